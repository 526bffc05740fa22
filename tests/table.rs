//! Measured profiles, judged by the closed forms of the shapes they were sampled from.

use std::f64::consts::PI;
use std::sync::Arc;

use fretwear::closed_form::LimitingShape;
use fretwear::indenter::{Indenter, TabulatedProfile};

const GRADINGS: [f64; 8] = [-0.9999, -0.9, -0.5, 0.0, 0.3, 0.7, 0.9, 0.9999];

fn table(radius: Vec<f64>, height: Vec<f64>) -> Indenter {
    Indenter::Table(Arc::new(TabulatedProfile::new("rows", radius, height).unwrap()))
}

/// `rows` radii from 0 to `last`, evenly spaced.
fn even(rows: usize, last: f64) -> Vec<f64> {
    (0..rows).map(|i| last * i as f64 / (rows - 1) as f64).collect()
}

/// Radii of very uneven spacing.
fn uneven(rows: usize, last: f64) -> Vec<f64> {
    let step = |i: usize| match i % 7 {
        0 => 0.05,
        3 => 2.0,
        _ => 0.6,
    };
    let mut radius = vec![0.0];
    (1..rows).for_each(|i| radius.push(radius[i - 1] + step(i)));
    let scale = last / radius[rows - 1];
    radius.iter().map(|r| r * scale).collect()
}

fn sampled(indenter: &Indenter, radius: Vec<f64>) -> Indenter {
    let height = radius.iter().map(|r| indenter.profile(*r)).collect();
    table(radius, height)
}

fn relative(found: f64, expected: f64) -> f64 {
    let error = (found / expected - 1.0).abs();
    if error.is_nan() { f64::INFINITY } else { error }
}

/// Relative errors of a0, F_N, a∞, ΔV, deepest wear and a depth at a fixed radius.
fn errors(tabulated: &Indenter, exact: &Indenter, grading: f64, depth: f64, ratio: f64) -> [f64; 6] {
    let shapes = [tabulated, exact]
        .map(|indenter| LimitingShape::from_stick_ratio(indenter, grading, depth, ratio).unwrap());
    let [found, expected] = &shapes;
    let load = |shape: &LimitingShape| {
        shape.initial_equivalent_profile().load_integral(shape.contact_radius_initial())
    };
    let offset = 0.4 * expected.slip_width_limit() * (expected.contact_radius_limit() + expected.stick_radius());
    [
        relative(found.contact_radius_initial(), expected.contact_radius_initial()),
        relative(load(found), load(expected)),
        relative(found.contact_radius_limit(), expected.contact_radius_limit()),
        relative(found.wear_volume(), expected.wear_volume()),
        relative(found.wear_depth_max(), expected.wear_depth_max()),
        relative(found.wear_depth_at_offset(offset), expected.wear_depth_at_offset(offset)),
    ]
}

#[test]
fn a_table_of_a_paraboloid_or_a_cone_has_their_limit_to_round_off() {
    let mut worst = (0.0, String::new());
    for exact in [Indenter::paraboloid(1e-2).unwrap(), Indenter::cone(0.02).unwrap()] {
        for (name, radius) in [("even", even(201, 1e-3)), ("uneven", uneven(160, 1e-3)), ("few", even(4, 1e-3))] {
            let tabulated = sampled(&exact, radius);
            for grading in GRADINGS {
                for ratio in [0.05, 0.5, 0.7, 0.99, 1.0 - 1e-6] {
                    let depth = exact.equivalent_profile(grading).unwrap().value(1e-4);
                    let found = errors(&tabulated, &exact, grading, depth, ratio);
                    for error in found {
                        if error > worst.0 {
                            worst = (error, format!("{exact:?}, {name}, k = {grading}, c/a0 = {ratio}: {found:?}"));
                        }
                    }
                }
            }
        }
    }
    println!("{worst:?}");
    assert!(worst.0 < 1e-9, "{worst:?}");
}

#[test]
fn probe() {
    let sphere = Indenter::sphere(1e-3).unwrap();
    for exact in [sphere, Indenter::power_law(0.3, 1.5).unwrap(), Indenter::power_law(1e3, 3.0).unwrap()] {
        for grading in GRADINGS {
            let depth = exact.equivalent_profile(grading).unwrap().value(5e-4);
            for rows in [51, 101, 201, 401] {
                let tabulated = sampled(&exact, even(rows, 9e-4));
                let start = std::time::Instant::now();
                let found = errors(&tabulated, &exact, grading, depth, 0.7);
                let shown = found.map(|e| format!("{e:.1e}"));
                println!("{exact:?} k {grading} {rows}: {} {:?}", shown.join(" "), start.elapsed());
            }
        }
    }
    for rows in [1000, 10000, 50000] {
        let start = std::time::Instant::now();
        let tabulated = sampled(&Indenter::sphere(1e-3).unwrap(), even(rows, 9e-4));
        let a = start.elapsed();
        let g = tabulated.equivalent_profile(0.3).unwrap();
        println!("{rows} rows: {a:?} {:?} {}", start.elapsed(), g.value(PI * 1e-4));
    }
}
