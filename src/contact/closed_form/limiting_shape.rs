//! The limiting shape itself.

use super::wear_integral::WearIntegral;
use super::{Regime, relative_slip_width, small_amplitude_wear_volume};
use crate::contact::InitialContact;
use crate::contact::indenter::{EquivalentProfile, Indenter};
use crate::contact::stick_slip;
use crate::error::{Error, Result};
use crate::laws::conditions::Conditions;
use std::f64::consts::PI;

/// Limiting shape of an indenter worn by tangential oscillation at a fixed indentation.
///
/// Lengths in m. Every width and depth is computed without cancellation, so that the smallest amplitudes keep their digits. Against
/// tables of 17 digits (`data/reference`) the relative error of `a∞ - c`, `a∞ - a0`, `ΔV` and the largest depth is at most
/// * 1.3e-14 for 0.05 <= c/a0 <= 0.999999, -0.99 <= k <= 0.9999, n <= 10;
/// * 1.3e-13 for -0.9999 <= k <= 0.9999, 0.1 <= n <= 20 and 1e-10 to 1 - 1e-10 of full sliding, with c/a0 down to 1e-100;
/// * 8e-13 for amplitudes from 1e-14 μ_f d up at k = -0.9999, where the rounding of `M U/μ_f` next to full sliding is what is seen.
///
/// Against two hundred nodes it is 3e-13 for c/a0 down to 1e-9, and 4e-12 at n = 60. [`HypergeometricLimit`](super::HypergeometricLimit),
/// an independent way, agrees to both claims at a million random places of the second range.
///
/// The rows of a cone or a paraboloid give their limit to 2e-13. For other tables the integrals are split at the knots of `g`: against adaptive
/// quadrature the depth is good to 5e-11 of the largest for ten to a thousand waves within the contact, to 1e-11 for smooth rows and rough ones.
///
/// # Examples
/// ```
/// use fretwear::contact::closed_form::LimitingShape;
/// use fretwear::contact::indenter::Indenter;
///
/// // Paraboloid of radius 1 on a homogeneous half-space, indentation 1, so that a0 = 1; slip down to c = a0/2.
/// let shape = LimitingShape::from_stick_ratio(&Indenter::paraboloid(1.0)?, 0.0, 1.0, 0.5)?;
/// assert!((shape.contact_radius_limit() - 1.2297905754654218).abs() < 1e-14);
/// assert!((shape.slip_compression() - 0.75).abs() < 1e-15);
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct LimitingShape {
    indenter: Indenter,
    slip_compression: f64,
    /// `η = ln(a0/c)`.
    stick_logarithm: f64,
    /// `b = ln(a∞/a0)`.
    growth_logarithm: f64,
    integral: WearIntegral,
    deepest: (f64, f64),
}

impl LimitingShape {
    /// Relative error claimed for `a∞ - c`, `a∞ - a0`, `ΔV` and the largest depth, and for every depth relative to the largest: of spheres
    /// and power laws with 0.1 <= n <= 20, for the doubles given, which next to full sliding hold few digits of `d - q_c`. Not for tables.
    pub const CLAIMED_ERROR: f64 = 1e-12;

    /// Limiting shape after slip down to the spring compression `q_c`.
    ///
    /// # Arguments
    /// * `indenter` -- the unworn indenter
    /// * `grading` -- `k`, in (-1, 1)
    /// * `indentation` -- `d`, m, positive
    /// * `slip_compression` -- `q_c = M U/μ_f`, m, `0 <= q_c < d`; 0 gives the unworn shape
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names an argument; [`Error::Inconsistent`] under full sliding, `q_c >= d`, and where a sphere would touch
    /// beyond 0.999 of its radius, or a table beyond its end; [`Error::NotConverged`] next to that, and for power-law exponents in the thousands.
    pub fn new(indenter: &Indenter, grading: f64, indentation: f64, slip_compression: f64) -> Result<Self> {
        let (profile, contact_radius) = first_contact(indenter, grading, indentation)?;
        if !(slip_compression >= 0.0 && slip_compression.is_finite()) {
            return Err(Error::OutOfRange {
                name: "slip compression",
                value: slip_compression,
                range: "[0, indentation)",
            });
        }
        if Regime::new(indentation, slip_compression) == Regime::FullSliding {
            return Err(Error::Inconsistent {
                what: "limiting shape",
                why: format!(
                    "the contact is in gross slip: M U/μ = {slip_compression} m is not below the indentation {indentation} m"
                ),
            });
        }
        let stick_logarithm =
            stick_slip::stick_logarithm(&profile, indentation, contact_radius, slip_compression)?;
        Self::assemble(indenter, profile, indentation, contact_radius, slip_compression, stick_logarithm)
    }

