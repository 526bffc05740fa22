//! An edge of stick that moves, and the mesh that begins there.
//!
//! `G = d - q_c` is the height of the equivalent profile at the edge of stick, `C = c²`, `S = F_c(q_c - q)` the slip depth from there on and
//! `S_0` that of the unworn profile with the same edge. At a fixed radius
//!
//! ```text
//! ∂S/∂N = W - G' Φ,    ∂S_0/∂N = -G_0' Φ,    Φ = F_c 1,    G_0 = g_0(c)
//! ```
//!
//! since the integrand is zero at the edge and the ground within it at rest. So for `λ = ln(S/S_0)` on the moving springs
//!
//! ```text
//! dλ/dN = W/S + (Φ/S_0) (G_0' - G' e^(-λ)) + (∂λ/∂ξ) (C' + ξ Z')/Z
//! ```
//!
//! An edge that moves inwards comes upon unworn ground, `G = g_0(c)` and `λ = 0` there. One that moves outwards leaves worn ground behind,
//! and `λ` stays finite: `g_0'(c) c' = G' e^(-λ)`. Where nothing wears, `S` is `S_0` less what was left behind,
//! `K' = -(G' - G_0') Φ`, which the contact edge needs to know: there `S = S_0 + K`.

mod at_rest;
mod both_forces;
mod breakaway;
mod causes;
mod jump;
mod near_edge;
mod stage;

use std::f64::consts::PI;

use super::schedule::{AmplitudeControl, CycleLoading, Schedule};
use super::{Fields, Model, SpringMesh, State, StickZone};
use crate::contact::InitialContact;
use crate::contact::indenter::EquivalentProfile;
use crate::error::{Error, Result};
use crate::laws::history::History;
use crate::laws::loading::TangentialControl;
use crate::numerics::grid::{Clustering, Mesh};
use crate::numerics::roots::bracketed;
use crate::solver::model::whole::slides_on;
pub use both_forces::Bearing;
use causes::at_one_indentation;
pub(super) use causes::check_friction;
use near_edge::NearEdge;
pub use stage::{StickStage, StickTarget, StickTrial};

/// Radii at which what was left behind is known, for interpolation over where the contact edge can be.
const STATIONS: usize = 24;

/// Steps in the search for the first balance of forces where the force may fall as the displacement grows.
const FIRST_BALANCE: usize = 200;

/// Slope of the strength of friction by the compression, over the strength per compression, below which an edge that jumps between blocks is not followed: at 0.5 such runs
/// came to no end (docs/extremes.md), from 0.7 up they do.
const LEAST_EVENNESS: f64 = 0.6;

/// Part of what a balance of forces asks for that is rounding.
const SAME_BALANCE: f64 = 1e-12;

/// Area of stick, over that of the core of the mesh, below which it is taken for lost.
const LOST: f64 = 4.0;

/// The same below which it is lost where no step leads on.
const NEARLY_LOST: f64 = 10.0;

/// Area of stick over that of the contact below which it is lost as well, where no step leads on, once what is left of it would last for so small a part of the
/// cycles before: under friction that depends on the load the contact gives way earlier.
const SMALL: f64 = 0.05;
const AT_ONCE: f64 = 1e-3;

/// Radius, over that of the contact, of the core of a mesh that follows an edge of stick that recedes until none is left: stick is lost within 1e-3 of the time when it is as small as that.
pub(super) const LAST_CORE: f64 = 0.02;

/// What moves the edge of stick.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Cause {
    /// The coefficient of friction changes.
    Friction,
    /// This normal force, N, is held.
    NormalForce(f64),
    /// The tangential amplitude follows from a balance of forces.
    Tangential,
    /// This normal force, N, and the tangential amplitude of force are held: the edge stays, `q_c = d - g_0(c)` grows, the amplitude with it. So it is
    /// on a rig where springs remember their slip, and where the displacement is held, which stays.
    BothForces(f64),
    /// The same while friction falls: the edge recedes to where unworn ground alone bears `F_N - F_x/μ`, see [`held_stick_radius`].
    ReleasedForces(f64),
    /// This normal force, N, is held, and the tangential amplitude follows from a balance of forces: height and compression at the edge are both
    /// solved for, see [`Model::bearing`].
    TwoBalances(f64),
}

