//! Lagrange polynomials on a few nodes.

use super::MOST_POINTS;

/// Lagrange polynomials on a few neighbouring nodes.
///
/// # Arguments
/// * `nodes` -- distinct nodes, shape `(m,)`
/// * `x` -- where to evaluate
/// * `values` -- receives the `m` polynomials at `x`
pub fn lagrange(nodes: &[f64], x: f64, values: &mut [f64]) {
    for (a, value) in values.iter_mut().enumerate().take(nodes.len()) {
        *value = 1.0;
        for (b, node) in nodes.iter().enumerate() {
            if b != a {
                *value *= (x - node) / (nodes[a] - node);
            }
        }
    }
}

/// Lagrange polynomials on the nodes `0, 1, ... m - 1` at `x`: as [`lagrange`], with the products of differences formed once.
pub(super) fn lagrange_even(m: usize, x: f64) -> [f64; MOST_POINTS] {
    match m {
        4 => lagrange_on_first::<4>(x),
        6 => lagrange_on_first::<6>(x),
        _ => {
            let (mut nodes, mut values) = ([0.0; MOST_POINTS], [0.0; MOST_POINTS]);
            (0..m).for_each(|i| nodes[i] = i as f64);
            lagrange(&nodes[..m], x, &mut values);
            values
        }
    }
}

fn lagrange_on_first<const M: usize>(x: f64) -> [f64; MOST_POINTS] {
    let mut values = [0.0; MOST_POINTS];
    let mut before = 1.0;
    for (a, value) in values.iter_mut().enumerate().take(M) {
        *value = before;
        before *= (x - a as f64) * (1.0 / (a + 1) as f64);
    }
    let mut behind = 1.0;
    for a in (0..M).rev() {
        values[a] *= behind;
        behind *= (a as f64 - x) * (1.0 / (M - a) as f64);
    }
    values
}

/// Derivatives of the Lagrange polynomials of [`lagrange`].
pub fn lagrange_derivative(nodes: &[f64], x: f64, values: &mut [f64]) {
    let m = nodes.len();
    for (a, value) in values.iter_mut().enumerate().take(m) {
        *value = (0..m)
            .filter(|&c| c != a)
            .map(|c| {
                let others = (0..m).filter(|&b| b != a && b != c);
                others.map(|b| (x - nodes[b]) / (nodes[a] - nodes[b])).product::<f64>()
                    / (nodes[a] - nodes[c])
            })
            .sum();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lagrange_reproduces_a_cubic_and_its_slope() {
        let nodes = [0.1, 0.4, 0.5, 1.0];
        let (mut value, mut slope) = ([0.0; 4], [0.0; 4]);
        lagrange(&nodes, 0.7, &mut value);
        lagrange_derivative(&nodes, 0.7, &mut slope);
        let cubic = nodes.map(|x| x * x * x);
        let even: [f64; MOST_POINTS] = std::array::from_fn(|i| i as f64);
        for (m, x) in [(4, 0.3), (6, 2.75), (6, 5.5)] {
            let mut plain = [0.0; MOST_POINTS];
            lagrange(&even[..m], x, &mut plain);
            let quick = lagrange_even(m, x);
            assert!(plain.iter().zip(&quick).all(|(a, b)| (a - b).abs() < 1e-14), "{plain:?} {quick:?}");
        }
        let dot = |weights: [f64; 4]| weights.iter().zip(cubic).map(|(w, y)| w * y).sum::<f64>();
        assert!((dot(value) - 0.343).abs() < 1e-14, "{}", dot(value));
        assert!((dot(slope) - 1.47).abs() < 1e-13, "{}", dot(slope));
    }
}
