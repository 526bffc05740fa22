//! A rig that breaks the last stick goes on to move the whole contact: the balance of energy, the worn-flat end, the passage of the transition, and runs in parts.

mod support;

use std::f64::consts::PI;

use fretwear::run::Results;
use fretwear::scene::Scene;
use support::resume::whole_and_in_parts;

const DEPTH: f64 = 1e-6;
const FRICTION: f64 = 0.3;
const WEAR: f64 = 1e-14;

/// What wears, and how it is moved.
struct Rig<'a> {
    indenter: &'a str,
    grading: f64,
    /// First stick radius over that of the contact, or an amplitude.
    amplitude: &'a str,
    /// Of the rig, N/m.
    stiffness: f64,
    tau: f64,
    wear: &'a str,
    friction: &'a str,
}

const PARABOLOID: &str = "paraboloid]\nradius = 0.5";
const ARCHARD: &str = "archard]\ncoefficient = 1e-14";
const COULOMB: &str = "coulomb]\ncoefficient = 0.3";

const PLAIN: Rig = Rig {
    indenter: PARABOLOID,
    grading: 0.0,
    amplitude: "stick_ratio = 0.5",
    stiffness: 1e8,
    tau: 5.0,
    wear: ARCHARD,
    friction: COULOMB,
};

impl Rig<'_> {
    fn scene(&self, numerics: &str) -> Scene {
        let Self { indenter, grading, amplitude, stiffness, tau, wear, friction } = self;
        let text = format!(
            "[indenter.{indenter}\n[half_space]\ngrading = {grading}\nnormal_stiffness = 2e11\nstiffness_ratio = 0.8\n[friction.{friction}\n[wear.{wear}\n\
             [loading]\nindentation = {DEPTH:e}\n{amplitude}\nfrequency = 1\ntau = {tau}\nrig_stiffness = {stiffness:e}\n[numerics]\n{numerics}\n\
             [output]\nsnapshots = 12\n"
        );
        Scene::from_toml(&text, "scene.toml").expect("a scene")
    }

    fn run(&self, numerics: &str) -> Results {
        self.scene(numerics).simulate().expect("an end")
    }
}

fn volume(results: &Results) -> f64 {
    results.last().wear_volume
}

fn slides(results: &Results) -> bool {
    results.last().stick_radius == 0.0
}

#[test]
fn energy_balances_the_volume_from_partial_into_gross_slip_to_the_end() {
    for grading in [-0.3, 0.0, 0.5, 0.9_f64] {
        for tau in [5.0, 60.0] {
            let stiffness = 5e7 * (DEPTH * 0.5).powf(0.5 * grading);
            let results = Rig { grading, stiffness, tau, ..PLAIN }.run("springs = 120\ntolerance = 1e-5");
            assert!(slides(&results), "k = {grading}");
            let first = results.snapshots().iter().find(|it| it.cycles > 0.0).expect("a snapshot");
            assert!(first.stick_radius > 0.0, "k = {grading}: stick from the start");
            let by_energy = WEAR / FRICTION * results.last().dissipated_energy;
            let off = volume(&results) / by_energy - 1.0;
            println!("k = {grading}, τ = {tau}: volume over that by energy {off:.1e}");
            assert!(off.abs() < 2e-4, "k = {grading}, τ = {tau}: {off:e}");
        }
    }
}

/// Worn flat, `f(a∞) = d`: `V∞ = π a∞² d n/(n+2)`.
#[test]
fn the_end_is_the_flat_that_bears_nothing() {
    for (indenter, exponent, last) in [(PARABOLOID, 2.0, 1e-3), ("cone]\nslope = 1e-3", 1.0, 1e-3)] {
        let rig = Rig { indenter, stiffness: 1e7, tau: 1e3, ..PLAIN };
        let results = rig.run("accuracy = 1e-3");
        let flat = PI * last * last * DEPTH * exponent / (exponent + 2.0);
        let off = volume(&results) / flat - 1.0;
        println!("n = {exponent}: {off:.1e}, estimate {:?}", results.error_estimate());
        assert!(slides(&results) && off.abs() < 1e-4, "n = {exponent}: {off:e}");
    }
}

#[test]
fn volumes_pass_the_transition_of_the_first_cycle_without_a_jump() {
    // What slides at first: U + μ_f F_N/k_r with M U = μ_f d, and F_N = 2 c_N d a0 2/3 of a paraboloid.
    let radius = (DEPTH * 0.5_f64).sqrt();
    let force = 2.0 * 2e11 * DEPTH * radius * 2.0 / 3.0;
    let transition = FRICTION * DEPTH / 0.8 + FRICTION * force / PLAIN.stiffness;
    let parts = [0.99, 0.997, 0.999, 0.9999, 1.0, 1.0001, 1.001];
    let volumes = parts.map(|part| {
        let amplitude = format!("amplitude = {:e}", part * transition);
        let results = Rig { amplitude: &amplitude, tau: 3.0, ..PLAIN }.run("accuracy = 1e-3");
        println!("{part}: {:e}, estimate {:?}", volume(&results), results.error_estimate());
        volume(&results)
    });
    // Between neighbours they change in proportion, but for what each is off by: below the transition the slope grows.
    for (part, volume) in parts.iter().zip(&volumes) {
        let change = volume / volumes[4] - 1.0;
        let expected = [3.6, 5.5][usize::from(*part < 1.0)] * (part - 1.0);
        assert!((change - expected).abs() < 1e-3 + 0.4 * expected.abs(), "{part}: {change:e}, {expected:e}");
    }
}

#[test]
fn an_accuracy_asked_is_delivered_or_told() {
    let laws = [
        (ARCHARD, COULOMB),
        ("power-law]\ncoefficient = 1e-14\npressure_exponent = 1\nslip_exponent = 0.5", COULOMB),
        ("threshold]\ncoefficient = 1e-14\npressure = 5e6", COULOMB),
        (ARCHARD, "load-dependent]\ncoefficient = 0.3\nexponent = -0.1"),
    ];
    for (wear, friction) in laws {
        for grading in [0.0, 0.5] {
            let stiffness = if grading > 0.0 { 1e7 } else { 1e8 };
            let wear = wear.replace("5e6", if grading > 0.0 { "2e5" } else { "5e6" });
            let rig = Rig { grading, stiffness, tau: 2.5, wear: &wear, friction, ..PLAIN };
            let fine = volume(&rig.run("springs = 300\ntolerance = 1e-6"));
            for accuracy in [1e-2_f64, 1e-3] {
                let results = rig.run(&format!("accuracy = {accuracy:e}"));
                let off = (volume(&results) / fine - 1.0).abs();
                let estimate = results.error_estimate().expect("an estimate");
                println!(
                    "{wear:.20}, {friction:.20}, k = {grading}, {accuracy:e}: {off:.1e}, estimate {estimate:.1e}"
                );
                assert!(off < accuracy.max(estimate), "{off:e}");
                assert_eq!(results.accuracy_met(), Some(estimate <= accuracy));
            }
        }
    }
}

#[test]
fn runs_in_parts_repeat_every_bit_before_and_after_stick_is_lost() {
    for numerics in ["springs = 60", "accuracy = 1e-2"] {
        let folder = tempfile::tempdir().expect("a folder");
        let scene = PLAIN.scene(numerics);
        let (results, [expected, found], interruptions) = whole_and_in_parts(&scene, folder.path(), 25);
        assert!(slides(&results));
        assert!(interruptions >= 3, "{interruptions}");
        assert!(found == expected, "{numerics}");
    }
}
