//! Rows of results, and the columns they are stored in.

use serde::Serialize;

use crate::data::{Column, RunFile, SweepFile, SweepHeader, Values};
use crate::scene::{Input, Study, Task, schema};

/// What came out of one scene.
#[derive(Debug, Clone)]
pub(super) struct Row {
    pub scene: u64,
    /// In the order of [`Study::keys`].
    pub inputs: Vec<Input>,
    /// In the order of the schema; not numbers if the scene failed.
    pub numbers: Vec<f64>,
    /// In the order of the schema; empty if the scene failed.
    pub texts: Vec<String>,
    pub run: Option<RunFile>,
    /// What went wrong, if the scene failed.
    pub error: Option<String>,
}

/// Name, units and meaning of a column.
type Label = (&'static str, &'static str, &'static str);

/// Column that tells done scenes from failed ones.
pub(super) const STATUS: &str = "status";
/// Value of [`STATUS`] where a scene failed.
pub(super) const FAILED: &str = "failed";
/// Column that is not the same when a scene is done again.
pub(super) const WALL_SECONDS: &str = "wall_seconds";

const RUN_TEXTS: [Label; 1] = [("stop_reason", "1", "why the run stopped")];

const RUN_NUMBERS: [Label; 17] = [
    ("error_estimate", "1", "estimated error of worn volume and profile, relative to those of the limit"),
    (
        "accuracy_met",
        "1",
        "1 if the estimated error is as small as was asked for, 0 if not; missing where springs were given by hand",
    ),
    ("cycles", "1", "number of fretting cycles"),
    ("tau", "1", "dimensionless time"),
    ("steps", "1", "steps accepted"),
    ("rejected_steps", "1", "steps rejected"),
    ("rate_evaluations", "1", "evaluations of the wear rate"),
    (WALL_SECONDS, "s", "wall time used"),
    ("indentation", "m", "indentation depth"),
    ("normal_force", "N", "normal force"),
    ("contact_radius", "m", "contact radius"),
    ("stick_radius", "m", "radius of the stick zone"),
    ("wear_volume", "m3", "worn volume"),
    ("wear_volume_limit", "m3", "worn volume in the limit of many cycles"),
    ("limit_distance", "1", "largest distance of the profile to the limit, over the indentation"),
    ("limit_distance_relative", "1", "the same over the largest wear depth of the limit"),
    ("dissipated_energy", "J", "energy dissipated by friction since the start"),
];

const LIMIT_TEXTS: [Label; 1] = [("regime", "1", "what the oscillation does to the contact")];

const LIMIT_NUMBERS: [Label; 16] = [
    ("grading", "1", "grading k of E = E0 (z/z0)^k"),
    ("stiffness_ratio", "1", "tangential over normal stiffness"),
    ("normal_stiffness", "1", "normal stiffness c_N, N/m^(2+k)"),
    ("friction_coefficient", "1", "friction coefficient"),
    ("indentation", "m", "indentation depth"),
    ("normal_force", "N", "normal force before any wear"),
    ("amplitude", "m", "tangential amplitude"),
    ("amplitude_full_sliding", "m", "tangential amplitude from which on everything slides"),
    ("contact_radius_initial", "m", "contact radius before any wear"),
    ("stick_radius", "m", "radius of the stick zone"),
    ("contact_radius_limit", "m", "contact radius in the limit of many cycles"),
    ("slip_width_limit", "m", "width of the worn annulus in the limit"),
    ("contact_growth_limit", "m", "growth of the contact radius up to the limit"),
    ("wear_volume_limit", "m3", "worn volume in the limit of many cycles"),
    ("wear_volume_asymptotic", "m3", "the same for small amplitudes"),
    ("wear_depth_max", "m", "largest wear depth of the limit"),
];

/// The columns of a study.
#[derive(Debug, Clone)]
pub(super) struct Schema {
    keys: Vec<String>,
    /// Whether a key has numbers, and whether it has words.
    kinds: Vec<[bool; 2]>,
    texts: &'static [Label],
    numbers: &'static [Label],
}

impl Schema {
    pub(super) fn new(study: &Study) -> Self {
        let (texts, numbers): (&'static [Label], &'static [Label]) = match study.task() {
            Task::Run => (&RUN_TEXTS, &RUN_NUMBERS),
            Task::Limit => (&LIMIT_TEXTS, &LIMIT_NUMBERS),
        };
        let keys = study.keys().into_iter().map(str::to_owned).collect();
        Self { keys, kinds: study.kinds(), texts, numbers }
    }

    /// Texts and numbers of a report; of none if the scene failed.
    pub(super) fn results(&self, report: Option<&impl Serialize>) -> (Vec<String>, Vec<f64>) {
        let json = report.map(serde_json::to_value).transpose();
        let json = json.expect("reports have string keys and plain values only").unwrap_or_default();
        let text = |label: &Label| json[label.0].as_str().unwrap_or_default().to_owned();
        let truth = |value: &serde_json::Value| value.as_bool().map(|it| if it { 1.0 } else { 0.0 });
        let number = |label: &Label| {
            let value = &json[label.0];
            value.as_f64().or_else(|| truth(value)).unwrap_or(f64::NAN)
        };
        (self.texts.iter().map(text).collect(), self.numbers.iter().map(number).collect())
    }

    /// Rows as a file.
    pub(super) fn file(&self, header: SweepHeader, complete: bool, mut rows: Vec<Row>) -> SweepFile {
        rows.sort_by_key(|row| row.scene);
        let mut columns = vec![];
        for (index, key) in self.keys.iter().enumerate() {
            let numbers: Vec<f64> = rows
                .iter()
                .map(|row| if let Input::Number(number) = row.inputs[index] { number } else { f64::NAN })
                .collect();
            let texts = rows
                .iter()
                .map(|row| if let Input::Text(text) = &row.inputs[index] { text.as_str() } else { "" })
                .collect();
            let name = format!("input_{}", key.replace(['.', '-'], "_"));
            let long_name = format!("{key} of the scene, in SI");
            let units = schema::unit_of(key);
            let [has_numbers, has_words] = self.kinds[index];
            if has_numbers {
                columns.push(column(&name, &units, &long_name, Values::Numbers(numbers)));
            }
            // Where a key has both, the words have a column of their own.
            if has_words {
                let name = if has_numbers { format!("{name}_word") } else { name };
                columns.push(column(&name, "1", &long_name, Values::Texts(texts)));
            }
        }
        let status = |row: &Row| if row.error.is_some() { FAILED } else { "done" };
        let texts = rows.iter().map(status).collect();
        columns.push(column(STATUS, "1", "done or failed", Values::Texts(texts)));
        let texts = rows.iter().map(|row| row.error.as_deref().unwrap_or_default()).collect();
        columns.push(column("error", "1", "why the scene failed", Values::Texts(texts)));
        for (index, &(name, units, long_name)) in self.texts.iter().enumerate() {
            let values = rows.iter().map(|row| &row.texts[index]).collect();
            columns.push(column(name, units, long_name, Values::Texts(values)));
        }
        for (index, &(name, units, long_name)) in self.numbers.iter().enumerate() {
            let values = rows.iter().map(|row| row.numbers[index]).collect();
            columns.push(column(name, units, long_name, Values::Numbers(values)));
        }
        let scenes = rows.iter().map(|row| row.scene).collect();
        let runs = rows.into_iter().filter_map(|row| row.run.map(|run| (row.scene, run))).collect();
        SweepFile::new(header, complete, scenes, columns, runs)
    }
}

fn column(name: &str, units: &str, long_name: &str, values: Values) -> Column {
    Column { name: name.into(), units: units.into(), long_name: long_name.into(), values }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{LimitReport, RunReport};
    use crate::scene::Scene;
    use std::path::Path;

    #[test]
    fn every_key_of_the_reports_has_a_column() {
        let scene = Scene::read(Path::new("data/scenes/paraboloid.toml")).unwrap();
        let results = scene.simulate().unwrap();
        let reports = [
            (
                serde_json::to_value(RunReport::new(&results, Path::new(""))).unwrap(),
                &RUN_TEXTS[..],
                &RUN_NUMBERS[..],
            ),
            (
                serde_json::to_value(LimitReport::new(&scene, Some(&[])).unwrap()).unwrap(),
                &LIMIT_TEXTS[..],
                &LIMIT_NUMBERS[..],
            ),
        ];
        for (report, texts, numbers) in reports {
            let keys: Vec<&String> = report
                .as_object()
                .unwrap()
                .keys()
                .filter(|key| *key != "output" && *key != "profile")
                .collect();
            let columns: Vec<&str> = texts.iter().chain(numbers).map(|label| label.0).collect();
            for key in &keys {
                assert!(columns.contains(&key.as_str()), "{key} has no column");
            }
            assert_eq!(keys.len(), columns.len());
            assert!(numbers.iter().all(|label| !report[label.0].is_string()));
        }
    }
}