impl Cause {
    /// The normal force that is held, N.
    fn normal_force(self) -> Option<f64> {
        match self {
            Self::NormalForce(force)
            | Self::BothForces(force)
            | Self::ReleasedForces(force)
            | Self::TwoBalances(force) => Some(force),
            Self::Friction | Self::Tangential => None,
        }
    }
}

/// How the edge of stick moves.
#[derive(Debug, Clone)]
pub struct MovingStick {
    cause: Cause,
    /// Whether it moves outwards and leaves worn ground behind.
    outwards: bool,
    /// Whether it does so between blocks only.
    jumps: bool,
    /// Whether it may turn: `outwards` is where it is first taken to move.
    turns: bool,
    /// Whether it jumps between blocks besides.
    in_blocks: bool,
    /// Whether the compression there is kept besides: it is solved for, or changes under a held normal force.
    keeps: bool,
    /// Logarithms of the squares of the first and last radius of the stations.
    span: [f64; 2],
    /// Where the stations are on that interval, from 0 to 1, and their weights in interpolation but for the sign.
    places: Vec<[f64; 2]>,
    /// How what is given at the springs is seen next to the edge.
    near_edge: NearEdge,
}

/// The edge of stick, in a state.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StickEdge {
    /// `C = c²`, m².
    pub area: f64,
    /// `G`, m.
    pub depth: f64,
    /// `∫_0^c x^k q dx`, m^(2+k).
    pub load: f64,
    /// Slip depth left behind, `K`, m, at the stations; empty where the edge moves inwards.
    pub left_behind: Vec<f64>,
    /// Wear depth at the radii of the output, m; empty where the edge moves inwards.
    pub wear_depth: Vec<f64>,
    /// Squared radii, m², increasing to the edge of stick, between which the ground that jumps of the edge left at rest is known; and by how much
    /// wear has raised the equivalent profile there, m. Empty where none was left.
    pub places_at_rest: Vec<f64>,
    /// See [`StickEdge::places_at_rest`].
    pub raised_at_rest: Vec<f64>,
    /// `q_c`, m, where it is solved for beside the depth; else zero.
    pub slip_compression: f64,
    /// Mean rates of area, m², depth and that compression, m, per cycle in the last step.
    pub rates: [f64; 3],
}

impl MovingStick {
    /// Whether it may come over worn ground under both forces or a rig beside a normal one, so that the end depends on the way there.
    pub fn passes_worn_ground(&self) -> bool {
        matches!(self.cause, Cause::TwoBalances(_))
    }

    /// A compression at the edge, m, where it is kept; else zero.
    pub(super) fn kept(&self, compression: f64) -> f64 {
        if self.keeps { compression } else { 0.0 }
    }

    /// Whether it may leave worn ground behind.
    pub(super) fn leaves_ground(&self) -> bool {
        self.outwards || self.turns
    }

    /// The contact with the largest indentation that can come, of which the limit bounds where wear can reach.
    ///
    /// Under a held force the unworn stick zone alone would bear it there.
    pub(super) fn farthest(&self, contact: &InitialContact) -> Result<InitialContact> {
        match self.cause {
            Cause::NormalForce(_)
            | Cause::BothForces(_)
            | Cause::ReleasedForces(_)
            | Cause::TwoBalances(_) => Ok(contact.under_held_forces()?.unwrap_or_else(|| contact.clone())),
            _ => Ok(contact.clone()),
        }
    }

    /// The mesh to use, where `asked` is the one for an edge of stick that rests.
    pub(super) fn clustering(&self, asked: Clustering, slip_exponent: f64) -> Clustering {
        match self.cause {
            _ if self.rests() => asked,
            _ if self.recedes() => Clustering::RecedingStick,
            _ if slip_exponent < 1.0 => Clustering::CreepingStickCoarse,
            _ => Clustering::CreepingStick,
        }
    }

