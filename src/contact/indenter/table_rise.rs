//! What a measured profile rises by outside the edge of stick, carried to the surface.

use std::f64::consts::PI;
use std::sync::{Arc, Mutex, PoisonError};

use super::cubic::Cubic;
use super::rise_kernel::RiseKernel;
use crate::error::{Error, Result};
use crate::numerics::chebyshev::PiecewiseChebyshev;
use crate::numerics::quadrature::Rule;

/// Nodes for a kernel that is singular at least one width away: its error falls as 5.8^(-2n), and as 5.8^-n where it is interpolated.
const NODES: usize = 10;
const INTERPOLATED: usize = 18;

/// Pieces below which a block is integrated piece by piece.
const LEAF: usize = 8;

/// Longest piece and block, in the logarithm: what is integrated grows exponentially.
const LONGEST: f64 = 0.5;
const LONGEST_BLOCK: f64 = 2.0;

/// How far beyond the table, in the logarithm, its straight continuation is integrated.
const BEYOND: f64 = 0.2;

/// To what the series resolve the transform, relative, where the kinks of the table let them.
const ACCURACY: f64 = 1e-11;

/// Pieces up to which they do. Rough rows would take several for each row, and minutes: beyond, a coarser accuracy is enough, up to most pieces.
const MANY_PIECES: usize = 2048;
const ENOUGH: f64 = 1e-8;
const MOST_PIECES: usize = 4096;

/// What may be left unresolved by them.
const COARSEST: f64 = 1e-6;

/// Steps between the ends of series, as a factor: those who need nearly the same share one.
const STEP: f64 = 1.25;

/// Transform of the rise of a table over its value at a radius `c`, [S, Eq. (20)]: a convolution in the logarithm `u = ln(x²/c²)`.
///
/// ```text
/// F(g - g(c)) = sin(πν)/π ∫_0^ℓ (g - g(c)) (e^(ℓ-u) - 1)^(-ν) du,     ℓ = ln(r²/c²),  ν = (1+k)/2
/// ```
///
/// Split at the knots of `g`. The piece in which `ℓ` is carries the singularity in the weight of a Gauss-Jacobi rule, pieces next to it are
/// halved towards it, and those farther away are taken in blocks on which the kernel is interpolated: a value costs the logarithm of the
/// number of rows, be they smooth or rough.
#[derive(Debug)]
pub struct RiseTransform {
    curve: Arc<Cubic>,
    radius: f64,
    mu: f64,
    nu: f64,
    /// Ends of the pieces in the logarithm, from 0.
    knots: Vec<f64>,
    /// Rise at the nodes of each piece.
    rises: Vec<[f64; NODES]>,
    rule: Rule,
    kernel: RiseKernel,
    end_rule: Rule,
    /// `v^ν` at the nodes of that rule.
    end_powers: Vec<f64>,
    volume_rule: Rule,
    blocks: Vec<Block>,
    interpolation: Interpolation,
    series: Mutex<Option<Arc<PiecewiseChebyshev>>>,
}

/// Neighbouring pieces, `first..last`; the blocks are stored so that the halves of one stand before it.
#[derive(Debug)]
struct Block {
    first: u32,
    last: u32,
    halves: Option<(u32, u32)>,
    /// Integrals of the rise times the Lagrange polynomials on the points.
    moments: [f64; INTERPOLATED],
}

/// Where a transform begins and for which radius it is, with the rise over the edge of stick that it begins at.
struct Span {
    /// Squared radius, m², of the edge of stick, its radius, m, and the piece of `g` there.
    stick_area: f64,
    radius: f64,
    piece: usize,
    /// Its logarithm, and what `g` has risen by there.
    start: f64,
    rise: f64,
    end: f64,
}

impl RiseTransform {
    /// How far beyond the limiting contact edge slip is wanted, as a factor of `r² - c²`.
    pub(crate) const MARGIN: f64 = 1.1;

    pub(super) fn new(curve: &Arc<Cubic>, grading: f64, radius: f64) -> Result<Self> {
        let (mu, nu) = (0.5 * (1.0 - grading), 0.5 * (1.0 + grading));
        let mut knots = vec![0.0];
        for x in &curve.knots()[curve.index(radius) + 1..] {
            add_knot(&mut knots, logarithm(radius, *x));
        }
        let end = knots[knots.len() - 1] + BEYOND;
        add_knot(&mut knots, end);
        let (rule, end_rule) = (Rule::legendre(NODES)?, Rule::jacobi(NODES + 2, 0.0, -nu)?);
        let area = radius * radius;
        let rise = |pair: &[f64]| {
            std::array::from_fn(|i| {
                let place = pair[0] + (pair[1] - pair[0]) * rule.nodes[i];
                curve.rise(radius, area * place.exp_m1())
            })
        };
        let rises = knots.windows(2).map(rise).collect();
        let mut transform = Self {
            curve: Arc::clone(curve),
            radius,
            mu,
            nu,
            knots,
            rises,
            kernel: RiseKernel::new(nu),
            end_powers: end_rule.nodes.iter().map(|v| v.powf(nu)).collect(),
            end_rule,
            volume_rule: Rule::jacobi(NODES + 2, 0.0, mu)?,
            rule,
            blocks: Vec::new(),
            interpolation: Interpolation::new(),
            series: Mutex::new(None),
        };
        transform.add_block(0, transform.rises.len());
        Ok(transform)
    }

