//! What was computed from something else is never used: checkpoints, parts, runs that are kept, merged files.

mod support;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Child;
use std::time::Duration;

use fretwear::data::{RunFile, SweepFile, Values};
use hdf5::types::VarLenUnicode;
use support::command::{names, object, program, run, text};

/// Every cycle by itself, a second or two; checkpoints come often.
const SLOW: &str = r#"
[indenter.paraboloid]
radius = "10 mm"
[half_space]
grading = 0.0
modulus = "210 GPa"
poisson_ratio = 0.3
[friction.coulomb]
coefficient = 0.6
[wear.archard]
coefficient = "5e-14 1/Pa"
[loading]
initial_force = "50 N"
stick_ratio = 0.7
cycles = 4000
[numerics]
springs = 100
stepper = "every-cycle"
checkpoint_interval = 0.05
[output]
snapshots = 3
"#;
const STUDY: &str = "scene = \"scene.toml\"\n[[axes]]\nkey = \"loading.stick_ratio\"\nvalues = [0.5, 0.7]\n";
const SWEEP: [&str; 8] =
    ["sweep", "study.toml", "-o", "out", "--threads", "1", "--checkpoint-interval", "0.05"];

fn place(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    files.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).unwrap());
    folder
}

/// Stops a command by SIGTERM when something is there.
fn stopped(folder: &Path, arguments: &[&str], there: impl Fn() -> bool) {
    let mut child: Child = program(folder, arguments).stderr(std::process::Stdio::null()).spawn().unwrap();
    while !there() {
        assert!(child.try_wait().unwrap().is_none(), "it ended before it was stopped");
        std::thread::sleep(Duration::from_millis(2));
    }
    // SAFETY: the process is a child that has not been waited for.
    unsafe { libc::kill(child.id().cast_signed(), libc::SIGTERM) };
    assert_eq!(child.wait().unwrap().code(), Some(75), "stopped with a checkpoint");
}

fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return vec![] };
    let paths = entries.flatten().map(|it| it.path());
    paths.filter(|it| it.extension().is_some_and(|it| it == ending)).collect()
}

/// The hidden directory in which unfinished runs are kept.
fn scratch(folder: &Path) -> Option<PathBuf> {
    let entries = fs::read_dir(folder).ok()?.flatten().map(|it| it.path());
    entries.into_iter().find(|it| it.join("marker").exists() && !it.join("content").exists())
}

fn volumes(path: &Path) -> Vec<f64> {
    let file = SweepFile::read(path).unwrap();
    match &file.columns.iter().find(|it| it.name == "wear_volume").unwrap().values {
        Values::Numbers(values) => values.clone(),
        _ => panic!("numbers"),
    }
}

fn edit(path: &Path, change: impl FnOnce(&hdf5::File)) {
    let file = hdf5::File::append(path).unwrap();
    change(&file);
    file.close().unwrap();
}

fn put_text(file: &hdf5::File, name: &str, text: &str) {
    let text: VarLenUnicode = text.parse().unwrap();
    file.attr(name).unwrap().write_scalar(&text).unwrap();
}

#[test]
fn a_checkpoint_of_an_edited_study_is_not_used() {
    let folder = place(&[("scene.toml", SLOW), ("study.toml", STUDY)]);
    let at = folder.path();
    let parts = at.join("out/parts");
    stopped(at, &SWEEP, || !files(&parts, "h5").is_empty());
    let left = files(&parts, "h5");
    assert!(left.len() == 1 && left[0].to_str().unwrap().contains("scene-0."), "{left:?}");
    fs::write(at.join("study.toml"), STUDY.replace("0.5", "0.65")).unwrap();
    assert_eq!(run(at, &SWEEP).status.code(), Some(0));
    assert!(names(&parts).is_empty(), "the old checkpoint is the program's own: {:?}", names(&parts));
    let mut fresh = SWEEP;
    fresh[3] = "fresh";
    assert_eq!(run(at, &fresh).status.code(), Some(0));
    let [found, expected] = ["out", "fresh"].map(|it| volumes(&at.join(it).join("shard-0-of-1.h5")));
    assert_eq!(found, expected, "the row of 0.65 is that of 0.65");
}

