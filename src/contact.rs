//! The unworn contact that a scene describes: how deep, how wide, how hard, and what of it slips.

use std::f64::consts::PI;

use crate::error::{Error, Result};
use crate::friction::Coulomb;
use crate::half_space::HalfSpace;
use crate::indenter::{EquivalentProfile, Indenter};
use crate::loading::{Amplitude, Load, Loading};
use crate::stick_slip::{
    Regime, full_sliding_amplitude, slip_amplitude, slip_compression, stick_logarithm,
};
use crate::wear::Archard;

/// The contact before any wear; every quantity is finite.
///
/// # Examples
/// ```
/// use fretwear::contact::InitialContact;
/// use fretwear::friction::Coulomb;
/// use fretwear::half_space::HalfSpace;
/// use fretwear::indenter::Indenter;
/// use fretwear::loading::{Amplitude, Duration, Load, Loading};
/// use fretwear::wear::Archard;
///
/// // k = 0: a0 = √(R d), F_N = (4/3) c_N √R d^(3/2) (Hertz)
/// let contact = InitialContact::new(
///     &Indenter::paraboloid(4.0)?,
///     &HalfSpace::from_stiffness(0.0, 3e9, 0.8)?,
///     &Coulomb { coefficient: 0.5 },
///     &Archard { coefficient: 1e-14 },
///     &Loading {
///         load: Load::Indentation(0.01),
///         amplitude: Amplitude::StickRatio(0.5),
///         duration: Duration::Tau(30.0),
///     },
/// )?;
/// assert!((contact.contact_radius() - 0.2).abs() < 1e-15);
/// assert!((contact.normal_force() / 8e6 - 1.0).abs() < 1e-14);
/// assert!((contact.slip_compression() - 0.0075).abs() < 1e-16);
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct InitialContact {
    indenter: Indenter,
    half_space: HalfSpace,
    friction: Coulomb,
    wear: Archard,
    equivalent_profile: EquivalentProfile,
    indentation: f64,
    contact_radius: f64,
    normal_force: f64,
    amplitude: f64,
    slip_compression: f64,
    /// `η = ln(a0/c)`; none under full sliding.
    stick_logarithm: Option<f64>,
    tau_per_cycle: f64,
}

impl InitialContact {
    /// Forms the contact.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the key of the scene; [`Error::Inconsistent`] if a sphere would sink in to its equator, or names the
    /// quantity that values each allowed make too large or too small for a double.
    pub fn new(
        indenter: &Indenter,
        half_space: &HalfSpace,
        friction: &Coulomb,
        wear: &Archard,
        loading: &Loading,
    ) -> Result<Self> {
        positive("friction.coulomb.coefficient", friction.coefficient)?;
        positive("wear.archard.coefficient", wear.coefficient)?;
        let profile = indenter.equivalent_profile(half_space.grading())?;
        let Press { indentation, contact_radius, normal_force } =
            Press::new(&profile, half_space.normal_stiffness(), loading.load)?;
        representable("mean pressure, Pa", normal_force / (PI * contact_radius * contact_radius))?;

        let stiffness_ratio = half_space.stiffness_ratio();
        let sliding = full_sliding_amplitude(stiffness_ratio, friction.coefficient, indentation);
        representable("amplitude of full sliding μ_f d/M, m", sliding)?;
        let slip = Slip::new(
            &profile,
            indentation,
            contact_radius,
            stiffness_ratio,
            friction.coefficient,
            loading.amplitude,
        )?;

        let radial = contact_radius.powf(half_space.grading() - 1.0);
        let tau_per_cycle =
            4.0 * (wear.coefficient * half_space.normal_stiffness()) * (radial * sliding);
        representable("dimensionless time per cycle 4 k_w c_N a0^(k-1) μ_f d/M", tau_per_cycle)?;
        Ok(Self {
            indenter: *indenter,
            half_space: *half_space,
            friction: *friction,
            wear: *wear,
            equivalent_profile: profile,
            indentation,
            contact_radius,
            normal_force,
            amplitude: slip.amplitude,
            slip_compression: slip.compression,
            stick_logarithm: slip.stick_logarithm,
            tau_per_cycle,
        })
    }

