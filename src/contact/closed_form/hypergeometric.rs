//! The paper's own form of the limit for power laws, [S, Eqs. (9), (10)], with Gauss's series: an independent second way.
//!
//! With `z = c²/r²`, `y = 1 - z`, `μ = (1-k)/2`, `ν = (1+k)/2`, `m = n/2` and Gauss's `F(a, c; y) = 2F1(a, 1; c; y)`, Eq. (9) is
//!
//! ```text
//! Δf/d = I_y(μ, ν) - (r/a0)^n/κ I_y(μ, ν+m)
//!      = S y^μ z^ν [F(1, 1+μ; y) - (c/a0)^n F(1+m, 1+μ; y)]                                               y <= 1/2
//!      = 1 - (r/a0)^n/κ - (sin πν/π) y^μ z^ν [F(1, 1+ν; z)/ν - (c/a0)^n F(1+m, 1+ν+m; z)/(ν+m)]           z <  1/2
//! ```
//! with `S = sin(πμ)/(πμ)`: the Γ functions of the regularised incomplete beta functions `I` cancel against those in `κ`, so nothing can
//! overflow, and every series has positive terms. The differences are what costs digits: at the fraction `ε` of full sliding some
//! `log10(1/ε)` of them in the depth, the volume and `a∞ - a0`, in the last one `log10(1/μ)` more as `k → 1`; as `k → -1` the depth becomes
//! small beside the terms. [`LimitingShape`](super::LimitingShape) has none of that; here every value comes with a bound of its own error,
//! so that the two can be compared. Against tables of 17 digits the error is at most 0.3 of the bound, typically 0.01 to 0.04 of it.
//!
//! The series are our own: of the crates with a 2F1 or an incomplete beta function none states an error bound, and the best was good to 1e-12.

use std::f64::consts::{LN_2, PI};

use super::wear_integral::transform_factor;
use crate::contact::indenter::power_law_factor;
use crate::error::{Error, Result};

/// Terms after which a series is given up: at an argument of a half some `60 + 2a` are needed.
const MAX_TERMS: usize = 10_000;

/// Relative error claimed for an elementary function, and for `κ`.
const ROUNDING: f64 = f64::EPSILON;
const FACTOR_ERROR: f64 = 24.0 * f64::EPSILON;

/// A value with a bound of its absolute error, from the sizes of all that was added and subtracted on the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Claimed {
    /// The value.
    pub value: f64,
    /// Largest error it may have.
    pub error: f64,
}

impl Claimed {
    /// Whether `other` may be the same quantity, both errors allowed.
    pub fn agrees_with(&self, other: &Self) -> bool {
        (self.value - other.value).abs() <= self.error + other.error
    }

    fn new(value: f64, relative_error: f64) -> Self {
        Self { value, error: relative_error * value.abs() }
    }

    fn times(self, other: Self) -> Self {
        let value = self.value * other.value;
        let error = self.error * other.value.abs() + other.error * (self.value.abs() + self.error);
        Self { value, error: error + ROUNDING * value.abs() }
    }

    fn plus(self, other: Self) -> Self {
        let value = self.value + other.value;
        Self { value, error: self.error + other.error + ROUNDING * value.abs() }
    }

    fn minus(self, other: Self) -> Self {
        self.plus(Self { value: -other.value, error: other.error })
    }

    fn over(self, exact: f64) -> Self {
        Self {
            value: self.value / exact,
            error: self.error / exact.abs() + ROUNDING * (self.value / exact).abs(),
        }
    }
}

