//! Methods that carry a state over cycles; each in its own file behind one trait.

mod bdf;
mod contact;
mod cycle_jump;
mod every_cycle;
mod gross;
mod mixing;
mod moving;
mod newton;
mod resting;
mod sdirk;
mod tableau;

pub use bdf::Bdf;
pub use cycle_jump::CycleJump;
pub use every_cycle::EveryCycle;
pub use gross::{GrossBdf, GrossSdirk};
pub use sdirk::Sdirk;

use crate::error::{Error, Result};
use crate::solver::model::{Fields, Model, State};

/// A step that was tried; accepting it is an assignment, so a failed one changes nothing.
#[derive(Debug, Clone)]
pub struct Trial {
    /// The state after the step, `None` if no contact was found.
    pub state: Option<State>,
    /// The fields of that state, where the method has them.
    pub fields: Option<Fields>,
    /// Estimated error of the step in the wear depth, relative to the largest depth of the limit.
    pub error: f64,
    /// Evaluations of pressure, slip and wear that the trial took.
    pub rate_evaluations: u64,
    /// The step that the method wants next, cycles, where it does not leave that to the error.
    pub next_step: Option<f64>,
}

impl Trial {
    /// A trial over a time in which nothing wears.
    pub fn at_rest(state: State) -> Self {
        Self { state: Some(state), fields: None, error: 0.0, rate_evaluations: 0, next_step: None }
    }

    /// A trial that found no state.
    pub fn failed(rate_evaluations: u64) -> Self {
        Self { state: None, fields: None, error: f64::INFINITY, rate_evaluations, next_step: None }
    }
}

/// The implicit method for a model.
pub fn implicit(model: &Model, tolerance: f64) -> Box<dyn Stepper + Send> {
    match model.gross() {
        Some(_) if model.schedule().is_smooth_in_gross_slip() => Box::new(GrossBdf::new(tolerance)),
        Some(_) => Box::new(GrossSdirk::new(tolerance)),
        None if model.wears_steadily() => Box::new(Bdf::new(tolerance)),
        None => Box::new(Sdirk::new(tolerance)),
    }
}

/// Growth of the slip in the first step that is tried, where a method has no reason for another.
const FIRST_GROWTH: f64 = 1e-3;

/// A method of time stepping.
pub trait Stepper {
    /// What the method is called.
    fn name(&self) -> &'static str;

    /// Tries a step of `cycles` cycles from a state.
    ///
    /// # Errors
    /// Only what no smaller step can cure.
    fn step(&mut self, model: &Model, state: &State, cycles: f64) -> Result<Trial>;

    /// Growth of the slip in the first step of a run.
    fn first_growth(&self) -> f64 {
        FIRST_GROWTH
    }

    /// Forgets the steps made so far, as far as the next one depends on more of them than its state.
    fn forget(&mut self) {}

    /// Order of the error estimate in the step, for the choice of the next one.
    fn estimate_order(&self) -> f64;

    /// Whether it follows an edge of stick that moves, or the compression at one under forces that are held.
    fn follows_stick(&self, _model: &Model) -> bool {
        false
    }

    /// Whether it steps contacts on the mesh of gross slip, and no others.
    fn steps_gross_slip(&self) -> bool {
        false
    }

    /// Whether states within a step are known as well as that at its end, see [`Stepper::between`]; else steps have to land where they are wanted.
    fn interpolates(&self) -> bool {
        false
    }

    /// The state at a time within the last step.
    fn between(&self, model: &Model, state: &State, cycles: f64) -> Option<State> {
        let _ = (model, state, cycles);
        None
    }

    /// The step that is prescribed, if the method does not choose it by its error.
    fn prescribed_step(&self) -> Option<f64> {
        None
    }
}

/// Refuses a method that does not follow the edge of stick of a model that moves, or is not that of its mesh.
pub(crate) fn check_model(stepper: &dyn Stepper, model: &Model) -> Result<()> {
    if stepper.steps_gross_slip() != model.gross().is_some() {
        let why =
            "does not step the mesh of this contact; GrossBdf and GrossSdirk step those in gross slip, and no others"
                .into();
        return Err(Error::Inconsistent { what: "numerics.stepper", why });
    }
    if stepper.follows_stick(model) || model.moving().is_none() {
        return Ok(());
    }
    Err(Error::Inconsistent {
        what: "numerics.stepper",
        why: "does not follow the edge of stick of this contact, which moves; step it by Sdirk".into(),
    })
}

/// Largest of some errors of the wear depth, m, over the largest depth of the limit.
fn relative_depth_error(model: &Model, depths: impl Iterator<Item = f64>) -> f64 {
    depths.fold(0.0, |largest: f64, depth| largest.max(depth.abs())) / model.depth_scale()
}
