//! Quantities with units, and keys: what a scene may say, declared once.

mod dimension;
mod key;
mod quantity;
mod table;
mod unit;

pub use dimension::Dimension;
pub(crate) use dimension::wanted;
pub use key::{Key, Kind, Range};
pub use quantity::parse;
pub(crate) use quantity::split_number;
pub use table::{Form, Rule, Table};
pub(crate) use unit::Unit;
