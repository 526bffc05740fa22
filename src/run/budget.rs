//! How an accuracy is shared out: to springs, to the tolerance of the time stepping, to the substeps of a period.
//!
//! Springs and tolerance follow from the measured errors of random scenes (docs/accuracy.md). Where the estimate of a run's error is larger
//! than was asked for, the run is repeated on more springs.

use std::ops::RangeInclusive;

use crate::contact::InitialContact;
use crate::contact::stick_slip::Regime;
use crate::laws::loading::TangentialControl;
use crate::numerics::grid::Clustering;
use crate::solver::model::{Gross, MOST_IN_GROSS_SLIP, Model, MovingStick, Schedule, straightens};

/// Most springs that the program asks for by itself where a scene needs more than others: a minute of run.
pub(in crate::run) const MOST_RAISED: usize = 600;

/// Error of the profile on 24 springs of a smooth mesh, and the power with which it falls, fitted to 118 random scenes on 16 to 54 springs:
/// `ln e = A + B k + C ln n + D ln(a0/c) + E ln n ln(a0/c)` with `k > 0` or zero. Nine of ten lie within a factor of 2.8, 98 of 100 below 7.7.
const ERROR: [f64; 5] = [-10.0, 2.9, 0.30, 0.36, 0.30];
const ORDER: [f64; 2] = [4.5, 1.3];
const FITTED_SPRINGS: f64 = 24.0;

/// Next to the edge of stick the profile is of third order only, `e = A e^(B k) N⁻³` for gradings from the first number on, below which that
/// is not seen: `A` and `B` through the errors at k = 0.5 and 0.9 on 120 springs, with a little to spare.
const THIRD_ORDER_FROM: f64 = 0.4;
const THIRD_ORDER: [f64; 2] = [0.35, 4.5];

/// Part of the accuracy asked for that the fitted error may take up, so that scenes off the fit keep to it too.
const MARGIN: f64 = 0.35;

/// Part of the accuracy asked for that the error of the time stepping may take up; less where stick is lost in the end, for the nearer that comes the
/// more errors grow.
const OF_TIME: f64 = 0.3;
const OF_TIME_LOSING_STICK: f64 = 0.03;

/// Coarsest accuracy for which steps are chosen where the edge of stick moves: in coarser ones, companions take the same steps as the run, whatever their tolerance, and tell nothing.
const COARSEST_MOVING: f64 = 1e-3;

/// The same where blocks recur: steps end at the ends of blocks, so that a smaller tolerance takes few more, and what they are off by adds up over the passes.
const OF_TIME_IN_PASSES: f64 = 0.03;

/// Springs added, as a part, for every unit of `n ln(a0/c)` beyond the first number, up to the second: with a small stick zone the fit's order sets
/// in late.
const ADDED: f64 = 0.1;
const SMALLNESS: [f64; 2] = [2.0, 5.0];

/// Fewest springs that the fit gives; on fewer than 18 the errors of half of the scenes are off the fit.
const FEWEST: f64 = 14.0;
const FEWEST_BELOW_A_HUNDREDTH: f64 = 18.0;

/// The least and the largest factor by which springs are raised when a run is repeated.
const RAISES: [f64; 2] = [1.15, 2.0];

/// Part of the accuracy that an estimate may take up before the run is repeated: of twenty errors one is 1.7 times its estimate.
pub(in crate::run) const SURE: f64 = 0.6;

/// Most springs of a repeated run: more would take longer than a user may wait without having been asked.
const MOST_REFINED: usize = 400;

/// The same where the normal load changes along the period: with more, profiles at the contact edge were off by five times their estimates.
const MOST_REFINED_LIFTING: usize = 200;

/// Order of the error in the springs with which the factor is found, low, and the part of the accuracy that is aimed at.
pub(super) const CAUTIOUS_ORDER: f64 = 4.0;
const AIM: f64 = 0.5;

/// Order below which none was seen, and that of kinks and edges that is then tried for.
const SEEN: f64 = 1.0;
const FULL_ORDER: f64 = 2.0;

/// Part of an error that is left by so many times the springs, which shows that it is not one of springs; tolerance over that before with which such a run is repeated.
const STANDS_STILL: f64 = 0.8;
pub(in crate::run) const MANY_MORE: f64 = 1.2;
pub(in crate::run) const TIGHTER: f64 = 0.2;

