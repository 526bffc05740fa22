//! The limiting worn volume of a power law as a function of the amplitude alone, for maps and searches.

use std::f64::consts::PI;

use super::small_amplitude_wear_volume;
use super::wear_integral::WearIntegral;
use crate::contact::indenter::{Indenter, power_law_factor};
use crate::error::{Error, Result};

/// Limiting worn volume of the power law `f = A r^n` at one grading, over the amplitude: `ΔV/(π a0² d)` as a function of `q_c/d`.
///
/// A power law has no length of its own, so that this function holds for every coefficient and indentation. The quadrature rules are
/// shared by all amplitudes; what is left is the search for `a∞`, some 10 µs.
///
/// # Examples
/// ```
/// use fretwear::contact::closed_form::PowerLawVolume;
///
/// // Paraboloid, k = 0, c/a0 = 0.5, for which q_c/d = 1 - (c/a0)².
/// let volume = PowerLawVolume::new(2.0, 0.0)?.at(0.75)?;
/// let shape = fretwear::contact::closed_form::LimitingShape::from_stick_ratio(
///     &fretwear::contact::indenter::Indenter::paraboloid(1.0)?, 0.0, 1.0, 0.5)?;
/// assert!((volume * std::f64::consts::PI / shape.wear_volume() - 1.0).abs() < 1e-14);
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct PowerLawVolume {
    exponent: f64,
    grading: f64,
    /// `ln(κ)/n`, the most that `ln(a∞/a0)` can be.
    largest_growth: f64,
    integral: WearIntegral,
}

impl PowerLawVolume {
    /// Prepares the function.
    ///
    /// # Arguments
    /// * `exponent` -- `n`, positive
    /// * `grading` -- `k`, in (-1, 1)
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the argument.
    pub fn new(exponent: f64, grading: f64) -> Result<Self> {
        // g = x^n: contact radius and indentation are one.
        let factor = power_law_factor(exponent, grading);
        let profile = Indenter::power_law(1.0 / factor, exponent)?.equivalent_profile(grading)?;
        let integral = WearIntegral::new(profile, 1.0, 1.0, WearIntegral::rules(grading)?);
        Ok(Self { exponent, grading, largest_growth: factor.ln() / exponent, integral })
    }

    /// Exponent `n` of the profile.
    pub fn exponent(&self) -> f64 {
        self.exponent
    }

    /// Grading `k`.
    pub fn grading(&self) -> f64 {
        self.grading
    }

    /// `ΔV/(π a0² d)` [S, Eq. (4)] at the relative spring compression `q_c/d` at the edge of stick, in [0, 1).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for another argument, full sliding included; [`Error::NotConverged`] for exponents in the thousands.
    pub fn at(&self, relative_compression: f64) -> Result<f64> {
        if !(0.0..1.0).contains(&relative_compression) {
            return Err(Error::OutOfRange { name: "q_c/d", value: relative_compression, range: "[0, 1)" });
        }
        if relative_compression == 0.0 {
            return Ok(0.0);
        }
        let stick_logarithm = -(-relative_compression).ln_1p() / self.exponent;
        let mut integral = self.integral.clone();
        let growth = integral.limiting_growth(stick_logarithm, self.largest_growth)?;
        Ok(integral.volume(stick_logarithm + growth, growth))
    }

    /// `ΔV/(π a0² d)` by [S, Eq. (15)], with the exact stick radius and `ε_a`.
    pub fn small_amplitude(&self, relative_compression: f64) -> f64 {
        let stick_logarithm = -(-relative_compression).ln_1p() / self.exponent;
        let stick_radius = (-stick_logarithm).exp();
        let relative_width = stick_logarithm.exp_m1();
        small_amplitude_wear_volume(self.grading, self.exponent, 1.0, stick_radius, relative_width) / PI
    }

    /// `ΔV/(π a0² d)` by [S, Eq. (15)] to leading order also of `c → a0` and `ε_a → q_c/(n d)`: a power of the amplitude.
    pub fn leading_order(&self, relative_compression: f64) -> f64 {
        let relative_width = relative_compression / self.exponent;
        small_amplitude_wear_volume(self.grading, self.exponent, 1.0, 1.0, relative_width) / PI
    }
}

/// `ΔV/(π a0² d)` of a power law in the limit `k → 1`, where the transforms become the identity and `Δf = d - f0` on `c < r < a0`.
///
/// ```text
/// ΔV/(π a0² d) = (1 - c²) - 2/(n+2) (1 - c^(n+2)),     c^n = 1 - q_c/d,     lengths in a0
/// ```
/// The Gibson medium of the literature has ν = 1/2 besides, for which `M` vanishes and nothing slips; under elastic similarity `M → 1/4`.
///
/// # Arguments
/// * `exponent` -- `n`
/// * `relative_compression` -- `q_c/d`, in [0, 1)
///
/// # Examples
/// ```
/// // Paraboloid: (1 - c²)²/2 = (q_c/d)²/2
/// assert!((fretwear::contact::closed_form::gibson_wear_volume(2.0, 1e-5) / 5e-11 - 1.0).abs() < 1e-14);
/// ```
pub fn gibson_wear_volume(exponent: f64, relative_compression: f64) -> f64 {
    let power = 2.0 / exponent;
    if relative_compression * (1.0 - power).abs().max(1.0) > 0.5 {
        let logarithm = (-relative_compression).ln_1p() / exponent;
        return -(2.0 * logarithm).exp_m1()
            + 2.0 / (exponent + 2.0) * ((exponent + 2.0) * logarithm).exp_m1();
    }
    // With r^n = 1 - q t the integral of 2 r (1 - r^n) dr is (2/n) q² times that of t (1 - q t)^(2/n - 1), here term by term:
    // Σ_j (1-2/n)_j/j! q^j/(j+2); no two close numbers are subtracted.
    let (mut term, mut sum, mut j) = (1.0, 0.5, 0.0);
    while f64::abs(term) > 1e-18 && j < 200.0 {
        term *= relative_compression * (1.0 - power + j) / (j + 1.0);
        j += 1.0;
        sum += term / (j + 2.0);
    }
    power * relative_compression * relative_compression * sum
}
