//! Backward differentiation formulas in the logarithm of time: implicit steps that remember several before.

use std::sync::Arc;

use super::newton::Newton;
use super::resting::{RestingStage, Tried};
use super::{FIRST_GROWTH, Stepper, Trial, relative_depth_error};
use crate::error::Result;
use crate::numerics::abel::Backend;
use crate::solver::model::{Linearised, Model, Past, PastPoint, State, Target, Unknowns};

/// Backward differentiation formulas of order 1 to 5, with variable steps and order, for wear that is smooth in time.
///
/// ```text
/// dλ/ds (s_n) = Σ_j ℓ'_j(s_n) λ_j,    s = ln(1 + t/t0),    ℓ_j on s_n, s_{n-1}, ..., s_{n-p}
/// ```
///
/// The weights are those of the interpolating polynomial whatever the steps (Hairer & Wanner, Solving Ordinary Differential Equations II,
/// ch. V.1), which keeps its order under a constraint of index 2 (there, ch. VII.3) as that of the contact edge is. Rates of wear fall like
/// powers of time, for which steps may stay even in `s`. A step is one stage, for which Newton's matrix is factorised once
/// while it converges; on many springs its factors serve the steps after it too. What lies within a step is on the same polynomial, so that
/// outputs cost no steps.
#[derive(Debug)]
pub struct Bdf {
    /// Largest error of one step.
    tolerance: f64,
    /// About the error at the end of a run.
    at_the_end: f64,
    newton: Newton,
    tried: Tried,
    /// Cycles of the state that the last step was tried from.
    tried_from: Option<f64>,
}

/// Times remembered, the present one included: the error at the next order takes two more than that order.
pub(super) const REMEMBERED: usize = Bdf::HIGHEST_ORDER + 2;

/// Error at the end of a run over that of its steps, measured (docs/numerics.md), so that a tolerance is about the error that comes of it.
const ACCUMULATED: f64 = 8.0;

/// Largest change of the step, as a logarithm, and contraction of the corrections with which hierarchical factors serve another step. Making them
/// takes as long as eight corrections. Dense factors are made anew in every step: on so few springs that is cheap.
const SAME_STEP: f64 = 0.3;
const SAME_MATRIX: f64 = 0.4;

/// `t0` over the time in which wear at the first pressures comes to the compression at the edge of stick: before that, too, wear at the edges goes by
/// powers of time. In gross slip it is that time.
const EARLY: f64 = 0.1;

/// Growth of the slip in the first step over the root of its largest error: a step of first order errs by its square.
const FIRST: f64 = 0.12;

/// Parts of the step that the error allows, at the present order and where the order changes.
const SAFETY: f64 = 0.8;
const SAFETY_OF_CHANGE: f64 = 0.7;

/// Bounds of the change of a step.
const CHANGES: [f64; 2] = [0.2, 2.0];