    /// Whether the edge moves inwards, upon unworn ground.
    pub fn recedes(&self) -> bool {
        !self.leaves_ground() && !self.rests()
    }

    /// Whether the tangential amplitude follows from a balance of forces at the indentation that is held.
    pub fn is_balanced(&self) -> bool {
        self.cause == Cause::Tangential
    }

    /// Whether the edge moves outwards during steps, over worn ground.
    pub(super) fn creeps(&self) -> bool {
        self.leaves_ground() && !self.rests()
    }

    /// Whether it moves since the normal force is held beside the displacement.
    pub fn creeps_under_force(&self) -> bool {
        matches!(self.cause, Cause::NormalForce(_))
    }

    /// Whether the edge moves between blocks only.
    pub(super) fn jumps_between_blocks(&self) -> bool {
        self.jumps
    }

    /// Whether the edge stays where it is during a step.
    fn rests(&self) -> bool {
        self.jumps || self.deepens()
    }

    /// Whether the edge stays while the compression there follows from the normal force, which is then what is solved for in place of the height.
    fn deepens(&self) -> bool {
        matches!(self.cause, Cause::BothForces(_))
    }

    pub(super) fn with_span(mut self, first: f64, last: f64) -> Self {
        self.span = [first.ln(), last.ln()];
        let angle = |j: usize| PI * (j as f64 + 0.5) / STATIONS as f64;
        self.places = (0..STATIONS).map(|j| [0.5 - 0.5 * angle(j).cos(), angle(j).sin()]).collect();
        self
    }

    /// On a mesh, where wear next to the edge goes by a power of the slip.
    pub(super) fn over(mut self, mesh: &Mesh, grading: f64, slip_exponent: f64) -> Self {
        if self.creeps() {
            self.near_edge = NearEdge::new(mesh, grading, slip_exponent);
        }
        self
    }

    /// What was left behind at a squared radius, m², outside the first contact; none within it.
    pub(super) fn left_behind_outside(&self, stick: &StickEdge, squared: f64) -> Option<f64> {
        (self.leaves_ground() && squared >= self.span[0].exp())
            .then(|| self.left_behind(&stick.left_behind, squared))
    }

    /// Squares of the radii of the stations, m².
    pub(super) fn stations(&self) -> impl Iterator<Item = f64> {
        let [first, last] = self.span;
        self.places.iter().map(move |[part, _]| (first + (last - first) * part).exp())
    }

    /// What was left behind at a squared radius, m².
    pub(super) fn left_behind(&self, values: &[f64], squared: f64) -> f64 {
        let [first, last] = self.span;
        let x = (squared.ln() - first) / (last - first);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (j, (value, [part, sine])) in values.iter().zip(&self.places).enumerate() {
            let distance = x - part;
            if distance == 0.0 {
                return *value;
            }
            let weight = if j % 2 == 0 { 1.0 } else { -1.0 } * sine / distance;
            sum += weight * value;
            weights += weight;
        }
        if weights == 0.0 { 0.0 } else { sum / weights }
    }

