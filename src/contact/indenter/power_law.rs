//! Profiles that are a power of the radius, and their equivalent, which is one too.

use std::sync::Arc;

use super::Indenter;
use super::equivalent::Equivalent;
use super::shape::{Shape, positive};
use crate::error::Result;
use crate::laws::entry::Entry;
use crate::units::{Dimension, Key, Kind, Range, number};

/// `[indenter.power-law]`.
pub static ENTRY: Entry<dyn Shape> =
    Entry::<dyn Shape>::new("power-law", "f = coefficient r^exponent.", &KEYS, |values| {
        let [coefficient, exponent] = KEYS.map(|key| values.number(key.name));
        Ok(Arc::new(PowerLaw { coefficient, exponent }))
    })
    .by_exponent(KEYS[1].name, Dimension::profile_coefficient);

const KEYS: [Key; 2] = [
    Key::new("coefficient", Kind::Scaled, "Coefficient A of f = A r^n, m^(1-n).")
        .range(Range::POSITIVE)
        .example("50 1/m"),
    Key::number("exponent", "Exponent n: 1 is a cone, 2 a paraboloid.").range(Range::POSITIVE).example("2"),
];

/// `f = A r^n`.
#[derive(Debug)]
struct PowerLaw {
    /// Coefficient `A`, m^(1-n).
    coefficient: f64,
    /// Exponent `n`.
    exponent: f64,
}

impl Indenter {
    /// Power law `f = A r^n` [S, Eq. (5)], `coefficient` in m^(1-n).
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names `indenter.power-law.coefficient` or `indenter.power-law.exponent`.
    pub fn power_law(coefficient: f64, exponent: f64) -> Result<Self> {
        Ok(Self(Arc::new(PowerLaw {
            coefficient: positive("indenter.power-law.coefficient", coefficient)?,
            exponent: positive("indenter.power-law.exponent", exponent)?,
        })))
    }
}

impl Shape for PowerLaw {
    fn entry(&self) -> &'static Entry<dyn Shape> {
        &ENTRY
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.coefficient, self.exponent]
    }

    fn words(&self) -> String {
        format!("power law, {} r^{} (m)", number(self.coefficient), number(self.exponent))
    }

    fn profile(&self, r: f64) -> f64 {
        self.coefficient * r.powf(self.exponent)
    }

    fn profile_derivative(&self, r: f64) -> f64 {
        self.exponent * self.coefficient * r.powf(self.exponent - 1.0)
    }

    fn radius_at_height(&self, height: f64) -> f64 {
        (height / self.coefficient).powf(self.exponent.recip())
    }

    fn as_power_law(&self) -> Option<(f64, f64)> {
        Some((self.coefficient, self.exponent))
    }

    fn equivalent(&self, grading: f64) -> Result<Arc<dyn Equivalent>> {
        Ok(Arc::new(PowerLawEquivalent::new(self.coefficient, self.exponent, grading)))
    }
}

/// `g = κ A x^n`, which is also the relation between indentation and contact radius [S, Eqs. (7), (8)].
#[derive(Debug)]
pub(super) struct PowerLawEquivalent {
    grading: f64,
    /// `κ A`.
    coefficient: f64,
    exponent: f64,
}

impl PowerLawEquivalent {
    /// The equivalent of `f = A r^n`.
    pub(super) fn new(coefficient: f64, exponent: f64, grading: f64) -> Self {
        Self { grading, coefficient: coefficient * power_law_factor(exponent, grading), exponent }
    }
}

impl Equivalent for PowerLawEquivalent {
    fn grading(&self) -> f64 {
        self.grading
    }

    fn exponent(&self) -> Option<f64> {
        Some(self.exponent)
    }

    fn largest_radius(&self) -> f64 {
        f64::INFINITY
    }

    fn value(&self, x: f64) -> f64 {
        self.coefficient * x.powf(self.exponent)
    }

    fn derivative(&self, x: f64) -> f64 {
        self.exponent * self.coefficient * x.powf(self.exponent - 1.0)
    }

    fn rise(&self, start: f64, offset: f64) -> f64 {
        let Self { coefficient, exponent, .. } = *self;
        if offset.abs() > 0.5 * start * start {
            coefficient * ((start * start + offset).max(0.0).powf(0.5 * exponent) - start.powf(exponent))
        } else if start > 0.0 {
            self.value(start) * (0.5 * exponent * (offset / start / start).ln_1p()).exp_m1()
        } else {
            0.0
        }
    }

    fn radius_at(&self, depth: f64) -> Result<f64> {
        Ok((depth / self.coefficient).powf(self.exponent.recip()))
    }

    fn radius_squared_drop(&self, radius: f64, depth_drop: f64) -> f64 {
        -radius * radius * ((-depth_drop / self.value(radius)).ln_1p() * 2.0 / self.exponent).exp_m1()
    }

    /// `F_N/c_N = 2 κ A a^(n+1+k) n / ((1+k)(n+1+k))`.
    fn load_integral(&self, radius: f64) -> f64 {
        let (exponent, q) = (self.exponent, 1.0 + self.grading);
        2.0 * self.coefficient * exponent * radius.powf(exponent + q) / (q * (exponent + q))
    }

    fn depth_for_load(&self, load: f64) -> Result<f64> {
        let (exponent, q) = (self.exponent, 1.0 + self.grading);
        let radius =
            (load * q * (exponent + q) / (2.0 * self.coefficient * exponent)).powf((exponent + q).recip());
        Ok(self.value(radius))
    }

    fn origin(&self, radius: f64) -> f64 {
        self.value(radius)
    }

    fn rise_from(&self, origin: f64, logarithm: f64) -> f64 {
        origin * (self.exponent * logarithm).exp_m1()
    }

    fn logarithmic_slope_from(&self, origin: f64, logarithm: f64) -> f64 {
        self.exponent * origin * (self.exponent * logarithm).exp()
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
