//! The files of `fretwear universality`: an HDF5 file with everything, and a table.

use std::path::{Path, PathBuf};

use super::{CURVE_POINTS, Judgement, Row};
use crate::data::layout::{Label, label};
use crate::data::{self, Array, ArrayFile, AtomicFile, Coordinate, Format, Mark, TextArray, TextColumn};
use crate::error::Result;
use crate::scene::UniversalityStudy;

const ARRAYS: &str = "universality.h5";
const TABLE: &str = "universality.csv";

const CASE: Label<'static> = label("case", "1", "number of the case in the study");
const POSITION: Label<'static> =
    label("position", "1", "distance from the stick radius over the width of the limit's worn annulus");

const WORDS: [TextColumn<Row>; 9] = [
    ("name", "name of the case", |row| &row.case.name),
    ("medium", "medium and indenter; empty where the study names none", |row| &row.case.levels[0]),
    ("wear", "law of wear; empty where the study names none", |row| &row.case.levels[1]),
    ("friction", "law of friction; empty where the study names none", |row| &row.case.levels[2]),
    ("mode", "mode of oscillation; empty where the study names none", |row| &row.case.levels[3]),
    ("predicted", "distance predicted: within or outside the tolerance", |row| row.case.predicted.name()),
    ("verdict", "distance found: obeys, violates, unclear or failed", |row| row.verdict.name()),
    ("stop_reason", "why the run ended", |row| row.end.as_ref().map_or("", |end| end.stop_reason.name())),
    ("error", "why a run failed; empty if it did not", |row| match (&row.end, &row.finer) {
        (Err(why), _) | (_, Some(Err(why))) => why,
        _ => "",
    }),
];

/// A column of numbers, not a number where there is none.
type Number = (Label<'static>, fn(&Row) -> f64);

const NUMBERS: [Number; 17] = [
    (label("agrees", "1", "1 where the verdict is as predicted"), |row| f64::from(u8::from(row.agrees()))),
    (
        label(
            "distance",
            "1",
            "largest difference of wear depth from the limit over the largest depth of the limit",
        ),
        |row| of(row, |end| end.distance.unwrap_or(f64::NAN)),
    ),
    (label("wear_volume", "m3", "worn volume at the end"), |row| of(row, |end| end.wear_volume)),
    (label("wear_volume_limit", "m3", "worn volume of the limit"), |row| {
        of(row, |end| end.wear_volume_limit)
    }),
    (label("wear_volume_ratio", "1", "worn volume over that of the limit"), |row| {
        of(row, |end| end.wear_volume / end.wear_volume_limit)
    }),
    (
        label(
            "wear_volume_relative",
            "1",
            "worn volume over squared contact radius times indentation of the first contact",
        ),
        |row| of(row, Judgement::wear_volume_relative),
    ),
    (label("wear_volume_limit_relative", "1", "worn volume of the limit over the same"), |row| {
        of(row, Judgement::wear_volume_limit_relative)
    }),
    (label("wear_depth_limit", "m", "largest wear depth of the limit"), |row| {
        of(row, |end| end.wear_depth_limit)
    }),
    (label("stick_radius", "m", "permanent stick radius, the smallest of the run"), |row| {
        of(row, |end| end.stick_radius)
    }),
    (label("stick_ratio", "1", "permanent stick radius over contact radius of the first contact"), |row| {
        of(row, Judgement::stick_ratio)
    }),
    (label("indentation", "m", "largest indentation of the run"), |row| of(row, |end| end.indentation)),
    (label("cycles", "1", "number of cycles at the end"), |row| of(row, |end| end.cycles)),
    (label("tau", "1", "dimensionless time at the end"), |row| of(row, |end| end.tau)),
    (label("finer_distance", "1", "distance with twice the springs and an eighth of the tolerance"), |row| {
        match &row.finer {
            Some(Ok(finer)) => finer.distance.unwrap_or(f64::NAN),
            _ => f64::NAN,
        }
    }),
    (label("finer_distance_change", "1", "finer distance less distance"), |row| {
        row.refinement().map_or(f64::NAN, |it| it[0])
    }),
    (
        label("finer_wear_volume_change", "1", "worn volume of the finer run over that of the run, less 1"),
        |row| row.refinement().map_or(f64::NAN, |it| it[1]),
    ),
    (label("wall_seconds", "s", "wall time of the run"), |row| of(row, |end| end.wall_seconds)),
];

fn of(row: &Row, number: impl Fn(&Judgement) -> f64) -> f64 {
    row.end.as_ref().map_or(f64::NAN, number)
}

/// Makes the directory if it is missing, and checks that both files can be written there; creates no file.
pub(super) fn check_folder(folder: &Path, overwrite: bool) -> Result<()> {
    let table = Mark::Words("name,medium,wear,friction,mode,predicted,verdict,");
    data::check_folder(folder, &[(ARRAYS, Mark::Results), (TABLE, table)], overwrite)
}

/// Writes both files, each as a whole or not at all; returns their paths.
pub(super) fn write(
    study: &UniversalityStudy,
    rows: &[Row],
    folder: &Path,
    overwrite: bool,
) -> Result<Vec<PathBuf>> {
    // Once more, for what has come in the time of the runs.
    check_folder(folder, overwrite)?;
    let [arrays, table] = [ARRAYS, TABLE].map(|name| folder.join(name));
    array_file(study, rows).write(&arrays, overwrite)?;
    AtomicFile::new(&table, overwrite)?.write(csv(rows).as_bytes())?;
    Ok(vec![arrays, table])
}

fn array_file(study: &UniversalityStudy, rows: &[Row]) -> ArrayFile {
    let index = |count: usize| (0..count).map(|number| number as f64);
    let last = (CURVE_POINTS - 1) as f64;
    let numbers = NUMBERS.iter().map(|(label, number)| Array {
        label: *label,
        axes: vec![CASE.name],
        values: rows.iter().map(number).collect(),
    });
    let curve = |name, long_name, of: fn(&Judgement) -> &Vec<f64>| Array {
        label: label(name, "1", long_name),
        axes: vec![CASE.name, POSITION.name],
        values: rows
            .iter()
            .flat_map(|row| {
                row.end.as_ref().map_or_else(|_| vec![f64::NAN; CURVE_POINTS], |end| of(end).clone())
            })
            .collect(),
    };
    let curves = [
        curve("profile_wear_depth", "wear depth at the end over the largest depth of the limit", |it| {
            &it.curve
        }),
        curve("profile_limit", "wear depth of the limit over its largest", |it| &it.curve_limit),
    ];
    let tolerances = study.tolerances();
    ArrayFile {
        format: Format::Universality,
        attributes: vec![
            ("title", study.title().unwrap_or_default().into()),
            ("study", study.text().into()),
            ("tolerance_within", tolerances.within.to_string()),
            ("tolerance_outside", tolerances.outside.to_string()),
        ],
        coordinates: vec![
            Coordinate { label: CASE, values: index(rows.len()).collect() },
            Coordinate { label: POSITION, values: index(CURVE_POINTS).map(|i| i / last).collect() },
        ],
        arrays: numbers.chain(curves).collect(),
        texts: TextArray::columns(&WORDS, rows, CASE.name),
    }
}

fn csv(rows: &[Row]) -> String {
    let names = WORDS.iter().map(|it| it.0).chain(NUMBERS.iter().map(|it| it.0.name));
    let cells = rows.iter().map(|row| {
        let words = WORDS.iter().map(|(_, _, word)| data::quoted(word(row)));
        words.chain(NUMBERS.iter().map(|(_, number)| data::cell(number(row)))).collect()
    });
    data::table(names, cells)
}
