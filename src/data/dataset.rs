//! Labelled arrays in memory, in the sense of xarray: variables over named dimensions, with attributes, in groups.
//!
//! Everything that this program stores is one, of any [`Format`]: files, tables and figures are made from it.

use std::any::type_name;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::Format;
use crate::error::{Error, Result};

/// What cures a file that cannot be used.
pub(super) const WRITE_AGAIN: &str =
    "the file is damaged or was edited, write it again with the command that wrote it";

/// Name, units (in the spelling of UDUNITS) and meaning of a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Quantity<'a> {
    /// Name of the variable in files, and key in JSON.
    pub name: &'a str,
    /// Attribute `units`; "1" for a pure number or a word.
    pub units: &'a str,
    /// Attribute `long_name`.
    pub long_name: &'a str,
}

/// A quantity.
pub const fn quantity<'a>(name: &'a str, units: &'a str, long_name: &'a str) -> Quantity<'a> {
    Quantity { name, units, long_name }
}

/// Variables over dimensions, and what is said of all of them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Dataset {
    /// What is said of all variables, by name.
    pub attributes: Vec<(String, Attribute)>,
    /// The variables; those named as their only dimension are coordinates, and come before whatever runs along them.
    pub variables: Vec<Variable>,
    /// Datasets within this one, by name, whose variables may run along its dimensions.
    pub groups: Vec<(String, Dataset)>,
    /// The file that it was read from, and the group in it.
    pub(super) origin: (PathBuf, String),
    /// What in the file cannot be used, and why; a variable among them has no values.
    pub(super) unusable: Vec<(String, String)>,
}

/// One quantity along some dimensions.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Name.
    pub name: String,
    /// Units; "1" for a pure number or a word.
    pub units: String,
    /// Meaning.
    pub long_name: String,
    /// Names of its dimensions, slowest first; none for a scalar.
    pub dimensions: Vec<String>,
    /// Lengths along them.
    pub shape: Vec<usize>,
    /// Whether it is a coordinate that may grow.
    pub unlimited: bool,
    /// What else is said of it, by name.
    pub attributes: Vec<(String, Attribute)>,
    /// Values, the last dimension fastest.
    pub values: Values,
}

/// What is said of a dataset or a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Attribute {
    /// Words.
    Text(String),
    /// A whole number.
    Integer(i32),
    /// A number of things.
    Count(u64),
    /// A number.
    Real(f64),
    /// Whole numbers.
    Integers(Vec<i32>),
}

/// Values of a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Numbers; not a number where the quantity has no meaning.
    Numbers(Vec<f64>),
    /// Indices.
    Indices(Vec<i64>),
    /// Numbers of things.
    Counts(Vec<u64>),
    /// Numbers that stand for words.
    Flags(Vec<i32>),
    /// Words.
    Texts(Words),
    /// In a file, of a type that this program does not write; they are not read.
    Foreign,
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

impl<'a> FromIterator<&'a str> for Words {
    fn from_iter<I: IntoIterator<Item = &'a str>>(words: I) -> Self {
        let mut found = Self::default();
        words.into_iter().for_each(|word| found.push(word));
        found
    }
}

/// A number of one of the types that are stored.
pub trait Number: Sized {
    /// Values of it.
    fn values(numbers: Vec<Self>) -> Values;
    /// The numbers, if they are of this type.
    fn numbers(values: Values) -> Option<Vec<Self>>;
}

impl Number for f64 {
    fn values(numbers: Vec<Self>) -> Values {
        Values::Numbers(numbers)
    }
    fn numbers(values: Values) -> Option<Vec<Self>> {
        if let Values::Numbers(found) = values { Some(found) } else { None }
    }
}

impl Number for i64 {
    fn values(numbers: Vec<Self>) -> Values {
        Values::Indices(numbers)
    }
    fn numbers(values: Values) -> Option<Vec<Self>> {
        if let Values::Indices(found) = values { Some(found) } else { None }
    }
}

impl Number for u64 {
    fn values(numbers: Vec<Self>) -> Values {
        Values::Counts(numbers)
    }
    fn numbers(values: Values) -> Option<Vec<Self>> {
        if let Values::Counts(found) = values { Some(found) } else { None }
    }
}

impl Number for i32 {
    fn values(numbers: Vec<Self>) -> Values {
        Values::Flags(numbers)
    }
    fn numbers(values: Values) -> Option<Vec<Self>> {
        if let Values::Flags(found) = values { Some(found) } else { None }
    }
}

impl<T: Number> From<Vec<T>> for Values {
    fn from(numbers: Vec<T>) -> Self {
        T::values(numbers)
    }
}

impl From<Words> for Values {
    fn from(words: Words) -> Self {
        Self::Texts(words)
    }
}

