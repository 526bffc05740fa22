//! What the program asks of a friction law.

use std::fmt::Debug;
use std::sync::Arc;

use serde::{Serialize, Serializer};

use crate::laws::entry::{Entry, Value, serialize};
use crate::laws::history::History;

/// A law of friction of single springs: which sticks, which slips, and how hard it is held.
///
/// Only Coulomb's law is exact in the method of dimensionality reduction. The others are laws of the one-dimensional model: they hold for
/// its springs, not point by point for the surface. Solvers ask for properties of a law, never for its name.
pub trait FrictionLaw: Debug + Send + Sync {
    /// Its entry in the table of friction laws.
    fn entry(&self) -> &'static Entry<dyn FrictionLaw>;

    /// Values of the keys of the entry, in their order.
    fn values(&self) -> Vec<Value>;

    /// The law with its coefficients times `factor`.
    fn scaled(&self, factor: f64) -> Arc<dyn FrictionLaw> {
        self.entry().scaled(self.values(), factor)
    }

    /// The law and its numbers, as reports say it.
    fn words(&self) -> String;

    /// Coefficient of Coulomb's law that stands for this one in the closed form, the limits of the regimes and the dimensionless time: that of the spring
    /// at rest, and of the compression of reference.
    fn reference_coefficient(&self) -> f64;

    /// What holds a spring of compression `q`, m, while it slips, over its normal stiffness: `μ_k(q) q`, m; zero without contact.
    fn kinetic_strength(&self, compression: f64) -> f64;

    /// Derivative of [`FrictionLaw::kinetic_strength`] by the compression; zero without contact.
    ///
    /// At `q = 0` it is infinite for a negative exponent of the load.
    fn kinetic_strength_slope(&self, compression: f64) -> f64;

    /// Compression, m, at which a spring that sticks bears `strength`, m: the inverse of [`FrictionLaw::static_strength`].
    fn compression_at(&self, strength: f64) -> f64;

    /// What a spring of compression `q`, m, that sticks can bear at most, over its normal stiffness: `μ_s(q) q`, m; zero without contact.
    fn static_strength(&self, compression: f64) -> f64 {
        self.kinetic_strength(compression)
    }

    /// Static over kinetic strength, at least one, the same at every compression.
    fn static_factor(&self) -> f64 {
        1.0
    }

    /// The coefficient, where there is one whatever the load and the slip.
    fn coefficient(&self) -> Option<f64> {
        None
    }

    /// What the law differs by, at most and relatively, from Coulomb's with its reference coefficient; infinite where that is not small.
    ///
    /// # Arguments
    /// * `indentation` -- `d`, m
    fn departure(&self, _indentation: f64) -> f64 {
        f64::INFINITY
    }

    /// Factor on its coefficients along the energy that friction has dissipated per area of the first contact, J/m².
    fn along_energy(&self) -> History {
        History::Constant
    }

    /// The mean of static and kinetic limit over the static one: springs that have slipped slip on while they are moved each way by more than twice that mean.
    fn mean_over_static(&self) -> f64 {
        0.5 * (1.0 + self.static_factor().recip())
    }

    /// Whether a spring is held otherwise while it sticks than while it slips, so that what it does depends on what it did.
    fn remembers_slip(&self) -> bool {
        false
    }
}

impl PartialEq for dyn FrictionLaw {
    fn eq(&self, other: &Self) -> bool {
        self.entry().name == other.entry().name && self.values() == other.values()
    }
}

impl Serialize for dyn FrictionLaw {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serialize(self.entry(), &self.values(), serializer)
    }
}
