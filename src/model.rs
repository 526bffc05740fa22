//! The wearing contact in spring space: what is fixed during a run, what changes, and what follows from it.
//!
//! The springs sit at fixed fractions `ξ` of the slip annulus `c < x <= a`, whose outer edge moves with the wear: `x² = c² + Z ξ`,
//! `Z = a² - c²`. Archard's law for the slip depth `S = F(q_c - q)` at a fixed radius is `dS/dN = κ p S`, so the state that evolves is
//! the logarithm `λ = ln(S/S_0)`, and on the moving springs
//!
//! ```text
//! dλ/dN - ξ (∂λ/∂ξ) (dZ/dN)/Z = κ p,     κ = 4 k_w μ_f/M,     w = S - S_0,     w = 0 at the edge
//! ```
//!
//! Compressions and edge are what is stored ([`State`]); everything else is recomputed from them ([`Fields`]).

use std::f64::consts::PI;

use faer::Mat;

use crate::abel::AbelOperators;
use crate::contact::InitialContact;
use crate::error::{Error, Result};
use crate::grid::{Clustering, lagrange, lagrange_derivative, slip_annulus, stencil_start};
use crate::linear::{Factors, dot, multiply};
use crate::roots::bracketed;
use crate::slip_depth::{UnwornSlip, UnwornValues};

/// Degree of the local polynomials of the transforms, of the derivative along the annulus and of output between the springs.
const DEGREE: usize = 3;
const POINTS: usize = DEGREE + 1;

/// Fewest springs on which the local polynomials fit.
pub const FEWEST_SPRINGS: usize = 8;

/// What a restart needs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    /// Cycles done.
    pub cycles: f64,
    /// `Z = a² - c²`, m², of the contact edge `a`.
    pub edge: f64,
    /// Compression `q`, m, of the springs inside the contact edge, shape `(springs - 1,)`, outwards.
    pub compression: Vec<f64>,
    /// Energy dissipated by friction since the start, J.
    pub dissipated_energy: f64,
    /// Mean rate of the edge in the last step, m² per cycle; zero at the start. A first guess for the next step.
    pub edge_rate: f64,
    /// Mean rates of the compressions in the last step, m per cycle, shape `(springs - 1,)`; zero at the start.
    pub compression_rate: Vec<f64>,
}

/// What follows from a state, on the springs `ξ_1 ... ξ_n` of which the last is the contact edge.
#[derive(Debug, Clone, Default)]
pub struct Fields {
    /// `Z = a² - c²`, m².
    pub edge: f64,
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
}

impl Fields {
    /// Whether slip is positive at every spring and every number finite: a state may exist that is none of a contact.
    pub fn are_physical(&self) -> bool {
        self.slip_depth.iter().all(|s| *s > 0.0 && s.is_finite())
            && self.pressure.iter().all(|p| p.is_finite())
    }
}

/// The fields on the fixed radii of the output, shape `(springs,)` each.
#[derive(Debug, Clone, PartialEq)]
pub struct RadialFields {
    /// Wear depth, m.
    pub wear_depth: Vec<f64>,
    /// Pressure, Pa, zero outside the contact.
    pub pressure: Vec<f64>,
    /// Slip amplitude, m, zero outside the contact.
    pub slip: Vec<f64>,
}

/// One wearing contact on its springs; immutable during a run.
#[derive(Debug, Clone)]
pub struct Model {
    contact: InitialContact,
    unworn: UnwornSlip,
    operators: AbelOperators,
    /// LU factors of `F` without the edge.
    profile_factors: Factors,
    /// Row of `F` at the edge times the inverse of the rest.
    edge_row: Vec<f64>,
    derivative: Vec<Stencil>,
    radial_unworn: Vec<UnwornValues>,
    stick_radius_squared: f64,
    stick_force: f64,
    wear_factor: f64,
    depth_scale: f64,
}

/// Weights of a derivative `ξ d/dξ` at one spring.
#[derive(Debug, Clone, Copy)]
struct Stencil {
    first: usize,
    weights: [f64; POINTS],
}

