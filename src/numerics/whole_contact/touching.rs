//! Pressure of springs that touch and lift off within a cycle.
//!
//! The load of a spring, `B(q - lift)`, has a kink where it touches, and next to the contact edge it falls faster than cubics follow; its compression does neither. So
//! the pressure is found by what the load changes with the compression:
//!
//! ```text
//! p(t) = -(1/π) ∫_ξ^1 (η-ξ)^(ν-1) B'(q - lift) q'(η) dη
//! ```
//!
//! over the cells between nodes, on Lobatto's points, at which `B' q'` is taken for a cubic. Where compressions fall outwards, no pressure is negative. Springs that the mesh takes out of contact next to
//! the edge, where `q < 0`, count by the size of `q`, so that they wear back.

use std::f64::consts::PI;

use faer::Mat;

use super::{Coordinate, LOCAL, WholeContact, difference, lagrange};
use crate::error::Result;
use crate::numerics::quadrature::Rule;

/// Points of Lobatto's rule in a cell, from 0 to 1.
const POINTS: [f64; LOCAL] = [0.0, 0.276_393_202_250_021, 0.723_606_797_749_979, 1.0];

/// Nodes of the rules over a cell, next to the node from which it is seen as well.
const RULE: usize = 20;

/// A point of a cell, by the nodes next to it.
#[derive(Debug, Clone)]
struct Point {
    /// The first of them.
    first: usize,
    /// What they count for in a value, and in its derivative by `y`.
    value: [f64; LOCAL],
    slope: [f64; LOCAL],
}

/// Operators from the points of all cells to the inner nodes.
#[derive(Debug, Clone)]
pub struct Touching {
    points: Vec<Point>,
    /// Shape `(inner nodes, points)`.
    kernel: Mat<f64>,
}

impl Touching {
    /// Of a mesh on cubics.
    ///
    /// # Errors
    /// Those of the quadrature.
    pub fn new(mesh: &WholeContact) -> Result<Self> {
        let (inner, nu) = (mesh.inner(), mesh.nu);
        let cells = mesh.nodes.windows(2).map(|ends| (ends[0], difference(ends[1], ends[0])));
        let [plain, at_node] = [Rule::legendre(RULE)?, Rule::jacobi(RULE, 0.0, nu - 1.0)?];
        let mut points = Vec::with_capacity(POINTS.len() * inner);
        let mut kernel = Mat::zeros(inner, POINTS.len() * inner);
        for (cell, (start, width)) in cells.enumerate() {
            let at = |part: f64| Coordinate::inwards(start, -part * width);
            let first = mesh.first_of_cubic(at(0.5), mesh.nodes.len());
            points.extend(POINTS.map(|part| Point {
                first,
                value: mesh.cubics(at(part), first),
                slope: mesh.cubic_slopes(at(part), first),
            }));
            for row in 0..=cell {
                let node = mesh.nodes[row];
                let starts_there = row == cell;
                let rule = if starts_there { &at_node } else { &plain };
                for (v, w) in rule.nodes.iter().zip(&rule.weights) {
                    let distance = difference(at(*v), node);
                    let rise = mesh.rise(at(*v), node, distance);
                    let weight = if starts_there {
                        width.powf(nu) / nu * w * (rise / distance).powf(nu - 1.0)
                    } else {
                        width * w * rise.powf(nu - 1.0)
                    };
                    for (i, cardinal) in cardinals(*v).into_iter().enumerate() {
                        kernel[(row, POINTS.len() * cell + i)] -= weight * cardinal / PI;
                    }
                }
            }
        }
        Ok(Self { points, kernel })
    }

    /// Points at which loads are asked for, for every inner node.
    pub const POINTS: usize = POINTS.len();

    /// `-(1/π) ∫_ξ^1 (η-ξ)^(ν-1) B'(q) q'(η) dη` at the inner nodes in each step, shape `(inner nodes, steps)`.
    ///
    /// # Arguments
    /// * `inside` -- `q`
    /// * `slopes` -- from `|q|` the `B'` of all steps
    pub fn pressure(
        &self,
        inside: &[f64],
        steps: usize,
        mut slopes: impl FnMut(f64, &mut [f64]),
    ) -> Mat<f64> {
        let mut loads = Mat::zeros(self.points.len(), steps);
        let mut at_point = vec![0.0; steps];
        for (i, point) in self.points.iter().enumerate() {
            let [size, rise] = point.of(inside);
            slopes(size, &mut at_point);
            at_point.iter().enumerate().for_each(|(m, slope)| loads[(i, m)] = rise * slope);
        }
        &self.kernel * &loads
    }

