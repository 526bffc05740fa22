//! What acts on the contact in each cycle: laws, amplitude and path, by block and by history.

mod memory;
mod pauses;
mod shrinking;
mod sliding;

use std::sync::{Arc, OnceLock};

use sliding::Then;

use super::first_force::first_force;
use super::worn_ground::WornGround;
use crate::contact::InitialContact;
use crate::contact::spring::{Response, Steps};
use crate::error::Result;
use crate::laws::conditions::Conditions;
use crate::laws::friction::FrictionLaw;
use crate::laws::history::History;
use crate::laws::loading::{Block, TangentialControl, has_come};
use crate::laws::motion::SampledPath;
use crate::laws::path::Path;
use crate::laws::wear::WearLaw;

/// What is asked of the contact tangentially in one cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AmplitudeControl {
    /// The displacement given.
    Displacement,
    /// An amplitude of the force, N.
    Force(f64),
    /// The displacement given is that of the far end of a spring of this stiffness, N/m.
    Rig(f64),
}

impl AmplitudeControl {
    /// Factors of force, N, and displacement, m, in what has to equal what is asked, see [`CycleLoading::excess`].
    pub fn factors(self) -> [f64; 2] {
        match self {
            Self::Displacement => [0.0, 1.0],
            Self::Force(_) => [1.0, 0.0],
            Self::Rig(stiffness) => [stiffness.recip(), 1.0],
        }
    }
}

/// What acts in one cycle, or in the mean cycle of a pass through the blocks.
#[derive(Debug, Clone)]
pub struct CycleLoading {
    /// Law of friction.
    pub friction: Arc<dyn FrictionLaw>,
    /// Law of wear.
    pub wear: Arc<dyn WearLaw>,
    /// Tangential amplitude `U`, m, as given: of the contact in the first cycle, or of the far end of a rig.
    pub amplitude: f64,
    /// What decides the amplitude of the contact.
    pub control: AmplitudeControl,
    /// How far the indenter is lifted from its largest indentation of the run, m, where the cycle is not resolved.
    pub lift: f64,
    /// The path over one period where the cycle is resolved, seen from the largest indentation of the run.
    pub path: Option<Arc<Path>>,
    /// What springs do on that path, where their limit alone decides it.
    pub response: Option<Arc<Response>>,
    /// The steps of that path where the indenter moves up and down along a line and a constant coefficient of friction decides how springs slip.
    pub steps: Option<Arc<Steps>>,
    /// Compression at the largest indentation of the run, m, below which springs have slipped in some cycle, where they remember it; else zero.
    pub slipped: f64,
    /// Cycles in that period.
    pub cycles_per_period: f64,
    /// Settled cycles that this one wears as much as: `FROM_REST` in the first cycle from rest, else one.
    pub share: f64,
    /// Squared radius, m², within which no spring slips whatever its compression, see [`State::resting_area`](super::State).
    pub resting_area: f64,
    /// Part of the pass that such cycles take; one where a cycle is of one block.
    pub part: f64,
    /// The cycles that take the rest of the pass; none where a cycle is of one block.
    pub others: Vec<CycleLoading>,
}

/// Settled cycles that the first one from rest wears as much as. The first loading moves every spring as a quarter of a settled cycle does: it
/// slips `σ` of `4 σ`, under the same load, in a quarter of the time, and is settled from the first reversal on.
const FROM_REST: f64 = 1.25;

/// End of the first cycle.
const FIRST_END: f64 = 1.0;

impl CycleLoading {
    /// The cycles of which this is the mean, each of one block and with its part.
    pub fn parts(&self) -> impl Iterator<Item = &Self> {
        std::iter::once(self).chain(&self.others)
    }

    /// The same change of each of them.
    pub fn each(mut self, change: impl Fn(Self) -> Self) -> Self {
        let others = std::mem::take(&mut self.others);
        let others = others.into_iter().map(&change).collect();
        Self { others, ..change(self) }
    }

    /// Whether nothing moves in any of them.
    pub fn rests(&self) -> bool {
        self.parts().all(Self::is_pause)
    }

