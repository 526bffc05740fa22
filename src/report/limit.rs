//! `fretwear limit`: the closed form for a scene.

use std::fmt::Write;

use serde::Serialize;

use super::text::{Scale, TextTable, number};
use super::{bad_option, unsigned_zero};
use crate::contact::InitialContact;
use crate::contact::closed_form::LimitingShape;
use crate::contact::indenter::Indenter;
use crate::data::quantity::{Entries, Reading};
use crate::error::Result;
use crate::run::readings::{ClosedForm, LIMIT};
use crate::scene::Scene;
use crate::units::{Dimension, parse};

/// The limiting shape of a scene, in SI; the keys of the JSON are [`LIMIT`] and the profile.
///
/// Under full sliding there is no limit, and what belongs to it is null.
///
/// # Examples
/// ```
/// # use std::path::Path;
/// use fretwear::report::LimitReport;
/// use fretwear::scene::Scene;
///
/// let scene = Scene::from_path(Path::new("data/scenes/paraboloid.toml"))?;
/// let report = LimitReport::new(&scene, Some(&[0.0, 80e-6]))?;
/// assert_eq!(report.profile.initial, [0.0, 80e-6 * 80e-6 / 0.02]);
/// assert!(report.form.limit.is_some_and(|shape| shape.wear_volume() > 0.0));
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone, Serialize)]
pub struct LimitReport {
    /// Title of the scene.
    #[serde(skip)]
    pub title: Option<String>,
    /// The indenter in words.
    #[serde(skip)]
    pub indenter: String,
    #[serde(flatten)]
    readings: Entries,
    /// What they are read off.
    #[serde(skip)]
    pub form: ClosedForm,
    /// The profile before and after.
    pub profile: ProfileTable,
}

/// The profile of an indenter before any wear and in the limit; each list has the shape `(radius,)`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ProfileTable {
    /// Radius, m.
    pub radius: Vec<f64>,
    /// Unworn profile, m.
    pub initial: Vec<f64>,
    /// Limiting profile, m.
    pub limit: Option<Vec<f64>>,
    /// Limiting wear depth, m.
    #[serde(skip)]
    pub wear_depth: Option<Vec<f64>>,
}

impl LimitReport {
    /// Evaluates the closed form.
    ///
    /// # Arguments
    /// * `scene` -- the scene
    /// * `radii` -- where the profile is wanted, m, each finite and at least 0, in any order; without, some 200 radii from 0 to beyond
    ///   the contact, graded to the stick radius
    ///
    /// # Errors
    /// As [`InitialContact::new`] and [`LimitingShape::from_contact`]; [`Error::Inconsistent`](crate::Error::Inconsistent) for a
    /// radius that is negative or lies beyond the equator of a sphere.
    pub fn new(scene: &Scene, radii: Option<&[f64]>) -> Result<Self> {
        let form = ClosedForm::new(scene)?;
        let profile = match radii {
            Some(radii) => ProfileTable::at(form.contact.indenter(), form.limit.as_ref(), radii)?,
            None => ProfileTable::graded(&form.contact, form.limit.as_ref()),
        };
        let indenter = form.contact.indenter().words();
        let readings = Entries::new(&LIMIT, &form);
        Ok(Self { title: scene.title().map(str::to_owned), indenter, readings, form, profile })
    }

    /// A table for people, without the profile.
    pub fn text(&self) -> String {
        let mut rows = TextTable::titled(self.title.as_deref());
        rows.row("indenter", &self.indenter);
        put_closed_form(&mut rows, &LIMIT, &self.form);
        rows.text()
    }

    /// The profile as a table for people, one row per radius.
    pub fn profile_text(&self) -> String {
        let mut table = format!("{:>14} {:>14} {:>14} {:>14}\n", "radius", "initial", "limit", "wear depth");
        for row in self.profile.rows() {
            let [radius, initial, limit, depth] =
                row.map(|it| it.map_or("none".into(), |value| Scale::LENGTH.show(value)));
            // Writing to a string cannot fail.
            let _ = writeln!(table, "{radius:>14} {initial:>14} {limit:>14} {depth:>14}");
        }
        table
    }

    /// The profile as CSV, all in m, every number with all its digits; what belongs to the limit is empty under full sliding.
    pub fn csv(&self) -> String {
        let mut table = String::from("radius_m,initial_profile_m,limit_profile_m,wear_depth_m\n");
        for row in self.profile.rows() {
            let cells = row.map(|it| it.map_or(String::new(), |value| format!("{value:e}")));
            table.push_str(&cells.join(","));
            table.push('\n');
        }
        table
    }
}

/// Adds readings of a closed form to a table for people, what belongs together without a gap.
pub(super) fn put_closed_form(
    rows: &mut TextTable,
    readings: impl IntoIterator<Item = &'static Reading<ClosedForm>>,
    form: &ClosedForm,
) {
    for reading in readings {
        match reading.quantity.name {
            "contact_radius_initial" | "contact_radius_limit" | "tau_per_cycle" => rows.gap(),
            // Their unit goes with the grading.
            "normal_stiffness" | "tangential_stiffness" => {
                let unit = format!("N/m^{}", number(2.0 + form.contact.half_space().grading()));
                rows.row(reading.heading, format!("{} {unit}", number((reading.of)(form).number())));
                continue;
            }
            _ => {}
        }
        rows.reading(reading, form);
    }
}

