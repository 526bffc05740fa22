//! The loop over time: which step to try, where to land, when to stop.

use std::f64::consts::PI;

use crate::error::Result;
use crate::laws::loading::has_come;
use crate::solver::model::{CycleFields, Fields, Model, Past, RadialFields, State};
use crate::solver::stepper::{self, Stepper, Trial};

mod failure;
mod hand_over;
mod possible;

use failure::nothing_wears;
pub use hand_over::HandOver;
use hand_over::Taking;

/// Safety factor and bounds of the choice of steps.
const SAFETY: f64 = 0.9;
const SMALLEST_FACTOR: f64 = 0.2;
const LARGEST_FACTOR: f64 = 2.5;

/// Smallest useful step, as growth `κ p ΔN` of the slip under the largest pressure; below it round-off rules.
const SMALLEST_GROWTH: f64 = 1e-13;

/// Compression, relative to `q_c`, below which no pressure is left but round-off.
const WORN_OUT: f64 = 1e-13;

/// Least rate at the end of the last step, over the one asked for.
const OVERSHOT: f64 = 0.5;

/// Part of the rate of worn volume by trapezoids that is certainly worn. The quadrature of the volume is more accurate, but some of its weights
/// are negative, and where only the ground next to the edge of stick still wears its sum may vanish.
const CERTAIN_WEAR: f64 = 0.5;

/// Growth of slip up to the next break, over the tolerance, below which nothing wears.
const SPENT: f64 = 1e-6;

/// Rejected steps after which a run is given up if they are more than half of the accepted ones as well. Where a held force loses its stick
/// zone, the edge of stick is followed in ever smaller steps.
const MOST_REJECTED: u64 = 4000;

/// Relative difference of errors of steps that are alike, by how much shorter each is than the one before, and after how many of them the next is taken as it is.
const ALIKE: f64 = 0.02;
const SHORTER: f64 = 0.7;
const ENOUGH: usize = 4;

/// Largest such error, over the tolerance: with blocks that recur that is the accuracy asked for.
const MOST_OF_JUMP: f64 = 30.0;

/// How far before a moment, relative, another block was under way.
const BEFORE: f64 = 1e-9;

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
    /// Cycles at which steps land, increasing, positive, none beyond the end.
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

/// Steps shorter than this part of the planned one, because they end at an output or a break, do not decide the next.
const CUT_SHORT: f64 = 1e-3;

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

/// Errors of rejected steps that hardly change while the steps become shorter: what a jump between two blocks is off by, which no step makes less. It decays in one
/// implicit step, and companions tell what comes of it.
#[derive(Default)]
struct Repeats {
    last: Option<[f64; 2]>,
    count: usize,
}

impl Repeats {
    /// Whether enough of them were alike, with this one.
    fn are_enough(&mut self, error: f64, step: f64) -> bool {
        let alike = self
            .last
            .is_some_and(|[before, longer]| (error / before - 1.0).abs() < ALIKE && step < SHORTER * longer);
        self.count = if alike { self.count + 1 } else { 0 };
        self.last = Some([error, step]);
        self.count >= ENOUGH && error < MOST_OF_JUMP
    }
}

