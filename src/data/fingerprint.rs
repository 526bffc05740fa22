//! What a result was computed from, as one word.

use sha2::{Digest, Sha256};

use super::layout::FORMAT_VERSION;
use crate::contact::indenter::TabulatedProfile;
use crate::laws::motion::RecordedPath;

/// SHA-256 over parts, each with its length: no two lists of parts run into one another.
#[derive(Default)]
pub(crate) struct Fingerprint(Sha256);

impl Fingerprint {
    pub(crate) fn add(mut self, part: &[u8]) -> Self {
        self.0.update((part.len() as u64).to_le_bytes());
        self.0.update(part);
        self
    }

    /// Adds the bits of numbers.
    pub(crate) fn add_numbers(self, numbers: &[f64]) -> Self {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_bits().to_le_bytes()).collect();
        self.add(&bytes)
    }

    /// Hexadecimal digits.
    pub(crate) fn finish(self) -> String {
        self.0.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// SHA-256 of all that the results of a run depend on, in hexadecimal digits: version of the program and of the format, the scene with its
/// numerics, the rows of a measured profile and of a recorded path.
pub(crate) fn scene_hash(
    program_version: &str,
    scene: &str,
    table: Option<&TabulatedProfile>,
    path: Option<&RecordedPath>,
) -> String {
    let mut parts = Fingerprint::default()
        .add(b"run")
        .add(&FORMAT_VERSION.to_le_bytes())
        .add(program_version.as_bytes())
        .add(scene.as_bytes());
    if let Some(table) = table {
        parts = parts.add(b"table").add_numbers(table.radii()).add_numbers(table.heights());
    }
    if let Some(path) = path {
        parts = parts.add(b"path").add_numbers(&path.x).add_numbers(&path.y).add_numbers(&path.indentation);
    }
    parts.finish()
}
