//! Which springs stick and which slip under tangential oscillation.

use crate::contact::indenter::EquivalentProfile;
use crate::error::Result;
use crate::laws::friction::FrictionLaw;

/// What tangential oscillation does to the contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Regime {
    /// No spring slips: the amplitude is zero.
    Stick,
    /// The springs beyond the stick radius slip.
    #[default]
    PartialSlip,
    /// Every spring slips; there is no limiting shape.
    FullSliding,
}

impl Regime {
    /// All regimes, by growing slip; each at the place of its own number.
    pub const ALL: [Self; 3] = [Self::Stick, Self::PartialSlip, Self::FullSliding];

    /// Regime of an indentation `d` and a [`slip_compression`] `q_c`, m: full sliding from `q_c = d` on.
    pub fn new(indentation: f64, slip_compression: f64) -> Self {
        if slip_compression >= indentation {
            Self::FullSliding
        } else if slip_compression > 0.0 {
            Self::PartialSlip
        } else {
            Self::Stick
        }
    }

    /// Name in files and JSON: `stick`, `partial-slip` or `full-sliding`.
    ///
    /// ```
    /// assert_eq!(fretwear::contact::stick_slip::Regime::new(1e-6, 2e-6).name(), "full-sliding");
    /// ```
    pub fn name(self) -> &'static str {
        match self {
            Self::Stick => "stick",
            Self::PartialSlip => "partial-slip",
            Self::FullSliding => "full-sliding",
        }
    }
}

/// Fretting regime of a run: which of the conditions of [`Regime`] its cycles have been in so far [Zhou, Vincent, Wear 181-183 (1995) 531].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrettingRegime {
    /// No spring has slipped.
    Stick,
    /// No cycle was in gross slip.
    PartialSlip,
    /// Some cycles were in gross slip, and some were not.
    Mixed,
    /// All cycles were in gross slip.
    FullSliding,
}

impl FrettingRegime {
    /// All of them, by growing slip; each at the place of its own number.
    pub const ALL: [Self; 4] = [Self::Stick, Self::PartialSlip, Self::Mixed, Self::FullSliding];

    /// After one more cycle.
    ///
    /// # Arguments
    /// * `before` -- up to then; none before the first cycle
    /// * `cycle` -- what this cycle does
    /// * `slid` -- whether a cycle so far was in gross slip
    pub fn after(before: Option<Self>, cycle: Regime, slid: bool) -> Self {
        match (cycle, before) {
            (Regime::FullSliding, None | Some(Self::FullSliding)) => Self::FullSliding,
            (Regime::FullSliding, _) | (_, Some(Self::Mixed | Self::FullSliding)) => Self::Mixed,
            _ if slid => Self::Mixed,
            (Regime::Stick, None | Some(Self::Stick)) => Self::Stick,
            _ => Self::PartialSlip,
        }
    }

    /// Name in files and JSON: `stick`, `partial-slip`, `mixed` or `full-sliding`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stick => Regime::Stick.name(),
            Self::PartialSlip => Regime::PartialSlip.name(),
            Self::Mixed => "mixed",
            Self::FullSliding => Regime::FullSliding.name(),
        }
    }
}

/// Compression `q_c` of the springs at the edge of stick, m [S, Eq. (11)].
///
/// ```text
/// q_c = M U / μ_f = d - g0(c)
/// ```
///
/// # Arguments
/// * `stiffness_ratio` -- `M`
/// * `amplitude` -- `U`, m
/// * `friction_coefficient` -- `μ_f`
pub fn slip_compression(stiffness_ratio: f64, amplitude: f64, friction_coefficient: f64) -> f64 {
    stiffness_ratio * amplitude / friction_coefficient
}

/// Tangential amplitude, m, at which the springs of compression `q_c` are at the edge of stick: the inverse of [`slip_compression`].
///
/// ```text
/// U = μ_f q_c / M
/// ```
pub fn slip_amplitude(stiffness_ratio: f64, friction_coefficient: f64, slip_compression: f64) -> f64 {
    friction_coefficient * slip_compression / stiffness_ratio
}

/// Tangential amplitude, m, from which on the whole contact slides: [S, Eq. (11)] with `g0(c) = 0`.
///
/// ```text
/// u_max = μ_f d / M
/// ```
pub fn full_sliding_amplitude(stiffness_ratio: f64, friction_coefficient: f64, indentation: f64) -> f64 {
    slip_amplitude(stiffness_ratio, friction_coefficient, indentation)
}