#[test]
fn a_checkpoint_of_an_edited_table_is_not_used() {
    let table = |height: f64| -> String {
        let rows = (0..=60).map(|i| f64::from(i) * 1e-5);
        rows.map(|r| format!("{r:e}, {:e}\n", height * r * r)).collect()
    };
    let scene =
        SLOW.replace("[indenter.paraboloid]\nradius = \"10 mm\"", "[indenter.table]\nfile = \"ball.csv\"");
    let scene = scene.replace("initial_force = \"50 N\"", "indentation = \"1 um\"");
    let folder = place(&[("scene.toml", &scene), ("study.toml", STUDY), ("ball.csv", &table(50.0))]);
    let at = folder.path();
    let parts = at.join("out/parts");
    stopped(at, &SWEEP, || !files(&parts, "h5").is_empty());
    fs::write(at.join("ball.csv"), table(40.0)).unwrap();
    assert_eq!(run(at, &SWEEP).status.code(), Some(0));
    let mut fresh = SWEEP;
    fresh[3] = "fresh";
    assert_eq!(run(at, &fresh).status.code(), Some(0));
    let [found, expected] = ["out", "fresh"].map(|it| volumes(&at.join(it).join("shard-0-of-1.h5")));
    assert_eq!(found, expected);
    // Rows that are done are of the table as it was.
    fs::write(at.join("ball.csv"), table(50.0)).unwrap();
    let refused = run(at, &SWEEP);
    assert_eq!(refused.status.code(), Some(2));
    assert!(text(&refused.stderr).contains("another measured profile"), "{}", text(&refused.stderr));
    assert_eq!(volumes(&at.join("out/shard-0-of-1.h5")), expected);
}

#[test]
fn a_table_that_changes_while_a_sweep_runs_ends_it() {
    let rows: String =
        (0..=60).map(|i| f64::from(i) * 1e-5).map(|r| format!("{r:e}, {:e}\n", 50.0 * r * r)).collect();
    let scene =
        SLOW.replace("[indenter.paraboloid]\nradius = \"10 mm\"", "[indenter.table]\nfile = \"ball.csv\"");
    let scene = scene.replace("initial_force = \"50 N\"", "indentation = \"1 um\"");
    let folder = place(&[("scene.toml", &scene), ("study.toml", STUDY), ("ball.csv", &rows)]);
    let at = folder.path();
    let child = program(at, &SWEEP).stderr(std::process::Stdio::piped()).spawn().unwrap();
    while files(&at.join("out/parts"), "h5").is_empty() {
        std::thread::sleep(Duration::from_millis(2));
    }
    fs::write(at.join("ball.csv"), rows.replace("e", "E")).unwrap();
    let output = child.wait_with_output().unwrap();
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("measured profile") && said.contains("changed"), "{said}");
    assert!(!at.join("out/shard-0-of-1.h5").exists(), "nothing of two tables");
}

#[test]
fn a_run_goes_on_with_its_own_scene_and_says_so() {
    let folder = place(&[("scene.toml", SLOW)]);
    let at = folder.path();
    object(at, &["run", "scene.toml", "-o", "whole.h5", "--json"]);
    stopped(at, &["run", "scene.toml", "-o", "run.h5", "--quiet"], || at.join("run.h5").exists());
    fs::write(at.join("scene.toml"), SLOW.replace("stick_ratio = 0.7", "stick_ratio = 0.5")).unwrap();
    let resumed = run(at, &["run", "--resume", "run.h5"]);
    assert_eq!(resumed.status.code(), Some(0), "{}", text(&resumed.stderr));
    assert!(
        text(&resumed.stderr).contains("goes on with the scene that is in run.h5"),
        "{}",
        text(&resumed.stderr)
    );
    let [found, expected] = ["run.h5", "whole.h5"].map(|it| RunFile::open(&at.join(it)).unwrap());
    assert_eq!((found.header, found.snapshots), (expected.header, expected.snapshots));
}

#[test]
fn a_checkpoint_of_something_else_is_refused_and_left_alone() {
    let folder = place(&[("scene.toml", SLOW)]);
    let at = folder.path();
    stopped(at, &["run", "scene.toml", "-o", "run.h5", "--quiet"], || at.join("run.h5").exists());
    let edited = |name: &str, change: &dyn Fn(&hdf5::File)| {
        fs::copy(at.join("run.h5"), at.join(name)).unwrap();
        edit(&at.join(name), change);
    };
    // Only the wear coefficient: shapes and springs are the same.
    let other = SLOW.replace("5e-14", "6e-14");
    edited("scene.h5", &|file| put_text(file, "scene", &other));
    edited("version.h5", &|file| {
        let scene = RunFile::open(&at.join("run.h5")).unwrap().header;
        put_text(file, "program_version", "0.0.9");
        put_text(file, "scene_hash", &scene.scene_hash("0.0.9"));
    });
    edited("format.h5", &|file| file.attr("format_version").unwrap().write_scalar(&2i32).unwrap());
    edited("unknown.h5", &|file| file.delete_attr("scene_hash").unwrap());
    edited("hash.h5", &|file| put_text(file, "scene_hash", "0123"));
    for (name, words) in [
        ("scene.h5", "its scene"),
        ("version.h5", "0.0.9"),
        ("format.h5", "format_version 2"),
        ("unknown.h5", "scene_hash"),
        ("hash.h5", "its scene"),
    ] {
        let before = fs::read(at.join(name)).unwrap();
        assert_eq!(run(at, &["run", "--resume", name]).status.code(), Some(2), "{name}: its checksum");
        let refused = run(at, &["run", "--resume", name, "--unchecked"]);
        let said = text(&refused.stderr);
        assert_eq!(refused.status.code(), Some(2), "{name}: {said}");
        assert!(said.contains(name) && said.contains(words), "{name}: {said}");
        assert!(fs::read(at.join(name)).unwrap() == before, "{name}");
    }
    // What an earlier program wrote can still be looked at.
    object(at, &["info", "unknown.h5", "--json", "--unchecked"]);
}

