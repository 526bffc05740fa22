//! How well the unknowns are known: profile likelihood, covariance, and what is known where single unknowns are not.

use faer::{Mat, Side};
use spec_math::cephes64::{ndtri, stdtri};

use super::objective::Objective;
use crate::numerics::least_squares::{Minimum, cost, jacobian, minimise, normal_matrix};

/// Probability that the interval holds the truth.
pub const CONFIDENCE: f64 = 0.95;
/// From so many degrees of freedom on Student's distribution is the normal one.
const MANY: f64 = 1e6;
/// How near the end of an interval is found, in parts of its distance.
const NEAR: f64 = 2e-3;
/// Gain of misfit that is not worth another step.
pub(super) const LEAST_GAIN: f64 = 2e-3;
/// How much lower than the least a misfit is that is no error of the runs.
const LOWER: f64 = 0.02;
/// Part of the rise that a bound of another unknown may be the cause of.
const BY_BOUND: f64 = 0.1;
/// Most places on one side.
const MOST_PLACES: usize = 30;
/// Eigenvalues of the correlations below this one are taken for it.
const SMALLEST: f64 = 1e-13;
/// Exponents below this one are not shown.
const LEAST_EXPONENT: f64 = 0.02;

/// Quantile of Student's distribution for a two-sided interval of 95 %; of the normal one where the deviations are known.
pub(super) fn quantile(freedom: f64) -> f64 {
    let one_sided = 0.5 + CONFIDENCE / 2.0;
    if freedom < MANY { stdtri(freedom.floor().max(1.0) as isize, one_sided) } else { ndtri(one_sided) }
}

/// What the misfit does as one unknown is moved and all else follows.
#[derive(Debug, Clone, Default)]
pub(super) struct Profile {
    /// Ends of the interval, none where the misfit never rises enough.
    pub(super) ends: [Option<f64>; 2],
    /// Coordinates and misfits above the least.
    pub(super) points: Vec<[f64; 2]>,
    /// A place that is better than the one it began from.
    pub(super) better: Option<Vec<f64>>,
}

/// The interval in which the misfit, all else fitted anew, lies less than `t²` above the least.
///
/// # Arguments
/// * `unknown` -- its place
/// * `deviation` -- its standard deviation by the curvature at the minimum, if that is finite
/// * `along` -- by how much the other coordinates follow, shape `(coordinate,)`
pub(super) fn profile(
    objective: &mut Objective,
    minimum: &Minimum,
    unknown: usize,
    deviation: f64,
    along: &[f64],
    t: f64,
) -> Profile {
    let coordinates = objective.coordinates.clone();
    let held: Vec<bool> = (0..coordinates.len()).map(|i| i == unknown).collect();
    let centre = minimum.place[unknown];
    let mut found = Profile { points: vec![[centre, 0.0]], ..Profile::default() };
    for side in [0, 1] {
        let bound = coordinates[unknown].bounds[side];
        let room = (bound - centre).abs();
        let way = if side == 0 { -1.0 } else { 1.0 };
        if room == 0.0 {
            continue;
        }
        // Distances at which the misfit is too small and too large, with its root.
        let (mut inside, mut outside): ((f64, f64), Option<(f64, f64)>) = ((0.0, 0.0), None);
        let mut distance = if deviation.is_finite() && deviation > 0.0 { t * deviation } else { room / 20.0 };
        let mut others = minimum.place.clone();
        for _ in 0..MOST_PLACES {
            distance = distance.min(room);
            let mut start = others.clone();
            let step = way * distance + centre - others[unknown];
            for (i, it) in start.iter_mut().enumerate() {
                let [low, high] = coordinates[i].bounds;
                *it = (*it + step * along[i]).clamp(low, high);
            }
            start[unknown] = if distance == room { bound } else { centre + way * distance };
            let mut residuals = |place: &[f64]| objective.residuals(place);
            let there = minimise(&mut residuals, &start, &coordinates, &held, LEAST_GAIN);
            let rise = there.as_ref().map_or(f64::INFINITY, |it| it.cost - minimum.cost);
            if let Some(there) = &there {
                found.points.push([there.place[unknown], rise]);
                if rise < -LOWER {
                    found.better = Some(there.place.clone());
                    return found;
                }
            }
            let root = rise.max(0.0).sqrt();
            let end = centre + way * distance;
            let there_is_an_end = |objective: &mut Objective| {
                let by_bound = there
                    .as_ref()
                    .is_some_and(|it| gain_beyond_bounds(objective, it, &held) > BY_BOUND * t * t);
                (!by_bound).then_some(end)
            };
            if (root - t).abs() <= NEAR * t {
                found.ends[side] = there_is_an_end(objective);
                break;
            }
            if root < t {
                if distance >= room {
                    break;
                }
                inside = (distance, root);
                others = there.as_ref().map_or(others, |it| it.place.clone());
            } else {
                outside = Some((distance, root));
            }
            distance = match outside {
                None => inside.0 * (t / inside.1.max(0.1 * t)).clamp(1.1, 4.0),
                // A wall: nothing is known of how the misfit rises towards it.
                Some((far, root)) if root.is_infinite() => (inside.0 + far) / 2.0,
                Some((far, root)) => {
                    let part = ((t - inside.1) / (root - inside.1)).clamp(0.05, 0.95);
                    inside.0 + part * (far - inside.0)
                }
            };
            let bracket = outside.map(|(far, root)| (far - inside.0, root));
            if let Some((width, root)) = bracket
                && width <= NEAR * distance
            {
                found.ends[side] = root.is_finite().then(|| there_is_an_end(objective)).flatten();
                break;
            }
        }
    }
    found.points.sort_by(|one, other| one[0].total_cmp(&other[0]));
    found
}

