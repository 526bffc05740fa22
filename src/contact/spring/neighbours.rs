//! Springs that slip for ever on a path at constant indentation, one after the other.

use super::enclosing::{Circle, smallest_enclosing};
use super::{
    Passed, Shakedown, SpringCycle, difference, dot, length, onset, scaled, square, steady_cycle, sum,
    turned_by,
};
use crate::laws::friction::Coulomb;
use crate::laws::path::Path;

/// Change of the deflection over a period, over its limit, below which the spring repeats itself, and the rounds in which it is to come to that from a
/// deflection nearby.
const PERIODIC: f64 = 1e-10;
const ROUNDS: usize = 16;

/// Largest part of a change that the one a period later may be for what follows from it to be summed up.
const SLOWEST: f64 = 0.999;

/// Difference of two places, over the reach of the path, that is round-off.
const SAME: f64 = 1e-13;

/// Springs that slip for ever on a path at constant indentation, without a static coefficient, in the order of the limit of their deflection.
///
/// What they repeat does not depend on where they began, so that each begins near what the ones before repeat. A period takes any
/// deflection on to a curve, along which its changes fall by a factor that is nearly that of the spring before, so that their sum is known from the
/// first, and from two of them the factor (secant method). On a path of which the second half goes back the way of the first, as on an ellipse, half a period is passed: after it the
/// deflection is the opposite.
#[derive(Debug)]
pub struct Neighbours {
    path: Path,
    /// Of its substeps, or of those in the first half of a mirrored one.
    motions: Vec<Motion>,
    mirrored: bool,
    sticking: f64,
    /// What the last three repeat at the first point, over their limits, each with its limit.
    before: [Option<(f64, [f64; 2])>; 3],
    /// Part of a change of the deflection that the one a period later is.
    part: f64,
}

/// The motion of a substep, m: as it is, its length and its direction.
#[derive(Debug)]
struct Motion {
    moved: [f64; 2],
    length: f64,
    along: [f64; 2],
}

impl Neighbours {
    /// # Arguments
    /// * `path` -- one period; none for one that presses and lifts
    pub fn new(path: &Path) -> Option<Self> {
        if !path.is_level() {
            return None;
        }
        let mut path = path.clone();
        path.points.iter_mut().for_each(|point| point.lift = 0.0);
        let circles: Vec<Circle> =
            path.points.iter().map(|point| Circle { centre: point.tangential, radius: 0.0 }).collect();
        let mirrored = goes_back(&path);
        let count = path.points.len();
        let motion = |m: usize| {
            let moved = difference(path.points[(m + 1) % count].tangential, path.points[m].tangential);
            let length = length(moved);
            let along = if length > 0.0 { scaled(length.recip(), moved) } else { [1.0, 0.0] };
            Motion { moved, length, along }
        };
        Some(Self {
            motions: (0..if mirrored { count / 2 } else { count }).map(motion).collect(),
            mirrored,
            sticking: smallest_enclosing(&circles).radius,
            before: [None; 3],
            part: 0.0,
            path,
        })
    }

    /// Limit of the deflection, m, from which on springs stick in the end.
    pub fn sticking(&self) -> f64 {
        self.sticking
    }

    /// Whether the second half of the period is the opposite of the first.
    pub fn is_mirrored(&self) -> bool {
        self.mirrored
    }

    /// The periodic motion of the next spring, energies over the tangential stiffness.
    ///
    /// # Arguments
    /// * `limit` -- of its deflection, m, in `[0, sticking)`
    /// * `out` -- overwritten; its memory is used again
    pub fn pass(&mut self, limit: f64, out: &mut SpringCycle) {
        let found = self.expected(limit).filter(|_| limit > 0.0).and_then(|near| {
            let size = length(near).max(1.0);
            self.from(scaled(limit / size, near), limit, out)
        });
        let law = Coulomb { coefficient: 1.0 };
        if found.is_none() {
            let shakedown = Shakedown { slips: true, ..Shakedown::default() };
            steady_cycle(&self.path, &law, 1.0, limit, &shakedown, out);
            self.part = 0.0;
        }
        let repeated = found.or_else(|| out.deflection.last().copied()).filter(|_| limit > 0.0);
        self.before = [repeated.map(|it| (limit, scaled(limit.recip(), it))), self.before[0], self.before[1]];
    }

