//! What the program asks of a wear law.

use std::fmt::Debug;
use std::sync::Arc;

use serde::{Serialize, Serializer};

use super::spreading::Spreading;
use crate::laws::entry::{Entry, Value, serialize};
use crate::units::{Dimension, Key, Range};

/// A law of wear: the depth worn per slipped distance at one place of the surface. Every number is positive and finite.
///
/// Solvers ask for its properties, never for its name.
pub trait WearLaw: Debug + Send + Sync {
    /// Its entry in the table of wear laws.
    fn entry(&self) -> &'static Entry<dyn WearLaw>;

    /// Values of the keys of the entry, in their order.
    fn values(&self) -> Vec<Value>;

    /// The law with its coefficient times `factor`.
    fn scaled(&self, factor: f64) -> Arc<dyn WearLaw> {
        self.entry().scaled(self.values(), factor)
    }

    /// The law and its numbers, as reports say it.
    fn words(&self) -> String;

    /// Depth worn per slipped distance, but for [what the path makes of it](WearLaw::by_path).
    fn rate(&self, at: &Rubbing) -> Rate;

    /// The same at many places, whose pressures, Pa, are given, times a factor at each, which is zero where nothing slips.
    fn rates(&self, pressures: &[f64], factors: &[f64], mean_pressure: f64, rates: &mut [Rate]) {
        for (rate, (pressure, factor)) in rates.iter_mut().zip(pressures.iter().zip(factors)) {
            *rate = match *factor {
                0.0 => Rate::default(),
                factor => self.rate(&Rubbing { pressure: *pressure, mean_pressure }).times(factor),
            };
        }
    }

    /// The factor by which the depth per slipped distance goes with the slip path of the whole cycle, m: the power [`WearLaw::path_exponent`] of it.
    fn by_path(&self, path: f64) -> f64 {
        match self.path_exponent() {
            0.0 => 1.0,
            exponent if path > 0.0 => path.powf(exponent),
            _ => 0.0,
        }
    }

    /// Coefficient `k_w`, 1/Pa, of Archard's law that stands for this one in the closed form and the dimensionless time.
    fn reference(&self, contact: &Scales) -> f64;

    /// `k_w`, 1/Pa, where wear is in proportion to pressure and slip.
    ///
    /// # Arguments
    /// * `friction` -- the coefficient of friction, where there is one whatever the load and the slip
    fn archard_coefficient(&self, _friction: Option<f64>) -> Option<f64> {
        None
    }

    /// Worn volume over dissipated energy, 1/Pa, where they are in proportion.
    ///
    /// # Arguments
    /// * `friction` -- as in [`WearLaw::archard_coefficient`]
    fn volume_per_energy(&self, _friction: Option<f64>) -> Option<f64> {
        None
    }

    /// What a cycle wears where the rates along its slip come to `depth`, and the derivative by that; none where it is just that.
    fn of_cycle(&self, _depth: f64) -> Option<[f64; 2]> {
        None
    }

    /// Factor on all wear at an energy, J/m², that friction dissipates per cycle and area of contact; none where it is one.
    fn at_contact(&self, _energy: f64) -> Option<f64> {
        None
    }

    /// `∂ ln(rate)/∂ ln(path)` by the slip path of the cycle.
    fn path_exponent(&self) -> f64 {
        0.0
    }

    /// `∂ ln(wear)/∂ ln(slip)` of a cycle where slip is small: zero where debris comes there from elsewhere.
    fn slip_exponent(&self) -> f64 {
        if self.spreading().is_some() { 0.0 } else { 1.0 + self.path_exponent() }
    }

    /// Whether the law takes the frictional traction in place of the pressure.
    fn takes_traction(&self) -> bool {
        false
    }

    /// How the pressure is spread over the surface before the law takes it; none for a local law.
    fn spreading(&self) -> Option<Spreading> {
        None
    }

    /// Whether the rate has a kink at some pressure.
    fn has_kink(&self) -> bool {
        false
    }

    /// What the law differs by, at most and relatively, from Archard's with the same coefficient; infinite where that is not small.
    ///
    /// # Arguments
    /// * `mean_pressure` -- Pa
    /// * `slip_width` -- of the slip annulus, m
    fn departure(&self, _mean_pressure: f64, _slip_width: f64) -> f64 {
        f64::INFINITY
    }

    /// Key of the scene and reason, where the law itself may keep everything from wearing at this mean pressure, Pa.
    fn keeps_from_wearing(&self, _mean_pressure: f64) -> Option<(&'static str, String)> {
        None
    }
}

/// One place of the surface in one step of a cycle.
#[derive(Debug, Clone, Copy)]
pub struct Rubbing {
    /// What presses, Pa: pressure, or the frictional traction for a law that takes it. Round-off may make it negative.
    pub pressure: f64,
    /// Mean pressure of the unworn contact, Pa.
    pub mean_pressure: f64,
}

/// Depth worn per slipped distance.
#[derive(Debug, Clone, Copy, Default)]
pub struct Rate {
    /// The depth over the distance.
    pub depth: f64,
    /// Its derivative by the pressure, 1/Pa.
    pub by_pressure: f64,
}

impl Rate {
    fn times(self, factor: f64) -> Self {
        Self { depth: factor * self.depth, by_pressure: factor * self.by_pressure }
    }
}

/// Natural pressure, slip path and friction of a contact.
#[derive(Debug, Clone, Copy)]
pub struct Scales {
    /// `c_N a0^(k-1) d`, Pa.
    pub pressure: f64,
    /// `4 μ_f d/M`, m.
    pub path: f64,
    /// Coefficient of friction `μ_f`.
    pub friction: f64,
}

/// The coefficient of Archard's law and of laws that are his in part.
pub(super) const COEFFICIENT: Key = Key::quantity(
    "coefficient",
    Dimension::INVERSE_PRESSURE,
    "Depth per sliding distance and pressure, 1/Pa or m³/(N m).",
)
.range(Range::POSITIVE)
.example("1e-8 1/MPa");

impl PartialEq for dyn WearLaw {
    fn eq(&self, other: &Self) -> bool {
        self.entry().name == other.entry().name && self.values() == other.values()
    }
}

impl Serialize for dyn WearLaw {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serialize(self.entry(), &self.values(), serializer)
    }
}
