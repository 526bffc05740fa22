//! Chebyshev series in two variables.

use super::Chebyshev;

/// Coefficients along an edge of the rectangle that count, over the largest, terms beyond those, and most of them along a variable.
const COUNTS: f64 = 4e-15;
const MORE_TERMS: usize = 2;
const MOST_TERMS: usize = 64;

/// A smooth function of `x` in `[0, end]` and `y` in `[0, 1]` as a Chebyshev series in both, to round-off of its largest value.
#[derive(Debug, Clone)]
pub struct ChebyshevPlane {
    end: f64,
    /// Coefficients of `T_i(x) T_j(y)`, a row for each `i`.
    rows: Vec<Vec<f64>>,
}

impl ChebyshevPlane {
    /// Interpolates a function with as many terms along each variable as it takes along an edge, at `x = 0` and at `y = 1`, where it is to vary the most. It is
    /// never called at `y = 0` or at `x = end`. None if these are too many.
    pub fn fit(function: impl Fn(f64, f64) -> f64, end: f64) -> Option<Self> {
        let terms = |edge: Chebyshev| {
            let least = COUNTS * edge.coefficients.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
            edge.coefficients.iter().rposition(|c| c.abs() > least).map_or(1, |last| last + 1) + MORE_TERMS
        };
        let along_y = terms(Chebyshev::fit(|y| function(0.0, y), 1.0));
        let along_x = terms(Chebyshev::fit(|x| function(x, 1.0), end));
        if along_x.max(along_y) > MOST_TERMS {
            return None;
        }
        let at_nodes: Vec<Vec<f64>> = Chebyshev::nodes(1.0, along_y)
            .map(|y| Chebyshev::coefficients(&|x| function(x, y), end, along_x))
            .collect();
        let row = |i: usize| Chebyshev::project(&at_nodes.iter().map(|column| column[i]).collect::<Vec<_>>());
        Some(Self { end, rows: (0..along_x).map(row).collect() })
    }

    /// The series along `y` at an `x`, on `[0, length]` in place of `[0, 1]`.
    pub fn along_y(&self, x: f64, length: f64) -> Chebyshev {
        let argument = 2.0 * x / self.end - 1.0;
        let mut coefficients = vec![0.0; self.rows[0].len()];
        let (mut before, mut term) = (argument, 1.0);
        for row in &self.rows {
            coefficients.iter_mut().zip(row).for_each(|(sum, c)| *sum += term * c);
            (before, term) = (term, 2.0 * argument * term - before);
        }
        Chebyshev { end: length, coefficients }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_in_two_variables_is_its_function_to_round_off() {
        let function = |x: f64, y: f64| (0.3 * x - y).exp() / (1.2 + y * (4.0 - x));
        let plane = ChebyshevPlane::fit(function, 4.0).expect("it takes few terms");
        for x in [0.0, 0.3, 2.0, 3.999, 4.0] {
            let series = plane.along_y(x, 5.0);
            for y in [1e-9, 0.2, 0.77, 1.0] {
                let (value, exact) = (series.value(5.0 * y), function(x, y));
                assert!((value - exact).abs() < 1e-14, "{x}, {y}: {value} {exact}");
            }
        }
    }
}
