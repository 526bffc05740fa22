//! Rows of results, and the columns they are stored in.

use crate::data::quantity::{Quantity, Reading, Value, quantity};
use crate::data::{RunFile, SweepFile, SweepHeader, Words, column};
use crate::run::readings;
use crate::scene::{Input, Study, Task, schema};

/// What came out of one scene.
#[derive(Debug, Clone)]
pub(super) struct SceneResult {
    pub scene: u64,
    /// In the order of [`Study::keys`].
    pub inputs: Vec<Input>,
    /// In the order of the schema; none if the scene failed.
    pub results: Option<Vec<Value>>,
    pub run: Option<RunFile>,
    /// What went wrong, if the scene failed.
    pub error: Option<String>,
}

/// Column that tells done scenes from failed ones.
pub(super) const STATUS: &str = "status";
/// Value of [`STATUS`] where a scene failed.
pub(super) const FAILED: &str = "failed";
/// Column that is not the same when a scene is done again.
pub(super) const WALL_SECONDS: &str = "wall_seconds";

/// The columns of a study.
#[derive(Debug, Clone)]
pub(super) struct Schema {
    keys: Vec<String>,
    /// Whether a key has numbers, and whether it has words.
    kinds: Vec<[bool; 2]>,
    /// The results, and whether each is a word.
    results: Vec<(Quantity<'static>, bool)>,
}

impl Schema {
    pub(super) fn new(study: &Study) -> Self {
        fn all<R>(readings: &[Reading<R>]) -> Vec<(Quantity<'static>, bool)> {
            readings.iter().map(|it| (it.quantity, it.is_word)).collect()
        }
        let results = match study.task() {
            Task::Run => all(&readings::RUN),
            Task::Limit => all(&readings::LIMIT),
        };
        let keys = study.keys().into_iter().map(str::to_owned).collect();
        Self { keys, kinds: study.kinds(), results }
    }

    /// Rows as a file.
    pub(super) fn file(&self, header: SweepHeader, complete: bool, mut rows: Vec<SceneResult>) -> SweepFile {
        rows.sort_by_key(|row| row.scene);
        let mut columns = vec![];
        for (index, key) in self.keys.iter().enumerate() {
            let numbers: Vec<f64> = rows
                .iter()
                .map(|row| if let Input::Number(number) = row.inputs[index] { number } else { f64::NAN })
                .collect();
            let texts: Words = rows
                .iter()
                .map(|row| if let Input::Text(text) = &row.inputs[index] { text.as_str() } else { "" })
                .collect();
            let name = format!("input_{}", key.replace(['.', '-'], "_"));
            let long_name = format!("{key} of the scene, in SI");
            let units = schema::unit_of(key);
            let [has_numbers, has_words] = self.kinds[index];
            if has_numbers {
                columns.push(column(quantity(&name, units, &long_name), numbers));
            }
            // Where a key has both, the words have a column of their own.
            if has_words {
                let name = if has_numbers { format!("{name}_word") } else { name };
                columns.push(column(quantity(&name, "1", &long_name), texts));
            }
        }
        let status = |row: &SceneResult| if row.error.is_some() { FAILED } else { "done" };
        let texts: Words = rows.iter().map(status).collect();
        columns.push(column(quantity(STATUS, "1", "done or failed"), texts));
        let texts: Words = rows.iter().map(|row| row.error.as_deref().unwrap_or_default()).collect();
        columns.push(column(quantity("error", "1", "why the scene failed"), texts));
        for kind in [true, false] {
            for (index, (quantity, _)) in self.results.iter().enumerate().filter(|it| it.1.1 == kind) {
                let of =
                    |row: &SceneResult| row.results.as_ref().map_or(Value::Missing, |it| it[index].clone());
                columns.push(column(*quantity, Value::all(rows.iter().map(of), kind)));
            }
        }
        let scenes = rows.iter().map(|row| row.scene).collect();
        let runs = rows.into_iter().filter_map(|row| row.run.map(|run| (row.scene, run))).collect();
        SweepFile::new(header, complete, scenes, columns, runs)
    }
}
