//! What an SDIRK step asks of a contact, whether its edge of stick rests or moves.
//!
//! The quantities that a step carries on are one vector: `λ` at the springs, the slip area, what belongs to an edge of stick that moves, the
//! dissipated energy, the worn volume.

use super::moving::MovingStage;
use super::newton::Newton;
use super::resting::{RestingStage, Tried};
use super::tableau::ALEXANDER;
use crate::laws::history::History;
use crate::numerics::grid::lagrange;
use crate::solver::model::{
    Fields, Model, Past, State, StickEdge, StickStage, StickTarget, StickTrial, Target, Unknowns,
};

/// Corrections of the energy that friction has dissipated, and the change of the coefficient below which there are no more.
const ENERGY_CORRECTIONS: usize = 30;
const SAME_FRICTION: f64 = 1e-12;

/// A contact during a step.
pub(super) trait Stages {
    /// The quantities at the start.
    fn start(&mut self) -> Vec<f64>;

    /// What a sum over the stages' slopes makes of the quantities at the start.
    fn gathered(&self, start: &[f64], slopes: &[Vec<f64>], weights: [f64; 3], cycles: f64) -> Vec<f64>;

    /// Solves a stage; the slopes of the quantities in it.
    fn solve(
        &mut self,
        index: usize,
        gathered: Vec<f64>,
        cycles: f64,
        evaluations: &mut u64,
    ) -> Option<Vec<f64>>;

    /// The model, and the fields in the stage solved last.
    fn solved(&self) -> (&Model, &Fields);

    /// The state after the step, from the quantities there.
    fn end(self, quantities: Vec<f64>, cycles: f64) -> State;
}

/// `(now - before)/step`.
fn slopes<'a>(
    now: impl IntoIterator<Item = &'a f64>,
    before: &'a [f64],
    step: f64,
) -> impl Iterator<Item = f64> {
    now.into_iter().zip(before).map(move |(now, before)| (now - before) / step)
}

fn target(model: &Model, state: &State, gathered: &[f64], index: usize, cycles: f64) -> Target {
    let (springs, now) = (model.springs(), state.cycles + ALEXANDER.times[index] * cycles);
    Target {
        log_slip: gathered[..springs].to_vec(),
        slip_area: gathered[springs],
        step: ALEXANDER.diagonal * cycles,
        cycles: now,
        loading: model.loading(state, now),
    }
}

/// The state after a step but for what belongs to an edge of stick that moves.
fn state_after(state: &State, at: Unknowns, quantities: &[f64], stick_radius: f64, cycles: f64) -> State {
    let [.., dissipated_energy, volume_by_rate] = *quantities else {
        unreachable!("two quantities at least")
    };
    State {
        cycles: state.cycles + cycles,
        slip_area: at.slip_area,
        dissipated_energy,
        volume_by_rate,
        least_stick_radius: state.least_stick_radius.min(stick_radius),
        slip_area_rate: (at.slip_area - state.slip_area) / cycles,
        compression_rate: slopes(&at.compression, &state.compression, cycles).collect(),
        compression: at.compression,
        resting_area: state.resting_area,
        stick: state.stick.clone(),
        ground: None,
        past: state.past.clone(),
    }
}

/// Where the edge of stick rests.
pub(super) struct RestingContact<'a> {
    model: &'a Model,
    state: &'a State,
    tolerance: f64,
    newton: &'a mut Newton,
    tried: &'a mut Tried,
    at: Unknowns,
    /// Energy that friction dissipates in a cycle, J, in the stage solved last; zero where nothing goes by it.
    dissipation: f64,
}

impl<'a> RestingContact<'a> {
    pub fn new(
        model: &'a Model,
        state: &'a State,
        tolerance: f64,
        newton: &'a mut Newton,
        tried: &'a mut Tried,
    ) -> Self {
        Self { model, state, tolerance, newton, tried, at: Unknowns::of(state), dissipation: 0.0 }
    }

