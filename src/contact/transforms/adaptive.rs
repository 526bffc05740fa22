//! Integrals that are refined until their estimated error is round-off, with algebraic singularities at known points.

use crate::error::{Error, Result};
use crate::numerics::quadrature::Rule;

/// Nodes of the rule in each panel.
const NODES: usize = 20;

/// Estimated relative error at which refinement ends, unless another is asked for.
pub(super) const TOLERANCE: f64 = 1e-13;

/// Panels after which an integral is given up: a tip `x^(-0.9)` takes some 450.
const MAX_PANELS: usize = 3000;

/// Difference of a panel and its halves, over its magnitude, that is nothing but rounding.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Largest ratio of the differences of a panel and its parent with which the rest of a geometric series is still trusted.
const SLOWEST_DECAY: f64 = 0.995;

/// Exponent `e > -1` of a singularity `|t|^e`, with `1 + e` on its own, because next to -1 the sum would lose its digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Exponent {
    pub(super) value: f64,
    pub(super) plus_one: f64,
}

impl Exponent {
    pub(super) const NONE: Self = Self { value: 0.0, plus_one: 1.0 };
}

/// Node of a rule: the distance from the end that may be singular is known better than the position.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    /// Where the integrand is wanted; never the anchor itself.
    pub(super) position: f64,
    /// Singular or otherwise distinguished point that the node is counted from.
    pub(super) anchor: f64,
    /// Signed distance from the anchor.
    pub(super) offset: f64,
}

impl Point {
    fn new(anchor: f64, offset: f64) -> Self {
        let position = anchor + offset;
        let position = match position == anchor {
            true if offset > 0.0 => anchor.next_up(),
            true => anchor.next_down(),
            false => position,
        };
        Self { position, anchor, offset }
    }

    /// `(|s² - x²|/scale²)^exponent`, without the factor `|s - x|^exponent` if the node is counted from `s`.
    pub(super) fn kernel(&self, s: f64, exponent: f64, scale: f64) -> f64 {
        let distance = if self.anchor == s { 1.0 } else { ((s - self.anchor) - self.offset).abs() };
        (distance / scale * ((s + self.position) / scale)).powf(exponent)
    }

    /// `|x - anchor|` of the position as rounded: the one a function of the position alone can have used.
    pub(super) fn rounded_distance(&self) -> f64 {
        (self.position - self.anchor).abs()
    }
}

/// Gauss rules for the singularities of one family of integrals.
#[derive(Debug, Clone)]
pub(super) struct Adaptive {
    rules: Vec<(Exponent, Rule)>,
    pub(super) tolerance: f64,
}

/// Stretch from an anchor, with the singularity there.
#[derive(Debug, Clone, Copy)]
struct Piece {
    anchor: f64,
    /// 1 upwards, -1 downwards.
    direction: f64,
    exponent: Exponent,
}

#[derive(Debug, Clone, Copy)]
struct Panel {
    piece: Piece,
    /// Distances of the ends from the anchor.
    near: f64,
    far: f64,
    /// Integrals over the half next to the anchor and the other one.
    halves: [f64; 2],
    /// Difference of the panel and its halves, and what it lets expect of the halves.
    difference: f64,
    error: f64,
}

impl Adaptive {
    /// Rules for singularities of the exponents given and for none.
    pub(super) fn new(exponents: &[Exponent]) -> Result<Self> {
        let mut rules: Vec<(Exponent, Rule)> = vec![(Exponent::NONE, Rule::legendre(NODES)?)];
        for &exponent in exponents {
            if rules.iter().all(|(known, _)| *known != exponent) {
                rules.push((exponent, Rule::jacobi(NODES, 0.0, exponent.value)?));
            }
        }
        Ok(Self { rules, tolerance: TOLERANCE })
    }

    /// Integral from the first to the last of the points, which increase.
    ///
    /// # Arguments
    /// * `what` -- name of the integral, for the error
    /// * `points` -- ends of the interval and all places between at which the integrand is not smooth
    /// * `exponent` -- of the singularity at a point, above it (`true`) and below it
    /// * `integrand` -- the integrand without the singular factor `|t|^e` of the point it is counted from
    ///
    /// # Errors
    /// [`Error::NotConverged`] if the estimated error stays above the tolerance, relative to the integral, or a value is not finite.
    pub(super) fn integrate(
        &self,
        what: &'static str,
        points: &[f64],
        exponent: impl Fn(f64, bool) -> Exponent,
        integrand: impl Fn(&Point) -> f64,
    ) -> Result<f64> {
        let mut panels = Vec::new();
        for ends in points.windows(2) {
            let middle = ends[0] + 0.5 * (ends[1] - ends[0]);
            for (anchor, direction) in [(ends[0], 1.0), (ends[1], -1.0)] {
                let piece = Piece { anchor, direction, exponent: exponent(anchor, direction > 0.0) };
                let length = (middle - anchor).abs();
                let whole = self.panel_integral(piece, 0.0, length, &integrand);
                panels.push(self.panel(piece, [0.0, length], whole, None, &integrand));
            }
        }
        loop {
            let value: f64 = panels.iter().map(|panel| panel.halves[0] + panel.halves[1]).sum();
            let error: f64 = panels.iter().map(|panel| panel.error).sum();
            if value.is_finite() && error <= self.tolerance * value.abs() {
                return Ok(value);
            }
            let worst =
                (0..panels.len()).max_by(|&i, &j| panels[i].error.total_cmp(&panels[j].error)).filter(
                    |&worst| value.is_finite() && panels.len() < MAX_PANELS && panels[worst].is_divisible(),
                );
            let Some(worst) = worst else {
                return Err(not_converged(what, value, error, &panels));
            };
            let panel = panels.swap_remove(worst);
            let middle = 0.5 * (panel.near + panel.far);
            for (ends, whole) in [[panel.near, middle], [middle, panel.far]].into_iter().zip(panel.halves) {
                panels.push(self.panel(panel.piece, ends, whole, Some(panel.difference), &integrand));
            }
        }
    }

