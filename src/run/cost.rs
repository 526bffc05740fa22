//! What a run costs, before it begins: steps and time.

use std::time::Instant;

use super::method::Method;
use crate::error::{Error, Result};
use crate::laws::loading::TangentialControl;
use crate::scene::Stepper as Choice;
use crate::solver::model::{FEWEST_SPRINGS, Model, State};
use crate::solver::simulation::{End, Progress, Simulation};

/// Most steps of an explicit method, and most ends of blocks in a run: about a day.
const MOST_STEPS: f64 = 1e9;

/// Wall time of a run, s, above which a user is warned.
const LONG: f64 = 60.0;

/// Steps of an implicit run beside those to outputs and breaks, and its time with its companion over that without.
const FREE_STEPS: f64 = 30.0;
const WITH_COMPANION: f64 = 1.5;

/// Springs and steps below which a run on a smooth mesh takes a few seconds at most, so that no step is tried to know.
const FEW: usize = 200;
const FEW_STEPS: f64 = 1e3;

/// Dimensionless time for which a run that ends at a rate may last.
const SOME_TAU: f64 = 30.0;

/// Part of its first value to which the rate of wear does not fall before slip has grown.
const SLOWED: f64 = 0.1;

/// Steps times the fastest rate of relaxation for which Bogacki and Shampine's method is stable, on the negative real axis.
const STABLE: f64 = 2.5;

/// Iterations of the power method; the estimate is one of magnitude.
const ITERATIONS: usize = 30;

/// Most work of a run whose springs the program chooses, as [`work_so_far`]: some eight seconds. What would be more is made on fewer springs, and told.
const MOST_WORK: f64 = 8e9;

/// Work of a companion over that of the run, about, beyond which the run would take too long, and the most where one before came to its end, so that this one is not left for it.
const OF_COMPANION: [f64; 2] = [0.2, 0.4];

/// Most work of a companion.
///
/// # Arguments
/// * `ended` -- whether an attempt before came to its end
pub(super) fn work_of_companion(ended: bool) -> f64 {
    MOST_WORK * OF_COMPANION[usize::from(ended)]
}

/// The same for a run on so few springs that none are left out: others may find an end where it does not.
const MOST_WORK_OF_LAST: f64 = 6e9;

/// Most work of all attempts at a run together, their companions included, as [`work_so_far`], and the part of [`MOST_WORK`] that each may take in any case.
const MOST_WORK_OF_ALL: f64 = 1.35e10;
const LEAST_PART: f64 = 0.05;

/// Part of it for a run that is only made anew for its estimate to be surely within the accuracy.
const TO_BE_SURE: f64 = 0.25;

/// Work of an attempt that is left: to begin it, over [`MOST_WORK`], and over that of its companion.
const OF_LEFT: [f64; 2] = [0.05, 2.5];

/// Largest part of [`MOST_WORK`] that the last resort may take, the least ones of it and of each that follows on other springs, and the part of [`MOST_WORK_OF_ALL`] beyond which it is what follows on
/// an attempt that takes too long.
const MOST_OF_LAST_RESORT: f64 = 0.82;
const OF_LAST_RESORT: [f64; 2] = [0.4, 0.08];
const NEARLY_ALL: f64 = 0.7;

/// Springs of a run that takes too long when it is made anew over those before, and fewest with which it is.
const FEWER: f64 = 0.6;
const OF_WHOLE: f64 = 0.75;
const FEWEST: usize = 12;

/// Evaluations of a step that is expected: by stages where the edge of stick rests and where it moves, by backward differentiation, and in gross slip by backward
/// differentiation, whose matrix by differences serves many steps, and by stages beside one for every spring, for theirs is found in each.
const EVALUATIONS: [f64; 2] = [30.0, 60.0];
const EVALUATIONS_BY_BACKWARD_DIFFERENTIATION: f64 = 3.0;
const EVALUATIONS_IN_GROSS_SLIP: [f64; 2] = [4.5, 15.0];

