//! Which springs slip in a cycle, and which of them remember that they have slipped before.

use super::{CycleLoading, Schedule, has_come};
use crate::contact::spring::searched_stick_compression;
use crate::laws::conditions::Conditions;
use crate::laws::history::History;
use crate::laws::loading::TangentialControl;

impl CycleLoading {
    /// Compression at the largest indentation below which springs slip in this cycle, m, at the amplitude given.
    pub fn slip_compression(&self, stiffness_ratio: f64) -> f64 {
        match &self.path {
            Some(path) => searched_stick_compression(path, &*self.friction, stiffness_ratio, self.slipped).0,
            None => self.fresh_compression(stiffness_ratio).max(self.keeps_slipping_below(stiffness_ratio)),
        }
    }

    /// The same of springs that were pressed on, and never slipped, to and fro.
    fn fresh_compression(&self, stiffness_ratio: f64) -> f64 {
        self.friction.compression_at(stiffness_ratio * self.amplitude) + self.lift
    }

    /// The same of springs that have slipped before, to and fro: where they remember it, they slip on as long as they are moved each way from the kinetic limit on one side
    /// to the static one on the other, `2 M U > τ_s + τ_k`. Else zero.
    pub fn keeps_slipping_below(&self, stiffness_ratio: f64) -> f64 {
        if self.slipped == 0.0 {
            return 0.0;
        }
        let mean_over_static = 0.5 * (1.0 + self.friction.static_factor().recip());
        let amplitude = self.amplitude / mean_over_static;
        let kept = self.friction.compression_at(stiffness_ratio * amplitude) + self.lift;
        kept.min(self.slipped)
    }
}

impl Schedule {
    /// Whether springs remember their slip and all of those beside the first stick zone slip from the first cycle on, under a held normal force that presses them harder.
    pub(in crate::solver::model) fn keeps_slipping_from_first(&self) -> bool {
        let Conditions { friction, holds_normal_force, tangential_control, .. } = &self.conditions;
        let [falls, _] = self.friction_change().directions();
        friction.remembers_slip()
            && *holds_normal_force
            && *tangential_control == TangentialControl::Displacement
            && !falls
            && !self.changes_between_blocks()
    }

    /// See [`CycleLoading::slipped`], at `cycles` in a block; all springs have once the whole of the unworn contact has.
    pub(super) fn slipped(&self, block: usize, cycles: f64) -> f64 {
        let Conditions { friction, friction_history, tangential_control, repeat, .. } = &self.conditions;
        if !friction.remembers_slip() || *tangential_control != TangentialControl::Displacement {
            return 0.0;
        }
        if self.keeps_slipping_from_first() {
            return f64::INFINITY;
        }
        let recurs = *repeat && self.ends.last().is_some_and(|whole| has_come(*whole, cycles));
        let begun = if recurs { self.loadings.len() } else { block + 1 };
        let slipping = |loading: &CycleLoading| loading.slip_compression(self.stiffness_ratio);
        let always = || self.loadings.iter().map(slipping).collect();
        let slipped = |(it, loading): (usize, &CycleLoading)| {
            if *friction_history == History::Constant {
                return self.slipping.get_or_init(always)[it];
            }
            let start = if it == 0 { 0.0 } else { self.ends[it - 1] };
            let until = if it == block || *repeat { cycles } else { self.ends[it].min(cycles) };
            let factor = friction_history.least_between(start * self.clock_rate, until * self.clock_rate);
            slipping(&CycleLoading { friction: friction.scaled(factor), ..loading.clone() })
        };
        let most = self.loadings[..begun].iter().enumerate().map(slipped).fold(0.0, f64::max);
        if most < self.largest_indentation { most } else { f64::INFINITY }
    }
}
