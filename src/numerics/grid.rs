//! Meshes of the slip annulus.

mod lagrange;

use std::iter;
use std::ops::Range;

use lagrange::lagrange_even;
pub use lagrange::{lagrange, lagrange_derivative};

/// Most nodes of a local polynomial on a [`Mesh`].
pub const MOST_POINTS: usize = 6;

/// Stretch below which a mesh is as good as without.
const NO_STRETCH: f64 = 1e-8;

/// Least stretch of a smooth mesh.
const SMOOTH_STRETCH: f64 = 10.0;

/// The same where the edge of stick recedes: far less fine ones lose the layer of ground just passed where the edge nearly stops, finer ones take more
/// steps.
const RECEDING_STRETCH: f64 = 6.0;

/// Springs up to which the ends of a smooth mesh are as fine as its exponents make them, and by how much of the mesh they are cut short for each
/// spring more, and for the third root of it: next to the edge of stick slip, a difference of what springs would do without pressure and with
/// it, and at the contact edge compressions would have no digits left in cells finer than those of that many.
const FINEST_ENDS: usize = 1000;
const CUT_AT_STICK: f64 = 5e-9;
const CUT_AT_CONTACT: f64 = 6e-5;

/// Correction of a place, over its distance from the end of the mesh, that is the last one: Halley's method leaves its cube.
const LAST: f64 = 1e-5;

/// Least value of the cubic in a cell, over its argument, with which that begins.
const LEAST_OF_CUBIC: f64 = 0.01;

/// How nodes cluster at the two ends of the slip annulus, and the degree of the polynomials between them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clustering {
    /// For wear that is smooth along the annulus, with the edge of stick at rest: degree 5. Towards the edge of stick nodes lie nearly
    /// evenly in `ln(r² - c²)`, where wear proceeds as a front; at the contact edge their spacing is `n^-4`.
    Smooth,
    /// The same nodes with polynomials of degree 3, for the weak kinks along the annulus that resolved cycles at a constant indentation make (an
    /// orbit), or a threshold.
    Even,
    /// Nodes towards the edge of stick as of these, with polynomials of degree 3 in `ξ` and a spacing of `n^-3` at the contact edge, for wear with
    /// kinks along the annulus, of normal oscillations or blocks, that lasts until its front comes to the edge of stick.
    Front,
    /// For wear with kinks along the annulus that ends sooner: degree 3, spacing `n^-4` at the edge of stick and `n^-3` at the contact edge.
    Cubic,
    /// As [`Clustering::Cubic`] with a spacing of `n^-2` at the contact edge: less stiff, so that explicit steps may be longer.
    Quadratic,
    /// Degree 3, spacing `n^-3` at the contact edge and `n^-2` at an edge of stick that creeps: ground passes through the springs there, and
    /// finer ones amplify what they are off by.
    CreepingStick,
    /// As [`Clustering::CreepingStick`] with a spacing of `n^-2` at the contact edge as well, for wear that goes by a power of the slip below one or comes from elsewhere: it leaves so much behind next to the edge of stick
    /// that the contact edge hardly moves at first, and what springs next to that one are off by stays with them, the larger in pressure the finer they are.
    CreepingStickCoarse,
    /// Degree 3, for an edge of stick that recedes over unworn ground: as [`Clustering::CreepingStick`], but towards that edge nodes lie nearly evenly in
    /// `ln(r² - c²)`. The ground just passed is a layer there, of `ln(S/S_0) = κ p/|d(c²)/dN| (r² - c²)`, the thinner the slower the edge.
    RecedingStick,
}

impl Clustering {
    /// Exponents of the spacing at the edge of stick and at the contact edge.
    fn exponents(self) -> (i32, i32) {
        match self {
            Self::Smooth | Self::Even => (1, 3),
            Self::Cubic => (3, 2),
            Self::Quadratic => (3, 1),
            Self::CreepingStickCoarse => (1, 1),
            Self::Front | Self::CreepingStick | Self::RecedingStick => (1, 2),
        }
    }

    /// Whether the front of wear next to the edge of stick is followed.
    pub fn follows_front(self) -> bool {
        matches!(self, Self::Smooth | Self::Even | Self::Front)
    }

    /// Whether the local polynomials are polynomials in `y`.
    pub fn is_even(self) -> bool {
        matches!(self, Self::Smooth | Self::Even)
    }

