//! How far off a run is: what coarser companions of the same scene differ by.
//!
//! On a smooth mesh the order of convergence is known, and one companion tells the error. Elsewhere a second, still coarser one shows by how the
//! differences fall from the second to the first which order there is, of which no more than second is believed, and less where it is not seen.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::super::budget::{CAUTIOUS_ORDER, Falling, Shares, UNKNOWN, springs_before};
use super::super::parts::resolution;
use super::super::passes;
use super::companion::{Coarser, Companion, Dear, Lost, Worn};
use super::substeps::larger;
use crate::data::{Attempt, Snapshot, same_cycles};
use crate::numerics::curve::distance_from_curve;
use crate::numerics::grid::Clustering;
use crate::scene::{Numerics, Scene, Stepper};
use crate::solver::model::{Gross, Model, MovingStick, OperatorStore, Schedule};
use crate::solver::simulation::{End, Outcome, Simulation};

/// Springs of a run over those of its companion, and of that over those of the next; fewest of a companion.
const RATIO: f64 = 5.0 / 3.0;
const FEWEST: usize = 10;

/// Tolerance of a companion over that of the run, the same of the accuracy that its mesh has to carry on a smooth one, and the largest of both.
const COARSER: f64 = 5.0;
const COARSEST: f64 = 0.1;

/// Error of a run over its difference `δ` from its companion, `e = C δ/(ρ^p - 1)` with `ρ` the ratio of the springs: `C` and `p` in the middle of the
/// random scenes, on smooth meshes, on those where the error next to the edge of stick is the larger one, and on meshes of cubics.
const ERROR_PER_DIFFERENCE: [[f64; 2]; 3] = [[1.3, 4.0], [1.0, 3.0], [0.4, 3.0]];

/// Part of the tolerance of the time stepping that is the least error told: as much is of steps, and companion and run may share it.
const LEAST_OF_TIME: f64 = 0.15;

/// Springs by hand below which the companion is a finer one, and the order with which the difference from it is taken to fall.
const FEW_BY_HAND: usize = 60;
const ORDER_OF_FINER: f64 = 2.0;

/// Largest order believed of more springs by hand, which no accuracy bounds from below: profiles next to edges and kinks were up to eight times as far off as second order
/// would have it.
const ORDER_BY_HAND: f64 = 1.0;

/// Radii at which companions are looked at for each that is compared, where profiles are compared as curves: next to an edge a curve is steep between two radii of the run.
const BETWEEN: usize = 4;

/// Least ratio of the springs that tells anything: a mesh may have to be raised to carry the companion.
const LEAST_RATIO: f64 = 1.2;

/// Orders that are believed: edges that move outwards and kinks of wear are of second order at best, edges of stick that recede of third, and below the
/// last number nothing is known.
const ORDER: f64 = 2.0;
const ORDER_RECEDING: f64 = 3.0;
const LEAST_ORDER: f64 = 0.5;

/// Least order that was seen in gross slip, with a mesh over the whole contact.
const ORDER_IN_GROSS_SLIP: f64 = 3.0;

/// Error of the worn volume over the part of the stick radius that is lost again: 1.3 was seen.
const SHARE_OF_STICK: f64 = 2.0;

/// Steps after which a companion is lost, with a known order and without: at the round-off of a coarse mesh a rate of nearly nothing may never be
/// reached.
const MOST_STEPS: [f64; 2] = [2000.0, 4000.0];

/// Coarser runs of a scene.
#[derive(Debug)]
pub(in crate::run) struct Companions {
    /// Whether the order of convergence is known.
    smooth: bool,
    /// The largest order believed, where it is not known.
    order: f64,
    /// Whether the contact is in gross slip in every cycle, where the order is known and one companion serves.
    slides: bool,
    /// Whether the companion is a finer one.
    finer: bool,
    /// One in so many radii of the run is compared: about as many as there are springs, between which the error varies no faster.
    every: usize,
    /// Those radii over the contact radius and others between them, where the edge of stick moves, or is where a sampled path says.
    radii: Option<Vec<f64>>,
    /// Volume and depth of the limit, where there is one.
    limit: Option<[f64; 2]>,
    /// What the discretisation leaves out in any case.
    left_out: f64,
    /// What averaging over passes leaves out of the worn volume, m³, and of the depth, m.
    of_passes: [f64; 2],
    first: Option<Companion>,
    second: Option<Companion>,
}

