//! The indenter, friction and wear.

use super::loading::MOST_TIMES;
use crate::laws::entry::Entry;
use crate::laws::{friction, wear};
use crate::units::{Dimension, Form, Key, Kind, Range, Rule, Table};

const fn positive(name: &'static str, about: &'static str) -> Key {
    Key::number(name, about).range(Range::POSITIVE)
}

const fn length(name: &'static str, about: &'static str) -> Key {
    Key::quantity(name, Dimension::LENGTH, about).range(Range::POSITIVE)
}

const PARABOLOID: Table = Table::new(
    "paraboloid",
    "f = r²/(2R).",
    &[length("radius", "Radius of curvature R of f = r²/(2R), m.").example("10 mm")],
);
const SPHERE: Table =
    Table::new("sphere", "f = R - √(R² - r²).", &[length("radius", "Radius R, m.").example("10 mm")]);
const CONE: Table = Table::new(
    "cone",
    "f = r tan θ.",
    &[
        positive("slope", "Slope tan θ of the flank against the surface.").example("0.087").optional(),
        Key::quantity("half_angle", Dimension::ANGLE, "Angle between axis and flank, rad.")
            .range(Range::POSITIVE)
            .example("85 deg")
            .optional(),
    ],
)
.rules(&[Rule::OneOf(&["slope", "half_angle"])]);
const POWER_LAW_SHAPE: Table = Table::new(
    "power-law",
    "f = coefficient r^exponent.",
    &[
        Key::new("coefficient", Kind::Scaled, "Coefficient A of f = A r^n, m^(1-n).")
            .range(Range::POSITIVE)
            .example("50 1/m"),
        positive("exponent", "Exponent n: 1 is a cone, 2 a paraboloid.").example("2"),
    ],
);
const TABLE: Table = Table::new(
    "table",
    "A measured profile.",
    &[
        Key::new(
            "file",
            Kind::Name,
            "File of two columns r and f, from the tip at r = 0 outwards; relative to the scene.",
        )
        .example("profile.csv"),
        Key::new("radius_unit", Kind::Name, "Unit of the radii, a length.").default("m"),
        Key::new("profile_unit", Kind::Name, "Unit of the heights, a length.").default("m"),
        Key::quantity(
            "smoothing",
            Dimension::LENGTH,
            "Standard deviation of the noise in the heights, m: the profile is the smoothest curve with such residuals. 0 takes the rows as they \
             are.",
        )
        .range(Range::NOT_NEGATIVE)
        .example("20 nm")
        .optional(),
    ],
);

const SHAPES: &[&str] = &["paraboloid", "sphere", "cone", "power-law", "table"];

pub(in crate::scene) const INDENTER: Table = Table::new(
    "indenter",
    "Shape of the indenter, exactly one.",
    &[
        Key::table(&PARABOLOID).optional(),
        Key::table(&SPHERE).optional(),
        Key::table(&CONE).optional(),
        Key::table(&POWER_LAW_SHAPE).optional(),
        Key::table(&TABLE).optional(),
    ],
)
.rules(&[Rule::OneOf(SHAPES)]);

/// Tables of laws.
const fn tables<L: ?Sized, const N: usize>(laws: &'static [&'static Entry<L>]) -> [Table; N] {
    let mut tables = [Table::new("", "", &[]); N];
    let mut place = 0;
    while place < N {
        tables[place] = laws[place].table();
        place += 1;
    }
    tables
}

/// Their names.
const fn names<const N: usize>(tables: &'static [Table]) -> [&'static str; N] {
    let mut names = [""; N];
    let mut place = 0;
    while place < N {
        names[place] = tables[place].name;
        place += 1;
    }
    names
}

/// The keys of a table with one of some laws, and their history.
const fn keys<const N: usize>(tables: &'static [Table], history: &'static Table) -> [Key; N] {
    let mut keys = [Key::table(history).optional(); N];
    let mut place = 0;
    while place < tables.len() {
        keys[place] = Key::table(&tables[place]).optional();
        place += 1;
    }
    keys
}

const FRICTION_LAWS: usize = friction::ENTRIES.len();
static FRICTION_TABLES: [Table; FRICTION_LAWS] = tables(friction::ENTRIES);
static FRICTION_NAMES: [&str; FRICTION_LAWS] = names(&FRICTION_TABLES);
static FRICTION_RULES: [Rule; 1] = [Rule::OneOf(&FRICTION_NAMES)];
static FRICTION_KEYS: [Key; FRICTION_LAWS + 1] = keys(&FRICTION_TABLES, &FRICTION_HISTORY);
pub(in crate::scene) const FRICTION: Table =
    Table::new("friction", "Law of friction, exactly one, and how it changes.", &FRICTION_KEYS)
        .rules(&FRICTION_RULES);

const WEAR_LAWS: usize = wear::ENTRIES.len();
static WEAR_TABLES: [Table; WEAR_LAWS] = tables(wear::ENTRIES);
static WEAR_NAMES: [&str; WEAR_LAWS] = names(&WEAR_TABLES);
static WEAR_RULES: [Rule; 1] = [Rule::OneOf(&WEAR_NAMES)];
static WEAR_KEYS: [Key; WEAR_LAWS + 1] = keys(&WEAR_TABLES, &WEAR_HISTORY);
pub(in crate::scene) const WEAR: Table =
    Table::new("wear", "Law of wear, exactly one, and how it changes.", &WEAR_KEYS).rules(&WEAR_RULES);

const ABOUT_HISTORY: &str = "A factor on the coefficients along the cycles.";
const FINAL_FACTOR: Key =
    Key::number("final_factor", "Factor after a long time, approached exponentially from 1.")
        .example("0.5")
        .optional();
const FACTOR: Key = positive("factor", "Factor.");
const TIME: Key = Key::number("time", "Time.").range(Range::NOT_NEGATIVE);
const fn history(last: Key) -> [Key; 6] {
    [last, HISTORY[0], HISTORY[1], HISTORY[2], HISTORY[3], HISTORY[4]]
}
const HISTORY: [Key; 5] = [
    positive("cycles", "Cycles after which 1/e of the change is left.").example("1e5").optional(),
    positive("tau", "The same as dimensionless time.").example("3").optional(),
    Key::new("factors", Kind::List(&FACTOR, [1, MOST_TIMES]), "Factors at the times, linear between them.")
        .example("[1, 0.5]")
        .optional(),
    Key::new("at_cycles", Kind::List(&TIME, [1, MOST_TIMES]), "Times of the factors in cycles, increasing.")
        .example("[0, 1e5]")
        .optional(),
    Key::new("at_tau", Kind::List(&TIME, [1, MOST_TIMES]), "The same as dimensionless times.")
        .example("[0, 10]")
        .optional(),
];
const HISTORY_FORMS: &[Rule] = &[Rule::Forms(&[
    Form::new(&["final_factor", "cycles"]),
    Form::new(&["final_factor", "tau"]),
    Form::new(&["factors", "at_cycles"]),
    Form::new(&["factors", "at_tau"]),
])];
const FRICTION_HISTORY: Table =
    Table::new("history", ABOUT_HISTORY, &history(FINAL_FACTOR.range(Range::POSITIVE))).rules(HISTORY_FORMS);
const WEAR_HISTORY: Table =
    Table::new("history", ABOUT_HISTORY, &history(FINAL_FACTOR.range(Range::NOT_NEGATIVE)))
        .rules(HISTORY_FORMS);
