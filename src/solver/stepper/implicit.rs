//! Implicit steps over many cycles: L-stable, adaptive, with the analytic Jacobian.

use super::newton::{Kept, Newton, Target};
use super::{Stepper, Trial, relative_depth_error};
use crate::error::Result;
use crate::solver::model::{Fields, Model, State};

/// Singly diagonally implicit Runge-Kutta method, L-stable and stiffly accurate (Alexander, SIAM J. Numer. Anal. 14:1006, 1977), with an
/// embedded method on its first two stages.
///
/// On an ordinary differential equation it is of order 3 with an estimate of order 2. Here the contact edge obeys a constraint whose
/// rate enters the equations (index 2), which costs a method of stage order one an order: the worn volume converges at order 2.
///
/// Each stage solves for the compressions and the edge at once, with what the stages before gathered; Newton's matrix is factorised once a
/// step and serves all stages while it converges.
#[derive(Debug)]
pub struct Implicit {
    newton: Newton,
    factors: Kept,
}

/// Times of the stages.
pub(super) const TIMES: [f64; STAGES] = [GAMMA, 0.5 * (1.0 + GAMMA), 1.0];
pub(super) const GAMMA: f64 = 0.435_866_521_508_459;
pub(super) const STAGES: usize = 3;
pub(super) const MATRIX: [[f64; STAGES]; STAGES] = [
    [GAMMA, 0.0, 0.0],
    [0.5 * (1.0 - GAMMA), GAMMA, 0.0],
    [
        -0.25 * (6.0 * GAMMA * GAMMA - 16.0 * GAMMA + 1.0),
        0.25 * (6.0 * GAMMA * GAMMA - 20.0 * GAMMA + 5.0),
        GAMMA,
    ],
];
/// Weights of order 2 on the stages at `γ` and `(1+γ)/2`: `b̂_1 = γ/(1-γ)`, `b̂_2 = (1-2γ)/(1-γ)`.
const EMBEDDED: [f64; STAGES] = [GAMMA / (1.0 - GAMMA), (1.0 - 2.0 * GAMMA) / (1.0 - GAMMA), 0.0];

impl Implicit {
    /// A stepper whose stages are solved well below the tolerance of the time stepping.
    pub fn new(tolerance: f64) -> Self {
        Self { newton: Newton::new(tolerance), factors: Kept::default() }
    }
}

/// Slopes of one stage.
struct Stage {
    log_slip: Vec<f64>,
    edge: f64,
    dissipation: f64,
    volume: f64,
}

impl Stepper for Implicit {
    fn step(&mut self, model: &Model, state: &State, cycles: f64) -> Result<Trial> {
        let mut evaluations = 1;
        model.evaluate(state.edge, &state.compression, &mut self.newton.fields);
        let start = self.newton.fields.log_slip.clone();
        let mut at = self.predict(model, state, TIMES[0] * cycles);
        let mut stages: Vec<Stage> = Vec::with_capacity(STAGES);
        self.factors.outdate();
        for (index, row) in MATRIX.into_iter().enumerate() {
            if index > 0 {
                extrapolate(state, &mut at, TIMES[index] / TIMES[index - 1]);
            }
            let gathered = |from: f64, part: &dyn Fn(&Stage) -> f64| {
                from + stages
                    .iter()
                    .zip(row)
                    .map(|(stage, weight)| cycles * weight * part(stage))
                    .sum::<f64>()
            };
            let target = Target {
                log_slip: (0..start.len()).map(|i| gathered(start[i], &|s| s.log_slip[i])).collect(),
                edge: gathered(state.edge, &|s| s.edge),
                step: GAMMA * cycles,
                drive: model.schedule().drive(state.cycles, state.cycles + TIMES[index] * cycles),
            };
            if !self.newton.solve(model, &target, &mut at, &mut self.factors, &mut evaluations) {
                return Ok(Trial::failed(evaluations));
            }
            let slope = |(now, before): (&f64, &f64)| (now - before) / target.step;
            stages.push(Stage {
                log_slip: self.newton.fields.log_slip.iter().zip(&target.log_slip).map(slope).collect(),
                edge: (at.edge - target.edge) / target.step,
                dissipation: self.newton.cycle.dissipation,
                volume: self.newton.cycle.volume,
            });
        }
        let weights = MATRIX[STAGES - 1];
        at.edge_rate = (at.edge - state.edge) / cycles;
        for ((rate, now), before) in
            at.compression_rate.iter_mut().zip(&at.compression).zip(&state.compression)
        {
            *rate = (now - before) / cycles;
        }
        at.cycles = state.cycles + cycles;
        let summed = |part: &dyn Fn(&Stage) -> f64| {
            stages.iter().zip(weights).map(|(stage, weight)| cycles * weight * part(stage)).sum::<f64>()
        };
        at.dissipated_energy = state.dissipated_energy + summed(&|stage| stage.dissipation);
        at.volume_by_rate = state.volume_by_rate + summed(&|stage| stage.volume);
        at.least_stick_radius = state.least_stick_radius.min(self.newton.cycle.stick_radius);
        let error = embedded_error(
            model,
            &self.newton.fields,
            cycles,
            stages.iter().map(|stage| &stage.log_slip[..]),
        );
        Ok(Trial { state: Some(at), fields: None, error, rate_evaluations: evaluations, next_step: None })
    }

    fn estimate_order(&self) -> f64 {
        3.0
    }
}

impl Implicit {
    /// The state some cycles on, at the rates of the last step, as long as it is one of a contact.
    fn predict(&mut self, model: &Model, state: &State, cycles: f64) -> State {
        let mut at = state.clone();
        at.edge += cycles * at.edge_rate;
        for (q, rate) in at.compression.iter_mut().zip(&at.compression_rate) {
            *q += cycles * rate;
        }
        if at.edge > 0.0 && at.edge < model.unworn().largest_edge() {
            model.evaluate(at.edge, &at.compression, &mut self.newton.fields);
            if self.newton.fields.are_physical() {
                return at;
            }
        }
        state.clone()
    }
}

/// Estimated error of a step of `cycles` cycles from the slopes of `λ` in its stages: the difference to the embedded method.
pub(super) fn embedded_error<'a>(
    model: &Model,
    fields: &Fields,
    cycles: f64,
    slopes: impl Iterator<Item = &'a [f64]> + Clone,
) -> f64 {
    let weights = MATRIX[STAGES - 1].into_iter().zip(EMBEDDED);
    let difference = |i: usize| -> f64 {
        let parts = slopes.clone().zip(weights.clone());
        parts.map(|(slopes, (weight, embedded))| cycles * (weight - embedded) * slopes[i]).sum()
    };
    let depths = (0..model.springs() - 1).map(|i| fields.slip_depth[i] * difference(i));
    relative_depth_error(model, depths)
}

/// Continues the straight line from a state to a later one, as a first guess of Newton's method.
fn extrapolate(from: &State, to: &mut State, factor: f64) {
    to.edge = from.edge + (to.edge - from.edge) * factor;
    for (q, start) in to.compression.iter_mut().zip(&from.compression) {
        *q = start + (*q - start) * factor;
    }
}
