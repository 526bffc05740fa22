//! The edge of stick within one block, where the mesh begins farther inside.
//!
//! `g` within a radius does not depend on the profile without, so that wear beyond the springs that stick changes none of their compressions: as long as amplitude,
//! indentation and friction stay, a spring that sticks at the start of a block sticks to its end. The springs of a mesh feel a little of what is worn one or two springs
//! ahead. Where wear goes by a root of slip, that little would grow into a front of slip that creeps inwards, on any number of springs.

use super::motion::{Energies, Motion};
use super::schedule::CycleLoading;
use super::{Fields, Model, State, StickZone};
use crate::laws::history::History;
use crate::laws::loading::TangentialControl;
use crate::numerics::roots::bracketed;

/// Squared radii that differ by less than this part are the same by two ways.
const SAME_PLACE: f64 = 1e-12;

impl Model {
    /// What acts at `cycles` in a step that begins in a state, with friction as it was before any energy was dissipated.
    pub fn loading(&self, state: &State, cycles: f64) -> CycleLoading {
        self.held_at_rest(state, self.schedule.loading(state.cycles, cycles))
    }

    /// A loading, with the ground that rests under it in a state.
    pub(super) fn held_at_rest(&self, state: &State, loading: CycleLoading) -> CycleLoading {
        let resting_area = match (self.follows_ground_at_rest(), self.friction_changes()) {
            (false, _) => 0.0,
            (true, false) => state.resting_area,
            (true, true) => state.least_stick_radius.powi(2),
        };
        CycleLoading { resting_area, ..loading }
    }

    /// Whether the mesh begins where springs slip in some cycle, and those that slip in others are found by their compressions at an indentation that is held.
    pub(super) fn follows_ground_at_rest(&self) -> bool {
        let conditions = self.schedule.conditions();
        let changes = !conditions.blocks.is_empty() || self.friction_changes();
        let held = conditions.tangential_control == TangentialControl::Displacement
            && !conditions.holds_normal_force;
        changes && held && self.moving().is_none() && self.gross().is_none()
    }

    fn friction_changes(&self) -> bool {
        *self.schedule.friction_change() != History::Constant
    }

    /// A state with the ground that rests in the block that begins with it.
    pub(super) fn with_resting_area(&self, state: State) -> State {
        let loading = self.schedule.loading(state.cycles, state.cycles);
        let limit = self.limit_of(&loading);
        // On ground that is not worn the place is known better than by springs.
        let unworn = self.unworn_area_above(limit);
        let edge = match unworn <= state.least_stick_radius.powi(2) {
            true => unworn,
            false => self.first_below(limit, &self.stick_zone, state.slip_area, &state.compression),
        };
        State { resting_area: self.beyond_mesh(edge), ..state }
    }

    /// The ground at rest in the first block.
    pub(super) fn first_resting_area(&self) -> f64 {
        let unworn = || self.unworn_area_above(self.limit_of(&self.schedule.loading(0.0, 0.0)));
        if self.follows_ground_at_rest() { self.beyond_mesh(unworn()) } else { 0.0 }
    }

    /// While friction changes, ground that never slipped rests as far as the unworn profile bears it.
    pub(super) fn where_friction_changes(&self, loading: CycleLoading) -> CycleLoading {
        if loading.resting_area == 0.0 || !self.friction_changes() {
            return loading;
        }
        let edge = loading.resting_area.min(self.unworn_area_above(self.limit_of(&loading)));
        CycleLoading { resting_area: self.beyond_mesh(edge), ..loading }
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
        let nodes = &self.annulus().operators.abel.nodes()[1..];
        let mut on_springs = compression.to_vec();
        on_springs.push(0.0);
        let at = |x: f64| match x < nodes[0] {
            true => zone.slip_compression + (on_springs[0] - zone.slip_compression) * x / nodes[0],
            false => self.between_springs(&on_springs, x),
        };
        let place = match on_springs.iter().position(|q| *q < limit) {
            None => 1.0,
            Some(0) if limit >= zone.slip_compression => 0.0,
            Some(j) => {
                let before = if j == 0 { 0.0 } else { nodes[j - 1] };
                bracketed(|x| at(x) - limit, before, nodes[j], 0.0).unwrap_or(before)
            }
        };
        zone.stick_area + slip_area * place
    }

    /// Radius, m, from which on springs slip, where debris lies.
    pub(super) fn slipping_from(&self, loading: &CycleLoading, compression: &[f64], fields: &Fields) -> f64 {
        let (zone, rests) = (&fields.stick_zone, loading.resting_area);
        let edge = match self.follows_ground_at_rest() && self.friction_changes() {
            true => self.first_below(self.limit_of(loading), zone, fields.slip_area, compression).max(rests),
            false => rests.max(zone.stick_area),
        };
        edge.sqrt()
    }

    /// How many springs, from the edge of the mesh outwards, stick for as long as the block lasts.
    pub(super) fn resting_springs(&self, loading: &CycleLoading, fields: &Fields) -> usize {
        if loading.resting_area == 0.0 {
            return 0;
        }
        let nodes = &self.annulus().operators.abel.nodes()[1..];
        nodes.partition_point(|x| fields.stick_zone.stick_area + fields.slip_area * x <= loading.resting_area)
    }

    /// Takes the slip away that errors of their compressions give to springs that stick for as long as the block lasts.
    pub(super) fn keep_at_rest(&self, loading: &CycleLoading, fields: &Fields, motion: &mut Motion) {
        let resting = self.resting_springs(loading, fields).min(motion.energies.len());
        motion.energies[..resting].fill(Energies::default());
        for part in [&mut motion.slip, &mut motion.slip_slope] {
            let rows = resting.min(part.nrows());
            part.subrows_mut(0, rows).fill(0.0);
        }
    }
}
