//! Archard's law: depth in proportion to pressure and slip.

use std::sync::Arc;

use serde::Serialize;

use super::law::{COEFFICIENT, Rate, Rubbing, Scales, WearLaw};
use crate::laws::entry::{Entry, Value};
use crate::units::number;

/// `[wear.archard]`.
pub static ENTRY: Entry<dyn WearLaw> = Entry::new("archard", "Archard's law.", &[COEFFICIENT], |values| {
    Ok(Arc::new(Archard { coefficient: values.number("coefficient") }))
});

/// `dw = k_w p |ds|`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Archard {
    /// Wear coefficient `k_w`, 1/Pa, positive and finite; the same number as the volume per load and distance in m³/(N m).
    ///
    /// It is the coefficient with a dimension: Archard's dimensionless one divided by the hardness.
    pub coefficient: f64,
}

impl WearLaw for Archard {
    fn entry(&self) -> &'static Entry<dyn WearLaw> {
        &ENTRY
    }

    fn values(&self) -> Vec<Value> {
        vec![self.coefficient.into()]
    }

    fn words(&self) -> String {
        format!("Archard, {} 1/Pa", number(self.coefficient))
    }

    fn rate(&self, at: &Rubbing) -> Rate {
        Rate { depth: self.coefficient * at.pressure, by_pressure: self.coefficient }
    }

    fn reference(&self, _: &Scales) -> f64 {
        self.coefficient
    }

    fn archard_coefficient(&self, _: Option<f64>) -> Option<f64> {
        Some(self.coefficient)
    }

    fn volume_per_energy(&self, friction: Option<f64>) -> Option<f64> {
        friction.map(|friction| self.coefficient / friction)
    }
}
