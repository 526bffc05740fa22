//! Figures as data, and what turns them into SVG and PNG.
//!
//! A [`Figure`] is panels with axes, series and labels in the units of its axes; it knows nothing of pixels. [`Drawing`] lays one out. Letters
//! are drawn as outlines of one font that is part of the program, so that a figure looks the same everywhere and needs no fonts.
//!
//! Texts may hold a little markup: `*w*` is italic, `_{0}` lowered, `^{3}` raised, and a backslash takes the next character as it is;
//! [`plain`] escapes what comes from outside.

mod colour;
mod layout;
mod letters;
mod paths;
mod picture;
mod svg;
mod thinning;
mod ticks;

pub use colour::{Colour, DISTINCT, graded};
pub use layout::Frame;
pub use letters::{escaped, html, plain, without_markup};
pub use picture::png;
pub use svg::{BEGINNING, Drawing};
pub use ticks::{Tick, ticks};

use serde::Serialize;

/// A figure: rows of panels from the top down.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Figure {
    /// Title, above everything.
    pub title: Option<String>,
    /// The rows.
    pub rows: Vec<Row>,
    /// Sentences below everything, one a line.
    pub notes: Vec<String>,
}

/// Panels side by side.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Height of the frames, px.
    pub height: f64,
    /// The panels from left to right.
    pub panels: Vec<Panel>,
}

/// A pair of axes and what is drawn between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Title, above the frame.
    pub title: Option<String>,
    /// Share of the width of its row.
    pub share: f64,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// What is drawn, the last on top.
    pub series: Vec<Series>,
    /// Texts within the frame.
    pub labels: Vec<Label>,
    /// Bar of colours to the right of the frame.
    pub bar: Option<Bar>,
}

impl Figure {
    /// All panels, row by row.
    pub fn panels(&self) -> impl Iterator<Item = &Panel> {
        self.rows.iter().flat_map(|row| &row.panels)
    }
}

impl Panel {
    /// A panel without title, series and labels.
    pub fn new(x: Axis, y: Axis) -> Self {
        Self { title: None, share: 1.0, x, y, series: vec![], labels: vec![], bar: None }
    }

    /// With a title.
    #[must_use]
    pub fn titled(mut self, title: impl Into<String>) -> Self {
        self.title = Some(title.into());
        self
    }
}

/// How values are spread along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Spacing {
    /// Evenly.
    Linear,
    /// By their logarithms; there is no place for values that are not positive.
    Logarithmic,
}

/// An axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Quantity and symbol.
    pub quantity: String,
    /// Unit; empty for a pure number.
    pub unit: String,
    /// How values are spread.
    pub spacing: Spacing,
    /// The values at its ends, increasing.
    pub range: [f64; 2],
    /// Whether it has ticks.
    pub ticked: bool,
}

impl Axis {
    /// An axis over a range.
    ///
    /// # Panics
    /// If the range is not finite and increasing, or not positive where it is logarithmic.
    pub fn new(quantity: &str, unit: &str, spacing: Spacing, range: [f64; 2]) -> Self {
        let [first, last] = range;
        assert!(first.is_finite() && last.is_finite() && first < last, "{quantity} from {first} to {last}");
        assert!(spacing == Spacing::Linear || first > 0.0, "{quantity} from {first} on a logarithmic axis");
        Self { quantity: quantity.into(), unit: unit.into(), spacing, range, ticked: true }
    }

    /// Quantity, symbol and unit, such as `radius *r* (µm)`; nothing where the quantity is left to the panel beside.
    pub fn text(&self) -> String {
        if self.unit.is_empty() || self.quantity.is_empty() {
            self.quantity.clone()
        } else {
            format!("{} ({})", self.quantity, self.unit)
        }
    }

    /// Place of a value along the axis, 0 at its beginning and 1 at its end; not a number where there is none.
    pub fn place(&self, value: f64) -> f64 {
        let [first, last] = self.range;
        match self.spacing {
            Spacing::Linear => (value - first) / (last - first),
            // Differences, because a quotient of what a file may hold can overflow.
            Spacing::Logarithmic => (value.ln() - first.ln()) / (last.ln() - first.ln()),
        }
    }

    /// The value at a place along the axis, which [`Axis::place`] gives back.
    pub fn value(&self, place: f64) -> f64 {
        let [first, last] = self.range;
        match self.spacing {
            Spacing::Linear => first + place * (last - first),
            Spacing::Logarithmic => (first.ln() + place * (last.ln() - first.ln())).exp(),
        }
    }
}

/// Ranges that are no wider are of values that have lost their digits.
const LEAST_WIDTH: f64 = 1e-290;

/// The range of some values with a margin of a part of it at both ends; none if there is no finite value, or no positive one on a
/// logarithmic axis.
pub fn range_of(values: impl IntoIterator<Item = f64>, spacing: Spacing, margin: f64) -> Option<[f64; 2]> {
    let fits = |value: &f64| value.is_finite() && (spacing == Spacing::Linear || *value >= f64::MIN_POSITIVE);
    let [first, last] = values
        .into_iter()
        .filter(fits)
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
    if first > last {
        return None;
    }
    let range = match spacing {
        // A single value, or values that differ by round-off, still need an axis.
        Spacing::Linear => {
            let width = (last - first).max(1e-3 * first.abs().max(last.abs()));
            let width = if width > LEAST_WIDTH { width } else { 1.0 };
            let middle = 0.5 * first + 0.5 * last;
            let half = (0.5 + margin) * width;
            [middle - half, middle + half]
        }
        Spacing::Logarithmic => {
            let width = (last.ln() - first.ln()).max(0.1);
            let least = if last > first { 1.0 } else { 1.02 };
            let factor = (margin * width).exp().max(least);
            [(first / factor).max(f64::MIN_POSITIVE), (last * factor).min(f64::MAX)]
        }
    };
    let usable = range.iter().all(|end| end.is_finite()) && range[0] < range[1];
    usable.then_some(range)
}

