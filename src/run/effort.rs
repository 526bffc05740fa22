//! What a run that cannot choose its steps freely comes to, before it begins.

use std::time::Instant;

use crate::error::{Error, Result};
use crate::model::{Model, State};
use crate::scene::Stepper as Choice;
use crate::simulation::{End, Simulation};

/// Most steps of a method that needs one for every cycle or for every relaxation of the stiffest springs: a day or so.
const MOST_STEPS: f64 = 1e9;

/// Wall time of a run, s, from which on it deserves a word.
const LONG: f64 = 3600.0;

/// Steps times the fastest rate of relaxation for which Bogacki and Shampine's method is stable, on the negative real axis.
const STABLE: f64 = 2.5;

/// Iterations of the power method; the estimate is one of magnitude.
const ITERATIONS: usize = 30;

/// Refuses what would take days, and gives a word about what would take hours.
///
/// # Arguments
/// * `steps` -- at least so many
///
/// # Errors
/// [`Error::Inconsistent`] beyond [`MOST_STEPS`].
pub(super) fn check(choice: Choice, simulation: &mut Simulation) -> Result<Option<String>> {
    let Some(steps) = fewest_steps(choice, simulation) else { return Ok(None) };
    let kind = match choice {
        Choice::EveryCycle => "makes a step of every cycle",
        Choice::CycleJump => "is explicit, and its steps are limited by the stiffest springs",
        Choice::Implicit => return Ok(None),
    };
    if steps > MOST_STEPS || steps.is_nan() {
        let why = format!(
            "{:?} {kind}: at least {steps:.1e} steps, of which {MOST_STEPS:e} are allowed; take the stepper \"implicit\", or ask for fewer cycles \
             or less time",
            choice.name()
        );
        return Err(Error::Inconsistent { what: "numerics.stepper", why });
    }
    // A first cycle that is too coarse a step is refused here as well.
    let begun = Instant::now();
    simulation.measure_step()?;
    let seconds = steps * begun.elapsed().as_secs_f64();
    Ok((seconds > LONG).then(|| {
        format!(
            "the stepper {:?} {kind}: at least {steps:.1e} steps, some {:.1} hours as things are; \"implicit\" needs some hundred",
            choice.name(),
            seconds / 3600.0
        )
    }))
}

/// A number of steps that the method cannot do with less than.
fn fewest_steps(choice: Choice, simulation: &Simulation) -> Option<f64> {
    let cycles = match simulation.plan().end {
        End::Cycles(cycles) => cycles,
        // Slip has to grow at all before the rate can fall.
        End::Rate(_) => simulation.cycle().growth.iter().fold(0.0_f64, |m, g| m.max(*g)).recip(),
    };
    match choice {
        Choice::EveryCycle => Some(cycles),
        Choice::CycleJump => Some(cycles * stiffness(simulation.model(), simulation.state()) / STABLE),
        Choice::Implicit => None,
    }
}

/// Fastest rate of relaxation near the limiting shape, per cycle, by the power method.
///
/// What is left of the slip depth, `δ = S_∞ - S`, presses the springs by `F⁻¹ δ` and falls by the growth of `S` under that pressure.
fn stiffness(model: &Model, start: &State) -> f64 {
    let edge = model.unworn().limit_edge();
    let drive = model.schedule().drive(0.0, 0.0);
    let small = 1e-3 * model.depth_scale();
    let mut left: Vec<f64> = (0..model.springs()).map(|i| if i % 2 == 0 { small } else { -small }).collect();
    let mut rate = 0.0;
    let mut fields = model.fields(start);
    for _ in 0..ITERATIONS {
        let compression = model.compression(edge, |i, unworn| unworn.limit_slip - left[i]);
        model.evaluate(edge, &compression, &mut fields);
        let cycle = model.cycle(&drive, &compression, &fields);
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
