//! A run with a result file: written at its end and at each checkpoint, and gone on with from there.

use std::path::Path;

use super::parts::{Known, Parts};
use super::recorder::Detail;
use super::{Results, Shared, Simulation, Stop};
use crate::data::{Checkpoint, LimitDistance, ResultPath, RunFile, RunWriter, scene_hash};
use crate::error::{Error, Result};
use crate::scene::Scene;
use crate::solver::simulation::{self as stepping, Observer};
use crate::solver::stepper::Bdf;

/// A run with a file that is ready to go.
pub struct Run(Simulation<'static>);

/// What is found in the file of a run that is to go on.
pub enum Resumed {
    /// A run that goes on.
    Run(Box<Run>),
    /// The file of a run that reached its end.
    Complete(Box<Results>),
}

impl Results {
    /// Reads the result file of a run that came to its end, or as far as one that was stopped came.
    ///
    /// ```
    /// # let scene: fretwear::Scene = include_str!("../../data/scenes/paraboloid.toml").parse()?;
    /// # let folder = tempfile::tempdir()?;
    /// # let path = folder.path().join("run.h5");
    /// let results = scene.simulate()?;
    /// results.save(&path)?;
    /// assert_eq!(fretwear::Results::open(&path)?.wear_depth(), results.wear_depth());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::File`] if the file is none of a run, is damaged, or holds no checkpoint that fits its scene.
    pub fn open<'a>(file: impl Into<ResultPath<'a>>) -> Result<Self> {
        let file = file.into();
        let path = file.path();
        let stored = RunFile::open(file)?;
        let checkpoint = stored.checkpoint.clone();
        match Run::go_on(stored, path, &Shared::default(), |run| Ok(run.into_deferred_writer(path)))? {
            Resumed::Complete(results) => Ok(*results),
            Resumed::Run(run) => Ok(run.0.so_far(checkpoint.unwrap_or_default())),
        }
    }

    /// Writes the result file.
    ///
    /// # Errors
    /// [`Error::Exists`] if there is one already; [`Error::File`] if it cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<()> {
        self.write(path.as_ref(), false)
    }

    /// Writes the result file, in the place of one that is there.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be written.
    pub fn save_over(&self, path: impl AsRef<Path>) -> Result<()> {
        self.write(path.as_ref(), true)
    }

    fn write(&self, path: &Path, overwrite: bool) -> Result<()> {
        let (header, snapshots) = (self.header.clone(), self.snapshots.clone());
        let mut writer = RunWriter::with_snapshots(path, header, snapshots, overwrite)?;
        writer.save(&self.checkpoint, self.stop_reason, self.is_complete())
    }

    /// What is in the result file, or would be.
    pub fn into_file(self) -> RunFile {
        RunFile::finished(self.header, self.snapshots, self.checkpoint, self.stop_reason)
    }
}

impl Run {
    /// Prepares the run of a scene; computes and writes nothing yet.
    ///
    /// # Errors
    /// [`Error::Exists`] if `output` exists and `overwrite` is not given, [`Error::File`] if it cannot be written; as [`Simulation::new`].
    pub fn new(scene: &Scene, output: &Path, overwrite: bool, stop: &Stop) -> Result<Self> {
        let shared = Shared { stop: stop.clone(), ..Shared::default() };
        let run = Simulation::begin(scene, &shared, |header| RunWriter::create(output, header, overwrite))?;
        Ok(Self(run.warned()))
    }

    /// Prepares the run of one scene of many, which writes a file only when it takes longer than its checkpoint interval or is stopped.
    ///
    /// # Errors
    /// As [`Run::new`].
    pub fn one_of_many(scene: &Scene, checkpoint: &Path, shared: &Shared) -> Result<Self> {
        let run = Simulation::begin(scene, shared, |header| Ok(RunWriter::deferred(checkpoint, header)))?;
        Ok(Self(run).keeping_checkpoints_only())
    }

    fn keeping_checkpoints_only(mut self) -> Self {
        self.0.saves_result = false;
        self
    }

    /// The run for what it ends with: its results tell of the times before only what the error and the regimes are made of.
    #[must_use]
    pub(crate) fn for_its_end(mut self) -> Self {
        self.0.detail = Detail::ForTheEnd;
        self
    }

