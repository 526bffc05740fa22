//! Many scenes in parallel: one shard of a study, whose results are rows that are never lost and never there twice.
//!
//! Each scene runs on one core; the scenes of a shard are spread over the threads. Rows collect in memory and are written, at the latest
//! after each checkpoint interval, as a *part*: a file that is never changed afterwards and whose name no other process uses. When the
//! shard is done its parts become one file. Whoever is killed loses the rows since its last part and, of the scenes that were running,
//! what came after their own checkpoints; another call does only what is missing. Two processes that work on one shard at the same time
//! find the same results, and the second to finish replaces the file of the first by an equal one.
//!
//! ```text
//! DIR/shard-3-of-10.h5                      a shard that is done
//! DIR/parts/3-of-10.ATTEMPT.SEQUENCE.h5     rows of a shard that is not
//! DIR/parts/scene-417.ATTEMPT.h5            a scene that takes longer than the checkpoint interval
//! ```
//!
//! Every file carries the hash of what it was computed from. Rows of another study are refused; the checkpoint of another scene, which had the same
//! number before the study was edited, is not used, and gives way when the scene is done.

mod folder;
mod gathering;
mod merge;
mod report;
mod rows;

pub use folder::shards_in;
pub use merge::{Merged, array_syntax, merge};
pub use report::{MergeReport, SweepReport};

use std::collections::HashSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use rayon::prelude::*;

use crate::data::{RunFile, SweepHeader, Value};
use crate::error::{Error, Result};
use crate::run::readings::{self, ClosedForm};
use crate::run::{Resumed, Run, Shared, Stop};
use crate::scene::{Study, Task};
use crate::study::batch::{Batch, End, Progress, check_valid};
use folder::Folder;
use rows::{SceneResult, Schema};

/// Kept runs in memory after which a part is written.
const MOST_RUNS: usize = 100;

/// Rows in memory after which a part is written.
const MOST_ROWS: usize = 20_000;

/// Which part of a study is done, and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SweepOptions {
    /// Number of the shard, from 0.
    pub shard: u64,
    /// Number of shards that the study is cut into.
    pub shards: u64,
    /// Threads, at most [`most_threads`](crate::study::most_threads); all cores if none.
    pub threads: Option<usize>,
    /// Wall time between checkpoints, s.
    pub checkpoint_interval: f64,
}

impl Default for SweepOptions {
    /// The whole study on all cores, with a checkpoint each half minute.
    fn default() -> Self {
        Self { shard: 0, shards: 1, threads: None, checkpoint_interval: 30.0 }
    }
}

/// What a sweep came to.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepOutcome {
    /// The file of the shard; none if it was stopped first.
    pub file: Option<PathBuf>,
    /// Scenes of the shard.
    pub scenes: u64,
    /// Scenes that were done before.
    pub done_before: u64,
    /// Scenes done now.
    pub done: u64,
    /// Failed scenes of the shard so far.
    pub failed: u64,
    /// Wall time of this call, s.
    pub wall_seconds: f64,
}

/// Numbers of the scenes of a shard.
///
/// ```
/// use fretwear::study::sweep::shard_range;
/// assert_eq!([0, 1, 2].map(|shard| shard_range(shard, 3, 10)), [0..3, 3..6, 6..10]);
/// ```
///
/// # Panics
/// If the shard is not below the number of shards.
pub fn shard_range(shard: u64, shards: u64, scenes: u64) -> Range<u64> {
    assert!(shard < shards, "shard {shard} of {shards}");
    let cut = |shard: u64| (u128::from(scenes) * u128::from(shard) / u128::from(shards)) as u64;
    cut(shard)..cut(shard + 1)
}

/// Does what is missing of a shard: [`Sweep::new`] and [`Sweep::execute`] in one.
///
/// # Errors
/// Those of both.
pub fn sweep(
    study: &Study,
    folder: &Path,
    options: &SweepOptions,
    progress: Option<&dyn Progress>,
) -> Result<SweepOutcome> {
    Sweep::new(study, folder, options, &Stop::default())?.execute(progress)
}

