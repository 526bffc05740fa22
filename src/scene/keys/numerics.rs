//! How it is computed, and what is kept.

use crate::scene::{Cycle, FINEST_ACCURACY, MOST_SNAPSHOTS, MOST_SUBSTEPS, Stepper};
use crate::solver::model::FEWEST_SPRINGS;
use crate::units::{Dimension, Key, Kind, Range, Rule, Table};

pub(in crate::scene) const NUMERICS: Table = Table::new(
    "numerics",
    "How it is computed; every key has a default that serves.",
    &[ACCURACY, SPRINGS, STEPPER, TOLERANCE, CHECKPOINT_INTERVAL, CYCLE, SUBSTEPS],
);

pub(in crate::scene) const ACCURACY: Key = Key::number(
    "accuracy",
    "Error asked of worn volume and profile at every snapshot; decides what is not given by hand.",
)
.range(Range::at_least(FINEST_ACCURACY).to(0.1))
.default("1e-4");
pub(in crate::scene) const SPRINGS: Key =
    Key::new("springs", Kind::Whole, "Springs over the slip annulus, by hand.")
        .aliases(&["nodes", "elements"])
        .range(Range::at_least(FEWEST_SPRINGS as f64))
        .example("64")
        .optional();
pub(in crate::scene) const STEPPER: Key =
    Key::new("stepper", Kind::Word(&Stepper::WORDS), "Method of time stepping.").default("implicit");
pub(in crate::scene) const TOLERANCE: Key =
    Key::number("tolerance", "Tolerance of a step relative to the limit's largest depth, by hand.")
        .range(Range::above(0.0).to(0.1))
        .example("1e-5")
        .optional();
/// The upper end, some thirty years, keeps it within what a clock can count.
pub(in crate::scene) const CHECKPOINT_INTERVAL: Key =
    Key::quantity("checkpoint_interval", Dimension::TIME, "Wall time between checkpoints, s.")
        .range(Range::at_least(0.0).to(1e9))
        .default("30 s");
pub(in crate::scene) const CYCLE: Key = Key::new(
    "cycle",
    Kind::Word(&Cycle::WORDS),
    "How the slip of a cycle is found; by formula where that is exact, else resolved.",
)
.optional();
pub(in crate::scene) const SUBSTEPS: Key =
    Key::new("substeps", Kind::Whole, "Substeps of one period where it is resolved.")
        .range(Range::at_least(2.0).to(MOST_SUBSTEPS as f64))
        .example("192")
        .optional();

pub(in crate::scene) const OUTPUT: Table = Table::new(
    "output",
    "When snapshots are taken, besides the start and the end.",
    &[SNAPSHOTS, AT_CYCLES, AT_TAU],
)
.rules(&[Rule::AtMostOneOf(&["snapshots", "at_cycles", "at_tau"])]);

pub(in crate::scene) const SNAPSHOTS: Key = Key::new(
    "snapshots",
    Kind::Whole,
    "Number of snapshots after the start, spread geometrically in cycles.",
)
.range(Range::at_least(1.0).to(MOST_SNAPSHOTS as f64))
.default("50");
const TIMES: Kind = Kind::List(&TIME, [0, MOST_SNAPSHOTS]);
pub(in crate::scene) const AT_CYCLES: Key =
    Key::new("at_cycles", TIMES, "Numbers of cycles at which snapshots are taken.")
        .example("[1e3, 1e5]")
        .optional();
pub(in crate::scene) const AT_TAU: Key =
    Key::new("at_tau", TIMES, "Dimensionless times at which snapshots are taken.")
        .example("[0.1, 1, 10]")
        .optional();
pub(in crate::scene) const TIME: Key = Key::number("time", "Time.").range(Range::NOT_NEGATIVE);
