//! How far the end of a run is from the limit that its own course predicts.

use crate::contact::closed_form::LimitingShape;
use crate::data::{RunFile, Snapshot, StopReason};
use crate::error::{Error, Result};
use crate::laws::history::History;
use crate::numerics::linear::largest;
use crate::scene::{Scene, Tolerances};

use super::CURVE_POINTS;

/// What a distance says about a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The end is the limit.
    Obeys,
    /// It is another shape.
    Violates,
    /// It is neither near nor far, or there is no distance.
    Unclear,
    /// There is no end: the run failed.
    Failed,
}

impl Verdict {
    /// From the distance of an end.
    pub(super) fn new(end: &std::result::Result<Judgement, String>, tolerances: Tolerances) -> Self {
        match end.as_ref().map(|end| end.distance) {
            Err(_) => Self::Failed,
            Ok(Some(distance)) if distance <= tolerances.within => Self::Obeys,
            Ok(Some(distance)) if distance >= tolerances.outside => Self::Violates,
            Ok(_) => Self::Unclear,
        }
    }

    /// Name in files and JSON: `obeys`, `violates`, `unclear` or `failed`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Obeys => "obeys",
            Self::Violates => "violates",
            Self::Unclear => "unclear",
            Self::Failed => "failed",
        }
    }
}

/// The end of a run and the limit for what the run showed.
#[derive(Debug, Clone, PartialEq)]
pub struct Judgement {
    /// Why the run ended.
    pub stop_reason: StopReason,
    /// Cycles at the end.
    pub cycles: f64,
    /// Dimensionless time at the end.
    pub tau: f64,
    /// Wall time, s.
    pub wall_seconds: f64,
    /// Contact radius `a0` of the unworn contact, m.
    pub contact_radius_initial: f64,
    /// Indentation `d` of the unworn contact, m.
    pub indentation_initial: f64,
    /// Permanent stick radius `c`, m: that within which nothing slipped in the whole run.
    pub stick_radius: f64,
    /// Largest indentation of all snapshots, m.
    pub indentation: f64,
    /// Worn volume at the end, m³.
    pub wear_volume: f64,
    /// Worn volume of the limit, m³.
    pub wear_volume_limit: f64,
    /// Largest depth of the limit, m.
    pub wear_depth_limit: f64,
    /// `sup |w - w∞| / max w∞` over the radii of the output; none where the limit is not worn.
    pub distance: Option<f64>,
    /// `w / max w∞` at `c + x (a∞ - c)`, `x` from 0 to 1 in equal steps; not a number between `c` and the first radius of the output.
    pub curve: Vec<f64>,
    /// The same for `w∞`.
    pub curve_limit: Vec<f64>,
}

impl Judgement {
    /// Judges a run.
    ///
    /// The limit is formed from `c/a0`, so that small amplitudes keep the digits that the stick radius has.
    ///
    /// # Errors
    /// [`Error::Inconsistent`] where nothing sticks throughout, and those of the closed form.
    pub(super) fn new(scene: &Scene, run: &RunFile) -> Result<Self> {
        let nothing = |why: &str| Error::Inconsistent { what: "the limit of this run", why: why.to_owned() };
        let last = run.snapshots.last().ok_or_else(|| nothing("it has no snapshot"))?;
        let Extremes { stick_radius, indentation } = Extremes::of(&run.snapshots);
        if stick_radius.is_nan() || stick_radius <= 0.0 {
            return Err(nothing("nothing sticks throughout"));
        }
        let contact = scene.contact()?;
        let limit = limit(scene, indentation, stick_radius)?;
        let wear_depth_limit = limit.wear_depth_max();
        // From the c of the run as it is, not from the one that the limit forms anew: next to c the last digit of a radius shows.
        let depth_limit = |r: f64| limit.wear_depth_at_offset((r - stick_radius) * (r + stick_radius));
        let positions = (0..CURVE_POINTS).map(|i| i as f64 / (CURVE_POINTS - 1) as f64);
        let radii = positions.map(|x| stick_radius + x * limit.slip_width_limit());
        let relative = |depth: f64| depth / wear_depth_limit;
        // What is between the nodes is interpolated of the distance from the limit, which is smooth and small where the limit is met: the
        // depth itself rises too steeply at the stick radius.
        let gaps: Vec<f64> =
            run.header.radius.iter().zip(&last.wear_depth).map(|(r, w)| w - depth_limit(*r)).collect();
        let gap = gaps.iter().fold(0.0, |largest: f64, gap| largest.max(gap.abs()));
        let depth = |r: f64| match r <= stick_radius {
            true => 0.0,
            false => depth_limit(r) + gap_at(&run.header.radius, &gaps, r).unwrap_or(-depth_limit(r)),
        };
        let curves = radii.map(|r| (relative(depth(r)), relative(depth_limit(r))));
        let (curve, curve_limit) = curves.unzip();
        Ok(Self {
            stop_reason: run.stop_reason,
            cycles: last.cycles,
            tau: last.tau,
            wall_seconds: run.checkpoint.as_ref().map_or(f64::NAN, |it| it.wall_seconds),
            contact_radius_initial: contact.contact_radius(),
            indentation_initial: contact.indentation(),
            stick_radius,
            indentation,
            wear_volume: last.wear_volume,
            wear_volume_limit: limit.wear_volume(),
            wear_depth_limit,
            distance: (wear_depth_limit > 0.0).then(|| gap / wear_depth_limit),
            curve,
            curve_limit,
        })
    }

    /// `c/a0` of the first contact.
    pub fn stick_ratio(&self) -> f64 {
        self.stick_radius / self.contact_radius_initial
    }

