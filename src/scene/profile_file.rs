//! The file of a measured profile: two columns, radius and height.

use std::path::Path;

use super::columns::{self, Kind, Row};
use crate::contact::indenter::TabulatedProfile;
use crate::error::{Error, Result};

/// Reads a profile; a warning is added where it does not begin at the height zero. The rows may come in any order.
///
/// # Arguments
/// * `path` -- the file, as [`columns::read`] takes it
/// * `name` -- what the profile is called
/// * `units` -- of radius and of height, of lengths
/// * `deviation` -- standard deviation of the heights, m, with which they are smoothed; 0 takes them as they are
///
/// # Errors
/// [`Error::File`] names the file, the line, what stands there and the cure; [`Error::Inconsistent`] names the deviation if that is at fault.
pub(super) fn read(
    path: &Path,
    name: &str,
    units: [&str; 2],
    deviation: f64,
    warnings: &mut Vec<String>,
) -> Result<TabulatedProfile> {
    let failed = |why: String| Error::File { path: path.to_owned(), why };
    let kind = Kind {
        key: "indenter.table.file",
        what: "a profile",
        columns: ["two", "r and f"],
        names: &["r", "f"],
        units: &units,
        fewest: 2,
        most_rows: TabulatedProfile::MOST_ROWS,
        check: |row| match row[0] < 0.0 {
            true => Err("has a negative radius; give one flank, from the tip at r = 0 outwards".into()),
            false => Ok(()),
        },
    };
    let (rows, tip) = from_the_tip(columns::read(path, &kind)?, deviation > 0.0).map_err(failed)?;
    // A smoothed profile has its tip where the curve has it.
    if tip != 0.0 && deviation == 0.0 {
        warnings.push(format!(
            "{}: f is {tip} at r = 0; that height is subtracted from every row, so that f(0) = 0",
            path.display()
        ));
    }
    let (radius, height) = rows.iter().map(|row| (row.metres[0], row.metres[1])).unzip();
    TabulatedProfile::smoothed(name, radius, height, deviation).map_err(|error| match error {
        Error::Inconsistent { what: "indenter.table", why } => failed(why),
        other => other,
    })
}

/// The rows in order of the radius, each once, with heights from the tip; and the height of the tip as written. Noisy ones may lie below it.
fn from_the_tip(mut rows: Vec<Row>, noisy: bool) -> std::result::Result<(Vec<Row>, f64), String> {
    let radius = |row: &Row| row.metres[0];
    rows.sort_by(|a, b| radius(a).total_cmp(&radius(b)));
    let twice =
        |pair: &&[Row]| radius(&pair[0]) == radius(&pair[1]) && pair[0].metres[1] != pair[1].metres[1];
    if let Some(pair) = rows.windows(2).find(twice) {
        let (first, second) =
            if pair[0].line < pair[1].line { (&pair[0], &pair[1]) } else { (&pair[1], &pair[0]) };
        return Err(format!(
            "lines {} and {} give the radius {} twice, with f = {} and f = {}; remove one",
            first.line, second.line, first.written[0], first.written[1], second.written[1]
        ));
    }
    rows.dedup_by(|a, b| radius(a) == radius(b));
    let tip = rows[0].clone();
    if radius(&tip) > 0.0 {
        return Err(format!(
            "begins at the radius {} (line {}); add a row for the tip, r = 0, from which f is measured",
            tip.written[0], tip.line
        ));
    }
    rows.iter_mut().for_each(|row| row.metres[1] -= tip.metres[1]);
    if let Some(row) = rows.iter().find(|row| row.metres[1] < 0.0).filter(|_| !noisy) {
        return Err(format!(
            "line {}: at r = {} the profile has f = {}, below its tip at r = 0 with f = {} (line {}); put r = 0 at the lowest point, with f \
             growing outwards; if that is noise, give the standard deviation of the heights as {}",
            row.line,
            row.written[0],
            row.written[1],
            tip.written[1],
            tip.line,
            TabulatedProfile::SMOOTHING
        ));
    }
    Ok((rows, tip.written[1]))
}
