//! The search: starts, deviations, accuracy of the runs, then uncertainty.

use super::journal::Runs;
use super::objective::{
    Comparison, Objective, coordinate_of, ground_count, has_centre, is_estimated, value_of,
};
use super::posterior::draws;
use super::prediction::Predictor;
use super::uncertainty::{combination, covariance, profile, quantile};
use super::{Combination, FittedData, Onlooker, Outcome, Parameter};
use crate::error::{Error, Result};
use crate::numerics::least_squares::{Minimum, cost, jacobian, minimise};
use crate::scene::sampling::{Method, UnitCube};
use crate::scene::{Calibration, Deviation, Measured};
use crate::units::number;

/// Accuracy of the first runs, and of the finest.
const ACCURACY: [f64; 2] = [1e-3, 1e-7];
/// Errors of the runs that are allowed, in deviations of the data.
const ALLOWED: f64 = 0.1;
/// How much finer the runs are that others are judged by.
const FINER: f64 = 0.1;
/// Rounds of better runs.
const MOST_REFINEMENTS: usize = 5;
/// Rounds in which deviations are estimated, and when they are steady.
const MOST_ESTIMATES: usize = 30;
const STEADY: f64 = 1e-4;
/// Starts for each unknown that costs runs, and how many of them are followed.
const STARTS: u64 = 4;
const FOLLOWED: usize = 3;
/// Values of an unknown without cost that are tried.
const TRIED: usize = 40;
/// Rounds from a place that turned out better.
const MOST_RESTARTS: usize = 5;
/// Residuals, in deviations, from which on a value is named as an outlier, and how many are.
const OUTLIER: f64 = 3.0;
const MOST_NAMED: usize = 10;
/// Reduced misfit that known deviations do not explain.
const UNEXPLAINED: f64 = 2.0;

/// A calibration under way.
pub(super) struct Fit<'a> {
    pub(super) calibration: &'a Calibration,
    pub(super) objective: Objective<'a>,
    /// Degrees of freedom of each data set.
    freedom: Vec<f64>,
}

impl<'a> Fit<'a> {
    pub(super) fn new(
        calibration: &'a Calibration,
        runs: Runs<'a>,
        onlooker: Option<&'a dyn Onlooker>,
    ) -> Result<Self> {
        let middle = |it: &crate::scene::Unknown| {
            let [low, high] = it.bounds.map(|end| coordinate_of(it, end));
            value_of(it, (low + high) / 2.0)
        };
        let values: Vec<f64> = calibration.unknowns().iter().map(middle).collect();
        let predictor = Predictor::new(calibration, &values, ACCURACY[0], runs)?;
        let objective = Objective::new(calibration, predictor, onlooker);
        let fitted = objective.coordinates.len() + calibration.data().iter().map(ground_count).sum::<usize>();
        let count = calibration.data().iter().map(|set| set.values.len()).sum::<usize>();
        let estimates = calibration.data().iter().filter(|set| is_estimated(set)).count();
        if count < fitted + estimates {
            let deviations = if estimates > 0 { " and the deviations" } else { "" };
            return Err(Error::Inconsistent {
                what: "data",
                why: format!(
                    "{count} values do not tell {fitted} numbers{deviations}; measure more, give deviations, or look for fewer unknowns"
                ),
            });
        }
        let freedom = calibration.data().iter().map(|set| set.values.len() as f64).collect();
        Ok(Self { calibration, objective, freedom })
    }

    /// What is found; none if it was stopped.
    pub(super) fn outcome(mut self) -> Result<Option<Outcome>> {
        let found = self.found();
        match self.objective.predictor.fatal.take() {
            Some(fatal) => Err(fatal),
            None => found,
        }
    }

