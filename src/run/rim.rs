//! Ground that debris spares at the contact edge, where the law of wear is not local.

use crate::error::{Error, Result};
use crate::solver::model::Model;
use crate::solver::simulation::{End, Simulation};

/// What the wear next to the contact edge may take off the slope of the profile there, over that slope, the part `q_c/d` of the indentation, at most 1, and `(1+k)²`:
/// of 252 runs in partial slip none below comes to no end, and above it one is done and thirteen are told (docs/extremes.md).
const RIM: f64 = 60.0;

/// Part of the moment that is given as a cure, so that rounding to two digits does not lead beyond it.
const SURE: f64 = 0.95;

/// Relative step of the slope.
const STEP: f64 = 1e-6;

/// Refuses runs of a contact that sticks somewhere in which its edge would jump.
pub(super) fn check_partial_slip(simulation: &Simulation) -> Result<()> {
    let (model, contact) = (simulation.model(), simulation.model().contact());
    if model.gross().is_some() {
        return Ok(());
    }
    let depth = simulation.fields().slip_depth.last().copied().unwrap_or_default();
    let slip = contact.friction().coefficient / contact.half_space().stiffness_ratio() * depth;
    check(model, simulation.plan().end, slip)
}

/// The same of a contact all of which slides.
pub(super) fn check_gross_slip(model: &Model, end: End) -> Result<()> {
    check(model, end, model.contact().amplitude())
}

/// Refuses runs in which the contact edge would jump.
///
/// Debris that leaves spares the ground next to the contact edge, and what stays wears the ground farther inside: the depth rises as `(a - r)/length` there.
/// Once that outweighs the slope of the profile, a rim stands out at the edge and takes the load. The edge moves the faster, as
/// the root of the time that is left, and none is found near by from then on.
///
/// ```text
/// N w'(a) > 60 (1+k)² (q_c/d) f_0'(a),    w'(a) = 4 k_w p_m (μ_f/M) S_0(a)/length
/// ```
///
/// Where the whole contact slides the ground slips by the amplitude `A` for `(μ_f/M) S_0(a)`, and `q_c/d` counts as 1.
fn check(model: &Model, end: End, slip: f64) -> Result<()> {
    let contact = model.contact();
    let grading = contact.half_space().grading();
    let spreading = model.schedule().conditions().wear.spreading();
    let Some(spreading) = spreading.filter(|_| contact.half_space().loads_rims()) else {
        return Ok(());
    };
    let radius = contact.contact_radius();
    let height = |part: f64| contact.indenter().profile(part * radius);
    let slope = (height(1.0) - height(1.0 - STEP)) / (STEP * radius);
    let rise = 4.0 * contact.wear().coefficient * contact.mean_pressure() * slip / spreading.length;
    let severity = (contact.slip_compression() / contact.indentation()).min(1.0);
    let cycles = RIM * severity * (1.0 + grading).powi(2) * slope / rise;
    let end = match end {
        End::Cycles(cycles) => cycles,
        End::Rate(_) => f64::INFINITY,
    };
    if end <= cycles {
        return Ok(());
    }
    let tau = cycles * contact.tau_per_cycle();
    let why = format!(
        "debris that leaves within {:e} m of the contact edge spares the ground there, which at grading {grading} stands out as a rim from cycle {cycles:.2e} (τ = {tau:.2e}) on and \
         takes the load, so that the edge jumps; end before (loading.tau = {:.1e}), or ask for a longer one",
        spreading.length,
        SURE * tau
    );
    Err(Error::Inconsistent { what: "wear.non-local.length", why })
}
