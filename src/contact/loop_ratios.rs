//! Energy ratio and sliding ratio of the fretting loop of an unworn contact: how far it is from gross slip.
//!
//! ```text
//! A = W/(4 Q* δ*),     D = δ0/δ*        [Fouvry, Kapsa, Vincent, Wear 185 (1995) 35]
//! ```
//!
//! with the energy `W` of the loop, the amplitudes `Q*` of the tangential force and `δ*` of the displacement, and half the width `δ0` of the loop
//! at no force. Over the springs, with `q_c = M U/μ_f` and the reversal of force at `q_v`,
//!
//! ```text
//! T(q_c) = q_c c^(1+k)/(1+k) + ∫_c^a x^k q dx,     Q* = 2 μ_f c_N T(q_c)
//! A = ∫_c^a x^k q (q_c - q) dx / (q_c T(q_c)),     D = 1 - 2 q_v/q_c,   T(q_v) = T(q_c)/2
//! ```

use std::sync::LazyLock;

use super::InitialContact;
use super::stick_slip::stick_logarithm;
use crate::error::Result;
use crate::numerics::quadrature::Rule;
use crate::numerics::roots::bracketed;

/// Nodes of a panel, of the width of the first in `ln(a/x)`; each ends at twice the place of the one before.
const NODES: usize = 24;
const FIRST_PANEL: f64 = 1.0 / 64.0;
static PANEL: LazyLock<Rule> = LazyLock::new(|| Rule::legendre(NODES).expect("a rule of few nodes"));

/// `ln(a/c)` below which the difference of two normal forces leaves few digits.
const NARROW: f64 = 0.1;

/// `(1+k) ln(a/x)` beyond which springs carry less than round-off.
const FARTHEST: f64 = 45.0;

impl InitialContact {
    /// Energy ratio `A` of the loop; zero where nothing slips.
    ///
    /// # Errors
    /// As [`stick_logarithm`].
    ///
    /// # Examples
    /// ```
    /// # let scene: fretwear::Scene = include_str!("../../data/scenes/paraboloid.toml").parse()?;
    /// assert!((scene.contact()?.energy_ratio_transition()? - 0.2).abs() < 1e-14); // (1+k)/(2n+1+k)
    /// # Ok::<(), fretwear::Error>(())
    /// ```
    pub fn energy_ratio(&self) -> Result<f64> {
        self.energy_ratio_at(self.slip_compression(), self.stick_logarithm())
    }

    /// Energy ratio at which gross slip begins.
    ///
    /// ```text
    /// A_t = (1+k)/(2n+1+k)     of f = A r^n
    /// ```
    ///
    /// # Errors
    /// As [`InitialContact::energy_ratio`].
    pub fn energy_ratio_transition(&self) -> Result<f64> {
        self.energy_ratio_at(self.indentation(), None)
    }

    /// Sliding ratio `D` of the loop; zero where nothing slips.
    ///
    /// # Errors
    /// As [`stick_logarithm`].
    pub fn sliding_ratio(&self) -> Result<f64> {
        let (whole, depth) = (self.slip_compression(), self.indentation());
        if whole == 0.0 {
            return Ok(0.0);
        }
        let force = |compression: f64, logarithm: Option<f64>| self.largest_force(compression, logarithm);
        let half = 0.5 * force(whole, self.stick_logarithm());
        let mut failed = None;
        let excess = |compression: f64| {
            let edge = match compression < depth {
                true => stick_logarithm(self.equivalent_profile(), depth, self.contact_radius(), compression)
                    .map(Some),
                false => Ok(None),
            };
            let found = edge.map(|logarithm| force(compression, logarithm));
            found.unwrap_or_else(|error| {
                failed = Some(error);
                f64::NAN
            }) - half
        };
        let reversal = bracketed(excess, 0.0, whole.min(depth), 0.0);
        failed.map_or(Ok(()), Err)?;
        Ok(1.0 - 2.0 * reversal? / whole)
    }

    fn energy_ratio_at(&self, compression: f64, logarithm: Option<f64>) -> Result<f64> {
        let [force, work] = self.moved(compression, logarithm);
        Ok(if compression == 0.0 { 0.0 } else { work / (compression * force) })
    }

    /// `T(q_c)` for an edge of stick at `ln(a/c)`, if there is one: of a power law by the difference of two normal forces, where that has digits
    /// enough (Ciavarella, Jäger),
    ///
    /// ```text
    /// T(q_c) = (F_N(a) - F_N(c))/(2 c_N)
    /// ```
    fn largest_force(&self, slip_compression: f64, logarithm: Option<f64>) -> f64 {
        let (profile, radius) = (self.equivalent_profile(), self.contact_radius());
        if profile.exponent().is_none() || logarithm.is_some_and(|it| it < NARROW) {
            return self.moved(slip_compression, logarithm)[0];
        }
        let held = logarithm.map_or(0.0, |it| profile.load_integral(radius * (-it).exp()));
        0.5 * (profile.load_integral(radius) - held)
    }

    /// `T(q_c)` and `∫_c^a x^k q (q_c - q) dx` for an edge of stick at `ln(a/c)`, if there is one.
    fn moved(&self, slip_compression: f64, logarithm: Option<f64>) -> [f64; 2] {
        let (profile, radius) = (self.equivalent_profile(), self.contact_radius());
        let exponent = 1.0 + self.half_space().grading();
        let stick = logarithm.map(|end| radius * (-end).exp());
        let compression = |s: f64| match logarithm.zip(stick) {
            Some((end, stick)) => {
                slip_compression - profile.rise(stick, stick * stick * (2.0 * (end - s)).exp_m1())
            }
            None => self.indentation() - profile.value(radius * (-s).exp()),
        };
        let rule = &*PANEL;
        let end = logarithm.unwrap_or(f64::INFINITY).min(FARTHEST / exponent);
        let (mut first, mut sums) = (0.0, [0.0; 2]);
        while first < end {
            let width = first.max(FIRST_PANEL).min(end - first);
            for (part, weight) in rule.nodes.iter().zip(&rule.weights) {
                let s = first + width * part;
                let (q, density) = (compression(s), width * weight * (-exponent * s).exp());
                sums[0] += density * q;
                sums[1] += density * q * (slip_compression - q);
            }
            first += width;
        }
        let scale = radius.powf(exponent);
        let held = stick.map_or(0.0, |stick| slip_compression * stick.powf(exponent) / exponent);
        [held + scale * sums[0], scale * sums[1]]
    }
}
