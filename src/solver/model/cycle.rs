//! What one cycle does to the contact: slip of the springs, wear of the surface, dissipated energy.
//!
//! Eq. (20) carries the slip of the springs in each step of the period to the surface, Eq. (21) their compressions, and the law of wear
//! makes of both the depth `W` worn in the cycle. The slip depth `S` of the model grows by `W`, its logarithm by `W/S`.

use std::f64::consts::PI;

use faer::{Mat, MatRef};

use super::motion::{Energies, Motion};
use super::schedule::{AmplitudeControl, CycleLoading};
use super::{Fields, Model};
use crate::laws::wear::Rate;
use crate::numerics::linear::{add_product, dot, product, row_sums};

/// Change of the edge, relative, by which slopes are found.
const DIFFERENCE: f64 = 1e-7;

/// Columns of a dense matrix that are formed at a time where only what follows from them is kept.
const BLOCK: usize = 128;

/// What slopes take over what a cycle takes, columns by columns.
const SLOPES: usize = 3;

/// Agreement of two amplitudes that are the same number by two ways.
const SAME: f64 = 1e-13;

/// Slip of a substep, over the path of the cycle, that is rounding: nothing slips there.
const ROUND_OFF_OF_PATH: f64 = 1e-13;

/// What one cycle does.
#[derive(Debug, Clone, Default)]
pub struct CycleFields {
    /// `W/S`, by which the logarithm of the slip depth grows in a cycle, at the springs.
    pub growth: Vec<f64>,
    /// Slip amplitude on the surface, m: a quarter of the path of slip in a cycle.
    pub slip: Vec<f64>,
    /// Energy that friction dissipates in a cycle, J.
    pub dissipation: f64,
    /// What jumps from static to kinetic friction lose in a cycle beyond that, J.
    pub jump_loss: f64,
    /// Work of the tangential force in a cycle, J.
    pub work: f64,
    /// Volume worn in a cycle, m³.
    pub volume: f64,
    /// Tangential amplitude of the contact, m.
    pub amplitude: f64,
    /// Radius within which no spring slips, m.
    pub stick_radius: f64,
}

/// Derivatives of the growth in a plain cycle, which are in proportion to the transform of Eq. (21).
#[derive(Debug)]
pub struct PlainSlopes {
    /// By `P` of the compressions.
    pub by_pressure: f64,
    /// By the edge, 1/m², shape `(springs,)`.
    pub by_slip_area: Vec<f64>,
}

/// Wear of the surface, from pressures and paths of slip: shape `(springs, steps)` each, one column of pressures if they are all the same.
pub(super) struct Worn {
    /// Depth worn in a period, m.
    pub depth: Vec<f64>,
    /// Derivatives by the pressure in each step.
    by_pressure: Mat<f64>,
    /// Derivatives by the path in each step.
    by_path: Mat<f64>,
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

impl CycleFields {
    /// Nothing slips up to the contact radius, m.
    fn at_rest(springs: usize, contact_radius: f64) -> Self {
        let none = vec![0.0; springs];
        Self { growth: none.clone(), slip: none, stick_radius: contact_radius, ..Self::default() }
    }

    /// What so many of these cycles do together.
    pub(super) fn lasting(mut self, cycles: f64) -> Self {
        if cycles != 1.0 {
            self.growth.iter_mut().for_each(|growth| *growth *= cycles);
            for sum in [&mut self.dissipation, &mut self.jump_loss, &mut self.work, &mut self.volume] {
                *sum *= cycles;
            }
        }
        self
    }

    /// The mean cycle of a pass of which these cycles take parts. Amplitude and slip are means, the stick radius is the smallest.
    pub fn mean(cycles: impl Iterator<Item = (f64, Self)>) -> Self {
        let mut mean = Self { stick_radius: f64::INFINITY, ..Self::default() };
        for (part, cycle) in cycles {
            for (sum, values) in [(&mut mean.growth, &cycle.growth), (&mut mean.slip, &cycle.slip)] {
                sum.resize(values.len(), 0.0);
                sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += part * value);
            }
            mean.dissipation += part * cycle.dissipation;
            mean.jump_loss += part * cycle.jump_loss;
            mean.work += part * cycle.work;
            mean.volume += part * cycle.volume;
            mean.amplitude += part * cycle.amplitude;
            mean.stick_radius = mean.stick_radius.min(cycle.stick_radius);
        }
        mean
    }
}

