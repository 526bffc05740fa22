//! Even splines of the fifth degree, and the banded systems of their coefficients.

use crate::numerics::quadrature::Rule;

/// Order of the B-splines: one more than their degree.
const ORDER: usize = 6;
/// Diagonals beside the main one on each side.
pub(super) const BANDWIDTH: usize = ORDER - 1;

/// Splines `s(-x) = s(x)` of the fifth degree on knots from 0 to 1, by B-splines, those that are images of each other taken together.
///
/// Unknown `j` belongs to the B-spline in the middle of whose support the knot `j` lies.
#[derive(Debug, Clone)]
pub(super) struct EvenSpline {
    knots: Vec<f64>,
}

impl EvenSpline {
    /// A spline whose knots are among some places, at least `1/pieces` apart but where these are fewer.
    ///
    /// # Arguments
    /// * `places` -- increasing from 0 to 1
    pub(super) fn new(places: &[f64], pieces: usize) -> Self {
        let apart = (1.0 - 1e-9) / pieces as f64;
        let mut knots = vec![0.0];
        for place in places {
            if *place - knots[knots.len() - 1] >= apart && 1.0 - *place >= apart {
                knots.push(*place);
            }
        }
        knots.push(1.0);
        Self { knots }
    }

    pub(super) fn knots(&self) -> &[f64] {
        &self.knots
    }

    pub(super) fn pieces(&self) -> usize {
        self.knots.len() - 1
    }

    pub(super) fn unknowns(&self) -> usize {
        self.pieces() + ORDER / 2
    }

    /// The knots, and between them as many places in each piece as make `fewest` pieces.
    pub(super) fn divided(&self, fewest: usize) -> Vec<f64> {
        let parts = fewest.div_ceil(self.pieces());
        let mut places = vec![0.0];
        for pair in self.knots.windows(2) {
            let between = (1..parts).map(|part| pair[0] + (pair[1] - pair[0]) * part as f64 / parts as f64);
            places.extend(between.filter(|x| *x > pair[0] && *x < pair[1]));
            places.push(pair[1]);
        }
        places
    }

    /// The piece that holds a place.
    pub(super) fn piece(&self, x: f64) -> usize {
        (self.knots.partition_point(|knot| *knot <= x).max(1) - 1).min(self.pieces() - 1)
    }

    /// Knot of any number: mirrored below 0, and going on beyond 1.
    fn knot(&self, number: isize) -> f64 {
        let (last, place) = (self.pieces(), number.unsigned_abs());
        let knot = match self.knots.get(place) {
            Some(knot) => *knot,
            None => 1.0 + (place - last) as f64 * (1.0 - self.knots[last - 1]),
        };
        if number < 0 { -knot } else { knot }
    }

    /// The first of six unknowns, and what each contributes to a derivative at a place.
    pub(super) fn basis(&self, x: f64, derivative: usize) -> (usize, [f64; ORDER]) {
        let piece = self.piece(x) as isize;
        let mut values = [0.0; ORDER];
        values[0] = 1.0;
        for order in 2..=ORDER {
            let lower = values;
            for (place, value) in values.iter_mut().enumerate().take(order) {
                // The B-spline of this order that begins at the knot `start`, from the two of the order below.
                let start = piece + 1 - order as isize + place as isize;
                let end = start + order as isize;
                let [first, last] = [self.knot(start), self.knot(end)];
                let rising = if place > 0 { lower[place - 1] / (self.knot(end - 1) - first) } else { 0.0 };
                let falling =
                    if place + 1 < order { lower[place] / (last - self.knot(start + 1)) } else { 0.0 };
                *value = match order + derivative > ORDER {
                    true => (order - 1) as f64 * (rising - falling),
                    false => (x - first) * rising + (last - x) * falling,
                };
            }
        }
        self.folded(piece, values)
    }

