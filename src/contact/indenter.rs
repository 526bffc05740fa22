//! Rigid axisymmetric indenters: profile `f(r)` and its one-dimensional equivalent `g(x)`.

mod cubic;
mod equivalent;
mod smoothing;
mod sphere;
mod spline;
mod table;
mod table_equivalent;
mod table_rise;
mod table_transform;

use std::sync::Arc;

pub use equivalent::{EquivalentProfile, power_law_factor};
pub use smoothing::{SmoothedBy, Smoothing};
pub use table::TabulatedProfile;
pub(crate) use table_rise::RiseTransform;

use crate::error::{Error, Result};

/// Profile `f(r)` of a rigid indenter, `f(0) = 0`, increasing but for what a table may hold; every parameter positive and finite.
#[derive(Debug, Clone, PartialEq)]
pub enum Indenter {
    /// `f = r²/(2R)`.
    Paraboloid {
        /// Radius of curvature `R`, m.
        radius: f64,
    },
    /// `f = R - √(R² - r²)`.
    Sphere {
        /// Radius `R`, m.
        radius: f64,
    },
    /// `f = r tan θ`.
    Cone {
        /// Slope `tan θ` of the flank against the surface.
        slope: f64,
    },
    /// `f = A r^n`.
    PowerLaw {
        /// Coefficient `A`, m^(1-n).
        coefficient: f64,
        /// Exponent `n`.
        exponent: f64,
    },
    /// `f` by a measured profile.
    Table(Arc<TabulatedProfile>),
}

impl Indenter {
    /// Paraboloid of radius of curvature `R`, m.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names `indenter.paraboloid.radius`.
    pub fn paraboloid(radius: f64) -> Result<Self> {
        Self::Paraboloid { radius }.validated()
    }

    /// Sphere of radius `R`, m.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names `indenter.sphere.radius`.
    pub fn sphere(radius: f64) -> Result<Self> {
        Self::Sphere { radius }.validated()
    }

    /// Cone whose flank rises by `slope` metres per metre of radius.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names `indenter.cone.slope`.
    pub fn cone(slope: f64) -> Result<Self> {
        Self::Cone { slope }.validated()
    }

    /// Power law `f = A r^n` [S, Eq. (5)], `coefficient` in m^(1-n).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names `indenter.power-law.coefficient` or `indenter.power-law.exponent`.
    pub fn power_law(coefficient: f64, exponent: f64) -> Result<Self> {
        Self::PowerLaw { coefficient, exponent }.validated()
    }

    /// The indenter itself, if every parameter is positive and finite.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the parameter as in the scene.
    pub fn validated(self) -> Result<Self> {
        let parameters = match &self {
            &Self::Paraboloid { radius } => [("indenter.paraboloid.radius", radius), ("", 1.0)],
            &Self::Sphere { radius } => [("indenter.sphere.radius", radius), ("", 1.0)],
            &Self::Cone { slope } => [("indenter.cone.slope", slope), ("", 1.0)],
            &Self::PowerLaw { coefficient, exponent } => {
                [("indenter.power-law.coefficient", coefficient), ("indenter.power-law.exponent", exponent)]
            }
            Self::Table(_) => [("", 1.0), ("", 1.0)],
        };
        match parameters.into_iter().find(|(_, value)| !(*value > 0.0 && value.is_finite())) {
            Some((name, value)) => Err(Error::OutOfRange { name, value, range: "(0, inf)" }),
            None => Ok(self),
        }
    }

    /// Profile `f(r)`, m, at radius `r >= 0`, m; not a number beyond the equator of a sphere or the end of a table.
    ///
    /// # Examples
    /// ```
    /// use fretwear::contact::indenter::Indenter;
    ///
    /// assert_eq!(Indenter::paraboloid(0.5)?.profile(3.0), 9.0);
    /// assert_eq!(Indenter::sphere(5.0)?.profile(3.0), 1.0);
    /// # Ok::<(), fretwear::Error>(())
    /// ```
    pub fn profile(&self, r: f64) -> f64 {
        match *self {
            Self::Paraboloid { radius } => 0.5 * r * r / radius,
            Self::Sphere { radius } => r * r / (radius + ((radius - r) * (radius + r)).sqrt()),
            Self::Cone { slope } => slope * r,
            Self::PowerLaw { coefficient, exponent } => coefficient * r.powf(exponent),
            Self::Table(ref table) => table.profile(r),
        }
    }

    /// Slope `f'(r)`, at radius `r >= 0`, m; infinite at the tip of a power law with `n < 1`.
    pub fn profile_derivative(&self, r: f64) -> f64 {
        match *self {
            Self::Paraboloid { radius } => r / radius,
            Self::Sphere { radius } => r / ((radius - r) * (radius + r)).sqrt(),
            Self::Cone { slope } => slope,
            Self::PowerLaw { coefficient, exponent } => exponent * coefficient * r.powf(exponent - 1.0),
            Self::Table(ref table) => table.profile_derivative(r),
        }
    }

    /// Coefficient `A` and exponent `n` where the profile is a power law `A r^n`; none for the sphere and the table.
    pub fn as_power_law(&self) -> Option<(f64, f64)> {
        match *self {
            Self::Paraboloid { radius } => Some((0.5 / radius, 2.0)),
            Self::Sphere { .. } | Self::Table(_) => None,
            Self::Cone { slope } => Some((slope, 1.0)),
            Self::PowerLaw { coefficient, exponent } => Some((coefficient, exponent)),
        }
    }

    /// Radius, m, at which the profile has risen to `height`, m: the inverse of `f`. At most the radius of a sphere
    /// or the last one of a table, of which it is the smallest such radius.
    pub fn radius_at_height(&self, height: f64) -> f64 {
        match *self {
            Self::Sphere { radius } if height < radius => (height * (2.0 * radius - height)).sqrt(),
            Self::Sphere { radius } => radius,
            Self::Paraboloid { radius } => (2.0 * radius * height).sqrt(),
            Self::Cone { slope } => height / slope,
            Self::PowerLaw { coefficient, exponent } => (height / coefficient).powf(exponent.recip()),
            Self::Table(ref table) => table.radius_at_height(height),
        }
    }

    /// Equivalent one-dimensional profile `g(x)` on a half-space of grading `k` [S, Eq. (19)].
    ///
    /// ```text
    /// g(x) = x^(1-k) ∫_0^x f'(r) (x² - r²)^(-(1-k)/2) dr
    /// ```
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if a parameter of the indenter is not positive and finite, or the grading not in (-1, 1).
    pub fn equivalent_profile(&self, grading: f64) -> Result<EquivalentProfile> {
        EquivalentProfile::new(self, grading)
    }
}
