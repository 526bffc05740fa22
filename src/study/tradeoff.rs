//! The measured cost of accuracy: one scene, computed in every way there is.
//!
//! Candidates combine stepper, way through a cycle, springs and tolerance; beside them stands what `accuracy` chooses. Each is run
//! alone for its wall time, its evaluations and its errors at every snapshot. Errors are measured against what is known best at that time: the
//! closed-form limit, the Gibson transient where `1 - k` is tiny, or two runs finer than any candidate, whose difference is their
//! uncertainty. An error below three times that uncertainty is given as a bound.
//!
//! Runs that are done are kept in a hidden directory of the program's own inside `DIR` until all are: a measurement that was stopped goes on with the
//! same command. After the end, or an error, that directory is gone.

mod candidates;
mod errors;
mod files;
mod front;
mod measure;
mod profile;
mod reference;
mod report;

pub use candidates::{Candidate, Choice, Ladders};
pub use errors::{Errors, Measured, ReferenceKind, Worst};
pub use front::{cheapest, pareto_front};
pub use measure::{Cost, Measurement};
pub use reference::Reference;
pub use report::TradeoffReport;

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::data::{Mark, check_folder};
use crate::error::{Error, Result};
use crate::run::{Simulation, Stop};
use crate::scene::{Output, Scene, Stepper};
use crate::study::batch::Progress;
use measure::Runs;

/// Where copies of the runs are put.
const RUNS: &str = "runs";

/// Most snapshots of a scene that is measured.
const MOST_SNAPSHOTS: usize = 1000;

/// Accuracy at which a scene must be ready to run.
const PREFLIGHT: f64 = 1e-4;

/// Passes in which short runs are measured once more.
const AGAIN: usize = 2;

/// Time for what `accuracy` chooses over that for other candidates: it is of interest even where it is dear.
const PATIENCE: f64 = 5.0;

/// How a scene is measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// What is tried.
    pub ladders: Ladders,
    /// Wall time up to which a candidate by hand is run, s; what `accuracy` chooses may take five times, a reference twenty times as long.
    pub most_seconds: f64,
    /// Most runs of a candidate for its wall time, one after the other; short ones are run twice more after all others, unless this is 1.
    pub repeats: usize,
    /// Whether copies of the runs are put into `DIR/runs`.
    pub keep_runs: bool,
    /// Whether files that exist may be replaced.
    pub overwrite: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            ladders: Ladders::default(),
            most_seconds: 2.0,
            repeats: 5,
            keep_runs: false,
            overwrite: false,
        }
    }
}

/// A candidate and what came of it.
#[derive(Debug, Clone, PartialEq)]
pub struct CandidateResult {
    /// The candidate.
    pub candidate: Candidate,
    /// What it cost, or why it was not run to its end.
    pub measurement: Measurement,
    /// Its errors at each snapshot after the start.
    pub errors: Vec<Errors>,
    /// The largest of them.
    pub worst: Option<Worst>,
    /// Whether it lies on each of [`FRONTS`]; what `accuracy` chooses does not.
    pub on_front: [bool; 4],
    /// Of what `accuracy` chooses: its cost over that of the cheapest candidate that is as accurate, in the sense of each of [`FRONTS`].
    pub over_front: [Option<f64>; 4],
}

impl CandidateResult {
    fn new(candidate: Candidate, measurement: Measurement, errors: Vec<Errors>) -> Self {
        let worst = Worst::of(&errors);
        Self { candidate, measurement, errors, worst, on_front: [false; 4], over_front: [None; 4] }
    }
}

/// A front: which error, against which cost.
#[derive(Debug, Clone, Copy)]
pub struct Front {
    /// Name in files: `volume_time`, `profile_time`, `volume_evaluations`, `profile_evaluations`.
    pub name: &'static str,
    /// The same in words.
    pub words: &'static str,
    cost: fn(&Cost) -> f64,
    error: fn(&Worst) -> Measured,
}

/// All fronts.
pub const FRONTS: [Front; 4] = [
    Front {
        name: "volume_time",
        words: "error of the volume against wall time",
        cost: |it| it.wall_seconds,
        error: |it| it.volume,
    },
    Front {
        name: "profile_time",
        words: "error of the profile against wall time",
        cost: |it| it.wall_seconds,
        error: |it| it.nodes,
    },
    Front {
        name: "volume_evaluations",
        words: "error of the volume against rate evaluations",
        cost: |it| it.rate_evaluations as f64,
        error: |it| it.volume,
    },
    Front {
        name: "profile_evaluations",
        words: "error of the profile against rate evaluations",
        cost: |it| it.rate_evaluations as f64,
        error: |it| it.nodes,
    },
];

impl Front {
    /// Cost and error of a candidate; not numbers where it has none.
    pub fn point(&self, row: &CandidateResult) -> (f64, f64) {
        match (row.measurement.cost(), &row.worst) {
            (Some(cost), Some(worst)) => ((self.cost)(cost), (self.error)(worst).value),
            _ => (f64::NAN, f64::NAN),
        }
    }

