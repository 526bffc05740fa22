//! Several laws on the same data: which the data prefer, and whether they can tell.

use super::{Outcome, Parameter};
use crate::data::quantity::{Reading, number, word};

/// Weight from which on the data prefer one law to all others.
pub(super) const TELLS: f64 = 0.95;

/// A law and what came of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// Name of the law.
    pub name: String,
    /// What was found under it, or why nothing was.
    pub outcome: Result<Outcome, String>,
    /// Its likelihood among the laws, by differences of Akaike's criterion; zero where nothing was found.
    pub weight: f64,
}

/// All that is told of a law, in the order of columns.
pub(super) const OF_MODEL: [Reading<Judged>; 6] = [
    word("name", "name of the law", |it| it.name.as_str().into()),
    number("aicc", "1", "Akaike's criterion with its correction for few values", |it| {
        found(it, |it| it.aicc)
    }),
    number("weight", "1", "likelihood of the law among those compared", |it| it.weight.into()),
    number("reduced_chi_squared", "1", "misfit over degrees of freedom", |it| {
        found(it, |it| it.reduced_chi_squared)
    }),
    word("estimates", "the unknowns with their intervals of 95 %", |it| {
        it.outcome
            .as_ref()
            .ok()
            .map(|it| it.parameters.iter().map(told).collect::<Vec<_>>().join("; "))
            .as_deref()
            .into()
    }),
    word("error", "why nothing was found", |it| it.outcome.as_ref().err().map(String::as_str).into()),
];

fn found(judged: &Judged, of: fn(&Outcome) -> f64) -> crate::data::Value {
    judged.outcome.as_ref().ok().map(of).into()
}

fn told(it: &Parameter) -> String {
    let end = |end: Option<f64>| end.map_or_else(|| "not told".to_owned(), crate::report::number);
    let [low, high] = it.interval.map(end);
    format!("{} = {} ({low} to {high})", it.key, crate::report::number(it.estimate))
}

/// Weighs laws by Akaike's criterion, the best first
///
/// ```text
/// w_i = e^(-Δ_i/2) / Σ e^(-Δ_j/2),     Δ_i = AICc_i - min AICc
/// ```
pub(super) fn judged(found: Vec<(String, Result<Outcome, String>)>) -> Vec<Judged> {
    let criterion = |it: &Result<Outcome, String>| it.as_ref().map_or(f64::INFINITY, |it| it.aicc);
    let least = found.iter().map(|(_, it)| criterion(it)).fold(f64::INFINITY, f64::min);
    let share = |it: &Result<Outcome, String>| {
        if least.is_finite() { (0.5 * (least - criterion(it))).exp() } else { 0.0 }
    };
    let sum: f64 = found.iter().map(|(_, it)| share(it)).sum();
    let judged = found.into_iter().map(|(name, outcome)| {
        let weight = if sum > 0.0 { share(&outcome) / sum } else { 0.0 };
        Judged { name, outcome, weight }
    });
    let mut judged: Vec<Judged> = judged.collect();
    judged.sort_by(|one, other| criterion(&one.outcome).total_cmp(&criterion(&other.outcome)));
    judged
}