    /// Limiting shape for a given ratio `c/a0` of stick radius to first contact radius, in (0, 1].
    ///
    /// # Errors
    /// As [`LimitingShape::new`]; [`Error::OutOfRange`] names `loading.stick_ratio`.
    pub fn from_stick_ratio(
        indenter: &Indenter,
        grading: f64,
        indentation: f64,
        stick_ratio: f64,
    ) -> Result<Self> {
        let (profile, contact_radius) = first_contact(indenter, grading, indentation)?;
        if !(stick_ratio > 0.0 && stick_ratio <= 1.0) {
            return Err(Error::OutOfRange {
                name: "loading.stick_ratio",
                value: stick_ratio,
                range: "(0, 1]",
            });
        }
        let stick_logarithm = -stick_ratio.ln();
        let slip_compression = -profile.at(contact_radius).rise(-stick_logarithm);
        Self::assemble(indenter, profile, indentation, contact_radius, slip_compression, stick_logarithm)
    }

    /// Limiting shape of the contact that a scene describes; none under full sliding.
    ///
    /// # Errors
    /// [`Error::Inconsistent`] where a worn sphere would touch beyond 0.999 of its radius, or a table beyond its end; [`Error::NotConverged`] next to that, and for
    /// power-law exponents in the thousands.
    pub fn from_contact(contact: &InitialContact) -> Result<Option<Self>> {
        let Some(stick_logarithm) = contact.stick_logarithm() else { return Ok(None) };
        let profile = contact.equivalent_profile().clone();
        let (indentation, contact_radius) = (contact.indentation(), contact.contact_radius());
        let slip_compression = contact.slip_compression();
        Self::assemble(
            contact.indenter(),
            profile,
            indentation,
            contact_radius,
            slip_compression,
            stick_logarithm,
        )
        .map(Some)
    }

    /// Limiting shape of a contact under some conditions: under both forces held the first contact comes to lie deeper, with the same stick
    /// radius. None under full sliding.
    ///
    /// # Errors
    /// As [`LimitingShape::from_contact`] and [`InitialContact::under_held_forces`].
    pub fn under(contact: &InitialContact, conditions: &Conditions) -> Result<Option<Self>> {
        if !conditions.holds_both_forces() {
            return Self::from_contact(contact);
        }
        let last = contact.under_held_forces()?;
        Ok(last.as_ref().map(Self::from_contact).transpose()?.flatten())
    }

    fn assemble(
        indenter: &Indenter,
        profile: EquivalentProfile,
        indentation: f64,
        contact_radius: f64,
        slip_compression: f64,
        stick_logarithm: f64,
    ) -> Result<Self> {
        // Where the unworn profile reaches the indentation, the worn one has left the contact.
        let outermost = indenter.radius_at_height(indentation).min(profile.largest_radius());
        let largest_growth = (outermost / contact_radius).ln().max(0.0);
        let rules = WearIntegral::rules(profile.grading())?;
        let mut integral =
            WearIntegral::new(profile, indentation, contact_radius, rules).at_stick(stick_logarithm)?;
        let growth_logarithm = match slip_compression > 0.0 {
            true => integral.limiting_growth(stick_logarithm, largest_growth)?,
            false => 0.0,
        };
        let mut shape = Self {
            indenter: indenter.clone(),
            slip_compression,
            stick_logarithm,
            growth_logarithm,
            integral,
            deepest: (contact_radius, 0.0),
        };
        if slip_compression > 0.0 {
            shape.deepest = shape.find_deepest()?;
        }
        shape.check_rings()?;
        Ok(shape)
    }

    /// Refuses a table that would touch again beyond `a∞`: at rows that lie above the surface which the springs leave, `Δf > 0`.
    ///
    /// Where `g` rises throughout, `Δf` has no other zero. The unworn contact leaves a lower surface than the limit and touches less.
    fn check_rings(&self) -> Result<()> {
        let Some(table) = self.indenter.table() else { return Ok(()) };
        if self.integral.profile.largest_radius() >= table.largest_radius() {
            return Ok(());
        }
        let (edge, contact_radius) = (self.contact_radius_limit(), self.contact_radius_initial());
        let near =
            table.knots().filter(|(r, height)| *r > edge * (1.0 + 1e-6) && *height < self.indentation());
        for (r, _) in near {
            let growth = (r / contact_radius).ln();
            if self.integral.mean_compression(self.stick_logarithm + growth, growth) > 0.0 {
                let why = format!(
                    "at an indentation of {:e} m the indenter, worn to the contact radius {edge:e} m, would touch again at its row r = {r:e} m: \
                     the contact would split into rings; where that is noise, smooth it: give the standard deviation of its heights as \
                     indenter.table.smoothing; else press less deep",
                    self.indentation()
                );
                return Err(Error::Inconsistent { what: "indenter.table", why });
            }
        }
        Ok(())
    }

