//! Chebyshev series of a smooth function on an interval, and of others on pieces of it.

mod piecewise;
mod plane;

use std::f64::consts::PI;

pub use piecewise::PiecewiseChebyshev;
pub use plane::ChebyshevPlane;

/// Largest number of terms tried.
const MOST_TERMS: usize = 256;

/// Coefficients below this fraction of the largest are round-off of the function; what is left out sums to a few times it.
const ROUND_OFF: f64 = 2e-15;

/// Places at which [`Chebyshev::values`] are found side by side.
pub const LANES: usize = 8;

/// A function on `[0, end]` as a Chebyshev series that resolves it to round-off.
#[derive(Debug, Clone)]
pub struct Chebyshev {
    end: f64,
    coefficients: Vec<f64>,
}

impl Chebyshev {
    /// Interpolates `function` on `[0, end]`, doubling the number of terms until the last ones are round-off, or there are 256; it is never called at 0.
    pub fn fit(function: impl Fn(f64) -> f64, end: f64) -> Self {
        let mut terms = 16;
        loop {
            let coefficients = Self::coefficients(&function, end, terms);
            let largest = coefficients.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
            let tail = coefficients[terms - 3..].iter().fold(0.0, |m: f64, c| m.max(c.abs()));
            if tail <= ROUND_OFF * largest || terms >= MOST_TERMS {
                let keep = coefficients
                    .iter()
                    .rposition(|c| c.abs() > 0.1 * ROUND_OFF * largest)
                    .map_or(1, |i| i + 1);
                return Self { end, coefficients: coefficients[..keep].to_vec() };
            }
            terms *= 2;
        }
    }

    fn coefficients(function: &impl Fn(f64) -> f64, end: f64, terms: usize) -> Vec<f64> {
        Self::project(&Self::nodes(end, terms).map(function).collect::<Vec<_>>())
    }

    /// Places on `[0, end]` at which as many terms are projected.
    fn nodes(end: f64, terms: usize) -> impl Iterator<Item = f64> {
        (0..terms).map(move |i| end * (0.25 * PI * (2 * i + 1) as f64 / terms as f64).cos().powi(2))
    }

    /// Coefficients of the interpolating polynomial through values at [`Chebyshev::nodes`].
    fn project(values: &[f64]) -> Vec<f64> {
        let terms = values.len();
        // cos(π m/(2n)) of m up to 4n: arguments are reduced in whole numbers, which leaves no noise in the last coefficients.
        let cosines: Vec<f64> = (0..4 * terms).map(|m| (0.5 * PI * m as f64 / terms as f64).cos()).collect();
        let projected = |j: usize| {
            let cosine = |i: usize| cosines[j * (2 * i + 1) % (4 * terms)];
            let sum: f64 = values.iter().enumerate().map(|(i, v)| v * cosine(i)).sum();
            sum * if j == 0 { 1.0 } else { 2.0 } / terms as f64
        };
        (0..terms).map(projected).collect()
    }

    /// Coefficients of the powers of `2x - 1` of the polynomial that interpolates `function` on `[0, 1]`, for few terms.
    pub fn powers<const TERMS: usize>(function: impl Fn(f64) -> f64) -> [f64; TERMS] {
        let mut powers = [0.0; TERMS];
        // T_(j+1) = 2x T_j - T_(j-1), in powers of x.
        let (mut before, mut term) = ([0.0; TERMS], [0.0; TERMS]);
        term[0] = 1.0;
        for (j, c) in Self::coefficients(&function, 1.0, TERMS).into_iter().enumerate() {
            powers.iter_mut().zip(&term).for_each(|(sum, power)| *sum += c * power);
            let factor = if j == 0 { 1.0 } else { 2.0 };
            let next = std::array::from_fn(|i| if i == 0 { 0.0 } else { factor * term[i - 1] } - before[i]);
            (before, term) = (term, next);
        }
        powers
    }

    /// Value at `x`, by Clenshaw's recurrence.
    pub fn value(&self, x: f64) -> f64 {
        let y = 2.0 * x / self.end - 1.0;
        let (mut b1, mut b2) = (0.0, 0.0);
        for &c in self.coefficients[1..].iter().rev() {
            (b1, b2) = (c + 2.0 * y * b1 - b2, b1);
        }
        self.coefficients[0] + y * b1 - b2
    }

    /// Values at some places, side by side: the recurrences of several go on while each waits for its last term. They are those of [`Chebyshev::value`] to
    /// the last bit.
    pub fn values(&self, x: &[f64; LANES]) -> [f64; LANES] {
        let y = x.map(|x| 2.0 * x / self.end - 1.0);
        let y2 = y.map(|y| 2.0 * y);
        let (mut b1, mut b2) = ([0.0; LANES], [0.0; LANES]);
        for &c in self.coefficients[1..].iter().rev() {
            let b: [f64; LANES] = std::array::from_fn(|i| c + y2[i] * b1[i] - b2[i]);
            (b1, b2) = (b, b1);
        }
        std::array::from_fn(|i| self.coefficients[0] + y[i] * b1[i] - b2[i])
    }

    /// Value and derivative at `x`, by Clenshaw's recurrence.
    pub fn value_and_derivative(&self, x: f64) -> (f64, f64) {
        let y = 2.0 * x / self.end - 1.0;
        let (mut b1, mut b2, mut d1, mut d2) = (0.0, 0.0, 0.0, 0.0);
        for &c in self.coefficients[1..].iter().rev() {
            let d = 2.0 * (b1 + y * d1) - d2;
            (d2, d1) = (d1, d);
            let b = c + 2.0 * y * b1 - b2;
            (b2, b1) = (b1, b);
        }
        (self.coefficients[0] + y * b1 - b2, (b1 + y * d1 - d2) * 2.0 / self.end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_of_an_exponential_gives_value_and_derivative_to_round_off() {
        let series = Chebyshev::fit(|x| (0.7 * x).exp(), 6.0);
        for x in [0.0, 0.1, 2.0, 5.9, 6.0f64] {
            let (value, derivative) = series.value_and_derivative(x);
            assert_eq!((value, [value; LANES]), (series.value(x), series.values(&[x; LANES])));
            let exact = (0.7 * x).exp();
            assert!((value / exact - 1.0).abs() < 3e-13, "{x}: {value} {exact}");
            assert!((derivative / (0.7 * exact) - 1.0).abs() < 1e-10, "{x}: {derivative}");
        }
    }
}
