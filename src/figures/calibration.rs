//! Data beside what is fitted to them, their residuals, and how the misfit rises with each unknown.

use super::measure::{Measure, points};
use crate::data::{Dataset, Words};
use crate::error::Result;
use crate::figures::drawing::{
    Axis, Colour, DISTINCT, Dash, Figure, Panel, Row, Series, Shape, Spacing, Style, plain,
};
use crate::units::unit_in_words;

/// Most data sets and unknowns that are drawn.
const MOST: usize = 6;
/// Most values of a data set whose bars are drawn.
const MOST_BARS: usize = 60;
const POINT: Style = Style::Points { shape: Shape::Circle, radius: 2.2 };
const LINE: Style = Style::Line { width: 1.4, dash: Dash::Solid };
const BAR: Style = Style::Line { width: 0.8, dash: Dash::Solid };
const LEVEL: Style = Style::Line { width: 0.9, dash: Dash::Dashed };
const DRAW: Style = Style::Points { shape: Shape::Disc, radius: 1.1 };
const CENTRE: Style = Style::Points { shape: Shape::Diamond, radius: 4.0 };
/// Most unknowns of the corner.
const MOST_OF_CORNER: usize = 5;
/// Height of the squared quantile that is shown at most, in units of that where the interval ends.
const ROOM: f64 = 1.6;

/// The values of all data sets.
struct Values<'a> {
    data: &'a [f64],
    files: &'a Words,
    measured: &'a Words,
    at: &'a [f64],
    measurement: &'a [f64],
    prediction: &'a [f64],
    deviation: &'a [f64],
    residual: &'a [f64],
}

pub(super) fn figure(file: &Dataset) -> Result<Figure> {
    let count = file.along("value")?.len();
    let numbers = |name: &str| file.numbers(name, &[count]);
    let values = Values {
        data: numbers("data")?,
        files: file.words("file", count)?,
        measured: file.words("measured", count)?,
        at: numbers("at")?,
        measurement: numbers("measurement")?,
        prediction: numbers("prediction")?,
        deviation: numbers("deviation")?,
        residual: numbers("residual")?,
    };
    let mut rows = vec![];
    for set in 0..MOST {
        let own: Vec<usize> = (0..count).filter(|i| values.data[*i] == set as f64).collect();
        if !own.is_empty() {
            rows.push(Row { height: 200.0, panels: vec![values.fit(&own), values.residuals(&own)] });
        }
    }
    let profiles = profiles(file)?;
    for pair in profiles.chunks(2) {
        rows.push(Row { height: 180.0, panels: pair.to_vec() });
    }
    rows.extend(corner(file)?);
    rows.extend(bands(file)?);
    let title = if file.title().is_empty() { None } else { Some(plain(file.title())) };
    let mut notes = vec![
        "Bars: one standard deviation. Misfit: sum of squares above the least, all else fitted anew.",
        "Vertical lines: the ends of the interval of 95 %.",
    ];
    if file.along("parameter")?.len() > 1 {
        notes.push("Of pairs of unknowns: draws of what they may be by the data, the estimates, and lines at the ends of their intervals.");
    }
    if file.has("forecast_cycles") {
        notes.push("Foretold: a line at the estimates, and where 95 % of the draws lie.");
    }
    Ok(Figure { title, rows, notes: notes.into_iter().map(String::from).collect() })
}

