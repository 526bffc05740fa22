//! Rows of many files as one table.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::rows::{FAILED, STATUS, WALL_SECONDS};
use crate::data::{RunFile, SweepFile, SweepHeader, Values, Variable};
use crate::error::{Error, Result};

/// How often files are read anew, and the first pause before: a process that put many parts into a larger file removes them one after the other, as
/// long as the file system takes.
const MOST_TRIES: u32 = 20;
const PAUSE: Duration = Duration::from_millis(5);

/// Doublings of the pause, to a second.
const MOST_DOUBLINGS: u32 = 8;

/// Reads files one after the other, and begins anew, after a while, where one has gone meanwhile: another process has put it into a larger one.
///
/// # Arguments
/// * `list` -- the files that are there now
/// * `start` -- what they are added to
/// * `add` -- adds one
pub(super) fn fold_files<T>(
    list: impl Fn() -> Result<Vec<PathBuf>>,
    start: impl Fn() -> T,
    mut add: impl FnMut(&mut T, &Path, SweepFile) -> Result<()>,
) -> Result<(T, Vec<PathBuf>)> {
    'again: for tried in 0..MOST_TRIES {
        let (mut sum, paths) = (start(), list()?);
        for path in &paths {
            match SweepFile::read(path) {
                Ok(file) => add(&mut sum, path, file)?,
                Err(_) if !path.exists() => {
                    std::thread::sleep(PAUSE * 2u32.pow(tried.min(MOST_DOUBLINGS)));
                    continue 'again;
                }
                Err(error) => return Err(error),
            }
        }
        return Ok((sum, paths));
    }
    Err(Error::Inconsistent { what: "sweep", why: "its files change all the time; try again later".into() })
}

/// Rows so far, in the order in which they came; each scene once.
#[derive(Debug, Default)]
pub(super) struct Gathering {
    /// Scene of each row.
    scenes: Vec<u64>,
    /// Row of each scene.
    rows: HashMap<u64, usize>,
    columns: Vec<Variable>,
    runs: BTreeMap<u64, RunFile>,
    /// Rows that were there already.
    pub duplicates: u64,
}

impl Gathering {
    /// Adds the rows of a file.
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if it has other columns, or another result for a scene.
    pub(super) fn add(&mut self, file: SweepFile) -> Result<()> {
        if self.scenes.is_empty() && self.columns.is_empty() {
            let empty =
                |it: &Variable| Variable { shape: vec![0], values: it.values.emptied(), ..it.clone() };
            self.columns = file.columns.iter().map(empty).collect();
        }
        let names = |columns: &[Variable]| columns.iter().map(|it| it.name.clone()).collect::<Vec<_>>();
        if names(&self.columns) != names(&file.columns) {
            return Err(Error::Inconsistent {
                what: "sweep",
                why: "its files have different columns; use one version of the program".into(),
            });
        }
        for (from, scene) in file.scenes.iter().enumerate() {
            if let Some(&row) = self.rows.get(scene) {
                self.check_equal(*scene, row, &file.columns, from)?;
                self.duplicates += 1;
                continue;
            }
            self.rows.insert(*scene, self.scenes.len());
            self.scenes.push(*scene);
            for (to, column) in self.columns.iter_mut().zip(&file.columns) {
                if !to.values.push_from(&column.values, from) {
                    return Err(Error::Inconsistent {
                        what: "sweep",
                        why: format!("{} is a number here and a word there", column.name),
                    });
                }
                to.shape[0] += 1;
            }
        }
        self.runs.extend(file.runs);
        Ok(())
    }

    /// Two rows of one scene must be the same but for the time they took.
    fn check_equal(&self, scene: u64, row: usize, others: &[Variable], other: usize) -> Result<()> {
        let same = |(one, two): (&Variable, &Variable)| one.values.same(row, &two.values, other);
        let mut columns = self.columns.iter().zip(others).filter(|(one, _)| one.name != WALL_SECONDS);
        match columns.find(|pair| !same(*pair)) {
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

    /// Whether a scene has a row.
    pub(super) fn has(&self, scene: u64) -> bool {
        self.rows.contains_key(&scene)
    }

    /// The scenes that have a row.
    pub(super) fn into_scenes(self) -> HashSet<u64> {
        self.rows.into_keys().collect()
    }

    /// Number of rows.
    pub(super) fn len(&self) -> u64 {
        self.scenes.len() as u64
    }

    /// Number of scenes that failed.
    pub(super) fn failed(&self) -> u64 {
        let status = self.columns.iter().find(|column| column.name == STATUS);
        let Some(Variable { values: Values::Texts(texts), .. }) = status else { return 0 };
        texts.iter().filter(|text| *text == FAILED).count() as u64
    }

    /// The rows as a file, sorted by scene.
    pub(super) fn into_file(mut self, header: SweepHeader, complete: bool) -> SweepFile {
        drop(self.rows);
        let mut order: Vec<usize> = (0..self.scenes.len()).collect();
        order.sort_unstable_by_key(|&row| self.scenes[row]);
        for column in &mut self.columns {
            let values = &column.values;
            let mut sorted = values.emptied();
            for &row in &order {
                sorted.push_from(values, row);
            }
            column.values = sorted;
        }
        let scenes = order.iter().map(|&row| self.scenes[row]).collect();
        SweepFile::new(header, complete, scenes, self.columns, self.runs.into_iter().collect())
    }
}
