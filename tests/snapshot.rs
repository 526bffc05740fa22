//! The file of a run: what is written comes back, other programs can read it, and a crash loses nothing.

mod support;

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::str::FromStr;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use fretwear::contact::stick_slip::Regime;
use fretwear::data::quantity::quantity;
use fretwear::data::{
    Attempt, Checkpoint, Dataset, Fineness, Format, LimitCurves, ResultPath, ResultTables, RunFile,
    RunHeader, RunWriter, Snapshot, StopReason, SweepFile, SweepHeader, Values, Variable, Words, column,
};
use fretwear::laws::motion::RecordedPath;
use fretwear::solver::model::{Linearised, Past, PastPoint, State, StickEdge, WornGround};
use fretwear::solver::simulation::Progress;
use hdf5::types::VarLenUnicode;
use support::command::names;

/// Values that a careless conversion would change.
const AWKWARD: [f64; 9] =
    [-0.0, 0.0, f64::MIN_POSITIVE / 3.0, 5e-324, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 0.1];

/// A NaN that is not the usual one: negative, signalling, with a payload.
const OTHER_NAN: u64 = 0xFFF0_0000_DEAD_BEEF;

fn awkward(seed: usize) -> f64 {
    if seed % 10 == 9 { f64::from_bits(OTHER_NAN) } else { AWKWARD[seed % 10] }
}

fn curve(nodes: usize, seed: usize) -> Vec<f64> {
    (0..nodes)
        .map(|node| if node % 3 == 0 { awkward(seed + node) } else { 1e-6 * (seed + node) as f64 })
        .collect()
}

fn header(nodes: usize) -> RunHeader {
    RunHeader {
        title: Some("Paraboloid, μ = 0.3".into()),
        scene: "[indenter.paraboloid]\nradius = \"10 mm\"\n".into(),
        radius: (0..nodes).map(|node| 1e-3 + 1e-5 * node as f64).collect(),
        limit: Some(LimitCurves { profile: curve(nodes, 1), wear_depth: curve(nodes, 2) }),
        table: None,
        path: Some(Arc::new(recorded_path())),
    }
}

/// Values that a path may have and a careless conversion would change.
fn recorded_path() -> RecordedPath {
    let x = vec![-0.0, 5e-324, 0.1, f64::MIN_POSITIVE / 3.0];
    RecordedPath::new("path, µm.csv", x, vec![1e-6, 0.0, -1e99, 2.0], vec![0.0, 1e-9, 0.1, -0.0])
        .expect("a path")
}

/// Points of a fretting loop.
const POINTS: usize = 5;

fn snapshot(nodes: usize, seed: usize) -> Snapshot {
    Snapshot {
        cycles: seed as f64,
        tau: awkward(seed),
        regime: Regime::ALL[seed % 3],
        wear_volume: awkward(seed + 1),
        contact_radius: awkward(seed + 2),
        stick_radius: awkward(seed + 3),
        permanent_stick_radius: awkward(seed + 9),
        indentation: awkward(seed + 4),
        normal_force: awkward(seed + 5),
        dissipated_energy: awkward(seed + 6),
        cycle_energy: awkward(seed + 7),
        tangential_force: awkward(seed + 8),
        energy_ratio: awkward(seed + 10),
        sliding_ratio: awkward(seed + 11),
        loop_displacement: curve(POINTS, seed + 6),
        loop_force: curve(POINTS, seed + 4),
        loop_displacement_y: curve(POINTS, seed + 7),
        loop_force_y: curve(POINTS, seed + 8),
        profile: curve(nodes, seed),
        wear_depth: curve(nodes, seed + 1),
        pressure: curve(nodes, seed + 2),
        slip: curve(nodes, seed + 3),
    }
}

fn past_point(seed: usize) -> Arc<PastPoint> {
    Arc::new(PastPoint {
        cycles: awkward(seed),
        slip_area: awkward(seed + 1),
        dissipated_energy: awkward(seed + 2),
        volume_by_rate: awkward(seed + 3),
        compression: curve(57, seed),
        log_slip: curve(58, seed + 1),
    })
}

