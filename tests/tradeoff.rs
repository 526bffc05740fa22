//! The measured cost of accuracy: fronts, errors that can be formed anew from the runs, and inputs that are refused.

mod support;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use fretwear::contact::closed_form::LimitingShape;
use fretwear::data::{DatasetSummary, RunFile};
use fretwear::scene::Scene;
use fretwear::study::tradeoff::{cheapest, pareto_front};
use serde_json::Value;
use support::command::{names, object, program, run, text};

const SCENE: &str = r#"
title = "small"
indenter = { paraboloid = { radius = 1 } }
half_space = { grading = 0, normal_stiffness = 1, stiffness_ratio = 1 }
friction = { coulomb = { coefficient = 1 } }
wear = { archard = { coefficient = 1e-3 } }
loading = { indentation = 1, stick_ratio = 0.7, tau = 30 }
output = { at_tau = [1, 10] }
"#;

/// Sixteen candidates and one by `accuracy`, of milliseconds each.
const LADDERS: [&str; 10] = [
    "--springs",
    "12,24,48",
    "--tolerances",
    "1e-4,1e-2",
    "--accuracies",
    "1e-2",
    "--repeats",
    "1",
    "--most-seconds",
    "0.5",
];

fn place(scene: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let output = folder.path().join("out");
    (folder, output)
}

fn arguments<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["tradeoff", "scene.toml", "-o", "out"], &LADDERS[..], more].concat()
}

fn number(row: &Value, key: &str) -> f64 {
    row[key].as_f64().unwrap_or_else(|| panic!("{key} of {row}"))
}

fn by_hand<'a>(found: &'a Value, stepper: &str, springs: u64, tolerance: f64) -> &'a Value {
    let rows = found["candidates"].as_array().unwrap();
    let is = |row: &&Value| {
        let same = row["stepper"] == stepper && row["cycle"] == "closed-form" && row["accuracy"].is_null();
        same && row["springs"] == springs && row["tolerance"] == tolerance
    };
    rows.iter().find(is).unwrap_or_else(|| panic!("{stepper} {springs} {tolerance}"))
}

#[test]
fn a_front_holds_whoever_is_not_beaten() {
    let points = [
        (3.0, 1e-3),
        (1.0, 1e-1),
        (2.0, 1e-2),
        (2.0, 2e-2),
        (4.0, 1e-2),
        (5.0, 1e-4),
        (0.5, f64::NAN),
        (f64::NAN, 1e-9),
    ];
    assert_eq!(pareto_front(&points), [1, 2, 0, 5]);
    assert_eq!(pareto_front(&[]), [0; 0]);
    // What is better by the last digits only is not worth its cost.
    assert_eq!(pareto_front(&[(1.0, 1e-3), (2.0, 0.999e-3), (3.0, 0.98e-3)]), [0, 2]);
    assert_eq!(pareto_front(&[(1.0, 0.0), (2.0, 0.0)]), [0]);
    assert_eq!([1.0, 5e-3, 1e-5].map(|error| cheapest(&points, error)), [Some(1.0), Some(3.0), None]);
}

#[test]
fn errors_fall_with_finer_numerics_and_follow_from_the_runs() {
    let (folder, output) = place(SCENE);
    let found = object(folder.path(), &arguments(&["--json", "--keep-runs"]));
    assert_eq!(names(&output), ["runs", "tradeoff.csv", "tradeoff.h5", "tradeoff.json"]);
    let written: Value =
        serde_json::from_str(&fs::read_to_string(output.join("tradeoff.json")).unwrap()).unwrap();
    assert_eq!(written, found);

    for key in ["volume_error", "profile_error"] {
        let errors = [12, 24, 48].map(|springs| number(by_hand(&found, "implicit", springs, 1e-4), key));
        // Measured: the volume falls by 49 and 1.6, where the tolerance is left over.
        let falls = errors[0] > errors[1] && errors[1] > errors[2] && errors[0] > 4.0 * errors[2];
        assert!(falls, "{key} on 12, 24, 48 springs: {errors:?}");
    }
    let explicit = by_hand(&found, "cycle-jump", 24, 1e-4);
    assert_eq!(explicit["status"], "done");
    // A billion cycles one by one.
    let every = by_hand(&found, "every-cycle", 12, 1e-2);
    assert!(["stopped", "done"].contains(&every["status"].as_str().unwrap()), "{every}");

    let rows = found["candidates"].as_array().unwrap();
    for (name, cost, error) in [
        ("volume_time", "wall_seconds", "volume_error"),
        ("profile_time", "wall_seconds", "node_error"),
        ("volume_evaluations", "rate_evaluations", "volume_error"),
        ("profile_evaluations", "rate_evaluations", "node_error"),
    ] {
        let front: Vec<usize> = found["fronts"][name]
            .as_array()
            .unwrap()
            .iter()
            .map(|it| it.as_u64().unwrap() as usize)
            .collect();
        assert!(!front.is_empty(), "{name}");
        let point = |row: &Value| Some((row[cost].as_f64()?, row[error].as_f64()?));
        for place in &front {
            let (own_cost, own_error) = point(&rows[*place]).expect("a front has costs and errors");
            assert!(rows[*place]["accuracy"].is_null(), "what `accuracy` chose is no part of a front");
            let beaten = rows.iter().filter(|it| it["accuracy"].is_null()).filter_map(point);
            let mut beaten = beaten.filter(|it| it.0 < own_cost && it.1 < own_error);
            assert_eq!(beaten.next(), None, "{name}: {place} at {own_cost}, {own_error}");
        }
    }
    let chosen = rows.iter().find(|row| row["accuracy"] == 1e-2).expect("the row of `accuracy`");
    assert!(
        chosen["springs"].as_u64().unwrap() > 12 && number(chosen, "tolerance") > 0.0,
        "what it chose: {chosen}"
    );
    the_errors_follow_from_the_runs(&found, &output);
}

