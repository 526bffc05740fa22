//! What a cycle does to a contact in gross slip.
//!
//! `F` carries what resists the springs, and so their slip, to the surface; at constant indentation it resists them by `b = τ_k(q)/μ`, that is by `q` under Coulomb's law:
//!
//! ```text
//! s = (μ/M) (M U/μ - F b),     U given  or  U + F_x/k_r given,     F_x = μ c_N A^ν ∫_0^1 ξ^(ν-1) b dξ
//! ```

use std::f64::consts::PI;

use faer::Mat;

use super::{Gross, Whole};
use crate::numerics::linear::dot;
use crate::numerics::roots::bracketed;
use crate::numerics::whole_contact::{Coordinate, WholeContact};
use crate::solver::model::cycle::Surface;
use crate::solver::model::motion::{Bearing, Energies, Motion};
use crate::solver::model::schedule::CycleLoading;
use crate::solver::model::{CycleFields, Model};

/// What the springs do in a period, as it is seen on the surface.
pub(super) struct Sliding {
    amplitude: f64,
    surface: Surface,
    /// Per cycle, J.
    energies: Energies,
    /// Directions in which there is slip.
    components: usize,
    /// In closed form at constant indentation.
    closed: Option<ClosedForm>,
    /// `c²/a²` of the springs that stick.
    stuck: f64,
}

/// Slip in a cycle to and fro at constant indentation.
struct ClosedForm {
    /// `μ/M`.
    per_depth: f64,
    /// `M U/μ`, m.
    level: f64,
    /// `F b`, m, at all nodes.
    carried: Vec<f64>,
    stick: Option<Stick>,
    /// `ν`.
    nu: f64,
}

/// Springs next to the axis that stick.
struct Stick {
    /// `c²/a²`.
    fraction: f64,
    /// `ξ`, weight of `∫ ξ^(ν-1) dξ`, and `b`; empty where the latter is that of the polynomials.
    within: Vec<[f64; 3]>,
}

impl ClosedForm {
    /// `M s/μ`, m, at a coordinate where `F b` is given; without the springs that stick, for which `F` has taken `M U/μ - b` as well.
    fn slip_depth(&self, carried: f64, fraction: f64) -> f64 {
        let Some(stick) = &self.stick else { return self.level - carried };
        if fraction <= stick.fraction {
            return 0.0;
        }
        let parts = stick
            .within
            .iter()
            .map(|[x, weight, b]| weight * (b - self.level) * (fraction - x).powf(-self.nu));
        self.level - carried + (PI * self.nu).sin() / PI * parts.sum::<f64>()
    }
}

impl Sliding {
    /// Slip amplitude, m, at a coordinate.
    pub(super) fn slip_at(&self, mesh: &WholeContact, cycle: &CycleFields, coordinate: Coordinate) -> f64 {
        match &self.closed {
            Some(closed) => {
                let carried = mesh.value(&closed.carried, coordinate);
                closed.per_depth * closed.slip_depth(carried, mesh.fraction(coordinate))
            }
            None => mesh.value_inside(&cycle.slip, coordinate),
        }
    }
}

impl Model {
    /// What a cycle does, with the depth worn at the inner nodes, m.
    pub(super) fn gross_wear(
        &self,
        gross: &Gross,
        loading: &CycleLoading,
        compression: &[f64],
        whole: &Whole,
    ) -> (Vec<f64>, CycleFields, Sliding) {
        let mesh = &gross.mesh;
        let sliding = match &loading.path {
            Some(path) => {
                let motion = self.resolved_motion(loading, path, compression, false);
                self.count_columns(loading, &motion, 1);
                self.sliding_on_path(gross, loading, &motion, whole)
            }
            None => self.sliding_to_and_fro(gross, loading, compression, whole),
        };
        let per_cycle = loading.cycles_per_period.recip();
        let law = &*loading.wear;
        let energies = sliding.energies;
        let at_contact = law.at_contact(energies.dissipation / (PI * whole.area)).unwrap_or(1.0);
        let mut depth = self.worn(loading, &sliding.surface, false).depth;
        depth.iter_mut().for_each(|depth| *depth *= at_contact * per_cycle);
        let in_proportion = law.volume_per_energy(loading.friction.coefficient());
        let volume = match in_proportion.filter(|_| sliding.components == 1) {
            Some(factor) => at_contact * factor * energies.dissipation,
            None => {
                // At the edge the polynomial through the other nodes.
                let mut all = depth.clone();
                all.push(mesh.value_inside(&depth, mesh.coordinate(1.0)));
                PI * whole.area * mesh.area(&all)
            }
        };
        let path = &sliding.surface.path;
        let slip = |i: usize| 0.25 * per_cycle * path.row(i).iter().sum::<f64>();
        let cycle = CycleFields {
            growth: depth.iter().map(|depth| depth / self.contact.indentation()).collect(),
            slip: (0..depth.len()).map(slip).collect(),
            dissipation: energies.dissipation,
            jump_loss: energies.jump_loss,
            work: energies.work,
            volume,
            amplitude: sliding.amplitude,
            stick_radius: (sliding.stuck * whole.area).sqrt(),
        };
        depth.iter_mut().for_each(|depth| *depth *= loading.share);
        (depth, cycle.lasting(loading.share), sliding)
    }

