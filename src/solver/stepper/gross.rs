//! Implicit steps of a contact in gross slip: an ordinary differential equation for the compressions.

use std::sync::Arc;

use faer::Mat;

use super::bdf::{REMEMBERED, TimesBefore, choose, state_of};
use super::tableau::ALEXANDER;
use super::{Stepper, Trial};
use crate::error::{Error, Result};
use crate::numerics::linear::{Factors, largest_magnitude};
use crate::solver::model::{CycleLoading, Gross, GrossRates, Linearised, Model, Past, PastPoint, State};

/// Change of a compression, over the largest, by which Newton's matrix is found.
const DIFFERENCE: f64 = 1e-7;

/// Newton iterations of a stage before the step is given up.
const ITERATIONS: usize = 10;

/// What Newton's method may leave, over the tolerance of a step, and at least.
const LEFT: f64 = 1e-3;
const ROUND_OFF: f64 = 1e-12;

/// Slowest contraction of Newton's corrections with which the slopes of the rates serve another step.
const SAME_SLOPES: f64 = 0.3;

/// Largest tolerance of backward differentiation. Formulas of higher order let modes grow that the ground carried along makes: with 1e-4 runs on 30 and more
/// springs at k = 0.5 went over to a contact that no wear leads to.
const LARGEST_TOLERANCE: f64 = 1e-5;

/// Backward differentiation formulas of order 1 to 5, as [`Bdf`](super::Bdf), where every cycle is the same, so that wear is smooth in time:
///
/// ```text
/// q - q̂ - h q'(q) = 0
/// ```
///
/// Slopes of the rates are differences, and serve the steps after them while Newton's method converges.
#[derive(Debug)]
pub struct GrossBdf {
    tolerance: f64,
    /// The tolerance asked for over this one.
    stricter: f64,
    slopes: Option<Slopes>,
    /// Cycles of the state that the last step was tried from.
    tried_from: Option<f64>,
}

/// Slopes of the rates of the compressions by the compressions.
#[derive(Debug)]
struct Slopes {
    at: Arc<Linearised>,
    matrix: Mat<f64>,
}

impl GrossBdf {
    /// A stepper with a largest error of the compressions in one step, relative to the indentation, or to the largest of them where the force is held.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance: tolerance.min(LARGEST_TOLERANCE),
            stricter: (tolerance / LARGEST_TOLERANCE).max(1.0),
            slopes: None,
            tried_from: None,
        }
    }

    /// Takes up the slopes of the step before, made again in a run that is resumed.
    ///
    /// A rejected step leaves its slopes to the next one from the same state. Evaluations are not counted: without the interruption there were none.
    fn take_up_slopes(&mut self, model: &Model, gross: &Gross, state: &State) {
        if self.tried_from.replace(state.cycles) == Some(state.cycles) {
            return;
        }
        let left = state.past.linearised.as_ref();
        if self.slopes.as_ref().map(|it| Arc::as_ptr(&it.at)) != left.map(Arc::as_ptr) {
            let loading = |at: &Linearised| model.schedule().loading(at.cycles, at.cycles);
            self.slopes = left.and_then(|at| Slopes::new(model, gross, &loading(at), at, &mut 0));
        }
    }
}

impl Slopes {
    /// By differences; none where no contact has these compressions.
    fn new(
        model: &Model,
        gross: &Gross,
        loading: &CycleLoading,
        at: &Arc<Linearised>,
        evaluations: &mut u64,
    ) -> Option<Self> {
        let around = model.surroundings(None);
        let rates = |compression: &[f64]| model.gross_rates(gross, loading, &around, compression);
        let here = rates(&at.compression)?;
        *evaluations += 1;
        let matrix = slopes(&at.compression, &here, evaluations, rates)?;
        Some(Self { at: Arc::clone(at), matrix })
    }
}

