//! One stage of an implicit step with an edge of stick that moves: its equations, Newton's matrix, what is carried along.

use std::cell::OnceCell;

use faer::Mat;

use super::{Cause, MovingStick, StickEdge, held_stick_radius};
use crate::contact::slip_depth::INNERMOST;
use crate::solver::model::derivatives::along;
use crate::solver::model::resistance::Resistance;
use crate::solver::model::schedule::CycleLoading;
use crate::solver::model::{CycleFields, Fields, Model, StickZone, Target, Unknowns};

/// Change of slip area, stick area or depth, relative, by which slopes are found; where the edge recedes no more than this part of the first spring's
/// `ξ`, for a change as large as that one takes all slip there away.
const DIFFERENCE: f64 = 1e-7;
const OF_FIRST_SPRING: f64 = 1e-4;

/// The most of that change of the stick area over the slip area: an annulus may be narrower than the one is of the other.
const OF_ANNULUS: f64 = 1e-3;

/// Indentation over the height of the profile at the edge of stick up to which rounding is not magnified.
const OF_STEEPNESS: f64 = 10.0;

/// What a stage with an edge of stick that moves starts from.
#[derive(Debug, Clone)]
pub struct StickTarget {
    /// As where the edge rests.
    pub springs: Target,
    /// Area, depth, load and what was left behind.
    pub stick: StickEdge,
    /// `q_c`, m.
    pub slip_compression: f64,
    /// See [`Model::bearing`].
    pub bearing: f64,
    /// Whether the edge is taken to move outwards, over worn ground.
    pub outwards: bool,
    /// Energy that friction has dissipated, J, without that of this stage.
    pub energy: f64,
}

/// What follows from the unknowns tried in a stage.
#[derive(Debug, Clone, Default)]
pub struct StickTrial {
    /// The stick zone, at whose edge the mesh begins.
    pub stick_zone: StickZone,
    /// The fields.
    pub fields: Fields,
    /// What a cycle does.
    pub cycle: CycleFields,
    /// What is left of the equations: springs, contact edge, stick edge, depth.
    pub residual: Vec<f64>,
}

/// The equations of a stage with an edge of stick that moves.
#[derive(Debug)]
pub struct StickStage<'a> {
    model: &'a Model,
    moving: &'a MovingStick,
    target: StickTarget,
    /// [`StickStage::driven_slip_compression`], which is searched for on some paths.
    driven: OnceCell<f64>,
}

/// Ground that the edge of stick has passed in a stage.
struct Passed {
    /// Change of `C`, m².
    area: f64,
    /// Change of `G`, m.
    risen: f64,
    /// Change of `g_0(c)`, m.
    unworn_rise: f64,
}

impl Model {
    /// The equations of a stage; none where the edge of stick rests.
    pub fn stick_stage(&self, target: StickTarget) -> Option<StickStage<'_>> {
        self.moving().map(|moving| StickStage { model: self, moving, target, driven: OnceCell::new() })
    }
}

