//! One stage of an implicit step with an edge of stick that moves: its equations, Newton's matrix, what is carried along.

use faer::Mat;

use super::{Cause, StickEdge};
use crate::numerics::grid::lagrange;
use crate::solver::model::schedule::Drive;
use crate::solver::model::{CycleFields, Fields, Model, Place};

/// Change of edge, stick edge or depth, relative, by which slopes are found.
const DIFFERENCE: f64 = 1e-7;

/// What a stage of a step starts from: the sums of the stages before, and what acts.
#[derive(Debug, Clone)]
pub struct StickTarget {
    /// `λ` at the springs.
    pub log_slip: Vec<f64>,
    /// `Z`, m².
    pub edge: f64,
    /// Area, depth, load and what was left behind.
    pub stick: StickEdge,
    /// `q_c`, m.
    pub slip_compression: f64,
    /// Step times the diagonal coefficient, cycles.
    pub step: f64,
    /// What acts.
    pub drive: Drive,
}

/// A state tried in a stage, with everything that follows from it.
#[derive(Debug, Clone, Default)]
pub struct StickTrial {
    /// Where the mesh begins.
    pub place: Place,
    /// The fields.
    pub fields: Fields,
    /// What a cycle does.
    pub cycle: CycleFields,
    /// What acts, with the amplitude of the contact.
    pub drive: Option<Drive>,
    /// What is left of the equations: springs, contact edge, stick edge, depth.
    pub residual: Vec<f64>,
}

impl Model {
    /// Compression at the edge of stick at the end of a stage, m, where friction alone decides it.
    pub fn known_slip_compression(&self, target: &StickTarget) -> Option<f64> {
        let moving = self.moving.as_ref()?;
        (moving.cause == Cause::Friction && !moving.jumps)
            .then(|| target.drive.slip_compression(self.contact.half_space().stiffness_ratio()))
    }

    /// Tries a state in a stage.
    pub fn try_stick(
        &self,
        target: &StickTarget,
        edge: f64,
        area: f64,
        depth: f64,
        compression: &[f64],
        trial: &mut StickTrial,
    ) -> bool {
        let moving = self.moving.as_ref().expect("called where the stick edge moves");
        let half_space = self.contact.half_space();
        let exponent = 1.0 + half_space.grading();
        let profile = self.contact.equivalent_profile();
        let least = self.place.stick_area;
        if !(edge > 0.0 && area > 0.99 * least && area + edge < least + self.unworn.largest_edge()) {
            return false;
        }
        let held = self.contact.indentation();
        let (slip_compression, drive) = match moving.cause {
            Cause::Tangential => (held - depth, self.displaced(target.drive.clone(), held - depth)),
            Cause::Sliding(_) => (depth, target.drive.clone()),
            _ => (target.drive.slip_compression(half_space.stiffness_ratio()), target.drive.clone()),
        };
        if slip_compression.is_nan() || slip_compression <= 0.0 {
            return false;
        }
        let radius = area.sqrt();
        let (passed, risen) = moving.motion(target, area, depth);
        let deeper = match moving.cause {
            Cause::NormalForce(_) => risen + slip_compression - target.slip_compression,
            _ => 0.0,
        };
        let load = if moving.slides() {
            target.stick.load
                + (slip_compression - target.slip_compression) * radius.powf(exponent) / exponent
        } else {
            target.stick.load
                + deeper * radius.powf(exponent) / exponent
                + 0.5 * slip_compression * radius.powf(exponent - 2.0) * passed
        };
        trial.place = Place { stick_area: area, slip_compression, stick_load: load };
        self.evaluate_at(&trial.place, edge, compression, &mut trial.fields);
        if !trial.fields.are_physical() {
            return false;
        }
        trial.cycle = self.cycle(&drive, compression, &trial.fields);
        let fields = &trial.fields;
        let unworn_rise = self.unworn_rise(area, passed);
        let n = self.springs();
        let nodes = &self.operators.abel.nodes()[1..];
        let along = self.stick_slopes(&fields.log_slip);
        trial.residual.clear();
        for i in 0..n - 1 {
            let values = &fields.unworn[i];
            let per_slip = values.limit_slip / slip_compression / values.slip;
            let singular = per_slip * (unworn_rise - risen * (-fields.log_slip[i]).exp());
            let moved = along[i] / nodes[i] * (passed + nodes[i] * (edge - target.edge)) / edge;
            trial.residual.push(
                fields.log_slip[i]
                    - target.log_slip[i]
                    - target.step * trial.cycle.growth[i]
                    - singular
                    - moved,
            );
        }
        let behind = self.left_behind(target, area, edge, unworn_rise, risen, slip_compression);
        let free = fields.slip_depth[n - 1] - behind;
        if free.is_nan() || free <= 0.0 {
            return false;
        }
        trial.residual.push((free / fields.unworn[n - 1].slip).ln());
        trial.residual.push(if moving.rests() {
            area / target.stick.area - 1.0
        } else if moving.outwards {
            (unworn_rise - risen * self.at_stick_edge(|i| (-fields.log_slip[i]).exp())) / slip_compression
        } else {
            (profile.value(radius) - depth) / slip_compression
        });
        let balance = match moving.cause {
            _ if moving.jumps => risen / slip_compression,
            Cause::Friction => (depth - (held - slip_compression)) / slip_compression,
            Cause::NormalForce(force) | Cause::Sliding(force) => self.normal_force(fields) / force - 1.0,
            Cause::Tangential => {
                let amplitude = drive.amplitude;
                let force = self.force(&drive, compression, fields, amplitude);
                target.drive.excess(force, amplitude) / target.drive.asked()
            }
        };
        trial.residual.push(balance);
        trial.drive = Some(drive);
        trial.residual.iter().all(|value| value.is_finite())
    }