impl Model {
    /// Puts a contact in partial slip on springs.
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if the contact does not slip in part; [`Error::OutOfRange`] for too few springs; those of the transforms.
    pub fn new(contact: &InitialContact, springs: usize, clustering: Clustering) -> Result<Self> {
        let stick_radius = contact.stick_radius().filter(|_| contact.slip_compression() > 0.0);
        let stick_radius = stick_radius.ok_or_else(|| Error::Inconsistent {
            what: "slip annulus",
            why: format!(
                "the contact is in the regime {:?}, and wear is stepped in partial slip only",
                contact.regime()
            ),
        })?;
        if springs < FEWEST_SPRINGS {
            return Err(Error::OutOfRange {
                name: "numerics.springs",
                value: springs as f64,
                range: "[8, inf)",
            });
        }
        let profile = contact.equivalent_profile();
        let grading = profile.grading();
        let unworn =
            UnwornSlip::new(profile, stick_radius, contact.slip_compression(), contact.slip_area_offset())?;
        let stick_radius_squared = stick_radius * stick_radius;
        let stretch = (unworn.limit_edge() / stick_radius_squared).ln_1p();
        let operators = AbelOperators::new(grading, slip_annulus(springs, stretch, clustering), DEGREE)?;
        let inner = springs - 1;
        let profile_factors = Factors::new(operators.profile().submatrix(0, 0, inner, inner).to_owned());
        let mut edge_row: Vec<f64> = (0..inner).map(|j| operators.profile()[(inner, j)]).collect();
        profile_factors.solve_transposed(&mut edge_row);
        let radial_unworn: Vec<_> =
            operators.nodes()[1..].iter().map(|x| unworn.at(unworn.limit_edge() * x)).collect();
        let half_space = contact.half_space();
        let compression = contact.slip_compression();
        let stick_force = half_space.normal_stiffness()
            * (profile.load_integral(stick_radius)
                + 2.0 * compression * stick_radius.powf(1.0 + grading) / (1.0 + grading));
        let depth_scale = radial_unworn.iter().map(|u| u.limit_slip - u.slip).fold(0.0, f64::max);
        let wear_factor =
            4.0 * contact.wear().coefficient * contact.friction().coefficient / half_space.stiffness_ratio();
        Ok(Self {
            contact: contact.clone(),
            derivative: derivative_stencils(operators.nodes()),
            unworn,
            operators,
            profile_factors,
            edge_row,
            radial_unworn,
            stick_radius_squared,
            stick_force,
            wear_factor,
            depth_scale,
        })
    }

    /// The unworn contact.
    pub fn contact(&self) -> &InitialContact {
        &self.contact
    }

    /// The transforms.
    pub fn operators(&self) -> &AbelOperators {
        &self.operators
    }

    /// The unworn slip.
    pub fn unworn(&self) -> &UnwornSlip {
        &self.unworn
    }

    /// Number of springs, the contact edge included.
    pub fn springs(&self) -> usize {
        self.operators.len()
    }

    /// Largest depth of the limit on the springs, m: what tolerances are relative to.
    pub fn depth_scale(&self) -> f64 {
        self.depth_scale
    }

    /// `κ = 4 k_w μ_f/M`, 1/Pa: slip depth grows by `κ p` of itself in a cycle under Archard's law.
    pub fn wear_factor(&self) -> f64 {
        self.wear_factor
    }

    /// Radii of the output, m, shape `(springs,)`, increasing from just outside the stick radius to the limiting contact radius.
    pub fn radii(&self) -> Vec<f64> {
        let limit = self.unworn.limit_edge();
        self.operators.nodes()[1..].iter().map(|x| (self.stick_radius_squared + limit * x).sqrt()).collect()
    }

    /// `r² - c²`, m², at [`Model::radii`], without the rounding of the radii.
    pub fn offsets(&self) -> Vec<f64> {
        self.operators.nodes()[1..].iter().map(|x| self.unworn.limit_edge() * x).collect()
    }

    /// The unworn state: the edge and the compressions whose wear depth is zero at every spring.
    ///
    /// # Errors
    /// [`Error::NotConverged`] if no edge is found.
    pub fn initial_state(&self) -> Result<State> {
        let guess = self.contact.slip_area_offset();
        let limit = self.unworn.limit_edge();
        let (mut low, mut high) = (0.98 * guess, (1.02 * guess).min(limit));
        while self.edge_mismatch(low, |_, values| values.slip) < 0.0 && low > 0.5 * guess {
            low *= 0.98;
        }
        while self.edge_mismatch(high, |_, values| values.slip) > 0.0 && high < limit {
            high = (1.02 * high).min(limit);
        }
        let edge = bracketed(|edge| self.edge_mismatch(edge, |_, values| values.slip), low, high, 0.0)?;
        let compression = self.compression(edge, |_, values| values.slip);
        Ok(State {
            cycles: 0.0,
            edge,
            compression_rate: vec![0.0; compression.len()],
            compression,
            dissipated_energy: 0.0,
            edge_rate: 0.0,
        })
    }

