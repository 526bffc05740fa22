//! Time and memory of the transforms and of implicit steps for 100 to a million springs: `cargo bench --bench many_springs`, results in
//! docs/many_springs.md. `-- --quick` ends at 100,000.
//!
//! Either backend alone, then the model with what serves it: an evaluation of depths, pressures and wear, and the factors of Newton's matrix. Beside
//! them, measured in the same run, what the machine's memory delivers, and what the product would take by Fourier transform on a uniform grid, with
//! the round-off that this leaves next to the edge of stick.

mod support;

use std::hint::black_box;
use std::time::Instant;

use fretwear::laws::conditions::Conditions;
use fretwear::numerics::abel::{AbelOperators, Backend};
use fretwear::numerics::grid::{Clustering, Mesh};
use fretwear::numerics::linear::Factors;
use fretwear::scene::Scene;
use fretwear::solver::model::Model;
use rayon::prelude::*;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

const SPRINGS: [usize; 9] = [100, 300, 1000, 3000, 10_000, 30_000, 100_000, 300_000, 1_000_000];
const QUICK: usize = 100_000;
/// Springs up to which dense operators are tried.
const MOST_DENSE: usize = 3000;
/// Springs from which on exponents are fitted.
const FITTED_FROM: usize = 10_000;
/// Factors of a step, which serve others too, and its evaluations with a solution (measured in runs of the main scene).
const FACTORS: f64 = 0.6;
const ITERATIONS: f64 = 5.4;
const REPEATS: usize = 5;

struct Cost {
    springs: usize,
    apply: f64,
    bytes: f64,
    evaluation: Option<f64>,
    step: Option<f64>,
}

/// Least time of several, s.
fn least(mut work: impl FnMut()) -> f64 {
    let time = |_| {
        let begin = Instant::now();
        work();
        begin.elapsed().as_secs_f64()
    };
    (0..REPEATS).map(time).fold(f64::INFINITY, f64::min)
}

/// Time of both transforms together, s.
fn apply(operators: &AbelOperators) -> f64 {
    let n = operators.len();
    let x: Vec<f64> = (1..n).map(|i| operators.mesh().node(i).complement).collect();
    let mut y = vec![0.0; n];
    let mut both = || {
        for transform in operators.transforms() {
            transform.apply(black_box(&x), &mut y);
        }
    };
    // Where it is short, many at a time.
    let times = 1 + 100_000 / n;
    least(|| (0..times).for_each(|_| both())) / times as f64
}

fn dense(n: usize) -> (f64, f64, f64) {
    let operators = AbelOperators::new(0.0, Mesh::new(n, 10.0, Clustering::Smooth)).expect("operators");
    let lu = least(|| {
        black_box(Factors::new(operators.profile().clone()));
    });
    (apply(&operators), lu, 8.0 * 5.0 * (n * n) as f64)
}

/// Evaluation, factors and solution of the model, s, and the bytes of the factors.
fn model(n: usize) -> [f64; 5] {
    let scene = Scene::from_toml(include_str!("../data/scenes/paraboloid.toml"), "scene").expect("a scene");
    let contact = scene.contact().expect("a contact");
    let begin = Instant::now();
    let model =
        Model::new(&contact, &Conditions::plain(*contact.friction(), *contact.wear()), n, Clustering::Smooth)
            .expect("a model");
    let state = model.initial_state().expect("a state");
    let set_up = begin.elapsed().as_secs_f64();
    let mut fields = model.fields(&state);
    let loading = model.schedule().loading(0.0, 0.0);
    let mut cycle = model.cycle(&loading, &state.compression, &fields);
    let evaluation = least(|| {
        model.evaluate(state.slip_area, &state.compression, &mut fields);
        cycle = model.cycle(&loading, &state.compression, &fields);
    });
    let by_slip_area = model.log_slip_by_slip_area(&fields);
    let step = 0.1 / contact.tau_per_cycle();
    let mut factors = None;
    let factorise = least(|| {
        let slopes = model.plain_growth_slopes(&loading, &fields, &cycle, -step).expect("a plain cycle");
        factors = model.stage_factors(&fields, 1e-3, slopes, &by_slip_area, factors.take());
    });
    let Some(factors) = factors else { return [evaluation, 0.0, 0.0, 0.0, set_up] };
    let mut rhs: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
    let solve = least(|| factors.solve(&mut rhs));
    [evaluation, factorise, solve, factors.bytes() as f64, set_up]
}

/// The power of the springs with which a cost grows.
fn exponent(costs: &[Cost], value: impl Fn(&Cost) -> Option<f64>) -> f64 {
    let fitted = costs.iter().filter(|cost| cost.springs >= FITTED_FROM);
    support::exponent(fitted.filter_map(|cost| Some((cost.springs as f64, value(cost)?))))
}

