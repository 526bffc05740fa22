//! Worn volume over grading and amplitude, with lines of equal wear and the line of full sliding [S, Fig. 2].

use super::measure::points;
use super::rings::Grid;
use crate::data::Dataset;
use crate::error::Result;
use crate::figures::drawing::{
    Axis, Bar, Colour, Dash, Figure, Label, Panel, Row, Series, Spacing, Style, graded, plain,
};
use crate::report::number;

/// Bands of colour over the range of the worn volume.
const BANDS: usize = 24;
/// Range of ΔV(k)/ΔV(0) that colours tell apart; beyond it they stay the same.
const RANGE: [f64; 2] = [0.1, 20.0];
/// Isolines with fewer points have no room for their label.
const FEW_POINTS: usize = 25;
/// Room of a label, in parts of the frame.
const ROOM: [f64; 2] = [0.1, 0.05];
const LINE: Style = Style::Line { width: 0.8, dash: Dash::Solid };
const EQUAL: Style = Style::Line { width: 2.0, dash: Dash::Solid };

/// The exact map and that of small amplitudes.
struct Form {
    title: &'static str,
    values: &'static str,
    isolines: [&'static str; 4],
}

const FORMS: [Form; 2] = [
    Form {
        title: "exact",
        values: "wear_volume_ratio",
        isolines: ["isoline_number", "isoline_level", "isoline_grading", "isoline_amplitude_ratio"],
    },
    Form {
        title: "for small amplitudes",
        values: "wear_volume_ratio_small_amplitude",
        isolines: [
            "small_amplitude_isoline_number",
            "small_amplitude_isoline_level",
            "small_amplitude_isoline_grading",
            "small_amplitude_isoline_amplitude_ratio",
        ],
    },
];

pub(super) fn figure(file: &Dataset) -> Result<Figure> {
    let mut panels = FORMS.iter().map(|form| panel(file, form)).collect::<Result<Vec<_>>>()?;
    panels[1].y.quantity = String::new();
    panels[1].bar = Some(bar());
    let title =
        if file.title().is_empty() { "Worn volume of graded media".into() } else { plain(file.title()) };
    let note = "Dots: the grading that wears least at an amplitude. Heavy line: as much wear as the homogeneous medium.";
    Ok(Figure {
        title: Some(title),
        rows: vec![Row { height: 330.0, panels }],
        notes: vec!["Same indentation *d* for all gradings.".into(), note.into()],
    })
}

fn panel(file: &Dataset, form: &Form) -> Result<Panel> {
    let gradings = file.along("grading")?;
    let amplitudes = file.along("amplitude_ratio")?;
    let values = file.numbers(form.values, &[gradings.len(), amplitudes.len()])?;
    let x = axis("grading *k*", Spacing::Linear, gradings)
        .ok_or_else(|| file.damaged("grading", &"has no range"))?;
    let y = axis("amplitude *U*/(*μ*_{f}*d*)", Spacing::Logarithmic, amplitudes)
        .ok_or_else(|| file.damaged("amplitude_ratio", &"has no range"))?;
    let mut panel = Panel::new(x, y).titled(form.title);
    add_bands(&mut panel, gradings, amplitudes, values);
    add_isolines(&mut panel, file, form)?;
    add_full_sliding(&mut panel, gradings, file.numbers("full_sliding_amplitude_ratio", &[gradings.len()])?);
    let least = [file.along("optimal_grading")?, file.along("optimum_amplitude_ratio")?];
    let inside = |point: &[f64; 2]| {
        let [low, high] = panel.x.range;
        point[0] > low && point[0] < high && point[1] >= panel.y.range[0]
    };
    let least = points(least[0], least[1]).into_iter().filter(inside).collect();
    let dots = Style::Line { width: 1.6, dash: Dash::Dotted };
    panel.series.push(Series::new("least wear", dots, Colour::BLACK, least));
    Ok(panel)
}

fn axis(quantity: &str, spacing: Spacing, values: &[f64]) -> Option<Axis> {
    let range = [*values.first()?, *values.last()?];
    let fits = range[0] < range[1] && (spacing == Spacing::Linear || range[0] > 0.0);
    (fits && range.iter().all(|end| end.is_finite())).then(|| Axis::new(quantity, "", spacing, range))
}

/// Logarithm of the lower end of a band, as a level.
fn level(band: usize) -> f64 {
    let [low, high] = RANGE.map(f64::ln);
    low + (high - low) * band as f64 / BANDS as f64
}

/// Much wear is dark, and all is pale enough for lines to be seen.
fn colour(band: usize) -> Colour {
    graded((band as f64 + 0.5) / BANDS as f64).towards_white(0.35)
}

fn add_bands(panel: &mut Panel, gradings: &[f64], amplitudes: &[f64], values: &[f64]) {
    let logarithms = without_gaps(values, amplitudes.len());
    // Rings are found where the axes are even.
    let heights: Vec<f64> = amplitudes.iter().map(|amplitude| amplitude.ln()).collect();
    let grid = Grid { first: gradings, second: &heights, values: &logarithms };
    for band in 0..BANDS {
        let level = if band == 0 { f64::NEG_INFINITY } else { level(band) };
        let rings = if band == 0 { frame(panel) } else { rounded(grid.rings(level)) };
        if rings.is_empty() {
            continue;
        }
        panel.series.push(Series::new("", Style::Region { opacity: 1.0 }, colour(band), rings));
    }
}

fn frame(panel: &Panel) -> Vec<[f64; 2]> {
    let ([left, right], [low, high]) = (panel.x.range, panel.y.range);
    vec![[left, low], [right, low], [right, high], [left, high]]
}

/// Rings with amplitudes for their logarithms.
fn rounded(rings: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    rings.into_iter().map(|[grading, height]| [grading, height.exp()]).collect()
}

/// Logarithms, with the last one before full sliding where there is none: what lies there is covered.
fn without_gaps(values: &[f64], row: usize) -> Vec<f64> {
    let mut last = 0.0;
    let mut filled = Vec::with_capacity(values.len());
    for (place, value) in values.iter().enumerate() {
        if place % row.max(1) == 0 {
            last = 0.0;
        }
        let logarithm = value.ln();
        last = if logarithm.is_finite() { logarithm } else { last };
        filled.push(last);
    }
    filled
}

fn add_isolines(panel: &mut Panel, file: &Dataset, form: &Form) -> Result<()> {
    let [numbers, levels, gradings, amplitudes] = form.isolines;
    let numbers = file.along(numbers)?;
    let columns = [levels, gradings, amplitudes].map(|name| file.numbers(name, &[numbers.len()]));
    let [levels, gradings, amplitudes] = columns;
    let (levels, gradings, amplitudes) = (levels?, gradings?, amplitudes?);
    let mut start = 0;
    for run in numbers.chunk_by(|one, other| one == other) {
        let part = start..start + run.len();
        start = part.end;
        let level = levels[part.start];
        let points = points(&gradings[part.clone()], &amplitudes[part]);
        let style = if level == 1.0 { EQUAL } else { LINE };
        let text = number(level);
        if points.len() >= FEW_POINTS {
            add_label(panel, &text, &points);
        }
        panel.series.push(Series::new(format!("Δ*V*(*k*)/Δ*V*(0) = {text}"), style, Colour::BLACK, points));
    }
    Ok(())
}

/// Writes on a line where there is room, or nowhere.
fn add_label(panel: &mut Panel, text: &str, points: &[[f64; 2]]) {
    const PARTS: [f64; 7] = [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8];
    let on_frame = |axes: &Panel, point: [f64; 2]| [axes.x.place(point[0]), axes.y.place(point[1])];
    let candidates = PARTS.map(|part| points[(part * points.len() as f64) as usize]);
    let free = candidates.into_iter().find(|point| {
        let [x, y] = on_frame(panel, *point);
        let apart = |label: &Label| {
            let [other_x, other_y] = on_frame(panel, label.at);
            (x - other_x).abs() > ROOM[0] || (y - other_y).abs() > ROOM[1]
        };
        let inside = |place: f64, margin: f64| (margin..1.0 - margin).contains(&place);
        inside(x, 0.6 * ROOM[0]) && inside(y, ROOM[1]) && panel.labels.iter().all(apart)
    });
    if let Some(at) = free {
        let label = Label::new(text, at, Colour::BLACK);
        panel.labels.push(Label { anchor: 0.5, shift: [0.0, 4.0], on_white: true, ..label });
    }
}

/// What slides altogether is covered in grey.
fn add_full_sliding(panel: &mut Panel, gradings: &[f64], amplitudes: &[f64]) {
    let top = panel.y.range[1];
    let line = points(gradings, amplitudes);
    let inside: Vec<[f64; 2]> = line.iter().copied().filter(|point| point[1] <= 1.02 * top).collect();
    if inside.is_empty() {
        return;
    }
    let mut area = line.clone();
    area.retain(|point| point[1] <= 1.5 * top);
    let [first, last] = [area[0], area[area.len() - 1]];
    area.extend([[last[0], 2.0 * top], [first[0], 2.0 * top]]);
    panel.series.push(Series::new("", Style::Region { opacity: 1.0 }, Colour::LIGHT, area));
    let style = Style::Line { width: 1.6, dash: Dash::Dashed };
    panel.series.push(Series::new("full sliding", style, Colour::BLACK, line));
    let at = [first[0], top];
    let label = Label::new("full sliding", at, Colour::BLACK);
    panel.labels.push(Label { shift: [4.0, 13.0], ..label });
}

fn bar() -> Bar {
    Bar {
        axis: Axis::new("worn volume Δ*V*(*k*)/Δ*V*(0)", "", Spacing::Logarithmic, RANGE),
        colours: (0..BANDS).map(colour).collect(),
        marks: vec![],
    }
}
