//! Archard's law on a pressure averaged over a length, as debris that does not leave would spread it. It leaves the paper's assumptions and
//! its limit.

use std::sync::Arc;

use super::law::{COEFFICIENT, Rate, Rubbing, Scales, WearLaw};
use super::spreading::Spreading;
use crate::laws::entry::{Entry, Value};
use crate::units::{Dimension, Key, Range, Scale, number};

/// `[wear.non-local]`.
pub static ENTRY: Entry<dyn WearLaw> = Entry::<dyn WearLaw>::new(
    "non-local",
    "Archard's law, spread over a length.",
    &[COEFFICIENT, LENGTH],
    |values| {
        Ok(Arc::new(NonLocal { coefficient: values.number("coefficient"), length: values.number("length") }))
    },
)
.departs("wear that is not local");

const LENGTH: Key = Key::quantity("length", Dimension::LENGTH, "Length over which wear spreads, m.")
    .range(Range::POSITIVE)
    .example("5 um");

/// `dw = k_w p̄ |ds|`.
#[derive(Debug, Clone, Copy)]
pub struct NonLocal {
    /// `k_w`, 1/Pa.
    pub coefficient: f64,
    /// Standard deviation of the Gaussian average along the radius, m.
    pub length: f64,
}

impl WearLaw for NonLocal {
    fn entry(&self) -> &'static Entry<dyn WearLaw> {
        &ENTRY
    }

    fn values(&self) -> Vec<Value> {
        vec![self.coefficient.into(), self.length.into()]
    }

    fn words(&self) -> String {
        let length = Scale::LENGTH.show(self.length);
        format!("Archard on the pressure averaged over {length}, {} 1/Pa", number(self.coefficient))
    }

    fn rate(&self, at: &Rubbing) -> Rate {
        Rate { depth: self.coefficient * at.pressure, by_pressure: self.coefficient }
    }

    fn reference(&self, _: &Scales) -> f64 {
        self.coefficient
    }

    fn departure(&self, _: f64, slip_width: f64) -> f64 {
        self.length / slip_width
    }

    fn spreading(&self) -> Option<Spreading> {
        Some(Spreading { length: self.length })
    }
}
