//! The wearing contact in spring space: what is fixed during a run, what changes, and what follows from it.
//!
//! The springs sit at fixed fractions `ξ` of the slip annulus `c < x <= a`, whose outer edge moves with the wear: `x² = c² + Z ξ`,
//! `Z = a² - c²`. Archard's law for the slip depth `S = F(q_c - q)` at a fixed radius is `dS/dN = κ p S`, so the state that evolves is
//! the logarithm `λ = ln(S/S_0)`, and on the moving springs, with `W` the depth worn in a cycle (`κ p S` here),
//!
//! ```text
//! dλ/dN - ξ (∂λ/∂ξ) (dZ/dN)/Z = W/S,     κ = 4 k_w μ_f/M,     w = S - S_0,     w = 0 at the edge
//! ```
//!
//! Compressions and edge are what is stored ([`State`]); everything else is recomputed from them ([`Fields`]).

mod construction;
mod cycle;
mod derivatives;
mod edge_in_block;
mod envelope;
mod first_force;
mod gross;
mod jacobian;
mod loops;
mod meter;
mod motion;
mod moving;
mod operators;
mod output;
mod passes;
mod past;
mod resistance;
mod schedule;
mod slipping;
mod spreading;
mod stage;
mod surface;
mod whole;
mod worn_ground;

use std::f64::consts::PI;
use std::sync::Arc;

use crate::contact::InitialContact;
use crate::contact::slip_depth::{UnwornSlip, UnwornValues};
use crate::error::Result;
use crate::numerics::abel::{AbelOperators, Backend};
use crate::numerics::linear::in_parallel;
use crate::numerics::roots::{bracketed, next_to};
pub use construction::{FEWEST_SPRINGS, MOST_IN_GROSS_SLIP};
pub use cycle::CycleFields;
pub use gross::{Gross, GrossRates};
pub use jacobian::StageFactors;
pub use loops::FrettingLoop;
use meter::Meter;
pub use moving::{Bearing, MovingStick, StickEdge, StickStage, StickTarget, StickTrial};
pub use operators::OperatorStore;
use operators::Operators;
use output::OutputRadii;
pub use output::RadialFields;
pub use passes::PassSwing;
pub use past::{Linearised, Past, PastPoint};
pub use resistance::straightens;
pub use schedule::{AmplitudeControl, CycleLoading, Resolution, Schedule};
pub use stage::{Target, Unknowns};
pub use worn_ground::{Surroundings, WornGround};

/// Part of the annulus, next to the edge of stick, whose springs the output of a mesh that [`Clustering::follows_front`] leaves out. Wear proceeds towards the
/// edge in a front, which is followed well as long as some springs are left before it.
const HIDDEN: f64 = 3e-5;

/// What a restart needs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    /// Cycles done.
    pub cycles: f64,
    /// `Z = a² - c²`, m², of the contact edge `a`.
    pub slip_area: f64,
    /// Compression `q`, m, of the springs inside the contact edge, shape `(springs - 1,)`, outwards.
    pub compression: Vec<f64>,
    /// Energy dissipated by friction since the start, J.
    pub dissipated_energy: f64,
    /// Worn volume by the rates of the cycles, m³: from the dissipated energy where the two are in proportion.
    pub volume_by_rate: f64,
    /// Smallest stick radius of the cycles so far, m; infinite before the first.
    pub least_stick_radius: f64,
    /// Mean rate of the edge in the last step, m² per cycle; zero at the start. A first guess for the next step.
    pub slip_area_rate: f64,
    /// Mean rates of the compressions in the last step, m per cycle, shape `(springs - 1,)`; zero at the start.
    pub compression_rate: Vec<f64>,
    /// Squared radius, m², within which no spring slips as long as the block under way lasts; zero where compressions alone decide.
    pub resting_area: f64,
    /// The edge of stick, where that moves.
    pub stick: Option<StickEdge>,
    /// Ground that blocks at other indentations have worn in gross slip, and how deep the one under way presses; none at the largest indentation on unworn ground.
    pub ground: Option<Arc<WornGround>>,
    /// The times before, for a multistep method.
    pub past: Past,
}

