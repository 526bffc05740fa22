//! The equivalent one-dimensional profile `g(x)`, in forms in which nothing cancels.

use std::sync::Arc;

use super::Indenter;
use super::sphere::SphereIntegral;
use super::table_equivalent::TabulatedEquivalent;
use super::table_rise::RiseTransform;
use crate::error::{Error, Result};
use crate::numerics::roots;

/// Equivalent one-dimensional profile `g(x)` of an indenter on a half-space of grading `k`, prepared for many evaluations.
///
/// Differences of `g` are formed from the difference of the squared arguments, which Eq. (19) makes the natural variable; they keep
/// their full relative accuracy however close the two arguments are.
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
pub struct EquivalentProfile {
    grading: f64,
    shape: Shape,
}

#[derive(Debug, Clone)]
enum Shape {
    /// `g = coefficient x^exponent`.
    PowerLaw { coefficient: f64, exponent: f64 },
    /// `g = R/(1+k) h(x²/R²)`.
    Sphere { radius: f64, integral: Box<SphereIntegral> },
    /// Cubics.
    Table(Arc<TabulatedEquivalent>),
}

impl EquivalentProfile {
    /// See [`Indenter::equivalent_profile`].
    pub(super) fn new(indenter: &Indenter, grading: f64) -> Result<Self> {
        if !(grading > -1.0 && grading < 1.0) {
            return Err(Error::OutOfRange { name: "half_space.grading", value: grading, range: "(-1, 1)" });
        }
        let shape = match (indenter.clone().validated()?.as_power_law(), indenter) {
            (Some((coefficient, exponent)), _) => {
                Shape::PowerLaw { coefficient: coefficient * power_law_factor(exponent, grading), exponent }
            }
            (None, &Indenter::Sphere { radius }) => {
                Shape::Sphere { radius, integral: Box::new(SphereIntegral::new(grading)?) }
            }
            (None, Indenter::Table(table)) => Shape::Table(table.equivalent(grading)?),
            (None, _) => unreachable!("every other indenter is a power law"),
        };
        Ok(Self { grading, shape })
    }

    /// Grading `k`.
    pub fn grading(&self) -> f64 {
        self.grading
    }

    /// Exponent `n` where `g` is a power law, as `f` then is; none for the sphere and the table.
    pub fn exponent(&self) -> Option<f64> {
        match self.shape {
            Shape::PowerLaw { exponent, .. } => Some(exponent),
            Shape::Sphere { .. } | Shape::Table(_) => None,
        }
    }

    /// Largest argument, m, up to which `g` has full accuracy: infinite for power laws, 0.999 of the radius of a sphere, at whose
    /// equator the flank is vertical; for a table the last radius up to which `g` rises.
    pub fn largest_radius(&self) -> f64 {
        match &self.shape {
            Shape::PowerLaw { .. } => f64::INFINITY,
            Shape::Sphere { radius, .. } => radius * SphereIntegral::LARGEST_ARGUMENT.sqrt(),
            Shape::Table(table) => table.largest_radius(),
        }
    }

    /// Radius, m, at which `g` is singular: that of a sphere.
    pub(crate) fn singular_radius(&self) -> Option<f64> {
        match self.shape {
            Shape::Sphere { radius, .. } => Some(radius),
            Shape::PowerLaw { .. } | Shape::Table(_) => None,
        }
    }

    /// Why a contact ends at [`EquivalentProfile::largest_radius`], and the cure, where `g` is that of a table.
    pub(crate) fn end_of_table(&self) -> Option<String> {
        match &self.shape {
            Shape::Table(table) => Some(table.end()),
            _ => None,
        }
    }

    /// The transform of the rise over the value at a radius, m, where `g` is that of a table.
    pub(crate) fn rise_transform(&self, radius: f64) -> Result<Option<Arc<RiseTransform>>> {
        match &self.shape {
            Shape::Table(table) => table.rise_transform(radius).map(Some),
            _ => Ok(None),
        }
    }

    /// Radius, m, of the flat in the middle: zero but for some tables.
    pub(crate) fn flat_radius(&self) -> f64 {
        match &self.shape {
            Shape::Table(table) => table.flat_radius(),
            _ => 0.0,
        }
    }

    /// `g(x)`, m, at `x >= 0`, m. For a power law this is `κ A x^n`, which is also the relation between indentation and contact
    /// radius [S, Eqs. (7), (8)].
    pub fn value(&self, x: f64) -> f64 {
        match &self.shape {
            Shape::PowerLaw { coefficient, exponent } => coefficient * x.powf(*exponent),
            Shape::Sphere { radius, .. } => self.rise(0.0, x.min(2.0 * radius).powi(2)),
            Shape::Table(table) => table.value(x),
        }
    }

    /// Slope `g'(x)`, at `x >= 0`, m.
    pub fn derivative(&self, x: f64) -> f64 {
        match &self.shape {
            Shape::PowerLaw { coefficient, exponent } => exponent * coefficient * x.powf(exponent - 1.0),
            Shape::Sphere { radius, integral } => {
                let argument = (x / radius).powi(2);
                2.0 * x / (radius * (1.0 + self.grading)) * integral.mean_slope(argument, argument)
            }
            Shape::Table(table) => table.derivative(x),
        }
    }

