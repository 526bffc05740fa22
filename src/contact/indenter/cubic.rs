//! Piecewise cubic interpolation with a continuous slope, which never falls where its data rise.

/// A function from 0 on, a cubic between neighbouring knots, and a straight line beyond the last.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Cubic {
    knots: Vec<f64>,
    /// Coefficients of the powers of the distance from each knot on; those of the last continue it.
    pieces: Vec<[f64; 4]>,
}

impl Cubic {
    /// Hermite interpolation; slopes with which it would fall between rising data, or rise between falling, are cut back (Hyman's
    /// filter).
    ///
    /// # Arguments
    /// * `knots` -- increasing from 0, at least two
    /// * `values`, `slopes` -- at the knots
    pub(crate) fn new(knots: Vec<f64>, values: &[f64], mut slopes: Vec<f64>) -> Self {
        let last = knots.len() - 1;
        let rate = |i: usize| (values[i + 1] - values[i]) / (knots[i + 1] - knots[i]);
        for (i, slope) in slopes.iter_mut().enumerate() {
            let (before, after) = (rate(i.saturating_sub(1)), rate(i.min(last - 1)));
            // With both slopes within three times the secant a cubic is monotone.
            let steepest = 3.0 * before.abs().min(after.abs());
            *slope = match before.signum() == after.signum() {
                true if before > 0.0 => slope.clamp(0.0, steepest),
                true => slope.clamp(-steepest, 0.0),
                false => 0.0,
            };
        }
        let piece = |i: usize| {
            let (width, rate) = (knots[i + 1] - knots[i], rate(i));
            let (start, end) = (slopes[i], slopes[i + 1]);
            let square = ((rate - start) + (rate - start) + (rate - end)) / width;
            let cube = ((start - rate) + (end - rate)) / width / width;
            [values[i], start, square, cube]
        };
        let mut pieces: Vec<_> = (0..last).map(piece).collect();
        pieces.push([values[last], slopes[last], 0.0, 0.0]);
        Self { knots, pieces }
    }

    /// Knots, increasing from 0.
    pub(crate) fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Coefficients of the piece that begins at a knot, in powers of the distance from it.
    pub(super) fn piece(&self, index: usize) -> [f64; 4] {
        self.pieces[index]
    }

    /// Value at a knot.
    pub(crate) fn at_knot(&self, index: usize) -> f64 {
        self.pieces[index][0]
    }

    /// The piece that holds `x >= 0`.
    pub(super) fn index(&self, x: f64) -> usize {
        self.knots.partition_point(|knot| *knot <= x).saturating_sub(1)
    }

    /// Value at `x >= 0`.
    pub(crate) fn value(&self, x: f64) -> f64 {
        let i = self.index(x);
        let ([constant, ..], t) = (self.pieces[i], x - self.knots[i]);
        constant + self.rise_within(i, t)
    }

    /// Slope at `x >= 0`.
    pub(crate) fn derivative(&self, x: f64) -> f64 {
        let i = self.index(x);
        let t = x - self.knots[i];
        self.mean_slope(i, t, t)
    }

    /// Divided difference between two distances from the knot of a piece.
    fn mean_slope(&self, index: usize, t: f64, u: f64) -> f64 {
        let [_, slope, square, cube] = self.pieces[index];
        slope + square * (t + u) + cube * (t * (t + u) + u * u)
    }

    /// Difference between `√(start² + offset)` and `start`: to full relative accuracy within a piece and its neighbours, to the rounding
    /// of the values farther away.
    pub(super) fn rise(&self, start: f64, offset: f64) -> f64 {
        self.rise_from(self.index(start), start, offset)
    }

    /// The same where the piece that holds the start is known.
    pub(super) fn rise_from(&self, from: usize, start: f64, offset: f64) -> f64 {
        if offset == 0.0 {
            return 0.0;
        }
        let end = (start * start + offset).max(0.0).sqrt();
        let distance = offset / (start + end);
        // Most rises end within the piece.
        let within = self.knots[from] <= end && self.knots.get(from + 1).is_none_or(|next| end < *next);
        let to = if within { from } else { self.index(end) };
        if from == to {
            let t = start - self.knots[from];
            return distance * self.mean_slope(from, t, t + distance);
        }
        let (low, high, first, last) = match from < to {
            true => (start, end, from, to),
            false => (end, start, to, from),
        };
        let (width, t) = (self.knots[first + 1] - self.knots[first], low - self.knots[first]);
        // The knot between two neighbours splits the distance, which has more digits than the end.
        let neighbours = last == first + 1;
        let beyond = match neighbours && from < to {
            true => (distance - (self.knots[last] - low)).max(0.0),
            false => high - self.knots[last],
        };
        let below = if neighbours { (distance.abs() - beyond).max(0.0) } else { width - t };
        let rise = below * self.mean_slope(first, width - below, width)
            + (self.at_knot(last) - self.at_knot(first + 1))
            + beyond * self.mean_slope(last, 0.0, beyond);
        if offset < 0.0 { -rise } else { rise }
    }

    /// Rise over the knot of a piece at the distance `t` from it.
    pub(super) fn rise_within(&self, index: usize, t: f64) -> f64 {
        t * self.mean_slope(index, 0.0, t)
    }

    /// Distance from the knot of a rising piece at which it has risen by `rise` over the knot's value; at most its width.
    pub(super) fn climb(&self, index: usize, rise: f64) -> f64 {
        let width = self.knots[index + 1] - self.knots[index];
        let missing = |t: f64| (self.rise_within(index, t) - rise, self.mean_slope(index, t, t));
        if missing(width).0 <= 0.0 { width } else { root(missing, width) }
    }

    /// Distance back from `t` in a rising piece over which it falls by `drop`; none if it does not fall so far.
    pub(super) fn descend(&self, index: usize, t: f64, drop: f64) -> Option<f64> {
        let missing = |back: f64| {
            (back * self.mean_slope(index, t - back, t) - drop, self.mean_slope(index, t - back, t - back))
        };
        (missing(t).0 >= 0.0).then(|| root(missing, t))
    }
}

/// Root between 0 and `width` of a function that rises from below zero to above, to full relative accuracy: Newton's method from 0,
/// where the smallest roots are, guarded by bisection.
fn root(function: impl Fn(f64) -> (f64, f64), width: f64) -> f64 {
    const MOST_STEPS: usize = 200;
    let (mut low, mut high, mut x) = (0.0, width, 0.0);
    for _ in 0..MOST_STEPS {
        let (value, slope) = function(x);
        if value < 0.0 {
            low = x
        } else {
            high = x
        }
        let newton = x - value / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if value == 0.0 || (next - x).abs() <= 2.0 * f64::EPSILON * next {
            return x;
        }
        x = next;
    }
    x
}
