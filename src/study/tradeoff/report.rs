//! `fretwear tradeoff`: what accuracy costs, in fronts.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::files::{OBJECT, READINGS};
use super::{CandidateResult, Choice, Errors, FRONTS, Front, Measured, Outcome, ReferenceKind, pareto_front};
use crate::data::quantity::Entries;
use crate::error::Result;
use crate::report::{Scale, TableFile, TextTable, json, number};

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
    /// The finer runs, with which errors are measured where nothing else is known better.
    pub reference: ReferenceReport,
    /// The fronts by name; each a list of places in `candidates`, by rising cost.
    pub fronts: Entries<Vec<usize>>,
    /// All candidates.
    pub candidates: Vec<CandidateReport>,
}

/// The two finer runs, the finest first.
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

/// Keys of a candidate that are columns too.
const KEYS: &str = "accuracy stepper cycle springs tolerance status reason wall_seconds wall_seconds_file repeats \
                    rate_evaluations steps rejected_steps memory";

/// One candidate; what is not known is null.
#[derive(Debug, Clone, Serialize)]
pub struct CandidateReport {
    #[serde(flatten)]
    readings: Entries,
    /// Largest error of the worn volume over all snapshots, or its bound.
    volume_error: Option<f64>,
    /// Largest error of the depth on common radii, or its bound.
    profile_error: Option<f64>,
    /// Largest error of the depth at its own radii, or its bound.
    node_error: Option<f64>,
    /// Which of the three are bounds.
    bounded: Option<[bool; 3]>,
    /// Of what `accuracy` chose: its cost over that of the cheapest candidate by hand with at most its error, by front; null where no candidate by hand is as
    /// accurate.
    over_front: Option<Entries>,
    /// The snapshots after the start.
    snapshots: Vec<SnapshotReport>,
}

/// Errors of one snapshot; null where nothing is known.
#[derive(Debug, Clone, Serialize)]
struct SnapshotReport {
    cycles: f64,
    tau: f64,
    /// What volume and depth are compared with: `none`, `limit`, `gibson` or `reference`.
    references: [&'static str; 2],
    wear_volume: f64,
    wear_volume_reference: f64,
    volume_error: f64,
    profile_error: f64,
    node_error: f64,
    /// Which of the three are bounds.
    bounded: Option<[bool; 3]>,
}

impl SnapshotReport {
    fn new(errors: &Errors) -> Self {
        let three = [errors.volume, errors.profile, errors.nodes];
        Self {
            cycles: errors.cycles,
            tau: errors.tau,
            references: errors.sources.map(ReferenceKind::name),
            wear_volume: errors.wear_volume,
            wear_volume_reference: errors.wear_volume_reference,
            volume_error: errors.volume.value,
            profile_error: errors.profile.value,
            node_error: errors.nodes.value,
            bounded: (!errors.sources.contains(&ReferenceKind::None)).then(|| three.map(|it| it.bounded)),
        }
    }
}

impl CandidateReport {
    fn new(row: &CandidateResult) -> Self {
        let three = row.worst.map(|it| [it.volume, it.profile, it.nodes]);
        let over_fronts = || FRONTS.iter().zip(row.over_front).map(|(front, over)| (front.name, over.into()));
        Self {
            readings: Entries::some(&READINGS, row, KEYS),
            volume_error: three.map(|it| it[0].value),
            profile_error: three.map(|it| it[1].value),
            node_error: three.map(|it| it[2].value),
            bounded: three.map(|it| it.map(|error| error.bounded)),
            over_front: row.candidate.accuracy().map(|_| over_fronts().collect()),
            snapshots: row.errors.iter().map(SnapshotReport::new).collect(),
        }
    }
}

impl TradeoffReport {
    /// The summary of a trade-off that is done.
    pub fn new(outcome: &Outcome) -> Self {
        let reference = &outcome.reference;
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
            fronts: FRONTS.iter().map(|front| (front.name, places(front, &outcome.rows))).collect(),
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

    /// The fronts, and what `accuracy` chose, for people.
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
            "What accuracy chose, and its wall time over that of the fronts of volume and profile\n{HEADER}"
        );
        for row in &outcome.rows {
            let Some(accuracy) = row.candidate.accuracy() else { continue };
            let times = |value: Option<f64>| value.map_or("beyond the front".into(), |it| format!("{it:.2}"));
            let [volume, profile, ..] = row.over_front;
            line(row, &format!("  {accuracy:e}: {}, {}", times(volume), times(profile)), &mut text);
        }
        text + "\n" + &self.rows(&outcome.rows)
    }

    fn rows(&self, candidates: &[CandidateResult]) -> String {
        let mut rows = TextTable::default();
        let count = |status: &str| candidates.iter().filter(|it| it.measurement.name() == status).count();
        let counts = ["done", "failed", "stopped", "skipped"].map(|it| format!("{} {it}", count(it)));
        rows.row("candidates", counts.join(", "));
        let reference = &self.reference;
        rows.row(
            "compared with the limit where reached, else with",
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
        rows.text()
    }
}

const HEADER: &str = "  stepper      cycle        springs  tolerance   wall time    with file  evaluations  volume error  profile error";

fn places(front: &Front, rows: &[CandidateResult]) -> Vec<usize> {
    let points = rows.iter().map(|row| match row.candidate.choice {
        Choice::Hand { .. } => front.point(row),
        Choice::Accuracy(_) => (f64::NAN, f64::NAN),
    });
    pareto_front(&points.collect::<Vec<_>>())
}

fn line(row: &CandidateResult, more: &str, text: &mut String) {
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
