//! Implicit steps over many cycles: L-stable, adaptive, with the analytic Jacobian.

use super::contact::{MovingContact, RestingContact, Stages};
use super::newton::Newton;
use super::resting::Tried;
use super::tableau::ALEXANDER;
use super::{Stepper, Trial, relative_depth_error};
use crate::error::Result;
use crate::solver::model::{Model, State, StickEdge, StickTrial};

/// Change of the squared radius of stick, relative, to the side to which it was not taken to move, that a step in which it turns may make.
const TURNING: f64 = 1e-5;

/// The same over the tolerance, in steps that go to neither side as taken. Where blocks follow one another, the edge jumps to where the balance holds on the
/// profile of the springs, which the stages know to what the springs are off by.
const TURNING_OF_TOLERANCE: f64 = 0.3;

/// Singly diagonally implicit Runge-Kutta method of Alexander, whether the edge of stick rests or moves.
///
/// On an ordinary differential equation it is of order 3 with an estimate of order 2. Here the contact edge obeys a constraint whose
/// rate enters the equations (index 2), which costs a method of stage order one an order: the worn volume converges at order 2.
///
/// Each stage solves for the compressions, the contact edge and, where it moves, the edge of stick at once, with what the stages before
/// gathered; Newton's matrix is factorised once a step and serves all stages while it converges.
#[derive(Debug)]
pub struct Sdirk {
    tolerance: f64,
    newton: Newton,
    tried: Tried,
    stick_trial: StickTrial,
}

impl Sdirk {
    /// Tolerance of runs that only have to come to an end. From there on parts of corrections lead over kinks, and corrections are mixed that fall slowly; both may end beside the way on which smaller
    /// steps would go (docs/numerics.md).
    pub const COARSE: f64 = 1e-2;

    /// A stepper whose stages are solved well below the tolerance of the time stepping.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            newton: Newton::mixing(tolerance >= Self::COARSE),
            tried: Tried::default(),
            stick_trial: StickTrial::default(),
        }
    }

    /// A step in which the edge of stick moves to either side.
    fn moved(&mut self, model: &Model, state: &State, stick: &StickEdge, cycles: f64) -> Trial {
        let Self { tolerance, newton, stick_trial, .. } = self;
        let mut towards = |outwards: bool| {
            newton.outdate();
            step(MovingContact::new(model, state, stick, *tolerance, newton, stick_trial, outwards), cycles)
        };
        let outwards = model.goes_outwards(stick);
        let first = towards(outwards);
        let least = TURNING.max(TURNING_OF_TOLERANCE * *tolerance) * stick.area;
        let from = EdgeBefore { stick, per_height: model.area_per_height(stick), least };
        if !model.turns() || from.went(&first, outwards).is_ok() {
            return first;
        }
        from.turned(first, towards(!outwards), outwards)
    }
}

impl Stepper for Sdirk {
    fn name(&self) -> &'static str {
        "SDIRK of order 3"
    }

    fn step(&mut self, model: &Model, state: &State, cycles: f64) -> Result<Trial> {
        let Some(stick) = &state.stick else {
            let Self { tolerance, newton, tried, .. } = self;
            newton.outdate();
            return Ok(step(RestingContact::new(model, state, *tolerance, newton, tried), cycles));
        };
        let trial = self.moved(model, state, stick, cycles);
        let may = self.tolerance >= Self::COARSE && model.schedule().conditions().wear.has_kink();
        if trial.state.is_some() || !may {
            return Ok(trial);
        }
        self.newton.by_parts = true;
        let again = self.moved(model, state, stick, cycles);
        self.newton.by_parts = false;
        Ok(Trial { rate_evaluations: trial.rate_evaluations + again.rate_evaluations, ..again })
    }

    fn follows_stick(&self, _: &Model) -> bool {
        true
    }

    fn estimate_order(&self) -> f64 {
        3.0
    }
}

/// An edge of stick from which a step begins.
struct EdgeBefore<'a> {
    stick: &'a StickEdge,
    /// See [`Model::area_per_height`].
    per_height: f64,
    /// The most that it may go to the other side than it was taken to, m².
    least: f64,
}

impl EdgeBefore<'_> {
    /// Whether it went to the side to which it was taken to move; else by how much it went to the other, m².
    ///
    /// Outwards the ground that it meets rises. Where slip has grown much next to the edge, the equation there lets that stay where it is while the height falls.
    fn went(&self, trial: &Trial, outwards: bool) -> std::result::Result<(), f64> {
        let Some(now) = trial.state.as_ref().and_then(|state| state.stick.as_ref()) else {
            return Err(f64::INFINITY);
        };
        let fallen = self.per_height * (self.stick.depth - now.depth);
        match now.area - self.stick.area {
            _ if outwards && fallen > self.least => Err(fallen),
            moved if (moved >= 0.0) == outwards => Ok(()),
            moved => Err(moved.abs()),
        }
    }

    /// Of two steps, the first with the edge of stick taken to move to the side it went before, the one in which it went as was taken; or the first, if it
    /// turns just before its end.
    fn turned(&self, first: Trial, second: Trial, outwards: bool) -> Trial {
        let rate_evaluations = first.rate_evaluations + second.rate_evaluations;
        let back = |trial: &Trial, outwards: bool| self.went(trial, outwards).err().unwrap_or_default();
        let [of_first, of_second] = [back(&first, outwards), back(&second, !outwards)];
        if of_second == 0.0 || (of_second < of_first && of_second <= self.least) {
            Trial { rate_evaluations, ..second }
        } else if of_first <= self.least {
            Trial { rate_evaluations, ..first }
        } else {
            Trial::failed(rate_evaluations)
        }
    }
}

/// A step of `cycles` cycles, stage by stage.
fn step(mut contact: impl Stages, cycles: f64) -> Trial {
    let mut evaluations = 1;
    let start = contact.start();
    let mut slopes: Vec<Vec<f64>> = Vec::with_capacity(ALEXANDER.matrix.len());
    for (index, row) in ALEXANDER.matrix.into_iter().enumerate() {
        let gathered = contact.gathered(&start, &slopes, row, cycles);
        match contact.solve(index, gathered, cycles, &mut evaluations) {
            Some(found) => slopes.push(found),
            None => return Trial::failed(evaluations),
        }
    }
    let weights = ALEXANDER.matrix[ALEXANDER.matrix.len() - 1];
    let (model, fields) = contact.solved();
    let difference = |i: usize| -> f64 {
        let weights = weights.iter().zip(ALEXANDER.embedded);
        let parts = slopes.iter().zip(weights);
        parts.map(|(slopes, (weight, embedded))| cycles * (weight - embedded) * slopes[i]).sum()
    };
    let depths = (0..model.springs() - 1).map(|i| fields.slip_depth[i] * difference(i));
    let error = relative_depth_error(model, depths);
    let end = contact.gathered(&start, &slopes, weights, cycles);
    let state = contact.end(end, cycles);
    Trial { state: Some(state), fields: None, error, rate_evaluations: evaluations, next_step: None }
}
