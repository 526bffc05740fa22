//! Keys and the tables that they stand in, each declared once. One declaration serves the reader, the schema, the pages of documentation, `--set` and the axes of sweeps.

use std::f64::consts::PI;

use super::dimension::Dimension;
use super::range::Range;

/// What a key takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A number in SI, or a text with a unit of this dimension.
    Quantity(Dimension),
    /// A number, or a text with a unit whose dimension depends on an exponent that another key gives.
    Scaled,
    /// A number with any unit or none.
    Magnitude,
    /// A number without quotes, or this word.
    NumberOr(&'static str),
    /// A ratio of whole numbers: a number, or a text such as `3/2`.
    Ratio,
    /// A whole number.
    Whole,
    /// One of some words.
    Word(&'static [&'static str]),
    /// `true` or `false`.
    Switch,
    /// One line of text.
    Text,
    /// The name of a file or of a unit: a text that is not empty.
    Name,
    /// The dotted name of a key of a scene.
    KeyOfScene,
    /// A value of any key of a scene.
    Literal,
    /// Any part of a scene, laid over another.
    Patch,
    /// Keys of a scene by their dotted names, and their values.
    Settings,
    /// An array: what each of its values is, the fewest and the most.
    List(&'static Key, [usize; 2]),
    /// Values along an axis: an array, or where they begin and end and how many they are; what each of them is, and the most.
    Axis(&'static Key, usize),
    /// A table.
    Table(&'static Table),
    /// An array of tables, the fewest and the most.
    Tables(&'static Table, [usize; 2]),
    /// One of several.
    Either(&'static [Key]),
}

/// A key of a table.
///
/// ```
/// use fretwear::units::{Dimension, Key, Range};
///
/// const PRESSURE: Key = Key::quantity("pressure", Dimension::PRESSURE, "Pressure p_0 below which nothing wears, Pa.")
///     .range(Range::POSITIVE)
///     .example("50 MPa");
/// assert!(PRESSURE.range.contains(5e7) && !PRESSURE.range.contains(0.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key {
    /// The key as it stands in its table.
    pub name: &'static str,
    /// Other names that people try, for which this one is suggested.
    pub aliases: &'static [&'static str],
    /// What it takes.
    pub kind: Kind,
    /// The numbers that it takes, in SI.
    pub range: Range,
    /// Why no others are taken, where that is not plain; empty else.
    pub reason: &'static str,
    /// What is taken where it is left out, as it would be written; none where the key must be given or has no value without it.
    pub default: Option<&'static str>,
    /// Whether the table must have it.
    pub required: bool,
    /// A value as a user would write it, without quotes.
    pub example: &'static str,
    /// One sentence: what it is, its symbol, its unit in SI.
    pub about: &'static str,
    /// Unit in SI, in the spelling of UDUNITS, where it is not that of the dimension.
    pub unit: Option<&'static str>,
}

impl Key {
    /// A required key of any kind and range.
    pub const fn new(name: &'static str, kind: Kind, about: &'static str) -> Self {
        Self {
            name,
            aliases: &[],
            kind,
            range: Range::ANY,
            reason: "",
            default: None,
            required: true,
            example: "",
            about,
            unit: None,
        }
    }

    /// A required key that takes a quantity.
    pub const fn quantity(name: &'static str, dimension: Dimension, about: &'static str) -> Self {
        Self::new(name, Kind::Quantity(dimension), about)
    }

    /// A required key that takes a plain number.
    pub const fn number(name: &'static str, about: &'static str) -> Self {
        Self::quantity(name, Dimension::NUMBER, about)
    }

    /// A required key that takes a table.
    pub const fn table(table: &'static Table) -> Self {
        Self::new(table.name, Kind::Table(table), table.about)
    }

    /// The key with other names, for which it is suggested.
    pub const fn aliases(self, aliases: &'static [&'static str]) -> Self {
        Self { aliases, ..self }
    }

    /// The key with a range.
    pub const fn range(self, range: Range) -> Self {
        Self { range, ..self }
    }

    /// The key with a reason for its range, which an error tells.
    pub const fn because(self, reason: &'static str) -> Self {
        Self { reason, ..self }
    }

    /// The key with an example.
    pub const fn example(self, example: &'static str) -> Self {
        Self { example, ..self }
    }

    /// The key, which may be left out and then has this value.
    pub const fn default(self, default: &'static str) -> Self {
        Self { default: Some(default), required: false, ..self }
    }

    /// The key, which may be left out.
    pub const fn optional(self) -> Self {
        Self { required: false, ..self }
    }

    /// The key with its unit in SI spelled out for UDUNITS.
    pub const fn unit(self, unit: &'static str) -> Self {
        Self { unit: Some(unit), ..self }
    }

    /// The key for a quantity of this dimension.
    pub const fn of(self, dimension: Dimension) -> Self {
        Self { kind: Kind::Quantity(dimension), ..self }
    }

    /// Unit of its number in SI, in the spelling of UDUNITS; "1" for plain numbers, words and what has a unit that depends on an exponent.
    pub fn si_unit(&self) -> &'static str {
        match (self.unit, self.kind) {
            (Some(unit), _) => unit,
            (None, Kind::Quantity(dimension)) => dimension.udunits(),
            _ => "1",
        }
    }

    /// The range as an error tells it: angles in degrees, a bound of another dimension with its unit, then the reason.
    pub(crate) fn range_in_words(&self) -> String {
        let Range { from, to } = self.range;
        let bounded = [from.0, to.0].iter().any(|end| end.is_finite() && *end != 0.0);
        let range = match (self.kind, self.si_unit()) {
            (Kind::Whole, _) if to.0.is_finite() => format!("{} to {}", from.0, to.0),
            (_, "1") => self.range.to_string(),
            (_, "rad") if bounded => {
                let degrees = |(end, belongs): (f64, bool)| ((end * 180.0 / PI * 1e9).round() / 1e9, belongs);
                let range = Range { from: degrees(from), to: degrees(to) }.to_string();
                let (inside, close) = range.split_at(range.len() - 1);
                format!("{inside} deg{close}")
            }
            (_, unit) if bounded => format!("{} {unit}", self.range),
            _ => self.range.to_string(),
        };
        if self.reason.is_empty() { range } else { format!("{range}; {}", self.reason) }
    }

    /// The example as it stands in TOML; None without one.
    pub(crate) fn example_in_toml(&self) -> Option<String> {
        let bare = !matches!(self.kind, Kind::Word(_) | Kind::Text | Kind::Name | Kind::KeyOfScene)
            // An array of one text looks like the head of a table.
            && (matches!(self.kind, Kind::List(..)) || self.example.parse::<toml::Table>().is_err())
            && format!("x = {}", self.example).parse::<toml::Table>().is_ok();
        let quoted = || format!("{:?}", self.example);
        (!self.example.is_empty()).then(|| if bare { self.example.into() } else { quoted() })
    }
}

