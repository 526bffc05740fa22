//! Wear laws: the depth worn per slipped distance.

use serde::Serialize;

use crate::laws::friction::Coulomb;

/// Archard's law: the depth worn per slipped distance is `k_w p`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
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
    /// use fretwear::laws::friction::Coulomb;
    /// use fretwear::laws::wear::Archard;
    ///
    /// let law = Archard::from_dissipated_energy(2e-14, &Coulomb { coefficient: 0.5 });
    /// assert_eq!(law.coefficient, 1e-14);
    /// ```
    pub fn from_dissipated_energy(coefficient: f64, friction: &Coulomb) -> Self {
        Self { coefficient: coefficient * friction.coefficient }
    }
}

/// A law of wear, every number positive and finite; `p` is the pressure, `s` the slip, both on the surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "law", rename_all = "kebab-case")]
pub enum WearLaw {
    /// `dw = k_w p |ds|`.
    Archard(Archard),
    /// `dw = α τ |ds|`, with the frictional traction `τ`.
    DissipatedEnergy {
        /// `α`, m³/J.
        coefficient: f64,
    },
    /// `dw = k ℓ^(β-1) p^α |ds|`, with the slip path `ℓ = ∮|ds|` of the cycle: `k p^α (4s)^β` a cycle for plain tangential oscillation.
    PowerLaw {
        /// `k`, Pa^(-α) m^(1-β).
        coefficient: f64,
        /// `α`.
        pressure_exponent: f64,
        /// `β`.
        slip_exponent: f64,
    },
    /// `dw = k_w (p - p_0)₊ |ds|`: no wear below a pressure. It leaves the paper's assumptions and its limit.
    Threshold {
        /// `k_w`, 1/Pa.
        coefficient: f64,
        /// `p_0`, Pa.
        pressure: f64,
    },
    /// `dw = k_w p̄ |ds|` with the pressure averaged over a length, as debris that does not leave would: not local. It leaves the paper's
    /// assumptions and its limit.
    NonLocal {
        /// `k_w`, 1/Pa.
        coefficient: f64,
        /// Standard deviation of the Gaussian average along the radius, m.
        length: f64,
    },
}

impl WearLaw {
    /// The law with its coefficient times `factor`.
    pub fn scaled(&self, factor: f64) -> Self {
        let mut law = *self;
        match &mut law {
            Self::Archard(Archard { coefficient })
            | Self::DissipatedEnergy { coefficient }
            | Self::PowerLaw { coefficient, .. }
            | Self::Threshold { coefficient, .. }
            | Self::NonLocal { coefficient, .. } => *coefficient *= factor,
        }
        law
    }
}
