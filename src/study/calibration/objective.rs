//! Residuals of the data over what is looked for: the unknowns, and the centre of each scar and loop.

use super::Onlooker;
use super::prediction::Predictor;
use crate::numerics::least_squares::{Coordinate, cost};
use crate::scene::{Calibration, DataSet, Deviation, Measured, Unknown};

/// Beyond so many deviations Huber's loss grows in proportion; 95 % as efficient as squares where errors are normal.
const HUBER: f64 = 1.345;
/// Rounds in which offset and tilt are found where outliers pull less.
const ROUNDS: usize = 10;
/// Steps of differences: of an unknown that costs runs, whose errors they must outweigh; of one that does not; of a centre.
const STEPS: [f64; 3] = [1e-2, 1e-4, 1e-3];
/// The step over the width between the bounds, for an unknown that is looked for by differences.
const OF_WIDTH: f64 = 0.2;
/// From a median deviation to the standard deviation of normal errors.
const OF_MEDIAN: f64 = 1.4826;
/// Correlation of neighbours above which it is taken for this.
const MOST_ALIKE: f64 = 0.98;
/// Points of unworn ground that tell how rough it is.
const FEWEST_OF_GROUND: usize = 12;

/// Sums of squares over what is looked for.
pub(super) struct Objective<'a> {
    pub(super) calibration: &'a Calibration,
    pub(super) predictor: Predictor<'a>,
    pub(super) coordinates: Vec<Coordinate>,
    /// Standard deviations, shape `(data, value)`.
    pub(super) deviations: Vec<Vec<f64>>,
    /// How many neighbouring points of a curve count as one, because their errors are alike.
    pub(super) alike: Vec<f64>,
    /// Data made anew in the place of those measured, shape `(data, value)`.
    pub(super) made: Option<Vec<Vec<f64>>>,
    onlooker: Option<&'a dyn Onlooker>,
}

/// What a place comes to for a data set.
#[derive(Debug, Clone)]
pub(super) struct Comparison {
    /// With offset and tilt, in the unit of the values.
    pub(super) predicted: Vec<f64>,
    /// Differences over the deviations, smaller where neighbours are alike.
    pub(super) residuals: Vec<f64>,
    /// Offset and tilt.
    pub(super) ground: Vec<f64>,
    /// Whether the surface is worn there; of scars.
    pub(super) is_worn: Vec<bool>,
}

/// An unknown as it is looked for.
pub(super) fn coordinate_of(unknown: &Unknown, value: f64) -> f64 {
    if unknown.is_logarithmic { value.ln() } else { value }
}

/// The value of an unknown.
pub(super) fn value_of(unknown: &Unknown, coordinate: f64) -> f64 {
    if unknown.is_logarithmic {
        coordinate.exp().clamp(unknown.bounds[0], unknown.bounds[1])
    } else {
        coordinate
    }
}

/// Whether a data set has a centre of its own.
pub(super) fn has_centre(set: &DataSet) -> bool {
    matches!(set.measured, Measured::Scar | Measured::Loop)
}

/// Columns that are fitted along with a data set, exactly: offset and tilt of a scar, offset of a loop.
fn ground(set: &DataSet) -> Vec<Vec<f64>> {
    let ones = vec![1.0; set.values.len()];
    match set.measured {
        Measured::Scar => vec![ones, set.at.clone()],
        Measured::Loop => vec![ones],
        _ => vec![],
    }
}

/// Number of columns that are fitted along with a data set.
pub(super) fn ground_count(set: &DataSet) -> usize {
    match set.measured {
        Measured::Scar => 2,
        Measured::Loop => 1,
        _ => 0,
    }
}

fn extent(values: &[f64]) -> [f64; 2] {
    let fold = |of: fn(f64, f64) -> f64, start| values.iter().copied().fold(start, of);
    [fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY)]
}

