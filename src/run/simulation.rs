//! A scene simulated in memory: no file, no signal, nothing printed.

use std::collections::BTreeMap;

use super::anew::{Attempts, End};
use super::cost::{self, Expected};
use super::limit::header;
use super::onlookers::{Onlookers, Watcher};
use super::parts::Known;
use super::ready::Ready;
use super::recorder::{Detail, Recorder, snapshot};
use super::{Results, Shared, Stop};
use crate::contact::closed_form::LimitingShape;
use crate::data::{Attempt, Checkpoint, LimitDistance, RunHeader, RunWriter, Snapshot, StopReason};
use crate::error::Result;
use crate::scene::{Scene, Stepper};
use crate::solver::simulation::{self as stepping, Observer};

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
    pub(super) known: Known,
    pub(super) warning: Option<String>,
    pub(super) scene: Scene,
    pub(super) shared: Shared,
    pub(super) writer: RunWriter,
    /// Whether the file of the writer, if there is one, is to hold the result; else only checkpoints are written.
    pub(super) saves_result: bool,
    /// What is recorded at the outputs.
    pub(super) detail: Detail,
    pub(super) wall_seconds_before: f64,
    pub(super) attempt: Attempt,
    pub(super) watchers: Vec<Watcher<'a>>,
}

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
        let Ready { simulation: stepping, limit, known } = Ready::new(scene, &shared.operators)?;
        if scene.numerics().stepper == Stepper::Implicit {
            stepping.model().release_factors();
        }
        Ok(Self {
            writer: writer(header(scene, stepping.model(), limit.as_ref()))?,
            stepping,
            limit,
            known,
            warning: None,
            scene: scene.clone(),
            shared: shared.clone(),
            saves_result: true,
            detail: Detail::Whole,
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
    /// [`Error::NotConverged`](crate::Error::NotConverged) tells the moment from which the run cannot go on.
    pub fn run(self) -> Result<Results> {
        self.run_with(None)
    }

    /// Runs as [`Simulation::run`] does, and shows each step to an observer.
    ///
    /// # Errors
    /// As [`Simulation::run`]; those of the observer; where there is a file, [`Error::File`](crate::Error::File) if it cannot be written.
    #[doc(hidden)]
    pub fn run_with(self, observer: Option<&mut dyn Observer>) -> Result<Results> {
        let Self {
            stepping,
            limit,
            known,
            scene,
            shared,
            writer,
            saves_result,
            detail,
            wall_seconds_before,
            attempt,
            watchers,
            ..
        } = self;
        let mut recorder = Recorder::new(&scene, writer, wall_seconds_before, &shared);
        (recorder.saves_result, recorder.detail) = (saves_result, detail);
        recorder.attempt = attempt;
        let mut onlookers = Onlookers { watchers, observer };
        let attempts = Attempts {
            scene: &scene,
            store: &shared.operators,
            recorder: &mut recorder,
            known: BTreeMap::from([(attempt.kind(), known)]),
            stepping,
            limit,
            ended: None,
        };
        let End { stepping, limit, outcome, checkpoint } = attempts.run(&mut onlookers);
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
    let model = stepping.model();
    let indenter = model.contact().indenter().clone();
    let wears_locally = model.schedule().wears_locally();
    let (header, snapshots) = writer.into_parts();
    let distance = header.limit.as_ref().map(|limit| LimitDistance::new(limit, &last));
    Results { header, snapshots, checkpoint, stop_reason, last, limit, distance, indenter, wears_locally }
}
