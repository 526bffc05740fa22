//! A result of a sweep over what is varied.

mod map;

use std::collections::HashSet;

use super::measure::Measure;
use crate::data::{SweepFile, Values, Variable};
use crate::error::{Error, Result};
use crate::figures::drawing::{
    Axis, Colour, DISTINCT, Dash, Figure, Panel, Row, Series, Shape, Spacing, Style, plain,
};
use crate::report::{Scale, number};

/// Up to so many values of the second axis are curves of their own; more are a map.
const MOST_CURVES: usize = 7;
/// From so many samples at a place on their band is drawn.
const MANY_SAMPLES: usize = 5;
/// Values further apart than this, from the first to the last, and geometrically spread, ask for a logarithmic axis.
const WIDE: f64 = 30.0;
/// Results whose largest is more than so many times their smallest are shown by their logarithms.
const VERY_WIDE: f64 = 300.0;
/// Dots of scenes, at most.
const MOST_DOTS: usize = 5000;
/// Quantities of which the first that is there is drawn.
const USUAL: [&str; 2] = ["wear_volume", "wear_volume_limit"];

/// Something that is varied.
pub(super) struct Input<'a> {
    key: &'a str,
    pub(super) values: &'a [f64],
    different: Vec<f64>,
    measure: Measure,
}

pub(super) fn figure(file: &SweepFile, quantity: Option<&str>) -> Result<Figure> {
    let result = result(file, quantity)?;
    let inputs = inputs(file);
    let Values::Numbers(values) = &result.values else { return Err(no_quantity(file, &result.name)) };
    if !values.iter().any(|value| value.is_finite()) {
        let why = format!("{} has no value in any of the {} scenes", result.name, values.len());
        return Err(Error::Inconsistent { what: "quantity", why });
    }
    let measure =
        Scale::of(&result.units).map_or(Measure::NUMBER, |scale| Measure::new(scale, values.iter().copied()));
    let values = measure.all(values);
    let unit = if Scale::of(&result.units).is_some() || result.units == "1" {
        measure.symbol()
    } else {
        &result.units
    };
    let meaning = plain(&result.long_name);
    let wanted = |values: &[f64]| {
        let axis = measure.axis(&meaning, spacing(values), values.iter().copied(), 0.06);
        Axis { unit: unit.to_owned(), ..axis }
    };
    let panel = match &inputs[..] {
        [] => {
            let why =
                "varies no number, so there is nothing to draw over; look at it with fretwear info".into();
            return Err(Error::Inconsistent { what: "sweep", why });
        }
        [one] => curves(one, None, &values, wanted(&values)),
        [one, other] if one.different.len() * other.different.len() == values.len() => {
            let (few, many) =
                if one.different.len() <= other.different.len() { (one, other) } else { (other, one) };
            if few.different.len() <= MOST_CURVES {
                curves(many, Some(few), &values, wanted(&values))
            } else {
                map::panel(one, other, &values, wanted(&values))
            }
        }
        all => scatter(all, &values, wanted(&values)),
    };
    let title = Some(plain(&file.header.title)).filter(|title| !title.is_empty());
    Ok(Figure { title, rows: vec![Row { height: 300.0, panels: vec![panel] }], notes: notes(file, &values) })
}

fn notes(file: &SweepFile, values: &[f64]) -> Vec<String> {
    let mut notes = vec![];
    let lacking = values.iter().filter(|value| !value.is_finite()).count();
    if lacking > 0 {
        notes.push(format!(
            "{lacking} of {} scenes have no value: they failed, or it has no meaning there.",
            values.len()
        ));
    }
    if !file.complete || (values.len() as u64) < file.header.scenes {
        notes.push(format!("Not complete: {} of {} scenes.", values.len(), file.header.scenes));
    }
    notes
}

