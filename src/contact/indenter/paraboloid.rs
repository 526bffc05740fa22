//! The paraboloid, which a ball is near its tip.

use std::sync::Arc;

use super::Indenter;
use super::equivalent::Equivalent;
use super::power_law::PowerLawEquivalent;
use super::shape::{Shape, positive};
use crate::error::Result;
use crate::laws::entry::Entry;
use crate::units::{Dimension, Key, Range, Scale};

/// `[indenter.paraboloid]`.
pub static ENTRY: Entry<dyn Shape> = Entry::new("paraboloid", "f = r²/(2R).", &[RADIUS], |values| {
    Ok(Arc::new(Paraboloid { radius: values.number(RADIUS.name) }))
});

const RADIUS: Key = Key::quantity("radius", Dimension::LENGTH, "Radius of curvature R of f = r²/(2R), m.")
    .range(Range::POSITIVE)
    .example("10 mm");

/// `f = r²/(2R)`.
#[derive(Debug)]
struct Paraboloid {
    /// Radius of curvature `R`, m.
    radius: f64,
}

impl Indenter {
    /// Paraboloid of radius of curvature `R`, m.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names `indenter.paraboloid.radius`.
    pub fn paraboloid(radius: f64) -> Result<Self> {
        Ok(Self(Arc::new(Paraboloid { radius: positive("indenter.paraboloid.radius", radius)? })))
    }
}

impl Shape for Paraboloid {
    fn entry(&self) -> &'static Entry<dyn Shape> {
        &ENTRY
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.radius]
    }

    fn words(&self) -> String {
        format!("paraboloid, radius {}", Scale::LENGTH.show(self.radius))
    }

    fn profile(&self, r: f64) -> f64 {
        0.5 * r * r / self.radius
    }

    fn profile_derivative(&self, r: f64) -> f64 {
        r / self.radius
    }

    fn radius_at_height(&self, height: f64) -> f64 {
        (2.0 * self.radius * height).sqrt()
    }

    fn as_power_law(&self) -> Option<(f64, f64)> {
        Some((0.5 / self.radius, 2.0))
    }

    fn equivalent(&self, grading: f64) -> Result<Arc<dyn Equivalent>> {
        Ok(Arc::new(PowerLawEquivalent::new(0.5 / self.radius, 2.0, grading)))
    }
}
