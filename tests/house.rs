//! The order of the house: each file uses files to its right in its own storey and storeys below, nothing else.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Storeys from the top down; in each, a module may use those to its right. A folder belongs to the module of its name.
const STOREYS: [(&str, &[&str]); 6] = [
    ("entry", &["main", "lib"]),
    (
        "jobs",
        &[
            "submit",
            "sweep",
            "page",
            "figures",
            "report",
            "export",
            "universality",
            "tradeoff",
            "progress",
            "run",
            "wear_map",
            "drawing",
        ],
    ),
    ("files", &["scene", "snapshot"]),
    ("time", &["simulation", "stepper", "model"]),
    (
        "physics",
        &[
            "closed_form",
            "contact",
            "slip_depth",
            "stick_slip",
            "conditions",
            "wear",
            "spring",
            "path",
            "friction",
            "loading",
            "history",
            "indenter",
            "half_space",
        ],
    ),
    ("numerics", &["transforms", "abel", "chebyshev", "linear", "quadrature", "roots", "grid", "error"]),
];

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Place from the top down, and the storey's name.
fn place(module: &str) -> Option<(usize, &'static str)> {
    let mut modules =
        STOREYS.iter().flat_map(|(storey, modules)| modules.iter().map(move |name| (*storey, *name)));
    modules.by_ref().enumerate().find(|(_, (_, name))| *name == module).map(|(i, (storey, _))| (i, storey))
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    let mut found = vec![];
    for path in entries.map(|entry| entry.expect("readable").path()) {
        if path.is_dir() {
            found.extend(files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn module_of(file: &Path) -> String {
    let inside = file.strip_prefix(source()).expect("below src").with_extension("");
    inside.iter().next().expect("not empty").to_string_lossy().into_owned()
}

/// The modules that a text names after `crate::`, comments aside.
fn used(text: &str) -> BTreeSet<String> {
    let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    let names = code.flat_map(|line| line.split("crate::").skip(1));
    names
        .map(|rest| {
            rest.chars().take_while(|c| c.is_alphanumeric() || matches!(c, '_' | '{' | '*')).collect()
        })
        .collect()
}

#[test]
fn every_module_has_its_place() {
    for file in files(&source()) {
        let module = module_of(&file);
        assert!(place(&module).is_some(), "{} stands in no storey; add it to this test", file.display());
    }
}

#[test]
fn every_file_uses_only_what_stands_to_its_right_or_below() {
    let mut wrong = vec![];
    for file in files(&source()) {
        let module = module_of(&file);
        let (own, storey) = place(&module).expect("every_module_has_its_place");
        for name in used(&std::fs::read_to_string(&file).expect("readable")) {
            match place(&name) {
                _ if name == module => {}
                Some((other, _)) if other > own => {}
                Some((_, above)) => {
                    wrong.push(format!("{} ({storey}) uses {name} ({above})", file.display()));
                }
                None => wrong.push(format!(
                    "{} uses crate::{name}, which is no module; name the module",
                    file.display()
                )),
            }
        }
    }
    assert!(wrong.is_empty(), "against the order of the storeys:\n{}", wrong.join("\n"));
}
