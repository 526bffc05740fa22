//! Blocks from which on springs never slip farther than before.

use super::{CycleLoading, Schedule, scaled};
use crate::laws::conditions::Conditions;
use crate::laws::loading::{Block, TangentialControl, has_come};

impl Schedule {
    /// The block from which on springs never slip farther than before, where blocks differ by their amplitudes alone and do not recur; the first where every cycle is the same.
    fn first_of_shrinking(&self) -> Option<usize> {
        if self.is_steady() {
            return Some(0);
        }
        let Conditions { repeat, tangential_control, ref blocks, .. } = self.conditions;
        let differ_by_amplitude =
            self.changes_between_blocks() && !self.lifts_blocks() && self.keeps_friction();
        let followed =
            differ_by_amplitude && !repeat && tangential_control == TangentialControl::Displacement;
        let grows = |pair: &[Block]| pair[0].amplitude_factor < pair[1].amplitude_factor;
        let last_to_grow = blocks.windows(2).rposition(grows);
        followed.then(|| last_to_grow.map_or(0, |before| before + 1))
    }

    /// Whether a time, cycles, is that at which a block begins.
    pub fn is_at_begin_of_block(&self, cycles: f64) -> bool {
        let (pass, block) = self.block(cycles);
        block > 0 && has_come(cycles, self.end(pass, block - 1))
    }

    /// Whether there is such a block.
    pub fn shrinks_at_last(&self) -> bool {
        self.first_of_shrinking().is_some()
    }

    /// Whether it has begun.
    pub fn only_shrinks_after(&self, cycles: f64) -> bool {
        self.first_of_shrinking().is_some_and(|first| self.block(cycles).1 >= first)
    }

    /// Everything that acts in the blocks before those that only shrink, but for pauses, with friction at its smallest and at its largest.
    pub fn extremes_before_shrinking(&self) -> impl Iterator<Item = CycleLoading> {
        let before = self.first_of_shrinking().unwrap_or(self.loadings.len());
        scaled(&self.loadings[..before], self.friction_change().range())
    }
}
