//! The indenter follows a recorded path.

use std::any::Any;
use std::sync::Arc;

use serde_json::{Value, json};

use super::mode::Mode;
use crate::error::{Error, Result};
use crate::laws::entry::{Columns, Entry};
use crate::laws::path::PathPoint;
use crate::units::{Key, Kind};

/// `[loading.path]`.
pub static ENTRY: Entry<dyn Mode> = Entry::<dyn Mode>::new(
    "path",
    "The indenter follows a recorded path; the amplitude is left out.",
    &KEYS,
    |values| {
        if let Some(stored) = values.stored::<RecordedPath>() {
            return Ok(stored);
        }
        let file = values.file()?;
        let column = |place: usize| {
            file.rows.iter().map(|row| row.metres.get(place).copied().unwrap_or(0.0)).collect()
        };
        Ok(Arc::new(RecordedPath::new(&*file.name, column(0), column(1), column(2))?))
    },
)
.departs("a recorded path")
.columns(&COLUMNS)
.gives_amplitude();

const KEYS: [Key; 2] = [
    Key::new(
        "file",
        Kind::Name,
        "File of columns x, y and, if it changes, the indentation over that of the scene; relative to the scene.",
    )
    .example("path.csv"),
    Key::new(UNIT, Kind::Name, "Unit of all columns, a length.").default("m"),
];

const UNIT: &str = "displacement_unit";

const COLUMNS: Columns = Columns {
    what: "a path",
    count: "two or three",
    listed: "x, y and the indentation over that of the scene",
    names: &["x", "y", "indentation"],
    units: &[UNIT; 3],
    fewest: 2,
    most_rows: RecordedPath::MOST_ROWS,
    check: |_| Ok(()),
};

/// A period as recorded: closed, straight between its rows, starting at the first one.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedPath {
    /// Where the rows came from.
    pub source: String,
    /// Tangential displacement along x, m, seen from where the indenter is pressed on.
    pub x: Vec<f64>,
    /// The same along y, m.
    pub y: Vec<f64>,
    /// Indentation over that of the scene, m; zero throughout if the indentation is constant.
    pub indentation: Vec<f64>,
}

impl RecordedPath {
    /// Fewest rows of a path.
    pub const FEWEST_ROWS: usize = 3;

    /// Most rows of a path.
    pub const MOST_ROWS: usize = 10_000;

    /// Path through rows.
    ///
    /// # Arguments
    /// * `source` -- where the rows come from, in words; the name of the file as a rule
    /// * `x`, `y`, `indentation` -- m, shape `(row,)` each, as the fields
    ///
    /// # Errors
    /// [`Error::Inconsistent`] names `loading.path` and what is wrong with the rows.
    ///
    /// # Examples
    /// ```
    /// use fretwear::laws::motion::{Mode, RecordedPath};
    ///
    /// let path = RecordedPath::new("triangle", vec![0.0, 3e-6, 0.0], vec![0.0, 0.0, 4e-6], vec![0.0; 3])?;
    /// assert!((path.amplitude().unwrap() / 2.5e-6 - 1.0).abs() < 1e-15);
    /// # Ok::<(), fretwear::Error>(())
    /// ```
    pub fn new(source: impl Into<String>, x: Vec<f64>, y: Vec<f64>, indentation: Vec<f64>) -> Result<Self> {
        let refused = |why: String| Err(Error::Inconsistent { what: "loading.path", why });
        let rows = x.len();
        if y.len() != rows || indentation.len() != rows {
            return refused(format!(
                "it has {rows} values of x, {} of y and {} of the indentation",
                y.len(),
                indentation.len()
            ));
        }
        if !(Self::FEWEST_ROWS..=Self::MOST_ROWS).contains(&rows) {
            let (fewest, most) = (Self::FEWEST_ROWS, Self::MOST_ROWS);
            return refused(format!("it has {rows} rows; give from {fewest} to {most}"));
        }
        // What is formed from them must not overflow.
        let sound = |value: f64| value.abs() < 1e100;
        if let Some(value) = [&x, &y, &indentation].into_iter().flatten().find(|it| !sound(**it)) {
            return refused(format!("it holds {value:e} m; check the units"));
        }
        if x.iter().all(|it| *it == x[0]) && y.iter().all(|it| *it == y[0]) {
            return refused(
                "all its rows are at the same x and y: the indenter does not move along the surface".into(),
            );
        }
        Ok(Self { source: source.into(), x, y, indentation })
    }