    fn found(&mut self) -> Result<Option<Outcome>> {
        let Some(mut minimum) = self.first_minimum()? else { return Ok(None) };
        let mut run_error = f64::NAN;
        for _ in 0..MOST_REFINEMENTS {
            minimum = self.with_deviations(minimum)?;
            if self.objective.predictor.is_stopped() {
                return Ok(None);
            }
            let Some(error) = self.run_error(&minimum)? else { return Ok(None) };
            run_error = error;
            if !self.refine(error) {
                break;
            }
            minimum = self.follow(&minimum.place).ok_or_else(|| self.trouble())?;
        }
        let mut restarts = 0;
        let (minimum, profiles, slopes) = loop {
            let slopes = self.slopes(&minimum);
            let profiles = self.profiles(&minimum, &slopes);
            if self.objective.predictor.is_stopped() {
                return Ok(None);
            }
            match profiles.iter().find_map(|it| it.better.clone()) {
                Some(better) if restarts < MOST_RESTARTS => {
                    let found = self.follow(&better).ok_or_else(|| self.trouble())?;
                    minimum = self.with_deviations(found)?;
                    restarts += 1;
                }
                _ => break (minimum, profiles, slopes),
            }
        };
        let at = self.objective.compare(&minimum.place).ok_or_else(|| self.trouble())?;
        let bootstrap = match self.calibration.bootstrap() {
            0 => vec![None; self.calibration.unknowns().len()],
            _ => match self.bootstrap(&minimum, &at, &slopes)? {
                Some(found) => found,
                None => return Ok(None),
            },
        };
        let mut outcome = self.told(&minimum, &at, profiles, &slopes, run_error);
        for (parameter, interval) in outcome.parameters.iter_mut().zip(bootstrap) {
            parameter.bootstrap = interval;
        }
        Ok(Some(outcome))
    }

    /// Why the model has no prediction.
    fn trouble(&mut self) -> Error {
        let why = self.objective.predictor.trouble.take().map_or_else(String::new, |error| error.to_string());
        Error::NotConverged {
            what: "calibration",
            why: format!("the model predicts the data nowhere between the bounds; the last reason: {why}"),
        }
    }

    fn follow(&mut self, start: &[f64]) -> Option<Minimum> {
        let coordinates = self.objective.coordinates.clone();
        let held = vec![false; coordinates.len()];
        minimise(&mut |place| self.objective.residuals(place), start, &coordinates, &held, 0.0)
    }

    /// The best of several starts; none if it was stopped.
    fn first_minimum(&mut self) -> Result<Option<Minimum>> {
        let unknowns = self.calibration.unknowns();
        let dear: Vec<usize> =
            (0..unknowns.len()).filter(|it| !self.objective.predictor.is_free(*it)).collect();
        let free: Vec<usize> = (0..unknowns.len()).filter(|it| !dear.contains(it)).collect();
        let count = STARTS * dear.len() as u64 + 1;
        let cube = UnitCube::new(Method::Sobol, count, dear.len(), 0);
        let centres = self.objective.first_centres();
        let mut starts: Vec<(f64, Vec<f64>)> = vec![];
        for sample in 0..count {
            let bounds = |i: usize| self.objective.coordinates[i].bounds;
            let mut place: Vec<f64> =
                (0..unknowns.len()).map(|i| (bounds(i)[0] + bounds(i)[1]) / 2.0).collect();
            if sample > 0 {
                for (index, i) in dear.iter().enumerate() {
                    let [low, high] = bounds(*i);
                    place[*i] = low + cube.coordinate(sample, index) * (high - low);
                }
            }
            place.extend(&centres);
            let mut lowest = self.cost(&place);
            for i in &free {
                lowest = self.scan(&mut place, *i, lowest);
            }
            if self.objective.predictor.is_stopped() {
                return Ok(None);
            }
            if lowest.is_finite() {
                starts.push((lowest, place));
            }
        }
        starts.sort_by(|one, other| one.0.total_cmp(&other.0));
        self.objective.predictor.stay_close();
        starts.truncate(if dear.is_empty() { 1 } else { FOLLOWED });
        let mut best: Option<Minimum> = None;
        for (_, start) in starts {
            let found = self.follow(&start);
            if self.objective.predictor.is_stopped() {
                return Ok(None);
            }
            best = best.into_iter().chain(found).min_by(|one, other| one.cost.total_cmp(&other.cost));
        }
        best.map(Some).ok_or_else(|| self.trouble())
    }

