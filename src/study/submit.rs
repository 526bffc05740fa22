//! A study on a cluster: its cost measured, its shards proposed, its job scripts written and handed to the engine.
//!
//! The scheduling is the engine's own. What is here decides how many shards a study is worth and writes scripts that survive what
//! clusters do to jobs: time limits, preemption, lost nodes. docs/hpc.md tells a user how to go about it.

mod engine;
mod measure;
mod proposal;
mod report;
mod scripts;
mod shell;

pub use engine::{Engine, Submitted};
pub use measure::{MeasuredScene, Measurement};
pub use proposal::{Proposal, Wishes};
pub use report::SubmitReport;

use std::path::{Path, PathBuf};

use crate::data::SweepFile;
use crate::error::{Error, Result};
use crate::scene::{Study, Task};
use crate::study::sweep;

/// What is asked of `fretwear submit` besides study and directory.
#[derive(Debug, Clone)]
pub struct Options {
    /// The engine that is to do it.
    pub engine: Engine,
    /// The program that the scripts call.
    pub program: PathBuf,
    /// Writes the scripts and hands nothing in.
    pub dry_run: bool,
    /// Overwrites scripts that exist.
    pub overwrite: bool,
    /// Wall time of one scene on one core, s, instead of measuring it.
    pub seconds_per_scene: Option<f64>,
    /// What the shards are to be like.
    pub wishes: Wishes,
    /// Wall time between checkpoints, s, instead of the engine's own.
    pub checkpoint_interval: Option<f64>,
    /// How often a shard may be queued again.
    pub most_requeues: u32,
    /// Slurm's partition.
    pub partition: Option<String>,
    /// Slurm's account.
    pub account: Option<String>,
    /// Memory of a shard in Slurm's notation, such as `4G`, instead of what the measurement suggests.
    pub memory: Option<String>,
    /// More options for the engine, each a word that begins with a dash.
    pub engine_options: Vec<String>,
}

/// A study that is ready for its cluster, or on it.
#[derive(Debug, Clone)]
pub struct Submission {
    /// Title of the study.
    pub title: Option<String>,
    /// The engine.
    pub engine: Engine,
    /// Number of scenes.
    pub scenes: u64,
    /// What is done with each.
    pub task: Task,
    /// What a few of them took.
    pub measurement: Measurement,
    /// The shards.
    pub proposal: Proposal,
    /// The scripts written.
    pub files: Vec<PathBuf>,
    /// The file that the merge will write.
    pub merged: PathBuf,
    /// What the engine answered; none after a dry run.
    pub submitted: Option<Submitted>,
}

/// Measures a study, writes its job scripts into a directory, which is made if it is missing, and hands them to the engine.
///
/// # Errors
/// Those of the study and its scenes; [`Error::Option`] names what is asked that cannot be, or the engine that is not here;
/// [`Error::File`] a script that exists or cannot be written. Nothing is written then.
pub fn submit(study: &Path, folder: &Path, options: &Options) -> Result<Submission> {
    options.check()?;
    let paths = scripts::Paths::new(&options.program, study, folder)?;
    if !options.dry_run {
        options.engine.check_presence()?;
    }
    scripts::check(&paths, options.engine, options.overwrite)?;
    let description = Study::read(study)?;
    sweep::validate_all(&description)?;
    let shards = shards_so_far(folder, &description, options.wishes.shards)?;
    check_merged(&paths.merged(), &description)?;
    let measurement = match options.seconds_per_scene {
        Some(seconds) => Measurement::told(seconds),
        None => Measurement::new(&description)?,
    };
    let largest_array = options.engine.largest_array();
    let wishes = Wishes { shards, ..options.wishes };
    let proposal = Proposal::new(description.count(), &measurement, &wishes, largest_array)?;
    let merged = paths.merged();
    let files = scripts::write(&paths, options, &proposal, &measurement, description.count())?;
    let submitted = match options.dry_run {
        true => None,
        false => Some(options.engine.hand_in(folder)),
    };
    Ok(Submission {
        title: description.title().map(str::to_owned),
        engine: options.engine,
        scenes: description.count(),
        task: description.task(),
        measurement,
        proposal,
        files,
        merged,
        submitted,
    })
}

/// Refuses a directory in which the file of the merge, which the scripts replace, is of something else.
fn check_merged(path: &Path, study: &Study) -> Result<()> {
    match path.exists() && !SweepFile::read_header(path).is_ok_and(|it| it.study_hash == study.hash()) {
        false => Ok(()),
        true => Err(Error::File {
            path: path.to_owned(),
            why: "is not the merged file of this study, and the scripts would replace it; move it away, or use another directory".into(),
        }),
    }
}

/// The number of shards that is asked for, or that results in the directory dictate.
fn shards_so_far(folder: &Path, study: &Study, asked: Option<u64>) -> Result<Option<u64>> {
    match (sweep::shards_in(folder, study)?, asked) {
        (Some(there), Some(asked)) if there != asked => Err(Error::File {
            path: folder.to_owned(),
            why: format!(
                "holds results of {there} shards, and {asked} are asked for; ask for no number of shards, or use another directory"
            ),
        }),
        (there, asked) => Ok(there.or(asked)),
    }
}

impl Options {
    /// Refuses options that make no sense or belong to another engine.
    fn check(&self) -> Result<()> {
        let times = [
            ("seconds-per-scene", self.seconds_per_scene),
            ("checkpoint-interval", self.checkpoint_interval),
        ];
        if let Some((name, Some(seconds))) =
            times.iter().find(|(_, it)| it.is_some_and(|it| !(it > 0.0 && it.is_finite())))
        {
            return Err(refuse(name, format!("{seconds} is no time; give seconds above 0")));
        }
        if self.engine == Engine::HyperQueue {
            let slurm_only = [
                ("partition", self.partition.is_some()),
                ("account", self.account.is_some()),
                ("memory", self.memory.is_some()),
                ("time-limit", self.wishes.time_limit.is_some()),
            ];
            if let Some((name, _)) = slurm_only.iter().find(|(_, given)| *given) {
                let why =
                    "belongs to Slurm; HyperQueue's workers have it from `hq worker start` or `hq alloc add`";
                return Err(refuse(name, why.into()));
            }
        }
        for (name, value) in [("partition", &self.partition), ("account", &self.account)] {
            value.as_deref().map_or(Ok(()), |value| shell::check_word(name, value))?;
        }
        self.memory.as_deref().map_or(Ok(()), check_memory)?;
        self.engine_options.iter().try_for_each(|option| shell::check_option(option))
    }
}

/// Refuses what Slurm would not take for an amount of memory.
fn check_memory(memory: &str) -> Result<()> {
    let digits = memory.strip_suffix(['K', 'M', 'G', 'T']).unwrap_or(memory);
    match digits.is_empty() || !digits.bytes().all(|it| it.is_ascii_digit()) {
        true => Err(refuse("memory", format!("{memory:?} is no amount of memory; for example 4G or 500M"))),
        false => Ok(()),
    }
}

fn refuse(name: &'static str, why: String) -> Error {
    Error::Option { name, why }
}
