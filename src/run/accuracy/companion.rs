//! A coarser run of the same scene, as it is seen at the radii of the run.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::super::cost::work_so_far;
use super::super::parts::Parts;
use super::substeps::{Unsampled, finer_than};
use crate::data::Snapshot;
use crate::scene::{Numerics, Scene, Stepper};
use crate::solver::model::{OperatorStore, Schedule};
use crate::solver::simulation::{End, Flow, Observer, Outcome, Simulation};

/// Part of its work that a companion may take for what it sees of the substeps, and how many times as much that may be at all outputs, of which it then sees one in so many.
const OF_LOOKS: f64 = 0.5;
const MOST_SKIPPED: f64 = 8.0;

/// Worn volume and depth at one time.
#[derive(Debug)]
pub(super) struct Worn {
    pub cycles: f64,
    pub volume: f64,
    /// At the radii looked at.
    pub depth: Vec<f64>,
    /// One in so many of those is a radius of the run.
    pub every: usize,
}

impl Worn {
    fn of(simulation: &Simulation, every: usize) -> Self {
        let state = simulation.state();
        let volume = simulation.model().worn_volume(state, simulation.fields());
        Self { cycles: state.cycles, volume, depth: simulation.wear_depth(), every }
    }

    pub(super) fn shown(snapshot: &Snapshot, every: usize) -> Self {
        let depth = snapshot.wear_depth.iter().step_by(every).copied().collect();
        Self { cycles: snapshot.cycles, volume: snapshot.wear_volume, depth, every: 1 }
    }

    /// At the radii of the run.
    pub(super) fn nodes(&self) -> impl Iterator<Item = f64> + '_ {
        self.depth.iter().copied().step_by(self.every)
    }

    pub(super) fn deepest(&self) -> f64 {
        self.depth.iter().copied().fold(0.0, f64::max)
    }
}

/// What a companion is to be.
pub(super) struct Coarser<'a> {
    pub scene: &'a Scene,
    pub numerics: Numerics,
    pub springs: usize,
    /// `r² - c²`, m², of the radii looked at, and one in how many of those is a radius of the run.
    pub offsets: &'a [f64],
    pub between: usize,
    /// Whether it tells what the substeps of a period leave out, if periods are sampled.
    pub samples: bool,
    /// The schedule of the run, where that has as many substeps.
    pub schedule: Option<&'a Schedule>,
    /// Whether steps see the mean cycle of a pass, as those of the run.
    pub averages: bool,
    /// Steps after which it is lost, if it chooses them by itself.
    pub most_steps: f64,
    /// Work, as [`work_so_far`], after which the run would take too long.
    pub most_work: f64,
    pub store: &'a OperatorStore,
    pub stop: &'a Arc<AtomicBool>,
}

impl Coarser<'_> {
    /// Whether profiles are compared as curves, for which companions are looked at between the radii of the run.
    fn as_curves(&self) -> bool {
        self.between > 1
    }
}

/// A coarser run that came to its end.
#[derive(Debug)]
pub(in crate::run) struct Companion {
    pub(super) springs: usize,
    /// At its outputs.
    pub(super) seen: Vec<Worn>,
    /// Whether the last of them is at the end of wear, whenever that came.
    pub(super) spent: bool,
    /// What substeps leave out; none where periods are not sampled.
    pub(super) unsampled: Option<Unsampled>,
}

/// Why there is no companion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lost {
    /// It comes to no end.
    NoEnd,
    /// It takes longer than leaves time for the run.
    Dear(Dear),
}

/// A companion that tells that the run would take too long.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::run) struct Dear {
    /// What it took to know, as [`work_so_far`].
    pub(in crate::run) work: u64,
    /// Whether it came past half of its outputs, so that a run on somewhat fewer springs may come to its end.
    pub(in crate::run) halfway: bool,
}

impl Dear {
    fn of(simulation: &Simulation) -> Self {
        let passed = 2 * simulation.progress().next_output as usize;
        Self { work: work_so_far(simulation) as u64, halfway: passed >= simulation.plan().outputs.len() }
    }
}

