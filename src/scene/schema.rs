//! JSON Schemas of the files that are read, for editors that complete keys, show what they mean and mark what is wrong.
//!
//! A schema takes every file that the program takes, and refuses unknown keys, wrong types, values outside their ranges and alternatives given
//! together. What needs physics or other files is left to `fretwear check`. Draft 7, which editors of TOML know.

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};

use super::keys;
pub use super::keys::{is_key, unit_of};
use crate::units::{Dimension, Form, Key, Kind, Range, Rule, Table};

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
    /// A calibration, as `fretwear calibrate` takes it.
    Calibration,
}

impl FileKind {
    /// All kinds.
    pub const ALL: [Self; 5] = [Self::Scene, Self::Study, Self::Map, Self::Universality, Self::Calibration];

    /// The word of the command line: `scene`, `study`, `map`, `universality` or `calibration`.
    pub fn name(self) -> &'static str {
        ["scene", "study", "map", "universality", "calibration"][self as usize]
    }

    /// The keys of the file.
    pub(super) fn table(self) -> &'static Table {
        [&keys::SCENE, &keys::STUDY, &keys::MAP, &keys::UNIVERSALITY, &keys::CALIBRATION][self as usize]
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
        let mut schema = of_table(self.table());
        schema["$schema"] = "http://json-schema.org/draft-07/schema#".into();
        schema["title"] = format!("fretwear {}", self.name()).into();
        if self == Self::Universality {
            schema["definitions"] = json!({ PATCH: patch() });
        }
        schema
    }
}

/// Annotation of a quantity: the unit of its number, in the spelling of UDUNITS.
const UNIT: &str = "x-unit";
/// Name of a part of a scene among the definitions.
const PATCH: &str = "patch";
/// A number as text begins so; what follows is left to the reader of units.
const NUMBER: &str = r"^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)";
/// Dotted name of a key of a scene.
const DOTTED: &str = r"^[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+)+$";
/// Something must follow the number.
const AND_UNIT: &str = r"(\s+\S|[^0-9\s.+-])";

/// The schema of what a key takes.
fn of_key(key: &Key) -> Value {
    let number_or = |pattern: String| json!({ "anyOf": [bounded("number", key.range), { "type": "string", "pattern": pattern }] });
    let mut value = match key.kind {
        Kind::Quantity(Dimension::NUMBER) | Kind::Magnitude => number_or(NUMBER.into()),
        Kind::Quantity(_) | Kind::Scaled => {
            let mut value = number_or(format!("{NUMBER}{AND_UNIT}"));
            value[UNIT] = key.si_unit().into();
            value
        }
        Kind::NumberOr(word) => json!({ "anyOf": [bounded("number", key.range), { "const": word }] }),
        Kind::Ratio => number_or(r"^\s*\+?[0-9.]".into()),
        Kind::Whole => bounded("integer", key.range),
        Kind::Word(words) => json!({ "enum": words }),
        Kind::Switch => json!({ "type": "boolean" }),
        Kind::Text => {
            json!({ "type": "string", "maxLength": 1000, "pattern": "^[^\u{0}-\u{1f}\u{7f}-\u{9f}]*$" })
        }
        Kind::Name => json!({ "type": "string", "minLength": 1 }),
        Kind::KeyOfScene => json!({ "type": "string", "pattern": DOTTED, "maxLength": 199 }),
        Kind::Literal => json!({ "type": ["number", "string", "boolean", "array"] }),
        Kind::Patch => return json!({ "$ref": format!("#/definitions/{PATCH}") }),
        Kind::Settings => {
            let value = json!({ "type": ["number", "string", "boolean", "array"] });
            json!({ "type": "object", "propertyNames": { "pattern": DOTTED }, "additionalProperties": value })
        }
        Kind::List(item, counts) => array(of_key(item), counts),
        Kind::Axis(item, most) => {
            let steps = keys::STEPS.keys.iter().map(|key| match key.kind {
                Kind::Quantity(_) => Key { range: item.range, ..*key },
                _ => *key,
            });
            let steps = whole(part(steps.map(|key| (key.name, of_key(&key))), key.about), &keys::STEPS);
            json!({ "anyOf": [array(of_key(item), [1, most]), steps] })
        }
        Kind::Table(table) => of_table(table),
        Kind::Tables(table, counts) => array(of_table(table), counts),
        Kind::Either(kinds) => json!({ "anyOf": kinds.iter().map(of_key).collect::<Vec<_>>() }),
    };
    if let Some(example) =
        key.example_in_toml().filter(|_| !matches!(key.kind, Kind::Table(_) | Kind::Tables(..)))
    {
        value["examples"] = json!([from_toml(&example)]);
    }
    if let Some(default) = key.default {
        value["default"] = from_toml(default);
    }
    value["description"] = key.about.into();
    value
}

