//! The file of a measured profile: two columns, radius and height.

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use super::document::printable;
use super::quantity::{Dimension, parse};
use crate::error::{Error, Result};
use crate::indenter::TabulatedProfile;

/// Size of the largest file read, bytes: [`TabulatedProfile::MOST_ROWS`] rows of 400 characters.
const LARGEST: u64 = 20_000_000;

/// A row as written in a line, and in SI.
#[derive(Clone, Copy)]
struct Row {
    line: usize,
    written: [f64; 2],
    radius: f64,
    height: f64,
}

/// Reads a profile; a warning is added where it does not begin at the height zero.
///
/// The columns stand apart by a comma, a semicolon, a tab or blanks. Lines before the first row that begin with no number are a header; empty
/// lines and what follows `#`, `%`, `//`, or `;` at the start of a line, are left out. The rows may come in any order.
///
/// # Arguments
/// * `path` -- the file
/// * `name` -- what the profile is called
/// * `units` -- of radius and of height, of lengths
///
/// # Errors
/// [`Error::File`] names the file, the line, what stands there and the cure.
pub(super) fn read(
    path: &Path,
    name: &str,
    units: [&str; 2],
    warnings: &mut Vec<String>,
) -> Result<TabulatedProfile> {
    let failed = |why: String| Error::File { path: path.to_owned(), why };
    let text = text_of(path).map_err(failed)?;
    let rows = rows(&text, units).map_err(failed)?;
    let (rows, tip) = from_the_tip(rows).map_err(failed)?;
    if tip != 0.0 {
        warnings.push(format!(
            "{}: f is {tip} at r = 0; that height is subtracted from every row, so that f(0) = 0",
            path.display()
        ));
    }
    let (radius, height) = rows.iter().map(|row| (row.radius, row.height)).unzip();
    TabulatedProfile::new(name, radius, height).map_err(|error| match error {
        Error::Inconsistent { why, .. } => failed(why),
        other => other,
    })
}

fn text_of(path: &Path) -> std::result::Result<String, String> {
    let reason = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => {
            "there is no such file; indenter.table.file is taken relative to the folder of the scene".into()
        }
        _ => format!("cannot be read: {error}"),
    };
    let found = fs::metadata(path).map_err(reason)?;
    if found.is_dir() {
        return Err("is a directory; name a file of two columns, r and f".into());
    }
    if !found.is_file() {
        return Err("is not a regular file; name a file of two columns, r and f".into());
    }
    let mut bytes = Vec::new();
    // One byte past the limit tells a file that is too large from one that just fits.
    File::open(path).and_then(|file| file.take(LARGEST + 1).read_to_end(&mut bytes)).map_err(reason)?;
    if bytes.len() as u64 > LARGEST {
        return Err(format!(
            "is larger than {LARGEST} bytes; a profile has two columns, and fewer rows will do"
        ));
    }
    if bytes.contains(&0) {
        return Err("is not text; save the profile as plain text in UTF-8 with two columns, r and f".into());
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..valid].iter().filter(|&&byte| byte == b'\n').count() + 1;
        format!("line {line} is not UTF-8 text; save the file in UTF-8")
    })
}

fn rows(text: &str, units: [&str; 2]) -> std::result::Result<Vec<Row>, String> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut rows: Vec<Row> = Vec::new();
    let mut header = None;
    for (number, full) in (1..).zip(text.lines()) {
        let line = without_comment(full);
        let fields = fields(line);
        let is_header = rows.is_empty() && fields.first().is_none_or(|field| !like_a_number(field));
        if line.is_empty() || is_header {
            header = header.or((!line.is_empty()).then_some((number, full)));
            continue;
        }
        if rows.len() == TabulatedProfile::MOST_ROWS {
            let most = TabulatedProfile::MOST_ROWS;
            return Err(format!("line {number}: there are more than {most} rows; give fewer, evenly spread"));
        }
        let shown = |why| format!("line {number}: \"{}\" {why}", printable(full.trim()));
        let written = row(line, &fields).map_err(shown)?;
        // Exactly: the power of ten of the unit is added before the number is read.
        let metres =
            |column: usize| parse(&format!("{} {}", fields[column], units[column]), Dimension::LENGTH);
        let [radius, height] = [metres(0), metres(1)];
        let (radius, height) = (radius.map_err(shown)? + 0.0, height.map_err(shown)?);
        rows.push(Row { line: number, written, radius, height });
    }
    match (rows.is_empty(), header) {
        (true, Some((line, text))) => Err(format!(
            "holds no row of two numbers, r and f; line {line} is \"{}\"",
            printable(text.trim())
        )),
        (true, None) => Err("is empty; give rows of two numbers, r and f".into()),
        (false, _) => Ok(rows),
    }
}

