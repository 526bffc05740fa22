//! Scenes with other laws, modes, blocks and control: what is read, exactly, and how everything else is refused.

use std::any::Any;
use std::fs;
use std::process::Command;
use std::sync::Arc;

use fretwear::contact::InitialContact;
use fretwear::laws::conditions::Conditions;
use fretwear::laws::friction::{Coulomb, FrictionLaw, LoadDependent, StaticKinetic};
use fretwear::laws::history::History;
use fretwear::laws::loading::{Amplitude, Block, Clock, TangentialControl};
use fretwear::laws::motion::{Mode, NormalOscillation, Orbit};
use fretwear::laws::wear::{Archard, DissipatedEnergy, NonLocal, PowerLaw, Threshold, WearLaw};
use fretwear::report::{CheckReport, json};
use fretwear::scene::{Scene, Study};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

const FRICTION: &str = "[friction.coulomb]\ncoefficient = 0.6\n";
const WEAR: &str = "[wear.archard]\ncoefficient = 1e-14\n";
const LOADING: &str = "[loading]\nindentation = \"2 um\"\namplitude = \"1 um\"\ntau = 30\n";

fn scene(friction: &str, wear: &str, loading: &str) -> String {
    format!(
        "[indenter.paraboloid]\nradius = \"10 mm\"\n[half_space]\ngrading = 0.2\nnormal_stiffness = 3e11\nstiffness_ratio = 0.75\n\
         {friction}\n{wear}\n{loading}\n"
    )
}

fn read(text: &str) -> Scene {
    Scene::from_toml(text, "scene.toml").unwrap_or_else(|error| panic!("{error}\n\n{text}"))
}

fn with_friction(friction: &str) -> Conditions {
    read(&scene(friction, WEAR, LOADING)).conditions().clone()
}

fn wear(law: impl WearLaw + 'static) -> Arc<dyn WearLaw> {
    Arc::new(law)
}

fn friction(law: impl FrictionLaw + 'static) -> Arc<dyn FrictionLaw> {
    Arc::new(law)
}

fn with_wear(wear: &str) -> Conditions {
    read(&scene(FRICTION, wear, LOADING)).conditions().clone()
}

fn with_loading(loading: &str) -> Conditions {
    read(&scene(FRICTION, WEAR, &format!("{LOADING}{loading}"))).conditions().clone()
}

#[test]
fn a_scene_without_any_of_it_is_plain_and_without_a_warning() {
    let plain = read(&scene(FRICTION, WEAR, LOADING));
    assert_eq!(
        *plain.conditions(),
        Conditions::plain(Coulomb { coefficient: 0.6 }, Archard { coefficient: 1e-14 })
    );
    assert!(plain.conditions().is_plain() && plain.warnings().is_empty());
    let energy = read(&scene(FRICTION, "[wear.dissipated-energy]\ncoefficient = 2e-14", LOADING));
    assert_eq!(*energy.conditions().wear, *wear(DissipatedEnergy { coefficient: 2e-14 }));
    assert_eq!(energy.wear().coefficient, 2e-14 * 0.6);
    assert!(energy.conditions().is_plain() && energy.warnings().is_empty());
}

#[test]
fn every_law_of_friction_is_read() {
    let law = with_friction("[friction.static-kinetic]\nstatic_coefficient = 0.7\nkinetic_coefficient = 0.5")
        .friction;
    assert_eq!(*law, *friction(StaticKinetic { static_coefficient: 0.7, kinetic_coefficient: 0.5 }));
    let load_dependent = "[friction.load-dependent]\ncoefficient = 0.5\nexponent = -0.25\n";
    let expected = |reference| friction(LoadDependent { coefficient: 0.5, exponent: -0.25, reference });
    let given = with_friction(&format!("{load_dependent}reference_compression = \"3 um\"")).friction;
    assert_eq!(*given, *expected(3e-6));
    // Without it the indentation of the first cycle, as given or under the force given.
    assert_eq!(*with_friction(load_dependent).friction, *expected(2e-6));
    let pressed =
        read(&scene(load_dependent, WEAR, &LOADING.replace("indentation = \"2 um\"", "normal_force = 50")));
    let indentation = pressed.contact().expect("a contact").indentation();
    assert_eq!(*pressed.conditions().friction, *expected(indentation));
    assert!(indentation > 0.0 && indentation != 2e-6);
    // What stands for them in the closed form.
    let static_kinetic = "[friction.static-kinetic]\nstatic_coefficient = 0.7\nkinetic_coefficient = 0.7";
    assert_eq!(read(&scene(static_kinetic, WEAR, LOADING)).friction().coefficient, 0.7);
    assert_eq!(pressed.friction().coefficient, 0.5);
}

