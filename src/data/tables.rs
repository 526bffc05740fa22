//! Result files of every kind as tables: variables over the same dimensions stand beside each other, one row for each place along them.

use serde::Serialize;

use super::Format;
use super::cells::{cell, quoted, table};
use super::dataset::{Dataset, Values, Variable};
use super::layout::FLAG_MEANINGS;
use super::reader::{OpenFile, Wanted};
use super::seal::ResultPath;
use super::shard::{RUNS, kept_runs};
use crate::error::{Error, Result, most_alike};

const NOT_OURS: &str =
    "give a file that `fretwear run`, `sweep`, `merge`, `map`, `universality` or `tradeoff` wrote";

/// What a table holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableSummary {
    /// Its name: the group and the dimensions, `loops/time,point`.
    pub name: String,
    /// Number of rows.
    pub rows: usize,
    /// Heads of its columns.
    pub columns: Vec<String>,
}

/// A result file of any kind, read as tables.
///
/// A table is named by its dimensions, `time` or `time,node`, after the group in which they are, `loops/time,point`; one without dimensions by
/// its group alone, `checkpoint`. The columns are the dimensions, the coordinates along them, then the variables. A head is the name of the
/// variable with its unit, `wear_volume [m3]`, and the name alone for a pure number or a word. Numbers have all digits that tell them from any
/// other; a cell is empty where there is none.
#[derive(Debug)]
pub struct ResultTables {
    open: OpenFile,
    dataset: Dataset,
    usual: &'static str,
    /// Runs kept in the file of a sweep, of which the first is in the dataset.
    runs: Vec<String>,
}

/// Variables over the same dimensions.
struct Table<'a> {
    name: String,
    /// Name and length of its dimensions, slowest first.
    axes: Vec<(&'a str, usize)>,
    columns: Vec<&'a Variable>,
}

