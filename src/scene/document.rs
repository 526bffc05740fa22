//! A TOML document walked by hand: every key and value knows its place, so that every error can show it.

use std::borrow::Cow;
use std::fmt::{Display, Write};
use std::ops::Range;

use serde_spanned::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{Error, Result, most_alike};
use crate::units::{self, Dimension, Table};

/// The text of a document and its name in messages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) name: &'a str,
    pub(super) text: &'a str,
    /// What it describes: `a scene`.
    pub(super) kind: &'static str,
}

impl<'a> Source<'a> {
    /// Parses the text.
    pub(super) fn parse(self) -> Result<Spanned<DeTable<'a>>> {
        DeTable::parse(self.text).map_err(|error| self.not_toml(&error))
    }

    /// The values of the text without their places, to be laid over others.
    pub(super) fn values(self) -> Result<toml::Table> {
        self.text.parse().map_err(|error| self.not_toml(&error))
    }

    fn not_toml(&self, error: &toml::de::Error) -> Error {
        let end = self.text.len();
        self.error(error.span().unwrap_or(end..end), format_args!("not valid TOML: {}", error.message()))
    }

    /// An error that shows its line, with carets under the span.
    ///
    /// ```text
    /// scene.toml:5:11: half_space.grading = 1.5 is outside (-1, 1)
    ///   |
    /// 5 | grading = 1.5
    ///   |           ^^^
    /// ```
    pub(super) fn error(&self, span: Range<usize>, message: impl Display) -> Error {
        // A window of the line around the span: a line may be as long as the file.
        const BEFORE: usize = 100;
        const AFTER: usize = 120;
        let start = floor(self.text, span.start);
        let line_start = self.text[..start].rfind('\n').map_or(0, |at| at + 1);
        let line_end = self.text[start..].find(['\n', '\r']).map_or(self.text.len(), |at| start + at);
        let number = self.text[..line_start].bytes().filter(|&b| b == b'\n').count() + 1;
        let column = self.text[line_start..start].chars().count() + 1;

        let from = floor(self.text, start.saturating_sub(BEFORE)).max(line_start);
        let to = floor(self.text, start + AFTER).clamp(start, line_end);
        let end = floor(self.text, span.end).clamp(start, to);
        let visible = |c: char| if c.is_control() { ' ' } else { c };
        let cut = |cut: bool| if cut { "..." } else { "" };
        let window: String = self.text[from..to].chars().map(visible).collect();
        let shown = format!("{}{}{}", cut(from > line_start), window.trim_end(), cut(to < line_end));
        let indent = self.text[from..start].chars().count() + cut(from > line_start).len();
        let carets = self.text[start..end].chars().count().max(1);
        let gutter = number.to_string().len();

        let mut text = format!("{}:{number}:{column}: {message}\n", self.name);
        let _ = writeln!(text, "{:gutter$} |", "");
        let _ = writeln!(text, "{number} | {shown}");
        let _ = write!(text, "{:gutter$} | {:indent$}{:^<carets$}", "", "", "");
        Error::scene(text)
    }

    /// An error that something is missing, shown where it could be added: at the end.
    pub(super) fn missing(&self, message: impl Display) -> Error {
        let end = self.text.trim_end().len();
        self.error(end..end, message)
    }

    /// An error that concerns no line.
    pub(super) fn unplaced(&self, message: impl Display) -> Error {
        Error::scene(format!("{}: {message}", self.name))
    }
}

/// The nearest character boundary at or before a byte offset.
fn floor(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// A key or a value fit for a message: short, without control characters.
pub(super) fn printable(text: &str) -> Cow<'_, str> {
    const LONGEST: usize = 60;
    if text.len() <= LONGEST && !text.chars().any(char::is_control) {
        return Cow::Borrowed(text);
    }
    let mut shown: String =
        text.chars().take(LONGEST).map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
    if text.chars().nth(LONGEST).is_some() {
        shown.push_str("...");
    }
    Cow::Owned(shown)
}

/// A table of the document.
#[derive(Debug, Clone)]
pub(super) struct Section<'a> {
    source: Source<'a>,
    path: String,
    /// Where the table is named; None for the document itself.
    place: Option<Range<usize>>,
    table: &'a DeTable<'a>,
}

