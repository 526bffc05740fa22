//! What of a contact slips, by the amplitude in each of its forms.

use super::{Press, positive, representable};
use crate::contact::half_space::HalfSpace;
use crate::contact::indenter::EquivalentProfile;
use crate::contact::stick_slip::{Regime, slip_amplitude, slip_compression, stick_logarithm};
use crate::error::{Error, Result};
use crate::laws::loading::Amplitude;

/// The tangential oscillation.
pub(super) struct Slip {
    pub amplitude: f64,
    pub compression: f64,
    pub stick_logarithm: Option<f64>,
}

impl Slip {
    pub(super) fn new(
        profile: &EquivalentProfile,
        press: &Press,
        half_space: &HalfSpace,
        friction_coefficient: f64,
        amplitude: Amplitude,
    ) -> Result<Self> {
        let Press { indentation, contact_radius, normal_force } = *press;
        let stiffness_ratio = half_space.stiffness_ratio();
        let from_displacement = |value: f64, displacement: f64| {
            let key = amplitude.key();
            if !(value >= 0.0 && value.is_finite()) {
                return Err(Error::OutOfRange { name: key, value, range: "[0, inf)" });
            }
            let compression = slip_compression(stiffness_ratio, displacement, friction_coefficient);
            if value > 0.0 {
                representable("amplitude, m", displacement, &[key])?;
                representable("compression at the edge of stick M U/μ_f, m", compression, &[key])?;
            }
            let stick_logarithm = match Regime::new(indentation, compression) {
                Regime::Stick => Some(0.0),
                Regime::FullSliding => None,
                Regime::PartialSlip => {
                    Some(stick_logarithm(profile, indentation, contact_radius, compression)?)
                }
            };
            Ok(Self { amplitude: displacement, compression, stick_logarithm })
        };
        let slip = match amplitude {
            Amplitude::Displacement(displacement) => from_displacement(displacement, displacement)?,
            Amplitude::Stroke(stroke) => from_displacement(stroke, 0.5 * stroke)?,
            Amplitude::Force(force) => {
                positive(amplitude.key(), force)?;
                let most = friction_coefficient * normal_force;
                // F_N - F_x/μ_f = 2 c_N ∫_0^c x^k (g0(c) - g0) dx  (Cattaneo, Mindlin; Ciavarella, Jäger)
                let borne = normal_force - force / friction_coefficient;
                if borne <= 0.0 {
                    let why = format!(
                        "{force} N is not below μ_f F_N = {most} N, so that the contact is in gross slip and a held force accelerates it; \
                         ask for less, or give the amplitude as a length"
                    );
                    return Err(Error::Inconsistent { what: amplitude.key(), why });
                }
                let height = profile.depth_for_load(borne / half_space.normal_stiffness())?;
                let compression = (indentation - height).max(0.0);
                from_displacement(force, slip_amplitude(stiffness_ratio, friction_coefficient, compression))?
            }
            Amplitude::Ratio(ratio) => {
                from_displacement(ratio, ratio * (friction_coefficient * indentation))?
            }
            Amplitude::StickRatio(ratio) => {
                if !(ratio > 0.0 && ratio <= 1.0) {
                    return Err(Error::OutOfRange { name: amplitude.key(), value: ratio, range: "(0, 1]" });
                }
                if contact_radius * ratio < profile.flat_radius() {
                    return Err(Error::Inconsistent {
                        what: amplitude.key(),
                        why: format!(
                            "{ratio} puts the edge of stick at {} m, but the profile is flat up to {} m, where all springs slip at once; \
                             ask for a larger ratio",
                            contact_radius * ratio,
                            profile.flat_radius()
                        ),
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
            let key = amplitude.key();
            let share = -(-2.0 * logarithm).exp_m1();
            representable("stick radius, m", contact_radius * (-logarithm).exp(), &[key])?;
            representable("amplitude, m", slip.amplitude, &[key])?;
            // The worn volume falls with the power (5-k)/2 of the annulus.
            let least = contact_radius * contact_radius * indentation * share.powi(3);
            representable("worn volume, m³, in order of size", least, &[key])?;
        }
        Ok(slip)
    }
}
