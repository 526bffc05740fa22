//! Signals: those that stop a run at its next step, with a checkpoint.

use std::sync::Arc;

use crate::{Error, Result, Stop};
use signal_hook::consts::{SIGINT, SIGTERM, SIGUSR1, SIGXFSZ};

/// A token that SIGTERM, SIGINT and SIGUSR1 set.
pub fn stop() -> Result<Stop> {
    let stop = Stop::default();
    for signal in [SIGTERM, SIGINT, SIGUSR1] {
        signal_hook::flag::register(signal, Arc::clone(stop.flag())).map_err(|error| {
            Error::Inconsistent { what: "signal handler", why: format!("signal {signal}: {error}") }
        })?;
    }
    Ok(stop)
}

/// Makes a file that grows beyond `ulimit -f` an error that names it, and not the end of the program.
pub fn outlive_full_files() {
    let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
}
