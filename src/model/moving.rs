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

use std::f64::consts::PI;

use faer::Mat;

use super::cycle::CycleFields;
use super::schedule::{Demand, Drive, Schedule};
use super::{Fields, Model, POINTS, Place, State};
use crate::contact::InitialContact;
use crate::error::{Error, Result};
use crate::grid::{Clustering, lagrange, stencil_start};
use crate::history::History;
use crate::indenter::EquivalentProfile;
use crate::linear::dot;
use crate::loading::TangentialControl;
use crate::roots::bracketed;

/// Radii at which what was left behind is known, for interpolation over where the contact edge can be.
const STATIONS: usize = 24;

/// Indentation over the first one up to which a contact that slides under a held force is followed.
const FARTHEST: f64 = 5.0;

/// Steps of the integrals over the ground that comes to rest in a jump of the edge of stick.
const JUMP_STEPS: usize = 1000;

/// Springs from the contact edge whose compression tells how it goes on beyond.
const BEYOND: usize = 4;

/// Change of edge, stick edge or depth, relative, by which slopes are found.
const DIFFERENCE: f64 = 1e-7;

/// What moves the edge of stick.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Cause {
    /// The coefficient of friction changes.
    Friction,
    /// This normal force, N, is held.
    NormalForce(f64),
    /// The tangential amplitude follows from a balance of forces.
    Tangential,
    /// This normal force, N, is held while the whole contact slides: the edge stays at the core of the mesh, `q_c = d - g_0(c)` grows.
    Sliding(f64),
}

/// How the edge of stick moves.
#[derive(Debug, Clone)]
pub struct MovingStick {
    cause: Cause,
    /// Whether it moves outwards and leaves worn ground behind.
    outwards: bool,
    /// Whether it does so between blocks only.
    jumps: bool,
    /// Logarithms of the squares of the first and last radius of the stations.
    span: [f64; 2],
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
    /// Mean rates of area, m², and depth, m, per cycle in the last step.
    pub rates: [f64; 2],
}

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

impl MovingStick {
    /// How the edge of stick moves under a schedule; none if it stays, or moves to and fro.
    ///
    /// # Arguments
    /// * `slides` -- whether no stick is left in some cycle
    ///
    /// # Errors
    /// [`Error::Inconsistent`] for a force that is held while friction falls or amplitudes grow, and for friction that changes under
    /// normal oscillation.
    pub fn new(schedule: &Schedule, contact: &InitialContact, slides: bool) -> Result<Option<Self>> {
        let conditions = schedule.conditions();
        if slides {
            let sliding = conditions.holds_normal_force && conditions.blocks.is_empty();
            let cause = Cause::Sliding(contact.normal_force());
            return Ok(sliding.then_some(Self { cause, outwards: false, jumps: false, span: [0.0; 2] }));
        }
        let cause = match (conditions.holds_normal_force, conditions.tangential_control) {
            (true, TangentialControl::Displacement) => Some(Cause::NormalForce(contact.normal_force())),
            (true, _) => {
                return Err(Error::Inconsistent {
                    what: "loading.normal_force",
                    why: "is not held together with a tangential force or a rig; hold one of the two".into(),
                });
            }
            (false, TangentialControl::Displacement) => {
                let changes = conditions.friction_history != History::Constant;
                match &conditions.blocks[..] {
                    [] => changes.then_some(Cause::Friction),
                    blocks => {
                        let shrink = blocks
                            .windows(2)
                            .all(|pair| pair[1].amplitude_factor <= pair[0].amplitude_factor)
                            && blocks
                                .iter()
                                .all(|block| block.indentation_factor == 1.0 && block.amplitude_factor > 0.0);
                        let jumps = shrink && !changes && !conditions.repeat;
                        return Ok(jumps.then_some(Self {
                            cause: Cause::Friction,
                            outwards: true,
                            jumps,
                            span: [0.0; 2],
                        }));
                    }
                }
            }
            (false, _) => Some(Cause::Tangential),
        };
        let Some(cause) = cause else { return Ok(None) };
        if cause == Cause::Friction && schedule.lifts() {
            return Err(Error::Inconsistent {
                what: "friction.history",
                why: "is not followed where the indentation changes within a period: springs that are loaded for a part of it would be \
                      worn too deep at an edge of stick that moves; leave out the history, or the normal oscillation"
                    .into(),
            });
        }
        let [falls, rises] = directions(&conditions.friction_history);
        let outwards = match cause {
            Cause::NormalForce(_) if falls || !conditions.blocks.is_empty() => {
                return Err(Error::Inconsistent {
                    what: "loading.normal_force",
                    why: "is held with a constant or rising coefficient of friction and without blocks only: else the edge of stick \
                          moves to and fro over worn ground; hold the indentation"
                        .into(),
                });
            }
            Cause::NormalForce(_) | Cause::Sliding(_) => true,
            Cause::Friction if falls && rises => return Ok(None),
            Cause::Friction => rises,
            Cause::Tangential if rises || !conditions.blocks.is_empty() => return Ok(None),
            Cause::Tangential => false,
        };
        Ok(Some(Self { cause, outwards, jumps: false, span: [0.0; 2] }))
    }