#[test]
fn every_law_of_wear_is_read() {
    let power = "[wear.power-law]\ncoefficient = 1e-13\npressure_exponent = 0.5\nslip_exponent = 2";
    assert_eq!(
        *with_wear(power).wear,
        *wear(PowerLaw { coefficient: 1e-13, pressure_exponent: 0.5, slip_exponent: 2.0 })
    );
    let threshold = "[wear.threshold]\ncoefficient = \"1e-5 mm^3/(N m)\"\npressure = \"50 MPa\"";
    assert_eq!(*with_wear(threshold).wear, *wear(Threshold { coefficient: 1e-14, pressure: 5e7 }));
    let non_local = "[wear.non-local]\ncoefficient = 1e-14\nlength = \"5 um\"";
    assert_eq!(*with_wear(non_local).wear, *wear(NonLocal { coefficient: 1e-14, length: 5e-6 }));
    for text in [threshold, non_local] {
        assert_eq!(read(&scene(FRICTION, text, LOADING)).wear().coefficient, 1e-14);
    }
}

#[test]
fn a_power_law_keeps_its_own_time_in_the_dimensionless_one() {
    let (k, alpha, beta) = (3e-20, 1.7, 0.6);
    let wear =
        format!("[wear.power-law]\ncoefficient = {k:e}\npressure_exponent = {alpha}\nslip_exponent = {beta}");
    let contact = read(&scene(FRICTION, &wear, LOADING)).contact().expect("a contact");
    let pressure = 3e11 * contact.contact_radius().powf(0.2 - 1.0) * 2e-6;
    let natural = k * pressure.powf(alpha) * (4.0 * 0.6 * 2e-6 / 0.75f64).powf(beta) / 2e-6;
    let found = contact.tau_per_cycle();
    assert!((found / natural - 1.0).abs() < 1e-13, "{found:e} instead of {natural:e}");
    // With both exponents 1 it is Archard's law.
    let archard = "[wear.power-law]\ncoefficient = 1e-14\npressure_exponent = 1\nslip_exponent = 1";
    assert_eq!(read(&scene(FRICTION, archard, LOADING)).wear().coefficient, 1e-14);
}

#[test]
fn every_history_is_read() {
    let friction = |history: &str| {
        let conditions = with_friction(&format!("{FRICTION}[friction.history]\n{history}"));
        (conditions.friction_history, conditions.clock)
    };
    let wear = |history: &str| {
        let conditions = with_wear(&format!("{WEAR}[wear.history]\n{history}"));
        (conditions.wear_history, conditions.clock)
    };
    let exponential = |last, time| History::Exponential { last, time };
    assert_eq!(friction("final_factor = 0.5\ncycles = 1e5"), (exponential(0.5, 1e5), Clock::Cycles));
    assert_eq!(wear("final_factor = 0\ntau = 3"), (exponential(0.0, 3.0), Clock::Tau));
    let table =
        |times: &[f64], factors: &[f64]| History::Table { times: times.into(), factors: factors.into() };
    assert_eq!(
        friction("factors = [1, 0.5]\nat_tau = [0, 2]"),
        (table(&[0.0, 2.0], &[1.0, 0.5]), Clock::Tau)
    );
    assert_eq!(wear("factors = [1.5]\nat_cycles = [10]"), (table(&[10.0], &[1.5]), Clock::Cycles));
}

#[test]
fn every_control_is_read() {
    let control = |keys: &str| with_loading(keys).tangential_control;
    let rig = TangentialControl::Rig { stiffness: 5e6 };
    assert_eq!(control(""), TangentialControl::Displacement);
    assert_eq!(control("tangential_control = \"displacement\""), TangentialControl::Displacement);
    assert_eq!(control("tangential_control = \"force\""), TangentialControl::Force);
    assert_eq!(control("rig_stiffness = \"5 MN/m\""), rig);
    assert_eq!(control("tangential_control = \"rig\"\nrig_stiffness = 5e6"), rig);
    let held = read(&scene(FRICTION, WEAR, &LOADING.replace("indentation = \"2 um\"", "normal_force = 50")));
    assert!(held.conditions().holds_normal_force && !held.conditions().is_plain());
    let first =
        read(&scene(FRICTION, WEAR, &LOADING.replace("indentation = \"2 um\"", "initial_force = 50")));
    assert!(!first.conditions().holds_normal_force && first.conditions().is_plain());
    let [held, first] = [held, first].map(|it| it.contact().expect("a contact").indentation());
    assert_eq!(held, first);
}

fn oscillation(mode: &dyn Mode) -> Option<&NormalOscillation> {
    (mode as &dyn Any).downcast_ref()
}

