//! Text that a user names: read whole up to a bound, and never waited for without end.
//!
//! What is no regular file is told before it is opened: a device has no end, and a pipe without a writer would be waited for. A pipe, which is
//! what a shell makes of `<(...)` and of `/dev/stdin`, is read where the caller allows it; it may be silent for [`PATIENCE`].

use std::fs::{File, FileType, Metadata, OpenOptions};
use std::io::{self, ErrorKind, Read};
use std::path::Path;
use std::time::{Duration, Instant};

const PATIENCE: Duration = Duration::from_secs(10);
const PAUSE: Duration = Duration::from_millis(2);

/// Whether a pipe is read: only once, so not where a file may be looked at again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pipes {
    /// It is read to its end.
    Read,
    /// It is refused.
    Refused,
}

/// Why a file is not read; messages add the cure.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Unread {
    #[error("there is no such file")]
    Missing,
    #[error("is a directory")]
    Directory,
    #[error("is not a regular file")]
    Device,
    #[error("is larger than {0} bytes")]
    TooLarge(u64),
    #[error("is a pipe into which nothing is written")]
    Silent,
    #[error("cannot be read: {0}")]
    Failed(io::Error),
    #[error("line {0} is not UTF-8 text")]
    NotText(usize),
}

impl From<io::Error> for Unread {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            ErrorKind::NotFound => Self::Missing,
            ErrorKind::IsADirectory => Self::Directory,
            _ => Self::Failed(error),
        }
    }
}

/// The content of a file of at most so many bytes.
///
/// # Errors
/// [`Unread`] says why there is none.
pub(crate) fn bytes(path: &Path, most: u64, pipes: Pipes) -> Result<Vec<u8>, Unread> {
    let found = std::fs::metadata(path)?;
    let is_pipe = readable(&found, most, pipes)?;
    // A pipe without a writer must not hold the program up.
    let file = open_at_once(path)?;
    // What is opened may have taken the place of what was looked at.
    if is_pipe != readable(&file.metadata()?, most, pipes)? {
        return Err(Unread::Device);
    }
    let mut bytes = Vec::new();
    // One byte past the limit tells a file that is too large from one that just fits.
    let file = file.take(most + 1);
    if is_pipe {
        drain(file, &mut bytes)?
    } else {
        read(file, &mut bytes)?
    }
    if bytes.len() as u64 > most { Err(Unread::TooLarge(most)) } else { Ok(bytes) }
}

/// Opens a file; a pipe without a writer does not block.
#[cfg(unix)]
fn open_at_once(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    OpenOptions::new().read(true).custom_flags(libc::O_NONBLOCK).open(path)
}

#[cfg(not(unix))]
fn open_at_once(path: &Path) -> io::Result<File> {
    OpenOptions::new().read(true).open(path)
}

#[cfg(unix)]
fn is_pipe(kind: FileType) -> bool {
    std::os::unix::fs::FileTypeExt::is_fifo(&kind)
}

#[cfg(not(unix))]
fn is_pipe(_: FileType) -> bool {
    false
}

/// The same as text.
pub(crate) fn text(bytes: Vec<u8>) -> Result<String, Unread> {
    String::from_utf8(bytes).map_err(|error| {
        let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        Unread::NotText(valid.iter().filter(|&&byte| byte == b'\n').count() + 1)
    })
}

/// Whether a file is a pipe, if it may be read at all.
fn readable(found: &Metadata, most: u64, pipes: Pipes) -> Result<bool, Unread> {
    let kind = found.file_type();
    match (kind.is_file(), is_pipe(kind) && pipes == Pipes::Read) {
        _ if kind.is_dir() => Err(Unread::Directory),
        (true, _) if found.len() > most => Err(Unread::TooLarge(most)),
        (true, _) => Ok(false),
        (false, true) => Ok(true),
        (false, false) => Err(Unread::Device),
    }
}

fn read(mut file: io::Take<File>, bytes: &mut Vec<u8>) -> Result<(), Unread> {
    file.read_to_end(bytes)?;
    Ok(())
}

/// Reads a pipe to its end, which is where its last writer has gone.
fn drain(mut pipe: io::Take<File>, bytes: &mut Vec<u8>) -> Result<(), Unread> {
    let mut buffer = vec![0; 1 << 16];
    let mut heard = Instant::now();
    loop {
        match pipe.read(&mut buffer) {
            Ok(0) if bytes.is_empty() => return Err(Unread::Silent),
            Ok(0) => return Ok(()),
            Ok(count) => {
                bytes.extend_from_slice(&buffer[..count]);
                heard = Instant::now();
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) if error.kind() == ErrorKind::WouldBlock => {
                if heard.elapsed() > PATIENCE {
                    return Err(Unread::Silent);
                }
                std::thread::sleep(PAUSE);
            }
            Err(error) => return Err(error.into()),
        }
    }
}
