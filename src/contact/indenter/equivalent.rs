//! The equivalent one-dimensional profile `g(x)`, in forms in which nothing cancels.

use std::fmt::Debug;
use std::ops::Deref;
use std::sync::Arc;

use super::table_rise::RiseTransform;
use crate::error::{Error, Result};

/// Equivalent one-dimensional profile `g(x)` of an indenter on a half-space of grading `k`, prepared for many evaluations; its methods are those
/// of [`Equivalent`].
///
/// # Examples
/// ```
/// use fretwear::contact::indenter::Indenter;
///
/// // On a homogeneous half-space (k = 0) a paraboloid has g = x²/R and a sphere has g = x artanh(x/R).
/// let paraboloid = Indenter::paraboloid(2.0)?.equivalent_profile(0.0)?;
/// assert!((paraboloid.value(1.0) - 0.5).abs() < 1e-15);
/// let sphere = Indenter::sphere(2.0)?.equivalent_profile(0.0)?;
/// assert!((sphere.value(1.0) - 0.5f64.atanh()).abs() < 1e-15);
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct EquivalentProfile(pub(super) Arc<dyn Equivalent>);

/// What is asked of an equivalent profile.
///
/// Differences of `g` are formed from the difference of the squared arguments, which Eq. (19) makes the natural variable; they keep
/// their full relative accuracy however close the two arguments are.
pub trait Equivalent: Debug + Send + Sync {
    /// Grading `k`.
    fn grading(&self) -> f64;

    /// Exponent `n` where `g` is a power law, as `f` then is.
    fn exponent(&self) -> Option<f64> {
        None
    }

    /// Largest argument, m, up to which `g` has full accuracy: infinite for power laws; for a table the last radius up to which `g` rises.
    fn largest_radius(&self) -> f64;

    /// Radius, m, at which `g` is singular.
    fn singular_radius(&self) -> Option<f64> {
        None
    }

    /// Why a contact ends at [`Equivalent::largest_radius`], and the cure, where `g` is that of a table.
    fn end_of_table(&self) -> Option<String> {
        None
    }

    /// The transform of the rise over the value at a radius, m, where `g` is that of a table.
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if it cannot be computed with.
    fn rise_transform(&self, _radius: f64) -> Result<Option<Arc<RiseTransform>>> {
        Ok(None)
    }

    /// Radius, m, of the flat in the middle: zero but for some tables.
    fn flat_radius(&self) -> f64 {
        0.0
    }

    /// `g(x)`, m, at `x >= 0`, m.
    fn value(&self, x: f64) -> f64;

    /// Slope `g'(x)`, at `x >= 0`, m.
    fn derivative(&self, x: f64) -> f64;

    /// `g(√(start² + offset)) - g(start)`, m, to full relative accuracy also for `abs(offset) << start²`.
    ///
    /// # Arguments
    /// * `start` -- m, `start >= 0`
    /// * `offset` -- m², of either sign, `offset >= -start²`
    fn rise(&self, start: f64, offset: f64) -> f64;

    /// Contact radius, m, at which `g` has risen to `depth >= 0`, m: the inverse of `g`.
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if a sphere would have to sink in to its equator, a table ends before that depth, or its contact would split
    /// into rings.
    fn radius_at(&self, depth: f64) -> Result<f64>;

    /// `a² - c² >= 0`, m², of the radius `c` at which `g` is lower than at `a = radius` by `depth_drop`.
    ///
    /// Relative accuracy for every `depth_drop` up to about half of `g(a)`; above that `c` itself is better from
    /// [`Equivalent::radius_at`].
    ///
    /// # Arguments
    /// * `radius` -- `a`, m, positive
    /// * `depth_drop` -- m, from 0 to `g(a)`
    fn radius_squared_drop(&self, radius: f64, depth_drop: f64) -> f64;

    /// Normal force per normal stiffness [S, Eq. (22)] at the contact radius `a = radius`, m^(2+k); for a table at most that of the largest
    /// radius.
    ///
    /// ```text
    /// F_N/c_N = 2 ∫_0^a x^k (g(a) - g(x)) dx
    /// ```
    ///
    /// # Examples
    /// ```
    /// use fretwear::contact::indenter::Indenter;
    ///
    /// // Hertz: F = (4/3) E* √R d^(3/2) with c_N = E*, here R = 4 and d = 1, a = 2
    /// let profile = Indenter::paraboloid(4.0)?.equivalent_profile(0.0)?;
    /// assert!((profile.load_integral(2.0) - 8.0 / 3.0).abs() < 1e-14);
    /// # Ok::<(), fretwear::Error>(())
    /// ```
    fn load_integral(&self, radius: f64) -> f64;

    /// Indentation `d`, m, under a positive normal force per normal stiffness, m^(2+k); see [`EquivalentProfile::depth_for_load`].
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if it is more than a sphere carries before it sinks in to its equator, or a table before it ends.
    fn depth_for_load(&self, load: f64) -> Result<f64>;

    /// The number of a point `x0 = radius`, m, from which [`Equivalent::rise_from`] goes.
    fn origin(&self, radius: f64) -> f64;

    /// `g(x0 e^l) - g(x0)`, m, to full relative accuracy.
    fn rise_from(&self, origin: f64, logarithm: f64) -> f64;

    /// `x g'(x)`, m, at `x = x0 e^l`.
    fn logarithmic_slope_from(&self, origin: f64, logarithm: f64) -> f64;
}

impl Deref for EquivalentProfile {
    type Target = dyn Equivalent;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

impl EquivalentProfile {
    /// Indentation `d`, m, under the normal force per normal stiffness `load = F_N/c_N`, m^(2+k): inverts [S, Eq. (22)].
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the load is not positive and finite; else as [`Equivalent::depth_for_load`].
    pub fn depth_for_load(&self, load: f64) -> Result<f64> {
        if !(load > 0.0 && load.is_finite()) {
            return Err(Error::OutOfRange {
                name: "normal force per stiffness",
                value: load,
                range: "(0, inf)",
            });
        }
        self.0.depth_for_load(load)
    }

    /// Differences of `g` against its value at `radius`.
    pub(crate) fn at(&self, radius: f64) -> Origin<'_> {
        Origin { profile: &*self.0, origin: self.0.origin(radius) }
    }
}

/// A point `x0` of an equivalent profile; its neighbours are named by the logarithm `l` of `x/x0`.
pub(crate) struct Origin<'a> {
    profile: &'a dyn Equivalent,
    origin: f64,
}

impl Origin<'_> {
    /// `g(x0 e^l) - g(x0)`, m, to full relative accuracy.
    pub(crate) fn rise(&self, logarithm: f64) -> f64 {
        self.profile.rise_from(self.origin, logarithm)
    }

    /// `x g'(x)`, m, at `x = x0 e^l`.
    pub(crate) fn logarithmic_slope(&self, logarithm: f64) -> f64 {
        self.profile.logarithmic_slope_from(self.origin, logarithm)
    }
}