    /// What is asked: an amplitude of the displacement, m, or of the force, N.
    pub fn asked(&self) -> f64 {
        if let AmplitudeControl::Force(asked) = self.control { asked } else { self.amplitude }
    }

    /// Whether nothing moves.
    pub fn is_pause(&self) -> bool {
        self.asked() == 0.0
    }

    /// By how much the indenter is lifted from its largest indentation of the run where it is deepest in this cycle, m.
    pub fn least_lift(&self) -> f64 {
        let lifts = self.path.iter().flat_map(|path| path.points.iter().map(|point| point.lift));
        lifts.min_by(f64::total_cmp).unwrap_or(self.lift)
    }

    /// Lifts the indenter by so much more throughout, m.
    pub fn lift_by(&mut self, lift: f64) {
        if lift == 0.0 {
            return;
        }
        self.slipped = if self.slipped > 0.0 { self.slipped + lift } else { 0.0 };
        match self.path.as_mut().map(Arc::make_mut) {
            Some(path) => path.points.iter_mut().for_each(|point| point.lift += lift),
            None => self.lift += lift,
        }
        if let Some(steps) = &mut self.steps {
            Arc::make_mut(steps).lift(lift);
        }
    }

    /// The same, seen from the indentation of the block under way in gross slip.
    pub fn on_ground(self, ground: Option<&WornGround>) -> Self {
        let Some(ground) = ground else { return self };
        self.each(|mut it| {
            it.lift_by(-ground.lift);
            it
        })
    }

    /// The same to and fro by an amplitude of the contact, m, that a balance of forces has decided.
    pub fn displaced(self, amplitude: f64) -> Self {
        let factor = amplitude / self.amplitude;
        let path = self.path.as_ref().map(|path| Arc::new(path.stretched(factor)));
        Self { amplitude, control: AmplitudeControl::Displacement, path, ..self }
    }

    /// By how much the contact, at an amplitude of force, N, and displacement, m, exceeds what is asked.
    pub fn excess(&self, force: f64, displacement: f64) -> f64 {
        let [by_force, by_displacement] = self.control.factors();
        by_force * force + by_displacement * displacement - self.asked()
    }
}

/// How one period is passed through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Resolution {
    /// Whether every period is resolved; else only those without a closed form are.
    pub resolved: bool,
    /// Steps within a resolved period, at least 2; chosen by the mode if not given.
    pub substeps: Option<usize>,
}

/// Substeps of a period by default: enough where only the reversals matter, and for paths that turn or press.
const FEWEST_SUBSTEPS: usize = 2;
const SUBSTEPS: usize = 96;

/// Substeps for which there is one step of the wear where springs are followed within it.
const SUBSTEPS_PER_STEP: usize = 4;

/// Bounds of where springs slip and wear in some cycle of a run.
#[derive(Debug, Clone)]
pub struct Envelope {
    /// The contact at the largest indentation, with the smallest stick radius.
    pub contact: InitialContact,
    /// Whether no stick is left in the end.
    pub slides: bool,
}

/// What acts when.
#[derive(Debug, Clone)]
pub struct Schedule {
    conditions: Conditions,
    /// Units of the clock in one cycle.
    clock_rate: f64,
    /// Ends of the blocks within one pass, cycles, increasing; empty for a single block without end.
    ends: Vec<f64>,
    /// At the start of the histories, one per block, at least one.
    loadings: Vec<CycleLoading>,
    /// Factor on friction along the energy dissipated, J/m².
    friction_along_energy: History,
    largest_indentation: f64,
    /// `M`.
    stiffness_ratio: f64,
    /// `k`.
    grading: f64,
    /// [`CycleLoading::slip_compression`] of each block from rest, under friction as it is at the start.
    slipping: OnceLock<Vec<f64>>,
    /// Whether steps follow an edge of stick that jumps between blocks.
    follows_jumps: bool,
    /// Cycles after which nothing is asked for; infinite where that is not known beforehand.
    asked_until: f64,
    /// Whether springs move with an edge of stick that a balance of tangential forces moves, where they can.
    follows_balance: bool,
    /// Cycles from which on wear goes on as in the mean cycle of a pass, so that no step ends at the end of a block; infinite where each does.
    averages_from: f64,
    /// Gross slip that follows the blocks, if it does.
    then: Option<Arc<Then>>,
    /// What [`Schedule::envelope`] found for a contact of this indentation and amplitude, m; copies of the schedule share it.
    envelope: Arc<OnceLock<([f64; 2], Envelope)>>,
}

