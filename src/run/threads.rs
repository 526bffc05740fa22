//! Threads for many runs at once.

use std::num::NonZero;
use std::thread::available_parallelism;

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::{Error, Result};

/// Cores that this process may use, which are the most threads that are started for many runs.
pub fn most_threads() -> usize {
    available_parallelism().map_or(1, NonZero::get)
}

/// Threads for many runs, all cores if no number is given.
///
/// # Errors
/// [`Error::Inconsistent`] if the system does not give them.
pub(crate) fn thread_pool(threads: Option<usize>) -> Result<ThreadPool> {
    let threads = threads.map_or(0, |asked| asked.clamp(1, most_threads()));
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| Error::Inconsistent { what: "--threads", why: error.to_string() })
}
