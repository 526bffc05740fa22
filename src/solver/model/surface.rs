//! What is on the surface in the steps of a period, and what they wear of it.

use faer::{Mat, MatRef};

use super::motion::Motion;
use super::schedule::CycleLoading;
use super::{Fields, Model};
use crate::laws::wear::Rate;
use crate::numerics::linear::{add_product, product, row_sums};

/// Columns of a dense matrix that are formed at a time where only what follows from them is kept.
const BLOCK: usize = 128;

/// Slip of a substep, over the path of the cycle, that is rounding: nothing slips there.
const ROUND_OFF_OF_PATH: f64 = 1e-13;

/// Wear of the surface, from pressures and paths of slip: shape `(springs, steps)` each, one column of pressures if they are all the same.
pub(super) struct Worn {
    /// Depth worn in a period, m.
    pub depth: Vec<f64>,
    /// Derivatives by the pressure in each step.
    pub by_pressure: Mat<f64>,
    /// Derivatives by the path in each step.
    pub by_path: Mat<f64>,
}

/// What is on the surface in the steps of a period.
pub(super) struct Surface {
    /// What the law of wear takes as pressure, Pa, `(springs, steps)` or `(springs, 1)`.
    pub pressure: Mat<f64>,
    /// Direction of the slip in each step, `(springs, steps · components)`.
    pub direction: Mat<f64>,
    /// Path of slip, m, `(springs, steps)`.
    pub path: Mat<f64>,
}

impl Model {
    /// Pressures and slip on the surface in each step of the period.
    pub(super) fn surface(
        &self,
        loading: &CycleLoading,
        motion: &Motion,
        compression: &[f64],
        fields: &Fields,
    ) -> Surface {
        let (n, inner) = (self.springs(), self.springs() - 1);
        let (steps, components) = (motion.steps(), motion.components);
        let columns = steps * components;
        let mut pressure = Mat::zeros(n, motion.load.ncols());
        let pressure_scale = self.pressure_scale(fields);
        self.pressures(&mut pressure, &motion.load, pressure_scale);
        if let Some(spreading) = loading.wear.spreading() {
            let debris = self.debris(loading, motion.at_rest, compression, fields);
            self.pass_on(loading, spreading, &debris, compression, &mut pressure);
        }
        let plain = self.slip_per_depth(loading, fields);
        let mut slip = Mat::zeros(n, columns);
        let mut direction = Mat::full(n, columns, 1.0);
        if let Some(factor) = plain {
            slip = Mat::from_fn(n, 1, |i, _| 4.0 * factor * fields.slip_depth[i]);
        } else {
            let scale = fields.slip_area.powf(self.mu());
            // Where slip reaches the inner end of the mesh, what a free spring would do is carried exactly.
            let free: Vec<f64> =
                (0..columns).map(|m| if motion.slip[(0, m)] == 0.0 { 0.0 } else { motion.free[m] }).collect();
            // Without compression, at the contact edge, springs are free.
            let slip_of = |j: usize, m: usize| if j < inner { motion.slip[(j, m)] } else { motion.free[m] };
            let moved = Mat::from_fn(n, columns, |j, m| (slip_of(j, m) - free[m]) * fields.density_factor[j]);
            product(slip.as_mut(), self.annulus().operators.abel.profile().as_ref(), moved.as_ref(), scale);
            let uniform: Vec<f64> = (0..n).map(|i| self.uniform_slip(fields, i)).collect();
            for (m, free) in free.iter().enumerate() {
                let to = slip.col_as_slice_mut(m).iter_mut().zip(&uniform);
                to.for_each(|(slip, uniform)| *slip += free * uniform);
            }
            // The stencils reach two springs ahead; where none of those inside ever slips, there is no slip. What they make of the front of slip in one
            // step cancels over the steps.
            let sticks = |j: &usize| (0..columns).all(|m| motion.slip[(*j, m)] == 0.0);
            let stuck = (0..inner).take_while(sticks).count();
            for m in 0..columns {
                (0..stuck).for_each(|i| slip[(i, m)] = 0.0);
            }
            if loading.path.is_some() {
                let slipped =
                    Mat::from_fn(inner, columns, |j, m| motion.slip[(j, m)] * fields.density_factor[j]);
                direction = directions(motion, self.annulus().operators.abel.profile(), &slipped);
            }
        }
        let mut path = Mat::<f64>::zeros(n, steps);
        for m in 0..steps {
            let along = path.col_as_slice_mut(m);
            for c in components * m..components * (m + 1) {
                let parts = slip.col_as_slice(c).iter().zip(direction.col_as_slice(c));
                along.iter_mut().zip(parts).for_each(|(sum, (slip, direction))| *sum += slip * direction);
            }
            if steps <= 2 {
                along.iter_mut().for_each(|along| *along = along.max(0.0));
            }
        }
        // Ahead of a front of slip that cells do not resolve the stencils may leave a negative sum over the steps: there is no slip there.
        clear_negative(&mut path);
        Surface { pressure, direction, path }
    }

