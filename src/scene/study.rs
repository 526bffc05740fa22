//! A study: a base scene and what is varied in it, expanded to numbered scenes.

mod reading;

use std::path::{Path, PathBuf};

use toml::{Table, Value};

use super::document::{Section, Source};
use super::input::{self, Pipes};
use super::keys;
use super::sampling::{Distribution, UnitCube};
use super::settings::set;
use super::{LARGEST, Rows, Scene, base_table, columns, read_text};
#[cfg(feature = "hdf5")]
use crate::data::layout::FORMAT_VERSION;
#[cfg(feature = "hdf5")]
use crate::data::{Fingerprint, SweepFile};
use crate::error::Result;
use crate::units::Unit;
use crate::units::split_number;

/// What is done with each scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Task {
    /// Time stepping, as `fretwear run`.
    #[default]
    Run,
    /// The closed form, as `fretwear limit`.
    Limit,
}

impl Task {
    /// All tasks.
    pub const ALL: [Self; 2] = [Self::Run, Self::Limit];

    /// The word of the study: `run` or `limit`.
    pub fn name(self) -> &'static str {
        keys::TASKS[self as usize]
    }
}

/// Of which scenes the snapshots are kept.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum KeptSnapshots {
    /// Of none.
    #[default]
    None,
    /// Of all.
    All,
    /// Of the scenes of these numbers, increasing.
    Of(Vec<u64>),
}

impl KeptSnapshots {
    /// Whether those of a scene are kept.
    pub fn contain(&self, scene: u64) -> bool {
        match self {
            Self::None => false,
            Self::All => true,
            Self::Of(scenes) => scenes.binary_search(&scene).is_ok(),
        }
    }
}

/// A valid study.
///
/// Scenes are numbered from 0: the last axis runs fastest, the samples faster still.
///
/// # Examples
/// ```
/// # use std::path::Path;
/// use fretwear::scene::Study;
///
/// let study = Study::read(Path::new("data/studies/friction.toml"))?;
/// assert_eq!(study.count(), 12);
/// assert_eq!(study.keys()[0], "friction.coulomb.coefficient");
/// assert_eq!(study.scene(0)?.friction().coefficient, 0.3);
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    title: Option<String>,
    task: Task,
    snapshots: KeptSnapshots,
    base: Table,
    folder: PathBuf,
    name: String,
    axes: Vec<Axis>,
    sampling: Option<Sampling>,
    count: u64,
    text: String,
    base_text: String,
}

/// Keys that change together, and their values.
#[derive(Debug, Clone, PartialEq)]
struct Axis {
    keys: Vec<String>,
    /// Shape `(rows, keys)`.
    rows: Vec<Vec<Value>>,
}

/// Keys drawn from distributions.
#[derive(Debug, Clone, PartialEq)]
struct Sampling {
    count: u64,
    cube: UnitCube,
    variables: Vec<Variable>,
}

#[derive(Debug, Clone, PartialEq)]
struct Variable {
    key: String,
    distribution: Distribution,
    unit: String,
}

/// A value that a scene of a study has in place of the base scene's.
#[derive(Debug, Clone, PartialEq)]
pub enum Input {
    /// A number in SI.
    Number(f64),
    /// A word, or anything else, as it stands in TOML.
    Text(String),
}

