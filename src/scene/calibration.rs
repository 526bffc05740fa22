//! A calibration: keys of a scene that are found from measurements.
//!
//! ```toml
//! scene = "ball.toml"                      # not needed where every data set has measured energies
//!
//! [[unknowns]]
//! key = "wear.archard.coefficient"
//! from = "1e-16 1/Pa"
//! to = "1e-12 1/Pa"
//!
//! [[data]]
//! file = "volumes.csv"
//! cycles = "N"                             # names of columns
//! wear_volume = "V [mm^3]"
//! set = { "loading.amplitude" = "2 um" }   # keys of the scene for this data set
//! ```

mod measurements;
mod reading;

use std::path::{Path, PathBuf};

use toml::{Table, Value};

use super::document::{Section, Source};
use super::settings::set;
use super::{LARGEST, Rows, Scene, base_table, read_text};
use crate::error::Result;

/// The one unknown of a calibration without a scene.
const ALPHA: &str = "wear.dissipated-energy.coefficient";

/// Keys of `[numerics]` in whose place the accuracy stands that the data ask for.
const BY_HAND: [&str; 2] = ["springs", "tolerance"];

/// A word on numerics by hand, which the accuracy that the data ask for replaces.
fn by_hand(base: &Table, data: &[DataSet]) -> Option<String> {
    let numerics = base.get("numerics").and_then(Value::as_table);
    let given = |key: &&&str| {
        let dotted = format!("numerics.{key}");
        numerics.is_some_and(|it| it.contains_key(**key))
            || data.iter().any(|it| it.settings.iter().any(|(key, _)| *key == dotted))
    };
    let given: Vec<String> = BY_HAND.iter().filter(given).map(|key| format!("numerics.{key}")).collect();
    (!given.is_empty()).then(|| {
        format!("{} by hand not followed: runs are as accurate as the data ask for", given.join(" and "))
    })
}

/// What a data set holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measured {
    /// Worn volume over cycles, m³.
    WearVolume,
    /// Largest wear depth over cycles, m.
    WearDepth,
    /// Contact radius over cycles, m.
    ContactRadius,
    /// Amplitude of the tangential force over cycles, N.
    TangentialForce,
    /// Energy dissipated in one cycle, over cycles, J.
    CycleEnergy,
    /// Energy dissipated since the start, over cycles, J.
    DissipatedEnergy,
    /// Worn volume over measured energies, m³.
    VolumeOverEnergy,
    /// Height along a line through the centre of a scar, m.
    Scar,
    /// Tangential force along one fretting loop, N.
    Loop,
}

impl Measured {
    /// All of them, in the order of the forms of a data set.
    pub const ALL: [Self; 9] = [
        Self::WearVolume,
        Self::WearDepth,
        Self::ContactRadius,
        Self::TangentialForce,
        Self::CycleEnergy,
        Self::DissipatedEnergy,
        Self::VolumeOverEnergy,
        Self::Scar,
        Self::Loop,
    ];

    /// Words for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::WearVolume => "worn volume over cycles",
            Self::WearDepth => "wear depth over cycles",
            Self::ContactRadius => "contact radius over cycles",
            Self::TangentialForce => "tangential force over cycles",
            Self::CycleEnergy => "energy per cycle over cycles",
            Self::DissipatedEnergy => "dissipated energy over cycles",
            Self::VolumeOverEnergy => "worn volume over dissipated energy",
            Self::Scar => "scar profile",
            Self::Loop => "fretting loop",
        }
    }

    /// Unit of the values in SI.
    pub fn unit(self) -> &'static str {
        match self {
            Self::WearVolume | Self::VolumeOverEnergy => "m3",
            Self::WearDepth | Self::ContactRadius | Self::Scar => "m",
            Self::TangentialForce | Self::Loop => "N",
            Self::CycleEnergy | Self::DissipatedEnergy => "J",
        }
    }

    /// Whether the first column is that of cycles.
    pub fn is_over_cycles(self) -> bool {
        !matches!(self, Self::VolumeOverEnergy | Self::Scar | Self::Loop)
    }
}

/// What is known of the standard deviations of a data set.
#[derive(Debug, Clone, PartialEq)]
pub enum Deviation {
    /// One for each value, in its unit.
    Known(Vec<f64>),
    /// A part of the value that is predicted.
    Relative(f64),
    /// The same for all values, not known.
    Estimated,
    /// The same part of all values that are predicted, not known.
    EstimatedRelative,
}