/// How much lower the misfit would be if unknowns that a bound holds could go on, at most as far again as their bounds are apart.
fn gain_beyond_bounds(objective: &mut Objective, at: &Minimum, held: &[bool]) -> f64 {
    const AT: f64 = 1e-6;
    let coordinates = objective.coordinates.clone();
    let unknowns = objective.calibration.unknowns().len();
    let is_at_bound = |i: &usize| {
        let [low, high] = coordinates[*i].bounds;
        !held[*i] && (at.place[*i] - low).min(high - at.place[*i]) <= AT * (high - low)
    };
    let stuck: Vec<usize> = (0..unknowns).filter(is_at_bound).collect();
    if stuck.is_empty() {
        return 0.0;
    }
    let slopes =
        jacobian(&mut |place| objective.residuals(place), &at.place, &at.residuals, &coordinates, held);
    let others: Vec<&Vec<f64>> =
        (0..slopes.len()).filter(|i| !stuck.contains(i)).map(|i| &slopes[i]).collect();
    let others = orthonormal(&others);
    let gain = |i: usize| {
        let own = without(&slopes[i], &others);
        let [low, high] = coordinates[i].bounds;
        let slope: f64 = own.iter().zip(&at.residuals).map(|(a, b)| a * b).sum();
        let outwards = if at.place[i] - low < high - at.place[i] { slope } else { -slope };
        let curvature = cost(&own);
        if outwards <= 0.0 || curvature == 0.0 {
            return 0.0;
        }
        let step = (outwards / curvature).min(high - low);
        2.0 * outwards * step - curvature * step * step
    };
    stuck.into_iter().map(gain).fold(0.0, f64::max)
}

/// Columns as perpendicular ones of length 1; those that the others make up are left out.
fn orthonormal(columns: &[&Vec<f64>]) -> Vec<Vec<f64>> {
    const NOTHING: f64 = 1e-9;
    let mut found: Vec<Vec<f64>> = vec![];
    for column in columns {
        let rest = without(column, &found);
        let [size, whole] = [&rest, *column].map(|it| cost(it).sqrt());
        if size > NOTHING * whole {
            found.push(rest.iter().map(|it| it / size).collect());
        }
    }
    found
}

/// A column without what perpendicular ones of length 1 make up of it.
fn without(column: &[f64], others: &[Vec<f64>]) -> Vec<f64> {
    let mut rest = column.to_vec();
    // Twice, as round-off leaves a part the first time.
    for other in others.iter().chain(others) {
        let part: f64 = rest.iter().zip(other).map(|(a, b)| a * b).sum();
        rest.iter_mut().zip(other).for_each(|(it, b)| *it -= part * b);
    }
    rest
}

