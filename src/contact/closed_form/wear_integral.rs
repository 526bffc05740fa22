//! The wear integrals [S, Eqs. (3), (4)] in logarithmic variables, in which nothing cancels.

use std::sync::Arc;

use super::table_wear::TableWear;
use crate::contact::indenter::EquivalentProfile;
use crate::error::{Error, Result};
use crate::numerics::quadrature::{MAX_NODES, RuleFamily};
use crate::numerics::roots;

/// Factor in front of [S, Eq. (3)], `S = sin(πμ)/(πμ)` with `μ = (1-k)/2`; finite as `k → ±1`.
pub(super) fn transform_factor(grading: f64) -> f64 {
    let (mu, nu) = (0.5 * (1.0 - grading), 0.5 * (1.0 + grading));
    let angle = std::f64::consts::PI * mu.min(nu);
    angle.sin() / (std::f64::consts::PI * mu)
}

/// Wear integrals of one first contact: profile `g0`, indentation `d`, contact radius `a0`.
///
/// A radius is given by two logarithms, `span` `L = ln(r/c)` and `growth` `b = ln(r/a0)`; with `x = r e^(-Lv)`, `y = 2Lv`,
/// `φ(y) = (e^y - 1)/y` and the spring compression left `E(v) = 1 - g0(x)/d`, [S, Eqs. (3), (4)] become
///
/// ```text
/// Δf/d = S (2L)^μ G,     G = ∫_0^1 μ v^(μ-1) φ^(-ν) E dv = h(0) + μ/(1+μ) ⟨(h(v) - h(0))/v⟩,     h = φ^(-ν) E
/// ΔV/(π r² d) = S (2L)^(1+μ)/(1+μ) ⟨e^(-y) φ^μ E⟩
/// ```
/// with `⟨·⟩` the mean under the weight `v^μ`, benign for every `k`.
#[derive(Debug, Clone)]
pub(super) struct WearIntegral {
    pub(super) profile: EquivalentProfile,
    pub(super) indentation: f64,
    pub(super) contact_radius: f64,
    rules: Arc<RuleFamily>,
    nodes: usize,
    mu: f64,
    nu: f64,
    table: Option<TableWear>,
}

/// Integrand at one node.
struct Node {
    /// `y = 2Lv`.
    doubled: f64,
    /// `ln φ(y)`.
    logarithm: f64,
    /// `(g0(x) - g0(r))/d`, negative.
    rise: f64,
    /// `E(v)`.
    compression: f64,
}

impl WearIntegral {
    /// The rules for one grading, which every profile and amplitude can share.
    pub(super) fn rules(grading: f64) -> Result<Arc<RuleFamily>> {
        RuleFamily::new(0.0, 0.5 * (1.0 - grading)).map(Arc::new)
    }

    /// Integrals of a first contact.
    pub(super) fn new(
        profile: EquivalentProfile,
        indentation: f64,
        contact_radius: f64,
        rules: Arc<RuleFamily>,
    ) -> Self {
        let (mu, nu) = (0.5 * (1.0 - profile.grading()), 0.5 * (1.0 + profile.grading()));
        Self { profile, indentation, contact_radius, rules, nodes: 1, mu, nu, table: None }
    }

    /// The same for one edge of stick only, at `ln(a0/c)`: where the profile is a table, split at its knots.
    pub(super) fn at_stick(self, stick_logarithm: f64) -> Result<Self> {
        let table = TableWear::new(&self.profile, self.contact_radius, stick_logarithm)?;
        Ok(Self { table, ..self })
    }

