//! Hierarchical operators for many springs, judged by the dense ones and by the closed form.

use std::sync::Arc;

use assert_cmd::Command;
use faer::Mat;
use faer::traits::RealField;
use faer::traits::math_utils::from_f64;
use fretwear::contact::InitialContact;
use fretwear::contact::closed_form::LimitingShape;
use fretwear::laws::conditions::Conditions;
use fretwear::numerics::abel::{AbelOperators, Backend};
use fretwear::numerics::grid::{Clustering, Mesh};
use fretwear::numerics::linear::{Factors, Halves, HodlrFactors, LowRank, OffDiagonal};
use fretwear::scene::Scene;
use fretwear::solver::model::{Model, Past, State};
use fretwear::solver::simulation::{End, Flow, Observer, Outcome, Plan, Simulation};
use fretwear::solver::stepper::Bdf;

/// A compression with waves that vanishes at the contact edge.
fn compression(mesh: &Mesh) -> Vec<f64> {
    (1..mesh.cells())
        .map(|i| mesh.node(i))
        .map(|point| point.complement * (1.0 + 0.3 * (40.0 * point.value).sin()))
        .collect()
}

/// Largest difference between the backends, over the largest value, for depths and pressures.
fn differences(grading: f64, mesh: &Mesh) -> [f64; 2] {
    let [dense, hierarchical] = [Backend::Dense, Backend::Hierarchical]
        .map(|backend| AbelOperators::with(backend, grading, mesh.clone()).unwrap());
    let x = compression(mesh);
    std::array::from_fn(|which| {
        let mut values = [vec![0.0; mesh.cells()], vec![0.0; mesh.cells()]];
        dense.transforms()[which].apply(&x, &mut values[0]);
        hierarchical.transforms()[which].apply(&x, &mut values[1]);
        let largest = values[0].iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        let pairs = values[0].iter().zip(&values[1]);
        pairs.fold(
            0.0,
            |most: f64, (a, b)| if (a - b).is_nan() { f64::INFINITY } else { most.max((a - b).abs()) },
        ) / largest
    })
}

#[test]
fn both_backends_carry_alike_whatever_the_mesh_and_the_grading() {
    let mut worst = ([0.0; 2], String::new());
    // Numbers that end with a whole cluster, with one cell too many, and in between; small stick zones stretch most.
    let meshes = [
        (Clustering::Smooth, 10.0, 2112),
        (Clustering::Smooth, 10.0, 2113),
        (Clustering::Smooth, 30.0, 1000),
        (Clustering::Smooth, 60.0, 1111),
        (Clustering::Cubic, 0.7, 1311),
        (Clustering::Quadratic, 0.7, 1025),
        (Clustering::CreepingStick, 3.0, 1000),
        (Clustering::RecedingStick, 6.0, 1311),
    ];
    for (clustering, stretch, cells) in meshes {
        for grading in [-0.9, -0.5, 0.0, 0.5, 0.9, 0.99] {
            let found = differences(grading, &Mesh::new(cells, stretch, clustering));
            for (worst_of, found_of) in worst.0.iter_mut().zip(found) {
                if found_of > *worst_of {
                    *worst_of = found_of;
                    worst.1 = format!("{clustering:?}, Λ = {stretch}, {cells} cells, k = {grading}");
                }
            }
        }
    }
    println!("{worst:?}");
    // Measured: 3.9e-14 for depths, 1.8e-14 for pressures.
    assert!(worst.0[0] < 2e-13 && worst.0[1] < 2e-13, "{worst:?}");
}

#[test]
fn at_4096_springs_the_backends_differ_by_less_than_1e_12_of_the_largest_pressure() {
    for grading in [-0.9, 0.0, 0.99] {
        let [depth, pressure] = differences(grading, &Mesh::new(4096, 10.0, Clustering::Smooth));
        println!("k = {grading}: {depth:e} {pressure:e}");
        // Measured: 6.4e-15 and 9.8e-15, at k = -0.9.
        assert!(depth < 1e-13 && pressure < 1e-13, "k = {grading}: depths {depth:e}, pressures {pressure:e}");
    }
}

#[test]
fn memory_grows_no_faster_than_the_springs() {
    let bytes = |cells: usize| {
        let mesh = Mesh::new(cells, 10.0, Clustering::Smooth);
        let operators = AbelOperators::with(Backend::Hierarchical, 0.0, mesh).unwrap();
        let [profile, pressure] = operators.hierarchical().unwrap();
        (profile.bytes() + pressure.bytes()) as f64
    };
    let [few, many] = [4_000, 32_000].map(bytes);
    assert!(many < 8.2 * few && many < 1600.0 * 32e3, "{few} bytes for 4,000 springs, {many} for 32,000");
}

