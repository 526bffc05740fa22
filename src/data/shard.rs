//! A file of a sweep: one row per scene, and the whole runs of scenes whose snapshots are kept.

use std::collections::HashMap;
use std::path::Path;
use std::str::FromStr;

use hdf5::types::VarLenUnicode;
use hdf5::{File, Group};

use super::atomic::AtomicFile;
use super::labelled::{Dimension, create_group, file_on_disk, put_array, put_integer, put_text};
use super::layout::{Label, label};
use super::reader::{self, Source};
use super::save::Save;
use super::seal::{ResultPath, seal};
use super::{Format, RunFile, StopReason};
use crate::error::{Error, Result};

/// Coordinate of the rows.
const SCENE: Label<'static> = label("scene", "1", "number of the scene in the expanded study");

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

/// A quantity of all rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Name of the dataset.
    pub name: String,
    /// Units; "1" for a pure number or a word.
    pub units: String,
    /// Meaning.
    pub long_name: String,
    /// One value for each row.
    pub values: Values,
}

/// Values of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Numbers; not a number where the quantity has no meaning.
    Numbers(Vec<f64>),
    /// Words.
    Texts(Words),
}

/// Many words of which few are different.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Words {
    different: Vec<String>,
    known: HashMap<String, u32>,
    places: Vec<u32>,
}

impl Words {
    /// Adds a word.
    pub fn push(&mut self, word: &str) {
        let place = self.known.get(word).copied().unwrap_or_else(|| {
            let place = self.different.len() as u32;
            self.known.insert(word.to_owned(), place);
            self.different.push(word.to_owned());
            place
        });
        self.places.push(place);
    }

    /// Number of words.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// The words in their order.
    pub fn iter(&self) -> impl Iterator<Item = &str> {
        self.places.iter().map(|&place| self.different[place as usize].as_str())
    }

    /// One of the words.
    ///
    /// # Panics
    /// If there are not so many.
    pub fn get(&self, index: usize) -> &str {
        &self.different[self.places[index] as usize]
    }
}