    fn cost(&mut self, place: &[f64]) -> f64 {
        let residuals = self.objective.residuals(place);
        residuals.map_or(f64::INFINITY, |it| cost(&it))
    }

    /// Tries values of an unknown from below, until it only becomes worse.
    fn scan(&mut self, place: &mut [f64], unknown: usize, mut lowest: f64) -> f64 {
        let [low, high] = self.objective.coordinates[unknown].bounds;
        let mut best = place[unknown];
        let (mut worse, mut before) = (0, f64::INFINITY);
        for i in 0..=TRIED {
            place[unknown] = low + (high - low) * i as f64 / TRIED as f64;
            let cost = self.cost(place);
            worse = if cost > before && cost > 4.0 * lowest { worse + 1 } else { 0 };
            before = cost;
            if cost < lowest {
                (lowest, best) = (cost, place[unknown]);
            }
            if worse >= 3 {
                break;
            }
        }
        place[unknown] = best;
        lowest
    }

    /// The minimum with the deviations that it tells itself.
    fn with_deviations(&mut self, mut minimum: Minimum) -> Result<Minimum> {
        if self.calibration.data().iter().all(|set| matches!(set.deviation, Deviation::Known(_))) {
            return Ok(minimum);
        }
        for _ in 0..MOST_ESTIMATES {
            let at = self.objective.compare(&minimum.place).ok_or_else(|| self.trouble())?;
            self.count_freedom(&minimum);
            let change = self.objective.estimate_deviations(&at, &mut self.freedom);
            minimum = self.follow(&minimum.place).ok_or_else(|| self.trouble())?;
            if change < STEADY {
                break;
            }
        }
        Ok(minimum)
    }

    /// Degrees of freedom of each data set: its values, less its part of what was fitted.
    fn count_freedom(&mut self, minimum: &Minimum) {
        let data = self.calibration.data();
        let only = data.len() == 1;
        let slopes = if only { vec![] } else { self.slopes(minimum) };
        let covariance = (!only).then(|| covariance(&slopes));
        let mut first = 0;
        for (place, set) in data.iter().enumerate() {
            let count = set.values.len();
            let fitted = match &covariance {
                None => self.objective.coordinates.len() as f64,
                Some(covariance) => (first..first + count)
                    .map(|row| {
                        let all = 0..slopes.len();
                        all.clone()
                            .flat_map(|i| all.clone().map(move |j| (i, j)))
                            .map(|(i, j)| slopes[i][row] * covariance[(i, j)] * slopes[j][row])
                            .sum::<f64>()
                    })
                    .sum(),
            };
            self.freedom[place] = (count as f64 - fitted - ground_count(set) as f64).max(1.0);
            first += count;
        }
    }

    /// What finer runs change, the largest of: predictions, in deviations of the data, and estimates, in standard errors; none if it was stopped
    ///
    /// ```text
    /// δθ = (JᵀJ)⁻¹ Jᵀ δr
    /// ```
    ///
    /// Errors of runs are alike from value to value, so that those of the estimates may be the larger ones where there are many values.
    fn run_error(&mut self, minimum: &Minimum) -> Result<Option<f64>> {
        if !self.calibration.has_scene() {
            return Ok(Some(0.0));
        }
        let place = &minimum.place;
        let (values, centres) = (self.objective.values(place), self.objective.centres(place));
        let mut finer = self.objective.predictor.finer(FINER);
        let (mut worst, mut changes) = (0.0f64, vec![]);
        for (data, centre) in centres.iter().enumerate() {
            let own = self.objective.predictor.predict(data, &values, *centre);
            let other = finer.predict(data, &values, *centre);
            if finer.is_stopped() {
                self.objective.predictor.fatal = finer.fatal.take();
                return Ok(None);
            }
            let (Some(own), Some(other)) = (own, other) else {
                return Err(finer.trouble.take().unwrap_or_else(|| self.trouble()));
            };
            let errors = own.iter().zip(&other).zip(&self.objective.deviations[data]);
            worst = errors.map(|((a, b), deviation)| (a - b).abs() / deviation).fold(worst, f64::max);
            let [own, other] = [own, other].map(|plain| self.objective.compare_one(data, &plain).residuals);
            changes.extend(own.iter().zip(&other).map(|(a, b)| a - b));
        }
        self.objective.predictor.runs += finer.runs;
        let slopes = self.slopes(minimum);
        let covariance = covariance(&slopes);
        let right: Vec<f64> =
            slopes.iter().map(|it| it.iter().zip(&changes).map(|(a, b)| a * b).sum()).collect();
        for i in 0..self.calibration.unknowns().len() {
            let shift: f64 = (0..slopes.len()).map(|j| covariance[(i, j)] * right[j]).sum();
            let shift = shift.abs() / covariance[(i, i)].sqrt();
            worst = if shift.is_finite() { worst.max(shift) } else { worst };
        }
        Ok(Some(worst))
    }

