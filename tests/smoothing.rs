//! Measured profiles with noise, smoothed: judged by the shapes that they were sampled from.

mod support;

use std::sync::Arc;

use fretwear::contact::closed_form::LimitingShape;
use fretwear::contact::indenter::{Indenter, Smoothing, TabulatedProfile};
use fretwear::data::RunFile;
use fretwear::scene::Scene;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use support::command::{done, object, run, text};

const RADIUS: f64 = 10e-3;
const LAST: f64 = 0.3e-3;
const DEVIATION: f64 = 20e-9;
const DEPTH: f64 = 1e-6;

/// Normal deviates of mean 0 and deviation 1 (Box and Muller).
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let mut uniform = move || (generator.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    move || {
        let (one, two) = (1.0 - uniform(), uniform());
        (-2.0 * one.ln()).sqrt() * (std::f64::consts::TAU * two).cos()
    }
}

fn even(rows: usize, last: f64) -> Vec<f64> {
    (0..rows).map(|i| last * i as f64 / (rows - 1) as f64).collect()
}

/// Rows of a shape with noise, heights from that of the tip's row.
fn noisy(shape: impl Fn(f64) -> f64, radius: Vec<f64>, deviation: f64, seed: u64) -> [Vec<f64>; 2] {
    let mut noise = noise(seed);
    let height: Vec<f64> = radius.iter().map(|r| shape(*r) + deviation * noise()).collect();
    let tip = height[0];
    [radius, height.into_iter().map(|f| f - tip).collect()]
}

fn smoothed([radius, height]: [Vec<f64>; 2], deviation: f64) -> TabulatedProfile {
    TabulatedProfile::smoothed("rows", radius, height, deviation).unwrap()
}

fn paraboloid(r: f64) -> f64 {
    0.5 * r * r / RADIUS
}

fn sphere(r: f64) -> f64 {
    r * r / (RADIUS + (RADIUS * RADIUS - r * r).sqrt())
}

/// A ball worn in an annulus from 60 to 140 µm, `depth` deep.
fn scar(r: f64, depth: f64) -> f64 {
    let place = (r - 100e-6) / 40e-6;
    let worn =
        if place.abs() < 1.0 { 0.5 * depth * (1.0 + (std::f64::consts::PI * place).cos()) } else { 0.0 };
    paraboloid(r) + worn
}

fn limit(indenter: &Indenter) -> LimitingShape {
    LimitingShape::from_stick_ratio(indenter, 0.0, DEPTH, 0.7).unwrap()
}

/// Root mean squares, over measurements with different noise, of the relative errors of a0, V∞ and the radius of curvature at the tip, and how far the
/// residual is from the deviation.
fn errors(shape: impl Fn(f64) -> f64, rows: usize) -> [f64; 4] {
    const MEASUREMENTS: u64 = 16;
    let dense = even(8001, LAST);
    let heights = dense.iter().map(|r| shape(*r)).collect();
    let exact = Indenter::from(Arc::new(TabulatedProfile::new("exact", dense, heights).unwrap()));
    let exact = limit(&exact);
    let mut squares = [0.0; 4];
    for seed in 0..MEASUREMENTS {
        let table = smoothed(noisy(&shape, even(rows, LAST), DEVIATION, seed), DEVIATION);
        let smoothing: Smoothing = *table.smoothing().unwrap();
        let found = limit(&Indenter::from(Arc::new(table)));
        let relative = [
            found.contact_radius_initial() / exact.contact_radius_initial() - 1.0,
            found.wear_volume() / exact.wear_volume() - 1.0,
            smoothing.tip_radius.unwrap() / RADIUS - 1.0,
            smoothing.residual_rms / DEVIATION - 1.0,
        ];
        squares.iter_mut().zip(relative).for_each(|(sum, error)| *sum += error * error);
    }
    squares.map(|sum| (sum / MEASUREMENTS as f64).sqrt())
}

