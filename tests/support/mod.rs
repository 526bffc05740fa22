//! Power-law contacts in units in which the first contact radius, both stiffnesses and the friction coefficient are one.

// Every test file uses a part of this.
#![allow(dead_code)]

pub mod calibration;
pub mod command;
pub mod laws;
pub mod reference;
pub mod results;
pub mod resume;
pub mod scenes;

use fretwear::Results;
use fretwear::contact::InitialContact;
use fretwear::contact::half_space::HalfSpace;
use fretwear::contact::indenter::{Indenter, power_law_factor};
use fretwear::laws::friction::Coulomb;
use fretwear::laws::loading::{Amplitude, Duration, Load, Loading};
use fretwear::laws::wear::Archard;
use fretwear::numerics::grid::Clustering;
use fretwear::solver::model::{Model, State};
use fretwear::solver::simulation::{End, Observer, Outcome, Plan, Simulation};
use fretwear::solver::stepper::Stepper;

/// A power-law indenter `r^n` on a half-space of grading `k` with the stick radius `c`.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    pub exponent: f64,
    pub grading: f64,
    pub stick_ratio: f64,
    pub springs: usize,
    pub clustering: Clustering,
    /// Dimensionless time of one cycle.
    pub tau_per_cycle: f64,
}

impl Case {
    /// One cycle lasts `τ = 1`, so that cycles are `τ`.
    pub fn new(exponent: f64, grading: f64, stick_ratio: f64, springs: usize) -> Self {
        let clustering = Clustering::Cubic;
        Self { exponent, grading, stick_ratio, springs, clustering, tau_per_cycle: 1.0 }
    }

    /// The same on the mesh of plain runs.
    pub fn smooth(self) -> Self {
        Self { clustering: Clustering::Smooth, ..self }
    }

    /// Indentation `d`; the first contact radius is one.
    pub fn indentation(&self) -> f64 {
        power_law_factor(self.exponent, self.grading)
    }

    pub fn contact(&self) -> InitialContact {
        let d = self.indentation();
        let loading = Loading {
            load: Load::Indentation(d),
            amplitude: Amplitude::StickRatio(self.stick_ratio),
            duration: Duration::Tau(1.0),
        };
        let indenter = Indenter::power_law(1.0, self.exponent).unwrap();
        let half_space = HalfSpace::from_stiffness(self.grading, 1.0, 1.0).unwrap();
        let wear = Archard { coefficient: self.tau_per_cycle / (4.0 * d) };
        InitialContact::new(&indenter, &half_space, &Coulomb { coefficient: 1.0 }, &wear, &loading).unwrap()
    }

    pub fn model(&self) -> Model {
        let contact = self.contact();
        Model::new(&contact, &laws::plain(&contact), self.springs, self.clustering).unwrap()
    }

    pub fn simulation(&self, stepper: Box<dyn Stepper + Send>, tolerance: f64, plan: Plan) -> Simulation {
        Simulation::new(self.model(), stepper, tolerance, plan).unwrap()
    }

    /// Runs to the last of the outputs, in cycles, and returns what was seen at them.
    pub fn run(&self, stepper: Box<dyn Stepper + Send>, tolerance: f64, outputs: &[f64]) -> Vec<Seen> {
        let plan = Plan { outputs: outputs.to_vec(), end: End::Cycles(outputs[outputs.len() - 1]) };
        let mut seen = Record::default();
        let outcome = self.simulation(stepper, tolerance, plan).run(&mut [&mut seen]).unwrap();
        assert_eq!(outcome, Outcome::End);
        seen.0
    }
}

/// What there was at an output.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    pub state: State,
    pub wear_volume: f64,
    pub wear_depth: Vec<f64>,
    /// Wear depth, m, at fixed parts of the annulus of the limit, whatever the springs; none in gross slip, which has no such annulus.
    pub depth_at_parts: Vec<f64>,
    pub steps: u64,
}

fn depth_at_parts(simulation: &Simulation) -> Vec<f64> {
    let model = simulation.model();
    if model.gross().is_some() {
        return vec![];
    }
    let limit = model.unworn().limit_slip_area();
    let near = (0..40).map(|i| 10f64.powf(-4.0 + 0.1 * f64::from(i)));
    let parts = near.chain((1..100).map(|i| 0.01 * f64::from(i)));
    parts.map(|part| model.wear_depth_at(simulation.state(), simulation.fields(), part * limit)).collect()
}

/// Keeps what it sees at the outputs after the start.
#[derive(Default)]
pub struct Record(pub Vec<Seen>);

impl Observer for Record {
    fn output(&mut self, simulation: &Simulation) -> fretwear::Result<()> {
        if simulation.progress().steps > 0 {
            self.0.push(Seen {
                state: simulation.state().clone(),
                wear_volume: simulation.model().wear_volume(simulation.fields()),
                wear_depth: simulation.wear_depth(),
                depth_at_parts: depth_at_parts(simulation),
                steps: simulation.progress().steps,
            });
        }
        Ok(())
    }
}

/// Largest difference of two rows of numbers.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |largest: f64, (a, b)| {
        let difference = (a - b).abs();
        if difference.is_nan() { f64::INFINITY } else { largest.max(difference) }
    })
}

/// Orders that the errors of ever halved steps show.
pub fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect()
}

/// By how much the worn volume of a run differs from that of a finer one, relative to the limit where there is one, as estimates are.
pub fn volume_off(run: &Results, finest: &Results) -> f64 {
    let [volume, expected] = [run, finest].map(|it| it.last().wear_volume);
    let scale = finest.limit().map_or(expected, |limit| limit.wear_volume());
    (volume - expected).abs() / scale
}
