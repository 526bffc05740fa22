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
//! [`Clustering::Smooth`](crate::numerics::grid::Clustering::Smooth), the compression is linear in the last cell: the contact edge meets unworn ground
//! there, and a polynomial of degree 5 through it makes the pressure next to it negative on coarse meshes. In the first cell, which the mesh
//! makes tiny, the compression is constant: it may jump at the stick edge, as it does in the limit.
//!
//! Two backends apply the same weights behind [`Transform`]: matrices ([`Matrix`]), and for many springs what takes `O(n)` numbers and operations
//! ([`Hierarchical`]).

mod compressed;
mod hierarchical;
mod weights;

use faer::Mat;

use crate::error::Result;
use crate::numerics::grid::Mesh;
use crate::numerics::linear::multiply;
pub use compressed::{Block, Compressed};
pub use hierarchical::Hierarchical;
pub(crate) use weights::profile_factor;
use weights::{Assembly, Cell, Direction, Kernel};

/// A transform between the springs.
pub trait Transform {
    /// `y = A x`; what `x` is too short for is zero.
    ///
    /// # Arguments
    /// * `x` -- at the springs from the first one off the edge of stick on, shape `(n,)` or shorter
    /// * `y` -- receives the product, shape `(n,)`
    fn apply(&self, x: &[f64], y: &mut [f64]);
}

/// A transform as a dense matrix.
#[derive(Debug, Clone)]
pub struct Matrix {
    direction: Direction,
    weights: Mat<f64>,
}

impl Matrix {
    fn new(assembly: &Assembly<'_>, direction: Direction) -> Self {
        let n = assembly.mesh.cells();
        let mut matrix = Mat::zeros(n, n);
        for index in direction.first_cell()..n {
            Cell::new(assembly, index, direction).add(1..n + 1, 1, &mut matrix);
        }
        Self { direction, weights: matrix }
    }
}

impl Transform for Matrix {
    fn apply(&self, x: &[f64], y: &mut [f64]) {
        multiply(self.weights.as_ref(), &self.direction.acts_on(x), y);
    }
}

/// Eqs. (20) and (21).
const BOTH: [Direction; 2] = [Direction::Outwards, Direction::Inwards];

/// Which of the backends applies the transforms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Backend {
    /// Matrices.
    Dense,
    /// Hierarchical ones.
    Hierarchical,
}

/// The transforms of one backend.
#[derive(Debug, Clone)]
enum Pair {
    Dense([Matrix; 2]),
    Hierarchical(Box<[Hierarchical; 2]>),
}

/// Product-integration operators of one grading on one mesh.
#[derive(Debug, Clone)]
pub struct AbelOperators {
    kernel: Kernel,
    mesh: Mesh,
    pair: Pair,
    spring_sum: Vec<f64>,
    depth_sum: Vec<f64>,
}

impl AbelOperators {
    /// Assembles the operators as matrices.
    ///
    /// # Arguments
    /// * `grading` -- `k` in (-1, 1)
    /// * `mesh` -- `n` cells
    ///
    /// # Errors
    /// Those of the quadrature rules.
    pub fn new(grading: f64, mesh: Mesh) -> Result<Self> {
        Self::with(Backend::Dense, grading, mesh)
    }

    /// Assembles the operators for a backend.
    ///
    /// # Errors
    /// As [`AbelOperators::new`].
    pub fn with(backend: Backend, grading: f64, mesh: Mesh) -> Result<Self> {
        let n = mesh.cells();
        let assembly = Assembly::new(grading, &mesh)?;
        let (mut spring_sum, mut depth_sum) = (vec![0.0; n], vec![0.0; n]);
        for index in 0..n {
            let cell = Cell::new(&assembly, index, Direction::Outwards);
            cell.add_spring_sum(&mut spring_sum);
            cell.add_depth_sum(&mut depth_sum);
        }
        let pair = match backend {
            Backend::Dense => Pair::Dense(BOTH.map(|direction| Matrix::new(&assembly, direction))),
            Backend::Hierarchical => {
                Pair::Hierarchical(Box::new(BOTH.map(|direction| Hierarchical::new(&assembly, direction))))
            }
        };
        Ok(Self { kernel: assembly.kernel, mesh, pair, spring_sum, depth_sum })
    }

    /// The transforms of Eqs. (20) and (21), of densities at `ξ_1 ... ξ_n` to depths there and of compressions to `π p/c_N`, for `Z = 1`; the
    /// last pressure is zero.
    pub fn transforms(&self) -> [&dyn Transform; 2] {
        match &self.pair {
            Pair::Dense([profile, pressure]) => [profile, pressure],
            Pair::Hierarchical(pair) => [&pair[0], &pair[1]],
        }
    }

    /// Which backend it is.
    pub fn backend(&self) -> Backend {
        match &self.pair {
            Pair::Dense(_) => Backend::Dense,
            Pair::Hierarchical(_) => Backend::Hierarchical,
        }
    }

    /// The hierarchical transforms, if it is those.
    pub fn hierarchical(&self) -> Option<[&Hierarchical; 2]> {
        match &self.pair {
            Pair::Dense(_) => None,
            Pair::Hierarchical(pair) => Some([&pair[0], &pair[1]]),
        }
    }

    /// Number of nodes with `ξ > 0`.
    pub fn len(&self) -> usize {
        self.spring_sum.len()
    }

    /// Whether there is no node; never true.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Grading `k`.
    pub fn grading(&self) -> f64 {
        self.kernel.grading
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
    ///
    /// # Panics
    /// If the backend is not [`Backend::Dense`].
    pub fn profile(&self) -> &Mat<f64> {
        &self.matrices()[0].weights
    }

    /// Matrix of Eq. (21), shape `(n, n)`: differences `q_2 - q_1, ..., q_n - q_(n-1), -q_n` of the compressions at `ξ_1 ... ξ_n` to `π p/c_N`
    /// there, for `Z = 1`; its last row is zero, and so is its last column.
    ///
    /// # Panics
    /// As [`AbelOperators::profile`].
    pub fn pressure_by_differences(&self) -> &Mat<f64> {
        &self.matrices()[1].weights
    }

    /// `P_ij` of Eq. (21): compression at the spring `j` to `π p/c_N` at the spring `i`, for `Z = 1`.
    ///
    /// # Panics
    /// As [`AbelOperators::profile`].
    pub fn pressure(&self, i: usize, j: usize) -> f64 {
        let weights = self.pressure_by_differences();
        let before = if j > 0 { weights[(i, j - 1)] } else { 0.0 };
        before - weights[(i, j)]
    }

    /// Adds the column `j` of `P`, see [`AbelOperators::pressure`], times a factor, shape `(springs,)`.
    ///
    /// # Panics
    /// As [`AbelOperators::profile`].
    pub fn add_pressure(&self, j: usize, factor: f64, to: &mut [f64]) {
        let weights = self.pressure_by_differences();
        let column = weights.col_as_slice(j);
        if j == 0 {
            to.iter_mut().zip(column).for_each(|(to, weight)| *to -= factor * weight);
            return;
        }
        let pairs = weights.col_as_slice(j - 1).iter().zip(column);
        to.iter_mut().zip(pairs).for_each(|(to, (before, weight))| *to += factor * (before - weight));
    }

    fn matrices(&self) -> &[Matrix; 2] {
        match &self.pair {
            Pair::Dense(matrices) => matrices,
            Pair::Hierarchical(_) => panic!("matrices asked of operators without any"),
        }
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