    /// The contact with the largest indentation that can come, of which the limit bounds where wear can reach.
    ///
    /// Under a held force the unworn stick zone alone would bear it there.
    pub(super) fn farthest(&self, contact: &InitialContact) -> Result<InitialContact> {
        if let Cause::Sliding(_) = self.cause {
            // Wear goes on without end; this is how far it is followed.
            let depth = FARTHEST * contact.indentation();
            return contact.at(depth, depth - contact.indentation() + contact.slip_compression());
        }
        let Cause::NormalForce(force) = self.cause else { return Ok(contact.clone()) };
        let half_space = contact.half_space();
        let exponent = 1.0 + half_space.grading();
        let profile = contact.equivalent_profile();
        let stick = contact.stick_radius().unwrap_or_default();
        let left = force / half_space.normal_stiffness() - profile.load_integral(stick);
        let compression = left * exponent / (2.0 * stick.powf(exponent));
        contact.at(profile.value(stick) + compression, compression)
    }

    /// The mesh that serves, where `asked` is the one for an edge of stick that stays.
    pub(super) fn clustering(&self, asked: Clustering) -> Clustering {
        match self.cause {
            _ if self.jumps || self.slides() => asked,
            _ if self.outwards => Clustering::CreepingStick,
            _ => Clustering::MovingStick,
        }
    }

    /// Whether the contact slides as a whole under a held normal force, so that wear never ends.
    pub fn slides(&self) -> bool {
        matches!(self.cause, Cause::Sliding(_))
    }

    /// By how much area and depth of the edge of stick have changed in a stage, as far as ground passes it.
    fn motion(&self, target: &StickTarget, area: f64, depth: f64) -> (f64, f64) {
        if self.slides() { (0.0, 0.0) } else { (area - target.stick.area, depth - target.stick.depth) }
    }

    pub(super) fn with_span(mut self, first: f64, last: f64) -> Self {
        self.span = [first.ln(), last.ln()];
        self
    }

    /// Squares of the radii of the stations, m².
    fn stations(&self) -> impl Iterator<Item = f64> {
        let [first, last] = self.span;
        (0..STATIONS).map(move |j| {
            let part = 0.5 - 0.5 * (PI * (j as f64 + 0.5) / STATIONS as f64).cos();
            (first + (last - first) * part).exp()
        })
    }

    /// What was left behind at a squared radius, m².
    fn left_behind(&self, values: &[f64], squared: f64) -> f64 {
        let [first, last] = self.span;
        let x = (squared.ln() - first) / (last - first);
        let (mut sum, mut weights) = (0.0, 0.0);
        for (j, value) in values.iter().enumerate() {
            let angle = PI * (j as f64 + 0.5) / STATIONS as f64;
            let distance = x - (0.5 - 0.5 * angle.cos());
            if distance == 0.0 {
                return *value;
            }
            let weight = if j % 2 == 0 { 1.0 } else { -1.0 } * angle.sin() / distance;
            sum += weight * value;
            weights += weight;
        }
        if weights == 0.0 { 0.0 } else { sum / weights }
    }

    /// The edge of stick of the unworn contact.
    pub(super) fn start(&self, model: &Model) -> Result<StickEdge> {
        let profile = model.contact.equivalent_profile();
        let drive = model.schedule.drive(0.0, 0.0);
        let compression = match self.cause {
            Cause::Sliding(_) => {
                let radius = model.place.stick_area.sqrt();
                return Ok(StickEdge {
                    area: model.place.stick_area,
                    depth: model.place.slip_compression,
                    load: unworn_load(profile, radius, model.place.slip_compression),
                    ..StickEdge::default()
                });
            }
            Cause::Tangential => model.first_slip_compression(&drive)?,
            _ => drive.slip_compression(model.contact.half_space().stiffness_ratio()),
        };
        let depth = model.contact.indentation() - compression;
        if depth <= 0.0 {
            return Err(Error::Inconsistent {
                what: "loading",
                why: "the whole contact slides in the first cycle under a force that is held; reduce the amplitude".into(),
            });
        }
        let radius = profile.radius_at(depth)?;
        let load = unworn_load(profile, radius, compression);
        let behind = if self.outwards { STATIONS } else { 0 };
        let nodes = if self.outwards { model.springs() } else { 0 };
        Ok(StickEdge {
            area: radius * radius,
            depth,
            load,
            left_behind: vec![0.0; behind],
            wear_depth: vec![0.0; nodes],
            rates: [0.0; 2],
        })
    }
}