/// A shard that is ready to be done.
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// # let scenes = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes"));
/// use fretwear::{Stop, Study, Sweep, SweepOptions, merge};
///
/// let text = r#"
///     scene = "paraboloid.toml"
///     task = "limit"
///     axes = [{ key = "loading.amplitude", from = "0.1 um", to = "0.3 um", count = 8 }]
/// "#;
/// let study = Study::from_toml(text, "study", scenes)?;
/// for shard in 0..2 {
///     let options = SweepOptions { shard, shards: 2, ..SweepOptions::default() };
///     Sweep::new(&study, folder.path(), &options, &Stop::default())?.execute(None)?;
/// }
/// let merged = merge(folder.path(), &folder.path().join("all.h5"), false)?;
/// assert_eq!((merged.scenes, merged.missing), (study.count(), 0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Sweep<'a> {
    study: &'a Study,
    schema: Schema,
    folder: Folder,
    batch: Batch,
    interval: Duration,
    range: Range<u64>,
    before: Done,
    /// Scenes without a row.
    missing: Vec<u64>,
    started: Instant,
}

impl<'a> Sweep<'a> {
    /// Looks at what is there of a shard, and makes sure that what is missing can be done.
    ///
    /// # Errors
    /// [`Error::Scene`] lists scenes of the study that are not valid; [`Error::Option`] for a shard that is none;
    /// [`Error::File`] if the directory cannot be used, or holds results of another study, version or number of shards.
    pub fn new(study: &'a Study, folder: &Path, options: &SweepOptions, stop: &Stop) -> Result<Self> {
        let started = Instant::now();
        let interval = Duration::from_secs_f64(options.checkpoint_interval);
        let (shard, shards) = (options.shard, options.shards);
        if !(1..=study.count()).contains(&shards) || shard >= shards {
            return Err(Error::Option {
                name: "shard",
                why: format!(
                    "{shard}/{shards} is none of a study of {} scenes; shards count from 0, and each has a scene",
                    study.count()
                ),
            });
        }
        let shared = Shared { stop: stop.clone(), checkpoint_interval: Some(interval), ..Shared::default() };
        let batch = Batch::new(options.threads, shared)?;
        let header = SweepHeader {
            title: study.title().unwrap_or_default().into(),
            task: study.task().name().into(),
            study: study.text().into(),
            base_scene: study.base_text().into(),
            study_hash: study.hash(),
            scenes: study.count(),
            shards,
            shard,
        };
        let folder = Folder::new(folder, header)?;
        let range = shard_range(shard, shards, study.count());
        let before = folder.done()?;
        let missing = before.missing(&range);
        let all = missing.len() as u64;
        batch.install(|| validate(study, missing.par_iter().copied(), all, stop))?;
        folder.create()?;
        let schema = Schema::new(study);
        Ok(Self { study, schema, folder, batch, interval, range, before, missing, started })
    }

    /// Runs what is missing; see the [module](self) for what is written where. Scenes that fail are rows, not errors.
    ///
    /// # Errors
    /// [`Error::File`] if files cannot be read or written.
    pub fn execute(self, progress: Option<&dyn Progress>) -> Result<SweepOutcome> {
        let Self { study, schema, folder, batch, missing, .. } = &self;
        if let (Some(file), true) = (folder.finished(), missing.is_empty()) {
            return Ok(self.outcome(Some(file), 0, 0));
        }
        let collector = Collector::new(study, folder, schema, self.interval);
        let run = |scene: &u64| match study.task() {
            Task::Limit => self.limit(*scene).map(Some),
            Task::Run => self.run(*scene),
        };
        let finished = batch.each(missing, progress, run, |scene, end| collector.add(self.row(*scene, end)));
        let (done, failed) = collector.finish()?;
        let file = finished?.map(|_| folder.compact()).transpose()?;
        Ok(self.outcome(file, done, failed))
    }

    /// What is stored of a scene.
    fn row(&self, scene: u64, end: End<Computed>) -> SceneResult {
        let (results, run, error) = match end {
            Ok((results, run)) => (Some(results), run, None),
            Err(error) => (None, None, Some(error)),
        };
        SceneResult { scene, inputs: self.study.inputs(scene), results, run, error }
    }

    fn limit(&self, scene: u64) -> Result<Computed> {
        let form = ClosedForm::new(&self.study.scene(scene)?)?;
        Ok((readings::LIMIT.iter().map(|it| (it.of)(&form)).collect(), None))
    }

    /// None if it was stopped.
    fn run(&self, scene: u64) -> Result<Option<Computed>> {
        let (number, scene, shared) = (scene, self.study.scene(scene)?, &self.batch.shared);
        let own = self.folder.checkpoint(number);
        let run = self.folder.checkpoints(number).iter().find_map(|from| {
            // One that cannot be used, or is of another scene under the same number, is of no use: the scene is begun anew.
            match Run::resume_one_of_many(&scene, from, &own, shared) {
                Ok(Resumed::Run(run)) => Some(*run),
                _ => None,
            }
        });
        let run = match run {
            Some(run) => run,
            None => Run::one_of_many(&scene, &own, shared)?,
        };
        let keeps = self.study.snapshots().contain(number);
        let run = if keeps { run } else { run.for_its_end() };
        let results = run.execute(None)?;
        if !results.is_complete() {
            return Ok(None);
        }
        let columns = readings::RUN.iter().map(|it| (it.of)(&results)).collect();
        let kept = keeps.then(|| results.into_file());
        Ok(Some((columns, kept)))
    }

