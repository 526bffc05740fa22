//! The documentation: links that resolve, pages that are in the book, keys and commands that are all described, code that runs.

mod support;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use support::command::done;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn page(name: &str) -> String {
    fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn pages() -> Vec<PathBuf> {
    let docs = fs::read_dir(root().join("docs")).expect("docs").map(|entry| entry.expect("readable").path());
    let mut pages: Vec<_> = docs.filter(|path| path.extension().is_some_and(|it| it == "md")).collect();
    pages.extend(
        ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "data/reference/README.md"]
            .map(|it| root().join(it)),
    );
    pages.sort();
    pages
}

/// Targets of the links of a page, code left out.
fn links(text: &str) -> Vec<String> {
    let outside_blocks = text.split("```").step_by(2);
    let prose = outside_blocks.flat_map(|part| part.lines().filter(|line| !line.starts_with("    ")));
    let ends = prose.flat_map(|line| line.split("](").skip(1));
    ends.filter_map(|rest| rest.split(')').next()).map(str::to_owned).collect()
}

/// The anchor that a heading gets.
fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.collect::<String>().trim().to_lowercase().replace(' ', "-")
}

#[test]
fn every_relative_link_leads_to_a_file_and_a_heading_that_are_there() {
    let (mut broken, mut count) = (vec![], 0);
    for page in pages() {
        let text = fs::read_to_string(&page).expect("readable");
        for link in links(&text).into_iter().filter(|link| !link.contains("://")) {
            count += 1;
            let (file, heading) = link.split_once('#').unwrap_or((&link, ""));
            let target =
                if file.is_empty() { page.clone() } else { page.parent().expect("a folder").join(file) };
            let found = fs::read_to_string(&target);
            let has_heading = || {
                let lines = found.as_deref().unwrap_or_default().lines();
                lines
                    .filter(|line| line.starts_with('#'))
                    .any(|line| anchor(line.trim_start_matches('#')) == heading)
            };
            if !target.exists() || (!heading.is_empty() && !has_heading()) {
                broken.push(format!("{}: {link}", page.display()));
            }
        }
    }
    assert!(broken.is_empty() && count > 40, "{count} links, broken: {broken:#?}");
}

#[test]
fn every_page_is_in_the_contents_of_the_book() {
    let listed: BTreeSet<String> = links(&page("docs/SUMMARY.md")).into_iter().collect();
    let docs = pages().into_iter().filter(|page| page.parent() == Some(&root().join("docs")));
    let names = docs.map(|page| page.file_name().expect("a file").to_string_lossy().into_owned());
    let there: BTreeSet<String> = names.filter(|name| name != "SUMMARY.md").collect();
    assert_eq!(listed, there);
}

#[test]
fn the_page_of_keys_is_made_of_the_keys() {
    let cure = "make it anew: fretwear schema --markdown -o docs/keys.md --force";
    assert!(page("docs/keys.md") == fretwear::scene::page_of_keys(), "{cure}");
}

#[test]
fn every_command_is_described() {
    let folder = tempfile::tempdir().unwrap();
    let help = done(folder.path(), &["--help"]);
    let list = help.split("Commands:\n").nth(1).and_then(|rest| rest.split("\n\n").next()).expect("a list");
    let text = page("docs/commands.md");
    for name in list.lines().filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help")
    {
        assert!(text.contains(&format!("    fretwear {name} ")), "docs/commands.md says nothing of {name}");
    }
}

#[test]
fn the_readme_is_short() {
    let lines = page("README.md").lines().count();
    assert!(lines < 140, "{lines} lines; what is long belongs in docs");
}
