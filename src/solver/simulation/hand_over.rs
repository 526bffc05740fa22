//! A contact in gross slip whose springs stick again: another model and another stepper take the run up.

use super::{Plan, Progress, Simulation};
use crate::error::{Error, Result};
use crate::solver::model::{Model, State};
use crate::solver::stepper::Sdirk;

/// First step after a hand-over, over the cycles before.
const SETTLED_IN: f64 = 0.1;

/// How a run goes on once springs stick again after gross slip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandOver {
    /// Springs over the slip annulus.
    pub springs: usize,
    /// Largest error of one step there, as [`Simulation::new`].
    pub tolerance: f64,
    /// Whether a coarse run has come to it.
    pub expected: bool,
}

/// What took part in a hand-over.
pub(super) enum Taking {
    /// None is followed.
    Never,
    /// Not yet.
    Ahead(HandOver, Found),
    /// The model and the tolerance before.
    Done(Box<Model>, f64),
}

/// The model that is to take a run up.
pub(super) enum Found {
    Unasked,
    Missing,
    Ready(Box<Model>),
}

impl Simulation {
    /// Lets another model take the run up once springs stick again after gross slip, where that is followed.
    #[must_use]
    pub fn handing_over(mut self, hand_over: Option<HandOver>) -> Self {
        self.taking = hand_over.map_or(Taking::Never, |it| Taking::Ahead(it, Found::Unasked));
        self
    }

    /// Goes on from a state after the hand-over, as if there had been no interruption.
    ///
    /// # Arguments
    /// * `gross` -- the model in gross slip, and the tolerance there
    ///
    /// # Errors
    /// [`Error::Inconsistent`] where springs do not stick again; those of [`Model::sticking_again`].
    pub fn resume_handed_over(
        (gross, before): (Model, f64),
        hand_over: HandOver,
        plan: Plan,
        state: State,
        progress: Progress,
    ) -> Result<Self> {
        let model = gross.sticking_again(hand_over.springs)?.ok_or_else(|| Error::Inconsistent {
            what: "loading",
            why: "no spring sticks again in this contact".into(),
        })?;
        let stepper = Box::new(Sdirk::new(hand_over.tolerance));
        let resumed = Self::resume(model, stepper, hand_over.tolerance, plan, state, progress);
        Ok(Self { taking: Taking::Done(Box::new(gross), before), ..resumed })
    }

    /// The model that the run began with, and the tolerance of its steps.
    pub fn first(&self) -> (&Model, f64) {
        match &self.taking {
            Taking::Done(model, tolerance) => (model, *tolerance),
            _ => (&self.model, self.tolerance),
        }
    }

    /// Whether another model has taken the run up.
    pub fn is_handed_over(&self) -> bool {
        matches!(self.taking, Taking::Done(..))
    }

    /// Whether springs stick again after gross slip, as far as a coarse run or this one tells.
    pub fn sticks_again(&self) -> bool {
        match &self.taking {
            Taking::Never => false,
            Taking::Ahead(hand_over, _) => hand_over.expected,
            Taking::Done(..) => true,
        }
    }

    /// Lets the other model take the run up if springs stick again.
    pub(super) fn hand_over(&mut self) {
        let Taking::Ahead(hand_over, found) = &mut self.taking else { return };
        if !self.model.sticks_again(&self.state) {
            return;
        }
        if let Found::Unasked = found {
            let model = self.model.sticking_again(hand_over.springs).ok().flatten();
            *found = model.map_or(Found::Missing, |model| Found::Ready(Box::new(model)));
        }
        let Found::Ready(to) = found else { return };
        let Some(state) = self.model.hand_over(&self.state, to) else { return };
        let (model, tolerance) = ((**to).clone(), hand_over.tolerance);
        // The finer mesh holds modes that the polynomials over the whole contact do not. What is left in them decays in one implicit step; the shorter that is, the
        // less its error falls.
        let next_step = self.progress.next_step.min(SETTLED_IN * state.cycles);
        let progress = Progress { next_step, ..self.progress };
        let (stepper, plan) = (Box::new(Sdirk::new(tolerance)), self.plan.clone());
        let taken_up = Self::resume(model, stepper, tolerance, plan, state, progress);
        let before = std::mem::replace(self, taken_up);
        self.taking = Taking::Done(Box::new(before.model), before.tolerance);
        self.settles = true;
    }
}
