//! The files of sweeps, maps and universality studies.

use serde_json::{Value, json};

use super::keys::{
    DEFINITIONS, PATCH, Table, above_zero, defined, described, line, list, magnitude, number, one_form, or,
    switch, text, whole, word,
};
use super::tables::{patch, poisson_ratio};
use crate::scene::map::MOST_ALONG_AXIS;
use crate::scene::sampling::{Method, UnitCube};
use crate::scene::spacing::Spacing;
use crate::scene::universality::MOST_ENTRIES;
use crate::scene::{MOST_SCENES, Prediction, Task};

const MOST: usize = MOST_SCENES as usize;

fn key_of_scene(about: &str) -> Value {
    let pattern = r"^[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+)+$";
    json!({ "type": "string", "pattern": pattern, "maxLength": 199, "description": about,
        "examples": ["friction.coulomb.coefficient"] })
}

pub(super) fn study() -> Table {
    let keys = vec![
        ("title", line("Title, one line.")),
        ("scene", text("File of the base scene, relative to the study.")),
        (
            "task",
            or(
                word(
                    "What is done with each scene: time stepping, or the closed form only.",
                    &Task::ALL.map(Task::name),
                ),
                Task::default().name(),
            ),
        ),
        (
            "axes",
            list("What varies; every value of one axis meets every one of the others.", axis(), [0, 100]),
        ),
        ("sampling", sampling()),
        ("output", output()),
    ];
    Table::new("A study: a base scene and what is varied in it.", keys).requires(&["scene"])
}

fn axis() -> Value {
    let value = json!({ "type": ["number", "string", "boolean", "array"] });
    let row = list("One value for each key.", value.clone(), [0, 100]);
    let keys = vec![
        ("key", key_of_scene("Key of the scene that varies.")),
        ("values", list("Its values.", value, [1, MOST])),
        ("from", magnitude("First of evenly spread values, with its unit.")),
        ("to", magnitude("Last of them, in the same unit.")),
        ("count", whole("How many values.", 2, Some(MOST))),
        ("spacing", or(word("How they are spread.", &Spacing::WORDS), Spacing::WORDS[0])),
        ("keys", list("Keys that change together.", key_of_scene("Key of the scene."), [0, 100])),
        ("rows", list("Values of these keys, one row for each scene along the axis.", row, [1, MOST])),
    ];
    let range = ["from", "to", "count", "spacing"];
    Table::new("One key and its values, or several keys that change together.", keys)
        .rule(one_form(&[
            (&["key", "values"], &[&range[..], &["keys", "rows"]].concat()),
            (&["key", "from", "to", "count"], &["values", "keys", "rows"]),
            (&["keys", "rows"], &[&range[..], &["key", "values"]].concat()),
        ]))
        .whole()
}

fn sampling() -> Value {
    let keys = vec![
        ("method", or(word("How samples are spread.", &Method::ALL.map(Method::name)), Method::Sobol.name())),
        ("count", whole("Number of samples.", 1, Some(MOST))),
        ("seed", or(whole("Seed of the random numbers.", 0, None), 0)),
        ("variables", list("What is drawn.", variable(), [1, UnitCube::MOST_VARIABLES])),
    ];
    Table::new("Keys drawn from distributions, the same samples at every place of the axes.", keys)
        .requires(&["count", "variables"])
        .whole()
}

fn variable() -> Value {
    let kinds = ["uniform", "log-uniform", "normal", "log-normal"];
    let keys = vec![
        ("key", key_of_scene("Key of the scene that varies.")),
        ("distribution", word("Its distribution.", &kinds)),
        ("from", magnitude("Lower end, with its unit.")),
        ("to", magnitude("Upper end, in the same unit.")),
        ("mean", magnitude("Mean, with its unit.")),
        ("deviation", magnitude("Standard deviation, in the same unit.")),
        ("median", magnitude("Median, with its unit.")),
        (
            "factor",
            number(
                "Factor of the median within which two thirds of all values lie.",
                json!({ "exclusiveMinimum": 1 }),
            ),
        ),
        ("minimum", magnitude("Values below are left out.")),
        ("maximum", magnitude("Values above are left out.")),
    ];
    let only = |kind: &str, needs: [&str; 2], strays: &[&str]| {
        let strays: Vec<Value> = strays.iter().map(|key| json!({ "required": [key] })).collect();
        json!({
            "if": { "properties": { "distribution": { "const": kind } }, "required": ["distribution"] },
            "then": { "required": needs, "not": { "anyOf": strays } },
        })
    };
    let (ends, normal, log_normal) = (["from", "to"], ["mean", "deviation"], ["median", "factor"]);
    let bounds = ["minimum", "maximum"];
    Table::new("A key and its distribution.", keys)
        .requires(&["key", "distribution"])
        .rule(only(kinds[0], ends, &[normal, log_normal, bounds].concat()))
        .rule(only(kinds[1], ends, &[normal, log_normal, bounds].concat()))
        .rule(only(kinds[2], normal, &[ends, log_normal].concat()))
        .rule(only(kinds[3], log_normal, &[ends, normal].concat()))
        .whole()
}

fn output() -> Value {
    let numbers =
        json!({ "type": "array", "items": { "type": "integer", "minimum": 0 }, "maxItems": 100_000 });
    let kept = json!({ "anyOf": [{ "enum": ["none", "all"] }, numbers] });
    let kept =
        or(described(kept, "Of which scenes the whole run is kept: none, all, or their numbers."), "none");
    Table::new("What is kept beside the rows.", vec![("snapshots", kept)]).whole()
}