    /// The radius `c`, m.
    pub(super) fn radius(&self) -> f64 {
        self.radius
    }

    /// `F(g - g(c))/(φ ℓ^(1+μ))`, m, with `φ = sin(πν)/(πμ)` and `μ = (1-k)/2`, at `ℓ = ln(r²/c²)`.
    pub(crate) fn mean(&self, logarithm: f64) -> f64 {
        self.mean_over(logarithm, &self.span(self.radius * self.radius, 0.0, 0.0, logarithm))
    }

    /// The same for another edge of stick, outside the radius `c`.
    ///
    /// # Arguments
    /// * `stick_area` -- its square, m²
    /// * `logarithm` -- `ln(r²/stick_area)`
    pub(crate) fn mean_from(&self, stick_area: f64, logarithm: f64) -> f64 {
        let area = self.radius * self.radius;
        let start = ((stick_area - area) / area).ln_1p();
        if start <= 0.0 {
            return self.mean(logarithm);
        }
        let rise = self.curve.rise(self.radius, stick_area - area);
        self.mean_over(logarithm, &self.span(stick_area, start, rise, start + logarithm))
    }

    fn span(&self, stick_area: f64, start: f64, rise: f64, end: f64) -> Span {
        let radius = stick_area.sqrt();
        Span { stick_area, radius, piece: self.curve.index(radius), start, rise, end }
    }

    fn mean_over(&self, logarithm: f64, span: &Span) -> f64 {
        let first = self.piece(span.start);
        let mut last = self.piece(span.end);
        if last > first && self.knots[last] >= span.end {
            last -= 1;
        }
        let kernel = |y: f64| self.kernel.value(y);
        let low = if last > first { (self.knots[last] - span.start).max(0.0) } else { 0.0 };
        let width = logarithm - low;
        // Of `(e^y - 1)^(-ν)` the rule has `v^(-ν)` as its weight.
        let rule = &self.end_rule;
        let own = (0..rule.len()).map(|i| {
            let smooth = self.end_powers[i] * kernel(width * rule.nodes[i]);
            rule.weights[i] * smooth * self.rise(span, low + width * rule.complements[i])
        });
        let own = width.powf(self.nu) * own.sum::<f64>();
        let mut others = 0.0;
        if last > first {
            let mut begin = first;
            if span.start > 0.0 {
                begin += 1;
                others += self.towards(span, 0.0, self.knots[begin] - span.start, logarithm, &kernel);
            }
            self.add_blocks(self.blocks.len() - 1, begin..last, span, &kernel, &mut others);
        }
        // With the powers of ℓ drawn in, nothing over- or underflows where ℓ is tiny.
        (width / logarithm).powf(self.mu) * (own / logarithm)
            + self.mu * logarithm.powf(-self.mu) * (others / logarithm)
    }

    /// Mean compression, m, that counts for the volume up to `ℓ = ln(r²/c²)` of springs with the compression `q_c` at `c`:
    ///
    /// ```text
    /// (1+μ) ℓ^(-1-μ) ∫_0^ℓ (q_c - (g - g(c))) e^(u-ℓ) (e^(ℓ-u) - 1)^μ du
    /// ```
    pub(crate) fn volume_mean(&self, compression: f64, logarithm: f64) -> f64 {
        let span = self.span(self.radius * self.radius, 0.0, compression, logarithm);
        let last = self.piece(logarithm);
        let width = logarithm - self.knots[last];
        let rule = &self.volume_rule;
        let own: f64 = (0..rule.len())
            .map(|i| {
                let y = width * rule.nodes[i];
                let rise = self.rise(&span, self.knots[last] + width * rule.complements[i]);
                rule.weights[i] * (-y).exp() * shed(y).powf(self.mu) * rise
            })
            .sum();
        let kernel = |y: f64| (-y).exp() * y.exp_m1().powf(self.mu);
        let mut others = 0.0;
        (0..last).for_each(|piece| self.add_piece(piece, &span, &kernel, &mut others));
        let alpha = 1.0 + self.mu;
        -((width / logarithm).powf(alpha) * own + alpha * logarithm.powf(-alpha) * others)
    }

