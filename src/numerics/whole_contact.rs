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

mod filtered;
mod touching;

use std::f64::consts::PI;

use faer::Mat;

pub use touching::Touching;

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

/// Nodes of a local polynomial, and their exponent `m`: with one of 2 swings next to the edge grow, one of 4 leaves compressions there no digits.
const LOCAL: usize = 4;
const POWER_OF_CUBICS: f64 = 3.0;

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
    const AXIS: Self = Self { y: 0.0, h: 1.0 };

    fn inwards(from: Self, distance: f64) -> Self {
        Self { y: from.y - distance, h: from.h + distance }
    }
}

/// What is between the nodes.
#[derive(Debug, Clone)]
enum Between {
    /// One polynomial through all of them, by its barycentric weights.
    Polynomial(Vec<f64>),
    /// Cubics through the four next to a place.
    Cubics,
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
    between: Between,
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
    /// Operators for a grading on one polynomial through so many nodes inside the edge.
    ///
    /// # Errors
    /// Those of the quadrature.
    pub fn new(grading: f64, inner: usize) -> Result<Self> {
        let most = POWER * NODES_OF_POWER.ln() / (inner as f64).ln();
        let zeros = Rule::jacobi(inner, AT_EDGE, 0.0)?;
        let mut nodes: Vec<Coordinate> =
            zeros.nodes.iter().zip(&zeros.complements).map(|(y, h)| Coordinate { y: *y, h: *h }).collect();
        nodes.push(Coordinate { y: 1.0, h: 0.0 });
        // The factor keeps the products representable.
        let weights = (0..=inner).map(|i| {
            let others = (0..=inner).filter(|j| *j != i);
            others.map(|j| 4.0 * difference(nodes[i], nodes[j])).product::<f64>().recip()
        });
        let between = Between::Polynomial(weights.collect());
        Self::on(grading, power_at_edge(grading).min(most).max(1.0), nodes, between)
    }

    /// The same on cubics between nodes that are even in `y`, for what has kinks along the contact, or grows no smoother by wear.
    ///
    /// # Errors
    /// Those of the quadrature.
    pub fn on_cubics(grading: f64, inner: usize) -> Result<Self> {
        // The axis lies in the middle of a cell.
        let cells = inner as f64 + 0.5;
        let at = |i: usize| Coordinate { y: (i as f64 + 0.5) / cells, h: (inner - i) as f64 / cells };
        Self::on(grading, POWER_OF_CUBICS, (0..=inner).map(at).collect(), Between::Cubics)
    }

