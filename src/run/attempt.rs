//! One of several attempts at a run, by its count: how it is made, and what it may take.

use std::cmp::Ordering;

use super::budget::{UNKNOWN, may_bear_at_rim};
use super::cost;
use crate::data::{Attempt, Fineness};
use crate::scene::{Numerics, Scene};
use crate::solver::model::Model;
use crate::solver::stepper::Sdirk;

/// How often a run is repeated on more springs or more finely: to be more accurate, and to find an end at all.
pub(super) const REFINEMENTS: u64 = 5;
pub(super) const FOR_AN_END: u64 = 3;

/// Attempts at a run, [`REFINEMENTS`] and one on fewer springs included, of which the last is made in coarse steps where all others found no end: it tells what
/// becomes of the contact, and that nothing is known of the error.
pub(super) const LAST_RESORT: u64 = REFINEMENTS + 2;

/// Substeps of a period that is sampled in that attempt.
const COARSE_SUBSTEPS: usize = 48;

/// The springs that it tries one after the other until there is an end: in gross slip, where cubics carry debris that spreads, where the contact may bear at its rim, and elsewhere, where a mesh from near the axis needs more.
const IN_GROSS_SLIP: &[usize] = &[10, 8];
const WHERE_DEBRIS_SPREADS: &[usize] = &[28, 10, 8];
const AT_RIM: &[usize] = &[80, 10, 8];
const ELSEWHERE: &[usize] = &[24, 48, 96, 60, 16];

/// Those of a model.
pub(super) fn springs_of_last_resort(model: &Model) -> &'static [usize] {
    match model.gross() {
        Some(_) if may_bear_at_rim(model) => AT_RIM,
        Some(_) if model.schedule().conditions().wear.spreading().is_some() => WHERE_DEBRIS_SPREADS,
        Some(_) => IN_GROSS_SLIP,
        None => ELSEWHERE,
    }
}

/// The first of those after these in which an edge of stick moves over springs that stay, and those springs.
pub(super) const ON_SPRINGS_THAT_STAY: u64 = LAST_RESORT + ELSEWHERE.len() as u64;
pub(super) const SPRINGS_THAT_STAY: [usize; 2] = [96, 60];

/// Parts of the work of a run that one on fewer springs may take: after one that took too long, and after those that found no end.
const OF_LAST_ATTEMPTS: [f64; 2] = [0.2, 0.05];

/// What decides the schedule of an attempt at a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Kind {
    /// As in [`Fineness::substeps`].
    substeps: u64,
    is_last_resort: bool,
    is_on_springs_that_stay: bool,
}

impl Attempt {
    /// Whether it is made in coarse steps, since no other found an end.
    pub(super) fn is_last_resort(&self) -> bool {
        self.refinements >= LAST_RESORT
    }

    /// Whether an edge of stick moves over springs that stay, since no other found an end.
    pub(super) fn is_on_springs_that_stay(&self) -> bool {
        self.refinements >= ON_SPRINGS_THAT_STAY
    }

    /// What those have in common that share a schedule.
    pub(super) fn kind(&self) -> Kind {
        Kind {
            substeps: self.fineness.substeps,
            is_last_resort: self.is_last_resort(),
            is_on_springs_that_stay: self.is_on_springs_that_stay(),
        }
    }

    /// Whether one before came to an end, so that it would do so again.
    pub(super) fn has_end(&self) -> bool {
        self.ended_on > 0
    }

    /// Whether it repeats one that came to its end, since finer ones did not, or know nothing of their error.
    pub(super) fn ends_again(&self) -> bool {
        self.refinements > REFINEMENTS && self.has_end()
    }

    /// Whether there is one to be repeated.
    pub(super) fn may_end_again(&self) -> bool {
        self.refinements <= REFINEMENTS && self.has_end()
    }

    /// Whether the error of one that came to its end is known.
    pub(super) fn knows_error(&self) -> bool {
        self.has_end() && self.ended_within < UNKNOWN
    }

    /// The numerics with which it is made.
    pub(super) fn numerics(&self, scene: &Scene) -> Numerics {
        let numerics = *scene.numerics();
        if !self.is_last_resort() {
            let Fineness { tolerance, substeps } = self.fineness;
            let (tightened, more) =
                ((tolerance > 0.0).then_some(tolerance), (substeps > 0).then_some(substeps));
            return Numerics {
                tolerance: tightened.or(numerics.tolerance),
                substeps: more.map(|it| it as usize).or(numerics.substeps),
                ..numerics
            };
        }
        let sampled = !scene.conditions().mode.is_tangential();
        let substeps = numerics.substeps.or(sampled.then_some(COARSE_SUBSTEPS));
        Numerics { tolerance: Some(Sdirk::COARSE), substeps, ..numerics }
    }

    /// The part of the work of a run that it may take.
    fn part_of_work(&self) -> f64 {
        let [after_long, after_no_end] = OF_LAST_ATTEMPTS;
        match self.refinements.cmp(&REFINEMENTS) {
            _ if self.has_end() => 1.0,
            Ordering::Less => 1.0,
            Ordering::Equal => after_long,
            Ordering::Greater => after_no_end,
        }
    }

    /// Most work of each of its companions.
    pub(super) fn most_work_of_companion(&self) -> f64 {
        self.part_of_work() * cost::work_of_companion(self.has_end())
    }

    /// Most work that it may take.
    ///
    /// # Arguments
    /// * `model` -- that with which it begins
    pub(super) fn most_work(&self, model: &Model) -> f64 {
        if self.is_last_resort() {
            return cost::work_of_last_resort(self.work, self.refinements > LAST_RESORT);
        }
        (self.part_of_work() * cost::most_work(model)).min(cost::work_left(self.work))
    }
}
