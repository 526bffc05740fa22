//! Runs of many scenes: on all cores, each by itself, until all are done or they are stopped.

use std::num::NonZero;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread::available_parallelism;

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::error::{Domain, Error, Result};
use crate::run::{Shared, Stop};

/// Whoever is told how far many runs have come.
pub trait Progress: Sync {
    /// So many are to be done.
    fn begin(&self, scenes: u64);

    /// One is done.
    fn done(&self, failed: bool);
}

/// What one of many runs came to, or why it failed.
pub(crate) type End<T> = std::result::Result<T, String>;

/// Cores that this process may use, which are the most threads that are started for many runs.
pub fn most_threads() -> usize {
    available_parallelism().map_or(1, NonZero::get)
}

/// Threads for many runs, and what these share.
pub(crate) struct Batch {
    pub(crate) shared: Shared,
    pool: ThreadPool,
}

impl Batch {
    /// Starts the threads, as many as there are cores if no number is given.
    ///
    /// # Errors
    /// [`Error::Option`] if the system does not give them.
    pub(crate) fn new(threads: Option<usize>, shared: Shared) -> Result<Self> {
        let threads = threads.map_or(0, |asked| asked.clamp(1, most_threads()));
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| Error::Option { name: "threads", why: error.to_string() })?;
        Ok(Self { shared, pool })
    }

    /// Does something on the threads of the batch.
    pub(crate) fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        self.pool.install(work)
    }

    /// Does the same on each thread; what comes of it on all of them.
    pub(crate) fn broadcast<T: Send>(&self, work: impl Fn() -> T + Sync) -> Vec<T> {
        self.pool.broadcast(|_| work())
    }

    /// Runs all jobs, and settles each as soon as it has come to an end; none if they were stopped first.
    ///
    /// # Arguments
    /// * `run` -- does one job; none where it was stopped
    /// * `settle` -- takes what came of it
    ///
    /// # Errors
    /// Those of `run` that concern all jobs, see [`alone`]; those of `settle`.
    pub(crate) fn each<J: Sync, T, U: Send>(
        &self,
        jobs: &[J],
        progress: Option<&dyn Progress>,
        run: impl Fn(&J) -> Result<Option<T>> + Sync,
        settle: impl Fn(&J, End<T>) -> Result<U> + Sync,
    ) -> Result<Option<Vec<U>>> {
        if let Some(progress) = progress {
            progress.begin(jobs.len() as u64);
        }
        let one = |job: &J| {
            let end = alone(&self.shared.stop, || run(job)).map_err(Some)?.ok_or(None)?;
            if let Some(progress) = progress {
                progress.done(end.is_err());
            }
            settle(job, end).map_err(Some)
        };
        // One job at a time, whoever is free: nobody knows beforehand which take long.
        let all = || jobs.par_iter().with_max_len(1).map(one).collect::<std::result::Result<Vec<_>, _>>();
        match self.pool.install(all) {
            Ok(settled) => Ok(Some(settled)),
            Err(Some(error)) => Err(error),
            Err(None) => Ok(None),
        }
    }
}

/// Runs one of many, whose failure or panic must not cost the others; none where it was stopped.
///
/// # Errors
/// That of a file, which concerns all: the disk is full, a directory has vanished.
pub(crate) fn alone<T>(stop: &Stop, run: impl FnOnce() -> Result<Option<T>>) -> Result<Option<End<T>>> {
    if stop.is_stopped() {
        return Ok(None);
    }
    match catch_unwind(AssertUnwindSafe(run)) {
        Ok(Ok(end)) => Ok(end.map(Ok)),
        Ok(Err(error)) if error.domain() == Domain::File => Err(error),
        Ok(Err(error)) => Ok(Some(Err(error.to_string()))),
        Err(_) => Ok(Some(Err("the program panicked; please report this scene".into()))),
    }
}

/// Refuses many scenes of which some are not valid.
///
/// # Errors
/// [`Error::Scene`] counts them and shows the first.
pub(crate) fn check_valid(wrong: &[String], total: u64) -> Result<()> {
    const SHOWN: usize = 3;
    match wrong.len() {
        0 => Ok(()),
        count => Err(Error::scene(format!(
            "{count} of {total} scenes are not valid, nothing was run:\n{}",
            wrong[..count.min(SHOWN)].join("\n")
        ))),
    }
}