/// The schema of a table as it stands in a file.
fn of_table(table: &Table) -> Value {
    whole(part(table.keys.iter().map(|key| (key.name, of_key(key))), table.about), table)
}

/// The schema of any part of a scene, which is laid over another: tables need not be complete, laws and shapes are replaced as a whole.
fn patch() -> Value {
    let part_of = |key: &Key| match key.kind {
        Kind::Table(table) => part(table.keys.iter().map(|key| (key.name, of_key(key))), table.about),
        _ => of_key(key),
    };
    part(keys::SCENE.keys.iter().map(|key| (key.name, part_of(key))), keys::PATCH.about)
}

/// Any part of a table of these keys.
fn part<'a>(keys: impl Iterator<Item = (&'a str, Value)>, about: &str) -> Value {
    let keys: Map<String, Value> = keys.map(|(name, schema)| (name.to_owned(), schema)).collect();
    json!({ "type": "object", "properties": keys, "additionalProperties": false, "description": about })
}

/// The schema of a table with what it must have and what goes together.
fn whole(mut schema: Value, table: &Table) -> Value {
    let required: Vec<_> = table.keys.iter().filter(|key| key.required).map(|key| key.name).collect();
    if !required.is_empty() {
        schema["required"] = required.into();
    }
    if !table.rules.is_empty() {
        schema["allOf"] = table.rules.iter().map(of_rule).collect();
    }
    schema
}

fn of_rule(rule: &Rule) -> Value {
    let list = |values: Vec<Value>| Value::Array(values);
    match rule {
        Rule::OneOf(keys) => {
            json!({ "oneOf": list(keys.iter().map(|key| json!({ "required": [key] })).collect()) })
        }
        Rule::AtMostOneOf(keys) => {
            let pairs = keys.iter().enumerate().flat_map(|(place, one)| {
                keys[place + 1..].iter().map(move |two| json!({ "not": { "required": [one, two] } }))
            });
            json!({ "allOf": list(pairs.collect()) })
        }
        Rule::Forms(forms) => {
            json!({ "oneOf": list(forms.iter().map(|form| alone(form, forms.iter())).collect()) })
        }
        Rule::Needs(key, other) => json!({ "dependencies": { *key: [other] } }),
        Rule::Words(key, words) => {
            let word = |(word, form): &(&str, Form)| {
                let given = json!({ "properties": { *key: { "const": word } }, "required": [key] });
                json!({ "if": given, "then": alone(form, words.iter().map(|(_, form)| form)) })
            };
            json!({ "allOf": list(words.iter().map(word).collect()) })
        }
    }
}

/// One of several forms, without keys of the others.
fn alone<'a>(form: &Form, all: impl Iterator<Item = &'a Form>) -> Value {
    let strays: BTreeSet<&str> = all.flat_map(Form::keys).filter(|key| !form.has(key)).collect();
    let mut schema = json!({ "required": form.needs });
    if !strays.is_empty() {
        let strays: Vec<_> = strays.iter().map(|key| json!({ "required": [key] })).collect();
        schema["not"] = json!({ "anyOf": strays });
    }
    schema
}

fn array(items: Value, [fewest, most]: [usize; 2]) -> Value {
    json!({ "type": "array", "items": items, "minItems": fewest, "maxItems": most })
}

fn bounded(kind: &str, range: Range) -> Value {
    let mut value = json!({ "type": kind });
    let mut limit = |(end, belongs): (f64, bool), names: [&str; 2]| {
        if end.is_finite() {
            let whole = end == end.trunc() && end.abs() < 1e15;
            value[names[usize::from(belongs)]] = if whole { json!(end as i64) } else { json!(end) };
        }
    };
    limit(range.from, ["exclusiveMinimum", "minimum"]);
    limit(range.to, ["exclusiveMaximum", "maximum"]);
    value
}

/// A value in TOML, or the text itself where it is none.
fn from_toml(text: &str) -> Value {
    let value = format!("value = {text}").parse::<toml::Table>();
    let value = value.ok().and_then(|mut table| table.remove("value"));
    value.and_then(|value| serde_json::to_value(value).ok()).unwrap_or_else(|| text.into())
}
