//! Numbers as people read them, and tables of two columns.

use std::fmt::Write;

use crate::data::quantity::{Reading, Value};
pub(crate) use crate::units::{Scale, number};

/// Width of the names in a table.
const WIDTH: usize = 34;

/// Lines of a name and a value, for people.
#[derive(Debug, Default)]
pub(crate) struct TextTable {
    title: Option<String>,
    /// Both are empty at a gap; the value alone at a heading.
    pub lines: Vec<(String, String)>,
}

impl TextTable {
    /// Begins with a title, if there is one.
    pub(crate) fn titled(title: Option<&str>) -> Self {
        Self { title: title.map(str::to_owned), lines: vec![] }
    }

    pub(crate) fn row(&mut self, name: &str, value: impl std::fmt::Display) {
        self.lines.push((name.to_owned(), value.to_string()));
    }

    /// A row whose value may have no meaning.
    pub(crate) fn optional(&mut self, name: &str, value: Option<String>) {
        self.row(name, value.as_deref().unwrap_or("none"));
    }

    /// A row of what was read off a record.
    pub(crate) fn reading<R>(&mut self, reading: &Reading<R>, record: &R) {
        self.optional(reading.heading, shown(&(reading.of)(record), reading.quantity.units));
    }

    pub(crate) fn gap(&mut self) {
        self.lines.push(Default::default());
    }

    pub(crate) fn text(&self) -> String {
        let mut text = self.title.as_ref().map_or(String::new(), |title| format!("{title}\n\n"));
        for (name, value) in &self.lines {
            // Writing to a string cannot fail.
            let _ = match name.as_str() {
                "" => writeln!(text),
                name => writeln!(text, "{name:<WIDTH$} {value}"),
            };
        }
        text
    }
}

/// A value with its unit; none where there is none.
pub(crate) fn shown(value: &Value, units: &str) -> Option<String> {
    Some(match value {
        Value::Number(value) => match (Scale::of(units), units) {
            (Some(scale), _) => scale.show(*value),
            (None, "1") => number(*value),
            (None, units) => format!("{} {units}", number(*value)),
        },
        Value::Count(count) => count.to_string(),
        Value::Truth(holds) => if *holds { "yes" } else { "no" }.to_owned(),
        Value::Word(word) => word.clone(),
        Value::Missing => return None,
    })
}
