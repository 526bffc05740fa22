//! The tables `[friction]` and `[wear]`: the laws and how they change along the cycles.

use super::document::{Entry, Section};
use super::keys::MOST_TIMES;
use crate::error::Result;
use crate::laws::friction::{Coulomb, FrictionLaw};
use crate::laws::history::History;
use crate::laws::loading::Clock;
use crate::laws::wear::{Archard, WearLaw};
use crate::units::Dimension;

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
pub(super) struct Friction {
    law: FrictionLaw,
    /// Whether the compression of reference is the indentation.
    from_indentation: bool,
}

impl Friction {
    /// Coulomb's law that stands for it.
    pub(super) fn reference(&self) -> Coulomb {
        self.law.reference()
    }

    /// The law; the indentation, m, is asked for only if the law was given in terms of it.
    pub(super) fn finish(self, indentation: impl FnOnce() -> Result<f64>) -> Result<FrictionLaw> {
        match self.law {
            FrictionLaw::LoadDependent { coefficient, exponent, .. } if self.from_indentation => {
                Ok(FrictionLaw::LoadDependent { coefficient, exponent, reference: indentation()? })
            }
            law => Ok(law),
        }
    }
}

pub(super) fn friction(section: &Section) -> Result<Friction> {
    const LAWS: [&str; 3] = ["coulomb", "static-kinetic", "load-dependent"];
    section.only(&[&LAWS[..], &["history"]].concat(), &[])?;
    let (name, entry) = section.one_of(&LAWS)?;
    let law = entry.section()?;
    let coefficient = |key: &str| law.required(key, "for example 0.6")?.positive(Dimension::NUMBER);
    let mut from_indentation = false;
    let law = match name {
        "coulomb" => {
            law.only(&["coefficient"], &[])?;
            FrictionLaw::Coulomb(Coulomb { coefficient: coefficient("coefficient")? })
        }
        "static-kinetic" => {
            const KEYS: [&str; 2] = ["static_coefficient", "kinetic_coefficient"];
            law.only(&KEYS, &[])?;
            let [static_coefficient, kinetic_coefficient] = [coefficient(KEYS[0])?, coefficient(KEYS[1])?];
            if kinetic_coefficient > static_coefficient {
                return Err(law.required(KEYS[1], "")?.error(format_args!(
                    "is above {} = {static_coefficient}; slip must not be held harder than stick",
                    law.name(KEYS[0])
                )));
            }
            FrictionLaw::StaticKinetic { static_coefficient, kinetic_coefficient }
        }
        _ => {
            law.only(&["coefficient", "exponent", "reference_compression"], &[])?;
            let range = "(-1, inf); μ_f(q) q must increase with the compression q, or springs would stick inside others that slip";
            let exponent = law.required("exponent", "0 is Coulomb's law")?.quantity_in(
                Dimension::NUMBER,
                range,
                |exponent| exponent > -1.0,
            )?;
            let reference = law.optional("reference_compression");
            from_indentation = reference.is_none();
            FrictionLaw::LoadDependent {
                coefficient: coefficient("coefficient")?,
                exponent,
                reference: reference.map_or(Ok(1.0), |entry| entry.positive(Dimension::LENGTH))?,
            }
        }
    };
    Ok(Friction { law, from_indentation })
}

pub(super) fn wear(section: &Section) -> Result<WearLaw> {
    const LAWS: [&str; 5] = ["archard", "dissipated-energy", "power-law", "threshold", "non-local"];
    section.only(&[&LAWS[..], &["history"]].concat(), &[])?;
    let (name, entry) = section.one_of(&LAWS)?;
    let law = entry.section()?;
    let positive = |key: &str, dimension, example: &str| law.required(key, example)?.positive(dimension);
    // Volume per load and distance, and volume per energy, have the same dimension.
    let coefficient = |example: &str| positive("coefficient", Dimension::INVERSE_PRESSURE, example);
    let archard = "for example \"1e-14 1/Pa\"";
    Ok(match name {
        "archard" => {
            law.only(&["coefficient"], &[])?;
            WearLaw::Archard(Archard { coefficient: coefficient(archard)? })
        }
        "dissipated-energy" => {
            law.only(&["coefficient"], &[])?;
            WearLaw::DissipatedEnergy { coefficient: coefficient("for example \"2e-5 mm^3/J\"")? }
        }
        "power-law" => {
            law.only(&["coefficient", "pressure_exponent", "slip_exponent"], &[])?;
            let number = |key: &str, example: &str| positive(key, Dimension::NUMBER, example);
            WearLaw::PowerLaw {
                coefficient: number("coefficient", "a plain number, the coefficient in Pa^-α m^(1-β)")?,
                pressure_exponent: number("pressure_exponent", "1 is Archard's law")?,
                slip_exponent: number("slip_exponent", "1 is Archard's law")?,
            }
        }
        "threshold" => {
            law.only(&["coefficient", "pressure"], &[])?;
            let pressure = positive("pressure", Dimension::PRESSURE, "for example \"50 MPa\"")?;
            WearLaw::Threshold { coefficient: coefficient(archard)?, pressure }
        }
        _ => {
            law.only(&["coefficient", "length"], &[])?;
            let length = positive("length", Dimension::LENGTH, "for example \"5 um\"")?;
            WearLaw::NonLocal { coefficient: coefficient(archard)?, length }
        }
    })
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
    history.only(&[FORMS, TIME, TIMES].concat(), &[])?;
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
