//! Names, units and meaning of all datasets of a run file: the writer and the reader both go by these tables.

use super::dataset::{Quantity, quantity};
use super::{Checkpoint, Snapshot};
use crate::solver::model::{Linearised, PastPoint, StickEdge};

pub use super::format::FORMAT_VERSION;
/// Root attribute of what the run was computed from, [`RunHeader::scene_hash`](super::RunHeader::scene_hash).
pub const SCENE_HASH: &str = "scene_hash";
/// Group that holds what a restart needs.
pub const CHECKPOINT: &str = "checkpoint";

/// Index coordinate along time, shape `(time,)`, resizable.
pub const TIME: Quantity = quantity("time", "1", "index of the snapshot");
/// Index coordinate along the nodes, shape `(node,)`.
pub const NODE: Quantity = quantity("node", "1", "index of the node");
/// Group of the fretting loops.
pub const LOOPS: &str = "loops";
/// Index coordinate along a fretting loop, shape `(point,)`, in the group of the loops.
pub const POINT: Quantity<'static> = quantity("point", "1", "index along one fretting loop");
/// Index coordinate along the springs, shape `(spring,)`, in the group of the checkpoint.
pub const SPRING: Quantity = quantity("spring", "1", "index of the spring");
/// What the oscillation does to the contact, a place in [`Regime::ALL`](crate::contact::stick_slip::Regime::ALL), shape `(time,)`.
pub const REGIME: Quantity = quantity("regime", "1", "what the oscillation does to the contact");
/// Regime of the run so far, a place in [`FrettingRegime::ALL`](crate::contact::stick_slip::FrettingRegime::ALL), shape `(time,)`; follows from the
/// conditions of the cycles.
pub const FRETTING_REGIME: Quantity = quantity(
    "fretting_regime",
    "1",
    "fretting regime of the run so far: mixed where some cycles were in gross slip and some were not",
);
/// Attribute of the regimes: the numbers there are.
pub const FLAG_VALUES: &str = "flag_values";
/// Attribute of the regimes: what the numbers mean, one word each.
pub const FLAG_MEANINGS: &str = "flag_meanings";
/// Radius of the nodes, shape `(node,)`.
pub const RADIUS: Quantity = quantity("radius", "m", "distance from the axis");
/// Limiting profile, shape `(node,)`.
pub const LIMIT_PROFILE: Quantity = quantity("limit_profile", "m", "profile in the limit of many cycles");
/// Depth worn away in the limit, shape `(node,)`.
pub const LIMIT_WEAR_DEPTH: Quantity =
    quantity("limit_wear_depth", "m", "wear depth in the limit of many cycles");
/// Index coordinate along the rows of a measured profile, shape `(table_row,)`; absent, as what belongs to it, for other indenters.
pub const TABLE_ROW: Quantity = quantity("table_row", "1", "index of the row of the measured profile");
/// Radius of the rows, shape `(table_row,)`.
pub const TABLE_RADIUS: Quantity =
    quantity("table_radius", "m", "radius of the rows of the measured profile");
/// Height of the rows, shape `(table_row,)`; its attribute `source` names the file that they came from.
pub const TABLE_PROFILE: Quantity = quantity("table_profile", "m", "measured profile of the unworn indenter");
/// Attribute of the heights of the rows, and of the path along x.
pub const SOURCE: &str = "source";
/// Attribute of the heights of the rows: standard deviation of their noise, m, with which they are smoothed; absent where they are taken as
/// they are.
pub const SMOOTHING: &str = "smoothing";
/// Index coordinate along the rows of a recorded path, shape `(path_row,)`; absent, as what belongs to it, without one.
pub const PATH_ROW: Quantity = quantity("path_row", "1", "index of the row of the recorded path");
/// Path along x, shape `(path_row,)`; its attribute `source` names the file that the rows came from.
pub const PATH_X: Quantity = quantity("path_x", "m", "tangential displacement along x over one period");
/// Path along y, shape `(path_row,)`.
pub const PATH_Y: Quantity = quantity("path_y", "m", "tangential displacement along y over one period");
/// Indentation along the path over that of the scene, shape `(path_row,)`.
pub const PATH_INDENTATION: Quantity =
    quantity("path_indentation", "m", "indentation over that of the scene over one period");
