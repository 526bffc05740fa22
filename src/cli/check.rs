//! `fretwear check`.

use std::path::PathBuf;

use clap::Args;
use fretwear::report::{self, CheckReport};
use fretwear::{Result, Scene};

use super::{at, complain};

#[derive(Args)]
pub struct Check {
    /// The scene, a TOML file
    #[arg(value_name = "SCENE.toml")]
    scene: PathBuf,
    /// Print one JSON object in SI units
    #[arg(long)]
    json: bool,
}

pub fn check(arguments: &Check) -> Result<String> {
    let scene = Scene::read(&arguments.scene)?;
    let report = CheckReport::new(&scene).map_err(at(&scene, &arguments.scene))?;
    report.warnings.iter().for_each(|warning| complain("warning", warning));
    Ok(if arguments.json { report::json(&report) } else { report.text() })
}
