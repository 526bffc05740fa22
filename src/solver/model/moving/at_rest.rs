//! An edge of stick that may turn, and the ground that it left at rest.

use super::{Cause, MovingStick, StickEdge};
use crate::numerics::grid::lagrange;
use crate::solver::model::schedule::CycleLoading;
use crate::solver::model::{Model, State};

/// Points of the local polynomial through the ground at rest.
const POINTS: usize = 4;

/// Squared radii that differ by less than this part are the same place.
const SAME_PLACE: f64 = 1e-10;

impl StickEdge {
    /// By how much wear has raised the equivalent profile at rest within the edge of stick, m, and its derivative by the squared radius, 1/m: by
    /// cubics through the nearest places known.
    pub(in crate::solver::model) fn ground_at_rest(&self, squared: f64) -> [f64; 2] {
        let (places, raised) = (&self.places_at_rest, &self.raised_at_rest);
        let (Some(first), Some(last)) = (places.first(), places.last()) else { return [0.0; 2] };
        if squared <= *first {
            return [0.0; 2];
        }
        let after = places.partition_point(|place| *place <= squared);
        let start = after.saturating_sub(POINTS / 2).min(places.len().saturating_sub(POINTS));
        let end = (start + POINTS).min(places.len());
        let (near, heights) = (&places[start..end], &raised[start..end]);
        let sum = |at: f64| -> f64 {
            let mut weights = [0.0; POINTS];
            lagrange(near, at, &mut weights[..near.len()]);
            weights.iter().zip(heights).map(|(weight, height)| weight * height).sum()
        };
        let at = squared.min(*last);
        // Of cubics the difference over twice a step is off by the square of it alone.
        let step = 1e-3 * (near[near.len() - 1] - near[0]);
        let slope = if near.len() < 2 { 0.0 } else { (sum(at + step) - sum(at - step)) / (2.0 * step) };
        [sum(at) + slope * (squared - at), slope]
    }
}

impl Model {
    /// Whether the edge of stick may turn.
    pub fn turns(&self) -> bool {
        self.moving().is_some_and(|moving| moving.turns)
    }

    /// By how much the squared radius of an edge of stick grows on unworn ground for the height that it gains, m.
    pub fn area_per_height(&self, stick: &StickEdge) -> f64 {
        let radius = stick.area.sqrt();
        2.0 * radius / self.contact.equivalent_profile().derivative(radius)
    }

    /// Whether the edge of stick is to be taken as moving outwards: where it may turn, as it did last.
    pub fn goes_outwards(&self, stick: &StickEdge) -> bool {
        let Some(MovingStick { turns, outwards, .. }) = self.moving() else { return false };
        match stick.rates[0] {
            rate if *turns && rate != 0.0 => rate > 0.0,
            _ => *outwards,
        }
    }

    /// What a balance of tangential forces leaves of the normal force to the stick zone, over `2 c_N`, m^(2+k), in a state with the compression at its
    /// edge, m.
    ///
    /// ```text
    /// ∫_0^c x^k (q - q_c) dx = (F_N - F_x/μ_f)/(2 c_N)
    /// ```
    ///
    /// Since the ground within is at rest and the integrand zero at the edge, it changes by `G' c^(1+k)/(1+k)`.
    pub fn bearing(&self, state: &State, slip_compression: f64) -> f64 {
        let loading = self.schedule.loading(state.cycles, state.cycles);
        self.bearing_under(&self.after_energy(loading, state.dissipated_energy), slip_compression)
    }

    /// After a step, with the ground passed outwards among that at rest, or without that passed inwards, where the edge may turn.
    ///
    /// # Arguments
    /// * `before` -- squared radius of the edge before the step, m²
    pub fn with_ground_at_rest(&self, mut stick: StickEdge, before: f64) -> StickEdge {
        if !self.moving().is_some_and(|moving| moving.turns || moving.in_blocks) {
            return stick;
        }
        let (places, raised) = (&mut stick.places_at_rest, &mut stick.raised_at_rest);
        let kept = places.partition_point(|place| *place < stick.area * (1.0 - SAME_PLACE));
        places.truncate(kept);
        raised.truncate(kept);
        if places.is_empty() && stick.area > before {
            places.push(before);
            raised.push(0.0);
        }
        if !places.is_empty() {
            places.push(stick.area);
            raised.push(stick.depth - self.contact.equivalent_profile().value(stick.area.sqrt()));
        }
        stick
    }

    /// See [`Model::bearing`]; zero where nothing asks for it, and under friction that is not Coulomb's.
    pub(super) fn bearing_under(&self, loading: &CycleLoading, slip_compression: f64) -> f64 {
        match self.moving() {
            Some(MovingStick { cause: Cause::TwoBalances(force), .. }) => {
                let Some(coefficient) = loading.friction.coefficient() else { return 0.0 };
                let half_space = self.contact.half_space();
                let amplitude = coefficient * slip_compression / half_space.stiffness_ratio();
                let [by_force, by_displacement] = loading.control.factors();
                let tangential = (loading.asked() - by_displacement * amplitude) / by_force;
                0.5 * (force - tangential / coefficient) / half_space.normal_stiffness()
            }
            _ => 0.0,
        }
    }

    /// Slope of [`Model::bearing`] by the compression, m^(1+k): that of a rig.
    pub(super) fn bearing_slope(&self, loading: &CycleLoading) -> f64 {
        let half_space = self.contact.half_space();
        let [by_force, by_displacement] = loading.control.factors();
        0.5 * by_displacement / by_force / (half_space.stiffness_ratio() * half_space.normal_stiffness())
    }
}