/// How the companions of a run are made.
#[derive(Debug)]
pub(in crate::run) struct Coarsening {
    springs: usize,
    tolerance: f64,
    smooth: bool,
    /// Whether one companion serves.
    alone: bool,
    /// Whether that is a finer one.
    finer: bool,
    /// Those of the run.
    numerics: Numerics,
    /// Springs over the slip annulus where springs stick again after gross slip, so that it is those that are to be fewer.
    to_stick_again: Option<usize>,
    /// Most of a companion where the program chose the springs.
    most_work: f64,
    /// `r² - c²`, m², of the radii compared, and of so many in all up to the next of them.
    offsets: Vec<f64>,
    between: usize,
    /// Substeps of a period where they are of a known order, so that coarser companions show what they leave out.
    substeps: Option<usize>,
    /// That of the run, where companions have the same.
    schedule: Option<Schedule>,
    /// Whether its steps see the mean cycle of a pass.
    averages: bool,
}

impl Coarsening {
    /// That of a run.
    ///
    /// # Arguments
    /// * `attempt` -- which of the attempts at it
    pub(in crate::run) fn new(scene: &Scene, simulation: &Simulation, attempt: &Attempt) -> Self {
        let ((model, tolerance), numerics) = (simulation.first(), attempt.numerics(scene));
        let to_stick_again = simulation.springs_to_stick_again();
        let smooth = is_smooth(scene, model);
        let substeps = resolution(scene, &numerics).substeps.filter(|_| model.schedule().takes_steps());
        let finer = compares_with_finer(scene, model);
        Self {
            springs: model.springs(),
            tolerance,
            smooth,
            alone: smooth || finer || always_slides(model) && to_stick_again.is_none(),
            finer,
            to_stick_again,
            most_work: attempt.most_work_of_companion(),
            numerics,
            offsets: looked_at(model.offsets(), model),
            between: density(model),
            schedule: substeps.is_none().then(|| model.under_all_blocks().1.clone()),
            substeps,
            averages: model.schedule().averages_from() == 0.0,
        }
    }

    /// Runs the companions.
    pub(in crate::run) fn run(&self, scene: &Scene, store: &OperatorStore, stop: &Arc<AtomicBool>) -> Found {
        let numerics = &self.numerics;
        // Where springs are given by hand, companions take as long as they take.
        let [most_work, most_steps] = match numerics.springs.is_some() {
            true => [f64::INFINITY, f64::INFINITY],
            false => [self.most_work, MOST_STEPS[usize::from(!self.smooth)]],
        };
        let coarser = |steps: i32| {
            let steps = if self.finer { -steps } else { steps };
            let coarser = |value: f64| (value * COARSER.powi(steps)).min(COARSEST);
            let fewer = |count: usize| (count as f64 / RATIO.powi(steps)).ceil() as usize;
            Companion::run(&Coarser {
                scene,
                numerics: Numerics {
                    accuracy: if self.smooth { coarser(numerics.accuracy) } else { numerics.accuracy },
                    springs: None,
                    tolerance: Some(coarser(self.tolerance)),
                    substeps: self.substeps.map(fewer).or(numerics.substeps),
                    ..*numerics
                },
                springs: match self.to_stick_again {
                    Some(springs) => springs_before(fewer(springs)),
                    None => fewer(self.springs),
                }
                .max(FEWEST),
                offsets: &self.offsets,
                between: self.between,
                schedule: self.schedule.as_ref(),
                averages: self.averages,
                samples: steps.abs() == 1 && self.substeps.is_none(),
                most_work,
                most_steps,
                store,
                stop,
            })
        };
        let first = coarser(1);
        let second = if first.is_ok() && !self.alone { coarser(2).ok() } else { None };
        Found { first, second }
    }
}

/// What companions came to.
#[derive(Debug)]
pub(in crate::run) struct Found {
    first: std::result::Result<Companion, Lost>,
    second: Option<Companion>,
}

impl Found {
    /// Where the run would take too long, how far its companion came that did.
    pub(in crate::run) fn dear(&self) -> Option<Dear> {
        match self.first {
            Err(Lost::Dear(dear)) => Some(dear),
            _ => None,
        }
    }
}

/// Whether the companion of a run is a finer one: of springs given by hand that are so few that the differences of still fewer tell nothing, and that more take no
/// time.
fn compares_with_finer(scene: &Scene, model: &Model) -> bool {
    scene.numerics().springs.is_some() && model.gross().is_none() && model.springs() < FEW_BY_HAND
}