/// What all threads together read from memory in a second, bytes.
fn bandwidth() -> f64 {
    let values = vec![1.0f64; 1 << 26];
    let seconds = least(|| {
        let sum: f64 = values.par_chunks(1 << 16).map(|part| part.iter().sum::<f64>()).sum();
        black_box(sum);
    });
    8.0 * values.len() as f64 / seconds
}

/// Time, s, of Eq. (20) on a uniform grid by Fourier transform, and its round-off over the depth at the first node and over the largest.
fn fourier(n: usize) -> (f64, f64, f64) {
    // Piecewise constant densities for k = 0: weights that differ by a shift only.
    let weights: Vec<f64> = (0..n).map(|m| ((m + 1) as f64).sqrt() - (m as f64).sqrt()).collect();
    let density: Vec<f64> = (0..n).map(|i| 1.0 - i as f64 / n as f64).collect();
    let size = (2 * n).next_power_of_two();
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, inverse) = (planner.plan_fft_forward(size), planner.plan_fft_inverse(size));
    let padded = |values: &[f64]| {
        let mut padded = values.to_vec();
        padded.resize(size, 0.0);
        padded
    };
    let mut kernel = forward.make_output_vec();
    forward.process(&mut padded(&weights), &mut kernel).expect("sizes fit");
    let mut spectrum: Vec<Complex<f64>> = forward.make_output_vec();
    let mut result = vec![0.0; size];
    let seconds = least(|| {
        let mut values = padded(&density);
        forward.process(&mut values, &mut spectrum).expect("sizes fit");
        spectrum.iter_mut().zip(&kernel).for_each(|(value, kernel)| *value *= *kernel / size as f64);
        // A real signal has no imaginary part there.
        spectrum[0].im = 0.0;
        spectrum[size / 2].im = 0.0;
        inverse.process(&mut spectrum, &mut result).expect("sizes fit");
    });
    let exact = |row: usize| (0..=row).map(|j| weights[row - j] * density[j]).sum::<f64>();
    let first = (result[0] / exact(0) - 1.0).abs();
    let rows = [0, 1, 2, 5, 10, 50, n / 2, n - 1];
    let largest = rows.iter().map(|row| exact(*row)).fold(0.0, f64::max);
    let off = rows.iter().map(|row| (result[*row] - exact(*row)).abs()).fold(0.0, f64::max);
    (seconds, first, off / largest)
}

fn main() {
    let quick = std::env::args().any(|argument| argument == "--quick");
    let bandwidth = bandwidth();
    println!("memory reads {:.1} GB/s on {} threads", 1e-9 * bandwidth, rayon::current_num_threads());
    println!(
        "springs | dense: both ms, LU ms, MB | hierarchical: both ms, MB, of bandwidth | evaluation ms, factors ms, solution ms, step ms, MB of factors, set-up s | Fourier ms, error of the first depth, of the largest"
    );
    let mut costs = Vec::new();
    for n in SPRINGS.into_iter().filter(|n| !quick || *n <= QUICK) {
        print!("{n} |");
        if n <= MOST_DENSE {
            let (both, lu, bytes) = dense(n);
            print!(" {:.3}, {:.2}, {:.1}", 1e3 * both, 1e3 * lu, 1e-6 * bytes);
        }
        print!(" |");
        let mut cost = Cost { springs: n, apply: f64::NAN, bytes: f64::NAN, evaluation: None, step: None };
        if n >= 300 {
            let mesh = Mesh::new(n, 10.0, Clustering::Smooth);
            let operators = AbelOperators::with(Backend::Hierarchical, 0.0, mesh).expect("operators");
            let [profile, pressure] = operators.hierarchical().expect("hierarchical ones");
            cost.bytes = (profile.bytes() + pressure.bytes()) as f64;
            cost.apply = apply(&operators);
            print!(
                " {:.3}, {:.1}, {:.2}",
                1e3 * cost.apply,
                1e-6 * cost.bytes,
                cost.bytes / cost.apply / bandwidth
            );
        }
        let [evaluation, factorise, solve, bytes, set_up] = model(n);
        cost.evaluation = Some(evaluation);
        print!(" | {:.3}", 1e3 * evaluation);
        if factorise > 0.0 && bytes > 0.0 {
            let step = FACTORS * factorise + ITERATIONS * (evaluation + solve);
            cost.step = Some(step);
            print!(
                ", {:.1}, {:.2}, {:.1}, {:.1}, {set_up:.1}",
                1e3 * factorise,
                1e3 * solve,
                1e3 * step,
                1e-6 * bytes
            );
        }
        let (seconds, first, largest) = fourier(n);
        println!(" | {:.3}, {first:.1e}, {largest:.1e}", 1e3 * seconds);
        costs.push(cost);
    }
    println!(
        "exponents from {FITTED_FROM} springs on: both transforms {:.2}, their memory {:.2}, evaluation {:.2}, step {:.2}",
        exponent(&costs, |cost| Some(cost.apply)),
        exponent(&costs, |cost| Some(cost.bytes)),
        exponent(&costs, |cost| cost.evaluation),
        exponent(&costs, |cost| cost.step),
    );
}
