//! The layers of the code: each file uses its own folder and what stands below it, and modules of one folder form no circle.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Folders of src, a file of the same name included, from the bottom up.
const LAYERS: [&str; 15] = [
    "error", "units", "numerics", "laws", "contact", "solver", "data", "scene", "run", "report", "study",
    "figures", "lib", "cli", "main",
];

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
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

/// The module of a file, as the names of its path: `["solver", "model", "jacobian"]`.
fn module_of(file: &Path) -> Vec<String> {
    let inside = file.strip_prefix(source()).expect("below src").with_extension("");
    inside.iter().map(|name| name.to_string_lossy().into_owned()).collect()
}

/// Statements without comments; each `use` is one text without line breaks.
fn code(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    lines.collect::<Vec<_>>().join(" ")
}

/// Writes `a::{b::{c, d}, e}` as `a::b::c`, `a::b::d`, `a::e`; `text` begins behind the first name.
fn expanded(prefix: &[String], text: &str) -> (Vec<Vec<String>>, usize) {
    let mut found = vec![];
    let mut path = prefix.to_vec();
    let mut at = 0;
    let bytes = text.as_bytes();
    loop {
        let name: String = text[at..].chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        at += name.len();
        if !name.is_empty() {
            path.push(name);
        }
        if text[at..].starts_with("::{") || (at == 0 && text.starts_with('{')) {
            at += text[at..].find('{').expect("seen") + 1;
            loop {
                while at < bytes.len() && matches!(bytes[at], b' ' | b',') {
                    at += 1;
                }
                if at >= bytes.len() || bytes[at] == b'}' {
                    return (found, (at + 1).min(bytes.len()));
                }
                let (inner, used) = expanded(&path, &text[at..]);
                found.extend(inner);
                at += used.max(1);
                // "as name"
                if text[at..].starts_with(" as ") {
                    at += 4 + text[at + 4..].find([',', '}']).unwrap_or(0);
                }
            }
        } else if text[at..].starts_with("::") {
            at += 2;
        } else {
            found.push(path);
            return (found, at);
        }
    }
}

/// All paths that a file names after `crate::`, `super::` and `self::`, from the root.
fn named(module: &[String], text: &str) -> Vec<Vec<String>> {
    let code = code(text);
    let mut found = vec![];
    for (start, _) in code.match_indices("crate::") {
        found.extend(expanded(&[], &code[start + "crate::".len()..]).0);
    }
    for (start, _) in code.match_indices("super::") {
        if code[..start].ends_with("super::") || code[..start].ends_with("in ") {
            continue;
        }
        let mut rest = &code[start..];
        let mut base = module.to_vec();
        while let Some(behind) = rest.strip_prefix("super::") {
            base.pop();
            rest = behind;
        }
        found.extend(expanded(&base, rest).0);
    }
    found
}

/// Names that a module passes on from its children: `(module, name) -> child`.
fn passed_on(modules: &BTreeMap<Vec<String>, String>) -> BTreeMap<(Vec<String>, String), Vec<String>> {
    let mut found = BTreeMap::new();
    for (module, text) in modules {
        let code = code(text);
        for (start, _) in code.match_indices("use ") {
            for path in expanded(&[], &code[start + 4..]).0 {
                let child: Vec<String> = module.iter().chain(path.first()).cloned().collect();
                let child = if module == &["lib"] { path[..1].to_vec() } else { child };
                if path.len() > 1 && modules.contains_key(&child) {
                    let full: Vec<String> = child.iter().chain(&path[1..]).cloned().collect();
                    found.insert((module.clone(), path[path.len() - 1].clone()), full);
                }
            }
        }
    }
    found
}

/// The file in which what a path names stands.
fn file_of(
    path: &[String],
    modules: &BTreeMap<Vec<String>, String>,
    passed: &BTreeMap<(Vec<String>, String), Vec<String>>,
) -> Option<Vec<String>> {
    let length = (1..=path.len()).rev().find(|length| modules.contains_key(&path[..*length]))?;
    let module = path[..length].to_vec();
    match path.get(length).and_then(|name| passed.get(&(module.clone(), name.clone()))) {
        Some(further) if further != path => file_of(further, modules, passed),
        _ => Some(module),
    }
}

/// Which file uses which.
fn uses() -> BTreeMap<Vec<String>, BTreeSet<Vec<String>>> {
    let read = |file: PathBuf| (module_of(&file), std::fs::read_to_string(&file).expect("readable"));
    let modules: BTreeMap<Vec<String>, String> = files(&source()).into_iter().map(read).collect();
    let passed = passed_on(&modules);
    let used = |module: &[String], text: &str| {
        named(module, text).iter().filter_map(|path| file_of(path, &modules, &passed)).collect()
    };
    modules.iter().map(|(module, text)| (module.clone(), used(module, text))).collect()
}

#[test]
fn every_file_uses_its_own_layer_and_those_below() {
    let place = |module: &[String]| {
        LAYERS
            .iter()
            .position(|layer| module[0] == *layer)
            .unwrap_or_else(|| panic!("{} is in no layer", module[0]))
    };
    let mut wrong = vec![];
    for (module, used) in uses() {
        for other in used {
            if place(&other) > place(&module) {
                wrong.push(format!("{} uses {}, which stands above it", module.join("::"), other.join("::")));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Siblings in one folder that use each other, directly or by way of others; what they hold counts with them.
fn circles() -> Vec<String> {
    let mut edges: BTreeMap<Vec<String>, BTreeSet<Vec<String>>> = BTreeMap::new();
    for (module, used) in uses() {
        for other in used {
            let common = module.iter().zip(&other).take_while(|(a, b)| a == b).count();
            // A module and one inside it belong together.
            if common < module.len() && common < other.len() {
                edges.entry(module[..=common].to_vec()).or_default().insert(other[..=common].to_vec());
            }
        }
    }
    let reaches = |from: &Vec<String>, to: &Vec<String>| {
        let (mut seen, mut left) = (BTreeSet::new(), vec![from]);
        while let Some(module) = left.pop() {
            for next in edges.get(module).into_iter().flatten() {
                if next == to {
                    return true;
                }
                if seen.insert(next) {
                    left.push(next);
                }
            }
        }
        false
    };
    let mut found = vec![];
    for (module, used) in &edges {
        found.extend(
            used.iter()
                .filter(|other| reaches(other, module))
                .map(|other| format!("{} -> {}", module.join("::"), other.join("::"))),
        );
    }
    found
}

#[test]
fn modules_form_no_circle() {
    let circles = circles();
    assert!(circles.is_empty(), "{}", circles.join("\n"));
}
