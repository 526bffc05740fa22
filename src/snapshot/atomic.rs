//! Files that are replaced as a whole: whoever opens one sees the old content or the new one, even after a crash.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

const CHOOSE: &str = "choose another output";

/// One output file and the temporary beside it, `.NAME.PID.tmp`.
#[derive(Debug)]
pub(crate) struct AtomicFile {
    path: PathBuf,
    folder: PathBuf,
    prefix: OsString,
    may_replace: bool,
}

impl AtomicFile {
    /// Checks that `path` can be written, and clears what killed runs left beside it; creates nothing.
    ///
    /// An existing file is replaced only with `overwrite`. A link is followed: the file it points to is replaced.
    ///
    /// # Errors
    /// [`Error::File`] names the path and the cure.
    pub(crate) fn new(path: &Path, overwrite: bool) -> Result<Self> {
        let refuse = |why: &str| Err(Error::File { path: path.to_owned(), why: why.to_owned() });
        let mut target = path.to_owned();
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => return refuse("is a directory; name a file in it"),
            Ok(found) if !found.is_file() => return refuse(&format!("is not a regular file; {CHOOSE}")),
            Ok(_) if !overwrite => {
                return refuse(&format!("exists already; give --force to overwrite it, or {CHOOSE}"));
            }
            Ok(_) => target = fs::canonicalize(path).map_err(|error| failure(path, &error))?,
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(failure(path, &error)),
        }
        let Some(name) = target.file_name() else {
            return refuse("is not the name of a file; name one");
        };
        if target.to_str().is_none() {
            return refuse("is not valid UTF-8, which the HDF5 library needs; rename it");
        }
        let mut prefix = OsString::from(".");
        prefix.push(name);
        prefix.push(".");
        let folder = match target.parent() {
            Some(parent) if parent != Path::new("") => parent.to_owned(),
            _ => PathBuf::from("."),
        };
        remove_abandoned(&folder, |file| OsStr::new(file) == name);
        let this = Self { path: target, folder, prefix, may_replace: overwrite };
        drop(this.temporary().map_err(|error| failure(path, &error))?);
        Ok(this)
    }

    /// The file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Replaces the content, and returns when it is safe on the disk.
    ///
    /// # Errors
    /// [`Error::File`] names the path and the cure; the previous content is then still there.
    pub(crate) fn write(&mut self, bytes: &[u8]) -> Result<()> {
        let written = self.try_write(bytes);
        self.settle(written)
    }

    fn settle(&mut self, written: io::Result<()>) -> Result<()> {
        written.map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists => Error::File {
                path: self.path.clone(),
                why: format!("was created by another program during the run; {CHOOSE}"),
            },
            _ => failure(&self.path, &error),
        })?;
        self.may_replace = true;
        Ok(())
    }

    /// Replaces the content by what `fill` writes into the file of the name it is given, as [`AtomicFile::write`] does.
    ///
    /// # Errors
    /// As [`AtomicFile::write`], and that of `fill`.
    pub(crate) fn write_with(&mut self, fill: impl FnOnce(&Path) -> Result<()>) -> Result<()> {
        let temporary = self.temporary().map_err(|error| failure(&self.path, &error))?;
        fill(&temporary.path)?;
        let written = self.replace(temporary);
        self.settle(written)
    }

    fn try_write(&self, bytes: &[u8]) -> io::Result<()> {
        let mut temporary = self.temporary()?;
        temporary.file.write_all(bytes)?;
        self.replace(temporary)
    }

    /// Gives a temporary its name.
    fn replace(&self, temporary: Temporary) -> io::Result<()> {
        temporary.file.sync_all()?;
        if self.may_replace {
            fs::rename(&temporary.path, &self.path)?;
        } else {
            // A link, other than a renaming, fails where a file has appeared meanwhile.
            match fs::hard_link(&temporary.path, &self.path) {
                Ok(()) => {}
                Err(error) if error.kind() == ErrorKind::AlreadyExists => return Err(error),
                Err(_) if self.path.symlink_metadata().is_ok() => return Err(ErrorKind::AlreadyExists.into()),
                Err(_) => fs::rename(&temporary.path, &self.path)?,
            }
        }
        // The lock was to keep the temporary from being cleared away; other programs that read the file respect it, and a child
        // process started meanwhile would hold on to it.
        let _ = temporary.file.unlock();
        drop(temporary);
        self.synchronise_folder()
    }

    /// Makes the new name safe, where the file system can do that.
    fn synchronise_folder(&self) -> io::Result<()> {
        let Ok(folder) = File::open(&self.folder) else { return Ok(()) };
        match folder.sync_all() {
            Err(error) if !matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => {
                Err(error)
            }
            _ => Ok(()),
        }
    }

    /// An empty temporary, locked so that nobody takes it for a leftover.
    fn temporary(&self) -> io::Result<Temporary> {
        let mut name = self.prefix.clone();
        name.push(format!("{}.tmp", std::process::id()));
        let path = self.folder.join(name);
        let create = || OpenOptions::new().write(true).create_new(true).open(&path);
        let file = match create() {
            // A killed process had the same number.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                fs::remove_file(&path)?;
                create()
            }
            other => other,
        }?;
        let temporary = Temporary { file, path };
        // Without locks on this file system leftovers stay, which does no harm.
        let _ = temporary.file.try_lock();
        Ok(temporary)
    }
}

/// Removes the temporaries in a folder whose processes are gone, their locks with them, of the files whose names satisfy a condition.
pub(crate) fn remove_abandoned(folder: &Path, belongs: impl Fn(&str) -> bool) {
    for path in fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
        let name = path.file_name().and_then(OsStr::to_str).unwrap_or_default();
        let file = name.strip_prefix('.').and_then(|rest| rest.strip_suffix(".tmp"));
        let is_process = |digits: &str| !digits.is_empty() && digits.bytes().all(|it| it.is_ascii_digit());
        let file = file.and_then(|rest| rest.rsplit_once('.')).filter(|(_, process)| is_process(process));
        if file.is_some_and(|(file, _)| belongs(file)) && is_abandoned(&path) {
            // Failing to remove it is no reason to fail, and somebody else may have done so.
            let _ = fs::remove_file(&path);
        }
    }
}

/// Whether nobody holds the lock of a temporary.
fn is_abandoned(path: &Path) -> bool {
    OpenOptions::new().write(true).open(path).is_ok_and(|file| file.try_lock().is_ok())
}

/// A temporary that is removed when dropped, unless it has been renamed by then.
struct Temporary {
    file: File,
    path: PathBuf,
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // After a renaming there is nothing of this name to remove.
        let _ = fs::remove_file(&self.path);
    }
}

/// The error of a file operation, with what to do about it.
pub(crate) fn failure(path: &Path, error: &io::Error) -> Error {
    let cure = match error.kind() {
        ErrorKind::NotFound => "; create its directory first, or check the spelling",
        ErrorKind::NotADirectory => "; a part of the path is a file, check the spelling",
        ErrorKind::PermissionDenied => {
            "; change the permissions of the file or of its directory, or choose another one"
        }
        ErrorKind::ReadOnlyFilesystem => "; choose a directory that can be written",
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
            "; free some space there, or choose another disk"
        }
        ErrorKind::InvalidFilename => "; choose a shorter name",
        _ => "",
    };
    Error::File { path: path.to_owned(), why: format!("{error}{cure}") }
}
