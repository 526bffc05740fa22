//! What the unknowns may be: draws from what the data tell of them, for predictions and pictures.

use faer::{Mat, Side};
use spec_math::cephes64::{chdtri, ndtri};

use super::uncertainty::Profile;
use crate::scene::sampling::{Method, UnitCube};

/// How many draws there are.
pub(super) const DRAWS: u64 = 512;
/// Added to correlations, so that they have a root where one unknown does what another does.
const SMALLEST: f64 = 1e-10;

/// Draws of the coordinates of the unknowns, shape `(draw, unknown)`.
///
/// Their signed roots of the misfit are Student's numbers with the correlations of the estimates; each is taken back through its own profile, so that
/// 95 % of the draws of an unknown lie in its interval. The numbers are those of Sobol, always the same.
///
/// # Arguments
/// * `profiles` -- of the unknowns
/// * `correlation` -- of their estimates, shape `(unknown, unknown)`
/// * `bounds` -- of the coordinates
/// * `freedom` -- degrees of freedom of the deviations; infinite where they are known
pub(super) fn draws(
    profiles: &[Profile],
    correlation: &[Vec<f64>],
    bounds: &[[f64; 2]],
    freedom: f64,
) -> Vec<Vec<f64>> {
    let count = profiles.len();
    let cube = UnitCube::new(Method::Sobol, DRAWS, count + 1, 0);
    let entry = |i: usize, j: usize| match i == j {
        true => 1.0 + SMALLEST,
        false => Some(correlation[i][j]).filter(|it| it.is_finite()).unwrap_or(0.0),
    };
    let matrix = Mat::from_fn(count, count, entry);
    // Round-off may leave correlations without a root; then each is by itself.
    let root = matrix.llt(Side::Lower).map_or(Mat::identity(count, count), |it| it.L().to_owned());
    let curves: Vec<Vec<[f64; 2]>> = profiles.iter().map(roots).collect();
    let inside = |part: f64| part.clamp(1e-9, 1.0 - 1e-9);
    let draw = |sample: u64| {
        let normal: Vec<f64> = (0..count).map(|i| ndtri(inside(cube.coordinate(sample, i)))).collect();
        let spread = match freedom.is_finite() {
            true => (freedom / chdtri(freedom, inside(cube.coordinate(sample, count)))).sqrt(),
            false => 1.0,
        };
        let score = |i: usize| spread * (0..=i).map(|j| root[(i, j)] * normal[j]).sum::<f64>();
        (0..count).map(|i| along(&curves[i], score(i)).clamp(bounds[i][0], bounds[i][1])).collect()
    };
    (0..DRAWS).map(draw).collect()
}

/// Signed roots of the misfit and their coordinates, both increasing.
fn roots(profile: &Profile) -> Vec<[f64; 2]> {
    let centre = profile.points.iter().min_by(|one, other| one[1].total_cmp(&other[1]));
    let centre = centre.map_or(0.0, |it| it[0]);
    let signed = |it: &[f64; 2]| [it[1].max(0.0).sqrt() * (it[0] - centre).signum(), it[0]];
    let mut found: Vec<[f64; 2]> = vec![];
    let known = profile.points.iter().filter(|it| it[1].is_finite());
    for point in known.map(|it| if it[0] == centre { [0.0, centre] } else { signed(it) }) {
        // What wavers by errors of the runs is left out.
        if found.last().is_none_or(|last| point[0] > last[0] + 1e-6 && point[1] > last[1]) {
            found.push(point);
        }
    }
    found
}

/// The coordinate of a root, straight between the points and beyond them.
fn along(curve: &[[f64; 2]], score: f64) -> f64 {
    match curve {
        [] => 0.0,
        [one] => one[1],
        _ => {
            let after = curve.partition_point(|it| it[0] < score).clamp(1, curve.len() - 1);
            let ([a, x], [b, y]) = (curve[after - 1], curve[after]);
            x + (score - a) / (b - a) * (y - x)
        }
    }
}

/// Ends of the interval that holds 95 % of some numbers, straight between them; none of fewer than 2.
pub(super) fn interval(mut values: Vec<f64>) -> Option<[f64; 2]> {
    if values.len() < 2 || values.iter().any(|it| it.is_nan()) {
        return None;
    }
    values.sort_by(f64::total_cmp);
    let outside = (1.0 - super::CONFIDENCE) / 2.0;
    let at = |part: f64| {
        let place = part * (values.len() - 1) as f64;
        let before = (place.floor() as usize).min(values.len() - 2);
        values[before] + (place - before as f64) * (values[before + 1] - values[before])
    };
    Some([outside, 1.0 - outside].map(at))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a parabola with known deviations the draws are normal, with the correlation asked for.
    #[test]
    fn draws_have_the_intervals_and_the_correlation_of_a_linear_problem() {
        let parabola = |deviation: f64| Profile {
            points: [-2.0, 0.0, 2.0].map(|t: f64| [1.0 + deviation * t, t * t]).to_vec(),
            ..Profile::default()
        };
        for freedom in [4.0, f64::INFINITY] {
            let t = super::super::uncertainty::quantile(freedom);
            let correlation = [vec![1.0, -0.6], vec![-0.6, 1.0]];
            let wide = [[-1e3, 1e3]; 2];
            let all = draws(&[parabola(0.1), parabola(2.0)], &correlation, &wide, freedom);
            for (i, deviation) in [0.1, 2.0].into_iter().enumerate() {
                let [low, high] = interval(all.iter().map(|it| it[i]).collect()).expect("many");
                let [a, b] = [(1.0 - low) / deviation, (high - 1.0) / deviation];
                assert!((a / t - 1.0).abs() < 0.06 && (b / t - 1.0).abs() < 0.06, "{freedom}: {a} {b} {t}");
            }
            let moment = |i: usize, j: usize| all.iter().map(|it| (it[i] - 1.0) * (it[j] - 1.0)).sum::<f64>();
            let found = moment(0, 1) / (moment(0, 0) * moment(1, 1)).sqrt();
            assert!((found + 0.6).abs() < 0.05, "{freedom}: {found}");
        }
    }
}