/// A sentence about the scenes that are less accurate than was asked for.
pub(super) fn inaccurate(file: &SweepFile) -> Option<String> {
    let column = file.columns.iter().find(|it| it.name == "accuracy_met")?;
    let Values::Numbers(met) = &column.values else { return None };
    let missed = met.iter().filter(|it| **it == 0.0).count();
    (missed > 0).then(|| format!("{missed} of {} scenes are less accurate than was asked for.", met.len()))
}

/// Logarithmic where results are positive and of very different sizes.
fn spacing(values: &[f64]) -> Spacing {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let (least, most) = (finite().fold(f64::INFINITY, f64::min), finite().fold(0.0, f64::max));
    if least > 0.0 && most > VERY_WIDE * least { Spacing::Logarithmic } else { Spacing::Linear }
}

/// The column that is drawn.
fn result<'a>(file: &'a SweepFile, quantity: Option<&str>) -> Result<&'a Variable> {
    let find = |name: &str| file.columns.iter().find(|column| column.name == name);
    match quantity {
        Some(name) => find(name).filter(|it| is_result(it)).ok_or_else(|| no_quantity(file, name)),
        None => USUAL.into_iter().find_map(find).ok_or_else(|| no_quantity(file, USUAL[0])),
    }
}

fn is_result(column: &Variable) -> bool {
    matches!(column.values, Values::Numbers(_)) && !column.name.starts_with("input_")
}

fn no_quantity(file: &SweepFile, name: &str) -> Error {
    let names: Vec<&str> =
        file.columns.iter().filter(|it| is_result(it)).map(|it| it.name.as_str()).collect();
    let why = format!("{name} is no number that the sweep found; give one of {}", names.join(", "));
    Error::Inconsistent { what: "quantity", why }
}

/// What is varied and a number, the keys in the order of the file.
pub(super) fn inputs(file: &SweepFile) -> Vec<Input<'_>> {
    file.columns.iter().filter_map(input).collect()
}

fn input(column: &Variable) -> Option<Input<'_>> {
    let Variable { name, long_name, values: Values::Numbers(values), .. } = column else { return None };
    // The file says "KEY of the scene, in SI".
    let key = long_name.split_once(" of the scene").map_or(name.as_str(), |(key, _)| key);
    let mut different: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    different.sort_by(f64::total_cmp);
    different.dedup();
    let measure =
        scale_of_key(key).map_or(Measure::NUMBER, |scale| Measure::new(scale, values.iter().copied()));
    let varies = name.starts_with("input_") && different.len() > 1;
    varies.then_some(Input { key, values, different, measure })
}

/// Units of the values of a key of the scene.
fn scale_of_key(key: &str) -> Option<Scale> {
    match key.rsplit('.').next().unwrap_or(key) {
        "radius"
        | "amplitude"
        | "stroke"
        | "indentation"
        | "transverse_amplitude"
        | "reference_depth"
        | "smoothing" => Some(Scale::LENGTH),
        "initial_force" | "normal_force" | "tangential_force" => Some(Scale::FORCE),
        "modulus" | "pressure" => Some(Scale::PRESSURE),
        _ => None,
    }
}

impl Input<'_> {
    pub(super) fn at(&self, row: usize) -> f64 {
        self.measure.of(self.values[row])
    }

    /// Whether whoever knows this one knows the other.
    fn tells(&self, other: &Self) -> bool {
        let pairs = self.values.iter().zip(other.values).map(|(one, other)| (one.to_bits(), other.to_bits()));
        pairs.collect::<HashSet<_>>().len() <= self.different.len()
    }

    /// `key = value unit`.
    fn says(&self, value: f64) -> String {
        let value = format!("{} {}", number(self.measure.of(value)), self.measure.symbol());
        format!("{} = {}", plain(self.key), value.trim_end())
    }

    pub(super) fn axis(&self, margin: f64) -> Axis {
        let values = self.different.iter().map(|value| self.measure.of(*value));
        self.measure.axis(&plain(self.key), self.spacing(), values, margin)
    }

    /// Logarithmic where the values are spread so.
    fn spacing(&self) -> Spacing {
        let [first, last] = [self.different[0], self.different[self.different.len() - 1]];
        let middle = self.different[self.different.len() / 2];
        // Values spread evenly have their middle one at half of their range.
        let geometric = first > 0.0 && last > WIDE * first && middle < 0.35 * last;
        if geometric { Spacing::Logarithmic } else { Spacing::Linear }
    }
}

