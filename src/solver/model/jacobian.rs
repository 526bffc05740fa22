//! Newton's matrix of an implicit stage on hierarchical operators, as one whose blocks off the diagonal are of low rank.
//!
//! ```text
//! J  =  (I - θ ξ ∂/∂ξ) diag(a) F diag(x^(k-1))  +  b P
//! ```
//!
//! `F` and `P` are compressed once for a mesh ([`Compressed`]); what changes from step to step are factors of rows and columns, and stencils
//! that reach a few springs across the middle of a block.

use std::ops::Range;

use faer::traits::RealField;
use faer::traits::math_utils::from_f64;
use faer::{Mat, MatMut};
use rayon::prelude::*;

use super::cycle::PlainSlopes;
use super::derivatives::Stencil;
use super::{Fields, Model};
use crate::numerics::abel::{AbelOperators, Block, Compressed};
use crate::numerics::grid::MOST_POINTS;
use crate::numerics::linear::{HodlrFactors, LeafColumns, LowRank, OffDiagonal, Split};

/// Columns of a second half that stencils of the first reach through what `F` has above its diagonal.
const CORNER: usize = Block::AHEAD + 2;

/// What makes Newton's matrix of the transforms.
#[derive(Debug)]
pub(super) struct Jacobian<'a> {
    pub abel: &'a AbelOperators,
    /// Of `ξ ∂/∂ξ`.
    pub stencils: &'a [Stencil],
    /// `a`, shape `(springs,)`; at the edge there is neither `θ` nor `b`.
    pub row_factor: &'a [f64],
    /// `x^(k-1)`, shape `(springs - 1,)`.
    pub column_factor: &'a [f64],
    /// `θ`.
    pub along: f64,
    /// `b`.
    pub pressure_factor: f64,
    /// The element of the edge at the edge.
    pub corner: f64,
}

/// Largest error, relative to a diagonal of one, of what stands next to the middle of a split in factored form.
const NEAR_DIAGONAL: f64 = 1e-3;

/// Grading below which factors are in double precision. In single precision Newton's method found no step with 3,000 springs at k = -0.9 and with
/// 60,000 at -0.5, and wasted two steps of three with 100,000 at -0.4; at -0.25 and above nothing was amiss with 300,000.
const SOFTEST_SINGLE: f64 = -0.25;

/// Factors of a matrix scaled to a diagonal of one.
#[derive(Debug)]
pub(super) struct ScaledFactors {
    factors: AnyPrecision,
    /// One over the root of the diagonal.
    scale: Vec<f64>,
}

/// Factors in single or double precision.
#[derive(Debug)]
enum AnyPrecision {
    Single(HodlrFactors<f32>),
    Double(HodlrFactors<f64>),
}

impl ScaledFactors {
    /// Replaces the right-hand side by the solution, nearly.
    pub fn solve(&self, rhs: &mut [f64]) {
        for (value, scale) in rhs.iter_mut().zip(&self.scale) {
            *value *= scale;
        }
        match &self.factors {
            AnyPrecision::Single(factors) => {
                let largest = rhs.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
                if largest > 0.0 {
                    let mut single: Vec<f32> = rhs.iter().map(|value| (value / largest) as f32).collect();
                    factors.solve(&mut single);
                    rhs.iter_mut().zip(single).for_each(|(to, from)| *to = largest * f64::from(from));
                }
            }
            AnyPrecision::Double(factors) => factors.solve(rhs),
        }
        for (value, scale) in rhs.iter_mut().zip(&self.scale) {
            *value *= scale;
        }
    }

    fn bytes(&self) -> usize {
        let factors = match &self.factors {
            AnyPrecision::Single(factors) => factors.bytes(),
            AnyPrecision::Double(factors) => factors.bytes(),
        };
        factors + 8 * self.scale.len()
    }
}

/// Factors of a matrix that has a full last column beside blocks of low rank.
#[derive(Debug)]
pub struct StageFactors {
    factors: ScaledFactors,
    /// Solution for the last column without its last element.
    edge: Vec<f64>,
}

impl StageFactors {
    /// Bytes held, about.
    pub fn bytes(&self) -> usize {
        self.factors.bytes() + 8 * self.edge.len()
    }

    /// Replaces the right-hand side by the solution, nearly.
    pub fn solve(&self, rhs: &mut [f64]) {
        self.factors.solve(rhs);
        let last = rhs.len() - 1;
        let part = rhs[last] / (1.0 + self.edge[last]);
        for (value, edge) in rhs.iter_mut().zip(&self.edge) {
            *value -= part * edge;
        }
    }
}