impl Values<'_> {
    /// Quantity and unit along the axis of a data set, and of its values.
    fn axes(&self, first: usize) -> [(&'static str, &'static str); 2] {
        match self.measured.get(first) {
            "worn volume over dissipated energy" => [("dissipated energy", "J"), ("worn volume", "m³")],
            "scar profile" => [("position", "m"), ("height", "m")],
            "fretting loop" => [("displacement", "m"), ("tangential force", "N")],
            "worn volume over cycles" => [("cycles", ""), ("worn volume", "m³")],
            "wear depth over cycles" => [("cycles", ""), ("wear depth", "m")],
            "contact radius over cycles" => [("cycles", ""), ("contact radius", "m")],
            "tangential force over cycles" => [("cycles", ""), ("tangential force", "N")],
            "energy per cycle over cycles" => [("cycles", ""), ("energy per cycle", "J")],
            _ => [("cycles", ""), ("dissipated energy", "J")],
        }
    }

    fn of(&self, numbers: &[f64], own: &[usize]) -> Vec<f64> {
        own.iter().map(|i| numbers[*i]).collect()
    }

    fn along(&self, own: &[usize]) -> Axis {
        let [(quantity, unit), _] = self.axes(own[0]);
        let at = self.of(self.at, own);
        Axis { unit: unit.into(), ..Measure::NUMBER.axis(quantity, Spacing::Linear, at, 0.05) }
    }

    fn fit(&self, own: &[usize]) -> Panel {
        let [_, (quantity, unit)] = self.axes(own[0]);
        let ends = |i: &usize| [-1.0, 0.0, 1.0].map(|side| self.measurement[*i] + side * self.deviation[*i]);
        let bars = own.len() <= MOST_BARS;
        let heights =
            own.iter().flat_map(|i| if bars { ends(i).to_vec() } else { vec![self.measurement[*i]] });
        let heights = heights.chain(self.of(self.prediction, own));
        let y = Axis { unit: unit.into(), ..Measure::NUMBER.axis(quantity, Spacing::Linear, heights, 0.05) };
        let mut panel = Panel::new(self.along(own), y).titled(plain(self.files.get(own[0])));
        if bars {
            for i in own {
                let [low, _, high] = ends(i);
                let bar = vec![[self.at[*i], low], [self.at[*i], high]];
                panel.series.push(Series::new("", BAR, Colour::GREY, bar));
            }
        }
        let measured = points(&self.of(self.at, own), &self.of(self.measurement, own));
        panel.series.push(Series::new("measured", POINT, Colour::BLACK, measured).in_legend());
        let mut fitted = points(&self.of(self.at, own), &self.of(self.prediction, own));
        if self.measured.get(own[0]) != "fretting loop" {
            fitted.sort_by(|one, other| one[0].total_cmp(&other[0]));
        }
        panel.series.push(Series::new("fitted", LINE, DISTINCT[0], fitted).in_legend());
        panel
    }

    fn residuals(&self, own: &[usize]) -> Panel {
        let residuals = self.of(self.residual, own);
        let heights = residuals.iter().copied().chain([-2.0, 2.0]);
        let y = Measure::NUMBER.axis("residual, in deviations", Spacing::Linear, heights, 0.08);
        let mut panel = Panel::new(self.along(own), y);
        let zero = panel.x.range.map(|at| [at, 0.0]).to_vec();
        panel.series.push(Series::new("", LEVEL, Colour::GREY, zero));
        let found = points(&self.of(self.at, own), &residuals);
        panel.series.push(Series::new("", POINT, Colour::BLACK, found));
        panel
    }
}

/// How the misfit rises with each unknown.
fn profiles(file: &Dataset) -> Result<Vec<Panel>> {
    let count = file.along("parameter")?.len();
    let places = file.along("point")?.len();
    let (keys, units) = (file.words("key", count)?, file.words("unit", count)?);
    let [lower, upper] = ["lower", "upper"].map(|name| file.numbers(name, &[count]));
    let [x, y] = ["profile_value", "profile_misfit"].map(|name| file.numbers(name, &[count, places]));
    let (x, y, lower, upper) = (x?, y?, lower?, upper?);
    let panel = |i: usize| {
        let part = i * places..(i + 1) * places;
        let is_known = |it: &[f64; 2]| it[0].is_finite() && it[1].is_finite();
        let all: Vec<[f64; 2]> = points(&x[part.clone()], &y[part]).into_iter().filter(is_known).collect();
        let within = |it: &&[f64; 2]| {
            let low = if lower[i].is_finite() { lower[i] } else { f64::NEG_INFINITY };
            let high = if upper[i].is_finite() { upper[i] } else { f64::INFINITY };
            it[0] >= low * (1.0 - 1e-9) && it[0] <= high * (1.0 + 1e-9)
        };
        let level = all.iter().filter(within).map(|it| it[1]).fold(1.0, f64::max);
        let curve: Vec<[f64; 2]> = all.into_iter().filter(|it| it[1] <= ROOM * level).collect();
        let unit = unit_in_words(units.get(i));
        let x = Measure::NUMBER.axis(keys.get(i), Spacing::Linear, curve.iter().map(|it| it[0]), 0.06);
        let heights = curve.iter().map(|it| it[1]).chain([0.0]);
        let y = Measure::NUMBER.axis("misfit above the least", Spacing::Linear, heights, 0.06);
        let mut panel = Panel::new(Axis { unit, ..x }, y);
        let base = panel.y.range[0];
        for end in [lower[i], upper[i]].into_iter().filter(|end| end.is_finite()) {
            panel.series.push(Series::new("", LEVEL, Colour::GREY, vec![[end, base], [end, level]]));
        }
        panel.series.push(Series::new("", LINE, DISTINCT[0], rounded(&curve)));
        panel.series.push(Series::new("", POINT, DISTINCT[0], curve));
        panel
    };
    Ok((0..count.min(MOST)).map(panel).collect())
}

