//! The commands `limit`, `check` and `info`, as a script sees them.

mod support;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use fretwear::contact::closed_form::LimitingShape;
use fretwear::data::{Checkpoint, LimitCurves, RunHeader, RunWriter, Snapshot, StopReason};
use fretwear::report::{self, CheckReport, LimitReport};
use fretwear::scene::Scene;
use fretwear::solver::model::State;
use fretwear::solver::simulation::Progress;
use serde_json::Value;
use std::f64::consts::PI;
use support::command::{done, names, object, run, text};

const KEYS: [&str; 22] = [
    "grading",
    "stiffness_ratio",
    "normal_stiffness",
    "friction_coefficient",
    "indentation",
    "normal_force",
    "amplitude",
    "amplitude_full_sliding",
    "regime",
    "contact_radius_initial",
    "stick_radius",
    "energy_ratio",
    "energy_ratio_transition",
    "sliding_ratio",
    "contact_radius_limit",
    "slip_width_limit",
    "contact_growth_limit",
    "indentation_limit",
    "wear_volume_limit",
    "wear_volume_asymptotic",
    "wear_depth_max",
    "profile",
];

/// Keys about the limit, zero without slip.
const WORN: [&str; 5] = [
    "slip_width_limit",
    "contact_growth_limit",
    "wear_volume_limit",
    "wear_volume_asymptotic",
    "wear_depth_max",
];

const SCENES: [&str; 4] =
    ["paraboloid.toml", "graded_ceramic.toml", "cone_negative_grading.toml", "measured_profile.toml"];

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(name)
}

fn scene(amplitude: &str) -> String {
    format!(
        "[indenter.paraboloid]\nradius = \"10 mm\"\n[half_space]\ngrading = 0.2\nmodulus = \"210 GPa\"\nreference_depth = \"1 m\"\npoisson_ratio = 0.3\n\
         [friction.coulomb]\ncoefficient = 0.6\n[wear.archard]\ncoefficient = 1e-14\n\
         [loading]\nindentation = \"1 um\"\n{amplitude}\ntau = 30\n"
    )
}

