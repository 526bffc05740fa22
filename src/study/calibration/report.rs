//! `fretwear calibrate`: what was found, and how well it is known.

use std::fmt::Write;
use std::path::PathBuf;

use serde::Serialize;

use super::files::{OF_VALUE, rows};
use super::forecast::{Band, CURVES, Forecast};
use super::models::{OF_MODEL, TELLS};
use super::{CONFIDENCE, Combination, FittedData, Judged, Outcome, Parameter};
use crate::data::quantity::Entries;
use crate::report::{Scale, TextTable, number};
use crate::scene::{Calibration, DataSet};
use crate::units::unit_in_words;

/// Summary of a calibration; the fields are the keys of the JSON.
#[derive(Debug, Clone, Serialize)]
pub struct CalibrationReport<'a> {
    /// Title of the calibration.
    pub title: Option<String>,
    /// The files written.
    pub files: Vec<PathBuf>,
    /// The unknowns; what the data do not tell is null.
    parameters: Vec<Told>,
    /// Probability that an interval holds the truth.
    pub confidence: f64,
    /// Misfit over degrees of freedom.
    pub reduced_chi_squared: f64,
    /// Values less what was fitted to them.
    pub degrees_of_freedom: f64,
    /// Correlations of the estimates, shape `(parameter, parameter)`.
    pub correlation: &'a [Vec<f64>],
    /// Products that are known where single unknowns are not.
    combinations: Vec<Product<'a>>,
    /// Centre, offset and tilt of scars and loops.
    data: Vec<Ground<'a>>,
    /// Akaike's criterion with its correction for few values.
    pub aicc: f64,
    /// The laws that were compared, the best first; all else is of the best.
    models: Vec<Entries>,
    /// All measured values.
    residuals: Vec<Entries>,
    /// What was foretold of another scene; null where that was not asked for.
    forecast: Option<Ahead<'a>>,
    /// What deserves a word.
    pub warnings: &'a [String],
    /// Runs of the model.
    pub runs: u64,
    /// Largest difference from finer runs, in deviations.
    pub run_error: f64,
    /// Whether that is below a tenth.
    pub accuracy_met: bool,
    /// Wall time, s.
    pub wall_seconds: f64,
    #[serde(skip)]
    judged: &'a [Judged],
    #[serde(skip)]
    outcome: &'a Outcome,
    #[serde(skip)]
    calibration: &'a Calibration,
}

#[derive(Debug, Clone, Serialize)]
struct Told {
    key: String,
    unit: &'static str,
    estimate: f64,
    lower: Option<f64>,
    upper: Option<f64>,
    identifiable: bool,
    standard_error: f64,
    bootstrap_lower: Option<f64>,
    bootstrap_upper: Option<f64>,
}

#[derive(Debug, Clone, Serialize)]
struct Ahead<'a> {
    draws: usize,
    failed: usize,
    results: Vec<Expected>,
    cycles: &'a [f64],
    curves: Vec<Curve<'a>>,
}

#[derive(Debug, Clone, Serialize)]
struct Expected {
    name: &'static str,
    unit: &'static str,
    estimate: Option<f64>,
    lower: Option<f64>,
    upper: Option<f64>,
}

#[derive(Debug, Clone, Serialize)]
struct Curve<'a> {
    name: &'static str,
    unit: &'static str,
    estimate: &'a [f64],
    lower: &'a [f64],
    upper: &'a [f64],
}

#[derive(Debug, Clone, Serialize)]
struct Product<'a> {
    keys: Vec<&'a str>,
    exponents: Vec<f64>,
    value: f64,
    relative_half_width: f64,
}

#[derive(Debug, Clone, Serialize)]
struct Ground<'a> {
    file: &'a str,
    measured: &'static str,
    count: usize,
    deviation_estimated: bool,
    deviation: f64,
    centre: Option<f64>,
    offset: Option<f64>,
    tilt: Option<f64>,
}

