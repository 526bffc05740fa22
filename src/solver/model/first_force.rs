//! Tangential force in the first cycle.

use crate::contact::InitialContact;
use crate::error::Result;
use crate::laws::friction::FrictionLaw;
use crate::numerics::quadrature::Rule;

/// Nodes of the quadrature over the springs that slip.
const NODES: usize = 100;

/// Amplitude of the tangential force, N, on the unworn contact under the law of friction at the start.
///
/// ```text
/// F_x = 2 c_T ∫_0^a x^k min(U, μ_f(q) q/M) dx
/// ```
pub(super) fn first_force(
    contact: &InitialContact,
    friction: &dyn FrictionLaw,
    amplitude: f64,
    depth: f64,
) -> Result<f64> {
    let half_space = contact.half_space();
    let (ratio, exponent) = (half_space.stiffness_ratio(), 1.0 + half_space.grading());
    let profile = contact.equivalent_profile();
    let edge = profile.radius_at(depth)?;
    let sticking = friction.compression_at(ratio * amplitude);
    let stick = if sticking < depth { profile.radius_at(depth - sticking)? } else { 0.0 };
    let stuck = ratio * amplitude * stick.powf(exponent) / exponent;
    // In y = x^(1+k), which leaves no power of x.
    let (low, high) = (stick.powf(exponent), edge.powf(exponent));
    let rule = Rule::legendre(NODES)?;
    let strength = |part: f64| {
        let x = (low + (high - low) * part).powf(exponent.recip());
        friction.kinetic_strength(depth - profile.value(x))
    };
    let slipping = (high - low) / exponent * rule.mean(strength);
    Ok(2.0 * half_space.normal_stiffness() * (stuck + slipping))
}
