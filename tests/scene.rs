//! Scenes: what is read, exactly, and how everything else is refused.

use std::path::Path;

use fretwear::contact::half_space::HalfSpace;
use fretwear::contact::indenter::Indenter;
use fretwear::laws::conditions::Conditions;
use fretwear::laws::loading::{Amplitude, Duration, Load};
use fretwear::report::CheckReport;
use fretwear::scene::{Cycle, Numerics, Output, Scene, Stepper};
use fretwear::units::{Dimension, parse};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

const VALID: &str = r#"title = "Valid"
[indenter.paraboloid]
radius = "10 mm"
[half_space]
grading = 0.2
reference_depth = "1 m"
modulus = "210 GPa"
poisson_ratio = 0.3
[friction.coulomb]
coefficient = 0.6
[wear.archard]
coefficient = "1e-14 1/Pa"
[loading]
initial_force = "50 N"
amplitude = "1 um"
cycles = 1e6
[numerics]
accuracy = 1e-4
[output]
snapshots = 50
"#;

fn read(text: &str) -> Scene {
    Scene::from_toml(text, "scene.toml").unwrap_or_else(|error| panic!("{error}\n\n{text}"))
}

fn edited(old: &str, new: &str) -> String {
    assert_eq!(VALID.matches(old).count(), 1, "{old:?} must occur once");
    VALID.replace(old, new)
}

fn refusal(text: &str) -> String {
    match Scene::from_toml(text, "scene.toml") {
        Ok(_) => panic!("this scene was taken:\n{text}"),
        Err(error) => {
            let message = error.to_string();
            assert!(shows_its_line(&message), "{message}");
            message
        }
    }
}

/// Whether a message begins with file, line and column and shows the line with a caret under it.
fn shows_its_line(message: &str) -> bool {
    let place = message.strip_prefix("scene.toml:").unwrap_or_default();
    let mut numbers = place.splitn(3, ':').map(|part| part.parse::<usize>().is_ok());
    numbers.next() == Some(true) && numbers.next() == Some(true) && message.contains('^')
}

