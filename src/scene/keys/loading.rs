//! Load, amplitude and end; control, mode and blocks.

use super::tables::{keys, names, tables};
use crate::laws::loading::Duration;
use crate::laws::motion;
use crate::units::{Dimension, Form, Key, Kind, Range, Rule, Table};

/// Most times of a history, and most blocks.
pub(in crate::scene) const MOST_TIMES: usize = 10_000;

pub(in crate::scene) const LOADING: Table = Table::new(
    "loading",
    "Load, amplitude and end: exactly one of each; control, mode and blocks.",
    &LOADING_KEYS,
)
.rules(&LOADING_RULES);

const OWN_KEYS: [Key; 17] = [
    INDENTATION,
    INITIAL_FORCE,
    NORMAL_FORCE,
    AMPLITUDE,
    STROKE,
    TANGENTIAL_FORCE,
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
    FREQUENCY,
    WEAR_FROM,
];

const MODES: usize = motion::ENTRIES.len();
static MODE_TABLES: [Table; MODES] = tables(motion::ENTRIES);
static MODE_NAMES: [&str; MODES] = names(&MODE_TABLES);
static LOADING_KEYS: [Key; OWN_KEYS.len() + MODES] = keys(&OWN_KEYS, &MODE_TABLES, &[]);
static LOADING_RULES: [Rule; 6] = [
    Rule::OneOf(&["indentation", "initial_force", "normal_force"]),
    Rule::OneOf(&AMPLITUDES),
    Rule::OneOf(&["cycles", "tau", "until_rate"]),
    Rule::AtMostOneOf(&MODE_NAMES),
    Rule::Needs("repeat", "blocks"),
    Rule::Words(
        "tangential_control",
        &[("displacement", Form::NONE), ("force", Form::NONE), ("rig", Form::new(&["rig_stiffness"]))],
    ),
];

/// What decides the tangential amplitude: a key of its own, or a mode.
static AMPLITUDES: [&str; 5 + own_amplitudes()] = {
    let mut names = ["amplitude"; 5 + own_amplitudes()];
    (names[1], names[2]) = ("stroke", "tangential_force");
    (names[3], names[4]) = ("amplitude_ratio", "stick_ratio");
    let (mut place, mut mode) = (5, 0);
    while mode < MODES {
        if motion::ENTRIES[mode].gives_amplitude {
            names[place] = motion::ENTRIES[mode].name;
            place += 1;
        }
        mode += 1;
    }
    names
};

const fn own_amplitudes() -> usize {
    let (mut count, mut mode) = (0, 0);
    while mode < MODES {
        count += motion::ENTRIES[mode].gives_amplitude as usize;
        mode += 1;
    }
    count
}

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
pub(in crate::scene) const STROKE: Key = length("stroke", "Stroke from end to end, twice the amplitude, m.")
    .aliases(&["peak_to_peak", "travel"])
    .range(Range::NOT_NEGATIVE)
    .example("0.6 um");
pub(in crate::scene) const TANGENTIAL_FORCE: Key = force(
    "tangential_force",
    "Amplitude of the tangential force, N; held, so that the amplitude of the displacement follows. Below μ_f times the normal force.",
)
.aliases(&["shear_force", "F_x"]);
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

pub(in crate::scene) const FREQUENCY: Key = Key::quantity(
    "frequency",
    Dimension::FREQUENCY,
    "Cycles per second, Hz; laws of the friction power need it.",
)
.range(Range::POSITIVE)
.example("10 Hz")
.optional();

pub(in crate::scene) const WEAR_FROM: Key = Key::new(
    "wear_from",
    Kind::Word(&["settled", "first-cycle"]),
    "From when on wear counts: after frictional shakedown, or from the first loading on, which is a quarter of a cycle more.",
)
.default("settled");

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
