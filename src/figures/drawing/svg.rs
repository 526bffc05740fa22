//! A figure as SVG.

use std::collections::BTreeMap;
use std::fmt::{self, Write};

use super::layout::{
    BAR, BAR_GAP, GAP, LEGEND_GAP, LEGEND_LINE, Layout, MARGIN, NOTE_LINE, Placed, SMALL_TEXT, SWATCH, TEXT,
    TICK, TITLE, WIDTH, entry_width,
};
use super::letters::{Glyph, Letters, escaped, without_markup};
use super::paths::{number, path_data};
use super::{Bar, Colour, Dash, Figure, Frame, Label, Series, Style};

/// Width of frames and ticks, px.
const HAIRLINE: f64 = 0.8;
/// Distance of hatching lines, px.
const HATCH: f64 = 5.0;
/// Height of capital letters relative to the size of letters.
const CAPITALS: f64 = 0.73;

/// What stands between the title and the letters of every SVG of this program.
pub const BEGINNING: &str = "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n<defs>\n";

/// A figure laid out.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// The SVG, a document of its own.
    pub svg: String,
    /// The frames of the panels, in the order of [`Figure::panels`].
    pub frames: Vec<Frame>,
}

impl Drawing {
    /// Lays a figure out.
    ///
    /// # Arguments
    /// * `figure` -- the figure
    /// * `name` -- letters and digits that no other drawing on the same page has
    pub fn new(figure: &Figure, name: &str) -> Self {
        let letters = Letters::new();
        let layout = Layout::new(figure, &letters);
        let mut page =
            Page { letters, name, body: String::new(), glyphs: BTreeMap::new(), patterns: BTreeMap::new() };
        if let Some(title) = &figure.title {
            page.text(title, [MARGIN, MARGIN + TITLE], TITLE, 0.0, Colour::BLACK);
        }
        for (number, panel) in layout.panels.iter().enumerate() {
            page.panel(number, panel);
        }
        for (line, note) in figure.notes.iter().enumerate() {
            let y = layout.notes + line as f64 * NOTE_LINE;
            page.text(note, [MARGIN, y], SMALL_TEXT, 0.0, Colour::GREY);
        }
        let title = figure.title.as_deref().unwrap_or("figure");
        let svg = page.finish(title, layout.height.ceil());
        Self { svg, frames: layout.panels.iter().map(|panel| panel.frame).collect() }
    }
}

struct Page<'a> {
    letters: Letters,
    name: &'a str,
    body: String,
    /// The letters that have been used, and their names.
    glyphs: BTreeMap<Glyph, String>,
    /// The hatchings that have been used, by their names.
    patterns: BTreeMap<String, String>,
}