    /// To and fro at constant indentation.
    fn sliding_to_and_fro(
        &self,
        gross: &Gross,
        loading: &CycleLoading,
        compression: &[f64],
        whole: &Whole,
    ) -> Sliding {
        let (half_space, mesh, friction) = (self.contact.half_space(), &gross.mesh, &*loading.friction);
        let (ratio, nu) = (half_space.stiffness_ratio(), 1.0 - self.mu());
        let coefficient = friction.reference_coefficient();
        let plain = friction.coefficient().is_some();
        // Springs lose contact by round-off only.
        let resisting = |q: &f64| friction.kinetic_strength(q.abs()).copysign(*q) / coefficient;
        let mut borne: Vec<f64> =
            if plain { compression.to_vec() } else { compression.iter().map(resisting).collect() };
        let force = coefficient * half_space.normal_stiffness() * whole.area.powf(nu);
        let [by_force, _] = loading.control.factors();
        let (per_depth, depth_of) = (coefficient / ratio, |amplitude: f64| ratio * amplitude / coefficient);
        let (amplitude, stick) = match by_force > 0.0 {
            true => {
                let most = borne.iter().copied().fold(0.0, f64::max);
                // Springs that stick bear `M U` each.
                let capped = |level: f64| borne.iter().map(move |b| b.min(level));
                let bearing = |level: f64| dot(&capped(level).collect::<Vec<_>>(), mesh.load_weights());
                let excess =
                    |amplitude: f64| amplitude + by_force * force * bearing(depth_of(amplitude)) - loading.amplitude;
                let sliding = loading.amplitude - by_force * force * mesh.load(&borne);
                if depth_of(sliding) >= most {
                    (sliding, None)
                } else {
                    let amplitude = bracketed(excess, 0.0, loading.amplitude, 0.0).unwrap_or(f64::NAN);
                    let level = depth_of(amplitude);
                    let end = mesh.last_above(&borne, level);
                    borne = capped(level).collect();
                    let stick = end.map(|end| Stick { fraction: mesh.fraction(end), within: vec![] });
                    (amplitude, stick)
                }
            }
            false => {
                // Where indentation and amplitude are held compressions only fall.
                let sticking = friction.compression_at(ratio * loading.amplitude);
                let pressed = gross.holds_force().then(|| mesh.last_above(compression, sticking)).flatten();
                let stick = pressed.and_then(|end| {
                    let within = mesh.up_to(end, &borne).ok()?;
                    Some(Stick { fraction: mesh.fraction(end), within })
                });
                (loading.amplitude, stick)
            }
        };
        let level = depth_of(amplitude);
        let carried = match plain && by_force == 0.0 {
            true => whole.elastic.clone(),
            false => mesh.profile(&borne),
        };
        // Of the springs but for those that stick.
        let sum = |value: &dyn Fn(f64, f64) -> f64| -> f64 {
            let all = borne.iter().zip(mesh.load_weights());
            let stuck = stick.iter().flat_map(|stick| &stick.within);
            all.map(|(b, weight)| value(*weight, *b)).sum::<f64>()
                - stuck.map(|[_, weight, b]| value(*weight, *b)).sum::<f64>()
        };
        let scale = 4.0 * coefficient * per_depth * half_space.normal_stiffness() * whole.area.powf(nu);
        let dissipation = scale * sum(&|weight, b| weight * b * (level - b));
        let jump_loss = match friction.static_factor() - 1.0 {
            0.0 => 0.0,
            more => 0.25 * more * more * scale * sum(&|weight, b| weight * b * b),
        };
        let closed = ClosedForm { per_depth, level, carried, stick, nu };
        let path =
            |i: usize| 4.0 * per_depth * closed.slip_depth(closed.carried[i], mesh.fractions()[i]).max(0.0);
        let path = Mat::from_fn(mesh.inner(), 1, |i, _| path(i));
        let taken = loading.wear.takes_traction();
        let pressure = if plain {
            let factor = if taken { coefficient } else { 1.0 };
            Mat::from_fn(mesh.inner(), 1, |i, _| factor * whole.pressure[i])
        } else {
            let bearing = Bearing::new(loading);
            let load = Mat::from_fn(mesh.inner(), 1, |i, _| bearing.of(compression[i], 0.0));
            self.pressed(gross, whole, &load)
        };
        Sliding {
            amplitude,
            surface: Surface { pressure, direction: Mat::zeros(0, 0), path },
            energies: Energies { dissipation, jump_loss, work: dissipation + jump_loss },
            components: 1,
            stuck: closed.stick.as_ref().map_or(0.0, |stick| stick.fraction),
            closed: Some(closed),
        }
    }

