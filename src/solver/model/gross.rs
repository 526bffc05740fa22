//! Gross slip: every spring slips, from the axis to the contact edge, on a mesh fitted to that edge and moving with it.
//!
//! With the compressions `q` at fixed fractions `ξ` of the contact's area `A = a²`, the displacement of the surface `u = F q` and its profile
//! `f = d - u` depend on `ξ` alone. At a fixed radius `∂f/∂N` is the depth `W` worn in a cycle, so that on the moving mesh
//!
//! ```text
//! d' - F q' + (A'/A) ξ ∂u/∂ξ = W(p, s),     s = (μ_f/M) (q_c - u),     q_c = M U/μ_f  under Coulomb's law
//! d - u(a) = f_0(a),     F_N = c_N A^ν ∫_0^1 ξ^(ν-1) q dξ  or  d held
//! ```
//!
//! The last two give `A` and `d` by the compressions, and their rates with those of the compressions: an ordinary differential equation.
//!
//! Under a held force next to the transition the axis may be pressed so hard, as the ground around it wears, that springs stick there again. Then
//! `q_c - u` is the transform of `(q_c - q)₊`, zero within the stick radius.

mod cycle;
mod ground;
mod hand_over;
mod held_again;

use std::f64::consts::PI;

use super::moving::{follows_held_force, height_of_last_core, slides_on_rig};
use ground::pressed_on;
use hand_over::{BEGINS_BELOW, is_followed_in_blocks};

use super::schedule::{AmplitudeControl, CycleLoading, Schedule};
use super::whole::{LEAST_STICK, LEAST_STICK_LATER, carries, is_smooth, slides_on, spares_edge};
use super::worn_ground::Surroundings;
use super::{CycleFields, Fields, Model, RadialFields, SpringMesh, State, StickZone};
use crate::contact::InitialContact;
use crate::contact::transforms::Transforms;
use crate::error::{Error, Result};
use crate::numerics::linear::{dot, largest_magnitude};
use crate::numerics::roots::next_to;
use crate::numerics::whole_contact::{Touching, WholeContact};

/// Radii of the output within the first contact, evenly spaced, and beyond, in constant ratio.
const SHOWN: [usize; 2] = [64, 128];

/// The mesh of a contact in gross slip.
#[derive(Debug, Clone)]
pub struct Gross {
    mesh: WholeContact,
    /// Where what wears goes to nothing at the contact edge faster than the compression of its springs does. Springs that the mesh takes out of contact there wear back.
    touching: Option<Touching>,
    /// `A^ν ∫ ξ^(ν-1) q dξ`, m^(2+k), of the first contact, where the force is held.
    held_load: Option<f64>,
    /// The same of the first contact in any case.
    first_load: f64,
    /// Its `A`, m², and compressions, m.
    first: (f64, Vec<f64>),
    /// `F⁻¹ 1` at the inner nodes.
    lifted: Vec<f64>,
    /// Whether springs stick in some cycles, as the unworn contact tells.
    sticks: bool,
}

/// A contact in gross slip.
#[derive(Debug, Clone)]
struct Whole {
    area: f64,
    indentation: f64,
    /// `F q`, m, at all nodes.
    elastic: Vec<f64>,
    /// Pressure, Pa, at the inner nodes.
    pressure: Vec<f64>,
}

/// Rates per cycle of a contact in gross slip.
#[derive(Debug)]
pub struct GrossRates {
    /// Of the compressions, m, shape `(springs - 1,)`.
    pub compression: Vec<f64>,
    /// Energy that friction dissipates, J.
    pub dissipation: f64,
    /// Worn volume, m³.
    pub volume: f64,
    /// Radius within which springs stick, m.
    pub stick_radius: f64,
}

