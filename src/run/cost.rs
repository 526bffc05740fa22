//! What a run costs, before it begins: steps and time.

use std::time::Instant;

use super::method::Method;
use crate::error::{Error, Result};
use crate::scene::Stepper as Choice;
use crate::solver::model::{Model, State};
use crate::solver::simulation::{End, Simulation};

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

/// Steps times the fastest rate of relaxation for which Bogacki and Shampine's method is stable, on the negative real axis.
const STABLE: f64 = 2.5;

/// Iterations of the power method; the estimate is one of magnitude.
const ITERATIONS: usize = 30;

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
pub(super) fn check(choice: Choice, simulation: &mut Simulation) -> Result<()> {
    let breaks = breaks(simulation);
    if breaks > MOST_STEPS || breaks.is_nan() {
        let why = format!(
            "the run has {breaks:.1e} ends of blocks in it, of which {MOST_STEPS:e} are allowed; make the blocks longer, or ask for fewer cycles"
        );
        return Err(Error::Inconsistent { what: "loading.blocks", why });
    }
    if choice == Choice::Implicit {
        return Ok(());
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
    let cycles = match simulation.plan().end {
        End::Cycles(cycles) => cycles,
        End::Rate(_) => SOME_TAU / model.contact().tau_per_cycle(),
    };
    model.schedule().breaks_until(cycles)
}

/// Fewest steps of an explicit method; about those of an implicit one.
fn fewest_steps(choice: Choice, simulation: &Simulation) -> f64 {
    let cycles = match simulation.plan().end {
        End::Cycles(cycles) => cycles,
        // Slip has to grow at all before the rate can fall.
        End::Rate(_) => simulation.cycle().growth.iter().fold(0.0_f64, |m, g| m.max(*g)).recip(),
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
