//! Files of columns: text with one row of numbers a line, as instruments and spreadsheets write it.

use std::ops::RangeInclusive;
use std::path::Path;

use super::document::{Section, printable};
use super::input::{self, Pipes, Unread};
use crate::error::{Error, Result};
use crate::laws::entry::{Columns, File, Row};
use crate::units::{Dimension, Key, Table, parse};

/// Size of the largest file read, bytes: a million rows of a hundred characters.
pub(super) const LARGEST: u64 = 100_000_000;

/// Reads the file that the key `file` of a table names, if it is to be read; all rows have the same number of columns.
///
/// The columns stand apart by a comma, a semicolon, a tab or blanks. Lines before the first row that begin with no number are a header; empty
/// lines and what follows `#`, `%`, `//`, or `;` at the start of a line, are left out.
///
/// # Arguments
/// * `folder` -- that of the scene; none where the rows are stored
///
/// # Errors
/// [`Error::File`] names the file, the line, what stands there and the cure.
pub(super) fn read(
    section: &Section,
    table: &Table,
    columns: &Columns,
    folder: Option<&Path>,
) -> Result<Option<File>> {
    let key = |name: &str| table.key(name).expect("columns are given by keys of their table");
    let name = match section.read(key("file"))? {
        "" => return Err(section.required_key(key("file"))?.error("is no name of a file")),
        name => name,
    };
    let units = columns.units.iter().map(|unit| length_unit(section, key(unit))).collect::<Result<_>>()?;
    let Some(folder) = folder else { return Ok(None) };
    let path = folder.join(name);
    if !path.exists() {
        let why = "there is no such file; it is taken relative to the folder of the scene";
        return Err(section.at_key("file", format_args!(": {}: {why}", path.display())));
    }
    let kind = Kind { columns, key: section.name("file"), units };
    let rows = kind.text_of(&path).and_then(|text| kind.rows(&text));
    match rows {
        Ok(rows) => Ok(Some(File { path, name: name.into(), rows })),
        Err(why) => Err(Error::File { path, why }),
    }
}

/// A unit of length.
fn length_unit<'a>(section: &Section<'a>, key: &Key) -> Result<&'a str> {
    let unit: &str = section.read(key)?;
    match (parse(&format!("1 {unit}"), Dimension::LENGTH), section.optional(key.name)) {
        (Err(why), Some(entry)) => {
            Err(entry.explained(why + "; give a unit of length alone, such as \"um\""))
        }
        _ => Ok(unit),
    }
}

/// What stands in a file, and how a scene gives it.
struct Kind<'a> {
    columns: &'a Columns,
    /// Key of the scene that names the file.
    key: String,
    /// Units of the columns, of lengths.
    units: Vec<&'a str>,
}

impl Kind<'_> {
    /// `two columns, r and f`.
    fn columns(&self) -> String {
        format!("{} columns, {}", self.columns.count, self.columns.listed)
    }

    /// `two numbers, r and f`.
    fn numbers(&self) -> String {
        format!("{} numbers, {}", self.columns.count, self.columns.listed)
    }

    fn widths(&self) -> RangeInclusive<usize> {
        self.columns.fewest..=self.columns.names.len()
    }

    fn text_of(&self, path: &Path) -> std::result::Result<String, String> {
        let refused = |unread: Unread| {
            let cure = match unread {
                Unread::Missing => format!("{} is taken relative to the folder of the scene", self.key),
                Unread::TooLarge(_) => {
                    format!(
                        "{} has {} columns, and fewer rows will do",
                        self.columns.what, self.columns.count
                    )
                }
                Unread::NotText(_) => "save the file in UTF-8".into(),
                _ => format!("name a file of {}", self.columns()),
            };
            format!("{unread}; {cure}")
        };
        let bytes = input::bytes(path, LARGEST, Pipes::Refused).map_err(refused)?;
        if bytes.contains(&0) {
            let name = self.columns.what.rsplit(' ').next().unwrap_or_default();
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
            if rows.len() == self.columns.most_rows {
                let most = self.columns.most_rows;
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
            let metres = fields.iter().zip(&self.units).map(metres).collect::<std::result::Result<_, _>>();
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
            self.columns.names.iter().zip(fields).map(number).collect::<std::result::Result<_, _>>()?;
        (self.columns.check)(&row)?;
        Ok(row)
    }
}

/// The line up to a comment.
pub(super) fn without_comment(line: &str) -> &str {
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