    /// The limit `b = ln(a∞/a0)`, the root of `Δf(a∞) = 0`; chooses the number of nodes for radii up to there.
    ///
    /// # Arguments
    /// * `stick_logarithm` -- `η = ln(a0/c)`, positive
    /// * `largest` -- the most that `b` can be
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if there is none up to the largest; [`Error::NotConverged`] if more nodes are needed than a rule can have:
    /// next to the equator of a sphere, or for exponents in the thousands.
    pub(super) fn limiting_growth(&mut self, stick_logarithm: f64, largest: f64) -> Result<f64> {
        // A guess from above in most cases; it is looked at again.
        let guess = (stick_logarithm * self.mu).min(largest);
        self.nodes = self.node_count(stick_logarithm + guess, guess).min(MAX_NODES);
        loop {
            let growth = self.growth_with_nodes(stick_logarithm, largest)?;
            let needed = self.node_count(stick_logarithm + growth, growth);
            if needed <= self.nodes {
                return Ok(growth);
            }
            if needed > MAX_NODES {
                return Err(Error::NotConverged {
                    what: "wear integral",
                    why: format!(
                        "{needed} nodes are needed for a contact radius of {} m at an indentation of {} m, {MAX_NODES} are the most",
                        self.contact_radius * growth.exp(),
                        self.indentation
                    ),
                });
            }
            self.nodes = needed;
        }
    }

    /// The same with the nodes as they are.
    pub(super) fn growth_with_nodes(&self, stick_logarithm: f64, largest: f64) -> Result<f64> {
        let mean = |growth: f64| self.mean_compression(stick_logarithm + growth, growth);
        // First order in small amplitudes, an upper bound there; else the bound that always holds, with room for rounding.
        let small = stick_logarithm * self.mu * 1.01;
        let bound = largest * (1.0 + 1e-9) + f64::EPSILON;
        let high = [small, bound].into_iter().find(|&growth| growth <= bound && mean(growth) < 0.0);
        match high {
            Some(high) => roots::bracketed(mean, 0.0, high, 0.0),
            None => {
                let table = self.profile.end_of_table();
                Err(Error::Inconsistent {
                    what: if table.is_some() { "indenter.table" } else { "limiting shape" },
                    why: format!(
                        "at an indentation of {} m the worn indenter would touch beyond {} m{}",
                        self.indentation,
                        self.contact_radius * largest.exp(),
                        table.map_or(String::new(), |end| format!(": {end}"))
                    ),
                })
            }
        }
    }

    /// The same with another number of nodes.
    #[cfg(test)]
    pub(super) fn with_nodes(mut self, nodes: usize) -> Self {
        self.nodes = nodes;
        self
    }

    /// Nodes for round-off accuracy at radii up to `c e^span = a0 e^growth`.
    ///
    /// The integrands have the zeros of `φ`, `v = ±iπ/L`, and for the sphere its equator, `v = -ln(R/r)/L`, as nearest singularities;
    /// the error falls as `ρ^(-2n)` with the sum `ρ` of the semi-axes of the ellipse through them. Steep power laws and long spans add a
    /// boundary layer of relative width `1/(nL)`. Of a table only the kernel's integral is left to the rule.
    fn node_count(&self, span: f64, growth: f64) -> usize {
        const DIGITS: f64 = 18.5; // half of -ln(1e-16)
        // Of the ellipse with foci 0 and 1 at these distances, in units of half the distance of the foci.
        let ellipse = |to_zero: f64, to_one: f64| {
            let axis = to_zero + to_one;
            axis + (axis * axis - 1.0).sqrt()
        };
        let imaginary = std::f64::consts::PI / span;
        let steepness = self.profile.exponent().unwrap_or(2.0).max(2.0) * span;
        let smooth = DIGITS / ellipse(imaginary, imaginary.hypot(1.0)).ln() + 2.5 * steepness.sqrt();
        let rim = self.profile.singular_radius().map_or(0.0, |radius| {
            let distance = (radius / self.contact_radius).ln() - growth;
            DIGITS / ellipse(distance / span, 1.0 + distance / span).ln()
        });
        smooth.max(rim).ceil() as usize + 8
    }

    /// `Δf/d` at the radius `c e^span = a0 e^growth`.
    pub(super) fn depth(&self, span: f64, growth: f64) -> f64 {
        if span <= 0.0 {
            return 0.0;
        }
        transform_factor(self.profile.grading())
            * (2.0 * span).powf(self.mu)
            * self.mean_compression(span, growth)
    }