    /// Wear depth at the edge, m, of the compressions that give the inner springs the slip depth `slip(spring, unworn)`; zero at the
    /// true contact edge.
    pub fn edge_mismatch(&self, edge: f64, slip: impl Fn(usize, &UnwornValues) -> f64) -> f64 {
        let inner = self.springs() - 1;
        let at = |i: usize| self.unworn.at(edge * self.operators.nodes()[i + 1]);
        let elastic = |i: usize| {
            let values = at(i);
            values.limit_slip - slip(i, &values)
        };
        let last = at(inner);
        let carried: f64 = (0..inner).map(|i| self.edge_row[i] * elastic(i)).sum();
        last.limit_slip - last.slip - carried
    }

    /// Compressions, m, that give the inner springs the slip depth `slip(spring, unworn)` with the contact edge at `edge`.
    pub fn compression(&self, edge: f64, slip: impl Fn(usize, &UnwornValues) -> f64) -> Vec<f64> {
        let inner = self.springs() - 1;
        let values: Vec<_> =
            (0..inner).map(|i| self.unworn.at(edge * self.operators.nodes()[i + 1])).collect();
        let mut solution: Vec<f64> =
            values.iter().enumerate().map(|(i, v)| v.limit_slip - slip(i, v)).collect();
        self.profile_factors.solve(&mut solution);
        let scale = edge.powf(-self.mu());
        for (q, v) in solution.iter_mut().zip(&values) {
            *q *= scale / self.density_factor(v);
        }
        solution
    }

    /// Recomputes everything that follows from an edge, m², and the compressions, m, shape `(springs - 1,)`.
    pub fn evaluate(&self, edge: f64, compression: &[f64], fields: &mut Fields) {
        let n = self.springs();
        let (mu, stiffness) = (self.mu(), self.contact.half_space().normal_stiffness());
        fields.edge = edge;
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
        fields.unworn.clear();
        fields.unworn.extend(self.operators.nodes()[1..].iter().map(|x| self.unworn.at(edge * x)));
        for (factor, values) in fields.density_factor.iter_mut().zip(&fields.unworn) {
            *factor = self.density_factor(values);
        }
        fields.density.clear();
        fields.density.extend(compression.iter().zip(&fields.density_factor).map(|(q, factor)| q * factor));
        multiply(self.operators.profile().as_ref(), &fields.density, &mut fields.elastic_depth);
        multiply(self.operators.pressure().as_ref(), compression, &mut fields.pressure);
        let (profile_scale, pressure_scale) = (edge.powf(mu), stiffness / PI * edge.powf(-mu));
        for (i, values) in fields.unworn.iter().enumerate() {
            fields.elastic_depth[i] *= profile_scale;
            fields.pressure[i] *= pressure_scale;
            fields.slip_depth[i] = values.limit_slip - fields.elastic_depth[i];
            fields.log_slip[i] = (fields.slip_depth[i] / values.slip).ln();
            fields.wear_depth[i] = fields.slip_depth[i] - values.slip;
        }
    }

    /// The fields of a state.
    pub fn fields(&self, state: &State) -> Fields {
        let mut fields = Fields::default();
        self.evaluate(state.edge, &state.compression, &mut fields);
        fields
    }

    /// `ξ ∂λ/∂ξ` at every spring, for any quantity given there, shape `(springs,)`.
    pub fn along_annulus(&self, values: &[f64]) -> Vec<f64> {
        self.derivative.iter().map(|s| dot(&s.weights, &values[s.first..s.first + POINTS])).collect()
    }

    /// Derivative of the elastic depth `F q` by the edge at constant compressions, dimensionless per m, shape `(springs,)`.
    pub fn elastic_depth_by_edge(&self, fields: &Fields) -> Vec<f64> {
        let mu = self.mu();
        let nodes = &self.operators.nodes()[1..];
        let moved: Vec<f64> = fields
            .density
            .iter()
            .zip(nodes)
            .map(|(u, x)| -mu * u * x / (self.stick_radius_squared + fields.edge * x))
            .collect();
        let mut change = vec![0.0; self.springs()];
        multiply(self.operators.profile().as_ref(), &moved, &mut change);
        let scale = fields.edge.powf(mu);
        change
            .iter()
            .zip(&fields.elastic_depth)
            .map(|(c, depth)| scale * c + mu / fields.edge * depth)
            .collect()
    }

