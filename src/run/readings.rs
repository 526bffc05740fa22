//! What a run and a closed form come to, each result declared once: JSON, columns of sweeps and lines for people are made from it.

use super::Results;
use crate::contact::InitialContact;
use crate::contact::closed_form::LimitingShape;
use crate::data::quantity::{Reading, named, number, word};
use crate::data::{LimitDistance, Value};
use crate::error::{Error, Result};
use crate::numerics::linear::largest;
use crate::scene::Scene;

/// The results of a run, in the order of the keys of the JSON.
pub const RUN: [Reading<Results>; 23] = [
    word("stop_reason", "why the run stopped", |it| it.stop_reason().name().into()),
    number(
        "error_estimate",
        "1",
        "estimated error of worn volume and profile, relative to those of the limit",
        |it| it.checkpoint().error_estimate.into(),
    ),
    number(
        "accuracy_met",
        "1",
        "1 if the estimated error is as small as was asked for, 0 if not; missing where springs were given by hand",
        |it| it.accuracy_met().into(),
    ),
    number("cycles", "1", "number of fretting cycles", |it| it.last().cycles.into()),
    number("tau", "1", "dimensionless time", |it| it.last().tau.into()),
    number("steps", "1", "steps accepted", |it| it.checkpoint().progress.steps.into()),
    number("rejected_steps", "1", "steps rejected", |it| it.checkpoint().progress.rejected_steps.into()),
    number("rate_evaluations", "1", "evaluations of the wear rate", |it| {
        it.checkpoint().progress.rate_evaluations.into()
    }),
    number("wall_seconds", "s", "wall time used", |it| it.checkpoint().wall_seconds.into()),
    number("indentation", "m", "indentation depth", |it| it.last().indentation.into()),
    number("normal_force", "N", "normal force", |it| it.last().normal_force.into()),
    number("contact_radius", "m", "contact radius", |it| it.last().contact_radius.into()),
    number("stick_radius", "m", "radius of the stick zone", |it| it.last().stick_radius.into()),
    number("wear_volume", "m3", "worn volume", |it| it.last().wear_volume.into()),
    number("wear_depth_max", "m", "largest wear depth", |it| largest(&it.last().wear_depth).into()),
    number("wear_volume_limit", "m3", "worn volume in the limit of many cycles", |it| {
        it.limit().map(LimitingShape::wear_volume).into()
    }),
    number(
        "limit_distance",
        "1",
        "largest distance of the profile to the limit, over the indentation",
        |it| it.distance().map(|it| it.distance).into(),
    ),
    number("limit_distance_relative", "1", "the same over the largest wear depth of the limit", |it| {
        it.distance().and_then(|LimitDistance { distance_relative, .. }| distance_relative).into()
    }),
    number("dissipated_energy", "J", "energy dissipated by friction since the start", |it| {
        it.last().dissipated_energy.into()
    }),
    word("regime", "what the last cycle does to the contact", |it| it.last().regime.name().into()),
    word(
        "fretting_regime",
        "fretting regime of the run: mixed where some cycles were in gross slip and some were not",
        |it| it.fretting_regime().last().map(|it| it.name()).into(),
    ),
    number("energy_ratio", "1", "energy of the last fretting loop over 4 Q* δ*", |it| {
        it.last().energy_ratio.into()
    }),
    number("sliding_ratio", "1", "width of the last fretting loop at no force over the stroke", |it| {
        it.last().sliding_ratio.into()
    }),
];

/// The first contact of a scene and its limiting shape.
#[derive(Debug, Clone)]
pub struct ClosedForm {
    /// The contact before any wear.
    pub contact: InitialContact,
    /// What it tends to; none under full sliding.
    pub limit: Option<LimitingShape>,
    /// Whether the normal force is held, and not the indentation.
    holds_normal_force: bool,
}

impl ClosedForm {
    /// The closed form for a scene.
    ///
    /// # Errors
    /// As [`InitialContact::new`] and [`LimitingShape::from_contact`].
    pub fn new(scene: &Scene) -> Result<Self> {
        let (form, unlimited) = Self::with_or_without_limit(scene)?;
        unlimited.map_or(Ok(form), Err)
    }

    /// The closed form, without its limit where that cannot be formed, and why it cannot.
    ///
    /// # Errors
    /// As [`InitialContact::new`].
    pub(crate) fn with_or_without_limit(scene: &Scene) -> Result<(Self, Option<Error>)> {
        let (contact, conditions) = (scene.contact()?, scene.conditions());
        let (limit, why) = match LimitingShape::under(&contact, conditions) {
            Ok(limit) => (limit, None),
            Err(error) => (None, Some(error)),
        };
        Ok((Self { contact, limit, holds_normal_force: conditions.holds_normal_force }, why))
    }

    /// `a∞ - a0`, m: under both forces held the shape's own first contact is a deeper one.
    fn growth(&self) -> Option<f64> {
        let deeper = |shape: &LimitingShape| shape.contact_radius_initial() - self.contact.contact_radius();
        self.limit.as_ref().map(|shape| shape.contact_growth_limit() + deeper(shape) + 0.0)
    }

    /// `F∞`, N.
    fn normal_force_limit(&self) -> Option<f64> {
        let part = |shape: &LimitingShape| if self.holds_normal_force { 1.0 } else { shape.load_fraction() };
        self.limit.as_ref().map(|shape| self.contact.normal_force() * part(shape))
    }

    fn of_limit(&self, of: fn(&LimitingShape) -> f64) -> Value {
        // Zero without its sign.
        self.limit.as_ref().map(|shape| of(shape) + 0.0).into()
    }
}