/// Springs over those of a run that ended, where finer steps on as many found no end.
pub(in crate::run) const MORE: f64 = 1.5;

/// Part of the difference of two attempts that the finer one is off by at least, on so many times the springs, with the full order, or in steps of a [fifth](TIGHTER) of the tolerance, whose error falls in
/// proportion.
pub(in crate::run) fn left_of_difference(times: f64) -> f64 {
    let falls = if times > MANY_MORE { times.powf(FULL_ORDER) } else { TIGHTER.recip() };
    (falls - 1.0).recip()
}

/// Power of the error with which the tolerance has to fall where an edge of stick moves, and most times that it becomes so much tighter at once.
const OF_EDGE: f64 = 1.5;
const MOST_TIGHTER: f64 = 3.0;

/// `n ln(a0/c)`: the logarithm of the profile's height at the first contact edge over that at the edge of stick.
pub(in crate::run) fn smallness(contact: &InitialContact) -> f64 {
    exponent(contact) * contact.stick_logarithm().unwrap_or(0.0)
}

/// `n` of a power law; other profiles begin as a paraboloid.
fn exponent(contact: &InitialContact) -> f64 {
    contact.equivalent_profile().exponent().unwrap_or(2.0)
}

/// Springs that keep the error of volume and profile below `accuracy`.
pub(in crate::run) fn springs_for(
    clustering: Clustering,
    contact: &InitialContact,
    schedule: &Schedule,
    accuracy: f64,
) -> usize {
    if Gross::follows(contact, schedule).unwrap_or_default() {
        return springs_in_gross_slip(contact, schedule, accuracy);
    }
    let conditions = schedule.conditions();
    let creeps = conditions.holds_normal_force && contact.regime() == Regime::PartialSlip;
    let moves = creeps || !(schedule.is_steady() || schedule.resolves());
    let straightened = !conditions.holds_normal_force
        && conditions.tangential_control == TangentialControl::Force
        && straightens(&*conditions.friction, contact.half_space().grading());
    let fewest = if straightened {
        FEWEST_STRAIGHTENED
    } else if moves {
        fewest_beside_small_stick(contact)
    } else if schedule.lifts() {
        FEWEST_LIFTING
    } else {
        0
    };
    let by_error = match clustering {
        Clustering::Smooth => springs_on_smooth_mesh(contact, accuracy),
        _ if creeps => {
            let [springs, at] = SPRINGS_UNDER_FORCE;
            (springs * (at / accuracy).sqrt()).clamp(FEWEST_UNDER_FORCE, MOST_REFINED as f64)
        }
        // The worn volume is of third order there (docs/numerics.md).
        _ => 120.0 * (1e-4 / accuracy).cbrt(),
    };
    fewest.max(by_error.ceil() as usize)
}

/// The same where neither wear has a kink nor the mesh a concentration of springs.
fn springs_on_smooth_mesh(contact: &InitialContact, accuracy: f64) -> f64 {
    let [wide, next_to_stick] = Falling::of(contact);
    let fewest = if accuracy < 1e-2 { FEWEST_BELOW_A_HUNDREDTH } else { FEWEST };
    let added = 1.0 + ADDED * (smallness(contact).clamp(SMALLNESS[0], SMALLNESS[1]) - SMALLNESS[0]);
    let wanted = MARGIN * accuracy;
    let springs = (added * wide.springs(wanted)).max(next_to_stick.springs(wanted));
    springs.clamp(fewest, MOST_RAISED as f64)
}

/// The same over the whole contact in gross slip.
pub(in crate::run) fn springs_in_gross_slip(
    contact: &InitialContact,
    schedule: &Schedule,
    accuracy: f64,
) -> usize {
    let sliding = springs_that_slide(contact, schedule, accuracy);
    if !Gross::would_stick(contact, schedule) {
        return sliding;
    }
    let [springs, at] = SPRINGS_THAT_STICK;
    let sticking = (springs * (at / accuracy).sqrt()).ceil() as usize;
    sliding.max(sticking).min(most_that_stick(contact))
}

