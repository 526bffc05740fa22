//! Published measurements in `data/validation` against what the program makes of them.

use std::path::Path;

use fretwear::Scene;
use fretwear::run::Results;

const SCENE: &str = include_str!("../data/scenes/fouvry2007.toml");

/// Name and coefficients, µm³/J, of the coatings: of volumes, and of the depth in the middle where it is given.
fn coatings() -> Vec<(String, f64, Option<f64>)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/validation/fouvry2007.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1).map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        (cells[0].to_owned(), cells[1].parse().unwrap(), cells[2].parse().ok())
    });
    rows.collect()
}

fn run(coefficient: f64, stroke: &str, friction: f64) -> Results {
    let text = SCENE
        .replace("415.1 um^3/J", &format!("{coefficient} um^3/J"))
        .replace("100 um", stroke)
        .replace("coefficient = 0.3", &format!("coefficient = {friction}"));
    text.parse::<Scene>().unwrap().simulate().unwrap()
}

/// Depth in the middle over the energy density there if the pressure stayed Hertz's and slip were the amplitude: `w(0)/(4 μ_f p0 U N)`, 1/Pa.
fn local_coefficient(results: &Results, amplitude: f64, friction: f64) -> f64 {
    let (first, last) = (&results.snapshots()[0], results.last());
    let hertz = 1.5 * first.normal_force / (std::f64::consts::PI * first.contact_radius.powi(2));
    last.wear_depth[0] / (4.0 * friction * hertz * amplitude * (last.cycles + 0.25))
}

#[test]
fn worn_volumes_of_coatings_are_the_coefficient_times_the_energy() {
    let coatings = coatings();
    assert_eq!(coatings.len(), 6);
    for (name, coefficient, _) in &coatings {
        for (stroke, amplitude) in [("100 um", 50e-6), ("200 um", 100e-6)] {
            let results = run(*coefficient, stroke, 0.3);
            let last = results.last();
            let off = last.wear_volume / (1e-18 * coefficient * last.dissipated_energy) - 1.0;
            // Nearly the energy of a rigid contact, 4 μ_f F_N U, of which elastic deflection takes some parts in a hundred.
            let rigid = last.dissipated_energy / (4.0 * 0.3 * 100.0 * amplitude * (last.cycles + 0.25));
            let ratio = local_coefficient(&results, amplitude, 0.3) / (1e-18 * coefficient);
            println!(
                "{name} {stroke}: E = {:.1} J, V = {:.4e} µm³ (off {off:.1e}), a = {:.1} µm, w = {:.3} µm, E/rigid {rigid:.4}, local/global {ratio:.3}, error {:?}",
                last.dissipated_energy,
                1e18 * last.wear_volume,
                1e6 * last.contact_radius,
                1e6 * last.wear_depth[0],
                results.error_estimate()
            );
            assert!(off.abs() < 5e-6, "{name} at {stroke}: {off:e}");
            assert!((0.98..1.0).contains(&rigid), "{name} at {stroke}: {rigid}");
            assert!(
                results.accuracy_met() == Some(true),
                "{name} at {stroke}: {:?}",
                results.error_estimate()
            );
            assert_eq!(results.fretting_regime().last().unwrap().name(), "full-sliding");
        }
    }
}

#[test]
fn loops_of_the_unworn_sphere_are_those_of_the_closed_form() {
    let contact = SCENE.parse::<Scene>().unwrap().contact().unwrap();
    let results = run(415.1, "100 um", 0.3);
    let pairs = [
        (contact.energy_ratio().unwrap(), results.energy_ratio()[0]),
        (contact.sliding_ratio().unwrap(), results.sliding_ratio()[0]),
    ];
    assert!(pairs.iter().all(|(one, other)| (one / other - 1.0).abs() < 1e-4), "{pairs:?}");
}

#[test]
fn friction_that_is_not_known_does_not_change_the_volume_of_an_energy() {
    let per_energy = [0.2, 0.7].map(|friction| {
        let results = run(415.1, "100 um", friction);
        results.last().wear_volume / results.last().dissipated_energy
    });
    assert!((per_energy[0] / per_energy[1] - 1.0).abs() < 1e-5, "{per_energy:?}");
}
