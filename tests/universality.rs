//! Universality studies: cases that follow from patches, the judge, and results that do not depend on how they were run.

mod support;

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::time::Duration;

use fretwear::scene::{Prediction, UniversalityStudy, covering_design};
use fretwear::study::universality::{CaseResult, Options, Outcome, Universality, Verdict};
use support::command::{names, object, program, run, text};

/// Thirty springs: milliseconds a case, and the limit to round-off all the same.
const BASE: &str = r#"
title = "small"
[tolerances]
within = 1e-6
outside = 1e-3
[scene]
indenter = { paraboloid = { radius = 1 } }
half_space = { grading = 0, normal_stiffness = 1, stiffness_ratio = 1 }
friction = { coulomb = { coefficient = 0.5 } }
wear = { archard = { coefficient = 1e-3 } }
loading = { indentation = 1, amplitude_ratio = 0.5, tau = 100 }
numerics = { springs = 30, tolerance = 1e-4 }
output = { snapshots = 5 }
"#;

const CASES: &str = r#"
[[media]]
name = "homogeneous"
[[media]]
name = "graded, cone"
patch = { half_space = { grading = 0.5 }, indenter = { cone = { slope = 2 } } }
[[wear]]
name = "Archard"
[[wear]]
name = "energy"
patch = { wear = { dissipated-energy = { coefficient = 1e-3 } } }
tau = 120
[[modes]]
name = "tangential"
[[cases]]
name = "stopped early"
predicted = "outside"
reason = "not there yet"
patch = { loading = { tau = 1 } }
finer = true
"#;

fn study(cases: &str) -> UniversalityStudy {
    UniversalityStudy::from_toml(&format!("{BASE}{cases}"), "study.toml", Path::new("")).unwrap()
}

fn refused(text: &str) -> String {
    let error = UniversalityStudy::from_toml(text, "study.toml", Path::new("")).unwrap_err();
    error.to_string()
}

fn execute(study: &UniversalityStudy, folder: &Path, threads: usize) -> Outcome {
    let options = Options { threads: Some(threads), overwrite: false };
    Universality::new(study, folder, &options, &fretwear::Stop::default())
        .unwrap()
        .execute(None)
        .unwrap()
        .expect("no signal came")
}

fn row<'a>(outcome: &'a Outcome, name: &str) -> &'a CaseResult {
    outcome.rows.iter().find(|row| row.case.name == name).expect("a case of this name")
}

/// A study in a file in a folder of its own.
fn place(cases: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("study.toml"), format!("{BASE}{cases}")).unwrap();
    let output = folder.path().join("out");
    (folder, output)
}

#[test]
fn every_two_levels_meet_in_few_combinations() {
    for levels in [vec![8, 5, 4, 6], vec![1, 3, 1, 2], vec![4, 4, 4], vec![2, 7]] {
        let design = covering_design(&levels, |_| true);
        let mut largest = levels.clone();
        largest.sort_unstable_by(|a, b| b.cmp(a));
        let (least, all) = (largest[0] * largest[1], levels.iter().product::<usize>());
        assert!(design.len() <= all.min(least + least / 4), "{levels:?}: {} of {least}", design.len());
        assert_eq!(design.iter().collect::<HashSet<_>>().len(), design.len(), "{levels:?}: no case twice");
        for (a, b) in (0..levels.len()).flat_map(|b| (0..b).map(move |a| (a, b))) {
            for (i, j) in (0..levels[a]).flat_map(|i| (0..levels[b]).map(move |j| (i, j))) {
                let met = design.iter().any(|it| it[a] == i && it[b] == j);
                assert!(met, "{levels:?}: level {i} of factor {a} and level {j} of factor {b}");
            }
        }
    }
}

#[test]
fn a_pair_left_out_costs_no_other_pair() {
    let levels = [3, 3, 2];
    let allowed = |it: &[usize]| !(it[0] == 1 && it[2] == 1);
    let design = covering_design(&levels, allowed);
    assert!(design.iter().all(|it| allowed(it)), "{design:?}");
    for (a, b) in [(0, 1), (0, 2), (1, 2)] {
        for (i, j) in (0..levels[a]).flat_map(|i| (0..levels[b]).map(move |j| (i, j))) {
            let met = design.iter().any(|it| it[a] == i && it[b] == j);
            assert_eq!(met, (a, b, i, j) != (0, 2, 1, 1), "{a} {b} {i} {j}: {design:?}");
        }
    }
}

