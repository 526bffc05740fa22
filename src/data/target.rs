//! The file that a run is saved to.

use std::path::{Path, PathBuf};

use super::atomic::AtomicFile;
use super::labelled::laid_out;
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

    fn path(&self) -> &Path {
        match self {
            Self::Ready(file) => file.path(),
            Self::Later(path) => path,
        }
    }

    pub(super) fn save(&mut self, save: &Save) -> Result<()> {
        let bytes = sealed(laid_out(self.path(), |file| save.put_into(file))?);
        if let Self::Later(path) = self {
            *self = Self::Ready(AtomicFile::new(path, true)?);
        }
        match self {
            Self::Ready(file) => file.write(&bytes),
            Self::Later(_) => unreachable!("made ready above"),
        }
    }
}
