//! A measured profile: rows of radius and height, and the curve through them.

use std::sync::{Arc, Mutex, PoisonError};

use super::cubic::Cubic;
use super::smoothing::{Smooth, Smoothing, smooth};
use super::table_equivalent::TabulatedEquivalent;
use crate::error::{Error, Result};
use crate::numerics::grid::lagrange_derivative;

/// Least distance of neighbouring rows, relative to their radius: the slope between them has an error of a millionth then, by rounding alone.
const CLOSEST: f64 = 1e-10;

/// Points of the polynomials whose slopes are taken at the rows.
const POINTS: usize = 5;

/// Profile `f(r)` given by rows, from the tip at `r = 0` outwards.
///
/// Between the rows it is a cubic whose slopes at the rows are those of the polynomial of fourth degree through the five nearest rows (third
/// degree for four rows), cut back where it would fall between rising rows. The slope is continuous; straight lines and
/// parabolas are reproduced, and a smooth profile with an error of the fourth power of the spacing.
///
/// # Examples
/// ```
/// use fretwear::contact::indenter::TabulatedProfile;
///
/// let radius: Vec<f64> = (0..20).map(f64::from).collect();
/// let height = radius.iter().map(|r| r * r).collect();
/// let profile = TabulatedProfile::new("parabola", radius, height)?;
/// assert!((profile.profile(4.5) - 20.25).abs() < 1e-13);
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct TabulatedProfile {
    source: String,
    radii: Vec<f64>,
    heights: Vec<f64>,
    curve: Cubic,
    smoothing: Option<Smoothing>,
    equivalent: Known,
}

/// The equivalent profile that was last asked for: every contact of a scene needs the same, and it takes a second for very many rows.
#[derive(Debug, Default)]
struct Known(Mutex<Option<Arc<TabulatedEquivalent>>>);

impl Clone for Known {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl PartialEq for Known {
    /// What is known of a table is no part of it.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl TabulatedProfile {
    /// Key of the standard deviation of heights that are to be smoothed.
    pub const SMOOTHING: &str = "indenter.table.smoothing";

    /// Fewest rows of a table.
    pub const FEWEST_ROWS: usize = 4;

    /// Most rows of a table: so many take a second or two to be prepared, and are more than any number of springs resolves.
    pub const MOST_ROWS: usize = 1_000_000;

    /// Profile through rows.
    ///
    /// # Arguments
    /// * `source` -- where the rows come from, in words; the name of the file as a rule
    /// * `radius` -- m, shape `(row,)`, increasing from 0
    /// * `height` -- `f`, m, shape `(row,)`, 0 at the first row and nowhere below
    ///
    /// # Errors
    /// [`Error::Inconsistent`] names `indenter.table`, the row and the value.
    pub fn new(source: impl Into<String>, radius: Vec<f64>, height: Vec<f64>) -> Result<Self> {
        Self::smoothed(source, radius, height, 0.0)
    }

    /// Profile near rows that are noisy: the smoothest curve whose residuals are those of noise of a standard deviation, even about the axis.
    ///
    /// The best paraboloid where that is such a curve, else a spline of the fifth degree; see [`TabulatedProfile::smoothing`]. A
    /// paraboloid keeps its radius of curvature on average, a sharp tip becomes round as far as the noise would hide it.
    ///
    /// # Arguments
    /// * `source`, `radius`, `height` -- as [`TabulatedProfile::new`] takes them, but for heights, which may lie below the first
    /// * `deviation` -- of the heights, m; 0 takes the rows as they are
    ///
    /// # Errors
    /// As [`TabulatedProfile::new`]; [`Error::Inconsistent`] names `indenter.table.smoothing` where it is negative, not finite, not below the height of the
    /// profile, or leaves no profile that rises.
    pub fn smoothed(
        source: impl Into<String>,
        radius: Vec<f64>,
        height: Vec<f64>,
        deviation: f64,
    ) -> Result<Self> {
        check(&radius, &height, deviation > 0.0).map_err(refused)?;
        check_deviation(&height, deviation)?;
        let smooth = if deviation > 0.0 { smooth(&radius, &height, deviation) } else { None };
        let (curve, smoothing) = match smooth {
            Some(Smooth { knots, values, slopes, smoothing }) => {
                check_smooth(&knots, &values, &smoothing)?;
                (Cubic::new(knots, &values, slopes), Some(smoothing))
            }
            None => {
                check_rows(&radius, &height).map_err(refused)?;
                let smoothing = (deviation > 0.0).then(|| Smoothing::none(deviation));
                (Cubic::new(radius.clone(), &height, slopes(&radius, &height)), smoothing)
            }
        };
        let finite = (0..curve.knots().len()).all(|i| curve.piece(i).iter().all(|it| it.is_finite()));
        if !finite {
            return Err(refused(
                "its rows are too close or too large to compute with; check the units".into(),
            ));
        }
        let equivalent = Known::default();
        Ok(Self { source: source.into(), radii: radius, heights: height, curve, smoothing, equivalent })
    }

