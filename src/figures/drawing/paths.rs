//! Paths of lines, regions and symbols, in px.

use std::fmt::Write;

use super::{Shape, Style};

/// The data of the path of a series whose points are in px.
pub(super) fn path_data(style: &Style, points: &[[f64; 2]]) -> String {
    let mut data = String::new();
    match style {
        Style::Points { shape, radius } => {
            points
                .iter()
                .filter(|point| is_there(point))
                .for_each(|point| data += &symbol(*shape, *radius, *point));
        }
        Style::Line { .. } | Style::Region { .. } | Style::Hatched => {
            let closed = !matches!(style, Style::Line { .. });
            for run in points.split(|point| !is_there(point)).filter(|run| !run.is_empty()) {
                for (place, [x, y]) in run.iter().enumerate() {
                    let command = if place == 0 { 'M' } else { 'L' };
                    // Writing to a string cannot fail.
                    let _ = write!(data, "{command}{} {}", number(*x), number(*y));
                }
                data += if closed { "Z" } else { "" };
            }
        }
    }
    data
}

/// Whether a point has a place that a reader of SVG can follow.
fn is_there(point: &[f64; 2]) -> bool {
    point.iter().all(|value| value.is_finite() && value.abs() < 1e6)
}

fn symbol(shape: Shape, radius: f64, [x, y]: [f64; 2]) -> String {
    let [left, right, r] = [number(x - radius), number(x + radius), number(radius)];
    let (upper, lower, middle) = (number(y - radius), number(y + radius), number(y));
    match shape {
        Shape::Disc | Shape::Circle => {
            format!("M{left} {middle}a{r} {r} 0 1 0 {0} 0a{r} {r} 0 1 0 -{0} 0Z", number(2.0 * radius))
        }
        Shape::Square => format!("M{left} {upper}H{right}V{lower}H{left}Z"),
        Shape::Diamond => {
            let reach = 1.3 * radius;
            let far = [x - reach, x + reach, y - reach, y + reach].map(number);
            format!(
                "M{} {middle}L{} {}L{} {middle}L{} {}Z",
                far[0],
                number(x),
                far[2],
                far[1],
                number(x),
                far[3]
            )
        }
        Shape::Triangle => format!("M{left} {lower}H{right}L{} {upper}Z", number(x)),
        Shape::Cross => format!("M{left} {upper}L{right} {lower}M{right} {upper}L{left} {lower}"),
    }
}

/// Hundredths of a px, without zeros that say nothing.
pub(super) fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}
