//! Slip of the unworn contact outside the zone that sticks.
//!
//! Spring `x` slips by the amplitude `(μ_f/M) (q_c - q)` where its compression `q` is below `q_c = M U/μ_f` [S, Eq. (11)], and Eq. (20)
//! carries that to the surface: `s(r) = (μ_f/M) S(r)` with the slip depth `S = F(q_c - q)`, where
//!
//! ```text
//! (F q)(r) = (2/π) cos(kπ/2) ∫_c^r x^k q(x) (r² - x²)^(-(1+k)/2) dx
//! ```
//!
//! As wear changes nothing inside `c`, the depth worn away is the growth of the slip depth, `w = S - S_0`.

use std::sync::{Arc, OnceLock};

use crate::contact::indenter::{EquivalentProfile, RiseTransform};
use crate::error::{Error, Result};
use crate::numerics::abel::profile_factor;
use crate::numerics::chebyshev::{Chebyshev, LANES, PiecewiseChebyshev};
use crate::numerics::power;
use crate::numerics::quadrature::Rule;
use crate::numerics::roots::bracketed;

/// Nodes of the Gauss-Jacobi rule for `F`; in the variable used, the integrand is entire for a power law but for the kernel's
/// own singularity at `ℓ v = 2πi`.
const NODES: usize = 40;

/// How far beyond the limiting contact edge the slip is tabulated, as a factor of `Z`.
const MARGIN: f64 = RiseTransform::MARGIN;

/// Where slip next to the edge of stick is taken, over the logarithm at the end.
const AT_STICK: f64 = 1e-6;

/// Relative difference of stick areas that is rounding.
const SAME_STICK: f64 = 1e-14;

/// Slip depth of the unworn contact over the annulus outside the stick zone, as a function of `z = r² - c²`.
#[derive(Debug, Clone)]
pub struct UnwornSlip {
    stick_radius_squared: f64,
    slip_compression: f64,
    profile: EquivalentProfile,
    mu: f64,
    /// `(F 1)/ℓ^μ` over `ℓ = ln(r²/c²)`, with `μ = (1-k)/2`.
    uniform: Chebyshev,
    slip: SlipSeries,
    rule: Rule,
    table: Option<Arc<RiseTransform>>,
    /// The slip of the terms of the profile where that is a series; found when the edge of stick has moved first.
    terms: OnceLock<Option<Vec<Term>>>,
    limit_slip_area: f64,
}

/// `(F(x^(2j) - c^(2j)))/(c^(2j) ℓ^(1+μ))` of a term of a series, the same for every `c`, times its coefficient in the series.
#[derive(Debug, Clone)]
struct Term {
    coefficient: f64,
    slip: SlipSeries,
}

/// `(F(q_c - q_0))/ℓ^(1+μ)`.
#[derive(Debug, Clone)]
enum SlipSeries {
    Smooth {
        /// Of that times `e^(-λℓ)` with the growth as `λ`.
        series: Chebyshev,
        /// By how much its logarithm grows on average: where the stick zone is small, slip next to it is orders of magnitude below that at the
        /// contact edge, and a series without that growth would keep as many digits fewer of it.
        growth: f64,
    },
    /// Of a table, whose waves and kinks take a series each, over the factor given.
    Table { series: Arc<PiecewiseChebyshev>, factor: f64 },
}

impl SlipSeries {
    fn smooth(slip: impl Fn(f64) -> f64, end: f64) -> Self {
        let growth = (slip(end) / slip(AT_STICK * end)).ln() / end;
        Self::Smooth { series: Chebyshev::fit(|l| slip(l) * (-growth * l).exp(), end), growth }
    }

    fn value(&self, logarithm: f64) -> f64 {
        match self {
            Self::Smooth { series, growth } => series.value(logarithm) * (growth * logarithm).exp(),
            Self::Table { series, factor } => factor * series.value(logarithm),
        }
    }