impl Model {
    /// Factors of Newton's matrix of a stage, where the operators are hierarchical.
    ///
    /// # Arguments
    /// * `theta` -- `1 - Ẑ/Z`
    /// * `growth` -- derivatives of the growth times those by it
    /// * `by_edge` -- derivatives of the rest by the edge, 1/m², shape `(springs,)`
    /// * `memory` -- of factors that are not needed any more
    pub fn stage_factors(
        &self,
        fields: &Fields,
        theta: f64,
        growth: PlainSlopes,
        by_slip_area: &[f64],
        memory: Option<StageFactors>,
    ) -> Option<StageFactors> {
        let compressed = self.annulus().operators.compressed()?;
        let scale = fields.slip_area.powf(self.mu());
        let row_factor: Vec<f64> = fields.slip_depth.iter().map(|slip| -scale / slip).collect();
        let inner = self.springs() - 1;
        let jacobian = Jacobian {
            abel: &self.annulus().operators.abel,
            stencils: &self.annulus().operators.derivative,
            row_factor: &row_factor,
            column_factor: &fields.density_factor[..inner],
            along: theta,
            pressure_factor: growth.by_pressure,
            corner: by_slip_area[inner],
        };
        let factors = jacobian.factors(compressed, memory.map(|it| it.factors));
        let mut edge: Vec<f64> = by_slip_area.iter().zip(&growth.by_slip_area).map(|(a, b)| a + b).collect();
        edge[inner] = 0.0;
        factors.solve(&mut edge);
        Some(StageFactors { factors, edge })
    }
}

/// `(I - θ ξ ∂/∂ξ) diag(a)` diagonal by diagonal: from [`Block::BACK`] below to what the stencils next to the edge of stick reach ahead.
struct Diagonals(Vec<Vec<f64>>);

impl Diagonals {
    const COUNT: usize = Block::BACK + MOST_POINTS;

    fn new(jacobian: &Jacobian<'_>) -> Self {
        let count = jacobian.stencils.len();
        let mut diagonals = vec![vec![0.0; count]; Self::COUNT];
        for i in 0..count {
            for (k, weight) in jacobian.row(i) {
                diagonals[k + Block::BACK - i][i] += weight * jacobian.row_factor[k];
            }
        }
        Self(diagonals)
    }

    /// Adds the product with what stands in the rows `have` to that of the rows `rows`.
    fn add(&self, rows: Range<usize>, have: Range<usize>, from: &[f64], to: &mut [f64]) {
        for (offset, diagonal) in self.0.iter().enumerate() {
            // Row i takes from row i + offset - BACK.
            let begin = rows.start.max((have.start + Block::BACK).saturating_sub(offset));
            let mut end = rows.end.min((have.end + Block::BACK).saturating_sub(offset));
            if offset > Block::BACK + Block::AHEAD {
                // Only the first springs reach so far.
                end = end.min(MOST_POINTS);
            }
            if begin >= end {
                continue;
            }
            let from = &from[begin + offset - Block::BACK - have.start..];
            let to = &mut to[begin - rows.start..end - rows.start];
            for ((to, weight), from) in to.iter_mut().zip(&diagonal[begin..end]).zip(from) {
                *to += weight * from;
            }
        }
    }
}

