//! Result files of every kind as tables: variables over the same dimensions stand beside each other, one row for each place along them.

use hdf5::{Dataset, File, Group, IndexType, IterationOrder};

use super::Format;
use super::folder::{cell, quoted, table};
use super::labelled::{is_dimension, runs_along};
use super::layout::FLAG_MEANINGS;
use super::reader::{self, Source};
use super::seal::ResultPath;
use super::shard::RUNS;
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

/// A result file of any kind, opened to be read as tables.
///
/// A table is named by its dimensions, `time` or `time,node`, after the group in which they are, `loops/time,point`; one without dimensions by
/// its group alone, `checkpoint`. The columns are the dimensions, the coordinates along them, then the variables. A head is the name of the
/// dataset with its unit, `wear_volume [m3]`, and the name alone for a pure number or a word. Numbers have all digits that tell them from any
/// other; a cell is empty where there is none.
#[derive(Debug)]
pub struct ResultTables {
    source: Source,
    tables: Vec<Table>,
    usual: &'static str,
    /// Runs kept in the file of a sweep, of which the first is among the tables.
    runs: Vec<String>,
}

/// Datasets over the same dimensions.
#[derive(Debug)]
struct Table {
    name: String,
    axes: Vec<Dataset>,
    columns: Vec<Variable>,
}

/// A dataset and the places of its axes among those of its table.
#[derive(Debug)]
struct Variable {
    name: String,
    dataset: Dataset,
    axes: Vec<usize>,
}

/// Values of a dataset.
enum Values {
    Real(Vec<f64>),
    Whole(Vec<i64>),
    Words(Vec<String>),
}