    fn values(&self, logarithms: &[f64; LANES]) -> [f64; LANES] {
        match self {
            Self::Smooth { series, growth } => {
                let values = series.values(logarithms);
                std::array::from_fn(|i| values[i] * (growth * logarithms[i]).exp())
            }
            Self::Table { .. } => logarithms.map(|logarithm| self.value(logarithm)),
        }
    }

    /// Derivative of its logarithm.
    fn log_slope(&self, logarithm: f64) -> f64 {
        let ((value, slope), growth) = match self {
            Self::Smooth { series, growth } => (series.value_and_derivative(logarithm), *growth),
            Self::Table { series, .. } => (series.value_and_derivative(logarithm), 0.0),
        };
        slope / value + growth
    }
}

/// Slip depths at one radius.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct UnwornValues {
    /// `ln(r²/c²)`.
    pub logarithm: f64,
    /// `F q_c`, m: the slip depth where no pressure is left; that of the limit.
    pub limit_slip: f64,
    /// `S_0 = F(q_c - q_0)`, m: the slip depth of the unworn contact.
    pub slip: f64,
}

/// Derivatives of the slip depths by `z = r² - c²` at one radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnwornSlopes {
    /// Of `F q_c`, 1/m.
    pub limit_slip: f64,
    /// Of `ln S_0`, 1/m².
    pub log_slip: f64,
}

impl UnwornValues {
    /// `ln(F q_c/S_0)`: how much the logarithm of slip has grown where no pressure is left.
    pub fn limit_log_slip(&self) -> f64 {
        (self.limit_slip / self.slip).ln()
    }

    /// Depth that the limit takes away, m: zero where it would add.
    pub fn limit_depth(&self) -> f64 {
        (self.limit_slip - self.slip).max(0.0)
    }
}

impl UnwornSlip {
    /// Tabulates the slip depth by the quadrature of `F`: to round-off; for a table to some 1e-11 of itself, where its rows are rough to what a series
    /// between two knots resolves.
    ///
    /// # Arguments
    /// * `profile` -- the unworn equivalent profile
    /// * `stick_radius` -- `c`, m
    /// * `slip_compression` -- `q(c)`, m, of the unworn contact
    /// * `initial_edge` -- `a0² - c²`, m²
    ///
    /// # Errors
    /// [`Error::NotConverged`] if no contact edge is found at which wear ends; [`Error::Inconsistent`] if a sphere would have to wear
    /// beyond its equator, or a table beyond its end.
    pub fn new(
        profile: &EquivalentProfile,
        stick_radius: f64,
        slip_compression: f64,
        initial_edge: f64,
    ) -> Result<Self> {
        let mu = 0.5 * (1.0 - profile.grading());
        let transform = Transform::new(profile, stick_radius)?;
        let squared = stick_radius * stick_radius;
        let depth_left = |l: f64| slip_compression * transform.uniform(l) / l - transform.slip(l);
        let low = (initial_edge / squared).ln_1p();
        let largest = (2.0 * (profile.largest_radius() / stick_radius).ln()).min(700.0);
        let mut high = low;
        while depth_left(high) > 0.0 {
            if high >= largest {
                let radius = stick_radius * (0.5 * high).exp();
                let (what, why) = match profile.end_of_table() {
                    Some(end) => {
                        ("indenter.table", format!("no limiting contact radius below {radius} m: {end}"))
                    }
                    None => (
                        "limiting contact radius",
                        format!("none below {radius} m; reduce the indentation or the amplitude"),
                    ),
                };
                return Err(Error::Inconsistent { what, why });
            }
            high = (1.5 * high).min(largest);
        }
        let logarithm = bracketed(depth_left, (low * 0.5).min(high), high, 0.0)?;
        let limit_slip_area = squared * logarithm.exp_m1();
        let end = (MARGIN * limit_slip_area / squared).ln_1p();
        let slip = match &transform.table {
            Some(table) => SlipSeries::Table { series: table.series(logarithm)?, factor: transform.factor },
            None => SlipSeries::smooth(|l| transform.slip(l), end),
        };
        Ok(Self {
            stick_radius_squared: squared,
            slip_compression,
            profile: profile.clone(),
            mu,
            uniform: Chebyshev::fit(|l| transform.uniform(l), end),
            slip,
            rule: transform.rule,
            table: transform.table,
            terms: OnceLock::new(),
            limit_slip_area,
        })
    }

