//! The paper's solution: the limiting shape of a fretted profile in closed form, the reference of every simulation.
//!
//! \[S\] is "Effect of elastic grading on fretting wear", Scientific Reports, 2019. Nothing here uses the discrete transforms of the
//! time stepping; the only tools are quadrature and root finding. Where the paper's own form subtracts nearly equal numbers at small
//! amplitudes, an equal form is evaluated in which nothing cancels.
//!
//! | equation | content | function |
//! |---|---|---|
//! | (1) | grading `E = E0 (z/z0)^k` | [`modulus_at_depth`](crate::contact::half_space::modulus_at_depth) |
//! | (2) | limiting equivalent profile `g∞` | [`LimitingShape::equivalent_profile`] |
//! | (3) | limiting wear depth `Δf(r)` | [`LimitingShape::wear_depth`] |
//! | (4) | limiting worn volume `ΔV` | [`LimitingShape::wear_volume`] |
//! | (5) | power law `f = A r^n` | [`power_law_profile`] |
//! | (6) | its factor `κ` | [`power_law_factor`](crate::contact::indenter::power_law_factor) |
//! | (7) | indentation `d = κ A a^n` | [`power_law_indentation`] |
//! | (8) | contact radius | [`power_law_contact_radius`] |
//! | (9) | limiting wear depth of a power law, by series | [`HypergeometricLimit::wear_depth`] |
//! | (10) | Gauss's hypergeometric function | [`gauss_hypergeometric`] |
//! | (11) | edge of stick `g0(c) = d - M U/μ_f` | [`slip_compression`], [`stick_radius`] |
//! | (12) | `M` under elastic similarity | [`similar_stiffness_ratio`] |
//! | (13) | small parameter `ε_a` | [`relative_slip_width`] |
//! | (14) | width of the limiting annulus at small amplitudes | [`relative_limit_width`] |
//! | (15) | worn volume at small amplitudes | [`small_amplitude_wear_volume`] |
//! | (16)–(18) | paraboloid | [`paraboloid_contact_radius`], [`paraboloid_stick_radius`], [`paraboloid_relative_slip_width`], [`paraboloid_small_amplitude_wear_volume`] |
//! | (19) | equivalent profile `g` | [`Indenter::equivalent_profile`](crate::contact::indenter::Indenter::equivalent_profile) |
//! | (22) | normal force | `EquivalentProfile::load_integral`, [`paraboloid_normal_force`] |
//!
//! Equations (19)–(22) for any profile are in [`transforms`](crate::contact::transforms).

mod gibson;
mod hypergeometric;
mod limiting_shape;
mod paraboloid;
mod power_law;
mod table_wear;
mod wear_integral;
mod wear_volume;

pub use gibson::GibsonTransient;
pub use hypergeometric::{Claimed, HypergeometricLimit, gauss_hypergeometric};
pub use limiting_shape::LimitingShape;
pub use paraboloid::{
    paraboloid_contact_radius, paraboloid_normal_force, paraboloid_relative_slip_width,
    paraboloid_small_amplitude_wear_volume, paraboloid_stick_radius,
};
pub use power_law::{power_law_contact_radius, power_law_indentation, power_law_profile};
pub use wear_volume::{PowerLawVolume, gibson_wear_volume};

pub use crate::contact::half_space::similar_stiffness_ratio;
pub use crate::contact::stick_slip::{Regime, full_sliding_amplitude, slip_compression, stick_radius};

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
/// assert_eq!(fretwear::contact::closed_form::relative_limit_width(0.5, 0.01), 0.0125);
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
/// use fretwear::contact::closed_form::small_amplitude_wear_volume;
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
