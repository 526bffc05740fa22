//! The job scripts: templates beside this file, filled in.

use std::path::{Path, PathBuf};

use super::measure::Measurement;
use super::proposal::Proposal;
use super::{Engine, Options, shell};
use crate::data::{AtomicFile, Mark, check_can_be_made, check_own, make_folder};
use crate::error::{Error, Result};

/// A script: its name and its template, in which `@NAME@` stands for a value.
type Script = (&'static str, &'static str);

const SLURM: [Script; 3] = [
    ("sweep.sbatch", include_str!("scripts/sweep.sbatch")),
    ("merge.sbatch", include_str!("scripts/merge.sbatch")),
    ("submit.sh", include_str!("scripts/submit-slurm.sh")),
];

const HYPERQUEUE: [Script; 3] = [
    ("sweep-hq.sh", include_str!("scripts/sweep-hq.sh")),
    ("merge-hq.sh", include_str!("scripts/merge-hq.sh")),
    ("submit.sh", include_str!("scripts/submit-hq.sh")),
];

/// The merged file, in the directory of the sweep.
const MERGED: &str = "merged.h5";

/// Memory of a process besides what its scenes need, and the least that is asked for; bytes.
const BASE_MEMORY: f64 = 0.5e9;
const LEAST_MEMORY: f64 = 1e9;

/// Memory of the merge for each scene, bytes; measured 0.5 kB.
const MERGE_MEMORY: f64 = 1e3;

/// Absolute paths that a script can hold.
#[derive(Debug)]
pub(super) struct Paths {
    program: String,
    study: String,
    folder: String,
    name: String,
}

impl Paths {
    /// Makes paths absolute; a job starts elsewhere.
    ///
    /// # Errors
    /// [`Error::File`] if one has a line break in it or is not UTF-8.
    pub(super) fn new(program: &Path, study: &Path, folder: &Path) -> Result<Self> {
        let stem = study.file_stem().unwrap_or_default().to_string_lossy();
        Ok(Self {
            program: absolute(program)?,
            study: absolute(study)?,
            folder: absolute(folder)?,
            name: format!("fretwear-{}", shell::job_name(&stem)),
        })
    }

    /// The file that the merge writes.
    pub(super) fn merged(&self) -> PathBuf {
        Path::new(&self.folder).join(MERGED)
    }
}

fn absolute(path: &Path) -> Result<String> {
    let refused = |why: &str| Error::File { path: path.to_owned(), why: why.into() };
    let absolute = std::path::absolute(path).map_err(|error| refused(&error.to_string()))?;
    match absolute.to_str() {
        None => Err(refused("is not valid UTF-8, which a job script needs; rename it")),
        Some(text) if text.chars().any(char::is_control) => Err(refused(
            "has a line break or another control character in it, which a job script cannot hold; rename it",
        )),
        Some(text) => Ok(text.into()),
    }
}

fn scripts(engine: Engine) -> &'static [Script] {
    match engine {
        Engine::Slurm => &SLURM,
        Engine::HyperQueue => &HYPERQUEUE,
    }
}

/// How scripts are known.
const MARK: Mark = Mark::Words("written by `fretwear submit`");

/// Refuses to overwrite scripts, which a user may have edited, and a directory that cannot be written; makes nothing.
pub(super) fn check(paths: &Paths, engine: Engine, overwrite: bool) -> Result<()> {
    let folder = Path::new(&paths.folder);
    if !folder.exists() {
        return check_can_be_made(folder);
    }
    if !folder.is_dir() {
        return make_folder(folder);
    }
    let [log, merged] = [folder.join("log"), paths.merged()];
    match log.symlink_metadata() {
        Ok(_) => make_folder(&log)?,
        Err(_) => check_can_be_made(&log)?,
    }
    AtomicFile::new(&merged, true)?;
    for (name, _) in scripts(engine) {
        let path = folder.join(name);
        if path.exists() && !overwrite {
            return Err(Error::Exists { path });
        }
        AtomicFile::new(&path, true)?;
        check_own(&path, MARK)?;
    }
    Ok(())
}

/// Writes the scripts of an engine into the directory, which is made if it is missing; returns their paths.
pub(super) fn write(
    paths: &Paths,
    options: &Options,
    proposal: &Proposal,
    measurement: &Measurement,
    scenes: u64,
) -> Result<Vec<PathBuf>> {
    let folder = Path::new(&paths.folder);
    // Slurm does not make the directory of a log, and a job without it fails in silence.
    make_folder(&folder.join("log"))?;
    let values = values(paths, options, proposal, measurement, scenes);
    let write = |(name, template): &Script| {
        let path = folder.join(name);
        AtomicFile::new(&path, options.overwrite)?.write(fill(template, &values).as_bytes())?;
        Ok(path)
    };
    scripts(options.engine).iter().map(write).collect()
}