impl Gross {
    /// Whether a contact is on the mesh of gross slip, whatever sticks in other cycles: all of it slides in some cycle of the run on the unworn contact, at the largest
    /// indentation.
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if cycles to and fro are resolved, where each spring slips by a formula; those of the force of the first cycle.
    pub fn follows(contact: &InitialContact, schedule: &Schedule) -> Result<bool> {
        if !carries(contact, schedule) || Slides::of(contact, schedule)? == Slides::Never {
            return Ok(false);
        }
        if schedule.resolves() && schedule.conditions().mode.is_tangential() {
            return Err(Error::Inconsistent {
                what: "numerics.cycle",
                why: format!(
                    "\"resolved\" has nothing to find at an amplitude of {:e} m: the whole contact slides to and fro, and a spring of compression q \
                     slips by U - μ_f q/M each way, which the formula has exactly; leave it out",
                    contact.amplitude()
                ),
            });
        }
        Ok(true)
    }

    /// The blocks in partial slip before the first of gross slip, and the contact under them, where a mesh that begins at their edge of stick carries them and the run is handed over
    /// then; none elsewhere.
    ///
    /// # Errors
    /// Those of [`Schedule::before_gross_slip`].
    pub fn before(
        contact: &InitialContact,
        schedule: &Schedule,
    ) -> Result<Option<(InitialContact, Schedule)>> {
        // Under a held normal force the contact grows, and springs may stick in a block that would have slid as a whole.
        if schedule.conditions().holds_normal_force || !is_followed_in_blocks(schedule) {
            return Ok(None);
        }
        let nearly = contact.equivalent_profile().value(LEAST_STICK_LATER * contact.contact_radius());
        schedule.before_gross_slip(contact, contact.indentation() - nearly)
    }

    /// Whether polynomials over the whole contact carry what happens in it, before the mesh is made; else cubics do.
    pub fn is_smooth(contact: &InitialContact, schedule: &Schedule) -> bool {
        is_smooth(contact, schedule)
    }

    pub(super) fn new(contact: &InitialContact, schedule: &Schedule, springs: usize) -> Result<Self> {
        let grading = contact.half_space().grading();
        let mesh = match is_smooth(contact, schedule) {
            true => WholeContact::new(grading, springs - 1)?,
            false => WholeContact::on_cubics(grading, springs - 1)?,
        };
        let (radius, first) = unworn(contact, &mesh);
        let first_load = radius.powf(1.0 + grading) * mesh.load(&first);
        let mut lifted = vec![1.0; mesh.inner()];
        mesh.solve_profile(&mut lifted);
        let held_load = schedule.conditions().holds_normal_force.then_some(first_load);
        let sticks = Slides::of(contact, schedule)? == Slides::InSomeCycles;
        let touching = spares_edge(contact, schedule, sticks).then(|| Touching::new(&mesh)).transpose()?;
        Ok(Self { mesh, touching, held_load, first_load, first: (radius * radius, first), lifted, sticks })
    }

    pub(super) fn springs(&self) -> usize {
        self.mesh.inner() + 1
    }

    /// Whether cubics carry what happens in the contact; else polynomials over all of it do.
    pub fn is_on_cubics(&self) -> bool {
        self.mesh.is_local()
    }

    /// Whether loads are asked for between the nodes as well.
    pub fn asks_between_nodes(&self) -> bool {
        self.touching.is_some()
    }

    /// Whether springs stick in some cycles, as the unworn contact tells, so that there is a kink where they begin to slip.
    pub fn sticks(&self) -> bool {
        self.sticks
    }

    /// Whether they do, before the mesh is made.
    pub fn would_stick(contact: &InitialContact, schedule: &Schedule) -> bool {
        Slides::of(contact, schedule).is_ok_and(|slides| slides == Slides::InSomeCycles)
    }

    /// Whether the normal force is held, so that wear never ends.
    pub fn holds_force(&self) -> bool {
        self.held_load.is_some()
    }
}

/// In which cycles all of an unworn contact slides, at the largest indentation of the run.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Slides {
    Never,
    InSomeCycles,
    Always,
}