    /// Series of [`RiseTransform::mean`] up to [`RiseTransform::MARGIN`] of `r² - c²` at a logarithm, or farther.
    ///
    /// # Errors
    /// [`Error::Inconsistent`] where rows are too rough for as many pieces as can be had in a second.
    pub(crate) fn series(&self, logarithm: f64) -> Result<Arc<PiecewiseChebyshev>> {
        let least = (Self::MARGIN * logarithm.exp_m1()).ln_1p();
        let step = (least.ln() / STEP.ln()).ceil();
        let end = STEP.powf(step).min(self.knots[self.knots.len() - 1]).max(least);
        let known = || self.series.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(series) = known().as_ref().filter(|series| series.edges().last() == Some(&end)) {
            return Ok(Arc::clone(series));
        }
        let narrowest = |place: f64| {
            let piece = self.piece(place);
            self.knots[piece + 1] - self.knots[piece]
        };
        // Not under the lock, as for the transform itself.
        let series = PiecewiseChebyshev::fit(|l| self.mean(l), end, accuracy, narrowest);
        if series.unresolved() > COARSEST {
            return Err(Error::Inconsistent {
                what: "indenter.table",
                why: format!(
                    "its rows are so rough that {MOST_PIECES} pieces leave {:.1e} of the wear unresolved between the edge of stick and {} m; \
                     smooth it, or give fewer rows",
                    series.unresolved(),
                    self.radius * (0.5 * end).exp()
                ),
            });
        }
        let series = Arc::new(series);
        *known() = Some(Arc::clone(&series));
        Ok(series)
    }

    /// The piece that holds a logarithm.
    fn piece(&self, logarithm: f64) -> usize {
        (self.knots.partition_point(|knot| *knot <= logarithm) - 1).min(self.rises.len() - 1)
    }

    /// Rise over the edge of stick at the distance `offset` from it in the logarithm; less `rise` where there is none of its own.
    fn rise(&self, span: &Span, offset: f64) -> f64 {
        let rise = self.curve.rise_from(span.piece, span.radius, span.stick_area * offset.exp_m1());
        if span.start > 0.0 { rise } else { rise - span.rise }
    }

    /// Integral from `low` to `high`, distances from the edge of stick, in panels no wider than their distance from `end`.
    fn towards(&self, span: &Span, low: f64, high: f64, end: f64, kernel: &impl Fn(f64) -> f64) -> f64 {
        let (mut sum, mut high) = (0.0, high);
        while high > low {
            let next = low.max(high - (end - high));
            let width = high - next;
            if width <= 0.0 {
                break;
            }
            for (node, weight) in self.rule.nodes.iter().zip(&self.rule.weights) {
                let place = next + width * node;
                sum += width * weight * kernel(end - place) * self.rise(span, place);
            }
            high = next;
        }
        sum
    }

    /// Adds the pieces of a block that are among those given, which lie before `end`.
    fn add_blocks(
        &self,
        index: usize,
        pieces: std::ops::Range<usize>,
        span: &Span,
        kernel: &impl Fn(f64) -> f64,
        sum: &mut f64,
    ) {
        let block = &self.blocks[index];
        let (first, last) = (block.first as usize, block.last as usize);
        if first >= pieces.end || last <= pieces.start {
            return;
        }
        let (left, right) = (self.knots[first], self.knots[last]);
        let (width, distance) = (right - left, span.end - right);
        let whole = pieces.start <= first && last <= pieces.end;
        if whole && distance >= width && width <= LONGEST_BLOCK {
            let interpolation = &self.interpolation;
            for (j, moment) in block.moments.iter().enumerate() {
                *sum += kernel(span.end - left - width * interpolation.points[j])
                    * (moment - span.rise * width * interpolation.weights[j]);
            }
        } else if let Some((lower, upper)) = block.halves {
            self.add_blocks(lower as usize, pieces.clone(), span, kernel, sum);
            self.add_blocks(upper as usize, pieces, span, kernel, sum);
        } else {
            for piece in first.max(pieces.start)..last.min(pieces.end) {
                self.add_piece(piece, span, kernel, sum);
            }
        }
    }

    /// Adds a whole piece that lies before `end`.
    fn add_piece(&self, piece: usize, span: &Span, kernel: &impl Fn(f64) -> f64, sum: &mut f64) {
        let (left, right) = (self.knots[piece], self.knots[piece + 1]);
        if span.end - right < right - left {
            *sum += self.towards(span, left - span.start, right - span.start, span.end - span.start, kernel);
            return;
        }
        let width = right - left;
        for (i, rise) in self.rises[piece].iter().enumerate() {
            let y = span.end - left - width * self.rule.nodes[i];
            *sum += width * self.rule.weights[i] * kernel(y) * (rise - span.rise);
        }
    }

