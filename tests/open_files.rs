//! Result files in other hands: h5py, xarray with h5netcdf, and h5dump read every dataset of every kind of file.

mod support;

use std::process::{Command, Stdio};

use support::command::done;
use support::results::every_kind;

const CURE: &str = "`bash .ci/setup` installs what is missing on Debian and Ubuntu; elsewhere: pip install h5py xarray h5netcdf, and HDF5's tools";

/// The first Python that has the packages.
fn python() -> &'static str {
    let has_packages = |python: &&str| {
        let mut command = Command::new(python);
        command.args(["-c", "import h5py, xarray, h5netcdf"]).stderr(Stdio::null());
        command.status().is_ok_and(|status| status.success())
    };
    let found = ["python3", "/usr/bin/python3", "python"].into_iter().find(has_packages);
    found.unwrap_or_else(|| panic!("no Python here has h5py, xarray and h5netcdf; {CURE}"))
}

#[test]
fn h5py_xarray_and_h5dump_see_units_meaning_dimensions_and_values_of_every_dataset_of_every_kind() {
    let folder = tempfile::tempdir().unwrap();
    let files = every_kind(folder.path());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/open_files.py");
    let output = Command::new(python()).arg(script).args(&files).output().expect("Python starts");
    let [said, complained] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    assert!(output.status.success(), "{said}{complained}");
    assert_eq!(said.lines().count(), files.len(), "{said}");
    for file in &files {
        let dump = |options: &[&str]| {
            let output = Command::new("h5dump").args(options).arg(file).output();
            let output = output.unwrap_or_else(|error| panic!("h5dump: {error}; {CURE}"));
            let complained = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success() && complained.is_empty(), "{}: {complained}", file.display());
            String::from_utf8_lossy(&output.stdout).into_owned()
        };
        let heads = dump(&["--header"]);
        let count = |what: &str| heads.matches(what).count();
        let datasets = count("DATASET \"");
        assert!(datasets > 8, "{heads}");
        for attribute in ["units", "long_name"] {
            let found = count(&format!("ATTRIBUTE \"{attribute}\""));
            assert_eq!(found, datasets, "{attribute} in {}", file.display());
        }
        assert_eq!(
            dump(&[]).matches("DATA {").count(),
            count("ATTRIBUTE \"") + datasets,
            "{}",
            file.display()
        );
    }
}

/// The code of the documentation, in the order of its pages, with results where it looks for them.
#[test]
fn the_python_code_of_the_documentation_runs() {
    let folder = tempfile::tempdir().unwrap();
    every_kind(folder.path());
    std::fs::rename(folder.path().join("merged.h5"), folder.path().join("study.h5")).unwrap();
    done(folder.path(), &["export", "paraboloid.h5", "--table", "time,node", "-o", "curves.csv"]);
    let mut count = 0;
    for page in [include_str!("../README.md"), include_str!("../docs/python.md")] {
        let blocks =
            page.split("```python\n").skip(1).map(|rest| rest.split("```").next().unwrap_or_default());
        // Those that need the package are run by its own tests.
        for block in blocks.filter(|block| !block.contains("import fretwear")) {
            let mut command = Command::new(python());
            let output =
                command.current_dir(folder.path()).args(["-c", block]).output().expect("Python starts");
            let complaint = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success() && !output.stdout.is_empty(), "{block}\n{complaint}");
            count += 1;
        }
    }
    assert_eq!(count, 2);
}
