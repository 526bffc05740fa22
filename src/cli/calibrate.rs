//! `fretwear calibrate`.

use std::path::PathBuf;

use crate::report;
use crate::scene::Calibration;
use crate::study::calibration::Comparison;
use clap::Args;

use super::end::{End, Failure, INACCURATE, SUCCESS, interrupted};
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
    /// Show no summary
    #[arg(long)]
    quiet: bool,
    /// Overwrite files that exist
    #[arg(long)]
    force: bool,
}

pub fn calibrate(arguments: &Calibrate) -> End {
    let laws = Calibration::read(&arguments.calibration)?.models();
    let stop = signals::stop()?;
    let comparison = Comparison::new(&laws, &arguments.output, arguments.force, &stop)?;
    let Some(found) = comparison.run().map_err(Failure::Failed)? else {
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
