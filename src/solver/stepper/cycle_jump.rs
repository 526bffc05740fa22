//! Explicit steps over many cycles with an embedded estimate of their error.

use super::tableau::BOGACKI_SHAMPINE;
use super::{Stepper, Trial, relative_depth_error};
use crate::error::Result;
use crate::solver::model::{Fields, Model, State};

/// Bogacki and Shampine's explicit Runge-Kutta method of order 3 with an embedded one of order 2.
#[derive(Debug, Default)]
pub struct CycleJump {
    fields: Fields,
}

/// Rates at one stage.
struct Stage {
    slip_area: f64,
    compression: Vec<f64>,
    dissipation: f64,
    volume: f64,
}

impl Stepper for CycleJump {
    fn name(&self) -> &'static str {
        "explicit Runge-Kutta of order 3"
    }

    fn step(&mut self, model: &Model, state: &State, cycles: f64) -> Result<Trial> {
        let mut stages: Vec<Stage> = vec![];
        let mut at = state.clone();
        for weights in BOGACKI_SHAMPINE.stages {
            at = advance(state, cycles, weights, &stages);
            let loading = model.loading(state, at.cycles);
            let loading = model.after_energy(loading, at.dissipated_energy);
            if !(at.slip_area > 0.0 && at.slip_area < model.unworn().largest_slip_area()) {
                return Ok(Trial::failed(stages.len() as u64));
            }
            model.evaluate(at.slip_area, &at.compression, &mut self.fields);
            if !self.fields.are_physical() {
                return Ok(Trial::failed(stages.len() as u64 + 1));
            }
            let cycle = model.cycle(&loading, &at.compression, &self.fields);
            let (slip_area, compression) = model.rates(&self.fields, &cycle);
            at.least_stick_radius = state.least_stick_radius.min(cycle.stick_radius);
            stages.push(Stage {
                slip_area,
                compression,
                dissipation: cycle.dissipation,
                volume: cycle.volume,
            });
        }
        let difference = advance(
            &State { compression: vec![0.0; at.compression.len()], ..at.clone() },
            cycles,
            &BOGACKI_SHAMPINE.error,
            &stages,
        );
        let error = self.depth_error(model, &difference.compression);
        let Ok(slip_area) = model.close_contact_edge(at.slip_area, &at.compression) else {
            return Ok(Trial::failed(4));
        };
        Ok(Trial {
            state: Some(State { slip_area, ..at }),
            fields: None,
            error,
            rate_evaluations: 5,
            next_step: None,
        })
    }

    fn estimate_order(&self) -> f64 {
        3.0
    }
}

impl CycleJump {
    /// Wear depth that belongs to a difference of compressions, relative to the largest of the limit.
    fn depth_error(&self, model: &Model, difference: &[f64]) -> f64 {
        let density: Vec<f64> =
            difference.iter().zip(&self.fields.density_factor).map(|(q, factor)| q * factor).collect();
        let mut depth = vec![0.0; model.springs()];
        model.operators().transforms()[0].apply(&density, &mut depth);
        let scale = self.fields.slip_area.powf(model.mu());
        relative_depth_error(model, depth.into_iter().map(|value| scale * value))
    }
}

/// The state moved by a weighted sum of the stages' rates.
fn advance(state: &State, cycles: f64, weights: &[f64], stages: &[Stage]) -> State {
    let mut next = state.clone();
    for (weight, stage) in weights.iter().zip(stages) {
        let step = cycles * weight;
        next.cycles += step;
        next.slip_area += step * stage.slip_area;
        next.dissipated_energy += step * stage.dissipation;
        next.volume_by_rate += step * stage.volume;
        for (q, rate) in next.compression.iter_mut().zip(&stage.compression) {
            *q += step * rate;
        }
    }
    next
}
