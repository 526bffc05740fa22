//! Fretting loops of a run at some snapshots, and the energy of a cycle.

use super::measure::Measure;
use super::run::{Ages, RunResults, rounded};
use crate::data::Snapshot;
use crate::figures::drawing::{Colour, DISTINCT, Dash, Panel, Row, Series, Spacing, Style};
use crate::report::Scale;

/// Displacement and force along one direction.
struct Direction {
    title: &'static str,
    axes: [&'static str; 2],
    displacement: fn(&Snapshot) -> Vec<f64>,
    force: fn(&Snapshot) -> Vec<f64>,
}

const ALONG: Direction = Direction {
    title: "fretting loops",
    axes: ["displacement *u*_{x}", "tangential force *F*_{x}"],
    displacement: |it| it.loop_displacement.clone(),
    force: |it| it.loop_force.clone(),
};
const OPENED: Direction = Direction {
    title: "loops without their secant",
    axes: ["displacement *u*_{x}", "*F*_{x} − *K u*_{x}"],
    displacement: |it| it.loop_displacement.clone(),
    force: force_less_spring,
};
const ACROSS: Direction = Direction {
    title: "fretting loops across",
    axes: ["displacement *u*_{y}", "tangential force *F*_{y}"],
    displacement: |it| it.loop_displacement_y.clone(),
    force: |it| it.loop_force_y.clone(),
};

pub(super) fn rows(results: &RunResults) -> Vec<Row> {
    let in_plane = results.snapshots().iter().any(|it| !it.loop_force_y.is_empty());
    let mut second = panel(results, if in_plane { &ACROSS } else { &OPENED });
    let shown = results.shown();
    second.bar = Ages::new(&shown).bar(&shown);
    vec![
        Row { height: 240.0, panels: vec![panel(results, &ALONG), second] },
        Row {
            height: 140.0,
            panels: [Some(energy(results)), ratios(results)].into_iter().flatten().collect(),
        },
    ]
}

/// Force less that of a spring between the reversals: slender loops lie on each other, these do not.
fn force_less_spring(snapshot: &Snapshot) -> Vec<f64> {
    let (displacement, force) = (&snapshot.loop_displacement, &snapshot.loop_force);
    let farthest = |one: &&(&f64, &f64), other: &&(&f64, &f64)| one.0.abs().total_cmp(&other.0.abs());
    let pairs: Vec<(&f64, &f64)> = displacement.iter().zip(force).collect();
    let stiffness = pairs.iter().max_by(farthest).map_or(0.0, |(u, force)| *force / *u);
    let stiffness = if stiffness.is_finite() { stiffness } else { 0.0 };
    pairs.iter().map(|(u, force)| *force - stiffness * *u).collect()
}

fn panel(results: &RunResults, direction: &Direction) -> Panel {
    let shown = results.shown();
    let ages = Ages::new(&shown);
    let curves: Vec<&Snapshot> =
        results.snapshots().first().into_iter().chain(shown.iter().copied()).collect();
    let all = |of: fn(&Snapshot) -> Vec<f64>| curves.iter().flat_map(move |it| of(it));
    let lengths = Measure::new(Scale::LENGTH, all(direction.displacement));
    let forces = Measure::new(Scale::FORCE, all(direction.force));
    let [x, y] = direction.axes;
    let x = lengths.axis(x, Spacing::Linear, all(direction.displacement).map(|it| lengths.of(it)), 0.05);
    let y = forces.axis(y, Spacing::Linear, all(direction.force).map(|it| forces.of(it)), 0.05);
    let mut panel = Panel::new(x, y).titled(direction.title);
    for (number, snapshot) in curves.iter().enumerate() {
        let along = (direction.displacement)(snapshot).into_iter().zip((direction.force)(snapshot));
        let points = along.map(|(u, force)| [lengths.of(u), forces.of(force)]).collect();
        panel.series.push(if number == 0 {
            let style = Style::Line { width: 1.3, dash: Dash::Dotted };
            Series::new("unworn", style, Colour::BLACK, points).in_legend()
        } else {
            let style = Style::Line { width: 1.5, dash: Dash::Solid };
            let name = format!("*N* = {}", rounded(snapshot.cycles));
            Series::new(name, style, ages.colour(snapshot.cycles), points)
        });
    }
    panel
}

/// What a curve is of, and its value in a snapshot.
type Ratio = (&'static str, fn(&Snapshot) -> f64);

const RATIOS: [Ratio; 2] =
    [("energy ratio *A*", |it| it.energy_ratio), ("sliding ratio *D*", |it| it.sliding_ratio)];

/// Energy ratio and sliding ratio; none of orbits.
fn ratios(results: &RunResults) -> Option<Panel> {
    let later = || results.snapshots().iter().filter(|it| it.cycles > 0.0);
    let all = later().flat_map(|it| RATIOS.map(|(_, of)| of(it))).filter(|it| it.is_finite());
    let all: Vec<f64> = all.collect();
    if all.is_empty() {
        return None;
    }
    let x = Measure::NUMBER.axis("cycles *N*", Spacing::Logarithmic, later().map(|it| it.cycles), 0.0);
    let y = Measure::NUMBER.axis("ratio", Spacing::Linear, all.into_iter().chain([0.0]), 0.08);
    let mut panel = Panel::new(x, y).titled("openness of the loops");
    for (number, (name, of)) in RATIOS.into_iter().enumerate() {
        let style = Style::Line { width: 1.8, dash: Dash::ALL[number] };
        let points = later().map(|it| [it.cycles, of(it)]).collect();
        panel.series.push(Series::new(name, style, DISTINCT[number], points).in_legend());
    }
    Some(panel)
}

fn energy(results: &RunResults) -> Panel {
    let later: Vec<&Snapshot> = results.snapshots().iter().filter(|it| it.cycles > 0.0).collect();
    let unit = Measure::new(Scale::ENERGY, later.iter().map(|it| it.cycle_energy));
    let cycles = later.iter().map(|it| it.cycles);
    let x = Measure::NUMBER.axis("cycles *N*", Spacing::Logarithmic, cycles, 0.0);
    let values = later.iter().map(|it| unit.of(it.cycle_energy));
    let y = unit.axis("energy per cycle *W*", Spacing::Linear, values, 0.08);
    let mut panel = Panel::new(x, y).titled("energy dissipated by friction");
    let style = Style::Line { width: 1.8, dash: Dash::Solid };
    let points = later.iter().map(|it| [it.cycles, unit.of(it.cycle_energy)]).collect();
    panel.series.push(Series::new("energy per cycle", style, DISTINCT[0], points));
    panel
}
