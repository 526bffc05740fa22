//! All shards of a sweep as one table.

use std::path::{Path, PathBuf};

use serde::{Serialize, Serializer};

use super::folder::{files, is_part, parts_folder, shard_of};
use super::gathering::{Gathering, fold_files};
use super::shard_range;
use crate::data::{AtomicFile, SweepHeader, check_distinct};
use crate::error::{Error, Result};

/// What is in a merged file, or is missing for it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Merged {
    /// Scenes of the study.
    pub scenes: u64,
    /// Scenes that failed.
    pub failed: u64,
    /// Rows that were there more than once.
    pub duplicates: u64,
    /// Scenes without a row.
    pub missing: u64,
    /// Shards that lack scenes, increasing; in JSON as `--array` takes them.
    #[serde(serialize_with = "as_array")]
    pub missing_shards: Vec<u64>,
    /// Files read.
    pub files: usize,
}

fn as_array<S: Serializer>(shards: &[u64], serializer: S) -> std::result::Result<S::Ok, S::Error> {
    serializer.serialize_str(&array_syntax(shards))
}

/// Merges the files of a sweep into one, sorted by scene, without duplicates; writes nothing if scenes are missing.
///
/// # Errors
/// [`Error::File`] if there is nothing to merge, files are damaged or belong to different studies; [`Error::Inconsistent`] if they disagree
/// on a scene.
pub fn merge(folder: &Path, output: &Path, overwrite: bool) -> Result<Merged> {
    let list = || -> Result<Vec<PathBuf>> {
        let mut paths: Vec<_> = files(folder)?.into_iter().filter(|path| shard_of(path).is_some()).collect();
        paths.extend(files(&parts_folder(folder))?.into_iter().filter(|path| is_part(path)));
        Ok(paths)
    };
    // Before hundreds of files are read.
    AtomicFile::new(output, overwrite)?;
    list()?.iter().try_for_each(|input| check_distinct(output, input))?;
    let mut header: Option<SweepHeader> = None;
    let (gathered, paths) = fold_files(list, Gathering::default, |gathered, path, file| {
        let first = header.get_or_insert_with(|| file.header.clone());
        if file.header.study_hash != first.study_hash || file.header.shards != first.shards {
            return Err(Error::File {
                path: path.to_owned(),
                why: "belongs to another study, version or number of shards than the others".into(),
            });
        }
        gathered.add(file)
    })?;
    let Some(header) = header else {
        return Err(Error::File {
            path: folder.to_owned(),
            why: "holds no results of a sweep; run `fretwear sweep` first, or check the spelling".into(),
        });
    };
    let lacks =
        |shard: &u64| shard_range(*shard, header.shards, header.scenes).any(|scene| !gathered.has(scene));
    let merged = Merged {
        scenes: header.scenes,
        failed: gathered.failed(),
        duplicates: gathered.duplicates,
        missing: header.scenes.saturating_sub(gathered.len()),
        missing_shards: (0..header.shards).filter(lacks).collect(),
        files: paths.len(),
    };
    if merged.missing_shards.is_empty() {
        let header = SweepHeader { shard: 0, shards: 1, ..header };
        gathered.into_file(header, true).write(output, overwrite)?;
    }
    Ok(merged)
}

/// Numbers as Slurm writes them for `--array`.
///
/// ```
/// assert_eq!(fretwear::study::sweep::array_syntax(&[0, 3, 4, 5, 9]), "0,3-5,9");
/// ```
pub fn array_syntax(numbers: &[u64]) -> String {
    let mut runs: Vec<(u64, u64)> = vec![];
    for &number in numbers {
        match runs.last_mut() {
            Some((_, last)) if *last + 1 == number => *last = number,
            _ => runs.push((number, number)),
        }
    }
    let shown = |&(first, last): &(u64, u64)| match first == last {
        true => first.to_string(),
        false => format!("{first}-{last}"),
    };
    runs.iter().map(shown).collect::<Vec<_>>().join(",")
}
