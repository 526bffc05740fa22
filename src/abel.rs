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
//! kernel. Degree 1 makes them exact for piecewise linear data, degree 3 for piecewise cubic data. In the first cell, which the mesh
//! makes tiny, the compression is constant: it may jump at the stick edge, as it does in the limit.

use faer::Mat;

use crate::error::{Error, Result};
use crate::grid::{lagrange, lagrange_derivative, stencil_start};
use crate::quadrature::Rule;

/// Nodes of the rule in the cell that holds the end-point singularity: exact for every local polynomial used here.
const SINGULAR_NODES: usize = 6;

/// Sizes of the Gauss-Legendre rules for the cells beside it; the largest is enough for a gap of a twentieth of the cell.
const REGULAR_NODES: [usize; 9] = [3, 4, 5, 6, 8, 12, 16, 24, 44];

/// Indices in [`REGULAR_NODES`] of the rules for the plain integrals: exact for the local polynomials, and accurate for a power.
const PLAIN: usize = 1;
const POWER: usize = 5;

/// Most nodes of a local polynomial.
const MOST_POINTS: usize = 4;

/// Nodes of the local polynomial through the wear depth in its integral: two more, so that the volume keeps up with the depth.
const SUM_POINTS: usize = 6;

/// Product-integration operators of one grading on one mesh.
#[derive(Debug, Clone)]
pub struct AbelOperators {
    nodes: Vec<f64>,
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
    /// * `nodes` -- `ξ`, shape `(n + 1,)`, increasing from 0 to 1, `n >= 4`
    /// * `degree` -- degree of the local polynomials: 1, 2 or 3
    ///
    /// # Errors
    /// Those of the quadrature rules.
    ///
    /// # Panics
    /// If the nodes or the degree are not as stated.
    pub fn new(grading: f64, nodes: Vec<f64>, degree: usize) -> Result<Self> {
        let n = nodes.len() - 1;
        assert!((1..MOST_POINTS).contains(&degree) && n > degree, "degree {degree} on {n} cells");
        assert!(nodes[0] == 0.0 && nodes[n] == 1.0 && nodes.windows(2).all(|pair| pair[1] > pair[0]));
        let assembly = Assembly::new(grading, &nodes, degree + 1)?;
        let mut operators = Self {
            profile: Mat::zeros(n, n),
            pressure: Mat::zeros(n, n),
            spring_sum: vec![0.0; n],
            depth_sum: vec![0.0; n],
            nodes: vec![],
        };
        for cell in 0..n {
            assembly.add_cell(cell, &mut operators);
        }
        operators.nodes = nodes;
        Ok(operators)
    }

    /// Number of nodes with `ξ > 0`.
    pub fn len(&self) -> usize {
        self.spring_sum.len()
    }

    /// Whether there is no node; never true.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Nodes `ξ`, shape `(n + 1,)`, from 0 at the stick edge to 1 at the contact edge.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
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
    nodes: &'a [f64],
    points: usize,
    nu: f64,
    mu: f64,
    /// `sin(πν)/(π (1-ν))`: finite as `k → 1`, where `1/(1-ν)` diverges.
    profile_factor: f64,
    upper_end: Rule,
    lower_end: Rule,
    depth_end: Rule,
    legendre: Vec<Rule>,
}

/// A rule mapped into a cell with the local polynomials on its points.
#[derive(Clone)]
struct Mapped {
    points: Vec<f64>,
    /// Weight times polynomial, shape `(points,)` of arrays over the stencil.
    values: Vec<[f64; MOST_POINTS]>,
    slopes: Vec<[f64; MOST_POINTS]>,
}

impl<'a> Assembly<'a> {
    fn new(grading: f64, nodes: &'a [f64], points: usize) -> Result<Self> {
        let (nu, mu) = (0.5 * (1.0 + grading), 0.5 * (1.0 - grading));
        if !(nu > 0.0 && mu > 0.0) {
            return Err(Error::OutOfRange { name: "half_space.grading", value: grading, range: "(-1, 1)" });
        }
        Ok(Self {
            nodes,
            points,
            nu,
            mu,
            profile_factor: profile_factor(nu, mu),
            upper_end: Rule::jacobi(SINGULAR_NODES, -nu, 0.0)?,
            lower_end: Rule::jacobi(SINGULAR_NODES, 0.0, -mu)?,
            depth_end: Rule::jacobi(SINGULAR_NODES, 0.0, mu)?,
            legendre: REGULAR_NODES.into_iter().map(Rule::legendre).collect::<Result<_>>()?,
        })
    }

    /// Index of the Gauss-Legendre rule that integrates a kernel singular `gap` widths from the cell to round-off.
    fn regular_rule(gap: f64) -> usize {
        let ellipse = 1.0 + 2.0 * gap + 2.0 * (gap * (1.0 + gap)).sqrt();
        let needed = 18.5 / ellipse.ln() + 2.0;
        REGULAR_NODES.partition_point(|nodes| (*nodes as f64) < needed).min(REGULAR_NODES.len() - 1)
    }

    /// Nodes of the local polynomial of a cell: indices of the first and one past the last.
    fn stencil(&self, cell: usize) -> (usize, usize) {
        if cell == 0 {
            return (1, 2);
        }
        let start = stencil_start(cell, self.points, self.nodes.len() - 1);
        (start, start + self.points)
    }

