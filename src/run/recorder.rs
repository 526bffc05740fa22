//! What a run records: snapshots, checkpoints, and the estimate of its error.

use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::Shared;
use super::accuracy::companion::Dear;
use super::accuracy::estimate::{Coarsening, Companions};
use super::budget::{self, Shares};
use super::cost;
use super::limit::worn_profile;
use super::passes;
use crate::data::{Attempt, Checkpoint, RunWriter, Snapshot, StopReason};
use crate::error::Result;
use crate::laws::loading::TangentialControl;
use crate::scene::{Scene, Stepper};
use crate::solver::model::{CycleFields, FrettingLoop, OperatorStore, State};
use crate::solver::simulation::{Flow, Observer, Outcome, Simulation};

/// Steps along one fretting loop to and fro at constant indentation in the result file, even.
const LOOP_STEPS: usize = 64;

/// What is recorded at an output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Detail {
    /// Everything.
    Whole,
    /// What the end of a run is told from: numbers without those of the fretting loop, and the wear depth where companions are compared. The rest is
    /// not a number, and of the loop there is no point.
    ForTheEnd,
}

/// The contact as it is now.
pub(super) fn snapshot(simulation: &Simulation) -> Snapshot {
    let (model, state) = (simulation.model(), simulation.state());
    let cycle = &*simulation.cycle_in_block();
    let radial = simulation.radial_fields();
    let wear_depth = if is_unworn(state) { vec![0.0; radial.wear_depth.len()] } else { radial.wear_depth };
    let fretting_loop = fretting_loop(simulation, cycle);
    let tangential_force = fretting_loop.largest_force();
    let share = model.schedule().loading_in_block(state.cycles, state.cycles).share;
    let [energy_ratio, sliding_ratio] =
        [fretting_loop.energy_ratio(cycle.work / share), fretting_loop.sliding_ratio()];
    let along_y = |values: Vec<f64>| if model.schedule().leaves_axis() { values } else { vec![] };
    let [loop_displacement, displacement_y] = fretting_loop.displacement;
    let [loop_force, force_y] = fretting_loop.force;
    let [loop_displacement_y, loop_force_y] = [displacement_y, force_y].map(along_y);
    Snapshot {
        tangential_force,
        energy_ratio,
        sliding_ratio,
        loop_displacement,
        loop_force,
        loop_displacement_y,
        loop_force_y,
        profile: worn_profile(model, &wear_depth),
        wear_depth,
        pressure: radial.pressure,
        slip: radial.slip,
        ..numbers(simulation, cycle)
    }
}

/// The contact as [`Detail::ForTheEnd`] has it.
///
/// # Arguments
/// * `every` -- one in so many radii is compared
fn sketch(simulation: &Simulation, every: usize) -> Snapshot {
    let (model, state) = (simulation.model(), simulation.state());
    let unknown = vec![f64::NAN; model.offsets().len()];
    let mut wear_depth = unknown.clone();
    let compared = model.radial_wear_depth(state, simulation.fields(), every);
    for (slot, depth) in wear_depth.iter_mut().step_by(every).zip(compared) {
        *slot = if is_unworn(state) { 0.0 } else { depth };
    }
    let [profile, pressure, slip] = [unknown.clone(), unknown.clone(), unknown];
    let numbers = numbers(simulation, &simulation.cycle_in_block());
    Snapshot { profile, wear_depth, pressure, slip, ..numbers }
}

/// The numbers of a contact, without those of its loop.
fn numbers(simulation: &Simulation, cycle: &CycleFields) -> Snapshot {
    let (model, state, fields) = (simulation.model(), simulation.state(), simulation.fields());
    Snapshot {
        cycles: state.cycles,
        tau: state.cycles * model.contact().tau_per_cycle(),
        regime: model.regime(state, cycle),
        wear_volume: if is_unworn(state) { 0.0 } else { model.worn_volume(state, fields) },
        contact_radius: model.contact_radius(state),
        stick_radius: model.without_core(cycle.stick_radius),
        permanent_stick_radius: model.without_core(state.least_stick_radius.min(cycle.stick_radius)),
        indentation: model.indentation(state),
        normal_force: model.normal_force(fields),
        dissipated_energy: state.dissipated_energy,
        cycle_energy: cycle.dissipation,
        tangential_force: f64::NAN,
        energy_ratio: f64::NAN,
        sliding_ratio: f64::NAN,
        ..Snapshot::default()
    }
}

