//! How the springs slip in one period, in closed form or step by step.

use faer::Mat;

use super::edge_in_block::AtRest;
use super::resistance::strength;
use super::schedule::{AmplitudeControl, CycleLoading};
use super::slipping::Slipping;
use super::{Fields, Model, State};
use crate::contact::spring::{Response, Shakedown, SpringCycle, Steps, settled_cycle};
use crate::contact::stick_slip::{sliding_amplitude, slip_amplitude_of_spring};
use crate::laws::friction::FrictionLaw;
use crate::laws::path::Path;
use crate::numerics::linear::dot;
use crate::numerics::roots::bracketed;

/// Change of a compression, relative to the one at the edge of stick, by which slopes are found.
const DIFFERENCE: f64 = 1e-7;

/// Part of the compression at the edge of stick below which a spring surely slips for ever.
const SURELY: f64 = 1.0 - 1e-9;

/// Grading up to which compressions swing wherever a block at a smaller indentation has worn, and springs that it lifts out of contact are better taken to bear nothing: with them pulling, no step led on.
const SWINGING_ALL_OVER: f64 = -0.9;

/// What the springs inside the contact edge do in one period.
pub(super) struct Motion {
    /// Tangential amplitude of the contact, m.
    pub amplitude: f64,
    /// Slip in each step, m, shape `(springs - 1, steps · components)`.
    pub slip: Mat<f64>,
    /// Slip of a spring without compression, m, shape `(steps · components,)`.
    pub free: Vec<f64>,
    /// One where all slip along a line, else two.
    pub components: usize,
    /// Which way all springs slip in each step along a line, 1 or -1, and 0 where they do not; none where that is not known.
    pub ways: Vec<f64>,
    /// Whether steps come in pairs, the two nodes of one, of which one alone may go against the other.
    pub paired: bool,
    /// What presses in each step, m: the mean compression, or what resists slip where wear goes by energy; shape
    /// `(springs - 1, steps)`, or one column if it is the same in all.
    pub load: Mat<f64>,
    /// By spring, shape `(springs - 1,)`.
    pub energies: Vec<Energies>,
    /// Derivatives of `slip` by the compression that a spring slips by, and of `load` by that of the spring.
    pub slip_slope: Mat<f64>,
    pub load_slope: Mat<f64>,
    /// Derivatives of the compressions that springs slip by, as [`Slipping`] has them.
    pub follows: Vec<Vec<(usize, f64)>>,
    /// Where the amplitude depends on the compressions.
    pub amplitude_slope: Option<AmplitudeSlope>,
    /// Springs that do not slip whatever their compression.
    pub at_rest: AtRest,
}

/// Energies of one spring in one period, over its normal stiffness, m².
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Energies {
    /// Work of kinetic friction.
    pub dissipation: f64,
    /// What jumps from static to kinetic friction lose beyond it.
    pub jump_loss: f64,
    /// Work of the indenter.
    pub work: f64,
}

impl Energies {
    /// A part of all.
    fn times(self, part: f64) -> Self {
        Self {
            dissipation: part * self.dissipation,
            jump_loss: part * self.jump_loss,
            work: part * self.work,
        }
    }
}

/// How the amplitude follows the compressions.
pub(super) struct AmplitudeSlope {
    /// Derivatives of the amplitude by the compressions.
    pub by_compression: Vec<f64>,
    /// One for the springs that slip, zero for the others.
    pub slips: Vec<f64>,
}

impl Motion {
    /// Steps of the period.
    pub fn steps(&self) -> usize {
        self.free.len() / self.components
    }
}

