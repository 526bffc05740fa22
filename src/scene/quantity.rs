//! Quantities with units: `"10 mm"`, `"210 GPa"`, `"1e-5 mm^3/(N m)"`, read exactly.
//!
//! The unit is a product or quotient of `m g s N Pa J rad` with the SI prefixes from f (femto) to T (tera), and of
//! `min h deg °` without. A space, `*` or `·` multiplies, `/` divides, `^` or a superscript raises to a decimal power or,
//! in parentheses, to a fraction. What is divided by a product stands in parentheses.

use std::fmt;

use super::unit::Unit;

/// Physical dimension as powers of metre, kilogram, second and radian; an angle is not a plain number here.
///
/// The powers are real numbers: a spring stiffness has `N/m^(2+k)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dimension {
    length: f64,
    mass: f64,
    time: f64,
    angle: f64,
}

impl Dimension {
    /// A plain number.
    pub const NUMBER: Self = Self::new(0.0, 0.0, 0.0);
    /// Metre.
    pub const LENGTH: Self = Self::new(1.0, 0.0, 0.0);
    /// Second.
    pub const TIME: Self = Self::new(0.0, 0.0, 1.0);
    /// N/m, of a spring between two bodies.
    pub const STIFFNESS: Self = Self::new(0.0, 1.0, -2.0);
    /// Newton.
    pub const FORCE: Self = Self::new(1.0, 1.0, -2.0);
    /// Pascal.
    pub const PRESSURE: Self = Self::new(-1.0, 1.0, -2.0);
    /// 1/Pa, which is also m³/(N m).
    pub const INVERSE_PRESSURE: Self = Self::new(1.0, -1.0, 2.0);
    /// Radian.
    pub const ANGLE: Self = Self { angle: 1.0, ..Self::NUMBER };

    pub(super) const MASS: Self = Self::new(0.0, 1.0, 0.0);
    pub(super) const ENERGY: Self = Self::new(2.0, 1.0, -2.0);

    const fn new(length: f64, mass: f64, time: f64) -> Self {
        Self { length, mass, time, angle: 0.0 }
    }

    /// N/m^(2+k), of the spring stiffness `c_N` at grading `k`.
    pub fn spring_stiffness(grading: f64) -> Self {
        Self { length: 1.0 - (2.0 + grading), ..Self::FORCE }
    }

    /// m^(1-n), of the coefficient `A` of a profile `A r^n`.
    pub fn profile_coefficient(exponent: f64) -> Self {
        Self { length: 1.0 - exponent, ..Self::NUMBER }
    }

    /// Equal but for the rounding of powers such as `2 + k`.
    fn is(self, other: Self) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        near(self.length, other.length)
            && near(self.mass, other.mass)
            && near(self.time, other.time)
            && near(self.angle, other.angle)
    }

    /// The dimension of this times a power of the other.
    pub(super) fn times(self, other: Self, power: f64) -> Self {
        Self {
            length: self.length + power * other.length,
            mass: self.mass + power * other.mass,
            time: self.time + power * other.time,
            angle: self.angle + power * other.angle,
        }
    }

    /// What a user calls it, and an example.
    fn name(self) -> Option<(&'static str, &'static str)> {
        const NAMES: [(Dimension, &str, &str); 12] = [
            (Dimension::NUMBER, "a plain number", "0.6"),
            (Dimension::LENGTH, "a length", "5 mm"),
            (Dimension::TIME, "a time", "30 s"),
            (Dimension::FORCE, "a force", "50 N"),
            (Dimension::STIFFNESS, "a stiffness", "5 MN/m"),
            (Dimension::PRESSURE, "a pressure", "210 GPa"),
            (Dimension::INVERSE_PRESSURE, "an inverse pressure", "1e-14 1/Pa"),
            (Dimension::ANGLE, "an angle", "80 deg"),
            (Dimension::MASS, "a mass", "1 kg"),
            (Dimension::ENERGY, "an energy", "1 J"),
            (Dimension::new(2.0, 0.0, 0.0), "an area", "1 mm^2"),
            (Dimension::new(3.0, 0.0, 0.0), "a volume", "1 mm^3"),
        ];
        NAMES.iter().find(|(dimension, _, _)| dimension.is(self)).map(|&(_, name, example)| (name, example))
    }
}

impl fmt::Display for Dimension {
    /// `a length`, or the SI unit where the quantity has no common name.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.name() {
            Some((name, _)) => f.write_str(name),
            None => write!(f, "a quantity in {}", si_unit(*self)),
        }
    }
}

