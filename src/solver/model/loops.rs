//! Fretting loops: tangential displacement and force along one period.

use std::f64::consts::PI;

use super::motion::slips_below;
use super::schedule::CycleLoading;
use super::{CycleFields, Fields, Model};
use crate::contact::spring::{Neighbours, Shakedown, SpringCycle, settled_cycle};
use crate::laws::path::{Path, PathPoint};
use crate::numerics::quadrature::Rule;
use crate::numerics::roots::bracketed;

/// Nodes of the quadrature over the core that no cycle reaches.
const CORE_NODES: usize = 24;

/// Displacement and force along one period, the last point of which is the first again.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FrettingLoop {
    /// Tangential displacement along x and y, m, shape `(point,)` each.
    pub displacement: [Vec<f64>; 2],
    /// Tangential force along x and y, N, shape `(point,)` each.
    pub force: [Vec<f64>; 2],
    /// Work of the tangential displacement in the period, J: energy that friction dissipates and what jumps from the static to the
    /// kinetic limit lose.
    pub work: f64,
    /// Width at no force, m, of a loop along x; not a number where the indenter leaves the axis or is not moved.
    pub width: f64,
}

impl FrettingLoop {
    /// Largest tangential force along the loop, N.
    pub fn largest_force(&self) -> f64 {
        let [x, y] = &self.force;
        x.iter().zip(y).map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max)
    }

    /// Energy ratio `A = W/(4 Q* δ*)` of a loop along x, with half the ranges of force and displacement [Fouvry, Kapsa, Vincent, Wear 185 (1995) 35].
    ///
    /// # Arguments
    /// * `work` -- `W` of a cycle, J
    pub fn energy_ratio(&self, work: f64) -> f64 {
        let ratio =
            work / (range(self.force[0].iter().copied()) * range(self.displacement[0].iter().copied()));
        if self.width.is_finite() && ratio.is_finite() { ratio } else { f64::NAN }
    }

    /// Sliding ratio of a loop along x: width at no force over the stroke.
    pub fn sliding_ratio(&self) -> f64 {
        self.width / range(self.displacement[0].iter().copied())
    }

    /// Width at no force, m, of the polygon through the points of a loop along x.
    fn polygon_width(&self) -> f64 {
        let ([u, across], force) = (&self.displacement, &self.force[0]);
        if across.iter().any(|y| *y != 0.0) {
            return f64::NAN;
        }
        let sides = u.windows(2).zip(force.windows(2)).filter(|(_, f)| (f[0] > 0.0) != (f[1] > 0.0));
        range(sides.map(|(u, f)| u[0] + (u[1] - u[0]) * f[0] / (f[0] - f[1])))
    }

    /// Area of the loop by the trapezoidal rule, J: [`FrettingLoop::work`] to second order in the distance of the points.
    ///
    /// ```text
    /// ∮ F·du
    /// ```
    pub fn area(&self) -> f64 {
        let along = |force: &[f64], displacement: &[f64]| -> f64 {
            let steps = force.windows(2).zip(displacement.windows(2));
            steps.map(|(f, u)| 0.5 * (f[0] + f[1]) * (u[1] - u[0])).sum()
        };
        (0..2).map(|axis| along(&self.force[axis], &self.displacement[axis])).sum()
    }
}

impl Model {
    /// The loop of the cycle that is under way.
    ///
    /// Where the plain cycle holds, by Masing's rule ([`Model::fretting_loop`]); else from the springs, each of which follows the path by
    /// [`steady_cycle`], and is exact at every point:
    ///
    /// ```text
    /// F = M c_N { 2 ∫_0^c x^k e dx + 2 ∫_c^a x^k e dx }
    /// ```
    ///
    /// with the deflections `e`. The springs of the core within `c` stick and follow the indenter, each from the place where it came to rest
    /// while the contact was pressed on.
    ///
    /// # Arguments
    /// * `loading` -- what acts
    /// * `cycle` -- what it does, of [`Model::cycle`]
    /// * `compression` -- of the springs, m, of the state
    /// * `fields` -- of the state
    /// * `steps` -- even; of a loop to and fro at constant indentation. Other modes have those of their path.
    pub fn cycle_loop(
        &self,
        loading: &CycleLoading,
        cycle: &CycleFields,
        compression: &[f64],
        fields: &Fields,
        steps: usize,
    ) -> FrettingLoop {
        let unchanged = loading.friction.coefficient() == Some(self.contact.friction().coefficient)
            && loading.amplitude == self.contact.amplitude();
        if unchanged && self.slip_per_depth(loading, fields).is_some() {
            let displacement = to_and_fro(self.contact.amplitude(), steps);
            let mut force = self.fretting_loop(fields, compression, &displacement[..=steps / 2]);
            force[steps] = force[0];
            let none = vec![0.0; displacement.len()];
            let moved = |displacement: f64| self.tangential_force(fields, compression, displacement);
            let (amplitude, largest) = (displacement[0], force[0]);
            return FrettingLoop {
                displacement: [displacement, none.clone()],
                force: [force, none],
                work: cycle.dissipation / loading.share,
                width: width(amplitude, |u| largest - 2.0 * moved(0.5 * (amplitude - u))),
            };
        }
        let tangential = self.schedule.conditions().mode.is_tangential();
        // Along the steps springs are followed by more corners than the path has.
        let followed = loading.steps.as_ref().map(|steps| steps.path());
        match followed.or(loading.path.as_deref()).filter(|_| !tangential) {
            Some(path) => self.spring_loop(loading, path, compression, fields),
            None => {
                let lift = loading.path.as_ref().map_or(loading.lift, |path| path.points[0].lift);
                let place = |u: f64| PathPoint { tangential: [u, 0.0], lift };
                let mut points: Vec<PathPoint> =
                    to_and_fro(cycle.amplitude, steps).into_iter().map(place).collect();
                points.pop();
                let passing =
                    |points: Vec<PathPoint>| self.spring_loop(loading, &Path { points }, compression, fields);
                let found = passing(points);
                let on_the_way =
                    |u: f64| passing([cycle.amplitude, u, -cycle.amplitude].map(place).to_vec()).force[0][1];
                FrettingLoop { width: width(cycle.amplitude, on_the_way), ..found }
            }
        }
    }

