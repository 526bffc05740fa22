//! What candidates cost: each is run alone, as often as is needed for a wall time that means something.

use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::data::{AtomicFile, Fingerprint, RunFile, Scratch, failure};
use crate::error::Result;
use crate::run::{Simulation, Stop, hash_of, is_of, operator_bytes};
use crate::scene::Scene;
use crate::scene::input::{self, Pipes};
use crate::solver::model::Model;
use crate::solver::simulation::{self as stepping, Flow, Observer};
use crate::study::batch::alone;

/// What the directory of runs is for.
const PURPOSE: &str = "runs of a trade-off";

/// Time after which a run is not repeated, s, all repeats together.
const ENOUGH: f64 = 0.3;

/// Size of the largest record read, bytes: one holds a scene.
const LARGEST_RECORD: u64 = 100_000_000;

/// What a candidate cost.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// Least wall time of a run in memory, s, with all that follows from the scene (mesh, operators).
    pub wall_seconds: f64,
    /// The same with the writing of the result file.
    pub wall_seconds_file: f64,
    /// How often it was run.
    pub repeats: usize,
    /// Evaluations of pressure, slip and wear.
    pub rate_evaluations: u64,
    /// Steps accepted.
    pub steps: u64,
    /// Steps rejected.
    pub rejected_steps: u64,
    /// Memory of its operators, bytes, estimated from the springs.
    pub memory: f64,
    /// Springs, asked for or chosen.
    pub springs: usize,
    /// Tolerance of a step, asked for or chosen.
    pub tolerance: f64,
}

/// What came of a candidate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Measurement {
    /// It was run to its end.
    Done(Cost),
    /// It cannot be run, or its run failed.
    Failed(String),
    /// It took longer than was allowed.
    Stopped(String),
    /// It was not run, as it would take longer than is allowed.
    Skipped(String),
}

impl Measurement {
    /// Name in files and JSON: `done`, `failed`, `stopped` or `skipped`.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Done(_) => "done",
            Self::Failed(_) => "failed",
            Self::Stopped(_) => "stopped",
            Self::Skipped(_) => "skipped",
        }
    }

    /// Why it was not run to its end; empty if it was.
    pub fn reason(&self) -> &str {
        match self {
            Self::Done(_) => "",
            Self::Failed(why) | Self::Stopped(why) | Self::Skipped(why) => why,
        }
    }

    /// What it cost, if it was run to its end.
    pub fn cost(&self) -> Option<&Cost> {
        match self {
            Self::Done(cost) => Some(cost),
            _ => None,
        }
    }
}

/// What is kept of a candidate until all are done, beside its run.
#[derive(Serialize, Deserialize)]
struct Record {
    /// What was measured, and how: [`Runs::hash`].
    hash: String,
    measurement: Measurement,
}

/// Does runs, or finds them done by a call that was stopped; what is kept of them goes with this.
pub(super) struct Runs<'a> {
    scratch: Scratch,
    stop: &'a Stop,
    repeats: usize,
}

impl<'a> Runs<'a> {
    pub(super) fn new(folder: &Path, stop: &'a Stop, repeats: usize) -> Result<Self> {
        let scratch = Scratch::take_up(folder, PURPOSE).map_err(|error| failure(folder, &error))?;
        Ok(Self { scratch, stop, repeats })
    }

    /// Keeps the runs for the next call.
    pub(super) fn keep(self) {
        self.scratch.keep();
    }

    /// SHA-256 of all that a measurement depends on: the scene, the patience with it, the repeats, the machine.
    fn hash(&self, scene: &Scene, most_seconds: f64) -> String {
        let host = std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
        Fingerprint::default()
            .add(b"measurement")
            .add(hash_of(scene).as_bytes())
            .add_numbers(&[most_seconds, self.repeats as f64])
            .add(host.as_bytes())
            .finish()
    }

    /// Puts a copy of a run that is done into a directory.
    pub(super) fn copy(&self, name: &str, folder: &Path, overwrite: bool) -> Result<()> {
        let (from, to) = (self.file(name), folder.join(format!("{name}.h5")));
        let copied = |temporary: &Path| {
            std::fs::copy(&from, temporary).map(drop).map_err(|error| failure(&to, &error))
        };
        AtomicFile::new(&to, overwrite)?.write_with(copied)
    }

    /// A run that is done.
    pub(super) fn read(&self, name: &str) -> Result<RunFile> {
        RunFile::open(&self.file(name))
    }

    fn file(&self, name: &str) -> PathBuf {
        self.scratch.path().join(format!("{name}.h5"))
    }

