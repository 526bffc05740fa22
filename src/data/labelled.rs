//! HDF5 files of labelled arrays, valid as netCDF-4: every dataset has units, a meaning and dimension scales.

use std::ffi::{CStr, c_char, c_uint};
use std::path::Path;
use std::str::FromStr;

use hdf5::file::{AttrCreationOrder, LibraryVersion, LinkCreationOrder};
use hdf5::types::VarLenUnicode;
use hdf5::{Dataset as StoredDataset, Extent, File, FileBuilder, Group, H5Type, Location, Result};
use hdf5_sys::h5i::hid_t;

use super::dataset::{Attribute, Dataset, Values, Variable, text};
use crate::error::Error;

/// Chunks hold at most this many values (1 MiB), the size of HDF5's chunk cache.
const CHUNK_VALUES: usize = 1 << 17;

// Dimension scales belong to HDF5's high-level library, which the hdf5 crate does not declare.
unsafe extern "C" {
    fn H5DSset_scale(scale: hid_t, name: *const c_char) -> i32;
    fn H5DSattach_scale(dataset: hid_t, scale: hid_t, axis: c_uint) -> i32;
    fn H5DSis_scale(dataset: hid_t) -> i32;
    fn H5DSis_attached(dataset: hid_t, scale: hid_t, axis: c_uint) -> i32;
}

/// Whether a dataset is a dimension.
pub(super) fn is_dimension(dataset: &StoredDataset) -> bool {
    // SAFETY: under the library's lock, with an open dataset.
    hdf5::sync::sync(|| unsafe { H5DSis_scale(dataset.id()) }) > 0
}

/// Whether an axis of a dataset runs along a dimension.
pub(super) fn runs_along(dataset: &StoredDataset, axis: usize, dimension: &StoredDataset) -> bool {
    let Ok(axis) = c_uint::try_from(axis) else { return false };
    // SAFETY: under the library's lock, with two open datasets of one file; an axis that is not there is an error, which is below zero.
    hdf5::sync::sync(|| unsafe { H5DSis_attached(dataset.id(), dimension.id(), axis) }) > 0
}

/// A dimension that variables name as the scale of an axis.
struct Dimension {
    name: String,
    scale: StoredDataset,
    resizable: bool,
}

/// The bytes of a file that is laid out in memory.
///
/// # Errors
/// [`Error::File`] names `path`, where they are to be written.
pub(super) fn laid_out(path: &Path, put: impl FnOnce(&File) -> Result<()>) -> crate::error::Result<Vec<u8>> {
    // One lock for the whole file: files in memory of two threads must not exist side by side under one name.
    let bytes = hdf5::sync::sync(|| {
        let file = file_in_memory()?;
        put(&file)?;
        bytes_of(&file)
    });
    bytes.map_err(|error| Error::File {
        path: path.to_owned(),
        why: format!("the HDF5 library could not lay out the file: {error}"),
    })
}

/// A new file in memory; nothing is on disk until its bytes are written.
///
/// The format is the earliest one that serves, which every reader in use knows: HDF5 1.8, with the order of creation
/// kept, as netCDF-4 asks. The superblock of later formats has a checksum that HDF5 1.10 gets wrong in the image of a
/// file. Small nodes of the chunk index take 25 kB off a run, whose datasets mostly are one chunk each; deflate was
/// left out because it saved no more than a fifth of the size and took as long as the rest of a save.
fn file_in_memory() -> Result<File> {
    options()
        .with_fapl(|access| access.core_options(1 << 16, false))
        // The library looks for a file of this name before it starts a new one: there can be none below a device.
        .create("/dev/null/in-memory")
}

/// A new file of the same format on the disk, for contents too large to be in memory twice; the file of that name is overwritten.
pub(super) fn file_on_disk(path: &Path) -> Result<File> {
    // Whoever made the temporary holds the lock.
    options().with_fapl(|access| access.file_locking(false)).create(path)
}

fn options() -> FileBuilder {
    let mut options = File::with_options();
    options
        .with_fapl(|access| access.libver_bounds(LibraryVersion::Earliest, LibraryVersion::V18))
        .with_fcpl(|creation| {
            creation
                .istore_k(4)
                .link_creation_order(LinkCreationOrder::Indexed)
                .attr_creation_order(AttrCreationOrder::Indexed)
                .obj_track_times(false)
        });
    options
}

/// The bytes of a file, as they belong on disk.
fn bytes_of(file: &File) -> Result<Vec<u8>> {
    use hdf5_sys::h5f::H5Fget_file_image;
    file.flush()?;
    hdf5::sync::sync(|| {
        // SAFETY: the identifier is that of an open file; a null buffer asks for the size only.
        let size = unsafe { H5Fget_file_image(file.id(), std::ptr::null_mut(), 0) };
        let mut bytes =
            vec![0u8; usize::try_from(size).map_err(|_| "the size of the file image is unknown")?];
        // SAFETY: the buffer has the length that is passed, and the file has not changed since it was asked for.
        let written = unsafe { H5Fget_file_image(file.id(), bytes.as_mut_ptr().cast(), bytes.len()) };
        if written == size { Ok(bytes) } else { Err("the file image could not be taken".into()) }
    })
}

/// Creates a group whose members keep their order.
pub(super) fn create_group(parent: &Group, name: &str) -> Result<Group> {
    let builder = parent.create_group_builder().obj_track_times(false);
    builder.with_gcpl(|creation| creation.link_creation_order(LinkCreationOrder::Indexed)).create(name)
}

/// Writes a dataset with all the groups in it into a group. The same dataset gives the same bytes: no times of creation are stored.
pub(super) fn put_dataset(group: &Group, dataset: &Dataset) -> Result<()> {
    put_within(group, dataset, &mut vec![])
}

