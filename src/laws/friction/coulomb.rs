//! Coulomb's law.

use std::sync::Arc;

use serde::Serialize;

use super::law::FrictionLaw;
use crate::laws::entry::{Entry, Value};
use crate::units::{Key, Range, number};

/// `[friction.coulomb]`.
pub static ENTRY: Entry<dyn FrictionLaw> =
    Entry::new("coulomb", "Coulomb's law.", &[COEFFICIENT], |values| {
        Ok(Arc::new(Coulomb { coefficient: values.number("coefficient") }))
    });

const COEFFICIENT: Key =
    Key::number("coefficient", "Friction coefficient.").range(Range::POSITIVE).example("0.6");

/// Coulomb's law: a spring sticks while its tangential force is below `μ_f` times its normal force [S, Eq. (11)].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Coulomb {
    /// Coefficient of friction `μ_f`, positive and finite.
    pub coefficient: f64,
}

impl FrictionLaw for Coulomb {
    fn entry(&self) -> &'static Entry<dyn FrictionLaw> {
        &ENTRY
    }

    fn values(&self) -> Vec<Value> {
        vec![self.coefficient.into()]
    }

    fn words(&self) -> String {
        format!("Coulomb, {}", number(self.coefficient))
    }

    fn reference_coefficient(&self) -> f64 {
        self.coefficient
    }

    fn kinetic_strength(&self, compression: f64) -> f64 {
        self.coefficient * compression.max(0.0)
    }

    fn kinetic_strength_slope(&self, compression: f64) -> f64 {
        if compression < 0.0 { 0.0 } else { self.coefficient }
    }

    fn compression_at(&self, strength: f64) -> f64 {
        strength / self.coefficient
    }

    fn coefficient(&self) -> Option<f64> {
        Some(self.coefficient)
    }
}
