//! `fretwear run`: what a run came to.

use std::path::Path;

use serde::Serialize;

use super::text::{Scale, TextTable, number};
use crate::contact::closed_form::LimitingShape;
use crate::contact::indenter::Shape;
use crate::data::quantity::Entries;
use crate::run::Results;
use crate::run::readings::RUN;

/// The outcome of a run in SI; the keys of the JSON are the result file and [`RUN`].
#[derive(Debug, Clone, Serialize)]
pub struct RunReport<'a> {
    /// The result file.
    pub output: String,
    #[serde(flatten)]
    readings: Entries,
    #[serde(skip)]
    result: &'a Results,
}

impl<'a> RunReport<'a> {
    /// Describes what a run came to.
    ///
    /// # Arguments
    /// * `output` -- the result file
    pub fn new(result: &'a Results, output: &Path) -> Self {
        Self { output: output.display().to_string(), readings: Entries::new(&RUN, result), result }
    }

    /// A table for people.
    pub fn text(&self) -> String {
        let mut rows = self.rows(&format!("by a signal; go on with fretwear run --resume {}", self.output));
        rows.row("written to", &self.output);
        rows.text()
    }

    /// All but the file.
    ///
    /// # Arguments
    /// * `interrupted` -- what is said of a run that was stopped
    fn rows(&self, interrupted: &str) -> TextTable {
        let (last, checkpoint, limit) = (self.result.last(), self.result.checkpoint(), self.result.limit());
        let distance = self.result.distance();
        let mut rows = TextTable::default();
        if let Some(table) = self.result.indenter().table() {
            rows.row("indenter", table.words());
        }
        let stopped = match self.result.stop_reason().name() {
            "end" => "at its end".to_owned(),
            "rate" => "when the rate of worn volume had fallen as asked".to_owned(),
            "unending" => "because the rate of worn volume asked for is never reached".to_owned(),
            "worn-out" => "with no pressure left outside the stick zone".to_owned(),
            _ => interrupted.to_owned(),
        };
        rows.row("stopped", stopped);
        rows.row("cycles", number(last.cycles));
        rows.row("dimensionless time τ", number(last.tau));
        let beside_limit = |scale: Scale, value: f64, of: fn(&LimitingShape) -> f64| match limit {
            Some(limit) => format!("{} of {} in the limit", scale.show(value), scale.show(of(limit))),
            None => scale.show(value),
        };
        let volume = beside_limit(Scale::VOLUME, last.wear_volume, LimitingShape::wear_volume);
        rows.row("worn volume", volume);
        let radius = beside_limit(Scale::LENGTH, last.contact_radius, LimitingShape::contact_radius_limit);
        rows.row("contact radius", radius);
        rows.row("regime", last.regime.name());
        rows.row("stick radius", Scale::LENGTH.show(last.stick_radius));
        rows.row("normal force", Scale::FORCE.show(last.normal_force));
        rows.row("dissipated energy", Scale::ENERGY.show(last.dissipated_energy));
        let distance = distance.and_then(|it| it.distance_relative);
        rows.optional(
            "distance to the limit",
            distance.map(|it| format!("{} of its largest depth", number(it))),
        );
        rows.optional(
            "estimated error",
            checkpoint.error_estimate.map(|it| {
                let of = if limit.is_some() { "the limit's" } else { "the largest of the run" };
                let met = self.result.accuracy_met();
                let missed = if met == Some(false) { ", more than was asked for" } else { "" };
                format!("{} of {of}{missed}", number(it))
            }),
        );
        let progress = &checkpoint.progress;
        rows.row(
            "steps",
            format!(
                "{} and {} rejected, {} rate evaluations, {}",
                progress.steps,
                progress.rejected_steps,
                progress.rate_evaluations,
                Scale::TIME.show(checkpoint.wall_seconds)
            ),
        );
        rows
    }
}

impl Results {
    /// What the run came to, a table for people.
    pub fn summary(&self) -> String {
        RunReport::new(self, Path::new("")).rows("before its end").text()
    }
}
