//! What the program knows of a law, a mode of motion or an indenter before it is built: its name, its keys and how it is made of their values.

use std::any::Any;
use std::cell::RefCell;
use std::path::PathBuf;
use std::sync::Arc;

use serde::ser::{SerializeMap, Serializer};

use crate::error::Error;
use crate::units::{Dimension, Key, Rule, Table};

/// A law of a scene, a mode of motion or an indenter. Reader, schema, patches and reports are made of it.
pub struct Entry<L: ?Sized + 'static> {
    /// Name of its table, `threshold` in `[wear.threshold]`.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// Keys of its table.
    pub keys: &'static [Key],
    /// What differs from the laws of Coulomb and Archard, in words; none where nothing does.
    pub departure: Option<&'static str>,
    /// Which of its keys go together.
    pub rules: &'static [Rule],
    /// Whether with these values it is made of the first contact too.
    pub refers: fn(&Values) -> bool,
    /// The columns of the file that its key `file` names.
    pub columns: Option<&'static Columns>,
    /// Key of the exponent that the unit of its coefficient depends on, and the dimension of that.
    pub by_exponent: Option<(&'static str, OfExponent)>,
    /// Whether it is a mode that decides the tangential amplitude itself.
    pub gives_amplitude: bool,
    /// Makes it of its values.
    pub build: fn(&Values) -> Built<L>,
}

impl<L: ?Sized + 'static> Entry<L> {
    /// A law with these keys.
    pub const fn new(
        name: &'static str,
        about: &'static str,
        keys: &'static [Key],
        build: fn(&Values) -> Built<L>,
    ) -> Self {
        Self {
            name,
            about,
            keys,
            departure: None,
            rules: &[],
            refers: |_| false,
            columns: None,
            by_exponent: None,
            gives_amplitude: false,
            build,
        }
    }

    /// The entry of a law that departs from those of Coulomb and Archard.
    pub const fn departs(self, departure: &'static str) -> Self {
        Self { departure: Some(departure), ..self }
    }

    /// The entry of a law of whose keys some go together.
    pub const fn rules(self, rules: &'static [Rule]) -> Self {
        Self { rules, ..self }
    }

    /// Its table in a scene.
    pub const fn table(&self) -> Table {
        Table::new(self.name, self.about, self.keys).rules(self.rules)
    }

    /// The entry of what is made of the first contact too, with such values.
    pub const fn refers(self, refers: fn(&Values) -> bool) -> Self {
        Self { refers, ..self }
    }

    /// The entry of what is read from a file of columns.
    pub const fn columns(self, columns: &'static Columns) -> Self {
        Self { columns: Some(columns), ..self }
    }

    /// The entry with a coefficient whose unit depends on the exponent of another key.
    pub const fn by_exponent(self, exponent: &'static str, dimension: OfExponent) -> Self {
        Self { by_exponent: Some((exponent, dimension)), ..self }
    }

    /// The entry of a mode that decides the tangential amplitude itself.
    pub const fn gives_amplitude(self) -> Self {
        Self { gives_amplitude: true, ..self }
    }

    /// The law of these values with its coefficients, which the names of their keys tell, times `factor`.
    pub(super) fn scaled(&self, values: Vec<Value>, factor: f64) -> Arc<L> {
        let times = |(key, value): (&Key, Value)| match value {
            Value::Number(number) if key.name.ends_with("coefficient") => Value::Number(factor * number),
            other => other,
        };
        let values = self.keys.iter().zip(values).map(times).collect();
        (self.build)(&Values::new(self.keys, values))
            .expect("a common factor changes no relation between them")
    }
}

/// Dimension of a coefficient at an exponent.
pub type OfExponent = fn(f64) -> Dimension;

/// What stands in a file of columns, for its reader and messages.
pub struct Columns {
    /// What it describes, with its article: `a profile`.
    pub what: &'static str,
    /// How many columns, in words.
    pub count: &'static str,
    /// Which columns: `r and f`.
    pub listed: &'static str,
    /// Names of the columns.
    pub names: &'static [&'static str],
    /// Keys of the units of the columns, of lengths.
    pub units: &'static [&'static str],
    /// Fewest columns of a row, the most being all names.
    pub fewest: usize,
    /// Most rows.
    pub most_rows: usize,
    /// What more a row must satisfy, in the units of the file.
    pub check: fn(&[f64]) -> Result<(), String>,
}

/// A file of columns that was read.
#[derive(Debug, Clone)]
pub struct File {
    /// Where it is.
    pub path: PathBuf,
    /// What the scene calls it.
    pub name: String,
    /// Its rows, at least one.
    pub rows: Vec<Row>,
}

/// A row of a file, as written in a line, and in m.
#[derive(Debug, Clone)]
pub struct Row {
    /// The line, from 1 on.
    pub line: usize,
    /// In the units of the file.
    pub written: Vec<f64>,
    /// In m.
    pub metres: Vec<f64>,
}