    /// Radius and depth of the deepest wear.
    fn find_deepest(&self) -> Result<(f64, f64)> {
        let span = self.integral.deepest(self.limiting_span(), self.stick_logarithm)?;
        let depth = self.integral.indentation * self.integral.depth(span, span - self.stick_logarithm);
        Ok((self.stick_radius() * span.exp(), depth))
    }

    /// `ln(a∞/c)`.
    fn limiting_span(&self) -> f64 {
        self.stick_logarithm + self.growth_logarithm
    }

    /// The unworn indenter.
    pub fn indenter(&self) -> &Indenter {
        &self.indenter
    }

    /// Grading `k`.
    pub fn grading(&self) -> f64 {
        self.integral.profile.grading()
    }

    /// Indentation `d`, m.
    pub fn indentation(&self) -> f64 {
        self.integral.indentation
    }

    /// Spring compression at the edge of stick, `q_c = d - g0(c)`, m.
    pub fn slip_compression(&self) -> f64 {
        self.slip_compression
    }

    /// Stick, if nothing slips, or partial slip.
    pub fn regime(&self) -> Regime {
        // Not from q_c: next to full sliding it rounds to the indentation while the stick radius keeps its digits.
        if self.stick_logarithm > 0.0 { Regime::PartialSlip } else { Regime::Stick }
    }

    /// Equivalent profile `g0` of the unworn indenter.
    pub fn initial_equivalent_profile(&self) -> &EquivalentProfile {
        &self.integral.profile
    }

    /// First contact radius `a0`, m.
    pub fn contact_radius_initial(&self) -> f64 {
        self.integral.contact_radius
    }

    /// Stick radius `c`, m.
    pub fn stick_radius(&self) -> f64 {
        self.contact_radius_initial() * (-self.stick_logarithm).exp()
    }

    /// Limiting contact radius `a∞`, m.
    pub fn contact_radius_limit(&self) -> f64 {
        self.contact_radius_initial() * self.growth_logarithm.exp()
    }

    /// Width `a0 - c` of the first slip annulus, m.
    pub fn slip_width_initial(&self) -> f64 {
        -self.contact_radius_initial() * (-self.stick_logarithm).exp_m1()
    }

    /// Width `a∞ - c` of the worn annulus, m.
    pub fn slip_width_limit(&self) -> f64 {
        self.stick_radius() * self.limiting_span().exp_m1()
    }

    /// Growth `a∞ - a0` of the contact radius, m.
    pub fn contact_growth_limit(&self) -> f64 {
        self.contact_radius_initial() * self.growth_logarithm.exp_m1()
    }

    /// Limiting worn volume `ΔV`, m³ [S, Eq. (4)], the outer bound being `a∞`.
    ///
    /// ```text
    /// ΔV = 2π ∫_c^a∞ Δf(r) r dr
    /// ```
    pub fn wear_volume(&self) -> f64 {
        let scale = PI * self.contact_radius_initial().powi(2) * self.indentation();
        scale * self.integral.volume(self.limiting_span(), self.growth_logarithm)
    }

    /// Worn volume, m³, by the leading term for small amplitudes [S, Eq. (15)].
    pub fn wear_volume_asymptotic(&self) -> f64 {
        let exponent = self.integral.profile.at(self.contact_radius_initial()).logarithmic_slope(0.0)
            / self.indentation();
        let small = relative_slip_width(self.slip_width_initial(), self.stick_radius());
        small_amplitude_wear_volume(self.grading(), exponent, self.indentation(), self.stick_radius(), small)
    }

    /// Largest wear depth, m.
    pub fn wear_depth_max(&self) -> f64 {
        self.deepest.1
    }

    /// Radius of the largest wear depth, m; the contact radius where nothing is worn.
    pub fn wear_depth_max_radius(&self) -> f64 {
        self.deepest.0
    }

    /// Normal force of the limiting shape over that of the first contact at the same indentation [S, Eq. (22)].
    ///
    /// ```text
    /// F∞/F0 = ∫_0^c x^k (d - g0) dx / ∫_0^a0 x^k (d - g0) dx
    /// ```
    pub fn load_fraction(&self) -> f64 {
        let (profile, q) = (&self.integral.profile, 1.0 + self.grading());
        let stick_radius = self.stick_radius();
        let punch = 2.0 * self.slip_compression * stick_radius.powf(q) / q;
        (profile.load_integral(stick_radius) + punch) / profile.load_integral(self.contact_radius_initial())
    }

