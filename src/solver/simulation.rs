//! The loop over time: which step to try, where to land, when to stop.

use std::borrow::Cow;
use std::f64::consts::PI;

use crate::error::{Error, Result};
use crate::numerics::linear::largest;
use crate::solver::model::{CycleFields, CycleLoading, Fields, Model, Past, RadialFields, State};
use crate::solver::stepper::{self, Stepper, Trial};

mod failure;
mod hand_over;
mod possible;
mod step;

use failure::nothing_wears;
pub use hand_over::HandOver;
use hand_over::Taking;
use step::{Landing, Rejected};

/// Compression, relative to `q_c`, below which no pressure is left but round-off.
const WORN_OUT: f64 = 1e-13;

/// Part of the rate of worn volume by trapezoids that is certainly worn. The quadrature of the volume is more accurate, but some of its weights
/// are negative, and where only the ground next to the edge of stick still wears its sum may vanish.
const CERTAIN_WEAR: f64 = 0.5;

/// Rejected steps after which a run that rejects many is given up. Where a held force loses its stick
/// zone, the edge of stick is followed in ever smaller steps.
const MOST_REJECTED: u64 = 4000;

/// Rejected steps after each of which it is seen, where the contact lifts within each period, whether the run would be given up before its end at the pace of the last of them, and the part of the cycles
/// done that these steps took at most. Elsewhere stick may be lost in a finite time, next to which steps are as small.
const REJECTED_AT_ONCE: u64 = 50;
const CRAWLS: f64 = 0.05;

/// Dimensionless time at which a run ends that would last until its rate has fallen, where wear goes on without end.
const SHOWN_UNENDING: f64 = 1.0;

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// After this many cycles.
    Cycles(f64),
    /// When the worn volume per cycle has fallen to this fraction of its first value.
    Rate(f64),
}

/// When to take snapshots and when to stop.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Cycles at which steps land, as they do at the end, increasing, positive, none beyond it.
    pub outputs: Vec<f64>,
    /// When to stop.
    pub end: End,
}

/// How a simulation ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The last cycle was reached.
    End,
    /// The rate fell to the fraction asked for.
    Rate,
    /// No pressure is left, so that the rate asked for is below round-off.
    WornOut,
    /// The rate asked for is never reached: the contact is in gross slip under a held normal force.
    Unending,
    /// An observer asked to stop.
    Interrupted,
}

/// What an observer wants after a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// Stop here; the simulation can be resumed.
    Stop,
}

/// Observer of a simulation: snapshots, checkpoints, a progress bar.
pub trait Observer {
    /// Called where the plan asks for output, the start and the end included.
    ///
    /// # Errors
    /// Ends the simulation.
    fn output(&mut self, simulation: &Simulation) -> Result<()> {
        let _ = simulation;
        Ok(())
    }

    /// Called after every accepted step.
    ///
    /// # Errors
    /// Ends the simulation.
    fn step(&mut self, simulation: &Simulation) -> Result<Flow> {
        let _ = simulation;
        Ok(Flow::Continue)
    }

    /// Called after every rejected one. A simulation that is stopped here is not resumed.
    ///
    /// # Errors
    /// Ends the simulation.
    fn rejected(&mut self, simulation: &Simulation) -> Result<Flow> {
        let _ = simulation;
        Ok(Flow::Continue)
    }
}

/// What besides the state a restart needs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Progress {
    /// Step to be tried next, cycles.
    pub next_step: f64,
    /// Worn volume per cycle at the start, m³.
    pub first_rate: f64,
    /// Cycles until which the rate was above the one at which to stop.
    pub busy_until: f64,
    /// Cycles from which on steps see the mean cycle of a pass, where its blocks were stepped through before; else zero.
    pub averages_from: f64,
    /// Cycles done when it was last seen whether steps that are rejected lead on.
    pub rejected_at: f64,
    /// Index of the next entry of the plan's outputs.
    pub next_output: u64,
    /// Steps accepted.
    pub steps: u64,
    /// Steps rejected.
    pub rejected_steps: u64,
    /// Evaluations of pressure, slip and wear.
    pub rate_evaluations: u64,
    /// Work of the periods that steps and outputs resolved, nanoseconds of one core, about, as [`Model::work_counted`].
    pub resolved_work: u64,
}