fn list(value: &Value) -> Vec<f64> {
    value.as_array().expect("an array").iter().map(|it| it.as_f64().expect("a number")).collect()
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

#[test]
fn json_has_every_key_in_each_regime_and_nulls_only_under_full_sliding() {
    let folder = folder();
    for (amplitude, regime) in [
        ("amplitude = 0", "stick"),
        ("stick_ratio = 1", "stick"),
        ("amplitude = \"0.3 um\"", "partial-slip"),
        ("stick_ratio = 1e-12", "partial-slip"),
        ("stick_ratio = 0.999999999999", "partial-slip"),
        ("amplitude_ratio = 3", "full-sliding"),
    ] {
        fs::write(folder.path().join("scene.toml"), scene(amplitude)).unwrap();
        let found = done(folder.path(), &["limit", "scene.toml", "--json"]);
        let positions: Vec<_> = KEYS.iter().map(|key| found.find(&format!("\n  \"{key}\":"))).collect();
        assert!(positions.iter().all(Option::is_some), "{amplitude}: {found}");
        assert!(positions.is_sorted(), "{amplitude}: the order of the keys");
        let json: Value = serde_json::from_str(&found).unwrap();
        assert_eq!(json.as_object().unwrap().len(), KEYS.len(), "{amplitude}");
        assert_eq!(json["regime"], regime, "{amplitude}");
        let profile = json["profile"].as_object().unwrap();
        assert_eq!(profile.keys().collect::<Vec<_>>(), ["initial", "limit", "radius"]);
        let radius = list(&profile["radius"]);
        assert!(radius[0] == 0.0 && radius.len() > 60 && radius.len() < 250, "{amplitude}: {}", radius.len());
        assert!(radius.is_sorted_by(|a, b| a < b), "{amplitude}");
        assert_eq!(list(&profile["initial"]).len(), radius.len());
        if regime == "full-sliding" {
            for key in WORN.iter().chain(&["stick_radius", "contact_radius_limit"]) {
                assert!(json[key].is_null(), "{key}");
            }
            assert!(profile["limit"].is_null());
            continue;
        }
        assert!(*radius.last().unwrap() > json["contact_radius_limit"].as_f64().unwrap());
        assert_eq!(list(&profile["limit"]).len(), radius.len());
        if regime == "stick" {
            assert_eq!(json["stick_radius"], json["contact_radius_initial"]);
            assert_eq!(json["contact_radius_limit"], json["contact_radius_initial"]);
            assert_eq!(profile["limit"], profile["initial"]);
            for key in WORN {
                assert_eq!(json[key].as_f64().unwrap().to_bits(), 0, "{key} is +0");
            }
        } else {
            for key in WORN {
                assert!(json[key].as_f64().unwrap() > 0.0, "{amplitude}: {key} = {}", json[key]);
            }
        }
    }
}

#[test]
fn the_scenes_give_the_closed_form_and_what_their_comments_say() {
    let folder = folder();
    // Indentation, contact radius, mean pressure, stiffness ratio, stick ratio: as printed in the files, and the time if it is given.
    let comments = [
        (0.75e-6, 87e-6, 0.42e9, 0.824, 0.700, Some(34.0)),
        (2.5e-6, 0.19e-3, 0.43e9, 0.541, 0.716, None),
        (20e-6, 0.11e-3, 0.33e6, 1.15, 0.495, Some(30.0)),
        (0.65e-6, 91e-6, 0.38e9, 0.824, 0.713, Some(28.0)),
    ];
    for (name, comment) in SCENES.into_iter().zip(comments) {
        let path = data("scenes").join(name);
        let arguments = ["limit", path.to_str().unwrap(), "--json", "--at", "0,60 um,0.15mm,0.3mm"];
        let json = object(folder.path(), &arguments);
        let number =
            |key: &str| json[key].as_f64().unwrap_or_else(|| panic!("{name}: {key} = {}", json[key]));
        let scene = Scene::from_path(&path).unwrap();
        let contact = scene.contact().unwrap();
        let (grading, depth) = (scene.half_space().grading(), contact.indentation());
        let shape = LimitingShape::new(scene.indenter(), grading, depth, contact.slip_compression()).unwrap();
        assert_eq!(number("contact_radius_limit"), shape.contact_radius_limit(), "{name}");
        assert_eq!(number("wear_volume_limit"), shape.wear_volume(), "{name}");
        assert_eq!(number("wear_depth_max"), shape.wear_depth_max(), "{name}");
        assert_eq!(number("wear_volume_asymptotic"), shape.wear_volume_asymptotic(), "{name}");
        assert_eq!(list(&json["profile"]["radius"]), [0.0, 60e-6, 0.15e-3, 0.3e-3], "{name}");
        let limit = list(&json["profile"]["limit"]);
        assert_eq!(limit, [0.0, 60e-6, 0.15e-3, 0.3e-3].map(|r| shape.profile(r)), "{name}");

        let check = CheckReport::new(&scene).unwrap();
        let checked: serde_json::Value = serde_json::from_str(&report::json(&check)).unwrap();
        let (d, a0, p, m, c, tau) = comment;
        let of = |name: &str| checked[name].as_f64().unwrap();
        let found = ["indentation", "contact_radius_initial", "mean_pressure"].map(of);
        for (found, printed) in found.into_iter().zip([d, a0, p]) {
            assert!((found / printed - 1.0).abs() < 0.03, "{name}: {found:e}, the comment says {printed:e}");
        }
        assert!((of("stiffness_ratio") - m).abs() < 0.005, "{name}: M = {}", of("stiffness_ratio"));
        assert!((of("stick_ratio") - c).abs() < 0.0006, "{name}: c/a0 = {}", of("stick_ratio"));
        assert_eq!(check.tau.map(f64::round), tau, "{name}");
        assert!(check.warnings.is_empty(), "{name}: {:?}", check.warnings);
    }
}

#[test]
fn a_scene_gives_the_reference_tables() {
    let table = fs::read_to_string(data("reference/limiting.csv")).unwrap();
    let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let names = lines.next().unwrap();
    let (mut worst, mut rows): (f64, _) = (0.0, 0);
    for row in lines {
        let of = |name: &str| row[names.iter().position(|it| *it == name).unwrap()].parse::<f64>().unwrap();
        let text = format!(
            "[indenter.power-law]\ncoefficient = 1e-3\nexponent = {}\n[half_space]\ngrading = {}\nnormal_stiffness = 1e9\n\
             [friction.coulomb]\ncoefficient = 0.6\n[wear.archard]\ncoefficient = 1e-14\n\
             [loading]\nindentation = 1e-6\nstick_ratio = {}\ntau = 30\n",
            of("n"),
            of("k"),
            of("c_over_a0"),
        );
        let report = LimitReport::new(&Scene::from_toml(&text, "scene").unwrap(), Some(&[])).unwrap();
        let (contact, limit) = (&report.form.contact, report.form.limit.as_ref().unwrap());
        let (a0, d) = (contact.contact_radius(), contact.indentation());
        let quantities = [
            (contact.half_space().stiffness_ratio(), of("mindlin_m")),
            (contact.amplitude() / contact.amplitude_full_sliding(), of("u_over_umax")),
            (contact.amplitude() / (0.6 * d), of("ubar")),
            (limit.slip_width_limit() / a0, of("a_inf_minus_c_over_a0")),
            (limit.contact_growth_limit() / a0, of("a_inf_minus_a0_over_a0")),
            (limit.wear_volume() / (PI * a0 * a0 * d), of("dv_over_pi_a0sq_d")),
            (limit.wear_volume_asymptotic() / (PI * a0 * a0 * d), of("dv_eq15_over_pi_a0sq_d")),
            (limit.wear_depth_max() / d, of("max_df_over_d")),
        ];
        for (found, expected) in quantities {
            worst = worst.max((found / expected - 1.0).abs());
            assert!(worst < 5e-14, "{row:?}: {found:e} instead of {expected:e}");
        }
        rows += 1;
    }
    println!("largest relative error {worst:e} in {rows} rows");
    assert!(rows > 100, "{rows}");
}

#[test]
fn csv_holds_the_profile_with_all_digits_and_is_never_overwritten_unasked() {
    let folder = folder();
    let path = data("scenes/paraboloid.toml");
    let scene = path.to_str().unwrap();
    let printed = done(folder.path(), &["limit", scene, "--csv", "table.csv"]);
    assert!(printed.contains("contact radius a∞, limit           98.9913 µm"), "{printed}");
    let table = fs::read_to_string(folder.path().join("table.csv")).unwrap();
    let report = LimitReport::new(&Scene::from_path(&path).unwrap(), None).unwrap();
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("radius_m,initial_profile_m,limit_profile_m,wear_depth_m"));
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect()).collect();
    let column = |index: usize| rows.iter().map(|row| row[index]).collect::<Vec<_>>();
    assert_eq!(column(0), report.profile.radius);
    assert_eq!(column(1), report.profile.initial);
    assert_eq!(Some(column(2)), report.profile.limit);
    assert_eq!(Some(column(3)), report.profile.wear_depth);
    // The list is dense enough to see the deepest place.
    let deepest = column(3).into_iter().fold(0.0, f64::max);
    assert!((deepest / report.form.limit.unwrap().wear_depth_max() - 1.0).abs() < 1e-3, "{deepest:e}");

    fs::write(folder.path().join("table.csv"), "mine").unwrap();
    let refused = run(folder.path(), &["limit", scene, "--csv", "table.csv"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("--force"), "{}", text(&refused.stderr));
    assert_eq!(fs::read_to_string(folder.path().join("table.csv")).unwrap(), "mine");
    done(folder.path(), &["limit", scene, "--csv", "table.csv", "--force", "--json"]);
    assert_eq!(fs::read_to_string(folder.path().join("table.csv")).unwrap(), table);
    assert_eq!(names(folder.path()), ["table.csv"]);
}