/// What follows from a state, on the springs `ξ_1 ... ξ_n` of which the last is the contact edge.
#[derive(Debug, Clone, Default)]
pub struct Fields {
    /// The stick zone, at whose edge the mesh begins.
    pub stick_zone: StickZone,
    /// `Z = a² - c²`, m².
    pub slip_area: f64,
    /// `x^(k-1)`, the factor from compression to density.
    pub density_factor: Vec<f64>,
    /// `F q`, m.
    pub elastic_depth: Vec<f64>,
    /// Slip depth `S = F(q_c - q)`, m; the slip amplitude is `μ_f/M` times it.
    pub slip_depth: Vec<f64>,
    /// `λ = ln(S/S_0)`.
    pub log_slip: Vec<f64>,
    /// Wear depth `w`, m.
    pub wear_depth: Vec<f64>,
    /// Pressure `p`, Pa.
    pub pressure: Vec<f64>,
    /// The unworn slip at the same radii.
    pub unworn: Vec<UnwornValues>,
    density: Vec<f64>,
    ground: Option<Arc<WornGround>>,
}

/// The stick zone, at whose edge the mesh begins.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StickZone {
    /// `c²`, m².
    pub stick_area: f64,
    /// Compression `q_c` below which springs slip, m: that of the springs there, and more where the contact is in gross slip.
    pub slip_compression: f64,
    /// `∫_0^c x^k q dx`, m^(2+k).
    pub stick_load: f64,
}

impl Fields {
    /// Whether slip is positive at every spring and every number is finite. Compressions can be such that no contact has them.
    pub fn are_physical(&self) -> bool {
        self.slip_depth.iter().all(|s| *s > 0.0 && s.is_finite())
            && self.pressure.iter().all(|p| p.is_finite())
    }
}

/// One wearing contact on its springs; immutable during a run.
#[derive(Debug, Clone)]
pub struct Model {
    contact: InitialContact,
    schedule: Schedule,
    mesh: SpringMesh,
    /// Where the output shows the fields.
    output: OutputRadii,
    /// The stick zone; the smallest one where its edge moves.
    stick_zone: StickZone,
    depth_scale: f64,
    slides: bool,
    meter: Meter,
}

/// Where the springs are.
#[derive(Debug, Clone)]
enum SpringMesh {
    /// From the edge of stick to the contact edge.
    Annulus(Box<AnnulusMesh>),
    /// From the axis to the contact edge, in gross slip.
    Whole(Box<Gross>),
}

/// The slip annulus around a stick zone.
#[derive(Debug, Clone)]
struct AnnulusMesh {
    unworn: UnwornSlip,
    operators: Arc<Operators>,
    /// The unworn slip on the springs of the limit.
    radial_unworn: Vec<UnwornValues>,
    /// Springs next to the edge of stick that the output does not show.
    hidden: usize,
    moving: Option<MovingStick>,
}

impl Model {
    /// The mesh of the slip annulus, which a contact in gross slip does not have.
    fn annulus(&self) -> &AnnulusMesh {
        match &self.mesh {
            SpringMesh::Annulus(annulus) => annulus,
            SpringMesh::Whole(_) => unreachable!("gross slip is stepped and read off over the whole contact"),
        }
    }

    /// The unworn contact.
    pub fn contact(&self) -> &InitialContact {
        &self.contact
    }

    /// Whether there is gross slip in some cycle, or all stick is lost in the end.
    pub fn slides(&self) -> bool {
        self.slides
    }

    /// Whether wear has no kinks, neither along the slip annulus nor in time.
    pub fn wears_smoothly(&self) -> bool {
        self.wears_steadily() && self.schedule.wears_smoothly() && !self.comes_to_gross_slip()
    }