/// Curves over one input, one for each value of the other.
fn curves(over: &Input, each: Option<&Input>, values: &[f64], y: Axis) -> Panel {
    let mut panel = Panel::new(over.axis(0.04), y);
    let groups: Vec<Option<f64>> = match each {
        Some(each) => each.different.iter().copied().map(Some).collect(),
        None => vec![None],
    };
    for (place, group) in groups.into_iter().enumerate() {
        let belongs = |row: &usize| each.zip(group).is_none_or(|(each, value)| each.values[*row] == value);
        // A scene without a value breaks the line.
        let rows = (0..values.len()).filter(belongs);
        let mut points: Vec<[f64; 2]> = rows.map(|row| [over.at(row), values[row]]).collect();
        points.sort_by(|one, other| one[0].total_cmp(&other[0]));
        let colour = DISTINCT[place % DISTINCT.len()];
        let line = Style::Line { width: 1.6, dash: Dash::ALL[place % Dash::ALL.len()] };
        let marks = Style::Points { shape: Shape::ALL[place % Shape::ALL.len()], radius: 3.0 };
        let name = each.zip(group).map_or_else(|| plain(over.key), |(each, value)| each.says(value));
        let curve = Series::new(name, line, colour, points.clone());
        panel.series.push(if each.is_some() { curve.in_legend() } else { curve });
        panel.series.push(Series::new("", marks, colour, points));
    }
    panel
}

/// Samples over an input that has few values: all of them, their median, and the band that nine of ten are in.
fn scatter(inputs: &[Input], values: &[f64], y: Axis) -> Panel {
    // Variables that are sampled together tell each other; what is varied besides them tells none.
    let tells = |input: &Input| inputs.iter().any(|other| other.key != input.key && input.tells(other));
    let over = inputs
        .iter()
        .min_by_key(|input| (tells(input), input.different.len()))
        .expect("there are at least two inputs");
    let mut panel = Panel::new(over.axis(0.06), y);
    let mut bands: Vec<[f64; 4]> = vec![];
    for place in &over.different {
        let rows = (0..values.len()).filter(|row| over.values[*row] == *place && values[*row].is_finite());
        let mut samples: Vec<f64> = rows.map(|row| values[row]).collect();
        samples.sort_by(f64::total_cmp);
        if samples.len() >= MANY_SAMPLES {
            let [low, middle, high] = [0.05, 0.5, 0.95].map(|part| quantile(&samples, part));
            bands.push([over.measure.of(*place), low, middle, high]);
        }
    }
    let edge = |which: usize| bands.iter().map(move |band| [band[0], band[which]]);
    if bands.len() > 1 {
        let ring = edge(1).chain(edge(3).rev()).collect();
        let region = Series::new("9 of 10 samples", Style::Region { opacity: 0.25 }, DISTINCT[0], ring);
        panel.series.push(region.in_legend());
    }
    // Of very many samples some: more are a black bar of many megabytes.
    let every = values.len().div_ceil(MOST_DOTS).max(1);
    let all = (0..values.len()).step_by(every).map(|row| [over.at(row), values[row]]).collect();
    let dots = Style::Points { shape: Shape::Circle, radius: 1.8 };
    panel.series.push(Series::new("samples", dots, DISTINCT[0], all).in_legend());
    if bands.len() > 1 {
        let line = Style::Line { width: 2.0, dash: Dash::Solid };
        panel.series.push(Series::new("median", line, Colour::BLACK, edge(2).collect()).in_legend());
    }
    panel
}

/// Quantile of sorted samples, linear between them.
fn quantile(sorted: &[f64], part: f64) -> f64 {
    let place = part * (sorted.len() - 1) as f64;
    let below = place as usize;
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
}
