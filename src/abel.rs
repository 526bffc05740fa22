//! The transforms between springs and space as product-integration operators on a mesh of the slip annulus.
//!
//! With `s = x²`, `t = r²` and `ν = (1+k)/2` Eqs. (20) and (21) are convolutions in `s`. On nodes `s = c² + Z ξ` they depend on the outer
//! edge `Z = a² - c²` of the annulus through a power alone, so operators assembled once on `ξ` in (0, 1] serve while the edge moves:
//!
//! ```text
//! (F q)(ξ_i)  =  Z^(1-ν) Σ_j F_ij s_j^(ν-1) q_j         the part of Eq. (20) that comes from c < x <= r
//! p(ξ_i)      =  (c_N/π) Z^(ν-1) Σ_j P_ij q_j           Eq. (21) as corrected, with q = 0 at the edge
//! ```
//!
//! `F` integrates the local polynomial through the densities `s^(ν-1) q`, `P` the one through the compressions `q`, both against the exact
//! kernel, with Gauss-Jacobi rules where that is singular. Polynomials are those of the [`Mesh`]. Where the clustering is
//! [`Clustering::Smooth`], the compression is linear in the last cell: the contact edge meets unworn ground there, and a polynomial of degree 5
//! through it makes the pressure next to it negative on coarse meshes. In the first cell, which the mesh makes tiny, the compression is
//! constant: it may jump at the stick edge, as it does in the limit.

use std::ops::Range;

use faer::Mat;

use crate::error::{Error, Result};
use crate::grid::{Clustering, MOST_POINTS, Mesh, MeshPoint};
use crate::quadrature::Rule;

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

/// Product-integration operators of one grading on one mesh.
#[derive(Debug, Clone)]
pub struct AbelOperators {
    mesh: Mesh,
    profile: Mat<f64>,
    pressure: Mat<f64>,
    spring_sum: Vec<f64>,
    depth_sum: Vec<f64>,
}

impl AbelOperators {
    /// Assembles the operators.
    ///
    /// # Arguments
    /// * `grading` -- `k` in (-1, 1)
    /// * `mesh` -- `n` cells
    ///
    /// # Errors
    /// Those of the quadrature rules.
    pub fn new(grading: f64, mesh: Mesh) -> Result<Self> {
        let n = mesh.cells();
        let (mut profile, mut pressure) = (Mat::zeros(n, n), Mat::zeros(n, n));
        let (mut spring_sum, mut depth_sum) = (vec![0.0; n], vec![0.0; n]);
        let assembly = Assembly::new(grading, &mesh)?;
        for index in 0..n {
            let mut cell = Cell { assembly: &assembly, index, regular: Default::default() };
            cell.add_profile(&mut profile);
            if index > 0 {
                cell.add_pressure(&mut pressure);
            }
            cell.add_spring_sum(&mut spring_sum);
            cell.add_depth_sum(&mut depth_sum);
        }
        Ok(Self { mesh, profile, pressure, spring_sum, depth_sum })
    }

    /// Number of nodes with `ξ > 0`.
    pub fn len(&self) -> usize {
        self.spring_sum.len()
    }

    /// Whether there is no node; never true.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Nodes `ξ`, shape `(n + 1,)`, from 0 at the stick edge to 1 at the contact edge.
    pub fn nodes(&self) -> &[f64] {
        self.mesh.nodes()
    }

    /// Matrix `F` of Eq. (20), shape `(n, n)`: densities at `ξ_1 ... ξ_n` to depths there, for `Z = 1`.
    pub fn profile(&self) -> &Mat<f64> {
        &self.profile
    }

    /// Matrix `P` of Eq. (21), shape `(n, n)`: compressions at `ξ_1 ... ξ_n` to `π p/c_N` there, for `Z = 1`; its last row is zero.
    pub fn pressure(&self) -> &Mat<f64> {
        &self.pressure
    }

    /// Weights `(n,)` of `∫_0^1 u dξ` for a density `u` given at `ξ_1 ... ξ_n`.
    pub fn spring_sum(&self) -> &[f64] {
        &self.spring_sum
    }

    /// Weights `(n,)` of `∫_0^1 w dξ` for a depth `w` given at `ξ_1 ... ξ_n`, of which `ξ^(ν-1) w` is smooth.
    pub fn depth_sum(&self) -> &[f64] {
        &self.depth_sum
    }
}

