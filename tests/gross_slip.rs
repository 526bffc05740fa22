//! Contacts that slide as a whole: the closed form of the first rate, and runs for every indenter, grading and amplitude that is not refused.

mod support;

use std::f64::consts::PI;
use std::sync::Arc;

use fretwear::contact::InitialContact;
use fretwear::contact::half_space::HalfSpace;
use fretwear::contact::indenter::{Indenter, power_law_factor};
use fretwear::laws::conditions::Conditions;
use fretwear::laws::friction::Coulomb;
use fretwear::laws::loading::{Amplitude, Duration, Load, Loading};
use fretwear::laws::motion::NormalOscillation;
use fretwear::laws::wear::Archard;
use fretwear::numerics::grid::Clustering;
use fretwear::solver::model::{Model, OperatorStore, Resolution, Schedule};
use fretwear::solver::simulation::{End, Outcome, Plan, Simulation};
use fretwear::solver::stepper::{CycleJump, Sdirk};
use support::laws::plain;
use support::{Record, distance};

const EXPONENTS: [f64; 5] = [0.5, 1.0, 2.0, 4.0, 10.0];

/// Amplitudes over the one from which on the whole contact slides.
const AMPLITUDES: [f64; 4] = [1.0001, 1.35, 3.0, 10.0];

/// The indenter `r^n` on a contact of radius one, stiffnesses and friction one, moved by `over` times the amplitude of full sliding; one cycle
/// lasts `τ = 1`.
fn contact(exponent: f64, grading: f64, over: f64) -> InitialContact {
    let indentation = power_law_factor(exponent, grading);
    let loading = Loading {
        load: Load::Indentation(indentation),
        amplitude: Amplitude::Ratio(over),
        duration: Duration::Tau(1.0),
    };
    let indenter = Indenter::power_law(1.0, exponent).unwrap();
    let half_space = HalfSpace::from_stiffness(grading, 1.0, 1.0).unwrap();
    let wear = Archard { coefficient: 1.0 / (4.0 * indentation) };
    InitialContact::new(&indenter, &half_space, &Coulomb { coefficient: 1.0 }, &wear, &loading).unwrap()
}

fn model(contact: &InitialContact, conditions: &Conditions, springs: usize) -> fretwear::Result<Model> {
    let schedule = Schedule::new(contact, conditions, Resolution::default())?;
    Model::under(contact, schedule, springs, Clustering::Cubic, &OperatorStore::default())
}

/// `dV/dN = 4 k_w [F_N U - (μ_f/M) 2 c_N ∫_0^a x^k q² dx]` of a power law, for stiffnesses and friction one.
fn first_rate(contact: &InitialContact, exponent: f64, grading: f64) -> f64 {
    let (d, power) = (contact.indentation(), 1.0 + grading);
    let integral = |weights: [f64; 3]| {
        let terms = [power, power + exponent, power + 2.0 * exponent];
        weights.iter().zip(terms).map(|(weight, term)| weight / term).sum::<f64>()
    };
    let force = 2.0 * d * integral([1.0, -1.0, 0.0]);
    let squares = 2.0 * d * d * integral([1.0, -2.0, 1.0]);
    4.0 * contact.wear().coefficient * (force * contact.amplitude() - squares)
}

#[test]
fn the_first_rate_of_gross_slip_is_that_of_the_closed_form() {
    for grading in [-0.2, 0.0, 0.4, 0.9] {
        for exponent in EXPONENTS {
            for over in AMPLITUDES {
                let contact = contact(exponent, grading, over);
                let model = model(&contact, &plain(&contact), 60).unwrap();
                assert!(model.slides());
                let state = model.initial_state().unwrap();
                let fields = model.fields(&state);
                let cycle = model.cycle(&model.schedule().loading(0.0, 0.0), &state.compression, &fields);
                let expected = first_rate(&contact, exponent, grading);
                let of_surface: f64 = model
                    .operators()
                    .depth_sum()
                    .iter()
                    .zip(cycle.growth.iter().zip(&fields.slip_depth))
                    .map(|(weight, (growth, depth))| PI * fields.slip_area * weight * growth * depth)
                    .sum();
                let off = [cycle.volume, of_surface].map(|rate| (rate / expected - 1.0).abs());
                println!("k {grading} n {exponent} U {over}: energy and surface off by {off:?}");
                let unworn = fields.log_slip.iter().fold(0.0, |m: f64, value| m.max(value.abs()));
                assert!(unworn < 2e-12, "k {grading} n {exponent} U {over}: slip {unworn:e}");
                // Measured on so few springs: 1.2e-2 at k = -0.2, 6.7e-3 at 0, 2.0e-3 at 0.4 and 4e-4 at 0.9, where the core bears 4e-3, 1e-3, 6e-5
                // and 2e-6 of the load.
                let allowed = 5.0 * model.core_uncertainty() + 2.5e-3;
                assert!(off.iter().all(|off| *off < allowed), "k {grading} n {exponent} U {over}: {off:?}");
            }
        }
    }
}

