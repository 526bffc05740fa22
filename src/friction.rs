//! Friction laws: which spring sticks and which slips.

/// Coulomb's law: a spring sticks while its tangential force is below `μ_f` times its normal force [S, Eq. (11)].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coulomb {
    /// Coefficient of friction `μ_f`, positive and finite.
    pub coefficient: f64,
}
