//! `fretwear map`: what the maps show, in a few numbers.

use std::path::{Path, PathBuf};

use serde::Serialize;

use super::{Control, MapStudy, Optimum, Thresholds};
use crate::error::Result;
use crate::report::{TextTable, number};
use crate::scene::MapScene;

/// Summary of a wear map; the serialised fields are the keys of the JSON.
#[derive(Debug, Clone, Serialize)]
pub struct MapReport {
    /// Title of the map.
    #[serde(skip)]
    pub title: Option<String>,
    /// The files written.
    pub files: Vec<PathBuf>,
    /// Exponent of the indenter.
    pub exponent: f64,
    /// First and last grading.
    pub grading_range: [f64; 2],
    /// First and last `U/(μ_f d)`.
    pub amplitude_ratio_range: [f64; 2],
    /// Number of gradings and of amplitudes.
    pub points: [usize; 2],
    /// Smallest and largest `ΔV(k)/ΔV(0)` on the map; null where the homogeneous contact slides at every amplitude.
    pub wear_volume_ratio_range: Option<[f64; 2]>,
    /// Where the comparison of gradings turns.
    #[serde(flatten)]
    pub thresholds: Thresholds,
    /// The optimal grading over the amplitude at the same indentation.
    pub optimum: Vec<OptimumRow>,
}

/// One row of the table of optimal gradings.
#[derive(Debug, Clone, Serialize)]
pub struct OptimumRow {
    /// `U/(μ_f d)`.
    pub amplitude_ratio: f64,
    /// `k*`; 1 and -1 where the least is a limit, null where there is none.
    pub grading: f64,
    /// Where it is: `interior`, `k->1`, `k->-1`, `full-sliding` or `nowhere`.
    pub least_at: &'static str,
    /// Least worn volume over that of the homogeneous medium.
    pub wear_volume_ratio: f64,
}

impl MapReport {
    /// Computes the maps of a scene and writes their files into a directory.
    ///
    /// # Errors
    /// Those of the closed form; [`Error::File`](crate::Error::File) names a file that cannot be written, before anything is.
    pub fn write(scene: &MapScene, folder: &Path, overwrite: bool) -> Result<Self> {
        super::check_folder(folder, overwrite)?;
        let study = MapStudy::new(scene)?;
        let files = super::write(scene, &study, folder, overwrite)?;
        let map = &study.map;
        let ends = |values: &[f64]| [values[0], values[values.len() - 1]];
        let ratios = || map.ratio.iter().copied().filter(|ratio| ratio.is_finite());
        let least = ratios().fold(f64::INFINITY, f64::min);
        let at_indentation = study.optimum.iter().find(|curve| curve.control == Control::Indentation);
        let row = |it: &Optimum| OptimumRow {
            amplitude_ratio: it.amplitude_ratio,
            grading: it.grading,
            least_at: it.end.name(),
            wear_volume_ratio: it.volume_ratio,
        };
        Ok(Self {
            title: scene.title.clone(),
            files,
            exponent: scene.exponent,
            grading_range: ends(&map.gradings),
            amplitude_ratio_range: ends(&map.amplitude_ratios),
            points: [map.gradings.len(), map.amplitude_ratios.len()],
            wear_volume_ratio_range: least
                .is_finite()
                .then(|| [least, ratios().fold(f64::NEG_INFINITY, f64::max)]),
            thresholds: study.thresholds,
            optimum: at_indentation.iter().flat_map(|curve| curve.points.iter().map(row)).collect(),
        })
    }

    /// A table for people.
    pub fn text(&self) -> String {
        const MOST_ROWS: usize = 12;
        let range = |[from, to]: [f64; 2]| format!("{} to {}", number(from), number(to));
        let amplitude = |value: Option<f64>| value.map(|it| format!("U/(μ_f d) = {}", number(it)));
        let mut rows = TextTable::titled(self.title.as_deref());
        rows.row("indenter", format!("f = A r^{}", number(self.exponent)));
        rows.row("grading k", format!("{}, {} values", range(self.grading_range), self.points[0]));
        rows.row(
            "amplitude U/(μ_f d)",
            format!("{}, {} values", range(self.amplitude_ratio_range), self.points[1]),
        );
        rows.optional("worn volume over homogeneous", self.wear_volume_ratio_range.map(range));
        rows.gap();
        rows.optional("negative k is best below", amplitude(self.thresholds.optimum_crosses_zero));
        rows.optional("k → 1 beats k = 0 above", amplitude(self.thresholds.limit_beats_homogeneous));
        rows.optional("k → 1 is best above", amplitude(self.thresholds.limit_is_best));
        rows.gap();
        let stride = self.optimum.len().div_ceil(MOST_ROWS).max(1);
        for row in self.optimum.iter().step_by(stride) {
            let name = format!("best k at U/(μ_f d) = {}", number(row.amplitude_ratio));
            let part = |value: f64, words: &str| match value.is_nan() {
                true => String::new(),
                false => format!("{words}{}", number(value)),
            };
            let place = if row.least_at == "interior" { "" } else { row.least_at };
            let shown = [part(row.grading, ""), part(row.wear_volume_ratio, "wears "), place.to_string()];
            rows.row(&name, shown.iter().filter(|it| !it.is_empty()).cloned().collect::<Vec<_>>().join(", "));
        }
        rows.gap();
        for file in &self.files {
            rows.row("written", file.display());
        }
        rows.text()
    }
}