#[test]
fn ends_of_meshes_of_a_million_cells_keep_widths_that_numbers_tell_apart() {
    for stretch in [10.0, 30.0] {
        let mesh = Mesh::new(1_000_000, stretch, Clustering::Smooth);
        let last = mesh.node(999_999).complement;
        assert!(last > 4e-12, "the last cell is {last:e} wide");
        let first = mesh.node(1).value * stretch.exp() / stretch;
        assert!(first > 9e-8, "the first cell is {first:e} of what it would be unstretched");
        let rises = (0..1_000_000).all(|i| mesh.node(i + 1).minus(&mesh.node(i)) > 0.0);
        assert!(rises, "nodes fall on each other");
    }
}

#[test]
fn blocks_of_low_rank_are_found_from_some_of_their_rows_and_columns() {
    // A sum of three exponentials is of rank three.
    let entry = |i: usize, j: usize| -> f64 {
        [0.01f64, 0.1, 1.0].iter().map(|rate| (-rate * (i as f64 - j as f64)).exp()).sum()
    };
    let found = LowRank::new(50..130, 0..50, 50, entry, 1e-12);
    assert!(found.terms() <= 4, "{} terms", found.terms());
    for i in 50..130 {
        for j in 0..50 {
            let sum: f64 = (0..found.terms()).map(|t| found.rows[t][i - 50] * found.columns[t][j]).sum();
            assert!((sum - entry(i, j)).abs() < 1e-13, "({i}, {j}): {sum} for {}", entry(i, j));
        }
    }
    // A fourth exponential, much smaller, is left out again.
    let small = |i: usize, j: usize| entry(i, j) + 1e-5 * (-0.3 * (i as f64 - j as f64)).exp();
    let shorter = LowRank::new(50..130, 0..50, 50, small, 1e-12).truncated(1e-4);
    assert_eq!(shorter.terms(), 3);
    let off = |i: usize, j: usize| {
        let sum: f64 = (0..3).map(|t| shorter.rows[t][i - 50] * shorter.columns[t][j]).sum();
        (sum - small(i, j)).abs()
    };
    let largest =
        (50..130).flat_map(|i| (0..50).map(move |j| (i, j))).map(|(i, j)| off(i, j)).fold(0.0, f64::max);
    assert!(largest < 1e-4 && largest > 1e-8, "off by {largest:e}");
}

/// Largest error of a solution by factors of halves, for a matrix whose blocks off the diagonal are of rank one; above it the second of two
/// terms is left zero.
fn error_of_halved<T: RealField + Copy + Into<f64>>() -> f64 {
    let n = 200;
    let below = |i: usize, j: usize| 0.5 * (-0.03 * (i as f64 - j as f64)).exp();
    let above = |i: usize, j: usize| -0.4 * (-0.05 * (j as f64 - i as f64)).exp();
    let dense = Mat::from_fn(n, n, |i, j| match i.cmp(&j) {
        std::cmp::Ordering::Less => above(i, j),
        std::cmp::Ordering::Equal => 2.0,
        std::cmp::Ordering::Greater => below(i, j),
    });
    let halves = Halves::new(n, 16);
    let leaves = halves.leaves.iter().map(|leaf| {
        Mat::from_fn(leaf.len(), leaf.len(), |i, j| from_f64::<T>(dense[(leaf.start + i, leaf.start + j)]))
    });
    let terms = halves.splits.iter().map(|_| [2, 1]).collect();
    let blocks = OffDiagonal::new(&halves, terms, None, |leaf, mut sides| {
        let middle = halves.splits[sides.split].middle;
        for (row, i) in leaf.enumerate() {
            let [left, right] = if sides.is_first {
                [above(i, middle), below(middle, i) / 0.5]
            } else {
                [below(i, middle), above(middle, i) / -0.4]
            };
            sides.left[(row, 0)] = from_f64(left);
            sides.right[(row, 0)] = from_f64(right);
        }
    });
    let factors = HodlrFactors::new(&halves, leaves.collect(), blocks);
    let rhs: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
    let mut exact = rhs.clone();
    Factors::new(dense).solve(&mut exact);
    let mut found: Vec<T> = rhs.iter().map(|value| from_f64(*value)).collect();
    factors.solve(&mut found);
    let pairs = exact.iter().zip(&found);
    pairs.fold(0.0, |most: f64, (a, b)| most.max((a - Into::<f64>::into(*b)).abs()))
}