/// A step to try.
struct Landing {
    step: f64,
    /// Cycles at which it ends exactly, on an output or where what acts changes.
    at: Option<f64>,
    /// Whether that is an output.
    output: bool,
    /// Whether nothing wears until then, so that the contact stays as it is.
    rests: bool,
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
            let cycle = model.cycle(&model.loading_in(&state, loading), &state.compression, &fields);
            first_rate = first_rate.max(rate_of_wear(&model, &fields, &cycle));
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
        model: Model,
        stepper: Box<dyn Stepper + Send>,
        tolerance: f64,
        plan: Plan,
        state: State,
        progress: Progress,
    ) -> Self {
        let fields = model.fields(&state);
        let cycle = cycle_of(&model, &state, &fields, state.cycles);
        let depth = model.depth_on_springs(&state, &fields);
        let rate = rate_of_wear(&model, &fields, &cycle);
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
            taking: Taking::Never,
            settles: false,
        }
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

    /// What the next cycle does.
    pub fn cycle(&self) -> &CycleFields {
        &self.cycle
    }

    /// The fields at the radii of the output.
    pub fn radial_fields(&self) -> RadialFields {
        self.model.radial_fields(&self.state, &self.fields, &self.cycle)
    }

    /// Wear depth at the radii of the output, m, shape `(node,)`.
    pub fn wear_depth(&self) -> Vec<f64> {
        self.model.radial_wear_depth(&self.state, &self.fields)
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
            self.hand_over();
            if self.model.loses_stick(&self.state) {
                return Err(self.slides_off());
            }
            let advanced = self.advance(observers).map_err(|error| self.timed(error))?;
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

    /// The state at a later time up to which nothing wears; what slips without wear goes on to dissipate.
    fn resting_until(&self, cycles: f64) -> State {
        let passed = if self.is_still() { 0.0 } else { cycles - self.state.cycles };
        State {
            cycles,
            dissipated_energy: self.state.dissipated_energy + passed * self.cycle.dissipation,
            volume_by_rate: self.state.volume_by_rate + passed * self.cycle.volume,
            // No polynomial leads here.
            past: Past::default(),
            ..self.state.clone()
        }
    }

    /// Shows the states within the last step.
    fn tell_passed(
        &mut self,
        passed: Vec<(State, Fields)>,
        observers: &mut [&mut dyn Observer],
    ) -> Result<()> {
        for (state, fields) in passed {
            let cycle = cycle_of(&self.model, &state, &fields, state.cycles);
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
        let before = self.model.work_counted();
        let told = observers.iter_mut().try_for_each(|observer| observer.output(self));
        self.progress.resolved_work += self.model.work_counted() - before;
        told
    }

    /// How it ended; none while it goes on or can be resumed.
    pub fn outcome(&self) -> Option<Outcome> {
        match self.plan.end {
            End::Cycles(cycles) => (self.state.cycles >= cycles).then_some(Outcome::End),
            End::Rate(_) if self.model.wears_without_end() => {
                let tau = self.state.cycles * self.model.contact().tau_per_cycle();
                (tau >= SHOWN_UNENDING).then_some(Outcome::Unending)
            }
            End::Rate(fraction) => {
                // After a step beyond the limit the rate is negative for a while.
                let spent = self.cycle.volume >= 0.0
                    && self.wear_rate() <= fraction * self.progress.first_rate
                    && self.model.schedule().has_shown_all(self.progress.busy_until, self.state.cycles);
                let limit = WORN_OUT * self.model.contact().slip_compression();
                let worn_out = self.state.compression.iter().all(|q| q.abs() <= limit);
                spent.then_some(Outcome::Rate).or(worn_out.then_some(Outcome::WornOut))
            }
        }
    }

    /// Makes one step, of which the length may have to be found; whether it landed on an output. None where an observer stops the search for its length.
    fn advance(&mut self, observers: &mut [&mut dyn Observer]) -> Result<Option<bool>> {
        let (mut repeats, mut was_rejected) = (Repeats::default(), false);
        loop {
            let landing = self.choose_step(was_rejected)?;
            let step = landing.step;
            let before = self.model.work_counted();
            let trial = match landing.rests {
                true => Trial::at_rest(self.resting_until(self.state.cycles + step)),
                false => self.stepper.step(&self.model, &self.state, step)?,
            };
            self.progress.resolved_work += self.model.work_counted() - before;
            self.progress.rate_evaluations += trial.rate_evaluations;
            let error = trial.error / self.tolerance;
            let accepted = match trial.state {
                Some(state) if error <= 1.0 || self.settles => {
                    let fields = trial.fields.unwrap_or_else(|| self.model.fields(&state));
                    let cycle = cycle_of(&self.model, &state, &fields, self.state.cycles);
                    let rate = rate_of_wear(&self.model, &fields, &cycle);
                    if let Some(shorter) = self.overshoot(rate, step) {
                        self.progress.next_step = shorter;
                        continue;
                    }
                    let passed = self.passed(&state, landing.rests);
                    match passed {
                        Some(passed) => {
                            let accepted = self.accept(state, fields, cycle, rate, landing.at)?;
                            if accepted {
                                self.tell_passed(passed, observers)?;
                            }
                            accepted
                        }
                        None => false,
                    }
                }
                _ => false,
            };
            if self.stepper.prescribed_step().is_some() {
                if !accepted {
                    return Err(self.stuck("the wear of one cycle leaves no contact that wear can lead to"));
                }
            } else if !landing.rests {
                // What settles tells nothing of the next step.
                let error = if self.settles && accepted { error.min(1.0) } else { error };
                self.adapt(step, error, accepted, trial.next_step);
            }
            if accepted {
                self.settles = false;
                self.progress.steps += 1;
                self.progress.next_output += u64::from(landing.output);
                return Ok(Some(landing.output));
            }
            was_rejected = true;
            self.settles |= repeats.are_enough(error, step) && self.begins_block();
            self.progress.rejected_steps += 1;
            let rejected = self.progress.rejected_steps;
            if rejected > MOST_REJECTED && 2 * rejected > self.progress.steps {
                return Err(self.stuck("wear goes on in ever smaller steps, of which most are rejected"));
            }
            let mut stops = false;
            for observer in observers.iter_mut() {
                stops |= observer.rejected(self)? == Flow::Stop;
            }
            if stops {
                return Ok(None);
            }
        }
    }

    /// Whether nothing moves from now on to the next break: the block under way asks for no amplitude.
    fn is_still(&self) -> bool {
        let now = self.state.cycles;
        self.model.schedule().loading(now, now).asked() == 0.0
    }

    /// Whether a block of another amplitude or indentation has begun just now.
    fn begins_block(&self) -> bool {
        let (schedule, now) = (self.model.schedule(), self.state.cycles);
        now > 0.0 && schedule.begins_block(now * (1.0 - BEFORE), now)
    }

    /// The step to try, and where it lands if it does.
    ///
    /// # Arguments
    /// * `was_rejected` -- whether one from here was tried before
    fn choose_step(&self, was_rejected: bool) -> Result<Landing> {
        let now = self.state.cycles;
        let output = match self.plan.end {
            End::Cycles(end) if self.stepper.interpolates() => Some(end),
            End::Rate(_) if self.stepper.interpolates() => None,
            _ => self.plan.outputs.get(self.progress.next_output as usize).copied(),
        };
        let target = match (self.model.schedule().next_break(now), output) {
            // Where they differ by rounding, the step lands on the output.
            (Some(kink), Some(output)) => Some(if has_come(output, kink) { output } else { kink }),
            (kink, output) => kink.or(output),
        };
        let landing = |step: f64, at: Option<f64>| {
            let output = at.is_some() && at == output;
            Landing { step, at, output, rests: false }
        };
        if let Some(step) = self.stepper.prescribed_step() {
            return Ok(landing(step, target.filter(|t| now + 1.5 * step > *t)));
        }
        let growth = largest(&self.cycle.growth);
        // As long as nothing moves nothing wears, but for the round-off of what presses; and where nothing wears while friction stays, nothing will. Where a step is
        // found it takes what pulls back to what is only spent.
        let spent = |target: f64| {
            let grows = growth * (target - now) > SPENT * self.tolerance;
            was_rejected && !grows && self.model.schedule().keeps_friction_until(now, target)
        };
        if let Some(target) = target.filter(|target| self.is_still() || spent(*target)) {
            return Ok(Landing { rests: true, ..landing(target - now, Some(target)) });
        }
        let step = self.progress.next_step;
        let growth = step * growth;
        if !(growth > SMALLEST_GROWTH || (now > 0.0 && step > 1e-6 * now)) {
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

    /// The step that ends where the rate is what was asked for, if this one leaves it far behind; the rate falls exponentially.
    fn overshoot(&self, rate: f64, step: f64) -> Option<f64> {
        let End::Rate(fraction) = self.plan.end else { return None };
        if self.stepper.prescribed_step().is_some() {
            return None;
        }
        let wanted = fraction * self.progress.first_rate;
        let reached = rate.max(f64::MIN_POSITIVE);
        let now = self.wear_rate();
        let part = (now / wanted).ln() / (now / reached).ln();
        (now > wanted && reached < OVERSHOT * wanted && part < 1.0)
            .then(|| step * part.clamp(SMALLEST_FACTOR, 0.99))
    }

    /// Accepts a state if wear can lead to it.
    fn accept(
        &mut self,
        mut state: State,
        fields: Fields,
        cycle: CycleFields,
        rate: f64,
        target: Option<f64>,
    ) -> Result<bool> {
        let depth = self.model.depth_on_springs(&state, &fields);
        if self.model.gross().is_none() && !self.is_possible(&state, &fields, &depth) {
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
        let (mut fields, mut cycle, mut rate, mut depth) = (fields, cycle, rate, depth);
        if target.is_some() {
            let (edge, before) = (state.stick.as_ref().map(|it| it.area), self.model.work_counted());
            state = self.model.begin_block(state, self.state.cycles)?;
            self.model.count_jump(edge, &state);
            self.progress.resolved_work += self.model.work_counted() - before;
            fields = self.model.fields(&state);
            // On a mesh that begins anew the depth between springs is another by as much as they leave open.
            depth = self.model.depth_on_springs(&state, &fields);
            cycle = cycle_of(&self.model, &state, &fields, state.cycles);
            rate = rate_of_wear(&self.model, &fields, &cycle);
        }
        (self.state, self.fields, self.cycle, self.depth, self.rate) = (state, fields, cycle, depth, rate);
        Ok(true)
    }

    /// Chooses the next step from the error of this one over the tolerance.
    fn adapt(&mut self, step: f64, error: f64, accepted: bool, wanted: Option<f64>) {
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

/// Largest of some rates of growth, at least zero.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m: f64, value| m.max(*value))
}

/// The cycle that follows a state, in the block that is under way at `start`.
fn cycle_of(model: &Model, state: &State, fields: &Fields, start: f64) -> CycleFields {
    let loading = model.loading_in(state, model.schedule().loading(start, state.cycles));
    model.cycle(&loading, &state.compression, fields)
}
