//! Files of measurements: columns with a header, as instruments, spreadsheets and people write them.
//!
//! Columns stand apart by a semicolon, a tab, a comma or blanks, whichever the header has. Where it is not the comma, a comma within a number is
//! a decimal comma. What follows `#`, and empty lines, are left out. A header may have units: `V [mm^3]` or `V (mm3)`.

use std::path::{Path, PathBuf};

use super::{DataSet, Deviation, Measured};
use crate::error::{Error, Result};
use crate::scene::columns::{LARGEST, without_comment};
use crate::scene::document::printable;
use crate::scene::input::{self, Pipes, Unread};
use crate::units::{Dimension, parse};

/// Most values of a data set.
const MOST_ROWS: usize = 100_000;

/// A column of a file, and the unit of its numbers where one is known.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Column {
    place: usize,
    name: String,
    pub(super) unit: Option<String>,
}

impl Column {
    /// The column with a unit, which its header must not contradict.
    pub(super) fn in_unit(self, unit: &str) -> std::result::Result<Self, String> {
        match self.unit.as_deref() {
            Some(own) if own != unit => {
                Err(format!("is not {own}, which the header of {} says; remove one of the two", self.name))
            }
            _ => Ok(Self { unit: Some(unit.to_owned()), ..self }),
        }
    }

    /// The column with a unit where its header has none.
    pub(super) fn or_in_unit(self, unit: Option<&str>) -> Self {
        Self { unit: self.unit.or(unit.map(str::to_owned)), ..self }
    }

    /// A number of the column in SI.
    fn number(&self, field: &str, dimension: Dimension) -> std::result::Result<f64, String> {
        match &self.unit {
            Some(unit) => parse(&format!("{field} {unit}"), dimension),
            None => field.parse().map_err(|_| String::from("is no number")),
        }
    }

    /// Its unit in SI.
    pub(super) fn scale(&self, dimension: Dimension) -> std::result::Result<f64, String> {
        self.number("1", dimension)
    }
}

/// The rows of a file.
pub(super) struct Measurements {
    path: PathBuf,
    header: Vec<(String, Option<String>)>,
    /// Line and fields.
    rows: Vec<(usize, Vec<String>)>,
}

impl Measurements {
    /// Reads a file.
    ///
    /// # Arguments
    /// * `filter` -- `column = text`: the rows that are taken
    ///
    /// # Errors
    /// [`Error::File`] names the file, the line and the cure.
    pub(super) fn read(path: &Path, filter: Option<&str>) -> Result<Self> {
        let table = text_of(path).and_then(|text| Self::of_text(path, &text));
        let table = table.and_then(|table| match filter {
            Some(filter) => table.filtered(filter),
            None => Ok(table),
        });
        table.map_err(|why| Error::File { path: path.to_owned(), why })
    }