/// Points that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// What it is; shown when a reader points at it, so an empty name hides it from that.
    pub name: String,
    /// How it is drawn.
    pub style: Style,
    /// Colour.
    pub colour: Colour,
    /// The points, in the units of the axes; one that is not a number breaks a line, or separates the rings of a region.
    pub points: Vec<[f64; 2]>,
    /// Whether it has an entry in the legend.
    pub in_legend: bool,
}

impl Series {
    /// A series without an entry in the legend.
    pub fn new(name: impl Into<String>, style: Style, colour: Colour, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.into(), style, colour, points, in_legend: false }
    }

    /// With an entry in the legend.
    #[must_use]
    pub fn in_legend(mut self) -> Self {
        self.in_legend = true;
        self
    }
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Style {
    /// A line of a width in px.
    Line {
        /// Width, px.
        width: f64,
        /// Pattern.
        dash: Dash,
    },
    /// A symbol at each point.
    Points {
        /// Shape.
        shape: Shape,
        /// Half of the width, px.
        radius: f64,
    },
    /// Filled rings; where two overlap there is a hole.
    Region {
        /// From 0 to 1.
        opacity: f64,
    },
    /// Filled rings as those of a region, white with oblique lines: of what is there nothing is known.
    Hatched,
}

/// Pattern of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dash {
    /// Without a gap.
    Solid,
    /// Long dashes.
    Dashed,
    /// Dots.
    Dotted,
    /// Dashes and dots.
    DashDotted,
}

impl Dash {
    /// The patterns, in an order in which neighbours are told apart.
    pub const ALL: [Self; 4] = [Self::Solid, Self::Dashed, Self::DashDotted, Self::Dotted];

    /// Lengths of dashes and gaps, px; empty for none.
    pub fn pattern(self) -> &'static str {
        match self {
            Self::Solid => "",
            Self::Dashed => "6 3.5",
            Self::Dotted => "1.4 2.6",
            Self::DashDotted => "7 2.6 1.6 2.6",
        }
    }
}

/// Shape of a symbol.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// Filled circle.
    Disc,
    /// Circle.
    Circle,
    /// Filled square.
    Square,
    /// Filled diamond.
    Diamond,
    /// Filled triangle.
    Triangle,
    /// Two crossing lines.
    Cross,
}

impl Shape {
    /// The shapes, in an order in which neighbours are told apart.
    pub const ALL: [Self; 6] =
        [Self::Disc, Self::Square, Self::Triangle, Self::Circle, Self::Diamond, Self::Cross];

    /// Whether the symbol is lines rather than a filled area.
    pub fn is_stroked(self) -> bool {
        matches!(self, Self::Circle | Self::Cross)
    }
}

/// A text at a point of a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// The text.
    pub text: String,
    /// The point, in the units of the axes.
    pub at: [f64; 2],
    /// Shift, px to the right and down.
    pub shift: [f64; 2],
    /// Which part of the text is at the point: 0 its beginning, 0.5 its middle, 1 its end.
    pub anchor: f64,
    /// Whether it runs upwards.
    pub upwards: bool,
    /// Whether it has a white ground.
    pub on_white: bool,
    /// Colour.
    pub colour: Colour,
}

impl Label {
    /// A text that begins at a point.
    pub fn new(text: impl Into<String>, at: [f64; 2], colour: Colour) -> Self {
        Self { text: text.into(), at, shift: [0.0; 2], anchor: 0.0, upwards: false, on_white: false, colour }
    }
}

/// A bar of colours with an axis of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// The axis, from below upwards.
    pub axis: Axis,
    /// Colours from the beginning of the axis to its end, each over an equal part.
    pub colours: Vec<Colour>,
    /// Values that are drawn, marked on the bar.
    pub marks: Vec<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_places_along_an_axis_are_inverse() {
        for (spacing, range) in [(Spacing::Linear, [-3.0, 5.0]), (Spacing::Logarithmic, [1e-9, 1e7])] {
            let axis = Axis::new("x", "", spacing, range);
            assert_eq!([axis.place(range[0]), axis.place(range[1])], [0.0, 1.0]);
            for place in [-0.2, 0.0, 0.3, 1.0, 1.4] {
                assert!((axis.place(axis.value(place)) - place).abs() < 1e-14, "{spacing:?} {place}");
            }
        }
    }

    #[test]
    fn ranges_are_usable_whatever_the_values() {
        let hostile = [f64::NAN, f64::INFINITY, -1e308, 1e308, 0.0, 5e-324, 1.0, 1.0 + f64::EPSILON];
        for one in hostile {
            for other in hostile {
                for spacing in [Spacing::Linear, Spacing::Logarithmic] {
                    let Some(range) = range_of([one, other], spacing, 0.05) else { continue };
                    let axis = Axis::new("x", "", spacing, range);
                    assert!(ticks(&axis, 5).len() < 10_000, "{one} {other} {spacing:?}");
                    let fits = |value: &f64| {
                        value.is_finite() && (spacing == Spacing::Linear || *value >= f64::MIN_POSITIVE)
                    };
                    for value in [one, other].into_iter().filter(fits) {
                        assert!((0.0..=1.0).contains(&axis.place(value)), "{value} in {range:?}");
                    }
                }
            }
        }
    }
}
