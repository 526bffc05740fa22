//! The cone.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use super::Indenter;
use super::equivalent::Equivalent;
use super::power_law::PowerLawEquivalent;
use super::shape::{Shape, positive};
use crate::error::Result;
use crate::laws::entry::{Built, Entry, Values, Wrong};
use crate::units::{Dimension, Key, Range, Rule, number};

/// `[indenter.cone]`.
pub static ENTRY: Entry<dyn Shape> =
    Entry::<dyn Shape>::new("cone", "f = r tan θ.", &KEYS, build).rules(&[Rule::OneOf(&[SLOPE, HALF_ANGLE])]);

const SLOPE: &str = "slope";
const HALF_ANGLE: &str = "half_angle";

const KEYS: [Key; 2] = [
    Key::number(SLOPE, "Slope tan θ of the flank against the surface.")
        .range(Range::POSITIVE)
        .example("0.087")
        .optional(),
    Key::quantity(HALF_ANGLE, Dimension::ANGLE, "Angle between axis and flank, rad.")
        .range(Range::POSITIVE)
        .example("85 deg")
        .optional(),
];

/// `tan θ` of the flank, or `cot α` of half the apex angle `α`, which lies between axis and flank.
fn build(values: &Values) -> Built<dyn Shape> {
    let of_angle = |angle: f64| if angle < FRAC_PI_2 { angle.tan().recip() } else { f64::NAN };
    let slope = values.optional(SLOPE).unwrap_or_else(|| of_angle(values.number(HALF_ANGLE)));
    if !slope.is_finite() {
        let range = "(0, 90 deg); it lies between axis and flank, and a number without unit is in radian";
        return Err(Wrong::Value { key: HALF_ANGLE, why: format!("is outside {range}") });
    }
    Ok(Arc::new(Cone { slope }))
}

/// `f = r tan θ`.
#[derive(Debug)]
struct Cone {
    /// Slope `tan θ` of the flank against the surface.
    slope: f64,
}

impl Indenter {
    /// Cone whose flank rises by `slope` metres per metre of radius.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names `indenter.cone.slope`.
    pub fn cone(slope: f64) -> Result<Self> {
        Ok(Self(Arc::new(Cone { slope: positive("indenter.cone.slope", slope)? })))
    }
}

impl Shape for Cone {
    fn entry(&self) -> &'static Entry<dyn Shape> {
        &ENTRY
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.slope]
    }

    fn words(&self) -> String {
        format!("cone, slope {}", number(self.slope))
    }

    fn profile(&self, r: f64) -> f64 {
        self.slope * r
    }

    fn profile_derivative(&self, _: f64) -> f64 {
        self.slope
    }

    fn radius_at_height(&self, height: f64) -> f64 {
        height / self.slope
    }

    fn as_power_law(&self) -> Option<(f64, f64)> {
        Some((self.slope, 1.0))
    }

    fn equivalent(&self, grading: f64) -> Result<Arc<dyn Equivalent>> {
        Ok(Arc::new(PowerLawEquivalent::new(self.slope, 1.0, grading)))
    }
}
