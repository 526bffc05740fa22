//! What schemas are made of: quantities, words, lists and tables.

use serde_json::{Map, Value, json};

use crate::units::{Dimension, Form, Key, Kind, Range, Rule, Table as Declared};

/// A number as text begins so; what follows is left to the reader of units.
const NUMBER: &str = r"^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)";
/// Something must follow the number.
const AND_UNIT: &str = r"(\s+\S|[^0-9\s.+-])";

/// The schema of what a key takes.
pub(in crate::scene) fn of_key(key: &Key) -> Value {
    let mut value = match key.kind {
        Kind::Quantity(dimension) if dimension == Dimension::NUMBER => either_number(key, NUMBER.into()),
        Kind::Magnitude => either_number(key, NUMBER.into()),
        Kind::Quantity(_) | Kind::Scaled => {
            let mut value = either_number(key, format!("{NUMBER}{AND_UNIT}"));
            value[UNIT] = key.si_unit().into();
            value
        }
        Kind::NumberOr(word) => json!({ "anyOf": [bounded("number", key.range), { "const": word }] }),
        Kind::Ratio => either_number(key, r"^\s*\+?[0-9.]".into()),
        Kind::Whole => bounded("integer", key.range),
        Kind::Word(words) => json!({ "enum": words }),
        Kind::Switch => json!({ "type": "boolean" }),
        Kind::Text => {
            json!({ "type": "string", "maxLength": 1000, "pattern": "^[^\u{0}-\u{1f}\u{7f}-\u{9f}]*$" })
        }
        Kind::Name => json!({ "type": "string", "minLength": 1 }),
        Kind::KeyOfScene => {
            json!({ "type": "string", "pattern": r"^[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+)+$", "maxLength": 199 })
        }
        Kind::Literal => json!({ "type": ["number", "string", "boolean", "array"] }),
        Kind::Patch => return defined(PATCH),
        Kind::List(item, counts) => array(of_key(item), counts),
        Kind::Table(table) => of_table(table),
        Kind::Tables(table, counts) => array(of_table(table), counts),
        Kind::Either(kinds) => json!({ "anyOf": kinds.iter().map(of_key).collect::<Vec<_>>() }),
    };
    if let Some(example) = key.example_in_toml() {
        value["examples"] = json!([from_toml(&example)]);
    }
    if let Some(default) = key.default {
        value["default"] = from_toml(default);
    }
    described(value, key.about)
}

/// The schema of a table as it stands in a file.
pub(in crate::scene) fn of_table(table: &Declared) -> Value {
    let mut schema = part_of_table(table);
    let required: Vec<_> = table.keys.iter().filter(|key| key.required).map(|key| key.name).collect();
    if !required.is_empty() {
        schema["required"] = required.into();
    }
    if !table.rules.is_empty() {
        schema["allOf"] = table.rules.iter().map(of_rule).collect();
    }
    schema
}

/// The schema of any part of a table, as in a patch.
pub(in crate::scene) fn part_of_table(table: &Declared) -> Value {
    let keys = table.keys.iter().map(|key| (key.name.to_owned(), of_key(key)));
    let keys: Map<String, Value> = keys.collect();
    let schema = json!({ "type": "object", "properties": keys, "additionalProperties": false });
    described(schema, table.about)
}

fn of_rule(rule: &Rule) -> Value {
    match rule {
        Rule::OneOf(keys) => one_of(keys),
        Rule::AtMostOneOf(keys) => at_most_one_of(keys),
        Rule::Needs(key, other) => json!({ "dependencies": { *key: [other] } }),
        Rule::Forms(forms) => {
            let form = |form: &Form| {
                let others = forms.iter().flat_map(Form::keys);
                let strays: Vec<_> = others.filter(|key| !form.keys().any(|own| own == *key)).collect();
                let strays: Vec<_> = strays.iter().map(|key| json!({ "required": [key] })).collect();
                match strays.is_empty() {
                    true => json!({ "required": form.needs }),
                    false => json!({ "required": form.needs, "not": { "anyOf": strays } }),
                }
            };
            json!({ "oneOf": forms.iter().map(form).collect::<Vec<_>>() })
        }
    }
}

/// A number in the range of a key, or a text.
fn either_number(key: &Key, pattern: String) -> Value {
    json!({ "anyOf": [bounded("number", key.range), { "type": "string", "pattern": pattern }] })
}

fn array(items: Value, [fewest, most]: [usize; 2]) -> Value {
    json!({ "type": "array", "items": items, "minItems": fewest, "maxItems": most })
}

