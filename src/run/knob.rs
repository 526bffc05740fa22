//! What `numerics.accuracy` chooses, and how the error of what comes of it is known.
//!
//! Springs and tolerance follow from the measured errors of random scenes (docs/accuracy.md). A pilot run on fewer springs, with larger steps,
//! then sees the same snapshots: what the two differ by tells the error of the finer one, since that of the pilot is known to be so many times
//! as large. Where it is more than was asked for, the run is made anew on more springs.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::ladder::{Shares, UNKNOWN};
use super::mesh::MOST_RAISED;
use super::parts::Parts;
use crate::contact::InitialContact;
use crate::contact::stick_slip::Regime;
use crate::data::{Snapshot, same_cycles};
use crate::error::Result;
use crate::numerics::grid::Clustering;
use crate::scene::{Numerics, Scene, Stepper};
use crate::solver::model::{Model, OperatorStore, Schedule, State};
use crate::solver::simulation::{Flow, Observer, Outcome, Simulation};

/// Error of the profile on 24 springs of a smooth mesh, and the power with which it falls, fitted to 118 random scenes on 16 to 54 springs:
/// `ln e = A + B k + C ln n + D ln(a0/c) + E ln n ln(a0/c)` with `k > 0` or zero. Nine of ten lie within a factor of 2.8, 98 of 100 below 7.7.
const ERROR: [f64; 5] = [-10.0, 2.9, 0.30, 0.36, 0.30];
const ORDER: [f64; 2] = [4.5, 1.3];
const FITTED_SPRINGS: f64 = 24.0;

/// Next to the edge of stick the profile is of third order only, `e = A e^(B k) N⁻³` for gradings from the first number on, below which that
/// is not seen: `A` and `B` through the errors at k = 0.5 and 0.9 on 120 springs, with a little to spare.
const THIRD_ORDER_FROM: f64 = 0.4;
const THIRD_ORDER: [f64; 2] = [0.35, 4.5];

/// Part of the accuracy asked for that the fitted error may take up, so that scenes off the fit keep to it too.
const MARGIN: f64 = 0.35;

/// Part of the accuracy asked for that the error of the time stepping may take up.
const OF_TIME: f64 = 0.3;

/// Springs added, as a part, for every unit of `n ln(a0/c)` beyond the first number, up to the second: with a small stick zone the fit's order sets
/// in late.
const ADDED: f64 = 0.1;
const SMALLNESS: [f64; 2] = [2.0, 5.0];

/// Fewest springs that the fit gives; on fewer than 18 the errors of half of the scenes are off the fit.
const FEWEST: f64 = 14.0;
const FEWEST_BELOW_A_HUNDREDTH: f64 = 18.0;

/// Springs of the pilot over those of the run, at least [`FEWEST_OF_PILOT`], and its tolerance over that of the run.
const PILOT_SPRINGS: f64 = 0.6;
const PILOT_TOLERANCE: f64 = 5.0;
const FEWEST_OF_PILOT: usize = 10;

/// Error of a run over its difference `δ` from its pilot, `e = C δ/(ρ^p - 1)` with `ρ` the ratio of the springs: `C` and `p` in the middle of the
/// random scenes, on smooth meshes, on those where the error next to the edge of stick is the larger one, and on meshes of cubics.
const ERROR_PER_DIFFERENCE: [[f64; 2]; 3] = [[1.3, 4.0], [1.0, 3.0], [0.4, 3.0]];

/// Part of the tolerance of the time stepping below which an error is not told: as much is of steps, and pilot and run may share it.
const LEAST_OF_TIME: f64 = 0.15;

/// Least ratio of the springs that tells anything: a mesh may have to be raised to carry the pilot.
const LEAST_RATIO: f64 = 1.2;

/// How often a run is made anew, and by which factors its springs are raised.
pub(super) const REFINEMENTS: usize = 3;
const RAISES: [f64; 2] = [1.15, 2.0];

/// Part of the accuracy beyond which an estimate makes a run anew: of twenty errors one is 1.7 times its estimate.
pub(super) const SURE: f64 = 0.6;

/// Most springs of a run that is made anew: beyond, that takes longer than who asked may wait for without having been asked.
const MOST_REFINED: usize = 400;

/// Order of the error in the springs with which the factor is found, low, and the part of the accuracy that is aimed at.
const CAUTIOUS_ORDER: f64 = 4.0;
const AIM: f64 = 0.5;

/// Steps after which a pilot is lost: at the round-off of a coarse mesh a rate of nearly nothing may never be reached.
const MOST_STEPS: u64 = 2000;

/// Whether the program chose the springs of a run on a model, and a pilot tells its error.
pub(super) fn serves(numerics: &Numerics, model: &Model) -> bool {
    numerics.springs.is_none() && numerics.stepper == Stepper::Implicit && model.wears_smoothly()
}

