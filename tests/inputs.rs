//! Files that are no files of numbers or words: devices, pipes, directories, and what is too large. All are refused at once.

mod support;

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use support::command::{ended, names, program, text};

const SCENE: &str = include_str!("../data/scenes/paraboloid.toml");
const TABLE: &str = include_str!("../data/scenes/measured_profile.toml");

/// Places that a user may name by mistake, with what is said of them.
fn places(folder: &Path) -> Vec<(String, &'static str)> {
    let name = |name: &str| folder.join(name).to_string_lossy().into_owned();
    assert!(Command::new("mkfifo").arg(name("pipe")).status().expect("mkfifo").success());
    fs::create_dir(name("folder")).unwrap();
    // Without a byte on the disk.
    File::create(name("sparse")).unwrap().set_len(10_000_000_000).unwrap();
    vec![
        ("/dev/zero".into(), "is not a"),
        ("/dev/urandom".into(), "is not a"),
        ("/dev/null".into(), "is not a"),
        (name("pipe"), "is "),
        (name("folder"), "is "),
        (name("sparse"), "is "),
    ]
}

#[test]
fn every_command_refuses_what_has_no_end_and_waits_for_nothing() {
    let (folder, away) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let places = places(away.path());
    let commands: [&[&str]; 15] = [
        &["check", "@"],
        &["limit", "@"],
        &["run", "@", "-o", "run.h5"],
        &["sweep", "@", "-o", "out"],
        &["submit", "@", "-o", "out", "--engine", "slurm", "--dry-run"],
        &["map", "@", "-o", "out"],
        &["universality", "@", "-o", "out"],
        &["tradeoff", "@", "-o", "out"],
        &["calibrate", "@", "-o", "out"],
        &["info", "@"],
        &["export", "@"],
        &["plot", "@", "-o", "figure.svg"],
        &["report", "@", "-o", "report.html"],
        &["run", "--resume", "@"],
        &["info", "@", "--force"],
    ];
    for (place, words) in &places {
        for command in commands {
            let arguments: Vec<&str> = command.iter().map(|&it| if it == "@" { place } else { it }).collect();
            let output = ended(program(folder.path(), &arguments));
            let message = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
            assert!(message.contains(&format!("{place}: {words}")), "{arguments:?}: {message}");
            assert!(names(folder.path()).is_empty(), "{arguments:?} wrote {:?}", names(folder.path()));
        }
    }
}

#[test]
fn tables_paths_and_base_scenes_are_refused_in_the_same_way() {
    let (folder, away) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let at = folder.path();
    let along = |file: &str| {
        let path = format!("path = {{ file = \"{file}\", displacement_unit = \"um\" }}");
        SCENE.replace("amplitude = \"0.325 um\"", &path)
    };
    for (place, words) in places(away.path()) {
        let table = TABLE.replace("measured_profile.csv", &place);
        let study = format!("scene = \"{place}\"\n[[axes]]\nkey = \"half_space.grading\"\nvalues = [0.0]\n");
        fs::write(at.join("scene.toml"), along(&place)).unwrap();
        fs::write(at.join("table.toml"), table).unwrap();
        fs::write(at.join("study.toml"), study).unwrap();
        for command in [
            &["check", "table.toml"][..],
            &["check", "scene.toml"],
            &["run", "table.toml"],
            &["sweep", "study.toml", "-o", "out"],
        ] {
            let output = ended(program(at, command));
            let message = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{place}, {command:?}: {message}");
            assert!(message.contains(&format!("{place}: {words}")), "{place}, {command:?}: {message}");
        }
        assert_eq!(names(at), ["scene.toml", "study.toml", "table.toml"], "{place}");
    }
}

#[test]
fn a_scene_may_come_through_a_pipe_up_to_the_bound() {
    let folder = tempfile::tempdir().unwrap();
    let piped = |bytes: Vec<u8>| {
        let mut command = program(folder.path(), &["check", "/dev/stdin"]);
        let (reader, mut writer) = std::io::pipe().unwrap();
        command.stdin(Stdio::from(reader));
        // The reader may go away before all is written.
        let writing = std::thread::spawn(move || writer.write_all(&bytes).is_ok());
        let output = ended(command);
        writing.join().unwrap();
        output
    };
    let output = piped(SCENE.into());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("paraboloid, radius 10 mm"));
    let output = piped(vec![b'#'; 11_000_000]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("/dev/stdin: is larger than 10000000 bytes"));
    let output = piped(vec![]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("/dev/stdin: is a pipe into which nothing is written"));
}

#[test]
fn no_more_threads_are_started_than_there_are_cores() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("scene.toml"), SCENE.replace("cycles = 1e6", "tau = 0.1")).unwrap();
    let study = "scene = \"scene.toml\"\n[[axes]]\nkey = \"friction.coulomb.coefficient\"\nvalues = [0.7]\n";
    fs::write(at.join("study.toml"), study).unwrap();
    let most = fretwear::study::most_threads();
    let many = ["sweep", "study.toml", "-o", "many", "--quiet", "--threads", "65535"];
    let output = ended(program(at, &many));
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{message}");
    assert!(message.contains(&format!("--threads 65535: this process may use {most} cores")), "{message}");
    let one = ["sweep", "study.toml", "-o", "one", "--quiet", "--threads", "1"];
    assert!(!text(&ended(program(at, &one)).stderr).contains("--threads"));
}