    /// `a∞² - c²`, m²: the edge at which the depth that can be worn away, `F q_0`, is zero.
    pub fn limit_slip_area(&self) -> f64 {
        self.limit_slip_area
    }

    /// Largest `z`, m², for which [`UnwornSlip::at`] holds.
    pub fn largest_slip_area(&self) -> f64 {
        MARGIN * self.limit_slip_area
    }

    /// Slip depths at `z = r² - c²`, m², in (0, [`UnwornSlip::largest_slip_area`]].
    pub fn at(&self, z: f64) -> UnwornValues {
        let logarithm = (z / self.stick_radius_squared).ln_1p();
        self.values(logarithm, self.slip_compression, self.slip.value(logarithm))
    }

    /// As [`UnwornSlip::at`], or with another edge of stick [`UnwornSlip::at_stick`], at many places, some of them side by side.
    ///
    /// # Arguments
    /// * `stick` -- `c²`, m², and `q_c`, m, of another edge of stick
    /// * `z` -- the places, m², by their index
    pub fn fill(&self, stick: Option<[f64; 2]>, z: impl Fn(usize) -> f64, to: &mut [UnwornValues]) {
        let [area, compression] = stick.unwrap_or([self.stick_radius_squared, self.slip_compression]);
        let factor = match (stick, self.profile.exponent()) {
            (None, _) => None,
            (Some(_), _) if self.is_at(area) => None,
            (Some(_), Some(exponent)) => Some(self.scaled(area, exponent)),
            (Some(_), None) => {
                to.iter_mut().enumerate().for_each(|(i, to)| *to = self.at_stick(area, compression, z(i)));
                return;
            }
        };
        in_lanes(area, z, to, |logarithms, to| {
            let (uniform, slip) = (self.uniform.values(&logarithms), self.slip.values(&logarithms));
            for (i, to) in to.iter_mut().enumerate() {
                let rise = factor.map_or(slip[i], |factor| factor * slip[i]);
                *to = self.values_with(logarithms[i], compression, rise, uniform[i]);
            }
        });
    }

    /// As [`UnwornSlip::uniform_at_stick`], at many places.
    pub fn fill_uniform_at_stick(&self, stick_area: f64, z: impl Fn(usize) -> f64, to: &mut [f64]) {
        in_lanes(stick_area, z, to, |logarithms, to| {
            let uniform = self.uniform.values(&logarithms);
            for (i, to) in to.iter_mut().enumerate() {
                *to = power(logarithms[i], self.mu) * uniform[i];
            }
        });
    }

    /// Whether a stick area is that for which the slip was tabulated.
    fn is_at(&self, stick_area: f64) -> bool {
        (stick_area / self.stick_radius_squared - 1.0).abs() < SAME_STICK
    }

    /// Rise of a power law at another stick area over that for which the slip was tabulated.
    fn scaled(&self, stick_area: f64, exponent: f64) -> f64 {
        (stick_area / self.stick_radius_squared).powf(0.5 * exponent)
    }

    /// With `(F(g_0 - g_0(c)))/ℓ^(1+μ)` as `rise`.
    fn values(&self, logarithm: f64, slip_compression: f64, rise: f64) -> UnwornValues {
        self.values_with(logarithm, slip_compression, rise, self.uniform.value(logarithm))
    }

    /// With `(F 1)/ℓ^μ` as `uniform` besides.
    fn values_with(&self, logarithm: f64, slip_compression: f64, rise: f64, uniform: f64) -> UnwornValues {
        let powered = power(logarithm, self.mu);
        let uniform = powered * uniform;
        UnwornValues { logarithm, limit_slip: slip_compression * uniform, slip: logarithm * powered * rise }
    }