/// Forms errors from the kept runs, without a line of the code that does so in the program.
fn the_errors_follow_from_the_runs(found: &Value, output: &Path) {
    let scene = Scene::from_toml(SCENE, "scene.toml").unwrap();
    let limit = LimitingShape::from_contact(&scene.contact().unwrap()).unwrap().expect("partial slip");
    let reference = RunFile::open(&output.join("runs/reference0.h5")).unwrap();
    let mut checked = [0; 2];
    for (place, row) in found["candidates"].as_array().unwrap().iter().enumerate() {
        if row["status"] != "done" {
            continue;
        }
        let run = RunFile::open(&output.join(format!("runs/candidate{place}.h5"))).unwrap();
        for (snapshot, errors) in run.snapshots[1..].iter().zip(row["snapshots"].as_array().unwrap()) {
            let volume = match errors["references"][0].as_str().unwrap() {
                "limit" => limit.wear_volume(),
                "reference" => {
                    let same = reference.snapshots.iter().find(|it| it.cycles == snapshot.cycles);
                    same.expect("the reference has all times").wear_volume
                }
                other => panic!("{other}"),
            };
            if errors["bounded"][0] == false {
                let expected = (snapshot.wear_volume - volume).abs() / limit.wear_volume();
                let error = number(errors, "volume_error");
                assert!((error / expected - 1.0).abs() < 1e-6, "{place}: {error:e}, not {expected:e}");
                checked[0] += 1;
            }
            if errors["references"][1] == "limit" && errors["bounded"][2] == false {
                let c = limit.stick_radius();
                let gap = |(r, depth): (&f64, &f64)| {
                    (depth - limit.wear_depth_at_offset((r - c) * (r + c))).abs() / limit.wear_depth_max()
                };
                let gaps = run.header.radius.iter().zip(&snapshot.wear_depth).map(gap);
                let expected = gaps.fold(0.0, f64::max);
                let error = number(errors, "node_error");
                assert!((error / expected - 1.0).abs() < 1e-6, "{place}: {error:e}, not {expected:e}");
                checked[1] += 1;
            }
        }
    }
    assert!(checked[0] > 20, "few errors were clear of the reference's own: {checked:?}");
}

#[test]
fn the_file_has_a_row_for_each_candidate_with_units_and_meaning() {
    let (folder, output) = place(SCENE);
    let more = ["--steppers", "implicit", "--quiet"];
    let done = run(folder.path(), &arguments(&more));
    assert_eq!((done.status.code(), text(&done.stdout)), (Some(0), ""), "{}", text(&done.stderr));
    let summary = DatasetSummary::read(&output.join("tradeoff.h5")).unwrap().expect("arrays");
    assert_eq!((summary.format.as_str(), summary.complete), ("fretwear-tradeoff", true));
    let table = fs::read_to_string(output.join("tradeoff.csv")).unwrap();
    // Two ways through a cycle, three numbers of springs, two tolerances; and `accuracy`.
    assert_eq!(table.lines().count(), 1 + 2 * 3 * 2 + 1);
    assert!(!output.join("runs").exists(), "what was kept for a restart is gone");

    let again = run(folder.path(), &arguments(&more));
    assert_eq!(again.status.code(), Some(2));
    assert!(text(&again.stderr).contains("--force"), "{}", text(&again.stderr));
    let forced = run(folder.path(), &arguments(&["--steppers", "implicit", "--quiet", "--force"]));
    assert_eq!(forced.status.code(), Some(0), "{}", text(&forced.stderr));
}