#[test]
fn a_ball_is_found_in_the_noise_with_errors_that_fall_as_the_root_of_the_number_of_rows() {
    for (name, shape) in [("paraboloid", paraboloid as fn(f64) -> f64), ("sphere", sphere)] {
        let [few, many] = [200, 3200].map(|rows| errors(shape, rows));
        println!("{name}: {few:?} {many:?}");
        assert!(few[0] < 5e-3 && few[1] < 1e-2 && few[2] < 2e-2, "200 rows of 20 nm, {name}: {few:?}");
        // A fourth is expected.
        for i in 0..3 {
            assert!(many[i] < 0.5 * few[i], "{name}: {few:?}, of sixteen times the rows {many:?}");
        }
        assert!(few[3] < 0.15 && many[3] < 0.04, "the residual is not the deviation: {few:?} {many:?}");
    }
}

#[test]
fn an_annulus_that_is_worn_as_deep_as_the_noise_is_found_by_many_rows() {
    let [few, many] = [200, 3200].map(|rows| errors(|r| scar(r, 30e-9), rows));
    println!("{few:?} {many:?}");
    assert!(many[0] < 1e-2 && many[1] < 4e-2, "{many:?}");
    assert!(many[0] < 0.5 * few[0] && many[1] < 0.6 * few[1], "{few:?}, of sixteen times the rows {many:?}");
    assert!(few[3] < 0.15 && many[3] < 0.04, "the residual is not the deviation: {few:?} {many:?}");
}

#[test]
fn a_paraboloid_without_noise_stays_itself_whatever_the_deviation() {
    // Very uneven rows.
    let radius: Vec<f64> = (0..300).map(|i| LAST * (f64::from(i) / 299.0).powi(3)).collect();
    for deviation in [1e-15, 1e-9, 1e-7] {
        let table = smoothed(noisy(paraboloid, radius.clone(), 0.0, 0), deviation);
        let tip = table.smoothing().unwrap().tip_radius.unwrap();
        assert!((tip / RADIUS - 1.0).abs() < 1e-10, "{deviation}: {tip}");
        for r in [1e-6, 5e-5, 2.9e-4] {
            let error = table.profile(r) / paraboloid(r) - 1.0;
            assert!(error.abs() < 1e-10, "{deviation}, r = {r}: {error}");
        }
    }
}

#[test]
fn a_deviation_of_zero_or_next_to_it_leaves_the_rows() {
    // A ball of 0.5 mm, of which the best paraboloid is 1 µm off.
    let ball = |r: f64| r * r / (5e-4 + (25e-8 - r * r).sqrt());
    let [radius, height] = noisy(ball, even(200, 3e-4), 0.0, 0);
    let rows = TabulatedProfile::new("rows", radius.clone(), height.clone()).unwrap();
    assert_eq!(smoothed([radius.clone(), height.clone()], 0.0), rows);
    for deviation in [1e-30, 1e-13, 1e-11] {
        let table = smoothed([radius.clone(), height.clone()], deviation);
        let farthest =
            radius.iter().map(|r| (table.profile(*r) - rows.profile(*r)).abs()).fold(0.0, f64::max);
        println!("{deviation:e}: {farthest:e} {:?}", table.smoothing());
        assert!(farthest < 30.0 * deviation.max(1e-15), "{deviation:e}: {farthest:e} m off");
    }
}

#[test]
fn a_million_rows_become_a_curve_of_few_pieces() {
    let table = smoothed(noisy(|r| scar(r, 100e-9), even(1_000_000, LAST), DEVIATION, 7), DEVIATION);
    let worst = (1..100).map(|i| 3e-6 * f64::from(i)).map(|r| (table.profile(r) - scar(r, 100e-9)).abs());
    let worst = worst.fold(0.0, f64::max);
    assert!(worst < 0.05 * DEVIATION, "{worst:e} m off");
    assert_eq!(table.radii().len(), 1_000_000);
}