    /// Depth worn in a period.
    pub(super) fn worn(&self, loading: &CycleLoading, surface: &Surface, slopes: bool) -> Worn {
        let law = &*loading.wear;
        let (n, steps) = (surface.path.nrows(), surface.path.ncols());
        let size = if slopes { n } else { 0 };
        let mut worn = Worn {
            depth: vec![0.0; n],
            by_pressure: Mat::zeros(size, steps),
            by_path: Mat::zeros(size, steps),
        };
        let mean_pressure = self.contact.mean_pressure();
        let total = row_sums(&surface.path);
        let by_path: Vec<f64> = total.iter().map(|path| law.by_path(*path)).collect();
        let mut factors = by_path.clone();
        let different = surface.pressure.ncols();
        let mut rates = vec![Rate::default(); n];
        for m in 0..steps {
            let path = surface.path.col_as_slice(m);
            if m < different {
                if different > 1 {
                    for (i, factor) in factors.iter_mut().enumerate() {
                        let slips = path[i].abs() > ROUND_OFF_OF_PATH * total[i];
                        *factor = if slips { by_path[i] } else { 0.0 };
                    }
                }
                law.rates(surface.pressure.col_as_slice(m), &factors, mean_pressure, &mut rates);
            }
            for (depth, (rate, path)) in worn.depth.iter_mut().zip(rates.iter().zip(path)) {
                *depth += rate.depth * path;
            }
            if slopes {
                let to = worn.by_pressure.col_as_slice_mut(m).iter_mut();
                to.zip(rates.iter().zip(path)).for_each(|(to, (rate, path))| *to = rate.by_pressure * path);
                let to = worn.by_path.col_as_slice_mut(m).iter_mut();
                to.zip(&rates).for_each(|(to, rate)| *to = rate.depth);
            }
        }
        for (i, total) in total.into_iter().enumerate() {
            if slopes && total > 0.0 {
                let shared = law.path_exponent() * worn.depth[i] / total;
                for m in 0..steps {
                    worn.by_path[(i, m)] += shared;
                }
            }
            if let Some([depth, slope]) = law.of_cycle(worn.depth[i] / loading.cycles_per_period) {
                worn.depth[i] = depth * loading.cycles_per_period;
                for m in 0..if slopes { steps } else { 0 } {
                    worn.by_pressure[(i, m)] *= slope;
                    worn.by_path[(i, m)] *= slope;
                }
            }
        }
        worn
    }

    /// Pressures over `scale`, shape `(springs, steps)`, of loads of the springs inside the edge, shape `(springs - 1, steps)`.
    pub(super) fn pressures(&self, to: &mut Mat<f64>, load: &Mat<f64>, scale: f64) {
        let inner = load.nrows();
        let next = |j: usize, m: usize| if j + 1 < inner { load[(j + 1, m)] } else { 0.0 };
        let differences = Mat::from_fn(inner, load.ncols(), |j, m| next(j, m) - load[(j, m)]);
        let weights = self.annulus().operators.abel.pressure_by_differences().subcols(0, inner);
        product(to.as_mut(), weights, differences.as_ref(), scale);
    }
}

