//! The inside of the Python package: scenes, runs and result files of the library in the types of Python. It holds no physics.

mod errors;
mod figure;
mod results;
mod scene;
mod values;
mod wait;

use std::path::PathBuf;
use std::sync::{LazyLock, Mutex};

use fretwear::data::{Format, format_of};
use fretwear::report::{self, CheckReport, LimitReport};
use fretwear::run::Shared;
use fretwear::solver::model::OperatorStore;
use fretwear::study::{
    calibration::{self, Comparison},
    on_threads, run_many_sharing,
    sweep::SweepReport,
};
use fretwear::{Progress, Result as Outcome, Stop, SweepOptions, Watch};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

use errors::{of_input, raised};
use results::Results;
use scene::Scene;
use wait::{Call, to_the_end, waited};

/// How far each of many scenes is.
struct Parts(Mutex<Vec<f64>>);

impl Parts {
    fn sum(&self) -> f64 {
        self.0.lock().map_or(0.0, |parts| parts.iter().sum())
    }
}

impl Watch for Parts {
    fn done(&self, scene: usize, part: f64) {
        if let Ok(mut parts) = self.0.lock() {
            parts[scene] = part;
        }
    }
}

/// Rows of a sweep: how many there are to be, and how many there are.
struct Rows(Mutex<(u64, u64)>);

impl Progress for Rows {
    fn begin(&self, scenes: u64) {
        if let Ok(mut rows) = self.0.lock() {
            rows.0 = scenes;
        }
    }

    fn done(&self, _: bool) {
        if let Ok(mut rows) = self.0.lock() {
            rows.1 += 1;
        }
    }
}

/// The transforms used last, which calls one after the other share.
static OPERATORS: LazyLock<OperatorStore> = LazyLock::new(OperatorStore::default);

/// Runs scenes in memory: results or exceptions in their order, fewer of them where the user stopped it, and whether that was so.
#[pyfunction]
fn run<'py>(
    py: Python<'py>,
    scenes: Vec<Bound<'py, Scene>>,
    threads: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Vec<Bound<'py, PyAny>>, bool)> {
    let inner: Vec<fretwear::Scene> = scenes.iter().map(|scene| scene.get().scene.clone()).collect();
    let (stop, parts) = (Stop::default(), Parts(Mutex::new(vec![0.0; inner.len()])));
    let call = Call { callback: progress, value: &|| (parts.sum(), inner.len() as f64) };
    let shared = Shared { stop: stop.clone(), operators: OPERATORS.clone(), ..Shared::default() };
    let (ended, stopped) = waited(py, &stop, &call, || run_many_sharing(&inner, threads, &shared, &parts))?;
    let ended = ended.map_err(|error| raised(py, &error))?;
    let named = |(end, scene): (Outcome<fretwear::Results>, &Bound<'py, Scene>)| match end {
        Ok(results) => Ok(Bound::new(py, Results::of_run(results, None))?.into_any()),
        Err(error) => Ok(raised(py, &scene.get().located(error)).into_value(py).into_bound(py).into_any()),
    };
    Ok((ended.into_iter().zip(&scenes).map(named).collect::<PyResult<_>>()?, stopped))
}

/// The JSON of `fretwear limit`.
#[pyfunction]
fn limit(py: Python, scene: &Scene, at: Option<Vec<f64>>) -> PyResult<String> {
    let work = || on_threads(|| LimitReport::new(&scene.scene, at.as_deref()).map(|it| report::json(&it)));
    py.detach(work).and_then(|it| it).map_err(|error| raised(py, &scene.located(error)))
}

/// The JSON of `fretwear check`.
#[pyfunction]
fn check(py: Python, scene: &Scene) -> PyResult<String> {
    let work = || on_threads(|| CheckReport::new(&scene.scene).map(|it| report::json(&it)));
    py.detach(work).and_then(|it| it).map_err(|error| raised(py, &scene.located(error)))
}

/// Does what is missing of a sweep; the JSON of `fretwear sweep`, whose output is null where the user stopped it.
#[pyfunction]
fn sweep(
    py: Python,
    study: &Bound<PyAny>,
    folder: PathBuf,
    threads: Option<usize>,
    checkpoint_interval: f64,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    let study = scene::study(study)?;
    let options = SweepOptions { threads, checkpoint_interval, ..SweepOptions::default() };
    let (stop, rows) = (Stop::default(), Rows(Mutex::new((0, 0))));
    let seen = || rows.0.lock().map_or((0.0, 0.0), |it| (it.1 as f64, it.0 as f64));
    let call = Call { callback: progress, value: &seen };
    let work = || fretwear::Sweep::new(&study, &folder, &options, &stop)?.execute(Some(&rows));
    let outcome = to_the_end(waited(py, &stop, &call, work)?)?.map_err(|error| of_input(py, &error))?;
    Ok(report::json(&SweepReport::new(&options, &outcome)))
}

/// Finds keys of a scene from measurements, and writes what `fretwear calibrate` writes; its JSON.
#[pyfunction]
fn calibrate(
    py: Python,
    calibrated: &Bound<PyAny>,
    folder: PathBuf,
    overwrite: bool,
    predict: Option<&Bound<PyAny>>,
    draws: usize,
) -> PyResult<String> {
    let foretold = predict.map(|it| scene::foretold(it, draws)).transpose()?;
    let options = calibration::Options { overwrite, foretold };
    let laws = scene::calibration(calibrated)?.models();
    let stop = Stop::default();
    let call = Call { callback: None, value: &|| (0.0, 0.0) };
    let work = || {
        let found = Comparison::new(&laws, &folder, &options, &stop)?.run(None)?;
        Ok(found.map(|it| report::json(&it.report())))
    };
    let found = to_the_end(waited(py, &stop, &call, || on_threads(work).and_then(|it| it))?)?;
    found.map_err(|error| raised(py, &error))?.ok_or_else(|| PyKeyboardInterrupt::new_err(()))
}

/// Opens a result file of any kind.
///
/// # Arguments
/// * `stays` -- whether it is there for others, so that results may name it
#[pyfunction]
fn open(py: Python, path: PathBuf, stays: bool) -> PyResult<Results> {
    let read = || match format_of(&path)? {
        Format::Run => {
            let run = on_threads(|| fretwear::Results::open(&path))??;
            Ok(Results::of_run(run, stays.then(|| path.clone())))
        }
        format => Results::of_study(&path, format, stays),
    };
    py.detach(read).map_err(|error| raised(py, &error))
}

/// Does what the command does with these arguments, the program's name first; the exit code.
#[pyfunction]
fn command(py: Python, arguments: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| fretwear::cli::main(arguments))
}

#[pymodule]
fn _native(module: &Bound<PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<Scene>()?;
    module.add_class::<Results>()?;
    module.add_function(wrap_pyfunction!(run, module)?)?;
    module.add_function(wrap_pyfunction!(limit, module)?)?;
    module.add_function(wrap_pyfunction!(check, module)?)?;
    module.add_function(wrap_pyfunction!(sweep, module)?)?;
    module.add_function(wrap_pyfunction!(calibrate, module)?)?;
    module.add_function(wrap_pyfunction!(open, module)?)?;
    module.add_function(wrap_pyfunction!(command, module)?)
}