fn is_unworn(state: &State) -> bool {
    state.cycles == 0.0
}

/// The loop of the cycle that is under way, with as many points as every other of the run.
fn fretting_loop(simulation: &Simulation, cycle: &CycleFields) -> FrettingLoop {
    let (model, state) = (simulation.model(), simulation.state());
    let schedule = model.schedule();
    let loading = model.loading_in(state, schedule.loading_in_block(state.cycles, state.cycles));
    let mut found = model.cycle_loop(&loading, cycle, &state.compression, simulation.fields(), LOOP_STEPS);
    let points = 1 + schedule.loop_steps(LOOP_STEPS);
    for values in found.displacement.iter_mut().chain(&mut found.force) {
        let end = values[0];
        values.resize(points, end);
    }
    found
}

/// Takes snapshots and checkpoints, and stops the run when it is asked to.
pub(super) struct Recorder {
    pub(super) writer: RunWriter,
    interval: Duration,
    started: Instant,
    saved: Instant,
    wall_seconds_before: f64,
    stop: Arc<AtomicBool>,
    /// Whether the result is written to a file; else only checkpoints are.
    pub(super) saves_result: bool,
    /// What is recorded at its outputs.
    pub(super) detail: Detail,
    /// Coarser runs, where the program chose the springs.
    companions: Option<Companions>,
    /// The accuracy asked for, where the program chooses the springs.
    accuracy: Option<f64>,
    /// Work that it may take, where the program chooses springs and steps, and whether it took more.
    most_work: f64,
    takes_too_long: bool,
    /// Whether the companions tell that it would take too long; they may do so while it runs.
    would_take_too_long: Arc<AtomicBool>,
    /// How far they came to know.
    dear: Option<Dear>,
    pub(super) attempt: Attempt,
}

impl Recorder {
    /// A run that is stopped earlier than this, s, is not worth a file.
    const WORTH_KEEPING: f64 = 0.2;

    pub(super) fn new(scene: &Scene, writer: RunWriter, wall_seconds_before: f64, shared: &Shared) -> Self {
        let of_scene = || Duration::from_secs_f64(scene.numerics().checkpoint_interval);
        let interval = shared.checkpoint_interval.unwrap_or_else(of_scene);
        let (now, stop) = (Instant::now(), Arc::clone(shared.stop.flag()));
        Self {
            writer,
            interval,
            started: now,
            saved: now,
            wall_seconds_before,
            stop,
            saves_result: true,
            detail: Detail::Whole,
            companions: None,
            accuracy: scene.numerics().accuracy_asked(),
            most_work: f64::INFINITY,
            takes_too_long: false,
            would_take_too_long: Arc::default(),
            dear: None,
            attempt: Attempt::default(),
        }
    }

    /// Whether the last run was stopped since it takes too long.
    pub(super) fn takes_too_long(&self) -> bool {
        self.takes_too_long
    }

    /// Coarser runs beside the last one, where the program chose the springs.
    pub(super) fn companions(&self) -> Option<&Companions> {
        self.companions.as_ref()
    }

    /// Whether the companions of a run tell that it would take too long.
    pub(super) fn would_take_too_long(&self) -> bool {
        self.would_take_too_long.load(Ordering::Relaxed)
    }

    /// Work of an attempt that was left since its companions told so.
    pub(super) fn work_of_left(&self) -> u64 {
        cost::work_of_left(self.dear.map_or(0, |it| it.work))
    }

    /// Whether they tell that somewhat fewer springs would not do either.
    pub(super) fn is_far_too_long(&self) -> bool {
        self.dear.is_some_and(|it| !it.halfway)
    }

    /// Whether the file is written where the run ends.
    pub(super) fn saves(&self, complete: bool, failed: bool) -> bool {
        let long = self.wall_seconds() > Self::WORTH_KEEPING;
        self.saves_result || (!complete && !failed && long)
    }

    /// Time that all attempts took so far, s, before an interruption too.
    pub(super) fn wall_seconds(&self) -> f64 {
        self.wall_seconds_before + self.started.elapsed().as_secs_f64()
    }