/// Covariances of all coordinates, `(JᵀJ)⁻¹`, shape `(coordinate, coordinate)`; what the data do not tell has a very large one.
pub(super) fn covariance(slopes: &[Vec<f64>]) -> Mat<f64> {
    let count = slopes.len();
    let all: Vec<usize> = (0..count).collect();
    let matrix = normal_matrix(slopes, &all);
    let largest = (0..count).map(|i| matrix[(i, i)]).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let size: Vec<f64> = (0..count).map(|i| matrix[(i, i)].max(SMALLEST * largest).sqrt()).collect();
    let scaled = Mat::from_fn(count, count, |i, j| matrix[(i, j)] / (size[i] * size[j]));
    let Some((values, vectors)) = eigen(&scaled) else { return Mat::full(count, count, f64::NAN) };
    let entry = |i: usize, j: usize| -> f64 {
        (0..count).map(|k| vectors[(i, k)] * vectors[(j, k)] / values[k].max(SMALLEST)).sum()
    };
    Mat::from_fn(count, count, |i, j| entry(i, j) / (size[i] * size[j]))
}

/// Eigenvalues, increasing, and eigenvectors of a symmetric matrix.
fn eigen(matrix: &Mat<f64>) -> Option<(Vec<f64>, Mat<f64>)> {
    let found = matrix.self_adjoint_eigen(Side::Lower).ok()?;
    let values = found.S().column_vector();
    Some(((0..matrix.nrows()).map(|i| values[i]).collect(), found.U().to_owned()))
}

/// Exponents of the product of some unknowns that is best known, the largest of them 1, and the standard deviation of its logarithm; all else is
/// fitted along. None if the product is not known either.
pub(super) fn combination(slopes: &[Vec<f64>], of: &[usize]) -> Option<(Vec<f64>, f64)> {
    // Without what the other coordinates could do as well.
    let others: Vec<&Vec<f64>> = (0..slopes.len()).filter(|i| !of.contains(i)).map(|i| &slopes[i]).collect();
    let others = orthonormal(&others);
    let own: Vec<Vec<f64>> = of.iter().map(|i| without(&slopes[*i], &others)).collect();
    let (values, vectors) = eigen(&normal_matrix(&own, &(0..own.len()).collect::<Vec<_>>()))?;
    let last = of.len() - 1;
    let vector: Vec<f64> = (0..of.len()).map(|i| vectors[(i, last)]).collect();
    let largest = vector.iter().copied().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
    let exponents: Vec<f64> = vector
        .iter()
        .map(|it| it / largest)
        .map(|it| if it.abs() < LEAST_EXPONENT { 0.0 } else { it })
        .collect();
    let deviation = 1.0 / (values[last].max(0.0).sqrt() * largest.abs());
    (deviation.is_finite() && exponents.iter().filter(|it| **it != 0.0).count() > 1)
        .then_some((exponents, deviation))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables() {
        assert!((quantile(4.0) - 2.776_445).abs() < 1e-6, "{}", quantile(4.0));
        assert!((quantile(f64::INFINITY) - 1.959_964).abs() < 1e-6);
    }

    #[test]
    fn the_product_of_two_unknowns_that_act_as_one_is_named() {
        // Residuals in a b^1.5 alone, and in a third unknown.
        let slopes = [1.0, 2.0, 3.0];
        let jacobian = [slopes.to_vec(), slopes.iter().map(|it| 1.5 * it).collect(), vec![1.0, 0.0, 0.0]];
        let (exponents, deviation) = combination(&jacobian, &[0, 1]).expect("it is known");
        assert!((exponents[0] - 1.0 / 1.5).abs() < 1e-4 && exponents[1] == 1.0, "{exponents:?}");
        // Of ln(a^(2/3) b): residuals 2 and 3 alone tell, as the first belongs to the third unknown.
        let expected = 1.0 / (1.5 * 13f64.sqrt());
        assert!((deviation / expected - 1.0).abs() < 1e-3, "{deviation} {expected}");
    }
}
