//! What sweeps gain by threads and by shared operators, and what checkpoints cost: `cargo bench --bench sweep`, figures in docs/hpc.md.
//!
//! Ratios of times measured alternately in one run, median of several rounds.

use std::path::{Path, PathBuf};
use std::time::Instant;

use fretwear::run::{Shared, Simulation};
use fretwear::scene::Study;
use fretwear::study::sweep::{SweepOptions, sweep};
use tempfile::TempDir;

const BASE: &str = include_str!("../data/scenes/paraboloid.toml");
const ROUNDS: usize = 5;

/// Scenes of accuracy 1e-3 that differ in the wear coefficient, by so little that each costs the same.
fn study(folder: &Path, scenes: usize) -> Study {
    let base = folder.join("base.toml");
    std::fs::write(&base, format!("{BASE}\n[numerics]\naccuracy = 1e-3\n")).expect("writable");
    let text = format!(
        "scene = \"base.toml\"\n[[axes]]\nkey = \"wear.archard.coefficient\"\nfrom = \"1e-8 1/MPa\"\nto = \"1.001e-8 1/MPa\"\ncount = {scenes}\n"
    );
    let path = folder.join("study.toml");
    std::fs::write(&path, text).expect("writable");
    Study::read(&path).expect("valid")
}

fn seconds(action: impl FnOnce()) -> f64 {
    let start = Instant::now();
    action();
    start.elapsed().as_secs_f64()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Prints the medians of two ways and of their ratio, round by round.
fn compare(name: &str, rounds: usize, mut one: impl FnMut() -> f64, mut other: impl FnMut() -> f64) {
    let pairs: Vec<(f64, f64)> = (0..rounds).map(|_| (one(), other())).collect();
    let of = |value: fn(&(f64, f64)) -> f64| median(pairs.iter().map(value).collect());
    println!("{name}: {:.3} s and {:.3} s, ratio {:.3}", of(|it| it.0), of(|it| it.1), of(|it| it.0 / it.1));
}

fn main() {
    let place: TempDir = tempfile::tempdir().expect("a temporary folder");
    let mut number = 0;
    let mut output = || -> PathBuf {
        number += 1;
        place.path().join(format!("out{number}"))
    };

    let equal = study(place.path(), 1000);
    let mut timed = |study: &Study, threads: usize, checkpoint_interval: f64| {
        let options = SweepOptions { threads: Some(threads), checkpoint_interval, ..SweepOptions::default() };
        let folder = output();
        seconds(|| {
            sweep(study, &folder, &options, None).expect("a sweep");
        })
    };
    // The closures take turns.
    let timed = std::cell::RefCell::new(&mut timed);
    let run = |study: &Study, threads: usize, interval: f64| (timed.borrow_mut())(study, threads, interval);
    compare(
        "1,000 equal scenes on one thread and on two",
        3,
        || run(&equal, 1, 30.0),
        || run(&equal, 2, 30.0),
    );
    let some = study(place.path(), 200);
    for interval in [1.0, 0.1] {
        compare(
            &format!("200 scenes with a checkpoint each {interval} s and without"),
            ROUNDS,
            || run(&some, 2, interval),
            || run(&some, 2, 1e9),
        );
    }

    let scenes: Vec<_> = (0..100).map(|scene| some.scene(scene).expect("valid")).collect();
    let all = |shared: &dyn Fn() -> Shared, common: bool| {
        let one = shared();
        seconds(|| {
            for scene in &scenes {
                let own = shared();
                let run = Simulation::sharing(scene, if common { &one } else { &own }).expect("a run");
                run.run().expect("reaches its end");
            }
        })
    };
    compare(
        "100 scenes with operators of their own and with shared ones",
        ROUNDS,
        || all(&Shared::default, false),
        || all(&Shared::default, true),
    );
}
