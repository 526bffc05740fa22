//! Springs that are held harder while they stick than while they slip, under a balance of tangential forces.
//!
//! A spring that breaks away at the edge of stick bears less than it did, by the difference of its static and its kinetic limit. As long as the springs
//! that still stick gain more, the force grows with the displacement and holds it; else the contact breaks away as a whole.
//!
//! A spring that slips goes on to until the amplitude is below the mean of both limits. Where wear presses the springs deeper under a held normal force
//! the edge of stick therefore rests, and the balance gives the amplitude,
//!
//! ```text
//! F_x = 2 c_N [M U c^(1+k)/(1+k) + μ_k ∫_c^a x^k q dx],    F_N = 2 c_N ∫_0^a x^k q dx
//! ```

use super::{Cause, first_slip_compression};
use crate::contact::InitialContact;
use crate::error::{Error, Result};
use crate::laws::loading::TangentialControl;
use crate::solver::model::schedule::{CycleLoading, Schedule};
use crate::solver::model::{Model, State, StickZone};

/// Part of the stiffness left at which a contact counts as broken away: the edge of stick then comes to that moment within some 1e-4 of the time.
const BROKEN: f64 = 0.02;

/// Change of the area of stick, relative, by which the rate of that part is found.
const DIFFERENCE: f64 = 1e-4;

/// How much of what the springs that stick gain, as the displacement grows, those that break away at the edge of stick leave: positive where the
/// balance of forces is stable.
///
/// ```text
/// 1 - L/(G + 1/k_r),    G = 2 c_N μ_s c^(1+k)/(1+k),    L = 2 c_N (μ_s - μ_k) q_c c^k/g_0'(c)
/// ```
///
/// per compression at the edge, without `1/k_r` under a held force.
fn firmness(contact: &InitialContact, loading: &CycleLoading, radius: f64, compression: f64) -> f64 {
    let half_space = contact.half_space();
    let grading = half_space.grading();
    let strength = loading.friction.static_strength(compression);
    let jump = strength - loading.friction.kinetic_strength(compression);
    let [by_force, by_displacement] = loading.control.factors();
    let by_force = 2.0 * half_space.normal_stiffness() * by_force;
    let gained = strength / compression
        * (by_force * radius.powf(1.0 + grading) / (1.0 + grading)
            + by_displacement / half_space.stiffness_ratio());
    let lost = by_force * jump * radius.powf(grading) / contact.equivalent_profile().derivative(radius);
    1.0 - lost / gained
}

/// Refuses a balance of tangential forces that springs with a memory of their slip do not hold, or in which it would be their past that decides what
/// sticks.
///
/// # Arguments
/// * `follows` -- whether the edge of stick can be followed under the balance
///
/// # Errors
/// [`Error::Inconsistent`] for blocks, for friction that rises or, under a held normal force, changes; where the contact breaks away in the first cycle.
pub(super) fn check_memory(schedule: &Schedule, contact: &InitialContact, follows: bool) -> Result<()> {
    let conditions = schedule.conditions();
    if !conditions.friction.remembers_slip()
        || conditions.tangential_control == TangentialControl::Displacement
    {
        return Ok(());
    }
    let [falls, rises] = schedule.friction_change().directions();
    let beside = [
        (!conditions.blocks.is_empty(), "loading.blocks"),
        (rises || falls && conditions.holds_normal_force, "friction.history"),
    ];
    if let Some((_, what)) = beside.iter().find(|(is_there, _)| *is_there) {
        return Err(Error::Inconsistent {
            what,
            why: format!(
                "lets springs that have slipped come to rest again under a balance of tangential forces, and friction.{} keeps them slipping down to \
                 the mean of both its limits: which of them stick is then decided by the past of each; leave it out, take friction.coulomb, or hold \
                 the amplitude (leave out loading.tangential_control, loading.rig_stiffness)",
                conditions.friction.entry().name
            ),
        });
    }
    for loading in schedule.first_cycles() {
        if !(follows && holds_at_first(contact, &loading)?) {
            return Err(Error::Inconsistent {
                what: "loading.amplitude",
                why: format!(
                    "at an amplitude of {:e} m the contact breaks away: springs that begin to slip bear less than they did, by more than those that \
                     still stick gain, so that the tangential force falls as the displacement grows and does not hold it; reduce the amplitude, or \
                     hold it (leave out loading.tangential_control, loading.rig_stiffness)",
                    loading.amplitude
                ),
            });
        }
    }
    Ok(())
}

