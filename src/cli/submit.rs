//! `fretwear submit`.

use std::path::PathBuf;

use crate::Error;
use crate::report;
use crate::study::submit::{self, Engine, SubmitReport, Wishes};
use clap::Args;

use super::complain;
use super::end::{End, FAILURE, done};

/// The study, the engine and what the jobs may take.
#[derive(Args)]
pub struct Submit {
    /// The study, a TOML file
    #[arg(value_name = "STUDY.toml")]
    study: PathBuf,
    /// Directory for scripts, logs and results, made if it is missing; the nodes must see it under the same path
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// What runs the jobs
    #[arg(long, value_parser = engine)]
    #[arg(value_name = "slurm|hyperqueue")]
    engine: Engine,
    /// Write the scripts and hand nothing in
    #[arg(long)]
    dry_run: bool,
    /// Number of shards, instead of the one proposed
    #[arg(long, value_name = "N")]
    shards: Option<u64>,
    /// Cores of each shard
    #[arg(long, value_name = "N", default_value_t = 4)]
    cpus_per_task: usize,
    /// Wall time of a scene on one core, instead of measuring a few
    #[arg(long, value_name = "SECONDS")]
    seconds_per_scene: Option<f64>,
    /// Seconds between checkpoints; by default 30, and 10 in HyperQueue, which warns only a second before it kills
    #[arg(long, value_name = "SECONDS")]
    checkpoint_interval: Option<f64>,
    /// How often a shard may be queued again after an interruption
    #[arg(long, value_name = "N", default_value_t = 20)]
    max_requeues: u32,
    /// Time limit of each shard (Slurm), instead of the one proposed
    #[arg(long, value_name = "MINUTES")]
    time_limit: Option<u64>,
    /// Memory of each shard (Slurm), such as 4G, instead of what the measured scenes suggest
    #[arg(long, value_name = "SIZE")]
    memory: Option<String>,
    /// Partition (Slurm)
    #[arg(long, value_name = "NAME")]
    partition: Option<String>,
    /// Account (Slurm)
    #[arg(long, value_name = "NAME")]
    account: Option<String>,
    /// One more option for sbatch or hq submit, such as --engine-option=--qos=long; may be repeated
    #[arg(long = "engine-option", value_name = "OPTION", allow_hyphen_values = true)]
    engine_options: Vec<String>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Overwrite scripts that exist
    #[arg(long)]
    force: bool,
}

pub fn submit(arguments: &Submit) -> End {
    let program = std::env::current_exe().map_err(|error| Error::File {
        path: "fretwear".into(),
        why: format!("where this program lies cannot be told: {error}"),
    })?;
    let options = submit::Options {
        engine: arguments.engine,
        program,
        dry_run: arguments.dry_run,
        overwrite: arguments.force,
        seconds_per_scene: arguments.seconds_per_scene,
        wishes: Wishes {
            shards: arguments.shards,
            cpus_per_task: arguments.cpus_per_task,
            time_limit: arguments.time_limit,
        },
        checkpoint_interval: arguments.checkpoint_interval,
        most_requeues: arguments.max_requeues,
        partition: arguments.partition.clone(),
        account: arguments.account.clone(),
        memory: arguments.memory.clone(),
        engine_options: arguments.engine_options.clone(),
    };
    let report =
        SubmitReport::new(&submit::submit(&arguments.study, &arguments.output, &options).map_err(cured)?);
    let text = if arguments.json { report::json(&report) } else { report.text() };
    let Some(refusal) = &report.refusal else { return Ok(done(text)) };
    complain(
        "error",
        &format!("the scripts are written, but {} did not take them: {refusal}", report.engine),
    );
    Ok((text, FAILURE))
}

/// An error with the option that helps.
fn cured(error: Error) -> Error {
    match error {
        Error::Option { name: "engine", why } => {
            Error::Option { name: "engine", why: why + "; --dry-run writes the scripts all the same" }
        }
        Error::Exists { path } => Error::File {
            path,
            why: "exists already; `bash submit.sh` beside it hands in what is there, --force writes it anew"
                .into(),
        },
        other => other,
    }
}

/// The engine of a word.
fn engine(word: &str) -> std::result::Result<Engine, String> {
    let known = Engine::ALL.into_iter().find(|engine| engine.name() == word);
    known.ok_or_else(|| format!("give {}", Engine::ALL.map(Engine::name).join(" or ")))
}
