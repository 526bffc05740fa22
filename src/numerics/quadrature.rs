//! Gauss rules on [0, 1] for integrands with an algebraic end-point singularity.

use std::sync::OnceLock;

use crate::error::{Error, Result};

/// Largest number of nodes of a [`Rule`]: the rounding errors of more were never looked at.
pub const MAX_NODES: usize = 200;

/// Newton steps that a node may take; from the guesses used here it takes three to eight.
const MAX_NEWTON_STEPS: usize = 60;

/// Gauss rule for the weighted mean of a function over (0, 1).
///
/// ```text
/// Σ_i w_i f(v_i)  =  ∫_0^1 (1-v)^α v^β f(v) dv / B(α+1, β+1),     Σ_i w_i = 1
/// ```
///
/// Exact for polynomials of degree below twice the number of nodes. The weights are those of a mean: as `α` or `β` tends to -1 the
/// integral diverges and the mean does not, and it is always the product with a vanishing factor that is wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// Nodes `v_i`, shape `(n,)`, increasing in (0, 1), to full relative accuracy.
    pub nodes: Vec<f64>,
    /// Distances `1 - v_i` from the upper end, shape `(n,)`, to full relative accuracy.
    pub complements: Vec<f64>,
    /// Weights, shape `(n,)`, positive, of sum one.
    pub weights: Vec<f64>,
}

impl Rule {
    /// Gauss-Legendre rule: the plain mean over (0, 1), `α = β = 0`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless `1 <= node_count <=` [`MAX_NODES`].
    pub fn legendre(node_count: usize) -> Result<Self> {
        Self::jacobi(node_count, 0.0, 0.0)
    }

    /// Gauss-Jacobi rule of weight `(1-v)^upper v^lower`.
    ///
    /// The nodes are zeros of the Jacobi polynomial, by Newton's method from both ends, with the recurrence written so that the zeros
    /// next to an end keep their relative accuracy; the pair `upper + lower = -1` needs no special treatment.
    ///
    /// # Arguments
    /// * `node_count` -- number of nodes `n`, from 1 to [`MAX_NODES`]
    /// * `upper` -- exponent `α` at `v = 1`, above -1
    /// * `lower` -- exponent `β` at `v = 0`, above -1
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the argument; [`Error::NotConverged`] if a zero was missed (exponents in the hundreds).
    ///
    /// # Examples
    /// ```
    /// use fretwear::numerics::quadrature::Rule;
    ///
    /// // mean of v under the weight (1-v)^(-1/2) v^(-1/2): the Chebyshev case, 1/2
    /// let rule = Rule::jacobi(8, -0.5, -0.5)?;
    /// assert!((rule.mean(|v| v) - 0.5).abs() < 1e-15);
    /// # Ok::<(), fretwear::Error>(())
    /// ```
    pub fn jacobi(node_count: usize, upper: f64, lower: f64) -> Result<Self> {
        if !(1..=MAX_NODES).contains(&node_count) {
            return Err(Error::OutOfRange {
                name: "quadrature node count",
                value: node_count as f64,
                range: "[1, 200]",
            });
        }
        check_exponents(upper, lower)?;
        let rising = Jacobi::new(node_count, upper, lower);
        let below = rising.zeros_up_to(0.5);
        let from_below = rising.smallest_zeros(below)?;
        let from_above = Jacobi::new(node_count, lower, upper).smallest_zeros(node_count - below)?;
        let rule = Self::assemble(node_count, upper, lower, &from_below, &from_above);
        rule.check_sum(upper, lower)?;
        Ok(rule)
    }

