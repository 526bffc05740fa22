//! Load, amplitude and end; control, mode and blocks.

use crate::laws::loading::Duration;
use crate::units::{Dimension, Form, Key, Kind, Range, Rule, Table};

/// Most times of a history, and most blocks.
pub(in crate::scene) const MOST_TIMES: usize = 10_000;

pub(in crate::scene) const LOADING: Table = Table::new(
    "loading",
    "Load, amplitude and end: exactly one of each; control, mode and blocks.",
    &[
        INDENTATION,
        INITIAL_FORCE,
        NORMAL_FORCE,
        AMPLITUDE,
        AMPLITUDE_RATIO,
        STICK_RATIO,
        CYCLES,
        TAU,
        UNTIL_RATE,
        TANGENTIAL_CONTROL,
        RIG_STIFFNESS,
        Key::new(
            "blocks",
            Kind::Tables(&BLOCK, [1, MOST_TIMES]),
            "Blocks of cycles, one after the other; the last goes on.",
        )
        .example("[[loading.blocks]] with cycles and amplitude_factor")
        .optional(),
        REPEAT,
        Key::table(&NORMAL_OSCILLATION).optional(),
        Key::table(&ORBIT).optional(),
        Key::table(&PATH).optional(),
    ],
)
.rules(&[
    Rule::OneOf(&["indentation", "initial_force", "normal_force"]),
    Rule::OneOf(&["amplitude", "amplitude_ratio", "stick_ratio", "path"]),
    Rule::OneOf(&["cycles", "tau", "until_rate"]),
    Rule::AtMostOneOf(&["normal_oscillation", "orbit", "path"]),
    Rule::Needs("repeat", "blocks"),
    Rule::Words(
        "tangential_control",
        &[("displacement", Form::NONE), ("force", Form::NONE), ("rig", Form::new(&["rig_stiffness"]))],
    ),
]);

const fn force(name: &'static str, about: &'static str) -> Key {
    Key::quantity(name, Dimension::FORCE, about).range(Range::POSITIVE).example("10 N").optional()
}

const fn length(name: &'static str, about: &'static str) -> Key {
    Key::quantity(name, Dimension::LENGTH, about).range(Range::POSITIVE).optional()
}

const fn positive(name: &'static str, about: &'static str) -> Key {
    Key::number(name, about).range(Range::POSITIVE).optional()
}

pub(in crate::scene) const INDENTATION: Key =
    length("indentation", "Indentation depth d, m; held.").aliases(&["depth", "d"]).example("1 um");
pub(in crate::scene) const INITIAL_FORCE: Key = force(
    "initial_force",
    "Normal force that presses the unworn indenter, N; the indentation found so is held.",
)
.aliases(&["force", "load"]);
pub(in crate::scene) const NORMAL_FORCE: Key =
    force("normal_force", "Normal force, N; held, so that the indentation grows as the contact wears.")
        .aliases(&["normal_load"]);

pub(in crate::scene) const AMPLITUDE: Key =
    length("amplitude", "Tangential amplitude U, half the stroke, m.")
        .aliases(&["displacement", "displacement_amplitude", "U"])
        .range(Range::NOT_NEGATIVE)
        .example("0.3 um");
pub(in crate::scene) const AMPLITUDE_RATIO: Key =
    positive("amplitude_ratio", "U/(μ_f d).").range(Range::NOT_NEGATIVE).example("0.5");
pub(in crate::scene) const STICK_RATIO: Key =
    positive("stick_ratio", "Stick radius over contact radius of the first cycle, c/a0.")
        .range(Range::above(0.0).to(1.0))
        .example("0.7");

pub(in crate::scene) const CYCLES: Key = positive("cycles", "Number of cycles to the end.").example("1e6");
pub(in crate::scene) const TAU: Key =
    positive("tau", "Dimensionless time to the end; some 30 is near the limit.").example("30");
