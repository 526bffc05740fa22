//! The transforms of Eqs. (20) and (21) over a whole contact, from the axis to its edge, for polynomials on nodes that move with the edge.
//!
//! With `s = x² = A ξ`, `A = a²`, both depend on `A` by a power alone:
//!
//! ```text
//! F q (t) = (sin πν/π) ∫_0^t s^(ν-1) q(s) (t-s)^(-ν) ds,          p(t) = -(c_N/π) A^(ν-1) ∫_ξ^1 (η-ξ)^(ν-1) q'(η) dη
//! ```
//!
//! Values are a polynomial in `y`, `√ξ = [1 - (1-y)^m]²`: smooth at the tip of any power law, and with `m = 2` at the edge both for the first contact,
//! `q ~ 1-ξ`, and under uniform pressure, `q ~ (1-ξ)^μ`, `k = 0`. Nodes are zeros of a Jacobi polynomial, denser towards the edge, where ground comes in.

use std::f64::consts::PI;

use faer::Mat;

use super::linear::{Factors, dot};
use super::quadrature::Rule;
use super::roots::bracketed;
use crate::error::Result;

/// Jacobi exponent of the nodes at the edge: with one of 1 and more the last node lies too far inside, pressure there turns negative and grows.
const AT_EDGE: f64 = -0.5;

/// Exponent `m` for `k >= 0`: more grading makes pressure at the edge grow. Below it is `2/(1-k)`, with which uniform pressure, `q ~ (1-ξ)^((1-k)/2)`, is a
/// polynomial.
const POWER: f64 = 2.0;

/// Grading below which it is `2 + 0.9 k`: there something else is off by more, which the balance of energy shows on cells that fine alone.
const SOFT: f64 = -0.6;
const FALL: f64 = 0.9;

/// Nodes up to which the largest exponent holds; of more it falls, so that the last cell, of width `N^(-2m)`, is no narrower.
const NODES_OF_POWER: f64 = 24.0;

/// Nodes of the rules on a panel beside half of those of the polynomial.
const BEYOND_DEGREE: usize = 16;

/// Width of the last of the panels, each half as wide as the one before, over which an end that is not analytic is integrated.
const LAST_PANEL: f64 = 1e-7;

/// A radius by the coordinate `y` of the mesh, from 0 on the axis to 1 at the edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinate {
    y: f64,
    /// `1 - y`, to full relative accuracy.
    h: f64,
}

impl Coordinate {
    fn inwards(from: Self, distance: f64) -> Self {
        Self { y: from.y - distance, h: from.h + distance }
    }
}

/// Operators on the values at nodes, of which the last is the edge.
#[derive(Debug, Clone)]
pub struct WholeContact {
    /// `ν = (1+k)/2`.
    nu: f64,
    /// `m`.
    power: f64,
    /// The inner nodes, outwards, and the edge.
    nodes: Vec<Coordinate>,
    /// Barycentric weights.
    weights: Vec<f64>,
    /// `ξ` of the nodes.
    fractions: Vec<f64>,
    profile: Mat<f64>,
    inverse: Factors,
    pressure: Mat<f64>,
    derivative: Mat<f64>,
    load: Vec<f64>,
    area: Vec<f64>,
}

