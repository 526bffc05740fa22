//! What a run comes to before its first step. What it refuses is refused here, for `run` and for `check`.

use super::cost;
use super::parts::Parts;
use crate::contact::closed_form::LimitingShape;
use crate::error::{Error, Result};
use crate::scene::Scene;
use crate::scene::schema::is_key;
use crate::solver::model::OperatorStore;
use crate::solver::simulation::Simulation;

/// Area of a slip annulus, over that of the stick zone, below which is tried whether there is a first step.
const NARROW: f64 = 1e-3;

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
        let mut parts = Parts::new(scene, scene.numerics(), None, None, store)?;
        let limit = parts.limit.take();
        let mut simulation = parts.begin()?;
        cost::check(scene.numerics().stepper, &mut simulation)?;
        check_width(&mut simulation)?;
        Ok(Self { simulation, limit })
    }
}

/// Refuses a slip annulus so narrow that no first step is found where the edge of stick moves: the place of that edge is rounded to `1e-16` of its radius.
fn check_width(simulation: &mut Simulation) -> Result<()> {
    let width = simulation.model().width_beside_moving_edge(simulation.state());
    let Some(width) = width.filter(|width| *width < NARROW) else { return Ok(()) };
    if simulation.begins()? {
        return Ok(());
    }
    let why = format!(
        "at an amplitude of {:e} m the slip annulus has {width:.1e} of the area of the stick zone, and in a step its edge moves by less than its place is rounded \
         to; ask for a larger amplitude, or leave out what moves it (a rig or force that is held, friction that changes, blocks)",
        simulation.model().contact().amplitude()
    );
    Err(Error::Inconsistent { what: "loading.amplitude", why })
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