/// Compression of the springs, shape `(spring,)`, in the group of the checkpoint.
pub const COMPRESSION: Quantity = quantity("compression", "m", "compression of the springs");
/// Mean rate of the compressions in the last step, shape `(spring,)`, in the group of the checkpoint.
pub const COMPRESSION_RATE: Quantity =
    quantity("compression_rate", "m", "compression of the springs gained per cycle in the last step");
/// Group, in that of the checkpoint, of an edge of stick that moves; absent where it stays.
pub const STICK: &str = "stick";
/// Group, in that of the checkpoint, of ground that blocks at other indentations have worn in gross slip; absent where they have not.
pub const GROUND: &str = "ground";
/// Squared radius at which that ground is known, shape `(worn_place,)`.
pub const WORN_PLACE: Quantity = quantity("worn_place", "m2", "square of the radius of worn ground");
/// Depth worn there when the block under way began, shape `(worn_place,)`.
pub const WORN_BEFORE: Quantity =
    quantity("worn_before", "m", "wear depth when the block under way began, to go on from");
/// By how much that block lifts the indenter.
pub const LIFT: Quantity =
    quantity("lift", "m", "largest indentation of the run less that of the block under way");
/// Index coordinate along the radii at which slip left behind is known, shape `(station,)`.
pub const STATION: Quantity =
    quantity("station", "1", "index of the radius at which slip left behind is known");
/// Slip depth left behind, shape `(station,)`.
pub const LEFT_BEHIND: Quantity = quantity("left_behind", "m", "slip depth left behind by the edge of stick");
/// Index coordinate along the radii of the output, shape `(worn_node,)`; empty where the edge of stick moves inwards.
pub const WORN_NODE: Quantity = quantity("worn_node", "1", "index of the node");
/// Wear depth at the radii of the output, shape `(worn_node,)`.
pub const STICK_WEAR_DEPTH: Quantity = quantity("wear_depth", "m", "wear depth at the nodes, to go on from");
/// Squared radii, increasing, at which ground that came to rest between blocks is known, shape `(place_at_rest,)`.
pub const PLACE_AT_REST: Quantity =
    quantity("place_at_rest", "m2", "square of the radius of ground that came to rest between blocks");
/// By how much wear has raised the equivalent profile there, shape `(place_at_rest,)`.
pub const RAISED_AT_REST: Quantity =
    quantity("raised_at_rest", "m", "equivalent profile of ground that came to rest less the unworn one");
/// Group, in that of the checkpoint, of the times that a method of several steps remembers; absent where there are none.
pub const PAST: &str = "past";
/// Index coordinate along those times, the newest first, shape `(earlier,)`.
pub const EARLIER: Quantity = quantity("earlier", "1", "index of the time remembered, the newest first");
/// Index coordinate along the springs and the contact edge, shape `(spring_or_edge,)`.
pub const SPRING_OR_EDGE: Quantity =
    quantity("spring_or_edge", "1", "index of the spring, the contact edge last");
/// Logarithm of the slip over that of the unworn profile, shape `(earlier, spring_or_edge)`.
pub const LOG_SLIP: Quantity =
    quantity("log_slip", "1", "logarithm of the slip over that of the unworn profile");
/// Order of the step to be tried next, scalar.
pub const ORDER: Quantity = quantity("order", "1", "order of the next step");
/// Group, in that of the past, of where Newton's matrix was factorised that the next step begins with; absent where that makes its own.
pub const LINEARISED: &str = "linearised";
/// Error estimate, scalar, in the group of the checkpoint; absent where there is none.
pub const ERROR_ESTIMATE: Quantity = quantity(
    "error_estimate",
    "1",
    "estimated error of worn volume and profile relative to those of the limit",
);

/// Accuracy asked for, scalar, in the group of the checkpoint, and whether the error estimate keeps to it; absent where springs were given by hand.
pub const ACCURACY: Quantity =
    quantity("accuracy", "1", "accuracy of worn volume and profile that was asked for");
pub const ACCURACY_MET: Quantity =
    quantity("accuracy_met", "1", "1 if the estimated error is as small as was asked for, 0 if not");

/// How a run came to be made anew, scalars, in the group of the checkpoint; absent where it was not.
pub const REFINEMENTS: Quantity =
    quantity("refinements", "1", "how often the run was made anew on more springs, or need not be any more");
