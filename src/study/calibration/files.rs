//! The files of `fretwear calibrate`: an HDF5 file with everything, and two tables.

use std::path::{Path, PathBuf};

use super::forecast::{CURVES, Forecast, OF_BAND};
use super::models::OF_MODEL;
use super::{FittedData, Judged, Outcome, Parameter};
use crate::data::quantity::{Quantity, Reading, csv, number, quantity, word};
use crate::data::{self, AtomicFile, Dataset, Format, Mark, Variable};
use crate::error::Result;
use crate::scene::{Calibration, DataSet};

const ARRAYS: &str = "calibration.h5";
const PARAMETERS: &str = "parameters.csv";
const RESIDUALS: &str = "residuals.csv";
const MODELS: &str = "models.csv";
const FORECAST: &str = "forecast.csv";

const PARAMETER: Quantity = quantity("parameter", "1", "number of the unknown in the calibration");
const VALUE: Quantity = quantity("value", "1", "number of the measured value, through all data sets");
const DRAW: Quantity = quantity("draw", "1", "number of the draw of the unknowns");
const RESULT: Quantity = quantity("forecast_result", "1", "number of the result that is foretold");
const TIME: Quantity =
    quantity("forecast_snapshot", "1", "number of the snapshot of the scene that is foretold");
const END: Quantity =
    quantity("forecast_end", "1", "0 at the estimates, 1 the lower and 2 the upper end of the interval");
const POINT: Quantity = quantity("point", "1", "number of the place along a profile of the misfit");

/// All that is told of an unknown, in the order of columns.
pub(super) const OF_PARAMETER: [Reading<Parameter>; 9] = [
    word("key", "key of the scene", |it| it.key.as_str().into()),
    word("unit", "unit of its values", |it| it.unit.into()),
    number("estimate", "1", "value at which the misfit is least, in the unit of the key", |it| {
        it.estimate.into()
    }),
    number("lower", "1", "lower end of the interval of 95 %; missing where the data tell none", |it| {
        it.interval[0].into()
    }),
    number("upper", "1", "upper end of the interval of 95 %; missing where the data tell none", |it| {
        it.interval[1].into()
    }),
    number("identifiable", "1", "1 where the data tell both ends, 0 else", |it| it.is_identifiable().into()),
    number("standard_error", "1", "standard deviation by the curvature of the misfit", |it| {
        it.standard_error.into()
    }),
    number(
        "bootstrap_lower",
        "1",
        "lower end by data made anew; missing where that was not asked for",
        |it| it.bootstrap.map(|it| it[0]).into(),
    ),
    number(
        "bootstrap_upper",
        "1",
        "upper end by data made anew; missing where that was not asked for",
        |it| it.bootstrap.map(|it| it[1]).into(),
    ),
];

/// A measured value beside what is predicted of it.
pub(super) struct Row {
    data: usize,
    file: String,
    line: usize,
    measured: &'static str,
    at: f64,
    measurement: f64,
    prediction: f64,
    deviation: f64,
    residual: f64,
}

/// All that is told of a measured value.
pub(super) const OF_VALUE: [Reading<Row>; 9] = [
    number("data", "1", "number of the data set in the calibration", |it| it.data.into()),
    word("file", "file of the data set", |it| it.file.as_str().into()),
    number("line", "1", "line of the file", |it| it.line.into()),
    word("measured", "what was measured", |it| it.measured.into()),
    number("at", "1", "number of cycles, energy (J), position or displacement (m) of the value", |it| {
        it.at.into()
    }),
    number("measurement", "1", "measured value, in SI", |it| it.measurement.into()),
    number("prediction", "1", "predicted value, in SI", |it| it.prediction.into()),
    number("deviation", "1", "standard deviation of the value, in SI", |it| it.deviation.into()),
    number("residual", "1", "measurement less prediction, over the deviation", |it| it.residual.into()),
];

/// All measured values, in the order of the calibration.
pub(super) fn rows(calibration: &Calibration, outcome: &Outcome) -> Vec<Row> {
    let sets = calibration.data().iter().zip(&outcome.data).enumerate();
    let of_set = |(data, (set, fitted)): (usize, (&DataSet, &FittedData))| {
        let row = |place: usize| Row {
            data,
            file: set.file.clone(),
            line: set.lines[place],
            measured: set.measured.name(),
            at: set.at[place],
            measurement: set.values[place],
            prediction: fitted.predicted[place],
            deviation: fitted.deviations[place],
            residual: fitted.residuals[place],
        };
        (0..set.values.len()).map(row).collect::<Vec<_>>()
    };
    sets.flat_map(of_set).collect()
}

/// Makes the directory if it is missing, and checks that the files can be written there; creates no file.
pub(super) fn check_folder(folder: &Path, overwrite: bool) -> Result<()> {
    let marks = [
        (ARRAYS, Mark::Results),
        (PARAMETERS, Mark::Words("key,unit,estimate,lower,upper,")),
        (RESIDUALS, Mark::Words("data,file,line,measured,at,")),
        (MODELS, Mark::Words("name,aicc,weight,")),
        (FORECAST, Mark::Words("forecast_name,forecast_unit,")),
    ];
    data::check_folder(folder, &marks, overwrite)
}

