//! The forward transform of a measured profile by product integration.

use super::cubic::Cubic;
use crate::error::Result;
use crate::numerics::grid::lagrange;
use crate::numerics::quadrature::Rule;

/// Nodes for a kernel that is singular at least one width away: its error falls as 5.8^(-2n), and as 5.8^-n where it is interpolated.
const NODES: usize = 11;
const INTERPOLATED: usize = 20;

/// Pieces below which a block is integrated piece by piece.
const LEAF: usize = 8;

/// The integrals behind `g` and `g'` [S, Eq. (19)], in units of the last radius, with `μ = (1-k)/2`.
///
/// ```text
/// g(x)    = x^(2μ)   ∫_0^x f'(r)      (x² - r²)^(-μ) dr
/// g'(x)   = x^(2μ-1) ∫_0^x (r f'(r))' (x² - r²)^(-μ) dr
/// ```
///
/// Both densities are parabolas in a piece. The piece that ends at `x` carries the singularity in the weight of a Gauss-Jacobi rule, pieces
/// next to it are halved towards `x`, and those farther away are taken in blocks on which the kernel is interpolated, so that
/// `n` points cost `n ln n`.
pub(super) struct Transform {
    mu: f64,
    nu: f64,
    knots: Vec<f64>,
    densities: Vec<[[f64; 3]; 2]>,
    end_rule: Rule,
    rule: Rule,
    blocks: Vec<Block>,
}

/// Neighbouring pieces, `first..last`; the blocks are stored so that the halves of one stand before it.
struct Block {
    first: usize,
    last: usize,
    halves: Option<(usize, usize)>,
    points: [f64; INTERPOLATED],
    /// Integrals of the two densities times the Lagrange polynomials on the points.
    moments: [[f64; 2]; INTERPOLATED],
}

impl Transform {
    pub(super) fn new(curve: &Cubic, grading: f64) -> Result<Self> {
        let (mu, nu) = (0.5 * (1.0 - grading), 0.5 * (1.0 + grading));
        let count = curve.knots().len() - 1;
        let size = curve.knots()[count];
        let knots: Vec<f64> = curve.knots().iter().map(|r| r / size).collect();
        let density = |i: usize| {
            let ([_, slope, square, cube], left) = (curve.piece(i), knots[i]);
            let (linear, quadratic) = (2.0 * square * size, 3.0 * cube * size * size);
            let second = [slope + left * linear, 2.0 * (linear + left * quadratic), 3.0 * quadratic];
            [[slope, linear, quadratic], second]
        };
        let densities = (0..count).map(density).collect();
        let mut transform = Self {
            mu,
            nu,
            knots,
            densities,
            end_rule: Rule::jacobi(NODES + 1, -mu, 0.0)?,
            rule: Rule::legendre(NODES)?,
            blocks: Vec::new(),
        };
        transform.add_block(0, count);
        Ok(transform)
    }

    /// `g/R` and `g'` at the fraction `share` in (0, 1] of a piece, `R` being the last radius.
    pub(super) fn at(&self, piece: usize, share: f64) -> [f64; 2] {
        let left = self.knots[piece];
        let width = (self.knots[piece + 1] - left) * share;
        let x = left + width;
        // Of rows as close as numbers can be, nothing lies between: the end of the piece before is the singular one.
        if x <= left && piece > 0 {
            return self.at(piece - 1, 1.0);
        }
        let scale = width.powf(self.nu) / self.nu;
        let mut sum = [0.0; 2];
        for (node, weight) in self.end_rule.nodes.iter().zip(&self.end_rule.weights) {
            let t = width * node;
            self.add(piece, t, scale * weight * (x + left + t).powf(-self.mu), &mut sum);
        }
        if piece > 0 {
            self.add_blocks(self.blocks.len() - 1, piece, x, &mut sum);
        }
        let power = x.powf(2.0 * self.mu);
        [power * sum[0], power / x * sum[1]]
    }

    /// Adds the densities at the distance `t` from the left end of a piece.
    fn add(&self, piece: usize, t: f64, weight: f64, sum: &mut [f64; 2]) {
        for (total, [constant, linear, quadratic]) in sum.iter_mut().zip(self.densities[piece]) {
            *total += weight * (constant + t * (linear + t * quadratic));
        }
    }

    fn kernel(&self, x: f64, r: f64) -> f64 {
        ((x - r) * (x + r)).powf(-self.mu)
    }

    /// Adds the pieces of a block that lie before the piece `end` in which `x` is.
    fn add_blocks(&self, index: usize, end: usize, x: f64, sum: &mut [f64; 2]) {
        let block = &self.blocks[index];
        let (left, right) = (self.knots[block.first], self.knots[block.last]);
        if block.first >= end {
            return;
        }
        if block.last <= end && x - right >= right - left {
            for (point, moments) in block.points.iter().zip(&block.moments) {
                let kernel = self.kernel(x, *point);
                sum[0] += kernel * moments[0];
                sum[1] += kernel * moments[1];
            }
        } else if let Some((lower, upper)) = block.halves {
            self.add_blocks(lower, end, x, sum);
            self.add_blocks(upper, end, x, sum);
        } else {
            (block.first..block.last.min(end)).for_each(|piece| self.add_piece(piece, x, sum));
        }
    }

    /// Adds a whole piece, in panels no wider than their distance from `x`.
    fn add_piece(&self, piece: usize, x: f64, sum: &mut [f64; 2]) {
        let left = self.knots[piece];
        let mut high = self.knots[piece + 1];
        while high > left {
            let low = left.max(high - (x - high));
            let width = high - low;
            if width <= 0.0 {
                break;
            }
            for (node, weight) in self.rule.nodes.iter().zip(&self.rule.weights) {
                let r = low + width * node;
                self.add(piece, r - left, width * weight * self.kernel(x, r), sum);
            }
            high = low;
        }
    }

    /// Adds the blocks of the pieces `first..last` and returns the index of the largest.
    fn add_block(&mut self, first: usize, last: usize) -> usize {
        let (left, right) = (self.knots[first], self.knots[last]);
        let angle = |j: usize| std::f64::consts::PI * (j as f64 + 0.5) / INTERPOLATED as f64;
        let points = std::array::from_fn(|j| left + (right - left) * (0.5 * angle(j)).sin().powi(2));
        let mut block = Block { first, last, halves: None, points, moments: [[0.0; 2]; INTERPOLATED] };
        let mut polynomials = [0.0; INTERPOLATED];
        if last - first <= LEAF {
            for piece in first..last {
                let (start, width) = (self.knots[piece], self.knots[piece + 1] - self.knots[piece]);
                for (node, weight) in self.rule.nodes.iter().zip(&self.rule.weights) {
                    lagrange(&points, start + width * node, &mut polynomials);
                    for (moments, polynomial) in block.moments.iter_mut().zip(&polynomials) {
                        self.add(piece, width * node, width * weight * polynomial, moments);
                    }
                }
            }
        } else {
            let middle = first + (last - first) / 2;
            let halves = (self.add_block(first, middle), self.add_block(middle, last));
            for half in [&self.blocks[halves.0], &self.blocks[halves.1]] {
                for (point, part) in half.points.iter().zip(&half.moments) {
                    lagrange(&points, *point, &mut polynomials);
                    for (moments, polynomial) in block.moments.iter_mut().zip(&polynomials) {
                        moments[0] += polynomial * part[0];
                        moments[1] += polynomial * part[1];
                    }
                }
            }
            block.halves = Some(halves);
        }
        self.blocks.push(block);
        self.blocks.len() - 1
    }
}