fn checkpoint() -> Checkpoint {
    Checkpoint {
        state: State {
            compression: curve(57, 4),
            compression_rate: curve(57, 5),
            cycles: 1e5 / 3.0,
            slip_area: f64::from_bits(OTHER_NAN),
            slip_area_rate: -1e-300,
            dissipated_energy: -0.0,
            volume_by_rate: 1e-17 / 3.0,
            least_stick_radius: f64::INFINITY,
            resting_area: 1e-7 / 3.0,
            stick: Some(StickEdge {
                area: 1e-9 / 3.0,
                depth: -0.0,
                load: 5e-324,
                left_behind: curve(24, 6),
                places_at_rest: vec![0.1, 0.2, 0.25],
                raised_at_rest: vec![0.0, 0.01, 0.03],
                wear_depth: curve(31, 7),
                slip_compression: 1e-7 / 3.0,
                rates: [1e-300, -1e-17 / 3.0, 5e-324],
            }),
            ground: Some(Arc::new(WornGround::new(
                1e-7 / 3.0,
                vec![0.0, 0.1 / 3.0, 0.4],
                &[1e-8 / 3.0, 5e-324, 0.0],
            ))),
            past: Past {
                order: 3,
                points: (0..4).map(past_point).collect(),
                linearised: Some(Arc::new(Linearised {
                    cycles: 1e4 / 3.0,
                    slip_area: 3e-10,
                    gathered_slip_area: 2e-10,
                    step: 7e4,
                    compression: past_point(5).compression.clone(),
                })),
            },
        },
        progress: Progress {
            next_step: 5e-324,
            first_rate: 1e-15,
            busy_until: 0.7 / 3.0,
            averages_from: 0.1 / 3.0,
            rejected_at: 0.2 / 3.0,
            steps: u64::MAX,
            rejected_steps: 1 << 53 | 1,
            rate_evaluations: 3,
            resolved_work: 0,
            next_output: 0,
        },
        wall_seconds: 0.1,
        error_estimate: Some(f64::NAN),
        accuracy: Some(1e-4),
        attempt: Attempt {
            refinements: 2,
            fineness: Fineness { tolerance: 3e-5, substeps: 256 },
            ended_on: 57,
            ended_with: Fineness { tolerance: 1e-4, substeps: 0 },
            ended_within: 0.02,
            ended_volume: 3e-14,
            work: 3_000_000_000,
        },
    }
}

fn written(path: &Path, nodes: usize, times: usize) {
    let mut writer = RunWriter::create(path, header(nodes), false).expect("a new file");
    (0..times).for_each(|time| writer.push(snapshot(nodes, time)));
    writer.save(&checkpoint(), StopReason::End, true).expect("a save");
}

/// `Debug` tells -0.0 from 0.0, but not one NaN from another.
fn bits(snapshot: &Snapshot) -> Vec<u64> {
    let Snapshot {
        cycles,
        tau,
        regime,
        wear_volume,
        contact_radius,
        stick_radius,
        permanent_stick_radius,
        indentation,
        normal_force,
        dissipated_energy,
        cycle_energy,
        tangential_force,
        energy_ratio,
        sliding_ratio,
        loop_displacement,
        loop_force,
        loop_displacement_y,
        loop_force_y,
        profile,
        wear_depth,
        pressure,
        slip,
    } = snapshot;
    let scalars = [
        cycles,
        tau,
        wear_volume,
        contact_radius,
        stick_radius,
        permanent_stick_radius,
        indentation,
        normal_force,
        dissipated_energy,
        cycle_energy,
        tangential_force,
        energy_ratio,
        sliding_ratio,
    ];
    scalars
        .into_iter()
        .chain([loop_displacement, loop_force, loop_displacement_y, loop_force_y].into_iter().flatten())
        .chain([profile, wear_depth, pressure, slip].into_iter().flatten())
        .map(|it| it.to_bits())
        .chain([*regime as u64])
        .collect()
}

fn to_bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// Held while a file is open that is edited, and while a child is started, which would inherit HDF5's lock on the file.
static EDITING: Mutex<()> = Mutex::new(());

fn edit(path: &Path, change: impl FnOnce(&hdf5::File) -> hdf5::Result<()>) -> hdf5::Result<()> {
    let _guard = EDITING.lock().unwrap_or_else(PoisonError::into_inner);
    let file = hdf5::File::append(path)?;
    change(&file)?;
    file.close()
}

fn message(path: &Path) -> String {
    let _guard = EDITING.lock().unwrap_or_else(PoisonError::into_inner);
    RunFile::open(path).expect_err("this file must be refused").to_string()
}

/// The same of a file that was edited, and so has lost its checksum.
fn edited_message(path: &Path) -> String {
    let without = message(path);
    assert!(without.contains("has no checksum at its end"), "{without}");
    let _guard = EDITING.lock().unwrap_or_else(PoisonError::into_inner);
    RunFile::open(ResultPath::unchecked(path)).expect_err("this file must be refused").to_string()
}