    /// The unworn indenter.
    pub fn indenter(&self) -> &Indenter {
        &self.indenter
    }

    /// Spring stiffnesses.
    pub fn half_space(&self) -> &HalfSpace {
        &self.half_space
    }

    /// Friction law.
    pub fn friction(&self) -> &Coulomb {
        &self.friction
    }

    /// Wear law.
    pub fn wear(&self) -> &Archard {
        &self.wear
    }

    /// Equivalent profile `g0` of the unworn indenter.
    pub fn equivalent_profile(&self) -> &EquivalentProfile {
        &self.equivalent_profile
    }

    /// Indentation `d`, m: as given, or under the force given.
    pub fn indentation(&self) -> f64 {
        self.indentation
    }

    /// Contact radius `a0`, m, the root of `g0(a0) = d`.
    pub fn contact_radius(&self) -> f64 {
        self.contact_radius
    }

    /// Normal force `F_N`, N: as given, or by [S, Eq. (22)].
    pub fn normal_force(&self) -> f64 {
        self.normal_force
    }

    /// Mean pressure `F_N/(π a0²)`, Pa.
    pub fn mean_pressure(&self) -> f64 {
        self.normal_force / (PI * self.contact_radius * self.contact_radius)
    }

    /// Tangential amplitude `U`, m.
    pub fn amplitude(&self) -> f64 {
        self.amplitude
    }

    /// Tangential amplitude `μ_f d/M`, m, from which on the whole contact slides.
    pub fn amplitude_full_sliding(&self) -> f64 {
        full_sliding_amplitude(
            self.half_space.stiffness_ratio(),
            self.friction.coefficient,
            self.indentation,
        )
    }

    /// Spring compression at the edge of stick, `q_c = M U/μ_f`, m; from `d` on every spring slips.
    pub fn slip_compression(&self) -> f64 {
        self.slip_compression
    }

    /// What the oscillation does to the contact.
    pub fn regime(&self) -> Regime {
        match self.stick_logarithm {
            None => Regime::FullSliding,
            Some(logarithm) if logarithm > 0.0 => Regime::PartialSlip,
            Some(_) => Regime::Stick,
        }
    }

    /// Stick radius `c`, m: the contact radius where nothing slips, none under full sliding.
    pub fn stick_radius(&self) -> Option<f64> {
        self.stick_logarithm.map(|logarithm| self.contact_radius * (-logarithm).exp())
    }

    /// `ln(a0/c)`: zero where nothing slips, none under full sliding; it keeps the digits of the smallest amplitudes.
    pub fn stick_logarithm(&self) -> Option<f64> {
        self.stick_logarithm
    }

    /// `a0² - c²`, m², to full relative accuracy; `a0²` under full sliding.
    pub fn slip_area_offset(&self) -> f64 {
        let area = self.contact_radius * self.contact_radius;
        self.stick_logarithm.map_or(area, |logarithm| area * -(-2.0 * logarithm).exp_m1())
    }

    /// Dimensionless time `τ` of one cycle.
    ///
    /// ```text
    /// τ/N = 4 k_w c_N a0^(k-1) μ_f d / M
    /// ```
    pub fn tau_per_cycle(&self) -> f64 {
        self.tau_per_cycle
    }
}

/// The normal contact.
struct Press {
    indentation: f64,
    contact_radius: f64,
    normal_force: f64,
}

