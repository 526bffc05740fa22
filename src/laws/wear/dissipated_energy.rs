//! Wear in proportion to the energy that friction dissipates at the place, which under Coulomb's law is Archard's law.

use std::sync::Arc;

use super::law::{Rate, Rubbing, Scales, WearLaw};
use crate::laws::entry::{Entry, Value};
use crate::units::{Dimension, Key, Range, number};

/// `[wear.dissipated-energy]`.
pub static ENTRY: Entry<dyn WearLaw> = Entry::new(
    "dissipated-energy",
    "Volume by the energy that friction dissipates.",
    &[COEFFICIENT],
    |values| Ok(Arc::new(DissipatedEnergy { coefficient: values.number("coefficient") })),
);

const COEFFICIENT: Key =
    Key::quantity("coefficient", Dimension::INVERSE_PRESSURE, "Volume per energy, m³/J.")
        .range(Range::POSITIVE)
        .unit("m3 J-1")
        .example("2e-5 mm^3/J");

/// Wear by energy.
///
/// ```text
/// dw = α τ |ds|,     τ = μ_f p     →     k_w = α μ_f
/// ```
#[derive(Debug, Clone, Copy)]
pub struct DissipatedEnergy {
    /// `α`, volume worn per energy dissipated, m³/J.
    pub coefficient: f64,
}

impl WearLaw for DissipatedEnergy {
    fn entry(&self) -> &'static Entry<dyn WearLaw> {
        &ENTRY
    }

    fn values(&self) -> Vec<Value> {
        vec![self.coefficient.into()]
    }

    fn words(&self) -> String {
        format!("dissipated energy, {} m³/J", number(self.coefficient))
    }

    fn rate(&self, at: &Rubbing) -> Rate {
        Rate { depth: self.coefficient * at.pressure, by_pressure: self.coefficient }
    }

    fn reference(&self, contact: &Scales) -> f64 {
        self.coefficient * contact.friction
    }

    fn archard_coefficient(&self, friction: Option<f64>) -> Option<f64> {
        friction.map(|friction| self.coefficient * friction)
    }

    fn volume_per_energy(&self, _: Option<f64>) -> Option<f64> {
        Some(self.coefficient)
    }

    fn takes_traction(&self) -> bool {
        true
    }
}
