//! Where everything goes: frames of panels, and the room that ticks, axes, legends and bars need around them.

use serde::Serialize;

use super::letters::Letters;
use super::{Axis, Figure, Panel, Row, Series, Spacing, Tick, ticks};

/// Width of a figure, px; at 96 px an inch, two columns of a journal.
pub(super) const WIDTH: f64 = 720.0;
/// Sizes of letters, px.
pub(super) const TEXT: f64 = 12.0;
pub(super) const SMALL_TEXT: f64 = 11.0;
pub(super) const TITLE: f64 = 13.5;
/// Around everything.
pub(super) const MARGIN: f64 = 8.0;
/// Between a frame and the labels of its ticks.
pub(super) const TICK: f64 = 5.0;
pub(super) const GAP: f64 = 4.0;
/// Height of a line of the legend, and lengths in it.
pub(super) const LEGEND_LINE: f64 = 17.0;
pub(super) const SWATCH: f64 = 24.0;
pub(super) const LEGEND_GAP: f64 = 16.0;
/// Width of a bar of colours, and its distance from the frame.
pub(super) const BAR: f64 = 12.0;
pub(super) const BAR_GAP: f64 = 10.0;
const BETWEEN_ROWS: f64 = 14.0;
const BETWEEN_PANELS: f64 = 14.0;
/// A label for so many px of an axis.
const ROOM_ACROSS: f64 = 58.0;
const ROOM_OF_POWER: f64 = 44.0;
const ROOM_UP: f64 = 38.0;
/// Height of a line of the notes.
pub(super) const NOTE_LINE: f64 = 15.0;

/// A rectangle, px from the left and the top of the figure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Frame {
    /// Left side.
    pub left: f64,
    /// Top side.
    pub top: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

impl Frame {
    /// Where a point of a panel is drawn; not numbers where it has no place.
    pub fn point(&self, x: &Axis, y: &Axis, [at_x, at_y]: [f64; 2]) -> [f64; 2] {
        [self.left + self.width * x.place(at_x), self.top + self.height * (1.0 - y.place(at_y))]
    }
}

/// Ticks of the axes of a panel.
pub(super) struct Ticks {
    pub x: Vec<Tick>,
    pub y: Vec<Tick>,
    pub bar: Vec<Tick>,
}

/// A panel in its place.
pub(super) struct Placed<'a> {
    pub panel: &'a Panel,
    pub frame: Frame,
    pub ticks: Ticks,
    /// Lines of the legend.
    pub legend: Vec<Vec<&'a Series>>,
    /// Width of the widest label of the vertical axis, and of the bar.
    pub tick_widths: [f64; 2],
}

pub(super) struct Layout<'a> {
    pub panels: Vec<Placed<'a>>,
    /// Baseline of the first note.
    pub notes: f64,
    pub height: f64,
}

impl<'a> Layout<'a> {
    pub(super) fn new(figure: &'a Figure, letters: &Letters) -> Self {
        let mut top = MARGIN + if figure.title.is_some() { TITLE + 8.0 } else { 0.0 };
        let mut panels = vec![];
        for row in &figure.rows {
            let left = left_margins(figure, row, letters);
            top = place_row(row, letters, &left, top, &mut panels) + BETWEEN_ROWS;
        }
        let end = top - BETWEEN_ROWS;
        let notes = end + 6.0 + SMALL_TEXT;
        let lines = figure.notes.len() as f64;
        let height = if lines > 0.0 { notes + (lines - 1.0) * NOTE_LINE + 4.0 } else { end } + MARGIN;
        Self { panels, notes, height }
    }
}

/// Width of the widest label.
fn widest(ticks: &[Tick], letters: &Letters) -> f64 {
    let width = |tick: &Tick| tick.label.as_ref().map_or(0.0, |label| letters.set(label, SMALL_TEXT).width);
    ticks.iter().map(width).fold(0.0, f64::max)
}

fn rows_of_ticks(axis: &Axis, height: f64) -> Vec<Tick> {
    ticks(axis, (height / ROOM_UP) as usize)
}

/// Room to the left of the frames of a row; the first frames of all rows begin together, and all those of rows of as many panels.
fn left_margins(figure: &Figure, row: &Row, letters: &Letters) -> Vec<f64> {
    let alike = |column: usize| {
        let same = move |other: &&Row| column == 0 || other.panels.len() == row.panels.len();
        figure.rows.iter().filter(same)
    };
    let margin = |column| alike(column).map(|row| left_margin(row, letters, column)).fold(0.0, f64::max);
    (0..row.panels.len()).map(margin).collect()
}

