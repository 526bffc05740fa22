//! Friction laws: which spring sticks and which slips, and how hard it is held.

use serde::Serialize;

/// Coulomb's law: a spring sticks while its tangential force is below `μ_f` times its normal force [S, Eq. (11)].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Coulomb {
    /// Coefficient of friction `μ_f`, positive and finite.
    pub coefficient: f64,
}

/// A law of friction of single springs, every number positive and finite unless it says otherwise.
///
/// Only Coulomb's law is exact in the method of dimensionality reduction. The others are laws of the one-dimensional model: they hold for
/// its springs, not point by point for the surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(tag = "law", rename_all = "kebab-case")]
pub enum FrictionLaw {
    /// One coefficient.
    Coulomb(Coulomb),
    /// A spring that sticks begins to slip at `μ_s q`; then `μ_k q` holds it until its slip reverses.
    StaticKinetic {
        /// `μ_s`, at least `μ_k`.
        static_coefficient: f64,
        /// `μ_k`.
        kinetic_coefficient: f64,
    },
    /// `μ_f(q) = μ_0 (q/q_0)^m` of a spring of compression `q`.
    LoadDependent {
        /// `μ_0`.
        coefficient: f64,
        /// `m > -1`, of either sign: then `μ_f(q) q` increases, without which no spring sticks inside one that slips.
        exponent: f64,
        /// `q_0`, m.
        #[serde(rename = "reference_compression")]
        reference: f64,
    },
}

impl FrictionLaw {
    /// Coulomb's law that stands for this one in the closed form, the limits of the regimes and the dimensionless time: that of the spring
    /// at rest, and of the compression of reference.
    pub fn reference(&self) -> Coulomb {
        match *self {
            Self::Coulomb(law) => law,
            Self::StaticKinetic { static_coefficient, .. } => Coulomb { coefficient: static_coefficient },
            Self::LoadDependent { coefficient, .. } => Coulomb { coefficient },
        }
    }

    /// What a spring of compression `q`, m, that sticks can bear at most, over its normal stiffness: `μ_s(q) q`, m; zero without contact.
    ///
    /// ```
    /// use fretwear::laws::friction::FrictionLaw;
    ///
    /// let law = FrictionLaw::LoadDependent { coefficient: 0.5, exponent: -0.5, reference: 4.0 };
    /// assert_eq!(law.static_strength(1.0), 1.0); // μ_f = 0.5 · (1/4)^(-1/2)
    /// assert_eq!(law.static_strength(-1.0), 0.0);
    /// ```
    pub fn static_strength(&self, compression: f64) -> f64 {
        match *self {
            Self::StaticKinetic { static_coefficient, .. } => static_coefficient * compression.max(0.0),
            _ => self.kinetic_strength(compression),
        }
    }

    /// What holds a spring of compression `q`, m, while it slips, over its normal stiffness: `μ_k(q) q`, m; zero without contact.
    pub fn kinetic_strength(&self, compression: f64) -> f64 {
        let q = compression.max(0.0);
        match *self {
            Self::Coulomb(Coulomb { coefficient }) => coefficient * q,
            Self::StaticKinetic { kinetic_coefficient, .. } => kinetic_coefficient * q,
            Self::LoadDependent { coefficient, exponent, reference } => {
                coefficient * reference * (q / reference).powf(1.0 + exponent)
            }
        }
    }

    /// Derivative of [`FrictionLaw::kinetic_strength`] by the compression; zero without contact.
    ///
    /// At `q = 0` it is infinite for a negative exponent of the load.
    pub fn kinetic_strength_slope(&self, compression: f64) -> f64 {
        if compression < 0.0 {
            return 0.0;
        }
        match *self {
            Self::Coulomb(Coulomb { coefficient }) => coefficient,
            Self::StaticKinetic { kinetic_coefficient, .. } => kinetic_coefficient,
            Self::LoadDependent { coefficient, exponent, reference } => {
                coefficient * (1.0 + exponent) * (compression / reference).powf(exponent)
            }
        }
    }

    /// Static over kinetic strength, at least one, the same at every compression.
    pub fn static_factor(&self) -> f64 {
        match *self {
            Self::StaticKinetic { static_coefficient, kinetic_coefficient } => {
                static_coefficient / kinetic_coefficient
            }
            _ => 1.0,
        }
    }

    /// Compression, m, at which a spring that sticks bears `strength`, m: the inverse of [`FrictionLaw::static_strength`].
    pub fn compression_at(&self, strength: f64) -> f64 {
        match *self {
            Self::Coulomb(Coulomb { coefficient }) => strength / coefficient,
            Self::StaticKinetic { static_coefficient, .. } => strength / static_coefficient,
            Self::LoadDependent { coefficient, exponent, reference } => {
                reference * (strength / (coefficient * reference)).powf((1.0 + exponent).recip())
            }
        }
    }

    /// The law with its coefficients times `factor`.
    pub fn scaled(&self, factor: f64) -> Self {
        match *self {
            Self::Coulomb(Coulomb { coefficient }) => {
                Self::Coulomb(Coulomb { coefficient: factor * coefficient })
            }
            Self::StaticKinetic { static_coefficient, kinetic_coefficient } => Self::StaticKinetic {
                static_coefficient: factor * static_coefficient,
                kinetic_coefficient: factor * kinetic_coefficient,
            },
            Self::LoadDependent { coefficient, exponent, reference } => {
                Self::LoadDependent { coefficient: factor * coefficient, exponent, reference }
            }
        }
    }
}
