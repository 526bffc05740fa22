//! The inverse problem: from measurements to coefficients with their uncertainty.
//!
//! Least squares of the residuals over their deviations, from several starts; each unknown with the interval in which the misfit, all else fitted
//! anew, rises by less than the square of Student's quantile (profile likelihood, 95 %). An unknown whose misfit never rises so far within its
//! bounds is not told by the data, and the product of such unknowns that is told is named.
//!
//! Where deviations are not given they are estimated from the residuals; the unworn ground of a scar tells its own. Runs of the model are as
//! accurate as a tenth of the deviations asks, and compared with finer ones at the end.

mod bootstrap;
mod files;
mod fit;
mod forecast;
mod journal;
mod models;
mod objective;
mod posterior;
mod prediction;
mod report;
mod trajectory;
mod uncertainty;

pub use forecast::{Band, Forecast, Foretold};
pub use models::Judged;
pub use report::CalibrationReport;
pub use uncertainty::CONFIDENCE;

use std::path::{Path, PathBuf};
use std::time::Instant;

use fit::Fit;
use journal::{Journal, Runs};

use crate::error::{Domain, Error, Result};
use crate::run::Stop;
use crate::scene::Calibration;
use crate::study::batch::Progress;

/// Whoever looks on while unknowns are looked for; and while a scene is foretold, run by run.
pub trait Onlooker: Progress {
    /// The model was run so often, and the last misfit was this for each value.
    fn misfit(&self, runs: u64, reduced: f64);
}

/// How a calibration is done.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Whether files that exist may be replaced.
    pub overwrite: bool,
    /// A scene that is foretold with what was found.
    pub foretold: Option<Foretold>,
}

/// A key that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Dotted key of the scene.
    pub key: String,
    /// Unit in SI.
    pub unit: &'static str,
    /// Value at which the misfit is least, in SI.
    pub estimate: f64,
    /// Ends of the interval of 95 %, none where the misfit never rises so far within the bounds.
    pub interval: [Option<f64>; 2],
    /// Ends of the interval of 95 % by data made anew from the residuals; none where it was not asked for.
    pub bootstrap: Option<[f64; 2]>,
    /// Standard deviation by the curvature of the misfit, in SI.
    pub standard_error: f64,
    /// Values and misfits above the least, all else fitted anew, by increasing values.
    pub profile: Vec<[f64; 2]>,
}

impl Parameter {
    /// Whether the data tell both ends.
    pub fn is_identifiable(&self) -> bool {
        self.interval.iter().all(Option::is_some)
    }
}

/// A data set beside what is predicted of it, in SI.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedData {
    /// What is predicted, with offset and tilt, shape `(value,)`.
    pub predicted: Vec<f64>,
    /// Standard deviations, shape `(value,)`.
    pub deviations: Vec<f64>,
    /// Differences over deviations, shape `(value,)`.
    pub residuals: Vec<f64>,
    /// Whether the deviations were estimated.
    pub is_estimated: bool,
    /// Centre of a scar or loop, m.
    pub centre: Option<f64>,
    /// Offset of a scar or loop, in the unit of its values, and tilt of a scar.
    pub ground: Vec<f64>,
}

/// A product of unknowns that is known where they are not.
#[derive(Debug, Clone, PartialEq)]
pub struct Combination {
    /// Keys and their exponents.
    pub factors: Vec<(String, f64)>,
    /// Its value in SI.
    pub value: f64,
    /// Half of the width of its interval of 95 %, relative.
    pub relative: f64,
}

/// What a calibration came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The keys found, in the order of the calibration.
    pub parameters: Vec<Parameter>,
    /// Correlations of their estimates, shape `(parameter, parameter)`.
    pub correlation: Vec<Vec<f64>>,
    /// What the keys may be, by the data, in SI, shape `(draw, parameter)`.
    pub draws: Vec<Vec<f64>>,
    /// What was foretold of another scene, where that was asked for.
    pub forecast: Option<Forecast>,
    /// Products that are known where single unknowns are not.
    pub combinations: Vec<Combination>,
    /// Misfit over degrees of freedom.
    pub reduced_chi_squared: f64,
    /// Values less what was fitted to them.
    pub degrees_of_freedom: f64,
    /// Akaike's criterion with its correction for few values, to compare laws on the same data.
    pub aicc: f64,
    /// The data, in the order of the calibration.
    pub data: Vec<FittedData>,
    /// What deserves a word, one sentence each.
    pub warnings: Vec<String>,
    /// Runs of the model.
    pub runs: u64,
    /// Largest difference from finer runs: of predictions, in deviations, and of estimates, in standard errors.
    pub run_error: f64,
    /// Whether that is below a tenth, and runs of a scene that is foretold are as accurate as it asks for.
    pub accuracy_met: bool,
    /// Wall time, s.
    pub wall_seconds: f64,
}

/// Finds the unknowns of a calibration, in memory; none if it was stopped first.
///
/// # Errors
/// [`Error::Scene`] if a scene between the bounds is not valid, [`Error::Inconsistent`] if there
/// are fewer values than unknowns, [`Error::NotConverged`] if the model predicts the data nowhere.
///
/// # Examples
/// The regression through the origin of van Peteghem, Fouvry, Petit, Wear 271 (2011) 1535: 97,429 ± 5,311 µm³/J.
/// ```
/// # use std::path::Path;
/// use fretwear::{Stop, scene::Calibration, study::calibration::calibrate};
///
/// let calibration = Calibration::read(Path::new("data/calibration/ti6al4v_5hz.toml"))?;
/// let found = &calibrate(&calibration, &Stop::default())?.unwrap().parameters[0];
/// assert!((found.estimate / 97.429e-15 - 1.0).abs() < 1e-4 && (found.standard_error / 5.311e-15 - 1.0).abs() < 1e-3);
/// # Ok::<(), fretwear::Error>(())
/// ```
pub fn calibrate(calibration: &Calibration, stop: &Stop) -> Result<Option<Outcome>> {
    Ready::new(calibration, stop)?.run(None, None)
}

