//! How deep, how wide and how hard bodies are pressed together, by depth or by force.

use std::f64::consts::PI;

use super::{positive, representable};
use crate::contact::indenter::EquivalentProfile;
use crate::error::{Error, Result};
use crate::laws::loading::Load;

/// The normal contact.
pub(super) struct Press {
    pub indentation: f64,
    pub contact_radius: f64,
    pub normal_force: f64,
}

impl Press {
    pub(super) fn new(profile: &EquivalentProfile, normal_stiffness: f64, load: Load) -> Result<Self> {
        let key = load.key();
        let (Load::Indentation(value) | Load::InitialForce(value) | Load::NormalForce(value)) = load;
        positive(key, value)?;
        let too_large = |error: Error| match error {
            // That of a table has its own cure.
            Error::Inconsistent { why, .. } if profile.end_of_table().is_some() => {
                Error::Inconsistent { what: key, why }
            }
            Error::Inconsistent { why, .. } => Error::Inconsistent {
                what: key,
                why: format!("{value} is too large: {why}; make it smaller, or the indenter larger"),
            },
            other => other,
        };
        let indentation = match load {
            Load::Indentation(indentation) => indentation,
            Load::InitialForce(force) | Load::NormalForce(force) => {
                let per_stiffness = force / normal_stiffness;
                representable(
                    "normal force per stiffness F_N/c_N, m^(2+k)",
                    per_stiffness,
                    &[key, "half_space"],
                )?;
                profile.depth_for_load(per_stiffness).map_err(too_large)?
            }
        };
        representable("indentation, m", indentation, &[key])?;
        let contact_radius = profile.radius_at(indentation).map_err(too_large)?;
        representable("contact radius, m", contact_radius, &["indenter", "loading"])?;
        // Worn volumes are fractions of it.
        let volume = PI * contact_radius * contact_radius * indentation;
        representable("volume π a0² d, m³", volume, &["indenter", "loading"])?;
        let normal_force = match load {
            Load::Indentation(_) => normal_stiffness * profile.load_integral(contact_radius),
            Load::InitialForce(force) | Load::NormalForce(force) => force,
        };
        representable("normal force, N", normal_force, &["loading.indentation", "half_space"])?;
        Ok(Self { indentation, contact_radius, normal_force })
    }
}
