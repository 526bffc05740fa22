//! The command `run`, as a script sees it: what it writes, what survives an interruption, what it refuses.

mod support;

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use fretwear::contact::closed_form::LimitingShape;
use fretwear::data::{RunFile, Snapshot, StopReason};
use fretwear::scene::Scene;
use serde_json::Value;
use support::command::{RUN_KEYS, names, object, program, run, text};

const SCENES: [&str; 4] = ["paraboloid", "graded_ceramic", "cone_negative_grading", "measured_profile"];

/// Runs a command that must fail with this code and these words; nothing goes to stdout.
fn refused(folder: &Path, arguments: &[&str], code: i32, words: &[&str]) {
    let output = run(folder, arguments);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {message}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    assert!(!message.contains("panicked"), "{message}");
    for word in words {
        assert!(message.contains(word), "{arguments:?}: no {word:?} in {message}");
    }
}

/// A paraboloid on a graded half-space, with lines of `[loading]`, then of `[numerics]` and `[output]`.
fn scene(grading: f64, loading: &str, rest: &str) -> String {
    format!(
        "[indenter.paraboloid]\nradius = \"10 mm\"\n[half_space]\ngrading = {grading}\nnormal_stiffness = 1e11\n\
         [friction.coulomb]\ncoefficient = 0.6\n[wear.archard]\ncoefficient = 1e-12\n\
         [loading]\nindentation = \"1 um\"\n{loading}\n{rest}\n"
    )
}

fn usual(rest: &str) -> String {
    scene(0.2, "stick_ratio = 0.6\ntau = 10", rest)
}

/// A run of about a second in very many steps, each saved.
fn long_scene() -> String {
    scene(
        0.2,
        "stick_ratio = 0.6\ncycles = 8000",
        "[numerics]\nstepper = \"every-cycle\"\nsprings = 48\ncheckpoint_interval = 0.01\n[output]\nsnapshots = 12",
    )
}

fn folder_with(scene: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("scene.toml"), scene).expect("the scene");
    folder
}

fn run_file(scene: &str) -> (Value, RunFile) {
    let folder = folder_with(scene);
    let json = object(folder.path(), &["run", "scene.toml", "--json"]);
    (json, RunFile::open(&folder.path().join("scene.h5")).expect("a run"))
}

fn close(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!(
        (found - expected).abs() <= tolerance * expected.abs(),
        "{what}: {found:e}, expected {expected:e}"
    );
}

fn values(snapshot: &Snapshot) -> impl Iterator<Item = &f64> {
    let curves = [&snapshot.profile, &snapshot.wear_depth, &snapshot.pressure, &snapshot.slip];
    let numbers = [
        &snapshot.cycles,
        &snapshot.tau,
        &snapshot.wear_volume,
        &snapshot.contact_radius,
        &snapshot.stick_radius,
        &snapshot.indentation,
        &snapshot.normal_force,
        &snapshot.dissipated_energy,
    ];
    curves.into_iter().flatten().chain(numbers)
}

fn bits(snapshots: &[Snapshot]) -> Vec<u64> {
    snapshots.iter().flat_map(values).map(|value| value.to_bits()).collect()
}

/// The same numbers bit for bit, but for the wall time.
fn assert_same_run(found: &RunFile, expected: &RunFile, what: &str) {
    assert_eq!(bits(&found.snapshots), bits(&expected.snapshots), "{what}: snapshots");
    let (mut found, mut expected) = (found.clone(), expected.clone());
    for file in [&mut found, &mut expected] {
        file.checkpoint.as_mut().expect("a checkpoint").wall_seconds = 0.0;
    }
    assert!(found == expected, "{what}");
}

