//! Weights of product integration, cell by cell: what the local polynomial of one cell contributes to the transforms at one node.

use std::borrow::Cow;
use std::ops::Range;

use faer::Mat;

use crate::error::{Error, Result};
use crate::numerics::grid::{MOST_POINTS, Mesh, MeshPoint, lagrange, lagrange_derivative};
use crate::numerics::power;
use crate::numerics::quadrature::Rule;

/// Nodes of the rule in the cell that holds the end-point singularity.
const SINGULAR_NODES: usize = 12;

/// Sizes of the Gauss-Legendre rules for the cells beside it: the largest serves a gap of one cell.
const REGULAR_NODES: [usize; 5] = [6, 8, 10, 12, 16];

/// Index in [`REGULAR_NODES`] of the rule for the plain integrals.
const PLAIN: usize = 4;

/// Part of a cell below which differences of the map lose digits.
const LEAST_DIFFERENCE: f64 = 0.02;

/// Nodes of the local polynomial through the wear depth in its integral, so that the volume keeps up with the depth.
const SUM_POINTS: usize = 6;

/// Which way a transform carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Direction {
    /// Eq. (20): depths from the densities further in.
    Outwards,
    /// Eq. (21): pressures from the compressions further out. A transform that takes a derivative, so its weights act on the difference between
    /// each compression and the next: next to the edge of stick, where springs are dense and compressions nearly equal, a sum of large weights
    /// of either sign would be round-off.
    Inwards,
}

impl Direction {
    /// What the weights act on, for data at the springs inside the contact edge or up to it.
    pub fn acts_on(self, x: &[f64]) -> Cow<'_, [f64]> {
        match self {
            Self::Outwards => Cow::Borrowed(x),
            Self::Inwards => {
                let next = x.iter().skip(1).chain(&[0.0]);
                Cow::Owned(x.iter().zip(next).map(|(value, next)| next - value).collect())
            }
        }
    }

    /// The first cell that contributes: in the very first one the compression is constant.
    pub fn first_cell(self) -> usize {
        match self {
            Self::Outwards => 0,
            Self::Inwards => 1,
        }
    }

    /// Weights of what is acted on from those of the data on a stencil of `count` nodes.
    pub fn weights(self, mut weights: Weights, count: usize) -> Weights {
        if self == Self::Inwards {
            let mut sum = 0.0;
            for weight in &mut weights[..count] {
                sum -= *weight;
                *weight = sum;
            }
            // Of a constant there is no derivative.
            weights[count - 1] = 0.0;
        }
        weights
    }
}

/// Exponents and factor of the kernels of Eqs. (20) and (21).
#[derive(Debug, Clone, Copy)]
pub(super) struct Kernel {
    pub grading: f64,
    /// `ν = (1+k)/2`
    pub nu: f64,
    /// `μ = (1-k)/2`
    pub mu: f64,
    /// `sin(πν)/(π (1-ν))`: finite as `k → 1`, where `1/(1-ν)` diverges.
    pub profile_factor: f64,
}

impl Kernel {
    fn new(grading: f64) -> Result<Self> {
        let (nu, mu) = (0.5 * (1.0 + grading), 0.5 * (1.0 - grading));
        if !(nu > 0.0 && mu > 0.0) {
            return Err(Error::OutOfRange { name: "half_space.grading", value: grading, range: "(-1, 1)" });
        }
        Ok(Self { grading, nu, mu, profile_factor: profile_factor(nu, mu) })
    }
}

/// Everything that the weights of one cell need.
pub(super) struct Assembly<'a> {
    pub mesh: &'a Mesh,
    pub kernel: Kernel,
    upper_end: LocalRule,
    lower_end: LocalRule,
    legendre: Vec<LocalRule>,
}