pub const TOLERANCE: Quantity =
    quantity("tolerance", "1", "tolerance of the time stepping where it was made smaller for that, or 0");
pub const SUBSTEPS: Quantity =
    quantity("substeps", "1", "substeps of a period where they were made more for that, or 0");
pub const ENDED_ON: Quantity = quantity(
    "ended_on",
    "1",
    "springs on which an attempt came to an end less accurately than was asked for, or 0",
);

/// Tolerance, substeps, error and worn volume of the attempt that came to an end, scalars.
pub const ENDED_WITH: Quantity =
    quantity("ended_with", "1", "tolerance of that attempt where it had been made smaller, or 0");
pub const ENDED_IN: Quantity =
    quantity("ended_in", "1", "substeps of a period of that attempt where they had been made more, or 0");
pub const ENDED_WITHIN: Quantity =
    quantity("ended_within", "1", "estimated error of that attempt, or 1 where nothing is known of it");
pub const ENDED_VOLUME: Quantity = quantity("ended_volume", "m3", "worn volume of that attempt, or 0");

/// Work of the attempts of such a run that came before, scalar.
pub const WORK: Quantity =
    quantity("work", "ns", "work of the attempts before, of one core, about, by what their steps take");

/// A dataset, and the place of its values in the record it stores.
pub(super) struct Field<Record, Value> {
    pub quantity: Quantity<'static>,
    pub of: fn(&Record) -> &Value,
    pub of_mut: fn(&mut Record) -> &mut Value,
}

const fn field<Record, Value>(
    quantity: Quantity<'static>,
    of: fn(&Record) -> &Value,
    of_mut: fn(&mut Record) -> &mut Value,
) -> Field<Record, Value> {
    Field { quantity, of, of_mut }
}

/// Shape `(time,)`.
pub(super) const SERIES: [Field<Snapshot, f64>; 13] = [
    field(quantity("cycles", "1", "number of fretting cycles"), |it| &it.cycles, |it| &mut it.cycles),
    field(quantity("tau", "1", "dimensionless time"), |it| &it.tau, |it| &mut it.tau),
    field(quantity("wear_volume", "m3", "worn volume"), |it| &it.wear_volume, |it| &mut it.wear_volume),
    field(
        quantity("contact_radius", "m", "contact radius"),
        |it| &it.contact_radius,
        |it| &mut it.contact_radius,
    ),
    field(
        quantity("stick_radius", "m", "radius of the stick zone per cycle"),
        |it| &it.stick_radius,
        |it| &mut it.stick_radius,
    ),
    field(
        quantity("permanent_stick_radius", "m", "radius within which nothing has slipped so far"),
        |it| &it.permanent_stick_radius,
        |it| &mut it.permanent_stick_radius,
    ),
    field(
        quantity("indentation", "m", "largest indentation depth"),
        |it| &it.indentation,
        |it| &mut it.indentation,
    ),
    field(
        quantity("normal_force", "N", "normal force at the largest indentation"),
        |it| &it.normal_force,
        |it| &mut it.normal_force,
    ),
    field(
        quantity("dissipated_energy", "J", "energy dissipated by friction since the start"),
        |it| &it.dissipated_energy,
        |it| &mut it.dissipated_energy,
    ),
    field(
        quantity("cycle_energy", "J", "energy dissipated by friction in one cycle"),
        |it| &it.cycle_energy,
        |it| &mut it.cycle_energy,
    ),
    field(
        quantity("tangential_force", "N", "largest tangential force along one fretting loop"),
        |it| &it.tangential_force,
        |it| &mut it.tangential_force,
    ),
    field(
        quantity("energy_ratio", "1", "energy of the fretting loop over 4 Q* δ*"),
        |it| &it.energy_ratio,
        |it| &mut it.energy_ratio,
    ),
    field(
        quantity("sliding_ratio", "1", "width of the fretting loop at no force over the stroke"),
        |it| &it.sliding_ratio,
        |it| &mut it.sliding_ratio,
    ),
];

