//! Rigid axisymmetric indenters: profile `f(r)` and its one-dimensional equivalent `g(x)`.

/// Profile `f(r)` of a rigid indenter, `f(0) = 0`, increasing; every parameter positive and finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Indenter {
    /// `f = r²/(2R)`.
    Paraboloid {
        /// Radius of curvature `R`, m.
        radius: f64,
    },
    /// `f = R - √(R² - r²)`.
    Sphere {
        /// Radius `R`, m.
        radius: f64,
    },
    /// `f = r tan θ`.
    Cone {
        /// Slope `tan θ` of the flank against the surface.
        slope: f64,
    },
    /// `f = A r^n`.
    PowerLaw {
        /// Coefficient `A`, m^(1-n).
        coefficient: f64,
        /// Exponent `n`.
        exponent: f64,
    },
}
