//! The one error type of the library.

use std::path::PathBuf;

/// What can go wrong, with the numbers that explain it.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A value lies outside its physical range.
    #[error("{name} = {value} is outside {range}")]
    OutOfRange {
        /// Name of the quantity, as in the scene (`half_space.grading`).
        name: &'static str,
        /// The value given.
        value: f64,
        /// The range allowed, in words or as an interval.
        range: &'static str,
    },
    /// A quantity cannot be formed from values that are each allowed.
    #[error("{what}: {why}")]
    Inconsistent {
        /// The quantity asked for.
        what: &'static str,
        /// Why it does not exist, with the numbers.
        why: String,
    },
    /// An iteration did not reach its tolerance.
    #[error("{what} did not converge: {why}")]
    NotConverged {
        /// The iteration.
        what: &'static str,
        /// How far it came, with the numbers.
        why: String,
    },
    /// A scene that cannot be used; the message shows the line and the key.
    #[error("{0}")]
    Scene(String),
    /// A file that cannot be read or written.
    #[error("{}: {why}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What went wrong and what to do about it.
        why: String,
    },
}

/// Result of a fallible function of this library.
pub type Result<T> = std::result::Result<T, Error>;

/// The known word that was probably meant by another, and how alike the two are, from 0 to 1.
pub(crate) fn most_alike<'a>(word: &str, known: &[&'a str]) -> Option<(f64, &'a str)> {
    let folded = |text: &str| text.to_lowercase().replace(['-', ' '], "_");
    let target = folded(word);
    let near = known.iter().map(|known| (strsim::jaro_winkler(&target, &folded(known)), *known));
    near.max_by(|a, b| a.0.total_cmp(&b.0))
}
