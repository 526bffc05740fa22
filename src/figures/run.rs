//! A run and what its scene tells, as all figures of runs need it.

use std::path::Path;

use super::Kind;
use super::measure::Measure;
use crate::contact::closed_form::LimitingShape;
use crate::data::{RunFile, Snapshot};
use crate::error::Result;
use crate::figures::drawing::{Axis, Bar, Colour, Spacing, graded};
use crate::numerics::linear::largest;
use crate::report::Scale;
use crate::scene::Scene;

/// Snapshots drawn as curves, at most.
const MOST_CURVES: usize = 6;
/// Lightest and darkest colour of curves; lighter ones are lost on white.
const LIGHTEST: f64 = 0.14;
/// Steps of a bar of colours.
const STEPS: usize = 60;
/// Up to this part of the largest depth the closed form and the curve in the file are the same.
const SAME_LIMIT: f64 = 1e-3;

/// A run read from its file, with its scene and its limit.
#[derive(Debug, Clone)]
pub struct RunResults {
    /// The run.
    pub run: RunFile,
    /// Its scene.
    pub scene: Scene,
    /// The limiting shape, where the run has one.
    pub limit: Option<LimitingShape>,
}

impl RunResults {
    /// A run that has been read from `path`.
    ///
    /// # Errors
    /// [`Error::Scene`](crate::Error::Scene) if its scene is not valid, and those of the closed form.
    pub fn new(run: RunFile, path: &Path) -> Result<Self> {
        let header = &run.header;
        let name = format!("{}: scene", path.display());
        let scene = Scene::from_stored(&header.scene, &name, header.table.clone(), header.path.clone())?;
        let limit = limit(&run, &scene)?;
        Ok(Self { run, scene, limit })
    }

    pub(super) fn kinds(&self) -> Vec<Kind> {
        let after_start = self.snapshots().iter().filter(|snapshot| snapshot.cycles > 0.0).count();
        let fits = |kind: &Kind| match kind {
            Kind::Profile | Kind::Pressure => !self.snapshots().is_empty(),
            Kind::History => after_start >= 2,
            Kind::Approach => after_start >= 2 && self.run.header.limit.is_some(),
            Kind::Loops => self.snapshots().iter().any(|snapshot| !snapshot.loop_force.is_empty()),
            _ => false,
        };
        Kind::ALL.into_iter().filter(fits).collect()
    }

    pub(super) fn snapshots(&self) -> &[Snapshot] {
        &self.run.snapshots
    }

    pub(super) fn notes(&self) -> Vec<String> {
        let last = self.snapshots().last().map_or(0.0, |snapshot| snapshot.cycles);
        match self.run.complete {
            true => vec![],
            false => vec![format!("Not complete: the run was stopped after {} cycles.", rounded(last))],
        }
    }

    /// The snapshots to be drawn as curves: about equal worn volumes apart, the last among them; none before the first wear.
    pub(super) fn shown(&self) -> Vec<&Snapshot> {
        let worn: Vec<&Snapshot> = self
            .snapshots()
            .iter()
            .filter(|it| is_positive(it.cycles) && is_positive(it.wear_volume))
            .collect();
        let Some(last) = worn.last() else { return vec![] };
        let mut places: Vec<usize> = (1..=MOST_CURVES)
            .filter_map(|part| {
                let volume = last.wear_volume * part as f64 / MOST_CURVES as f64;
                let distance = |it: &&Snapshot| (it.wear_volume - volume).abs();
                let nearest = worn
                    .iter()
                    .enumerate()
                    .min_by(|one, other| distance(one.1).total_cmp(&distance(other.1)));
                nearest.map(|(place, _)| place)
            })
            .collect();
        places.dedup();
        places.into_iter().map(|place| worn[place]).collect()
    }

    /// Unit of radii.
    pub(super) fn radii(&self) -> Measure {
        Measure::new(Scale::LENGTH, self.run.header.radius.last().copied())
    }

    /// Unit of wear depths.
    pub(super) fn depths(&self) -> Measure {
        let limit = self.run.header.limit.iter().map(|limit| largest(&limit.wear_depth));
        Measure::new(Scale::LENGTH, self.snapshots().iter().map(|it| largest(&it.wear_depth)).chain(limit))
    }

    /// The last stick radius.
    pub(super) fn stick_radius(&self) -> f64 {
        self.snapshots().last().map_or(0.0, |snapshot| snapshot.permanent_stick_radius)
    }
}

/// Colours of snapshots by their numbers of cycles.
pub(super) struct Ages {
    first: f64,
    last: f64,
}

impl Ages {
    pub(super) fn new(shown: &[&Snapshot]) -> Self {
        let cycles = |snapshot: Option<&&Snapshot>| snapshot.map_or(1.0, |it| it.cycles);
        Self { first: cycles(shown.first()), last: cycles(shown.last()) }
    }

    /// The later the darker.
    pub(super) fn colour(&self, cycles: f64) -> Colour {
        let place = (cycles / self.first).ln() / (self.last / self.first).ln();
        graded(LIGHTEST + (1.0 - LIGHTEST) * if place.is_finite() { place } else { 1.0 })
    }

    /// The bar that tells colours; none where there is only one.
    pub(super) fn bar(&self, shown: &[&Snapshot]) -> Option<Bar> {
        (self.last > self.first).then(|| {
            let range = [self.first, self.last];
            let axis = Axis::new("cycles *N*", "", Spacing::Logarithmic, range);
            let ratio = self.last / self.first;
            let at = |step: usize| self.first * ratio.powf((step as f64 + 0.5) / STEPS as f64);
            let colours = (0..STEPS).map(|step| self.colour(at(step))).collect();
            Bar { axis, colours, marks: shown.iter().map(|it| it.cycles).collect() }
        })
    }
}

fn is_positive(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

/// A number of cycles, as people say it.
pub(super) fn rounded(cycles: f64) -> String {
    let short = format!("{cycles:.2e}");
    match short.split_once('e') {
        Some((mantissa, exponent)) if cycles >= 1e4 => {
            let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
            if mantissa == "1" {
                format!("10^{{{exponent}}}")
            } else {
                format!("{mantissa}·10^{{{exponent}}}")
            }
        }
        _ => format!("{cycles:.0}"),
    }
}

/// The limit of a run: that of its scene, or of the smallest stick radius and the largest indentation that it came to. None if the file has
/// none, or another one.
fn limit(run: &RunFile, scene: &Scene) -> Result<Option<LimitingShape>> {
    let (Some(curve), Some(last)) = (&run.header.limit, run.snapshots.last()) else { return Ok(None) };
    let first = scene.contact()?;
    let conditions = scene.conditions();
    let contact = if conditions.is_plain() || conditions.holds_both_forces() {
        first
    } else {
        let height = first.equivalent_profile().value(last.permanent_stick_radius);
        first.at(last.indentation, last.indentation - height)?
    };
    let agrees = |shape: &LimitingShape| {
        let depths = run.header.radius.iter().map(|r| shape.wear_depth(*r));
        let gap = depths.zip(&curve.wear_depth).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
        gap <= SAME_LIMIT * largest(&curve.wear_depth)
    };
    Ok(LimitingShape::under(&contact, conditions)?.filter(agrees))
}
