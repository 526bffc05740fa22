//! `fretwear info`: what is in a result file.

use std::path::Path;

use serde::Serialize;

use super::text::{self, Scale, TextTable, shown};
use crate::contact::indenter::Shape;
use crate::data::quantity::{Entries, Reading, Value, number, word};
use crate::data::{Checkpoint, DatasetSummary, LimitDistance, ResultPath, RunFile, Snapshot};
use crate::error::Result;
use crate::laws::motion::Mode;
use crate::numerics::linear::largest;

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
    /// What [`LAST`] tells of the last snapshot; null without one.
    #[serde(flatten)]
    last: Entries,
    /// Distance to the limiting shape, where there is one.
    pub limit: Option<LimitDistance>,
    /// What [`CHECKPOINT`] tells of the checkpoint; null without one.
    #[serde(flatten)]
    checkpoint: Entries,
    /// The scene as TOML text.
    pub scene: String,
}

/// What is told of the last snapshot.
const LAST: [Reading<Snapshot>; 11] = [
    number("cycles", "1", "number of fretting cycles", |it: &Snapshot| it.cycles.into()),
    number("tau", "1", "dimensionless time", |it: &Snapshot| it.tau.into()).headed("dimensionless time τ"),
    number("indentation", "m", "largest indentation depth", |it: &Snapshot| it.indentation.into()),
    number("normal_force", "N", "normal force at the largest indentation", |it: &Snapshot| {
        it.normal_force.into()
    })
    .headed("normal force"),
    number("contact_radius", "m", "contact radius", |it: &Snapshot| it.contact_radius.into())
        .headed("contact radius"),
    word("regime", "what the oscillation does to the contact", |it: &Snapshot| it.regime.name().into()),
    number("stick_radius", "m", "radius of the stick zone per cycle", |it: &Snapshot| it.stick_radius.into())
        .headed("stick radius"),
    number(
        "permanent_stick_radius",
        "m",
        "radius within which nothing has slipped so far",
        |it: &Snapshot| it.permanent_stick_radius.into(),
    )
    .headed("permanent stick radius"),
    number("wear_volume", "m3", "worn volume", |it: &Snapshot| it.wear_volume.into()).headed("worn volume"),
    number("wear_depth_max", "m", "largest wear depth", |it: &Snapshot| largest(&it.wear_depth).into())
        .headed("largest wear depth"),
    number("dissipated_energy", "J", "energy dissipated by friction since the start", |it: &Snapshot| {
        it.dissipated_energy.into()
    })
    .headed("dissipated energy"),
];

/// What is told of a checkpoint.
const CHECKPOINT: [Reading<Checkpoint>; 7] = [
    number("checkpoint_cycles", "1", "number of fretting cycles done", |it: &Checkpoint| {
        it.state.cycles.into()
    })
    .headed("cycles done"),
    number("steps", "1", "steps accepted", |it: &Checkpoint| it.progress.steps.into()),
    number("rejected_steps", "1", "steps rejected", |it: &Checkpoint| it.progress.rejected_steps.into())
        .headed("rejected steps"),
    number("rate_evaluations", "1", "evaluations of the wear rate", |it: &Checkpoint| {
        it.progress.rate_evaluations.into()
    })
    .headed("evaluations of the wear rate"),
    number("wall_seconds", "s", "wall time used", |it: &Checkpoint| it.wall_seconds.into())
        .headed("wall time"),
    number("error_estimate", "1", "estimated error of worn volume and profile", |it: &Checkpoint| {
        it.error_estimate.into()
    })
    .headed("estimated error"),
    number(
        "accuracy_met",
        "1",
        "whether the estimated error is as small as was asked for",
        |it: &Checkpoint| it.accuracy_met().into(),
    )
    .headed("accuracy asked for"),
];

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
        Self {
            file: path.display().to_string(),
            title: run.header.title.clone(),
            complete: run.complete,
            stop_reason: run.stop_reason.name(),
            program_version: run.program_version.clone(),
            table: run.header.table.as_deref().map(Shape::words),
            path: run.header.path.as_deref().map(Mode::words),
            nodes: run.header.radius.len(),
            radius_first: run.header.radius.first().copied(),
            radius_last: run.header.radius.last().copied(),
            snapshots: run.snapshots.len(),
            last: Entries::of(&LAST, last),
            limit: run.header.limit.as_ref().zip(last).map(|(limit, last)| LimitDistance::new(limit, last)),
            checkpoint: Entries::of(&CHECKPOINT, run.checkpoint.as_ref()),
            scene: run.header.scene.clone(),
        }
    }

    /// A table for people, without the scene.
    pub fn text(&self) -> String {
        self.table().text()
    }

    /// Its lines.
    pub(crate) fn table(&self) -> TextTable {
        let mut rows = TextTable::titled(self.title.as_deref());
        let stopped = match (self.complete, self.checkpoint.get("checkpoint_cycles")) {
            (true, _) => format!("yes ({})", self.stop_reason),
            (false, Some(Value::Number(_))) => {
                format!("no ({}); go on with fretwear run --resume {}", self.stop_reason, self.file)
            }
            (false, _) => format!("no ({}), and without a checkpoint", self.stop_reason),
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
        put_readings(&mut rows, "at the last snapshot", &LAST, &self.last);
        let limit = self.limit.as_ref();
        present(
            &mut rows,
            "limiting shape",
            &[
                ("largest wear depth", limit.map(|it| length(it.wear_depth_max))),
                ("distance over indentation", limit.map(|it| text::number(it.distance))),
                ("distance over that depth", limit.and_then(|it| it.distance_relative).map(text::number)),
            ],
        );
        put_readings(&mut rows, "checkpoint", &CHECKPOINT, &self.checkpoint);
        rows
    }
}

/// What was read off a record, under a heading.
fn put_readings<R>(rows: &mut TextTable, heading: &str, readings: &[Reading<R>], entries: &Entries) {
    let line = |it: &Reading<R>| {
        let value = entries.get(it.quantity.name).unwrap_or(&Value::Missing);
        let words = match value {
            Value::Truth(holds) => Some(if *holds { "reached" } else { "not reached" }.to_owned()),
            value => shown(value, it.quantity.units),
        };
        (it.heading, words)
    };
    present(rows, heading, &readings.iter().map(line).collect::<Vec<_>>());
}

/// The rows that have a value, under a heading.
fn present(rows: &mut TextTable, heading: &str, values: &[(&str, Option<String>)]) {
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
pub fn arrays_text(summary: &DatasetSummary) -> String {
    let mut rows =
        TextTable::titled(Some(&summary.title).filter(|title| !title.is_empty()).map(String::as_str));
    rows.row("format", &summary.format);
    rows.row("complete", if summary.complete { "yes" } else { "no" });
    rows.row("written by version", &summary.program_version);
    rows.gap();
    for array in &summary.arrays {
        let shape: Vec<String> = array.shape.iter().map(usize::to_string).collect();
        let unit = if array.units == "1" { String::new() } else { format!(", {}", array.units) };
        rows.row(&array.name, format!("{}{unit}: {}", shape.join(" x "), array.long_name));
    }
    rows.text()
}