    /// Where the rows come from.
    pub fn source(&self) -> &str {
        &self.source
    }

    /// Radii of the rows, m, shape `(row,)`, increasing from 0.
    pub fn radii(&self) -> &[f64] {
        &self.radii
    }

    /// Heights of the rows as measured, m, shape `(row,)`.
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }

    /// How the rows were smoothed; none where they are taken as they are.
    pub fn smoothing(&self) -> Option<&Smoothing> {
        self.smoothing.as_ref()
    }

    /// Standard deviation with which the rows were smoothed, m; 0 where they are taken as they are.
    pub fn deviation(&self) -> f64 {
        self.smoothing.map_or(0.0, |smoothing| smoothing.deviation)
    }

    /// Radii and heights between which the curve is a cubic: those of the rows where they are not smoothed.
    pub(crate) fn knots(&self) -> impl Iterator<Item = (f64, f64)> {
        self.curve.knots().iter().enumerate().map(|(i, r)| (*r, self.curve.at_knot(i)))
    }

    /// Radius of the last row, m.
    pub fn largest_radius(&self) -> f64 {
        self.radii[self.radii.len() - 1]
    }

    /// Profile `f(r)`, m, at radius `r >= 0`, m; not a number beyond the last row.
    pub fn profile(&self, r: f64) -> f64 {
        if r <= self.largest_radius() { self.curve.value(r) } else { f64::NAN }
    }

    /// Slope `f'(r)`, at radius `r >= 0`, m; not a number beyond the last row.
    pub fn profile_derivative(&self, r: f64) -> f64 {
        if r <= self.largest_radius() { self.curve.derivative(r) } else { f64::NAN }
    }

    /// Smallest radius, m, at which the profile has risen to `height`, m; that of the last row if it never does.
    pub fn radius_at_height(&self, height: f64) -> f64 {
        let knots = self.curve.knots();
        let Some(above) = (1..knots.len()).find(|&i| self.curve.at_knot(i) >= height) else {
            return self.largest_radius();
        };
        let [low, ..] = self.curve.piece(above - 1);
        knots[above - 1] + self.curve.climb(above - 1, height - low)
    }

    /// Its equivalent profile.
    pub(super) fn equivalent(&self, grading: f64) -> Result<Arc<TabulatedEquivalent>> {
        let known = || self.equivalent.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(equivalent) = known().as_ref().filter(|it| it.grading == grading) {
            return Ok(Arc::clone(equivalent));
        }
        // Not under the lock: threads may be at work on different gradings.
        let equivalent = Arc::new(TabulatedEquivalent::new(&self.curve, self.largest_radius(), grading)?);
        *known() = Some(Arc::clone(&equivalent));
        Ok(equivalent)
    }
}

pub(super) fn refused(why: String) -> Error {
    Error::Inconsistent { what: "indenter.table", why }
}

/// Checks the standard deviation of heights.
fn check_deviation(height: &[f64], deviation: f64) -> Result<()> {
    let (low, high) =
        height.iter().fold((0.0, 0.0), |(low, high): (f64, f64), f| (low.min(*f), high.max(*f)));
    let why = if !(deviation >= 0.0 && deviation.is_finite()) {
        format!("{deviation:e} m is outside [0, inf); give the standard deviation of the heights of the rows")
    } else if deviation >= high - low {
        format!(
            "{deviation:e} m is not below the height of the profile, {:e} m; give the standard deviation of the noise in its heights, and check \
             the unit",
            high - low
        )
    } else {
        return Ok(());
    };
    Err(Error::Inconsistent { what: TabulatedProfile::SMOOTHING, why })
}

