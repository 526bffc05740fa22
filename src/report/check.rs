//! `fretwear check`: everything that follows from a scene without stepping in time.

use serde::Serialize;

use super::text::{Scale, TextTable, number};
use super::{conditions, unsigned_zero};
use crate::contact::InitialContact;
use crate::contact::closed_form::LimitingShape;
use crate::contact::indenter::{SmoothedBy, Smoothing};
use crate::contact::stick_slip::Regime;
use crate::error::Result;
use crate::laws::conditions::Conditions;
use crate::laws::loading::Duration;
use crate::run::{Expected, Method, Simulation};
use crate::scene::Scene;

/// Steepest flank at the edge of contact that is not worth a word.
const STEEP: f64 = 0.3;

/// Fewest rows within the contact that describe a measured profile well.
const FEW_ROWS: usize = 10;

/// Dimensionless time of one cycle up to which the shape hardly changes within it.
const LONG_CYCLE: f64 = 0.01;

/// The quantities derived from a scene, in SI; the fields are the keys of the JSON.
///
/// # Examples
/// ```
/// # use std::path::Path;
/// use fretwear::report::{CheckReport, json};
/// use fretwear::scene::Scene;
///
/// let scene = Scene::from_path(Path::new("data/scenes/paraboloid.toml"))?;
/// let report = CheckReport::new(&scene)?;
/// assert!((report.contact_radius_initial - 8.7e-5).abs() < 1e-6);
/// assert!(report.text().contains("regime                             partial-slip"));
/// assert!(json(&report).contains("\"regime\": \"partial-slip\""));
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone, Serialize)]
pub struct CheckReport {
    /// Title of the scene.
    pub title: Option<String>,
    /// The indenter in words.
    pub indenter: String,
    /// How the rows of a measured profile were smoothed; none where they are taken as they are.
    pub smoothing: Option<Smoothing>,
    /// Grading `k`.
    pub grading: f64,
    /// `c_N`, N/m^(2+k).
    pub normal_stiffness: f64,
    /// `c_T`, N/m^(2+k).
    pub tangential_stiffness: f64,
    /// `M`.
    pub stiffness_ratio: f64,
    /// Laws, mode, blocks and control.
    pub conditions: Conditions,
    /// `μ_f`, of Coulomb's law that stands for the law of friction.
    pub friction_coefficient: f64,
    /// `k_w`, 1/Pa, of Archard's law that stands for the law of wear.
    pub wear_coefficient: f64,
    /// `d`, m.
    pub indentation: f64,
    /// `F_N` before any wear, N.
    pub normal_force: f64,
    /// Mean pressure before any wear, Pa.
    pub mean_pressure: f64,
    /// `U`, m.
    pub amplitude: f64,
    /// `μ_f d/M`, m.
    pub amplitude_full_sliding: f64,
    /// `stick`, `partial-slip` or `full-sliding`.
    pub regime: &'static str,
    /// `a0`, m.
    pub contact_radius_initial: f64,
    /// `c`, m; none under full sliding, as all that follows of the limit.
    pub stick_radius: Option<f64>,
    /// `c/a0`.
    pub stick_ratio: Option<f64>,
    /// `a∞`, m.
    pub contact_radius_limit: Option<f64>,
    /// `ΔV∞`, m³.
    pub wear_volume_limit: Option<f64>,
    /// Largest depth of the limit, m.
    pub wear_depth_max: Option<f64>,
    /// `F∞`, N.
    pub normal_force_limit: Option<f64>,
    /// Dimensionless time of one cycle.
    pub tau_per_cycle: f64,
    /// Cycles planned; none if the rate of wear decides.
    pub cycles: Option<f64>,
    /// Dimensionless time planned; none if the rate of wear decides.
    pub tau: Option<f64>,
    /// Fraction of the first rate of wear at which the run ends.
    pub until_rate: Option<f64>,
    /// How it is computed; none for a scene that cannot be run.
    #[serde(flatten)]
    pub method: Option<Method>,
    /// Wall time that a run will take, s, in order of size; none where that is short.
    pub seconds_expected: Option<f64>,
    /// What is allowed but deserves a word.
    pub warnings: Vec<String>,
}

impl CheckReport {
    /// Derives the quantities of a scene that can be run.
    ///
    /// # Errors
    /// Those of [`Simulation::check`]: all that a run refuses before its first step.
    pub fn new(scene: &Scene) -> Result<Self> {
        let Expected { method, seconds, warning } = Simulation::check(scene)?;
        let mut report = Self::derived(scene)?;
        report.warnings.extend(warning);
        Ok(Self { method: Some(method), seconds_expected: seconds, ..report })
    }