impl ProfileTable {
    /// The profile at radii given.
    fn at(indenter: &Indenter, limit: Option<&LimitingShape>, radii: &[f64]) -> Result<Self> {
        for &radius in radii {
            if !(radius >= 0.0 && radius.is_finite()) {
                return Err(bad_option("at", format!("{radius} m is no radius; give numbers from 0 up")));
            }
            if !indenter.profile(radius).is_finite() {
                return Err(bad_option("at", format!("the indenter does not reach out to {radius} m")));
            }
        }
        let depths = limit.map(|shape| radii.iter().map(|&radius| shape.wear_depth(radius)).collect());
        Ok(Self::new(indenter, radii.to_vec(), depths))
    }

    /// The profile at radii of our own, graded to the stick radius, where the depth rises as `(r-c)^((1-k)/2)`.
    fn graded(contact: &InitialContact, limit: Option<&LimitingShape>) -> Self {
        const INSIDE: usize = 40;
        const ANNULUS: usize = 120;
        const OUTSIDE: usize = 40;
        const MARGIN: f64 = 1.25;
        let indenter = contact.indenter();
        let inner = limit.map_or(contact.contact_radius(), LimitingShape::stick_radius);
        let outer = limit.map_or(contact.contact_radius(), LimitingShape::contact_radius_limit);
        let mut nodes: Vec<_> = steps(INSIDE).map(|share| (inner * share, 0.0)).collect();
        if let Some(shape) = limit {
            // Offsets r² - c² keep the digits next to c. With this power the depth is linear in the share there, as far as that is wise.
            let power = (2.0 / (1.0 - shape.grading())).clamp(2.0, 6.0);
            let widest = shape.slip_width_limit() * (inner + outer);
            nodes.push((inner, 0.0));
            nodes.extend(steps(ANNULUS).map(|share| {
                let offset = widest * share.powf(power);
                ((inner * inner + offset).sqrt(), shape.wear_depth_at_offset(offset))
            }));
        }
        nodes.extend(steps(OUTSIDE + 1).map(|share| (outer * (1.0 + (MARGIN - 1.0) * share), 0.0)));
        nodes.push((outer * MARGIN, 0.0));
        // Neighbours that round to the same radius are one; a sphere ends at its equator.
        let mut last = f64::NEG_INFINITY;
        nodes.retain(|&(radius, _)| {
            let keep = radius > last && indenter.profile(radius).is_finite();
            last = last.max(radius);
            keep
        });
        let (radii, depths) = nodes.into_iter().unzip();
        Self::new(indenter, radii, limit.map(|_| depths))
    }

    fn new(indenter: &Indenter, radius: Vec<f64>, wear_depth: Option<Vec<f64>>) -> Self {
        let initial: Vec<f64> = radius.iter().map(|&radius| indenter.profile(radius)).collect();
        let limit = wear_depth
            .as_ref()
            .map(|depths| initial.iter().zip(depths).map(|(height, depth)| height + depth).collect());
        Self { radius, initial, limit, wear_depth }
    }

    /// Radius, initial and limiting profile, wear depth.
    fn rows(&self) -> impl Iterator<Item = [Option<f64>; 4]> + '_ {
        let of = |list: &Option<Vec<f64>>, row: usize| list.as_ref().map(|values| values[row]);
        (0..self.radius.len()).map(move |row| {
            [Some(self.radius[row]), Some(self.initial[row]), of(&self.limit, row), of(&self.wear_depth, row)]
        })
    }
}

/// `0, 1/n, ..., (n-1)/n`.
fn steps(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |step| step as f64 / count as f64)
}

/// Reads radii such as `1e-6,0.5 mm,20um`, separated by commas; a number without unit is in m.
///
/// # Errors
/// [`Error::Option`](crate::Error::Option) names the entry and the cure.
///
/// # Examples
/// ```
/// assert_eq!(fretwear::report::parse_radii("0, 1e-6,2 um")?, [0.0, 1e-6, 2e-6]);
/// # Ok::<(), fretwear::Error>(())
/// ```
pub fn parse_radii(list: &str) -> Result<Vec<f64>> {
    let read = |(place, entry): (usize, &str)| {
        let refuse = |why: String| Err(bad_option("at", format!("entry {}: {why}", place + 1)));
        let entry = entry.trim();
        if entry.is_empty() {
            return refuse("is empty; give radii such as 0,1e-5,\"20 um\"".into());
        }
        let radius = match entry.parse::<f64>() {
            Ok(radius) => radius,
            Err(_) => match parse(entry, Dimension::LENGTH) {
                Ok(radius) => radius,
                Err(why) => return refuse(why),
            },
        };
        match radius >= 0.0 && radius.is_finite() {
            true => Ok(unsigned_zero(radius)),
            false => refuse(format!("{entry:?} is outside [0, inf)")),
        }
    };
    list.split(',').enumerate().map(read).collect()
}