    /// Weighted mean of `function`.
    pub fn mean(&self, function: impl Fn(f64) -> f64) -> f64 {
        self.nodes.iter().zip(&self.weights).map(|(&node, &weight)| weight * function(node)).sum()
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there is no node; never true.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Joins the zeros found from either end; `w_i` is proportional to `1 / (v (1-v) P'(v)²)`.
    fn assemble(node_count: usize, upper: f64, lower: f64, from_below: &[Zero], from_above: &[Zero]) -> Self {
        // The polynomial is scaled to 1 at its own end: |P(1)/P(0)| joins the two scales.
        let end_ratio: f64 = (1..=node_count).map(|j| (upper + j as f64) / (lower + j as f64)).product();
        let above =
            from_above.iter().rev().map(|zero| (1.0 - zero.position, zero.position, zero.slope * end_ratio));
        let all = from_below.iter().map(|zero| (zero.position, 1.0 - zero.position, zero.slope)).chain(above);
        let mut rule = Self { nodes: Vec::new(), complements: Vec::new(), weights: Vec::new() };
        for (node, complement, slope) in all {
            rule.nodes.push(node);
            rule.complements.push(complement);
            rule.weights.push(1.0 / (node * complement * slope * slope));
        }
        let total: f64 = rule.weights.iter().sum();
        rule.weights.iter_mut().for_each(|weight| *weight /= total);
        rule
    }

    /// The zeros of the Jacobi polynomial have a known sum; a missed one would show.
    fn check_sum(&self, upper: f64, lower: f64) -> Result<()> {
        let count = self.len() as f64;
        let expected = count * (count + lower) / (2.0 * count + upper + lower);
        let found: f64 = self.nodes.iter().sum();
        if (found - expected).abs() <= 1e-12 * count && self.weights.iter().all(|weight| weight.is_finite()) {
            return Ok(());
        }
        Err(Error::NotConverged {
            what: "Gauss-Jacobi nodes",
            why: format!(
                "their sum is {found}, not {expected} ({count} nodes, exponents {upper} and {lower})"
            ),
        })
    }
}

fn check_exponents(upper: f64, lower: f64) -> Result<()> {
    for (name, value) in [("upper quadrature exponent", upper), ("lower quadrature exponent", lower)] {
        if !(value > -1.0 && value.is_finite()) {
            return Err(Error::OutOfRange { name, value, range: "(-1, inf)" });
        }
    }
    Ok(())
}

/// Rules of one pair of exponents, each built when it is first asked for.
///
/// Nodes are dear: a rule of 48 costs as much as a thousand evaluations of a simple integrand.
#[derive(Debug, Clone)]
pub struct RuleFamily {
    exponents: (f64, f64),
    rules: [OnceLock<Rule>; FAMILY.len()],
}

/// Node counts of a [`RuleFamily`].
const FAMILY: [usize; 16] = [12, 16, 20, 24, 28, 32, 40, 48, 56, 64, 80, 96, 112, 136, 168, MAX_NODES];

impl RuleFamily {
    /// Rules of weight `(1-v)^upper v^lower`, as [`Rule::jacobi`] gives them.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the exponent that is not above -1, or above 10.
    pub fn new(upper: f64, lower: f64) -> Result<Self> {
        check_exponents(upper, lower)?;
        if upper.max(lower) > 10.0 {
            return Err(Error::OutOfRange {
                name: "quadrature exponent",
                value: upper.max(lower),
                range: "(-1, 10]",
            });
        }
        Ok(Self { exponents: (upper, lower), rules: Default::default() })
    }

    /// The smallest rule of at least so many nodes; the largest one if none has as many.
    pub fn at_least(&self, node_count: usize) -> &Rule {
        let place = FAMILY.partition_point(|&count| count < node_count).min(FAMILY.len() - 1);
        let (upper, lower) = self.exponents;
        self.rules[place].get_or_init(|| {
            Rule::jacobi(FAMILY[place], upper, lower).expect("for exponents in (-1, 10] no zero is missed")
        })
    }
}

/// Zero of a Jacobi polynomial with the derivative there.
struct Zero {
    position: f64,
    slope: f64,
}

/// Jacobi polynomial on [0, 1] of weight `(1-v)^α v^β`, scaled to 1 at `v = 0`, by the recurrence of its increments,
///
/// ```text
/// P_{j+1} = P_j + D_j,     D_j = c_j D_{j-1} - a_j v P_j
/// a_j = (2j+s+1)(2j+s+2) / ((j+β+1)(j+s+1)),   c_j = j (j+α)(2j+s+2) / ((2j+s)(j+β+1)(j+s+1)),   s = α+β
/// ```
/// in which nothing cancels next to `v = 0`.
struct Jacobi {
    coefficients: Vec<[f64; 2]>,
    /// Distance of neighbouring zeros in `arcsin √v` when there are many.
    angle_step: f64,
    /// `β+1`, `s+2` and `n (n+s+1)` of the differential equation.
    equation: [f64; 3],
}

impl Jacobi {
    fn new(degree: usize, upper: f64, lower: f64) -> Self {
        let sum = upper + lower;
        let later = (1..degree).map(|j| {
            let j = j as f64;
            let (even, divisor) = (2.0 * j + sum, (j + lower + 1.0) * (j + sum + 1.0));
            [(even + 1.0) * (even + 2.0) / divisor, j * (j + upper) * (even + 2.0) / (even * divisor)]
        });
        let coefficients = std::iter::once([(sum + 2.0) / (lower + 1.0), 0.0]).chain(later).collect();
        let n = degree as f64;
        Self {
            coefficients,
            angle_step: 0.5 * std::f64::consts::PI / (n + 0.5 * (sum + 1.0)),
            equation: [lower + 1.0, sum + 2.0, n * (n + sum + 1.0)],
        }
    }

