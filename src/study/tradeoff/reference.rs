//! Runs finer than any candidate, with which candidates are compared.

use std::collections::BTreeSet;

use super::candidates::{Candidate, Choice, cycles};
use super::errors::References;
use super::measure::{Cost, Measurement, Runs};
use super::name as candidate_name;
use crate::data::SAME_CYCLES;
use crate::error::{Error, Result};
use crate::scene::{Scene, Stepper};

/// Time for a reference over that for a candidate, and what of it may be planned with.
const PATIENCE: f64 = 20.0;
const PLANNED: f64 = 0.5;

/// Springs of the two references over those of the finest candidate: from second order on their difference is more than the better one is off
/// by. First the better pair, then what is left where that takes too long.
const SPRINGS: [[f64; 2]; 2] = [[1.5, 1.0], [1.25, 0.8]];

/// Tolerance of the references over the smallest of the candidates.
const TOLERANCES: [f64; 2] = [0.25, 0.5];

/// Powers of the number of steps with which the tolerance falls: those of methods of orders 2 to 4.
const POWERS: [f64; 2] = [3.0, 5.0];

/// The runs that candidates were compared with.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    /// Springs of both, the finer first.
    pub springs: [usize; 2],
    /// Tolerances of both.
    pub tolerance: [f64; 2],
    /// Wall time of both, s.
    pub wall_seconds: [f64; 2],
    /// Their largest differences over all snapshots, in volume and profile, relative as errors are.
    pub uncertainty: [f64; 2],
}

/// Name of the finer run, or of the other.
pub(super) fn name(number: usize) -> String {
    format!("reference{number}")
}

/// What all candidates are compared with; none if a signal came.
///
/// # Errors
/// [`Error::NotConverged`] if no reference could be run; [`Error::File`] concerns all runs.
pub(super) fn found(
    scene: &Scene,
    runs: &Runs,
    measured: &[(Candidate, Measurement)],
    most_seconds: f64,
) -> Result<Option<(References, Reference)>> {
    let unknown = |why: String| Error::NotConverged { what: "reference of the trade-off", why };
    let Some(Finest { cost: finest, tolerance, power }) = finest(scene, measured) else {
        let reasons: BTreeSet<&str> = measured.iter().map(|it| it.1.reason()).collect();
        let reasons: Vec<&str> = reasons.into_iter().filter(|why| !why.is_empty()).take(3).collect();
        return Err(unknown(format!("no candidate came to its end: {}", reasons.join("; "))));
    };
    let times = times(runs, measured)?;
    let mut reason = String::new();
    for springs in SPRINGS {
        let plan = Plan {
            springs: springs.map(|it| (it * finest.springs as f64).ceil() as usize),
            tolerance: affordable(finest, springs[0], tolerance, power, PLANNED * PATIENCE * most_seconds),
            most_seconds: PATIENCE * most_seconds,
        };
        match plan.run(scene, runs, &times)? {
            None => return Ok(None),
            Some(Ok(found)) => return Ok(Some(found)),
            Some(Err(why)) => reason = why,
        }
    }
    Err(unknown(reason))
}

/// What is known of the candidates by hand, of the default method where that came to an end.
struct Finest<'a> {
    /// The one with the most springs.
    cost: &'a Cost,
    /// Smallest tolerance of those with at least a quarter of them.
    tolerance: f64,
    /// Power of the rate evaluations with which the tolerance falls.
    power: f64,
}

fn finest<'a>(scene: &Scene, measured: &'a [(Candidate, Measurement)]) -> Option<Finest<'a>> {
    let way = (Stepper::default(), cycles(scene)[0]);
    let by_hand = measured.iter().filter(|(candidate, _)| candidate.accuracy().is_none());
    let done = || by_hand.clone().filter_map(|(candidate, it)| it.cost().map(|cost| (candidate, cost)));
    let default = || done().filter(|(candidate, _)| (candidate.stepper, candidate.cycle) == way);
    let all: Vec<&Cost> = if default().next().is_some() {
        default().map(|it| it.1).collect()
    } else {
        done().map(|it| it.1).collect()
    };
    let finest = all
        .iter()
        .copied()
        .max_by(|a, b| a.springs.cmp(&b.springs).then(b.tolerance.total_cmp(&a.tolerance)))?;
    let fine = all.iter().filter(|it| 4 * it.springs >= finest.springs);
    let tolerance = fine.map(|it| it.tolerance).fold(finest.tolerance, f64::min);
    Some(Finest { cost: finest, tolerance, power: power(&all) })
}