/// The most that are asked for over the whole contact where springs stick in some cycles.
pub(in crate::run) fn most_that_stick(contact: &InitialContact) -> usize {
    match contact.half_space().grading() {
        grading if grading < SOFT => MOST_THAT_STICK_AT_SOFT_TOP,
        grading if grading > STEEP => MOST_ASKED_IN_GROSS_SLIP as usize,
        _ => MOST_IN_GROSS_SLIP,
    }
}

/// The same where springs slip in every cycle.
fn springs_that_slide(contact: &InitialContact, schedule: &Schedule, accuracy: f64) -> usize {
    if !Gross::is_smooth(contact, schedule) {
        let [at, power] = CUBICS_IN_GROSS_SLIP;
        let least = if lifts_at_rim(contact, schedule) { FEWEST_WITH_A_RIM } else { FEWEST_CUBICS } as f64;
        // Debris leaves a layer at the contact edge as wide as it spreads.
        let layer =
            schedule.conditions().wear.spreading().map_or(0.0, |it| contact.contact_radius() / it.length);
        let wanted = (least * (at / accuracy).powf(power)).max(OF_LAYER * layer);
        return wanted.clamp(least, MOST_CUBICS_IN_GROSS_SLIP).ceil() as usize;
    }
    let [springs, at, power] = SPRINGS_IN_GROSS_SLIP;
    let most =
        if contact.half_space().grading() < SOFT { MOST_AT_SOFT_TOP } else { MOST_ASKED_IN_GROSS_SLIP };
    (springs * (at / accuracy).powf(power)).max(FEWEST).min(most).ceil() as usize
}

/// An error that falls with a power of the springs.
pub(super) struct Falling {
    /// On [`FITTED_SPRINGS`].
    error: f64,
    order: f64,
}

impl Falling {
    /// Errors of the profile on smooth meshes: over the annulus, and next to the edge of stick.
    pub(super) fn of(contact: &InitialContact) -> [Self; 2] {
        let grading = contact.half_space().grading().max(0.0);
        let (exponent, stick) = (exponent(contact).ln(), contact.stick_logarithm().unwrap_or(0.0));
        let [a, b, c, d, e] = ERROR;
        let wide = (a + b * grading + c * exponent + d * stick + e * exponent * stick).exp();
        let [scale, growth] = THIRD_ORDER;
        let seen = if grading >= THIRD_ORDER_FROM { scale * (growth * grading).exp() } else { 0.0 };
        [
            Self { error: wide, order: ORDER[0] + ORDER[1] * grading },
            Self { error: seen / FITTED_SPRINGS.powi(3), order: 3.0 },
        ]
    }

    pub(super) fn at(&self, springs: f64) -> f64 {
        self.error * (FITTED_SPRINGS / springs).powf(self.order)
    }

    fn springs(&self, error: f64) -> f64 {
        FITTED_SPRINGS * (self.error / error).powf(self.order.recip())
    }
}

/// Tolerance of the time stepping, whose error is about as large, that leaves most of `accuracy` to the springs.
///
/// In gross slip the errors of all steps add up in the worn volume and in the energy, whose balance is kept to a hundredth of the accuracy; that takes half
/// as many steps again.
pub(in crate::run) fn tolerance_for(accuracy: f64, model: &Model) -> f64 {
    let loses_stick = model.slides() && model.moving().is_some_and(MovingStick::recedes);
    let accuracy = if follows_edge(model) { accuracy.min(COARSEST_MOVING) } else { accuracy };
    accuracy
        * match model.gross() {
            Some(_) => OF_STEPS * OF_TIME,
            None if loses_stick => OF_TIME_LOSING_STICK,
            None if nearly_slides(model) => NEAR_GROSS_SLIP * OF_TIME,
            None if model.schedule().steps_through_passes() => OF_TIME_IN_PASSES,
            None => OF_TIME,
        }
}

/// Accuracy than which nothing is made more coarsely where a run takes too long.
pub(in crate::run) const CHEAPEST: f64 = 1e-2;

/// Tolerance of a run on so many times the springs, fewer, whose error grows as fast as theirs.
pub(in crate::run) fn coarser_tolerance(now: f64, springs: f64, model: &Model) -> f64 {
    (now * springs.powf(-FULL_ORDER)).min(tolerance_for(CHEAPEST, model)).max(now)
}