impl<'a> CalibrationReport<'a> {
    /// The summary of a calibration that is done.
    ///
    /// # Arguments
    /// * `models` -- the laws that were compared, if any; `calibration` and `outcome` are then of the best
    pub fn new(
        calibration: &'a Calibration,
        outcome: &'a Outcome,
        models: &'a [Judged],
        files: Vec<PathBuf>,
    ) -> Self {
        let told = |it: &Parameter| Told {
            key: it.key.clone(),
            unit: it.unit,
            estimate: it.estimate,
            lower: it.interval[0],
            upper: it.interval[1],
            identifiable: it.is_identifiable(),
            standard_error: it.standard_error,
            bootstrap_lower: it.bootstrap.map(|it| it[0]),
            bootstrap_upper: it.bootstrap.map(|it| it[1]),
        };
        let product = |it: &'a Combination| Product {
            keys: it.factors.iter().map(|(key, _)| key.as_str()).collect(),
            exponents: it.factors.iter().map(|(_, exponent)| *exponent).collect(),
            value: it.value,
            relative_half_width: it.relative,
        };
        let ground = |(set, fitted): (&'a DataSet, &'a FittedData)| Ground {
            file: &set.file,
            measured: set.measured.name(),
            count: set.values.len(),
            deviation_estimated: fitted.is_estimated,
            deviation: super::objective::median(fitted.deviations.clone()),
            centre: fitted.centre,
            offset: fitted.ground.first().copied(),
            tilt: fitted.ground.get(1).copied(),
        };
        Self {
            title: calibration.title().map(str::to_owned),
            files,
            parameters: outcome.parameters.iter().map(told).collect(),
            confidence: CONFIDENCE,
            reduced_chi_squared: outcome.reduced_chi_squared,
            degrees_of_freedom: outcome.degrees_of_freedom,
            correlation: &outcome.correlation,
            combinations: outcome.combinations.iter().map(product).collect(),
            data: calibration.data().iter().zip(&outcome.data).map(ground).collect(),
            aicc: outcome.aicc,
            models: models.iter().map(|it| Entries::new(&OF_MODEL, it)).collect(),
            residuals: rows(calibration, outcome).iter().map(|row| Entries::new(&OF_VALUE, row)).collect(),
            forecast: outcome.forecast.as_ref().map(ahead),
            warnings: &outcome.warnings,
            runs: outcome.runs,
            run_error: outcome.run_error,
            accuracy_met: outcome.accuracy_met,
            wall_seconds: outcome.wall_seconds,
            judged: models,
            outcome,
            calibration,
        }
    }

    /// A table for people.
    pub fn text(&self) -> String {
        let mut text = self.title.as_ref().map_or(String::new(), |title| format!("{title}\n\n"));
        let width = self.parameters.iter().map(|it| it.key.len()).max().unwrap_or(0).max(7);
        // Writing to a string cannot fail.
        if let [best, ..] = self.judged {
            let _ = writeln!(text, "law (AICc, likelihood among these)");
            for it in self.judged {
                let told = match &it.outcome {
                    Ok(outcome) => format!("{}, {}", number(outcome.aicc), number(it.weight)),
                    Err(why) => why.clone(),
                };
                let _ = writeln!(text, "  {}: {told}", it.name);
            }
            let tell =
                if best.weight >= TELLS { "the data prefer" } else { "the data cannot tell; the best is" };
            let _ = writeln!(text, "{tell} {}\n", best.name);
        }
        let _ = writeln!(text, "{:<width$}  {:>12}  interval of 95 %", "unknown", "estimate");
        for it in &self.parameters {
            let end = |end: Option<f64>| end.map_or_else(|| "not told".to_owned(), number);
            let unit = if it.unit == "1" { String::new() } else { format!(" {}", unit_in_words(it.unit)) };
            let mut interval = format!("{} to {}{unit}", end(it.lower), end(it.upper));
            if let (Some(low), Some(high)) = (it.bootstrap_lower, it.bootstrap_upper) {
                let _ = write!(interval, "; data made anew: {} to {}{unit}", number(low), number(high));
            }
            let _ = writeln!(text, "{:<width$}  {:>12}  {interval}", it.key, number(it.estimate));
        }
        if let Some(forecast) = &self.forecast {
            let _ =
                writeln!(text, "\n{:<width$}  {:>12}  where 95 % of the draws lie", "foretold", "estimate");
            for it in forecast.results.iter().filter(|it| it.lower.is_some()) {
                let [low, high] = [it.lower, it.upper].map(|it| it.map_or_else(String::new, number));
                let unit =
                    if it.unit == "1" { String::new() } else { format!(" {}", unit_in_words(it.unit)) };
                let estimate = it.estimate.map_or_else(String::new, number);
                let _ = writeln!(text, "{:<width$}  {estimate:>12}  {low} to {high}{unit}", it.name);
            }
        }
        text.push('\n');
        for (set, fitted) in self.calibration.data().iter().zip(&self.outcome.data) {
            let estimated = if fitted.is_estimated { ", deviations estimated" } else { "" };
            let worst = fitted.residuals.iter().map(|it| it.abs()).fold(0.0, f64::max);
            let _ = writeln!(
                text,
                "{}: {}, {} values{estimated}, largest residual {} deviations",
                set.file,
                set.measured.name(),
                set.values.len(),
                number(worst)
            );
        }
        text.push('\n');
        let mut rows = TextTable::default();
        rows.row("reduced chi-squared", number(self.reduced_chi_squared));
        rows.row("degrees of freedom", self.degrees_of_freedom);
        rows.row("runs of the model", self.runs);
        rows.row("wall time", Scale::TIME.show(self.wall_seconds));
        for file in &self.files {
            rows.row("written", file.display());
        }
        text + &rows.text()
    }
}

fn ahead(forecast: &Forecast) -> Ahead<'_> {
    let expected = |it: &Band| Expected {
        name: it.name,
        unit: it.unit,
        estimate: Some(it.estimate).filter(|it| it.is_finite()),
        lower: it.interval.map(|it| it[0]),
        upper: it.interval.map(|it| it[1]),
    };
    Ahead {
        draws: forecast.draws[0],
        failed: forecast.draws[1],
        results: forecast.bands.iter().map(expected).collect(),
        cycles: &forecast.cycles,
        curves: CURVES
            .iter()
            .zip(&forecast.curves)
            .map(|((quantity, _), [estimate, lower, upper])| Curve {
                name: quantity.name,
                unit: quantity.units,
                estimate,
                lower,
                upper,
            })
            .collect(),
    }
}

impl Combination {
    /// `wear.archard.coefficient * loading.amplitude^1.5 = 3.1e-20 within 4 %`.
    pub(super) fn words(&self) -> String {
        let factor = |(key, exponent): &(String, f64)| match *exponent {
            1.0 => key.clone(),
            exponent => format!("{key}^{exponent:.2}"),
        };
        let product: Vec<String> = self.factors.iter().map(factor).collect();
        format!("{} = {} (SI) within {:.2} %", product.join(" * "), number(self.value), 100.0 * self.relative)
    }
}