    /// Derivative of `λ` by the edge at constant compressions, 1/m², shape `(springs,)`.
    pub fn log_slip_by_edge(&self, fields: &Fields) -> Vec<f64> {
        let elastic = self.elastic_depth_by_edge(fields);
        let nodes = &self.operators.nodes()[1..];
        let rate = |i: usize| {
            let slopes = self.unworn.slopes(&fields.unworn[i]);
            (nodes[i] * slopes.limit_slip - elastic[i]) / fields.slip_depth[i] - nodes[i] * slopes.log_slip
        };
        (0..nodes.len()).map(rate).collect()
    }

    /// Derivative of the elastic depth by the compressions: `Z^(1-ν) F_ij x_j^(k-1)`, shape `(springs, springs - 1)`.
    pub fn elastic_depth_by_compression(&self, fields: &Fields, i: usize, j: usize) -> f64 {
        self.operators.profile()[(i, j)] * fields.density_factor[j]
    }

    /// Rates per cycle of the edge, m², and of the compressions, m, under Archard's law: the closed-form cycle as an explicit
    /// differential equation.
    pub fn rates(&self, fields: &Fields) -> (f64, Vec<f64>) {
        let inner = self.springs() - 1;
        let by_edge = self.log_slip_by_edge(fields);
        let along = self.along_annulus(&fields.log_slip);
        let slip = &fields.slip_depth;
        let mut worn: Vec<f64> =
            (0..inner).map(|i| -self.wear_factor * fields.pressure[i] * slip[i]).collect();
        let mut moved: Vec<f64> =
            (0..inner).map(|i| slip[i] * (by_edge[i] - along[i] / fields.edge)).collect();
        // At the edge, where wear is zero: F q' = ∂(F q_0 - F q)/∂Z Z'.
        let edge_slope = slip[inner] * by_edge[inner];
        let edge_rate = -dot(&self.edge_row, &worn) / (dot(&self.edge_row, &moved) - edge_slope);
        self.profile_factors.solve(&mut worn);
        self.profile_factors.solve(&mut moved);
        let scale = fields.edge.powf(-self.mu());
        let rate = |i: usize| scale / fields.density_factor[i] * (worn[i] + moved[i] * edge_rate);
        (edge_rate, (0..inner).map(rate).collect())
    }

    /// Moves the edge to where the wear depth of the compressions is zero.
    pub fn close_edge(&self, edge: f64, compression: &[f64]) -> Result<f64> {
        let last = self.springs() - 1;
        let mut edge = edge;
        let mut fields = Fields::default();
        for _ in 0..20 {
            self.evaluate(edge, compression, &mut fields);
            let slopes = self.unworn.slopes(&fields.unworn[last]);
            let slope = slopes.limit_slip
                - fields.unworn[last].slip * slopes.log_slip
                - self.elastic_depth_by_edge(&fields)[last];
            let change = -fields.wear_depth[last] / slope;
            edge += change;
            if change.abs() <= 1e-15 * edge {
                return Ok(edge);
            }
            if !(edge > 0.0 && edge < self.unworn.largest_edge()) {
                break;
            }
        }
        Err(Error::NotConverged {
            what: "contact edge",
            why: format!("a² - c² = {edge:e} m² after 20 iterations"),
        })
    }

    /// Worn volume `2π ∫ w r dr`, m³ [S, Eq. (4)].
    pub fn wear_volume(&self, fields: &Fields) -> f64 {
        PI * fields.edge * dot(self.operators.depth_sum(), &fields.wear_depth)
    }

    /// Normal force, N [S, Eq. (22)].
    pub fn normal_force(&self, fields: &Fields) -> f64 {
        self.stick_force
            + self.contact.half_space().normal_stiffness()
                * fields.edge
                * dot(&self.operators.spring_sum()[..fields.density.len()], &fields.density)
    }

    /// Energy that friction dissipates in one cycle, J.
    ///
    /// ```text
    /// W = 8 μ_f c_N ∫_c^a x^k q (μ_f/M) (q_c - q) dx
    /// ```
    pub fn dissipation(&self, fields: &Fields, compression: &[f64]) -> f64 {
        let friction = self.contact.friction().coefficient;
        let half_space = self.contact.half_space();
        let slipping = self.contact.slip_compression();
        let sum: f64 = compression
            .iter()
            .zip(&fields.density)
            .zip(self.operators.spring_sum())
            .map(|((q, u), weight)| weight * u * (slipping - q))
            .sum();
        4.0 * friction * friction / half_space.stiffness_ratio()
            * half_space.normal_stiffness()
            * fields.edge
            * sum
    }

    /// Worn volume per cycle, m³: Archard's law on the dissipated energy, `k_w W/μ_f`.
    pub fn wear_rate(&self, fields: &Fields, compression: &[f64]) -> f64 {
        self.dissipation(fields, compression) * self.contact.wear().coefficient
            / self.contact.friction().coefficient
    }

