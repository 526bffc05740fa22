//! `fretwear check`.

use std::path::PathBuf;

use crate::report::{self, CheckReport};
use crate::{Result, Scene};
use clap::Args;

use super::{Settings, at, complain};

#[derive(Args)]
pub struct Check {
    /// The scene, a TOML file
    #[arg(value_name = "SCENE.toml")]
    scene: PathBuf,
    #[command(flatten)]
    set: Settings,
    /// Print one JSON object in SI units
    #[arg(long)]
    json: bool,
}

pub fn check(arguments: &Check) -> Result<String> {
    let scene = Scene::read_with(&arguments.scene, &arguments.set.settings)?;
    let report = CheckReport::new(&scene).map_err(at(&scene, &arguments.scene, &arguments.set))?;
    report.warnings.iter().for_each(|warning| complain("warning", warning));
    Ok(if arguments.json { report::json(&report) } else { report.text() })
}