#[test]
fn every_mode_is_read() {
    let mode = |keys: &str| with_loading(keys).mode;
    let oscillation = |keys: &str| mode(&format!("[loading.normal_oscillation]\n{keys}"));
    let expected = |amplitude, frequency_ratio, phase| -> Arc<dyn Mode> {
        Arc::new(NormalOscillation { amplitude, frequency_ratio, phase })
    };
    let orbit = |transverse_amplitude, phase, centre| -> Arc<dyn Mode> {
        Arc::new(Orbit { transverse_amplitude, phase, centre })
    };
    assert_eq!(
        &*oscillation("amplitude = \"0.5 um\"\nfrequency_ratio = 2\nphase = \"90 deg\""),
        &*expected(5e-7, [2, 1], std::f64::consts::FRAC_PI_2)
    );
    assert_eq!(&*oscillation("amplitude_ratio = 0.25\nfrequency_ratio = 1"), &*expected(5e-7, [1, 1], 0.0));
    for (written, ratio) in [
        ("0.5", [1, 2]),
        ("1.5", [3, 2]),
        ("0.3333333333333333", [1, 3]),
        ("\"3/2\"", [3, 2]),
        ("\" 128 / 64 \"", [2, 1]),
        ("\"64/63\"", [64, 63]),
        ("\"1.5\"", [3, 2]),
    ] {
        let found = oscillation(&format!("amplitude_ratio = 0.25\nfrequency_ratio = {written}"));
        assert_eq!(&*found, &*expected(5e-7, ratio, 0.0), "{written}");
    }
    assert_eq!(
        &*mode("[loading.orbit]\ntransverse_ratio = 0.5\nphase = 0.1\ncentre_x = \"1 nm\"\ncentre_y = -2e-9"),
        &*orbit(5e-7, 0.1, [1e-9, -2e-9])
    );
    assert_eq!(&*mode("[loading.orbit]\ntransverse_amplitude = \"0.3 um\""), &*orbit(3e-7, 0.0, [0.0, 0.0]));
}

#[test]
fn blocks_are_read_in_their_order() {
    let conditions = with_loading(
        "repeat = true\n[[loading.blocks]]\ntau = 2\namplitude_factor = 0\n[[loading.blocks]]\ntau = 0.5\nindentation_factor = 1.5",
    );
    let block = |duration, amplitude_factor, indentation_factor| Block {
        duration,
        amplitude_factor,
        indentation_factor,
    };
    assert_eq!(conditions.blocks, [block(2.0, 0.0, 1.0), block(0.5, 1.0, 1.5)]);
    assert!(conditions.repeat && conditions.clock == Clock::Tau);
    let once = with_loading("[[loading.blocks]]\ncycles = 10\namplitude_factor = 0.9");
    assert_eq!((once.blocks, once.repeat, once.clock), (vec![block(10.0, 0.9, 1.0)], false, Clock::Cycles));
    assert_eq!(
        with_loading("repeat = true\n[[loading.blocks]]\ncycles = 10").blocks,
        [],
        "factors of one change nothing"
    );
}

const BARE: &str = "[loading]\nindentation = \"2 um\"\ntau = 30\n";

fn folder_with(path: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("path.csv"), path).expect("the path");
    folder
}

fn read_path(rows: &str, keys: &str) -> fretwear::Result<Scene> {
    let folder = folder_with(rows);
    let text = scene(FRICTION, WEAR, &format!("{BARE}[loading.path]\nfile = \"path.csv\"\n{keys}"));
    fs::write(folder.path().join("scene.toml"), text).expect("the scene");
    Scene::from_path(folder.path().join("scene.toml"))
}

#[test]
fn a_recorded_path_is_read_and_comes_back_from_its_stored_rows() {
    let scene =
        read_path("x (um); y (um)\n-1; 0\n1; 0\n0; 0.5 # back\n", "displacement_unit = \"um\"").unwrap();
    let path = scene.path().expect("a path");
    assert_eq!(
        (&path.x[..], &path.y[..], &path.indentation[..]),
        (&[-1e-6, 1e-6, 0.0][..], &[0.0, 0.0, 5e-7][..], &[0.0; 3][..])
    );
    assert_eq!(path.source, "path.csv");
    assert_eq!(scene.loading().amplitude, Amplitude::Displacement(1e-6));
    let again = Scene::from_stored(scene.text(), "stored", None, Some(path.clone())).unwrap();
    assert_eq!(again, scene);
    let lacking = Scene::from_stored(scene.text(), "stored", None, None).unwrap_err().to_string();
    assert!(lacking.contains("its rows are not stored"), "{lacking}");

    let lifted = read_path("0,0,0\n2e-6,0,1e-7\n1e-6,0,-1e-7\n", "").unwrap();
    assert_eq!(lifted.path().expect("a path").indentation, [0.0, 1e-7, -1e-7]);
}

#[test]
fn the_hash_of_a_study_changes_with_the_recorded_path_of_its_scenes() {
    let folder = folder_with("0,0\n1e-6,0\n0,0\n");
    let base = scene(FRICTION, WEAR, &format!("{BARE}[loading.path]\nfile = \"path.csv\"\n"));
    let text =
        "scene = \"base.toml\"\n[[axes]]\nkey = \"friction.coulomb.coefficient\"\nvalues = [0.5, 0.6]\n";
    let study =
        || Study::from_texts(text, "study.toml", &base, &folder.path().join("base.toml")).expect("a study");
    assert_eq!(study().scene(1).expect("a scene").path().expect("a path").x, [0.0, 1e-6, 0.0]);
    let before = study().hash();
    assert_eq!(before, study().hash());
    fs::write(folder.path().join("path.csv"), "0,0\n2e-6,0\n0,0\n").expect("the path");
    assert_ne!(before, study().hash());
}