impl Schedule {
    /// The same where nothing is asked for after some cycles.
    pub fn asked_until(self, cycles: f64) -> Self {
        Self { asked_until: cycles, ..self }
    }

    /// What acts on a contact under some conditions.
    ///
    /// # Errors
    /// Those of the indentation of a block.
    pub fn new(contact: &InitialContact, conditions: &Conditions, resolution: Resolution) -> Result<Self> {
        let whole = Block { duration: f64::INFINITY, amplitude_factor: 1.0, indentation_factor: 1.0 };
        let blocks = if conditions.blocks.is_empty() { vec![whole] } else { conditions.blocks.clone() };
        let clock_rate = conditions.clock.per_cycle(contact.tau_per_cycle());
        let mut end = 0.0;
        let ends = conditions.blocks.iter().map(|block| {
            end += block.duration / clock_rate;
            end
        });
        let ends: Vec<f64> = ends.collect();
        // One block after the other that are the same are one without end.
        let changes = blocks.iter().any(|block| {
            [block.amplitude_factor, block.indentation_factor]
                != [blocks[0].amplitude_factor, blocks[0].indentation_factor]
        });
        let ends = if changes { ends } else { vec![] };
        let resolved = resolution.resolved || !conditions.mode.is_tangential();
        let friction = conditions.friction.scaled(conditions.friction_history.at(0.0));
        let driven = driven_amplitude(contact, conditions, &*friction)?;
        let mut loadings = Vec::with_capacity(blocks.len());
        let mut depths = Vec::with_capacity(blocks.len());
        for block in &blocks {
            let (amplitude, indentation) =
                (driven * block.amplitude_factor, contact.indentation() * block.indentation_factor);
            let mut loading = CycleLoading {
                friction: Arc::clone(&conditions.friction),
                wear: Arc::clone(&conditions.wear),
                amplitude,
                control: match conditions.tangential_control {
                    TangentialControl::Displacement => AmplitudeControl::Displacement,
                    TangentialControl::Rig { stiffness } => AmplitudeControl::Rig(stiffness),
                    TangentialControl::Force => {
                        AmplitudeControl::Force(first_force(contact, &*friction, amplitude, indentation)?)
                    }
                },
                lift: 0.0,
                path: None,
                response: None,
                steps: None,
                slipped: 0.0,
                cycles_per_period: 1.0,
                share: 1.0,
                resting_area: 0.0,
                part: 1.0,
                others: vec![],
            };
            let mut depth = indentation;
            if resolved {
                let fewest = if conditions.mode.is_tangential() { FEWEST_SUBSTEPS } else { SUBSTEPS };
                let substeps = resolution.substeps.unwrap_or(fewest);
                let scaled = conditions.mode.scaled(block.amplitude_factor);
                let mode = scaled.as_ref().unwrap_or(&conditions.mode);
                let slope =
                    conditions.constant_friction().map(|it| it / contact.half_space().stiffness_ratio());
                let sample = |substeps: usize| match slope {
                    Some(slope) => SampledPath::with_turns(&**mode, amplitude, indentation, substeps, slope),
                    None => SampledPath::new(&**mode, amplitude, indentation, substeps),
                };
                let sampled = sample(if slope.is_some() { substeps.max(SUBSTEPS) } else { substeps });
                depth = sampled.largest_indentation;
                if let Some(slope) = slope.filter(|_| !sampled.path.is_level() && sampled.path.is_straight())
                {
                    let count = substeps.div_ceil(SUBSTEPS_PER_STEP);
                    let path = sample(count * Steps::CORNERS).path;
                    loading.steps = Steps::new(path, count, slope).map(Arc::new);
                }
                loading.cycles_per_period = f64::from(sampled.oscillations);
                loading.response = response(&sampled.path, &*loading.friction, &loadings);
                loading.path = Some(Arc::new(sampled.path));
            }
            loadings.push(loading);
            depths.push(depth);
        }
        let largest_indentation = depths.iter().fold(0.0, |largest: f64, depth| largest.max(*depth));
        for (loading, depth) in loadings.iter_mut().zip(&depths) {
            loading.lift_by(largest_indentation - depth);
        }
        let friction_along_energy = conditions.friction.along_energy();
        let conditions = conditions.clone();
        Ok(Self {
            conditions,
            clock_rate,
            ends,
            loadings,
            friction_along_energy,
            largest_indentation,
            stiffness_ratio: contact.half_space().stiffness_ratio(),
            grading: contact.half_space().grading(),
            slipping: OnceLock::new(),
            follows_jumps: true,
            asked_until: f64::INFINITY,
            follows_balance: true,
            averages_from: f64::INFINITY,
            then: None,
            envelope: Arc::default(),
        })
    }