#[test]
fn bad_input_is_refused_with_exit_code_2_and_nothing_is_written() {
    let folder = folder();
    let path = data("scenes/paraboloid.toml");
    let good = path.to_str().unwrap();
    fs::write(folder.path().join("bad.toml"), scene("amplitude = \"1 MPa\"")).unwrap();
    fs::write(folder.path().join("sphere.toml"), scene("stick_ratio = 0.5").replace("paraboloid", "sphere"))
        .unwrap();
    let deep = scene("stick_ratio = 0.5").replace("paraboloid", "sphere").replace("\"1 um\"", "\"1 m\"");
    fs::write(folder.path().join("deep.toml"), deep).unwrap();
    fs::write(folder.path().join("huge.toml"), scene("stick_ratio = 0.5").replace("\"1 um\"", "1e300"))
        .unwrap();
    fs::write(folder.path().join("text.h5"), "not HDF5").unwrap();
    fs::create_dir(folder.path().join("empty")).unwrap();
    let before = names(folder.path());
    let cases: [(&[&str], &str); 24] = [
        (&["limit", "none.toml", "--csv", "t.csv"], "none.toml: there is no such file"),
        (&["check", "none.toml"], "none.toml: there is no such file"),
        (&["limit", "empty", "--csv", "t.csv"], "empty: is a directory"),
        (&["limit", "bad.toml", "--csv", "t.csv"], "loading.amplitude: expected a length"),
        (&["check", "bad.toml", "--json"], "loading.amplitude: expected a length"),
        (&["limit", "deep.toml", "--csv", "t.csv"], "loading.indentation: 1 is too large"),
        (&["check", "huge.toml"], "check the value and the unit of"),
        (&["limit", good, "--at", "", "--csv", "t.csv"], "--at: entry 1: is empty"),
        (&["limit", good, "--at", "1e-6,,2e-6", "--csv", "t.csv"], "--at: entry 2: is empty"),
        (&["limit", good, "--at", "1e-6,wide", "--csv", "t.csv"], "--at: entry 2: \"wide\" does not begin"),
        (&["limit", good, "--at", "-1e-6", "--csv", "t.csv"], "--at: entry 1: \"-1e-6\" is outside [0, inf)"),
        (&["limit", good, "--at", "nan"], "--at: entry 1: \"nan\" is outside [0, inf)"),
        (&["limit", good, "--at", "inf"], "--at: entry 1: \"inf\" is outside [0, inf)"),
        (&["limit", good, "--at", "5 MPa"], "--at: entry 1: expected a length"),
        (&["limit", "sphere.toml", "--at", "11 mm", "--csv", "t.csv"], "does not reach out to 0.011 m"),
        (&["limit", good, "--csv", "none/t.csv"], "none/t.csv: "),
        (&["limit", good, "--csv", "empty"], "empty: is a directory"),
        (&["limit", good, "--force"], "--csv"),
        (&["info", "text.h5"], "text.h5: is not an HDF5 file"),
        (&["info", "none.h5"], "none.h5: "),
        (&["info", "empty", "--json"], "empty: is not a file"),
        (&["run"], "SCENE.toml"),
        (&["run", good, "--resume", "text.h5"], "cannot be used with"),
        (&["limit"], "SCENE.toml"),
    ];
    for (arguments, words) in cases {
        let output = run(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", text(&output.stderr));
        assert!(output.stdout.is_empty(), "{arguments:?}: {}", text(&output.stdout));
        let message = text(&output.stderr);
        assert!(message.starts_with("error: ") && message.contains(words), "{arguments:?}: {message}");
        assert_eq!(names(folder.path()), before, "{arguments:?}");
    }
}

#[test]
fn warnings_go_to_stderr_and_json_stays_one_object() {
    let folder = folder();
    let formal = scene("amplitude_ratio = 3")
        .replace("grading = 0.2", "grading = -0.2")
        .replace("poisson_ratio = 0.3", "poisson_ratio = \"similar\"");
    fs::write(folder.path().join("scene.toml"), formal).unwrap();
    for command in ["check", "limit"] {
        let output = run(folder.path(), &[command, "scene.toml", "--json"]);
        assert_eq!(output.status.code(), Some(0));
        let message = text(&output.stderr);
        assert!(message.starts_with("warning: half_space.grading: elastic similarity"), "{message}");
        assert_eq!(message.contains("warning: full sliding"), command == "check", "{message}");
        let json: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(json["regime"], "full-sliding");
        if command == "check" {
            assert_eq!(json["warnings"].as_array().unwrap().len(), 2);
        }
    }
}

#[test]
fn a_reader_that_has_seen_enough_is_no_failure() {
    let folder = folder();
    let path = data("scenes/paraboloid.toml");
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("fretwear"));
    command.current_dir(folder.path()).arg("limit").arg(&path).arg("--json");
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), ""));
}