/// The same of the substeps of a period, of which there are no fewer than `least`, a multiple of four.
pub(in crate::run) fn fewer_substeps(now: usize, springs: f64, least: usize) -> usize {
    (4 * (0.25 * springs * now as f64).ceil() as usize).max(least).min(now)
}

/// Whether the edge of stick moves and wear is not smooth, so that its error is one of steps before it is one of springs.
pub(in crate::run) fn follows_edge(model: &Model) -> bool {
    model.moving().is_some() && !model.wears_smoothly()
}

/// Part of that where a held normal force lets a small stick zone grow: volumes at τ = 30 change by eight times as much as the amplitude, and so they do by errors of
/// early steps.
pub(in crate::run) const NEAR_GROSS_SLIP: f64 = 0.1;

/// Stick radius over that of the contact below which it is small.
const SMALL_STICK: f64 = 0.3;

/// Whether a held normal force lets a small stick zone grow.
fn nearly_slides(model: &Model) -> bool {
    let contact = model.contact();
    let small = contact.stick_radius().is_some_and(|radius| radius < SMALL_STICK * contact.contact_radius());
    small && model.moving().is_some_and(MovingStick::creeps_under_force)
}

/// Springs with which a held normal force is followed to an accuracy: the edge of stick creeps over worn ground, to second order
/// (docs/accuracy.md).
const SPRINGS_UNDER_FORCE: [f64; 2] = [200.0, 1e-4];

/// Fewest springs with which a held tangential force is followed where friction is a straight line next to the edge: on fewer than 44 no step leads on at k = -0.5, and the second of two
/// companions has 0.36 as many.
const FEWEST_STRAIGHTENED: usize = 124;

/// Fewest springs where the contact lifts within each period: on 16 the steps got stuck, and companions on 23 were off by fifty times as much as runs on 30.
const FEWEST_LIFTING: usize = 48;

/// Fewest springs under a held normal force: on 20 the second companion had 10 for 0.36 of 20, and no order was seen.
const FEWEST_UNDER_FORCE: f64 = 28.0;

/// Springs for a ratio of stick radius to contact radius, that ratio, and the power with which they grow for smaller ones; the grading they are for, and by how much their logarithm grows with each unit below it.
/// On fewer no step leads on, with companions on 0.6 of them: 60 serve for 0.12 at k = -0.595, 120 for 0.085, 240 for 0.057, and for 0.03 at -0.4.
const BESIDE_SMALL_STICK: [f64; 5] = [100.0, 0.12, 1.85, -0.595, 7.1];

/// Grading from which on as many are not needed, and number beyond which [`MOST_REFINED`] do not help.
const STIFF_ENOUGH: f64 = -0.3;
const OUT_OF_REACH: f64 = 1000.0;

/// Fewest springs with which the moving edge of a stick zone that may be small is followed; 0 where no such number is known.
fn fewest_beside_small_stick(contact: &InitialContact) -> usize {
    let [springs, part, power, reference, growth] = BESIDE_SMALL_STICK;
    let grading = contact.half_space().grading();
    let logarithm = contact.stick_logarithm().unwrap_or(0.0) + part.ln();
    let fewest = springs * (power * logarithm + growth * (reference - grading)).exp();
    let is_known = grading < STIFF_ENOUGH && fewest <= OUT_OF_REACH;
    if is_known { MOST_REFINED.min(fewest.ceil() as usize) } else { 0 }
}

/// Springs with which gross slip is followed to an accuracy, and the power with which they grow: polynomials over the whole contact
/// (docs/numerics.md).
const SPRINGS_IN_GROSS_SLIP: [f64; 3] = [17.0, 1e-4, 0.12];

/// Springs with which springs that stick in some cycles are followed there to an accuracy, to second order: polynomials as well as cubics make of the kink where slip begins what they
/// can.
const SPRINGS_THAT_STICK: [f64; 2] = [40.0, 1e-3];
const MOST_THAT_STICK_AT_SOFT_TOP: usize = 40;

/// Grading above which more than [`MOST_ASKED_IN_GROSS_SLIP`] make the pressure at the edge grow: at 0.92 runs on 90 springs end early.
const STEEP: f64 = 0.8;