    /// Whether every cycle is the same, with weak kinks at most, and the edge of stick rests, so that wear is nearly smooth in time.
    pub fn wears_steadily(&self) -> bool {
        let rests = self.moving().is_none() || self.bears_both_forces();
        self.schedule.wears_nearly_smoothly() && rests && !self.slides
    }

    /// Whether wear goes on as long as the contact is moved: in gross slip under a held normal force.
    pub fn wears_without_end(&self) -> bool {
        self.gross().is_some_and(Gross::holds_force)
    }

    /// What acts when.
    pub fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    /// Cycles in which wear at the first pressures would be as deep as the compression at the edge of stick.
    pub fn cycles_of_wear(&self) -> f64 {
        self.contact.indentation() / (self.contact.slip_compression() * self.contact.tau_per_cycle())
    }

    /// The transforms.
    pub fn operators(&self) -> &AbelOperators {
        &self.annulus().operators.abel
    }

    /// The unworn slip.
    pub fn unworn(&self) -> &UnwornSlip {
        &self.annulus().unworn
    }

    /// Frees memory that only explicit steps and the search for a state need, where it is much.
    pub fn release_factors(&self) {
        if let SpringMesh::Annulus(annulus) = &self.mesh {
            annulus.operators.release_factors();
        }
    }

    /// Number of springs, the contact edge included.
    pub fn springs(&self) -> usize {
        self.gross().map_or_else(|| self.annulus().operators.abel.len(), Gross::springs)
    }

    /// Largest depth of the limit on the springs, m: what tolerances are relative to.
    pub fn depth_scale(&self) -> f64 {
        self.depth_scale
    }

    /// Radii of the output, m, shape `(node,)`, increasing from just outside the stick radius to the limiting contact radius.
    pub fn radii(&self) -> Vec<f64> {
        self.offsets().iter().map(|offset| (self.stick_zone.stick_area + offset).sqrt()).collect()
    }

    /// `r² - c²`, m², at [`Model::radii`], without the rounding of the radii.
    pub fn offsets(&self) -> Vec<f64> {
        self.output.offsets().to_vec()
    }

    /// The unworn state: the edge and the compressions whose wear depth is zero at every spring.
    ///
    /// # Errors
    /// [`Error::NotConverged`] if no edge is found.
    pub fn initial_state(&self) -> Result<State> {
        if let Some(gross) = self.gross() {
            return self.gross_initial_state(gross);
        }
        let stick = self.moving().map(|moving| moving.start(self)).transpose()?;
        let stick_zone = self.stick_zone_in(stick.as_ref(), &self.schedule.loading(0.0, 0.0));
        let guess = self.contact.contact_radius().powi(2) - stick_zone.stick_area;
        let guess = if stick.is_some() { guess } else { self.contact.slip_area_offset() };
        let limit =
            self.annulus().unworn.limit_slip_area() + self.stick_zone.stick_area - stick_zone.stick_area;
        let mismatch = |slip_area: f64| self.mismatch_at(&stick_zone, slip_area, |_, values| values.slip);
        let slip_area = match self.annulus().operators.abel.backend() {
            Backend::Dense => {
                let (mut low, mut high) = (0.98 * guess, (1.02 * guess).min(limit));
                while mismatch(low) < 0.0 && low > 0.5 * guess {
                    low *= 0.98;
                }
                while mismatch(high) > 0.0 && high < limit {
                    high = (1.02 * high).min(limit);
                }
                bracketed(mismatch, low, high, 0.0)?
            }
            // On so many springs the guess is nearly right, and an evaluation takes long.
            Backend::Hierarchical => next_to(mismatch, guess),
        };
        let compression = self.compression_at(&stick_zone, slip_area, |_, values| values.slip);
        Ok(self.with_resting_area(self.close_force(State {
            cycles: 0.0,
            slip_area,
            compression_rate: vec![0.0; compression.len()],
            compression,
            dissipated_energy: 0.0,
            volume_by_rate: 0.0,
            least_stick_radius: f64::INFINITY,
            slip_area_rate: 0.0,
            resting_area: 0.0,
            stick,
            ground: None,
            past: Past::default(),
        })))
    }

