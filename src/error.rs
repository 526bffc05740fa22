//! The error type of the library, and what an error is about.

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
    #[error("{shown}")]
    Scene {
        /// The dotted key that it is about, if it is about one.
        key: Option<String>,
        /// The message, with the line and the bad place marked where there is one.
        shown: String,
    },
    /// What is asked of a study besides its file, such as a number of threads or of shards, cannot be.
    #[error("{name}: {why}")]
    Option {
        /// What is asked, in words joined by dashes.
        name: &'static str,
        /// Why it cannot be, and what can.
        why: String,
    },
    /// A file that exists and may not be replaced.
    #[error("{}: exists already; choose another output", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// A file that is damaged or bears no checksum, so that it is not read.
    #[error("{}: {why}; write it again with the command that wrote it", path.display())]
    Unsealed {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// A file that cannot be read or written.
    #[error("{}: {why}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What went wrong and what to do about it.
        why: String,
    },
}

/// What an error is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Domain {
    /// The text of a scene or study, or what is asked besides it.
    Scene,
    /// Values of the physics that cannot be, alone or together.
    Physics,
    /// An iteration that found no end.
    Solver,
    /// A file.
    File,
}

impl Error {
    /// What the error is about.
    ///
    /// ```
    /// use fretwear::{Domain, Error, Scene};
    /// let error = "[indenter.ball]".parse::<Scene>().unwrap_err();
    /// assert_eq!((error.domain(), error.exit_code()), (Domain::Scene, 2));
    /// ```
    pub fn domain(&self) -> Domain {
        match self {
            Self::Scene { .. } | Self::Option { .. } => Domain::Scene,
            Self::OutOfRange { .. } | Self::Inconsistent { .. } => Domain::Physics,
            Self::NotConverged { .. } => Domain::Solver,
            Self::Exists { .. } | Self::Unsealed { .. } | Self::File { .. } => Domain::File,
        }
    }

    /// The dotted key of the scene that the error is about, where it is about one.
    ///
    /// ```
    /// let error = "[indenter.ball]".parse::<fretwear::Scene>().unwrap_err();
    /// assert_eq!(error.key(), Some("indenter.ball"));
    /// ```
    pub fn key(&self) -> Option<&str> {
        match self {
            Self::OutOfRange { name, .. } | Self::Inconsistent { what: name, .. } => {
                Some(*name).filter(|it| it.contains('.'))
            }
            Self::Scene { key, .. } => key.as_deref(),
            _ => None,
        }
    }

    /// The error of a scene, about no key.
    pub(crate) fn scene(shown: String) -> Self {
        Self::Scene { key: None, shown }
    }

    /// The error of a scene as one about a key.
    pub(crate) fn about(self, key: &str) -> Self {
        match self {
            Self::Scene { shown, .. } => Self::Scene { key: Some(key.into()), shown },
            other => other,
        }
    }

    /// Exit code of a program that ends with this error before anything has begun: 1 where a computation failed, 2 where what was given
    /// cannot be used.
    pub fn exit_code(&self) -> u8 {
        if self.domain() == Domain::Solver { 1 } else { 2 }
    }
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
