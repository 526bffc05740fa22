//! The paper's solution: the limiting shape of a fretted profile in closed form, the judge of every simulation.
//!
//! \[S\] is "Effect of elastic grading on fretting wear", Scientific Reports, 2019. Nothing here uses the discrete transforms of the
//! time stepping; the only tools are quadrature and root finding. Where the paper's own form subtracts nearly equal numbers at small
//! amplitudes, an equal form is evaluated in which nothing cancels.
//!
//! | equation | content | function |
//! |---|---|---|
//! | (2) | limiting equivalent profile `g∞` | [`LimitingShape::equivalent_profile`] |
//! | (3) | limiting wear depth `Δf(r)` | [`LimitingShape::wear_depth`] |
//! | (4) | limiting worn volume `ΔV` | [`LimitingShape::wear_volume`] |
//! | (5), (6) | power law, its factor `κ` | [`Indenter::power_law`](crate::indenter::Indenter::power_law), [`power_law_factor`](crate::indenter::power_law_factor) |
//! | (7), (8) | indentation and contact radius | [`EquivalentProfile::value`], [`EquivalentProfile::radius_at`] |
//! | (11) | edge of stick `g0(c) = d - M U/μ_f` | [`slip_compression`], [`stick_radius`] |
//! | (12) | `M` under elastic similarity | [`similar_stiffness_ratio`] |
//! | (13)–(15) | small amplitudes | [`relative_slip_width`], [`relative_limit_width`], [`small_amplitude_wear_volume`] |
//! | (16)–(18) | paraboloid | [`paraboloid_contact_radius`], [`paraboloid_stick_radius`] |
//! | (19) | equivalent profile `g` | [`Indenter::equivalent_profile`](crate::indenter::Indenter::equivalent_profile) |
//! | (22) | normal force | [`EquivalentProfile::load_integral`] |

mod limiting_shape;
mod wear_integral;

pub use limiting_shape::LimitingShape;

use crate::error::Result;
use crate::indenter::EquivalentProfile;

/// What tangential oscillation does to the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// No spring slips: the amplitude is zero.
    Stick,
    /// The springs beyond the stick radius slip.
    PartialSlip,
    /// Every spring slips; there is no limiting shape.
    FullSliding,
}

impl Regime {
    /// Regime of an indentation `d` and a [`slip_compression`] `q_c`, m: full sliding from `q_c = d` on.
    pub fn new(indentation: f64, slip_compression: f64) -> Self {
        if slip_compression >= indentation {
            Self::FullSliding
        } else if slip_compression > 0.0 {
            Self::PartialSlip
        } else {
            Self::Stick
        }
    }
}

/// Compression `q_c` of the springs at the edge of stick, m [S, Eq. (11)].
///
/// ```text
/// q_c = M U / μ_f = d - g0(c)
/// ```
///
/// # Arguments
/// * `stiffness_ratio` -- `M`
/// * `amplitude` -- `U`, m
/// * `friction_coefficient` -- `μ_f`
pub fn slip_compression(stiffness_ratio: f64, amplitude: f64, friction_coefficient: f64) -> f64 {
    stiffness_ratio * amplitude / friction_coefficient
}

/// Stick radius `c`, m, the root of `g0(c) = d - q_c` [S, Eq. (11)].
///
/// # Arguments
/// * `profile` -- equivalent profile `g0`
/// * `indentation` -- `d`, m
/// * `slip_compression` -- `q_c`, m, from 0 to `d`
///
/// # Errors
/// [`Error::Inconsistent`](crate::Error::Inconsistent) if a sphere would sink in to its equator.
pub fn stick_radius(profile: &EquivalentProfile, indentation: f64, slip_compression: f64) -> Result<f64> {
    profile.radius_at(indentation - slip_compression)
}

/// Tangential amplitude, m, from which on the whole contact slides: [S, Eq. (11)] with `g0(c) = 0`.
///
/// ```text
/// u_max = μ_f d / M
/// ```
pub fn full_sliding_amplitude(stiffness_ratio: f64, friction_coefficient: f64, indentation: f64) -> f64 {
    friction_coefficient * indentation / stiffness_ratio
}

