//! What is reported of a contact: integrals over it, and its fields at fixed radii.

use std::f64::consts::PI;
use std::sync::OnceLock;

use super::{CycleFields, Fields, HIDDEN, Model, MovingStick, State, StickEdge};
use crate::contact::slip_depth::{UnwornSlip, UnwornValues};
use crate::contact::stick_slip::Regime;
use crate::numerics::grid::{Local, Mesh};
use crate::numerics::linear::dot;
use crate::numerics::power;

/// Distance from the contact edge, over the annulus, that is round-off.
const AT_EDGE: f64 = 1e-13;

/// Radii of the output on a smooth mesh of fewer springs.
const SHOWN: usize = 128;

/// Most radii of the output: of more springs every second one is shown, or every third, and so on, inwards from the contact edge. A file of a
/// hundred snapshots then takes 40 MB.
const MOST_SHOWN: usize = 16_384;

/// Radius of the output, over that of the first contact, from which on it is asked how far a run comes.
const FAR_OUT: f64 = 2.0;

/// Most springs at which the depth is compared from step to step.
const MOST_JUDGED: usize = 4096;

/// Stick radius, over that of the core of a mesh that follows it until none is left, below which nothing sticks.
const MIDDLE: f64 = 2.0;

/// The fields on the fixed radii of the output, shape `(node,)` each.
#[derive(Debug, Clone, PartialEq)]
pub struct RadialFields {
    /// Wear depth, m.
    pub wear_depth: Vec<f64>,
    /// Pressure, Pa, zero outside the contact; not a number in the stick zone, which has no springs.
    pub pressure: Vec<f64>,
    /// Slip amplitude, m, zero outside the contact.
    pub slip: Vec<f64>,
}

impl Model {
    /// The same contact on the same springs, with the radii of the output at `r² - c²`, m², increasing, instead of its own.
    pub(crate) fn shown_at(mut self, offsets: Vec<f64>) -> Self {
        let unworn = match self.gross() {
            Some(_) => vec![],
            None => offsets.iter().map(|offset| self.annulus().unworn.at(*offset)).collect(),
        };
        self.output = OutputRadii { unworn, offsets, heights: OnceLock::new() };
        self
    }

    /// Whether the radii of the output go as far out as a limit to which few runs come.
    pub(crate) fn is_shown_far_out(&self) -> bool {
        let farthest = self.stick_zone.stick_area + self.offsets().last().copied().unwrap_or_default();
        farthest.sqrt() > FAR_OUT * self.contact.contact_radius()
    }

    /// The same contact with the radii of the output spread as they are, up to one, m.
    pub(crate) fn shown_up_to(self, radius: f64) -> Self {
        let offsets = self.offsets();
        let last = offsets.last().copied().unwrap_or_default();
        let part = ((radius * radius - self.stick_zone.stick_area) / last).min(1.0);
        self.shown_at(offsets.iter().map(|offset| part * offset).collect())
    }

    /// Height of the unworn profile at [`Model::radii`], m.
    pub fn unworn_heights(&self) -> &[f64] {
        let height = |r: f64| self.contact.indenter().profile(r);
        self.output.heights.get_or_init(|| self.radii().into_iter().map(height).collect())
    }

    /// Worn volume `2π ∫ w r dr`, m³ [S, Eq. (4)].
    pub fn wear_volume(&self, fields: &Fields) -> f64 {
        if let Some(gross) = self.gross() {
            return self.gross_volume(gross, fields);
        }
        self.volume(fields.slip_area, &fields.wear_depth)
    }

    /// Worn volume in a state, m³: where the edge of stick has left worn ground behind, or jumps over it, by the rates of the cycles. The wall where slip has ended lies between springs after a jump
    /// inwards, and no quadrature over them sees where.
    pub fn worn_volume(&self, state: &State, fields: &Fields) -> f64 {
        let jumps = self.moving().is_some_and(MovingStick::jumps_between_blocks);
        match &state.stick {
            Some(stick) if jumps || !stick.wear_depth.is_empty() => state.volume_by_rate,
            _ => self.wear_volume(fields),
        }
    }

    /// Worn volume of the limit by the program's own quadrature, m³.
    pub fn limit_volume(&self) -> f64 {
        let depth: Vec<f64> = self.annulus().radial_unworn.iter().map(UnwornValues::limit_depth).collect();
        self.volume(self.annulus().unworn.limit_slip_area(), &depth)
    }

