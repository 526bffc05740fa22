//! The snapshots of a run while it goes on, and the file that they are saved to.

use std::mem;
#[cfg(feature = "hdf5")]
use std::path::Path;

#[cfg(feature = "hdf5")]
use super::RunFile;
use super::save::Save;
#[cfg(feature = "hdf5")]
use super::target::Target;
use super::{Checkpoint, RunHeader, Snapshot, StopReason};
use crate::error::Result;

/// Collects the snapshots of a run and saves them, each time as one whole file, where there is one.
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
    file: Option<Target>,
    header: RunHeader,
    snapshots: Vec<Snapshot>,
}

/// There is no file without HDF5.
#[cfg(not(feature = "hdf5"))]
#[derive(Debug)]
enum Target {}

#[cfg(not(feature = "hdf5"))]
impl Target {
    fn save(&mut self, _: &Save) -> Result<()> {
        match *self {}
    }
}

#[cfg(feature = "hdf5")]
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

    /// A writer that goes on after `snapshots`; see [`RunFile::into_writer`].
    pub(crate) fn with_snapshots(
        path: &Path,
        header: RunHeader,
        snapshots: Vec<Snapshot>,
        overwrite: bool,
    ) -> Result<Self> {
        let file = Some(Target::new(path, overwrite)?);
        Ok(Self { file, snapshots, ..Self::in_memory(header) })
    }

    /// A writer that does not look at its file before the first save, which replaces what is there.
    pub fn deferred(path: &Path, header: RunHeader) -> Self {
        Self { file: Some(Target::Later(path.to_owned())), ..Self::in_memory(header) }
    }

    /// The file that is written, behind all links; none for what stays in memory.
    pub fn path(&self) -> Option<&Path> {
        self.file.as_ref().map(Target::path)
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
    /// Keeps the snapshots and has no file.
    ///
    /// # Panics
    /// If there are no nodes, or a curve of the limit does not have one value per node.
    pub fn in_memory(header: RunHeader) -> Self {
        header.check();
        Self { file: None, header, snapshots: Vec::new() }
    }

    /// Begins again without snapshots, for a run that is made anew; what was saved stays until the next save.
    ///
    /// # Returns
    /// Header and snapshots so far.
    ///
    /// # Panics
    /// As [`RunWriter::in_memory`].
    pub fn restart(&mut self, header: RunHeader) -> (RunHeader, Vec<Snapshot>) {
        header.check();
        (mem::replace(&mut self.header, header), mem::take(&mut self.snapshots))
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

    /// Replaces the file by one with all snapshots so far, and returns when it is safe on the disk; without a file nothing is done.
    ///
    /// # Arguments
    /// * `checkpoint` -- what a restart needs
    /// * `stop_reason` -- why the run stops here; [`StopReason::Interrupted`] while it goes on
    /// * `complete` -- whether the run reached its end
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) names the file and the cure; the previous save is then still there.
    pub fn save(&mut self, checkpoint: &Checkpoint, stop_reason: StopReason, complete: bool) -> Result<()> {
        let save =
            Save { header: &self.header, snapshots: &self.snapshots, checkpoint, stop_reason, complete };
        self.file.as_mut().map_or(Ok(()), |file| file.save(&save))
    }
}

#[cfg(feature = "hdf5")]
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
