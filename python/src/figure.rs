//! Figures as JSON, for those who draw them by other means.

use fretwear::figures::drawing::{Axis, Colour, Dash, Figure, Label, Panel, Series, Style};
use serde_json::{Value, json};

/// A figure with all of its panels, texts with their markup.
pub fn json(figure: &Figure) -> String {
    let row = |row: &fretwear::figures::drawing::Row| json!({ "height": row.height, "panels": row.panels.iter().map(panel).collect::<Vec<_>>() });
    let rows: Vec<Value> = figure.rows.iter().map(row).collect();
    json!({ "title": figure.title, "rows": rows, "notes": figure.notes }).to_string()
}

fn panel(panel: &Panel) -> Value {
    let series: Vec<Value> = panel.series.iter().map(series).collect();
    let labels: Vec<Value> = panel.labels.iter().map(label).collect();
    let bar = panel.bar.as_ref().map(|bar| {
        let colours: Vec<String> = bar.colours.iter().map(|it| hex(*it)).collect();
        json!({ "axis": axis(&bar.axis), "colours": colours, "marks": bar.marks })
    });
    json!({
        "title": panel.title, "share": panel.share, "x": axis(&panel.x), "y": axis(&panel.y), "series": series, "labels": labels, "bar": bar
    })
}

fn axis(axis: &Axis) -> Value {
    json!({ "text": axis.text(), "spacing": axis.spacing, "range": axis.range, "ticked": axis.ticked })
}

fn series(series: &Series) -> Value {
    let style = match series.style {
        Style::Line { width, dash } => {
            let dash = match dash {
                Dash::Solid => "-",
                Dash::Dashed => "--",
                Dash::Dotted => ":",
                Dash::DashDotted => "-.",
            };
            json!({ "line": dash, "width": width })
        }
        Style::Points { shape, radius } => json!({ "points": shape, "radius": radius }),
        Style::Region { opacity } => json!({ "region": opacity }),
        Style::Hatched => json!({ "region": 1.0, "hatched": true }),
    };
    json!({
        "name": series.name, "style": style, "colour": hex(series.colour), "points": series.points, "in_legend": series.in_legend
    })
}

fn label(label: &Label) -> Value {
    json!({
        "text": label.text, "at": label.at, "shift": label.shift, "anchor": label.anchor, "upwards": label.upwards,
        "on_white": label.on_white, "colour": hex(label.colour)
    })
}

fn hex(colour: Colour) -> String {
    let [red, green, blue] = colour.0;
    format!("#{red:02x}{green:02x}{blue:02x}")
}
