//! Wear on its way to the limit: reference volumes, observed orders, the energy balance, and the Gibson medium.

mod support;

use fretwear::contact::closed_form::{GibsonTransient, gibson_wear_volume};
use fretwear::numerics::grid::Clustering;
use fretwear::solver::model::State;
use fretwear::solver::stepper::{CycleJump, Sdirk, Stepper};
use support::{Case, Seen, distance, orders};

const TAUS: [f64; 3] = [1.0, 3.0, 10.0];

/// Paraboloid on a homogeneous half-space, `c/a0 = 0.7`.
fn paraboloid(springs: usize) -> Case {
    Case::new(2.0, 0.0, 0.7, springs).smooth()
}

fn run(case: Case, taus: &[f64]) -> Vec<Seen> {
    case.run(Box::new(Sdirk::new(1e-8)), 1e-8, taus)
}

/// `ΔV/(a0² d)` by boundary-element codes of the three-dimensional half-space, which know nothing of the springs.
#[test]
fn the_worn_volume_agrees_with_boundary_elements() {
    let case = paraboloid(60);
    let seen = case.run(Box::new(Sdirk::new(1e-6)), 1e-6, &[1.0, 3.0, 10.0, 30.0]);
    for (seen, reference) in seen.iter().zip([0.0268731, 0.0830288, 0.213381, 0.235817]) {
        let volume = seen.wear_volume / case.indentation();
        let error = volume / reference - 1.0;
        // Measured with 60 springs: 4.6e-6; the references carry six digits.
        assert!(error.abs() < 5e-5, "τ = {}: {volume}, not {reference}: {error:e}", seen.state.cycles);
    }
}

#[test]
fn volume_and_profile_converge_and_the_energy_balances_as_springs_are_doubled() {
    const FINEST: usize = 120;
    let counts = [12, 24, 48];
    let reference = run(paraboloid(FINEST), &TAUS);
    let runs = counts.map(|springs| run(paraboloid(springs), &TAUS));
    for (at, tau) in TAUS.into_iter().enumerate() {
        let exact = &reference[at];
        let deepest = exact.wear_depth.iter().fold(0.0, |m: f64, w| m.max(*w));
        let volumes: Vec<f64> =
            runs.iter().map(|run| (run[at].wear_volume / exact.wear_volume - 1.0).abs()).collect();
        let profile = |run: &Vec<Seen>| distance(&run[at].depth_at_parts, &exact.depth_at_parts) / deepest;
        let profiles: Vec<f64> = runs.iter().map(profile).collect();
        // μ_f = 1, and the wear coefficient turns energy into volume.
        let coefficient = paraboloid(8).contact().wear().coefficient;
        let balance = |run: &Vec<Seen>| {
            (run[at].state.dissipated_energy * coefficient / run[at].wear_volume - 1.0).abs()
        };
        let balances: Vec<f64> = runs.iter().map(balance).collect();
        for (name, errors, least) in
            [("volume", &volumes, 3.5), ("profile", &profiles, 3.5), ("energy balance", &balances, 2.0)]
        {
            // Measured over the doublings: volume 4.8 to 6.2, profile 4.7 to 5.2, balance 2.7 to 5.9.
            let mean = (errors[0] / errors[2]).log2() / 2.0;
            assert!(
                mean >= least,
                "τ = {tau}, {name}: errors {errors:?} with {counts:?} springs, orders {:?}",
                orders(errors)
            );
        }
    }
}

/// Relative errors of the worn volume after equal steps from `τ = 0.5` to `1.5`, against eight times the most steps.
fn errors_in_time(case: Case, stepper: &mut dyn Stepper, steps: &[usize]) -> Vec<f64> {
    let model = case.model();
    let start = run(case, &[0.5]).pop().unwrap().state;
    let march = |stepper: &mut dyn Stepper, count: usize| -> f64 {
        let mut state: State = start.clone();
        for _ in 0..count {
            state = stepper.step(&model, &state, 1.0 / count as f64).unwrap().state.expect("a contact");
        }
        model.wear_volume(&model.fields(&state))
    };
    let exact = march(stepper, 8 * steps[steps.len() - 1]);
    steps.iter().map(|count| (march(stepper, *count) / exact - 1.0).abs()).collect()
}

fn few_springs() -> Case {
    Case { clustering: Clustering::Quadratic, ..paraboloid(12) }
}

fn assert_orders(errors: &[f64], range: std::ops::Range<f64>) {
    let orders = orders(errors);
    assert!(orders.iter().all(|order| range.contains(order)), "errors {errors:?}, orders {orders:?}");
}