/// `sin(πν)/(π μ)`, the factor of Eq. (20) with that of the mean over its kernel; finite as `k → 1`.
pub(crate) fn profile_factor(nu: f64, mu: f64) -> f64 {
    // The sine of the smaller: next to π the other loses its digits.
    (std::f64::consts::PI * nu.min(mu)).sin() / (std::f64::consts::PI * mu)
}

/// Everything that the weights of one cell need.
struct Assembly<'a> {
    mesh: &'a Mesh,
    nu: f64,
    mu: f64,
    /// `sin(πν)/(π (1-ν))`: finite as `k → 1`, where `1/(1-ν)` diverges.
    profile_factor: f64,
    upper_end: Rule,
    lower_end: Rule,
    legendre: Vec<Rule>,
}

/// Weights of one row over the stencil of a cell.
type Weights = [f64; MOST_POINTS];

/// A rule mapped into a cell with the local polynomials on its points.
struct Mapped {
    points: Vec<MeshPoint>,
    /// Weight times polynomial times `dξ/dy`.
    values: Vec<Weights>,
    /// Weight times derivative by `y` of the polynomial.
    slopes: Vec<Weights>,
}

impl<'a> Assembly<'a> {
    fn new(grading: f64, mesh: &'a Mesh) -> Result<Self> {
        let (nu, mu) = (0.5 * (1.0 + grading), 0.5 * (1.0 - grading));
        if !(nu > 0.0 && mu > 0.0) {
            return Err(Error::OutOfRange { name: "half_space.grading", value: grading, range: "(-1, 1)" });
        }
        Ok(Self {
            mesh,
            nu,
            mu,
            profile_factor: profile_factor(nu, mu),
            upper_end: Rule::jacobi(SINGULAR_NODES, -nu, 0.0)?,
            lower_end: Rule::jacobi(SINGULAR_NODES, 0.0, -mu)?,
            legendre: REGULAR_NODES.into_iter().map(Rule::legendre).collect::<Result<_>>()?,
        })
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
        self.legendre[0].mean(|part| self.mesh.at(y + part * width).slope)
    }

    /// Nodes of the local polynomial of a cell.
    fn stencil(&self, cell: usize) -> Range<usize> {
        let last = self.mesh.cells();
        match self.mesh.clustering() {
            _ if cell == 0 => 1..2,
            Clustering::Smooth if cell + 1 == last => last - 1..last + 1,
            clustering => Mesh::stencil(cell, clustering.degree() + 1, last),
        }
    }

    fn map(&self, cell: usize, rule: &Rule, stencil: &Range<usize>) -> Mapped {
        let count = rule.len();
        let mut mapped = Mapped {
            points: Vec::with_capacity(count),
            values: Vec::with_capacity(count),
            slopes: Vec::with_capacity(count),
        };
        for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
            let y = cell as f64 + node;
            let point = self.mesh.at(y);
            let value = self.mesh.lagrange(stencil, y, &point);
            let slope = self.mesh.lagrange_derivative(stencil, y, &point);
            mapped.values.push(value.map(|v| v * weight * point.slope));
            mapped.slopes.push(slope.map(|v| v * weight));
            mapped.points.push(point);
        }
        mapped
    }
}

/// One cell, with the regular rules mapped into it so far.
struct Cell<'a> {
    assembly: &'a Assembly<'a>,
    index: usize,
    regular: [Option<Mapped>; REGULAR_NODES.len()],
}

