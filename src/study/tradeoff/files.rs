//! The files of `fretwear tradeoff`: an HDF5 file with everything, and a table.

use std::path::{Path, PathBuf};

use super::{Cost, Errors, FRONTS, Measured, Outcome, Row, Source, Worst};
use crate::data::layout::{Label, label};
use crate::data::{self, Array, ArrayFile, AtomicFile, Coordinate, Format, Mark, TextArray, TextColumn};
use crate::error::Result;
use crate::scene::Scene;

const ARRAYS: &str = "tradeoff.h5";
const TABLE: &str = "tradeoff.csv";
/// Written by the report, which knows the keys.
pub const OBJECT: &str = "tradeoff.json";

const CANDIDATE: Label<'static> = label("candidate", "1", "number of the candidate");
const SNAPSHOT: Label<'static> =
    label("snapshot", "1", "number of the snapshot, from the first after the start");

const WORDS: [TextColumn<Row>; 4] = [
    ("stepper", "method of time stepping", |row| row.candidate.stepper.name()),
    ("cycle", "how a cycle is passed through: closed-form or resolved", |row| row.candidate.cycle.name()),
    ("status", "done, failed, stopped after the time allowed, or skipped as too costly", |row| {
        row.measurement.name()
    }),
    ("reason", "why it was not run to its end; empty if it was", |row| row.measurement.reason()),
];

