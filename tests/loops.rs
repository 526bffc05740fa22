//! Fretting loops of worn and unworn contacts.

mod support;

use std::sync::Arc;

use fretwear::laws::conditions::Conditions;
use fretwear::laws::friction::{FrictionLaw, LoadDependent, StaticKinetic};
use fretwear::laws::loading::TangentialControl;
use fretwear::laws::motion::{Mode, NormalOscillation, Orbit, RecordedPath};
use fretwear::numerics::grid::Clustering;
use fretwear::numerics::quadrature::Rule;
use fretwear::solver::model::{
    AmplitudeControl, FrettingLoop, Model, OperatorStore, Resolution, Schedule, State,
};
use fretwear::solver::simulation::{End, Plan, Simulation};
use fretwear::solver::stepper::Sdirk;
use support::{Case, Record, Seen, distance, orders};

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
            let seen = case.run(Box::new(Sdirk::new(1e-4)), 1e-4, &[tau]);
            let model = case.model();
            let state = &seen[0].state;
            let fields = model.fields(state);
            let energy = model.dissipation(&fields, &state.compression);
            let area = |half: usize| {
                let u = displacements(&model, half);
                let force = model.fretting_loop(&fields, &state.compression, &u[..=half]);
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
    let seen = case.run(Box::new(Sdirk::new(1e-4)), 1e-4, &[40.0]);
    let model = case.model();
    let fields = model.fields(&seen[0].state);
    let (u, c) = (model.contact().amplitude(), 0.7);
    let force = model.tangential_force(&fields, &seen[0].state.compression, u);
    // 2 c_T u c^(1+k)/(1+k)
    assert!((force / (2.0 * u * c) - 1.0).abs() < 1e-4, "{force}");
    let energy = model.dissipation(&fields, &seen[0].state.compression);
    assert!(energy < 1e-3 * force * u, "{energy}");
}

fn under(case: &Case, conditions: &Conditions, substeps: usize) -> Model {
    let contact = case.contact();
    let resolution = Resolution { resolved: false, substeps: Some(substeps) };
    let schedule = Schedule::new(&contact, conditions, resolution).unwrap();
    Model::under(&contact, schedule, case.springs, case.clustering, &OperatorStore::default()).unwrap()
}

/// The loop of the cycle that begins in a state, with the energy of its period.
fn loop_and_energy(model: &Model, state: &State, steps: usize) -> (FrettingLoop, f64) {
    let fields = model.fields(state);
    let loading = model.loading_in(state, model.schedule().loading(state.cycles, state.cycles));
    let cycle = model.cycle(&loading, &state.compression, &fields);
    let found = model.cycle_loop(&loading, &cycle, &state.compression, &fields, steps);
    (found, cycle.dissipation * loading.cycles_per_period)
}

/// As all the modes below are run: a force that stick can bear to the end.
const CASE: Case = Case {
    exponent: 2.0,
    grading: 0.2,
    stick_ratio: 0.9,
    springs: 24,
    clustering: Clustering::Cubic,
    tau_per_cycle: 1.0,
};

fn modes() -> Vec<(&'static str, Conditions)> {
    let case = CASE;
    let contact = case.contact();
    let (d, amplitude) = (contact.indentation(), contact.amplitude());
    let plain = Conditions::plain(*contact.friction(), *contact.wear());
    let with_friction = |friction: Arc<dyn FrictionLaw>| Conditions { friction, ..plain.clone() };
    let with_mode = |mode: Arc<dyn Mode>| Conditions { mode, ..plain.clone() };
    let control = |tangential_control| Conditions { tangential_control, ..plain.clone() };
    let rows = vec![0.0, amplitude, 0.3 * amplitude, -0.4 * amplitude];
    let across = vec![0.0, 0.1 * amplitude, 0.7 * amplitude, 0.2 * amplitude];
    let depth = vec![0.0, 0.1 * d, 0.0, 0.05 * d];
    let path = RecordedPath::new("four corners", rows, across, depth).unwrap();
    vec![
        ("plain", plain.clone()),
        (
            "load-dependent",
            with_friction(Arc::new(LoadDependent { coefficient: 1.0, exponent: -0.3, reference: d })),
        ),
        (
            "static and kinetic",
            with_friction(Arc::new(StaticKinetic { static_coefficient: 1.0, kinetic_coefficient: 0.8 })),
        ),
        ("force", control(TangentialControl::Force)),
        ("rig", control(TangentialControl::Rig { stiffness: 5.0 })),
        (
            "normal oscillation",
            with_mode(Arc::new(NormalOscillation {
                amplitude: 0.2 * d,
                frequency_ratio: [3, 2],
                phase: 0.6,
            })),
        ),
        (
            "orbit",
            with_mode(Arc::new(Orbit {
                transverse_amplitude: 0.5 * amplitude,
                phase: 0.3,
                centre: [0.0; 2],
            })),
        ),
        (
            "orbit off its centre",
            with_mode(Arc::new(Orbit {
                transverse_amplitude: 0.5 * amplitude,
                phase: 0.0,
                centre: [0.3 * amplitude, 0.1 * amplitude],
            })),
        ),
        ("recorded path", with_mode(Arc::new(path))),
    ]
}