/// Room to the left of the frame of a panel.
fn left_margin(row: &Row, letters: &Letters, column: usize) -> f64 {
    let Some(panel) = row.panels.get(column) else { return 0.0 };
    let labels = widest(&rows_of_ticks(&panel.y, row.height), letters);
    let title = if panel.y.quantity.is_empty() { 0.0 } else { TEXT + 10.0 };
    title + if labels > 0.0 { labels + TICK + GAP } else { GAP }
}

/// Room to the right of the frame of a panel.
fn right_margin(panel: &Panel, height: f64, letters: &Letters) -> f64 {
    match &panel.bar {
        Some(bar) => {
            let labels = widest(&rows_of_ticks(&bar.axis, height), letters);
            BAR_GAP + BAR + TICK + GAP + labels + TEXT + 8.0
        }
        // Half of the last label of the horizontal axis.
        None => 12.0,
    }
}

/// Places a row of panels below `top`; returns where it ends.
fn place_row<'a>(
    row: &'a Row,
    letters: &Letters,
    left_margins: &[f64],
    top: f64,
    placed: &mut Vec<Placed<'a>>,
) -> f64 {
    let margins: Vec<[f64; 2]> = (0..row.panels.len())
        .map(|column| [left_margins[column], right_margin(&row.panels[column], row.height, letters)])
        .collect();
    let between = BETWEEN_PANELS * row.panels.len().saturating_sub(1) as f64;
    let taken: f64 = margins.iter().flatten().sum::<f64>() + between + 2.0 * MARGIN;
    let shares: f64 = row.panels.iter().map(|panel| panel.share).sum();
    let width = |panel: &Panel| ((WIDTH - taken) * panel.share / shares).max(40.0);
    let legends: Vec<Vec<Vec<&Series>>> = row
        .panels
        .iter()
        .map(|panel| legend(panel, room_of_legend(row, panel, width(panel)), letters))
        .collect();
    let above = |panel: &Panel, legend: &Vec<Vec<&Series>>| {
        legend.len() as f64 * LEGEND_LINE + panel.title.as_ref().map_or(0.0, |_| TEXT + 8.0)
    };
    let head =
        row.panels.iter().zip(&legends).map(|(panel, legend)| above(panel, legend)).fold(0.0, f64::max);
    let mut left = MARGIN;
    for ((panel, legend), [before, after]) in row.panels.iter().zip(legends).zip(margins) {
        left += before;
        let frame = Frame { left, top: top + head, width: width(panel), height: row.height };
        let bar = panel.bar.as_ref().map(|bar| rows_of_ticks(&bar.axis, row.height)).unwrap_or_default();
        let room = if panel.x.spacing == Spacing::Linear { ROOM_ACROSS } else { ROOM_OF_POWER };
        let x = ticks(&panel.x, (frame.width / room) as usize);
        let ticks = Ticks { x, y: rows_of_ticks(&panel.y, row.height), bar };
        let tick_widths = [widest(&ticks.y, letters), widest(&ticks.bar, letters)];
        placed.push(Placed { panel, frame, ticks, legend, tick_widths });
        left += frame.width + after + BETWEEN_PANELS;
    }
    let labelled = row.panels.iter().any(|panel| panel.x.ticked);
    let below = if labelled { TICK + GAP + SMALL_TEXT } else { GAP };
    top + head + row.height + below + TEXT + 8.0
}

/// Width that the legend of a panel may take: that of its frame, or of its row where nothing else is above the other frames.
fn room_of_legend(row: &Row, panel: &Panel, width: f64) -> f64 {
    let is_bare =
        |other: &Panel| other.title.is_none() && other.series.iter().all(|series| !series.in_legend);
    let is_first = row.panels.first().is_some_and(|first| std::ptr::eq(first, panel));
    if is_first && row.panels[1..].iter().all(is_bare) { width * row.panels.len() as f64 } else { width }
}

/// The entries of the legend in lines no wider than the frame.
fn legend<'a>(panel: &'a Panel, width: f64, letters: &Letters) -> Vec<Vec<&'a Series>> {
    let mut lines: Vec<Vec<&Series>> = vec![];
    let mut used = f64::INFINITY;
    for series in panel.series.iter().filter(|series| series.in_legend) {
        let entry = entry_width(series, letters);
        if used + entry > width {
            lines.push(vec![]);
            used = 0.0;
        }
        used += entry + LEGEND_GAP;
        lines.last_mut().expect("one was just begun, if there was none").push(series);
    }
    lines
}

/// Width of an entry of the legend.
pub(super) fn entry_width(series: &Series, letters: &Letters) -> f64 {
    SWATCH + GAP + letters.set(&series.name, SMALL_TEXT).width
}
