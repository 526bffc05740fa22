//! `fretwear run`: what a run came to.

use std::path::Path;

use serde::Serialize;

use super::text::{Rows, Scale, indenter, number};
use crate::contact::closed_form::LimitingShape;
use crate::contact::indenter::Indenter;
use crate::contact::stick_slip::Regime;
use crate::run::Results;

/// The outcome of a run in SI; the fields are the keys of the JSON.
#[derive(Debug, Clone, Serialize)]
pub struct RunReport {
    /// The result file.
    pub output: String,
    /// Why the run stopped: `end`, `rate`, `interrupted`, `worn-out` or `unending`.
    pub stop_reason: &'static str,
    /// Estimated error of worn volume and profile, relative to those of the limit, or to the largest of the run where there is none.
    pub error_estimate: Option<f64>,
    /// Whether that is within `numerics.accuracy`; null where springs were given by hand.
    pub accuracy_met: Option<bool>,
    /// Cycles done.
    pub cycles: f64,
    /// Dimensionless time.
    pub tau: f64,
    /// Steps accepted.
    pub steps: u64,
    /// Steps rejected.
    pub rejected_steps: u64,
    /// Evaluations of pressure, slip and wear.
    pub rate_evaluations: u64,
    /// Wall time, s.
    pub wall_seconds: f64,
    /// Indentation, m.
    pub indentation: f64,
    /// Normal force, N.
    pub normal_force: f64,
    /// Contact radius, m.
    pub contact_radius: f64,
    /// Stick radius, m.
    pub stick_radius: f64,
    /// Worn volume, m³.
    pub wear_volume: f64,
    /// Worn volume of the limit, m³.
    pub wear_volume_limit: Option<f64>,
    /// `sup |f - f∞| / d` over all nodes.
    pub limit_distance: Option<f64>,
    /// `sup |f - f∞|` over the limit's own largest depth.
    pub limit_distance_relative: Option<f64>,
    /// Energy dissipated by friction, J.
    pub dissipated_energy: f64,
    #[serde(skip)]
    regime: Regime,
    #[serde(skip)]
    contact_radius_limit: Option<f64>,
    #[serde(skip)]
    table: Option<String>,
}

impl RunReport {
    /// Describes what a run came to.
    ///
    /// # Arguments
    /// * `output` -- the result file
    pub fn new(result: &Results, output: &Path) -> Self {
        let (last, checkpoint, limit) = (result.last(), result.checkpoint(), result.limit());
        let distance = result.distance();
        Self {
            output: output.display().to_string(),
            stop_reason: result.stop_reason().name(),
            error_estimate: checkpoint.error_estimate,
            accuracy_met: result.accuracy_met(),
            cycles: last.cycles,
            tau: last.tau,
            steps: checkpoint.progress.steps,
            rejected_steps: checkpoint.progress.rejected_steps,
            rate_evaluations: checkpoint.progress.rate_evaluations,
            wall_seconds: checkpoint.wall_seconds,
            indentation: last.indentation,
            normal_force: last.normal_force,
            contact_radius: last.contact_radius,
            stick_radius: last.stick_radius,
            wear_volume: last.wear_volume,
            wear_volume_limit: limit.map(LimitingShape::wear_volume),
            limit_distance: distance.map(|it| it.distance),
            limit_distance_relative: distance.and_then(|it| it.distance_relative),
            dissipated_energy: last.dissipated_energy,
            regime: last.regime,
            contact_radius_limit: limit.map(LimitingShape::contact_radius_limit),
            table: matches!(result.indenter(), Indenter::Table(_)).then(|| indenter(result.indenter())),
        }
    }

    /// A table for people.
    pub fn text(&self) -> String {
        let mut rows = self.rows(&format!("by a signal; go on with fretwear run --resume {}", self.output));
        rows.row("written to", &self.output);
        rows.finish()
    }

    /// All but the file.
    ///
    /// # Arguments
    /// * `interrupted` -- what is said of a run that was stopped
    fn rows(&self, interrupted: &str) -> Rows {
        let mut rows = Rows::default();
        if let Some(table) = &self.table {
            rows.row("indenter", table);
        }
        let stopped = match self.stop_reason {
            "end" => "at its end".to_owned(),
            "rate" => "when the rate of worn volume had fallen as asked".to_owned(),
            "unending" => "because the rate of worn volume asked for is never reached".to_owned(),
            "worn-out" => "with no pressure left outside the stick zone".to_owned(),
            _ => interrupted.to_owned(),
        };
        rows.row("stopped", stopped);
        rows.row("cycles", number(self.cycles));
        rows.row("dimensionless time τ", number(self.tau));
        let of_limit = |value: String, limit: String| format!("{value} of {limit} in the limit");
        let volume = |value: f64| Scale::VOLUME.show(value);
        rows.row(
            "worn volume",
            self.wear_volume_limit
                .map_or(volume(self.wear_volume), |it| of_limit(volume(self.wear_volume), volume(it))),
        );
        let length = |value: f64| Scale::LENGTH.show(value);
        rows.row(
            "contact radius",
            self.contact_radius_limit
                .map_or(length(self.contact_radius), |it| of_limit(length(self.contact_radius), length(it))),
        );
        rows.row("regime", self.regime.name());
        rows.row("stick radius", Scale::LENGTH.show(self.stick_radius));
        rows.row("normal force", Scale::FORCE.show(self.normal_force));
        rows.row("dissipated energy", Scale::ENERGY.show(self.dissipated_energy));
        rows.optional(
            "distance to the limit",
            self.limit_distance_relative.map(|it| format!("{} of its largest depth", number(it))),
        );
        rows.optional(
            "estimated error",
            self.error_estimate.map(|it| {
                let of =
                    if self.wear_volume_limit.is_some() { "the limit's" } else { "the largest of the run" };
                let missed = if self.accuracy_met == Some(false) { ", more than was asked for" } else { "" };
                format!("{} of {of}{missed}", number(it))
            }),
        );
        rows.row(
            "steps",
            format!(
                "{} and {} rejected, {} rate evaluations, {}",
                self.steps,
                self.rejected_steps,
                self.rate_evaluations,
                Scale::TIME.show(self.wall_seconds)
            ),
        );
        rows
    }
}

impl Results {
    /// What the run came to, a table for people.
    pub fn summary(&self) -> String {
        RunReport::new(self, Path::new("")).rows("before its end").finish()
    }
}