impl Slides {
    /// # Errors
    /// Those of the force of the first cycle.
    fn of(contact: &InitialContact, schedule: &Schedule) -> Result<Self> {
        let (depth, ratio) = (schedule.largest_indentation(), contact.half_space().stiffness_ratio());
        let conditions = schedule.conditions();
        // Springs that hardly stick do so soon after under a held normal force, and an edge that is followed from there has no time to settle in.
        let least = match conditions.holds_normal_force && !schedule.keeps_slipping_alike() {
            true => BEGINS_BELOW,
            false if schedule.is_uniform() => 0.0,
            false => LEAST_STICK,
        };
        let radius = schedule.largest_first_radius(contact)?;
        let nearly_at = |least: f64| contact.equivalent_profile().value(least * radius);
        let (nearly, later) = (nearly_at(least), nearly_at(least.max(LEAST_STICK_LATER)));
        let slides = |loading: &CycleLoading, nearly: f64| match loading.control {
            AmplitudeControl::Displacement => Ok(loading.slip_compression(ratio) >= depth - nearly),
            AmplitudeControl::Force(_) => Ok(false),
            AmplitudeControl::Rig(_) => slides_on_rig(contact, loading, depth - height_of_last_core(contact)),
        };
        let on_rig = conditions.tangential_control.is_rig();
        if on_rig && !schedule.follows_balance() {
            return Ok(Self::Never);
        }
        let plain = conditions.friction.coefficient().is_some() && is_smooth(contact, schedule);
        // The edge of stick is followed until the last springs give way, and where polynomials would not carry what a rig does at first.
        let followed = plain && schedule.keeps_friction() && slides_on(contact, schedule);
        if on_rig && followed && !slides(&schedule.first_slip(), nearly)? {
            return Ok(Self::Never);
        }
        let [mut some, mut all] = [false, true];
        if on_rig && !follows_held_force(schedule, contact)? {
            some = schedule.largest_slip_compression(contact)? >= depth - nearly;
        }
        let grows = schedule.slips_otherwise_between_blocks() && !slides(&schedule.first_slip(), later)?;
        let nearly = if grows { later } else { nearly };
        let handed_over = is_followed_in_blocks(schedule);
        for loading in schedule.extremes() {
            some |= slides(&loading, nearly)?;
            all &= handed_over || slides(&loading, 0.0)?;
        }
        if handed_over {
            for loading in schedule.extremes_before_shrinking() {
                all &= slides(&loading, 0.0)?;
            }
        }
        // Under a balance of forces it is the past of each spring that decides which of them stick.
        let by_past = on_rig && conditions.friction.remembers_slip();
        Ok(match some {
            true if all => Self::Always,
            true if by_past => Self::Never,
            true => Self::InSomeCycles,
            false => Self::Never,
        })
    }
}

/// Radius of the first contact, m, and `q_0 = g_0(a_0) - g_0` inside it, m, to full relative accuracy at its edge as well; on cubics those of which the surface is the unworn profile at
/// all nodes, so that what wears at first is not less than what they are off by.
fn unworn(contact: &InitialContact, mesh: &WholeContact) -> (f64, Vec<f64>) {
    let (profile, edge) = (contact.equivalent_profile(), contact.contact_radius());
    if !mesh.is_local() {
        return (
            edge,
            mesh.distances().map(|distance| -profile.rise(edge, -edge * edge * distance)).collect(),
        );
    }
    let height = |radius: f64| contact.indentation() - contact.indenter().profile(radius);
    let radius = next_to(|radius| pressed_on(mesh, radius, height).1, edge);
    (radius, pressed_on(mesh, radius, height).0)
}

impl Model {
    /// The mesh of gross slip, where the contact is in gross slip and that is followed on a mesh of its own.
    pub fn gross(&self) -> Option<&Gross> {
        match &self.mesh {
            SpringMesh::Annulus(_) => None,
            SpringMesh::Whole(gross) => Some(gross),
        }
    }

