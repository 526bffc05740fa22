//! Archard's law above a pressure. It leaves the paper's assumptions and its limit: wear stops at that pressure.

use std::sync::Arc;

use super::law::{COEFFICIENT, Rate, Rubbing, Scales, WearLaw};
use crate::laws::entry::{Entry, Value};
use crate::units::{Dimension, Key, Range, Scale, number};

/// `[wear.threshold]`.
pub static ENTRY: Entry<dyn WearLaw> = Entry::<dyn WearLaw>::new(
    "threshold",
    "Archard's law above a pressure.",
    &[COEFFICIENT, PRESSURE],
    |values| {
        Ok(Arc::new(Threshold {
            coefficient: values.number("coefficient"),
            pressure: values.number("pressure"),
        }))
    },
)
.departs("wear above a threshold");

const PRESSURE: Key =
    Key::quantity("pressure", Dimension::PRESSURE, "Pressure below which nothing wears, Pa.")
        .range(Range::POSITIVE)
        .example("50 MPa");

/// `dw = k_w (p - p_0)₊ |ds|`.
#[derive(Debug, Clone, Copy)]
pub struct Threshold {
    /// `k_w`, 1/Pa.
    pub coefficient: f64,
    /// `p_0`, Pa.
    pub pressure: f64,
}

impl WearLaw for Threshold {
    fn entry(&self) -> &'static Entry<dyn WearLaw> {
        &ENTRY
    }

    fn values(&self) -> Vec<Value> {
        vec![self.coefficient.into(), self.pressure.into()]
    }

    fn words(&self) -> String {
        format!("Archard above {}, {} 1/Pa", Scale::PRESSURE.show(self.pressure), number(self.coefficient))
    }

    fn rate(&self, at: &Rubbing) -> Rate {
        let slope = if at.pressure > self.pressure { 1.0 } else { 0.0 };
        Rate {
            depth: self.coefficient * (at.pressure - self.pressure).max(0.0),
            by_pressure: self.coefficient * slope,
        }
    }

    fn reference(&self, _: &Scales) -> f64 {
        self.coefficient
    }

    fn departure(&self, mean_pressure: f64, _: f64) -> f64 {
        self.pressure / mean_pressure
    }

    fn has_kink(&self) -> bool {
        true
    }

    fn keeps_from_wearing(&self, mean_pressure: f64) -> Option<(&'static str, String)> {
        let why = format!(
            "{:e} Pa is not exceeded where springs slip in the first cycles, so that nothing wears (the mean pressure is {mean_pressure:e} Pa); \
             ask for less, or press harder",
            self.pressure
        );
        Some(("wear.threshold.pressure", why))
    }
}