/// Shape `(time, node)`.
pub(super) const CURVES: [Field<Snapshot, Vec<f64>>; 4] = [
    field(quantity("profile", "m", "worn profile"), |it| &it.profile, |it| &mut it.profile),
    field(quantity("wear_depth", "m", "wear depth"), |it| &it.wear_depth, |it| &mut it.wear_depth),
    field(quantity("pressure", "Pa", "contact pressure"), |it| &it.pressure, |it| &mut it.pressure),
    field(quantity("slip", "m", "slip amplitude"), |it| &it.slip, |it| &mut it.slip),
];

/// Those of the series and curves that are not known everywhere, and where they are not.
pub(super) const UNKNOWN: [(&str, &str); 3] = [
    ("energy_ratio", OFF_AXIS),
    ("sliding_ratio", OFF_AXIS),
    (
        "pressure",
        "Not a number at radii within the stick zone, where the method does not give the pressure: these slipped until the edge of stick passed them. \
         Zero outside the contact.",
    ),
];
const OFF_AXIS: &str = "Not a number where the indenter leaves the x axis or is not moved.";

/// Shape `(time, point)`, in the group of the loops; those along y only where the indenter leaves the x axis.
pub(super) const LOOP_CURVES: [Field<Snapshot, Vec<f64>>; 4] = [
    field(
        quantity("displacement", "m", "tangential displacement along one period, which ends where it begins"),
        |it| &it.loop_displacement,
        |it| &mut it.loop_displacement,
    ),
    field(
        quantity("tangential_force", "N", "tangential force along one period"),
        |it| &it.loop_force,
        |it| &mut it.loop_force,
    ),
    field(
        quantity("displacement_y", "m", "tangential displacement across the first one along one period"),
        |it| &it.loop_displacement_y,
        |it| &mut it.loop_displacement_y,
    ),
    field(
        quantity("tangential_force_y", "N", "tangential force across the first one along one period"),
        |it| &it.loop_force_y,
        |it| &mut it.loop_force_y,
    ),
];

/// Scalars of the checkpoint, real.
pub(super) const CHECKPOINT_REALS: [Field<Checkpoint, f64>; 13] = [
    field(
        quantity("cycles", "1", "number of fretting cycles done"),
        |it| &it.state.cycles,
        |it| &mut it.state.cycles,
    ),
    field(
        quantity("dissipated_energy", "J", "energy dissipated by friction since the start"),
        |it| &it.state.dissipated_energy,
        |it| &mut it.state.dissipated_energy,
    ),
    field(
        quantity("volume_by_rate", "m3", "worn volume by the rates of the cycles"),
        |it| &it.state.volume_by_rate,
        |it| &mut it.state.volume_by_rate,
    ),
    field(
        quantity("least_stick_radius", "m", "radius within which no spring has slipped so far"),
        |it| &it.state.least_stick_radius,
        |it| &mut it.state.least_stick_radius,
    ),
    field(
        quantity(
            "resting_area",
            "m2",
            "square of the radius within which no spring slips in the block under way",
        ),
        |it| &it.state.resting_area,
        |it| &mut it.state.resting_area,
    ),
    field(
        quantity(
            "busy_until",
            "1",
            "cycles until which the worn volume per cycle was above the one at which to stop",
        ),
        |it| &it.progress.busy_until,
        |it| &mut it.progress.busy_until,
    ),
    field(
        quantity(
            "averages_from",
            "1",
            "cycles from which on steps see passes through repeated blocks, which were stepped through before",
        ),
        |it| &it.progress.averages_from,
        |it| &mut it.progress.averages_from,
    ),
    field(
        quantity(
            "rejected_at",
            "1",
            "cycles done when it was last seen whether steps that are rejected lead on",
        ),
        |it| &it.progress.rejected_at,
        |it| &mut it.progress.rejected_at,
    ),
    field(
        quantity("next_step", "1", "number of cycles to be tried in the next step"),
        |it| &it.progress.next_step,
        |it| &mut it.progress.next_step,
    ),
    field(
        quantity("edge", "m2", "square of the contact radius less that of the stick radius"),
        |it| &it.state.slip_area,
        |it| &mut it.state.slip_area,
    ),
    field(
        quantity("edge_rate", "m2", "gain of edge per cycle in the last step"),
        |it| &it.state.slip_area_rate,
        |it| &mut it.state.slip_area_rate,
    ),
    field(
        quantity("first_rate", "m3", "worn volume per cycle at the start"),
        |it| &it.progress.first_rate,
        |it| &mut it.progress.first_rate,
    ),
    field(quantity("wall_seconds", "s", "wall time used"), |it| &it.wall_seconds, |it| &mut it.wall_seconds),
];

