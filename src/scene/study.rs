//! A study: a base scene and what is varied in it, expanded to numbered scenes.

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use toml::{Table, Value};

use super::document::{Entry, Section, Source};
use super::quantity::{Dimension, split_number};
use super::sampling::{Distribution, Method, UnitCube};
use super::unit::Unit;
use super::{LARGEST, Rows, Scene, read_text, sections};
use crate::error::{Error, Result};

/// Most scenes of a study.
pub const MOST_SCENES: u64 = 10_000_000;

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
        match self {
            Self::Run => "run",
            Self::Limit => "limit",
        }
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
    /// [`Error::Scene`], whose message shows the line with the bad place marked, the key and the cure; [`Error::File`] if one of the two
    /// files cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        let text = read_text(path)?;
        let name = path.display().to_string();
        let source = Source { name: &name, text: &text, kind: "a study" };
        let document = source.parse()?;
        let root = Section::root(source, document.get_ref());
        let entry = root.required("scene", "name the file of the base scene, relative to the study")?;
        let base = path.parent().unwrap_or(Path::new("")).join(entry.string()?);
        let base_text = read_text(&base)?;
        Self::from_texts(&text, &name, &base_text, &base)
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
            return Err(source.missing(format_args!("is larger than {LARGEST} bytes, which no study is")));
        }
        let document = source.parse()?;
        let root = Section::root(source, document.get_ref());
        let base_table = base_text.parse::<Table>().map_err(|error| Error::File {
            path: base.to_owned(),
            why: format!("the base scene of {name} is not valid TOML: {}", error.message()),
        })?;
        let mut study = read(&root)?;
        study.base = base_table;
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

    /// Number of scenes, from 1 to [`MOST_SCENES`].
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

    /// SHA-256 of everything that a result depends on, in hexadecimal digits: version of the program, study, base scene, and the files of
    /// measured profiles that the scenes name.
    pub fn hash(&self) -> String {
        let mut hasher = Sha256::new();
        let mut add = |part: &[u8]| {
            hasher.update((part.len() as u64).to_le_bytes());
            hasher.update(part);
        };
        [env!("CARGO_PKG_VERSION"), &self.text, &self.base_text].iter().for_each(|part| add(part.as_bytes()));
        for file in self.profile_files() {
            // A file that cannot be read is an error of the scenes that name it.
            add(&std::fs::read(self.folder.join(file)).unwrap_or_default());
        }
        hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// The files of measured profiles, of the base scene and along the axes.
    fn profile_files(&self) -> Vec<&str> {
        let table = self.base.get("indenter").and_then(|it| it.get("table")).and_then(|it| it.get("file"));
        let along = self.axes.iter().flat_map(|axis| {
            let place = axis.keys.iter().position(|key| key == "indenter.table.file");
            axis.rows.iter().filter_map(move |row| place.map(|place| &row[place]))
        });
        table.into_iter().chain(along).filter_map(Value::as_str).collect()
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
    /// [`Error::Scene`] if a key leads through something that is no table.
    ///
    /// # Panics
    /// If there is no scene of this number.
    pub fn scene_text(&self, scene: u64) -> Result<String> {
        let mut table = self.base.clone();
        for (key, value) in self.keys().into_iter().zip(self.values(scene)) {
            set(&mut table, key, value)
                .map_err(|why| Error::Scene(format!("{}: {key}: {why}", self.name)))?;
        }
        Ok(table.to_string())
    }

    /// A scene.
    ///
    /// # Errors
    /// [`Error::Scene`] names the scene, shows the line of its text and the cure.
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

/// Sets a dotted key.
fn set(table: &mut Table, key: &str, value: Value) -> std::result::Result<(), String> {
    match key.split_once('.') {
        None => {
            table.insert(key.into(), value);
            Ok(())
        }
        Some((first, rest)) => {
            let inner = table.entry(first).or_insert_with(|| Value::Table(Table::new()));
            let inner =
                inner.as_table_mut().ok_or_else(|| format!("{first} is no table in the base scene"))?;
            set(inner, rest, value)
        }
    }
}

fn read(root: &Section) -> Result<Study> {
    root.only(&["title", "scene", "task", "axes", "sampling", "output"], &[])?;
    let title = root.optional("title").map(|entry| sections::title(&entry)).transpose()?;
    let task = match root.optional("task") {
        Some(entry) => Task::ALL[entry.word(&Task::ALL.map(Task::name))?],
        None => Task::default(),
    };
    const MOST_AXES: usize = 100;
    let axes = match root.optional("axes") {
        Some(entry) => {
            entry.array(MOST_AXES)?.iter().map(|it| axis(&it.section()?)).collect::<Result<Vec<_>>>()?
        }
        None => vec![],
    };
    let sampling =
        root.optional("sampling").map(|entry| entry.section().and_then(|it| sampling(&it))).transpose()?;
    let lengths = axes.iter().map(|axis| axis.rows.len() as u64).chain(sampling.as_ref().map(|it| it.count));
    let count = lengths.fold(1u64, u64::saturating_mul);
    if count > MOST_SCENES {
        return Err(root.error(format_args!(
            "expands to {} scenes, more than {MOST_SCENES}; make the axes shorter or split the study",
            if count == u64::MAX { "too many".into() } else { count.to_string() }
        )));
    }
    let mut snapshots = KeptSnapshots::None;
    if let Some(entry) = root.optional("output") {
        let section = entry.section()?;
        section.only(&["snapshots"], &[])?;
        if let Some(entry) = section.optional("snapshots") {
            snapshots = kept_snapshots(&entry, count)?;
        }
    }
    let study = Study {
        title,
        task,
        snapshots,
        base: Table::new(),
        folder: PathBuf::new(),
        name: String::new(),
        axes,
        sampling,
        count,
        text: String::new(),
        base_text: String::new(),
    };
    let mut keys = study.keys();
    keys.sort_unstable();
    if let Some(twice) = keys.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(root.error(format_args!("{} is varied twice; name it in one axis only", twice[0])));
    }
    Ok(study)
}

fn kept_snapshots(entry: &Entry, count: u64) -> Result<KeptSnapshots> {
    if entry.is_array() {
        let last = (count - 1) as usize;
        let scenes = entry.array(100_000)?.iter().map(|it| it.whole(0..=last)).collect::<Result<Vec<_>>>()?;
        let mut scenes: Vec<u64> = scenes.into_iter().map(|it| it as u64).collect();
        scenes.sort_unstable();
        scenes.dedup();
        return Ok(KeptSnapshots::Of(scenes));
    }
    Ok([KeptSnapshots::None, KeptSnapshots::All][entry.word(&["none", "all"])?].clone())
}

/// A dotted key of the scene.
fn key(entry: &Entry) -> Result<String> {
    let key = entry.string()?;
    let bare = |part: &str| {
        !part.is_empty() && part.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-'))
    };
    match key.split('.').all(bare) && key.contains('.') && key.len() < 200 {
        true => Ok(key.into()),
        false => Err(entry.error("is not a key of a scene, such as \"friction.coulomb.coefficient\"")),
    }
}

const MOST_ROWS: usize = MOST_SCENES as usize;

fn axis(section: &Section) -> Result<Axis> {
    section.only(&["key", "keys", "values", "rows", "from", "to", "count", "spacing"], &[])?;
    if let Some(entry) = section.optional("keys") {
        section.only(&["keys", "rows"], &[])?;
        let keys = entry.array(100)?.iter().map(key).collect::<Result<Vec<_>>>()?;
        let rows = section.required("rows", "one list of values for each scene along the axis")?;
        let width = keys.len();
        let row = |row: &Entry| -> Result<Vec<Value>> {
            let values = row.array(width)?.iter().map(value).collect::<Result<Vec<_>>>()?;
            match values.len() == width {
                true => Ok(values),
                false => Err(row.error(format_args!("has {} values for {width} keys", values.len()))),
            }
        };
        let rows = not_empty(&rows)?.iter().map(row).collect::<Result<_>>()?;
        return Ok(Axis { keys, rows });
    }
    let keys = vec![key(&section.required("key", "for example \"friction.coulomb.coefficient\"")?)?];
    if let Some(entry) = section.optional("values") {
        section.only(&["key", "values"], &[])?;
        let rows = not_empty(&entry)?.iter().map(|it| Ok(vec![value(it)?])).collect::<Result<_>>()?;
        return Ok(Axis { keys, rows });
    }
    let cure = "an axis has values = [...], or from, to and count";
    let (from, to) = (section.required("from", cure)?, section.required("to", cure)?);
    let ((low, unit), (high, other)) = (magnitude(&from)?, magnitude(&to)?);
    if unit != other {
        return Err(to.error(format_args!("has not the unit of {}, {unit:?}", from.path())));
    }
    let count = section.required("count", cure)?.whole(2..=MOST_ROWS)?;
    let spacings = ["linear", "geometric"];
    let geometric = section.optional("spacing").map_or(Ok(0), |entry| entry.word(&spacings))? == 1;
    if geometric && !(low > 0.0 && high > 0.0) {
        return Err(from.error(format_args!("and {} must be above zero for geometric spacing", to.path())));
    }
    let last = (count - 1) as f64;
    let at = |i: usize| match (i, geometric) {
        (0, _) => low,
        (i, _) if i + 1 == count => high,
        (i, true) => low * ((high / low).ln() * i as f64 / last).exp(),
        (i, false) => (low * (last - i as f64) + high * i as f64) / last,
    };
    Ok(Axis { keys, rows: (0..count).map(|i| vec![with_unit(at(i), &unit)]).collect() })
}

fn not_empty<'a>(entry: &Entry<'a>) -> Result<Vec<Entry<'a>>> {
    let entries = entry.array(MOST_ROWS)?;
    match entries.is_empty() {
        true => Err(entry.error("is empty; give at least one value")),
        false => Ok(entries),
    }
}

