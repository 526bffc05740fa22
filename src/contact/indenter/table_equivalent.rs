//! The equivalent profile of a measured profile.

use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;

use super::cubic::Cubic;
use super::equivalent::Equivalent;
use super::power_law::power_law_factor;
use super::table_rise::RiseTransform;
use super::table_transform::Transform;
use crate::error::{Error, Result};
use crate::numerics::quadrature::Rule;
use crate::numerics::roots;

/// Fall of `g` from one knot to the next, relative, that is rounding: where a wave is flat, a million rows rise by less.
const ROUNDING: f64 = 1e-13;

/// Pieces of `g` to one of `f`.
const DIVISIONS: usize = 2;

/// Nodes for `x^(1+k)` over a piece no longer than its distance from the axis.
const LOAD_NODES: usize = 12;

/// Pieces looked at one by one for the place to which `g` falls, before a search by halves.
const MOST_WALKED: usize = 64;

/// Equivalent profile `g` [S, Eq. (19)] of a measured profile: value and slope at the rows and halfway between them by
/// [`Transform`], cubics in between.
///
/// Rows of a power law with the exponent 1, 2 or 3 give its `g` but for rounding. Else the error is that of the table: against a sphere in to
/// half its radius it falls with the power 3.6 to 4 of the number of rows for `k >= 0`, with the power 3 as `k → -1`.
#[derive(Debug)]
pub(super) struct TabulatedEquivalent {
    pub(super) grading: f64,
    exponent: f64,
    curve: Arc<Cubic>,
    /// Load integral at the contact radii that are knots.
    loads: Vec<f64>,
    rule: Rule,
    /// Knot up to which `g` rises.
    rising: usize,
    /// Knot beyond that up to which it falls; the same where the table ends.
    falling: usize,
    /// The last transform that was asked for: the limit and the model of one contact need the same.
    transform: Mutex<Option<Arc<RiseTransform>>>,
}

impl TabulatedEquivalent {
    /// The equivalent of a curve.
    ///
    /// # Arguments
    /// * `largest` -- radius at which its rows end, m
    pub(super) fn new(profile: &Cubic, largest: f64, grading: f64) -> Result<Self> {
        let transform = Transform::new(profile, grading)?;
        let radii = profile.knots();
        let count = DIVISIONS * (radii.len() - 1) + 1;
        let (mut knots, mut values, mut slopes) = (Vec::new(), Vec::new(), Vec::new());
        knots.reserve(count);
        knots.push(0.0);
        values.push(0.0);
        slopes.push(power_law_factor(1.0, grading) * profile.derivative(0.0));
        let share = |part: usize| part as f64 / DIVISIONS as f64;
        // Each by itself, so that threads change nothing; a few rows are not worth one.
        let pieces = (0..radii.len() - 1).into_par_iter().with_min_len(256);
        let found: Vec<[[f64; 2]; DIVISIONS]> =
            pieces.map(|piece| std::array::from_fn(|part| transform.at(piece, share(part + 1)))).collect();
        for (piece, pair) in radii.windows(2).enumerate() {
            for part in 1..=DIVISIONS {
                let (share, [value, slope]) = (share(part), found[piece][part - 1]);
                let knot = if part == DIVISIONS { pair[1] } else { pair[0] + share * (pair[1] - pair[0]) };
                // Rows as close as numbers can be have none between them.
                if knot > knots[knots.len() - 1] && (part == DIVISIONS || knot < pair[1]) {
                    knots.push(knot);
                    values.push(value * largest);
                    slopes.push(slope);
                }
            }
        }
        even_out(&mut values);
        let curve = Cubic::new(knots, &values, slopes);
        let last = values.len() - 1;
        if !(0..=last).all(|i| curve.piece(i).iter().all(|it| it.is_finite())) {
            return Err(Error::Inconsistent {
                what: "indenter.table",
                why: "its equivalent profile is too large to compute with; check the units".into(),
            });
        }
        let rises = |i: &usize| values[i + 1] > values[*i] || values[i + 1] == 0.0;
        let rising = (0..last).take_while(rises).count();
        let falling = rising + (rising..last).take_while(|&i| values[i + 1] <= values[i]).count();
        let mut equivalent = Self {
            grading,
            exponent: 1.0 + grading,
            curve: Arc::new(curve),
            loads: vec![0.0],
            rule: Rule::legendre(LOAD_NODES)?,
            rising,
            falling,
            transform: Mutex::new(None),
        };
        for i in 0..rising {
            let width = equivalent.curve.knots()[i + 1] - equivalent.curve.knots()[i];
            equivalent.loads.push(equivalent.loads[i] + equivalent.load(i, width));
        }
        Ok(equivalent)
    }