/// A rule on a cell, with the local polynomials that are the same in all cells well inside a mesh on which they are polynomials of `y`.
struct LocalRule {
    rule: Rule,
    /// Nodes of the polynomials that cells share.
    points: usize,
    /// The polynomials and their derivatives on the nodes, where there are such cells.
    shared: Option<Vec<[Weights; 2]>>,
}

impl LocalRule {
    fn new(mesh: &Mesh, rule: Rule) -> Self {
        let points = mesh.clustering().degree() + 1;
        let shared = mesh.clustering().is_even().then(|| {
            let nodes: Vec<f64> = (0..points).map(|i| i as f64 - (points / 2 - 1) as f64).collect();
            let on_node = |y: &f64| {
                let mut both = [[0.0; MOST_POINTS]; 2];
                lagrange(&nodes, *y, &mut both[0]);
                lagrange_derivative(&nodes, *y, &mut both[1]);
                both
            };
            rule.nodes.iter().map(on_node).collect()
        });
        Self { rule, points, shared }
    }

    /// The shared polynomials, if they are those of a cell with this stencil.
    fn shared(&self, cell: usize, stencil: &Range<usize>) -> Option<&[[Weights; 2]]> {
        let fits = stencil.len() == self.points && stencil.start + self.points / 2 == cell + 1;
        self.shared.as_deref().filter(|_| fits)
    }
}

/// Weights of one row over the stencil of a cell.
pub(super) type Weights = [f64; MOST_POINTS];

/// A rule mapped into a cell with the local polynomials on its points.
struct Mapped {
    points: Vec<MeshPoint>,
    /// Weight times polynomial times `dξ/dy` outwards, weight times derivative by `y` of the polynomial inwards.
    parts: Vec<Weights>,
}

impl<'a> Assembly<'a> {
    pub fn new(grading: f64, mesh: &'a Mesh) -> Result<Self> {
        let kernel = Kernel::new(grading)?;
        Ok(Self {
            mesh,
            kernel,
            upper_end: LocalRule::new(mesh, Rule::jacobi(SINGULAR_NODES, -kernel.nu, 0.0)?),
            lower_end: LocalRule::new(mesh, Rule::jacobi(SINGULAR_NODES, 0.0, -kernel.mu)?),
            legendre: REGULAR_NODES
                .into_iter()
                .map(|nodes| Ok(LocalRule::new(mesh, Rule::legendre(nodes)?)))
                .collect::<Result<_>>()?,
        })
    }

    /// The rule for the plain integrals.
    pub fn plain_rule(&self) -> &Rule {
        &self.legendre[PLAIN].rule
    }

    /// Index of the Gauss-Legendre rule that integrates a kernel singular `gap` cells from the cell to 1e-13.
    fn regular_rule(gap: usize) -> usize {
        let gap = gap as f64;
        let ellipse = 1.0 + 2.0 * gap + 2.0 * (gap * (1.0 + gap)).sqrt();
        let needed = 15.0 / ellipse.ln() + 4.0;
        REGULAR_NODES.partition_point(|nodes| (*nodes as f64) < needed).min(REGULAR_NODES.len() - 1)
    }

    /// `dξ/dy` on average over `width` from `y` on, within a cell.
    fn mean_slope(&self, y: f64, width: f64) -> f64 {
        if width > LEAST_DIFFERENCE {
            return self.mesh.at(y + width).minus(&self.mesh.at(y)) / width;
        }
        self.legendre[0].rule.mean(|part| self.mesh.at(y + part * width).slope)
    }

    /// Nodes of the local polynomial of a cell.
    pub fn stencil(&self, cell: usize) -> Range<usize> {
        let last = self.mesh.cells();
        match self.mesh.clustering() {
            _ if cell == 0 => 1..2,
            clustering if clustering.is_even() && cell + 1 == last => last - 1..last + 1,
            clustering => Mesh::stencil(cell, clustering.degree() + 1, last),
        }
    }

