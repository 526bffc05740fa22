//! The tables of a scene.

use serde_json::{Value, json};

use super::keys::{
    Table, above_zero, at_least_zero, at_most_one_of, line, list, number, one_form, one_of, or, quantity,
    text, whole, word,
};
use super::loading::loading;
use crate::scene::laws::MOST_TIMES;
use crate::scene::{Cycle, MOST_SNAPSHOTS, MOST_SUBSTEPS, Stepper, WearFrom};

/// The scene.
pub(super) fn scene() -> Table {
    let mut keys = vec![("title", line("Title, one line; stored in the result."))];
    keys.extend(tables().into_iter().map(|(name, table)| (name, table.whole())));
    Table::new("A scene: what is pressed on what, how it moves and for how long.", keys).requires(&[
        "indenter",
        "half_space",
        "friction",
        "wear",
        "loading",
    ])
}

/// Any part of a scene, as a patch lays it over another.
pub(super) fn patch(about: &str) -> Value {
    let mut keys = vec![("title", line("Title, one line."))];
    keys.extend(tables().into_iter().map(|(name, table)| (name, table.partial())));
    Table::new(about, keys).partial()
}

fn tables() -> Vec<(&'static str, Table)> {
    vec![
        ("indenter", indenter()),
        ("half_space", body("Elastic half-space E = E0 (z/z0)^k.").requires(&["grading"])),
        (
            "counter_body",
            body(
                "The indenter is elastic too; its grading is that of the half-space, and the stiffnesses act in series.",
            ),
        ),
        ("friction", friction()),
        ("wear", wear()),
        ("loading", loading()),
        ("numerics", numerics()),
        ("output", output()),
    ]
}