    /// Asks for better runs where the data need them; whether any were asked for.
    fn refine(&mut self, error: f64) -> bool {
        if error <= ALLOWED || self.objective.predictor.accuracy.iter().all(|it| *it <= ACCURACY[1]) {
            return false;
        }
        let predictor = &mut self.objective.predictor;
        let wanted: Vec<f64> = predictor
            .accuracy
            .iter()
            .map(|it| (it * (ALLOWED / error).clamp(0.01, 0.3)).max(ACCURACY[1]))
            .collect();
        predictor.refine(&wanted);
        true
    }

    fn slopes(&mut self, minimum: &Minimum) -> Vec<Vec<f64>> {
        let coordinates = self.objective.coordinates.clone();
        let held = vec![false; coordinates.len()];
        let mut residuals = |place: &[f64]| self.objective.residuals(place);
        jacobian(&mut residuals, &minimum.place, &minimum.residuals, &coordinates, &held)
    }

    fn profiles(&mut self, minimum: &Minimum, slopes: &[Vec<f64>]) -> Vec<super::uncertainty::Profile> {
        let covariance = covariance(slopes);
        let t = quantile(self.freedom_of_deviations());
        let count = slopes.len();
        let mut found = vec![];
        for i in 0..self.calibration.unknowns().len() {
            let along: Vec<f64> = (0..count).map(|j| covariance[(j, i)] / covariance[(i, i)]).collect();
            let along: Vec<f64> = along.into_iter().map(|it| if it.is_finite() { it } else { 0.0 }).collect();
            found.push(profile(&mut self.objective, minimum, i, covariance[(i, i)].sqrt(), &along, t));
            if self.objective.predictor.is_stopped() || found.last().is_some_and(|it| it.better.is_some()) {
                break;
            }
        }
        found
    }

    /// Degrees of freedom of the estimated deviations; infinite where all are known.
    fn freedom_of_deviations(&self) -> f64 {
        let own = self.calibration.data().iter().zip(&self.freedom).filter(|(set, _)| is_estimated(set));
        let freedom: f64 = own.map(|(_, freedom)| freedom).sum();
        if freedom > 0.0 { freedom } else { f64::INFINITY }
    }