    /// Along a path.
    fn sliding_on_path(
        &self,
        gross: &Gross,
        loading: &CycleLoading,
        motion: &Motion,
        whole: &Whole,
    ) -> Sliding {
        let (mesh, components) = (&gross.mesh, motion.components);
        // At the edge springs are free.
        let column = |m: usize| -> Vec<f64> {
            let held = (0..mesh.inner()).map(|j| motion.slip[(j, m)] - motion.free[m]);
            let mut slip = mesh.profile(&held.collect::<Vec<_>>());
            slip.iter_mut().for_each(|slip| *slip += motion.free[m]);
            slip
        };
        let sticks = |spring: &usize| (0..motion.free.len()).all(|m| motion.slip[(*spring, m)] == 0.0);
        let last = (0..mesh.inner()).rev().find(sticks);
        let slip: Vec<Vec<f64>> = (0..motion.free.len()).map(column).collect();
        let along = |i: usize, one: usize, other: usize| -> f64 {
            (0..components)
                .map(|axis| slip[components * one + axis][i] * slip[components * other + axis][i])
                .sum()
        };
        let path = Mat::from_fn(mesh.inner(), motion.steps(), |i, step| {
            let path = along(i, step, step).sqrt();
            let against = motion.paired && along(i, step, step) + along(i, step, step ^ 1) < 0.0;
            if against { -path } else { path }
        });
        let pressure = self.pressed(gross, whole, &motion.load);
        let stiffness = self.contact.half_space().normal_stiffness() * whole.area.powf(1.0 - self.mu());
        let energy = |part: fn(&Energies) -> f64| -> f64 {
            let springs = motion.energies.iter().zip(mesh.load_weights());
            stiffness / loading.cycles_per_period * springs.map(|(it, weight)| weight * part(it)).sum::<f64>()
        };
        Sliding {
            amplitude: motion.amplitude,
            surface: Surface { pressure, direction: Mat::zeros(0, 0), path },
            energies: Energies {
                dissipation: energy(|it| it.dissipation),
                jump_loss: energy(|it| it.jump_loss),
                work: energy(|it| it.work),
            },
            components,
            stuck: last.map_or(0.0, |spring| mesh.fractions()[spring]),
            closed: None,
        }
    }

    /// Pressure, Pa, of loads on the springs, m, by column.
    fn pressed(&self, gross: &Gross, whole: &Whole, load: &Mat<f64>) -> Mat<f64> {
        let columns: Vec<Vec<f64>> =
            (0..load.ncols()).map(|m| gross.mesh.pressure(load.col_as_slice(m))).collect();
        let scale = self.gross_pressure_scale(whole.area);
        Mat::from_fn(load.nrows(), load.ncols(), |i, m| scale * columns[m][i])
    }
}
