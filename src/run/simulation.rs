//! A scene simulated in memory: no file, no signal, nothing printed.

use super::budget;
use super::cost::{self, Expected};
use super::limit::header;
use super::parts::Parts;
use super::ready::Ready;
use super::recorder::{Recorder, snapshot};
use super::{Results, Shared, Stop};
use crate::contact::closed_form::LimitingShape;
use crate::data::{Attempt, Checkpoint, LimitDistance, RunHeader, RunWriter, Snapshot, StopReason};
use crate::error::{Error, Result};
use crate::scene::{Scene, Stepper};
use crate::solver::simulation::{self as stepping, Flow, Observer, Outcome};

/// A scene that is ready to be simulated, with whoever looks on.
///
/// ```
/// # let scene: fretwear::Scene = include_str!("../../data/scenes/paraboloid.toml").parse()?;
/// let (stop, mut seen) = (fretwear::Stop::default(), vec![]);
/// let results = fretwear::Simulation::new(&scene)?
///     .stopped_by(&stop)
///     .on_snapshot(|snapshot| {
///         seen.push(snapshot.wear_volume);
///         if seen.len() == 10 {
///             stop.stop();
///         }
///     })
///     .run()?;
/// assert!(!results.is_complete() && results.worn_volume() == seen);
/// # Ok::<(), fretwear::Error>(())
/// ```
pub struct Simulation<'a> {
    pub(super) stepping: stepping::Simulation,
    pub(super) limit: Option<LimitingShape>,
    pub(super) warning: Option<String>,
    pub(super) scene: Scene,
    pub(super) shared: Shared,
    pub(super) writer: RunWriter,
    /// Whether the file of the writer, if there is one, is to hold the result; else only checkpoints are written.
    pub(super) saves_result: bool,
    pub(super) wall_seconds_before: f64,
    pub(super) attempt: Attempt,
    pub(super) watchers: Vec<Watcher<'a>>,
}

/// Called at each snapshot.
type Watcher<'a> = Box<dyn FnMut(&Snapshot) + 'a>;

impl Scene {
    /// Simulates the scene from its first cycle to its end, in memory.
    ///
    /// # Errors
    /// As [`Simulation::new`] and [`Simulation::run`].
    pub fn simulate(&self) -> Result<Results> {
        Simulation::new(self)?.run()
    }
}

impl<'a> Simulation<'a> {
    /// Prepares a scene: mesh, transforms, the unworn contact.
    ///
    /// # Errors
    /// Those of the physics where in the scene nothing slips, or it needs more memory than there is. Each names a key of the scene.
    pub fn new(scene: &Scene) -> Result<Self> {
        Ok(Self::sharing(scene, &Shared::default())?.warned())
    }

    /// With a word about what it will take, where that is long.
    pub(super) fn warned(mut self) -> Self {
        self.warning = cost::expected(self.scene.numerics().stepper, &mut self.stepping).warning;
        self
    }