pub(in crate::scene) const UNTIL_RATE: Key =
    positive("until_rate", "The run ends when the rate of worn volume has fallen to this fraction of its first.")
        .range(Range::at_least(Duration::SMALLEST_RATE).below(1.0))
        .because("below, the rate of worn volume is the rounding of what is left of the pressure: give loading.tau instead")
        .example("1e-6");

pub(in crate::scene) const TANGENTIAL_CONTROL: Key = Key::new(
    "tangential_control",
    Kind::Word(&["displacement", "force", "rig"]),
    "What is held of the tangential oscillation.",
)
.default("displacement");
pub(in crate::scene) const RIG_STIFFNESS: Key = Key::quantity(
    "rig_stiffness",
    Dimension::STIFFNESS,
    "Stiffness of the rig, whose far end moves by the amplitude, N/m.",
)
.range(Range::POSITIVE)
.example("5 MN/m")
.optional();
pub(in crate::scene) const REPEAT: Key =
    Key::new("repeat", Kind::Switch, "After the last block the first one again.").default("false");

pub(in crate::scene) const BLOCK: Table = Table::new(
    "blocks",
    "Cycles of one amplitude and indentation.",
    &[
        positive("cycles", "How many cycles.").example("1e4"),
        positive("tau", "How long, as dimensionless time.").example("2"),
        AMPLITUDE_FACTOR,
        INDENTATION_FACTOR,
    ],
)
.rules(&[Rule::OneOf(&["cycles", "tau"])]);
pub(in crate::scene) const AMPLITUDE_FACTOR: Key =
    Key::number("amplitude_factor", "Factor on the amplitude.").range(Range::NOT_NEGATIVE).default("1");
pub(in crate::scene) const INDENTATION_FACTOR: Key =
    Key::number("indentation_factor", "Factor on the indentation.").range(Range::POSITIVE).default("1");

const NORMAL_OSCILLATION: Table = Table::new(
    "normal_oscillation",
    "The indentation oscillates too.",
    &[
        length("amplitude", "Amplitude d1, m, below the indentation.").example("0.1 um"),
        positive("amplitude_ratio", "d1 over the indentation.")
            .range(Range::above(0.0).below(1.0))
            .example("0.2"),
        Key::new(
            "frequency_ratio",
            Kind::Ratio,
            "Normal oscillations per tangential one, a ratio of whole numbers up to 64.",
        )
        .range(Range::POSITIVE)
        .example("3/2"),
        Key::quantity("phase", Dimension::ANGLE, "Phase against the tangential oscillation, rad.")
            .example("35 deg")
            .default("0 deg"),
    ],
)
.rules(&[Rule::OneOf(&["amplitude", "amplitude_ratio"])]);

const fn centre(name: &'static str, about: &'static str) -> Key {
    Key::quantity(name, Dimension::LENGTH, about).example("0.1 um").default("0 m")
}

const ORBIT: Table = Table::new(
    "orbit",
    "The indenter moves along x and y.",
    &[
        length("transverse_amplitude", "Amplitude along y, m.").example("0.1 um"),
        positive("transverse_ratio", "Amplitude along y over that along x.").example("0.5"),
        Key::quantity(
            "phase",
            Dimension::ANGLE,
            "Phase of the motion along y, rad; 0 is an ellipse with the axes x and y.",
        )
        .example("35 deg")
        .default("0 deg"),
        centre("centre_x", "Where the indenter was pressed on, along x, m."),
        centre("centre_y", "Where the indenter was pressed on, along y, m."),
    ],
)
.rules(&[Rule::OneOf(&["transverse_amplitude", "transverse_ratio"])]);

const PATH: Table = Table::new(
    "path",
    "The indenter follows a recorded path; the amplitude is left out.",
    &[
        Key::new(
            "file",
            Kind::Name,
            "File of columns x, y and, if it changes, the indentation over that of the scene; relative to the scene.",
        )
        .example("path.csv"),
        Key::new("displacement_unit", Kind::Name, "Unit of all columns, a length.").default("m"),
    ],
);