#[test]
fn a_scene_smooths_shows_the_residual_and_keeps_rows_and_key_in_its_result() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let [radius, height] = noisy(sphere, even(200, LAST), DEVIATION, 3);
    let rows: String = radius.iter().zip(&height).map(|(r, f)| format!("{r:e} {f:e}\n")).collect();
    std::fs::write(at.join("rows.txt"), rows).unwrap();
    let scene = |keys: &str| {
        let text = format!(
            "[indenter.table]\nfile = \"rows.txt\"\n{keys}\n[half_space]\ngrading = 0\nnormal_stiffness = 1e11\n\
             [friction.coulomb]\ncoefficient = 0.6\n[wear.archard]\ncoefficient = 1e-12\n\
             [loading]\nindentation = \"1 um\"\nstick_ratio = 0.6\ntau = 1\n[numerics]\nsprings = 24\n"
        );
        std::fs::write(at.join("scene.toml"), text).unwrap();
    };
    // Rows that lie below the tip by noise.
    scene("");
    let refused = run(at, &["check", "scene.toml"]);
    let message = text(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{message}");
    assert!(message.contains("indenter.table.smoothing"), "{message}");

    scene("smoothing = \"20 nm\"");
    let check = object(at, &["check", "scene.toml", "--json"]);
    let smoothing = &check["smoothing"];
    assert_eq!(
        (smoothing["deviation"].as_f64(), smoothing["by"].as_str()),
        (Some(20e-9), Some("paraboloid"))
    );
    let residual = smoothing["residual_rms"].as_f64().unwrap();
    assert!((residual / 20e-9 - 1.0).abs() < 0.15, "{check}");
    assert!(smoothing["residual_largest"].as_f64().unwrap() > residual, "{check}");
    let shown = done(at, &["check", "scene.toml"]);
    assert!(shown.contains("smoothed with 20 nm") && shown.contains("the best paraboloid"), "{shown}");
    assert!(shown.contains("residual of its rows               rms "), "{shown}");

    done(at, &["run", "scene.toml", "--quiet"]);
    let expected = Scene::from_path(at.join("scene.toml")).unwrap();
    std::fs::remove_file(at.join("rows.txt")).unwrap();
    let file = RunFile::open(&at.join("scene.h5")).unwrap();
    let table = file.header.table.clone().expect("the rows");
    assert_eq!(table.heights(), expected.table().unwrap().heights());
    // As measured, not as smoothed.
    assert_eq!(table.heights(), &height[..]);
    let again = Scene::from_stored(&file.header.scene, "scene.toml", Some(table), None).unwrap();
    assert_eq!(again.indenter(), expected.indenter());
    let resumed = run(at, &["run", "--resume", "scene.h5"]);
    assert_eq!(resumed.status.code(), Some(0), "{}", text(&resumed.stderr));
    // Another deviation is that of another profile.
    let other = file.header.scene.replace("20 nm", "10 um");
    let other = Scene::from_stored(&other, "scene.toml", file.header.table, None).unwrap_err().to_string();
    assert!(
        other.contains("indenter.table.smoothing: ") && other.contains("is not below the height"),
        "{other}"
    );
}

#[test]
fn deviations_that_are_none_are_refused_with_key_value_and_cure() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let [radius, height] = noisy(sphere, even(50, LAST), DEVIATION, 3);
    let rows: String = radius.iter().zip(&height).map(|(r, f)| format!("{r:e} {f:e}\n")).collect();
    std::fs::write(at.join("rows.txt"), rows).unwrap();
    for (value, words) in [
        ("\"-1 nm\"", "is outside [0, inf)"),
        ("-1e-9", "is outside [0, inf)"),
        ("\"5 um\"", "is not below the height of the profile"),
        ("1.0", "is not below the height of the profile"),
        ("nan", "is not a finite number"),
        ("inf", "is not a finite number"),
        ("\"20 N\"", "expected a length"),
        ("true", "expected"),
    ] {
        let text_of_scene = format!(
            "[indenter.table]\nfile = \"rows.txt\"\nsmoothing = {value}\n[half_space]\ngrading = 0\nnormal_stiffness = 1e11\n\
             [friction.coulomb]\ncoefficient = 0.6\n[wear.archard]\ncoefficient = 1e-12\n\
             [loading]\nindentation = \"1 um\"\nstick_ratio = 0.6\ntau = 1\n"
        );
        std::fs::write(at.join("scene.toml"), text_of_scene).unwrap();
        let refused = run(at, &["check", "scene.toml"]);
        let message = text(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{value}: {message}");
        let named = message.contains("indenter.table.smoothing") && message.contains("scene.toml:3");
        assert!(named && message.contains(words), "{value}: {message}");
    }
}