#[test]
fn every_value_comes_back_bit_for_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.h5");
    written(&path, 31, 12);
    let run = RunFile::open(&path).expect("the file");
    assert_eq!(run.header.title, header(31).title);
    assert_eq!(run.header.scene, header(31).scene);
    assert_eq!(run.header.radius, header(31).radius);
    let (limit, expected) = (run.header.limit.expect("a limit"), header(31).limit.expect("a limit"));
    assert_eq!(to_bits(&limit.profile), to_bits(&expected.profile));
    assert_eq!(to_bits(&limit.wear_depth), to_bits(&expected.wear_depth));
    let (found, expected) = (run.header.path.expect("a path"), recorded_path());
    assert_eq!(found.source, expected.source);
    for (found, expected) in
        [(&found.x, &expected.x), (&found.y, &expected.y), (&found.indentation, &expected.indentation)]
    {
        assert_eq!(to_bits(found), to_bits(expected));
    }
    assert_eq!(run.snapshots.len(), 12);
    for (time, found) in run.snapshots.iter().enumerate() {
        assert_eq!(bits(found), bits(&snapshot(31, time)), "snapshot {time}");
    }
    let (found, expected) = (run.checkpoint.expect("a checkpoint"), checkpoint());
    assert_eq!(to_bits(&found.state.compression), to_bits(&expected.state.compression));
    assert_eq!(to_bits(&found.state.compression_rate), to_bits(&expected.state.compression_rate));
    let (stick, wanted) = (found.state.stick.as_ref().unwrap(), expected.state.stick.as_ref().unwrap());
    let scalars = |it: &StickEdge| to_bits(&[it.area, it.depth, it.load, it.rates[0], it.rates[1]]);
    assert_eq!(scalars(stick), scalars(wanted));
    assert_eq!(to_bits(&stick.left_behind), to_bits(&wanted.left_behind));
    assert_eq!(to_bits(&stick.wear_depth), to_bits(&wanted.wear_depth));
    assert_eq!(found.state.past.order, expected.state.past.order);
    let linearised = |it: &State| {
        let it = it.past.linearised.clone().unwrap();
        [to_bits(&[it.slip_area, it.gathered_slip_area, it.step]), to_bits(&it.compression)]
    };
    assert_eq!(linearised(&found.state), linearised(&expected.state));
    assert_eq!(found.state.past.points.len(), expected.state.past.points.len());
    for (point, wanted) in found.state.past.points.iter().zip(&expected.state.past.points) {
        let scalars =
            |it: &PastPoint| to_bits(&[it.cycles, it.slip_area, it.dissipated_energy, it.volume_by_rate]);
        assert_eq!(scalars(point), scalars(wanted));
        assert_eq!(to_bits(&point.compression), to_bits(&wanted.compression));
        assert_eq!(to_bits(&point.log_slip), to_bits(&wanted.log_slip));
    }
    assert_eq!(found.state.slip_area.to_bits(), OTHER_NAN);
    assert_eq!(found.error_estimate.map(f64::to_bits), expected.error_estimate.map(f64::to_bits));
    assert_eq!((found.accuracy, found.accuracy_met()), (expected.accuracy, Some(false)));
    // `Debug` prints the shortest decimal that gives the same number, and the sign of zero.
    assert_eq!(format!("{found:?}"), format!("{expected:?}"));
    assert_eq!((run.stop_reason, run.complete), (StopReason::End, true));
    assert_eq!(run.program_version, env!("CARGO_PKG_VERSION"));
}

#[test]
fn what_a_run_may_lack_comes_back_as_lacking() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.h5");
    let bare = RunHeader { radius: vec![1e-3], ..RunHeader::default() };
    let mut writer = RunWriter::create(&path, bare.clone(), false).expect("a new file");
    for reason in [
        StopReason::End,
        StopReason::Rate,
        StopReason::Interrupted,
        StopReason::WornOut,
        StopReason::Unending,
    ] {
        writer.save(&Checkpoint::default(), reason, false).expect("a save");
        let run = RunFile::open(&path).expect("the file");
        assert_eq!((&run.header, run.stop_reason, run.complete), (&bare, reason, false));
        assert_eq!((run.snapshots.len(), run.checkpoint), (0, Some(Checkpoint::default())));
    }
    edit(&path, |file| file.unlink("checkpoint")).expect("an edit");
    assert_eq!(RunFile::open(ResultPath::unchecked(&path)).expect("the file").checkpoint, None);
}

#[test]
fn a_scene_of_any_length_is_stored() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.h5");
    let scene = "# Tabelle: r, f in µm\n".repeat(10_000);
    let header = RunHeader { scene: scene.clone(), ..header(3) };
    RunWriter::create(&path, header, false)
        .and_then(|mut writer| writer.save(&checkpoint(), StopReason::End, true))
        .expect("a save");
    assert_eq!(RunFile::open(&path).expect("the file").header.scene, scene);
}