    /// Slip depths at `z = r² - c²`, m², of the unworn contact with another stick radius `c` and compression `q_c` there.
    ///
    /// A power law is the same at every scale, and so is every term of a sphere's profile; for other profiles the quadrature of `F` runs anew.
    ///
    /// # Arguments
    /// * `stick_area` -- `c²`, m², at least that for which the slip was tabulated
    /// * `slip_compression` -- `q_c`, m
    pub fn at_stick(&self, stick_area: f64, slip_compression: f64, z: f64) -> UnwornValues {
        let logarithm = (z / stick_area).ln_1p();
        let slip = match self.profile.exponent() {
            _ if self.is_at(stick_area) => self.slip.value(logarithm),
            Some(exponent) => self.scaled(stick_area, exponent) * self.slip.value(logarithm),
            None => match &self.table {
                Some(table) => {
                    profile_factor(1.0 - self.mu, self.mu) * table.mean_from(stick_area, logarithm)
                }
                None => self.slip_elsewhere(stick_area, logarithm),
            },
        };
        self.values(logarithm, slip_compression, slip)
    }

    /// `F 1` at `z = r² - c²`, m², with another stick area `c²`, m²: how far a rise of the ground within `c` by one raises that outside. The same for every profile.
    pub fn uniform_at_stick(&self, stick_area: f64, z: f64) -> f64 {
        let logarithm = (z / stick_area).ln_1p();
        power(logarithm, self.mu) * self.uniform.value(logarithm)
    }

    /// `F e`, m, at `z = r² - c²`, m², of compressions `e(x² - c²)`, m, by quadrature.
    pub fn carried(&self, stick_area: f64, z: f64, compression: impl Fn(f64) -> f64) -> f64 {
        let (logarithm, nu) = ((z / stick_area).ln_1p(), 1.0 - self.mu);
        let weighted = |(node, complement): (&f64, &f64)| {
            kernel(logarithm * node, nu) * compression(stick_area * (logarithm * complement).exp_m1())
        };
        let terms = self.rule.nodes.iter().zip(&self.rule.complements).map(weighted);
        let mean = terms.zip(&self.rule.weights).map(|(term, weight)| term * weight).sum::<f64>();
        profile_factor(nu, self.mu) * power(logarithm, self.mu) * mean
    }

    fn slip_elsewhere(&self, stick_area: f64, logarithm: f64) -> f64 {
        let Some(terms) = self.terms.get_or_init(|| self.of_terms()) else {
            return Transform::with_rule(&self.profile, stick_area.sqrt(), self.rule.clone()).slip(logarithm);
        };
        let mut power = 1.0;
        let slips = terms.iter().map(|term| {
            power *= stick_area;
            term.coefficient * power * term.slip.value(logarithm)
        });
        // The smallest first.
        slips.collect::<Vec<_>>().into_iter().rev().sum()
    }

    /// The slip of the terms of the profile, as far out as the slip depth holds.
    fn of_terms(&self) -> Option<Vec<Term>> {
        let farthest = self.stick_radius_squared + self.largest_slip_area();
        let coefficients = self.profile.series(farthest.sqrt())?;
        let end = (self.largest_slip_area() / self.stick_radius_squared).ln_1p();
        let transform = Transform::with_rule(&self.profile, 1.0, self.rule.clone());
        let term = |(j, coefficient): (usize, f64)| Term {
            coefficient,
            slip: SlipSeries::smooth(|l| transform.slip_of_power(l, (j + 1) as f64), end),
        };
        Some(coefficients.into_iter().enumerate().map(term).collect())
    }