    fn spring_loop(
        &self,
        loading: &CycleLoading,
        path: &Path,
        compression: &[f64],
        fields: &Fields,
    ) -> FrettingLoop {
        let half_space = self.contact.half_space();
        let ratio = half_space.stiffness_ratio();
        let steps = path.points.len();
        let displacement =
            [0, 1].map(|axis| (0..=steps).map(|m| path.points[m % steps].tangential[axis]).collect());
        let mut force = [0, 1].map(|_| vec![0.0; steps + 1]);
        let (mut work, mut substeps) = (0.0, 0);
        let mut spring = SpringCycle::default();
        let friction = &*loading.friction;
        let turns = !path.is_straight() && friction.static_factor() == 1.0;
        let mut slipping = turns.then(|| Neighbours::new(path)).flatten();
        // Neighbours leave only springs that stick or are lifted.
        let slips_below = if slipping.is_none() { slips_below(loading, path, ratio) } else { 0.0 };
        let lift = path.points[0].lift;
        let mut add = |stiffness: f64, compression: f64, slipped: f64| {
            let limit = friction.kinetic_strength(compression - lift) / ratio;
            match slipping.as_mut().filter(|it| compression >= lift && limit < it.sticking()) {
                Some(slipping) => {
                    slipping.pass(limit, &mut spring);
                    spring.work *= ratio;
                }
                None => {
                    let shakedown = Shakedown { slips: compression < slips_below, ..Shakedown::default() };
                    settled_cycle(path, friction, ratio, [compression, slipped], &shakedown, &mut spring);
                }
            }
            work += stiffness * spring.work;
            substeps += spring.substeps;
            for (axis, force) in force.iter_mut().enumerate() {
                for (total, deflection) in force[1..].iter_mut().zip(&spring.deflection) {
                    *total += ratio * stiffness * deflection[axis];
                }
            }
        };
        // In y = x^(1+k), which leaves no power of x.
        let exponent = 1.0 + half_space.grading();
        let core = 2.0 * half_space.normal_stiffness() * fields.stick_zone.stick_area.powf(0.5 * exponent)
            / exponent;
        let (profile, radius) = (self.contact.equivalent_profile(), fields.stick_zone.stick_area.sqrt());
        let depth = self.depth_over_core(&fields.stick_zone);
        let rule = Rule::legendre(CORE_NODES).expect("a rule of few nodes");
        for (part, weight) in rule.nodes.iter().zip(&rule.weights) {
            let x = radius * part.powf(exponent.recip());
            add(core * weight, depth - profile.value(x), 0.0);
        }
        for (q, weight) in compression.iter().zip(self.spring_weights(fields)) {
            add(half_space.normal_stiffness() * weight, q.max(0.0), loading.slipped);
        }
        for force in &mut force {
            force[0] = force[steps];
        }
        self.count_substeps(substeps, path, &*loading.friction);
        let found = FrettingLoop { displacement, force, work, width: f64::NAN };
        FrettingLoop { width: found.polygon_width(), ..found }
    }
}

/// Largest value less the smallest; not a number where there is none.
fn range(values: impl Iterator<Item = f64>) -> f64 {
    let ends = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], it| [low.min(it), high.max(it)]);
    if ends[0] <= ends[1] { ends[1] - ends[0] } else { f64::NAN }
}

/// Width at no force, m, of a loop whose way back is its way from `U` to `-U` turned about the origin; not a number where no force acts.
fn width(amplitude: f64, force: impl FnMut(f64) -> f64) -> f64 {
    bracketed(force, -amplitude, amplitude, 0.0).map_or(f64::NAN, |u| 2.0 * u.abs())
}

/// Displacements, m, from the amplitude to its negative and back, denser next to the reversals.
fn to_and_fro(amplitude: f64, steps: usize) -> Vec<f64> {
    let turn = steps / 2;
    let first_half = |i: usize| amplitude * (PI * i as f64 / turn as f64).cos();
    let way_down = |i: usize| if i <= turn - i { first_half(i) } else { -first_half(turn - i) };
    // Exactly the same displacements on the way back, and the negative ones those of the positive.
    (0..=steps).map(|i| way_down(i.min(steps - i))).collect()
}