/// Stick radius `c`, m, the root of `g0(c) = d - q_c` [S, Eq. (11)].
///
/// ```
/// use fretwear::{Indenter, stick_radius};
/// let g0 = Indenter::paraboloid(10e-3)?.equivalent_profile(0.0)?; // r²/(2R) becomes x²/R
/// let c = stick_radius(&g0, 1e-6, 0.51e-6)?;
/// assert!((c - 70e-6).abs() < 1e-15);
/// # Ok::<(), fretwear::Error>(())
/// ```
///
/// # Arguments
/// * `profile` -- equivalent profile `g0`
/// * `indentation` -- `d`, m
/// * `slip_compression` -- `q_c`, m, from 0 to `d`
///
/// # Errors
/// [`Error::Inconsistent`](crate::Error::Inconsistent) if a sphere would sink in to its equator.
pub fn stick_radius(profile: &EquivalentProfile, indentation: f64, slip_compression: f64) -> Result<f64> {
    profile.radius_at(indentation - slip_compression)
}

/// `η = ln(a0/c)`, from whichever of `c` and `a0² - c²` is known without cancellation.
///
/// From it follow `c = a0 e^(-η)` and `a0² - c² = -a0² (e^(-2η) - 1)`, both to full relative accuracy.
///
/// # Arguments
/// * `profile` -- equivalent profile `g0`
/// * `indentation` -- `d = g0(a0)`, m
/// * `contact_radius` -- `a0`, m
/// * `slip_compression` -- `q_c`, m, from 0 to `d`
///
/// # Errors
/// As [`stick_radius`].
pub fn stick_logarithm(
    profile: &EquivalentProfile,
    indentation: f64,
    contact_radius: f64,
    slip_compression: f64,
) -> Result<f64> {
    let direct = || Ok((contact_radius / stick_radius(profile, indentation, slip_compression)?).ln());
    if slip_compression > 0.5 * indentation {
        return direct();
    }
    let drop = profile.radius_squared_drop(contact_radius, slip_compression);
    let fraction = drop / (contact_radius * contact_radius);
    // A pointed profile (n << 1) loses nearly all of its radius well before half of the indentation.
    if fraction > 0.5 { direct() } else { Ok(-0.5 * (-fraction).ln_1p()) }
}

/// Slip amplitude `σ` of one spring under tangential oscillation at constant indentation, m, and its derivative by the compression.
///
/// ```text
/// σ = U - μ_k(q) q/M  if  M U > μ_s(q) q,  else 0
/// ```
///
/// A period slips `4σ`. The spring was pressed on in the middle of the oscillation, so one that never reached its static limit sticks, and
/// with static and kinetic friction `σ` jumps where it does. The derivative is that on the side of the spring; it is infinite at `q = 0` for
/// friction whose coefficient falls with the load.
///
/// # Arguments
/// * `law` -- friction of the spring
/// * `stiffness_ratio` -- `M`
/// * `amplitude` -- `U`, m
/// * `compression` -- `q`, m; without contact the slip is `U`
///
/// ```
/// use fretwear::laws::friction::Coulomb;
/// use fretwear::contact::stick_slip::slip_amplitude_of_spring;
///
/// let law = Coulomb { coefficient: 0.5 };
/// assert_eq!(slip_amplitude_of_spring(&law, 2.0, 3.0, 4.0), (2.0, -0.25));
/// assert_eq!(slip_amplitude_of_spring(&law, 2.0, 3.0, 12.0), (0.0, 0.0));
/// ```
pub fn slip_amplitude_of_spring(
    law: &dyn FrictionLaw,
    stiffness_ratio: f64,
    amplitude: f64,
    compression: f64,
) -> (f64, f64) {
    if stiffness_ratio * amplitude > law.static_strength(compression) {
        sliding_amplitude(law, stiffness_ratio, amplitude, compression)
    } else {
        (0.0, 0.0)
    }
}

/// [`slip_amplitude_of_spring`] of one that does slip, whatever it is held by while it sticks.
pub fn sliding_amplitude(
    law: &dyn FrictionLaw,
    stiffness_ratio: f64,
    amplitude: f64,
    compression: f64,
) -> (f64, f64) {
    let value = amplitude - law.kinetic_strength(compression) / stiffness_ratio;
    (value, -law.kinetic_strength_slope(compression) / stiffness_ratio)
}