    /// The same for explicit steps, which do not follow an edge of stick that jumps between blocks: the mesh begins where that is innermost.
    pub(crate) fn for_explicit_steps(self) -> Self {
        Self { follows_jumps: false, ..self }
    }

    /// The same with an edge of stick that moves over springs that stay, whatever moves it: coarser, and wherever a balance of forces leads it.
    pub(crate) fn on_springs_that_stay(self) -> Self {
        Self { follows_balance: false, envelope: Arc::default(), ..self }
    }

    /// Lets wear go on as in the mean cycle of a pass through the blocks, from some cycle on; before, or if that is infinite, a step ends with each block.
    pub fn average_from(&mut self, cycles: f64) {
        self.averages_from = if self.recurs() { cycles } else { f64::INFINITY };
    }

    /// Cycles from which on wear goes on as in the mean cycle of a pass.
    pub fn averages_from(&self) -> f64 {
        self.averages_from
    }

    /// Whether blocks that differ follow one another again and again.
    pub fn recurs(&self) -> bool {
        self.conditions.repeat && self.changes_between_blocks()
    }

    /// Whether blocks recur, and steps end with each.
    pub fn steps_through_passes(&self) -> bool {
        self.conditions.repeat && self.averages_from > 0.0
    }

    /// Cycles of different blocks that a step sees at once.
    pub fn cycles_at_once(&self) -> usize {
        if self.averages_from > 0.0 { 1 } else { self.loadings.len() }
    }

    fn duration(&self, block: usize) -> f64 {
        self.ends[block] - if block == 0 { 0.0 } else { self.ends[block - 1] }
    }

    /// Cycles of each block of a pass.
    pub fn durations(&self) -> impl Iterator<Item = f64> {
        (0..self.ends.len()).map(|block| self.duration(block))
    }

    /// Whether springs move with an edge of stick that a balance of tangential forces moves, where they can.
    pub(super) fn follows_balance(&self) -> bool {
        self.follows_balance
    }

    /// Whether steps follow an edge of stick that jumps between blocks.
    pub(super) fn follows_jumps(&self) -> bool {
        self.follows_jumps
    }

    pub(super) fn known_envelope(&self) -> &OnceLock<([f64; 2], Envelope)> {
        &self.envelope
    }

    /// Largest indentation of the run at which cycles begin, m.
    pub fn largest_indentation(&self) -> f64 {
        self.largest_indentation
    }

    /// The conditions that it follows.
    pub fn conditions(&self) -> &Conditions {
        &self.conditions
    }

    /// What acts at `cycles` in a step that begins at `start`: the block is that of the beginning, or all of a pass.
    pub fn loading(&self, start: f64, cycles: f64) -> CycleLoading {
        if self.averages_at(start) {
            self.mean_loading(start, cycles)
        } else {
            self.loading_in_block(start, cycles)
        }
    }

    /// What acts in a pass.
    pub fn mean_loading(&self, start: f64, cycles: f64) -> CycleLoading {
        let of_block = |block: usize| {
            let part = self.part(block);
            CycleLoading { part, share: self.share(start), ..self.in_block(block, cycles) }
        };
        let mut parts = (0..self.loadings.len()).map(of_block);
        let first = parts.next().expect("a pass has blocks");
        CycleLoading { others: parts.collect(), ..first }
    }

