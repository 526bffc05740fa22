//! Reading a file of labelled arrays; nothing in a file is trusted.

use std::collections::BTreeMap;
use std::path::PathBuf;

use hdf5::types::VarLenUnicode;
use hdf5::{Dataset, File};

use super::Format;
use super::arrays::ArrayFile;
use super::reader::{self, Source};
use super::seal::ResultPath;
use crate::error::{Error, Result};

/// Most dimensions that an array of this program has.
const MOST_DIMENSIONS: usize = 2;

/// What a result file of any kind is of.
///
/// # Errors
/// [`Error::File`] if it is no HDF5 file, is damaged or was not written by this program.
pub fn format_of<'a>(file: impl Into<ResultPath<'a>>) -> Result<Format> {
    let (source, file) = reader::open(file)?;
    source.format(&file)?.ok_or_else(|| {
        let why = "is an HDF5 file, but not one of this program; give a result file that fretwear wrote";
        source.error(why.into())
    })
}

/// An array as it is stored.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredArray {
    /// Units.
    pub units: String,
    /// Meaning.
    pub long_name: String,
    /// Lengths along its dimensions, slowest first.
    pub shape: Vec<usize>,
    /// Values, the last dimension fastest.
    pub values: Vec<f64>,
}

/// A file of labelled arrays read back: numbers and words by their names.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredArrays {
    path: PathBuf,
    /// What it is of.
    pub format: Format,
    /// The root attribute `title`.
    pub title: String,
    /// Version of the program that wrote the file.
    pub program_version: String,
    attributes: BTreeMap<String, String>,
    numbers: BTreeMap<String, StoredArray>,
    words: BTreeMap<String, Vec<String>>,
}

impl StoredArrays {
    /// Reads a file that [`ArrayFile::write`] wrote, in one of its formats.
    ///
    /// # Errors
    /// [`Error::File`] names the file, what in it cannot be used, and the cure.
    pub fn read<'a>(file: impl Into<ResultPath<'a>>, format: Format) -> Result<Self> {
        let file = file.into();
        let path = file.path();
        let (source, file) = reader::open(file)?;
        source.check_format(
            &file,
            format,
            ArrayFile::FORMAT_VERSION,
            "give the file that the program wrote",
        )?;
        let mut stored = Self {
            path: path.to_owned(),
            format,
            title: source.text(&file, "title")?,
            program_version: source.text(&file, "program_version")?,
            attributes: attributes(&source, &file)?,
            numbers: BTreeMap::new(),
            words: BTreeMap::new(),
        };
        for name in file.member_names().map_err(|error| source.damaged("its members", &error))? {
            let dataset = file.dataset(&name).map_err(|error| source.damaged(&name, &error))?;
            stored.add(&source, name, &dataset)?;
        }
        Ok(stored)
    }

    fn add(&mut self, source: &Source, name: String, dataset: &Dataset) -> Result<()> {
        let (units, long_name) = (source.text(dataset, "units")?, source.text(dataset, "long_name")?);
        let shape = dataset.shape();
        if shape.len() > MOST_DIMENSIONS {
            return Err(source.damaged(&name, &format!("has {} dimensions", shape.len())));
        }
        let any = vec![None; shape.len()];
        if dataset.dtype().is_ok_and(|kind| kind.is::<VarLenUnicode>()) {
            self.words.insert(name, source.words_of(dataset, &dataset.name(), &any)?);
        } else {
            let values = source.values_of(dataset, &dataset.name(), &any)?;
            self.numbers.insert(name, StoredArray { units, long_name, shape, values });
        }
        Ok(())
    }

    /// A further root attribute, where there is one of that name.
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.get(name).map(String::as_str)
    }

    /// Names of the arrays of numbers.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.numbers.keys().map(String::as_str)
    }

    /// Values of an array of numbers over dimensions that have lengths.
    ///
    /// # Errors
    /// [`Error::File`] if there is none of that name and shape.
    pub fn numbers(&self, name: &str, shape: &[usize]) -> Result<&[f64]> {
        let array = self.array(name)?;
        if array.shape == shape {
            return Ok(&array.values);
        }
        Err(self.unusable(&format!("{name} has the shape {:?}, expected {shape:?}", array.shape)))
    }

    /// Values along a dimension of any length.
    ///
    /// # Errors
    /// [`Error::File`] if there is no such array, or it has more than one dimension.
    pub fn coordinate(&self, name: &str) -> Result<&[f64]> {
        self.numbers(name, &[self.array(name)?.values.len()])
    }

    /// An array of numbers.
    ///
    /// # Errors
    /// [`Error::File`] if there is none of that name.
    pub fn array(&self, name: &str) -> Result<&StoredArray> {
        self.numbers.get(name).ok_or_else(|| self.unusable(&format!("{name} is missing")))
    }

    /// Words along a dimension of a length.
    ///
    /// # Errors
    /// [`Error::File`] if there are none of that name and number.
    pub fn words(&self, name: &str, length: usize) -> Result<&[String]> {
        let words = self.words.get(name).filter(|words| words.len() == length);
        words.map(Vec::as_slice).ok_or_else(|| self.unusable(&format!("{length} words {name} are missing")))
    }

    /// The error of a file that cannot be used.
    pub fn unusable(&self, why: &str) -> Error {
        let why = format!("{why}; write the file again with the command that wrote it");
        Error::File { path: self.path.clone(), why }
    }
}

/// The root attributes that are texts.
fn attributes(source: &Source, file: &File) -> Result<BTreeMap<String, String>> {
    let names = file.attr_names().map_err(|error| source.damaged("its attributes", &error))?;
    let is_text = |name: &String| {
        file.attr(name).and_then(|attribute| attribute.dtype()).is_ok_and(|kind| kind.is::<VarLenUnicode>())
    };
    let texts = names.into_iter().filter(is_text);
    texts.map(|name| source.text(file, &name).map(|text| (name, text))).collect()
}