/// `∂q'/∂q` by differences, shape `(springs - 1, springs - 1)`.
///
/// # Arguments
/// * `here` -- the rates at these compressions
fn slopes(
    compression: &[f64],
    here: &GrossRates,
    evaluations: &mut u64,
    rates: impl Fn(&[f64]) -> Option<GrossRates>,
) -> Option<Mat<f64>> {
    let n = compression.len();
    let difference = DIFFERENCE * largest_magnitude(compression);
    *evaluations += n as u64;
    let mut moved = compression.to_vec();
    let mut matrix = Mat::zeros(n, n);
    for j in 0..n {
        moved[j] += difference;
        let there = rates(&moved)?.compression;
        moved[j] = compression[j];
        for i in 0..n {
            matrix[(i, j)] = (there[i] - here.compression[i]) / difference;
        }
    }
    Some(matrix)
}

/// Equations `q - q̂ - h q'(q) = 0` of a step or stage.
struct Stage<'a> {
    /// `q̂`, m.
    gathered: &'a [f64],
    /// `h`, cycles.
    step: f64,
    /// What Newton's method may leave of the compressions, m.
    left: f64,
}

/// What solves a stage.
struct Solved {
    compression: Vec<f64>,
    /// The rates before the last correction.
    rates: GrossRates,
    /// Largest part of a correction that the next one was.
    contraction: f64,
}

impl Stage<'_> {
    /// Newton's method with one matrix, `1 - h ∂q'/∂q`; none if it does not converge.
    fn solve(
        &self,
        slopes: &Mat<f64>,
        guess: &[f64],
        mut rates: impl FnMut(&[f64]) -> Option<GrossRates>,
    ) -> Option<Solved> {
        let n = guess.len();
        let matrix = Mat::from_fn(n, n, |i, j| f64::from(u8::from(i == j)) - self.step * slopes[(i, j)]);
        let factors = Factors::new(matrix);
        let mut compression = guess.to_vec();
        let (mut before, mut contraction) = (f64::INFINITY, 0.0_f64);
        for _ in 0..ITERATIONS {
            let there = rates(&compression)?;
            let mut change: Vec<f64> = (0..n)
                .map(|i| compression[i] - self.gathered[i] - self.step * there.compression[i])
                .collect();
            factors.solve(&mut change);
            let size = largest_magnitude(&change);
            compression.iter_mut().zip(&change).for_each(|(q, change)| *q -= change);
            if before.is_finite() {
                contraction = contraction.max(size / before);
            }
            if size <= self.left {
                return Some(Solved { compression, rates: there, contraction });
            }
            if size.is_nan() || size >= 2.0 * before {
                return None;
            }
            before = size;
        }
        None
    }
}

impl Stepper for GrossBdf {
    fn name(&self) -> &'static str {
        "BDF of order 1 to 5"
    }

    fn step(&mut self, model: &Model, state: &State, cycles: f64) -> Result<Trial> {
        let gross = mesh(model)?;
        // What no smaller step can cure.
        model.gross_area_in(gross, state)?;
        let mut evaluations = 0;
        let trial = self.try_step(model, gross, state, cycles, &mut evaluations);
        Ok(trial.unwrap_or_else(|| Trial::failed(evaluations)))
    }

    fn forget(&mut self) {
        self.slopes = None;
        self.tried_from = None;
    }

    fn estimate_order(&self) -> f64 {
        2.0
    }

    fn steps_gross_slip(&self) -> bool {
        true
    }

    fn interpolates(&self) -> bool {
        true
    }

    fn between(&self, model: &Model, state: &State, cycles: f64) -> Option<State> {
        let between =
            state_of(state, TimesBefore::new(model, cycles, &state.past).guess(&state.past), cycles);
        let slip_area = model.gross_area_in(model.gross()?, &between).ok()?;
        Some(State { slip_area, ..between })
    }
}

