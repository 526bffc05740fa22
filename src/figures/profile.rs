//! The profile of a run: unworn, at some snapshots, in the limit; and its ring that wears, enlarged.

use super::curve::Curve;
use super::measure::Measure;
use super::run::{Ages, RunResults, rounded};
use crate::data::Snapshot;
use crate::figures::drawing::{Colour, Dash, Label, Panel, Row, Series, Spacing, Style, range_of};
use crate::report::Scale;

/// How far beyond the outermost node the profile is drawn.
const BEYOND: f64 = 1.12;
/// Points between two nodes, and within the stuck region.
const PARTS: usize = 4;
const STUCK_POINTS: usize = 60;
/// Width of curves, px.
const WIDTH: f64 = 1.6;

const UNWORN: Style = Style::Line { width: 1.3, dash: Dash::Dotted };
const WORN: Style = Style::Line { width: WIDTH, dash: Dash::Solid };
const LIMIT: Style = Style::Line { width: WIDTH, dash: Dash::Dashed };

pub(super) fn rows(results: &RunResults) -> Vec<Row> {
    let curves = Curves::new(results);
    let shown = results.shown();
    let bar = Ages::new(&shown).bar(&shown);
    let mut whole = curves.profiles(results, 0.0).titled("whole contact");
    let mut ring = curves.profiles(results, curves.inner).titled("worn ring");
    ring.y.range = curves.ring_heights(&ring);
    ring.y.quantity = String::new();
    ring.series.iter_mut().for_each(|series| series.in_legend = false);
    let stick = results.radii().of(results.stick_radius());
    mark_stick(&mut whole, stick, true);
    mark_stick(&mut ring, stick, false);
    ring.bar.clone_from(&bar);
    let mut depth = curves.depths(results);
    // Without stick the ring is the whole contact.
    let panels = if stick > 0.0 { vec![whole, ring] } else { vec![Panel { bar: bar.clone(), ..whole }] };
    depth.bar = bar;
    vec![Row { height: 235.0, panels }, Row { height: 190.0, panels: vec![depth] }]
}

/// Wear depths as curves, radius and depth in m.
struct Curves {
    worn: Vec<(String, Colour, Vec<[f64; 2]>)>,
    limit: Option<Vec<[f64; 2]>>,
    /// Where the enlargement begins and the axes end, m.
    inner: f64,
    outer: f64,
}

impl Curves {
    fn new(results: &RunResults) -> Self {
        let radius = &results.run.header.radius;
        let shown = results.shown();
        let ages = Ages::new(&shown);
        let reach = radius.last().copied().unwrap_or(1.0);
        let outer = BEYOND * reach;
        let stick = results.stick_radius().min(reach);
        let curve = |snapshot: &&Snapshot| {
            let name = format!("*N* = {}", rounded(snapshot.cycles));
            (name, ages.colour(snapshot.cycles), extended(stick, radius, &snapshot.wear_depth, outer))
        };
        let limit = results.run.header.limit.as_ref().map(|limit| match &results.limit {
            // The closed form is known between the nodes too.
            Some(shape) => {
                let nodes = extended(stick, radius, &limit.wear_depth, outer);
                nodes.into_iter().map(|[r, _]| [r, shape.wear_depth(r)]).collect()
            }
            None => extended(stick, radius, &limit.wear_depth, outer),
        });
        let inner = (stick - 0.08 * (reach - stick)).max(0.0);
        Self { worn: shown.iter().map(curve).collect(), limit, inner, outer }
    }

