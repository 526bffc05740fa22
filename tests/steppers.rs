//! The steppers against each other, and what the loop over time promises of each.

mod support;

use fretwear::numerics::grid::Clustering;
use fretwear::solver::simulation::{End, Flow, Observer, Outcome, Plan, Progress, Simulation};
use fretwear::solver::stepper::{Bdf, CycleJump, EveryCycle, Sdirk, Stepper};
use support::{Case, Record, Seen, distance};

const TOLERANCE: f64 = 1e-5;

/// Paraboloid on a homogeneous half-space, `c/a0 = 0.7`, on 50 springs that suit every stepper.
fn scene(tau_per_cycle: f64) -> Case {
    Case { clustering: Clustering::Quadratic, tau_per_cycle, ..Case::new(2.0, 0.0, 0.7, 50) }
}

fn steppers() -> [(&'static str, Box<dyn Stepper + Send>); 4] {
    [
        ("every-cycle", Box::<EveryCycle>::default()),
        ("cycle-jump", Box::<CycleJump>::default()),
        ("implicit", Box::new(Sdirk::new(TOLERANCE))),
        ("multistep", Box::new(Bdf::new(TOLERANCE))),
    ]
}

#[test]
fn all_steppers_agree_over_twenty_thousand_cycles() {
    let outputs = [667.0, 2000.0, 6667.0, 20_000.0];
    let case = scene(30.0 / 20_000.0);
    let scale = case.model().depth_scale();
    let reference = case.run(Box::new(Sdirk::new(1e-8)), 1e-8, &outputs);
    // Measured: 7.5e-5, the first order in the wear of one cycle; 1.9e-6; 1.6e-6.
    for ((name, stepper), allowed) in steppers().into_iter().zip([5e-4, 1e-5, 1e-5, 5e-5]) {
        let seen = case.run(stepper, TOLERANCE, &outputs);
        let cycles: Vec<f64> = seen.iter().map(|seen| seen.state.cycles).collect();
        assert_eq!(cycles, outputs, "{name}");
        for (now, exact) in seen.iter().zip(&reference) {
            let error = distance(&now.wear_depth, &exact.wear_depth) / scale;
            let volume = now.wear_volume / exact.wear_volume - 1.0;
            assert!(
                error < allowed && volume.abs() < 10.0 * allowed,
                "{name}, cycle {}: depth {error:e}, volume {volume:e}",
                now.state.cycles
            );
        }
        for pair in seen.windows(2) {
            let lost =
                pair[0].wear_depth.iter().zip(&pair[1].wear_depth).fold(0.0, |m: f64, (a, b)| m.max(a - b));
            assert!(lost <= 0.1 * TOLERANCE * scale, "{name}, cycle {}: lost {lost:e}", pair[1].state.cycles);
        }
        if ["implicit", "multistep"].contains(&name) {
            // Measured: 128 and 133.
            assert!(seen[3].steps < 250, "{name}: {} steps", seen[3].steps);
        }
    }
}

#[test]
fn every_cycle_differs_from_the_continuous_wear_by_the_first_order_in_one_cycle() {
    let depth_after = |cycles: f64, stepper: Box<dyn Stepper + Send>, tolerance: f64| -> Seen {
        scene(3.0 / cycles).run(stepper, tolerance, &[cycles]).pop().unwrap()
    };
    let exact = depth_after(1.0, Box::new(Sdirk::new(1e-9)), 1e-9);
    let errors = [2000.0, 4000.0, 8000.0].map(|cycles| {
        let seen = depth_after(cycles, Box::<EveryCycle>::default(), TOLERANCE);
        distance(&seen.wear_depth, &exact.wear_depth) / scene(1.0).model().depth_scale()
    });
    assert!(
        support::orders(&errors).iter().all(|order| (order - 1.0).abs() < 0.05),
        "errors {errors:?}, orders {:?}",
        support::orders(&errors)
    );
}

#[test]
fn a_cycle_that_is_too_coarse_ends_in_a_clear_error_and_leaves_the_last_good_state() {
    let plan = Plan { outputs: vec![30.0], end: End::Cycles(30.0) };
    let mut simulation = scene(1.0).simulation(Box::<EveryCycle>::default(), TOLERANCE, plan);
    let message = simulation.run(&mut []).unwrap_err().to_string();
    assert!(message.contains("every-cycle") && message.contains("too coarse"), "{message}");
    let fields = simulation.fields();
    assert!(fields.are_physical() && simulation.wear_depth().iter().all(|w| w.is_finite()), "{fields:?}");
}

/// Stops after a number of steps.
struct StopAfter(u64);

impl Observer for StopAfter {
    fn step(&mut self, simulation: &Simulation) -> fretwear::Result<Flow> {
        Ok(if simulation.progress().steps == self.0 { Flow::Stop } else { Flow::Continue })
    }
}

#[test]
fn a_resumed_run_repeats_every_bit_of_one_without_interruption() {
    let case = scene(1e-3);
    let plan = Plan { outputs: vec![100.0, 333.0, 500.0, 1000.0], end: End::Cycles(1000.0) };
    for index in 0..4 {
        let stepper = || steppers().into_iter().nth(index).unwrap();
        let (name, first) = stepper();
        let mut whole = case.simulation(first, TOLERANCE, plan.clone());
        let mut expected = Record::default();
        assert_eq!(whole.run(&mut [&mut expected]).unwrap(), Outcome::End);
        for stop in [1, 7, whole.progress().steps - 2] {
            let mut seen = Record::default();
            let mut before = case.simulation(stepper().1, TOLERANCE, plan.clone());
            let outcome = before.run(&mut [&mut seen, &mut StopAfter(stop)]).unwrap();
            assert_eq!(outcome, Outcome::Interrupted, "{name} after {stop} steps");
            let (state, progress): (_, Progress) = (before.state().clone(), *before.progress());
            let mut after =
                Simulation::resume(case.model(), stepper().1, TOLERANCE, plan.clone(), state, progress);
            assert_eq!(after.run(&mut [&mut seen]).unwrap(), Outcome::End);
            assert_eq!(seen.0, expected.0, "{name}, interrupted after {stop} steps");
            assert_eq!(after.progress(), whole.progress(), "{name}, interrupted after {stop} steps");
        }
    }
}

#[test]
fn backward_differentiation_gives_about_the_error_asked_for_in_a_number_of_steps_that_grows_slowly() {
    let outputs: Vec<f64> = (0..14).map(|i| 30.0 * 0.5f64.powi(13 - i)).collect();
    let case = Case { clustering: Clustering::Smooth, ..scene(1.0) };
    let reference = case.run(Box::new(Bdf::new(1e-10)), 1e-10, &outputs);
    let scale = case.model().depth_scale();
    let found = [1e-4, 1e-6, 1e-8].map(|tolerance| {
        let seen = case.run(Box::new(Bdf::new(tolerance)), tolerance, &outputs);
        let pairs = seen.iter().zip(&reference);
        let error = pairs
            .fold(0.0, |m: f64, (now, exact)| m.max(distance(&now.wear_depth, &exact.wear_depth) / scale));
        (tolerance, error, seen[13].steps)
    });
    for (tolerance, error, _) in found {
        assert!((0.1..3.0).contains(&(error / tolerance)), "{found:?}");
    }
    // Of order 5, a hundredth of the error takes 2.5 times the steps; at lower orders 4.6 (3) or 10 (2).
    for pair in found.windows(2) {
        assert!((pair[1].2 as f64) < 2.6 * pair[0].2 as f64, "{found:?}");
    }
}

#[test]
fn snapshots_cost_backward_differentiation_no_steps() {
    let steps = |count: i32| {
        let outputs: Vec<f64> = (1..=count).map(|i| 30.0 * f64::from(i) / f64::from(count)).collect();
        let seen = scene(1.0).run(Box::new(Bdf::new(TOLERANCE)), TOLERANCE, &outputs);
        assert_eq!(seen.len(), outputs.len());
        seen[seen.len() - 1].steps
    };
    assert_eq!(steps(1), steps(500));
}