impl Progress {
    /// Whether more than half as many steps were rejected as accepted.
    pub fn rejects_many(&self) -> bool {
        2 * self.rejected_steps > self.steps
    }
}

/// Where a step led, and what follows from there.
struct Reached {
    state: State,
    fields: Fields,
    cycle: CycleFields,
    rate: f64,
}

/// A model on its way through time.
pub struct Simulation {
    model: Model,
    stepper: Box<dyn Stepper + Send>,
    tolerance: f64,
    plan: Plan,
    state: State,
    fields: Fields,
    cycle: CycleFields,
    /// Wear depth on the limit's springs, m.
    depth: Vec<f64>,
    rate: f64,
    progress: Progress,
    /// Radius, m, at which the last state that was refused had lost wear depth.
    healed_at: Option<f64>,
    taking: Taking,
    /// Whether the next step settles a state that was handed over, so that its error does not count.
    settles: bool,
    rejected: Rejected,
    /// When and where a rig broke the last stick, if it did.
    let_go: Option<String>,
    /// Swing of a pass, over the limit and over what is worn, from which on downwards steps see its mean cycle; zero where they never come to do so.
    most_swing: f64,
}

impl Simulation {
    /// Starts from the unworn contact.
    ///
    /// # Arguments
    /// * `tolerance` -- largest error of one step in the wear depth, relative to the largest depth of the limit
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if the method of stepping does not follow the edge of stick of the model as it moves or stays; those of
    /// [`Model::initial_state`].
    pub fn new(model: Model, stepper: Box<dyn Stepper + Send>, tolerance: f64, plan: Plan) -> Result<Self> {
        stepper::check_model(&*stepper, &model)?;
        let state = model.initial_state()?;
        let fields = model.fields(&state);
        let mut first_rate = 0.0_f64;
        let mut growth = 0.0_f64;
        let mut finite = true;
        for loading in model.schedule().first_cycles() {
            let other = model.at_indentation_of(&loading, &state)?.map(|state| (model.fields(&state), state));
            let (fields, state) = other.as_ref().map_or((&fields, &state), |(fields, state)| (fields, state));
            let cycle = model.cycle_in_block(&model.loading_in(state, loading), &state.compression, fields);
            first_rate = first_rate.max(rate_of_wear(&model, fields, &cycle));
            growth = growth.max(largest(&cycle.growth));
            finite &= cycle.volume.is_finite() && cycle.growth.iter().all(|it| it.is_finite());
        }
        if !(finite && growth > 0.0 && first_rate > 0.0) {
            return Err(nothing_wears(&model, finite));
        }
        let next_step = stepper.first_growth() / growth;
        let progress = Progress { next_step, first_rate, rate_evaluations: 1, ..Progress::default() };
        Ok(Self::resume(model, stepper, tolerance, plan, state, progress))
    }

    /// Goes on from a state, as if there had been no interruption.
    pub fn resume(
        mut model: Model,
        stepper: Box<dyn Stepper + Send>,
        tolerance: f64,
        plan: Plan,
        state: State,
        progress: Progress,
    ) -> Self {
        if progress.averages_from > 0.0 {
            model.average_from(progress.averages_from);
        }
        let fields = model.fields(&state);
        let (cycle, rate) = cycle_of(&model, &state, &fields, state.cycles);
        let depth = model.depth_on_springs(&state, &fields);
        Self {
            model,
            stepper,
            tolerance,
            plan,
            state,
            fields,
            cycle,
            depth,
            rate,
            progress,
            healed_at: None,
            taking: Taking::default(),
            settles: false,
            rejected: Rejected::default(),
            let_go: None,
            most_swing: 0.0,
        }
    }

    /// Lets steps no longer end with each block once the swing of a pass has fallen to this part of the limit and of what is worn.
    #[must_use]
    pub fn averaging_below(self, most_swing: f64) -> Self {
        Self { most_swing, ..self }
    }