/// Nanoseconds of one core that they take by spring, without and with an edge of stick that moves; in gross slip, where its sums are over the whole contact, in any case, by spring and by pair of springs;
/// and by pair of springs over which wear spreads. Periods that are resolved are counted as they are passed.
const BY_SPRING: [f64; 2] = [150.0, 300.0];
const IN_GROSS_SLIP: [f64; 3] = [1300.0, 150.0, 0.8];
const BY_SPREADING: f64 = 10.0;

/// How much longer an evaluation in gross slip takes where springs stick and slip sets in with a jump, up to which its sums are integrated; where an amplitude follows from a balance of forces; and where
/// loads are asked for between the nodes.
const OF_JUMP: f64 = 7.0;
const OF_BALANCE: f64 = 1.7;
const OF_POINTS: f64 = 3.0;

/// Nanoseconds of one core of a step in any case, in gross slip and elsewhere; of its slopes, by pair of springs, where they are found in each step by stages; and of its factors, by triple of springs,
/// without and with slopes that are products of matrices.
const OVERHEAD: [f64; 2] = [4e3, 4e4];
const BY_SLOPE: f64 = 3.0;
const BY_TRIPLE: [f64; 2] = [0.06, 0.35];

/// Power of the springs with which the work of resolved periods grows.
const OF_RESOLVED: f64 = 1.5;

/// How much longer it takes where a profile is a table and the edge of stick moves: slip of the unworn contact is then by quadrature in each evaluation.
const OF_TABLE: f64 = 8.0;

/// Nanoseconds of one core, about, of an evaluation and of the rest of a step, but for the periods that are resolved. The same on every machine, so that a run and one that was interrupted take the same
/// way.
struct Work {
    evaluation: f64,
    step: f64,
}

impl Work {
    fn of(model: &Model, springs: f64) -> Self {
        let schedule = model.schedule();
        let conditions = schedule.conditions();
        let cycles = schedule.cycles_at_once() as f64;
        let spread = if conditions.wear.spreading().is_some() { BY_SPREADING * springs } else { 0.0 };
        let [in_gross_slip, elsewhere] = OVERHEAD;
        let [of_factors, of_products] = BY_TRIPLE.map(|each| each * springs.powi(3));
        let Some(gross) = model.gross() else {
            let moves = model.moving().is_some();
            let is_table = model.contact().equivalent_profile().end_of_table().is_some();
            let table = if is_table && moves { OF_TABLE } else { 1.0 };
            let evaluation = springs * (table * BY_SPRING[usize::from(moves)] + spread);
            let slopes = if model.wears_steadily() { 0.0 } else { BY_SLOPE * springs.powi(2) };
            let factors = if schedule.wears_by_pressure_alone() { of_factors } else { of_products };
            return Self { evaluation: cycles * evaluation, step: elsewhere + cycles * (slopes + factors) };
        };
        let longer = [
            (gross.sticks() && conditions.friction.remembers_slip(), OF_JUMP),
            (conditions.tangential_control != TangentialControl::Displacement, OF_BALANCE),
            (gross.asks_between_nodes(), OF_POINTS),
        ];
        let times: f64 = longer.iter().filter(|(is_so, _)| *is_so).map(|(_, times)| times).product();
        let [in_any_case, by_spring, by_pair] = IN_GROSS_SLIP;
        let once = times * (in_any_case + (by_spring + by_pair * springs) * springs) + spread * springs;
        Self { evaluation: cycles * once, step: in_gross_slip + cycles * of_factors }
    }
}

/// Work of a step that is expected, as [`Work`].
fn work_of_step(model: &Model, springs: f64) -> f64 {
    let Work { evaluation, step } = Work::of(model, springs);
    evaluations(model, springs) * evaluation + step
}

/// Evaluations of a step on so many springs.
fn evaluations(model: &Model, springs: f64) -> f64 {
    let schedule = model.schedule();
    let [once, beside_springs] = EVALUATIONS_IN_GROSS_SLIP;
    match model.gross() {
        Some(_) if schedule.is_smooth_in_gross_slip() => once,
        Some(_) => springs + beside_springs,
        None if model.wears_steadily() => EVALUATIONS_BY_BACKWARD_DIFFERENTIATION,
        None => EVALUATIONS[usize::from(model.moving().is_some())],
    }
}

/// Work of a run so far without its companions, nanoseconds of one core, about, by what a step takes of the model that it began with.
pub(super) fn work_so_far(simulation: &Simulation) -> f64 {
    work_by(simulation.first().0, simulation)
}

