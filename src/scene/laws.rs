//! What a scene gives by the name of a law, a mode of motion or an indenter, and how laws change along the cycles.

use std::fmt::Display;
use std::sync::Arc;

use super::document::{Entry, Section};
use super::keys::{self, MOST_TIMES};
use super::reading::Read;
use super::{Rows, columns};
use crate::error::{Error, Result};
use crate::laws::entry::{self as law, Lengths, Value, Values, Wrong};
use crate::laws::history::History;
use crate::laws::loading::Clock;
use crate::units::{Key, Kind, Table};

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

/// A law, a mode of motion or an indenter as a table gives it, but for what other tables tell.
pub(super) struct Given<'a, L: ?Sized + 'static> {
    pub(super) entry: &'static law::Entry<L>,
    section: Section<'a>,
    pub(super) values: Values,
}

impl<L: ?Sized> Given<'_, L> {
    /// Takes lengths of the first contact, which is formed only where something refers to it.
    pub(super) fn refer(&mut self, contact: impl FnOnce() -> Result<Lengths>) -> Result<()> {
        if (self.entry.refers)(&self.values) {
            self.values.contact = contact()?;
        }
        Ok(())
    }

    pub(super) fn build(&self) -> Result<Arc<L>> {
        (self.entry.build)(&self.values).map_err(|wrong| match wrong {
            Wrong::Value { key, why } => match self.section.optional(key) {
                Some(entry) => entry.error(why),
                None => self.section.absent(key, why),
            },
            Wrong::Error(Error::Inconsistent { what, why }) => {
                let named = |key: &&Key| self.section.name(key.name) == what;
                let key = self.entry.keys.iter().find(named).and_then(|key| self.section.optional(key.name));
                match (key, &self.values.file) {
                    (Some(entry), _) => entry.explained(why),
                    (None, Some(file)) => Error::File { path: file.path.clone(), why },
                    (None, None) => Error::Inconsistent { what, why },
                }
            }
            Wrong::Error(other) => other,
        })
    }

    /// An error that what is given is wrong as a whole, shown at the first of its keys.
    pub(super) fn error(&self, why: impl Display) -> Error {
        let first = self.entry.keys.iter().find_map(|key| self.section.optional(key.name));
        first.expect("its table holds one of its keys").error(why)
    }
}

/// What a table gives of some entries; none if it gives none of them.
pub(super) fn given<'a, L: ?Sized>(
    section: &Section<'a>,
    entries: &'static [&'static law::Entry<L>],
    rows: &Rows,
) -> Result<Option<Given<'a, L>>> {
    let found = entries.iter().find_map(|it| Some((*it, section.optional(it.name)?)));
    let Some((entry, place)) = found else { return Ok(None) };
    let (section, table) = (place.section()?, entry.table());
    section.check(&table)?;
    let values = entry.keys.iter().map(|key| value(&section, key, entry)).collect::<Result<_>>()?;
    let mut values = Values::new(entry.keys, values);
    if let Some(columns) = entry.columns {
        let (folder, stored) = match rows {
            Rows::In(folder) => (Some(*folder), &[][..]),
            Rows::Stored(stored) => (None, &stored[..]),
        };
        values.file = columns::read(&section, &table, columns, folder)?;
        values.stored = stored.to_vec();
    }
    Ok(Some(Given { entry, section, values }))
}

/// The value of a key, or what is taken where it is left out.
fn value<L: ?Sized>(section: &Section, key: &'static Key, entry: &law::Entry<L>) -> Result<Value> {
    if !key.required && key.default.is_none() && section.optional(key.name).is_none() {
        return Ok(Value::Missing);
    }
    match key.kind {
        Kind::Word(words) => section.read(key).map(|place: usize| Value::Word(words[place])),
        Kind::Ratio => section.read(key).map(Value::Ratio),
        Kind::Name => Ok(Value::Missing),
        Kind::Scaled => {
            let (exponent, dimension) = entry.by_exponent.expect("its unit depends on an exponent");
            let exponent = entry.keys.iter().find(|key| key.name == exponent).expect("one of its keys");
            section.read(&key.of(dimension(section.read(exponent)?))).map(Value::Number)
        }
        _ => section.read(key).map(Value::Number),
    }
}

/// The table `history` beside a law.
///
/// # Arguments
/// * `table` -- its keys
pub(super) fn history(section: &Section, table: &Table, clock: &mut OneClock) -> Result<History> {
    let Some(entry) = section.optional(table.name) else { return Ok(History::Constant) };
    let history = entry.section()?;
    history.check(table)?;
    let given = |name: &str| Some((table.key(name)?, history.optional(name)?));
    let of_clocks = |names: [&str; 2]| names.into_iter().find_map(given).expect("its form has one of them");
    if let Some((key, last)) = given("final_factor") {
        let last = f64::read(&last, key)?;
        let (key, time) = of_clocks(["cycles", "tau"]);
        clock.take(clock_of(key.name), &time)?;
        return Ok(History::Exponential { last, time: f64::read(&time, key)? });
    }
    let (_, factors) = given("factors").expect("its form has factors");
    let (key, times) = of_clocks(["at_cycles", "at_tau"]);
    clock.take(clock_of(key.name), &times)?;
    of_rows(&factors, &times)
}

fn of_rows(factors: &Entry, times: &Entry) -> Result<History> {
    let [factor_entries, time_entries] = [factors.array(MOST_TIMES)?, times.array(MOST_TIMES)?];
    let (count, of_times) = (factor_entries.len(), time_entries.len());
    if count == 0 {
        return Err(factors.error("is empty; give at least one factor"));
    }
    if of_times != count {
        return Err(times
            .misplaced(format_args!("has {of_times} times for {count} factors; give one time per factor")));
    }
    let factors =
        factor_entries.iter().map(|entry| f64::read(entry, &keys::HISTORY_FACTOR)).collect::<Result<_>>()?;
    let mut times: Vec<f64> = Vec::with_capacity(count);
    for entry in time_entries {
        let time = f64::read(&entry, &keys::TIME)?;
        if let Some(before) = times.last().filter(|before| **before >= time) {
            return Err(entry.error(format_args!("does not come after {before}; times must increase")));
        }
        times.push(time);
    }
    Ok(History::Table { times, factors })
}
