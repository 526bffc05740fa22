//! What is done to the contact: how deep it is pressed, how far it is moved to and fro, and for how long.

/// The normal load of the first cycle; its indentation `d` is then held.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Load {
    /// Indentation `d`, m, positive.
    Indentation(f64),
    /// Normal force `F_N` before any wear, N, positive; it falls as the contact wears.
    InitialForce(f64),
}

impl Load {
    /// Key of the scene that gives it.
    pub fn key(self) -> &'static str {
        match self {
            Self::Indentation(_) => "loading.indentation",
            Self::InitialForce(_) => "loading.initial_force",
        }
    }
}

/// The amplitude of the tangential oscillation `-U..U..-U`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Amplitude {
    /// `U`, m, at least 0.
    Displacement(f64),
    /// `U/(μ_f d)`, at least 0; full sliding begins at `1/M`.
    Ratio(f64),
    /// Stick radius over contact radius `c/a0` before any wear, in (0, 1]; 1 is no slip.
    StickRatio(f64),
}

impl Amplitude {
    /// Key of the scene that gives it.
    pub fn key(self) -> &'static str {
        match self {
            Self::Displacement(_) => "loading.amplitude",
            Self::Ratio(_) => "loading.amplitude_ratio",
            Self::StickRatio(_) => "loading.stick_ratio",
        }
    }
}

/// When a run ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Duration {
    /// After this number of cycles `N`, positive, not necessarily whole.
    Cycles(f64),
    /// At the dimensionless time `τ = 4 k_w c_N a0^(k-1) (μ_f d/M) N`, positive.
    Tau(f64),
    /// When the rate of worn volume has fallen to this fraction of its first value, in (0, 1).
    UntilRate(f64),
}

/// Tangential oscillation at constant indentation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loading {
    /// The normal load.
    pub load: Load,
    /// The tangential amplitude.
    pub amplitude: Amplitude,
    /// The end of the run.
    pub duration: Duration,
}
