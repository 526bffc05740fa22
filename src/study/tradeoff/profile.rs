//! Worn profiles on other radii than their own.

use crate::contact::InitialContact;
use crate::data::{RunFile, Snapshot};
use crate::numerics::grid::{Clustering, Mesh, lagrange};

/// Cells of the mesh that gives the common radii.
const COMMON: usize = 64;

/// A node next to the contact edge gives way to it from this part of its distance from its neighbour on.
const CLOSE: f64 = 1e-2;

/// Points of the local polynomials.
const POINTS: usize = 4;

/// The factor that makes a wear depth smooth, and the radii on which depths are compared.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    /// Stick radius, m, and the exponent `(1-k)/2`; none where the edge of stick moves over worn ground, or there is none.
    edge: Option<(f64, f64)>,
    /// Radii that all candidates are compared on, m.
    pub(super) radii: Vec<f64>,
}

impl Shape {
    /// For runs whose edge of stick stays, or does not.
    pub(super) fn new(contact: &InitialContact, stays: bool, run: &RunFile) -> Self {
        let exponent = 0.5 * (1.0 - contact.half_space().grading());
        let edge = contact.stick_radius().filter(|_| stays).map(|c| (c, exponent));
        let first = run.header.radius.first().map_or(0.0, |r| r * r);
        let inner = edge.map_or(first, |(c, _)| c * c);
        let outer = run.header.radius.last().map_or(0.0, |r| r * r);
        let stretch = if edge.is_some() { (outer / inner).ln() } else { 0.0 };
        let mesh = Mesh::new(COMMON, stretch, Clustering::Cubic);
        let radii = mesh.nodes()[1..COMMON].iter().map(|x| (inner + x * (outer - inner)).sqrt()).collect();
        Self { edge, radii }
    }

    /// `(r²-c²)^((1-k)/2)`, by which a depth is divided to make it smooth; m to the same power twice.
    fn factor(&self, r: f64) -> f64 {
        self.edge.map_or(1.0, |(c, exponent)| ((r - c) * (r + c)).max(0.0).powf(exponent))
    }

    /// The variable of the interpolation, `(r²-c²)^(1/3)` as the springs are graded: the layer at the edge of stick narrows in time.
    fn place(&self, r: f64) -> f64 {
        self.edge.map_or(r * r, |(c, _)| ((r - c) * (r + c)).cbrt())
    }

    /// Depth, m, at some radii, by local cubics of the smooth part; zero beyond the contact edge, which is a node of its own.
    pub(super) fn depth_at(&self, nodes: &[f64], snapshot: &Snapshot, radii: &[f64]) -> Vec<f64> {
        let (mut places, mut smooth) = (vec![], vec![]);
        for (r, depth) in nodes.iter().zip(&snapshot.wear_depth) {
            let factor = self.factor(*r);
            places.push(self.place(*r));
            smooth.push(if factor > 0.0 { depth / factor } else { 0.0 });
        }
        let edge = self.place(snapshot.contact_radius);
        let inside = places.partition_point(|place| *place < edge);
        if self.edge.is_some() && (2..places.len()).contains(&inside) {
            let spacing = places[inside - 1] - places[inside - 2];
            let close = edge - places[inside - 1] < CLOSE * spacing;
            let kept = if close { inside - 1 } else { inside };
            places.truncate(kept);
            smooth.truncate(kept);
            places.push(edge);
            smooth.push(0.0);
        }
        let last = places.last().copied().unwrap_or(0.0);
        let at = |r: &f64| match self.place(*r) {
            place if place > last => 0.0,
            place => self.factor(*r) * cubic(&places, &smooth, place),
        };
        radii.iter().map(at).collect()
    }
}

fn cubic(nodes: &[f64], values: &[f64], x: f64) -> f64 {
    let points = POINTS.min(nodes.len());
    let cell = nodes.partition_point(|node| *node < x).clamp(1, nodes.len().max(2) - 1);
    let start = Mesh::stencil(cell, points, nodes.len()).start - 1;
    let start = start.min(nodes.len() - points);
    let mut weights = [0.0; POINTS];
    lagrange(&nodes[start..start + points], x, &mut weights[..points]);
    weights.iter().zip(&values[start..start + points]).map(|(weight, value)| weight * value).sum()
}