fn bounded(kind: &str, range: Range) -> Value {
    let mut value = json!({ "type": kind });
    let mut limit = |(end, belongs): (f64, bool), names: [&str; 2]| {
        if end.is_finite() {
            let whole = end == end.trunc() && end.abs() < 1e15;
            let end = if whole { json!(end as i64) } else { json!(end) };
            value[names[usize::from(belongs)]] = end;
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

/// Name of a part of a scene among the definitions.
pub(super) const PATCH: &str = "patch";

pub(super) fn above_zero() -> Value {
    json!({ "exclusiveMinimum": 0 })
}

pub(super) fn at_least_zero() -> Value {
    json!({ "minimum": 0 })
}

pub(super) fn any() -> Value {
    json!({})
}

/// A number in SI, or a string with a unit.
///
/// # Arguments
/// * `about` -- what it is, with its unit in SI
/// * `unit` -- the same in the spelling of UDUNITS; "1" where it depends on an exponent
/// * `limits` -- of the number in SI
/// * `example` -- with a unit
pub(super) fn quantity(about: &str, unit: &str, limits: Value, example: &str) -> Value {
    let text = json!({ "type": "string", "pattern": format!("{NUMBER}{AND_UNIT}") });
    let value = json!({ "anyOf": [limited("number", limits), text], "examples": [example], UNIT: unit });
    described(value, about)
}

/// Annotation of a quantity: the unit of its number, in the spelling of UDUNITS.
pub(super) const UNIT: &str = "x-unit";

/// Where the parts of a schema stand that occur often in it.
pub(super) const DEFINITIONS: &str = "definitions";

/// A part that stands among the definitions.
pub(super) fn defined(name: &str) -> Value {
    json!({ "$ref": format!("#/{DEFINITIONS}/{name}") })
}

/// A plain number, or its digits as a string.
pub(super) fn number(about: &str, limits: Value) -> Value {
    let text = json!({ "type": "string", "pattern": NUMBER });
    described(json!({ "anyOf": [limited("number", limits), text] }), about)
}

/// A number with any unit or none.
pub(super) fn magnitude(about: &str) -> Value {
    number(about, any())
}

pub(super) fn whole(about: &str, least: usize, most: Option<usize>) -> Value {
    let mut value = json!({ "type": "integer", "minimum": least });
    if let Some(most) = most {
        value["maximum"] = most.into();
    }
    described(value, about)
}

pub(super) fn word(about: &str, words: &[&str]) -> Value {
    described(json!({ "enum": words }), about)
}

pub(super) fn switch(about: &str) -> Value {
    described(json!({ "type": "boolean" }), about)
}

/// One line of text.
pub(super) fn line(about: &str) -> Value {
    let pattern = "^[^\u{0}-\u{1f}\u{7f}-\u{9f}]*$";
    described(json!({ "type": "string", "maxLength": 1000, "pattern": pattern }), about)
}

pub(super) fn text(about: &str) -> Value {
    described(json!({ "type": "string", "minLength": 1 }), about)
}

pub(super) fn list(about: &str, items: Value, [fewest, most]: [usize; 2]) -> Value {
    described(json!({ "type": "array", "items": items, "minItems": fewest, "maxItems": most }), about)
}

/// The value with what is taken where the key is left out.
pub(super) fn or(mut value: Value, default: impl Into<Value>) -> Value {
    value["default"] = default.into();
    value
}

fn limited(kind: &str, mut limits: Value) -> Value {
    limits["type"] = kind.into();
    limits
}

pub(super) fn described(mut value: Value, about: &str) -> Value {
    value["description"] = about.into();
    value
}

/// Exactly one of several keys.
pub(super) fn one_of(keys: &[&str]) -> Value {
    let forms: Vec<Value> = keys.iter().map(|key| json!({ "required": [key] })).collect();
    json!({ "oneOf": forms })
}

/// At most one of several keys.
pub(super) fn at_most_one_of(keys: &[&str]) -> Value {
    let pairs = keys.iter().enumerate().flat_map(|(place, one)| {
        keys[place + 1..].iter().map(move |two| json!({ "not": { "required": [one, two] } }))
    });
    json!({ "allOf": pairs.collect::<Vec<_>>() })
}

/// Exactly one of several forms, each with the keys that it needs and those that it has no place for.
pub(super) fn one_form(forms: &[(&[&str], &[&str])]) -> Value {
    let form = |(needs, refuses): &(&[&str], &[&str])| {
        let strays: Vec<Value> = refuses.iter().map(|key| json!({ "required": [key] })).collect();
        match strays.is_empty() {
            true => json!({ "required": needs }),
            false => json!({ "required": needs, "not": { "anyOf": strays } }),
        }
    };
    json!({ "oneOf": forms.iter().map(form).collect::<Vec<_>>() })
}

/// A table: its keys, those that it must have, and rules of what goes together.
pub(super) struct Table {
    about: String,
    keys: Vec<(&'static str, Value)>,
    required: Vec<&'static str>,
    rules: Vec<Value>,
}

impl Table {
    pub(super) fn new(about: &str, keys: Vec<(&'static str, Value)>) -> Self {
        Self { about: about.into(), keys, required: vec![], rules: vec![] }
    }

    pub(super) fn requires(mut self, keys: &[&'static str]) -> Self {
        self.required.extend(keys);
        self
    }

    pub(super) fn rule(mut self, rule: Value) -> Self {
        self.rules.push(rule);
        self
    }

    /// The table as it stands in a file.
    pub(super) fn whole(self) -> Value {
        let (required, rules) = (self.required.clone(), self.rules.clone());
        let mut schema = self.partial();
        if !required.is_empty() {
            schema["required"] = required.into();
        }
        if !rules.is_empty() {
            schema["allOf"] = rules.into();
        }
        schema
    }

    /// Any part of the table, as in a patch.
    pub(super) fn partial(self) -> Value {
        let properties: Map<String, Value> =
            self.keys.into_iter().map(|(key, schema)| (key.to_owned(), schema)).collect();
        let schema = json!({ "type": "object", "properties": properties, "additionalProperties": false });
        described(schema, &self.about)
    }
}
