//! Wear laws: the depth worn per slipped distance.

use crate::friction::Coulomb;

/// Archard's law: the depth worn per slipped distance is `k_w p`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Archard {
    /// Wear coefficient `k_w`, 1/Pa, positive and finite; the same number as the volume per load and distance in m³/(N m).
    ///
    /// It is the coefficient with a dimension: Archard's dimensionless one divided by the hardness.
    pub coefficient: f64,
}

impl Archard {
    /// Wear in proportion to the energy that friction dissipates there, which under Coulomb's law is Archard's law.
    ///
    /// ```text
    /// dw = α τ |ds|,     τ = μ_f p     →     k_w = α μ_f
    /// ```
    ///
    /// # Arguments
    /// * `coefficient` -- `α`, volume worn per energy dissipated, m³/J
    /// * `friction` -- the law of friction
    ///
    /// # Examples
    /// ```
    /// use fretwear::friction::Coulomb;
    /// use fretwear::wear::Archard;
    ///
    /// let law = Archard::from_dissipated_energy(2e-14, &Coulomb { coefficient: 0.5 });
    /// assert_eq!(law.coefficient, 1e-14);
    /// ```
    pub fn from_dissipated_energy(coefficient: f64, friction: &Coulomb) -> Self {
        Self { coefficient: coefficient * friction.coefficient }
    }
}