#[test]
fn a_resumed_run_goes_on_after_its_snapshots() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.h5");
    written(&path, 5, 3);
    let mut writer = RunFile::open(&path).expect("the file").into_writer(&path).expect("a writer");
    writer.push(snapshot(5, 3));
    writer.save(&checkpoint(), StopReason::Rate, true).expect("a save");
    let run = RunFile::open(&path).expect("the file");
    assert_eq!(run.stop_reason, StopReason::Rate);
    let found: Vec<_> = run.snapshots.iter().map(bits).collect();
    let expected: Vec<_> = (0..4).map(|time| bits(&snapshot(5, time))).collect();
    assert_eq!(found, expected);
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let [first, second] = ["a.h5", "b.h5"].map(|name| folder.path().join(name));
    written(&first, 31, 12);
    std::thread::sleep(Duration::from_millis(1100));
    written(&second, 31, 12);
    assert_eq!(fs::read(first).expect("a file"), fs::read(second).expect("a file"));
}

#[test]
fn threads_write_their_files_side_by_side() {
    let folder = tempfile::tempdir().expect("a folder");
    std::thread::scope(|scope| {
        for thread in 1..=4 {
            let path = folder.path().join(format!("{thread}.h5"));
            scope.spawn(move || {
                for round in 0..10 {
                    let mut writer = RunWriter::create(&path, header(thread), round > 0).expect("a writer");
                    (0..thread).for_each(|time| writer.push(snapshot(thread, time)));
                    writer.save(&checkpoint(), StopReason::End, true).expect("a save");
                    assert_eq!(RunFile::open(&path).expect("the file").snapshots.len(), thread);
                }
            });
        }
    });
}

fn text(place: &hdf5::Location, name: &str) -> Option<String> {
    place.attr(name).ok()?.read_scalar::<VarLenUnicode>().ok().map(|text| text.to_string())
}