/// What the names in the templates stand for.
fn values(
    paths: &Paths,
    options: &Options,
    proposal: &Proposal,
    measurement: &Measurement,
    scenes: u64,
) -> Vec<(&'static str, String)> {
    let memory = shard_memory(measurement, proposal.cpus_per_task);
    let more = match options.engine {
        Engine::Slurm => slurm_lines(options, memory.map(megabytes)),
        Engine::HyperQueue => {
            options.engine_options.iter().map(|it| format!(" {}", shell::quote(it))).collect()
        }
    };
    vec![
        ("NAME", paths.name.clone()),
        ("PROGRAM", shell::quote(&paths.program)),
        ("STUDY", shell::quote(&paths.study)),
        ("FOLDER", shell::quote(&paths.folder)),
        ("MERGED", shell::quote(&paths.merged().display().to_string())),
        ("SHARDS", proposal.shards.to_string()),
        ("LAST", (proposal.shards - 1).to_string()),
        ("CPUS", proposal.cpus_per_task.to_string()),
        ("MINUTES", proposal.time_limit.to_string()),
        ("LEAD", proposal.signal_lead.to_string()),
        ("INTERVAL", options.checkpoint_interval.unwrap_or(options.engine.checkpoint_interval()).to_string()),
        ("REQUEUES", options.most_requeues.to_string()),
        ("MORE", more),
        ("MERGEMORE", slurm_lines(options, memory.map(|it| megabytes(it.max(merge_memory(scenes)))))),
    ]
}

/// The lines of #SBATCH that not every cluster needs.
fn slurm_lines(options: &Options, memory: Option<String>) -> String {
    let memory = options.memory.clone().or(memory);
    let named = [
        ("--mem", memory),
        ("--partition", options.partition.clone()),
        ("--account", options.account.clone()),
    ];
    let named = named.into_iter().filter_map(|(name, value)| value.map(|value| format!("{name}={value}")));
    let lines = named.chain(options.engine_options.iter().cloned()).map(|it| format!("#SBATCH {it}"));
    lines.collect::<Vec<_>>().join("\n")
}

/// Twice what one scene needed, for each core, bytes: without a wish of ours many clusters give a job all the memory of its node, and so
/// the node.
fn shard_memory(measurement: &Measurement, cpus: usize) -> Option<f64> {
    Some((BASE_MEMORY + 2.0 * measurement.peak_memory? * cpus as f64).max(LEAST_MEMORY))
}

fn merge_memory(scenes: u64) -> f64 {
    BASE_MEMORY + MERGE_MEMORY * scenes as f64
}

/// An amount of memory as Slurm takes it, rounded up.
fn megabytes(bytes: f64) -> String {
    format!("{}M", (bytes / 1e8).ceil() as u64 * 100)
}

/// Puts values in place of `@NAME@`, in one pass: what a value contains is never taken for a name.
///
/// # Panics
/// If a template has a name that has no value.
fn fill(template: &str, values: &[(&str, String)]) -> String {
    let mut filled = String::with_capacity(2 * template.len());
    let mut rest = template;
    while let Some(at) = rest.find('@') {
        filled.push_str(&rest[..at]);
        let after = &rest[at + 1..];
        let name = after.find(|c: char| !c.is_ascii_uppercase()).map_or(after, |end| &after[..end]);
        if name.is_empty() || !after[name.len()..].starts_with('@') {
            filled.push('@');
            rest = after;
            continue;
        }
        let value = values.iter().find(|(known, _)| *known == name);
        filled.push_str(&value.unwrap_or_else(|| panic!("@{name}@ has no value")).1);
        rest = &after[name.len() + 1..];
    }
    filled.push_str(rest);
    filled
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_put_in_once() {
        let values = [("A", "@B@".to_string()), ("B", "b".to_string())];
        assert_eq!(fill("@A@ B:USR1@@B@ x@y @ @", &values), "@B@ B:USR1@b x@y @ @");
    }

    #[test]
    fn memory_grows_with_cores_and_scenes() {
        let measured = Measurement { peak_memory: Some(3e8), ..Measurement::told(1.0) };
        assert_eq!(shard_memory(&measured, 4).map(megabytes).as_deref(), Some("2900M"));
        assert_eq!(shard_memory(&measured, 0).map(megabytes).as_deref(), Some("1000M"));
        assert_eq!(megabytes(merge_memory(1_000_000)), "1500M");
    }
}
