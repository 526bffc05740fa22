//! The file that a run is saved to.

use std::path::{Path, PathBuf};

use super::atomic::AtomicFile;
use super::labelled::laid_out;
use super::seal::sealed;
use super::writer::Run;
use super::{RunHeader, RunWriter, Snapshot};
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
    fn path(&self) -> &Path {
        match self {
            Self::Ready(file) => file.path(),
            Self::Later(path) => path,
        }
    }

    pub(super) fn save(&mut self, run: &Run) -> Result<()> {
        let bytes = sealed(laid_out(self.path(), |file| run.put_into(file))?);
        if let Self::Later(path) = self {
            *self = Self::Ready(AtomicFile::new(path, true)?);
        }
        match self {
            Self::Ready(file) => file.write(&bytes),
            Self::Later(_) => unreachable!("made ready above"),
        }
    }
}

impl RunWriter {
    /// A writer of a new file. Checks that the file can be written; creates nothing before the first save.
    ///
    /// # Arguments
    /// * `path` -- the file, in a directory that exists
    /// * `header` -- what does not change during the run
    /// * `overwrite` -- whether a file that exists may be replaced (at the first save, not before)
    ///
    /// # Errors
    /// [`Error::Exists`](crate::Error::Exists) if the file exists and may not be replaced, [`Error::File`](crate::Error::File) if its directory
    /// is missing or cannot be written.
    ///
    /// # Panics
    /// As [`RunWriter::in_memory`].
    pub fn create(path: &Path, header: RunHeader, overwrite: bool) -> Result<Self> {
        Self::with_snapshots(path, header, Vec::new(), overwrite)
    }

    /// A writer that goes on after `snapshots`; see [`RunFile::into_writer`](super::RunFile::into_writer).
    pub(crate) fn with_snapshots(
        path: &Path,
        header: RunHeader,
        snapshots: Vec<Snapshot>,
        overwrite: bool,
    ) -> Result<Self> {
        let file = Some(Target::Ready(AtomicFile::new(path, overwrite)?));
        Ok(Self { file, snapshots, ..Self::in_memory(header) })
    }

    /// A writer that does not look at its file before the first save, which replaces what is there.
    pub fn deferred(path: &Path, header: RunHeader) -> Self {
        Self { file: Some(Target::Later(path.to_owned())), ..Self::in_memory(header) }
    }
}
