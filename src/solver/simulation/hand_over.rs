//! A contact in gross slip whose springs stick again, or one that comes to gross slip: another model and another stepper take the run up.

use super::{Plan, Progress, Simulation};
use crate::error::{Error, Result};
use crate::solver::model::{Model, State};
use crate::solver::stepper;

/// First step after a hand-over, over the cycles before, or over the step that was planned where the contact comes to gross slip.
const SETTLED_IN: f64 = 0.1;

/// First steps that are tried before a hand-over between blocks, each shorter by as much.
const FIRST_STEPS: i32 = 6;

/// How a run goes on once springs stick again after gross slip, or once the last of them slide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandOver {
    /// Springs on the other mesh.
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

/// Whether the error goes by the springs of the mesh that takes the run up: in gross slip, where none sticks, it falls much faster with their number.
fn leaves_error_to_next(before: &Model) -> bool {
    before.gross().is_some_and(|gross| !gross.sticks())
}

impl Simulation {
    /// Lets another model take the run up, see [`Model::is_taken_up`].
    #[must_use]
    pub fn handing_over(mut self, hand_over: Option<HandOver>) -> Self {
        self.taking = hand_over.map_or(Taking::Never, |it| Taking::Ahead(it, Found::Unasked));
        self
    }

    /// Goes on from a state after the hand-over, as if there had been no interruption.
    ///
    /// # Arguments
    /// * `first` -- the model before, and the tolerance there
    ///
    /// # Errors
    /// [`Error::Inconsistent`] where no other model takes the run up; those of [`Model::taken_up`].
    pub fn resume_handed_over(
        (first, before): (Model, f64),
        hand_over: HandOver,
        plan: Plan,
        state: State,
        progress: Progress,
    ) -> Result<Self> {
        let model = first.taken_up(hand_over.springs)?.ok_or_else(|| Error::Inconsistent {
            what: "loading",
            why: "no spring sticks again in this contact, and the last does not give way".into(),
        })?;
        let stepper = stepper::implicit(&model, hand_over.tolerance);
        let resumed = Self::resume(model, stepper, hand_over.tolerance, plan, state, progress);
        Ok(Self { taking: Taking::Done(Box::new(first), before), ..resumed })
    }

    /// The model that the run began with, and the tolerance of its steps.
    pub fn first(&self) -> (&Model, f64) {
        match &self.taking {
            Taking::Done(model, tolerance) => (model, *tolerance),
            _ => (&self.model, self.tolerance),
        }
    }

    /// Whether springs have come to stick again.
    pub fn sticks_after_gross_slip(&self) -> bool {
        matches!(&self.taking, Taking::Done(before, _) if before.gross().is_some())
    }

    /// Springs over the slip annulus once springs stick again after gross slip, as far as a coarse run or this one tells; none where the error does not go by them.
    pub fn springs_to_stick_again(&self) -> Option<usize> {
        match &self.taking {
            Taking::Ahead(hand_over, _) if hand_over.expected && leaves_error_to_next(&self.model) => {
                Some(hand_over.springs)
            }
            _ => self.errs_by_springs_that_stick_again().then(|| self.model.springs()),
        }
    }

    /// Whether springs have come to stick again that none did before, so that the error goes by them.
    pub fn errs_by_springs_that_stick_again(&self) -> bool {
        matches!(&self.taking, Taking::Done(before, _) if leaves_error_to_next(before))
    }

    /// Springs of the mesh by which the error goes: that which followed an edge of stick, if one did, or on which springs stuck first.
    pub fn springs(&self) -> usize {
        match &self.taking {
            Taking::Done(before, _) if !leaves_error_to_next(before) => before.springs(),
            _ => self.model.springs(),
        }
    }

    /// Lets the other model take the run up where springs stick again or the last of them give way.
    pub(super) fn hand_over(&mut self) {
        if matches!(self.taking, Taking::Ahead(..)) && self.model.changes_over(&self.state) {
            self.take_up();
        }
    }

    /// Whether some first step leads on.
    fn leads_on(&mut self) -> bool {
        let lengths = (0..FIRST_STEPS).map(|i| self.progress.next_step * SETTLED_IN.powi(i));
        let found = lengths.into_iter().any(|cycles| {
            let tried = self.stepper.step(&self.model, &self.state, cycles);
            tried.is_ok_and(|trial| trial.state.is_some())
        });
        self.stepper.forget();
        found
    }

    /// Lets the other model take the run up; whether there is one.
    pub(super) fn take_up(&mut self) -> bool {
        let Taking::Ahead(hand_over, found) = &mut self.taking else { return false };
        if let Found::Unasked = found {
            let model = self.model.taken_up(hand_over.springs).ok().flatten();
            *found = model.map_or(Found::Missing, |model| Found::Ready(Box::new(model)));
        }
        let Found::Ready(to) = found else { return false };
        let Some(state) = self.model.hand_over(&self.state, to) else { return false };
        let (model, tolerance) = ((**to).clone(), hand_over.tolerance);
        // The finer mesh holds modes that the polynomials over the whole contact do not. What is left in them decays in one implicit step; the shorter that is, the
        // less its error falls.
        let settles = model.gross().is_none();
        let most = SETTLED_IN * if settles { state.cycles } else { self.progress.next_step };
        let progress = Progress { next_step: self.progress.next_step.min(most), ..self.progress };
        let (stepper, plan) = (stepper::implicit(&model, tolerance), self.plan.clone());
        let mut taken_up = Self::resume(model, stepper, tolerance, plan, state, progress);
        if self.model.takes_up_in_blocks() && !taken_up.leads_on() {
            return false;
        }
        let let_go = self.model.gross().is_none().then(|| self.moment_of_loss());
        let before = std::mem::replace(self, Self { let_go, ..taken_up });
        self.taking = Taking::Done(Box::new(before.model), before.tolerance);
        self.settles = settles;
        true
    }
}
