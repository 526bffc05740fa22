//! The edge of stick within one block, where the mesh begins farther inside.
//!
//! `g` within a radius does not depend on the profile without, so that wear beyond the springs that stick changes none of their compressions: as long as amplitude,
//! indentation and friction stay, a spring that sticks at the start of a block sticks to its end. The springs of a mesh feel a little of what is worn one or two springs
//! ahead. Where wear goes by a root of slip, that little would grow into a front of slip that creeps inwards, on any number of springs.

use super::schedule::{AmplitudeControl, CycleLoading};
use super::{Fields, Model, State, StickZone};
use crate::laws::loading::TangentialControl;
use crate::numerics::roots::bracketed;

/// Squared radii that differ by less than this part are the same by two ways.
const SAME_PLACE: f64 = 1e-12;

/// Ground that rests in a cycle.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct AtRest {
    /// Squared radius, m², within which no spring slips whatever its compression; zero where compressions alone decide.
    pub area: f64,
    /// Compression below which springs slip, m, where that changes within a block.
    pub limit: Option<f64>,
}

impl Model {
    /// What acts at `cycles` in a step that begins in a state, with friction as it was before any energy was dissipated.
    pub fn loading(&self, state: &State, cycles: f64) -> CycleLoading {
        self.held_at_rest(state, self.schedule.loading(state.cycles, cycles))
    }

    /// A loading, with the ground that rests under it in a state.
    pub(super) fn held_at_rest(&self, state: &State, loading: CycleLoading) -> CycleLoading {
        let follows = self.follows_ground_at_rest();
        loading.each(|loading| {
            let resting_area = match (follows, self.limit_changes_in(&loading)) {
                (false, _) => 0.0,
                (true, false) => state.resting_area,
                (true, true) => state.least_stick_radius.powi(2),
            };
            CycleLoading { resting_area, ..loading }
        })
    }

    /// Whether the mesh begins where springs slip in some cycle, and those that slip in others are found by their compressions at an indentation that is held.
    pub fn follows_ground_at_rest(&self) -> bool {
        let conditions = self.schedule.conditions();
        let changes = self.schedule.changes_between_blocks() || self.limit_changes();
        changes && !conditions.holds_normal_force && self.moving().is_none() && self.gross().is_none()
    }

    /// The same, or in a cycle that stands for a part of a pass: other blocks wear the ground at its edge of stick.
    fn limit_changes_in(&self, loading: &CycleLoading) -> bool {
        loading.part != 1.0 || self.limit_changes()
    }

    /// Whether the compression below which springs slip changes within a block.
    fn limit_changes(&self) -> bool {
        !self.schedule.keeps_friction()
            || self.schedule.conditions().tangential_control != TangentialControl::Displacement
    }

    /// A state with the ground that rests in the block that begins with it.
    pub fn with_resting_area(&self, state: State) -> State {
        let loading = self.schedule.loading(state.cycles, state.cycles);
        if !self.follows_ground_at_rest() || loading.is_pause() {
            return state;
        }
        let limit = self.limit_of(&loading);
        // On ground that is not worn the place is known better than by springs.
        let unworn = self.unworn_area_above(limit);
        let edge = match unworn <= state.least_stick_radius.powi(2) {
            true => unworn,
            false => self.first_below(limit, &self.stick_zone, state.slip_area, &state.compression),
        };
        State { resting_area: self.beyond_mesh(edge), ..state }
    }

    /// The ground that rests in a cycle of an amplitude of the contact, m. Where the limit of slip changes, that is ground that has never slipped, as far as the unworn
    /// profile bears it.
    pub(super) fn at_rest_in(&self, loading: &CycleLoading, amplitude: f64) -> AtRest {
        if !self.follows_ground_at_rest() || !self.limit_changes_in(loading) {
            return AtRest { area: loading.resting_area, limit: None };
        }
        let limit = match loading.control {
            AmplitudeControl::Displacement => self.limit_of(loading),
            _ => self.limit_of(&loading.clone().displaced(amplitude)),
        };
        let edge = loading.resting_area.min(self.unworn_area_above(limit));
        AtRest { area: self.beyond_mesh(edge), limit: Some(limit) }
    }

    /// Zero for what begins with the mesh.
    fn beyond_mesh(&self, edge: f64) -> f64 {
        if edge > (1.0 + SAME_PLACE) * self.stick_zone.stick_area { edge } else { 0.0 }
    }

    /// Compression below which springs slip, m.
    fn limit_of(&self, loading: &CycleLoading) -> f64 {
        loading.slip_compression(self.contact.half_space().stiffness_ratio())
    }

    /// Squared radius, m², within which unworn springs have a compression of a limit at least, m.
    fn unworn_area_above(&self, limit: f64) -> f64 {
        let height = self.contact.indentation() - limit;
        if height <= 0.0 {
            return 0.0;
        }
        self.contact.equivalent_profile().radius_at(height).map_or(f64::INFINITY, |radius| radius * radius)
    }

    /// Squared radius, m², of the innermost place whose compression is below a limit, m.
    fn first_below(&self, limit: f64, zone: &StickZone, slip_area: f64, compression: &[f64]) -> f64 {
        let springs = OnSprings::new(self, zone, compression);
        let at_edge_of_mesh = limit >= zone.slip_compression && springs.compression[0] < limit;
        let place = match springs.compression.iter().position(|q| *q < limit) {
            _ if at_edge_of_mesh => 0.0,
            Some(j) => springs.crossing(j, limit),
            None => 1.0,
        };
        zone.stick_area + slip_area * place
    }

    /// Radii, m, between which springs slip in a cycle, where debris lies: from the edge of stick to that of the contact.
    pub(super) fn slipping_between(
        &self,
        loading: &CycleLoading,
        at_rest: AtRest,
        compression: &[f64],
        fields: &Fields,
    ) -> [f64; 2] {
        let zone = &fields.stick_zone;
        let from = match at_rest.limit {
            Some(limit) => self.first_below(limit, zone, fields.slip_area, compression),
            None => zone.stick_area,
        };
        let to = match loading.least_lift() {
            lift if lift > 0.0 => {
                let springs = OnSprings::new(self, zone, compression);
                let last = springs.compression.iter().rposition(|q| *q >= lift);
                last.map_or(0.0, |last| springs.crossing(last + 1, lift))
            }
            _ => 1.0,
        };
        [from.max(at_rest.area), zone.stick_area + fields.slip_area * to].map(f64::sqrt)
    }
}

/// Compressions along the mesh, the contact edge included.
struct OnSprings<'a> {
    model: &'a Model,
    /// At the edge of the mesh, m.
    before: f64,
    compression: Vec<f64>,
}

impl<'a> OnSprings<'a> {
    fn new(model: &'a Model, zone: &StickZone, compression: &[f64]) -> Self {
        Self { model, before: zone.slip_compression, compression: [compression, &[0.0]].concat() }
    }

    /// Place between a spring and the one before at which the compression passes a value, m.
    fn crossing(&self, spring: usize, value: f64) -> f64 {
        // The nodes begin at the edge of the mesh, with no spring.
        let nodes = self.model.annulus().operators.abel.nodes();
        let at = |x: f64| match x < nodes[1] {
            true => self.before + (self.compression[0] - self.before) * x / nodes[1],
            false => self.model.between_springs(&self.compression, x),
        };
        bracketed(|x| at(x) - value, nodes[spring], nodes[spring + 1], 0.0).unwrap_or(nodes[spring])
    }
}
