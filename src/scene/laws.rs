//! The tables `[friction]` and `[wear]`: the laws and how they change along the cycles.

use std::sync::Arc;

use super::document::{Entry, Section};
use super::keys::{self, MOST_TIMES};
use crate::error::Result;
use crate::laws::entry::{self as law, Value, Values, Wrong};
use crate::laws::friction::{self, Coulomb, FrictionLaw};
use crate::laws::history::History;
use crate::laws::loading::Clock;
use crate::laws::wear::{self, WearLaw};
use crate::units::{Dimension, Key, Kind, Table};

/// The one clock of all times in histories and blocks, and the first key that used it.
#[derive(Default)]
pub(super) struct OneClock(Option<(Clock, String)>);

impl OneClock {
    /// The clock; cycles where nothing asked for one.
    pub(super) fn clock(&self) -> Clock {
        self.0.as_ref().map_or(Clock::default(), |(clock, _)| *clock)
    }

    /// Takes the clock of a key, `cycles` or `tau` by its last part.
    pub(super) fn take(&mut self, clock: Clock, entry: &Entry) -> Result<()> {
        match &self.0 {
            Some((first, path)) if *first != clock => Err(entry.misplaced(format_args!(
                "does not go by the clock of {path}; give all times of histories and blocks in cycles, or all as tau"
            ))),
            Some(_) => Ok(()),
            None => {
                self.0 = Some((clock, entry.path().into()));
                Ok(())
            }
        }
    }
}

/// The clock that a key such as `tau` or `at_tau` goes by.
pub(super) fn clock_of(key: &str) -> Clock {
    if key.ends_with("tau") { Clock::Tau } else { Clock::Cycles }
}

/// A law of friction, but for what only the contact tells.
pub(super) struct Friction<'a>(Given<'a, dyn FrictionLaw>);

impl Friction<'_> {
    /// Coulomb's law that stands for it.
    pub(super) fn reference(&self) -> Result<Coulomb> {
        // Whatever the indentation, it is the same.
        Ok(Coulomb { coefficient: self.0.build(None, || Ok(1.0))?.reference_coefficient() })
    }

    /// The law; the indentation, m, is asked for only if the law was given in terms of it.
    pub(super) fn finish(&self, indentation: impl FnOnce() -> Result<f64>) -> Result<Arc<dyn FrictionLaw>> {
        self.0.build(None, indentation)
    }
}

pub(super) fn friction<'a>(section: &Section<'a>) -> Result<Friction<'a>> {
    given(section, &keys::FRICTION, friction::ENTRIES).map(Friction)
}

/// A law of wear, but for what other tables tell.
pub(super) struct Wear<'a>(Given<'a, dyn WearLaw>);

impl Wear<'_> {
    /// The law, at a number of cycles per second, Hz, if the scene tells one.
    pub(super) fn build(&self, frequency: Option<f64>) -> Result<Arc<dyn WearLaw>> {
        self.0.build(frequency, || unreachable!("no wear law takes the indentation"))
    }
}

pub(super) fn wear<'a>(section: &Section<'a>) -> Result<Wear<'a>> {
    given(section, &keys::WEAR, wear::ENTRIES).map(Wear)
}

/// A law as a table gives it.
struct Given<'a, L: ?Sized + 'static> {
    entry: &'static law::Entry<L>,
    section: Section<'a>,
    values: Values,
}

impl<L: ?Sized> Given<'_, L> {
    fn build(&self, frequency: Option<f64>, indentation: impl FnOnce() -> Result<f64>) -> Result<Arc<L>> {
        let mut values = self.values.clone();
        values.frequency = frequency;
        if let Some(key) = self.entry.indentation.filter(|key| values.lacks(key)) {
            values.set(key, indentation()?.into());
        }
        (self.entry.build)(&values).map_err(|Wrong { key, why }| match self.section.optional(key) {
            Some(entry) => entry.error(why),
            None => self.section.error(format_args!("{} {why}", self.section.name(key))),
        })
    }
}

/// The one law of a table, which may have a history beside it.
fn given<'a, L: ?Sized>(
    section: &Section<'a>,
    table: &Table,
    entries: &'static [&'static law::Entry<L>],
) -> Result<Given<'a, L>> {
    section.check(table)?;
    let found = entries.iter().find_map(|law| Some((*law, section.optional(law.name)?)));
    let (law, entry) = found.expect("the table has exactly one");
    let section = entry.section()?;
    section.check(&law.table())?;
    let values = law.keys.iter().map(|key| value(&section, key)).collect::<Result<_>>()?;
    Ok(Given { entry: law, section, values: Values::new(law.keys, values) })
}

/// The value of a key, or what is taken where it is left out.
fn value(section: &Section, key: &'static Key) -> Result<Value> {
    if !key.required && key.default.is_none() && section.optional(key.name).is_none() {
        return Ok(Value::Missing);
    }
    match key.kind {
        Kind::Word(words) => section.read(key).map(|place: usize| Value::Word(words[place])),
        _ => section.read(key).map(Value::Number),
    }
}

/// The table `history` beside a law.
///
/// # Arguments
/// * `ends_at_zero` -- whether the factor may fall to zero
pub(super) fn history(section: &Section, ends_at_zero: bool, clock: &mut OneClock) -> Result<History> {
    const FORMS: [&str; 2] = ["final_factor", "factors"];
    const TIME: [&str; 2] = ["cycles", "tau"];
    const TIMES: [&str; 2] = ["at_cycles", "at_tau"];
    let Some(entry) = section.optional("history") else { return Ok(History::Constant) };
    let history = entry.section()?;
    history.only(&[FORMS, TIME, TIMES].concat())?;
    match history.one_of(&FORMS)? {
        ("final_factor", last) => {
            history.refuse_beside(&TIMES, &last)?;
            let range = if ends_at_zero { "[0, inf)" } else { "(0, inf)" };
            let within = |factor: f64| factor > 0.0 || (ends_at_zero && factor == 0.0);
            let last = last.quantity_in(Dimension::NUMBER, range, within)?;
            let (key, time) = history.one_of(&TIME)?;
            clock.take(clock_of(key), &time)?;
            Ok(History::Exponential { last, time: time.positive(Dimension::NUMBER)? })
        }
        (_, factors) => {
            history.refuse_beside(&TIME, &factors)?;
            let (key, times) = history.one_of(&TIMES)?;
            clock.take(clock_of(key), &times)?;
            table(&factors, &times)
        }
    }
}

fn table(factors: &Entry, times: &Entry) -> Result<History> {
    let [factor_entries, time_entries] = [factors.array(MOST_TIMES)?, times.array(MOST_TIMES)?];
    let (count, of_times) = (factor_entries.len(), time_entries.len());
    if count == 0 {
        return Err(factors.error("is empty; give at least one factor"));
    }
    if of_times != count {
        return Err(times
            .misplaced(format_args!("has {of_times} times for {count} factors; give one time per factor")));
    }
    let positive = |entry: &Entry| entry.positive(Dimension::NUMBER);
    let factors = factor_entries.iter().map(positive).collect::<Result<_>>()?;
    let mut times: Vec<f64> = Vec::with_capacity(count);
    for entry in time_entries {
        let time = entry.quantity_in(Dimension::NUMBER, "[0, inf)", |time| time >= 0.0)?;
        if let Some(before) = times.last().filter(|before| **before >= time) {
            return Err(entry.error(format_args!("does not come after {before}; times must increase")));
        }
        times.push(time);
    }
    Ok(History::Table { times, factors })
}
