//! Files that are replaced as a whole: whoever opens one sees the old content or the new one, even after a crash.

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use super::scratch::{CONTENT, Scratch, remove_leftovers};
use crate::error::{Error, Result};

const CHOOSE: &str = "choose another output";

/// One output file, and the temporary in a directory of its own beside it.
#[derive(Debug)]
pub(crate) struct AtomicFile {
    path: PathBuf,
    folder: PathBuf,
    name: String,
    may_replace: bool,
}

impl AtomicFile {
    /// Checks that `path` can be written, and clears what killed runs left beside it; creates nothing.
    ///
    /// An existing file is replaced only with `overwrite`. A link is followed: the file it points to is replaced, or made if it is missing.
    ///
    /// # Errors
    /// [`Error::File`] names the path and the cure.
    pub(crate) fn new(path: &Path, overwrite: bool) -> Result<Self> {
        let refuse = |why: &str| Err(Error::File { path: path.to_owned(), why: why.to_owned() });
        let target = match fs::metadata(path) {
            Ok(found) if found.is_dir() => return refuse("is a directory; name a file in it"),
            Ok(found) if !found.is_file() => return refuse(&format!("is not a regular file; {CHOOSE}")),
            Ok(_) if !overwrite => {
                return Err(Error::Exists { path: path.to_owned() });
            }
            Ok(_) => fs::canonicalize(path),
            Err(error) if error.kind() == ErrorKind::NotFound => end_of_links(path),
            Err(error) => Err(error),
        };
        let target = target.map_err(|error| failure(path, &error))?;
        if target.file_name().is_none() || path.as_os_str().as_encoded_bytes().ends_with(b"/") {
            return refuse("is not the name of a file; name one");
        }
        let Some(name) = target.to_str().and(target.file_name()).and_then(|name| name.to_str()) else {
            return refuse("is not valid UTF-8, which the HDF5 library needs; rename it");
        };
        let name = name.to_owned();
        let folder = match target.parent() {
            Some(parent) if parent != Path::new("") => parent.to_owned(),
            _ => PathBuf::from("."),
        };
        remove_abandoned(&folder, |file| file == name);
        let this = Self { path: target, folder, name, may_replace: overwrite };
        let tried = this.temporary().map_err(|error| failure(&this.path, &error))?;
        if !tried.may_replace(&this) {
            return refuse(&format!(
                "belongs to another user, and its directory lets nobody else replace it; {CHOOSE}"
            ));
        }
        drop(tried);
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
            if let Ok(found) = fs::metadata(&self.path) {
                // Who may read it stays as it was; where that cannot be, the file is still the user's.
                let _ = temporary.file.set_permissions(found.permissions());
            }
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

    /// An empty temporary.
    fn temporary(&self) -> io::Result<Temporary> {
        let scratch = Scratch::new(&self.folder, &purpose(&self.name))?;
        let path = scratch.path().join(CONTENT);
        let file = OpenOptions::new().write(true).create_new(true).open(&path)?;
        Ok(Temporary { file, path, _scratch: scratch })
    }
}

/// What the directory of a temporary is for.
fn purpose(name: &str) -> String {
    format!("temporary of {name}")
}

/// Removes the temporaries in a folder whose processes are gone, of the files whose names satisfy a condition.
pub(crate) fn remove_abandoned(folder: &Path, belongs: impl Fn(&str) -> bool) {
    remove_leftovers(folder, |found| found.strip_prefix(&purpose("")).is_some_and(&belongs));
}

/// The place that links lead to, where there is nothing.
fn end_of_links(path: &Path) -> io::Result<PathBuf> {
    const MOST_LINKS: usize = 40;
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(next) => path = path.parent().unwrap_or(Path::new("")).join(next),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("is a link that leads nowhere"))
}

/// A temporary that is removed with its directory when dropped, unless it has been renamed by then.
struct Temporary {
    file: File,
    path: PathBuf,
    _scratch: Scratch,
}

impl Temporary {
    /// Whether it can take the place of the file that is there: in a directory such as /tmp only owners can do that.
    #[cfg(unix)]
    fn may_replace(&self, target: &AtomicFile) -> bool {
        use std::os::unix::fs::MetadataExt;
        const STICKY: u32 = 0o1000;
        let found = [fs::metadata(&target.path), fs::metadata(&target.folder), self.file.metadata()];
        let [Ok(there), Ok(folder), Ok(own)] = found else { return true };
        let user = own.uid();
        folder.mode() & STICKY == 0 || [0, there.uid(), folder.uid()].contains(&user)
    }

    #[cfg(not(unix))]
    fn may_replace(&self, _: &AtomicFile) -> bool {
        true
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