    /// The error of a candidate.
    pub fn error(&self, row: &CandidateResult) -> Option<Measured> {
        row.worst.as_ref().map(self.error)
    }
}

/// What a measurement came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// Title of the scene.
    pub title: Option<String>,
    /// One row for each candidate.
    pub rows: Vec<CandidateResult>,
    /// What they were compared with.
    pub reference: Reference,
    /// Volume, m³, that errors of the volume are relative to: that of the limit, or of the end where there is no limit.
    pub volume_scale: f64,
    /// Depth, m, that errors of the profile are relative to, likewise.
    pub depth_scale: f64,
    /// The files written.
    pub files: Vec<PathBuf>,
    /// Wall time of this call, s.
    pub wall_seconds: f64,
}

/// A scene that is ready to be measured.
pub struct Tradeoff<'a> {
    scene: &'a Scene,
    folder: PathBuf,
    options: Options,
    candidates: Vec<(Candidate, Scene)>,
    stop: Stop,
    started: Instant,
}

impl<'a> Tradeoff<'a> {
    /// Reads the scenes of all candidates and makes sure that results can be written.
    ///
    /// # Errors
    /// [`Error::Inconsistent`] names what is wrong with an option, or why the scene cannot be run at all; [`Error::File`] if a file exists
    /// that may not be replaced, or the directory cannot be written.
    pub fn new(scene: &'a Scene, folder: &Path, options: &Options, stop: &Stop) -> Result<Self> {
        let started = Instant::now();
        let options = Options { ladders: options.ladders.clone().sorted()?, ..options.clone() };
        let snapshots = match scene.output() {
            Output::Snapshots(count) => *count,
            Output::AtCycles(times) | Output::AtTau(times) => times.len(),
        };
        if snapshots > MOST_SNAPSHOTS {
            let why = format!(
                "{snapshots} snapshots, more than {MOST_SNAPSHOTS}, of every candidate; ask for fewer"
            );
            return Err(Error::Inconsistent { what: "output", why });
        }
        let with_scene =
            |candidate: Candidate| Ok((candidate, scene.varied(&candidate.numerics(scene), "")?));
        let candidates: Vec<_> = candidates::candidates(scene, &options.ladders)
            .into_iter()
            .map(with_scene)
            .collect::<Result<_>>()?;
        // What no candidate could run is refused before anything is written.
        let chosen = Candidate {
            choice: Choice::Accuracy(PREFLIGHT),
            stepper: Stepper::default(),
            cycle: candidates::cycles(scene)[0],
        };
        let plain = scene.varied(&chosen.numerics(scene), "")?;
        Simulation::check(&plain)?;
        files::check_folder(folder, options.overwrite)?;
        if options.keep_runs {
            let names: Vec<String> = run_names(candidates.len()).map(|it| format!("{it}.h5")).collect();
            let names: Vec<_> = names.iter().map(|name| (name.as_str(), Mark::Results)).collect();
            check_folder(&folder.join(RUNS), &names, options.overwrite)?;
        }
        Ok(Self { scene, folder: folder.to_owned(), options, candidates, stop: stop.clone(), started })
    }

    /// Wall time up to which a candidate is run, s.
    fn patience(&self, candidate: &Candidate) -> f64 {
        self.options.most_seconds * if candidate.accuracy().is_some() { PATIENCE } else { 1.0 }
    }

    /// Number of candidates.
    pub fn candidates(&self) -> usize {
        self.candidates.len()
    }

    /// Measures all candidates and writes `tradeoff.h5` and `tradeoff.csv`; none if it was stopped first. A candidate that fails is a row.
    ///
    /// # Errors
    /// [`Error::File`] if files cannot be written, [`Error::NotConverged`] if no reference could be run.
    pub fn execute(self, progress: Option<&dyn Progress>) -> Result<Option<Outcome>> {
        let runs = Runs::new(&self.folder, &self.stop, self.options.repeats)?;
        let outcome = self.execute_in(&runs, progress)?;
        if outcome.is_none() {
            runs.keep();
        }
        Ok(outcome)
    }

    fn execute_in(&self, runs: &Runs, progress: Option<&dyn Progress>) -> Result<Option<Outcome>> {
        if let Some(progress) = progress {
            progress.begin(self.candidates.len() as u64);
        }
        let Some(measured) = self.measure(runs, progress)? else { return Ok(None) };
        let most_seconds = self.options.most_seconds;
        let Some((references, reference)) = reference::found(self.scene, runs, &measured, most_seconds)?
        else {
            return Ok(None);
        };
        let mut rows = vec![];
        for (number, (candidate, measurement)) in measured.into_iter().enumerate() {
            let errors = match measurement.cost() {
                Some(_) => references.errors(&runs.read(&name(number))?),
                None => vec![],
            };
            rows.push(CandidateResult::new(candidate, measurement, errors));
        }
        place_on_fronts(&mut rows);
        let mut outcome = Outcome {
            title: self.scene.title().map(str::to_owned),
            rows,
            reference,
            volume_scale: references.scales[0],
            depth_scale: references.scales[1],
            files: vec![],
            wall_seconds: self.started.elapsed().as_secs_f64(),
        };
        outcome.files = files::write(self.scene, &outcome, &self.folder, self.options.overwrite)?;
        if self.options.keep_runs {
            for name in run_names(self.candidates.len()).filter(|name| runs.read(name).is_ok()) {
                runs.copy(&name, &self.folder.join(RUNS), self.options.overwrite)?;
            }
        }
        Ok(Some(outcome))
    }

