//! Laws, modes and media against one limit, with the negative controls.

use super::measure::{Measure, points};
use crate::data::Dataset;
use crate::error::Result;
use crate::figures::drawing::{
    Axis, Colour, DISTINCT, Dash, Figure, Label, Panel, Row, Series, Shape, Spacing, Style, plain,
};

/// Distances below this are shown at it: round-off.
const FLOOR: f64 = 1e-16;
/// Of the points of a profile every so many is drawn where many cases lie on each other.
const EVERY: usize = 5;
/// Colour of the cases that are to obey.
const OBEYS: Colour = DISTINCT[0];

/// One of the cases.
struct Case<'a> {
    name: &'a str,
    distance: f64,
    /// Depth of the limit and depth at the end, both over the limit's largest.
    curve: Vec<[f64; 2]>,
}

pub(super) fn figure(file: &Dataset) -> Result<Figure> {
    let count = file.along("case")?.len();
    let positions = file.along("position")?.len();
    let (names, predicted) = (file.words("name", count)?, file.words("predicted", count)?);
    let distances = file.numbers("distance", &[count])?;
    let shape = [count, positions];
    let [depth, limit] = ["profile_wear_depth", "profile_limit"].map(|name| file.numbers(name, &shape));
    let (depth, limit) = (depth?, limit?);
    let (mut inside, mut controls) = (vec![], vec![]);
    for (case, &distance) in distances.iter().enumerate() {
        let part = case * positions..(case + 1) * positions;
        let curve = points(&limit[part.clone()], &depth[part]);
        let group = if predicted.get(case) == "within" { &mut inside } else { &mut controls };
        group.push(Case { name: names.get(case), distance, curve });
    }
    let by_distance = |one: &Case, other: &Case| one.distance.total_cmp(&other.distance);
    inside.sort_by(by_distance);
    controls.sort_by(by_distance);
    let tolerances = ["tolerance_within", "tolerance_outside"].map(|name| {
        file.text(name)
            .and_then(|text| text.parse().ok())
            .filter(|value: &f64| *value > 0.0 && value.is_finite())
    });
    let rows = vec![
        Row { height: 230.0, panels: vec![overlay(&inside), outliers(&controls)] },
        Row { height: 215.0, panels: vec![order(&inside, &controls, tolerances)] },
    ];
    let title = if file.title().is_empty() { None } else { Some(plain(file.title())) };
    let notes = vec![
        "Numbers tell the controls. Depths over the largest of the limit, at radii between *c* and *a*_{∞}."
            .into(),
    ];
    Ok(Figure { title, rows, notes })
}

fn depth_axes(curves: &[Case]) -> Panel {
    let depths = curves.iter().flat_map(|case| case.curve.iter().map(|point| point[1]));
    let x = Axis::new("depth of the limit *w*_{∞}/max *w*_{∞}", "", Spacing::Linear, [0.0, 1.02]);
    let y =
        Measure::NUMBER.axis("final depth *w*/max *w*_{∞}", Spacing::Linear, depths.chain([0.0, 1.0]), 0.03);
    Panel::new(x, y)
}

/// The line on which the limit is reached.
fn limit() -> Series {
    let style = Style::Line { width: 1.3, dash: Dash::Dashed };
    Series::new("limit, Eq. (9)", style, Colour::BLACK, vec![[0.0, 0.0], [1.0, 1.0]]).in_legend()
}

fn overlay(inside: &[Case]) -> Panel {
    let mut panel = depth_axes(inside).titled(format!("{} cases predicted to obey", inside.len()));
    let style = Style::Points { shape: Shape::Disc, radius: 1.7 };
    for case in inside {
        let every = case.curve.iter().step_by(EVERY).copied().collect();
        panel.series.push(Series::new(plain(case.name), style, OBEYS, every));
    }
    panel.series.push(limit());
    panel
}

