//! Implicit steps of a contact whose edge of stick moves.

use super::implicit::{GAMMA, MATRIX, STAGES, TIMES, embedded_error};
use super::newton::{ITERATIONS, RENEWALS, ROUND_OFF, SLOWEST};
use super::{Stepper, Trial};
use crate::error::Result;
use crate::numerics::grid::lagrange;
use crate::numerics::linear::Factors;
use crate::solver::model::{Model, Past, State, StickEdge, StickTarget, StickTrial};

/// The method of [`Implicit`](super::Implicit) with the edge of stick and the depth of the profile there as further unknowns.
#[derive(Debug)]
pub struct MovingStickImplicit {
    newton_tolerance: f64,
    trial: StickTrial,
}

/// Corrections of the edge of stick, relative, that are round-off of the balance that decides it.
const STICK_ROUND_OFF: f64 = 1e-11;

/// What may be left of a balance of forces, relative.
const BALANCED: f64 = 1e-12;

/// Slopes of one stage.
struct Stage {
    log_slip: Vec<f64>,
    edge: f64,
    slip_compression: f64,
    stick: StickEdge,
    dissipation: f64,
    volume: f64,
}

/// The unknowns of a stage.
#[derive(Clone)]
struct Unknowns {
    compression: Vec<f64>,
    edge: f64,
    area: f64,
    depth: f64,
}

impl MovingStickImplicit {
    /// A stepper whose stages are solved well below the tolerance of the time stepping.
    pub fn new(tolerance: f64) -> Self {
        Self { newton_tolerance: (1e-3 * tolerance).clamp(1e-12, 1e-8), trial: StickTrial::default() }
    }

    /// Newton's method for one stage, from and into `at`; whether it converged to a contact.
    fn solve(
        &mut self,
        model: &Model,
        target: &StickTarget,
        at: &mut Unknowns,
        factors: &mut Option<Factors>,
        evaluations: &mut u64,
    ) -> bool {
        let inner = at.compression.len();
        *evaluations += 1;
        if !at.try_in(model, target, &mut self.trial) {
            return false;
        }
        for _ in 0..=RENEWALS {
            if factors.is_none() {
                *evaluations += 4;
                let matrix =
                    model.stick_matrix(target, at.edge, at.area, at.depth, &at.compression, &self.trial);
                *factors = matrix.map(Factors::new);
            }
            let Some(lu) = factors else { return false };
            let mut before = f64::INFINITY;
            for _ in 0..ITERATIONS {
                let mut change = self.trial.residual.clone();
                lu.solve(&mut change);
                for (q, dq) in at.compression.iter_mut().zip(&change) {
                    *q -= dq;
                }
                at.edge -= change[inner];
                at.area -= change[inner + 1];
                at.depth -= change[inner + 2];
                *evaluations += 1;
                if !at.try_in(model, target, &mut self.trial) {
                    return false;
                }
                let scale = self.trial.place.slip_compression;
                let largest = change[..inner].iter().fold(0.0, |m: f64, dq| m.max(dq.abs())) / scale;
                let size = largest.max(change[inner].abs() / at.edge);
                let stick = (change[inner + 1].abs() / at.area).max(change[inner + 2].abs() / scale);
                let left = at.compression.iter().fold(0.0, |m: f64, q| m.max(q.abs())) / scale;
                let balanced = self.trial.residual.last().is_some_and(|it| it.abs() <= BALANCED);
                if size <= self.newton_tolerance * left + 10.0 * ROUND_OFF
                    && stick <= STICK_ROUND_OFF
                    && balanced
                {
                    return true;
                }
                if size.max(stick) > SLOWEST * before {
                    break;
                }
                before = size.max(stick);
            }
            *factors = None;
        }
        false
    }
}

impl Unknowns {
    fn try_in(&self, model: &Model, target: &StickTarget, trial: &mut StickTrial) -> bool {
        model.try_stick(target, self.edge, self.area, self.depth, &self.compression, trial)
    }

    /// Some cycles on, at the rates of the last step.
    fn ahead(state: &State, stick: &StickEdge, cycles: f64) -> Self {
        Self {
            compression: state
                .compression
                .iter()
                .zip(&state.compression_rate)
                .map(|(q, rate)| q + cycles * rate)
                .collect(),
            edge: state.edge + cycles * state.edge_rate,
            area: stick.area + cycles * stick.rates[0],
            depth: stick.depth + cycles * stick.rates[1],
        }
    }

    /// At `time` by the polynomial through what there was at some times.
    fn through(times: &[f64], known: &[Self], time: f64) -> Self {
        let mut weights = vec![0.0; times.len()];
        lagrange(times, time, &mut weights);
        let sum = |part: &dyn Fn(&Self) -> f64| known.iter().zip(&weights).map(|(it, w)| w * part(it)).sum();
        Self {
            compression: (0..known[0].compression.len()).map(|i| sum(&|it| it.compression[i])).collect(),
            edge: sum(&|it| it.edge),
            area: sum(&|it| it.area),
            depth: sum(&|it| it.depth),
        }
    }

