//! The file of a calibration.

use super::{FROM, KEY, NAME, SEED, TITLE, TO};
use crate::units::{Form, Key, Kind, Range, Rule, Table};

/// Most unknowns of a calibration.
pub(in crate::scene) const MOST_UNKNOWNS: usize = 12;
/// Most laws that are compared.
pub(in crate::scene) const MOST_MODELS: usize = 20;
/// Most data sets of a calibration.
pub(in crate::scene) const MOST_DATA: usize = 1000;

/// A calibration.
pub(in crate::scene) const CALIBRATION: Table = Table::new(
    "",
    "A calibration: keys of a scene that are found from measurements.",
    &[
        TITLE,
        Key::new(
            "scene",
            Kind::Name,
            "File of the base scene, relative to the calibration; not needed where every data set has measured energies.",
        )
        .example("ball.toml")
        .optional(),
        LOSS,
        BOOTSTRAP,
        SEED,
        Key::new("unknowns", Kind::Tables(&UNKNOWN, [1, MOST_UNKNOWNS]), "What is found, under every model.")
            .example("[[unknowns]] with key, from and to")
            .optional(),
        Key::new("data", Kind::Tables(&DATA, [1, MOST_DATA]), "What was measured.")
            .example("[[data]] with file, cycles and wear_volume"),
        Key::new("models", Kind::Tables(&MODEL, [2, MOST_MODELS]), "Laws that are compared on the same data.")
            .optional(),
    ],
);
pub(in crate::scene) const LOSSES: [&str; 2] = ["squares", "huber"];
pub(in crate::scene) const LOSS: Key = Key::new(
    "loss",
    Kind::Word(&LOSSES),
    "What residuals cost: their squares, or beyond 1.345 deviations their size alone, so that outliers pull less.",
)
.default("squares");

/// Most times that data are made anew.
const MOST_SAMPLES: f64 = 1e5;
pub(in crate::scene) const BOOTSTRAP: Key = Key::new(
    "bootstrap",
    Kind::Whole,
    "How many times the data are made anew with errors drawn from the residuals and fitted, for intervals that do not take errors for normal.",
)
.range(Range::NOT_NEGATIVE.to(MOST_SAMPLES))
.default("0");

pub(in crate::scene) const UNKNOWN: Table = Table::new(
    "unknowns",
    "A key of the scene that is found, and where it is looked for.",
    &[
        Key { required: true, about: "Key of the scene that is found.", ..KEY }
            .example("wear.archard.coefficient"),
        TIED,
        Key { required: true, about: "Least value, with its unit.", ..FROM }.example("1e-16 1/Pa"),
        Key { required: true, about: "Largest value.", ..TO }.example("1e-12 1/Pa"),
        SCALE,
    ],
);
pub(in crate::scene) const TIED: Key =
    Key::new("tied", Kind::List(&KEY, [0, 100]), "Other keys that have the same value.")
        .example("[\"counter_body.modulus\"]")
        .optional();
pub(in crate::scene) const SCALES: [&str; 2] = ["log", "linear"];
pub(in crate::scene) const SCALE: Key = Key::new(
    "scale",
    Kind::Word(&SCALES),
    "How it is looked for: by ratios (the default where from is above 0) or by differences.",
)
.example("log")
.optional();

const fn column(name: &'static str, about: &'static str) -> Key {
    Key::new(name, Kind::Name, about).optional()
}