    /// The edge of stick of the unworn contact.
    pub(super) fn start(&self, model: &Model) -> Result<StickEdge> {
        let profile = model.contact.equivalent_profile();
        let loading = model.schedule.first_slip();
        let compression = match self.cause {
            Cause::BothForces(_) => {
                let radius = model.stick_zone.stick_area.sqrt();
                return Ok(StickEdge {
                    area: model.stick_zone.stick_area,
                    depth: model.stick_zone.slip_compression,
                    load: unworn_load(profile, radius, model.contact.slip_compression()),
                    ..StickEdge::default()
                });
            }
            Cause::Tangential => {
                first_slip_compression(&model.contact, &loading, model.contact.slip_compression())?
            }
            Cause::TwoBalances(_) => {
                first_slip_compression(&model.contact, &loading, model.contact.indentation())?
            }
            _ => loading.slip_compression(model.contact.half_space().stiffness_ratio()),
        };
        let depth = model.contact.indentation() - compression;
        // Under both forces what is solved for is the compression.
        let solved = if matches!(self.cause, Cause::ReleasedForces(_)) { compression } else { depth };
        if depth <= 0.0 {
            return Err(Error::Inconsistent {
                what: "loading.amplitude",
                why: format!(
                    "at an amplitude of {:e} m the whole contact slides in the first cycle under a force that is held; reduce it",
                    loading.amplitude
                ),
            });
        }
        let radius = profile.radius_at(depth)?;
        let load = unworn_load(profile, radius, compression);
        let behind = if self.leaves_ground() { STATIONS } else { 0 };
        let nodes = if self.leaves_ground() { model.output.offsets().len() } else { 0 };
        Ok(StickEdge {
            area: radius * radius,
            depth: solved,
            load,
            left_behind: vec![0.0; behind],
            wear_depth: vec![0.0; nodes],
            places_at_rest: vec![],
            raised_at_rest: vec![],
            slip_compression: self.kept(compression),
            rates: [0.0; 3],
        })
    }
}

/// Whether the edge of stick is followed under a balance of tangential forces: springs are to move with it, there is one at first, blocks differ by their amplitudes alone, and where they do friction does
/// not fall too steeply with the load.
///
/// # Errors
/// As [`slides_at_once`].
pub(super) fn follows_held_force(schedule: &Schedule, contact: &InitialContact) -> Result<bool> {
    let conditions = schedule.conditions();
    Ok(schedule.follows_balance()
        && conditions.tangential_control != TangentialControl::Displacement
        && !jumps_steeply(schedule, contact)
        && at_one_indentation(conditions)
        && !slides_at_once(schedule, contact)?)
}

/// Whether the edge of stick jumps between blocks at an indentation that is held, under friction that falls too steeply with the load for it to be followed.
pub(super) fn jumps_steeply(schedule: &Schedule, contact: &InitialContact) -> bool {
    let conditions = schedule.conditions();
    let (friction, depth) = (&conditions.friction, contact.indentation());
    let evenness = friction.kinetic_strength_slope(depth) * depth / friction.kinetic_strength(depth);
    !conditions.holds_normal_force && schedule.slips_otherwise_between_blocks() && evenness < LEAST_EVENNESS
}

/// Whether a balance of tangential forces leaves no more stick in the first cycle than the core up to which the edge is followed.
///
/// # Errors
/// As [`EquivalentProfile::radius_at`].
pub(super) fn slides_at_once(schedule: &Schedule, contact: &InitialContact) -> Result<bool> {
    let first = first_to_slide(schedule, contact)?;
    // What slides later on a rig is handed over then.
    Ok(first.is_some_and(|block| block == 0 || !slides_on(contact, schedule)))
}

/// The first block whose balance of tangential forces leaves no more stick on the unworn contact than that core.
///
/// # Errors
/// As [`EquivalentProfile::radius_at`].
fn first_to_slide(schedule: &Schedule, contact: &InitialContact) -> Result<Option<usize>> {
    let ratio = contact.half_space().stiffness_ratio();
    let at_core = contact.indentation() - height_of_last_core(contact);
    for (block, loading) in schedule.first_cycles().enumerate() {
        let slides = match loading.control {
            AmplitudeControl::Displacement => false,
            AmplitudeControl::Force(_) => loading.slip_compression(ratio) >= at_core,
            AmplitudeControl::Rig(_) => slides_on_rig(contact, &loading, at_core)?,
        };
        if slides {
            return Ok(Some(block));
        }
    }
    Ok(None)
}

/// Area of stick, over that of the contact, below which it is taken for lost under a balance of tangential forces.
pub(super) const LAST_STICK: f64 = LOST * LAST_CORE * LAST_CORE;

/// Height of the equivalent profile, m, at the last edge of stick that is followed.
pub(super) fn height_of_last_core(contact: &InitialContact) -> f64 {
    contact.equivalent_profile().value(LAST_STICK.sqrt() * contact.contact_radius())
}

