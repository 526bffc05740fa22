//! Errors of the library as exceptions.

use fretwear::{Domain, Error};
use pyo3::exceptions::{PyFileExistsError, PyFileNotFoundError, PyOSError};
use pyo3::prelude::*;

/// The exception for an error.
pub fn raised(py: Python, error: &Error) -> PyErr {
    match error {
        Error::Exists { .. } => PyFileExistsError::new_err(error.to_string()),
        Error::File { path, .. } if !path.exists() => PyFileNotFoundError::new_err(error.to_string()),
        _ if error.domain() == Domain::File => PyOSError::new_err(error.to_string()),
        _ if error.domain() == Domain::Solver => own(py, "RunError", (error.to_string(),)),
        _ => scene_error(py, error),
    }
}

/// The exception for an error of what was given: files that are there but cannot be used are bad input too.
pub fn of_input(py: Python, error: &Error) -> PyErr {
    match error {
        Error::File { path, .. } if path.exists() => scene_error(py, error),
        _ => raised(py, error),
    }
}

fn scene_error(py: Python, error: &Error) -> PyErr {
    own(py, "SceneError", (error.to_string(), error.key()))
}

/// A scene that cannot be used, for another reason than the library's.
pub fn refused(py: Python, key: &str, why: &str) -> PyErr {
    own(py, "SceneError", (format!("{key}: {why}"), Some(key)))
}

/// An exception of the package.
fn own<'py>(py: Python<'py>, name: &str, arguments: impl pyo3::call::PyCallArgs<'py>) -> PyErr {
    let made = py.import("fretwear._errors").and_then(|it| it.getattr(name)?.call1(arguments));
    made.map_or_else(|error| error, PyErr::from_value)
}
