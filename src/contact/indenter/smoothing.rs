//! Smoothing of a measured profile: the smoothest curve that its rows allow.
//!
//! Written here because the crate for smoothing splines, `csaps`, bends a curve straight at both of its ends: at the tip that is an infinite
//! radius of curvature. It takes no bound on the shape either.

use serde::Serialize;

use super::spline::{BANDWIDTH, Banded, EvenSpline};

/// What a degree of freedom of the curve costs, in units of `σ²`: it must take more than this off the sum of squares. 2 makes the expected
/// error the least; 4 keeps waves away, and noise of up to twice the deviation given is not followed.
const PENALTY: f64 = 4.0;
/// Degrees of freedom of a paraboloid.
const OF_PARABOLOID: f64 = 2.0;
/// Most pieces of the spline.
const MOST_PIECES: usize = 4096;
/// Pieces to begin with.
const FIRST_PIECES: usize = 8;
/// Longest piece over the length on which the spline smoothes: shorter ones change nothing that could be seen.
const RESOLVED: f64 = 0.5;
/// Pieces of the curve, at least.
const FEWEST_KNOTS: usize = 512;
/// Least mean curvature over that of the best paraboloid.
const LEAST_CURVATURE: f64 = 0.01;
/// How much stiffer the bound on the curvature is than the rows.
const STIFFNESS: f64 = 1e5;
/// Sums of squares that are smaller against those of the paraboloid have lost their digits.
const ROUNDING: f64 = 1e-10;
/// Range and step of the logarithm of the weights that are tried, over the one with which rows and roughness are as strong.
const WEIGHTS: [f64; 2] = [-30.0, 16.0];
const STEP: f64 = 0.5;

/// What a measured profile was replaced by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SmoothedBy {
    /// The best paraboloid: the rows do not tell the profile from it.
    Paraboloid,
    /// A spline.
    Spline,
    /// A spline that was kept from bending back: without that it would have, in waves that the rows do not ask for.
    BoundedSpline,
    /// The rows themselves: they lie nearer to each other than the deviation is small.
    Rows,
}

/// How a measured profile was smoothed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Smoothing {
    /// Standard deviation of the heights as it was given, m.
    pub deviation: f64,
    /// What the rows were replaced by.
    pub by: SmoothedBy,
    /// Root of the mean of the squared residuals, rows less curve, m.
    pub residual_rms: f64,
    /// Largest residual, m.
    pub residual_largest: f64,
    /// Radius of the row with the largest residual, m.
    pub residual_largest_radius: f64,
    /// Radius of curvature of the curve at the tip, m; none of rows.
    pub tip_radius: Option<f64>,
}

impl Smoothing {
    /// Of rows that are taken as they are.
    pub(super) fn none(deviation: f64) -> Self {
        let (by, residual_rms, residual_largest) = (SmoothedBy::Rows, 0.0, 0.0);
        Self { deviation, by, residual_rms, residual_largest, residual_largest_radius: 0.0, tip_radius: None }
    }
}

/// A smooth curve: knots, values and slopes, the value at the tip taken away; and how it was found.
pub(super) struct Smooth {
    pub knots: Vec<f64>,
    pub values: Vec<f64>,
    pub slopes: Vec<f64>,
    pub smoothing: Smoothing,
}