impl Stepper for Bdf {
    fn name(&self) -> &'static str {
        "BDF of order 1 to 5"
    }

    fn step(&mut self, model: &Model, state: &State, cycles: f64) -> Result<Trial> {
        let past = self.past(model, state);
        let now = state.cycles + cycles;
        let times = TimesBefore::new(model, now, &past);
        let first = (past.points.len() == 1).then(|| self.first_log_slip(model, state, cycles));
        let gathered = PastPoint::sum(&times.gathering(past.order), &past.points);
        let target = Target {
            log_slip: gathered.log_slip,
            slip_area: gathered.slip_area,
            step: times.step(past.order),
            cycles: now,
            loading: model.loading(state, now),
        };
        self.take_up_factors(model, state, &target);
        let step = target.step;
        let mut evaluations = 1;
        // First guess: the polynomial through the past, then the same with new factors, then the state itself. On fine meshes with gradings near
        // -1 the polynomial may lead too far for Newton's method.
        let led = (past.points.len() > 1).then(|| led(model, state, &times, &past, now));
        let again = led.clone().filter(|_| self.newton.linearised().is_some());
        let still = State { cycles: now, past: Past::default(), ..state.clone() };
        let guesses = led.into_iter().chain(again).chain([still]).enumerate();
        let (tolerance, newton) = (self.at_the_end, &mut self.newton);
        let bearing = model.bearing_ahead(state);
        let mut stage = RestingStage { model, target, bearing, tolerance, tried: &mut self.tried };
        let found = guesses.into_iter().find_map(|(attempt, guess)| {
            if attempt > 0 {
                newton.outdate();
            }
            let mut at = Unknowns::of(&guess);
            newton.solve(&mut stage, &mut at, &mut evaluations).then_some(State {
                stick: bearing
                    .zip(state.stick.as_ref())
                    .map(|(it, stick)| model.bearing_edge(&it, stick, at.slip_area, &at.compression)),
                slip_area: at.slip_area,
                compression: at.compression,
                ..guess
            })
        });
        let Some(mut at) = found else {
            self.newton.outdate();
            return Ok(Trial::failed(evaluations));
        };
        if self.newton.contraction > SAME_MATRIX {
            self.newton.outdate();
        }
        let cycle = &self.tried.cycle;
        at.dissipated_energy = gathered.dissipated_energy + step * cycle.dissipation;
        at.volume_by_rate = gathered.volume_by_rate + step * cycle.volume;
        at.least_stick_radius = state.least_stick_radius.min(cycle.stick_radius);

        let mut past = past;
        past.points.insert(0, PastPoint::new(&at, &self.tried.fields.log_slip));
        let error = match first {
            // Explicit and implicit Euler steps err by the same amount in opposite directions.
            Some(guess) => 0.5 * self.depth_error(model, &[1.0, -1.0], &[&past.points[0].log_slip, &guess]),
            None => self.error_at(model, past.order, &times, &past),
        };
        let error_at = |order| self.error_at(model, order, &times, &past);
        let (order, factor) = choose(past.order, error, self.tolerance, error_at);
        past.order = order;
        past.points.truncate(REMEMBERED);
        let serves_more = model.operators().backend() == Backend::Hierarchical;
        past.linearised = self.newton.linearised().filter(|_| serves_more).cloned();
        at.past = past;
        Ok(Trial {
            state: Some(at),
            fields: Some(std::mem::take(&mut self.tried.fields)),
            error: ACCUMULATED * error,
            rate_evaluations: evaluations,
            next_step: Some(cycles * factor),
        })
    }

    fn first_growth(&self) -> f64 {
        (FIRST * self.tolerance.sqrt()).min(FIRST_GROWTH)
    }

    fn forget(&mut self) {
        self.newton.outdate();
        self.tried_from = None;
    }

    fn estimate_order(&self) -> f64 {
        2.0
    }

    fn follows_stick(&self, model: &Model) -> bool {
        model.bears_both_forces()
    }

    fn interpolates(&self) -> bool {
        true
    }

    fn between(&self, model: &Model, state: &State, cycles: f64) -> Option<State> {
        let past = &state.past;
        Some(led(model, state, &TimesBefore::new(model, cycles, past), past, cycles))
    }
}

impl Bdf {
    /// Highest order; from 6 on the formulas are not stable enough for stiff equations.
    pub const HIGHEST_ORDER: usize = 5;