    /// What acts in the block that is under way at `start`, whether steps see it or its pass.
    pub fn loading_in_block(&self, start: f64, cycles: f64) -> CycleLoading {
        let block = self.block(start).1;
        let part = if self.averages_at(start) { self.part(block) } else { 1.0 };
        CycleLoading { part, share: self.share(start), ..self.in_block(block, cycles) }
    }

    /// The part of a pass that a block takes.
    fn part(&self, block: usize) -> f64 {
        self.duration(block) / self.ends[self.ends.len() - 1]
    }

    /// Settled cycles that the one at `start` wears as much as.
    fn share(&self, start: f64) -> f64 {
        if self.is_first(start) { FROM_REST } else { 1.0 }
    }

    /// What acts at `cycles` in a block.
    fn in_block(&self, block: usize, cycles: f64) -> CycleLoading {
        let mut loading = self.loadings[block].clone();
        let factor = |history: &History| history.at(cycles * self.clock_rate);
        if self.conditions.friction_history != History::Constant {
            loading.friction = loading.friction.scaled(factor(&self.conditions.friction_history));
        }
        if self.conditions.wear_history != History::Constant {
            loading.wear = loading.wear.scaled(factor(&self.conditions.wear_history));
        }
        loading.slipped = self.slipped(block, cycles);
        loading
    }

    /// Whether steps from there on see whole passes. A first cycle that wears from rest is one of the first block, if that lasts as long.
    pub fn averages_at(&self, start: f64) -> bool {
        start >= self.averages_from && !(self.is_first(start) && self.ends[0] >= FIRST_END)
    }

    /// Whether what acts changes from one block to another.
    pub fn changes_between_blocks(&self) -> bool {
        !self.ends.is_empty()
    }

    /// Whether steps see what acts change from one block to another.
    pub fn changes_in_time(&self) -> bool {
        self.changes_between_blocks() && self.averages_from > 0.0
    }

    /// Whether steps end where one block, or one pass of it, ends between two times, cycles.
    pub fn begins_block(&self, before: f64, now: f64) -> bool {
        before < self.averages_from && self.block(before) != self.block(now)
    }

    /// Whether a step that began at `before` ends with a pass.
    pub fn ends_pass(&self, before: f64, now: f64) -> bool {
        self.recurs() && self.begins_block(before, now) && self.block(now).1 == 0
    }

    /// Whether a time, cycles, is within a first cycle that wears from rest.
    pub fn is_first(&self, cycles: f64) -> bool {
        self.conditions.wears_from_rest && !has_come(FIRST_END, cycles)
    }

    /// How friction changes along the cycles, or along the energy dissipated: never along both.
    pub fn friction_change(&self) -> &History {
        match self.friction_along_energy {
            History::Constant => &self.conditions.friction_history,
            _ => &self.friction_along_energy,
        }
    }

    /// Factor on friction along the energy dissipated per area of the first contact, J/m².
    pub fn friction_along_energy(&self) -> &History {
        &self.friction_along_energy
    }

    /// The first settled cycle of each block, with the laws as they are at the start.
    pub fn first_cycles(&self) -> impl Iterator<Item = CycleLoading> {
        let mut start = 0.0;
        self.loadings.iter().enumerate().map(move |(block, _)| {
            let loading = CycleLoading { share: 1.0, ..self.loading_in_block(start, 0.0) };
            start = self.ends.get(block).copied().unwrap_or_default();
            loading
        })
    }

    /// Whether every block that is still to come was under way between two times, cycles.
    pub fn has_shown_all(&self, since: f64, now: f64) -> bool {
        match self.ends.last() {
            None => true,
            Some(_) if now >= self.averages_from => true,
            Some(whole) if self.conditions.repeat => now - since >= *whole,
            Some(_) => self.block(now).1 == self.loadings.len() - 1,
        }
    }

    /// Everything that acts at some time but for pauses, with friction at its smallest and at its largest.
    pub fn extremes(&self) -> impl Iterator<Item = CycleLoading> {
        scaled(&self.loadings, self.friction_change().range())
    }

