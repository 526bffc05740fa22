//! The transforms between a profile and its one-dimensional equivalent for any profile: [S, Eqs. (19)–(22)] by adaptive quadrature.
//!
//! [`Indenter`](crate::contact::indenter::Indenter) has the equivalent profiles of power laws and spheres in closed form, and
//! [`AbelOperators`](crate::numerics::abel::AbelOperators) the transforms as matrices for the time stepping. Here the profile is a closure, and every
//! value is refined until its estimated error is below 1e-13 of it, or refused. What is not smooth, such as the edge of a truncated cone,
//! is named as a break; tips like `f = A r^n` with small `n` and places next to an end of an integral need no mention.
//!
//! | equation of \[S\] | content | function |
//! |---|---|---|
//! | (19) | `g` from `f` | [`Transforms::equivalent_profile`] |
//! | (19), differentiated | `g'` from `f` | [`Transforms::equivalent_slope`] |
//! | (20) | `f` from `g` | [`Transforms::profile`] |
//! | (21), corrected | `p/c_N` from `g'` | [`Transforms::pressure`] |
//! | (22) | `F_N/c_N` from `g` | [`Transforms::load`] |
//! | | `F_N` from `p` | [`Transforms::pressure_sum`] |
//!
//! As `k → ±1` some of the integrals diverge while the factors before them vanish; only the products are ever formed.

mod adaptive;

use std::f64::consts::PI;

use crate::error::{Error, Result};
use adaptive::{Adaptive, Exponent};

/// Transforms of profiles on a half-space of one grading, with one set of breaks.
///
/// The closures take a radius, m, that is positive and never a break itself. Where a value cannot be had, for instance because it is the
/// result of another transform that failed, they return NaN, which makes the transform fail.
///
/// # Examples
/// ```
/// use fretwear::contact::transforms::Transforms;
///
/// // Cone of slope 0.1, truncated at the radius b = 1; homogeneous half-space: g = 0.1 x arccos(b/x).
/// let transforms = Transforms::new(0.0, &[1.0])?;
/// let slope = |r: f64| if r < 1.0 { 0.0 } else { 0.1 };
/// let g = transforms.equivalent_profile(slope, 2.0)?;
/// assert!((g / (0.2 * 0.5f64.acos()) - 1.0).abs() < 1e-13);
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Transforms {
    grading: f64,
    /// `μ = (1-k)/2` and `ν = (1+k)/2`.
    mu: f64,
    nu: f64,
    breaks: Vec<f64>,
    adaptive: Adaptive,
}

impl Transforms {
    /// Transforms on a half-space of grading `k`, in (-1, 1), for profiles with kinks or jumps at the radii `breaks`, m.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if the grading or a break, which is to be positive and finite, is out of range.
    pub fn new(grading: f64, breaks: &[f64]) -> Result<Self> {
        if !(grading > -1.0 && grading < 1.0) {
            return Err(Error::OutOfRange { name: "half_space.grading", value: grading, range: "(-1, 1)" });
        }
        if let Some(&value) = breaks.iter().find(|radius| !(**radius > 0.0 && radius.is_finite())) {
            return Err(Error::OutOfRange { name: "break of the profile", value, range: "(0, inf)" });
        }
        let mut breaks = breaks.to_vec();
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        let (mu, nu) = (0.5 * (1.0 - grading), 0.5 * (1.0 + grading));
        let mut transforms = Self { grading, mu, nu, breaks, adaptive: Adaptive::new(&[])? };
        let mut exponents =
            vec![transforms.minus_mu(), transforms.minus_nu(), transforms.k(), transforms.plus_nu()];
        exponents.extend(transforms.minus_two_mu());
        transforms.adaptive = Adaptive::new(&exponents)?;
        Ok(transforms)
    }

    /// The same with another relative error than 1e-13 at which refinement ends: for closures that are less accurate themselves, which would
    /// be refined in vain, or for speed.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if it is not in [1e-15, 1).
    pub fn with_tolerance(mut self, tolerance: f64) -> Result<Self> {
        if !(1e-15..1.0).contains(&tolerance) {
            return Err(Error::OutOfRange {
                name: "tolerance of a transform",
                value: tolerance,
                range: "[1e-15, 1)",
            });
        }
        self.adaptive.tolerance = tolerance;
        Ok(self)
    }

    /// Grading `k`.
    pub fn grading(&self) -> f64 {
        self.grading
    }

    /// Equivalent profile `g(x)`, m [S, Eq. (19)].
    ///
    /// ```text
    /// g(x) = x^(1-k) ∫_0^x f'(r) (x²-r²)^(-μ) dr = x ∫_0^1 f'(xv) (1-v²)^(-μ) dv,     μ = (1-k)/2
    /// ```
    ///
    /// # Arguments
    /// * `slope` -- `f'(r)`
    /// * `x` -- m, `x >= 0`
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a radius that is negative or not finite; [`Error::NotConverged`] if the tolerance is out of reach.
    pub fn equivalent_profile(&self, slope: impl Fn(f64) -> f64, x: f64) -> Result<f64> {
        if check_radius(x)? == 0.0 {
            return Ok(0.0);
        }
        let end = |point: f64, _: bool| if point == x { self.minus_mu() } else { Exponent::NONE };
        self.adaptive.integrate("equivalent profile", &self.points(0.0, x), end, |point| {
            slope(point.position) * point.kernel(x, -self.mu, x)
        })
    }

