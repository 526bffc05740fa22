//! Intervals from the data fitted many times anew, with errors drawn from the residuals: normal errors are not assumed.

use super::fit::Fit;
use super::objective::{Comparison, ground_count, value_of};
use super::posterior::interval;
use super::uncertainty::{LEAST_GAIN, covariance};
use crate::error::Result;
use crate::numerics::least_squares::{Minimum, minimise};
use crate::scene::sampling::{Method, UnitCube};

impl Fit<'_> {
    /// For each unknown the ends of the interval that holds 95 % of the estimates from data made anew; none if it was stopped.
    ///
    /// Errors of a data set are drawn with replacement from its residuals over their deviations, less their mean and as many times larger as degrees
    /// of freedom were spent, `√(n/(n - p))`; of curves whose neighbours are alike in blocks. Deviations are held.
    pub(super) fn bootstrap(
        &mut self,
        minimum: &Minimum,
        at: &[Comparison],
        slopes: &[Vec<f64>],
    ) -> Result<Option<Vec<Option<[f64; 2]>>>> {
        let data = self.calibration.data();
        let (samples, seed) = (self.calibration.bootstrap(), self.calibration.seed());
        let values: usize = at.iter().map(|it| it.residuals.len()).sum();
        let cube = UnitCube::new(Method::Random, samples, 1, seed);
        let fitted = self.objective.coordinates.len() + data.iter().map(ground_count).sum::<usize>();
        let larger = (values as f64 / (values as f64 - fitted as f64).max(1.0)).sqrt();
        let unknowns = self.calibration.unknowns();
        let covariance = covariance(slopes);
        let coordinates = self.objective.coordinates.clone();
        let held = vec![false; coordinates.len()];
        let mut found = vec![vec![]; unknowns.len()];
        for sample in 0..samples {
            let mut errors = vec![];
            let mut made = vec![];
            let mut number = 0;
            for (place, fit) in at.iter().enumerate() {
                let count = fit.residuals.len();
                let plain = self.objective.alike[place].sqrt();
                let mean = fit.residuals.iter().sum::<f64>() / count as f64;
                let block = (self.objective.alike[place].ceil() as usize).clamp(1, count);
                let mut own = vec![];
                while own.len() < count {
                    let begin = (cube.coordinate(sample, number) * count as f64) as usize;
                    number += 1;
                    own.extend((0..block).map(|i| (fit.residuals[(begin + i) % count] - mean) * larger));
                }
                own.truncate(count);
                let deviations = &self.objective.deviations[place];
                let value = |i: usize| fit.predicted[i] + own[i] * plain * deviations[i];
                made.push((0..count).map(value).collect());
                errors.extend(own);
            }
            // Where a linear problem has its minimum; residuals fall where the prediction rises.
            let right: Vec<f64> =
                slopes.iter().map(|it| it.iter().zip(&errors).map(|(a, b)| a * b).sum()).collect();
            let step = |i: usize| (0..right.len()).map(|j| covariance[(i, j)] * right[j]).sum::<f64>();
            let start = |i: usize| {
                let [low, high] = coordinates[i].bounds;
                let there = minimum.place[i] - step(i);
                if there.is_finite() { there.clamp(low, high) } else { minimum.place[i] }
            };
            let start: Vec<f64> = (0..coordinates.len()).map(start).collect();
            self.objective.made = Some(made);
            let mut residuals = |place: &[f64]| self.objective.residuals(place);
            let there = minimise(&mut residuals, &start, &coordinates, &held, LEAST_GAIN);
            self.objective.made = None;
            if self.objective.predictor.is_stopped() {
                return Ok(None);
            }
            if let Some(there) = there {
                for ((unknown, place), all) in unknowns.iter().zip(&there.place).zip(&mut found) {
                    all.push(value_of(unknown, *place));
                }
            }
        }
        Ok(Some(found.into_iter().map(interval).collect()))
    }
}