#[test]
fn the_studies_of_the_data_folder_can_be_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/studies");
    let study = UniversalityStudy::read(&folder.join("universality.toml")).unwrap();
    for case in study.cases() {
        for text in [Some(&case.scene), case.finer.as_ref()].into_iter().flatten() {
            study_scene(&study, &case.name, text);
        }
    }
    let theorem = UniversalityStudy::read(&folder.join("universality_held_forces.toml")).unwrap();
    assert_eq!(theorem.cases().len(), 60, "six laws in ten media");
    for case in theorem.cases() {
        assert_eq!(case.predicted, Prediction::Within);
        assert!(
            theorem.scene(&case.name, &case.scene).unwrap().conditions().holds_both_forces(),
            "{}",
            case.name
        );
    }
    let count = |predicted| study.cases().iter().filter(|case| case.predicted == predicted).count();
    let [within, outside] = Prediction::ALL.map(count);
    assert!((72..=85).contains(&within), "8 media with 9 modes are 72 pairs: {within} cases");
    assert!(outside >= 10, "{outside} negative controls");
}

fn study_scene(study: &UniversalityStudy, name: &str, text: &str) {
    let scene = study.scene(name, text).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scene.title(), Some(name));
}

#[test]
fn patches_replace_what_excludes_them_and_nothing_else() {
    let study = study(CASES);
    let names: Vec<&str> = study.cases().iter().map(|case| case.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "homogeneous + Archard + tangential",
            "homogeneous + energy + tangential",
            "graded, cone + Archard + tangential",
            "graded, cone + energy + tangential",
            "stopped early"
        ]
    );
    let case = study.case("graded, cone + energy + tangential").unwrap();
    assert_eq!(case.levels, ["graded, cone", "energy", "", "tangential"]);
    let scene: toml::Table = case.scene.parse().unwrap();
    let expected: toml::Table = r#"
        title = "graded, cone + energy + tangential"
        indenter = { cone = { slope = 2 } }
        half_space = { grading = 0.5, normal_stiffness = 1, stiffness_ratio = 1 }
        friction = { coulomb = { coefficient = 0.5 } }
        wear = { dissipated-energy = { coefficient = 1e-3 } }
        loading = { indentation = 1, amplitude_ratio = 0.5, tau = 120.0 }
        numerics = { springs = 30, tolerance = 1e-4 }
        output = { snapshots = 5 }
    "#
    .parse()
    .unwrap();
    assert_eq!(scene, expected);
    // What is asked for twice is what the finer run has.
    let finer: toml::Table = study.cases()[4].finer.as_ref().unwrap().parse().unwrap();
    assert_eq!(finer["numerics"]["springs"].as_integer(), Some(60));
    assert_eq!(finer["numerics"]["tolerance"].as_float(), Some(1.25e-5));
    assert_eq!(study.cases()[4].predicted, Prediction::Outside);
}

#[test]
fn all_combinations_are_run_where_that_is_asked_for() {
    let cases = CASES.to_owned() + "[[friction]]\nname = \"one\"\n[[friction]]\nname = \"two\"\n";
    let full = format!("cover = \"full\"\n{BASE}{cases}");
    let full = UniversalityStudy::from_toml(&full, "study.toml", Path::new("")).unwrap();
    assert_eq!((full.cases().len(), study(&cases).cases().len()), (9, 5));
    let without = full.text().to_owned() + "[[without]]\nlevels = [\"two\", \"energy\"]\nreason = \"no\"\n";
    let fewer = UniversalityStudy::from_toml(&without, "study.toml", Path::new("")).unwrap();
    assert_eq!(fewer.cases().len(), 7);
}

