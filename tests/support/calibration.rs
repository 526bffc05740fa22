//! Calibrations of made data: scenes, errors, and what is found.

use std::fs;
use std::path::Path;

use fretwear::scene::Calibration;
use fretwear::scene::sampling::{Method, UnitCube};
use fretwear::study::calibration::{Outcome, Parameter, calibrate};
use fretwear::{Results, Scene, Stop};
use spec_math::cephes64::ndtri;

/// Steel on steel in partial slip, as data/scenes/paraboloid.toml, at most a million cycles.
pub const BALL: &str = r#"
[indenter.paraboloid]
radius = "10 mm"
[half_space]
grading = 0
modulus = "105 GPa"
poisson_ratio = 0.3
[friction.coulomb]
coefficient = 0.7
[wear.archard]
coefficient = 1e-14
[loading]
initial_force = 10
amplitude = "0.325 um"
cycles = 1e6
"#;

pub const WEAR: &str = "[[unknowns]]\nkey = \"wear.archard.coefficient\"\nfrom = 1e-17\nto = 1e-11\n";
pub const AMPLITUDE: &str =
    "[[unknowns]]\nkey = \"loading.amplitude\"\nfrom = \"0.2 um\"\nto = \"0.45 um\"\n";
pub const FRICTION: &str = "[[unknowns]]\nkey = \"friction.coulomb.coefficient\"\nfrom = 0.4\nto = 1.2\n";

/// Normal numbers, the same for the same seed.
pub fn noise(seed: u64, count: usize) -> Vec<f64> {
    let cube = UnitCube::new(Method::Random, count as u64, 1, seed);
    (0..count as u64).map(|i| ndtri(cube.coordinate(i, 0).clamp(1e-12, 1.0 - 1e-12))).collect()
}

/// The run of a scene with snapshots at these cycles, finer than any calibration of it.
pub fn truth(scene: &str, settings: &[&str], cycles: &[f64]) -> Results {
    let settings: Vec<String> = settings.iter().map(|it| (*it).to_owned()).collect();
    let end = cycles.last().expect("some");
    let output = [format!("output.at_cycles={cycles:?}"), format!("loading.cycles={end:e}")];
    let settings = [&settings[..], &output, &["numerics.accuracy=1e-5".into()]].concat();
    let scene = Scene::from_toml_with(scene, Path::new("truth"), Path::new(""), &settings);
    scene.expect("a scene").simulate().expect("it runs")
}

/// A calibration in a folder of its own: scene, columns, document.
pub fn found(scene: &str, columns: &[(&str, &str)], document: &str) -> Outcome {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("scene.toml"), scene).expect("written");
    for (name, text) in columns {
        fs::write(folder.path().join(name), text).expect("written");
    }
    let text = if scene.is_empty() { document.into() } else { format!("scene = \"scene.toml\"\n{document}") };
    let calibration = Calibration::from_toml(&text, "calibration", folder.path());
    let calibration = calibration.unwrap_or_else(|error| panic!("{error}\n{text}"));
    calibrate(&calibration, &Stop::default())
        .unwrap_or_else(|error| panic!("{error}"))
        .expect("it was not stopped")
}

pub fn csv(header: &str, columns: &[&[f64]]) -> String {
    let rows = (0..columns[0].len()).map(|i| {
        columns.iter().map(|column| format!("{:e}", column[i])).collect::<Vec<_>>().join(",") + "\n"
    });
    format!("{header}\n{}", rows.collect::<String>())
}

pub fn holds(outcome: &Outcome, truths: &[f64]) -> Vec<bool> {
    let inside = |(it, truth): (&Parameter, &f64)| {
        it.interval[0].is_none_or(|low| low <= *truth) && it.interval[1].is_none_or(|high| *truth <= high)
    };
    outcome.parameters.iter().zip(truths).map(inside).collect()
}

/// Points along a line through the centre of a scar on rough ground that lies askew.
pub fn scar(results: &Results, seed: u64, roughness: f64, centre: f64) -> String {
    let (radius, depth) = (results.radius(), *results.wear_depth().last().expect("some"));
    let x: Vec<f64> = (0..161).map(|i| -4e-4 + 5e-6 * f64::from(i)).collect();
    let at = |x: f64| {
        let r = (x - centre).abs();
        let after = radius.partition_point(|it| *it < r);
        if after == 0 || after == radius.len() {
            return 0.0;
        }
        let part = (r - radius[after - 1]) / (radius[after] - radius[after - 1]);
        depth[after - 1] + part * (depth[after] - depth[after - 1])
    };
    let z: Vec<f64> = x
        .iter()
        .zip(noise(seed, x.len()))
        .map(|(x, noise)| 3e-7 + 1e-4 * x - at(*x) + roughness * noise)
        .collect();
    csv("x,z", &[&x, &z])
}

pub const SCAR: &str = "[[data]]\nfile = \"s.csv\"\nposition = \"x\"\nheight = \"z\"\n";