    /// The path of a mode, if it is one.
    pub fn of(mode: &Arc<dyn Mode>) -> Option<Arc<Self>> {
        let mode: Arc<dyn Any + Send + Sync> = mode.clone();
        mode.downcast().ok()
    }
}

impl Mode for RecordedPath {
    fn entry(&self) -> Option<&'static Entry<dyn Mode>> {
        Some(&ENTRY)
    }

    /// Name and number of rows, which are enough to tell it.
    fn told(&self) -> Vec<(&'static str, Value)> {
        vec![("source", json!(self.source)), ("rows", json!(self.x.len()))]
    }

    fn words(&self) -> String {
        format!("path {}, {} rows", self.source, self.x.len())
    }

    /// The rows, every straight line between them cut evenly into the same number of parts; the amplitude plays no part.
    ///
    /// # Panics
    /// If there are no rows.
    fn period(&self, _: f64, substeps: usize) -> Vec<PathPoint> {
        let highest = self.indentations()[1];
        let columns = self.x.iter().zip(&self.y).zip(&self.indentation);
        let mut corners: Vec<PathPoint> = columns
            .map(|((&x, &y), &indentation)| PathPoint { tangential: [x, y], lift: highest - indentation })
            .collect();
        assert!(!corners.is_empty(), "a recorded path has rows");
        if corners.len() > 2 && corners.first() == corners.last() {
            corners.pop();
        }
        if corners.len() == 1 {
            corners.push(corners[0]);
        }
        let parts = substeps.div_ceil(corners.len()).max(1);
        let next = corners.iter().cycle().skip(1);
        let cut = |(from, to): (&PathPoint, &PathPoint)| {
            let (from, to) = (*from, *to);
            (0..parts).map(move |i| {
                let part = i as f64 / parts as f64;
                let between = |a: f64, b: f64| a + part * (b - a);
                PathPoint {
                    tangential: [0, 1].map(|axis| between(from.tangential[axis], to.tangential[axis])),
                    lift: between(from.lift, to.lift),
                }
            })
        };
        corners.iter().zip(next).flat_map(cut).collect()
    }

    fn indentations(&self) -> [f64; 2] {
        let end =
            |start: f64, choose: fn(f64, f64) -> f64| self.indentation.iter().copied().fold(start, choose);
        [end(f64::INFINITY, f64::min), end(f64::NEG_INFINITY, f64::max)]
    }

    fn scaled(&self, factor: f64) -> Option<Arc<dyn Mode>> {
        let times = |values: &[f64]| values.iter().map(|value| factor * value).collect();
        Some(Arc::new(Self { x: times(&self.x), y: times(&self.y), ..self.clone() }))
    }

    /// Half of the largest distance between two rows along the surface, m: of a straight path to and fro its amplitude.
    fn amplitude(&self) -> Option<f64> {
        let place = |row: usize| [self.x[row], self.y[row]];
        let mut largest = 0.0f64;
        for row in 0..self.x.len() {
            let [x, y] = place(row);
            largest =
                (0..row).map(place).fold(largest, |most, [u, v]| most.max((x - u).powi(2) + (y - v).powi(2)));
        }
        Some(0.5 * largest.sqrt())
    }

    fn rows(&self) -> Vec<&[f64]> {
        vec![&self.x, &self.y, &self.indentation]
    }
}