    /// Everything that acts in the end: the last block that is no pause, or all of them where they are repeated, with friction as it is then.
    pub fn lasting(&self) -> impl Iterator<Item = CycleLoading> {
        self.last_of(self.loadings.len())
    }

    /// The same of the blocks that begin before nothing more is asked for.
    pub(super) fn lasting_until_end(&self) -> impl Iterator<Item = CycleLoading> {
        let before = &self.ends[..self.ends.len().saturating_sub(1)];
        self.last_of(1 + before.iter().filter(|end| !has_come(self.asked_until, **end)).count())
    }

    /// Of the first blocks the last that is no pause, or all of them where they are repeated.
    fn last_of(&self, begun: usize) -> impl Iterator<Item = CycleLoading> {
        let factor = self.friction_change().last();
        let [begun, last] =
            if self.conditions.repeat { [self.loadings.len(), usize::MAX] } else { [begun, 1] };
        self.loadings[..begun].iter().rev().filter(|loading| !loading.is_pause()).take(last).map(
            move |loading| {
                let slipped = self.slipped(begun - 1, f64::INFINITY);
                CycleLoading { friction: loading.friction.scaled(factor), slipped, ..loading.clone() }
            },
        )
    }

    /// The next time after `cycles` at which what acts changes abruptly or has a kink, in cycles: a step may end there but not cross it.
    pub fn next_break(&self, cycles: f64) -> Option<f64> {
        let histories = [&self.conditions.friction_history, &self.conditions.wear_history];
        let kinks = histories.into_iter().flat_map(|history| history.kinks()).map(|t| t / self.clock_rate);
        let block = (self.changes_between_blocks() && cycles < self.averages_from).then(|| {
            let (pass, block) = self.block(cycles);
            self.end(pass, block)
        });
        let first = self.conditions.wears_from_rest.then_some(FIRST_END);
        kinks
            .chain(block)
            .chain(first)
            .chain(self.ends_with_gross_slip_at())
            .filter(|time| !has_come(*time, cycles) && time.is_finite())
            .min_by(f64::total_cmp)
    }

    /// How many breaks there are up to a number of cycles.
    pub fn breaks_until(&self, cycles: f64) -> f64 {
        let histories = [&self.conditions.friction_history, &self.conditions.wear_history];
        let passed = |time: &&f64| **time / self.clock_rate < cycles;
        let kinks: usize = histories.iter().map(|it| it.kinks().iter().filter(passed).count()).sum();
        let ends = match self.ends.last() {
            Some(whole) if self.conditions.repeat => {
                cycles.min(self.averages_from) / whole * self.ends.len() as f64
            }
            _ => self.ends.iter().filter(|end| **end < cycles).count() as f64,
        };
        kinks as f64 + ends + f64::from(u8::from(self.conditions.wears_from_rest))
    }

    /// Pass through the blocks, and index of the block, that begins at `cycles` or is under way then.
    fn block(&self, cycles: f64) -> (f64, usize) {
        let Some(whole) = self.ends.last() else { return (0.0, 0) };
        if !self.conditions.repeat {
            return (
                0.0,
                self.ends.partition_point(|end| has_come(*end, cycles)).min(self.loadings.len() - 1),
            );
        }
        // The quotient may round to either side of a whole number of passes.
        let first = ((cycles / whole).floor() - 1.0).max(0.0);
        let ahead =
            (0..3 * self.ends.len()).map(|i| (first + (i / self.ends.len()) as f64, i % self.ends.len()));
        ahead
            .into_iter()
            .find(|(pass, block)| !has_come(self.end(*pass, *block), cycles))
            .unwrap_or((first, 0))
    }

    /// End of a block, cycles; the last one goes on where they are not repeated.
    fn end(&self, pass: f64, block: usize) -> f64 {
        let last = self.ends.len() - 1;
        if !self.conditions.repeat && block == last {
            return f64::INFINITY;
        }
        pass * self.ends[last] + self.ends[block]
    }

    /// Whether blocks differ by their indentation.
    pub fn lifts_blocks(&self) -> bool {
        self.changes_between_blocks() && self.loadings.iter().any(|loading| loading.least_lift() > 0.0)
    }

