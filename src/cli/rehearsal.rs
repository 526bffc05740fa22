//! Reading a file for which no checksum vouches: first in a process of its own, because the HDF5 library follows damaged files in circles, or ends
//! the program.

use std::path::Path;

use crate::{Error, Result};

/// Seconds of a processor that reading may take, and one more for every so many bytes.
const PATIENCE: u64 = 1;
const BYTES_A_SECOND: u64 = 4 << 20;

/// Reads in another process, whose end tells whether this one may.
///
/// # Errors
/// [`Error::File`] if that process panicked, took too long or was ended by a signal.
#[cfg(unix)]
pub fn survived(path: &Path, read: impl FnOnce()) -> Result<()> {
    let length = std::fs::metadata(path).map_or(0, |it| it.len());
    let seconds = PATIENCE + length / BYTES_A_SECOND;
    let failed = |why| Err(Error::File { path: path.to_owned(), why });
    // SAFETY: commands start no thread before they have read their file, so the child finds every lock free; it ends without a return from here.
    let child = unsafe { libc::fork() };
    if child == 0 {
        let never = libc::timeval { tv_sec: 0, tv_usec: 0 };
        let end = libc::timeval { tv_sec: seconds as libc::time_t, ..never };
        let timer = libc::itimerval { it_interval: never, it_value: end };
        // SAFETY: the timer is valid, and what was set before is not asked for.
        unsafe {
            libc::signal(libc::SIGPROF, libc::SIG_DFL);
            libc::setitimer(libc::ITIMER_PROF, &raw const timer, std::ptr::null_mut());
        }
        // The bindings of the library panic at what it returns from some damage.
        std::panic::set_hook(Box::new(|_| {}));
        let read = std::panic::catch_unwind(std::panic::AssertUnwindSafe(read));
        // SAFETY: what the parent has begun, such as files, is left to it.
        unsafe { libc::_exit(read.is_err().into()) };
    }
    let mut status = 0;
    // SAFETY: the place for the status is valid; a signal may interrupt the wait.
    while child > 0 && unsafe { libc::waitpid(child, &raw mut status, 0) } < 0 {
        let error = std::io::Error::last_os_error();
        if error.kind() != std::io::ErrorKind::Interrupted {
            return failed(format!("the process that reads it cannot be waited for ({error})"));
        }
    }
    let signal = libc::WIFSIGNALED(status).then(|| libc::WTERMSIG(status));
    failed(match (child, signal) {
        (-1, _) => {
            format!("no process could be started to read it in ({})", std::io::Error::last_os_error())
        }
        (_, Some(libc::SIGPROF)) => {
            format!("is damaged: the HDF5 library did not come to its end in {seconds} s of computing")
        }
        (_, Some(signal)) => format!("is damaged: the HDF5 library was ended by signal {signal}"),
        (_, None) if status != 0 => "is damaged: what the HDF5 library gives makes no sense".into(),
        _ => return Ok(()),
    })
}

#[cfg(not(unix))]
pub fn survived(_: &Path, _: impl FnOnce()) -> Result<()> {
    Ok(())
}