    /// Depth that the mesh does not resolve in the unworn slip, over the limit's largest: waves of a table that are too short for it. None where the
    /// indenter is not a table, or the edge of stick moves.
    pub fn unseen_depth(&self) -> Option<f64> {
        self.contact.equivalent_profile().end_of_table()?;
        if self.moving().is_some() || self.gross().is_some() {
            return None;
        }
        let (mesh, count) = (self.annulus().operators.abel.mesh(), self.springs());
        let smooth = |unworn: &UnwornValues| unworn.slip.ln() - (1.0 + self.mu()) * unworn.logarithm.ln();
        let springs: Vec<f64> = self.annulus().radial_unworn.iter().map(smooth).collect();
        let missed = |y: f64| {
            let unworn = self.annulus().unworn.at(self.annulus().unworn.limit_slip_area() * mesh.at(y).value);
            unworn.slip * (mesh.local(y, count).sum(&springs) - smooth(&unworn)).abs()
        };
        let between = (1..count).flat_map(|i| [0.25, 0.5, 0.75].map(|part| i as f64 + part));
        Some(between.map(missed).fold(0.0, f64::max) / self.depth_scale)
    }

    pub(super) fn volume(&self, slip_area: f64, wear_depth: &[f64]) -> f64 {
        PI * slip_area * dot(self.annulus().operators.abel.depth_sum(), wear_depth)
    }

    /// Normal force, N [S, Eq. (22)].
    pub fn normal_force(&self, fields: &Fields) -> f64 {
        if let Some(gross) = self.gross() {
            return self.gross_normal_force(gross, fields);
        }
        let slipping = fields.slip_area
            * dot(&self.annulus().operators.abel.spring_sum()[..fields.density.len()], &fields.density);
        self.contact.half_space().normal_stiffness() * (2.0 * fields.stick_zone.stick_load + slipping)
    }

    /// Energy that friction dissipates in one cycle, J.
    ///
    /// ```text
    /// W = 8 μ_f c_N ∫_c^a x^k q (μ_f/M) (q_c - q) dx
    /// ```
    pub fn dissipation(&self, fields: &Fields, compression: &[f64]) -> f64 {
        let friction = self.contact.friction().coefficient;
        let half_space = self.contact.half_space();
        let slipping = fields.stick_zone.slip_compression;
        let sum: f64 = compression
            .iter()
            .zip(&fields.density)
            .zip(self.annulus().operators.abel.spring_sum())
            .map(|((q, u), weight)| weight * u * (slipping - q))
            .sum();
        4.0 * friction * friction / half_space.stiffness_ratio()
            * half_space.normal_stiffness()
            * fields.slip_area
            * sum
    }

    /// Tangential force, N, when a contact without tangential load is moved by `u`, m, in one direction.
    ///
    /// ```text
    /// F_x(u) = 2 c_T ∫_0^a x^k min(u, μ_f q/M) dx,     c_T = M c_N
    /// ```
    pub fn tangential_force(&self, fields: &Fields, compression: &[f64], displacement: f64) -> f64 {
        let half_space = self.contact.half_space();
        let q = 1.0 + half_space.grading();
        let limit = self.contact.friction().coefficient / half_space.stiffness_ratio();
        if let Some(gross) = self.gross() {
            let moved: Vec<f64> = compression.iter().map(|q| displacement.min(limit * q)).collect();
            return half_space.stiffness_ratio()
                * half_space.normal_stiffness()
                * self.gross_sum(gross, fields, &moved);
        }
        let stuck = 2.0 * displacement * fields.stick_zone.stick_area.powf(0.5 * q) / q;
        let springs =
            compression.iter().zip(&fields.density_factor).zip(self.annulus().operators.abel.spring_sum());
        let moved: f64 =
            springs.map(|((q, factor), weight)| weight * factor * displacement.min(limit * q)).sum();
        half_space.stiffness_ratio() * half_space.normal_stiffness() * (stuck + fields.slip_area * moved)
    }

