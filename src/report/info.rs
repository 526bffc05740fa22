//! `fretwear info`: what is in a result file.

use std::path::Path;

use serde::Serialize;

use super::text::{Rows, Scale, number, recorded_path, table};
use crate::data::{ArraySummary, Checkpoint, LimitDistance, ResultPath, RunFile, Snapshot, largest};
use crate::error::Result;

/// The content of a result file in SI; the fields are the keys of the JSON.
#[derive(Debug, Clone, Serialize)]
pub struct InfoReport {
    /// The file.
    pub file: String,
    /// Title of the scene.
    pub title: Option<String>,
    /// Whether the run reached its end.
    pub complete: bool,
    /// Why it stopped: `end`, `rate`, `interrupted`, `worn-out` or `unending`.
    pub stop_reason: &'static str,
    /// Version of the program that wrote the file.
    pub program_version: String,
    /// The measured profile of the indenter in words, where it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table: Option<String>,
    /// The recorded path that the indenter follows, in words, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<String>,
    /// Number of radial nodes.
    pub nodes: usize,
    /// Innermost node, m.
    pub radius_first: Option<f64>,
    /// Outermost node, m.
    pub radius_last: Option<f64>,
    /// Number of snapshots.
    pub snapshots: usize,
    /// Cycles at the last snapshot, as all that follows.
    pub cycles: Option<f64>,
    /// Dimensionless time.
    pub tau: Option<f64>,
    /// Indentation, m.
    pub indentation: Option<f64>,
    /// Normal force, N.
    pub normal_force: Option<f64>,
    /// Contact radius, m.
    pub contact_radius: Option<f64>,
    /// What the oscillation does to the contact: `stick`, `partial-slip` or `full-sliding`.
    pub regime: Option<&'static str>,
    /// Stick radius, m.
    pub stick_radius: Option<f64>,
    /// Radius within which nothing has slipped so far, m.
    pub permanent_stick_radius: Option<f64>,
    /// Worn volume, m³.
    pub wear_volume: Option<f64>,
    /// Largest wear depth, m.
    pub wear_depth_max: Option<f64>,
    /// Energy dissipated by friction since the start, J.
    pub dissipated_energy: Option<f64>,
    /// Distance to the limiting shape, where there is one.
    pub limit: Option<LimitDistance>,
    /// Cycles done at the checkpoint; none without a checkpoint, as all that follows.
    pub checkpoint_cycles: Option<f64>,
    /// Steps accepted.
    pub steps: Option<u64>,
    /// Steps rejected.
    pub rejected_steps: Option<u64>,
    /// Evaluations of the wear rate.
    pub rate_evaluations: Option<u64>,
    /// Wall time used, s.
    pub wall_seconds: Option<f64>,
    /// Estimated error of worn volume and profile, relative to those of the limit, or to the largest of the run where there is none.
    pub error_estimate: Option<f64>,
    /// Whether that is as small as was asked for; none where springs were given by hand.
    pub accuracy_met: Option<bool>,
    /// The scene as TOML text.
    pub scene: String,
}