impl Values {
    /// Number of values that are known.
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(values) => values.len(),
            Self::Indices(values) => values.len(),
            Self::Counts(values) => values.len(),
            Self::Flags(values) => values.len(),
            Self::Texts(values) => values.len(),
            Self::Foreign => 0,
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// None of the same kind, words or numbers.
    pub fn emptied(&self) -> Self {
        match self {
            Self::Numbers(_) => Self::Numbers(vec![]),
            Self::Texts(_) => Self::Texts(Words::default()),
            _ => Self::Foreign,
        }
    }

    /// Adds one of other values; false if they are not words or numbers both.
    ///
    /// # Panics
    /// If there are not so many.
    pub fn push_from(&mut self, other: &Self, at: usize) -> bool {
        match (self, other) {
            (Self::Numbers(to), Self::Numbers(from)) => to.push(from[at]),
            (Self::Texts(to), Self::Texts(from)) => to.push(from.get(at)),
            _ => return false,
        }
        true
    }

    /// Whether two values are the same to the bit.
    pub fn same(&self, at: usize, other: &Self, other_at: usize) -> bool {
        match (self, other) {
            (Self::Numbers(one), Self::Numbers(two)) => one[at].to_bits() == two[other_at].to_bits(),
            (Self::Texts(one), Self::Texts(two)) => one.get(at) == two.get(other_at),
            _ => false,
        }
    }
}

impl Variable {
    /// A variable over dimensions, each with its length.
    ///
    /// # Panics
    /// If the number of values is not the product of the lengths.
    pub fn new(quantity: Quantity, dimensions: &[(&str, usize)], values: impl Into<Values>) -> Self {
        let (name, values) = (quantity.name, values.into());
        let (dimensions, shape): (Vec<_>, Vec<_>) =
            dimensions.iter().map(|(name, length)| ((*name).to_owned(), *length)).unzip();
        assert_eq!(values.len(), shape.iter().product::<usize>(), "values of {name}");
        Self {
            name: name.to_owned(),
            units: quantity.units.to_owned(),
            long_name: quantity.long_name.to_owned(),
            dimensions,
            shape,
            unlimited: false,
            attributes: vec![],
            values,
        }
    }

    /// The variable with one more attribute.
    pub fn with(mut self, name: &str, attribute: Attribute) -> Self {
        self.attributes.push((name.to_owned(), attribute));
        self
    }

    /// The variable with the names of the coordinates that tell where its values are.
    pub fn with_coordinates(self, coordinates: &str) -> Self {
        self.with("coordinates", text(coordinates))
    }

    /// Whether it tells the places along a dimension.
    pub fn is_coordinate(&self) -> bool {
        matches!(&self.dimensions[..], [only] if *only == self.name)
    }

    /// Whether its values are real numbers.
    pub fn is_numeric(&self) -> bool {
        matches!(self.values, Values::Numbers(_))
    }

    /// The words of an attribute, where it has it.
    pub fn text(&self, name: &str) -> Option<&str> {
        find_text(&self.attributes, name)
    }
}

/// An attribute of words.
pub fn text(words: impl Into<String>) -> Attribute {
    Attribute::Text(words.into())
}

fn find_text<'a>(attributes: &'a [(String, Attribute)], name: &str) -> Option<&'a str> {
    attributes.iter().find_map(|(other, attribute)| match attribute {
        Attribute::Text(text) if other == name => Some(text.as_str()),
        _ => None,
    })
}

impl Dataset {
    /// What a study writes, without variables so far.
    ///
    /// # Arguments
    /// * `format` -- what it is of
    /// * `attributes` -- what is said of it besides format and versions
    pub fn of(format: Format, attributes: &[(&str, String)]) -> Self {
        let mut new = Self::default();
        new.say("format", text(format.name()));
        new.say("format_version", Attribute::Integer(format.version()));
        new.say("program_version", text(env!("CARGO_PKG_VERSION")));
        attributes.iter().for_each(|(name, words)| new.say(name, text(words)));
        new.say("complete", Attribute::Integer(1));
        new
    }

    /// Adds an attribute.
    pub fn say(&mut self, name: &str, attribute: Attribute) {
        self.attributes.push((name.to_owned(), attribute));
    }

    /// Adds a coordinate.
    pub fn coordinate(&mut self, quantity: Quantity, values: impl Into<Values>) {
        let values = values.into();
        self.add(Variable::new(quantity, &[(quantity.name, values.len())], values));
    }

    /// Adds the coordinate `0, 1, …`.
    pub fn index(&mut self, quantity: Quantity, length: usize) {
        self.coordinate(quantity, (0..).take(length).collect::<Vec<i64>>());
    }

    /// Adds a variable.
    pub fn add(&mut self, variable: Variable) {
        self.variables.push(variable);
    }

    /// Adds a number without dimensions.
    pub fn scalar<T: Number>(&mut self, quantity: Quantity, number: T) {
        self.add(Variable::new(quantity, &[], vec![number]));
    }

    /// The words of an attribute, where it has it.
    pub fn text(&self, name: &str) -> Option<&str> {
        find_text(&self.attributes, name)
    }

    /// The title; empty where there is none.
    pub fn title(&self) -> &str {
        self.text("title").unwrap_or_default()
    }

