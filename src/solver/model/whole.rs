//! Which contacts polynomials over the whole of them carry.

use super::schedule::Schedule;
use crate::contact::InitialContact;
use crate::contact::stick_slip::Regime;
use crate::laws::history::History;
use crate::laws::loading::TangentialControl;

/// Difference of a slope of friction from that of its strength at all of the indentation, relative, that is round-off.
const EVEN: f64 = 1e-12;

/// Grading below which the mesh of gross slip holds the compressions less well than that of an edge of stick.
pub(super) const SOFT: f64 = -0.5;

/// Grading below which a core that is left out costs more than what a few springs that stick do on the mesh of gross slip under other laws than Coulomb's: 1e-4 of the volume.
const CORE_COUNTS: f64 = 0.4;

/// Whether the mesh of gross slip carries what happens in a contact, once all of it slides.
pub(super) fn carries(contact: &InitialContact, schedule: &Schedule) -> bool {
    let along_energy = *schedule.friction_along_energy() != History::Constant;
    let both = along_energy && schedule.conditions().friction_history != History::Constant;
    // Below, pressure at the contact edge takes cubics apart: two of three random scenes came to no end.
    !both && (contact.half_space().grading() >= SOFT || is_smooth(contact, schedule))
}

/// Whether polynomials over the whole contact carry what happens in it; else cubics do.
pub(super) fn is_smooth(contact: &InitialContact, schedule: &Schedule) -> bool {
    let conditions = schedule.conditions();
    // Where springs within the mesh lose contact pressure has kinks.
    let lifted = schedule.lifts() || schedule.extremes().any(|loading| loading.lift > 0.0);
    // What is finer than debris spreads is not worn off.
    let spreads = conditions.wear.spreading().is_some();
    // Traction that is not in proportion to the pressure does not follow it at the contact edge, where polynomials then swing.
    let friction = &conditions.friction;
    let depth = contact.indentation();
    let even = friction.kinetic_strength_slope(0.0) * depth / friction.kinetic_strength(depth);
    let uneven = conditions.wear.takes_traction() && (even - 1.0).abs() > EVEN;
    !(lifted || spreads || uneven)
}

/// Whether a rig goes on to move a contact whose stick it has broken.
pub(super) fn slides_on(contact: &InitialContact, schedule: &Schedule) -> bool {
    let on_rig = matches!(schedule.conditions().tangential_control, TangentialControl::Rig { .. });
    on_rig && !schedule.resolves() && sticks_again(contact, schedule)
}

/// Whether springs that stick again in smaller blocks, at an indentation that is held, may do so on the mesh of gross slip.
pub(super) fn sticks_again(contact: &InitialContact, schedule: &Schedule) -> bool {
    let conditions = schedule.conditions();
    // Springs that remember their slip break away all at once.
    let remembers = conditions.friction.remembers_slip();
    // The edge would creep over worn ground, of which the polynomials do not resolve the kink: 3 % of the volume at k = 0.
    let [_, creeps] = schedule.friction_change().directions();
    let turns = schedule.resolves() && !conditions.mode.is_tangential();
    let fits = contact.half_space().grading() >= SOFT && carries(contact, schedule);
    !conditions.holds_normal_force && !remembers && !creeps && !turns && fits
}

/// Whether a contact whose first cycle slides is on that mesh from then on, whatever sticks later.
pub(super) fn begins(contact: &InitialContact, schedule: &Schedule) -> bool {
    let constant = schedule.conditions().friction.coefficient().is_some();
    let core_counts = contact.half_space().grading() < CORE_COUNTS;
    sticks_again(contact, schedule) && (contact.regime() == Regime::FullSliding || constant || core_counts)
}