/// Whether springs with a memory of their slip hold a balance of tangential forces in the first cycle: as the displacement grows, they come to it before the contact breaks away.
///
/// # Errors
/// Those of the force of the first cycle.
pub(super) fn holds_at_first(contact: &InitialContact, loading: &CycleLoading) -> Result<bool> {
    let depth = contact.indentation();
    let compression = first_slip_compression(contact, loading, depth)?;
    let radius = contact.equivalent_profile().radius_at(depth - compression)?;
    Ok(radius > 0.0 && firmness(contact, loading, radius, compression) >= BROKEN)
}

impl Model {
    /// See [`firmness`], in a state with some area of stick, m²; none where springs do not remember their slip.
    fn firmness_at(&self, state: &State, area: f64) -> Option<f64> {
        let cause = self.moving().map(|moving| moving.cause);
        let loading = self.schedule.loading(state.cycles, state.cycles);
        if cause != Some(Cause::Tangential) || !loading.friction.remembers_slip() {
            return None;
        }
        let radius = area.sqrt();
        let compression = self.contact.indentation() - self.contact.equivalent_profile().value(radius);
        Some(firmness(&self.contact, &loading, radius, compression))
    }

    /// Whether springs at the edge of stick are about to break away as a whole.
    pub(super) fn breaks_away(&self, state: &State) -> bool {
        let stick = state.stick.as_ref();
        stick.and_then(|stick| self.firmness_at(state, stick.area)).is_some_and(|left| left < BROKEN)
    }

    /// Cycles, about, until an edge of stick that recedes is lost: at the rate of the last step, or where the contact breaks away by the root of the time
    /// left, with which the edge comes there.
    pub fn cycles_to_loss(&self, state: &State) -> f64 {
        let Some(stick) = state.stick.as_ref().filter(|stick| stick.rates[0] < 0.0) else { return 0.0 };
        let broken = self.firmness_at(state, stick.area).and_then(|left| {
            let nearby = self.firmness_at(state, stick.area * (1.0 - DIFFERENCE))?;
            let falls = (left - nearby) / (DIFFERENCE * stick.area) * -stick.rates[0];
            Some(0.5 * left / falls)
        });
        broken.unwrap_or(stick.area / -stick.rates[0])
    }

    /// What acts under both forces, or a rig beside a normal one, where the edge of stick rests: the amplitude at which springs there begin to slip, or
    /// the one of the balance where they go on to at less.
    pub(super) fn deepened(&self, loading: CycleLoading, zone: &StickZone) -> CycleLoading {
        let cause = self.moving().map(|moving| moving.cause);
        let Some(force) = cause.and_then(Cause::normal_force).filter(|_| loading.friction.remembers_slip())
        else {
            return self.displaced(loading, zone.slip_compression);
        };
        let half_space = self.contact.half_space();
        let exponent = 1.0 + half_space.grading();
        let stiffness = 2.0 * half_space.normal_stiffness();
        let slipping = loading.friction.kinetic_strength(1.0) * (force - stiffness * zone.stick_load);
        let per_amplitude =
            half_space.stiffness_ratio() * stiffness * zone.stick_area.powf(0.5 * exponent) / exponent;
        let [by_force, by_displacement] = loading.control.factors();
        let amplitude =
            (loading.asked() - by_force * slipping) / (by_force * per_amplitude + by_displacement);
        // All springs on the mesh slip from the first cycle on.
        CycleLoading { slipped: f64::INFINITY, ..loading.displaced(amplitude) }
    }
}
