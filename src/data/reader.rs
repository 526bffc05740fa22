//! Reading HDF5 files of labelled arrays; nothing in a file is trusted.

use std::path::PathBuf;

use hdf5::types::{TypeDescriptor, VarLenUnicode};
use hdf5::{Dataset as StoredDataset, File, Group, H5Type, IndexType, IterationOrder, Location};

use super::Format;
use super::dataset::{self, Attribute, Dataset, Values, Variable, WRITE_AGAIN, Words, text};
use super::labelled::{is_dimension, runs_along};
use super::seal::ResultPath;
use crate::error::{Error, Result};

/// Deflate cannot do better than this, so a dataset that claims more values than this per stored byte is not genuine.
const LARGEST_COMPRESSION: u64 = 1032;

/// Groups within groups of the files of this program: `/runs/0/checkpoint/past/linearised`.
const DEEPEST: usize = 5;

/// Attributes by which HDF5 ties variables to dimensions.
const TIES: [&str; 4] = ["CLASS", "NAME", "REFERENCE_LIST", "DIMENSION_LIST"];

/// A result file that is open, and its name in errors.
#[derive(Debug)]
pub(super) struct OpenFile {
    path: PathBuf,
    pub file: File,
}

/// How much of a file is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Wanted {
    /// All there is.
    Everything,
    /// No values.
    Labels,
    /// No names of dimensions, which take longer than the values of a run.
    Values,
}

impl OpenFile {
    /// Opens an HDF5 file for reading, the one way to the library: what is damaged does not get there.
    pub(super) fn new<'a>(file: impl Into<ResultPath<'a>>) -> Result<Self> {
        let path = file.into().ready()?.path();
        // No lock is needed: a file is replaced as a whole, so what is opened here never changes.
        let file = File::with_options().with_fapl(|access| access.file_locking(false)).open(path);
        let file = file.map_err(|error| Error::File {
            path: path.to_owned(),
            why: format!("is damaged or cut short ({error}); {WRITE_AGAIN}"),
        })?;
        Ok(Self { path: path.to_owned(), file })
    }

    pub(super) fn error(&self, why: String) -> Error {
        Error::File { path: self.path.clone(), why }
    }

    pub(super) fn damaged(&self, what: &str, why: &dyn std::fmt::Display) -> Error {
        dataset::damaged(&self.path, what, why)
    }

    /// What the attribute `format` tells; none if there is none, or one of another program.
    pub(super) fn format(&self, group: &Group) -> Result<Option<Format>> {
        match group.attr("format") {
            Ok(_) => self.text(group, "format").map(|name| Format::from_name(&name)),
            Err(_) => Ok(None),
        }
    }

    /// Refuses what is of another format or version; the cure says what to give instead.
    pub(super) fn check_format(&self, group: &Group, format: Format, cure: &str) -> Result<()> {
        if self.format(group)? != Some(format) {
            let name = format.name();
            let why = format!("is an HDF5 file, but has no attribute format = \"{name}\"; {cure}");
            return Err(self.error(why));
        }
        match self.integer::<i32>(group, "format_version")? {
            found if found == format.version() => Ok(()),
            other => Err(self.error(format!(
                "has format_version {other}, this program reads {}; use the fretwear that wrote it",
                format.version()
            ))),
        }
    }

    pub(super) fn text(&self, place: &Location, name: &str) -> Result<String> {
        let what = format!("attribute {name}");
        let attribute = place.attr(name).map_err(|error| self.damaged(&what, &error))?;
        if !attribute.dtype().is_ok_and(|kind| kind.is::<VarLenUnicode>()) {
            return Err(self.damaged(&what, &"is not UTF-8 text of variable length"));
        }
        let text = attribute.read_scalar::<VarLenUnicode>().map_err(|error| self.damaged(&what, &error))?;
        String::from_utf8(text.as_bytes().to_vec()).map_err(|error| self.damaged(&what, &error))
    }

    /// A whole number that is an attribute.
    pub(super) fn integer<T: H5Type>(&self, group: &Group, name: &str) -> Result<T> {
        let attribute = group.attr(name).and_then(|attribute| attribute.read_scalar());
        attribute.map_err(|error| self.damaged(&format!("attribute {name}"), &error))
    }

    /// Names of the members of a group in the order of creation, in which what belongs together stands together.
    pub(super) fn members(&self, group: &Group) -> Result<Vec<String>> {
        let names = group.member_names_by(IndexType::CreationOrder, IterationOrder::Increasing);
        let names = names.or_else(|_| group.member_names());
        names.map_err(|error| self.damaged(&format!("members of {}", group.name()), &error))
    }

    /// All of a group that is of this program, but for some of its members.
    pub(super) fn dataset(&self, group: &Group, wanted: Wanted, without: &[&str]) -> Result<Dataset> {
        self.read(group, wanted, without, &mut vec![])
    }

    /// As [`OpenFile::dataset`]; `known` are the dimensions of the groups around it.
    fn read(
        &self,
        group: &Group,
        wanted: Wanted,
        without: &[&str],
        known: &mut Vec<(String, StoredDataset)>,
    ) -> Result<Dataset> {
        let place = group.name().trim_end_matches('/').to_owned();
        let attributes = attributes_of(group);
        let mut read = Dataset { attributes, origin: (self.path.clone(), place), ..Dataset::default() };
        if read.origin.1.matches('/').count() > DEEPEST {
            return Err(self.damaged(&read.origin.1, &"lies in more groups than this program makes"));
        }
        let around = known.len();
        let (mut groups, mut stored) = (vec![], vec![]);
        for name in self.members(group)?.into_iter().filter(|name| !without.contains(&name.as_str())) {
            let Err(error) = group.dataset(&name).map(|found| stored.push((name.clone(), found))) else {
                continue;
            };
            match group.group(&name) {
                Ok(inner) => groups.push((name, inner)),
                Err(_) => read.unusable.push((name, error.to_string())),
            }
        }
        if wanted != Wanted::Values {
            known.extend(stored.iter().filter(|(_, found)| is_dimension(found)).cloned());
        }
        for (name, found) in stored {
            match variable(&name, &found, wanted) {
                Ok((mut variable, why)) => {
                    if wanted != Wanted::Values {
                        variable.dimensions = dimensions_of(&found, &variable.shape, known);
                    }
                    read.add(variable);
                    read.unusable.extend(why.map(|why| (name, why)));
                }
                Err(why) => read.unusable.push((name, why)),
            }
        }
        for (name, inner) in groups {
            let inner = self.read(&inner, wanted, without, known)?;
            read.groups.push((name, inner));
        }
        known.truncate(around);
        Ok(read)
    }
}

