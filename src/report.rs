//! What the commands say: tables for people, JSON and CSV for programs.
//!
//! Each report is data in SI with a `text`, and is turned to JSON by [`json`]. Nothing here prints.

mod check;
mod conditions;
#[cfg(feature = "hdf5")]
pub mod export;
#[cfg(feature = "hdf5")]
mod info;
mod limit;
mod run;
mod text;

pub use check::CheckReport;
#[cfg(feature = "hdf5")]
pub use info::{InfoReport, arrays_text};
pub use limit::{LimitReport, ProfileTable, parse_radii};
pub use run::RunReport;
pub(crate) use text::{Scale, TextTable, number};

#[cfg(feature = "hdf5")]
use std::path::Path;

use serde::Serialize;

#[cfg(feature = "hdf5")]
use crate::data::AtomicFile;
use crate::error::Error;
#[cfg(feature = "hdf5")]
use crate::error::Result;

/// One JSON object, keys in the order of declaration; a number that is not finite is null.
pub fn json(report: &impl Serialize) -> String {
    serde_json::to_string_pretty(report).expect("reports have string keys and plain values only") + "\n"
}

#[cfg(feature = "hdf5")]
/// A table of text that is written as a whole or not at all.
#[derive(Debug)]
pub struct TableFile(AtomicFile);

#[cfg(feature = "hdf5")]
impl TableFile {
    /// Checks that the file can be written; creates nothing.
    ///
    /// # Errors
    /// [`Error::File`] if the file exists and `overwrite` is not given, or its directory is missing or cannot be written.
    pub fn new(path: &Path, overwrite: bool) -> Result<Self> {
        AtomicFile::new(path, overwrite).map(Self)
    }

    /// Writes the file.
    ///
    /// # Errors
    /// [`Error::File`] names the file and the cure.
    pub fn write(mut self, text: &str) -> Result<()> {
        self.0.write(text.as_bytes())
    }
}

/// Zero without its sign.
fn unsigned_zero(value: f64) -> f64 {
    value + 0.0
}

fn bad_option(name: &'static str, why: String) -> Error {
    Error::Option { name, why }
}