    /// A stepper whose tolerance is about the error at the end of a run.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance: tolerance / ACCUMULATED,
            at_the_end: tolerance,
            newton: Newton::default(),
            tried: Tried::default(),
            tried_from: None,
        }
    }

    /// Takes up the factors of the step before, made again in a run that is resumed, as long as they suit the step.
    ///
    /// A rejected step leaves its factors to the next one from the same state.
    fn take_up_factors(&mut self, model: &Model, state: &State, target: &Target) {
        if self.tried_from != Some(state.cycles) {
            self.tried_from = Some(state.cycles);
            let known = self.newton.linearised().map(Arc::as_ptr);
            match &state.past.linearised {
                Some(left) if known == Some(Arc::as_ptr(left)) => {}
                Some(left) => {
                    let target = Target {
                        log_slip: vec![],
                        slip_area: left.gathered_slip_area,
                        step: left.step,
                        cycles: left.cycles,
                        loading: model.schedule().loading(left.cycles, left.cycles),
                    };
                    let (tolerance, tried) = (self.at_the_end, &mut self.tried);
                    let bearing = model.bearing_ahead(state);
                    self.newton.recall(&mut RestingStage { model, target, bearing, tolerance, tried }, left);
                }
                None => self.newton.outdate(),
            }
        }
        let suits = |at: &Arc<Linearised>| (target.step / at.step).ln().abs() <= SAME_STEP;
        if model.operators().backend() == Backend::Dense || !self.newton.linearised().is_some_and(suits) {
            self.newton.outdate();
        }
    }

    /// The past of a state, which at the start is that state alone.
    fn past(&mut self, model: &Model, state: &State) -> Past {
        if !state.past.points.is_empty() {
            return state.past.clone();
        }
        self.tried.fields = model.fields(state);
        Past { order: 1, points: vec![PastPoint::new(state, &self.tried.fields.log_slip)], linearised: None }
    }

    /// `λ` where the rates at the start lead, from zero.
    fn first_log_slip(&mut self, model: &Model, state: &State, cycles: f64) -> Vec<f64> {
        let fields = &self.tried.fields;
        let loading = model.loading_in(state, model.schedule().loading(state.cycles, state.cycles));
        let cycle = model.cycle(&loading, &state.compression, fields);
        fields
            .log_slip
            .iter()
            .zip(&cycle.growth)
            .map(|(log_slip, growth)| log_slip + cycles * growth)
            .collect()
    }

    /// Largest error in depth of a step at some order, over the limit's largest depth; infinite where the past is too short.
    fn error_at(&self, model: &Model, order: usize, times: &TimesBefore, past: &Past) -> f64 {
        let log_slips: Vec<&[f64]> = past.points.iter().map(|point| &point.log_slip[..]).collect();
        let weights = times.error_weights(order);
        weights.map_or(f64::INFINITY, |weights| self.depth_error(model, &weights, &log_slips))
    }

    /// Depth, over the limit's largest, of a weighted sum of logarithms of slip on the inner springs, the largest of all.
    fn depth_error(&self, model: &Model, weights: &[f64], log_slips: &[&[f64]]) -> f64 {
        let slip = &self.tried.fields.slip_depth;
        let sum = |i: usize| {
            weights.iter().zip(log_slips).map(|(weight, log_slip)| weight * log_slip[i]).sum::<f64>()
        };
        relative_depth_error(model, (0..model.springs() - 1).map(|i| slip[i] * sum(i)))
    }
}

/// Order of the next step and its length over that of this one: those of the largest step among the present order and its neighbours.
///
/// # Arguments
/// * `order` -- of this step
/// * `error` -- of this step
/// * `error_at` -- what it would have been at another order; infinite where that is not known
pub(super) fn choose(
    order: usize,
    error: f64,
    tolerance: f64,
    error_at: impl Fn(usize) -> f64,
) -> (usize, f64) {
    let factor = |error: f64, order: usize, safety: f64| {
        safety * (error / tolerance).max(1e-12).powf(-1.0 / (order as f64 + 1.0))
    };
    let mut best = (order, factor(error, order, SAFETY));
    for other in [order - 1, order + 1].into_iter().filter(|it| (1..=Bdf::HIGHEST_ORDER).contains(it)) {
        let found = factor(error_at(other), other, SAFETY_OF_CHANGE);
        if found > best.1 {
            best = (other, found);
        }
    }
    let [least, most] = CHANGES;
    (best.0, best.1.clamp(least, most))
}

/// Times before another, in `s`.
#[derive(Debug)]
pub(super) struct TimesBefore {
    /// `s_n - s_j`, the latest first.
    before: Vec<f64>,
    /// `dt/ds`, cycles.
    per_slope: f64,
}

