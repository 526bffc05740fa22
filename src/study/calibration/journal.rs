//! What is kept of the runs until a calibration is done, so that one that was stopped goes on with the same command.

use std::path::Path;
use std::time::Duration;

use crate::data::{Scratch, failure};
use crate::error::Result;
use crate::run::{Results, Resumed, Run, Shared, Simulation, Stop, hash_of};
use crate::scene::Scene;

/// What the directory of runs is for.
const PURPOSE: &str = "runs of a calibration";
/// Wall time after which a long run leaves a checkpoint.
const CHECKPOINTS: Duration = Duration::from_secs(30);

/// A directory of runs that are done, each under the hash of all that it was computed from. It goes with this.
pub(super) struct Journal(Scratch);

impl Journal {
    /// The one that a stopped or killed call left in a folder, or a new one.
    pub(super) fn take_up(folder: &Path) -> Result<Self> {
        Scratch::take_up(folder, PURPOSE).map(Self).map_err(|error| failure(folder, &error))
    }

    /// Leaves the runs for the next call.
    pub(super) fn keep(self) {
        self.0.keep();
    }
}

/// Runs scenes, or finds them done.
#[derive(Clone)]
pub(super) struct Runs<'a> {
    shared: Shared,
    journal: Option<&'a Journal>,
}

impl<'a> Runs<'a> {
    pub(super) fn new(stop: &Stop, journal: Option<&'a Journal>) -> Self {
        let shared = Shared::without_checkpoints(stop);
        let interval = journal.map_or(shared.checkpoint_interval, |_| Some(CHECKPOINTS));
        Self { shared: Shared { checkpoint_interval: interval, ..shared }, journal }
    }

    pub(super) fn is_stopped(&self) -> bool {
        self.shared.stop.is_stopped()
    }

    /// The run of a scene, not complete if it was stopped.
    ///
    /// # Errors
    /// Those of the run; [`Error::File`](crate::Error::File) if what is to be kept cannot be written.
    pub(super) fn run(&self, scene: &Scene) -> Result<Results> {
        let Some(journal) = self.journal else { return Simulation::sharing(scene, &self.shared)?.run() };
        // Under this name lies the run of no other scene, and what is in the file is compared with it again.
        let path = journal.0.path().join(format!("{}.h5", hash_of(scene)));
        let results = match Run::resume_one_of_many(scene, &path, &path, &self.shared) {
            Ok(Resumed::Complete(results)) => return Ok(*results),
            Ok(Resumed::Run(run)) => run.execute(None)?,
            // There is none, or one that is damaged: it is of no use.
            Err(_) => Run::one_of_many(scene, &path, &self.shared)?.execute(None)?,
        };
        if results.is_complete() {
            results.save_over(&path)?;
        }
        Ok(results)
    }
}