#[test]
fn every_bad_value_is_refused_at_its_line_with_its_key_and_a_cure() {
    const RADIUS: &str = "radius = \"10 mm\"";
    const GRADING: &str = "grading = 0.2";
    const MODULUS: &str = "modulus = \"210 GPa\"";
    const POISSON: &str = "poisson_ratio = 0.3";
    const FRICTION: &str = "coefficient = 0.6";
    const WEAR: &str = "coefficient = \"1e-14 1/Pa\"";
    const FORCE: &str = "initial_force = \"50 N\"";
    const AMPLITUDE: &str = "amplitude = \"1 um\"";
    const CYCLES: &str = "cycles = 1e6";
    const ACCURACY: &str = "accuracy = 1e-4";
    const SNAPSHOTS: &str = "snapshots = 50";
    // (replaced, by what, text on the line that must be shown, words of the message)
    let cases: &[(&str, &str, &str, &[&str])] = &[
        // Syntax.
        (RADIUS, "radius = ", "radius = ", &["not valid TOML"]),
        (RADIUS, "radius = \"10 mm", "radius = \"10 mm", &["not valid TOML"]),
        (RADIUS, "radius = 10 mm", "radius = 10 mm", &["not valid TOML"]),
        (RADIUS, "radius = \"10 mm\"\nradius = 2", "radius = 2", &["not valid TOML", "duplicate"]),
        ("[half_space]", "[half_space", "[half_space", &["not valid TOML"]),
        ("[loading]", "[half_space]", "[half_space]", &["not valid TOML", "duplicate"]),
        (RADIUS, "radius = \"10 mm\" \u{1}", "radius =", &["not valid TOML"]),
        // Types.
        (RADIUS, "radius = true", "radius = true", &["indenter.paraboloid.radius", "a length", "a boolean"]),
        (RADIUS, "radius = [1, 2]", "radius = [1, 2]", &["indenter.paraboloid.radius", "an array"]),
        (RADIUS, "radius = { value = 1 }", "radius = {", &["indenter.paraboloid.radius", "a table"]),
        (RADIUS, "radius = 2024-01-01", "radius = 2024", &["indenter.paraboloid.radius", "a date"]),
        (RADIUS, "radius = 0x10", "radius = 0x10", &["indenter.paraboloid.radius", "decimal"]),
        ("title = \"Valid\"", "title = 3", "title = 3", &["title", "expected a string, found an integer"]),
        ("title = \"Valid\"", "title = \"a\\nb\"", "title = ", &["title", "one line"]),
        ("title = \"Valid\"", "title = \"a\\u0000b\"", "title = ", &["title", "control character"]),
        (
            "title = \"Valid\"\n[indenter.paraboloid]\nradius = \"10 mm\"",
            "indenter = 3",
            "indenter = 3",
            &["indenter: expected a table"],
        ),
        ("[loading]", "[[loading]]", "[[loading]]", &["loading: expected a table", "an array"]),
        // Units.
        (
            RADIUS,
            "radius = \"10 MPa\"",
            "10 MPa",
            &["indenter.paraboloid.radius", "expected a length such as \"5 mm\"", "(a pressure)"],
        ),
        (RADIUS, "radius = \"10\"", "radius = \"10\"", &["indenter.paraboloid.radius", "has no unit"]),
        (
            RADIUS,
            "radius = \"mm\"",
            "\"mm\"",
            &["indenter.paraboloid.radius", "does not begin with a number"],
        ),
        (RADIUS, "radius = \"\"", "\"\"", &["indenter.paraboloid.radius", "does not begin with a number"]),
        (RADIUS, "radius = \"1,5 mm\"", "1,5", &["indenter.paraboloid.radius", "decimal comma"]),
        (RADIUS, "radius = \"10 furlong\"", "furlong", &["indenter.paraboloid.radius", "no known unit"]),
        (
            RADIUS,
            "radius = \"nan mm\"",
            "nan",
            &["indenter.paraboloid.radius", "does not begin with a number"],
        ),
        (RADIUS, "radius = \"1e999 mm\"", "1e999", &["indenter.paraboloid.radius", "too large"]),
        (RADIUS, "radius = \"10 mm)\"", "10 mm)", &["indenter.paraboloid.radius", "out of place"]),
        (RADIUS, "radius = \"10 (mm\"", "10 (mm", &["indenter.paraboloid.radius", "not closed"]),
        (RADIUS, "radius = \"10 mm^\"", "mm^", &["indenter.paraboloid.radius", "no number"]),
        (RADIUS, "radius = \"10 m/\"", "10 m/", &["indenter.paraboloid.radius", "ends too early"]),
        (MODULUS, "modulus = \"210 Gpa\"", "Gpa", &["half_space.modulus", "did you mean GPa?"]),
        (
            MODULUS,
            "modulus = \"210 mm\"",
            "210 mm",
            &["half_space.modulus", "expected a pressure", "(a length)"],
        ),
        (WEAR, "coefficient = \"1e-5 mm^3/N m\"", "mm^3/N m", &["wear.archard.coefficient", "a/(b c)"]),
        (
            WEAR,
            "coefficient = \"1e-5 mm^3/Jm\"",
            "mm^3/Jm",
            &["wear.archard.coefficient", "did you mean \"J m\"?"],
        ),
        (
            WEAR,
            "coefficient = \"1e-14 Pa\"",
            "1e-14 Pa",
            &["wear.archard.coefficient", "expected an inverse pressure"],
        ),
        (AMPLITUDE, "amplitude = \"1 N\"", "1 N\"", &["loading.amplitude", "expected a length", "(a force)"]),
        (CYCLES, "cycles = \"1e6 s\"", "1e6 s", &["loading.cycles", "expected a plain number", "(a time)"]),
        // Ranges.
        (RADIUS, "radius = 0", "radius = 0", &["indenter.paraboloid.radius = 0 is outside (0, inf)"]),
        (RADIUS, "radius = -1", "radius = -1", &["indenter.paraboloid.radius = -1 is outside"]),
        (
            RADIUS,
            "radius = nan",
            "radius = nan",
            &["indenter.paraboloid.radius = nan is not a finite number"],
        ),
        (
            RADIUS,
            "radius = -inf",
            "radius = -inf",
            &["indenter.paraboloid.radius = -inf is not a finite number"],
        ),
        (
            RADIUS,
            "radius = 1e999",
            "radius = 1e999",
            &["indenter.paraboloid.radius = 1e999 is not a finite number"],
        ),
        (GRADING, "grading = 1.5", "grading = 1.5", &["half_space.grading = 1.5 is outside (-1, 1)"]),
        (GRADING, "grading = -1", "grading = -1", &["half_space.grading = -1 is outside (-1, 1)"]),
        (POISSON, "poisson_ratio = 0.6", "= 0.6", &["half_space.poisson_ratio = 0.6 is outside (-1, 0.5]"]),
        (POISSON, "poisson_ratio = \"alike\"", "alike", &["half_space.poisson_ratio", "\"similar\""]),
        (
            "reference_depth = \"1 m\"",
            "reference_depth = 0",
            "reference_depth",
            &["half_space.reference_depth = 0 is outside"],
        ),
        (FRICTION, "coefficient = 0", "coefficient = 0", &["friction.coulomb.coefficient = 0 is outside"]),
        (WEAR, "coefficient = -1e-14", "-1e-14", &["wear.archard.coefficient = -1e-14 is outside"]),
        (FORCE, "initial_force = \"0 N\"", "0 N", &["loading.initial_force = \"0 N\" is outside (0, inf)"]),
        (AMPLITUDE, "amplitude = -1e-9", "-1e-9", &["loading.amplitude = -1e-9 is outside [0, inf)"]),
        (AMPLITUDE, "stick_ratio = 0", "stick_ratio", &["loading.stick_ratio = 0 is outside (0, 1]"]),
        (AMPLITUDE, "stick_ratio = 1.01", "stick_ratio", &["loading.stick_ratio = 1.01 is outside (0, 1]"]),
        (
            AMPLITUDE,
            "amplitude_ratio = -0.1",
            "amplitude_ratio",
            &["loading.amplitude_ratio = -0.1 is outside"],
        ),
        (CYCLES, "cycles = 0", "cycles = 0", &["loading.cycles = 0 is outside"]),
        (CYCLES, "tau = inf", "tau = inf", &["loading.tau = inf is not a finite number"]),
        (CYCLES, "until_rate = 1.0", "until_rate", &["loading.until_rate = 1.0 is outside [1e-14, 1)"]),
        (
            CYCLES,
            "until_rate = 1e-15",
            "until_rate",
            &["is outside [1e-14, 1)", "rounding", "give loading.tau instead"],
        ),
        (ACCURACY, "accuracy = 0", "accuracy = 0", &["numerics.accuracy = 0 is outside"]),
        (ACCURACY, "accuracy = 1", "accuracy = 1", &["numerics.accuracy = 1 is outside"]),
        (ACCURACY, "springs = 7", "springs = 7", &["numerics.springs = 7 is outside [8, inf)"]),
        (ACCURACY, "springs = -5", "springs = -5", &["numerics.springs = -5 is outside"]),
        (ACCURACY, "springs = 99999999999999999999999", "springs", &["numerics.springs"]),
        (ACCURACY, "springs = 50.5", "springs = 50.5", &["numerics.springs", "whole number"]),
        (ACCURACY, "tolerance = 0.2", "tolerance", &["numerics.tolerance = 0.2 is outside (0, 0.1]"]),
        (ACCURACY, "tolerance = 0", "tolerance", &["numerics.tolerance = 0 is outside (0, 0.1]"]),
        (
            ACCURACY,
            "checkpoint_interval = -1",
            "checkpoint",
            &["numerics.checkpoint_interval = -1 is outside"],
        ),
        (
            ACCURACY,
            "checkpoint_interval = 1e300",
            "checkpoint",
            &["numerics.checkpoint_interval = 1e300 is outside"],
        ),
        (SNAPSHOTS, "snapshots = 0", "snapshots = 0", &["output.snapshots = 0 is outside 1 to 100000"]),
        (SNAPSHOTS, "snapshots = 1000000", "snapshots", &["output.snapshots = 1000000 is outside"]),
        (SNAPSHOTS, "at_cycles = 5", "at_cycles", &["output.at_cycles", "expected an array"]),
        (SNAPSHOTS, "at_cycles = [1, -5]", "at_cycles", &["output.at_cycles[1] = -5 is outside"]),
        (SNAPSHOTS, "at_cycles = [1,\n nan]", " nan]", &["output.at_cycles[1] = nan is not a finite number"]),
        (SNAPSHOTS, "at_cycles = [\"x\"]", "at_cycles", &["output.at_cycles[0]", "number"]),
        (
            SNAPSHOTS,
            "at_cycles = [2e6]",
            "at_cycles",
            &["output.at_cycles[0] = 2e6 lies after the end", "loading.cycles = 1000000"],
        ),
        // Keys.
        (RADIUS, "radis = \"10 mm\"", "radis", &["indenter.paraboloid.radis", "radius"]),
        ("[half_space]", "[halfspace]", "[halfspace]", &["halfspace", "did you mean half_space?"]),
        (GRADING, "grading = 0.2\ncolour = 3", "colour", &["half_space.colour is not a key"]),
        (GRADING, "Grading = 0.2", "Grading", &["half_space.Grading", "did you mean grading?"]),
        ("title =", "\"a\\u001b[31m\" = 1\ntitle =", "u001b", &["is not a key of a scene"]),
        (
            "[indenter.paraboloid]",
            "[indenter.parabola]",
            "parabola",
            &["indenter.parabola", "did you mean paraboloid?"],
        ),
        (
            "[friction.coulomb]",
            "[friction.stribeck]",
            "stribeck",
            &[
                "friction.stribeck",
                "offers coulomb, static-kinetic, load-dependent, wear-dependent or history",
            ],
        ),
        ("[wear.archard]", "[wear.power]", "[wear.power]", &["wear.power", "did you mean power-law?"]),
        (FRICTION, "coeficient = 0.6", "coeficient", &["friction.coulomb.coeficient", "coefficient"]),
        (ACCURACY, "stepper = \"implict\"", "stepper", &["numerics.stepper", "did you mean implicit?"]),
        (
            ACCURACY,
            "stepper = \"every_cycle\"",
            "stepper",
            &["numerics.stepper", "did you mean every-cycle?"],
        ),
        (ACCURACY, "cycle = \"open\"", "cycle = ", &["numerics.cycle"]),
        // Alternatives: none and two.
        (
            "[indenter.paraboloid]\nradius = \"10 mm\"",
            "[indenter]",
            "[indenter]",
            &["indenter.paraboloid", "indenter.cone", "exactly one"],
        ),
        (
            RADIUS,
            "radius = 1\n[indenter.cone]\nslope = 0.1",
            "[indenter.cone]",
            &["indenter.paraboloid and indenter.cone exclude"],
        ),
        (MODULUS, "", "[half_space]", &["half_space.modulus is missing", "210 GPa"]),
        (
            MODULUS,
            "modulus = 1\nnormal_stiffness = 1",
            "normal_stiffness",
            &["half_space.modulus and half_space.normal_stiffness exclude"],
        ),
        (
            MODULUS,
            "normal_stiffness = 1",
            "reference_depth",
            &["half_space.reference_depth", "beside half_space.normal_stiffness"],
        ),
        (
            MODULUS,
            "modulus = 1\nstiffness_ratio = 1",
            "stiffness_ratio",
            &["half_space.stiffness_ratio", "beside half_space.modulus"],
        ),
        (
            FORCE,
            "",
            "[loading]",
            &["loading.indentation, loading.initial_force or loading.normal_force", "exactly one"],
        ),
        (
            FORCE,
            "initial_force = 50\nindentation = 1e-6",
            "indentation",
            &["loading.initial_force and loading.indentation exclude"],
        ),
        (
            AMPLITUDE,
            "",
            "[loading]",
            &[
                "loading.amplitude, loading.stroke, loading.tangential_force, loading.amplitude_ratio, loading.stick_ratio or loading.path",
                "exactly one",
            ],
        ),
        (
            AMPLITUDE,
            "amplitude = 1e-6\nstick_ratio = 0.5",
            "stick_ratio",
            &["loading.amplitude and loading.stick_ratio exclude"],
        ),
        (CYCLES, "", "[loading]", &["loading.cycles, loading.tau or loading.until_rate", "exactly one"]),
        (CYCLES, "cycles = 1\ntau = 1", "tau = 1", &["loading.cycles and loading.tau exclude"]),
        (SNAPSHOTS, "snapshots = 5\nat_tau = [1]", "at_tau", &["output.snapshots and output.at_tau exclude"]),
        (
            "[friction.coulomb]\ncoefficient = 0.6",
            "[friction]",
            "[friction]",
            &["friction.coulomb", "exactly one"],
        ),
        // Missing.
        (RADIUS, "", "[indenter.paraboloid]", &["indenter.paraboloid.radius is missing"]),
        (GRADING, "", "[half_space]", &["half_space.grading is missing"]),
        (POISSON, "", "[half_space]", &["half_space.poisson_ratio is missing", "similar"]),
        (FRICTION, "", "[friction.coulomb]", &["friction.coulomb.coefficient is missing"]),
        ("[wear.archard]\ncoefficient = \"1e-14 1/Pa\"\n", "", "", &["wear is missing", "[wear.archard]"]),
        (
            "[loading]\ninitial_force = \"50 N\"\namplitude = \"1 um\"\ncycles = 1e6\n",
            "",
            "",
            &["loading is missing"],
        ),
        (
            FORCE,
            "initial_force = 50\nnormal_force = 50",
            "normal_force",
            &["loading.initial_force and loading.normal_force exclude"],
        ),
        // The other shapes and bodies.
        (
            "[indenter.paraboloid]\nradius = \"10 mm\"",
            "[indenter.cone]",
            "[indenter.cone]",
            &["indenter.cone.slope or indenter.cone.half_angle"],
        ),
        (
            "[indenter.paraboloid]\nradius = \"10 mm\"",
            "[indenter.cone]\nslope = 1\nhalf_angle = 1",
            "half_angle",
            &["exclude"],
        ),
        (
            "[indenter.paraboloid]\nradius = \"10 mm\"",
            "[indenter.cone]\nhalf_angle = 80",
            "half_angle",
            &["indenter.cone.half_angle = 80", "radian"],
        ),
        (
            "[indenter.paraboloid]\nradius = \"10 mm\"",
            "[indenter.cone]\nhalf_angle = \"90 deg\"",
            "half_angle",
            &["indenter.cone.half_angle"],
        ),
        (
            "[indenter.paraboloid]\nradius = \"10 mm\"",
            "[indenter.cone]\nslope = \"5 deg\"",
            "slope",
            &["indenter.cone.slope", "(an angle)"],
        ),
        (
            "[indenter.paraboloid]\nradius = \"10 mm\"",
            "[indenter.power-law]\ncoefficient = \"3 m\"\nexponent = 3",
            "3 m",
            &["indenter.power-law.coefficient", "m^-2"],
        ),
        (
            "[indenter.paraboloid]\nradius = \"10 mm\"",
            "[indenter.power-law]\ncoefficient = 3",
            "[indenter.power-law]",
            &["exponent is missing"],
        ),
        (
            POISSON,
            "poisson_ratio = 0.3\n[counter_body]\ngrading = 0.3\nmodulus = 1\npoisson_ratio = 0",
            "grading = 0.3",
            &["counter_body.grading = 0.3 differs from half_space.grading = 0.2"],
        ),
        (
            POISSON,
            "poisson_ratio = 0.3\n[counter_body]\nmodulus = 1\nreference_depth = 1\npoisson_ratio = 0.9",
            "= 0.9",
            &["counter_body.poisson_ratio = 0.9 is outside"],
        ),
        (
            POISSON,
            "poisson_ratio = 0.3\n[counter_body]",
            "[counter_body]",
            &["counter_body.modulus", "exactly one"],
        ),
    ];
    assert!(cases.len() >= 60);
    for &(old, new, shown, words) in cases {
        let text = edited(old, new);
        let message = refusal(&text);
        for word in words {
            assert!(message.contains(word), "no {word:?} in\n{message}\nfor {new:?}");
        }
        if shown.is_empty() {
            continue;
        }
        let number: usize = message.split(':').nth(1).and_then(|line| line.parse().ok()).unwrap_or_default();
        let line = text.lines().nth(number.wrapping_sub(1)).unwrap_or_default();
        assert!(line.contains(shown), "line {number}, {line:?}, has no {shown:?}:\n{message}");
        assert!(message.contains('^'), "{message}");
        assert!(!message.contains(|c: char| c.is_control() && c != '\n'), "{message:?}");
    }
}