/// A profile between its points: its root, with a sign, is straight there, as that of a parabola.
fn rounded(curve: &[[f64; 2]]) -> Vec<[f64; 2]> {
    const PARTS: usize = 12;
    let least = curve.iter().map(|it| it[1]).fold(f64::INFINITY, f64::min);
    let lowest = curve.iter().position(|it| it[1] == least).unwrap_or(0);
    let root = |i: usize| curve[i][1].max(0.0).sqrt() * if i < lowest { -1.0 } else { 1.0 };
    let between = |i: usize| {
        let ([x, _], [end, _]) = (curve[i - 1], curve[i]);
        (0..PARTS).map(move |part| {
            let part = part as f64 / PARTS as f64;
            let root = root(i - 1) + part * (root(i) - root(i - 1));
            [x + part * (end - x), root * root]
        })
    };
    (1..curve.len()).flat_map(between).chain(curve.last().copied()).collect()
}

/// A corner: each unknown against those before it.
fn corner(file: &Dataset) -> Result<Vec<Row>> {
    let count = file.along("parameter")?.len();
    if count < 2 || !file.has("draw_value") {
        return Ok(vec![]);
    }
    let draws = file.along("draw")?.len();
    let (keys, units) = (file.words("key", count)?, file.words("unit", count)?);
    let values = file.numbers("draw_value", &[draws, count])?;
    let [estimate, lower, upper] = ["estimate", "lower", "upper"].map(|name| file.numbers(name, &[count]));
    let (estimate, ends) = (estimate?, [lower?, upper?]);
    let of = |i: usize| -> Vec<f64> { (0..draws).map(|draw| values[draw * count + i]).collect() };
    let axis = |i: usize| {
        let all = of(i).into_iter().chain([estimate[i]]);
        let unit = unit_in_words(units.get(i));
        Axis { unit, ..Measure::NUMBER.axis(keys.get(i), Spacing::Linear, all, 0.05) }
    };
    let panel = |i: usize, j: usize| {
        let mut panel = Panel::new(axis(j), axis(i));
        panel.series.push(Series::new("", DRAW, DISTINCT[0], points(&of(j), &of(i))));
        let (x, y) = (panel.x.range, panel.y.range);
        for end in ends.map(|it| it[j]).into_iter().filter(|it| it.is_finite()) {
            panel.series.push(Series::new("", LEVEL, Colour::GREY, y.map(|it| [end, it]).to_vec()));
        }
        for end in ends.map(|it| it[i]).into_iter().filter(|it| it.is_finite()) {
            panel.series.push(Series::new("", LEVEL, Colour::GREY, x.map(|it| [it, end]).to_vec()));
        }
        panel.series.push(Series::new("", CENTRE, Colour::BLACK, vec![[estimate[j], estimate[i]]]));
        panel
    };
    let row = |i: usize| Row { height: 200.0, panels: (0..i).map(|j| panel(i, j)).collect() };
    Ok((1..count.min(MOST_OF_CORNER)).map(row).collect())
}

/// What is foretold of another scene over its cycles.
fn bands(file: &Dataset) -> Result<Vec<Row>> {
    if !file.has("forecast_cycles") {
        return Ok(vec![]);
    }
    let count = file.along("forecast_snapshot")?.len();
    let cycles = file.numbers("forecast_cycles", &[count])?;
    let panel = |name: &str, quantity: &str, unit: &str, from_zero: bool| -> Result<Panel> {
        let all = file.numbers(name, &[3, count])?;
        let known = |side: usize| -> Vec<[f64; 2]> {
            let own = points(cycles, &all[side * count..(side + 1) * count]);
            own.into_iter().filter(|it| it[1].is_finite()).collect()
        };
        let heights = all.iter().copied().filter(|it| it.is_finite()).chain(from_zero.then_some(0.0));
        let y = Axis { unit: unit.into(), ..Measure::NUMBER.axis(quantity, Spacing::Linear, heights, 0.05) };
        let x = Measure::NUMBER.axis("cycles", Spacing::Linear, cycles.iter().copied(), 0.02);
        let mut panel = Panel::new(x, y);
        let ring = known(1).into_iter().chain(known(2).into_iter().rev()).collect();
        let name = "where 95 % of the draws lie";
        panel.series.push(Series::new(name, Style::Region { opacity: 0.3 }, DISTINCT[0], ring).in_legend());
        panel.series.push(Series::new("foretold", LINE, DISTINCT[0], known(0)).in_legend());
        Ok(panel)
    };
    let panels = vec![
        panel("forecast_wear_volume", "worn volume foretold", "m³", true)?,
        panel("forecast_contact_radius", "contact radius foretold", "m", false)?,
    ];
    Ok(vec![Row { height: 200.0, panels }])
}
