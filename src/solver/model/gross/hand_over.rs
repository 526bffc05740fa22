//! From gross slip to partial slip and back.
//!
//! On a rig the last springs that stick may give way, and a block of gross slip may follow others. From there on the contact slides as a whole, and the mesh over all of it takes the compressions, of which it leaves out what is steeper than it
//! carries.
//!
//! Under a held normal force springs next to the axis may stick again, and from there on the edge of stick is followed.
//! Within the new edge `c` the ground is worn already. With `G = d - q_c` the height of the equivalent profile there and `G_0 = g_0(c)` that of the unworn one,
//! what was left behind (see [`moving`](super::super::moving)) follows from `S - S_0 = w + K`:
//!
//! ```text
//! K(r) = G_0 - G + (2/π) cos(kπ/2) ∫_0^c x^k [(q - q_c) - (G_0 - g_0)] (r² - x²)^(-(1+k)/2) dx
//! ```

use std::f64::consts::PI;

use super::Gross;
use crate::contact::InitialContact;
use crate::contact::stick_slip::Regime;
use crate::error::Result;
use crate::solver::model::moving::{MovingStick, StickEdge};
use crate::solver::model::schedule::Schedule;
use crate::solver::model::whole::{SOFT, slides_on};
use crate::solver::model::{Model, Past, State, StickZone};

/// Stick radius, over that of the contact, from which on its edge is followed. Up to there the kink at the edge costs the polynomials over the whole contact
/// 1e-5 of the worn volume.
const FOLLOWED: f64 = 0.1;

/// The same of an unworn contact below which it begins on the mesh of gross slip: an edge that is followed at once would leave no time to settle in.
pub(super) const BEGINS_BELOW: f64 = 0.09;

/// Grading below which polynomials make pressure swing around a kink, so that the edge is followed at once from the second number on, which grows by so much with the grading below.
const FOLLOWED_AT_ONCE: [f64; 3] = [-0.3, 0.02, 0.1];

/// Radius of the core of the mesh that follows it, over that of the first contact.
const CORE: f64 = 0.03;

/// Whether the edge of springs that stick again is followed, once they never slip farther than before.
fn is_followed(schedule: &Schedule) -> bool {
    let conditions = schedule.conditions();
    let local = schedule.wears_locally() && !schedule.resolves();
    schedule.shrinks_at_last() && local && conditions.friction.coefficient().is_some()
}

/// Whether it is followed in blocks that come after others in gross slip.
pub(super) fn is_followed_in_blocks(schedule: &Schedule) -> bool {
    !schedule.is_steady() && is_followed(schedule)
}

impl Gross {
    /// Whether a contact hardly sticks at first, and soon sticks farther out under the normal force that is held.
    pub fn nearly_follows(contact: &InitialContact, schedule: &Schedule) -> bool {
        let [even, least, growth] = FOLLOWED_AT_ONCE;
        let grading = contact.half_space().grading();
        let below = if grading < even { least + growth * (even - grading) } else { BEGINS_BELOW };
        let small = contact.stick_radius().is_some_and(|radius| radius < below * contact.contact_radius());
        let held = schedule.conditions().holds_normal_force && grading >= SOFT;
        let followed = schedule.is_steady() && is_followed(schedule);
        contact.regime() == Regime::PartialSlip && small && held && followed
    }
}

impl Model {
    /// Whether another model takes the run up once springs stick again, or once the last of them slide.
    pub fn is_taken_up(&self) -> bool {
        match self.gross() {
            Some(gross) => {
                let schedule = self.schedule();
                gross.holds_force() && is_followed(schedule) || is_followed_in_blocks(schedule)
            }
            None => {
                let gives_way = self.slides && self.moving().is_some_and(MovingStick::is_balanced);
                gives_way && slides_on(self.contact(), self.schedule()) || self.comes_to_gross_slip()
            }
        }
    }

    /// Whether a block of gross slip follows those in partial slip.
    pub fn comes_to_gross_slip(&self) -> bool {
        self.schedule.ends_with_gross_slip_at().is_some()
    }

    /// Whether the contact is in gross slip, or comes to a block of it.
    pub fn has_gross_slip(&self) -> bool {
        self.gross().is_some() || self.comes_to_gross_slip()
    }

