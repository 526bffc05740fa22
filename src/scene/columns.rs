//! Files of columns: text with one row of numbers a line, as instruments and spreadsheets write it.

use std::ops::RangeInclusive;
use std::path::Path;

use super::document::printable;
use super::input::{self, Pipes, Unread};
use crate::error::{Error, Result};
use crate::units::{Dimension, parse};

/// Size of the largest file read, bytes: a million rows of a hundred characters.
pub(super) const LARGEST: u64 = 100_000_000;

/// What stands in a file, for the reader and for its messages.
pub(super) struct Kind<'a> {
    /// Key of the scene that names the file.
    pub key: &'static str,
    /// What it describes, with its article: `a profile`.
    pub what: &'static str,
    /// How many columns, in words, and which: `two`, `r and f`.
    pub columns: [&'static str; 2],
    /// Names of the columns.
    pub names: &'a [&'static str],
    /// Units of the columns, of lengths.
    pub units: &'a [&'a str],
    /// Fewest columns of a row, the most being all names.
    pub fewest: usize,
    /// Most rows.
    pub most_rows: usize,
    /// What more a row must satisfy, in the units of the file.
    pub check: fn(&[f64]) -> std::result::Result<(), String>,
}

/// A row as written in a line, and in m.
#[derive(Clone)]
pub(super) struct Row {
    pub line: usize,
    pub written: Vec<f64>,
    pub metres: Vec<f64>,
}

/// Reads the rows of a file, at least one, all with the same number of columns.
///
/// The columns stand apart by a comma, a semicolon, a tab or blanks. Lines before the first row that begin with no number are a header; empty
/// lines and what follows `#`, `%`, `//`, or `;` at the start of a line, are left out.
///
/// # Errors
/// [`Error::File`] names the file, the line, what stands there and the cure.
pub(super) fn read(path: &Path, kind: &Kind) -> Result<Vec<Row>> {
    let failed = |why: String| Error::File { path: path.to_owned(), why };
    let text = kind.text_of(path).map_err(failed)?;
    kind.rows(&text).map_err(failed)
}

impl Kind<'_> {
    /// `two columns, r and f`.
    fn columns(&self) -> String {
        format!("{} columns, {}", self.columns[0], self.columns[1])
    }

    /// `two numbers, r and f`.
    fn numbers(&self) -> String {
        format!("{} numbers, {}", self.columns[0], self.columns[1])
    }

    fn widths(&self) -> RangeInclusive<usize> {
        self.fewest..=self.names.len()
    }

    fn text_of(&self, path: &Path) -> std::result::Result<String, String> {
        let refused = |unread: Unread| {
            let cure = match unread {
                Unread::Missing => format!("{} is taken relative to the folder of the scene", self.key),
                Unread::TooLarge(_) => {
                    format!("{} has {} columns, and fewer rows will do", self.what, self.columns[0])
                }
                Unread::NotText(_) => "save the file in UTF-8".into(),
                _ => format!("name a file of {}", self.columns()),
            };
            format!("{unread}; {cure}")
        };
        let bytes = input::bytes(path, LARGEST, Pipes::Refused).map_err(refused)?;
        if bytes.contains(&0) {
            let name = self.what.rsplit(' ').next().unwrap_or_default();
            return Err(format!(
                "is not text; save the {name} as plain text in UTF-8 with {}",
                self.columns()
            ));
        }
        input::text(bytes).map_err(refused)
    }

    fn rows(&self, text: &str) -> std::result::Result<Vec<Row>, String> {
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
            if rows.len() == self.most_rows {
                let most = self.most_rows;
                return Err(format!(
                    "line {number}: there are more than {most} rows; give fewer, evenly spread"
                ));
            }
            let shown = |why| format!("line {number}: \"{}\" {why}", printable(full.trim()));
            let written = self.row(line, &fields).map_err(shown)?;
            let width = rows.first().map_or(written.len(), |first| first.written.len());
            if written.len() != width {
                return Err(shown(format!(
                    "has {} columns, and the first row {width}; give all rows the same",
                    written.len()
                )));
            }
            // Exactly: the power of ten of the unit is added before the number is read. Zero loses its sign.
            let metres = |(field, unit): (&&str, &&str)| {
                parse(&format!("{field} {unit}"), Dimension::LENGTH).map(|it| it + 0.0)
            };
            let metres = fields.iter().zip(self.units).map(metres).collect::<std::result::Result<_, _>>();
            rows.push(Row { line: number, written, metres: metres.map_err(shown)? });
        }
        match (rows.is_empty(), header) {
            (true, Some((line, text))) => Err(format!(
                "holds no row of {}; line {line} is \"{}\"",
                self.numbers(),
                printable(text.trim())
            )),
            (true, None) => Err(format!("is empty; give rows of {}", self.numbers())),
            (false, _) => Ok(rows),
        }
    }

    /// The numbers of a row, in the units of the file.
    fn row(&self, line: &str, fields: &[&str]) -> std::result::Result<Vec<f64>, String> {
        let blanks: Vec<&str> = line.split_whitespace().collect();
        if fields.iter().any(|field| has_decimal_comma(field))
            || (self.widths().contains(&blanks.len()) && blanks.iter().all(|it| has_decimal_comma(it)))
        {
            return Err("has a decimal comma; write points, as in 0.5".into());
        }
        if !self.widths().contains(&fields.len()) {
            return Err(format!(
                "has {} column{}; a row is {}",
                fields.len(),
                if fields.len() == 1 { "" } else { "s" },
                self.numbers()
            ));
        }
        let number = |(what, field): (&&str, &&str)| match field.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(_) => Err(format!(
                "has {what} = {}, which is not finite; remove the row or measure it again",
                printable(field)
            )),
            Err(_) => Err(format!(
                "has {what} = \"{}\", which is no number; a row is {}, and a comment begins with #",
                printable(field),
                self.numbers()
            )),
        };
        let row: Vec<f64> =
            self.names.iter().zip(fields).map(number).collect::<std::result::Result<_, _>>()?;
        (self.check)(&row)?;
        Ok(row)
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

fn has_decimal_comma(field: &str) -> bool {
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    let field = field.trim_start_matches(['+', '-']);
    field
        .split_once(',')
        .is_some_and(|(whole, part)| digits(whole) && part.starts_with(|c: char| c.is_ascii_digit()))
}
