//! How a run comes to its limit.

use super::measure::{Measure, points};
use super::run::RunResults;
use crate::data::{LimitDistance, Snapshot};
use crate::figures::drawing::{Axis, Colour, DISTINCT, Dash, Panel, Row, Series, Shape, Spacing, Style};

/// Below this, distances are round-off.
const FLOOR: f64 = 1e-16;

pub(super) fn rows(results: &RunResults) -> Vec<Row> {
    let later: Vec<&Snapshot> = results.snapshots().iter().filter(|it| it.cycles > 0.0).collect();
    let shape = later.iter().map(|it| {
        let limit = results.run.header.limit.as_ref();
        limit.and_then(|limit| LimitDistance::new(limit, it).distance_relative).unwrap_or(f64::NAN)
    });
    let shape: Vec<f64> = shape.map(|distance| distance.max(FLOOR)).collect();
    let volume = results.limit.as_ref().map(|limit| {
        let missing = |it: &&Snapshot| (1.0 - it.wear_volume / limit.wear_volume()).abs().max(FLOOR);
        later.iter().map(missing).collect::<Vec<f64>>()
    });
    let estimate = results.run.checkpoint.as_ref().and_then(|checkpoint| checkpoint.error_estimate);
    let values = shape.iter().chain(volume.iter().flatten()).copied().chain(estimate);
    let y = Measure::NUMBER.axis("distance from the limit", Spacing::Logarithmic, values, 0.05);
    let tau: Vec<f64> = later.iter().map(|it| it.tau).collect();
    let cycles: Vec<f64> = later.iter().map(|it| it.cycles).collect();
    let axis = |name: &str, spacing, times: &[f64], margin| {
        Measure::NUMBER.axis(name, spacing, times.iter().copied(), margin)
    };
    let over_tau = axis("dimensionless time *τ*", Spacing::Linear, &tau, 0.02);
    let over_cycles = axis("cycles *N*", Spacing::Logarithmic, &cycles, 0.0);
    let panel = |x: Axis, times: &[f64]| {
        let mut panel = Panel::new(x, y.clone());
        let solid = Style::Line { width: 1.8, dash: Dash::Solid };
        let dashed = Style::Line { width: 1.8, dash: Dash::DashDotted };
        let curve = "profile, sup |*w* − *w*_{∞}| / max *w*_{∞}";
        panel.series.push(Series::new(curve, solid, DISTINCT[0], points(times, &shape)).in_legend());
        if let Some(volume) = &volume {
            let curve = "worn volume, |1 − Δ*V*/Δ*V*_{∞}|";
            panel.series.push(Series::new(curve, dashed, DISTINCT[1], points(times, volume)).in_legend());
            let marks = Style::Points { shape: Shape::Square, radius: 1.8 };
            panel.series.push(Series::new("", marks, DISTINCT[1], points(times, volume)));
        }
        let marks = Style::Points { shape: Shape::Disc, radius: 1.8 };
        panel.series.push(Series::new("", marks, DISTINCT[0], points(times, &shape)));
        if let Some(estimate) = estimate {
            let ends = panel.x.range.map(|time| [time, estimate]);
            let style = Style::Line { width: 1.1, dash: Dash::Dotted };
            let series = Series::new("estimated error of the run", style, Colour::BLACK, ends.to_vec());
            panel.series.push(series.in_legend());
        }
        panel
    };
    let mut second = panel(over_cycles, &cycles);
    second.y.quantity = String::new();
    second.series.iter_mut().for_each(|series| series.in_legend = false);
    vec![Row { height: 260.0, panels: vec![panel(over_tau, &tau), second] }]
}