/// A value of a key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// A number in SI.
    Number(f64),
    /// One of the words of the key.
    Word(&'static str),
    /// A ratio of whole numbers without common divisor.
    Ratio([u32; 2]),
    /// The key was left out and has no default.
    Missing,
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

/// Lengths of the first contact that others refer to.
#[derive(Debug, Clone, Copy)]
pub struct Lengths {
    /// Indentation `d`, m.
    pub indentation: f64,
    /// Tangential amplitude `U`, m.
    pub amplitude: f64,
}

/// Values of the keys of a law, and what else it may be made of.
#[derive(Debug, Clone)]
pub struct Values {
    given: Vec<(&'static str, Value)>,
    /// Cycles per second, Hz, where the scene tells.
    pub frequency: Option<f64>,
    /// The first contact; 1 m for all where [`Entry::refers`] says that they are not asked for.
    pub contact: Lengths,
    /// The file that was read.
    pub file: Option<File>,
    /// What was stored with a result in place of files.
    pub stored: Vec<Arc<dyn Any + Send + Sync>>,
    /// What is allowed but deserves a word.
    pub warnings: RefCell<Vec<String>>,
}

impl Values {
    /// The values of some keys, in their order.
    pub fn new(keys: &'static [Key], values: Vec<Value>) -> Self {
        assert_eq!(keys.len(), values.len(), "one value per key");
        Self {
            given: keys.iter().map(|key| key.name).zip(values).collect(),
            frequency: None,
            contact: Lengths { indentation: 1.0, amplitude: 1.0 },
            file: None,
            stored: vec![],
            warnings: RefCell::default(),
        }
    }

    fn get(&self, name: &str) -> Value {
        let found = self.given.iter().find(|(key, _)| *key == name);
        found.unwrap_or_else(|| panic!("{name} is no key of this law")).1
    }

    /// The number of a key, if it was given or has a default.
    pub fn optional(&self, name: &str) -> Option<f64> {
        match self.get(name) {
            Value::Number(number) => Some(number),
            Value::Missing => None,
            _ => panic!("{name} takes no number"),
        }
    }

    /// The number of a key that is required or has a default.
    pub fn number(&self, name: &str) -> f64 {
        self.optional(name).unwrap_or_else(|| panic!("{name} is required"))
    }

    /// The word of a key that takes words and is required or has a default.
    pub fn word(&self, name: &str) -> &'static str {
        match self.get(name) {
            Value::Word(word) => word,
            _ => panic!("{name} takes a word"),
        }
    }

    /// The ratio of a key that takes one and is required or has a default.
    pub fn ratio(&self, name: &str) -> [u32; 2] {
        match self.get(name) {
            Value::Ratio(ratio) => ratio,
            _ => panic!("{name} takes a ratio"),
        }
    }

    /// What was stored with a result, if it is of this type.
    pub fn stored<T: Any + Send + Sync>(&self) -> Option<Arc<T>> {
        self.stored.iter().find_map(|it| Arc::clone(it).downcast().ok())
    }

    /// The file that was read.
    ///
    /// # Errors
    /// Its rows should have been stored with a result and were not.
    pub fn file(&self) -> Result<&File, Wrong> {
        let why = || "is not at hand: its rows are not stored in the result; run the scene again".into();
        self.file.as_ref().ok_or_else(|| Wrong::Value { key: "file", why: why() })
    }

    /// Whether a key was left out.
    pub fn lacks(&self, name: &str) -> bool {
        self.get(name) == Value::Missing
    }
}

/// What was made of values, or what is wrong with them though each is allowed.
pub type Built<L> = Result<Arc<L>, Wrong>;

/// What is wrong with values each of which is allowed.
#[derive(Debug)]
pub enum Wrong {
    /// It shows at the value of a key.
    Value {
        /// The key.
        key: &'static str,
        /// What follows its name and value in an error.
        why: String,
    },
    /// An error that names a key of the scene, or what was read from a file.
    Error(Error),
}

impl From<Error> for Wrong {
    fn from(error: Error) -> Self {
        Self::Error(error)
    }
}

/// Writes a law as its name and its values.
pub(super) fn serialize<L: ?Sized, S: Serializer>(
    entry: &Entry<L>,
    values: &[Value],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(None)?;
    map.serialize_entry("law", entry.name)?;
    for (key, value) in entry.keys.iter().zip(values) {
        match value {
            Value::Number(number) => map.serialize_entry(key.name, number)?,
            Value::Word(word) => map.serialize_entry(key.name, word)?,
            Value::Ratio(ratio) => map.serialize_entry(key.name, ratio)?,
            Value::Missing => {}
        }
    }
    map.end()
}
