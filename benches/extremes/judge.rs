//! What becomes of a scene: done, told, refused, failed, or out of time.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, mpsc};
use std::time::Duration;

use fretwear::data::{Snapshot, StopReason};
use fretwear::run::{Resumed, Run};
use fretwear::scene::Scene;
use fretwear::solver::simulation::{self as stepping, Flow, Observer};
use fretwear::{Error, Results, Simulation, Stop};

/// Part of the largest depth or slip by which curves may swing below nothing next to an edge, over the accuracy.
const SWING: f64 = 2.0;

/// Processor time after which a scene that does not stop when it is asked to ends the whole, s.
const HANGS: f64 = 90.0;

/// Scene and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    pub name: String,
    /// `done`, `told`, `refused`, `named`, `failed`, `late` or `wrong`.
    pub end: String,
    /// Of the processor.
    pub seconds: f64,
    pub why: String,
}

impl Row {
    fn new(name: &str, end: &str, why: impl Into<String>) -> Self {
        let why = why.into().lines().next().unwrap_or_default().replace('|', "/");
        // The folder of a scene is another each time.
        let why = why.split_once("scene.toml:").map_or(why.as_str(), |(_, words)| words).to_owned();
        Self { name: name.into(), end: end.into(), seconds: used(), why }
    }

    /// That of a scene which does not stop when it is asked to.
    pub fn lost(name: &str) -> Self {
        Self { seconds: HANGS, ..Self::new(name, "late", "does not stop when it is asked to") }
    }

    pub fn written(&self) -> String {
        let Self { name, end, seconds, why } = self;
        format!("{name}|{end}|{seconds:.2}|{why}")
    }

    pub fn read_all(file: &Path) -> Vec<Self> {
        let text = std::fs::read_to_string(file).unwrap_or_default();
        let row = |line: &str| {
            let mut parts = line.splitn(4, '|').map(str::to_owned);
            Some(Self {
                name: parts.next()?,
                end: parts.next()?,
                seconds: parts.next()?.parse().ok()?,
                why: parts.next()?,
            })
        };
        text.lines().filter_map(row).collect()
    }
}

/// Processor time of this process so far, s.
fn seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after_name = text.rsplit(") ").next().unwrap_or_default();
    // User and system time, in hundredths of a second.
    after_name.split(' ').skip(11).take(2).filter_map(|it| it.parse::<f64>().ok()).sum::<f64>() * 0.01
}

/// Asks to stop the scene under way; one at a time.
static STOP: Mutex<Option<Stop>> = Mutex::new(None);

fn stop() -> Stop {
    let stop = Stop::default();
    *STOP.lock().unwrap_or_else(PoisonError::into_inner) = Some(stop.clone());
    stop
}

/// Processor time at which the run under way began, s.
static BEGUN: Mutex<f64> = Mutex::new(0.0);

fn begins() {
    *BEGUN.lock().unwrap_or_else(PoisonError::into_inner) = seconds();
}

fn used() -> f64 {
    seconds() - *BEGUN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Judges a scene, asks it to stop when it has used its time, and ends the process where it does not.
pub fn watched(patience: f64, lost: impl Fn() + Sync, judged: impl FnOnce() -> Row) -> Row {
    begins();
    let late = AtomicBool::new(false);
    let (done, waits) = mpsc::channel::<()>();
    let judged = std::thread::scope(|scope| {
        scope.spawn(|| {
            let waits = waits;
            while waits.recv_timeout(Duration::from_millis(50)) == Err(mpsc::RecvTimeoutError::Timeout) {
                let used = used();
                if used > patience {
                    late.store(true, Ordering::Relaxed);
                    if let Some(stop) = &*STOP.lock().unwrap_or_else(PoisonError::into_inner) {
                        stop.stop();
                    }
                }
                if used > HANGS {
                    lost();
                    std::process::exit(1);
                }
            }
        });
        let judged = catch_unwind(AssertUnwindSafe(judged));
        drop(done);
        judged
    });
    let mut row = judged.unwrap_or_else(|panic| {
        let words = panic.downcast_ref::<String>().cloned();
        let words = words.or_else(|| panic.downcast_ref::<&str>().map(|it| (*it).to_owned()));
        Row::new("", "wrong", format!("panics: {}", words.unwrap_or_default()))
    });
    if late.load(Ordering::Relaxed) && row.end != "wrong" {
        row = Row { end: "late".into(), ..row };
    }
    row
}

/// What is not a number, or less than nothing.
///
/// # Arguments
/// * `most` -- depth and slip of the run, m: in a block that sticks slip is the round-off of others
fn unsound(snapshot: &Snapshot, most: [f64; 2], swing: f64) -> Option<&'static str> {
    let Snapshot { wear_volume, contact_radius, stick_radius, indentation, normal_force, .. } = snapshot;
    let numbers =
        [wear_volume, contact_radius, stick_radius, indentation, normal_force, &snapshot.dissipated_energy];
    if numbers.into_iter().any(|value| !value.is_finite()) {
        return Some("a number that is none");
    }
    for ((what, values), most) in
        [("depth", &snapshot.wear_depth), ("slip", &snapshot.slip)].into_iter().zip(most)
    {
        if !values.iter().all(|value| value.is_finite() && *value >= -swing * most) {
            return Some(what);
        }
    }
    None
}