impl WholeContact {
    /// Operators for a grading, on so many nodes inside the edge.
    ///
    /// # Errors
    /// Those of the quadrature.
    pub fn new(grading: f64, inner: usize) -> Result<Self> {
        let most = POWER * NODES_OF_POWER.ln() / (inner as f64).ln();
        let at_edge = if grading < SOFT { POWER + FALL * grading } else { POWER / (1.0 - grading.min(0.0)) };
        let power = at_edge.min(most).max(1.0);
        let zeros = Rule::jacobi(inner, AT_EDGE, 0.0)?;
        let mut nodes: Vec<Coordinate> =
            zeros.nodes.iter().zip(&zeros.complements).map(|(y, h)| Coordinate { y: *y, h: *h }).collect();
        nodes.push(Coordinate { y: 1.0, h: 0.0 });
        // The factor keeps the products representable.
        let weights = (0..=inner).map(|i| {
            let others = (0..=inner).filter(|j| *j != i);
            others.map(|j| 4.0 * difference(nodes[i], nodes[j])).product::<f64>().recip()
        });
        let mut it = Self {
            nu: 0.5 * (1.0 + grading),
            power,
            weights: weights.collect(),
            fractions: vec![],
            profile: Mat::zeros(inner + 1, inner),
            inverse: Factors::new(Mat::identity(1, 1)),
            pressure: Mat::zeros(inner, inner),
            derivative: Mat::zeros(inner, inner + 1),
            load: vec![],
            area: vec![],
            nodes,
        };
        it.fractions = it.nodes.iter().map(|coordinate| it.fraction(*coordinate)).collect();
        let slopes = it.slopes();
        it.fill_profile()?;
        it.fill_pressure(&slopes)?;
        for i in 0..inner {
            let node = it.nodes[i];
            let over_slope = it.root(node) / (4.0 * it.power * node.h.powf(it.power - 1.0));
            for j in 0..=inner {
                it.derivative[(i, j)] = over_slope * slopes[(i, j)];
            }
        }
        it.load = it.integral(it.nu)?;
        it.load.truncate(inner);
        it.area = it.integral(1.0)?;
        it.inverse = Factors::new(it.profile.subrows(0, inner).to_owned());
        Ok(it)
    }

    /// Nodes inside the edge.
    pub fn inner(&self) -> usize {
        self.nodes.len() - 1
    }

    /// `ξ` at the nodes, the edge included.
    pub fn fractions(&self) -> &[f64] {
        &self.fractions
    }

    /// `1 - ξ` at the inner nodes, to full relative accuracy.
    pub fn distances(&self) -> impl Iterator<Item = f64> {
        let (edge, inner) = (self.nodes[self.inner()], &self.nodes[..self.inner()]);
        inner.iter().map(move |node| self.rise(edge, *node, node.h))
    }

    /// `F q` at the nodes, of `q` inside, which is zero at the edge.
    pub fn profile(&self, inside: &[f64]) -> Vec<f64> {
        product(&self.profile, inside)
    }

    /// `q` inside whose `F q` has these values at the inner nodes, in their place.
    pub fn solve_profile(&self, values: &mut [f64]) {
        self.inverse.solve(values);
    }

    /// `F q` at the edge.
    pub fn profile_at_edge(&self, inside: &[f64]) -> f64 {
        (0..self.inner()).map(|j| self.profile[(self.inner(), j)] * inside[j]).sum()
    }

    /// `-(1/π) ∫_ξ^1 (η-ξ)^(ν-1) q'(η) dη` at the inner nodes.
    pub fn pressure(&self, inside: &[f64]) -> Vec<f64> {
        product(&self.pressure, inside)
    }

    /// `ξ du/dξ` at the inner nodes, of values at all nodes.
    pub fn dilation(&self, values: &[f64]) -> Vec<f64> {
        product(&self.derivative, values)
    }

    /// `∫_0^1 ξ^(ν-1) q dξ` of values inside.
    pub fn load(&self, inside: &[f64]) -> f64 {
        dot(&self.load, inside)
    }

    /// Weights of [`WholeContact::load`].
    pub fn load_weights(&self) -> &[f64] {
        &self.load
    }

    /// `∫_0^1 w dξ` of values at all nodes.
    pub fn area(&self, values: &[f64]) -> f64 {
        dot(&self.area, values)
    }

    /// The coordinate with a fraction `ξ` from 0 to 1 of the contact's area.
    pub fn coordinate(&self, fraction: f64) -> Coordinate {
        let root = fraction.sqrt().sqrt();
        let h = (-root).ln_1p() / self.power;
        Coordinate { y: -h.exp_m1(), h: h.exp() }
    }

