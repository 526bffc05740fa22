//! Numbers as people read them, and tables of two columns.

use std::fmt::Write;

use crate::contact::indenter::{Indenter, TabulatedProfile};
use crate::data::quantity::{Reading, Value};
use crate::laws::loading::RecordedPath;

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

/// `paraboloid, radius 10 mm`.
pub(super) fn indenter(indenter: &Indenter) -> String {
    match *indenter {
        Indenter::Paraboloid { radius } => format!("paraboloid, radius {}", Scale::LENGTH.show(radius)),
        Indenter::Sphere { radius } => format!("sphere, radius {}", Scale::LENGTH.show(radius)),
        Indenter::Cone { slope } => format!("cone, slope {}", number(slope)),
        Indenter::PowerLaw { coefficient, exponent } => {
            format!("power law, {} r^{} (m)", number(coefficient), number(exponent))
        }
        Indenter::Table(ref table) => self::table(table),
    }
}

/// `table ball.csv, 201 rows, radius 0 to 0.5 mm, f to 12 µm`.
pub(super) fn table(table: &TabulatedProfile) -> String {
    let smoothing = table
        .smoothing()
        .map_or_else(String::new, |it| format!(", smoothed with {}", Scale::LENGTH.show(it.deviation)));
    format!(
        "table {}, {} rows, radius 0 to {}, f to {}{smoothing}",
        table.source(),
        table.heights().len(),
        Scale::LENGTH.show(table.largest_radius()),
        Scale::LENGTH.show(table.heights().iter().copied().fold(0.0, f64::max)),
    )
}

/// `path path.csv, 360 rows`.
pub(super) fn recorded_path(path: &RecordedPath) -> String {
    format!("path {}, {} rows", path.source, path.x.len())
}

/// Width of the names in a table.
const WIDTH: usize = 34;

/// Lines of a name and a value, for people.
#[derive(Debug, Default)]
pub(crate) struct TextTable {
    title: Option<String>,
    /// Both are empty at a gap; the value alone at a heading.
    pub lines: Vec<(String, String)>,
}

impl TextTable {
    /// Begins with a title, if there is one.
    pub(crate) fn titled(title: Option<&str>) -> Self {
        Self { title: title.map(str::to_owned), lines: vec![] }
    }

    pub(crate) fn row(&mut self, name: &str, value: impl std::fmt::Display) {
        self.lines.push((name.to_owned(), value.to_string()));
    }

    /// A row whose value may have no meaning.
    pub(crate) fn optional(&mut self, name: &str, value: Option<String>) {
        self.row(name, value.as_deref().unwrap_or("none"));
    }

    /// A row of what was read off a record.
    pub(crate) fn reading<R>(&mut self, reading: &Reading<R>, record: &R) {
        self.optional(reading.heading, shown(&(reading.of)(record), reading.quantity.units));
    }

    pub(crate) fn gap(&mut self) {
        self.lines.push(Default::default());
    }

    pub(crate) fn text(&self) -> String {
        let mut text = self.title.as_ref().map_or(String::new(), |title| format!("{title}\n\n"));
        for (name, value) in &self.lines {
            // Writing to a string cannot fail.
            let _ = match name.as_str() {
                "" => writeln!(text),
                name => writeln!(text, "{name:<WIDTH$} {value}"),
            };
        }
        text
    }
}

/// A value with its unit; none where there is none.
pub(crate) fn shown(value: &Value, units: &str) -> Option<String> {
    Some(match value {
        Value::Number(value) => Scale::of(units).map_or_else(|| number(*value), |scale| scale.show(*value)),
        Value::Count(count) => count.to_string(),
        Value::Truth(holds) => if *holds { "yes" } else { "no" }.to_owned(),
        Value::Word(word) => word.clone(),
        Value::Missing => return None,
    })
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
}