impl Dataset {
    /// Reads what a study wrote, in one of its formats.
    ///
    /// # Errors
    /// [`Error::File`] names the file, what in it cannot be used, and the cure.
    pub fn read<'a>(file: impl Into<ResultPath<'a>>, format: Format) -> Result<Self> {
        let open = OpenFile::new(file)?;
        open.check_format(&open.file, format, "give the file that the program wrote")?;
        ["title", "program_version"].iter().try_for_each(|name| open.text(&open.file, name).map(drop))?;
        open.dataset(&open.file, Wanted::Everything, &[])
    }
}

/// What a result file of any kind is of.
///
/// # Errors
/// [`Error::File`] if it is no HDF5 file, is damaged or was not written by this program.
pub fn format_of<'a>(file: impl Into<ResultPath<'a>>) -> Result<Format> {
    let open = OpenFile::new(file)?;
    open.format(&open.file)?.ok_or_else(|| {
        let why = "is an HDF5 file, but not one of this program; give a result file that fretwear wrote";
        open.error(why.into())
    })
}

/// The attributes that can be read, but for the ties between variables and dimensions.
fn attributes_of(place: &Location) -> Vec<(String, Attribute)> {
    let read = |name: &String| {
        let attribute = place.attr(name).ok().filter(|it| it.is_scalar())?;
        match attribute.dtype().and_then(|kind| kind.to_descriptor()).ok()? {
            TypeDescriptor::VarLenUnicode => {
                let words = attribute.read_scalar::<VarLenUnicode>().ok()?;
                String::from_utf8(words.as_bytes().to_vec()).ok().map(text)
            }
            TypeDescriptor::Float(_) => attribute.read_scalar().ok().map(Attribute::Real),
            _ => None,
        }
    };
    let names = place.attr_names().unwrap_or_default();
    let own = names.into_iter().filter(|name| !TIES.contains(&name.as_str()));
    own.filter_map(|name| read(&name).map(|attribute| (name, attribute))).collect()
}