    /// Value and derivative at `v`.
    fn evaluate(&self, v: f64) -> (f64, f64) {
        let (mut value, mut slope) = (1.0, 0.0);
        let (mut increment, mut slope_increment) = (0.0, 0.0);
        for &[a, c] in &self.coefficients {
            increment = c * increment - a * v * value;
            slope_increment = c * slope_increment - a * (value + v * slope);
            value += increment;
            slope += slope_increment;
        }
        (value, slope)
    }

    /// Number of zeros in (0, v]: the polynomials of lower degree form a Sturm sequence.
    fn zeros_up_to(&self, v: f64) -> usize {
        let (mut value, mut increment) = (1.0_f64, 0.0);
        let mut changes = 0;
        for &[a, c] in &self.coefficients {
            increment = c * increment - a * v * value;
            let next = value + increment;
            changes += usize::from((next > 0.0) != (value > 0.0));
            value = next;
        }
        changes
    }

    /// The `count` smallest zeros, increasing.
    ///
    /// They are nearly equidistant in `arcsin √v`: from the third on each is guessed from the two before. The first ones, and any whose
    /// guess leads astray, are found by Newton's method with the zeros already known divided out, which cannot meet one twice.
    fn smallest_zeros(&self, count: usize) -> Result<Vec<Zero>> {
        let angle = |zero: &Zero| zero.position.sqrt().asin();
        let mut zeros: Vec<Zero> = Vec::with_capacity(count);
        for _ in 0..count {
            let guessed = match zeros.as_slice() {
                [.., before, last] => self.zero_near((2.0 * angle(last) - angle(before)).sin().powi(2), last),
                _ => None,
            };
            let zero = match guessed {
                Some(zero) => zero,
                None => {
                    let start =
                        zeros.last().map_or(0.0, |last| (angle(last) + self.angle_step).sin().powi(2));
                    self.zero_from(start, &zeros)?
                }
            };
            zeros.push(zero);
        }
        Ok(zeros)
    }

    /// The zero next to a good guess by Halley's method, whose second derivative comes from the differential equation
    ///
    /// ```text
    /// v (1-v) P'' + [β+1 - (s+2) v] P' + n (n+s+1) P = 0
    /// ```
    /// none if it does not settle within a third of the spacing of the zeros.
    fn zero_near(&self, guess: f64, last: &Zero) -> Option<Zero> {
        let reach = (guess - last.position) / 3.0;
        let mut position = guess;
        for _ in 0..4 {
            let (value, slope) = self.evaluate(position);
            let newton = value / slope;
            let [constant, linear, eigenvalue] = self.equation;
            let room = position * (1.0 - position);
            let curvature = -((constant - linear * position) + eigenvalue * newton) / room;
            let step = newton / (1.0 - 0.5 * newton * curvature);
            position -= step;
            let astray = (position - guess).abs();
            if astray.is_nan() || astray >= reach {
                return None;
            }
            // The error left is of the order of the cube of the step over the spacing; Newton's method takes it below the last bit.
            if step.abs() <= 1e-5 * room.min(reach) {
                let (value, slope) = self.evaluate(position);
                return Some(Zero { position: position - value / slope, slope });
            }
        }
        None
    }

