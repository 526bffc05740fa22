//! The grading that wears least, over the amplitude.

use super::measure::{Measure, points};
use crate::data::Dataset;
use crate::error::Result;
use crate::figures::drawing::{DISTINCT, Dash, Figure, Panel, Row, Series, Spacing, Style, plain};
use crate::report::number;

/// Datasets of the optimum at the same force, in one rule and the other.
const FORCE: [(&str, &str); 2] =
    [("_force", "same force"), ("_force_depth_only", "same force, amplitude as at the same depth")];

pub(super) fn figure(file: &Dataset) -> Result<Figure> {
    let amplitudes = file.along("optimum_amplitude_ratio")?;
    let mut curves = vec![(
        "same indentation".to_owned(),
        ["optimal_grading", "optimal_wear_volume_ratio"].map(|name| file.numbers(name, &[amplitudes.len()])),
    )];
    let depths = file.along("reference_depth")?;
    for (ending, meaning) in FORCE {
        let shape = [depths.len(), amplitudes.len()];
        let rows = ["optimal_grading", "optimal_wear_volume_ratio"]
            .map(|name| file.numbers(&format!("{name}{ending}"), &shape));
        let [gradings, ratios] = rows;
        let (gradings, ratios) = (gradings?, ratios?);
        for (row, depth) in depths.iter().enumerate() {
            let part = row * amplitudes.len()..(row + 1) * amplitudes.len();
            let name = format!("{meaning}, *z*_{{0}} = {} *a*", number(*depth));
            curves.push((name, [Ok(&gradings[part.clone()]), Ok(&ratios[part])]));
        }
    }
    let x = Measure::NUMBER.axis(
        "amplitude *U*/(*μ*_{f}*d*)",
        Spacing::Logarithmic,
        amplitudes.iter().copied(),
        0.0,
    );
    let mut panels = [vec![], vec![]];
    for (place, (name, rows)) in curves.into_iter().enumerate() {
        let style = Style::Line { width: 1.8, dash: Dash::ALL[place % Dash::ALL.len()] };
        for (series, values) in panels.iter_mut().zip(rows) {
            let curve = points(amplitudes, values?);
            series
                .push(Series::new(name.clone(), style, DISTINCT[place % DISTINCT.len()], curve).in_legend());
        }
    }
    let [gradings, ratios] = panels;
    let values = |series: &[Series]| {
        series.iter().flat_map(|it| it.points.iter().map(|point| point[1])).collect::<Vec<_>>()
    };
    let grading = Measure::NUMBER.axis("optimal grading *k*", Spacing::Linear, values(&gradings), 0.05);
    let ratio = Measure::NUMBER.axis("least Δ*V*(*k*)/Δ*V*(0)", Spacing::Logarithmic, values(&ratios), 0.05);
    let upper = Panel { series: gradings, ..Panel::new(x.clone(), grading) };
    let mut lower = Panel { series: ratios, ..Panel::new(x, ratio) };
    lower.series.iter_mut().for_each(|series| series.in_legend = false);
    let title = if file.title().is_empty() { "Optimal grading".into() } else { plain(file.title()) };
    Ok(Figure {
        title: Some(title),
        rows: vec![Row { height: 190.0, panels: vec![upper] }, Row { height: 170.0, panels: vec![lower] }],
        notes: vec!["*k* = 1 and −1 stand for limits that are not reached; amplitude relative to the homogeneous contact.".into()],
    })
}
