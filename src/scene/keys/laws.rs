//! The indenter, friction and wear.

use super::loading::MOST_TIMES;
use super::numerics::TIME;
use super::tables::{keys, names, tables};
use crate::contact::indenter;
use crate::laws::{friction, wear};
use crate::units::{Form, Key, Kind, Range, Rule, Table};

const fn positive(name: &'static str, about: &'static str) -> Key {
    Key::number(name, about).range(Range::POSITIVE)
}

const SHAPES: usize = indenter::ENTRIES.len();
static SHAPE_TABLES: [Table; SHAPES] = tables(indenter::ENTRIES);
static SHAPE_NAMES: [&str; SHAPES] = names(&SHAPE_TABLES);
static SHAPE_RULES: [Rule; 1] = [Rule::OneOf(&SHAPE_NAMES)];
static SHAPE_KEYS: [Key; SHAPES] = keys(&[], &SHAPE_TABLES, &[]);
pub(in crate::scene) const INDENTER: Table =
    Table::new("indenter", "Shape of the indenter, exactly one.", &SHAPE_KEYS).rules(&SHAPE_RULES);

const FRICTION_LAWS: usize = friction::ENTRIES.len();
static FRICTION_TABLES: [Table; FRICTION_LAWS] = tables(friction::ENTRIES);
static FRICTION_NAMES: [&str; FRICTION_LAWS] = names(&FRICTION_TABLES);
static FRICTION_RULES: [Rule; 1] = [Rule::OneOf(&FRICTION_NAMES)];
static FRICTION_KEYS: [Key; FRICTION_LAWS + 1] =
    keys(&[], &FRICTION_TABLES, &[Key::table(&FRICTION_HISTORY).optional()]);
pub(in crate::scene) const FRICTION: Table =
    Table::new("friction", "Law of friction, exactly one, and how it changes.", &FRICTION_KEYS)
        .rules(&FRICTION_RULES);

const WEAR_LAWS: usize = wear::ENTRIES.len();
static WEAR_TABLES: [Table; WEAR_LAWS] = tables(wear::ENTRIES);
static WEAR_NAMES: [&str; WEAR_LAWS] = names(&WEAR_TABLES);
static WEAR_RULES: [Rule; 1] = [Rule::OneOf(&WEAR_NAMES)];
static WEAR_KEYS: [Key; WEAR_LAWS + 1] = keys(&[], &WEAR_TABLES, &[Key::table(&WEAR_HISTORY).optional()]);
pub(in crate::scene) const WEAR: Table =
    Table::new("wear", "Law of wear, exactly one, and how it changes.", &WEAR_KEYS).rules(&WEAR_RULES);

const ABOUT_HISTORY: &str = "A factor on the coefficients along the cycles.";
const FINAL_FACTOR: Key =
    Key::number("final_factor", "Factor after a long time, approached exponentially from 1.")
        .example("0.5")
        .optional();
pub(in crate::scene) const HISTORY_FACTOR: Key = positive("factor", "Factor.");
const fn history(last: Key) -> [Key; 6] {
    [last, HISTORY[0], HISTORY[1], HISTORY[2], HISTORY[3], HISTORY[4]]
}
const HISTORY: [Key; 5] = [
    positive("cycles", "Cycles after which 1/e of the change is left.").example("1e5").optional(),
    positive("tau", "The same as dimensionless time.").example("3").optional(),
    Key::new(
        "factors",
        Kind::List(&HISTORY_FACTOR, [1, MOST_TIMES]),
        "Factors at the times, linear between them.",
    )
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
pub(in crate::scene) const FRICTION_HISTORY: Table =
    Table::new("history", ABOUT_HISTORY, &history(FINAL_FACTOR.range(Range::POSITIVE))).rules(HISTORY_FORMS);
pub(in crate::scene) const WEAR_HISTORY: Table =
    Table::new("history", ABOUT_HISTORY, &history(FINAL_FACTOR.range(Range::NOT_NEGATIVE)))
        .rules(HISTORY_FORMS);
