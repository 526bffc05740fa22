//! `fretwear info`.

use std::path::PathBuf;

use crate::Result;
use crate::data::{DatasetSummary, ResultPath};
use crate::report::{self, InfoReport};
use clap::Args;

use super::result_file;

#[derive(Args)]
pub struct Info {
    /// A result file that `fretwear run`, `sweep`, `merge`, `map`, `universality` or `tradeoff` wrote
    #[arg(value_name = "FILE.h5")]
    file: PathBuf,
    /// Print one JSON object in SI units
    #[arg(long)]
    json: bool,
    /// Read the file even if it does not fit its checksum or has none; what is damaged in it may go unnoticed
    #[arg(long, visible_alias = "force")]
    unchecked: bool,
}

pub fn info(arguments: &Info) -> Result<String> {
    let shown = |file: ResultPath| {
        if let Some(summary) = DatasetSummary::read(file)? {
            return Ok(if arguments.json { report::json(&summary) } else { report::arrays_text(&summary) });
        }
        let report = InfoReport::read(file)?;
        Ok(if arguments.json { report::json(&report) } else { report.text() })
    };
    shown(result_file(&arguments.file, arguments.unchecked, shown)?)
}
