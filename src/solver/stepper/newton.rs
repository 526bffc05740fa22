//! Newton's method for the equations of one implicit stage.

use std::sync::Arc;

use super::mixing::Mixing;
use crate::numerics::linear::{Factors, largest_magnitude};
use crate::solver::model::{Linearised, StageFactors, Target, Unknowns};

/// Newton iterations before the matrix is renewed, and renewals before the step is given up; the same where the matrix takes no evaluations.
const ITERATIONS: usize = 8;
const RENEWALS: usize = 2;
const FREE_RENEWALS: usize = 6;

/// Contraction from which on a matrix that takes no evaluations is renewed: next to the contact edge the equations bend within a correction of it,
/// and with the matrix of the first guess corrections may fall by a half only.
const RENEWED: f64 = 0.03;

/// What a correction by factors of compressed matrices may leave of itself: measured 1e-4 to 0.04, the most at the contact edge.
const NEARLY: f64 = 0.05;

/// Mixed corrections before a step is given up.
const MIXED_CORRECTIONS: usize = 16;

/// Over kinks: corrections before a step is given up; most by which what is left of the equations may grow in one; the part of itself to which it is shortened until it
/// does not, and how often; what is left that counts as nothing, since rounding is of that size; and the most that the last correction may leave.
const KINKED_CORRECTIONS: usize = 24;
const GROWN: f64 = 2.0;
const SHORTENED: f64 = 0.25;
const MOST_SHORTENED: usize = 4;
const NEGLIGIBLE: f64 = 1e-9;
const LEFT: f64 = 1e-8;

/// Slowest contraction of Newton's corrections that is waited for.
const SLOWEST: f64 = 0.5;

/// Equations of a stage, with what was computed at the unknowns tried last.
pub(super) trait Equations {
    /// What the stage starts from.
    fn target(&self) -> &Target;

    /// Recomputes everything that follows from the unknowns; whether they are those of a contact.
    fn evaluate(&mut self, at: &Unknowns) -> bool;

    /// What is left of the equations: those of the inner springs, of the contact edge, and of what else is solved for.
    fn residual(&self) -> Vec<f64>;

    /// Compression at the edge of stick, m, by which corrections are measured.
    fn scale(&self) -> f64;

    /// Factors of Newton's matrix, in the memory of others that are not needed any more; none if it is not found.
    fn factorise(&self, at: &Unknowns, memory: Option<Factorised>) -> Option<Factorised>;

    /// Evaluations of pressure, slip and wear that the matrix takes.
    fn evaluations_of_matrix(&self) -> u64;

    /// Whether a correction was the last one needed.
    fn is_last(&self, correction: &Correction) -> bool;

    /// Whether round-off is all that is left of the equations, where corrections stopped falling.
    fn is_round_off(&self) -> bool;
}

/// How large a correction was.
#[derive(Debug)]
pub(super) struct Correction {
    /// Of compressions, over that at the edge of stick, and of the slip area, relative.
    pub springs: f64,
    /// Of the edge of stick, where that is solved for.
    pub stick: f64,
    /// Estimate of what is left to correct.
    pub remaining: f64,
    /// Whether that is the next correction, and not what quadratic convergence would leave.
    pub measured: bool,
    /// Largest compression over that at the edge of stick.
    pub compression: f64,
}

impl Correction {
    fn new(change: &[f64], at: &Unknowns, scale: f64) -> Self {
        let (of_springs, others) = change.split_at(at.compression.len());
        let relative = |values: &[f64]| largest_magnitude(values) / scale;
        let stick = match others {
            [_, area, depths @ ..] => (area.abs() / at.stick_area).max(relative(depths)),
            _ => 0.0,
        };
        Self {
            springs: relative(of_springs).max(others[0].abs() / at.slip_area),
            stick,
            remaining: f64::INFINITY,
            measured: false,
            compression: relative(&at.compression),
        }
    }

    fn size(&self) -> f64 {
        self.springs.max(self.stick)
    }
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

    /// The correction that they ask for where the equations were evaluated.
    fn correction(&self, equations: &dyn Equations) -> Vec<f64> {
        let mut change = equations.residual();
        self.solve(&mut change);
        change
    }

    fn solve(&self, rhs: &mut [f64]) {
        match self {
            Self::Dense(factors) => factors.solve(rhs),
            Self::Hierarchical(factors) => factors.solve(rhs),
        }
    }
}

