//! `fretwear merge`.

use std::path::PathBuf;

use crate::report;
use crate::study::sweep::{self, MergeReport};
use clap::Args;

use super::end::{End, FAILURE, SUCCESS};

#[derive(Args)]
pub struct Merge {
    /// Directory of a sweep
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// The merged file
    #[arg(short, long, value_name = "FILE.h5")]
    output: PathBuf,
    /// Print the summary as one JSON object
    #[arg(long)]
    json: bool,
    /// Overwrite the merged file if it exists
    #[arg(long)]
    force: bool,
}

pub fn merge(arguments: &Merge) -> End {
    let merged = sweep::merge(&arguments.folder, &arguments.output, arguments.force)?;
    let report = MergeReport::new(&merged, &arguments.output);
    let code = if merged.missing_shards.is_empty() { SUCCESS } else { FAILURE };
    Ok((if arguments.json { report::json(&report) } else { report.text() }, code))
}