    /// Prepares a run that goes on from the last checkpoint in its file.
    ///
    /// # Errors
    /// [`Error::File`] if the file is none of a run, or holds no checkpoint that fits its scene.
    pub fn resume<'a>(file: impl Into<ResultPath<'a>>, stop: &Stop) -> Result<Resumed> {
        let file = file.into();
        let path = file.path();
        let shared = Shared { stop: stop.clone(), ..Shared::default() };
        Self::go_on(RunFile::open(file)?, path, &shared, |run| run.into_writer(path))
    }

    /// Prepares a run as [`Run::one_of_many`] that goes on from the checkpoint in `from`, and writes its own to `checkpoint`.
    ///
    /// # Errors
    /// As [`Run::resume`]; [`Error::File`] if what is in `from` was computed from another scene.
    pub fn resume_one_of_many(
        scene: &Scene,
        from: &Path,
        checkpoint: &Path,
        shared: &Shared,
    ) -> Result<Resumed> {
        let file = RunFile::open(from)?;
        if !is_of(&file, scene) {
            let why = "was computed from another scene, or by another version of the program".into();
            return Err(Error::File { path: from.to_owned(), why });
        }
        let resumed = Self::go_on(file, from, shared, |file| Ok(file.into_deferred_writer(checkpoint)))?;
        Ok(match resumed {
            Resumed::Run(run) => Resumed::Run(Box::new(run.keeping_checkpoints_only())),
            complete => complete,
        })
    }

    fn go_on(
        file: RunFile,
        path: &Path,
        shared: &Shared,
        writer: impl FnOnce(RunFile) -> Result<RunWriter>,
    ) -> Result<Resumed> {
        let unusable = |why: &str| Error::File { path: path.to_owned(), why: why.to_owned() };
        if !file.complete && file.program_version != env!("CARGO_PKG_VERSION") {
            return Err(unusable(&format!(
                "its checkpoint is of fretwear {}, and this is {}; go on with that one, or run its scene again",
                file.program_version,
                env!("CARGO_PKG_VERSION")
            )));
        }
        if !file.complete && file.scene_hash.is_none() {
            return Err(unusable(
                "does not tell what its checkpoint was computed from (no attribute scene_hash); run its scene again",
            ));
        }
        let mut checkpoint =
            file.checkpoint.clone().ok_or_else(|| unusable("holds no checkpoint; run its scene again"))?;
        let name = format!("{} (its scene)", path.display());
        let scene = Scene::from_stored(
            &file.header.scene,
            &name,
            file.header.table.clone(),
            file.header.path.clone(),
        )?;
        checkpoint.accuracy = scene.numerics().accuracy_asked();
        let attempt = checkpoint.attempt;
        let parts =
            Parts::of_state(&scene, &attempt, (&checkpoint.state, &file.header.radius), &shared.operators)?;
        if file.header.radius != parts.model.radii()
            || !parts.fit(&checkpoint.state)
            || !checkpoint.state.past.fits(
                &checkpoint.state,
                Bdf::HIGHEST_ORDER,
                parts.is_on_whole_contact(&checkpoint.state),
            )
            || !checkpoint
                .state
                .compression
                .iter()
                .chain([&checkpoint.state.slip_area])
                .all(|value| value.is_finite())
        {
            return Err(unusable(
                "its checkpoint does not fit its scene; run the scene again with this version",
            ));
        }
        if file.complete {
            let last = file
                .snapshots
                .last()
                .cloned()
                .ok_or_else(|| unusable("holds no snapshot; run its scene again"))?;
            return Ok(Resumed::Complete(Box::new(Results {
                distance: file.header.limit.as_ref().map(|limit| LimitDistance::new(limit, &last)),
                indenter: parts.model.contact().indenter().clone(),
                wears_locally: parts.model.schedule().wears_locally(),
                header: file.header,
                snapshots: file.snapshots,
                stop_reason: file.stop_reason,
                last,
                checkpoint,
                limit: parts.limit,
            })));
        }
        let Checkpoint { state, progress, wall_seconds, .. } = checkpoint;
        let (limit, known) = (parts.limit.clone(), Known::of(&parts));
        Ok(Resumed::Run(Box::new(Self(Simulation {
            stepping: parts.resume(state, progress)?,
            limit,
            known,
            warning: None,
            scene,
            shared: shared.clone(),
            writer: writer(file)?,
            saves_result: true,
            detail: Detail::Whole,
            wall_seconds_before: wall_seconds,
            attempt,
            watchers: vec![],
        }))))
    }

    /// A word about a run that will take long, where that is known beforehand.
    pub fn warning(&self) -> Option<&str> {
        self.0.warning()
    }

    /// The loop over cycles, at its start or where it goes on.
    pub fn stepping(&self) -> &stepping::Simulation {
        self.0.stepping()
    }

    /// The result file, behind all links.
    pub fn path(&self) -> Option<&Path> {
        self.0.writer.path()
    }

    /// Runs to the end, or to a checkpoint when it is stopped, and writes the result file.
    ///
    /// # Errors
    /// Those of the simulation, after what was reached is written; [`Error::File`] if it cannot be.
    pub fn execute(self, observer: Option<&mut dyn Observer>) -> Result<Results> {
        self.0.run_with(observer)
    }
}

/// Whether a file was computed from this scene, with its rows and numerics, by this version of the program.
pub(crate) fn is_of(file: &RunFile, scene: &Scene) -> bool {
    file.scene_hash == Some(hash_of(scene))
}

/// What a run of a scene is computed from, as one word.
pub(crate) fn hash_of(scene: &Scene) -> String {
    let (table, path) = (scene.table(), scene.path());
    scene_hash(env!("CARGO_PKG_VERSION"), scene.text(), table.as_deref(), path.as_deref())
}