/// A variable without the names of its dimensions; why it has no values, if they cannot be read.
pub(super) fn variable(
    name: &str,
    stored: &StoredDataset,
    wanted: Wanted,
) -> std::result::Result<(Variable, Option<String>), String> {
    let mut attributes = attributes_of(stored);
    let mut said = |name: &str| {
        let place = attributes.iter().position(|(other, _)| other == name)?;
        if let Attribute::Text(words) = attributes.remove(place).1 { Some(words) } else { None }
    };
    let (units, long_name) =
        (said("units").unwrap_or_else(|| "1".into()), said("long_name").unwrap_or_default());
    let shape = stored.get_shape().map_err(|error| error.to_string())?;
    let (values, why) = match wanted {
        Wanted::Labels => (Values::Foreign, None),
        _ => values_of(stored, &shape)?,
    };
    let name = name.to_owned();
    let dimensions = vec![];
    Ok((Variable { name, units, long_name, dimensions, shape, unlimited: false, attributes, values }, why))
}

/// The dimension of each axis; empty where there is none as long as it.
fn dimensions_of(stored: &StoredDataset, shape: &[usize], known: &[(String, StoredDataset)]) -> Vec<String> {
    let along = |(axis, length): (usize, &usize)| {
        let runs = |(name, scale): &&(String, StoredDataset)| {
            let itself = stored.name() == scale.name() && stored.name().ends_with(name.as_str());
            scale.size() == *length && (itself || runs_along(stored, axis, scale))
        };
        known.iter().rev().find(runs).map_or_else(String::new, |(name, _)| name.clone())
    };
    shape.iter().enumerate().map(along).collect()
}

/// The values; none of them, and why, if they cannot be read.
fn values_of(
    stored: &StoredDataset,
    shape: &[usize],
) -> std::result::Result<(Values, Option<String>), String> {
    fn of<T: H5Type, V: Into<Values> + FromIterator<T>>(
        stored: &StoredDataset,
        shape: &[usize],
    ) -> (Values, Option<String>) {
        match read::<T>(stored, shape) {
            Ok(values) => (values.into_iter().collect::<V>().into(), None),
            Err(why) => (V::from_iter([]).into(), Some(why)),
        }
    }
    let kind = stored.dtype().map_err(|error| error.to_string())?;
    Ok(if kind.is::<f64>() {
        of::<f64, Vec<_>>(stored, shape)
    } else if kind.is::<i64>() {
        of::<i64, Vec<_>>(stored, shape)
    } else if kind.is::<u64>() {
        of::<u64, Vec<_>>(stored, shape)
    } else if kind.is::<i32>() {
        of::<i32, Vec<_>>(stored, shape)
    } else if kind.is::<VarLenUnicode>() {
        of::<VarLenUnicode, Words>(stored, shape)
    } else {
        (Values::Foreign, None)
    })
}

impl FromIterator<VarLenUnicode> for Words {
    /// The library vouches for no text, so a sign stands for what is not UTF-8.
    fn from_iter<I: IntoIterator<Item = VarLenUnicode>>(words: I) -> Self {
        let mut found = Self::default();
        words.into_iter().for_each(|word| found.push(&String::from_utf8_lossy(word.as_bytes())));
        found
    }
}

/// All values in row-major order, if the file can hold so many.
fn read<T: H5Type>(stored: &StoredDataset, shape: &[usize]) -> std::result::Result<Vec<T>, String> {
    let product =
        |lengths: &[usize]| lengths.iter().try_fold(1usize, |product, length| product.checked_mul(*length));
    let chunk = product(&stored.chunk().unwrap_or_default());
    let room = stored.storage_size().saturating_mul(LARGEST_COMPRESSION) / size_of::<T>() as u64;
    let count = match (product(shape), chunk) {
        (Some(0), _) => 0,
        (Some(count), Some(chunk)) if count.max(chunk) as u64 <= room => count,
        _ => {
            let stored = stored.storage_size();
            return Err(format!("claims the shape {shape:?}, but only {stored} bytes are stored"));
        }
    };
    let values = stored.read_raw().map_err(|error| error.to_string())?;
    if values.len() == count { Ok(values) } else { Err("has no values".into()) }
}