/// Smooths rows.
///
/// The curve is even, `f(-r) = f(r)`, so that it has no slope at the axis, and minimises
///
/// ```text
/// Σ (y_i - f(r_i))² + λ ∫ f'''(r)² dr
/// ```
///
/// Whatever `λ`, a paraboloid stays itself, radius of curvature included; a penalty on `f''` would flatten it at both ends. Of all `λ` it is
/// the one with the least
///
/// ```text
/// Σ (y_i - f(r_i))² + 4 σ² p
/// ```
///
/// where `p` are the degrees of freedom of the curve, the trace of the matrix that makes its values of the heights (Mallows, Technometrics 15
/// (1973) 661, with 2 in place of 4). The residual comes to `σ` then, as near as so many rows tell it. Reinsch's `λ` (Numerische Mathematik 10
/// (1967) 177), with which it is `σ` to the last digit, leaves two to four times the error beside a worn annulus, and waves where the noise
/// happens to be a little more than `σ`.
///
/// Where that curve has a negative mean curvature `f'' + f'/r` somewhere, it is found again without, and taken if the rows do not say
/// otherwise. Then `r f'` rises, and with it the equivalent profile for every grading: one contact.
///
/// None where the deviation is too small for a spline: the rows are to be taken as they are.
///
/// # Arguments
/// * `radius` -- m, increasing from 0
/// * `height` -- m
/// * `deviation` -- `σ`, m, positive
pub(super) fn smooth(radius: &[f64], height: &[f64], deviation: f64) -> Option<Smooth> {
    let rows = Rows::new(radius, height);
    let variance = deviation * deviation;
    if variance * radius.len() as f64 <= ROUNDING * rows.sum_of_squares {
        return None;
    }
    let mut pieces = FIRST_PIECES;
    loop {
        let fit = Fit::new(&rows, pieces);
        let Best { criterion, weight, freedom } = fit.best(variance);
        let last = fit.spline.pieces() + 1 == radius.len() || pieces >= MOST_PIECES;
        if last || fit.resolves(weight) {
            if rows.sum_of_squares + PENALTY * variance * OF_PARABOLOID <= criterion {
                return Some(rows.curve(None, SmoothedBy::Paraboloid, deviation));
            }
            let free = fit.coefficients(weight, false);
            if fit.least_curvature(&free) >= 0.0 {
                return Some(rows.curve(Some((&fit, &free)), SmoothedBy::Spline, deviation));
            }
            let bounded = fit.coefficients(weight, true);
            let worse = fit.sum_of_squares(&bounded) - fit.sum_of_squares(&free);
            let fits = worse <= PENALTY * variance * freedom.sqrt();
            return Some(match fits && fit.least_curvature(&bounded) >= 0.0 {
                true => rows.curve(Some((&fit, &bounded)), SmoothedBy::BoundedSpline, deviation),
                false => rows.curve(Some((&fit, &free)), SmoothedBy::Spline, deviation),
            });
        }
        pieces *= 2;
    }
}

/// The best of the weights `λ`.
struct Best {
    /// Sum of the squares and what the degrees of freedom cost, m².
    criterion: f64,
    weight: f64,
    /// Degrees of freedom.
    freedom: f64,
}

/// Rows and the best paraboloid through them; radii over the largest, so that it is 1.
struct Rows<'a> {
    radius: &'a [f64],
    /// `r/L`.
    places: Vec<f64>,
    /// Heights over the paraboloid, m.
    heights: Vec<f64>,
    /// What the paraboloid rises by to the last row, m.
    rise: f64,
    /// Sum of the squared heights over the paraboloid, m².
    sum_of_squares: f64,
}

impl<'a> Rows<'a> {
    fn new(radius: &'a [f64], height: &[f64]) -> Self {
        let count = radius.len() as f64;
        let largest = radius[radius.len() - 1];
        let places: Vec<f64> = radius.iter().map(|r| r / largest).collect();
        let square = places.iter().map(|x| x * x).sum::<f64>() / count;
        let mean = height.iter().sum::<f64>() / count;
        let moments = places.iter().zip(height).fold([0.0; 2], |[product, own], (x, y)| {
            let from_mean = x * x - square;
            [product + from_mean * (y - mean), own + from_mean * from_mean]
        });
        let rise = moments[0] / moments[1];
        let tip = mean - rise * square;
        let heights: Vec<f64> = places.iter().zip(height).map(|(x, y)| y - tip - rise * x * x).collect();
        let sum_of_squares = heights.iter().map(|y| y * y).sum();
        Self { radius, places, heights, rise, sum_of_squares }
    }