impl<T: AsRef<str>> FromIterator<T> for Words {
    fn from_iter<I: IntoIterator<Item = T>>(words: I) -> Self {
        let mut found = Self::default();
        words.into_iter().for_each(|word| found.push(word.as_ref()));
        found
    }
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
    pub columns: Vec<Column>,
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
        columns: Vec<Column>,
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
        for Column { name, values, .. } in &self.columns {
            let length = match values {
                Values::Numbers(values) => values.len(),
                Values::Texts(values) => values.len(),
            };
            assert_eq!(length, self.scenes.len(), "values of {name}, scenes");
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
            let (source, file) = reader::open(temporary).map_err(|error| failed(&error))?;
            let rows: Vec<i64> = source.values(&file, SCENE, &[Some(self.scenes.len())])?;
            match header(&source, &file)? == self.header && rows == self.ids() {
                true => Ok(()),
                false => Err(failed(&"what was written reads differently")),
            }
        })
    }

    fn ids(&self) -> Vec<i64> {
        self.scenes.iter().map(|scene| scene.cast_signed()).collect()
    }

    fn lay_out(&self, path: &Path) -> hdf5::Result<()> {
        let file = file_on_disk(path)?;
        let header = &self.header;
        put_text(&file, "title", &header.title)?;
        put_text(&file, "format", Format::Sweep.name())?;
        put_integer(&file, "format_version", Self::FORMAT_VERSION)?;
        put_text(&file, "program_version", &self.program_version)?;
        for (name, text) in [
            ("task", &header.task),
            ("study", &header.study),
            ("base_scene", &header.base_scene),
            ("study_hash", &header.study_hash),
        ] {
            put_text(&file, name, text)?;
        }
        for (name, number) in [("scenes", header.scenes), ("shards", header.shards), ("shard", header.shard)]
        {
            file.new_attr::<u64>().create(name)?.write_scalar(&number)?;
        }
        put_integer(&file, "complete", self.complete.into())?;
        let rows = Dimension::coordinate(&file, SCENE, &self.ids())?;
        for Column { name, units, long_name, values } in &self.columns {
            let label = Label { name, units, long_name };
            match values {
                Values::Numbers(values) => put_array(&file, label, &[&rows], values)?,
                Values::Texts(values) => {
                    let texts = values.iter().map(unicode).collect::<hdf5::Result<Vec<_>>>()?;
                    put_array(&file, label, &[&rows], &texts)?
                }
            };
        }
        if !self.runs.is_empty() {
            let group = create_group(&file, RUNS)?;
            for (scene, run) in &self.runs {
                let RunFile { header, snapshots, checkpoint, stop_reason, complete, .. } = run;
                let checkpoint = checkpoint.clone().unwrap_or_default();
                let run = Save {
                    header,
                    snapshots,
                    checkpoint: &checkpoint,
                    stop_reason: *stop_reason,
                    complete: *complete,
                };
                run.put_into(&create_group(&group, &scene.to_string())?)?;
            }
        }
        drop(rows);
        file.flush()?;
        file.close()
    }

    /// Reads a file of a sweep.
    ///
    /// # Errors
    /// [`Error::File`] names the file and what is wrong with it.
    pub fn read<'a>(file: impl Into<ResultPath<'a>>) -> Result<Self> {
        let (source, file) = reader::open(file)?;
        let header = header(&source, &file)?;
        let program_version = source.text(&file, "program_version")?;
        let complete = source.integer(&file, "complete")? != 0;
        let ids: Vec<i64> = source.values(&file, SCENE, &[None])?;
        let rows = [Some(ids.len())];
        let mut names = file.member_names().map_err(|error| source.damaged("its members", &error))?;
        names.sort();
        let mut columns = vec![];
        for name in names.into_iter().filter(|name| name != SCENE.name && name != RUNS) {
            let dataset = file.dataset(&name).map_err(|error| source.damaged(&name, &error))?;
            let (units, long_name) = (source.text(&dataset, "units")?, source.text(&dataset, "long_name")?);
            let values = if dataset.dtype().is_ok_and(|kind| kind.is::<f64>()) {
                Values::Numbers(source.values_of(&dataset, &dataset.name(), &rows)?)
            } else {
                Values::Texts(source.words_of(&dataset, &dataset.name(), &rows)?.into_iter().collect())
            };
            columns.push(Column { name, units, long_name, values });
        }
        let mut runs = vec![];
        if file.link_exists(RUNS) {
            let group = file.group(RUNS).map_err(|error| source.damaged(RUNS, &error))?;
            let mut names = group.member_names().map_err(|error| source.damaged(RUNS, &error))?;
            names.sort_by_key(|name| name.parse::<u64>().ok());
            for name in names {
                let place = format!("/{RUNS}/{name}");
                let scene = name.parse().map_err(|error| source.damaged(&place, &error))?;
                let group = group.group(&name).map_err(|error| source.damaged(&place, &error))?;
                runs.push((scene, RunFile::from_group(&source, &group)?));
            }
        }
        let scenes = ids.into_iter().map(i64::cast_unsigned).collect();
        Ok(Self { header, program_version, complete, scenes, columns, runs })
    }

    /// Reads only what a file of a sweep is about.
    ///
    /// # Errors
    /// As [`SweepFile::read`].
    pub fn read_header(path: &Path) -> Result<SweepHeader> {
        let (source, file) = reader::open(path)?;
        header(&source, &file)
    }
}

impl RunFile {
    /// A run as it would be read from its file.
    pub fn finished(
        header: super::RunHeader,
        snapshots: Vec<super::Snapshot>,
        checkpoint: super::Checkpoint,
        stop_reason: StopReason,
    ) -> Self {
        let program_version: String = env!("CARGO_PKG_VERSION").into();
        let complete = stop_reason != StopReason::Interrupted;
        let scene_hash = Some(header.scene_hash(&program_version));
        let checkpoint = Some(checkpoint);
        Self { header, snapshots, checkpoint, stop_reason, complete, program_version, scene_hash }
    }
}

fn header(source: &Source, file: &File) -> Result<SweepHeader> {
    let group: &Group = file;
    const CURE: &str = "give the directory of a `fretwear sweep` only";
    source.check_format(group, Format::Sweep, SweepFile::FORMAT_VERSION, CURE)?;
    let whole = |name: &str| -> Result<u64> {
        let attribute = group.attr(name).and_then(|attribute| attribute.read_scalar::<u64>());
        attribute.map_err(|error| source.damaged(&format!("attribute {name}"), &error))
    };
    Ok(SweepHeader {
        title: source.text(group, "title")?,
        task: source.text(group, "task")?,
        study: source.text(group, "study")?,
        base_scene: source.text(group, "base_scene")?,
        study_hash: source.text(group, "study_hash")?,
        scenes: whole("scenes")?,
        shards: whole("shards")?,
        shard: whole("shard")?,
    })
}

/// Text without NUL, which HDF5 would end it at.
pub(super) fn unicode(text: &str) -> hdf5::Result<VarLenUnicode> {
    VarLenUnicode::from_str(&text.replace('\0', "\u{fffd}")).map_err(|error| error.to_string().into())
}

/// Errors of the HDF5 library go on for lines.
fn first_line(error: &dyn std::fmt::Display) -> String {
    error.to_string().lines().next().unwrap_or_default().to_owned()
}