    /// Slope `g'(x)` of the equivalent profile, from the derivative of [S, Eq. (19)].
    ///
    /// ```text
    /// g'(x) = ∫_0^1 [f'(xv) + xv f''(xv)] (1-v²)^(-μ) dv + Σ_b [f'(b+) - f'(b-)] (b/x) (1-b²/x²)^(-μ)
    /// ```
    /// The sum is over the breaks `b < x`, at which the jumps of `f'` are found by calling it on either side. Above a kink `g'` has a pole
    /// of order `μ`.
    ///
    /// # Arguments
    /// * `slope` -- `f'(r)`
    /// * `curvature` -- `f''(r)`, 1/m
    /// * `x` -- m, positive
    ///
    /// # Errors
    /// As [`Transforms::equivalent_profile`], and [`Error::OutOfRange`] at `x = 0` and at a break.
    pub fn equivalent_slope(
        &self,
        slope: impl Fn(f64) -> f64,
        curvature: impl Fn(f64) -> f64,
        x: f64,
    ) -> Result<f64> {
        if check_radius(x)? == 0.0 || self.breaks.contains(&x) {
            return Err(Error::OutOfRange { name: "radius", value: x, range: "(0, inf), breaks excluded" });
        }
        let end = |point: f64, _: bool| if point == x { self.minus_mu() } else { Exponent::NONE };
        let smooth = self.adaptive.integrate(
            "slope of the equivalent profile",
            &self.points(0.0, x),
            end,
            |point| {
                let r = point.position;
                (slope(r) + r * curvature(r)) * point.kernel(x, -self.mu, x) / x
            },
        )?;
        let kinks = self.breaks.iter().filter(|radius| **radius < x).map(|&b| {
            let jump = slope(b.next_up()) - slope(b.next_down());
            jump * (b / x) * ((x - b) / x * ((x + b) / x)).powf(-self.mu)
        });
        Ok(smooth + kinks.sum::<f64>())
    }

    /// Profile `f(r)`, m, of an equivalent profile [S, Eq. (20)].
    ///
    /// ```text
    /// f(r) = (2/π) cos(kπ/2) ∫_0^r x^k g(x) (r²-x²)^(-ν) dx,     ν = (1+k)/2
    /// ```
    /// A mean of `g(ru)` of weight `u^k (1-u²)^(-ν)`: a constant is its own profile. At breaks `g` may jump, as that of a worn profile.
    ///
    /// # Arguments
    /// * `equivalent` -- `g(x)`, m
    /// * `r` -- m, `r >= 0`
    ///
    /// # Errors
    /// As [`Transforms::equivalent_profile`].
    pub fn profile(&self, equivalent: impl Fn(f64) -> f64, r: f64) -> Result<f64> {
        if check_radius(r)? == 0.0 {
            return Ok(0.0);
        }
        let end = |point: f64, _: bool| match point {
            0.0 => self.k(),
            point if point == r => self.minus_nu(),
            _ => Exponent::NONE,
        };
        let factor = 2.0 / PI * (PI * self.mu.min(self.nu)).sin();
        let scale = factor * r.powf(-self.k().plus_one);
        let integral = self.adaptive.integrate("profile", &self.points(0.0, r), end, |point| {
            let density = if point.anchor == 0.0 { 1.0 } else { point.position.powf(self.grading) };
            equivalent(point.position) * density * point.kernel(r, -self.nu, r)
        })?;
        Ok(scale * integral)
    }

    /// Contact pressure per normal stiffness, `p(r)/c_N`, m^k, from the slope of the equivalent profile [S, Eq. (21) without its factor
    /// `x^k`, pressure positive].
    ///
    /// ```text
    /// p(r) = (c_N/π) ∫_r^a g'(x) (x²-r²)^(-μ) dx
    /// ```
    /// A jump of `g` by `h` at `b`, which the slope cannot show, adds `(c_N/π) h (b²-r²)^(-μ)` within `b`.
    ///
    /// # Arguments
    /// * `equivalent_slope` -- `g'(x)`; above a break it may have a pole of order `μ`, as above a kink of `f`
    /// * `r` -- m, `r >= 0`
    /// * `contact_radius` -- `a`, m; outside there is no pressure
    ///
    /// # Errors
    /// [`Error::NotConverged`] as elsewhere, and where the pressure is infinite, at some tips and for `k <= 0` at a kink; also so close above
    /// a kink, within some 1e-3 of its radius, that the rounding of the radii that `g'` is called with spoils its pole.
    pub fn pressure(
        &self,
        equivalent_slope: impl Fn(f64) -> f64,
        r: f64,
        contact_radius: f64,
    ) -> Result<f64> {
        let (r, a) = (check_radius(r)?, check_radius(contact_radius)?);
        if r >= a {
            return Ok(0.0);
        }
        let at_break = self.breaks.contains(&r);
        let end = |point: f64, above: bool| match point {
            _ if !above => Exponent::NONE,
            _ if point == r && (r == 0.0 || at_break) => self.minus_two_mu().unwrap_or(Exponent::NONE),
            _ if point == r || self.breaks.contains(&point) => self.minus_mu(),
            _ => Exponent::NONE,
        };
        let integral = self.adaptive.integrate("pressure", &self.points(r, a), end, |point| {
            // What is left of the singularities when the kernel has shed its own and the rule has taken its share.
            let kernel = if point.anchor == r { self.mu } else { 0.0 };
            let left = -kernel - end(point.anchor, point.offset > 0.0).value;
            let singular = if left == 0.0 { 1.0 } else { point.rounded_distance().powf(left) };
            equivalent_slope(point.position) * singular * point.kernel(r, -self.mu, 1.0)
        })?;
        Ok(integral / PI)
    }

