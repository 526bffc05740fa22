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

/// Hand-overs of a run, of which there may be one after the other.
#[derive(Default)]
pub(super) struct Taking {
    /// Those to come, the next one last.
    ahead: Vec<HandOver>,
    next: Found,
    /// The models before, and the tolerance of their steps.
    before: Vec<(Model, f64)>,
}

/// The model that is to take a run up.
#[derive(Default)]
enum Found {
    #[default]
    Unasked,
    Missing,
    Ready(Box<Model>),
}

/// Whether the error goes by the springs of the mesh that takes the run up: in gross slip, where none sticks, it falls much faster with their number.
fn leaves_error_to_next(before: &Model) -> bool {
    before.gross().is_some_and(|gross| !gross.sticks())
}

impl Simulation {
    /// Lets other models take the run up, one after the other, see [`Model::is_taken_up`].
    #[must_use]
    pub fn handing_over(mut self, hand_overs: &[HandOver]) -> Self {
        self.taking.ahead = hand_overs.iter().rev().copied().collect();
        self
    }

    /// Goes on from a state after some hand-overs, as if there had been no interruption.
    ///
    /// # Arguments
    /// * `first` -- the model at the beginning, and the tolerance there
    /// * `hand_overs` -- those that are done
    ///
    /// # Errors
    /// [`Error::Inconsistent`] where no other model takes the run up; those of [`Model::taken_up`].
    pub fn resume_handed_over(
        first: (Model, f64),
        hand_overs: &[HandOver],
        plan: Plan,
        state: State,
        progress: Progress,
    ) -> Result<Self> {
        let ((mut model, mut tolerance), mut before) = (first, vec![]);
        for hand_over in hand_overs {
            let next = model.taken_up(hand_over.springs)?.ok_or_else(|| Error::Inconsistent {
                what: "loading",
                why: "no spring sticks again in this contact, and the last does not give way".into(),
            })?;
            before.push((std::mem::replace(&mut model, next), tolerance));
            tolerance = hand_over.tolerance;
        }
        let stepper = stepper::implicit(&model, tolerance);
        let resumed = Self::resume(model, stepper, tolerance, plan, state, progress);
        Ok(Self { taking: Taking { before, ..Taking::default() }, ..resumed })
    }

    /// The model that the run began with, and the tolerance of its steps.
    pub fn first(&self) -> (&Model, f64) {
        self.taking
            .before
            .first()
            .map_or((&self.model, self.tolerance), |(model, tolerance)| (model, *tolerance))
    }

    /// Whether springs have come to stick again.
    pub fn sticks_after_gross_slip(&self) -> bool {
        self.taking.before.last().is_some_and(|(before, _)| before.gross().is_some())
    }

    /// Springs over the slip annulus once springs stick again after gross slip, as far as a coarse run or this one tells; none where the error does not go by them.
    pub fn springs_to_stick_again(&self) -> Option<usize> {
        match self.taking.ahead.last() {
            Some(next) if next.expected && leaves_error_to_next(&self.model) => Some(next.springs),
            _ => self.errs_by_springs_that_stick_again().then(|| self.model.springs()),
        }
    }

    /// Whether springs have come to stick again that none did before, so that the error goes by them.
    pub fn errs_by_springs_that_stick_again(&self) -> bool {
        self.taking.before.first().is_some_and(|(first, _)| leaves_error_to_next(first))
    }

    /// Springs of the mesh by which the error goes: that which followed an edge of stick, if one did, or on which springs stuck first.
    pub fn springs(&self) -> usize {
        let (first, _) = self.first();
        if leaves_error_to_next(first) { self.model.springs() } else { first.springs() }
    }

    /// Lets the next model take the run up where springs stick again or the last of them give way.
    ///
    /// # Errors
    /// [`Error::NotConverged`] where it has to and does not.
    pub(super) fn hand_over(&mut self) -> Result<()> {
        if !self.taking.ahead.is_empty() && self.model.changes_over(&self.state) {
            self.take_up();
        }
        if self.model.is_left_at(self.state.cycles) {
            let why = "no contact that slides as a whole has the ground that partial slip has worn";
            return Err(self.stuck(why));
        }
        Ok(())
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
        let Some(hand_over) = self.taking.ahead.last() else { return false };
        if let Found::Unasked = self.taking.next {
            let model = self.model.taken_up(hand_over.springs).ok().flatten();
            self.taking.next = model.map_or(Found::Missing, |model| Found::Ready(Box::new(model)));
        }
        let Found::Ready(to) = &self.taking.next else { return false };
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
        let breaks = self.model.gross().is_none() && !self.model.comes_to_gross_slip();
        let let_go = breaks.then(|| self.moment_of_loss());
        let mut before = std::mem::replace(self, Self { let_go, ..taken_up });
        before.taking.ahead.pop();
        before.taking.before.push((before.model, before.tolerance));
        self.taking = Taking { next: Found::Unasked, ..before.taking };
        self.settles = settles;
        true
    }
}