#[test]
fn parts_of_different_studies_are_not_merged() {
    let quick = include_str!("support/base.toml");
    let folder = place(&[("scene.toml", quick), ("study.toml", STUDY)]);
    let at = folder.path();
    for (shard, output) in [("0/2", "out"), ("1/2", "other")] {
        assert_eq!(run(at, &["sweep", "study.toml", "-o", output, "--shard", shard]).status.code(), Some(0));
        fs::write(at.join("study.toml"), STUDY.replace("0.5", "0.6")).unwrap();
    }
    fs::copy(at.join("other/shard-1-of-2.h5"), at.join("out/shard-1-of-2.h5")).unwrap();
    let refused = run(at, &["merge", "out", "-o", "merged.h5"]);
    assert_eq!(refused.status.code(), Some(2));
    let said = text(&refused.stderr);
    assert!(said.contains("shard-1-of-2.h5") && said.contains("another study"), "{said}");
    assert!(!at.join("merged.h5").exists());
    // Nor is the other study submitted into this directory.
    let refused = run(at, &["submit", "study.toml", "-o", "out", "--engine", "slurm", "--dry-run"]);
    let said = text(&refused.stderr);
    assert_eq!(refused.status.code(), Some(2), "{said}");
    assert!(said.contains("shard-0-of-2.h5") && said.contains("another study"), "{said}");
    assert_eq!(names(&at.join("out")), ["parts", "shard-0-of-2.h5", "shard-1-of-2.h5"]);
}

#[test]
fn runs_of_an_edited_universality_study_are_not_used() {
    let study = "scene = \"scene.toml\"\n[[cases]]\nname = \"one\"\npredicted = \"outside\"\npatch = { loading = { cycles = 40 } }\n\
                 [[cases]]\nname = \"two\"\npredicted = \"outside\"\n";
    let folder = place(&[("scene.toml", SLOW), ("study.toml", study)]);
    let at = folder.path();
    let arguments = ["universality", "study.toml", "-o", "out", "--quiet", "--threads", "1"];
    let runs = || scratch(&at.join("out")).map_or(0, |it| files(&it, "h5").len());
    stopped(at, &arguments, || runs() == 1);
    fs::write(at.join("scene.toml"), SLOW.replace("stick_ratio = 0.7", "stick_ratio = 0.6")).unwrap();
    let table = |output: &str| {
        let mut arguments = arguments;
        arguments[3] = output;
        let output_of = run(at, &arguments);
        assert!(matches!(output_of.status.code(), Some(0 | 1)), "{}", text(&output_of.stderr));
        assert_eq!(names(&at.join(output)), ["universality.csv", "universality.h5"]);
        let table = fs::read_to_string(at.join(output).join("universality.csv")).unwrap();
        // The last column is the wall time.
        table.lines().map(|line| line.rsplit_once(',').unwrap().0.to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(table("out"), table("fresh"));
}

#[test]
fn measurements_of_an_edited_scene_or_with_other_patience_are_not_used() {
    let folder = place(&[("scene.toml", include_str!("support/base.toml"))]);
    let at = folder.path();
    let command = |seconds: &'static str| {
        vec![
            "tradeoff",
            "scene.toml",
            "-o",
            "out",
            "--springs",
            "12,24,48",
            "--tolerances",
            "1e-2,1e-3",
            "--accuracies",
            "1e-2",
            "--repeats",
            "1",
            "--quiet",
            "--most-seconds",
            seconds,
        ]
    };
    let hash = |path: &Path| -> String {
        let record: serde_json::Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
        record["hash"].as_str().unwrap().to_owned()
    };
    let first = || scratch(&at.join("out")).map(|it| it.join("candidate0.json"));
    let mut hashes = vec![];
    let again = |seconds, before: Option<&String>| {
        stopped(at, &command(seconds), || {
            first().is_some_and(|it| it.exists() && before.is_none_or(|before| hash(&it) != *before))
        });
        hash(&first().unwrap())
    };
    hashes.push(again("2", None));
    hashes.push(again("3", hashes.last()));
    fs::write(at.join("scene.toml"), include_str!("support/base.toml").replace("tau = 3", "tau = 2"))
        .unwrap();
    hashes.push(again("3", hashes.last()));
    assert_eq!(run(at, &command("3")).status.code(), Some(0));
    assert_eq!(names(&at.join("out")), ["tradeoff.csv", "tradeoff.h5", "tradeoff.json"]);
}
