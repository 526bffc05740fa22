//! HDF5 files of labelled arrays, valid as netCDF-4: every dataset has units, a meaning and dimension scales.

use std::ffi::{CStr, c_char, c_uint};
use std::path::Path;
use std::str::FromStr;

use hdf5::file::{AttrCreationOrder, LibraryVersion, LinkCreationOrder};
use hdf5::types::VarLenUnicode;
use hdf5::{Dataset, Extent, File, FileBuilder, Group, H5Type, Location, Result};
use hdf5_sys::h5i::hid_t;

use super::layout::Label;
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
pub(super) fn is_dimension(dataset: &Dataset) -> bool {
    // SAFETY: under the library's lock, with an open dataset.
    hdf5::sync::sync(|| unsafe { H5DSis_scale(dataset.id()) }) > 0
}

/// Whether an axis of a dataset runs along a dimension.
pub(super) fn runs_along(dataset: &Dataset, axis: usize, dimension: &Dataset) -> bool {
    let Ok(axis) = c_uint::try_from(axis) else { return false };
    // SAFETY: under the library's lock, with two open datasets of one file; an axis that is not there is an error, which is below zero.
    hdf5::sync::sync(|| unsafe { H5DSis_attached(dataset.id(), dimension.id(), axis) }) > 0
}

/// A dimension: an index coordinate `0, 1, …` that datasets name as the scale of an axis.
pub(super) struct Dimension {
    scale: Dataset,
    length: usize,
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

/// Writes a text attribute: UTF-8 of variable length, which has no upper limit and h5py gives back as `str`.
pub(super) fn put_text(place: &Location, name: &str, text: &str) -> Result<()> {
    let text = VarLenUnicode::from_str(text).map_err(|error| format!("attribute {name}: {error}"))?;
    place.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&text)
}

/// Writes a whole number as an attribute.
pub(super) fn put_integer(place: &Location, name: &str, value: i32) -> Result<()> {
    place.new_attr::<i32>().create(name)?.write_scalar(&value)
}

/// Writes whole numbers as an attribute.
pub(super) fn put_integers(place: &Location, name: &str, values: &[i32]) -> Result<()> {
    place.new_attr::<i32>().shape(values.len()).create(name)?.write_raw(values)
}

/// Writes a real number as an attribute.
pub(super) fn put_real(place: &Location, name: &str, value: f64) -> Result<()> {
    place.new_attr::<f64>().create(name)?.write_scalar(&value)
}

/// Says that what is not a number in a dataset is missing, and why, in the attributes of the CF conventions.
pub(super) fn put_missing(dataset: &Dataset, why: &str) -> Result<()> {
    put_real(dataset, "_FillValue", f64::NAN)?;
    put_text(dataset, "comment", why)
}

impl Dimension {
    /// Creates the index coordinate `0, 1, …` of `length` entries.
    pub(super) fn create(group: &Group, label: Label, length: usize, resizable: bool) -> Result<Self> {
        let index: Vec<i64> = (0..).take(length).collect();
        let builder = group.new_dataset::<i64>().obj_track_times(false);
        let builder =
            if resizable { builder.chunk(length.clamp(1, CHUNK_VALUES)) } else { builder.no_chunk() };
        let extent = if resizable { Extent::resizable(length) } else { Extent::fixed(length) };
        let scale = builder.shape(extent).create(label.name)?;
        scale.write_raw(&index)?;
        Self::with_scale(scale, label, length, resizable)
    }

    /// Creates a coordinate whose values are more than an index.
    pub(super) fn coordinate<T: H5Type>(group: &Group, label: Label, values: &[T]) -> Result<Self> {
        let builder = group.new_dataset::<T>().obj_track_times(false).no_chunk();
        let scale = builder.shape(values.len()).create(label.name)?;
        scale.write_raw(values)?;
        Self::with_scale(scale, label, values.len(), false)
    }

    fn with_scale(scale: Dataset, label: Label, length: usize, resizable: bool) -> Result<Self> {
        put_label(&scale, label)?;
        let name = format!("{}\0", label.name);
        let name = CStr::from_bytes_with_nul(name.as_bytes()).map_err(|error| error.to_string())?;
        // SAFETY: under the library's lock, with an open dataset and a string that ends in NUL.
        check(hdf5::sync::sync(|| unsafe { H5DSset_scale(scale.id(), name.as_ptr()) }), label.name)?;
        Ok(Self { scale, length, resizable })
    }
}

/// Writes one dataset with its label and the scales of its axes; no dimension means a scalar.
///
/// # Panics
/// If the number of values is not the product of the lengths of the dimensions.
pub(super) fn put_array<T: H5Type>(
    group: &Group,
    label: Label,
    axes: &[&Dimension],
    values: &[T],
) -> Result<Dataset> {
    assert_eq!(values.len(), axes.iter().map(|axis| axis.length).product::<usize>(), "{}", label.name);
    let builder = group.new_dataset::<T>().obj_track_times(false);
    let extents: Vec<Extent> = axes
        .iter()
        .map(|axis| if axis.resizable { Extent::resizable(axis.length) } else { Extent::fixed(axis.length) })
        .collect();
    let dataset = match axes {
        [] => builder.create(label.name)?,
        axes if axes.iter().any(|axis| axis.resizable) => {
            builder.chunk(chunk_shape(axes)).shape(extents).create(label.name)?
        }
        _ => builder.no_chunk().shape(extents).create(label.name)?,
    };
    dataset.write_raw(values)?;
    put_label(&dataset, label)?;
    for (position, axis) in (0..).zip(axes) {
        // SAFETY: under the library's lock, with two open datasets of one file and an axis that the first one has.
        let status =
            hdf5::sync::sync(|| unsafe { H5DSattach_scale(dataset.id(), axis.scale.id(), position) });
        check(status, label.name)?;
    }
    Ok(dataset)
}

/// The whole array where it fits, else whole rows, else parts of a row.
fn chunk_shape(axes: &[&Dimension]) -> Vec<usize> {
    let mut room = CHUNK_VALUES;
    let mut shape: Vec<usize> = axes
        .iter()
        .rev()
        .map(|axis| {
            let length = axis.length.clamp(1, room);
            room /= length;
            length
        })
        .collect();
    shape.reverse();
    shape
}

fn put_label(dataset: &Dataset, label: Label) -> Result<()> {
    put_text(dataset, "units", label.units)?;
    put_text(dataset, "long_name", label.long_name)
}

fn check(status: i32, name: &str) -> Result<()> {
    if status < 0 {
        Err(format!("the dimension scales of {name} could not be written").into())
    } else {
        Ok(())
    }
}
