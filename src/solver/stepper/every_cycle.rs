//! The definition: one update by Archard's law per period.

use super::{Stepper, Trial};
use crate::error::{Error, Result};
use crate::solver::model::{Fields, Model, State};

/// Every period by itself: the slip depth at each radius grows by the factor `1 + W/S` of that period.
///
/// The springs move with the contact edge, so `λ` is carried to their new places by its slope along the annulus; as a period moves the
/// edge by little, what that leaves out is of second order in the wear of one period.
#[derive(Debug, Default)]
pub struct EveryCycle {
    fields: Fields,
}

impl Stepper for EveryCycle {
    fn name(&self) -> &'static str {
        "every cycle"
    }

    fn step(&mut self, model: &Model, state: &State, cycles: f64) -> Result<Trial> {
        let fields = &mut self.fields;
        model.evaluate(state.slip_area, &state.compression, fields);
        let loading = model.loading(state, state.cycles);
        let loading = model.after_energy(loading, state.dissipated_energy);
        let cycle = model.cycle(&loading, &state.compression, fields);
        let mut worn = fields.log_slip.clone();
        for (log_slip, growth) in worn.iter_mut().zip(&cycle.growth) {
            *log_slip += (cycles * growth).ln_1p();
        }
        let along = model.along_annulus(&worn);
        let shifted = |slip_area: f64, i: usize| worn[i] + (slip_area / state.slip_area).ln() * along[i];
        let mut evaluations = 1;
        let mut mismatch = |slip_area: f64| {
            evaluations += 1;
            model.contact_edge_mismatch(slip_area, |i, unworn| unworn.slip * shifted(slip_area, i).exp())
        };
        let Some(slip_area) = secant(&mut mismatch, state.slip_area) else {
            return Err(too_coarse(state, "no contact edge fits the wear of this cycle"));
        };
        let compression = model.compression(slip_area, |i, unworn| unworn.slip * shifted(slip_area, i).exp());
        let slipping = model.contact().slip_compression();
        if !compression.iter().all(|q| *q > -1e-9 * slipping && *q < (1.0 + 1e-9) * slipping) {
            return Err(too_coarse(
                state,
                "the wear of this cycle presses springs beyond the limiting shape",
            ));
        }
        let next = State {
            cycles: state.cycles + cycles,
            slip_area,
            compression,
            dissipated_energy: state.dissipated_energy + cycles * cycle.dissipation,
            volume_by_rate: state.volume_by_rate + cycles * cycle.volume,
            least_stick_radius: state.least_stick_radius.min(cycle.stick_radius),
            ..state.clone()
        };
        Ok(Trial {
            state: Some(next),
            fields: None,
            error: 0.0,
            rate_evaluations: evaluations,
            next_step: None,
        })
    }

    fn estimate_order(&self) -> f64 {
        1.0
    }

    fn prescribed_step(&self) -> Option<f64> {
        Some(1.0)
    }
}

/// Root of a nearly linear function near `start`, to round-off.
fn secant(function: &mut impl FnMut(f64) -> f64, start: f64) -> Option<f64> {
    let (mut a, mut b) = (start, start * (1.0 + 1e-6));
    let (mut f_a, mut f_b) = (function(a), function(b));
    for _ in 0..30 {
        if f_b == 0.0 || f_b == f_a {
            break;
        }
        let c = b - f_b * (b - a) / (f_b - f_a);
        if !(c > 0.5 * start && c < 2.0 * start) {
            return None;
        }
        if (c - b).abs() <= 1e-15 * c {
            return Some(c);
        }
        (a, f_a, b) = (b, f_b, c);
        f_b = function(b);
    }
    f_b.is_finite().then_some(b)
}

fn too_coarse(state: &State, why: &str) -> Error {
    Error::Inconsistent {
        what: "numerics.stepper",
        why: format!(
            "\"every-cycle\": {why} (cycle {}); one cycle is too coarse a step for this scene and its springs: reduce numerics.springs, \
             or take the stepper \"implicit\"",
            state.cycles
        ),
    }
}
