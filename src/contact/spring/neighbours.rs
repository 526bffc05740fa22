//! Springs that slip for ever on a path at constant indentation, one after the other.

use super::enclosing::{Circle, smallest_enclosing};
use super::{Shakedown, Spring, SpringCycle, difference, dot, general_period, length, periodic, scaled, sum};
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
    limits: Vec<f64>,
    mirrored: bool,
    sticking: f64,
    /// What the last three repeat at the first point, over their limits, each with its limit.
    before: [Option<(f64, [f64; 2])>; 3],
    /// Part of a change of the deflection that the one a period later is.
    part: f64,
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
        Some(Self {
            limits: vec![0.0; path.points.len()],
            mirrored: goes_back(&path),
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
            periodic(&self.path, &law, 1.0, limit, &Shakedown::default(), true, out);
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
        self.limits.fill(limit);
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
    fn after(&self, deflection: [f64; 2], limit: f64, out: &mut SpringCycle) -> [f64; 2] {
        let points = self.path.points.len();
        let (count, sign) = if self.mirrored { (points / 2, -1.0) } else { (points, 1.0) };
        out.clear();
        let mut spring = Spring { deflection, sliding: false };
        (out.slip_path, _) = general_period(&self.path, &self.limits, count, limit, &mut spring, 1.0, out);
        scaled(sign, spring.deflection)
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