#[test]
fn an_error_shows_its_place_as_a_compiler_does() {
    let message = refusal(&edited("grading = 0.2", "  grading = 1.5 # µ"));
    let expected = "scene.toml:5:13: half_space.grading = 1.5 is outside (-1, 1)\n  |\n5 |   grading = 1.5 # µ\n  |             ^^^";
    assert_eq!(message, expected);
}

#[test]
fn an_error_on_a_line_of_a_megabyte_stays_short() {
    let list = vec!["1"; 100_001].join(",");
    let message = refusal(&edited("snapshots = 50", &format!("at_cycles = [{list}]")));
    assert!(message.contains("output.at_cycles has 100001 entries") && message.len() < 800, "{message}");
    let late = format!("at_cycles = [{}, -1, {}]", vec!["1"; 40_000].join(","), vec!["1"; 40_000].join(","));
    let message = refusal(&edited("snapshots = 50", &late));
    assert!(message.contains("output.at_cycles[40000] = -1") && message.len() < 800, "{message}");
}

#[test]
fn quantities_are_read_to_the_last_bit() {
    let cases = [
        ("10 mm", Dimension::LENGTH, 0.01),
        ("0.1 mm", Dimension::LENGTH, 1e-4),
        ("3 um", Dimension::LENGTH, 3e-6),
        ("3 \u{b5}m", Dimension::LENGTH, 3e-6),
        ("3\u{3bc}m", Dimension::LENGTH, 3e-6),
        ("0.325 um", Dimension::LENGTH, 3.25e-7),
        ("+.5 nm", Dimension::LENGTH, 5e-10),
        ("7. cm", Dimension::LENGTH, 0.07),
        ("1E2 km", Dimension::LENGTH, 1e5),
        ("1 mm^(1/2) mm^0.5", Dimension::LENGTH, 1e-3),
        ("210 GPa", Dimension::PRESSURE, 210e9),
        ("1.1 MN/m^2", Dimension::PRESSURE, 1.1e6),
        ("7 kg/(m s^2)", Dimension::PRESSURE, 7.0),
        ("2.3 N/mm²", Dimension::PRESSURE, 2.3e6),
        ("2 kN", Dimension::FORCE, 2000.0),
        ("5 kg m s⁻²", Dimension::FORCE, 5.0),
        ("3 J/m", Dimension::FORCE, 3.0),
        ("1e-14 1/Pa", Dimension::INVERSE_PRESSURE, 1e-14),
        ("1e-8 1/MPa", Dimension::INVERSE_PRESSURE, 1e-14),
        ("1.5 MPa^-1", Dimension::INVERSE_PRESSURE, 1.5e-6),
        ("1e-5 mm^3/(N m)", Dimension::INVERSE_PRESSURE, 1e-14),
        ("1e-5 mm^3/(N·m)", Dimension::INVERSE_PRESSURE, 1e-14),
        ("1e-5 mm³/(N*m)", Dimension::INVERSE_PRESSURE, 1e-14),
        ("1e-5 mm^3/N/m", Dimension::INVERSE_PRESSURE, 1e-14),
        ("1e-6 mm3/Nm", Dimension::INVERSE_PRESSURE, 1e-15),
        ("2 mm³/(N·m)", Dimension::INVERSE_PRESSURE, 2e-9),
        ("2 mm³/(N\u{22c5}m)", Dimension::INVERSE_PRESSURE, 2e-9),
        ("3 mm3 N-1 m-1", Dimension::INVERSE_PRESSURE, 3e-9),
        ("4 mm2/kN", Dimension::INVERSE_PRESSURE, 4e-9),
        ("5 N/mm", Dimension::STIFFNESS, 5000.0),
        ("5 kNm/m2", Dimension::STIFFNESS, 5000.0),
        ("6 Nmm/mm", Dimension::FORCE, 6.0),
        ("20 Hz", Dimension::FREQUENCY, 20.0),
        ("2 kHz", Dimension::FREQUENCY, 2000.0),
        ("4 s-1", Dimension::FREQUENCY, 4.0),
        ("5\u{a0}\u{b5}m", Dimension::LENGTH, 5e-6),
        ("2 min", Dimension::TIME, 120.0),
        ("1.5 h", Dimension::TIME, 5400.0),
        ("30 ms", Dimension::TIME, 0.03),
        ("90 deg", Dimension::ANGLE, std::f64::consts::FRAC_PI_2),
        ("90°", Dimension::ANGLE, std::f64::consts::FRAC_PI_2),
        ("250 mrad", Dimension::ANGLE, 0.25),
        ("5 mm/m", Dimension::NUMBER, 0.005),
        ("0.6", Dimension::NUMBER, 0.6),
        ("3 N/m^2.2", Dimension::spring_stiffness(0.2), 3.0),
        ("3 kN/m^(2.2)", Dimension::spring_stiffness(0.2), 3000.0),
        ("4 1/mm", Dimension::profile_coefficient(2.0), 4000.0),
        ("4 m^-0.5", Dimension::profile_coefficient(1.5), 4.0),
    ];
    for (text, dimension, value) in cases {
        assert_eq!(parse(text, dimension), Ok(value), "{text}");
    }
    // A fractional power of a prefix cannot be exact.
    let stiffness = parse("1 N/mm^2.2", Dimension::spring_stiffness(0.2)).expect("a stiffness");
    assert!((stiffness / 10f64.powf(6.6) - 1.0).abs() < 5e-15, "{stiffness}");
}

