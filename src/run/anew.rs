//! A run that is made anew: on more springs where its error is larger than was asked for, in finer steps where those do not help, on fewer where it takes too long or finds no end.

use std::collections::BTreeMap;
use std::mem;

use super::attempt::{
    FOR_AN_END, Kind, LAST_RESORT, ON_SPRINGS_THAT_STAY, REFINEMENTS, SPRINGS_THAT_STAY,
    springs_of_last_resort,
};
use super::budget::{self, Shares, TIGHTER, UNKNOWN};
use super::cost;
use super::limit::header;
use super::onlookers::Onlookers;
use super::parts::{Known, Parts, resolution};
use super::recorder::Recorder;
use crate::contact::closed_form::LimitingShape;
use crate::data::{Attempt, Checkpoint, Fineness, RunHeader, Snapshot};
use crate::error::{Error, Result};
use crate::scene::{Numerics, Scene, Stepper};
use crate::solver::model::{Model, MovingStick, OperatorStore};
use crate::solver::simulation::{Outcome, Simulation};

/// Estimated error of an attempt over that of a later one, below which the earlier stands.
const NEARER: f64 = 0.5;

/// A run, attempt by attempt; its recorder holds what the one under way counts as.
pub(super) struct Attempts<'a> {
    pub scene: &'a Scene,
    pub store: &'a OperatorStore,
    pub recorder: &'a mut Recorder,
    pub stepping: Simulation,
    pub limit: Option<LimitingShape>,
    /// Of attempts by their [kind](Attempt::kind).
    pub known: BTreeMap<Kind, Known>,
    /// That which ended and may be taken after all, if it was made in this process.
    pub ended: Option<Ended>,
}

/// An attempt that came to its end, while finer ones are made, and what it recorded.
pub(super) struct Ended {
    end: End,
    recorded: Recorded,
}

type Recorded = (RunHeader, Vec<Snapshot>);

/// An attempt at its start.
type Begun = (Attempt, Simulation, Option<LimitingShape>);

/// Where a run ended, and on which springs.
pub(super) struct End {
    pub stepping: Simulation,
    pub limit: Option<LimitingShape>,
    pub outcome: Result<Outcome>,
    pub checkpoint: Checkpoint,
}

/// An attempt that may take the place of another.
struct Anew {
    springs: usize,
    /// Whether it is made only on fewer springs than the one before: a mesh may need as many.
    on_fewer: bool,
    counted: Attempt,
}

