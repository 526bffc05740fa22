//! Quantities in units that make them short.

use crate::figures::drawing::{Axis, Spacing, range_of};
use crate::report::Scale;

/// A unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measure {
    /// One of it, in SI.
    size: f64,
    symbol: &'static str,
}

impl Measure {
    /// Pure numbers.
    pub(super) const NUMBER: Self = Self { size: 1.0, symbol: "" };

    /// The largest unit of which the largest of some values has at least one.
    pub(super) fn new(scale: Scale, values: impl IntoIterator<Item = f64>) -> Self {
        let finite = values.into_iter().filter(|value| value.is_finite());
        let (size, symbol) = scale.unit(finite.fold(0.0, |largest: f64, value| largest.max(value.abs())));
        Self { size, symbol }
    }

    /// A value in SI in this unit.
    pub(super) fn of(self, value: f64) -> f64 {
        value / self.size
    }

    pub(super) fn symbol(self) -> &'static str {
        self.symbol
    }

    /// Values in SI in this unit.
    pub(super) fn all(self, values: &[f64]) -> Vec<f64> {
        values.iter().map(|value| self.of(*value)).collect()
    }

    /// An axis over values that are in this unit, with a margin of a part of their range; over 0 to 1, or 1 to 10, where there are none.
    pub(super) fn axis(
        self,
        quantity: &str,
        spacing: Spacing,
        values: impl IntoIterator<Item = f64>,
        margin: f64,
    ) -> Axis {
        let range = range_of(values, spacing, margin).unwrap_or(match spacing {
            Spacing::Linear => [0.0, 1.0],
            Spacing::Logarithmic => [1.0, 10.0],
        });
        Axis::new(quantity, self.symbol, spacing, range)
    }
}

/// Points of two rows of numbers.
pub(super) fn points(x: &[f64], y: &[f64]) -> Vec<[f64; 2]> {
    x.iter().zip(y).map(|(x, y)| [*x, *y]).collect()
}