/// A calibration whose scenes are valid and whose data are enough.
struct Ready<'a> {
    calibration: &'a Calibration,
    stop: Stop,
    started: Instant,
}

impl<'a> Ready<'a> {
    /// # Errors
    /// As [`calibrate`], before any run of the model.
    fn new(calibration: &'a Calibration, stop: &Stop) -> Result<Self> {
        let started = Instant::now();
        Fit::new(calibration, Runs::new(stop, None), None)?;
        Ok(Self { calibration, stop: stop.clone(), started })
    }

    /// Finds the unknowns; none if it was stopped first.
    ///
    /// # Errors
    /// As [`calibrate`].
    fn run(self, journal: Option<&Journal>, onlooker: Option<&dyn Onlooker>) -> Result<Option<Outcome>> {
        let outcome = Fit::new(self.calibration, Runs::new(&self.stop, journal), onlooker)?.outcome()?;
        Ok(outcome.map(|it| Outcome { wall_seconds: self.started.elapsed().as_secs_f64(), ..it }))
    }
}

/// A calibration under each of its laws, with a folder for what is found.
pub struct Comparison<'a> {
    laws: &'a [(String, Calibration)],
    ready: Vec<Ready<'a>>,
    folder: &'a Path,
    options: Options,
    stop: Stop,
}

impl<'a> Comparison<'a> {
    /// Makes sure that all can be run and written; runs and writes nothing.
    ///
    /// # Arguments
    /// * `laws` -- [`Calibration::models`]
    /// * `folder` -- where files are written
    ///
    /// # Errors
    /// As [`calibrate`], before any run; [`Error::Scene`] if the scene that is foretold is not valid; [`Error::File`] if a file exists that may not be replaced, or the directory cannot be written.
    pub fn new(
        laws: &'a [(String, Calibration)],
        folder: &'a Path,
        options: &Options,
        stop: &Stop,
    ) -> Result<Self> {
        let ready = laws.iter().map(|(_, it)| Ready::new(it, stop)).collect::<Result<Vec<_>>>()?;
        if let Some(foretold) = &options.foretold {
            laws.iter().try_for_each(|(_, it)| foretold.check(it))?;
        }
        files::check_folder(folder, options.overwrite)?;
        Ok(Self { laws, ready, folder, options: options.clone(), stop: stop.clone() })
    }

    /// Finds the unknowns under each law, and writes `calibration.h5`, `parameters.csv` and `residuals.csv` of the one that the data prefer, and
    /// `models.csv` where several are compared; none if it was stopped first, and the same call then goes on from the runs that it has left in the folder.
    ///
    /// # Errors
    /// As [`calibrate`], of several laws only if all fail; [`Error::File`] if files cannot be written.
    pub fn run(self, onlooker: Option<&dyn Onlooker>) -> Result<Option<Found<'a>>> {
        let several = self.laws.len() > 1;
        let journal = Journal::take_up(self.folder)?;
        let mut found = vec![];
        for ((name, _), ready) in self.laws.iter().zip(self.ready) {
            match ready.run(Some(&journal), onlooker) {
                Ok(Some(outcome)) => found.push((name.clone(), Ok(outcome))),
                Ok(None) => {
                    journal.keep();
                    return Ok(None);
                }
                Err(error) if several && error.domain() != Domain::File => {
                    found.push((name.clone(), Err(error.to_string())))
                }
                Err(error) => return Err(error),
            }
        }
        let mut judged = models::judged(found);
        let best = &mut judged[0];
        if let Err(why) = &best.outcome {
            return Err(Error::NotConverged { what: "every law", why: why.clone() });
        }
        let (_, calibration) =
            self.laws.iter().find(|(name, _)| *name == best.name).expect("every law has its name");
        if let (Some(foretold), Ok(outcome)) = (&self.options.foretold, &mut best.outcome) {
            let bands = foretold.bands(calibration, outcome, &journal, onlooker, &self.stop)?;
            let Some(forecast) = bands else {
                journal.keep();
                return Ok(None);
            };
            outcome.warnings.extend(forecast.warnings(outcome));
            outcome.accuracy_met &= forecast.accuracy_met;
            outcome.forecast = Some(forecast);
        }
        let mut found = Found { calibration, judged, files: vec![] };
        let overwrite = self.options.overwrite;
        found.files = files::write(calibration, found.outcome(), found.compared(), self.folder, overwrite)?;
        Ok(Some(found))
    }
}

/// What was found under the law that the data prefer, and what they say of the others.
pub struct Found<'a> {
    calibration: &'a Calibration,
    /// The best first.
    judged: Vec<Judged>,
    files: Vec<PathBuf>,
}

impl Found<'_> {
    /// That of the law that the data prefer.
    pub fn outcome(&self) -> &Outcome {
        self.judged[0].outcome.as_ref().expect("there is an outcome of the best")
    }

    fn compared(&self) -> &[Judged] {
        if self.judged.len() > 1 { &self.judged } else { &[] }
    }

    /// Its summary.
    pub fn report(&self) -> CalibrationReport<'_> {
        CalibrationReport::new(self.calibration, self.outcome(), self.compared(), self.files.clone())
    }
}
