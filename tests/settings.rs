//! Keys of a scene that are set on the command line.

mod support;

use std::fs;

use serde_json::Value;
use support::command::{done, names, object, run, text};

const SCENE: &str = r#"
[indenter.paraboloid]
radius = "10 mm"
[half_space]
grading = 0
modulus = "210 GPa"
poisson_ratio = 0.3
[friction.coulomb]
coefficient = 0.6
[wear.archard]
coefficient = "1e-8 1/MPa"
[loading]
initial_force = "10 N"
stick_ratio = 0.7
tau = 1
"#;

/// What follows from a scene, by the closed form.
fn limit(folder: &std::path::Path, arguments: &[&str]) -> Value {
    object(folder, &[&["limit", "scene.toml", "--json"], arguments].concat())
}

#[test]
fn a_key_that_is_set_gives_what_the_edited_scene_gives() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (settings, old, new) in [
        (vec!["loading.initial_force=20 N"], "\"10 N\"", "\"20 N\""),
        (vec!["loading.initial_force = 0.02 kN"], "\"10 N\"", "20"),
        (vec!["half_space.poisson_ratio=similar"], "poisson_ratio = 0.3", "poisson_ratio = \"similar\""),
        // What excludes the key is left out, at any depth.
        (vec!["loading.amplitude=0.2 um"], "stick_ratio = 0.7", "amplitude = 2e-7"),
        (
            vec!["indenter.sphere.radius=8 mm"],
            "[indenter.paraboloid]\nradius = \"10 mm\"",
            "[indenter.sphere]\nradius = 8e-3",
        ),
        (
            vec!["half_space.normal_stiffness=2e11 N/m2"],
            "modulus = \"210 GPa\"\npoisson_ratio = 0.3",
            "normal_stiffness = 2e11",
        ),
        (
            vec![
                "friction.static-kinetic.static_coefficient=0.7",
                "friction.static-kinetic.kinetic_coefficient=0.5",
            ],
            "[friction.coulomb]\ncoefficient = 0.6",
            "[friction.static-kinetic]\nstatic_coefficient = 0.7\nkinetic_coefficient = 0.5",
        ),
    ] {
        assert_eq!(SCENE.matches(old).count(), 1, "{old}");
        fs::write(folder.join("scene.toml"), SCENE.replace(old, new)).unwrap();
        let edited = limit(folder, &[]);
        fs::write(folder.join("scene.toml"), SCENE).unwrap();
        let arguments: Vec<&str> = settings.iter().flat_map(|setting| ["--set", *setting]).collect();
        assert_eq!(limit(folder, &arguments), edited, "{settings:?}");
        assert_ne!(limit(folder, &[]), edited, "{settings:?} changes nothing");
    }
}

#[test]
fn a_run_keeps_the_scene_with_what_was_set() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("scene.toml"), SCENE).unwrap();
    let set = ["--set", "numerics.springs=16", "--set", "loading.tau=0.5", "--set", "title=Set"];
    let result = object(folder, &[&["run", "scene.toml", "--json"], &set[..]].concat());
    assert_eq!(result["tau"], 0.5, "{result}");
    let info = object(folder, &["info", "scene.h5", "--json"]);
    assert_eq!(info["title"], "Set", "{info}");
    let resumed = object(folder, &["run", "--resume", "scene.h5", "--json"]);
    assert_eq!(resumed["wear_volume"], result["wear_volume"]);
}

#[test]
fn a_setting_that_cannot_be_is_refused_with_its_key_and_the_nearest() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("scene.toml"), SCENE).unwrap();
    let before = names(folder);
    for (settings, words) in [
        (vec!["loading.amplitud=1 um"], "did you mean loading.amplitude?"),
        (vec!["half_space.nu=0.3"], "did you mean half_space.poisson_ratio?"),
        (vec!["loading=1"], "it is a table; name one of its keys, such as loading.indentation"),
        (vec!["loading.amplitude"], "is not of the form key=value"),
        (
            vec!["loading.amplitude=1 MPa"],
            "loading.amplitude: expected a length such as \"5 mm\", found \"1 MPa\" (a pressure)",
        ),
        (vec!["loading.amplitude=-1 um"], "loading.amplitude = \"-1 um\" is outside [0, inf)"),
        (vec!["loading.amplitude=1 mum"], "is no known unit"),
        (vec!["numerics.springs=7"], "numerics.springs = 7 is outside [8, inf)"),
        (vec!["numerics.stepper=implict"], "did you mean implicit?"),
        (vec!["loading.amplitude=1 um", "loading.stick_ratio=0.7"], "exclude each other"),
        // What only the whole scene tells is shown in it.
        (vec!["half_space.grading=0.2"], "half_space.reference_depth is missing"),
        (vec!["wear.threshold.pressure=1 MPa"], "wear.threshold.coefficient is missing"),
    ] {
        let arguments: Vec<&str> = settings.iter().flat_map(|setting| ["--set", *setting]).collect();
        for command in ["run", "check", "limit"] {
            let output = run(folder, &[&[command, "scene.toml"], &arguments[..]].concat());
            let complaint = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{settings:?}: {complaint}");
            assert!(complaint.contains(words), "{settings:?}: {complaint}");
        }
    }
    assert_eq!(names(folder), before);
    done(
        folder,
        &[
            "check",
            "scene.toml",
            "--set",
            "half_space.grading=0.2",
            "--set",
            "half_space.reference_depth=2 mm",
        ],
    );
    let output = run(folder, &["run", "--resume", "scene.h5", "--set", "loading.tau=1"]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
}
