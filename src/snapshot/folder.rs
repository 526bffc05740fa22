//! Folders of results, and the cells of tables in them.

use std::path::Path;

use super::AtomicFile;
use crate::error::{Error, Result};

/// Makes a directory if it is missing.
///
/// # Errors
/// [`Error::File`] names it.
pub(crate) fn make_folder(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|error| Error::File {
        path: folder.to_owned(),
        why: format!("the directory cannot be made: {error}"),
    })
}

/// Makes a directory if it is missing, and checks that all files can be written there; creates no file.
///
/// # Errors
/// [`Error::File`] names the file or the directory and the cure.
pub(crate) fn check_folder(folder: &Path, names: &[&str], overwrite: bool) -> Result<()> {
    make_folder(folder)?;
    names.iter().try_for_each(|name| AtomicFile::new(&folder.join(name), overwrite).map(drop))
}

/// A number with all its digits; nothing where it is not a number.
pub(crate) fn cell(value: f64) -> String {
    if value.is_nan() { String::new() } else { format!("{value:e}") }
}

/// A cell of words; quotes where it needs them.
pub(crate) fn quoted(word: &str) -> String {
    match word.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", word.replace('"', "\"\"")),
        false => word.to_owned(),
    }
}

/// A table with its header.
///
/// # Arguments
/// * `names` -- of the columns
/// * `rows` -- as many cells each
pub(crate) fn table<'a>(
    names: impl Iterator<Item = &'a str>,
    rows: impl Iterator<Item = Vec<String>>,
) -> String {
    let mut table = names.collect::<Vec<_>>().join(",") + "\n";
    rows.for_each(|cells| table += &(cells.join(",") + "\n"));
    table
}