impl Model {
    /// What a cycle does to the contact whose fields are given, or the mean cycle of a pass.
    pub fn cycle(&self, loading: &CycleLoading, compression: &[f64], fields: &Fields) -> CycleFields {
        if loading.others.is_empty() {
            return self.cycle_in_block(loading, compression, fields);
        }
        let parts = loading.parts();
        CycleFields::mean(parts.map(|part| (part.part, self.cycle_in_block(part, compression, fields))))
    }

    /// What a cycle of one block does, the others of its pass aside.
    pub fn cycle_in_block(
        &self,
        loading: &CycleLoading,
        compression: &[f64],
        fields: &Fields,
    ) -> CycleFields {
        if let Some(gross) = self.gross() {
            return self.gross_cycle(gross, loading, compression);
        }
        if loading.is_pause() {
            let edge = fields.stick_zone.stick_area + fields.slip_area;
            return CycleFields::at_rest(self.springs(), edge.sqrt());
        }
        let mut cycle = self.local_cycle(loading, compression, fields);
        if let Some(factor) = self.factor_at_contact(loading, fields, cycle.dissipation) {
            cycle.growth.iter_mut().for_each(|growth| *growth *= factor);
            cycle.volume *= factor;
        }
        cycle.lasting(loading.share)
    }

    /// Factor on all wear of a law that goes by what the contact as a whole dissipates.
    fn factor_at_contact(&self, loading: &CycleLoading, fields: &Fields, dissipation: f64) -> Option<f64> {
        loading.wear.at_contact(dissipation / (PI * (fields.stick_zone.stick_area + fields.slip_area)))
    }

    /// That factor for the cycle that it was found in, with the settled cycles that this one wears as much as.
    fn share_at_contact(&self, loading: &CycleLoading, fields: &Fields, cycle: &CycleFields) -> f64 {
        let settled = cycle.dissipation / loading.share;
        loading.share * self.factor_at_contact(loading, fields, settled).unwrap_or(1.0)
    }

    /// What a cycle does by what happens at each place.
    fn local_cycle(&self, loading: &CycleLoading, compression: &[f64], fields: &Fields) -> CycleFields {
        if let Some(cycle) = self.plain_cycle(loading, compression, fields) {
            return cycle;
        }
        let motion = self.motion(loading, compression, fields, false);
        self.count_columns(loading, &motion, 1);
        let surface = self.surface(loading, &motion, compression, fields);
        let worn = self.worn(loading, &surface, false);
        let per_cycle = loading.cycles_per_period.recip();
        let slip = row_sums(&surface.path).into_iter().map(|path| 0.25 * per_cycle * path);
        let energy = |part: fn(&Energies) -> f64| {
            per_cycle * self.spring_energy(fields, motion.energies.iter().map(part))
        };
        let dissipation = energy(|spring| spring.dissipation);
        // Where slip turns, that of neighbouring springs does not add up on the surface, while its energy does.
        let volume = match self.volume_per_energy(loading).filter(|_| motion.components == 1) {
            Some(factor) => factor * dissipation,
            None => {
                // Round-off about zero must not make up for what still wears elsewhere.
                let worn: Vec<f64> = worn.depth.iter().map(|depth| depth.abs()).collect();
                per_cycle * self.volume(fields.slip_area, &worn)
            }
        };
        CycleFields {
            growth: growth(loading, &worn, fields),
            slip: slip.collect(),
            dissipation,
            jump_loss: energy(|spring| spring.jump_loss),
            work: energy(|spring| spring.work),
            volume,
            amplitude: motion.amplitude,
            stick_radius: self.stick_radius(&motion, fields),
        }
    }

