//! The files of `fretwear tradeoff`: an HDF5 file with everything, and a table.

use std::path::{Path, PathBuf};

use super::{CandidateResult, Choice, Cost, Errors, Measured, Outcome, Worst};
use crate::data::quantity::{Quantity, Reading, Value, csv, number, quantity, word};
use crate::data::{self, AtomicFile, Dataset, Format, Mark, Variable};
use crate::error::Result;
use crate::scene::Scene;

const ARRAYS: &str = "tradeoff.h5";
const TABLE: &str = "tradeoff.csv";
/// Written by the report, which knows the keys.
pub(super) const OBJECT: &str = "tradeoff.json";

const CANDIDATE: Quantity = quantity("candidate", "1", "number of the candidate");
const SNAPSHOT: Quantity =
    quantity("snapshot", "1", "number of the snapshot, from the first after the start");

/// All that is told of a candidate, in the order of columns.
pub(super) const READINGS: [Reading<CandidateResult>; 28] = [
    word("stepper", "method of time stepping", |row| row.candidate.stepper.name().into()),
    word("cycle", "how a cycle is passed through: closed-form or resolved", |row| {
        row.candidate.cycle.name().into()
    }),
    word("status", "done, failed, stopped after the time allowed, or skipped as too costly", |row| {
        row.measurement.name().into()
    }),
    word("reason", "why it was not run to its end; empty if it was", |row| {
        Some(row.measurement.reason()).filter(|why| !why.is_empty()).into()
    }),
    number(
        "accuracy",
        "1",
        "accuracy asked for; not a number where springs and tolerance were given by hand",
        |row| row.candidate.accuracy().into(),
    ),
    number("springs", "1", "springs over the slip annulus, asked for or chosen", |row| {
        match row.candidate.choice {
            Choice::Hand { springs, .. } => springs.into(),
            Choice::Accuracy(_) => cost(row, |it| it.springs),
        }
    }),
    number(
        "tolerance",
        "1",
        "tolerance of a step over the limit's largest depth, asked for or chosen",
        |row| match row.candidate.choice {
            Choice::Hand { tolerance, .. } => tolerance.into(),
            Choice::Accuracy(_) => cost(row, |it| it.tolerance),
        },
    ),
    number("wall_seconds", "s", "least wall time of a run in memory, setting up included", |row| {
        cost(row, |it| it.wall_seconds)
    }),
    number("wall_seconds_file", "s", "least wall time of a run with its result file", |row| {
        cost(row, |it| it.wall_seconds_file)
    }),
    number("repeats", "1", "runs of which the least time was taken", |row| cost(row, |it| it.repeats)),
    number("rate_evaluations", "1", "evaluations of pressure, slip and wear", |row| {
        cost(row, |it| it.rate_evaluations)
    }),
    number("steps", "1", "steps accepted", |row| cost(row, |it| it.steps)),
    number("rejected_steps", "1", "steps rejected", |row| cost(row, |it| it.rejected_steps)),
    number("memory", "byte", "memory of the operators, estimated", |row| cost(row, |it| it.memory)),
    number(
        "volume_error_max",
        "1",
        "largest error of the worn volume over all snapshots, over the volume of the limit",
        |row| worst(row, |it| it.volume.value),
    ),
    number(
        "profile_error_max",
        "1",
        "largest error of the depth on common radii over all snapshots, over the largest depth of the limit",
        |row| worst(row, |it| it.profile.value),
    ),
    number("node_error_max", "1", "the same at the radii of the candidate's own file", |row| {
        worst(row, |it| it.nodes.value)
    }),
    number(
        "volume_error_max_bounded",
        "1",
        "1 where that error is a bound: not clear of the uncertainty of its reference",
        |row| worst(row, |it| it.volume.bounded),
    ),
    number("profile_error_max_bounded", "1", "the same of the depth on common radii", |row| {
        worst(row, |it| it.profile.bounded)
    }),
    number("node_error_max_bounded", "1", "the same of the depth at own radii", |row| {
        worst(row, |it| it.nodes.bounded)
    }),
    // On which of the fronts it lies, and the cost of what `accuracy` chose over theirs.
    number("front_volume_time", "1", "1 on the front of volume error against wall time", |row| {
        row.on_front[0].into()
    }),
    number(
        "chosen_volume_time",
        "1",
        "wall time of what accuracy chose over that of the cheapest candidate with at most its volume error",
        |row| row.over_front[0].into(),
    ),
    number("front_profile_time", "1", "1 on the front of profile error against wall time", |row| {
        row.on_front[1].into()
    }),
    number("chosen_profile_time", "1", "the same with the profile error", |row| row.over_front[1].into()),
    number(
        "front_volume_evaluations",
        "1",
        "1 on the front of volume error against rate evaluations",
        |row| row.on_front[2].into(),
    ),
    number(
        "chosen_volume_evaluations",
        "1",
        "evaluations of what accuracy chose over those of the cheapest candidate with at most its volume error",
        |row| row.over_front[2].into(),
    ),
    number(
        "front_profile_evaluations",
        "1",
        "1 on the front of profile error against rate evaluations",
        |row| row.on_front[3].into(),
    ),
    number("chosen_profile_evaluations", "1", "the same with the profile error", |row| {
        row.over_front[3].into()
    }),
];

const WHO: &str = "what the error is measured against: 0 nothing, 1 the closed-form limit, 2 the Gibson transient, 3 the reference run";