    /// [`Model::offsets`] of a contact that grows to a radius, m.
    pub fn gross_offsets(&self, last: f64) -> Vec<f64> {
        let [within, beyond] = SHOWN;
        let first = self.contact.contact_radius();
        let ratio = (last / first).max(1.0).ln() / beyond as f64;
        let inside = (1..=within).map(|i| first * i as f64 / within as f64);
        let outside = (1..=beyond).map(|i| first * (ratio * i as f64).exp());
        let core = self.stick_zone.stick_area;
        inside.chain(outside.filter(|r| *r > first)).map(|r| r * r - core).collect()
    }

    pub(super) fn gross_initial_state(&self, gross: &Gross) -> Result<State> {
        let (slip_area, compression) = gross.first.clone();
        let first = State {
            slip_area,
            compression_rate: vec![0.0; compression.len()],
            compression,
            least_stick_radius: f64::INFINITY,
            ..State::default()
        };
        self.in_block_of(first)
    }

    /// Everything that follows from the compressions; none where no contact has them.
    fn whole(&self, gross: &Gross, around: &Surroundings, compression: &[f64]) -> Option<Whole> {
        let (half_space, mesh) = (self.contact.half_space(), &gross.mesh);
        let nu = 0.5 * (1.0 + half_space.grading());
        let elastic = mesh.profile(compression);
        let at_edge = elastic[mesh.inner()];
        let (area, indentation) = match gross.held_load {
            Some(load) => {
                let area = (load / mesh.load(compression)).powf(nu.recip());
                (area, around.profile(area.sqrt()) + at_edge)
            }
            None => {
                let held = around.indentation;
                (around.radius_at_height(held - at_edge).powi(2), held)
            }
        };
        // A load that is held presses.
        let pressed = gross.held_load.is_none() || mesh.load(compression) > 0.0;
        if !(pressed && area > 0.0 && area.is_finite() && indentation.is_finite()) {
            return None;
        }
        let scale = self.gross_pressure_scale(area);
        let pressure = mesh.pressure(compression).into_iter().map(|p| scale * p).collect();
        Some(Whole { area, indentation, elastic, pressure })
    }

    /// `c_N A^(ν-1)`, Pa/m.
    fn gross_pressure_scale(&self, area: f64) -> f64 {
        self.contact.half_space().normal_stiffness() * area.powf(-self.mu())
    }

