//! Series on pieces of an interval, for functions that no single series resolves.

use std::collections::BinaryHeap;
use std::f64::consts::PI;

/// Terms of the series of a piece.
const TERMS: usize = 12;

/// A piece that may be halved; the largest is that whose last terms are the largest.
struct Waiting {
    tail: f64,
    ends: [f64; 2],
    series: [f64; TERMS],
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.tail.total_cmp(&other.tail).then(self.ends[0].total_cmp(&other.ends[0]))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Waiting {}

/// A function on `[0, end]` as Chebyshev series on pieces, each half, a quarter ... of the interval, that resolve it locally.
///
/// A value and a derivative cost the same however many pieces there are.
#[derive(Debug, Clone)]
pub struct PiecewiseChebyshev {
    end: f64,
    /// Ends of the pieces, from 0.
    edges: Vec<f64>,
    series: Vec<[f64; TERMS]>,
    unresolved: f64,
    /// The piece in which each of so many equal parts of the interval begins.
    index: Vec<u32>,
}

impl PiecewiseChebyshev {
    /// Interpolates `function` on `[0, end]`, halving pieces until the last terms are at most the fraction `accuracy` of the largest.
    ///
    /// # Arguments
    /// * `accuracy` -- as a function of the number of pieces so far, the least resolved of which is halved next: so work can be bounded
    /// * `narrowest` -- width below which the piece that holds a place is not halved any more
    pub fn fit(
        function: impl Fn(f64) -> f64,
        end: f64,
        accuracy: impl Fn(usize) -> f64,
        narrowest: impl Fn(f64) -> f64,
    ) -> Self {
        let angle = |i: usize| PI * (i as f64 + 0.5) / TERMS as f64;
        let points: [f64; TERMS] = std::array::from_fn(|i| (0.5 * angle(i)).cos().powi(2));
        let projection: [[f64; TERMS]; TERMS] = std::array::from_fn(|j| {
            std::array::from_fn(|i| {
                (j as f64 * angle(i)).cos() * if j == 0 { 1.0 } else { 2.0 } / TERMS as f64
            })
        });
        let mut fitted =
            Self { end, edges: vec![0.0], series: Vec::new(), unresolved: 0.0, index: Vec::new() };
        let (mut done, mut waiting) = (Vec::new(), BinaryHeap::new());
        let finest = accuracy(0);
        let ask = |done: &mut Vec<Waiting>, waiting: &mut BinaryHeap<Waiting>, low: f64, high: f64| {
            let width = high - low;
            let values = points.map(|point| function(low + width * point));
            let series = projection.map(|row| row.iter().zip(&values).map(|(a, b)| a * b).sum::<f64>());
            let largest = series.iter().fold(0.0, |most: f64, term| most.max(term.abs()));
            let tail = series[TERMS - 3..].iter().fold(0.0, |most: f64, term| most.max(term.abs()));
            let middle = low + 0.5 * width;
            let piece = Waiting { tail: tail / largest, ends: [low, high], series };
            // What is no number is not resolved by more pieces.
            let halved =
                tail > finest * largest && width > narrowest(middle) && low < middle && middle < high;
            if halved { waiting.push(piece) } else { done.push(piece) }
        };
        ask(&mut done, &mut waiting, 0.0, end);
        while let Some(worst) = waiting.pop() {
            if worst.tail <= accuracy(done.len() + waiting.len() + 1) {
                waiting.push(worst);
                break;
            }
            let [low, high] = worst.ends;
            let middle = low + 0.5 * (high - low);
            ask(&mut done, &mut waiting, low, middle);
            ask(&mut done, &mut waiting, middle, high);
        }
        fitted.unresolved = waiting.peek().map_or(0.0, |worst| worst.tail);
        done.extend(waiting);
        done.sort_by(|a, b| a.ends[0].total_cmp(&b.ends[0]));
        for piece in done {
            fitted.edges.push(piece.ends[1]);
            fitted.series.push(piece.series);
        }
        let parts = fitted.series.len();
        let start = |part: usize| {
            let place = end * part as f64 / parts as f64;
            (fitted.edges.partition_point(|edge| *edge <= place) - 1).min(parts - 1) as u32
        };
        fitted.index = (0..parts).map(start).collect();
        fitted
    }

    /// Ends of the pieces, shape `(pieces + 1,)`, increasing from 0.
    pub fn edges(&self) -> &[f64] {
        &self.edges
    }

    /// Largest last term of a piece that was not halved for the sake of work, as a part of its largest; else zero.
    pub fn unresolved(&self) -> f64 {
        self.unresolved
    }