    /// Degree of the local polynomials.
    pub fn degree(self) -> usize {
        if self == Self::Smooth { 5 } else { 3 }
    }

    /// What is cut off at the ends of a mesh.
    fn cut(self, cells: usize) -> [f64; 2] {
        let more = cells.saturating_sub(FINEST_ENDS) as f64;
        match self {
            Self::Smooth | Self::Even => [CUT_AT_STICK * more, CUT_AT_CONTACT * more.cbrt()],
            _ => [0.0; 2],
        }
    }

    /// Stretch `Λ` of the mesh at a grading where the limit's area is `e^natural` times that of the stick zone.
    ///
    /// On a smooth mesh the front next to the edge of stick is followed to far within what the output shows; as `k → 1` it is as high there as
    /// anywhere.
    pub fn stretch(self, natural: f64, grading: f64) -> f64 {
        match self {
            Self::Smooth | Self::Even | Self::Front => {
                (natural + 3.0).max(SMOOTH_STRETCH + 3.0 * grading.max(0.0))
            }
            Self::RecedingStick => natural.max(RECEDING_STRETCH),
            _ => natural,
        }
    }
}

/// Nodes of the slip annulus as a smooth map of evenly spaced ones, `y = 0, 1, ... n`.
///
/// ```text
/// ξ = expm1(Λ g(y/n)) / expm1(Λ),      g(x) = ∫_0^x t^a (1-t)^b dt / B(a+1, b+1)
/// ```
///
/// `ξ = (s - c²)/(a² - c²)` with `s = x²` is the fraction of the annulus' area, from 0 at the edge of stick to 1 at the contact edge. Both
/// ends carry singularities of the worn solution, powers of the distance, which are smooth in `y` as the nodes cluster there: the local
/// polynomials are polynomials in `y` on meshes that [`Clustering::is_even`] names, but for straight lines. With more than a thousand cells `t` runs over a little less
/// than (0, 1) on such a mesh, so that the last cells keep widths that numbers can tell apart. Those of the other meshes are polynomials in `ξ`: over
/// kinks, and over ground that passes through the springs, they have proved the steadier ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    clustering: Clustering,
    stretch: f64,
    /// `expm1(Λ)` and `expm1(-Λ)`.
    grown: f64,
    fallen: f64,
    /// What is cut off the range of `t` at either end.
    cut: [f64; 2],
    /// `g` from either end as polynomials in the distance of `t` from it.
    rising: Polynomial,
    falling: Polynomial,
    ends: Vec<MeshPoint>,
    nodes: Vec<f64>,
    /// [`Root`]s of the nodes up to the middle, from either end.
    roots: [Vec<Root>; 2],
}

/// `v = g^(1/m)` of a node, with `m` the lowest power of `g` from the end of the mesh, and by how much the distance in `y` from that end grows with it: smoothly, up to
/// the end.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Root {
    value: f64,
    slope: f64,
}

/// A place on a [`Mesh`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshPoint {
    /// `ξ`.
    pub value: f64,
    /// `1 - ξ`, to full relative accuracy.
    pub complement: f64,
    /// `dξ/dy`.
    pub slope: f64,
}

impl MeshPoint {
    /// `ξ` less that of another place, to the accuracy of the places at both ends of the mesh.
    pub fn minus(&self, other: &Self) -> f64 {
        if self.value < 0.5 { self.value - other.value } else { other.complement - self.complement }
    }
}

impl Mesh {
    /// Lays out a mesh.
    ///
    /// # Arguments
    /// * `cells` -- number of cells `n`, more than the degree of the clustering
    /// * `stretch` -- `Λ >= 0`; [`Clustering::stretch`] proposes it
    /// * `clustering` -- at the ends
    ///
    /// # Panics
    /// If there are too few cells.
    pub fn new(cells: usize, stretch: f64, clustering: Clustering) -> Self {
        assert!(
            cells > clustering.degree(),
            "{cells} cells for polynomials of degree {}",
            clustering.degree()
        );
        let (low, high) = clustering.exponents();
        let cut = clustering.cut(cells);
        let [rising, falling] =
            [Polynomial::incomplete_beta(low, high), Polynomial::incomplete_beta(high, low)];
        let whole = if cut == [0.0; 2] { 1.0 } else { rising.at(1.0 - cut[1]).0 - rising.at(cut[0]).0 };
        let mut mesh = Self {
            clustering,
            stretch,
            grown: stretch.exp_m1(),
            fallen: (-stretch).exp_m1(),
            rising: rising.from(cut[0]).over(whole),
            falling: falling.from(cut[1]).over(whole),
            cut,
            ends: Vec::new(),
            nodes: vec![0.0; cells + 1],
            roots: [vec![], vec![]],
        };
        mesh.ends = (0..=cells).map(|i| mesh.at(i as f64)).collect();
        mesh.nodes = mesh.ends.iter().map(|end| end.value).collect();
        let middle = cells / 2;
        mesh.roots = [
            (0..=middle).map(|i| mesh.root(i, true)).collect(),
            (0..=cells - middle).map(|i| mesh.root(cells - i, false)).collect(),
        ];
        mesh
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.nodes.len() - 1
    }