    /// By how much the unworn profile rises, m, where the square of the stick radius grows by `passed`, m².
    fn unworn_rise(&self, area: f64, passed: f64) -> f64 {
        let radius = area.sqrt();
        0.5 * self.contact.equivalent_profile().derivative(radius) / radius * passed
    }

    /// `K` at the contact edge, m, at the end of a stage.
    fn left_behind(
        &self,
        target: &StickTarget,
        area: f64,
        edge: f64,
        unworn_rise: f64,
        risen: f64,
        slip_compression: f64,
    ) -> f64 {
        let moving = self.moving.as_ref().expect("called where the stick edge moves");
        if !moving.outwards {
            return 0.0;
        }
        let uniform = self.unworn.at_stick(area, slip_compression, edge).limit_slip / slip_compression;
        moving.left_behind(&target.stick.left_behind, area + edge) - (risen - unworn_rise) * uniform
    }

    /// A quantity at the edge of stick, by the parabola through the first three springs.
    ///
    /// By the first spring alone, what the springs next to it are off by would grow in time on meshes as fine as these.
    fn at_stick_edge(&self, value: impl Fn(usize) -> f64) -> f64 {
        let mut weights = [0.0; 3];
        lagrange(&self.operators.abel.nodes()[1..4], 0.0, &mut weights);
        weights.iter().enumerate().map(|(i, weight)| weight * value(i)).sum()
    }

    /// `ξ ∂λ/∂ξ`, leaning to where the ground comes from: outwards, or inwards next to an edge of stick that recedes.
    fn stick_slopes(&self, log_slip: &[f64]) -> Vec<f64> {
        let moving = self.moving.as_ref().expect("called where the stick edge moves");
        let mut along = self.along_annulus(log_slip);
        if !moving.outwards && !moving.slides() {
            let nodes = self.operators.abel.nodes();
            for (i, slope) in along.iter_mut().enumerate().take(log_slip.len() / 2) {
                let before = if i == 0 { 0.0 } else { log_slip[i - 1] };
                *slope = nodes[i + 1] * (log_slip[i] - before) / (nodes[i + 1] - nodes[i]);
            }
        }
        along
    }

