//! Static and kinetic friction on a rig: whether the contact goes on to slide as a whole.
//!
//! As the motion reverses, all springs stick at first. One breaks away once it is moved by `(μ_s + μ_k) q/M`, and bears `μ_k q` from there on. Half of that
//! way is the first cycle of springs whose static limit is the mean of both. The rig breaks all of them away each time if no displacement holds it,
//!
//! ```text
//! U + F(U)/k_r < U_r    for all U,    F = 2 c_N ∫ x^k f dx,    f = M U where M U < (μ_s + μ_k) q/2, else μ_k q
//! ```

use std::cmp::Ordering;

use super::Gross;
use crate::solver::model::moving::LAST_STICK;
use crate::solver::model::{Model, State};

/// What the quadrature over the nodes leaves of the displacement of the rig, relative.
const LEFT: f64 = 1e-3;

impl Model {
    /// Whether a rig that moved the whole contact no longer breaks all springs away.
    pub fn is_held_again(&self, state: &State) -> bool {
        let conditions = self.schedule.conditions();
        let may = conditions.tangential_control.is_rig() && conditions.friction.remembers_slip();
        may && self.gross().is_some_and(|gross| self.holds_rig(gross, state))
    }

    fn holds_rig(&self, gross: &Gross, state: &State) -> bool {
        let loading = self.loading_in(state, self.schedule.loading(state.cycles, state.cycles));
        let (friction, mesh) = (&*loading.friction, &gross.mesh);
        let Some(whole) = self.whole(gross, &self.surroundings(None), &state.compression) else {
            return false;
        };
        let [by_force, _] = loading.control.factors();
        let half_space = self.contact.half_space();
        let by_force = by_force * half_space.normal_stiffness() * whole.area.powf(1.0 - self.mu());
        let limits = |q: &f64| {
            [friction.mean_over_static() * friction.static_strength(*q), friction.kinetic_strength(*q)]
        };
        let limits: Vec<[f64; 2]> = state.compression.iter().map(limits).collect();
        // Of the spring that is about to break away, half.
        let asked = |held: f64| {
            let borne = |[mean, dragged]: &[f64; 2]| match mean.total_cmp(&held) {
                Ordering::Greater => held,
                Ordering::Equal => 0.5 * (held + dragged),
                Ordering::Less => *dragged,
            };
            let borne: Vec<f64> = limits.iter().map(borne).collect();
            held / half_space.stiffness_ratio() + by_force * mesh.load(&borne)
        };
        let followed = limits.iter().zip(mesh.fractions()).filter(|(_, fraction)| **fraction > LAST_STICK);
        let most = followed.map(|([mean, _], _)| asked(*mean)).fold(0.0, f64::max);
        most > loading.amplitude * (1.0 + LEFT)
    }
}
