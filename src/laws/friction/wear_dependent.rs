//! Friction that changes with wear: from a first coefficient to a last one with the energy that was dissipated per area of contact, as bench
//! results give it.

use std::sync::Arc;

use super::law::FrictionLaw;
use crate::laws::entry::{Entry, Value};
use crate::laws::history::History;
use crate::units::{Dimension, Key, Range, number};

/// `[friction.wear-dependent]`.
pub static ENTRY: Entry<dyn FrictionLaw> = Entry::<dyn FrictionLaw>::new(
    "wear-dependent",
    "Coulomb's law with a coefficient that goes from a first to a last value as energy is dissipated.",
    &KEYS,
    |values| {
        let [first, last, energy] = KEYS.map(|key| values.number(key.name));
        Ok(Arc::new(WearDependent { first, last, energy }))
    },
)
.departs("friction that changes with the dissipated energy");

const KEYS: [Key; 3] = [
    Key::number("first_coefficient", "Coefficient of the unworn contact.")
        .range(Range::POSITIVE)
        .example("0.3"),
    Key::number("last_coefficient", "Coefficient after much wear.").range(Range::POSITIVE).example("0.6"),
    Key::quantity(
        "energy_density",
        Dimension::ENERGY_PER_AREA,
        "Energy per area of the first contact after which 1/e of the change is left, J/m².",
    )
    .range(Range::POSITIVE)
    .example("5 J/mm^2"),
];

/// `μ_f = μ_last + (μ_first - μ_last) e^(-ΣE/(A e_0))`, with the area `A = π a0²` of the first contact, at its largest indentation.
#[derive(Debug, Clone, Copy)]
pub struct WearDependent {
    /// `μ_first`, the coefficient that holds until [`FrictionLaw::along_energy`] says otherwise.
    pub first: f64,
    /// `μ_last`.
    pub last: f64,
    /// `e_0`, J/m².
    pub energy: f64,
}

impl FrictionLaw for WearDependent {
    fn entry(&self) -> &'static Entry<dyn FrictionLaw> {
        &ENTRY
    }

    fn values(&self) -> Vec<Value> {
        vec![self.first.into(), self.last.into(), self.energy.into()]
    }

    fn words(&self) -> String {
        let [first, last, energy] = [self.first, self.last, self.energy].map(number);
        format!("from {first} to {last}, by 1/e in {energy} J/m² of dissipated energy")
    }

    fn reference_coefficient(&self) -> f64 {
        self.first
    }

    fn kinetic_strength(&self, compression: f64) -> f64 {
        self.first * compression.max(0.0)
    }

    fn kinetic_strength_slope(&self, compression: f64) -> f64 {
        if compression < 0.0 { 0.0 } else { self.first }
    }

    fn compression_at(&self, strength: f64) -> f64 {
        strength / self.first
    }

    fn coefficient(&self) -> Option<f64> {
        Some(self.first)
    }

    fn along_energy(&self) -> History {
        match self.last == self.first {
            true => History::Constant,
            false => History::Exponential { last: self.last / self.first, time: self.energy },
        }
    }
}