#[test]
fn every_field_arrives() {
    let scene = read(VALID);
    assert_eq!(scene.title(), Some("Valid"));
    assert_eq!(*scene.indenter(), Indenter::paraboloid(0.01).unwrap());
    assert_eq!(scene.half_space().grading(), 0.2);
    assert!((scene.half_space().normal_stiffness() / (210e9 * 1.281130773) - 1.0).abs() < 1e-9);
    assert_eq!(scene.friction().coefficient, 0.6);
    assert_eq!(scene.wear().coefficient, 1e-14);
    assert_eq!(scene.loading().load, Load::InitialForce(50.0));
    assert_eq!(scene.loading().amplitude, Amplitude::Displacement(1e-6));
    assert_eq!(scene.loading().duration, Duration::Cycles(1e6));
    assert_eq!(scene.text(), VALID);
    assert!(scene.warnings().is_empty());
    assert_eq!(*scene.conditions(), Conditions::plain(*scene.friction(), *scene.wear()));
}

#[test]
fn numerics_and_output_have_defaults_that_serve() {
    let bare = read(&VALID[..VALID.find("[numerics]").expect("a table")]);
    let numerics = Numerics {
        accuracy: 1e-4,
        springs: None,
        stepper: Stepper::Implicit,
        tolerance: None,
        cycle: None,
        substeps: None,
        checkpoint_interval: 30.0,
    };
    assert_eq!(*bare.numerics(), numerics);
    assert_eq!(*bare.output(), Output::Snapshots(50));
    let empty = read(&edited("accuracy = 1e-4\n[output]\nsnapshots = 50", "[output]"));
    assert_eq!((empty.numerics(), empty.output()), (bare.numerics(), bare.output()));
}