/// Reads a quantity and converts it to SI.
///
/// The powers of ten of number and prefixes are added before the number is read, so that `"10 mm"` is 0.01 and nothing beside it.
///
/// # Arguments
/// * `text` -- a number, then a unit unless a plain number is expected
/// * `expected` -- the dimension that the unit must have
///
/// # Errors
/// A sentence that says what was expected and what was found; it does not repeat the name of the key.
///
/// ```
/// use fretwear::scene::quantity::{Dimension, parse};
/// assert_eq!(parse("10 mm", Dimension::LENGTH), Ok(0.01));
/// assert_eq!(parse("1e-5 mm^3/(N m)", Dimension::INVERSE_PRESSURE), Ok(1e-14));
/// assert!(parse("5 MPa", Dimension::LENGTH).is_err());
/// ```
pub fn parse(text: &str, expected: Dimension) -> Result<f64, String> {
    // Long enough for any unit, short enough for the recursion over parentheses.
    const LONGEST: usize = 200;
    let shown = text.trim();
    if shown.len() > LONGEST {
        return Err(format!("a quantity of {} characters is too long; {}", shown.len(), wanted(expected)));
    }
    let (number, exponent, unit) = split_number(shown)
        .ok_or_else(|| format!("{shown:?} does not begin with a number; {}", wanted(expected)))?;
    let unit = unit.trim_start();
    if unit.starts_with(',') {
        return Err(format!("{shown:?} has a decimal comma; write a point"));
    }
    let unit = if unit.is_empty() { Unit::ONE } else { Unit::read(unit)? };
    if !unit.dimension.is(expected) {
        if unit.dimension.is(Dimension::NUMBER) {
            let cure = "add one, or write a number without quotes for SI";
            return Err(format!("{shown:?} has no unit; {}; {cure}", wanted(expected)));
        }
        return Err(format!("{}, found {shown:?} ({})", wanted(expected), unit.dimension));
    }
    unit.scale(number, exponent).ok_or_else(|| format!("{shown:?} is too large for a double"))
}

/// `expected a length such as "5 mm"`.
pub(super) fn wanted(expected: Dimension) -> String {
    match expected.name() {
        Some((name, example)) if expected.is(Dimension::NUMBER) => {
            format!("expected {name} such as {example}")
        }
        Some((name, example)) => format!("expected {name} such as {example:?}"),
        None => format!("expected {expected} such as \"1 {}\"", si_unit(expected)),
    }
}

/// The unit in SI, with the newton where it makes the expression short: `N/m^2.5`.
fn si_unit(dimension: Dimension) -> String {
    let Dimension { length, mass, time, angle } = dimension;
    let newton = mass == 1.0 && time == -2.0 && angle == 0.0;
    let powers = match newton {
        true => vec![("N", 1.0), ("m", length - 1.0)],
        false => vec![("kg", mass), ("m", length), ("s", time), ("rad", angle)],
    };
    let tidy = |power: f64| (power * 1e9).round() / 1e9;
    let raised = |(symbol, power): (&str, f64)| match tidy(power) {
        1.0 => symbol.to_string(),
        other => format!("{symbol}^{other}"),
    };
    if newton && tidy(length - 1.0) < 0.0 {
        return format!("N/{}", raised(("m", 1.0 - length)));
    }
    powers.into_iter().filter(|&(_, power)| tidy(power) != 0.0).map(raised).collect::<Vec<_>>().join(" ")
}

/// Splits `"5.0e-3 mm"` into the digits `5.0`, the power of ten -3 and the rest; None without a number.
pub(super) fn split_number(text: &str) -> Option<(&str, i64, &str)> {
    let bytes = text.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let sign = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let whole = digits(sign);
    let mut end = sign + whole;
    let mut fraction = 0;
    if bytes.get(end) == Some(&b'.') {
        fraction = digits(end + 1);
        end += 1 + fraction;
    }
    if whole + fraction == 0 {
        return None;
    }
    let mantissa = &text[..end];
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let count = digits(end + 1 + sign);
        if count > 0 {
            let last = end + 1 + sign + count;
            // A power that overflows even i64 is out of every range: any far value does.
            let exponent =
                text[end + 1..last].parse().unwrap_or(if bytes[end + 1] == b'-' { -9999 } else { 9999 });
            return Some((mantissa, exponent, &text[last..]));
        }
    }
    Some((mantissa, 0, &text[end..]))
}