impl StickStage<'_> {
    /// What the stage starts from.
    pub fn target(&self) -> &StickTarget {
        &self.target
    }

    /// Compression at the edge of stick at the end of the stage, m, where friction alone decides it.
    pub fn known_slip_compression(&self) -> Option<f64> {
        (self.moving.cause == Cause::Friction && !self.moving.jumps).then(|| self.driven_slip_compression())
    }

    /// Scales the compressions of a guess to that at the edge of stick, which is as well known where friction changes under a held normal force.
    pub fn scale(&self, at: &mut Unknowns) {
        if !self.moving.keeps || matches!(self.moving.cause, Cause::TwoBalances(_)) {
            return;
        }
        let known = self.driven_slip_compression();
        let factor = known / at.slip_compression;
        at.compression.iter_mut().for_each(|q| *q *= factor);
        at.slip_compression = known;
    }

    /// Rounding of an edge of stick that recedes, over the distance of the first spring from it: slip there is known no better.
    pub fn rounding(&self) -> f64 {
        let target = &self.target;
        let first = target.springs.slip_area * self.model.annulus().operators.abel.nodes()[1];
        if self.recedes() { f64::EPSILON * target.stick.area / first } else { 0.0 }
    }

    /// By how much rounding of the indentation is magnified in the place of an edge that moves outwards: next to the axis profiles are flat.
    pub fn magnified_rounding(&self) -> f64 {
        let contact = &self.model.contact;
        let height = contact.equivalent_profile().value(self.target.stick.area.sqrt());
        let magnified = contact.indentation() / (OF_STEEPNESS * height);
        if self.moving.creeps() && magnified.is_finite() { magnified.max(1.0) } else { 1.0 }
    }

    /// Recomputes everything that follows from the unknowns; whether they are those of a contact.
    pub fn evaluate(&self, at: &Unknowns, trial: &mut StickTrial) -> bool {
        let model = self.model;
        let slip_compression = self.slip_compression(at);
        if !self.is_on_mesh(at) || slip_compression.is_nan() || slip_compression <= 0.0 {
            return false;
        }
        let loading = self.loading(at);
        trial.stick_zone = self.stick_zone(at, slip_compression);
        model.evaluate_at(&trial.stick_zone, at.slip_area, &at.compression, &mut trial.fields);
        if !trial.fields.are_physical() {
            return false;
        }
        trial.cycle = model.cycle(&loading, &at.compression, &trial.fields);
        let passed = self.passed(at);
        let contact_edge = self.at_contact_edge(at, &passed, trial);
        if contact_edge.is_nan() {
            return false;
        }
        trial.residual.clear();
        self.push_on_springs(at, &passed, trial);
        let stick_edge = self.at_stick_edge(at, &passed, trial);
        let depth = self.balance(at, &passed, &loading, trial);
        trial.residual.extend([contact_edge, stick_edge, depth]);
        if let Some(tangential) = self.tangential_balance(at, &loading, trial) {
            trial.residual.push(tangential);
        }
        trial.residual.iter().all(|value| value.is_finite())
    }

    /// Newton's matrix: columns the compressions, contact edge, stick edge and depth. None if a state next to this one is none of a contact.
    pub fn matrix(&self, at: &Unknowns, trial: &StickTrial) -> Option<Mat<f64>> {
        let n = self.model.springs();
        let size = trial.residual.len();
        let mut matrix = Mat::zeros(size, size);
        let loading = self.loading(at);
        let resistance = self.model.resistance(&loading, &at.compression, &trial.fields);
        self.fill_by_compressions(at, &loading, &resistance, trial, &mut matrix);
        // What resists the springs next to the edge follows from that one besides.
        if let Some(j) = resistance.behind() {
            let mut moved = at.clone();
            moved.compression[j] += DIFFERENCE * trial.stick_zone.slip_compression;
            let step = moved.compression[j] - at.compression[j];
            self.fill_by_difference(j, step, &moved, trial, &mut matrix)?;
        }
        let step = DIFFERENCE * at.slip_area;
        let moved = Unknowns { slip_area: at.slip_area + step, ..at.clone() };
        self.fill_by_difference(n - 1, step, &moved, trial, &mut matrix)?;
        if self.moving.rests() {
            matrix[(n, n)] = self.target.stick.area.recip();
        } else {
            let step = (self.difference() * at.stick_area).min(OF_ANNULUS * at.slip_area);
            let moved = Unknowns { stick_area: at.stick_area + step, ..at.clone() };
            let step = moved.stick_area - at.stick_area;
            self.fill_by_difference(n, step, &moved, trial, &mut matrix)?;
        }
        match self.moving.cause {
            _ if self.moving.jumps => matrix[(n + 1, n + 1)] = trial.stick_zone.slip_compression.recip(),
            _ => {
                let step = self.difference() * trial.stick_zone.slip_compression;
                let moved = Unknowns { stick_depth: at.stick_depth + step, ..at.clone() };
                let step = moved.stick_depth - at.stick_depth;
                self.fill_by_difference(n + 1, step, &moved, trial, &mut matrix)?;
            }
        }
        if size > n + 2 {
            let step = self.difference() * trial.stick_zone.slip_compression;
            let moved = Unknowns { slip_compression: at.slip_compression + step, ..at.clone() };
            self.fill_by_difference(n + 2, step, &moved, trial, &mut matrix)?;
        }
        Some(matrix)
    }

    /// Slopes, per cycle, of what the stick edge carries along: load, what was left behind, wear depth at the radii of the output.
    pub fn rates(&self, at: &Unknowns, trial: &StickTrial) -> StickEdge {
        let (model, target) = (self.model, &self.target);
        let passed = self.passed(at);
        let per_step = target.springs.step.recip();
        let (area, q) = (at.stick_area, trial.stick_zone.slip_compression);
        let (mut left_behind, mut wear_depth) = (vec![], vec![]);
        if self.moving.leaves_ground() {
            let stations: Vec<f64> = self.moving.stations().collect();
            left_behind = vec![0.0; stations.len()];
            let unworn = &model.annulus().unworn;
            unworn.fill_uniform_at_stick(area, |i| stations[i] - area, &mut left_behind);
            let risen = -per_step * (passed.risen - passed.unworn_rise);
            left_behind.iter_mut().for_each(|value| *value *= risen);
            let growth = trial.cycle.growth.iter().zip(&trial.fields.log_slip);
            let worn: Vec<f64> = growth.map(|(growth, log_slip)| growth * log_slip.exp()).collect();
            let depth = |offset: &f64| {
                let z = model.stick_zone.stick_area + offset - area;
                let x = z / trial.fields.slip_area;
                if x <= 0.0 || x >= 1.0 {
                    return 0.0;
                }
                // Nothing grows back where the polynomial swings below zero, next to an edge at which slip jumps.
                (model.between_springs(&worn, x) * model.annulus().unworn.at_stick(area, q, z).slip).max(0.0)
            };
            wear_depth = model.output.offsets().iter().map(depth).collect();
        }
        StickEdge {
            area: per_step * passed.area,
            depth: per_step * (at.stick_depth - target.stick.depth),
            load: per_step * (trial.stick_zone.stick_load - target.stick.load),
            left_behind,
            wear_depth,
            ..StickEdge::default()
        }
    }

    fn is_on_mesh(&self, at: &Unknowns) -> bool {
        let least = self.model.stick_zone.stick_area;
        at.slip_area > 0.0
            && at.stick_area > INNERMOST * least
            && at.stick_area + at.slip_area < least + self.model.annulus().unworn.largest_slip_area()
    }

    /// `q_c`, m.
    fn slip_compression(&self, at: &Unknowns) -> f64 {
        match self.moving.cause {
            Cause::Tangential => self.model.contact.indentation() - at.stick_depth,
            Cause::BothForces(_) | Cause::ReleasedForces(_) => at.stick_depth,
            Cause::TwoBalances(_) => at.slip_compression,
            _ => self.driven_slip_compression(),
        }
    }

    /// `q_c` at the amplitude that acts, m.
    fn driven_slip_compression(&self) -> f64 {
        *self.driven.get_or_init(|| self.model.slip_compression_of(&self.target.springs.loading))
    }

    /// What acts, with the amplitude of the contact.
    fn loading(&self, at: &Unknowns) -> CycleLoading {
        let loading = self.target.springs.loading.clone();
        match self.moving.cause {
            Cause::BothForces(_) => {
                self.model.deepened(loading, &self.stick_zone(at, self.slip_compression(at)))
            }
            Cause::Tangential | Cause::ReleasedForces(_) | Cause::TwoBalances(_) => {
                self.model.displaced(loading, self.slip_compression(at))
            }
            _ => loading,
        }
    }

    fn passed(&self, at: &Unknowns) -> Passed {
        let stick = &self.target.stick;
        let (area, risen) = if self.moving.deepens() {
            (0.0, 0.0)
        } else {
            (at.stick_area - stick.area, at.stick_depth - stick.depth)
        };
        let radius = at.stick_area.sqrt();
        let slope = self.model.contact.equivalent_profile().derivative(radius);
        let unworn_rise = 0.5 * slope / radius * area;
        // Inwards the profile met is the one at rest; next to the edge any difference would count by the inverse of the distance.
        let met = || unworn_rise + stick.ground_at_rest(at.stick_area)[1] * area;
        let risen = if self.recedes() { met() } else { risen };
        Passed { area, risen, unworn_rise }
    }

    /// Whether the edge is taken to move inwards, over ground at rest.
    fn recedes(&self) -> bool {
        !self.target.outwards && !self.moving.rests()
    }

    /// See [`Model::bearing`].
    pub fn bearing(&self, at: &Unknowns) -> f64 {
        self.model.bearing_under(&self.target.springs.loading, at.slip_compression)
    }

    /// Where the mesh begins: the load grows by that of the ground passed, and with `q_c` on all of the stick zone where a normal force is held.
    fn stick_zone(&self, at: &Unknowns, slip_compression: f64) -> StickZone {
        let target = &self.target;
        let exponent = 1.0 + self.model.contact.half_space().grading();
        let radius = at.stick_area.sqrt();
        let passed = self.passed(at);
        let stick_load = if self.moving.deepens() {
            target.stick.load
                + (slip_compression - target.slip_compression) * radius.powf(exponent) / exponent
        } else {
            let deeper = match self.moving.cause {
                Cause::NormalForce(_) | Cause::ReleasedForces(_) | Cause::TwoBalances(_) => {
                    passed.risen + slip_compression - target.slip_compression
                }
                _ => 0.0,
            };
            target.stick.load
                + deeper * radius.powf(exponent) / exponent
                + 0.5 * slip_compression * radius.powf(exponent - 2.0) * passed.area
        };
        StickZone { stick_area: at.stick_area, slip_compression, stick_load }
    }

    /// Equations of the inner springs.
    fn push_on_springs(&self, at: &Unknowns, passed: &Passed, trial: &mut StickTrial) {
        let StickTrial { fields, cycle, residual, .. } = trial;
        let target = &self.target.springs;
        let motion = self.motion(at, passed);
        let along = self.along_annulus(&fields.log_slip, &motion);
        for i in 0..at.compression.len() {
            let singular =
                per_slip(fields, i) * (passed.unworn_rise - passed.risen * (-fields.log_slip[i]).exp());
            residual.push(
                fields.log_slip[i]
                    - target.log_slip[i]
                    - target.step * cycle.growth[i]
                    - singular
                    - self.carried(at, &motion, &along, i),
            );
        }
    }

    /// What the motion of spring `i` makes of a quantity whose `ξ ∂/∂ξ` is given.
    fn carried(&self, at: &Unknowns, motion: &[f64], along: &[f64], i: usize) -> f64 {
        let node = self.model.annulus().operators.abel.nodes()[i + 1];
        along[i] / node * motion[i] / at.slip_area
    }

    /// By how much ground has passed the inner springs inwards in the stage, m².
    fn motion(&self, at: &Unknowns, passed: &Passed) -> Vec<f64> {
        let grown = at.slip_area - self.target.springs.slip_area;
        let inner = &self.model.annulus().operators.abel.nodes()[1..=at.compression.len()];
        inner.iter().map(|node| passed.area + node * grown).collect()
    }

    /// `ξ ∂/∂ξ` at the inner springs. Where an edge recedes, leaning to where the ground comes from: else what springs next to it are off by grows.
    fn along_annulus(&self, values: &[f64], motion: &[f64]) -> Vec<f64> {
        let operators = &self.model.annulus().operators;
        if !self.recedes() {
            return along(self.moving.near_edge.derivative(&operators.derivative), values);
        }
        let stencil = |(i, motion): (usize, &f64)| {
            let leaning = if *motion < 0.0 { &operators.derivative_inwards } else { &operators.derivative };
            leaning[i].apply(values)
        };
        motion.iter().enumerate().map(stencil).collect()
    }

    /// `ln((S - K)/S_0)` at the contact edge; not a number where less slipped than was left behind.
    fn at_contact_edge(&self, at: &Unknowns, passed: &Passed, trial: &StickTrial) -> f64 {
        let (last, fields) = (at.compression.len(), &trial.fields);
        let free = fields.slip_depth[last] - self.left_behind(at, passed);
        if free > 0.0 { (free / fields.unworn[last].slip).ln() } else { f64::NAN }
    }

    /// `K` at the contact edge, m, at the end of the stage.
    fn left_behind(&self, at: &Unknowns, passed: &Passed) -> f64 {
        if !self.moving.leaves_ground() {
            return 0.0;
        }
        let uniform = self.model.annulus().unworn.uniform_at_stick(at.stick_area, at.slip_area);
        self.moving.left_behind(&self.target.stick.left_behind, at.stick_area + at.slip_area)
            - (passed.risen - passed.unworn_rise) * uniform
    }

    /// What decides where the edge of stick is: the unworn profile inwards, what is left behind outwards.
    fn at_stick_edge(&self, at: &Unknowns, passed: &Passed, trial: &StickTrial) -> f64 {
        let q = trial.stick_zone.slip_compression;
        if self.moving.rests() {
            return at.stick_area / self.target.stick.area - 1.0;
        }
        if self.target.outwards {
            let slope = self.moving.near_edge.at_edge(|i| (-trial.fields.log_slip[i]).exp());
            return (passed.unworn_rise - passed.risen * slope) / q;
        }
        let contact = &self.model.contact;
        if let Cause::ReleasedForces(force) = self.moving.cause {
            let radius = held_stick_radius(contact, force, &self.target.springs.loading);
            return radius.map_or(f64::NAN, |radius| at.stick_area / (radius * radius) - 1.0);
        }
        let met = contact.equivalent_profile().value(at.stick_area.sqrt());
        (met + self.target.stick.ground_at_rest(at.stick_area)[0] - at.stick_depth) / q
    }

    /// What decides the height of the profile there: friction, or a balance of forces.
    fn balance(&self, at: &Unknowns, passed: &Passed, loading: &CycleLoading, trial: &StickTrial) -> f64 {
        let (model, q) = (self.model, trial.stick_zone.slip_compression);
        match self.moving.cause {
            _ if self.moving.jumps => passed.risen / q,
            Cause::Friction => (at.stick_depth - (model.contact.indentation() - q)) / q,
            Cause::NormalForce(force)
            | Cause::BothForces(force)
            | Cause::ReleasedForces(force)
            | Cause::TwoBalances(force) => model.normal_force(&trial.fields) / force - 1.0,
            Cause::Tangential => self.excess(at, loading, trial),
        }
    }

    /// What is left of the balance of tangential forces, relative.
    fn excess(&self, at: &Unknowns, loading: &CycleLoading, trial: &StickTrial) -> f64 {
        let force = self.model.force(loading, &at.compression, &trial.fields, loading.amplitude);
        let asked = &self.target.springs.loading;
        asked.excess(force, loading.amplitude) / asked.asked()
    }

    /// The balance of tangential forces beside a normal one: under Coulomb's law by the rise of the profile at the edge that it asks for, which the
    /// quadrature over the springs leaves alone; none where there is no such balance.
    fn tangential_balance(&self, at: &Unknowns, loading: &CycleLoading, trial: &StickTrial) -> Option<f64> {
        let Cause::TwoBalances(_) = self.moving.cause else { return None };
        if loading.friction.coefficient().is_none() {
            return Some(self.excess(at, loading, trial));
        }
        let exponent = 1.0 + self.model.contact.half_space().grading();
        let gained = self.bearing(at) - self.target.bearing;
        let rise = exponent * gained / at.stick_area.powf(0.5 * exponent);
        // How much more of it the spring of a rig asks for where the compression grows.
        let more = exponent * self.model.bearing_slope(&self.target.springs.loading)
            / at.stick_area.powf(0.5 * exponent);
        let scale = (1.0 + more) * trial.stick_zone.slip_compression;
        Some((at.stick_depth - self.target.stick.depth - rise) / scale)
    }

    fn fill_by_compressions(
        &self,
        at: &Unknowns,
        loading: &CycleLoading,
        resistance: &Resistance,
        trial: &StickTrial,
        matrix: &mut Mat<f64>,
    ) {
        let (model, fields) = (self.model, &trial.fields);
        let (n, inner) = (model.springs(), model.springs() - 1);
        let passed = self.passed(at);
        let mut growth = Mat::zeros(n, n);
        let step = self.target.springs.step;
        model.add_growth_slopes(loading, &at.compression, fields, &trial.cycle, -step, &mut growth);
        let scale = fields.slip_area.powf(model.mu());
        let behind = fields.slip_depth[inner] - fields.unworn[inner].slip * trial.residual[inner].exp();
        let singular = |i| 1.0 - per_slip(fields, i) * passed.risen * (-fields.log_slip[i]).exp();
        let singular: Vec<f64> = (0..inner).map(singular).collect();
        let motion = self.motion(at, &passed);
        let mut slopes = vec![0.0; n];
        for j in 0..inner {
            for (i, slope) in slopes.iter_mut().enumerate() {
                *slope = -scale * model.elastic_depth_by_compression(fields, i, j) / fields.slip_depth[i];
            }
            let along = self.along_annulus(&slopes, &motion);
            for i in 0..inner {
                matrix[(i, j)] =
                    growth[(i, j)] + slopes[i] * singular[i] - self.carried(at, &motion, &along, i);
            }
            matrix[(inner, j)] =
                slopes[inner] * fields.slip_depth[inner] / (fields.slip_depth[inner] - behind);
            if self.target.outwards && !self.moving.jumps {
                let slope = self.moving.near_edge.at_edge(|i| (-fields.log_slip[i]).exp() * slopes[i]);
                matrix[(n, j)] = passed.risen * slope / trial.stick_zone.slip_compression;
            }
            let q = at.compression[j];
            matrix[(n + 1, j)] = self.balance_by_compression(j, q, loading, resistance, trial);
            if let Cause::TwoBalances(_) = self.moving.cause
                && loading.friction.coefficient().is_none()
            {
                matrix[(n + 2, j)] = self.excess_by_compression(j, q, loading, resistance, trial);
            }
        }
    }

    /// What presses on a spring, N, over its compression, m.
    fn weight(&self, spring: usize, trial: &StickTrial) -> f64 {
        self.model.contact.half_space().normal_stiffness()
            * trial.fields.slip_area
            * self.model.annulus().operators.abel.spring_sum()[spring]
            * trial.fields.density_factor[spring]
    }

    fn excess_by_compression(
        &self,
        spring: usize,
        q: f64,
        loading: &CycleLoading,
        resistance: &Resistance,
        trial: &StickTrial,
    ) -> f64 {
        let half_space = self.model.contact.half_space();
        let strength = |q: f64| resistance.of(spring, q);
        let sticks = half_space.stiffness_ratio() * loading.amplitude;
        if strength(q) >= sticks && !resistance.is_straight(spring) {
            return 0.0;
        }
        let step = DIFFERENCE * trial.stick_zone.slip_compression;
        let slope = (strength(q + step) - strength(q)) / step;
        let asked = &self.target.springs.loading;
        let [by_force, _] = asked.control.factors();
        by_force * self.weight(spring, trial) * slope / asked.asked()
    }

    fn balance_by_compression(
        &self,
        spring: usize,
        q: f64,
        loading: &CycleLoading,
        resistance: &Resistance,
        trial: &StickTrial,
    ) -> f64 {
        let weight = self.weight(spring, trial);
        match self.moving.cause {
            Cause::Friction => 0.0,
            Cause::NormalForce(force)
            | Cause::BothForces(force)
            | Cause::ReleasedForces(force)
            | Cause::TwoBalances(force) => weight / force,
            Cause::Tangential => self.excess_by_compression(spring, q, loading, resistance, trial),
        }
    }

    fn difference(&self) -> f64 {
        let most = if self.recedes() { OF_FIRST_SPRING } else { f64::INFINITY };
        DIFFERENCE.min(most * self.model.annulus().operators.abel.nodes()[1])
    }

    fn fill_by_difference(
        &self,
        column: usize,
        step: f64,
        moved: &Unknowns,
        trial: &StickTrial,
        matrix: &mut Mat<f64>,
    ) -> Option<()> {
        let mut nearby = StickTrial::default();
        if !self.evaluate(moved, &mut nearby) {
            return None;
        }
        for (i, (after, before)) in nearby.residual.iter().zip(&trial.residual).enumerate() {
            matrix[(i, column)] = (after - before) / step;
        }
        Some(())
    }
}

/// `Φ/S_0` at a spring, 1/m.
fn per_slip(fields: &Fields, spring: usize) -> f64 {
    let values = &fields.unworn[spring];
    values.limit_slip / fields.stick_zone.slip_compression / values.slip
}
