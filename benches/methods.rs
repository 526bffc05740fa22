use fretwear::contact::InitialContact;
use fretwear::error::Result;
use fretwear::friction::Coulomb;
use fretwear::grid::Clustering;
use fretwear::half_space::HalfSpace;
use fretwear::indenter::Indenter;
use fretwear::loading::{Amplitude, Duration, Load, Loading};
use fretwear::model::Model;
use fretwear::simulation::{End, Observer, Plan, Simulation};
use fretwear::stepper::{Implicit, Multistep, Stepper};
use fretwear::wear::Archard;
use std::time::Instant;

const SCENES: [(f64, f64, f64, f64); 6] = [
    (2.0, 0.0, 0.7, 30.0),
    (2.0, -0.5, 0.7, 30.0),
    (2.0, 0.5, 0.7, 100.0),
    (2.0, 0.9, 0.7, 30.0),
    (1.0, -0.3, 0.3, 30.0),
    (4.0, 0.3, 0.2, 1e6),
];
const OUTPUTS: i32 = 16;

#[derive(Default)]
struct Shown {
    volume: Vec<f64>,
    wear_depth: Vec<Vec<f64>>,
    energy: Vec<f64>,
}
impl Observer for Shown {
    fn output(&mut self, simulation: &Simulation) -> Result<()> {
        let model = simulation.model();
        self.volume.push(model.wear_volume(simulation.fields()));
        self.energy.push(simulation.state().volume_by_rate);
        self.wear_depth.push(simulation.wear_depth().to_vec());
        Ok(())
    }
}
fn model(
    (exponent, grading, stick_ratio, tau): (f64, f64, f64, f64),
    springs: usize,
) -> Result<(Model, Plan)> {
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
    let end = tau / contact.tau_per_cycle();
    let outputs: Vec<f64> = (0..OUTPUTS).map(|i| end * 2f64.powi(i - OUTPUTS + 1)).collect();
    let plan = Plan { end: End::Cycles(end), outputs };
    Ok((Model::new(&contact, springs, Clustering::Smooth)?, plan))
}
fn run(
    scene: (f64, f64, f64, f64),
    springs: usize,
    tolerance: f64,
    stepper: Box<dyn Stepper + Send>,
) -> Result<(Shown, f64, u64, u64, u64)> {
    let (model, plan) = model(scene, springs)?;
    let mut shown = Shown::default();
    let begun = Instant::now();
    let mut simulation = Simulation::new(model, stepper, tolerance, plan)?;
    simulation.run(&mut [&mut shown])?;
    let p = simulation.progress();
    Ok((shown, 1e3 * begun.elapsed().as_secs_f64(), p.steps, p.rejected_steps, p.rate_evaluations))
}
fn error(of: &Shown, reference: &Shown) -> (f64, f64, f64) {
    let limit = reference.volume[reference.volume.len() - 1];
    let v = of.volume.iter().zip(&reference.volume).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs() / limit));
    let e = of.energy.iter().zip(&reference.energy).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs() / limit));
    let pairs = of.wear_depth.iter().flatten().zip(reference.wear_depth.iter().flatten());
    let deepest = reference.wear_depth.iter().flatten().fold(0.0, |m: f64, a| m.max(*a));
    (v, pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / deepest, e)
}
fn main() -> Result<()> {
    let springs = std::env::args().filter_map(|a| a.parse().ok()).next().unwrap_or(40);
    let mut rows = vec![];
    for scene in SCENES {
        let reference = run(scene, springs, 1e-9, Box::new(Implicit::new(1e-9)))?;
        println!("{scene:?} reference {:.0} ms {} steps", reference.1, reference.2);
        for tolerance in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8] {
            for name in if std::env::var("ONLY").is_ok() { vec!["BDF"] } else { vec!["SDIRK", "BDF"] } {
                let stepper: Box<dyn Stepper + Send> = if name == "BDF" {
                    Box::new(Multistep::new(tolerance))
                } else {
                    Box::new(Implicit::new(tolerance))
                };
                match run(scene, springs, tolerance, stepper) {
                    Ok((shown, ms, steps, rejected, evaluations)) => {
                        let (v, d, e) = error(&shown, &reference.0);
                        if name == "BDF" {
                            rows.push((v.max(d), steps, rejected, evaluations));
                        }
                        if std::env::var("ONLY").is_err() {
                            println!(
                                "  {name:6} {tolerance:.0e} volume {v:.1e} depth {d:.1e} energy {e:.1e}  {ms:.1} ms {steps} steps {rejected} rejected {evaluations} evaluations"
                            );
                        }
                    }
                    Err(error) => println!("  {name} {tolerance:.0e} {error}"),
                }
            }
        }
    }
    // cost at which error 1e-3, 1e-5, 1e-7 interpolated, geometric mean over scenes
    for chunk in [1e-3f64, 1e-4, 1e-5, 1e-6, 2e-7] {
        let mut total = 0.0;
        let mut n = 0.0;
        let mut ts = 0.0;
        let mut te = 0.0;
        for scene in rows.chunks(7) {
            for pair in scene.windows(2) {
                if pair[0].0 >= chunk && pair[1].0 < chunk {
                    let x = (pair[0].0 / chunk).ln() / (pair[0].0 / pair[1].0).ln();
                    let f = |a: u64, b: u64| (a as f64).powf(1.0 - x) * (b as f64).powf(x);
                    let (s, e) = (f(pair[0].1 + pair[0].2, pair[1].1 + pair[1].2), f(pair[0].3, pair[1].3));
                    total += (3.0 * s + e).ln();
                    n += 1.0;
                    ts += s;
                    te += e;
                    break;
                }
            }
        }
        println!(
            "error {chunk:e}: cost {:.0} steps {:.0} evaluations {:.0} ({n})",
            (total / n).exp(),
            ts / n,
            te / n
        );
    }
    Ok(())
}