#[test]
fn the_scenes_that_come_along_give_the_keys_and_curves_promised() {
    for name in SCENES {
        let path =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes").join(name).with_extension("toml");
        let folder = tempfile::tempdir().unwrap();
        let json = object(folder.path(), &["run", path.to_str().unwrap(), "--json"]);
        let mut keys: Vec<&str> = json.as_object().unwrap().keys().map(String::as_str).collect();
        let mut expected = RUN_KEYS;
        keys.sort_unstable();
        expected.sort_unstable();
        assert_eq!(keys, expected, "{name}");
        let output = format!("{name}.h5");
        assert_eq!(names(folder.path()), [output.as_str()], "{name}");
        assert_eq!(json["output"], output.as_str());

        let file = RunFile::open(&folder.path().join(output)).unwrap();
        let scene = Scene::from_path(&path).unwrap();
        let contact = scene.contact().unwrap();
        let shape = LimitingShape::from_contact(&contact).unwrap().unwrap();
        assert!(file.complete);
        assert_eq!(file.header.scene, fs::read_to_string(&path).unwrap());
        assert_eq!(file.stop_reason.name(), json["stop_reason"].as_str().unwrap());
        check_curves(name, &file, &shape, contact.stick_radius().unwrap());
        let last = file.snapshots.last().unwrap();
        for (key, value) in [
            ("cycles", last.cycles),
            ("tau", last.tau),
            ("normal_force", last.normal_force),
            ("contact_radius", last.contact_radius),
            ("wear_volume", last.wear_volume),
            ("dissipated_energy", last.dissipated_energy),
            ("wear_volume_limit", shape.wear_volume()),
        ] {
            assert_eq!(json[key].as_f64().unwrap(), value, "{name}: {key}");
        }
        let (by_volume, limit) = (last.wear_volume, shape.wear_volume());
        let by_energy = last.dissipated_energy * contact.wear().coefficient / contact.friction().coefficient;
        let estimate = json["error_estimate"].as_f64().unwrap();
        // Measured: 1.2e-5 to 5e-5 by the companion, 2e-4 at most by the energy; the accuracy asked for is the default.
        assert!(estimate > 0.0 && estimate < ACCURACY, "{name}: {estimate:e}");
        let balance = (by_energy - by_volume).abs() / limit;
        assert!(balance < 1e-3, "{name}: {balance:e}");
        assert!(json["limit_distance_relative"].as_f64().unwrap() < 1e-3, "{name}");
    }
}

/// The default.
const ACCURACY: f64 = 1e-4;

fn check_curves(name: &str, file: &RunFile, shape: &LimitingShape, stick_radius: f64) {
    let limit = file.header.limit.as_ref().expect("a limit");
    let deepest = limit.wear_depth.iter().fold(0.0, |m: f64, w| m.max(*w));
    assert!(file.header.radius[0] > stick_radius, "{name}");
    assert!(file.header.radius.windows(2).all(|pair| pair[0] < pair[1]), "{name}");
    for (i, r) in file.header.radius.iter().enumerate() {
        assert!((limit.wear_depth[i] - shape.wear_depth(*r)).abs() < 1e-6 * deepest, "{name}: r = {r}");
        close(limit.profile[i], shape.profile(*r), 1e-6, name);
    }
    let first = &file.snapshots[0];
    assert_eq!((first.cycles, first.tau, first.wear_volume, first.dissipated_energy), (0.0, 0.0, 0.0, 0.0));
    assert!(first.wear_depth.iter().all(|depth| depth.to_bits() == 0), "{name}");
    for snapshot in &file.snapshots {
        assert!(values(snapshot).all(|value| value.is_finite()), "{name}: cycle {}", snapshot.cycles);
        assert!(snapshot.contact_radius <= shape.contact_radius_limit() * (1.0 + 1e-12), "{name}");
        close(snapshot.stick_radius, stick_radius, 0.0, name);
        let largest = snapshot.pressure.iter().fold(0.0, |m: f64, p| m.max(*p));
        let highest_ever = first.pressure.iter().fold(largest, |m: f64, p| m.max(*p));
        for (i, r) in file.header.radius.iter().enumerate() {
            assert!(snapshot.wear_depth[i] >= 0.0, "{name}: r = {r}");
            assert!(snapshot.wear_depth[i] <= limit.wear_depth[i] + ACCURACY * deepest, "{name}: r = {r}");
            assert!(snapshot.pressure[i] > -1e-3 * highest_ever, "{name}: r = {r}");
            assert!(snapshot.slip[i] >= 0.0, "{name}: r = {r}");
            let outside = *r > snapshot.contact_radius;
            assert!(!outside || (snapshot.pressure[i] == 0.0 && snapshot.slip[i] == 0.0), "{name}: r = {r}");
        }
    }
    for pair in file.snapshots.windows(2) {
        let [before, now] = pair else { unreachable!() };
        assert!(now.cycles > before.cycles, "{name}");
        assert!(now.normal_force < before.normal_force, "{name}");
        assert!(now.contact_radius > before.contact_radius, "{name}");
        assert!(now.wear_volume > before.wear_volume, "{name}");
        let regain = now.wear_depth.iter().zip(&before.wear_depth).all(|(n, b)| *n >= b - ACCURACY * deepest);
        assert!(regain, "{name}: wear depth decreases before cycle {}", now.cycles);
    }
}