#[test]
fn a_bad_path_is_refused_with_its_line_and_the_cure() {
    let many = "0,0\n1e-6,0\n".repeat(5001);
    let cases = [
        ("0,0\n1e-6,0\n", "it has 2 rows; give from 3 to 10000"),
        (&many, "line 10001: there are more than 10000 rows"),
        ("0,0\n0,0\n0,0\n", "all its rows are at the same x and y"),
        ("0,0,0\n0,0,1e-8\n0,0,0\n", "does not move along the surface"),
        ("0\n1\n", "line 1: \"0\" has 1 column; a row is two or three numbers, x, y and the indentation"),
        ("0,0,0,0\n", "has 4 columns"),
        ("0,0\n1e-6,0,0\n", "line 2: \"1e-6,0,0\" has 3 columns, and the first row 2"),
        ("0,0\n1e-6,nan\n", "has y = nan, which is not finite"),
        ("0,0\n1e-6,z\n", "has y = \"z\", which is no number"),
        ("0,0\n1e200,0\n0,0\n", "it holds 1e200 m; check the units"),
        ("0;0,5\n", "decimal comma"),
        ("x,y\n", "holds no row of two or three numbers"),
        ("", "is empty"),
        ("0,0,0\n1e-6,0,-2e-6\n0,0,0\n", "lifts the indenter by 2e-6 m from an indentation of 2e-6 m"),
    ];
    for (rows, words) in cases {
        let found = read_path(rows, "").map(drop).expect_err(words).to_string();
        assert!(found.contains(words), "{found}\nlacks {words}");
    }
    for (keys, words) in [("file = \"\"", "is no name of a file"), ("", "loading.path.file is missing")] {
        let text = scene(FRICTION, WEAR, &format!("{BARE}[loading.path]\n{keys}"));
        let found = Scene::from_toml(&text, "scene.toml").unwrap_err().to_string();
        assert!(found.contains(words), "{found}\nlacks {words}");
    }
    let found = read_path("0,0\n1,0\n0,0\n", "displacement_unit = \"N\"").unwrap_err().to_string();
    assert!(found.contains("scene.toml") && found.contains("a unit of length alone"), "{found}");
}

/// The scene is refused at the line that shows the text, with the words.
fn refused(text: &str, shown: &str, words: &[&str]) {
    let message = match Scene::from_toml(text, "scene.toml") {
        Ok(_) => panic!("this scene was taken:\n{text}"),
        Err(error) => error.to_string(),
    };
    for word in words {
        assert!(message.contains(word), "no {word:?} in\n{message}");
    }
    let number = message.split(':').nth(1).and_then(|it| it.parse::<usize>().ok()).expect("a line");
    let line = text.lines().nth(number - 1).unwrap_or_default();
    assert!(line.contains(shown), "line {number}, {line:?}, has no {shown:?}:\n{message}");
}