impl<'a> Objective<'a> {
    pub(super) fn new(
        calibration: &'a Calibration,
        predictor: Predictor<'a>,
        onlooker: Option<&'a dyn Onlooker>,
    ) -> Self {
        let of_unknown = |(place, unknown): (usize, &Unknown)| {
            let bounds = unknown.bounds.map(|it| coordinate_of(unknown, it));
            let step = STEPS[usize::from(predictor.is_free(place))];
            let scale = if unknown.is_logarithmic { 1.0 } else { OF_WIDTH * (bounds[1] - bounds[0]) };
            Coordinate { bounds, step: step * scale }
        };
        let mut coordinates: Vec<_> = calibration.unknowns().iter().enumerate().map(of_unknown).collect();
        for set in calibration.data().iter().filter(|set| has_centre(set)) {
            let [low, high] = extent(&set.at);
            let reach = if set.measured == Measured::Scar { [low, high] } else { [low - high, high - low] };
            coordinates.push(Coordinate { bounds: reach, step: STEPS[2] * (high - low) });
        }
        let deviations = calibration.data().iter().map(first_deviations).collect();
        let alike = vec![1.0; calibration.data().len()];
        Self { calibration, predictor, coordinates, deviations, alike, made: None, onlooker }
    }

    /// Values of the unknowns at a place.
    pub(super) fn values(&self, place: &[f64]) -> Vec<f64> {
        self.calibration.unknowns().iter().zip(place).map(|(unknown, it)| value_of(unknown, *it)).collect()
    }

    /// Centres of the data sets at a place, zero for those that have none.
    pub(super) fn centres(&self, place: &[f64]) -> Vec<f64> {
        let mut own = place[self.calibration.unknowns().len()..].iter();
        let centre = |set: &DataSet| if has_centre(set) { own.next().copied().unwrap_or(0.0) } else { 0.0 };
        self.calibration.data().iter().map(centre).collect()
    }

    /// First guess of the centres: where the heights are lowest, smoothed; the middle of a loop.
    pub(super) fn first_centres(&self) -> Vec<f64> {
        let guess = |set: &DataSet| match set.measured {
            Measured::Scar => hollow(set),
            _ => extent(&set.at).iter().sum::<f64>() / 2.0,
        };
        self.calibration.data().iter().filter(|set| has_centre(set)).map(guess).collect()
    }

    /// Prediction and measurement of all data sets; none where the model has no prediction.
    pub(super) fn compare(&mut self, place: &[f64]) -> Option<Vec<Comparison>> {
        let (values, centres) = (self.values(place), self.centres(place));
        let mut found = vec![];
        for (data, centre) in centres.iter().enumerate() {
            let plain = self.predictor.predict(data, &values, *centre)?;
            found.push(self.compare_one(data, &plain));
        }
        Some(found)
    }

    /// What a prediction without offset and tilt comes to for a data set.
    pub(super) fn compare_one(&self, data: usize, plain: &[f64]) -> Comparison {
        let (set, robust) = (&self.calibration.data()[data], self.calibration.is_robust());
        let values = self.made.as_ref().map_or(&set.values, |it| &it[data]);
        let mut fit = compared(set, values, plain, &self.deviations[data], robust);
        let alike = self.alike[data].sqrt();
        fit.residuals.iter_mut().for_each(|it| *it /= alike);
        fit
    }

    /// Residuals whose squares add up to the cost; of Huber's loss, their roots with their signs.
    pub(super) fn residuals(&mut self, place: &[f64]) -> Option<Vec<f64>> {
        let robust = self.calibration.is_robust();
        let all = self.compare(place)?.into_iter().flat_map(|it| it.residuals);
        let all: Vec<f64> = all.map(|it| if robust { rooted(it) } else { it }).collect();
        if let Some(onlooker) = self.onlooker {
            onlooker.misfit(self.predictor.runs, cost(&all) / all.len().max(1) as f64);
        }
        cost(&all).is_finite().then_some(all)
    }

