//! `fretwear map`.

use std::path::PathBuf;

use crate::Result;
use crate::report;
use crate::scene::MapScene;
use crate::study::wear_map::MapReport;
use clap::Args;

#[derive(Args)]
pub struct Map {
    /// What to compare, a TOML file; by default a paraboloid under elastic similarity
    #[arg(value_name = "MAP.toml")]
    map: Option<PathBuf>,
    /// Directory for map.h5 and its CSV tables, made if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Overwrite files that exist
    #[arg(long)]
    force: bool,
}

pub fn map(arguments: &Map) -> Result<String> {
    let scene = arguments.map.as_deref().map(MapScene::read).transpose()?.unwrap_or_default();
    let report = MapReport::write(&scene, &arguments.output, arguments.force)?;
    Ok(if arguments.json { report::json(&report) } else { report.text() })
}