impl ResultTables {
    /// Opens a file.
    ///
    /// # Errors
    /// [`Error::File`] if it is no HDF5 file, not one of this program's, or damaged.
    pub fn open<'a>(file: impl Into<ResultPath<'a>>) -> Result<Self> {
        let (source, file) = reader::open(file)?;
        let usual = match source.format(&file)? {
            Some(Format::Run) => "time",
            Some(Format::Sweep) => "scene",
            Some(Format::Map) => "grading,amplitude_ratio",
            Some(Format::Universality) => "case",
            Some(Format::Tradeoff) => "candidate",
            None => return Err(source.error(format!("is no result of this program; {NOT_OURS}"))),
        };
        let mut this = Self { source, tables: vec![], usual, runs: vec![] };
        this.walk(&file, "", &[])?;
        if let Some(first) = this.list_runs(&file)? {
            this.walk_run(&file, &first)?;
        }
        Ok(this)
    }

    /// Opens a file for one of its tables, by its name or the usual one; of the runs that a sweep has kept, any may be named.
    ///
    /// # Errors
    /// As [`ResultTables::open`]; also if there is no such table.
    pub fn csv<'a>(file: impl Into<ResultPath<'a>>, name: Option<&str>) -> Result<String> {
        let file = file.into().ready()?;
        let mut this = Self::open(file)?;
        let name = name.unwrap_or(this.usual);
        let run = name.strip_prefix("runs/").and_then(|rest| rest.split('/').next());
        if let Some(run) = run.filter(|run| this.runs.iter().skip(1).any(|other| other == run)) {
            this.walk_run(&reader::open(file)?.1, run)?;
        }
        match this.tables.iter().find(|table| table.name == name) {
            Some(table) => this.text(table),
            None => Err(this.no_such_table(name)),
        }
    }

    /// The tables of the file; of the runs that a sweep has kept, those of the first.
    pub fn summaries(&self) -> Vec<TableSummary> {
        let summary = |table: &Table| TableSummary {
            name: table.name.clone(),
            rows: table.rows(),
            columns: table
                .columns
                .iter()
                .map(|it| it.head(&self.source).unwrap_or(it.name.clone()))
                .collect(),
        };
        self.tables.iter().map(summary).collect()
    }

    /// Name of the table that is taken where none is named.
    pub fn usual(&self) -> &'static str {
        self.usual
    }

    /// Names of the runs that a sweep has kept, as they stand in names of tables: `runs/0`.
    pub fn runs(&self) -> Vec<String> {
        self.runs.iter().map(|run| format!("{RUNS}/{run}")).collect()
    }

    fn no_such_table(&self, name: &str) -> Error {
        let names: Vec<&str> = self.tables.iter().map(|table| table.name.as_str()).collect();
        let near = most_alike(name, &names).map_or("", |(_, near)| near);
        self.source
            .error(format!("has no table {name:?}; did you mean {near:?}? There are: {}", names.join("  ")))
    }

    fn list_runs(&mut self, file: &File) -> Result<Option<String>> {
        if !file.link_exists(RUNS) {
            return Ok(None);
        }
        let group = file.group(RUNS).map_err(|error| self.source.damaged(RUNS, &error))?;
        self.runs = group.member_names().map_err(|error| self.source.damaged(RUNS, &error))?;
        self.runs.sort_by_key(|name| name.parse::<u64>().ok());
        Ok(self.runs.first().cloned())
    }

    fn walk_run(&mut self, file: &File, run: &str) -> Result<()> {
        let place = format!("{RUNS}/{run}");
        let group = file.group(&place).map_err(|error| self.source.damaged(&place, &error))?;
        self.walk(&group, &place, &[])
    }

    /// Adds the tables of a group and of the groups in it, where datasets may run along dimensions of the groups above.
    fn walk(&mut self, group: &Group, path: &str, above: &[(String, Dataset)]) -> Result<()> {
        let damaged = |what: &str, error: &dyn std::fmt::Display| self.source.damaged(what, error);
        // In the order of creation, in which what belongs together stands together.
        let names = group
            .member_names_by(IndexType::CreationOrder, IterationOrder::Increasing)
            .or_else(|_| group.member_names())
            .map_err(|error| damaged(path, &error))?;
        let (mut groups, mut datasets) = (vec![], vec![]);
        for name in names.into_iter().filter(|name| !(path.is_empty() && name == RUNS)) {
            match group.group(&name) {
                Ok(inner) => groups.push((name, inner)),
                Err(_) => {
                    let dataset = group.dataset(&name).map_err(|error| damaged(&name, &error))?;
                    datasets.push((name, dataset));
                }
            }
        }
        let known: Vec<(String, Dataset)> = datasets.iter().chain(above).cloned().collect();
        let first = self.tables.len();
        for (name, dataset) in datasets.iter().filter(|(_, dataset)| !is_dimension(dataset)) {
            let axes = axes(dataset, &known).map_err(|why| damaged(name, &why))?;
            let names: Vec<&str> = axes.iter().map(|axis| axis.0.as_str()).collect();
            let title = match (path, &names[..]) {
                ("", names) => names.join(","),
                (path, []) => path.to_owned(),
                (path, names) => format!("{path}/{}", names.join(",")),
            };
            let table = match self.tables[first..].iter().position(|table| table.name == title) {
                Some(place) => first + place,
                None => {
                    self.tables.push(Table::new(title, axes));
                    self.tables.len() - 1
                }
            };
            self.tables[table].add_with_coordinates(&self.source, name, dataset, &known)?;
        }
        for (name, inner) in groups {
            let path = if path.is_empty() { name } else { format!("{path}/{name}") };
            self.walk(&inner, &path, &known)?;
        }
        Ok(())
    }

    fn text(&self, shown: &Table) -> Result<String> {
        let heads = shown.columns.iter().map(|it| it.head(&self.source)).collect::<Result<Vec<_>>>()?;
        let lengths: Vec<usize> = shown.axes.iter().map(|axis| axis.size()).collect();
        let columns = shown
            .columns
            .iter()
            .map(|it| Ok((it.values(&self.source, &lengths)?, it.strides(&lengths))))
            .collect::<Result<Vec<_>>>()?;
        let rows = (0..shown.rows()).map(|row| {
            let mut place = vec![0; lengths.len()];
            let mut rest = row;
            for (index, length) in place.iter_mut().zip(&lengths).rev() {
                *index = rest % length;
                rest /= length;
            }
            let of = |(values, strides): &(Values, Vec<usize>)| {
                values.cell(place.iter().zip(strides).map(|(index, stride)| index * stride).sum())
            };
            columns.iter().map(of).collect()
        });
        let heads: Vec<String> = heads.iter().map(|head| quoted(head)).collect();
        Ok(table(heads.iter().map(String::as_str), rows))
    }
}

/// The dimensions of a dataset.
fn axes(
    dataset: &Dataset,
    known: &[(String, Dataset)],
) -> std::result::Result<Vec<(String, Dataset)>, String> {
    let along = |axis: usize| {
        let found = known.iter().find(|(_, it)| is_dimension(it) && runs_along(dataset, axis, it));
        let (name, dimension) = found.ok_or(format!("axis {axis} has no dimension scale"))?;
        match dataset.shape()[axis] == dimension.size() {
            true => Ok((name.clone(), dimension.clone())),
            false => Err(format!("axis {axis} is not as long as its dimension {name}")),
        }
    };
    (0..dataset.ndim()).map(along).collect()
}

