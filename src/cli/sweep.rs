//! `fretwear sweep`.

use std::path::PathBuf;

use crate::report;
use crate::scene::Study;
use crate::study::Progress;
use crate::study::sweep::{self, SweepOptions, SweepReport};
use clap::Args;

use super::end::{End, FAILURE, Failure, SUCCESS, interrupted};
use super::progress::SceneProgress;
use super::{complain, seconds, signals, threads};

#[derive(Args)]
pub struct Sweep {
    /// The study, a TOML file
    #[arg(value_name = "STUDY.toml")]
    study: PathBuf,
    /// Directory of the results, made if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Do shard I of N only, I from 0; all shards need the same N
    #[arg(long, value_name = "I/N", value_parser = shard)]
    shard: Option<(u64, u64)>,
    /// Threads, each of which runs one scene at a time; at most, and by default, one for each core
    #[arg(long, value_name = "T", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Failed scenes up to which the exit code is 0
    #[arg(long, value_name = "M", default_value_t = 0)]
    max_failed: u64,
    /// Seconds between checkpoints
    #[arg(long, value_name = "S", default_value_t = 30.0, value_parser = seconds)]
    checkpoint_interval: f64,
    /// Print the summary as one JSON object
    #[arg(long)]
    json: bool,
    /// Show no progress and no summary
    #[arg(long)]
    quiet: bool,
}

/// `I/N` of `--shard`.
fn shard(text: &str) -> std::result::Result<(u64, u64), String> {
    let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
    match numbers {
        Some((shard, shards)) if shard < shards => Ok((shard, shards)),
        _ => Err("write I/N with 0 <= I < N, for example 0/4".into()),
    }
}

pub fn sweep(arguments: &Sweep) -> End {
    let study = Study::read(&arguments.study)?;
    let (shard, shards) = arguments.shard.unwrap_or((0, 1));
    let options = SweepOptions {
        shard,
        shards,
        threads: threads(arguments.threads),
        checkpoint_interval: arguments.checkpoint_interval,
    };
    let shown = !arguments.quiet && !arguments.json;
    if shown {
        complain("note", &format!("{} scenes in {shards} shards", study.count()));
    }
    let ready = sweep::Sweep::new(&study, &arguments.output, &options, &signals::stop()?)?;
    let progress = shown.then(SceneProgress::default);
    let outcome = ready.execute(progress.as_ref().map(|it| it as &dyn Progress));
    drop(progress);
    let outcome = outcome.map_err(Failure::Failed)?;
    let report = SweepReport::new(&options, &outcome);
    let code = match &outcome.file {
        None => interrupted(),
        Some(_) if outcome.failed > arguments.max_failed => {
            complain("error", &format!("{} scenes failed; their rows say why", outcome.failed));
            FAILURE
        }
        Some(_) => SUCCESS,
    };
    let text = match (arguments.json, arguments.quiet) {
        (true, _) => report::json(&report),
        (false, true) => String::new(),
        (false, false) => report.text(),
    };
    Ok((text, code))
}
