//! Measured errors of worn volume and profile, over springs, and over the tolerance of both implicit methods of time stepping.
//!
//! `cargo bench --bench accuracy` prints the tables of docs/numerics.md. Each scene is judged by the same one with 160 springs and a
//! tolerance of 1e-8, at sixteen times from the first wear to the limit; errors are relative to the worn volume and to the largest
//! depth of the limit.

use std::time::Instant;

use fretwear::contact::InitialContact;
use fretwear::contact::half_space::HalfSpace;
use fretwear::contact::indenter::Indenter;
use fretwear::error::Result;
use fretwear::laws::conditions::Conditions;
use fretwear::laws::friction::Coulomb;
use fretwear::laws::loading::{Amplitude, Duration, Load, Loading};
use fretwear::laws::wear::Archard;
use fretwear::numerics::grid::Clustering;
use fretwear::solver::model::Model;
use fretwear::solver::simulation::{End, Observer, Plan, Simulation};
use fretwear::solver::stepper::{Bdf, Sdirk, Stepper};

/// Exponent of the indenter, grading, stick ratio.
const SCENES: [(f64, f64, f64); 12] = [
    (2.0, 0.0, 0.7),
    (2.0, 0.0, 0.3),
    (2.0, -0.5, 0.7),
    (2.0, 0.5, 0.7),
    (2.0, 0.9, 0.7),
    (1.0, -0.3, 0.5),
    (1.0, 0.0, 0.9),
    (4.0, 0.3, 0.2),
    (2.0, -0.8, 0.5),
    (2.0, 0.0, 0.97),
    (0.5, 0.0, 0.5),
    (2.0, 0.0, 0.05),
];
const SPRINGS: [usize; 7] = [12, 16, 24, 36, 54, 80, 120];
const TOLERANCES: [f64; 6] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7];
const OUTPUTS: i32 = 16;

/// What a run shows at its outputs.
struct Shown {
    volume: Vec<f64>,
    wear_depth: Vec<Vec<f64>>,
    /// Dissipated energy over `μ_f/k_w`, which is the worn volume again.
    volume_by_energy: Vec<f64>,
    depth_scale: f64,
    steps: u64,
    evaluations: u64,
    milliseconds: f64,
}

/// A method of time stepping, by its tolerance.
type Method = fn(f64) -> Box<dyn Stepper + Send>;

const METHODS: [(&str, Method); 2] = [
    ("Runge-Kutta", |tolerance| Box::new(Sdirk::new(tolerance))),
    ("backward differentiation", |tolerance| Box::new(Bdf::new(tolerance))),
];

impl Observer for Shown {
    fn output(&mut self, simulation: &Simulation) -> Result<()> {
        let model = simulation.model();
        self.volume.push(model.wear_volume(simulation.fields()));
        self.volume_by_energy.push(simulation.state().dissipated_energy);
        let depth = |part: f64| {
            model.wear_depth_at(
                simulation.state(),
                simulation.fields(),
                part * model.unworn().limit_slip_area(),
            )
        };
        // From 1e-4 of the annulus on, evenly in the logarithm, then evenly.
        let near = (0..40).map(|i| 10f64.powf(-4.0 + 0.1 * f64::from(i)));
        self.wear_depth.push(near.chain((1..100).map(|i| 0.01 * f64::from(i))).map(depth).collect());
        Ok(())
    }
}

fn run(
    (exponent, grading, stick_ratio): (f64, f64, f64),
    springs: usize,
    tolerance: f64,
    method: Method,
) -> Result<Shown> {
    let contact = InitialContact::new(
        &Indenter::power_law(1.0, exponent)?,
        &HalfSpace::from_stiffness(grading, 1.0, 1.0)?,
        &Coulomb { coefficient: 1.0 },
        &Archard { coefficient: 1.0 },
        &Loading {
            load: Load::Indentation(1.0),
            amplitude: Amplitude::StickRatio(stick_ratio),
            duration: Duration::Tau(1.0),
        },
    )?;
    // The pressure in the annulus goes with q_c/d, and the time that wear takes with its inverse.
    let unit = 3.0 / (contact.tau_per_cycle() * contact.slip_compression());
    let outputs: Vec<f64> = (0..OUTPUTS).map(|i| 0.1 * unit * 1.6f64.powi(i)).collect();
    let plan = Plan { end: End::Cycles(outputs[OUTPUTS as usize - 1]), outputs };
    let model = Model::new(
        &contact,
        &Conditions::plain(*contact.friction(), *contact.wear()),
        springs,
        Clustering::Smooth,
    )?;
    let mut shown = Shown {
        volume: vec![],
        wear_depth: vec![],
        volume_by_energy: vec![],
        depth_scale: model.depth_scale(),
        steps: 0,
        evaluations: 0,
        milliseconds: 0.0,
    };
    let begun = Instant::now();
    let mut simulation = Simulation::new(model, method(tolerance), tolerance, plan)?;
    simulation.run(&mut [&mut shown])?;
    shown.milliseconds = 1e3 * begun.elapsed().as_secs_f64();
    let progress = simulation.progress();
    (shown.steps, shown.evaluations) = (progress.steps + progress.rejected_steps, progress.rate_evaluations);
    Ok(shown)
}

/// Largest difference over the outputs, relative to the last value of the reference.
fn volume_error(of: &[f64], reference: &[f64]) -> f64 {
    let limit = reference[reference.len() - 1];
    of.iter().zip(reference).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs() / limit))
}

/// Largest difference of the profiles over the outputs and the radii, `r² - c²` over the limit's, at which both are seen.
fn depth_error(of: &Shown, reference: &Shown) -> f64 {
    let pairs = of.wear_depth.iter().flatten().zip(reference.wear_depth.iter().flatten());
    pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / reference.depth_scale
}

fn main() -> Result<()> {
    println!(
        "| n, k, c/a0 | springs | error of volume | of profile | energy balance |\n|---|---|---|---|---|"
    );
    for scene in SCENES {
        let reference = run(scene, 160, 1e-8, METHODS[1].1)?;
        for springs in SPRINGS {
            let shown = run(scene, springs, 1e-8, METHODS[1].1)?;
            let volume = volume_error(&shown.volume, &reference.volume);
            let balance = volume_error(&shown.volume_by_energy, &shown.volume);
            let depth = depth_error(&shown, &reference);
            println!("| {scene:?} | {springs} | {volume:.1e} | {depth:.1e} | {balance:.1e} |");
        }
    }
    println!(
        "\n| n, k, c/a0 | method | tolerance | error of volume | of profile | steps | evaluations | ms |\n|---|---|---|---|---|---|---|---|"
    );
    for scene in SCENES {
        let reference = run(scene, 60, 1e-10, METHODS[1].1)?;
        for tolerance in TOLERANCES {
            for (name, method) in METHODS {
                let shown = run(scene, 60, tolerance, method)?;
                let volume = volume_error(&shown.volume, &reference.volume);
                let depth = depth_error(&shown, &reference);
                let Shown { steps, evaluations, milliseconds, .. } = shown;
                println!(
                    "| {scene:?} | {name} | {tolerance:e} | {volume:.1e} | {depth:.1e} | {steps} | {evaluations} | {milliseconds:.1} |"
                );
            }
        }
    }
    Ok(())
}