/// Work of an attempt so far with its companions, by what a step takes of the model that it came to.
pub(super) fn work_of(simulation: &Simulation) -> u64 {
    (WITH_COMPANION * work_by(simulation.model(), simulation)) as u64
}

fn work_by(steps_of: &Model, simulation: &Simulation) -> f64 {
    let progress = simulation.progress();
    work_on(steps_of, steps_of.springs() as f64, progress) + progress.resolved_work as f64
}

/// Work of as many steps, if they were made on so many springs.
fn work_on(model: &Model, springs: f64, progress: &Progress) -> f64 {
    let Work { evaluation, step } = Work::of(model, springs);
    let more = evaluations(model, springs) / evaluations(model, model.springs() as f64);
    let tried = progress.steps + progress.rejected_steps;
    more * progress.rate_evaluations as f64 * evaluation + tried as f64 * step
}

/// Most work of an attempt, without its companions, after others that took so much.
pub(super) fn work_left(work: u64) -> f64 {
    let left = (MOST_WORK_OF_ALL - work as f64) / WITH_COMPANION;
    left.max(LEAST_PART * MOST_WORK)
}

/// Work of an attempt that was left when its companion, which took so much, told that it would take too long: the run beside it took somewhat longer. How far it came depends
/// on the machine, so that what it took is not asked.
pub(super) fn work_of_left(companion: u64) -> u64 {
    let [begun, per_companion] = OF_LEFT;
    (begun * MOST_WORK + per_companion * companion as f64) as u64
}

/// Most work of the last resort, which has no companions, after others that took so much.
///
/// # Arguments
/// * `follows` -- whether another on other springs has found no end
pub(super) fn work_of_last_resort(work: u64, follows: bool) -> f64 {
    let left = (MOST_WORK_OF_ALL - work as f64).min(MOST_OF_LAST_RESORT * MOST_WORK);
    left.max(OF_LAST_RESORT[usize::from(follows)] * MOST_WORK)
}

/// Whether attempts have taken so much that what is left is for the last resort.
pub(super) fn is_nearly_spent(work: u64) -> bool {
    work as f64 > NEARLY_ALL * MOST_WORK_OF_ALL
}

/// Springs with which to make a run anew that found no end on these; none if they would be too few. Polynomials over the whole contact swing the more, the more
/// there are.
pub(super) fn fewer_for_an_end(model: &Model) -> Option<usize> {
    let springs = model.springs();
    if model.gross().is_none() {
        return fewer(springs);
    }
    let fewer = (OF_WHOLE * springs as f64) as usize;
    (springs > FEWEST_SPRINGS).then_some(fewer.max(FEWEST_SPRINGS))
}

/// Springs with which to make a run anew that takes too long; none if they would be too few.
pub(super) fn fewer(springs: usize) -> Option<usize> {
    let fewer = (FEWER * springs as f64).ceil() as usize;
    (fewer >= FEWEST && fewer < springs).then_some(fewer)
}

/// Most work of a run whose springs the program chooses.
pub(super) fn most_work(model: &Model) -> f64 {
    if fewer(model.springs()).is_some() { MOST_WORK } else { MOST_WORK_OF_LAST }
}

/// Steps that an attempt may try.
pub(super) fn steps_of_attempt(model: &Model) -> f64 {
    MOST_WORK / work_of_step(model, model.springs() as f64)
}

/// Whether a run that came to its end, after others that took so much, can be made anew on so many springs.
///
/// # Arguments
/// * `times` -- as many substeps of a period as now
/// * `is_met` -- whether its estimate is within the accuracy already, if not surely
pub(super) fn allows(simulation: &Simulation, springs: usize, times: f64, work: u64, is_met: bool) -> bool {
    let (model, progress) = (simulation.model(), simulation.progress());
    let before = (work + work_of(simulation)) as f64;
    let (springs, now) = (springs as f64, model.springs() as f64);
    let resolved = times * (springs / now).powf(OF_RESOLVED) * progress.resolved_work as f64;
    let wanted = work_on(model, springs, progress) + resolved;
    let most = if is_met { TO_BE_SURE * MOST_WORK } else { MOST_WORK };
    wanted <= most && before + WITH_COMPANION * wanted <= MOST_WORK_OF_ALL
}