/// Most springs that are asked for there.
const MOST_ASKED_IN_GROSS_SLIP: f64 = 60.0;

/// The same of cubics over the whole contact: the fewest, the accuracy up to which they serve, and the power with which they grow from there on; for each layer of debris in the contact radius,
/// which grows to a few times its first length; and the most.
pub(in crate::run) const FEWEST_CUBICS: usize = 24;
const CUBICS_IN_GROSS_SLIP: [f64; 2] = [1e-3, 1.0 / 3.0];
const OF_LAYER: f64 = 3.0;
const MOST_CUBICS_IN_GROSS_SLIP: f64 = 120.0;

/// The same below a grading at which more make the pressure at the edge grow.
const SOFT: f64 = -0.6;
const MOST_AT_SOFT_TOP: f64 = 13.0;

/// Springs over the slip annulus, for every one in gross slip beyond the second number, once springs stick again: as many as [`SPRINGS_UNDER_FORCE`] at the
/// default accuracy.
const TO_STICK_AGAIN: [usize; 2] = [20, 7];

/// Springs over the slip annulus where those of gross slip stick again.
pub(in crate::run) fn springs_to_stick_again(in_gross_slip: usize) -> usize {
    let [each, beyond] = TO_STICK_AGAIN;
    each * (in_gross_slip - beyond)
}

/// Springs over the slip annulus for every one of gross slip beyond the second number, once a rig has broken stick: next to the axis, where stick was lost last, the
/// profile is steep.
const TO_SLIDE_ON: [usize; 2] = [4, 16];

/// Part of the tolerance of partial slip that is then that of gross slip.
pub(in crate::run) const OF_SLIDING_ON: f64 = OF_STEPS * OF_TIME / OF_TIME_LOSING_STICK;

/// Springs on the mesh that takes the run of a model up. What a mesh has carried on which springs stuck before is no finer than its own.
pub(in crate::run) fn springs_taken_up(model: &Model) -> usize {
    let springs = model.springs();
    if let Some(gross) = model.gross() {
        return if gross.sticks() { springs } else { springs_to_stick_again(springs) };
    }
    if model.comes_to_gross_slip() {
        return springs;
    }
    let [each, beyond] = TO_SLIDE_ON;
    (beyond + springs.div_ceil(each)).min(MOST_IN_GROSS_SLIP)
}

/// Springs of gross slip that lead to so many over the slip annulus, or to more.
pub(in crate::run) fn springs_before(sticking_again: usize) -> usize {
    let [each, beyond] = TO_STICK_AGAIN;
    beyond + sticking_again.div_ceil(each)
}

/// Springs over the slip annulus that lead to so many of gross slip.
pub(in crate::run) fn springs_before_sliding(taken_up: usize) -> RangeInclusive<usize> {
    let [each, beyond] = TO_SLIDE_ON;
    let most = each * taken_up.saturating_sub(beyond);
    let last = if taken_up < MOST_IN_GROSS_SLIP { most } else { MOST_RAISED };
    most.saturating_sub(each - 1)..=last
}

/// Part of the tolerance elsewhere that is that of gross slip.
pub(in crate::run) const OF_STEPS: f64 = 5e-3;

/// Substeps of a period that is sampled: the fewest and the most, the accuracy up to which the fewest serve, and the power with which they
/// grow beyond: four times as many for a tenth of the error.
const SUBSTEPS: [f64; 2] = [192.0, 768.0];
const SAMPLED_AT: f64 = 3.2e-4;
const ORDER_OF_SUBSTEPS: f64 = 0.602;
/// The same where the normal load changes along the path, which substeps take as linear between its points: 192 leave up to 8e-4.
const LIFTING_SAMPLED_AT: f64 = 2.5e-3;

/// Substeps of a period that is sampled, a multiple of four.
///
/// # Arguments
/// * `lifts` -- whether the indenter moves up and down along the period
pub(in crate::run) fn substeps_for(accuracy: f64, lifts: bool) -> usize {
    let [fewest, most] = SUBSTEPS;
    let at = if lifts { LIFTING_SAMPLED_AT } else { SAMPLED_AT };
    let wanted = fewest * (at / accuracy).powf(ORDER_OF_SUBSTEPS);
    4 * (0.25 * wanted.clamp(fewest, most)).round() as usize
}