#[test]
fn info_tells_what_a_result_file_holds_and_whether_it_is_complete() {
    let folder = folder();
    let header = RunHeader {
        title: Some("Three nodes".into()),
        scene: "title = \"Three nodes\"\n".into(),
        radius: vec![1e-5, 2e-5, 3e-5],
        limit: Some(LimitCurves { profile: vec![1e-8, 5e-8, 1e-7], wear_depth: vec![0.0, 2e-8, 1e-8] }),
        table: None,
        path: None,
    };
    let snapshot = Snapshot {
        cycles: 2000.0,
        tau: 0.5,
        indentation: 1e-7,
        wear_volume: 3e-18,
        wear_depth: vec![0.0, 1.5e-8, 1e-8],
        profile: vec![1e-8, 4.5e-8, 1e-7],
        pressure: vec![0.0; 3],
        slip: vec![f64::NAN; 3],
        normal_force: f64::NAN,
        ..Snapshot::default()
    };
    let checkpoint = Checkpoint {
        state: State {
            cycles: 2500.0,
            compression: vec![1e-7],
            compression_rate: vec![0.0],
            ..State::default()
        },
        progress: Progress { steps: 7, ..Progress::default() },
        ..Checkpoint::default()
    };
    for (name, complete) in [("part.h5", false), ("whole.h5", true)] {
        let mut writer = RunWriter::create(&folder.path().join(name), header.clone(), false).unwrap();
        writer.push(snapshot.clone());
        let reason = if complete { StopReason::End } else { StopReason::Interrupted };
        writer.save(&checkpoint, reason, complete).unwrap();
        let json = object(folder.path(), &["info", name, "--json"]);
        assert_eq!(json["complete"], complete);
        assert_eq!(json["stop_reason"], reason.name());
        assert_eq!((&json["nodes"], &json["snapshots"], &json["steps"]), (&3.into(), &1.into(), &7.into()));
        assert_eq!((&json["cycles"], &json["checkpoint_cycles"]), (&2000.0.into(), &2500.0.into()));
        assert!(json["normal_force"].is_null(), "what is no number is null");
        assert!((json["limit"]["distance"].as_f64().unwrap() - 0.05).abs() < 1e-15);
        assert!((json["limit"]["distance_relative"].as_f64().unwrap() - 0.25).abs() < 1e-15);
        assert_eq!(json["scene"], "title = \"Three nodes\"\n");
        let printed = done(folder.path(), &["info", name]);
        let words =
            if complete { "yes (end)" } else { "no (interrupted); go on with fretwear run --resume part.h5" };
        assert!(printed.contains(words) && printed.starts_with("Three nodes\n"), "{printed}");
    }
}
