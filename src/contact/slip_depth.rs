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

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use crate::contact::indenter::{EquivalentProfile, RiseTransform};
use crate::error::{Error, Result};
use crate::numerics::abel::profile_factor;
use crate::numerics::chebyshev::{Chebyshev, ChebyshevPlane, LANES, PiecewiseChebyshev};
use crate::numerics::power;
use crate::numerics::quadrature::Rule;
use crate::numerics::roots::bracketed;

/// Nodes of the Gauss-Jacobi rule for `F`; in the variable used, the integrand is entire for a power law but for the kernel's
/// own singularity at `ℓ v = 2πi`.
const NODES: usize = 40;

/// How far beyond the limiting contact edge the slip is tabulated, as a factor of `Z`; at most half of the way to where a sphere ends.
const MARGIN: f64 = RiseTransform::MARGIN;

/// Where slip next to the edge of stick is taken, over the logarithm at the end.
const AT_STICK: f64 = 1e-6;

/// How far in an edge of stick may come in a step that is tried, as a part of the stick area for which the slip is tabulated.
pub const INNERMOST: f64 = 0.99;

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
    /// The slip at other edges of stick, where the profile is neither a power law nor a table and a series gives it; found when the edge has moved first.
    elsewhere: OnceLock<Option<SlipElsewhere>>,
    limit_slip_area: f64,
    largest_slip_area: f64,
}

/// `(F(g_0 - g_0(c)))/ℓ^(1+μ)` for edges of stick from the [innermost](INNERMOST) outwards.
#[derive(Debug, Clone)]
struct SlipElsewhere {
    /// Of that times `e^(-λℓ - γu)`, over `u`, the logarithm of the stick area over the innermost one, and `ℓ` over its largest value.
    plane: ChebyshevPlane,
    /// The largest `u + ℓ`.
    end: f64,
    growth: f64,
    growth_by_stick: f64,
}

/// The slip at an edge of stick.
enum Slips<'a> {
    Series { slip: Cow<'a, SlipSeries>, factor: f64 },
    Table { transform: &'a RiseTransform, stick_area: f64, factor: f64 },
    Quadrature(Transform<'a>),
}

impl Slips<'_> {
    fn value(&self, logarithm: f64) -> f64 {
        match self {
            Self::Series { slip, factor } => factor * slip.value(logarithm),
            Self::Table { transform, stick_area, factor } => {
                factor * transform.mean_from(*stick_area, logarithm)
            }
            Self::Quadrature(transform) => transform.slip(logarithm),
        }
    }

    fn values(&self, logarithms: &[f64; LANES]) -> [f64; LANES] {
        match self {
            Self::Series { slip, factor } => slip.values(logarithms).map(|slip| factor * slip),
            _ => logarithms.map(|logarithm| self.value(logarithm)),
        }
    }
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
        let largest_slip_area = match profile.end_of_table() {
            Some(_) => MARGIN * limit_slip_area,
            None => {
                let farthest = profile.largest_radius().powi(2) - squared;
                (MARGIN * limit_slip_area).min(0.5 * (limit_slip_area + farthest))
            }
        };
        let end = (largest_slip_area / squared).ln_1p();
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
            elsewhere: OnceLock::new(),
            limit_slip_area,
            largest_slip_area,
        })
    }

    /// `a∞² - c²`, m²: the edge at which the depth that can be worn away, `F q_0`, is zero.
    pub fn limit_slip_area(&self) -> f64 {
        self.limit_slip_area
    }

    /// Largest `z`, m², for which [`UnwornSlip::at`] holds.
    pub fn largest_slip_area(&self) -> f64 {
        self.largest_slip_area
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
        let slips = self.slips(area);
        in_lanes(area, z, to, |logarithms, to| {
            let (uniform, slip) = (self.uniform.values(&logarithms), slips.values(&logarithms));
            for (i, to) in to.iter_mut().enumerate() {
                *to = self.values_with(logarithms[i], compression, slip[i], uniform[i]);
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
    /// A power law is the same at every scale; for a sphere there is a series in the stick radius too, for tables the quadrature of `F` runs anew.
    ///
    /// # Arguments
    /// * `stick_area` -- `c²`, m², at least [`INNERMOST`] of that for which the slip was tabulated
    /// * `slip_compression` -- `q_c`, m
    pub fn at_stick(&self, stick_area: f64, slip_compression: f64, z: f64) -> UnwornValues {
        let logarithm = (z / stick_area).ln_1p();
        self.values(logarithm, slip_compression, self.slips(stick_area).value(logarithm))
    }

    fn slips(&self, stick_area: f64) -> Slips<'_> {
        let scaled = |factor: f64| Slips::Series { slip: Cow::Borrowed(&self.slip), factor };
        let ratio = stick_area / self.stick_radius_squared;
        if self.is_at(stick_area) {
            return scaled(1.0);
        }
        if let Some(exponent) = self.profile.exponent() {
            return scaled(ratio.powf(0.5 * exponent));
        }
        if let Some(transform) = &self.table {
            return Slips::Table { transform, stick_area, factor: profile_factor(1.0 - self.mu, self.mu) };
        }
        let elsewhere = self.elsewhere.get_or_init(|| self.slip_elsewhere()).as_ref();
        elsewhere.and_then(|it| it.slips((ratio / INNERMOST).ln())).unwrap_or_else(|| {
            Slips::Quadrature(Transform::with_rule(&self.profile, stick_area.sqrt(), self.rule.clone()))
        })
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

    /// The slip at other edges of stick, as far out as the slip depth holds; none where a series takes too many terms, next to a sphere's equator.
    fn slip_elsewhere(&self) -> Option<SlipElsewhere> {
        let squared = INNERMOST * self.stick_radius_squared;
        let end = ((self.stick_radius_squared + self.largest_slip_area()) / squared).ln();
        let growth = match &self.slip {
            SlipSeries::Smooth { growth, .. } => *growth,
            SlipSeries::Table { .. } => 0.0,
        };
        let slip = |u: f64, logarithm: f64| {
            let radius = (squared * u.exp()).sqrt();
            Transform::with_rule(&self.profile, radius, self.rule.clone()).slip(logarithm)
        };
        let at_stick = AT_STICK * end;
        let growth_by_stick = 2.0 * (slip(0.5 * end, at_stick) / slip(0.0, at_stick)).ln() / end;
        let slip = |u: f64, part: f64| {
            let logarithm = part * (end - u);
            slip(u, logarithm) * (-growth * logarithm - growth_by_stick * u).exp()
        };
        let plane = ChebyshevPlane::fit(slip, end)?;
        Some(SlipElsewhere { plane, end, growth, growth_by_stick })
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

impl SlipElsewhere {
    /// The slip at the stick area that is `e^u` times the innermost one; none where no series reaches.
    fn slips(&self, u: f64) -> Option<Slips<'_>> {
        let length = self.end - u;
        if !(u > 0.0 && length > 0.0) {
            return None;
        }
        let slip = SlipSeries::Smooth { series: self.plane.along_y(u, length), growth: self.growth };
        Some(Slips::Series { slip: Cow::Owned(slip), factor: (self.growth_by_stick * u).exp() })
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
