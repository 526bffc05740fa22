//! Blocks in partial slip before the first of gross slip: a run of their own, whose ground a mesh over the whole contact takes up.

use std::sync::Arc;

use super::{CycleLoading, Schedule};
use crate::contact::InitialContact;
use crate::error::Result;
use crate::laws::conditions::Conditions;
use crate::laws::loading::Block;

/// The gross slip that follows.
#[derive(Debug, Clone)]
pub(super) struct Then {
    /// Cycles at which it begins.
    from: f64,
    contact: InitialContact,
    /// Of all blocks.
    schedule: Schedule,
}

impl Schedule {
    /// The blocks before the first of gross slip, and the contact under them; none where that is the first, or where the run ends at no time that is known.
    ///
    /// At an indentation that is held their edge of stick stays where it is, which no mesh over the whole contact resolves as well.
    ///
    /// # Arguments
    /// * `contact` -- under all of them
    /// * `slides_from` -- compression, m, from which on the whole of the unworn contact slides
    ///
    /// # Errors
    /// As [`InitialContact::at`].
    pub(in crate::solver::model) fn before_gross_slip(
        &self,
        contact: &InitialContact,
        slides_from: f64,
    ) -> Result<Option<(InitialContact, Self)>> {
        let compression = |it: &CycleLoading| it.slip_compression(self.stiffness_ratio);
        let slides = |it: &CycleLoading| compression(it) >= slides_from;
        let Some(first) = self.loadings.iter().position(slides).filter(|first| *first > 0) else {
            return Ok(None);
        };
        let (from, loadings) = (self.ends[first - 1], &self.loadings[..first]);
        let most = loadings.iter().max_by(|one, other| one.amplitude.total_cmp(&other.amplitude));
        let Some(most) = most.filter(|most| self.asked_until.is_finite() && !most.is_pause()) else {
            return Ok(None);
        };
        let (amplitude, conditions) = (most.amplitude, &self.conditions);
        let blocks = loadings.iter().zip(&conditions.blocks);
        let blocks: Vec<Block> = blocks
            .map(|(loading, block)| Block { amplitude_factor: loading.amplitude / amplitude, ..*block })
            .collect();
        let changes = blocks.iter().any(|block| block.amplitude_factor != 1.0);
        let before = Self {
            conditions: Conditions { blocks, ..conditions.clone() },
            ends: if changes { self.ends[..first].to_vec() } else { vec![] },
            loadings: loadings.to_vec(),
            then: Some(Arc::new(Then { from, contact: contact.clone(), schedule: self.clone() })),
            slipping: Default::default(),
            envelope: Arc::default(),
            ..self.clone()
        };
        Ok(Some((contact.moved_by(amplitude, compression(most))?, before)))
    }

    /// Cycles at which the blocks end and gross slip begins, if it does.
    pub fn ends_with_gross_slip_at(&self) -> Option<f64> {
        self.then.as_ref().map(|then| then.from)
    }

    /// The contact under all blocks where gross slip follows, and what acts in them.
    pub fn with_gross_slip(&self) -> Option<(&InitialContact, &Self)> {
        self.then.as_ref().map(|then| (&then.contact, &then.schedule))
    }
}
