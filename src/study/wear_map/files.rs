//! The files of `fretwear map`: one HDF5 file with everything, and a CSV table of each part.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use super::{Control, Isoline, MapStudy, OptimumCurve};
use crate::data::layout::{Label, label};
use crate::data::{self, Array, ArrayFile, AtomicFile, Coordinate, Format, Mark, cell};
use crate::error::Result;
use crate::scene::MapScene;

const GRADING: Label<'static> = label("grading", "1", "grading k of E = E0 (z/z0)^k");
const AMPLITUDE: Label<'static> =
    label("amplitude_ratio", "1", "tangential amplitude over friction coefficient times indentation");
const OPTIMUM_AMPLITUDE: Label<'static> = label(
    "optimum_amplitude_ratio",
    "1",
    "tangential amplitude over friction coefficient times indentation of the homogeneous contact",
);
const REFERENCE_DEPTH: Label<'static> =
    label("reference_depth", "1", "depth z0 over contact radius of the homogeneous contact");
const PROFILE_GRADING: Label<'static> = label("profile_grading", "1", "grading of the worn profiles");
const PROFILE_RADIUS: Label<'static> =
    label("profile_radius", "1", "radius over (d/(n A))^(1/n), which is sqrt(R d) for a paraboloid");

/// Name of a file, what its first line begins with, and how its text is made.
type Table = (&'static str, &'static str, fn(&MapStudy) -> String);

/// Tables written beside `map.h5`.
const TABLES: [Table; 5] = [
    ("map.csv", "grading,amplitude_ratio,wear_volume,", map_table),
    ("full_sliding.csv", "grading,full_sliding_amplitude_ratio\n", full_sliding_table),
    ("isolines.csv", "form,line,wear_volume_ratio,", isoline_table),
    ("optimum.csv", "control,reference_depth,amplitude_ratio,", optimum_table),
    ("profiles.csv", "grading,radius,initial_profile,", profile_table),
];

const ARRAYS: &str = "map.h5";

/// Makes the directory if it is missing, and checks that all files can be written there; creates no file.
///
/// # Errors
/// [`Error::File`](crate::Error::File) names the file or the directory and the cure.
pub fn check_folder(folder: &Path, overwrite: bool) -> Result<()> {
    let tables = TABLES.iter().map(|(name, start, _)| (*name, Mark::Words(start)));
    let files: Vec<_> = tables.chain([(ARRAYS, Mark::Results)]).collect();
    data::check_folder(folder, &files, overwrite)
}

/// Writes `map.h5` and the tables `map.csv`, `full_sliding.csv`, `isolines.csv`, `optimum.csv` and `profiles.csv` into a directory that
/// exists, each as a whole or not at all; returns their paths.
///
/// # Errors
/// [`Error::File`](crate::Error::File) names the file and the cure.
pub fn write(scene: &MapScene, study: &MapStudy, folder: &Path, overwrite: bool) -> Result<Vec<PathBuf>> {
    let arrays = folder.join(ARRAYS);
    array_file(scene, study).write(&arrays, overwrite)?;
    let mut written = vec![arrays];
    for (name, _, table) in TABLES {
        let path = folder.join(name);
        AtomicFile::new(&path, overwrite)?.write(table(study).as_bytes())?;
        written.push(path);
    }
    Ok(written)
}