/// How a run is computed, and what it will take.
#[derive(Debug, Clone, PartialEq)]
pub struct Expected {
    /// Method and springs.
    pub method: Method,
    /// Wall time, s, in order of size; none where it is short.
    pub seconds: Option<f64>,
    /// The same in a sentence, with its cause.
    pub warning: Option<String>,
}

/// Refuses what would take days, and a first cycle that is too coarse a step.
///
/// # Errors
/// [`Error::Inconsistent`] beyond [`MOST_STEPS`]; those of a step of one cycle where the method makes one of every cycle.
pub(super) fn check(choice: Choice, by_hand: bool, simulation: &mut Simulation) -> Result<()> {
    let breaks = breaks(simulation);
    if breaks > MOST_STEPS || breaks.is_nan() {
        let why = format!(
            "the run has {breaks:.1e} ends of blocks in it, of which {MOST_STEPS:e} are allowed; make the blocks longer, or ask for fewer cycles"
        );
        return Err(Error::Inconsistent { what: "loading.blocks", why });
    }
    if choice == Choice::Implicit {
        return if by_hand { Ok(()) } else { check_blocks(simulation) };
    }
    let steps = fewest_steps(choice, simulation);
    if steps > MOST_STEPS || steps.is_nan() {
        let why = format!(
            "{:?} {}: at least {steps:.1e} steps, of which {MOST_STEPS:e} are allowed; take the stepper \"implicit\", or ask for fewer cycles \
             or less time",
            choice.name(),
            kind(choice)
        );
        return Err(Error::Inconsistent { what: "numerics.stepper", why });
    }
    simulation.try_step(1.0)
}

/// Refuses more ends of blocks, at each of which a step ends, than any attempt comes to on springs that the program chooses.
fn check_blocks(simulation: &Simulation) -> Result<()> {
    let model = simulation.model();
    if simulation.may_come_to_average() {
        return Ok(());
    }
    let (cycles, before) = match simulation.plan().end {
        End::Cycles(cycles) => (cycles, ""),
        End::Rate(rate) if rate < SLOWED * model.schedule().least_by_laws() => {
            (cycles_of_growth(simulation), ", before wear slows itself down")
        }
        End::Rate(_) => return Ok(()),
    };
    let breaks = model.schedule().breaks_until(cycles);
    let most = MOST_WORK_OF_ALL / work_of_step(model, FEWEST as f64);
    if breaks <= most {
        return Ok(());
    }
    let why = format!(
        "the run has {breaks:.1e} ends of blocks in it{before}, at each of which a step ends, and comes to at most {most:.1e} of them by itself; make the blocks longer, ask for fewer \
         cycles, or go on by hand (numerics.springs), however long it takes"
    );
    Err(Error::Inconsistent { what: "loading.blocks", why })
}

/// What a run will take, by the time of one step, and a word about it if that is more than a minute.
pub(super) fn expected(choice: Choice, simulation: &mut Simulation) -> Expected {
    let length = if choice == Choice::Implicit { simulation.progress().next_step } else { 1.0 };
    let steps = fewest_steps(choice, simulation);
    let model = simulation.model();
    if choice == Choice::Implicit && model.wears_smoothly() && model.springs() < FEW && steps < FEW_STEPS {
        return Expected { method: Method::of(simulation), seconds: None, warning: None };
    }
    let begun = Instant::now();
    // Where it fails, the run will say so.
    let _ = simulation.try_step(length);
    let step = begun.elapsed().as_secs_f64();
    let method = Method::of(simulation);
    if choice == Choice::Implicit {
        return implicit(method, steps, step, simulation.model());
    }
    let seconds = steps * step;
    Expected::of(method, seconds, || {
        format!(
            "the stepper {:?} {}: at least {steps:.1e} steps, some {} as things are; \"implicit\" needs some hundred",
            choice.name(),
            kind(choice),
            span(seconds)
        )
    })
}

