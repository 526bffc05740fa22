//! Which step to try, and where it lands; where nothing wears it is a rest.

use super::{End, Simulation};
use crate::error::Result;
use crate::laws::loading::has_come;
use crate::numerics::linear::{largest, largest_magnitude};
use crate::solver::model::{Past, State};

/// Safety factor and bounds of the choice of steps.
const SAFETY: f64 = 0.9;
pub(super) const SMALLEST_FACTOR: f64 = 0.2;
const LARGEST_FACTOR: f64 = 2.5;

/// Smallest useful step, as growth `κ p ΔN` of the slip under the largest pressure; below it round-off rules.
pub(super) const SMALLEST_GROWTH: f64 = 1e-13;

/// Step over the cycles before it that is as short as that.
const SHORT: f64 = 1e-6;

/// Growth of slip up to the next break, over the tolerance, below which nothing wears.
const SPENT: f64 = 1e-6;

/// Largest compression, over what a step may be off by, of a contact in gross slip that has worn out.
const NOTHING_PRESSES: f64 = 10.0;

/// Steps shorter than this part of the planned one, because they end at an output or a break, do not decide the next.
const CUT_SHORT: f64 = 1e-3;

/// Least rate at the end of the last step, over the one asked for, and most of a step that is gone beyond it on purpose.
const OVERSHOT: f64 = 0.5;
const JUST_BEYOND: f64 = 0.02;

/// Relative difference of errors of steps that are alike, by how much shorter each is than the one before, and after how many of them the next is taken as it is.
const ALIKE: f64 = 0.02;
const SHORTER: f64 = 0.7;
const ENOUGH: usize = 4;

/// Steps of a contact that has worn out, each shorter than the one before, after which none leads on.
const NO_STEP: usize = 3;

/// Largest such error, over the tolerance: with blocks that recur that is the accuracy asked for.
const MOST_OF_JUMP: f64 = 30.0;

/// How far before a moment, relative, another block was under way.
const BEFORE: f64 = 1e-9;

/// Steps from here that were rejected. Their errors may hardly change while they become shorter: by what a jump between two blocks is off, which no step makes less. It
/// decays in one implicit step, and companions tell what comes of it.
#[derive(Default)]
pub(super) struct Rejected {
    /// Error over the tolerance, and length, of the last.
    last: Option<[f64; 2]>,
    count: usize,
    alike: usize,
}

impl Rejected {
    /// Takes one more; whether enough of them were alike.
    pub(super) fn are_alike_with(&mut self, error: f64, step: f64) -> bool {
        let alike = self
            .last
            .is_some_and(|[before, longer]| (error / before - 1.0).abs() < ALIKE && step < SHORTER * longer);
        self.count += 1;
        self.alike = if alike { self.alike + 1 } else { 0 };
        self.last = Some([error, step]);
        self.alike >= ENOUGH && error < MOST_OF_JUMP
    }
}

/// A step to try.
pub(super) struct Landing {
    pub step: f64,
    /// Cycles at which it ends exactly, on an output or where what acts changes.
    pub at: Option<f64>,
    /// Whether that is an output.
    pub output: bool,
    /// Whether nothing wears until then, so that the contact stays as it is.
    pub rests: bool,
}

impl Simulation {
    /// The step to try, and where it lands if it does.
    pub(super) fn choose_step(&self) -> Result<Landing> {
        let now = self.state.cycles;
        let end = match self.plan.end {
            End::Cycles(end) => Some(end),
            End::Rate(_) => None,
        };
        let output = match self.stepper.interpolates() {
            true => end,
            false => self.plan.outputs.get(self.progress.next_output as usize).copied().or(end),
        };
        let target = match (self.model.schedule().next_break(now), output) {
            // Where they differ by rounding, the step lands on the output.
            (Some(kink), Some(output)) => Some(if has_come(output, kink) { output } else { kink }),
            (kink, output) => kink.or(output),
        };
        // Companions are compared there.
        let target = [target, self.shown_until()].into_iter().flatten().reduce(f64::min);
        let landing = |step: f64, at: Option<f64>| {
            let output = at.is_some() && at == output;
            Landing { step, at, output, rests: false }
        };
        if let Some(step) = self.stepper.prescribed_step() {
            return Ok(landing(step, target.filter(|t| now + 1.5 * step > *t)));
        }
        if let Some(target) = target.filter(|target| self.rests_until(*target)) {
            return Ok(Landing { rests: true, ..landing(target - now, Some(target)) });
        }
        let step = self.progress.next_step;
        if self.rounds_off(step) {
            return Err(self.stuck("no step is small enough for wear to go on from there"));
        }
        let Some(target) = target else { return Ok(landing(step, None)) };
        let remaining = target - now;
        Ok(if step >= remaining * (1.0 - 1e-9) {
            landing(remaining, Some(target))
        } else {
            landing(if 2.0 * step > remaining { 0.5 * remaining } else { step }, None)
        })
    }