    /// Runs a simulation, and its coarser companions beside it where the program chose the springs. Until they have come to their ends, checkpoints tell that
    /// nothing is known of the error. It stops where they tell that it would take too long, if no coarser one came to its end before.
    ///
    /// # Arguments
    /// * `limited` -- whether the scene has a limit in closed form
    pub(super) fn run(
        &mut self,
        scene: &Scene,
        store: &OperatorStore,
        simulation: &mut Simulation,
        limited: bool,
        onlookers: &mut dyn Observer,
    ) -> Result<Outcome> {
        let chosen = scene.numerics().springs.is_none();
        let compared = chosen || !has_balance(simulation);
        self.companions = compared.then(|| Companions::new(scene, simulation, limited));
        let bounded = chosen && scene.numerics().stepper == Stepper::Implicit && !self.attempt.ends_again();
        // Also where another model has taken the run up, as before an interruption.
        let (model, _) = simulation.first();
        self.most_work = if bounded { self.attempt.most_work(model) } else { f64::INFINITY };
        (self.takes_too_long, self.would_take_too_long) = (false, Arc::default());
        // Nothing is told of the error of the last resort.
        let compares = compared && !self.attempt.is_last_resort();
        let coarsening = compares.then(|| Coarsening::new(scene, simulation, &self.attempt));
        let (stop, too_long) = (Arc::clone(&self.stop), Arc::clone(&self.would_take_too_long));
        let leaves = chosen && !self.attempt.has_end();
        let run_companions = || {
            let found = coarsening.map(|it| it.run(scene, store, &stop))?;
            too_long.store(leaves && found.dear().is_some(), Ordering::Relaxed);
            Some(found)
        };
        let (outcome, found) = beside(|| simulation.run(&mut [&mut *self, onlookers]), run_companions);
        if let (Some(companions), Some(found)) = (&mut self.companions, found) {
            self.dear = found.dear();
            companions.take(found);
        }
        outcome
    }

    /// Goes on with a simulation that was stopped because it would take too long, until it does.
    pub(super) fn go_on(
        &mut self,
        simulation: &mut Simulation,
        onlookers: &mut dyn Observer,
    ) -> Result<Outcome> {
        self.would_take_too_long.store(false, Ordering::Relaxed);
        simulation.run(&mut [&mut *self, onlookers])
    }

    /// By coarser runs where the program chose the springs, else by the balance of the worn volume, as before the first snapshot that a companion
    /// on a smooth mesh saw. Where neither tells and an accuracy was asked for, nothing is known.
    fn error_estimate(&self, simulation: &Simulation) -> Option<f64> {
        let Some(companions) = &self.companions else { return balance_error(simulation) };
        if self.attempt.is_last_resort() {
            return Some(budget::UNKNOWN);
        }
        let balance = || if companions.is_smooth() { balance_error(simulation) } else { None };
        let found = self.shares(simulation).map(|shares| shares.error()).or_else(balance);
        let found = found.or(self.accuracy.map(|_| budget::UNKNOWN));
        match self.attempt.ends_again() {
            true => found.map(|error| error.max(self.attempt.ended_within)),
            false => found,
        }
    }

    /// What the companions tell of the error, as [`Companions::shares`], and at its end the attempt before that came to its own: of what they are apart, as much is of this one as is beyond the
    /// error of that one, or as is left where errors fall as fast as they may.
    pub(super) fn shares(&self, simulation: &Simulation) -> Option<Shares> {
        let companions = self.companions.as_ref()?;
        let shares = companions.shares(simulation, self.writer.snapshots())?;
        let Some(apart) = self.apart_from_ended(simulation).filter(|_| !companions.is_smooth()) else {
            return Some(shares);
        };
        let times = simulation.first().0.springs() as f64 / self.attempt.ended_on as f64;
        let least = (apart - self.attempt.ended_within).max(apart * budget::left_of_difference(times));
        Some(Shares { springs: shares.springs.max(least), ..shares })
    }

    /// The difference of worn volume, relative, of an attempt at its end from the one before that came to its own.
    pub(super) fn apart_from_ended(&self, simulation: &Simulation) -> Option<f64> {
        let companions = self.companions.as_ref().filter(|_| self.attempt.has_end())?;
        simulation.outcome()?;
        let apart = (self.wear_volume() - self.attempt.ended_volume).abs();
        let scale = companions.volume_scale(self.writer.snapshots());
        // Where nothing wears there is nothing to be relative to.
        (scale > 0.0).then(|| apart / scale)
    }

    /// Worn volume at the last snapshot, m³; zero before the first.
    pub(super) fn wear_volume(&self) -> f64 {
        self.writer.snapshots().last().map_or(0.0, |it| it.wear_volume)
    }

