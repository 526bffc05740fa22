//! Colours that readers of all kinds of sight, and greyscale prints, tell apart.

use std::fmt;

/// A colour, red, green and blue from 0 to 255.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Colour(pub [u8; 3]);

impl Colour {
    /// Black.
    pub const BLACK: Self = Self([0; 3]);
    /// Of texts and lines that stand back.
    pub const GREY: Self = Self([110; 3]);
    /// Of lines that mark a place.
    pub const PALE: Self = Self([170; 3]);
    /// Of areas that mean nothing.
    pub const LIGHT: Self = Self([218; 3]);

    /// Relative luminance (sRGB), from 0, black, to 1, white.
    ///
    /// ```
    /// use fretwear::figures::drawing::Colour;
    /// assert_eq!(Colour::BLACK.luminance(), 0.0);
    /// assert!((Colour([255; 3]).luminance() - 1.0).abs() < 1e-12);
    /// ```
    pub fn luminance(self) -> f64 {
        let linear = self.0.map(|part| {
            let part = f64::from(part) / 255.0;
            if part <= 0.04045 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
        });
        0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    }

    /// This colour with a part of white.
    #[must_use]
    pub fn towards_white(self, part: f64) -> Self {
        Self(self.0.map(|value| (f64::from(value) + part * (255.0 - f64::from(value))).round() as u8))
    }
}

impl fmt::Display for Colour {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let [red, green, blue] = self.0;
        write!(formatter, "#{red:02x}{green:02x}{blue:02x}")
    }
}

/// Colours without an order, by Okabe and Ito but for their yellow, which is lost on white.
pub const DISTINCT: [Colour; 7] = [
    Colour([0, 114, 178]),
    Colour([213, 94, 0]),
    Colour([0, 158, 115]),
    Colour([204, 121, 167]),
    Colour([86, 180, 233]),
    Colour([230, 159, 0]),
    Colour([0, 0, 0]),
];

/// From yellow to dark violet: lightness falls steadily, and hue passes through green and blue, which all kinds of sight order alike.
const STOPS: [[u8; 3]; 10] = [
    [253, 231, 37],
    [181, 222, 43],
    [110, 206, 88],
    [53, 183, 121],
    [31, 158, 137],
    [38, 130, 142],
    [49, 104, 142],
    [62, 73, 137],
    [72, 40, 120],
    [68, 1, 84],
];

/// The colour of a place between 0, light, and 1, dark.
pub fn graded(place: f64) -> Colour {
    let last = STOPS.len() - 1;
    let place = if place.is_finite() { place.clamp(0.0, 1.0) * last as f64 } else { 0.0 };
    let from = (place as usize).min(last - 1);
    let part = place - from as f64;
    let mixed = |one: u8, other: u8| ((1.0 - part) * f64::from(one) + part * f64::from(other)).round() as u8;
    Colour(std::array::from_fn(|i| mixed(STOPS[from][i], STOPS[from + 1][i])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn graded_colours_grow_darker_all_the_way() {
        let luminances: Vec<f64> = (0..=100).map(|i| graded(f64::from(i) / 100.0).luminance()).collect();
        assert!(luminances.windows(2).all(|pair| pair[1] <= pair[0]), "{luminances:?}");
        assert!(luminances[0] > 0.7 && luminances[100] < 0.03, "{luminances:?}");
    }
}
