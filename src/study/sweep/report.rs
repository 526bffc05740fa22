//! What `fretwear sweep` and `fretwear merge` say.

use std::path::Path;

use serde::Serialize;

use super::{Merged, SweepOptions, SweepOutcome, array_syntax};

/// The outcome of a sweep; the fields are the keys of the JSON.
#[derive(Debug, Clone, Serialize)]
pub struct SweepReport {
    /// The file of the shard; null if a signal came first.
    pub output: Option<String>,
    /// Number of the shard.
    pub shard: u64,
    /// Number of shards.
    pub shards: u64,
    /// Scenes of the shard.
    pub scenes: u64,
    /// Scenes that were done before this call.
    pub done_before: u64,
    /// Scenes done in this call.
    pub done: u64,
    /// Failed scenes of the shard so far.
    pub failed: u64,
    /// Whether every scene of the shard has a row.
    pub complete: bool,
    /// Wall time of this call, s.
    pub wall_seconds: f64,
}

impl SweepReport {
    /// Describes the outcome of a sweep.
    pub fn new(options: &SweepOptions, outcome: &SweepOutcome) -> Self {
        Self {
            output: outcome.file.as_ref().map(|file| file.display().to_string()),
            shard: options.shard,
            shards: options.shards,
            scenes: outcome.scenes,
            done_before: outcome.done_before,
            done: outcome.done,
            failed: outcome.failed,
            complete: outcome.file.is_some(),
            wall_seconds: outcome.wall_seconds,
        }
    }

    /// Some lines for people.
    pub fn text(&self) -> String {
        let Self { shard, shards, scenes, done_before, done, failed, wall_seconds, .. } = self;
        let rate = *done as f64 / wall_seconds.max(1e-9);
        let left = scenes - done_before - done;
        let end = match &self.output {
            Some(file) => format!("written to {file}"),
            None => format!("interrupted with {left} left; the same command goes on"),
        };
        format!(
            "shard {shard} of {shards}: {scenes} scenes, {done_before} done before, {done} now ({rate:.1}/s), {failed} failed\n{end}\n"
        )
    }
}

/// The outcome of a merge; the fields are the keys of the JSON.
#[derive(Debug, Clone, Serialize)]
pub struct MergeReport {
    /// The merged file; null if scenes are missing.
    pub output: Option<String>,
    /// What was merged.
    #[serde(flatten)]
    pub merged: Merged,
}

impl MergeReport {
    /// Describes what was merged into `output`.
    pub fn new(merged: &Merged, output: &Path) -> Self {
        Self {
            output: merged.missing_shards.is_empty().then(|| output.display().to_string()),
            merged: merged.clone(),
        }
    }

    /// Some lines for people.
    pub fn text(&self) -> String {
        let Merged { scenes, failed, duplicates, missing, missing_shards, files } = &self.merged;
        match &self.output {
            Some(output) => format!(
                "{scenes} scenes, {failed} failed, {duplicates} duplicates, from {files} files\nwritten to {output}\n"
            ),
            None => format!(
                "{missing} of {scenes} scenes are missing, nothing was written\n--array={}\n",
                array_syntax(missing_shards)
            ),
        }
    }
}
