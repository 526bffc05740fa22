//! Reads what keys and tables declare: unknown keys, keys that exclude each other, ranges, defaults.

use super::document::{Entry, Section};
use crate::error::Result;
use crate::units::{self, Dimension, Form, Key, Kind, Rule, Table};

/// What a key can be read as.
pub(super) trait Read<'a>: Sized {
    /// The value that stands there, checked.
    fn read(entry: &Entry<'a>, key: &Key) -> Result<Self>;

    /// The value of a text that a key has as its default.
    fn parse(text: &'static str, key: &Key) -> Option<Self>;

    /// The default of a key; None for one that has none.
    fn default_of(key: &Key) -> Option<Self> {
        key.default.map(|text| Self::parse(text, key).expect("defaults are values of their keys"))
    }
}

/// Quantities in SI.
impl<'a> Read<'a> for f64 {
    fn read(entry: &Entry<'a>, key: &Key) -> Result<Self> {
        let Kind::Quantity(dimension) = key.kind else { unreachable!("{} is no quantity", key.name) };
        let value = entry.quantity(dimension)?;
        if key.range.contains(value) { Ok(value) } else { Err(entry.outside(&key.range_in_words())) }
    }

    fn parse(text: &'static str, key: &Key) -> Option<Self> {
        let Kind::Quantity(dimension) = key.kind else { return None };
        units::parse(text, dimension).ok()
    }
}

/// Whole numbers, and words by their position.
impl<'a> Read<'a> for usize {
    fn read(entry: &Entry<'a>, key: &Key) -> Result<Self> {
        if let Kind::Word(words) = key.kind {
            return entry.word(words);
        }
        let number = entry.whole_number()?.filter(|number| key.range.contains(*number as f64));
        number.ok_or_else(|| entry.outside(&key.range_in_words()))
    }

    fn parse(text: &'static str, key: &Key) -> Option<Self> {
        match key.kind {
            Kind::Word(words) => words.iter().position(|word| *word == text),
            _ => text.parse().ok(),
        }
    }
}

impl<'a> Read<'a> for bool {
    fn read(entry: &Entry<'a>, _: &Key) -> Result<Self> {
        entry.boolean()
    }

    fn parse(text: &'static str, _: &Key) -> Option<Self> {
        text.parse().ok()
    }
}

/// One line, which goes into files and figures.
impl<'a> Read<'a> for String {
    fn read(entry: &Entry<'a>, _: &Key) -> Result<Self> {
        const LONGEST: usize = 1000;
        let line = entry.string()?;
        if line.chars().any(char::is_control) {
            return Err(entry.error("holds a line break or another control character; a title is one line"));
        }
        match line.len() > LONGEST {
            true => Err(entry.error(format_args!("is longer than {LONGEST} bytes"))),
            false => Ok(line.into()),
        }
    }

    fn parse(text: &'static str, _: &Key) -> Option<Self> {
        Some(text.into())
    }
}

/// Ratios `m/n` of whole numbers, as `m` and `n` without common divisor.
impl<'a> Read<'a> for [u32; 2] {
    fn read(entry: &Entry<'a>, key: &Key) -> Result<Self> {
        const LARGEST: u32 = 64;
        /// What the digits of a decimal fraction such as 1.3333333333333333 leave open.
        const ROUNDING: f64 = 1e-12;
        let ratio = match entry.text() {
            Some(text) if text.contains('/') => {
                let whole = |part: &str| part.trim().parse::<u64>().ok().filter(|number| *number > 0);
                let parts = text.split_once('/').and_then(|(over, under)| whole(over).zip(whole(under)));
                parts.and_then(|(over, under)| {
                    let divisor = common_divisor(over, under);
                    let small =
                        |number: u64| u32::try_from(number / divisor).ok().filter(|it| *it <= LARGEST);
                    Some([small(over)?, small(under)?])
                })
            }
            _ => {
                let value = f64::read(entry, &key.of(Dimension::NUMBER))?;
                (1..=LARGEST).find_map(|under| {
                    let over = (value * f64::from(under)).round();
                    let near = (value * f64::from(under) - over).abs() <= ROUNDING * over;
                    (near && (1.0..=f64::from(LARGEST)).contains(&over)).then_some([over as u32, under])
                })
            }
        };
        let why =
            || format!("is no ratio of whole numbers up to {LARGEST}; write for example 2, 0.5 or \"4/3\"");
        ratio.ok_or_else(|| entry.error(why()))
    }

    fn parse(_: &'static str, _: &Key) -> Option<Self> {
        None
    }
}

fn common_divisor(mut a: u64, mut b: u64) -> u64 {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// Texts.
impl<'a> Read<'a> for &'a str {
    fn read(entry: &Entry<'a>, _: &Key) -> Result<Self> {
        entry.string()
    }

    fn parse(text: &'static str, _: &Key) -> Option<Self> {
        Some(text)
    }
}

impl<'a> Section<'a> {
    /// Refuses keys that a table does not have, and keys that do not go together.
    pub(super) fn check(&self, table: &Table) -> Result<()> {
        self.only_of(table)?;
        table.rules.iter().try_for_each(|rule| self.obey(rule, table))
    }

    fn obey(&self, rule: &Rule, table: &Table) -> Result<()> {
        match rule {
            Rule::OneOf(keys) => self.one_of(keys).map(drop),
            Rule::AtMostOneOf(keys) => self.at_most_one_of(keys).map(drop),
            Rule::Forms(forms) => self.in_one_form(forms, table),
            Rule::Needs(key, other) => match self.optional(key) {
                Some(entry) if self.optional(other).is_none() => Err(entry.misplaced(format_args!(
                    "has no meaning without {}; give that too, or remove it",
                    self.name(other)
                ))),
                _ => Ok(()),
            },
            Rule::Words(key, words) => self.as_the_word_says(key, words, table),
        }
    }

    /// Refuses keys that go with another word, and one that is missing for the word that is given.
    fn as_the_word_says(&self, key: &str, words: &[(&str, Form)], table: &Table) -> Result<()> {
        let Some(entry) = self.optional(key) else { return Ok(()) };
        let (word, form) = &words[entry.word(&words.iter().map(|(word, _)| *word).collect::<Vec<_>>())?];
        for (other, foreign) in words {
            let stray = foreign.keys().filter(|key| !form.has(key)).find_map(|key| self.optional(key));
            if let Some(stray) = stray {
                let beside = format!("has no meaning beside {} = {word:?}", entry.path());
                return Err(stray.misplaced(format_args!("{beside}; remove it, or write {other:?}")));
            }
        }
        match form.needs.iter().find(|key| self.optional(key).is_none()) {
            None => Ok(()),
            Some(missing) => {
                let key = table.key(missing).expect("forms are made of keys");
                let example = key.example_in_toml().map_or(String::new(), |it| format!(", for example {it}"));
                let needs = form.needs.join(" and ");
                Err(self.error(format_args!(
                    "{} is missing; {} = {word:?} needs {needs}{example}",
                    self.name(missing),
                    entry.path()
                )))
            }
        }
    }

    /// Refuses keys of different forms, and a form that is not complete.
    fn in_one_form(&self, forms: &[Form], table: &Table) -> Result<()> {
        let heads: Vec<&str> = forms.iter().filter_map(|form| form.needs.first().copied()).collect();
        let given = forms.iter().flat_map(Form::keys).filter_map(|key| Some((key, self.optional(key)?)));
        let mut given: Vec<(&str, Entry)> = given.collect();
        // What is given beside the key that decides the form is what has no place.
        given.sort_by_key(|(key, entry)| (!heads.contains(key), entry.place().start));
        given.dedup_by_key(|(key, _)| *key);
        let mut open: Vec<&Form> = forms.iter().collect();
        for (place, (key, entry)) in given.iter().enumerate() {
            open.retain(|form| form.has(key));
            if open.is_empty() {
                let apart = |other: &str| !forms.iter().any(|form| form.has(key) && form.has(other));
                let (other, rival) = given[..place].iter().find(|(it, _)| apart(it)).unwrap_or(&given[0]);
                return Err(match heads.contains(key) && heads.contains(other) {
                    true => entry.excludes(rival, &self.listed(&heads)),
                    false => entry.without_meaning_beside(rival),
                });
            }
        }
        let missing = |form: &&Form| form.needs.iter().copied().find(|key| self.optional(key).is_none());
        let Some(mut missing) = open.iter().map(missing).collect::<Option<Vec<_>>>() else { return Ok(()) };
        missing.dedup();
        match missing[..] {
            [one] => self.required_key(table.key(one).expect("forms are made of keys")).map(drop),
            _ => {
                Err(self.error(format_args!("give exactly one of {}; none is there", self.listed(&missing))))
            }
        }
    }

    /// The value of a key that must be there.
    pub(super) fn required_key(&self, key: &Key) -> Result<Entry<'a>> {
        if let Some(entry) = self.optional(key.name) {
            return Ok(entry);
        }
        let cure = match (key.kind, key.example_in_toml()) {
            (Kind::Table(_) | Kind::Tables(..), _) => format!("add for example {}", key.example),
            (_, Some(example)) => format!("for example {example}. {}", key.about),
            (_, None) => key.about.to_owned(),
        };
        self.required(key.name, &cure)
    }

    /// The value of a key, checked; its default where it is left out.
    pub(super) fn read<T: Read<'a>>(&self, key: &Key) -> Result<T> {
        match T::default_of(key).filter(|_| self.optional(key.name).is_none()) {
            Some(default) => Ok(default),
            None => T::read(&self.required_key(key)?, key),
        }
    }

    /// The value of a key, checked, if it is given.
    pub(super) fn read_optional<T: Read<'a>>(&self, key: &Key) -> Result<Option<T>> {
        self.optional(key.name).map(|entry| T::read(&entry, key)).transpose()
    }
}

impl Entry<'_> {
    /// Checks a value by itself, as far as it does not depend on other keys.
    pub(super) fn check(&self, key: &Key) -> Result<()> {
        match key.kind {
            Kind::Quantity(_) => f64::read(self, key).map(drop),
            Kind::Whole | Kind::Word(_) => usize::read(self, key).map(drop),
            Kind::Switch => self.boolean().map(drop),
            Kind::Text => String::read(self, key).map(drop),
            Kind::Name => self.string().map(drop),
            Kind::List(item, [_, most]) => self.array(most)?.iter().try_for_each(|it| it.check(item)),
            Kind::Tables(table, [_, most]) => {
                self.array(most)?.iter().try_for_each(|it| it.section()?.check(table))
            }
            _ => Ok(()),
        }
    }
}