#[test]
fn bad_laws_are_refused_at_their_line() {
    let history = |keys: &str| format!("{FRICTION}[friction.history]\n{keys}");
    let static_kinetic = "[friction.static-kinetic]\nstatic_coefficient = 0.5\n";
    let load_dependent = "[friction.load-dependent]\ncoefficient = 0.5\n";
    let long = vec!["1"; 10_001].join(",");
    let cases: &[(&str, &str, &[&str])] = &[
        (
            &format!("{static_kinetic}kinetic_coefficient = 0.6"),
            "kinetic_coefficient = 0.6",
            &["is above friction.static-kinetic.static_coefficient = 0.5"],
        ),
        (static_kinetic, "[friction.static-kinetic]", &["kinetic_coefficient is missing"]),
        (&format!("{static_kinetic}kinetic_coefficient = 0"), "kinetic", &["is outside (0, inf)"]),
        (
            &format!("{load_dependent}exponent = -1"),
            "exponent",
            &["friction.load-dependent.exponent = -1 is outside (-1, inf)", "μ_f(q) q must increase"],
        ),
        (load_dependent, "[friction.load-dependent]", &["exponent is missing"]),
        (
            &format!("{load_dependent}exponent = 0\nreference_compression = 0"),
            "reference",
            &["is outside (0, inf)"],
        ),
        (&format!("{FRICTION}[friction.static-kinetic]"), "static-kinetic", &["exclude each other"]),
        (
            "[friction.history]\nfinal_factor = 1\ntau = 1",
            "[friction.history]",
            &["exactly one of friction.coulomb"],
        ),
        (&history(""), "[friction.history]", &["friction.history.final_factor or friction.history.factors"]),
        (&history("final_factor = 0\ntau = 1"), "final_factor", &["= 0 is outside (0, inf)"]),
        (
            &history("final_factor = 1"),
            "[friction.history]",
            &["friction.history.cycles or friction.history.tau"],
        ),
        (&history("final_factor = 1\ntau = 0"), "tau", &["is outside (0, inf)"]),
        (
            &history("final_factor = 1\ntau = 1\nat_tau = [1]"),
            "at_tau",
            &["has no meaning beside friction.history.final_factor"],
        ),
        (&history("factors = [1]\ntau = 1"), "tau = 1", &["has no meaning beside friction.history.factors"]),
        (&history("factors = [1, 2]\nat_tau = [1]"), "at_tau", &["has 1 times for 2 factors"]),
        (&history("factors = []\nat_tau = []"), "factors", &["is empty"]),
        (
            &history("factors = [1, 0]\nat_tau = [1, 2]"),
            "factors",
            &["friction.history.factors[1] = 0 is outside"],
        ),
        (
            &history("factors = [1, 2]\nat_tau = [1, 1]"),
            "at_tau",
            &["friction.history.at_tau[1] = 1 does not come after 1"],
        ),
        (&history("factors = [1]\nat_tau = [-1]"), "at_tau", &["is outside [0, inf)"]),
        (
            &history(&format!("factors = [{long}]\nat_tau = [1]")),
            "factors",
            &["has 10001 entries, more than 10000"],
        ),
    ];
    for (friction, shown, words) in cases {
        refused(&scene(friction, WEAR, LOADING), shown, words);
    }
    let power = "[wear.power-law]\ncoefficient = 1e-14\nslip_exponent = 1\n";
    let cases: &[(&str, &str, &[&str])] = &[
        (power, "[wear.power-law]", &["wear.power-law.pressure_exponent is missing"]),
        (&format!("{power}pressure_exponent = 0"), "pressure_exponent", &["is outside (0, inf)"]),
        (&format!("{power}pressure_exponent = 99"), "[wear]", &[]),
        ("[wear.threshold]\ncoefficient = 1e-14", "threshold", &["wear.threshold.pressure is missing"]),
        ("[wear.threshold]\ncoefficient = 1e-14\npressure = \"1 mm\"", "pressure", &["expected a pressure"]),
        ("[wear.non-local]\ncoefficient = 1e-14\nlength = -1", "length", &["is outside (0, inf)"]),
        (
            &format!("{WEAR}[wear.history]\nfinal_factor = -0.1\ncycles = 1"),
            "final_factor",
            &["is outside [0, inf)"],
        ),
    ];
    for (wear, shown, words) in cases {
        if words.is_empty() {
            let found =
                Scene::from_toml(&scene(FRICTION, wear, LOADING), "scene.toml").unwrap_err().to_string();
            assert!(found.contains("which cannot be computed with"), "{found}");
        } else {
            refused(&scene(FRICTION, wear, LOADING), shown, words);
        }
    }
    let two_clocks = history("final_factor = 0.5\ncycles = 10");
    refused(
        &scene(&two_clocks, &format!("{WEAR}[wear.history]\nfactors = [1]\nat_tau = [1]"), LOADING),
        "at_tau",
        &[
            "wear.history.at_tau does not go by the clock of friction.history.cycles",
            "in cycles, or all as tau",
        ],
    );
    refused(
        &scene(&two_clocks, WEAR, &format!("{LOADING}[[loading.blocks]]\ntau = 1")),
        "tau = 1",
        &["loading.blocks[0].tau does not go by the clock of friction.history.cycles"],
    );
}