    /// The contact and what acts on it in all blocks, those of gross slip that follow included.
    pub fn under_all_blocks(&self) -> (&InitialContact, &Schedule) {
        self.schedule.with_gross_slip().unwrap_or((self.contact(), self.schedule()))
    }

    /// Whether that block began before some time, cycles.
    pub fn was_left_before(&self, cycles: f64) -> bool {
        self.schedule.ends_with_gross_slip_at().is_some_and(|from| cycles > from)
    }

    /// Whether it is that block's time, which this model does not step through.
    pub fn is_left_at(&self, cycles: f64) -> bool {
        self.schedule.ends_with_gross_slip_at().is_some_and(|from| cycles >= from)
    }

    /// The same contact on the mesh that takes the run up, see [`Model::is_taken_up`]; none where none does.
    ///
    /// # Errors
    /// Those of [`Model::under`].
    pub fn taken_up(&self, springs: usize) -> Result<Option<Self>> {
        if !self.is_taken_up() {
            return Ok(None);
        }
        let schedule = self.schedule();
        if self.gross().is_none() {
            let (contact, schedule) = self.under_all_blocks();
            let model = Self::in_gross_slip(contact, schedule.clone(), springs)?;
            let core = self.stick_zone.stick_area;
            return Ok(Some(model.shown_at(self.offsets().iter().map(|offset| offset + core).collect())));
        }
        let contact = self.contact();
        let innermost = contact.with_core(contact.indentation(), CORE * contact.contact_radius())?;
        let model = Self::in_partial_slip(contact, &innermost, schedule, springs)?;
        let core = model.stick_zone.stick_area;
        Ok(Some(model.shown_at(self.offsets().iter().map(|squared| squared - core).collect())))
    }

    /// Whether springs stick again as far out as their edge is followed, or the last of them give way.
    pub fn changes_over(&self, state: &State) -> bool {
        match self.gross() {
            Some(gross) => {
                // At an indentation that is held the edge of stick is where it is from the first cycle of a block on.
                let may_come = gross.holds_force() || self.schedule.is_at_begin_of_block(state.cycles);
                may_come && self.stick_zone_again(gross, state).is_some()
            }
            None => self.loses_stick(state) || self.is_left_at(state.cycles),
        }
    }

    /// Whether another model takes the run up between blocks, where it may find no step on from what gross slip has worn.
    pub fn takes_up_in_blocks(&self) -> bool {
        self.gross().is_some() && is_followed_in_blocks(&self.schedule)
    }

    /// The stick zone of springs that stick again.
    fn stick_zone_again(&self, gross: &Gross, state: &State) -> Option<StickZone> {
        let (mesh, whole) = (&gross.mesh, self.whole(gross, &self.surroundings(None), &state.compression)?);
        let loading = self.schedule.loading(state.cycles, state.cycles);
        if loading.is_pause() || !self.schedule.only_shrinks_after(state.cycles) {
            return None;
        }
        let slip_compression = loading.slip_compression(self.contact.half_space().stiffness_ratio());
        let end = mesh.last_above(&state.compression, slip_compression)?;
        let fraction = mesh.fraction(end);
        if fraction < FOLLOWED * FOLLOWED {
            return None;
        }
        let within = mesh.up_to(end, &state.compression).ok()?;
        let load = within.iter().map(|[_, weight, q]| weight * q).sum::<f64>();
        Some(StickZone {
            stick_area: fraction * whole.area,
            slip_compression,
            stick_load: 0.5 * whole.area.powf(1.0 - self.mu()) * load,
        })
    }

    /// A state on the mesh of [`Model::taken_up`]; none where nothing changes over, or no contact is found there.
    pub fn hand_over(&self, state: &State, to: &Self) -> Option<State> {
        match to.gross() {
            Some(gross) => self.let_go(state, to, gross),
            None => self.stuck_again(state, to),
        }
    }