/// The springs' work is the energy to round-off, and the drawn loop's area tends to it at second order.
#[test]
fn the_area_of_the_loop_of_every_mode_is_the_energy_of_its_period() {
    let case = CASE;
    for (name, conditions) in modes() {
        let errors = [48, 192, 768].map(|steps| {
            let model = under(&case, &conditions, steps);
            let state = model.initial_state().unwrap();
            let (found, energy) = loop_and_energy(&model, &state, steps);
            let balance = found.work / energy - 1.0;
            match name {
                "static and kinetic" => {}
                // What the cycle takes from its table of springs that go round, the loop has from the springs themselves; measured 2e-6.
                "orbit" | "orbit off its centre" => assert!(balance.abs() < 2e-5, "{name}: {balance:e}"),
                // Along a line the work of a spring is its energy; of a spring that goes round, once it repeats itself.
                _ => assert!(balance.abs() < 1e-9, "{name}: {balance:e}"),
            }
            (found.area() / found.work - 1.0).abs()
        });
        println!("{name}: {errors:?}");
        let worst = errors[0].max(1e-2);
        assert!(errors[2] < worst / 50.0, "{name}: {errors:?}");
    }
}

#[test]
fn jumps_from_static_to_kinetic_friction_lose_what_they_are_to() {
    // (μ_s - μ_k)² q²/(2M) at two jumps a cycle, here with μ_s = M = c_N = 1
    let case = Case { springs: 200, ..CASE };
    let (_, conditions) = modes().into_iter().find(|(name, _)| *name == "static and kinetic").unwrap();
    let model = under(&case, &conditions, 64);
    let (found, energy) = loop_and_energy(&model, &model.initial_state().unwrap(), 64);
    let contact = model.contact();
    let (d, profile) = (contact.indentation(), contact.equivalent_profile());
    let (low, high) = (CASE.stick_ratio.powf(1.2), 1.0);
    let squared = |part: f64| (d - profile.value((low + (high - low) * part).powf(1.2_f64.recip()))).powi(2);
    let integral = (high - low) / 1.2 * Rule::legendre(40).unwrap().mean(squared);
    let expected = 2.0 * 0.2_f64.powi(2) * integral;
    let lost = found.work - energy;
    assert!((lost / expected - 1.0).abs() < 1e-4, "{lost:e}, expected {expected:e}");
}

#[test]
fn a_held_force_is_the_force_of_every_loop() {
    let case = CASE;
    let (_, conditions) = modes().into_iter().find(|(name, _)| *name == "force").unwrap();
    let model = under(&case, &conditions, 64);
    let AmplitudeControl::Force(asked) = model.schedule().loading(0.0, 0.0).control else {
        panic!("no force")
    };
    let plan = Plan { outputs: vec![0.5, 3.0, 20.0], end: End::Cycles(20.0) };
    let mut simulation = Simulation::new(model, Box::new(Sdirk::new(1e-4)), 1e-4, plan).unwrap();
    let mut seen = Record::default();
    simulation.run(&mut [&mut seen]).unwrap();
    let first = simulation.model().contact().amplitude();
    for Seen { state, .. } in &seen.0 {
        let (found, _) = loop_and_energy(simulation.model(), state, 64);
        let force = found.largest_force();
        // Measured: 2e-13 at most.
        assert!((force / asked - 1.0).abs() < 2e-12, "{}: {force}, held {asked}", state.cycles);
        // The contact gives way, so that the same force moves it farther.
        assert!(found.displacement[0][0] > 1.001 * first, "{}", state.cycles);
    }
}

/// The two ways to the same loop: Masing's rule and the springs themselves.
#[test]
fn the_loop_of_a_resolved_plain_cycle_is_that_of_masing() {
    let case = Case::new(2.0, 0.2, 0.6, 24);
    let contact = case.contact();
    let conditions = Conditions::plain(*contact.friction(), *contact.wear());
    let resolution = Resolution { resolved: true, substeps: None };
    let schedule = Schedule::new(&contact, &conditions, resolution).unwrap();
    let resolved =
        Model::under(&contact, schedule, case.springs, case.clustering, &OperatorStore::default()).unwrap();
    let plain = case.model();
    let state = plain.initial_state().unwrap();
    let [(found, _), (expected, _)] = [&resolved, &plain].map(|model| loop_and_energy(model, &state, 64));
    let largest = expected.largest_force();
    assert_eq!(found.displacement, expected.displacement);
    for axis in 0..2 {
        let difference = distance(&found.force[axis], &expected.force[axis]) / largest;
        assert!(difference < 1e-13, "{difference:e}");
    }
    assert!((found.work / expected.work - 1.0).abs() < 1e-12);
}
