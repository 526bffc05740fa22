//! Implicit steps over many cycles: L-stable, adaptive, with the analytic Jacobian.

use faer::Mat;

use super::{Stepper, Trial, relative_depth_error};
use crate::error::Result;
use crate::linear::Factors;
use crate::model::{CycleFields, Drive, Fields, Model, State};

/// Singly diagonally implicit Runge-Kutta method, L-stable and stiffly accurate (Alexander, SIAM J. Numer. Anal. 14:1006, 1977), with an
/// embedded method on its first two stages.
///
/// On an ordinary differential equation it is of order 3 with an estimate of order 2. Here the contact edge obeys a constraint whose
/// rate enters the equations (index 2), which costs a method of stage order one an order: the worn volume converges at order 2.
///
/// Each stage solves for the compressions and the edge at once,
///
/// ```text
/// λ - λ̂ - (1 - Ẑ/Z) ξ ∂λ/∂ξ - h γ W/S = 0 on the inner springs,    w = 0 at the edge,
/// ```
///
/// where `λ̂` and `Ẑ` gather the stages before; Newton's matrix is factorised once a step and serves all stages while it converges.
#[derive(Debug)]
pub struct Implicit {
    newton_tolerance: f64,
    fields: Fields,
    cycle: CycleFields,
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

/// Newton iterations before the matrix is renewed, and renewals before the step is given up.
pub(super) const ITERATIONS: usize = 8;
pub(super) const RENEWALS: usize = 2;

/// Corrections, relative to `q_c` or the edge, that are round-off.
pub(super) const ROUND_OFF: f64 = 1e-14;

/// Units of round-off in a slip depth of the unworn contact, by a series, and in what springs take away from it, by a sum over all of them.
const RESIDUAL_ROUND_OFF: f64 = 64.0;

/// Slowest contraction of Newton's corrections that is waited for.
pub(super) const SLOWEST: f64 = 0.5;

impl Implicit {
    /// A stepper whose stages are solved well below the tolerance of the time stepping.
    pub fn new(tolerance: f64) -> Self {
        let newton_tolerance = (1e-3 * tolerance).clamp(1e-12, 1e-8);
        Self { newton_tolerance, fields: Fields::default(), cycle: CycleFields::default() }
    }
}

/// Slopes of one stage.
struct Stage {
    log_slip: Vec<f64>,
    edge: f64,
    dissipation: f64,
    volume: f64,
}

/// What a stage is solved for: the values gathered so far, the step times `γ`, and what acts.
struct Target {
    log_slip: Vec<f64>,
    edge: f64,
    step: f64,
    drive: Drive,
}

impl Stepper for Implicit {
    fn step(&mut self, model: &Model, state: &State, cycles: f64) -> Result<Trial> {
        let mut evaluations = 1;
        model.evaluate(state.edge, &state.compression, &mut self.fields);
        let start = self.fields.log_slip.clone();
        let mut at = self.predict(model, state, TIMES[0] * cycles);
        let mut stages: Vec<Stage> = Vec::with_capacity(STAGES);
        let mut factors = None;
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
            if !self.solve(model, &target, &mut at, &mut factors, &mut evaluations) {
                return Ok(Trial::failed(evaluations));
            }
            let slope = |(now, before): (&f64, &f64)| (now - before) / target.step;
            stages.push(Stage {
                log_slip: self.fields.log_slip.iter().zip(&target.log_slip).map(slope).collect(),
                edge: (at.edge - target.edge) / target.step,
                dissipation: self.cycle.dissipation,
                volume: self.cycle.volume,
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
        at.least_stick_radius = state.least_stick_radius.min(self.cycle.stick_radius);
        let error =
            embedded_error(model, &self.fields, cycles, stages.iter().map(|stage| &stage.log_slip[..]));
        Ok(Trial { state: Some(at), error, rate_evaluations: evaluations })
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
            model.evaluate(at.edge, &at.compression, &mut self.fields);
            if self.fields.are_physical() {
                return at;
            }
        }
        state.clone()
    }

    /// Newton's method for one stage, from and into `at`; leaves the fields there. Whether it converged to a contact.
    fn solve(
        &mut self,
        model: &Model,
        target: &Target,
        at: &mut State,
        factors: &mut Option<Factors>,
        evaluations: &mut u64,
    ) -> bool {
        let inner = at.compression.len();
        let scale = model.contact().slip_compression();
        self.evaluate(model, target, at);
        for _ in 0..=RENEWALS {
            let lu = factors.get_or_insert_with(|| Factors::new(self.matrix(model, target, &at.compression)));
            let mut before = f64::INFINITY;
            for _ in 0..ITERATIONS {
                let mut change = residual(model, target, &self.fields, &self.cycle.growth);
                lu.solve(&mut change);
                for (q, dq) in at.compression.iter_mut().zip(&change) {
                    *q -= dq;
                }
                at.edge -= change[inner];
                if !(at.edge > 0.0 && at.edge < model.unworn().largest_edge()) {
                    return false;
                }
                self.evaluate(model, target, at);
                *evaluations += 1;
                if !self.fields.are_physical() {
                    return false;
                }
                let largest = change[..inner].iter().fold(0.0, |m: f64, dq| m.max(dq.abs())) / scale;
                let size = largest.max(change[inner].abs() / at.edge);
                let left = at.compression.iter().fold(0.0, |m: f64, q| m.max(q.abs())) / scale;
                if size <= self.newton_tolerance * left + ROUND_OFF {
                    return true;
                }
                if size > SLOWEST * before {
                    if self.has_converged(model, target) {
                        return true;
                    }
                    break;
                }
                before = size;
            }
            *factors = None;
        }
        false
    }

    /// Whether no more is left of the stage's equations than the round-off of slip, a difference of the depths without pressure and with it.
    fn has_converged(&self, model: &Model, target: &Target) -> bool {
        let left = residual(model, target, &self.fields, &self.cycle.growth);
        let round_off = |i: usize| {
            let fields = &self.fields;
            let cancelled = fields.unworn[i].limit_slip / fields.slip_depth[i];
            RESIDUAL_ROUND_OFF * f64::EPSILON * (cancelled + fields.log_slip[i].abs())
        };
        left.iter().enumerate().all(|(i, value)| value.abs() <= round_off(i))
    }

    /// Recomputes the fields and what a cycle does.
    fn evaluate(&mut self, model: &Model, target: &Target, at: &State) {
        model.evaluate(at.edge, &at.compression, &mut self.fields);
        self.cycle = model.cycle(&target.drive, &at.compression, &self.fields);
    }

    /// Newton's matrix at the current fields, columns the compressions and then the edge.
    fn matrix(&self, model: &Model, target: &Target, compression: &[f64]) -> Mat<f64> {
        let fields = &self.fields;
        let n = model.springs();
        let inner = n - 1;
        let theta = 1.0 - target.edge / fields.edge;
        let mu = model.mu();
        let mut matrix = Mat::zeros(n, n);
        model.add_growth_slopes(&target.drive, compression, fields, &self.cycle, -target.step, &mut matrix);
        model.add_log_slip_by_compression(fields, theta, &mut matrix);
        let by_edge = model.log_slip_by_edge(fields);
        let carried = model.along_annulus(&by_edge);
        let along = model.along_annulus(&fields.log_slip);
        for i in 0..inner {
            matrix[(i, inner)] +=
                by_edge[i] - theta * carried[i] - along[i] * target.edge / (fields.edge * fields.edge);
        }
        let scale = fields.edge.powf(mu) / fields.slip_depth[inner];
        for j in 0..inner {
            matrix[(inner, j)] = -scale * model.elastic_depth_by_compression(fields, inner, j);
        }
        matrix[(inner, inner)] = by_edge[inner];
        matrix
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

/// What is left of the stage's equations, shape `(springs,)`; the last is `λ` at the edge.
fn residual(model: &Model, target: &Target, fields: &Fields, growth: &[f64]) -> Vec<f64> {
    let inner = model.springs() - 1;
    let theta = 1.0 - target.edge / fields.edge;
    let mut left = model.along_annulus(&fields.log_slip);
    for (i, value) in left.iter_mut().enumerate().take(inner) {
        *value = fields.log_slip[i] - target.log_slip[i] - theta * *value - target.step * growth[i];
    }
    left[inner] = fields.log_slip[inner];
    left
}