/// Substeps for every peak of the indentation where slip is taken by steps, the accuracy that they serve, and the power with which they grow:
/// twice as many for a tenth of the error. The most in a period.
const SUBSTEPS_OF_STEPS: [f64; 3] = [64.0, 1e-2, 0.3011];
const MOST_SUBSTEPS: f64 = 1024.0;

/// Substeps of a period whose slip is taken by [`Steps`](crate::contact::spring::Steps).
///
/// # Arguments
/// * `peaks` -- of the indentation, or turns of the tangential oscillation, in the period
pub(in crate::run) fn substeps_of_steps(accuracy: f64, peaks: u32) -> usize {
    let [substeps, at, power] = SUBSTEPS_OF_STEPS;
    let wanted = f64::from(peaks) * substeps * (at / accuracy).powf(power).max(1.0);
    wanted.min(MOST_SUBSTEPS).ceil() as usize
}

/// Substeps, so many times as many as now.
pub(in crate::run) fn more_substeps(now: usize, times: f64) -> usize {
    ((now as f64 * times).ceil() as usize).min(MOST_SUBSTEPS as usize).max(now)
}

/// Parts of the accuracy that substeps may leave out in a run that is repeated anyway, and to which they are then brought, to second order.
const OF_SUBSTEPS: [f64; 2] = [0.3, 0.25];

/// Factor on the substeps of a period with which to repeat a run.
///
/// # Arguments
/// * `now` -- substeps of the run
pub(in crate::run) fn times_substeps(shares: Shares, accuracy: f64, now: usize) -> f64 {
    let [most, aim] = OF_SUBSTEPS;
    if shares.substeps <= most * accuracy {
        return 1.0;
    }
    (shares.substeps / (aim * accuracy)).sqrt().min(MOST_SUBSTEPS / now as f64).max(1.0)
}

/// The estimate where nothing is known: as much as all that wears.
pub(in crate::run) const UNKNOWN: f64 = 1.0;

/// What an error comes from.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::run) struct Shares {
    /// Springs and steps.
    pub springs: f64,
    /// Order with which it falls with the springs.
    pub order: f64,
    /// Substeps of a period.
    pub substeps: f64,
    /// What neither cures.
    pub left_out: f64,
}

impl Shares {
    /// The whole of it.
    pub fn error(&self) -> f64 {
        self.springs + self.substeps + self.left_out
    }

    /// Whether it is so far within the accuracy that no run is repeated.
    pub fn is_surely_within(&self, accuracy: f64) -> bool {
        self.error() <= SURE * accuracy
    }

    /// The same with so many times the substeps, to second order.
    pub fn with_substeps(self, times: f64) -> Self {
        Self { substeps: self.substeps / times.powi(2), ..self }
    }

    /// What that of springs and steps is to come to in a repeat; none if it is surely within the accuracy, or the rest leaves nothing to it.
    fn aim(&self, accuracy: f64) -> Option<f64> {
        let aim = AIM * accuracy - (self.substeps + self.left_out);
        (!self.is_surely_within(accuracy) && aim > 0.0).then_some(aim)
    }

    /// Factor on the tolerance that would cure it if all of it were of the steps, next to an edge of stick that moves.
    pub fn by_steps(&self, accuracy: f64) -> Option<f64> {
        let aim = self.aim(accuracy).filter(|_| self.springs < UNKNOWN)?;
        let times = OF_EDGE * (aim / self.springs).ln() / TIGHTER.ln();
        Some(TIGHTER.powf(times.ceil().clamp(1.0, MOST_TIGHTER)))
    }

    /// Whether more springs have not helped, so that it is the steps that companions differ by.
    ///
    /// # Arguments
    /// * `springs` -- of the run
    /// * `before` -- springs and error of a run before
    pub fn stand_still(&self, springs: usize, before: (usize, f64), accuracy: f64) -> bool {
        let (fewer, error) = before;
        let helped = self.error() <= STANDS_STILL * error;
        let beyond = self.springs < UNKNOWN && !self.is_surely_within(accuracy);
        beyond && springs as f64 > MANY_MORE * fewer as f64 && !helped
    }
}