pub(in crate::scene) const DATA: Table = Table::new(
    "data",
    "Measurements of one test, in columns of a file; a column is given by its name, and by its unit where the header has none: \"V [mm^3]\".",
    &[
        Key::new("file", Kind::Name, "File of columns with a header, relative to the calibration.")
            .example("volumes.csv"),
        WHERE,
        CYCLES_OF_DATA,
        column("wear_volume", "Worn volume of both bodies, m³.").example("V"),
        column("wear_depth", "Largest wear depth of both bodies, m.").example("h"),
        column("contact_radius", "Radius of the scar, m.").example("a"),
        column("tangential_force", "Amplitude of the tangential force of a cycle, or along a loop, N.").example("Q"),
        column("cycle_energy", "Energy dissipated in one cycle, J.").example("Ed"),
        column("dissipated_energy", "Energy dissipated since the start, J.").example("E"),
        column("position", "Position along a line through the centre of a scar, m.").example("x"),
        column("height", "Height of the worn surface there, m; a scar is a hollow.").example("z"),
        column("displacement", "Displacement along one loop, in the order of time, m.").example("u"),
        SHARE,
        Key::new("unit", Kind::Name, "Unit of what was measured, where the header has none.")
            .example("mm^3")
            .optional(),
        DEVIATION,
        RELATIVE_DEVIATION,
        SET,
    ],
)
.rules(&[
    Rule::Forms(&FORMS_OF_DATA),
    Rule::AtMostOneOf(&["deviation", "relative_deviation"]),
]);
/// What can be measured, in the order of `Measured`.
pub(in crate::scene) const FORMS_OF_DATA: [Form; 9] = [
    Form::new(&["cycles", "wear_volume"]),
    Form::new(&["cycles", "wear_depth"]),
    Form::new(&["cycles", "contact_radius"]),
    Form::new(&["cycles", "tangential_force"]),
    Form::new(&["cycles", "cycle_energy"]),
    Form::new(&["cycles", "dissipated_energy"]),
    Form::new(&["dissipated_energy", "wear_volume"]),
    Form::new(&["position", "height", "cycles"]).may(&["share"]),
    Form::new(&["displacement", "tangential_force", "cycles"]),
];
const SET: Key = Key::new("set", Kind::Settings, "Keys of the scene for it.")
    .example("{ \"loading.amplitude\" = \"2 um\" }")
    .optional();
pub(in crate::scene) const WHERE: Key =
    Key::new("where", Kind::Text, "Rows that are taken: those with this text in this column.")
        .example("group = 5Hz")
        .optional();
pub(in crate::scene) const CYCLES_OF_DATA: Key = Key::new(
    "cycles",
    Kind::Either(&[
        Key::new("column", Kind::Name, "Column of the numbers of cycles."),
        Key::number("number", "The cycle at which a scar or a loop was measured.").range(Range::NOT_NEGATIVE),
    ]),
    "Number of cycles: a column, or a number for a scar or a loop.",
)
.example("N")
.optional();
pub(in crate::scene) const SHARE: Key = Key::number("share", "Part of the wear that the body of a scar has.")
    .range(Range::above(0.0).to(1.0))
    .default("1");
pub(in crate::scene) const DEVIATION: Key = Key::new(
    "deviation",
    Kind::Either(&[
        Key::new("column", Kind::Name, "Column of standard deviations."),
        Key::number("number", "Standard deviation in the unit of what was measured.").range(Range::POSITIVE),
    ]),
    "Standard deviation: a column, or a number in the unit of what was measured; estimated where it is left out.",
)
.example("s")
.optional();
pub(in crate::scene) const RELATIVE_DEVIATION: Key = Key::new(
    "relative_deviation",
    Kind::NumberOr("estimated"),
    "Standard deviation over the value itself: a number, or \"estimated\".",
)
.range(Range::above(0.0).to(10.0))
.example("0.05")
.optional();

pub(in crate::scene) const MODEL: Table = Table::new(
    "models",
    "A law with unknowns of its own.",
    &[
        Key { about: "Name, different from all others.", ..NAME }.example("friction power"),
        SET,
        Key::new(
            "unknowns",
            Kind::Tables(&UNKNOWN, [0, MOST_UNKNOWNS]),
            "What is found under this law besides.",
        )
        .example("[[models.unknowns]] with key, from and to")
        .optional(),
    ],
);
