//! How far off a run is whose order of convergence nobody knows: what coarser runs of the same scene differ by.
//!
//! The first companion has fewer springs and a larger tolerance than the run, the second still fewer. How the differences fall from the second
//! to the first tells the order, of which no more than second is believed, and less where it is not seen. Where periods are sampled, a third
//! companion differs from the first by its substeps alone.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::Parts;
use super::knob::substeps_for;
use crate::error::Result;
use crate::loading::Mode;
use crate::model::{Model, OperatorStore};
use crate::scene::{Numerics, Scene, Stepper};
use crate::simulation::{End, Flow, Observer, Outcome, Simulation};
use crate::snapshot::{Snapshot, same_cycles};

/// Springs of a run over those of its companion, and of that over those of the next; fewest of a companion.
const RATIO: f64 = 5.0 / 3.0;
const FEWEST: usize = 10;

/// Tolerance of a companion over that of the run, and the largest that any takes.
const TOLERANCE: f64 = 5.0;
const LARGEST_TOLERANCE: f64 = 0.1;

/// Orders that are believed: edges that move and kinks of wear are of second order at best, and below the first number nothing is known.
const ORDERS: [f64; 2] = [0.5, 2.0];

/// Order in the substeps that is believed: curved paths are of second order, springs that stick next to a reversal of less.
const ORDER_OF_SUBSTEPS: f64 = 1.0;

/// The estimate where a companion came to no end: as much as all that wears.
pub(super) const UNKNOWN: f64 = 1.0;

/// Steps after which a companion is lost that chooses them by itself.
const MOST_STEPS: u64 = 4000;

/// Worn volume and depth at one time.
#[derive(Debug)]
struct Sight {
    cycles: f64,
    volume: f64,
    /// At the radii looked at.
    depth: Vec<f64>,
}

/// A coarser run as it is seen at the radii of the run.
#[derive(Debug)]
struct Companion {
    /// Springs.
    springs: usize,
    /// Points of a period.
    points: usize,
    sights: Vec<Sight>,
    /// Whether its last sight is of the end of wear, whenever that came.
    spent: bool,
}

/// Coarser runs of a scene.
#[derive(Debug)]
pub(super) struct Ladder {
    springs: usize,
    points: usize,
    /// Every which of the radii of the run is looked at.
    every: usize,
    /// Volume and depth of the limit, where there is one.
    limit: Option<[f64; 2]>,
    /// What the discretisation leaves out in any case.
    left_out: f64,
    first: Option<Companion>,
    second: Option<Companion>,
    sampled: Option<Companion>,
    samples: bool,
}

/// What an error comes from.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Shares {
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
}

impl Ladder {
    /// Runs the companions of a run.
    ///
    /// # Arguments
    /// * `numerics` -- those of the run
    /// * `limited` -- whether the scene has a limit in closed form
    pub(super) fn climb(
        scene: &Scene,
        numerics: &Numerics,
        simulation: &Simulation,
        limited: bool,
        store: &OperatorStore,
        stop: &Arc<AtomicBool>,
    ) -> Self {
        let model = simulation.model();
        let offsets = model.offsets();
        let every = (offsets.len() / model.springs()).max(1);
        let offsets: Vec<f64> = offsets.into_iter().step_by(every).collect();
        let points = |model: &Model| model.schedule().loop_steps(1);
        let springs = |steps: i32| ((model.springs() as f64 / RATIO.powi(steps)).ceil() as usize).max(FEWEST);
        let samples = scene.conditions().mode != Mode::Tangential;
        let substeps = numerics.substeps.unwrap_or_else(|| substeps_for(numerics.accuracy));
        let coarser = |steps: i32, substeps: Option<usize>| {
            let numerics = Numerics {
                tolerance: Some((simulation.tolerance() * TOLERANCE.powi(steps)).min(LARGEST_TOLERANCE)),
                substeps,
                ..*numerics
            };
            let parts = Parts::on_any(scene, &numerics, Some(springs(steps)), store).ok()?;
            let plan = parts.plan.end;
            let model = parts.model.shown_at(offsets.clone());
            let mut coarse = Simulation::new(model, parts.stepper, parts.tolerance, parts.plan).ok()?;
            let mut seen = Seen { sights: vec![], stop: Arc::clone(stop), stepper: numerics.stepper };
            let outcome = coarse.run(&mut [&mut seen]).ok()?;
            let model = coarse.model();
            (outcome != Outcome::Interrupted).then(|| Companion {
                springs: model.springs(),
                points: points(model),
                sights: seen.sights,
                spent: matches!(plan, End::Rate(_)) && outcome != Outcome::Unending,
            })
        };
        let first = coarser(1, numerics.substeps);
        let sampled = first.as_ref().filter(|_| samples).and_then(|first| {
            // A recorded path has no fewer points than rows; then it is cut further.
            let fewer = coarser(1, Some((substeps / 2).max(2)));
            let differs = fewer.as_ref().is_none_or(|it| it.points != first.points);
            if differs { fewer } else { coarser(1, Some(2 * substeps.max(first.points))) }
        });
        let second = first.is_some().then(|| coarser(2, numerics.substeps)).flatten();
        let unseen = model.unseen_depth().unwrap_or(0.0);
        Self {
            springs: model.springs(),
            points: points(model),
            every,
            limit: limited.then(|| [model.limit_volume(), model.depth_scale()]),
            left_out: model.core_uncertainty().max(unseen),
            first,
            second,
            sampled,
            samples,
        }
    }

