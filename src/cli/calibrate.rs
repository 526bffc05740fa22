//! `fretwear calibrate`.

use std::path::PathBuf;

use crate::error::{Error, Result};
use crate::report;
use crate::scene::Calibration;
use crate::study::calibration::{self, CalibrationReport};
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
    let read = Calibration::read(&arguments.calibration)?;
    let stop = signals::stop()?;
    let models = read.models();
    let ready =
        models.iter().map(|(_, it)| calibration::Ready::new(it, &stop)).collect::<Result<Vec<_>>>()?;
    calibration::check_folder(&arguments.output, arguments.force)?;
    let mut found = vec![];
    for ((name, _), ready) in models.iter().zip(ready) {
        match ready.run() {
            Ok(Some(outcome)) => found.push((name.clone(), Ok(outcome))),
            Ok(None) => {
                complain("note", "stopped, nothing was written; the same command begins anew");
                return Ok((String::new(), interrupted()));
            }
            // Of several laws one may fail.
            Err(error) if models.len() > 1 => found.push((name.clone(), Err(error.to_string()))),
            Err(error) => return Err(Failure::Failed(error)),
        }
    }
    let judged = calibration::judged(found);
    let best = &judged[0];
    let outcome = best
        .outcome
        .as_ref()
        .map_err(|why| Failure::Failed(Error::NotConverged { what: "every law", why: why.clone() }))?;
    let (_, own) = models.iter().find(|(name, _)| *name == best.name).expect("every law has its name");
    let compared = if models.len() > 1 { &judged[..] } else { &[] };
    let files = calibration::write(own, outcome, compared, &arguments.output, arguments.force)
        .map_err(Failure::Failed)?;
    let report = CalibrationReport::new(own, outcome, compared, files);
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
