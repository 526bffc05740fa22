//! The files of sweeps, maps and universality studies.

use super::{POISSON_RATIO, TITLE};
use crate::scene::sampling::{Method, UnitCube};
use crate::scene::spacing::Spacing;
use crate::units::{Form, Key, Kind, Range, Rule, Table};

/// Most scenes of a study.
pub const MOST_SCENES: u64 = 10_000_000;
/// Most levels of a factor, single cases and pairs left out.
pub(in crate::scene) const MOST_ENTRIES: usize = 10_000;
/// Most gradings or amplitudes along one axis of a map.
pub(in crate::scene) const MOST_ALONG_AXIS: usize = 20_000;
/// Most scenes of which the whole run is kept by number.
pub(in crate::scene) const MOST_KEPT: usize = 100_000;
const MOST: usize = MOST_SCENES as usize;
const SCENES: Range = Range::at_least(1.0).to(MOST as f64);

/// A study.
pub(in crate::scene) const STUDY: Table = Table::new(
    "",
    "A study: a base scene and what is varied in it.",
    &[
        TITLE,
        Key::new("scene", Kind::Name, "File of the base scene, relative to the study.").example("base.toml"),
        TASK,
        Key::new(
            "axes",
            Kind::Tables(&AXIS, [0, 100]),
            "What varies; every value of one axis meets every one of the others.",
        )
        .optional(),
        Key::table(&SAMPLING).optional(),
        Key::table(&KEPT).optional(),
    ],
);
pub(in crate::scene) const TASKS: [&str; 2] = ["run", "limit"];
pub(in crate::scene) const TASK: Key = Key::new(
    "task",
    Kind::Word(&TASKS),
    "What is done with each scene: time stepping, or the closed form only.",
)
.default("run");

pub(in crate::scene) const AXIS: Table = Table::new(
    "axes",
    "One key and its values, or several keys that change together.",
    &[
        KEY,
        Key::new("values", Kind::List(&VALUE, [1, MOST]), "Its values.").example("[0.3, 0.6]").optional(),
        FROM,
        TO,
        COUNT,
        SPACING,
        Key::new("keys", Kind::List(&KEY, [0, 100]), "Keys that change together.")
            .example("[\"half_space.modulus\", \"half_space.poisson_ratio\"]")
            .optional(),
        ROWS,
    ],
)
.rules(&[Rule::Forms(&[
    Form::new(&["key", "values"]),
    Form::new(&["key", "from", "to", "count"]).may(&["spacing"]),
    Form::new(&["keys", "rows"]),
])]);
pub(in crate::scene) const FROM: Key =
    magnitude("from", "First of evenly spread values, with its unit.").example("10 GPa");
pub(in crate::scene) const TO: Key = magnitude("to", "Last of them, in the same unit.").example("200 GPa");
pub(in crate::scene) const ROWS: Key = Key::new(
    "rows",
    Kind::List(&ROW, [1, MOST]),
    "Values of these keys, one row for each scene along the axis.",
)
.example("[[\"210 GPa\", 0.3], [\"70 GPa\", 0.33]]")
.optional();
pub(in crate::scene) const KEY: Key = Key::new("key", Kind::KeyOfScene, "Key of the scene that varies.")
    .example("friction.coulomb.coefficient")
    .optional();
const VALUE: Key = Key::new("value", Kind::Literal, "Value of the key.");
const ROW: Key = Key::new("row", Kind::List(&VALUE, [0, 100]), "One value for each key.");
pub(in crate::scene) const COUNT: Key = Key::new("count", Kind::Whole, "How many values.")
    .range(Range::at_least(2.0).to(MOST as f64))
    .example("11")
    .optional();
pub(in crate::scene) const SPACING: Key =
    Key::new("spacing", Kind::Word(&Spacing::WORDS), "How they are spread.").default("linear");

const fn magnitude(name: &'static str, about: &'static str) -> Key {
    Key::new(name, Kind::Magnitude, about).optional()
}

pub(in crate::scene) const SAMPLING: Table = Table::new(
    "sampling",
    "Keys drawn from distributions, the same samples at every place of the axes.",
    &[METHOD, SAMPLES, SEED, VARIABLES],
);
pub(in crate::scene) const VARIABLES: Key =
    Key::new("variables", Kind::Tables(&VARIABLE, [1, UnitCube::MOST_VARIABLES]), "What is drawn.")
        .example("[[sampling.variables]] with key and distribution");
pub(in crate::scene) const METHOD: Key =
    Key::new("method", Kind::Word(&Method::WORDS), "How samples are spread.").default("sobol");
pub(in crate::scene) const SAMPLES: Key =
    Key::new("count", Kind::Whole, "Number of samples.").range(SCENES).example("1024");
pub(in crate::scene) const SEED: Key =
    Key::new("seed", Kind::Whole, "Seed of the random numbers.").range(Range::NOT_NEGATIVE).default("0");