impl<'a> Section<'a> {
    /// The document itself.
    pub(super) fn root(source: Source<'a>, table: &'a DeTable<'a>) -> Self {
        Self { source, path: String::new(), place: None, table }
    }

    /// The dotted name of a key in this table.
    pub(super) fn name(&self, key: &str) -> String {
        match self.path.is_empty() {
            true => printable(key).into_owned(),
            false => format!("{}.{}", self.path, printable(key)),
        }
    }

    /// An error about the table as a whole, shown at its name.
    pub(super) fn error(&self, message: impl Display) -> Error {
        match &self.place {
            Some(place) => self.source.error(place.clone(), message).about(&self.path),
            None => self.source.missing(message),
        }
    }

    /// An error about a key that is not there, shown at the name of the table.
    ///
    /// # Arguments
    /// * `message` -- what follows the name of the key
    pub(super) fn absent(&self, key: &str, message: impl Display) -> Error {
        let name = self.name(key);
        self.error(format_args!("{name} {message}")).about(&name)
    }

    /// Shows what is wrong with a key at its value, or at the innermost table in which it is missing.
    ///
    /// # Arguments
    /// * `key` -- its dotted name, from this table on
    /// * `message` -- what follows its name
    pub(super) fn at_key(&self, key: &str, message: impl Display) -> Error {
        let mut section = self.clone();
        let name = self.name(key);
        for part in key.split('.') {
            let Some(entry) = section.optional(part) else { break };
            match entry.section() {
                Ok(inner) => section = inner,
                Err(_) => {
                    return self.source.error(entry.place, format_args!("{name}{message}")).about(&name);
                }
            }
        }
        let message = format!("{name}{message}");
        match section.place {
            Some(place) => self.source.error(place, message).about(&name),
            None => self.source.unplaced(message).about(&name),
        }
    }

    /// Refuses the first key that a table does not have.
    pub(super) fn only_of(&self, table: &Table) -> Result<()> {
        let strangers = self.table.keys().filter(|key| table.key(key.get_ref()).is_none());
        let Some(first) = strangers.min_by_key(|key| key.span().start) else { return Ok(()) };
        let stranger: &str = first.get_ref();
        let cure = match table.keys.iter().find(|key| key.aliases.contains(&stranger)) {
            Some(key) => format!("did you mean {}?", key.name),
            None => suggestion(stranger, &table.keys.iter().map(|key| key.name).collect::<Vec<_>>()),
        };
        let name = self.name(stranger);
        let message = format!("{name} is not a key of {}; {cure}", self.source.kind);
        Err(self.source.error(first.span(), message).about(&name))
    }

    /// Names of keys of this table: `a, b or c`.
    pub(super) fn listed(&self, keys: &[&str]) -> String {
        listed(keys.iter().map(|key| self.name(key)))
    }