impl Cell<'_> {
    /// Adds what the densities of the cell contribute to the depths at its outer end and beyond.
    fn add_profile(&mut self, matrix: &mut Mat<f64>) {
        let (assembly, cell) = (self.assembly, self.index);
        let (stencil, factor) = (assembly.stencil(cell), assembly.profile_factor);
        add(matrix, cell, &stencil, factor, self.at_outer_end(&stencil));
        for row in cell + 2..=assembly.mesh.cells() {
            let node = assembly.mesh.node(row);
            let mapped = self.regular(row - cell - 1);
            let kernel = |at: usize| node.minus(&mapped.points[at]).powf(-assembly.nu);
            add(matrix, row - 1, &stencil, factor * assembly.mu, weighted_sum(&mapped.values, kernel));
        }
    }

    /// Weights of the densities of the cell in the integral over it with the kernel that is singular at its outer end, times `μ`.
    fn at_outer_end(&self, stencil: &Range<usize>) -> Weights {
        let (assembly, cell) = (self.assembly, self.index);
        let (mesh, rule) = (assembly.mesh, &assembly.upper_end);
        if cell + 1 == mesh.cells() {
            // The map is flat at the contact edge: here the rule is one in ξ, as the polynomials of this cell are.
            let width = mesh.node(cell).complement;
            let on_line = |at: usize| {
                let complement = width * rule.complements[at];
                let point = MeshPoint { value: 1.0 - complement, complement, slope: width };
                mesh.lagrange(stencil, mesh.cells() as f64, &point)
            };
            let values: Vec<Weights> = (0..rule.len()).map(on_line).collect();
            let scale = width.powf(assembly.mu);
            return weighted_sum(&values, |at| scale * rule.weights[at]);
        }
        let mapped = assembly.map(cell, rule, stencil);
        let steepness = |at: usize| {
            let left = rule.complements[at];
            assembly.mean_slope((cell + 1) as f64 - left, left).powf(-assembly.nu)
        };
        weighted_sum(&mapped.values, steepness)
    }

    /// Adds what the compressions of the cell contribute to the pressures at its inner end and further in.
    fn add_pressure(&mut self, matrix: &mut Mat<f64>) {
        let (assembly, cell) = (self.assembly, self.index);
        let (stencil, rule) = (assembly.stencil(cell), &assembly.lower_end);
        let mapped = assembly.map(cell, rule, &stencil);
        let steepness = |at: usize| assembly.mean_slope(cell as f64, rule.nodes[at]).powf(-assembly.mu);
        add(matrix, cell - 1, &stencil, -1.0 / assembly.nu, weighted_sum(&mapped.slopes, steepness));
        for row in 1..cell {
            let node = assembly.mesh.node(row);
            let mapped = self.regular(cell - row);
            let kernel = |at: usize| mapped.points[at].minus(&node).powf(-assembly.mu);
            add(matrix, row - 1, &stencil, -1.0, weighted_sum(&mapped.slopes, kernel));
        }
    }

    /// Adds the cell's part of `∫ u dξ`.
    fn add_spring_sum(&self, sum: &mut [f64]) {
        let stencil = self.assembly.stencil(self.index);
        let mapped = self.assembly.map(self.index, &self.assembly.legendre[PLAIN], &stencil);
        let part = weighted_sum(&mapped.values, |_| 1.0);
        for (weight, part) in sum[stencil.start - 1..stencil.end - 1].iter_mut().zip(part) {
            *weight += part;
        }
    }

    /// Adds the cell's part of `∫ w dξ`, where `ξ^(-μ) w` is the polynomial.
    fn add_depth_sum(&self, sum: &mut [f64]) {
        let (mesh, mu) = (self.assembly.mesh, self.assembly.mu);
        let stencil = Mesh::stencil(self.index, SUM_POINTS.min(mesh.cells()), mesh.cells());
        let mapped = self.assembly.map(self.index, &self.assembly.legendre[PLAIN], &stencil);
        let part = weighted_sum(&mapped.values, |at| mapped.points[at].value.powf(mu));
        for ((weight, part), node) in
            sum[stencil.start - 1..stencil.end - 1].iter_mut().zip(part).zip(stencil)
        {
            *weight += part * mesh.node(node).value.powf(-mu);
        }
    }

    /// The Gauss-Legendre rule for a kernel that is singular `gap` cells from the cell.
    fn regular(&mut self, gap: usize) -> &Mapped {
        let (assembly, cell) = (self.assembly, self.index);
        let rule = Assembly::regular_rule(gap);
        self.regular[rule]
            .get_or_insert_with(|| assembly.map(cell, &assembly.legendre[rule], &assembly.stencil(cell)))
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

/// Adds `scale` times the weights of a stencil to a row; what is at the contact edge is zero where there is no column for it.
fn add(matrix: &mut Mat<f64>, row: usize, stencil: &Range<usize>, scale: f64, weights: Weights) {
    for (node, weight) in stencil.clone().zip(weights) {
        matrix[(row, node - 1)] += scale * weight;
    }
}