    /// Newton's method. Friction follows the energy, J, that it has dissipated at the end of the stage, of which `energy` is without that of the stage.
    fn converged(&mut self, target: &Target, energy: f64, evaluations: &mut u64) -> Option<()> {
        let (model, tolerance) = (self.model, self.tolerance);
        let mut last = f64::NAN;
        for _ in 0..ENERGY_CORRECTIONS {
            let dissipated = energy + target.step * self.dissipation;
            let loading = model.after_energy(target.loading.clone(), dissipated);
            let coefficient = loading.friction.reference_coefficient();
            if (coefficient / last - 1.0).abs() <= SAME_FRICTION {
                return Some(());
            }
            last = coefficient;
            let target = Target { loading, ..target.clone() };
            let mut stage = RestingStage { model, target, bearing: None, tolerance, tried: self.tried };
            if !self.newton.solve(&mut stage, &mut self.at, evaluations) {
                return None;
            }
            if *model.schedule().friction_along_energy() == History::Constant {
                return Some(());
            }
            self.dissipation = self.tried.cycle.dissipation;
        }
        None
    }

    /// First guess of a stage: at the rates of the last step as long as that is a contact, then on the straight line from the state through the
    /// stage before.
    fn guess(&mut self, index: usize, cycles: f64) {
        let (model, state) = (self.model, self.state);
        if index > 0 {
            let factor = ALEXANDER.times[index] / ALEXANDER.times[index - 1];
            self.at.slip_area = state.slip_area + (self.at.slip_area - state.slip_area) * factor;
            for (q, start) in self.at.compression.iter_mut().zip(&state.compression) {
                *q = start + (*q - start) * factor;
            }
            return;
        }
        let ahead = Unknowns::ahead(state, ALEXANDER.times[0] * cycles);
        if ahead.slip_area > 0.0 && ahead.slip_area < model.unworn().largest_slip_area() {
            model.evaluate(ahead.slip_area, &ahead.compression, &mut self.tried.fields);
            if self.tried.fields.are_physical() {
                self.at = ahead;
            }
        }
    }
}

impl Stages for RestingContact<'_> {
    fn start(&mut self) -> Vec<f64> {
        let state = self.state;
        self.model.evaluate(state.slip_area, &state.compression, &mut self.tried.fields);
        let others = [state.slip_area, state.dissipated_energy, state.volume_by_rate];
        self.tried.fields.log_slip.iter().copied().chain(others).collect()
    }

    fn gathered(&self, start: &[f64], slopes: &[Vec<f64>], weights: [f64; 3], cycles: f64) -> Vec<f64> {
        let sum = |i: usize| {
            slopes.iter().zip(weights).map(|(slopes, weight)| cycles * weight * slopes[i]).sum::<f64>()
        };
        start.iter().enumerate().map(|(i, value)| value + sum(i)).collect()
    }

    fn solve(
        &mut self,
        index: usize,
        gathered: Vec<f64>,
        cycles: f64,
        evaluations: &mut u64,
    ) -> Option<Vec<f64>> {
        let target = target(self.model, self.state, &gathered, index, cycles);
        let step = target.step;
        self.guess(index, cycles);
        self.converged(&target, gathered[self.model.springs() + 1], evaluations)?;
        let Tried { fields, cycle } = &*self.tried;
        let now = fields.log_slip.iter().chain([&self.at.slip_area]);
        Some(slopes(now, &gathered, step).chain([cycle.dissipation, cycle.volume]).collect())
    }

    fn solved(&self) -> (&Model, &Fields) {
        (self.model, &self.tried.fields)
    }

    fn end(self, quantities: Vec<f64>, cycles: f64) -> State {
        state_after(self.state, self.at, &quantities, self.tried.cycle.stick_radius, cycles)
    }
}

