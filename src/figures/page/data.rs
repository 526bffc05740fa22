//! What the script of a page knows of a figure.

use serde::Serialize;

use crate::figures::drawing::{Axis, Drawing, Figure, Frame, Panel, Series, Shape, Spacing, Style, html};

#[derive(Serialize)]
struct PanelData {
    frame: Frame,
    x: AxisData,
    y: AxisData,
    series: Vec<SeriesData>,
}

#[derive(Serialize)]
struct AxisData {
    /// Quantity, in HTML.
    name: String,
    unit: String,
    spacing: Spacing,
    range: [f64; 2],
    ticked: bool,
}

#[derive(Serialize)]
struct SeriesData {
    /// In HTML; empty where there is nothing to be pointed at.
    name: String,
    style: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    shape: Option<Shape>,
    #[serde(skip_serializing_if = "Option::is_none")]
    radius: Option<f64>,
    /// Seven digits are more than a figure shows; what is not a number is null.
    points: Vec<[f32; 2]>,
}

/// The panels as JSON that may stand within a script.
pub(super) fn json(figure: &Figure, drawing: &Drawing) -> String {
    let rows = figure.rows.iter().flat_map(|row| {
        // The axis of a panel without a name is that of the one before it.
        let mut name = "";
        row.panels.iter().map(move |panel| {
            if !panel.y.quantity.is_empty() {
                name = &panel.y.quantity;
            }
            (panel, name)
        })
    });
    let panels: Vec<PanelData> =
        rows.zip(&drawing.frames).map(|((panel, y), frame)| data(panel, y, *frame)).collect();
    let json = serde_json::to_string(&panels).expect("panels have string keys and plain values only");
    // Nothing in it may end the script.
    json.replace('<', "\\u003c")
}

fn data(panel: &Panel, y: &str, frame: Frame) -> PanelData {
    PanelData {
        frame,
        x: axis(&panel.x, &panel.x.quantity),
        y: axis(&panel.y, y),
        series: panel.series.iter().map(series).collect(),
    }
}

fn axis(axis: &Axis, name: &str) -> AxisData {
    AxisData {
        name: html(name),
        unit: axis.unit.clone(),
        spacing: axis.spacing,
        range: axis.range,
        ticked: axis.ticked,
    }
}

fn series(series: &Series) -> SeriesData {
    let (style, shape, radius) = match series.style {
        Style::Line { .. } => ("line", None, None),
        Style::Points { shape, radius } => ("points", Some(shape), Some(radius)),
        Style::Region { .. } | Style::Hatched => ("region", None, None),
    };
    let points = series.points.iter().map(|point| point.map(|value| value as f32)).collect();
    SeriesData { name: html(&series.name), style, shape, radius, points }
}
