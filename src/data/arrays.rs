//! A file of labelled arrays over coordinates: what studies write beside their CSV tables.

use std::path::Path;

use hdf5::{File, Result as Hdf5Result};
use serde::Serialize;

use super::Format;
use super::atomic::AtomicFile;
use super::labelled::{Dimension, laid_out, put_array, put_integer, put_text};
use super::layout::{Label, label};
use super::reader;
use super::seal::{ResultPath, sealed};
use super::shard::unicode;
use crate::error::Result;

/// A coordinate: a dimension and the values along it.
#[derive(Debug, Clone, PartialEq)]
pub struct Coordinate {
    /// Name, units and meaning; the name is that of the dimension too.
    pub label: Label<'static>,
    /// Values along the dimension.
    pub values: Vec<f64>,
}

/// An array over some of the coordinates of its file.
#[derive(Debug, Clone, PartialEq)]
pub struct Array {
    /// Name, units and meaning.
    pub label: Label<'static>,
    /// Names of the coordinates, slowest first.
    pub axes: Vec<&'static str>,
    /// Values, the last axis fastest.
    pub values: Vec<f64>,
}

/// Words along one of the coordinates of its file.
#[derive(Debug, Clone, PartialEq)]
pub struct TextArray {
    /// Name and meaning; the unit is "1".
    pub label: Label<'static>,
    /// Name of the coordinate.
    pub axis: &'static str,
    /// One text for each of its values.
    pub values: Vec<String>,
}

/// A column of words of a table: name, meaning, and the word of a row.
pub type TextColumn<R> = (&'static str, &'static str, fn(&R) -> &str);

impl TextArray {
    /// The columns of words of a table.
    pub fn columns<R>(words: &[TextColumn<R>], rows: &[R], axis: &'static str) -> Vec<Self> {
        let column = |&(name, long_name, word): &TextColumn<R>| Self {
            label: label(name, "1", long_name),
            axis,
            values: rows.iter().map(|row| word(row).to_owned()).collect(),
        };
        words.iter().map(column).collect()
    }
}

/// Everything that a file of arrays holds; valid netCDF-4 in which every array names its coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct ArrayFile {
    /// What it is of.
    pub format: Format,
    /// Further root attributes, all text.
    pub attributes: Vec<(&'static str, String)>,
    /// The dimensions.
    pub coordinates: Vec<Coordinate>,
    /// The arrays.
    pub arrays: Vec<Array>,
    /// The words.
    pub texts: Vec<TextArray>,
}

impl ArrayFile {
    /// Version of the layout, the root attribute `format_version`.
    pub const FORMAT_VERSION: i32 = 1;

    /// Writes the file, as a whole or not at all.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) if the file exists and `overwrite` is not given, or cannot be written.
    ///
    /// # Panics
    /// If an array names a coordinate that is not there, or does not have the product of their lengths as its own.
    pub fn write(&self, path: &Path, overwrite: bool) -> Result<()> {
        let mut file = AtomicFile::new(path, overwrite)?;
        file.write(&sealed(laid_out(path, |file| self.put_into(file))?))
    }

    fn put_into(&self, file: &File) -> Hdf5Result<()> {
        put_text(file, "format", self.format.name())?;
        put_integer(file, "format_version", Self::FORMAT_VERSION)?;
        put_text(file, "program_version", env!("CARGO_PKG_VERSION"))?;
        for (name, text) in &self.attributes {
            put_text(file, name, text)?;
        }
        put_integer(file, "complete", 1)?;
        let dimensions = self
            .coordinates
            .iter()
            .map(|it| Dimension::coordinate(file, it.label, &it.values))
            .collect::<Hdf5Result<Vec<_>>>()?;
        for array in &self.arrays {
            let axes: Vec<&Dimension> =
                array.axes.iter().map(|axis| &dimensions[self.position(axis)]).collect();
            put_array(file, array.label, &axes, &array.values)?;
        }
        for array in &self.texts {
            let texts = array.values.iter().map(|text| unicode(text)).collect::<Hdf5Result<Vec<_>>>()?;
            put_array(file, array.label, &[&dimensions[self.position(array.axis)]], &texts)?;
        }
        Ok(())
    }

    fn position(&self, axis: &str) -> usize {
        let found = self.coordinates.iter().position(|it| it.label.name == axis);
        found.unwrap_or_else(|| panic!("no coordinate {axis}"))
    }
}

/// What a file of arrays holds, without the values.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ArraySummary {
    /// The root attribute `format`.
    pub format: String,
    /// Title of the study.
    pub title: String,
    /// Version of the program that wrote the file.
    pub program_version: String,
    /// Whether everything is in it.
    pub complete: bool,
    /// The datasets, by name.
    pub arrays: Vec<ArrayShape>,
}

/// Name, meaning and shape of a dataset.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ArrayShape {
    /// Name.
    pub name: String,
    /// Lengths along its dimensions, slowest first.
    pub shape: Vec<usize>,
    /// Units.
    pub units: String,
    /// Meaning.
    pub long_name: String,
}

impl ArraySummary {
    /// Reads what is in a file of arrays; none if it is of a run or not one of this program's.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) if it is no HDF5 file or damaged.
    pub fn read<'a>(file: impl Into<ResultPath<'a>>) -> Result<Option<Self>> {
        let (source, file) = reader::open(file)?;
        let Some(format) = source.format(&file)?.filter(|format| *format != Format::Run) else {
            return Ok(None);
        };
        let mut names = file.member_names().map_err(|error| source.damaged("its members", &error))?;
        names.sort();
        let shape = |name: String| {
            if let Ok(group) = file.group(&name) {
                let long_name = "whole runs, one group each".into();
                return Ok(ArrayShape {
                    name,
                    shape: vec![group.len() as usize],
                    units: "1".into(),
                    long_name,
                });
            }
            let dataset = file.dataset(&name).map_err(|error| source.damaged(&name, &error))?;
            Ok(ArrayShape {
                shape: dataset.shape(),
                units: source.text(&dataset, "units")?,
                long_name: source.text(&dataset, "long_name")?,
                name,
            })
        };
        Ok(Some(Self {
            format: format.name().into(),
            title: source.text(&file, "title")?,
            program_version: source.text(&file, "program_version")?,
            complete: source.integer(&file, "complete")? != 0,
            arrays: names.into_iter().map(shape).collect::<Result<_>>()?,
        }))
    }
}