/// A value as TOML.
fn value(entry: &Entry) -> Result<Value> {
    let value = entry.literal()?;
    match value {
        Value::Table(_) => Err(entry.error("is a table; vary its keys one by one")),
        value => Ok(value),
    }
}

/// A number and its unit, empty for a plain number.
fn magnitude(entry: &Entry) -> Result<(f64, String)> {
    let Ok(text) = entry.string() else { return Ok((entry.quantity(Dimension::NUMBER)?, String::new())) };
    let unreadable = || entry.error("is not a number with a unit such as \"5 mm\"");
    let (digits, exponent, unit) = split_number(text.trim()).ok_or_else(unreadable)?;
    let unit = unit.trim();
    Unit::read(unit).map_err(|why| entry.error(format_args!(": {why}")))?;
    let number: f64 = format!("{digits}e{exponent}").parse().map_err(|_| unreadable())?;
    match number.is_finite() {
        true => Ok((number, unit.into())),
        false => Err(entry.error("is too large for a double")),
    }
}

fn with_unit(number: f64, unit: &str) -> Value {
    match unit {
        "" => Value::Float(number),
        unit => Value::String(format!("{number:e} {unit}")),
    }
}

fn sampling(section: &Section) -> Result<Sampling> {
    section.only(&["method", "count", "seed", "variables"], &[])?;
    let entry = section.required("count", "the number of samples")?;
    let count = entry.whole(1..=MOST_SCENES as usize)? as u64;
    let method = match section.optional("method") {
        Some(entry) => Method::ALL[entry.word(&Method::ALL.map(Method::name))?],
        None => Method::Sobol,
    };
    let seed = section.optional("seed").map_or(Ok(0), |entry| entry.whole(0..=usize::MAX))? as u64;
    let entry = section.required("variables", "a list of tables with key and distribution")?;
    let entries = entry.array(UnitCube::MOST_VARIABLES)?;
    if entries.is_empty() {
        return Err(entry.error("is empty; give at least one variable"));
    }
    let variables = entries.iter().map(|it| variable(&it.section()?)).collect::<Result<Vec<_>>>()?;
    Ok(Sampling { count, cube: UnitCube::new(method, count, variables.len(), seed), variables })
}