    fn panel(
        &self,
        piece: Piece,
        [near, far]: [f64; 2],
        whole: f64,
        parent_difference: Option<f64>,
        integrand: &impl Fn(&Point) -> f64,
    ) -> Panel {
        let middle = 0.5 * (near + far);
        let halves = [
            self.panel_integral(piece, near, middle, integrand),
            self.panel_integral(piece, middle, far, integrand),
        ];
        let difference = (halves[0] + halves[1] - whole).abs();
        let magnitude = halves[0].abs() + halves[1].abs();
        let error = if difference <= ROUNDING * magnitude {
            difference
        } else if difference.is_nan() {
            f64::INFINITY
        } else {
            // At an end where the integrand is not smooth the differences of ever smaller panels form a geometric series. At a kink that
            // nobody named they jump, and a small one may be luck: the mean with the one before is not.
            let parent = parent_difference.unwrap_or(f64::INFINITY);
            let decay = (difference / parent).clamp(0.5, SLOWEST_DECAY);
            (difference * decay / (1.0 - decay)).max((difference * parent.min(magnitude)).sqrt())
        };
        Panel { piece, near, far, halves, difference, error }
    }

    fn panel_integral(&self, piece: Piece, near: f64, far: f64, integrand: &impl Fn(&Point) -> f64) -> f64 {
        let value_at = |distance: f64| integrand(&Point::new(piece.anchor, piece.direction * distance));
        let exponent = piece.exponent;
        if near == 0.0 {
            let scale = far.powf(exponent.plus_one) / exponent.plus_one;
            return scale * self.rule(exponent).mean(|v| value_at(far * v));
        }
        let width = far - near;
        width
            * self.rule(Exponent::NONE).mean(|v| {
                let distance = near + width * v;
                let singular = if exponent == Exponent::NONE { 1.0 } else { distance.powf(exponent.value) };
                singular * value_at(distance)
            })
    }

    fn rule(&self, exponent: Exponent) -> &Rule {
        let known = self.rules.iter().find(|(known, _)| *known == exponent);
        &known.expect("every exponent in use is listed at the construction").1
    }
}

impl Panel {
    /// Whether halves of it would have nodes of their own.
    fn is_divisible(&self) -> bool {
        self.far > f64::MIN_POSITIVE
            && self.far > f64::EPSILON * self.piece.anchor.abs()
            && self.far - self.near > 4.0 * f64::EPSILON * self.far
    }
}

fn not_converged(what: &'static str, value: f64, error: f64, panels: &[Panel]) -> Error {
    let worst = panels.iter().max_by(|a, b| a.error.total_cmp(&b.error));
    let place = worst.map_or(f64::NAN, |panel| panel.piece.anchor + panel.piece.direction * panel.far);
    Error::NotConverged {
        what,
        why: format!(
            "{value:e} with an estimated error of {error:e} from {} panels, the worst of them next to {place} m",
            panels.len()
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integral(e: f64, f: impl Fn(f64) -> f64) -> Result<f64> {
        let exponent = Exponent { value: e, plus_one: 1.0 + e };
        let none = |_: f64, above: bool| if above { exponent } else { Exponent::NONE };
        let adaptive = Adaptive::new(&[exponent]).unwrap();
        adaptive.integrate("test", &[0.0, 1.0], none, |point| {
            f(point.position) * if point.anchor == 0.0 { 1.0 } else { point.position.powf(e) }
        })
    }

    #[test]
    fn tips_that_no_rule_knows_are_refined_to_round_off() {
        for e in [-0.9, -0.5, 0.3, 1.5] {
            let found = integral(0.0, |x| x.powf(e)).unwrap();
            assert!((found * (1.0 + e) - 1.0).abs() < 2e-13, "x^{e}: {found}");
            let found = integral(-0.99, |x| x.powf(e + 0.99)).unwrap();
            assert!((found * (1.0 + e) - 1.0).abs() < 2e-13, "x^{e} by another exponent: {found}");
        }
    }

    #[test]
    fn what_diverges_or_is_no_number_is_refused() {
        for e in [-1.0, -1.01, -2.0] {
            let message = integral(0.0, |x| x.powf(e)).unwrap_err().to_string();
            assert!(message.contains("panels"), "{message}");
        }
        assert!(integral(0.0, |x| if x > 0.7 { f64::NAN } else { 1.0 }).is_err());
    }
}
