//! Results of any kind: labelled arrays, figures, a file.

use std::fs;
use std::path::{Path, PathBuf};

use fretwear::data::{Attribute, Dataset, Format, Values, Variable};
use fretwear::figures::drawing::{Drawing, Figure, png};
use fretwear::report::{self, RunReport};
use fretwear::study::on_threads;
use fretwear::{Error, FigureKind, FigureSource, Result};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyList};

use crate::errors::raised;
use crate::figure;

/// What the arrays are of.
enum Source {
    Run(Box<fretwear::Results>),
    /// The bytes of the file.
    Study(FigureSource, Vec<u8>),
}

/// What a run or a study came to.
#[pyclass(frozen, module = "fretwear._native")]
pub struct Results {
    source: Source,
    dataset: Dataset,
    format: Format,
    path: Option<PathBuf>,
}

impl Results {
    pub fn of_run(run: fretwear::Results, path: Option<PathBuf>) -> Self {
        let dataset = run.clone().into_file().dataset();
        Self { source: Source::Run(Box::new(run)), dataset, format: Format::Run, path }
    }

    /// Reads the file of a study.
    pub fn of_study(path: &Path, format: Format, stays: bool) -> Result<Self> {
        let (dataset, figures) = (Dataset::read(path, format)?, FigureSource::read(path)?);
        let unread = |error: std::io::Error| Error::File { path: path.to_owned(), why: error.to_string() };
        let source = Source::Study(figures, fs::read(path).map_err(unread)?);
        Ok(Self { source, dataset, format, path: stays.then(|| path.to_owned()) })
    }

    fn with_figures<T: Send>(&self, of: impl FnOnce(&FigureSource) -> Result<T> + Send) -> Result<T> {
        match &self.source {
            Source::Run(run) => on_threads(|| of(&FigureSource::of_run((**run).clone())?))?,
            Source::Study(figures, _) => of(figures),
        }
    }

    fn figure(&self, py: Python, kind: Option<&str>, quantity: Option<&str>) -> PyResult<Figure> {
        let made = |figures: &FigureSource| {
            let kind = match kind {
                None => figures.kinds().first().copied().unwrap_or(FigureKind::Profile),
                Some(name) => FigureKind::ALL.into_iter().find(|it| it.name() == name).ok_or_else(|| {
                    let known: Vec<&str> = figures.kinds().into_iter().map(FigureKind::name).collect();
                    Error::Option {
                        name: "kind",
                        why: format!("{name:?} is none; give {}", known.join(", ")),
                    }
                })?,
            };
            figures.figure(kind, quantity)
        };
        py.detach(|| self.with_figures(made)).map_err(|error| raised(py, &error))
    }

    /// The dataset of a group, such as `checkpoint/past`.
    fn group(&self, path: &str) -> PyResult<&Dataset> {
        path.split('/').filter(|part| !part.is_empty()).try_fold(&self.dataset, |dataset, part| {
            let found = dataset.groups.iter().find(|(name, _)| name == part);
            found.map(|(_, group)| group).ok_or_else(|| PyKeyError::new_err(path.to_owned()))
        })
    }

    fn variable(&self, path: &str) -> PyResult<&Variable> {
        let (group, name) = path.rsplit_once('/').unwrap_or(("", path));
        let found = self.group(group).ok().and_then(|it| it.variables.iter().find(|it| it.name == name));
        found.ok_or_else(|| PyKeyError::new_err(path.to_owned()))
    }
}