    /// Prepares one scene of many, whose cost nobody asks for.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn sharing(scene: &Scene, shared: &Shared) -> Result<Self> {
        Self::begin(scene, shared, |header| Ok(RunWriter::in_memory(header)))
    }

    pub(super) fn begin(
        scene: &Scene,
        shared: &Shared,
        writer: impl FnOnce(RunHeader) -> Result<RunWriter>,
    ) -> Result<Self> {
        let Ready { simulation: stepping, limit } = Ready::new(scene, &shared.operators)?;
        if scene.numerics().stepper == Stepper::Implicit {
            stepping.model().release_factors();
        }
        Ok(Self {
            writer: writer(header(scene, stepping.model(), limit.as_ref()))?,
            stepping,
            limit,
            warning: None,
            scene: scene.clone(),
            shared: shared.clone(),
            saves_result: true,
            wall_seconds_before: 0.0,
            attempt: Attempt::default(),
            watchers: vec![],
        })
    }

    /// Refuses what [`Simulation::new`] refuses, with the same words; else what the run will take.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub fn check(scene: &Scene) -> Result<Expected> {
        let mut ready = Ready::new(scene, &Shared::default().operators)?;
        Ok(cost::expected(scene.numerics().stepper, &mut ready.simulation))
    }

    /// Stops at the next step once the token says so; the results are then those up to there.
    #[must_use]
    pub fn stopped_by(mut self, stop: &Stop) -> Self {
        self.shared.stop = stop.clone();
        self
    }

    /// Calls back at each snapshot, the unworn contact first.
    ///
    /// A run whose error turns out larger than was asked for is made anew on more springs, and its snapshots come again from the unworn
    /// contact on.
    #[must_use]
    pub fn on_snapshot(mut self, watcher: impl FnMut(&Snapshot) + 'a) -> Self {
        self.watchers.push(Box::new(watcher));
        self
    }

    /// A word about a run that will take long, where that is known beforehand.
    pub fn warning(&self) -> Option<&str> {
        self.warning.as_deref()
    }

    /// The loop over cycles, at its start or where it goes on.
    #[doc(hidden)]
    pub fn stepping(&self) -> &stepping::Simulation {
        &self.stepping
    }

    /// Runs to the end, or until it is stopped.
    ///
    /// # Errors
    /// [`Error::NotConverged`] tells the moment from which the run cannot go on.
    pub fn run(self) -> Result<Results> {
        self.run_with(None)
    }

    /// Runs as [`Simulation::run`] does, and shows each step to an observer.
    ///
    /// # Errors
    /// As [`Simulation::run`]; those of the observer; where there is a file, [`Error::File`] if it cannot be written.
    #[doc(hidden)]
    pub fn run_with(self, observer: Option<&mut dyn Observer>) -> Result<Results> {
        let Self {
            stepping,
            limit,
            scene,
            shared,
            writer,
            saves_result,
            wall_seconds_before,
            attempt,
            watchers,
            ..
        } = self;
        let mut recorder = Recorder::new(&scene, writer, wall_seconds_before, &shared);
        recorder.saves_result = saves_result;
        recorder.attempt = attempt;
        let mut onlookers = Onlookers { watchers, observer };
        let end = to_the_end(stepping, limit, &scene, &shared, &mut recorder, &mut onlookers);
        let End { stepping, limit, outcome, checkpoint } = end;
        let stop_reason = outcome.as_ref().map_or(StopReason::Interrupted, |outcome| (*outcome).into());
        let complete = stop_reason != StopReason::Interrupted;
        if recorder.saves(complete, outcome.is_err()) {
            recorder.writer.save(&checkpoint, stop_reason, complete)?;
        }
        outcome?;
        Ok(results(&stepping, limit, recorder.writer, checkpoint, stop_reason))
    }

    /// What a run that has been restored from this checkpoint came to.
    #[cfg(feature = "hdf5")]
    pub(super) fn so_far(self, checkpoint: Checkpoint) -> Results {
        results(&self.stepping, self.limit, self.writer, checkpoint, StopReason::Interrupted)
    }
}

fn results(
    stepping: &stepping::Simulation,
    limit: Option<LimitingShape>,
    writer: RunWriter,
    checkpoint: Checkpoint,
    stop_reason: StopReason,
) -> Results {
    let last = snapshot(stepping);
    let indenter = stepping.model().contact().indenter().clone();
    let (header, snapshots) = writer.into_parts();
    let distance = header.limit.as_ref().map(|limit| LimitDistance::new(limit, &last));
    Results { header, snapshots, checkpoint, stop_reason, last, limit, distance, indenter }
}

/// Where a run ended, and on which springs.
struct End {
    stepping: stepping::Simulation,
    limit: Option<LimitingShape>,
    outcome: Result<Outcome>,
    checkpoint: Checkpoint,
}

