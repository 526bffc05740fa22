//! How time and memory of a whole run grow with the springs: `cargo bench --bench growth`, table in docs/growth.md.
//!
//! Each number of springs is a process of the program of its own, file included. The scene is the main one, cut short so that the largest are
//! bearable. Peak memory is the largest resident set of the process, which the operating system keeps.

mod support;

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use tempfile::TempDir;

const SCENE: &str = include_str!("../data/scenes/paraboloid.toml");
const TAU: f64 = 0.3;
const TOLERANCE: &str = "1e-3";
const SPRINGS: [usize; 7] = [50, 100, 200, 400, 800, 1600, 3200];

/// The number of springs for which a most is asked, and that, MB.
const JUDGED: (usize, f64) = (2000, 200.0);

/// Springs up to which the median of several runs is taken; beyond, one.
const MOST_REPEATED: usize = 400;
const REPEATS: usize = 5;

/// Number of springs from which on exponents are fitted: below, starting the process outweighs the rest.
const FITTED_FROM: usize = 400;

struct Cost {
    springs: usize,
    seconds: f64,
    processor_seconds: f64,
    steps: f64,
    megabytes: f64,
}

impl Cost {
    fn per_step(&self) -> f64 {
        self.processor_seconds / self.steps
    }
}

/// One process; time, accepted and rejected steps, peak memory.
#[expect(clippy::zombie_processes, reason = "wait4 waits for it, and tells what it used")]
fn measure(folder: &Path, springs: usize) -> Cost {
    let scene = folder.join("scene.toml");
    let text = SCENE.replace("cycles = 1e6", &format!("tau = {TAU}"));
    let tables =
        format!("[numerics]\nsprings = {springs}\ntolerance = {TOLERANCE}\n[output]\nat_tau = [0.01, 0.1]\n");
    std::fs::write(&scene, format!("{text}\n{tables}")).expect("writable");
    let begin = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_fretwear"))
        .args(["run", "--json", "--quiet", "--force", "-o"])
        .arg(folder.join("run.h5"))
        .arg(&scene)
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let stdout = child.stdout.take().expect("piped");
    let summary: serde_json::Value = serde_json::from_reader(stdout).expect("one object");
    let (processor_seconds, megabytes) = usage(child.id());
    let seconds = begin.elapsed().as_secs_f64();
    let count = |key: &str| summary[key].as_f64().expect("a number");
    Cost { springs, seconds, processor_seconds, steps: count("steps") + count("rejected_steps"), megabytes }
}

/// Waits for a child; its time on the processor, s, and its largest resident set, MB.
fn usage(pid: u32) -> (f64, f64) {
    // SAFETY: both are plain numbers, for which zero is a value, and they outlive the call that fills them.
    let (mut status, mut usage) = (0, unsafe { std::mem::zeroed::<libc::rusage>() });
    let pid = libc::pid_t::try_from(pid).expect("an id of a process");
    let waited = unsafe { libc::wait4(pid, &mut status, 0, &mut usage) };
    assert!(waited == pid && libc::WIFEXITED(status) && libc::WEXITSTATUS(status) == 0, "status {status}");
    // Linux counts it in units of 1024 bytes.
    let megabytes = usage.ru_maxrss as f64 * 1024.0 / 1e6;
    let seconds = |time: libc::timeval| time.tv_sec as f64 + 1e-6 * time.tv_usec as f64;
    (seconds(usage.ru_utime) + seconds(usage.ru_stime), megabytes)
}

/// The power of the springs with which a cost grows.
fn exponent(costs: &[Cost], value: fn(&Cost) -> f64) -> f64 {
    let fitted = costs.iter().filter(|cost| cost.springs >= FITTED_FROM);
    support::exponent(fitted.map(|cost| (cost.springs as f64, value(cost))))
}

fn main() {
    let folder = TempDir::new().expect("a temporary folder");
    let typical = |springs| {
        let repeats = if springs <= MOST_REPEATED { REPEATS } else { 1 };
        let mut costs: Vec<Cost> = (0..repeats).map(|_| measure(folder.path(), springs)).collect();
        costs.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        costs.swap_remove(repeats / 2)
    };
    println!("Main scene to τ = {TAU}, tolerance {TOLERANCE}.\n");
    println!(
        "| springs | wall s | processor s | steps | processor s per step | peak MB | n² numbers of 8 bytes, MB |\n|---|---|---|---|---|---|---|"
    );
    let show = |cost: &Cost| {
        let matrix = 8e-6 * (cost.springs * cost.springs) as f64;
        let (n, seconds, steps) = (cost.springs, cost.seconds, cost.steps);
        println!(
            "| {n} | {seconds:.3} | {:.3} | {steps} | {:.4} | {:.1} | {matrix:.1} |",
            cost.processor_seconds,
            cost.per_step(),
            cost.megabytes
        );
    };
    let mut costs = Vec::new();
    for springs in SPRINGS {
        costs.push(typical(springs));
        show(&costs[costs.len() - 1]);
    }
    println!(
        "\nExponents from {FITTED_FROM} springs on: processor time {:.2}, per step {:.2}, memory {:.2}",
        exponent(&costs, |cost| cost.processor_seconds),
        exponent(&costs, Cost::per_step),
        exponent(&costs, |cost| cost.megabytes)
    );
    let (springs, most) = JUDGED;
    let judged = typical(springs);
    println!();
    show(&judged);
    let verdict = if judged.megabytes <= most { "within" } else { "above" };
    println!("\n{springs} springs take {:.1} MB, {verdict} {most} MB.", judged.megabytes);
}