#[test]
fn every_alternative_is_read() {
    let indenter =
        |table: &str| read(&edited("[indenter.paraboloid]\nradius = \"10 mm\"", table)).indenter().clone();
    assert_eq!(indenter("[indenter.sphere]\nradius = 0.02"), Indenter::sphere(0.02).unwrap());
    assert_eq!(indenter("[indenter.cone]\nslope = 0.1"), Indenter::cone(0.1).unwrap());
    assert_eq!(
        indenter("[indenter.power-law]\ncoefficient = \"2 m^-3\"\nexponent = 4"),
        Indenter::power_law(2.0, 4.0).unwrap()
    );
    let slope = indenter("[indenter.cone]\nhalf_angle = \"85 deg\"").profile_derivative(1.0);
    assert!((slope - 5f64.to_radians().tan()).abs() < 1e-15, "{slope}");

    let load = |line: &str| read(&edited("initial_force = \"50 N\"", line)).loading().load;
    assert_eq!(load("indentation = \"3 um\""), Load::Indentation(3e-6));
    assert_eq!(load("normal_force = \"3 N\""), Load::NormalForce(3.0));
    let amplitude = |line: &str| read(&edited("amplitude = \"1 um\"", line)).loading().amplitude;
    assert_eq!(amplitude("amplitude = 0"), Amplitude::Displacement(0.0));
    assert_eq!(amplitude("amplitude_ratio = 0.5"), Amplitude::Ratio(0.5));
    assert_eq!(amplitude("stick_ratio = 1"), Amplitude::StickRatio(1.0));
    let duration = |line: &str| read(&edited("cycles = 1e6", line)).loading().duration;
    assert_eq!(duration("tau = 30"), Duration::Tau(30.0));
    assert_eq!(duration("until_rate = 1e-8"), Duration::UntilRate(1e-8));

    let numerics = |lines: &str| *read(&edited("accuracy = 1e-4", lines)).numerics();
    assert_eq!(numerics("springs = 1_00").springs, Some(100));
    assert_eq!(numerics("tolerance = 1e-6").tolerance, Some(1e-6));
    assert_eq!(numerics("stepper = \"every-cycle\"").stepper, Stepper::EveryCycle);
    assert_eq!(numerics("stepper = \"cycle-jump\"").stepper, Stepper::CycleJump);
    assert_eq!(numerics("cycle = \"closed-form\"").cycle, Some(Cycle::ClosedForm));
    assert_eq!(numerics("cycle = \"resolved\"\nsubsteps = 200").cycle, Some(Cycle::Resolved));
    assert_eq!(numerics("cycle = \"resolved\"\nsubsteps = 200").substeps, Some(200));
    assert_eq!(
        numerics("cycle = \"closed-form\"\ncheckpoint_interval = \"1 min\"").checkpoint_interval,
        60.0
    );

    let output = |lines: &str| read(&edited("snapshots = 50", lines)).output().clone();
    assert_eq!(output("at_cycles = [100, 1, 1, 1e6]"), Output::AtCycles(vec![1.0, 100.0, 1e6]));
    assert_eq!(output("at_tau = []"), Output::AtTau(vec![]));
}

