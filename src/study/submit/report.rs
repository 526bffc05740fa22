//! `fretwear submit`: what was measured, proposed and handed in.

use std::path::PathBuf;

use serde::Serialize;

use super::{Engine, MeasuredScene, Submission, Submitted};
use crate::report::{TextTable, number};

/// Summary of a submission; the serialised fields are the keys of the JSON.
#[derive(Debug, Clone, Serialize)]
pub struct SubmitReport {
    /// Title of the study.
    #[serde(skip)]
    pub title: Option<String>,
    /// `slurm` or `hyperqueue`.
    pub engine: &'static str,
    /// Number of scenes.
    pub scenes: u64,
    /// `run` or `limit`.
    pub task: &'static str,
    /// The scenes measured.
    pub measured: Vec<MeasuredScene>,
    /// Mean wall time of a scene on one core, s.
    pub seconds_per_scene: f64,
    /// Longest wall time of one, s.
    pub seconds_longest: f64,
    /// Number of shards.
    pub shards: u64,
    /// Cores of each.
    pub cpus_per_task: usize,
    /// Expected wall time of each, s.
    pub seconds_per_shard: f64,
    /// Time limit of each, minutes; null where the engine has none.
    pub time_limit_minutes: Option<u64>,
    /// How long before it the warning comes, s; null where the engine has none.
    pub signal_lead_seconds: Option<u64>,
    /// Most elements that the engine allows in an array.
    pub largest_array: u64,
    /// The scripts written.
    pub files: Vec<PathBuf>,
    /// The file that the merge will write.
    pub merged: PathBuf,
    /// Whether the engine took the jobs.
    pub submitted: bool,
    /// Numbers of the array and of the merge, as the engine told them.
    pub jobs: Vec<String>,
    /// The engine's words where it took no jobs.
    pub refusal: Option<String>,
}

impl SubmitReport {
    /// Describes a submission.
    pub fn new(submission: &Submission) -> Self {
        let Submission { measurement, proposal, .. } = submission;
        let slurm = submission.engine == Engine::Slurm;
        let (jobs, refusal) = match &submission.submitted {
            Some(Submitted::Jobs(jobs)) => (jobs.clone(), None),
            Some(Submitted::Refused(words)) => (vec![], Some(words.clone())),
            None => (vec![], None),
        };
        Self {
            title: submission.title.clone(),
            engine: submission.engine.name(),
            scenes: submission.scenes,
            task: submission.task.name(),
            measured: measurement.scenes.clone(),
            seconds_per_scene: measurement.mean_seconds,
            seconds_longest: measurement.longest_seconds,
            shards: proposal.shards,
            cpus_per_task: proposal.cpus_per_task,
            seconds_per_shard: proposal.seconds_per_shard,
            time_limit_minutes: slurm.then_some(proposal.time_limit),
            signal_lead_seconds: slurm.then_some(proposal.signal_lead),
            largest_array: proposal.largest_array,
            files: submission.files.clone(),
            merged: submission.merged.clone(),
            submitted: matches!(submission.submitted, Some(Submitted::Jobs(_))),
            jobs,
            refusal,
        }
    }

    /// A table for people.
    pub fn text(&self) -> String {
        let mut rows = TextTable::titled(self.title.as_deref());
        rows.row("scenes", format!("{}, task {}", self.scenes, self.task));
        let longest =
            format!("{} on average, {} at most", time(self.seconds_per_scene), time(self.seconds_longest));
        match self.measured.len() {
            0 => rows.row("a scene on one core", format!("{}, as told", time(self.seconds_per_scene))),
            count => rows.row("a scene on one core", format!("{longest}, of {count} measured here")),
        }
        for row in self.measured.iter().filter(|row| row.failure.is_some()) {
            rows.row(&format!("scene {} fails", row.scene), row.failure.as_deref().unwrap_or_default());
        }
        rows.row("all of them on one core", time(self.scenes as f64 * self.seconds_per_scene));
        rows.gap();
        let cores = if self.cpus_per_task == 1 { "core" } else { "cores" };
        rows.row(
            "shards",
            format!(
                "{} of {} {cores}, array of at most {}",
                self.shards, self.cpus_per_task, self.largest_array
            ),
        );
        rows.row("a shard", time(self.seconds_per_shard));
        if let (Some(limit), Some(lead)) = (self.time_limit_minutes, self.signal_lead_seconds) {
            rows.row("time limit", format!("{limit} min, with a warning {lead} s before"));
        }
        if self.seconds_per_shard > 3600.0 {
            rows.row(
                "longer than an hour",
                "give the shards more cores with --cpus-per-task, if the cluster has them",
            );
        }
        rows.gap();
        for file in &self.files {
            rows.row("written", file.display());
        }
        rows.row("to be merged into", self.merged.display());
        match (&self.jobs[..], self.submitted) {
            (_, false) => rows.row("submitted", "no; `bash submit.sh` beside the scripts does it"),
            ([array, merge, ..], true) => rows.row("submitted", format!("array {array}, then merge {merge}")),
            (jobs, true) => rows.row(
                "submitted",
                format!("job {}; then `bash merge-hq.sh` with this number", jobs.join(" ")),
            ),
        }
        rows.text()
    }
}

/// A time in the unit that people would use.
fn time(seconds: f64) -> String {
    const UNITS: [(f64, &str); 5] = [(86400.0, "d"), (3600.0, "h"), (60.0, "min"), (1.0, "s"), (1e-3, "ms")];
    // More than three digits would pretend to an accuracy that no such measurement has.
    let three = |value: f64| format!("{value:.2e}").parse().unwrap_or(value);
    let (unit, symbol) = UNITS.into_iter().find(|(unit, _)| seconds >= 2.0 * unit).unwrap_or(UNITS[4]);
    format!("{} {symbol}", number(three(seconds / unit)))
}

#[cfg(test)]
mod tests {
    use super::time;

    #[test]
    fn times_have_the_unit_that_people_would_use() {
        let shown = [0.0123456, 1.5, 90.0, 1234.5, 7200.0, 1e6].map(time);
        assert_eq!(shown, ["12.3 ms", "1500 ms", "90 s", "20.6 min", "2 h", "11.6 d"]);
    }
}