#[test]
fn every_dataset_has_units_a_meaning_and_its_scales() {
    unsafe extern "C" {
        fn H5DSis_attached(dataset: i64, scale: i64, axis: u32) -> i32;
        fn H5DSis_scale(dataset: i64) -> i32;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.h5");
    written(&path, 31, 12);
    let file = hdf5::File::open(&path).expect("the file");
    let time = &["time"][..];
    let both = &["time", "node"][..];
    let node = &["node"][..];
    let loops = &["time", "loops/point"][..];
    let expected = [
        ("cycles", time, None, "1"),
        ("tau", time, None, "1"),
        ("wear_volume", time, Some("cycles tau"), "m3"),
        ("contact_radius", time, Some("cycles tau"), "m"),
        ("stick_radius", time, Some("cycles tau"), "m"),
        ("permanent_stick_radius", time, Some("cycles tau"), "m"),
        ("indentation", time, Some("cycles tau"), "m"),
        ("normal_force", time, Some("cycles tau"), "N"),
        ("dissipated_energy", time, Some("cycles tau"), "J"),
        ("energy_ratio", time, Some("cycles tau"), "1"),
        ("sliding_ratio", time, Some("cycles tau"), "1"),
        ("regime", time, Some("cycles tau"), "1"),
        ("fretting_regime", time, Some("cycles tau"), "1"),
        ("radius", node, None, "m"),
        ("path_x", &["path_row"], None, "m"),
        ("path_y", &["path_row"], None, "m"),
        ("path_indentation", &["path_row"], None, "m"),
        ("limit_profile", node, Some("radius"), "m"),
        ("limit_wear_depth", node, Some("radius"), "m"),
        ("profile", both, Some("cycles tau radius"), "m"),
        ("wear_depth", both, Some("cycles tau radius"), "m"),
        ("pressure", both, Some("cycles tau radius"), "Pa"),
        ("slip", both, Some("cycles tau radius"), "m"),
        ("checkpoint/compression", &["checkpoint/spring"], None, "m"),
        ("loops/displacement", loops, Some("cycles tau"), "m"),
        ("loops/tangential_force", loops, Some("cycles tau"), "N"),
        ("loops/displacement_y", loops, Some("cycles tau"), "m"),
        ("loops/tangential_force_y", loops, Some("cycles tau"), "N"),
    ];
    for (name, axes, coordinates, units) in expected {
        let dataset = file.dataset(name).expect(name);
        assert_eq!(text(&dataset, "coordinates").as_deref(), coordinates, "coordinates of {name}");
        assert_eq!(text(&dataset, "units").as_deref(), Some(units), "units of {name}");
        assert_eq!(dataset.ndim(), axes.len(), "rank of {name}");
        assert_eq!(dataset.is_resizable(), axes[0] == "time", "resizable: {name}");
        for (axis, scale) in (0..).zip(axes) {
            let scale = file.dataset(scale).expect(scale);
            // SAFETY: both identifiers are open for the call, under the library's lock.
            let attached = hdf5::sync::sync(|| unsafe { H5DSis_attached(dataset.id(), scale.id(), axis) });
            assert_eq!(attached, 1, "scale of {name}, axis {axis}");
        }
    }
    for (name, length) in [("time", 12), ("node", 31), ("path_row", 4), ("checkpoint/spring", 57)] {
        let scale = file.dataset(name).expect(name);
        assert_eq!(scale.read_raw::<i64>().expect(name), (0..length).collect::<Vec<i64>>());
        // SAFETY: the identifier is open for the call, under the library's lock.
        assert_eq!(hdf5::sync::sync(|| unsafe { H5DSis_scale(scale.id()) }), 1, "{name} is a scale");
    }
    let group = file.group("checkpoint").expect("the group");
    let loops = file.group("loops").expect("the group");
    let in_groups = [group, loops].map(|it| it.datasets().expect("datasets")).concat();
    let all = [file.datasets().expect("datasets"), in_groups].concat();
    assert_eq!(all.len(), 24 + 4 + 33 + 5, "{all:?}");
    for dataset in all {
        for attribute in ["units", "long_name"] {
            let found = text(&dataset, attribute).unwrap_or_default();
            assert!(!found.is_empty(), "{attribute} of {}", dataset.name());
        }
    }
    let regime = file.dataset("regime").expect("the regime");
    let flags = regime.attr("flag_values").and_then(|it| it.read_raw::<i32>()).expect("numbers");
    assert_eq!(flags, [0, 1, 2]);
    assert_eq!(text(&regime, "flag_meanings").as_deref(), Some("stick partial-slip full-sliding"));
    assert_eq!(regime.read_raw::<i32>().expect("numbers")[..4], [0, 1, 2, 0]);
    assert_eq!(text(&file.dataset("path_x").expect("a path"), "source").as_deref(), Some("path, µm.csv"));
    assert_eq!(text(&file, "format").as_deref(), Some("fretwear-run"));
    assert_eq!(file.attr("format_version").and_then(|it| it.read_scalar::<i32>()).expect("a number"), 4);
    assert_eq!(file.attr("complete").and_then(|it| it.read_scalar::<i32>()).expect("a number"), 1);
}

#[test]
fn what_cannot_be_written_is_refused_before_the_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.h5");
    let refusal = |path: &Path, overwrite| {
        RunWriter::create(path, header(3), overwrite).expect_err("this path must be refused").to_string()
    };
    drop(RunWriter::create(&path, header(3), false).expect("a new file"));
    assert!(names(folder.path()).is_empty(), "nothing is created before the first save");
    fs::write(&path, "mine").expect("a file");
    assert!(
        refusal(&path, false).contains("exists already; choose another output"),
        "{}",
        refusal(&path, false)
    );
    drop(RunWriter::create(&path, header(3), true).expect("overwriting"));
    assert_eq!(
        fs::read_to_string(&path).expect("the file"),
        "mine",
        "nothing is overwritten before the first save"
    );
    for (path, overwrite, words) in [
        (folder.path().to_owned(), true, "is a directory"),
        (folder.path().join("none/run.h5"), false, "create its directory"),
        (path.join("run.h5"), false, "a part of the path is a file"),
        (folder.path().join("x".repeat(300)), false, "shorter name"),
        (PathBuf::from("/dev/null"), true, "not a regular file"),
    ] {
        let found = refusal(&path, overwrite);
        assert!(found.contains(words) && found.starts_with(&*path.to_string_lossy()), "{found}");
    }
    assert_eq!(names(folder.path()), ["run.h5"]);
}

#[test]
fn a_file_that_appears_during_the_run_is_not_overwritten() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.h5");
    let mut writer = RunWriter::create(&path, header(3), false).expect("a new file");
    fs::write(&path, "somebody else's").expect("a file");
    let found = writer.save(&checkpoint(), StopReason::End, true).expect_err("a refusal").to_string();
    assert!(found.contains("during the run"), "{found}");
    assert_eq!(fs::read_to_string(&path).expect("the file"), "somebody else's");
    assert_eq!(names(folder.path()), ["run.h5"]);
}