    /// The paraboloid with what a spline adds to it.
    fn curve(&self, added: Option<(&Fit, &[f64])>, by: SmoothedBy, deviation: f64) -> Smooth {
        let largest = self.radius[self.radius.len() - 1];
        let of_spline = |x: f64, derivative: usize| {
            added.map_or(0.0, |(fit, coefficients)| fit.spline.value(coefficients, x, derivative))
        };
        let places = match added {
            Some((fit, _)) => fit.spline.divided(FEWEST_KNOTS),
            None => (0..=FEWEST_KNOTS).map(|i| i as f64 / FEWEST_KNOTS as f64).collect(),
        };
        let tip = of_spline(0.0, 0);
        let value = |x: &f64| self.rise * x * x + (of_spline(*x, 0) - tip);
        let slope = |x: &f64| (2.0 * self.rise * x + of_spline(*x, 1)) / largest;
        let residual = |(x, y): (&f64, &f64)| (y - of_spline(*x, 0)).abs();
        let residuals: Vec<f64> = self.places.iter().zip(&self.heights).map(residual).collect();
        let farthest =
            (0..residuals.len()).fold(0, |far, i| if residuals[i] > residuals[far] { i } else { far });
        let squares: f64 = residuals.iter().map(|it| it * it).sum();
        let smoothing = Smoothing {
            deviation,
            by,
            residual_rms: (squares / residuals.len() as f64).sqrt(),
            residual_largest: residuals[farthest],
            residual_largest_radius: self.radius[farthest],
            tip_radius: Some(largest * largest / (2.0 * self.rise + of_spline(0.0, 2))),
        };
        let knots = places.iter().map(|x| if *x == 1.0 { largest } else { x * largest }).collect();
        Smooth {
            knots,
            values: places.iter().map(value).collect(),
            slopes: places.iter().map(slope).collect(),
            smoothing,
        }
    }
}

/// Least squares of the heights over the paraboloid by a spline.
struct Fit<'a> {
    rows: &'a Rows<'a>,
    spline: EvenSpline,
    /// `BᵀB`, `Bᵀy` and `∫ B'''ᵀB'''`.
    products: Banded,
    right: Vec<f64>,
    roughness: Banded,
    /// Where the mean curvature is bounded: the first unknown, and what the unknowns from it on add to it.
    bounds: Vec<(usize, [f64; BANDWIDTH + 1])>,
}

impl<'a> Fit<'a> {
    fn new(rows: &'a Rows, pieces: usize) -> Self {
        let spline = EvenSpline::new(&rows.places, pieces);
        let (mut products, mut right) = (Banded::new(spline.unknowns()), vec![0.0; spline.unknowns()]);
        for (x, y) in rows.places.iter().zip(&rows.heights) {
            let (first, values) = spline.basis(*x, 0);
            products.add(first, &values, 1.0);
            right[first..].iter_mut().zip(values).for_each(|(sum, value)| *sum += value * y);
        }
        let roughness = spline.roughness();
        let at = |x: f64| {
            let (first, mut curvature) = spline.basis(x, 2);
            if x == 0.0 {
                curvature.iter_mut().for_each(|it| *it *= 2.0);
            } else {
                let slope = spline.basis(x, 1).1;
                curvature.iter_mut().zip(slope).for_each(|(it, slope)| *it += slope / x);
            }
            (first, curvature)
        };
        let bounds = spline.divided(2 * spline.pieces()).into_iter().map(at).collect();
        Self { rows, spline, products, right, roughness, bounds }
    }

    /// The best weight; of equal ones the largest.
    fn best(&self, variance: f64) -> Best {
        let unit = self.products.trace() / self.roughness.trace();
        let steps = ((WEIGHTS[1] - WEIGHTS[0]) / STEP) as usize;
        let mut best = Best { criterion: f64::INFINITY, weight: unit, freedom: OF_PARABOLOID };
        for step in 0..=steps {
            let weight = unit * (WEIGHTS[1] - STEP * step as f64).exp();
            let factor = self.products.plus(&self.roughness, weight).factor();
            let freedom = factor.trace_of_solution(&self.products);
            let sum = self.sum_of_squares(&factor.solve(self.right.clone()));
            // With too little roughness the system may have no solution: it compares as no better.
            let criterion = sum + PENALTY * variance * freedom;
            if criterion < best.criterion {
                best = Best { criterion, weight, freedom };
            }
        }
        best
    }

