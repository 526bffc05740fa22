//! Least squares of nonlinear residuals within bounds, by Levenberg and Marquardt.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

/// Most steps of one search.
const MOST_STEPS: usize = 60;
/// Most tries of one step with ever stronger damping.
const MOST_TRIES: usize = 12;
/// A step below this part of the width between the bounds is the last.
const SMALLEST_STEP: f64 = 1e-7;
/// A step that lowers the cost by a smaller part is the last.
const SMALLEST_GAIN: f64 = 1e-9;
/// Damping at the start, in parts of the diagonal of `JᵀJ`.
const FIRST_DAMPING: f64 = 1e-3;

/// Where something is looked for, and how it is differentiated there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinate {
    /// Least and largest value.
    pub bounds: [f64; 2],
    /// Half of the distance over which differences are taken.
    pub step: f64,
}

impl Coordinate {
    fn width(&self) -> f64 {
        self.bounds[1] - self.bounds[0]
    }
}

/// A place at which the sum of squared residuals is least.
#[derive(Debug, Clone)]
pub struct Minimum {
    /// The place, shape `(coordinate,)`.
    pub place: Vec<f64>,
    /// Residuals there, shape `(residual,)`.
    pub residuals: Vec<f64>,
    /// Sum of their squares.
    pub cost: f64,
}

/// Sum of squares.
pub fn cost(residuals: &[f64]) -> f64 {
    residuals.iter().map(|it| it * it).sum()
}

/// Minimises the sum of squared residuals from a start, by damped Gauss-Newton steps
///
/// ```text
/// (JᵀJ + λ diag(JᵀJ)) δ = -Jᵀ r
/// ```
///
/// that end at the bounds; coordinates that a bound holds stay there as long as the slope leads beyond it. A place where there are no residuals is
/// as a wall.
///
/// # Arguments
/// * `residuals` -- at a place, none where they do not exist; their number is always the same
/// * `start` -- within the bounds
/// * `held` -- coordinates that stay where they start
/// * `least_gain` -- a step that lowers the sum by less is the last
///
/// # Returns
/// None if there are no residuals at the start.
///
/// # Examples
/// ```
/// use fretwear::numerics::least_squares::{Coordinate, minimise};
///
/// // Rosenbrock's valley: its floor is at (1, 1).
/// let mut valley = |x: &[f64]| Some(vec![1.0 - x[0], 10.0 * (x[1] - x[0] * x[0])]);
/// let coordinate = Coordinate { bounds: [-5.0, 5.0], step: 1e-5 };
/// let found = minimise(&mut valley, &[-1.2, 1.0], &[coordinate; 2], &[false; 2], 0.0).unwrap();
/// assert!(found.place.iter().all(|it| (it - 1.0).abs() < 1e-8));
/// ```
pub fn minimise(
    residuals: &mut dyn FnMut(&[f64]) -> Option<Vec<f64>>,
    start: &[f64],
    coordinates: &[Coordinate],
    held: &[bool],
    least_gain: f64,
) -> Option<Minimum> {
    let mut place = start.to_vec();
    let mut now = residuals(&place)?;
    let mut lowest = cost(&now);
    let mut damping = FIRST_DAMPING;
    for _ in 0..MOST_STEPS {
        let jacobian = jacobian(residuals, &place, &now, coordinates, held);
        let slope: Vec<f64> = (0..place.len()).map(|i| dot(&jacobian[i], &now)).collect();
        let is_free = |i: usize| {
            let [low, high] = coordinates[i].bounds;
            let beyond = (place[i] <= low && slope[i] > 0.0) || (place[i] >= high && slope[i] < 0.0);
            !held[i] && !beyond && jacobian[i].iter().any(|it| *it != 0.0)
        };
        let free: Vec<usize> = (0..place.len()).filter(|i| is_free(*i)).collect();
        if free.is_empty() {
            break;
        }
        let mut moved = None;
        for _ in 0..MOST_TRIES {
            let Some(step) = damped_step(&jacobian, &slope, &free, damping) else {
                damping *= 10.0;
                continue;
            };
            let mut next = place.clone();
            for (i, step) in free.iter().zip(step) {
                let [low, high] = coordinates[*i].bounds;
                next[*i] = (place[*i] + step).clamp(low, high);
            }
            let there = residuals(&next).filter(|it| cost(it) <= lowest);
            if let Some(there) = there {
                moved = Some((next, there));
                damping = (damping / 5.0).max(1e-12);
                break;
            }
            let far =
                free.iter().any(|i| (next[*i] - place[*i]).abs() > SMALLEST_STEP * coordinates[*i].width());
            if !far {
                break;
            }
            damping *= 5.0;
        }
        let Some((next, there)) = moved else { break };
        let step = coordinates.iter().zip(&place).zip(&next);
        let is_small = step.into_iter().all(|((it, a), b)| (b - a).abs() <= SMALLEST_STEP * it.width());
        let gain = lowest - cost(&there);
        (lowest, place, now) = (cost(&there), next, there);
        if is_small || gain <= least_gain.max(SMALLEST_GAIN * lowest) {
            break;
        }
    }
    Some(Minimum { place, residuals: now, cost: lowest })
}