impl Model {
    /// How the springs slip; slopes only if they are asked for.
    pub(super) fn motion(
        &self,
        loading: &CycleLoading,
        compression: &[f64],
        fields: &Fields,
        slopes: bool,
    ) -> Motion {
        let mut motion = match (&loading.steps, &loading.path) {
            (Some(steps), _) => self.stepped_motion(loading, steps, compression, slopes),
            (None, Some(path)) if loading.control == AmplitudeControl::Displacement => {
                self.resolved_motion(loading, path, compression, slopes)
            }
            (None, Some(path)) => self.balanced_motion(loading, path, compression, fields, slopes),
            (None, None) => self.closed_form_motion(loading, compression, fields, slopes),
        };
        motion.at_rest = self.at_rest_in(loading, motion.amplitude);
        self.keep_at_rest(fields, &mut motion);
        motion
    }

    /// Takes the slip away that errors of their compressions give to springs that rest.
    fn keep_at_rest(&self, fields: &Fields, motion: &mut Motion) {
        if motion.at_rest.area == 0.0 {
            return;
        }
        let nodes = &self.annulus().operators.abel.nodes()[1..=motion.energies.len()];
        let place = |x: &f64| fields.stick_zone.stick_area + fields.slip_area * x;
        let resting = nodes.partition_point(|x| place(x) <= motion.at_rest.area);
        motion.energies[..resting].fill(Energies::default());
        for part in [&mut motion.slip, &mut motion.slip_slope] {
            let rows = resting.min(part.nrows());
            part.subrows_mut(0, rows).fill(0.0);
        }
    }

    /// Tangential oscillation at constant indentation: `4 σ(q)` in a single step.
    fn closed_form_motion(
        &self,
        loading: &CycleLoading,
        compression: &[f64],
        fields: &Fields,
        slopes: bool,
    ) -> Motion {
        let ratio = self.contact.half_space().stiffness_ratio();
        let lifted: Vec<f64> = compression.iter().map(|q| q - loading.lift).collect();
        let amplitude = self.amplitude(loading, &lifted, fields);
        let law = &*loading.friction;
        let keeps_below = loading.keeps_slipping_below(ratio) - loading.lift;
        let resistance = self.resistance(loading, &lifted, fields);
        let slip: Vec<(f64, f64)> = lifted
            .iter()
            .enumerate()
            .map(|(j, q)| {
                if resistance.is_straight(j) {
                    let slope = -self.slope(|q| resistance.of(j, q), *q) / ratio;
                    return (amplitude - resistance.of(j, *q) / ratio, slope);
                }
                match *q < keeps_below {
                    true => sliding_amplitude(law, ratio, amplitude, *q),
                    false => slip_amplitude_of_spring(law, ratio, amplitude, *q),
                }
            })
            .collect();
        let bearing = self.bearing_in(loading);
        let energies = |(j, (q, slip)): (usize, (&f64, &(f64, f64)))| -> Energies {
            if slip.0 == 0.0 {
                return Energies::default();
            }
            if resistance.is_straight(j) {
                let dissipation = 4.0 * resistance.of(j, *q) * slip.0;
                return Energies { dissipation, jump_loss: 0.0, work: dissipation };
            }
            let held = law.static_strength(*q);
            let dragged = law.kinetic_strength(*q);
            // Each way from the kinetic limit on one side to the static one on the other, and from there on at the kinetic one.
            let stuck = 0.5 * (held * held - dragged * dragged) / ratio;
            let slides = 2.0 * amplitude - (held + dragged) / ratio;
            Energies {
                dissipation: 4.0 * dragged * slip.0,
                jump_loss: (held - dragged).powi(2) / ratio,
                work: 2.0 * (stuck + dragged * slides),
            }
            .times(bearing.part_borne(*q))
        };
        let inner = compression.len();
        let borne = |j, q| match bearing.traction.is_some() && resistance.is_straight(j) {
            true => resistance.of(j, q),
            false => bearing.of(q, loading.lift),
        };
        let amplitude_slope = (slopes && loading.control != AmplitudeControl::Displacement)
            .then(|| self.amplitude_slope(loading, &lifted, &slip, fields));
        let rows = if slopes { inner } else { 0 };
        Motion {
            amplitude,
            slip: Mat::from_fn(inner, 1, |j, _| 4.0 * slip[j].0),
            free: vec![4.0 * amplitude],
            components: 1,
            ways: vec![],
            paired: false,
            load: Mat::from_fn(inner, 1, |j, _| borne(j, compression[j])),
            energies: lifted.iter().zip(&slip).enumerate().map(energies).collect(),
            slip_slope: Mat::from_fn(rows, 1, |j, _| 4.0 * slip[j].1),
            load_slope: Mat::from_fn(rows, 1, |j, _| self.slope(|q| borne(j, q), compression[j])),
            follows: vec![],
            amplitude_slope,
            at_rest: AtRest::default(),
        }
    }

