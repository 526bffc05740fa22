//! The indenter, friction and wear.

use super::loading::MOST_TIMES;
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

const COULOMB: Table = Table::new(
    "coulomb",
    "Coulomb's law.",
    &[positive("coefficient", "Friction coefficient.").example("0.6")],
);
const STATIC_KINETIC: Table = Table::new(
    "static-kinetic",
    "Springs are held harder while they stick than while they slip.",
    &[
        positive("static_coefficient", "Coefficient while a spring sticks.").example("0.7"),
        positive("kinetic_coefficient", "Coefficient while it slips, not above the static one.")
            .example("0.6"),
    ],
);
const LOAD_DEPENDENT: Table = Table::new(
    "load-dependent",
    "Coefficient (q/reference)^exponent of the compression q of a spring.",
    &[
        positive("coefficient", "Coefficient at the reference compression.").example("0.6"),
        Key::number("exponent", "Exponent; 0 is Coulomb's law.").range(Range::above(-1.0)).example("-0.1"),
        length("reference_compression", "Compression of reference, m; by default the indentation.")
            .example("1 um")
            .optional(),
    ],
);

pub(in crate::scene) const FRICTION: Table = Table::new(
    "friction",
    "Law of friction, exactly one, and how it changes.",
    &[
        Key::table(&COULOMB).optional(),
        Key::table(&STATIC_KINETIC).optional(),
        Key::table(&LOAD_DEPENDENT).optional(),
        Key::table(&FRICTION_HISTORY).optional(),
    ],
)
.rules(&[Rule::OneOf(&["coulomb", "static-kinetic", "load-dependent"])]);

const COEFFICIENT: Key = Key::quantity(
    "coefficient",
    Dimension::INVERSE_PRESSURE,
    "Depth per sliding distance and pressure, 1/Pa or m³/(N m).",
)
.range(Range::POSITIVE)
.example("1e-8 1/MPa");

const ARCHARD: Table = Table::new("archard", "Archard's law.", &[COEFFICIENT]);
const DISSIPATED_ENERGY: Table = Table::new(
    "dissipated-energy",
    "Volume by the energy that friction dissipates.",
    &[Key::quantity("coefficient", Dimension::INVERSE_PRESSURE, "Volume per energy, m³/J.")
        .unit("m3 J-1")
        .range(Range::POSITIVE)
        .example("2e-5 mm^3/J")],
);
const POWER_LAW: Table = Table::new(
    "power-law",
    "Depth per cycle as pressure^α slip^β.",
    &[
        positive("coefficient", "Coefficient in Pa^-α m^(1-β), a plain number.").example("1e-14"),
        positive("pressure_exponent", "Exponent α; 1 is Archard's law.").example("1"),
        positive("slip_exponent", "Exponent β; 1 is Archard's law.").example("1"),
    ],
);
const THRESHOLD: Table = Table::new(
    "threshold",
    "Archard's law above a pressure.",
    &[
        COEFFICIENT,
        Key::quantity("pressure", Dimension::PRESSURE, "Pressure below which nothing wears, Pa.")
            .range(Range::POSITIVE)
            .example("50 MPa"),
    ],
);
const NON_LOCAL: Table = Table::new(
    "non-local",
    "Archard's law, spread over a length.",
    &[COEFFICIENT, length("length", "Length over which wear spreads, m.").example("5 um")],
);

pub(in crate::scene) const WEAR: Table = Table::new(
    "wear",
    "Law of wear, exactly one, and how it changes.",
    &[
        Key::table(&ARCHARD).optional(),
        Key::table(&DISSIPATED_ENERGY).optional(),
        Key::table(&POWER_LAW).optional(),
        Key::table(&THRESHOLD).optional(),
        Key::table(&NON_LOCAL).optional(),
        Key::table(&WEAR_HISTORY).optional(),
    ],
)
.rules(&[Rule::OneOf(&["archard", "dissipated-energy", "power-law", "threshold", "non-local"])]);

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