    /// Wear depth at the edge, m, of the compressions that give the inner springs the slip depth `slip(spring, unworn)`; zero at the
    /// true contact edge.
    pub fn contact_edge_mismatch(&self, slip_area: f64, slip: impl Fn(usize, &UnwornValues) -> f64) -> f64 {
        self.mismatch_at(&self.stick_zone, slip_area, slip)
    }

    pub(super) fn mismatch_at(
        &self,
        stick_zone: &StickZone,
        slip_area: f64,
        slip: impl Fn(usize, &UnwornValues) -> f64,
    ) -> f64 {
        let inner = self.springs() - 1;
        let values: Vec<_> = self.unworn_on_springs(stick_zone, slip_area).collect();
        let elastic = |(i, values): (usize, &UnwornValues)| values.limit_slip - slip(i, values);
        let carried =
            self.annulus().operators.depth_at_edge(values.iter().take(inner).enumerate().map(elastic));
        values[inner].limit_slip - values[inner].slip - carried
    }

    /// Compressions, m, that give the inner springs the slip depth `slip(spring, unworn)` with the contact edge at `edge`.
    pub fn compression(&self, slip_area: f64, slip: impl Fn(usize, &UnwornValues) -> f64) -> Vec<f64> {
        self.compression_at(&self.stick_zone, slip_area, slip)
    }

    pub(super) fn compression_at(
        &self,
        stick_zone: &StickZone,
        slip_area: f64,
        slip: impl Fn(usize, &UnwornValues) -> f64,
    ) -> Vec<f64> {
        let inner = self.springs() - 1;
        let values: Vec<_> = self.unworn_on_springs(stick_zone, slip_area).collect();
        let depth = |(i, v): (usize, &UnwornValues)| v.limit_slip - slip(i, v);
        let mut solution: Vec<f64> = values.iter().take(inner).enumerate().map(depth).collect();
        self.annulus().operators.solve_profile(&mut solution);
        let (scale, at_stick) = (slip_area.powf(-self.mu()), self.density_factor_at_stick(stick_zone));
        for (q, v) in solution.iter_mut().zip(&values) {
            *q *= scale / (at_stick * self.density_ratio(v));
        }
        solution
    }

    /// Recomputes everything that follows from an edge, m², and the compressions, m, shape `(springs - 1,)`.
    pub fn evaluate(&self, slip_area: f64, compression: &[f64], fields: &mut Fields) {
        self.evaluate_at(&self.stick_zone, slip_area, compression, fields);
    }

    /// As [`Model::evaluate`], with the mesh beginning at another edge of stick.
    pub fn evaluate_at(
        &self,
        stick_zone: &StickZone,
        slip_area: f64,
        compression: &[f64],
        fields: &mut Fields,
    ) {
        let n = self.springs();
        fields.stick_zone = *stick_zone;
        let (mu, stiffness) = (self.mu(), self.contact.half_space().normal_stiffness());
        fields.slip_area = slip_area;
        for part in [
            &mut fields.density_factor,
            &mut fields.elastic_depth,
            &mut fields.slip_depth,
            &mut fields.log_slip,
            &mut fields.wear_depth,
            &mut fields.pressure,
        ] {
            part.resize(n, 0.0);
        }
        let nodes = &self.annulus().operators.abel.nodes()[1..];
        fields.unworn.resize(n, UnwornValues::default());
        let fill = |first: usize, part: &mut [UnwornValues]| {
            let stick = self.moving().map(|_| [stick_zone.stick_area, stick_zone.slip_compression]);
            self.annulus().unworn.fill(stick, |i| slip_area * nodes[first + i], part);
        };
        match self.annulus().operators.abel.backend() {
            Backend::Dense => fill(0, &mut fields.unworn),
            Backend::Hierarchical => in_parallel(&mut fields.unworn, 1, fill),
        }
        let at_stick = self.density_factor_at_stick(stick_zone);
        let unworn = &fields.unworn;
        self.on_springs(&mut fields.density_factor, |i| at_stick * self.density_ratio(&unworn[i]));
        fields.density.clear();
        fields.density.extend(compression.iter().zip(&fields.density_factor).map(|(q, factor)| q * factor));
        let [profile, pressure] = self.annulus().operators.abel.transforms();
        profile.apply(&fields.density, &mut fields.elastic_depth);
        pressure.apply(compression, &mut fields.pressure);
        let (profile_scale, pressure_scale) = (slip_area.powf(mu), stiffness / PI * slip_area.powf(-mu));
        for (i, values) in fields.unworn.iter().enumerate() {
            fields.elastic_depth[i] *= profile_scale;
            fields.pressure[i] *= pressure_scale;
            fields.slip_depth[i] = values.limit_slip - fields.elastic_depth[i];
            fields.wear_depth[i] = fields.slip_depth[i] - values.slip;
        }
        let slip = &fields.slip_depth;
        self.on_springs(&mut fields.log_slip, |i| (slip[i] / unworn[i].slip).ln());
    }