/// Newton's method, with the factors of its matrix, which serve several stages or steps while it converges.
#[derive(Debug, Default)]
pub(super) struct Newton {
    factors: Option<Factorised>,
    /// Where the factors were made; none if they are good for nothing but their memory.
    linearised: Option<Arc<Linearised>>,
    /// Largest part of a correction that the next one was.
    pub contraction: f64,
    /// Whether corrections may be shortened where whole ones do not converge, as over kinks.
    pub by_parts: bool,
    /// Whether corrections are mixed where whole ones fall slowly.
    mixes: bool,
    /// Whether whole corrections fell, but slowly, with a matrix of their own.
    is_slow: bool,
}

impl Newton {
    /// # Arguments
    /// * `mixes` -- whether corrections are mixed where whole ones fall slowly
    pub fn mixing(mixes: bool) -> Self {
        Self { mixes, ..Self::default() }
    }

    /// Solves the equations of a stage, from and into `at`, and leaves them evaluated there; whether it converged to a contact.
    pub fn solve(&mut self, equations: &mut dyn Equations, at: &mut Unknowns, evaluations: &mut u64) -> bool {
        let start = self.by_parts.then(|| at.clone());
        self.by_whole_corrections(equations, at, evaluations)
            || self.mixes && self.is_slow && self.by_mixed_corrections(equations, at, evaluations)
            || start.is_some_and(|start| {
                *at = start;
                self.by_parts_of_corrections(equations, at, evaluations)
            })
    }

    /// Corrections each by a matrix of its own, where whole ones fall slowly: at a root that is nearly a multiple one, those before tell how much of each to take.
    fn by_mixed_corrections(
        &mut self,
        equations: &mut dyn Equations,
        at: &mut Unknowns,
        evaluations: &mut u64,
    ) -> bool {
        let mut mixing = Mixing::default();
        let mut least = f64::INFINITY;
        for _ in 0..MIXED_CORRECTIONS {
            *evaluations += equations.evaluations_of_matrix() + 1;
            self.factorise(equations, at);
            let Some(factors) = &self.factors else { return false };
            let mut change = factors.correction(equations);
            let size = Correction::new(&change, at, equations.scale()).size();
            if size.is_nan() || size >= GROWN * least {
                break;
            }
            least = least.min(size);
            at.correct(&mixed(&mut mixing, &mut change, at, equations.scale()));
            if !equations.evaluate(at) {
                return false;
            }
            let mut correction = Correction::new(&change, at, equations.scale());
            correction.remaining = size;
            if equations.is_last(&correction) {
                return true;
            }
        }
        self.outdate();
        false
    }

    /// Corrections that are shortened where what is left of the equations would grow, each by a matrix of its own.
    fn by_parts_of_corrections(
        &mut self,
        equations: &mut dyn Equations,
        at: &mut Unknowns,
        evaluations: &mut u64,
    ) -> bool {
        if !equations.evaluate(at) {
            return false;
        }
        for _ in 0..KINKED_CORRECTIONS {
            *evaluations += equations.evaluations_of_matrix();
            self.factorise(equations, at);
            let Some(factors) = &self.factors else { return false };
            let change = factors.correction(equations);
            let Some(is_whole) = correct_by_part(equations, at, &change, evaluations) else { return false };
            let left = largest_magnitude(&equations.residual());
            if is_whole && left <= LEFT && equations.is_last(&Correction::new(&change, at, equations.scale()))
            {
                return true;
            }
        }
        self.outdate();
        false
    }