    /// `ξ` at a coordinate.
    pub fn fraction(&self, coordinate: Coordinate) -> f64 {
        self.root(coordinate).powi(4)
    }

    /// Value at a coordinate of a polynomial that is given at all nodes.
    pub fn value(&self, values: &[f64], coordinate: Coordinate) -> f64 {
        dot(&self.cardinals(coordinate), values)
    }

    /// Value at a coordinate of the polynomial through the inner nodes alone.
    pub fn value_inside(&self, inside: &[f64], coordinate: Coordinate) -> f64 {
        // Weights without the edge, of which the distance is what they lack.
        let mut sums = [0.0; 2];
        for ((node, weight), value) in self.nodes.iter().zip(&self.weights).zip(inside) {
            let away = difference(coordinate, *node);
            if away == 0.0 {
                return *value;
            }
            let share = weight * node.h / away;
            sums = [sums[0] + share * value, sums[1] + share];
        }
        sums[0] / sums[1]
    }

    /// Outermost coordinate at which values inside exceed `level`, if they do on the axis or at a node.
    pub fn last_above(&self, inside: &[f64], level: f64) -> Option<Coordinate> {
        let mut values = inside.to_vec();
        values.push(0.0);
        let axis = Coordinate { y: 0.0, h: 1.0 };
        let above = (0..inside.len()).rev().find(|i| inside[*i] > level);
        let low = above.map_or(axis, |i| self.nodes[i]);
        let high = self.nodes[above.map_or(0, |i| i + 1)];
        let between =
            |part: f64| Coordinate { y: low.y + part * (high.y - low.y), h: low.h + part * (high.h - low.h) };
        let excess = |part: f64| self.value(&values, between(part)) - level;
        if excess(0.0) <= 0.0 {
            return None;
        }
        bracketed(excess, 0.0, 1.0, 0.0).ok().map(between)
    }

    /// Nodes `ξ_g` and weights of `∫_0^ξ(end) ξ^(ν-1) e(ξ) dξ`, with the values there of what is given inside.
    ///
    /// # Errors
    /// Those of the quadrature.
    pub fn up_to(&self, end: Coordinate, inside: &[f64]) -> Result<Vec<[f64; 3]>> {
        let mut values = inside.to_vec();
        values.push(0.0);
        let panel = self.panel_at_axis(end, self.nu)?;
        Ok(panel
            .into_iter()
            .map(|(coordinate, weight)| [self.fraction(coordinate), weight, self.value(&values, coordinate)])
            .collect())
    }

    /// `√√ξ = 1 - h^m`.
    fn root(&self, coordinate: Coordinate) -> f64 {
        let log = if coordinate.y < 0.5 { (-coordinate.y).ln_1p() } else { coordinate.h.ln() };
        -(self.power * log).exp_m1()
    }

    /// `ξ(outer) - ξ(inner)` of places a distance apart.
    fn rise(&self, outer: Coordinate, inner: Coordinate, distance: f64) -> f64 {
        let of_roots = if outer.h == 0.0 {
            inner.h.powf(self.power)
        } else {
            outer.h.powf(self.power) * (self.power * (distance / outer.h).ln_1p()).exp_m1()
        };
        let low = self.root(inner);
        let high = low + of_roots;
        of_roots * (low + high) * (low * low + high * high)
    }

    /// Values of the cardinal polynomials.
    fn cardinals(&self, coordinate: Coordinate) -> Vec<f64> {
        if let Some(at) = self.nodes.iter().position(|node| difference(coordinate, *node) == 0.0) {
            return (0..self.nodes.len()).map(|j| if j == at { 1.0 } else { 0.0 }).collect();
        }
        let mut cardinals: Vec<f64> =
            self.nodes.iter().zip(&self.weights).map(|(node, w)| w / difference(coordinate, *node)).collect();
        let sum: f64 = cardinals.iter().sum();
        cardinals.iter_mut().for_each(|value| *value /= sum);
        cardinals
    }