/// Whether springs slip on a rig up to a compression, m, of the unworn contact; those with a memory of their slip may hold it farther out.
///
/// # Errors
/// Those of the force of the first cycle.
pub(super) fn slides_on_rig(
    contact: &InitialContact,
    loading: &CycleLoading,
    compression: f64,
) -> Result<bool> {
    if loading.friction.remembers_slip() && breakaway::holds_at_first(contact, loading)? {
        return Ok(false);
    }
    let amplitude = loading.friction.static_strength(compression) / contact.half_space().stiffness_ratio();
    let force =
        super::first_force::first_force(contact, &*loading.friction, amplitude, contact.indentation())?;
    Ok(loading.excess(force, amplitude) <= 0.0)
}

/// Stick radius, m, under both forces held while the ground within it is unworn; none where stick cannot bear them.
///
/// ```text
/// F_N - F_x/μ_f = 2 c_N ∫_0^c x^k (g_0(c) - g_0(x)) dx
/// ```
pub(super) fn held_stick_radius(
    contact: &InitialContact,
    normal_force: f64,
    loading: &CycleLoading,
) -> Option<f64> {
    let borne = normal_force - loading.asked() / loading.friction.reference_coefficient();
    let profile = contact.equivalent_profile();
    let excess =
        |radius: f64| contact.half_space().normal_stiffness() * profile.load_integral(radius) - borne;
    let edge = contact.contact_radius();
    (borne > 0.0).then(|| bracketed(excess, 1e-9 * edge, edge, 0.0).ok()).flatten()
}

/// `∫_0^c x^k q dx` of unworn ground, m^(2+k).
fn unworn_load(profile: &EquivalentProfile, radius: f64, slip_compression: f64) -> f64 {
    let exponent = 1.0 + profile.grading();
    0.5 * profile.load_integral(radius) + slip_compression * radius.powf(exponent) / exponent
}

impl Model {
    /// How the edge of stick moves, if it does.
    pub fn moving(&self) -> Option<&MovingStick> {
        match &self.mesh {
            SpringMesh::Annulus(annulus) => annulus.moving.as_ref(),
            SpringMesh::Whole(_) => None,
        }
    }

    /// Whether a stick zone that shrinks has come to the core of the mesh, or breaks away before.
    pub fn loses_stick(&self, state: &State) -> bool {
        self.shrinks_below(LOST, state) || self.breaks_away(state) || self.gives_way(state)
    }

    /// Whether a stick zone that shrinks is so near to the core of the mesh that it is lost in the next moment, or shrinks so fast that it is.
    pub fn is_losing_stick(&self, state: &State) -> bool {
        self.shrinks_below(NEARLY_LOST, state) || self.runs_away(state)
    }

    /// Whether a small stick zone under a held tangential force is lost at once at the rate at which its edge recedes.
    fn runs_away(&self, state: &State) -> bool {
        let held = self.schedule.conditions().tangential_control == TangentialControl::Force;
        let stick = state.stick.as_ref().filter(|_| held);
        stick.is_some_and(|stick| {
            let left = stick.area / -stick.rates[0];
            let is_small = stick.area < SMALL * (stick.area + state.slip_area);
            is_small && left > 0.0 && left < AT_ONCE * state.cycles
        })
    }

    /// Whether a stick zone that a tangential force takes away in the end has less than so many times the area of the core of the mesh.
    fn shrinks_below(&self, times: f64, state: &State) -> bool {
        let tangential = self.moving().is_some_and(MovingStick::is_balanced);
        let area = times * self.stick_zone.stick_area;
        self.slides && tangential && state.stick.as_ref().is_some_and(|stick| stick.area < area)
    }

    /// Width of the slip annulus of the first cycle, `(a² - c²)/c²`, where the edge of stick moves.
    pub fn width_beside_moving_edge(&self, state: &State) -> Option<f64> {
        state.stick.as_ref().map(|stick| state.slip_area / stick.area)
    }