#[test]
fn bad_loading_and_what_does_not_go_together_are_refused_at_their_line() {
    let numerics = |keys: &str, mode: &str| format!("[numerics]\n{keys}\n{mode}");
    let orbit = "[loading.orbit]\ntransverse_ratio = 1\n";
    let oscillation = "[loading.normal_oscillation]\nfrequency_ratio = 2\n";
    let fast = |ratio: &str| {
        format!("[loading.normal_oscillation]\namplitude_ratio = 0.1\nfrequency_ratio = {ratio}")
    };
    let no_ratio = &["is no ratio of whole numbers up to 64"][..];
    let cases: Vec<(String, &str, &[&str])> = vec![
        (fast("1.3333333"), "1.3333333", no_ratio),
        (fast("65"), "65", no_ratio),
        (fast("1e300"), "1e300", no_ratio),
        (fast("1e-300"), "1e-300", no_ratio),
        (fast("\"65/64\""), "65/64", no_ratio),
        (fast("\"0/1\""), "0/1", no_ratio),
        (fast("\"1/0\""), "1/0", no_ratio),
        (fast("\"-3/2\""), "-3/2", no_ratio),
        (fast("\"1/2/3\""), "1/2/3", no_ratio),
        (fast("\"99999999999999999999/2\""), "9/2", no_ratio),
        (fast("0"), "frequency_ratio", &["is outside (0, inf)"]),
        (fast("true"), "frequency_ratio", &["expected a plain number"]),
        (oscillation.into(), "normal_oscillation", &["amplitude or loading.normal_oscillation.amplitude_ratio"]),
        (format!("{oscillation}amplitude_ratio = 1"), "amplitude_ratio", &["is outside (0, 1)"]),
        (format!("{oscillation}amplitude = \"2 um\""), "amplitude", &["= \"2 um\" lifts the indenter by 2e-6 m from an indentation of 2e-6 m"]),
        (
            format!("[[loading.blocks]]\ncycles = 1\nindentation_factor = 0.4\n{oscillation}amplitude_ratio = 0.5"),
            "amplitude_ratio",
            &["from an indentation of 8e-7 m"],
        ),
        ("[loading.normal_oscillation]\namplitude = 1e-9".into(), "normal_osc", &["frequency_ratio is missing"]),
        (format!("{orbit}{oscillation}amplitude_ratio = 0.1"), "normal_osc", &["exclude each other"]),
        (format!("{orbit}[loading.path]\nfile = \"x\""), "path", &["exclude each other"]),
        ("[loading.orbit]".into(), "orbit", &["transverse_amplitude or loading.orbit.transverse_ratio"]),
        ("[loading.orbit]\ntransverse_ratio = 0".into(), "transverse_ratio", &["is outside (0, inf)"]),
        (format!("{orbit}phase = \"1 m\""), "phase", &["expected an angle"]),
        (format!("{orbit}centre = 1"), "centre", &["loading.orbit.centre", "did you mean centre_"]),
        ("tangential_control = \"forced\"".into(), "forced", &["did you mean force?"]),
        ("tangential_control = \"rig\"".into(), "[loading]", &["loading.rig_stiffness is missing"]),
        ("rig_stiffness = 0".into(), "rig_stiffness", &["is outside (0, inf)"]),
        ("rig_stiffness = \"1 N\"".into(), "rig_stiffness", &["expected a stiffness such as \"5 MN/m\""]),
        (
            "tangential_control = \"force\"\nrig_stiffness = 1".into(),
            "rig_stiffness",
            &["has no meaning beside loading.tangential_control = \"force\""],
        ),
        ("blocks = []".into(), "blocks", &["is empty"]),
        ("blocks = 3".into(), "blocks", &["expected an array"]),
        ("blocks = [1]".into(), "blocks", &["loading.blocks[0]", "expected a table"]),
        ("[[loading.blocks]]".into(), "blocks", &["loading.blocks[0].cycles or loading.blocks[0].tau"]),
        ("[[loading.blocks]]\ncycles = 0".into(), "cycles = 0", &["loading.blocks[0].cycles = 0 is outside"]),
        ("[[loading.blocks]]\ncycles = 1\namplitude_factor = -1".into(), "amplitude_factor", &["is outside [0, inf)"]),
        ("[[loading.blocks]]\ncycles = 1\nindentation_factor = 0".into(), "indentation_f", &["is outside (0, inf)"]),
        ("[[loading.blocks]]\ncycles = 1\nfactor = 2".into(), "factor", &["loading.blocks[0].factor is not a key"]),
        (
            "[[loading.blocks]]\ncycles = 1\namplitude_factor = 0\n[[loading.blocks]]\ncycles = 2\namplitude_factor = 0.0".into(),
            "blocks",
            &["has only amplitude factors of 0"],
        ),
        (
            "[[loading.blocks]]\ncycles = 1\n[[loading.blocks]]\ntau = 1".into(),
            "tau = 1",
            &["loading.blocks[1].tau does not go by the clock of loading.blocks[0].cycles"],
        ),
        ("repeat = true".into(), "repeat", &["has no meaning without loading.blocks"]),
        ("repeat = 1\n[[loading.blocks]]\ncycles = 1".into(), "repeat", &["expected true or false, found an integer"]),
        // Tangential control is for tangential oscillation.
        (format!("tangential_control = \"force\"\n{orbit}"), "orbit", &["a held tangential force", "which component", "remove loading.tangential_control"]),
        (format!("rig_stiffness = 1e6\n{oscillation}amplitude_ratio = 0.1"), "normal_osc", &["a rig", "changes with the indentation", "remove loading.rig_stiffness"]),
        // The closed form of a cycle.
        (numerics("cycle = \"closed-form\"", orbit), "closed-form", &["holds for tangential oscillation alone"]),
        (numerics("cycle = \"closed-form\"", &fast("2")), "closed-form", &["holds for tangential oscillation alone"]),
        (numerics("substeps = 1", ""), "substeps", &["numerics.substeps = 1 is outside 2 to 100000"]),
        (numerics("substeps = 100001", ""), "substeps", &["is outside 2 to 100000"]),
        ("wear_from = \"shakedown\"\n".into(), "wear_from", &["settled", "first-cycle"]),
        (format!("wear_from = \"first-cycle\"\n{orbit}"), "orbit", &["settles in the course of many cycles", "loading.wear_from"]),
    ];
    for (loading, shown, words) in &cases {
        refused(&scene(FRICTION, WEAR, &format!("{LOADING}{loading}")), shown, words);
    }
    // The amplitude of a path is its own.
    refused(
        &scene(FRICTION, WEAR, &format!("{BARE}[loading.orbit]\ntransverse_ratio = 1")),
        "[loading]",
        &["exactly one of loading.amplitude"],
    );
    // What the contact cannot give.
    let deep = LOADING.replace("2 um", "2e200 m");
    let found =
        Scene::from_toml(&scene(FRICTION, WEAR, &format!("{deep}{orbit}")), "scene.toml").unwrap_err();
    assert!(found.to_string().contains("too large"), "{found}");
    let resting = LOADING.replace("\"1 um\"", "0");
    refused(
        &scene(FRICTION, WEAR, &format!("{resting}{orbit}")),
        "transverse_ratio",
        &["gives an amplitude of 0e0 m"],
    );
}

