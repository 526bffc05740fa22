//! Wear in time as `k → 1`, where both transforms become the identity and each radius wears on its own.

use std::f64::consts::PI;

use crate::contact::InitialContact;
use crate::contact::indenter::Indenter;
use crate::error::Result;
use crate::numerics::quadrature::Rule;

/// Panels of the worn volume, each half as wide as the one outside it: the depth rises next to the edge of stick within a width that falls
/// exponentially in time.
const PANELS: i32 = 60;

/// Plain tangential oscillation under Archard's and Coulomb's laws in the limit `k → 1`.
///
/// ```text
/// (f - f_c)/(d - f) = (f0 - f_c)/(d - f0) exp[(1 - f_c/d) τ/π],    f_c = f0(c),    c < r < a,    f0(a) = d
/// ```
/// At `1 - k` above zero the depth differs from it by some `0.05 (1 - k)` of the limit's largest one (`tests/transient.rs`).
#[derive(Debug, Clone)]
pub struct GibsonTransient {
    indenter: Indenter,
    stick_radius: f64,
    contact_radius: f64,
    indentation: f64,
    rule: Rule,
}

impl GibsonTransient {
    /// The same for a contact whose grading is near 1; none unless it slips in part.
    ///
    /// # Errors
    /// Those of the quadrature.
    pub fn from_contact(contact: &InitialContact) -> Result<Option<Self>> {
        let Some(stick_radius) = contact.stick_radius() else { return Ok(None) };
        Ok(Some(Self {
            indenter: contact.indenter().clone(),
            stick_radius,
            contact_radius: contact.contact_radius(),
            indentation: contact.indentation(),
            rule: Rule::legendre(12)?,
        }))
    }

    /// Wear depth, m, at radius `r`, m, and dimensionless time `tau`.
    pub fn wear_depth(&self, r: f64, tau: f64) -> f64 {
        let (d, initial, stuck) =
            (self.indentation, self.indenter.profile(r), self.indenter.profile(self.stick_radius));
        if r <= self.stick_radius || initial >= d {
            return 0.0;
        }
        let odds = (initial - stuck) / (d - initial);
        let growth = (1.0 - stuck / d) * tau / PI;
        // f - f0 with f = (f_c + d X)/(1 + X) and X the odds times the growth; nothing cancels.
        let part = (d - initial) * odds * growth.exp_m1();
        part / (1.0 + odds * growth.exp())
    }

    /// Worn volume, m³, at dimensionless time `tau`.
    pub fn wear_volume(&self, tau: f64) -> f64 {
        let (c, width) = (self.stick_radius, self.contact_radius - self.stick_radius);
        let panel = |number: i32| {
            let outer = 0.5_f64.powi(number);
            let inner = if number + 1 == PANELS { 0.0 } else { 0.5 * outer };
            let at = |x: f64| c + width * (inner + x * (outer - inner));
            (outer - inner) * self.rule.mean(|x| self.wear_depth(at(x), tau) * at(x))
        };
        2.0 * PI * width * (0..PANELS).rev().map(panel).sum::<f64>()
    }
}