    /// Whether steps that end with each block may come to see passes.
    pub fn may_come_to_average(&self) -> bool {
        self.most_swing > 0.0
            && !self.model.follows_blocks()
            && self.model.may_average()
            && !self.model.wears_without_end()
    }

    /// The swing of a pass, over the limit, that is left out since blocks are no longer stepped through.
    pub fn swing_left_out(&self) -> f64 {
        if self.progress.averages_from > 0.0 { self.most_swing } else { 0.0 }
    }

    /// Whether passes have become short beside what is left of wear.
    fn passes_are_short(&self, state: &State) -> bool {
        let swing = if self.may_come_to_average() { self.model.pass_swing(state) } else { None };
        swing.is_some_and(|swing| {
            let parts = [self.model.of_limit(&swing), swing.volume / state.volume_by_rate];
            parts.iter().all(|part| *part <= self.most_swing)
        })
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Name of the method of time stepping.
    pub fn stepper_name(&self) -> &'static str {
        self.stepper.name()
    }

    /// The model alone, when nothing more is to be simulated.
    pub fn into_model(self) -> Model {
        self.model
    }

    /// The state reached.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The fields of the state reached.
    pub fn fields(&self) -> &Fields {
        &self.fields
    }

    /// What the next cycle does, or the mean cycle of a pass through the blocks.
    pub fn cycle(&self) -> &CycleFields {
        &self.cycle
    }

