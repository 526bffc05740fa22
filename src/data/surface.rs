//! A surface that changes with time, in VTK's HDF5 format, which programs built on VTK open, ParaView and PyVista among them.

use std::path::Path;

use hdf5::types::FixedAscii;
use hdf5::{File, Group, H5Type, Result as Hdf5Result};

use super::atomic::AtomicFile;
use super::labelled::{create_group, laid_out};
use crate::error::Result;

/// Points that move, polygons between them that stay, and values at the points.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SurfaceSeries {
    /// Value of the time of each step; ParaView shows it as it is.
    pub times: Vec<f64>,
    /// Coordinates x, y, z, m, shape `(time, point, 3)`.
    pub points: Vec<f64>,
    /// Points of one polygon after the other.
    pub connectivity: Vec<i64>,
    /// Where each polygon begins in them, and where the last one ends.
    pub offsets: Vec<i64>,
    /// Name and values, shape `(time, point)`, of what is known at the points.
    pub values: Vec<(&'static str, Vec<f64>)>,
}

impl SurfaceSeries {
    /// Number of points at each time.
    pub fn points_per_step(&self) -> usize {
        self.points.len() / 3 / self.times.len().max(1)
    }

    /// Writes the file, as a whole or not at all.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) if the file exists and `overwrite` is not given, or cannot be written.
    ///
    /// # Panics
    /// If lengths of points and values do not fit the number of times.
    pub fn write(&self, path: &Path, overwrite: bool) -> Result<()> {
        let count = self.times.len() * self.points_per_step();
        assert!(self.points.len() == 3 * count, "{} coordinates of {count} points", self.points.len());
        for (name, values) in &self.values {
            assert_eq!(values.len(), count, "values of {name}");
        }
        let mut file = AtomicFile::new(path, overwrite)?;
        file.write(&laid_out(path, |file| self.put_into(file))?)
    }

    fn put_into(&self, file: &File) -> Hdf5Result<()> {
        let root = create_group(file, "VTKHDF")?;
        root.new_attr::<i64>().shape(2).create("Version")?.write_raw(&[2i64, 0])?;
        // VTK reads a string of fixed length only.
        let kind = FixedAscii::<8>::from_ascii("PolyData").map_err(|error| error.to_string())?;
        root.new_attr::<FixedAscii<8>>().create("Type")?.write_scalar(&kind)?;
        let (steps, points) = (self.times.len(), self.points_per_step());
        put(&root, "NumberOfPoints", &[1], &[points as i64])?;
        put(&root, "Points", &[steps * points, 3], &self.points)?;
        put_cells(&root, "Polygons", &self.connectivity, &self.offsets)?;
        for name in ["Vertices", "Lines", "Strips"] {
            put_cells(&root, name, &[], &[0])?;
        }
        let data = create_group(&root, "PointData")?;
        for (name, values) in &self.values {
            put(&data, name, &[steps * points], values)?;
        }
        self.put_steps(&root)
    }

    /// Where the points and values of each step begin; the polygons are those of the one part that there is.
    fn put_steps(&self, root: &Group) -> Hdf5Result<()> {
        let count = self.times.len();
        let steps = create_group(root, "Steps")?;
        steps.new_attr::<i64>().create("NSteps")?.write_scalar(&(count as i64))?;
        let starts: Vec<i64> = (0..count).map(|step| (step * self.points_per_step()) as i64).collect();
        put(&steps, "Values", &[count], &self.times)?;
        put(&steps, "PointOffsets", &[count], &starts)?;
        put(&steps, "NumberOfParts", &[count], &vec![1i64; count])?;
        put(&steps, "PartOffsets", &[count], &vec![0i64; count])?;
        // Vertices, lines, polygons and strips.
        put(&steps, "CellOffsets", &[count, 4], &vec![0i64; 4 * count])?;
        put(&steps, "ConnectivityIdOffsets", &[count, 4], &vec![0i64; 4 * count])?;
        let data = create_group(&steps, "PointDataOffsets")?;
        self.values.iter().try_for_each(|(name, _)| put(&data, name, &[count], &starts))
    }
}

fn put_cells(root: &Group, name: &str, connectivity: &[i64], offsets: &[i64]) -> Hdf5Result<()> {
    let group = create_group(root, name)?;
    put(&group, "NumberOfCells", &[1], &[offsets.len() as i64 - 1])?;
    put(&group, "NumberOfConnectivityIds", &[1], &[connectivity.len() as i64])?;
    put(&group, "Connectivity", &[connectivity.len()], connectivity)?;
    put(&group, "Offsets", &[offsets.len()], offsets)
}

fn put<T: H5Type>(group: &Group, name: &str, shape: &[usize], values: &[T]) -> Hdf5Result<()> {
    let builder = group.new_dataset::<T>().obj_track_times(false).no_chunk();
    builder.shape(shape).create(name)?.write_raw(values)
}