    /// Adds the blocks of the pieces `first..last` and returns the index of the largest.
    fn add_block(&mut self, first: usize, last: usize) -> usize {
        let (left, width) = (self.knots[first], self.knots[last] - self.knots[first]);
        let mut block =
            Block { first: first as u32, last: last as u32, halves: None, moments: [0.0; INTERPOLATED] };
        let interpolation = &self.interpolation;
        if last - first <= LEAF {
            for piece in first..last {
                let (start, length) = (self.knots[piece], self.knots[piece + 1] - self.knots[piece]);
                for (i, rise) in self.rises[piece].iter().enumerate() {
                    let place = (start - left + length * self.rule.nodes[i]) / width;
                    interpolation.add(place, length * self.rule.weights[i] * rise, &mut block.moments);
                }
            }
        } else {
            let middle = first + (last - first) / 2;
            let halves = (self.add_block(first, middle), self.add_block(middle, last));
            let interpolation = &self.interpolation;
            for half in [&self.blocks[halves.0], &self.blocks[halves.1]] {
                let start = self.knots[half.first as usize];
                let length = self.knots[half.last as usize] - start;
                for (point, part) in interpolation.points.iter().zip(&half.moments) {
                    interpolation.add((start - left + length * point) / width, *part, &mut block.moments);
                }
            }
            block.halves = Some((halves.0 as u32, halves.1 as u32));
        }
        self.blocks.push(block);
        self.blocks.len() - 1
    }
}

/// What so many pieces of a series are to resolve.
fn accuracy(pieces: usize) -> f64 {
    match pieces {
        0..MANY_PIECES => ACCURACY,
        MANY_PIECES..MOST_PIECES => ENOUGH,
        _ => f64::INFINITY,
    }
}

/// `ln(x²/c²)` at full relative accuracy next to `c`.
fn logarithm(radius: f64, x: f64) -> f64 {
    if x > 2.0 * radius {
        2.0 * (x / radius).ln()
    } else {
        ((x - radius) / radius * ((x + radius) / radius)).ln_1p()
    }
}

/// Adds a knot, and others before it where it is far.
fn add_knot(knots: &mut Vec<f64>, knot: f64) {
    let left = knots[knots.len() - 1];
    let parts = ((knot - left) / LONGEST).ceil();
    let between = (1..parts as usize).map(|i| left + (knot - left) * i as f64 / parts);
    // Rows as close as numbers can be may have the same logarithm.
    if knot > left {
        knots.extend(between);
        knots.push(knot);
    }
}

/// `(e^y - 1)/y`.
fn shed(y: f64) -> f64 {
    if y > 1e-300 { y.exp_m1() / y } else { 1.0 }
}

/// Interpolation on Chebyshev points of [0, 1].
#[derive(Debug)]
struct Interpolation {
    points: [f64; INTERPOLATED],
    barycentric: [f64; INTERPOLATED],
    /// Integrals of the Lagrange polynomials.
    weights: [f64; INTERPOLATED],
}

impl Interpolation {
    fn new() -> Self {
        let angle = |j: usize| PI * (j as f64 + 0.5) / INTERPOLATED as f64;
        let points = std::array::from_fn(|j| (0.5 * angle(j)).sin().powi(2));
        let barycentric = std::array::from_fn(|j| angle(j).sin() * if j % 2 == 0 { 1.0 } else { -1.0 });
        // Fejér's first rule.
        let weight = |j: usize| {
            let terms = (1..=INTERPOLATED / 2).map(|m| {
                let m = m as f64;
                (2.0 * m * angle(j)).cos() / (4.0 * m * m - 1.0)
            });
            (1.0 - 2.0 * terms.sum::<f64>()) / INTERPOLATED as f64
        };
        Self { points, barycentric, weights: std::array::from_fn(weight) }
    }

    /// Adds `value` times the Lagrange polynomials at a place in [0, 1].
    fn add(&self, place: f64, value: f64, sum: &mut [f64; INTERPOLATED]) {
        let terms: [f64; INTERPOLATED] =
            std::array::from_fn(|j| self.barycentric[j] / (place - self.points[j]));
        let total: f64 = terms.iter().sum();
        if !total.is_finite() {
            let at = (0..INTERPOLATED).find(|&j| place == self.points[j]);
            sum[at.expect("only at a point is the term infinite")] += value;
            return;
        }
        for (sum, term) in sum.iter_mut().zip(&terms) {
            *sum += value * term / total;
        }
    }
}
