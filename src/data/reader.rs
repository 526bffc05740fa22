//! Reading the file of a run; nothing in a file is trusted.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use hdf5::types::VarLenUnicode;
use hdf5::{Dataset, File, Group, H5Type, Location};

use super::layout::*;
use super::seal::ResultPath;
use super::{Checkpoint, Format, LimitCurves, RunHeader, RunWriter, Snapshot, StopReason};
use crate::contact::indenter::TabulatedProfile;
use crate::contact::stick_slip::Regime;
use crate::error::{Error, Result};
use crate::laws::loading::RecordedPath;
use crate::solver::model::{Linearised, Past, PastPoint, StickEdge};

const NOT_A_RUN: &str = "give a file that `fretwear run` wrote";
const WRITE_AGAIN: &str = "the file is damaged or was edited, write it again with the command that wrote it";

/// Deflate cannot do better than this, so a dataset that claims more values than this per stored byte is not genuine.
const LARGEST_COMPRESSION: u64 = 1032;

/// A run read back from its file.
#[derive(Debug, Clone, PartialEq)]
pub struct RunFile {
    /// What does not change during the run.
    pub header: RunHeader,
    /// The snapshots, in the order of time.
    pub snapshots: Vec<Snapshot>,
    /// What a restart needs, where the file has it.
    pub checkpoint: Option<Checkpoint>,
    /// Why the run stopped.
    pub stop_reason: StopReason,
    /// Whether the run reached its end.
    pub complete: bool,
    /// Version of the program that wrote the file.
    pub program_version: String,
    /// What it was computed from, [`RunHeader::scene_hash`]; none in files of earlier programs.
    pub scene_hash: Option<String>,
}

impl RunFile {
    /// Reads a file that [`RunWriter`] wrote.
    ///
    /// # Errors
    /// [`Error::File`] names the file, the dataset or attribute that cannot be used, and the cure.
    pub fn open<'a>(file: impl Into<ResultPath<'a>>) -> Result<Self> {
        let (source, file) = open(file)?;
        Self::from_group(&source, &file)
    }

    /// Reads a run from a group of a file.
    pub(super) fn from_group(source: &Source, file: &Group) -> Result<Self> {
        source.check_format(file, Format::Run, FORMAT_VERSION, NOT_A_RUN)?;
        let header = source.header(file)?;
        let snapshots = source.snapshots(file, header.radius.len())?;
        let checkpoint = if file.link_exists(CHECKPOINT) { Some(source.checkpoint(file)?) } else { None };
        let reason = source.text(file, "stop_reason")?;
        let stop_reason = StopReason::from_name(&reason)
            .ok_or_else(|| source.error(format!("stop_reason = {reason:?} is not known; {WRITE_AGAIN}")))?;
        let complete = source.integer(file, "complete")? != 0;
        let program_version = source.text(file, "program_version")?;
        let scene_hash = file.attr(SCENE_HASH).is_ok().then(|| source.text(file, SCENE_HASH)).transpose()?;
        if scene_hash.as_ref().is_some_and(|it| *it != header.scene_hash(&program_version)) {
            let why = "is not the one that checkpoint and snapshots were computed from";
            return Err(source.damaged("its scene", &why));
        }
        Ok(Self { header, snapshots, checkpoint, stop_reason, complete, program_version, scene_hash })
    }

    /// A writer that goes on after the snapshots of this file and replaces `path` at its first save.
    ///
    /// # Errors
    /// [`Error::File`] if `path` cannot be written.
    pub fn into_writer(self, path: &Path) -> Result<RunWriter> {
        RunWriter::with_snapshots(path, self.header, self.snapshots, true)
    }
}

impl RunFile {
    /// As [`RunFile::into_writer`], without a look at `path` before the first save.
    pub fn into_deferred_writer(self, path: &Path) -> RunWriter {
        let mut writer = RunWriter::deferred(path, self.header);
        self.snapshots.into_iter().for_each(|snapshot| writer.push(snapshot));
        writer
    }
}

/// Opens an HDF5 file for reading, the one way to the library: what is damaged does not get there.
pub(super) fn open<'a>(file: impl Into<ResultPath<'a>>) -> Result<(Source, File)> {
    let path = file.into().ready()?.path();
    let source = Source { path: path.to_owned() };
    // No lock is needed: a file is replaced as a whole, so what is opened here never changes.
    let file = File::with_options()
        .with_fapl(|access| access.file_locking(false))
        .open(path)
        .map_err(|error| source.error(format!("is damaged or cut short ({error}); {WRITE_AGAIN}")))?;
    Ok((source, file))
}

/// The file that is read, for its name in errors.
#[derive(Debug)]
pub(super) struct Source {
    path: PathBuf,
}