    /// `g(√(start² + offset)) - g(start)`, m, to full relative accuracy also for `abs(offset) << start²`.
    ///
    /// # Arguments
    /// * `start` -- m, `start >= 0`
    /// * `offset` -- m², of either sign, `offset >= -start²`
    pub fn rise(&self, start: f64, offset: f64) -> f64 {
        match &self.shape {
            Shape::PowerLaw { coefficient, exponent } if offset.abs() > 0.5 * start * start => {
                coefficient * ((start * start + offset).max(0.0).powf(0.5 * exponent) - start.powf(*exponent))
            }
            Shape::PowerLaw { exponent, .. } if start > 0.0 => {
                self.value(start) * (0.5 * exponent * (offset / start / start).ln_1p()).exp_m1()
            }
            Shape::PowerLaw { .. } => 0.0,
            Shape::Sphere { radius, integral } => {
                let first = (start / radius).powi(2);
                let increase = offset / (radius * radius);
                radius / (1.0 + self.grading) * increase * integral.mean_slope(first, first + increase)
            }
            Shape::Table(table) => table.rise(start, offset),
        }
    }

    /// Contact radius, m, at which `g` has risen to `depth >= 0`, m: the inverse of `g`.
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if a sphere would have to sink in to its equator, a table ends before that depth, or its contact would split
    /// into rings.
    pub fn radius_at(&self, depth: f64) -> Result<f64> {
        match &self.shape {
            Shape::PowerLaw { coefficient, exponent } => Ok((depth / coefficient).powf(exponent.recip())),
            Shape::Sphere { radius, integral } => {
                let scaled = depth * (1.0 + self.grading) / radius;
                let argument = integral.argument_at(scaled).ok_or_else(|| Error::Inconsistent {
                    what: "contact radius",
                    why: format!("a sphere of radius {radius} m at an indentation of {depth} m would touch beyond 0.999 of its radius"),
                })?;
                Ok(radius * argument.sqrt())
            }
            Shape::Table(table) => table.radius_at(depth),
        }
    }

    /// `a² - c² >= 0`, m², of the radius `c` at which `g` is lower than at `a = radius` by `depth_drop`.
    ///
    /// Relative accuracy for every `depth_drop` up to about half of `g(a)`; above that `c` itself is better from
    /// [`EquivalentProfile::radius_at`].
    ///
    /// # Arguments
    /// * `radius` -- `a`, m, positive
    /// * `depth_drop` -- m, from 0 to `g(a)`
    pub fn radius_squared_drop(&self, radius: f64, depth_drop: f64) -> f64 {
        match &self.shape {
            Shape::PowerLaw { exponent, .. } => {
                -radius * radius * ((-depth_drop / self.value(radius)).ln_1p() * 2.0 / exponent).exp_m1()
            }
            Shape::Sphere { radius: sphere_radius, integral } => {
                let scaled = depth_drop * (1.0 + self.grading) / sphere_radius;
                sphere_radius
                    * sphere_radius
                    * integral.argument_drop((radius / sphere_radius).powi(2), scaled)
            }
            Shape::Table(table) => table.radius_squared_drop(radius, depth_drop),
        }
    }

    /// Normal force per normal stiffness [S, Eq. (22)] at the contact radius `a = radius`, m^(2+k).
    ///
    /// ```text
    /// F_N/c_N = 2 ∫_0^a x^k (g(a) - g(x)) dx        g = κ A x^n:  2 κ A a^(n+1+k) n / ((1+k)(n+1+k))
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
    pub fn load_integral(&self, radius: f64) -> f64 {
        let q = 1.0 + self.grading;
        match &self.shape {
            Shape::PowerLaw { coefficient, exponent } => {
                2.0 * coefficient * exponent * radius.powf(exponent + q) / (q * (exponent + q))
            }
            Shape::Sphere { radius: sphere_radius, integral } => {
                let argument = (radius / sphere_radius).powi(2);
                radius.powf(q + 2.0) / (sphere_radius * q) * integral.load(argument)
            }
            Shape::Table(table) => table.load_integral(radius),
        }
    }

    /// Indentation `d`, m, under the normal force per normal stiffness `load = F_N/c_N`, m^(2+k): inverts [S, Eq. (22)].
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the load is not positive and finite; [`Error::Inconsistent`] if it is more than a sphere carries
    /// before it sinks in to its equator, or a table before it ends.
    pub fn depth_for_load(&self, load: f64) -> Result<f64> {
        if !(load > 0.0 && load.is_finite()) {
            return Err(Error::OutOfRange {
                name: "normal force per stiffness",
                value: load,
                range: "(0, inf)",
            });
        }
        let q = 1.0 + self.grading;
        match &self.shape {
            Shape::PowerLaw { coefficient, exponent } => {
                let radius =
                    (load * q * (exponent + q) / (2.0 * coefficient * exponent)).powf((exponent + q).recip());
                Ok(self.value(radius))
            }
            Shape::Sphere { radius, .. } => {
                let largest = self.largest_radius();
                if self.load_integral(largest) < load {
                    let why = format!(
                        "F_N/c_N = {load} m^(2+k) presses a sphere of radius {radius} m in beyond 0.999 of its radius"
                    );
                    return Err(Error::Inconsistent { what: "indentation under the normal force", why });
                }
                // A sphere carries more than its paraboloid of the same contact radius.
                let paraboloid = (0.5 * load * q * q * (2.0 + q) * radius / 2.0).powf((2.0 + q).recip());
                let contact = roots::bracketed(
                    |a| self.load_integral(a) - load,
                    0.0,
                    largest.min(1.001 * paraboloid),
                    0.0,
                )?;
                Ok(self.value(contact))
            }
            Shape::Table(table) => table.depth_for_load(load),
        }
    }