pub(in crate::scene) const VARIABLE: Table = Table::new(
    "variables",
    "A key and its distribution.",
    &[
        Key { required: true, ..KEY },
        DISTRIBUTION,
        magnitude("from", "Lower end, with its unit.").example("0.5"),
        magnitude("to", "Upper end, in the same unit.").example("0.7"),
        magnitude("mean", "Mean, with its unit.").example("210 GPa"),
        magnitude("deviation", "Standard deviation, in the same unit.").example("10 GPa"),
        magnitude("median", "Median, with its unit.").example("1e-8 1/MPa"),
        FACTOR,
        magnitude("minimum", "Values below are left out."),
        magnitude("maximum", "Values above are left out."),
    ],
)
.rules(&[Rule::Words("distribution", &DISTRIBUTIONS)]);
/// The distributions and their parameters.
pub(in crate::scene) const DISTRIBUTIONS: [(&str, Form); 4] = [
    ("uniform", Form::new(&["from", "to"])),
    ("log-uniform", Form::new(&["from", "to"])),
    ("normal", Form::new(&["mean", "deviation"]).may(&["minimum", "maximum"])),
    ("log-normal", Form::new(&["median", "factor"]).may(&["minimum", "maximum"])),
];
pub(in crate::scene) const DISTRIBUTION: Key = Key::new(
    "distribution",
    Kind::Word(&["uniform", "log-uniform", "normal", "log-normal"]),
    "Its distribution.",
)
.example("uniform");
pub(in crate::scene) const FACTOR: Key =
    Key::number("factor", "Factor of the median within which two thirds of all values lie.")
        .range(Range::above(1.0))
        .example("2")
        .optional();

pub(in crate::scene) const KEPT: Table = Table::new(
    "output",
    "What is kept beside the rows.",
    &[Key::new(
        "snapshots",
        Kind::Either(&[
            Key::new("word", Kind::Word(&["none", "all"]), "Of no scene, or of all."),
            Key::new("numbers", Kind::List(&SCENE_NUMBER, [0, MOST_KEPT]), "Of the scenes of these numbers."),
        ]),
        "Of which scenes the whole run is kept: none, all, or their numbers.",
    )
    .default("none")],
);
const SCENE_NUMBER: Key =
    Key::new("scene", Kind::Whole, "Number of a scene, from 0.").range(Range::NOT_NEGATIVE);

/// A map.
pub(in crate::scene) const MAP: Table = Table::new(
    "",
    "Wear maps: what is compared; any part can be left out.",
    &[
        TITLE,
        Key::table(&MAP_INDENTER).optional(),
        Key::table(&MAP_HALF_SPACE).optional(),
        Key::table(&RATIOS).optional(),
        Key::table(&OPTIMUM).optional(),
        Key::table(&PROFILES).optional(),
    ],
);
const MAP_INDENTER: Table = Table::new("indenter", "Shape of the indenter.", &[MAP_EXPONENT]);
pub(in crate::scene) const MAP_EXPONENT: Key =
    Key::number("exponent", "Exponent n of f = A r^n: 1 is a cone, 2 a paraboloid.")
        .range(Range::at_least(0.1).to(20.0))
        .example("2");
const MAP_HALF_SPACE: Table =
    Table::new("half_space", "All half-spaces.", &[Key { required: true, ..POISSON_RATIO }]);

const RATIOS: Table = Table::new(
    "map",
    "The map of worn volumes over those of the homogeneous medium.",
    &[MAP_GRADINGS, MAP_AMPLITUDES, LEVELS],
);
pub(in crate::scene) const MAP_GRADINGS: Key = axis("grading", &MAP_GRADING, "Gradings k.");
const MAP_GRADING: Key = Key::number("value", "Value.").range(Range::above(-1.0).below(1.0)).example("0.2");
pub(in crate::scene) const MAP_AMPLITUDES: Key =
    axis("amplitude_ratio", &MAP_AMPLITUDE, "Amplitudes U/(μ_f d) of the map.");
const MAP_AMPLITUDE: Key =
    Key::number("value", "Value.").range(Range::at_least(1e-12).to(1e3)).example("0.5");
pub(in crate::scene) const LEVELS: Key = axis("levels", &LEVEL, "Values of the isolines.");
const LEVEL: Key = Key::number("value", "Value.").range(Range::POSITIVE).example("1");

const OPTIMUM: Table =
    Table::new("optimum", "The grading that wears least.", &[OPTIMUM_AMPLITUDES, REFERENCE_DEPTHS]);
pub(in crate::scene) const OPTIMUM_AMPLITUDES: Key =
    axis("amplitude_ratio", &MAP_AMPLITUDE, "Amplitudes U/(μ_f d) of the homogeneous contact.");
pub(in crate::scene) const REFERENCE_DEPTHS: Key = axis(
    "reference_depth",
    &RELATIVE_DEPTH,
    "Depths z0 over the contact radius of the homogeneous contact, for equal force.",
);
const RELATIVE_DEPTH: Key = Key::number("value", "Value.").range(Range::at_least(1e-6).to(1e6)).example("1");

const PROFILES: Table =
    Table::new("profiles", "Worn profiles.", &[MAP_GRADINGS, PROFILE_AMPLITUDE, PROFILE_POINTS]);
