//! What a run comes to before its first step. What it refuses is refused here, for `run` and for `check`.

use std::f64::consts::PI;

use super::cost;
use super::parts::{Known, Parts};
use super::rim;
use crate::contact::closed_form::LimitingShape;
use crate::error::{Error, Result};
use crate::laws::history::History;
use crate::numerics::roots::SEARCH;
use crate::scene::Scene;
use crate::scene::schema::is_key;
use crate::solver::model::OperatorStore;
use crate::solver::simulation::Simulation;

/// Area of a slip annulus, over that of the stick zone, below which is tried whether there is a first step.
const NARROW: f64 = 1e-3;

/// Least part of a cycle within which friction may change by the energy dissipated.
const LEAST_OF_CYCLE: f64 = 1e-6;

/// A run before its first step.
pub(super) struct Ready {
    pub simulation: Simulation,
    pub limit: Option<LimitingShape>,
    pub known: Known,
}

impl Ready {
    /// # Errors
    /// Every refusal names a key of the scene.
    pub(super) fn new(scene: &Scene, store: &OperatorStore) -> Result<Self> {
        Self::unkeyed(scene, store).map_err(|error| keyed(scene, error))
    }

    fn unkeyed(scene: &Scene, store: &OperatorStore) -> Result<Self> {
        let mut parts = Parts::new(scene, scene.numerics(), None, None, store)?;
        let (limit, known) = (parts.limit.take(), Known::of(&parts));
        let mut simulation = parts.begin()?;
        let numerics = scene.numerics();
        cost::check(numerics.stepper, numerics.springs.is_some(), &mut simulation)?;
        check_width(&mut simulation)?;
        rim::check_partial_slip(&simulation)?;
        check_energy(&simulation)?;
        Ok(Self { simulation, limit, known })
    }
}

/// Refuses a slip annulus so narrow that no first step is found where the edge of stick moves: the place of that edge is rounded to `1e-16` of its radius.
fn check_width(simulation: &mut Simulation) -> Result<()> {
    let width = simulation.model().width_beside_moving_edge(simulation.state());
    let Some(width) = width.filter(|width| *width < NARROW) else { return Ok(()) };
    if simulation.begins()? {
        return Ok(());
    }
    let why = too_narrow((simulation.model().contact().amplitude(), width));
    Err(Error::Inconsistent { what: "loading.amplitude", why })
}

/// Refuses friction that has changed by the energy of a tiny part of the first cycle, along which the model takes it to be one.
fn check_energy(simulation: &Simulation) -> Result<()> {
    let model = simulation.model();
    let History::Exponential { time: density, .. } = *model.schedule().friction_along_energy() else {
        return Ok(());
    };
    let area = PI * model.contact().contact_radius().powi(2);
    let dissipation = simulation.cycle().dissipation;
    if dissipation < 0.0 {
        let why = format!("by its springs {dissipation:.1e} J are dissipated, less than nothing");
        return Err(Error::NotConverged { what: "energy dissipated", why });
    }
    let cycles = density * area / dissipation;
    if cycles >= LEAST_OF_CYCLE || cycles.is_nan() {
        return Ok(());
    }
    let why = format!(
        "{density:e} J/m² are dissipated in {cycles:.1e} of the first cycle, along which friction is taken to be the same; ask for more, or for the last \
         coefficient from the start (friction.coulomb)"
    );
    Err(Error::Inconsistent { what: "friction.wear-dependent.energy_density", why })
}

/// Amplitude, m, and area of the slip annulus of the first cycle over that of the stick zone, where there is one.
fn width(scene: &Scene) -> Option<(f64, f64)> {
    let contact = scene.contact().ok()?;
    let stick = contact.stick_radius()?;
    Some((contact.amplitude(), contact.slip_area_offset() / (stick * stick)))
}

fn too_narrow((amplitude, width): (f64, f64)) -> String {
    format!(
        "at an amplitude of {amplitude:e} m the slip annulus has {width:.1e} of the area of the stick zone, and in a step its edge moves by less than its place is rounded \
         to; ask for a larger amplitude, or leave out what moves it (a rig or force that is held, friction that changes, blocks)"
    )
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
            if let Some(refused) = width(scene).filter(|(_, width)| *width < NARROW && what == SEARCH) {
                return Error::Inconsistent { what: loading.amplitude.key(), why: too_narrow(refused) };
            }
            let why = if what == SEARCH {
                "no place is found for its edges at which the forces balance".into()
            } else {
                format!("{what}: {why}")
            };
            let why = format!(
                "with {value} the first cycle of this contact is not found: {why}; ask for more springs by hand (numerics.springs), or for another amplitude"
            );
            Error::Inconsistent { what: key, why }
        }
        other => other,
    }
}