/// `∫_0^c x^k q dx` of unworn ground, m^(2+k).
fn unworn_load(profile: &EquivalentProfile, radius: f64, slip_compression: f64) -> f64 {
    let exponent = 1.0 + profile.grading();
    0.5 * profile.load_integral(radius) + slip_compression * radius.powf(exponent) / exponent
}

/// Whether a history falls, and whether it rises, somewhere.
fn directions(history: &History) -> [bool; 2] {
    match history {
        History::Constant => [false, false],
        History::Exponential { last, .. } => [*last < 1.0, *last > 1.0],
        History::Table { factors, .. } => [
            factors.windows(2).any(|pair| pair[1] < pair[0]),
            factors.windows(2).any(|pair| pair[1] > pair[0]),
        ],
    }
}

impl Model {
    /// How the edge of stick moves, if it does.
    pub fn moving(&self) -> Option<&MovingStick> {
        self.moving.as_ref()
    }

    /// Where the mesh begins in a state.
    pub(super) fn place_of(&self, stick: &StickEdge, drive: &Drive) -> Place {
        let moving = self.moving.as_ref().expect("a stick edge in the state is one that moves");
        let slip_compression = match moving.cause {
            Cause::Tangential | Cause::Friction => self.contact.indentation() - stick.depth,
            Cause::NormalForce(_) => drive.slip_compression(self.contact.half_space().stiffness_ratio()),
            Cause::Sliding(_) => stick.depth,
        };
        Place { stick_area: stick.area, slip_compression, stick_load: stick.load }
    }

    /// Puts what the quadrature over the springs leaves of a held force in the first cycle on the stick zone.
    pub(super) fn close_force(&self, mut state: State) -> State {
        let cause = self.moving.as_ref().map(|moving| moving.cause);
        let Some(Cause::NormalForce(force) | Cause::Sliding(force)) = cause else { return state };
        let left = force - self.normal_force(&self.fields(&state));
        if let Some(stick) = &mut state.stick {
            stick.load += 0.5 * left / self.contact.half_space().normal_stiffness();
        }
        state
    }

    /// What acts in a state: the amplitude is that at which springs at the edge of stick begin to slip.
    pub fn drive_in(&self, state: &State, drive: Drive) -> Drive {
        let tangential = self.moving.as_ref().is_some_and(|moving| moving.cause == Cause::Tangential);
        match &state.stick {
            Some(stick) if tangential => self.displaced(drive, self.contact.indentation() - stick.depth),
            _ => drive,
        }
    }

    fn displaced(&self, drive: Drive, slip_compression: f64) -> Drive {
        let amplitude =
            drive.friction.static_strength(slip_compression) / self.contact.half_space().stiffness_ratio();
        Drive { amplitude, demand: Demand::Displacement, ..drive }
    }