/// Where the edge of stick moves.
pub(super) struct MovingContact<'a> {
    model: &'a Model,
    state: &'a State,
    stick: &'a StickEdge,
    tolerance: f64,
    newton: &'a mut Newton,
    trial: &'a mut StickTrial,
    /// Energy that friction dissipates in a cycle, J, in the stage solved last or at the start; zero where nothing goes by it.
    dissipation: f64,
    /// Whether the edge of stick is taken to move outwards, over worn ground.
    outwards: bool,
    /// The start and the stages solved.
    known: Vec<Unknowns>,
}

impl<'a> MovingContact<'a> {
    pub fn new(
        model: &'a Model,
        state: &'a State,
        stick: &'a StickEdge,
        tolerance: f64,
        newton: &'a mut Newton,
        trial: &'a mut StickTrial,
        outwards: bool,
    ) -> Self {
        let known = vec![Unknowns::of(state)];
        Self { model, state, stick, tolerance, newton, trial, outwards, dissipation: 0.0, known }
    }

    fn target(&self, index: usize, gathered: &[f64], cycles: f64) -> StickTarget {
        let springs = target(self.model, self.state, gathered, index, cycles);
        let [slip_compression, area, depth, load, bearing] =
            *gathered[self.model.springs() + 1..].first_chunk().expect("five numbers of the edge of stick");
        let left_behind = self.carried(gathered)[0].to_vec();
        let (places_at_rest, raised_at_rest) =
            (self.stick.places_at_rest.clone(), self.stick.raised_at_rest.clone());
        let carried = StickEdge { places_at_rest, raised_at_rest, ..StickEdge::default() };
        let stick = StickEdge { area, depth, load, left_behind, ..carried };
        let energy = gathered[gathered.len() - 2];
        StickTarget { springs, stick, slip_compression, bearing, energy, outwards: self.outwards }
    }

    /// What was left behind, and wear depth, among the quantities.
    fn carried<'b>(&self, quantities: &'b [f64]) -> [&'b [f64]; 2] {
        let all = &quantities[self.model.springs() + 6..quantities.len() - 2];
        let (left_behind, wear_depth) = all.split_at(self.stick.left_behind.len());
        [left_behind, wear_depth]
    }

    /// Solves a stage from a guess, or else from where the stage before ended. Friction follows the energy that it has dissipated at the end of
    /// the stage.
    fn converged(
        &mut self,
        mut target: StickTarget,
        at: &mut Unknowns,
        before: Unknowns,
        evaluations: &mut u64,
    ) -> Option<StickStage<'a>> {
        let loading = target.springs.loading.clone();
        let (mut rate, mut last) = (self.dissipation, f64::NAN);
        for _ in 0..ENERGY_CORRECTIONS {
            let energy = target.energy + target.springs.step * rate;
            target.springs.loading = self.model.after_energy(loading.clone(), energy);
            let stage = self.model.stick_stage(target.clone())?;
            let coefficient = target.springs.loading.friction.reference_coefficient();
            if (coefficient / last - 1.0).abs() <= SAME_FRICTION {
                return Some(stage);
            }
            last = coefficient;
            let mut stage = MovingStage::new(stage, self.tolerance, self.model, self.trial);
            if !stage.solve(at, self.newton, evaluations) {
                // What was before may lead astray.
                *at = before.clone();
                self.newton.outdate();
                if !stage.solve(at, self.newton, evaluations) {
                    return None;
                }
            }
            rate = self.trial.cycle.dissipation;
            if *self.model.schedule().friction_along_energy() != History::Constant {
                self.dissipation = rate;
            }
        }
        None
    }

    /// By the polynomial through the start and the stages before; in the first one at the rates of the last step.
    fn guess(&self, index: usize, cycles: f64) -> Unknowns {
        if index == 0 {
            return Unknowns::ahead(self.state, ALEXANDER.times[0] * cycles);
        }
        let [first, second, third] = ALEXANDER.times;
        let times = &[0.0, first, second, third][..=index];
        let mut weights = vec![0.0; times.len()];
        lagrange(times, ALEXANDER.times[index], &mut weights);
        let sum = |part: &dyn Fn(&Unknowns) -> f64| {
            self.known.iter().zip(&weights).map(|(it, weight)| weight * part(it)).sum()
        };
        Unknowns {
            compression: (0..self.state.compression.len()).map(|i| sum(&|it| it.compression[i])).collect(),
            slip_area: sum(&|it| it.slip_area),
            stick_area: sum(&|it| it.stick_area),
            stick_depth: sum(&|it| it.stick_depth),
            slip_compression: sum(&|it| it.slip_compression),
        }
    }
}