    fn zero_from(&self, start: f64, known: &[Zero]) -> Result<Zero> {
        let mut position = start;
        for _ in 0..MAX_NEWTON_STEPS {
            let (value, slope) = self.evaluate(position);
            let plain_step = value / slope;
            let crowding: f64 = known.iter().map(|zero| 1.0 / (position - zero.position)).sum();
            position -= plain_step / (1.0 - plain_step * crowding);
            // The step after this one would be below the last bit: it would be of the order of this one squared.
            if plain_step.abs() <= 1e-9 * position.abs() * (1.0 - position).abs() {
                let (value, slope) = self.evaluate(position);
                return Ok(Zero { position: position - value / slope, slope });
            }
        }
        Err(Error::NotConverged {
            what: "Gauss-Jacobi node",
            why: format!("Newton's method from {start} was at {position} after {MAX_NEWTON_STEPS} steps"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean of `v^m (1-v)^l` under the weight: a ratio of Beta functions, as a product.
    fn moment(upper: f64, lower: f64, m: usize, l: usize) -> f64 {
        let powers = (0..m).map(|j| (lower + 1.0 + j as f64) / (upper + lower + 2.0 + j as f64));
        let total = upper + lower + 2.0 + m as f64;
        powers.chain((0..l).map(|j| (upper + 1.0 + j as f64) / (total + j as f64))).product()
    }

    #[test]
    fn moments_are_ratios_of_beta_functions() {
        let mut worst = (0.0, String::new());
        let exponents = [-0.99995, -0.9, -0.5, -0.3, 0.0, 0.5, 0.99995, 3.0, 12.0];
        for upper in exponents.into_iter().chain([-0.05, -0.7]) {
            for lower in
                exponents.into_iter().chain([-0.95, -0.3, -1.0 - upper]).filter(|lower| *lower > -1.0)
            {
                for count in [1, 2, 3, 8, 24, 25, 48, 96, 200] {
                    let rule = Rule::jacobi(count, upper, lower).unwrap();
                    assert!(rule.nodes.windows(2).all(|pair| pair[0] < pair[1]));
                    for (m, l) in [
                        (1, 0),
                        (0, 1),
                        (2 * count - 1, 0),
                        (0, 2 * count - 1),
                        (count, count - 1),
                        (3, 0),
                        (0, 3),
                    ] {
                        if m + l >= 2 * count {
                            continue;
                        }
                        let expected = moment(upper, lower, m, l);
                        let terms = rule.weights.iter().zip(rule.nodes.iter().zip(&rule.complements));
                        let found: f64 =
                            terms.map(|(w, (v, u))| w * v.powi(m as i32) * u.powi(l as i32)).sum();
                        let error = (found / expected - 1.0).abs() / (1.0 + m as f64 + l as f64);
                        if error > worst.0 {
                            worst = (
                                error,
                                format!("{count} nodes, exponents {upper} and {lower}, v^{m} (1-v)^{l}"),
                            );
                        }
                    }
                }
            }
        }
        println!("worst {worst:?}");
        assert!(worst.0 < 2e-14, "relative error {:e} per degree: {}", worst.0, worst.1);
    }

    #[test]
    fn chebyshev_nodes_are_exact_next_to_the_ends() {
        let count = 100;
        let rule = Rule::jacobi(count, -0.5, -0.5).unwrap();
        for (i, (&v, &u)) in rule.nodes.iter().zip(&rule.complements).enumerate() {
            let angle = std::f64::consts::FRAC_PI_4 * (2 * i + 1) as f64 / count as f64;
            let (sine, cosine) = (angle.sin().powi(2), angle.cos().powi(2));
            assert!(
                (v / sine - 1.0).abs() < 2e-14 && (u / cosine - 1.0).abs() < 2e-14,
                "node {i}: {v:e} {u:e}, exact {sine:e} {cosine:e}"
            );
            assert!(
                (rule.weights[i] * count as f64 - 1.0).abs() < 2e-13,
                "weight {i}: {:e}",
                rule.weights[i]
            );
        }
    }

    #[test]
    fn exponents_of_minus_one_and_too_many_nodes_are_refused() {
        assert!(matches!(Rule::jacobi(4, -1.0, 0.0), Err(Error::OutOfRange { .. })));
        assert!(matches!(Rule::jacobi(4, 0.0, f64::NAN), Err(Error::OutOfRange { .. })));
        assert!(matches!(Rule::legendre(201), Err(Error::OutOfRange { .. })));
        assert!(matches!(Rule::legendre(0), Err(Error::OutOfRange { .. })));
    }
}
