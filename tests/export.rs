//! Exports: tables that hold every digit, and a surface with the volume that is worn away.

mod support;

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use fretwear::data::{ResultTables, RunFile, SurfaceSeries, SweepFile};
use fretwear::report::export::worn_surface;
use support::command::{done, names, run, text};
use support::results::every_kind;

/// Columns of a CSV table without quotes, by their heads.
fn columns(table: &str) -> HashMap<String, Vec<String>> {
    let mut lines = table.lines();
    let heads: Vec<&str> = lines.next().expect("a head").split(',').collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert!(rows.iter().all(|row| row.len() == heads.len()), "{table}");
    let column = |place: usize| rows.iter().map(|row| row[place].to_owned()).collect();
    heads.iter().enumerate().map(|(place, head)| ((*head).to_owned(), column(place))).collect()
}

fn numbers(columns: &HashMap<String, Vec<String>>, head: &str) -> Vec<f64> {
    let column = columns.get(head).unwrap_or_else(|| panic!("no column {head} in {:?}", columns.keys()));
    column.iter().map(|cell| if cell.is_empty() { f64::NAN } else { cell.parse().unwrap() }).collect()
}

fn same_bits(one: &[f64], other: &[f64]) -> bool {
    one.len() == other.len() && one.iter().zip(other).all(|(one, other)| one.to_bits() == other.to_bits())
}

#[test]
fn tables_of_every_kind_hold_every_digit_under_heads_with_units() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let files = every_kind(folder);
    for file in &files {
        let tables = ResultTables::open(file).unwrap().summaries().unwrap();
        assert!(tables.iter().any(|table| table.name == ResultTables::open(file).unwrap().usual()));
        for table in tables {
            let csv = ResultTables::csv(file, Some(&table.name)).unwrap();
            assert_eq!(csv.lines().count(), table.rows + 1, "{} of {}", table.name, file.display());
        }
    }

    let run = RunFile::open(&files[0]).unwrap();
    let time = columns(&done(folder, &["export", "paraboloid.h5"]));
    let volumes: Vec<f64> = run.snapshots.iter().map(|it| it.wear_volume).collect();
    assert!(same_bits(&numbers(&time, "wear_volume [m3]"), &volumes));
    assert!(time["regime"].iter().all(|word| word == "partial-slip"));

    done(folder, &["export", "paraboloid.h5", "--table", "time,node", "-o", "curves.csv"]);
    let curves = columns(&fs::read_to_string(folder.join("curves.csv")).unwrap());
    let of_all = |of: fn(&fretwear::data::Snapshot) -> &Vec<f64>| -> Vec<f64> {
        run.snapshots.iter().flat_map(of).copied().collect()
    };
    assert!(same_bits(&numbers(&curves, "wear_depth [m]"), &of_all(|it| &it.wear_depth)));
    assert!(same_bits(&numbers(&curves, "pressure [Pa]"), &of_all(|it| &it.pressure)));
    let radii: Vec<f64> = run.snapshots.iter().flat_map(|_| &run.header.radius).copied().collect();
    assert!(same_bits(&numbers(&curves, "radius [m]"), &radii));
    let cycles: Vec<f64> =
        run.snapshots.iter().flat_map(|it| vec![it.cycles; run.header.radius.len()]).collect();
    assert!(same_bits(&numbers(&curves, "cycles"), &cycles));

    let sweep = SweepFile::read(&folder.join("merged.h5")).unwrap();
    let rows = columns(&done(folder, &["export", "merged.h5"]));
    assert_eq!(numbers(&rows, "scene"), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    let fretwear::data::Values::Numbers(volumes) =
        &sweep.columns.iter().find(|it| it.name == "wear_volume").unwrap().values
    else {
        panic!("volumes are numbers")
    };
    assert!(same_bits(&numbers(&rows, "wear_volume [m3]"), volumes));
    // A run that is not the first of those kept.
    let kept = columns(&done(folder, &["export", "merged.h5", "--table", "runs/4/time"]));
    assert_eq!(numbers(&kept, "wear_volume [m3]").last(), Some(&volumes[4]));
}

