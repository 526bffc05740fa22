//! The public face: a scene in memory, from wherever it comes, and what the root of the library names.

use std::fs;
use std::path::{Path, PathBuf};

use fretwear::run::{Run, Stop};
use fretwear::{Domain, Error, Results, RunFile, Scene, Simulation, StopReason};

const TEXT: &str = "[indenter.paraboloid]\nradius = \"10 mm\"\n[half_space]\ngrading = 0.0\nmodulus = 210e9\npoisson_ratio = 0.3\n\
                    [friction.coulomb]\ncoefficient = 0.6\n[wear.archard]\ncoefficient = \"1e-14 1/Pa\"\n[loading]\n\
                    initial_force = \"50 N\"\nstick_ratio = 0.7\ntau = 1.0\n[numerics]\naccuracy = 1e-3\n";

fn built() -> Scene {
    let scene = Scene::builder()
        .set("indenter.paraboloid.radius", "10 mm")
        .set("half_space.grading", 0.0)
        .set("half_space.modulus", 210e9)
        .set("half_space.poisson_ratio", 0.3)
        .set("friction.coulomb.coefficient", 0.6)
        .set("wear.archard.coefficient", "1e-14 1/Pa")
        .set("loading.initial_force", "50 N")
        .set("loading.stick_ratio", 0.7)
        .set("loading.tau", 1.0)
        .set("numerics.accuracy", 1e-3);
    scene.build().expect("a scene")
}

/// All numbers of the snapshots that differ between runs of different scenes, as bits.
fn bits(results: &Results) -> Vec<u64> {
    let series =
        [results.cycles(), results.worn_volume(), results.contact_radius(), results.dissipated_energy()];
    let curves = [results.profile(), results.pressure(), results.slip(), results.loop_force()];
    let curves = curves.iter().flatten().flat_map(|curve| curve.iter());
    series.iter().flatten().chain(curves).map(|value| value.to_bits()).collect()
}

#[test]
fn a_scene_from_a_file_from_text_and_key_by_key_gives_the_same_results_with_a_file_and_without() {
    let folder = tempfile::tempdir().expect("a folder");
    let [toml, saved, written] = ["a.toml", "saved.h5", "written.h5"].map(|name| folder.path().join(name));
    fs::write(&toml, TEXT).expect("a file");
    let scene: Scene = TEXT.parse().expect("a scene");
    let from_text = scene.simulate().expect("an end");
    let others = [Scene::from_path(&toml).expect("a scene"), built()];
    for other in others.map(|scene| scene.simulate().expect("an end")) {
        assert_eq!(bits(&other), bits(&from_text));
    }
    from_text.save(&saved).expect("a file");
    assert!(
        matches!(from_text.save(&saved), Err(error @ Error::Exists { .. }) if error.domain() == Domain::File)
    );
    let run = Run::new(&scene, &written, false, &Stop::default()).expect("a run");
    run.execute(None).expect("an end");
    let [saved, written] = [saved, written].map(|path| RunFile::open(&path).expect("a run"));
    assert_eq!(saved.header, written.header);
    assert_eq!(format!("{:?}", saved.snapshots), format!("{:?}", written.snapshots));
    assert_eq!(saved.checkpoint.expect("kept").state, written.checkpoint.expect("kept").state);
    assert_eq!(saved.snapshots.last().map(|it| it.wear_volume), from_text.worn_volume().last().copied());
    assert!(from_text.summary().contains("worn volume") && !from_text.summary().contains("written to"));
}

#[test]
fn a_callback_sees_every_snapshot_and_a_token_stops_the_run_at_the_next_step() {
    let (scene, mut seen) = (built(), vec![]);
    let whole = Simulation::new(&scene).expect("ready").on_snapshot(|it| seen.push(it.clone())).run();
    let whole = whole.expect("an end");
    // Where the ground has come to stick pressure is not a number, which equals nothing.
    assert_eq!(format!("{seen:?}"), format!("{:?}", whole.snapshots()));
    assert!(whole.is_complete() && whole.stop_reason() == StopReason::End);

    let (stop, mut count) = (Stop::default(), 0);
    let stopped = Simulation::new(&scene).expect("ready").stopped_by(&stop).on_snapshot(|_| {
        count += 1;
        if count == 5 {
            stop.stop();
        }
    });
    let stopped = stopped.run().expect("results so far");
    assert_eq!(stopped.stop_reason(), StopReason::Interrupted);
    // One step may pass several snapshots.
    let shown = stopped.snapshots().len();
    assert!(shown >= 5 && shown < whole.snapshots().len(), "{shown} of {}", whole.snapshots().len());
    assert_eq!(stopped.worn_volume()[..], whole.worn_volume()[..shown]);
}

#[test]
fn a_builder_refuses_a_key_below_a_value_and_what_is_no_scene() {
    let below = Scene::builder().set("loading", 1.0).set("loading.tau", 1.0).build().unwrap_err();
    assert!(below.to_string().starts_with("loading.tau: stands below"), "{below}");
    let unknown = Scene::builder().set("indenter.ball.radius", 1.0).build().unwrap_err();
    assert_eq!((unknown.domain(), unknown.exit_code()), (Domain::Scene, 2));
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("readable").path());
    let all = entries.flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] });
    all.filter(|path| path.extension().is_some_and(|it| it == "rs")).collect()
}

#[test]
fn the_root_names_at_most_eighty_things() {
    let text = include_str!("../src/lib.rs");
    let uses = text.split("\npub use ").skip(1).map(|rest| rest.split(';').next().expect("an end"));
    let names: Vec<&str> = uses
        .flat_map(|it| it.rsplit_once('{').map_or_else(|| it.rsplit("::").next(), |(_, list)| Some(list)))
        .flat_map(|list| list.trim_end_matches('}').split(','))
        .map(str::trim)
        .filter(|name| !name.is_empty())
        .collect();
    assert!((40..=80).contains(&names.len()), "{}: {names:?}", names.len());
}

#[test]
fn the_library_names_no_option_of_the_command_line_in_its_errors_and_neither_prints_nor_listens_to_signals() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let options = ["--force", "--unchecked", "--threads", "--shard", "--dry-run", "\"--"];
    for path in sources(&source) {
        let inside = path.strip_prefix(&source).expect("below src");
        // The program itself, the scripts of clusters, which call it, and a page of its documentation.
        if ["cli", "cli.rs", "main.rs", "study/submit", "scene/page.rs"]
            .iter()
            .any(|it| inside.starts_with(it))
        {
            continue;
        }
        let text = fs::read_to_string(&path).expect("readable");
        let code = text.split("#[cfg(test)]\nmod ").next().expect("a beginning");
        for (number, line) in code.lines().enumerate() {
            if line.trim_start().starts_with("//") {
                continue;
            }
            let printed = ["println!(", "eprintln!(", "signal_hook", "indicatif", "clap::"];
            let found = options.iter().chain(&printed).find(|word| line.contains(**word));
            assert!(found.is_none(), "{}:{}: {line}", inside.display(), number + 1);
        }
    }
}