    /// What the next cycle does, in the block that is under way.
    pub fn cycle_in_block(&self) -> Cow<'_, CycleFields> {
        let (model, state) = (&self.model, &self.state);
        if !model.schedule().averages_at(state.cycles) {
            return Cow::Borrowed(&self.cycle);
        }
        let loading = model.schedule().loading_in_block(state.cycles, state.cycles);
        let loading = model.loading_in(state, loading);
        Cow::Owned(model.cycle_in_block(&loading, &state.compression, &self.fields))
    }

    /// The fields at the radii of the output, with the slip of the block that is under way.
    pub fn radial_fields(&self) -> RadialFields {
        self.model.radial_fields(&self.state, &self.fields, &self.cycle_in_block())
    }

    /// Wear depth at the radii of the output, m, shape `(node,)`.
    pub fn wear_depth(&self) -> Vec<f64> {
        self.model.radial_wear_depth(&self.state, &self.fields, 1)
    }

    /// The plan.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// What besides the state a restart needs.
    pub fn progress(&self) -> &Progress {
        &self.progress
    }

    /// Largest error of one step in the wear depth, relative to the largest depth of the limit.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Worn volume per cycle, m³, by the quadrature of the worn volume, but at least half of what trapezoids give.
    pub fn wear_rate(&self) -> f64 {
        self.rate
    }

    /// How much of the plan is done, from 0 to 1: by cycles, or by the logarithm of the rate that ends it.
    pub fn done(&self) -> f64 {
        let done = match self.plan.end {
            End::Cycles(cycles) => self.state.cycles / cycles,
            End::Rate(fraction) => (self.rate / self.progress.first_rate).ln().min(0.0) / fraction.ln(),
        };
        done.clamp(0.0, 1.0)
    }

    /// Tries a step of so many cycles and forgets it.
    ///
    /// # Errors
    /// Those of the stepper.
    pub fn try_step(&mut self, cycles: f64) -> Result<()> {
        let tried = self.stepper.step(&self.model, &self.state, cycles).map(|_| ());
        self.stepper.forget();
        tried
    }

    /// Steps to the end of the plan or until an observer stops it. The start is an output too, unless steps were made before.
    ///
    /// # Errors
    /// [`Error::NotConverged`] if the step would have to become smaller than round-off allows; those of stepper and observers.
    pub fn run(&mut self, observers: &mut [&mut dyn Observer]) -> Result<Outcome> {
        if self.progress.steps == 0 {
            self.tell(observers)?;
        }
        loop {
            if let Some(outcome) = self.outcome() {
                return Ok(outcome);
            }
            self.hand_over()?;
            if self.model.loses_stick(&self.state) {
                return Err(self.slides_off());
            }
            if self.model.is_held_again(&self.state) {
                return Err(self.held_again());
            }
            let advanced = match self.advance(observers) {
                Err(Error::NotConverged { .. })
                    if self.model.is_losing_stick(&self.state) && self.take_up() =>
                {
                    continue;
                }
                advanced => advanced.map_err(|error| self.timed(error))?,
            };
            let Some(landed) = advanced else { return Ok(Outcome::Interrupted) };
            let ended = self.outcome().is_some();
            if landed || ended {
                self.tell(observers)?;
            }
            let mut flow = Flow::Continue;
            for observer in observers.iter_mut() {
                if observer.step(self)? == Flow::Stop {
                    flow = Flow::Stop;
                }
            }
            if flow == Flow::Stop && !ended {
                return Ok(Outcome::Interrupted);
            }
        }
    }

    /// States at the outputs that lie within a step; none if one of them is not possible.
    ///
    /// # Arguments
    /// * `rests` -- whether the contact stays as it is
    fn passed(&self, state: &State, rests: bool) -> Option<Vec<(State, Fields)>> {
        let outputs = &self.plan.outputs[self.progress.next_output as usize..];
        let within = outputs.iter().take_while(|output| **output < state.cycles);
        let states = within.map(|output| {
            let between = match rests {
                true => self.resting_until(*output),
                false => self.stepper.between(&self.model, state, *output)?,
            };
            let fields = self.model.fields(&between);
            (self.model.gross().is_some() || fields.are_physical()).then_some((between, fields))
        });
        states.collect()
    }

    /// Shows the states within the last step.
    fn tell_passed(
        &mut self,
        passed: Vec<(State, Fields)>,
        observers: &mut [&mut dyn Observer],
    ) -> Result<()> {
        for (state, fields) in passed {
            let (cycle, _) = cycle_of(&self.model, &state, &fields, state.cycles);
            let mut shown = (state, fields, cycle);
            self.progress.next_output += 1;
            self.exchange(&mut shown);
            let told = self.tell(observers);
            self.exchange(&mut shown);
            told?;
        }
        Ok(())
    }

    fn exchange(&mut self, other: &mut (State, Fields, CycleFields)) {
        std::mem::swap(&mut self.state, &mut other.0);
        std::mem::swap(&mut self.fields, &mut other.1);
        std::mem::swap(&mut self.cycle, &mut other.2);
    }

    fn tell(&mut self, observers: &mut [&mut dyn Observer]) -> Result<()> {
        self.counting(|it| observers.iter_mut().try_for_each(|observer| observer.output(it)))
    }

    /// Does something, and counts the periods that it resolves.
    fn counting<T>(&mut self, something: impl FnOnce(&mut Self) -> T) -> T {
        let before = self.model.work_counted();
        let done = something(self);
        self.progress.resolved_work += self.model.work_counted() - before;
        done
    }

    /// Cycles up to which wear is shown that has no end, where it is to end by its rate.
    fn shown_until(&self) -> Option<f64> {
        let unending = matches!(self.plan.end, End::Rate(_)) && self.model.wears_without_end();
        unending.then(|| SHOWN_UNENDING / self.model.contact().tau_per_cycle())
    }

    /// How it ended; none while it goes on or can be resumed.
    pub fn outcome(&self) -> Option<Outcome> {
        if let Some(end) = self.shown_until() {
            return (self.state.cycles >= end).then_some(Outcome::Unending);
        }
        match self.plan.end {
            End::Cycles(cycles) => (self.state.cycles >= cycles).then_some(Outcome::End),
            End::Rate(fraction) => {
                // After a step beyond the limit the rate is negative for a while.
                let shown = self.model.schedule().has_shown_all(self.progress.busy_until, self.state.cycles);
                let spent = self.cycle.volume >= 0.0
                    && self.wear_rate() <= fraction * self.progress.first_rate
                    && shown;
                let limit = WORN_OUT * self.model.contact().slip_compression();
                let worn_out =
                    self.state.compression.iter().all(|q| q.abs() <= limit) || self.wears_no_more();
                let worn_out = worn_out && (shown || !self.model.follows_blocks());
                spent.then_some(Outcome::Rate).or(worn_out.then_some(Outcome::WornOut))
            }
        }
    }

    /// Makes one step, of which the length may have to be found; whether it landed on an output. None where an observer stops the search for its length.
    fn advance(&mut self, observers: &mut [&mut dyn Observer]) -> Result<Option<bool>> {
        loop {
            let landing = self.choose_step()?;
            let step = landing.step;
            let trial = self.tried(&landing)?;
            let (error, next_step) = (trial.error / self.tolerance, trial.next_step);
            let is_looked_at = error <= 1.0 || self.settles;
            let reached = if is_looked_at { self.counting(|it| it.reached(trial)) } else { None };
            if let Some(shorter) = reached.as_ref().and_then(|it| self.overshoot(it.rate, step)) {
                self.progress.next_step = shorter;
                continue;
            }
            let passed = reached.as_ref().and_then(|it| self.passed(&it.state, landing.rests));
            let mut accepted = false;
            if let Some((reached, passed)) = reached.zip(passed) {
                accepted = self.counting(|it| it.accept(reached, landing.at))?;
                if accepted {
                    self.tell_passed(passed, observers)?;
                }
            }
            if self.stepper.prescribed_step().is_some() {
                if !accepted {
                    return Err(self.stuck("the wear of one cycle leaves no contact that wear can lead to"));
                }
            } else if !landing.rests {
                // What settles tells nothing of the next step.
                let error = if self.settles && accepted { error.min(1.0) } else { error };
                self.adapt(step, error, accepted, next_step);
            }
            if accepted {
                self.settles = false;
                self.rejected = Rejected::default();
                self.progress.steps += 1;
                self.progress.next_output += u64::from(landing.output);
                return Ok(Some(landing.output));
            }
            self.settles |= self.rejected.are_alike_with(error, step) && self.begins_block();
            if self.reject(observers)? == Flow::Stop {
                return Ok(None);
            }
            if self.outcome().is_some() {
                return Ok(Some(false));
            }
        }
    }

    /// Tries a step, and counts what that takes.
    fn tried(&mut self, landing: &Landing) -> Result<Trial> {
        let trial = self.counting(|it| match landing.rests {
            true => Ok(Trial::at_rest(it.resting_until(it.state.cycles + landing.step))),
            false => it.stepper.step(&it.model, &it.state, landing.step),
        })?;
        self.progress.rate_evaluations += trial.rate_evaluations;
        Ok(trial)
    }

    /// What a step led to; none if no contact was found.
    fn reached(&self, trial: Trial) -> Option<Reached> {
        let state = trial.state?;
        let fields = trial.fields.unwrap_or_else(|| self.model.fields(&state));
        let (cycle, rate) = cycle_of(&self.model, &state, &fields, self.state.cycles);
        Some(Reached { state, fields, cycle, rate })
    }

    /// Counts a step that was rejected.
    ///
    /// # Errors
    /// [`Error::NotConverged`](crate::Error::NotConverged) if too many were; those of observers.
    fn reject(&mut self, observers: &mut [&mut dyn Observer]) -> Result<Flow> {
        self.progress.rejected_steps += 1;
        let rejected = self.progress.rejected_steps;
        let mut is_stuck = rejected > MOST_REJECTED && self.progress.rejects_many();
        if self.model.schedule().lifts() && rejected.is_multiple_of(REJECTED_AT_ONCE) {
            is_stuck |= self.crawls();
            self.progress.rejected_at = self.state.cycles;
        }
        if is_stuck {
            return Err(self.stuck("wear goes on in ever smaller steps, of which most are rejected"));
        }
        let mut flow = Flow::Continue;
        for observer in observers.iter_mut() {
            if observer.rejected(self)? == Flow::Stop {
                flow = Flow::Stop;
            }
        }
        Ok(flow)
    }

    /// Whether the steps since the last look are so short that more of them would be rejected than is allowed before the end of the run, or before it has lasted twice as long where a rate ends it.
    fn crawls(&self) -> bool {
        let now = self.state.cycles;
        let passed = now - self.progress.rejected_at;
        let left = match self.plan.end {
            End::Cycles(end) => end - now,
            End::Rate(_) => now,
        };
        let at_this_pace = passed * (MOST_REJECTED / REJECTED_AT_ONCE) as f64;
        passed <= CRAWLS * now && at_this_pace < left
    }

    /// Accepts a state if wear can lead to it.
    fn accept(&mut self, reached: Reached, target: Option<f64>) -> Result<bool> {
        let Reached { mut state, mut fields, mut cycle, mut rate } = reached;
        let mut depth = self.model.depth_on_springs(&state, &fields);
        let is_possible = match self.model.gross() {
            Some(gross) => self.has_not_shrunk(gross, &state),
            None => self.is_possible(&state, &fields, &depth),
        };
        if !is_possible {
            return Ok(false);
        }
        self.healed_at = None;
        if let Some(target) = target {
            state.cycles = target;
        }
        let schedule = self.model.schedule();
        if schedule.is_first(self.state.cycles) && !schedule.is_first(state.cycles) {
            // Rates change by a jump, which no polynomial through the times before follows.
            state.past = Past::default();
        }
        if let End::Rate(fraction) = self.plan.end
            && rate > fraction * self.progress.first_rate
        {
            self.progress.busy_until = state.cycles;
        }
        // Steppers look at their ends; the first cycle of a block is where springs come to slip.
        state.least_stick_radius = state.least_stick_radius.min(self.cycle.stick_radius);
        if target.is_some() {
            let edge = state.stick.as_ref().map(|it| it.area);
            state = self.model.begin_block(state, self.state.cycles)?;
            self.model.count_jump(edge, &state);
            if self.model.schedule().ends_pass(self.state.cycles, state.cycles)
                && self.passes_are_short(&state)
            {
                self.progress.averages_from = state.cycles;
                self.model.average_from(state.cycles);
            }
            fields = self.model.fields(&state);
            // On a mesh that begins anew the depth between springs is another by as much as they leave open.
            depth = self.model.depth_on_springs(&state, &fields);
            (cycle, rate) = cycle_of(&self.model, &state, &fields, state.cycles);
        }
        (self.state, self.fields, self.cycle, self.depth, self.rate) = (state, fields, cycle, depth, rate);
        Ok(true)
    }
}