fn indenter() -> Table {
    let radius = |about: &str| quantity(about, "m", above_zero(), "10 mm");
    let unit = |of: &str| or(text(&format!("Unit of {of}, a length.")), "m");
    let shape = |about: &str, keys, required: &[&'static str]| Table::new(about, keys).requires(required);
    let paraboloid = shape(
        "f = r²/(2R).",
        vec![("radius", radius("Radius of curvature R of f = r²/(2R), m."))],
        &["radius"],
    );
    let sphere = shape("f = R - √(R² - r²).", vec![("radius", radius("Radius R, m."))], &["radius"]);
    let cone = Table::new(
        "f = r tan θ.",
        vec![
            ("slope", number("Slope tan θ of the flank against the surface.", above_zero())),
            ("half_angle", quantity("Angle between axis and flank, rad.", "rad", above_zero(), "85 deg")),
        ],
    );
    let cone = cone.rule(one_of(&["slope", "half_angle"]));
    let power_law = shape(
        "f = coefficient r^exponent.",
        vec![
            ("coefficient", quantity("Coefficient A of f = A r^n, m^(1-n).", "1", above_zero(), "50 1/m")),
            ("exponent", number("Exponent n: 1 is a cone, 2 a paraboloid.", above_zero())),
        ],
        &["coefficient", "exponent"],
    );
    let table = shape(
        "A measured profile.",
        vec![
            (
                "file",
                text("File of two columns r and f, from the tip at r = 0 outwards; relative to the scene."),
            ),
            ("radius_unit", unit("the radii")),
            ("profile_unit", unit("the heights")),
            (
                "smoothing",
                quantity(
                    "Standard deviation of the noise in the heights, m: the profile is the smoothest curve with such residuals. 0 takes the rows as \
                     they are.",
                    "m",
                    at_least_zero(),
                    "20 nm",
                ),
            ),
        ],
        &["file"],
    );
    Table::new(
        "Shape of the indenter, exactly one.",
        vec![
            ("paraboloid", paraboloid.whole()),
            ("sphere", sphere.whole()),
            ("cone", cone.whole()),
            ("power-law", power_law.whole()),
            ("table", table.whole()),
        ],
    )
    .rule(json!({ "minProperties": 1, "maxProperties": 1 }))
}

/// Poisson's ratio; what is possible depends on the grading.
pub(super) fn poisson_ratio() -> Value {
    let mut value = number(
        "Poisson's ratio, or \"similar\" for elastic similarity, 1/(2+k).",
        json!({ "exclusiveMinimum": -1, "maximum": 0.5 }),
    );
    value["anyOf"][1] = json!({ "const": "similar" });
    value
}

fn body(about: &str) -> Table {
    let keys = vec![
        (
            "grading",
            number(
                "Exponent k of E = E0 (z/z0)^k; 0 is homogeneous.",
                json!({ "exclusiveMinimum": -1, "exclusiveMaximum": 1 }),
            ),
        ),
        (
            "modulus",
            quantity("Young's modulus E0 at the reference depth, Pa.", "Pa", above_zero(), "210 GPa"),
        ),
        ("reference_depth", or(quantity("Depth z0 at which E is E0, m.", "m", above_zero(), "2 mm"), "1 m")),
        ("poisson_ratio", poisson_ratio()),
        (
            "normal_stiffness",
            quantity("Normal stiffness c_N of the springs, N/m^(2+k).", "1", above_zero(), "2.3e11 N/m^2"),
        ),
        (
            "stiffness_ratio",
            number(
                "Tangential over normal stiffness, M; by default that of elastic similarity.",
                above_zero(),
            ),
        ),
    ];
    Table::new(about, keys).rule(one_form(&[
        (&["modulus", "poisson_ratio"], &["normal_stiffness", "stiffness_ratio"]),
        (&["normal_stiffness"], &["modulus", "reference_depth", "poisson_ratio"]),
    ]))
}

fn friction() -> Table {
    let coefficient = |about: &str| number(about, above_zero());
    let coulomb = Table::new("Coulomb's law.", vec![("coefficient", coefficient("Friction coefficient."))])
        .requires(&["coefficient"]);
    let static_kinetic = Table::new(
        "Springs are held harder while they stick than while they slip.",
        vec![
            ("static_coefficient", coefficient("Coefficient while a spring sticks.")),
            ("kinetic_coefficient", coefficient("Coefficient while it slips, not above the static one.")),
        ],
    )
    .requires(&["static_coefficient", "kinetic_coefficient"]);
    let exponent = json!({ "exclusiveMinimum": -1 });
    let load_dependent = Table::new(
        "Coefficient (q/reference)^exponent of the compression q of a spring.",
        vec![
            ("coefficient", coefficient("Coefficient at the reference compression.")),
            ("exponent", number("Exponent; 0 is Coulomb's law.", exponent)),
            (
                "reference_compression",
                quantity(
                    "Compression of reference, m; by default the indentation.",
                    "m",
                    above_zero(),
                    "1 um",
                ),
            ),
        ],
    )
    .requires(&["coefficient", "exponent"]);
    let keys = vec![
        ("coulomb", coulomb.whole()),
        ("static-kinetic", static_kinetic.whole()),
        ("load-dependent", load_dependent.whole()),
        ("history", history(above_zero())),
    ];
    Table::new("Law of friction, exactly one, and how it changes.", keys).rule(one_of(&[
        "coulomb",
        "static-kinetic",
        "load-dependent",
    ]))
}

fn wear() -> Table {
    let per_pressure = |about: &str, unit: &str, example: &str| quantity(about, unit, above_zero(), example);
    let coefficient =
        || per_pressure("Depth per sliding distance and pressure, 1/Pa or m³/(N m).", "Pa-1", "1e-8 1/MPa");
    let law =
        |about: &str, keys, required: &[&'static str]| Table::new(about, keys).requires(required).whole();
    let keys = vec![
        ("archard", law("Archard's law.", vec![("coefficient", coefficient())], &["coefficient"])),
        (
            "dissipated-energy",
            law(
                "Volume by the energy that friction dissipates.",
                vec![("coefficient", per_pressure("Volume per energy, m³/J.", "m3 J-1", "2e-5 mm^3/J"))],
                &["coefficient"],
            ),
        ),
        (
            "power-law",
            law(
                "Depth per cycle as pressure^α slip^β.",
                vec![
                    ("coefficient", number("Coefficient in Pa^-α m^(1-β), a plain number.", above_zero())),
                    ("pressure_exponent", number("Exponent α; 1 is Archard's law.", above_zero())),
                    ("slip_exponent", number("Exponent β; 1 is Archard's law.", above_zero())),
                ],
                &["coefficient", "pressure_exponent", "slip_exponent"],
            ),
        ),
        (
            "threshold",
            law(
                "Archard's law above a pressure.",
                vec![
                    ("coefficient", coefficient()),
                    (
                        "pressure",
                        quantity("Pressure below which nothing wears, Pa.", "Pa", above_zero(), "50 MPa"),
                    ),
                ],
                &["coefficient", "pressure"],
            ),
        ),
        (
            "non-local",
            law(
                "Archard's law, spread over a length.",
                vec![
                    ("coefficient", coefficient()),
                    ("length", quantity("Length over which wear spreads, m.", "m", above_zero(), "5 um")),
                ],
                &["coefficient", "length"],
            ),
        ),
        ("history", history(at_least_zero())),
    ];
    Table::new("Law of wear, exactly one, and how it changes.", keys).rule(one_of(&[
        "archard",
        "dissipated-energy",
        "power-law",
        "threshold",
        "non-local",
    ]))
}

/// How a coefficient changes along the cycles.
fn history(limits: Value) -> Value {
    let times = |about: &str| list(about, number("Time.", at_least_zero()), [1, MOST_TIMES]);
    let factors = number("Factor.", above_zero());
    Table::new(
        "A factor on the coefficients along the cycles.",
        vec![
            ("final_factor", number("Factor after a long time, approached exponentially from 1.", limits)),
            ("cycles", number("Cycles after which 1/e of the change is left.", above_zero())),
            ("tau", number("The same as dimensionless time.", above_zero())),
            ("factors", list("Factors at the times, linear between them.", factors, [1, MOST_TIMES])),
            ("at_cycles", times("Times of the factors in cycles, increasing.")),
            ("at_tau", times("The same as dimensionless times.")),
        ],
    )
    .rule(one_form(&[
        (&["final_factor", "cycles"], &["tau", "factors", "at_cycles", "at_tau"]),
        (&["final_factor", "tau"], &["cycles", "factors", "at_cycles", "at_tau"]),
        (&["factors", "at_cycles"], &["at_tau", "final_factor", "cycles", "tau"]),
        (&["factors", "at_tau"], &["at_cycles", "final_factor", "cycles", "tau"]),
    ]))
    .whole()
}

fn numerics() -> Table {
    let steppers = Stepper::ALL.map(Stepper::name);
    let keys = vec![
        (
            "accuracy",
            or(
                number(
                    "Error asked of worn volume and profile at every snapshot; decides what is not given by hand.",
                    json!({ "minimum": 1e-10, "maximum": 0.1 }),
                ),
                1e-4,
            ),
        ),
        ("springs", whole("Springs over the slip annulus, by hand.", 3, None)),
        ("stepper", or(word("Method of time stepping.", &steppers), Stepper::default().name())),
        (
            "tolerance",
            number(
                "Tolerance of a step relative to the limit's largest depth, by hand.",
                json!({ "exclusiveMinimum": 0, "maximum": 0.1 }),
            ),
        ),
        (
            "checkpoint_interval",
            or(
                quantity(
                    "Wall time between checkpoints, s.",
                    "s",
                    json!({ "minimum": 0, "maximum": 1e9 }),
                    "30 s",
                ),
                30.0,
            ),
        ),
        (
            "cycle",
            word(
                "How the slip of a cycle is found; by formula where that is exact, else resolved.",
                &[Cycle::ClosedForm, Cycle::Resolved].map(Cycle::name),
            ),
        ),
        ("substeps", whole("Substeps of one period where it is resolved.", 2, Some(MOST_SUBSTEPS))),
        (
            "wear_from",
            or(
                word(
                    "From when on a resolved cycle wears.",
                    &[WearFrom::Shakedown, WearFrom::FirstCycle].map(WearFrom::name),
                ),
                WearFrom::default().name(),
            ),
        ),
    ];
    Table::new("How it is computed; every key has a default that serves.", keys)
}

fn output() -> Table {
    let times = |about: &str| list(about, number("Time.", at_least_zero()), [0, MOST_SNAPSHOTS]);
    let snapshots = whole(
        "Number of snapshots after the start, spread geometrically in cycles.",
        1,
        Some(MOST_SNAPSHOTS),
    );
    let keys = vec![
        ("snapshots", or(snapshots, 50)),
        ("at_cycles", times("Numbers of cycles at which snapshots are taken.")),
        ("at_tau", times("Dimensionless times at which snapshots are taken.")),
    ];
    Table::new("When snapshots are taken, besides the start and the end.", keys).rule(at_most_one_of(&[
        "snapshots",
        "at_cycles",
        "at_tau",
    ]))
}
