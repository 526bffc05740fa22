//! Worn profiles of media of several gradings at one amplitude [S, Fig. 1].

use super::measure::{Measure, points};
use crate::data::Dataset;
use crate::error::Result;
use crate::figures::drawing::{Colour, Dash, Figure, Panel, Row, Series, Spacing, Style, graded, plain};
use crate::report::number;
use crate::scene::MapScene;

/// Lightest colour of a curve.
const LIGHTEST: f64 = 0.12;

pub(super) fn figure(file: &Dataset) -> Result<Figure> {
    let gradings = file.along("profile_grading")?;
    let radii = file.along("profile_radius")?;
    let initial = file.numbers("profile_initial", &[radii.len()])?;
    let depths = file.numbers("profile_wear_depth", &[gradings.len(), radii.len()])?;
    let map = MapScene::from_toml(file.text("map").unwrap_or_default(), "the map in the file")?;
    let curves: Vec<&[f64]> = depths.chunks(radii.len().max(1)).collect();
    let slides = |depths: &&[f64]| depths.iter().any(|depth| !depth.is_finite());
    let sliding: Vec<String> =
        gradings.iter().zip(&curves).filter(|(_, curve)| slides(curve)).map(|(k, _)| number(*k)).collect();

    let profiles =
        curves.iter().map(|curve| curve.iter().zip(initial).map(|(w, f)| w + f).collect::<Vec<_>>());
    let profiles: Vec<Vec<f64>> = profiles.collect();
    let x = || Measure::NUMBER.axis(&radius_name(map.exponent), Spacing::Linear, radii.iter().copied(), 0.0);
    let axis = |name: &str, values: &[f64]| {
        Measure::NUMBER.axis(name, Spacing::Linear, values.iter().copied(), 0.04)
    };
    let mut left = Panel::new(x(), axis("profile *f*/*d*", initial));
    let mut right = Panel::new(x(), axis("wear depth *w*_{∞}/*d*", depths));
    left.series.push(unworn(radii, initial));
    for (place, (grading, (profile, depth))) in gradings.iter().zip(profiles.iter().zip(&curves)).enumerate()
    {
        let part = place as f64 / (gradings.len().max(2) - 1) as f64;
        let colour = graded(LIGHTEST + (1.0 - LIGHTEST) * part);
        // Colours next to each other also differ in their pattern.
        let style = Style::Line { width: 1.7, dash: Dash::ALL[place % Dash::ALL.len()] };
        let name = format!("*k* = {}", number(*grading).replace('-', "−"));
        if depth.iter().all(|depth| depth.is_finite()) {
            left.series.push(Series::new(name.clone(), style, colour, points(radii, profile)).in_legend());
            right.series.push(Series::new(name, style, colour, points(radii, depth)));
        }
    }
    let exponent = number(map.exponent);
    let setting = format!("*U*/(*μ*_{{f}}*d*) = {}, *n* = {exponent}", number(map.profile_amplitude_ratio));
    let mut notes = vec![format!("{setting}; same indentation *d*.")];
    if !sliding.is_empty() {
        notes.push(format!(
            "Full sliding, without a limit, for *k* = {}.",
            sliding.join(", ").replace('-', "−")
        ));
    }
    let title = if file.title().is_empty() {
        "Limiting profiles of graded media".into()
    } else {
        plain(file.title())
    };
    Ok(Figure { title: Some(title), rows: vec![Row { height: 270.0, panels: vec![left, right] }], notes })
}

fn unworn(radii: &[f64], initial: &[f64]) -> Series {
    let style = Style::Line { width: 1.3, dash: Dash::Dotted };
    Series::new("unworn", style, Colour::BLACK, points(radii, initial)).in_legend()
}

/// The radius and what it is relative to, for `f = A r^n`.
fn radius_name(exponent: f64) -> String {
    if exponent == 2.0 { "radius *r*/√(*R d*)".into() } else { "radius *r*/(*d*/(*n A*))^{1/n}".into() }
}