    /// Contributions of the B-splines that are alive in a piece, with those of the images added to their own.
    fn folded(&self, piece: isize, values: [f64; ORDER]) -> (usize, [f64; ORDER]) {
        let centre = |place: usize| piece - 2 + place as isize;
        let first = centre(0).max(0) as usize;
        let mut folded = [0.0; ORDER];
        for (place, value) in values.into_iter().enumerate() {
            folded[centre(place).unsigned_abs() - first] += value;
        }
        // Of very few unknowns the last ones are none; what is there is zero.
        (first, folded)
    }

    /// A derivative at a place.
    pub(super) fn value(&self, coefficients: &[f64], x: f64, derivative: usize) -> f64 {
        let (first, values) = self.basis(x, derivative);
        values.iter().zip(&coefficients[first..]).map(|(value, c)| value * c).sum()
    }

    /// Products of the third derivatives, `∫_0^1 B_i''' B_j''' dx`: polynomials of the fourth degree, which three nodes integrate.
    pub(super) fn roughness(&self) -> Banded {
        let rule = Rule::legendre(3).expect("three nodes are few");
        let mut products = Banded::new(self.unknowns());
        for pair in self.knots.windows(2) {
            let width = pair[1] - pair[0];
            for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
                let (first, third) = self.basis(pair[0] + width * node, 3);
                products.add(first, &third, width * weight);
            }
        }
        products
    }
}

/// A symmetric matrix with [`BANDWIDTH`] diagonals beside the main one: of each row the entries up to the diagonal, that last.
#[derive(Debug, Clone)]
pub(super) struct Banded {
    rows: Vec<[f64; ORDER]>,
}

impl Banded {
    pub(super) fn new(size: usize) -> Self {
        Self { rows: vec![[0.0; ORDER]; size] }
    }

    /// Adds `weight v vᵀ`, `v` beginning at a place.
    pub(super) fn add(&mut self, first: usize, values: &[f64; ORDER], weight: f64) {
        let size = self.rows.len();
        for (i, value) in values.iter().enumerate().take(size - first) {
            for (j, other) in values.iter().enumerate().take(i + 1) {
                self.rows[first + i][BANDWIDTH - (i - j)] += weight * value * other;
            }
        }
    }

    /// `A + w B`.
    pub(super) fn plus(&self, other: &Self, weight: f64) -> Self {
        let sum = |(a, b): (&[f64; ORDER], &[f64; ORDER])| std::array::from_fn(|i| a[i] + weight * b[i]);
        Self { rows: self.rows.iter().zip(&other.rows).map(sum).collect() }
    }

    pub(super) fn diagonal(&self, place: usize) -> f64 {
        self.rows[place.min(self.rows.len() - 1)][BANDWIDTH]
    }

    pub(super) fn trace(&self) -> f64 {
        (0..self.rows.len()).map(|i| self.diagonal(i)).sum()
    }

    /// `xᵀ A x`.
    pub(super) fn form(&self, x: &[f64]) -> f64 {
        let row = |(i, row): (usize, &[f64; ORDER])| {
            let before = i.min(BANDWIDTH);
            let beside: f64 = (1..=before).map(|j| row[BANDWIDTH - j] * x[i - j]).sum();
            x[i] * (row[BANDWIDTH] * x[i] + 2.0 * beside)
        };
        self.rows.iter().enumerate().map(row).sum()
    }

    /// Cholesky's factor of a positive definite matrix; not numbers where it is none.
    pub(super) fn factor(mut self) -> Factor {
        for i in 0..self.rows.len() {
            for j in i.saturating_sub(BANDWIDTH)..=i {
                let common = i.saturating_sub(BANDWIDTH)..j;
                let sum: f64 = common.map(|k| self.entry(i, k) * self.entry(j, k)).sum();
                let rest = self.entry(i, j) - sum;
                self.rows[i][BANDWIDTH - (i - j)] =
                    if i == j { rest.sqrt() } else { rest / self.entry(j, j) };
            }
        }
        Factor { lower: self }
    }