/// Of second order as observed, one below that of the Runge-Kutta method it is built on.
#[test]
fn the_implicit_stepper_is_of_second_order() {
    // Measured: 1.98, 2.00 on few springs, 1.9, 2.1, 2.2 on a stiff mesh.
    assert_orders(&errors_in_time(few_springs(), &mut Sdirk::new(1e-12), &[80, 160, 320]), 1.9..2.1);
    assert_orders(&errors_in_time(paraboloid(30), &mut Sdirk::new(1e-12), &[8, 16, 32, 64]), 1.8..2.4);
}

#[test]
fn the_cycle_jump_is_of_third_order() {
    // Measured: 3.02, 3.01.
    let errors = errors_in_time(few_springs(), &mut CycleJump::default(), &[40, 80, 160]);
    assert_orders(&errors, 2.9..3.1);
}

/// As `k → 1` every radius wears on its own:
///
/// ```text
/// (f - f_c)/(d - f) = (f0 - f_c)/(d - f0) exp[(1 - f_c/d) τ/π]
/// ```
///
/// with lengths in `a0` and depths in `d`, which there is the paraboloid's height at `a0`.
#[test]
fn a_gibson_medium_follows_the_logistic_curve() {
    /// Height of the paraboloid at the stick radius.
    const F_C: f64 = 0.49;
    let mut distances: Vec<Vec<f64>> = vec![];
    for grading in [0.9, 0.99, 0.999, 0.9999] {
        let case = Case::new(2.0, grading, 0.7, 100);
        let d = case.indentation();
        let model = case.model();
        let (contact, radii, offsets) = (case.contact(), model.radii(), model.offsets());
        let off = |seen: &Seen| {
            let growth = ((1.0 - F_C) * seen.state.cycles / std::f64::consts::PI).exp();
            let nodes = radii.iter().zip(&offsets).zip(&seen.wear_depth);
            let inside = nodes.filter(|((_, offset), _)| **offset < contact.slip_area_offset());
            inside.fold(0.0, |largest: f64, ((r, _), w)| {
                let f0 = r * r;
                let odds = (f0 - F_C) / (1.0 - f0) * growth;
                largest.max((f0 + w / d - (F_C + odds) / (1.0 + odds)).abs())
            })
        };
        let seen = case.run(Box::new(Sdirk::new(1e-7)), 1e-7, &[1.0, 3.0]);
        distances.push(seen.iter().map(off).collect());
    }
    // Measured: 9.46e-4, 9.30e-5, 9.28e-6, 9.28e-7 at τ = 1 and 2.52e-3, 2.48e-4, 2.47e-5, 2.48e-6 at τ = 3.
    for (at, tau) in [1.0, 3.0].into_iter().enumerate() {
        let ratios: Vec<f64> = distances.windows(2).map(|pair| pair[0][at] / pair[1][at]).collect();
        assert!(
            ratios.iter().all(|ratio| (9.5..10.5).contains(ratio)),
            "τ = {tau}: distances {distances:?}, ratios {ratios:?}"
        );
    }
}

#[test]
fn the_gibson_transient_obeys_its_equation_and_tends_to_the_limit() {
    let case = Case::new(2.0, 1.0 - 1e-9, 0.7, 3);
    let contact = case.contact();
    let transient = GibsonTransient::from_contact(&contact).unwrap().expect("it slips");
    let d = contact.indentation();
    let (r, tau, step) = (0.85_f64, 2.0, 1e-4);
    let f = |tau: f64| r * r + transient.wear_depth(r, tau) / d;
    let rate = (f(tau + step) - f(tau - step)) / (2.0 * step);
    let expected = (1.0 - f(tau)) * (f(tau) - 0.49) / std::f64::consts::PI;
    // Measured: 2e-10, the difference quotient's own error.
    assert!((rate / expected - 1.0).abs() < 2e-9, "{rate} {expected}");
    assert_eq!([0.6, contact.stick_radius().unwrap(), 1.1].map(|r| transient.wear_depth(r, 1e3)), [0.0; 3]);
    assert_eq!(transient.wear_depth(0.85, 0.0), 0.0);
    let limit = std::f64::consts::PI * d * gibson_wear_volume(2.0, contact.slip_compression() / d);
    let gaps = [50.0, 100.0, 150.0].map(|tau| (transient.wear_volume(tau) / limit - 1.0).abs());
    // Measured: 4.3e-3, 2.7e-6, 2.2e-10.
    assert!(gaps[0] < 6e-3 && gaps[1] < 4e-6 && gaps[2] < 1e-9, "{gaps:?}");
}