    /// The last piece whose left knot has at most `value` of something that grows from knot to knot as far as `g` rises.
    fn last_at_most(&self, value: f64, at_knot: impl Fn(usize) -> f64) -> usize {
        let (mut low, mut high) = (0, self.rising);
        while high - low > 1 {
            let middle = (low + high) / 2;
            if at_knot(middle) <= value { low = middle } else { high = middle }
        }
        low
    }

    /// Part of the load integral that comes from a piece up to the distance `t` from its knot; by parts, so that every term is positive.
    ///
    /// ```text
    /// 2 ∫ x^k (g(a) - g(x)) dx = 2/(1+k) ∫ x^(1+k) g'(x) dx
    /// ```
    fn load(&self, piece: usize, t: f64) -> f64 {
        let (q, left) = (self.exponent, self.curve.knots()[piece]);
        let [_, slope, square, cube] = self.curve.piece(piece);
        let right = left + t;
        if right <= 2.0 * left {
            let mean = self.rule.mean(|v| {
                let u = t * v;
                (left + u).powf(q) * (slope + u * (2.0 * square + 3.0 * u * cube))
            });
            return 2.0 / q * t * mean;
        }
        // In powers of x: next to the axis nothing cancels.
        let powers = [
            slope - left * (2.0 * square - 3.0 * left * cube),
            2.0 * (square - 3.0 * left * cube),
            3.0 * cube,
        ];
        let term = |(j, coefficient): (usize, f64)| {
            let power = q + 1.0 + j as f64;
            coefficient * (right.powf(power) - left.powf(power)) / power
        };
        2.0 / q * powers.into_iter().enumerate().map(term).sum::<f64>()
    }

    fn unreachable(&self, what: &str) -> Error {
        Error::Inconsistent {
            what: "contact radius",
            why: format!("{what} is too much: {}", self.end_of_table().unwrap_or_default()),
        }
    }
}

impl Equivalent for TabulatedEquivalent {
    fn grading(&self) -> f64 {
        self.grading
    }

    /// Radius up to which `g` rises.
    fn largest_radius(&self) -> f64 {
        self.curve.knots()[self.rising]
    }

    fn rise_transform(&self, radius: f64) -> Result<Option<Arc<RiseTransform>>> {
        let known = || self.transform.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(transform) = known().as_ref().filter(|it| it.radius() == radius) {
            return Ok(Some(Arc::clone(transform)));
        }
        // Not under the lock: threads may be at work on different contacts.
        let transform = Arc::new(RiseTransform::new(&self.curve, self.grading, radius)?);
        *known() = Some(Arc::clone(&transform));
        Ok(Some(transform))
    }

    /// Radius within which `g` is zero.
    fn flat_radius(&self) -> f64 {
        let above = (0..=self.rising).find(|&i| self.curve.at_knot(i) > 0.0).unwrap_or(self.rising);
        self.curve.knots()[above.saturating_sub(1)]
    }

    fn value(&self, x: f64) -> f64 {
        self.curve.value(x)
    }

    fn derivative(&self, x: f64) -> f64 {
        self.curve.derivative(x)
    }

    fn rise(&self, start: f64, offset: f64) -> f64 {
        self.curve.rise(start, offset)
    }