    /// Derives the quantities, also of a scene that cannot be run.
    ///
    /// # Errors
    /// As [`InitialContact::new`] and [`Duration::span`].
    pub fn derived(scene: &Scene) -> Result<Self> {
        let contact = scene.contact()?;
        let limit = LimitingShape::under(&contact, scene.conditions());
        let unlimited = limit.as_ref().err().map(|error| format!("the first cycle has no limit: {error}"));
        let limit = limit.ok().flatten();
        let of_limit =
            |value: fn(&LimitingShape) -> f64| limit.as_ref().map(|shape| unsigned_zero(value(shape)));
        let half_space = contact.half_space();
        let duration = scene.loading().duration;
        let span = duration.span(contact.tau_per_cycle())?;
        let mut warnings = scene.warnings().to_vec();
        warnings.extend(unlimited);
        warnings.extend(doubts(&contact, limit.as_ref()));
        Ok(Self {
            title: scene.title().map(str::to_owned),
            indenter: contact.indenter().words(),
            smoothing: scene.table().and_then(|table| table.smoothing().copied()),
            grading: half_space.grading(),
            normal_stiffness: half_space.normal_stiffness(),
            tangential_stiffness: half_space.stiffness_ratio() * half_space.normal_stiffness(),
            stiffness_ratio: half_space.stiffness_ratio(),
            conditions: scene.conditions().clone(),
            friction_coefficient: contact.friction().coefficient,
            wear_coefficient: contact.wear().coefficient,
            indentation: contact.indentation(),
            normal_force: contact.normal_force(),
            mean_pressure: contact.mean_pressure(),
            amplitude: contact.amplitude(),
            amplitude_full_sliding: contact.amplitude_full_sliding(),
            regime: contact.regime().name(),
            contact_radius_initial: contact.contact_radius(),
            stick_radius: contact.stick_radius(),
            stick_ratio: contact.stick_logarithm().map(|logarithm| (-logarithm).exp()),
            contact_radius_limit: of_limit(LimitingShape::contact_radius_limit),
            wear_volume_limit: of_limit(LimitingShape::wear_volume),
            wear_depth_max: of_limit(LimitingShape::wear_depth_max),
            normal_force_limit: limit.as_ref().map(|shape| match scene.conditions().holds_normal_force {
                true => contact.normal_force(),
                false => contact.normal_force() * shape.load_fraction(),
            }),
            tau_per_cycle: contact.tau_per_cycle(),
            cycles: span.map(|[cycles, _]| cycles),
            tau: span.map(|[_, tau]| tau),
            until_rate: if let Duration::UntilRate(rate) = duration { Some(rate) } else { None },
            method: None,
            seconds_expected: None,
            warnings,
        })
    }

    /// A table for people.
    pub fn text(&self) -> String {
        self.table().text()
    }

    /// Its lines.
    pub(crate) fn table(&self) -> TextTable {
        let lengths = |value: Option<f64>| value.map(|value| Scale::LENGTH.show(value));
        let stiffness = |value: f64| format!("{} N/m^{}", number(value), number(2.0 + self.grading));
        let mut rows = TextTable::titled(self.title.as_deref());
        rows.row("indenter", &self.indenter);
        if let Some(smoothing) = &self.smoothing {
            put_smoothing(&mut rows, smoothing);
        }
        rows.row("grading k", number(self.grading));
        rows.row("normal stiffness c_N", stiffness(self.normal_stiffness));
        rows.row("tangential stiffness c_T", stiffness(self.tangential_stiffness));
        rows.row("stiffness ratio M", number(self.stiffness_ratio));
        rows.row("friction coefficient", number(self.friction_coefficient));
        rows.row("wear coefficient", format!("{} 1/Pa", number(self.wear_coefficient)));
        conditions::put(&mut rows, &self.conditions);
        rows.gap();
        rows.row("indentation d", Scale::LENGTH.show(self.indentation));
        rows.row("normal force F_N, unworn", Scale::FORCE.show(self.normal_force));
        rows.row("mean pressure, unworn", Scale::PRESSURE.show(self.mean_pressure));
        rows.row("amplitude U", Scale::LENGTH.show(self.amplitude));
        rows.row("amplitude of full sliding", Scale::LENGTH.show(self.amplitude_full_sliding));
        rows.row("regime", self.regime);
        rows.row("contact radius a0, unworn", Scale::LENGTH.show(self.contact_radius_initial));
        let stick = self.stick_radius.zip(self.stick_ratio);
        rows.optional(
            "stick radius c",
            stick.map(|(radius, ratio)| format!("{} = {} a0", Scale::LENGTH.show(radius), number(ratio))),
        );
        rows.gap();
        rows.optional("contact radius a∞, limit", lengths(self.contact_radius_limit));
        rows.optional("worn volume ΔV∞, limit", self.wear_volume_limit.map(|it| Scale::VOLUME.show(it)));
        rows.optional("largest wear depth, limit", lengths(self.wear_depth_max));
        rows.optional("normal force, limit", self.normal_force_limit.map(|it| Scale::FORCE.show(it)));
        rows.gap();
        rows.row("dimensionless time per cycle", number(self.tau_per_cycle));
        if let Some((cycles, tau)) = self.cycles.zip(self.tau) {
            rows.row("cycles planned", number(cycles));
            rows.row("dimensionless time planned", number(tau));
        }
        if let Some(rate) = self.until_rate {
            rows.row("planned until", format!("the rate of wear is {} of its first value", number(rate)));
        }
        if let Some(method) = &self.method {
            rows.gap();
            rows.row("slip of a cycle", method.cycle);
            rows.row("springs", format!("{} over the {}", method.springs, method.mesh.replace('-', " ")));
            rows.row("edge of stick", method.stick_edge);
            rows.row("time stepping", method.time_stepping);
            rows.row("memory of its matrices", format!("{} MB", number(1e-6 * method.memory_expected)));
            let seconds = self.seconds_expected.map(|it| Scale::TIME.show(it));
            rows.row("wall time expected", seconds.unwrap_or_else(|| "below a minute".into()));
        }
        rows
    }
}

