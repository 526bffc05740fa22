//! Pressure that debris spreads over the surface, where the law of wear is not local.

use faer::Mat;

use super::edge_in_block::AtRest;
use super::motion::Motion;
use super::schedule::CycleLoading;
use super::{Fields, Model};
use crate::laws::wear::Spreading;
use crate::numerics::linear::{dot, product};

impl Model {
    /// How far debris fills the gap under a spring of some compression at the largest indentation, and the derivative; whole at the contact
    /// edge, for which there is no compression.
    pub(super) fn filled(
        &self,
        loading: &CycleLoading,
        spreading: Spreading,
        compression: Option<f64>,
    ) -> (f64, f64) {
        compression.map_or((1.0, 0.0), |compression| {
            spreading.filled(compression - loading.least_lift(), self.contact.slip_compression())
        })
    }

    /// How the pressure that debris passes on follows the compressions, over the factor of Eq. (21).
    pub(super) fn spread_pressure(
        &self,
        loading: &CycleLoading,
        motion: &Motion,
        compression: &[f64],
        fields: &Fields,
        spreading: Spreading,
    ) -> Mat<f64> {
        let (n, inner) = (self.springs(), self.springs() - 1);
        let steps = motion.load.ncols();
        let mut pressed = Mat::zeros(n, steps);
        self.pressures(&mut pressed, &motion.load, self.pressure_scale(fields));
        let scale = self.contact.mean_pressure();
        let mean = |i: usize| pressed.row(i).iter().sum::<f64>() / steps as f64;
        let slopes: Vec<f64> = (0..n).map(|i| spreading.passed_on(mean(i), scale).1).collect();
        let mut touching = Mat::zeros(n, inner);
        for j in 0..inner {
            let column = touching.col_as_slice_mut(j);
            self.annulus().operators.abel.add_pressure(j, 1.0, column);
            column.iter_mut().zip(&slopes).for_each(|(to, slope)| *to *= slope);
        }
        let mut spread = Mat::zeros(n, inner);
        let averages = self.debris(loading, motion.at_rest, compression, fields).averages(spreading);
        product(spread.as_mut(), averages.as_ref(), touching.as_ref(), 1.0);
        for i in 0..n {
            let (filled, _) = self.filled(loading, spreading, compression.get(i).copied());
            (0..inner).for_each(|j| spread[(i, j)] *= filled);
        }
        spread
    }

    /// Pressure at the springs, Pa, shape `(springs, steps)`, as debris passes it on: no tension, and into gaps that it can fill.
    pub(super) fn pass_on(
        &self,
        loading: &CycleLoading,
        spreading: Spreading,
        debris: &Debris,
        compression: &[f64],
        pressure: &mut Mat<f64>,
    ) {
        let mean = self.contact.mean_pressure();
        for m in 0..pressure.ncols() {
            pressure.col_as_slice_mut(m).iter_mut().for_each(|p| *p = spreading.passed_on(*p, mean).0);
        }
        debris.spread(spreading, pressure);
        for i in 0..pressure.nrows() {
            let (filled, _) = self.filled(loading, spreading, compression.get(i).copied());
            (0..pressure.ncols()).for_each(|m| pressure[(i, m)] *= filled);
        }
    }

    /// Where debris lies: where springs slip, alone.
    pub(super) fn debris(
        &self,
        loading: &CycleLoading,
        at_rest: AtRest,
        compression: &[f64],
        fields: &Fields,
    ) -> Debris {
        let inside = fields.stick_zone.stick_area.sqrt();
        Debris::new(
            self.spring_radii(fields),
            inside,
            self.slipping_between(loading, at_rest, compression, fields),
        )
    }
}

/// Where debris lies.
pub(super) struct Debris {
    /// Radii of the springs, m.
    radii: Vec<f64>,
    /// Widths of the rings that they stand for, m, as far as debris lies there.
    widths: Vec<f64>,
    /// Radius where the contact ends, m.
    edge: f64,
    /// Whether debris comes from beyond the axis as well: all of the contact slips.
    crosses: bool,
}