    /// Whether the indenter is lifted within a period, so that springs lose contact.
    pub fn lifts(&self) -> bool {
        self.loadings.iter().any(|loading| loading.path.as_ref().is_some_and(|path| !path.is_level()))
    }

    /// Whether the slip in all resolved periods is taken by [`Steps`].
    pub fn takes_steps(&self) -> bool {
        self.loadings.iter().all(|loading| loading.steps.is_some())
    }

    /// Whether periods are passed through step by step.
    pub fn resolves(&self) -> bool {
        self.loadings.iter().any(|loading| loading.path.is_some())
    }

    /// Whether what springs do in all resolved periods is in a table.
    pub fn is_tabulated(&self) -> bool {
        self.loadings.iter().all(|loading| loading.response.is_some())
    }

    /// Steps of the loop of every period, for which one to and fro at constant indentation takes `plain`.
    pub fn loop_steps(&self, plain: usize) -> usize {
        if self.conditions.mode.is_tangential() {
            return plain;
        }
        let followed = |loading: &CycleLoading| {
            let steps = loading.steps.as_ref().map(|steps| steps.path().points.len());
            steps.or(loading.path.as_ref().map(|path| path.points.len()))
        };
        self.loadings.iter().filter_map(followed).max().unwrap_or(plain)
    }

    /// Numbers for the slip of a spring in a period, the most of all blocks; one where a cycle has a closed form.
    pub fn columns(&self) -> usize {
        let columns = |loading: &CycleLoading| match (&loading.response, &loading.steps, &loading.path) {
            (Some(table), ..) => table.columns(),
            (None, Some(steps), _) => steps.columns(),
            (None, None, Some(path)) => path.columns(&path.ways()),
            (None, None, None) => 1,
        };
        self.loadings.iter().map(columns).max().unwrap_or(1)
    }

    /// Whether the indenter leaves the x axis in some block.
    pub fn leaves_axis(&self) -> bool {
        let mut paths = self.loadings.iter().filter_map(|loading| loading.path.as_ref());
        paths.any(|path| path.points.iter().any(|point| point.tangential[1] != 0.0))
    }

    /// Whether every cycle is the same: one amplitude at one indentation, under friction that does not change.
    pub fn is_steady(&self) -> bool {
        let conditions = &self.conditions;
        self.keeps_slipping_alike() && conditions.tangential_control == TangentialControl::Displacement
    }

    /// Whether the mesh of the plain contact serves: every cycle the same, to and fro, under Coulomb's law.
    pub fn is_uniform(&self) -> bool {
        let Conditions { mode, friction, .. } = &self.conditions;
        self.is_steady() && mode.is_tangential() && friction.coefficient().is_some()
    }

    /// Whether springs of the same compression slip by as much in every cycle: neither blocks nor friction change that.
    pub fn keeps_slipping_alike(&self) -> bool {
        !self.slips_otherwise() && self.keeps_friction()
    }

    /// Whether ground wears only where it is pressed: no debris spreads.
    pub fn wears_locally(&self) -> bool {
        self.conditions.wear.spreading().is_none()
    }

    /// Whether friction changes along the cycles and along the energy dissipated, which is not followed.
    pub fn changes_friction_by_both(&self) -> bool {
        let by_both = [&self.conditions.friction_history, &self.friction_along_energy];
        by_both.iter().all(|history| **history != History::Constant)
    }

    /// Whether friction changes neither along the cycles nor along the energy dissipated.
    pub fn keeps_friction(&self) -> bool {
        *self.friction_change() == History::Constant
    }

    /// Whether friction stays the same between two times, cycles, without a break in between.
    pub fn keeps_friction_until(&self, now: f64, later: f64) -> bool {
        let [now, later] = [now, later].map(|cycles| cycles * self.clock_rate);
        self.friction_along_energy == History::Constant && self.conditions.friction_history.stays(now, later)
    }

    /// The part of its first value to which the rate of wear falls at most as friction and the law of wear change; zero where friction rises, which may end all slip.
    pub fn least_by_laws(&self) -> f64 {
        let ([least, most], [worn, _]) =
            (self.friction_change().range(), self.conditions.wear_history.range());
        if most > 1.0 { 0.0 } else { least * worn }
    }

