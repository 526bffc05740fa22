//! What the program asks of a shape of the indenter.

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use super::equivalent::Equivalent;
use crate::error::{Error, Result};
use crate::laws::entry::Entry;

/// Profile `f(r)` of a rigid indenter, `f(0) = 0`, increasing but for what a table may hold; every number positive and finite.
pub trait Shape: Any + Debug + Send + Sync {
    /// Its entry in the table of shapes.
    fn entry(&self) -> &'static Entry<dyn Shape>;

    /// The numbers that tell it from others of its kind.
    fn numbers(&self) -> Vec<f64>;

    /// The shape and its numbers, as reports say it.
    fn words(&self) -> String;

    /// Profile `f(r)`, m, at radius `r >= 0`, m; not a number beyond the equator of a sphere or the end of a table.
    fn profile(&self, r: f64) -> f64;

    /// Slope `f'(r)`, at radius `r >= 0`, m; infinite at the tip of a power law with `n < 1`.
    fn profile_derivative(&self, r: f64) -> f64;

    /// Radius, m, at which the profile has risen to `height`, m: the inverse of `f`. At most the radius of a sphere
    /// or the last one of a table, of which it is the smallest such radius.
    fn radius_at_height(&self, height: f64) -> f64;

    /// Equivalent profile on a half-space of a grading in (-1, 1).
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if it cannot be computed with.
    fn equivalent(&self, grading: f64) -> Result<Arc<dyn Equivalent>>;

    /// Coefficient `A` and exponent `n` where the profile is a power law `A r^n`.
    fn as_power_law(&self) -> Option<(f64, f64)> {
        None
    }

    /// Rows that it was measured at, column by column.
    fn rows(&self) -> Vec<&[f64]> {
        vec![]
    }
}

/// A number, if it is positive and finite.
///
/// # Errors
/// [`Error::OutOfRange`] names it as in the scene.
pub(super) fn positive(name: &'static str, value: f64) -> Result<f64> {
    match value > 0.0 && value.is_finite() {
        true => Ok(value),
        false => Err(Error::OutOfRange { name, value, range: "(0, inf)" }),
    }
}
