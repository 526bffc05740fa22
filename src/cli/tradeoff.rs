//! `fretwear tradeoff`.

use std::path::PathBuf;

use crate::report;
use crate::scene::Stepper;
use crate::study::Progress;
use crate::study::tradeoff::{self, Ladders, TradeoffReport};
use clap::Args;

use super::end::{End, Failure, done, interrupted};
use super::progress::SceneProgress;
use super::{Settings, at, complain, read, signals};

/// Candidates of the trade-off and where its results go.
#[derive(Args)]
pub struct Tradeoff {
    /// The scene, a TOML file; springs, tolerance, stepper and cycle of its [numerics] are replaced
    #[arg(value_name = "SCENE.toml")]
    scene: PathBuf,
    /// Directory for tradeoff.h5, tradeoff.csv and tradeoff.json, made if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Numbers of springs; by default 15 to 480, doubled
    #[arg(long, value_name = "N1,N2,...", value_delimiter = ',')]
    springs: Option<Vec<usize>>,
    /// Tolerances of the time stepping; by default 1e-2 to 1e-8, by tens
    #[arg(long, value_name = "T1,T2,...", value_delimiter = ',')]
    tolerances: Option<Vec<f64>>,
    /// Values of `accuracy`; by default 1e-2 to 1e-6, by tens
    #[arg(long, value_name = "A1,A2,...", value_delimiter = ',')]
    accuracies: Option<Vec<f64>>,
    /// Steppers; by default all
    #[arg(long, value_name = "S1,S2,...", value_delimiter = ',', value_parser = stepper)]
    steppers: Option<Vec<Stepper>>,
    /// Wall time up to which a candidate is run, s; what `accuracy` chooses may take five times, a reference twenty times as long
    #[arg(long, value_name = "S", default_value_t = 2.0, value_parser = super::seconds)]
    most_seconds: f64,
    /// Runs of which the least wall time is taken, fewer where a run takes long
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..))]
    repeats: u16,
    /// Put the run of every candidate into DIR/runs
    #[arg(long)]
    keep_runs: bool,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Show no progress and no summary
    #[arg(long)]
    quiet: bool,
    /// Overwrite files that exist
    #[arg(long)]
    force: bool,
}

/// The stepper of a word.
fn stepper(word: &str) -> std::result::Result<Stepper, String> {
    let known = Stepper::ALL.into_iter().find(|stepper| stepper.name() == word);
    known.ok_or_else(|| format!("give some of {}", Stepper::ALL.map(Stepper::name).join(", ")))
}

pub fn tradeoff(arguments: &Tradeoff) -> End {
    let scene = read(&arguments.scene, &Settings::default())?;
    let usual = Ladders::default();
    let ladders = Ladders {
        springs: arguments.springs.clone().unwrap_or(usual.springs),
        tolerances: arguments.tolerances.clone().unwrap_or(usual.tolerances),
        accuracies: arguments.accuracies.clone().unwrap_or(usual.accuracies),
        steppers: arguments.steppers.clone().unwrap_or(usual.steppers),
    };
    let options = tradeoff::Options {
        ladders,
        most_seconds: arguments.most_seconds,
        repeats: usize::from(arguments.repeats),
        keep_runs: arguments.keep_runs,
        overwrite: arguments.force,
    };
    let ready = tradeoff::Tradeoff::new(&scene, &arguments.output, &options, &signals::stop()?)
        .map_err(at(&scene, &arguments.scene, &Settings::default()))?;
    let shown = !arguments.quiet && !arguments.json;
    if shown {
        complain("note", &format!("{} candidates, one after the other", ready.candidates()));
    }
    let progress = shown.then(SceneProgress::default);
    let outcome = ready.execute(progress.as_ref().map(|it| it as &dyn Progress));
    drop(progress);
    let Some(outcome) = outcome.map_err(Failure::Failed)? else {
        complain("note", "stopped; the same command goes on from here");
        return Ok((String::new(), interrupted()));
    };
    let mut report = TradeoffReport::new(&outcome);
    report.write(&arguments.output, arguments.force).map_err(Failure::Failed)?;
    Ok(done(match (arguments.json, arguments.quiet) {
        (true, _) => report::json(&report),
        (false, true) => String::new(),
        (false, false) => report.text(&outcome),
    }))
}