    /// Contact radius `a`, m.
    pub fn contact_radius(&self, state: &State) -> f64 {
        (self.stick_radius_squared + state.edge).sqrt()
    }

    /// The fields at [`Model::radii`], by local cubic interpolation between the springs.
    pub fn radial_fields(&self, fields: &Fields) -> RadialFields {
        let n = self.springs();
        let nodes = self.operators.nodes();
        let nu = 1.0 - self.mu();
        let slip_per_depth =
            self.contact.friction().coefficient / self.contact.half_space().stiffness_ratio();
        let eased: Vec<f64> =
            (0..n - 1).map(|i| fields.pressure[i] * (1.0 - nodes[i + 1]).powf(-nu)).collect();
        let mut radial =
            RadialFields { wear_depth: vec![0.0; n], pressure: vec![0.0; n], slip: vec![0.0; n] };
        let mut cell = 1;
        for i in 0..n {
            let x = nodes[i + 1] * (self.unworn.limit_edge() / fields.edge);
            if x >= 1.0 {
                break;
            }
            while nodes[cell + 1] < x {
                cell += 1;
            }
            let log_slip = interpolate(&nodes[1..], &fields.log_slip, cell, x);
            let unworn = self.radial_unworn[i].slip;
            radial.wear_depth[i] = unworn * log_slip.exp_m1();
            radial.slip[i] = slip_per_depth * unworn * log_slip.exp();
            radial.pressure[i] = interpolate(&nodes[1..n], &eased, cell, x) * (1.0 - x).powf(nu);
        }
        radial
    }

    /// Depth that the limit takes away at [`Model::radii`] by the program's own quadrature, m.
    pub fn limit_depth(&self) -> Vec<f64> {
        self.radial_unworn.iter().map(|u| (u.limit_slip - u.slip).max(0.0)).collect()
    }

    fn mu(&self) -> f64 {
        0.5 * (1.0 - self.contact.half_space().grading())
    }

    /// `x^(k-1) = s^(ν-1)`.
    fn density_factor(&self, values: &UnwornValues) -> f64 {
        let mu = self.mu();
        self.stick_radius_squared.powf(-mu) * (-mu * values.logarithm).exp()
    }

    /// Adds the derivatives of `λ` by the compressions, from the left times `I - θ ξ ∂/∂ξ`, to the leading columns of a matrix.
    pub fn add_log_slip_by_compression(&self, fields: &Fields, theta: f64, matrix: &mut Mat<f64>) {
        let n = self.springs();
        let scale = fields.edge.powf(self.mu());
        let per_slip: Vec<f64> = fields.slip_depth.iter().map(|s| -scale / s).collect();
        let mut changed = vec![0.0; n];
        for j in 0..n - 1 {
            // Cells inside a radius add nothing to it but through the stencils that reach one node back and two ahead.
            let first = j.saturating_sub(POINTS);
            let factor = fields.density_factor[j];
            let column = self.operators.profile().col_as_slice(j);
            for ((change, column), slip) in changed.iter_mut().zip(column).zip(&per_slip).skip(first) {
                *change = factor * column * slip;
            }
            let rows = matrix.col_as_slice_mut(j).iter_mut().zip(&self.derivative);
            for (i, (entry, stencil)) in rows.enumerate().take(n - 1).skip(first) {
                let along = dot(&stencil.weights, &changed[stencil.first..stencil.first + POINTS]);
                *entry += changed[i] - theta * along;
            }
            changed[first] = 0.0;
        }
    }
}

fn derivative_stencils(nodes: &[f64]) -> Vec<Stencil> {
    let last = nodes.len() - 1;
    let stencil = |node: usize| {
        // The material moves inwards past the springs, so the stencil leans outwards.
        let start = stencil_start(node, POINTS, last);
        let mut weights = [0.0; POINTS];
        lagrange_derivative(&nodes[start..start + POINTS], nodes[node], &mut weights);
        Stencil { first: start - 1, weights: weights.map(|w| w * nodes[node]) }
    };
    (1..=last).map(stencil).collect()
}

/// Local cubic interpolation at `x` in cell `cell` between nodes given from the first spring on.
fn interpolate(nodes: &[f64], values: &[f64], cell: usize, x: f64) -> f64 {
    let start = stencil_start(cell, POINTS, values.len()).min(values.len() + 1 - POINTS) - 1;
    let mut weights = [0.0; POINTS];
    lagrange(&nodes[start..start + POINTS], x, &mut weights);
    dot(&weights, &values[start..start + POINTS])
}