    /// Whether the pieces are short against the length on which it smoothes: `λ^(1/6)` where a row stands in each unit.
    fn resolves(&self, weight: f64) -> bool {
        let knots = self.spline.knots();
        let mut within = vec![0.0; knots.len() - 1];
        self.rows.places.iter().for_each(|x| within[self.spline.piece(*x)] += 1.0);
        let shortest = |i: usize| {
            let width = knots[i + 1] - knots[i];
            width <= RESOLVED * (weight * width / within[i]).powf(1.0 / 6.0)
        };
        (0..within.len()).all(shortest)
    }

    /// Coefficients for a `λ`, with or without a bound on the mean curvature.
    fn coefficients(&self, weight: f64, bounded: bool) -> Vec<f64> {
        let matrix = self.products.plus(&self.roughness, weight);
        let free = matrix.clone().factor().solve(self.right.clone());
        if bounded { self.bounded(&matrix, free) } else { free }
    }

    /// Newton's method for the squares with a stiff penalty on what the mean curvature lacks; convex and piecewise quadratic, so that it ends.
    fn bounded(&self, matrix: &Banded, start: Vec<f64>) -> Vec<f64> {
        const MOST_STEPS: usize = 60;
        let stiffness = |(first, row): &(usize, [f64; BANDWIDTH + 1])| {
            let squares: f64 = row.iter().map(|it| it * it).sum();
            STIFFNESS * matrix.diagonal(*first + BANDWIDTH / 2) / squares
        };
        let stiffness: Vec<f64> = self.bounds.iter().map(stiffness).collect();
        let least = (LEAST_CURVATURE - 1.0) * self.paraboloid();
        let lacking = |x: &[f64], i: usize| (least - self.along(i, x)).max(0.0);
        let objective = |x: &[f64]| {
            let penalty = (0..self.bounds.len()).map(|i| stiffness[i] * lacking(x, i).powi(2));
            let linear: f64 = x.iter().zip(&self.right).map(|(x, y)| x * y).sum();
            matrix.form(x) - 2.0 * linear + penalty.sum::<f64>()
        };
        let (mut x, mut held) = (start, vec![]);
        for _ in 0..MOST_STEPS {
            let now: Vec<usize> = (0..self.bounds.len()).filter(|i| lacking(&x, *i) > 0.0).collect();
            if now == held {
                break;
            }
            let (mut stiffened, mut right) = (matrix.clone(), self.right.clone());
            for &i in &now {
                let (first, row) = &self.bounds[i];
                stiffened.add(*first, row, stiffness[i]);
                right[*first..].iter_mut().zip(row).for_each(|(sum, a)| *sum += stiffness[i] * a * least);
            }
            let next = stiffened.factor().solve(right);
            let before = objective(&x);
            let mut part = 1.0;
            let towards = |part: f64| -> Vec<f64> {
                x.iter().zip(&next).map(|(x, next)| x + part * (next - x)).collect()
            };
            while part > 1e-3 && objective(&towards(part)) > before {
                part *= 0.5;
            }
            x = towards(part);
            // Only a whole step with the same places held is the end.
            held = if part == 1.0 { now } else { vec![] };
        }
        x
    }

    /// Mean curvature of the paraboloid, in the units of the spline.
    fn paraboloid(&self) -> f64 {
        4.0 * self.rows.rise
    }

    /// Mean curvature that the spline adds at one of the places where it is bounded.
    fn along(&self, place: usize, coefficients: &[f64]) -> f64 {
        let (first, row) = &self.bounds[place];
        row.iter().zip(&coefficients[*first..]).map(|(a, c)| a * c).sum()
    }

    fn least_curvature(&self, coefficients: &[f64]) -> f64 {
        let added = (0..self.bounds.len()).map(|i| self.along(i, coefficients));
        self.paraboloid() + added.fold(f64::INFINITY, f64::min)
    }

    /// Sum of the squared residuals, m²; not below zero.
    fn sum_of_squares(&self, coefficients: &[f64]) -> f64 {
        let linear: f64 = coefficients.iter().zip(&self.right).map(|(c, y)| c * y).sum();
        let sum = self.rows.sum_of_squares - 2.0 * linear + self.products.form(coefficients);
        if sum.is_finite() { sum.max(0.0) } else { f64::INFINITY }
    }
}