    /// Springs through the period of a path, with what goes one way between reversals as one step.
    pub(super) fn resolved_motion(
        &self,
        loading: &CycleLoading,
        path: &Path,
        compression: &[f64],
        slopes: bool,
    ) -> Motion {
        let components = path.components();
        let table = loading.response.as_deref();
        let ways = if table.is_some() { vec![] } else { path.ways() };
        let columns = table.map_or_else(|| path.columns(&ways), Response::columns);
        let inner = compression.len();
        let steps = columns / components;
        let ratio = self.contact.half_space().stiffness_ratio();
        // A table has been found already.
        let slipping = if table.is_none() { slips_below(loading, path, ratio) } else { 0.0 };
        let mut springs = PathSprings {
            loading,
            path,
            components,
            ways,
            ratio,
            slipping,
            difference: DIFFERENCE * self.contact.slip_compression(),
            cycle: SpringCycle::default(),
            passed: 0,
        };
        let mut values = vec![0.0; columns];
        let mut slope = vec![0.0; if slopes { columns } else { 0 }];
        springs.pass(0.0, &mut values, &mut []);
        let mut motion = Motion {
            amplitude: loading.amplitude,
            slip: Mat::zeros(inner, columns),
            free: values.clone(),
            components,
            ways: vec![],
            paired: table.is_some_and(Response::is_paired),
            load: Mat::zeros(0, 0),
            energies: Vec::with_capacity(inner),
            slip_slope: Mat::zeros(if slopes { inner } else { 0 }, columns),
            load_slope: Mat::zeros(0, 0),
            follows: vec![],
            amplitude_slope: None,
            at_rest: AtRest::default(),
        };
        let bearing = self.bearing_in(loading);
        let slipping = (!path.is_level()).then(|| Slipping::new(compression));
        let by = slipping.as_ref().map_or(compression, Slipping::compressions);
        for (j, q) in by.iter().enumerate() {
            let energies = springs.pass(q.max(0.0), &mut values, &mut slope);
            let part = if path.is_level() { bearing.part_borne(q - path.points[0].lift) } else { 1.0 };
            motion.energies.push(energies.times(part));
            for (m, value) in values.iter().enumerate() {
                motion.slip[(j, m)] = *value;
            }
            for (m, value) in slope.iter().enumerate() {
                motion.slip_slope[(j, m)] = *value;
            }
        }
        motion.follows = slipping.map(Slipping::into_follows).unwrap_or_default();
        self.count_substeps(springs.passed, path, &*loading.friction);
        let count = path.points.len();
        let lifts = |m: usize| [path.points[m].lift, path.points[(m + 1) % count].lift];
        let different = if path.is_level() { 1 } else { steps };
        let mean = |q: f64, m: usize| lifts(m).map(|lift| 0.5 * bearing.of(q, lift)).iter().sum::<f64>();
        motion.load = Mat::from_fn(inner, different, |j, m| mean(compression[j], m));
        motion.load_slope = Mat::from_fn(if slopes { inner } else { 0 }, different, |j, m| {
            self.slope(|q| mean(q, m), compression[j])
        });
        motion
    }