fn ended(name: &str, results: &Results, accuracy: f64) -> Row {
    let estimate =
        results.error_estimate().map_or_else(|| "no estimate".to_owned(), |it| format!("estimate {it:.1e}"));
    let how = format!("{estimate}, {} springs, {} steps", results.springs(), results.steps());
    let largest =
        |of: fn(&Snapshot) -> &Vec<f64>| results.snapshots().iter().flat_map(of).copied().fold(0.0, f64::max);
    let most = [largest(|it| &it.wear_depth), largest(|it| &it.slip)];
    let first =
        results.snapshots().iter().find_map(|it| Some((it.tau, unsound(it, most, SWING * accuracy)?)));
    // What has been told may be off by as much as was told.
    let swing = SWING * results.error_estimate().unwrap_or(1.0).max(accuracy);
    let beyond = results.snapshots().iter().find_map(|it| Some((it.tau, unsound(it, most, swing)?)));
    if let Some((tau, what)) = if results.accuracy_met() == Some(true) { first } else { beyond } {
        return Row::new(name, "wrong", format!("{what} at τ = {tau:.3e}, {how}"));
    }
    match results.accuracy_met() {
        Some(true) => Row::new(name, "done", how),
        _ => Row::new(name, "told", how),
    }
}

fn refused_or_failed(name: &str, error: &Error, before: bool) -> Row {
    // What is physical: beyond it there is no contact to follow.
    let named = ["stick is lost at", "the profile of the indenter ends"];
    let is_named = named.iter().any(|words| error.to_string().contains(words));
    match (error, before) {
        _ if is_named => Row::new(name, "named", error.to_string()),
        (Error::NotConverged { .. }, false) => Row::new(name, "failed", error.to_string()),
        // What is found to fail while it is prepared is no refusal of what was asked.
        (Error::Inconsistent { why, .. }, true) if why.starts_with("at cycle ") => {
            Row::new(name, "failed", error.to_string())
        }
        (_, true) => Row::new(name, "refused", error.to_string()),
        (_, false) => Row::new(name, "wrong", format!("an error of its own: {error}")),
    }
}

/// Reads a scene and runs it in memory.
pub fn judge(name: &str, read: impl FnOnce() -> fretwear::Result<Scene>) -> Row {
    let stop = stop();
    let scene = match read() {
        Ok(scene) => scene,
        Err(error) => return refused_or_failed(name, &error, true),
    };
    let run = match Simulation::new(&scene) {
        Ok(run) => run.stopped_by(&stop),
        Err(error) => return refused_or_failed(name, &error, true),
    };
    match run.run() {
        Ok(results) => ended(name, &results, scene.numerics().accuracy),
        Err(error) => refused_or_failed(name, &error, false),
    }
}

/// Stops after some steps.
struct StopAfter(u64);

impl Observer for StopAfter {
    fn step(&mut self, _: &stepping::Simulation) -> fretwear::Result<Flow> {
        self.0 = self.0.saturating_sub(1);
        Ok(if self.0 == 0 { Flow::Stop } else { Flow::Continue })
    }
}

/// Runs a scene with a file, and once more in two parts, which have to come to the same; each has its time.
pub fn judge_in_parts(name: &str, text: &str) -> Row {
    let stop = stop();
    let folder = tempfile::tempdir().expect("a folder");
    let scene = match Scene::from_toml(text, "scene.toml") {
        Ok(scene) => scene,
        Err(error) => return refused_or_failed(name, &error, true),
    };
    let run = match Run::new(&scene, &folder.path().join("whole.h5"), false, &stop) {
        Ok(run) => run,
        Err(error) => return refused_or_failed(name, &error, true),
    };
    let whole = match run.execute(None) {
        Ok(results) => results,
        Err(error) => return refused_or_failed(name, &error, false),
    };
    let row = ended(name, &whole, scene.numerics().accuracy);
    begins();
    let wrong = |why: &str| Row::new(name, "wrong", format!("resumed: {why}"));
    if whole.steps() < 2 || row.end == "wrong" || !whole.is_complete() {
        return row;
    }
    let parts = folder.path().join("parts.h5");
    let mut observer = StopAfter((whole.steps() / 2).max(1));
    let first = Run::new(&scene, &parts, false, &stop).and_then(|run| run.execute(Some(&mut observer)));
    let mut last = match first {
        Ok(first) => first,
        Err(error) => return wrong(&error.to_string()),
    };
    if last.stop_reason() == StopReason::Interrupted {
        let resumed = Run::resume(&parts, &stop).and_then(|run| match run {
            Resumed::Run(run) => run.execute(None),
            Resumed::Complete(results) => Ok(*results),
        });
        last = match resumed {
            Ok(results) => results,
            Err(error) => return wrong(&error.to_string()),
        };
    }
    let seen = |it: &Results| {
        let last = it.last();
        (
            last.wear_volume.to_bits(),
            last.contact_radius.to_bits(),
            last.wear_depth.clone(),
            it.snapshots().len(),
        )
    };
    if last.is_complete() && (seen(&last) != seen(&whole) || last.error_estimate() != whole.error_estimate())
    {
        return wrong(&format!(
            "volume {:e} for {:e}, estimate {:?} for {:?}",
            last.last().wear_volume,
            whole.last().wear_volume,
            last.error_estimate(),
            whole.error_estimate()
        ));
    }
    row
}