impl Press {
    fn new(profile: &EquivalentProfile, normal_stiffness: f64, load: Load) -> Result<Self> {
        let (key, value) = match load {
            Load::Indentation(indentation) => ("loading.indentation", indentation),
            Load::InitialForce(force) => ("loading.initial_force", force),
        };
        positive(key, value)?;
        let too_large = |error: Error| match error {
            Error::Inconsistent { why, .. } => Error::Inconsistent {
                what: key,
                why: format!("{value} is too large: {why}; make it smaller, or the indenter larger"),
            },
            other => other,
        };
        let indentation = match load {
            Load::Indentation(indentation) => indentation,
            Load::InitialForce(force) => {
                let per_stiffness = force / normal_stiffness;
                representable("normal force per stiffness F_N/c_N, m^(2+k)", per_stiffness)?;
                profile.depth_for_load(per_stiffness).map_err(too_large)?
            }
        };
        representable("indentation, m", indentation)?;
        let contact_radius = profile.radius_at(indentation).map_err(too_large)?;
        representable("contact radius, m", contact_radius)?;
        representable("contact area a0², m²", contact_radius * contact_radius)?;
        let normal_force = match load {
            Load::Indentation(_) => normal_stiffness * profile.load_integral(contact_radius),
            Load::InitialForce(force) => force,
        };
        representable("normal force, N", normal_force)?;
        Ok(Self { indentation, contact_radius, normal_force })
    }
}

/// The tangential oscillation.
struct Slip {
    amplitude: f64,
    compression: f64,
    stick_logarithm: Option<f64>,
}

impl Slip {
    fn new(
        profile: &EquivalentProfile,
        indentation: f64,
        contact_radius: f64,
        stiffness_ratio: f64,
        friction_coefficient: f64,
        amplitude: Amplitude,
    ) -> Result<Self> {
        let from_displacement = |key: &'static str, value: f64, amplitude: f64| {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(Error::OutOfRange { name: key, value, range: "[0, inf)" });
            }
            let compression = slip_compression(stiffness_ratio, amplitude, friction_coefficient);
            if value > 0.0 {
                representable("amplitude, m", amplitude)?;
                representable("compression at the edge of stick M U/μ_f, m", compression)?;
            }
            let stick_logarithm = match Regime::new(indentation, compression) {
                Regime::Stick => Some(0.0),
                Regime::FullSliding => None,
                Regime::PartialSlip => {
                    Some(stick_logarithm(profile, indentation, contact_radius, compression)?)
                }
            };
            Ok(Self { amplitude, compression, stick_logarithm })
        };
        let slip = match amplitude {
            Amplitude::Displacement(amplitude) => {
                from_displacement("loading.amplitude", amplitude, amplitude)?
            }
            Amplitude::Ratio(ratio) => from_displacement(
                "loading.amplitude_ratio",
                ratio,
                ratio * (friction_coefficient * indentation),
            )?,
            Amplitude::StickRatio(ratio) => {
                if !(ratio > 0.0 && ratio <= 1.0) {
                    return Err(Error::OutOfRange {
                        name: "loading.stick_ratio",
                        value: ratio,
                        range: "(0, 1]",
                    });
                }
                // Zero minus: a ratio of 1 gives +0 throughout.
                let logarithm = 0.0 - ratio.ln();
                let compression = 0.0 - profile.at(contact_radius).rise(-logarithm);
                let amplitude = slip_amplitude(stiffness_ratio, friction_coefficient, compression);
                Self { amplitude, compression, stick_logarithm: Some(logarithm) }
            }
        };
        if let Some(logarithm) = slip.stick_logarithm
            && slip.compression > 0.0
        {
            representable("stick radius, m", contact_radius * (-logarithm).exp())?;
            representable("amplitude, m", slip.amplitude)?;
            let offset = contact_radius * contact_radius * -(-2.0 * logarithm).exp_m1();
            representable("slip annulus a0² - c², m²", offset)?;
        }
        Ok(slip)
    }
}

fn positive(name: &'static str, value: f64) -> Result<()> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(Error::OutOfRange { name, value, range: "(0, inf)" })
}

/// Passes what a double holds with all its digits.
fn representable(what: &'static str, value: f64) -> Result<()> {
    if value > 0.0 && value.is_normal() {
        return Ok(());
    }
    let size = if value > 1.0 { "large" } else { "small" };
    Err(Error::Inconsistent {
        what,
        why: format!("{value:e} is too {size} to compute with; check the units in the scene"),
    })
}