#[test]
fn snapshots_are_taken_exactly_where_the_scene_asks() {
    let (_, file) = run_file(&usual("[output]\nat_tau = [0.1, 1, 3]"));
    let taus: Vec<f64> = file.snapshots.iter().map(|it| it.tau).collect();
    assert_eq!(taus.len(), 5, "{taus:?}");
    for (found, expected) in taus.iter().zip([0.0, 0.1, 1.0, 3.0, 10.0]) {
        close(*found, expected, 4e-16, "τ");
    }
    let asked = "[output]\nat_cycles = [0.5, 10, 1234.5]";
    for stepper in ["implicit", "cycle-jump"] {
        let numerics = format!("[numerics]\nstepper = \"{stepper}\"\nsprings = 30\n{asked}");
        let (_, file) = run_file(&scene(0.2, "stick_ratio = 0.6\ncycles = 2000.25", &numerics));
        let cycles: Vec<f64> = file.snapshots.iter().map(|it| it.cycles).collect();
        assert_eq!(cycles, [0.0, 0.5, 10.0, 1234.5, 2000.25], "{stepper}");
    }
    let numerics =
        "[numerics]\nstepper = \"every-cycle\"\nsprings = 30\n[output]\nat_cycles = [10.4, 1234.6]";
    let text = scene(0.2, "stick_ratio = 0.6\ncycles = 2000.25", numerics);
    let (_, file) = run_file(&text);
    let per_cycle = Scene::from_toml(&text, "scene").unwrap().contact().unwrap().tau_per_cycle();
    let found: Vec<(f64, f64)> = file.snapshots.iter().map(|it| (it.cycles, it.tau)).collect();
    assert_eq!(found, [0.0, 10.0, 1235.0, 2000.0].map(|n| (n, n * per_cycle)));
}

#[test]
fn a_run_until_a_rate_ends_there() {
    let text = scene(0.2, "stick_ratio = 0.6\nuntil_rate = 0.01", "");
    let (json, file) = run_file(&text);
    assert_eq!(json["stop_reason"], "rate");
    assert_eq!(file.stop_reason, StopReason::Rate);
    assert!(file.complete);
}

#[test]
fn accuracies_springs_tolerances_and_steppers_agree() {
    let distance = |rest: &str| run_file(&usual(rest)).0["wear_volume"].as_f64().unwrap();
    let best = distance("[numerics]\naccuracy = 1e-5");
    for (rest, tolerance) in [
        ("", 1e-4),
        ("[numerics]\naccuracy = 1e-3", 2e-3),
        ("[numerics]\nsprings = 120\ntolerance = 1e-5", 1e-4),
        ("[numerics]\nstepper = \"cycle-jump\"\nsprings = 120", 1e-3),
        ("[numerics]\nstepper = \"every-cycle\"\nsprings = 48", 2e-3),
    ] {
        close(distance(rest), best, tolerance, rest);
    }
}

/// A generator of pseudo-random numbers in [0, 1).
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 53) as f64
}

fn signal(child: &Child, name: &str) {
    // A process that has ended by itself is no failure of the test.
    let _ = Command::new("kill").args(["-s", name, &child.id().to_string()]).output();
}