    /// Version of the program that wrote the file.
    pub fn program_version(&self) -> &str {
        self.text("program_version").unwrap_or_default()
    }

    /// Whether there is a variable of a name.
    pub fn has(&self, name: &str) -> bool {
        self.variables.iter().any(|it| it.name == name) || self.is_unusable(name)
    }

    fn is_unusable(&self, name: &str) -> bool {
        self.unusable.iter().any(|it| it.0 == name)
    }

    /// A variable.
    ///
    /// # Errors
    /// [`Error::File`] if there is none of that name, or it cannot be used.
    pub fn variable(&self, name: &str) -> Result<&Variable> {
        let found = self.variables.iter().find(|it| it.name == name).filter(|_| !self.is_unusable(name));
        found.ok_or_else(|| self.lack(name))
    }

    /// Numbers over dimensions that have lengths.
    ///
    /// # Errors
    /// [`Error::File`] if there are none of that name and shape.
    pub fn numbers(&self, name: &str, shape: &[usize]) -> Result<&[f64]> {
        let variable = self.variable(name)?;
        match &variable.values {
            Values::Numbers(values) if variable.shape == shape => Ok(values),
            Values::Numbers(_) => Err(self.damaged(name, &misshapen(&variable.shape, shape))),
            _ => Err(self.damaged(name, &"does not hold numbers")),
        }
    }

    /// Numbers along a dimension of any length.
    ///
    /// # Errors
    /// [`Error::File`] if there is no such variable, or it has more than one dimension.
    pub fn along(&self, name: &str) -> Result<&[f64]> {
        self.numbers(name, &[self.variable(name)?.values.len()])
    }

    /// Words along a dimension of a length.
    ///
    /// # Errors
    /// [`Error::File`] if there are none of that name and number.
    pub fn words(&self, name: &str, length: usize) -> Result<&Words> {
        match &self.variable(name)?.values {
            Values::Texts(words) if words.len() == length => Ok(words),
            _ => Err(self.damaged(name, &format!("does not hold {length} words"))),
        }
    }

    /// Takes the numbers of a variable out; `None` in the shape stands for any length.
    ///
    /// # Errors
    /// [`Error::File`] if there are none of that name, type and shape.
    pub fn take<T: Number>(&mut self, quantity: Quantity, shape: &[Option<usize>]) -> Result<Vec<T>> {
        let name = quantity.name;
        let place = self.variables.iter().position(|it| it.name == name).ok_or_else(|| self.lack(name))?;
        let Variable { shape: found, values, .. } = self.variables.swap_remove(place);
        let numbers = T::numbers(values).ok_or_else(|| {
            self.damaged(name, &format!("does not hold values of type {}", type_name::<T>()))
        })?;
        let fits = found.len() == shape.len()
            && found.iter().zip(shape).all(|(length, expected)| expected.is_none_or(|it| it == *length));
        if !fits {
            let shape: Vec<String> =
                shape.iter().map(|length| length.map_or("any".into(), |it| it.to_string())).collect();
            let why = format!("has the shape {found:?}, expected [{}]", shape.join(", "));
            return Err(self.damaged(name, &why));
        }
        if self.is_unusable(name) { Err(self.lack(name)) } else { Ok(numbers) }
    }

    /// Takes a number without dimensions out.
    ///
    /// # Errors
    /// As [`Dataset::take`].
    pub fn take_scalar<T: Number + Copy>(&mut self, quantity: Quantity) -> Result<T> {
        Ok(self.take(quantity, &[])?[0])
    }

    /// Takes a group out; none if there is none of that name.
    ///
    /// # Errors
    /// [`Error::File`] if a variable has its name.
    pub fn take_group(&mut self, name: &str) -> Result<Option<Self>> {
        if self.has(name) {
            return Err(self.damaged(name, &"is not a group"));
        }
        let place = self.groups.iter().position(|(other, _)| other == name);
        Ok(place.map(|place| self.groups.swap_remove(place).1))
    }

    fn lack(&self, name: &str) -> Error {
        match self.unusable.iter().find(|(other, _)| other == name) {
            Some((_, why)) => self.damaged(name, why),
            None => self.error(format!("dataset {}/{name} is missing; {WRITE_AGAIN}", self.origin.1)),
        }
    }

    /// The error of a variable that cannot be used.
    pub fn damaged(&self, name: &str, why: &dyn std::fmt::Display) -> Error {
        damaged(&self.origin.0, &format!("{}/{name}", self.origin.1), why)
    }

    fn error(&self, why: String) -> Error {
        Error::File { path: self.origin.0.clone(), why }
    }
}

fn misshapen(found: &[usize], expected: &[usize]) -> String {
    format!("has the shape {found:?}, expected {expected:?}")
}

/// The error of something in a file that cannot be used.
pub(super) fn damaged(path: &Path, what: &str, why: &dyn std::fmt::Display) -> Error {
    Error::File { path: path.to_owned(), why: format!("{what}: {why}; {WRITE_AGAIN}") }
}