#[test]
fn a_failed_save_leaves_the_previous_one_and_no_litter() {
    let folder = tempfile::tempdir().expect("a folder");
    let inside = folder.path().join("inside");
    fs::create_dir(&inside).expect("a folder");
    let path = inside.join("run.h5");
    let mut writer = RunWriter::create(&path, header(3), false).expect("a new file");
    writer.save(&checkpoint(), StopReason::Interrupted, false).expect("a save");
    fs::rename(&inside, folder.path().join("moved")).expect("renaming");
    let found = writer.save(&checkpoint(), StopReason::End, true).expect_err("a refusal").to_string();
    assert!(found.contains("run.h5") && found.contains("directory"), "{found}");
    assert_eq!(names(&folder.path().join("moved")), ["run.h5"]);
    assert!(!RunFile::open(&folder.path().join("moved/run.h5")).expect("the file").complete);
}

#[test]
fn leftovers_of_killed_runs_are_removed_and_others_kept() {
    const OWN: &str =
        "This directory is fretwear's own. It holds what is not finished, and is removed by the program.\n";
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.h5");
    let put = |name: &str, marker: &str, others: &[&str]| {
        let inside = folder.path().join(name);
        fs::create_dir(&inside).expect("a folder");
        fs::write(inside.join("marker"), marker).expect("a file");
        others.iter().for_each(|name| fs::write(inside.join(name), "torn").expect("a file"));
        inside
    };
    let own = format!("{OWN}temporary of run.h5");
    put(".fretwear-killed", &own, &["content"]);
    put(".fretwear-killed-at-once", "", &[]);
    fs::create_dir(folder.path().join(".fretwear-empty")).expect("a folder");
    let busy = put(".fretwear-busy", &own, &["content"]);
    put(".fretwear-other", &format!("{OWN}temporary of other.h5"), &["content"]);
    put(".fretwear-users", "a folder of mine", &["content"]);
    put(".fretwear-more", &own, &["content", "thesis.txt"]);
    // As an earlier version called them: nothing in them tells whose they are.
    fs::write(folder.path().join(".run.h5.1.tmp"), "torn").expect("a file");
    let lock = fs::File::open(busy.join("marker")).expect("a file");
    lock.lock().expect("a lock");
    written(&path, 3, 1);
    let mut found = names(folder.path());
    found.sort();
    let kept =
        [".fretwear-busy", ".fretwear-more", ".fretwear-other", ".fretwear-users", ".run.h5.1.tmp", "run.h5"];
    assert_eq!(found, kept);
    let mut more = names(&folder.path().join(".fretwear-more"));
    more.sort();
    assert_eq!(more, ["marker", "thesis.txt"], "a directory with anything else in it stays");
    assert_eq!(names(&folder.path().join(".fretwear-users")).len(), 2);
}

#[cfg(unix)]
#[test]
fn a_link_stays_a_link_to_the_new_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let [link, target] = ["link.h5", "target.h5"].map(|name| folder.path().join(name));
    fs::write(&target, "old").expect("a file");
    std::os::unix::fs::symlink(&target, &link).expect("a link");
    let mut writer = RunWriter::create(&link, header(3), true).expect("a writer");
    writer.save(&checkpoint(), StopReason::End, true).expect("a save");
    assert!(fs::symlink_metadata(&link).expect("the link").is_symlink());
    assert!(RunFile::open(&target).expect("the file").complete);
}

#[test]
fn foreign_and_damaged_files_are_refused_with_a_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.h5");
    assert!(message(&path).contains("No such file"), "{}", message(&path));
    assert!(message(folder.path()).contains("is not a file"));
    fs::write(&path, "").expect("a file");
    assert!(message(&path).contains("is empty"));
    fs::write(&path, "radius,profile\n1,2\n").expect("a file");
    assert!(message(&path).contains("not an HDF5 file"));
    fs::remove_file(&path).expect("the file");
    edit(&path, |_| Ok(())).expect("a file");
    assert!(edited_message(&path).contains("no attribute format"), "{}", edited_message(&path));
    fs::remove_file(&path).expect("the file");

    written(&path, 31, 12);
    let bytes = fs::read(&path).expect("the file");
    for length in (9..bytes.len()).step_by(bytes.len() / 97) {
        fs::write(&path, &bytes[..length]).expect("a file");
        assert!(message(&path).contains("cut short"), "{length} bytes: {}", message(&path));
    }
}