fn array_file(scene: &MapScene, study: &MapStudy) -> ArrayFile {
    let (map, profiles) = (&study.map, &study.profiles);
    let mut file = ArrayFile {
        format: Format::Map,
        attributes: vec![
            ("title", scene.title.clone().unwrap_or_default()),
            ("map", scene.text.clone()),
            ("indenter_exponent", scene.exponent.to_string()),
        ],
        coordinates: vec![],
        arrays: vec![],
        texts: vec![],
    };
    let mut coordinate = |label: Label<'static>, values: &[f64]| {
        file.coordinates.push(Coordinate { label, values: values.to_vec() })
    };
    coordinate(GRADING, &map.gradings);
    coordinate(AMPLITUDE, &map.amplitude_ratios);
    coordinate(OPTIMUM_AMPLITUDE, &scene.optimum_amplitude_ratios);
    coordinate(REFERENCE_DEPTH, &scene.reference_depths);
    coordinate(PROFILE_GRADING, &profiles.gradings);
    coordinate(PROFILE_RADIUS, &profiles.radii);
    let plane = [GRADING.name, AMPLITUDE.name];
    let curves = [PROFILE_GRADING.name, PROFILE_RADIUS.name];
    let mut array = |name, long_name, axes: &[&'static str], values: &[f64]| {
        file.arrays.push(Array {
            label: label(name, "1", long_name),
            axes: axes.to_vec(),
            values: values.to_vec(),
        });
    };
    array(
        "wear_volume",
        "limiting worn volume over pi times squared contact radius of the homogeneous contact times indentation",
        &plane,
        &map.volume,
    );
    array(
        "wear_volume_ratio",
        "limiting worn volume over that of the homogeneous medium",
        &plane,
        &map.ratio,
    );
    array(
        "wear_volume_ratio_small_amplitude",
        "the same for small amplitudes, with the exact stick radius",
        &plane,
        &map.small_amplitude_ratio,
    );
    array(
        "wear_volume_ratio_leading_order",
        "the same for small amplitudes, to leading order throughout",
        &plane,
        &map.leading_order_ratio,
    );
    array(
        "full_sliding_amplitude_ratio",
        "amplitude ratio from which on the whole contact slides",
        &plane[..1],
        &map.full_sliding,
    );
    array("profile_initial", "unworn profile over indentation", &curves[1..], &profiles.initial);
    array("profile_wear_depth", "limiting wear depth over indentation", &curves, &profiles.wear_depth);
    for (name, long_name, values) in [
        ("profile_contact_radius_initial", "first contact radius", &profiles.contact_radius_initial),
        ("profile_stick_radius", "stick radius", &profiles.stick_radius),
        ("profile_contact_radius_limit", "limiting contact radius", &profiles.contact_radius_limit),
    ] {
        array(name, long_name, &curves[..1], values);
    }
    add_optimum(&mut file, &study.optimum);
    add_isolines(
        &mut file,
        &study.isolines,
        ["isoline_vertex", "isoline_number", "isoline_level", "isoline_grading", "isoline_amplitude_ratio"],
    );
    add_isolines(
        &mut file,
        &study.small_amplitude_isolines,
        [
            "small_amplitude_isoline_vertex",
            "small_amplitude_isoline_number",
            "small_amplitude_isoline_level",
            "small_amplitude_isoline_grading",
            "small_amplitude_isoline_amplitude_ratio",
        ],
    );
    file
}

/// Name of a control in the tables.
fn control_name(control: Control) -> &'static str {
    match control {
        Control::Indentation => "indentation",
        Control::Force { .. } => "force",
        Control::ForceDepthOnly { .. } => "force_depth_only",
    }
}

/// Dataset names of the optimum under one control.
fn optimum_names(control: Control) -> [&'static str; 3] {
    match control {
        Control::Indentation => ["optimal_grading", "optimal_wear_volume_ratio", "optimal_indentation_ratio"],
        Control::Force { .. } => {
            ["optimal_grading_force", "optimal_wear_volume_ratio_force", "optimal_indentation_ratio_force"]
        }
        Control::ForceDepthOnly { .. } => [
            "optimal_grading_force_depth_only",
            "optimal_wear_volume_ratio_force_depth_only",
            "optimal_indentation_ratio_force_depth_only",
        ],
    }
}

fn add_optimum(file: &mut ArrayFile, curves: &[OptimumCurve]) {
    const MEANINGS: [&str; 3] = [
        "grading of least wear; 1 and -1 where the least is a limit",
        "least worn volume over that of the homogeneous medium",
        "indentation over that of the homogeneous contact, at the optimum",
    ];
    for kind in ["indentation", "force", "force_depth_only"] {
        let same = || curves.iter().filter(|curve| control_name(curve.control) == kind);
        let Some(first) = same().next() else { continue };
        let axes = match first.control {
            Control::Indentation => vec![OPTIMUM_AMPLITUDE.name],
            _ => vec![REFERENCE_DEPTH.name, OPTIMUM_AMPLITUDE.name],
        };
        let of = |which: usize| {
            let points = same().flat_map(|curve| &curve.points);
            points.map(move |it| [it.grading, it.volume_ratio, it.indentation_ratio][which]).collect()
        };
        for (which, (name, meaning)) in optimum_names(first.control).into_iter().zip(MEANINGS).enumerate() {
            let label = label(name, "1", meaning);
            file.arrays.push(Array { label, axes: axes.clone(), values: of(which) });
        }
    }
}