/// Colour and pattern of a control.
fn look(number: usize) -> (Colour, Dash) {
    // Without that of the cases that obey.
    let colours = &DISTINCT[1..];
    (colours[number % colours.len()], Dash::ALL[(number / colours.len()) % Dash::ALL.len()])
}

fn outliers(controls: &[Case]) -> Panel {
    let mut panel = depth_axes(controls).titled(format!("{} controls predicted to violate", controls.len()));
    panel.series.push(limit());
    for (number, case) in controls.iter().enumerate() {
        let (colour, dash) = look(number);
        let style = Style::Line { width: 1.5, dash };
        panel.series.push(Series::new(plain(case.name), style, colour, case.curve.clone()));
        let gap = |point: &[f64; 2]| (point[1] - point[0]).abs();
        let mut finite: Vec<&[f64; 2]> =
            case.curve.iter().filter(|point| point.iter().all(|value| value.is_finite())).collect();
        finite.sort_by(|one, other| gap(other).total_cmp(&gap(one)));
        let taken = |point: &[f64; 2]| panel.labels.iter().any(|label| is_near(label.at, *point));
        // Where it is farthest from the limit, or next to that where another number stands there.
        let free = finite.iter().find(|point| !taken(point)).or(finite.first());
        if let Some(at) = free {
            let label = Label::new((number + 1).to_string(), **at, Colour::BLACK);
            panel.labels.push(Label { anchor: 0.5, shift: [0.0, 4.0], on_white: true, ..label });
        }
    }
    panel
}

/// Whether two numbers would lie on each other.
fn is_near(one: [f64; 2], other: [f64; 2]) -> bool {
    (one[0] - other[0]).abs() < 0.06 && (one[1] - other[1]).abs() < 0.07
}

/// All distances in their order.
fn order(inside: &[Case], controls: &[Case], tolerances: [Option<f64>; 2]) -> Panel {
    let rank = |place: usize, count: usize| (place as f64 + 0.5) / count.max(1) as f64;
    let ranked = |cases: &[Case]| -> Vec<[f64; 2]> {
        let place = |(place, case): (usize, &Case)| [case.distance.max(FLOOR), rank(place, cases.len())];
        cases.iter().enumerate().map(place).collect()
    };
    let (obeying, violating) = (ranked(inside), ranked(controls));
    let distances =
        obeying.iter().chain(&violating).map(|point| point[0]).chain(tolerances.into_iter().flatten());
    let x = Measure::NUMBER.axis(
        "distance from the limit, sup |*w* − *w*_{∞}|/max *w*_{∞}",
        Spacing::Logarithmic,
        distances,
        0.04,
    );
    let y = Axis { ticked: false, ..Axis::new("cases in order", "", Spacing::Linear, [-0.02, 1.02]) };
    let mut panel = Panel::new(x, y);
    let dashes = [Dash::Dotted, Dash::DashDotted];
    let words = ["obeys up to here", "violates from here"];
    for ((tolerance, word), dash) in tolerances.into_iter().zip(words).zip(dashes) {
        let Some(tolerance) = tolerance else { continue };
        let ends = panel.y.range.map(|height| [tolerance, height]);
        let line = Style::Line { width: 1.2, dash };
        panel.series.push(Series::new(word, line, Colour::GREY, ends.to_vec()).in_legend());
    }
    let style = Style::Points { shape: Shape::Disc, radius: 2.2 };
    for (case, point) in inside.iter().zip(obeying) {
        panel.series.push(Series::new(plain(case.name), style, OBEYS, vec![point]));
    }
    let style = Style::Points { shape: Shape::Square, radius: 3.4 };
    for (number, (case, point)) in controls.iter().zip(violating).enumerate() {
        panel.series.push(Series::new(plain(case.name), style, look(number).0, vec![point]));
        let label = Label::new(format!("{}  {}", plain(case.name), number + 1), point, Colour::BLACK);
        panel.labels.push(Label { anchor: 1.0, shift: [-8.0, 4.0], on_white: true, ..label });
    }
    panel
}
