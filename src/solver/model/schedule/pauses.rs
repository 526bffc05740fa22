//! Blocks without amplitude: nothing slips, the contact rests as it is, and the next block begins from the edge of stick before.

use super::{CycleLoading, Schedule};
use crate::laws::history::History;

impl Schedule {
    /// Amplitude factors of the blocks, without pauses.
    pub fn amplitude_factors(&self) -> impl Iterator<Item = f64> {
        self.conditions.blocks.iter().map(|block| block.amplitude_factor).filter(|factor| *factor > 0.0)
    }

    /// Whether blocks make springs slip otherwise than one without end would: they differ by more than pauses, or friction changes along the cycles while
    /// one lasts.
    pub fn slips_otherwise(&self) -> bool {
        let first = self.amplitude_factors().next();
        let differ = self.amplitude_factors().any(|factor| Some(factor) != first)
            || self.conditions.blocks.iter().any(|block| block.indentation_factor != 1.0);
        self.changes_between_blocks()
            && (differ || self.conditions.friction_history != History::Constant)
    }

    /// What makes springs slip first, as it begins.
    pub fn first_slip(&self) -> CycleLoading {
        let block = self.loadings.iter().position(|loading| !loading.is_pause()).unwrap_or_default();
        let start = if block > 0 { self.ends[block - 1] } else { 0.0 };
        self.in_block(block, start)
    }

    /// What made springs slip last before the block that is under way at `cycles`, as it ended; none where nothing did.
    pub fn slip_before(&self, cycles: f64) -> Option<CycleLoading> {
        let (mut pass, mut block) = self.block(cycles);
        loop {
            (pass, block) = match block {
                0 if pass == 0.0 => return None,
                0 => (pass - 1.0, self.loadings.len() - 1),
                _ => (pass, block - 1),
            };
            if !self.loadings[block].is_pause() {
                return Some(self.in_block(block, self.end(pass, block)));
            }
        }
    }
}