/// Gauss's hypergeometric function `2F1(a, b; c; y)` [S, Eq. (10)] by its series.
///
/// ```text
/// 2F1(a, b; c; y) = Σ_j (a)_j (b)_j / ((c)_j j!) y^j
/// ```
/// All terms are positive, so the relative error is that of the last bits: some `1e-16` for each term that matters.
///
/// # Arguments
/// * `a`, `b`, `c` -- positive
/// * `y` -- in [0, 1); the series is slow next to 1
///
/// # Errors
/// [`Error::OutOfRange`] names an argument; [`Error::NotConverged`] after 10000 terms.
///
/// # Examples
/// ```
/// use fretwear::contact::closed_form::gauss_hypergeometric;
///
/// // 2F1(1, 1; 2; y) = -ln(1-y)/y
/// let half = gauss_hypergeometric(1.0, 1.0, 2.0, 0.5)?;
/// assert!((half.value - 2.0 * 2f64.ln()).abs() <= half.error && half.error < 2e-14);
/// # Ok::<(), fretwear::Error>(())
/// ```
pub fn gauss_hypergeometric(a: f64, b: f64, c: f64, y: f64) -> Result<Claimed> {
    for (name, value) in [("hypergeometric a", a), ("hypergeometric b", b), ("hypergeometric c", c)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(Error::OutOfRange { name, value, range: "(0, inf)" });
        }
    }
    if !(0.0..1.0).contains(&y) {
        return Err(Error::OutOfRange { name: "hypergeometric argument", value: y, range: "[0, 1)" });
    }
    let (mut term, mut sum, mut error) = (1.0, 1.0, 0.0);
    for j in 0..MAX_TERMS {
        let j = j as f64;
        let ratio = (a + j) * (b + j) / ((c + j) * (1.0 + j)) * y;
        term *= ratio;
        sum += term;
        // Nine roundings go into each ratio, with that of y, and accumulate in the term; one goes into each sum.
        error += (5.0 * (j + 1.0) * term + 0.5 * sum) * ROUNDING;
        // The ratios tend to y, from above or below: what is left is below a geometric series of the larger of both.
        let largest = ratio.max(y);
        if largest < 1.0 && term * largest / (1.0 - largest) <= 0.25 * ROUNDING * sum {
            return Ok(Claimed { value: sum, error: error + ROUNDING * sum });
        }
    }
    Err(Error::NotConverged {
        what: "hypergeometric series",
        why: format!("2F1({a}, {b}; {c}; {y}) is {sum:e} after {MAX_TERMS} terms"),
    })
}

/// Limiting shape of a power law by [S, Eq. (9)], in units in which `d = a0 = 1`.
///
/// Radii are given by the logarithms `span = ln(r/c)` and `growth = ln(r/a0)`, so that neither `y` nor `z` cancels.
///
/// # Examples
/// ```
/// use fretwear::contact::closed_form::HypergeometricLimit;
///
/// // Paraboloid on a homogeneous half-space, stick radius a0/2.
/// let limit = HypergeometricLimit::new(2.0, 0.0, 2f64.ln())?;
/// let growth = limit.growth()?;
/// assert!((growth.value - 1.2297905754654218f64.ln()).abs() <= growth.error && growth.error < 1e-13);
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct HypergeometricLimit {
    exponent: f64,
    grading: f64,
    /// `η = ln(a0/c)`.
    stick_logarithm: f64,
    mu: f64,
    nu: f64,
    factor: f64,
}

