//! A function that is steep somewhere, by the part of it that a polynomial over the whole contact carries.

use super::{Coordinate, WholeContact};
use crate::error::Result;
use crate::numerics::quadrature::Rule;

/// Order `p` and strength `α` of the filter `exp(-α (n/N)^p)` of the modes: of one of second order the volume is wrong, none lets negative values swing behind a fall.
const ORDER: i32 = 8;
const STRENGTH: f64 = 8.0;

/// Panels on either side of the place where the function is steep, each narrower than the one before by a factor.
const PANELS: i32 = 14;
const NARROWER: f64 = 0.3;

impl WholeContact {
    /// Values at the inner nodes of the polynomial that comes next to a function in the mean of squares over `y`, its highest modes filtered. Means stay, as that by which a volume goes:
    /// the function's own values at the nodes miss what lies between two of them.
    ///
    /// The modes are `(1-y) P_n^(2,0)(2y-1)`, `P_n^(2,0)` Jacobi polynomials, which are orthogonal and zero at the edge, with squares of the mean `1/(2n+3)`.
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
