//! Whether wear goes on as in the mean cycle of a pass through repeated blocks, and what that leaves out.

use super::cost::steps_of_attempt;
use crate::solver::model::{Model, PassSwing};
use crate::solver::simulation::{End, Simulation};

/// Part of the accuracy asked for that averaging over passes may take up, from the first on and later on; more where an attempt does not come to all ends of blocks.
const OF_PASSES: [f64; 2] = [0.1, 0.03];
const OF_MANY_PASSES: [f64; 2] = [0.4, 0.4];

/// What averaging leaves out over the swing of a pass: that itself, by the phase of the pass, and up to 0.6 of it by the order of the blocks.
const OF_SWING: f64 = 1.5;

/// When steps see passes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Averaging {
    /// Whether they do so from the first on.
    pub at_once: bool,
    /// The largest swing of a pass that may be left out later on, over the limit and over what is worn; zero where each block is stepped through.
    pub most_swing: f64,
}

fn first_swing(model: &Model) -> Option<PassSwing> {
    model.initial_state().ok().and_then(|state| model.pass_swing(&state))
}

impl Averaging {
    /// That of an implicit run.
    pub(super) fn of(model: &Model, end: End, accuracy: f64) -> Self {
        let swing = if model.may_average() { first_swing(model) } else { None };
        let Some(swing) = swing else { return Self::default() };
        let of_limit = model.of_limit(&swing);
        // Passes in the run, or as many as wear all that the limit takes away; and what is left out at its end.
        let (passes, of_end) = match end {
            End::Cycles(cycles) => (cycles / swing.cycles, swing.part * swing.cycles / cycles),
            End::Rate(fraction) => (swing.part / of_limit, of_limit / (1.0 - fraction)),
        };
        let blocks = passes * model.schedule().durations().count() as f64;
        let shares = if blocks > steps_of_attempt(model) { OF_MANY_PASSES } else { OF_PASSES };
        let [at_once, most_swing] = shares.map(|share| share / OF_SWING * accuracy);
        Self { at_once: [of_limit, of_end].iter().all(|part| *part <= at_once), most_swing }
    }
}

/// What averaging from the first pass on leaves out of the worn volume, m³, and of the depth, m.
pub(in crate::run) fn left_out(model: &Model) -> [f64; 2] {
    let averaged = if model.schedule().averages_from() > 0.0 { None } else { first_swing(model) };
    averaged.map_or([0.0; 2], |it| [it.volume, it.depth].map(|swing| OF_SWING * swing))
}

/// The same of averaging later on, over the limit.
pub(in crate::run) fn left_out_later(simulation: &Simulation) -> f64 {
    OF_SWING * simulation.swing_left_out()
}
