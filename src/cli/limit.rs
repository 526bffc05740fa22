//! `fretwear limit`.

use std::path::PathBuf;

use crate::Result;
use crate::data::check_distinct;
use crate::report::{self, LimitReport, TableFile};
use clap::Args;

use super::{Settings, at, read};

#[derive(Args)]
pub struct Limit {
    /// The scene, a TOML file
    #[arg(value_name = "SCENE.toml")]
    scene: PathBuf,
    #[command(flatten)]
    set: Settings,
    /// Print one JSON object in SI units
    #[arg(long)]
    json: bool,
    /// Write radius, initial and limiting profile and wear depth, all in m, to this file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Radii of the profile, separated by commas, in m or with a unit: 0,1e-5,"20 um"
    #[arg(long, value_name = "R1,R2,...", allow_hyphen_values = true)]
    at: Option<String>,
    /// Overwrite the CSV file if it exists
    #[arg(long, requires = "csv")]
    force: bool,
}

pub fn limit(arguments: &Limit) -> Result<String> {
    let scene = read(&arguments.scene, &arguments.set)?;
    let radii = arguments.at.as_deref().map(report::parse_radii).transpose()?;
    arguments.csv.as_deref().map_or(Ok(()), |path| check_distinct(path, &arguments.scene))?;
    let table = arguments.csv.as_deref().map(|path| TableFile::new(path, arguments.force)).transpose()?;
    let report =
        LimitReport::new(&scene, radii.as_deref()).map_err(at(&scene, &arguments.scene, &arguments.set))?;
    if let Some(table) = table {
        table.write(&report.csv())?;
    }
    Ok(match (arguments.json, radii) {
        (true, _) => report::json(&report),
        (false, Some(_)) => report.text() + "\n" + &report.profile_text(),
        (false, None) => report.text(),
    })
}