    /// Springs to and fro along a path by the amplitude that the balance of forces decides.
    fn balanced_motion(
        &self,
        loading: &CycleLoading,
        path: &Path,
        compression: &[f64],
        fields: &Fields,
        slopes: bool,
    ) -> Motion {
        let lift = path.points[0].lift;
        let lifted: Vec<f64> = compression.iter().map(|q| q - lift).collect();
        let amplitude = self.amplitude(loading, &lifted, fields);
        let path = path.stretched(amplitude / loading.amplitude);
        let motion = self.resolved_motion(loading, &path, compression, slopes);
        let amplitude_slope = slopes.then(|| {
            let slip: Vec<(f64, f64)> = lifted
                .iter()
                .map(|q| {
                    let ratio = self.contact.half_space().stiffness_ratio();
                    slip_amplitude_of_spring(&*loading.friction, ratio, amplitude, *q)
                })
                .collect();
            self.amplitude_slope(loading, &lifted, &slip, fields)
        });
        Motion { amplitude, amplitude_slope, ..motion }
    }

    /// Springs through the steps of a path along which the indenter moves up and down.
    fn stepped_motion(
        &self,
        loading: &CycleLoading,
        steps: &Steps,
        compression: &[f64],
        slopes: bool,
    ) -> Motion {
        let (inner, columns) = (compression.len(), steps.columns());
        let ratio = self.contact.half_space().stiffness_ratio();
        let rows = if slopes { inner } else { 0 };
        let mut motion = Motion {
            amplitude: loading.amplitude,
            slip: Mat::zeros(inner, columns),
            free: vec![0.0; columns],
            components: 1,
            ways: steps.ways(),
            paired: true,
            load: Mat::zeros(inner, columns),
            energies: Vec::with_capacity(inner),
            slip_slope: Mat::zeros(rows, columns),
            load_slope: Mat::zeros(rows, columns),
            follows: vec![],
            amplitude_slope: None,
            at_rest: AtRest::default(),
        };
        // Springs without compression are never loaded.
        let [mut values, mut after] = [(); 2].map(|()| vec![0.0; columns]);
        let difference = DIFFERENCE * self.contact.slip_compression();
        let bearing = self.bearing_in(loading);
        let per_compression = bearing.of(1.0, 0.0);
        let slipping = Slipping::new(compression);
        for (j, (q, by)) in compression.iter().zip(slipping.compressions()).enumerate() {
            let passed = steps.pass(by.max(0.0), &mut values);
            let dissipation = ratio * passed.dissipation;
            motion.energies.push(Energies { dissipation, jump_loss: 0.0, work: dissipation });
            for (m, value) in values.iter().enumerate() {
                motion.slip[(j, m)] = *value;
            }
            if slopes {
                // Springs that bear next to nothing touch for a moment, and their slopes hold over no more than that.
                steps.pass(by.max(0.0) + difference, &mut after);
                for (m, (after, value)) in after.iter().zip(&values).enumerate() {
                    motion.slip_slope[(j, m)] = (after - value) / difference;
                }
            }
            if *q < 0.0 {
                motion.load.row_mut(j).fill(bearing.of(*q, 0.0));
                if slopes {
                    motion.load_slope.row_mut(j).fill(self.slope(|q| bearing.of(q, 0.0), *q));
                }
                continue;
            }
            steps.load(*q, |m, load, slope| {
                motion.load[(j, m)] = per_compression * load;
                if slopes {
                    motion.load_slope[(j, m)] = per_compression * slope;
                }
            });
        }
        motion.follows = slipping.into_follows();
        motion
    }

    /// Tangential amplitude of the contact, m: as prescribed, or by the balance of forces.
    fn amplitude(&self, loading: &CycleLoading, lifted: &[f64], fields: &Fields) -> f64 {
        if loading.control == AmplitudeControl::Displacement {
            return loading.amplitude;
        }
        let largest = self.largest_amplitude(loading);
        let excess =
            |amplitude: f64| loading.excess(self.force(loading, lifted, fields, amplitude), amplitude);
        // At the last stick radius the contact gives way.
        bracketed(excess, 0.0, largest, 0.0).unwrap_or(largest)
    }

