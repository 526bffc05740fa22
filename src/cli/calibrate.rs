//! `fretwear calibrate`.

use std::path::PathBuf;

use crate::report;
use crate::scene::Calibration;
use crate::study::calibration::{Comparison, Foretold, Onlooker, Options};
use clap::Args;

use super::end::{End, Failure, INACCURATE, SUCCESS, interrupted};
use super::progress::CalibrationProgress;
use super::{complain, signals};

/// The calibration and where its results go.
#[derive(Args)]
pub struct Calibrate {
    /// The calibration, a TOML file
    #[arg(value_name = "CALIBRATION.toml")]
    calibration: PathBuf,
    /// Directory for calibration.h5, parameters.csv and residuals.csv, made if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Scene that is foretold: all its results with the interval that holds 95 % of them
    #[arg(long, value_name = "SCENE.toml")]
    predict: Option<PathBuf>,
    /// Draws of the unknowns with which that scene is run
    #[arg(long, value_name = "N", default_value_t = 200, requires = "predict", value_parser = clap::value_parser!(u16).range(20..=512))]
    draws: u16,
    /// Show no progress and no summary
    #[arg(long)]
    quiet: bool,
    /// Overwrite files that exist
    #[arg(long)]
    force: bool,
}

pub fn calibrate(arguments: &Calibrate) -> End {
    let laws = Calibration::read(&arguments.calibration)?.models();
    let stop = signals::stop()?;
    let foretold = arguments.predict.as_deref().map(|path| Foretold::read(path, arguments.draws.into()));
    let options = Options { overwrite: arguments.force, foretold: foretold.transpose()? };
    let comparison = Comparison::new(&laws, &arguments.output, &options, &stop)?;
    let shown = !arguments.quiet && !arguments.json;
    let progress = shown.then(CalibrationProgress::default);
    let found = comparison.run(progress.as_ref().map(|it| it as &dyn Onlooker));
    drop(progress);
    let Some(found) = found.map_err(Failure::Failed)? else {
        complain("note", "stopped; the same command goes on from here");
        return Ok((String::new(), interrupted()));
    };
    let (outcome, report) = (found.outcome(), found.report());
    if !arguments.json {
        outcome.warnings.iter().for_each(|warning| complain("warning", warning));
    }
    let text = match (arguments.json, arguments.quiet) {
        (true, _) => report::json(&report),
        (false, true) => String::new(),
        (false, false) => report.text(),
    };
    Ok((text, if outcome.accuracy_met { SUCCESS } else { INACCURATE }))
}
