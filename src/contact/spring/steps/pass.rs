//! What a spring slips in the steps of a period, by the turns of what pushes it.

use super::{Phase, Step, Steps};
use crate::contact::spring::{ROUND_OFF, Shakedown};

/// Energies of a period over the tangential stiffness, m².
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PassedSteps {
    /// Work of friction, and of the indenter: nothing else takes any.
    pub dissipation: f64,
    /// Length of the slip path, m.
    pub slip_path: f64,
}

/// A position on the path: substep, and part of it.
#[derive(Debug, Clone, Copy)]
struct Position {
    substep: usize,
    part: f64,
}

/// Slip of one phase.
struct Slip {
    side: usize,
    from: Position,
    to: Position,
}

impl Steps {
    /// Slip of a spring at the nodes, m, shape `(columns,)`, and energies.
    ///
    /// Between its turns what pushes goes one way, so that slip begins where it reaches the place of the spring and lasts to the turn or to where the spring
    /// lifts off; a spring that touches begins there anew. From the second period on it repeats itself.
    ///
    /// # Arguments
    /// * `compression` -- at the largest indentation, m, at least 0
    pub fn pass(&self, compression: f64, slip: &mut [f64]) -> PassedSteps {
        slip.fill(0.0);
        let first = &self.path.points[0];
        let limit = self.slope * (compression - first.lift).max(0.0);
        let (u, mut loaded) = (first.tangential[0], 0.0);
        // Pressed on without tangential displacement, and moved to the first point.
        let side = 1.0_f64.copysign(u);
        let mut slipped = side * (u.abs() - limit).max(0.0);
        let mut passed = PassedSteps::default();
        for phase in &self.phases {
            self.through_phase(phase, compression, &mut slipped);
        }
        for phase in &self.phases {
            let Some([from, to]) = self.loaded(phase, compression) else { continue };
            loaded += (self.tangential(to) - self.tangential(from)).abs();
            if let Some(found) = self.through_phase(phase, compression, &mut slipped) {
                self.record(&found, compression, &mut passed, slip);
            }
        }
        let round_off = ROUND_OFF * (self.reach + self.slope * compression) * self.path.points.len() as f64;
        if passed.slip_path <= Shakedown::default().threshold * loaded + round_off {
            slip.fill(0.0);
            return PassedSteps::default();
        }
        passed
    }

    /// The part of a phase in which a spring is loaded.
    fn loaded(&self, phase: &Phase, compression: f64) -> Option<[Position; 2]> {
        let lift = |m: usize| self.corner(m).lift;
        let begin = Position { substep: phase.first, part: 0.0 };
        let end = Position { substep: phase.end - 1, part: 1.0 };
        let crossing = |m: usize| {
            let [before, after] = [lift(m), lift(m + 1)];
            Position { substep: m, part: (compression - before) / (after - before) }
        };
        match (lift(phase.first) <= compression, lift(phase.end) <= compression) {
            (true, true) => Some([begin, end]),
            (false, false) => None,
            (true, false) => {
                let within = phase.find(|m| lift(m + 1) <= compression);
                Some([begin, crossing(within)])
            }
            (false, true) => {
                let before = phase.find(|m| lift(m + 1) > compression);
                Some([crossing(before), end])
            }
        }
    }

    /// Moves a spring through a phase; its slip, if it slips.
    fn through_phase(&self, phase: &Phase, compression: f64, slipped: &mut f64) -> Option<Slip> {
        let [begin, to] = self.loaded(phase, compression)?;
        if self.corner(phase.first).lift > compression {
            // It touches.
            *slipped = self.tangential(begin);
        }
        for side in 0..2 {
            if self.pushes[phase.first][side] == 0.0 {
                continue;
            }
            let sign = [1.0, -1.0][side];
            let reached = self.pushed(to, side) - self.slope * compression;
            if reached <= sign * *slipped {
                continue;
            }
            let level = sign * *slipped + self.slope * compression;
            let from = if self.pushed(begin, side) >= level {
                begin
            } else {
                let corner = |m: usize| self.pushed(Position { substep: m, part: 1.0 }, side);
                let substep = phase.find(|m| corner(m) < level);
                let before = self.pushed(Position { substep, part: 0.0 }, side);
                let part = ((level - before) / self.pushes[substep][side]).clamp(0.0, 1.0);
                Position { substep, part }
            };
            *slipped = sign * reached;
            return Some(Slip { side, from, to });
        }
        None
    }