#[test]
fn an_interrupted_run_resumes_to_the_same_bits() {
    let whole = folder_with(&long_scene());
    let start = std::time::Instant::now();
    object(whole.path(), &["run", "scene.toml", "--json"]);
    let full = start.elapsed().as_secs_f64();
    let expected = RunFile::open(&whole.path().join("scene.h5")).unwrap();
    let mut seed = 20;
    let mut interruptions = 0;
    let names = ["KILL", "TERM", "INT", "USR1", "KILL", "TERM", "KILL", "TERM", "KILL", "TERM"];
    // Every signal once, and on until ten have hit: how many miss depends on what else the machine does.
    for (round, name) in names.into_iter().cycle().take(6 * names.len()).enumerate() {
        if round >= names.len() && interruptions >= 10 {
            break;
        }
        let folder = folder_with(&long_scene());
        let output = folder.path().join("scene.h5");
        for attempt in 0.. {
            let resume = output.exists();
            let arguments: &[&str] =
                if resume { &["run", "--resume", "scene.h5"] } else { &["run", "scene.toml"] };
            let mut command = program(folder.path(), arguments);
            let mut child =
                command.arg("--quiet").stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
            // The second half of the attempts runs through, so that every round ends.
            if attempt < 3 {
                std::thread::sleep(Duration::from_secs_f64(0.8 * full * random(&mut seed)));
                signal(&child, name);
            }
            let status = child.wait().unwrap();
            let mut message = String::new();
            child.stderr.take().unwrap().read_to_string(&mut message).unwrap();
            if status.success() {
                break;
            }
            interruptions += 1;
            // A signal before the handlers are in place ends the program as it ends any other.
            match status.code() {
                Some(code) => {
                    assert_eq!(code, 75, "{name}: {message}");
                    let file = RunFile::open(&output).unwrap();
                    assert!(!file.complete && file.stop_reason == StopReason::Interrupted);
                }
                None => assert!(name == "KILL" || attempt < 3, "{name}: {message}"),
            }
        }
        assert_same_run(&RunFile::open(&output).unwrap(), &expected, &format!("round {round}, SIG{name}"));
        assert_eq!(self::names(folder.path()), ["scene.h5", "scene.toml"], "SIG{name}");
    }
    assert!(interruptions >= 10, "only {interruptions} interruptions");
}

#[test]
fn resuming_a_complete_file_changes_nothing() {
    let folder = folder_with(&usual(""));
    let first = object(folder.path(), &["run", "scene.toml", "--json"]);
    let path = folder.path().join("scene.h5");
    let before = fs::read(&path).unwrap();
    let output = run(folder.path(), &["run", "--resume", "scene.h5", "--json"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&output.stderr).contains("complete"), "{}", text(&output.stderr));
    assert_eq!(serde_json::from_slice::<Value>(&output.stdout).unwrap(), first);
    assert_eq!(fs::read(&path).unwrap(), before);
}

#[test]
fn a_run_killed_before_its_first_checkpoint_leaves_nothing_in_the_way() {
    let text = long_scene().replace("checkpoint_interval = 0.01", "checkpoint_interval = \"1 h\"");
    let folder = folder_with(&text.replace("cycles = 8000", "cycles = 1e7"));
    let mut child = program(folder.path(), &["run", "scene.toml", "--quiet"]).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(300));
    signal(&child, "KILL");
    assert!(!child.wait().unwrap().success());
    assert_eq!(names(folder.path()), ["scene.toml"]);
    fs::write(folder.path().join("scene.toml"), usual("")).unwrap();
    object(folder.path(), &["run", "scene.toml", "--json"]);
    assert_eq!(names(folder.path()), ["scene.h5", "scene.toml"]);
}