impl Study {
    /// Reads a study and its base scene.
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene), whose message shows the line with the bad place marked, the key and the cure; [`Error::File`](crate::Error::File) if one of the two
    /// files cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_toml(&read_text(path)?, &path.display().to_string(), folder)
    }

    /// Reads a study from its text, and the base scene that it names.
    ///
    /// # Arguments
    /// * `text`, `name` -- the study and what messages call it
    /// * `folder` -- that to which the base scene is relative
    ///
    /// # Errors
    /// As [`Study::read`].
    pub fn from_toml(text: &str, name: &str, folder: &Path) -> Result<Self> {
        let source = Source { name, text, kind: "a study" };
        let document = source.parse()?;
        let root = Section::root(source, document.get_ref());
        let entry = root.required("scene", "name the file of the base scene, relative to the study")?;
        let base = folder.join(entry.string()?);
        let base_text =
            read_text(&base).map_err(|error| entry.error(format_args!("cannot be used: {error}")))?;
        Self::from_texts(text, name, &base_text, &base)
    }

    /// Reads a study from the texts of its two files.
    ///
    /// # Arguments
    /// * `text`, `name` -- the study and what messages call it
    /// * `base_text`, `base` -- the base scene and its path, to which the files it names are relative
    ///
    /// # Errors
    /// As [`Study::read`].
    pub fn from_texts(text: &str, name: &str, base_text: &str, base: &Path) -> Result<Self> {
        let source = Source { name, text, kind: "a study" };
        if (text.len() + base_text.len()) as u64 > LARGEST {
            return Err(source.unplaced(format_args!("is larger than {LARGEST} bytes, which no study is")));
        }
        let document = source.parse()?;
        let root = Section::root(source, document.get_ref());
        let mut study = reading::read(&root)?;
        study.base = base_table(base_text, base)?;
        study.folder = base.parent().unwrap_or(Path::new("")).to_owned();
        (study.name, study.text, study.base_text) = (name.into(), text.into(), base_text.into());
        Ok(study)
    }

    /// Title, one line.
    pub fn title(&self) -> Option<&str> {
        self.title.as_deref()
    }

    /// What is done with each scene.
    pub fn task(&self) -> Task {
        self.task
    }

    /// Of which scenes the snapshots are kept.
    pub fn snapshots(&self) -> &KeptSnapshots {
        &self.snapshots
    }

    /// Number of scenes, from 1 to [`MOST_SCENES`](super::MOST_SCENES).
    pub fn count(&self) -> u64 {
        self.count
    }

    /// The TOML text of the study.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The TOML text of the base scene.
    pub fn base_text(&self) -> &str {
        &self.base_text
    }

    /// SHA-256 of everything that a result depends on, in hexadecimal digits: version of the program and of its formats, study, base scene, and the files of
    /// measured profiles and recorded paths that the scenes name.
    #[cfg(feature = "hdf5")]
    pub fn hash(&self) -> String {
        let mut parts = Fingerprint::default()
            .add(env!("CARGO_PKG_VERSION").as_bytes())
            .add(&FORMAT_VERSION.to_le_bytes())
            .add(&SweepFile::FORMAT_VERSION.to_le_bytes())
            .add(self.text.as_bytes())
            .add(self.base_text.as_bytes());
        for file in self.files() {
            // A file that cannot be read is an error of the scenes that name it.
            let read = input::bytes(&self.folder.join(file), columns::LARGEST, Pipes::Refused);
            parts = parts.add(&read.unwrap_or_default());
        }
        parts.finish()
    }

    /// The files of measured profiles and recorded paths, of the base scene and along the axes.
    fn files(&self) -> Vec<&str> {
        let named = |key: String| {
            let mut parts = key.split('.');
            let first = parts.next().and_then(|table| self.base.get(table));
            let in_base = parts.fold(first, |table, part| table.and_then(|it| it.get(part)));
            let along = self.axes.iter().flat_map(move |axis| {
                let place = axis.keys.iter().position(|it| *it == key);
                axis.rows.iter().filter_map(move |row| place.map(|place| &row[place]))
            });
            in_base.into_iter().chain(along).filter_map(Value::as_str)
        };
        keys::SCENE.dotted().into_iter().filter(|key| key.ends_with(".file")).flat_map(named).collect()
    }

    /// The keys that vary, axes before samples.
    pub fn keys(&self) -> Vec<&str> {
        let axes = self.axes.iter().flat_map(|axis| axis.keys.iter().map(String::as_str));
        let sampled = self.sampling.iter().flat_map(|it| it.variables.iter().map(|it| it.key.as_str()));
        axes.chain(sampled).collect()
    }

    /// Whether a key has numbers and whether it has words in any scene, in the order of [`Study::keys`].
    pub fn kinds(&self) -> Vec<[bool; 2]> {
        let mut kinds = vec![];
        for axis in &self.axes {
            for place in 0..axis.keys.len() {
                let is_word = |row: &Vec<Value>| matches!(Input::new(&row[place]), Input::Text(_));
                kinds.push([!axis.rows.iter().all(is_word), axis.rows.iter().any(is_word)]);
            }
        }
        kinds.extend(self.sampling.iter().flat_map(|it| it.variables.iter().map(|_| [true, false])));
        kinds
    }

    /// Values of the keys in a scene, in the order of [`Study::keys`].
    ///
    /// # Panics
    /// If there is no scene of this number.
    pub fn inputs(&self, scene: u64) -> Vec<Input> {
        self.values(scene).iter().map(Input::new).collect()
    }

    fn values(&self, scene: u64) -> Vec<Value> {
        assert!(scene < self.count, "scene {scene} of {}", self.count);
        let mut rest = scene;
        let mut digit = |base: u64| {
            let digit = rest % base;
            rest /= base;
            digit
        };
        let sample = self.sampling.as_ref().map(|sampling| (sampling, digit(sampling.count)));
        let mut rows: Vec<&Vec<Value>> =
            self.axes.iter().rev().map(|axis| &axis.rows[digit(axis.rows.len() as u64) as usize]).collect();
        rows.reverse();
        let mut values: Vec<Value> = rows.into_iter().flatten().cloned().collect();
        if let Some((sampling, sample)) = sample {
            values.extend(sampling.values(sample));
        }
        values
    }

    /// The TOML text of a scene.
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene) if a key leads through something that is no table.
    ///
    /// # Panics
    /// If there is no scene of this number.
    pub fn scene_text(&self, scene: u64) -> Result<String> {
        let mut table = self.base.clone();
        for (key, value) in self.keys().into_iter().zip(self.values(scene)) {
            set(&mut table, &self.name, key, value)?;
        }
        Ok(table.to_string())
    }

    /// A scene.
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene) names the scene, shows the line of its text and the cure.
    ///
    /// # Panics
    /// If there is no scene of this number.
    pub fn scene(&self, scene: u64) -> Result<Scene> {
        let name = format!("{}, scene {scene}", self.name);
        Scene::with_rows(&self.scene_text(scene)?, &name, &Rows::In(&self.folder))
    }
}

impl Input {
    fn new(value: &Value) -> Self {
        match value {
            Value::Integer(number) => Self::Number(*number as f64),
            Value::Float(number) => Self::Number(*number),
            Value::String(text) => quantity(text).map_or_else(|| Self::Text(text.clone()), Self::Number),
            other => Self::Text(other.to_string()),
        }
    }
}

/// A number with a unit, in SI.
fn quantity(text: &str) -> Option<f64> {
    let (digits, exponent, unit) = split_number(text.trim())?;
    let unit = unit.trim();
    let unit = if unit.is_empty() { Unit::ONE } else { Unit::read(unit).ok()? };
    unit.scale(digits, exponent)
}

impl Sampling {
    fn values(&self, sample: u64) -> impl Iterator<Item = Value> {
        self.variables.iter().enumerate().map(move |(index, variable)| {
            let probability = self.cube.coordinate(sample, index);
            with_unit(variable.distribution.quantile(probability), &variable.unit)
        })
    }
}

fn with_unit(number: f64, unit: &str) -> Value {
    match unit {
        "" => Value::Float(number),
        unit => Value::String(format!("{number:e} {unit}")),
    }
}
