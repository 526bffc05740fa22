//! One indenter on half-spaces of different grading.

use super::Form;
use crate::contact::closed_form::{PowerLawVolume, gibson_wear_volume};
use crate::contact::half_space::{HalfSpace, Poisson};
use crate::contact::indenter::power_law_factor;
use crate::error::{Error, Result};

/// The power-law indenter and Poisson's ratio, which are the same for all gradings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Medium {
    exponent: f64,
    poisson: Poisson,
}

impl Medium {
    /// Largest and smallest exponent offered.
    pub const EXPONENTS: (f64, f64) = (0.1, 20.0);

    /// A comparison of half-spaces.
    ///
    /// # Arguments
    /// * `exponent` -- `n` of `f = A r^n`, from 0.1 to 20
    /// * `poisson` -- Poisson's ratio, or elastic similarity as in \[S\]
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the argument.
    pub fn new(exponent: f64, poisson: Poisson) -> Result<Self> {
        if !(Self::EXPONENTS.0..=Self::EXPONENTS.1).contains(&exponent) {
            return Err(Error::OutOfRange { name: "indenter.exponent", value: exponent, range: "[0.1, 20]" });
        }
        HalfSpace::from_modulus(0.0, 1.0, 1.0, poisson)?;
        Ok(Self { exponent, poisson })
    }

    /// `n`.
    pub fn exponent(&self) -> f64 {
        self.exponent
    }

    fn half_space(&self, grading: f64) -> Result<HalfSpace> {
        HalfSpace::from_modulus(grading, 1.0, 1.0, self.poisson)
    }

    /// `M(k)`; the limit at `k = 1`.
    pub fn stiffness_ratio(&self, grading: f64) -> f64 {
        self.poisson.stiffness_ratio(grading)
    }

    /// `c_N(k) z0^k/c_N(0)`.
    pub(super) fn relative_stiffness(&self, grading: f64) -> Result<f64> {
        Ok(self.half_space(grading)?.normal_stiffness() / self.half_space(0.0)?.normal_stiffness())
    }

    /// `κ(n,k)/κ(n,0)`: the indentation of one contact radius over that of the homogeneous contact.
    pub(super) fn relative_factor(&self, grading: f64) -> f64 {
        power_law_factor(self.exponent, grading) / power_law_factor(self.exponent, 0.0)
    }

    /// The worn volume at one grading, prepared for many amplitudes.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the grading.
    pub(super) fn at(&self, grading: f64) -> Result<Column> {
        Ok(self.column(grading, Some(PowerLawVolume::new(self.exponent, grading)?)))
    }

    /// The limit `k → 1` of the worn volume at the same indentation.
    pub(super) fn gibson(&self) -> Column {
        self.column(1.0, None)
    }

    fn column(&self, grading: f64, volume: Option<PowerLawVolume>) -> Column {
        Column {
            stiffness_ratio: self.stiffness_ratio(grading),
            area: self.relative_factor(grading).powf(-2.0 / self.exponent),
            volume,
            exponent: self.exponent,
        }
    }
}

/// Amplitudes closer to that of full sliding than this, relatively, count as full sliding: for small exponents the stick radius is next
/// to nothing there (`c/a0 = 1e-100` at `n = 0.1`).
const NEXT_TO_SLIDING: f64 = 1e-10;

/// The worn volume of one grading over the amplitude.
#[derive(Debug, Clone)]
pub(super) struct Column {
    stiffness_ratio: f64,
    /// `(a0/a_h)²` at the same indentation.
    area: f64,
    /// None in the limit `k → 1`.
    volume: Option<PowerLawVolume>,
    exponent: f64,
}

impl Column {
    /// Whether the whole contact slides.
    pub(super) fn slides(&self, amplitude_ratio: f64) -> bool {
        self.stiffness_ratio * amplitude_ratio > 1.0 - NEXT_TO_SLIDING
    }

    /// `ΔV/(π a0² d)`; not a number under full sliding.
    pub(super) fn own_volume(&self, form: Form, amplitude_ratio: f64) -> Result<f64> {
        if self.slides(amplitude_ratio) {
            return Ok(f64::NAN);
        }
        let compression = self.stiffness_ratio * amplitude_ratio;
        match (&self.volume, form) {
            (Some(volume), Form::Exact) => volume.at(compression),
            (Some(volume), Form::SmallAmplitude) => Ok(volume.small_amplitude(compression)),
            (Some(volume), Form::LeadingOrder) => Ok(volume.leading_order(compression)),
            (None, _) => Ok(gibson_wear_volume(self.exponent, compression)),
        }
    }

    /// `ΔV/(π a_h² d)` at the same indentation; not a number under full sliding.
    pub(super) fn volume(&self, form: Form, amplitude_ratio: f64) -> Result<f64> {
        Ok(self.area * self.own_volume(form, amplitude_ratio)?)
    }
}
