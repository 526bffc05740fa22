//! Quantities with units: `"10 mm"`, `"210 GPa"`, `"1e-5 mm^3/(N m)"`, read exactly.
//!
//! The unit is a product or quotient of `m g s N Pa J W Hz rad` with the SI prefixes from f (femto) to T (tera), and of
//! `min h deg °` without. A space, `*` or `·` multiplies, `/` divides, `^` or a superscript raises to a decimal power or,
//! in parentheses, to a fraction; digits behind a symbol are a power too: `mm3`. What is divided by a product stands in parentheses, but for
//! newtons times a length written as one word: `mm3/Nm`.

use super::dimension::{Dimension, wanted};
use super::unit::Unit;

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
/// use fretwear::units::{Dimension, parse};
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

/// Splits `"5.0e-3 mm"` into the digits `5.0`, the power of ten -3 and the rest; None without a number.
pub(crate) fn split_number(text: &str) -> Option<(&str, i64, &str)> {
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
