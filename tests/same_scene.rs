//! A scene is computed as what it is, not as it is written; laws without kinks keep the accuracy asked as the plain ones do.

use std::f64::consts::SQRT_2;

use fretwear::Scene;
use fretwear::laws::motion::{Mode, RecordedPath};

const COULOMB: &str = "[friction.coulomb]\ncoefficient = 0.7\n";
const ARCHARD: &str = "[wear.archard]\ncoefficient = \"1e-8 1/MPa\"\n";

fn scene(friction: &str, wear: &str, more: &str, numerics: &str) -> Scene {
    let text = format!(
        "[indenter.paraboloid]\nradius = \"10 mm\"\n[half_space]\ngrading = 0\nmodulus = \"210 GPa\"\npoisson_ratio = 0.3\n{friction}{wear}\
         [loading]\nindentation = \"0.75 um\"\nstick_ratio = 0.7\ntau = 10\n{more}[output]\nsnapshots = 5\n[numerics]\n{numerics}"
    );
    Scene::from_toml(&text, "scene.toml").unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Friction, wear and motion that come to the plain scene, and whether they do exactly.
fn other_words() -> Vec<(bool, &'static str, &'static str, &'static str)> {
    let threshold = "[wear.threshold]\ncoefficient = \"1e-8 1/MPa\"\npressure = 1.0\n";
    let spread = "[wear.non-local]\ncoefficient = \"1e-8 1/MPa\"\nlength = 1e-12\n";
    let power = "[wear.power-law]\ncoefficient = 1e-14\npressure_exponent = 1\nslip_exponent = 1\n";
    let statics = ["0.7", "0.69999999"].map(|kinetic| {
        let law =
            format!("[friction.static-kinetic]\nstatic_coefficient = 0.7\nkinetic_coefficient = {kinetic}\n");
        &*law.leak()
    });
    let exponents = ["0", "1e-9"].map(|exponent| {
        &*format!("[friction.load-dependent]\ncoefficient = 0.7\nexponent = {exponent}\n").leak()
    });
    let changing =
        "[friction.coulomb]\ncoefficient = 0.7\n[friction.history]\nfactors = [1, 1]\nat_tau = [0, 5]\n";
    let orbit = "[loading.orbit]\ntransverse_ratio = 1e-8\n";
    let oscillation = "[loading.normal_oscillation]\namplitude_ratio = 1e-8\nfrequency_ratio = \"3/2\"\n";
    let blocks = "repeat = true\n[[loading.blocks]]\ntau = 1\n[[loading.blocks]]\ntau = 2\n";
    vec![
        (true, statics[0], ARCHARD, ""),
        (false, statics[1], ARCHARD, ""),
        (true, exponents[0], ARCHARD, ""),
        (false, exponents[1], ARCHARD, ""),
        (true, changing, ARCHARD, ""),
        (true, COULOMB, power, ""),
        (false, COULOMB, threshold, ""),
        (false, COULOMB, spread, ""),
        (false, COULOMB, ARCHARD, orbit),
        (false, COULOMB, ARCHARD, oscillation),
        (true, COULOMB, ARCHARD, blocks),
        (false, COULOMB, ARCHARD, "rig_stiffness = 1e14\n"),
    ]
}

#[test]
fn the_same_physics_in_other_words_is_the_same_run() {
    let plain = scene(COULOMB, ARCHARD, "", "").simulate().unwrap();
    for (exactly, friction, wear, more) in other_words() {
        let name = format!("{friction}{wear}{more}");
        let other = scene(friction, wear, more, "");
        let told = other.warnings().iter().filter(|it| it.contains("left out")).count();
        assert_eq!(told, usize::from(!exactly), "{name}: {:?}", other.warnings());
        assert!(other.conditions().is_plain(), "{name}");
        let found = other.simulate().unwrap();
        let [volume, expected] = [&found, &plain].map(|it| it.last().wear_volume);
        assert!((volume / expected - 1.0).abs() < 1e-12, "{name}: {volume:e}, {expected:e}");
        let [steps, expected] = [&found, &plain].map(|it| it.steps());
        assert_eq!(steps, expected, "{name}");
    }
    // Beyond a hundredth of the accuracy they are what they say.
    for (friction, more) in [
        ("[friction.static-kinetic]\nstatic_coefficient = 0.7\nkinetic_coefficient = 0.6999\n", ""),
        (COULOMB, "[loading.orbit]\ntransverse_ratio = 1e-4\n"),
        (COULOMB, "[[loading.blocks]]\ntau = 1\namplitude_factor = 0.9999\n[[loading.blocks]]\ntau = 1\n"),
    ] {
        assert!(!scene(friction, ARCHARD, more, "").conditions().is_plain(), "{friction}{more}");
    }
}

#[test]
fn motion_along_a_slanted_line_is_that_along_x() {
    // Partial slip, the contact in gross slip along the line alone, both amplitudes that blocks scale, and a held normal force.
    let blocks = "[[loading.blocks]]\ntau = 1\n[[loading.blocks]]\ntau = 1\namplitude_factor = 1.2\n";
    for (load, ratio, more) in [
        ("indentation", 0.3, ""),
        ("indentation", 0.9, ""),
        ("indentation", 0.4, blocks),
        ("normal_force", 0.3, ""),
    ] {
        let run = |ratio: f64, more: &str| {
            let load = if load == "indentation" { "indentation = 1e-6" } else { "normal_force = 10.0" };
            let text = format!(
                "[indenter.paraboloid]\nradius = 0.01\n[half_space]\ngrading = 0\nnormal_stiffness = 1e11\nstiffness_ratio = 0.8\n\
                 {COULOMB}{ARCHARD}[loading]\n{load}\namplitude_ratio = {ratio}\ntau = 2\n{more}[output]\nsnapshots = 3\n\
                 [numerics]\naccuracy = 1e-3\n"
            );
            let scene =
                Scene::from_toml(&text, "scene.toml").unwrap_or_else(|error| panic!("{error}\n{text}"));
            let slanted = scene.warnings().iter().filter(|it| it.contains("45° to x")).count();
            (slanted, scene.simulate().unwrap())
        };
        let orbit = "[loading.orbit]\ntransverse_ratio = 1\nphase = \"90 deg\"\n";
        let (told, found) = run(ratio, &format!("{orbit}{more}"));
        let (untold, expected) = run(SQRT_2 * ratio, more);
        assert_eq!((told, untold), (1, 0), "{load}, {ratio}, {more}");
        let [volume, expected] = [&found, &expected].map(|it| it.last().wear_volume);
        assert!((volume / expected - 1.0).abs() < 1e-12, "{load}, {ratio}, {more}: {volume:e}, {expected:e}");
    }
}

#[test]
fn a_recorded_path_is_told_from_the_line_that_comes_nearest_to_it() {
    let path = |x: [f64; 3], y: [f64; 3]| {
        let path = RecordedPath::new("path", x.to_vec(), y.to_vec(), vec![0.0; 3]).unwrap();
        let mode: &dyn Mode = &path;
        mode.to_and_fro(path.amplitude().unwrap(), 1.0)
    };
    let line = path([0.0, -3.0, 3.0], [0.0, -4.0, 4.0]);
    assert!((line.amplitude - 5.0).abs() < 1e-14 && line.departure < 1e-14, "{line:?}");
    assert!((line.angle - 4f64.atan2(3.0)).abs() < 1e-15, "{line:?}");
    // To one side alone, and a triangle.
    for [x, y] in [[[0.0, 3.0, 6.0], [0.0, 4.0, 8.0]], [[0.0, 3.0, 0.0], [0.0, 0.0, 4.0]]] {
        assert!(path(x, y).departure > 0.1);
    }
    // A shape that is 1e-6 wide.
    let narrow = path([3.0, -3.0, 0.0], [4.0, -4.0, 5e-6]);
    assert!((narrow.departure / 6e-7 - 1.0).abs() < 1e-5, "{narrow:?}");
}

#[test]
fn forces_that_are_held_are_left_out_where_next_to_nothing_slips() {
    let text = |load: &str, control: &str, ratio: f64, exponent: f64, grading: f64| {
        format!(
            "[indenter.power-law]\ncoefficient = 1.0\nexponent = {exponent}\n[half_space]\ngrading = {grading}\nnormal_stiffness = 1e11\n\
             stiffness_ratio = 0.8\n[friction.coulomb]\ncoefficient = 0.5\n[wear.archard]\ncoefficient = 1e-13\n[loading]\n{load}\n\
             stick_ratio = {ratio}\ntau = 1000\n{control}[numerics]\naccuracy = 1e-3\n[output]\nsnapshots = 3\n"
        )
    };
    let read =
        |text: &str| Scene::from_toml(text, "scene.toml").unwrap_or_else(|error| panic!("{error}\n{text}"));
    let mut most = 0.0_f64;
    for (exponent, grading) in [(2.0, 0.0), (2.0, -0.6), (2.0, 0.6), (0.5, 0.6)] {
        let (held, slips) = ("indentation = 1e-6", 1e-2);
        let plain = read(&text(held, "", 1.0 - slips, exponent, grading));
        let force = format!("normal_force = {:e}", plain.contact().unwrap().normal_force());
        let expected = plain.simulate().unwrap().last().wear_volume;
        for (load, control) in [
            (&*force, ""),
            (held, "tangential_control = \"force\"\n"),
            (&*force, "tangential_control = \"force\"\n"),
        ] {
            let scene = read(&text(load, control, 1.0 - slips, exponent, grading));
            assert!(!scene.conditions().is_plain(), "{load} {control}");
            let results = scene.simulate().unwrap();
            let change = (results.last().wear_volume / expected - 1.0).abs() / slips;
            println!("n = {exponent}, k = {grading}, {load} {control}: {change} of what slips");
            most = most.max(change);
            // A hundredth of 1e-3, and twice what slips: less than that is left out, and told.
            let less = read(&text(load, control, 1.0 - 4e-6, exponent, grading));
            let told = less.warnings().iter().filter(|it| it.contains("left out")).count();
            assert!(less.conditions().is_plain() && told > 0, "{load} {control}: {:?}", less.warnings());
        }
    }
    // Twice what slips is what the program takes it for.
    assert!(most > 1.0 && most < 2.0, "{most}");
}

#[test]
fn laws_without_kinks_keep_the_accuracy_asked() {
    let laws = [
        ("[friction.static-kinetic]\nstatic_coefficient = 0.7\nkinetic_coefficient = 0.5\n", ARCHARD),
        ("[friction.load-dependent]\ncoefficient = 0.5\nexponent = -0.2\n", ARCHARD),
        (COULOMB, "[wear.power-law]\ncoefficient = 1e-18\npressure_exponent = 1.5\nslip_exponent = 0.5\n"),
        (COULOMB, "[wear.power-law]\ncoefficient = 1e-11\npressure_exponent = 0.7\nslip_exponent = 0.8\n"),
    ];
    for (friction, wear) in laws {
        let at = |accuracy: f64| {
            let found = scene(friction, wear, "", &format!("accuracy = {accuracy:e}\n")).simulate().unwrap();
            (found.last().wear_volume, found.accuracy_met(), found.radius().len())
        };
        let finest = at(1e-6).0;
        for accuracy in [1e-2, 1e-3, 1e-4] {
            let (volume, met, radii) = at(accuracy);
            assert_eq!((met, radii), (Some(true), 128), "{friction}{wear} at {accuracy}");
            assert!((volume / finest - 1.0).abs() < accuracy, "{friction}{wear}: {volume:e}, {finest:e}");
        }
    }
}