pub(in crate::scene) const PROFILE_AMPLITUDE: Key =
    Key { name: "amplitude_ratio", about: "Amplitude U/(μ_f d).", ..MAP_AMPLITUDE }.default("0.5");
pub(in crate::scene) const PROFILE_POINTS: Key = Key::new("points", Kind::Whole, "Number of radii.")
    .range(Range::at_least(2.0).to(MOST_ALONG_AXIS as f64))
    .default("401");

const fn axis(name: &'static str, value: &'static Key, about: &'static str) -> Key {
    Key::new(name, Kind::Axis(value, MOST_ALONG_AXIS), about).optional()
}

/// Values of an axis of a map that are not given one by one.
pub(in crate::scene) const STEPS: Table = Table::new(
    "",
    "Where the values begin and end.",
    &[FIRST, LAST, MAP_COUNT, Key { default: None, ..SPACING }],
);
pub(in crate::scene) const FIRST: Key = Key::number("from", "First value.").example("0.1");
pub(in crate::scene) const LAST: Key = Key::number("to", "Last value.").example("0.9");
pub(in crate::scene) const MAP_COUNT: Key = Key::new("count", Kind::Whole, "How many.")
    .range(Range::at_least(2.0).to(MOST_ALONG_AXIS as f64))
    .example("11");

/// A universality study.
pub(in crate::scene) const UNIVERSALITY: Table = Table::new(
    "",
    "Laws and modes of which each is to wear to one limit.",
    &[
        TITLE,
        Key::new(
            "scene",
            Kind::Either(&[
                Key::new("file", Kind::Name, "File of the base scene, relative to the study."),
                Key::new("table", Kind::Patch, "The base scene itself."),
            ]),
            "The base scene: the name of its file, or a table.",
        ),
        Key::table(&TOLERANCES).optional(),
        COVER,
        levels("media", "Media and indenters."),
        levels("wear", "Laws of wear."),
        levels("friction", "Laws of friction."),
        levels("modes", "Modes of oscillation."),
        Key::new("without", Kind::Tables(&WITHOUT, [0, MOST_ENTRIES]), "Pairs that are left out.").optional(),
        Key::new("cases", Kind::Tables(&CASE, [0, MOST_ENTRIES]), "Single cases.").optional(),
    ],
);
pub(in crate::scene) const COVER: Key =
    Key::new("cover", Kind::Word(&["pairs", "full"]), "Every two levels meet once, or all combinations.")
        .default("pairs");

pub(in crate::scene) const TOLERANCES: Table = Table::new(
    "tolerances",
    "Distances from the limit over its largest depth that decide.",
    &[WITHIN, OUTSIDE],
);
pub(in crate::scene) const WITHIN: Key =
    Key::number("within", "Up to here a case obeys the limit.").range(Range::POSITIVE).default("1e-6");
pub(in crate::scene) const OUTSIDE: Key =
    Key::number("outside", "From here on it violates it.").range(Range::POSITIVE).default("1e-3");

const fn levels(name: &'static str, about: &'static str) -> Key {
    Key::new(name, Kind::Tables(&LEVEL_OF_FACTOR, [0, MOST_ENTRIES]), about).optional()
}
pub(in crate::scene) const LEVEL_OF_FACTOR: Table =
    Table::new("", "A value of a factor.", &[NAME, PATCH, LASTS]);
pub(in crate::scene) const NAME: Key =
    Key::new("name", Kind::Text, "Name, different from all others.").example("blocks");
pub(in crate::scene) const PATCH: Key =
    Key::new("patch", Kind::Patch, "Keys of a scene that are laid over those of the base scene.").optional();
pub(in crate::scene) const LASTS: Key = Key::number("tau", "Dimensionless time that the run lasts at least.")
    .range(Range::POSITIVE)
    .example("100")
    .optional();

pub(in crate::scene) const WITHOUT: Table =
    Table::new("without", "A pair of levels that no case has.", &[PAIR, REASON]);
pub(in crate::scene) const PAIR: Key =
    Key::new("levels", Kind::List(&LEVEL_NAME, [2, 2]), "Names of two levels of different factors.")
        .example("[\"blocks\", \"load-dependent\"]");
const LEVEL_NAME: Key = Key::new("level", Kind::Text, "Name of a level.");
pub(in crate::scene) const REASON: Key = Key::new("reason", Kind::Text, "Why, one sentence.").optional();

pub(in crate::scene) const CASE: Table =
    Table::new("cases", "A case that stands for itself.", &[NAME, PATCH, LASTS, PREDICTED, REASON, FINER]);
pub(in crate::scene) const PREDICTIONS: [&str; 2] = ["within", "outside"];
pub(in crate::scene) const PREDICTED: Key = Key::new(
    "predicted",
    Kind::Word(&PREDICTIONS),
    "Where its end is to be: within or outside the tolerance of the limit.",
)
.example("within");
pub(in crate::scene) const FINER: Key =
    Key::new("finer", Kind::Switch, "Once more with twice the springs and an eighth of the tolerance.")
        .default("false");
