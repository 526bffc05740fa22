//! Newton's matrix of an implicit stage on hierarchical operators, as one whose blocks off the diagonal are of low rank.
//!
//! ```text
//! J  =  (I - θ ξ ∂/∂ξ) diag(a) F diag(x^(k-1))  +  b P
//! ```
//!
//! `F` and `P` are compressed once for a mesh ([`Compressed`]); what changes from step to step are factors of rows and columns, and stencils
//! that reach a few springs across the middle of a block.

use std::ops::Range;

use faer::Mat;
use rayon::prelude::*;

use super::cycle::PlainSlopes;
use super::derivatives::Stencil;
use super::operators::Operators;
use super::{Fields, Model};
use crate::abel::{Block, Compressed};
use crate::grid::MOST_POINTS;
use crate::linear::{HodlrFactors, LowRank, OffDiagonal, Split};

/// Columns of a second half that stencils of the first reach through what `F` has above its diagonal.
const CORNER: usize = Block::AHEAD + 2;

/// What makes Newton's matrix of the transforms.
#[derive(Debug)]
pub(super) struct Jacobian<'a> {
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

/// What is left out beside the blocks where the diagonal is one.
const BESIDE: f64 = 1e-3;

/// Factors of a matrix scaled to a diagonal of one.
#[derive(Debug)]
pub(super) struct ScaledFactors {
    factors: HodlrFactors,
    /// One over the root of the diagonal.
    scale: Vec<f64>,
}

impl ScaledFactors {
    /// Replaces the right-hand side by the solution, nearly.
    pub fn solve(&self, rhs: &mut [f64]) {
        let scaled = rhs.iter().zip(&self.scale).map(|(value, scale)| value * scale);
        let largest = scaled.clone().fold(0.0, |most: f64, value| most.max(value.abs()));
        if largest == 0.0 {
            return;
        }
        let mut single: Vec<f32> = scaled.map(|value| (value / largest) as f32).collect();
        self.factors.solve(&mut single);
        for ((value, scale), single) in rhs.iter_mut().zip(&self.scale).zip(single) {
            *value = largest * scale * f64::from(single);
        }
    }

    fn bytes(&self) -> usize {
        self.factors.bytes() + 8 * self.scale.len()
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
    pub fn stage_factors(
        &self,
        fields: &Fields,
        theta: f64,
        growth: PlainSlopes,
        by_edge: &[f64],
    ) -> Option<StageFactors> {
        let compressed = self.operators.compressed()?;
        let scale = fields.edge.powf(self.mu());
        let row_factor: Vec<f64> = fields.slip_depth.iter().map(|slip| -scale / slip).collect();
        let inner = self.springs() - 1;
        let jacobian = Jacobian {
            row_factor: &row_factor,
            column_factor: &fields.density_factor[..inner],
            along: theta,
            pressure_factor: growth.by_pressure,
            corner: by_edge[inner],
        };
        let factors = jacobian.factors(&self.operators, compressed);
        let mut edge: Vec<f64> = by_edge.iter().zip(&growth.by_edge).map(|(a, b)| a + b).collect();
        edge[inner] = 0.0;
        factors.solve(&mut edge);
        Some(StageFactors { factors, edge })
    }
}

/// `(I - θ ξ ∂/∂ξ) diag(a)` diagonal by diagonal: from [`Block::BACK`] below to what the stencils next to the edge of stick reach ahead.
struct Diagonals(Vec<Vec<f64>>);

impl Diagonals {
    const COUNT: usize = Block::BACK + MOST_POINTS;