    /// Tangential force, N, along one steady fretting loop, at displacements, m, that go from `U` to `-U` and back.
    ///
    /// After a reversal every spring repeats its first loading at twice the scale (Masing), and the way back is the way down turned about the origin:
    ///
    /// ```text
    /// F = F_x(U) - 2 F_x((U - u)/2)  on the way down,     F(u) = -F(-u)  on the way up
    /// ```
    ///
    /// # Arguments
    /// * `fields` -- of the state
    /// * `compression` -- of the springs, m
    /// * `displacements` -- on the way down, each with its negative, the largest first; shape `(m,)`
    ///
    /// # Returns
    /// Forces on both ways, shape `(2m - 1,)`; the last is the first.
    pub fn fretting_loop(&self, fields: &Fields, compression: &[f64], displacements: &[f64]) -> Vec<f64> {
        let amplitude = self.contact.amplitude();
        let force = |displacement: f64| self.tangential_force(fields, compression, displacement);
        let largest = force(amplitude);
        let mut forces: Vec<f64> =
            displacements.iter().map(|u| largest - 2.0 * force(0.5 * (amplitude - u))).collect();
        let way_up: Vec<f64> = forces.iter().skip(1).map(|force| -force).collect();
        forces.extend(way_up);
        forces
    }

    /// What a cycle does to the contact: stick if no spring slips, full sliding if the innermost one does and no stick zone bears the load.
    pub fn regime(&self, state: &State, cycle: &CycleFields) -> Regime {
        if cycle.stick_radius >= self.contact_radius(state) {
            Regime::Stick
        } else if self.reaches_the_middle(cycle.stick_radius) {
            Regime::FullSliding
        } else {
            Regime::PartialSlip
        }
    }

    /// A stick radius of [`CycleFields`] or [`State`], m: zero where that is the core of a mesh on which stick is lost.
    pub fn without_core(&self, stick_radius: f64) -> f64 {
        if self.reaches_the_middle(stick_radius) { 0.0 } else { stick_radius }
    }

    fn reaches_the_middle(&self, stick_radius: f64) -> bool {
        self.gross().is_some() && stick_radius == 0.0
            || self.slides && stick_radius < MIDDLE * self.stick_zone.stick_area.sqrt()
    }

    /// Wear depth, m, at any `offset = r² - c²`, m², where the edge of stick left no worn ground behind.
    pub fn wear_depth_at(&self, state: &State, fields: &Fields, offset: f64) -> f64 {
        if let Some(gross) = self.gross() {
            return self.gross_depth_at(gross, fields, offset);
        }
        let annulus = Annulus::new(self, state, fields);
        annulus.point(offset, &self.annulus().unworn.at(offset)).map_or(0.0, |point| point.grown)
    }

    /// Wear depth, m, by which a step is accepted: at the output where the edge of stick leaves worn ground behind, else at the springs of the limit
    /// that are not hidden, or at one in several where they are many; at least zero.
    pub fn depth_on_springs(&self, state: &State, fields: &Fields) -> Vec<f64> {
        if self.gross().is_some() {
            return vec![];
        }
        if state.stick.as_ref().is_some_and(|stick| !stick.wear_depth.is_empty()) {
            return self.radial_wear_depth(state, fields, 1);
        }
        let annulus = Annulus::new(self, state, fields);
        let every = self.springs().div_ceil(MOST_JUDGED);
        let springs = self.annulus().operators.abel.nodes()[1..]
            .iter()
            .zip(&self.annulus().radial_unworn)
            .skip(self.annulus().hidden);
        let depth = |(x, unworn): (&f64, &UnwornValues)| {
            let point = annulus.point(self.annulus().unworn.limit_slip_area() * x, unworn);
            point.map_or(0.0, |point| point.wear_depth())
        };
        springs.step_by(every).map(depth).collect()
    }

    /// Wear depth at one in so many of [`Model::radii`], m.
    pub fn radial_wear_depth(&self, state: &State, fields: &Fields, every: usize) -> Vec<f64> {
        if let Some(gross) = self.gross() {
            return self.gross_radial_fields(gross, state).wear_depth.into_iter().step_by(every).collect();
        }
        let annulus = Annulus::new(self, state, fields);
        let depth =
            |(i, (offset, unworn))| annulus.wear_depth(i, offset, annulus.point(offset, unworn).as_ref());
        self.output.iter().enumerate().step_by(every).map(depth).collect()
    }