    /// Worn volume over `a0² d` of the first contact.
    pub fn wear_volume_relative(&self) -> f64 {
        self.wear_volume / (self.contact_radius_initial.powi(2) * self.indentation_initial)
    }

    /// The same of the limit.
    pub fn wear_volume_limit_relative(&self) -> f64 {
        self.wear_volume_limit / (self.contact_radius_initial.powi(2) * self.indentation_initial)
    }
}

/// What the limit depends on: the smallest stick radius and the largest indentation of a run.
struct Extremes {
    stick_radius: f64,
    indentation: f64,
}

impl Extremes {
    fn of(snapshots: &[Snapshot]) -> Self {
        let indentations: Vec<f64> = snapshots.iter().map(|it| it.indentation).collect();
        Self {
            stick_radius: snapshots.iter().map(|it| it.permanent_stick_radius).fold(f64::INFINITY, f64::min),
            indentation: largest(&indentations),
        }
    }
}

/// Eq. (9), for every profile, from the permanent stick radius and the largest indentation; under both forces held from the scene alone.
fn limit(scene: &Scene, indentation: f64, stick_radius: f64) -> Result<LimitingShape> {
    let constant = scene.conditions().friction_history == History::Constant;
    if scene.conditions().holds_both_forces()
        && constant
        && let Some(limit) = LimitingShape::under(&scene.contact()?, scene.conditions())?
    {
        return Ok(limit);
    }
    let (indenter, grading) = (scene.indenter(), scene.half_space().grading());
    let contact_radius = indenter.equivalent_profile(grading)?.radius_at(indentation)?;
    // Without slip the two are the same to the last digit but one.
    LimitingShape::from_stick_ratio(indenter, grading, indentation, (stick_radius / contact_radius).min(1.0))
}

/// Distance of the depth from that of the limit between nodes, linear; none beyond the last, where nothing is worn, and not a number before
/// the first, of which nothing is known.
fn gap_at(radii: &[f64], gaps: &[f64], r: f64) -> Option<f64> {
    match radii.partition_point(|node| *node <= r) {
        0 => Some(f64::NAN),
        after if after == radii.len() => (r == radii[after - 1]).then(|| gaps[after - 1]),
        after => {
            let part = (r - radii[after - 1]) / (radii[after] - radii[after - 1]);
            Some(gaps[after - 1] + part * (gaps[after] - gaps[after - 1]))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::{Checkpoint, RunHeader};

    #[test]
    fn the_limit_is_that_of_the_smallest_stick_radius_and_the_largest_indentation() {
        let scene = Scene::from_toml(
            "indenter = { cone = { slope = 1 } }\n\
             half_space = { grading = 0.3, normal_stiffness = 1, stiffness_ratio = 1 }\n\
             friction = { coulomb = { coefficient = 1 } }\nwear = { archard = { coefficient = 1 } }\n\
             loading = { indentation = 1, stick_ratio = 0.7, tau = 1 }",
            "cone.toml",
        )
        .unwrap();
        // In the middle of the run it is pressed deepest, at another time least sticks.
        let course = [(0.5, 1.0), (0.45, 1.1), (0.5, 1.2), (0.6, 1.0)];
        let (indenter, grading, c, d) = (scene.indenter(), 0.3, 0.45, 1.2);
        let lift = indenter.equivalent_profile(grading).unwrap().value(c);
        let limit = LimitingShape::new(indenter, grading, d, d - lift).unwrap();
        let radius: Vec<f64> = (1..200).map(|i| 0.3 + 0.006 * f64::from(i)).collect();
        let run = |error: f64| {
            let wear_depth: Vec<f64> = radius.iter().map(|r| (1.0 + error) * limit.wear_depth(*r)).collect();
            let of = |&(permanent_stick_radius, indentation): &(f64, f64)| Snapshot {
                permanent_stick_radius,
                indentation,
                wear_depth: wear_depth.clone(),
                ..Snapshot::default()
            };
            let header = RunHeader { radius: radius.clone(), ..RunHeader::default() };
            let snapshots = course.iter().map(of).collect();
            RunFile::finished(header, snapshots, Checkpoint::default(), StopReason::End)
        };
        let exact = Judgement::new(&scene, &run(0.0)).unwrap();
        assert!(exact.distance.unwrap() < 1e-13, "{exact:?}");
        assert_eq!((exact.stick_radius, exact.indentation), (c, d));
        let off = Judgement::new(&scene, &run(1e-3)).unwrap().distance.unwrap();
        assert!((off / 1e-3 - 1.0).abs() < 1e-3, "the deepest of the nodes is off by a thousandth: {off:e}");

        let tolerances = Tolerances::default();
        let verdict = |distance| Verdict::new(&Ok(Judgement { distance, ..exact.clone() }), tolerances);
        assert_eq!(
            [Some(1e-6), Some(1.1e-6), Some(1e-3), None].map(verdict),
            [Verdict::Obeys, Verdict::Unclear, Verdict::Violates, Verdict::Unclear]
        );
    }

    #[test]
    fn without_permanent_stick_there_is_no_limit() {
        let scene = Scene::from_path(std::path::Path::new("data/scenes/paraboloid.toml")).unwrap();
        let snapshots = vec![Snapshot { indentation: 1e-6, ..Snapshot::default() }];
        let run = RunFile::finished(RunHeader::default(), snapshots, Checkpoint::default(), StopReason::End);
        let error = Judgement::new(&scene, &run).unwrap_err().to_string();
        assert!(error.contains("nothing sticks"), "{error}");
    }
}
