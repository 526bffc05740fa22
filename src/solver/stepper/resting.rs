//! Equations of an implicit stage where the edge of stick rests, with their analytic Jacobian.

use faer::Mat;

use super::newton::{Correction, Equations, Factorised};
use crate::numerics::linear::Factors;
use crate::solver::model::{Bearing, CycleFields, Fields, Model, StickZone, Target, Unknowns};

/// Corrections, relative to `q_c` or the slip area, that are round-off.
pub(super) const ROUND_OFF: f64 = 1e-14;

/// Units of round-off in a slip depth of the unworn contact, by a series, and in what springs take away from it, by a sum over all of them.
const RESIDUAL_ROUND_OFF: f64 = 64.0;

/// The largest part of the tolerance of the time stepping that Newton's method may leave, and its bounds; the same where that is measured. What quadratic
/// convergence would leave was seen to be a thousandth of what was left.
const OF_TOLERANCE: f64 = 1e-2;
const BOUNDS: [f64; 2] = [1e-12, 1e-5];
const OF_TOLERANCE_MEASURED: f64 = 0.1;
const BOUNDS_MEASURED: [f64; 2] = [1e-13, 1e-4];

/// Change of the compression at the edge of stick, relative, by which slopes of the wear by it are found.
const DIFFERENCE: f64 = 1e-7;

/// Fields and cycle of the unknowns tried last.
#[derive(Debug, Default)]
pub(super) struct Tried {
    pub fields: Fields,
    pub cycle: CycleFields,
}

/// ```text
/// λ - λ̂ - (1 - Ẑ/Z) ξ ∂λ/∂ξ - h W/S = 0 on the inner springs,    w = 0 at the edge.
/// ```
#[derive(Debug)]
pub(super) struct RestingStage<'a> {
    pub model: &'a Model,
    pub target: Target,
    /// An edge of stick at rest under both forces.
    pub bearing: Option<Bearing>,
    /// Of the time stepping.
    pub tolerance: f64,
    pub tried: &'a mut Tried,
}

/// What Newton's method may leave under a tolerance of the time stepping.
pub(super) fn newton_tolerance(tolerance: f64) -> f64 {
    let [least, most] = BOUNDS;
    (OF_TOLERANCE * tolerance).clamp(least, most)
}

/// Whether what is left of the equations of some springs is rounding of their slip, which is a difference of the depths without pressure and with it.
pub(super) fn is_round_off(residual: &[f64], fields: &Fields) -> bool {
    let round_off = |i: usize| {
        let cancelled = fields.unworn[i].limit_slip / fields.slip_depth[i];
        RESIDUAL_ROUND_OFF * f64::EPSILON * (cancelled + fields.log_slip[i].abs())
    };
    residual.iter().enumerate().all(|(i, value)| value.abs() <= round_off(i))
}

impl Equations for RestingStage<'_> {
    fn target(&self) -> &Target {
        &self.target
    }

    fn evaluate(&mut self, at: &Unknowns) -> bool {
        let Self { model, target, bearing, tried, .. } = self;
        if !(at.slip_area > 0.0 && at.slip_area < model.unworn().largest_slip_area()) {
            return false;
        }
        match bearing {
            None => model.evaluate(at.slip_area, &at.compression, &mut tried.fields),
            Some(bearing) => {
                let zone = model.bearing_zone(bearing, at.slip_area, &at.compression);
                if zone.slip_compression.is_nan() || zone.slip_compression <= 0.0 {
                    return false;
                }
                target.loading = model.displaced(target.loading.clone(), zone.slip_compression);
                model.evaluate_at(&zone, at.slip_area, &at.compression, &mut tried.fields);
            }
        }
        if !tried.fields.are_physical() {
            return false;
        }
        tried.cycle = model.cycle(&target.loading, &at.compression, &tried.fields);
        true
    }

    fn residual(&self) -> Vec<f64> {
        let (fields, growth) = (&self.tried.fields, &self.tried.cycle.growth);
        let inner = self.model.springs() - 1;
        let theta = self.theta();
        let mut left = self.model.along_annulus(&fields.log_slip);
        for (i, value) in left.iter_mut().enumerate().take(inner) {
            *value =
                fields.log_slip[i] - self.target.log_slip[i] - theta * *value - self.target.step * growth[i];
        }
        left[inner] = fields.log_slip[inner];
        left
    }

    fn scale(&self) -> f64 {
        match self.bearing {
            None => self.model.contact().slip_compression(),
            Some(_) => self.tried.fields.stick_zone.slip_compression,
        }
    }

    fn factorise(&self, at: &Unknowns, memory: Option<Factorised>) -> Option<Factorised> {
        let (model, target, Tried { fields, cycle }) = (self.model, &self.target, &*self.tried);
        let by_slip_area = self.by_slip_area();
        let slopes = model.plain_growth_slopes(&target.loading, fields, cycle, -target.step);
        let (dense, hierarchical) = match memory {
            Some(Factorised::Dense(factors)) => (Some(factors.into_matrix()), None),
            Some(Factorised::Hierarchical(factors)) => (None, Some(factors)),
            None => (None, None),
        };
        let factors = slopes.and_then(|slopes| {
            model.stage_factors(fields, self.theta(), slopes, &by_slip_area, hierarchical)
        });
        Some(match factors {
            Some(factors) => Factorised::Hierarchical(factors),
            None => {
                let n = model.springs();
                let mut matrix = dense.filter(|it| it.nrows() == n).unwrap_or_else(|| Mat::zeros(n, n));
                matrix.fill(0.0);
                self.fill(&mut matrix, &at.compression, &by_slip_area);
                Factorised::Dense(Factors::new(matrix))
            }
        })
    }

    fn evaluations_of_matrix(&self) -> u64 {
        0
    }

    fn is_last(&self, correction: &Correction) -> bool {
        let [least, most] = BOUNDS_MEASURED;
        let allowed = match correction.measured {
            true => (OF_TOLERANCE_MEASURED * self.tolerance).clamp(least, most),
            false => newton_tolerance(self.tolerance),
        };
        correction.remaining <= allowed * correction.compression || correction.springs <= ROUND_OFF
    }

    fn is_round_off(&self) -> bool {
        is_round_off(&self.residual(), &self.tried.fields)
    }
}