    /// `Λ`.
    pub fn stretch(&self) -> f64 {
        self.stretch
    }

    /// How the nodes cluster.
    pub fn clustering(&self) -> Clustering {
        self.clustering
    }

    /// Nodes `ξ`, shape `(n + 1,)`, increasing from 0 to 1.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// The node of an index, up to `n`.
    pub fn node(&self, index: usize) -> MeshPoint {
        self.ends[index]
    }

    /// The place at `y` in [0, n].
    pub fn at(&self, y: f64) -> MeshPoint {
        let (part, rest, slope) = self.without_stretch(y);
        if self.stretch < NO_STRETCH {
            return MeshPoint { value: part, complement: rest, slope };
        }
        let (whole, risen) = (self.grown, (self.stretch * part).exp_m1());
        let steepness = (risen + 1.0) / whole;
        MeshPoint {
            value: risen / whole,
            complement: steepness * (self.stretch * rest).exp_m1(),
            slope: self.stretch * steepness * slope,
        }
    }

    /// `g(y/n)`, `1 - g(y/n)` and `dg/dy`.
    fn without_stretch(&self, y: f64) -> (f64, f64, f64) {
        let cells = self.cells() as f64;
        let [at_stick, at_contact] = self.cut;
        let span = (1.0 - at_stick - at_contact) / cells;
        if y < 0.5 * cells {
            let (part, slope) = self.rising.at(span * y);
            (part, 1.0 - part, slope * span)
        } else {
            let (rest, slope) = self.falling.at(span * (cells - y));
            (1.0 - rest, rest, slope * span)
        }
    }

    /// The cell in which `ξ` in [0, 1) lies.
    pub fn cell(&self, fraction: f64) -> usize {
        self.nodes.partition_point(|node| *node <= fraction).clamp(1, self.cells()) - 1
    }

    /// `y` of `ξ` in [0, 1), by Halley's method for `g` from the nearer end.
    pub fn place(&self, fraction: f64) -> f64 {
        let (cells, cell) = (self.cells() as f64, self.cell(fraction));
        let near_stick = cell < self.cells() / 2;
        let wanted = match (self.stretch < NO_STRETCH, near_stick) {
            (true, true) => fraction,
            (true, false) => 1.0 - fraction,
            (false, true) => (fraction * self.grown).ln_1p() / self.stretch,
            (false, false) => -((1.0 - fraction) * self.fallen).ln_1p() / self.stretch,
        };
        let (mut low, mut high) = (cell as f64, cell as f64 + 1.0);
        let Some(part) = self.within_cell(cell, near_stick, wanted) else { return low };
        let mut y = low + part;
        for _ in 0..60 {
            let (part, rest, slope) = self.without_stretch(y);
            let off = if near_stick { part - wanted } else { wanted - rest };
            if off > 0.0 {
                high = y;
            } else {
                low = y;
            }
            let newton = off / slope;
            let halley = y - newton / (1.0 - 0.5 * newton * self.log_slope(y)).max(0.5);
            let from_end = if near_stick { y } else { cells - y };
            if (halley - y).abs() <= LAST * from_end {
                return halley.clamp(low, high);
            }
            let next = if halley > low && halley < high { halley } else { 0.5 * (low + high) };
            if next == y {
                return y;
            }
            y = next;
        }
        y
    }