#[test]
fn factors_of_halved_matrices_solve_what_dense_ones_do() {
    // Measured: 2e-7 and 6e-16.
    let [single, double] = [error_of_halved::<f32>(), error_of_halved::<f64>()];
    println!("{single:e} {double:e}");
    assert!(single < 2e-6, "single precision: largest error {single:e}");
    assert!(double < 1e-14, "double precision: largest error {double:e}");
}

/// A paraboloid with `c/a0 = 0.7`.
fn paraboloid(grading: f64) -> InitialContact {
    let scene = format!(
        "[indenter.power-law]\ncoefficient = 1\nexponent = 2\n[half_space]\ngrading = {grading}\nnormal_stiffness = 1\n\
         stiffness_ratio = 1\n[friction.coulomb]\ncoefficient = 1\n[wear.archard]\ncoefficient = 1\n\
         [loading]\nindentation = 2\nstick_ratio = 0.7\ntau = 20\n"
    );
    Scene::from_toml(&scene, "scene").unwrap().contact().unwrap()
}

/// Worn volume at `τ = 20`, and what is left of its way to the closed form, relative.
fn run(grading: f64, springs: usize, tolerance: f64) -> (f64, f64) {
    let contact = paraboloid(grading);
    let model = Model::new(
        &contact,
        &Conditions::plain(*contact.friction(), *contact.wear()),
        springs,
        Clustering::Smooth,
    )
    .unwrap();
    let expected = if springs < 601 { Backend::Dense } else { Backend::Hierarchical };
    assert_eq!(model.operators().backend(), expected);
    let cycles = 20.0 / contact.tau_per_cycle();
    let plan = Plan { outputs: vec![cycles], end: End::Cycles(cycles) };
    let mut simulation = Simulation::new(model, Box::new(Bdf::new(tolerance)), tolerance, plan).unwrap();
    simulation.run(&mut []).unwrap();
    let volume = simulation.model().wear_volume(simulation.fields());
    let limit = LimitingShape::from_contact(&contact).unwrap().unwrap().wear_volume();
    (volume, 1.0 - volume / limit)
}

#[test]
fn wear_is_the_same_on_springs_of_either_backend() {
    for grading in [-0.9, -0.5, 0.0, 0.6, 0.9] {
        let (dense, _) = run(grading, 500, 1e-5);
        for springs in [601, 1600] {
            let (hierarchical, left) = run(grading, springs, 1e-5);
            let difference = (hierarchical / dense - 1.0).abs();
            println!("k = {grading}, {springs} springs: {difference:e}, {left:e} left");
            assert!(difference < 1e-5, "k = {grading}: volumes {dense:e} and {hierarchical:e}");
        }
    }
}

#[test]
fn ten_thousand_springs_come_to_the_limit() {
    // In single precision steps shrink to nothing at k = -0.9.
    for grading in [-0.9, -0.6] {
        let (_, left) = run(grading, 10_000, 1e-3);
        println!("k = {grading}: {left:e}");
        assert!(left.abs() < 1e-3, "k = {grading}: {left:e} of the volume is left");
    }
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let text = include_str!("../data/scenes/paraboloid.toml").replace("cycles = 1e6", "tau = 0.1");
    std::fs::write(&scene, format!("{text}\n[numerics]\nsprings = 9000\ntolerance = 1e-3\n")).unwrap();
    let outputs = ["1", "2"].map(|threads| {
        let mut command = Command::cargo_bin("fretwear").unwrap();
        let output = command
            .env("RAYON_NUM_THREADS", threads)
            .args(["run", "--json", "--quiet", "--force", "-o"])
            .arg(folder.path().join("run.h5"))
            .arg(&scene)
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        ["wear_volume", "contact_radius", "steps", "rate_evaluations"].map(|key| summary[key].clone())
    });
    assert_eq!(outputs[0], outputs[1]);
}

