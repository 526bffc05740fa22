//! A result over two inputs of a sweep as a map.

use super::super::rings::Grid;
use super::{Input, MOST_DOTS};
use crate::figures::drawing::{Axis, Bar, Colour, Panel, Series, Shape, Style, graded, range_of};
use crate::report::number;

/// Bands of colour.
const BANDS: usize = 20;
const CROSS: Style = Style::Points { shape: Shape::Cross, radius: 3.0 };
const DOT: Style = Style::Points { shape: Shape::Disc, radius: 1.6 };

/// A map with the scenes as dots; `result` is the axis of the values.
pub(super) fn panel(first: &Input, second: &Input, values: &[f64], result: Axis) -> Panel {
    let range = range_of(values.iter().copied(), result.spacing, 0.0).unwrap_or(result.range);
    let bar = Axis { range, ..result };
    let mut panel = Panel::new(first.axis(0.0), second.axis(0.0));
    add_bands(&mut panel, [first, second], &heights(first, second, values, &bar));
    let lacking = values.iter().filter(|value| !value.is_finite()).count();
    if lacking > 0 {
        add_gaps(&mut panel, [first, second], values, lacking);
    }
    let dotted =
        values.iter().enumerate().filter(|(_, value)| value.is_finite() && values.len() <= MOST_DOTS);
    for (row, value) in dotted {
        let says = format!("{} {}", number(*value), bar.unit);
        let at = [first.at(row), second.at(row)];
        panel.series.push(Series::new(says.trim_end(), DOT, Colour::BLACK, vec![at]));
    }
    panel.bar = Some(Bar { axis: bar, colours: (0..BANDS).map(colour).collect(), marks: vec![] });
    panel
}

fn colour(band: usize) -> Colour {
    graded((band as f64 + 0.5) / BANDS as f64).towards_white(0.25)
}

/// Places of the values along their axis on the grid of the inputs; not a number where there is none.
fn heights(first: &Input, second: &Input, values: &[f64], axis: &Axis) -> Vec<f64> {
    let index = |input: &Input, row: usize| {
        let found = input.different.binary_search_by(|value| value.total_cmp(&input.values[row]));
        // Zero may be there with the other sign.
        found.unwrap_or_else(|next| next.min(input.different.len() - 1))
    };
    let mut heights = vec![f64::NAN; values.len()];
    for (row, value) in values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
        heights[index(first, row) * second.different.len() + index(second, row)] = axis.place(*value);
    }
    heights
}

/// Hatches the cells beside a scene without a result, and marks that scene.
fn add_gaps(panel: &mut Panel, inputs: [&Input; 2], values: &[f64], lacking: usize) {
    let scenes = (0..values.len()).filter(|row| !values[*row].is_finite());
    let at: Vec<[f64; 2]> = scenes.map(|row| inputs.map(|input| input.at(row))).collect();
    let name = format!("no result in {lacking} of {} scenes, nor between them and others", values.len());
    let rings = panel.series.iter().position(|series| series.style == Style::Hatched);
    match rings {
        Some(place) => {
            let hatched = &mut panel.series[place];
            (hatched.name, hatched.in_legend) = (name, true);
        }
        None => panel.series.push(Series::new(name, Style::Hatched, Colour::GREY, vec![]).in_legend()),
    }
    if values.len() <= MOST_DOTS {
        panel.series.push(Series::new("no result", CROSS, Colour::BLACK, at));
    }
}

fn add_bands(panel: &mut Panel, inputs: [&Input; 2], heights: &[f64]) {
    let places = |input: &Input, axis: &Axis| -> Vec<f64> {
        input.different.iter().map(|value| axis.place(input.measure.of(*value))).collect()
    };
    let [across, up] = [places(inputs[0], &panel.x), places(inputs[1], &panel.y)];
    let grid = Grid { first: &across, second: &up, values: heights };
    let gaps = on_axes(panel, grid.gaps());
    for band in 0..BANDS {
        let level = if band == 0 { f64::NEG_INFINITY } else { band as f64 / BANDS as f64 };
        let rings = on_axes(panel, grid.rings(level));
        panel.series.push(Series::new("", Style::Region { opacity: 1.0 }, colour(band), rings));
    }
    if !gaps.is_empty() {
        panel.series.push(Series::new("", Style::Hatched, Colour::GREY, gaps));
    }
}

/// Places along the axes as values.
fn on_axes(panel: &Panel, places: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    places.into_iter().map(|[x, y]| [panel.x.value(x), panel.y.value(y)]).collect()
}