/// Whether the order of convergence is known.
fn is_smooth(scene: &Scene, model: &Model) -> bool {
    scene.numerics().stepper == Stepper::Implicit && model.wears_smoothly()
}

/// Whether no spring sticks in any cycle, as the unworn contact tells, and wear is local: a rim that debris spares may come to stick, and debris to be narrower than springs are apart.
fn always_slides(model: &Model) -> bool {
    let spreads = model.schedule().conditions().wear.spreading().is_some();
    !spreads && model.gross().is_some_and(|gross| !gross.sticks())
}

/// Whether profiles are compared as curves: they are steep at places that are known to the error of an edge only, or, in other modes than plain oscillation, next to the edge of stick, where slip wears
/// by less than its first power and springs are close together.
fn are_curves(model: &Model) -> bool {
    let schedule = model.schedule();
    let sampled = schedule.lifts() && !schedule.takes_steps();
    let moves = model.moving().is_some() && !model.bears_both_forces();
    let conditions = schedule.conditions();
    let is_steep = !conditions.mode.is_tangential() && conditions.wear.slip_exponent() < 1.0;
    moves || sampled || is_steep || model.has_gross_slip() || schedule.changes_between_blocks()
}

/// Radii at which companions are looked at for each that is compared.
fn density(model: &Model) -> usize {
    if are_curves(model) { BETWEEN } else { 1 }
}

/// Of values at the radii of a run those at the radii compared, and evenly between them where companions are looked at besides.
fn looked_at(values: Vec<f64>, model: &Model) -> Vec<f64> {
    let compared: Vec<f64> = values.into_iter().step_by(every(model)).collect();
    let count = density(model);
    let to_next = |pair: &[f64]| -> Vec<f64> {
        let [from, to] = [pair[0], pair[1]];
        (0..count).map(|i| from + (to - from) * i as f64 / count as f64).collect()
    };
    compared.windows(2).flat_map(to_next).chain(compared.last().copied()).collect()
}

/// One in so many radii of a run is compared.
fn every(model: &Model) -> usize {
    (model.offsets().len() / model.springs()).max(1)
}

impl Companions {
    /// Those of a run, before they are run.
    ///
    /// # Arguments
    /// * `limited` -- whether the scene has a limit in closed form
    pub(in crate::run) fn new(scene: &Scene, simulation: &Simulation, limited: bool) -> Self {
        let (model, _) = simulation.first();
        let (smooth, every) = (is_smooth(scene, model), every(model));
        let radius = model.contact().contact_radius();
        let radii = are_curves(model).then(|| {
            let squared = model.radii().into_iter().map(|r| (r / radius).powi(2)).collect();
            looked_at(squared, model).into_iter().map(f64::sqrt).collect()
        });
        let recedes = model.moving().is_some_and(MovingStick::recedes);
        let order = match recedes {
            _ if scene.numerics().springs.is_some() => ORDER_BY_HAND,
            true => ORDER_RECEDING,
            false => ORDER,
        };
        let unseen = || model.unseen_depth().unwrap_or(0.0);
        // Companions of a run with a coarse tolerance by hand step no more coarsely than it does.
        let numerics = scene.numerics();
        let by_hand = numerics.tolerance.filter(|_| numerics.stepper != Stepper::EveryCycle);
        let of_time = LEAST_OF_TIME * by_hand.unwrap_or(0.0);
        Self {
            smooth,
            order,
            slides: always_slides(model),
            finer: compares_with_finer(scene, model),
            every,
            radii,
            limit: (limited || smooth)
                .then(|| [model.limit_volume(), model.depth_scale()])
                .filter(|limit| limit.iter().all(|it| *it > 0.0)),
            left_out: if smooth { 0.0 } else { unseen().max(of_time) },
            of_passes: passes::left_out(model),
            first: None,
            second: None,
        }
    }

    /// Takes what they came to.
    pub(in crate::run) fn take(&mut self, found: Found) {
        (self.first, self.second) = (found.first.ok(), found.second);
    }

    /// One in so many radii of the run is compared.
    pub(in crate::run) fn every(&self) -> usize {
        self.every
    }

    /// Whether the order of convergence is known.
    pub(in crate::run) fn is_smooth(&self) -> bool {
        self.smooth
    }

    /// Whether the first companion came to no end.
    pub(in crate::run) fn is_lost(&self) -> bool {
        self.first.is_none()
    }