    /// The same of springs that bear in proportion to their compression, `B = (q - lift)₊`, and are lifted from one height to another in each step, over which `B'` is the mean.
    ///
    /// # Arguments
    /// * `inside` -- `q`
    /// * `lifts` -- by step, the lower one first
    pub fn pressure_in_proportion(
        &self,
        inside: &[f64],
        lifts: impl ExactSizeIterator<Item = [f64; 2]>,
    ) -> Mat<f64> {
        let inner = self.kernel.nrows();
        let mut parts: Vec<(f64, f64, usize)> = self
            .points
            .iter()
            .enumerate()
            .map(|(i, point)| {
                let [size, rise] = point.of(inside);
                (size, rise, i)
            })
            .collect();
        parts.sort_by(|one, other| other.0.total_cmp(&one.0));
        // What the points with the largest compressions make, by their number.
        let mut sums = Mat::zeros(inner, parts.len() + 1);
        for (count, (_, rise, point)) in parts.iter().enumerate() {
            for i in 0..inner {
                sums[(i, count + 1)] = sums[(i, count)] + self.kernel[(i, *point)] * rise;
            }
        }
        let mut pressure = Mat::zeros(inner, lifts.len());
        for (m, [low, high]) in lifts.enumerate() {
            let all = parts.partition_point(|it| it.0 >= high);
            let some = parts.partition_point(|it| it.0 > low);
            for i in 0..inner {
                pressure[(i, m)] = sums[(i, all)];
            }
            for (size, rise, point) in &parts[all..some] {
                let part = rise * (size - low) / (high - low);
                for i in 0..inner {
                    pressure[(i, m)] += part * self.kernel[(i, *point)];
                }
            }
        }
        pressure
    }
}

impl Point {
    /// The size of a compression and its derivative by `y`, of those at the inner nodes, with none at the edge.
    fn of(&self, inside: &[f64]) -> [f64; 2] {
        let [compression, rise] = [&self.value, &self.slope].map(|weights| -> f64 {
            weights.iter().zip(&inside[self.first..]).map(|(weight, value)| weight * value).sum()
        });
        [compression.abs(), rise]
    }
}

/// Lagrange's polynomials on the points of a cell.
fn cardinals(at: f64) -> [f64; LOCAL] {
    lagrange(|i, j| (at - POINTS[j]) / (POINTS[i] - POINTS[j]))
}

#[cfg(test)]
mod tests {
    use super::{Touching, WholeContact};

    /// Of loads in proportion to the compressions it is the pressure of the mesh.
    #[test]
    fn touching_springs_that_stay_in_contact_press_as_all_do() {
        for grading in [-0.7, -0.3, 0.0, 0.5, 0.9] {
            let mesh = WholeContact::on_cubics(grading, 24).unwrap();
            let inside: Vec<f64> = mesh.distances().map(|x| x.powf(0.7)).collect();
            let there = Touching::new(&mesh).unwrap().pressure(&inside, 1, |_, slopes| slopes.fill(1.0));
            for (i, pressure) in mesh.pressure(&inside).into_iter().enumerate() {
                let off = there[(i, 0)] / pressure - 1.0;
                assert!(off.abs() < 1e-4, "k = {grading}, node {i}: {off:e}");
            }
        }
    }

    /// Springs that bear in proportion press as by their slopes, also where they touch within a step; none presses by less than nothing.
    #[test]
    fn touching_springs_press_in_proportion_as_by_their_slopes() {
        let mesh = WholeContact::on_cubics(-0.3, 24).unwrap();
        let touching = Touching::new(&mesh).unwrap();
        let inside: Vec<f64> = mesh.distances().collect();
        let lifts = [[0.0, 0.1], [0.1, 0.35], [0.35, 0.36], [1.0, 1.1]];
        let in_proportion = touching.pressure_in_proportion(&inside, lifts.into_iter());
        let by_slopes = touching.pressure(&inside, lifts.len(), |q, slopes| {
            for ([low, high], slope) in lifts.into_iter().zip(slopes) {
                *slope = ((q - low) / (high - low)).clamp(0.0, 1.0);
            }
        });
        for m in 0..lifts.len() {
            for i in 0..mesh.inner() {
                let off = in_proportion[(i, m)] - by_slopes[(i, m)];
                assert!(off.abs() < 1e-14 && in_proportion[(i, m)] >= 0.0, "step {m}, node {i}: {off:e}");
            }
        }
    }
}