    /// The value of a key, if given.
    pub(super) fn optional(&self, key: &str) -> Option<Entry<'a>> {
        let (name, value) = self.table.get_key_value(key)?;
        Some(Entry {
            source: self.source,
            path: self.name(key),
            key_place: name.span(),
            place: value.span(),
            value: value.get_ref(),
        })
    }

    /// The value of a key that must be there.
    pub(super) fn required(&self, key: &str, cure: &str) -> Result<Entry<'a>> {
        self.optional(key).ok_or_else(|| self.absent(key, format_args!("is missing; {cure}")))
    }

    /// The one key given of several that exclude each other, and its value.
    pub(super) fn one_of(&self, alternatives: &[&'static str]) -> Result<(&'static str, Entry<'a>)> {
        self.at_most_one_of(alternatives)?.ok_or_else(|| {
            self.error(format_args!("give exactly one of {}; none is there", self.listed(alternatives)))
        })
    }

    /// As [`Section::one_of`] where none may be given.
    pub(super) fn at_most_one_of(
        &self,
        alternatives: &[&'static str],
    ) -> Result<Option<(&'static str, Entry<'a>)>> {
        let mut given: Vec<_> =
            alternatives.iter().filter_map(|&key| self.optional(key).map(|entry| (key, entry))).collect();
        given.sort_by_key(|(_, entry)| entry.key_place.start);
        if let [(_, first), (_, second), ..] = &given[..] {
            return Err(second.excludes(first, &self.listed(alternatives)));
        }
        Ok(given.pop())
    }

    /// Shows an error of the library, which names a quantity as `table.key`, at that key of this table.
    pub(super) fn locate(&self, error: Error) -> Error {
        match error {
            Error::OutOfRange { name, value, range } => {
                let key = name.rsplit('.').next().unwrap_or(name);
                match self.optional(key) {
                    Some(entry) => entry.outside(range),
                    None => self.absent(key, format_args!("= {value} is outside {range}")),
                }
            }
            other => self.error(other),
        }
    }
}

/// `a, b or c`.
fn listed(names: impl Iterator<Item = String>) -> String {
    let names: Vec<_> = names.collect();
    match &names[..] {
        [one] => one.clone(),
        [most @ .., last] => format!("{} or {last}", most.join(", ")),
        [] => String::new(),
    }
}

/// The nearest of the known words, or all of them.
fn suggestion(word: &str, known: &[&str]) -> String {
    match nearest_key(word, known) {
        Some((likeness, candidate)) if likeness > 0.8 => format!("did you mean {candidate}?"),
        _ if known.len() == 1 => format!("this version offers {} only", known[0]),
        _ => format!("this version offers {}", listed(known.iter().map(|key| key.to_string()))),
    }
}

/// The nearest of words that are too many to be listed.
pub(super) fn nearest(word: &str, known: &[&str]) -> String {
    nearest_key(word, known).map_or(String::new(), |(_, candidate)| format!("did you mean {candidate}?"))
}

/// As [`most_alike`]; none for a long word, which would cost the square of its length and is near to nothing.
fn nearest_key<'a>(word: &str, known: &[&'a str]) -> Option<(f64, &'a str)> {
    if word.len() <= 60 { most_alike(word, known) } else { None }
}

/// A key and its value.
#[derive(Debug, Clone)]
pub(super) struct Entry<'a> {
    source: Source<'a>,
    path: String,
    key_place: Range<usize>,
    place: Range<usize>,
    value: &'a DeValue<'a>,
}

impl<'a> Entry<'a> {
    /// An error shown under the value: `half_space.grading = 1.5 is outside (-1, 1)` for the message `is outside (-1, 1)`.
    pub(super) fn error(&self, message: impl Display) -> Error {
        let value = printable(self.source.text.get(self.place.clone()).unwrap_or_default());
        self.at(&self.place, format_args!(" = {value} {message}"))
    }

    /// An error shown at a place: the key, and what follows it.
    fn at(&self, place: &Range<usize>, message: impl Display) -> Error {
        self.source.error(place.clone(), format_args!("{}{message}", self.path)).about(&self.path)
    }

    /// The error that the value lies outside a range.
    pub(super) fn outside(&self, range: &str) -> Error {
        self.error(format_args!("is outside {range}"))
    }

    /// An error shown under the key: what is wrong with its being there.
    pub(super) fn misplaced(&self, message: impl Display) -> Error {
        self.at(&self.key_place, format_args!(" {message}"))
    }

    /// The error that the key has no place beside another.
    pub(super) fn without_meaning_beside(&self, other: &Entry) -> Error {
        self.misplaced(format_args!("has no meaning beside {}; remove one of the two", other.path))
    }

    /// The error that one of several keys alone may be given; `other` was given before.
    pub(super) fn excludes(&self, other: &Entry, choice: &str) -> Error {
        let message = format!("{} and {} exclude each other; give one of {choice}", other.path, self.path);
        self.source.error(self.key_place.clone(), message).about(&self.path)
    }

    /// Where the value stands.
    pub(super) fn place(&self) -> Range<usize> {
        self.place.clone()
    }

    /// Dotted name.
    pub(super) fn path(&self) -> &str {
        &self.path
    }

    fn wrong_type(&self, wanted: impl Display) -> Error {
        let found = match self.value {
            DeValue::String(_) => "a string",
            DeValue::Integer(_) => "an integer",
            DeValue::Float(_) => "a number",
            DeValue::Boolean(_) => "a boolean",
            DeValue::Datetime(_) => "a date",
            DeValue::Array(_) => "an array",
            DeValue::Table(_) => "a table",
        };
        // A table has no text of its own to show.
        let place = if matches!(self.value, DeValue::Table(_)) { &self.key_place } else { &self.place };
        self.at(place, format_args!(": {wanted}, found {found}"))
    }

    /// Whether the value is a table.
    pub(super) fn is_table(&self) -> bool {
        matches!(self.value, DeValue::Table(_))
    }