/// A list of values, or where they begin and end.
fn values(about: &str, limits: &Value) -> Value {
    let number = |about: &str| number(about, limits.clone());
    let range = Table::new(
        about,
        vec![
            ("from", number("First value.")),
            ("to", number("Last value.")),
            ("count", whole("How many.", 2, Some(MOST_ALONG_AXIS))),
            ("spacing", word("How they are spread.", &Spacing::WORDS)),
        ],
    );
    let range = range.requires(&["from", "to", "count"]).whole();
    let list = list(about, number("Value."), [1, MOST_ALONG_AXIS]);
    described(json!({ "anyOf": [list, range] }), about)
}

pub(super) fn map() -> Table {
    let grading = json!({ "exclusiveMinimum": -1, "exclusiveMaximum": 1 });
    let amplitude = json!({ "minimum": 1e-12, "maximum": 1e3 });
    let depth = json!({ "minimum": 1e-6, "maximum": 1e6 });
    let exponent = number(
        "Exponent n of f = A r^n: 1 is a cone, 2 a paraboloid.",
        json!({ "minimum": 0.1, "maximum": 20 }),
    );
    let indenter =
        Table::new("Shape of the indenter.", vec![("exponent", or(exponent, 2))]).requires(&["exponent"]);
    let half_space = Table::new("All half-spaces.", vec![("poisson_ratio", or(poisson_ratio(), "similar"))])
        .requires(&["poisson_ratio"]);
    let ratios = |of: &str| values(&format!("Amplitudes U/(μ_f d) of {of}."), &amplitude);
    let map = Table::new(
        "The map of worn volumes over those of the homogeneous medium.",
        vec![
            ("grading", values("Gradings k.", &grading)),
            ("amplitude_ratio", ratios("the map")),
            ("levels", values("Values of the isolines.", &above_zero())),
        ],
    );
    let optimum = Table::new(
        "The grading that wears least.",
        vec![
            ("amplitude_ratio", ratios("the homogeneous contact")),
            (
                "reference_depth",
                values(
                    "Depths z0 over the contact radius of the homogeneous contact, for equal force.",
                    &depth,
                ),
            ),
        ],
    );
    let amplitude_ratio = or(number("Amplitude U/(μ_f d).", amplitude.clone()), 0.5);
    let profiles = Table::new(
        "Worn profiles.",
        vec![
            ("grading", values("Gradings k.", &grading)),
            ("amplitude_ratio", amplitude_ratio),
            ("points", or(whole("Number of radii.", 2, Some(MOST_ALONG_AXIS)), 401)),
        ],
    );
    let tables = [
        ("indenter", indenter),
        ("half_space", half_space),
        ("map", map),
        ("optimum", optimum),
        ("profiles", profiles),
    ];
    let mut keys = vec![("title", line("Title, one line."))];
    keys.extend(tables.into_iter().map(|(name, table)| (name, table.whole())));
    Table::new("Wear maps: what is compared; any part can be left out.", keys)
}

/// The schema of a universality study, and of what stands in it often.
pub(super) fn universality() -> Value {
    let mut schema = universality_keys().whole();
    schema[DEFINITIONS][PATCH] = patch("Keys of a scene that are laid over those of the base scene.");
    schema
}

fn universality_keys() -> Table {
    let file = text("File of the base scene, relative to the study.");
    let scene = json!({ "anyOf": [file, defined(PATCH)] });
    let tolerances = Table::new(
        "Distances from the limit over its largest depth that decide.",
        vec![
            ("within", or(number("Up to here a case obeys the limit.", above_zero()), 1e-6)),
            ("outside", or(number("From here on it violates it.", above_zero()), 1e-3)),
        ],
    );
    let pair = list("Names of two levels of different factors.", json!({ "type": "string" }), [2, 2]);
    let without = Table::new(
        "A pair of levels that no case has.",
        vec![("levels", pair), ("reason", line("Why, one sentence."))],
    );
    let level = |about: &str| Table::new(about, level_keys()).requires(&["name"]).whole();
    let mut case_keys = level_keys();
    case_keys.extend([
        ("predicted", word("Where its end is to be.", &Prediction::ALL.map(Prediction::name))),
        ("reason", line("Why, one sentence.")),
        ("finer", or(switch("Once more with twice the springs and an eighth of the tolerance."), false)),
    ]);
    let case =
        Table::new("A case that stands for itself.", case_keys).requires(&["name", "predicted"]).whole();
    let levels = |about: &str| list(about, level(about), [0, MOST_ENTRIES]);
    let keys = vec![
        ("title", line("Title, one line.")),
        ("scene", described(scene, "The base scene: the name of its file, or a table.")),
        ("tolerances", tolerances.whole()),
        ("cover", or(word("Every two levels meet once, or all combinations.", &["pairs", "full"]), "pairs")),
        ("media", levels("Media and indenters.")),
        ("wear", levels("Laws of wear.")),
        ("friction", levels("Laws of friction.")),
        ("modes", levels("Modes of oscillation.")),
        (
            "without",
            list("Pairs that are left out.", without.requires(&["levels"]).whole(), [0, MOST_ENTRIES]),
        ),
        ("cases", list("Single cases.", case, [0, MOST_ENTRIES])),
    ];
    Table::new("Laws and modes of which each is to wear to one limit.", keys).requires(&["scene"])
}

fn level_keys() -> Vec<(&'static str, Value)> {
    vec![
        ("name", line("Name, different from all others.")),
        ("patch", defined(PATCH)),
        ("tau", number("Dimensionless time that the run lasts at least.", above_zero())),
    ]
}