#[test]
fn a_half_space_is_given_by_its_springs_as_well() {
    let body = |lines: &str| {
        *read(&edited("reference_depth = \"1 m\"\nmodulus = \"210 GPa\"\npoisson_ratio = 0.3", lines))
            .half_space()
    };
    assert_eq!(
        body("normal_stiffness = 3e9\nstiffness_ratio = 0.7"),
        HalfSpace::from_stiffness(0.2, 3e9, 0.7).expect("springs")
    );
    let similar = body("normal_stiffness = \"3 GN/m^2.2\"");
    assert_eq!(similar.normal_stiffness(), 3e9);
    assert!((similar.stiffness_ratio() - 2.0 / (1.2 * 3.2)).abs() < 1e-15);
}

#[test]
fn a_counter_body_acts_in_series_and_may_leave_its_grading_out() {
    let alone = *read(VALID).half_space();
    for grading in ["", "grading = 0.2\n"] {
        let table = format!(
            "poisson_ratio = 0.3\n[counter_body]\n{grading}modulus = 210e9\nreference_depth = 1\npoisson_ratio = 0.3\n"
        );
        let pair = *read(&edited("poisson_ratio = 0.3\n", &table)).half_space();
        assert_eq!(pair.normal_stiffness(), alone.normal_stiffness() / 2.0);
        assert!((pair.stiffness_ratio() / alone.stiffness_ratio() - 1.0).abs() < 1e-15);
    }
}