    /// Computes something at every spring, side by side where they are many.
    fn on_springs<T: Send>(&self, values: &mut [T], value: impl Fn(usize) -> T + Sync) {
        let fill = |first: usize, part: &mut [T]| {
            part.iter_mut().enumerate().for_each(|(i, to)| *to = value(first + i));
        };
        match self.annulus().operators.abel.backend() {
            Backend::Dense => fill(0, values),
            Backend::Hierarchical => in_parallel(values, 1, fill),
        }
    }

    /// The fields of a state.
    pub fn fields(&self, state: &State) -> Fields {
        if let Some(gross) = self.gross() {
            return self.gross_fields(gross, state);
        }
        let mut fields = Fields::default();
        let loading = self.schedule.loading(state.cycles, state.cycles);
        let stick_zone = self.stick_zone_in(state.stick.as_ref(), &loading);
        self.evaluate_at(&stick_zone, state.slip_area, &state.compression, &mut fields);
        fields
    }

    /// Contact radius `a`, m.
    pub fn contact_radius(&self, state: &State) -> f64 {
        let stick_area = state.stick.as_ref().map_or(self.stick_zone.stick_area, |stick| stick.area);
        (stick_area + state.slip_area).sqrt()
    }

    /// Depth that the limit takes away at [`Model::radii`] by the program's own quadrature, m.
    pub fn limit_depth(&self) -> Vec<f64> {
        self.output.limit_depth()
    }

    /// The unworn slip on every spring, with the contact edge at `edge`.
    fn unworn_on_springs(
        &self,
        stick_zone: &StickZone,
        slip_area: f64,
    ) -> impl Iterator<Item = UnwornValues> {
        let stick_zone = *stick_zone;
        self.annulus().operators.abel.nodes()[1..]
            .iter()
            .map(move |x| self.unworn_at(&stick_zone, slip_area * x))
    }

    /// The unworn slip at `z = r² - c²`, m², of the edge of a stick zone.
    fn unworn_at(&self, stick_zone: &StickZone, z: f64) -> UnwornValues {
        match self.moving() {
            None => self.annulus().unworn.at(z),
            Some(_) => self.annulus().unworn.at_stick(stick_zone.stick_area, stick_zone.slip_compression, z),
        }
    }

    /// `μ = (1-k)/2`, the exponent with which the transforms scale with the edge.
    pub(crate) fn mu(&self) -> f64 {
        0.5 * (1.0 - self.contact.half_space().grading())
    }

    /// `c^(k-1)`.
    fn density_factor_at_stick(&self, stick_zone: &StickZone) -> f64 {
        stick_zone.stick_area.powf(-self.mu())
    }

    /// `(x/c)^(k-1)`.
    fn density_ratio(&self, values: &UnwornValues) -> f64 {
        (-self.mu() * values.logarithm).exp()
    }
}
