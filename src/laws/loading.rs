//! What is done to the contact: how deep it is pressed, how far it is moved to and fro, and for how long.

use serde::Serialize;

use crate::error::{Error, Result};

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
    /// Stroke `2 U` from end to end, m, at least 0.
    Stroke(f64),
    /// Amplitude of the tangential force `F_x`, N, positive: that of the first cycle, which is then held.
    Force(f64),
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
            Self::Stroke(_) => "loading.stroke",
            Self::Force(_) => "loading.tangential_force",
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

impl Duration {
    /// Smallest fraction of its first value to which the rate of worn volume can be seen to fall: below, it is the rounding of compressions that
    /// have come to nothing.
    pub const SMALLEST_RATE: f64 = 1e-14;

    /// Cycles and dimensionless time at the end; none if the rate of wear decides.
    ///
    /// # Arguments
    /// * `tau_per_cycle` -- dimensionless time of one cycle
    ///
    /// # Errors
    /// [`Error::Inconsistent`] names the key if one of the two overflows.
    pub fn span(self, tau_per_cycle: f64) -> Result<Option<[f64; 2]>> {
        let (key, value, span, name) = match self {
            Self::Cycles(cycles) => ("loading.cycles", cycles, [cycles, cycles * tau_per_cycle], "the time"),
            Self::Tau(tau) => {
                ("loading.tau", tau, [cycles_at(tau, tau_per_cycle), tau], "the number of cycles")
            }
            Self::UntilRate(_) => return Ok(None),
        };
        if span.iter().all(|it| it.is_finite()) {
            return Ok(Some(span));
        }
        let why = format!(
            "{value:e} is too large at a dimensionless time of {tau_per_cycle:e} per cycle: {name} overflows; ask for less"
        );
        Err(Error::Inconsistent { what: key, why })
    }
}

/// Cycles at a dimensionless time: of the doubles next to the quotient the one that gives this time back, if there is one.
pub fn cycles_at(tau: f64, tau_per_cycle: f64) -> f64 {
    let cycles = tau / tau_per_cycle;
    let candidates = [cycles, cycles.next_up(), cycles.next_down()];
    candidates.into_iter().find(|it| it * tau_per_cycle == tau).unwrap_or(cycles)
}

/// Times closer than this, relatively, are one: the sum of the durations of blocks and the same time written out differ by rounding.
const ONE_EVENT: f64 = 1e-12;

/// Whether an event at `time` is over at the time `now`, or one with it but for rounding.
pub fn has_come(time: f64, now: f64) -> bool {
    time <= now * (1.0 + ONE_EVENT)
}

/// Load, amplitude and end of plain tangential oscillation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loading {
    /// The normal load.
    pub load: Load,
    /// The tangential amplitude.
    pub amplitude: Amplitude,
    /// The end of the run.
    pub duration: Duration,
}

/// What decides the tangential amplitude in each cycle.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum TangentialControl {
    /// The amplitude of the displacement is as given.
    #[default]
    Displacement,
    /// The amplitude of the tangential force is held at its value in the first cycle.
    Force,
    /// The displacement given is that of the far end of a spring in series with the contact.
    Rig {
        /// Tangential stiffness, N/m, positive.
        #[serde(rename = "rig_stiffness")]
        stiffness: f64,
    },
}

impl TangentialControl {
    /// Whether a spring in series with the contact moves it.
    pub fn is_rig(self) -> bool {
        matches!(self, Self::Rig { .. })
    }
}

/// Some cycles in which amplitude and indentation are multiplied by factors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Block {
    /// How long it lasts, in cycles or as dimensionless time by [`Clock`]; positive.
    pub duration: f64,
    /// On all tangential amplitudes, at least 0.
    pub amplitude_factor: f64,
    /// On the indentation, positive.
    pub indentation_factor: f64,
}

/// The unit of the times of blocks and histories.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Clock {
    /// Cycles.
    #[default]
    Cycles,
    /// The dimensionless time `τ`.
    Tau,
}

impl Clock {
    /// How much of the unit passes in one cycle.
    ///
    /// # Arguments
    /// * `tau_per_cycle` -- dimensionless time of one cycle
    pub fn per_cycle(self, tau_per_cycle: f64) -> f64 {
        match self {
            Self::Cycles => 1.0,
            Self::Tau => tau_per_cycle,
        }
    }
}
