//! The checksum at the end of a result file, which tells damage before the HDF5 library sees a byte: that library follows damaged files in
//! circles, or ends the program.
//!
//! The last [`LENGTH`] bytes stand behind the end that HDF5 knows of, where its readers do not look:
//!
//! | bytes | |
//! |---|---|
//! | 16 | `fretwear-sha-256` |
//! | 8 | 1, the version of these lines, as the next a little-endian integer |
//! | 8 | length of the HDF5 part in bytes |
//! | 32 | SHA-256 of all bytes before |

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use sha2::{Digest, Sha256};

use super::atomic::failure;
use crate::error::{Error, Result};

/// Length of a seal, bytes.
const LENGTH: usize = 64;
const MARK: [u8; 16] = *b"fretwear-sha-256";
const VERSION: u64 = 1;
/// The part of a seal before its checksum.
const HEAD: usize = LENGTH - 32;

/// What every HDF5 file begins with.
const SIGNATURE: [u8; 8] = *b"\x89HDF\r\n\x1a\n";

const NOT_A_RESULT: &str = "give a file that `fretwear run` or another of its commands wrote";

/// A result file to be read, and whether its checksum is still to be compared.
///
/// # Examples
/// ```no_run
/// use std::path::Path;
/// use fretwear::data::{ResultPath, RunFile};
///
/// let path = Path::new("run.h5");
/// RunFile::open(path)?;                             // refused if the file is damaged
/// RunFile::open(ResultPath::unchecked(path))?;      // a file that another program has added something to
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct ResultPath<'a> {
    path: &'a Path,
    checked: bool,
}

impl<'a> ResultPath<'a> {
    /// A file whose checksum was found to be right, once for all that is read from it. It is not locked: a file that another program writes
    /// into, instead of replacing it, may change afterwards.
    ///
    /// # Errors
    /// [`Error::File`] if it is missing, no HDF5 file, damaged, or has no checksum.
    pub fn checked(path: &'a Path) -> Result<Self> {
        let failed = |error: io::Error| failure(path, &error);
        let mut file = open(path)?;
        let length = file.metadata().map_err(failed)?.len();
        let mut seal = [0; LENGTH];
        let refuse = |why: &str| Err(Error::Unsealed { path: path.to_owned(), why: why.to_owned() });
        if length > LENGTH as u64 {
            file.seek(SeekFrom::End(-(LENGTH as i64))).map_err(failed)?;
            file.read_exact(&mut seal).map_err(failed)?;
        }
        let number = |at: usize| u64::from_le_bytes(std::array::from_fn(|i| seal[at + i]));
        let [version, part] = [MARK.len(), MARK.len() + 8].map(number);
        if seal[..MARK.len()] != MARK {
            return refuse(
                "has no checksum at its end: it was cut short, another program has opened it for writing, or an older fretwear wrote it",
            );
        }
        file.rewind().map_err(failed)?;
        let fits = part == length - LENGTH as u64
            && checksum(file.take(length - LENGTH as u64), &seal[..HEAD]).map_err(failed)? == seal[HEAD..];
        match (fits, version) {
            (false, _) => refuse("is damaged: what it holds does not fit the checksum at its end"),
            (true, VERSION) => Ok(Self { path, checked: true }),
            (true, other) => {
                refuse(&format!("has a checksum of version {other}, and this program knows {VERSION}"))
            }
        }
    }

    /// A file that is read as it is. The HDF5 library may never come back from a damaged one, or end the program.
    pub fn unchecked(path: &'a Path) -> Self {
        Self { path, checked: true }
    }

    /// The file.
    pub fn path(self) -> &'a Path {
        self.path
    }

    /// The file after its check, where that is still to be done, so that the HDF5 library may see it.
    pub(crate) fn ready(self) -> Result<Self> {
        if self.checked { open(self.path).map(|_| self) } else { Self::checked(self.path) }
    }
}

impl<'a, P: AsRef<Path> + ?Sized> From<&'a P> for ResultPath<'a> {
    /// A file that is checked when it is opened.
    fn from(path: &'a P) -> Self {
        Self { path: path.as_ref(), checked: false }
    }
}

/// Opens an HDF5 file, and tells missing and foreign ones.
fn open(path: &Path) -> Result<File> {
    let refuse =
        |why: &str| Err(Error::File { path: path.to_owned(), why: format!("{why}; {NOT_A_RESULT}") });
    let failed = |error: io::Error| failure(path, &error);
    // Before it is opened, which would wait for the other end of a pipe.
    if !fs::metadata(path).map_err(failed)?.is_file() {
        return refuse("is not a file");
    }
    let mut file = File::open(path).map_err(failed)?;
    let mut start = Vec::new();
    Read::by_ref(&mut file).take(SIGNATURE.len() as u64).read_to_end(&mut start).map_err(failed)?;
    match start.as_slice() {
        [] => refuse("is empty"),
        start if start != SIGNATURE => refuse("is not an HDF5 file"),
        _ => Ok(file),
    }
}

/// The bytes of a file with their seal.
pub(super) fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    let head = head(bytes.len() as u64);
    bytes.extend(head);
    let checksum = Sha256::digest(&bytes);
    bytes.extend(checksum);
    bytes
}

/// Adds its seal to a file.
pub(super) fn seal(path: &Path) -> Result<()> {
    let add = || {
        let mut file = OpenOptions::new().read(true).write(true).open(path)?;
        let head = head(file.metadata()?.len());
        let checksum = checksum(&file, &head)?;
        file.seek(SeekFrom::End(0))?;
        file.write_all(&[&head[..], &checksum].concat())
    };
    add().map_err(|error| failure(path, &error))
}

fn head(length: u64) -> [u8; HEAD] {
    let mut head = [0; HEAD];
    head[..MARK.len()].copy_from_slice(&MARK);
    head[MARK.len()..][..8].copy_from_slice(&VERSION.to_le_bytes());
    head[MARK.len() + 8..].copy_from_slice(&length.to_le_bytes());
    head
}

/// SHA-256 of all that is read, and of the head of a seal after it.
fn checksum(mut file: impl Read, head: &[u8]) -> io::Result<[u8; 32]> {
    let mut hasher = Sha256::new();
    let mut buffer = vec![0; 1 << 17];
    loop {
        match file.read(&mut buffer) {
            Ok(0) => break,
            Ok(count) => hasher.update(&buffer[..count]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    hasher.update(head);
    Ok(hasher.finalize().into())
}
