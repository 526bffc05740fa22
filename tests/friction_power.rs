//! Wear that depends on the power of friction: against a power law, against an exact change of time, and against the limit.

mod support;

use std::f64::consts::PI;
use std::sync::Arc;

use fretwear::laws::conditions::Conditions;
use fretwear::laws::wear::friction_power::{Coefficient, FrictionPower};
use fretwear::laws::wear::{DissipatedEnergy, PowerLaw};
use fretwear::scene::Scene;
use fretwear::solver::simulation::{End, Observer, Plan, Simulation};
use fretwear::solver::stepper::Sdirk;
use support::{Case, laws};

const FREQUENCY: f64 = 2.0;

/// Cycles, worn volume and energy per cycle and area at the outputs.
#[derive(Default)]
struct History(Vec<[f64; 3]>);

impl Observer for History {
    fn output(&mut self, simulation: &Simulation) -> fretwear::Result<()> {
        let model = simulation.model();
        let area = PI * model.contact_radius(simulation.state()).powi(2);
        let volume = model.wear_volume(simulation.fields());
        self.0.push([simulation.state().cycles, volume, simulation.cycle().dissipation / area]);
        Ok(())
    }
}

fn history(case: &Case, conditions: &Conditions, outputs: &[f64]) -> Vec<[f64; 3]> {
    let plan = Plan { outputs: outputs.to_vec(), end: End::Cycles(outputs[outputs.len() - 1]) };
    let model = laws::model(case, conditions, None);
    let mut simulation = Simulation::new(model, Box::new(Sdirk::new(1e-6)), 1e-6, plan).unwrap();
    let mut history = History::default();
    simulation.run(&mut [&mut history]).unwrap();
    history.0
}

#[test]
fn a_power_law_of_the_power_of_each_place_is_one_of_pressure_and_slip() {
    let exponent = -0.25;
    for (profile, grading) in [(2.0, 0.0), (1.0, 0.5)] {
        let case = Case::new(profile, grading, 0.7, 40);
        let contact = case.contact();
        let friction = contact.friction().coefficient;
        let reference = 3.0;
        let factor = 0.2;
        let coefficient = Coefficient::Power { coefficient: factor, exponent, reference, largest: None };
        let power = PowerLaw {
            coefficient: factor * friction * (FREQUENCY * friction / reference).powf(exponent),
            pressure_exponent: 1.0 + exponent,
            slip_exponent: 1.0 + exponent,
        };
        let by_power = FrictionPower { coefficient, frequency: FREQUENCY, local: true };
        let plain = laws::plain(&contact);
        let ends = [
            history(&case, &Conditions { wear: Arc::new(by_power), ..plain.clone() }, &[0.5, 2.0]),
            history(&case, &Conditions { wear: Arc::new(power), ..plain.clone() }, &[0.5, 2.0]),
        ];
        println!("{ends:?}");
        for (a, b) in ends[0].iter().zip(&ends[1]).skip(1) {
            assert!((a[1] / b[1] - 1.0).abs() < 6e-10, "{a:?} {b:?}");
        }
    }
}

/// Cycles under the law of a contact at the worn volumes of a run with a constant coefficient, by the fourth-order rule of Simpson on
/// pairs of intervals of the same length.
fn stretched(reference: &[[f64; 3]], constant: f64, law: &Coefficient) -> Vec<[f64; 2]> {
    let rate = |at: &[f64; 3]| constant / law.at(FREQUENCY * at[2]).0;
    let mut cycles = 0.0;
    let mut found = vec![];
    for pair in reference.windows(3).step_by(2) {
        let width = (pair[2][0] - pair[0][0]) / 6.0;
        cycles += width * (rate(&pair[0]) + 4.0 * rate(&pair[1]) + rate(&pair[2]));
        found.push([cycles, pair[2][1]]);
    }
    found
}

#[test]
fn the_power_of_the_whole_contact_changes_time_and_nothing_else() {
    for (profile, grading) in [(2.0, 0.0), (1.0, 0.5)] {
        let case = Case::new(profile, grading, 0.7, 40);
        let contact = case.contact();
        let constant = contact.wear().coefficient;
        let plain = laws::plain(&contact);
        let outputs: Vec<f64> = (1..=80).map(|i| 0.05 * f64::from(i)).collect();
        let energy = DissipatedEnergy { coefficient: constant };
        let reference = history(&case, &Conditions { wear: Arc::new(energy), ..plain.clone() }, &outputs);
        let power = FREQUENCY * reference[0][2];
        for coefficient in [
            Coefficient::Exponential {
                abrasive: 3.0 * constant,
                adhesive: 0.1 * constant,
                decay: 1.5 / power,
            },
            Coefficient::Power { coefficient: constant, exponent: -0.25, reference: power, largest: None },
        ] {
            let expected = stretched(&reference, constant, &coefficient);
            let law = FrictionPower { coefficient, frequency: FREQUENCY, local: false };
            let at: Vec<f64> = [9, 19, 39].map(|i| expected[i][0]).to_vec();
            let found = history(&case, &Conditions { wear: Arc::new(law), ..plain.clone() }, &at);
            for (found, expected) in found.iter().skip(1).zip([9, 19, 39].map(|i| expected[i])) {
                let miss = found[1] / expected[1] - 1.0;
                println!("n {profile} k {grading}: {found:?} for {expected:?}, {miss:e}");
                assert!(miss.abs() < 1e-4, "{found:?} for {expected:?}");
            }
        }
    }
}

