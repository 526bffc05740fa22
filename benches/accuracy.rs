//! Measured errors of worn volume and profile, over springs and over the tolerance of the time stepping.
//!
//! `cargo bench --bench accuracy` prints the tables of docs/numerics.md. Each scene is judged by the same one with 360 springs and a
//! tolerance of 1e-7, at sixteen times from the first wear to the limit; errors are relative to the worn volume and to the largest
//! depth of the limit.

use fretwear::contact::InitialContact;
use fretwear::error::Result;
use fretwear::friction::Coulomb;
use fretwear::grid::{Clustering, lagrange, stencil_start};
use fretwear::half_space::HalfSpace;
use fretwear::indenter::Indenter;
use fretwear::loading::{Amplitude, Duration, Load, Loading};
use fretwear::model::Model;
use fretwear::simulation::{End, Observer, Plan, Simulation};
use fretwear::stepper::Implicit;
use fretwear::wear::Archard;

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
const SPRINGS: [usize; 6] = [25, 36, 54, 80, 120, 180];
const TOLERANCES: [f64; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];
const OUTPUTS: i32 = 16;

/// What a run shows at its outputs.
struct Shown {
    nodes: Vec<f64>,
    volume: Vec<f64>,
    wear_depth: Vec<Vec<f64>>,
    /// Dissipated energy over `μ_f/k_w`, which is the worn volume again.
    volume_by_energy: Vec<f64>,
    depth_scale: f64,
    steps: u64,
}

impl Observer for Shown {
    fn output(&mut self, simulation: &Simulation) -> Result<()> {
        let model = simulation.model();
        self.volume.push(model.wear_volume(simulation.fields()));
        self.volume_by_energy.push(simulation.state().dissipated_energy);
        self.wear_depth.push(simulation.wear_depth().to_vec());
        Ok(())
    }
}

fn run((exponent, grading, stick_ratio): (f64, f64, f64), springs: usize, tolerance: f64) -> Result<Shown> {
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
    let model = Model::new(&contact, springs, Clustering::Cubic)?;
    let mut shown = Shown {
        nodes: model.operators().nodes().to_vec(),
        volume: vec![],
        wear_depth: vec![],
        volume_by_energy: vec![],
        depth_scale: model.depth_scale(),
        steps: 0,
    };
    let mut simulation = Simulation::new(model, Box::new(Implicit::new(tolerance)), tolerance, plan)?;
    simulation.run(&mut [&mut shown])?;
    shown.steps = simulation.progress().steps;
    Ok(shown)
}

/// Largest difference over the outputs, relative to the last value of the reference.
fn volume_error(of: &[f64], reference: &[f64]) -> f64 {
    let limit = reference[reference.len() - 1];
    of.iter().zip(reference).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs() / limit))
}

/// Largest difference of the profiles over the outputs and the nodes of `of`.
fn depth_error(of: &Shown, reference: &Shown, grading: f64) -> f64 {
    let mu = 0.5 * (1.0 - grading);
    let mut largest = 0.0f64;
    for (depth, exact) in of.wear_depth.iter().zip(&reference.wear_depth) {
        for (x, depth) in of.nodes[1..].iter().zip(depth) {
            largest = largest.max((depth - between(&reference.nodes, exact, *x, mu)).abs());
        }
    }
    largest / reference.depth_scale
}

/// Local cubic interpolation of a depth that rises from the stick edge like `ξ^μ`.
fn between(nodes: &[f64], depth: &[f64], x: f64, mu: f64) -> f64 {
    let last = nodes.len() - 1;
    let cell = nodes[1..last].partition_point(|node| *node < x).clamp(1, last - 1);
    let start = stencil_start(cell, 4, last);
    let mut weights = [0.0; 4];
    lagrange(&nodes[start..start + 4], x, &mut weights);
    let eased = |m: usize| depth[start + m - 1] * nodes[start + m].powf(-mu);
    (0..4).map(|m| weights[m] * eased(m)).sum::<f64>() * x.powf(mu)
}

fn main() -> Result<()> {
    println!(
        "| n, k, c/a0 | springs | error of volume | of profile | energy balance |\n|---|---|---|---|---|"
    );
    for scene in SCENES {
        let reference = run(scene, 360, 1e-7)?;
        for springs in SPRINGS {
            let shown = run(scene, springs, 1e-7)?;
            let volume = volume_error(&shown.volume, &reference.volume);
            let balance = volume_error(&shown.volume_by_energy, &shown.volume);
            let depth = depth_error(&shown, &reference, scene.1);
            println!("| {scene:?} | {springs} | {volume:.1e} | {depth:.1e} | {balance:.1e} |");
        }
    }
    println!("\n| n, k, c/a0 | tolerance | error of volume | of profile | steps |\n|---|---|---|---|---|");
    for scene in SCENES {
        let reference = run(scene, 60, 1e-8)?;
        for tolerance in TOLERANCES {
            let shown = run(scene, 60, tolerance)?;
            let volume = volume_error(&shown.volume, &reference.volume);
            let depth = depth_error(&shown, &reference, scene.1);
            println!("| {scene:?} | {tolerance:e} | {volume:.1e} | {depth:.1e} | {} |", shown.steps);
        }
    }
    Ok(())
}