/// Measurements of one test, in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct DataSet {
    /// The file as the calibration names it.
    pub file: String,
    /// What they are.
    pub measured: Measured,
    /// Cycles, energies (J), positions or displacements (m), shape `(value,)`.
    pub at: Vec<f64>,
    /// What was measured there, shape `(value,)`.
    pub values: Vec<f64>,
    /// Lines of the file, shape `(value,)`.
    pub lines: Vec<usize>,
    /// What is known of their deviations.
    pub deviation: Deviation,
    /// The cycle of a scar or a loop; zero else.
    pub cycles: f64,
    /// Part of the wear that the body of a scar has.
    pub share: f64,
    settings: Vec<(String, Value)>,
}

/// A key that is found.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// Dotted key of the scene.
    pub key: String,
    /// Other keys that have the same value.
    pub tied: Vec<String>,
    /// Least and largest value, in SI.
    pub bounds: [f64; 2],
    /// Whether it is looked for by ratios.
    pub is_logarithmic: bool,
    /// Unit in SI.
    pub unit: &'static str,
}

/// A law with unknowns of its own.
#[derive(Debug, Clone, PartialEq)]
struct Model {
    name: String,
    settings: Vec<(String, Value)>,
    unknowns: Vec<Unknown>,
}

/// A valid calibration with its measurements.
///
/// # Examples
/// ```
/// # use std::path::Path;
/// use fretwear::scene::{Calibration, Measured};
///
/// let calibration = Calibration::read(Path::new("data/calibration/ti6al4v_5hz.toml"))?;
/// let (unknown, data) = (&calibration.unknowns()[0], &calibration.data()[0]);
/// assert_eq!(unknown.key, "wear.dissipated-energy.coefficient");
/// assert_eq!((data.measured, data.at[0], data.values[0]), (Measured::VolumeOverEnergy, 17_200.0, 1.81e-9));
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    title: Option<String>,
    unknowns: Vec<Unknown>,
    data: Vec<DataSet>,
    /// Keys of the scene for all data sets.
    settings: Vec<(String, Value)>,
    models: Vec<Model>,
    is_robust: bool,
    bootstrap: u64,
    seed: u64,
    base: Option<Table>,
    /// Folder of the base scene, to which files that it names are relative.
    folder: PathBuf,
    name: String,
    text: String,
    base_text: String,
    notes: Vec<String>,
}