    /// Where the mesh begins, with the edge of stick of a state.
    pub(super) fn stick_zone_in(&self, stick: Option<&StickEdge>, loading: &CycleLoading) -> StickZone {
        let (Some(moving), Some(stick)) = (self.moving(), stick) else { return self.stick_zone };
        let slip_compression = match moving.cause {
            Cause::Tangential | Cause::Friction => self.contact.indentation() - stick.depth,
            _ if moving.keeps => stick.slip_compression,
            Cause::NormalForce(_) => loading.slip_compression(self.contact.half_space().stiffness_ratio()),
            Cause::TwoBalances(_) => unreachable!("guessed above"),
            Cause::BothForces(_) | Cause::ReleasedForces(_) => stick.depth,
        };
        StickZone { stick_area: stick.area, slip_compression, stick_load: stick.load }
    }

    /// Indentation, m, from which the compressions of the core within a stick zone are seen: unworn ground there sticks, and comes to lie deeper
    /// where a normal force is held.
    pub(super) fn depth_over_core(&self, stick_zone: &StickZone) -> f64 {
        match self.moving().map(|moving| moving.cause) {
            Some(
                Cause::NormalForce(_)
                | Cause::BothForces(_)
                | Cause::ReleasedForces(_)
                | Cause::TwoBalances(_),
            ) => {
                let height = self.contact.equivalent_profile().value(stick_zone.stick_area.sqrt());
                stick_zone.slip_compression + height
            }
            _ => self.contact.indentation(),
        }
    }

    /// Adds the part of a held force that the quadrature over the springs misses in the first cycle to the load of the stick zone.
    pub(super) fn close_force(&self, mut state: State) -> State {
        let cause = self.moving().map(|moving| moving.cause);
        let held = cause.and_then(Cause::normal_force);
        let Some(force) = held else { return state };
        let left = force - self.normal_force(&self.fields(&state));
        if let Some(stick) = &mut state.stick {
            stick.load += 0.5 * left / self.contact.half_space().normal_stiffness();
        }
        state
    }

    /// What acts in a state. Under a balance of forces the amplitude is that at which springs at the edge of stick begin to slip.
    pub fn loading_in(&self, state: &State, loading: CycleLoading) -> CycleLoading {
        let loading = self.after_energy(self.held_at_rest(state, loading), state.dissipated_energy);
        let loading = loading.on_ground(state.ground.as_deref());
        if loading.is_pause() {
            return loading;
        }
        match (self.moving().map(|moving| moving.cause), &state.stick) {
            (Some(Cause::Tangential), Some(stick)) => {
                self.displaced(loading, self.contact.indentation() - stick.depth)
            }
            (Some(Cause::BothForces(_)), Some(stick)) => {
                let zone = self.stick_zone_in(Some(stick), &loading);
                self.deepened(loading, &zone)
            }
            (Some(Cause::ReleasedForces(_)), Some(stick)) => self.displaced(loading, stick.depth),
            (Some(Cause::TwoBalances(_)), Some(stick)) => self.displaced(loading, stick.slip_compression),
            _ => loading,
        }
    }

    /// What acts when friction has dissipated some energy, J.
    pub fn after_energy(&self, loading: CycleLoading, energy: f64) -> CycleLoading {
        match self.schedule.friction_along_energy() {
            History::Constant => loading,
            history => {
                let area = PI * self.contact.contact_radius().powi(2);
                let factor = history.at(energy / area);
                loading.each(|loading| CycleLoading { friction: loading.friction.scaled(factor), ..loading })
            }
        }
    }

    /// What acts when springs begin to slip at this compression, m: the amplitude of the contact that a balance of forces has decided.
    pub fn displaced(&self, loading: CycleLoading, slip_compression: f64) -> CycleLoading {
        let amplitude =
            loading.friction.static_strength(slip_compression) / self.contact.half_space().stiffness_ratio();
        loading.displaced(amplitude)
    }

