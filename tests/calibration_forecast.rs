//! What is foretold with what a calibration found, and intervals from data made anew: judged where the problem is linear.

mod support;

use std::fs;
use std::path::Path;

use rayon::prelude::*;
use serde_json::Value;
use support::calibration::{BALL, WEAR, csv, noise};
use support::command::{done, run, text};

/// Energies and volumes of one coefficient, and the calibration of it without a scene.
fn place(values: usize, seed: u64, deviation: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let energies: Vec<f64> = (1..=values).map(|it| it as f64).collect();
    let volumes: Vec<f64> =
        energies.iter().zip(noise(seed, values)).map(|(it, e)| 2e-14 * it + 2e-14 * e).collect();
    fs::write(folder.path().join("v.csv"), csv("E,V", &[&energies, &volumes])).expect("written");
    let unknown = WEAR.replace("archard", "dissipated-energy");
    let data = "[[data]]\nfile = \"v.csv\"\ndissipated_energy = \"E\"\nwear_volume = \"V\"\n";
    fs::write(folder.path().join("alpha.toml"), format!("bootstrap = 2000\n{unknown}{data}{deviation}\n"))
        .expect("written");
    // Of few cycles the profile is still that of the start, so that V = α E is in proportion to the coefficient.
    let scene = BALL.replace("cycles = 1e6", "cycles = 1") + "[numerics]\naccuracy = 1e-3\n";
    fs::write(folder.path().join("ahead.toml"), scene).expect("written");
    folder
}

fn calibrated(folder: &Path, more: &[&str]) -> Value {
    let printed =
        done(folder, &[&["calibrate", "alpha.toml", "-o", "out", "--json", "--force"], more].concat());
    serde_json::from_str(&printed).expect("one JSON object")
}

fn of(json: &Value, name: &str) -> [f64; 3] {
    ["estimate", "lower", "upper"].map(|end| {
        let all = json["forecast"]["results"].as_array().expect("results");
        let found = all.iter().find(|it| it["name"] == name).unwrap_or_else(|| panic!("{name}: {all:?}"));
        found[end].as_f64().unwrap_or_else(|| panic!("{found}"))
    })
}

/// The first cycle wears V = α E, in proportion to the coefficient: the band is its interval of Student times that.
#[test]
fn the_band_of_a_linear_result_is_the_interval_of_the_coefficient() {
    for deviation in ["", "deviation = 2e-14"] {
        let folder = place(6, 3, deviation);
        let json = calibrated(folder.path(), &["--predict", "ahead.toml", "--draws", "500"]);
        let parameter = &json["parameters"][0];
        let [estimate, lower, upper] =
            ["estimate", "lower", "upper"].map(|it| parameter[it].as_f64().expect("a number"));
        let [volume, low, high] = of(&json, "wear_volume");
        let [part, width] = [low, high].map(|it| it / volume - 1.0);
        let [exact, exact_width] = [lower / estimate - 1.0, upper / estimate - 1.0];
        // Student's tails of 500 draws: 6 % of the width.
        assert!((part / exact - 1.0).abs() < 0.06, "{deviation}: {part} {exact}");
        assert!((width / exact_width - 1.0).abs() < 0.06, "{deviation}: {width} {exact_width}");
        let energy = of(&json, "dissipated_energy")[0];
        assert!((volume / (estimate * energy) - 1.0).abs() < 1e-3, "{volume} {estimate} {energy}");
        assert!(folder.path().join("out/forecast.csv").exists());
        done(folder.path(), &["plot", "out/calibration.h5", "-o", "fit.svg"]);
    }
}

/// Of 200 made sets 95 % of the bands hold what the true coefficient comes to; three standard deviations are 4.6 %.
#[test]
#[ignore = "minutes"]
fn bands_hold_the_truth_as_often_as_they_say() {
    let inside = |seed: u64| {
        let folder = place(6, 100 + seed, "");
        let path = folder.path();
        let text =
            fs::read_to_string(path.join("alpha.toml")).expect("readable").replace("bootstrap = 2000\n", "");
        fs::write(path.join("alpha.toml"), text).expect("written");
        let json = calibrated(path, &["--predict", "ahead.toml", "--draws", "100"]);
        let [_, low, high] = of(&json, "wear_volume");
        let energy = of(&json, "dissipated_energy")[0];
        u64::from(low <= 2e-14 * energy && 2e-14 * energy <= high)
    };
    let count = 200;
    let held: u64 = (0..count).into_par_iter().map(inside).sum();
    let part = held as f64 / count as f64;
    println!("{held} of {count}");
    assert!((part - 0.95).abs() < 0.046, "{part}");
}

/// Of 400 values with normal errors the interval by data made anew is that of the profile.
#[test]
fn data_made_anew_tell_the_interval_of_the_profile_where_it_is_linear() {
    let folder = place(400, 5, "");
    let json = calibrated(folder.path(), &[]);
    let parameter = &json["parameters"][0];
    let number = |name: &str| parameter[name].as_f64().unwrap_or_else(|| panic!("{name}: {parameter}"));
    for end in ["lower", "upper"] {
        let [own, made] =
            [number(end), number(&format!("bootstrap_{end}"))].map(|it| it - number("estimate"));
        // The quantile of 2,000 has a standard deviation of 3 % of the half width.
        assert!((made / own - 1.0).abs() < 0.09, "{end}: {made} {own}");
    }
    let again = calibrated(folder.path(), &[]);
    assert_eq!(json["parameters"], again["parameters"]);
    let one = fretwear_on_one_thread(folder.path());
    assert_eq!(json["parameters"], one["parameters"]);
}

fn fretwear_on_one_thread(folder: &Path) -> Value {
    let arguments = ["calibrate", "alpha.toml", "-o", "out", "--json", "--force"];
    let mut command = support::command::program(folder, &arguments);
    let output = command.env("RAYON_NUM_THREADS", "1").output().expect("it starts");
    serde_json::from_str(text(&output.stdout)).expect("one JSON object")
}

#[test]
fn a_scene_that_cannot_be_foretold_is_refused_before_anything_is_run() {
    let folder = place(6, 3, "");
    let path = folder.path();
    fs::write(path.join("bad.toml"), BALL.replace("grading = 0", "grading = 3")).expect("written");
    for (scene, told) in [("bad.toml", "grading"), ("none.toml", "none.toml")] {
        let output = run(path, &["calibrate", "alpha.toml", "-o", "out", "--predict", scene]);
        assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
        assert!(text(&output.stderr).contains(told), "{}", text(&output.stderr));
        assert!(!path.join("out").exists());
    }
}
