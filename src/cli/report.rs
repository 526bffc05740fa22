//! `fretwear report`.

use std::path::PathBuf;

use crate::Result;
use crate::data::check_distinct;
use crate::figures::Results;
use crate::figures::page;
use crate::report::TableFile;
use clap::Args;

use super::result_file;

/// The file a page is made of, and where it goes.
#[derive(Args)]
pub struct Report {
    /// A result file that `fretwear run`, `sweep`, `merge`, `map`, `universality` or `tradeoff` wrote
    #[arg(value_name = "FILE.h5")]
    file: PathBuf,
    /// The page, one HTML file that needs nothing else
    #[arg(short, long, value_name = "REPORT.html")]
    output: PathBuf,
    /// Overwrite the page if it exists
    #[arg(long)]
    force: bool,
    /// Read the result file even if it does not fit its checksum or has none; what is damaged in it may go unnoticed
    #[arg(long)]
    unchecked: bool,
}

pub fn report(arguments: &Report) -> Result<String> {
    check_distinct(&arguments.output, &arguments.file)?;
    let file = TableFile::new(&arguments.output, arguments.force)?;
    let results = Results::read(result_file(&arguments.file, arguments.unchecked, Results::read)?)?;
    file.write(&page::report(&results, &arguments.file)?)?;
    Ok(String::new())
}