#[test]
fn formal_similarity_is_warned_about_and_allowed() {
    let scene = read(
        &edited("grading = 0.2", "grading = -0.2")
            .replace("poisson_ratio = 0.3", "poisson_ratio = \"similar\""),
    );
    assert!((scene.half_space().stiffness_ratio() - 2.0 / (0.8 * 2.8)).abs() < 1e-15);
    assert!(
        matches!(scene.warnings(), [one] if one.contains("half_space.grading") && one.contains("0.5556"))
    );
    let physical = read(&edited("poisson_ratio = 0.3", "poisson_ratio = \"similar\""));
    assert!(physical.warnings().is_empty());
}

#[test]
fn an_accuracy_that_decides_nothing_is_warned_about() {
    let scene = read(&edited("accuracy = 1e-4", "accuracy = 1e-4\nsprings = 50\ntolerance = 1e-6"));
    assert!(matches!(scene.warnings(), [one] if one.contains("numerics.accuracy")), "{:?}", scene.warnings());
}

#[test]
fn line_ends_of_windows_a_byte_order_mark_and_inline_tables_are_read() {
    let plain = read(VALID);
    assert_eq!(read(&VALID.replace('\n', "\r\n")).loading(), plain.loading());
    assert_eq!(read(&format!("\u{feff}{VALID}")).loading(), plain.loading());
    let inline =
        edited("[indenter.paraboloid]\nradius = \"10 mm\"", "indenter = { paraboloid = { radius = 0.01 } }");
    assert_eq!(read(&inline).indenter(), plain.indenter());
}

#[test]
fn a_file_that_is_no_scene_is_refused_with_its_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let failure = |path: &Path| Scene::from_path(path).expect_err("no scene").to_string();
    let missing = failure(&folder.path().join("missing.toml"));
    assert!(missing.contains("missing.toml: there is no such file"), "{missing}");
    assert!(failure(folder.path()).contains("is a directory"));

    let path = folder.path().join("scene.toml");
    std::fs::write(&path, b"title = \"x\"\ntitle2 = \"\xff\"").expect("written");
    assert!(failure(&path).contains("line 2 is not UTF-8"));
    std::fs::write(&path, vec![b'#'; 10_000_001]).expect("written");
    assert!(failure(&path).contains("larger than 10000000 bytes"));
    std::fs::write(&path, b"").expect("written");
    assert!(failure(&path).contains("indenter is missing"));
    assert!(failure(Path::new("/dev/zero")).contains("is not a regular file"));
    std::fs::write(&path, VALID).expect("written");
    assert_eq!(Scene::from_path(&path).expect("a scene").text(), VALID);
}

#[test]
fn deep_nesting_is_refused_and_does_not_exhaust_the_stack() {
    refusal(&format!("title = {}", "[".repeat(1_000_000)));
    refusal(&format!("{}x = 1", "a.".repeat(100_000)));
    refusal(&edited("10 mm", &format!("10 {}m", "(".repeat(1_000_000))));
}