    /// Rates of the compressions, and what a cycle does; none where no contact has them.
    pub fn gross_rates(
        &self,
        gross: &Gross,
        loading: &CycleLoading,
        around: &Surroundings,
        compression: &[f64],
    ) -> Option<GrossRates> {
        let mesh = &gross.mesh;
        let whole = self.whole(gross, around, compression)?;
        let (depth, cycle) = self.gross_mean_wear(gross, loading, compression, &whole);
        // q' = d' F⁻¹ 1 + (A'/A) F⁻¹ ξ ∂u/∂ξ - F⁻¹ W, with A'/A and d' from the edge and the force.
        let carried = mesh.dilation(compression, &whole.elastic);
        let mut worn = depth;
        mesh.solve_profile(&mut worn);
        let radius = whole.area.sqrt();
        let rise = 0.5 * radius * around.slope(radius);
        let edge = [&gross.lifted, &carried, &worn].map(|part| mesh.profile_at_edge(part));
        let (growth, sinking) = match gross.held_load {
            Some(_) => {
                let loads = [&gross.lifted, &carried, &worn].map(|part| mesh.load(part));
                let nu = 1.0 - self.mu();
                let matrix =
                    [[-rise - edge[1], 1.0 - edge[0]], [loads[1] + nu * mesh.load(compression), loads[0]]];
                let determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0];
                let [first, second] = [-edge[2], loads[2]];
                (
                    (first * matrix[1][1] - matrix[0][1] * second) / determinant,
                    (matrix[0][0] * second - matrix[1][0] * first) / determinant,
                )
            }
            None => (edge[2] / around.kept_apart(rise + edge[1], rise), 0.0),
        };
        let parts = gross.lifted.iter().zip(&carried).zip(&worn);
        let rates: Vec<f64> =
            parts.map(|((lifted, carried), worn)| sinking * lifted + growth * carried - worn).collect();
        rates.iter().all(|rate| rate.is_finite()).then_some(GrossRates {
            compression: rates,
            dissipation: cycle.dissipation,
            volume: cycle.volume,
            stick_radius: cycle.stick_radius,
        })
    }

    /// Squared contact radius, m², of compressions, m.
    ///
    /// # Errors
    /// [`Error::NotConverged`] where the profile ends before.
    pub fn gross_area(&self, gross: &Gross, around: &Surroundings, compression: &[f64]) -> Result<f64> {
        self.whole(gross, around, compression).map(|whole| whole.area).ok_or_else(|| Error::NotConverged {
            what: "contact edge",
            why: "the contact has grown to where the profile of the indenter ends".into(),
        })
    }

    /// The same of a state.
    ///
    /// # Errors
    /// As [`Model::gross_area`].
    pub fn gross_area_in(&self, gross: &Gross, state: &State) -> Result<f64> {
        self.gross_area(gross, &self.surroundings(state.ground.as_deref()), &state.compression)
    }

    /// Wear depth at all nodes, m.
    fn gross_depth(&self, gross: &Gross, whole: &Whole) -> Vec<f64> {
        let unworn = |fraction: &f64| self.contact.indenter().profile((whole.area * fraction).sqrt());
        let nodes = whole.elastic.iter().zip(gross.mesh.fractions());
        nodes.map(|(u, fraction)| whole.indentation - u - unworn(fraction)).collect()
    }

    pub(super) fn gross_fields(&self, gross: &Gross, state: &State) -> Fields {
        let around = self.surroundings(state.ground.as_deref());
        let Some(whole) = self.whole(gross, &around, &state.compression) else { return Fields::default() };
        Fields {
            stick_zone: StickZone {
                slip_compression: self.contact.slip_compression(),
                ..StickZone::default()
            },
            slip_area: whole.area,
            wear_depth: self.gross_depth(gross, &whole),
            elastic_depth: whole.elastic,
            pressure: whole.pressure,
            density: state.compression.clone(),
            ground: state.ground.clone(),
            ..Fields::default()
        }
    }

    pub(super) fn gross_cycle(
        &self,
        gross: &Gross,
        loading: &CycleLoading,
        compression: &[f64],
        fields: &Fields,
    ) -> CycleFields {
        let around = self.surroundings(fields.ground.as_deref());
        self.whole(gross, &around, compression)
            .map_or_else(CycleFields::default, |whole| self.gross_wear(gross, loading, compression, &whole).1)
    }

    pub(super) fn gross_depth_at(&self, gross: &Gross, fields: &Fields, squared: f64) -> f64 {
        let fraction = squared / fields.slip_area;
        if fraction < 1.0 {
            gross.mesh.value(&fields.wear_depth, gross.mesh.coordinate(fraction))
        } else {
            self.surroundings(fields.ground.as_deref()).worn(squared)
        }
    }

    pub(super) fn gross_volume(&self, gross: &Gross, fields: &Fields) -> f64 {
        PI * fields.slip_area * gross.mesh.area(&fields.wear_depth) + self.volume_around(fields)
    }

    pub(super) fn gross_normal_force(&self, gross: &Gross, fields: &Fields) -> f64 {
        self.contact.normal_force() * self.gross_sum(gross, fields, &fields.density) / gross.first_load
    }

    pub(super) fn gross_indentation(&self, gross: &Gross, state: &State) -> f64 {
        let around = self.surroundings(state.ground.as_deref());
        self.whole(gross, &around, &state.compression).map_or(f64::NAN, |whole| whole.indentation)
    }

    /// Sum of something over the springs, `2 ∫_0^a x^k value(q) dx`.
    pub(super) fn gross_sum(&self, gross: &Gross, fields: &Fields, values: &[f64]) -> f64 {
        fields.slip_area.powf(1.0 - self.mu()) * dot(gross.mesh.load_weights(), values)
    }

    /// Weights of such a sum over the springs of the mesh.
    pub(super) fn spring_weights(&self, fields: &Fields) -> Vec<f64> {
        match self.gross() {
            Some(gross) => {
                let scale = fields.slip_area.powf(1.0 - self.mu());
                gross.mesh.load_weights().iter().map(|weight| scale * weight).collect()
            }
            None => {
                let springs = self.annulus().operators.abel.spring_sum().iter().zip(&fields.density_factor);
                springs.map(|(weight, factor)| fields.slip_area * weight * factor).collect()
            }
        }
    }

    /// What errors of the compressions in gross slip, m, are relative to: under a held force, under which wear goes on without end, the largest; else the indentation, which is
    /// as deep as anything wears.
    pub(crate) fn gross_error_scale(&self, gross: &Gross, compression: &[f64]) -> f64 {
        if gross.holds_force() { largest_magnitude(compression) } else { self.contact.indentation() }
    }

    /// Transforms for the pressure of a state where the polynomials do not have it: the first contact below `k = 0`, by which they are chosen, as `q ~ 1-ξ` at its edge is none of
    /// them. It becomes one within the first wear.
    fn beside_polynomials(&self, state: &State) -> Option<Transforms> {
        let grading = self.contact.half_space().grading();
        (state.cycles == 0.0 && grading < 0.0).then(|| Transforms::new(grading, &[]).ok()).flatten()
    }

    /// Pressure, Pa, of the first contact at a radius, m; none where the transform does not converge.
    fn unworn_pressure(&self, transforms: &Transforms, radius: f64) -> Option<f64> {
        let (profile, edge) = (self.contact.equivalent_profile(), self.contact.contact_radius());
        let pressure = transforms.pressure(|x| profile.derivative(x), radius, edge).ok()?;
        Some(self.contact.half_space().normal_stiffness() * pressure)
    }

    pub(super) fn gross_radial_fields(&self, gross: &Gross, state: &State) -> RadialFields {
        let offsets = self.output.offsets();
        let [mut wear_depth, mut pressure, mut slip] = [(); 3].map(|()| vec![0.0; offsets.len()]);
        let around = self.surroundings(state.ground.as_deref());
        if let Some(whole) = self.whole(gross, &around, &state.compression) {
            let mesh = &gross.mesh;
            let loading = self.loading_in(state, self.schedule.loading_in_block(state.cycles, state.cycles));
            let (_, cycle, sliding) = self.gross_wear(gross, &loading, &state.compression, &whole);
            let transforms = self.beside_polynomials(state);
            let depth = self.gross_depth(gross, &whole);
            for (i, squared) in offsets.iter().enumerate() {
                if *squared >= whole.area {
                    wear_depth[i] = around.worn(*squared);
                    continue;
                }
                let coordinate = mesh.coordinate(squared / whole.area);
                wear_depth[i] = mesh.value(&depth, coordinate).max(0.0);
                let first = transforms.as_ref().and_then(|it| self.unworn_pressure(it, squared.sqrt()));
                let pressed = first.unwrap_or_else(|| mesh.value_inside(&whole.pressure, coordinate));
                // What the mesh takes out of contact is so by its error only.
                pressure[i] = if gross.touching.is_some() { pressed.max(0.0) } else { pressed };
                slip[i] = sliding.slip_at(mesh, &cycle, coordinate).max(0.0);
            }
        }
        RadialFields { wear_depth, pressure, slip }
    }
}
