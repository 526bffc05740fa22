//! Quantities with units, and keys: what a scene may say, declared once.

mod dimension;
mod key;
mod quantity;
mod range;
mod shown;
mod unit;

pub use dimension::Dimension;
pub(crate) use dimension::wanted;
pub use key::{Form, Key, Kind, Rule, Table};
pub use quantity::parse;
pub(crate) use quantity::split_number;
pub use range::Range;
pub(crate) use shown::{Scale, number, unit_in_words};
pub(crate) use unit::Unit;
