//! `fretwear universality`.

use std::path::PathBuf;

use crate::report;
use crate::scene::UniversalityStudy;
use crate::study::Progress;
use crate::study::universality::{self, UniversalityReport};
use clap::Args;

use super::end::{End, FAILURE, Failure, done, interrupted};
use super::progress::SceneProgress;
use super::{complain, signals, threads};

/// The study and where its results go.
#[derive(Args)]
pub struct Universality {
    /// The study, a TOML file
    #[arg(value_name = "STUDY.toml")]
    study: PathBuf,
    /// Directory for universality.h5 and universality.csv, made if it is missing
    #[arg(short, long, value_name = "DIR", required_unless_present_any = ["list", "scene"])]
    output: Option<PathBuf>,
    /// Print the names of the cases and what is predicted of them, and run nothing
    #[arg(long, conflicts_with_all = ["output", "scene"])]
    list: bool,
    /// Print the complete scene of a case, and run nothing
    #[arg(long, value_name = "CASE", conflicts_with = "output")]
    scene: Option<String>,
    /// Threads, each of which runs one case at a time; at most, and by default, one for each core
    #[arg(long, value_name = "T", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Print one JSON object
    #[arg(long, conflicts_with_all = ["list", "scene"])]
    json: bool,
    /// Show no progress and no summary
    #[arg(long)]
    quiet: bool,
    /// Overwrite files that exist
    #[arg(long)]
    force: bool,
}

pub fn universality(arguments: &Universality) -> End {
    let study = UniversalityStudy::read(&arguments.study)?;
    if let Some(name) = &arguments.scene {
        let case = study.case(name)?;
        return Ok(done(case.scene.clone()));
    }
    let Some(folder) = &arguments.output else {
        let lines = study.cases().iter().map(|case| format!("{}: {}\n", case.predicted.name(), case.name));
        return Ok(done(lines.collect()));
    };
    let options = universality::Options { threads: threads(arguments.threads), overwrite: arguments.force };
    let ready = universality::Universality::new(&study, folder, &options, &signals::stop()?)?;
    let shown = !arguments.quiet && !arguments.json;
    if shown {
        complain("note", &format!("{} cases in {} runs", study.cases().len(), ready.runs()));
    }
    let progress = shown.then(SceneProgress::default);
    let outcome = ready.execute(progress.as_ref().map(|it| it as &dyn Progress));
    drop(progress);
    let Some(outcome) = outcome.map_err(Failure::Failed)? else {
        complain("note", "stopped; the same command goes on from here");
        return Ok((String::new(), interrupted()));
    };
    let report = UniversalityReport::new(&study, &outcome);
    let text = match (arguments.json, arguments.quiet) {
        (true, _) => report::json(&report),
        (false, true) => String::new(),
        (false, false) => report.text(),
    };
    if report.agreeing == report.count {
        return Ok(done(text));
    }
    let wrong = report.count - report.agreeing;
    complain("error", &format!("{wrong} of {} cases are not as predicted", report.count));
    Ok((text, FAILURE))
}