/// All that is told of a candidate at a snapshot.
const AT_SNAPSHOTS: [Reading<Errors>; 14] = [
    number("cycles", "1", "number of cycles", |it| it.cycles.into()),
    number("tau", "1", "dimensionless time", |it| it.tau.into()),
    number("wear_volume", "m3", "worn volume", |it| it.wear_volume.into()),
    number("wear_volume_reference", "m3", "worn volume of the reference", |it| {
        it.wear_volume_reference.into()
    }),
    number("volume_reference", "1", WHO, |it| (it.sources[0] as usize).into()),
    number("profile_reference", "1", WHO, |it| (it.sources[1] as usize).into()),
    number(
        "volume_uncertainty",
        "1",
        "uncertainty of the reference in the volume, over that of the limit",
        |it| it.uncertainty[0].into(),
    ),
    number(
        "profile_uncertainty",
        "1",
        "uncertainty of the reference in the depth, over the largest of the limit",
        |it| it.uncertainty[1].into(),
    ),
    number("volume_error", "1", "error of the worn volume over the volume of the limit", |it| {
        it.volume.value.into()
    }),
    number(
        "profile_error",
        "1",
        "largest error of the depth on common radii over the largest depth of the limit",
        |it| it.profile.value.into(),
    ),
    number(
        "node_error",
        "1",
        "largest error of the depth at the radii of the candidate's own file, likewise",
        |it| it.nodes.value.into(),
    ),
    number("volume_error_bounded", "1", "1 where the error of the volume is a bound", |it| {
        bounded(it.volume)
    }),
    number("profile_error_bounded", "1", "1 where the error on common radii is a bound", |it| {
        bounded(it.profile)
    }),
    number("node_error_bounded", "1", "1 where the error at own radii is a bound", |it| bounded(it.nodes)),
];

/// What it cost; nothing where it was not run to its end.
fn cost<T: Into<Value>>(row: &CandidateResult, of: impl Fn(&Cost) -> T) -> Value {
    row.measurement.cost().map(of).into()
}

fn worst<T: Into<Value>>(row: &CandidateResult, of: impl Fn(&Worst) -> T) -> Value {
    row.worst.as_ref().map(of).into()
}

fn bounded(measured: Measured) -> Value {
    Some(measured.bounded).filter(|_| !measured.value.is_nan()).into()
}

/// Makes the directory if it is missing, and checks that all files can be written there; creates no file.
pub(super) fn check_folder(folder: &Path, overwrite: bool) -> Result<()> {
    let (table, object) = (Mark::Words("stepper,cycle,status,reason,"), Mark::Words("\"volume_scale\":"));
    data::check_folder(folder, &[(ARRAYS, Mark::Results), (TABLE, table), (OBJECT, object)], overwrite)
}

/// Writes both files, each as a whole or not at all; returns their paths.
pub(super) fn write(
    scene: &Scene,
    outcome: &Outcome,
    folder: &Path,
    overwrite: bool,
) -> Result<Vec<PathBuf>> {
    // Once more, for what has come in the time of the runs.
    check_folder(folder, overwrite)?;
    let [arrays, table] = [ARRAYS, TABLE].map(|name| folder.join(name));
    dataset(scene, outcome).write(&arrays, overwrite)?;
    AtomicFile::new(&table, overwrite)?.write(csv(&READINGS, &outcome.rows).as_bytes())?;
    Ok(vec![arrays, table])
}

fn dataset(scene: &Scene, outcome: &Outcome) -> Dataset {
    let rows = &outcome.rows;
    let index = |count: usize| (0..count).map(|number| number as f64).collect::<Vec<_>>();
    let snapshots = rows.iter().map(|row| row.errors.len()).max().unwrap_or(0).max(1);
    let reference = &outcome.reference;
    let pair = |values: [f64; 2]| format!("{:e}, {:e}", values[0], values[1]);
    let mut dataset = Dataset::of(
        Format::Tradeoff,
        &[
            ("title", scene.title().unwrap_or_default().into()),
            ("scene", scene.text().into()),
            ("volume_scale", format!("{:e} m3", outcome.volume_scale)),
            ("depth_scale", format!("{:e} m", outcome.depth_scale)),
            ("reference_springs", reference.springs.map(|it| it.to_string()).join(", ")),
            ("reference_tolerance", pair(reference.tolerance)),
            ("reference_uncertainty", pair(reference.uncertainty)),
        ],
    );
    dataset.coordinate(CANDIDATE, index(rows.len()));
    dataset.coordinate(SNAPSHOT, index(snapshots));
    let (numbers, words): (Vec<_>, Vec<_>) =
        READINGS.iter().map(|it| it.variable(CANDIDATE.name, rows)).partition(Variable::is_numeric);
    dataset.variables.extend(numbers);
    let plane = [(CANDIDATE.name, rows.len()), (SNAPSHOT.name, snapshots)];
    for reading in &AT_SNAPSHOTS {
        let of = |row: &CandidateResult, at: usize| row.errors.get(at).map_or(Value::Missing, reading.of);
        let values = rows.iter().flat_map(|row| (0..snapshots).map(move |at| of(row, at)));
        dataset.add(Variable::new(reading.quantity, &plane, Value::all(values, reading.is_word)));
    }
    dataset.variables.extend(words);
    dataset
}