    /// The worn volume to which errors are relative, m³: the limit's, or the largest of the run where there is none.
    pub(in crate::run) fn volume_scale(&self, snapshots: &[Snapshot]) -> f64 {
        let largest = || snapshots.iter().map(|it| it.wear_volume).fold(0.0, f64::max);
        self.limit.map_or_else(largest, |[volume, _]| volume)
    }

    /// Estimated error at the snapshots of the run: of the worn volume or of the profile at any radius, whichever is larger, relative to the
    /// limit's, or to the largest of the run where there is none. None before the first snapshot that a companion saw.
    pub(in crate::run) fn shares(&self, simulation: &Simulation, snapshots: &[Snapshot]) -> Option<Shares> {
        let worn: Vec<Worn> = snapshots.iter().map(|it| Worn::shown(it, self.every)).collect();
        let deepest = || worn.iter().map(Worn::deepest).fold(0.0, f64::max);
        let mut scale = [self.volume_scale(snapshots), self.limit.map_or_else(deepest, |[_, depth]| depth)];
        if scale[0] > 0.0 && scale[1] == 0.0 {
            // The radii shown lie beyond a contact that wear has hardly let grow.
            scale[1] = f64::INFINITY;
        }
        if !(self.smooth || scale[0] > 0.0) {
            // A coarse mesh may make less than nothing of a little wear.
            let wears = simulation.state().volume_by_rate > 0.0;
            return wears.then(|| Shares { springs: UNKNOWN, ..Shares::default() });
        }
        // Nothing wears less than not at all.
        let below =
            worn.iter().flat_map(|it| &it.depth).fold(0.0, |most: f64, depth| most.max(-depth)) / scale[1];
        let [of_volume, of_depth] = self.of_passes;
        let of_passes = (of_volume / scale[0]).max(of_depth / scale[1]) + passes::left_out_later(simulation);
        let left_out = self.left_out.max(below) + of_passes;
        let unknown = Shares { springs: UNKNOWN, left_out, ..Shares::default() };
        let Some(first) = &self.first else { return Some(unknown) };
        let ratio = simulation.springs() as f64 / first.springs as f64;
        let spent = !self.smooth
            && matches!(simulation.plan().end, End::Rate(_))
            && matches!(simulation.outcome(), Some(Outcome::Rate | Outcome::WornOut));
        let nearest = gap(&worn, &first.seen, spent && first.spent, |a, b| self.apart(a, b, scale))?;
        if self.finer {
            let springs = nearest / (1.0 - ratio.powf(ORDER_OF_FINER));
            let springs = if ratio < 1.0 && springs.is_finite() { springs } else { UNKNOWN };
            return Some(Shares { springs, order: ORDER_OF_FINER, left_out, ..Shares::default() });
        }
        let finite = |value: f64| if value.is_finite() { value } else { UNKNOWN };
        if self.smooth {
            return by_known_order(simulation, ratio, nearest);
        }
        let substeps = finite(first.unsampled.as_ref().map_or(0.0, |it| it.error(scale)));
        // Where a mesh has to be raised to as many springs as the run has, or more, nothing is known.
        let tells = ratio >= LEAST_RATIO;
        if simulation.sticks_after_gross_slip() {
            // What the polynomials over the whole contact make of the kink at the edge of stick falls with no order, and two runs may share it: the companions
            // are off by more than the run.
            let farther = self.farther(first, scale).map_or(nearest, |(gap, _)| gap.max(nearest));
            let springs = if tells { finite(farther) } else { UNKNOWN };
            return Some(Shares { springs, order: ORDER, substeps, left_out: finite(left_out) });
        }
        if self.slides {
            let shares = in_gross_slip(simulation, snapshots, nearest, ratio, scale);
            return Some(Shares { substeps, left_out: shares.left_out + of_passes, ..shares });
        }
        let (order, difference) = self.observed_order(first, nearest, scale);
        Some(Shares {
            springs: if tells { finite(difference / (ratio.powf(order) - 1.0)) } else { UNKNOWN },
            order,
            substeps,
            left_out: finite(left_out),
        })
    }

    /// The order that two companions show, and the difference that falls with it.
    fn observed_order(&self, first: &Companion, nearest: f64, scale: [f64; 2]) -> (f64, f64) {
        let Some((gap, step)) = self.farther(first, scale) else { return (LEAST_ORDER, nearest) };
        let observed = (gap / nearest).ln() / step.ln();
        let grows = if observed > 0.0 { nearest } else { nearest.max(gap) };
        (observed.clamp(LEAST_ORDER, self.order), grows)
    }

