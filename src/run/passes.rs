//! Whether wear goes on as in the mean cycle of a pass through repeated blocks, and what that leaves out.

use crate::solver::model::{Model, PassSwing};
use crate::solver::simulation::End;

/// Part of the accuracy asked for that averaging over passes may take up.
const OF_PASSES: f64 = 0.1;

/// What averaging leaves out over the swing of a pass: that itself, by the phase of the pass, and up to 0.4 of it by the order of the blocks.
const OF_SWING: f64 = 1.5;

fn swing(model: &Model) -> Option<PassSwing> {
    model.pass_swing().ok().flatten()
}

/// Whether what averaging leaves out is a small part of the accuracy: over the limit, and over what is worn at the end of the run.
pub(super) fn are_short(model: &Model, end: End, accuracy: f64) -> bool {
    let Some(swing) = swing(model) else { return false };
    let of_depth = swing.depth / model.depth_scale();
    let of_volume = if model.gross().is_some() { 0.0 } else { swing.volume / model.limit_volume() };
    let of_end = match end {
        End::Cycles(cycles) => swing.part * swing.cycles / cycles,
        End::Rate(fraction) => of_depth / (1.0 - fraction),
    };
    [of_depth, of_volume, of_end].iter().all(|part| OF_SWING * part <= OF_PASSES * accuracy)
}

/// What averaging leaves out of the worn volume, m³, and of the depth, m; nothing where steps end with each block.
pub(in crate::run) fn left_out(model: &Model) -> [f64; 2] {
    let averaged = model.schedule().averages().then(|| swing(model)).flatten();
    averaged.map_or([0.0; 2], |it| [it.volume, it.depth].map(|swing| OF_SWING * swing))
}
