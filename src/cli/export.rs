//! `fretwear export`: tables for spreadsheets and pandas, surfaces for ParaView.

use std::path::PathBuf;

use crate::data::{ResultPath, ResultTables, check_distinct};
use crate::report::TableFile;
use crate::report::export::worn_surface;
use crate::{Error, Result};
use clap::Args;

use super::result_file;

/// Points around the axis.
const SECTORS: usize = 72;

#[derive(Args)]
pub struct Export {
    /// A result file of any kind
    #[arg(value_name = "FILE.h5")]
    file: PathBuf,
    /// A .csv file for a table, or a .vtkhdf file for the worn surface of a run; without it the table goes to stdout
    #[arg(short, long, value_name = "TABLE.csv|SURFACE.vtkhdf")]
    output: Option<PathBuf>,
    /// The table: its dimensions, such as time or time,node, after its group; by default time of a run, scene of a sweep, case, candidate,
    /// and grading,amplitude_ratio of a map
    #[arg(long, value_name = "NAME")]
    table: Option<String>,
    /// List the tables and their columns
    #[arg(long, conflicts_with_all = ["output", "table", "force"])]
    list: bool,
    /// Overwrite the output if it exists
    #[arg(long, requires = "output")]
    force: bool,
    /// Read the result file even if it does not fit its checksum or has none; what is damaged in it may go unnoticed
    #[arg(long)]
    unchecked: bool,
}

/// Writes what was asked for; what is left to print.
pub fn export(arguments: &Export) -> Result<String> {
    if arguments.list {
        return list(arguments);
    }
    let table = arguments.table.as_deref();
    let csv = |file: ResultPath| ResultTables::csv(file, table);
    let checked_csv = || csv(result_file(&arguments.file, arguments.unchecked, csv)?);
    let Some(output) = &arguments.output else { return checked_csv() };
    check_distinct(output, &arguments.file)?;
    match output.extension().and_then(|it| it.to_str()) {
        Some("csv") => {
            let file = TableFile::new(output, arguments.force)?;
            file.write(&checked_csv()?)?;
        }
        Some("vtkhdf") if table.is_none() => {
            // Before the surface is made.
            drop(TableFile::new(output, arguments.force)?);
            let surface = |file: ResultPath| worn_surface(file, SECTORS);
            surface(result_file(&arguments.file, arguments.unchecked, surface)?)?
                .write(output, arguments.force)?;
        }
        Some("vtkhdf") => return Err(refused(output, "a surface has no table; leave out --table")),
        _ => {
            let why = "end the name in .csv for a table, or in .vtkhdf for the worn surface of a run";
            return Err(refused(output, why));
        }
    }
    Ok(String::new())
}

fn refused(output: &std::path::Path, why: &str) -> Error {
    Error::File { path: output.to_owned(), why: why.into() }
}

fn list(arguments: &Export) -> Result<String> {
    let tables = ResultTables::open(result_file(&arguments.file, arguments.unchecked, ResultTables::open)?)?;
    let mut text = String::new();
    for table in tables.summaries()? {
        let usual = if table.name == tables.usual() { ", the one taken by default" } else { "" };
        let rows = if table.rows == 1 { "1 row".into() } else { format!("{} rows", table.rows) };
        text += &format!("{}: {rows}{usual}\n    {}\n", table.name, table.columns.join("  "));
    }
    if let [first, .., last] = &tables.runs()[..] {
        text += &format!(
            "{} runs are kept, {first} to {last}; those of the others have the same tables\n",
            tables.runs().len()
        );
    }
    Ok(text)
}
