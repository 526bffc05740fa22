//! The equivalent profile of a sphere, a hypergeometric function, by a quadrature whose terms are all positive.

use crate::error::Result;
use crate::numerics::quadrature::Rule;
use std::sync::OnceLock;

/// Node counts, and the largest argument `z = x²/R²` at which each reaches round-off.
///
/// The integrands are analytic but for a singularity at `u = -(1-z)/z`, so the error of `n` nodes falls as `ρ^(-2n)`,
/// `ρ = 1 + 2δ + 2√(δ+δ²)`, `δ = (1-z)/z`.
const LEVELS: [(usize, f64); 3] = [(18, 0.6), (48, 0.93), (200, SphereIntegral::LARGEST_ARGUMENT)];

/// Newton steps for an inverse; the iteration is monotone and takes five to ten.
const MAX_NEWTON_STEPS: usize = 100;

/// Integral behind the equivalent profile of a sphere [S, Eq. (19)], as a function of `z = x²/R²`, with `ν = (1+k)/2`.
///
/// ```text
/// g(x) = R/(1+k) h(x²/R²),     h(z) = z ν ∫_0^1 (1-z+zu)^(-1/2) u^(ν-1) du  =  z 2F1(1/2, 1; 1+ν; z)
/// ```
/// The divided difference of `h` between `y` and `z` is the same integral over `K = (1/(pq) + 1)/(p+q)`, `p² = 1-y+yu`,
/// `q² = 1-z+zu`, and by parts `1 + ∫ u^ν (-dK/du) du`, in which every term is positive and the weight is benign for every `k`.
#[derive(Debug, Clone)]
pub(super) struct SphereIntegral {
    /// `ν = (1+k)/2`.
    nu: f64,
    first_rule: Rule,
    /// Rules for arguments closer to one; rarely needed and dear.
    later_rules: [OnceLock<Rule>; 2],
}

impl SphereIntegral {
    /// `x = 0.999 R`.
    pub(super) const LARGEST_ARGUMENT: f64 = 0.998001;

    pub(super) fn new(grading: f64) -> Result<Self> {
        let nu = 0.5 * (1.0 + grading);
        Ok(Self {
            nu,
            first_rule: Rule::jacobi(LEVELS[0].0, 0.0, nu)?,
            later_rules: [OnceLock::new(), OnceLock::new()],
        })
    }

    fn rule(&self, argument: f64) -> &Rule {
        let level = LEVELS.iter().position(|&(_, largest)| argument <= largest).unwrap_or(LEVELS.len() - 1);
        match level {
            0 => &self.first_rule,
            _ => self.later_rules[level - 1].get_or_init(|| {
                Rule::jacobi(LEVELS[level].0, 0.0, self.nu)
                    .expect("the exponents were accepted for the first rule")
            }),
        }
    }

    /// Divided difference `(h(z) - h(y)) / (z - y)`, the derivative where they agree; `0 <= y, z < 1`.
    pub(super) fn mean_slope(&self, y: f64, z: f64) -> f64 {
        let rule = self.rule(y.max(z));
        let excess: f64 = rule.nodes.iter().zip(&rule.weights).fold(0.0, |sum, (&u, &weight)| {
            let (p_squared, q_squared) = ((1.0 - y) + y * u, (1.0 - z) + z * u);
            let (p, q) = (p_squared.sqrt(), q_squared.sqrt());
            let inverse_sum = 1.0 / (p + q);
            let inverse_product = 1.0 / (p * q);
            let product_part = inverse_product * 0.5 * (y / p_squared + z / q_squared) * inverse_sum;
            let sum_part = (inverse_product + 1.0) * 0.5 * (y / p + z / q) * inverse_sum * inverse_sum;
            sum + weight * (product_part + sum_part)
        });
        1.0 + excess / (1.0 + self.nu)
    }

    /// Load of the contact radius `√z R` over that radius to the power `3+k`, times `R(1+k)`.
    ///
    /// ```text
    /// ∫_0^1 v u^(ν-1) (1-zv)^(-1/2) du = (1/ν) ∫_0^1 u^ν [(1-zv)^(-1/2) + (v z/2)(1-zv)^(-3/2)] du,     v = 1-u
    /// ```
    pub(super) fn load(&self, z: f64) -> f64 {
        let rule = self.rule(z);
        let mean: f64 = rule.nodes.iter().zip(rule.complements.iter().zip(&rule.weights)).fold(
            0.0,
            |sum, (&u, (&v, &weight))| {
                let squared = (1.0 - z) + z * u;
                sum + weight * (1.0 + 0.5 * v * z / squared) / squared.sqrt()
            },
        );
        mean / (self.nu * (1.0 + self.nu))
    }

    /// `z` with `h(z) = value`; none if that lies beyond the largest argument.
    pub(super) fn argument_at(&self, value: f64) -> Option<f64> {
        // h is convex and at least z: from the right Newton's method descends to the root without passing it.
        let mut z = value.min(Self::LARGEST_ARGUMENT);
        if z * self.mean_slope(0.0, z) < value {
            return None;
        }
        for _ in 0..MAX_NEWTON_STEPS {
            let step = (z * self.mean_slope(0.0, z) - value) / self.mean_slope(z, z);
            z -= step;
            if step.abs() <= 2.0 * f64::EPSILON * z {
                break;
            }
        }
        Some(z)
    }

    /// `y >= 0` with `h(z) - h(z-y) = drop`, to full relative accuracy for small drops.
    pub(super) fn argument_drop(&self, z: f64, drop: f64) -> f64 {
        // The difference is concave in y: from zero Newton's method climbs to the root without passing it.
        let mut y = 0.0;
        for _ in 0..MAX_NEWTON_STEPS {
            let step = (drop - y * self.mean_slope(z - y, z)) / self.mean_slope(z - y, z - y);
            y = (y + step).min(z);
            if step.abs() <= 2.0 * f64::EPSILON * y {
                break;
            }
        }
        y
    }
}
