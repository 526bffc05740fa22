//! Units: what a symbol stands for and how an expression of symbols is read.

use std::f64::consts::PI;

use super::dimension::Dimension;

/// A unit: its dimension and its size in SI, `10^decimal · numerator/denominator`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Unit {
    pub(crate) dimension: Dimension,
    decimal: f64,
    numerator: f64,
    denominator: f64,
}

impl Unit {
    pub(crate) const ONE: Self =
        Self { dimension: Dimension::NUMBER, decimal: 0.0, numerator: 1.0, denominator: 1.0 };

    const fn decimal(dimension: Dimension, decimal: f64) -> Self {
        Self { dimension, decimal, ..Self::ONE }
    }

    const fn multiple(dimension: Dimension, numerator: f64) -> Self {
        Self { dimension, numerator, ..Self::ONE }
    }

    /// Reads a unit expression; the error is a sentence with the cure.
    pub(crate) fn read(text: &str) -> Result<Self, String> {
        Parser { text, rest: text }.whole()
    }

    /// This unit times a power of the other.
    fn times(self, other: Self, power: f64) -> Self {
        let (over, under) = if power < 0.0 {
            (other.denominator, other.numerator)
        } else {
            (other.numerator, other.denominator)
        };
        Self {
            dimension: self.dimension.times(other.dimension, power),
            decimal: self.decimal + power * other.decimal,
            numerator: self.numerator * over.powf(power.abs()),
            denominator: self.denominator * under.powf(power.abs()),
        }
    }

    /// The number `digits · 10^exponent` of this unit, in SI; None if it overflows.
    pub(crate) fn scale(self, digits: &str, exponent: i64) -> Option<f64> {
        let whole = self.decimal.round();
        // Fractional powers of prefixed units leave a fractional power of ten.
        let rest = if (self.decimal - whole).abs() < 1e-9 { 0.0 } else { self.decimal - whole };
        let power = exponent.saturating_add(whole as i64);
        let number: f64 = format!("{digits}e{power}").parse().ok()?;
        let value = number * 10f64.powf(rest) * self.numerator / self.denominator;
        value.is_finite().then_some(value)
    }
}

const PREFIXED: [(&str, Unit); 9] = [
    ("m", Unit::decimal(Dimension::LENGTH, 0.0)),
    ("g", Unit::decimal(Dimension::MASS, -3.0)),
    ("s", Unit::decimal(Dimension::TIME, 0.0)),
    ("N", Unit::decimal(Dimension::FORCE, 0.0)),
    ("Pa", Unit::decimal(Dimension::PRESSURE, 0.0)),
    ("J", Unit::decimal(Dimension::ENERGY, 0.0)),
    ("W", Unit::decimal(Dimension::POWER, 0.0)),
    ("Hz", Unit::decimal(Dimension::FREQUENCY, 0.0)),
    ("rad", Unit::decimal(Dimension::ANGLE, 0.0)),
];

const PLAIN: [(&str, Unit); 4] = [
    ("min", Unit::multiple(Dimension::TIME, 60.0)),
    ("h", Unit::multiple(Dimension::TIME, 3600.0)),
    ("deg", Unit::multiple(Dimension::ANGLE, PI / 180.0)),
    ("°", Unit::multiple(Dimension::ANGLE, PI / 180.0)),
];

/// Micro is written u, as the micro sign or as the Greek letter.
const PREFIXES: [(&str, f64); 15] = [
    ("", 0.0),
    ("f", -15.0),
    ("p", -12.0),
    ("n", -9.0),
    ("u", -6.0),
    ("\u{b5}", -6.0),
    ("\u{3bc}", -6.0),
    ("m", -3.0),
    ("c", -2.0),
    ("d", -1.0),
    ("h", 2.0),
    ("k", 3.0),
    ("M", 6.0),
    ("G", 9.0),
    ("T", 12.0),
];

/// The unit of a symbol; newtons may stand before a length without a space: `Nm`, `N/Nmm`.
fn lookup(symbol: &str) -> Option<Unit> {
    single(symbol).or_else(|| {
        let end = symbol.find('N')? + 1;
        let (force, length) = (single(&symbol[..end])?, single(&symbol[end..])?);
        (length.dimension == Dimension::LENGTH).then(|| force.times(length, 1.0))
    })
}

fn single(symbol: &str) -> Option<Unit> {
    if let Some((_, unit)) = PLAIN.iter().find(|(name, _)| *name == symbol) {
        return Some(*unit);
    }
    PREFIXES.iter().find_map(|(prefix, decimal)| {
        let rest = symbol.strip_prefix(prefix)?;
        let (_, unit) = PREFIXED.iter().find(|(name, _)| *name == rest)?;
        Some(Unit { decimal: unit.decimal + decimal, ..*unit })
    })
}

