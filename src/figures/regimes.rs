//! Fretting regimes over cycles and what a sweep varies: a running condition fretting map.

use super::measure::Measure;
use super::sweep::{Input, inaccurate, inputs};
use crate::contact::stick_slip::{FrettingRegime, Regime};
use crate::data::{Snapshot, SweepFile, fretting_regimes};
use crate::error::{Error, Result};
use crate::figures::drawing::{
    Axis, Colour, DISTINCT, Figure, Panel, Row, Series, Shape, Spacing, Style, plain,
};

const DOT: Style = Style::Points { shape: Shape::Disc, radius: 0.9 };

/// Conditions that are told apart: those of the cycle, and of the run before.
const AREAS: [(&str, FrettingRegime, Option<Regime>); 5] = [
    ("stick", FrettingRegime::Stick, None),
    ("partial slip", FrettingRegime::PartialSlip, None),
    ("mixed, now partial slip", FrettingRegime::Mixed, Some(Regime::PartialSlip)),
    ("mixed, now gross slip", FrettingRegime::Mixed, Some(Regime::FullSliding)),
    ("gross slip", FrettingRegime::FullSliding, None),
];

fn colour(area: usize) -> Colour {
    [Colour::LIGHT, DISTINCT[0].towards_white(0.7), DISTINCT[0], DISTINCT[1], DISTINCT[1].towards_white(0.6)]
        [area]
}

/// Whether a sweep can be drawn so: one number is varied, and runs are kept.
pub(super) fn fits(file: &SweepFile) -> bool {
    inputs(file).len() == 1 && file.runs.iter().any(|(_, run)| run.snapshots.iter().any(|it| it.cycles > 0.0))
}

pub(super) fn figure(file: &SweepFile) -> Result<Figure> {
    let inputs = inputs(file);
    let ([over], true) = (&inputs[..], fits(file)) else {
        let why = "needs a sweep over one number that keeps its snapshots".into();
        return Err(Error::Inconsistent { what: "kind", why });
    };
    let mut rows: Vec<(f64, &[Snapshot])> = file
        .runs
        .iter()
        .filter_map(|(scene, run)| {
            let row = file.scenes.iter().position(|it| it == scene)?;
            Some((over.at(row), &run.snapshots[..])).filter(|(value, _)| value.is_finite())
        })
        .collect();
    rows.sort_by(|one, other| one.0.total_cmp(&other.0));
    let panel = panel(over, &rows);
    let title = Some(plain(&file.header.title)).filter(|title| !title.is_empty());
    let lacking = over.values.len() - rows.len();
    let lacks =
        (lacking > 0).then(|| format!("{lacking} of {} scenes have no snapshots.", over.values.len()));
    let notes = lacks.into_iter().chain(inaccurate(file)).collect();
    Ok(Figure { title, rows: vec![Row { height: 300.0, panels: vec![panel] }], notes })
}

/// Bands of the values, each with areas along the cycles that reach half way to the next snapshot.
fn panel(over: &Input, rows: &[(f64, &[Snapshot])]) -> Panel {
    let cycles = rows.iter().flat_map(|row| row.1).map(|it| it.cycles).filter(|it| *it > 0.0);
    let x = Measure::NUMBER.axis("cycles *N*", Spacing::Logarithmic, cycles, 0.0);
    let mut panel = Panel::new(x, over.axis(0.0));
    let values: Vec<f64> = rows.iter().map(|row| row.0).collect();
    let bands = borders(&panel.y, &values);
    let mut rings = AREAS.map(|_| vec![]);
    let mut dots = vec![];
    for (place, (value, snapshots)) in rows.iter().enumerate() {
        let regimes = fretting_regimes(snapshots);
        let worn = snapshots.iter().zip(regimes).filter(|(it, _)| it.cycles > 0.0);
        let (worn, regimes): (Vec<&Snapshot>, Vec<FrettingRegime>) = worn.unzip();
        let times: Vec<f64> = worn.iter().map(|it| it.cycles).collect();
        let edges = borders(&panel.x, &times);
        let area = |i: usize| {
            let fits = |it: &(&str, FrettingRegime, Option<Regime>)| {
                it.1 == regimes[i] && it.2.is_none_or(|cycle| cycle == worn[i].regime)
            };
            // A run that slid and now sticks altogether is as one that slips in part.
            AREAS.iter().position(fits).unwrap_or(2)
        };
        let mut start = 0;
        for i in 0..worn.len() {
            if i + 1 < worn.len() && area(i + 1) == area(i) {
                continue;
            }
            let ([left, right], [low, high]) =
                ([edges[start], edges[i + 1]], [bands[place], bands[place + 1]]);
            rings[area(i)].extend([[left, low], [right, low], [right, high], [left, high], [f64::NAN; 2]]);
            start = i + 1;
        }
        dots.extend(times.iter().map(|cycles| [*cycles, *value]));
    }
    for (number, (ring, (name, ..))) in
        rings.into_iter().zip(AREAS).enumerate().filter(|it| !it.1.0.is_empty())
    {
        panel
            .series
            .push(Series::new(name, Style::Region { opacity: 1.0 }, colour(number), ring).in_legend());
    }
    panel.series.push(Series::new("snapshots", DOT, Colour::BLACK, dots));
    panel
}

/// Borders half way between neighbours along an axis, with its ends.
fn borders(axis: &Axis, values: &[f64]) -> Vec<f64> {
    let [first, last] = axis.range;
    let between = values.windows(2).map(|pair| axis.value(0.5 * (axis.place(pair[0]) + axis.place(pair[1]))));
    let mut borders = vec![first];
    borders.extend(between);
    borders.push(last);
    borders
}
