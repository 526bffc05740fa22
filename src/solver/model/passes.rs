//! Blocks that recur so fast that wear goes on as in the mean cycle of a pass.
//!
//! With the rates `f_b` of block `b`, which takes the part `φ_b` of a pass of `P` cycles, the contact `y` stays beside one that follows the mean:
//!
//! ```text
//! dy/dN = f_b(y),     dz/dN = Σ_b φ_b f_b(z),     y - z = O(P):  of the phase of the pass  ∫ (f_b - Σ φ f) dN,
//!                                                                 and as much of the order of the blocks
//! ```

use super::{Model, State};
use crate::laws::history::History;

/// By how much a pass leads the contact away from its mean evolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassSwing {
    /// Of the worn volume, m³.
    pub volume: f64,
    /// Of the wear depth at any spring, m.
    pub depth: f64,
    /// The larger of both over what a pass wears, of the depth at its deepest.
    pub part: f64,
    /// Cycles of a pass.
    pub cycles: f64,
}

impl Model {
    /// Lets wear go on as in the mean cycle of a pass from some cycle on, where blocks recur and no edge of stick is followed from one to the next.
    pub fn average_from(&mut self, cycles: f64) {
        let follows = self.moving().is_some();
        self.schedule.average_from(if follows { f64::INFINITY } else { cycles });
    }

    /// Whether wear may go on as in the mean cycle of a pass.
    pub fn may_average(&self) -> bool {
        self.schedule.recurs() && self.moving().is_none()
    }

    /// What a pass does to a contact, with friction and wear at their largest; none where wear may not go on as in its mean cycle.
    pub fn pass_swing(&self, state: &State) -> Option<PassSwing> {
        if !self.may_average() {
            return None;
        }
        let (schedule, now) = (&self.schedule, state.cycles);
        // All blocks on one mesh: that at the largest indentation.
        let deepest = self.lifted_to(0.0, state).ok()?;
        let state = deepest.as_ref().unwrap_or(state);
        let fields = self.fields(state);
        // In gross slip growth is over the indentation.
        let scale = |i: usize| fields.slip_depth.get(i).copied().unwrap_or(self.contact.indentation());
        let durations: Vec<f64> = schedule.durations().collect();
        let loading = self.loading_in(state, schedule.mean_loading(now, now));
        let worn = loading.parts().zip(&durations).map(|(part, duration)| {
            let cycle = self.cycle_in_block(part, &state.compression, &fields);
            let depths = cycle.growth.iter().enumerate().map(|(i, growth)| growth * scale(i));
            std::iter::once(cycle.volume).chain(depths).map(|it| duration * it).collect()
        });
        let worn: Vec<Vec<f64>> = worn.collect();
        let cycles: f64 = durations.iter().sum();
        let largest = |history: &History| history.range()[1] / history.at(0.0);
        let conditions = schedule.conditions();
        let more = largest(schedule.friction_change()) * largest(&conditions.wear_history);
        let of_pass = |i: usize| worn.iter().map(|block| block[i]).sum::<f64>();
        let swing = |i: usize| {
            let (mean, mut away) = (of_pass(i) / cycles, 0.0);
            let aways = worn.iter().zip(&durations).map(|(block, duration)| {
                away += block[i] - duration * mean;
                f64::abs(away)
            });
            more * aways.fold(0.0, f64::max)
        };
        let (volume, springs) = (swing(0), 1..worn[0].len());
        let depth = springs.clone().map(swing).fold(0.0, f64::max);
        let deepest = springs.map(of_pass).fold(0.0, f64::max);
        let part = (volume / of_pass(0)).max(depth / deepest) / more;
        Some(PassSwing { volume, depth, part, cycles })
    }

    /// A swing over the limit's volume and depth, the larger of both; in gross slip of the depth over the indentation.
    pub fn of_limit(&self, swing: &PassSwing) -> f64 {
        let of_volume = if self.gross().is_some() { 0.0 } else { swing.volume / self.limit_volume() };
        of_volume.max(swing.depth / self.depth_scale())
    }
}