    /// Measures a scene, or finds it measured; none if it was stopped.
    ///
    /// # Errors
    /// [`Error::File`] concerns all runs: the disk is full, a directory has vanished.
    pub(super) fn measure(
        &self,
        name: &str,
        scene: &Scene,
        most_seconds: f64,
    ) -> Result<Option<Measurement>> {
        let path = self.scratch.path().join(format!("{name}.json"));
        let before = input::bytes(&path, LARGEST_RECORD, Pipes::Refused)
            .ok()
            .and_then(|text| serde_json::from_slice::<Record>(&text).ok());
        let hash = self.hash(scene, most_seconds);
        let fits = |it: &Record| {
            let has_run = || self.read(name).is_ok_and(|run| is_of(&run, scene));
            it.hash == hash && (it.measurement.cost().is_none() || has_run())
        };
        if let Some(before) = before.filter(fits) {
            return Ok(Some(before.measurement));
        }
        let Some(end) = alone(self.stop, || self.run(name, scene, most_seconds))? else { return Ok(None) };
        let measured = end.unwrap_or_else(Measurement::Failed);
        self.note(name, hash, &measured)?;
        Ok(Some(measured))
    }

    fn note(&self, name: &str, hash: String, measurement: &Measurement) -> Result<()> {
        let record = Record { hash, measurement: measurement.clone() };
        let text =
            serde_json::to_vec_pretty(&record).expect("a record has string keys and plain values only");
        AtomicFile::new(&self.scratch.path().join(format!("{name}.json")), true)?.write(&text)
    }

    /// Measures once more what took little time, at another moment: other programs may have been busy at the first. False if it was stopped.
    ///
    /// # Errors
    /// As [`Runs::measure`], and those of the run, which there were none of before.
    pub(super) fn measure_again(
        &self,
        name: &str,
        scene: &Scene,
        most_seconds: f64,
        measurement: &mut Measurement,
    ) -> Result<bool> {
        let Measurement::Done(cost) = measurement else { return Ok(true) };
        if self.repeats == 1 || cost.wall_seconds_file > ENOUGH {
            return Ok(true);
        }
        match self.once(name, scene, f64::INFINITY)? {
            Some(Measurement::Done(again)) => *cost = cost.with(&again),
            Some(_) => {}
            None => return Ok(false),
        }
        self.note(name, self.hash(scene, most_seconds), measurement)?;
        Ok(true)
    }

    fn run(&self, name: &str, scene: &Scene, most_seconds: f64) -> Result<Option<Measurement>> {
        let mut found: Option<Cost> = None;
        let mut spent = 0.0;
        loop {
            let Some(measurement) = self.once(name, scene, most_seconds)? else { return Ok(None) };
            let Measurement::Done(cost) = measurement else { return Ok(Some(measurement)) };
            spent += cost.wall_seconds_file;
            let cost = found.map_or(cost.clone(), |before| before.with(&cost));
            if cost.repeats >= self.repeats || spent >= ENOUGH {
                return Ok(Some(Measurement::Done(cost)));
            }
            found = Some(cost);
        }
    }

    /// One run, which is kept; none if it was stopped.
    fn once(&self, name: &str, scene: &Scene, most_seconds: f64) -> Result<Option<Measurement>> {
        let started = Instant::now();
        // Each forms its own operators, as a user's run does.
        let simulation = Simulation::new(scene)?.stopped_by(self.stop);
        let (model, tolerance) = (simulation.stepping().model(), simulation.stepping().tolerance());
        let springs = model.springs();
        let backend = Model::backend(model.contact(), model.schedule(), springs);
        let results = simulation.run_with(Some(&mut Deadline { started, most_seconds }))?;
        let wall_seconds = started.elapsed().as_secs_f64();
        if self.stop.is_stopped() {
            return Ok(None);
        }
        let progress = results.checkpoint().progress;
        if !results.is_complete() {
            let (tau, steps) = (results.last().tau, progress.steps);
            let why = format!("stopped after {most_seconds} s at τ = {tau:.3e} with {steps} steps");
            return Ok(Some(Measurement::Stopped(why)));
        }
        let saving = Instant::now();
        results.save_over(self.file(name))?;
        Ok(Some(Measurement::Done(Cost {
            wall_seconds,
            wall_seconds_file: wall_seconds + saving.elapsed().as_secs_f64(),
            repeats: 1,
            rate_evaluations: progress.rate_evaluations,
            steps: progress.steps,
            rejected_steps: progress.rejected_steps,
            memory: operator_bytes(backend, springs),
            springs,
            tolerance,
        })))
    }
}

impl Cost {
    /// The lesser times of both, and as many repeats as both.
    fn with(&self, other: &Self) -> Self {
        Self {
            wall_seconds: self.wall_seconds.min(other.wall_seconds),
            wall_seconds_file: self.wall_seconds_file.min(other.wall_seconds_file),
            repeats: self.repeats + other.repeats,
            ..self.clone()
        }
    }
}

/// Stops a run that takes too long.
struct Deadline {
    started: Instant,
    most_seconds: f64,
}

impl Observer for Deadline {
    fn step(&mut self, _: &stepping::Simulation) -> Result<Flow> {
        let late = self.started.elapsed().as_secs_f64() > self.most_seconds;
        Ok(if late { Flow::Stop } else { Flow::Continue })
    }
}