    /// The cycle in which slip on the surface is `μ_f/M` times the slip depth and wear is in proportion to pressure and slip.
    fn plain_cycle(
        &self,
        loading: &CycleLoading,
        compression: &[f64],
        fields: &Fields,
    ) -> Option<CycleFields> {
        let factor = self.slip_per_depth(loading, fields)?;
        let per_pressure = 4.0 * factor * self.archard(loading)?;
        let changed = loading.friction.coefficient()? / self.contact.friction().coefficient;
        let dissipation = changed * changed * self.dissipation(fields, compression);
        Some(CycleFields {
            growth: fields.pressure.iter().map(|p| per_pressure * p).collect(),
            slip: fields.slip_depth.iter().map(|s| factor * s).collect(),
            dissipation,
            jump_loss: 0.0,
            work: dissipation,
            volume: self.volume_per_energy(loading)? * dissipation,
            amplitude: loading.amplitude,
            stick_radius: fields.stick_zone.stick_area.sqrt(),
        })
    }

    /// Slip over slip depth, `μ_f/M`, if the amplitude is that for which the mesh was made and the law is Coulomb's.
    pub(super) fn slip_per_depth(&self, loading: &CycleLoading, fields: &Fields) -> Option<f64> {
        let coefficient = loading.friction.coefficient()?;
        let ratio = self.contact.half_space().stiffness_ratio();
        let compression = ratio * loading.amplitude / coefficient;
        let same = (compression / fields.stick_zone.slip_compression - 1.0).abs() < SAME;
        (same
            && loading.path.is_none()
            && loading.lift == 0.0
            && loading.control == AmplitudeControl::Displacement)
            .then_some(coefficient / ratio)
    }

    /// `k_w` where wear is in proportion to pressure and slip.
    fn archard(&self, loading: &CycleLoading) -> Option<f64> {
        loading.wear.archard_coefficient(loading.friction.coefficient())
    }

    /// Worn volume over dissipated energy, 1/Pa, where they are in proportion.
    pub(super) fn volume_per_energy(&self, loading: &CycleLoading) -> Option<f64> {
        loading.wear.volume_per_energy(loading.friction.coefficient())
    }

