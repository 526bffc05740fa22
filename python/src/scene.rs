//! Scenes and studies from what Python gives: a path, a TOML text, or a dictionary.

use std::path::{Path, PathBuf};

use fretwear::scene::Calibration;
use fretwear::study::calibration::Foretold;
use fretwear::{Error, Study};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use toml::Value;

use crate::errors::{of_input, raised};
use crate::values;

/// What a scene is given as.
pub enum Source {
    /// Its file.
    File(PathBuf),
    /// Its text.
    Text(String),
}

impl Source {
    /// A path, or TOML: a text with a line break or an equals sign, or a dictionary.
    fn new(given: &Bound<PyAny>) -> PyResult<Self> {
        if let Ok(table) = given.cast::<PyDict>() {
            return Ok(Self::Text(values::table(table, "")?.to_string()));
        }
        let text: Option<String> = given.cast::<PyString>().ok().map(|it| it.extract()).transpose()?;
        match text {
            Some(text) if text.contains(['\n', '=']) => Ok(Self::Text(text)),
            _ => given.extract().map(Self::File),
        }
    }
}

/// A scene that has been read.
#[pyclass(frozen, module = "fretwear._native")]
pub struct Scene {
    pub scene: fretwear::Scene,
    /// What messages call it.
    name: String,
    /// To which the files that it names are relative.
    #[pyo3(get)]
    folder: String,
}

#[pymethods]
impl Scene {
    #[new]
    fn new(
        py: Python,
        source: &Bound<PyAny>,
        set: Option<&Bound<PyDict>>,
        folder: Option<PathBuf>,
    ) -> PyResult<Self> {
        let setting = |(key, value): (Bound<PyAny>, Bound<PyAny>)| -> PyResult<String> {
            let key: String = key.extract()?;
            Ok(format!("{key}={}", values::value(&value, &key)?))
        };
        let settings: Vec<String> =
            set.iter().flat_map(|it| it.iter()).map(setting).collect::<PyResult<_>>()?;
        let source = Source::new(source)?;
        let here = Path::new("");
        let (path, folder, read) = match &source {
            Source::File(path) => {
                let folder = path.parent().unwrap_or(here).to_owned();
                (path.as_path(), folder, fretwear::Scene::read_with(path, &settings))
            }
            Source::Text(text) => {
                let (name, folder) = (Path::new("scene"), folder.unwrap_or_default());
                let read = fretwear::Scene::from_toml_with(text, name, &folder, &settings);
                (name, folder, read)
            }
        };
        let name = fretwear::Scene::name_with(path, &settings);
        let scene = read.map_err(|error| of_input(py, &error))?;
        Ok(Self { scene, name, folder: std::env::current_dir()?.join(folder).display().to_string() })
    }

    /// The TOML text.
    #[getter]
    fn toml(&self) -> &str {
        self.scene.text()
    }

    /// What is allowed but deserves a word.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.scene.warnings().to_vec()
    }
}

impl Scene {
    /// An error shown at its line.
    pub fn located(&self, error: Error) -> Error {
        self.scene.locate(error, &self.name)
    }
}

/// The key of a scene in a study or calibration, and what messages call one that is a dictionary.
const SCENE: &str = "scene";

/// The text of a study or calibration that is a dictionary, and that of its scene where this is one as well.
fn texts(table: &Bound<PyDict>) -> PyResult<(String, Option<String>)> {
    let mut table = values::table(table, "")?;
    let scene = match table.get(SCENE) {
        Some(Value::Table(scene)) => Some(scene.to_string()),
        _ => None,
    };
    if scene.is_some() {
        table.insert(SCENE.into(), Value::String(SCENE.into()));
    }
    Ok((table.to_string(), scene))
}

/// A study; the base scene of one that is a dictionary may be a dictionary as well.
pub fn study(given: &Bound<PyAny>) -> PyResult<Study> {
    let here = Path::new("");
    let read = match given.cast::<PyDict>() {
        Ok(table) => match texts(table)? {
            (text, Some(scene)) => Study::from_texts(&text, "study", &scene, Path::new(SCENE)),
            (text, None) => Study::from_toml(&text, "study", here),
        },
        Err(_) => match Source::new(given)? {
            Source::File(path) => Study::read(&path),
            Source::Text(text) => Study::from_toml(&text, "study", here),
        },
    };
    read.map_err(|error| raised(given.py(), &error))
}

/// The text of a scene that is foretold, and what messages call it.
pub fn foretold(given: &Bound<PyAny>, draws: usize) -> PyResult<Foretold> {
    match Source::new(given)? {
        Source::File(path) => Foretold::read(&path, draws).map_err(|error| of_input(given.py(), &error)),
        Source::Text(text) => Ok(Foretold { text, name: SCENE.into(), draws }),
    }
}

/// A calibration, whose scene may be a dictionary as well; files that a dictionary or a text names are relative to the working directory.
pub fn calibration(given: &Bound<PyAny>) -> PyResult<Calibration> {
    let here = Path::new("");
    let read = match given.cast::<PyDict>() {
        Ok(table) => match texts(table)? {
            (text, Some(scene)) => {
                Calibration::from_texts(&text, "calibration", here, (&scene, Path::new(SCENE)))
            }
            (text, None) => Calibration::from_toml(&text, "calibration", here),
        },
        Err(_) => match Source::new(given)? {
            Source::File(path) => Calibration::read(&path),
            Source::Text(text) => Calibration::from_toml(&text, "calibration", here),
        },
    };
    read.map_err(|error| of_input(given.py(), &error))
}
