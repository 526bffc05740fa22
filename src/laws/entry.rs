//! What the program knows of a law before it is built: its name, its keys and how it is made of their values.

use std::sync::Arc;

use serde::ser::{SerializeMap, Serializer};

use crate::units::{Key, Rule, Table};

/// A law of a scene. Reader, schema, patches and reports are made of it.
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
    /// Key that is the indentation of the first cycle where it is left out.
    pub indentation: Option<&'static str>,
    /// Makes the law of its values.
    pub build: fn(&Values) -> Result<Arc<L>, Wrong>,
}

impl<L: ?Sized + 'static> Entry<L> {
    /// A law with these keys.
    pub const fn new(
        name: &'static str,
        about: &'static str,
        keys: &'static [Key],
        build: fn(&Values) -> Result<Arc<L>, Wrong>,
    ) -> Self {
        Self { name, about, keys, departure: None, rules: &[], indentation: None, build }
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

    /// The entry of a law with a key that is the indentation of the first cycle where it is left out.
    pub const fn indentation(self, key: &'static str) -> Self {
        Self { indentation: Some(key), ..self }
    }
}

/// A value of a key.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// A number in SI.
    Number(f64),
    /// One of the words of the key.
    Word(&'static str),
    /// The key was left out and has no default.
    Missing,
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

/// Values of the keys of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct Values {
    given: Vec<(&'static str, Value)>,
    /// Cycles per second, Hz, where the scene tells.
    pub frequency: Option<f64>,
}

impl Values {
    /// The values of some keys, in their order.
    pub fn new(keys: &'static [Key], values: Vec<Value>) -> Self {
        assert_eq!(keys.len(), values.len(), "one value per key");
        Self { given: keys.iter().map(|key| key.name).zip(values).collect(), frequency: None }
    }

    /// Gives a key another value.
    pub fn set(&mut self, name: &str, value: Value) {
        let found = self.given.iter_mut().find(|(key, _)| *key == name);
        found.unwrap_or_else(|| panic!("{name} is no key of this law")).1 = value;
    }

    fn get(&self, name: &str) -> Value {
        let found = self.given.iter().find(|(key, _)| *key == name);
        found.unwrap_or_else(|| panic!("{name} is no key of this law")).1
    }

    /// The number of a key, if it was given or has a default.
    pub fn optional(&self, name: &str) -> Option<f64> {
        match self.get(name) {
            Value::Number(number) => Some(number),
            Value::Word(_) => panic!("{name} takes a word"),
            Value::Missing => None,
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

    /// Whether a key was left out.
    pub fn lacks(&self, name: &str) -> bool {
        self.get(name) == Value::Missing
    }
}

/// What is wrong with values each of which is allowed.
#[derive(Debug, Clone, PartialEq)]
pub struct Wrong {
    /// The key at which it shows.
    pub key: &'static str,
    /// What follows its name and value in an error.
    pub why: String,
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
            Value::Missing => {}
        }
    }
    map.end()
}