    /// Where the compression at the edge of stick is known, with that one: next to the edge slip is the small difference of both.
    fn fitted(mut self, model: &Model, target: &StickTarget) -> Self {
        let Some(known) = model.known_slip_compression(target) else { return self };
        let held = model.contact().indentation();
        let factor = known / (held - self.depth);
        self.compression.iter_mut().for_each(|q| *q *= factor);
        self.depth = held - known;
        self
    }
}

impl Stepper for MovingStickImplicit {
    fn step(&mut self, model: &Model, state: &State, cycles: f64) -> Result<Trial> {
        let stick = state.stick.as_ref().expect("stepped where the stick edge moves");
        let fields = model.fields(state);
        let mut evaluations = 1;
        let start = &fields.log_slip;
        let mut stages: Vec<Stage> = Vec::with_capacity(STAGES);
        let mut factors = None;
        let mut at = Unknowns::ahead(state, stick, 0.0);
        let mut known = vec![at.clone()];
        let times: Vec<f64> = std::iter::once(0.0).chain(TIMES).collect();
        for (index, row) in MATRIX.into_iter().enumerate() {
            let gathered = |from: f64, part: &dyn Fn(&Stage) -> f64| {
                let sum: f64 = stages.iter().zip(row).map(|(stage, weight)| weight * part(stage)).sum();
                from + cycles * sum
            };
            let target = StickTarget {
                log_slip: (0..start.len()).map(|i| gathered(start[i], &|s| s.log_slip[i])).collect(),
                edge: gathered(state.edge, &|s| s.edge),
                stick: StickEdge {
                    area: gathered(stick.area, &|s| s.stick.area),
                    depth: gathered(stick.depth, &|s| s.stick.depth),
                    load: gathered(stick.load, &|s| s.stick.load),
                    left_behind: (0..stick.left_behind.len())
                        .map(|j| gathered(stick.left_behind[j], &|s| s.stick.left_behind[j]))
                        .collect(),
                    ..StickEdge::default()
                },
                slip_compression: gathered(fields.place.slip_compression, &|s| s.slip_compression),
                step: GAMMA * cycles,
                drive: model.schedule().drive(state.cycles, state.cycles + TIMES[index] * cycles),
            };
            let from = at.clone();
            at = match index {
                0 => Unknowns::ahead(state, stick, TIMES[0] * cycles),
                _ => Unknowns::through(&times[..=index], &known, TIMES[index]),
            }
            .fitted(model, &target);
            if !self.solve(model, &target, &mut at, &mut factors, &mut evaluations) {
                // What was before may lead astray.
                at = from.fitted(model, &target);
                factors = None;
                if !self.solve(model, &target, &mut at, &mut factors, &mut evaluations) {
                    return Ok(Trial::failed(evaluations));
                }
            }
            known.push(at.clone());
            let trial = &self.trial;
            let slope = |(now, before): (&f64, &f64)| (now - before) / target.step;
            stages.push(Stage {
                log_slip: trial.fields.log_slip.iter().zip(&target.log_slip).map(slope).collect(),
                edge: (at.edge - target.edge) / target.step,
                slip_compression: (trial.place.slip_compression - target.slip_compression) / target.step,
                stick: model.stick_rates(&target, at.area, at.depth, trial),
                dissipation: trial.cycle.dissipation,
                volume: trial.cycle.volume,
            });
        }
        let weights = MATRIX[STAGES - 1];
        let summed = |part: &dyn Fn(&Stage) -> f64| {
            cycles * stages.iter().zip(weights).map(|(stage, weight)| weight * part(stage)).sum::<f64>()
        };
        let over = |values: &[f64], part: &dyn Fn(&Stage, usize) -> f64| -> Vec<f64> {
            values.iter().enumerate().map(|(j, value)| value + summed(&|stage| part(stage, j))).collect()
        };
        let rate = |(now, before): (&f64, &f64)| (now - before) / cycles;
        let mut next = State {
            cycles: state.cycles + cycles,
            edge: at.edge,
            dissipated_energy: state.dissipated_energy + summed(&|stage| stage.dissipation),
            volume_by_rate: state.volume_by_rate + summed(&|stage| stage.volume),
            least_stick_radius: state.least_stick_radius.min(self.trial.cycle.stick_radius),
            edge_rate: (at.edge - state.edge) / cycles,
            compression_rate: at.compression.iter().zip(&state.compression).map(rate).collect(),
            stick: Some(StickEdge {
                area: at.area,
                depth: at.depth,
                load: self.trial.place.stick_load,
                left_behind: over(&stick.left_behind, &|stage, j| stage.stick.left_behind[j]),
                wear_depth: over(&stick.wear_depth, &|stage, j| stage.stick.wear_depth[j]),
                rates: [(at.area - stick.area) / cycles, (at.depth - stick.depth) / cycles],
                places_at_rest: stick.places_at_rest.clone(),
                raised_at_rest: stick.raised_at_rest.clone(),
            }),
            compression: at.compression,
            past: Past::default(),
        };
        model.settle_depth(&mut next, &self.trial.fields);
        let slopes = stages.iter().map(|stage| &stage.log_slip[..]);
        let error = embedded_error(model, &self.trial.fields, cycles, slopes);
        Ok(Trial { state: Some(next), fields: None, error, rate_evaluations: evaluations, next_step: None })
    }

    fn follows_stick(&self) -> bool {
        true
    }

    fn estimate_order(&self) -> f64 {
        3.0
    }
}