/// Runs to the end, and anew on more springs as long as the error is larger than was asked for.
fn to_the_end(
    mut stepping: stepping::Simulation,
    mut limit: Option<LimitingShape>,
    scene: &Scene,
    shared: &Shared,
    recorder: &mut Recorder,
    onlookers: &mut Onlookers,
) -> End {
    let store = &shared.operators;
    loop {
        let known = stepping.model().schedule().clone();
        let made = |springs: usize, refinements: u64| {
            let numerics = budget::numerics_of(scene, refinements);
            let known = (refinements < budget::LAST_RESORT).then_some(&known);
            let mut parts = Parts::new(scene, &numerics, Some(springs), known, store)?;
            let limit = parts.limit.take();
            Ok::<_, Error>((parts.begin()?, limit))
        };
        let anew = |springs: usize| made(springs, 0);
        let is_last = recorder.attempt.refinements >= budget::LAST_RESORT;
        let last_resort = |stepping: &stepping::Simulation, tried: Option<usize>| {
            let springs = budget::SPRINGS_OF_LAST_RESORT[usize::from(stepping.model().gross().is_none())];
            let next = tried.map_or(0, |tried| 1 + springs.iter().take_while(|it| **it != tried).count());
            springs.iter().skip(next).find_map(|springs| made(*springs, budget::LAST_RESORT).ok())
        };
        // On fewer springs where these take too long; a mesh may need as many.
        let coarser = |stepping: &stepping::Simulation, work: u64, far_too_long: bool| {
            if is_last {
                return None;
            }
            // In gross slip the last resort has no fewer springs than these.
            if stepping.model().gross().is_none() && (far_too_long || cost::is_nearly_spent(work)) {
                return last_resort(stepping, None).map(|found| (found, budget::LAST_RESORT));
            }
            let springs = stepping.first().0.springs();
            let coarser = cost::fewer(springs).and_then(|fewer| anew(fewer).ok());
            let coarser = coarser.filter(|(coarser, _)| coarser.model().springs() < springs);
            coarser.map(|found| (found, budget::REFINEMENTS))
        };
        let ended_on = recorder.attempt.ended_on as usize;
        let first = ended_on == 0;
        let mut outcome = recorder.run(scene, store, &mut stepping, limit.is_some(), first, onlookers);
        if recorder.would_take_too_long() {
            let work = recorder.attempt.work + recorder.work_of_left();
            if let Some((found, refinements)) = coarser(&stepping, work, recorder.is_far_too_long()) {
                (stepping, limit) = found;
                if refinements == budget::LAST_RESORT {
                    recorder.attempt.refinements = refinements;
                }
                recorder.attempt.work = work;
                recorder.writer.restart(header(scene, stepping.model(), limit.as_ref()));
                continue;
            }
            outcome = recorder.go_on(&mut stepping, onlookers);
        }
        let work = cost::work_of(&stepping);
        if recorder.takes_too_long() {
            let spent = recorder.attempt.work + work;
            if let Some((found, refinements)) =
                (ended_on == 0).then(|| coarser(&stepping, spent, false)).flatten()
            {
                (stepping, limit) = found;
                recorder.writer.restart(header(scene, stepping.model(), limit.as_ref()));
                recorder.attempt.refinements = refinements;
                recorder.attempt.work = spent;
                continue;
            }
            outcome = Err(stepping.takes_too_long());
        }
        let checkpoint = recorder.checkpoint(&stepping);
        let no_end = matches!(outcome, Err(Error::NotConverged { .. }));
        let more = match recorder.attempt.refinements < budget::REFINEMENTS {
            true => recorder.more_springs(scene, &stepping, &outcome, &checkpoint),
            false => None,
        };
        let mut ends_again = false;
        let found = match more {
            // Finer ones do not end: that which did, once more.
            _ if no_end && ended_on > 0 && !recorder.has_ended_before() => {
                recorder.attempt.refinements = budget::REFINEMENTS;
                ends_again = true;
                anew(ended_on).ok()
            }
            // Coarser ones may, and tell that nothing is known of the error.
            None if no_end && !is_last && recorder.looks_for_an_end(&stepping) => {
                recorder.attempt.refinements = budget::REFINEMENTS;
                let first = Parts::new(scene, scene.numerics(), None, Some(&known), store).ok();
                let (begun, _) = stepping.first();
                let springs = begun.springs();
                let first = first.map(|parts| parts.model).filter(|it| it.springs() < springs);
                let fewer = cost::fewer_for_an_end(first.as_ref().unwrap_or(begun));
                // A mesh may need as many.
                let coarser = fewer.and_then(|it| anew(it).ok());
                coarser.filter(|(coarser, _)| coarser.model().springs() < springs).or_else(|| {
                    recorder.attempt.refinements = budget::LAST_RESORT - 1;
                    last_resort(&stepping, None)
                })
            }
            // Steps as coarse lead on from some places of the springs and not from others.
            None if no_end
                && is_last
                && !recorder.takes_too_long()
                && recorder.looks_for_an_end(&stepping) =>
            {
                last_resort(&stepping, Some(stepping.first().0.springs()))
            }
            more => more.and_then(|springs| anew(springs).ok()),
        };
        if let Some(found) = found {
            recorder.attempt = Attempt {
                refinements: recorder.attempt.refinements + 1,
                ended_on: match outcome {
                    _ if ends_again => ended_on as u64,
                    Ok(_) => stepping.first().0.springs() as u64,
                    Err(_) => 0,
                },
                work: recorder.attempt.work + work,
            };
            (stepping, limit) = found;
            recorder.writer.restart(header(scene, stepping.model(), limit.as_ref()));
            continue;
        }
        return End { stepping, limit, outcome, checkpoint };
    }
}

/// Whoever looks on besides the recorder.
struct Onlookers<'a, 'b> {
    watchers: Vec<Watcher<'a>>,
    observer: Option<&'b mut dyn Observer>,
}

impl Observer for Onlookers<'_, '_> {
    fn output(&mut self, simulation: &stepping::Simulation) -> Result<()> {
        if !self.watchers.is_empty() {
            let shown = snapshot(simulation);
            self.watchers.iter_mut().for_each(|watcher| watcher(&shown));
        }
        self.observer.as_mut().map_or(Ok(()), |observer| observer.output(simulation))
    }

    fn step(&mut self, simulation: &stepping::Simulation) -> Result<Flow> {
        self.observer.as_mut().map_or(Ok(Flow::Continue), |observer| observer.step(simulation))
    }
}