impl Table {
    /// A table of its dimensions alone.
    fn new(name: String, axes: Vec<(String, Dataset)>) -> Self {
        let columns = axes.iter().enumerate().map(|(place, (name, dataset))| Variable {
            name: name.clone(),
            dataset: dataset.clone(),
            axes: vec![place],
        });
        Self { name, columns: columns.collect(), axes: axes.into_iter().map(|axis| axis.1).collect() }
    }

    fn rows(&self) -> usize {
        self.axes.iter().map(|axis| axis.size()).product()
    }

    /// Adds a variable after the coordinates that it names, each once.
    fn add_with_coordinates(
        &mut self,
        source: &Source,
        name: &str,
        dataset: &Dataset,
        known: &[(String, Dataset)],
    ) -> Result<()> {
        let named = match dataset.attr("coordinates") {
            Ok(_) => source.text(dataset, "coordinates")?,
            Err(_) => String::new(),
        };
        for coordinate in named.split_whitespace() {
            if let Some((name, dataset)) = known.iter().find(|(name, _)| name == coordinate) {
                self.add(source, name, dataset)?;
            }
        }
        self.add(source, name, dataset)
    }

    fn add(&mut self, source: &Source, name: &str, dataset: &Dataset) -> Result<()> {
        if self.columns.iter().any(|it| it.name == name) {
            return Ok(());
        }
        let place = |axis| {
            let found = self.axes.iter().position(|dimension| runs_along(dataset, axis, dimension));
            found.ok_or_else(|| {
                source.damaged(name, &format!("does not run along the dimensions of {}", self.name))
            })
        };
        let axes = (0..dataset.ndim()).map(place).collect::<Result<_>>()?;
        self.columns.push(Variable { name: name.to_owned(), dataset: dataset.clone(), axes });
        Ok(())
    }
}

impl Variable {
    /// `wear_volume [m3]`; the name alone where the unit is 1.
    fn head(&self, source: &Source) -> Result<String> {
        Ok(match source.text(&self.dataset, "units")?.as_str() {
            "1" => self.name.clone(),
            unit => format!("{} [{unit}]", self.name),
        })
    }

    /// Steps of the position in the values for one step along each axis of the table.
    fn strides(&self, lengths: &[usize]) -> Vec<usize> {
        let mut strides = vec![0; lengths.len()];
        let mut stride = 1;
        for &axis in self.axes.iter().rev() {
            strides[axis] = stride;
            stride *= lengths[axis];
        }
        strides
    }

    fn values(&self, source: &Source, lengths: &[usize]) -> Result<Values> {
        let shape: Vec<Option<usize>> = self.axes.iter().map(|&axis| Some(lengths[axis])).collect();
        let kind = self.dataset.dtype().map_err(|error| source.damaged(&self.name, &error))?;
        let dataset = &self.dataset;
        let values = if kind.is::<f64>() {
            Values::Real(source.values_of(dataset, &self.name, &shape)?)
        } else if kind.is::<i64>() {
            Values::Whole(source.values_of(dataset, &self.name, &shape)?)
        } else if kind.is::<i32>() {
            let numbers: Vec<i32> = source.values_of(dataset, &self.name, &shape)?;
            self.words(source, &numbers)?
                .unwrap_or_else(|| Values::Whole(numbers.into_iter().map(i64::from).collect()))
        } else if kind.is::<u64>() {
            let numbers: Vec<u64> = source.values_of(dataset, &self.name, &shape)?;
            Values::Whole(numbers.into_iter().map(u64::cast_signed).collect())
        } else {
            Values::Words(source.words_of(dataset, &self.name, &shape)?)
        };
        Ok(values)
    }

    /// The words that numbers stand for, where there are any.
    fn words(&self, source: &Source, numbers: &[i32]) -> Result<Option<Values>> {
        if self.dataset.attr(FLAG_MEANINGS).is_err() {
            return Ok(None);
        }
        let meanings = source.text(&self.dataset, FLAG_MEANINGS)?;
        let meanings: Vec<&str> = meanings.split_whitespace().collect();
        let word = |flag: &i32| {
            let meaning = usize::try_from(*flag).ok().and_then(|place| meanings.get(place));
            meaning.map_or_else(|| flag.to_string(), |word| (*word).to_owned())
        };
        Ok(Some(Values::Words(numbers.iter().map(word).collect())))
    }
}

impl Values {
    fn cell(&self, place: usize) -> String {
        match self {
            Self::Real(values) => cell(values[place]),
            Self::Whole(values) => values[place].to_string(),
            Self::Words(values) => quoted(&values[place]),
        }
    }
}
