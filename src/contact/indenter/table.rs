//! A measured profile: rows of radius and height from a file.

use std::any::Any;
use std::sync::Arc;

use super::Indenter;
use super::equivalent::Equivalent;
use super::shape::Shape;
use super::table_profile::{TabulatedProfile, refused};
use crate::error;
use crate::laws::entry::{Built, Columns, Entry, File, Row, Values};
use crate::units::{Dimension, Key, Kind, Range, Scale};

/// `[indenter.table]`.
pub static ENTRY: Entry<dyn Shape> =
    Entry::<dyn Shape>::new("table", "A measured profile.", &KEYS, build).columns(&COLUMNS);

const UNITS: [&str; 2] = ["radius_unit", "profile_unit"];
const SMOOTHING: &str = "smoothing";

const KEYS: [Key; 4] = [
    Key::new(
        "file",
        Kind::Name,
        "File of two columns r and f, from the tip at r = 0 outwards; relative to the scene.",
    )
    .example("profile.csv"),
    Key::new(UNITS[0], Kind::Name, "Unit of the radii, a length.").default("m"),
    Key::new(UNITS[1], Kind::Name, "Unit of the heights, a length.").default("m"),
    Key::quantity(
        SMOOTHING,
        Dimension::LENGTH,
        "Standard deviation of the noise in the heights, m: the profile is the smoothest curve with such residuals. 0 takes the rows as they \
         are.",
    )
    .range(Range::NOT_NEGATIVE)
    .example("20 nm")
    .optional(),
];

/// The rows may come in any order.
const COLUMNS: Columns = Columns {
    what: "a profile",
    count: "two",
    listed: "r and f",
    names: &["r", "f"],
    units: &UNITS,
    fewest: 2,
    most_rows: TabulatedProfile::MOST_ROWS,
    check: |row| match row[0] < 0.0 {
        true => Err("has a negative radius; give one flank, from the tip at r = 0 outwards".into()),
        false => Ok(()),
    },
};

fn build(values: &Values) -> Built<dyn Shape> {
    let deviation = values.optional(SMOOTHING).unwrap_or(0.0);
    if let Some(stored) = values.stored::<TabulatedProfile>() {
        if stored.deviation() == deviation {
            return Ok(stored);
        }
        // The scene was patched.
        let [radii, heights] = [stored.radii(), stored.heights()].map(<[f64]>::to_vec);
        return Ok(Arc::new(TabulatedProfile::smoothed(stored.source(), radii, heights, deviation)?));
    }
    let file = values.file()?;
    let (rows, tip) = from_the_tip(file, deviation > 0.0).map_err(refused)?;
    // A smoothed profile has its tip where the curve has it.
    if tip.written[1] != 0.0 && deviation == 0.0 {
        values.warnings.borrow_mut().push(format!(
            "{}: f is {} at r = 0; that height is subtracted from every row, so that f(0) = 0",
            file.path.display(),
            tip.written[1]
        ));
    }
    let (radius, height) = rows.iter().map(|row| (row.metres[0], row.metres[1] - tip.metres[1])).unzip();
    Ok(Arc::new(TabulatedProfile::smoothed(&*file.name, radius, height, deviation)?))
}

/// The rows in order of the radius, each once; the first is the tip. Noisy ones may lie below it.
fn from_the_tip(file: &File, noisy: bool) -> Result<(Vec<&Row>, &Row), String> {
    let radius = |row: &Row| row.metres[0];
    let mut rows: Vec<&Row> = file.rows.iter().collect();
    rows.sort_by(|a, b| radius(a).total_cmp(&radius(b)));
    let twice = |pair: &&[&Row]| radius(pair[0]) == radius(pair[1]) && pair[0].metres[1] != pair[1].metres[1];
    if let Some(pair) = rows.windows(2).find(twice) {
        let (first, second) =
            if pair[0].line < pair[1].line { (pair[0], pair[1]) } else { (pair[1], pair[0]) };
        return Err(format!(
            "lines {} and {} give the radius {} twice, with f = {} and f = {}; remove one",
            first.line, second.line, first.written[0], first.written[1], second.written[1]
        ));
    }
    rows.dedup_by(|a, b| radius(a) == radius(b));
    let tip = rows[0];
    if radius(tip) > 0.0 {
        return Err(format!(
            "begins at the radius {} (line {}); add a row for the tip, r = 0, from which f is measured",
            tip.written[0], tip.line
        ));
    }
    if let Some(row) = rows.iter().find(|row| row.metres[1] < tip.metres[1]).filter(|_| !noisy) {
        return Err(format!(
            "line {}: at r = {} the profile has f = {}, below its tip at r = 0 with f = {} (line {}); put r = 0 at the lowest point, with f \
             growing outwards; if that is noise, give the standard deviation of the heights as {}",
            row.line,
            row.written[0],
            row.written[1],
            tip.written[1],
            tip.line,
            TabulatedProfile::SMOOTHING
        ));
    }
    Ok((rows, tip))
}

impl Indenter {
    /// The rows of a measured profile, if it is one.
    pub fn table(&self) -> Option<Arc<TabulatedProfile>> {
        let shape: Arc<dyn Any + Send + Sync> = self.0.clone();
        shape.downcast().ok()
    }
}

impl Shape for TabulatedProfile {
    fn entry(&self) -> &'static Entry<dyn Shape> {
        &ENTRY
    }

    fn numbers(&self) -> Vec<f64> {
        vec![self.deviation()]
    }

    /// `table ball.csv, 201 rows, radius 0 to 0.5 mm, f to 12 µm`.
    fn words(&self) -> String {
        let smoothing = self
            .smoothing()
            .map_or_else(String::new, |it| format!(", smoothed with {}", Scale::LENGTH.show(it.deviation)));
        format!(
            "table {}, {} rows, radius 0 to {}, f to {}{smoothing}",
            self.source(),
            self.heights().len(),
            Scale::LENGTH.show(self.largest_radius()),
            Scale::LENGTH.show(self.heights().iter().copied().fold(0.0, f64::max)),
        )
    }

    fn profile(&self, r: f64) -> f64 {
        self.profile(r)
    }

    fn profile_derivative(&self, r: f64) -> f64 {
        self.profile_derivative(r)
    }

    fn radius_at_height(&self, height: f64) -> f64 {
        self.radius_at_height(height)
    }

    fn equivalent(&self, grading: f64) -> error::Result<Arc<dyn Equivalent>> {
        Ok(self.equivalent(grading)?)
    }

    fn rows(&self) -> Vec<&[f64]> {
        vec![self.radii(), self.heights()]
    }
}
