//! The discrete transforms against closed forms.

mod support;

use fretwear::numerics::abel::AbelOperators;
use fretwear::numerics::grid::{Clustering, Mesh};
use fretwear::numerics::linear::{dot, multiply};
use libm::tgamma;
use support::orders;

const GRADINGS: [f64; 11] = [-0.9999, -0.99, -0.9, -0.5, -0.2, 0.0, 0.3, 0.6, 0.9, 0.99, 0.9999];
const CELLS: usize = 40;
const MESHES: [Clustering; 3] = [Clustering::Smooth, Clustering::Cubic, Clustering::RecedingStick];

fn operators(grading: f64, cells: usize, clustering: Clustering) -> AbelOperators {
    AbelOperators::new(grading, Mesh::new(cells, clustering.stretch(1.5, 0.0), clustering)).unwrap()
}

/// `F` of the density `(ξ - b)₊^m`: `m! / (Γ(ν) Γ(m+2-ν)) (ξ - b)₊^(m+1-ν)`.
fn profile_of_power(grading: f64, m: i32, b: f64, x: f64) -> f64 {
    let nu = 0.5 * (1.0 + grading);
    let m = f64::from(m);
    if x <= b {
        return 0.0;
    }
    tgamma(m + 1.0) / (tgamma(nu) * tgamma(m + 2.0 - nu)) * (x - b).powf(m + 1.0 - nu)
}

/// `P` of the compression `(b - ξ)₊^m`: `m! Γ(ν)/Γ(m+ν) (b - ξ)₊^(m-1+ν)`.
fn pressure_of_power(grading: f64, m: i32, b: f64, x: f64) -> f64 {
    let nu = 0.5 * (1.0 + grading);
    let m = f64::from(m);
    if x >= b {
        return 0.0;
    }
    tgamma(m + 1.0) * tgamma(nu) / tgamma(m + nu) * (b - x).powf(m - 1.0 + nu)
}

/// Largest error over the rows, relative to each row, and relative to the largest row.
fn errors(matrix: &faer::Mat<f64>, data: &[f64], exact: &[f64]) -> (f64, f64) {
    let mut result = vec![0.0; exact.len()];
    multiply(matrix.as_ref(), data, &mut result);
    let largest = exact.iter().fold(0.0, |m: f64, e| m.max(e.abs()));
    let over = |scale: &dyn Fn(f64) -> f64| {
        result.iter().zip(exact).filter(|(_, e)| **e != 0.0).fold(0.0, |m: f64, (r, e)| {
            let error = ((r - e) / scale(*e)).abs();
            if error.is_nan() { f64::INFINITY } else { m.max(error) }
        })
    };
    (over(&|e| e), over(&|_| largest))
}

/// Least order, with its grading and the errors, of what `error(grading, cells)` gives on 20, 40 and 80 cells.
fn least_order(mut error: impl FnMut(f64, usize) -> f64) -> (f64, f64, Vec<f64>) {
    let found = GRADINGS.map(|grading| {
        let errors = [20, 40, 80].map(|cells| error(grading, cells));
        (orders(&errors).into_iter().fold(f64::INFINITY, f64::min), grading, errors.to_vec())
    });
    found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
}

/// Error of `F` for `Σ a ξ^m`, relative to the largest row.
fn profile_error(operators: &AbelOperators, grading: f64, terms: &[(f64, i32)]) -> f64 {
    let density = |x: &f64| terms.iter().map(|(a, m)| a * x.powi(*m)).sum::<f64>();
    let exact = |x: &f64| terms.iter().map(|(a, m)| a * profile_of_power(grading, *m, 0.0, *x)).sum();
    let data: Vec<f64> = operators.nodes()[1..].iter().map(density).collect();
    let exact: Vec<f64> = operators.nodes()[1..].iter().map(exact).collect();
    errors(operators.profile(), &data, &exact).1
}

/// Error of `P` for `Σ a (1-ξ)^m` from `from` on, relative to the largest row.
fn pressure_error(operators: &AbelOperators, grading: f64, terms: &[(f64, i32)], from: f64) -> f64 {
    let compression = |x: &f64| terms.iter().map(|(a, m)| a * (1.0 - x).powi(*m)).sum::<f64>();
    let data: Vec<f64> = operators.nodes()[1..].iter().map(compression).collect();
    let mut result = vec![0.0; data.len()];
    operators.transforms()[1].apply(&data, &mut result);
    let exact = |x: f64| terms.iter().map(|(a, m)| a * pressure_of_power(grading, *m, 1.0, x)).sum::<f64>();
    let rows = operators.nodes()[1..].iter().zip(result).filter(|(x, _)| **x >= from);
    rows.fold(0.0, |m: f64, (x, p)| m.max((p - exact(*x)).abs())) / exact(0.0)
}

