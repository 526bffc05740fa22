//! The directory of a sweep: which files are there, whose they are, and how parts become the file of a shard.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::SystemTime;

use super::Done;
use super::gathering::{Gathering, fold_files};
use super::rows::{SceneResult, Schema};
use crate::data::{AtomicFile, Fingerprint, RunFile, SweepFile, SweepHeader, make_folder, remove_abandoned};
use crate::error::{Error, Result};
use crate::scene::Study;

/// Folder of the parts.
const PARTS: &str = "parts";

/// Digits of the name of an attempt.
const ATTEMPT_DIGITS: usize = 12;

/// The directory of a sweep, for one attempt at one shard.
pub(super) struct Folder {
    path: PathBuf,
    header: SweepHeader,
    /// A name that no other attempt has.
    attempt: String,
    sequence: AtomicU64,
    /// Checkpoints of scenes, by other attempts.
    checkpoints: HashMap<u64, Vec<PathBuf>>,
}

impl Folder {
    /// Looks at a directory, which need not be there; creates nothing.
    pub(super) fn new(path: &Path, header: SweepHeader) -> Result<Self> {
        let mut this = Self {
            path: path.to_owned(),
            header,
            attempt: attempt(),
            sequence: AtomicU64::new(0),
            checkpoints: HashMap::new(),
        };
        if path.exists() && !path.is_dir() {
            return Err(this.error(path, "is a file; name a directory"));
        }
        this.check_shards()?;
        for file in files(&path.join(PARTS))? {
            if let Some(scene) = scene_of(name_of(&file)) {
                this.checkpoints.entry(scene).or_default().push(file);
            }
        }
        Ok(this)
    }

    /// Refuses a directory that holds results cut into another number of shards.
    fn check_shards(&self) -> Result<()> {
        let other = counts(&self.path)?.into_iter().find(|(_, shards)| *shards != self.header.shards);
        let Some((file, shards)) = other else { return Ok(()) };
        let why = format!(
            "is one of {shards} shards, and {} are asked for; use the same number, or another directory",
            self.header.shards
        );
        Err(self.error(&file, &why))
    }

    fn error(&self, path: &Path, why: &str) -> Error {
        Error::File { path: path.to_owned(), why: why.to_owned() }
    }

    /// Makes the directory, and checks that the files of this shard can be written.
    pub(super) fn create(&self) -> Result<()> {
        make_folder(&self.path.join(PARTS))?;
        // What is there under this name was read as rows of this very study, or there is nothing.
        AtomicFile::new(&self.shard_file(), true)?;
        AtomicFile::new(&self.part_file(), true).map(drop)
    }

    /// A part that this attempt has not written yet.
    fn part_file(&self) -> PathBuf {
        let sequence = self.sequence.fetch_add(1, Ordering::Relaxed);
        let name = format!("{}-of-{}.{}.{sequence}.h5", self.header.shard, self.header.shards, self.attempt);
        self.path.join(PARTS).join(name)
    }

    fn shard_file(&self) -> PathBuf {
        self.path.join(format!("shard-{}-of-{}.h5", self.header.shard, self.header.shards))
    }

    /// The file of the shard, if it is there.
    pub(super) fn finished(&self) -> Option<PathBuf> {
        Some(self.shard_file()).filter(|file| file.exists())
    }

    /// The parts of this shard, by whomever.
    fn parts(&self) -> Result<Vec<PathBuf>> {
        let prefix = format!("{}-of-{}.", self.header.shard, self.header.shards);
        let mut parts = files(&self.path.join(PARTS))?;
        parts.retain(|file| name_of(file).starts_with(&prefix));
        Ok(parts)
    }

    /// All rows that are there of this shard, and the files they were read from.
    fn read(&self) -> Result<(Gathering, Vec<PathBuf>)> {
        let list = || {
            let mut paths = self.parts()?;
            paths.extend(self.finished());
            Ok(paths)
        };
        fold_files(list, Gathering::default, |gathered, path, file| gathered.add(self.checked(path, file)?))
    }

    /// Refuses a file of another study or version.
    fn checked(&self, path: &Path, file: SweepFile) -> Result<SweepFile> {
        let Self { header: SweepHeader { study, base_scene, study_hash, .. }, .. } = self;
        check_study(path, &file.header, study, base_scene, study_hash).map(|()| file)
    }

    /// Whether a study, with the files that it names as they are now, is that of this directory.
    pub(super) fn is_of(&self, study: &Study) -> bool {
        study.hash() == self.header.study_hash
    }

    /// Scenes of this shard that have a row.
    pub(super) fn done(&self) -> Result<Done> {
        let (gathered, _) = self.read()?;
        Ok(Done { failed: gathered.failed(), scenes: gathered.into_scenes() })
    }

    /// Writes rows as a new part.
    pub(super) fn write_part(&self, schema: &Schema, rows: Vec<SceneResult>) -> Result<()> {
        schema.file(self.header.clone(), false, rows).write(&self.part_file(), false)
    }

    /// Makes one file of all parts, and removes them.
    pub(super) fn compact(&self) -> Result<PathBuf> {
        let (gathered, paths) = self.read()?;
        let target = self.shard_file();
        let whole = gathered.into_file(self.header.clone(), true);
        whole.write(&target, true)?;
        let done: HashSet<u64> = whole.scenes.into_iter().collect();
        for path in paths.into_iter().filter(|path| *path != target) {
            // Another attempt may have done so.
            let _ = fs::remove_file(path);
        }
        done.iter().for_each(|&scene| self.remove_checkpoints(scene));
        let prefix = format!("{}-of-{}.", self.header.shard, self.header.shards);
        let own =
            |name: &str| name.starts_with(&prefix) || scene_of(name).is_some_and(|it| done.contains(&it));
        remove_abandoned(&self.path.join(PARTS), own);
        // The folder of the parts stays: other shards, or other attempts at this one, are about to write into it.
        Ok(target)
    }

