//! Numbers as people read them: six digits and the unit that makes them short.

/// A kind of quantity and the units it is shown in, by growing size in SI.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scale(&'static [(f64, &'static str)]);

impl Scale {
    pub(crate) const LENGTH: Self =
        Self(&[(1e-12, "pm"), (1e-9, "nm"), (1e-6, "µm"), (1e-3, "mm"), (1.0, "m"), (1e3, "km")]);
    pub(crate) const VOLUME: Self =
        Self(&[(1e-27, "nm³"), (1e-18, "µm³"), (1e-9, "mm³"), (1.0, "m³"), (1e9, "km³")]);
    pub(crate) const FORCE: Self =
        Self(&[(1e-9, "nN"), (1e-6, "µN"), (1e-3, "mN"), (1.0, "N"), (1e3, "kN"), (1e6, "MN")]);
    pub(crate) const PRESSURE: Self =
        Self(&[(1.0, "Pa"), (1e3, "kPa"), (1e6, "MPa"), (1e9, "GPa"), (1e12, "TPa")]);
    pub(crate) const ENERGY: Self =
        Self(&[(1e-9, "nJ"), (1e-6, "µJ"), (1e-3, "mJ"), (1.0, "J"), (1e3, "kJ"), (1e6, "MJ")]);
    pub(crate) const TIME: Self = Self(&[(1e-3, "ms"), (1.0, "s")]);

    /// The scale of units as files have them; none for pure numbers and other units.
    pub(crate) fn of(units: &str) -> Option<Self> {
        match units {
            "m" => Some(Self::LENGTH),
            "m3" => Some(Self::VOLUME),
            "N" => Some(Self::FORCE),
            "Pa" => Some(Self::PRESSURE),
            "J" => Some(Self::ENERGY),
            "s" => Some(Self::TIME),
            _ => None,
        }
    }

    /// A value in SI with the largest unit of which there is at least one.
    pub(crate) fn show(self, value: f64) -> String {
        let (unit, symbol) = self.unit(value);
        format!("{} {symbol}", number(value / unit))
    }

    /// That unit, its size in SI and its symbol.
    pub(crate) fn unit(self, value: f64) -> (f64, &'static str) {
        // The rounding of six digits must not leave 1000 of one unit instead of 1 of the next.
        let size = value.abs() * (1.0 + 5e-7);
        let plain = self.0.iter().find(|(unit, _)| *unit == 1.0).unwrap_or(&self.0[0]);
        match value {
            value if value == 0.0 || !value.is_finite() => *plain,
            _ => *self.0.iter().rev().find(|(unit, _)| size >= *unit).unwrap_or(&self.0[0]),
        }
    }
}

/// Six significant digits, without trailing zeros.
pub(crate) fn number(value: f64) -> String {
    const DIGITS: usize = 6;
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return value.to_string();
    }
    let scientific = format!("{value:.*e}", DIGITS - 1);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    match exponent.parse::<i32>() {
        Ok(exponent) if (-4..DIGITS as i32).contains(&exponent) => {
            let decimals = (DIGITS as i32 - 1 - exponent).max(0) as usize;
            trimmed(&format!("{value:.decimals$}")).to_string()
        }
        _ => format!("{}e{exponent}", trimmed(mantissa)),
    }
}

fn trimmed(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

/// A unit as people write it: `1/Pa` of `Pa-1`, `m³/(N m)` of `m3 N-1 m-1`; nothing of a pure number.
pub(crate) fn unit_in_words(unit: &str) -> String {
    if unit == "1" {
        return String::new();
    }
    let raised = |power: &str| -> String {
        let digit = |it: char| match it {
            '0'..='9' => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][it as usize - '0' as usize],
            other => other,
        };
        match power {
            "" | "1" => String::new(),
            power if power.contains('.') => format!("^{power}"),
            power => power.chars().map(digit).collect(),
        }
    };
    let (mut above, mut below) = (vec![], vec![]);
    for factor in unit.split(' ').filter(|it| !it.is_empty()) {
        let end = factor.find(|it: char| it == '-' || it.is_ascii_digit()).unwrap_or(factor.len());
        let (symbol, power) = factor.split_at(end);
        match power.strip_prefix('-') {
            Some(power) => below.push(format!("{symbol}{}", raised(power))),
            None => above.push(format!("{symbol}{}", raised(power))),
        }
    }
    let above = if above.is_empty() { "1".into() } else { above.join(" ") };
    match &below[..] {
        [] => above,
        [one] => format!("{above}/{one}"),
        all => format!("{above}/({})", all.join(" ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_six_digits_and_no_more() {
        let shown = [0.0, -0.0, 1.0, 0.1, 0.8235294117647058, 123456.7, 1234567.8, 1e-5, -2.5e-4, 999999.7];
        let expected = ["0", "0", "1", "0.1", "0.823529", "123457", "1.23457e6", "1e-5", "-0.00025", "1e6"];
        assert_eq!(shown.map(number), expected);
    }

    #[test]
    fn quantities_have_the_unit_that_makes_them_short() {
        let lengths = [0.0, 0.01, 8.66e-5, 9.999_999_9e-7, 3.25e-7, 5.0, 1e-20, 2.5e7, f64::NAN];
        let expected = ["0 m", "10 mm", "86.6 µm", "1 µm", "325 nm", "5 m", "1e-8 pm", "25000 km", "NaN m"];
        assert_eq!(lengths.map(|length| Scale::LENGTH.show(length)), expected);
        assert_eq!(Scale::VOLUME.show(2.5e-12), "2.5e6 µm³");
        assert_eq!(Scale::PRESSURE.show(4.2e8), "420 MPa");
    }

    #[test]
    fn units_are_written_as_people_do() {
        for (unit, words) in
            [("1", ""), ("Pa-1", "1/Pa"), ("m3 N-1 m-1", "m³/(N m)"), ("m", "m"), ("N m-2.5", "N/m^2.5")]
        {
            assert_eq!(unit_in_words(unit), words);
        }
    }
}
