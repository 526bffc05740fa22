//! `fretwear universality`: which cases came to the limit, and which were to.

use std::fmt::Write;
use std::path::PathBuf;

use serde::Serialize;

use super::text::{Rows, Scale, number};
use crate::scene::{Prediction, UniversalityStudy};
use crate::study::universality::{Outcome, Row};

/// Summary of a universality study; the fields are the keys of the JSON.
#[derive(Debug, Clone, Serialize)]
pub struct UniversalityReport {
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
    /// The cases, in the order of the study.
    pub cases: Vec<UniversalityRow>,
}

/// One case; the keys of numbers are null where the run failed.
#[derive(Debug, Clone, Serialize)]
pub struct UniversalityRow {
    /// Name of the case.
    pub name: String,
    /// Medium and indenter; null where the study names none, as the next three.
    pub medium: Option<String>,
    /// Law of wear.
    pub wear: Option<String>,
    /// Law of friction.
    pub friction: Option<String>,
    /// Mode of oscillation.
    pub mode: Option<String>,
    /// `within` or `outside`.
    pub predicted: &'static str,
    /// Why, where the study says it.
    pub reason: Option<String>,
    /// `obeys`, `violates`, `unclear` or `failed`.
    pub verdict: &'static str,
    /// Whether the verdict is as predicted.
    pub agrees: bool,
    /// Largest difference of wear depth from the limit, over the largest depth of the limit.
    pub distance: Option<f64>,
    /// Worn volume over `a0² d` of the first contact.
    pub wear_volume_relative: Option<f64>,
    /// The same of the limit.
    pub wear_volume_limit_relative: Option<f64>,
    /// Worn volume over that of the limit.
    pub wear_volume_ratio: Option<f64>,
    /// Permanent stick radius, m.
    pub stick_radius: Option<f64>,
    /// Permanent stick radius over `a0` of the first contact.
    pub stick_ratio: Option<f64>,
    /// Largest indentation, m.
    pub indentation: Option<f64>,
    /// `end`, `rate` or `worn-out`.
    pub stop_reason: Option<&'static str>,
    /// Cycles at the end.
    pub cycles: Option<f64>,
    /// Dimensionless time at the end.
    pub tau: Option<f64>,
    /// Wall time of the run, s.
    pub wall_seconds: Option<f64>,
    /// Distance with twice the springs and an eighth of the tolerance less that without; null where that was not asked for, as the next.
    pub finer_distance_change: Option<f64>,
    /// Worn volume of the finer run over that of the run, less 1.
    pub finer_wear_volume_change: Option<f64>,
    /// Why the run failed.
    pub error: Option<String>,
}

impl UniversalityRow {
    fn new(row: &Row) -> Self {
        let [medium, wear, friction, mode] =
            row.case.levels.clone().map(|name| Some(name).filter(|name| !name.is_empty()));
        let end = row.end.as_ref().ok();
        let finer = row.refinement();
        let failed = |end: &std::result::Result<_, String>| end.as_ref().err().cloned();
        Self {
            name: row.case.name.clone(),
            medium,
            wear,
            friction,
            mode,
            predicted: row.case.predicted.name(),
            reason: row.case.reason.clone(),
            verdict: row.verdict.name(),
            agrees: row.agrees(),
            distance: end.and_then(|it| it.distance),
            wear_volume_relative: end.map(|it| it.wear_volume_relative()),
            wear_volume_limit_relative: end.map(|it| it.wear_volume_limit_relative()),
            wear_volume_ratio: end.map(|it| it.wear_volume / it.wear_volume_limit),
            stick_radius: end.map(|it| it.stick_radius),
            stick_ratio: end.map(|it| it.stick_ratio()),
            indentation: end.map(|it| it.indentation),
            stop_reason: end.map(|it| it.stop_reason.name()),
            cycles: end.map(|it| it.cycles),
            tau: end.map(|it| it.tau),
            wall_seconds: end.map(|it| it.wall_seconds),
            finer_distance_change: finer.map(|it| it[0]),
            finer_wear_volume_change: finer.map(|it| it[1]),
            error: failed(&row.end).or_else(|| row.finer.as_ref().and_then(failed)),
        }
    }
}

impl UniversalityReport {
    /// The summary of a study that is done.
    pub fn new(study: &UniversalityStudy, outcome: &Outcome) -> Self {
        let tolerances = study.tolerances();
        Self {
            title: study.title().map(str::to_owned),
            files: outcome.files.clone(),
            tolerance_within: tolerances.within,
            tolerance_outside: tolerances.outside,
            count: outcome.rows.len(),
            agreeing: outcome.rows.iter().filter(|row| row.agrees()).count(),
            wall_seconds: outcome.wall_seconds,
            cases: outcome.rows.iter().map(UniversalityRow::new).collect(),
        }
    }

    /// A table for people.
    pub fn text(&self) -> String {
        let mut text = self.title.as_ref().map_or(String::new(), |title| format!("{title}\n\n"));
        let width = self.cases.iter().map(|row| row.name.chars().count()).max().unwrap_or(0).max(4);
        for predicted in Prediction::ALL.map(Prediction::name) {
            let rows: Vec<_> = self.cases.iter().filter(|row| row.predicted == predicted).collect();
            if rows.is_empty() {
                continue;
            }
            let tolerance = match predicted {
                "within" => format!("up to {}", number(self.tolerance_within)),
                _ => format!("from {} on", number(self.tolerance_outside)),
            };
            // Writing to a string cannot fail.
            let _ = writeln!(text, "Predicted {predicted}: distance {tolerance}");
            let _ = writeln!(
                text,
                "  {:<width$}  {:>10}  {:>11}  {:>9}  {:>9}  {:>10}  {:<9} {:>8}  verdict",
                "case", "distance", "ΔV/(a0²d)", "ΔV/ΔV∞", "c/a0", "τ", "stopped", "wall"
            );
            rows.iter().for_each(|row| row.line(width, &mut text));
            text.push('\n');
        }
        let mut rows = Rows::default();
        rows.row("as predicted", format!("{} of {} cases", self.agreeing, self.count));
        rows.row("wall time", Scale::TIME.show(self.wall_seconds));
        for file in &self.files {
            rows.row("written", file.display());
        }
        text + &rows.finish()
    }
}

impl UniversalityRow {
    fn line(&self, width: usize, text: &mut String) {
        let shown = |value: Option<f64>| value.map_or("-".into(), number);
        let distance = self.distance.map_or("-".into(), |it| format!("{it:.3e}"));
        let wrong = if self.agrees { "" } else { " (not as predicted)" };
        let _ = writeln!(
            text,
            "  {:<width$}  {distance:>10}  {:>11}  {:>9}  {:>9}  {:>10}  {:<9} {:>8}  {}{wrong}",
            self.name,
            shown(self.wear_volume_relative),
            shown(self.wear_volume_ratio),
            shown(self.stick_ratio),
            shown(self.tau),
            self.stop_reason.unwrap_or("-"),
            self.wall_seconds.map_or("-".into(), |it| format!("{it:.1} s")),
            self.verdict
        );
        if let (Some(distance), Some(volume)) = (self.finer_distance_change, self.finer_wear_volume_change) {
            let _ =
                writeln!(text, "    finer: distance {distance:+.1e}, worn volume {volume:+.1e} of itself");
        }
        if let Some(error) = &self.error {
            let _ = writeln!(text, "    {}", error.replace('\n', "\n    "));
        }
    }
}