/// A number with its name in lines for people.
const fn line(
    heading: &'static str,
    name: &'static str,
    units: &'static str,
    long_name: &'static str,
    of: fn(&ClosedForm) -> Value,
) -> Reading<ClosedForm> {
    number(name, units, long_name, of).headed(heading)
}

/// The results of a closed form, in the order of the keys of the JSON.
pub const LIMIT: [Reading<ClosedForm>; 21] = [
    line("grading k", "grading", "1", "grading k of E = E0 (z/z0)^k", |it| {
        it.contact.half_space().grading().into()
    }),
    line("stiffness ratio M", "stiffness_ratio", "1", "tangential over normal stiffness", |it| {
        it.contact.half_space().stiffness_ratio().into()
    }),
    line("normal stiffness c_N", "normal_stiffness", "1", "normal stiffness c_N, N/m^(2+k)", |it| {
        it.contact.half_space().normal_stiffness().into()
    }),
    line("friction coefficient", "friction_coefficient", "1", "friction coefficient", |it| {
        it.contact.friction().coefficient.into()
    }),
    line("indentation d", "indentation", "m", "indentation depth", |it| it.contact.indentation().into()),
    line("normal force F_N, unworn", "normal_force", "N", "normal force before any wear", |it| {
        it.contact.normal_force().into()
    }),
    line("amplitude U", "amplitude", "m", "tangential amplitude", |it| it.contact.amplitude().into()),
    line(
        "amplitude of full sliding",
        "amplitude_full_sliding",
        "m",
        "tangential amplitude from which on everything slides",
        |it| it.contact.amplitude_full_sliding().into(),
    ),
    word("regime", "what the oscillation does to the contact", |it| it.contact.regime().name().into()),
    line(
        "contact radius a0, unworn",
        "contact_radius_initial",
        "m",
        "contact radius before any wear",
        |it| it.contact.contact_radius().into(),
    ),
    line("stick radius c", "stick_radius", "m", "radius of the stick zone", |it| {
        it.contact.stick_radius().into()
    }),
    line(
        "energy ratio A, unworn",
        "energy_ratio",
        "1",
        "energy of the fretting loop over 4 Q* δ* before any wear",
        |it| it.contact.energy_ratio().ok().into(),
    ),
    line(
        "energy ratio of full sliding",
        "energy_ratio_transition",
        "1",
        "the same where full sliding begins",
        |it| it.contact.energy_ratio_transition().ok().into(),
    ),
    line(
        "sliding ratio, unworn",
        "sliding_ratio",
        "1",
        "width of the fretting loop at no force over the stroke before any wear",
        |it| it.contact.sliding_ratio().ok().into(),
    ),
    line(
        "contact radius a∞, limit",
        "contact_radius_limit",
        "m",
        "contact radius in the limit of many cycles",
        |it| it.of_limit(LimitingShape::contact_radius_limit),
    ),
    line(
        "width of the worn annulus a∞ - c",
        "slip_width_limit",
        "m",
        "width of the worn annulus in the limit",
        |it| it.of_limit(LimitingShape::slip_width_limit),
    ),
    line(
        "growth of the contact a∞ - a0",
        "contact_growth_limit",
        "m",
        "growth of the contact radius up to the limit",
        |it| it.growth().into(),
    ),
    line(
        "indentation d∞, limit",
        "indentation_limit",
        "m",
        "indentation depth in the limit of many cycles",
        |it| it.of_limit(LimitingShape::indentation),
    ),
    line(
        "worn volume ΔV∞, limit",
        "wear_volume_limit",
        "m3",
        "worn volume in the limit of many cycles",
        |it| it.of_limit(LimitingShape::wear_volume),
    ),
    line(
        "worn volume, small amplitudes",
        "wear_volume_asymptotic",
        "m3",
        "the same for small amplitudes",
        |it| it.of_limit(LimitingShape::wear_volume_asymptotic),
    ),
    line("largest wear depth, limit", "wear_depth_max", "m", "largest wear depth of the limit", |it| {
        it.of_limit(LimitingShape::wear_depth_max)
    }),
];

/// More of the first contact and of the limit, which a check of a scene shows.
const CHECK: [Reading<ClosedForm>; 6] = [
    line(
        "tangential stiffness c_T",
        "tangential_stiffness",
        "1",
        "tangential stiffness c_T, N/m^(2+k)",
        |it| {
            let half_space = it.contact.half_space();
            (half_space.stiffness_ratio() * half_space.normal_stiffness()).into()
        },
    ),
    line(
        "wear coefficient",
        "wear_coefficient",
        "1/Pa",
        "coefficient of Archard's law that stands for the law of wear",
        |it| it.contact.wear().coefficient.into(),
    ),
    line("mean pressure, unworn", "mean_pressure", "Pa", "mean pressure before any wear", |it| {
        it.contact.mean_pressure().into()
    }),
    line("stick ratio c/a0", "stick_ratio", "1", "radius of the stick zone over that of the contact", |it| {
        it.contact.stick_logarithm().map(|logarithm| (-logarithm).exp()).into()
    }),
    line(
        "normal force, limit",
        "normal_force_limit",
        "N",
        "normal force in the limit of many cycles",
        |it| it.normal_force_limit().into(),
    ),
    line("dimensionless time per cycle", "tau_per_cycle", "1", "dimensionless time of one cycle", |it| {
        it.contact.tau_per_cycle().into()
    }),
];

/// What is declared of a closed form under some names, which blanks separate.
///
/// # Panics
/// If nothing is under one of them.
pub(crate) fn closed_form(names: &str) -> impl Iterator<Item = &'static Reading<ClosedForm>> {
    named(LIMIT.iter().chain(&CHECK), names)
}