impl RestingStage<'_> {
    /// `1 - Ẑ/Z`.
    fn theta(&self) -> f64 {
        1.0 - self.target.slip_area / self.tried.fields.slip_area
    }

    /// Derivatives of the equations, but for the growth, by the slip area, shape `(springs,)`.
    fn by_slip_area(&self) -> Vec<f64> {
        let (model, fields) = (self.model, &self.tried.fields);
        let inner = model.springs() - 1;
        let mut by_slip_area = model.log_slip_by_slip_area(fields);
        let carried = model.along_annulus(&by_slip_area);
        let along = model.along_annulus(&fields.log_slip);
        let theta = self.theta();
        for i in 0..inner {
            by_slip_area[i] -=
                theta * carried[i] + along[i] * self.target.slip_area / (fields.slip_area * fields.slip_area);
        }
        by_slip_area
    }

    /// Adds Newton's matrix at the current fields, columns the compressions and then the slip area.
    fn fill(&self, matrix: &mut Mat<f64>, compression: &[f64], by_slip_area: &[f64]) {
        let (model, target, Tried { fields, cycle }) = (self.model, &self.target, &*self.tried);
        let inner = model.springs() - 1;
        model.add_growth_slopes(&target.loading, compression, fields, cycle, -target.step, matrix);
        model.add_log_slip_by_compression(fields, self.theta(), matrix);
        for i in 0..inner {
            matrix[(i, inner)] += by_slip_area[i];
        }
        let scale = fields.slip_area.powf(model.mu()) / fields.slip_depth[inner];
        for j in 0..inner {
            matrix[(inner, j)] = -scale * model.elastic_depth_by_compression(fields, inner, j);
        }
        matrix[(inner, inner)] = by_slip_area[inner];
        if let Some(bearing) = &self.bearing {
            let by_stick = self.by_slip_compression(compression);
            for (j, slope) in model.bearing_slopes(bearing, fields, compression).into_iter().enumerate() {
                matrix.col_as_slice_mut(j).iter_mut().zip(&by_stick).for_each(|(to, by)| *to += by * slope);
            }
        }
    }

    /// Derivatives of the equations by `q_c`, which moves all slip alike, 1/m, shape `(springs,)`.
    fn by_slip_compression(&self, compression: &[f64]) -> Vec<f64> {
        let (model, target, Tried { fields, cycle }) = (self.model, &self.target, &*self.tried);
        let inner = model.springs() - 1;
        let zone = fields.stick_zone;
        let per_slip = |i: usize| fields.unworn[i].limit_slip / zone.slip_compression / fields.slip_depth[i];
        let slopes: Vec<f64> = (0..=inner).map(per_slip).collect();
        let carried = model.along_annulus(&slopes);
        let mut by_stick: Vec<f64> = (0..inner).map(|i| slopes[i] - self.theta() * carried[i]).collect();
        by_stick.push(slopes[inner]);
        if model.plain_growth_slopes(&target.loading, fields, cycle, 1.0).is_none() {
            // Plain wear grows in proportion to the slip there is.
            let step = DIFFERENCE * zone.slip_compression;
            let moved = StickZone { slip_compression: zone.slip_compression + step, ..zone };
            let mut nearby = Fields::default();
            model.evaluate_at(&moved, fields.slip_area, compression, &mut nearby);
            let loading = model.displaced(target.loading.clone(), moved.slip_compression);
            let after = model.cycle(&loading, compression, &nearby);
            let growth = after.growth.iter().zip(&cycle.growth);
            for (by, (after, before)) in by_stick.iter_mut().zip(growth).take(inner) {
                *by -= target.step * (after - before) / step;
            }
        }
        by_stick
    }
}