    /// Derivatives of the slip depths where `values` belong to.
    pub fn slopes(&self, values: &UnwornValues) -> UnwornSlopes {
        let logarithm = values.logarithm;
        let by_z = (-logarithm).exp() / self.stick_radius_squared;
        let (uniform, uniform_slope) = self.uniform.value_and_derivative(logarithm);
        let of_uniform = uniform_slope / uniform + self.mu / logarithm;
        let of_rise = self.slip.log_slope(logarithm) + (1.0 + self.mu) / logarithm;
        UnwornSlopes { limit_slip: values.limit_slip * by_z * of_uniform, log_slip: by_z * of_rise }
    }
}

/// Quadrature of `F` in the variable `v` of `x² = r² e^(-ℓ v)`, `ℓ = ln(r²/c²)`.
struct Transform<'a> {
    profile: &'a EquivalentProfile,
    stick_radius: f64,
    nu: f64,
    factor: f64,
    rule: Rule,
    /// What stands for the rule where the profile is a table.
    table: Option<Arc<RiseTransform>>,
}

impl<'a> Transform<'a> {
    fn new(profile: &'a EquivalentProfile, stick_radius: f64) -> Result<Self> {
        let nu = 0.5 * (1.0 + profile.grading());
        let transform = Self::with_rule(profile, stick_radius, Rule::jacobi(NODES, 0.0, -nu)?);
        Ok(Self { table: profile.rise_transform(stick_radius)?, ..transform })
    }

    fn with_rule(profile: &'a EquivalentProfile, stick_radius: f64, rule: Rule) -> Self {
        let (nu, mu) = (0.5 * (1.0 + profile.grading()), 0.5 * (1.0 - profile.grading()));
        Self { profile, stick_radius, nu, factor: profile_factor(nu, mu), rule, table: None }
    }

    /// `(F 1)/ℓ^μ`.
    fn uniform(&self, logarithm: f64) -> f64 {
        self.factor * self.rule.mean(|v| self.kernel(logarithm * v))
    }

    /// `(F (g_0 - g_0(c)))/ℓ^(1+μ)`.
    fn slip(&self, logarithm: f64) -> f64 {
        if let Some(table) = &self.table {
            return self.factor * table.mean(logarithm);
        }
        let squared = self.stick_radius * self.stick_radius;
        let weighted = |(node, complement): (&f64, &f64)| {
            let rise = self.profile.rise(self.stick_radius, squared * (logarithm * complement).exp_m1());
            self.kernel(logarithm * node) * rise / logarithm
        };
        let terms = self.rule.nodes.iter().zip(&self.rule.complements).map(weighted);
        self.factor * terms.zip(&self.rule.weights).map(|(term, weight)| term * weight).sum::<f64>()
    }

    /// The same of `(x/c)^(2j)` in the place of `g_0`.
    fn slip_of_power(&self, logarithm: f64, power: f64) -> f64 {
        let weighted = |(node, complement): (&f64, &f64)| {
            self.kernel(logarithm * node) * (power * logarithm * complement).exp_m1() / logarithm
        };
        let terms = self.rule.nodes.iter().zip(&self.rule.complements).map(weighted);
        self.factor * terms.zip(&self.rule.weights).map(|(term, weight)| term * weight).sum::<f64>()
    }

    fn kernel(&self, y: f64) -> f64 {
        kernel(y, self.nu)
    }
}

/// `(expm1(y)/y)^(-ν)`.
fn kernel(y: f64, nu: f64) -> f64 {
    if y > 1e-300 { power(y.exp_m1() / y, -nu) } else { 1.0 }
}

/// Fills what follows from `ln(1 + z/c²)` at places `z`, m², by their index, some of them side by side.
fn in_lanes<T>(
    stick_area: f64,
    z: impl Fn(usize) -> f64,
    to: &mut [T],
    each: impl Fn([f64; LANES], &mut [T]),
) {
    for (chunk, to) in to.chunks_mut(LANES).enumerate() {
        // The last ones are found more than once where they are fewer.
        let place = |i: usize| z(chunk * LANES + i.min(to.len() - 1));
        each(std::array::from_fn(|i| (place(i) / stick_area).ln_1p()), to);
    }
}
