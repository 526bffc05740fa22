//! A file of a sweep: one row per scene, and the whole runs of scenes whose snapshots are kept.

use std::path::Path;

use hdf5::File;

use super::atomic::AtomicFile;
use super::dataset::{Attribute, Dataset, Quantity, Values, Variable, quantity, text};
use super::labelled::{create_group, file_on_disk, put_dataset};
use super::reader::{OpenFile, Wanted, variable};
use super::seal::{ResultPath, seal};
use super::{Format, RunFile};
use crate::error::{Error, Result};

/// Coordinate of the rows.
const SCENE: Quantity = quantity("scene", "1", "number of the scene in the expanded study");

/// Group of the runs whose snapshots are kept.
pub(super) const RUNS: &str = "runs";

/// What a sweep is about; all its files must agree on it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SweepHeader {
    /// Title of the study.
    pub title: String,
    /// What is done with each scene.
    pub task: String,
    /// TOML text of the study.
    pub study: String,
    /// TOML text of the base scene.
    pub base_scene: String,
    /// SHA-256 of all that results depend on.
    pub study_hash: String,
    /// Number of scenes of the study.
    pub scenes: u64,
    /// Number of shards that the study is cut into; 1 in a merged file.
    pub shards: u64,
    /// Number of this shard, from 0.
    pub shard: u64,
}

/// Rows of a sweep; the same rows give the same bytes.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepFile {
    /// What the sweep is about.
    pub header: SweepHeader,
    /// Version of the program that wrote the file.
    pub program_version: String,
    /// Whether all rows are there that the file is to have.
    pub complete: bool,
    /// Numbers of the scenes, shape `(scene,)`.
    pub scenes: Vec<u64>,
    /// Everything about them, each of shape `(scene,)`.
    pub columns: Vec<Variable>,
    /// Runs of scenes whose snapshots are kept.
    pub runs: Vec<(u64, RunFile)>,
}

impl SweepFile {
    /// Version of the layout, the root attribute `format_version`.
    pub const FORMAT_VERSION: i32 = 1;

    /// A file as this program writes it.
    ///
    /// # Arguments
    /// * `complete` -- whether all rows are there that the file is to have
    /// * `scenes` -- their numbers, shape `(scene,)`
    /// * `columns` -- everything about them, each of shape `(scene,)`
    /// * `runs` -- those of scenes whose snapshots are kept
    pub fn new(
        header: SweepHeader,
        complete: bool,
        scenes: Vec<u64>,
        columns: Vec<Variable>,
        runs: Vec<(u64, RunFile)>,
    ) -> Self {
        let program_version = env!("CARGO_PKG_VERSION").into();
        Self { header, program_version, complete, scenes, columns, runs }
    }

    /// Writes the file, as a whole or not at all, over one that exists only if `overwrite` is given.
    ///
    /// # Errors
    /// [`Error::File`] names the file and the cure.
    ///
    /// # Panics
    /// If a column does not have one value per scene.
    pub fn write(&self, path: &Path, overwrite: bool) -> Result<()> {
        for column in &self.columns {
            assert_eq!(column.values.len(), self.scenes.len(), "values of {}, scenes", column.name);
        }
        let mut file = AtomicFile::new(path, overwrite)?;
        file.write_with(|temporary| {
            let failed = |error: &dyn std::fmt::Display| Error::File {
                path: path.to_owned(),
                why: format!("could not be written, is the disk full? ({})", first_line(error)),
            };
            self.lay_out(temporary).map_err(|error| failed(&error))?;
            seal(temporary).map_err(|error| failed(&error))?;
            // The library has lost errors of a full disk.
            let open = OpenFile::new(temporary).map_err(|error| failed(&error))?;
            let scenes = open.file.dataset(SCENE.name).map_err(|error| error.to_string());
            let scenes = scenes.and_then(|it| variable(SCENE.name, &it, Wanted::Values));
            match header(&open)? == self.header && scenes.is_ok_and(|it| it.0.values == self.ids().into()) {
                true => Ok(()),
                false => Err(failed(&"what was written reads differently")),
            }
        })
    }

    fn ids(&self) -> Vec<i64> {
        self.scenes.iter().map(|scene| scene.cast_signed()).collect()
    }

