//! Smooth curves through nodes.

/// A monotone cubic through nodes (Fritsch and Carlson): between two nodes it stays between their values, so that nothing is drawn that is
/// not in the data.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    x: Vec<f64>,
    y: Vec<f64>,
    slopes: Vec<f64>,
}

impl Curve {
    /// # Arguments
    /// * `x` -- places of the nodes, increasing, shape `(n,)`
    /// * `y` -- values, shape `(n,)`
    ///
    /// # Panics
    /// If the shapes differ or are empty.
    pub(super) fn new(x: &[f64], y: &[f64]) -> Self {
        assert!(x.len() == y.len() && !x.is_empty(), "{} places, {} values", x.len(), y.len());
        let secants: Vec<f64> =
            x.windows(2).zip(y.windows(2)).map(|(x, y)| (y[1] - y[0]) / (x[1] - x[0])).collect();
        let slope = |i: usize| match (i.checked_sub(1).and_then(|i| secants.get(i)), secants.get(i)) {
            (Some(&before), Some(&after)) if before * after > 0.0 => {
                // The weighted harmonic mean of Fritsch and Butland.
                let [left, right] = [x[i] - x[i - 1], x[i + 1] - x[i]];
                let [one, other] = [2.0 * right + left, right + 2.0 * left];
                (one + other) / (one / before + other / after)
            }
            (Some(_), Some(_)) | (None, None) => 0.0,
            (Some(&only), None) | (None, Some(&only)) => only,
        };
        let slopes = (0..x.len()).map(slope).collect();
        Self { x: x.to_vec(), y: y.to_vec(), slopes }
    }

    /// The nodes with `parts` points to each interval.
    pub(super) fn points(&self, parts: usize) -> Vec<[f64; 2]> {
        let mut points = vec![[self.x[0], self.y[0]]];
        for i in 1..self.x.len() {
            let width = self.x[i] - self.x[i - 1];
            for part in 1..=parts {
                let t = part as f64 / parts as f64;
                points.push([self.x[i - 1] + t * width, self.between(i, t)]);
            }
        }
        points
    }

    /// Value at the part `t` of the way from node `i - 1` to node `i`.
    fn between(&self, i: usize, t: f64) -> f64 {
        let width = self.x[i] - self.x[i - 1];
        let s = 1.0 - t;
        let [before, after] = [self.y[i - 1], self.y[i]];
        let value = s * s * (1.0 + 2.0 * t) * before
            + t * t * (1.0 + 2.0 * s) * after
            + width * s * t * (s * self.slopes[i - 1] - t * self.slopes[i]);
        // But for round-off it is between them already.
        value.max(before.min(after)).min(before.max(after))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_monotone_curve_meets_its_nodes_and_never_leaves_them() {
        let x: Vec<f64> = (0..9).map(|i| f64::from(i) * (1.0 + 0.1 * f64::from(i))).collect();
        let y = [0.0, 0.0, 1.0, 1.0, 0.2, 0.19, 5.0, 5.0, -1.0];
        let points = Curve::new(&x, &y).points(7);
        for (i, (x, y)) in x.iter().zip(y).enumerate() {
            assert!(
                (points[7 * i][0] - x).abs() < 1e-12 && points[7 * i][1] == y,
                "{i}: {:?}",
                points[7 * i]
            );
        }
        for (i, pair) in y.windows(2).enumerate() {
            for [_, value] in &points[7 * i..=7 * (i + 1)] {
                assert!((pair[0].min(pair[1])..=pair[0].max(pair[1])).contains(value), "{i}: {value}");
            }
        }
    }

    #[test]
    fn a_smooth_monotone_function_is_met_to_third_order_or_better() {
        let error = |count: usize| {
            let x: Vec<f64> = (0..=count).map(|i| i as f64 / count as f64).collect();
            let y: Vec<f64> = x.iter().map(|x| x.exp()).collect();
            let inner =
                |points: Vec<[f64; 2]>| points.into_iter().filter(|point| point[0] > 0.3 && point[0] < 0.7);
            inner(Curve::new(&x, &y).points(4)).map(|[x, y]| (y - x.exp()).abs()).fold(0.0, f64::max)
        };
        let order = (error(20) / error(40)).log2();
        assert!(order > 2.7, "{} {} {order}", error(20), error(40));
    }
}