    /// Limiting equivalent profile `g∞(x)`, m [S, Eq. (2)], the outer bound being `a∞`.
    ///
    /// ```text
    /// g∞ = g0(x)  for x <= c,     d  for c < x <= a∞
    /// ```
    /// None beyond the contact, where the equivalent profile has no say.
    pub fn equivalent_profile(&self, x: f64) -> Option<f64> {
        if x <= self.stick_radius() {
            Some(self.integral.profile.value(x))
        } else {
            (x <= self.contact_radius_limit()).then_some(self.indentation())
        }
    }

    /// Limiting wear depth `Δf`, m, at radius `r`, m [S, Eq. (3)]; zero within `c` and beyond `a∞`.
    ///
    /// ```text
    /// Δf(r) = (2/π) cos(kπ/2) ∫_c^r x^k (d - g0(x)) (r² - x²)^(-(1+k)/2) dx
    /// ```
    /// Next to the stick radius the depth rises as `(r-c)^((1-k)/2)`, and the rounding of `c` shows: there
    /// [`LimitingShape::wear_depth_at_offset`] keeps all digits.
    pub fn wear_depth(&self, r: f64) -> f64 {
        let stick_radius = self.stick_radius();
        self.wear_depth_at_offset((r - stick_radius) * (r + stick_radius))
    }

    /// Limiting wear depth, m, at the radius `r` with `r² - c² = offset`, m²; zero for negative offsets and beyond `a∞`.
    pub fn wear_depth_at_offset(&self, offset: f64) -> f64 {
        let stick_radius = self.stick_radius();
        let span = 0.5 * (offset / stick_radius / stick_radius).max(0.0).ln_1p();
        if !(span > 0.0 && span < self.limiting_span()) {
            return 0.0;
        }
        self.indentation() * self.integral.depth(span, span - self.stick_logarithm).max(0.0)
    }

    /// Limiting profile `f∞ = f0 + Δf`, m, at radius `r`, m.
    pub fn profile(&self, r: f64) -> f64 {
        self.indenter.profile(r) + self.wear_depth(r)
    }
}

/// Equivalent profile and contact radius of the first contact.
fn first_contact(indenter: &Indenter, grading: f64, indentation: f64) -> Result<(EquivalentProfile, f64)> {
    if !(indentation > 0.0 && indentation.is_finite()) {
        return Err(Error::OutOfRange { name: "loading.indentation", value: indentation, range: "(0, inf)" });
    }
    let profile = indenter.equivalent_profile(grading)?;
    let contact_radius = profile.radius_at(indentation)?;
    Ok((profile, contact_radius))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::quadrature::MAX_NODES;

    /// The same shape by the largest rule there is.
    fn refined(shape: &LimitingShape) -> LimitingShape {
        let mut fine = shape.clone();
        fine.integral = fine.integral.with_nodes(MAX_NODES);
        fine.growth_logarithm =
            fine.integral.growth_with_nodes(shape.stick_logarithm, 1.0001 * shape.growth_logarithm).unwrap();
        fine.deepest = fine.find_deepest().unwrap();
        fine
    }

    #[test]
    fn the_nodes_chosen_are_as_good_as_two_hundred() {
        let (mut worst, mut compared) = ((0.0, String::new()), 0);
        let power_laws = [0.2, 1.0, 2.0, 10.0].map(|n| Indenter::power_law(1.0, n).unwrap());
        let spheres = [1.5, 3.0, 1e3].map(|radius| Indenter::sphere(radius).unwrap());
        for indenter in power_laws.into_iter().chain(spheres) {
            for grading in [-0.9999, -0.9, -0.5, 0.0, 0.5, 0.9, 0.9999] {
                for ratio in [1e-9, 1e-6, 1e-3, 0.05, 0.3, 0.7, 0.99, 1.0 - 1e-10] {
                    let depth = indenter.equivalent_profile(grading).unwrap().value(1.0);
                    let Ok(shape) = LimitingShape::from_stick_ratio(&indenter, grading, depth, ratio) else {
                        continue; // a sphere in to its equator
                    };
                    let fine = refined(&shape);
                    let errors = [
                        shape.growth_logarithm / fine.growth_logarithm - 1.0,
                        shape.wear_volume() / fine.wear_volume() - 1.0,
                        shape.wear_depth_max() / fine.wear_depth_max() - 1.0,
                    ];
                    let error = errors.iter().fold(0.0, |largest: f64, error| largest.max(error.abs()));
                    compared += 1;
                    assert!(!error.is_nan(), "{indenter:?}, k = {grading}, c/a0 = {ratio}");
                    if error > worst.0 {
                        worst = (error, format!("{indenter:?}, k = {grading}, c/a0 = {ratio}: {errors:?}"));
                    }
                }
            }
        }
        assert!(compared > 350, "only {compared} shapes");
        assert!(worst.0 < 1e-12, "{worst:?}");
    }
}