    /// `G`, the weighted mean of the compression left between the stick radius and `r`: zero at the limiting contact radius.
    pub(super) fn mean_compression(&self, span: f64, growth: f64) -> f64 {
        if let Some(table) = &self.table {
            return table.mean_compression(2.0 * span, self.uniform(span)) / self.indentation;
        }
        let edge = self.edge_compression(growth);
        let mean = self.mean(span, growth, |v, node| {
            ((-self.nu * node.logarithm).exp_m1() * node.compression - node.rise) / v
        });
        edge + self.mu / (1.0 + self.mu) * mean
    }

    /// `G` of the compression 1.
    fn uniform(&self, span: f64) -> f64 {
        let change = |v: f64| (-self.nu * logarithmic_growth(2.0 * span * v)).exp_m1() / v;
        1.0 + self.mu / (1.0 + self.mu) * self.rules.at_least(self.nodes).mean(change)
    }

    /// `ln(r/c)` where wear is deepest, up to the limit at `span = ln(a∞/c)`.
    pub(super) fn deepest(&self, span: f64, stick_logarithm: f64) -> Result<f64> {
        match &self.table {
            Some(table) => Ok(0.5 * table.deepest(2.0 * span, |l| self.uniform(0.5 * l))?),
            None => roots::bracketed(|span| self.depth_slope(span, span - stick_logarithm), 0.0, span, 0.0),
        }
    }

    /// `L/(S (2L)^μ) · d(Δf/d)/dL` along `r` at fixed stick radius: zero where the wear is deepest.
    fn depth_slope(&self, span: f64, growth: f64) -> f64 {
        let origin = self.profile.at(self.contact_radius * growth.exp());
        let edge = -span * origin.logarithmic_slope(0.0) / self.indentation;
        let mean = self.mean(span, growth, |v, node| {
            // y φ'/φ = y/(1 - e^(-y)) - 1
            let weight_change =
                if node.doubled > 0.0 { -node.doubled / (-node.doubled).exp_m1() - 1.0 } else { 0.0 };
            let flank = span * (1.0 - v) * origin.logarithmic_slope(-span * v) / self.indentation;
            let change =
                (-self.nu * node.logarithm).exp() * (self.nu * weight_change * node.compression + flank);
            (-change - edge) / v
        });
        self.mu * self.mean_compression(span, growth) + edge + self.mu / (1.0 + self.mu) * mean
    }

    /// `ΔV/(π a0² d)` of the annulus up to `r`.
    pub(super) fn volume(&self, span: f64, growth: f64) -> f64 {
        if span <= 0.0 {
            return 0.0;
        }
        let integrand = |_, node: &Node| (self.mu * node.logarithm - node.doubled).exp() * node.compression;
        let mean = match &self.table {
            Some(table) => table.volume_mean(2.0 * span) / self.indentation,
            None => self.mean(span, growth, integrand),
        };
        let alpha = 1.0 + self.mu;
        transform_factor(self.profile.grading()) * (2.0 * growth).exp() * (2.0 * span).powf(alpha) / alpha
            * mean
    }

    /// `E(0) = 1 - g0(r)/d`, to full relative accuracy at `r → a0`.
    fn edge_compression(&self, growth: f64) -> f64 {
        -self.profile.at(self.contact_radius).rise(growth) / self.indentation
    }

    /// Weighted mean over the nodes of `integrand(v, node)`.
    fn mean(&self, span: f64, growth: f64, integrand: impl Fn(f64, &Node) -> f64) -> f64 {
        let edge = self.edge_compression(growth);
        let origin = self.profile.at(self.contact_radius * growth.exp());
        self.rules.at_least(self.nodes).mean(|v| {
            let doubled = 2.0 * span * v;
            let rise = origin.rise(-span * v) / self.indentation;
            integrand(
                v,
                &Node { doubled, logarithm: logarithmic_growth(doubled), rise, compression: edge - rise },
            )
        })
    }
}

/// `ln φ(y) = ln((e^y - 1)/y)`, `y >= 0`, without overflow.
fn logarithmic_growth(y: f64) -> f64 {
    if y > 0.0 { y + (-(-y).exp_m1() / y).ln() } else { 0.0 }
}