#[test]
fn edited_files_are_refused_by_the_name_of_what_is_wrong() {
    fn replace<T: hdf5::H5Type>(file: &hdf5::File, name: &str, shape: &[usize]) -> hdf5::Result<()> {
        file.unlink(name)?;
        file.new_dataset::<T>().shape(shape).create(name).map(drop)
    }
    fn put_text(file: &hdf5::File, name: &str, text: &str) -> hdf5::Result<()> {
        file.delete_attr(name)?;
        let text = VarLenUnicode::from_str(text).map_err(|error| error.to_string())?;
        file.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&text)
    }
    fn put_integer(file: &hdf5::File, name: &str, value: i64) -> hdf5::Result<()> {
        file.delete_attr(name)?;
        file.new_attr::<i64>().create(name)?.write_scalar(&value)
    }
    type Edit = fn(&hdf5::File) -> hdf5::Result<()>;
    let edits: [(&str, Edit); 28] = [
        ("format_version 3, this program reads 4; use the fretwear", |file| {
            put_integer(file, "format_version", 3)
        }),
        ("attribute format_version", |file| put_text(file, "format_version", "4")),
        ("no attribute format", |file| put_text(file, "format", "netcdf")),
        ("attribute scene", |file| file.delete_attr("scene")),
        ("attribute scene: is not UTF-8 text", |file| put_integer(file, "scene", 1)),
        ("stop_reason = \"tired\" is not known", |file| put_text(file, "stop_reason", "tired")),
        ("attribute complete", |file| file.delete_attr("complete")),
        ("dataset /cycles is missing", |file| file.unlink("cycles")),
        ("dataset /slip is missing", |file| file.unlink("slip")),
        ("dataset /limit_wear_depth is missing", |file| file.unlink("limit_wear_depth")),
        ("dataset /checkpoint/next_step is missing", |file| file.unlink("checkpoint/next_step")),
        ("/tau: has the shape [11], expected [12]", |file| replace::<f64>(file, "tau", &[11])),
        ("/profile: has the shape [31, 12], expected [12, 31]", |file| {
            replace::<f64>(file, "profile", &[31, 12])
        }),
        ("/profile: has the shape [372], expected [12, 31]", |file| replace::<f64>(file, "profile", &[372])),
        ("/radius: has the shape []", |file| replace::<f64>(file, "radius", &[])),
        ("/radius: has no values", |file| replace::<f64>(file, "radius", &[0])),
        ("/pressure: does not hold values of type f64", |file| replace::<f32>(file, "pressure", &[12, 31])),
        ("/checkpoint/steps: does not hold values of type u64", |file| {
            replace::<f64>(file, "checkpoint/steps", &[])
        }),
        ("/regime: 3 is no regime", |file| file.dataset("regime")?.write_raw(&[3i32; 12])),
        ("/regime: -1 is no regime", |file| file.dataset("regime")?.write_raw(&[-1i32; 12])),
        ("dataset /regime is missing", |file| file.unlink("regime")),
        ("/loops/point: has the shape []", |file| replace::<i64>(file, "loops/point", &[])),
        ("dataset /loops/displacement_y is missing", |file| file.unlink("loops/displacement_y")),
        ("dataset /path_indentation is missing", |file| file.unlink("path_indentation")),
        ("/path_x: loading.path: all its rows are at the same x and y", |file| {
            file.dataset("path_x")?.write_raw(&[0.0; 4])?;
            file.dataset("path_y")?.write_raw(&[0.0; 4])
        }),
        ("/checkpoint: ", |file| replace::<f64>(file, "checkpoint", &[])),
        // Nothing was ever stored of these: reading them would fill the memory with zeros.
        ("/radius: claims the shape [1000000000000000]", |file| {
            file.unlink("radius")?;
            file.new_dataset::<f64>().chunk(1000).shape(1_000_000_000_000_000).create("radius").map(drop)
        }),
        ("/cycles: claims the shape [1000000000000000]", |file| {
            file.unlink("cycles")?;
            file.new_dataset::<f64>().chunk(1000).shape(1_000_000_000_000_000).create("cycles").map(drop)
        }),
    ];
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.h5");
    written(&path, 31, 12);
    let bytes = fs::read(&path).expect("the file");
    for (words, change) in edits {
        fs::write(&path, &bytes).expect("a file");
        edit(&path, change).unwrap_or_else(|error| panic!("{words}: {error}"));
        let found = edited_message(&path);
        assert!(
            found.contains(words) && found.starts_with(&*path.to_string_lossy()),
            "{found}\nlacks {words}"
        );
    }
}

