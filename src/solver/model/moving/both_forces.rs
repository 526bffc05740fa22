//! An edge of stick at rest under both forces: the compression there follows from the normal force alone.
//!
//! ```text
//! F_N = 2 c_N [∫_0^c x^k q dx + ∫_c^a x^k q dx],    d/dq_c ∫_0^c x^k q dx = c^(1+k)/(1+k)
//! ```
//!
//! since the ground within is at rest and comes to lie deeper as a whole. So `q_c` is a linear function of the springs' compressions, which takes its place
//! in their equations, and needs none of its own.

use super::{Cause, StickEdge};
use crate::numerics::linear::dot;
use crate::solver::model::{Fields, Model, StickZone};

impl Model {
    /// The normal force, N, that is held together with the tangential one under Coulomb's friction that does not change; none elsewhere.
    fn force_on_resting_edge(&self) -> Option<f64> {
        match self.moving()?.cause {
            Cause::BothForces(force) if !self.schedule.conditions().friction.remembers_slip() => Some(force),
            _ => None,
        }
    }

    /// Whether an edge of stick stays under both forces, with `q_c` a function of the compressions ([`Model::bearing_edge`]).
    pub fn bears_both_forces(&self) -> bool {
        self.force_on_resting_edge().is_some()
    }

    /// The edge of stick with the compression there by which the contact bears the normal force; as it is where it is none that both forces hold at rest.
    ///
    /// # Arguments
    /// * `stick` -- of any state of the run
    /// * `slip_area` -- `Z = a² - c²`, m²
    /// * `compression` -- of the inner springs, m, shape `(springs - 1,)`
    pub fn bearing_edge(&self, stick: &StickEdge, slip_area: f64, compression: &[f64]) -> StickEdge {
        let Some(force) = self.force_on_resting_edge() else { return stick.clone() };
        let factors = self.weighted_density_factors(stick.area, slip_area);
        let slipping = 0.5 * slip_area * dot(&factors, compression);
        let load = 0.5 * force / self.contact.half_space().normal_stiffness() - slipping;
        let deeper = (load - stick.load) / self.load_per_compression(stick.area);
        StickEdge { load, depth: stick.depth + deeper, ..stick.clone() }
    }

    /// The stick zone with that edge.
    pub fn bearing_zone(&self, stick: &StickEdge, slip_area: f64, compression: &[f64]) -> StickZone {
        let StickEdge { area, depth, load, .. } = self.bearing_edge(stick, slip_area, compression);
        StickZone { stick_area: area, slip_compression: depth, stick_load: load }
    }

    /// Scales compressions, m, so that those at the edge of stick by the balance and by a guess, m, are in the same proportion to them.
    pub fn scale_to_bear(&self, stick: &StickEdge, guess: f64, slip_area: f64, compression: &mut [f64]) {
        let of = |compression: &[f64]| self.bearing_zone(stick, slip_area, compression).slip_compression;
        let unloaded = of(&vec![0.0; compression.len()]);
        let factor = unloaded / (guess + unloaded - of(compression));
        compression.iter_mut().for_each(|q| *q *= factor);
    }

    /// Derivatives of that compression by those of the inner springs and by `Z`, 1/m, shape `(springs,)`.
    pub fn bearing_slopes(&self, fields: &Fields, compression: &[f64]) -> Vec<f64> {
        let StickZone { stick_area, .. } = fields.stick_zone;
        let per_load = self.load_per_compression(stick_area).recip();
        let factors = self.weighted_density_factors(stick_area, fields.slip_area);
        let nodes = &self.annulus().operators.abel.nodes()[1..];
        // Springs move outwards with the contact edge, where fewer of them are as stiff.
        let of_edge = |(i, factor): (usize, &f64)| {
            let grown = fields.slip_area * nodes[i];
            factor * compression[i] * (1.0 - self.mu() * grown / (stick_area + grown))
        };
        let by_edge: f64 = factors.iter().enumerate().map(of_edge).sum();
        let by_springs = factors.iter().map(|factor| -0.5 * fields.slip_area * per_load * factor);
        by_springs.chain([-0.5 * per_load * by_edge]).collect()
    }

    /// `c^(1+k)/(1+k)`, m^(1+k).
    fn load_per_compression(&self, stick_area: f64) -> f64 {
        let exponent = 1.0 + self.contact.half_space().grading();
        stick_area.powf(0.5 * exponent) / exponent
    }

    /// Weights of the compressions of the inner springs in `2/Z ∫_c^a x^k q dx`.
    fn weighted_density_factors(&self, stick_area: f64, slip_area: f64) -> Vec<f64> {
        let abel = &self.annulus().operators.abel;
        let factor = |x: &f64| (stick_area + slip_area * x).powf(-self.mu());
        let inner = self.springs() - 1;
        abel.nodes()[1..=inner].iter().zip(abel.spring_sum()).map(|(x, weight)| weight * factor(x)).collect()
    }
}