impl Source {
    pub(super) fn error(&self, why: String) -> Error {
        Error::File { path: self.path.clone(), why }
    }

    pub(super) fn damaged(&self, what: &str, why: &dyn std::fmt::Display) -> Error {
        self.error(format!("{what}: {why}; {WRITE_AGAIN}"))
    }

    /// What the root attribute `format` tells; none if there is none, or one of another program.
    pub(super) fn format(&self, file: &Group) -> Result<Option<Format>> {
        match file.attr("format") {
            Ok(_) => self.text(file, "format").map(|name| Format::from_name(&name)),
            Err(_) => Ok(None),
        }
    }

    /// Refuses a file of another format or version; the cure says what to give instead.
    pub(super) fn check_format(&self, file: &Group, format: Format, version: i32, cure: &str) -> Result<()> {
        if self.format(file)? != Some(format) {
            let name = format.name();
            let why = format!("is an HDF5 file, but has no attribute format = \"{name}\"; {cure}");
            return Err(self.error(why));
        }
        match self.integer(file, "format_version")? {
            found if found == version => Ok(()),
            other => Err(self.error(format!(
                "has format_version {other}, this program reads {version}; use the fretwear that wrote it"
            ))),
        }
    }

    fn header(&self, file: &Group) -> Result<RunHeader> {
        let title = Some(self.text(file, "title")?).filter(|title| !title.is_empty());
        let scene = self.text(file, "scene")?;
        let radius: Vec<f64> = self.values(file, RADIUS, &[None])?;
        if radius.is_empty() {
            return Err(self.damaged("/radius", &"has no values"));
        }
        let nodes = [Some(radius.len())];
        let limit = if file.link_exists(LIMIT_PROFILE.name) {
            let profile = self.values(file, LIMIT_PROFILE, &nodes)?;
            Some(LimitCurves { profile, wear_depth: self.values(file, LIMIT_WEAR_DEPTH, &nodes)? })
        } else {
            None
        };
        let table = if file.link_exists(TABLE_PROFILE.name) { Some(self.table(file)?) } else { None };
        let path = if file.link_exists(PATH_X.name) { Some(self.path(file)?) } else { None };
        Ok(RunHeader { title, scene, radius, limit, table, path })
    }

    fn table(&self, file: &Group) -> Result<Arc<TabulatedProfile>> {
        let radius: Vec<f64> = self.values(file, TABLE_RADIUS, &[None])?;
        let height = self.values(file, TABLE_PROFILE, &[Some(radius.len())])?;
        let name = format!("/{}", TABLE_PROFILE.name);
        let dataset = file.dataset(TABLE_PROFILE.name).map_err(|error| self.damaged(&name, &error))?;
        let source = self.text(&dataset, SOURCE)?;
        let deviation = match dataset.attr(SMOOTHING) {
            Ok(attribute) => attribute.read_scalar().map_err(|error| self.damaged(&name, &error))?,
            Err(_) => 0.0,
        };
        let table = TabulatedProfile::smoothed(source, radius, height, deviation);
        table.map(Arc::new).map_err(|error| self.damaged(&name, &error))
    }

    fn path(&self, file: &Group) -> Result<Arc<RecordedPath>> {
        let x: Vec<f64> = self.values(file, PATH_X, &[None])?;
        let rows = [Some(x.len())];
        let [y, indentation] = [PATH_Y, PATH_INDENTATION].map(|label| self.values(file, label, &rows));
        let name = format!("/{}", PATH_X.name);
        let dataset = file.dataset(PATH_X.name).map_err(|error| self.damaged(&name, &error))?;
        let path = RecordedPath::new(self.text(&dataset, SOURCE)?, x, y?, indentation?);
        path.map(Arc::new).map_err(|error| self.damaged(&name, &error))
    }

    fn snapshots(&self, file: &Group, nodes: usize) -> Result<Vec<Snapshot>> {
        let mut times = None;
        let mut snapshots = Vec::new();
        for field in &SERIES {
            let values: Vec<f64> = self.values(file, field.label, &[times])?;
            times = Some(values.len());
            snapshots.resize_with(values.len(), Snapshot::default);
            for (snapshot, value) in snapshots.iter_mut().zip(values) {
                *(field.of_mut)(snapshot) = value;
            }
        }
        let regimes: Vec<i32> = self.values(file, REGIME, &[times])?;
        for (snapshot, flag) in snapshots.iter_mut().zip(regimes) {
            let regime = usize::try_from(flag).ok().and_then(|place| Regime::ALL.get(place));
            snapshot.regime = *regime
                .ok_or_else(|| self.damaged(&format!("/{}", REGIME.name), &format!("{flag} is no regime")))?;
        }
        for field in &CURVES {
            let values: Vec<f64> = self.values(file, field.label, &[times, Some(nodes)])?;
            for (snapshot, row) in snapshots.iter_mut().zip(values.chunks_exact(nodes)) {
                *(field.of_mut)(snapshot) = row.to_vec();
            }
        }
        self.loops(file, &mut snapshots)?;
        Ok(snapshots)
    }

