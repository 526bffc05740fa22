//! Fretting loops of worn and unworn contacts.

mod support;

use fretwear::model::Model;
use fretwear::stepper::Implicit;
use support::{Case, orders};

/// Displacements of a loop of `2 half` equal steps.
fn displacements(model: &Model, half: usize) -> Vec<f64> {
    let amplitude = model.contact().amplitude();
    let down = |i: usize| amplitude * (1.0 - 2.0 * i as f64 / half as f64);
    (0..=2 * half).map(|i| down(i.min(2 * half - i))).collect()
}

fn cases() -> [Case; 3] {
    [Case::new(2.0, 0.0, 0.7, 100), Case::new(1.0, -0.4, 0.5, 100), Case::new(2.0, 0.6, 0.3, 100)]
}

#[test]
fn first_loading_is_that_of_ciavarella_and_jaeger() {
    // F_x(u) = μ_f [F_N(d) - F_N(d - M u/μ_f)], here with μ_f = M = c_N = 1
    for case in cases() {
        let error = |springs: usize| {
            let case = Case { springs, ..case };
            let model = case.model();
            let state = model.initial_state().unwrap();
            let fields = model.fields(&state);
            let contact = model.contact();
            let (profile, d) = (contact.equivalent_profile(), contact.indentation());
            let load = |depth: f64| profile.load_integral(profile.radius_at(depth).unwrap());
            [0.1, 0.5, 0.9, 1.0].iter().fold(0.0, |worst: f64, part| {
                let u = part * contact.amplitude();
                let found = model.tangential_force(&fields, &state.compression, u);
                worst.max((found / (load(d) - load(d - u)) - 1.0).abs())
            })
        };
        let errors = [50, 100, 200, 400].map(error);
        let mean_order = (errors[0] / errors[3]).log2() / 3.0;
        println!("{case:?}: {errors:?}, order {mean_order:.2}");
        // The integrand has a kink where slip begins, somewhere within a cell.
        assert!(errors[1] < 1e-4 && mean_order > 1.7, "{case:?}: {errors:?}, order {mean_order}");
    }
}

#[test]
fn the_area_of_a_loop_is_the_energy_of_a_cycle_at_every_wear() {
    for case in cases() {
        for tau in [0.3, 3.0, 20.0] {
            let seen = case.run(Box::new(Implicit::new(1e-4)), 1e-4, &[tau]);
            let model = case.model();
            let state = &seen[0].state;
            let fields = model.fields(state);
            let energy = model.dissipation(&fields, &state.compression);
            let area = |half: usize| {
                let u = displacements(&model, half);
                let force = model.fretting_loop(&fields, &state.compression, &u);
                assert!(
                    (force[half] + force[0]).abs() < 1e-12 * force[0]
                        && (force[2 * half] - force[0]).abs() < 1e-12 * force[0]
                );
                let trapezoids = (0..2 * half).map(|i| 0.5 * (force[i] + force[i + 1]) * (u[i + 1] - u[i]));
                trapezoids.sum::<f64>()
            };
            let errors: Vec<f64> =
                [100, 400, 1600, 6400].iter().map(|&half| (area(half) / energy - 1.0).abs()).collect();
            let found = orders(&errors);
            println!("{case:?}, τ = {tau}: {errors:?}, orders per fourfold {found:.2?}");
            // The trapezoidal rule is of second order, 4 per fourfold; the loop's energy is that of the same springs.
            assert!(errors[3] < 1e-5, "{case:?}, τ = {tau}: {errors:?}");
            assert!(errors[0] / errors[3] > 1e3, "{case:?}, τ = {tau}: {errors:?}");
        }
    }
}

#[test]
fn a_worn_out_contact_is_moved_by_its_stick_zone_alone() {
    let case = Case::new(2.0, 0.0, 0.7, 100);
    let seen = case.run(Box::new(Implicit::new(1e-4)), 1e-4, &[40.0]);
    let model = case.model();
    let fields = model.fields(&seen[0].state);
    let (u, c) = (model.contact().amplitude(), 0.7);
    let force = model.tangential_force(&fields, &seen[0].state.compression, u);
    // 2 c_T u c^(1+k)/(1+k)
    assert!((force / (2.0 * u * c) - 1.0).abs() < 1e-4, "{force}");
    let energy = model.dissipation(&fields, &seen[0].state.compression);
    assert!(energy < 1e-3 * force * u, "{energy}");
}
