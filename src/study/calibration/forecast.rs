//! What a scene does, and between what bounds, with all that the data leave open.

use std::path::{Path, PathBuf};

use super::journal::{Journal, Runs};
use super::posterior::interval;
use super::{Onlooker, Outcome};
use crate::data::quantity::{Quantity, Reading, number, quantity, word};
use crate::error::{Error, Result};
use crate::numerics::linear::largest;
use crate::run::{Results, Shared, Stop, readings};
use crate::scene::{Calibration, Scene, read_text};
use crate::study::batch::{Batch, Progress};

/// Results that tell of the computing and not of the scene.
const OF_COMPUTING: [&str; 6] =
    ["error_estimate", "accuracy_met", "steps", "rejected_steps", "rate_evaluations", "wall_seconds"];

/// Numbers of a run, one for each snapshot.
type OverTime = fn(&Results) -> Vec<f64>;

/// Curves of a scene over cycles.
pub(super) const CURVES: [(Quantity, OverTime); 3] = [
    (quantity("forecast_wear_volume", "m3", "worn volume that is foretold"), |it| it.worn_volume()),
    (quantity("forecast_wear_depth", "m", "largest wear depth that is foretold"), |it| {
        it.wear_depth().into_iter().map(largest).collect()
    }),
    (quantity("forecast_contact_radius", "m", "contact radius that is foretold"), |it| it.contact_radius()),
];

/// A scene that is foretold.
#[derive(Debug, Clone)]
pub struct Foretold {
    /// The TOML text.
    pub text: String,
    /// What messages call it.
    pub name: PathBuf,
    /// Draws of the unknowns with which it is run.
    pub draws: usize,
}

/// A result, at the estimates and the ends of the interval that holds 95 % of the draws.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Name of the result, as in the JSON of a run.
    pub name: &'static str,
    /// Unit in SI.
    pub unit: &'static str,
    /// Its value at the estimates; not a number where it has no meaning.
    pub estimate: f64,
    /// Where 95 % of the draws lie; none where a draw has no value.
    pub interval: Option<[f64; 2]>,
}

/// What was foretold of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Forecast {
    /// The TOML text of the scene.
    pub scene: String,
    /// Draws that were run, and that failed.
    pub draws: [usize; 2],
    /// All results at its end.
    pub bands: Vec<Band>,
    /// Numbers of cycles of its snapshots; empty where they differ between draws.
    pub cycles: Vec<f64>,
    /// Worn volume, wear depth and contact radius at the estimates and at both ends, shape `(curve, 3, cycle)`.
    pub curves: Vec<[Vec<f64>; 3]>,
    /// Whether each run was as accurate as its scene asks for.
    pub accuracy_met: bool,
}

/// All that is told of a result, in the order of columns.
pub(super) const OF_BAND: [Reading<Band>; 5] = [
    word("forecast_name", "result that is foretold", |it| it.name.into()),
    word("forecast_unit", "unit of its values", |it| it.unit.into()),
    number("forecast_estimate", "1", "value at the estimates of the unknowns", |it| it.estimate.into()),
    number("forecast_lower", "1", "lower end of the interval that holds 95 % of the draws", |it| {
        it.interval.map(|it| it[0]).into()
    }),
    number("forecast_upper", "1", "upper end of the interval that holds 95 % of the draws", |it| {
        it.interval.map(|it| it[1]).into()
    }),
];

/// One run as numbers.
struct Told {
    results: Vec<f64>,
    cycles: Vec<f64>,
    curves: Vec<Vec<f64>>,
    accuracy_met: bool,
}

impl Told {
    fn new(results: &Results) -> Self {
        Self {
            results: foretold().map(|it| (it.of)(results).number()).collect(),
            cycles: results.cycles(),
            curves: CURVES.iter().map(|(_, of)| of(results)).collect(),
            accuracy_met: results.accuracy_met() != Some(false),
        }
    }
}

fn foretold() -> impl Iterator<Item = &'static Reading<Results>> {
    readings::RUN.iter().filter(|it| !it.is_word && !OF_COMPUTING.contains(&it.quantity.name))
}

impl Foretold {
    /// Reads a scene that is foretold.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be read.
    pub fn read(path: &Path, draws: usize) -> Result<Self> {
        Ok(Self { text: read_text(path)?, name: path.to_owned(), draws })
    }

