//! `fretwear universality`: which cases came to the limit, and which were to.

use std::fmt::Write;
use std::path::PathBuf;

use serde::Serialize;

use super::files::READINGS;
use super::{CaseResult, Judgement, Outcome};
use crate::data::quantity::{Entries, word};
use crate::report::{Scale, TextTable, number};
use crate::scene::{Prediction, UniversalityStudy};

/// Summary of a universality study; the fields are the keys of the JSON.
#[derive(Debug, Clone, Serialize)]
pub struct UniversalityReport<'a> {
    /// Title of the study.
    pub title: Option<String>,
    /// The files written.
    pub files: Vec<PathBuf>,
    /// Distance up to which a case obeys the limit.
    pub tolerance_within: f64,
    /// Distance from which on it violates it.
    pub tolerance_outside: f64,
    /// Number of cases.
    pub count: usize,
    /// Number of cases whose verdict is as predicted.
    pub agreeing: usize,
    /// Wall time of this call, s.
    pub wall_seconds: f64,
    /// The cases, in the order of the study; what a case does not have is null.
    cases: Vec<Entries>,
    #[serde(skip)]
    rows: &'a [CaseResult],
}

/// Keys of a case.
const KEYS: &str = "name medium wear friction mode predicted reason verdict agrees distance wear_volume_relative \
                    wear_volume_limit_relative wear_volume_ratio stick_radius stick_ratio indentation stop_reason \
                    cycles tau wall_seconds finer_distance_change finer_wear_volume_change error";

impl<'a> UniversalityReport<'a> {
    /// The summary of a study that is done.
    pub fn new(study: &UniversalityStudy, outcome: &'a Outcome) -> Self {
        let tolerances = study.tolerances();
        // In no file, as the study says it.
        let reason = word("reason", "why, where the study says it", |row: &CaseResult| {
            row.case.reason.as_deref().into()
        });
        let readings = [&READINGS[..], &[reason]].concat();
        Self {
            title: study.title().map(str::to_owned),
            files: outcome.files.clone(),
            tolerance_within: tolerances.within,
            tolerance_outside: tolerances.outside,
            count: outcome.rows.len(),
            agreeing: outcome.rows.iter().filter(|row| row.agrees()).count(),
            wall_seconds: outcome.wall_seconds,
            cases: outcome.rows.iter().map(|row| Entries::some(&readings, row, KEYS)).collect(),
            rows: &outcome.rows,
        }
    }

    /// A table for people.
    pub fn text(&self) -> String {
        let mut text = self.title.as_ref().map_or(String::new(), |title| format!("{title}\n\n"));
        let width = self.rows.iter().map(|row| row.case.name.chars().count()).max().unwrap_or(0).max(4);
        for predicted in Prediction::ALL {
            let rows: Vec<_> = self.rows.iter().filter(|row| row.case.predicted == predicted).collect();
            if rows.is_empty() {
                continue;
            }
            let tolerance = match predicted {
                Prediction::Within => format!("up to {}", number(self.tolerance_within)),
                Prediction::Outside => format!("from {} on", number(self.tolerance_outside)),
            };
            // Writing to a string cannot fail.
            let _ = writeln!(text, "Predicted {}: distance {tolerance}", predicted.name());
            let _ = writeln!(
                text,
                "  {:<width$}  {:>10}  {:>11}  {:>9}  {:>9}  {:>10}  {:<9} {:>8}  verdict",
                "case", "distance", "ΔV/(a0²d)", "ΔV/ΔV∞", "c/a0", "τ", "stopped", "wall"
            );
            rows.iter().for_each(|row| line(row, width, &mut text));
            text.push('\n');
        }
        let mut rows = TextTable::default();
        rows.row("as predicted", format!("{} of {} cases", self.agreeing, self.count));
        rows.row("wall time", Scale::TIME.show(self.wall_seconds));
        for file in &self.files {
            rows.row("written", file.display());
        }
        text + &rows.text()
    }
}

fn line(row: &CaseResult, width: usize, text: &mut String) {
    let end = row.end.as_ref().ok();
    let shown = |of: &dyn Fn(&Judgement) -> f64| end.map_or("-".into(), |end| number(of(end)));
    let distance = end.and_then(|it| it.distance).map_or("-".into(), |it| format!("{it:.3e}"));
    let wrong = if row.agrees() { "" } else { " (not as predicted)" };
    let _ = writeln!(
        text,
        "  {:<width$}  {distance:>10}  {:>11}  {:>9}  {:>9}  {:>10}  {:<9} {:>8}  {}{wrong}",
        row.case.name,
        shown(&Judgement::wear_volume_relative),
        shown(&|it| it.wear_volume / it.wear_volume_limit),
        shown(&Judgement::stick_ratio),
        shown(&|it| it.tau),
        end.map_or("-", |it| it.stop_reason.name()),
        end.map_or("-".into(), |it| format!("{:.1} s", it.wall_seconds)),
        row.verdict.name()
    );
    if let Some([distance, volume]) = row.refinement() {
        let _ = writeln!(text, "    finer: distance {distance:+.1e}, worn volume {volume:+.1e} of itself");
    }
    if let Some(error) = row.error() {
        let _ = writeln!(text, "    {}", error.replace('\n', "\n    "));
    }
}