impl HypergeometricLimit {
    /// Limit of the power law of exponent `n` at grading `k` for the stick radius `c = a0 e^(-η)`.
    ///
    /// # Arguments
    /// * `exponent` -- `n`, positive
    /// * `grading` -- `k`, in (-1, 1)
    /// * `stick_logarithm` -- `η = ln(a0/c) = -ln(1 - M U/(μ_f d))/n`, positive
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the argument.
    pub fn new(exponent: f64, grading: f64, stick_logarithm: f64) -> Result<Self> {
        if !(grading > -1.0 && grading < 1.0) {
            return Err(Error::OutOfRange { name: "half_space.grading", value: grading, range: "(-1, 1)" });
        }
        for (name, value) in
            [("indenter.power-law.exponent", exponent), ("logarithm of a0/c", stick_logarithm)]
        {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::OutOfRange { name, value, range: "(0, inf)" });
            }
        }
        Ok(Self {
            exponent,
            grading,
            stick_logarithm,
            mu: 0.5 * (1.0 - grading),
            nu: 0.5 * (1.0 + grading),
            factor: power_law_factor(exponent, grading),
        })
    }

    /// Limiting wear depth `Δf/d` [S, Eq. (9)].
    ///
    /// # Arguments
    /// * `span` -- `ln(r/c)`, `span >= 0`
    /// * `growth` -- `ln(r/a0)`
    ///
    /// # Errors
    /// [`Error::OutOfRange`] within the stick radius; those of [`gauss_hypergeometric`].
    pub fn wear_depth(&self, span: f64, growth: f64) -> Result<Claimed> {
        let (stuck, pressed) = self.parts(span, growth)?;
        Ok(stuck.minus(pressed))
    }

    /// Limiting profile `f∞/d` between `c` and `a∞` [S, Eq. (9) with the unworn profile].
    ///
    /// ```text
    /// f∞/d = I_y(μ, ν) + (r/a0)^n/κ I_z(ν+m, μ)
    /// ```
    ///
    /// # Errors
    /// Those of [`gauss_hypergeometric`].
    pub fn profile(&self, span: f64, growth: f64) -> Result<Claimed> {
        let (stuck, pressed) = self.parts(span, growth)?;
        Ok(stuck.plus(self.unworn(growth).minus(pressed)))
    }

    /// `ln(a∞/a0)`: the zero of [S, Eq. (9)] between `a0` and `a0 κ^(1/n)`.
    ///
    /// The error claimed is that of an interval at whose ends the depth has opposite signs beyond its own error.
    ///
    /// # Errors
    /// Those of [`gauss_hypergeometric`]; [`Error::NotConverged`] if the signs at the ends cannot be told from rounding.
    pub fn growth(&self) -> Result<Claimed> {
        let depth = |growth: f64| self.wear_depth(self.stick_logarithm + growth, growth);
        // To first order in small amplitudes b = μη, which is an upper bound; else f0 = d is one.
        let largest = (self.factor.ln() / self.exponent).max(0.0) * (1.0 + 1e-12);
        let (mut low, mut high) = (0.0, largest.min(1.01 * self.mu * self.stick_logarithm));
        if depth(high)?.value > 0.0 {
            high = largest;
        }
        // Between zero and a bound that is far too large the middle is the geometric one.
        while high - low > 4.0 * ROUNDING * high && high > f64::MIN_POSITIVE {
            let middle = if low > 0.0 && high > 4.0 * low { (low * high).sqrt() } else { 0.5 * (low + high) };
            if depth(middle)?.value > 0.0 { low = middle } else { high = middle }
        }
        let root = 0.5 * (low + high);
        let slope = self.depth_slope(root)?;
        let mut error = 4.0 * ROUNDING * root + 1.5 * depth(root)?.error / slope.abs();
        for _ in 0..60 {
            let (inside, outside) = ((root - error).max(-self.stick_logarithm), root + error);
            let below = inside <= -self.stick_logarithm || {
                let claimed = depth(inside)?;
                claimed.value > claimed.error
            };
            let above = depth(outside)?;
            if below && above.value < -above.error {
                return Ok(Claimed { value: root, error });
            }
            error *= 2.0;
        }
        Err(Error::NotConverged {
            what: "limiting contact radius",
            why: format!("ln(a∞/a0) = {root:e} ± {error:e} does not show in the depth"),
        })
    }

    /// Limiting worn volume `ΔV/(π a0² d)` [S, Eq. (4)] in closed form, where the paper integrates numerically.
    ///
    /// ```text
    /// ΔV/(π a0² d) = A I_Y(1+μ, ν) - 2/(n+2) A^(1+m)/κ I_Y(1+μ, ν+m),     A = (a∞/a0)²,  Y = 1 - c²/a∞²
    /// ```
    /// An error of `a∞` matters in second order only, because the depth vanishes there.
    ///
    /// # Arguments
    /// * `growth` -- `ln(a∞/a0)`, from [`HypergeometricLimit::growth`]
    ///
    /// # Errors
    /// Those of [`gauss_hypergeometric`].
    pub fn wear_volume(&self, growth: Claimed) -> Result<Claimed> {
        let (mu, nu, m) = (self.mu, self.nu, 0.5 * self.exponent);
        let span = self.stick_logarithm + growth.value;
        let area = self.exponential(2.0, growth.value);
        let stuck_fraction = self.exponential(-self.exponent, self.stick_logarithm);
        let power = self.powers(1.0 + mu, span);
        let value = if span <= 0.5 * LN_2 {
            let y = -(-2.0 * span).exp_m1();
            let difference = gauss_hypergeometric(2.0, 1.0, 2.0 + mu, y)?
                .minus(stuck_fraction.times(gauss_hypergeometric(2.0 + m, 1.0, 2.0 + mu, y)?));
            power
                .times(difference)
                .times(Claimed::new(transform_factor(self.grading), 8.0 * ROUNDING))
                .over(1.0 + mu)
        } else {
            let z = (-2.0 * span).exp();
            let difference = gauss_hypergeometric(2.0, 1.0, 1.0 + nu, z)?.over(nu).minus(
                stuck_fraction.times(gauss_hypergeometric(2.0 + m, 1.0, 1.0 + nu + m, z)?.over(nu + m)),
            );
            let factor = Claimed::new(transform_factor(self.grading), 8.0 * ROUNDING);
            let flat = Claimed::new(1.0, 0.0).minus(self.unworn(growth.value).over(1.0 + m));
            flat.minus(power.times(difference).times(factor))
        };
        let mut volume = area.times(value);
        // d(ΔV)/db = 2 A Δf vanishes at the root: what is left is its own change over the error, and the error of the span.
        let slope = self.depth_slope(growth.value)?.abs();
        volume.error += 4.0
            * area.value
            * (slope * growth.error + self.wear_depth(span, growth.value)?.error)
            * growth.error;
        Ok(volume)
    }

    /// `I_y(μ, ν)` and `(r/a0)^n/κ I_y(μ, ν+m)`.
    fn parts(&self, span: f64, growth: f64) -> Result<(Claimed, Claimed)> {
        if span.is_nan() || span < 0.0 {
            return Err(Error::OutOfRange { name: "ln(r/c)", value: span, range: "[0, inf)" });
        }
        let (mu, nu, m) = (self.mu, self.nu, 0.5 * self.exponent);
        let stuck_fraction = self.exponential(self.exponent, growth - span);
        let power = self.powers(mu, span);
        if span <= 0.5 * LN_2 {
            let y = -(-2.0 * span).exp_m1();
            let common = power.times(Claimed::new(transform_factor(self.grading), 8.0 * ROUNDING));
            return Ok((
                common.times(gauss_hypergeometric(1.0, 1.0, 1.0 + mu, y)?),
                common.times(stuck_fraction).times(gauss_hypergeometric(1.0 + m, 1.0, 1.0 + mu, y)?),
            ));
        }
        let z = (-2.0 * span).exp();
        let common = power.times(Claimed::new((PI * mu.min(nu)).sin() / PI, 8.0 * ROUNDING));
        let stuck = common.times(gauss_hypergeometric(1.0, 1.0, 1.0 + nu, z)?).over(nu);
        let pressed = common
            .times(stuck_fraction)
            .times(gauss_hypergeometric(1.0 + m, 1.0, 1.0 + nu + m, z)?)
            .over(nu + m);
        Ok((Claimed::new(1.0, 0.0).minus(stuck), self.unworn(growth).minus(pressed)))
    }

    /// Slope of `Δf/d` over `ln r` at a zero of it, where `(r/a0)^n/κ I_y(μ, ν+m) = I_y(μ, ν)`.
    fn depth_slope(&self, growth: f64) -> Result<f64> {
        let span = self.stick_logarithm + growth;
        let slipping = -(-self.exponent * self.stick_logarithm).exp_m1();
        let (stuck, _) = self.parts(span, growth)?;
        let rise =
            2.0 * self.mu * transform_factor(self.grading) * slipping * self.powers(self.mu, span).value
                / -(-2.0 * span).exp_m1();
        Ok(rise - self.exponent * stuck.value)
    }

    /// Unworn profile `f0/d = (r/a0)^n/κ`.
    fn unworn(&self, growth: f64) -> Claimed {
        self.exponential(self.exponent, growth).times(Claimed::new(1.0 / self.factor, FACTOR_ERROR))
    }

    /// `y^power z^ν`.
    fn powers(&self, power: f64, span: f64) -> Claimed {
        let y = -(-2.0 * span).exp_m1();
        if y == 0.0 {
            return Claimed::new(0.0, 0.0);
        }
        let value = y.powf(power) * (-2.0 * span * self.nu).exp();
        // The logarithms differ by the rounding of y, of the exponents and of span.
        Claimed::new(value, ROUNDING * (3.0 + 2.0 * power + power * y.ln().abs() + 4.0 * span * self.nu))
    }

    /// `e^(coefficient * logarithm)`.
    fn exponential(&self, coefficient: f64, logarithm: f64) -> Claimed {
        let exponent = coefficient * logarithm;
        Claimed::new(exponent.exp(), ROUNDING * (1.0 + exponent.abs()))
    }
}