    /// Adds a slip to the nodes and to the energies.
    fn record(&self, slip: &Slip, compression: f64, passed: &mut PassedSteps, nodes: &mut [f64]) {
        let Slip { side, from, to } = *slip;
        let sign = [1.0, -1.0][side];
        let (Some(first), Some(last)) = (self.step_of[from.substep], self.step_of[to.substep]) else {
            return;
        };
        // The first substep and the end of those that are passed as a whole.
        let begun = from.substep + usize::from(from.part > 0.0);
        let ended = to.substep + usize::from(to.part == 1.0);
        let mut add = |step: usize, [mean, aside, lifted]: [f64; 3]| {
            put(nodes, step, sign * mean, sign * aside);
            passed.slip_path += mean;
            passed.dissipation += self.slope * (compression * mean - lifted);
        };
        for step in first..=last {
            let Step { first, end, whole, .. } = &self.steps[step];
            if *first >= begun && *end <= ended {
                add(step, whole[side]);
                continue;
            }
            for m in (*first).max(from.substep)..(*end).min(to.substep + 1) {
                let begin = if m == from.substep { from.part } else { 0.0 };
                let end = if m == to.substep { to.part } else { 1.0 };
                add(step, self.part(m, side, [begin, end]));
            }
        }
    }

    /// `∫ ds`, `∫ (2f - 1) ds` and `∫ lift ds` of a part of a substep, m, m and m².
    pub(super) fn part(&self, m: usize, side: usize, [begin, end]: [f64; 2]) -> [f64; 3] {
        let moved = (end - begin).max(0.0) * self.pushes[m][side];
        let part = 0.5 * (begin + end);
        let middle = Position { substep: m, part };
        let lift = (1.0 - part) * self.corner(m).lift + part * self.corner(m + 1).lift;
        [moved, moved * self.aside(middle), moved * lift]
    }

    /// `2f - 1` at a place.
    fn aside(&self, place: Position) -> f64 {
        let [from, to] = self.through[place.substep];
        2.0 * (from + place.part * (to - from)) - 1.0
    }

    fn tangential(&self, Position { substep, part }: Position) -> f64 {
        (1.0 - part) * self.corner(substep).tangential[0] + part * self.corner(substep + 1).tangential[0]
    }

    /// What pushes at a place, m: `u + (μ_f/M) lift`, or `-u + (μ_f/M) lift` to the other side.
    fn pushed(&self, Position { substep, part }: Position, side: usize) -> f64 {
        let at = |m: usize| {
            let point = self.corner(m);
            [1.0, -1.0][side] * point.tangential[0] + self.slope * point.lift
        };
        if part == 1.0 { at(substep + 1) } else { at(substep) + part * self.pushes[substep][side] }
    }
}

impl Phase {
    /// The first substep of which this is not so; the last one if it is so of all.
    fn find(&self, holds: impl Fn(usize) -> bool) -> usize {
        let (mut low, mut high) = (self.first, self.end - 1);
        while low < high {
            let middle = low + (high - low) / 2;
            if holds(middle) { low = middle + 1 } else { high = middle }
        }
        low
    }
}

/// Adds moments of a step to its two nodes.
fn put(nodes: &mut [f64], step: usize, mean: f64, aside: f64) {
    let aside = 0.5 * 3.0_f64.sqrt() * aside;
    nodes[2 * step] += 0.5 * mean - aside;
    nodes[2 * step + 1] += 0.5 * mean + aside;
}
