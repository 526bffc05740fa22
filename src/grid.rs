//! Meshes of the slip annulus.

/// How strongly nodes cluster at the contact edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clustering {
    /// Spacing `n^-3` at the edge: the more accurate of the two.
    Cubic,
    /// Spacing `n^-2` at the edge: less stiff, so that explicit steps may be longer.
    Quadratic,
    /// Spacing `n^-3` at the contact edge and `n^-2` at an edge of stick that creeps: ground passes through the springs there, and finer ones
    /// amplify what they are off by.
    CreepingStick,
    /// Spacing `n^-3` at the contact edge and `n^-1` at an edge of stick that moves as fast as wear.
    MovingStick,
}

/// Nodes of the slip annulus, graded towards the stick edge and towards the contact edge.
///
/// ```text
/// ξ = expm1(Λ g(x)) / expm1(Λ),    x = 0, 1/n, ... 1,    g(x) = x³ (10 - 15 x + 6 x²)  or  x³ (4 - 3 x)
/// ```
///
/// `ξ = (s - c²)/(a² - c²)` with `s = x²` is the fraction of the annulus' area. Both ends of the annulus carry singularities of the worn
/// solution, hence the clustering of `g`; `Λ = ln(a²/c²)` spreads the nodes evenly in `ln s` where the stick zone is small.
///
/// # Arguments
/// * `cells` -- number of cells `n`, at least 1
/// * `stretch` -- `Λ >= 0`
/// * `clustering` -- at the contact edge
///
/// Returns `ξ`, shape `(cells + 1,)`, increasing from 0 to 1.
pub fn slip_annulus(cells: usize, stretch: f64, clustering: Clustering) -> Vec<f64> {
    let fraction = |i: usize| {
        let x = i as f64 / cells as f64;
        let clustered = match clustering {
            Clustering::Cubic => x.powi(4) * (15.0 + x * (10.0 * x - 24.0)),
            Clustering::Quadratic => x.powi(4) * (5.0 - 4.0 * x),
            Clustering::CreepingStick => x * x * (6.0 + x * (3.0 * x - 8.0)),
            Clustering::MovingStick => x * (3.0 + x * (x - 3.0)),
        };
        if stretch > 1e-8 { (stretch * clustered).exp_m1() / stretch.exp_m1() } else { clustered }
    };
    let mut nodes: Vec<f64> = (0..=cells).map(fraction).collect();
    nodes[cells] = 1.0;
    nodes
}

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

/// First of the `points` nodes that interpolate best in cell `cell` of nodes `1..=last`: centred, shifted inwards at the ends.
pub fn stencil_start(cell: usize, points: usize, last: usize) -> usize {
    (cell + 1).saturating_sub(points / 2).max(1).min(last + 1 - points.min(last))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_rise_from_zero_to_one_for_every_stretch() {
        for clustering in [Clustering::Cubic, Clustering::Quadratic] {
            for stretch in [0.0, 1e-12, 0.5, 5.0, 30.0] {
                let nodes = slip_annulus(50, stretch, clustering);
                assert_eq!((nodes[0], nodes[50]), (0.0, 1.0));
                assert!(nodes.windows(2).all(|pair| pair[1] > pair[0]), "stretch {stretch}: {nodes:?}");
            }
        }
    }

    #[test]
    fn lagrange_reproduces_a_cubic_and_its_slope() {
        let nodes = [0.1, 0.4, 0.5, 1.0];
        let (mut value, mut slope) = ([0.0; 4], [0.0; 4]);
        lagrange(&nodes, 0.7, &mut value);
        lagrange_derivative(&nodes, 0.7, &mut slope);
        let cubic = nodes.map(|x| x * x * x);
        let dot = |weights: [f64; 4]| weights.iter().zip(cubic).map(|(w, y)| w * y).sum::<f64>();
        assert!((dot(value) - 0.343).abs() < 1e-14, "{}", dot(value));
        assert!((dot(slope) - 1.47).abs() < 1e-13, "{}", dot(slope));
    }

    #[test]
    fn stencils_stay_inside_the_nodes() {
        assert_eq!(stencil_start(1, 4, 50), 1);
        assert_eq!(stencil_start(10, 4, 50), 9);
        assert_eq!(stencil_start(49, 4, 50), 47);
        assert_eq!(stencil_start(2, 2, 50), 2);
    }
}