    /// The fields at [`Model::radii`], by the local polynomials between the springs.
    pub fn radial_fields(&self, state: &State, fields: &Fields, cycle: &CycleFields) -> RadialFields {
        if let Some(gross) = self.gross() {
            return self.gross_radial_fields(gross, state);
        }
        let mesh = self.annulus().operators.abel.mesh();
        let nu = 1.0 - self.mu();
        // Slip over slip depth is smooth along the annulus.
        let per_depth: Vec<f64> =
            cycle.slip.iter().zip(&fields.slip_depth).map(|(slip, depth)| slip / depth).collect();
        let eased: Vec<f64> = (0..self.springs() - 1)
            .map(|i| fields.pressure[i] * mesh.node(i + 1).complement.powf(-nu))
            .collect();
        let shown = self.output.offsets.len();
        let mut radial =
            RadialFields { wear_depth: vec![0.0; shown], pressure: vec![0.0; shown], slip: vec![0.0; shown] };
        let annulus = Annulus::new(self, state, fields);
        for (i, (offset, unworn)) in self.output.iter().enumerate() {
            let point = annulus.point(offset, unworn);
            radial.wear_depth[i] = annulus.wear_depth(i, offset, point.as_ref());
            if annulus.sticks_at(offset) {
                radial.pressure[i] = f64::NAN;
            }
            let Some(AnnulusPoint { x, y, unworn, grown, local }) = point else { continue };
            let slip = local.sum(&per_depth) * (unworn + grown);
            // A path has no sign; where slip jumps, under a static coefficient, the polynomial swings.
            radial.slip[i] = if slip < 0.0 { 0.0 } else { slip };
            let inner = mesh.local_among(&local, y, eased.len());
            radial.pressure[i] = inner.sum(&eased) * power(1.0 - x, nu);
            if mesh.clustering().is_even() {
                radial.pressure[i] = radial.pressure[i].max(0.0);
            }
        }
        radial
    }
}

/// Range of `λ` on the springs of one local polynomial beyond which it swings, where slip jumps at the edge of stick.
const JUMP: f64 = 2.0;

/// What is given on the springs, on the straight line between two of them, and as on the first one before it.
fn on_line(y: f64, values: &[f64]) -> f64 {
    let before = (y.floor() as usize).clamp(1, values.len() - 1);
    let [from, to] = [values[before - 1], values[before]];
    from + (y - before as f64).max(0.0) * (to - from)
}

/// The slip annulus in a state, at any `offset = r² - c²`, m², from the edge of stick at rest.
struct Annulus<'a> {
    model: &'a Model,
    state: &'a State,
    fields: &'a Fields,
    /// `λ_∞` on the springs.
    limit_log_slip: Vec<f64>,
    /// Whether slip jumps at the edge of stick, as under a static coefficient.
    slip_jumps: bool,
}

impl<'a> Annulus<'a> {
    fn new(model: &'a Model, state: &'a State, fields: &'a Fields) -> Self {
        let limit_log_slip = fields.unworn.iter().map(UnwornValues::limit_log_slip).collect();
        let slip_jumps = model.schedule().conditions().friction.static_factor() > 1.0;
        Self { model, state, fields, limit_log_slip, slip_jumps }
    }

    /// A point of the annulus where the unworn slip of the edge at rest is known; none outside the annulus.
    fn point(&self, offset: f64, at_rest: &UnwornValues) -> Option<AnnulusPoint> {
        let (model, fields) = (self.model, self.fields);
        let (z, unworn) = match &self.state.stick {
            None => (offset, *at_rest),
            Some(stick) => {
                let z = model.stick_zone.stick_area + offset - stick.area;
                (z, if z > 0.0 { model.unworn_at(&fields.stick_zone, z) } else { *at_rest })
            }
        };
        let x = z / fields.slip_area;
        if x <= 0.0 || x >= 1.0 - AT_EDGE {
            return None;
        }
        let y = model.annulus().operators.abel.mesh().place(x);
        let local = model.annulus().operators.abel.mesh().local(y, model.springs());
        let log_slip = self.log_slip(y, &local, &unworn);
        Some(AnnulusPoint { x, y, unworn: unworn.slip, grown: unworn.slip * log_slip.exp_m1(), local })
    }

    /// `λ` at a place of the mesh where the unworn slip is known.
    ///
    /// On a smooth mesh the local polynomial is corrected by its error for the limit's `λ_∞`, which is known everywhere, in the proportion in
    /// which wear has come to the limit: so the limit is met between the springs as it is at them.
    /// Elsewhere a straight line takes its place where it swings, since slip jumps at the edge of stick.
    fn log_slip(&self, y: f64, local: &Local, unworn: &UnwornValues) -> f64 {
        let mesh = self.model.annulus().operators.abel.mesh();
        let values = &self.fields.log_slip;
        let log_slip = local.sum(values);
        if !mesh.clustering().follows_front() {
            let swings = self.slip_jumps && local.range(values) > JUMP;
            return if swings { on_line(y, values) } else { log_slip };
        }
        let between = local.sum(&self.limit_log_slip);
        let worn = if between > 0.0 { (log_slip / between).clamp(0.0, 1.0) } else { 1.0 };
        log_slip + worn * (unworn.limit_log_slip() - between)
    }