    /// Takes the deviations that this place tells, where they are not known.
    ///
    /// # Arguments
    /// * `freedom` -- degrees of freedom of each data set
    ///
    /// # Returns
    /// The largest change of one, relative.
    pub(super) fn estimate_deviations(&mut self, at: &[Comparison], freedom: &mut [f64]) -> f64 {
        let mut change = 0.0f64;
        let robust = self.calibration.is_robust();
        for (data, set) in self.calibration.data().iter().enumerate() {
            let fit = &at[data];
            let errors: Vec<f64> = set.values.iter().zip(&fit.predicted).map(|(y, p)| y - p).collect();
            let size = |errors: Vec<f64>, freedom: f64| match robust {
                true => {
                    OF_MEDIAN
                        * median(errors.iter().map(|it| it.abs()).collect())
                        * (errors.len() as f64 / freedom).sqrt()
                }
                false => (cost(&errors) / freedom).sqrt(),
            };
            let new = match &set.deviation {
                Deviation::Known(_) => continue,
                Deviation::Relative(part) => fit.predicted.iter().map(|it| part * it.abs()).collect(),
                Deviation::EstimatedRelative => {
                    let ratios =
                        errors.iter().zip(&fit.predicted).filter(|(_, p)| **p != 0.0).map(|(e, p)| e / p);
                    let part = size(ratios.collect(), freedom[data]);
                    fit.predicted.iter().map(|it| part * it.abs()).collect::<Vec<f64>>()
                }
                Deviation::Estimated => {
                    let is_bare = |it: &(&f64, &bool)| !*it.1;
                    let ground: Vec<f64> =
                        errors.iter().zip(&fit.is_worn).filter(is_bare).map(|it| *it.0).collect();
                    let bare = ground.len();
                    let own = match bare >= FEWEST_OF_GROUND && bare < errors.len() {
                        true => {
                            freedom[data] = (bare - ground_count(set)) as f64;
                            ground
                        }
                        false => errors,
                    };
                    if has_centre(set) {
                        let alike = likeness(&own);
                        change = change.max((alike / self.alike[data] - 1.0).abs());
                        self.alike[data] = alike;
                    }
                    let size = size(own, freedom[data]);
                    freedom[data] = (freedom[data] / self.alike[data]).max(1.0);
                    vec![size; set.values.len()]
                }
            };
            // Data without any error still have a finite one.
            let floor = 1e-9 * extent(&set.values).iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            for (old, new) in self.deviations[data].iter_mut().zip(new) {
                let new = new.max(floor).max(f64::MIN_POSITIVE);
                change = change.max((new / *old - 1.0).abs());
                *old = new;
            }
        }
        change
    }
}

/// How many neighbours count as one, `(1 + ρ)/(1 - ρ)` with the correlation `ρ` of neighbours; 1 where it could be by chance.
fn likeness(errors: &[f64]) -> f64 {
    let together: f64 = errors.windows(2).map(|pair| pair[0] * pair[1]).sum();
    let correlation = together / cost(errors).max(f64::MIN_POSITIVE);
    let by_chance = 2.0 / (errors.len() as f64).sqrt();
    if correlation > by_chance { (1.0 + correlation) / (1.0 - correlation.min(MOST_ALIKE)) } else { 1.0 }
}

/// Whether the deviations of a data set are estimated from it.
pub(super) fn is_estimated(set: &DataSet) -> bool {
    matches!(set.deviation, Deviation::Estimated | Deviation::EstimatedRelative)
}

fn first_deviations(set: &DataSet) -> Vec<f64> {
    let sizes: Vec<f64> = set.values.iter().map(|it| it.abs()).collect();
    let [low, high] = extent(&set.values);
    let largest = extent(&sizes)[1].max(f64::MIN_POSITIVE);
    // A relative deviation is of what is predicted, which is not known yet.
    let of_value = |part: f64| sizes.iter().map(|it| part * it.max(1e-3 * largest)).collect();
    match &set.deviation {
        Deviation::Known(all) => all.clone(),
        Deviation::Relative(part) => of_value(*part),
        Deviation::EstimatedRelative => of_value(0.1),
        Deviation::Estimated if has_centre(set) => {
            vec![(0.1 * (high - low)).max(f64::MIN_POSITIVE); sizes.len()]
        }
        Deviation::Estimated => vec![0.1 * largest; sizes.len()],
    }
}

