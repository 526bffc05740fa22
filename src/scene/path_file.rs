//! The file of a recorded path: columns x, y and, where it changes, the indentation.

use std::path::Path;

use super::columns::{self, Kind};
use crate::error::{Error, Result};
use crate::laws::loading::RecordedPath;

/// Reads a path; its rows are in the order of time.
///
/// # Arguments
/// * `path` -- the file, as [`columns::read`] takes it
/// * `name` -- what the path is called
/// * `unit` -- of all columns, of length
///
/// # Errors
/// [`Error::File`] names the file, the line, what stands there and the cure.
pub(super) fn read(path: &Path, name: &str, unit: &str) -> Result<RecordedPath> {
    let kind = Kind {
        key: "loading.path.file",
        what: "a path",
        columns: ["two or three", "x, y and the indentation over that of the scene"],
        names: &["x", "y", "indentation"],
        units: &[unit; 3],
        fewest: 2,
        most_rows: RecordedPath::MOST_ROWS,
        check: |_| Ok(()),
    };
    let rows = columns::read(path, &kind)?;
    let column =
        |place: usize| rows.iter().map(|row| row.metres.get(place).copied().unwrap_or(0.0)).collect();
    RecordedPath::new(name, column(0), column(1), column(2)).map_err(|error| match error {
        Error::Inconsistent { why, .. } => Error::File { path: path.to_owned(), why },
        other => other,
    })
}
