//! Newton's method for the compressions and the edge at the end of an implicit stage, with the analytic Jacobian.

use std::sync::Arc;

use faer::Mat;

use super::mixing::Mixing;
use crate::numerics::linear::Factors;
use crate::solver::model::{CycleFields, Drive, Fields, Linearised, Model, StageFactors, State};

/// Newton iterations before the matrix is renewed, and renewals before the step is given up.
pub(super) const ITERATIONS: usize = 8;
pub(super) const RENEWALS: usize = 2;

/// Corrections, relative to `q_c` or the edge, that are round-off.
pub(super) const ROUND_OFF: f64 = 1e-14;

/// Units of round-off in a slip depth of the unworn contact, by a series, and in what springs take away from it, by a sum over all of them.
const RESIDUAL_ROUND_OFF: f64 = 64.0;

/// What a correction by factors of compressed matrices may leave of itself: measured 1e-4 to 0.04, the most at the contact edge.
const NEARLY: f64 = 0.05;

/// Slowest contraction of Newton's corrections that is waited for.
pub(super) const SLOWEST: f64 = 0.5;

/// The largest part of the tolerance of the time stepping that Newton's method may leave, and its bounds.
const OF_TOLERANCE: f64 = 1e-3;
const BOUNDS: [f64; 2] = [1e-12, 1e-5];

/// What a stage is solved for,
///
/// ```text
/// λ - λ̂ - (1 - Ẑ/Z) ξ ∂λ/∂ξ - h W/S = 0 on the inner springs,    w = 0 at the edge.
/// ```
#[derive(Debug)]
pub(super) struct Target {
    /// `λ̂`, what earlier times make of the logarithms, shape `(springs,)`.
    pub log_slip: Vec<f64>,
    /// `Ẑ`, m².
    pub edge: f64,
    /// `h`, cycles.
    pub step: f64,
    /// What acts.
    pub drive: Drive,
}

/// Factors of Newton's matrix.
#[derive(Debug)]
pub(super) enum Factorised {
    Dense(Factors),
    Hierarchical(StageFactors),
}

impl Factorised {
    /// Whether they are near the matrix only.
    fn is_near(&self) -> bool {
        matches!(self, Self::Hierarchical(_))
    }

    /// What a correction leaves of itself because of that.
    fn slack(&self) -> f64 {
        if self.is_near() { NEARLY } else { 0.0 }
    }

    fn solve(&self, rhs: &mut [f64]) {
        match self {
            Self::Dense(factors) => factors.solve(rhs),
            Self::Hierarchical(factors) => factors.solve(rhs),
        }
    }
}

/// Factors that serve several stages or steps, and their memory in between.
#[derive(Debug, Default)]
pub(super) struct Kept {
    factors: Option<Factorised>,
    /// Where they were made; none if they are good for nothing but their memory.
    at: Option<Arc<Linearised>>,
}

impl Kept {
    /// Leaves nothing but the memory.
    pub fn outdate(&mut self) {
        self.at = None;
    }

    /// Where the factors were made.
    pub fn at(&self) -> Option<&Arc<Linearised>> {
        self.at.as_ref()
    }

    /// The factors, made anew if they are outdated, and whether they were.
    fn get(
        &mut self,
        at: impl FnOnce() -> Linearised,
        make: impl FnOnce(Option<Factorised>) -> Factorised,
    ) -> (&Factorised, bool) {
        let fresh = self.at.is_none();
        let memory = if fresh { self.factors.take() } else { None };
        self.at.get_or_insert_with(|| Arc::new(at()));
        (self.factors.get_or_insert_with(|| make(memory)), fresh)
    }
}

/// Newton's method and what it left: the fields and the cycle of the last state tried.
#[derive(Debug)]
pub(super) struct Newton {
    tolerance: f64,
    pub fields: Fields,
    pub cycle: CycleFields,
    /// Largest part of a correction that the next one was.
    pub contraction: f64,
}

impl Newton {
    /// A method that leaves well less than the tolerance of the time stepping.
    pub fn new(tolerance: f64) -> Self {
        let [least, most] = BOUNDS;
        let tolerance = (OF_TOLERANCE * tolerance).clamp(least, most);
        Self { tolerance, fields: Fields::default(), cycle: CycleFields::default(), contraction: 0.0 }
    }