    /// About where in a cell `g` from the nearer end is `wanted`: by the cubic in its [`Root`] with the slopes at the ends of the cell. None if that is
    /// not past the first of them.
    fn within_cell(&self, cell: usize, near_stick: bool, wanted: f64) -> Option<f64> {
        let [from_stick, from_contact] = &self.roots;
        let [begin, end] = match near_stick {
            true => [from_stick[cell], from_stick[cell + 1]],
            false => [from_contact[self.cells() - cell], from_contact[self.cells() - cell - 1]],
        };
        let growth = end.value - begin.value;
        let part = (root(wanted, self.lowest_power(near_stick)) - begin.value) / growth;
        let left = 1.0 - part;
        let cubic = part * (3.0 - 2.0 * part) + left * growth.abs() * (begin.slope * left - end.slope * part);
        (part > 0.0).then(|| (part * cubic.max(LEAST_OF_CUBIC)).min(1.0))
    }

    /// Lowest power of `g` from either end, without what is cut off there.
    fn lowest_power(&self, near_stick: bool) -> i32 {
        let (low, high) = self.clustering.exponents();
        1 + if near_stick { low } else { high }
    }

    fn root(&self, node: usize, near_stick: bool) -> Root {
        let (part, rest, slope) = self.without_stretch(node as f64);
        let power = self.lowest_power(near_stick);
        let value = root(if near_stick { part } else { rest }, power);
        if value > 0.0 {
            return Root { value, slope: f64::from(power) * value.powi(power - 1) / slope };
        }
        // At the end itself the lowest power is all there is; of a mesh that is cut there `g` is a straight line.
        let grown = if near_stick { &self.rising } else { &self.falling };
        let (lowest, coefficient) = grown.lowest();
        let slope = if lowest == power { self.cells() as f64 / root(coefficient, power) } else { 0.0 };
        Root { value, slope }
    }

    /// Derivative of `ln(dg/dy)` by `y`.
    fn log_slope(&self, y: f64) -> f64 {
        let cells = self.cells() as f64;
        let (low, high) = self.clustering.exponents();
        let [at_stick, at_contact] = self.cut;
        let span = (1.0 - at_stick - at_contact) / cells;
        span * (f64::from(low) / (at_stick + span * y) - f64::from(high) / (at_contact + span * (cells - y)))
    }

    /// The `points` nodes of the local polynomial of cell `cell`, from 1 to `last` on: centred, shifted inwards at the ends.
    pub fn stencil(cell: usize, points: usize, last: usize) -> Range<usize> {
        let start = (cell + 1).saturating_sub(points / 2).max(1).min(last + 1 - points.min(last));
        start..start + points
    }

    /// The local polynomials of a stencil at `y`, where the place `point` is.
    pub fn lagrange(&self, stencil: &Range<usize>, y: f64, point: &MeshPoint) -> [f64; MOST_POINTS] {
        if self.is_even(stencil) {
            return lagrange_even(stencil.len(), y - stencil.start as f64);
        }
        let mut values = [0.0; MOST_POINTS];
        let nodes = self.coordinates(stencil);
        lagrange(&nodes[..stencil.len()], self.coordinate(stencil, y, point), &mut values);
        values
    }

    /// Derivatives by `y` of [`Mesh::lagrange`].
    pub fn lagrange_derivative(
        &self,
        stencil: &Range<usize>,
        y: f64,
        point: &MeshPoint,
    ) -> [f64; MOST_POINTS] {
        let mut slopes = [0.0; MOST_POINTS];
        let nodes = self.coordinates(stencil);
        lagrange_derivative(&nodes[..stencil.len()], self.coordinate(stencil, y, point), &mut slopes);
        if self.is_even(stencil) { slopes } else { slopes.map(|slope| slope * point.slope) }
    }

    /// Whether the local polynomial is one of `y`.
    fn is_even(&self, stencil: &Range<usize>) -> bool {
        self.clustering.is_even() && stencil.len() > 2
    }

    /// Whether the nodes of a local polynomial begin in the half of the annulus next to the edge of stick.
    pub fn is_next_to_stick(&self, stencil: &Range<usize>) -> bool {
        self.ends[stencil.start].value < 0.5
    }

    /// What the local polynomial is a polynomial of: `y`, or `ξ` as it is next to the edge of stick and less one next to the contact edge.
    fn coordinate(&self, stencil: &Range<usize>, y: f64, point: &MeshPoint) -> f64 {
        if self.is_even(stencil) {
            y
        } else if self.is_next_to_stick(stencil) {
            point.value
        } else {
            -point.complement
        }
    }

