//! Laws and modes in the units of the cases, and runs under them.

use std::sync::Arc;

use fretwear::contact::InitialContact;
use fretwear::contact::closed_form::LimitingShape;
use fretwear::laws::conditions::Conditions;
use fretwear::laws::friction::{FrictionLaw, LoadDependent, StaticKinetic};
use fretwear::laws::loading::Block;
use fretwear::laws::motion::{Mode, NormalOscillation, Orbit, Tangential};
use fretwear::laws::wear::{DissipatedEnergy, NonLocal, PowerLaw, Threshold, WearLaw};
use fretwear::solver::model::{Model, OperatorStore, Resolution, Schedule};
use fretwear::solver::simulation::{End, Outcome, Plan, Simulation};
use fretwear::solver::stepper::Sdirk;

use super::{Case, distance};

pub fn plain(contact: &InitialContact) -> Conditions {
    Conditions::plain(*contact.friction(), *contact.wear())
}

/// `p^α s^β` that wears as Archard's law does under the mean pressure and a slip of `0.3 d`.
pub fn power(contact: &InitialContact, pressure_exponent: f64, slip_exponent: f64) -> Arc<dyn WearLaw> {
    let pressure = contact.mean_pressure().powf(1.0 - pressure_exponent);
    let path = (4.0 * 0.3 * contact.indentation()).powf(1.0 - slip_exponent);
    let coefficient = contact.wear().coefficient * pressure * path;
    Arc::new(PowerLaw { coefficient, pressure_exponent, slip_exponent })
}

/// Laws of wear that are local, without threshold.
pub fn wear_laws(contact: &InitialContact) -> Vec<(&'static str, Arc<dyn WearLaw>)> {
    let coefficient = contact.wear().coefficient;
    vec![
        ("Archard", Arc::new(*contact.wear())),
        ("energy", Arc::new(DissipatedEnergy { coefficient })),
        ("p^1.5", power(contact, 1.5, 1.0)),
        ("p^0.7", power(contact, 0.7, 1.0)),
        ("s^0.5", power(contact, 1.0, 0.5)),
        ("p^1.5 s^0.5", power(contact, 1.5, 0.5)),
    ]
}

/// Those that leave the limit.
pub fn other_wear_laws(contact: &InitialContact) -> Vec<(&'static str, Arc<dyn WearLaw>)> {
    let coefficient = contact.wear().coefficient;
    vec![
        ("threshold", Arc::new(Threshold { coefficient, pressure: 0.1 * contact.mean_pressure() })),
        ("non-local", Arc::new(NonLocal { coefficient, length: 0.1 })),
    ]
}

pub fn friction_laws(contact: &InitialContact) -> Vec<(&'static str, Arc<dyn FrictionLaw>)> {
    let load = |exponent: f64| {
        Arc::new(LoadDependent { coefficient: 1.0, exponent, reference: contact.indentation() })
    };
    let kinetic = StaticKinetic { static_coefficient: 1.0, kinetic_coefficient: 0.8 };
    vec![
        ("Coulomb", Arc::new(*contact.friction())),
        ("static and kinetic", Arc::new(kinetic)),
        ("load-dependent -0.3", load(-0.3)),
        ("load-dependent 0.3", load(0.3)),
    ]
}

pub fn modes(contact: &InitialContact) -> Vec<(&'static str, Arc<dyn Mode>)> {
    let (u, d) = (contact.amplitude(), contact.indentation());
    let normal = |frequency_ratio: [u32; 2]| -> Arc<dyn Mode> {
        Arc::new(NormalOscillation { amplitude: 0.1 * d, frequency_ratio, phase: 1.0 })
    };
    let orbit = |transverse: f64, phase: f64, centre: f64| -> Arc<dyn Mode> {
        Arc::new(Orbit { transverse_amplitude: transverse * u, phase, centre: [centre * u, 0.0] })
    };
    vec![
        ("tangential", Arc::new(Tangential)),
        ("normal 1:1", normal([1, 1])),
        ("normal 2:1", normal([2, 1])),
        ("ellipse", orbit(0.6, 0.0, 0.0)),
        ("ellipse off centre", orbit(0.6, 0.0, 1.0)),
        ("circle", orbit(1.0, 0.0, 0.0)),
        ("slanted ellipse", orbit(0.8, 0.5, 0.0)),
    ]
}

pub fn block(duration: f64, amplitude_factor: f64, indentation_factor: f64) -> Block {
    Block { duration, amplitude_factor, indentation_factor }
}

/// A model under conditions; resolved in so many substeps, if any are given.
pub fn model(case: &Case, conditions: &Conditions, substeps: Option<usize>) -> Model {
    let contact = case.contact();
    let resolution = Resolution { resolved: substeps.is_some(), substeps };
    let schedule = Schedule::new(&contact, conditions, resolution).unwrap();
    Model::under(&contact, schedule, case.springs, case.clustering, &OperatorStore::default()).unwrap()
}

/// How a run ended, against the closed form for the largest indentation and the smallest stick radius.
#[derive(Debug)]
pub struct Ending {
    pub outcome: Outcome,
    pub cycles: f64,
    pub steps: u64,
    /// Largest difference of the depth over the largest depth of the limit.
    pub distance: f64,
    /// Worn volume over that of the limit.
    pub volume: f64,
}

/// Runs until the rate has fallen to a fraction.
pub fn end(case: &Case, conditions: &Conditions, end: End) -> Ending {
    let tolerance = 1e-4;
    let plan = Plan { outputs: vec![], end };
    let stepper = Box::new(Sdirk::new(tolerance));
    let mut simulation = Simulation::new(model(case, conditions, None), stepper, tolerance, plan).unwrap();
    let outcome = simulation.run(&mut []);
    let model = simulation.model();
    let shape = LimitingShape::from_contact(model.contact()).unwrap().unwrap();
    let limit: Vec<f64> = model.offsets().iter().map(|offset| shape.wear_depth_at_offset(*offset)).collect();
    Ending {
        outcome: outcome.unwrap(),
        cycles: simulation.state().cycles,
        steps: simulation.progress().steps,
        distance: distance(&simulation.wear_depth(), &limit) / shape.wear_depth_max(),
        volume: model.wear_volume(simulation.fields()) / shape.wear_volume(),
    }
}