    fn map(&self, cell: usize, local: &LocalRule, stencil: &Range<usize>, direction: Direction) -> Mapped {
        let (rule, shared) = (&local.rule, local.shared(cell, stencil));
        let points: Vec<MeshPoint> = rule.nodes.iter().map(|node| self.mesh.at(cell as f64 + node)).collect();
        let part = |at: usize| {
            let (y, weight, point) = (cell as f64 + rule.nodes[at], rule.weights[at], &points[at]);
            match direction {
                Direction::Outwards => {
                    let values =
                        shared.map_or_else(|| self.mesh.lagrange(stencil, y, point), |shared| shared[at][0]);
                    values.map(|value| value * weight * point.slope)
                }
                Direction::Inwards => {
                    let slopes = shared.map_or_else(
                        || self.mesh.lagrange_derivative(stencil, y, point),
                        |shared| shared[at][1],
                    );
                    slopes.map(|slope| slope * weight)
                }
            }
        };
        let parts = (0..rule.len()).map(part).collect();
        Mapped { points, parts }
    }
}

/// One cell, with the regular rules mapped into it so far.
pub(super) struct Cell<'a> {
    assembly: &'a Assembly<'a>,
    index: usize,
    direction: Direction,
    stencil: Range<usize>,
    regular: [Option<Mapped>; REGULAR_NODES.len()],
}

impl<'a> Cell<'a> {
    pub fn new(assembly: &'a Assembly<'a>, index: usize, direction: Direction) -> Self {
        Self { assembly, index, direction, stencil: assembly.stencil(index), regular: Default::default() }
    }

    /// Adds the weights of the cell at some nodes to a matrix that begins with the first of them and with the column of the node `first_column`.
    pub fn add(&mut self, rows: Range<usize>, first_column: usize, to: &mut Mat<f64>) {
        for row in rows.clone() {
            let Some(weights) = self.weights(row) else { continue };
            for (node, weight) in self.stencil.clone().zip(weights) {
                to[(row - rows.start, node - first_column)] += weight;
            }
        }
    }

    /// Weights of the cell at a node, if it contributes there.
    fn weights(&mut self, row: usize) -> Option<Weights> {
        let weights = match self.direction {
            Direction::Outwards if row > self.index => self.profile_weights(row),
            Direction::Inwards if row <= self.index => self.pressure_weights(row),
            _ => return None,
        };
        Some(self.direction.weights(weights, self.stencil.len()))
    }

    /// Weights of the densities of the cell in the depth at a node from its outer end on.
    fn profile_weights(&mut self, row: usize) -> Weights {
        let (assembly, cell) = (self.assembly, self.index);
        let factor = assembly.kernel.profile_factor;
        if row == cell + 1 {
            return self.at_outer_end().map(|weight| factor * weight);
        }
        let node = assembly.mesh.node(row);
        let mapped = self.regular(row - cell - 1);
        let kernel = |at: usize| power(node.minus(&mapped.points[at]), -assembly.kernel.nu);
        weighted_sum(&mapped.parts, kernel).map(|weight| factor * assembly.kernel.mu * weight)
    }

    /// Weights of the densities of the cell in the integral over it with the kernel that is singular at its outer end, times `μ`.
    fn at_outer_end(&self) -> Weights {
        let (assembly, cell, stencil) = (self.assembly, self.index, &self.stencil);
        let (mesh, rule) = (assembly.mesh, &assembly.upper_end.rule);
        if cell + 1 == mesh.cells() {
            // The map is flat at the contact edge: here the rule is one in ξ, as the polynomials of this cell are.
            let width = mesh.node(cell).complement;
            let on_line = |at: usize| {
                let complement = width * rule.complements[at];
                let point = MeshPoint { value: 1.0 - complement, complement, slope: width };
                mesh.lagrange(stencil, mesh.cells() as f64, &point)
            };
            let values: Vec<Weights> = (0..rule.len()).map(on_line).collect();
            let scale = width.powf(assembly.kernel.mu);
            return weighted_sum(&values, |at| scale * rule.weights[at]);
        }
        let mapped = assembly.map(cell, &assembly.upper_end, stencil, self.direction);
        let steepness = |at: usize| {
            let left = rule.complements[at];
            power(assembly.mean_slope((cell + 1) as f64 - left, left), -assembly.kernel.nu)
        };
        weighted_sum(&mapped.parts, steepness)
    }