    fn told(
        &mut self,
        minimum: &Minimum,
        at: &[Comparison],
        profiles: Vec<super::uncertainty::Profile>,
        slopes: &[Vec<f64>],
        run_error: f64,
    ) -> Outcome {
        let unknowns = self.calibration.unknowns();
        let values = self.objective.values(&minimum.place);
        let covariance = covariance(slopes);
        let t = quantile(self.freedom_of_deviations());
        let correlation = |i: usize, j: usize| {
            let it = covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt();
            it.clamp(-1.0, 1.0)
        };
        let correlation: Vec<Vec<f64>> =
            (0..unknowns.len()).map(|i| (0..unknowns.len()).map(|j| correlation(i, j)).collect()).collect();
        let bounds: Vec<[f64; 2]> = self.objective.coordinates.iter().map(|it| it.bounds).collect();
        let draws = draws(&profiles, &correlation, &bounds, self.freedom_of_deviations());
        let draws = draws.iter().map(|it| self.objective.values(it)).collect();
        let parameters: Vec<Parameter> = unknowns
            .iter()
            .zip(profiles)
            .enumerate()
            .map(|(i, (unknown, profile))| Parameter {
                key: unknown.key.clone(),
                unit: unknown.unit,
                estimate: values[i],
                interval: profile.ends.map(|end| end.map(|it| value_of(unknown, it))),
                standard_error: covariance[(i, i)].sqrt()
                    * if unknown.is_logarithmic { values[i] } else { 1.0 },
                bootstrap: None,
                profile: profile.points.iter().map(|[x, rise]| [value_of(unknown, *x), *rise]).collect(),
            })
            .collect();
        let fitted = self.objective.coordinates.len()
            + self.calibration.data().iter().map(ground_count).sum::<usize>();
        let count: usize = at.iter().map(|it| it.residuals.len()).sum();
        let degrees_of_freedom = count as f64 - fitted as f64;
        let alike: Vec<f64> = self.objective.alike.iter().map(|it| it.sqrt()).collect();
        let plain =
            |place: usize| at[place].residuals.iter().map(|it| it * alike[place]).collect::<Vec<f64>>();
        let misfit: f64 = (0..at.len()).flat_map(plain).map(|it| it * it).sum();
        let centres = self.objective.centres(&minimum.place);
        let data = self.calibration.data().iter().enumerate().map(|(place, set)| FittedData {
            predicted: at[place].predicted.clone(),
            deviations: self.objective.deviations[place].clone(),
            residuals: plain(place),
            is_estimated: is_estimated(set),
            centre: has_centre(set).then(|| centres[place]),
            ground: at[place].ground.clone(),
        });
        let data: Vec<FittedData> = data.collect();
        let combinations = self.combinations(&parameters, slopes, t);
        let mut outcome = Outcome {
            parameters,
            correlation,
            draws,
            forecast: None,
            combinations,
            reduced_chi_squared: misfit / degrees_of_freedom,
            degrees_of_freedom,
            aicc: self.criterion(&data, fitted),
            data,
            warnings: vec![],
            runs: self.objective.predictor.runs,
            run_error,
            accuracy_met: run_error <= ALLOWED,
            wall_seconds: 0.0,
        };
        outcome.warnings = self.warnings(&outcome);
        outcome
    }

    /// Akaike's criterion with its correction for few values
    ///
    /// ```text
    /// AICc = -2 ln L + 2 K + 2 K (K + 1)/(n - K - 1)
    /// ```
    ///
    /// with the likelihood of normal errors, of which deviations that are estimated take the value most likely and count among the K numbers fitted.
    fn criterion(&self, data: &[FittedData], fitted: usize) -> f64 {
        let (mut likelihood, mut numbers, mut count) = (0.0, fitted as f64, 0.0);
        for it in data {
            let own = it.residuals.len() as f64;
            let misfit = cost(&it.residuals);
            likelihood += it.deviations.iter().map(|it| 2.0 * it.ln()).sum::<f64>();
            likelihood += if it.is_estimated { own * (misfit / own).ln() + own } else { misfit };
            numbers += f64::from(u8::from(it.is_estimated));
            count += own;
        }
        let spare = count - numbers - 1.0;
        let correction = if spare > 0.0 { 2.0 * numbers * (numbers + 1.0) / spare } else { f64::INFINITY };
        likelihood + 2.0 * numbers + correction
    }