/// What limits the steps of a method, in words.
fn kind(choice: Choice) -> &'static str {
    match choice {
        Choice::EveryCycle => "makes a step of every cycle",
        Choice::CycleJump => "is explicit, and its steps are limited by the stiffest springs",
        Choice::Implicit => "chooses its steps by their error",
    }
}

/// What an implicit run of so many steps, each of so many seconds, takes.
fn implicit(method: Method, steps: f64, step: f64, model: &Model) -> Expected {
    let seconds = WITH_COMPANION * steps * step;
    Expected::of(method, seconds, || {
        let resolved =
            if model.schedule().resolves() { ", numerics.substeps = 24 or fewer rows of a path" } else { "" };
        format!(
            "the run takes some {} as things are: {steps:.0} steps of {step:.1e} s on {} springs; where that is too long, ask for \
             numerics.accuracy = 1e-3 or fewer springs (numerics.springs){resolved}",
            span(seconds),
            model.springs()
        )
    })
}

impl Expected {
    fn of(method: Method, seconds: f64, words: impl FnOnce() -> String) -> Self {
        let is_long = seconds > LONG;
        Self { method, seconds: is_long.then(|| seconds.round()), warning: is_long.then(words) }
    }
}

/// A wall time for people.
fn span(seconds: f64) -> String {
    match seconds {
        seconds if seconds < 5400.0 => format!("{:.0} minutes", seconds / 60.0),
        seconds if seconds < 1.5e5 => format!("{:.1} hours", seconds / 3600.0),
        seconds => format!("{:.1e} days", seconds / 86400.0),
    }
}

/// Ends of blocks and kinks of histories in a run.
fn breaks(simulation: &Simulation) -> f64 {
    let model = simulation.model();
    if simulation.may_come_to_average() {
        // How many are stepped through is not known.
        return 0.0;
    }
    let cycles = match simulation.plan().end {
        End::Cycles(cycles) => cycles,
        End::Rate(_) => SOME_TAU / model.contact().tau_per_cycle(),
    };
    model.schedule().breaks_until(cycles)
}

/// Cycles in which slip grows at all, where it does so fastest; before, the rate of wear does not fall.
fn cycles_of_growth(simulation: &Simulation) -> f64 {
    simulation.cycle().growth.iter().fold(0.0_f64, |m, g| m.max(*g)).recip()
}

/// Fewest steps of an explicit method; about those of an implicit one.
fn fewest_steps(choice: Choice, simulation: &Simulation) -> f64 {
    let cycles = match simulation.plan().end {
        End::Cycles(cycles) => cycles,
        End::Rate(_) => cycles_of_growth(simulation),
    };
    match choice {
        Choice::EveryCycle => cycles,
        Choice::CycleJump => cycles * stiffness(simulation.model(), simulation.state()) / STABLE,
        Choice::Implicit => FREE_STEPS + simulation.plan().outputs.len() as f64 + breaks(simulation),
    }
}

/// Fastest rate of relaxation near the limiting shape, per cycle, by the power method.
///
/// What is left of the slip depth, `δ = S_∞ - S`, presses the springs by `F⁻¹ δ` and falls by the growth of `S` under that pressure.
fn stiffness(model: &Model, start: &State) -> f64 {
    let slip_area = model.unworn().limit_slip_area();
    let loading = model.schedule().loading(0.0, 0.0);
    let small = 1e-3 * model.depth_scale();
    let mut left: Vec<f64> = (0..model.springs()).map(|i| if i % 2 == 0 { small } else { -small }).collect();
    let mut rate = 0.0;
    let mut fields = model.fields(start);
    for _ in 0..ITERATIONS {
        let compression = model.compression(slip_area, |i, unworn| unworn.limit_slip - left[i]);
        model.evaluate(slip_area, &compression, &mut fields);
        let cycle = model.cycle(&loading, &compression, &fields);
        let fall: Vec<f64> = cycle
            .growth
            .iter()
            .zip(&fields.unworn)
            .map(|(growth, unworn)| growth * unworn.limit_slip)
            .collect();
        let size = fall.iter().fold(0.0_f64, |m, value| m.max(value.abs()));
        if !(size > 0.0 && size.is_finite()) {
            return 0.0;
        }
        rate = size / small;
        left = fall.iter().map(|value| value * small / size).collect();
    }
    rate
}
