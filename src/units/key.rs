//! Keys of scenes. One declaration serves the reader, the schema, the pages of documentation, `init`, `--set` and the axes of sweeps.

use std::fmt;

use super::Dimension;

/// What a key takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A number in SI, or a text with a unit of this dimension.
    Quantity(Dimension),
    /// A whole number.
    Whole,
    /// One of some words.
    Word(&'static [&'static str]),
    /// `true` or `false`.
    Switch,
    /// One line of text.
    Text,
}

/// The numbers that a key takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Lower end, and whether it belongs to the range.
    pub from: (f64, bool),
    /// Upper end, and whether it belongs to the range.
    pub to: (f64, bool),
}

impl Range {
    /// All numbers.
    pub const ANY: Self = Self { from: (f64::NEG_INFINITY, false), to: (f64::INFINITY, false) };
    /// Above zero.
    pub const POSITIVE: Self = Self { from: (0.0, false), ..Self::ANY };
    /// Zero and above.
    pub const NOT_NEGATIVE: Self = Self { from: (0.0, true), ..Self::ANY };

    /// Whether a number is in the range.
    pub fn contains(&self, value: f64) -> bool {
        let Self { from, to } = *self;
        (value > from.0 || (from.1 && value == from.0)) && (value < to.0 || (to.1 && value == to.0))
    }
}

impl fmt::Display for Range {
    /// `(0, inf)`, `[0, 1)`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [open, close] = [if self.from.1 { '[' } else { '(' }, if self.to.1 { ']' } else { ')' }];
        write!(f, "{open}{}, {}{close}", self.from.0, self.to.0)
    }
}

/// A key of a table of scenes.
///
/// ```
/// use fretwear::units::{Dimension, Key, Range};
///
/// const PRESSURE: Key = Key::quantity("pressure", Dimension::PRESSURE, "Pressure p_0 below which nothing wears, Pa.")
///     .range(Range::POSITIVE)
///     .example("50 MPa");
/// assert!(PRESSURE.range.contains(5e7) && !PRESSURE.range.contains(0.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key {
    /// The key as it stands in its table.
    pub name: &'static str,
    /// What it takes.
    pub kind: Kind,
    /// The numbers that it takes, in SI.
    pub range: Range,
    /// What is taken where it is left out, as it would be written; none where the key must be given or has no value without it.
    pub default: Option<&'static str>,
    /// Whether the table must have it.
    pub required: bool,
    /// A value as a user would write it, without quotes.
    pub example: &'static str,
    /// One sentence: what it is, its symbol, its unit in SI.
    pub about: &'static str,
}

impl Key {
    /// A required key of any kind and range.
    pub const fn new(name: &'static str, kind: Kind, about: &'static str) -> Self {
        Self { name, kind, range: Range::ANY, default: None, required: true, example: "", about }
    }

    /// A required key that takes a quantity.
    pub const fn quantity(name: &'static str, dimension: Dimension, about: &'static str) -> Self {
        Self::new(name, Kind::Quantity(dimension), about)
    }

    /// A required key that takes a plain number.
    pub const fn number(name: &'static str, about: &'static str) -> Self {
        Self::quantity(name, Dimension::NUMBER, about)
    }

    /// The key with a range.
    pub const fn range(self, range: Range) -> Self {
        Self { range, ..self }
    }

    /// The key with an example.
    pub const fn example(self, example: &'static str) -> Self {
        Self { example, ..self }
    }

    /// The key, which may be left out and then has this value.
    pub const fn default(self, default: &'static str) -> Self {
        Self { default: Some(default), required: false, ..self }
    }

    /// The key, which may be left out.
    pub const fn optional(self) -> Self {
        Self { required: false, ..self }
    }
}
