//! Writing files: of a dataset at once, of a run with each of its saves.

use std::path::{Path, PathBuf};

use super::atomic::AtomicFile;
use super::dataset::Dataset;
use super::labelled::{laid_out, put_dataset};
use super::run_file::{Run, RunFile};
use super::seal::sealed;
use super::{Checkpoint, RunHeader, Snapshot, StopReason};
use crate::error::Result;

/// Collects the snapshots of a run and saves them, each time as one whole file.
///
/// ```
/// use fretwear::data::{Checkpoint, RunFile, RunHeader, RunWriter, Snapshot, StopReason};
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("run.h5");
/// let header = RunHeader { scene: "[output]".into(), radius: vec![1e-3, 2e-3], ..RunHeader::default() };
/// let mut writer = RunWriter::create(&path, header, false)?;
/// let zero = vec![0.0; 2];
/// writer.push(Snapshot {
///     profile: vec![1e-6, 4e-6], wear_depth: zero.clone(), pressure: zero.clone(), slip: zero, ..Snapshot::default()
/// });
/// writer.save(&Checkpoint::default(), StopReason::End, true)?;
/// assert_eq!(RunFile::open(&path)?.snapshots[0].profile[1], 4e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct RunWriter {
    file: Target,
    header: RunHeader,
    snapshots: Vec<Snapshot>,
}

/// The file that is written.
#[derive(Debug)]
enum Target {
    /// One that was seen to be writable.
    Ready(AtomicFile),
    /// One that is looked at when it is first written.
    Later(PathBuf),
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
        let mut file = AtomicFile::new(path, overwrite)?;
        file.write(&sealed(laid_out(path, |file| put_dataset(file, self))?))
    }
}

impl RunHeader {
    fn check(&self) {
        assert!(!self.radius.is_empty(), "a run has at least one node");
        for curve in self.limit.iter().flat_map(|limit| [&limit.profile, &limit.wear_depth]) {
            assert_eq!(curve.len(), self.radius.len(), "values of the limit, nodes");
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
    /// [`Error::File`](crate::Error::File) if the file exists and may not be replaced, or its directory is missing or cannot be written.
    ///
    /// # Panics
    /// If there are no nodes, or a curve of the limit does not have one value per node.
    pub fn create(path: &Path, header: RunHeader, overwrite: bool) -> Result<Self> {
        Self::with_snapshots(path, header, Vec::new(), overwrite)
    }

    /// A writer that goes on after `snapshots`; see [`RunFile::into_writer`](super::RunFile::into_writer).
    pub(super) fn with_snapshots(
        path: &Path,
        header: RunHeader,
        snapshots: Vec<Snapshot>,
        overwrite: bool,
    ) -> Result<Self> {
        header.check();
        Ok(Self { file: Target::Ready(AtomicFile::new(path, overwrite)?), header, snapshots })
    }

    /// A writer that does not look at its file before the first save, which replaces what is there.
    pub fn deferred(path: &Path, header: RunHeader) -> Self {
        Self { file: Target::Later(path.to_owned()), header, snapshots: Vec::new() }
    }

    /// Forgets the snapshots so far, for a run that is made anew; what was saved stays until the next save.
    ///
    /// # Panics
    /// As [`RunWriter::create`].
    pub fn restart(&mut self, header: RunHeader) {
        header.check();
        self.header = header;
        self.snapshots.clear();
    }

    /// Header and snapshots, when nothing more is to be written.
    pub fn into_parts(self) -> (RunHeader, Vec<Snapshot>) {
        (self.header, self.snapshots)
    }

    /// Adds a snapshot, in memory.
    ///
    /// # Panics
    /// If a curve does not have one value per node, or a loop not as many points as those before.
    pub fn push(&mut self, snapshot: Snapshot) {
        for curve in [&snapshot.profile, &snapshot.wear_depth, &snapshot.pressure, &snapshot.slip] {
            assert_eq!(curve.len(), self.header.radius.len(), "values of a snapshot, nodes");
        }
        let first = self.snapshots.first().unwrap_or(&snapshot);
        let [along, across] = [&first.loop_displacement, &first.loop_displacement_y].map(Vec::len);
        let lengths = [&snapshot.loop_displacement, &snapshot.loop_force].map(Vec::len);
        let lengths_across = [&snapshot.loop_displacement_y, &snapshot.loop_force_y].map(Vec::len);
        assert_eq!((lengths, lengths_across), ([along; 2], [across; 2]), "points of a loop");
        assert!(across == 0 || across == along, "points of a loop along x and y");
        self.snapshots.push(snapshot);
    }

    /// What does not change during the run.
    pub fn header(&self) -> &RunHeader {
        &self.header
    }

    /// The snapshots so far, in the order of time.
    pub fn snapshots(&self) -> &[Snapshot] {
        &self.snapshots
    }

    /// The file that is written.
    pub fn path(&self) -> &Path {
        match &self.file {
            Target::Ready(file) => file.path(),
            Target::Later(path) => path,
        }
    }

    /// Replaces the file by one with all snapshots so far, and returns when it is safe on the disk.
    ///
    /// # Arguments
    /// * `checkpoint` -- what a restart needs
    /// * `stop_reason` -- why the run stops here; [`StopReason::Interrupted`] while it goes on
    /// * `complete` -- whether the run reached its end
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) names the file and the cure; the previous save is then still there.
    pub fn save(&mut self, checkpoint: &Checkpoint, stop_reason: StopReason, complete: bool) -> Result<()> {
        let run = Run { header: &self.header, snapshots: &self.snapshots, checkpoint, stop_reason, complete };
        let bytes = sealed(laid_out(self.path(), |file| put_dataset(file, &run.dataset()))?);
        if let Target::Later(path) = &self.file {
            self.file = Target::Ready(AtomicFile::new(path, true)?);
        }
        match &mut self.file {
            Target::Ready(file) => file.write(&bytes),
            Target::Later(_) => unreachable!("made ready above"),
        }
    }
}

impl RunFile {
    /// A writer that goes on after the snapshots of this file and replaces `path` at its first save.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) if `path` cannot be written.
    pub fn into_writer(self, path: &Path) -> Result<RunWriter> {
        RunWriter::with_snapshots(path, self.header, self.snapshots, true)
    }

    /// As [`RunFile::into_writer`], without a look at `path` before the first save.
    pub fn into_deferred_writer(self, path: &Path) -> RunWriter {
        let mut writer = RunWriter::deferred(path, self.header);
        self.snapshots.into_iter().for_each(|snapshot| writer.push(snapshot));
        writer
    }
}