    /// Derivatives by `y` at the nodes.
    fn slopes(&self) -> Mat<f64> {
        let n = self.nodes.len();
        let mut slopes = Mat::from_fn(n, n, |i, j| {
            if i == j {
                0.0
            } else {
                self.weights[j] / self.weights[i] / difference(self.nodes[i], self.nodes[j])
            }
        });
        for i in 0..n {
            let sum: f64 = (0..n).map(|j| slopes[(i, j)]).sum();
            slopes[(i, i)] = -sum;
        }
        slopes
    }

    fn rule_size(&self) -> usize {
        self.nodes.len() / 2 + BEYOND_DEGREE
    }

    /// Places and weights of `∫_0^ξ(end) ξ^(exponent-1) ... dξ`.
    fn panel_at_axis(&self, end: Coordinate, exponent: f64) -> Result<Vec<(Coordinate, f64)>> {
        let lower = 4.0 * exponent - 1.0;
        let rule = Rule::jacobi(self.rule_size(), 0.0, lower)?;
        let scale = end.y.powf(4.0 * exponent) / exponent * self.power;
        Ok(rule
            .nodes
            .iter()
            .zip(&rule.weights)
            .map(|(v, w)| {
                let coordinate = Coordinate { y: end.y * v, h: 1.0 - end.y * v };
                let smooth =
                    (self.root(coordinate) / coordinate.y).powf(lower) * coordinate.h.powf(self.power - 1.0);
                (coordinate, scale * w * smooth)
            })
            .collect())
    }

    /// Rows of `F`: `(sin πν/π) ∫ ξ^(ν-1) (ξ_t - ξ)^(-ν) ξ_y ℓ_j dy` up to each node.
    fn fill_profile(&mut self) -> Result<()> {
        let (nu, size) = (self.nu, self.rule_size());
        let plain = Rule::legendre(size)?;
        let prefactor = (PI * nu).sin() / PI;
        for row in 0..self.nodes.len() {
            let end = self.nodes[row];
            let half = 0.5 * end.y;
            let mut sum = vec![0.0; self.nodes.len()];
            let mut add = |coordinate: Coordinate, weight: f64| {
                for (sum, value) in sum.iter_mut().zip(self.cardinals(coordinate)) {
                    *sum += prefactor * weight * value;
                }
            };
            for (coordinate, weight) in self.panel_at_axis(Coordinate::inwards(end, half), nu)? {
                add(coordinate, weight * self.rise(end, coordinate, end.y - coordinate.y).powf(-nu));
            }
            // Near the node, at a distance below that of the edge first: 1 - √√ξ is a power of the distance from there.
            let slope =
                |coordinate: Coordinate| 4.0 * self.root(coordinate).powf(4.0 * nu - 1.0) * self.power;
            let (first, at_node) = if end.h == 0.0 {
                (LAST_PANEL, self.power * (1.0 - nu) - 1.0)
            } else {
                (end.h.min(half), -nu)
            };
            let rule = Rule::jacobi(size, 0.0, at_node)?;
            for (v, w) in rule.nodes.iter().zip(&rule.weights) {
                let distance = first * v;
                let coordinate = Coordinate::inwards(end, distance);
                let kernel =
                    self.rise(end, coordinate, distance).powf(-nu) * coordinate.h.powf(self.power - 1.0);
                let scale = first.powf(at_node + 1.0) / (at_node + 1.0);
                add(coordinate, scale * w * slope(coordinate) * kernel * distance.powf(-at_node));
            }
            let mut from = first;
            while from < half {
                let to = (2.0 * from).min(half);
                for (v, w) in plain.nodes.iter().zip(&plain.weights) {
                    let distance = from + (to - from) * v;
                    let coordinate = Coordinate::inwards(end, distance);
                    let kernel =
                        self.rise(end, coordinate, distance).powf(-nu) * coordinate.h.powf(self.power - 1.0);
                    add(coordinate, (to - from) * w * slope(coordinate) * kernel);
                }
                from = to;
            }
            for (j, value) in sum.into_iter().take(self.inner()).enumerate() {
                self.profile[(row, j)] = value;
            }
        }
        Ok(())
    }