    fn of_text(path: &Path, text: &str) -> std::result::Result<Self, String> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let lines = (1..).zip(text.lines().map(without_comment)).filter(|(_, line)| !line.is_empty());
        let mut lines = lines.peekable();
        let (number, head) =
            lines.next().ok_or("is empty; the first line names the columns, as in \"N,V\"")?;
        let separator = [';', '\t', ','].into_iter().find(|it| head.contains(*it));
        let header: Vec<_> = fields(head, separator).iter().map(|name| named(name)).collect();
        if header.iter().all(|(name, _)| name.parse::<f64>().is_ok()) {
            return Err(format!(
                "line {number}: \"{}\" holds numbers where the names of columns belong; begin the file with a line such as \"N,V [mm^3]\"",
                printable(head)
            ));
        }
        for (place, (name, _)) in header.iter().enumerate() {
            if !name.is_empty() && header[..place].iter().any(|(other, _)| other == name) {
                return Err(format!(
                    "line {number}: the column \"{}\" is there twice; rename one",
                    printable(name)
                ));
            }
        }
        let mut rows = vec![];
        for (number, line) in lines {
            let mut found = fields(line, separator);
            while found.len() > header.len() && found.last().is_some_and(String::is_empty) {
                found.pop();
            }
            if found.len() != header.len() {
                return Err(format!(
                    "line {number}: \"{}\" has {} fields, and the header {}; give each column one, and texts with the separator in quotes",
                    printable(line),
                    found.len(),
                    header.len()
                ));
            }
            if rows.len() == MOST_ROWS {
                return Err(format!("line {number}: there are more than {MOST_ROWS} rows; give fewer"));
            }
            if separator != Some(',') {
                found.iter_mut().for_each(decimal_point);
            }
            rows.push((number, found));
        }
        Ok(Self { path: path.to_owned(), header, rows })
    }

    /// The rows with a text in a column.
    fn filtered(mut self, filter: &str) -> std::result::Result<Self, String> {
        let (name, wanted) = filter
            .split_once('=')
            .ok_or(format!("where = {filter:?} is not of the form \"column = text\""))?;
        let place = self.column(name.trim()).map_err(|why| format!("where = {filter:?} {why}"))?.place;
        self.rows.retain(|(_, fields)| fields[place] == wanted.trim());
        Ok(self)
    }

    /// The column of a name, which may have a unit in brackets.
    ///
    /// # Errors
    /// The cure: which columns there are.
    pub(super) fn column(&self, asked: &str) -> std::result::Result<Column, String> {
        let (name, unit) = named(asked.trim());
        let whole = |(other, unit): &(String, Option<String>)| match unit {
            Some(unit) => format!("{other} [{unit}]"),
            None => other.clone(),
        };
        let place = self.header.iter().position(|(other, _)| *other == name);
        let Some(place) = place.filter(|_| !name.is_empty()) else {
            let names: Vec<String> =
                self.header.iter().map(|it| printable(&whole(it)).into_owned()).collect();
            let shown = names[..names.len().min(20)].join(", ");
            return Err(format!("is no column of {}; there are {shown}", self.path.display()));
        };
        let column = Column { place, name, unit: self.header[place].1.clone() };
        unit.map_or(Ok(column.clone()), |unit| column.in_unit(&unit))
    }

    /// The numbers of some columns in SI, with the lines of their rows; how many rows are left out because one of them is missing.
    ///
    /// # Errors
    /// [`Error::File`] names the line, what stands there and the cure.
    pub(super) fn numbers(
        &self,
        columns: &[(Column, Dimension)],
    ) -> Result<(Vec<usize>, Vec<Vec<f64>>, usize)> {
        let (mut lines, mut numbers) = (vec![], vec![vec![]; columns.len()]);
        for (line, fields) in &self.rows {
            if columns.iter().any(|(column, _)| fields[column.place].is_empty()) {
                continue;
            }
            for ((column, dimension), numbers) in columns.iter().zip(&mut numbers) {
                let field = &fields[column.place];
                let number = column.number(field, *dimension).and_then(|it| match it.is_finite() {
                    true => Ok(it),
                    false => Err("is not finite; remove the row or measure it again".into()),
                });
                let wrong =
                    |why| self.wrong(*line, format!("{} = \"{}\": {why}", column.name, printable(field)));
                numbers.push(number.map_err(wrong)?);
            }
            lines.push(*line);
        }
        let left_out = self.rows.len() - lines.len();
        match lines.is_empty() {
            true => Err(Error::File {
                path: self.path.clone(),
                why: "holds no row with numbers in the columns asked for; look at the names of columns and at where".into(),
            }),
            false => Ok((lines, numbers, left_out)),
        }
    }

    fn wrong(&self, line: usize, why: String) -> Error {
        Error::File { path: self.path.clone(), why: format!("line {line}: {why}") }
    }

    /// Refuses measurements that cannot be.
    ///
    /// # Errors
    /// [`Error::File`] names the line and the cure.
    pub(super) fn check(&self, set: &DataSet) -> Result<()> {
        let is_place = matches!(set.measured, Measured::Scar | Measured::Loop);
        for (place, line) in set.lines.iter().enumerate() {
            if !is_place && set.at[place] < 0.0 {
                let what = if set.measured.is_over_cycles() { "a number of cycles" } else { "an energy" };
                return Err(
                    self.wrong(*line, format!("{what} is below zero; remove the row or measure it again"))
                );
            }
            if let Deviation::Known(all) = &set.deviation
                && all[place] <= 0.0
            {
                return Err(self
                    .wrong(*line, "the deviation is not above zero; give what the value is good to".into()));
            }
            let is_relative = matches!(set.deviation, Deviation::Relative(_) | Deviation::EstimatedRelative);
            if is_relative && (set.at[place] == 0.0 || is_place) {
                let cure = "a relative deviation says nothing where nothing is predicted; give deviation instead, or remove the row";
                return Err(self.wrong(*line, cure.into()));
            }
        }
        if !is_place && set.at.iter().all(|it| *it == 0.0) {
            let why = "tells nothing: all values stand at zero; measure after some cycles".into();
            return Err(Error::File { path: self.path.clone(), why });
        }
        Ok(())
    }
}

fn text_of(path: &Path) -> std::result::Result<String, String> {
    let refused = |unread: Unread| {
        let cure = match unread {
            Unread::TooLarge(_) => "give fewer rows",
            Unread::NotText(_) => "save the file in UTF-8",
            _ => "name a file of columns with a header",
        };
        format!("{unread}; {cure}")
    };
    let bytes = input::bytes(path, LARGEST, Pipes::Refused).map_err(refused)?;
    if bytes.contains(&0) {
        return Err(
            "is not text; save the measurements as plain text in UTF-8 with columns and a header".into()
        );
    }
    input::text(bytes).map_err(refused)
}

/// Name and unit of `V [mm^3]` or `V (mm3)`.
fn named(text: &str) -> (String, Option<String>) {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, rest)) = text.split_once(open)
            && let Some(unit) = rest.trim_end().strip_suffix(close)
            && !name.trim().is_empty()
            && !unit.trim().is_empty()
        {
            return (name.trim().into(), Some(unit.trim().into()));
        }
    }
    (text.trim().into(), None)
}

/// The fields of a line; what stands in quotes or brackets is one.
fn fields(line: &str, separator: Option<char>) -> Vec<String> {
    let mut found = vec![String::new()];
    let (mut quoted, mut depth) = (false, 0usize);
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            '[' | '(' if separator.is_none() && !quoted => depth += 1,
            ']' | ')' if separator.is_none() && !quoted => depth = depth.saturating_sub(1),
            _ => {}
        }
        let parts = separator.map_or(c.is_whitespace(), |it| it == c);
        let last = found.last_mut().expect("it begins with one");
        match parts && !quoted && depth == 0 {
            true => found.push(String::new()),
            false if c != '"' => last.push(c),
            false => {}
        }
    }
    let mut found: Vec<String> = found.into_iter().map(|field| field.trim().to_owned()).collect();
    if separator.is_none() {
        found.retain(|field| !field.is_empty());
        // A unit belongs to the name before it.
        for place in (1..found.len()).rev() {
            if found[place].starts_with(['[', '(']) {
                let unit = found.remove(place);
                found[place - 1] = format!("{} {unit}", found[place - 1]);
            }
        }
    }
    found
}

/// Writes a decimal comma as a point.
fn decimal_point(field: &mut String) {
    let is_number = field.bytes().all(|byte| byte.is_ascii_digit() || b"+-eE,".contains(&byte));
    if is_number && field.matches(',').count() == 1 {
        *field = field.replace(',', ".");
    }
}