impl Page<'_> {
    fn put(&mut self, text: fmt::Arguments) {
        // Writing to a string cannot fail.
        let _ = self.body.write_fmt(text);
    }

    fn finish(self, title: &str, height: f64) -> String {
        let width = number(WIDTH);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             role=\"img\" aria-label=\"{0}\">\n<title>{0}</title>\n{BEGINNING}",
            escaped(&without_markup(title))
        );
        for (glyph, name) in &self.glyphs {
            let _ = writeln!(svg, "<path id=\"{name}\" d=\"{}\"/>", self.letters.outline(*glyph));
        }
        self.patterns.values().for_each(|pattern| svg += pattern);
        svg + "</defs>\n" + &self.body + "</svg>\n"
    }

    /// A text whose part `anchor` of its width lies at a point of its baseline.
    fn text(&mut self, text: &str, [x, y]: [f64; 2], size: f64, anchor: f64, colour: Colour) {
        let width = self.letters.set(text, size).width;
        self.text_under(
            text,
            size,
            colour,
            &format!("translate({} {})", number(x - anchor * width), number(y)),
        );
    }

    /// A text under a transformation.
    fn text_under(&mut self, text: &str, size: f64, colour: Colour, transform: &str) {
        let word = self.letters.set(text, size);
        let units = self.letters.units();
        self.put(format_args!(
            "<g fill=\"{colour}\" transform=\"{transform}\" role=\"img\" aria-label=\"{}\">",
            escaped(&without_markup(text))
        ));
        let mut open = None;
        for letter in &word.letters {
            if self.letters.outline(letter.glyph).is_empty() {
                continue;
            }
            let (italic, glyph) = letter.glyph;
            let name = format!("{}{}{glyph}", self.name, if italic { 'i' } else { 'u' });
            // Letters of one size share their scale.
            let scale = letter.size / units;
            if open != Some((scale, letter.y)) {
                if open.is_some() {
                    self.put(format_args!("</g>"));
                }
                self.put(format_args!(
                    "<g transform=\"translate(0 {}) scale({:.6} -{:.6})\">",
                    number(letter.y),
                    scale,
                    scale
                ));
                open = Some((scale, letter.y));
            }
            self.put(format_args!("<use href=\"#{name}\" x=\"{:.0}\"/>", letter.x / scale));
            self.glyphs.entry(letter.glyph).or_insert(name);
        }
        if open.is_some() {
            self.put(format_args!("</g>"));
        }
        self.put(format_args!("</g>\n"));
    }

    fn panel(&mut self, position: usize, placed: &Placed) {
        let Placed { panel, frame, .. } = placed;
        let Frame { left, top, width, height } = frame.rounded();
        let clip = format!("{}clip{position}", self.name);
        self.put(format_args!("<clipPath id=\"{clip}\"><rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\"/></clipPath>\n\
             <g class=\"panel\" data-panel=\"{position}\">\n"));
        self.grid(placed);
        self.put(format_args!("<g class=\"data\" clip-path=\"url(#{clip})\">\n"));
        for (number, series) in panel.series.iter().enumerate() {
            let place = |point: [f64; 2]| frame.point(&panel.x, &panel.y, point);
            self.series(number, series, &place);
        }
        self.put(format_args!("</g>\n<g class=\"labels\" clip-path=\"url(#{clip})\">\n"));
        for label in &panel.labels {
            self.label(label, frame.point(&panel.x, &panel.y, label.at));
        }
        self.put(format_args!("</g>\n<rect class=\"frame\" x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill=\"none\" \
             stroke=\"#000\" stroke-width=\"{HAIRLINE}\"/>\n"));
        self.axes(placed);
        self.axis_titles(placed);
        self.head(placed);
        if let Some(bar) = &panel.bar {
            self.bar(bar, placed);
        }
        self.put(format_args!("</g>\n"));
    }

    /// Pale lines at the labelled ticks.
    fn grid(&mut self, placed: &Placed) {
        let Placed { panel, frame, ticks, .. } = placed;
        self.put(format_args!(
            "<path class=\"grid\" fill=\"none\" stroke=\"#e9e9e9\" stroke-width=\"{HAIRLINE}\" d=\""
        ));
        for tick in ticks.x.iter().filter(|tick| tick.label.is_some()) {
            let x = frame.left + frame.width * panel.x.place(tick.value);
            self.put(format_args!("M{} {}v{}", number(x), number(frame.top), number(frame.height)));
        }
        for tick in ticks.y.iter().filter(|tick| tick.label.is_some()) {
            let y = frame.top + frame.height * (1.0 - panel.y.place(tick.value));
            self.put(format_args!("M{} {}h{}", number(frame.left), number(y), number(frame.width)));
        }
        self.put(format_args!("\"/>\n"));
    }

    /// Ticks and what stands beside them.
    fn axes(&mut self, placed: &Placed) {
        let Placed { panel, frame, ticks, .. } = placed;
        let Frame { left, top, width, height } = *frame;
        let bottom = top + height;
        self.put(format_args!(
            "<g class=\"ticks\">\n<path fill=\"none\" stroke=\"#000\" stroke-width=\"{HAIRLINE}\" d=\""
        ));
        let length = |label: &Option<String>| if label.is_some() { TICK } else { 0.5 * TICK };
        for tick in &ticks.x {
            let x = left + width * panel.x.place(tick.value);
            self.put(format_args!("M{} {}v{}", number(x), number(bottom), length(&tick.label)));
        }
        for tick in &ticks.y {
            let y = top + height * (1.0 - panel.y.place(tick.value));
            self.put(format_args!("M{} {}h-{}", number(left), number(y), length(&tick.label)));
        }
        self.put(format_args!("\"/>\n"));
        for tick in &ticks.x {
            let Some(label) = &tick.label else { continue };
            let x = left + width * panel.x.place(tick.value);
            let at = [x, bottom + TICK + GAP + CAPITALS * SMALL_TEXT];
            self.text(label, at, SMALL_TEXT, 0.5, Colour::BLACK);
        }
        for tick in &ticks.y {
            let Some(label) = &tick.label else { continue };
            let y = top + height * (1.0 - panel.y.place(tick.value));
            let at = [left - TICK - GAP, y + 0.5 * CAPITALS * SMALL_TEXT];
            self.text(label, at, SMALL_TEXT, 1.0, Colour::BLACK);
        }
        self.put(format_args!("</g>\n"));
    }

    /// Quantities and units of the axes.
    fn axis_titles(&mut self, placed: &Placed) {
        let Placed { panel, frame, ticks, tick_widths, .. } = placed;
        let Frame { left, top, width, height } = *frame;
        let below = if ticks.x.is_empty() { GAP } else { TICK + GAP + SMALL_TEXT };
        let at = [left + 0.5 * width, top + height + below + TEXT + 2.0];
        self.text(&panel.x.text(), at, TEXT, 0.5, Colour::BLACK);
        if !panel.y.quantity.is_empty() {
            let labels = if tick_widths[0] > 0.0 { tick_widths[0] + TICK + GAP } else { GAP };
            self.upwards(
                &panel.y.text(),
                [left - labels - 9.0, top + 0.5 * height],
                TEXT,
                0.5,
                Colour::BLACK,
            );
        }
    }

    /// A text that runs upwards.
    fn upwards(&mut self, text: &str, [x, y]: [f64; 2], size: f64, anchor: f64, colour: Colour) {
        let start = y + anchor * self.letters.set(text, size).width;
        let transform = format!("translate({} {}) rotate(-90)", number(x), number(start));
        self.text_under(text, size, colour, &transform);
    }

    /// Title and legend of a panel.
    fn head(&mut self, placed: &Placed) {
        let Placed { panel, frame, legend, .. } = placed;
        let lines = legend.len() as f64 * LEGEND_LINE;
        if let Some(title) = &panel.title {
            self.text(title, [frame.left, frame.top - lines - 7.0], TEXT, 0.0, Colour::BLACK);
        }
        for (line, entries) in legend.iter().enumerate() {
            let y = frame.top - lines + (line as f64 + 0.45) * LEGEND_LINE;
            let mut x = frame.left;
            for series in entries {
                self.swatch(series, [x, y]);
                let at = [x + SWATCH + GAP, y + 0.5 * CAPITALS * SMALL_TEXT];
                self.text(&series.name, at, SMALL_TEXT, 0.0, Colour::BLACK);
                x += entry_width(series, &self.letters) + LEGEND_GAP;
            }
        }
    }

    /// The sample of a series in the legend, from a point to the right.
    fn swatch(&mut self, series: &Series, [x, y]: [f64; 2]) {
        let points = match series.style {
            Style::Line { .. } => vec![[x, y], [x + SWATCH, y]],
            Style::Points { .. } => vec![[x + 0.5 * SWATCH, y]],
            Style::Region { .. } | Style::Hatched => {
                vec![[x, y - 4.5], [x + SWATCH, y - 4.5], [x + SWATCH, y + 4.5], [x, y + 4.5]]
            }
        };
        self.path(&series.style, series.colour, &points, "");
    }

    fn series(&mut self, position: usize, series: &Series, place: &dyn Fn([f64; 2]) -> [f64; 2]) {
        let points: Vec<[f64; 2]> = series.points.iter().map(|point| place(*point)).collect();
        let mark = format!(" data-series=\"{position}\"");
        self.path(&series.style, series.colour, &points, &mark);
    }

    /// A series whose points are in px.
    fn path(&mut self, style: &Style, colour: Colour, points: &[[f64; 2]], mark: &str) {
        self.put(format_args!("<path{mark} d=\"{}\"", path_data(style, points)));
        match style {
            Style::Line { width, dash } => {
                self.put(format_args!(
                    " fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linejoin=\"round\""
                ));
                if *dash != Dash::Solid {
                    self.put(format_args!(" stroke-dasharray=\"{}\"", dash.pattern()));
                }
            }
            Style::Points { shape, .. } if shape.is_stroked() => {
                self.put(format_args!(" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.2\""));
            }
            Style::Points { .. } => {
                self.put(format_args!(" fill=\"{colour}\""));
            }
            Style::Region { opacity } => {
                self.put(format_args!(" fill=\"{colour}\" fill-rule=\"evenodd\""));
                if *opacity < 1.0 {
                    self.put(format_args!(" fill-opacity=\"{opacity}\""));
                }
            }
            Style::Hatched => {
                let pattern = self.hatch(colour);
                self.put(format_args!(" fill=\"url(#{pattern})\" fill-rule=\"evenodd\""));
            }
        }
        self.put(format_args!("/>\n"));
    }

    /// The name of oblique lines of a colour on white.
    fn hatch(&mut self, colour: Colour) -> String {
        let name = format!("{}hatch{}", self.name, colour.to_string().trim_start_matches('#'));
        let pattern = format!(
            "<pattern id=\"{name}\" patternUnits=\"userSpaceOnUse\" width=\"{HATCH}\" height=\"{HATCH}\" \
             patternTransform=\"rotate(45)\"><rect width=\"{HATCH}\" height=\"{HATCH}\" fill=\"#fff\"/>\
             <rect width=\"1.3\" height=\"{HATCH}\" fill=\"{colour}\"/></pattern>\n"
        );
        self.patterns.insert(name.clone(), pattern);
        name
    }

    fn label(&mut self, label: &Label, [x, y]: [f64; 2]) {
        if !x.is_finite() || !y.is_finite() {
            return;
        }
        let at = [x + label.shift[0], y + label.shift[1]];
        let width = self.letters.set(&label.text, SMALL_TEXT).width;
        self.put(format_args!("<g data-x=\"{}\" data-y=\"{}\">", number(x), number(y)));
        if label.upwards {
            self.upwards(&label.text, at, SMALL_TEXT, label.anchor, label.colour);
        } else {
            if label.on_white {
                self.put(format_args!("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"2\" fill=\"#fff\" fill-opacity=\"0.85\"/>",
                    number(at[0] - label.anchor * width - 2.0),
                    number(at[1] - CAPITALS * SMALL_TEXT - 2.5),
                    number(width + 4.0),
                    number(CAPITALS * SMALL_TEXT + 5.0)));
            }
            self.text(&label.text, at, SMALL_TEXT, label.anchor, label.colour);
        }
        self.put(format_args!("</g>\n"));
    }

    fn bar(&mut self, bar: &Bar, placed: &Placed) {
        let Placed { frame, ticks, tick_widths, .. } = placed;
        let left = frame.left + frame.width + BAR_GAP;
        let step = frame.height / bar.colours.len().max(1) as f64;
        for (place, colour) in bar.colours.iter().enumerate() {
            let top = frame.top + frame.height - step * (place as f64 + 1.0);
            // A little higher than its share, so that nothing shines through between two.
            let tall = if place == 0 { step } else { step + 0.4 };
            self.put(format_args!(
                "<rect x=\"{}\" y=\"{}\" width=\"{BAR}\" height=\"{}\" fill=\"{colour}\"/>\n",
                number(left),
                number(top),
                number(tall)
            ));
        }
        let height = |value: f64| frame.top + frame.height * (1.0 - bar.axis.place(value));
        let right = left + BAR;
        self.put(format_args!("<path fill=\"none\" stroke=\"#fff\" stroke-width=\"1\" d=\""));
        for mark in &bar.marks {
            self.put(format_args!("M{} {}h{BAR}", number(left), number(height(*mark))));
        }
        self.put(format_args!("\"/>\n<path fill=\"none\" stroke=\"#000\" stroke-width=\"{HAIRLINE}\" d=\""));
        self.put(format_args!(
            "M{} {}h{BAR}v{}h-{BAR}z",
            number(left),
            number(frame.top),
            number(frame.height)
        ));
        for tick in &ticks.bar {
            let length = if tick.label.is_some() { TICK } else { 0.5 * TICK };
            self.put(format_args!("M{} {}h{length}", number(right), number(height(tick.value))));
        }
        self.put(format_args!("\"/>\n"));
        for tick in &ticks.bar {
            if let Some(label) = &tick.label {
                let at = [right + TICK + GAP, height(tick.value) + 0.5 * CAPITALS * SMALL_TEXT];
                self.text(label, at, SMALL_TEXT, 0.0, Colour::BLACK);
            }
        }
        let x = right + TICK + GAP + tick_widths[1] + TEXT + 4.0;
        self.upwards(&bar.axis.text(), [x, frame.top + 0.5 * frame.height], TEXT, 0.5, Colour::BLACK);
    }
}

impl Frame {
    /// In hundredths of a px, as it is written.
    fn rounded(&self) -> Self {
        let round = |length: f64| (100.0 * length).round() / 100.0;
        Self {
            left: round(self.left),
            top: round(self.top),
            width: round(self.width),
            height: round(self.height),
        }
    }
}