#[test]
fn outputs_that_cannot_be_written_are_refused_before_the_run() {
    let folder = folder_with(&usual(""));
    let at = folder.path();
    fs::write(at.join("scene.h5"), "mine").unwrap();
    refused(at, &["run", "scene.toml", "--json"], 2, &["scene.h5", "exists", "--force"]);
    assert_eq!(fs::read(at.join("scene.h5")).unwrap(), b"mine");
    refused(at, &["run", "scene.toml", "-o", "none/x.h5"], 2, &["none", "create its directory"]);
    refused(at, &["run", "scene.toml", "-o", "."], 2, &["directory"]);
    refused(at, &["run", "scene.toml", "-o", "scene.toml/x.h5"], 2, &["scene.toml/x.h5"]);
    refused(at, &["run", "absent.toml"], 2, &["absent.toml", "no such file"]);
    refused(at, &["run", "scene.toml", "--resume", "scene.h5"], 2, &["cannot be used with"]);
    refused(at, &["run"], 2, &["SCENE.toml"]);
    assert_eq!(names(at), ["scene.h5", "scene.toml"]);
    // Nobody named it, and it is none of this program's.
    refused(at, &["run", "scene.toml", "--json", "--force"], 2, &["scene.h5", "not written by fretwear"]);
    assert_eq!(fs::read(at.join("scene.h5")).unwrap(), b"mine");
    object(at, &["run", "scene.toml", "-o", "scene.h5", "--json", "--force"]);
    object(at, &["run", "scene.toml", "--json", "--force"]);
    assert!(RunFile::open(&at.join("scene.h5")).unwrap().complete);
}

#[test]
fn scenes_that_cannot_be_simulated_are_refused_with_the_key_the_value_and_the_cure() {
    let with = |amplitude: &str| scene(0.2, &format!("{amplitude}\ntau = 10"), "");
    let springs = |count: &str| usual(&format!("[numerics]\nsprings = {count}"));
    for (text, words) in [
        (with("amplitude = 0"), ["loading.amplitude", "stuck", "ask for more"]),
        (with("stick_ratio = 1"), ["loading.stick_ratio", "stuck", "ask for more"]),
        (springs("10000000"), ["numerics.springs", "120.0 GB", "ask for at most"]),
        (springs("9223372036854775807"), ["numerics.springs", "GB", "ask for at most"]),
        (springs("5"), ["numerics.springs", "5", "outside [8, inf)"]),
    ] {
        let folder = folder_with(&text);
        refused(folder.path(), &["run", "scene.toml", "--json"], 2, &words);
        assert_eq!(names(folder.path()), ["scene.toml"]);
    }
}

#[test]
fn springs_whose_matrices_are_dense_are_refused_where_there_is_no_memory_for_those() {
    let numerics = "[numerics]\nsprings = 100000";
    let slides = scene(0.2, "amplitude = \"1 mm\"\ntau = 1", numerics);
    let held = scene(0.2, "amplitude = \"0.3 um\"\ntau = 1", numerics)
        .replace("indentation = \"1 um\"", "normal_force = 10");
    for text in [slides, held] {
        let folder = folder_with(&text);
        for command in ["check", "run"] {
            refused(
                folder.path(),
                &[command, "scene.toml", "--json"],
                2,
                &["numerics.springs", "400.0 GB", "at most"],
            );
        }
        assert_eq!(names(folder.path()), ["scene.toml"]);
    }
}

#[test]
fn a_cycle_that_wears_too_much_for_every_cycle_fails_the_run() {
    let numerics = "[numerics]\nstepper = \"every-cycle\"";
    let text = scene(0.2, "stick_ratio = 0.6\ncycles = 1000", numerics).replace("1e-12", "1e-9");
    let folder = folder_with(&text);
    refused(folder.path(), &["run", "scene.toml", "--json"], 1, &["every-cycle", "too coarse", "implicit"]);
}

