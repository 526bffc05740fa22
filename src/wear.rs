//! Wear laws: the depth worn per slipped distance.

/// Archard's law: the depth worn per slipped distance is `k_w p`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Archard {
    /// Wear coefficient `k_w`, 1/Pa, positive and finite; the same number as the volume per load and distance in m³/(N m).
    ///
    /// It is the coefficient with a dimension: Archard's dimensionless one divided by the hardness.
    pub coefficient: f64,
}