/// What the rows of a measured profile were replaced by, and how far they lie from it.
fn put_smoothing(rows: &mut TextTable, smoothing: &Smoothing) {
    let length = |value: f64| Scale::LENGTH.show(value);
    let by = match smoothing.by {
        SmoothedBy::Paraboloid => "the best paraboloid",
        SmoothedBy::Spline => "a smoothing spline",
        SmoothedBy::BoundedSpline => "a smoothing spline, kept from bending back",
        SmoothedBy::Rows => "nothing: the rows are taken as they are",
    };
    rows.row("profile smoothed by", by);
    if smoothing.by == SmoothedBy::Rows {
        return;
    }
    rows.row(
        "residual of its rows",
        format!(
            "rms {} of {} given, largest {} at r = {}",
            length(smoothing.residual_rms),
            length(smoothing.deviation),
            length(smoothing.residual_largest),
            length(smoothing.residual_largest_radius)
        ),
    );
    rows.optional("radius of curvature at the tip", smoothing.tip_radius.map(length));
}

/// Doubts about what was given as the deviation of a measured profile.
fn doubt_of_smoothing(smoothing: &Smoothing) -> Option<String> {
    // The root mean square of a few dozen residuals is known to a fifth.
    const FAR: f64 = 1.3;
    let given = Scale::LENGTH.show(smoothing.deviation);
    let found = Scale::LENGTH.show(smoothing.residual_rms);
    if smoothing.by == SmoothedBy::Rows {
        Some(format!(
            "indenter.table.smoothing = {given} is less than a spline leaves; the rows are taken as they are"
        ))
    } else if smoothing.residual_rms * FAR < smoothing.deviation {
        Some(format!(
            "the rows lie nearer to the smoothed profile, {found} on average, than indenter.table.smoothing = {given}; give {found} if that is \
             their noise"
        ))
    } else {
        None
    }
}

/// Where the model leaves its ground.
fn doubts(contact: &InitialContact, limit: Option<&LimitingShape>) -> Vec<String> {
    let mut doubts = Vec::new();
    match contact.regime() {
        Regime::FullSliding => doubts.push(format!(
            "full sliding: the amplitude {} is not below {}, so there is no stick zone and no limiting shape",
            Scale::LENGTH.show(contact.amplitude()),
            Scale::LENGTH.show(contact.amplitude_full_sliding()),
        )),
        Regime::Stick => doubts.push("no slip at this amplitude: nothing wears".into()),
        Regime::PartialSlip => {}
    }
    let outermost = limit
        .map_or(contact.contact_radius(), |shape| shape.contact_radius_limit().max(contact.contact_radius()));
    let slope = contact.indenter().profile_derivative(outermost);
    // Beyond the equator of a sphere the slope is not a number.
    if slope > STEEP || slope.is_nan() {
        doubts.push(format!(
            "the flank rises by {} per metre at the edge of contact; the model takes slopes as small against 1",
            number(slope)
        ));
    }
    if let Some(table) = contact.indenter().table() {
        doubts.extend(table.smoothing().and_then(doubt_of_smoothing));
        let within = table.radii().iter().filter(|r| **r <= contact.contact_radius()).count();
        if within < FEW_ROWS {
            doubts.push(format!(
                "only {within} rows of the table lie within the contact radius of {}: what is between them decides; measure closer",
                Scale::LENGTH.show(contact.contact_radius())
            ));
        }
    }
    if contact.tau_per_cycle() > LONG_CYCLE {
        doubts.push(format!(
            "one cycle takes a dimensionless time of {}; the model takes the wear of one cycle as small",
            number(contact.tau_per_cycle())
        ));
    }
    doubts
}