#[test]
fn a_held_normal_force_goes_with_nothing_that_changes_the_indentation() {
    let loading = "[loading]\nnormal_force = 50\namplitude = \"1 um\"\ntau = 30\n";
    let with = |rest: &str| scene(FRICTION, WEAR, &format!("{loading}{rest}"));
    let words = ["loading.normal_force decides", "give loading.initial_force or loading.indentation"];
    refused(
        &with("[loading.normal_oscillation]\namplitude_ratio = 0.1\nfrequency_ratio = 1"),
        "normal_osc",
        &words,
    );
    refused(
        &with("[[loading.blocks]]\ncycles = 1\nindentation_factor = 1.5"),
        "blocks",
        &["loading.normal_force decides"],
    );
    assert!(
        read(&with("[[loading.blocks]]\ncycles = 1\namplitude_factor = 0.5")).conditions().holds_normal_force
    );
    assert!(read(&with("[loading.orbit]\ntransverse_ratio = 0.5")).conditions().holds_normal_force);

    let bare = "[loading]\nnormal_force = 50\ntau = 30\n[loading.path]\nfile = \"path.csv\"\n";
    for (rows, taken) in [("0,0,0\n1e-6,0,1e-8\n0,0,0\n", false), ("0,0\n1e-6,0\n0,0\n", true)] {
        let folder = folder_with(rows);
        let file = folder.path().join("scene.toml");
        fs::write(&file, scene(FRICTION, WEAR, bare)).expect("the scene");
        match Scene::from_path(&file) {
            Ok(scene) => assert!(taken && scene.conditions().holds_normal_force),
            Err(error) => assert!(!taken && error.to_string().contains(words[0]), "{error}"),
        }
    }
    let folder = folder_with("0,0\n1e-6,0\n0,0\n");
    let file = folder.path().join("scene.toml");
    let control = bare.replace("tau = 30", "tau = 30\nrig_stiffness = 1e6");
    fs::write(&file, scene(FRICTION, WEAR, &control)).expect("the scene");
    assert!(
        Scene::from_path(&file)
            .unwrap_err()
            .to_string()
            .contains("loading.path does not go together with a rig")
    );
    let amplitude = bare.replace("tau = 30", "tau = 30\nstick_ratio = 0.5");
    fs::write(&file, scene(FRICTION, WEAR, &amplitude)).expect("the scene");
    let found = Scene::from_path(&file).unwrap_err().to_string();
    assert!(found.contains("loading.stick_ratio and loading.path exclude each other"), "{found}");
}

#[test]
fn what_is_not_plain_is_warned_about_and_shown() {
    let text = scene(
        "[friction.static-kinetic]\nstatic_coefficient = 0.7\nkinetic_coefficient = 0.5\n[friction.history]\nfinal_factor = 0.5\ntau = 3",
        "[wear.threshold]\ncoefficient = 1e-14\npressure = \"50 MPa\"",
        &format!(
            "{LOADING}repeat = true\n[[loading.blocks]]\ntau = 2\namplitude_factor = 0.5\n[[loading.blocks]]\ntau = 1"
        ),
    );
    let scene = read(&text);
    let [warning] = scene.warnings() else { panic!("{:?}", scene.warnings()) };
    for words in [
        "the limit in closed form is that of plain tangential oscillation",
        "static and kinetic friction",
        "wear above a threshold",
        "blocks",
        "first cycle",
    ] {
        assert!(warning.contains(words), "{warning}");
    }
    let report = CheckReport::new(&scene).expect("a report");
    let shown = report.text();
    for words in [
        "static 0.7, kinetic 0.5",
        "Archard above 50 MPa",
        "2 τ at 0.5 of the amplitude",
        "repeated",
        "to 0.5 of the first",
    ] {
        assert!(shown.contains(words), "{shown}");
    }
    let found: serde_json::Value = serde_json::from_str(&json(&report)).expect("JSON");
    let conditions = &found["conditions"];
    assert_eq!(conditions["friction"]["law"], "static-kinetic");
    assert_eq!(conditions["friction"]["kinetic_coefficient"], 0.5);
    assert_eq!(conditions["friction_history"]["final_factor"], 0.5);
    assert_eq!(conditions["wear"]["pressure"], 5e7);
    assert_eq!(conditions["blocks"][0]["amplitude_factor"], 0.5);
    assert_eq!((&conditions["clock"], &conditions["repeat"]), (&"tau".into(), &true.into()));
    assert_eq!(conditions["tangential_control"]["kind"], "displacement");
    assert_eq!(found["friction_coefficient"], 0.7);

    let recorded = read_path("0,0\n1e-6,0\n0,1e-6\n", "").unwrap();
    let report = CheckReport::new(&recorded).expect("a report");
    assert!(report.text().contains("path path.csv, 3 rows"), "{}", report.text());
    let found: serde_json::Value = serde_json::from_str(&json(&report)).expect("JSON");
    let expected = serde_json::json!({ "kind": "path", "source": "path.csv", "rows": 3 });
    assert_eq!(found["conditions"]["mode"], expected);
}

