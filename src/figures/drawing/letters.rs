//! Texts as outlines of letters: markup, widths, paths. The home of the font.

use std::fmt::Write;

use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// Why parsing the font cannot fail.
const WHOLE: &str = "the font that the program was built with is whole";

/// Size of raised and lowered letters, relative to the others.
const SMALL: f64 = 0.72;
/// How far letters are raised and lowered, relative to their size.
const RAISED: f64 = 0.38;
const LOWERED: f64 = 0.2;

/// Text in which nothing is markup.
///
/// ```
/// use fretwear::figures::drawing::{plain, without_markup};
/// assert_eq!(plain("p*s_{a}"), r"p\*s\_{a}");
/// assert_eq!(without_markup(&plain("p*s_{a}")), "p*s_{a}");
/// assert_eq!(without_markup("radius *a*_{0}, 10^{−3}"), "radius a0, 10−3");
/// ```
pub fn plain(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '*' | '_' | '^' | '\\' => escaped.extend(['\\', letter]),
            // Nothing that ends a line or that XML forbids.
            letter if letter.is_control() => escaped.push(' '),
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// The letters of a text.
pub fn without_markup(text: &str) -> String {
    parse(text).into_iter().map(|letter| letter.letter).collect()
}

/// A text with its markup as HTML.
///
/// ```
/// use fretwear::figures::drawing::html;
/// assert_eq!(html("*a*_{0} < 10^{−3}"), "<i>a</i><sub>0</sub> &lt; 10<sup>−3</sup>");
/// ```
pub fn html(text: &str) -> String {
    let tags = |italic: bool, level: i8| {
        let level = match level {
            1 => Some("sup"),
            -1 => Some("sub"),
            _ => None,
        };
        level.into_iter().chain(italic.then_some("i"))
    };
    let mut html = String::new();
    for run in parse(text).chunk_by(|one, other| (one.italic, one.level) == (other.italic, other.level)) {
        let (italic, level) = (run[0].italic, run[0].level);
        tags(italic, level).for_each(|tag| html += &format!("<{tag}>"));
        html += &escaped(&run.iter().map(|letter| letter.letter).collect::<String>());
        let mut closing: Vec<&str> = tags(italic, level).collect();
        closing.reverse();
        closing.into_iter().for_each(|tag| html += &format!("</{tag}>"));
    }
    html
}

/// Text as it stands in XML and HTML, without what both forbid.
pub fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped += "&amp;",
            '<' => escaped += "&lt;",
            '>' => escaped += "&gt;",
            '"' => escaped += "&quot;",
            '\n' => escaped.push('\n'),
            letter if letter.is_control() || matches!(letter, '\u{fffe}' | '\u{ffff}') => escaped.push(' '),
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// One letter of a text with markup.
struct Letter {
    letter: char,
    italic: bool,
    /// 1 raised, -1 lowered.
    level: i8,
}

fn parse(text: &str) -> Vec<Letter> {
    let (mut italic, mut level) = (false, 0);
    let mut letters = vec![];
    let mut rest = text.chars().peekable();
    while let Some(letter) = rest.next() {
        let letter = match letter {
            '\\' => match rest.next() {
                Some(escaped) => escaped,
                None => break,
            },
            '*' => {
                italic = !italic;
                continue;
            }
            '_' | '^' if rest.peek() == Some(&'{') => {
                rest.next();
                level = if letter == '^' { 1 } else { -1 };
                continue;
            }
            '}' if level != 0 => {
                level = 0;
                continue;
            }
            letter => letter,
        };
        letters.push(Letter { letter, italic, level });
    }
    letters
}

/// A letter of the font: whether it is italic, and its number.
pub(super) type Glyph = (bool, u16);

/// A letter in its place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placed {
    pub glyph: Glyph,
    /// From the beginning of the text, px.
    pub x: f64,
    /// Below the line that letters stand on, px.
    pub y: f64,
    /// Size, px.
    pub size: f64,
}