impl Sampling {
    fn values(&self, sample: u64) -> impl Iterator<Item = Value> {
        self.variables.iter().enumerate().map(move |(index, variable)| {
            let probability = self.cube.coordinate(sample, index);
            with_unit(variable.distribution.quantile(probability), &variable.unit)
        })
    }
}

fn variable(section: &Section) -> Result<Variable> {
    const KINDS: [&str; 4] = ["uniform", "log-uniform", "normal", "log-normal"];
    let entry = section.required("distribution", "uniform, log-uniform, normal or log-normal")?;
    let kind = entry.word(&KINDS)?;
    let parameters: [&str; 2] =
        [["from", "to"], ["from", "to"], ["mean", "deviation"], ["median", "factor"]][kind];
    let bounds: &[&str] = if kind < 2 { &[] } else { &["minimum", "maximum"] };
    section.only(&[&["key", "distribution"], &parameters[..], bounds].concat(), &[])?;
    let key = key(&section.required("key", "for example \"wear.archard.coefficient\"")?)?;
    let cure = format!("a {} distribution has {} and {}", KINDS[kind], parameters[0], parameters[1]);
    let (first, second) = (section.required(parameters[0], &cure)?, section.required(parameters[1], &cure)?);
    let (one, unit) = magnitude(&first)?;
    let same_unit = |entry: &Entry| -> Result<f64> {
        let (number, other) = magnitude(entry)?;
        match other == unit {
            true => Ok(number),
            false => Err(entry.error(format_args!("has not the unit of {}, {unit:?}", first.path()))),
        }
    };
    let positive = |entry: &Entry, value: f64| match value > 0.0 {
        true => Ok(value),
        false => Err(entry.error("must be above zero")),
    };
    let mut limits = [f64::NEG_INFINITY, f64::INFINITY];
    for (limit, name) in limits.iter_mut().zip(bounds) {
        if let Some(entry) = section.optional(name) {
            *limit = same_unit(&entry)?;
        }
    }
    if limits[0] >= limits[1] {
        return Err(section.error("minimum is not below maximum"));
    }
    let distribution = match kind {
        0 | 1 => {
            let two = same_unit(&second)?;
            if one >= two {
                return Err(second.error(format_args!("is not above {} = {one}", first.path())));
            }
            match kind {
                0 => Distribution::Uniform { from: one, to: two },
                _ => Distribution::LogUniform { from: positive(&first, one)?, to: two },
            }
        }
        2 => {
            let deviation = same_unit(&second)?;
            Distribution::Normal { mean: one, deviation: positive(&second, deviation)?, bounds: limits }
        }
        _ => {
            let factor = second.quantity_in(Dimension::NUMBER, "(1, inf)", |factor| factor > 1.0)?;
            limits[0] = limits[0].max(0.0);
            Distribution::LogNormal { median: positive(&first, one)?, factor, bounds: limits }
        }
    };
    Ok(Variable { key, distribution, unit })
}