    /// A state in which the springs slide that stuck, at an indentation that is held.
    fn let_go(&self, state: &State, to: &Self, gross: &Gross) -> Option<State> {
        let stick_area = state.stick.as_ref().map_or(self.stick_zone.stick_area, |stick| stick.area);
        let raised =
            |squared: f64| state.stick.as_ref().map_or(0.0, |stick| stick.ground_at_rest(squared)[0]);
        let (mesh, profile) = (&gross.mesh, self.contact.equivalent_profile());
        let (area, held) = (stick_area + state.slip_area, self.contact.indentation());
        let mut all = state.compression.clone();
        all.push(0.0);
        // Of an unworn contact with the same edge: by it, what is filtered is no more than what wear has changed.
        let unworn = |fraction: f64| profile.value(area.sqrt()) - profile.value((fraction * area).sqrt());
        let changed = |fraction: f64| {
            let squared = fraction * area;
            let compression = match squared < stick_area {
                true => held - profile.value(squared.sqrt()) - raised(squared),
                false => self.between_springs(&all, (squared - stick_area) / state.slip_area),
            };
            compression - unworn(fraction)
        };
        let mut compression = mesh.filtered(stick_area / area, changed).ok()?;
        compression
            .iter_mut()
            .zip(mesh.fractions())
            .for_each(|(value, fraction)| *value += unworn(*fraction));
        let whole = to.whole(gross, &to.surroundings(None), &compression)?;
        Some(State {
            slip_area: whole.area,
            compression_rate: vec![0.0; compression.len()],
            compression,
            slip_area_rate: 0.0,
            stick: None,
            past: Past::default(),
            ..state.clone()
        })
    }

    /// A state in which springs stick again.
    fn stuck_again(&self, state: &State, to: &Self) -> Option<State> {
        // Polynomials may swing above what slips where nothing sticks in any block.
        let (gross, moving) = (self.gross()?, to.moving().filter(|it| it.leaves_ground())?);
        let zone = self.stick_zone_again(gross, state)?;
        let (mesh, whole) = (&gross.mesh, self.whole(gross, &self.surroundings(None), &state.compression)?);
        let slip_area = whole.area - zone.stick_area;
        let profile = self.contact.equivalent_profile();
        let height = profile.value(zone.stick_area.sqrt());
        let depth = whole.indentation - zone.slip_compression;
        // Of the springs that stick, beyond those of an unworn contact with the same edge.
        let end = mesh.coordinate(zone.stick_area / whole.area);
        let within = mesh.up_to(end, &state.compression).ok()?;
        let more = within.iter().map(|[x, weight, q]| {
            let unworn = height - profile.value((x * whole.area).sqrt());
            [*x, weight * (q - zone.slip_compression - unworn)]
        });
        let more: Vec<[f64; 2]> = more.collect();
        let nu = 1.0 - self.mu();
        let mut left_behind: Vec<f64> = moving
            .stations()
            .map(|squared| {
                let carried = more.iter().map(|[x, value]| value * (squared / whole.area - x).powf(-nu));
                height - depth + (PI * nu).sin() / PI * carried.sum::<f64>()
            })
            .collect();
        let mut all = state.compression.clone();
        all.push(0.0);
        let slipping = |offset: f64| {
            let at = mesh.coordinate((zone.stick_area + offset) / whole.area);
            zone.slip_compression - mesh.value(&all, at)
        };
        let slip_at = |x: &f64| to.unworn().carried(zone.stick_area, slip_area * x, slipping);
        let slip: Vec<f64> = to.operators().nodes()[1..].iter().map(slip_at).collect();
        // By another quadrature than the slip: the contact edge stays where it is.
        let behind = moving.left_behind(&left_behind, whole.area);
        let off = to.mismatch_at(&zone, slip_area, |i, _| slip[i]) - behind;
        left_behind.iter_mut().for_each(|value| *value += off);
        let compression = to.compression_at(&zone, slip_area, |i, _| slip[i]);
        let stick = StickEdge {
            area: zone.stick_area,
            depth,
            load: zone.stick_load,
            left_behind,
            wear_depth: self.gross_radial_fields(gross, state).wear_depth,
            slip_compression: moving.kept(zone.slip_compression),
            ..StickEdge::default()
        };
        let handed = to.close_force(State {
            slip_area,
            compression_rate: vec![0.0; compression.len()],
            compression,
            slip_area_rate: 0.0,
            stick: Some(stick),
            past: Past::default(),
            ..state.clone()
        });
        to.fields(&handed).are_physical().then_some(handed)
    }
}
