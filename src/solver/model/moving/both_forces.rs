//! An edge of stick at rest under both forces: the compression there follows from the normal force alone.
//!
//! ```text
//! F_N = 2 c_N [∫_0^c x^k q dx + ∫_c^a x^k q dx],    d/dq_c ∫_0^c x^k q dx = c^(1+k)/(1+k)
//! ```
//!
//! since the ground within is at rest and comes to lie deeper as a whole. So `q_c` is a linear function of the springs' compressions, which takes its place
//! in their equations, and needs none of its own.

use super::{Cause, StickEdge, unworn_load};
use crate::numerics::linear::dot;
use crate::solver::model::{Fields, Model, State, StickZone};

/// Load of the springs, over that of the normal force, below which it is rounding.
const NO_LOAD: f64 = 1e-12;

/// How the compression at a resting edge follows from those of the springs.
///
/// The quadrature over the springs misses a part of the load in the first cycle. It is taken for the same part of what they bear ever after, so that nothing
/// is missed in the end, where they bear nothing and the limit is met whatever the mesh.
#[derive(Debug, Clone, Copy)]
pub struct Bearing {
    /// `c²`, m².
    stick_area: f64,
    /// `F_N/(2 c_N)`, m^(2+k).
    load: f64,
    /// `∫_0^c x^k (q - q_c) dx`, m^(2+k).
    within: f64,
    /// `c^(1+k)/(1+k)`, m^(1+k).
    per_compression: f64,
    /// What springs bear over what the quadrature gives.
    share: f64,
}

impl Model {
    /// Whether an edge of stick stays under both forces, with `q_c` a function of the compressions.
    pub fn bears_both_forces(&self) -> bool {
        self.force_on_resting_edge().is_some()
    }

    /// The normal force, N, that is held together with the tangential one under Coulomb's friction that does not change; none elsewhere.
    fn force_on_resting_edge(&self) -> Option<f64> {
        match self.moving()?.cause {
            Cause::BothForces(force) if !self.schedule.conditions().friction.remembers_slip() => Some(force),
            _ => None,
        }
    }

    /// How the compression at the edge of stick follows from the springs' ahead of a state; none where both forces do not hold it at rest.
    pub fn bearing_ahead(&self, state: &State) -> Option<Bearing> {
        let (force, stick) = (self.force_on_resting_edge()?, state.stick.as_ref()?);
        let exponent = 1.0 + self.contact.half_space().grading();
        let per_compression = stick.area.powf(0.5 * exponent) / exponent;
        let compression = self.contact.slip_compression();
        let unworn = unworn_load(self.contact.equivalent_profile(), stick.area.sqrt(), compression);
        let within = unworn - per_compression * compression;
        let load = 0.5 * force / self.contact.half_space().normal_stiffness();
        let slipping = self.slipping_load(stick.area, state.slip_area, &state.compression);
        let missed = stick.load - per_compression * stick.depth - within;
        let share = if slipping > NO_LOAD * load { 1.0 + missed / slipping } else { 1.0 };
        Some(Bearing { stick_area: stick.area, load, within, per_compression, share })
    }

    /// The stick zone whose compression lets the contact bear the normal force.
    ///
    /// # Arguments
    /// * `slip_area` -- `Z = a² - c²`, m²
    /// * `compression` -- of the inner springs, m, shape `(springs - 1,)`
    pub fn bearing_zone(&self, bearing: &Bearing, slip_area: f64, compression: &[f64]) -> StickZone {
        let Bearing { stick_area, load, within, per_compression, share } = *bearing;
        let slipping = self.slipping_load(stick_area, slip_area, compression);
        let slip_compression = (load - share * slipping - within) / per_compression;
        StickZone { stick_area, slip_compression, stick_load: load - slipping }
    }

    /// The edge of stick with that compression.
    pub fn bearing_edge(
        &self,
        bearing: &Bearing,
        stick: &StickEdge,
        slip_area: f64,
        compression: &[f64],
    ) -> StickEdge {
        let zone = self.bearing_zone(bearing, slip_area, compression);
        StickEdge { load: zone.stick_load, depth: zone.slip_compression, ..stick.clone() }
    }

    /// Scales compressions, m, so that those at the edge of stick by the balance and by a guess, m, are in the same proportion to them.
    pub fn scale_to_bear(&self, bearing: &Bearing, guess: f64, slip_area: f64, compression: &mut [f64]) {
        let of = |compression: &[f64]| self.bearing_zone(bearing, slip_area, compression).slip_compression;
        let unloaded = of(&vec![0.0; compression.len()]);
        let factor = unloaded / (guess + unloaded - of(compression));
        compression.iter_mut().for_each(|q| *q *= factor);
    }

    /// Derivatives of that compression by those of the inner springs and by `Z`, 1/m, shape `(springs,)`.
    pub fn bearing_slopes(&self, bearing: &Bearing, fields: &Fields, compression: &[f64]) -> Vec<f64> {
        let factor = -0.5 * bearing.share / bearing.per_compression;
        let factors = self.weighted_density_factors(bearing.stick_area, fields.slip_area);
        let nodes = &self.annulus().operators.abel.nodes()[1..];
        // Springs move outwards with the contact edge, where fewer of them are as stiff.
        let of_edge = |(i, weight): (usize, &f64)| {
            let grown = fields.slip_area * nodes[i];
            weight * compression[i] * (1.0 - self.mu() * grown / (bearing.stick_area + grown))
        };
        let by_edge: f64 = factors.iter().enumerate().map(of_edge).sum();
        let by_springs = factors.iter().map(|weight| factor * fields.slip_area * weight);
        by_springs.chain([factor * by_edge]).collect()
    }

    /// `∫_c^a x^k q dx` by the quadrature over the springs, m^(2+k).
    fn slipping_load(&self, stick_area: f64, slip_area: f64, compression: &[f64]) -> f64 {
        0.5 * slip_area * dot(&self.weighted_density_factors(stick_area, slip_area), compression)
    }

    /// Weights of the compressions of the inner springs in `2/Z ∫_c^a x^k q dx`.
    fn weighted_density_factors(&self, stick_area: f64, slip_area: f64) -> Vec<f64> {
        let abel = &self.annulus().operators.abel;
        let factor = |x: &f64| (stick_area + slip_area * x).powf(-self.mu());
        let inner = self.springs() - 1;
        abel.nodes()[1..=inner].iter().zip(abel.spring_sum()).map(|(x, weight)| weight * factor(x)).collect()
    }
}