    /// Amplitude, m, at which springs slip from the last stick radius on.
    fn largest_amplitude(&self, loading: &CycleLoading) -> f64 {
        let strength = loading.friction.static_strength(self.contact.slip_compression() - loading.lift);
        strength / self.contact.half_space().stiffness_ratio()
    }

    /// Whether a balance of tangential forces asks for more than all springs beyond the core of the mesh bear, where the edge of stick is on the mesh.
    pub(super) fn gives_way(&self, state: &State) -> bool {
        if !self.slides || self.gross().is_some() || self.moving().is_some() {
            return false;
        }
        let loading = self.loading_in(state, self.schedule.loading(state.cycles, state.cycles));
        if loading.control == AmplitudeControl::Displacement || loading.is_pause() {
            return false;
        }
        let lifted: Vec<f64> = state.compression.iter().map(|q| q - loading.lift).collect();
        let amplitude = self.largest_amplitude(&loading);
        loading.excess(self.force(&loading, &lifted, &self.fields(state), amplitude), amplitude) < 0.0
    }

    /// Derivatives of the amplitude in the balance of forces.
    fn amplitude_slope(
        &self,
        loading: &CycleLoading,
        lifted: &[f64],
        slip: &[(f64, f64)],
        fields: &Fields,
    ) -> AmplitudeSlope {
        let half_space = self.contact.half_space();
        let resistance = self.resistance(loading, lifted, fields);
        let slips: Vec<f64> = slip.iter().map(|(value, _)| f64::from(u8::from(*value > 0.0))).collect();
        let weights: Vec<f64> = self
            .annulus()
            .operators
            .abel
            .spring_sum()
            .iter()
            .zip(&fields.density_factor)
            .map(|(weight, factor)| half_space.normal_stiffness() * fields.slip_area * weight * factor)
            .collect();
        let ratio = half_space.stiffness_ratio();
        let sticking: f64 =
            weights.iter().zip(&slips).map(|(weight, slips)| ratio * weight * (1.0 - slips)).sum();
        let by_amplitude = self.stuck_force(fields, 1.0) + sticking;
        let [by_force, direct] = loading.control.factors();
        let by_compression = (0..lifted.len()).map(|j| {
            let strength = slips[j] * self.slope(|q| resistance.of(j, q), lifted[j]);
            -by_force * weights[j] * strength / (by_force * by_amplitude + direct)
        });
        AmplitudeSlope { by_compression: by_compression.collect(), slips: slips.clone() }
    }

    /// Amplitude of the tangential force, N, of springs lifted to `lifted`, m, moved by `amplitude`, m.
    pub(super) fn force(
        &self,
        loading: &CycleLoading,
        lifted: &[f64],
        fields: &Fields,
        amplitude: f64,
    ) -> f64 {
        let half_space = self.contact.half_space();
        let resistance = self.resistance(loading, lifted, fields);
        let sticks = half_space.stiffness_ratio() * amplitude;
        let bears = |j, q| match resistance.is_straight(j) {
            true => resistance.of(j, q),
            false => resistance.of(j, q).min(sticks),
        };
        let borne: Vec<f64> = lifted
            .iter()
            .zip(&fields.density_factor)
            .enumerate()
            .map(|(j, (q, factor))| factor * bears(j, *q))
            .collect();
        self.stuck_force(fields, amplitude)
            + half_space.normal_stiffness()
                * fields.slip_area
                * dot(self.annulus().operators.abel.spring_sum(), &borne)
    }

    /// Tangential force, N, of the springs within the last stick radius.
    fn stuck_force(&self, fields: &Fields, amplitude: f64) -> f64 {
        let half_space = self.contact.half_space();
        let q = 1.0 + half_space.grading();
        let tangential = half_space.stiffness_ratio() * half_space.normal_stiffness();
        2.0 * tangential * amplitude * fields.stick_zone.stick_area.powf(0.5 * q) / q
    }

