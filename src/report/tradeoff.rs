//! `fretwear tradeoff`: what accuracy costs, in fronts.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::text::{Rows, Scale, number};
use super::{TableFile, json};
use crate::error::Result;
use crate::study::tradeoff::{
    Choice, Errors, FRONTS, Front, Measured, OBJECT, Outcome, Row, Source, pareto_front,
};

/// Summary of a trade-off; the fields are the keys of the JSON.
#[derive(Debug, Clone, Serialize)]
pub struct TradeoffReport {
    /// Title of the scene.
    pub title: Option<String>,
    /// The files written.
    pub files: Vec<PathBuf>,
    /// Wall time of this call, s.
    pub wall_seconds: f64,
    /// Volume that errors of the volume are relative to, m³.
    pub volume_scale: f64,
    /// Depth that errors of the profile are relative to, m.
    pub depth_scale: f64,
    /// The runs that judged where nothing else was known better.
    pub reference: ReferenceReport,
    /// The fronts by name; each a list of places in `candidates`, by rising cost.
    pub fronts: Fronts,
    /// All candidates.
    pub candidates: Vec<CandidateReport>,
}

/// The runs that judged, the finer first.
#[derive(Debug, Clone, Serialize)]
pub struct ReferenceReport {
    /// Springs of both.
    pub springs: [usize; 2],
    /// Tolerances of both.
    pub tolerance: [f64; 2],
    /// Wall time of both, s.
    pub wall_seconds: [f64; 2],
    /// Their largest difference in the worn volume over all snapshots, relative as errors are.
    pub volume_uncertainty: f64,
    /// Their largest difference in depth.
    pub profile_uncertainty: f64,
}

/// Places of candidates.
#[derive(Debug, Clone, Serialize)]
pub struct Fronts {
    /// Error of the volume against wall time.
    pub volume_time: Vec<usize>,
    /// Error of the profile against wall time.
    pub profile_time: Vec<usize>,
    /// Error of the volume against rate evaluations.
    pub volume_evaluations: Vec<usize>,
    /// Error of the profile against rate evaluations.
    pub profile_evaluations: Vec<usize>,
}

/// One candidate; what is not known is null.
#[derive(Debug, Clone, Serialize)]
pub struct CandidateReport {
    /// Accuracy asked of the knob; null where springs and tolerance were given by hand.
    pub accuracy: Option<f64>,
    /// Method of time stepping.
    pub stepper: &'static str,
    /// How a cycle is passed through.
    pub cycle: &'static str,
    /// Springs, asked for or chosen.
    pub springs: Option<usize>,
    /// Tolerance of a step, asked for or chosen.
    pub tolerance: Option<f64>,
    /// `done`, `failed`, `stopped` or `skipped`.
    pub status: &'static str,
    /// Why it was not run to its end.
    pub reason: Option<String>,
    /// Least wall time in memory, s, setting up included.
    pub wall_seconds: Option<f64>,
    /// Least wall time with the result file, s.
    pub wall_seconds_file: Option<f64>,
    /// Runs of which the least time was taken.
    pub repeats: Option<usize>,
    /// Evaluations of pressure, slip and wear.
    pub rate_evaluations: Option<u64>,
    /// Steps accepted.
    pub steps: Option<u64>,
    /// Steps rejected.
    pub rejected_steps: Option<u64>,
    /// Memory of the dense operators, bytes, estimated.
    pub memory: Option<f64>,
    /// Largest error of the worn volume over all snapshots, or its bound.
    pub volume_error: Option<f64>,
    /// Largest error of the depth on common radii, or its bound.
    pub profile_error: Option<f64>,
    /// Largest error of the depth at its own radii, or its bound.
    pub node_error: Option<f64>,
    /// Which of the three are bounds.
    pub bounded: Option<[bool; 3]>,
    /// For the knob: its cost over that of the cheapest candidate by hand with at most its error, by front.
    pub over_front: Option<OverFront>,
    /// The snapshots after the start.
    pub snapshots: Vec<SnapshotReport>,
}

