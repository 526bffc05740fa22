//! Directories of this program's own, for what is not finished: a name that no other has, a marker inside that says what it is for,
//! and a lock on the marker while somebody works in it.
//!
//! What a killed process left is known by its marker and by the lock that nobody holds. Nothing is ever removed by the name of its
//! directory alone, and of a directory's content only what this program puts there.

use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

/// Beginning of the names.
const PREFIX: &str = ".fretwear-";

/// Name of the marker.
const MARKER: &str = "marker";

/// What a marker begins with; its purpose follows.
const OWN: &str =
    "This directory is fretwear's own. It holds what is not finished, and is removed by the program.\n";

/// Longest marker that is read, bytes: the purpose is a few words or the name of a file.
const LONGEST_MARKER: u64 = 4096;

/// Name of the one file of a directory that is written for another place.
pub(super) const CONTENT: &str = "content";

/// Endings of files that are kept for a while.
const ENDINGS: [&str; 2] = ["h5", "json"];

/// How often a new directory is tried, of which each may have been taken for a leftover before it was marked.
const MOST_TRIES: usize = 100;

/// A directory that is removed when dropped, with what this program put there.
#[derive(Debug)]
pub(crate) struct Scratch {
    path: PathBuf,
    /// Holds the lock; none where the file system has no locks, or the directory is to stay.
    marker: Option<File>,
}

impl Scratch {
    /// A new directory inside another.
    pub(crate) fn new(folder: &Path, purpose: &str) -> io::Result<Self> {
        for _ in 0..MOST_TRIES {
            let path = tempfile::Builder::new().prefix(PREFIX).rand_bytes(12).tempdir_in(folder)?.keep();
            // From here on it is removed whatever happens.
            let mut this = Self { path, marker: None };
            match this.mark(purpose) {
                Ok(true) => return Ok(this),
                Ok(false) => {}
                // Somebody took it for a leftover.
                Err(error) if error.kind() == ErrorKind::NotFound && folder.is_dir() => {}
                Err(error) => return Err(error),
            }
        }
        Err(io::Error::other("no directory for temporary files stays in place; try again later"))
    }

    /// One that another process left for the same purpose, or a new one.
    pub(crate) fn take_up(folder: &Path, purpose: &str) -> io::Result<Self> {
        match Leftover::all_in(folder).find(|it| it.purpose == purpose) {
            Some(Leftover { path, marker, .. }) => Ok(Self { path, marker: Some(marker) }),
            None => Self::new(folder, purpose),
        }
    }

    /// Locks and writes the marker; false if another process was faster.
    fn mark(&mut self, purpose: &str) -> io::Result<bool> {
        let path = self.path.join(MARKER);
        let mut marker = OpenOptions::new().write(true).create_new(true).open(&path)?;
        // Before there is a word in it: an empty marker that nobody holds is a leftover.
        if matches!(marker.try_lock(), Err(TryLockError::WouldBlock)) {
            return Ok(false);
        }
        marker.write_all(format!("{OWN}{purpose}").as_bytes())?;
        self.marker = Some(marker);
        Ok(path.exists())
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Leaves the directory where it is, for a later process to take up.
    pub(crate) fn keep(mut self) {
        self.path = PathBuf::new();
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        if self.path != Path::new("") {
            remove(&self.path);
        }
    }
}

/// A directory of a process that is gone; holds its lock.
struct Leftover {
    path: PathBuf,
    /// Empty if the process was killed before it could say.
    purpose: String,
    marker: File,
}

impl Leftover {
    fn all_in(folder: &Path) -> impl Iterator<Item = Self> {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        entries.filter_map(|entry| {
            let named = entry.file_name().to_str().is_some_and(|name| name.starts_with(PREFIX));
            // Never through a link.
            let is_folder = entry.file_type().is_ok_and(|it| it.is_dir());
            (named && is_folder).then(|| Self::new(entry.path())).flatten()
        })
    }

    fn new(path: PathBuf) -> Option<Self> {
        let marker = path.join(MARKER);
        match fs::symlink_metadata(&marker) {
            Ok(found) if found.is_file() => {}
            // Killed before there was a marker: nothing is lost with an empty directory.
            Err(error) if error.kind() == ErrorKind::NotFound => {
                let _ = fs::remove_dir(&path);
                return None;
            }
            _ => return None,
        }
        let marker = OpenOptions::new().read(true).write(true).open(marker).ok()?;
        // Without locks on this file system leftovers stay, which does no harm.
        marker.try_lock().ok()?;
        let mut text = String::new();
        (&marker).take(LONGEST_MARKER).read_to_string(&mut text).ok()?;
        let purpose = match text.as_str() {
            "" => String::new(),
            text => text.strip_prefix(OWN)?.to_owned(),
        };
        Some(Self { path, purpose, marker })
    }
}

/// Removes the directories that killed processes left in a folder, of those whose purposes satisfy a condition.
pub(crate) fn remove_leftovers(folder: &Path, belongs: impl Fn(&str) -> bool) {
    Leftover::all_in(folder).filter(|it| it.purpose.is_empty() || belongs(&it.purpose)).for_each(|it| {
        remove(&it.path);
        // Held until here.
        drop(it.marker);
    });
}

/// Removes what this program puts into such a directory, then the directory, which stays if there is anything else in it.
fn remove(path: &Path) {
    remove_leftovers(path, |_| true);
    for entry in fs::read_dir(path).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let ending = Path::new(&name).extension().and_then(OsStr::to_str).unwrap_or_default();
        if name == CONTENT || ENDINGS.contains(&ending) {
            // Failing to remove it is no reason to fail.
            let _ = fs::remove_file(entry.path());
        }
    }
    let others =
        fs::read_dir(path).map_or(0, |it| it.flatten().filter(|it| it.file_name() != MARKER).count());
    if others == 0 {
        let _ = fs::remove_file(path.join(MARKER));
        let _ = fs::remove_dir(path);
    }
}