#[test]
fn both_scopes_end_at_the_limit() {
    let case = Case::new(2.0, 0.0, 0.7, 40);
    let contact = case.contact();
    let constant = contact.wear().coefficient;
    let power = FREQUENCY * contact.mean_pressure() * contact.indentation();
    for local in [true, false] {
        let coefficient =
            Coefficient::Exponential { abrasive: 2.0 * constant, adhesive: constant, decay: 2.0 / power };
        let wear = Arc::new(FrictionPower { coefficient, frequency: FREQUENCY, local });
        let ending = laws::end(&case, &Conditions { wear, ..laws::plain(&contact) }, End::Rate(1e-12));
        println!("local {local}: {ending:?}");
        assert!(ending.distance < 1e-12 && (ending.volume - 1.0).abs() < 7e-8, "{local}: {ending:?}");
    }
}

fn read(law: &str, loading: &str) -> Result<Scene, String> {
    let text = format!(
        "[indenter.sphere]\nradius = \"10 mm\"\n[half_space]\ngrading = 0\nmodulus = \"210 GPa\"\npoisson_ratio = 0.3\n\
         [friction.coulomb]\ncoefficient = 0.6\n[wear.friction-power]\n{law}\n\
         [loading]\nindentation = \"2 um\"\nstick_ratio = 0.7\ncycles = 1e4\n{loading}"
    );
    Scene::from_toml(&text, "scene.toml").map_err(|error| error.to_string())
}

#[test]
fn what_is_ill_posed_or_incomplete_is_refused_with_the_reason() {
    let cylinder = "abrasive_coefficient = \"4.1e-4 mm^3/J\"\nadhesive_coefficient = \"1.0e-5 mm^3/J\"\ndecay = \"11 mm^2/W\"\n";
    let frequency = "frequency = \"1 Hz\"";
    let global = read(&format!("{cylinder}scope = \"global\""), frequency).expect("a scene");
    assert_eq!(global.conditions().frequency, Some(1.0));
    assert!(!global.conditions().is_plain());
    let power = "coefficient = \"1.1e-4 mm^3/J\"\nexponent = -0.25\n";
    read(&format!("{power}scope = \"local\"\nlargest_coefficient = \"4e-4 mm^3/J\""), frequency)
        .expect("a scene");
    for (law, loading, expected) in [
        (
            format!("{cylinder}scope = \"local\""),
            frequency,
            "is 0.025 of abrasive_coefficient - adhesive_coefficient",
        ),
        (format!("{cylinder}scope = \"global\""), "", "give loading.frequency"),
        (cylinder.to_owned(), frequency, "wear.friction-power.scope is missing"),
        (format!("{cylinder}{power}scope = \"local\""), frequency, "exclude each other"),
        ("scope = \"local\"".to_owned(), frequency, "give exactly one of"),
        (power.replace("-0.25", "-1") + "scope = \"local\"", frequency, "is outside (-1, inf); with less"),
    ] {
        let error = read(&law, loading).expect_err("refused");
        assert!(error.contains(expected), "{expected:?} in {error}");
    }
}

#[test]
fn dimensionless_time_goes_by_the_coefficient_in_both_scopes() {
    let tau = |law: &str| {
        let scene = read(law, "frequency = \"1 Hz\"").expect("a scene");
        scene.contact().expect("a contact").tau_per_cycle()
    };
    let constant = "abrasive_coefficient = 2e-14\nadhesive_coefficient = 2e-14\ndecay = 1e-9\n";
    let [local, global] = ["local", "global"].map(|scope| tau(&format!("{constant}scope = \"{scope}\"")));
    // k_w = α μ_f
    let text = "[indenter.sphere]\nradius = \"10 mm\"\n[half_space]\ngrading = 0\nmodulus = \"210 GPa\"\npoisson_ratio = 0.3\n\
        [friction.coulomb]\ncoefficient = 0.6\n[wear.dissipated-energy]\ncoefficient = 2e-14\n\
        [loading]\nindentation = \"2 um\"\nstick_ratio = 0.7\ncycles = 1e4\n";
    let scene = Scene::from_toml(text, "scene.toml").expect("a scene");
    let expected = scene.contact().expect("a contact").tau_per_cycle();
    for tau in [local, global] {
        assert!((tau / expected - 1.0).abs() < 1e-12, "{tau:e} for {expected:e}");
    }
}
