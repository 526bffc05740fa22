//! All shards of a sweep as one table.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::folder::{files, is_part, parts_folder, shard_of};
use super::rows::{FAILED, STATUS, WALL_SECONDS};
use super::shard_range;
use crate::error::{Error, Result};
use crate::snapshot::{Column, SweepFile, SweepHeader, Values};

/// What is in a merged file, or is missing for it.
#[derive(Debug, Clone, PartialEq)]
pub struct Merged {
    /// Scenes of the study.
    pub scenes: u64,
    /// Scenes that failed.
    pub failed: u64,
    /// Rows that were there more than once.
    pub duplicates: u64,
    /// Scenes without a row.
    pub missing: u64,
    /// Shards that lack scenes, increasing.
    pub missing_shards: Vec<u64>,
    /// Files read.
    pub files: usize,
}

/// Merges the files of a sweep into one, sorted by scene, without duplicates; writes nothing if scenes are missing.
///
/// # Errors
/// [`Error::File`] if there is nothing to merge, files are damaged, belong to different studies, or disagree on a scene.
pub fn merge(folder: &Path, output: &Path, overwrite: bool) -> Result<Merged> {
    let mut paths: Vec<_> = files(folder)?.into_iter().filter(|path| shard_of(path).is_some()).collect();
    paths.extend(files(&parts_folder(folder))?.into_iter().filter(|path| is_part(path)));
    let Some(first) = paths.first() else {
        return Err(Error::File {
            path: folder.to_owned(),
            why: "holds no results of a sweep; run `fretwear sweep` first, or check the spelling".into(),
        });
    };
    let header = SweepFile::read_header(first)?;
    let mut found = vec![];
    for path in &paths {
        let file = SweepFile::read(path)?;
        if file.header.study_hash != header.study_hash || file.header.shards != header.shards {
            return Err(Error::File {
                path: path.clone(),
                why: format!(
                    "belongs to another study, version or number of shards than {}",
                    first.display()
                ),
            });
        }
        found.push(file);
    }
    let rows: u64 = found.iter().map(|file| file.scenes.len() as u64).sum();
    let present: BTreeSet<u64> = found.iter().flat_map(|file| file.scenes.iter().copied()).collect();
    let missing_shards: Vec<u64> = (0..header.shards)
        .filter(|&shard| {
            shard_range(shard, header.shards, header.scenes).any(|scene| !present.contains(&scene))
        })
        .collect();
    let (scenes, distinct) = (header.scenes, present.len() as u64);
    let mut merged = Merged {
        scenes,
        failed: 0,
        duplicates: rows - distinct,
        missing: scenes.saturating_sub(distinct),
        missing_shards,
        files: paths.len(),
    };
    if merged.missing_shards.is_empty() {
        let whole = gather(found, SweepHeader { shard: 0, shards: 1, ..header }, true)?;
        merged.failed = failed_scenes(&whole).len() as u64;
        whole.write(output, overwrite)?;
    }
    Ok(merged)
}

/// Numbers as Slurm writes them for `--array`.
///
/// ```
/// assert_eq!(fretwear::sweep::array_syntax(&[0, 3, 4, 5, 9]), "0,3-5,9");
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

/// Scenes of a file that failed.
pub(super) fn failed_scenes(file: &SweepFile) -> BTreeSet<u64> {
    let status = file.columns.iter().find(|column| column.name == STATUS);
    let Some(Column { values: Values::Texts(texts), .. }) = status else { return BTreeSet::new() };
    file.scenes
        .iter()
        .zip(texts.iter())
        .filter(|(_, text)| *text == FAILED)
        .map(|(scene, _)| *scene)
        .collect()
}

/// One file of the rows of many, sorted by scene, each scene once.
pub(super) fn gather(files: Vec<SweepFile>, header: SweepHeader, complete: bool) -> Result<SweepFile> {
    // Where the row of each scene is.
    let mut places: BTreeMap<u64, (usize, usize)> = BTreeMap::new();
    for (number, file) in files.iter().enumerate() {
        for (row, scene) in file.scenes.iter().enumerate() {
            match places.get(scene) {
                None => {
                    places.insert(*scene, (number, row));
                }
                Some(&other) => check_equal(&files, *scene, other, (number, row))?,
            }
        }
    }
    let Some(first) = files.first() else {
        return Err(Error::Inconsistent { what: "sweep", why: "there are no rows".into() });
    };
    let mut columns = vec![];
    for index in 0..first.columns.len() {
        let Column { name, units, long_name, values } = &first.columns[index];
        let same = files.iter().all(|file| file.columns.get(index).is_some_and(|it| it.name == *name));
        if !same {
            return Err(Error::Inconsistent {
                what: "sweep",
                why: format!("not every file has the column {name}; use one version of the program"),
            });
        }
        let values = match values {
            Values::Numbers(_) => Values::Numbers(
                places.values().map(|&(file, row)| number(&files[file].columns[index], row)).collect(),
            ),
            Values::Texts(_) => Values::Texts(
                places.values().map(|&(file, row)| text(&files[file].columns[index], row)).collect(),
            ),
        };
        columns.push(Column {
            name: name.clone(),
            units: units.clone(),
            long_name: long_name.clone(),
            values,
        });
    }
    let scenes = places.into_keys().collect();
    let mut runs: Vec<_> = files.into_iter().flat_map(|file| file.runs).collect();
    runs.sort_by_key(|(scene, _)| *scene);
    runs.dedup_by_key(|(scene, _)| *scene);
    Ok(SweepFile { header, complete, scenes, columns, runs })
}

fn number(column: &Column, row: usize) -> f64 {
    if let Values::Numbers(values) = &column.values { values[row] } else { f64::NAN }
}

fn text(column: &Column, row: usize) -> &str {
    if let Values::Texts(values) = &column.values { values.get(row) } else { "" }
}

/// Two rows of one scene must be the same but for the time they took.
fn check_equal(files: &[SweepFile], scene: u64, one: (usize, usize), other: (usize, usize)) -> Result<()> {
    let columns = |(file, _): (usize, usize)| files[file].columns.iter();
    let differs = columns(one).zip(columns(other)).find(|(a, b)| {
        a.name != WALL_SECONDS
            && (a.name != b.name
                || number(a, one.1).to_bits() != number(b, other.1).to_bits()
                || text(a, one.1) != text(b, other.1))
    });
    match differs {
        None => Ok(()),
        Some((column, _)) => Err(Error::Inconsistent {
            what: "sweep",
            why: format!(
                "scene {scene} has two different results for {}; one of the files was made by another program",
                column.name
            ),
        }),
    }
}