#[test]
fn what_contradicts_itself_is_refused_by_name() {
    let level = |table: &str, name: &str, patch: &str| {
        format!("[[{table}]]\nname = \"{name}\"\npatch = {{ {patch} }}\n")
    };
    for (cases, expected) in [
        (
            level("wear", "a", "loading = { tau = 1 }") + &level("modes", "b", "loading = { tau = 2 }"),
            "the wear \"a\" sets loading.tau and the mode \"b\" sets loading.tau otherwise",
        ),
        (
            level("media", "a", "loading = { amplitude_ratio = 0.1 }")
                + &level("modes", "b", "loading = { stick_ratio = 0.9 }"),
            "the medium \"a\" sets loading.amplitude_ratio and the mode \"b\" sets loading.stick_ratio otherwise",
        ),
        (
            level(
                "wear",
                "a",
                "wear = { archard = { coefficient = 1 }, dissipated-energy = { coefficient = 1 } }",
            ),
            "a: wear.archard and wear.dissipated-energy exclude each other",
        ),
        (level("wear", "a", "") + &level("modes", "a", ""), "modes[0].name = \"a\" is given twice"),
        (level("waer", "a", ""), "waer is not a key of a universality study; did you mean wear?"),
        ("[[cases]]\nname = \"a\"\n".into(), "cases[0].predicted is missing"),
        ("[[cases]]\nname = \"a\"\npredicted = \"perhaps\"\n".into(), "is not allowed here"),
        (String::new(), "has no case; give levels"),
        (
            level("wear", "a", "") + "[[without]]\nlevels = [\"a\", \"b\"]\n",
            "without[0].levels[1] = \"b\" is the name of no level",
        ),
    ] {
        let message = refused(&format!("{BASE}{cases}"));
        assert!(message.contains(expected), "{cases}\n{message}");
        assert!(message.starts_with("study.toml:") && message.contains('^'), "no line is shown: {message}");
    }
    // The same value is no conflict.
    let same = level("wear", "a", "loading = { tau = 1 }") + &level("modes", "b", "loading = { tau = 1 }");
    assert_eq!(study(&same).cases().len(), 1);
    let tolerances = BASE.replace("within = 1e-6", "within = 1e-3") + CASES;
    assert!(refused(&tolerances).contains("within = 0.001 is not below outside = 0.001"));
}

#[test]
fn cases_reach_the_limit_of_their_own_run_or_do_not() {
    let folder = tempfile::tempdir().unwrap();
    let outcome = execute(&study(CASES), folder.path(), 2);
    assert_eq!(names(folder.path()), ["universality.csv", "universality.h5"]);
    for row in &outcome.rows {
        let end = row.end.as_ref().unwrap();
        let distance = end.distance.unwrap();
        assert!(row.agrees(), "{}: {distance:e}", row.case.name);
        if row.case.predicted == Prediction::Within {
            // Measured: 1e-7 is left of the transient, 4e-7 is the quadrature over thirty springs, 0.004 the way between two of them.
            assert!(distance < 4e-7, "{}: {distance:e}", row.case.name);
            let volume = (end.wear_volume / end.wear_volume_limit - 1.0).abs();
            assert!(volume < 3e-6, "{}: {volume:e}", row.case.name);
            let gaps = end.curve.iter().zip(&end.curve_limit).map(|(a, b)| (a - b).abs());
            assert!(gaps.fold(0.0, f64::max) < 0.01, "{}", row.case.name);
        }
        let ratio = if row.case.name.contains("cone") { 0.5 } else { 0.5f64.sqrt() };
        assert!((end.stick_ratio() - ratio).abs() < 1e-14, "{}: c/a0 = {}", row.case.name, end.stick_ratio());
    }
    let early = row(&outcome, "stopped early");
    assert_eq!(early.verdict, Verdict::Violates);
    let [distance, volume] = early.refinement().unwrap();
    assert!(
        distance != 0.0 && distance.abs() < 1e-2 && volume != 0.0 && volume.abs() < 1e-2,
        "{distance:e} {volume:e}"
    );
}

/// Of each kind of data/studies/universality.toml a few, with fewer springs.
const KINDS: &str = r#"
[[wear]]
name = "p s"
[[wear]]
name = "p^1.5 s"
patch = { wear = { power-law = { coefficient = 1e-3, pressure_exponent = 1.5, slip_exponent = 1 } } }
tau = 1e5
[[wear]]
name = "p s^0.5"
patch = { wear = { power-law = { coefficient = 1e-3, pressure_exponent = 1, slip_exponent = 0.5 } } }
[[friction]]
name = "Coulomb"
[[friction]]
name = "static and kinetic"
patch = { friction = { static-kinetic = { static_coefficient = 0.6, kinetic_coefficient = 0.5 } } }
[[modes]]
name = "tangential"
[[modes]]
name = "growing blocks"
patch = { loading = { blocks = [{ tau = 2, amplitude_factor = 0.6 }, { tau = 2, amplitude_factor = 1 }] } }
[[modes]]
name = "ellipse"
patch = { loading = { orbit = { transverse_ratio = 0.6 } } }