    /// What the law of wear takes for the load of springs.
    pub(super) fn bearing_in<'a>(&self, loading: &'a CycleLoading) -> Bearing<'a> {
        let law = &*loading.friction;
        Bearing {
            traction: loading.wear.takes_traction().then_some(law),
            least: self.least_compression(law),
            spreads: loading.wear.spreading().is_some(),
            pulls_lifted: loading.path.is_some() || self.contact.half_space().grading() > SWINGING_ALL_OVER,
        }
    }

    /// Slope of a function of the compression of one spring, by a difference to the side of more compression.
    fn slope(&self, function: impl Fn(f64) -> f64, compression: f64) -> f64 {
        let difference = DIFFERENCE * self.contact.slip_compression();
        (function(compression + difference) - function(compression)) / difference
    }

    /// Two heights, m, the lower one first, far enough apart for a slope between them.
    pub(super) fn apart(&self, [one, other]: [f64; 2]) -> [f64; 2] {
        let low = one.min(other);
        [low, one.max(other).max(low + DIFFERENCE * self.contact.slip_compression())]
    }

    /// Mean derivatives by the compression of what a spring bears while it is lifted from each height to the next, m.
    ///
    /// # Arguments
    /// * `bears` -- what it bears, by its lift
    /// * `lifts` -- one more than there are derivatives
    pub(super) fn mean_slopes(&self, bears: impl Fn(f64) -> f64, lifts: &[f64], slopes: &mut [f64]) {
        let mut before = bears(lifts[0]);
        for (ends, slope) in lifts.windows(2).zip(slopes) {
            let after = bears(ends[1]);
            let rise = ends[1] - ends[0];
            let [low, high] = self.apart([ends[0], ends[1]]);
            *slope = match rise.abs() == high - low {
                true => (before - after) / rise,
                false => (bears(low) - bears(high)) / (high - low),
            };
            before = after;
        }
    }
}

/// Compression, m, below which springs slip for ever on a path in two directions; zero along a line, where a period repeats the first, and for springs with a memory of their slip.
pub(super) fn slips_below(loading: &CycleLoading, path: &Path, stiffness_ratio: f64) -> f64 {
    let searches = !path.is_straight() && !loading.friction.remembers_slip();
    if searches { SURELY * loading.slip_compression(stiffness_ratio) } else { 0.0 }
}

/// Springs on the path of a cycle.
struct PathSprings<'a> {
    loading: &'a CycleLoading,
    path: &'a Path,
    components: usize,
    /// The step to which each substep belongs.
    ways: Vec<usize>,
    ratio: f64,
    /// Change of the compression, m, by which slopes are found.
    difference: f64,
    /// Compression, m, below which springs slip for ever.
    slipping: f64,
    cycle: SpringCycle,
    /// Substeps so far.
    passed: usize,
}

