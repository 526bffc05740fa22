//! `fretwear schema` and `fretwear init`: what helps to write a scene or a calibration.

use std::path::{Path, PathBuf};

use crate::Result;
use crate::report::{self, TableFile};
use crate::scene::page_of_keys;
use crate::scene::schema::FileKind;
use clap::Args;

/// A scene with its alternatives as comments.
const SCENE: &str = include_str!("../../data/template/scene.toml");
/// A calibration, likewise.
const CALIBRATION: &str = include_str!("../../data/template/calibration.toml");

#[derive(Args)]
pub struct Schema {
    /// What kind of file
    #[arg(value_name = "scene|study|map|universality|calibration", default_value = "scene", value_parser = kind)]
    kind: FileKind,
    /// Print the keys of all kinds of files as a page in Markdown instead
    #[arg(long, conflicts_with = "kind")]
    markdown: bool,
    /// File to write instead of stdout
    #[arg(short, long, value_name = "FILE.json")]
    output: Option<PathBuf>,
    /// Overwrite the file if it exists
    #[arg(long, requires = "output")]
    force: bool,
}

#[derive(Args)]
pub struct Init {
    /// What kind of file
    #[arg(value_name = "scene|calibration", default_value = "scene", value_parser = ["scene", "calibration"])]
    kind: String,
    /// The file to write; without it the text goes to stdout
    #[arg(short, long, value_name = "FILE.toml")]
    output: Option<PathBuf>,
    /// Overwrite the file if it exists
    #[arg(long, requires = "output")]
    force: bool,
}

/// The kind of a word.
fn kind(word: &str) -> std::result::Result<FileKind, String> {
    let known = FileKind::ALL.into_iter().find(|kind| kind.name() == word);
    known.ok_or_else(|| format!("give one of {}", FileKind::ALL.map(FileKind::name).join(", ")))
}

/// Writes the JSON Schema; what is left to print.
pub fn schema(arguments: &Schema) -> Result<String> {
    let text = match arguments.markdown {
        true => page_of_keys(),
        false => report::json(&arguments.kind.schema()),
    };
    write(text, arguments.output.as_deref(), arguments.force)
}

/// Writes the scene or the calibration; what is left to print.
pub fn init(arguments: &Init) -> Result<String> {
    let text = if arguments.kind == "calibration" { CALIBRATION } else { SCENE };
    write(text.into(), arguments.output.as_deref(), arguments.force)
}

fn write(text: String, output: Option<&Path>, overwrite: bool) -> Result<String> {
    let Some(path) = output else { return Ok(text) };
    TableFile::new(path, overwrite)?.write(&text)?;
    Ok(String::new())
}