impl ResultTables {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Error::File`] if it is no HDF5 file, not one of this program's, or damaged.
    pub fn open<'a>(file: impl Into<ResultPath<'a>>) -> Result<Self> {
        let open = OpenFile::new(file)?;
        let usual = match open.format(&open.file)? {
            Some(Format::Run) => "time",
            Some(Format::Sweep) => "scene",
            Some(Format::Map) => "grading,amplitude_ratio",
            Some(Format::Universality) => "case",
            Some(Format::Tradeoff) => "candidate",
            Some(Format::Calibration) => "parameter",
            None => return Err(open.error(format!("is no result of this program; {NOT_OURS}"))),
        };
        let (dataset, runs) = (open.dataset(&open.file, Wanted::Everything, &[RUNS])?, kept_runs(&open)?);
        let mut this = Self { open, dataset, usual, runs };
        if let Some(first) = this.runs.first().cloned() {
            this.add_run(&first)?;
        }
        Ok(this)
    }

    /// One of the tables of a file, by its name or the usual one; of the runs that a sweep has kept, any may be named.
    ///
    /// # Errors
    /// As [`ResultTables::open`]; also if there is no such table.
    pub fn csv<'a>(file: impl Into<ResultPath<'a>>, name: Option<&str>) -> Result<String> {
        let mut this = Self::open(file)?;
        let name = name.unwrap_or(this.usual);
        let run = name.strip_prefix("runs/").and_then(|rest| rest.split('/').next());
        if let Some(run) = run.filter(|run| this.runs.iter().skip(1).any(|other| other == run)) {
            this.add_run(run)?;
        }
        let tables = this.tables()?;
        match tables.iter().find(|table| table.name == name) {
            Some(table) => Ok(table.text()),
            None => Err(this.no_such_table(name, &tables)),
        }
    }

    /// The tables of the file; of the runs that a sweep has kept, those of the first.
    ///
    /// # Errors
    /// [`Error::File`] if a variable does not run along dimensions of the file.
    pub fn summaries(&self) -> Result<Vec<TableSummary>> {
        let summary = |table: Table| TableSummary {
            rows: table.rows(),
            columns: table.columns.iter().map(|it| head(it)).collect(),
            name: table.name,
        };
        Ok(self.tables()?.into_iter().map(summary).collect())
    }

    /// Name of the table that is taken where none is named.
    pub fn usual(&self) -> &'static str {
        self.usual
    }

    /// Names of the runs that a sweep has kept, as they stand in names of tables: `runs/0`.
    pub fn runs(&self) -> Vec<String> {
        self.runs.iter().map(|run| format!("{RUNS}/{run}")).collect()
    }

    fn no_such_table(&self, name: &str, tables: &[Table]) -> Error {
        let names: Vec<&str> = tables.iter().map(|table| table.name.as_str()).collect();
        let near = most_alike(name, &names).map_or("", |(_, near)| near);
        self.open
            .error(format!("has no table {name:?}; did you mean {near:?}? There are: {}", names.join("  ")))
    }

    fn add_run(&mut self, run: &str) -> Result<()> {
        let place = format!("{RUNS}/{run}");
        let group = self.open.file.group(&place).map_err(|error| self.open.damaged(&place, &error))?;
        let run = self.open.dataset(&group, Wanted::Everything, &[])?;
        self.dataset.groups.push((place, run));
        Ok(())
    }

    fn tables(&self) -> Result<Vec<Table<'_>>> {
        let mut tables = vec![];
        add_tables(&mut tables, &self.dataset, "", &mut vec![])?;
        Ok(tables)
    }
}

/// Adds the tables of a dataset and of the groups in it, whose variables may run along dimensions and name coordinates of those around them.
fn add_tables<'a>(
    tables: &mut Vec<Table<'a>>,
    dataset: &'a Dataset,
    path: &str,
    around: &mut Vec<&'a Dataset>,
) -> Result<()> {
    if let Some((name, why)) = dataset.unusable.first() {
        return Err(dataset.damaged(name, why));
    }
    around.push(dataset);
    let find = |name: &str| {
        let inwards = around.iter().rev();
        inwards.filter_map(|it| it.variables.iter().find(|it| it.name == name)).next()
    };
    let first = tables.len();
    for variable in dataset.variables.iter().filter(|it| !it.is_coordinate()) {
        let name = variable.name.as_str();
        if let Some(axis) = variable.dimensions.iter().position(String::is_empty) {
            return Err(dataset.damaged(name, &format!("axis {axis} has no dimension scale")));
        }
        let names = variable.dimensions.join(",");
        let title = match (path, names.as_str()) {
            ("", names) => names.to_owned(),
            (path, "") => path.to_owned(),
            (path, names) => format!("{path}/{names}"),
        };
        let place = tables[first..].iter().position(|table| table.name == title);
        let place = place.map_or(tables.len(), |place| first + place);
        if place == tables.len() {
            let axes = variable.dimensions.iter().map(String::as_str).zip(variable.shape.iter().copied());
            let columns = variable.dimensions.iter().filter_map(|name| find(name)).collect();
            tables.push(Table { name: title, axes: axes.collect(), columns });
        }
        let table = &mut tables[place];
        let coordinates = variable.text("coordinates").unwrap_or_default().split_whitespace();
        for column in coordinates.filter_map(find).chain([variable]) {
            table.add(column).map_err(|why| dataset.damaged(&column.name, &why))?;
        }
    }
    for (name, inner) in &dataset.groups {
        let path = if path.is_empty() { name.clone() } else { format!("{path}/{name}") };
        add_tables(tables, inner, &path, around)?;
    }
    around.pop();
    Ok(())
}

impl<'a> Table<'a> {
    fn rows(&self) -> usize {
        self.axes.iter().map(|axis| axis.1).product()
    }

    /// Adds a variable once.
    fn add(&mut self, variable: &'a Variable) -> std::result::Result<(), String> {
        if self.columns.iter().any(|it| it.name == variable.name) {
            return Ok(());
        }
        let own = variable.dimensions.iter().map(String::as_str).zip(variable.shape.iter().copied());
        if !own.clone().all(|axis| self.axes.contains(&axis)) {
            return Err(format!("does not run along the dimensions of {}", self.name));
        }
        self.columns.push(variable);
        Ok(())
    }

    fn text(&self) -> String {
        let columns: Vec<_> = self.columns.iter().map(|it| (cells(it), self.strides(it))).collect();
        let rows = (0..self.rows()).map(|row| {
            let mut place = vec![0; self.axes.len()];
            let mut rest = row;
            for (index, (_, length)) in place.iter_mut().zip(&self.axes).rev() {
                *index = rest % length;
                rest /= length;
            }
            let at =
                |strides: &[usize]| place.iter().zip(strides).map(|(index, stride)| index * stride).sum();
            columns.iter().map(|(cell, strides)| cell(at(strides))).collect()
        });
        let heads: Vec<String> = self.columns.iter().map(|it| quoted(&head(it))).collect();
        table(heads.iter().map(String::as_str), rows)
    }

    /// Steps of the position in the values of a variable for one step along each axis of the table.
    fn strides(&self, variable: &Variable) -> Vec<usize> {
        let mut strides = vec![0; self.axes.len()];
        let mut stride = 1;
        for (name, length) in variable.dimensions.iter().zip(&variable.shape).rev() {
            let axis = self.axes.iter().position(|axis| axis.0 == name).expect("looked at when it was added");
            strides[axis] = stride;
            stride *= length;
        }
        strides
    }
}

/// `wear_volume [m3]`; the name alone where the unit is 1.
fn head(variable: &Variable) -> String {
    match variable.units.as_str() {
        "1" => variable.name.clone(),
        unit => format!("{} [{unit}]", variable.name),
    }
}

/// How a value is written, by its place.
fn cells(variable: &Variable) -> Box<dyn Fn(usize) -> String + '_> {
    match &variable.values {
        Values::Numbers(values) => Box::new(|place| cell(values[place])),
        Values::Indices(values) => Box::new(|place| values[place].to_string()),
        Values::Counts(values) => Box::new(|place| values[place].to_string()),
        Values::Texts(words) => Box::new(|place| quoted(words.get(place))),
        Values::Flags(flags) => {
            let meanings: Vec<&str> =
                variable.text(FLAG_MEANINGS).unwrap_or_default().split_whitespace().collect();
            Box::new(move |place| {
                let meaning = usize::try_from(flags[place]).ok().and_then(|flag| meanings.get(flag));
                meaning.map_or_else(|| flags[place].to_string(), |word| (*word).to_owned())
            })
        }
        Values::Foreign => Box::new(|_| String::new()),
    }
}

/// What a file of a study holds, without the values.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DatasetSummary {
    /// The root attribute `format`.
    pub format: String,
    /// Title of the study.
    pub title: String,
    /// Version of the program that wrote the file.
    pub program_version: String,
    /// Whether everything is in it.
    pub complete: bool,
    /// The variables, by name.
    pub arrays: Vec<VariableSummary>,
}

/// Name, meaning and shape of a variable.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct VariableSummary {
    /// Name.
    pub name: String,
    /// Lengths along its dimensions, slowest first.
    pub shape: Vec<usize>,
    /// Units.
    pub units: String,
    /// Meaning.
    pub long_name: String,
}

impl DatasetSummary {
    /// Reads what is in a file of a study; none if it is of a run or not one of this program's.
    ///
    /// # Errors
    /// [`Error::File`] if it is no HDF5 file or damaged.
    pub fn read<'a>(file: impl Into<ResultPath<'a>>) -> Result<Option<Self>> {
        let open = OpenFile::new(file)?;
        let Some(format) = open.format(&open.file)?.filter(|format| *format != Format::Run) else {
            return Ok(None);
        };
        let stored = open.dataset(&open.file, Wanted::Labels, &[RUNS])?;
        let summary = |Variable { name, shape, units, long_name, .. }| VariableSummary {
            name,
            shape,
            units,
            long_name,
        };
        let mut arrays: Vec<_> = stored.variables.into_iter().map(summary).collect();
        if open.file.link_exists(RUNS) {
            let (name, units) = (RUNS.to_owned(), "1".to_owned());
            let long_name = "whole runs, one group each".to_owned();
            arrays.push(VariableSummary { name, shape: vec![kept_runs(&open)?.len()], units, long_name });
        }
        arrays.sort_by(|one, other| one.name.cmp(&other.name));
        Ok(Some(Self {
            format: format.name().into(),
            title: open.text(&open.file, "title")?,
            program_version: open.text(&open.file, "program_version")?,
            complete: open.integer::<i32>(&open.file, "complete")? != 0,
            arrays,
        }))
    }
}