    /// Newton's method for one stage, from and into `at`; leaves the fields there. Whether it converged to a contact.
    pub fn solve(
        &mut self,
        model: &Model,
        target: &Target,
        at: &mut State,
        kept: &mut Kept,
        evaluations: &mut u64,
    ) -> bool {
        let inner = at.compression.len();
        let scale = model.contact().slip_compression();
        if !self.evaluate(model, target, at) {
            return false;
        }
        for _ in 0..=RENEWALS {
            let linearised = || Linearised {
                edge: at.edge,
                gathered_edge: target.edge,
                step: target.step,
                compression: at.compression.clone(),
            };
            let (lu, fresh) =
                kept.get(linearised, |memory| self.factorise(model, target, &at.compression, memory));
            let mut mixing = lu.is_near().then(Mixing::default);
            let mut before = f64::INFINITY;
            self.contraction = 0.0;
            for _ in 0..ITERATIONS {
                let mut change = residual(model, target, &self.fields, &self.cycle.growth);
                lu.solve(&mut change);
                let weight = scale / at.edge;
                let taken = mixing.as_mut().map(|mixing| {
                    // The edge counts as much as a compression.
                    change[inner] *= weight;
                    let mut taken = mixing.improved(&change);
                    change[inner] /= weight;
                    taken[inner] /= weight;
                    taken
                });
                let taken = taken.as_ref().unwrap_or(&change);
                for (q, dq) in at.compression.iter_mut().zip(taken) {
                    *q -= dq;
                }
                at.edge -= taken[inner];
                *evaluations += 1;
                if !self.evaluate(model, target, at) {
                    return false;
                }
                let largest = change[..inner].iter().fold(0.0, |m: f64, dq| m.max(dq.abs())) / scale;
                let size = largest.max(change[inner].abs() / at.edge);
                let left = at.compression.iter().fold(0.0, |m: f64, q| m.max(q.abs())) / scale;
                if before.is_finite() {
                    self.contraction = self.contraction.max(size / before);
                }
                // What is left falls as the corrections do, and the first one with a matrix of its own leaves its square.
                let first = if fresh { (size / left).max(lu.slack()) } else { SLOWEST };
                let part = if before.is_finite() { size / before } else { first }.min(SLOWEST);
                if size * part / (1.0 - part) <= self.tolerance * left || size <= ROUND_OFF {
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
            kept.outdate();
        }
        false
    }

    /// Makes the factors again that were made some steps before.
    pub fn recall(&mut self, model: &Model, drive: &Drive, at: &Arc<Linearised>, kept: &mut Kept) {
        model.evaluate(at.edge, &at.compression, &mut self.fields);
        self.cycle = model.cycle(drive, &at.compression, &self.fields);
        let target =
            Target { log_slip: Vec::new(), edge: at.gathered_edge, step: at.step, drive: drive.clone() };
        let memory = kept.factors.take();
        kept.factors = Some(self.factorise(model, &target, &at.compression, memory));
        kept.at = Some(Arc::clone(at));
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

    /// Recomputes the fields and what a cycle does; whether the state is one of a contact.
    fn evaluate(&mut self, model: &Model, target: &Target, at: &State) -> bool {
        if !(at.edge > 0.0 && at.edge < model.unworn().largest_edge()) {
            return false;
        }
        model.evaluate(at.edge, &at.compression, &mut self.fields);
        if !self.fields.are_physical() {
            return false;
        }
        self.cycle = model.cycle(&target.drive, &at.compression, &self.fields);
        true
    }

    fn factorise(
        &self,
        model: &Model,
        target: &Target,
        compression: &[f64],
        memory: Option<Factorised>,
    ) -> Factorised {
        let theta = 1.0 - target.edge / self.fields.edge;
        let by_edge = self.by_edge(model, target, theta);
        let slopes = model.plain_growth_slopes(&target.drive, &self.fields, &self.cycle, -target.step);
        let (dense, hierarchical) = match memory {
            Some(Factorised::Dense(factors)) => (Some(factors.into_matrix()), None),
            Some(Factorised::Hierarchical(factors)) => (None, Some(factors)),
            None => (None, None),
        };
        let factors = slopes
            .and_then(|slopes| model.stage_factors(&self.fields, theta, slopes, &by_edge, hierarchical));
        match factors {
            Some(factors) => Factorised::Hierarchical(factors),
            None => {
                let n = model.springs();
                let mut matrix = dense.filter(|it| it.nrows() == n).unwrap_or_else(|| Mat::zeros(n, n));
                matrix.fill(0.0);
                self.fill(&mut matrix, model, target, compression, theta, &by_edge);
                Factorised::Dense(Factors::new(matrix))
            }
        }
    }

    /// Derivatives of the stage's equations but for the growth by the edge, shape `(springs,)`.
    fn by_edge(&self, model: &Model, target: &Target, theta: f64) -> Vec<f64> {
        let fields = &self.fields;
        let inner = model.springs() - 1;
        let mut by_edge = model.log_slip_by_edge(fields);
        let carried = model.along_annulus(&by_edge);
        let along = model.along_annulus(&fields.log_slip);
        for i in 0..inner {
            by_edge[i] -= theta * carried[i] + along[i] * target.edge / (fields.edge * fields.edge);
        }
        by_edge
    }

    /// Adds Newton's matrix at the current fields, columns the compressions and then the edge.
    fn fill(
        &self,
        matrix: &mut Mat<f64>,
        model: &Model,
        target: &Target,
        compression: &[f64],
        theta: f64,
        by_edge: &[f64],
    ) {
        let fields = &self.fields;
        let inner = model.springs() - 1;
        model.add_growth_slopes(&target.drive, compression, fields, &self.cycle, -target.step, matrix);
        model.add_log_slip_by_compression(fields, theta, matrix);
        for i in 0..inner {
            matrix[(i, inner)] += by_edge[i];
        }
        let scale = fields.edge.powf(model.mu()) / fields.slip_depth[inner];
        for j in 0..inner {
            matrix[(inner, j)] = -scale * model.elastic_depth_by_compression(fields, inner, j);
        }
        matrix[(inner, inner)] = by_edge[inner];
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
