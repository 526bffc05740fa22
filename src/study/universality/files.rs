//! The files of `fretwear universality`: an HDF5 file with everything, and a table.

use std::path::{Path, PathBuf};

use super::{CURVE_POINTS, CaseResult, Judgement};
use crate::data::quantity::{Quantity, Reading, Value, csv, number, quantity, word};
use crate::data::{self, AtomicFile, Dataset, Format, Mark, Variable};
use crate::error::Result;
use crate::scene::UniversalityStudy;

const ARRAYS: &str = "universality.h5";
const TABLE: &str = "universality.csv";

const CASE: Quantity = quantity("case", "1", "number of the case in the study");
const POSITION: Quantity =
    quantity("position", "1", "distance from the stick radius over the width of the limit's worn annulus");

/// All that is told of a case, in the order of columns.
pub(super) const READINGS: [Reading<CaseResult>; 26] = [
    word("name", "name of the case", |row| row.case.name.as_str().into()),
    word("medium", "medium and indenter; empty where the study names none", |row| level(row, 0)),
    word("wear", "law of wear; empty where the study names none", |row| level(row, 1)),
    word("friction", "law of friction; empty where the study names none", |row| level(row, 2)),
    word("mode", "mode of oscillation; empty where the study names none", |row| level(row, 3)),
    word("predicted", "distance predicted: within or outside the tolerance", |row| {
        row.case.predicted.name().into()
    }),
    word("verdict", "distance found: obeys, violates, unclear or failed", |row| row.verdict.name().into()),
    word("stop_reason", "why the run ended", |row| at_end(row, |end| end.stop_reason.name())),
    word("error", "why a run failed; empty if it did not", |row| row.error().into()),
    number("agrees", "1", "1 where the verdict is as predicted", |row| row.agrees().into()),
    number(
        "distance",
        "1",
        "largest difference of wear depth from the limit over the largest depth of the limit",
        |row| at_end(row, |end| end.distance),
    ),
    number("wear_volume", "m3", "worn volume at the end", |row| at_end(row, |end| end.wear_volume)),
    number("wear_volume_limit", "m3", "worn volume of the limit", |row| {
        at_end(row, |end| end.wear_volume_limit)
    }),
    number("wear_volume_ratio", "1", "worn volume over that of the limit", |row| {
        at_end(row, |end| end.wear_volume / end.wear_volume_limit)
    }),
    number(
        "wear_volume_relative",
        "1",
        "worn volume over squared contact radius times indentation of the first contact",
        |row| at_end(row, Judgement::wear_volume_relative),
    ),
    number("wear_volume_limit_relative", "1", "worn volume of the limit over the same", |row| {
        at_end(row, Judgement::wear_volume_limit_relative)
    }),
    number("wear_depth_limit", "m", "largest wear depth of the limit", |row| {
        at_end(row, |end| end.wear_depth_limit)
    }),
    number("stick_radius", "m", "permanent stick radius, the smallest of the run", |row| {
        at_end(row, |end| end.stick_radius)
    }),
    number("stick_ratio", "1", "permanent stick radius over contact radius of the first contact", |row| {
        at_end(row, Judgement::stick_ratio)
    }),
    number("indentation", "m", "largest indentation of the run", |row| at_end(row, |end| end.indentation)),
    number("cycles", "1", "number of cycles at the end", |row| at_end(row, |end| end.cycles)),
    number("tau", "1", "dimensionless time at the end", |row| at_end(row, |end| end.tau)),
    number("finer_distance", "1", "distance with twice the springs and an eighth of the tolerance", |row| {
        match &row.finer {
            Some(Ok(finer)) => finer.distance.into(),
            _ => Value::Missing,
        }
    }),
    number("finer_distance_change", "1", "finer distance less distance", |row| {
        row.refinement().map(|it| it[0]).into()
    }),
    number(
        "finer_wear_volume_change",
        "1",
        "worn volume of the finer run over that of the run, less 1",
        |row| row.refinement().map(|it| it[1]).into(),
    ),
    number("wall_seconds", "s", "wall time of the run", |row| at_end(row, |end| end.wall_seconds)),
];

/// Name of a level of a case; none where the study names none.
fn level(row: &CaseResult, which: usize) -> Value {
    Some(row.case.levels[which].as_str()).filter(|name| !name.is_empty()).into()
}

/// What the end of a run tells; nothing if it failed.
fn at_end<T: Into<Value>>(row: &CaseResult, of: impl Fn(&Judgement) -> T) -> Value {
    row.end.as_ref().ok().map(of).into()
}

/// Makes the directory if it is missing, and checks that both files can be written there; creates no file.
pub(super) fn check_folder(folder: &Path, overwrite: bool) -> Result<()> {
    let table = Mark::Words("name,medium,wear,friction,mode,predicted,verdict,");
    data::check_folder(folder, &[(ARRAYS, Mark::Results), (TABLE, table)], overwrite)
}

/// Writes both files, each as a whole or not at all; returns their paths.
pub(super) fn write(
    study: &UniversalityStudy,
    rows: &[CaseResult],
    folder: &Path,
    overwrite: bool,
) -> Result<Vec<PathBuf>> {
    // Once more, for what has come in the time of the runs.
    check_folder(folder, overwrite)?;
    let [arrays, table] = [ARRAYS, TABLE].map(|name| folder.join(name));
    dataset(study, rows).write(&arrays, overwrite)?;
    AtomicFile::new(&table, overwrite)?.write(csv(&READINGS, rows).as_bytes())?;
    Ok(vec![arrays, table])
}

fn dataset(study: &UniversalityStudy, rows: &[CaseResult]) -> Dataset {
    let index = |count: usize| (0..count).map(|number| number as f64);
    let last = (CURVE_POINTS - 1) as f64;
    let tolerances = study.tolerances();
    let mut dataset = Dataset::of(
        Format::Universality,
        &[
            ("title", study.title().unwrap_or_default().into()),
            ("study", study.text().into()),
            ("tolerance_within", tolerances.within.to_string()),
            ("tolerance_outside", tolerances.outside.to_string()),
        ],
    );
    dataset.coordinate(CASE, index(rows.len()).collect::<Vec<_>>());
    dataset.coordinate(POSITION, index(CURVE_POINTS).map(|i| i / last).collect::<Vec<_>>());
    let (numbers, words): (Vec<_>, Vec<_>) =
        READINGS.iter().map(|it| it.variable(CASE.name, rows)).partition(Variable::is_numeric);
    dataset.variables.extend(numbers);
    let mut curve = |name, long_name, of: fn(&Judgement) -> &Vec<f64>| {
        let of = |row: &CaseResult| {
            row.end.as_ref().map_or_else(|_| vec![f64::NAN; CURVE_POINTS], |end| of(end).clone())
        };
        let values: Vec<f64> = rows.iter().flat_map(of).collect();
        let plane = [(CASE.name, rows.len()), (POSITION.name, CURVE_POINTS)];
        dataset.add(Variable::new(quantity(name, "1", long_name), &plane, values));
    };
    curve("profile_wear_depth", "wear depth at the end over the largest depth of the limit", |it| &it.curve);
    curve("profile_limit", "wear depth of the limit over its largest", |it| &it.curve_limit);
    dataset.variables.extend(words);
    dataset
}