    fn map(&self, cell: usize, rule: &Rule, (start, end): (usize, usize)) -> Mapped {
        let (left, width) = (self.nodes[cell], self.nodes[cell + 1] - self.nodes[cell]);
        let stencil = &self.nodes[start..end];
        let (mut points, mut values, mut slopes) = (vec![], vec![], vec![]);
        for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
            let x = left + width * node;
            let (mut value, mut slope) = ([0.0; MOST_POINTS], [0.0; MOST_POINTS]);
            lagrange(stencil, x, &mut value);
            lagrange_derivative(stencil, x, &mut slope);
            points.push(width * node);
            values.push(value.map(|v| v * weight));
            slopes.push(slope.map(|v| v * weight));
        }
        Mapped { points, values, slopes }
    }

    fn add_cell(&self, cell: usize, into: &mut AbelOperators) {
        let mut mapped = Cell { assembly: self, index: cell, regular: vec![None; REGULAR_NODES.len()] };
        mapped.add_profile(&mut into.profile);
        if cell > 0 {
            mapped.add_pressure(&mut into.pressure);
        }
        self.add_sums(cell, self.nodes[cell + 1] - self.nodes[cell], self.stencil(cell), into);
    }

    /// Adds the cell's part of the weights of the plain integrals.
    fn add_sums(&self, cell: usize, width: f64, stencil: (usize, usize), into: &mut AbelOperators) {
        let spring = self.map(cell, &self.legendre[PLAIN], stencil);
        for value in &spring.values {
            for (weight, part) in into.spring_sum[stencil.0 - 1..stencil.1 - 1].iter_mut().zip(value) {
                *weight += width * part;
            }
        }
        let last = self.nodes.len() - 1;
        let points = SUM_POINTS.min(last);
        let start = stencil_start(cell, points, last);
        let left = self.nodes[cell];
        let rule = if cell == 0 { &self.depth_end } else { &self.legendre[POWER] };
        for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
            let x = left + width * node;
            let power = if cell == 0 { width.powf(self.mu) / (1.0 + self.mu) } else { x.powf(self.mu) };
            let mut values = [0.0; SUM_POINTS];
            lagrange(&self.nodes[start..start + points], x, &mut values);
            for (index, value) in (start..start + points).zip(values) {
                into.depth_sum[index - 1] +=
                    width * power * weight * value * self.nodes[index].powf(-self.mu);
            }
        }
    }
}

/// One cell, with the regular rules mapped into it so far.
struct Cell<'a> {
    assembly: &'a Assembly<'a>,
    index: usize,
    regular: Vec<Option<Mapped>>,
}

impl Cell<'_> {
    /// Adds what the densities of the cell contribute to the depths at its outer end and beyond.
    fn add_profile(&mut self, matrix: &mut Mat<f64>) {
        let (assembly, cell) = (self.assembly, self.index);
        let (left, right, width) = self.bounds();
        let (first, points) = (assembly.stencil(cell).0, assembly.points);
        let end = assembly.map(cell, &assembly.upper_end, assembly.stencil(cell));
        let factor = assembly.profile_factor;
        add(matrix, cell, first, factor * width.powf(assembly.mu), &end.values, points);
        for row in cell + 2..assembly.nodes.len() {
            let node = assembly.nodes[row];
            let mapped = self.regular((node - right) / width);
            let kernel = |point: f64| (node - left - point).powf(-assembly.nu);
            let sum = weighted_sum(&mapped.points, &mapped.values, kernel);
            add(matrix, row - 1, first, factor * assembly.mu * width, &[sum], points);
        }
    }

    /// Adds what the compressions of the cell contribute to the pressures at its inner end and further in.
    fn add_pressure(&mut self, matrix: &mut Mat<f64>) {
        let (assembly, cell) = (self.assembly, self.index);
        let (left, _, width) = self.bounds();
        let (first, points) = (assembly.stencil(cell).0, assembly.points);
        let end = assembly.map(cell, &assembly.lower_end, assembly.stencil(cell));
        add(matrix, cell - 1, first, -width.powf(assembly.nu) / assembly.nu, &end.slopes, points);
        for row in 1..cell {
            let node = assembly.nodes[row];
            let mapped = self.regular((left - node) / width);
            let kernel = |point: f64| (left - node + point).powf(-assembly.mu);
            let sum = weighted_sum(&mapped.points, &mapped.slopes, kernel);
            add(matrix, row - 1, first, -width, &[sum], points);
        }
    }

    /// The Gauss-Legendre rule for a kernel that is singular `gap` widths from the cell.
    fn regular(&mut self, gap: f64) -> &Mapped {
        let rule = Assembly::regular_rule(gap);
        let (assembly, cell) = (self.assembly, self.index);
        self.regular[rule]
            .get_or_insert_with(|| assembly.map(cell, &assembly.legendre[rule], assembly.stencil(cell)))
    }

    /// Left and right end and width.
    fn bounds(&self) -> (f64, f64, f64) {
        let (left, right) = (self.assembly.nodes[self.index], self.assembly.nodes[self.index + 1]);
        (left, right, right - left)
    }
}

fn weighted_sum(
    points: &[f64],
    weights: &[[f64; MOST_POINTS]],
    kernel: impl Fn(f64) -> f64,
) -> [f64; MOST_POINTS] {
    let mut sum = [0.0; MOST_POINTS];
    for (point, values) in points.iter().zip(weights) {
        let factor = kernel(*point);
        for (total, value) in sum.iter_mut().zip(values) {
            *total += factor * value;
        }
    }
    sum
}

/// Adds `scale` times the sum of `parts` to a row, from the column of node `first` on.
fn add(
    matrix: &mut Mat<f64>,
    row: usize,
    first: usize,
    scale: f64,
    parts: &[[f64; MOST_POINTS]],
    points: usize,
) {
    for part in parts {
        for (offset, value) in part.iter().enumerate().take(points) {
            if first - 1 + offset < matrix.ncols() {
                matrix[(row, first - 1 + offset)] += scale * value;
            }
        }
    }
}