/// Worn volume per cycle, m³, at least what is certainly worn.
fn rate_of_wear(model: &Model, fields: &Fields, cycle: &CycleFields) -> f64 {
    if model.gross().is_some() {
        return cycle.volume;
    }
    let nodes = model.operators().nodes();
    let wear = |i: usize| (cycle.growth[i] * fields.slip_depth[i]).max(0.0);
    let last = cycle.growth.len().min(fields.slip_depth.len());
    // No wear at the edge of stick.
    let first = 0.5 * wear(0) * nodes[1];
    let cells = (1..last).map(|i| 0.5 * (wear(i - 1) + wear(i)) * (nodes[i + 1] - nodes[i]));
    let trapezoids = PI * fields.slip_area * (first + cells.sum::<f64>());
    cycle.volume.max(CERTAIN_WEAR * trapezoids)
}

/// The cycle that follows a state, in the block that is under way at `start` or as the mean of a pass, and its rate of wear: that of the block that wears most.
fn cycle_of(model: &Model, state: &State, fields: &Fields, start: f64) -> (CycleFields, f64) {
    let loading = model.loading_in(state, model.schedule().loading(start, state.cycles));
    let cycle_in = |loading: &CycleLoading| model.cycle_in_block(loading, &state.compression, fields);
    if loading.others.is_empty() {
        let cycle = cycle_in(&loading);
        let rate = rate_of_wear(model, fields, &cycle);
        return (cycle, rate);
    }
    let mut most = 0.0;
    let cycle = CycleFields::mean(loading.parts().map(|part| {
        let cycle = cycle_in(part);
        most = rate_of_wear(model, fields, &cycle).max(most);
        (part.part, cycle)
    }));
    (cycle, most)
}