    /// Rows of the pressure: `-(1/π) ∫ (ξ - ξ_t)^(ν-1) ℓ_j' dy` from each inner node to the edge.
    fn fill_pressure(&mut self, slopes: &Mat<f64>) -> Result<()> {
        let (nu, size) = (self.nu, self.rule_size());
        let plain = Rule::legendre(size)?;
        let at_node = Rule::jacobi(size, 0.0, nu - 1.0)?;
        for row in 0..self.inner() {
            let start = self.nodes[row];
            let half = 0.5 * start.h;
            let mut sum = vec![0.0; self.nodes.len()];
            let mut add = |coordinate: Coordinate, weight: f64| {
                for (sum, value) in sum.iter_mut().zip(self.cardinals(coordinate)) {
                    *sum -= weight * value / PI;
                }
            };
            let first = start.y.min(half);
            for (v, w) in at_node.nodes.iter().zip(&at_node.weights) {
                let distance = first * v;
                let coordinate = Coordinate::inwards(start, -distance);
                let kernel = (self.rise(coordinate, start, distance) / distance).powf(nu - 1.0);
                add(coordinate, first.powf(nu) / nu * w * kernel);
            }
            let mut panels = vec![];
            let mut from = first;
            while from < half {
                let to = (2.0 * from).min(half);
                panels.push([from, to]);
                from = to;
            }
            // Towards the edge, where ξ is a power of the distance.
            let mut left = half;
            while left > LAST_PANEL * start.h {
                panels.push([start.h - left, start.h - 0.5 * left]);
                left *= 0.5;
            }
            panels.push([start.h - left, start.h]);
            for [from, to] in panels {
                for (v, w) in plain.nodes.iter().zip(&plain.weights) {
                    let distance = from + (to - from) * v;
                    let coordinate = Coordinate::inwards(start, -distance);
                    add(coordinate, (to - from) * w * self.rise(coordinate, start, distance).powf(nu - 1.0));
                }
            }
            for j in 0..self.inner() {
                self.pressure[(row, j)] = (0..sum.len()).map(|i| sum[i] * slopes[(i, j)]).sum();
            }
        }
        Ok(())
    }

    /// Weights of `∫_0^1 ξ^(exponent-1) ... dξ`.
    fn integral(&self, exponent: f64) -> Result<Vec<f64>> {
        let lower = 4.0 * exponent - 1.0;
        let rule = Rule::jacobi(self.nodes.len() + BEYOND_DEGREE, self.power - 1.0, lower)?;
        let mut sum = vec![0.0; self.nodes.len()];
        let mut whole = 0.0;
        for ((v, complement), w) in rule.nodes.iter().zip(&rule.complements).zip(&rule.weights) {
            let coordinate = Coordinate { y: *v, h: *complement };
            let weight = w * (self.root(coordinate) / v).powf(lower);
            whole += weight;
            for (sum, value) in sum.iter_mut().zip(self.cardinals(coordinate)) {
                *sum += weight * value;
            }
        }
        // Of one it is 1/exponent.
        sum.iter_mut().for_each(|value| *value /= whole * exponent);
        Ok(sum)
    }
}

/// `y - y_other`, by the distances from the nearer end.
fn difference(one: Coordinate, other: Coordinate) -> f64 {
    if one.y + other.y < 1.0 { one.y - other.y } else { other.h - one.h }
}

fn product(matrix: &Mat<f64>, values: &[f64]) -> Vec<f64> {
    let mut to = vec![0.0; matrix.nrows()];
    super::linear::multiply(matrix.as_ref(), values, &mut to);
    to
}