    /// Estimated error at the snapshots of the run: of the worn volume or of the profile at any radius, whichever is larger, relative to the
    /// limit's, or to the largest of the run where there is none. None before the first snapshot that a companion saw.
    pub(super) fn shares(&self, simulation: &Simulation, snapshots: &[Snapshot]) -> Option<Shares> {
        let sights: Vec<Sight> = snapshots.iter().map(|it| Sight::shown(it, self.every)).collect();
        let own = |value: fn(&Sight) -> f64| sights.iter().map(value).fold(0.0, f64::max);
        let scale = self.limit.unwrap_or_else(|| [own(|it| it.volume), own(Sight::deepest)]);
        if !(scale[0] > 0.0 && scale[1] > 0.0) {
            return None;
        }
        let spent = matches!(simulation.plan().end, End::Rate(_))
            && matches!(simulation.outcome(), Some(Outcome::Rate | Outcome::WornOut));
        let unknown = Shares { springs: UNKNOWN, left_out: self.left_out, ..Shares::default() };
        let Some(first) = &self.first else { return Some(unknown) };
        let nearest = gap(&sights, &first.sights, spent && first.spent, scale)?;
        let ratio = self.springs as f64 / first.springs as f64;
        let farther = self.second.as_ref().and_then(|second| {
            let gap = gap(&first.sights, &second.sights, first.spent && second.spent, scale)?;
            Some((gap, first.springs as f64 / second.springs as f64))
        });
        let (order, difference) = match farther {
            Some((gap, step)) => {
                let seen = (gap / nearest).ln() / step.ln();
                let grows = if seen > 0.0 { nearest } else { nearest.max(gap) };
                (seen.clamp(ORDERS[0], ORDERS[1]), grows)
            }
            None => (ORDERS[0], nearest),
        };
        let springs = difference / (ratio.powf(order) - 1.0);
        let substeps = match &self.sampled {
            None if self.samples => UNKNOWN,
            None => 0.0,
            Some(sampled) => {
                let gap = gap(&first.sights, &sampled.sights, first.spent && sampled.spent, scale)?;
                let ratio = self.points as f64 / sampled.points as f64;
                gap / (ratio.powf(ORDER_OF_SUBSTEPS) - 1.0).abs()
            }
        };
        let finite = |value: f64| if value.is_finite() { value } else { UNKNOWN };
        Some(Shares {
            springs: finite(springs),
            order,
            substeps: finite(substeps),
            left_out: finite(self.left_out),
        })
    }
}

impl Sight {
    fn of(simulation: &Simulation) -> Self {
        let state = simulation.state();
        let volume = simulation.model().worn_volume(state, simulation.fields());
        Self { cycles: state.cycles, volume, depth: simulation.wear_depth() }
    }

    fn shown(snapshot: &Snapshot, every: usize) -> Self {
        let depth = snapshot.wear_depth.iter().step_by(every).copied().collect();
        Self { cycles: snapshot.cycles, volume: snapshot.wear_volume, depth }
    }

    fn deepest(&self) -> f64 {
        self.depth.iter().copied().fold(0.0, f64::max)
    }

    /// The larger of the differences of volume and depth.
    fn gap(&self, other: &Self, [volume, depth]: [f64; 2]) -> f64 {
        let of_volume = (self.volume - other.volume).abs() / volume;
        let depths = self.depth.iter().zip(&other.depth).map(|(a, b)| (a - b).abs() / depth);
        depths.chain([of_volume]).fold(0.0, larger)
    }
}

/// The larger of two numbers; infinite where one is none.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::INFINITY } else { a.max(b) }
}

/// The largest difference of two runs at the times that both saw, the ends of wear included where both came to them.
fn gap(one: &[Sight], other: &[Sight], spent: bool, scale: [f64; 2]) -> Option<f64> {
    let worn = one.iter().filter(|it| it.cycles > 0.0);
    let common = worn.filter_map(|it| {
        let same = other.iter().find(|that| same_cycles(that.cycles, it.cycles))?;
        Some(it.gap(same, scale))
    });
    let ends = one.last().zip(other.last()).filter(|_| spent).map(|(a, b)| a.gap(b, scale));
    common.chain(ends).reduce(larger)
}

/// What is seen at the outputs.
struct Seen {
    sights: Vec<Sight>,
    stop: Arc<AtomicBool>,
    stepper: Stepper,
}

impl Observer for Seen {
    fn output(&mut self, simulation: &Simulation) -> Result<()> {
        self.sights.push(Sight::of(simulation));
        Ok(())
    }

    fn step(&mut self, simulation: &Simulation) -> Result<Flow> {
        // Explicit steps are as many as cycles or stiffness ask for.
        let lost = self.stepper == Stepper::Implicit && simulation.progress().steps > MOST_STEPS;
        Ok(if lost || self.stop.load(Ordering::Relaxed) { Flow::Stop } else { Flow::Continue })
    }
}
