//! JSON Schemas of the files that are read, for editors that complete keys, show what they mean and mark what is wrong.
//!
//! A schema takes every file that the program takes, and refuses unknown keys, wrong types, values outside their ranges and alternatives given
//! together. What needs physics or other files is left to `fretwear check`. Draft 7, which editors of TOML know.

mod keys;
mod loading;
mod studies;
mod tables;

use serde_json::Value;

/// Kinds of files that have a schema.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FileKind {
    /// A scene, as `fretwear run` takes it.
    Scene,
    /// A study, as `fretwear sweep` takes it.
    Study,
    /// A map, as `fretwear map` takes it.
    Map,
    /// A universality study, as `fretwear universality` takes it.
    Universality,
}

impl FileKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::Scene, Self::Study, Self::Map, Self::Universality];

    /// The word of the command line: `scene`, `study`, `map` or `universality`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Study => "study",
            Self::Map => "map",
            Self::Universality => "universality",
        }
    }

    /// The JSON Schema of the file.
    ///
    /// # Examples
    /// ```
    /// use fretwear::scene::schema::FileKind;
    ///
    /// let schema = FileKind::Scene.schema();
    /// let radius = &schema["properties"]["indenter"]["properties"]["paraboloid"]["properties"]["radius"];
    /// assert_eq!(radius["description"], "Radius of curvature R of f = r²/(2R), m.");
    /// ```
    pub fn schema(self) -> Value {
        let mut schema = match self {
            Self::Scene => tables::scene().whole(),
            Self::Study => studies::study().whole(),
            Self::Map => studies::map().whole(),
            Self::Universality => studies::universality(),
        };
        schema["$schema"] = "http://json-schema.org/draft-07/schema#".into();
        schema["title"] = format!("fretwear {}", self.name()).into();
        schema
    }
}

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
pub fn unit_of(key: &str) -> String {
    let scene = FileKind::Scene.schema();
    let entry = key.split('.').fold(&scene, |table, key| &table["properties"][key]);
    entry[keys::UNIT].as_str().unwrap_or("1").to_owned()
}

/// Whether a dotted name is that of a table or a key of a scene.
///
/// ```
/// use fretwear::scene::schema::is_key;
///
/// assert!(is_key("loading.amplitude") && is_key("wear.threshold") && !is_key("slip annulus"));
/// ```
pub fn is_key(name: &str) -> bool {
    let scene = FileKind::Scene.schema();
    name.split('.').try_fold(&scene, |table, key| table["properties"].get(key)).is_some()
}

/// Dotted keys of a scene that have values, as studies vary them; those of arrays of tables by the array alone.
pub(super) fn keys_of_scene() -> Vec<String> {
    fn add(schema: &Value, path: &str, keys: &mut Vec<String>) {
        match schema["properties"].as_object() {
            Some(inner) => inner.iter().for_each(|(key, schema)| {
                let dot = if path.is_empty() { "" } else { "." };
                add(schema, &format!("{path}{dot}{key}"), keys);
            }),
            None => keys.push(path.to_owned()),
        }
    }
    let mut keys = vec![];
    add(&FileKind::Scene.schema(), "", &mut keys);
    keys
}