    /// Newton's matrix of a stage: columns the compressions, contact edge, stick edge and depth.
    pub fn stick_matrix(
        &self,
        target: &StickTarget,
        edge: f64,
        area: f64,
        depth: f64,
        compression: &[f64],
        trial: &StickTrial,
    ) -> Option<Mat<f64>> {
        let moving = self.moving.as_ref().expect("called where the stick edge moves");
        let (n, inner) = (self.springs(), self.springs() - 1);
        let fields = &trial.fields;
        let drive = trial.drive.as_ref().expect("set by the trial");
        let (passed, risen) = moving.motion(target, area, depth);
        let nodes = &self.operators.abel.nodes()[1..];
        let mut growth = Mat::zeros(n, n);
        self.add_growth_slopes(drive, compression, fields, &trial.cycle, -target.step, &mut growth);
        let mut matrix = Mat::zeros(n + 2, n + 2);
        let scale = fields.edge.powf(self.mu());
        let behind = fields.slip_depth[inner] - fields.unworn[inner].slip * trial.residual[inner].exp();
        let mut slopes = vec![0.0; n];
        for j in 0..inner {
            for (i, slope) in slopes.iter_mut().enumerate() {
                *slope = -scale * self.elastic_depth_by_compression(fields, i, j) / fields.slip_depth[i];
            }
            let along = self.stick_slopes(&slopes);
            for i in 0..inner {
                let values = &fields.unworn[i];
                let per_slip = values.limit_slip / trial.place.slip_compression / values.slip;
                let moved = along[i] / nodes[i] * (passed + nodes[i] * (edge - target.edge)) / edge;
                matrix[(i, j)] = growth[(i, j)]
                    + slopes[i] * (1.0 - per_slip * risen * (-fields.log_slip[i]).exp())
                    - moved;
            }
            matrix[(inner, j)] =
                slopes[inner] * fields.slip_depth[inner] / (fields.slip_depth[inner] - behind);
            if moving.outwards && !moving.jumps {
                let slope = self.at_stick_edge(|i| (-fields.log_slip[i]).exp() * slopes[i]);
                matrix[(n, j)] = risen * slope / trial.place.slip_compression;
            }
            let weight = self.contact.half_space().normal_stiffness()
                * fields.edge
                * self.operators.abel.spring_sum()[j]
                * fields.density_factor[j];
            matrix[(n + 1, j)] = match moving.cause {
                Cause::Friction => 0.0,
                Cause::NormalForce(force) | Cause::Sliding(force) => weight / force,
                Cause::Tangential => {
                    let ratio = self.contact.half_space().stiffness_ratio();
                    let q = compression[j];
                    let slips = drive.friction.kinetic_strength(q) < ratio * drive.amplitude;
                    let step = DIFFERENCE * trial.place.slip_compression;
                    let slope = (drive.friction.kinetic_strength(q + step)
                        - drive.friction.kinetic_strength(q))
                        / step;
                    let [by_force, _] = target.drive.demand.factors();
                    if slips { by_force * weight * slope / target.drive.asked() } else { 0.0 }
                }
            };
        }
        let mut nearby = StickTrial::default();
        let steps = [
            (n - 1, [DIFFERENCE * edge, 0.0, 0.0]),
            (n, [0.0, DIFFERENCE * area, 0.0]),
            (n + 1, [0.0, 0.0, DIFFERENCE * trial.place.slip_compression]),
        ];
        for (column, [by_edge, by_area, by_depth]) in steps {
            if let (Cause::Sliding(force), true) = (moving.cause, column == n + 1) {
                // By a difference the small slip next to the core would change its sign.
                let uniform = |i: usize| fields.unworn[i].limit_slip / trial.place.slip_compression;
                let slopes: Vec<f64> = (0..n).map(|i| uniform(i) / fields.slip_depth[i]).collect();
                let along = self.stick_slopes(&slopes);
                for i in 0..inner {
                    let moved = along[i] * (edge - target.edge) / edge;
                    matrix[(i, column)] = slopes[i] * (1.0 + target.step * trial.cycle.growth[i]) - moved;
                }
                matrix[(inner, column)] = slopes[inner];
                let exponent = 1.0 + self.contact.half_space().grading();
                let stiffness = self.contact.half_space().normal_stiffness();
                matrix[(n + 1, column)] = 2.0 * stiffness * area.powf(0.5 * exponent) / (exponent * force);
                continue;
            }
            if (moving.jumps && column >= n) || (moving.slides() && column == n) {
                // The edge of stick stays.
                matrix[(column, column)] = if column == n {
                    target.stick.area.recip()
                } else {
                    trial.place.slip_compression.recip()
                };
                continue;
            }
            let step = by_edge + by_area + by_depth;
            let found = self.try_stick(
                target,
                edge + by_edge,
                area + by_area,
                depth + by_depth,
                compression,
                &mut nearby,
            );
            if !found {
                return None;
            }
            for i in 0..n + 2 {
                matrix[(i, column)] = (nearby.residual[i] - trial.residual[i]) / step;
            }
        }
        Some(matrix)
    }

    /// Slopes, per cycle, of what the stick edge carries along: load, what was left behind, wear depth at the radii of the output.
    pub fn stick_rates(&self, target: &StickTarget, area: f64, depth: f64, trial: &StickTrial) -> StickEdge {
        let moving = self.moving.as_ref().expect("called where the stick edge moves");
        let (passed, risen) = moving.motion(target, area, depth);
        let changed = depth - target.stick.depth;
        let per_step = target.step.recip();
        let unworn_rise = self.unworn_rise(area, passed);
        let (mut left_behind, mut wear_depth) = (vec![], vec![]);
        if moving.outwards {
            let q = trial.place.slip_compression;
            let uniform = |squared: f64| self.unworn.at_stick(area, q, squared - area).limit_slip / q;
            left_behind = moving
                .stations()
                .map(|squared| -per_step * (risen - unworn_rise) * uniform(squared))
                .collect();
            let worn: Vec<f64> = trial
                .cycle
                .growth
                .iter()
                .zip(&trial.fields.log_slip)
                .map(|(growth, log_slip)| growth * log_slip.exp())
                .collect();
            wear_depth = self
                .offsets()
                .iter()
                .map(|offset| {
                    let z = self.place.stick_area + offset - area;
                    let x = z / trial.fields.edge;
                    if x <= 0.0 || x >= 1.0 {
                        return 0.0;
                    }
                    self.between_springs(&worn, x) * self.unworn.at_stick(area, q, z).slip
                })
                .collect();
        }
        StickEdge {
            area: per_step * passed,
            depth: per_step * changed,
            load: per_step * (trial.place.stick_load - target.stick.load),
            left_behind,
            wear_depth,
            rates: [0.0; 2],
            ..StickEdge::default()
        }
    }
}
