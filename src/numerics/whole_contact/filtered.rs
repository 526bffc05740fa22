//! A function that is steep somewhere, by the part of it that a polynomial over the whole contact carries.

use super::{Coordinate, WholeContact};
use crate::error::Result;
use crate::numerics::quadrature::Rule;

/// Order `p` and strength `α` of the filter `exp(-α (n/N)^p)` of the modes. A filter of second order changes the volume; without one values swing below zero behind a fall.
const ORDER: i32 = 8;
const STRENGTH: f64 = 8.0;

/// Panels on either side of the place where the function is steep, each narrower than the one before by a factor.
const PANELS: i32 = 14;
const NARROWER: f64 = 0.3;

impl WholeContact {
    /// Values at the inner nodes of the polynomial that is nearest to a function in the mean of squares over `y`, with its highest modes filtered. Means, such as that by which a volume goes, stay as they are;
    /// the function's own values at the nodes miss what lies between two of them.
    ///
    /// The modes are `(1-y) P_n^(2,0)(2y-1)`, `P_n^(2,0)` Jacobi polynomials, which are orthogonal and zero at the edge; the means of their squares are `1/(2n+3)`.
    ///
    /// # Arguments
    /// * `steep` -- where it is steep, a fraction `ξ` of the area
    /// * `value` -- of such a fraction; zero at the edge
    ///
    /// # Errors
    /// Those of the quadrature.
    pub fn filtered(&self, steep: f64, value: impl Fn(f64) -> f64) -> Result<Vec<f64>> {
        let inner = self.inner();
        let mut parts = vec![0.0; inner];
        for (coordinate, weight) in self.places_around(self.coordinate(steep))? {
            let weighted = weight * value(self.fraction(coordinate));
            for (part, mode) in parts.iter_mut().zip(modes(coordinate)) {
                *part += weighted * mode;
            }
        }
        for (n, part) in parts.iter_mut().enumerate() {
            let fineness = n as f64 / inner as f64;
            *part *= (2 * n + 3) as f64 * (-STRENGTH * fineness.powi(ORDER)).exp();
        }
        let at = |node: &Coordinate| parts.iter().zip(modes(*node)).map(|(part, mode)| part * mode).sum();
        Ok(self.nodes[..inner].iter().map(at).collect())
    }

    /// Places and weights of `∫_0^1 ... dy`, close together around one of them.
    fn places_around(&self, steep: Coordinate) -> Result<Vec<(Coordinate, f64)>> {
        let rule = Rule::legendre(self.rule_size())?;
        let distance = |i: i32| if i < PANELS { NARROWER.powi(i) } else { 0.0 };
        let mut places = vec![];
        for width in [-steep.y, steep.h] {
            for [far, near] in (0..PANELS).map(|i| [distance(i), distance(i + 1)].map(|part| width * part)) {
                for (v, w) in rule.nodes.iter().zip(&rule.weights) {
                    let place = Coordinate::inwards(steep, -(near + (far - near) * v));
                    places.push((place, (far - near).abs() * w));
                }
            }
        }
        Ok(places)
    }
}

/// `(1-y) P_n^(2,0)(2y-1)` for all `n` from 0 on.
fn modes(place: Coordinate) -> impl Iterator<Item = f64> {
    let x = place.y - place.h;
    let following = move |[before, last]: &[f64; 2], n: f64| {
        let linear = (2.0 * n + 1.0) * (4.0 * n * (n + 1.0) * x + 4.0) * last;
        (linear - 2.0 * (n + 1.0) * (n - 1.0) * (2.0 * n + 2.0) * before) / (4.0 * n * n * (n + 2.0))
    };
    let first = ([0.0, place.h], 0.0);
    std::iter::successors(Some(first), move |(pair, n)| Some(([pair[1], following(pair, n + 1.0)], n + 1.0)))
        .map(|(pair, _)| pair[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is smooth stays; a fall keeps its mean, and what lies behind it swings by little.
    #[test]
    fn smooth_functions_and_means_stay() {
        let mesh = WholeContact::new(0.0, 40).expect("a mesh");
        let distance = |fraction: f64| mesh.coordinate(fraction).h;
        let smooth = |fraction: f64| distance(fraction) * (1.0 + distance(fraction));
        let kept = mesh.filtered(0.3, smooth).expect("a quadrature");
        for (value, fraction) in kept.iter().zip(mesh.fractions()) {
            assert!((value - smooth(*fraction)).abs() < 1e-9, "{value} at {fraction}");
        }
        let fall = mesh.filtered(0.3, |fraction| f64::from(u8::from(fraction < 0.3))).expect("a quadrature");
        let mean = |values: &[f64]| {
            let places = mesh.places_around(mesh.coordinate(0.3)).expect("a quadrature");
            places
                .iter()
                .map(|(place, weight)| weight * place.h * mesh.value_inside(values, *place))
                .sum::<f64>()
        };
        let end = 1.0 - distance(0.3);
        assert!((mean(&fall) / (end - 0.5 * end * end) - 1.0).abs() < 1e-6, "{}", mean(&fall));
        let least = fall.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(least > -0.1, "{least}");
    }
}