/// Springs with which to repeat a run that is off by `error`, or by nobody knows how much; none if it is accurate enough, or springs are as many
/// as a run may take.
pub(in crate::run) fn refined(springs: usize, error: Option<f64>, accuracy: f64) -> Option<usize> {
    if error.is_some_and(|error| error <= SURE * accuracy) {
        return None;
    }
    let factor =
        error.map_or(RAISES[1].sqrt(), |error| (error / (AIM * accuracy)).powf(CAUTIOUS_ORDER.recip()));
    let refined = (springs as f64 * factor.clamp(RAISES[0], RAISES[1])).ceil() as usize;
    (refined <= MOST_REFINED).then_some(refined)
}

/// Springs on which gross slip comes to its end where the contact lifts within each period, and fewer may find none: pressed hardest as slip turns, a contact hardly wears at its rim, which comes to
/// bear ever more, and cubics swing there. And the gradings at which that is so: above, 24 do, and below as many are too few.
const ENOUGH_FOR_A_RIM: usize = 80;
const GRADINGS_WITH_A_RIM: [f64; 2] = [-0.5, 0.25];

/// Fewest springs there: of companions on 15 some got stuck, of those on 24 fewer.
const FEWEST_WITH_A_RIM: usize = 40;

/// Whether the contact may come to bear at a rim that hardly wears, where it is in gross slip.
fn lifts_at_rim(contact: &InitialContact, schedule: &Schedule) -> bool {
    let (grading, [least, most]) = (contact.half_space().grading(), GRADINGS_WITH_A_RIM);
    schedule.lifts() && grading > least && grading < most
}

/// Whether the contact may come to bear at a rim that hardly wears.
pub(in crate::run) fn may_bear_at_rim(model: &Model) -> bool {
    model.gross().is_some() && lifts_at_rim(model.contact(), model.schedule())
}

/// More springs for a run that found no end on these, or whose companion did not, where the contact may bear at its rim.
pub(in crate::run) fn enough_for_a_rim(model: &Model) -> Option<usize> {
    (may_bear_at_rim(model) && model.springs() < ENOUGH_FOR_A_RIM).then_some(ENOUGH_FOR_A_RIM)
}

/// Most springs of a repeat over those before: an estimate on few springs tells little of how many it takes, and on many of them runs take long or find no end.
const AT_ONCE: f64 = 2.5;

/// Most springs of a repeat: in gross slip more are of no use, and where the normal load changes along the period they take long.
pub(in crate::run) fn most_springs(model: &Model) -> usize {
    match model.gross() {
        Some(_) => MOST_IN_GROSS_SLIP,
        None if model.comes_to_gross_slip() => most_that_stick(model.contact()),
        None if model.schedule().lifts() => MOST_REFINED_LIFTING,
        None => MOST_RAISED,
    }
}

/// As [`refined`] where the order of convergence was observed: the springs that this order asks for, those that the full one does, at most [so many times as many](AT_ONCE), twice as many, and as many as a run may take at all: the first of them serve that it may take.
///
/// # Arguments
/// * `model` -- of the run
pub(in crate::run) fn refined_by_order(
    springs: usize,
    shares: Shares,
    accuracy: f64,
    model: &Model,
) -> Vec<usize> {
    let most = most_springs(model);
    if shares.springs >= UNKNOWN {
        // Companions of a finer run may tell.
        return refined(springs, None, accuracy).filter(|springs| *springs <= most).into_iter().collect();
    }
    let Some(aim) = shares.aim(accuracy) else { return vec![] };
    let wanted = |order: f64| {
        let factor = (shares.springs / aim).powf(order.recip()).clamp(RAISES[0], AT_ONCE);
        (springs as f64 * factor).ceil()
    };
    let most = most as f64;
    // On few springs the order may not show yet, nor may the estimate be one: more tell.
    let by_order = (shares.order >= SEEN).then(|| wanted(shares.order));
    let as_many = (model.gross().is_none() && most >= MANY_MORE * springs as f64).then_some(most);
    let by_others = [wanted(FULL_ORDER), RAISES[1] * springs as f64].into_iter().chain(as_many);
    by_order.into_iter().chain(by_others).filter(|it| *it <= most).map(|it| it as usize).collect()
}