    fn by_whole_corrections(
        &mut self,
        equations: &mut dyn Equations,
        at: &mut Unknowns,
        evaluations: &mut u64,
    ) -> bool {
        self.is_slow = false;
        if !equations.evaluate(at) {
            return false;
        }
        let free = equations.evaluations_of_matrix() == 0;
        for _ in 0..=if free { FREE_RENEWALS } else { RENEWALS } {
            let fresh = self.linearised.is_none();
            if fresh {
                *evaluations += equations.evaluations_of_matrix();
                self.factorise(equations, at);
            }
            let Some(factors) = &self.factors else { return false };
            let mut mixing = factors.is_near().then(Mixing::default);
            let (mut before, mut ahead) = (f64::INFINITY, None);
            self.contraction = 0.0;
            for _ in 0..ITERATIONS {
                let mut change = ahead.take().unwrap_or_else(|| factors.correction(equations));
                match &mut mixing {
                    Some(mixing) => at.correct(&mixed(mixing, &mut change, at, equations.scale())),
                    None => at.correct(&change),
                }
                *evaluations += 1;
                if !equations.evaluate(at) {
                    return false;
                }
                let mut correction = Correction::new(&change, at, equations.scale());
                let size = correction.size();
                if before.is_finite() {
                    self.contraction = self.contraction.max(size / before);
                }
                // What is left falls as the corrections do, and the first one with a matrix of its own leaves its square.
                let first =
                    if fresh { (size / correction.compression).max(factors.slack()) } else { SLOWEST };
                let part = if before.is_finite() { size / before } else { first }.min(SLOWEST);
                correction.remaining = size * part / (1.0 - part);
                let mut slow = false;
                if mixing.is_none() && free {
                    // What the next correction would take away is what this one left.
                    let next = factors.correction(equations);
                    let left = Correction::new(&next, at, equations.scale()).size();
                    (correction.remaining, correction.measured) = (left, true);
                    slow = left > RENEWED * size;
                    ahead = Some(next);
                }
                if equations.is_last(&correction) {
                    return true;
                }
                if size > SLOWEST * before {
                    if equations.is_round_off() {
                        return true;
                    }
                    self.is_slow = !free && fresh && size < GROWN * before;
                    break;
                }
                if slow {
                    break;
                }
                before = size;
            }
            self.outdate();
        }
        false
    }

    /// Leaves nothing of the factors but their memory.
    pub fn outdate(&mut self) {
        self.linearised = None;
    }

    /// Where the factors were made, while they serve.
    pub fn linearised(&self) -> Option<&Arc<Linearised>> {
        self.linearised.as_ref()
    }

    /// Makes the factors again that were made some steps before.
    pub fn recall(&mut self, equations: &mut dyn Equations, at: &Arc<Linearised>) {
        let unknowns = Unknowns {
            compression: at.compression.clone(),
            slip_area: at.slip_area,
            stick_area: 0.0,
            stick_depth: 0.0,
            slip_compression: 0.0,
        };
        self.outdate();
        if equations.evaluate(&unknowns) {
            self.factorise(equations, &unknowns);
            self.linearised = Some(Arc::clone(at));
        }
    }

    fn factorise(&mut self, equations: &dyn Equations, at: &Unknowns) {
        let memory = self.factors.take();
        self.factors = equations.factorise(at, memory);
        let target = equations.target();
        self.linearised = Some(Arc::new(Linearised {
            cycles: target.cycles,
            slip_area: at.slip_area,
            gathered_slip_area: target.slip_area,
            step: target.step,
            compression: at.compression.clone(),
        }));
    }
}

/// Takes a correction away, or the part of it after which what is left of the equations has not grown, or the least part that is tried; whether it was the whole. None
/// if the least leads to no contact.
fn correct_by_part(
    equations: &mut dyn Equations,
    at: &mut Unknowns,
    change: &[f64],
    evaluations: &mut u64,
) -> Option<bool> {
    let (start, before) = (at.clone(), largest_magnitude(&equations.residual()));
    let mut part = change.to_vec();
    let mut found = false;
    for times in 0..=MOST_SHORTENED {
        *at = start.clone();
        at.correct(&part);
        *evaluations += 1;
        found = equations.evaluate(at);
        if found && largest_magnitude(&equations.residual()) <= (GROWN * before).max(NEGLIGIBLE) {
            return Some(times == 0);
        }
        part.iter_mut().for_each(|it| *it *= SHORTENED);
    }
    found.then_some(false)
}

/// A correction improved by those before.
fn mixed(mixing: &mut Mixing, change: &mut [f64], at: &Unknowns, scale: f64) -> Vec<f64> {
    let inner = at.compression.len();
    // Areas count as much as a compression.
    let weights = [scale / at.slip_area, scale / at.stick_area];
    let weigh =
        |of_areas: &mut [f64]| of_areas.iter_mut().zip(&weights).for_each(|(it, weight)| *it *= weight);
    weigh(&mut change[inner..]);
    let mut taken = mixing.improved(change);
    for values in [change, &mut taken] {
        values[inner..].iter_mut().zip(&weights).for_each(|(it, weight)| *it /= weight);
    }
    taken
}