#[test]
fn words_that_are_not_utf_8_are_read_with_a_sign_for_what_is_none() {
    const WORD: &str = "obeys";
    const READ: &str = "ob\u{fffd}ys";
    let folder = tempfile::tempdir().expect("a folder");
    // Words stand in the file as they are, without a checksum.
    let damage = |path: &Path| {
        let mut bytes = fs::read(path).expect("the file");
        let place = bytes.windows(WORD.len()).position(|it| it == WORD.as_bytes()).expect("the word");
        bytes[place + 2] = 0xff;
        fs::write(path, bytes).expect("a file");
        let _guard = EDITING.lock().unwrap_or_else(PoisonError::into_inner);
        let table = ResultTables::csv(ResultPath::unchecked(path), None).expect("a table");
        assert!(table.trim_end().ends_with(&format!(",{READ}")), "{table}");
    };

    let sweep = folder.path().join("sweep.h5");
    let verdict = quantity("verdict", "1", "a word");
    let words = || [WORD].into_iter().collect::<Words>();
    let column = column(verdict, words());
    let header = SweepHeader::default();
    SweepFile::new(header, true, vec![0], vec![column], vec![]).write(&sweep, false).expect("written");
    damage(&sweep);
    let column = SweepFile::read(ResultPath::unchecked(&sweep)).expect("readable").columns.remove(0);
    assert_eq!(column.values, Values::Texts([READ].into_iter().collect()));

    let study = folder.path().join("study.h5");
    let mut file = Dataset::of(Format::Universality, &[("title", String::new())]);
    file.coordinate(quantity("case", "1", "a number"), vec![0.0]);
    file.add(Variable::new(verdict, &[("case", 1)], words()));
    file.write(&study, false).expect("written");
    damage(&study);
    let stored = Dataset::read(ResultPath::unchecked(&study), Format::Universality).expect("readable");
    assert_eq!(stored.words("verdict", 1).expect("one").iter().collect::<Vec<_>>(), [READ]);
}

const SAVE_LOOP: &str = "FRETWEAR_TEST_SAVE_LOOP";

/// The child of the next test: goes on with the file that the variable names, and says how many snapshots are safe.
#[test]
fn save_for_ever_when_asked_to() {
    let Some(path) = std::env::var_os(SAVE_LOOP).map(PathBuf::from) else { return };
    let mut writer = match RunFile::open(&path) {
        Ok(run) => run.into_writer(&path).expect("a writer"),
        Err(_) => RunWriter::create(&path, header(50), false).expect("a new file"),
    };
    loop {
        let count = writer.snapshots().len();
        writer.push(snapshot(50, count));
        let mut checkpoint = checkpoint();
        checkpoint.progress.steps = count as u64 + 1;
        writer.save(&checkpoint, StopReason::Interrupted, false).expect("a save");
        println!("\nsafe: {}", count + 1);
    }
}

#[test]
fn a_run_killed_at_any_moment_loses_nothing_that_was_saved() {
    const ROUNDS: u64 = 30;
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run.h5");
    let mut safe = 0;
    for round in 0..ROUNDS {
        let mut command = Command::new(std::env::current_exe().expect("this test"));
        command.args(["--exact", "save_for_ever_when_asked_to", "--nocapture"]).env(SAVE_LOOP, &path);
        command.stdout(Stdio::piped()).stderr(Stdio::null());
        let guard = EDITING.lock().unwrap_or_else(PoisonError::into_inner);
        let mut child = command.spawn().expect("a child");
        drop(guard);
        let lines = BufReader::new(child.stdout.take().expect("its output")).lines();
        let mut reports =
            lines.map_while(Result::ok).filter_map(|line| line.strip_prefix("safe: ")?.parse().ok());
        safe = reports.next().expect("the first save of the child");
        // Spread over the few milliseconds that one save takes.
        std::thread::sleep(Duration::from_micros(1 + round * 7919 % 9000));
        child.kill().expect("killing");
        child.wait().expect("the end of the child");
        safe = reports.last().unwrap_or(safe);
        let run = RunFile::open(&path).unwrap_or_else(|error| panic!("round {round}: {error}"));
        let found = run.snapshots.len();
        assert!(found == safe || found == safe + 1, "round {round}: {safe} were safe, {found} are there");
        assert_eq!(
            run.checkpoint.expect("a checkpoint").progress.steps,
            found as u64,
            "of one and the same save"
        );
        for (time, it) in run.snapshots.iter().enumerate() {
            assert_eq!(bits(it), bits(&snapshot(50, time)), "round {round}, snapshot {time}");
        }
        assert!(names(folder.path()).len() <= 2, "litter grows: {:?}", names(folder.path()));
    }
    assert!(safe as u64 >= ROUNDS, "{safe}");
    drop(RunFile::open(&path).and_then(|run| run.into_writer(&path)).expect("a writer"));
    assert_eq!(names(folder.path()), ["run.h5"], "the next run clears the litter");
}