/// At 1 - k = 1e-9 nothing is known better than the closed transient.
#[test]
fn the_gibson_transient_is_the_reference_next_to_its_medium() {
    let scene = SCENE
        .replace("grading = 0,", "grading = 0.999999999,")
        .replace("tau = 30", "tau = 3")
        .replace("[1, 10]", "[1]");
    let (folder, _) = place(&scene);
    let found = object(folder.path(), &arguments(&["--json", "--steppers", "implicit"]));
    let row = by_hand(&found, "implicit", 48, 1e-4);
    for errors in row["snapshots"].as_array().unwrap() {
        assert_eq!(errors["references"][0], "gibson", "{errors}");
        assert!(number(errors, "volume_error") < 1e-3, "{errors}");
    }
}

#[test]
fn what_cannot_be_run_is_a_row_with_its_reason() {
    // An edge of stick that moves is nothing for explicit steps.
    let scene = SCENE
        .replace("indentation = 1,", "normal_force = 1,")
        .replace("tau = 30", "tau = 1")
        .replace("[1, 10]", "[0.3]");
    let (folder, _) = place(&scene);
    let arguments = [
        "tradeoff",
        "scene.toml",
        "-o",
        "out",
        "--json",
        "--springs",
        "24,48",
        "--tolerances",
        "1e-2",
        "--accuracies",
        "1e-2",
        "--repeats",
        "1",
    ];
    let found = object(folder.path(), &arguments);
    let explicit = by_hand(&found, "cycle-jump", 24, 1e-2);
    assert_eq!(explicit["status"], "failed");
    assert!(explicit["reason"].as_str().unwrap().contains("numerics.stepper"), "{explicit}");
    let implicit = by_hand(&found, "implicit", 24, 1e-2);
    assert!(number(implicit, "volume_error") < 0.1, "{implicit}");
}

#[test]
fn bad_inputs_are_refused_with_nothing_written() {
    let stuck = SCENE.replace("stick_ratio = 0.7", "amplitude_ratio = 0");
    let many = SCENE.replace("at_tau = [1, 10]", "snapshots = 5000");
    for (scene, more, words) in [
        (SCENE, &["--springs", "2"][..], "--springs"),
        (SCENE, &["--springs", "1e3"], "invalid value"),
        (SCENE, &["--springs", ""], "invalid value"),
        (SCENE, &["--tolerances", "0.5"], "--tolerances"),
        (SCENE, &["--tolerances", "nan"], "--tolerances"),
        (SCENE, &["--tolerances=-1e-3"], "--tolerances"),
        (SCENE, &["--accuracies", "1e-12"], "--accuracies"),
        (SCENE, &["--steppers", "euler"], "cycle-jump"),
        (SCENE, &["--most-seconds=-1"], "--most-seconds"),
        (SCENE, &["--repeats", "0"], "--repeats"),
        (stuck.as_str(), &[], "amplitude_ratio"),
        (many.as_str(), &[], "5000 snapshots"),
        ("nonsense", &[], "scene.toml"),
    ] {
        let (folder, _) = place(scene);
        let arguments = [&["tradeoff", "scene.toml", "-o", "out"], more].concat();
        let refused = run(folder.path(), &arguments);
        let why = text(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{arguments:?}: {why}");
        assert!(why.contains(words) && refused.stdout.is_empty(), "{arguments:?}: {why}");
        assert_eq!(names(folder.path()), ["scene.toml"], "{arguments:?}");
    }
}

#[test]
fn a_signal_stops_it_and_the_same_command_goes_on() {
    let (folder, output) = place(SCENE);
    let arguments = arguments(&["--json"]);
    let mut child = program(folder.path(), &arguments).spawn().unwrap();
    let record = || scratch(&output).map(|it| it.join("candidate3.json")).filter(|it| it.exists());
    while record().is_none() && child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(5));
    }
    // SAFETY: the child has not been waited for, so that its number is its own.
    unsafe { libc::kill(child.id().cast_signed(), libc::SIGTERM) };
    assert_eq!(child.wait().unwrap().code(), Some(75));
    assert_eq!(names(&output).len(), 1, "{:?}", names(&output));
    let before: Value = serde_json::from_slice(&fs::read(record().unwrap()).unwrap()).unwrap();
    let found = object(folder.path(), &[&arguments[..], &["--keep-runs"]].concat());
    assert_eq!(
        number(&found["candidates"][3], "wall_seconds"),
        number(&before["measurement"]["Done"], "wall_seconds"),
        "what was measured is not measured again"
    );
    assert_eq!(names(&output), ["runs", "tradeoff.csv", "tradeoff.h5", "tradeoff.json"]);
}

/// The directory in which runs are kept until all are done.
fn scratch(output: &Path) -> Option<PathBuf> {
    let entries = fs::read_dir(output).ok()?.flatten().map(|it| it.path());
    entries.into_iter().find(|it| it.join("marker").exists() && !it.join("content").exists())
}
