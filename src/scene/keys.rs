//! The keys of every file that is read, each declared once: the reader, the schema, the pages of documentation, `--set` and the axes of studies
//! are made from these tables.

mod bodies;
mod calibration;
mod laws;
mod loading;
mod numerics;
mod studies;
mod tables;

pub(super) use bodies::*;
pub(super) use calibration::*;
pub(super) use laws::*;
pub(super) use loading::*;
pub(super) use numerics::*;
pub use studies::MOST_SCENES;
pub(super) use studies::*;

use super::document::nearest;
use crate::units::{Key, Kind, Table};

/// A title: one line.
pub(super) const TITLE: Key = Key::new("title", Kind::Text, "Title, one line; stored in the result.")
    .example("Steel ball on a steel flat")
    .optional();

/// A scene.
pub(super) const SCENE: Table = Table::new(
    "",
    "A scene: what is pressed on what, how it moves and for how long.",
    &[
        TITLE,
        Key::table(&INDENTER).example("[indenter.paraboloid] with radius"),
        Key::table(&HALF_SPACE).example("[half_space] with grading, modulus and poisson_ratio"),
        Key::table(&COUNTER_BODY).optional(),
        Key::table(&FRICTION).example("[friction.coulomb] with coefficient"),
        Key::table(&WEAR).example("[wear.archard] with coefficient"),
        Key::table(&LOADING).example("[loading] with load, amplitude and duration"),
        Key::table(&NUMERICS).optional(),
        Key::table(&OUTPUT).optional(),
    ],
);

/// Unit in SI of the number that a dotted key of a scene stands for, in the spelling of UDUNITS; "1" for plain numbers, words and what has a
/// unit that depends on an exponent.
///
/// ```
/// use fretwear::scene::schema::unit_of;
///
/// assert_eq!(unit_of("loading.amplitude"), "m");
/// assert_eq!(unit_of("wear.archard.coefficient"), "Pa-1");
/// assert_eq!(unit_of("friction.coulomb.coefficient"), "1");
/// ```
pub fn unit_of(key: &str) -> &'static str {
    SCENE.find(key).map_or("1", Key::si_unit)
}

/// Whether a dotted name is that of a table or a key of a scene.
///
/// ```
/// use fretwear::scene::schema::is_key;
///
/// assert!(is_key("loading.amplitude") && is_key("wear.threshold") && !is_key("slip annulus"));
/// ```
pub fn is_key(name: &str) -> bool {
    SCENE.find(name).is_some()
}

/// The dotted key of a scene that has values.
///
/// # Errors
/// The cure: which key is the nearest.
pub(super) fn find(dotted: &str) -> Result<&'static Key, String> {
    match SCENE.find(dotted) {
        Some(key) if !matches!(key.kind, Kind::Table(_)) => return Ok(key),
        Some(_) => {
            let inside = SCENE.dotted().into_iter().find(|it| it.starts_with(&format!("{dotted}.")));
            return Err(format!(
                "it is a table; name one of its keys, such as {}",
                inside.expect("a table has keys")
            ));
        }
        None => {}
    }
    let (table, last) = dotted.rsplit_once('.').unwrap_or(("", dotted));
    let inner = match SCENE.find(table).map(|key| key.kind) {
        Some(Kind::Table(inner)) => inner.keys,
        _ => &[],
    };
    if let Some(key) = inner.iter().find(|key| key.aliases.contains(&last)) {
        return Err(format!("did you mean {table}.{}?", key.name));
    }
    let all = SCENE.dotted();
    Err(nearest(dotted, &all.iter().map(String::as_str).collect::<Vec<_>>()))
}

/// Whether no scene can have both of two dotted keys.
pub(super) fn exclude(one: &str, other: &str) -> bool {
    let mut table = &SCENE;
    for (a, b) in one.split('.').zip(other.split('.')) {
        if a != b {
            return table.rivals(a).contains(&b);
        }
        match table.key(a).map(|key| key.kind) {
            Some(Kind::Table(inner)) => table = inner,
            _ => return false,
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::document::{Section, Source};
    use crate::units::Rule;

    /// All tables within one, itself included.
    fn tables(table: &'static Table) -> Vec<&'static Table> {
        let inner = table.keys.iter().filter_map(|key| match key.kind {
            Kind::Table(inner) | Kind::Tables(inner, _) => Some(inner),
            _ => None,
        });
        [table].into_iter().chain(inner.flat_map(tables)).collect()
    }

    fn all() -> Vec<&'static Table> {
        [&SCENE, &STUDY, &MAP, &UNIVERSALITY, &CALIBRATION].into_iter().flat_map(tables).collect()
    }

    #[test]
    fn defaults_and_examples_are_values_of_their_keys() {
        let mut count = 0;
        for key in all().iter().flat_map(|table| table.keys) {
            let default = key.default.map(|text| Key { example: text, default: None, ..*key });
            for key in [Some(*key), default].into_iter().flatten() {
                let table = matches!(key.kind, Kind::Table(_) | Kind::Tables(..));
                let Some(value) = key.example_in_toml().filter(|_| !table) else { continue };
                let text = format!("{} = {value}", key.name);
                let source = Source { name: "example", text: &text, kind: "a scene" };
                let document = source.parse().expect("TOML");
                let section = Section::root(source, document.get_ref());
                let entry = section.required(key.name, "").expect("it is there");
                assert_eq!(entry.check(&key).map_err(|error| error.to_string()), Ok(()), "{text}");
                count += 1;
            }
        }
        assert!(count > 100, "{count} examples");
    }

    #[test]
    fn every_key_says_what_it_is_in_a_sentence() {
        for key in all().iter().flat_map(|table| table.keys) {
            assert!(key.about.ends_with('.'), "{}: {}", key.name, key.about);
        }
    }

    #[test]
    fn rules_name_keys_of_their_tables() {
        for table in all() {
            let named = table.rules.iter().flat_map(|rule| match rule {
                Rule::Needs(one, other) => vec![*one, *other],
                Rule::Words(key, words) => {
                    words.iter().flat_map(|(_, form)| form.keys()).chain([*key]).collect()
                }
                _ => rule.forms().iter().flat_map(|form| form.keys().collect::<Vec<_>>()).collect(),
            });
            for name in named {
                assert!(table.key(name).is_some(), "{name} in [{}]", table.name);
            }
        }
    }
}
