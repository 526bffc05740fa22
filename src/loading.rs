//! What is done to the contact: how deep it is pressed, how far it is moved to and fro, and for how long.

use std::sync::Arc;

/// The normal load of the first cycle; its indentation `d` is then held, unless the force is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Load {
    /// Indentation `d`, m, positive.
    Indentation(f64),
    /// Normal force `F_N` before any wear, N, positive; it falls as the contact wears.
    InitialForce(f64),
    /// Normal force `F_N`, N, positive, held in every cycle; the indentation grows as the contact wears.
    NormalForce(f64),
}

impl Load {
    /// Key of the scene that gives it.
    pub fn key(self) -> &'static str {
        match self {
            Self::Indentation(_) => "loading.indentation",
            Self::InitialForce(_) => "loading.initial_force",
            Self::NormalForce(_) => "loading.normal_force",
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

/// What the indenter does over one period, of which the tangential oscillation `u_x = U cos ωt` is a part.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Mode {
    /// Nothing else.
    #[default]
    Tangential,
    /// The indentation oscillates too, `d(t) = d + d_1 cos(m ωt/n + φ)`.
    NormalOscillation {
        /// `d_1`, m, positive, smaller than `d`.
        amplitude: f64,
        /// `m` and `n`, positive, without common divisor: `m` normal oscillations in `n` tangential ones.
        frequency_ratio: [u32; 2],
        /// `φ`, rad.
        phase: f64,
    },
    /// The indenter goes round, `u = (o_x + U cos ωt, o_y + U_y sin(ωt + φ))`.
    Orbit {
        /// `U_y`, m, positive.
        transverse_amplitude: f64,
        /// `φ`, rad; zero is an ellipse with its axes along x and y.
        phase: f64,
        /// `o_x`, `o_y`, m: the centre, seen from where the indenter is pressed on.
        centre: [f64; 2],
    },
    /// A recorded period.
    Recorded(Arc<RecordedPath>),
}

/// A period as recorded: closed, straight between its rows, starting at the first one.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedPath {
    /// Where the rows came from.
    pub source: String,
    /// Tangential displacement along x, m, seen from where the indenter is pressed on.
    pub x: Vec<f64>,
    /// The same along y, m.
    pub y: Vec<f64>,
    /// Indentation over that of the scene, m; zero throughout if the indentation is constant.
    pub indentation: Vec<f64>,
}

/// What decides the tangential amplitude in each cycle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum TangentialControl {
    /// The amplitude of the displacement is as given.
    #[default]
    Displacement,
    /// The amplitude of the tangential force is held at its value in the first cycle.
    Force,
    /// The displacement given is that of the far end of a spring in series with the contact.
    Rig {
        /// Tangential stiffness, N/m, positive.
        stiffness: f64,
    },
}

/// Some cycles in which amplitude and indentation are multiplied by factors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block {
    /// How long it lasts, in cycles or as dimensionless time by [`Clock`]; positive.
    pub duration: f64,
    /// On all tangential amplitudes, at least 0.
    pub amplitude_factor: f64,
    /// On the indentation, positive.
    pub indentation_factor: f64,
}

/// The unit of the times of blocks and histories.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Clock {
    /// Cycles.
    #[default]
    Cycles,
    /// The dimensionless time `τ`.
    Tau,
}
