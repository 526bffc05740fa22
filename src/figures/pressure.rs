//! Pressure and slip of a run over the radius, at some snapshots.

use super::curve::Curve;
use super::measure::Measure;
use super::profile::mark_stick;
use super::run::{Ages, RunResults, rounded};
use crate::data::Snapshot;
use crate::figures::drawing::{Colour, Dash, Panel, Row, Series, Spacing, Style};
use crate::report::Scale;

/// Points between two nodes.
const PARTS: usize = 4;
/// Part of the annulus next to the edge of stick whose pressure does not set the axis: in the end it grows there without bound, and what is
/// seen of that is a property of the mesh.
const SINGULAR: f64 = 0.03;

/// What is drawn over the radius, up to the edge of contact.
struct Quantity {
    title: &'static str,
    axis: &'static str,
    scale: Scale,
    of: fn(&Snapshot) -> &Vec<f64>,
    /// Whether it falls to zero at the edge of contact; else it is not known beyond the last node within.
    vanishes: bool,
}

const QUANTITIES: [Quantity; 2] = [
    Quantity {
        title: "contact pressure",
        axis: "pressure *p*",
        scale: Scale::PRESSURE,
        of: |it| &it.pressure,
        vanishes: true,
    },
    Quantity {
        title: "slip",
        axis: "slip amplitude *s*",
        scale: Scale::LENGTH,
        of: |it| &it.slip,
        vanishes: false,
    },
];

pub(super) fn rows(results: &RunResults) -> Vec<Row> {
    let [pressure, mut slip] = QUANTITIES.map(|quantity| panel(results, &quantity));
    // One legend does for both.
    slip.series.iter_mut().for_each(|series| series.in_legend = false);
    [pressure, slip].map(|panel| Row { height: 215.0, panels: vec![panel] }).into()
}

fn panel(results: &RunResults, quantity: &Quantity) -> Panel {
    let radius = &results.run.header.radius;
    let shown = results.shown();
    let ages = Ages::new(&shown);
    let radii = results.radii();
    let first = results.snapshots().first();
    let curves: Vec<&Snapshot> = first.into_iter().chain(shown.iter().copied()).collect();
    let [stick, reach] = [results.stick_radius(), radius.last().copied().unwrap_or(1.0)];
    let regular = |r: f64| r < stick || r > stick + SINGULAR * (reach - stick);
    let values = |snapshot: &&Snapshot| {
        let all = radius.iter().zip((quantity.of)(snapshot)).filter(|(r, _)| regular(**r));
        all.map(|(_, value)| *value).collect::<Vec<_>>()
    };
    let values: Vec<f64> = curves.iter().flat_map(values).collect();
    let unit = Measure::new(quantity.scale, values.iter().copied());
    let outer = reach + 0.06 * (reach - stick).max(0.0);
    let inner = (radius.first().copied().unwrap_or(0.0)).min(stick) - 0.06 * (reach - stick).max(0.0);
    let x = radii.axis("radius *r*", Spacing::Linear, [radii.of(inner.max(0.0)), radii.of(outer)], 0.0);
    let y = unit.axis(quantity.axis, Spacing::Linear, unit.all(&values).into_iter().chain([0.0]), 0.05);
    let mut panel = Panel::new(x, y).titled(quantity.title);
    for (number, snapshot) in curves.iter().enumerate() {
        let points = within_contact(radius, snapshot, quantity)
            .into_iter()
            .map(|[r, value]| [radii.of(r), unit.of(value)])
            .collect();
        let series = if number == 0 {
            let style = Style::Line { width: 1.3, dash: Dash::Dotted };
            Series::new("unworn", style, Colour::BLACK, points).in_legend()
        } else {
            let style = Style::Line { width: 1.6, dash: Dash::Solid };
            let name = format!("*N* = {}", rounded(snapshot.cycles));
            Series::new(name, style, ages.colour(snapshot.cycles), points)
        };
        panel.series.push(series);
    }
    panel.bar = ages.bar(&shown);
    mark_stick(&mut panel, radii.of(stick), true);
    panel
}

/// A quantity within the contact as a curve, m and SI.
fn within_contact(radius: &[f64], snapshot: &Snapshot, quantity: &Quantity) -> Vec<[f64; 2]> {
    let edge = snapshot.contact_radius;
    // Pressure is not known where the edge of stick has passed.
    let is_known = |(r, value): &(&f64, &f64)| **r < edge && value.is_finite();
    let inside = radius.iter().zip((quantity.of)(snapshot)).filter(is_known);
    let (mut radii, mut values): (Vec<f64>, Vec<f64>) = inside.unzip();
    if quantity.vanishes {
        radii.push(edge);
        values.push(0.0);
    }
    if radii.is_empty() { vec![] } else { Curve::new(&radii, &values).points(PARTS) }
}