    fn loops(&self, file: &Group, snapshots: &mut [Snapshot]) -> Result<()> {
        let group = file.group(LOOPS).map_err(|error| self.damaged("/loops", &error))?;
        let points = self.values::<i64>(&group, POINT, &[None])?.len();
        if points == 0 {
            return Ok(());
        }
        let in_plane = LOOP_CURVES[2..].iter().any(|field| group.link_exists(field.label.name));
        for field in &LOOP_CURVES[..if in_plane { 4 } else { 2 }] {
            let values: Vec<f64> =
                self.values(&group, field.label, &[Some(snapshots.len()), Some(points)])?;
            for (snapshot, row) in snapshots.iter_mut().zip(values.chunks_exact(points)) {
                *(field.of_mut)(snapshot) = row.to_vec();
            }
        }
        Ok(())
    }

    fn checkpoint(&self, file: &Group) -> Result<Checkpoint> {
        let group = file.group(CHECKPOINT).map_err(|error| self.damaged("/checkpoint", &error))?;
        let mut checkpoint = Checkpoint::default();
        checkpoint.state.compression = self.values(&group, COMPRESSION, &[None])?;
        let springs = Some(checkpoint.state.compression.len());
        checkpoint.state.compression_rate = self.values(&group, COMPRESSION_RATE, &[springs])?;
        for field in &CHECKPOINT_REALS {
            *(field.of_mut)(&mut checkpoint) = self.scalar(&group, field.label)?;
        }
        for field in &CHECKPOINT_COUNTS {
            *(field.of_mut)(&mut checkpoint) = self.scalar(&group, field.label)?;
        }
        if group.link_exists(ERROR_ESTIMATE.name) {
            checkpoint.error_estimate = Some(self.scalar(&group, ERROR_ESTIMATE)?);
        }
        if group.link_exists(ACCURACY.name) {
            checkpoint.accuracy = Some(self.scalar(&group, ACCURACY)?);
        }
        if group.link_exists(STICK) {
            let group = group.group(STICK).map_err(|error| self.damaged("/checkpoint/stick", &error))?;
            let mut stick = StickEdge {
                left_behind: self.values(&group, LEFT_BEHIND, &[None])?,
                wear_depth: self.values(&group, STICK_WEAR_DEPTH, &[None])?,
                ..StickEdge::default()
            };
            if group.link_exists(PLACE_AT_REST.name) {
                stick.places_at_rest = self.values(&group, PLACE_AT_REST, &[None])?;
                stick.raised_at_rest =
                    self.values(&group, RAISED_AT_REST, &[Some(stick.places_at_rest.len())])?;
            }
            for field in &STICK_REALS {
                *(field.of_mut)(&mut stick) = self.scalar(&group, field.label)?;
            }
            checkpoint.state.stick = Some(stick);
        }
        if group.link_exists(PAST) {
            let group = group.group(PAST).map_err(|error| self.damaged("/checkpoint/past", &error))?;
            checkpoint.state.past = self.past(&group, checkpoint.state.compression.len())?;
        }
        Ok(checkpoint)
    }

    fn past(&self, group: &Group, springs: usize) -> Result<Past> {
        let count = self.values::<i64>(group, EARLIER, &[None])?.len();
        let mut points = vec![PastPoint::default(); count];
        for field in &PAST_REALS {
            let values: Vec<f64> = self.values(group, field.label, &[Some(count)])?;
            points.iter_mut().zip(values).for_each(|(point, value)| *(field.of_mut)(point) = value);
        }
        let compressions: Vec<f64> = self.values(group, COMPRESSION, &[Some(count), Some(springs)])?;
        let log_slips: Vec<f64> = self.values(group, LOG_SLIP, &[Some(count), Some(springs + 1)])?;
        let rows = compressions.chunks(springs.max(1)).zip(log_slips.chunks(springs + 1));
        for (point, (compression, log_slip)) in points.iter_mut().zip(rows) {
            (point.compression, point.log_slip) = (compression.to_vec(), log_slip.to_vec());
        }
        let order = self.scalar::<u64>(group, ORDER)?;
        let order = usize::try_from(order).unwrap_or(usize::MAX);
        let linearised =
            group.link_exists(LINEARISED).then(|| self.linearised(group, springs)).transpose()?;
        Ok(Past { order, points: points.into_iter().map(Arc::new).collect(), linearised })
    }