impl Jacobian<'_> {
    /// The factors; `memory` is that of others that are not needed any more.
    pub(super) fn factors(&self, compressed: &Compressed, memory: Option<ScaledFactors>) -> ScaledFactors {
        let memory = memory.map(|it| it.factors);
        if self.abel.grading() < SOFTEST_SINGLE {
            let memory =
                memory.and_then(|it| if let AnyPrecision::Double(it) = it { Some(it) } else { None });
            let (factors, scale) = self.factorised(compressed, memory);
            ScaledFactors { factors: AnyPrecision::Double(factors), scale }
        } else {
            let memory =
                memory.and_then(|it| if let AnyPrecision::Single(it) = it { Some(it) } else { None });
            let (factors, scale) = self.factorised(compressed, memory);
            ScaledFactors { factors: AnyPrecision::Single(factors), scale }
        }
    }

    /// Factors of the matrix scaled to a diagonal of one, and the scale.
    fn factorised<T: RealField + Copy>(
        &self,
        compressed: &Compressed,
        memory: Option<HodlrFactors<T>>,
    ) -> (HodlrFactors<T>, Vec<f64>) {
        let halves = compressed.halves();
        let diagonals = Diagonals::new(self);
        let leaves = halves.leaves.par_iter().map(|leaf| {
            let matrix = self.leaf(&diagonals, leaf.clone());
            let root = |i: usize| matrix[(i, i)].abs().sqrt().recip();
            let scale: Vec<f64> = (0..leaf.len()).map(root).collect();
            let scaled = |i: usize, j: usize| from_f64(scale[i] * matrix[(i, j)] * scale[j]);
            (Mat::<T>::from_fn(leaf.len(), leaf.len(), scaled), scale)
        });
        let (leaves, scale): (Vec<_>, Vec<_>) = leaves.unzip();
        let rows = Rows { jacobian: self, diagonals, scale: scale.concat() };
        let splits = halves.splits.par_iter().zip(compressed.blocks());
        let near: Vec<NearDiagonal<'_>> = splits.map(|(split, block)| rows.near(split, block)).collect();
        let terms = near.iter().map(NearDiagonal::terms).collect();
        let memory = memory.map(HodlrFactors::into_blocks);
        let blocks = OffDiagonal::new(halves, terms, memory, |leaf, sides| {
            let block = &near[sides.split];
            if sides.is_first {
                rows.fill_first(leaf, block, sides)
            } else {
                rows.fill_second(leaf, block, sides)
            }
        });
        (HodlrFactors::new(halves, leaves, blocks), rows.scale)
    }

    fn column_factor(&self, j: usize) -> f64 {
        self.column_factor.get(j).copied().unwrap_or(0.0)
    }

    /// A row of `I - θ ξ ∂/∂ξ`: columns and what stands there.
    fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        let last = i + 1 == self.stencils.len();
        let along = if last { 0.0 } else { -self.along };
        let (first, weights) = self.stencils[i].parts();
        let along = weights.iter().enumerate().map(move |(k, weight)| (first + k, along * weight));
        std::iter::once((i, 1.0)).chain(along)
    }

    fn leaf(&self, diagonals: &Diagonals, leaf: Range<usize>) -> Mat<f64> {
        let n = self.abel.len();
        let (first, size) = (leaf.start, leaf.len());
        let reach = first.saturating_sub(Block::BACK)..(leaf.end + Block::AHEAD).min(n);
        let [profile, pressure] = self.abel.diagonal_blocks(reach.clone(), leaf.clone());
        let mut matrix = Mat::zeros(size, size);
        let edge = n - 1;
        for j in 0..size {
            let to = matrix.col_as_slice_mut(j);
            diagonals.add(leaf.clone(), reach.clone(), profile.col_as_slice(j), to);
            let factor = self.column_factor(first + j);
            for (i, (value, pressure)) in to.iter_mut().zip(pressure.col_as_slice(j)).enumerate() {
                *value *= factor;
                if (first + i).max(first + j) < edge {
                    *value += self.pressure_factor * pressure;
                }
            }
        }
        if leaf.end == n {
            matrix[(size - 1, size - 1)] = self.corner;
        }
        matrix
    }
}

/// What the blocks off the diagonal are made of.
struct Rows<'a> {
    jacobian: &'a Jacobian<'a>,
    diagonals: Diagonals,
    /// One over the root of the diagonal.
    scale: Vec<f64>,
}

/// The blocks of a split, with what stands next to its middle beside those of the transforms.
struct NearDiagonal<'a> {
    split: &'a Split,
    block: &'a Block,
    /// Terms of `P` above the diagonal.
    pressed: usize,
    /// Rows of the first half that the stencils of the second reach back to.
    across: usize,
    /// `P` below the diagonal.
    below: LowRank,
    /// `F` above the diagonal, with the stencils.
    above: LowRank,
    /// First row of the latter.
    corner: usize,
}

impl NearDiagonal<'_> {
    /// Of the blocks above and below the diagonal.
    fn terms(&self) -> [usize; 2] {
        let carried = self.block.profile.terms() + self.across;
        [self.pressed + self.above.terms(), carried + self.below.terms()]
    }
}