impl Calibration {
    /// Reads a calibration, its base scene and its measurements.
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene), whose message shows the line with the bad place marked, the key and the cure; [`Error::File`](crate::Error::File) where one of the files
    /// cannot be used, with the line.
    pub fn read(path: &Path) -> Result<Self> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_toml(&read_text(path)?, &path.display().to_string(), folder)
    }

    /// Reads a calibration from its text; files that it names are taken relative to a folder.
    ///
    /// # Errors
    /// As [`Calibration::read`].
    pub fn from_toml(text: &str, name: &str, folder: &Path) -> Result<Self> {
        Self::of_texts(text, name, folder, None)
    }

    /// Reads a calibration and its base scene from their texts; the calibration names the scene by any word.
    ///
    /// # Arguments
    /// * `base` -- text of the scene, and the path to whose folder the files that it names are relative
    ///
    /// # Errors
    /// As [`Calibration::read`].
    pub fn from_texts(text: &str, name: &str, folder: &Path, base: (&str, &Path)) -> Result<Self> {
        Self::of_texts(text, name, folder, Some(base))
    }

    fn of_texts(text: &str, name: &str, folder: &Path, base: Option<(&str, &Path)>) -> Result<Self> {
        let source = Source { name, text, kind: "a calibration" };
        if text.len() as u64 > LARGEST {
            return Err(
                source.unplaced(format_args!("is larger than {LARGEST} bytes, which no calibration is"))
            );
        }
        let document = source.parse()?;
        let root = Section::root(source, document.get_ref());
        let mut calibration = reading::read(&root, &source.values()?, folder)?;
        (calibration.name, calibration.text) = (name.into(), text.into());
        if let Some(entry) = root.optional("scene") {
            let named = folder.join(entry.string()?);
            let (text, base) = match base {
                Some((text, base)) => (text.to_owned(), base.to_owned()),
                None => {
                    let text = read_text(&named);
                    let wrong = |error| entry.error(format_args!("cannot be used: {error}"));
                    (text.map_err(wrong)?, named)
                }
            };
            let table = base_table(&text, &base)?;
            calibration.notes.extend(by_hand(&table, &calibration.data));
            calibration.base = Some(table);
            calibration.folder = base.parent().unwrap_or(Path::new("")).to_owned();
            calibration.base_text = text;
        }
        Ok(calibration)
    }

    /// The laws that are compared, each with its name and as a calibration of its own; itself without a name where none are.
    pub fn models(&self) -> Vec<(String, Self)> {
        let of = |model: &Model| {
            let unknowns = [&self.unknowns[..], &model.unknowns].concat();
            let settings = model.settings.clone();
            (model.name.clone(), Self { unknowns, settings, models: vec![], ..self.clone() })
        };
        match self.models.is_empty() {
            true => vec![(String::new(), self.clone())],
            false => self.models.iter().map(of).collect(),
        }
    }

    /// Title, one line.
    pub fn title(&self) -> Option<&str> {
        self.title.as_deref()
    }

    /// What is found.
    pub fn unknowns(&self) -> &[Unknown] {
        &self.unknowns
    }

    /// What was measured.
    pub fn data(&self) -> &[DataSet] {
        &self.data
    }

    /// Whether residuals cost what Huber lets them cost, instead of their squares.
    pub fn is_robust(&self) -> bool {
        self.is_robust
    }

    /// How many times the data are made anew from their residuals, to tell intervals without normal errors; 0 for never.
    pub fn bootstrap(&self) -> u64 {
        self.bootstrap
    }

    /// Seed of the random numbers for that.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// Whether there is a base scene; without one all data are measured energies.
    pub fn has_scene(&self) -> bool {
        self.base.is_some()
    }

    /// What messages call it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The TOML text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The TOML text of the base scene, empty without one.
    pub fn base_text(&self) -> &str {
        &self.base_text
    }

    /// What was left out of the files, one sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// All data sets of the same scene that one run serves, in their order; a data set over measured energies needs none and is by itself.
    pub fn companions(&self, data: usize) -> Vec<usize> {
        let runs = |it: &DataSet| it.measured != Measured::VolumeOverEnergy;
        let one = &self.data[data];
        let same = |it: &DataSet| runs(it) && it.settings == one.settings;
        match runs(one) {
            true => (0..self.data.len()).filter(|it| same(&self.data[*it])).collect(),
            false => vec![data],
        }
    }

    /// The scene of a data set.
    ///
    /// # Arguments
    /// * `data` -- its place
    /// * `values` -- of the unknowns, in SI, shape `(unknown,)`
    /// * `cycles` -- at which snapshots are taken, increasing, above 0; the run ends with the last
    /// * `accuracy` -- of the run, in place of springs and tolerance that the scene gives by hand
    ///
    /// # Errors
    /// As [`Scene::from_toml`].
    ///
    /// # Panics
    /// If there is no base scene, or no cycles are given.
    pub fn scene(&self, data: usize, values: &[f64], cycles: &[f64], accuracy: f64) -> Result<Scene> {
        let mut table = self.base.clone().expect("a data set that needs a scene has one");
        let name = format!("{}, data[{data}]", self.name);
        let mut put = |key: &str, value: Value| set(&mut table, &name, key, value);
        for (key, value) in self.settings.iter().chain(&self.data[data].settings) {
            put(key, value.clone())?;
        }
        self.pairs(values).try_for_each(|(key, value)| put(key, Value::Float(value)))?;
        let end = *cycles.last().expect("a run lasts for some cycles");
        put("loading.cycles", Value::Float(end))?;
        put("output.at_cycles", Value::Array(cycles.iter().map(|it| Value::Float(*it)).collect()))?;
        put("numerics.accuracy", Value::Float(accuracy))?;
        if let Some(numerics) = table.get_mut("numerics").and_then(Value::as_table_mut) {
            BY_HAND.iter().for_each(|key| drop(numerics.remove(*key)));
        }
        Scene::with_rows(&table.to_string(), &name, &Rows::In(&self.folder))
    }

    /// All keys that are found or tied to one that is, with their values.
    fn pairs(&self, values: &[f64]) -> impl Iterator<Item = (&str, f64)> {
        self.unknowns.iter().zip(values.to_vec()).flat_map(|(unknown, value)| {
            std::iter::once(&unknown.key).chain(&unknown.tied).map(move |key| (key.as_str(), value))
        })
    }

    /// Another scene with the keys of the law and of the unknowns.
    ///
    /// # Arguments
    /// * `text` -- of the scene, in TOML
    /// * `name` -- what messages call it
    /// * `folder` -- that to which the files it names are relative
    /// * `values` -- of the unknowns, in SI, shape `(unknown,)`
    ///
    /// # Errors
    /// As [`Scene::from_toml`].
    pub fn scene_with(&self, text: &str, name: &Path, folder: &Path, values: &[f64]) -> Result<Scene> {
        let mut table = base_table(text, name)?;
        let name = name.display().to_string();
        let own = self.settings.iter().map(|(key, value)| (key.as_str(), value.clone()));
        for (key, value) in own.chain(self.pairs(values).map(|(key, it)| (key, Value::Float(it)))) {
            set(&mut table, &name, key, value)?;
        }
        Scene::with_rows(&table.to_string(), &name, &Rows::In(folder))
    }
}