    /// By what the second companion differs from the first, and the ratio of their springs.
    fn farther(&self, first: &Companion, scale: [f64; 2]) -> Option<(f64, f64)> {
        let second = self.second.as_ref()?;
        let spent = first.spent && second.spent;
        let gap = gap(&first.seen, &second.seen, spent, |a, b| self.apart(a, b, scale))?;
        Some((gap, first.springs as f64 / second.springs as f64))
    }

    /// The larger of the differences of volume and profile, relative.
    ///
    /// Where the edge of stick moves or follows from a sampled path, the profile is steep at places that are known to the error of that edge only: there it is the distance of
    /// the curves, of depth over the largest or of radius over that of the contact, whichever is larger.
    fn apart(&self, one: &Worn, other: &Worn, [volume, depth]: [f64; 2]) -> f64 {
        let of_volume = (one.volume - other.volume).abs() / volume;
        let of_profile: Vec<f64> = match &self.radii {
            None => one.nodes().zip(other.nodes()).map(|(one, other)| (one - other).abs() / depth).collect(),
            Some(radii) => {
                let curve: Vec<f64> = other.depth.iter().map(|it| it / depth).collect();
                let places = (0..curve.len()).step_by(other.every);
                let from = |(i, one)| distance_from_curve(radii, &curve, [radii[i], one / depth], i);
                places.zip(one.nodes()).map(from).collect()
            }
        };
        of_profile.into_iter().fold(of_volume, larger)
    }
}

/// The error on a smooth mesh, for which a ratio of springs and a difference from the companion were compared with finer runs.
fn by_known_order(simulation: &Simulation, ratio: f64, difference: f64) -> Option<Shares> {
    let model = simulation.model();
    if ratio < LEAST_RATIO {
        return None;
    }
    let [smooth, next_to_stick, cubic] = ERROR_PER_DIFFERENCE;
    let errors = Falling::of(model.contact()).map(|error| error.at(model.springs() as f64));
    let [factor, order] = match model.operators().mesh().clustering() {
        Clustering::Smooth if errors[1] > errors[0] => next_to_stick,
        Clustering::Smooth => smooth,
        _ => cubic,
    };
    let least = LEAST_OF_TIME * simulation.tolerance();
    let springs = (factor * difference / (ratio.powf(order) - 1.0)).max(least);
    Some(Shares { springs, order: CAUTIOUS_ORDER, ..Shares::default() })
}

/// The error in gross slip: by the companion, or what energy and profile disagree by.
///
/// Where springs came to stick again next to the axis, ever more springs do not help: the kink there is not resolved. That shows in a stick radius that
/// falls, which under a held force it never does while every cycle is the same.
fn in_gross_slip(
    simulation: &Simulation,
    snapshots: &[Snapshot],
    difference: f64,
    ratio: f64,
    scale: [f64; 2],
) -> Shares {
    let (model, state) = (simulation.model(), simulation.state());
    let balance = (model.wear_volume(simulation.fields()) - state.volume_by_rate).abs() / scale[0];
    // A companion on about as many springs tells nothing.
    let tells = ratio >= LEAST_RATIO;
    let error = (difference / (ratio.powf(ORDER_IN_GROSS_SLIP) - 1.0)).max(balance);
    let error = if tells && error.is_finite() { error } else { UNKNOWN };
    let shares = Shares { order: ORDER_IN_GROSS_SLIP, ..Shares::default() };
    let most = snapshots.iter().map(|it| it.stick_radius).fold(0.0, f64::max);
    let holds_force = model.gross().is_some_and(Gross::holds_force);
    if most > 0.0 && holds_force && model.schedule().keeps_slipping_alike() {
        let lost = SHARE_OF_STICK * (1.0 - simulation.cycle().stick_radius / most).max(0.0);
        return Shares { left_out: (difference.max(balance) + lost).min(UNKNOWN), ..shares };
    }
    Shares { springs: error, ..shares }
}

/// The largest difference of two runs at the times that both saw, the ends of wear included where both came to them.
fn gap(one: &[Worn], other: &[Worn], spent: bool, apart: impl Fn(&Worn, &Worn) -> f64) -> Option<f64> {
    let worn = one.iter().filter(|it| it.cycles > 0.0);
    let common = worn.filter_map(|it| {
        let same = other.iter().find(|that| same_cycles(that.cycles, it.cycles))?;
        Some(apart(it, same))
    });
    let ends = one.last().zip(other.last()).filter(|_| spent).map(|(a, b)| apart(a, b));
    common.chain(ends).reduce(larger)
}
