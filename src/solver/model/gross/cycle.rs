//! What a cycle does to a contact in gross slip.
//!
//! `F` carries what resists the springs, and so their slip, to the surface; at constant indentation it resists them by `b = τ_k(q)/μ`, that is by `q` under Coulomb's law:
//!
//! ```text
//! s = (μ/M) (M U/μ - F b),     U given  or  U + F_x/k_r given,     F_x = μ c_N A^ν ∫_0^1 ξ^(ν-1) b dξ
//! ```

use std::f64::consts::PI;

use faer::{Mat, Scale};

use super::{Gross, Whole};
use crate::laws::friction::FrictionLaw;
use crate::laws::wear::Spreading;
use crate::numerics::roots::bracketed;
use crate::numerics::whole_contact::{Coordinate, WholeContact};
use crate::solver::model::motion::{Energies, Motion};
use crate::solver::model::moving::LAST_STICK;
use crate::solver::model::schedule::{AmplitudeControl, CycleLoading};
use crate::solver::model::spreading::Debris;
use crate::solver::model::surface::{Surface, clear_negative, directions};
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
    /// `c²/a²` within which all springs stick.
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

/// Springs that stick: next to the axis, or in a ring where ground has worn more within. A place on the surface follows the springs within it, and sticks where all of these do.
struct Stick {
    /// `c²/a²` within which all springs stick.
    fraction: f64,
    /// As how much they count: less than 1 where they are so few that a rig counts as moving all.
    part: f64,
    /// `ξ`, weight of `∫ ξ^(ν-1) dξ`, and `b` of the springs next to the axis; empty where what is borne is that of the polynomials through what each spring bears as it sticks.
    within: Vec<[f64; 3]>,
}