impl Stages for MovingContact<'_> {
    fn start(&mut self) -> Vec<f64> {
        let (state, stick) = (self.state, self.stick);
        let fields = self.model.fields(state);
        if *self.model.schedule().friction_along_energy() != History::Constant {
            let loading = self.model.schedule().loading(state.cycles, state.cycles);
            let loading = self.model.loading_in(state, loading);
            self.dissipation = self.model.cycle(&loading, &state.compression, &fields).dissipation;
        }
        let compression = fields.stick_zone.slip_compression;
        let of_edges = [
            state.slip_area,
            compression,
            stick.area,
            stick.depth,
            stick.load,
            self.model.bearing(state, compression),
        ];
        let carried = stick.left_behind.iter().chain(&stick.wear_depth);
        let sums = [state.dissipated_energy, state.volume_by_rate];
        fields.log_slip.iter().chain(&of_edges).chain(carried).chain(&sums).copied().collect()
    }

    fn gathered(&self, start: &[f64], slopes: &[Vec<f64>], weights: [f64; 3], cycles: f64) -> Vec<f64> {
        let sum =
            |i: usize| -> f64 { slopes.iter().zip(weights).map(|(slopes, weight)| weight * slopes[i]).sum() };
        start.iter().enumerate().map(|(i, value)| value + cycles * sum(i)).collect()
    }

    fn solve(
        &mut self,
        index: usize,
        gathered: Vec<f64>,
        cycles: f64,
        evaluations: &mut u64,
    ) -> Option<Vec<f64>> {
        let before = self.known.last()?.clone();
        let mut at = self.guess(index, cycles);
        let stage = self.converged(self.target(index, &gathered, cycles), &mut at, before, evaluations)?;
        let bearing = stage.bearing(&at);
        let stick = stage.rates(&at, self.trial);
        let (trial, step) = (&*self.trial, ALEXANDER.diagonal * cycles);
        let now = trial.fields.log_slip.iter().chain([&at.slip_area, &trial.stick_zone.slip_compression]);
        let found = slopes(now, &gathered, step)
            .chain([stick.area, stick.depth, stick.load])
            .chain(slopes([&bearing], &gathered[self.model.springs() + 5..], step))
            .chain(stick.left_behind)
            .chain(stick.wear_depth)
            .chain([trial.cycle.dissipation, trial.cycle.volume])
            .collect();
        self.known.push(at);
        Some(found)
    }

    fn solved(&self) -> (&Model, &Fields) {
        (self.model, &self.trial.fields)
    }

    fn end(mut self, quantities: Vec<f64>, cycles: f64) -> State {
        let at = self.known.pop().expect("the start at least is known");
        let [left_behind, wear_depth] = self.carried(&quantities).map(<[f64]>::to_vec);
        let stick = StickEdge {
            area: at.stick_area,
            depth: at.stick_depth,
            load: self.trial.stick_zone.stick_load,
            left_behind,
            wear_depth,
            slip_compression: at.slip_compression,
            rates: [
                (at.stick_area - self.stick.area) / cycles,
                (at.stick_depth - self.stick.depth) / cycles,
                (at.slip_compression - self.stick.slip_compression) / cycles,
            ],
            ..self.stick.clone()
        };
        let stick = self.model.with_ground_at_rest(stick, self.stick.area);
        let after = state_after(self.state, at, &quantities, self.trial.cycle.stick_radius, cycles);
        let mut next = State { stick: Some(stick), past: Past::default(), ..after };
        self.model.settle_depth(&mut next, &self.trial.fields);
        next
    }
}
