//! What one cycle does to the contact: slip of the springs, wear of the surface, dissipated energy.
//!
//! Eq. (20) carries the slip of the springs in each step of the period to the surface, Eq. (21) their compressions, and the law of wear
//! makes of both the depth `W` worn in the cycle. The slip depth `S` of the model grows by `W`, its logarithm by `W/S`.

use std::f64::consts::PI;

use faer::Mat;

use super::motion::{Energies, Motion};
use super::schedule::{AmplitudeControl, CycleLoading};
use super::surface::{Worn, blocks};
use super::{Fields, Model};
use crate::numerics::linear::{dot, product, row_sums};

/// Change of the edge, relative, by which slopes are found.
const DIFFERENCE: f64 = 1e-7;

/// What slopes take over what a cycle takes, columns by columns.
const SLOPES: usize = 3;

/// Agreement of two amplitudes that are the same number by two ways.
const SAME: f64 = 1e-13;

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
            return self.gross_cycle(gross, loading, compression, fields);
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

    /// Slip over slip depth, `μ_f/M`, where the mesh begins at the edge of stick and the law is Coulomb's.
    pub(super) fn slip_per_depth(&self, loading: &CycleLoading, fields: &Fields) -> Option<f64> {
        let coefficient = loading.friction.coefficient()?;
        self.slips_from_edge(loading, fields)
            .then(|| coefficient / self.contact.half_space().stiffness_ratio())
    }

    /// Whether the mesh begins where slip does, in tangential oscillation at the largest indentation.
    pub(super) fn slips_from_edge(&self, loading: &CycleLoading, fields: &Fields) -> bool {
        let compression = || loading.slip_compression(self.contact.half_space().stiffness_ratio());
        loading.path.is_none()
            && loading.lift == 0.0
            && loading.control == AmplitudeControl::Displacement
            && (compression() / fields.stick_zone.slip_compression - 1.0).abs() < SAME
    }

    /// `k_w` where wear is in proportion to pressure and slip.
    fn archard(&self, loading: &CycleLoading) -> Option<f64> {
        loading.wear.archard_coefficient(loading.friction.coefficient())
    }

    /// Worn volume over dissipated energy, 1/Pa, where they are in proportion.
    pub(super) fn volume_per_energy(&self, loading: &CycleLoading) -> Option<f64> {
        loading.wear.volume_per_energy(loading.friction.coefficient())
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
                let carried = |i: usize| scale * profile[i] * fields.density_factor[j] / fields.slip_depth[i];
                for (i, to) in matrix.col_as_slice_mut(j).iter_mut().enumerate().take(n) {
                    let pressed = by_pressure[i] * pressure_scale * pressed[i] / fields.slip_depth[i];
                    *to += per_cycle * pressed + factor * cycle.growth[i] * carried(i);
                }
                let own = [(j, 1.0)];
                for (of, slope) in motion.follows.get(j).map_or(&own[..], Vec::as_slice) {
                    let slope = per_cycle * slope;
                    let column = matrix.col_as_slice_mut(*of).iter_mut().enumerate().take(n);
                    column.for_each(|(i, to)| *to += slope * by_slip[i] * carried(i));
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
    pub fn spring_radii(&self, fields: &Fields) -> Vec<f64> {
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
