//! The runs of a study, and what is kept of them until all are done.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::Ordering;

use super::Judgement;
use crate::data::{RunFile, Scratch, StopReason, failure};
use crate::error::{Error, Result};
use crate::run::{Resumed, Run, Shared, hash_of, is_of};
use crate::scene::Scene;

/// What the directory of runs is for.
const PURPOSE: &str = "runs of a universality study";

/// One run.
pub(super) struct Job {
    /// Number of the case.
    pub(super) case: usize,
    /// Whether it has more springs and smaller steps than its case asks for.
    pub(super) finer: bool,
    pub(super) scene: Scene,
}

/// Does runs, or finds them done by a call that was stopped; what is kept of them goes with this.
pub(super) struct Runs<'a> {
    scratch: Scratch,
    shared: &'a Shared,
}

impl<'a> Runs<'a> {
    pub(super) fn new(folder: &Path, shared: &'a Shared) -> Result<Self> {
        let scratch = Scratch::take_up(folder, PURPOSE).map_err(|error| failure(folder, &error))?;
        Ok(Self { scratch, shared })
    }

    /// Keeps the runs for the next call.
    pub(super) fn keep(self) {
        self.scratch.keep();
    }

    /// The end of a run, or why it has none; none if a signal came first.
    ///
    /// # Errors
    /// [`Error::File`] concerns all runs: the disk is full, a directory has vanished.
    pub(super) fn end(&self, job: &Job) -> Result<Option<std::result::Result<Judgement, String>>> {
        if self.shared.stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        // A fault of the program in one run must not cost the others.
        let done = catch_unwind(AssertUnwindSafe(|| {
            let run = self.run(&job.scene)?;
            run.map(|run| Judgement::new(&job.scene, &run)).transpose()
        }));
        match done {
            Ok(Ok(end)) => Ok(end.map(Ok)),
            Ok(Err(error @ Error::File { .. })) => Err(error),
            Ok(Err(error)) => Ok(Some(Err(error.to_string()))),
            Err(_) => Ok(Some(Err("the program panicked; please report this scene".into()))),
        }
    }

    /// A run from its start, or on from where it was stopped; none if a signal comes.
    fn run(&self, scene: &Scene) -> Result<Option<RunFile>> {
        // Under this name lies no other scene, however the study was edited in between.
        let path = self.scratch.path().join(format!("{}.h5", hash_of(scene)));
        let complete = RunFile::open(&path).ok().filter(|it| it.complete && is_of(it, scene));
        if complete.is_some() {
            return Ok(complete);
        }
        let run = match Run::resume_one_of_many(scene, &path, &path, self.shared) {
            Ok(Resumed::Run(run)) => *run,
            // There is none, or one that cannot be used.
            _ => Run::one_of_many(scene, &path, self.shared)?,
        };
        let (result, file) = run.execute_keeping(None)?;
        if result.stop_reason == StopReason::Interrupted {
            return Ok(None);
        }
        file.clone().into_deferred_writer(&path).save(&result.checkpoint, result.stop_reason, true)?;
        Ok(Some(file))
    }
}
