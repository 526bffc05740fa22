//! How far off a run is whose order of convergence nobody knows: what coarser runs of the same scene differ by.
//!
//! The first companion has fewer springs and a larger tolerance than the run, the second still fewer. How the differences fall from the second
//! to the first tells the order, of which no more than second is believed, and less where it is not seen. Where periods are sampled, the first
//! companion also sees what wears in a cycle of eight times as many substeps, in every state that it shows.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::parts::{Parts, resolution};
use crate::contact::InitialContact;
use crate::contact::closed_form::LimitingShape;
use crate::data::{Snapshot, same_cycles};
use crate::error::Result;
use crate::laws::loading::{Mode, TangentialControl};
use crate::scene::{Numerics, Scene, Stepper};
use crate::solver::model::{Model, MovingStick, OperatorStore, Schedule};
use crate::solver::simulation::{End, Flow, Observer, Outcome, Simulation};

/// Springs of a run over those of its companion, and of that over those of the next; fewest of a companion.
const RATIO: f64 = 5.0 / 3.0;
const FEWEST: usize = 10;

/// Tolerance of a companion over that of the run, and the largest that any takes.
const TOLERANCE: f64 = 5.0;
const LARGEST_TOLERANCE: f64 = 0.1;

/// Orders that are believed: edges that move outwards and kinks of wear are of second order at best, edges that may move inwards of first, and
/// below the last number nothing is known.
const ORDER: f64 = 2.0;
const ORDER_INWARDS: f64 = 1.0;
const LEAST_ORDER: f64 = 0.5;

/// Substeps of a period beside which those of a run are judged, over these. Halves would tell little: as more substeps come next to a reversal, the
/// error may stand still and then fall at once.
const FINER: usize = 8;

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
    springs: usize,
    sights: Vec<Sight>,
    /// Whether its last sight is of the end of wear, whenever that came.
    spent: bool,
    /// What substeps leave out of volume, m³, and depth, m, and of the limit's volume, relative; none where periods are not sampled.
    unsampled: Option<Unsampled>,
}

/// Coarser runs of a scene.
#[derive(Debug)]
pub(super) struct Ladder {
    springs: usize,
    /// The largest order believed.
    order: f64,
    /// Every which of the radii of the run is looked at.
    every: usize,
    /// Those radii over the contact radius, where the edge of stick moves.
    radii: Option<Vec<f64>>,
    /// Volume and depth of the limit, where there is one.
    limit: Option<[f64; 2]>,
    /// What the discretisation leaves out in any case.
    left_out: f64,
    first: Option<Companion>,
    second: Option<Companion>,
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
        let springs = |steps: i32| ((model.springs() as f64 / RATIO.powi(steps)).ceil() as usize).max(FEWEST);
        let coarser = |steps: i32| {
            let tolerance = (simulation.tolerance() * TOLERANCE.powi(steps)).min(LARGEST_TOLERANCE);
            let numerics = Numerics { tolerance: Some(tolerance), ..*numerics };
            let parts = Parts::on_any(scene, &numerics, Some(springs(steps)), store).ok()?;
            let ends_by_rate = matches!(parts.plan.end, End::Rate(_));
            let samples = steps == 1 && scene.conditions().mode != Mode::Tangential;
            let unsampled =
                if samples { Some(Unsampled::new(scene, &numerics, &parts.model)?) } else { None };
            let model = parts.model.shown_at(offsets.clone());
            let mut coarse = Simulation::new(model, parts.stepper, parts.tolerance, parts.plan).ok()?;
            let mut seen =
                Seen { sights: vec![], unsampled, stop: Arc::clone(stop), stepper: numerics.stepper };
            let outcome = coarse.run(&mut [&mut seen]).ok()?;
            (outcome != Outcome::Interrupted).then(|| Companion {
                springs: coarse.model().springs(),
                sights: seen.sights,
                spent: ends_by_rate && outcome != Outcome::Unending,
                unsampled: seen.unsampled,
            })
        };
        let first = coarser(1);
        let second = first.is_some().then(|| coarser(2)).flatten();
        let radius = model.contact().contact_radius();
        let shown = model.radii().into_iter().step_by(every);
        let radii = model.moving().map(|_| shown.map(|r| r / radius).collect());
        let held = scene.conditions().tangential_control != TangentialControl::Displacement;
        let inwards = held || model.slides() || model.moving().is_some_and(MovingStick::recedes);
        let unseen = model.unseen_depth().unwrap_or(0.0);
        Self {
            springs: model.springs(),
            order: if inwards { ORDER_INWARDS } else { ORDER },
            every,
            radii,
            limit: limited.then(|| [model.limit_volume(), model.depth_scale()]),
            left_out: model.core_uncertainty().max(unseen),
            first,
            second,
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
        let nearest = gap(&sights, &first.sights, spent && first.spent, |a, b| self.apart(a, b, scale))?;
        let ratio = self.springs as f64 / first.springs as f64;
        let farther = self.second.as_ref().and_then(|second| {
            let gap = gap(&first.sights, &second.sights, first.spent && second.spent, |a, b| {
                self.apart(a, b, scale)
            })?;
            Some((gap, first.springs as f64 / second.springs as f64))
        });
        let (order, difference) = match farther {
            Some((gap, step)) => {
                let seen = (gap / nearest).ln() / step.ln();
                let grows = if seen > 0.0 { nearest } else { nearest.max(gap) };
                (seen.clamp(LEAST_ORDER, self.order), grows)
            }
            None => (LEAST_ORDER, nearest),
        };
        let springs = difference / (ratio.powf(order) - 1.0);
        let substeps = first.unsampled.as_ref().map_or(0.0, |it| it.error(scale));
        let finite = |value: f64| if value.is_finite() { value } else { UNKNOWN };
        Some(Shares {
            springs: finite(springs),
            order,
            substeps: finite(substeps),
            left_out: finite(self.left_out),
        })
    }

