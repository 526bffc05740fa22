//! Files that are written: of a dataset at once, of a run with each of its saves.

use std::path::{Path, PathBuf};

use super::atomic::AtomicFile;
use super::dataset::Dataset;
use super::labelled::{laid_out, put_dataset};
use super::save::Save;
use super::seal::sealed;
use crate::error::Result;

/// The file that is written.
#[derive(Debug)]
pub(super) enum Target {
    /// One that was seen to be writable.
    Ready(AtomicFile),
    /// One that is looked at when it is first written.
    Later(PathBuf),
}

impl Target {
    pub(super) fn new(path: &Path, overwrite: bool) -> Result<Self> {
        AtomicFile::new(path, overwrite).map(Self::Ready)
    }

    pub(super) fn path(&self) -> &Path {
        match self {
            Self::Ready(file) => file.path(),
            Self::Later(path) => path,
        }
    }

    pub(super) fn save(&mut self, save: &Save) -> Result<()> {
        let bytes = save.dataset().bytes(self.path())?;
        if let Self::Later(path) = self {
            *self = Self::Ready(AtomicFile::new(path, true)?);
        }
        match self {
            Self::Ready(file) => file.write(&bytes),
            Self::Later(_) => unreachable!("made ready above"),
        }
    }
}

/// Writes the bytes of a result file, as a whole or not at all.
///
/// # Errors
/// [`Error::Exists`](crate::Error::Exists) if it exists and `overwrite` is not given, [`Error::File`](crate::Error::File) if it cannot be written.
pub fn write_file(path: &Path, bytes: &[u8], overwrite: bool) -> Result<()> {
    AtomicFile::new(path, overwrite)?.write(bytes)
}

impl Dataset {
    /// Writes a file, as a whole or not at all.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) if the file exists and `overwrite` is not given, or cannot be written.
    ///
    /// # Panics
    /// If a variable runs along a dimension that has no coordinate before it.
    pub fn write(&self, path: &Path, overwrite: bool) -> Result<()> {
        write_file(path, &self.bytes(path)?, overwrite)
    }

    /// The bytes of a file of it.
    ///
    /// # Arguments
    /// * `path` -- what errors call it
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) if the HDF5 library cannot lay it out.
    ///
    /// # Panics
    /// As [`Dataset::write`].
    pub fn bytes(&self, path: &Path) -> Result<Vec<u8>> {
        Ok(sealed(laid_out(path, |file| put_dataset(file, self))?))
    }
}