#[test]
fn the_profile_is_exact_for_a_constant_and_of_the_order_of_its_polynomials() {
    let mut constant = (0.0, 0.0);
    let terms = [(2.0, 0), (1.0, 1), (0.5, 2), (3.0, 3)];
    let (order, grading, found) = least_order(|grading, cells| {
        let operators = operators(grading, cells, Clustering::Smooth);
        let of_one = profile_error(&operators, grading, &[(1.0, 0)]);
        let sum = (operators.spring_sum().iter().sum::<f64>() - 1.0).abs();
        if of_one.max(sum) > constant.0 {
            constant = (of_one.max(sum), grading);
        }
        profile_error(&operators, grading, &terms)
    });
    // Measured: 8e-14 for a constant, order 5.3; 5.7e-9 for cubics in ξ, of which the first cell is taken as constant.
    assert!(constant.0 < 8e-13, "of a constant: relative error {:e} at k = {}", constant.0, constant.1);
    assert!(order > 5.0, "order {order} at k = {grading}: {found:?}");
    for grading in GRADINGS {
        let error = profile_error(&operators(grading, CELLS, Clustering::Cubic), grading, &terms);
        assert!(error < 6e-8, "cubics at k = {grading}: relative error {error:e}");
    }
}

#[test]
fn the_pressure_is_exact_for_cubics_and_of_the_order_of_its_polynomials() {
    let terms = [(1.0, 1), (0.5, 2), (3.0, 3)];
    let (order, grading, found) = least_order(|grading, cells| {
        pressure_error(&operators(grading, cells, Clustering::Smooth), grading, &terms, 3e-5)
    });
    // Measured: order 5.1; 8.2e-12 for cubics in ξ, at k = -0.99, 2e-15 for k > 0.
    assert!(order > 4.5, "order {order} at k = {grading}: {found:?}");
    for grading in GRADINGS {
        let error = pressure_error(&operators(grading, CELLS, Clustering::Cubic), grading, &terms, 0.0);
        assert!(error < 8e-11, "cubics at k = {grading}: relative error {error:e}");
    }
}

#[test]
fn the_worn_volume_of_a_root_times_a_cubic_is_that_of_its_integral() {
    for grading in GRADINGS {
        let mu = 0.5 * (1.0 - grading);
        let operators = operators(grading, CELLS, Clustering::Smooth);
        let depth = |x: &f64| x.powf(mu) * (1.0 + x * (2.0 + x * (0.5 + 3.0 * x)));
        let depths: Vec<f64> = operators.nodes()[1..].iter().map(depth).collect();
        let exact = 1.0 / (1.0 + mu) + 2.0 / (2.0 + mu) + 0.5 / (3.0 + mu) + 3.0 / (4.0 + mu);
        let error = (dot(operators.depth_sum(), &depths) / exact - 1.0).abs();
        // Measured: 1.0e-7, at k = -0.9999.
        assert!(error < 4e-7, "k = {grading}: relative error {error:e}");
    }
}

#[test]
fn both_transforms_stay_finite_and_tend_to_the_identity_in_a_gibson_medium() {
    for grading in [-1.0 + 1e-12, 1.0 - 1e-12] {
        for clustering in MESHES {
            let operators = operators(grading, CELLS, clustering);
            for matrix in [operators.profile(), operators.pressure_by_differences()] {
                let finite = (0..CELLS).all(|j| matrix.col(j).iter().all(|value| value.is_finite()));
                assert!(finite, "k = {grading}, {clustering:?}");
            }
        }
    }
    let mut deviations = vec![];
    for gap in [1e-4, 1e-5, 1e-6] {
        let operators = operators(1.0 - gap, CELLS, Clustering::Cubic);
        let nodes = operators.nodes();
        let (density, compression): (Vec<f64>, Vec<f64>) =
            nodes[1..].iter().map(|x| (1.0 + x * x, 1.0 - x * x)).unzip();
        let (mut depth, mut pressure) = (vec![0.0; CELLS], vec![0.0; CELLS]);
        multiply(operators.profile().as_ref(), &density, &mut depth);
        operators.transforms()[1].apply(&compression, &mut pressure);
        let inner = CELLS - 1;
        let off = |a: &[f64], b: &[f64]| {
            a[..inner].iter().zip(&b[..inner]).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()))
        };
        deviations.push(off(&depth, &density).max(off(&pressure, &compression)) / gap);
    }
    assert!(
        deviations.windows(2).all(|pair| (pair[0] / pair[1] - 1.0).abs() < 0.01),
        "distance from the identity over 1-k: {deviations:?}"
    );
}