    /// The larger of the differences of volume and profile, relative.
    ///
    /// Where the edge of stick moves, the profile is steep at places that are known to the error of that edge only: there it is the distance of
    /// the curves, of depth over the largest or of radius over that of the contact, whichever is larger.
    fn apart(&self, one: &Sight, other: &Sight, [volume, depth]: [f64; 2]) -> f64 {
        let of_volume = (one.volume - other.volume).abs() / volume;
        let by_depth = |i: usize| (one.depth[i] - other.depth[i]).abs() / depth;
        let of_profile = (0..one.depth.len().min(other.depth.len())).map(|i| match &self.radii {
            None => by_depth(i),
            Some(radii) => {
                let to = |j: usize| [radii[j] - radii[i], (other.depth[j] - one.depth[i]) / depth];
                let mut least = by_depth(i);
                // Segments farther away than what was found are none the nearest.
                let left = (0..i).rev().take_while(|j| radii[i] - radii[j + 1] < least);
                least = left.map(|j| nearest(to(j), to(j + 1))).fold(least, f64::min);
                let right = (i + 1..radii.len()).take_while(|j| radii[j - 1] - radii[i] < least);
                right.map(|j| nearest(to(j - 1), to(j))).fold(least, f64::min)
            }
        });
        of_profile.fold(of_volume, larger)
    }
}

/// Distance of the origin from a straight line between two points, by the larger of the coordinates.
fn nearest(from: [f64; 2], to: [f64; 2]) -> f64 {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let size = |part: f64| {
        let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 };
        (from[0] + part * dx).abs().max((from[1] + part * dy).abs())
    };
    // Where a coordinate is zero, or both are as large: there the larger one has its least.
    let places = [
        0.0,
        1.0,
        -from[0] / dx,
        -from[1] / dy,
        (from[1] - from[0]) / (dx - dy),
        -(from[0] + from[1]) / (dx + dy),
    ];
    places.into_iter().map(size).fold(f64::INFINITY, f64::min)
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
}

/// The larger of two numbers; infinite where one is none.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::INFINITY } else { a.max(b) }
}