/// A column of numbers, not a number where there is none.
type Number = (Label<'static>, fn(&Row) -> f64);

const NUMBERS: [Number; 16] = [
    (
        label(
            "accuracy",
            "1",
            "accuracy asked of the knob; not a number where springs and tolerance were given by hand",
        ),
        |row| row.candidate.accuracy().unwrap_or(f64::NAN),
    ),
    (label("springs", "1", "springs over the slip annulus, asked for or chosen"), |row| {
        asked(row, |springs, _| springs as f64, |cost| cost.springs as f64)
    }),
    (
        label("tolerance", "1", "tolerance of a step over the limit's largest depth, asked for or chosen"),
        |row| asked(row, |_, tolerance| tolerance, |cost| cost.tolerance),
    ),
    (label("wall_seconds", "s", "least wall time of a run in memory, setting up included"), |row| {
        cost(row, |it| it.wall_seconds)
    }),
    (label("wall_seconds_file", "s", "least wall time of a run with its result file"), |row| {
        cost(row, |it| it.wall_seconds_file)
    }),
    (label("repeats", "1", "runs of which the least time was taken"), |row| {
        cost(row, |it| it.repeats as f64)
    }),
    (label("rate_evaluations", "1", "evaluations of pressure, slip and wear"), |row| {
        cost(row, |it| it.rate_evaluations as f64)
    }),
    (label("steps", "1", "steps accepted"), |row| cost(row, |it| it.steps as f64)),
    (label("rejected_steps", "1", "steps rejected"), |row| cost(row, |it| it.rejected_steps as f64)),
    (label("memory", "byte", "memory of the operators, estimated"), |row| cost(row, |it| it.memory)),
    (
        label(
            "volume_error_max",
            "1",
            "largest error of the worn volume over all snapshots, over the volume of the limit",
        ),
        |row| worst(row, |it| it.volume.value),
    ),
    (
        label(
            "profile_error_max",
            "1",
            "largest error of the depth on common radii over all snapshots, over the largest depth of the limit",
        ),
        |row| worst(row, |it| it.profile.value),
    ),
    (label("node_error_max", "1", "the same at the radii of the candidate's own file"), |row| {
        worst(row, |it| it.nodes.value)
    }),
    (
        label(
            "volume_error_max_bounded",
            "1",
            "1 where that error is a bound: not clear of the uncertainty of its judge",
        ),
        |row| worst(row, |it| flag(it.volume.bounded)),
    ),
    (label("profile_error_max_bounded", "1", "the same of the depth on common radii"), |row| {
        worst(row, |it| flag(it.profile.bounded))
    }),
    (label("node_error_max_bounded", "1", "the same of the depth at own radii"), |row| {
        worst(row, |it| flag(it.nodes.bounded))
    }),
];

const WHO: &str =
    "who judged: 0 nobody, 1 the closed-form limit, 2 the Gibson transient, 3 the reference run";

/// A number of each snapshot.
type Series = (Label<'static>, fn(&Errors) -> f64);

const SERIES: [Series; 14] = [
    (label("cycles", "1", "number of cycles"), |it| it.cycles),
    (label("tau", "1", "dimensionless time"), |it| it.tau),
    (label("wear_volume", "m3", "worn volume"), |it| it.wear_volume),
    (label("wear_volume_judge", "m3", "worn volume of the judge"), |it| it.wear_volume_judge),
    (label("volume_judge", "1", WHO), |it| number_of(it.sources[0])),
    (label("profile_judge", "1", WHO), |it| number_of(it.sources[1])),
    (
        label("volume_uncertainty", "1", "uncertainty of the judge in the volume, over that of the limit"),
        |it| it.uncertainty[0],
    ),
    (
        label(
            "profile_uncertainty",
            "1",
            "uncertainty of the judge in the depth, over the largest of the limit",
        ),
        |it| it.uncertainty[1],
    ),
    (label("volume_error", "1", "error of the worn volume over the volume of the limit"), |it| {
        it.volume.value
    }),
    (
        label(
            "profile_error",
            "1",
            "largest error of the depth on common radii over the largest depth of the limit",
        ),
        |it| it.profile.value,
    ),
    (
        label(
            "node_error",
            "1",
            "largest error of the depth at the radii of the candidate's own file, likewise",
        ),
        |it| it.nodes.value,
    ),
    (label("volume_error_bounded", "1", "1 where the error of the volume is a bound"), |it| known(it.volume)),
    (label("profile_error_bounded", "1", "1 where the error on common radii is a bound"), |it| {
        known(it.profile)
    }),
    (label("node_error_bounded", "1", "1 where the error at own radii is a bound"), |it| known(it.nodes)),
];

/// On which fronts a candidate lies, and the knob's cost over theirs.
const FRONT_LABELS: [[Label<'static>; 2]; 4] = [
    [
        label("front_volume_time", "1", "1 on the front of volume error against wall time"),
        label(
            "knob_volume_time",
            "1",
            "wall time of the knob over that of the cheapest candidate with at most its volume error",
        ),
    ],
    [
        label("front_profile_time", "1", "1 on the front of profile error against wall time"),
        label("knob_profile_time", "1", "the same with the profile error"),
    ],
    [
        label("front_volume_evaluations", "1", "1 on the front of volume error against rate evaluations"),
        label(
            "knob_volume_evaluations",
            "1",
            "evaluations of the knob over those of the cheapest candidate with at most its volume error",
        ),
    ],
    [
        label("front_profile_evaluations", "1", "1 on the front of profile error against rate evaluations"),
        label("knob_profile_evaluations", "1", "the same with the profile error"),
    ],
];

fn asked(row: &Row, by_hand: impl Fn(usize, f64) -> f64, of_run: impl Fn(&Cost) -> f64) -> f64 {
    match row.candidate.choice {
        super::Choice::Hand { springs, tolerance } => by_hand(springs, tolerance),
        super::Choice::Knob(_) => cost(row, of_run),
    }
}

fn cost(row: &Row, number: impl Fn(&Cost) -> f64) -> f64 {
    row.measurement.cost().map_or(f64::NAN, number)
}

fn worst(row: &Row, number: impl Fn(&Worst) -> f64) -> f64 {
    row.worst.as_ref().map_or(f64::NAN, number)
}

fn flag(holds: bool) -> f64 {
    f64::from(u8::from(holds))
}

fn known(measured: Measured) -> f64 {
    if measured.value.is_nan() { f64::NAN } else { flag(measured.bounded) }
}

fn number_of(source: Source) -> f64 {
    Source::ALL.iter().position(|it| *it == source).unwrap_or(0) as f64
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
    array_file(scene, outcome).write(&arrays, overwrite)?;
    AtomicFile::new(&table, overwrite)?.write(csv(&outcome.rows).as_bytes())?;
    Ok(vec![arrays, table])
}

/// Every column of numbers with its values.
fn columns(rows: &[Row]) -> Vec<(Label<'static>, Vec<f64>)> {
    let mut columns: Vec<_> =
        NUMBERS.iter().map(|(label, number)| (*label, rows.iter().map(number).collect())).collect();
    for (place, [on, over]) in FRONT_LABELS.into_iter().enumerate() {
        debug_assert!(on.name.ends_with(FRONTS[place].name));
        columns.push((on, rows.iter().map(|row| flag(row.on_front[place])).collect()));
        columns.push((over, rows.iter().map(|row| row.over_front[place].unwrap_or(f64::NAN)).collect()));
    }
    columns
}

fn array_file(scene: &Scene, outcome: &Outcome) -> ArrayFile {
    let rows = &outcome.rows;
    let index = |count: usize| (0..count).map(|number| number as f64).collect();
    let snapshots = rows.iter().map(|row| row.errors.len()).max().unwrap_or(0).max(1);
    let numbers =
        columns(rows).into_iter().map(|(label, values)| Array { label, axes: vec![CANDIDATE.name], values });
    let series = SERIES.iter().map(|(label, number)| Array {
        label: *label,
        axes: vec![CANDIDATE.name, SNAPSHOT.name],
        values: rows
            .iter()
            .flat_map(|row| (0..snapshots).map(move |at| row.errors.get(at).map_or(f64::NAN, number)))
            .collect(),
    });
    let reference = &outcome.reference;
    let pair = |values: [f64; 2]| format!("{:e}, {:e}", values[0], values[1]);
    ArrayFile {
        format: Format::Tradeoff,
        attributes: vec![
            ("title", scene.title().unwrap_or_default().into()),
            ("scene", scene.text().into()),
            ("volume_scale", format!("{:e} m3", outcome.volume_scale)),
            ("depth_scale", format!("{:e} m", outcome.depth_scale)),
            ("reference_springs", reference.springs.map(|it| it.to_string()).join(", ")),
            ("reference_tolerance", pair(reference.tolerance)),
            ("reference_uncertainty", pair(reference.uncertainty)),
        ],
        coordinates: vec![
            Coordinate { label: CANDIDATE, values: index(rows.len()) },
            Coordinate { label: SNAPSHOT, values: index(snapshots) },
        ],
        arrays: numbers.chain(series).collect(),
        texts: TextArray::columns(&WORDS, rows, CANDIDATE.name),
    }
}

fn csv(rows: &[Row]) -> String {
    let columns = columns(rows);
    let names = WORDS.iter().map(|it| it.0).chain(columns.iter().map(|it| it.0.name));
    let cells = rows.iter().enumerate().map(|(place, row)| {
        let words = WORDS.iter().map(|(_, _, word)| data::quoted(word(row)));
        words.chain(columns.iter().map(|(_, values)| data::cell(values[place]))).collect()
    });
    data::table(names, cells)
}
