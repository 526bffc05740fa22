//! What is given at the springs as it is seen next to an edge of stick that moves outwards.
//!
//! There wear goes by the slip `S ~ z^((3-k)/2)`, and where a law takes the power `m` of it, `W/S ~ S^(m-1)`. So the equation of `λ` (see [the module](super)) has
//!
//! ```text
//! λ = λ_0 + λ_1 z^β + ...,      β = 1 - (1-m)(3-k)/2
//! ```
//!
//! at the edge: smooth in `z` for `m = 1` alone. For less, polynomials in `z` swing from spring to spring there, and those in `z^β` do not.

use crate::numerics::grid::{Mesh, lagrange};
use crate::solver::model::derivatives::{Stencil, derivative_stencils};

/// Least power: where the edge slows down the layer in which the expansion holds becomes thinner than springs resolve, and with the power itself profiles beyond it are off by more (docs/numerics.md).
const LEAST_POWER: f64 = 0.7;

/// Polynomials in a power of the distance from the edge.
#[derive(Debug, Clone, Default)]
pub(super) struct NearEdge {
    /// Weights of `ξ ∂/∂ξ` at every spring; none where they are those of the mesh.
    derivative: Option<Vec<Stencil>>,
    /// Weights of the first three springs in what is at the edge.
    ///
    /// By the first spring alone, what the springs next to it are off by would grow in time on meshes as fine as these.
    at_edge: [f64; 3],
}

impl NearEdge {
    pub fn new(mesh: &Mesh, grading: f64, slip_exponent: f64) -> Self {
        let power = 1.0 - 0.5 * (3.0 - grading) * (1.0 - slip_exponent);
        let power = power.max(LEAST_POWER);
        let nodes = [1, 2, 3].map(|node| mesh.nodes()[node].powf(power));
        let mut at_edge = [0.0; 3];
        lagrange(&nodes, 0.0, &mut at_edge);
        Self { derivative: (power < 1.0).then(|| derivative_stencils(mesh, 0, power)), at_edge }
    }

    /// Weights of `ξ ∂/∂ξ` at every spring, where those of the mesh are given.
    pub fn derivative<'a>(&'a self, of_mesh: &'a [Stencil]) -> &'a [Stencil] {
        self.derivative.as_deref().unwrap_or(of_mesh)
    }

    /// A quantity at the edge.
    pub fn at_edge(&self, value: impl Fn(usize) -> f64) -> f64 {
        self.at_edge.iter().enumerate().map(|(i, weight)| weight * value(i)).sum()
    }
}