/// Keys that stand together.
///
/// ```
/// use fretwear::units::{Key, Range, Rule, Table};
///
/// const SLOPE: Key = Key::number("slope", "Slope of the flank.").range(Range::POSITIVE).optional();
/// const ANGLE: Key = Key::number("angle", "Angle of the flank.").range(Range::POSITIVE).optional();
/// const CONE: Table = Table::new("cone", "f = r tan θ.", &[SLOPE, ANGLE]).rules(&[Rule::OneOf(&["slope", "angle"])]);
/// assert_eq!(CONE.rivals("slope"), ["angle"]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Table {
    /// The key under which it stands; empty for a document.
    pub name: &'static str,
    /// One sentence: what it describes.
    pub about: &'static str,
    /// Its keys.
    pub keys: &'static [Key],
    /// Which keys go together.
    pub rules: &'static [Rule],
}

/// Which keys of a table go together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rule {
    /// Exactly one of these is given.
    OneOf(&'static [&'static str]),
    /// One of these at most is given.
    AtMostOneOf(&'static [&'static str]),
    /// The keys are given in exactly one of these forms.
    Forms(&'static [Form]),
    /// The first of these is given beside the second only.
    Needs(&'static str, &'static str),
    /// The word of a key decides which other keys are given.
    Words(&'static str, &'static [(&'static str, Form)]),
}

/// Keys that are given together. Those of other forms have no place beside them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Form {
    /// What must be given.
    pub needs: &'static [&'static str],
    /// What may be given besides.
    pub may: &'static [&'static str],
}

impl Form {
    /// No keys.
    pub const NONE: Self = Self::new(&[]);

    /// Keys that must be given together.
    pub const fn new(needs: &'static [&'static str]) -> Self {
        Self { needs, may: &[] }
    }

    /// The form with keys that may be given besides.
    pub const fn may(self, may: &'static [&'static str]) -> Self {
        Self { may, ..self }
    }

    /// Whether a key is one of its keys.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.keys().any(|own| own == key)
    }

    /// All its keys.
    pub fn keys(&self) -> impl Iterator<Item = &'static str> {
        self.needs.iter().chain(self.may).copied()
    }
}

impl Rule {
    /// The keys of each form, those that it needs first in number; none for a rule that is not of forms.
    pub(crate) fn forms(&self) -> Vec<Form> {
        match self {
            Rule::OneOf(keys) | Rule::AtMostOneOf(keys) => {
                (0..keys.len()).map(|place| Form::new(&keys[place..=place])).collect()
            }
            Rule::Forms(forms) => forms.to_vec(),
            Rule::Needs(..) | Rule::Words(..) => vec![],
        }
    }
}

impl Table {
    /// A table of keys.
    pub const fn new(name: &'static str, about: &'static str, keys: &'static [Key]) -> Self {
        Self { name, about, keys, rules: &[] }
    }

    /// The table with rules.
    pub const fn rules(self, rules: &'static [Rule]) -> Self {
        Self { rules, ..self }
    }

    /// The key of a name.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    /// The key of a dotted name, through the tables within this one.
    pub fn find(&self, dotted: &str) -> Option<&'static Key> {
        match dotted.split_once('.') {
            None => self.key(dotted),
            Some((first, rest)) => match self.key(first)?.kind {
                Kind::Table(inner) => inner.find(rest),
                _ => None,
            },
        }
    }

    /// Dotted names of all keys that have values, through the tables within this one; those of arrays of tables by the array alone.
    pub fn dotted(&self) -> Vec<String> {
        let below = |key: &Key| match key.kind {
            Kind::Table(inner) => inner.dotted().iter().map(|it| format!("{}.{it}", key.name)).collect(),
            _ => vec![key.name.to_owned()],
        };
        self.keys.iter().flat_map(below).collect()
    }

    /// Keys that cannot be given beside one.
    pub fn rivals(&self, name: &str) -> Vec<&'static str> {
        let mut rivals = vec![];
        for rule in self.rules {
            let forms = rule.forms();
            let (with, without): (Vec<&Form>, Vec<&Form>) = forms.iter().partition(|form| form.has(name));
            let beside = |rival: &str| with.iter().any(|form| form.has(rival));
            if !with.is_empty() {
                rivals.extend(without.iter().flat_map(|form| form.keys()).filter(|key| !beside(key)));
            }
        }
        rivals.dedup();
        rivals
    }
}
