//! What a run comes to before its first step. What it refuses is refused here, for `run` and for `check`.

use super::cost;
use super::parts::Parts;
use crate::contact::closed_form::LimitingShape;
use crate::error::{Error, Result};
use crate::scene::Scene;
use crate::scene::schema::is_key;
use crate::solver::model::OperatorStore;
use crate::solver::simulation::Simulation;

/// A run before its first step.
pub(super) struct Ready {
    pub simulation: Simulation,
    pub limit: Option<LimitingShape>,
}

impl Ready {
    /// # Errors
    /// Every refusal names a key of the scene.
    pub(super) fn new(scene: &Scene, store: &OperatorStore) -> Result<Self> {
        Self::unkeyed(scene, store).map_err(|error| keyed(scene, error))
    }

    fn unkeyed(scene: &Scene, store: &OperatorStore) -> Result<Self> {
        let parts = Parts::new(scene, scene.numerics(), None, None, store)?;
        let mut simulation = Simulation::new(parts.model, parts.stepper, parts.tolerance, parts.plan)?;
        cost::check(scene.numerics().stepper, &mut simulation)?;
        Ok(Self { simulation, limit: parts.limit })
    }
}

/// A refusal at the key with which the scene gives what is refused.
fn keyed(scene: &Scene, error: Error) -> Error {
    let loading = scene.loading();
    let given = |name: &'static str| match name {
        "loading.amplitude" if scene.path().is_some() => "loading.path",
        "loading.amplitude" => loading.amplitude.key(),
        "loading.indentation" => loading.load.key(),
        other => other,
    };
    match error {
        Error::Inconsistent { what, why } if is_key(what) => Error::Inconsistent { what: given(what), why },
        Error::OutOfRange { name, value, range } if is_key(name) => {
            Error::OutOfRange { name: given(name), value, range }
        }
        // The depth decides how wide the contact becomes.
        Error::Inconsistent { .. } | Error::OutOfRange { .. } => {
            let blocks = scene.conditions().blocks.iter().any(|block| block.indentation_factor != 1.0);
            let what = if blocks { "loading.blocks" } else { loading.load.key() };
            Error::Inconsistent { what, why: error.to_string() }
        }
        Error::NotConverged { what, why } => {
            let numerics = scene.numerics();
            let (key, value) = match numerics.springs {
                Some(springs) => ("numerics.springs", springs.to_string()),
                None => ("numerics.accuracy", format!("{:e}", numerics.accuracy)),
            };
            let why = format!(
                "with {value} the first cycle of this contact is not found ({what}: {why}); ask for more springs by hand \
                 (numerics.springs), or for another amplitude"
            );
            Error::Inconsistent { what: key, why }
        }
        other => other,
    }
}
