//! Wear by powers of pressure and slip.

use std::sync::Arc;

use super::law::{Rate, Rubbing, Scales, WearLaw};
use crate::laws::entry::{Entry, Value};
use crate::units::{Key, Range, number};

/// `[wear.power-law]`.
pub static ENTRY: Entry<dyn WearLaw> =
    Entry::<dyn WearLaw>::new("power-law", "Depth per cycle as pressure^α slip^β.", &KEYS, |values| {
        Ok(Arc::new(PowerLaw {
            coefficient: values.number("coefficient"),
            pressure_exponent: values.number("pressure_exponent"),
            slip_exponent: values.number("slip_exponent"),
        }))
    })
    .departs("wear by a power law");

const KEYS: [Key; 3] = [
    Key::number("coefficient", "Coefficient in Pa^-α m^(1-β), a plain number.")
        .range(Range::POSITIVE)
        .example("1e-14"),
    Key::number("pressure_exponent", "Exponent α; 1 is Archard's law.").range(Range::POSITIVE).example("1"),
    Key::number("slip_exponent", "Exponent β; 1 is Archard's law.").range(Range::POSITIVE).example("1"),
];

/// Pressure, relative to the mean one of the unworn contact, below which a power law of it goes on in proportion: else wear by `p^α` with
/// `α < 1` would end at an instant, in a root.
const LEAST_PRESSURE: f64 = 1e-9;

/// `dw = k ℓ^(β-1) p^α |ds|`, with the slip path `ℓ = ∮|ds|` of the cycle: `k p^α (4s)^β` a cycle for plain tangential oscillation.
#[derive(Debug, Clone, Copy)]
pub struct PowerLaw {
    /// `k`, Pa^(-α) m^(1-β).
    pub coefficient: f64,
    /// `α`.
    pub pressure_exponent: f64,
    /// `β`.
    pub slip_exponent: f64,
}

impl WearLaw for PowerLaw {
    fn entry(&self) -> &'static Entry<dyn WearLaw> {
        &ENTRY
    }

    fn values(&self) -> Vec<Value> {
        vec![self.coefficient.into(), self.pressure_exponent.into(), self.slip_exponent.into()]
    }

    fn words(&self) -> String {
        let [pressure, slip] = [self.pressure_exponent, self.slip_exponent].map(number);
        format!("power law, {} p^{pressure} s^{slip} (SI)", number(self.coefficient))
    }

    fn rate(&self, at: &Rubbing) -> Rate {
        let (power, slope) =
            eased_power(at.pressure, self.pressure_exponent, LEAST_PRESSURE * at.mean_pressure);
        Rate { depth: self.coefficient * power, by_pressure: self.coefficient * slope }
    }

    /// The coefficient under which the time of one cycle is the natural one of this law. Numbers each allowed may give one too large or too
    /// small for a double.
    ///
    /// ```text
    /// k_w = k P^(α-1) L^(β-1),     P = c_N a0^(k-1) d,     L = 4 μ_f d/M     →     k P^α L^β/d = 4 k_w c_N a0^(k-1) μ_f d/M = τ/N
    /// ```
    fn reference(&self, contact: &Scales) -> f64 {
        let factor =
            contact.pressure.powf(self.pressure_exponent - 1.0) * contact.path.powf(self.slip_exponent - 1.0);
        self.coefficient * factor
    }

    fn departure(&self, _: f64, _: f64) -> f64 {
        let is_archard = self.pressure_exponent == 1.0 && self.slip_exponent == 1.0;
        if is_archard { 0.0 } else { f64::INFINITY }
    }

    fn path_exponent(&self) -> f64 {
        self.slip_exponent - 1.0
    }
}

/// `p^α` and its slope, odd in `p`, in proportion to `p` well below `least`.
fn eased_power(p: f64, exponent: f64, least: f64) -> (f64, f64) {
    if exponent == 1.0 {
        return (p, 1.0);
    }
    let squared = p * p + least * least;
    let power = squared.powf(0.5 * (exponent - 1.0));
    (p * power, power * (1.0 + (exponent - 1.0) * p * p / squared))
}