impl Companion {
    /// Runs it.
    pub(super) fn run(coarser: &Coarser<'_>) -> Result<Self, Lost> {
        let Coarser { scene, numerics, .. } = coarser;
        let averages = Some(coarser.averages);
        let Ok(mut parts) =
            Parts::on_any(scene, numerics, Some(coarser.springs), coarser.schedule, averages, coarser.store)
        else {
            return Err(Lost::NoEnd);
        };
        let ends_by_rate = matches!(parts.plan.end, End::Rate(_));
        let samples = coarser.samples && !scene.conditions().mode.is_tangential();
        let unsampled = samples
            .then(|| Unsampled::new(scene, numerics, &parts.model, coarser.as_curves()).ok_or(Lost::NoEnd));
        let unsampled = unsampled.transpose()?;
        parts.model = parts.model.shown_at(coarser.offsets.to_vec());
        let Ok(mut simulation) = parts.begin() else { return Err(Lost::NoEnd) };
        // Explicit steps are as many as cycles or stiffness ask for.
        let implicit = numerics.stepper == Stepper::Implicit;
        let most_steps = if implicit { coarser.most_steps } else { f64::INFINITY };
        let most_work = if implicit { coarser.most_work } else { f64::INFINITY };
        let looks = work_of_looks(&simulation) / (OF_LOOKS * most_work);
        if unsampled.is_some() && looks > MOST_SKIPPED {
            return Err(Lost::Dear(Dear::of(&simulation)));
        }
        let stop = Arc::clone(coarser.stop);
        let every = looks.ceil().max(1.0) as usize;
        let between = coarser.between;
        let mut seen = Seen { worn: vec![], between, unsampled, every, stop, most_steps, most_work };
        let outcome = simulation.run(&mut [&mut seen]);
        if work_so_far(&simulation) > most_work {
            return Err(if is_stuck(&simulation) { Lost::NoEnd } else { Lost::Dear(Dear::of(&simulation)) });
        }
        match outcome {
            Ok(Outcome::Interrupted) | Err(_) => Err(Lost::NoEnd),
            Ok(outcome) => Ok(Self {
                springs: simulation.springs(),
                seen: seen.worn,
                spent: ends_by_rate && outcome != Outcome::Unending,
                unsampled: seen.unsampled,
            }),
        }
    }
}

/// Whether it is the springs that are too few, not the work too much, where the contact lifts within each period.
fn is_stuck(simulation: &Simulation) -> bool {
    simulation.model().schedule().lifts() && simulation.progress().rejects_many()
}

/// Work of what is seen of the substeps at the outputs, by that of the cycles with which a simulation begins: two at least.
fn work_of_looks(simulation: &Simulation) -> f64 {
    let model = simulation.model();
    let cycle = 0.5 * model.work_counted() as f64;
    let looks = 1 + simulation.plan().outputs.len();
    (finer_than(model.schedule()) * looks) as f64 * cycle
}

/// What is seen at the outputs.
struct Seen {
    worn: Vec<Worn>,
    /// One in so many of the radii looked at is one of the run.
    between: usize,
    unsampled: Option<Unsampled>,
    /// One in so many outputs tells what substeps leave out.
    every: usize,
    stop: Arc<AtomicBool>,
    most_steps: f64,
    most_work: f64,
}

impl Seen {
    fn goes_on(&self, simulation: &Simulation) -> Flow {
        let lost =
            simulation.progress().steps as f64 > self.most_steps || work_so_far(simulation) > self.most_work;
        if lost || self.stop.load(Ordering::Relaxed) { Flow::Stop } else { Flow::Continue }
    }
}

impl Observer for Seen {
    fn output(&mut self, simulation: &Simulation) -> crate::Result<()> {
        self.worn.push(Worn::of(simulation, self.between));
        let left = simulation.plan().outputs.len().saturating_sub(self.worn.len());
        if let Some(unsampled) = self.unsampled.as_mut().filter(|_| left.is_multiple_of(self.every)) {
            unsampled.see(simulation);
        }
        Ok(())
    }

    fn step(&mut self, simulation: &Simulation) -> crate::Result<Flow> {
        Ok(self.goes_on(simulation))
    }

    fn rejected(&mut self, simulation: &Simulation) -> crate::Result<Flow> {
        Ok(self.goes_on(simulation))
    }
}
