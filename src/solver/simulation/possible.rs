//! Whether a step ended in a state that wear can lead to.

use super::Simulation;
use crate::numerics::grid::Clustering;
use crate::numerics::linear::largest_magnitude;
use crate::solver::model::{Fields, Gross, State};

/// Largest loss of wear depth in a step, relative to the limit's largest depth, that is taken for an error of interpolation between moving
/// springs: this, or `(3/n)^4` if that is larger, on a smooth mesh. It rejects explicit steps before they are unstable.
const INTERPOLATION: f64 = 1e-6;
const COARSE_INTERPOLATION: f64 = 3.0;

/// The same where wear has kinks.
const KINKED_INTERPOLATION: f64 = 1e-2;

/// How far a compression, over `q_c`, may lie outside the range from 0 to 1. Where the pressure at the edge of stick blows up it is negative for a
/// while, by more than 0.1 as `k → -1`; on unstable meshes it swings by more than one.
const BEYOND_CONTACT: f64 = 0.3;

/// How many times as steeply compressions may fall to the contact edge from the last spring as from the one before, and how many times that ratio may grow in a step.
/// Where steps were right it was 0.6 to 1.6 on 30 to 600 springs, at a corner 3 to 10.
const CORNER: f64 = 2.0;
const SUDDEN: f64 = 1.5;

/// Relative loss of contact area in a step of gross slip, over the tolerance of the compressions relative to the largest of them, that is taken for an error.
const SHRINKS: f64 = 1e-2;

impl Simulation {
    /// Whether a contact in gross slip has not become smaller. The equations on a mesh have another solution, in which the edge recedes and pressure in front of it
    /// grows, and implicit steps that are too long to resolve how it grows may come to it. Below `k = 0`, where the first contact and one that is handed over are none of the polynomials,
    /// the edge settles by 1e-6 to 1e-4, and is not looked at; nor is it on worn ground, which has kinks.
    pub(super) fn has_not_shrunk(&self, gross: &Gross, state: &State) -> bool {
        let now = &self.state;
        let settles = self.model.contact().half_space().grading() < 0.0 || now.ground.is_some();
        // Where little presses any more, errors of the compressions move the edge the farther.
        let error = self.tolerance * self.model.gross_error_scale(gross, &state.compression);
        let most = SHRINKS * error / largest_magnitude(&state.compression);
        let keeps = |area: f64| 1.0 - state.slip_area / area <= most;
        // Where a first contact is none of them either, as at a sharp tip, a first step of any length brings it to where they have its edge.
        settles || keeps(now.slip_area) || self.model.gross_area_in(gross, now).is_ok_and(keeps)
    }

    /// Whether compressions fall to zero at the contact edge. Where the ground wears there as well, the equations have another root: the edge stays or recedes, and
    /// behind it is a corner as that of a punch, which no wear makes.
    fn ends_smoothly(&self, state: &State) -> bool {
        if self.model.schedule().wears_locally() {
            return true;
        }
        let nodes = self.model.operators().nodes();
        let slope = |state: &State, from_edge: usize| {
            let inner = state.compression.len() - from_edge;
            state.compression[inner] / (1.0 - nodes[inner + 1])
        };
        let steepening = |state: &State| slope(state, 1) / slope(state, 2);
        let now = steepening(state);
        !(now > CORNER && now > SUDDEN * steepening(&self.state))
    }

    /// Whether compressions are between zero and that at the edge of stick, with some room. Asked under the plain laws only: under others single
    /// springs next to the edge of stick swing farther and come back.
    fn compressions_are_possible(&self, state: &State) -> bool {
        let most = self.model.contact().slip_compression();
        let within = |q: &f64| (-BEYOND_CONTACT..=1.0 + BEYOND_CONTACT).contains(&(q / most));
        !self.model.schedule().conditions().is_plain() || state.compression.iter().all(within)
    }

    /// Whether a state is one of a contact in which wear became deeper everywhere; notes the radius where it did not.
    pub(super) fn is_possible(&mut self, state: &State, fields: &Fields, depth: &[f64]) -> bool {
        let coarse = COARSE_INTERPOLATION / self.model.springs() as f64;
        let interpolation = match self.model.operators().mesh().clustering() {
            Clustering::Smooth => INTERPOLATION.max(coarse.powi(4)),
            Clustering::Even => KINKED_INTERPOLATION,
            _ if self.model.schedule().is_uniform() => INTERPOLATION,
            _ => KINKED_INTERPOLATION,
        };
        let allowed = (self.tolerance + interpolation) * self.model.depth_scale();
        let healed = depth.iter().zip(&self.depth).position(|(now, before)| *now < before - allowed);
        if healed.is_none()
            && fields.are_physical()
            && self.compressions_are_possible(state)
            && self.ends_smoothly(state)
        {
            return true;
        }
        self.healed_at = healed.map(|at| {
            let stick = self.model.contact().stick_radius().unwrap_or_default();
            let nodes = self.model.operators().nodes();
            let x = nodes[(at + 1).min(nodes.len() - 1)];
            (stick * stick + self.model.unworn().limit_slip_area() * x).sqrt()
        });
        false
    }
}