fn compared(set: &DataSet, values: &[f64], plain: &[f64], deviations: &[f64], robust: bool) -> Comparison {
    let columns = ground(set);
    let mut weights = vec![1.0; plain.len()];
    let mut coefficients = vec![];
    let errors: Vec<f64> = values.iter().zip(plain).map(|(y, p)| y - p).collect();
    let with_ground = |coefficients: &[f64]| -> Vec<f64> {
        let of = |i: usize| {
            plain[i] + columns.iter().zip(coefficients).map(|(column, c)| c * column[i]).sum::<f64>()
        };
        (0..plain.len()).map(of).collect()
    };
    let rounds = if robust && !columns.is_empty() { ROUNDS } else { 1 };
    for _ in 0..rounds {
        let scale: Vec<f64> =
            weights.iter().zip(deviations).map(|(w, s): (&f64, &f64)| w.sqrt() / s).collect();
        coefficients = regression(&columns, &errors, &scale);
        let predicted = with_ground(&coefficients);
        for (i, weight) in weights.iter_mut().enumerate() {
            let residual = ((values[i] - predicted[i]) / deviations[i]).abs();
            *weight = if robust && residual > HUBER { HUBER / residual } else { 1.0 };
        }
    }
    let predicted = with_ground(&coefficients);
    let residuals = (0..plain.len()).map(|i| (values[i] - predicted[i]) / deviations[i]).collect();
    Comparison {
        predicted,
        residuals,
        ground: coefficients,
        is_worn: plain.iter().map(|it| *it != 0.0).collect(),
    }
}

/// Coefficients of columns that come nearest to values, by orthogonal columns.
fn regression(columns: &[Vec<f64>], values: &[f64], scale: &[f64]) -> Vec<f64> {
    let scaled = |of: &[f64]| -> Vec<f64> { of.iter().zip(scale).map(|(it, s)| it * s).collect() };
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let right = scaled(values);
    match columns {
        [] => vec![],
        [one] => {
            let one = scaled(one);
            vec![dot(&one, &right) / dot(&one, &one)]
        }
        [one, other, ..] => {
            // Two columns at most: ones and positions.
            let (one, other) = (scaled(one), scaled(other));
            let shift = dot(&one, &other) / dot(&one, &one);
            let apart: Vec<f64> = other.iter().zip(&one).map(|(b, a)| b - shift * a).collect();
            let length = dot(&apart, &apart);
            let tilt = if length > 0.0 { dot(&apart, &right) / length } else { 0.0 };
            let level = dot(&one, &right) / dot(&one, &one);
            vec![level - tilt * shift, tilt]
        }
    }
}

/// The root of twice Huber's loss, with the sign of the residual.
fn rooted(residual: f64) -> f64 {
    let size = residual.abs();
    if size <= HUBER { residual } else { (HUBER * (2.0 * size - HUBER)).sqrt().copysign(residual) }
}

pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => 0.0,
        count if count % 2 == 1 => values[middle],
        _ => (values[middle - 1] + values[middle]) / 2.0,
    }
}

/// Centre of the depth below a straight line through the two ends of a scar.
fn hollow(set: &DataSet) -> f64 {
    let mut points: Vec<(f64, f64)> = set.at.iter().copied().zip(set.values.iter().copied()).collect();
    points.sort_by(|one, other| one.0.total_cmp(&other.0));
    let end = (points.len() / 10).max(1);
    let mean = |points: &[(f64, f64)]| {
        let count = points.len() as f64;
        (points.iter().map(|it| it.0).sum::<f64>() / count, points.iter().map(|it| it.1).sum::<f64>() / count)
    };
    let (first, last) = (mean(&points[..end]), mean(&points[points.len() - end..]));
    let tilt = if last.0 > first.0 { (last.1 - first.1) / (last.0 - first.0) } else { 0.0 };
    let depth: Vec<f64> = points.iter().map(|(x, z)| first.1 + tilt * (x - first.0) - z).collect();
    let deep = extent(&depth)[1] / 2.0;
    let inside = points.iter().zip(&depth).filter(|(_, depth)| **depth >= deep && deep > 0.0);
    let (sum, weight) =
        inside.fold((0.0, 0.0), |(sum, weight), ((x, _), depth)| (sum + x * depth, weight + depth));
    if weight > 0.0 { sum / weight } else { (first.0 + last.0) / 2.0 }
}