/// Ratio of tangential to normal stiffness of a half-space elastically similar to a rigid indenter [S, Eq. (12)].
///
/// ```text
/// M = 2 / ((1+k)(3+k)),     Poisson's ratio 1/(2+k)
/// ```
///
/// # Examples
/// ```
/// assert!((fretwear::closed_form::similar_stiffness_ratio(0.0) - 2.0 / 3.0).abs() < 1e-15);
/// ```
pub fn similar_stiffness_ratio(grading: f64) -> f64 {
    2.0 / ((1.0 + grading) * (3.0 + grading))
}

/// Width of the first slip annulus relative to the stick radius: the small parameter of [S, Eqs. (13)–(15)].
///
/// ```text
/// ε_a = (a0 - c) / c
/// ```
///
/// # Arguments
/// * `slip_width` -- `a0 - c`, m; passed as a difference so that its digits survive
/// * `stick_radius` -- `c`, m
pub fn relative_slip_width(slip_width: f64, stick_radius: f64) -> f64 {
    slip_width / stick_radius
}

/// Width of the limiting annulus relative to the stick radius, to first order in the amplitude [S, Eq. (14)].
///
/// ```text
/// ε = (a∞ - c) / c = ((3-k)/2) ε_a
/// ```
///
/// # Examples
/// ```
/// assert_eq!(fretwear::closed_form::relative_limit_width(0.5, 0.01), 0.0125);
/// ```
pub fn relative_limit_width(grading: f64, relative_slip_width: f64) -> f64 {
    0.5 * (3.0 - grading) * relative_slip_width
}

/// Limiting worn volume `ΔV`, m³, to leading order in the amplitude [S, Eq. (15)].
///
/// ```text
/// ΔV = π c² d n S 2^α α^μ ε_a^(1+α) / (2+μ),     μ = (1-k)/2,  α = 1+μ,  S = sin(πμ)/(πμ)
/// ```
/// with `n = a0 g0'(a0)/d`, which is the exponent of a power law. The relative error is of the order of `ε_a`.
///
/// # Arguments
/// * `grading` -- `k`
/// * `exponent` -- `n`
/// * `indentation`, `stick_radius` -- `d`, `c`, m
/// * `relative_slip_width` -- `ε_a`
///
/// # Examples
/// ```
/// use fretwear::closed_form::small_amplitude_wear_volume;
///
/// // paraboloid on a homogeneous half-space: ΔV = (16√3/5) c² d ε_a^(5/2)
/// let volume = small_amplitude_wear_volume(0.0, 2.0, 1.0, 1.0, 1e-4);
/// assert!((volume / (3.2 * 3f64.sqrt() * 1e-10) - 1.0).abs() < 1e-14);
/// ```
pub fn small_amplitude_wear_volume(
    grading: f64,
    exponent: f64,
    indentation: f64,
    stick_radius: f64,
    relative_slip_width: f64,
) -> f64 {
    let mu = 0.5 * (1.0 - grading);
    let alpha = 1.0 + mu;
    let leading =
        wear_integral::transform_factor(grading) * exponent * 2f64.powf(alpha) * alpha.powf(mu) / (2.0 + mu);
    std::f64::consts::PI
        * stick_radius
        * stick_radius
        * indentation
        * leading
        * relative_slip_width.powf(1.0 + alpha)
}

/// Contact radius of a paraboloid, m: part of [S, Eqs. (16)–(18)].
///
/// ```text
/// a0 = √((1+k) R d)
/// ```
pub fn paraboloid_contact_radius(grading: f64, radius: f64, indentation: f64) -> f64 {
    ((1.0 + grading) * radius * indentation).sqrt()
}

/// Stick radius of a paraboloid, m: part of [S, Eqs. (16)–(18)].
///
/// ```text
/// c = √((1+k) R (d - M U/μ_f))
/// ```
pub fn paraboloid_stick_radius(grading: f64, radius: f64, indentation: f64, slip_compression: f64) -> f64 {
    paraboloid_contact_radius(grading, radius, indentation - slip_compression)
}