    fn on(grading: f64, power: f64, nodes: Vec<Coordinate>, between: Between) -> Result<Self> {
        let inner = nodes.len() - 1;
        let mut it = Self {
            nu: 0.5 * (1.0 + grading),
            power,
            between,
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
        it.fill_profile()?;
        it.fill_pressure()?;
        for i in 0..inner {
            let node = it.nodes[i];
            let over_slope = it.root(node) / (4.0 * it.power * node.h.powf(it.power - 1.0));
            for (j, slope) in it.slopes(node) {
                it.derivative[(i, j)] = over_slope * slope;
            }
        }
        it.load = it.integral(it.nu)?;
        it.load.truncate(inner);
        it.area = it.integral(1.0)?;
        it.inverse = Factors::new(it.profile.subrows(0, inner).to_owned());
        Ok(it)
    }

    /// Whether what is between nodes follows those next to a place alone, so that no kink makes it swing elsewhere.
    pub fn is_local(&self) -> bool {
        matches!(self.between, Between::Cubics)
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

    /// Weights of [`WholeContact::profile`], shape `(nodes, inner nodes)`.
    pub fn profile_weights(&self) -> &Mat<f64> {
        &self.profile
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

    /// `F⁻¹ (ξ d/dξ) F q` at the inner nodes, which is `ξ dq/dξ`, since `F` depends on the area by a power alone. On cubics it is found as the latter, by which nothing grows;
    /// one polynomial does better by the former, for the place of the edge follows from `F q`.
    ///
    /// # Arguments
    /// * `inside` -- `q`
    /// * `profile` -- `F q` at all nodes
    pub fn dilation(&self, inside: &[f64], profile: &[f64]) -> Vec<f64> {
        match self.between {
            Between::Polynomial(_) => {
                let mut dilated = product(&self.derivative, profile);
                self.solve_profile(&mut dilated);
                dilated
            }
            Between::Cubics => product(&self.derivative, &[inside, &[0.0]].concat()),
        }
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

    /// Value at a coordinate of what is given at all nodes.
    pub fn value(&self, values: &[f64], coordinate: Coordinate) -> f64 {
        self.cardinals(coordinate, values.len()).map(|(j, cardinal)| cardinal * values[j]).sum()
    }

    /// Value at a coordinate by the inner nodes alone.
    pub fn value_inside(&self, inside: &[f64], coordinate: Coordinate) -> f64 {
        self.value(&inside[..self.inner()], coordinate)
    }

    /// Outermost coordinate at which values inside exceed `level`, if they do on the axis or at a node.
    pub fn last_above(&self, inside: &[f64], level: f64) -> Option<Coordinate> {
        self.falls_below(&with_edge(inside), level, inside.iter().rposition(|value| *value > level))
    }

    /// Innermost coordinate at which values inside do not exceed `level`, if they do on the axis.
    ///
    /// # Arguments
    /// * `last` -- [the outermost at which they do](WholeContact::last_above)
    pub fn first_below(&self, inside: &[f64], level: f64, last: Coordinate) -> Option<Coordinate> {
        let values = with_edge(inside);
        let is_above = |value: &f64| *value > level;
        let node = inside.iter().take_while(|value| is_above(value)).count().checked_sub(1);
        if !is_above(&self.value(&values, Coordinate::AXIS)) {
            None
        } else if node == inside.iter().rposition(is_above) {
            Some(last)
        } else {
            self.falls_below(&values, level, node)
        }
    }

    /// Where values at all nodes fall to `level` behind a node at which they exceed it, or behind the axis if they do there.
    fn falls_below(&self, values: &[f64], level: f64, node: Option<usize>) -> Option<Coordinate> {
        let low = node.map_or(Coordinate::AXIS, |i| self.nodes[i]);
        let high = self.nodes[node.map_or(0, |i| i + 1)];
        let between =
            |part: f64| Coordinate { y: low.y + part * (high.y - low.y), h: low.h + part * (high.h - low.h) };
        let excess = |part: f64| self.value(values, between(part)) - level;
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
        let values = with_edge(inside);
        let places = self.places_from_axis(end, self.nu)?;
        Ok(places
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

    /// Nodes, among the first so many, whose values tell that at a coordinate, with their weights.
    fn cardinals(&self, coordinate: Coordinate, nodes: usize) -> impl Iterator<Item = (usize, f64)> {
        let first = match &self.between {
            Between::Polynomial(_) => 0,
            Between::Cubics => self.first_of_cubic(coordinate, nodes),
        };
        let near = match &self.between {
            Between::Polynomial(weights) => self.barycentric(coordinate, &weights[..nodes]),
            Between::Cubics => self.cubics(coordinate, first).to_vec(),
        };
        near.into_iter().enumerate().map(move |(j, cardinal)| (first + j, cardinal))
    }

    /// Of one polynomial through the first of the nodes.
    fn barycentric(&self, coordinate: Coordinate, weights: &[f64]) -> Vec<f64> {
        let count = weights.len();
        if let Some(at) = self.nodes[..count].iter().position(|node| difference(coordinate, *node) == 0.0) {
            return (0..count).map(|j| if j == at { 1.0 } else { 0.0 }).collect();
        }
        // The weights without the edge lack the distance from it.
        let lacks = count < self.nodes.len();
        let mut cardinals: Vec<f64> = self
            .nodes
            .iter()
            .zip(weights)
            .map(|(node, w)| if lacks { w * node.h } else { *w } / difference(coordinate, *node))
            .collect();
        let sum: f64 = cardinals.iter().sum();
        cardinals.iter_mut().for_each(|value| *value /= sum);
        cardinals
    }

    /// First of the four nodes next to a coordinate, among so many.
    fn first_of_cubic(&self, coordinate: Coordinate, nodes: usize) -> usize {
        let after = self.nodes[..nodes].partition_point(|node| difference(*node, coordinate) <= 0.0);
        (after + LOCAL / 2).clamp(LOCAL, nodes) - LOCAL
    }

    /// Lagrange's polynomials on four nodes.
    fn cubics(&self, coordinate: Coordinate, first: usize) -> [f64; LOCAL] {
        let nodes = &self.nodes[first..first + LOCAL];
        let factor = |i: usize, j: usize| difference(coordinate, nodes[j]) / difference(nodes[i], nodes[j]);
        lagrange(factor)
    }

    /// Derivatives of these by `y`.
    fn cubic_slopes(&self, coordinate: Coordinate, first: usize) -> [f64; LOCAL] {
        let nodes = &self.nodes[first..first + LOCAL];
        let factor = |i: usize, j: usize| difference(coordinate, nodes[j]) / difference(nodes[i], nodes[j]);
        std::array::from_fn(|i| {
            let others = || (0..LOCAL).filter(|j| *j != i);
            let one = |l: usize| {
                let product: f64 = others().filter(|j| *j != l).map(|j| factor(i, j)).product();
                product / difference(nodes[i], nodes[l])
            };
            others().map(one).sum()
        })
    }

    /// Nodes whose values tell the derivative by `y`, with their weights: of one polynomial at a node, of cubics anywhere. At a node these have one more of those farther out, from
    /// where ground comes in.
    fn slopes(&self, coordinate: Coordinate) -> Vec<(usize, f64)> {
        match &self.between {
            Between::Polynomial(weights) => {
                let count = self.nodes.len();
                let at =
                    (0..count).find(|j| difference(coordinate, self.nodes[*j]) == 0.0).unwrap_or_default();
                let away = |j: usize| weights[j] / weights[at] / difference(coordinate, self.nodes[j]);
                let mut slopes: Vec<(usize, f64)> =
                    (0..count).map(|j| (j, if j == at { 0.0 } else { away(j) })).collect();
                slopes[at].1 = -slopes.iter().map(|(_, slope)| slope).sum::<f64>();
                slopes
            }
            Between::Cubics => {
                let first = self.first_of_cubic(coordinate, self.nodes.len());
                let near = self.cubic_slopes(coordinate, first).into_iter().enumerate();
                near.map(|(j, slope)| (first + j, slope)).collect()
            }
        }
    }

    /// Ends of panels, distances from a coordinate outwards or, negative, inwards, parted where one cubic follows another.
    fn parted(&self, from: Coordinate, panels: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
        if let Between::Polynomial(_) = self.between {
            return panels;
        }
        let at: Vec<f64> = self.nodes.iter().map(|node| difference(*node, from)).collect();
        let part = |[low, high]: [f64; 2]| {
            let within = at.iter().copied().filter(|it| *it > low && *it < high);
            let ends: Vec<f64> = std::iter::once(low).chain(within).chain([high]).collect();
            ends.windows(2).map(|ends| [ends[0], ends[1]]).collect::<Vec<_>>()
        };
        panels.into_iter().flat_map(part).collect()
    }

    fn rule_size(&self) -> usize {
        match self.between {
            Between::Polynomial(_) => self.nodes.len() / 2 + BEYOND_DEGREE,
            Between::Cubics => BEYOND_DEGREE,
        }
    }

    /// Places and weights of `∫_0^ξ(end) ξ^(exponent-1) ... dξ`.
    fn places_from_axis(&self, end: Coordinate, exponent: f64) -> Result<Vec<(Coordinate, f64)>> {
        let lower = 4.0 * exponent - 1.0;
        let rule = Rule::jacobi(self.rule_size(), 0.0, lower)?;
        let axis = Coordinate { y: 0.0, h: 1.0 };
        let panels = self.parted(axis, vec![[0.0, end.y]]);
        let first = panels[0][1];
        let scale = first.powf(4.0 * exponent) / exponent * self.power;
        let mut places: Vec<(Coordinate, f64)> = rule
            .nodes
            .iter()
            .zip(&rule.weights)
            .map(|(v, w)| {
                let coordinate = Coordinate { y: first * v, h: 1.0 - first * v };
                let smooth =
                    (self.root(coordinate) / coordinate.y).powf(lower) * coordinate.h.powf(self.power - 1.0);
                (coordinate, scale * w * smooth)
            })
            .collect();
        let plain = Rule::legendre(self.rule_size())?;
        for [from, to] in &panels[1..] {
            for (v, w) in plain.nodes.iter().zip(&plain.weights) {
                let y = from + (to - from) * v;
                let coordinate = Coordinate { y, h: (end.h + (end.y - y)).max(0.0) };
                places.push((coordinate, (to - from) * w * self.measure(coordinate, exponent)));
            }
        }
        Ok(places)
    }

    /// `ξ^(exponent-1) dξ/dy`.
    fn measure(&self, coordinate: Coordinate, exponent: f64) -> f64 {
        4.0 * self.power
            * self.root(coordinate).powf(4.0 * exponent - 1.0)
            * coordinate.h.powf(self.power - 1.0)
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
                for (j, value) in self.cardinals(coordinate, self.nodes.len()) {
                    sum[j] += prefactor * weight * value;
                }
            };
            for (coordinate, weight) in self.places_from_axis(Coordinate::inwards(end, half), nu)? {
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
            let mut panels = vec![[0.0, first]];
            while panels[panels.len() - 1][1] < half {
                let from = panels[panels.len() - 1][1];
                panels.push([from, (2.0 * from).min(half)]);
            }
            let outwards = |[from, to]: [f64; 2]| [-to, -from];
            let mut panels = self.parted(end, panels.into_iter().rev().map(outwards).collect());
            let first = -panels.pop().unwrap_or_default()[0];
            let rule = Rule::jacobi(size, 0.0, at_node)?;
            for (v, w) in rule.nodes.iter().zip(&rule.weights) {
                let distance = first * v;
                let coordinate = Coordinate::inwards(end, distance);
                let kernel =
                    self.rise(end, coordinate, distance).powf(-nu) * coordinate.h.powf(self.power - 1.0);
                let scale = first.powf(at_node + 1.0) / (at_node + 1.0);
                add(coordinate, scale * w * slope(coordinate) * kernel * distance.powf(-at_node));
            }
            for [from, to] in panels.into_iter().map(outwards) {
                for (v, w) in plain.nodes.iter().zip(&plain.weights) {
                    let distance = from + (to - from) * v;
                    let coordinate = Coordinate::inwards(end, distance);
                    let kernel =
                        self.rise(end, coordinate, distance).powf(-nu) * coordinate.h.powf(self.power - 1.0);
                    add(coordinate, (to - from) * w * slope(coordinate) * kernel);
                }
            }
            for (j, value) in sum.into_iter().take(self.inner()).enumerate() {
                self.profile[(row, j)] = value;
            }
        }
        Ok(())
    }

    /// Rows of the pressure: `-(1/π) ∫ (ξ - ξ_t)^(ν-1) ℓ_j' dy` from each inner node to the edge.
    fn fill_pressure(&mut self) -> Result<()> {
        let (nu, size) = (self.nu, self.rule_size());
        let plain = Rule::legendre(size)?;
        let at_node = Rule::jacobi(size, 0.0, nu - 1.0)?;
        let at_nodes: Vec<_> = self.nodes.iter().map(|node| self.slopes(*node)).collect();
        for row in 0..self.inner() {
            let start = self.nodes[row];
            let half = 0.5 * start.h;
            let mut sum = vec![0.0; self.nodes.len()];
            let mut add = |coordinate: Coordinate, weight: f64| {
                let mut add = |(j, value): (usize, f64)| sum[j] -= weight * value / PI;
                match self.between {
                    // The slope of one polynomial is the one through its slopes at the nodes.
                    Between::Polynomial(_) => self.cardinals(coordinate, self.nodes.len()).for_each(add),
                    Between::Cubics => self.slopes(coordinate).into_iter().for_each(&mut add),
                }
            };
            let mut panels = vec![[0.0, start.y.min(half)]];
            while panels[panels.len() - 1][1] < half {
                let from = panels[panels.len() - 1][1];
                panels.push([from, (2.0 * from).min(half)]);
            }
            // Towards the edge, where ξ is a power of the distance.
            let mut left = half;
            while left > LAST_PANEL * start.h {
                panels.push([start.h - left, start.h - 0.5 * left]);
                left *= 0.5;
            }
            panels.push([start.h - left, start.h]);
            let panels = self.parted(start, panels);
            let first = panels[0][1];
            for (v, w) in at_node.nodes.iter().zip(&at_node.weights) {
                let distance = first * v;
                let coordinate = Coordinate::inwards(start, -distance);
                let kernel = (self.rise(coordinate, start, distance) / distance).powf(nu - 1.0);
                add(coordinate, first.powf(nu) / nu * w * kernel);
            }
            for [from, to] in &panels[1..] {
                for (v, w) in plain.nodes.iter().zip(&plain.weights) {
                    let distance = from + (to - from) * v;
                    let coordinate = Coordinate::inwards(start, -distance);
                    add(coordinate, (to - from) * w * self.rise(coordinate, start, distance).powf(nu - 1.0));
                }
            }
            match self.between {
                Between::Polynomial(_) => {
                    for (sum, slopes) in sum.into_iter().zip(&at_nodes) {
                        let inner = slopes.iter().take(self.inner());
                        inner.for_each(|(j, slope)| self.pressure[(row, *j)] += sum * slope);
                    }
                }
                Between::Cubics => (0..self.inner()).for_each(|j| self.pressure[(row, j)] = sum[j]),
            }
        }
        Ok(())
    }

    /// Weights of `∫_0^1 ξ^(exponent-1) ... dξ`.
    fn integral(&self, exponent: f64) -> Result<Vec<f64>> {
        let mut sum = vec![0.0; self.nodes.len()];
        let mut whole = 0.0;
        let mut add = |coordinate: Coordinate, weight: f64| {
            whole += weight;
            self.cardinals(coordinate, self.nodes.len()).for_each(|(j, value)| sum[j] += weight * value);
        };
        let lower = 4.0 * exponent - 1.0;
        match self.between {
            Between::Polynomial(_) => {
                let rule = Rule::jacobi(self.nodes.len() + BEYOND_DEGREE, self.power - 1.0, lower)?;
                for ((v, complement), w) in rule.nodes.iter().zip(&rule.complements).zip(&rule.weights) {
                    let coordinate = Coordinate { y: *v, h: *complement };
                    add(coordinate, w * (self.root(coordinate) / v).powf(lower));
                }
            }
            Between::Cubics => {
                for (coordinate, weight) in self.places_from_axis(self.nodes[self.inner()], exponent)? {
                    add(coordinate, weight);
                }
            }
        }
        // Of one it is 1/exponent.
        sum.iter_mut().for_each(|value| *value /= whole * exponent);
        Ok(sum)
    }
}

/// `m`.
fn power_at_edge(grading: f64) -> f64 {
    if grading < SOFT { POWER + FALL * grading } else { POWER / (1.0 - grading.min(0.0)) }
}

/// `y - y_other`, by the distances from the nearer end.
fn difference(one: Coordinate, other: Coordinate) -> f64 {
    if one.y + other.y < 1.0 { one.y - other.y } else { other.h - one.h }
}

/// Lagrange's polynomials at a place.
///
/// # Arguments
/// * `factor` -- what the place lies away from a node `j`, over what a node `i` does
fn lagrange(factor: impl Fn(usize, usize) -> f64) -> [f64; LOCAL] {
    std::array::from_fn(|i| (0..LOCAL).filter(|j| *j != i).map(|j| factor(i, j)).product())
}

/// Values at all nodes, of which that at the edge is nothing.
fn with_edge(inside: &[f64]) -> Vec<f64> {
    inside.iter().copied().chain([0.0]).collect()
}

fn product(matrix: &Mat<f64>, values: &[f64]) -> Vec<f64> {
    let mut to = vec![0.0; matrix.nrows()];
    super::linear::multiply(matrix.as_ref(), values, &mut to);
    to
}

#[cfg(test)]
mod tests {
    use super::WholeContact;

    /// Under a paraboloid `q = 1 - ξ`, `F q = 1 - ν ξ` and `ξ dq/dξ = -ξ`.
    #[test]
    fn cubics_carry_a_paraboloid() {
        for grading in [-0.5, -0.3, 0.0, 0.5, 0.9] {
            let nu = 0.5 * (1.0 + grading);
            let off = |inner: usize| {
                let mesh = WholeContact::on_cubics(grading, inner).unwrap();
                let inside: Vec<f64> = mesh.distances().collect();
                // ∫ ξ^(ν-1) (1-ξ) dξ and F ξ = ν ξ.
                let load = (mesh.load(&inside) * nu * (nu + 1.0) - 1.0).abs();
                let profile = mesh.profile(&inside);
                let carried = profile.iter().zip(mesh.fractions()).map(|(u, x)| (u - 1.0 + nu * x).abs());
                let dilated = mesh.dilation(&inside, &profile);
                let dilated = dilated.iter().zip(mesh.fractions()).map(|(it, x)| (it + x).abs());
                let most = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
                [load, most(&mut carried.into_iter()), most(&mut dilated.into_iter())]
            };
            let [coarse, fine] = [off(40), off(80)];
            println!("k = {grading}: {coarse:?}, {fine:?}");
            for (coarse, fine) in coarse.into_iter().zip(fine) {
                assert!(fine < 1e-4 && fine < 0.2 * coarse, "{coarse:e}, {fine:e}");
            }
        }
    }
}