    /// What is known of unknowns that are not known one by one.
    fn combinations(&mut self, parameters: &[Parameter], slopes: &[Vec<f64>], t: f64) -> Vec<Combination> {
        let unknowns = self.calibration.unknowns();
        let is_open = |i: &usize| !parameters[*i].is_identifiable() && unknowns[*i].is_logarithmic;
        let open: Vec<usize> = (0..parameters.len()).filter(is_open).collect();
        if open.len() < 2 {
            return vec![];
        }
        let known = combination(slopes, &open).filter(|(_, deviation)| t * deviation < 1.0);
        let combination = known.map(|(exponents, deviation)| {
            let factors = open.iter().zip(&exponents).filter(|(_, exponent)| **exponent != 0.0);
            let factors: Vec<(String, f64)> =
                factors.map(|(i, it)| (parameters[*i].key.clone(), *it)).collect();
            let value =
                open.iter().zip(&exponents).map(|(i, it)| parameters[*i].estimate.powf(*it)).product();
            Combination { factors, value, relative: t * deviation }
        });
        combination.into_iter().collect()
    }

    fn warnings(&self, outcome: &Outcome) -> Vec<String> {
        let mut warnings = self.calibration.notes().to_vec();
        let data = self.calibration.data();
        if self.calibration.has_scene() {
            let values: Vec<f64> = outcome.parameters.iter().map(|it| it.estimate).collect();
            for place in 0..data.len() {
                let scene = self.calibration.scene(place, &values, &[1.0], ACCURACY[0]);
                let own = scene.iter().flat_map(|it| it.warnings()).filter(|it| !warnings.contains(it));
                let own: Vec<String> = own.cloned().collect();
                warnings.extend(own);
            }
        }
        for parameter in outcome.parameters.iter().filter(|it| !it.is_identifiable()) {
            let side = match parameter.interval {
                [None, None] => "neither end",
                [None, _] => "no lower end",
                _ => "no upper end",
            };
            warnings.push(format!(
                "the data do not tell {}: between its bounds there is {side} of the interval of 95 %; other data, or another key held, would",
                parameter.key
            ));
        }
        for combination in &outcome.combinations {
            warnings.push(format!("what the data do tell is {}", combination.words()));
        }
        for (set, alike) in data.iter().zip(&self.objective.alike).filter(|(_, alike)| **alike > 1.0) {
            warnings.push(format!(
                "{}: errors of neighbouring points are alike, so that {} of them count as one in the intervals",
                set.file,
                number(*alike)
            ));
        }
        let estimated: Vec<bool> = data.iter().map(is_estimated).collect();
        let from_ground = |place: usize| {
            data[place].measured == Measured::Scar
                && self.freedom[place] + 2.0 < outcome.data[place].residuals.len() as f64 - 2.0
        };
        if estimated.iter().all(|it| *it) && !(0..data.len()).any(from_ground) {
            warnings.push("the deviations are estimated from the residuals, so that the reduced chi-squared is 1 by construction and says nothing".into());
        } else if outcome.reduced_chi_squared > UNEXPLAINED {
            warnings.push(format!(
                "the reduced chi-squared is {}: the deviations given do not explain the residuals, so that the intervals are too narrow; look for what the model leaves out, or leave deviations out to have them estimated",
                number(outcome.reduced_chi_squared)
            ));
        }
        let mut outliers = vec![];
        for (set, fitted) in data.iter().zip(&outcome.data) {
            for (line, residual) in
                set.lines.iter().zip(&fitted.residuals).filter(|(_, it)| it.abs() > OUTLIER)
            {
                outliers.push((residual.abs(), format!("{}:{line} ({residual:.1} deviations)", set.file)));
            }
        }
        outliers.sort_by(|one, other| other.0.total_cmp(&one.0));
        let outliers: Vec<String> = outliers.into_iter().map(|it| it.1).collect();
        if !outliers.is_empty() {
            let more = outliers.len().saturating_sub(MOST_NAMED);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            let named = outliers[..outliers.len().min(MOST_NAMED)].join(", ");
            warnings
                .push(format!("far from the fit lie {named}{more}; loss = \"huber\" lets them pull less"));
        }
        if !outcome.accuracy_met {
            warnings.push(format!(
                "finer runs differ by {} deviations of the data, more than {ALLOWED}: the estimates are no better than the runs",
                number(outcome.run_error)
            ));
        }
        warnings
    }
}
