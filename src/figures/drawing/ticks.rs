//! Ticks of an axis, and what stands beside them.

use super::{Axis, Spacing};

/// A mark on an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    /// Value, in the unit of the axis.
    pub value: f64,
    /// What stands beside it; none at a small mark.
    pub label: Option<String>,
}

/// The marks of an axis that has room for `most` labels.
///
/// ```
/// use fretwear::figures::drawing::{Axis, Spacing, ticks};
/// let labels = |axis: &Axis| ticks(axis, 5).into_iter().filter_map(|tick| tick.label).collect::<Vec<_>>();
/// let linear = Axis::new("radius", "µm", Spacing::Linear, [-1.2, 1.9]);
/// assert_eq!(labels(&linear), ["−1", "0", "1"]);
/// let logarithmic = Axis::new("cycles", "", Spacing::Logarithmic, [80.0, 2e6]);
/// assert_eq!(labels(&logarithmic), ["10^{2}", "10^{3}", "10^{4}", "10^{5}", "10^{6}"]);
/// ```
pub fn ticks(axis: &Axis, most: usize) -> Vec<Tick> {
    if !axis.ticked {
        return vec![];
    }
    let [first, last] = axis.range;
    match axis.spacing {
        Spacing::Logarithmic if last.log10() - first.log10() >= 0.9 => logarithmic(first, last, most.max(2)),
        // Less than about a decade: ticks as on an even axis.
        _ => linear(first, last, most.max(2)),
    }
}

/// Marks at multiples of 1, 2 or 5 times a power of ten.
fn linear(first: f64, last: f64, most: usize) -> Vec<Tick> {
    let step = step(last - first, most);
    let slack = 1e-9 * (last - first);
    let [from, to] = [((first - slack) / step).ceil(), ((last + slack) / step).floor()];
    let values: Vec<f64> =
        (0..=((to - from).max(0.0) as usize).min(2 * most)).map(|i| (from + i as f64) * step).collect();
    let size = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    values.into_iter().map(|value| Tick { value, label: Some(label(value, step, size)) }).collect()
}

/// The smallest of 1, 2 or 5 times a power of ten of which there are no more than `most` in a range.
fn step(width: f64, most: usize) -> f64 {
    let least = width / most as f64;
    let power = 10f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|it| it * power)
        .find(|it| *it >= 0.999 * least)
        .unwrap_or(10.0 * power)
}

/// A value of an axis whose marks are a step apart and whose largest has a size.
fn label(value: f64, step: f64, size: f64) -> String {
    const LEAST: f64 = 1e-3;
    const MOST: f64 = 1e5;
    if value.abs() < 1e-6 * step {
        return "0".into();
    }
    if (LEAST..MOST).contains(&size) {
        let decimals = (-(step * 1.001).log10().floor()).max(0.0) as usize;
        return with_minus(format!("{value:.decimals$}"));
    }
    let exponent = size.log10().floor() as i32;
    let decimals = (f64::from(exponent) - (step * 1.001).log10().floor()).clamp(0.0, 9.0) as usize;
    let mantissa = value / 10f64.powi(exponent);
    with_minus(format!("{mantissa:.decimals$}·{}", power_of_ten(exponent)))
}

fn power_of_ten(exponent: i32) -> String {
    format!("10^{{{}}}", with_minus(exponent.to_string()))
}

fn with_minus(number: String) -> String {
    number.replace('-', "−")
}

/// Labels at powers of ten, as many of them as there is room for, and small marks between.
fn logarithmic(first: f64, last: f64, most: usize) -> Vec<Tick> {
    const SLACK: f64 = 1e-9;
    let [from, to] = [(first.log10() - SLACK).ceil() as i32, (last.log10() + SLACK).floor() as i32];
    let count = (to - from + 1).max(0) as usize;
    let every = count.div_ceil(most).max(1) as i32;
    // Short axes read better in plain numbers, which then stand at 2 and 5 too.
    let short = count <= 2;
    let plain = from >= -3 && to <= 3;
    let label = |exponent: i32, digit: i32| {
        let value = f64::from(digit) * 10f64.powi(exponent);
        match (plain, digit) {
            (true, _) => format!("{value:.*}", (-exponent).max(0) as usize),
            (false, 1) => power_of_ten(exponent),
            (false, _) => format!("{digit}·{}", power_of_ten(exponent)),
        }
    };
    let mut found = vec![];
    for exponent in from - 1..=to {
        for digit in 1..10 {
            let value = f64::from(digit) * 10f64.powi(exponent);
            if value < first * (1.0 - SLACK) || value > last * (1.0 + SLACK) {
                continue;
            }
            let is_label = match digit {
                1 => exponent.rem_euclid(every) == 0,
                2 | 5 => short,
                _ => false,
            };
            if is_label {
                found.push(Tick { value, label: Some(label(exponent, digit)) });
            } else if digit == 1 || (every == 1 && count <= 10) {
                found.push(Tick { value, label: None });
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(spacing: Spacing, range: [f64; 2], most: usize) -> Vec<String> {
        let axis = Axis::new("x", "", spacing, range);
        ticks(&axis, most).into_iter().filter_map(|tick| tick.label).collect()
    }

    #[test]
    fn labels_tell_neighbours_apart_and_are_not_too_many() {
        for range in [[0.0, 1.0], [1e-9, 3e-9], [-5e7, 2e8], [0.999, 1.001], [86.6, 98.99], [-1.0, -0.2]] {
            for most in 2..9 {
                let found = labels(Spacing::Linear, range, most);
                assert!((1..=most + 1).contains(&found.len()), "{range:?}, {most}: {found:?}");
                assert!(found.windows(2).all(|pair| pair[0] != pair[1]), "{range:?}: {found:?}");
            }
        }
        assert_eq!(labels(Spacing::Linear, [0.0, 2.5e-4], 4), ["0", "1·10^{−4}", "2·10^{−4}"]);
    }

    #[test]
    fn long_logarithmic_axes_skip_powers_and_short_ones_show_steps() {
        assert_eq!(
            labels(Spacing::Logarithmic, [1e-14, 1.0], 4),
            ["10^{−12}", "10^{−8}", "10^{−4}", "10^{0}"]
        );
        assert_eq!(labels(Spacing::Logarithmic, [0.08, 2.0], 8), ["0.1", "0.2", "0.5", "1", "2"]);
        assert_eq!(
            labels(Spacing::Logarithmic, [2e5, 3e6], 4),
            ["2·10^{5}", "5·10^{5}", "10^{6}", "2·10^{6}"]
        );
        assert_eq!(
            labels(Spacing::Logarithmic, [60.0, 100.0], 4),
            ["60", "70", "80", "90", "100"][..].to_vec()
        );
    }
}
