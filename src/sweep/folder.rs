//! The directory of a sweep: which files are there, whose they are, and how parts become the file of a shard.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::SystemTime;

use sha2::{Digest, Sha256};

use super::Done;
use super::gathering::{Gathering, fold_files};
use super::rows::{Row, Schema};
use crate::error::{Error, Result};
use crate::snapshot::{SweepFile, SweepHeader, remove_abandoned};

/// Folder of the parts.
const PARTS: &str = "parts";

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

    /// Makes the directory.
    pub(super) fn create(&self) -> Result<()> {
        let parts = self.path.join(PARTS);
        fs::create_dir_all(&parts)
            .map_err(|error| self.error(&parts, &format!("the directory cannot be made: {error}")))
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
        if file.header.study_hash == self.header.study_hash {
            return Ok(file);
        }
        let what = if file.header.study != self.header.study {
            "another study"
        } else if file.header.base_scene != self.header.base_scene {
            "another base scene"
        } else {
            "another version of the program, or another measured profile"
        };
        Err(self.error(path, &format!("holds results of {what}; use another directory, or remove this one")))
    }

    /// Scenes of this shard that have a row.
    pub(super) fn done(&self) -> Result<Done> {
        let (gathered, _) = self.read()?;
        Ok(Done { failed: gathered.failed(), scenes: gathered.into_scenes() })
    }

    /// Writes rows as a new part.
    pub(super) fn write_part(&self, schema: &Schema, rows: Vec<Row>) -> Result<()> {
        let sequence = self.sequence.fetch_add(1, Ordering::Relaxed);
        let name = format!("{}-of-{}.{}.{sequence}.h5", self.header.shard, self.header.shards, self.attempt);
        schema.file(self.header.clone(), false, rows).write(&self.path.join(PARTS).join(name), true)
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
        for path in others.chain([&self.checkpoint(scene)]) {
            // Most scenes have none.
            let _ = fs::remove_file(path);
        }
    }
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

/// Number of the scene in the name of its checkpoint.
fn scene_of(name: &str) -> Option<u64> {
    name.strip_prefix("scene-")?.split('.').next()?.parse().ok()
}

/// Number and count of shards in the name of a shard's file.
pub(super) fn shard_of(path: &Path) -> Option<(u64, u64)> {
    let (shard, shards) = name_of(path).strip_prefix("shard-")?.strip_suffix(".h5")?.split_once("-of-")?;
    Some((shard.parse().ok()?, shards.parse().ok()?))
}

/// Number of shards by which the results in a directory are cut; none where there are none.
///
/// # Errors
/// [`Error::File`] if the directory cannot be read.
pub fn shards_in(folder: &Path) -> Result<Option<u64>> {
    Ok(counts(folder)?.first().map(|(_, shards)| *shards))
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
    let mut hasher = Sha256::new();
    hasher.update(format!("{host} {} {time} {:p}", std::process::id(), &host));
    hasher.finalize().iter().take(6).map(|byte| format!("{byte:02x}")).collect()
}