    /// The rows without the runs that are kept.
    fn dataset(&self) -> Dataset {
        let header = &self.header;
        let mut sweep = Dataset::default();
        sweep.say("title", text(&header.title));
        sweep.say("format", text(Format::Sweep.name()));
        sweep.say("format_version", Attribute::Integer(Self::FORMAT_VERSION));
        sweep.say("program_version", text(&self.program_version));
        sweep.say("task", text(&header.task));
        sweep.say("study", text(&header.study));
        sweep.say("base_scene", text(&header.base_scene));
        sweep.say("study_hash", text(&header.study_hash));
        sweep.say("scenes", Attribute::Count(header.scenes));
        sweep.say("shards", Attribute::Count(header.shards));
        sweep.say("shard", Attribute::Count(header.shard));
        sweep.say("complete", Attribute::Integer(self.complete.into()));
        sweep.coordinate(SCENE, self.ids());
        sweep.variables.extend(self.columns.iter().cloned());
        sweep
    }

    fn lay_out(&self, path: &Path) -> hdf5::Result<()> {
        let file = file_on_disk(path)?;
        put_dataset(&file, &self.dataset())?;
        if !self.runs.is_empty() {
            let group = create_group(&file, RUNS)?;
            for (scene, run) in &self.runs {
                put_dataset(&create_group(&group, &scene.to_string())?, &run.dataset())?;
            }
        }
        file.flush()?;
        file.close()
    }

    /// Reads a file of a sweep.
    ///
    /// # Errors
    /// [`Error::File`] names the file and what is wrong with it.
    pub fn read<'a>(file: impl Into<ResultPath<'a>>) -> Result<Self> {
        let open = OpenFile::new(file)?;
        let header = header(&open)?;
        let program_version = open.text(&open.file, "program_version")?;
        let complete = open.integer::<i32>(&open.file, "complete")? != 0;
        let mut sweep = open.dataset(&open.file, Wanted::Values, &[RUNS])?;
        let scenes: Vec<i64> = sweep.take(SCENE, &[None])?;
        if let Some((name, why)) = sweep.unusable.first() {
            return Err(open.damaged(name, why));
        }
        let mut columns = std::mem::take(&mut sweep.variables);
        columns.sort_by(|one, other| one.name.cmp(&other.name));
        for column in &mut columns {
            let known = matches!(column.values, Values::Numbers(_) | Values::Texts(_));
            if !known || column.shape != [scenes.len()] {
                let why = format!(
                    "has the shape {:?}, expected words or numbers of {}",
                    column.shape,
                    scenes.len()
                );
                return Err(open.damaged(&column.name, &why));
            }
            column.dimensions = vec![SCENE.name.into()];
        }
        let runs = kept_runs(&open)?.into_iter().map(|name| {
            let place = format!("/{RUNS}/{name}");
            let scene = name.parse().map_err(|error| open.damaged(&place, &error))?;
            let group = open.file.group(&place).map_err(|error| open.damaged(&place, &error))?;
            Ok((scene, RunFile::from_group(&open, &group)?))
        });
        let runs = runs.collect::<Result<_>>()?;
        let scenes = scenes.into_iter().map(i64::cast_unsigned).collect();
        Ok(Self { header, program_version, complete, scenes, columns, runs })
    }

    /// Reads only what a file of a sweep is about.
    ///
    /// # Errors
    /// As [`SweepFile::read`].
    pub fn read_header(path: &Path) -> Result<SweepHeader> {
        header(&OpenFile::new(path)?)
    }
}

/// Names of the runs that a sweep has kept, in the order of the scenes.
pub(super) fn kept_runs(open: &OpenFile) -> Result<Vec<String>> {
    if !open.file.link_exists(RUNS) {
        return Ok(vec![]);
    }
    let group = open.file.group(RUNS).map_err(|error| open.damaged(RUNS, &error))?;
    let mut names = group.member_names().map_err(|error| open.damaged(RUNS, &error))?;
    names.sort_by_key(|name| name.parse::<u64>().ok());
    Ok(names)
}

/// A quantity of all rows of a sweep.
pub fn column(quantity: Quantity, values: impl Into<Values>) -> Variable {
    let values = values.into();
    Variable::new(quantity, &[(SCENE.name, values.len())], values)
}

fn header(open: &OpenFile) -> Result<SweepHeader> {
    let file: &File = &open.file;
    open.check_format(file, Format::Sweep, "give the directory of a `fretwear sweep` only")?;
    Ok(SweepHeader {
        title: open.text(file, "title")?,
        task: open.text(file, "task")?,
        study: open.text(file, "study")?,
        base_scene: open.text(file, "base_scene")?,
        study_hash: open.text(file, "study_hash")?,
        scenes: open.integer(file, "scenes")?,
        shards: open.integer(file, "shards")?,
        shard: open.integer(file, "shard")?,
    })
}

/// Errors of the HDF5 library go on for lines.
fn first_line(error: &dyn std::fmt::Display) -> String {
    error.to_string().lines().next().unwrap_or_default().to_owned()
}