    /// Differences of `g` against its value at `radius`.
    pub(crate) fn at(&self, radius: f64) -> Origin<'_> {
        let scale = match &self.shape {
            Shape::PowerLaw { .. } => self.value(radius),
            Shape::Sphere { radius: sphere_radius, .. } => (radius / sphere_radius).powi(2),
            Shape::Table(_) => radius,
        };
        Origin { profile: self, scale }
    }
}

/// A point `x0` of an equivalent profile; its neighbours are named by the logarithm `l` of `x/x0`.
pub(crate) struct Origin<'a> {
    profile: &'a EquivalentProfile,
    /// `g(x0)` for power laws, `x0²/R²` for the sphere, `x0` for a table.
    scale: f64,
}

impl Origin<'_> {
    /// `g(x0 e^l) - g(x0)`, m, to full relative accuracy.
    pub(crate) fn rise(&self, logarithm: f64) -> f64 {
        match &self.profile.shape {
            Shape::PowerLaw { exponent, .. } => self.scale * (exponent * logarithm).exp_m1(),
            Shape::Sphere { radius, integral } => {
                let increase = self.scale * (2.0 * logarithm).exp_m1();
                radius / (1.0 + self.profile.grading)
                    * increase
                    * integral.mean_slope(self.scale, self.scale + increase)
            }
            Shape::Table(table) => {
                table.rise(self.scale, self.scale * self.scale * (2.0 * logarithm).exp_m1())
            }
        }
    }

    /// `x g'(x)`, m, at `x = x0 e^l`.
    pub(crate) fn logarithmic_slope(&self, logarithm: f64) -> f64 {
        match &self.profile.shape {
            Shape::PowerLaw { exponent, .. } => exponent * self.scale * (exponent * logarithm).exp(),
            Shape::Sphere { radius, integral } => {
                let argument = self.scale * (2.0 * logarithm).exp();
                2.0 * radius / (1.0 + self.profile.grading)
                    * argument
                    * integral.mean_slope(argument, argument)
            }
            Shape::Table(table) => {
                let x = self.scale * logarithm.exp();
                x * table.derivative(x)
            }
        }
    }
}

/// Factor `κ` between a power-law profile `f = A r^n` and its equivalent `g = κ A x^n` [S, Eq. (6)].
///
/// ```text
/// κ(n, k) = (n/2) B(n/2, (1+k)/2) = Γ(1 + n/2) Γ((1+k)/2) / Γ((n+1+k)/2)
/// ```
///
/// # Arguments
/// * `exponent` -- `n`, positive; any size, nothing overflows
/// * `grading` -- `k`, in (-1, 1)
///
/// # Examples
/// ```
/// use fretwear::contact::indenter::power_law_factor;
///
/// assert!((power_law_factor(2.0, 0.0) - 2.0).abs() < 1e-15); // paraboloid: 2/(1+k)
/// assert!((power_law_factor(1.0, 0.0) - std::f64::consts::FRAC_PI_2).abs() < 1e-15); // cone
/// ```
pub fn power_law_factor(exponent: f64, grading: f64) -> f64 {
    let (m, nu) = (0.5 * exponent, 0.5 * (1.0 + grading));
    // Γ(ν) = Γ(1+ν)/ν: the pole at k = -1 without the rounding of Γ next to it.
    let gamma_nu = libm::tgamma(1.0 + nu) / nu;
    if m <= 10.0 {
        return libm::tgamma(1.0 + m) * gamma_nu / libm::tgamma(m + nu);
    }
    // Γ(m+1)/Γ(m+ν) by Fields' expansion about w = m + ν/2, whose next term is below 1e-15 from m = 100 on; smaller m are carried there by
    // Γ(m+1) = m Γ(m), because Γ itself loses digits.
    let carried = (100.0 - m).ceil().max(0.0);
    let carry: f64 = (0..carried as usize).map(|j| (m + nu + j as f64) / (m + 1.0 + j as f64)).product();
    let (w, p) = (m + carried + 0.5 * nu, 1.0 - nu);
    let second = -p * (p - 1.0) * (p + 1.0) / 24.0;
    let fourth = p * (p - 1.0) * (p - 2.0) * (p - 3.0) * (p + 1.0) * (5.0 * p + 7.0) / 5760.0;
    gamma_nu * carry * w.powf(p) * (1.0 + (second + fourth / (w * w)) / (w * w))
}