/// A text that has been set.
#[derive(Debug, Clone, Default)]
pub(super) struct Word {
    pub letters: Vec<Placed>,
    /// Width, px.
    pub width: f64,
}

/// The font.
pub(super) struct Letters {
    upright: Face<'static>,
    italic: Face<'static>,
}

impl Letters {
    pub(super) fn new() -> Self {
        let face = |bytes| Face::parse(bytes, 0).expect(WHOLE);
        Self { upright: face(dejavu::sans::regular()), italic: face(dejavu::sans::oblique()) }
    }

    fn face(&self, italic: bool) -> &Face<'static> {
        if italic { &self.italic } else { &self.upright }
    }

    /// Letter size of the font's own coordinates.
    pub(super) fn units(&self) -> f64 {
        f64::from(self.upright.units_per_em())
    }

    /// Sets a text in letters of a size, px.
    pub(super) fn set(&self, text: &str, size: f64) -> Word {
        let mut word = Word::default();
        for Letter { letter, italic, level } in parse(text) {
            // Letters that the italics lack stay upright.
            let italic = italic && self.italic.glyph_index(letter).is_some();
            let face = self.face(italic);
            // A letter that the font lacks is drawn as its box.
            let glyph = face.glyph_index(letter).unwrap_or(GlyphId(0));
            let scaled = if level == 0 { size } else { SMALL * size };
            let y = match level {
                1 => -RAISED * size,
                -1 => LOWERED * size,
                _ => 0.0,
            };
            word.letters.push(Placed { glyph: (italic, glyph.0), x: word.width, y, size: scaled });
            word.width += scaled * f64::from(face.glyph_hor_advance(glyph).unwrap_or(0)) / self.units();
        }
        word
    }

    /// The outline of a letter as the data of an SVG path, in the font's own coordinates, in which y grows upwards.
    pub(super) fn outline(&self, (italic, glyph): Glyph) -> String {
        let mut path = Path::default();
        // A space has none.
        let _ = self.face(italic).outline_glyph(GlyphId(glyph), &mut path);
        path.0
    }
}

#[derive(Default)]
struct Path(String);

impl Path {
    fn add(&mut self, command: char, numbers: &[f32]) {
        self.0.push(command);
        for (position, number) in numbers.iter().enumerate() {
            let space = if position > 0 && *number >= 0.0 { " " } else { "" };
            // Writing to a string cannot fail; outlines of this font are in whole numbers.
            let _ = write!(self.0, "{space}{number}");
        }
    }
}

impl OutlineBuilder for Path {
    fn move_to(&mut self, x: f32, y: f32) {
        self.add('M', &[x, y]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.add('L', &[x, y]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.add('Q', &[x1, y1, x, y]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.add('C', &[x1, y1, x2, y2, x, y]);
    }

    fn close(&mut self) {
        self.add('Z', &[]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_every_letter_that_figures_use() {
        let letters = Letters::new();
        for letter in "abcxyzACFMNUVEWΔτμµκφ∞₀−·×→≈√²³°()/|,–".chars() {
            assert!(letters.upright.glyph_index(letter).is_some(), "{letter}");
        }
        for letter in "abcdfkprswxzAFMNUVτμφΔ".chars() {
            assert!(letters.italic.glyph_index(letter).is_some(), "{letter}");
        }
    }

    #[test]
    fn markup_moves_letters_and_costs_no_width_of_its_own() {
        let letters = Letters::new();
        let plain = letters.set("a0", 10.0);
        let lowered = letters.set("a_{0}", 10.0);
        assert_eq!(plain.letters.len(), lowered.letters.len());
        assert!(lowered.letters[1].y > 0.0 && lowered.width < plain.width);
        assert!(letters.set("10^{3}", 10.0).letters[2].y < 0.0);
        assert!(letters.set("*a*", 10.0).letters[0].glyph.0);
        assert!(!letters.outline(letters.set("*a*", 10.0).letters[0].glyph).is_empty());
    }
}
