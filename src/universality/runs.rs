//! The runs of a study, and what is kept of them until all are done.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use super::Judgement;
use crate::error::{Error, Result};
use crate::run::{Resumed, Run, Shared};
use crate::scene::Scene;
use crate::snapshot::{RunFile, StopReason, make_folder};

/// One run.
pub(super) struct Job {
    /// Number of the case.
    pub(super) case: usize,
    /// Whether it has more springs and smaller steps than its case asks for.
    pub(super) finer: bool,
    pub(super) scene: Scene,
}

/// Does runs, or finds them done.
pub(super) struct Runs<'a> {
    folder: PathBuf,
    shared: &'a Shared,
}

impl<'a> Runs<'a> {
    pub(super) fn new(folder: &Path, shared: &'a Shared) -> Result<Self> {
        let folder = folder.join("runs");
        make_folder(&folder)?;
        Ok(Self { folder, shared })
    }

    /// Removes what was kept. What cannot be removed is in nobody's way.
    pub(super) fn remove(&self) {
        let _ = std::fs::remove_dir_all(&self.folder);
    }

    /// The end of a run, or why it has none; none if a signal came first.
    ///
    /// # Errors
    /// [`Error::File`] concerns all runs: the disk is full, a directory has vanished.
    pub(super) fn end(
        &self,
        number: usize,
        job: &Job,
    ) -> Result<Option<std::result::Result<Judgement, String>>> {
        if self.shared.stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        // A fault of the program in one run must not cost the others.
        let done = catch_unwind(AssertUnwindSafe(|| {
            let run = self.run(number, &job.scene)?;
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
    fn run(&self, number: usize, scene: &Scene) -> Result<Option<RunFile>> {
        let path = self.folder.join(format!("{number}.h5"));
        let before = RunFile::open(&path).ok().filter(|it| {
            let same_scene = it.header.scene == scene.text() && it.header.table.as_ref() == scene.table();
            same_scene && it.program_version == env!("CARGO_PKG_VERSION")
        });
        let run = match before {
            Some(complete) if complete.complete => return Ok(Some(complete)),
            // A checkpoint that cannot be used is of no use: the run is begun anew.
            Some(_) => match Run::resume_one_of_many(&path, &path, self.shared) {
                Ok(Resumed::Run(run)) => *run,
                _ => Run::one_of_many(scene, &path, self.shared)?,
            },
            None => Run::one_of_many(scene, &path, self.shared)?,
        };
        let (result, file) = run.execute_keeping(None)?;
        if result.stop_reason == StopReason::Interrupted {
            return Ok(None);
        }
        file.clone().into_deferred_writer(&path).save(&result.checkpoint, result.stop_reason, true)?;
        Ok(Some(file))
    }
}