/// Writes the files, each as a whole or not at all; returns their paths.
pub(super) fn write(
    calibration: &Calibration,
    outcome: &Outcome,
    models: &[Judged],
    folder: &Path,
    overwrite: bool,
) -> Result<Vec<PathBuf>> {
    // Once more, for what has come in the meantime.
    check_folder(folder, overwrite)?;
    let [arrays, parameters, residuals] = [ARRAYS, PARAMETERS, RESIDUALS].map(|name| folder.join(name));
    let rows = rows(calibration, outcome);
    dataset(calibration, outcome, &rows).write(&arrays, overwrite)?;
    AtomicFile::new(&parameters, overwrite)?.write(csv(&OF_PARAMETER, &outcome.parameters).as_bytes())?;
    AtomicFile::new(&residuals, overwrite)?.write(csv(&OF_VALUE, &rows).as_bytes())?;
    let mut files = vec![arrays, parameters, residuals];
    if !models.is_empty() {
        let path = folder.join(MODELS);
        AtomicFile::new(&path, overwrite)?.write(csv(&OF_MODEL, models).as_bytes())?;
        files.push(path);
    }
    if let Some(forecast) = &outcome.forecast {
        let path = folder.join(FORECAST);
        AtomicFile::new(&path, overwrite)?.write(csv(&OF_BAND, &forecast.bands).as_bytes())?;
        files.push(path);
    }
    Ok(files)
}

fn dataset(calibration: &Calibration, outcome: &Outcome, rows: &[Row]) -> Dataset {
    let index = |count: usize| (0..count).map(|number| number as f64).collect::<Vec<_>>();
    let (parameters, count) = (&outcome.parameters, outcome.parameters.len());
    let points = parameters.iter().map(|it| it.profile.len()).max().unwrap_or(0);
    let mut dataset = Dataset::of(
        Format::Calibration,
        &[
            ("title", calibration.title().unwrap_or_default().into()),
            ("calibration", calibration.text().into()),
            ("scene", calibration.base_text().into()),
            ("reduced_chi_squared", outcome.reduced_chi_squared.to_string()),
            ("degrees_of_freedom", outcome.degrees_of_freedom.to_string()),
            ("warnings", outcome.warnings.join("\n")),
            ("forecast_scene", outcome.forecast.as_ref().map_or(String::new(), |it| it.scene.clone())),
        ],
    );
    dataset.coordinate(PARAMETER, index(count));
    dataset.coordinate(VALUE, index(rows.len()));
    dataset.coordinate(POINT, index(points));
    let of_parameters = OF_PARAMETER.iter().map(|it| it.variable(PARAMETER.name, parameters));
    let of_values = OF_VALUE.iter().map(|it| it.variable(VALUE.name, rows));
    let draws = &outcome.draws;
    dataset.coordinate(DRAW, index(draws.len()));
    if let Some(forecast) = &outcome.forecast {
        dataset.coordinate(RESULT, index(forecast.bands.len()));
    }
    let bands = outcome.forecast.as_ref().map_or(&[][..], |it| &it.bands);
    let of_bands = OF_BAND.iter().filter(|_| !bands.is_empty()).map(|it| it.variable(RESULT.name, bands));
    let (numbers, words): (Vec<_>, Vec<_>) =
        of_parameters.chain(of_values).chain(of_bands).partition(Variable::is_numeric);
    dataset.variables.extend(numbers);
    let other = [(PARAMETER.name, count), ("other_parameter", count)];
    dataset.coordinate(quantity("other_parameter", "1", "as parameter"), index(count));
    let correlation: Vec<f64> = outcome.correlation.iter().flatten().copied().collect();
    dataset.add(Variable::new(
        quantity("correlation", "1", "correlation of two estimates"),
        &other,
        correlation,
    ));
    let plane = [(PARAMETER.name, count), (POINT.name, points)];
    let mut profile = |name, long_name, which: usize| {
        let of = |it: &Parameter| {
            let own = it.profile.iter().map(|point| point[which]).collect::<Vec<_>>();
            own.into_iter().chain(std::iter::repeat(f64::NAN)).take(points).collect::<Vec<_>>()
        };
        dataset.add(Variable::new(
            quantity(name, "1", long_name),
            &plane,
            parameters.iter().flat_map(of).collect::<Vec<_>>(),
        ));
    };
    profile("profile_value", "value of the unknown along the profile of the misfit", 0);
    profile("profile_misfit", "misfit above the least, all else fitted anew", 1);
    dataset.add(Variable::new(
        quantity("draw_value", "1", "what the unknown may be by the data, in its unit"),
        &[(DRAW.name, draws.len()), (PARAMETER.name, count)],
        draws.concat(),
    ));
    if let Some(forecast) = &outcome.forecast {
        foretell(&mut dataset, forecast);
    }
    dataset.variables.extend(words);
    dataset
}

/// The curves of a scene that is foretold, where its snapshots are at the same cycles for all draws.
fn foretell(dataset: &mut Dataset, forecast: &Forecast) {
    let count = forecast.cycles.len();
    if count == 0 {
        return;
    }
    dataset.coordinate(TIME, (0..count).map(|number| number as f64).collect::<Vec<_>>());
    dataset.coordinate(END, vec![0.0, 1.0, 2.0]);
    let cycles = quantity("forecast_cycles", "1", "number of cycles");
    dataset.add(Variable::new(cycles, &[(TIME.name, count)], forecast.cycles.clone()));
    for ((quantity, _), ends) in CURVES.iter().zip(&forecast.curves) {
        dataset.add(Variable::new(*quantity, &[(END.name, 3), (TIME.name, count)], ends.concat()));
    }
}