    /// Wear depth, m, at a radius of the output, at least zero.
    fn wear_depth(&self, index: usize, offset: f64, point: Option<&AnnulusPoint>) -> f64 {
        let passed = self.state.stick.as_ref().and_then(|stick| Some((stick, stick.wear_depth.get(index)?)));
        match passed {
            Some((stick, worn)) => self.depth_beyond(stick, offset, point, *worn),
            None => point.map_or(0.0, AnnulusPoint::wear_depth),
        }
    }

    /// Wear depth, m, where the edge of stick leaves worn ground behind: `worn`, the sum over the cycles; but outside the first contact, where wear
    /// sets in as the contact edge passes within a step, by the slip.
    ///
    /// ```text
    /// w = S - S_0 - K
    /// ```
    fn depth_beyond(&self, stick: &StickEdge, offset: f64, point: Option<&AnnulusPoint>, worn: f64) -> f64 {
        let squared = self.model.stick_zone.stick_area + offset;
        let behind = self.model.moving().and_then(|it| it.left_behind_outside(stick, squared));
        match behind {
            Some(behind) => point.map_or(0.0, |point| (point.grown - behind).max(0.0)),
            None => worn,
        }
    }

    /// Whether an edge of stick that moves outwards has passed.
    fn sticks_at(&self, offset: f64) -> bool {
        let least = self.model.stick_zone.stick_area;
        self.state.stick.as_ref().is_some_and(|stick| least + offset <= stick.area)
    }
}

/// A point between the springs.
struct AnnulusPoint {
    /// `ξ`.
    x: f64,
    /// Its coordinate on the mesh.
    y: f64,
    /// Slip depth of the unworn contact, m.
    unworn: f64,
    /// `S - S_0`, m.
    grown: f64,
    /// The local polynomial there.
    local: Local,
}

impl AnnulusPoint {
    /// At least zero: next to the contact edge the polynomial may be negative, by less than the error of the run.
    fn wear_depth(&self) -> f64 {
        self.grown.max(0.0)
    }
}

/// Where fields are shown.
#[derive(Debug, Clone, Default)]
pub(super) struct OutputRadii {
    /// `r² - c²`, m², increasing.
    offsets: Vec<f64>,
    /// The unworn slip there.
    unworn: Vec<UnwornValues>,
    /// Heights of the unworn profile there, m, once they have been asked for.
    heights: OnceLock<Vec<f64>>,
}

impl OutputRadii {
    /// The springs of the limit without the first ones, or one in several where they are more than [`MOST_SHOWN`]. On a smooth mesh of few springs
    /// [`SHOWN`] radii, graded as the mesh is, from [`HIDDEN`] to the contact edge.
    pub(super) fn new(unworn: &UnwornSlip, mesh: &Mesh, hidden: usize) -> Self {
        let springs = &mesh.nodes()[1 + hidden..];
        let fractions: Vec<f64> = if mesh.clustering().follows_front() && springs.len() < SHOWN {
            let like = Mesh::new(SHOWN, mesh.stretch(), mesh.clustering());
            let first = like.place(HIDDEN);
            let spacing = (SHOWN as f64 - first) / (SHOWN - 1) as f64;
            (0..SHOWN).map(|i| like.at(SHOWN as f64 - spacing * (SHOWN - 1 - i) as f64).value).collect()
        } else {
            let every = springs.len().div_ceil(MOST_SHOWN);
            let skipped = (springs.len() - 1) % every;
            springs.iter().skip(skipped).step_by(every).copied().collect()
        };
        let offsets: Vec<f64> = fractions.iter().map(|x| unworn.limit_slip_area() * x).collect();
        let unworn = offsets.iter().map(|offset| unworn.at(*offset)).collect();
        Self { unworn, offsets, heights: OnceLock::new() }
    }

    /// `r² - c²`, m², and the unworn slip there.
    fn iter(&self) -> impl Iterator<Item = (f64, &UnwornValues)> {
        self.offsets.iter().copied().zip(&self.unworn)
    }

    /// `r² - c²`, m².
    pub(super) fn offsets(&self) -> &[f64] {
        &self.offsets
    }

    /// Depth that the limit takes away, m.
    pub(super) fn limit_depth(&self) -> Vec<f64> {
        self.unworn.iter().map(UnwornValues::limit_depth).collect()
    }
}
