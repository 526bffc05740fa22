//! The runs of a study, and what is kept of them until all are done.

use std::path::Path;

use super::Judgement;
use crate::data::{RunFile, Scratch, failure};
use crate::error::Result;
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

    /// The end of a run; none if it was stopped.
    pub(super) fn end(&self, job: &Job) -> Result<Option<Judgement>> {
        let run = self.run(&job.scene)?;
        run.map(|run| Judgement::new(&job.scene, &run)).transpose()
    }

    /// A run from its start, or on from where it was stopped; none if it is stopped.
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
        let results = run.execute(None)?;
        if !results.is_complete() {
            return Ok(None);
        }
        results.save_over(&path)?;
        Ok(Some(results.into_file()))
    }
}