impl Attempts<'_> {
    /// Runs until no other attempt follows.
    pub(super) fn run(mut self, onlookers: &mut Onlookers<'_, '_>) -> End {
        loop {
            let before = self.recorder.attempt.work;
            let limited = self.limit.is_some();
            let mut outcome =
                self.recorder.run(self.scene, self.store, &mut self.stepping, limited, onlookers);
            if self.recorder.would_take_too_long() {
                let instead = self.instead_of_too_long(before + self.recorder.work_of_left());
                if self.takes_up(&instead) {
                    continue;
                }
                outcome = self.recorder.go_on(&mut self.stepping, onlookers);
            }
            let work = before + cost::work_of(&self.stepping);
            if self.recorder.takes_too_long() {
                if self.takes_up(&self.after_too_long(work)) {
                    continue;
                }
                outcome = Err(self.stepping.takes_too_long());
            }
            let checkpoint = self.recorder.checkpoint(&self.stepping);
            let next = self.after(&outcome, &checkpoint, work);
            let ends = outcome.is_ok() && next.iter().any(|it| self.is_end_of(&it.counted));
            if let Some(again) = next.iter().find(|it| it.counted.ends_again())
                && let Some(ended) = self.ended.take()
            {
                return self.end_with(ended, again.counted, onlookers);
            }
            let Some(begun) = self.first_of(&next) else {
                let Self { stepping, limit, .. } = self;
                return End { stepping, limit, outcome, checkpoint };
            };
            let (stepping, limit, recorded) = self.take_up(begun);
            if ends {
                self.ended = Some(Ended { end: End { stepping, limit, outcome, checkpoint }, recorded });
            }
        }
    }

    /// Takes up the first of some attempts that begins; whether there is one.
    fn takes_up(&mut self, attempts: &[Anew]) -> bool {
        self.first_of(attempts).map(|begun| self.take_up(begun)).is_some()
    }

    fn first_of(&mut self, attempts: &[Anew]) -> Option<Begun> {
        attempts.iter().find_map(|it| self.begun(it))
    }

    /// Takes up an attempt; what the one before came to.
    fn take_up(
        &mut self,
        (counted, stepping, limit): Begun,
    ) -> (Simulation, Option<LimitingShape>, Recorded) {
        self.recorder.attempt = counted;
        let recorded = self.recorder.writer.restart(header(self.scene, stepping.model(), limit.as_ref()));
        (mem::replace(&mut self.stepping, stepping), mem::replace(&mut self.limit, limit), recorded)
    }

    /// Whether the attempt under way is the one that ended, as another counts.
    fn is_end_of(&self, counted: &Attempt) -> bool {
        let now = (self.springs() as u64, self.recorder.attempt.fineness);
        (counted.ended_on, counted.ended_with) == now
    }

    /// What that would come to which repeats an attempt, from memory.
    fn end_with(self, ended: Ended, counted: Attempt, onlookers: &mut Onlookers<'_, '_>) -> End {
        let Ended { mut end, recorded: (header, snapshots) } = ended;
        onlookers.again(&snapshots);
        self.recorder.attempt = counted;
        self.recorder.writer.restart(header);
        snapshots.into_iter().for_each(|it| self.recorder.writer.push(it));
        end.checkpoint = Checkpoint {
            attempt: counted,
            wall_seconds: self.recorder.wall_seconds(),
            error_estimate: Some(counted.ended_within),
            ..end.checkpoint
        };
        end
    }

    fn begun(&mut self, anew: &Anew) -> Option<Begun> {
        let Anew { springs, on_fewer, counted } = *anew;
        let kind = counted.kind();
        let known = self.known.get(&kind);
        let mut parts = Parts::of_attempt(self.scene, &counted, springs, known, self.store).ok()?;
        self.known.entry(kind).or_insert_with(|| Known::of(&parts));
        let limit = parts.limit.take();
        let stepping = parts.begin().ok()?;
        (!on_fewer || stepping.model().springs() < self.springs()).then_some((counted, stepping, limit))
    }

    /// Those with which this one began.
    fn springs(&self) -> usize {
        self.stepping.first().0.springs()
    }

    /// What follows on an attempt that its companions tell would take too long, after so much work: nothing where those on fewer springs found no end.
    fn instead_of_too_long(&self, work: u64) -> Vec<Anew> {
        let attempt = self.recorder.attempt;
        let fewer_find_none = attempt.refinements > 0 && !attempt.has_end();
        if fewer_find_none {
            return vec![];
        }
        self.coarser(attempt.refinements, work, self.recorder.is_far_too_long())
    }

    /// What follows on one that took too long.
    fn after_too_long(&self, work: u64) -> Vec<Anew> {
        if self.recorder.attempt.has_end() { vec![] } else { self.coarser(REFINEMENTS, work, false) }
    }

    /// On fewer springs where these take too long; on more where the contact may bear at its rim and this was the first attempt, and by the last resort where it was not.
    ///
    /// # Arguments
    /// * `refinements` -- as how many that counts, unless it is the last resort
    fn coarser(&self, refinements: u64, work: u64, far_too_long: bool) -> Vec<Anew> {
        if self.recorder.attempt.is_last_resort() {
            return vec![];
        }
        let (model, attempt) = (self.stepping.model(), self.recorder.attempt);
        if let Some(springs) = budget::enough_for_a_rim(model) {
            return match attempt.refinements {
                0 => vec![self.finer(springs, attempt.fineness, None, work)],
                _ => self.last_resort(work),
            };
        }
        // In gross slip the last resort has no fewer springs than these.
        if model.gross().is_none() && cost::is_nearly_spent(work) {
            return self.last_resort(work);
        }
        let fewer = cost::fewer(self.springs());
        let fewer = if far_too_long { fewer.map(|it| cost::fewer(it).unwrap_or(it)) } else { fewer };
        let on = |springs| {
            let fineness = self.as_coarse_as(springs);
            let counted = Attempt { refinements, fineness, work, ..Attempt::default() };
            Anew { springs, on_fewer: true, counted }
        };
        fewer.map(on).into_iter().collect()
    }

    /// Steps and substeps, where the program chooses them, that are as coarse as so many springs, fewer than these.
    fn as_coarse_as(&self, springs: usize) -> Fineness {
        let (model, tolerance) = self.stepping.first();
        let fewer = springs as f64 / self.springs() as f64;
        let mut fineness = self.recorder.attempt.fineness;
        if self.chooses_steps() {
            fineness.tolerance = budget::coarser_tolerance(tolerance, fewer, model);
        }
        if let Some(now) = self.chosen_substeps() {
            let cheapest = Numerics { accuracy: budget::CHEAPEST, ..*self.scene.numerics() };
            let least = resolution(self.scene, &cheapest).substeps.unwrap_or(now);
            fineness.substeps = budget::fewer_substeps(now, fewer, least) as u64;
        }
        fineness
    }

    /// What follows on an attempt that is over.
    fn after(&self, outcome: &Result<Outcome>, checkpoint: &Checkpoint, work: u64) -> Vec<Anew> {
        let attempt = self.recorder.attempt;
        let no_end = matches!(outcome, Err(Error::NotConverged { .. }));
        if no_end && attempt.may_end_again() {
            return vec![self.nearer_than_ended(work).unwrap_or_else(|| self.end_again(work))];
        }
        let error = checkpoint.error_estimate.unwrap_or(UNKNOWN);
        let ends = outcome.as_ref().is_ok_and(|it| *it != Outcome::Interrupted);
        if let Some(times) = self.more_tightly().filter(|_| ends) {
            let (_, tolerance) = self.stepping.first();
            let finer = Fineness { tolerance: times * tolerance, ..attempt.fineness };
            return vec![self.finer(self.springs(), finer, Some(error), work)];
        }
        if let Some((springs, fineness)) = self.more(outcome, checkpoint) {
            return vec![self.finer(springs, fineness, outcome.is_ok().then_some(error), work)];
        }
        if ends && self.was_nearer(error) && attempt.may_end_again() {
            return vec![self.end_again(work)];
        }
        if !(no_end && self.looks_for_an_end()) {
            return vec![];
        }
        match attempt.is_last_resort() {
            false => self.for_an_end(work),
            // Steps as coarse lead on from some places of the springs and not from others, or in far fewer.
            true => self.last_resort(work),
        }
    }

    /// Whether one before is to stand rather than this one, told to be off by `error`: it was within the accuracy and this is not, since of finer springs other radii are compared, or it was
    /// [much nearer](NEARER), or the only one of which an error is known.
    fn was_nearer(&self, error: f64) -> bool {
        let (attempt, accuracy) = (self.recorder.attempt, self.scene.numerics().accuracy);
        let within = self.ended_within();
        let much_nearer = within < if error < UNKNOWN { NEARER * error } else { UNKNOWN };
        attempt.has_end() && error > accuracy && (within <= accuracy || much_nearer)
    }

    /// Estimated error of the one before that came to its end, which is no less than what it is apart from this one.
    fn ended_within(&self) -> f64 {
        let apart = self.recorder.apart_from_ended(&self.stepping).unwrap_or(0.0);
        self.recorder.attempt.ended_within.max(apart)
    }

    /// Where a finer one than that which ended found no end: springs between both, or more in the steps of that which ended.
    fn nearer_than_ended(&self, work: u64) -> Option<Anew> {
        let (attempt, accuracy) = (self.recorder.attempt, self.scene.numerics().accuracy);
        let (ended_on, now) = (attempt.ended_on as f64, self.springs() as f64);
        let springs = if now > ended_on { (ended_on * now).sqrt() } else { budget::MORE * now };
        let springs = springs.ceil() as usize;
        let is_of_use = attempt.ended_within > accuracy && springs as f64 >= budget::MANY_MORE * ended_on;
        let is_allowed = is_of_use
            && springs <= budget::most_springs(self.stepping.first().0)
            && self.may_be_finer()
            && cost::allows(&self.stepping, springs, 1.0, attempt.work, false);
        is_allowed.then(|| self.finer(springs, attempt.ended_with, None, work))
    }

    /// Finer ones do not end, or know less of their error: that which did, once more, if it is not in memory any more.
    fn end_again(&self, work: u64) -> Anew {
        let before = self.recorder.attempt;
        let ended_within = self.ended_within();
        let counted = Attempt {
            refinements: REFINEMENTS + 1,
            fineness: before.ended_with,
            ended_within,
            work,
            ..before
        };
        Anew { springs: counted.ended_on as usize, on_fewer: false, counted }
    }

    /// # Arguments
    /// * `fineness` -- as [`Attempt::fineness`]
    /// * `error` -- estimated, of this attempt, if it came to its end
    fn finer(&self, springs: usize, fineness: Fineness, error: Option<f64>, work: u64) -> Anew {
        let now = self.recorder.attempt;
        let ended = match error {
            Some(error) if !self.was_nearer(error) => Attempt {
                ended_on: self.springs() as u64,
                ended_with: now.fineness,
                ended_within: error,
                ended_volume: self.recorder.wear_volume(),
                ..now
            },
            Some(_) => Attempt { ended_within: self.ended_within(), ..now },
            None => now,
        };
        let counted = Attempt { refinements: now.refinements + 1, fineness, work, ..ended };
        Anew { springs, on_fewer: false, counted }
    }

    /// Coarser ones may come to an end where this does not, and tell that nothing is known of the error.
    fn for_an_end(&self, work: u64) -> Vec<Anew> {
        let (begun, _) = self.stepping.first();
        let known = self.known.get(&Attempt::default().kind());
        let asked = Parts::new(self.scene, self.scene.numerics(), None, known, self.store).ok();
        let asked = asked.map(|parts| parts.model).filter(|it| it.springs() < begun.springs());
        let fewer = cost::fewer_for_an_end(asked.as_ref().unwrap_or(begun));
        let counted = Attempt { refinements: REFINEMENTS + 1, work, ..Attempt::default() };
        let fewer = fewer.filter(|_| !budget::may_bear_at_rim(begun));
        let fewer = fewer.map(|springs| Anew { springs, on_fewer: true, counted });
        fewer.into_iter().chain(self.last_resort(work)).collect()
    }

    /// In coarse steps, on those springs that have not been tried so; where a balance of forces moves the edge of stick, over springs that stay at last.
    fn last_resort(&self, work: u64) -> Vec<Anew> {
        let (attempt, first) = (self.recorder.attempt, self.stepping.first().0);
        let on = |springs: &[usize], from: u64, is_tried: bool| -> Vec<Anew> {
            let counted =
                Attempt { refinements: from.max(attempt.refinements + 1), work, ..Attempt::default() };
            let tried = match is_tried {
                true => 1 + springs.iter().take_while(|it| **it != self.springs()).count(),
                false => 0,
            };
            let left = springs.iter().skip(tried);
            left.map(|springs| Anew { springs: *springs, on_fewer: false, counted }).collect()
        };
        if attempt.is_on_springs_that_stay() {
            return on(&SPRINGS_THAT_STAY, ON_SPRINGS_THAT_STAY, true);
        }
        let springs = springs_of_last_resort(self.stepping.model());
        let mut all = on(springs, LAST_RESORT, attempt.is_last_resort());
        if first.moving().is_some_and(MovingStick::is_balanced) {
            all.extend(on(&SPRINGS_THAT_STAY, ON_SPRINGS_THAT_STAY, false));
        }
        all
    }

    /// Springs with which to repeat a run, and how finely, where the program chose the springs and the run found no end or may be off by more than was asked for.
    fn more(&self, outcome: &Result<Outcome>, checkpoint: &Checkpoint) -> Option<(usize, Fineness)> {
        let (simulation, attempt) = (&self.stepping, &self.recorder.attempt);
        let (accuracy, springs) = (self.scene.numerics().accuracy, simulation.springs());
        let companions = self.recorder.companions().filter(|_| self.may_be_finer())?;
        let alone = |springs: Option<usize>| springs.map(|it| (it, 1.0)).into_iter().collect();
        let wanted: Vec<(usize, f64)> = match outcome {
            Ok(Outcome::Interrupted) => vec![],
            // The companion of a finer run may come to an end.
            _ if companions.is_smooth() && companions.is_lost() => {
                alone(budget::refined(springs, None, accuracy))
            }
            Ok(_) if companions.is_smooth() => {
                alone(budget::refined(springs, checkpoint.error_estimate, accuracy))
            }
            Ok(_) => self.more_by_order(self.recorder.shares(simulation)?),
            // More springs may find an end where few do not.
            Err(Error::NotConverged { .. }) => alone(
                budget::enough_for_a_rim(simulation.model())
                    .or_else(|| budget::refined(springs, None, accuracy)),
            ),
            Err(_) => vec![],
        };
        let is_met = outcome.is_ok() && checkpoint.error_estimate.is_some_and(|error| error <= accuracy);
        let allowed = |(springs, times): &(usize, f64)| {
            cost::allows(simulation, *springs, *times, attempt.work, is_met)
        };
        let (wanted, times) = wanted.into_iter().find(allowed)?;
        let mut fineness = attempt.fineness;
        if let Some(now) = self.chosen_substeps().filter(|_| times > 1.0) {
            fineness.substeps = budget::more_substeps(now, times) as u64;
        }
        let goes_over = simulation.errs_by_springs_that_stick_again();
        Some((if goes_over { budget::springs_before(wanted) } else { wanted }, fineness))
    }

    /// The model whose mesh limits how many springs are of use: the last, or the first where all have as many.
    fn refined_model(&self) -> &Model {
        let (first, _) = self.stepping.first();
        if first.comes_to_gross_slip() { first } else { self.stepping.model() }
    }

    /// Springs that are wanted by the order that was observed, with how many times the substeps, the best first.
    fn more_by_order(&self, shares: Shares) -> Vec<(usize, f64)> {
        let (model, springs) = (self.refined_model(), self.stepping.springs());
        let accuracy = self.scene.numerics().accuracy;
        if model.schedule().takes_steps() {
            let wanted = budget::refined_by_order(springs, shares, accuracy, model);
            // Companions have fewer substeps in proportion.
            let known = shares.springs < UNKNOWN && self.chosen_substeps().is_some();
            let times = |wanted: usize| if known { wanted as f64 / springs as f64 } else { 1.0 };
            return wanted.into_iter().map(|it| (it, times(it))).collect();
        }
        let times = self.chosen_substeps().map_or(1.0, |now| budget::times_substeps(shares, accuracy, now));
        let wanted = budget::refined_by_order(springs, shares.with_substeps(times), accuracy, model);
        let only_substeps = (times > 1.0 && !shares.is_surely_within(accuracy)).then_some(springs);
        wanted.into_iter().chain(only_substeps).map(|it| (it, times)).collect()
    }

    /// Substeps of a period, where the program chooses them.
    fn chosen_substeps(&self) -> Option<usize> {
        let (scene, attempt) = (self.scene, &self.recorder.attempt);
        let by_hand = scene.numerics().substeps.is_some();
        resolution(scene, &attempt.numerics(scene)).substeps.filter(|_| !by_hand)
    }

    /// Whether the program chooses the steps by a tolerance of its own.
    fn chooses_steps(&self) -> bool {
        let numerics = self.scene.numerics();
        numerics.tolerance.is_none() && numerics.stepper != Stepper::EveryCycle
    }

    /// Whether a run may be repeated on other springs, or in other steps: the program chose the springs, and it is not a stick zone that is about to be lost.
    fn may_be_finer(&self) -> bool {
        let simulation = &self.stepping;
        let chosen = self.scene.numerics().springs.is_none();
        let has_end = simulation.outcome().is_some() || self.recorder.attempt.has_end();
        let most = if has_end { REFINEMENTS } else { FOR_AN_END };
        let again = self.recorder.attempt.refinements < most;
        chosen && again && !simulation.model().is_losing_stick(simulation.state())
    }

    /// Factor on the tolerance with which to repeat a run in finer steps, where the program chooses them: where an edge of stick moves they are tried before more springs, which take longer,
    /// elsewhere where more springs have not helped, so that it is the steps that companions differ by.
    fn more_tightly(&self) -> Option<f64> {
        let (numerics, attempt) = (self.scene.numerics(), self.recorder.attempt);
        if !(self.chooses_steps() && self.may_be_finer()) {
            return None;
        }
        let shares = self.recorder.shares(&self.stepping)?;
        let before = (attempt.ended_on as usize, attempt.ended_within);
        let ((first, _), accuracy) = (self.stepping.first(), numerics.accuracy);
        let springs = first.springs();
        let by_steps = first.gross().is_none() && budget::follows_edge(first);
        // Steps that are finer already than those of the attempt before did not help.
        let steps_may_help = attempt.knows_error() && attempt.fineness == attempt.ended_with;
        let times = match attempt.fineness.tolerance > 0.0 {
            false if by_steps => shares.by_steps(accuracy),
            _ if steps_may_help && shares.stand_still(springs, before, accuracy) => Some(TIGHTER),
            _ => None,
        };
        times.filter(|_| cost::allows(&self.stepping, springs, 1.0, attempt.work, false))
    }

    /// Whether a run that found no end may be made anew on fewer springs: the program chose them, and it is not a stick zone that is lost, or about to be.
    fn looks_for_an_end(&self) -> bool {
        let (model, state) = (self.stepping.model(), self.stepping.state());
        let chosen = self.scene.numerics().accuracy_asked().is_some();
        chosen && !model.loses_stick(state) && !model.is_losing_stick(state)
    }
}