/// Derivatives of the residuals by each coordinate, shape `(coordinate, residual)`, by central differences, from one side at a bound or a wall; zero
/// for a coordinate that is held.
pub fn jacobian(
    residuals: &mut dyn FnMut(&[f64]) -> Option<Vec<f64>>,
    place: &[f64],
    now: &[f64],
    coordinates: &[Coordinate],
    held: &[bool],
) -> Vec<Vec<f64>> {
    let mut column = |i: usize| {
        let mut at = |shift: f64| {
            let mut moved = place.to_vec();
            moved[i] = (place[i] + shift).clamp(coordinates[i].bounds[0], coordinates[i].bounds[1]);
            let way = moved[i] - place[i];
            let there = if way == 0.0 { None } else { residuals(&moved) };
            there.map_or_else(|| (0.0, now.to_vec()), |there| (way, there))
        };
        let ((after, up), (before, down)) = (at(coordinates[i].step), at(-coordinates[i].step));
        match after - before {
            0.0 => vec![0.0; now.len()],
            way => up.iter().zip(&down).map(|(up, down)| (up - down) / way).collect(),
        }
    };
    (0..place.len()).map(|i| if held[i] { vec![0.0; now.len()] } else { column(i) }).collect()
}

/// `JᵀJ` over some of the coordinates.
pub fn normal_matrix(jacobian: &[Vec<f64>], of: &[usize]) -> Mat<f64> {
    Mat::from_fn(of.len(), of.len(), |i, j| dot(&jacobian[of[i]], &jacobian[of[j]]))
}

fn damped_step(jacobian: &[Vec<f64>], slope: &[f64], free: &[usize], damping: f64) -> Option<Vec<f64>> {
    let mut matrix = normal_matrix(jacobian, free);
    let largest = (0..free.len()).map(|i| matrix[(i, i)]).fold(0.0, f64::max);
    for i in 0..free.len() {
        matrix[(i, i)] += damping * matrix[(i, i)] + f64::EPSILON * largest;
    }
    let right = Mat::from_fn(free.len(), 1, |i, _| -slope[free[i]]);
    let step = matrix.llt(Side::Lower).ok()?.solve(&right);
    let step: Vec<f64> = (0..free.len()).map(|i| step[(i, 0)]).collect();
    step.iter().all(|it| it.is_finite()).then_some(step)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDE: Coordinate = Coordinate { bounds: [-10.0, 10.0], step: 1e-4 };

    /// `y = a + b x` at x = 0 ... 4, against the closed form of its normal equations.
    #[test]
    fn a_straight_line_is_found_in_one_step() {
        let y = [1.0, 2.9, 5.1, 7.0, 9.2];
        let mut calls = 0;
        let mut residuals = |at: &[f64]| {
            calls += 1;
            Some((0..5).map(|i| at[0] + at[1] * i as f64 - y[i]).collect())
        };
        let found =
            minimise(&mut residuals, &[0.0, 0.0], &[WIDE; 2], &[false; 2], 0.0).expect("it has residuals");
        assert!((found.place[0] - 0.94).abs() < 1e-7 && (found.place[1] - 2.05).abs() < 1e-7, "{found:?}");
        assert!(calls <= 31, "{calls} calls");
    }

    #[test]
    fn a_bound_holds_what_leads_beyond_it_and_lets_the_rest_go_on() {
        let mut residuals = |at: &[f64]| Some(vec![at[0] - 20.0, at[1] - 3.0, 0.5 * (at[0] - at[1])]);
        let found =
            minimise(&mut residuals, &[0.0, 0.0], &[WIDE; 2], &[false; 2], 0.0).expect("it has residuals");
        // With at[0] = 10: (y - 3) - 0.25 (10 - y) = 0.
        assert!(found.place[0] == 10.0 && (found.place[1] - 4.4).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn a_wall_of_the_residuals_is_not_stepped_over() {
        let mut residuals = |at: &[f64]| (at[0] < 2.0).then(|| vec![at[0].exp() - 4.0]);
        let found = minimise(&mut residuals, &[-3.0], &[WIDE], &[false], 0.0).expect("it has residuals");
        assert!((found.place[0] - 4f64.ln()).abs() < 1e-7, "{found:?}");
    }
}
