//! How the fields change with the state, and the rates of the state that follow.

use std::ops::Range;

use faer::Mat;

use super::{CycleFields, Fields, Model};
use crate::error::{Error, Result};
use crate::numerics::grid::{MOST_POINTS, Mesh, lagrange_derivative};
use crate::numerics::linear::dot;

/// Weights of a derivative `ξ d/dξ` at one spring.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stencil {
    first: usize,
    count: usize,
    weights: [f64; MOST_POINTS],
}

impl Stencil {
    /// The first spring, and the weights of it and the next ones.
    pub(super) fn parts(&self) -> (usize, &[f64]) {
        (self.first, &self.weights[..self.count])
    }

    pub(super) fn apply(&self, values: &[f64]) -> f64 {
        dot(&self.weights[..self.count], &values[self.first..self.first + self.count])
    }
}

/// Weights of `ξ d/dξ` at every spring.
///
/// The material moves inwards past the springs, so the stencils lean outwards. On a smooth mesh they reach beyond the contact edge, where
/// nothing wears: so do those of the last springs not depend on what lies behind the wave alone.
///
/// # Arguments
/// * `back` -- by how many nodes they are moved inwards, for ground that moves outwards past the springs
/// * `power` -- of `ξ`, of which the local polynomials next to the edge of stick are polynomials; on a smooth mesh one
pub(super) fn derivative_stencils(mesh: &Mesh, back: usize, power: f64) -> Vec<Stencil> {
    let last = mesh.cells();
    let smooth = mesh.clustering().is_even();
    let points = mesh.clustering().degree() + 1;
    let stencil = |node: usize| {
        let nodes =
            Mesh::stencil(node.saturating_sub(back), points, if smooth { last + points } else { last });
        let place = mesh.node(node);
        // At the contact edge itself the slope of the map is zero, and nothing asks for a derivative there.
        let scale = if node == last { 0.0 } else { place.value / place.slope };
        let weights = if power != 1.0 && mesh.is_next_to_stick(&nodes) {
            let raised = |node: usize| mesh.node(node).value.powf(power);
            let mut weights = [0.0; MOST_POINTS];
            lagrange_derivative(&nodes.clone().map(raised).collect::<Vec<_>>(), raised(node), &mut weights);
            weights.map(|w| w * power * raised(node))
        } else {
            mesh.lagrange_derivative(&nodes, node as f64, &place).map(|w| w * scale)
        };
        Stencil { first: nodes.start - 1, count: nodes.end.min(last + 1) - nodes.start, weights }
    };
    (1..=last).map(stencil).collect()
}

/// What stencils make of a quantity, one by one.
pub(super) fn along(stencils: &[Stencil], values: &[f64]) -> Vec<f64> {
    stencils.iter().map(|stencil| stencil.apply(values)).collect()
}

impl Model {
    /// `ξ ∂λ/∂ξ` at every spring, for any quantity given there, shape `(springs,)`.
    pub fn along_annulus(&self, values: &[f64]) -> Vec<f64> {
        along(&self.annulus().operators.derivative, values)
    }

    /// Derivative of the elastic depth `F q` by the edge at constant compressions, dimensionless per m, shape `(springs,)`.
    pub fn elastic_depth_by_slip_area(&self, fields: &Fields) -> Vec<f64> {
        let mu = self.mu();
        let nodes = &self.annulus().operators.abel.nodes()[1..];
        let moved: Vec<f64> = fields
            .density
            .iter()
            .zip(nodes)
            .map(|(u, x)| -mu * u * x / (fields.stick_zone.stick_area + fields.slip_area * x))
            .collect();
        let mut change = vec![0.0; self.springs()];
        self.annulus().operators.abel.transforms()[0].apply(&moved, &mut change);
        let scale = fields.slip_area.powf(mu);
        change
            .iter()
            .zip(&fields.elastic_depth)
            .map(|(c, depth)| scale * c + mu / fields.slip_area * depth)
            .collect()
    }

    /// Derivative of `λ` by the edge at constant compressions, 1/m², shape `(springs,)`.
    pub fn log_slip_by_slip_area(&self, fields: &Fields) -> Vec<f64> {
        let elastic = self.elastic_depth_by_slip_area(fields);
        let nodes = &self.annulus().operators.abel.nodes()[1..];
        let rate = |i: usize| {
            let slopes = self.annulus().unworn.slopes(&fields.unworn[i]);
            (nodes[i] * slopes.limit_slip - elastic[i]) / fields.slip_depth[i] - nodes[i] * slopes.log_slip
        };
        let mut by_slip_area = vec![0.0; nodes.len()];
        self.on_springs(&mut by_slip_area, rate);
        by_slip_area
    }

    /// Derivative of the elastic depth at spring `i` by the compression of spring `j`, over `Z^(1-ν)`: `F_ij x_j^(k-1)`.
    pub fn elastic_depth_by_compression(&self, fields: &Fields, i: usize, j: usize) -> f64 {
        self.annulus().operators.abel.profile()[(i, j)] * fields.density_factor[j]
    }