    /// Weights of the compressions of the cell, beyond the first, in the pressure at a node up to its inner end.
    fn pressure_weights(&mut self, row: usize) -> Weights {
        let (assembly, cell) = (self.assembly, self.index);
        if row == cell {
            let mapped = assembly.map(cell, &assembly.lower_end, &self.stencil, self.direction);
            let nodes = &assembly.lower_end.rule.nodes;
            let steepness =
                |at: usize| power(assembly.mean_slope(cell as f64, nodes[at]), -assembly.kernel.mu);
            return weighted_sum(&mapped.parts, steepness).map(|weight| -1.0 / assembly.kernel.nu * weight);
        }
        let node = assembly.mesh.node(row);
        let mapped = self.regular(cell - row);
        let kernel = |at: usize| power(mapped.points[at].minus(&node), -assembly.kernel.mu);
        weighted_sum(&mapped.parts, kernel).map(|weight| -weight)
    }

    /// Adds the cell's part of `∫ u dξ`.
    pub fn add_spring_sum(&self, sum: &mut [f64]) {
        let stencil = &self.stencil;
        let mapped =
            self.assembly.map(self.index, &self.assembly.legendre[PLAIN], stencil, Direction::Outwards);
        let part = weighted_sum(&mapped.parts, |_| 1.0);
        for (weight, part) in sum[stencil.start - 1..stencil.end - 1].iter_mut().zip(part) {
            *weight += part;
        }
    }

    /// Adds the cell's part of `∫ w dξ`, where `ξ^(-μ) w` is the polynomial.
    pub fn add_depth_sum(&self, sum: &mut [f64]) {
        let (mesh, mu) = (self.assembly.mesh, self.assembly.kernel.mu);
        let stencil = Mesh::stencil(self.index, SUM_POINTS.min(mesh.cells()), mesh.cells());
        let mapped =
            self.assembly.map(self.index, &self.assembly.legendre[PLAIN], &stencil, Direction::Outwards);
        let part = weighted_sum(&mapped.parts, |at| mapped.points[at].value.powf(mu));
        for ((weight, part), node) in
            sum[stencil.start - 1..stencil.end - 1].iter_mut().zip(part).zip(stencil)
        {
            *weight += part * mesh.node(node).value.powf(-mu);
        }
    }

    /// The Gauss-Legendre rule for a kernel that is singular `gap` cells from the cell.
    fn regular(&mut self, gap: usize) -> &Mapped {
        let (assembly, cell, direction) = (self.assembly, self.index, self.direction);
        let rule = Assembly::regular_rule(gap);
        self.regular[rule]
            .get_or_insert_with(|| assembly.map(cell, &assembly.legendre[rule], &self.stencil, direction))
    }
}

fn weighted_sum(weights: &[Weights], kernel: impl Fn(usize) -> f64) -> Weights {
    let mut sum = [0.0; MOST_POINTS];
    for (at, values) in weights.iter().enumerate() {
        let factor = kernel(at);
        for (total, value) in sum.iter_mut().zip(values) {
            *total += factor * value;
        }
    }
    sum
}

/// `sin(πν)/(π μ)`, the factor of Eq. (20) with that of the mean over its kernel; finite as `k → 1`.
pub(crate) fn profile_factor(nu: f64, mu: f64) -> f64 {
    // The sine of the smaller: next to π the other loses its digits.
    (std::f64::consts::PI * nu.min(mu)).sin() / (std::f64::consts::PI * mu)
}