impl InfoReport {
    /// Reads a result file.
    ///
    /// # Errors
    /// As [`RunFile::open`].
    pub fn read<'a>(file: impl Into<ResultPath<'a>>) -> Result<Self> {
        let file = file.into();
        Ok(Self::new(file.path(), &RunFile::open(file)?))
    }

    /// Describes a run that has been read from `path`.
    pub fn new(path: &Path, run: &RunFile) -> Self {
        let last = run.snapshots.last();
        let of_last = |value: fn(&Snapshot) -> f64| last.map(value);
        let checkpoint = run.checkpoint.as_ref();
        let count = |value: fn(&Checkpoint) -> u64| checkpoint.map(value);
        Self {
            file: path.display().to_string(),
            title: run.header.title.clone(),
            complete: run.complete,
            stop_reason: run.stop_reason.name(),
            program_version: run.program_version.clone(),
            table: run.header.table.as_deref().map(table),
            path: run.header.path.as_deref().map(recorded_path),
            nodes: run.header.radius.len(),
            radius_first: run.header.radius.first().copied(),
            radius_last: run.header.radius.last().copied(),
            snapshots: run.snapshots.len(),
            cycles: of_last(|it| it.cycles),
            tau: of_last(|it| it.tau),
            indentation: of_last(|it| it.indentation),
            normal_force: of_last(|it| it.normal_force),
            contact_radius: of_last(|it| it.contact_radius),
            regime: last.map(|it| it.regime.name()),
            stick_radius: of_last(|it| it.stick_radius),
            permanent_stick_radius: of_last(|it| it.permanent_stick_radius),
            wear_volume: of_last(|it| it.wear_volume),
            wear_depth_max: of_last(|it| largest(&it.wear_depth)),
            dissipated_energy: of_last(|it| it.dissipated_energy),
            limit: run.header.limit.as_ref().zip(last).map(|(limit, last)| LimitDistance::new(limit, last)),
            checkpoint_cycles: checkpoint.map(|it| it.state.cycles),
            steps: count(|it| it.progress.steps),
            rejected_steps: count(|it| it.progress.rejected_steps),
            rate_evaluations: count(|it| it.progress.rate_evaluations),
            wall_seconds: checkpoint.map(|it| it.wall_seconds),
            error_estimate: checkpoint.and_then(|it| it.error_estimate),
            accuracy_met: checkpoint.and_then(Checkpoint::accuracy_met),
            scene: run.header.scene.clone(),
        }
    }

    /// A table for people, without the scene.
    pub fn text(&self) -> String {
        let mut rows = Rows::titled(self.title.as_deref());
        let stopped = match (self.complete, self.checkpoint_cycles) {
            (true, _) => format!("yes ({})", self.stop_reason),
            (false, Some(_)) => {
                format!("no ({}); go on with fretwear run --resume {}", self.stop_reason, self.file)
            }
            (false, None) => format!("no ({}), and without a checkpoint", self.stop_reason),
        };
        rows.row("file", &self.file);
        rows.row("complete", stopped);
        rows.row("written by fretwear", &self.program_version);
        if let Some(table) = &self.table {
            rows.row("indenter", table);
        }
        if let Some(path) = &self.path {
            rows.row("mode", path);
        }
        let length = |value: f64| Scale::LENGTH.show(value);
        if let Some((first, last)) = self.radius_first.zip(self.radius_last) {
            rows.row("nodes", format!("{} from {} to {}", self.nodes, length(first), length(last)));
        }
        rows.row("snapshots", self.snapshots);
        let values: [(&str, Option<String>); 11] = [
            ("cycles", self.cycles.map(number)),
            ("dimensionless time τ", self.tau.map(number)),
            ("indentation", self.indentation.map(length)),
            ("normal force", self.normal_force.map(|it| Scale::FORCE.show(it))),
            ("contact radius", self.contact_radius.map(length)),
            ("regime", self.regime.map(str::to_owned)),
            ("stick radius", self.stick_radius.map(length)),
            ("permanent stick radius", self.permanent_stick_radius.map(length)),
            ("worn volume", self.wear_volume.map(|it| Scale::VOLUME.show(it))),
            ("largest wear depth", self.wear_depth_max.map(length)),
            ("dissipated energy", self.dissipated_energy.map(|it| Scale::ENERGY.show(it))),
        ];
        present(&mut rows, "at the last snapshot", &values);
        let limit = self.limit.as_ref();
        present(
            &mut rows,
            "limiting shape",
            &[
                ("largest wear depth", limit.map(|it| length(it.wear_depth_max))),
                ("distance over indentation", limit.map(|it| number(it.distance))),
                ("distance over that depth", limit.and_then(|it| it.distance_relative).map(number)),
            ],
        );
        present(
            &mut rows,
            "checkpoint",
            &[
                ("cycles done", self.checkpoint_cycles.map(number)),
                ("steps", self.steps.map(|it| it.to_string())),
                ("rejected steps", self.rejected_steps.map(|it| it.to_string())),
                ("evaluations of the wear rate", self.rate_evaluations.map(|it| it.to_string())),
                ("wall time", self.wall_seconds.map(|it| Scale::TIME.show(it))),
                ("estimated error", self.error_estimate.map(number)),
                (
                    "accuracy asked for",
                    self.accuracy_met.map(|met| if met { "reached" } else { "not reached" }.to_owned()),
                ),
            ],
        );
        rows.finish()
    }
}

/// The rows that have a value, under a heading.
fn present(rows: &mut Rows, heading: &str, values: &[(&str, Option<String>)]) {
    if values.iter().all(|(_, value)| value.is_none()) {
        return;
    }
    rows.gap();
    rows.row(heading, "");
    for (name, value) in values {
        if let Some(value) = value {
            rows.row(&format!("  {name}"), value);
        }
    }
}

/// What is in a file of arrays, a table for people.
pub fn arrays_text(summary: &ArraySummary) -> String {
    let mut rows = Rows::titled(Some(&summary.title).filter(|title| !title.is_empty()).map(String::as_str));
    rows.row("format", &summary.format);
    rows.row("complete", if summary.complete { "yes" } else { "no" });
    rows.row("written by version", &summary.program_version);
    rows.gap();
    for array in &summary.arrays {
        let shape: Vec<String> = array.shape.iter().map(usize::to_string).collect();
        let unit = if array.units == "1" { String::new() } else { format!(", {}", array.units) };
        rows.row(&array.name, format!("{}{unit}: {}", shape.join(" x "), array.long_name));
    }
    rows.finish()
}