/// Power of the rate evaluations with which the tolerance falls, from the two farthest tolerances on the same springs.
fn power(all: &[&Cost]) -> f64 {
    let pairs = all.iter().flat_map(|a| all.iter().map(move |b| (a, b)));
    let same = pairs.filter(|(a, b)| a.springs == b.springs && a.tolerance > b.tolerance);
    let farthest = same
        .max_by(|one, other| {
            let ratio = |it: &(&&Cost, &&Cost)| it.0.tolerance / it.1.tolerance;
            ratio(one).total_cmp(&ratio(other))
        })
        .map(|(a, b)| {
            (a.tolerance / b.tolerance).ln() / (b.rate_evaluations as f64 / a.rate_evaluations as f64).ln()
        });
    let [least, most] = POWERS;
    farthest.filter(|power| *power > 0.0).map_or(least, |power| power.clamp(least, most))
}

/// The tolerance that a reference can be run with in some time, s, at best the smallest and at worst that of the finest candidate: time goes as
/// the power 2.5 of the number of springs, and with a root of the tolerance.
fn affordable(finest: &Cost, springs: f64, smallest: f64, power: f64, seconds: f64) -> f64 {
    let same = finest.wall_seconds * springs.powf(2.5);
    (finest.tolerance * (same / seconds).powf(power))
        .clamp(smallest * TOLERANCES[0], finest.tolerance * TOLERANCES[0])
}

/// The cycles of all snapshots of all candidates.
fn times(runs: &Runs, measured: &[(Candidate, Measurement)]) -> Result<Vec<f64>> {
    let mut times = vec![];
    for (number, _) in measured.iter().enumerate().filter(|(_, it)| it.1.cost().is_some()) {
        times.extend(
            runs.read(&candidate_name(number))?.snapshots.iter().map(|it| it.cycles).filter(|it| *it > 0.0),
        );
    }
    times.sort_by(f64::total_cmp);
    times.dedup_by(|later, earlier| *later - *earlier <= SAME_CYCLES * *later);
    Ok(times)
}

/// Two runs that differ in springs and tolerance.
struct Plan {
    springs: [usize; 2],
    /// Of the finer one.
    tolerance: f64,
    most_seconds: f64,
}

impl Plan {
    /// Both runs, or why they could not be had; none if a signal came.
    fn run(
        &self,
        scene: &Scene,
        runs: &Runs,
        times: &[f64],
    ) -> Result<Option<std::result::Result<(References, Reference), String>>> {
        let patch = format!(
            "loading = {{ cycles = {:e} }}\noutput = {{ at_cycles = [{}] }}",
            times.last().copied().unwrap_or(f64::NAN),
            times.iter().map(|it| format!("{it:e}")).collect::<Vec<_>>().join(", ")
        );
        let (mut costs, mut files) = (vec![], vec![]);
        for (number, springs) in self.springs.into_iter().enumerate() {
            let tolerance = self.tolerance * TOLERANCES[number] / TOLERANCES[0];
            let choice = Choice::Hand { springs, tolerance };
            let candidate = Candidate { choice, stepper: Stepper::default(), cycle: cycles(scene)[0] };
            let scene = scene.varied(&candidate.numerics(scene), &patch)?;
            let name = self::name(number);
            let Some(measurement) = runs.measure(&name, &scene, self.most_seconds)? else { return Ok(None) };
            match measurement {
                Measurement::Done(cost) => costs.push(cost),
                other => return Ok(Some(Err(format!("{springs} springs: {}", other.reason())))),
            }
            files.push(runs.read(&name)?);
        }
        let references = References::new(scene, files.try_into().expect("two were pushed"))?;
        let of = |number: usize| &costs[number];
        let reference = Reference {
            springs: [0, 1].map(|it| of(it).springs),
            tolerance: [0, 1].map(|it| of(it).tolerance),
            wall_seconds: [0, 1].map(|it| of(it).wall_seconds),
            uncertainty: references.largest_uncertainty(),
        };
        Ok(Some(Ok((references, reference))))
    }
}
