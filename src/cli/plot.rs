//! `fretwear plot`.

use std::path::{Path, PathBuf};

use crate::Result;
use crate::data::check_distinct;
use crate::figures::{FigureFile, Kind, Results};
use clap::Args;

use super::result_file;

/// The file a figure is made of, and where it goes.
#[derive(Args)]
pub struct Plot {
    /// A result file that `fretwear run`, `sweep`, `merge`, `map`, `universality` or `tradeoff` wrote
    #[arg(value_name = "FILE.h5")]
    file: PathBuf,
    /// The picture, SVG or PNG by the ending of its name
    #[arg(short, long, value_name = "FIGURE.svg|.png")]
    output: PathBuf,
    /// What it shows; by default what tells most about the file
    #[arg(long, value_name = "KIND", value_parser = kind)]
    kind: Option<Kind>,
    /// Which result of a sweep is drawn, the name of a dataset; by default the worn volume
    #[arg(long, value_name = "NAME")]
    quantity: Option<String>,
    /// Overwrite the picture if it exists
    #[arg(long)]
    force: bool,
    /// Read the result file even if it does not fit its checksum or has none; what is damaged in it may go unnoticed
    #[arg(long)]
    unchecked: bool,
}

/// The kind of a word.
pub fn kind(word: &str) -> std::result::Result<Kind, String> {
    let known = Kind::ALL.into_iter().find(|kind| kind.name() == word);
    known.ok_or_else(|| {
        format!("give one of {}; which of them fit depends on the file", Kind::ALL.map(Kind::name).join(", "))
    })
}

pub fn plot(arguments: &Plot) -> Result<String> {
    check_distinct(&arguments.output, &arguments.file)?;
    let file = FigureFile::new(&arguments.output, arguments.force)?;
    let results = Results::read(result_file(&arguments.file, arguments.unchecked, Results::read)?)?;
    // A result file that can be read has at least one kind but for a run without a snapshot, whose profile says so.
    let kind = arguments.kind.or_else(|| results.kinds().first().copied()).unwrap_or(Kind::Profile);
    file.write(&results.figure(kind, arguments.quantity.as_deref())?)?;
    Ok(String::new())
}

/// Draws the worn profile of a run that has been written to `result`.
pub fn draw_run(result: &Path, picture: FigureFile) -> Result<()> {
    picture.write(&Results::read(result)?.figure(Kind::Profile, None)?)
}