    /// Rates per cycle of the edge, m², and of the compressions, m, that follow from a cycle: wear as an explicit differential
    /// equation.
    pub fn rates(&self, fields: &Fields, cycle: &CycleFields) -> (f64, Vec<f64>) {
        let inner = self.springs() - 1;
        let by_slip_area = self.log_slip_by_slip_area(fields);
        let along = self.along_annulus(&fields.log_slip);
        let slip = &fields.slip_depth;
        let mut worn: Vec<f64> = (0..inner).map(|i| -cycle.growth[i] * slip[i]).collect();
        let mut moved: Vec<f64> =
            (0..inner).map(|i| slip[i] * (by_slip_area[i] - along[i] / fields.slip_area)).collect();
        // At the edge, where wear is zero: F q' = ∂(F q_0 - F q)/∂Z Z'.
        let edge_slope = slip[inner] * by_slip_area[inner];
        let at_edge = [&mut worn, &mut moved].map(|depth| self.annulus().operators.solve_profile(depth));
        let slip_area_rate = -at_edge[0] / (at_edge[1] - edge_slope);
        let scale = fields.slip_area.powf(-self.mu());
        let rate = |i: usize| scale / fields.density_factor[i] * (worn[i] + moved[i] * slip_area_rate);
        (slip_area_rate, (0..inner).map(rate).collect())
    }

    /// Moves the edge to where the wear depth of the compressions is zero.
    pub fn close_contact_edge(&self, slip_area: f64, compression: &[f64]) -> Result<f64> {
        let last = self.springs() - 1;
        let mut slip_area = slip_area;
        let mut fields = Fields::default();
        for _ in 0..20 {
            self.evaluate(slip_area, compression, &mut fields);
            let slopes = self.annulus().unworn.slopes(&fields.unworn[last]);
            let slope = slopes.limit_slip
                - fields.unworn[last].slip * slopes.log_slip
                - self.elastic_depth_by_slip_area(&fields)[last];
            let change = -fields.wear_depth[last] / slope;
            slip_area += change;
            if change.abs() <= 1e-15 * slip_area {
                return Ok(slip_area);
            }
            if !(slip_area > 0.0 && slip_area < self.annulus().unworn.largest_slip_area()) {
                break;
            }
        }
        Err(Error::NotConverged {
            what: "contact edge",
            why: format!("a² - c² = {slip_area:e} m² after 20 iterations"),
        })
    }

    /// Adds the derivatives of `λ` by the compressions, from the left times `I - θ ξ ∂/∂ξ`, to the leading columns of a matrix.
    pub fn add_log_slip_by_compression(&self, fields: &Fields, theta: f64, matrix: &mut Mat<f64>) {
        let n = self.springs();
        let scale = fields.slip_area.powf(self.mu());
        let per_slip: Vec<f64> = fields.slip_depth.iter().map(|s| -scale / s).collect();
        let stencils = Stencils::new(&self.annulus().operators.derivative);
        // Beyond the contact edge, where stencils reach, nothing changes.
        let (mut changed, mut along) = (vec![0.0; n + MOST_POINTS], vec![0.0; n]);
        for j in 0..n - 1 {
            // Cells inside a radius add nothing to it but through the stencils that reach one node back and two ahead.
            let first = j.saturating_sub(MOST_POINTS);
            let factor = fields.density_factor[j];
            let column = self.annulus().operators.abel.profile().col_as_slice(j);
            for ((change, column), slip) in changed.iter_mut().zip(column).zip(&per_slip).skip(first) {
                *change = factor * column * slip;
            }
            stencils.apply(first, &changed, &mut along);
            let rows = matrix.col_as_slice_mut(j).iter_mut().zip(changed.iter().zip(&along));
            for (entry, (change, along)) in rows.take(n - 1).skip(first) {
                *entry += change - theta * along;
            }
            changed[first] = 0.0;
        }
    }
}

/// Stencils of all springs weight by weight, for products with many columns.
struct Stencils {
    /// The first weight of each row, the second, and so on.
    weights: [Vec<f64>; MOST_POINTS],
    /// Rows of which each begins one spring after the one before, and the spring where the first of them does.
    runs: Vec<(Range<usize>, usize)>,
}

impl Stencils {
    fn new(stencils: &[Stencil]) -> Self {
        let mut runs: Vec<(Range<usize>, usize)> = vec![];
        for run in stencils.chunk_by(|one, next| next.first == one.first + 1) {
            let begin = runs.last().map_or(0, |(rows, _)| rows.end);
            runs.push((begin..begin + run.len(), run[0].first));
        }
        let weights = std::array::from_fn(|k| stencils.iter().map(|stencil| stencil.weights[k]).collect());
        Self { weights, runs }
    }

    /// The product from a row on.
    ///
    /// # Arguments
    /// * `values` -- at the springs, and zeros beyond the last one, shape `(springs + MOST_POINTS,)`
    fn apply(&self, first: usize, values: &[f64], product: &mut [f64]) {
        product[first..].fill(0.0);
        for (rows, from) in &self.runs {
            let begin = rows.start.max(first);
            if begin >= rows.end {
                continue;
            }
            let values = &values[from + begin - rows.start..];
            for (k, weights) in self.weights.iter().enumerate() {
                let parts = weights[begin..rows.end].iter().zip(&values[k..]);
                for (to, (weight, value)) in product[begin..rows.end].iter_mut().zip(parts) {
                    *to += weight * value;
                }
            }
        }
    }
}
