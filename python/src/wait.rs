//! Waiting for the library without holding Python up: signals are seen, and whoever asked is told how far things are.

use std::panic::resume_unwind;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use fretwear::Stop;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

/// How often Python is asked for signals: a fifth of the tenth of a second within which a run is to stop.
const PAUSE: Duration = Duration::from_millis(20);

/// What is called with a value while something goes on.
pub struct Call<'a> {
    pub callback: Option<Py<PyAny>>,
    /// How much is done, and of how much.
    pub value: &'a (dyn Fn() -> (f64, f64) + Sync),
}

/// Does something that stops when it is told to; what came of it, and whether the user stopped it.
///
/// # Errors
/// Exceptions of signal handlers and of the callback, other than `KeyboardInterrupt`, after all has stopped.
pub fn waited<T: Send>(
    py: Python,
    stop: &Stop,
    call: &Call,
    work: impl FnOnce() -> T + Send,
) -> PyResult<(T, bool)> {
    let (outcome, raised) = py.detach(|| {
        thread::scope(|scope| {
            let (done, is_done) = sync_channel(0);
            let worker = scope.spawn(move || {
                let outcome = work();
                // Whoever waits is there until this thread has ended.
                let _ = done.send(());
                outcome
            });
            let mut raised = None;
            while is_done.recv_timeout(PAUSE) == Err(RecvTimeoutError::Timeout) {
                if raised.is_none()
                    && let Err(error) = Python::attach(|py| call.now(py))
                {
                    stop.stop();
                    raised = Some(error);
                }
            }
            (worker.join().unwrap_or_else(|panic| resume_unwind(panic)), raised)
        })
    });
    match raised {
        Some(error) if !error.is_instance_of::<PyKeyboardInterrupt>(py) => Err(error),
        Some(_) => Ok((outcome, true)),
        None => call.now(py).map(|()| (outcome, false)),
    }
}

/// What has come of work that the user has not stopped.
///
/// # Errors
/// `KeyboardInterrupt`, also where the work was done by the time that it would have stopped: a caller's loop is to stop as well.
pub fn to_the_end<T>((outcome, stopped): (T, bool)) -> PyResult<T> {
    if stopped { Err(PyKeyboardInterrupt::new_err(())) } else { Ok(outcome) }
}

impl Call<'_> {
    fn now(&self, py: Python) -> PyResult<()> {
        py.check_signals()?;
        self.callback.as_ref().map_or(Ok(()), |callback| callback.call1(py, (self.value)()).map(drop))
    }
}
