//! Tables of keys: which keys there are, and which of them go together.

use super::Key;
use super::key::Kind;

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