    /// Whether the wear of a cycle is in proportion to pressure and slip, and to nothing else.
    pub fn is_plain(&self) -> bool {
        let Conditions { wear, friction, .. } = &self.conditions;
        self.is_uniform() && !self.resolves() && wear.archard_coefficient(friction.coefficient()).is_some()
    }

    /// Whether wear is in proportion to pressure and slip, and slip known from the slip depth: the slopes of a cycle are those of the pressure.
    pub fn wears_by_pressure_alone(&self) -> bool {
        let Conditions { wear, friction, tangential_control, .. } = &self.conditions;
        let given = *tangential_control == TangentialControl::Displacement && !self.resolves();
        given
            && friction.coefficient().is_some()
            && wear.archard_coefficient(friction.coefficient()).is_some()
    }

    /// Whether nothing makes a kink in wear along the slip annulus. A resolved cycle does: it takes what is pulled as without contact.
    pub fn wears_smoothly(&self) -> bool {
        self.wears_nearly_smoothly() && self.conditions.mode.is_tangential() && !self.resolves()
    }

    /// Whether cycles are the same, at a constant indentation, and wear is local, at a rate without a kink: at most resolved cycles make kinks, weak ones.
    pub fn wears_nearly_smoothly(&self) -> bool {
        (self.makes_weak_kinks() || self.rests_under_both_forces()) && !self.conditions.wear.has_kink()
    }

    /// Whether both forces are held in cycles that are the same, and wear is local: the edge of stick stays, and amplitude and indentation follow from the
    /// springs.
    fn rests_under_both_forces(&self) -> bool {
        let Conditions { mode, friction, .. } = &self.conditions;
        let same = self.keeps_slipping_alike();
        let closed = mode.is_tangential() && friction.coefficient().is_some() && !self.resolves();
        self.conditions.holds_both_forces() && same && closed && self.wears_locally()
    }

    /// Whether every cycle of gross slip does the same to the same compressions, at a rate without a kink.
    pub fn is_smooth_in_gross_slip(&self) -> bool {
        let differs = self.changes_in_time() && (self.slips_otherwise() || self.lifts_blocks());
        !differs && self.keeps_friction() && !self.conditions.wear.has_kink()
    }

    /// Whether cycles are the same, at a constant indentation, and wear is local: at most resolved cycles or a threshold make kinks along the annulus.
    pub fn makes_weak_kinks(&self) -> bool {
        self.is_steady() && !self.lifts() && self.wears_locally()
    }
}

/// Those that are no pause, under friction scaled by each of two factors.
fn scaled(loadings: &[CycleLoading], factors: [f64; 2]) -> impl Iterator<Item = CycleLoading> {
    loadings.iter().filter(|loading| !loading.is_pause()).flat_map(move |loading| {
        factors.map(|factor| CycleLoading { friction: loading.friction.scaled(factor), ..loading.clone() })
    })
}

/// Tangential amplitude that is given, m: of the contact, or of the far end of a rig.
///
/// A stick radius that is asked for is the contact's; then the far end moves by `U_far = U + F_x(U)/k_r`.
fn driven_amplitude(
    contact: &InitialContact,
    conditions: &Conditions,
    friction: &dyn FrictionLaw,
) -> Result<f64> {
    let amplitude = contact.amplitude();
    match conditions.tangential_control {
        TangentialControl::Rig { stiffness } if contact.amplitude_follows_stick() => {
            Ok(amplitude + first_force(contact, friction, amplitude, contact.indentation())? / stiffness)
        }
        _ => Ok(amplitude),
    }
}

/// The table of a path that turns at constant indentation; that of an earlier block with the same path, if there is one.
fn response(path: &Path, friction: &dyn FrictionLaw, before: &[CycleLoading]) -> Option<Arc<Response>> {
    if path.is_straight() || friction.static_factor() != 1.0 {
        return None;
    }
    let same = before.iter().find(|loading| loading.path.as_deref() == Some(path));
    same.map_or_else(|| Response::new(path).map(Arc::new), |loading| loading.response.clone())
}
