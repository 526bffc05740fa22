//! The files of `fretwear map`: one HDF5 file with everything, and a CSV table of each part.

use std::path::{Path, PathBuf};

use super::{Control, Isoline, MapStudy, OptimumCurve};
use crate::data::quantity::{Quantity, quantity};
use crate::data::{self, AtomicFile, Dataset, Format, Mark, Variable, cell, table};
use crate::error::Result;
use crate::scene::MapScene;

const GRADING: Quantity = quantity("grading", "1", "grading k of E = E0 (z/z0)^k");
const AMPLITUDE: Quantity =
    quantity("amplitude_ratio", "1", "tangential amplitude over friction coefficient times indentation");
const OPTIMUM_AMPLITUDE: Quantity = quantity(
    "optimum_amplitude_ratio",
    "1",
    "tangential amplitude over friction coefficient times indentation of the homogeneous contact",
);
const REFERENCE_DEPTH: Quantity =
    quantity("reference_depth", "1", "depth z0 over contact radius of the homogeneous contact");
const PROFILE_GRADING: Quantity = quantity("profile_grading", "1", "grading of the worn profiles");
const PROFILE_RADIUS: Quantity =
    quantity("profile_radius", "1", "radius over (d/(n A))^(1/n), which is sqrt(R d) for a paraboloid");

/// A table of text.
struct Table {
    file: &'static str,
    /// Names of the columns, by which the file is known too.
    header: &'static str,
    /// The cells of its rows.
    rows: fn(&MapStudy) -> Vec<Vec<String>>,
}

/// Tables written beside `map.h5`.
const TABLES: [Table; 5] = [
    Table {
        file: "map.csv",
        header: "grading,amplitude_ratio,wear_volume,wear_volume_ratio,wear_volume_ratio_small_amplitude,wear_volume_ratio_leading_order",
        rows: map_rows,
    },
    Table {
        file: "full_sliding.csv",
        header: "grading,full_sliding_amplitude_ratio",
        rows: full_sliding_rows,
    },
    Table {
        file: "isolines.csv",
        header: "form,line,wear_volume_ratio,grading,amplitude_ratio",
        rows: isoline_rows,
    },
    Table {
        file: "optimum.csv",
        header: "control,reference_depth,amplitude_ratio,least_at,grading,wear_volume_ratio,indentation_ratio",
        rows: optimum_rows,
    },
    Table {
        file: "profiles.csv",
        header: "grading,radius,initial_profile,wear_depth,limit_profile",
        rows: profile_rows,
    },
];

const ARRAYS: &str = "map.h5";

/// What the names of isolines begin with: of the exact map, and of that for small amplitudes.
const ISOLINES: [&str; 2] = ["isoline", "small_amplitude_isoline"];

/// Makes the directory if it is missing, and checks that all files can be written there; creates no file.
///
/// # Errors
/// [`Error::File`](crate::Error::File) names the file or the directory and the cure.
pub fn check_folder(folder: &Path, overwrite: bool) -> Result<()> {
    let tables = TABLES.iter().map(|it| (it.file, Mark::Words(it.header)));
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
    dataset(scene, study).write(&arrays, overwrite)?;
    let mut written = vec![arrays];
    for Table { file, header, rows } in TABLES {
        let path = folder.join(file);
        let text = table(header.split(','), rows(study).into_iter());
        AtomicFile::new(&path, overwrite)?.write(text.as_bytes())?;
        written.push(path);
    }
    Ok(written)
}

fn dataset(scene: &MapScene, study: &MapStudy) -> Dataset {
    let (map, profiles) = (&study.map, &study.profiles);
    let mut dataset = Dataset::of(
        Format::Map,
        &[
            ("title", scene.title.clone().unwrap_or_default()),
            ("map", scene.text.clone()),
            ("indenter_exponent", scene.exponent.to_string()),
        ],
    );
    // All dimensions come before the first variable.
    for (quantity, values) in [
        (GRADING, &map.gradings),
        (AMPLITUDE, &map.amplitude_ratios),
        (OPTIMUM_AMPLITUDE, &scene.optimum_amplitude_ratios),
        (REFERENCE_DEPTH, &scene.reference_depths),
        (PROFILE_GRADING, &profiles.gradings),
        (PROFILE_RADIUS, &profiles.radii),
    ] {
        dataset.coordinate(quantity, values.clone());
    }
    for (prefix, lines) in ISOLINES.into_iter().zip([&study.isolines, &study.small_amplitude_isolines]) {
        let count = lines.iter().map(|line| line.points.len()).sum();
        let vertices: Vec<f64> = (0..count).map(|index: usize| index as f64).collect();
        dataset.coordinate(quantity(&format!("{prefix}_vertex"), "1", "index of the vertex"), vertices);
    }
    let plane = [(GRADING.name, map.gradings.len()), (AMPLITUDE.name, map.amplitude_ratios.len())];
    let curves =
        [(PROFILE_GRADING.name, profiles.gradings.len()), (PROFILE_RADIUS.name, profiles.radii.len())];
    let mut array = |name, long_name, dimensions: &[(&str, usize)], values: &[f64]| {
        dataset.add(Variable::new(quantity(name, "1", long_name), dimensions, values.to_vec()));
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
    add_optimum(&mut dataset, scene, &study.optimum);
    for (prefix, lines) in ISOLINES.into_iter().zip([&study.isolines, &study.small_amplitude_isolines]) {
        add_isolines(&mut dataset, prefix, lines);
    }
    dataset
}

/// Name of a control in the tables.
fn control_name(control: Control) -> &'static str {
    match control {
        Control::Indentation => "indentation",
        Control::Force { .. } => "force",
        Control::ForceDepthOnly { .. } => "force_depth_only",
    }
}