    /// Pressures and slip on the surface in each step of the period.
    fn surface(
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

    /// `factor` times the derivatives of the growth in a cycle that is plain.
    pub fn plain_growth_slopes(
        &self,
        loading: &CycleLoading,
        fields: &Fields,
        cycle: &CycleFields,
        factor: f64,
    ) -> Option<PlainSlopes> {
        if !loading.others.is_empty() {
            return None;
        }
        let per_pressure = self.share_at_contact(loading, fields, cycle)
            * factor
            * 4.0
            * self.slip_per_depth(loading, fields)?
            * self.archard(loading)?;
        Some(PlainSlopes {
            by_pressure: per_pressure * self.pressure_scale(fields),
            by_slip_area: cycle
                .growth
                .iter()
                .map(|growth| -factor * self.mu() / fields.slip_area * growth)
                .collect(),
        })
    }

    /// Adds `factor` times the derivatives of the growth in a cycle, or in the mean cycle of a pass, by compressions and edge to a matrix with these columns.
    pub fn add_growth_slopes(
        &self,
        loading: &CycleLoading,
        compression: &[f64],
        fields: &Fields,
        cycle: &CycleFields,
        factor: f64,
        matrix: &mut Mat<f64>,
    ) {
        if loading.others.is_empty() {
            return self.add_growth_slopes_in_block(loading, compression, fields, cycle, factor, matrix);
        }
        for part in loading.parts().cloned() {
            let part = CycleLoading { others: vec![], ..part };
            let cycle = self.cycle(&part, compression, fields);
            self.add_growth_slopes_in_block(&part, compression, fields, &cycle, part.part * factor, matrix);
        }
    }

    fn add_growth_slopes_in_block(
        &self,
        loading: &CycleLoading,
        compression: &[f64],
        fields: &Fields,
        cycle: &CycleFields,
        factor: f64,
        matrix: &mut Mat<f64>,
    ) {
        let (n, inner) = (self.springs(), self.springs() - 1);
        let pressure_scale = self.pressure_scale(fields);
        if let Some(PlainSlopes { by_pressure, by_slip_area }) =
            self.plain_growth_slopes(loading, fields, cycle, factor)
        {
            for j in 0..inner {
                self.annulus().operators.abel.add_pressure(j, by_pressure, matrix.col_as_slice_mut(j));
            }
            for (i, by_slip_area) in by_slip_area.into_iter().enumerate() {
                matrix[(i, inner)] += by_slip_area;
            }
            return;
        }
        let motion = self.motion(loading, compression, fields, true);
        self.count_columns(loading, &motion, SLOPES);
        let surface = self.surface(loading, &motion, compression, fields);
        let worn = self.worn(loading, &surface, true);
        let (steps, components) = (motion.steps(), motion.components);
        let along = Mat::from_fn(n, steps * components, |i, c| {
            let step = c / components;
            let slips = surface.path[(i, step)] != 0.0;
            if slips { worn.by_path[(i, step)] * surface.direction[(i, c)] } else { 0.0 }
        });
        let spreading = loading.wear.spreading();
        let spread = spreading.map(|it| self.spread_pressure(loading, &motion, compression, fields, it));
        let pressed = |j: usize| match &spread {
            Some(spread) => spread.col_as_slice(j).to_vec(),
            None => {
                let mut column = vec![0.0; n];
                self.annulus().operators.abel.add_pressure(j, 1.0, &mut column);
                column
            }
        };
        let at_contact = self.share_at_contact(loading, fields, cycle);
        let per_cycle = at_contact * factor / loading.cycles_per_period;
        let scale = fields.slip_area.powf(self.mu());
        let profile = self.annulus().operators.abel.profile();
        let total = row_sums(&worn.by_pressure);
        for columns in blocks(inner) {
            let (first, count) = (columns.start, columns.len());
            let mut by_slip = Mat::zeros(n, count);
            product(
                by_slip.as_mut(),
                along.as_ref(),
                motion.slip_slope.subrows(first, count).transpose(),
                1.0,
            );
            let mut by_pressure = Mat::zeros(n, count);
            if motion.load.ncols() == 1 {
                by_pressure = Mat::from_fn(n, count, |i, j| total[i] * motion.load_slope[(first + j, 0)]);
            } else {
                let slopes = motion.load_slope.subrows(first, count).transpose();
                product(by_pressure.as_mut(), worn.by_pressure.as_ref(), slopes, 1.0);
            }
            for j in columns {
                let (pressed, profile) = (pressed(j), profile.col_as_slice(j));
                let by_pressure = by_pressure.col_as_slice(j - first);
                let by_slip = by_slip.col_as_slice(j - first);
                for (i, to) in matrix.col_as_slice_mut(j).iter_mut().enumerate().take(n) {
                    let carried = scale * profile[i] * fields.density_factor[j];
                    let worn = by_pressure[i] * pressure_scale * pressed[i] + by_slip[i] * carried;
                    *to += (per_cycle * worn + factor * cycle.growth[i] * carried) / fields.slip_depth[i];
                }
            }
        }
        if let Some(spreading) = spreading {
            for j in 0..inner {
                let (filled, slope) = self.filled(loading, spreading, Some(compression[j]));
                if filled > 0.0 {
                    matrix[(j, j)] += factor * cycle.growth[j] * slope / filled;
                }
            }
        }
        if let Some(by_amplitude) = &motion.amplitude_slope {
            // The amplitude follows from the balance of forces: all springs move a little farther.
            let moved = self.carried(fields, (0..inner).map(|j| 4.0 * (by_amplitude.slips[j] - 1.0)));
            for i in 0..n {
                let slip = moved[i] + 4.0 * self.uniform_slip(fields, i);
                let growth = per_cycle * worn.by_path[(i, 0)] * slip / fields.slip_depth[i];
                for j in 0..inner {
                    matrix[(i, j)] += growth * by_amplitude.by_compression[j];
                }
            }
        }
        let slip_area = fields.slip_area * (1.0 + DIFFERENCE);
        let mut moved = Fields::default();
        self.evaluate_at(&fields.stick_zone, slip_area, compression, &mut moved);
        let after = if loading.path.is_some() && loading.control == AmplitudeControl::Displacement {
            // What springs do is a matter of their compressions alone.
            let worn = self.worn(loading, &self.surface(loading, &motion, compression, &moved), false);
            growth(loading, &worn, &moved).into_iter().map(|growth| at_contact * growth).collect()
        } else {
            self.cycle(loading, compression, &moved).growth
        };
        for i in 0..n {
            matrix[(i, inner)] += factor * (after[i] - cycle.growth[i]) / (slip_area - fields.slip_area);
        }
    }

    /// Pressures over `scale`, shape `(springs, steps)`, of loads of the springs inside the edge, shape `(springs - 1, steps)`.
    pub(super) fn pressures(&self, to: &mut Mat<f64>, load: &Mat<f64>, scale: f64) {
        let inner = load.nrows();
        let next = |j: usize, m: usize| if j + 1 < inner { load[(j + 1, m)] } else { 0.0 };
        let differences = Mat::from_fn(inner, load.ncols(), |j, m| next(j, m) - load[(j, m)]);
        let weights = self.annulus().operators.abel.pressure_by_differences().subcols(0, inner);
        product(to.as_mut(), weights, differences.as_ref(), scale);
    }

    /// `c_N/π Z^(-μ)`, the factor of Eq. (21).
    pub(super) fn pressure_scale(&self, fields: &Fields) -> f64 {
        self.contact.half_space().normal_stiffness() / std::f64::consts::PI
            * fields.slip_area.powf(-self.mu())
    }

    /// `F 1` at a spring.
    pub(super) fn uniform_slip(&self, fields: &Fields, spring: usize) -> f64 {
        fields.unworn[spring].limit_slip / fields.stick_zone.slip_compression
    }

    /// `F` of values at the springs inside the edge, shape `(springs,)`.
    pub(super) fn carried(&self, fields: &Fields, values: impl Iterator<Item = f64>) -> Vec<f64> {
        let density: Vec<f64> =
            values.zip(&fields.density_factor).map(|(value, factor)| value * factor).collect();
        let mut depth = vec![0.0; self.springs()];
        self.annulus().operators.abel.transforms()[0].apply(&density, &mut depth);
        let scale = fields.slip_area.powf(self.mu());
        depth.iter_mut().for_each(|value| *value *= scale);
        depth
    }

    /// Energy, J, of energies per normal stiffness of the springs, m².
    fn spring_energy(&self, fields: &Fields, energies: impl Iterator<Item = f64>) -> f64 {
        let densities: Vec<f64> =
            energies.zip(&fields.density_factor).map(|(e, factor)| e * factor).collect();
        self.contact.half_space().normal_stiffness()
            * fields.slip_area
            * dot(self.annulus().operators.abel.spring_sum(), &densities)
    }

    /// Radii of the springs, m.
    pub(super) fn spring_radii(&self, fields: &Fields) -> Vec<f64> {
        let squared = |x: &f64| fields.stick_zone.stick_area + fields.slip_area * x;
        self.annulus().operators.abel.nodes()[1..].iter().map(|x| squared(x).sqrt()).collect()
    }

    /// Radius of the innermost spring that slips; the mesh begins where the first one does.
    fn stick_radius(&self, motion: &Motion, fields: &Fields) -> f64 {
        let slips = |j: &usize| (0..motion.slip.ncols()).any(|m| motion.slip[(*j, m)] != 0.0);
        let before = match (0..motion.slip.nrows()).find(slips) {
            // The nodes begin at the edge of the mesh, with no spring.
            Some(j) => self.annulus().operators.abel.nodes()[j],
            None => 1.0,
        };
        (fields.stick_zone.stick_area + fields.slip_area * before).max(motion.at_rest.area).sqrt()
    }
}

/// `W/S` at the springs.
fn growth(loading: &CycleLoading, worn: &Worn, fields: &Fields) -> Vec<f64> {
    let per_cycle = loading.cycles_per_period.recip();
    worn.depth.iter().zip(&fields.slip_depth).map(|(w, s)| per_cycle * w / s).collect()
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
fn blocks(columns: usize) -> impl Iterator<Item = std::ops::Range<usize>> {
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