    /// Whether the value is an array.
    pub(super) fn is_array(&self) -> bool {
        matches!(self.value, DeValue::Array(_))
    }

    /// The value as it stands.
    pub(super) fn literal(&self) -> Result<toml::Value> {
        let text = self.source.text.get(self.place.clone()).unwrap_or_default();
        let mut table: toml::Table =
            format!("value = {text}").parse().map_err(|_| self.error("is no value"))?;
        table.remove("value").ok_or_else(|| self.error("is no value"))
    }

    /// The value as a table.
    pub(super) fn section(&self) -> Result<Section<'a>> {
        match self.value {
            DeValue::Table(table) => Ok(Section {
                source: self.source,
                path: self.path.clone(),
                place: Some(self.key_place.clone()),
                table,
            }),
            _ => Err(self.wrong_type(format_args!("expected a table [{}]", self.path))),
        }
    }

    /// The value as a string.
    pub(super) fn string(&self) -> Result<&'a str> {
        self.text().ok_or_else(|| self.wrong_type("expected a string"))
    }

    /// The string that the value is; None for another.
    pub(super) fn text(&self) -> Option<&'a str> {
        if let DeValue::String(text) = self.value { Some(text) } else { None }
    }

    /// The value as `true` or `false`.
    pub(super) fn boolean(&self) -> Result<bool> {
        match self.value {
            DeValue::Boolean(value) => Ok(*value),
            _ => Err(self.wrong_type("expected true or false")),
        }
    }

    /// The value as one word of a list, by its position there.
    pub(super) fn word(&self, words: &[&str]) -> Result<usize> {
        let word = self.string()?;
        let found = words.iter().position(|known| *known == word);
        found.ok_or_else(|| self.error(format_args!("is not allowed here; {}", suggestion(word, words))))
    }

    /// The value as a whole number; None for one that is negative or too large.
    pub(super) fn whole_number(&self) -> Result<Option<usize>> {
        let DeValue::Integer(integer) = self.value else {
            return Err(self.wrong_type("expected a whole number"));
        };
        Ok(usize::from_str_radix(integer.as_str(), integer.radix()).ok())
    }

    /// The value as a whole number in a range.
    pub(super) fn whole(&self, range: std::ops::RangeInclusive<usize>) -> Result<usize> {
        let number = self.whole_number()?;
        let shown = || match *range.end() {
            usize::MAX => format!("[{}, inf)", range.start()),
            end => format!("{} to {end}", range.start()),
        };
        number.filter(|number| range.contains(number)).ok_or_else(|| self.outside(&shown()))
    }

    /// The value in SI: a number, or a string with its unit. It is finite.
    pub(super) fn quantity(&self, dimension: Dimension) -> Result<f64> {
        let number: f64 = match self.value {
            DeValue::String(text) => {
                return units::parse(text, dimension).map_err(|why| self.explained(why));
            }
            DeValue::Integer(integer) if integer.radix() == 10 => {
                integer.as_str().parse().unwrap_or(f64::NAN)
            }
            DeValue::Integer(_) => return Err(self.error("is not written in decimal digits")),
            DeValue::Float(float) => float.as_str().parse().unwrap_or(f64::NAN),
            _ => return Err(self.wrong_type(units::wanted(dimension))),
        };
        match number.is_finite() {
            true => Ok(number),
            false => Err(self.error("is not a finite number")),
        }
    }

    /// The entries of an array, named `key[0]`, `key[1]` and so on.
    pub(super) fn array(&self, longest: usize) -> Result<Vec<Entry<'a>>> {
        let DeValue::Array(values) = self.value else {
            return Err(self.wrong_type("expected an array [...]"));
        };
        if values.len() > longest {
            return Err(self.misplaced(format_args!("has {} entries, more than {longest}", values.len())));
        }
        let entry = |(index, value): (usize, &'a Spanned<DeValue<'a>>)| Entry {
            source: self.source,
            path: format!("{}[{index}]", self.path),
            key_place: value.span(),
            place: value.span(),
            value: value.get_ref(),
        };
        Ok(values.iter().enumerate().map(entry).collect())
    }

    /// The error `key: why` at the value.
    pub(super) fn explained(&self, why: String) -> Error {
        self.at(&self.place, format_args!(": {why}"))
    }
}
