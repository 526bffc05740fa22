//! How the program ends: exit codes, and errors in the words of the command line.

use crate::Error;
use crate::run::Results;

/// What the help says of exit codes.
pub const EXIT_CODES: &str = "Exit codes: 0 done; 1 the run failed; 2 bad usage or bad input, nothing written; \
3 done, but the accuracy asked for was not reached; 75 stopped by a signal with a checkpoint written.\nResults go to stdout, everything else to stderr.";

/// Exit code of what was done.
pub const SUCCESS: u8 = 0;

/// Exit code of what failed.
pub const FAILURE: u8 = 1;

/// Exit code of what came to its end less accurately than was asked for; its results are kept.
pub const INACCURATE: u8 = 3;

/// Exit code of a run that a signal stopped with a checkpoint written.
const INTERRUPTED: u8 = 75;

/// What is left to print, and the exit code.
pub type End = std::result::Result<(String, u8), Failure>;

/// Why a command came to no end.
pub enum Failure {
    /// Before anything was begun, as a rule because of what was given.
    Refused(Error),
    /// After what was given had been found in order.
    Failed(Error),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Refused(error)
    }
}

impl Failure {
    /// The exit code.
    pub fn code(&self) -> u8 {
        match self {
            Self::Refused(error) => error.exit_code(),
            Self::Failed(_) => FAILURE,
        }
    }

    /// The message.
    pub fn words(&self) -> String {
        let (Self::Refused(error) | Self::Failed(error)) = self;
        words(error)
    }
}

/// An error with the option that cures it.
pub fn words(error: &Error) -> String {
    match error {
        Error::Exists { path } => {
            format!(
                "{}: exists already; give --force to overwrite it, or choose another output",
                path.display()
            )
        }
        Error::Unsealed { .. } => format!(
            "{error}, or give --unchecked to info, export, plot, report or run --resume, which then read it as it is"
        ),
        Error::Option { .. } => format!("--{error}"),
        error => error.to_string(),
    }
}

/// The end of a command that has done what it was asked.
pub fn done(text: String) -> (String, u8) {
    (text, SUCCESS)
}

/// The exit code of what was stopped and can go on.
pub fn interrupted() -> u8 {
    INTERRUPTED
}

/// The exit code of a run.
pub fn of_run(results: &Results) -> u8 {
    match (results.is_complete(), results.accuracy_met()) {
        (false, _) => interrupted(),
        (true, Some(false)) => INACCURATE,
        (true, _) => SUCCESS,
    }
}