    fn outcome(&self, file: Option<PathBuf>, done: u64, failed: u64) -> SweepOutcome {
        SweepOutcome {
            file,
            scenes: self.range.end - self.range.start,
            done_before: self.before.scenes.len() as u64,
            done,
            failed: self.before.failed + failed,
            wall_seconds: self.started.elapsed().as_secs_f64(),
        }
    }
}

/// Refuses a study of which some scenes are not valid; runs nothing.
///
/// # Errors
/// [`Error::Scene`] counts them and shows the first.
pub fn validate_all(study: &Study) -> Result<()> {
    validate(study, (0..study.count()).into_par_iter(), study.count(), &Stop::default())
}

/// Refuses a study of which some of these scenes are not valid; who is stopped looks no further.
fn validate(study: &Study, scenes: impl ParallelIterator<Item = u64>, total: u64, stop: &Stop) -> Result<()> {
    let fault = |scene: u64| match stop.is_stopped() {
        true => None,
        false => study.scene(scene).err().map(|it| it.to_string()),
    };
    let wrong: Vec<String> = scenes.filter_map(fault).collect();
    check_valid(&wrong, total)
}

/// Results of a row, and its run where that is kept.
type Computed = (Vec<Value>, Option<RunFile>);

/// Takes rows from all threads and writes parts.
struct Collector<'a> {
    study: &'a Study,
    folder: &'a Folder,
    schema: &'a Schema,
    interval: Duration,
    waiting: Mutex<Waiting>,
}

struct Waiting {
    rows: Vec<SceneResult>,
    /// How many of them have a run.
    runs: usize,
    saved: Instant,
    done: u64,
    failed: u64,
}

impl<'a> Collector<'a> {
    fn new(study: &'a Study, folder: &'a Folder, schema: &'a Schema, interval: Duration) -> Self {
        let waiting = Waiting { rows: vec![], runs: 0, saved: Instant::now(), done: 0, failed: 0 };
        let waiting = Mutex::new(waiting);
        Self { study, folder, schema, interval, waiting }
    }

    fn add(&self, row: SceneResult) -> Result<()> {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.done += 1;
        waiting.failed += u64::from(row.error.is_some());
        waiting.runs += usize::from(row.run.is_some());
        waiting.rows.push(row);
        let few = waiting.runs < MOST_RUNS && waiting.rows.len() < MOST_ROWS;
        if few && waiting.saved.elapsed() < self.interval {
            return Ok(());
        }
        (waiting.saved, waiting.runs) = (Instant::now(), 0);
        let rows = std::mem::take(&mut waiting.rows);
        // The others go on while this thread writes.
        drop(waiting);
        self.write(rows)
    }

    fn write(&self, rows: Vec<SceneResult>) -> Result<()> {
        if rows.is_empty() {
            return Ok(());
        }
        // Scenes read these files when they begin, and each is to have read the same.
        if !self.folder.is_of(self.study) {
            return Err(Error::Inconsistent {
                what: "sweep",
                why: "the file of a measured profile or of a recorded path was changed meanwhile; rows since the last checkpoint are dropped: \
                      give the file its old content, or use another directory"
                    .into(),
            });
        }
        let scenes: Vec<u64> = rows.iter().map(|row| row.scene).collect();
        self.folder.write_part(self.schema, rows)?;
        scenes.into_iter().for_each(|scene| self.folder.remove_checkpoints(scene));
        Ok(())
    }

    /// Writes what is left; numbers of rows done and failed.
    fn finish(self) -> Result<(u64, u64)> {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        let rows = std::mem::take(&mut waiting.rows);
        let counts = (waiting.done, waiting.failed);
        drop(waiting);
        self.write(rows)?;
        Ok(counts)
    }
}

/// Scenes that have a row.
#[derive(Debug, Clone, Default)]
struct Done {
    scenes: HashSet<u64>,
    failed: u64,
}

impl Done {
    fn missing(&self, range: &Range<u64>) -> Vec<u64> {
        range.clone().filter(|scene| !self.scenes.contains(scene)).collect()
    }
}
