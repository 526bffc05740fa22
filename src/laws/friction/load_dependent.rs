//! Friction by a power of the load.

use std::sync::Arc;

use super::law::FrictionLaw;
use crate::laws::entry::{Entry, Value};
use crate::units::{Dimension, Key, Range, Scale, number};

/// `[friction.load-dependent]`.
pub static ENTRY: Entry<dyn FrictionLaw> = Entry::<dyn FrictionLaw>::new(
    "load-dependent",
    "Coefficient (q/reference)^exponent of the compression q of a spring.",
    &KEYS,
    |values| {
        Ok(Arc::new(LoadDependent {
            coefficient: values.number("coefficient"),
            exponent: values.number("exponent"),
            reference: values.optional(REFERENCE).unwrap_or(values.contact.indentation),
        }))
    },
)
.departs("friction that depends on the load")
.refers(|values| values.lacks(REFERENCE));

const REFERENCE: &str = "reference_compression";

const KEYS: [Key; 3] = [
    Key::number("coefficient", "Coefficient at the reference compression.")
        .range(Range::POSITIVE)
        .example("0.6"),
    Key::number("exponent", "Exponent; 0 is Coulomb's law.")
        .range(Range { from: (-1.0, false), ..Range::ANY })
        .because(
            "μ_f(q) q must increase with the compression q, or springs would stick inside others that slip",
        )
        .example("-0.2"),
    Key::quantity(REFERENCE, Dimension::LENGTH, "Compression of reference, m; by default the indentation.")
        .range(Range::POSITIVE)
        .example("1 um")
        .optional(),
];

/// `μ_f(q) = μ_0 (q/q_0)^m` of a spring of compression `q`.
///
/// ```
/// use fretwear::laws::friction::{FrictionLaw, LoadDependent};
///
/// let law = LoadDependent { coefficient: 0.5, exponent: -0.5, reference: 4.0 };
/// assert_eq!(law.static_strength(1.0), 1.0); // μ_f = 0.5 · (1/4)^(-1/2)
/// assert_eq!(law.static_strength(-1.0), 0.0);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct LoadDependent {
    /// `μ_0`, positive.
    pub coefficient: f64,
    /// `m > -1`, of either sign: then `μ_f(q) q` increases, without which no spring sticks inside one that slips.
    pub exponent: f64,
    /// `q_0`, m, positive.
    pub reference: f64,
}

impl FrictionLaw for LoadDependent {
    fn entry(&self) -> &'static Entry<dyn FrictionLaw> {
        &ENTRY
    }

    fn values(&self) -> Vec<Value> {
        vec![self.coefficient.into(), self.exponent.into(), self.reference.into()]
    }

    fn words(&self) -> String {
        let reference = Scale::LENGTH.show(self.reference);
        format!("{} (q/{reference})^{}", number(self.coefficient), number(self.exponent))
    }

    fn reference_coefficient(&self) -> f64 {
        self.coefficient
    }

    /// `|m|` times the logarithms of the compressions that bear most of the load.
    fn departure(&self, indentation: f64) -> f64 {
        self.exponent.abs() * (1.0 + (indentation / self.reference).ln().abs())
    }

    fn kinetic_strength(&self, compression: f64) -> f64 {
        let relative = compression.max(0.0) / self.reference;
        self.coefficient * self.reference * relative.powf(1.0 + self.exponent)
    }

    fn kinetic_strength_slope(&self, compression: f64) -> f64 {
        if compression < 0.0 {
            return 0.0;
        }
        self.coefficient * (1.0 + self.exponent) * (compression / self.reference).powf(self.exponent)
    }

    fn compression_at(&self, strength: f64) -> f64 {
        let relative = strength / (self.coefficient * self.reference);
        self.reference * relative.powf((1.0 + self.exponent).recip())
    }
}