/// `to = |left| right` for the leading columns of `left`, some at a time, so that no second matrix of that size is held.
fn product_without_signs(to: &mut Mat<f64>, left: &Mat<f64>, right: MatRef<'_, f64>) {
    to.fill(0.0);
    for columns in blocks(right.nrows()) {
        let part = Mat::from_fn(left.nrows(), columns.len(), |i, j| left[(i, columns.start + j)].abs());
        let rows = right.subrows(columns.start, columns.len());
        add_product(to.as_mut(), part.as_ref(), rows, 1.0);
    }
}

/// Turns each of the vectors along a row that goes against the sum of its pair.
fn turn_to_pairs(vectors: &mut Mat<f64>, components: usize) {
    for first in (0..vectors.ncols()).step_by(2 * components) {
        for i in 0..vectors.nrows() {
            let node = |node: usize, axis: usize| vectors[(i, first + node * components + axis)];
            let along = |it: usize| -> f64 {
                (0..components).map(|axis| node(it, axis) * (node(0, axis) + node(1, axis))).sum()
            };
            let against = [along(0) < 0.0, along(1) < 0.0];
            for (it, _) in against.iter().enumerate().filter(|(_, against)| **against) {
                for axis in 0..components {
                    vectors[(i, first + it * components + axis)] *= -1.0;
                }
            }
        }
    }
}

/// Direction of the slip on the surface in each step, shape `(rows of the profile, steps · components)`: where not all springs slip one way, that of their slips by the sizes of
/// their weights.
///
/// # Arguments
/// * `profile` -- how the slip of springs is carried to the surface
/// * `slipped` -- that of each spring, shape `(springs, steps · components)`
pub(super) fn directions(motion: &Motion, profile: &Mat<f64>, slipped: &Mat<f64>) -> Mat<f64> {
    let (n, columns) = (profile.nrows(), motion.free.len());
    let way = |m: usize| motion.ways.get(m).copied().unwrap_or_default();
    let unknown: Vec<usize> = (0..columns).filter(|m| way(*m) == 0.0).collect();
    let slipped = Mat::from_fn(slipped.nrows(), unknown.len(), |j, m| slipped[(j, unknown[m])]);
    let mut found = Mat::zeros(n, unknown.len());
    product_without_signs(&mut found, profile, slipped.as_ref());
    if motion.paired {
        turn_to_pairs(&mut found, motion.components);
    }
    normalise(&mut found, motion.components);
    if unknown.len() == columns {
        return found;
    }
    let mut direction = Mat::from_fn(n, columns, |_, m| way(m));
    for (m, column) in unknown.into_iter().enumerate() {
        direction.col_as_slice_mut(column).copy_from_slice(found.col_as_slice(m));
    }
    direction
}

/// Clears the rows of paths of slip whose sum over the steps is negative.
pub(super) fn clear_negative(path: &mut Mat<f64>) {
    for (i, total) in row_sums(path).into_iter().enumerate() {
        if total < 0.0 {
            path.row_mut(i).fill(0.0);
        }
    }
}

/// Columns of a matrix, some at a time.
pub(super) fn blocks(columns: usize) -> impl Iterator<Item = std::ops::Range<usize>> {
    (0..columns).step_by(BLOCK).map(move |first| first..(first + BLOCK).min(columns))
}

/// Makes the vectors along each row unit vectors, or zero.
fn normalise(vectors: &mut Mat<f64>, components: usize) {
    if components == 1 {
        let sign = |value: f64| if value == 0.0 { 0.0 } else { 1.0_f64.copysign(value) };
        for c in 0..vectors.ncols() {
            vectors.col_as_slice_mut(c).iter_mut().for_each(|value| *value = sign(*value));
        }
        return;
    }
    for first in (0..vectors.ncols()).step_by(components) {
        let mut squares = vec![0.0; vectors.nrows()];
        for c in first..first + components {
            let values = vectors.col_as_slice(c).iter();
            squares.iter_mut().zip(values).for_each(|(sum, value)| *sum += value * value);
        }
        for c in first..first + components {
            let values = vectors.col_as_slice_mut(c).iter_mut().zip(&squares);
            values.for_each(|(value, square)| {
                *value = if *square > 0.0 { *value / square.sqrt() } else { 0.0 }
            });
        }
    }
}