    pub(super) fn checkpoint(&self, simulation: &Simulation) -> Checkpoint {
        Checkpoint {
            state: simulation.state().clone(),
            progress: *simulation.progress(),
            wall_seconds: self.wall_seconds(),
            error_estimate: self.error_estimate(simulation),
            accuracy: self.accuracy,
            attempt: self.attempt,
        }
    }
}

impl Observer for Recorder {
    fn output(&mut self, simulation: &Simulation) -> Result<()> {
        self.writer.push(match self.detail {
            Detail::Whole => snapshot(simulation),
            Detail::ForTheEnd => sketch(simulation, self.companions.as_ref().map_or(1, Companions::every)),
        });
        Ok(())
    }

    fn step(&mut self, simulation: &Simulation) -> Result<Flow> {
        if self.stop.load(Ordering::Relaxed) {
            return Ok(Flow::Stop);
        }
        if self.rejected(simulation)? == Flow::Stop {
            return Ok(Flow::Stop);
        }
        if self.saved.elapsed() >= self.interval {
            self.writer.save(&self.checkpoint(simulation), StopReason::Interrupted, false)?;
            self.saved = Instant::now();
        }
        Ok(Flow::Continue)
    }

    fn rejected(&mut self, simulation: &Simulation) -> Result<Flow> {
        self.takes_too_long = cost::work_so_far(simulation) > self.most_work;
        let stops = self.takes_too_long || self.would_take_too_long();
        Ok(if stops { Flow::Stop } else { Flow::Continue })
    }
}

/// Does one thing here and another in a thread of its own; one after the other where there are no other cores, or other scenes keep them busy.
fn beside<A, B: Send>(here: impl FnOnce() -> A, there: impl FnOnce() -> B + Send) -> (A, B) {
    let one_core = thread::available_parallelism().is_ok_and(|cores| cores.get() == 1);
    if one_core || rayon::current_thread_index().is_some() {
        let found = there();
        return (here(), found);
    }
    thread::scope(|scope| {
        let there = scope.spawn(there);
        let found = here();
        (found, there.join().unwrap_or_else(|panic| resume_unwind(panic)))
    })
}

/// Estimate of the error in the worn volume, relative to the limit's: its distance from the volume by the rates of the cycles.
///
/// Where worn volume and dissipated energy are in proportion, as under Archard's law and Coulomb's friction (`μ_f/k_w`), that volume is the
/// energy's, a balance that holds for the continuous contact between springs and surface. Else it is the integral of what the surface
/// loses in each cycle, and tells of the time stepping alone. What the springs do not see of a waviness is in neither. None where there is no such
/// [balance](has_balance).
fn balance_error(simulation: &Simulation) -> Option<f64> {
    let (model, state) = (simulation.model(), simulation.state());
    if !has_balance(simulation) {
        return None;
    }
    let by_depth = model.wear_volume(simulation.fields());
    // A coarse mesh may make less than nothing of a little wear.
    let whole =
        if model.gross().is_some() { by_depth.max(state.volume_by_rate) } else { model.limit_volume() };
    let by_rate = (state.volume_by_rate - by_depth).abs() / whole;
    let [of_volume, of_depth] = passes::left_out(model);
    let of_passes =
        (of_volume / whole).max(of_depth / model.depth_scale()) + passes::left_out_later(simulation);
    Some(by_rate.max(model.unseen_depth().unwrap_or(0.0)) + of_passes)
}

/// Whether the two volumes tell the error: where the edge of stick moves neither sees that of its place, nor that of an amplitude which follows from a balance
/// of forces, nor that of kinks: where springs begin to slip in gross slip, of all that cubics carry there, where the contact edge comes to lie while the contact lifts, where slip ends in smaller blocks or as friction rises, and what debris spreads of
/// slip that sets in with a jump.
fn has_balance(simulation: &Simulation) -> bool {
    let (model, _) = simulation.first();
    let schedule = model.schedule();
    let conditions = schedule.conditions();
    let tangential = conditions.tangential_control != TangentialControl::Displacement;
    let slides_with_kink = model.gross().is_some_and(|gross| gross.sticks() || gross.is_on_cubics());
    let [_, rises] = schedule.friction_change().directions();
    let jumps = conditions.friction.remembers_slip() && (rises || conditions.wear.spreading().is_some());
    let has_kink = slides_with_kink || jumps || schedule.lifts() || schedule.changes_between_blocks();
    !tangential && model.moving().is_none() && !has_kink
}
