//! What a run leaves behind: snapshots, checkpoints, and how far off it is.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::Shared;
use super::knob::{self, Pilot};
use super::ladder::{self, Ladder, Shares};
use super::limit::worn_profile;
use crate::data::{Checkpoint, RunWriter, Snapshot, StopReason};
use crate::error::{Error, Result};
use crate::laws::loading::TangentialControl;
use crate::scene::Scene;
use crate::solver::model::{FrettingLoop, OperatorStore};
use crate::solver::simulation::{Flow, Observer, Outcome, Simulation};

/// Steps along one fretting loop to and fro at constant indentation in the result file, even.
const LOOP_STEPS: usize = 64;

/// The contact as it is now.
pub(super) fn snapshot(simulation: &Simulation) -> Snapshot {
    let (model, state, fields) = (simulation.model(), simulation.state(), simulation.fields());
    let (contact, cycle) = (model.contact(), simulation.cycle());
    let radial = simulation.radial_fields();
    let unworn = state.cycles == 0.0;
    let wear_depth = if unworn { vec![0.0; radial.wear_depth.len()] } else { radial.wear_depth };
    let fretting_loop = fretting_loop(simulation);
    let tangential_force = fretting_loop.largest_force();
    let along_y = |values: Vec<f64>| if model.schedule().leaves_axis() { values } else { vec![] };
    let [loop_displacement, displacement_y] = fretting_loop.displacement;
    let [loop_force, force_y] = fretting_loop.force;
    let [loop_displacement_y, loop_force_y] = [displacement_y, force_y].map(along_y);
    Snapshot {
        cycles: state.cycles,
        tau: state.cycles * contact.tau_per_cycle(),
        regime: model.regime(state, cycle),
        wear_volume: if unworn { 0.0 } else { model.worn_volume(state, fields) },
        contact_radius: model.contact_radius(state),
        stick_radius: model.without_core(cycle.stick_radius),
        permanent_stick_radius: model.without_core(state.least_stick_radius.min(cycle.stick_radius)),
        indentation: model.indentation(state),
        normal_force: model.normal_force(fields),
        dissipated_energy: state.dissipated_energy,
        cycle_energy: cycle.dissipation,
        tangential_force,
        loop_displacement,
        loop_force,
        loop_displacement_y,
        loop_force_y,
        profile: worn_profile(model, &wear_depth),
        wear_depth,
        pressure: radial.pressure,
        slip: radial.slip,
    }
}

/// The loop of the cycle that is under way, with as many points as every other of the run.
fn fretting_loop(simulation: &Simulation) -> FrettingLoop {
    let (model, state) = (simulation.model(), simulation.state());
    let schedule = model.schedule();
    let drive = model.drive_in(state, schedule.drive(state.cycles, state.cycles));
    let mut found =
        model.cycle_loop(&drive, simulation.cycle(), &state.compression, simulation.fields(), LOOP_STEPS);
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
    /// Whether a file is to hold the result; else only checkpoints are written.
    pub(super) saves_result: bool,
    judge: Option<Judge>,
    /// The accuracy asked for, where the program chooses the springs.
    accuracy: Option<f64>,
}

/// What tells the error of a run whose springs the program chose.
enum Judge {
    /// On a smooth mesh; none if it came to no end.
    Pilot(Option<Pilot>),
    /// On any other.
    Ladder(Ladder),
}