#[test]
fn files_that_cannot_be_resumed_are_refused_and_left_alone() {
    let folder = folder_with(&usual(""));
    let at = folder.path();
    object(at, &["run", "scene.toml", "--json"]);
    let good = at.join("scene.h5");
    let edited = |name: &str, edit: &dyn Fn(&hdf5::File)| -> PathBuf {
        let path = at.join(name);
        fs::copy(&good, &path).unwrap();
        let file = hdf5::File::open_rw(&path).unwrap();
        edit(&file);
        file.close().unwrap();
        path
    };
    edited("nan.h5", &|file| {
        let compression = file.dataset("checkpoint/compression").unwrap();
        let mut values: Vec<f64> = compression.read_raw().unwrap();
        values[3] = f64::NAN;
        compression.write_raw(&values).unwrap();
    });
    edited("other_scene.h5", &|file| {
        let scene: hdf5::types::VarLenUnicode = usual("[numerics]\nsprings = 20").parse().unwrap();
        file.attr("scene").unwrap().write_scalar(&scene).unwrap();
    });
    edited("no_scene.h5", &|file| {
        let scene: hdf5::types::VarLenUnicode = "nothing".parse().unwrap();
        file.attr("scene").unwrap().write_scalar(&scene).unwrap();
    });
    edited("no_checkpoint.h5", &|file| file.unlink("checkpoint").unwrap());
    edited("foreign.h5", &|file| file.delete_attr("format").unwrap());
    fs::write(at.join("garbage.h5"), [7u8; 5000]).unwrap();
    let whole = fs::read(&good).unwrap();
    fs::write(at.join("half.h5"), &whole[..whole.len() / 2]).unwrap();
    for (name, word) in [
        ("nan.h5", "checkpoint"),
        ("other_scene.h5", "checkpoint"),
        ("no_scene.h5", "its scene"),
        ("no_checkpoint.h5", "checkpoint"),
        ("foreign.h5", "format"),
        ("garbage.h5", "not an HDF5 file"),
        ("half.h5", "damaged"),
        ("absent.h5", "absent.h5"),
    ] {
        let before = fs::read(at.join(name)).ok();
        refused(at, &["run", "--resume", name, "--json", "--unchecked"], 2, &[name, word]);
        let known = ["absent.h5", "garbage.h5"].contains(&name);
        let checked = if known { word } else { "no checksum" };
        refused(at, &["run", "--resume", name, "--json"], 2, &[name, checked]);
        assert_eq!(fs::read(at.join(name)).ok(), before, "{name}");
    }
}

#[test]
fn extreme_scenes_end_with_finite_numbers() {
    let tau = |amplitude: &str| format!("{amplitude}\ntau = 30");
    let base = scene(0.2, &tau("stick_ratio = 0.6"), "");
    let mut scenes: Vec<(String, String)> = [0.99, -0.99, 0.9999, -0.9999]
        .map(|k| (format!("grading {k}"), scene(k, &tau("stick_ratio = 0.6"), "")))
        .into();
    for amplitude in ["amplitude_ratio = 1e-10", "stick_ratio = 0.001", "stick_ratio = 0.9999999"] {
        scenes.push((amplitude.into(), scene(0.2, &tau(amplitude), "")));
    }
    for (from, to) in [
        ("radius = \"10 mm\"", "radius = \"10 nm\""),
        ("radius = \"10 mm\"", "radius = \"10 km\""),
        ("= 1e11", "= 1e-10"),
        ("= 1e11", "= 1e20"),
        ("tau = 30", "cycles = 1e12"),
        ("tau = 30", "tau = 1e6"),
        ("tau = 30", "cycles = 1e-6"),
    ] {
        scenes.push((to.into(), base.replace(from, to)));
    }
    for (name, text) in scenes {
        let (json, file) = run_file(&text);
        assert!(file.snapshots.iter().flat_map(values).all(|value| value.is_finite()), "{name}");
        let known = |key: &&str| json[key].is_number() || json[key].is_boolean();
        assert!(RUN_KEYS[4..].iter().all(known), "{name}: {json}");
        let distance = json["limit_distance_relative"].as_f64().unwrap();
        assert!((0.0..=1.0).contains(&distance), "{name}: {distance}");
        let part = json["wear_volume"].as_f64().unwrap() / json["wear_volume_limit"].as_f64().unwrap();
        assert!((0.0..1.0 + 1e-3).contains(&part), "{name}: {part}");
    }
}

#[test]
fn reading_needs_no_lock_on_the_file() {
    let folder = folder_with(&usual(""));
    object(folder.path(), &["run", "scene.toml", "--json"]);
    let path = folder.path().join("scene.h5");
    let locked = fs::File::open(&path).unwrap();
    locked.lock().unwrap();
    assert!(RunFile::open(&path).unwrap().complete);
    locked.unlock().unwrap();
}