    /// Profiles from a radius outwards.
    fn profiles(&self, results: &RunResults, from: f64) -> Panel {
        let indenter = results.scene.indenter();
        let radii = results.radii();
        let heights = Measure::new(Scale::LENGTH, [indenter.profile(self.outer)]);
        let profile = |depths: &[[f64; 2]]| -> Vec<[f64; 2]> {
            let outside = depths.iter().filter(|[r, _]| *r >= from);
            outside.map(|[r, depth]| [radii.of(*r), heights.of(indenter.profile(*r) + depth)]).collect()
        };
        let step = (self.outer - from) / STUCK_POINTS as f64;
        let unworn: Vec<[f64; 2]> = (0..=STUCK_POINTS).map(|i| [from + i as f64 * step, 0.0]).collect();
        let unworn = profile(&unworn);
        let tops = unworn.iter().map(|point| point[1]);
        let x = radii.axis("radius *r*", Spacing::Linear, [radii.of(from), radii.of(self.outer)], 0.0);
        let y = heights.axis("profile *f*", Spacing::Linear, tops, 0.04);
        let mut panel = Panel::new(x, y);
        panel.series.push(Series::new("unworn", UNWORN, Colour::BLACK, unworn).in_legend());
        for (name, colour, depths) in &self.worn {
            panel.series.push(Series::new(name, WORN, *colour, profile(depths)));
        }
        if let Some(limit) = &self.limit {
            panel.series.push(Series::new("limit", LIMIT, Colour::BLACK, profile(limit)).in_legend());
        }
        panel
    }

    /// Heights of what is in the enlargement.
    fn ring_heights(&self, ring: &Panel) -> [f64; 2] {
        let curves = ring.series.iter().filter(|series| !series.name.is_empty());
        let heights = curves.flat_map(|series| series.points.iter().map(|point| point[1]));
        range_of(heights, Spacing::Linear, 0.05).unwrap_or(ring.y.range)
    }

    fn depths(&self, results: &RunResults) -> Panel {
        let (radii, depths) = (results.radii(), results.depths());
        let scaled = |curve: &[[f64; 2]]| -> Vec<[f64; 2]> {
            let outside = curve.iter().filter(|[r, _]| *r >= self.inner);
            outside.map(|[r, depth]| [radii.of(*r), depths.of(*depth)]).collect()
        };
        let curves = self.worn.iter().map(|(_, _, curve)| curve).chain(&self.limit);
        let values: Vec<f64> = curves.flat_map(|curve| scaled(curve)).map(|point| point[1]).collect();
        let x = radii.axis("radius *r*", Spacing::Linear, [radii.of(self.inner), radii.of(self.outer)], 0.0);
        let y = depths.axis("wear depth *w*", Spacing::Linear, values, 0.05);
        let mut panel = Panel::new(x, y).titled("depth worn away");
        for (name, colour, curve) in &self.worn {
            panel.series.push(Series::new(name, WORN, *colour, scaled(curve)));
        }
        if let Some(limit) = &self.limit {
            panel.series.push(Series::new("limit", LIMIT, Colour::BLACK, scaled(limit)));
        }
        mark_stick(&mut panel, radii.of(results.stick_radius()), false);
        panel
    }
}

/// A curve from the axis to beyond the nodes: nothing is worn in the stuck region and beyond the reach of wear. In gross slip the axis is as worn as the
/// ground next to it.
fn extended(stick: f64, radius: &[f64], depths: &[f64], outer: f64) -> Vec<[f64; 2]> {
    let at_axis = if stick > 0.0 { 0.0 } else { depths.first().copied().unwrap_or(0.0) };
    let inside = (0..=STUCK_POINTS).map(|i| [stick * i as f64 / STUCK_POINTS as f64, at_axis]);
    let first = radius.first().copied().unwrap_or(0.0);
    let mut points: Vec<[f64; 2]> = inside.filter(|[r, _]| *r < first).collect();
    points.extend(Curve::new(radius, depths).points(PARTS));
    let last = points.last().copied().unwrap_or([0.0, 0.0]);
    points.extend((1..=PARTS).map(|i| {
        let r = last[0] + (outer - last[0]) * i as f64 / PARTS as f64;
        [r, 0.0]
    }));
    points
}

/// A line at the edge of stick.
pub(super) fn mark_stick(panel: &mut Panel, radius: f64, labelled: bool) {
    let [low, high] = panel.x.range;
    if radius <= low || radius >= high {
        return;
    }
    let style = Style::Line { width: 0.8, dash: Dash::Solid };
    let ends = panel.y.range.map(|height| [radius, height]);
    panel.series.insert(0, Series::new("", style, Colour::PALE, ends.to_vec()));
    if labelled {
        let top = [radius, panel.y.range[1]];
        let label = Label::new("edge of stick", top, Colour::GREY);
        panel.labels.push(Label { upwards: true, anchor: 1.0, shift: [-4.0, 6.0], ..label });
    }
}