/// Adds the optimum under each control, by names that end in that of the control unless it is the indentation.
fn add_optimum(dataset: &mut Dataset, scene: &MapScene, curves: &[OptimumCurve]) {
    const NAMES: [(&str, &str); 3] = [
        ("optimal_grading", "grading of least wear; 1 and -1 where the least is a limit"),
        ("optimal_wear_volume_ratio", "least worn volume over that of the homogeneous medium"),
        ("optimal_indentation_ratio", "indentation over that of the homogeneous contact, at the optimum"),
    ];
    let depths = (REFERENCE_DEPTH.name, scene.reference_depths.len());
    let amplitudes = (OPTIMUM_AMPLITUDE.name, scene.optimum_amplitude_ratios.len());
    for (kind, ending) in
        [("indentation", ""), ("force", "_force"), ("force_depth_only", "_force_depth_only")]
    {
        let same = || curves.iter().filter(|curve| control_name(curve.control) == kind);
        if same().next().is_none() {
            continue;
        }
        let dimensions = if ending.is_empty() { vec![amplitudes] } else { vec![depths, amplitudes] };
        for (which, (name, meaning)) in NAMES.into_iter().enumerate() {
            let points = same().flat_map(|curve| &curve.points);
            let values: Vec<f64> =
                points.map(|it| [it.grading, it.volume_ratio, it.indentation_ratio][which]).collect();
            let name = format!("{name}{ending}");
            dataset.add(Variable::new(quantity(&name, "1", meaning), &dimensions, values));
        }
    }
}

/// Adds lines one after the other along one dimension: where the number changes, a new line begins.
fn add_isolines(dataset: &mut Dataset, prefix: &str, lines: &[Isoline]) {
    let points = (0..).zip(lines).flat_map(|(number, line)| {
        let point =
            move |&[grading, amplitude]: &[f64; 2]| [f64::from(number), line.level, grading, amplitude];
        line.points.iter().map(point)
    });
    let points: Vec<[f64; 4]> = points.collect();
    let vertex = format!("{prefix}_vertex");
    let columns = [
        ("number", "number of the line"),
        ("level", "worn volume over that of the homogeneous medium"),
        ("grading", "grading"),
        ("amplitude_ratio", "amplitude ratio"),
    ];
    for (column, (name, meaning)) in columns.into_iter().enumerate() {
        let values: Vec<f64> = points.iter().map(|point| point[column]).collect();
        let name = format!("{prefix}_{name}");
        dataset.add(Variable::new(quantity(&name, "1", meaning), &[(&vertex, points.len())], values));
    }
}

fn cells(values: &[f64]) -> Vec<String> {
    values.iter().copied().map(cell).collect()
}

fn map_rows(study: &MapStudy) -> Vec<Vec<String>> {
    let map = &study.map;
    let values = [&map.volume, &map.ratio, &map.small_amplitude_ratio, &map.leading_order_ratio];
    let points = map.gradings.iter().flat_map(|k| map.amplitude_ratios.iter().map(move |u| [*k, *u]));
    let row = |(index, point): (usize, [f64; 2])| {
        cells(&[point.as_slice(), &values.map(|values| values[index])].concat())
    };
    points.enumerate().map(row).collect()
}

fn full_sliding_rows(study: &MapStudy) -> Vec<Vec<String>> {
    let map = &study.map;
    map.gradings
        .iter()
        .zip(&map.full_sliding)
        .map(|(grading, amplitude)| cells(&[*grading, *amplitude]))
        .collect()
}

fn isoline_rows(study: &MapStudy) -> Vec<Vec<String>> {
    let forms = [("exact", &study.isolines), ("small_amplitude", &study.small_amplitude_isolines)];
    let lines = forms.into_iter().flat_map(|(form, lines)| {
        lines.iter().enumerate().map(move |(number, line)| (vec![form.to_owned(), number.to_string()], line))
    });
    let rows = lines.flat_map(|(line, Isoline { level, points, .. })| {
        points.iter().map(move |[grading, amplitude]| {
            [line.as_slice(), &cells(&[*level, *grading, *amplitude])].concat()
        })
    });
    rows.collect()
}

fn optimum_rows(study: &MapStudy) -> Vec<Vec<String>> {
    let rows = study.optimum.iter().flat_map(|curve| {
        let depth = match curve.control {
            Control::Indentation => f64::NAN,
            Control::Force { reference_depth } | Control::ForceDepthOnly { reference_depth } => {
                reference_depth
            }
        };
        curve.points.iter().map(move |it| {
            let mut row = vec![control_name(curve.control).to_owned()];
            row.extend(cells(&[depth, it.amplitude_ratio]));
            row.push(it.end.name().to_owned());
            row.extend(cells(&[it.grading, it.volume_ratio, it.indentation_ratio]));
            row
        })
    });
    rows.collect()
}

fn profile_rows(study: &MapStudy) -> Vec<Vec<String>> {
    let profiles = &study.profiles;
    let unworn = || profiles.radii.iter().zip(&profiles.initial);
    let points = profiles.gradings.iter().flat_map(|grading| unworn().map(move |point| (grading, point)));
    let row = |((grading, (radius, initial)), depth): ((&f64, (&f64, &f64)), &f64)| {
        cells(&[*grading, *radius, *initial, *depth, initial + depth])
    };
    points.zip(&profiles.wear_depth).map(row).collect()
}
