//! Blocks without amplitude: nothing slips, the contact rests as it is, and the next block begins from the edge of stick before.

use super::{CycleLoading, Schedule};
use crate::laws::history::History;
use crate::laws::loading::Block;

impl Schedule {
    /// Amplitude factors of the blocks, without pauses.
    pub fn amplitude_factors(&self) -> impl Iterator<Item = f64> {
        self.conditions.blocks.iter().map(|block| block.amplitude_factor).filter(|factor| *factor > 0.0)
    }

    /// Whether blocks make springs slip otherwise than they would without blocks: they are more than pauses, or friction changes along the cycles while one lasts.
    pub fn slips_otherwise(&self) -> bool {
        let blocks = &self.conditions.blocks;
        let pauses = blocks.iter().any(|block| block.amplitude_factor == 0.0);
        let differs =
            |block: &Block| ![0.0, 1.0].contains(&block.amplitude_factor) || block.indentation_factor != 1.0;
        blocks.iter().any(differs) || pauses && self.conditions.friction_history != History::Constant
    }

    /// Whether springs slip otherwise in one block than in another.
    pub fn slips_otherwise_between_blocks(&self) -> bool {
        self.changes_between_blocks() && self.slips_otherwise()
    }

    /// What makes springs slip first, as it begins, and none has slipped before.
    pub fn first_slip(&self) -> CycleLoading {
        let block = self.loadings.iter().position(|loading| !loading.is_pause()).unwrap_or_default();
        let start = if block > 0 { self.ends[block - 1] } else { 0.0 };
        CycleLoading { slipped: 0.0, ..self.in_block(block, start) }
    }

    /// Whether nothing moves in the block that begins at `cycles`, or springs slip as they did when they slipped last, or for the first time.
    pub fn rests_or_goes_on(&self, cycles: f64) -> bool {
        let now = self.loading(cycles, cycles);
        let same = |last: CycleLoading| {
            let [last, now] =
                [&last, &now].map(|it| [it.asked(), it.lift, it.friction.reference_coefficient()]);
            last == now
        };
        now.is_pause() || self.slip_before(cycles).is_none_or(same)
    }

    /// What made springs slip last before the block that is under way at `cycles`, as it ended; none where nothing did.
    fn slip_before(&self, cycles: f64) -> Option<CycleLoading> {
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