    /// Whether the contact rests until a break or an output. As long as nothing moves nothing wears, but for the round-off of what presses; and where nothing wears while
    /// friction stays, nothing will. Where a step is found it takes what pulls back to what is only spent.
    fn rests_until(&self, target: f64) -> bool {
        let now = self.state.cycles;
        let is_spent = || largest(&self.cycle.growth) * (target - now) <= SPENT * self.tolerance;
        let stays =
            || self.is_worn_out() || is_spent() && self.model.schedule().keeps_friction_until(now, target);
        self.is_still() || self.rejected.count > 0 && stays()
    }

    /// Whether a step is so short that nothing but round-off would come of it.
    fn rounds_off(&self, step: f64) -> bool {
        let now = self.state.cycles;
        let growth = step * largest(&self.cycle.growth);
        !(growth > SMALLEST_GROWTH || (now > 0.0 && step > SHORT * now))
    }

    /// Whether no step leads on from a contact that has worn out.
    pub(super) fn wears_no_more(&self) -> bool {
        let short = self.progress.next_step <= SHORT * self.state.cycles;
        (self.rejected.count >= NO_STEP || short) && self.is_worn_out()
    }

    /// Whether gross slip at a held indentation has worn off all that presses, to the tolerance. Where wear goes by a power of the pressure below one that is so after a finite
    /// time, when the slope of the rate is infinite.
    fn is_worn_out(&self) -> bool {
        let Some(gross) = self.model.gross().filter(|it| !it.holds_force()) else { return false };
        let compression = &self.state.compression;
        let error = self.tolerance * self.model.gross_error_scale(gross, compression);
        largest_magnitude(compression) <= NOTHING_PRESSES * error
    }

    /// Whether nothing moves from now on to the next break: the block under way asks for no amplitude.
    fn is_still(&self) -> bool {
        let now = self.state.cycles;
        self.model.schedule().loading(now, now).rests()
    }

    /// The state at a later time up to which nothing wears; what slips without wear goes on to dissipate.
    pub(super) fn resting_until(&self, cycles: f64) -> State {
        let passed = if self.is_still() || self.is_worn_out() { 0.0 } else { cycles - self.state.cycles };
        State {
            cycles,
            dissipated_energy: self.state.dissipated_energy + passed * self.cycle.dissipation,
            volume_by_rate: self.state.volume_by_rate + passed * self.cycle.volume,
            // No polynomial leads here.
            past: Past::default(),
            ..self.state.clone()
        }
    }

    /// The step that ends where the rate is what was asked for, or just beyond, if this one leaves it far behind, or so far that the worn volume shows it; the rate is
    /// taken to fall exponentially.
    pub(super) fn overshoot(&self, rate: f64, step: f64) -> Option<f64> {
        let End::Rate(fraction) = self.plan.end else { return None };
        if self.stepper.prescribed_step().is_some() {
            return None;
        }
        let wanted = fraction * self.progress.first_rate;
        let reached = rate.max(f64::MIN_POSITIVE);
        let now = self.wear_rate();
        let part = (now / wanted).ln() / (now / reached).ln();
        let allowed = self.tolerance * (self.state.volume_by_rate + step * reached) / (step * wanted);
        let shorter = step * (part + 0.5 * allowed.min(JUST_BEYOND)).clamp(SMALLEST_FACTOR, 0.99);
        let leads_there = reached < wanted && wanted < now;
        // Where other blocks are to come the run does not end there.
        let schedule = self.model.schedule();
        let may_end = || schedule.has_shown_all(self.progress.busy_until, self.state.cycles + step);
        let is_far_behind = reached < OVERSHOT * wanted || 1.0 - part > allowed && may_end();
        (leads_there && is_far_behind && !self.rounds_off(shorter)).then_some(shorter)
    }

    /// Whether a block of another amplitude or indentation has begun just now.
    pub(super) fn begins_block(&self) -> bool {
        let (schedule, now) = (self.model.schedule(), self.state.cycles);
        now > 0.0 && schedule.begins_block(now * (1.0 - BEFORE), now)
    }

    /// Chooses the next step from the error of this one over the tolerance.
    pub(super) fn adapt(&mut self, step: f64, error: f64, accepted: bool, wanted: Option<f64>) {
        let order = self.stepper.estimate_order();
        let by_error = || step * SAFETY * error.max(1e-12).powf(-1.0 / order);
        let best = if error.is_finite() { wanted.unwrap_or_else(by_error) } else { 0.25 * step };
        let planned = self.progress.next_step;
        self.progress.next_step = if accepted && step < CUT_SHORT * planned {
            planned
        } else if accepted {
            best.clamp(SMALLEST_FACTOR * step, LARGEST_FACTOR * step.max(planned))
        } else {
            best.clamp(SMALLEST_FACTOR * step, 0.5 * step)
        };
    }
}