    /// Refuses a scene that is not valid with the unknowns.
    ///
    /// # Errors
    /// As [`Calibration::scene_with`].
    pub(super) fn check(&self, calibration: &Calibration) -> Result<()> {
        let middle = |it: &crate::scene::Unknown| {
            let [low, high] = it.bounds;
            if it.is_logarithmic { (low * high).sqrt() } else { (low + high) / 2.0 }
        };
        self.scene(calibration, &calibration.unknowns().iter().map(middle).collect::<Vec<_>>()).map(drop)
    }

    fn scene(&self, calibration: &Calibration, values: &[f64]) -> Result<Scene> {
        let folder = self.name.parent().unwrap_or(Path::new(""));
        calibration.scene_with(&self.text, &self.name, folder, values)
    }

    /// Runs the scene at the estimates and at draws of the unknowns; none if it was stopped.
    ///
    /// # Errors
    /// [`Error::NotConverged`] if the run at the estimates fails; [`Error::File`] if what is kept cannot be written.
    pub(super) fn bands(
        &self,
        calibration: &Calibration,
        outcome: &Outcome,
        journal: &Journal,
        onlooker: Option<&dyn Onlooker>,
        stop: &Stop,
    ) -> Result<Option<Forecast>> {
        let estimates: Vec<f64> = outcome.parameters.iter().map(|it| it.estimate).collect();
        let draws = outcome.draws.iter().take(self.draws).cloned();
        let places: Vec<Vec<f64>> = std::iter::once(estimates).chain(draws).collect();
        let runs = Runs::new(stop, Some(journal));
        let batch = Batch::new(None, Shared::without_checkpoints(stop))?;
        let run = |values: &Vec<f64>| -> Result<Option<Told>> {
            let results = runs.run(&self.scene(calibration, values)?)?;
            Ok(results.is_complete().then(|| Told::new(&results)))
        };
        let progress = onlooker.map(|it| it as &dyn Progress);
        let Some(mut ends) = batch.each(&places, progress, run, |_, end| Ok(end))? else { return Ok(None) };
        let drawn = ends.split_off(1);
        let base = match ends.remove(0) {
            Ok(base) => base,
            Err(why) => return Err(Error::NotConverged { what: "the scene that is foretold", why }),
        };
        let count = drawn.len();
        let drawn: Vec<Told> = drawn.into_iter().flatten().collect();
        let bands = foretold().enumerate().map(|(i, it)| Band {
            name: it.quantity.name,
            unit: it.quantity.units,
            estimate: base.results[i],
            interval: interval(drawn.iter().map(|it| it.results[i]).collect()),
        });
        let is_alike = drawn.iter().all(|it| it.cycles == base.cycles);
        let curve = |which: usize| {
            let at = |time: usize| interval(drawn.iter().map(|it| it.curves[which][time]).collect());
            let ends: Vec<[f64; 2]> =
                (0..base.cycles.len()).map(|time| at(time).unwrap_or([f64::NAN; 2])).collect();
            let end = |side: usize| ends.iter().map(|it| it[side]).collect();
            [base.curves[which].clone(), end(0), end(1)]
        };
        Ok(Some(Forecast {
            scene: self.text.clone(),
            draws: [count, count - drawn.len()],
            bands: bands.collect(),
            curves: if is_alike { (0..CURVES.len()).map(curve).collect() } else { vec![] },
            cycles: if is_alike { base.cycles.clone() } else { vec![] },
            accuracy_met: base.accuracy_met && drawn.iter().all(|it| it.accuracy_met),
        }))
    }
}

impl Forecast {
    /// What deserves a word of it.
    pub(super) fn warnings(&self, outcome: &Outcome) -> Vec<String> {
        let mut warnings = vec![];
        let open: Vec<&str> =
            outcome.parameters.iter().filter(|it| !it.is_identifiable()).map(|it| it.key.as_str()).collect();
        if !open.is_empty() {
            warnings.push(format!(
                "what is foretold rests on the bounds given for {}, which the data do not tell",
                open.join(" and ")
            ));
        }
        if self.draws[1] > 0 {
            warnings.push(format!(
                "{} of {} runs with draws of the unknowns failed; what is foretold is of the others",
                self.draws[1], self.draws[0]
            ));
        }
        if !self.accuracy_met {
            warnings
                .push("some runs of the scene that is foretold are less accurate than it asks for".into());
        }
        warnings
    }
}
