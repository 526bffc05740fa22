//! Physical dimensions and what users call them.

use std::fmt;

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

    /// Hertz.
    pub const FREQUENCY: Self = Self::new(0.0, 0.0, -1.0);
    /// W/m².
    pub const POWER_PER_AREA: Self = Self::new(0.0, 1.0, -3.0);
    /// m²/W.
    pub const AREA_PER_POWER: Self = Self::new(0.0, -1.0, 3.0);
    /// J/m².
    pub const ENERGY_PER_AREA: Self = Self::new(0.0, 1.0, -2.0);

    pub(crate) const POWER: Self = Self::new(2.0, 1.0, -3.0);
    pub(crate) const MASS: Self = Self::new(0.0, 1.0, 0.0);
    pub(crate) const ENERGY: Self = Self::new(2.0, 1.0, -2.0);

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
    pub(crate) fn is(self, other: Self) -> bool {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        near(self.length, other.length)
            && near(self.mass, other.mass)
            && near(self.time, other.time)
            && near(self.angle, other.angle)
    }

    /// The dimension of this times a power of the other.
    pub(crate) fn times(self, other: Self, power: f64) -> Self {
        Self {
            length: self.length + power * other.length,
            mass: self.mass + power * other.mass,
            time: self.time + power * other.time,
            angle: self.angle + power * other.angle,
        }
    }

    /// Its unit in SI in the spelling of UDUNITS; "1" where it depends on an exponent.
    pub fn udunits(self) -> &'static str {
        const UNITS: [(Dimension, &str); 10] = [
            (Dimension::LENGTH, "m"),
            (Dimension::TIME, "s"),
            (Dimension::STIFFNESS, "N m-1"),
            (Dimension::FORCE, "N"),
            (Dimension::PRESSURE, "Pa"),
            (Dimension::INVERSE_PRESSURE, "Pa-1"),
            (Dimension::ANGLE, "rad"),
            (Dimension::FREQUENCY, "Hz"),
            (Dimension::POWER_PER_AREA, "W m-2"),
            (Dimension::AREA_PER_POWER, "m2 W-1"),
        ];
        UNITS.iter().find(|(dimension, _)| dimension.is(self)).map_or("1", |(_, unit)| unit)
    }

    /// What a user calls it, and an example.
    fn name(self) -> Option<(&'static str, &'static str)> {
        const NAMES: [(Dimension, &str, &str); 16] = [
            (Dimension::NUMBER, "a plain number", "0.6"),
            (Dimension::LENGTH, "a length", "5 mm"),
            (Dimension::TIME, "a time", "30 s"),
            (Dimension::FORCE, "a force", "50 N"),
            (Dimension::STIFFNESS, "a stiffness", "5 MN/m"),
            (Dimension::PRESSURE, "a pressure", "210 GPa"),
            (Dimension::INVERSE_PRESSURE, "an inverse pressure", "1e-14 1/Pa"),
            (Dimension::ANGLE, "an angle", "80 deg"),
            (Dimension::FREQUENCY, "a frequency", "10 Hz"),
            (Dimension::POWER, "a power", "1 W"),
            (Dimension::POWER_PER_AREA, "a power per area", "1 W/mm^2"),
            (Dimension::AREA_PER_POWER, "an area per power", "11 mm^2/W"),
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

/// `expected a length such as "5 mm"`.
pub(crate) fn wanted(expected: Dimension) -> String {
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
