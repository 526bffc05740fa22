//! A coarser run of the same scene, as it is seen at the radii of the run.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::super::parts::Parts;
use super::substeps::Unsampled;
use crate::data::Snapshot;
use crate::error::Result;
use crate::scene::{Numerics, Scene, Stepper};
use crate::solver::model::OperatorStore;
use crate::solver::simulation::{End, Flow, Observer, Outcome, Simulation};

/// Worn volume and depth at one time.
#[derive(Debug)]
pub(super) struct Worn {
    pub cycles: f64,
    pub volume: f64,
    /// At the radii looked at.
    pub depth: Vec<f64>,
}

impl Worn {
    fn of(simulation: &Simulation) -> Self {
        let state = simulation.state();
        let volume = simulation.model().worn_volume(state, simulation.fields());
        Self { cycles: state.cycles, volume, depth: simulation.wear_depth() }
    }

    pub(super) fn shown(snapshot: &Snapshot, every: usize) -> Self {
        let depth = snapshot.wear_depth.iter().step_by(every).copied().collect();
        Self { cycles: snapshot.cycles, volume: snapshot.wear_volume, depth }
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
    /// `r² - c²`, m², of the radii looked at.
    pub offsets: &'a [f64],
    /// Whether it tells what the substeps of a period leave out, if periods are sampled.
    pub samples: bool,
    /// Steps after which it is lost, if it chooses them by itself.
    pub most_steps: u64,
    pub store: &'a OperatorStore,
    pub stop: &'a Arc<AtomicBool>,
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

impl Companion {
    /// Runs it; none if it comes to no end.
    pub(super) fn run(coarser: &Coarser<'_>) -> Option<Self> {
        let Coarser { scene, numerics, .. } = coarser;
        let parts = Parts::on_any(scene, numerics, Some(coarser.springs), coarser.store).ok()?;
        let ends_by_rate = matches!(parts.plan.end, End::Rate(_));
        let samples = coarser.samples && !scene.conditions().mode.is_tangential();
        let unsampled = if samples { Some(Unsampled::new(scene, numerics, &parts.model)?) } else { None };
        let model = parts.model.shown_at(coarser.offsets.to_vec());
        let mut simulation = Simulation::new(model, parts.stepper, parts.tolerance, parts.plan).ok()?;
        // Explicit steps are as many as cycles or stiffness ask for.
        let most_steps = if numerics.stepper == Stepper::Implicit { coarser.most_steps } else { u64::MAX };
        let mut seen = Seen { worn: vec![], unsampled, stop: Arc::clone(coarser.stop), most_steps };
        let outcome = simulation.run(&mut [&mut seen]).ok()?;
        (outcome != Outcome::Interrupted).then(|| Self {
            springs: simulation.model().springs(),
            seen: seen.worn,
            spent: ends_by_rate && outcome != Outcome::Unending,
            unsampled: seen.unsampled,
        })
    }
}

/// What is seen at the outputs.
struct Seen {
    worn: Vec<Worn>,
    unsampled: Option<Unsampled>,
    stop: Arc<AtomicBool>,
    most_steps: u64,
}

impl Observer for Seen {
    fn output(&mut self, simulation: &Simulation) -> Result<()> {
        self.worn.push(Worn::of(simulation));
        if let Some(unsampled) = &mut self.unsampled {
            unsampled.see(simulation);
        }
        Ok(())
    }

    fn step(&mut self, simulation: &Simulation) -> Result<Flow> {
        let lost = simulation.progress().steps > self.most_steps;
        Ok(if lost || self.stop.load(Ordering::Relaxed) { Flow::Stop } else { Flow::Continue })
    }
}
