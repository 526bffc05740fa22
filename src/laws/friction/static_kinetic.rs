//! Static and kinetic friction.

use std::sync::Arc;

use super::law::FrictionLaw;
use crate::laws::entry::{Entry, Value, Wrong};
use crate::units::{Key, Range, number};

/// `[friction.static-kinetic]`.
pub static ENTRY: Entry<dyn FrictionLaw> =
    Entry::<dyn FrictionLaw>::new("static-kinetic", "Springs are held harder while they stick than while they slip.", &KEYS, |values| {
        let [static_coefficient, kinetic_coefficient] = [values.number(KEYS[0].name), values.number(KEYS[1].name)];
        if kinetic_coefficient > static_coefficient {
            return Err(Wrong::Value {
                key: KEYS[1].name,
                why: format!(
                    "is above friction.static-kinetic.static_coefficient = {static_coefficient}; slip must not be held harder than stick"
                ),
            });
        }
        Ok(Arc::new(StaticKinetic { static_coefficient, kinetic_coefficient }))
    })
    .departs("static and kinetic friction");

const KEYS: [Key; 2] = [
    Key::number("static_coefficient", "Coefficient while a spring sticks.")
        .range(Range::POSITIVE)
        .example("0.7"),
    Key::number("kinetic_coefficient", "Coefficient while it slips, not above the static one.")
        .range(Range::POSITIVE)
        .example("0.6"),
];

/// A spring that sticks begins to slip at `μ_s q`; then `μ_k q` holds it until its slip reverses.
#[derive(Debug, Clone, Copy)]
pub struct StaticKinetic {
    /// `μ_s`, at least `μ_k`.
    pub static_coefficient: f64,
    /// `μ_k`, positive.
    pub kinetic_coefficient: f64,
}

impl FrictionLaw for StaticKinetic {
    fn entry(&self) -> &'static Entry<dyn FrictionLaw> {
        &ENTRY
    }

    fn values(&self) -> Vec<Value> {
        vec![self.static_coefficient.into(), self.kinetic_coefficient.into()]
    }

    fn words(&self) -> String {
        format!("static {}, kinetic {}", number(self.static_coefficient), number(self.kinetic_coefficient))
    }

    fn reference_coefficient(&self) -> f64 {
        self.static_coefficient
    }

    fn departure(&self, _: f64) -> f64 {
        1.0 - self.kinetic_coefficient / self.static_coefficient
    }

    fn kinetic_strength(&self, compression: f64) -> f64 {
        self.kinetic_coefficient * compression.max(0.0)
    }

    fn kinetic_strength_slope(&self, compression: f64) -> f64 {
        if compression < 0.0 { 0.0 } else { self.kinetic_coefficient }
    }

    fn compression_at(&self, strength: f64) -> f64 {
        strength / self.static_coefficient
    }

    fn static_strength(&self, compression: f64) -> f64 {
        self.static_coefficient * compression.max(0.0)
    }

    fn static_factor(&self) -> f64 {
        self.static_coefficient / self.kinetic_coefficient
    }

    fn remembers_slip(&self) -> bool {
        true
    }
}
