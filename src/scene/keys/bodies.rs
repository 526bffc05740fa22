//! The elastic bodies.

use crate::units::{Dimension, Form, Key, Kind, Range, Rule, Table};

pub(in crate::scene) const HALF_SPACE: Table = Table::new(
    "half_space",
    "Elastic half-space E = E0 (z/z0)^k.",
    &[GRADING, MODULUS, REFERENCE_DEPTH, POISSON_RATIO, NORMAL_STIFFNESS, STIFFNESS_RATIO],
)
.rules(FORMS);

pub(in crate::scene) const COUNTER_BODY: Table = Table::new(
    "counter_body",
    "The indenter is elastic too; its grading is that of the half-space, and the stiffnesses act in series.",
    &[GRADING.optional(), MODULUS, REFERENCE_DEPTH, POISSON_RATIO, NORMAL_STIFFNESS, STIFFNESS_RATIO],
)
.rules(FORMS);

const FORMS: &[Rule] = &[Rule::Forms(&[
    Form::new(&["modulus", "poisson_ratio"]).may(&["reference_depth"]),
    Form::new(&["normal_stiffness"]).may(&["stiffness_ratio"]),
])];

pub(in crate::scene) const GRADING: Key =
    Key::number("grading", "Exponent k of E = E0 (z/z0)^k; 0 is homogeneous.")
        .aliases(&["k", "exponent"])
        .range(Range::above(-1.0).below(1.0))
        .example("0.2");

pub(in crate::scene) const MODULUS: Key =
    Key::quantity("modulus", Dimension::PRESSURE, "Young's modulus E0 at the reference depth, Pa.")
        .aliases(&["E", "E0", "young", "youngs_modulus", "elastic_modulus"])
        .range(Range::POSITIVE)
        .example("210 GPa")
        .optional();

pub(in crate::scene) const REFERENCE_DEPTH: Key = Key::quantity(
    "reference_depth",
    Dimension::LENGTH,
    "Depth z0 at which E is E0, m; needed beside a modulus where k ≠ 0, of no consequence where k = 0.",
)
.aliases(&["z0", "depth"])
.range(Range::POSITIVE)
.example("2 mm")
.optional();

/// What is possible depends on the grading.
pub(in crate::scene) const POISSON_RATIO: Key = Key::new(
    "poisson_ratio",
    Kind::NumberOr("similar"),
    "Poisson's ratio, or \"similar\" for elastic similarity, 1/(2+k).",
)
.aliases(&["nu", "poisson", "poissons_ratio"])
.range(Range::above(-1.0).to(0.5))
.example("0.3")
.optional();

pub(in crate::scene) const NORMAL_STIFFNESS: Key =
    Key::new("normal_stiffness", Kind::Scaled, "Normal stiffness c_N of the springs, N/m^(2+k).")
        .aliases(&["c_N"])
        .range(Range::POSITIVE)
        .example("2.3e11 N/m^2")
        .optional();

pub(in crate::scene) const STIFFNESS_RATIO: Key = Key::number(
    "stiffness_ratio",
    "Tangential over normal stiffness, M; by default that of elastic similarity.",
)
.aliases(&["M"])
.range(Range::POSITIVE)
.example("0.82")
.optional();