impl Rows<'_> {
    fn near<'a>(&self, split: &'a Split, block: &'a Block) -> NearDiagonal<'a> {
        let Split { start, middle, end, .. } = *split;
        let across = if self.jacobian.along != 0.0 { Block::BACK } else { 0 };
        let pressed = if self.jacobian.pressure_factor == 0.0 { 0 } else { block.pressure.terms() };
        let corner = middle.saturating_sub(CORNER).max(start);
        let below = self.beside(middle..(middle + Block::BACK).min(end), middle - Block::BACK..middle);
        let above = self.beside(corner..middle, middle..(middle + CORNER).min(end));
        NearDiagonal { split, block, pressed, across, below, above, corner }
    }

    /// `U₁` and `V₁`.
    fn fill_first<T: RealField + Copy>(
        &self,
        leaf: Range<usize>,
        near: &NearDiagonal<'_>,
        mut sides: LeafColumns<'_, T>,
    ) {
        let (Split { start, middle, .. }, block) = (*near.split, near.block);
        let scale = &self.scale[leaf.clone()];
        let within = leaf.start - start..leaf.end - start;
        for (term, rows) in block.pressure.rows.iter().enumerate().take(near.pressed) {
            let pressed = scale.iter().zip(&rows[within.clone()]);
            let factor = self.jacobian.pressure_factor;
            fill(&mut sides.left, term, pressed.map(|(scale, row)| factor * scale * row));
        }
        put(&near.above.rows, near.corner, &leaf, &mut sides.left, near.pressed);
        // The last rows of the first half are as large as its diagonal.
        let last_rows = block.last_rows.iter().enumerate().take(near.across).map(|(back, row)| {
            let i = middle - 1 - back;
            (self.scale[i] * self.jacobian.row_factor[i], row)
        });
        let vectors = block.profile.columns.iter().map(|column| (1.0, column)).chain(last_rows);
        let factors: Vec<f64> =
            leaf.clone().zip(scale).map(|(j, scale)| self.jacobian.column_factor(j) * scale).collect();
        for (term, (times, vector)) in vectors.enumerate() {
            let carried = factors.iter().zip(&vector[within.clone()]);
            fill(&mut sides.right, term, carried.map(|(factor, value)| times * factor * value));
        }
        let first = block.profile.terms() + near.across;
        put(&near.below.columns, middle - Block::BACK, &leaf, &mut sides.right, first);
    }

    /// `U₂` and `V₂`.
    fn fill_second<T: RealField + Copy>(
        &self,
        leaf: Range<usize>,
        near: &NearDiagonal<'_>,
        mut sides: LeafColumns<'_, T>,
    ) {
        let (Split { middle, end, .. }, block) = (*near.split, near.block);
        let scale = &self.scale[leaf.clone()];
        let within = leaf.start - middle..leaf.end - middle;
        let mut product = vec![0.0; leaf.len()];
        for (term, row) in block.profile.rows.iter().enumerate() {
            product.fill(0.0);
            self.diagonals.add(leaf.clone(), middle..middle + row.len(), row, &mut product);
            fill(&mut sides.left, term, product.iter().zip(scale).map(|(value, scale)| value * scale));
        }
        let terms = block.profile.terms();
        for i in leaf.start..(middle + near.across).min(end).min(leaf.end) {
            for (k, weight) in self.jacobian.row(i).filter(|(k, _)| *k < middle) {
                let value = weight * self.scale[i] / self.scale[k];
                sides.left[(i - leaf.start, terms + middle - 1 - k)] += from_f64::<T>(value);
            }
        }
        put(&near.below.rows, middle, &leaf, &mut sides.left, terms + near.across);
        for (term, columns) in block.pressure.columns.iter().enumerate().take(near.pressed) {
            let pressed = scale.iter().zip(&columns[within.clone()]);
            fill(&mut sides.right, term, pressed.map(|(scale, column)| scale * column));
        }
        put(&near.above.columns, middle, &leaf, &mut sides.right, near.pressed);
    }

    /// What stands next to the middle of a split beside the blocks: `P` below the diagonal, and above it `F` with the stencils.
    fn beside(&self, rows: Range<usize>, columns: Range<usize>) -> LowRank {
        let below = rows.start > columns.start;
        let (jacobian, abel) = (self.jacobian, self.jacobian.abel);
        let entry = |i: usize, j: usize| {
            let value = if below {
                let edge = abel.len() - 1;
                if i < edge { jacobian.pressure_factor * abel.pressure_weight(i, j) } else { 0.0 }
            } else {
                let carried = |(k, weight): (usize, f64)| {
                    // Above the diagonal a row of F reaches no farther.
                    if j < k + Block::AHEAD {
                        weight * jacobian.row_factor[k] * abel.profile_weight(k, j)
                    } else {
                        0.0
                    }
                };
                jacobian.row(i).map(carried).sum::<f64>() * jacobian.column_factor(j)
            };
            self.scale[i] * value * self.scale[j]
        };
        let first = if below { rows.start } else { rows.end - 1 };
        LowRank::new(rows.clone(), columns, first, entry, NEAR_DIAGONAL)
    }
}

/// Sets a column.
fn fill<T: RealField + Copy>(to: &mut MatMut<'_, T>, column: usize, values: impl Iterator<Item = f64>) {
    for (to, value) in to.as_mut().col_mut(column).iter_mut().zip(values) {
        *to = from_f64(value);
    }
}

/// Puts vectors that begin at a row into columns from `column` on, as far as they lie in a leaf.
fn put<T: RealField + Copy>(
    vectors: &[Vec<f64>],
    begin: usize,
    leaf: &Range<usize>,
    to: &mut MatMut<'_, T>,
    column: usize,
) {
    for (term, vector) in vectors.iter().enumerate() {
        for (i, value) in (begin..).zip(vector).filter(|(i, _)| leaf.contains(i)) {
            to[(i - leaf.start, column + term)] = from_f64(*value);
        }
    }
}