/// `3 x² - 2 x³` from 0 to 1, constant beyond.
fn smooth_step(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// Whether a ring of springs that stick can be told from what the mesh makes of a kink or jump elsewhere: not on polynomials through all nodes, nor with a static limit, where what springs bear jumps as
/// they begin to slip. Where not, all up to the outermost spring that sticks are taken to.
fn tells_rings(mesh: &WholeContact, friction: &dyn FrictionLaw) -> bool {
    mesh.is_local() && !friction.remembers_slip()
}

/// `c²/a²` within which all springs stick: those stick that bear more than `level`, the outermost at `end`.
fn disc_that_sticks(
    mesh: &WholeContact,
    friction: &dyn FrictionLaw,
    borne: &[f64],
    level: f64,
    end: Coordinate,
) -> f64 {
    let disc = if tells_rings(mesh, friction) { mesh.first_below(borne, level, end) } else { Some(end) };
    disc.map_or(0.0, |disc| mesh.fraction(disc))
}

impl ClosedForm {
    /// `M s/μ`, m, at a coordinate where `F b` is given; without the springs that stick, for which `F` has taken `M U/μ - b` as well.
    fn slip_depth(&self, carried: f64, fraction: f64) -> f64 {
        let Some(stick) = &self.stick else { return self.level - carried };
        if fraction <= stick.fraction {
            return (1.0 - stick.part) * (self.level - carried);
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
    /// Depth worn at the inner nodes, m, in a cycle or in the mean cycle of a pass, and what that does.
    pub(super) fn gross_mean_wear(
        &self,
        gross: &Gross,
        loading: &CycleLoading,
        compression: &[f64],
        whole: &Whole,
    ) -> (Vec<f64>, CycleFields) {
        let of_block = |part: &CycleLoading| {
            let (depth, cycle, _) = self.gross_wear(gross, part, compression, whole);
            (depth, cycle)
        };
        if loading.others.is_empty() {
            return of_block(loading);
        }
        let cycle = CycleFields::mean(loading.parts().map(|part| (part.part, of_block(part).1)));
        (cycle.growth.iter().map(|growth| growth * self.contact.indentation()).collect(), cycle)
    }

    /// What a cycle does, with the depth worn at the inner nodes, m.
    pub(super) fn gross_wear(
        &self,
        gross: &Gross,
        loading: &CycleLoading,
        compression: &[f64],
        whole: &Whole,
    ) -> (Vec<f64>, CycleFields, Sliding) {
        let mesh = &gross.mesh;
        let mut sliding = match &loading.path {
            Some(path) => {
                let motion = self.resolved_motion(loading, path, compression, false);
                self.count_columns(loading, &motion, 1);
                self.sliding_on_path(gross, loading, &motion, compression, whole)
            }
            None => self.sliding_to_and_fro(gross, loading, compression, whole),
        };
        if let Some(spreading) = loading.wear.spreading() {
            self.spread_in_gross_slip(gross, loading, spreading, compression, whole, &mut sliding);
        }
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

    /// Pressure as debris passes it on, where wear is not local.
    fn spread_in_gross_slip(
        &self,
        gross: &Gross,
        loading: &CycleLoading,
        spreading: Spreading,
        compression: &[f64],
        whole: &Whole,
        sliding: &mut Sliding,
    ) {
        let (mesh, lift) = (&gross.mesh, loading.least_lift());
        let ends = if lift > 0.0 { mesh.last_above(compression, lift) } else { None };
        let end = ends.map_or(1.0, |end| mesh.fraction(end));
        let radius = |fraction: &f64| (fraction * whole.area).sqrt();
        let radii = mesh.fractions()[..mesh.inner()].iter().map(radius).collect();
        let debris = Debris::new(radii, 0.0, [sliding.stuck, end].map(|it| radius(&it)));
        self.pass_on(loading, spreading, &debris, compression, &mut sliding.surface.pressure);
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
        let lift = loading.lift;
        let lifted = || compression.iter().map(|q| q - lift);
        let plain = friction.coefficient().is_some() && lift == 0.0;
        let resisting = |q: f64| match lift {
            // Springs lose contact by round-off only.
            0.0 => friction.kinetic_strength(q.abs()).copysign(q) / coefficient,
            _ => friction.kinetic_strength(q) / coefficient,
        };
        let mut borne: Vec<f64> =
            if plain { compression.to_vec() } else { lifted().map(resisting).collect() };
        let per_depth = coefficient / ratio;
        let force = coefficient * half_space.normal_stiffness() * whole.area.powf(nu);
        // Exactly where slip sets in with a jump, or the edge of stick is to be followed from there on.
        let exact = if gross.sticks() { friction.remembers_slip() } else { gross.holds_force() };
        let presses = exact && loading.control == AmplitudeControl::Displacement;
        let (amplitude, stick) = match presses {
            true => {
                let level = loading.amplitude / per_depth;
                let lifted: Vec<f64> = lifted().collect();
                (loading.amplitude, self.pressed_to_stick(gross, loading, &lifted, level, &mut borne))
            }
            false => self.sticking(gross, loading, force, &mut borne),
        };
        let level = amplitude / per_depth;
        let is_held = stick.as_ref().is_some_and(|stick| stick.within.is_empty());
        let as_pressed = plain && !is_held;
        let carried = if as_pressed { whole.elastic.clone() } else { mesh.profile(&borne) };
        // Of the springs but for those that stick.
        let sum = |value: &dyn Fn(f64, f64) -> f64| -> f64 {
            let all = borne.iter().zip(mesh.load_weights());
            let stuck = stick.iter().flat_map(|stick| &stick.within);
            all.map(|(b, weight)| value(*weight, *b)).sum::<f64>()
                - stuck.map(|[_, weight, b]| value(*weight, *b)).sum::<f64>()
        };
        let scale = 4.0 * per_depth * force;
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
            let bearing = self.bearing_in(loading);
            let load = Mat::from_fn(mesh.inner(), 1, |i, _| bearing.of(compression[i], lift));
            self.pressed(gross, loading, compression, whole, &load)
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

    /// The springs that are pressed so hard under a held normal force, as the ground around them wears, that they stick again, if there are any.
    ///
    /// # Arguments
    /// * `level` -- `M U/μ`, m, which those that stick bear
    /// * `borne` -- `b`, m; on return what springs of a ring bear as they stick
    fn pressed_to_stick(
        &self,
        gross: &Gross,
        loading: &CycleLoading,
        compression: &[f64],
        level: f64,
        borne: &mut [f64],
    ) -> Option<Stick> {
        let (mesh, ratio) = (&gross.mesh, self.contact.half_space().stiffness_ratio());
        let sticking = loading.slip_compression(ratio) - loading.lift;
        let end = mesh.last_above(compression, sticking)?;
        let fraction = disc_that_sticks(mesh, &*loading.friction, compression, sticking, end);
        if fraction == mesh.fraction(end) {
            return Some(Stick { fraction, part: 1.0, within: mesh.up_to(end, borne).ok()? });
        }
        borne.iter_mut().zip(compression).filter(|(_, q)| **q > sticking).for_each(|(b, _)| *b = level);
        Some(Stick { fraction, part: 1.0, within: vec![] })
    }

    /// The amplitude, m, and the springs that stick under a balance of forces, or in a block that moves them less far: each bears `M U`, and so the polynomials
    /// through the nodes do.
    ///
    /// # Arguments
    /// * `force` -- `μ c_N A^ν`, N, over the sum of the springs
    /// * `borne` -- `b`, m; what springs bear on return
    fn sticking(
        &self,
        gross: &Gross,
        loading: &CycleLoading,
        force: f64,
        borne: &mut [f64],
    ) -> (f64, Option<Stick>) {
        let (mesh, [by_force, _]) = (&gross.mesh, loading.control.factors());
        let per_depth =
            loading.friction.reference_coefficient() / self.contact.half_space().stiffness_ratio();
        let by_force = by_force * force;
        let sliding = loading.amplitude - by_force * mesh.load(borne);
        if borne.iter().all(|b| *b <= sliding / per_depth) {
            return (sliding, None);
        }
        let stuck = |level: f64| {
            let end = mesh.last_above(borne, level)?;
            let part = smooth_step(mesh.fraction(end) / LAST_STICK - 1.0);
            let fraction = disc_that_sticks(mesh, &*loading.friction, borne, level, end);
            Some(Stick { fraction, part, within: vec![] })
        };
        let held = |level: f64, stick: Option<&Stick>| -> Vec<f64> {
            let part = stick.map_or(0.0, |stick| stick.part);
            borne.iter().map(|b| b - part * (b - level).max(0.0)).collect()
        };
        let excess = |amplitude: f64| {
            let level = amplitude / per_depth;
            amplitude + by_force * mesh.load(&held(level, stuck(level).as_ref())) - loading.amplitude
        };
        let amplitude = match by_force > 0.0 && excess(sliding.max(0.0)) < 0.0 {
            true => bracketed(excess, sliding.max(0.0), loading.amplitude, 0.0).unwrap_or(f64::NAN),
            false => sliding,
        };
        let level = amplitude / per_depth;
        let stick = stuck(level);
        let held = held(level, stick.as_ref());
        borne.copy_from_slice(&held);
        (amplitude, stick)
    }

    /// Along a path.
    fn sliding_on_path(
        &self,
        gross: &Gross,
        loading: &CycleLoading,
        motion: &Motion,
        compression: &[f64],
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
        let last = match tells_rings(mesh, &*loading.friction) {
            true => (0..mesh.inner()).take_while(sticks).last(),
            false => (0..mesh.inner()).rev().find(sticks),
        };
        let slip: Vec<Vec<f64>> = (0..motion.free.len()).map(column).collect();
        // Along a line: what a kink in the slip of one step makes of that elsewhere cancels over the steps, by its sign.
        let direction = (components == 1).then(|| directions(motion, mesh.profile_weights(), &motion.slip));
        let along = |i: usize, one: usize, other: usize| -> f64 {
            (0..components)
                .map(|axis| slip[components * one + axis][i] * slip[components * other + axis][i])
                .sum()
        };
        let mut path = Mat::from_fn(mesh.inner(), motion.steps(), |i, step| match &direction {
            Some(direction) => slip[step][i] * direction[(i, step)],
            None => {
                let path = along(i, step, step).sqrt();
                let against = motion.paired && along(i, step, step) + along(i, step, step ^ 1) < 0.0;
                if against { -path } else { path }
            }
        });
        clear_negative(&mut path);
        let pressure = self.pressed(gross, loading, compression, whole, &motion.load);
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

    /// Pressure, Pa, of what the springs bear, by step.
    ///
    /// # Arguments
    /// * `load` -- what they bear, m, by step
    fn pressed(
        &self,
        gross: &Gross,
        loading: &CycleLoading,
        compression: &[f64],
        whole: &Whole,
        load: &Mat<f64>,
    ) -> Mat<f64> {
        let steps = load.ncols();
        // On a level path springs touch nowhere within a step, and a kink stays where it is.
        let changes = loading.path.as_ref().map_or(loading.lift == 0.0, |path| !path.is_level());
        let mut pressure = match &gross.touching {
            Some(touching) if changes => {
                let bearing = self.bearing_in(loading);
                let lifts: Vec<f64> = match &loading.path {
                    Some(path) => (0..=steps).map(|m| path.points[m % path.points.len()].lift).collect(),
                    None => vec![loading.lift; steps + 1],
                };
                match bearing.in_proportion() {
                    Some(factor) => {
                        let ends = lifts.windows(2).map(|ends| self.apart([ends[0], ends[1]]));
                        let pressure = touching.pressure_in_proportion(compression, ends);
                        pressure * Scale(factor)
                    }
                    None => touching.pressure(compression, steps, |q, slopes| {
                        self.mean_slopes(|lift| bearing.of(q, lift), &lifts, slopes);
                    }),
                }
            }
            _ => {
                let columns: Vec<Vec<f64>> =
                    (0..steps).map(|m| gross.mesh.pressure(load.col_as_slice(m))).collect();
                Mat::from_fn(load.nrows(), steps, |i, m| columns[m][i])
            }
        };
        pressure *= Scale(self.gross_pressure_scale(whole.area));
        pressure
    }
}
