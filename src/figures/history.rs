//! Worn volume, depth, radii and normal force of a run over cycles, with the limit.

use super::measure::{Measure, points};
use super::run::RunResults;
use crate::contact::closed_form::LimitingShape;
use crate::data::Snapshot;
use crate::figures::drawing::{Colour, DISTINCT, Dash, Panel, Row, Series, Spacing, Style};
use crate::numerics::linear::largest;
use crate::report::Scale;

const LIMIT: Style = Style::Line { width: 1.2, dash: Dash::Dashed };

/// A quantity over cycles.
struct Quantity {
    name: &'static str,
    of: fn(&Snapshot) -> f64,
    /// Its value in the limit.
    limit: fn(&RunResults, &LimitingShape) -> Option<f64>,
}

pub(super) fn rows(results: &RunResults) -> Vec<Row> {
    let volume = Quantity {
        name: "worn volume",
        of: |it| it.wear_volume,
        limit: |_, limit| Some(limit.wear_volume()),
    };
    let depth = Quantity {
        name: "largest wear depth",
        of: |it| largest(&it.wear_depth),
        limit: |_, limit| Some(limit.wear_depth_max()),
    };
    let contact = Quantity {
        name: "contact *a*",
        of: |it| it.contact_radius,
        limit: |_, limit| Some(limit.contact_radius_limit()),
    };
    // Where there is a limit, the edge of stick is where that begins: one line does.
    let stick = Quantity { name: "stick *c*", of: |it| it.stick_radius, limit: |_, _| None };
    let force = Quantity {
        name: "normal force",
        of: |it| it.normal_force,
        // The load that a worn contact keeps is known where nothing but wear changes it.
        limit: |results, limit| {
            let plain = results.scene.conditions().is_plain();
            let first = results.snapshots().first().filter(|_| plain)?;
            Some(first.normal_force * limit.load_fraction())
        },
    };
    let pair = |panels: [Panel; 2]| Row { height: 165.0, panels: panels.into() };
    vec![
        pair([
            panel(results, "worn volume Δ*V*", Scale::VOLUME, &[volume], true),
            panel(results, "largest depth max *w*", Scale::LENGTH, &[depth], true),
        ]),
        pair([
            panel(results, "radius", Scale::LENGTH, &[contact, stick], false),
            panel(results, "normal force *F*_{N}", Scale::FORCE, &[force], false),
        ]),
    ]
}

/// Quantities over cycles, on an axis that begins at zero or not.
fn panel(results: &RunResults, axis: &str, scale: Scale, quantities: &[Quantity], from_zero: bool) -> Panel {
    // The start has no place on a logarithmic axis.
    let later: Vec<&Snapshot> = results.snapshots().iter().filter(|it| it.cycles > 0.0).collect();
    let cycles: Vec<f64> = later.iter().map(|it| it.cycles).collect();
    let rows: Vec<(&Quantity, Vec<f64>, Option<f64>)> = quantities
        .iter()
        .map(|quantity| {
            let limit = results.limit.as_ref().and_then(|limit| (quantity.limit)(results, limit));
            (quantity, later.iter().map(|it| (quantity.of)(it)).collect(), limit)
        })
        .collect();
    let all = || rows.iter().flat_map(|(_, values, limit)| values.iter().copied().chain(*limit));
    let unit = Measure::new(scale, all());
    let x = Measure::NUMBER.axis("cycles *N*", Spacing::Logarithmic, cycles.iter().copied(), 0.0);
    let values = all().map(|value| unit.of(value)).chain(from_zero.then_some(0.0));
    let y = unit.axis(axis, Spacing::Linear, values, 0.06);
    let mut panel = Panel::new(x, y);
    let several = quantities.len() > 1;
    for (number, (quantity, values, limit)) in rows.iter().enumerate() {
        let dash = if number == 0 { Dash::Solid } else { Dash::DashDotted };
        let style = Style::Line { width: 1.8, dash };
        let series = Series::new(quantity.name, style, DISTINCT[number], points(&cycles, &unit.all(values)));
        panel.series.push(if several { series.in_legend() } else { series });
        if let Some(limit) = limit {
            let ends = panel.x.range.map(|cycles| [cycles, unit.of(*limit)]);
            let series = Series::new("limit", LIMIT, Colour::BLACK, ends.to_vec());
            // One entry of the figure explains the lines of all.
            panel.series.push(Series { in_legend: several, ..series });
        }
    }
    panel
}