    /// What a spring repeats over its limit, by the polynomial through those before.
    fn expected(&self, limit: f64) -> Option<[f64; 2]> {
        let before: Vec<(f64, [f64; 2])> = self.before.iter().map_while(|it| *it).collect();
        let weight = |i: usize| -> f64 {
            let others = before.iter().enumerate().filter(|(j, _)| *j != i);
            others.map(|(_, (other, _))| (limit - other) / (before[i].0 - other)).product()
        };
        let parts = before.iter().enumerate().map(|(i, (_, place))| scaled(weight(i), *place));
        parts.reduce(sum).filter(|place| place.iter().all(|it| it.is_finite()))
    }

    /// The motion that a spring repeats, from a deflection nearby; the deflection at the first point, or none where it is not found.
    fn from(&mut self, start: [f64; 2], limit: f64, out: &mut SpringCycle) -> Option<[f64; 2]> {
        let mut deflection = start;
        let mut last: Option<([f64; 2], [f64; 2])> = None;
        for _ in 0..ROUNDS {
            let end = self.after(deflection, limit, out);
            let change = difference(end, deflection);
            if length(change) <= PERIODIC * limit {
                if self.mirrored {
                    turn(out);
                }
                return Some(end);
            }
            if let Some((place, left)) = last {
                let moved = difference(deflection, place);
                let part = 1.0 + dot(difference(change, left), moved) / dot(moved, moved);
                self.part = if part.abs() < SLOWEST { part } else { 0.0 };
            }
            last = Some((deflection, change));
            let found = sum(deflection, scaled((1.0 - self.part).recip(), change));
            let size = length(found);
            deflection = if size > limit { scaled(limit / size, found) } else { found };
        }
        None
    }

    /// The deflection a period after this one, or its opposite half a period after.
    fn after(&self, start: [f64; 2], limit: f64, out: &mut SpringCycle) -> [f64; 2] {
        out.clear();
        let mut deflection = start;
        let mut slides = false;
        for Motion { moved, length: way, along } in &self.motions {
            let trial = sum(deflection, *moved);
            if square(trial) <= limit * limit {
                let work = 0.5 * dot(sum(deflection, trial), *moved);
                out.push(trial, &Passed { work, ..Default::default() });
                (deflection, slides) = (trial, false);
                continue;
            }
            // On the limit, and pushed out of it, a spring slides at once.
            let at_once = slides && dot(deflection, *moved) > 0.0;
            let stuck = if at_once { 0.0 } else { onset(deflection, *moved, [limit; 2]) };
            let held = if at_once { deflection } else { sum(deflection, scaled(stuck, *moved)) };
            let decay = (-(1.0 - stuck) * way / limit).exp();
            let end = turned_by(held, limit, *along, decay, limit);
            let slip = difference(*moved, difference(end, deflection));
            let dissipation = 0.5 * dot(sum(held, end), slip);
            let work = dissipation + 0.5 * dot(difference(end, deflection), sum(end, deflection));
            out.push(end, &Passed { slip, dissipation, jump_loss: 0.0, work });
            out.slip_path += length(slip);
            (deflection, slides) = (end, true);
        }
        if self.mirrored { scaled(-1.0, deflection) } else { deflection }
    }
}

/// Adds the second half of a period, the opposite of the first.
fn turn(out: &mut SpringCycle) {
    let half = out.slip.len();
    for values in [&mut out.slip, &mut out.deflection] {
        values.extend_from_within(..);
        values[half..].iter_mut().for_each(|value| *value = scaled(-1.0, *value));
    }
    for value in [&mut out.slip_path, &mut out.dissipation, &mut out.work] {
        *value *= 2.0;
    }
}

/// Whether the second half of a path goes the way of the first in the opposite direction, as on an ellipse.
fn goes_back(path: &Path) -> bool {
    let half = path.points.len() / 2;
    if !path.points.len().is_multiple_of(2) {
        return false;
    }
    let places: Vec<[f64; 2]> = path.points.iter().map(|point| point.tangential).collect();
    let reach = places.iter().map(|place| length(difference(*place, places[0]))).fold(0.0, f64::max);
    let middle = |m: usize| sum(places[m], places[m + half]);
    (1..half).all(|m| length(difference(middle(m), middle(0))) <= SAME * reach)
}