    fn coordinates(&self, stencil: &Range<usize>) -> [f64; MOST_POINTS] {
        let last = self.cells();
        std::array::from_fn(|i| {
            let node = stencil.start + i;
            self.coordinate(stencil, node as f64, &self.ends[node.min(last)])
        })
    }

    /// Value at `y` of what is given at the nodes from the first one off the edge of stick on, by the local polynomial.
    pub fn interpolate(&self, values: &[f64], y: f64) -> f64 {
        self.local(y, values.len()).sum(values)
    }

    /// The local polynomial at `y` through what is given at `count` nodes from the first one off the edge of stick on.
    pub fn local(&self, y: f64, count: usize) -> Local {
        let cell = (y as usize).min(self.cells() - 1);
        self.on_stencil(Self::stencil(cell, self.clustering.degree() + 1, count), y)
    }

    /// As [`Mesh::local`] for fewer nodes, at the place `y` of a local polynomial that is known.
    pub fn local_among(&self, known: &Local, y: f64, count: usize) -> Local {
        let cell = (y as usize).min(self.cells() - 1);
        let stencil = Self::stencil(cell, self.clustering.degree() + 1, count);
        if stencil == known.stencil { known.clone() } else { self.on_stencil(stencil, y) }
    }

    fn on_stencil(&self, stencil: Range<usize>, y: f64) -> Local {
        // A polynomial in `y` does not ask for the place.
        let place = if self.is_even(&stencil) { self.ends[0] } else { self.at(y) };
        let weights = self.lagrange(&stencil, y, &place);
        Local { stencil, weights }
    }
}

/// A local polynomial at one place of a [`Mesh`].
#[derive(Debug, Clone)]
pub struct Local {
    stencil: Range<usize>,
    weights: [f64; MOST_POINTS],
}

impl Local {
    /// By how much what is given at its nodes differs.
    pub fn range(&self, values: &[f64]) -> f64 {
        let there = self.at_its_nodes(values).iter().copied();
        there.clone().fold(f64::NEG_INFINITY, f64::max) - there.fold(f64::INFINITY, f64::min)
    }

    /// Its value there for what is given at the nodes.
    pub fn sum(&self, values: &[f64]) -> f64 {
        self.weights.iter().zip(self.at_its_nodes(values)).map(|(weight, value)| weight * value).sum()
    }

    fn at_its_nodes<'a>(&self, values: &'a [f64]) -> &'a [f64] {
        &values[self.stencil.start - 1..self.stencil.end - 1]
    }
}

/// `x^(1/n)` for 2, 3 or 4.
fn root(x: f64, n: i32) -> f64 {
    match n {
        2 => x.sqrt(),
        3 => x.cbrt(),
        _ => x.sqrt().sqrt(),
    }
}

/// Degree of a [`Polynomial`].
const DEGREE: usize = 6;

/// A polynomial without a constant: the coefficients of `x` to `x^6`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Polynomial([f64; DEGREE]);

impl Polynomial {
    /// `∫_0^x t^a (1-t)^b dt / B(a+1, b+1)` for `a + b` up to five.
    fn incomplete_beta(a: i32, b: i32) -> Self {
        let beta = (1..=b).map(|j| f64::from(j) / f64::from(a + j)).product::<f64>() / f64::from(a + b + 1);
        let mut coefficients = [0.0; DEGREE];
        let mut binomial = 1.0;
        for (j, coefficient) in (0..=b).zip(&mut coefficients[a as usize..]) {
            *coefficient = binomial / f64::from(a + 1 + j) / beta;
            binomial *= -f64::from(b - j) / f64::from(j + 1);
        }
        Self(coefficients)
    }

    /// Value and slope.
    fn at(&self, x: f64) -> (f64, f64) {
        // Horner's rule for both.
        let (sum, slope) =
            self.0.iter().rev().fold((0.0, 0.0), |(sum, slope), c| (sum * x + c, slope * x + sum));
        (sum * x, slope * x + sum)
    }

    /// The lowest power, and its coefficient.
    fn lowest(&self) -> (i32, f64) {
        let found = self.0.iter().zip(1..).find(|(c, _)| **c != 0.0);
        found.map_or((0, 0.0), |(c, power)| (power, *c))
    }