[[cases]]
name = "normal force held"
predicted = "outside"
patch = { loading = { amplitude_ratio = 0.51, normal_force = 1.3333333333333333, tau = 1000 } }
finer = true
[[cases]]
name = "amplitude halved"
predicted = "outside"
patch = { loading = { amplitude_ratio = 0.51, blocks = [{ tau = 3, amplitude_factor = 1 }, { tau = 1, amplitude_factor = 0.5 }] } }
finer = true
[[cases]]
name = "friction rising"
predicted = "outside"
patch = { friction = { history = { final_factor = 2, tau = 3 } } }
finer = true
[[cases]]
name = "threshold"
predicted = "outside"
patch = { wear = { threshold = { coefficient = 1e-3, pressure = 0.1 } } }
finer = true
"#;

#[test]
fn laws_and_modes_share_the_limit_and_the_controls_do_not() {
    let folder = tempfile::tempdir().unwrap();
    let outcome = execute(&study(KINDS), folder.path(), 2);
    for row in &outcome.rows {
        let distance = row.end.as_ref().unwrap_or_else(|why| panic!("{}: {why}", row.case.name)).distance;
        assert!(row.agrees(), "{}: {distance:?}", row.case.name);
        // Another shape, and no matter of the mesh: the distance does not fall away.
        if let Some([change, _]) = row.refinement() {
            assert!(change.abs() < 0.1 * distance.unwrap(), "{}: {change:e}", row.case.name);
        }
    }
    // An independent prototype: 0.346 within 2 %, and 0.162.
    for (name, volume, tolerance) in [("normal force held", 0.346, 0.02), ("amplitude halved", 0.162, 0.02)] {
        let found = row(&outcome, name).end.as_ref().unwrap().wear_volume_relative();
        assert!((found / volume - 1.0).abs() < tolerance, "{name}: {found}");
    }
}

#[test]
fn threads_do_not_change_a_digit() {
    let study = study(CASES);
    let table = |threads| {
        let folder = tempfile::tempdir().unwrap();
        execute(&study, folder.path(), threads);
        let table = std::fs::read_to_string(folder.path().join("universality.csv")).unwrap();
        // The last column is the wall time.
        let rows = table.lines().map(|line| line.rsplit_once(',').unwrap().0.to_owned());
        rows.collect::<Vec<_>>()
    };
    assert_eq!(table(1), table(3));
}

#[test]
fn a_wrong_prediction_is_an_exit_code_after_everything_is_written() {
    let (folder, output) = place(&CASES.replace("predicted = \"outside\"", "predicted = \"within\""));
    let answer = run(folder.path(), &["universality", "study.toml", "-o", "out", "--json"]);
    assert_eq!(answer.status.code(), Some(1), "{}", text(&answer.stderr));
    assert!(text(&answer.stderr).contains("1 of 5 cases are not as predicted"), "{}", text(&answer.stderr));
    let report: serde_json::Value = serde_json::from_slice(&answer.stdout).unwrap();
    assert_eq!((report["count"].as_u64(), report["agreeing"].as_u64()), (Some(5), Some(4)));
    assert_eq!(report["cases"][4]["verdict"], "violates");
    assert_eq!(names(&output), ["universality.csv", "universality.h5"]);

    let again = run(folder.path(), &["universality", "study.toml", "-o", "out"]);
    assert_eq!(again.status.code(), Some(2), "an existing file is not overwritten");
    let shown = run(folder.path(), &["universality", "study.toml", "-o", "out", "--force"]);
    assert!(text(&shown.stdout).contains("violates (not as predicted)"), "{}", text(&shown.stdout));
    let info = object(folder.path(), &["info", "out/universality.h5", "--json"]);
    assert_eq!((&info["format"], &info["complete"]), (&"fretwear-universality".into(), &true.into()));
    let found = info["arrays"].as_array().unwrap().iter().find(|it| it["name"] == "profile_limit").unwrap();
    assert_eq!(found["shape"], serde_json::json!([5, 101]));
}