    /// The piece that holds `x`, and twice the place in it, from -1 to 1.
    fn locate(&self, x: f64) -> (usize, f64) {
        let parts = self.index.len();
        let part = ((x / self.end * parts as f64) as usize).min(parts - 1);
        let first = self.index[part] as usize;
        let last = self.index.get(part + 1).map_or(parts - 1, |next| *next as usize);
        let within = &self.edges[first + 1..=last];
        let piece = first + within.partition_point(|edge| *edge <= x);
        let (low, high) = (self.edges[piece], self.edges[piece + 1]);
        (piece, 2.0 * (2.0 * (x - low) / (high - low) - 1.0))
    }

    /// Value at `x` in `[0, end]`, by Clenshaw's recurrence.
    pub fn value(&self, x: f64) -> f64 {
        let (piece, y2) = self.locate(x);
        let series = &self.series[piece];
        let (mut b1, mut b2) = (0.0, 0.0);
        for &c in series[1..].iter().rev() {
            (b1, b2) = (c + y2 * b1 - b2, b1);
        }
        series[0] + 0.5 * y2 * b1 - b2
    }

    /// Value and derivative at `x` in `[0, end]`, by Clenshaw's recurrence.
    pub fn value_and_derivative(&self, x: f64) -> (f64, f64) {
        let (piece, y2) = self.locate(x);
        let series = &self.series[piece];
        let (mut b1, mut b2, mut d1, mut d2) = (0.0, 0.0, 0.0, 0.0);
        for &c in series[1..].iter().rev() {
            (d1, d2) = (2.0 * b1 + y2 * d1 - d2, d1);
            (b1, b2) = (c + y2 * b1 - b2, b1);
        }
        let width = self.edges[piece + 1] - self.edges[piece];
        (series[0] + 0.5 * y2 * b1 - b2, (b1 + 0.5 * y2 * d1 - d2) * 2.0 / width)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thousand_waves_and_a_kink_are_followed_in_value_and_derivative() {
        let wave = 2000.0 * PI;
        let function = |x: f64| 2.0 + x + 1e-3 * (wave * x).sin() + (x - 0.3f64).max(0.0).powf(2.5);
        let series = PiecewiseChebyshev::fit(function, 1.1, |_| 1e-12, |_| 1e-4);
        let mut worst = [0.0f64; 2];
        for x in (0..=5000).map(|i| 1.1 * f64::from(i) / 5000.0) {
            let (value, derivative) = series.value_and_derivative(x);
            assert_eq!(value, series.value(x));
            let slope = 1.0 + 1e-3 * wave * (wave * x).cos() + 2.5 * (x - 0.3f64).max(0.0).powf(1.5);
            worst = [worst[0].max((value - function(x)).abs()), worst[1].max((derivative - slope).abs())];
        }
        println!("{worst:?}, {} pieces", series.edges().len() - 1);
        assert!(worst[0] < 2e-11 && worst[1] < 1e-6, "{worst:?}");
    }

    #[test]
    fn work_is_bounded_where_the_function_is_rough_and_goes_to_the_worst_places() {
        let asked = std::cell::Cell::new(0usize);
        let rough = |x: f64| {
            asked.set(asked.get() + 1);
            1.0 + 1e-6 * (1e6 * x).sin() + 1e-2 * (x - 0.3).abs().sqrt()
        };
        let bounded = |pieces| if pieces < 100 { 1e-12 } else { f64::INFINITY };
        let series = PiecewiseChebyshev::fit(rough, 1.0, bounded, |_| 0.0);
        let pieces = series.edges().len() - 1;
        let near = series.edges().windows(2).find(|pair| pair[1] > 0.3).map_or(1.0, |pair| pair[1] - pair[0]);
        println!(
            "{pieces} pieces, {} values, {:e} unresolved, {near:e} wide at the cusp",
            asked.get(),
            series.unresolved()
        );
        assert!(pieces == 100 && asked.get() == 12 * 199, "{pieces} pieces, {} values", asked.get());
        assert!(near < 1e-4 && series.unresolved() > 1e-7 && series.unresolved() < 1e-5);
        let smooth = PiecewiseChebyshev::fit(f64::exp, 1.0, bounded, |_| 0.0);
        // On the whole interval its tenth term is 2e-11.
        assert_eq!((smooth.edges().len(), smooth.unresolved()), (3, 0.0));
    }

    #[test]
    fn a_function_that_is_no_number_ends() {
        let series = PiecewiseChebyshev::fit(|_| f64::NAN, 1.0, |_| 1e-12, |_| 1e-9);
        assert!(series.value(0.5).is_nan() && series.edges().len() == 2);
    }
}