    /// Indentation in a state, m.
    pub fn indentation(&self, state: &State) -> f64 {
        match (&self.moving, &state.stick) {
            (Some(MovingStick { cause: Cause::NormalForce(_), .. }), Some(stick)) => {
                let drive = self.schedule.drive(state.cycles, state.cycles);
                stick.depth + self.place_of(stick, &drive).slip_compression
            }
            (Some(MovingStick { cause: Cause::Sliding(_), .. }), Some(stick)) => {
                self.contact.indentation() - self.contact.slip_compression() + stick.depth
            }
            _ => self.contact.indentation(),
        }
    }

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
        let unworn_rise = 0.5 * profile.derivative(radius) / radius * passed;
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
        let closure = if moving.jumps || moving.slides() {
            area / target.stick.area - 1.0
        } else if moving.outwards {
            unworn_rise - risen * self.at_stick_edge(|i| (-fields.log_slip[i]).exp())
        } else {
            profile.value(radius) - depth
        };
        let closure = if moving.jumps || moving.slides() { closure } else { closure / slip_compression };
        trial.residual.push(closure);
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
        let radius = area.sqrt();
        let unworn_rise = 0.5 * self.contact.equivalent_profile().derivative(radius) / radius * passed;
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
        }
    }

    /// The state in which a new block begins: where the edge of stick jumps outwards, the mesh begins anew there.
    ///
    /// # Errors
    /// [`Error::NotConverged`] if no spring has the compression at which stick would end.
    pub fn begin_block(&self, state: State) -> Result<State> {
        let (Some(moving), Some(stick)) = (&self.moving, &state.stick) else { return Ok(state) };
        let drive = self.schedule.drive(state.cycles, state.cycles);
        let compression = drive.slip_compression(self.contact.half_space().stiffness_ratio());
        let before = self.contact.indentation() - stick.depth;
        if !moving.jumps || compression >= before {
            return Ok(state);
        }
        let profile = self.contact.equivalent_profile();
        let exponent = 1.0 + profile.grading();
        let place = Place { stick_area: stick.area, slip_compression: before, stick_load: stick.load };
        let mut fields = Fields::default();
        self.evaluate_at(&place, state.edge, &state.compression, &mut fields);
        let inner = state.compression.len();
        let mut on_springs = state.compression.clone();
        on_springs.push(0.0);
        // Next to the old edge, where springs may have lost their load within the first cell, the first spring's.
        let first = self.operators.abel.nodes()[1];
        let nodes = self.operators.abel.nodes();
        let beyond = -on_springs[inner - BEYOND] / (1.0 - nodes[inner + 1 - BEYOND]);
        let at = |x: f64| match x {
            x if x < first => on_springs[0] + (before - on_springs[0]) * (1.0 - x / first),
            x if x > 1.0 => beyond * (x - 1.0),
            x => self.between_springs(&on_springs, x),
        };
        let part = bracketed(|x| at(x) - compression, 0.0, 1.0, 0.0)?;
        let (mut left_behind, mut load) = (stick.left_behind.clone(), stick.load);
        let height = |x: f64| {
            let squared = stick.area + state.edge * x;
            self.contact.indentation() - at(x) - profile.value(squared.sqrt())
        };
        for step in 0..JUMP_STEPS {
            // Denser next to the old edge, as the springs are.
            let end = |i: usize| part * (i as f64 / JUMP_STEPS as f64).powi(4);
            let (low, high) = (end(step), end(step + 1));
            let middle = stick.area + 0.5 * state.edge * (low + high);
            let rise = height(high) - height(low);
            for (value, squared) in left_behind.iter_mut().zip(moving.stations()) {
                *value -= rise * self.unworn.at_stick(middle, 1.0, squared - middle).limit_slip;
            }
            load += 0.5
                * state.edge
                * (high - low)
                * at(0.5 * (low + high))
                * middle.powf(0.5 * (exponent - 2.0));
        }
        let next = Place {
            stick_area: stick.area + state.edge * part,
            slip_compression: compression,
            stick_load: load,
        };
        // Slip is what is carried over: small numbers next to the edge of stick, where compressions differ by little. The contact edge
        // may be off by what the interpolation is.
        let nodes = &self.operators.abel.nodes()[1..];
        let guess = state.edge * (1.0 - part);
        let mut slip_at = |edge: f64| {
            self.evaluate_at(&next, edge, &state.compression, &mut fields);
            let slipping = nodes.iter().map(|x| (compression - at(part + edge / state.edge * x)).max(0.0));
            self.carried(&fields, slipping)
        };
        let edge = guess;
        let slip = slip_at(edge);
        // What is left behind is by another quadrature than the slip: the contact edge stays where it is.
        let behind = moving.left_behind(&left_behind, next.stick_area + edge);
        let off = self.mismatch_at(&next, edge, |i, _| slip[i]) - behind;
        left_behind.iter_mut().for_each(|value| *value += off);
        let moved = self.compression_at(&next, edge, |i, _| slip[i]);
        Ok(State {
            edge,
            compression_rate: vec![0.0; moved.len()],
            compression: moved,
            edge_rate: 0.0,
            stick: Some(StickEdge {
                area: next.stick_area,
                depth: self.contact.indentation() - compression,
                load,
                left_behind,
                wear_depth: stick.wear_depth.clone(),
                rates: [0.0; 2],
            }),
            ..state
        })
    }

    /// Value between the springs of a quantity given at all of them, by local cubics.
    fn between_springs(&self, values: &[f64], x: f64) -> f64 {
        let nodes = self.operators.abel.nodes();
        let cell = nodes.partition_point(|node| *node < x).saturating_sub(1).max(1);
        let start = stencil_start(cell, POINTS, values.len()).min(values.len() + 1 - POINTS) - 1;
        let mut weights = [0.0; POINTS];
        lagrange(&nodes[1 + start..1 + start + POINTS], x, &mut weights);
        dot(&weights, &values[start..start + POINTS])
    }

    /// Compression at the edge of stick of the unworn contact in the balance of forces, m.
    fn first_slip_compression(&self, drive: &Drive) -> Result<f64> {
        let ratio = self.contact.half_space().stiffness_ratio();
        let depth = self.contact.indentation();
        let largest = self.contact.slip_compression();
        let excess = |compression: f64| {
            let amplitude = drive.friction.static_strength(compression) / ratio;
            let force = super::reach::first_force(&self.contact, &drive.friction, amplitude, depth)
                .unwrap_or(f64::NAN);
            drive.excess(force, amplitude)
        };
        bracketed(excess, 1e-12 * largest, largest, 0.0)
    }
}