impl GrossBdf {
    fn try_step(
        &mut self,
        model: &Model,
        gross: &Gross,
        state: &State,
        cycles: f64,
        evaluations: &mut u64,
    ) -> Option<Trial> {
        let mut past = match state.past.points.is_empty() {
            true => Past { order: 1, points: vec![PastPoint::new(state, &[])], linearised: None },
            false => state.past.clone(),
        };
        let (now, scale) = (state.cycles + cycles, model.gross_error_scale(gross, &state.compression));
        let loading = model.schedule().loading(state.cycles, now);
        let around = model.surroundings(None);
        let times = TimesBefore::new(model, now, &past);
        let gathered = PastPoint::sum(&times.gathering(past.order), &past.points);
        let step = times.step(past.order);
        let is_first = past.points.len() == 1;
        let guess = match is_first {
            true => {
                *evaluations += 1;
                let rates = model.gross_rates(gross, &loading, &around, &state.compression)?.compression;
                state.compression.iter().zip(rates).map(|(q, rate)| q + cycles * rate).collect()
            }
            false => times.guess(&past).compression,
        };
        self.take_up_slopes(model, gross, state);
        let left = (LEFT * self.tolerance).max(ROUND_OFF) * scale;
        let stage = Stage { gathered: &gathered.compression, step, left };
        let solve = |slopes: &Slopes, evaluations: &mut u64| {
            stage.solve(&slopes.matrix, &guess, |compression| {
                *evaluations += 1;
                model.gross_rates(gross, &loading, &around, compression)
            })
        };
        let found = self.slopes.as_ref().and_then(|slopes| solve(slopes, evaluations));
        let Solved { compression, rates, contraction } = match found {
            Some(found) => found,
            None => {
                let at = Arc::new(Linearised {
                    cycles: now,
                    slip_area: state.slip_area,
                    gathered_slip_area: gathered.slip_area,
                    step,
                    compression: guess.clone(),
                });
                self.slopes = Slopes::new(model, gross, &loading, &at, evaluations);
                solve(self.slopes.as_ref()?, evaluations)?
            }
        };
        let mut end = State {
            cycles: now,
            slip_area: model.gross_area(gross, &around, &compression).ok()?,
            compression,
            dissipated_energy: gathered.dissipated_energy + step * rates.dissipation,
            volume_by_rate: gathered.volume_by_rate + step * rates.volume,
            least_stick_radius: state.least_stick_radius.min(rates.stick_radius),
            past: Past::default(),
            ..state.clone()
        };
        past.points.insert(0, PastPoint::new(&end, &[]));
        // At the start what a step adds, later what was there.
        let of_energy = end.dissipated_energy.max(rates.dissipation * times.per_slope());
        let of_volume = end.volume_by_rate.max(rates.volume * times.per_slope());
        let error_at = |order| {
            let Some(weights) = times.error_weights(order) else { return f64::INFINITY };
            let off = PastPoint::sum(&weights, &past.points);
            let relative = |off: f64, scale: f64| if scale > 0.0 { off.abs() / scale } else { 0.0 };
            (largest_magnitude(&off.compression) / scale)
                .max(relative(off.dissipated_energy, of_energy))
                .max(relative(off.volume_by_rate, of_volume))
        };
        let error = match is_first {
            // Explicit and implicit Euler steps err by the same amount in opposite directions.
            true => {
                let apart: Vec<f64> =
                    end.compression.iter().zip(&guess).map(|(q, guess)| q - guess).collect();
                0.5 * largest_magnitude(&apart) / scale
            }
            false => error_at(past.order),
        };
        let (order, factor) = choose(past.order, error, self.tolerance, error_at);
        past.order = order;
        past.points.truncate(REMEMBERED);
        if contraction > SAME_SLOPES {
            self.slopes = None;
        }
        past.linearised = self.slopes.as_ref().map(|it| Arc::clone(&it.at));
        end.past = past;
        Some(Trial {
            state: Some(end),
            fields: None,
            error: self.stricter * error,
            rate_evaluations: *evaluations,
            next_step: Some(cycles * factor),
        })
    }
}

/// The mesh of gross slip of a model.
fn mesh(model: &Model) -> Result<&Gross> {
    model.gross().ok_or_else(|| Error::Inconsistent {
        what: "numerics.stepper",
        why: "this method steps contacts in gross slip alone; take Sdirk".into(),
    })
}

/// Alexander's method of order 3, with the error of the compressions by the embedded one of order 2.
#[derive(Debug)]
pub struct GrossSdirk {
    tolerance: f64,
}

impl GrossSdirk {
    /// A stepper whose stages are solved well below the tolerance of the time stepping.
    pub fn new(tolerance: f64) -> Self {
        Self { tolerance }
    }
}

