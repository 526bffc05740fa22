//! Implicit steps of a contact in gross slip: an ordinary differential equation for the compressions.

use faer::Mat;

use super::tableau::ALEXANDER;
use super::{Stepper, Trial};
use crate::error::{Error, Result};
use crate::numerics::linear::Factors;
use crate::solver::model::{Gross, GrossRates, Model, State};

/// Change of a compression, over the largest, by which Newton's matrix is found.
const DIFFERENCE: f64 = 1e-7;

/// Newton iterations of a stage before the step is given up.
const ITERATIONS: usize = 10;

/// What Newton's method may leave, over the tolerance of a step, and at least.
const LEFT: f64 = 1e-3;
const ROUND_OFF: f64 = 1e-12;

/// Alexander's method of order 3, with the error of the compressions, relative to the largest, by the embedded one of order 2.
#[derive(Debug)]
pub struct GrossSdirk {
    tolerance: f64,
}

impl GrossSdirk {
    /// A stepper whose stages are solved well below the tolerance of the time stepping.
    pub fn new(tolerance: f64) -> Self {
        Self { tolerance }
    }
}

impl Stepper for GrossSdirk {
    fn name(&self) -> &'static str {
        "SDIRK of order 3"
    }

    fn step(&mut self, model: &Model, state: &State, cycles: f64) -> Result<Trial> {
        let gross = model.gross().ok_or_else(|| Error::Inconsistent {
            what: "numerics.stepper",
            why: "GrossSdirk steps contacts in gross slip alone; take Sdirk".into(),
        })?;
        // What no smaller step can cure.
        model.gross_area(gross, &state.compression)?;
        let mut evaluations = 1;
        Ok(step(model, gross, state, cycles, self.tolerance, &mut evaluations)
            .unwrap_or_else(|| Trial::failed(evaluations)))
    }

    fn estimate_order(&self) -> f64 {
        3.0
    }

    fn steps_gross_slip(&self) -> bool {
        true
    }
}

fn step(
    model: &Model,
    gross: &Gross,
    state: &State,
    cycles: f64,
    tolerance: f64,
    evaluations: &mut u64,
) -> Option<Trial> {
    let start = &state.compression;
    let rates = |at: f64, energy: f64, compression: &[f64], evaluations: &mut u64| {
        *evaluations += 1;
        let loading = model.after_energy(model.schedule().loading(state.cycles, at), energy);
        model.gross_rates(gross, &loading, compression)
    };
    let scale = largest(start);
    let first = rates(state.cycles, state.dissipated_energy, start, evaluations)?;
    let factors = {
        let step = cycles * ALEXANDER.diagonal;
        let mut matrix = Mat::<f64>::identity(start.len(), start.len());
        let mut moved = start.clone();
        for j in 0..start.len() {
            moved[j] += DIFFERENCE * scale;
            let there = rates(state.cycles, state.dissipated_energy, &moved, evaluations)?;
            moved[j] = start[j];
            for i in 0..start.len() {
                matrix[(i, j)] -= step * (there.compression[i] - first.compression[i]) / (DIFFERENCE * scale);
            }
        }
        Factors::new(matrix)
    };
    let mut stages: Vec<GrossRates> = Vec::with_capacity(ALEXANDER.matrix.len());
    let mut at = start.clone();
    for (row, time) in ALEXANDER.matrix.iter().zip(ALEXANDER.times) {
        let gathered: Vec<f64> = (0..start.len())
            .map(|i| {
                let before = stages.iter().zip(row).map(|(stage, weight)| weight * stage.compression[i]);
                start[i] + cycles * before.sum::<f64>()
            })
            .collect();
        let spent = stages.iter().zip(row).map(|(stage, weight)| cycles * weight * stage.dissipation);
        let spent = state.dissipated_energy + spent.sum::<f64>();
        let guess = stages.last().unwrap_or(&first);
        let mut dissipation = guess.dissipation;
        for (i, q) in at.iter_mut().enumerate() {
            *q = gathered[i] + cycles * ALEXANDER.diagonal * guess.compression[i];
        }
        let left = (LEFT * tolerance).max(ROUND_OFF) * scale;
        let mut before = f64::INFINITY;
        let mut found = None;
        for _ in 0..ITERATIONS {
            let energy = spent + cycles * ALEXANDER.diagonal * dissipation;
            let there = rates(state.cycles + time * cycles, energy, &at, evaluations)?;
            dissipation = there.dissipation;
            let mut change: Vec<f64> = (0..start.len())
                .map(|i| at[i] - gathered[i] - cycles * ALEXANDER.diagonal * there.compression[i])
                .collect();
            factors.solve(&mut change);
            let size = largest(&change);
            at.iter_mut().zip(&change).for_each(|(q, change)| *q -= change);
            if size <= left {
                found = Some(there);
                break;
            }
            if size.is_nan() || size >= 2.0 * before {
                return None;
            }
            before = size;
        }
        let mut found = found?;
        // The rate that makes the stage exact.
        for (i, rate) in found.compression.iter_mut().enumerate() {
            *rate = (at[i] - gathered[i]) / (cycles * ALEXANDER.diagonal);
        }
        stages.push(found);
    }
    let weights = ALEXANDER.matrix[ALEXANDER.matrix.len() - 1];
    let sum = |part: fn(&GrossRates) -> f64| -> f64 {
        stages.iter().zip(weights).map(|(stage, weight)| cycles * weight * part(stage)).sum()
    };
    let errors = (0..start.len()).map(|i| {
        let parts = stages.iter().zip(weights.iter().zip(ALEXANDER.embedded));
        cycles
            * parts.map(|(stage, (weight, embedded))| (weight - embedded) * stage.compression[i]).sum::<f64>()
    });
    let error = errors.fold(0.0, |most: f64, error| most.max(error.abs())) / scale;
    let stick_radius = stages.iter().map(|stage| stage.stick_radius).fold(f64::INFINITY, f64::min);
    let end = State {
        cycles: state.cycles + cycles,
        slip_area: model.gross_area(gross, &at).ok()?,
        compression: at,
        dissipated_energy: state.dissipated_energy + sum(|stage| stage.dissipation),
        volume_by_rate: state.volume_by_rate + sum(|stage| stage.volume),
        least_stick_radius: state.least_stick_radius.min(stick_radius),
        ..state.clone()
    };
    Some(Trial { state: Some(end), fields: None, error, rate_evaluations: *evaluations, next_step: None })
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}