/// Costs of the knob over those of the fronts; null where no candidate by hand is as accurate.
#[derive(Debug, Clone, Serialize)]
pub struct OverFront {
    /// Error of the volume, wall time.
    pub volume_time: Option<f64>,
    /// Error of the profile, wall time.
    pub profile_time: Option<f64>,
    /// Error of the volume, rate evaluations.
    pub volume_evaluations: Option<f64>,
    /// Error of the profile, rate evaluations.
    pub profile_evaluations: Option<f64>,
}

/// Errors of one snapshot; null where nobody could judge.
#[derive(Debug, Clone, Serialize)]
pub struct SnapshotReport {
    /// Cycles.
    pub cycles: f64,
    /// Dimensionless time.
    pub tau: f64,
    /// Who judged volume and depth: `none`, `limit`, `gibson` or `reference`.
    pub judges: [&'static str; 2],
    /// Worn volume, m³.
    pub wear_volume: f64,
    /// That of the judge, m³.
    pub wear_volume_judge: f64,
    /// Error of the worn volume, or its bound.
    pub volume_error: f64,
    /// Error of the depth on common radii, or its bound.
    pub profile_error: f64,
    /// Error of the depth at its own radii, or its bound.
    pub node_error: f64,
    /// Which of the three are bounds.
    pub bounded: Option<[bool; 3]>,
}

impl SnapshotReport {
    fn new(errors: &Errors) -> Self {
        let three = [errors.volume, errors.profile, errors.nodes];
        Self {
            cycles: errors.cycles,
            tau: errors.tau,
            judges: errors.sources.map(Source::name),
            wear_volume: errors.wear_volume,
            wear_volume_judge: errors.wear_volume_judge,
            volume_error: errors.volume.value,
            profile_error: errors.profile.value,
            node_error: errors.nodes.value,
            bounded: (!errors.sources.contains(&Source::None)).then(|| three.map(|it| it.bounded)),
        }
    }
}

impl CandidateReport {
    fn new(row: &Row) -> Self {
        let cost = row.measurement.cost();
        let (springs, tolerance) = match row.candidate.choice {
            Choice::Hand { springs, tolerance } => (Some(springs), Some(tolerance)),
            Choice::Knob(_) => (cost.map(|it| it.springs), cost.map(|it| it.tolerance)),
        };
        let three = row.worst.map(|it| [it.volume, it.profile, it.nodes]);
        let [volume_time, profile_time, volume_evaluations, profile_evaluations] = row.over_front;
        let over_front = OverFront { volume_time, profile_time, volume_evaluations, profile_evaluations };
        Self {
            accuracy: row.candidate.accuracy(),
            stepper: row.candidate.stepper.name(),
            cycle: row.candidate.cycle.name(),
            springs,
            tolerance,
            status: row.measurement.name(),
            reason: Some(row.measurement.reason().to_owned()).filter(|why| !why.is_empty()),
            wall_seconds: cost.map(|it| it.wall_seconds),
            wall_seconds_file: cost.map(|it| it.wall_seconds_file),
            repeats: cost.map(|it| it.repeats),
            rate_evaluations: cost.map(|it| it.rate_evaluations),
            steps: cost.map(|it| it.steps),
            rejected_steps: cost.map(|it| it.rejected_steps),
            memory: cost.map(|it| it.memory),
            volume_error: three.map(|it| it[0].value),
            profile_error: three.map(|it| it[1].value),
            node_error: three.map(|it| it[2].value),
            bounded: three.map(|it| it.map(|error| error.bounded)),
            over_front: row.candidate.accuracy().map(|_| over_front),
            snapshots: row.errors.iter().map(SnapshotReport::new).collect(),
        }
    }
}

impl TradeoffReport {
    /// The summary of a trade-off that is done.
    pub fn new(outcome: &Outcome) -> Self {
        let reference = &outcome.reference;
        let [volume_time, profile_time, volume_evaluations, profile_evaluations] =
            FRONTS.each_ref().map(|front| places(front, &outcome.rows));
        Self {
            title: outcome.title.clone(),
            files: outcome.files.clone(),
            wall_seconds: outcome.wall_seconds,
            volume_scale: outcome.volume_scale,
            depth_scale: outcome.depth_scale,
            reference: ReferenceReport {
                springs: reference.springs,
                tolerance: reference.tolerance,
                wall_seconds: reference.wall_seconds,
                volume_uncertainty: reference.uncertainty[0],
                profile_uncertainty: reference.uncertainty[1],
            },
            fronts: Fronts { volume_time, profile_time, volume_evaluations, profile_evaluations },
            candidates: outcome.rows.iter().map(CandidateReport::new).collect(),
        }
    }

