//! The numbers that a key takes.

use std::fmt;

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
    pub const POSITIVE: Self = Self::above(0.0);
    /// Zero and above.
    pub const NOT_NEGATIVE: Self = Self::at_least(0.0);

    /// All numbers above this one.
    pub const fn above(least: f64) -> Self {
        Self { from: (least, false), ..Self::ANY }
    }

    /// This number and all above it.
    pub const fn at_least(least: f64) -> Self {
        Self { from: (least, true), ..Self::ANY }
    }

    /// The range up to this number, which belongs to it.
    pub const fn to(self, most: f64) -> Self {
        Self { to: (most, true), ..self }
    }

    /// The range below this number.
    pub const fn below(self, most: f64) -> Self {
        Self { to: (most, false), ..self }
    }

    /// Whether a number is in the range.
    pub fn contains(&self, value: f64) -> bool {
        let Self { from, to } = *self;
        (value > from.0 || (from.1 && value == from.0)) && (value < to.0 || (to.1 && value == to.0))
    }
}

impl fmt::Display for Range {
    /// `(0, inf)`, `[0, 1)`, `[1e-10, 0.1]`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [open, close] = [if self.from.1 { '[' } else { '(' }, if self.to.1 { ']' } else { ')' }];
        let [from, to] = [self.from.0, self.to.0].map(short);
        write!(f, "{open}{from}, {to}{close}")
    }
}

/// A number as one would write it: 0.1, 100000, 1e-10.
fn short(number: f64) -> String {
    match number != 0.0 && number.is_finite() && !(1e-3..1e6).contains(&number.abs()) {
        true => format!("{number:e}"),
        false => number.to_string(),
    }
}