    /// Where this attempt keeps the checkpoint of a scene.
    pub(super) fn checkpoint(&self, scene: u64) -> PathBuf {
        self.path.join(PARTS).join(format!("scene-{scene}.{}.h5", self.attempt))
    }

    /// Checkpoints of a scene by earlier attempts, the latest first.
    pub(super) fn checkpoints(&self, scene: u64) -> Vec<PathBuf> {
        let mut found = self.checkpoints.get(&scene).cloned().unwrap_or_default();
        found.sort_by_key(|path| fs::metadata(path).and_then(|it| it.modified()).ok());
        found.reverse();
        found
    }

    /// Removes all checkpoints of a scene that has a row.
    pub(super) fn remove_checkpoints(&self, scene: u64) {
        let others = self.checkpoints.get(&scene).into_iter().flatten();
        let others = others.filter(|path| is_checkpoint(path)).cloned();
        for path in others.chain([self.checkpoint(scene)]) {
            // Most scenes have none.
            let _ = fs::remove_file(path);
        }
    }
}

/// Whether a file under the name of a checkpoint is one: the unfinished run of some scene.
fn is_checkpoint(path: &Path) -> bool {
    RunFile::open(path).is_ok_and(|run| !run.complete)
}

/// Refuses a file whose rows are not those of a study.
fn check_study(path: &Path, file: &SweepHeader, study: &str, base_scene: &str, hash: &str) -> Result<()> {
    if file.study_hash == hash {
        return Ok(());
    }
    let what = if file.study != study {
        "another study"
    } else if file.base_scene != base_scene {
        "another base scene"
    } else {
        "another version of the program, or another measured profile or recorded path"
    };
    let why = format!("holds results of {what}; use another directory, or remove this file");
    Err(Error::File { path: path.to_owned(), why })
}

/// The files of a directory by name, temporaries aside; none if it is missing.
pub(super) fn files(folder: &Path) -> Result<Vec<PathBuf>> {
    let failed = |error: std::io::Error| Error::File {
        path: folder.to_owned(),
        why: format!("the directory cannot be read: {error}"),
    };
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(vec![]),
        Err(error) => return Err(failed(error)),
    };
    let mut files = vec![];
    for entry in entries {
        let path = entry.map_err(failed)?.path();
        let name = name_of(&path);
        if name.ends_with(".h5") && !name.starts_with('.') {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn name_of(path: &Path) -> &str {
    path.file_name().and_then(|name| name.to_str()).unwrap_or_default()
}

/// Number of the scene in the name of its checkpoint, `scene-NUMBER.ATTEMPT.h5`.
fn scene_of(name: &str) -> Option<u64> {
    let (number, attempt) = name.strip_prefix("scene-")?.strip_suffix(".h5")?.split_once('.')?;
    let is_digit = |it: u8| it.is_ascii_digit() || (b'a'..=b'f').contains(&it);
    let is_attempt = attempt.len() == ATTEMPT_DIGITS && attempt.bytes().all(is_digit);
    number.parse().ok().filter(|_| is_attempt)
}

/// Number and count of shards in the name of a shard's file.
pub(super) fn shard_of(path: &Path) -> Option<(u64, u64)> {
    let (shard, shards) = name_of(path).strip_prefix("shard-")?.strip_suffix(".h5")?.split_once("-of-")?;
    Some((shard.parse().ok()?, shards.parse().ok()?))
}

/// Number of shards by which the results of a study in a directory are cut; none where there are none.
///
/// # Errors
/// [`Error::File`] if the directory cannot be read, or holds results of another study or version.
pub fn shards_in(folder: &Path, study: &Study) -> Result<Option<u64>> {
    let (files, hash) = (counts(folder)?, study.hash());
    for (path, _) in &files {
        check_study(path, &SweepFile::read_header(path)?, study.text(), study.base_text(), &hash)?;
    }
    Ok(files.first().map(|(_, shards)| *shards))
}

/// The files of whole shards and of parts, each with the number of shards of its sweep.
fn counts(folder: &Path) -> Result<Vec<(PathBuf, u64)>> {
    let of_shard = |path: PathBuf| shard_of(&path).map(|(_, shards)| (path, shards));
    let of_part = |path: PathBuf| {
        let (_, rest) = name_of(&path).split_once("-of-").filter(|_| is_part(&path))?;
        let shards = rest.split('.').next()?.parse().ok()?;
        Some((path, shards))
    };
    let whole = files(folder)?.into_iter().filter_map(of_shard);
    Ok(whole.chain(files(&parts_folder(folder))?.into_iter().filter_map(of_part)).collect())
}

/// Folder of the parts of a sweep.
pub(super) fn parts_folder(folder: &Path) -> PathBuf {
    folder.join(PARTS)
}

/// Whether a file in the folder of the parts holds rows.
pub(super) fn is_part(path: &Path) -> bool {
    name_of(path).starts_with(|c: char| c.is_ascii_digit())
}

/// A name that no other process on any machine has now.
fn attempt() -> String {
    let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    let time = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(0, |it| it.as_nanos());
    let parts = format!("{host} {} {time} {:p}", std::process::id(), &host);
    Fingerprint::default().add(parts.as_bytes()).finish()[..ATTEMPT_DIGITS].to_owned()
}