    /// What became of all candidates; none if it was stopped.
    fn measure(
        &self,
        runs: &Runs,
        progress: Option<&dyn Progress>,
    ) -> Result<Option<Vec<(Candidate, Measurement)>>> {
        let mut measured: Vec<(Candidate, Measurement)> = vec![];
        for (number, (candidate, scene)) in self.candidates.iter().enumerate() {
            let measurement = match too_dear(candidate, &measured, self.options.most_seconds) {
                Some(why) => Measurement::Skipped(why),
                None => match runs.measure(&name(number), scene, self.patience(candidate))? {
                    Some(measurement) => measurement,
                    None => return Ok(None),
                },
            };
            if let Some(progress) = progress {
                progress.done(matches!(measurement, Measurement::Failed(_)));
            }
            measured.push((*candidate, measurement));
        }
        for _ in 0..AGAIN {
            for (number, (candidate, measurement)) in measured.iter_mut().enumerate() {
                let (scene, patience) = (&self.candidates[number].1, self.patience(candidate));
                if !runs.measure_again(&name(number), scene, patience, measurement)? {
                    return Ok(None);
                }
            }
        }
        Ok(Some(measured))
    }
}

fn name(number: usize) -> String {
    format!("candidate{number}")
}

/// Names of all runs that there may be.
fn run_names(candidates: usize) -> impl Iterator<Item = String> {
    (0..candidates).map(name).chain((0..2).map(reference::name))
}

/// Why a candidate would take longer than is allowed, as far as coarser ones tell.
fn too_dear(
    candidate: &Candidate,
    measured: &[(Candidate, Measurement)],
    most_seconds: f64,
) -> Option<String> {
    let Choice::Hand { springs, tolerance } = candidate.choice else { return None };
    let akin: Vec<(usize, f64, &Measurement)> = measured
        .iter()
        .filter(|(other, _)| other.is_akin(candidate))
        .filter_map(|(other, measurement)| match other.choice {
            Choice::Hand { springs, tolerance } => Some((springs, tolerance, measurement)),
            Choice::Accuracy(_) => None,
        })
        .collect();
    let coarser = |it: &&(usize, f64, &Measurement)| it.0 <= springs && it.1 >= tolerance;
    let dear =
        |it: &&(usize, f64, &Measurement)| matches!(it.2, Measurement::Stopped(_) | Measurement::Skipped(_));
    if let Some((springs, tolerance, _)) = akin.iter().filter(coarser).find(dear) {
        return Some(format!("{springs} springs at the tolerance {tolerance:e} took too long already"));
    }
    let time = |springs: usize, tolerance: f64| {
        let same = akin.iter().find(|it| it.0 == springs && it.1 == tolerance);
        same.and_then(|it| it.2.cost()).map(|it| it.wall_seconds)
    };
    let fewer = akin.iter().map(|it| it.0).filter(|it| *it < springs).max();
    let looser = akin.iter().map(|it| it.1).filter(|it| *it > tolerance).min_by(f64::total_cmp);
    // Time goes at least as the square of the number of springs, and steps of second order as the cube root of the tolerance.
    let by_springs = fewer.and_then(|it| Some(time(it, tolerance)? * (springs as f64 / it as f64).powi(2)));
    let by_tolerance = looser.and_then(|it| Some(time(springs, it)? * (it / tolerance).cbrt()));
    let by_both =
        fewer.zip(looser).and_then(|(n, e)| Some(time(springs, e)? * time(n, tolerance)? / time(n, e)?));
    let predicted = by_both.or(by_springs).or(by_tolerance)?;
    (predicted > most_seconds)
        .then(|| format!("would take some {predicted:.1} s, more than {most_seconds} s"))
}

/// Finds the fronts, and where what `accuracy` chooses stands against them.
fn place_on_fronts(rows: &mut [CandidateResult]) {
    for (number, front) in FRONTS.iter().enumerate() {
        let by_hand = |row: &CandidateResult| match row.candidate.choice {
            Choice::Hand { .. } => front.point(row),
            Choice::Accuracy(_) => (f64::NAN, f64::NAN),
        };
        let points: Vec<(f64, f64)> = rows.iter().map(by_hand).collect();
        for place in pareto_front(&points) {
            rows[place].on_front[number] = true;
        }
        for row in rows.iter_mut().filter(|row| row.candidate.accuracy().is_some()) {
            let (cost, error) = front.point(row);
            row.over_front[number] =
                cheapest(&points, error).map(|least| cost / least).filter(|it| it.is_finite());
        }
    }
}