#[test]
fn the_scenes_that_come_with_the_program_are_valid_and_without_warnings() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes");
    let mut names: Vec<_> =
        std::fs::read_dir(&folder).expect("scenes").map(|entry| entry.expect("an entry").path()).collect();
    names.retain(|path| path.extension().is_some_and(|it| it == "toml"));
    names.sort();
    assert!(names.len() >= 4);
    for path in names {
        let scene = Scene::from_path(&path).unwrap_or_else(|error| panic!("{error}"));
        // Of one that is not plain the limit is.
        let expected = usize::from(!scene.conditions().is_plain());
        assert_eq!(scene.warnings().len(), expected, "{}: {:?}", path.display(), scene.warnings());
        assert!(scene.title().is_some(), "{}", path.display());
        CheckReport::new(&scene).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }
}

#[test]
fn the_main_scene_reaches_the_limit_within_its_million_cycles() {
    let scene = Scene::from_path(Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes/paraboloid.toml"))
        .expect("a scene");
    let radius = 1.0 / scene.indenter().profile_derivative(1.0);
    let (Load::InitialForce(force), Amplitude::Displacement(amplitude), Duration::Cycles(cycles)) =
        (scene.loading().load, scene.loading().amplitude, scene.loading().duration)
    else {
        panic!("another loading")
    };
    // Hertz: F = 4/3 c_N √R d^1.5, a0² = R d; stick: c²/a0² = 1 - M U/(μ_f d).
    let (stiffness, ratio) = (scene.half_space().normal_stiffness(), scene.half_space().stiffness_ratio());
    let indentation = (0.75 * force / (stiffness * radius.sqrt())).powf(2.0 / 3.0);
    let contact_radius = (radius * indentation).sqrt();
    let slip = scene.friction().coefficient * indentation / ratio;
    let stick_ratio = (1.0 - amplitude / slip).sqrt();
    let tau = 4.0 * scene.wear().coefficient * stiffness / contact_radius * slip * cycles;
    assert!((stick_ratio - 0.7).abs() < 1e-3, "stick ratio {stick_ratio}");
    assert!((tau - 33.98).abs() < 0.01, "τ = {tau}");
}

fn fixed() -> Config {
    Config { cases: 2000, rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..Config::default() }
}

proptest! {
    #![proptest_config(fixed())]

    #[test]
    fn no_text_makes_the_reader_panic(text in ".{0,200}") {
        let _ = Scene::from_toml(&text, "x");
        let _ = parse(&text, Dimension::LENGTH);
    }

    #[test]
    fn no_unit_makes_the_parser_panic(text in "[-+]?[0-9.]{0,4}(e[-+]?[0-9]{1,20})? ?[mgsNPakMGuµhdeg°1()/*·^ 0-9.⁻²³+-]{0,24}") {
        if let Ok(value) = parse(&text, Dimension::LENGTH) {
            prop_assert!(value.is_finite());
        }
    }

    #[test]
    fn no_mutation_of_a_scene_makes_the_reader_panic(
        edits in prop::collection::vec((0usize..VALID.len(), 0usize..12, "[-0-9a-z_.=\\[\\]{}\"'#\n ,e^/µ\u{0}]{0,8}"), 1..4)
    ) {
        let mut text = VALID.to_string();
        for (at, length, insert) in edits {
            let floor = |at: usize| (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
            let range = floor(at)..floor(at + length);
            text.replace_range(range, &insert);
        }
        if let Ok(scene) = Scene::from_toml(&text, "x") {
            prop_assert!(scene.half_space().normal_stiffness() > 0.0);
            prop_assert!(scene.friction().coefficient > 0.0 && scene.wear().coefficient > 0.0);
        }
    }
}

#[test]
fn wear_by_dissipated_energy_is_archards_law_times_the_friction_coefficient() {
    let text = VALID.replace(
        "[wear.archard]\ncoefficient = \"1e-14 1/Pa\"",
        "[wear.dissipated-energy]\ncoefficient = \"2e-5 mm^3/J\"",
    );
    assert_ne!(text, VALID);
    let scene = Scene::from_toml(&text, "scene.toml").unwrap();
    let expected = 2e-14 * scene.friction().coefficient;
    assert!((scene.wear().coefficient / expected - 1.0).abs() < 1e-15, "{}", scene.wear().coefficient);
    let both = text + "\n[wear.archard]\ncoefficient = 1e-14\n";
    let message = Scene::from_toml(&both, "scene.toml").unwrap_err().to_string();
    assert!(message.contains("exclude each other"), "{message}");
}

#[test]
fn a_modulus_that_depends_on_the_depth_needs_the_depth_at_which_it_counts() {
    let text = edited("reference_depth = \"1 m\"\n", "");
    let error = Scene::from_toml(&text, "scene.toml").expect_err("no depth").to_string();
    let cure = "half_space.reference_depth is missing; where half_space.grading is not 0 the modulus counts at that depth: give it, for example \"2 mm\"";
    assert!(error.contains(cure) && error.contains("[half_space]"), "{error}");
    read(&text.replace("grading = 0.2", "grading = 0"));
}