impl Debris {
    /// Debris between two radii of slip, m.
    ///
    /// # Arguments
    /// * `radii` -- of the springs, m
    /// * `inside` -- where their mesh begins, m; on the axis debris comes from beyond it as well
    pub(super) fn new(radii: Vec<f64>, inside: f64, [slips, edge]: [f64; 2]) -> Self {
        let last = radii.len() - 1;
        let width = |j: usize| {
            let before = if j == 0 { inside } else { radii[j - 1] };
            let next = radii[(j + 1).min(last)];
            let from = if j == 0 && inside == 0.0 { 0.0 } else { 0.5 * (before + radii[j]) };
            let [from, to] = [from, 0.5 * (radii[j] + next)].map(|end| end.max(slips).min(edge));
            to - from
        };
        let widths = (0..=last).map(width).collect();
        Self { radii, widths, edge, crosses: inside == 0.0 }
    }

    /// Weight of one spring in the average at another.
    fn weight(&self, spreading: Spreading, i: usize, j: usize) -> f64 {
        let [one, other] = [self.radii[i], self.radii[j]];
        let beyond = if self.crosses { spreading.weight(one + other) } else { 0.0 };
        spreading.weight(one - other) + beyond
    }

    /// Spreads pressures at the springs, shape `(springs, steps)`, by [`Debris::averages`], without that matrix.
    pub(super) fn spread(&self, spreading: Spreading, pressure: &mut Mat<f64>) {
        let Self { radii, widths, edge, .. } = self;
        let n = radii.len();
        // Of each pair of springs the weight is found once: columns of the pressures beside one for the sums of the weights.
        let steps = pressure.ncols();
        let part = |i: usize, m: usize| if m < steps { widths[i] * pressure[(i, m)] } else { widths[i] };
        let parts = Mat::from_fn(n, steps + 1, part);
        let mut spread = Mat::from_fn(n, steps + 1, |i, m| self.weight(spreading, i, i) * parts[(i, m)]);
        let mut weights = vec![0.0; n];
        for j in 0..n {
            let mut near = 0;
            for (i, weight) in (j + 1..n).map(|i| (i, self.weight(spreading, i, j))) {
                if weight == 0.0 {
                    break;
                }
                weights[near] = weight;
                near = i - j;
            }
            let (weights, ahead) = (&weights[..near], j + 1..j + 1 + near);
            for m in 0..=steps {
                let from = parts.col_as_slice(m);
                let to = spread.col_as_slice_mut(m);
                to[j] += dot(weights, &from[ahead.clone()]);
                to[ahead.clone()].iter_mut().zip(weights).for_each(|(to, weight)| *to += weight * from[j]);
            }
        }
        for i in 0..n {
            let kept = part_of(spreading.kept(edge - radii[i]), spread[(i, steps)]);
            (0..steps).for_each(|m| pressure[(i, m)] = kept * spread[(i, m)]);
        }
    }

    /// Averages along the radius, within the annulus. Debris leaves at the edge of contact, so rows sum to one well inside and to nothing
    /// there: else ground would wear where no pressure is at all.
    fn averages(&self, spreading: Spreading) -> Mat<f64> {
        let Self { radii, widths, edge, .. } = self;
        let n = radii.len();
        let mut weights = Mat::zeros(n, n);
        for j in 0..n {
            // The nearest first; what is too far weighs nothing.
            let near = (j..n).map(|i| self.weight(spreading, i, j)).take_while(|weight| *weight > 0.0);
            for (i, weight) in (j..n).zip(near) {
                weights[(i, j)] = widths[j] * weight;
                weights[(j, i)] = widths[i] * weight;
            }
        }
        for i in 0..n {
            let sum: f64 = weights.row(i).iter().sum();
            let kept = part_of(spreading.kept(edge - radii[i]), sum);
            for j in 0..n {
                weights[(i, j)] *= kept;
            }
        }
        weights
    }
}

/// A part over the sum of weights; none where springs are too far from all that slip.
fn part_of(part: f64, sum: f64) -> f64 {
    if sum > 0.0 { part / sum } else { 0.0 }
}