/// Checks a smoothed profile.
fn check_smooth(knots: &[f64], values: &[f64], smoothing: &Smoothing) -> Result<()> {
    let deviation = smoothing.deviation;
    let lowest = (0..values.len()).fold(0, |low, i| if values[i] < values[low] { i } else { low });
    let why = if !values.iter().all(|it| it.is_finite()) {
        "the rows are too close or too large to smooth; check the units".to_owned()
    } else if values[values.len() - 1] <= 0.0 {
        format!(
            "smoothed with {deviation:e} m the profile does not rise from the tip outwards; check the rows and their units"
        )
    } else if values[lowest] < 0.0 {
        format!(
            "smoothed with {deviation:e} m the profile lies {:e} m below its tip at r = {:e} m; give a larger deviation if that is noise, else \
             measure from the lowest point",
            -values[lowest], knots[lowest]
        )
    } else {
        return Ok(());
    };
    Err(Error::Inconsistent { what: TabulatedProfile::SMOOTHING, why })
}

fn check(radius: &[f64], height: &[f64], noisy: bool) -> std::result::Result<(), String> {
    let (rows, heights) = (radius.len(), height.len());
    if rows != heights {
        return Err(format!("it has {rows} radii and {heights} heights"));
    }
    let (fewest, most) = (TabulatedProfile::FEWEST_ROWS, TabulatedProfile::MOST_ROWS);
    if !(fewest..=most).contains(&rows) {
        return Err(format!("it has {rows} rows of different radius; give from {fewest} to {most}"));
    }
    if let Some(row) = (0..rows).find(|&i| !(radius[i].is_finite() && height[i].is_finite())) {
        return Err(format!("row {} is r = {}, f = {}, not finite", row + 1, radius[row], height[row]));
    }
    if radius[0] != 0.0 || height[0] != 0.0 {
        let (r, f) = (radius[0], height[0]);
        return Err(format!(
            "it begins at r = {r:e} m with f = {f:e} m; the first row is the tip, r = 0 and f = 0"
        ));
    }
    if let Some(row) = (1..rows).find(|&i| radius[i] <= radius[i - 1]) {
        return Err(format!(
            "radius {:e} m follows {:e} m; they must increase",
            radius[row],
            radius[row - 1]
        ));
    }
    if !noisy {
        check_rows(radius, height)?;
    }
    let (largest, highest) = (radius[rows - 1], height.iter().fold(0.0, |m: f64, f| m.max(*f)));
    if highest == 0.0 {
        return Err(
            "every f is zero: a flat punch, whose contact radius is its own; give a profile that rises"
                .into(),
        );
    }
    // What is formed from them must not overflow.
    if !(largest < 1e100 && highest < 1e100 && radius[1] > 1e-100) {
        return Err(format!("radii to {largest:e} m and heights to {highest:e} m; check the units"));
    }
    Ok(())
}

/// Checks rows that are to be taken as they are.
fn check_rows(radius: &[f64], height: &[f64]) -> std::result::Result<(), String> {
    if let Some(row) = (1..radius.len()).find(|&i| radius[i] - radius[i - 1] <= CLOSEST * radius[i]) {
        return Err(format!(
            "its rows at r = {:e} m and r = {:e} m are so close that rounding decides the slope between them; remove one",
            radius[row - 1],
            radius[row]
        ));
    }
    match (0..height.len()).find(|&i| height[i] < 0.0) {
        None => Ok(()),
        Some(row) => Err(format!(
            "at r = {:e} m it lies {:e} m below the tip at r = 0; measure from the lowest point, or give the standard deviation of its heights \
             as {} if that is noise",
            radius[row],
            -height[row],
            TabulatedProfile::SMOOTHING
        )),
    }
}

/// Slopes at the rows by polynomials through the nearest ones.
fn slopes(radius: &[f64], height: &[f64]) -> Vec<f64> {
    let points = POINTS.min(radius.len());
    let slope = |row: usize| {
        let start = row.saturating_sub(points / 2).min(radius.len() - points);
        let mut weights = [0.0; POINTS];
        lagrange_derivative(&radius[start..start + points], radius[row], &mut weights);
        // The weights sum to zero: differences from the row keep the digits that heights far from zero would take.
        (0..points).map(|i| weights[i] * (height[start + i] - height[row])).sum()
    };
    (0..radius.len()).map(slope).collect()
}