#[test]
fn factors_of_newtons_matrix_invert_it_nearly() {
    let n = 1600;
    for grading in [-0.95, -0.8, 0.0, 0.9] {
        let contact = paraboloid(grading);
        let model = Model::new(
            &contact,
            &Conditions::plain(*contact.friction(), *contact.wear()),
            n,
            Clustering::Smooth,
        )
        .unwrap();
        let state = model.initial_state().unwrap();
        let fields = model.fields(&state);
        let loading = model.schedule().loading(0.0, 0.0);
        let cycle = model.cycle(&loading, &state.compression, &fields);
        let step = 0.1 / contact.tau_per_cycle();
        let slopes = model.plain_growth_slopes(&loading, &fields, &cycle, -step).unwrap();
        let (by_pressure, growth) = (slopes.by_pressure, slopes.by_slip_area.clone());
        let by_slip_area = model.log_slip_by_slip_area(&fields);
        let theta = 1e-3;
        let factors = model.stage_factors(&fields, theta, slopes, &by_slip_area, None).unwrap();
        // The product of the matrix, by the transforms, with something that is a compression and not smooth.
        let inner = n - 1;
        let change: Vec<f64> = (0..inner).map(|i| (0.77 * i as f64).sin()).collect();
        let density: Vec<f64> =
            change.iter().zip(&fields.density_factor).map(|(q, factor)| q * factor).collect();
        let (mut carried, mut pressed) = (vec![0.0; n], vec![0.0; n]);
        let [profile, pressure] = model.operators().transforms();
        profile.apply(&density, &mut carried);
        pressure.apply(&change, &mut pressed);
        let scale = fields.slip_area.powf(0.5 * (1.0 - grading));
        let by_log: Vec<f64> =
            carried.iter().zip(&fields.slip_depth).map(|(depth, slip)| -scale * depth / slip).collect();
        let along = model.along_annulus(&by_log);
        let edge = fields.slip_area;
        let mut rhs: Vec<f64> = (0..inner)
            .map(|i| {
                by_log[i] - theta * along[i] + by_pressure * pressed[i] + (by_slip_area[i] + growth[i]) * edge
            })
            .collect();
        rhs.push(by_log[inner] + by_slip_area[inner] * edge);
        factors.solve(&mut rhs);
        let errors = rhs.iter().zip(&change).map(|(found, q)| (found - q).abs());
        let error = errors.fold(0.0, f64::max);
        let off = (rhs[inner] / edge - 1.0).abs();
        println!("k = {grading}: {error:e}, edge {off:e}");
        assert!(error < 0.02 && off < 0.02, "k = {grading}: compressions by {error:e}, edge by {off:e}");
    }
}

/// Stops after some steps.
struct Stopping(u64);

impl Observer for Stopping {
    fn step(&mut self, simulation: &Simulation) -> fretwear::Result<Flow> {
        let stops = self.0 > 0 && simulation.progress().steps.is_multiple_of(self.0);
        Ok(if stops { Flow::Stop } else { Flow::Continue })
    }
}

#[test]
fn runs_that_are_resumed_with_factors_of_steps_before_repeat_every_bit() {
    let contact = paraboloid(0.0);
    let cycles = 20.0 / contact.tau_per_cycle();
    let end = |every: u64| {
        let plan = Plan { outputs: vec![cycles], end: End::Cycles(cycles) };
        let stepper = || Box::new(Bdf::new(1e-4));
        let model = Model::new(
            &contact,
            &Conditions::plain(*contact.friction(), *contact.wear()),
            1200,
            Clustering::Smooth,
        )
        .unwrap();
        let mut simulation = Simulation::new(model.clone(), stepper(), 1e-4, plan.clone()).unwrap();
        let (mut resumed, mut with_factors) = (0, 0);
        while simulation.run(&mut [&mut Stopping(every)]).unwrap() == Outcome::Interrupted {
            let (state, progress) = (simulation.state().clone(), *simulation.progress());
            resumed += 1;
            with_factors += u32::from(state.past.linearised.is_some());
            // As from a file: nothing is shared with what was there before.
            let linearised = state.past.linearised.as_deref().cloned().map(Arc::new);
            let state = State { past: Past { linearised, ..state.past.clone() }, ..state };
            simulation = Simulation::resume(model.clone(), stepper(), 1e-4, plan.clone(), state, progress);
        }
        println!("{resumed} times resumed, {with_factors} of them with factors");
        (simulation.state().clone(), *simulation.progress(), with_factors)
    };
    let (whole, progress, _) = end(0);
    for every in [1, 7] {
        let (state, its_progress, with_factors) = end(every);
        assert!(with_factors > 2, "factors were kept over {with_factors} of the stops only");
        assert_eq!(progress, its_progress);
        assert_eq!(whole, state);
    }
}
