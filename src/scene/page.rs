//! The keys of all files as a page of documentation.

use std::fmt::Write;

use super::schema::FileKind;
use crate::units::{Dimension, Form, Key, Kind, Range, Rule, Table};

/// The page `docs/keys.md`, Markdown: every table and key of every file, with what it takes, its default and an example.
pub fn page_of_keys() -> String {
    let mut page = String::from(
        "# Every key\n\nMade by `fretwear schema --markdown -o docs/keys.md --force`; [Scenes](scene.md) tells how the keys go together. A quantity is \
         a number in SI, or a string with its unit.\n",
    );
    for kind in FileKind::ALL {
        let table = kind.table();
        // Writing to a string cannot fail.
        let _ = write!(
            page,
            "\n## {}\n\n{}\n\n| key | takes | meaning |\n|---|---|---|\n",
            kind.name(),
            table.about
        );
        rows(&mut page, table, "");
    }
    page
}

/// The keys of a table, then the tables within it.
fn rows(page: &mut String, table: &Table, path: &str) {
    for key in table.keys.iter().filter(|key| inner(key).is_none()) {
        let _ = writeln!(page, "| `{}` | {} | {} |", key.name, takes(key), key.about);
    }
    for key in table.keys {
        let Some((inner, [open, close])) = inner(key) else { continue };
        let path = if path.is_empty() { key.name.into() } else { format!("{path}.{}", key.name) };
        let rules: Vec<String> = inner.rules.iter().map(rule).collect();
        let rules = if rules.is_empty() { String::new() } else { format!(" {}.", rules.join("; ")) };
        let needed = if key.required { "required" } else { "" };
        let _ = writeln!(page, "| **`{open}{path}{close}`** | {needed} | {}{rules} |", key.about);
        rows(page, inner, &path);
    }
}

/// The table of a key, and the brackets of its header.
fn inner(key: &Key) -> Option<(&'static Table, [&'static str; 2])> {
    match key.kind {
        Kind::Table(table) => Some((table, ["[", "]"])),
        Kind::Tables(table, _) => Some((table, ["[[", "]]"])),
        _ => None,
    }
}

fn takes(key: &Key) -> String {
    let mut text = kind(key);
    match key.range {
        Range::ANY => {}
        Range::POSITIVE => text += " above 0",
        Range::NOT_NEGATIVE => text += ", 0 or more",
        range => text += &format!(" in {range}"),
    }
    match (key.default, key.example_in_toml()) {
        (Some(default), _) => text += &format!("; {default} by default"),
        (None, Some(example)) => text += &format!(": `{example}`"),
        (None, None) => {}
    }
    text
}

fn kind(key: &Key) -> String {
    let plural = |item: &Key| format!("{}s", kind(item).trim_start_matches("a "));
    match key.kind {
        Kind::Quantity(Dimension::NUMBER) => "a number".into(),
        Kind::Quantity(dimension) => dimension.to_string(),
        Kind::Scaled | Kind::Magnitude => "a quantity".into(),
        Kind::NumberOr(word) => format!("{word:?} or a number"),
        Kind::Ratio => "a ratio of whole numbers".into(),
        Kind::Whole => "a whole number".into(),
        Kind::Word(words) => words.iter().map(|word| format!("{word:?}")).collect::<Vec<_>>().join(", "),
        Kind::Switch => "true or false".into(),
        Kind::Text => "one line of text".into(),
        Kind::Name => "a name".into(),
        Kind::KeyOfScene => "a key of a scene".into(),
        Kind::Literal => "a value".into(),
        Kind::Patch => "tables of a scene".into(),
        Kind::Settings => "keys of a scene and their values".into(),
        Kind::List(item, _) => format!("an array of {}", plural(item)),
        Kind::Axis(item, _) => {
            format!("an array of {}, or `{{ from, to, count, spacing }}`", plural(item))
        }
        Kind::Table(_) | Kind::Tables(..) => String::new(),
        Kind::Either(kinds) => kinds.iter().map(kind).collect::<Vec<_>>().join(", or "),
    }
}

fn rule(rule: &Rule) -> String {
    let names = |keys: &[&str]| keys.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
    let form = |form: &Form| match form.may {
        [] => names(form.needs),
        may => format!("{} (and {})", names(form.needs), names(may)),
    };
    match rule {
        Rule::OneOf(keys) => format!("Exactly one of {}", names(keys)),
        Rule::AtMostOneOf(keys) => format!("At most one of {}", names(keys)),
        Rule::Forms(forms) => forms.iter().map(form).collect::<Vec<_>>().join("; or "),
        Rule::Needs(key, other) => format!("`{key}` beside `{other}` only"),
        Rule::Words(key, words) => {
            let told = words.iter().filter(|(_, form)| !form.needs.is_empty());
            let told: Vec<String> = told.map(|(word, it)| format!("{word:?} with {}", form(it))).collect();
            format!("`{key}` = {}", told.join(", "))
        }
    }
}
