//! Which contacts are carried by a mesh over the whole of them.

use super::schedule::Schedule;
use crate::contact::InitialContact;
use crate::error::Error;

/// Difference of a slope of friction from that of its strength at all of the indentation, relative, that is round-off.
const EVEN: f64 = 1e-12;

/// Grading below which cubics over the whole contact do not follow an edge of stick.
pub(super) const SOFT: f64 = -0.5;

/// Stick radius, over that of the contact, below which all of it slides, where cycles differ.
pub(super) const LEAST_STICK: f64 = 1e-3;

/// The same where the edge of stick comes in over unworn ground later: at 0.01 meshes that follow it come to no end below k = 0, or to estimates of 3e-2.
pub(super) const LEAST_STICK_LATER: f64 = 0.02;

/// Grading below which no contact is followed whose edge comes in and goes out within each cycle: paraboloids are, down to -0.99, but of eleven random scenes five come to an end, two of them within
/// their accuracy.
const SOFTEST_THAT_LIFTS: f64 = -0.96;

/// Whether the mesh of gross slip carries what happens in a contact, once all of it slides.
pub(super) fn carries(contact: &InitialContact, schedule: &Schedule) -> bool {
    !schedule.changes_friction_by_both()
        && (contact.half_space().grading() >= SOFTEST_THAT_LIFTS || !lifts(schedule))
}

/// Why a contact is refused that [is not carried](carries).
pub(super) fn not_carried(contact: &InitialContact, schedule: &Schedule) -> Error {
    let (amplitude, grading) = (contact.amplitude(), contact.half_space().grading());
    if carries(contact, schedule) {
        return Error::Inconsistent {
            what: "loading.tangential_control",
            why: format!(
                "at an amplitude of {amplitude:e} m the tangential force that is held takes all stick away in the end, which is not followed beside blocks under friction \
                 that falls as steeply with the load; reduce the amplitude, or hold it"
            ),
        };
    }
    Error::Inconsistent {
        what: "loading.amplitude",
        why: format!(
            "at an amplitude of {amplitude:e} m the whole contact slides while its edge comes in and goes out; at grading {grading}, below {SOFTEST_THAT_LIFTS}, \
             pressure at such an edge falls in a layer that most meshes do not resolve; reduce the amplitude, or leave out the motion that lifts the indenter"
        ),
    }
}

/// Whether springs within the mesh lose contact in some cycle, where pressure has kinks.
fn lifts(schedule: &Schedule) -> bool {
    schedule.lifts() || schedule.extremes().any(|loading| loading.lift > 0.0)
}

/// Whether polynomials over the whole contact carry what happens in it; else cubics do.
pub(super) fn is_smooth(contact: &InitialContact, schedule: &Schedule) -> bool {
    let conditions = schedule.conditions();
    // What is finer than debris spreads is not worn off.
    let spreads = conditions.wear.spreading().is_some();
    // Traction that is not in proportion to the pressure does not follow it at the contact edge, where polynomials then swing.
    let uneven = (worn_at_edge(contact, schedule) - 1.0).abs() > EVEN;
    !(lifts(schedule) || spreads || uneven)
}

/// Whether what wears goes to nothing at the contact edge faster than the compression of its springs does, so that cubics would make less than nothing of it: where springs are lifted within a period, and by
/// traction in media below `k = 0`, where no spring sticks in any cycle.
///
/// # Arguments
/// * `sticks` -- whether some do
pub(super) fn spares_edge(contact: &InitialContact, schedule: &Schedule, sticks: bool) -> bool {
    let spreads = schedule.conditions().wear.spreading().is_some();
    let by_traction = contact.half_space().grading() < 0.0 && !sticks;
    !spreads && (schedule.lifts() || by_traction && worn_at_edge(contact, schedule) < 1.0 - EVEN)
}

/// What resists slip for what presses at the contact edge, over the same at all of the indentation, where wear takes the traction; else 1.
fn worn_at_edge(contact: &InitialContact, schedule: &Schedule) -> f64 {
    let conditions = schedule.conditions();
    if !conditions.wear.takes_traction() {
        return 1.0;
    }
    let (friction, depth) = (&conditions.friction, contact.indentation());
    friction.kinetic_strength_slope(0.0) * depth / friction.kinetic_strength(depth)
}

/// Whether a rig goes on to move a contact whose stick it has broken.
pub(super) fn slides_on(contact: &InitialContact, schedule: &Schedule) -> bool {
    let conditions = schedule.conditions();
    let on_rig = conditions.tangential_control.is_rig();
    let fits = contact.half_space().grading() >= SOFT && carries(contact, schedule);
    on_rig && !conditions.holds_normal_force && !schedule.resolves() && fits
}