    /// An entry below the diagonal or on it, within the band.
    fn entry(&self, row: usize, column: usize) -> f64 {
        self.rows[row][BANDWIDTH - (row - column)]
    }
}

/// Cholesky's factor of a banded matrix.
pub(super) struct Factor {
    lower: Banded,
}

impl Factor {
    /// Solution of `A x = b`.
    pub(super) fn solve(&self, mut right: Vec<f64>) -> Vec<f64> {
        let (lower, size) = (&self.lower, right.len());
        for i in 0..size {
            let sum: f64 = (i.saturating_sub(BANDWIDTH)..i).map(|k| lower.entry(i, k) * right[k]).sum();
            right[i] = (right[i] - sum) / lower.entry(i, i);
        }
        for i in (0..size).rev() {
            let sum: f64 = (i + 1..size.min(i + ORDER)).map(|k| lower.entry(k, i) * right[k]).sum();
            right[i] = (right[i] - sum) / lower.entry(i, i);
        }
        right
    }

    /// Trace of `A⁻¹ B`, of the entries of the inverse within the band (Hutchinson and de Hoog, Numerische Mathematik 47 (1985) 99).
    pub(super) fn trace_of_solution(&self, other: &Banded) -> f64 {
        let (lower, size) = (&self.lower, self.lower.rows.len());
        let mut inverse = Banded::new(size);
        for i in (0..size).rev() {
            let diagonal = lower.entry(i, i);
            let below = i + 1..size.min(i + ORDER);
            for j in below.clone().rev().chain([i]) {
                let sum: f64 =
                    below.clone().map(|k| lower.entry(k, i) * inverse.entry(k.max(j), k.min(j))).sum();
                let own = if i == j { diagonal.recip() } else { 0.0 };
                inverse.rows[j][BANDWIDTH - (j - i)] = (own - sum) / diagonal;
            }
        }
        let row = |i: usize| {
            let before = i.saturating_sub(BANDWIDTH)..i;
            let beside: f64 = before.map(|j| inverse.entry(i, j) * other.entry(i, j)).sum();
            inverse.entry(i, i) * other.entry(i, i) + 2.0 * beside
        };
        (0..size).map(row).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splines_hold_even_polynomials_and_their_derivatives() {
        let places = [0.0, 0.02, 0.1, 0.13, 0.3, 0.5, 0.55, 0.8, 1.0];
        let spline = EvenSpline::new(&places, 1000);
        assert_eq!(spline.knots(), places);
        // Least squares on many points give back what the spline can hold.
        let mut products = Banded::new(spline.unknowns());
        let mut right = vec![0.0; spline.unknowns()];
        let f = |x: f64| 2.0 - 3.0 * x * x + 0.7 * x.powi(4);
        for i in 0..=1000 {
            let x = f64::from(i) / 1000.0;
            let (first, values) = spline.basis(x, 0);
            assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-14, "{x}: {values:?}");
            products.add(first, &values, 1.0);
            (0..ORDER).for_each(|j| right[first + j] += values[j] * f(x));
        }
        let factor = products.clone().factor();
        // The trace of the identity.
        assert!((factor.trace_of_solution(&products) - spline.unknowns() as f64).abs() < 1e-6);
        let coefficients = factor.solve(right);
        for x in [0.0, 0.01, 0.13, 0.4, 0.77, 1.0] {
            let found = [0, 1, 2, 3].map(|derivative| spline.value(&coefficients, x, derivative));
            let exact = [f(x), -6.0 * x + 2.8 * x.powi(3), -6.0 + 8.4 * x * x, 16.8 * x];
            let error = (0..4).map(|i| (found[i] - exact[i]).abs()).fold(0.0, f64::max);
            assert!(error < 1e-8, "x = {x}: {found:?} against {exact:?}");
        }
        // ∫ (16.8 x)² dx.
        let roughness = spline.roughness().form(&coefficients);
        assert!((roughness / (16.8 * 16.8 / 3.0) - 1.0).abs() < 1e-9, "{roughness}");
    }
}