/// As [`put_dataset`]; `dimensions` are those of the groups around it, and have the own ones added.
fn put_within(group: &Group, dataset: &Dataset, dimensions: &mut Vec<Dimension>) -> Result<()> {
    let around = dimensions.len();
    for (name, attribute) in &dataset.attributes {
        put_attribute(group, name, attribute)?;
    }
    for variable in &dataset.variables {
        if let Some(dimension) = put_variable(group, variable, dimensions)? {
            dimensions.push(dimension);
        }
    }
    for (name, inner) in &dataset.groups {
        put_within(&create_group(group, name)?, inner, dimensions)?;
    }
    dimensions.truncate(around);
    Ok(())
}

/// Writes an attribute; texts are UTF-8 of variable length, which has no upper limit and h5py gives back as `str`.
pub(super) fn put_attribute(place: &Location, name: &str, attribute: &Attribute) -> Result<()> {
    match attribute {
        Attribute::Text(text) => {
            let text = VarLenUnicode::from_str(text).map_err(|error| format!("attribute {name}: {error}"))?;
            place.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&text)
        }
        Attribute::Integer(value) => place.new_attr::<i32>().create(name)?.write_scalar(value),
        Attribute::Count(value) => place.new_attr::<u64>().create(name)?.write_scalar(value),
        Attribute::Real(value) => place.new_attr::<f64>().create(name)?.write_scalar(value),
        Attribute::Integers(values) => {
            place.new_attr::<i32>().shape(values.len()).create(name)?.write_raw(values)
        }
    }
}

/// Writes a variable along dimensions that are there, the innermost of a name if there are more; a coordinate is a new one.
fn put_variable(group: &Group, variable: &Variable, dimensions: &[Dimension]) -> Result<Option<Dimension>> {
    match &variable.values {
        Values::Numbers(values) => put_values(group, variable, dimensions, values),
        Values::Indices(values) => put_values(group, variable, dimensions, values),
        Values::Counts(values) => put_values(group, variable, dimensions, values),
        Values::Flags(values) => put_values(group, variable, dimensions, values),
        Values::Texts(words) => {
            // HDF5 would end a text at a NUL.
            let unicode = |word: &str| VarLenUnicode::from_str(&word.replace('\0', "\u{fffd}"));
            let texts: std::result::Result<Vec<_>, _> = words.iter().map(unicode).collect();
            put_values(group, variable, dimensions, &texts.map_err(|error| error.to_string())?)
        }
        Values::Foreign => Err(format!("{} holds no values of this program", variable.name).into()),
    }
}

fn put_values<T: H5Type>(
    group: &Group,
    variable: &Variable,
    dimensions: &[Dimension],
    values: &[T],
) -> Result<Option<Dimension>> {
    let name = variable.name.as_str();
    let is_coordinate = variable.is_coordinate();
    let along = |axis: &String| {
        let found = dimensions.iter().rev().find(|it| it.name == *axis);
        found.unwrap_or_else(|| panic!("{name} runs along {axis}, which is no coordinate"))
    };
    let axes: Vec<&Dimension> =
        if is_coordinate { vec![] } else { variable.dimensions.iter().map(along).collect() };
    let grows = |axis: usize| axes.get(axis).map_or(variable.unlimited, |it| it.resizable);
    let extent = |(axis, length): (usize, &usize)| match grows(axis) {
        true => Extent::resizable(*length),
        false => Extent::fixed(*length),
    };
    let extents: Vec<Extent> = variable.shape.iter().enumerate().map(extent).collect();
    let builder = group.new_dataset::<T>().obj_track_times(false);
    let dataset = match variable.shape.len() {
        0 => builder.create(name)?,
        count if (0..count).any(grows) => {
            builder.chunk(chunk_shape(&variable.shape)).shape(extents).create(name)?
        }
        _ => builder.no_chunk().shape(extents).create(name)?,
    };
    dataset.write_raw(values)?;
    put_attribute(&dataset, "units", &text(&variable.units))?;
    put_attribute(&dataset, "long_name", &text(&variable.long_name))?;
    if is_coordinate {
        let ended = format!("{name}\0");
        let ended = CStr::from_bytes_with_nul(ended.as_bytes()).map_err(|error| error.to_string())?;
        // SAFETY: under the library's lock, with an open dataset and a string that ends in NUL.
        check(hdf5::sync::sync(|| unsafe { H5DSset_scale(dataset.id(), ended.as_ptr()) }), name)?;
    }
    for (position, axis) in (0..).zip(&axes) {
        // SAFETY: under the library's lock, with two open datasets of one file and an axis that the first one has.
        let status =
            hdf5::sync::sync(|| unsafe { H5DSattach_scale(dataset.id(), axis.scale.id(), position) });
        check(status, name)?;
    }
    for (name, attribute) in &variable.attributes {
        put_attribute(&dataset, name, attribute)?;
    }
    let (name, resizable) = (name.to_owned(), variable.unlimited);
    Ok(is_coordinate.then_some(Dimension { name, scale: dataset, resizable }))
}

/// The whole array where it fits, else whole rows, else parts of a row.
fn chunk_shape(lengths: &[usize]) -> Vec<usize> {
    let mut room = CHUNK_VALUES;
    let mut shape: Vec<usize> = lengths
        .iter()
        .rev()
        .map(|length| {
            let length = (*length).clamp(1, room);
            room /= length;
            length
        })
        .collect();
    shape.reverse();
    shape
}

fn check(status: i32, name: &str) -> Result<()> {
    if status < 0 {
        Err(format!("the dimension scales of {name} could not be written").into())
    } else {
        Ok(())
    }
}