/// `n ln(a0/c)`: the logarithm of the profile's height at the first contact edge over that at the edge of stick.
pub(super) fn smallness(contact: &InitialContact) -> f64 {
    exponent(contact) * contact.stick_logarithm().unwrap_or(0.0)
}

/// `n` of a power law; other profiles begin as a paraboloid.
fn exponent(contact: &InitialContact) -> f64 {
    contact.equivalent_profile().exponent().unwrap_or(2.0)
}

/// Springs that keep the error of volume and profile below `accuracy`.
pub(super) fn springs_for(
    clustering: Clustering,
    contact: &InitialContact,
    schedule: &Schedule,
    accuracy: f64,
) -> usize {
    if schedule.conditions().holds_normal_force && contact.regime() == Regime::PartialSlip {
        let [springs, at] = SPRINGS_UNDER_FORCE;
        return (springs * (at / accuracy).sqrt()).clamp(FEWEST_BELOW_A_HUNDREDTH, MOST_REFINED as f64).ceil()
            as usize;
    }
    if clustering != Clustering::Smooth {
        // The worn volume is of third order there (docs/numerics.md).
        return (120.0 * (1e-4 / accuracy).cbrt()).ceil() as usize;
    }
    let [wide, next_to_stick] = Falling::of(contact);
    let fewest = if accuracy < 1e-2 { FEWEST_BELOW_A_HUNDREDTH } else { FEWEST };
    let added = 1.0 + ADDED * (smallness(contact).clamp(SMALLNESS[0], SMALLNESS[1]) - SMALLNESS[0]);
    let wanted = MARGIN * accuracy;
    let springs = (added * wide.springs(wanted)).max(next_to_stick.springs(wanted));
    springs.clamp(fewest, MOST_RAISED as f64).ceil() as usize
}

/// An error that falls with a power of the springs.
struct Falling {
    /// On [`FITTED_SPRINGS`].
    error: f64,
    order: f64,
}

impl Falling {
    /// Errors of the profile on smooth meshes: over the annulus, and next to the edge of stick.
    fn of(contact: &InitialContact) -> [Self; 2] {
        let grading = contact.half_space().grading().max(0.0);
        let (exponent, stick) = (exponent(contact).ln(), contact.stick_logarithm().unwrap_or(0.0));
        let [a, b, c, d, e] = ERROR;
        let wide = (a + b * grading + c * exponent + d * stick + e * exponent * stick).exp();
        let [scale, growth] = THIRD_ORDER;
        let seen = if grading >= THIRD_ORDER_FROM { scale * (growth * grading).exp() } else { 0.0 };
        [
            Self { error: wide, order: ORDER[0] + ORDER[1] * grading },
            Self { error: seen / FITTED_SPRINGS.powi(3), order: 3.0 },
        ]
    }

    fn at(&self, springs: f64) -> f64 {
        self.error * (FITTED_SPRINGS / springs).powf(self.order)
    }

    fn springs(&self, error: f64) -> f64 {
        FITTED_SPRINGS * (self.error / error).powf(self.order.recip())
    }
}

/// Tolerance of the time stepping, whose error is about as large, that leaves most of `accuracy` to the springs.
pub(super) fn tolerance_for(accuracy: f64) -> f64 {
    OF_TIME * accuracy
}

/// Springs with which a held normal force is followed to an accuracy: the edge of stick creeps over worn ground, to second order
/// (docs/accuracy.md).
const SPRINGS_UNDER_FORCE: [f64; 2] = [200.0, 1e-4];

/// Substeps of a period that is sampled: the fewest and the most, the accuracy up to which the fewest serve, and the power with which they
/// grow beyond: four times as many for a tenth of the error.
const SUBSTEPS: [f64; 2] = [192.0, 768.0];
const SAMPLED_AT: f64 = 3.2e-4;
const ORDER_OF_SUBSTEPS: f64 = 0.602;

/// Substeps of a period that is sampled, a multiple of four.
pub(super) fn substeps_for(accuracy: f64) -> usize {
    let [fewest, most] = SUBSTEPS;
    let wanted = fewest * (SAMPLED_AT / accuracy).powf(ORDER_OF_SUBSTEPS);
    4 * (0.25 * wanted.clamp(fewest, most)).round() as usize
}

/// Springs with which a run is made anew that was off by `error`, or found no end; none beyond [`MOST_REFINED`].
pub(super) fn refined(springs: usize, error: Option<f64>, accuracy: f64) -> Option<usize> {
    let factor =
        error.map_or(RAISES[1].sqrt(), |error| (error / (AIM * accuracy)).powf(CAUTIOUS_ORDER.recip()));
    let refined = (springs as f64 * factor.clamp(RAISES[0], RAISES[1])).ceil() as usize;
    (refined <= MOST_REFINED).then_some(refined)
}