#[pymethods]
impl Results {
    /// `fretwear-run` and the like.
    #[getter]
    fn format(&self) -> &'static str {
        self.format.name()
    }

    /// The file that they were read from.
    #[getter]
    fn path(&self) -> Option<&str> {
        self.path.as_deref().and_then(Path::to_str)
    }

    /// Names of the variables of a group.
    fn names(&self, group: &str) -> PyResult<Vec<&str>> {
        let readable = |it: &&Variable| it.values != Values::Foreign;
        Ok(self.group(group)?.variables.iter().filter(readable).map(|it| it.name.as_str()).collect())
    }

    /// Names of the groups of a group.
    fn groups(&self, group: &str) -> PyResult<Vec<&str>> {
        Ok(self.group(group)?.groups.iter().map(|(name, _)| name.as_str()).collect())
    }

    /// Attributes of a group.
    fn attributes<'py>(&self, py: Python<'py>, group: &str) -> PyResult<Bound<'py, PyDict>> {
        attributes(py, &self.group(group)?.attributes)
    }

    /// Dimensions and attributes of a variable, units and meaning among them.
    fn labels<'py>(&self, py: Python<'py>, name: &str) -> PyResult<(Vec<String>, Bound<'py, PyDict>)> {
        let variable = self.variable(name)?;
        let said = attributes(py, &variable.attributes)?;
        said.set_item("units", &variable.units)?;
        said.set_item("long_name", &variable.long_name)?;
        Ok((variable.dimensions.clone(), said))
    }

    /// NumPy's name of the type, the shape, and the values: bytes, or a list of words.
    fn values<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<(&'static str, Vec<usize>, Bound<'py, PyAny>)> {
        fn bytes<'py, T: Copy, const N: usize>(
            py: Python<'py>,
            values: &[T],
            of: fn(T) -> [u8; N],
        ) -> Bound<'py, PyAny> {
            PyBytes::new(py, &values.iter().flat_map(|it| of(*it)).collect::<Vec<u8>>()).into_any()
        }
        let variable = self.variable(name)?;
        let (kind, values) = match &variable.values {
            Values::Numbers(values) => ("<f8", bytes(py, values, f64::to_le_bytes)),
            Values::Indices(values) => ("<i8", bytes(py, values, i64::to_le_bytes)),
            Values::Counts(values) => ("<u8", bytes(py, values, u64::to_le_bytes)),
            Values::Flags(values) => ("<i4", bytes(py, values, i32::to_le_bytes)),
            Values::Texts(words) => ("O", PyList::new(py, words.iter())?.into_any()),
            Values::Foreign => return Err(PyKeyError::new_err(name.to_owned())),
        };
        Ok((kind, variable.shape.clone(), values))
    }

    /// The JSON of `fretwear run`, for runs.
    fn summary(&self) -> Option<String> {
        let Source::Run(run) = &self.source else { return None };
        Some(report::json(&RunReport::new(run, self.path.as_deref().unwrap_or(Path::new("")))))
    }

    /// What deserves a word of a run that has ended.
    fn warnings(&self) -> Vec<String> {
        if let Source::Run(run) = &self.source { run.warnings() } else { vec![] }
    }

    /// The kinds of figures that fit.
    fn kinds(&self, py: Python) -> PyResult<Vec<&'static str>> {
        let kinds =
            py.detach(|| self.with_figures(|it| Ok(it.kinds()))).map_err(|error| raised(py, &error))?;
        Ok(kinds.into_iter().map(FigureKind::name).collect())
    }

    /// A picture: the bytes of SVG or PNG.
    fn picture<'py>(
        &self,
        py: Python<'py>,
        kind: Option<&str>,
        quantity: Option<&str>,
        as_png: bool,
        name: &str,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let figure = self.figure(py, kind, quantity)?;
        let drawn = py.detach(|| {
            let drawing = Drawing::new(&figure, name);
            if as_png { png(&drawing) } else { Ok(drawing.svg.into_bytes()) }
        });
        drawn.map(|bytes| PyBytes::new(py, &bytes)).map_err(|error| raised(py, &error))
    }

    /// Panels, axes and series of a figure as JSON.
    fn panels(&self, py: Python, kind: Option<&str>, quantity: Option<&str>) -> PyResult<String> {
        self.figure(py, kind, quantity).map(|it| figure::json(&it))
    }

    /// The bytes of the file.
    fn bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        match &self.source {
            Source::Study(_, bytes) => Ok(PyBytes::new(py, bytes)),
            Source::Run(_) => {
                let bytes = py.detach(|| self.dataset.bytes(Path::new("run")));
                bytes.map(|it| PyBytes::new(py, &it)).map_err(|error| raised(py, &error))
            }
        }
    }

    /// Writes the file of a run.
    fn save(&self, py: Python, path: PathBuf, overwrite: bool) -> PyResult<()> {
        let saved = py.detach(|| match &self.source {
            Source::Run(run) if overwrite => run.save_over(&path),
            Source::Run(run) => run.save(&path),
            Source::Study(_, bytes) => fretwear::data::write_file(&path, bytes, overwrite),
        });
        saved.map_err(|error| raised(py, &error))
    }
}

fn attributes<'py>(py: Python<'py>, said: &[(String, Attribute)]) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    for (name, attribute) in said {
        match attribute {
            Attribute::Text(text) => found.set_item(name, text),
            Attribute::Integer(value) => found.set_item(name, value),
            Attribute::Count(value) => found.set_item(name, value),
            Attribute::Real(value) => found.set_item(name, value),
            Attribute::Integers(values) => found.set_item(name, values),
        }?;
    }
    Ok(found)
}
