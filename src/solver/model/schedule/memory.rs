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
        let amplitude = self.amplitude / self.friction.mean_over_static();
        let kept = self.friction.compression_at(stiffness_ratio * amplitude) + self.lift;
        kept.min(self.slipped)
    }
}

impl Schedule {
    /// Whether springs remember their slip and all of those beside the first stick zone slip from the first cycle on, under a held normal force that presses them harder. Where debris
    /// spreads below `k = 0` the mesh from an edge that rests needs 500 springs for what 60 do that follow it (docs/numerics.md).
    pub(in crate::solver::model) fn keeps_slipping_from_first(&self) -> bool {
        let Conditions { friction, holds_normal_force, tangential_control, .. } = &self.conditions;
        let [falls, _] = self.friction_change().directions();
        friction.remembers_slip()
            && *holds_normal_force
            && *tangential_control == TangentialControl::Displacement
            && (self.grading >= 0.0 || self.wears_locally())
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
        let from_rest = |loading: &CycleLoading, factor: f64| {
            let loading = CycleLoading { friction: friction.scaled(factor), ..loading.clone() };
            loading.slip_compression(self.stiffness_ratio)
        };
        let at_start = || self.loadings.iter().map(|it| from_rest(it, friction_history.at(0.0))).collect();
        let [_, rises] = friction_history.directions();
        if !(rises || self.changes_between_blocks()) {
            // What slipped before slips now.
            let all = self.slipping.get_or_init(at_start)[0] >= self.largest_indentation;
            return if all { f64::INFINITY } else { 0.0 };
        }
        let recurs = *repeat && self.ends.last().is_some_and(|whole| has_come(*whole, cycles));
        let begun = if recurs { self.loadings.len() } else { block + 1 };
        let slipped = |(it, loading): (usize, &CycleLoading)| {
            if *friction_history == History::Constant {
                return self.slipping.get_or_init(at_start)[it];
            }
            let start = if it == 0 { 0.0 } else { self.ends[it - 1] };
            let until = if it == block || *repeat { cycles } else { self.ends[it].min(cycles) };
            let [start, until] = [start, until].map(|cycles| cycles * self.clock_rate);
            from_rest(loading, friction_history.least_between(start, until))
        };
        let most = self.loadings[..begun].iter().enumerate().map(slipped).fold(0.0, f64::max);
        if most < self.largest_indentation { most } else { f64::INFINITY }
    }
}