/// The largest difference of two runs at the times that both saw, the ends of wear included where both came to them.
fn gap(one: &[Sight], other: &[Sight], spent: bool, apart: impl Fn(&Sight, &Sight) -> f64) -> Option<f64> {
    let worn = one.iter().filter(|it| it.cycles > 0.0);
    let common = worn.filter_map(|it| {
        let same = other.iter().find(|that| same_cycles(that.cycles, it.cycles))?;
        Some(apart(it, same))
    });
    let ends = one.last().zip(other.last()).filter(|_| spent).map(|(a, b)| apart(a, b));
    common.chain(ends).reduce(larger)
}

/// What the substeps of a period leave out: the integral over the cycles of what more of them would wear in the same states.
#[derive(Debug)]
struct Unsampled {
    finer: Schedule,
    /// Change of the limit's volume, relative.
    limit: f64,
    cycles: f64,
    /// Rates that are left out: of the volume, m³ per cycle, and of the depth at the springs, m per cycle.
    rates: Vec<f64>,
    /// What has been left out so far, as the rates, and the most of it at any time.
    sums: Vec<f64>,
    most: [f64; 2],
}

impl Unsampled {
    fn new(scene: &Scene, numerics: &Numerics, model: &Model) -> Option<Self> {
        let contact = scene.contact().ok()?;
        let points = model.schedule().loop_steps(1);
        let finer = Numerics { substeps: Some(FINER * points), ..*numerics };
        let finer = Schedule::new(&contact, scene.conditions(), resolution(scene, &finer)).ok()?;
        let volume = |contact: &InitialContact| {
            let limit = LimitingShape::from_contact(contact).ok().flatten()?;
            Some(limit.wear_volume())
        };
        let limit = if model.slides() {
            0.0
        } else {
            let reach = finer.reach(&contact).ok()?.contact;
            volume(&reach)
                .zip(volume(model.contact()))
                .map_or(0.0, |(fine, coarse)| (fine / coarse - 1.0).abs())
        };
        Some(Self { finer, limit, cycles: 0.0, rates: vec![], sums: vec![], most: [0.0; 2] })
    }

    /// Takes the state of a simulation into account.
    fn see(&mut self, simulation: &Simulation) {
        let (model, state, fields) = (simulation.model(), simulation.state(), simulation.fields());
        let drive = model.drive_in(state, self.finer.drive(state.cycles, state.cycles));
        let (fine, coarse) = (model.cycle(&drive, &state.compression, fields), simulation.cycle());
        let depths = fine.growth.iter().zip(&coarse.growth).zip(&fields.slip_depth);
        let depths = depths.map(|((fine, coarse), slip)| (fine - coarse) * slip);
        let rates: Vec<f64> = std::iter::once(fine.volume - coarse.volume).chain(depths).collect();
        let elapsed = state.cycles - self.cycles;
        self.cycles = state.cycles;
        if self.rates.is_empty() {
            self.sums = vec![0.0; rates.len()];
        } else {
            for (sum, (now, before)) in self.sums.iter_mut().zip(rates.iter().zip(&self.rates)) {
                *sum += 0.5 * elapsed * (now + before);
            }
        }
        self.rates = rates;
        let depth = self.sums[1..].iter().map(|it| it.abs()).fold(0.0, larger);
        self.most = [larger(self.most[0], self.sums[0].abs()), larger(self.most[1], depth)];
    }

    fn error(&self, [volume, depth]: [f64; 2]) -> f64 {
        larger(self.most[0] / volume, self.most[1] / depth).max(self.limit)
    }
}

/// What is seen at the outputs.
struct Seen {
    sights: Vec<Sight>,
    unsampled: Option<Unsampled>,
    stop: Arc<AtomicBool>,
    stepper: Stepper,
}

impl Observer for Seen {
    fn output(&mut self, simulation: &Simulation) -> Result<()> {
        self.sights.push(Sight::of(simulation));
        if let Some(unsampled) = &mut self.unsampled {
            unsampled.see(simulation);
        }
        Ok(())
    }

    fn step(&mut self, simulation: &Simulation) -> Result<Flow> {
        // Explicit steps are as many as cycles or stiffness ask for.
        let lost = self.stepper == Stepper::Implicit && simulation.progress().steps > MOST_STEPS;
        Ok(if lost || self.stop.load(Ordering::Relaxed) { Flow::Stop } else { Flow::Continue })
    }
}