#[test]
fn what_cannot_be_exported_is_refused_with_exit_code_2_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    done(folder, &["map", "-o", "map"]);
    fs::write(folder.join("there.csv"), "mine").unwrap();
    fs::write(folder.join("foreign.h5"), "no HDF5").unwrap();
    let before = names(folder);
    for (arguments, words) in [
        (&["map/map.h5", "--table", "gradings"][..], &["no table", "did you mean \"grading\"?"][..]),
        (&["map/map.h5", "-o", "table.xlsx"], &["table.xlsx", ".csv", ".vtkhdf"]),
        (&["map/map.h5", "-o", "there.csv"], &["there.csv", "--force"]),
        (&["map/map.h5", "-o", "map.vtkhdf"], &["map.h5", "fretwear run"]),
        (&["map/map.h5", "-o", "map.vtkhdf", "--table", "grading"], &["map.vtkhdf", "--table"]),
        (&["foreign.h5"], &["foreign.h5", "not an HDF5 file"]),
        (&["missing.h5"], &["missing.h5"]),
    ] {
        let output = run(folder, &[&["export"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let complaint = text(&output.stderr);
        assert!(words.iter().all(|word| complaint.contains(word)), "{arguments:?}: {complaint}");
        assert!(output.stdout.is_empty());
    }
    assert_eq!(names(folder), before);
    assert_eq!(fs::read_to_string(folder.join("there.csv")).unwrap(), "mine");
    done(folder, &["export", "map/map.h5", "-o", "there.csv", "--force"]);
    assert!(
        fs::read_to_string(folder.join("there.csv"))
            .unwrap()
            .starts_with("grading,amplitude_ratio,wear_volume,")
    );
}

/// Volume under the surface of one step, by prisms over its polygons.
fn volume(surface: &SurfaceSeries, step: usize) -> f64 {
    let count = surface.points_per_step();
    let points = &surface.points[3 * count * step..3 * count * (step + 1)];
    let point = |index: i64| &points[3 * index as usize..][..3];
    let polygons =
        surface.offsets.windows(2).map(|ends| &surface.connectivity[ends[0] as usize..ends[1] as usize]);
    polygons
        .flat_map(|polygon| {
            (2..polygon.len()).map(move |last| [polygon[0], polygon[last - 1], polygon[last]])
        })
        .map(|corners| {
            let [a, b, c] = corners.map(point);
            let twice_area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
            twice_area / 2.0 * (a[2] + b[2] + c[2]) / 3.0
        })
        .sum()
}

#[test]
fn the_surface_loses_the_worn_volume() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes/paraboloid.toml");
    done(folder.path(), &["run", scene.to_str().unwrap(), "-o", "run.h5", "--quiet"]);
    let path = folder.path().join("run.h5");
    let run = RunFile::open(&path).unwrap();
    let worn = run.snapshots.last().unwrap().wear_volume;
    let mut errors = vec![];
    for sectors in [36, 72] {
        let surface = worn_surface(&path, sectors).unwrap();
        assert_eq!(surface.times.len(), run.snapshots.len());
        let last = surface.times.len() - 1;
        let angle = std::f64::consts::TAU / sectors as f64;
        // Of a circle by its polygon.
        let circle = angle.sin() / angle;
        errors.push(((volume(&surface, last) - volume(&surface, 0)) / (circle * worn) - 1.0).abs());
    }
    // What is left is the trapezoidal rule between the nodes.
    assert!(errors.iter().all(|error| *error < 1e-2), "{errors:?}");
    done(folder.path(), &["export", "run.h5", "-o", "surface.vtkhdf"]);
    assert!(folder.path().join("surface.vtkhdf").metadata().unwrap().len() > 100_000);
}
