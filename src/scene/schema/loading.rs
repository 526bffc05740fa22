//! The table `[loading]` of a scene.

use serde_json::{Value, json};

use super::keys::{
    Table, above_zero, any, at_least_zero, at_most_one_of, list, number, one_form, one_of, or, quantity,
    switch, text, word,
};
use crate::laws::loading::Duration;
use crate::scene::laws::MOST_TIMES;

pub(super) fn loading() -> Table {
    let force = |about: &str| quantity(about, "N", above_zero(), "10 N");
    let keys = vec![
        ("indentation", quantity("Indentation depth d, m; held.", "m", above_zero(), "1 um")),
        (
            "initial_force",
            force("Normal force that presses the unworn indenter, N; the indentation found so is held."),
        ),
        ("normal_force", force("Normal force, N; held, so that the indentation grows as the contact wears.")),
        (
            "amplitude",
            quantity("Tangential amplitude U, half the stroke, m.", "m", at_least_zero(), "0.3 um"),
        ),
        ("amplitude_ratio", number("U/(μ_f d).", at_least_zero())),
        (
            "stick_ratio",
            number(
                "Stick radius over contact radius of the first cycle, c/a0.",
                json!({ "exclusiveMinimum": 0, "maximum": 1 }),
            ),
        ),
        ("cycles", number("Number of cycles to the end.", above_zero())),
        ("tau", number("Dimensionless time to the end; some 30 is near the limit.", above_zero())),
        (
            "until_rate",
            number(
                "The run ends when the rate of worn volume has fallen to this fraction of its first.",
                json!({ "minimum": Duration::SMALLEST_RATE, "exclusiveMaximum": 1 }),
            ),
        ),
        (
            "tangential_control",
            or(
                word("What is held of the tangential oscillation.", &["displacement", "force", "rig"]),
                "displacement",
            ),
        ),
        (
            "rig_stiffness",
            quantity(
                "Stiffness of the rig, whose far end moves by the amplitude, N/m.",
                "N m-1",
                above_zero(),
                "5 MN/m",
            ),
        ),
        (
            "blocks",
            list("Blocks of cycles, one after the other; the last goes on.", block(), [1, MOST_TIMES]),
        ),
        ("repeat", or(switch("After the last block the first one again."), false)),
        ("normal_oscillation", normal_oscillation()),
        ("orbit", orbit()),
        ("path", path()),
    ];
    Table::new("Load, amplitude and end: exactly one of each; control, mode and blocks.", keys)
        .rule(one_of(&["indentation", "initial_force", "normal_force"]))
        .rule(one_of(&["amplitude", "amplitude_ratio", "stick_ratio", "path"]))
        .rule(one_of(&["cycles", "tau", "until_rate"]))
        .rule(at_most_one_of(&["normal_oscillation", "orbit", "path"]))
        .rule(json!({ "dependencies": {
            "repeat": ["blocks"],
            "rig_stiffness": { "properties": { "tangential_control": { "const": "rig" } } },
        } }))
        .rule(json!({
            "if": { "properties": { "tangential_control": { "const": "rig" } }, "required": ["tangential_control"] },
            "then": { "required": ["rig_stiffness"] },
        }))
}

fn block() -> Value {
    let factor = |about: &str, limits| or(number(about, limits), 1);
    Table::new(
        "Cycles of one amplitude and indentation.",
        vec![
            ("cycles", number("How many cycles.", above_zero())),
            ("tau", number("How long, as dimensionless time.", above_zero())),
            ("amplitude_factor", factor("Factor on the amplitude.", at_least_zero())),
            ("indentation_factor", factor("Factor on the indentation.", above_zero())),
        ],
    )
    .rule(one_of(&["cycles", "tau"]))
    .whole()
}

fn phase(about: &str) -> Value {
    or(quantity(about, "rad", any(), "35 deg"), 0)
}

fn normal_oscillation() -> Value {
    let ratio = json!({
        "description": "Normal oscillations per tangential one, a ratio of whole numbers up to 64.",
        "anyOf": [
            { "type": "number", "exclusiveMinimum": 0 },
            { "type": "string", "pattern": r"^\s*\+?[0-9.]" },
        ],
        "examples": [2, "3/2"],
    });
    let amplitude = quantity("Amplitude d1, m, below the indentation.", "m", above_zero(), "0.1 um");
    let amplitude_ratio =
        number("d1 over the indentation.", json!({ "exclusiveMinimum": 0, "exclusiveMaximum": 1 }));
    Table::new(
        "The indentation oscillates too.",
        vec![
            ("amplitude", amplitude),
            ("amplitude_ratio", amplitude_ratio),
            ("frequency_ratio", ratio),
            ("phase", phase("Phase against the tangential oscillation, rad.")),
        ],
    )
    .requires(&["frequency_ratio"])
    .rule(one_of(&["amplitude", "amplitude_ratio"]))
    .whole()
}

fn orbit() -> Value {
    let centre = |axis: &str| {
        or(quantity(&format!("Where the indenter was pressed on, along {axis}, m."), "m", any(), "0.1 um"), 0)
    };
    Table::new(
        "The indenter moves along x and y.",
        vec![
            ("transverse_amplitude", quantity("Amplitude along y, m.", "m", above_zero(), "0.1 um")),
            ("transverse_ratio", number("Amplitude along y over that along x.", above_zero())),
            ("phase", phase("Phase of the motion along y, rad; 0 is an ellipse with the axes x and y.")),
            ("centre_x", centre("x")),
            ("centre_y", centre("y")),
        ],
    )
    .rule(one_form(&[
        (&["transverse_amplitude"], &["transverse_ratio"]),
        (&["transverse_ratio"], &["transverse_amplitude"]),
    ]))
    .whole()
}

fn path() -> Value {
    let file = text(
        "File of columns x, y and, if it changes, the indentation over that of the scene; relative to the scene.",
    );
    Table::new(
        "The indenter follows a recorded path; the amplitude is left out.",
        vec![("file", file), ("displacement_unit", or(text("Unit of all columns, a length."), "m"))],
    )
    .requires(&["file"])
    .whole()
}