/// The line up to a comment.
fn without_comment(line: &str) -> &str {
    let end = ["#", "%", "//"].iter().filter_map(|mark| line.find(mark)).min().unwrap_or(line.len());
    let line = line[..end].trim();
    if line.starts_with(';') { "" } else { line }
}

/// The columns of a line, without the empty ones at its end.
fn fields(line: &str) -> Vec<&str> {
    let separator = [';', '\t', ','].into_iter().find(|separator| line.contains(*separator));
    let mut fields: Vec<&str> = match separator {
        Some(separator) => line.split(separator).map(|field| field.trim().trim_matches('"')).collect(),
        None => line.split_whitespace().map(|field| field.trim_matches('"')).collect(),
    };
    while fields.last().is_some_and(|field| field.is_empty()) {
        fields.pop();
    }
    fields
}

/// Whether a field is meant as a number, however badly written.
fn like_a_number(field: &str) -> bool {
    let digits = field.trim_start_matches(['+', '-', '.']);
    digits.starts_with(|c: char| c.is_ascii_digit()) || field.parse::<f64>().is_ok()
}

/// Radius and height of a row, in the units of the file.
fn row(line: &str, fields: &[&str]) -> std::result::Result<[f64; 2], String> {
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    let decimal_comma = |field: &str| {
        let field = field.trim_start_matches(['+', '-']);
        field
            .split_once(',')
            .is_some_and(|(whole, part)| digits(whole) && part.starts_with(|c: char| c.is_ascii_digit()))
    };
    let blanks: Vec<&str> = line.split_whitespace().collect();
    if fields.iter().any(|field| decimal_comma(field))
        || (blanks.len() == 2 && blanks.iter().all(|it| decimal_comma(it)))
    {
        return Err("has a decimal comma; write points, as in 0.5".into());
    }
    let [radius, height] = fields else {
        return Err(format!(
            "has {} column{}; a row is two numbers, r and f",
            fields.len(),
            if fields.len() == 1 { "" } else { "s" }
        ));
    };
    let number = |what: &str, field: &str| match field.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!(
            "has {what} = {}, which is not finite; remove the row or measure it again",
            printable(field)
        )),
        Err(_) => Err(format!(
            "has {what} = \"{}\", which is no number; a row is two numbers, r and f, and a comment begins with #",
            printable(field)
        )),
    };
    let row = [number("r", radius)?, number("f", height)?];
    if row[0] < 0.0 {
        return Err("has a negative radius; give one flank, from the tip at r = 0 outwards".into());
    }
    Ok(row)
}

/// The rows in order of the radius, each once, with heights from the tip; and the height of the tip as written.
fn from_the_tip(mut rows: Vec<Row>) -> std::result::Result<(Vec<Row>, f64), String> {
    rows.sort_by(|a, b| a.radius.total_cmp(&b.radius));
    let twice = |pair: &&[Row]| pair[0].radius == pair[1].radius && pair[0].height != pair[1].height;
    if let Some(pair) = rows.windows(2).find(twice) {
        let (first, second) =
            if pair[0].line < pair[1].line { (pair[0], pair[1]) } else { (pair[1], pair[0]) };
        return Err(format!(
            "lines {} and {} give the radius {} twice, with f = {} and f = {}; remove one",
            first.line, second.line, first.written[0], first.written[1], second.written[1]
        ));
    }
    rows.dedup_by(|a, b| a.radius == b.radius);
    let tip = rows[0];
    if tip.radius > 0.0 {
        return Err(format!(
            "begins at the radius {} (line {}); add a row for the tip, r = 0, from which f is measured",
            tip.written[0], tip.line
        ));
    }
    rows.iter_mut().for_each(|row| row.height -= tip.height);
    if let Some(row) = rows.iter().find(|row| row.height < 0.0) {
        return Err(format!(
            "line {}: at r = {} the profile has f = {}, below its tip at r = 0 with f = {} (line {}); put r = 0 at the lowest point, with f \
             growing outwards",
            row.line, row.written[0], row.written[1], tip.written[1], tip.line
        ));
    }
    Ok((rows, tip.written[1]))
}
