//! What moves the edge of stick, and where it is not followed.

use super::breakaway::check_memory;
use super::near_edge::NearEdge;
use super::{Cause, MovingStick, first_to_slide, follows_held_force};
use crate::contact::InitialContact;
use crate::error::{Error, Result};
use crate::laws::conditions::Conditions;
use crate::laws::history::History;
use crate::laws::loading::TangentialControl;
use crate::solver::model::schedule::{CycleLoading, Schedule};

/// Compressions that differ by less than this part are equal but for rounding.
const SAME_COMPRESSION: f64 = 1e-9;

impl MovingStick {
    /// How the edge of stick moves under a schedule; none if it stays, or if the mesh from where it is innermost serves.
    ///
    /// # Errors
    /// As [`check_friction`].
    pub fn new(schedule: &Schedule, contact: &InitialContact) -> Result<Option<Self>> {
        let conditions = schedule.conditions();
        let force = contact.normal_force();
        let follows = follows_held_force(schedule, contact)?;
        check_friction(schedule, contact, follows)?;
        let by_energy = *schedule.friction_along_energy() != History::Constant;
        let in_blocks = schedule.slips_otherwise_between_blocks();
        let [falls, rises] = schedule.friction_change().directions();
        let coulomb = conditions.friction.coefficient().is_some();
        let moving = match (conditions.holds_normal_force, conditions.tangential_control) {
            // Ground next to the edge wears from the first cycle on, for slip sets in with a jump: the edge rests, and springs that are held again stick one by one.
            (true, TangentialControl::Displacement) if schedule.keeps_slipping_from_first() => {
                Self::by(Cause::BothForces(force))
            }
            (true, TangentialControl::Displacement) => Self {
                outwards: rises || !falls,
                turns: falls || in_blocks,
                in_blocks,
                keeps: falls || by_energy || schedule.changes_between_blocks(),
                ..Self::by(Cause::NormalForce(force))
            },
            (true, TangentialControl::Force) if coulomb && !rises && !in_blocks => {
                Self::by(if falls { Cause::ReleasedForces(force) } else { Cause::BothForces(force) })
            }
            (true, _) if conditions.friction.remembers_slip() => Self::by(Cause::BothForces(force)),
            (true, _) => {
                let cause = Cause::TwoBalances(force);
                Self {
                    keeps: true,
                    outwards: rises || !falls,
                    turns: falls || !coulomb || in_blocks,
                    in_blocks,
                    ..Self::by(cause)
                }
            }
            (false, TangentialControl::Displacement) => return Self::by_friction(schedule, contact),
            (false, _) if !follows => return Ok(None),
            (false, _) => {
                let turns = rises || in_blocks && !only_grows(schedule, contact)?;
                Self { outwards: rises, turns, in_blocks, ..Self::by(Cause::Tangential) }
            }
        };
        Ok(Some(moving))
    }

    fn by(cause: Cause) -> Self {
        Self {
            cause,
            outwards: false,
            jumps: false,
            turns: false,
            in_blocks: false,
            keeps: false,
            span: [0.0; 2],
            places: vec![],
            near_edge: NearEdge::default(),
        }
    }

    /// How friction or blocks move it at the indentation that is held.
    fn by_friction(schedule: &Schedule, contact: &InitialContact) -> Result<Option<Self>> {
        let conditions = schedule.conditions();
        let changes = *schedule.friction_change() != History::Constant;
        let [falls, rises] = schedule.friction_change().directions();
        let by = Self::by(Cause::Friction);
        let in_blocks = schedule.slips_otherwise_between_blocks();
        let remembers = conditions.friction.remembers_slip();
        // The mesh from where the edge is innermost serves: slip that sets in with a jump wears a groove next to the edge, beyond which springs stick again one by one.
        if !in_blocks && falls && schedule.lifts() || remembers && rises {
            return Ok(None);
        }
        let level = at_one_indentation(conditions) && !schedule.lifts();
        let turning = Self { outwards: !falls, turns: true, in_blocks, ..by.clone() };
        if *schedule.friction_along_energy() != History::Constant && in_blocks && level {
            return Ok(Some(turning));
        }
        if in_blocks || falls && rises {
            let amplitudes: Vec<f64> = schedule.amplitude_factors().collect();
            let shrink = !amplitudes.is_sorted();
            let rests = rests_on_worn_ground(schedule, contact);
            // Where it comes to rest on worn ground after one that slips farther than the first, an edge that turns takes less work.
            let jumps = match shrink {
                true => {
                    !rests && schedule.follows_jumps()
                        || amplitudes.iter().all(|factor| *factor <= amplitudes[0])
                }
                false => schedule.follows_jumps(),
            };
            // What has slipped may go on to although the amplitude falls.
            let stays = || shrink && remembers && !rests;
            if level && jumps && !changes && !conditions.repeat && !stays() {
                return Ok(Some(Self { outwards: shrink, jumps: true, ..by }));
            }
            // Beside friction that changes an edge that is followed finds no step on from some time on, on many springs, where a block lifts the indenter.
            let follows = level || !changes && !schedule.lifts();
            return Ok((follows && rests).then_some(turning));
        }
        Ok(changes.then_some(Self { outwards: rises, ..by }))
    }
}

/// Whether no block slips less far than one before, up to that in which a rig moves the contact as a whole, if there is one.
fn only_grows(schedule: &Schedule, contact: &InitialContact) -> Result<bool> {
    let first = first_to_slide(schedule, contact)?;
    let until = first.map_or(usize::MAX, |block| block + 1);
    let blocks = schedule.conditions().blocks.iter().take(until).map(|block| block.amplitude_factor);
    let recur = first.is_none() && schedule.conditions().repeat;
    Ok(!recur && blocks.filter(|factor| *factor > 0.0).is_sorted())
}

/// Whether blocks differ by their amplitudes alone.
pub(super) fn at_one_indentation(conditions: &Conditions) -> bool {
    conditions.blocks.iter().all(|block| block.indentation_factor == 1.0)
}

/// Whether springs slip less far in the end of what is asked for than in some block, so that the edge of stick comes to rest on worn ground, or farther out than a mesh for that block begins.
fn rests_on_worn_ground(schedule: &Schedule, contact: &InitialContact) -> bool {
    let ratio = contact.half_space().stiffness_ratio();
    let largest = |loadings: &mut dyn Iterator<Item = CycleLoading>| {
        loadings.map(|loading| loading.slip_compression(ratio)).fold(0.0, f64::max)
    };
    let [last, most] = [largest(&mut schedule.lasting_until_end()), largest(&mut schedule.extremes())];
    last < most * (1.0 - SAME_COMPRESSION)
}

/// Refuses where the law of friction does not let an edge of stick be followed.
///
/// # Arguments
/// * `follows` -- see [`follows_held_force`]
///
/// # Errors
/// [`Error::Inconsistent`] for what goes beside friction along the energy; those of [`check_memory`].
pub(in crate::solver::model) fn check_friction(
    schedule: &Schedule,
    contact: &InitialContact,
    follows: bool,
) -> Result<()> {
    check_along_energy(schedule)?;
    check_memory(schedule, contact, follows)
}

/// Refuses friction that changes with the energy that it dissipates and along the cycles at once.
fn check_along_energy(schedule: &Schedule) -> Result<()> {
    if !schedule.changes_friction_by_both() {
        return Ok(());
    }
    Err(Error::Inconsistent {
        what: "friction",
        why: "changes with the energy that it dissipates, and so does the edge of stick; that is not followed beside friction.history; leave it out"
            .to_owned(),
    })
}