    /// Writes the object as `tradeoff.json` beside the other files, and lists it among them.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) if the file exists and `overwrite` is not given, or cannot be written.
    pub fn write(&mut self, folder: &Path, overwrite: bool) -> Result<()> {
        let path = folder.join(OBJECT);
        self.files.push(path.clone());
        TableFile::new(&path, overwrite)?.write(&json(self))
    }

    /// The fronts and the knob for people.
    pub fn text(&self, outcome: &Outcome) -> String {
        let mut text = self.title.as_ref().map_or(String::new(), |title| format!("{title}\n\n"));
        for front in &FRONTS {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "Front: {}\n{}", front.words, HEADER);
            for place in places(front, &outcome.rows) {
                line(&outcome.rows[place], "", &mut text);
            }
            text.push('\n');
        }
        let _ = writeln!(
            text,
            "The knob, and its wall time over that of the fronts of volume and profile\n{HEADER}"
        );
        for row in &outcome.rows {
            let Some(accuracy) = row.candidate.accuracy() else { continue };
            let times = |value: Option<f64>| value.map_or("beyond the front".into(), |it| format!("{it:.2}"));
            let [volume, profile, ..] = row.over_front;
            line(row, &format!("  {accuracy:e}: {}, {}", times(volume), times(profile)), &mut text);
        }
        text + "\n" + &self.rows()
    }

    fn rows(&self) -> String {
        let mut rows = Rows::default();
        let count = |status: &str| self.candidates.iter().filter(|it| it.status == status).count();
        let counts = ["done", "failed", "stopped", "skipped"].map(|it| format!("{} {it}", count(it)));
        rows.row("candidates", counts.join(", "));
        let reference = &self.reference;
        rows.row(
            "judged by the limit where reached, else by",
            format!(
                "{} springs, tolerance {}; uncertain by {:.1e} (volume), {:.1e} (profile)",
                reference.springs[0],
                number(reference.tolerance[0]),
                reference.volume_uncertainty,
                reference.profile_uncertainty
            ),
        );
        rows.row("wall time", Scale::TIME.show(self.wall_seconds));
        for file in &self.files {
            rows.row("written", file.display());
        }
        rows.finish()
    }
}

const HEADER: &str = "  stepper      cycle        springs  tolerance   wall time    with file  evaluations  volume error  profile error";

fn places(front: &Front, rows: &[Row]) -> Vec<usize> {
    let points = rows.iter().map(|row| match row.candidate.choice {
        Choice::Hand { .. } => front.point(row),
        Choice::Knob(_) => (f64::NAN, f64::NAN),
    });
    pareto_front(&points.collect::<Vec<_>>())
}

fn line(row: &Row, more: &str, text: &mut String) {
    let error = |it: Option<Measured>| {
        it.map_or("-".into(), |it| format!("{}{:.1e}", if it.bounded { "<" } else { "" }, it.value))
    };
    let Some(cost) = row.measurement.cost() else {
        let _ = writeln!(text, "  {}: {}{more}", row.measurement.name(), row.measurement.reason());
        return;
    };
    let time = |seconds: f64| format!("{:.1} ms", 1e3 * seconds);
    let _ = writeln!(
        text,
        "  {:<12} {:<12} {:>7}  {:>9.1e}  {:>10}  {:>11}  {:>11}  {:>12}  {:>13}{more}",
        row.candidate.stepper.name(),
        row.candidate.cycle.name(),
        cost.springs,
        cost.tolerance,
        time(cost.wall_seconds),
        time(cost.wall_seconds_file),
        cost.rate_evaluations,
        error(row.worst.map(|it| it.volume)),
        error(row.worst.map(|it| it.nodes)),
    );
}