    fn radius_at(&self, depth: f64) -> Result<f64> {
        if depth > self.curve.at_knot(self.rising) {
            return Err(self.unreachable(&format!("an indentation of {depth:e} m")));
        }
        let below = self.last_at_most(depth, |i| self.curve.at_knot(i));
        Ok(self.curve.knots()[below] + self.curve.climb(below, depth - self.curve.at_knot(below)))
    }

    fn radius_squared_drop(&self, radius: f64, depth_drop: f64) -> f64 {
        let mut piece = self.curve.index(radius).min(self.rising.saturating_sub(1));
        let mut t = radius - self.curve.knots()[piece];
        let (mut left, mut back) = (depth_drop, 0.0);
        for walked in 0.. {
            if walked == MOST_WALKED && left > 0.0 {
                // Far enough for the difference of two values.
                let target = self.curve.at_knot(piece) + self.curve.rise_within(piece, t) - left;
                let below = self.last_at_most(target.max(0.0), |i| self.curve.at_knot(i));
                if below < piece {
                    let knots = self.curve.knots();
                    left = (self.curve.at_knot(below + 1) - target).max(0.0);
                    back += t + (knots[piece] - knots[below + 1]);
                    (piece, t) = (below, knots[below + 1] - knots[below]);
                }
            }
            if let Some(distance) = self.curve.descend(piece, t, left) {
                back += distance;
                break;
            }
            if piece == 0 {
                back = radius;
                break;
            }
            left -= self.curve.rise_within(piece, t);
            back += t;
            piece -= 1;
            t = self.curve.knots()[piece + 1] - self.curve.knots()[piece];
        }
        let back = back.min(radius);
        back * (2.0 * radius - back)
    }

    fn load_integral(&self, radius: f64) -> f64 {
        let piece = self.curve.index(radius);
        if piece >= self.rising {
            return self.loads[self.rising];
        }
        self.loads[piece] + self.load(piece, radius - self.curve.knots()[piece])
    }

    fn depth_for_load(&self, load: f64) -> Result<f64> {
        if load > self.loads[self.rising] {
            return Err(self.unreachable(&format!("F_N/c_N = {load:e} m^(2+k)")));
        }
        let below = self.last_at_most(load, |i| self.loads[i]);
        let (missing, left) = (load - self.loads[below], self.curve.knots()[below]);
        let width = self.curve.knots()[below + 1] - left;
        let part = |t: f64| self.load(below, t) - missing;
        let t = if part(width) <= 0.0 { width } else { roots::bracketed(part, 0.0, width, 0.0)? };
        Ok(self.value(left + t))
    }

    fn end_of_table(&self) -> Option<String> {
        let (radius, depth) = (self.largest_radius(), self.curve.at_knot(self.rising));
        if self.falling == self.rising {
            return Some(format!(
                "the table ends at {radius:e} m, where the equivalent profile g is {depth:e} m; measure further out, or press less deep"
            ));
        }
        Some(format!(
            "between its rows at r = {radius:e} m and {:e} m the equivalent profile g falls from {depth:e} m to {:e} m, so that the contact \
             would split into rings; where that is noise, smooth it: give the standard deviation of its heights as indenter.table.smoothing; \
             else press less deep",
            self.curve.knots()[self.falling],
            self.curve.at_knot(self.falling),
        ))
    }

    fn origin(&self, radius: f64) -> f64 {
        radius
    }

    fn rise_from(&self, origin: f64, logarithm: f64) -> f64 {
        self.rise(origin, origin * origin * (2.0 * logarithm).exp_m1())
    }

    fn logarithmic_slope_from(&self, origin: f64, logarithm: f64) -> f64 {
        let x = origin * logarithm.exp();
        x * self.derivative(x)
    }
}

/// Takes falls that are rounding out of values that rise.
fn even_out(values: &mut [f64]) {
    for i in 1..values.len() {
        let before = values[i - 1];
        if values[i] <= before && before > 0.0 && before - values[i] <= ROUNDING * before {
            values[i] = before.next_up();
        }
    }
}
