//! Equations of an implicit stage where the edge of stick moves, for Newton's method.

use super::newton::{Correction, Equations, Factorised, Newton};
use super::resting::{ROUND_OFF, is_round_off, newton_tolerance};
use crate::numerics::linear::Factors;
use crate::solver::model::{Model, StickStage, StickTrial, Target, Unknowns};

/// Most that Newton's method may leave: the edge of stick takes more digits than the springs.
const MOST_LEFT: f64 = 1e-8;

/// Corrections of the edge of stick, relative, that are round-off of the balance that decides it.
const STICK_ROUND_OFF: f64 = 1e-11;

/// Roundings of an edge of stick that recedes that no correction of the springs is below.
const ROUNDINGS: f64 = 4.0;

/// What may be left of a balance of forces, relative, and that is not rounding.
const BALANCED: f64 = 1e-12;

/// A stage and what was found at the unknowns tried last.
pub(super) struct MovingStage<'a> {
    stage: StickStage<'a>,
    /// What Newton's method may leave.
    tolerance: f64,
    held: f64,
    /// Corrections of the springs, relative to `q_c`, that come of the rounding of the edge of stick.
    round_off: f64,
    /// The same of the edge of stick.
    stick_round_off: f64,
    /// What may be left of a balance of forces, relative.
    balanced: f64,
    trial: &'a mut StickTrial,
}

impl<'a> MovingStage<'a> {
    pub fn new(stage: StickStage<'a>, tolerance: f64, model: &Model, trial: &'a mut StickTrial) -> Self {
        let tolerance = newton_tolerance(tolerance).min(MOST_LEFT);
        let held = model.contact().indentation();
        // What is solved for is the height of the profile at the edge, and `q_c` what is left of the indentation above it.
        let of_compression = ROUNDINGS * f64::EPSILON * held / stage.target().slip_compression;
        let stick_round_off = (STICK_ROUND_OFF * stage.magnified_rounding()).max(of_compression);
        let round_off = ROUNDINGS * stage.rounding() + of_compression;
        let balanced = BALANCED.max(of_compression);
        Self { stage, tolerance, held, round_off, stick_round_off, balanced, trial }
    }

    /// Whether what is left of the equations of the inner springs and of the contact edge is rounding.
    fn is_round_off_of_slip(&self) -> bool {
        let springs = self.stage.target().springs.log_slip.len();
        let residual = &self.trial.residual[..springs];
        residual.iter().all(|it| it.abs() <= self.tolerance) && is_round_off(residual, &self.trial.fields)
    }

    /// What is left of the balances, behind the equations of springs and edges.
    fn balances(&self) -> &[f64] {
        &self.trial.residual[self.stage.target().springs.log_slip.len() + 1..]
    }

    /// Newton's method from a guess; where the compression at the edge of stick is known, with that one: next to the edge slip is the small
    /// difference of both.
    pub fn solve(&mut self, at: &mut Unknowns, newton: &mut Newton, evaluations: &mut u64) -> bool {
        if let Some(known) = self.stage.known_slip_compression() {
            let factor = known / (self.held - at.stick_depth);
            at.compression.iter_mut().for_each(|q| *q *= factor);
            at.stick_depth = self.held - known;
        }
        self.stage.scale(at);
        *evaluations += 1;
        newton.solve(self, at, evaluations)
    }
}

impl Equations for MovingStage<'_> {
    fn target(&self) -> &Target {
        &self.stage.target().springs
    }

    fn evaluate(&mut self, at: &Unknowns) -> bool {
        self.stage.evaluate(at, self.trial)
    }

    fn residual(&self) -> Vec<f64> {
        self.trial.residual.clone()
    }

    fn scale(&self) -> f64 {
        self.trial.stick_zone.slip_compression
    }

    fn factorise(&self, at: &Unknowns, _: Option<Factorised>) -> Option<Factorised> {
        self.stage.matrix(at, self.trial).map(|matrix| Factorised::Dense(Factors::new(matrix)))
    }

    fn evaluations_of_matrix(&self) -> u64 {
        4
    }

    fn is_last(&self, correction: &Correction) -> bool {
        let allowed = self.tolerance * correction.compression + 10.0 * ROUND_OFF + self.round_off;
        (correction.springs <= allowed || self.is_round_off_of_slip())
            && correction.stick <= self.stick_round_off
            && self.balances().iter().all(|it| it.abs() <= self.balanced)
    }

    /// The edge of stick has to be found to the last digit.
    fn is_round_off(&self) -> bool {
        false
    }
}