impl Stepper for GrossSdirk {
    fn name(&self) -> &'static str {
        "SDIRK of order 3"
    }

    fn step(&mut self, model: &Model, state: &State, cycles: f64) -> Result<Trial> {
        let gross = mesh(model)?;
        // What no smaller step can cure.
        model.gross_area_in(gross, state)?;
        let mut evaluations = 1;
        Ok(step(model, gross, state, cycles, self.tolerance, &mut evaluations)
            .unwrap_or_else(|| Trial::failed(evaluations)))
    }

    fn estimate_order(&self) -> f64 {
        3.0
    }

    fn steps_gross_slip(&self) -> bool {
        true
    }
}

fn step(
    model: &Model,
    gross: &Gross,
    state: &State,
    cycles: f64,
    tolerance: f64,
    evaluations: &mut u64,
) -> Option<Trial> {
    let (start, ground) = (&state.compression, state.ground.as_deref());
    let around = model.surroundings(ground);
    let loading = |at: f64, energy: f64| {
        model.after_energy(model.schedule().loading(state.cycles, at).on_ground(ground), energy)
    };
    let rates = |at: f64, energy: f64, compression: &[f64], evaluations: &mut u64| {
        *evaluations += 1;
        model.gross_rates(gross, &loading(at, energy), &around, compression)
    };
    let scale = model.gross_error_scale(gross, start);
    let first = rates(state.cycles, state.dissipated_energy, start, evaluations)?;
    let step = cycles * ALEXANDER.diagonal;
    let slopes = slopes(start, &first, evaluations, |compression| {
        model.gross_rates(gross, &loading(state.cycles, state.dissipated_energy), &around, compression)
    })?;
    let mut stages: Vec<GrossRates> = Vec::with_capacity(ALEXANDER.matrix.len());
    let mut at = start.clone();
    for (row, time) in ALEXANDER.matrix.iter().zip(ALEXANDER.times) {
        let gathered: Vec<f64> = (0..start.len())
            .map(|i| {
                let before = stages.iter().zip(row).map(|(stage, weight)| weight * stage.compression[i]);
                start[i] + cycles * before.sum::<f64>()
            })
            .collect();
        let spent = stages.iter().zip(row).map(|(stage, weight)| cycles * weight * stage.dissipation);
        let spent = state.dissipated_energy + spent.sum::<f64>();
        let guess = stages.last().unwrap_or(&first);
        let mut dissipation = guess.dissipation;
        let from: Vec<f64> = (0..start.len()).map(|i| gathered[i] + step * guess.compression[i]).collect();
        let left = (LEFT * tolerance).max(ROUND_OFF) * scale;
        let stage = Stage { gathered: &gathered, step, left };
        let solved = stage.solve(&slopes, &from, |compression| {
            let energy = spent + step * dissipation;
            let there = rates(state.cycles + time * cycles, energy, compression, evaluations)?;
            dissipation = there.dissipation;
            Some(there)
        })?;
        let mut found = solved.rates;
        at = solved.compression;
        // The rate that makes the stage exact.
        for (i, rate) in found.compression.iter_mut().enumerate() {
            *rate = (at[i] - gathered[i]) / step;
        }
        stages.push(found);
    }
    let weights = ALEXANDER.matrix[ALEXANDER.matrix.len() - 1];
    let sum = |part: fn(&GrossRates) -> f64| -> f64 {
        stages.iter().zip(weights).map(|(stage, weight)| cycles * weight * part(stage)).sum()
    };
    let errors = (0..start.len()).map(|i| {
        let parts = stages.iter().zip(weights.iter().zip(ALEXANDER.embedded));
        cycles
            * parts.map(|(stage, (weight, embedded))| (weight - embedded) * stage.compression[i]).sum::<f64>()
    });
    let error = errors.fold(0.0, |most: f64, error| most.max(error.abs())) / scale;
    let stick_radius = stages.iter().map(|stage| stage.stick_radius).fold(f64::INFINITY, f64::min);
    let end = State {
        cycles: state.cycles + cycles,
        slip_area: model.gross_area(gross, &around, &at).ok()?,
        compression: at,
        dissipated_energy: state.dissipated_energy + sum(|stage| stage.dissipation),
        volume_by_rate: state.volume_by_rate + sum(|stage| stage.volume),
        least_stick_radius: state.least_stick_radius.min(stick_radius),
        ..state.clone()
    };
    Some(Trial { state: Some(end), fields: None, error, rate_evaluations: *evaluations, next_step: None })
}
