//! A calibration that was killed goes on with the same command, and comes to the same to the last bit.

mod support;

use std::fs;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;

use support::calibration::{AMPLITUDE, BALL, WEAR, csv, noise, truth};
use support::command::{done, program, run, text};

const NAMES: [&str; 3] = ["calibration.h5", "parameters.csv", "residuals.csv"];

/// A folder with a calibration of two unknowns, which takes about a hundred runs.
fn place() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let cycles = [1e4, 3e4, 1e5, 2e5, 4e5, 7e5, 1e6];
    let volumes = truth(BALL, &[], &cycles).worn_volume();
    let noisy: Vec<f64> = volumes[1..].iter().zip(noise(9, 7)).map(|(v, e)| v * (1.0 + 0.02 * e)).collect();
    let data = "[[data]]\nfile = \"v.csv\"\ncycles = \"N\"\nwear_volume = \"V\"\nrelative_deviation = 0.02\n";
    fs::write(folder.path().join("scene.toml"), BALL).expect("written");
    fs::write(folder.path().join("v.csv"), csv("N,V", &[&cycles, &noisy])).expect("written");
    let document = format!("scene = \"scene.toml\"\n{WEAR}{AMPLITUDE}{data}");
    fs::write(folder.path().join("two.toml"), document).expect("written");
    folder
}

/// The runs that a killed call has left.
fn kept(folder: &Path) -> Vec<PathBuf> {
    let entries = |path: &Path| fs::read_dir(path).into_iter().flatten().flatten().map(|it| it.path());
    let own =
        |it: &PathBuf| it.file_name().is_some_and(|name| name.to_string_lossy().starts_with(".fretwear"));
    let inner = entries(folder).filter(own).flat_map(|it| entries(&it).collect::<Vec<_>>());
    inner.filter(|it| it.extension().is_some_and(|it| it == "h5")).collect()
}

fn killed_after(folder: &Path, arguments: &[&str], milliseconds: u64) {
    let mut child = program(folder, arguments).spawn().expect("it starts");
    sleep(Duration::from_millis(milliseconds));
    let _ = child.kill();
    let _ = child.wait();
}

#[test]
fn a_killed_calibration_goes_on_and_comes_to_the_same_bits() {
    let folder = place();
    let path = folder.path();
    done(path, &["calibrate", "two.toml", "-o", "whole", "--quiet"]);
    let command = ["calibrate", "two.toml", "-o", "parts", "--quiet"];
    let (mut counts, mut changed) = (vec![], vec![]);
    for milliseconds in [60, 110, 170, 90, 130] {
        killed_after(path, &command, milliseconds);
        let found = kept(&path.join("parts"));
        let stamps = |all: &[PathBuf]| -> Vec<_> {
            let stamp = |it: &PathBuf| (it.clone(), fs::metadata(it).and_then(|it| it.modified()).ok());
            all.iter().map(stamp).collect()
        };
        let now = stamps(&found);
        // A run that is done is not done again.
        let again = |it: &(PathBuf, _)| now.iter().any(|other| other.0 == it.0 && other.1 != it.1);
        assert!(!changed.iter().any(again), "{changed:?} {now:?}");
        changed = now;
        counts.push(found.len());
    }
    assert!(counts.windows(2).all(|it| it[0] <= it[1]), "{counts:?}");
    // Damage is not trusted: that run is done again.
    if let Some(one) = kept(&path.join("parts")).first() {
        let mut bytes = fs::read(one).expect("readable");
        let middle = bytes.len() / 2;
        bytes[middle] ^= 0x55;
        fs::write(one, bytes).expect("written");
    }
    done(path, &command);
    for name in NAMES {
        let [whole, parts] = ["whole", "parts"].map(|it| fs::read(path.join(it).join(name)).expect("there"));
        assert!(whole == parts, "{name} differs after interruptions with {counts:?} runs kept");
    }
    assert_eq!(kept(&path.join("parts")), [] as [PathBuf; 0]);
}

#[test]
#[cfg(unix)]
fn a_signal_leaves_what_is_done_and_the_exit_code_that_says_so() {
    let folder = place();
    let path = folder.path();
    let arguments = ["calibrate", "two.toml", "-o", "out"];
    let mut child =
        program(path, &arguments).stderr(std::process::Stdio::piped()).spawn().expect("it starts");
    while kept(&path.join("out")).is_empty() && child.try_wait().expect("a child").is_none() {
        sleep(Duration::from_millis(5));
    }
    // SAFETY: one system call with the number of a child that was not waited for.
    unsafe { libc::kill(child.id().cast_signed(), libc::SIGTERM) };
    let output = child.wait_with_output().expect("an end");
    assert_eq!(output.status.code(), Some(75), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("goes on from here"), "{}", text(&output.stderr));
    assert!(!kept(&path.join("out")).is_empty());
    let again = run(path, &arguments);
    assert_eq!(again.status.code(), Some(0), "{}", text(&again.stderr));
    assert!(path.join("out/calibration.h5").exists() && kept(&path.join("out")).is_empty());
}