/// Scalars of the checkpoint, whole numbers.
pub(super) const CHECKPOINT_COUNTS: [Field<Checkpoint, u64>; 5] = [
    field(quantity("steps", "1", "steps accepted"), |it| &it.progress.steps, |it| &mut it.progress.steps),
    field(
        quantity("rejected_steps", "1", "steps rejected"),
        |it| &it.progress.rejected_steps,
        |it| &mut it.progress.rejected_steps,
    ),
    field(
        quantity("rate_evaluations", "1", "evaluations of the wear rate"),
        |it| &it.progress.rate_evaluations,
        |it| &mut it.progress.rate_evaluations,
    ),
    field(
        quantity(
            "resolved_work",
            "ns",
            "work of the periods that steps and outputs resolved, of one core, about",
        ),
        |it| &it.progress.resolved_work,
        |it| &mut it.progress.resolved_work,
    ),
    field(
        quantity("next_output", "1", "index of the next entry of the output plan"),
        |it| &it.progress.next_output,
        |it| &mut it.progress.next_output,
    ),
];

/// Shape `(earlier,)`.
pub(super) const PAST_REALS: [Field<PastPoint, f64>; 4] = [
    field(quantity("cycles", "1", "number of fretting cycles done"), |it| &it.cycles, |it| &mut it.cycles),
    field(
        quantity("edge", "m2", "square of the contact radius less that of the stick radius"),
        |it| &it.slip_area,
        |it| &mut it.slip_area,
    ),
    field(
        quantity("dissipated_energy", "J", "energy dissipated by friction since the start"),
        |it| &it.dissipated_energy,
        |it| &mut it.dissipated_energy,
    ),
    field(
        quantity("volume_by_rate", "m3", "worn volume by the rates of the cycles"),
        |it| &it.volume_by_rate,
        |it| &mut it.volume_by_rate,
    ),
];

/// Scalars.
pub(super) const LINEARISED_REALS: [Field<Linearised, f64>; 4] = [
    field(quantity("cycles", "1", "number of fretting cycles done"), |it| &it.cycles, |it| &mut it.cycles),
    field(
        quantity("edge", "m2", "square of the contact radius less that of the stick radius"),
        |it| &it.slip_area,
        |it| &mut it.slip_area,
    ),
    field(
        quantity("gathered_edge", "m2", "what the times before made of the edge"),
        |it| &it.gathered_slip_area,
        |it| &mut it.gathered_slip_area,
    ),
    field(quantity("step", "1", "cycles by which rates are multiplied"), |it| &it.step, |it| &mut it.step),
];

/// Scalars of an edge of stick that moves.
pub(super) const STICK_REALS: [Field<StickEdge, f64>; 5] = [
    field(quantity("area", "m2", "square of the stick radius"), |it| &it.area, |it| &mut it.area),
    field(
        quantity("depth", "m", "equivalent profile at the edge of stick"),
        |it| &it.depth,
        |it| &mut it.depth,
    ),
    field(
        quantity("load", "1", "integral of x^k times compression over the stick radius, m^(2+k)"),
        |it| &it.load,
        |it| &mut it.load,
    ),
    field(
        quantity("area_rate", "m2", "gain of area per cycle in the last step"),
        |it| &it.rates[0],
        |it| &mut it.rates[0],
    ),
    field(
        quantity("depth_rate", "m", "gain of depth per cycle in the last step"),
        |it| &it.rates[1],
        |it| &mut it.rates[1],
    ),
];

/// The same where a balance of tangential forces decides it beside a held normal force.
pub(super) const BALANCED_STICK_REALS: [Field<StickEdge, f64>; 2] = [
    field(
        quantity("slip_compression", "m", "compression at the edge of stick"),
        |it| &it.slip_compression,
        |it| &mut it.slip_compression,
    ),
    field(
        quantity("slip_compression_rate", "m", "gain of that compression per cycle in the last step"),
        |it| &it.rates[2],
        |it| &mut it.rates[2],
    ),
];
