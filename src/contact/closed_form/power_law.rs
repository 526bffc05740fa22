//! [S, Eqs. (5), (7), (8)]: the first contact of a power law, by the general functions of the indenter.

use crate::contact::indenter::Indenter;
use crate::error::Result;

/// Profile of a power law, m [S, Eq. (5)]; `Indenter::profile` with the parameters as arguments.
///
/// ```text
/// f(r) = A r^n
/// ```
///
/// # Arguments
/// * `coefficient` -- `A`, m^(1-n), positive
/// * `exponent` -- `n`, positive
/// * `r` -- m, `r >= 0`
///
/// # Errors
/// [`Error::OutOfRange`](crate::Error::OutOfRange) names a parameter that is not positive and finite.
///
/// # Examples
/// ```
/// assert_eq!(fretwear::contact::closed_form::power_law_profile(0.5, 2.0, 3.0)?, 4.5);
/// # Ok::<(), fretwear::Error>(())
/// ```
pub fn power_law_profile(coefficient: f64, exponent: f64, r: f64) -> Result<f64> {
    Ok(Indenter::power_law(coefficient, exponent)?.profile(r))
}

/// Indentation of a power law, m, at a contact radius [S, Eq. (7)].
///
/// ```text
/// d = κ A a^n,     κ = power_law_factor(n, k)
/// ```
///
/// # Arguments
/// * `coefficient`, `exponent` -- `A`, m^(1-n), and `n`, positive
/// * `grading` -- `k`, in (-1, 1)
/// * `contact_radius` -- `a`, m
///
/// # Errors
/// [`Error::OutOfRange`](crate::Error::OutOfRange) names the argument.
///
/// # Examples
/// ```
/// // f = r²/2 on a homogeneous half-space: d = a²
/// let d = fretwear::contact::closed_form::power_law_indentation(0.5, 2.0, 0.0, 3.0)?;
/// assert!((d - 9.0).abs() < 1e-14);
/// # Ok::<(), fretwear::Error>(())
/// ```
pub fn power_law_indentation(
    coefficient: f64,
    exponent: f64,
    grading: f64,
    contact_radius: f64,
) -> Result<f64> {
    Ok(Indenter::power_law(coefficient, exponent)?.equivalent_profile(grading)?.value(contact_radius))
}

/// First contact radius of a power law, m, at an indentation [S, Eq. (8)]: the inverse of [`power_law_indentation`].
///
/// ```text
/// a0 = (d / (κ A))^(1/n)
/// ```
///
/// # Arguments
/// * `coefficient`, `exponent` -- `A`, m^(1-n), and `n`, positive
/// * `grading` -- `k`, in (-1, 1)
/// * `indentation` -- `d`, m
///
/// # Errors
/// [`Error::OutOfRange`](crate::Error::OutOfRange) names the argument.
///
/// # Examples
/// ```
/// let a = fretwear::contact::closed_form::power_law_contact_radius(0.5, 2.0, 0.0, 9.0)?;
/// assert!((a - 3.0).abs() < 1e-14);
/// # Ok::<(), fretwear::Error>(())
/// ```
pub fn power_law_contact_radius(
    coefficient: f64,
    exponent: f64,
    grading: f64,
    indentation: f64,
) -> Result<f64> {
    Indenter::power_law(coefficient, exponent)?.equivalent_profile(grading)?.radius_at(indentation)
}