impl PathSprings<'_> {
    /// Slip of a spring in each step, m, and its derivatives by the compression where there is room for them; energies.
    fn pass(&mut self, compression: f64, slip: &mut [f64], slopes: &mut [f64]) -> Energies {
        if let Some(response) = &self.loading.response {
            return self.tabulated(response, compression, slip, slopes);
        }
        let energies = self.direct(compression, slip);
        if !slopes.is_empty() {
            self.direct(compression + self.difference, slopes);
            for (slope, value) in slopes.iter_mut().zip(slip) {
                *slope = (*slope - *value) / self.difference;
            }
        }
        energies
    }

    fn tabulated(
        &self,
        response: &Response,
        compression: f64,
        slip: &mut [f64],
        slopes: &mut [f64],
    ) -> Energies {
        let lifted = compression - self.path.points[0].lift;
        if lifted < 0.0 {
            slip.fill(0.0);
            slopes.fill(0.0);
            return Energies::default();
        }
        let limit = |q: f64| self.loading.friction.kinetic_strength(q) / self.ratio;
        let by_limit = (!slopes.is_empty()).then_some(&mut *slopes);
        let [dissipation, work] = response.at(limit(lifted), slip, by_limit);
        let by_compression = (limit(lifted + self.difference) - limit(lifted)) / self.difference;
        slopes.iter_mut().for_each(|slope| *slope *= by_compression);
        Energies { dissipation: self.ratio * dissipation, jump_loss: 0.0, work: self.ratio * work }
    }

    fn direct(&mut self, compression: f64, slip: &mut [f64]) -> Energies {
        let cycle = &mut self.cycle;
        settled_cycle(
            self.path,
            &*self.loading.friction,
            self.ratio,
            [compression, self.loading.slipped],
            &Shakedown { slips: compression < self.slipping, ..Shakedown::default() },
            cycle,
        );
        self.passed += cycle.substeps;
        slip.fill(0.0);
        if self.components == 1 && self.path.is_level() {
            // What moved less what the deflection took up: a sum over the substeps would round off as many times.
            let count = self.path.points.len();
            let place = |m: usize| {
                self.path.points[m % count].tangential[0] - cycle.deflection[(m + count - 1) % count][0]
            };
            let slips = if cycle.slip_path > 0.0 { 1.0 } else { 0.0 };
            for (m, way) in self.ways.iter().enumerate() {
                let before = self.ways[(m + count - 1) % count];
                if before != *way {
                    slip[before] += slips * place(m);
                    slip[*way] -= slips * place(m);
                }
            }
        } else {
            for (way, substep) in self.ways.iter().zip(&cycle.slip) {
                for (axis, value) in substep[..self.components].iter().enumerate() {
                    slip[self.components * way + axis] += value;
                }
            }
        }
        Energies { dissipation: cycle.dissipation, jump_loss: cycle.jump_loss, work: cycle.work }
    }
}

/// What the law of wear takes for the load of a spring.
pub(super) struct Bearing<'a> {
    /// The law that says what resists slip, where wear takes the traction.
    traction: Option<&'a dyn FrictionLaw>,
    /// See [`strength`], m.
    least: f64,
    spreads: bool,
    /// Whether what pulls at the largest indentation does so wherever it is lifted to.
    pulls_lifted: bool,
}

impl<'a> Bearing<'a> {
    /// What is taken for each compression, where all springs that are loaded bear in proportion to theirs.
    pub(super) fn in_proportion(&self) -> Option<f64> {
        let Some(law) = self.traction else { return Some(1.0) };
        let factor = law.kinetic_strength(1.0);
        (law.kinetic_strength_slope(0.0) == factor).then_some(factor)
    }

    /// Part that wear takes of what resists the slip of a spring, by its compression after a lift that stays, m.
    fn part_borne(&self, compression: f64) -> f64 {
        match self.traction {
            Some(law) if compression > 0.0 && compression < self.least => {
                strength(law, self.least, compression) / law.kinetic_strength(compression)
            }
            _ => 1.0,
        }
    }

    /// Of a spring of this compression at the largest indentation, lifted by `lift`, m: its compression, or what resists its slip.
    pub(super) fn of(&self, compression: f64, lift: f64) -> f64 {
        // A spring that pulls at the largest indentation does so by round-off, about zero in the limit, or as compressions swing next to the edge of stick;
        // it pulls all the time, wherever it is lifted to, for so it wears back. One that presses there may lose contact.
        let pulls = compression < 0.0 && (self.pulls_lifted || lift == 0.0);
        match self.traction {
            Some(law) if pulls => -strength(law, self.least, -compression),
            Some(law) => strength(law, self.least, compression - lift),
            None if pulls && !self.spreads => compression,
            None => (compression - lift).max(0.0),
        }
    }
}