    /// Indentation in a state, m.
    pub fn indentation(&self, state: &State) -> f64 {
        if let Some(gross) = self.gross() {
            return self.gross_indentation(gross, state);
        }
        match (self.moving(), &state.stick) {
            (Some(MovingStick { cause: Cause::NormalForce(_), .. }), Some(stick)) => {
                let loading = self.schedule.loading(state.cycles, state.cycles);
                let loading = self.after_energy(loading, state.dissipated_energy);
                stick.depth + self.stick_zone_in(Some(stick), &loading).slip_compression
            }
            (Some(MovingStick { cause: Cause::TwoBalances(_), .. }), Some(stick)) => {
                stick.depth + stick.slip_compression
            }
            (Some(MovingStick { cause: Cause::ReleasedForces(_), .. }), Some(stick)) => {
                stick.depth + self.contact.equivalent_profile().value(stick.area.sqrt())
            }
            (Some(moving), Some(stick)) if moving.deepens() => {
                self.contact.indentation() - self.stick_zone.slip_compression + stick.depth
            }
            _ => self.contact.indentation(),
        }
    }

    /// Wear depth, m, at the radii of the output that the first contact did not cover, of a state with its fields: what slip has grown by.
    ///
    /// By the rates of the steps it would be off there, for wear sets in where the contact edge comes past a radius within a step.
    pub fn settle_depth(&self, state: &mut State, fields: &Fields) {
        let (Some(moving), Some(stick)) = (self.moving(), &mut state.stick) else { return };
        let first = moving.span[0].exp();
        for (offset, depth) in self.output.offsets().iter().zip(&mut stick.wear_depth) {
            let squared = self.stick_zone.stick_area + offset;
            let z = squared - stick.area;
            if squared < first || z <= 0.0 {
                continue;
            }
            let x = z / fields.slip_area;
            *depth = if x < 1.0 {
                let unworn =
                    self.annulus().unworn.at_stick(stick.area, fields.stick_zone.slip_compression, z).slip;
                let grown = unworn * self.between_springs(&fields.log_slip, x).exp_m1();
                (grown - moving.left_behind(&stick.left_behind, squared)).max(0.0)
            } else {
                0.0
            };
        }
    }

    /// Value between the springs of a quantity given at all of them.
    pub(super) fn between_springs(&self, values: &[f64], x: f64) -> f64 {
        let mesh = self.annulus().operators.abel.mesh();
        mesh.interpolate(values, mesh.place(x))
    }
}

/// Compression at the edge of stick of the unworn contact in the balance of forces, m; at most the largest there can be, and that where springs remember their slip and none holds it.
///
/// # Errors
/// [`Error::NotConverged`](crate::Error::NotConverged) if even that is not enough, elsewhere.
pub(super) fn first_slip_compression(
    contact: &InitialContact,
    loading: &CycleLoading,
    largest: f64,
) -> Result<f64> {
    let ratio = contact.half_space().stiffness_ratio();
    let depth = contact.indentation();
    let excess = |compression: f64| {
        let amplitude = loading.friction.static_strength(compression) / ratio;
        let force = super::first_force::first_force(contact, &*loading.friction, amplitude, depth)
            .unwrap_or(f64::NAN);
        loading.excess(force, amplitude)
    };
    let least = 1e-12 * largest;
    let left = excess(largest);
    if left < 0.0 && left.abs() <= SAME_BALANCE * loading.asked() {
        return Ok(largest);
    }
    if !loading.friction.remembers_slip() {
        return bracketed(excess, least, largest, 0.0);
    }
    // The force falls again where more springs break away than stick: what is reached first is what holds it. Held, it is the one of an amplitude.
    if let AmplitudeControl::Force(_) = loading.control {
        return Ok(loading.slip_compression(ratio));
    }
    let part = |i: usize| least + (largest - least) * i as f64 / FIRST_BALANCE as f64;
    match (1..=FIRST_BALANCE).find(|i| excess(part(*i)) >= 0.0) {
        Some(reached) => bracketed(excess, part(reached - 1), part(reached), 0.0),
        None => Ok(largest),
    }
}
