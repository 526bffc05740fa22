//! [S, Eqs. (16)–(18)]: the paraboloid `f = r²/(2R)` in elementary functions.

use super::small_amplitude_wear_volume;

/// Contact radius of a paraboloid, m: part of [S, Eqs. (16)–(18)].
///
/// ```text
/// a0 = √((1+k) R d)
/// ```
///
/// # Arguments
/// * `grading` -- `k`
/// * `radius` -- `R`, m
/// * `indentation` -- `d`, m
///
/// # Examples
/// ```
/// assert_eq!(fretwear::contact::closed_form::paraboloid_contact_radius(0.0, 4.0, 1.0), 2.0);
/// ```
pub fn paraboloid_contact_radius(grading: f64, radius: f64, indentation: f64) -> f64 {
    ((1.0 + grading) * radius * indentation).sqrt()
}

/// Stick radius of a paraboloid, m: part of [S, Eqs. (16)–(18)].
///
/// ```text
/// c = √((1+k) R (d - M U/μ_f))
/// ```
///
/// # Arguments
/// * `grading` -- `k`
/// * `radius` -- `R`, m
/// * `indentation` -- `d`, m
/// * `slip_compression` -- `M U/μ_f`, m, up to `d`
///
/// # Examples
/// ```
/// assert_eq!(fretwear::contact::closed_form::paraboloid_stick_radius(0.0, 4.0, 1.0, 0.75), 1.0);
/// ```
pub fn paraboloid_stick_radius(grading: f64, radius: f64, indentation: f64, slip_compression: f64) -> f64 {
    paraboloid_contact_radius(grading, radius, indentation - slip_compression)
}

/// Small parameter of a paraboloid, [S, Eq. (13)] by its amplitude: part of [S, Eqs. (16)–(18)].
///
/// ```text
/// ε_a = (a0 - c)/c = (1 - M U/(μ_f d))^(-1/2) - 1   ≈   M U/(2 μ_f d)
/// ```
/// Without cancellation at small amplitudes; it depends on neither the radius nor, through anything but `M`, the grading.
///
/// # Arguments
/// * `indentation` -- `d`, m
/// * `slip_compression` -- `M U/μ_f`, m, below `d`
///
/// # Examples
/// ```
/// let small = fretwear::contact::closed_form::paraboloid_relative_slip_width(1.0, 1e-12);
/// assert!((small / 5e-13 - 1.0).abs() < 1e-11);
/// ```
pub fn paraboloid_relative_slip_width(indentation: f64, slip_compression: f64) -> f64 {
    (-0.5 * (-slip_compression / indentation).ln_1p()).exp_m1()
}

/// Limiting worn volume of a paraboloid, m³, to leading order in the amplitude: [S, Eq. (15)] by indentation and amplitude.
///
/// ```text
/// ΔV = 2π (1+k) R d (d - M U/μ_f) S 2^α α^μ ε_a^(1+α) / (2+μ),     μ = (1-k)/2,  α = 1+μ,  S = sin(πμ)/(πμ)
/// ```
/// The relative error is of the order of `ε_a`.
///
/// # Arguments
/// * `grading` -- `k`
/// * `radius` -- `R`, m
/// * `indentation` -- `d`, m
/// * `slip_compression` -- `M U/μ_f`, m, below `d`
///
/// # Examples
/// ```
/// use fretwear::contact::closed_form::{paraboloid_relative_slip_width, paraboloid_small_amplitude_wear_volume};
///
/// // k = 0: (16√3/5) c² d ε_a^(5/2)
/// let volume = paraboloid_small_amplitude_wear_volume(0.0, 1.0, 1.0, 1e-6);
/// let small = paraboloid_relative_slip_width(1.0, 1e-6);
/// assert!((volume / (3.2 * 3f64.sqrt() * (1.0 - 1e-6) * small.powf(2.5)) - 1.0).abs() < 1e-14);
/// ```
pub fn paraboloid_small_amplitude_wear_volume(
    grading: f64,
    radius: f64,
    indentation: f64,
    slip_compression: f64,
) -> f64 {
    let stick_radius = paraboloid_stick_radius(grading, radius, indentation, slip_compression);
    let small = paraboloid_relative_slip_width(indentation, slip_compression);
    small_amplitude_wear_volume(grading, 2.0, indentation, stick_radius, small)
}

/// Normal force on a paraboloid, N: [S, Eq. (22)] at its first contact.
///
/// ```text
/// F_N = 4 c_N d^((3+k)/2) (R (1+k))^((1+k)/2) / ((1+k)(3+k))
/// ```
///
/// # Arguments
/// * `grading` -- `k`
/// * `radius` -- `R`, m
/// * `indentation` -- `d`, m
/// * `normal_stiffness` -- `c_N`, N/m^(2+k)
///
/// # Examples
/// ```
/// // Hertz: (4/3) E* √R d^(3/2)
/// let force = fretwear::contact::closed_form::paraboloid_normal_force(0.0, 4.0, 1.0, 3.0);
/// assert!((force - 8.0).abs() < 1e-14);
/// ```
pub fn paraboloid_normal_force(grading: f64, radius: f64, indentation: f64, normal_stiffness: f64) -> f64 {
    let q = 1.0 + grading;
    4.0 * normal_stiffness * indentation.powf(1.0 + 0.5 * q) * (radius * q).powf(0.5 * q) / (q * (2.0 + q))
}
