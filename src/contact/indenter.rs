//! Rigid axisymmetric indenters, a file each: keys, profile `f(r)`, its one-dimensional equivalent `g(x)` and words of one shape. A new one is a
//! file and its line in [`ENTRIES`].

pub mod cone;
mod cubic;
mod equivalent;
pub mod paraboloid;
pub mod power_law;
mod rise_kernel;
mod shape;
mod smoothing;
pub mod sphere;
mod sphere_integral;
mod spline;
pub mod table;
mod table_equivalent;
mod table_profile;
mod table_rise;
mod table_transform;

use std::ops::Deref;
use std::sync::Arc;

pub(crate) use cubic::Cubic;
pub use equivalent::{Equivalent, EquivalentProfile};
pub use power_law::power_law_factor;
pub use shape::Shape;
pub use smoothing::{SmoothedBy, Smoothing};
pub use table_profile::TabulatedProfile;
pub use table_rise::RiseTransform;

use crate::error::{Error, Result};
use crate::laws::entry::Entry;

/// All shapes.
pub static ENTRIES: &[&Entry<dyn Shape>] =
    &[&paraboloid::ENTRY, &sphere::ENTRY, &cone::ENTRY, &power_law::ENTRY, &table::ENTRY];

/// A rigid indenter of any [`Shape`], whose methods it has.
///
/// # Examples
/// ```
/// use fretwear::contact::indenter::Indenter;
///
/// assert_eq!(Indenter::paraboloid(0.5)?.profile(3.0), 9.0);
/// assert_eq!(Indenter::sphere(5.0)?.profile(3.0), 1.0);
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Indenter(Arc<dyn Shape>);

impl Indenter {
    /// Equivalent one-dimensional profile `g(x)` on a half-space of grading `k` [S, Eq. (19)].
    ///
    /// ```text
    /// g(x) = x^(1-k) ∫_0^x f'(r) (x² - r²)^(-(1-k)/2) dr
    /// ```
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the grading is not in (-1, 1).
    pub fn equivalent_profile(&self, grading: f64) -> Result<EquivalentProfile> {
        if !(grading > -1.0 && grading < 1.0) {
            return Err(Error::OutOfRange { name: "half_space.grading", value: grading, range: "(-1, 1)" });
        }
        self.equivalent(grading).map(EquivalentProfile)
    }
}

impl<S: Shape> From<Arc<S>> for Indenter {
    fn from(shape: Arc<S>) -> Self {
        Self(shape)
    }
}

impl From<Arc<dyn Shape>> for Indenter {
    fn from(shape: Arc<dyn Shape>) -> Self {
        Self(shape)
    }
}

impl Deref for Indenter {
    type Target = dyn Shape;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

impl PartialEq for Indenter {
    fn eq(&self, other: &Self) -> bool {
        let [one, other] = [self, other].map(|it| (it.entry().name, it.numbers(), it.rows()));
        one == other
    }
}