#[test]
fn gross_slip_runs_for_every_indenter_and_amplitude() {
    for grading in [-0.2, 0.0, 0.4, 0.9] {
        for exponent in EXPONENTS {
            for over in AMPLITUDES {
                let contact = contact(exponent, grading, over);
                let at = |springs: usize| {
                    let model = model(&contact, &plain(&contact), springs).unwrap();
                    let plan = Plan { outputs: vec![0.01, 0.1, 1.0], end: End::Cycles(1.0) };
                    let mut seen = Record::default();
                    let mut simulation =
                        Simulation::new(model, Box::new(Sdirk::new(1e-3)), 1e-3, plan).unwrap();
                    let outcome = simulation.run(&mut [&mut seen]);
                    let place = format!("k {grading} n {exponent} U {over} on {springs} springs");
                    let outcome = outcome.unwrap_or_else(|error| panic!("{place}: {error}"));
                    assert_eq!(outcome, Outcome::End);
                    seen.0.iter().map(|seen| seen.wear_volume).collect::<Vec<_>>()
                };
                let [few, many] = [at(60), at(90)];
                let last = many[many.len() - 1];
                let off = distance(&few, &many) / last;
                println!("k {grading} n {exponent} U {over}: {many:?}, fewer springs off by {off:.1e}");
                assert!(off < 1e-2, "k {grading} n {exponent} U {over}: {few:?} {many:?}");
                assert!(many.windows(2).all(|pair| pair[1] >= pair[0]), "{many:?}");
            }
        }
    }
}

#[test]
fn gross_slip_under_normal_oscillation_wears_from_the_first_cycle() {
    for (exponent, over, frequency_ratio) in [
        (4.0, 1.35, [1, 1]),
        (4.0, 1.35, [1, 2]),
        (4.0, 1.35, [3, 2]),
        (10.0, 2.0, [1, 1]),
        (0.5, 2.0, [2, 1]),
    ] {
        let contact = contact(exponent, 0.0, over);
        let mode =
            NormalOscillation { amplitude: 0.2 * contact.indentation(), frequency_ratio, phase: 0.5 * PI };
        let conditions = Conditions { mode: Arc::new(mode), ..plain(&contact) };
        let model = model(&contact, &conditions, 60).unwrap();
        assert!(model.slides());
        let plan = Plan { outputs: vec![0.1], end: End::Cycles(0.1) };
        let mut simulation = Simulation::new(model, Box::new(Sdirk::new(1e-3)), 1e-3, plan).unwrap();
        let first = simulation.progress().first_rate;
        assert_eq!(simulation.run(&mut []).unwrap(), Outcome::End);
        let (state, fields) = (simulation.state(), simulation.fields());
        let volume = simulation.model().wear_volume(fields);
        println!(
            "n {exponent} U {over} {frequency_ratio:?}: {first:.5}, {volume:.5}, {:.5}",
            state.volume_by_rate
        );
        assert!(volume > 0.0 && (volume / state.volume_by_rate - 1.0).abs() < 2e-2, "{volume}");
    }
}

/// Beside Runge-Kutta's explicit steps, and with a held force.
#[test]
fn explicit_steps_and_a_held_force_serve_gross_slip_on_a_flat_indenter() {
    let contact = contact(4.0, 0.0, 1.35);
    let plan = Plan { outputs: vec![0.1], end: End::Cycles(0.1) };
    let at = |implicit: bool| {
        let model = model(&contact, &plain(&contact), 60).unwrap();
        let mut simulation = if implicit {
            Simulation::new(model, Box::new(Sdirk::new(1e-4)), 1e-4, plan.clone()).unwrap()
        } else {
            Simulation::new(model, Box::new(CycleJump::default()), 1e-4, plan.clone()).unwrap()
        };
        simulation.run(&mut []).unwrap();
        simulation.model().wear_volume(simulation.fields())
    };
    let [implicit, explicit] = [at(true), at(false)];
    println!("implicit {implicit}, explicit {explicit}");
    assert!((implicit / explicit - 1.0).abs() < 1e-3, "{implicit} {explicit}");
    let held = Conditions { holds_normal_force: true, ..plain(&contact) };
    let model = model(&contact, &held, 60).unwrap();
    let stepper = Box::new(Sdirk::new(1e-4));
    let mut simulation = Simulation::new(model, stepper, 1e-4, plan.clone()).unwrap();
    simulation.run(&mut []).unwrap();
    let volume = simulation.model().wear_volume(simulation.fields());
    let force = simulation.model().normal_force(simulation.fields());
    println!("held force {volume} {force}");
    assert!((force / contact.normal_force() - 1.0).abs() < 1e-9, "{force}");
    let by_rate = simulation.state().volume_by_rate;
    assert!((volume / by_rate - 1.0).abs() < 1e-2, "{volume} {by_rate}");
}
