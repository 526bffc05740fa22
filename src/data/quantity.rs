//! Results declared once: what a quantity is called and means, and how it is read off a record. Columns of files and tables, keys of JSON and lines for
//! people are made from it.

use serde::{Serialize, Serializer};

use super::cells::{cell, quoted, table};
pub use super::dataset::{Quantity, quantity};
use super::dataset::{Values, Variable, Words};

/// What is read off a record.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number; not a number where the quantity has no meaning.
    Number(f64),
    /// A number of things.
    Count(u64),
    /// Whether something holds.
    Truth(bool),
    /// A word.
    Word(String),
    /// Nothing, where the quantity has no meaning.
    Missing,
}

impl From<f64> for Value {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<u64> for Value {
    fn from(value: u64) -> Self {
        Self::Count(value)
    }
}

impl From<usize> for Value {
    fn from(value: usize) -> Self {
        Self::Count(value as u64)
    }
}

impl From<bool> for Value {
    fn from(value: bool) -> Self {
        Self::Truth(value)
    }
}

impl From<&str> for Value {
    fn from(value: &str) -> Self {
        Self::Word(value.into())
    }
}

impl<T: Into<Value>> From<Option<T>> for Value {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Missing, Into::into)
    }
}

impl Serialize for Value {
    /// A number that is not finite is null.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Number(value) => serializer.serialize_f64(*value),
            Self::Count(value) => serializer.serialize_u64(*value),
            Self::Truth(value) => serializer.serialize_bool(*value),
            Self::Word(value) => serializer.serialize_str(value),
            Self::Missing => serializer.serialize_none(),
        }
    }
}

impl Value {
    /// As a number: 1 where something holds, 0 where it does not; not a number for words and where there is none.
    pub fn number(&self) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::Count(value) => *value as f64,
            Self::Truth(holds) => f64::from(u8::from(*holds)),
            Self::Word(_) | Self::Missing => f64::NAN,
        }
    }

    /// Many of them, as words or as numbers.
    pub fn all(values: impl Iterator<Item = Self>, are_words: bool) -> Values {
        match are_words {
            true => {
                let mut words = Words::default();
                values.for_each(|value| words.push(value.word()));
                Values::Texts(words)
            }
            false => Values::Numbers(values.map(|value| value.number()).collect()),
        }
    }

    /// As a word: empty for numbers and where there is none.
    pub fn word(&self) -> &str {
        if let Self::Word(word) = self { word } else { "" }
    }
}

/// A quantity and how it is read off a record.
#[derive(Debug, Clone, Copy)]
pub struct Reading<R> {
    /// What is read off.
    pub quantity: Quantity<'static>,
    /// Name in lines for people, with the symbol where it has one.
    pub heading: &'static str,
    /// Whether it is a word.
    pub is_word: bool,
    /// Its value for a record.
    pub of: fn(&R) -> Value,
}

/// A number that is read off records.
pub const fn number<R>(
    name: &'static str,
    units: &'static str,
    long_name: &'static str,
    of: fn(&R) -> Value,
) -> Reading<R> {
    Reading { quantity: quantity(name, units, long_name), heading: name, is_word: false, of }
}

/// A word that is read off records.
pub const fn word<R>(name: &'static str, long_name: &'static str, of: fn(&R) -> Value) -> Reading<R> {
    Reading { quantity: quantity(name, "1", long_name), heading: name, is_word: true, of }
}

impl<R> Reading<R> {
    /// The same with a name in lines for people.
    pub const fn headed(self, heading: &'static str) -> Self {
        Self { heading, ..self }
    }

    /// Its name and its value for a record.
    pub fn entry(&self, record: &R) -> (&'static str, Value) {
        (self.quantity.name, (self.of)(record))
    }

    /// The variable along a dimension of which each place is a record.
    pub fn variable(&self, dimension: &str, records: &[R]) -> Variable {
        let values = Value::all(records.iter().map(self.of), self.is_word);
        Variable::new(self.quantity, &[(dimension, records.len())], values)
    }
}

/// Readings of records as a CSV table with a line for each record.
pub fn csv<R>(readings: &[Reading<R>], records: &[R]) -> String {
    let line = |record: &R| {
        let cell = |it: &Reading<R>| match (it.of)(record) {
            Value::Word(word) => quoted(&word),
            value => cell(value.number()),
        };
        readings.iter().map(cell).collect()
    };
    table(readings.iter().map(|it| it.quantity.name), records.iter().map(line))
}

/// Names and what belongs to them, for JSON: one object, the keys in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct Entries<T = Value>(Vec<(&'static str, T)>);

impl<T> FromIterator<(&'static str, T)> for Entries<T> {
    fn from_iter<I: IntoIterator<Item = (&'static str, T)>>(entries: I) -> Self {
        Self(entries.into_iter().collect())
    }
}

impl Entries {
    /// All readings of a record.
    pub fn new<R>(readings: &[Reading<R>], record: &R) -> Self {
        readings.iter().map(|it| it.entry(record)).collect()
    }

    /// All readings of a record that may not be there; nothing is read off then.
    pub fn of<R>(readings: &[Reading<R>], record: Option<&R>) -> Self {
        readings.iter().map(|it| (it.quantity.name, record.map_or(Value::Missing, it.of))).collect()
    }

    /// The value of a name.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.0.iter().find(|(other, _)| *other == name).map(|(_, value)| value)
    }

    /// Some of the readings of a record, see [`named`].
    ///
    /// # Panics
    /// If there is none of a name.
    pub fn some<R>(readings: &[Reading<R>], record: &R, names: &str) -> Self {
        named(readings, names).map(|it| it.entry(record)).collect()
    }
}

/// Some of the readings, in the order of their names, which blanks separate.
///
/// # Panics
/// If there is none of a name.
pub fn named<'a, R: 'a>(
    readings: impl IntoIterator<Item = &'a Reading<R>, IntoIter: Clone>,
    names: &str,
) -> impl Iterator<Item = &'a Reading<R>> {
    let readings = readings.into_iter();
    names.split_whitespace().map(move |name| {
        let found = readings.clone().find(|it| it.quantity.name == name);
        found.unwrap_or_else(|| panic!("{name} is not declared"))
    })
}

impl<T: Serialize> Serialize for Entries<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}