    /// Normal force per normal stiffness, `F_N/c_N`, m^(2+k), from the equivalent profile [S, Eq. (22)].
    ///
    /// ```text
    /// F_N/c_N = 2 ∫_0^a x^k (d - g(x)) dx
    /// ```
    ///
    /// # Arguments
    /// * `equivalent` -- `g(x)`, m
    /// * `indentation` -- `d`, m; `g(a)` if the profile ends the contact
    /// * `contact_radius` -- `a`, m
    ///
    /// # Errors
    /// As [`Transforms::equivalent_profile`].
    pub fn load(
        &self,
        equivalent: impl Fn(f64) -> f64,
        indentation: f64,
        contact_radius: f64,
    ) -> Result<f64> {
        if check_radius(contact_radius)? == 0.0 {
            return Ok(0.0);
        }
        let end = |point: f64, _: bool| if point == 0.0 { self.k() } else { Exponent::NONE };
        let integral =
            self.adaptive.integrate("normal force", &self.points(0.0, contact_radius), end, |point| {
                let density = if point.anchor == 0.0 { 1.0 } else { point.position.powf(self.grading) };
                density * (indentation - equivalent(point.position))
            })?;
        Ok(2.0 * integral)
    }

    /// Force that a pressure adds up to, with which [S, Eq. (22)] has to agree.
    ///
    /// ```text
    /// F_N = 2π ∫_0^a p(r) r dr
    /// ```
    ///
    /// # Arguments
    /// * `pressure` -- `p(r)`, Pa, or per stiffness
    /// * `contact_radius` -- `a`, m
    ///
    /// # Errors
    /// As [`Transforms::equivalent_profile`].
    pub fn pressure_sum(&self, pressure: impl Fn(f64) -> f64, contact_radius: f64) -> Result<f64> {
        let a = check_radius(contact_radius)?;
        if a == 0.0 {
            return Ok(0.0);
        }
        // At the contact edge p ~ (a-r)^ν; on both sides of a kink p ~ |r-b|^k.
        let end = |point: f64, _: bool| match point {
            0.0 => Exponent::NONE,
            point if point == a => self.plus_nu(),
            _ if self.grading < 0.0 => self.k(),
            _ => Exponent::NONE,
        };
        let integral =
            self.adaptive.integrate("sum of the pressure", &self.points(0.0, a), end, |point| {
                let exponent = end(point.anchor, true).value;
                let singular = if exponent == 0.0 { 1.0 } else { point.rounded_distance().powf(-exponent) };
                pressure(point.position) * point.position * singular
            })?;
        Ok(2.0 * PI * integral)
    }

    /// Ends of an interval and the breaks between.
    fn points(&self, low: f64, high: f64) -> Vec<f64> {
        let between = self.breaks.iter().copied().filter(|radius| low < *radius && *radius < high);
        std::iter::once(low).chain(between).chain([high]).collect()
    }

    fn minus_mu(&self) -> Exponent {
        Exponent { value: -self.mu, plus_one: self.nu }
    }

    fn minus_nu(&self) -> Exponent {
        Exponent { value: -self.nu, plus_one: self.mu }
    }

    fn plus_nu(&self) -> Exponent {
        Exponent { value: self.nu, plus_one: 1.0 + self.nu }
    }

    fn k(&self) -> Exponent {
        Exponent { value: self.grading, plus_one: 1.0 + self.grading }
    }

    /// `-2μ = k - 1`; none if the singularity cannot be integrated.
    fn minus_two_mu(&self) -> Option<Exponent> {
        (self.grading > 0.0).then_some(Exponent { value: -2.0 * self.mu, plus_one: self.grading })
    }
}

fn check_radius(radius: f64) -> Result<f64> {
    if radius >= 0.0 && radius.is_finite() {
        return Ok(radius);
    }
    Err(Error::OutOfRange { name: "radius", value: radius, range: "[0, inf)" })
}