    fn linearised(&self, past: &Group, springs: usize) -> Result<Arc<Linearised>> {
        let group =
            past.group(LINEARISED).map_err(|error| self.damaged("/checkpoint/past/linearised", &error))?;
        let compression = self.values(&group, COMPRESSION, &[Some(springs)])?;
        let mut found = Linearised { compression, ..Linearised::default() };
        for field in &LINEARISED_REALS {
            *(field.of_mut)(&mut found) = self.scalar(&group, field.label)?;
        }
        Ok(Arc::new(found))
    }

    fn scalar<T: H5Type + Copy>(&self, group: &Group, label: Label) -> Result<T> {
        Ok(self.values(group, label, &[])?[0])
    }

    /// All values of a dataset in row-major order; `None` in the shape stands for any length.
    pub(super) fn values<T: H5Type>(
        &self,
        group: &Group,
        label: Label,
        shape: &[Option<usize>],
    ) -> Result<Vec<T>> {
        let name = format!("{}/{}", group.name().trim_end_matches('/'), label.name);
        if !group.link_exists(label.name) {
            return Err(self.error(format!("dataset {name} is missing; {WRITE_AGAIN}")));
        }
        let dataset = group.dataset(label.name).map_err(|error| self.damaged(&name, &error))?;
        self.values_of(&dataset, &name, shape)
    }

    /// As [`Source::values`], of a dataset that is open; errors call it `name`.
    pub(super) fn values_of<T: H5Type>(
        &self,
        dataset: &Dataset,
        name: &str,
        shape: &[Option<usize>],
    ) -> Result<Vec<T>> {
        let count = check_shape::<T>(dataset, shape).map_err(|why| self.damaged(name, &why))?;
        let values = dataset.read_raw().map_err(|error| self.damaged(name, &error))?;
        if values.len() == count { Ok(values) } else { Err(self.damaged(name, &"has no values")) }
    }

    /// As [`Source::values_of`], of words: the library vouches for no text, so a sign stands for what is not UTF-8.
    pub(super) fn words_of(
        &self,
        dataset: &Dataset,
        name: &str,
        shape: &[Option<usize>],
    ) -> Result<Vec<String>> {
        let words: Vec<VarLenUnicode> = self.values_of(dataset, name, shape)?;
        Ok(words.into_iter().map(|word| String::from_utf8_lossy(word.as_bytes()).into_owned()).collect())
    }

    pub(super) fn text(&self, file: &Location, name: &str) -> Result<String> {
        let what = format!("attribute {name}");
        let attribute = file.attr(name).map_err(|error| self.damaged(&what, &error))?;
        if !attribute.dtype().is_ok_and(|kind| kind.is::<VarLenUnicode>()) {
            return Err(self.damaged(&what, &"is not UTF-8 text of variable length"));
        }
        let text = attribute.read_scalar::<VarLenUnicode>().map_err(|error| self.damaged(&what, &error))?;
        String::from_utf8(text.as_bytes().to_vec()).map_err(|error| self.damaged(&what, &error))
    }

    pub(super) fn integer(&self, file: &Group, name: &str) -> Result<i32> {
        let what = format!("attribute {name}");
        let attribute = file.attr(name).map_err(|error| self.damaged(&what, &error))?;
        attribute.read_scalar().map_err(|error| self.damaged(&what, &error))
    }
}

/// The number of values of a dataset, if its type and shape are those expected and its file can hold so many.
fn check_shape<T: H5Type>(
    dataset: &Dataset,
    expected: &[Option<usize>],
) -> std::result::Result<usize, String> {
    if !dataset.dtype().is_ok_and(|kind| kind.is::<T>()) {
        return Err(format!("does not hold values of type {}", std::any::type_name::<T>()));
    }
    let shape = dataset.get_shape().map_err(|error| error.to_string())?;
    let fits = shape.len() == expected.len()
        && shape.iter().zip(expected).all(|(length, expected)| expected.is_none_or(|it| it == *length));
    if !fits {
        let expected: Vec<String> =
            expected.iter().map(|length| length.map_or("any".into(), |it| it.to_string())).collect();
        return Err(format!("has the shape {shape:?}, expected [{}]", expected.join(", ")));
    }
    let count = shape.iter().try_fold(1usize, |product, length| product.checked_mul(*length));
    let chunk = dataset
        .chunk()
        .unwrap_or_default()
        .iter()
        .try_fold(1usize, |product, length| product.checked_mul(*length));
    let room = dataset.storage_size().saturating_mul(LARGEST_COMPRESSION) / size_of::<T>() as u64;
    match (count, chunk) {
        (Some(0), _) => Ok(0),
        (Some(count), Some(chunk)) if count.max(chunk) as u64 <= room => Ok(count),
        _ => Err(format!("claims the shape {shape:?}, but only {} bytes are stored", dataset.storage_size())),
    }
}