    /// What it grows by from `start` on, as a polynomial in the distance.
    fn from(self, start: f64) -> Self {
        let mut all = self.0;
        if start != 0.0 {
            // Synthetic division again and again (Horner): the first one ends with the constant, which is left out.
            for first in iter::once(0).chain(0..DEGREE) {
                for j in (first..DEGREE - 1).rev() {
                    all[j] += start * all[j + 1];
                }
            }
        }
        Self(all)
    }

    fn over(self, divisor: f64) -> Self {
        Self(self.0.map(|c| c / divisor))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Clustering; 8] = [
        Clustering::Smooth,
        Clustering::Even,
        Clustering::Front,
        Clustering::Cubic,
        Clustering::Quadratic,
        Clustering::CreepingStick,
        Clustering::CreepingStickCoarse,
        Clustering::RecedingStick,
    ];

    #[test]
    fn nodes_rise_from_zero_to_one_for_every_stretch() {
        for clustering in ALL {
            for stretch in [0.0, 1e-12, 0.5, 5.0, 30.0] {
                let mesh = Mesh::new(50, stretch, clustering);
                let nodes = mesh.nodes();
                assert_eq!((nodes[0], nodes[50], mesh.node(50).complement), (0.0, 1.0, 0.0));
                assert!(nodes.windows(2).all(|pair| pair[1] > pair[0]), "stretch {stretch}: {nodes:?}");
            }
        }
    }

    #[test]
    fn slopes_and_complements_are_those_of_the_map() {
        for clustering in ALL {
            for stretch in [0.0, 2.0] {
                let mesh = Mesh::new(20, stretch, clustering);
                for i in 1..200 {
                    let y = 0.1 * f64::from(i);
                    let (low, point, high) = (mesh.at(y - 1e-4), mesh.at(y), mesh.at(y + 1e-4));
                    let slope = high.minus(&low) / 2e-4;
                    assert!(
                        (slope / point.slope - 1.0).abs() < 1e-5,
                        "{clustering:?} at {y}: {slope}, {point:?}"
                    );
                    assert!(
                        (point.value + point.complement - 1.0).abs() < 3e-15,
                        "{clustering:?}: {point:?}"
                    );
                    let back = mesh.place(point.value);
                    assert!(
                        (back - y).abs() < 1e-9 * 20.0 / point.complement,
                        "{clustering:?}: {y} came back as {back}"
                    );
                }
            }
        }
    }

    #[test]
    fn places_come_back_up_to_both_ends() {
        for clustering in ALL {
            for (cells, stretch) in [(12, 12.0), (33, 0.0), (3000, 25.0)] {
                let mesh = Mesh::new(cells, stretch, clustering);
                let n = cells as f64;
                // Both halves are of one map.
                let [before, behind] = [0.5 * n * (1.0 - 1e-15), 0.5 * n].map(|y| mesh.without_stretch(y));
                assert!((before.0 - behind.0).abs() < 1e-14, "{clustering:?}: {before:?}, {behind:?}");
                assert!((before.2 / behind.2 - 1.0).abs() < 1e-13, "{clustering:?}: {before:?}, {behind:?}");
                for part in [1e-7, 1e-4, 0.01, 0.3, 0.49, 0.5, 0.51, 0.7, 0.97] {
                    let (y, at) = (part * n, mesh.at(part * n));
                    // By so much `y` is known from `ξ`, of which the complement is taken next to the contact edge, and from `g`.
                    let known_to = if part < 0.5 { at.value } else { 1.0 };
                    let (grown, _, slope) = mesh.without_stretch(y);
                    let digits = 4.0 * f64::EPSILON * (known_to / at.slope + grown / slope + n);
                    let off = (mesh.place(at.value) - y).abs();
                    assert!(off <= digits + 1e-13 * y, "{clustering:?}, {cells}: {off:e} of {y}, {digits:e}");
                }
            }
        }
    }

    #[test]
    fn stencils_stay_inside_the_nodes() {
        assert_eq!(Mesh::stencil(1, 4, 50), 1..5);
        assert_eq!(Mesh::stencil(10, 4, 50), 9..13);
        assert_eq!(Mesh::stencil(49, 4, 50), 47..51);
        assert_eq!(Mesh::stencil(2, 2, 50), 2..4);
    }
}
