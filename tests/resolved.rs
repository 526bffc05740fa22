//! Periods passed step by step against their closed form, and their energies.

mod support;

use faer::Mat;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use fretwear::contact::spring::{Neighbours, Response, Shakedown, SpringCycle, Steps, steady_cycle};
use fretwear::laws::conditions::Conditions;
use fretwear::laws::friction::Coulomb;
use fretwear::laws::motion::{NormalOscillation, Orbit, SampledPath};
use fretwear::numerics::grid::Clustering;
use fretwear::solver::model::{Model, State};
use fretwear::solver::simulation::{End, Plan, Simulation};
use fretwear::solver::stepper::{CycleJump, EveryCycle, Sdirk, Stepper};
use support::{Case, distance, laws, orders};

const MEDIA: [(f64, f64); 3] = [(2.0, 0.0), (1.0, -0.3), (2.0, 0.5)];

/// States of a model at some times.
fn states(model: &Model, times: &[f64]) -> Vec<State> {
    let mut found = vec![model.initial_state().unwrap()];
    for time in times {
        let plan = Plan { outputs: vec![*time], end: End::Cycles(*time) };
        let mut simulation = Simulation::new(model.clone(), Box::new(Sdirk::new(1e-3)), 1e-3, plan).unwrap();
        simulation.run(&mut []).unwrap();
        found.push(simulation.state().clone());
    }
    found
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m: f64, value| m.max(value.abs()))
}

#[test]
fn a_resolved_tangential_cycle_is_the_closed_form_for_any_number_of_substeps() {
    let mut worst = 0.0_f64;
    for (exponent, grading) in MEDIA {
        let case = Case::new(exponent, grading, 0.7, 30);
        let contact = case.contact();
        let wear = laws::wear_laws(&contact).into_iter().chain(laws::other_wear_laws(&contact));
        let wear: Vec<_> = wear.collect();
        for (friction_name, friction) in laws::friction_laws(&contact) {
            let closed = Conditions { friction, ..laws::plain(&contact) };
            let states = states(&laws::model(&case, &closed, None), &[0.5, 3.0, 10.0]);
            for substeps in [2, 3, 5, 16, 64, 200] {
                for (wear_name, law) in &wear {
                    let conditions = Conditions { wear: Arc::clone(law), ..closed.clone() };
                    let [one, other] =
                        [None, Some(substeps)].map(|substeps| laws::model(&case, &conditions, substeps));
                    for state in &states {
                        let fields = other.fields(state);
                        let [exact, resolved] = [&one, &other].map(|model| {
                            other.cycle(&model.schedule().loading(0.0, 0.0), &state.compression, &fields)
                        });
                        // Next to the edge of stick a difference of nearly equal numbers is divided by itself; the depth is not.
                        let [depth, resolved_depth] = [&exact, &resolved].map(|cycle| -> Vec<f64> {
                            cycle.growth.iter().zip(&fields.slip_depth).map(|(g, s)| g * s).collect()
                        });
                        let errors = [
                            distance(&depth, &resolved_depth) / largest(&depth),
                            0.1 * distance(&exact.growth, &resolved.growth) / largest(&exact.growth),
                            distance(&exact.slip, &resolved.slip) / largest(&exact.slip),
                            resolved.dissipation / exact.dissipation - 1.0,
                            resolved.work / exact.work - 1.0,
                            resolved.volume / exact.volume - 1.0,
                        ];
                        worst = worst.max(largest(&errors));
                        assert!(
                            largest(&errors) < 1e-11,
                            "n = {exponent}, k = {grading}, {friction_name}, {wear_name}, {substeps} substeps, τ = {}: {errors:?}",
                            state.cycles
                        );
                    }
                }
            }
        }
    }
    println!("resolved against closed form: {worst:e}");
}

/// Every mode under every law that it may have.
fn all_conditions(case: &Case) -> Vec<(String, Conditions)> {
    let contact = case.contact();
    let mut all = vec![];
    for (mode_name, mode) in laws::modes(&contact) {
        for (friction_name, friction) in laws::friction_laws(&contact) {
            let wear = laws::wear_laws(&contact).into_iter().chain(laws::other_wear_laws(&contact));
            // Energy is a matter of friction, the rest of wear.
            for (wear_name, wear) in wear.take(if friction_name == "Coulomb" { 8 } else { 2 }) {
                let conditions = Conditions {
                    mode: mode.clone(),
                    friction: Arc::clone(&friction),
                    wear,
                    ..laws::plain(&contact)
                };
                all.push((format!("{mode_name}, {friction_name}, {wear_name}"), conditions));
            }
        }
    }
    all
}

