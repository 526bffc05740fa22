//! Roots of functions of one variable.

use crate::error::{Error, Result};

/// What does not converge where no root is found.
pub(crate) const SEARCH: &str = "root search";

/// Evaluations after which a search is given up: bisection alone needs no more for any bracket that is not absurd.
const MAX_EVALUATIONS: usize = 200;

/// Root of `function` next to a guess that is right but for roundings and what a discretisation leaves, by the secant method.
///
/// Steps are taken as long as they shrink; whether the root is one is for the caller to see. For functions that take long and are smooth.
///
/// # Arguments
/// * `function` -- of which a root is near
/// * `guess` -- not zero
pub fn next_to(mut function: impl FnMut(f64) -> f64, guess: f64) -> f64 {
    const FIRST_STEP: f64 = 1e-6;
    let (mut x, mut value) = (guess, function(guess));
    let mut step = FIRST_STEP * guess;
    while value != 0.0 {
        let next = x + step;
        let next_value = function(next);
        let change = -next_value * step / (next_value - value);
        (x, value) = (next, next_value);
        // The first step is none towards the root.
        let before = if step == FIRST_STEP * guess { f64::INFINITY } else { step.abs() };
        if !(change.abs() < 0.5 * before && change.abs() > f64::EPSILON * x.abs()) {
            break;
        }
        step = change;
    }
    x
}

/// Root of `function` between `low` and `high`, by Brent's method.
///
/// Inverse quadratic interpolation guarded by bisection; one evaluation a step. (The `roots` crate evaluates twice a step and multiplies
/// function values to compare signs, which underflows for values below 1e-162.)
///
/// # Arguments
/// * `function` -- continuous, of opposite signs at `low` and `high`
/// * `low`, `high` -- ends of the bracket
/// * `tolerance` -- absolute error allowed; 0 asks for two units in the last place of the root
///
/// # Errors
/// [`Error::NotConverged`] if there is no change of sign, a value is not a number, or 200 evaluations do not suffice.
///
/// # Examples
/// ```
/// use fretwear::numerics::roots::bracketed;
///
/// let root = bracketed(|x| x * x - 2.0, 0.0, 2.0, 0.0)?;
/// assert!((root - 2f64.sqrt()).abs() < 1e-15);
/// # Ok::<(), fretwear::Error>(())
/// ```
pub fn bracketed(mut function: impl FnMut(f64) -> f64, low: f64, high: f64, tolerance: f64) -> Result<f64> {
    let (mut previous, mut best) = (low, high);
    let (mut previous_value, mut best_value) = (function(low), function(high));
    if previous_value == 0.0 {
        return Ok(low);
    }
    let same_side = best_value != 0.0 && previous_value.signum() == best_value.signum();
    if same_side || previous_value.is_nan() || best_value.is_nan() {
        return Err(not_converged(format!(
            "no change of sign: f({low:e}) = {previous_value:e}, f({high:e}) = {best_value:e}"
        )));
    }
    // `far` is the end of the bracket on the other side of the root from `best`.
    let (mut far, mut far_value) = (previous, previous_value);
    let mut step = best - previous;
    let mut step_before = step;
    for _ in 2..MAX_EVALUATIONS {
        if best_value.signum() == far_value.signum() {
            (far, far_value) = (previous, previous_value);
            step = best - previous;
            step_before = step;
        }
        if far_value.abs() < best_value.abs() {
            (previous, best, far) = (best, far, best);
            (previous_value, best_value, far_value) = (best_value, far_value, best_value);
        }
        let allowed = 2.0 * f64::EPSILON * best.abs() + 0.5 * tolerance;
        let half = 0.5 * (far - best);
        if half.abs() <= allowed || best_value == 0.0 {
            return Ok(best);
        }
        let interpolated = interpolation_step([previous, best, far], [previous_value, best_value, far_value]);
        let inside = interpolated * half > 0.0 && interpolated.abs() < 1.5 * half.abs() - 0.5 * allowed;
        if step_before.abs() >= allowed && inside && interpolated.abs() < 0.5 * step_before.abs() {
            step_before = step;
            step = interpolated;
        } else {
            step = half;
            step_before = half;
        }
        (previous, previous_value) = (best, best_value);
        best += if step.abs() > allowed { step } else { allowed.copysign(half) };
        best_value = function(best);
        if best_value.is_nan() {
            return Err(not_converged(format!("f({best}) is not a number")));
        }
    }
    Err(not_converged(format!(
        "between {best} and {far} after {MAX_EVALUATIONS} evaluations, f = {best_value}"
    )))
}

/// Step from the second of three points by inverse quadratic interpolation, or by the secant where two points coincide.
fn interpolation_step(
    [previous, best, far]: [f64; 3],
    [previous_value, best_value, far_value]: [f64; 3],
) -> f64 {
    let ratio = best_value / previous_value;
    if previous == far {
        return -ratio * (far - best) / (1.0 - ratio);
    }
    let (q, r) = (previous_value / far_value, best_value / far_value);
    let numerator = ratio * ((far - best) * q * (q - r) - (best - previous) * (r - 1.0));
    -numerator / ((q - 1.0) * (r - 1.0) * (ratio - 1.0))
}

fn not_converged(why: String) -> Error {
    Error::NotConverged { what: SEARCH, why }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_roots_take_few_evaluations() {
        let mut evaluations = 0;
        let root = bracketed(
            |x| {
                evaluations += 1;
                x.cos() - x
            },
            0.0,
            1.0,
            0.0,
        )
        .unwrap();
        assert!((root - 0.7390851332151607).abs() < 3e-16, "{root}");
        assert!(evaluations <= 10, "{evaluations} evaluations");
    }

    #[test]
    fn tiny_roots_and_tiny_values_keep_relative_accuracy() {
        let root = bracketed(|x| 1e-200 * ((x / 1e-14).exp() - 2.0), 0.0, 1e-12, 0.0).unwrap();
        assert!((root / (1e-14 * 2f64.ln()) - 1.0).abs() < 1e-14, "{root:e}");
    }

    #[test]
    fn flat_and_steep_functions_converge() {
        let flat = bracketed(|x| (x - 0.3).powi(9), -5.0, 11.0, 1e-10).unwrap();
        assert!((flat - 0.3).abs() < 1e-3, "{flat}");
        let step = bracketed(|x| if x < 0.123 { -1.0 } else { 1e9 }, -5.0, 11.0, 0.0).unwrap();
        assert!((step - 0.123).abs() < 1e-15, "{step}");
    }

    #[test]
    fn a_bracket_without_change_of_sign_is_refused_with_its_numbers() {
        let message = bracketed(|x| x * x + 1.0, 0.0, 2.0, 0.0).unwrap_err().to_string();
        assert!(message.contains("f(2e0) = 5e0"), "{message}");
        assert!(bracketed(|_| f64::NAN, 0.0, 2.0, 0.0).is_err());
    }
}