/// As [`refined`] on any mesh, where that keeps to the accuracy within the springs that a run may take.
pub(super) fn worth_refining(springs: usize, shares: Shares, accuracy: f64) -> Option<usize> {
    let rest = shares.substeps + shares.left_out;
    let aim = AIM * accuracy - rest;
    if shares.error() <= SURE * accuracy || aim <= 0.0 || shares.springs >= UNKNOWN {
        return None;
    }
    let factor = (shares.springs / aim).powf(shares.order.recip()).max(RAISES[0]);
    let refined = (springs as f64 * factor).ceil();
    (refined <= MOST_REFINED as f64).then_some(refined as usize)
}

/// A coarser run of the same scene, for what it differs by.
#[derive(Debug)]
pub(super) struct Pilot {
    model: Model,
    seen: Vec<State>,
}

impl Pilot {
    /// Runs the pilot of a run on so many springs with such a tolerance; none if it comes to no end.
    pub(super) fn run(
        scene: &Scene,
        store: &OperatorStore,
        springs: usize,
        tolerance: f64,
        stop: &Arc<AtomicBool>,
    ) -> Option<Self> {
        let springs = ((PILOT_SPRINGS * springs as f64).ceil() as usize).max(FEWEST_OF_PILOT);
        let numerics = Numerics {
            accuracy: (PILOT_TOLERANCE * scene.numerics().accuracy).min(0.1),
            tolerance: Some((PILOT_TOLERANCE * tolerance).min(0.1)),
            ..*scene.numerics()
        };
        let parts = Parts::new(scene, &numerics, Some(springs), store).ok()?;
        let mut simulation = Simulation::new(parts.model, parts.stepper, parts.tolerance, parts.plan).ok()?;
        let mut seen = Seen { states: vec![], stop: Arc::clone(stop) };
        let outcome = simulation.run(&mut [&mut seen]).ok()?;
        (outcome != Outcome::Interrupted).then(|| Self { model: simulation.into_model(), seen: seen.states })
    }

    /// Estimated error of a run at its snapshots: of the worn volume, relative to the limit's, or of the profile at any of its radii, relative
    /// to the limit's largest depth, whichever is larger. None where no snapshot is of a time that the pilot has seen.
    pub(super) fn error_of(&self, simulation: &Simulation, snapshots: &[Snapshot]) -> Option<f64> {
        let model = simulation.model();
        let ratio = model.springs() as f64 / self.model.springs() as f64;
        if ratio < LEAST_RATIO {
            return None;
        }
        let offsets = model.offsets();
        // About as many radii as springs: between those the error varies no faster.
        let every = (offsets.len() / model.springs()).max(1);
        let difference = |snapshot: &Snapshot| {
            let state = self.seen.iter().find(|state| same_cycles(state.cycles, snapshot.cycles))?;
            let fields = self.model.fields(state);
            let volume =
                (self.model.wear_volume(&fields) - snapshot.wear_volume).abs() / model.limit_volume();
            let depths = offsets.iter().zip(&snapshot.wear_depth).step_by(every);
            let off = depths.map(|(offset, depth)| {
                (self.model.wear_depth_at(state, &fields, *offset) - depth).abs() / model.depth_scale()
            });
            Some(off.fold(volume, f64::max))
        };
        let worn = snapshots.iter().filter(|snapshot| snapshot.cycles > 0.0);
        let largest = worn.filter_map(difference).reduce(f64::max);
        let [smooth, next_to_stick, cubic] = ERROR_PER_DIFFERENCE;
        let errors = Falling::of(model.contact()).map(|error| error.at(model.springs() as f64));
        let [factor, order] = match model.operators().mesh().clustering() {
            Clustering::Smooth if errors[1] > errors[0] => next_to_stick,
            Clustering::Smooth => smooth,
            _ => cubic,
        };
        let least = LEAST_OF_TIME * simulation.tolerance();
        largest.map(|largest| (factor * largest / (ratio.powf(order) - 1.0)).max(least))
    }
}

/// The states at the outputs.
struct Seen {
    states: Vec<State>,
    stop: Arc<AtomicBool>,
}

impl Observer for Seen {
    fn output(&mut self, simulation: &Simulation) -> Result<()> {
        self.states.push(simulation.state().clone());
        Ok(())
    }

    fn step(&mut self, simulation: &Simulation) -> Result<Flow> {
        let lost = simulation.progress().steps > MOST_STEPS;
        Ok(if lost || self.stop.load(Ordering::Relaxed) { Flow::Stop } else { Flow::Continue })
    }
}