/// Lines one after the other along one dimension: where the number changes, a new line begins.
fn add_isolines(
    file: &mut ArrayFile,
    lines: &[Isoline],
    [vertex, number, level, grading, amplitude]: [&'static str; 5],
) {
    let points = || {
        (0..).zip(lines).flat_map(|(number, line)| {
            line.points
                .iter()
                .map(move |&[grading, amplitude]| [f64::from(number), line.level, grading, amplitude])
        })
    };
    let count = points().count();
    let values = (0..count).map(|index| index as f64).collect();
    file.coordinates.push(Coordinate { label: label(vertex, "1", "index of the vertex"), values });
    let columns = [
        (number, "number of the line"),
        (level, "worn volume over that of the homogeneous medium"),
        (grading, "grading"),
        (amplitude, "amplitude ratio"),
    ];
    for (column, (name, meaning)) in columns.into_iter().enumerate() {
        let values = points().map(|point| point[column]).collect();
        file.arrays.push(Array { label: label(name, "1", meaning), axes: vec![vertex], values });
    }
}

fn line(table: &mut String, cells: &[f64]) {
    let cells: Vec<String> = cells.iter().copied().map(cell).collect();
    // Writing to a string cannot fail.
    let _ = writeln!(table, "{}", cells.join(","));
}

fn map_table(study: &MapStudy) -> String {
    let map = &study.map;
    let mut table = String::from(
        "grading,amplitude_ratio,wear_volume,wear_volume_ratio,wear_volume_ratio_small_amplitude,wear_volume_ratio_leading_order\n",
    );
    let points = map.gradings.iter().flat_map(|k| map.amplitude_ratios.iter().map(move |u| (*k, *u)));
    for (index, (grading, amplitude)) in points.enumerate() {
        let values = [&map.volume, &map.ratio, &map.small_amplitude_ratio, &map.leading_order_ratio];
        let [volume, ratio, small, leading] = values.map(|values| values[index]);
        line(&mut table, &[grading, amplitude, volume, ratio, small, leading]);
    }
    table
}

fn full_sliding_table(study: &MapStudy) -> String {
    let mut table = String::from("grading,full_sliding_amplitude_ratio\n");
    for (grading, amplitude) in study.map.gradings.iter().zip(&study.map.full_sliding) {
        line(&mut table, &[*grading, *amplitude]);
    }
    table
}

fn isoline_table(study: &MapStudy) -> String {
    let mut table = String::from("form,line,wear_volume_ratio,grading,amplitude_ratio\n");
    for (form, lines) in [("exact", &study.isolines), ("small_amplitude", &study.small_amplitude_isolines)] {
        for (number, isoline) in lines.iter().enumerate() {
            for [grading, amplitude] in &isoline.points {
                let _ = write!(table, "{form},{number},");
                line(&mut table, &[isoline.level, *grading, *amplitude]);
            }
        }
    }
    table
}

fn optimum_table(study: &MapStudy) -> String {
    let mut table = String::from(
        "control,reference_depth,amplitude_ratio,least_at,grading,wear_volume_ratio,indentation_ratio\n",
    );
    for curve in &study.optimum {
        let depth = match curve.control {
            Control::Indentation => f64::NAN,
            Control::Force { reference_depth } | Control::ForceDepthOnly { reference_depth } => {
                reference_depth
            }
        };
        for point in &curve.points {
            let _ = write!(
                table,
                "{},{},{},{},",
                control_name(curve.control),
                cell(depth),
                cell(point.amplitude_ratio),
                point.end.name()
            );
            line(&mut table, &[point.grading, point.volume_ratio, point.indentation_ratio]);
        }
    }
    table
}

fn profile_table(study: &MapStudy) -> String {
    let profiles = &study.profiles;
    let mut table = String::from("grading,radius,initial_profile,wear_depth,limit_profile\n");
    for (row, grading) in profiles.gradings.iter().enumerate() {
        let depths = &profiles.wear_depth[row * profiles.radii.len()..];
        for ((radius, initial), depth) in profiles.radii.iter().zip(&profiles.initial).zip(depths) {
            line(&mut table, &[*grading, *radius, *initial, *depth, initial + depth]);
        }
    }
    table
}