/// The cure for a symbol that is no unit: other capitals, or a forgotten space.
fn suggestion(symbol: &str) -> String {
    for (at, _) in symbol.char_indices().skip(1) {
        let (left, right) = symbol.split_at(at);
        if lookup(left).is_some() && lookup(right).is_some() {
            return format!("; did you mean \"{left} {right}\"?");
        }
    }
    let folded = symbol.to_lowercase();
    let mut alike = Vec::new();
    for (prefix, _) in PREFIXES {
        for (name, _) in PREFIXED {
            let candidate = format!("{prefix}{name}");
            if candidate.to_lowercase() == folded {
                alike.push(candidate);
            }
        }
    }
    alike.extend(PLAIN.iter().filter(|(name, _)| *name == folded).map(|(name, _)| name.to_string()));
    match alike.is_empty() {
        true => "; known are m g s N Pa J W Hz rad with SI prefixes, min h deg".to_string(),
        false => format!("; did you mean {}?", alike.join(" or ")),
    }
}

/// Recursive descent over a unit expression.
struct Parser<'a> {
    text: &'a str,
    rest: &'a str,
}

impl Parser<'_> {
    fn fail<T>(&self, why: &str) -> Result<T, String> {
        Err(format!("the unit {:?} cannot be read: {why}", self.text))
    }

    fn take(&mut self, token: &str) -> bool {
        match self.rest.strip_prefix(token) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn whole(mut self) -> Result<Unit, String> {
        let unit = self.product()?;
        match self.rest.chars().next() {
            None => Ok(unit),
            Some(found) => self.fail(&format!("{found:?} is out of place")),
        }
    }

    /// `factor { (space | * | · | /) factor }`.
    fn product(&mut self) -> Result<Unit, String> {
        let mut unit = self.factor()?;
        let mut divided = false;
        loop {
            self.rest = self.rest.trim_start();
            if self.rest.is_empty() || self.rest.starts_with(')') {
                return Ok(unit);
            }
            let divides = self.take("/");
            if !divides {
                let _ = ["·", "\u{22c5}", "*"].into_iter().any(|sign| self.take(sign));
                if divided {
                    return self.fail("after a division a product is ambiguous, write a/(b c)");
                }
            }
            divided |= divides;
            self.rest = self.rest.trim_start();
            unit = unit.times(self.factor()?, if divides { -1.0 } else { 1.0 });
        }
    }

    /// A symbol, `1` or a product in parentheses, with its power.
    fn factor(&mut self) -> Result<Unit, String> {
        let symbol = self.rest.starts_with(char::is_alphabetic);
        let unit = if self.take("(") {
            let unit = self.product()?;
            if !self.take(")") {
                return self.fail("a parenthesis is not closed");
            }
            unit
        } else if self.take("1") {
            Unit::ONE
        } else {
            let end = self.rest.find(|c: char| !(c.is_alphabetic() || c == '°')).unwrap_or(self.rest.len());
            let (symbol, rest) = self.rest.split_at(end);
            if symbol.is_empty() {
                return match self.rest.chars().next() {
                    Some(found) => self.fail(&format!("{found:?} is out of place")),
                    None => self.fail("it ends too early"),
                };
            }
            self.rest = rest;
            match lookup(symbol) {
                Some(unit) => unit,
                None => return self.fail(&format!("{symbol:?} is no known unit{}", suggestion(symbol))),
            }
        };
        let power = self.power(symbol)?;
        Ok(Unit::ONE.times(unit, power))
    }

    /// `^2`, `^-1`, `^2.2`, `^(1/3)`, a superscript, or digits that follow the symbol as in `mm3` and `s-1`; 1 without any.
    fn power(&mut self, symbol: bool) -> Result<f64, String> {
        let follows = symbol
            && self.rest.strip_prefix('-').unwrap_or(self.rest).starts_with(|c: char| c.is_ascii_digit());
        if !follows && !self.take("^") {
            return self.superscript();
        }
        let parentheses = !follows && self.take("(");
        let mut power = self.plain_number()?;
        if parentheses {
            if self.take("/") {
                power /= self.plain_number()?;
            }
            if !self.take(")") {
                return self.fail("a parenthesis is not closed");
            }
        }
        match power.is_finite() && power.abs() <= 100.0 {
            true => Ok(power),
            false => self.fail("a power is larger than 100"),
        }
    }

    fn plain_number(&mut self) -> Result<f64, String> {
        let end =
            self.rest.find(|c: char| !(c.is_ascii_digit() || "+-.".contains(c))).unwrap_or(self.rest.len());
        let (digits, rest) = self.rest.split_at(end);
        match digits.parse() {
            Ok(number) => {
                self.rest = rest;
                Ok(number)
            }
            Err(_) => self.fail("after ^ stands no number"),
        }
    }

    fn superscript(&mut self) -> Result<f64, String> {
        const DIGITS: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
        let mut digits = String::new();
        for c in self.rest.chars() {
            match DIGITS.chars().position(|digit| digit == c) {
                Some(value) => digits.push_str(&value.to_string()),
                None if c == '⁻' && digits.is_empty() => digits.push('-'),
                None => break,
            }
        }
        if digits.is_empty() {
            return Ok(1.0);
        }
        let count = digits.chars().count();
        self.rest = &self.rest[self.rest.chars().take(count).map(char::len_utf8).sum::<usize>()..];
        match digits.parse::<f64>() {
            Ok(power) if power.abs() <= 100.0 => Ok(power),
            _ => self.fail("a superscript is no power"),
        }
    }
}