    fn new(jacobian: &Jacobian<'_>, stencils: &[Stencil]) -> Self {
        let mut diagonals = vec![vec![0.0; stencils.len()]; Self::COUNT];
        for i in 0..stencils.len() {
            for (k, weight) in jacobian.row(stencils, i) {
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
    pub(super) fn factors(&self, operators: &Operators, compressed: &Compressed) -> ScaledFactors {
        let halves = compressed.halves();
        let diagonals = Diagonals::new(self, &operators.derivative);
        let leaves: Vec<Mat<f64>> =
            halves.leaves.par_iter().map(|leaf| self.leaf(operators, &diagonals, leaf.clone())).collect();
        let diagonal = leaves.iter().flat_map(|leaf| (0..leaf.nrows()).map(|i| leaf[(i, i)]));
        let scale: Vec<f64> = diagonal.map(|value| value.abs().sqrt().recip()).collect();
        let own = halves.leaves.par_iter().zip(&leaves);
        let leaves = own.map(|(range, leaf)| {
            let scale = &scale[range.clone()];
            Mat::from_fn(leaf.nrows(), leaf.ncols(), |i, j| (scale[i] * leaf[(i, j)] * scale[j]) as f32)
        });
        let leaves = leaves.collect();
        let blocks = halves.splits.par_iter().zip(compressed.blocks());
        let off_diagonal = blocks
            .map(|(split, block)| self.off_diagonal(operators, &diagonals, split, block, &scale))
            .collect();
        ScaledFactors { factors: HodlrFactors::new(halves, leaves, off_diagonal), scale }
    }

    fn column_factor(&self, j: usize) -> f64 {
        self.column_factor.get(j).copied().unwrap_or(0.0)
    }

    /// A row of `I - θ ξ ∂/∂ξ`: columns and what stands there.
    fn row<'a>(&'a self, stencils: &'a [Stencil], i: usize) -> impl Iterator<Item = (usize, f64)> + 'a {
        let last = i + 1 == stencils.len();
        let along = if last { 0.0 } else { -self.along };
        let (first, weights) = stencils[i].parts();
        let along = weights.iter().enumerate().map(move |(k, weight)| (first + k, along * weight));
        std::iter::once((i, 1.0)).chain(along)
    }

    fn leaf(&self, operators: &Operators, diagonals: &Diagonals, leaf: Range<usize>) -> Mat<f64> {
        let n = operators.abel.len();
        let (first, size) = (leaf.start, leaf.len());
        let reach = first.saturating_sub(Block::BACK)..(leaf.end + Block::AHEAD).min(n);
        let [profile, pressure] = operators.abel.diagonal_blocks(reach.clone(), leaf.clone());
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

    fn off_diagonal(
        &self,
        operators: &Operators,
        diagonals: &Diagonals,
        split: &Split,
        block: &Block,
        scale: &[f64],
    ) -> OffDiagonal {
        let Split { start, middle, end, .. } = *split;
        let stencils = &operators.derivative;
        // From the first half to the second; next to the middle, pressures at the first springs by the last compressions.
        let beside = self.beside(
            operators,
            middle..(middle + Block::BACK).min(end),
            middle - Block::BACK..middle,
            scale,
        );
        let terms = block.profile.terms();
        let across = if self.along != 0.0 { Block::BACK } else { 0 };
        let mut left = Mat::zeros(end - middle, terms + across + beside.terms());
        let mut right = Mat::zeros(middle - start, terms + across + beside.terms());
        let mut product = vec![0.0; end - middle];
        for (term, row) in block.profile.rows.iter().enumerate() {
            product.fill(0.0);
            diagonals.add(middle..end, middle..middle + row.len(), row, &mut product);
            let to = left.col_as_slice_mut(term).iter_mut().zip(&product).zip(&scale[middle..end]);
            to.for_each(|((to, value), scale)| *to = (scale * value) as f32);
        }
        // The last rows of the first half are as large as its diagonal.
        for i in middle..(middle + across).min(end) {
            for (k, weight) in self.row(stencils, i).filter(|(k, _)| *k < middle) {
                left[(i - middle, terms + middle - 1 - k)] += (weight * scale[i] / scale[k]) as f32;
            }
        }
        let factors: Vec<f64> = (start..middle).map(|j| self.column_factor(j) * scale[j]).collect();
        let last_rows = block.last_rows.iter().enumerate().take(across);
        let last_rows =
            last_rows.map(|(back, row)| (scale[middle - 1 - back] * self.row_factor[middle - 1 - back], row));
        let vectors = block.profile.columns.iter().map(|column| (1.0, column)).chain(last_rows);
        for (term, (times, vector)) in vectors.enumerate() {
            fill(right.col_as_slice_mut(term), times, &factors, vector);
        }
        put(&beside, [&mut left, &mut right], [0, middle - Block::BACK - start], terms + across);
        let lower = [left, right];
        // From the second half to the first; next to the middle, what F has above its diagonal and stencils that reach ahead.
        let (corner_rows, corner_columns) =
            (middle.saturating_sub(CORNER).max(start)..middle, middle..(middle + CORNER).min(end));
        let beside = self.beside(operators, corner_rows.clone(), corner_columns, scale);
        let terms = if self.pressure_factor == 0.0 { 0 } else { block.pressure.terms() };
        let mut left = Mat::zeros(middle - start, terms + beside.terms());
        let mut right = Mat::zeros(end - middle, terms + beside.terms());
        for term in 0..terms {
            let to = left.col_as_slice_mut(term);
            fill(to, self.pressure_factor, &scale[start..middle], &block.pressure.rows[term]);
            fill(right.col_as_slice_mut(term), 1.0, &scale[middle..end], &block.pressure.columns[term]);
        }
        put(&beside, [&mut left, &mut right], [corner_rows.start - start, 0], terms);
        OffDiagonal { upper: [left, right], lower }
    }

    /// What stands next to the middle of a split beside the blocks: `P` below the diagonal, and above it `F` with the stencils.
    fn beside(
        &self,
        operators: &Operators,
        rows: Range<usize>,
        columns: Range<usize>,
        scale: &[f64],
    ) -> LowRank {
        let below = rows.start > columns.start;
        let entry = |i: usize, j: usize| {
            let abel = &operators.abel;
            let value = if below {
                let edge = abel.len() - 1;
                if i < edge { self.pressure_factor * abel.pressure_weight(i, j) } else { 0.0 }
            } else {
                let carried = |(k, weight): (usize, f64)| {
                    // Above the diagonal a row of F reaches no farther.
                    if j < k + Block::AHEAD {
                        weight * self.row_factor[k] * abel.profile_weight(k, j)
                    } else {
                        0.0
                    }
                };
                self.row(&operators.derivative, i).map(carried).sum::<f64>() * self.column_factor(j)
            };
            scale[i] * value * scale[j]
        };
        let first = if below { rows.start } else { rows.end - 1 };
        LowRank::new(rows.clone(), columns, first, entry, BESIDE)
    }
}

/// Sets values to products of a factor with one of each of two vectors.
fn fill(to: &mut [f32], times: f64, factors: &[f64], values: &[f64]) {
    for ((to, factor), value) in to.iter_mut().zip(factors).zip(values) {
        *to = (times * factor * value) as f32;
    }
}

/// Puts a block of low rank into the last columns, from `first` on, of what blocks are made of.
fn put(block: &LowRank, to: [&mut Mat<f32>; 2], rows: [usize; 2], first: usize) {
    for ((to, begin), vectors) in to.into_iter().zip(rows).zip([&block.rows, &block.columns]) {
        for (term, vector) in vectors.iter().enumerate() {
            for (i, value) in vector.iter().enumerate() {
                to[(begin + i, first + term)] = *value as f32;
            }
        }
    }
}
