//! `fretwear check`: everything that follows from a scene without stepping in time.

use serde::Serialize;

use super::conditions;
use super::limit::put_closed_form;
use super::text::{Scale, TextTable, number};
use crate::contact::InitialContact;
use crate::contact::closed_form::LimitingShape;
use crate::contact::indenter::{SmoothedBy, Smoothing};
use crate::contact::stick_slip::Regime;
use crate::data::quantity::Entries;
use crate::error::Result;
use crate::laws::conditions::Conditions;
use crate::laws::loading::Duration;
use crate::run::readings::{ClosedForm, closed_form};
use crate::run::{Expected, Method, Simulation};
use crate::scene::Scene;

/// Steepest flank at the edge of contact that is not worth a word.
const STEEP: f64 = 0.3;

/// Fewest rows within the contact that describe a measured profile well.
const FEW_ROWS: usize = 10;

/// Dimensionless time of one cycle up to which the shape hardly changes within it.
const LONG_CYCLE: f64 = 0.01;

/// Names of what is said of the medium, as in the JSON.
const MEDIUM: &str = "grading normal_stiffness tangential_stiffness stiffness_ratio";

/// Names of what is said of the first contact and of the limit, as in the JSON.
const CONTACT: &str = "friction_coefficient wear_coefficient indentation normal_force mean_pressure amplitude amplitude_full_sliding \
                       regime contact_radius_initial stick_radius stick_ratio contact_radius_limit wear_volume_limit wear_depth_max \
                       normal_force_limit tau_per_cycle";

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
/// assert!((report.form.contact.contact_radius() - 8.7e-5).abs() < 1e-6);
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
    #[serde(flatten)]
    medium: Entries,
    /// Laws, mode, blocks and control.
    pub conditions: Conditions,
    #[serde(flatten)]
    contact: Entries,
    /// What the numbers are read off; under full sliding it has no limit.
    #[serde(skip)]
    pub form: ClosedForm,
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
    /// As [`InitialContact::new`](crate::contact::InitialContact::new) and [`Duration::span`].
    pub fn derived(scene: &Scene) -> Result<Self> {
        let (form, unlimited) = ClosedForm::with_or_without_limit(scene)?;
        let duration = scene.loading().duration;
        let span = duration.span(form.contact.tau_per_cycle())?;
        let mut warnings = scene.warnings().to_vec();
        warnings.extend(unlimited.map(|error| format!("the first cycle has no limit: {error}")));
        warnings.extend(doubts(&form.contact, form.limit.as_ref()));
        let entries = |names| closed_form(names).map(|it| it.entry(&form)).collect();
        Ok(Self {
            title: scene.title().map(str::to_owned),
            indenter: form.contact.indenter().words(),
            smoothing: scene.table().and_then(|table| table.smoothing().copied()),
            medium: entries(MEDIUM),
            conditions: scene.conditions().clone(),
            contact: entries(CONTACT),
            cycles: span.map(|[cycles, _]| cycles),
            tau: span.map(|[_, tau]| tau),
            until_rate: if let Duration::UntilRate(rate) = duration { Some(rate) } else { None },
            method: None,
            seconds_expected: None,
            warnings,
            form,
        })
    }

    /// A table for people.
    pub fn text(&self) -> String {
        self.table().text()
    }

    /// Its lines.
    pub(crate) fn table(&self) -> TextTable {
        let mut rows = TextTable::titled(self.title.as_deref());
        rows.row("indenter", &self.indenter);
        if let Some(smoothing) = &self.smoothing {
            put_smoothing(&mut rows, smoothing);
        }
        put_closed_form(&mut rows, closed_form(MEDIUM), &self.form);
        conditions::put(&mut rows, &self.conditions);
        rows.gap();
        put_closed_form(&mut rows, closed_form(CONTACT), &self.form);
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
            let edge = match method.stick_edge {
                "on-mesh" => "moves over the springs",
                edge => edge,
            };
            rows.row("edge of stick", edge);
            rows.row("time stepping", method.time_stepping);
            if let Some(how) = method.repeated_blocks {
                let words = match how {
                    "averaged" => "averaged over passes",
                    "stepped-at-first" => "stepped through until passes are short, then averaged over them",
                    _ => "stepped through",
                };
                rows.row("repeated blocks", words);
            }
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