impl TimesBefore {
    /// Those of a past before some number of cycles; negative where they are later.
    pub fn new(model: &Model, cycles: f64, past: &Past) -> Self {
        let early = if model.gross().is_some() { 1.0 } else { EARLY };
        let zero = early * model.cycles_of_wear();
        let elapsed = |before: f64| ((cycles - before) / (before + zero)).ln_1p();
        Self {
            before: past.points.iter().map(|point| elapsed(point.cycles)).collect(),
            per_slope: cycles + zero,
        }
    }

    /// `dt/ds`, cycles.
    pub fn per_slope(&self) -> f64 {
        self.per_slope
    }

    /// Cycles by which the rates at the end of a step of some order are multiplied.
    pub fn step(&self, order: usize) -> f64 {
        self.per_slope / self.leading(order)
    }

    /// `ℓ'_0(s_n)` at some order.
    fn leading(&self, order: usize) -> f64 {
        self.before[..order].iter().map(|elapsed| elapsed.recip()).sum()
    }

    /// `-ℓ'_j/ℓ'_0` at some order: what the past makes of the present.
    pub fn gathering(&self, order: usize) -> Vec<f64> {
        let leading = self.leading(order);
        let before = &self.before[..order];
        lagrange(before).iter().zip(before).map(|(weight, elapsed)| weight / (elapsed * leading)).collect()
    }

    /// What the polynomial of one order more than the step gives.
    pub fn guess(&self, past: &Past) -> PastPoint {
        PastPoint::sum(&self.leading_weights(past), &past.points)
    }

    /// Weights of the times before in that polynomial.
    fn leading_weights(&self, past: &Past) -> Vec<f64> {
        let count = (past.order + 1).min(self.before.len());
        lagrange(&self.before[..count])
    }

    /// Weights of the end of a step and of the times before it, the latest first, with which they sum to the error at some order; none where the past is
    /// too short.
    ///
    /// The error is from the divided difference of the next order: the distance of the step from the polynomial through the times before it, less that
    /// polynomial's own error.
    pub fn error_weights(&self, order: usize) -> Option<Vec<f64>> {
        let before = self.before.get(..order + 1)?;
        let part = 1.0 / (1.0 + self.leading(order) * before[order]);
        let mut weights: Vec<f64> = lagrange(before).iter().map(|weight| -part * weight).collect();
        weights.insert(0, part);
        Some(weights)
    }
}

/// Weights of the values at some times with which the polynomial through them passes zero.
fn lagrange(times: &[f64]) -> Vec<f64> {
    let weight = |j: usize| -> f64 {
        let others = times.iter().enumerate().filter(|(m, _)| *m != j);
        others.map(|(_, other)| other / (other - times[j])).product()
    };
    (0..times.len()).map(weight).collect()
}

/// The state at some cycles to which the polynomial through the times before leads; under both forces with the compression at the edge of stick on that
/// polynomial too: next to the edge slip is the small difference of both.
fn led(model: &Model, state: &State, times: &TimesBefore, past: &Past, cycles: f64) -> State {
    let mut at = state_of(state, times.guess(past), cycles);
    if let Some((bearing, stick)) = model.bearing_ahead(state).zip(state.stick.as_ref()) {
        let compression = |point: &PastPoint| {
            model.bearing_zone(&bearing, point.slip_area, &point.compression).slip_compression
        };
        let weights = times.leading_weights(past);
        let known = weights.iter().zip(&past.points).map(|(weight, point)| weight * compression(point)).sum();
        model.scale_to_bear(&bearing, known, at.slip_area, &mut at.compression);
        at.stick = Some(model.bearing_edge(&bearing, stick, at.slip_area, &at.compression));
    }
    at
}

/// A state at some cycles as a polynomial tells it.
pub(super) fn state_of(state: &State, point: PastPoint, cycles: f64) -> State {
    State {
        cycles,
        slip_area: point.slip_area,
        compression: point.compression,
        dissipated_energy: point.dissipated_energy,
        volume_by_rate: point.volume_by_rate,
        past: Past::default(),
        ..state.clone()
    }
}