impl Recorder {
    /// A run stopped before it took so long, s, is begun anew rather than kept.
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
            judge: None,
            accuracy: scene.numerics().accuracy_asked(),
        }
    }

    /// Whether the file is written where the run ends.
    pub(super) fn saves(&self, complete: bool, failed: bool) -> bool {
        let long = self.wall_seconds_before + self.started.elapsed().as_secs_f64() > Self::WORTH_KEEPING;
        self.saves_result || (!complete && !failed && long)
    }

    /// Lets coarser runs go before one whose springs the program chose.
    ///
    /// # Arguments
    /// * `limited` -- whether the scene has a limit in closed form
    pub(super) fn follow_judge(
        &mut self,
        scene: &Scene,
        store: &OperatorStore,
        simulation: &Simulation,
        limited: bool,
    ) {
        let (numerics, model) = (scene.numerics(), simulation.model());
        self.judge = numerics.springs.is_none().then(|| {
            if knob::serves(numerics, model) {
                let tolerance = simulation.tolerance();
                Judge::Pilot(Pilot::run(scene, store, model.springs(), tolerance, &self.stop))
            } else {
                Judge::Ladder(Ladder::climb(scene, numerics, simulation, limited, store, &self.stop))
            }
        });
    }

    /// What the error of a run is made up of, where its mesh is not smooth.
    fn shares(&self, simulation: &Simulation) -> Option<Shares> {
        match &self.judge {
            Some(Judge::Ladder(ladder)) => ladder.shares(simulation, self.writer.snapshots()),
            _ => None,
        }
    }

    /// By coarser runs where the program chose the springs and there is a snapshot, else by the balance of the worn volume.
    fn error_estimate(&self, simulation: &Simulation) -> Option<f64> {
        let snapshots = self.writer.snapshots();
        let balance = || balance_error(simulation);
        match &self.judge {
            None => balance(),
            Some(Judge::Pilot(Some(pilot))) => pilot.error_of(simulation, snapshots).or_else(balance),
            Some(Judge::Pilot(None)) => Some(balance().map_or(ladder::UNKNOWN, |it| it.max(ladder::UNKNOWN))),
            Some(Judge::Ladder(_)) => self.shares(simulation).map(|shares| shares.error()),
        }
    }

    /// Springs with which a run is to be made anew: where the program chose them, and the run found no end or may be off by more than was asked for.
    pub(super) fn wanting(
        &self,
        scene: &Scene,
        simulation: &Simulation,
        outcome: &Result<Outcome>,
        checkpoint: &Checkpoint,
    ) -> Option<usize> {
        let (accuracy, springs) = (scene.numerics().accuracy, simulation.model().springs());
        let error = match (&self.judge, outcome) {
            (None, _) | (_, Ok(Outcome::Interrupted)) => return None,
            // Without a pilot, its finer one may come to an end.
            (Some(Judge::Pilot(None)), _) => None,
            (_, Ok(_)) => checkpoint.error_estimate,
            // More springs may find an end where few do not.
            (_, Err(Error::NotConverged { .. })) => None,
            (_, Err(_)) => return None,
        };
        match &self.judge {
            Some(Judge::Ladder(_)) if outcome.is_ok() => {
                knob::worth_refining(springs, self.shares(simulation)?, accuracy)
            }
            _ => match error {
                Some(error) if error <= knob::SURE * accuracy => None,
                _ => knob::refined(springs, error, accuracy),
            },
        }
    }

    pub(super) fn checkpoint(&self, simulation: &Simulation) -> Checkpoint {
        Checkpoint {
            state: simulation.state().clone(),
            progress: *simulation.progress(),
            wall_seconds: self.wall_seconds_before + self.started.elapsed().as_secs_f64(),
            error_estimate: self.error_estimate(simulation),
            accuracy: self.accuracy,
        }
    }
}

impl Observer for Recorder {
    fn output(&mut self, simulation: &Simulation) -> Result<()> {
        self.writer.push(snapshot(simulation));
        Ok(())
    }

    fn step(&mut self, simulation: &Simulation) -> Result<Flow> {
        if self.stop.load(Ordering::Relaxed) {
            return Ok(Flow::Stop);
        }
        if self.saved.elapsed() >= self.interval {
            self.writer.save(&self.checkpoint(simulation), StopReason::Interrupted, false)?;
            self.saved = Instant::now();
        }
        Ok(Flow::Continue)
    }
}

/// Estimate of the error in the worn volume, relative to the limit's: its distance from the volume by the rates of the cycles.
///
/// Where worn volume and dissipated energy are in proportion, as under Archard's law and Coulomb's friction (`μ_f/k_w`), that volume is the
/// energy's, a balance that holds for the continuous contact between springs and surface. Else it is the integral of what the surface
/// loses in each cycle, and tells of the time stepping alone. What the springs do not see of a waviness is in neither. Where the edge of stick
/// moves neither sees the error of its place, and there is no estimate.
fn balance_error(simulation: &Simulation) -> Option<f64> {
    let (model, state) = (simulation.model(), simulation.state());
    let tangential = model.schedule().conditions().tangential_control != TangentialControl::Displacement;
    if tangential || state.stick.as_ref().is_some_and(|stick| !stick.wear_depth.is_empty()) {
        return None;
    }
    let by_depth = model.wear_volume(simulation.fields());
    let by_rate = (state.volume_by_rate - by_depth).abs() / model.limit_volume();
    Some(by_rate.max(model.core_uncertainty()).max(model.unseen_depth().unwrap_or(0.0)))
}