/// Compressions as in the middle of a run, inside the edge of the unworn contact.
fn some_compression(model: &Model) -> State {
    let mut state = model.initial_state().unwrap();
    let springs = model.springs() as f64;
    for (j, q) in state.compression.iter_mut().enumerate() {
        *q *= 1.0 - 0.4 * (j as f64 / springs);
    }
    state
}

/// The same, swinging about what they are next to the edge of stick: one of the springs pulls.
fn swinging_compression(model: &Model) -> State {
    let mut state = some_compression(model);
    for (q, part) in state.compression.iter_mut().zip([-0.1, 0.3, 0.8]) {
        *q *= part;
    }
    state
}

#[test]
fn work_of_the_drive_is_what_friction_and_jumps_take_in_every_mode_under_every_law() {
    let mut worst = 0.0_f64;
    let mut failed = vec![];
    for (exponent, grading) in MEDIA {
        let case = Case::new(exponent, grading, 0.7, 16);
        for (name, conditions) in all_conditions(&case) {
            let model = laws::model(&case, &conditions, None);
            let loading = model.schedule().loading(0.0, 0.0);
            for state in [model.initial_state().unwrap(), some_compression(&model)] {
                let cycle = model.cycle(&loading, &state.compression, &model.fields(&state));
                let error = (cycle.dissipation + cycle.jump_loss) / cycle.work - 1.0;
                worst = worst.max(error.abs());
                if !(cycle.work > 0.0 && error.abs() < 1e-9) {
                    failed.push(format!("k = {grading}, {name}: {error:e}"));
                }
            }
        }
    }
    println!("energy: {worst:e}");
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn slopes_of_growth_are_those_of_differences_in_every_mode_under_every_law() {
    let case = Case::new(2.0, 0.3, 0.7, 16);
    let mut worst = 0.0_f64;
    let mut failed = vec![];
    for (name, conditions) in all_conditions(&case) {
        let model = laws::model(&case, &conditions, None);
        let loading = model.schedule().loading(0.0, 0.0);
        let mut states = vec![("pressing", some_compression(&model))];
        // Other laws have kinks where pressure does, and debris takes nothing for what pulls.
        if name.starts_with("normal") && !name.contains("non-local") {
            states.push(("swinging", swinging_compression(&model)));
        }
        for (state_name, state) in states {
            let fields = model.fields(&state);
            let cycle = model.cycle(&loading, &state.compression, &fields);
            let n = model.springs();
            let mut matrix = Mat::zeros(n, n);
            model.add_growth_slopes(&loading, &state.compression, &fields, &cycle, 1.0, &mut matrix);
            let growth = |slip_area: f64, compression: &[f64]| {
                let moved = State { slip_area, compression: compression.to_vec(), ..state.clone() };
                model.cycle(&loading, compression, &model.fields(&moved)).growth
            };
            let mut error = 0.0_f64;
            let mut whole = 0.0_f64;
            for j in 0..n {
                // Small enough to stay within a cell of the table of a path.
                let difference =
                    1e-6 * if j + 1 < n { model.contact().slip_compression() } else { state.slip_area };
                let at = |sign: f64| {
                    let (mut slip_area, mut compression) = (state.slip_area, state.compression.clone());
                    *compression.get_mut(j).unwrap_or(&mut slip_area) += sign * difference;
                    growth(slip_area, &compression)
                };
                let (before, after) = (at(-1.0), at(1.0));
                for i in 0..n {
                    let slope = (after[i] - before[i]) / (2.0 * difference);
                    error = error.max((matrix[(i, j)] - slope).abs());
                    whole = whole.max(slope.abs());
                }
            }
            worst = worst.max(error / whole);
            // Differences of 1e-6 leave 1e-4. On an orbit the slip turns with the compression, where slopes take its direction as given, and on a circle the
            // table has kinks as well.
            let allowed = match &name {
                name if name.starts_with("circle") => 3e-2,
                name if name.contains("ellipse") => 5e-3,
                _ => 5e-4,
            };
            if error > allowed * whole {
                failed.push(format!("{name}, {state_name}: {:e}", error / whole));
            }
        }
    }
    println!("slopes: {worst:e}");
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn every_cycle_resolved_differs_from_the_continuous_wear_by_the_first_order_in_one_cycle() {
    let case = |cycles: f64| Case {
        clustering: Clustering::Quadratic,
        tau_per_cycle: 3.0 / cycles,
        ..Case::new(2.0, 0.0, 0.7, 30)
    };
    let run = |cycles: f64, substeps: Option<usize>, stepper: Box<dyn Stepper + Send>, tolerance: f64| {
        let plan = Plan { outputs: vec![cycles], end: End::Cycles(cycles) };
        let case = case(cycles);
        let model = laws::model(&case, &laws::plain(&case.contact()), substeps);
        let mut simulation = Simulation::new(model, stepper, tolerance, plan).unwrap();
        simulation.run(&mut []).unwrap();
        (simulation.wear_depth(), simulation.model().depth_scale())
    };
    let (exact, scale) = run(1.0, None, Box::new(Sdirk::new(1e-9)), 1e-9);
    let errors = [1000.0, 2000.0, 4000.0]
        .map(|cycles| distance(&run(cycles, Some(5), Box::<EveryCycle>::default(), 1.0).0, &exact) / scale);
    println!("errors {errors:?}, orders {:?}", orders(&errors));
    assert!(
        orders(&errors).iter().all(|order| (order - 1.0).abs() < 0.05),
        "errors {errors:?}, orders {:?}",
        orders(&errors)
    );
}

#[test]
fn every_stepper_wears_alike_with_closed_and_with_resolved_cycles() {
    let per_cycle = 2e-3;
    let case =
        Case { clustering: Clustering::Quadratic, tau_per_cycle: per_cycle, ..Case::new(2.0, 0.0, 0.7, 12) };
    let contact = case.contact();
    let plain = laws::plain(&contact);
    let conditions = [
        ("Archard", plain.clone(), 80.0),
        ("energy", Conditions { wear: laws::wear_laws(&contact).remove(1).1, ..plain.clone() }, 80.0),
        ("s^0.5", Conditions { wear: laws::power(&contact, 1.0, 0.5), ..plain.clone() }, 80.0),
        (
            "static and kinetic",
            Conditions { friction: laws::friction_laws(&contact).remove(1).1, ..plain.clone() },
            80.0,
        ),
        (
            "load-dependent 0.3",
            Conditions { friction: laws::friction_laws(&contact).remove(3).1, ..plain.clone() },
            80.0,
        ),
    ];
    for (name, conditions, last) in conditions {
        let times = [1.0, 3.0, 10.0, last].map(|tau| tau / per_cycle);
        let run = |substeps: Option<usize>, stepper: Box<dyn Stepper + Send>, tolerance: f64| {
            let plan = Plan { outputs: times.to_vec(), end: End::Cycles(times[3]) };
            let model = laws::model(&case, &conditions, substeps);
            let mut seen = support::Record::default();
            let mut simulation = Simulation::new(model, stepper, tolerance, plan).unwrap();
            simulation.run(&mut [&mut seen]).unwrap();
            let limit = simulation.model().limit_depth();
            let scale = simulation.model().depth_scale();
            (seen.0, limit, scale)
        };
        let (exact, limit, scale) = run(None, Box::new(Sdirk::new(1e-8)), 1e-8);
        for substeps in [None, Some(3)] {
            let steppers: [(&str, Box<dyn Stepper + Send>, f64); 3] = [
                ("every-cycle", Box::<EveryCycle>::default(), 3e-3),
                ("cycle-jump", Box::<CycleJump>::default(), 1e-4),
                ("implicit", Box::new(Sdirk::new(1e-5)), 1e-4),
            ];
            for (stepper_name, stepper, allowed) in steppers {
                // Its first cycle takes more off next to the edge of stick than a slope can carry along.
                if name == "s^0.5" && stepper_name == "every-cycle" {
                    continue;
                }
                // An explicit method on a stiff problem keeps an error of its tolerance to the end.
                let tolerance = if stepper_name == "cycle-jump" { 1e-7 } else { 1e-5 };
                let (seen, _, _) = run(substeps, stepper, tolerance);
                let errors: Vec<f64> = seen
                    .iter()
                    .zip(&exact)
                    .map(|(now, exact)| distance(&now.wear_depth, &exact.wear_depth) / scale)
                    .collect();
                let missed = distance(&seen[3].wear_depth, &limit) / scale;
                println!("{name}, {stepper_name}, {substeps:?}: {errors:?} {missed:.1e}");
                assert!(
                    largest(&errors) < allowed && missed < 1e-6,
                    "{name}, {stepper_name}, substeps {substeps:?}: transient {errors:?}, limit {missed:e}"
                );
            }
        }
    }
}

/// Length of the slip that is given at nodes, x and y in turn: at one of a pair it may go against the other.
fn path_of(slip: &[f64], paired: bool) -> f64 {
    let node = |m: usize| [slip[2 * m], slip[2 * m + 1]];
    let along = |m: usize| {
        let ([x, y], [other_x, other_y]) = (node(m), node(if paired { m ^ 1 } else { m }));
        x.hypot(y) * if x * (x + other_x) + y * (y + other_y) < 0.0 { -1.0 } else { 1.0 }
    };
    (0..slip.len() / 2).map(along).sum()
}

#[test]
fn the_table_of_an_orbit_is_that_of_its_springs() {
    let case = Case::new(2.0, 0.0, 0.7, 20);
    let contact = case.contact();
    let amplitude = contact.amplitude();
    for (name, mode) in laws::modes(&contact).into_iter().skip(3) {
        let path = SampledPath::new(&*mode, amplitude, contact.indentation(), 96).path;
        let start = std::time::Instant::now();
        let table = Response::new(&path).unwrap();
        let built = start.elapsed();
        assert!(Response::new(&path).unwrap() == table, "{name}: another table");
        let law = *contact.friction();
        let mut cycle = SpringCycle::default();
        let mut slip = vec![0.0; table.columns()];
        let free: f64 = path.length();
        let (mut energy_error, mut path_error, mut periods) = (0.0_f64, 0.0_f64, 0);
        let mut times = 0.0;
        // Irrational steps, so that no limit is one of the table.
        for i in 0..2000 {
            let part = (0.618_033_988_75 * f64::from(i)).fract();
            // Also next to the edge of stick.
            let limit = amplitude * if i % 2 == 0 { part } else { 1.0 - 10f64.powf(-10.0 * part) };
            let start = std::time::Instant::now();
            steady_cycle(&path, &law, 1.0, limit, &Shakedown::default(), &mut cycle);
            times += start.elapsed().as_secs_f64();
            periods = periods.max(cycle.periods);
            let [dissipation, _] = table.at(limit, &mut slip, None);
            energy_error = energy_error.max((dissipation - cycle.dissipation).abs() / (amplitude * free));
            let total = path_of(&slip, table.is_paired());
            path_error = path_error.max((total - cycle.slip_path).abs() / free);
        }
        println!(
            "{name}: energy {energy_error:e}, path {path_error:e}, periods {periods}, built in {built:?}, direct {:e} s each",
            times / 2000.0
        );
        // Where slip begins within a step of one spring its path is of second order in the step.
        assert!(energy_error < 1e-4 && path_error < 1e-3, "{name}: {energy_error:e}, {path_error:e}");
    }
}

#[test]
fn springs_that_begin_near_the_ones_before_repeat_what_springs_from_rest_do() {
    let case = Case::new(2.0, 0.0, 0.7, 20);
    let contact = case.contact();
    let law = Coulomb { coefficient: 1.0 };
    for (name, mode) in laws::modes(&contact).into_iter().skip(3) {
        let path = SampledPath::new(&*mode, contact.amplitude(), contact.indentation(), 96).path;
        let mut springs = Neighbours::new(&path).unwrap();
        let [mut near, mut from_rest] = [(); 2].map(|()| SpringCycle::default());
        let mut worst = [0.0_f64; 2];
        for i in 1..200 {
            let limit = springs.sticking() * (1.0 - (1.0 - 0.005 * f64::from(i)).powi(2));
            springs.pass(limit, &mut near);
            steady_cycle(&path, &law, 1.0, limit, &Shakedown::default(), &mut from_rest);
            assert_eq!(near.deflection.len(), path.points.len(), "{name}");
            let [found, expected] = [&near, &from_rest].map(|it| it.deflection.concat());
            worst[0] = worst[0].max(distance(&found, &expected) / limit);
            worst[1] = worst[1].max((near.work / from_rest.work - 1.0).abs());
        }
        println!("{name}: {worst:?}");
        // Springs from rest next to the one that sticks may not have come to an end in their thousand periods.
        assert!(worst[0] < 1e-5 && worst[1] < 1e-5, "{name}: {worst:?}");
    }
}

#[test]
fn springs_through_steps_do_what_they_do_from_corner_to_corner() {
    let (amplitude, slope) = (2.0, 0.5);
    for (lift, ratio, phase) in
        [(0.1, [1, 1], 1.0), (0.3, [2, 1], 0.4), (1.5, [1, 1], 0.9), (3.0, [3, 2], 0.6), (2.5, [1, 2], 2.0)]
    {
        let mode = NormalOscillation { amplitude: lift, frequency_ratio: ratio, phase };
        let path = SampledPath::with_turns(&mode, amplitude, 2.0, 512, slope).path;
        let steps = Steps::new(path, 64, slope).unwrap();
        let law = Coulomb { coefficient: slope };
        let mut cycle = SpringCycle::default();
        let mut slip = vec![0.0; steps.columns()];
        let mut worst = [0.0_f64; 2];
        for i in 1..400 {
            let part = (0.618_033_988_75 * f64::from(i)).fract();
            // Half of them down to where springs touch for a moment only.
            let part = if i % 2 == 0 { part } else { 1e-9_f64.powf(part) };
            let compression = 8.0 * lift.max(amplitude) * part;
            steady_cycle(steps.path(), &law, 1.0, compression, &Shakedown::default(), &mut cycle);
            let passed = steps.pass(compression, &mut slip);
            let total: f64 = slip.chunks(2).map(|pair| (pair[0] + pair[1]).abs()).sum();
            let scale = amplitude;
            worst[0] =
                worst[0].max((total - cycle.slip_path).abs().max((passed.slip_path - total).abs()) / scale);
            worst[1] = worst[1].max((passed.dissipation - cycle.work).abs() / (scale * scale));
        }
        println!("{lift}, {ratio:?}: {worst:?}");
        assert!(worst[0] < 1e-12 && worst[1] < 1e-12, "{lift}, {ratio:?}: {worst:?}");
    }
}

/// Errors of the depth worn in a period, over the largest, by the substeps, against a finer period; and their mean order where substeps double.
fn errors_in_substeps(
    case: &Case,
    conditions: &Conditions,
    substeps: [usize; 4],
    finest: usize,
) -> (Vec<f64>, f64) {
    let depth = |substeps: usize| -> Vec<f64> {
        let model = laws::model(case, conditions, Some(substeps));
        let state = some_compression(&model);
        let fields = model.fields(&state);
        let cycle = model.cycle(&model.schedule().loading(0.0, 0.0), &state.compression, &fields);
        cycle.growth.iter().zip(&fields.slip_depth).map(|(growth, slip)| growth * slip).collect()
    };
    let finest = depth(finest);
    let errors = substeps.map(|substeps| distance(&depth(substeps), &finest) / largest(&finest)).to_vec();
    let mean = orders(&errors).iter().sum::<f64>() / 3.0;
    (errors, mean)
}

#[test]
fn the_wear_of_an_orbit_is_of_second_order_in_the_substeps() {
    for (transverse, phase) in [(0.6, 0.0), (0.7, 0.5), (1.0, FRAC_PI_2)] {
        let case = Case::new(2.0, 0.0, 0.7, 24);
        let contact = case.contact();
        let transverse_amplitude = transverse * contact.amplitude();
        let mode = Orbit { transverse_amplitude, phase, centre: [0.0; 2] };
        let conditions = Conditions { mode: Arc::new(mode), ..laws::plain(&contact) };
        let (errors, mean) = errors_in_substeps(&case, &conditions, [96, 192, 384, 768], 6144);
        println!("{transverse}, {phase}: {errors:?}, order {mean:.2}");
        // On a circle what the table leaves is more than what the substeps do.
        assert!(
            if transverse == 1.0 { errors[0] < 1e-4 } else { mean > 1.8 && errors[1] < 1e-3 },
            "{errors:?}: {mean}"
        );
    }
}

#[test]
fn the_wear_of_a_normal_oscillation_is_of_second_order_in_the_steps_at_least() {
    for (exponent, grading) in MEDIA {
        let case = Case::new(exponent, grading, 0.7, 24);
        let contact = case.contact();
        let mode =
            NormalOscillation { amplitude: 0.1 * contact.indentation(), frequency_ratio: [1, 1], phase: 1.0 };
        let conditions = Conditions { mode: Arc::new(mode), ..laws::plain(&contact) };
        let (errors, mean) = errors_in_substeps(&case, &conditions, [64, 128, 256, 512], 4096);
        println!("n = {exponent}, k = {grading}: {errors:?}, order {mean:.2}");
        assert!(mean > 1.9 && errors[1] < 1e-3, "{errors:?}: {mean}");
    }
}