#[test]
fn the_reference_of_every_law_is_that_of_its_scene() {
    let contact: InitialContact = read(&scene(FRICTION, WEAR, LOADING)).contact().expect("a contact");
    for (law, expected) in [
        (wear(Archard { coefficient: 3.0 }), 3.0),
        (wear(DissipatedEnergy { coefficient: 3.0 }), 3.0 * 0.6),
        (wear(Threshold { coefficient: 3.0, pressure: 1.0 }), 3.0),
        (wear(NonLocal { coefficient: 3.0, length: 1.0 }), 3.0),
    ] {
        assert_eq!(contact.reference_wear(&*law).coefficient, expected, "{law:?}");
    }
}

/// Everything at once that goes together.
fn rich() -> String {
    scene(
        "[friction.load-dependent]\ncoefficient = 0.6\nexponent = -0.2\n[friction.history]\nfactors = [1, 0.8]\nat_cycles = [0, 1e4]",
        "[wear.power-law]\ncoefficient = 1e-14\npressure_exponent = 1.1\nslip_exponent = 0.9\n[wear.history]\nfinal_factor = 0.5\ncycles = 1e5",
        &format!(
            "{LOADING}repeat = true\n[loading.normal_oscillation]\namplitude_ratio = 0.2\nfrequency_ratio = \"3/2\"\nphase = \"35 deg\"\n\
             [[loading.blocks]]\ncycles = 100\namplitude_factor = 0.5\nindentation_factor = 1.2\n[[loading.blocks]]\ncycles = 1e3\n\
             [numerics]\ncycle = \"resolved\"\nsubsteps = 100"
        ),
    )
}

#[test]
fn everything_at_once_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let few = rich().replace("substeps = 100", "substeps = 40\nsprings = 16");
    let few = few.replace("tau = 30", "cycles = 1500");
    fs::write(folder.path().join("scene.toml"), few).expect("the scene");
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("fretwear"));
    let output = command.current_dir(folder.path()).args(["run", "scene.toml"]).output().expect("a run");
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{message}");
    assert!(folder.path().join("scene.h5").exists());
}

fn fixed() -> Config {
    Config { cases: 2000, rng_seed: RngSeed::Fixed(11), failure_persistence: None, ..Config::default() }
}

proptest! {
    #![proptest_config(fixed())]

    #[test]
    fn no_mutation_of_a_rich_scene_makes_the_reader_panic_or_gives_what_is_no_number(
        edits in prop::collection::vec((0usize..1100, 0usize..12, "[-0-9a-z_.=\\[\\]{}\"'#\n ,e^/µ\u{0}]{0,8}"), 1..4)
    ) {
        let mut text = rich();
        for (at, length, insert) in edits {
            let floor = |at: usize| (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
            let range = floor(at)..floor(at + length);
            text.replace_range(range, &insert);
        }
        if let Ok(scene) = Scene::from_toml(&text, "x") {
            let conditions = scene.conditions();
            prop_assert!(scene.friction().coefficient > 0.0 && scene.wear().coefficient.is_normal());
            prop_assert!(conditions.friction_history.range()[0] > 0.0 && conditions.wear_history.range()[0] >= 0.0);
            prop_assert!(conditions.blocks.iter().all(|it| it.duration > 0.0 && it.indentation_factor > 0.0));
            if let Some(oscillation) = oscillation(&*conditions.mode) {
                let NormalOscillation { amplitude, frequency_ratio: [over, under], phase } = *oscillation;
                prop_assert!(amplitude > 0.0 && phase.is_finite());
                prop_assert!((1..=64).contains(&over) && (1..=64).contains(&under));
            }
        }
    }

    #[test]
    fn a_ratio_of_whole_numbers_is_found_from_its_decimal_digits(over in 1u32..=64, under in 1u32..=64) {
        let value = f64::from(over) / f64::from(under);
        let keys = |ratio: &str| format!("[loading.normal_oscillation]\namplitude_ratio = 0.1\nfrequency_ratio = {ratio}");
        let [from_digits, from_words] = [keys(&value.to_string()), keys(&format!("\"{over}/{under}\""))].map(|it| with_loading(&it).mode);
        prop_assert_eq!(&from_digits, &from_words);
        let [m, n] = oscillation(&*from_digits).expect("an oscillation").frequency_ratio;
        prop_assert_eq!(m * under, n * over);
    }
}