#[test]
fn a_run_that_fails_is_a_row() {
    let (folder, _) = place(
        "[[cases]]\nname = \"rests\"\npredicted = \"outside\"\npatch = { loading = { amplitude_ratio = 0 } }\n\
         [[cases]]\nname = \"sticks, of \\\"course\\\"\"\npredicted = \"within\"\n",
    );
    let answer = run(folder.path(), &["universality", "study.toml", "-o", "out", "--json"]);
    assert_eq!(answer.status.code(), Some(1));
    let report: serde_json::Value = serde_json::from_slice(&answer.stdout).unwrap();
    assert_eq!(
        (&report["cases"][0]["verdict"], &report["cases"][1]["verdict"]),
        (&"failed".into(), &"obeys".into())
    );
    assert!(report["cases"][0]["error"].as_str().unwrap().contains("stuck"), "{report}");
    let table = std::fs::read_to_string(folder.path().join("out/universality.csv")).unwrap();
    assert!(
        table.lines().nth(2).unwrap().starts_with("\"sticks, of \"\"course\"\"\",,,,,within,obeys,end,,1e0,"),
        "{table}"
    );
}

#[test]
fn scenes_that_are_not_valid_leave_nothing_behind() {
    let (folder, output) =
        place("[[cases]]\nname = \"x\"\npredicted = \"within\"\npatch = { loading = { tua = 1 } }\n");
    let answer = run(folder.path(), &["universality", "study.toml", "-o", "out"]);
    assert_eq!(answer.status.code(), Some(2));
    let message = text(&answer.stderr);
    assert!(
        message.contains("1 of 1 scenes are not valid") && message.contains("study.toml, x:"),
        "{message}"
    );
    assert!(!output.exists());
}

#[test]
fn cases_are_listed_and_their_scenes_run_by_themselves() {
    let (folder, _) = place(CASES);
    let list = run(folder.path(), &["universality", "study.toml", "--list"]);
    assert_eq!(text(&list.stdout).lines().count(), 5);
    assert!(text(&list.stdout).ends_with("outside: stopped early\n"), "{}", text(&list.stdout));
    let scene = run(folder.path(), &["universality", "study.toml", "--scene", "stopped early"]);
    std::fs::write(folder.path().join("early.toml"), &scene.stdout).unwrap();
    let report = object(folder.path(), &["run", "early.toml", "--json"]);
    assert_eq!(report["tau"].as_f64(), Some(1.0));
    let none = run(folder.path(), &["universality", "study.toml", "--scene", "stopped erly"]);
    assert!(text(&none.stderr).contains("did you mean \"stopped early\"?"));
}

#[cfg(unix)]
#[test]
fn a_stopped_study_goes_on_where_it_was() {
    // Every cycle by itself: long enough to be stopped on the way.
    let slow = "[[cases]]\nname = \"slow\"\npredicted = \"outside\"\n\
                patch = { loading = { tau = 10 }, numerics = { springs = 100, stepper = \"every-cycle\" }, \
                wear = { archard = { coefficient = 3e-4 } } }\n";
    let (folder, output) = place(&format!("{CASES}{slow}"));
    let arguments = ["universality", "study.toml", "-o", "out", "--quiet", "--threads", "1"];
    let mut child = program(folder.path(), &arguments).spawn().unwrap();
    let kept = || -> Vec<PathBuf> {
        let scratch = std::fs::read_dir(&output).into_iter().flatten().flatten().map(|it| it.path());
        let inside = scratch.flat_map(|it| std::fs::read_dir(it).into_iter().flatten().flatten());
        inside.map(|it| it.path()).filter(|it| it.extension().is_some_and(|it| it == "h5")).collect()
    };
    while kept().len() < 6 {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it was stopped");
        std::thread::sleep(Duration::from_millis(5));
    }
    // A run that took long enough to be worth keeping.
    std::thread::sleep(Duration::from_millis(400));
    // SAFETY: the process is a child that has not been waited for.
    unsafe { libc::kill(child.id().cast_signed(), libc::SIGTERM) };
    assert_eq!(child.wait().unwrap().code(), Some(75));
    assert_eq!(kept().len(), 7, "six that are done, and one that goes on");
    let name = names(&output);
    assert!(name.len() == 1 && name[0].starts_with(".fretwear-"), "{name:?}");

    let resumed = run(folder.path(), &arguments);
    assert_eq!(text(&resumed.stderr), "");
    assert_eq!(names(&output), ["universality.csv", "universality.h5"]);
    let whole = run(folder.path(), &["universality", "study.toml", "-o", "whole", "--quiet"]);
    assert_eq!(resumed.status.code(), whole.status.code());
    let table = |name: &str| {
        let table = std::fs::read_to_string(folder.path().join(name).join("universality.csv")).unwrap();
        table.lines().map(|line| line.rsplit_once(',').unwrap().0.to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(table("out"), table("whole"));
}
