//! Factors of a matrix whose blocks off the diagonal are of low rank.
//!
//! ```text
//! A = | A₁      U₁ V₂ᵀ |     = | A₁    | ( I + |  0     Y₁ V₂ᵀ | ),     Y_i = A_i⁻¹ U_i
//!     | U₂ V₁ᵀ  A₂     |       |    A₂ |       | Y₂ V₁ᵀ   0    |
//! ```
//!
//! The halves are of the same kind down to dense leaves, so that factors cost `O(n log² n)` and solutions `O(n log n)` operations (HODLR:
//! Ambikasaran & Darve, J. Sci. Comput. 57:477, 2013). In single precision, where that does, they take half the time and memory.

use std::ops::Range;

use faer::traits::RealField;
use faer::traits::math_utils::{one, zero};
use faer::{Mat, MatMut, MatRef};
use rayon::prelude::*;

use super::{Factors, add_product, product};

/// The halves of a matrix in between its leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Split {
    /// Depth below the whole matrix.
    pub level: usize,
    /// First row of the first half.
    pub start: usize,
    /// First row of the second half.
    pub middle: usize,
    /// End of the second half.
    pub end: usize,
}

/// Where a matrix is halved, down to leaves.
#[derive(Debug, Clone)]
pub struct Halves {
    /// Each before the halves of its parts.
    pub splits: Vec<Split>,
    /// From the first row on; all but the last have the same number of rows.
    pub leaves: Vec<Range<usize>>,
    /// For each leaf the splits that it is in, from the whole matrix down.
    above: Vec<Vec<usize>>,
}

impl Halves {
    /// Halves `n` rows at multiples of `leaf` until parts are no larger.
    pub fn new(n: usize, leaf: usize) -> Self {
        let mut halves = Self { splits: Vec::new(), leaves: Vec::new(), above: Vec::new() };
        halves.divide(0..n, leaf, &mut Vec::new());
        halves
    }

    fn divide(&mut self, rows: Range<usize>, leaf: usize, above: &mut Vec<usize>) {
        let leaves = rows.len().div_ceil(leaf);
        if leaves <= 1 {
            self.leaves.push(rows);
            self.above.push(above.clone());
            return;
        }
        let (start, end) = (rows.start, rows.end);
        let middle = start + leaves / 2 * leaf;
        above.push(self.splits.len());
        self.splits.push(Split { level: above.len() - 1, start, middle, end });
        self.divide(start..middle, leaf, above);
        self.divide(middle..end, leaf, above);
        above.pop();
    }
}

/// The blocks off the diagonal: `U` and `V` of all splits, columns a term each.
///
/// Splits of one level have the same columns. In the rows of its first half are `U₁` and `V₁`, in those of its second `U₂` and `V₂`.
#[derive(Debug, Clone)]
pub struct OffDiagonal<T> {
    rows: usize,
    /// For each split the terms of `U₁ V₂ᵀ` and of `U₂ V₁ᵀ`.
    terms: Vec<[usize; 2]>,
    /// Where the columns of each level begin, and their number.
    columns: Vec<usize>,
    left: Vec<T>,
    right: Vec<T>,
}

/// What a leaf has of `U` and `V` of a split that it is in.
#[derive(Debug)]
pub struct LeafColumns<'a, T> {
    /// The split.
    pub split: usize,
    /// Whether the leaf is in its first half.
    pub is_first: bool,
    /// `U`, shape `(rows, terms)`, zero at first.
    pub left: MatMut<'a, T>,
    /// `V`, likewise.
    pub right: MatMut<'a, T>,
}

impl<T: RealField + Copy> OffDiagonal<T> {
    /// Makes blocks, leaf by leaf.
    ///
    /// # Arguments
    /// * `terms` -- for each of [`Halves::splits`] the terms of `U₁ V₂ᵀ` and of `U₂ V₁ᵀ`
    /// * `memory` -- of blocks that are not needed any more, if there are some: new pages take as long as all of the rest
    /// * `fill` -- is called for every leaf with each of the splits that it is in
    pub fn new(
        halves: &Halves,
        terms: Vec<[usize; 2]>,
        memory: Option<Self>,
        fill: impl Fn(Range<usize>, LeafColumns<'_, T>) + Sync,
    ) -> Self {
        let levels = halves.above.iter().map(Vec::len).max().unwrap_or(0);
        let mut columns = vec![0; levels + 1];
        for (split, terms) in halves.splits.iter().zip(&terms) {
            let width = &mut columns[split.level + 1];
            *width = terms[0].max(terms[1]).max(*width);
        }
        for level in 0..levels {
            columns[level + 1] += columns[level];
        }
        let n = halves.leaves.last().map_or(0, |leaf| leaf.end);
        let [left, right] =
            memory.map_or_else(Default::default, |it| [it.left, it.right]).map(|mut values| {
                values.resize(n * columns[levels], zero::<T>());
                values
            });
        let mut blocks = Self { rows: n, terms, left, right, columns };
        blocks.fill(halves, fill);
        blocks
    }

    fn fill(&mut self, halves: &Halves, fill: impl Fn(Range<usize>, LeafColumns<'_, T>) + Sync) {
        let (n, width) = self.shape();
        let (terms, columns) = (&self.terms, &self.columns);
        let size = halves.leaves.first().map_or(1, Range::len);
        let left = MatMut::from_column_major_slice_mut(&mut self.left, n, width).par_row_chunks_mut(size);
        let right = MatMut::from_column_major_slice_mut(&mut self.right, n, width).par_row_chunks_mut(size);
        let leaves = halves.leaves.par_iter().zip(&halves.above);
        leaves.zip(left.zip(right)).for_each(|((leaf, above), (mut left, mut right))| {
            left.fill(zero());
            right.fill(zero());
            for &split in above {
                let Split { level, middle, .. } = halves.splits[split];
                let is_first = leaf.start < middle;
                let [upper, lower] = terms[split];
                let [of_left, of_right] = if is_first { [upper, lower] } else { [lower, upper] };
                let left = left.as_mut().subcols_mut(columns[level], of_left);
                let right = right.as_mut().subcols_mut(columns[level], of_right);
                fill(leaf.clone(), LeafColumns { split, is_first, left, right });
            }
        });
    }
}

/// Factors of such a matrix.
#[derive(Debug)]
pub struct HodlrFactors<T> {
    root: Node<T>,
    /// `Y` in the place of `U`.
    blocks: OffDiagonal<T>,
}

#[derive(Debug)]
enum Node<T> {
    Leaf(Factors<T>),
    Split(Box<Coupling<T>>),
}

#[derive(Debug)]
struct Coupling<T> {
    middle: usize,
    /// First column of its level.
    first: usize,
    terms: [usize; 2],
    halves: [Node<T>; 2],
    /// Of `[I, V₂ᵀ Y₂; V₁ᵀ Y₁, I]`, for what the halves give to each other: `V₂ᵀ x₂` and then `V₁ᵀ x₁`.
    small: Factors<T>,
}

impl<T: RealField + Copy> HodlrFactors<T> {
    /// Factorises.
    ///
    /// # Arguments
    /// * `leaves` -- dense blocks on the diagonal, in the order of [`Halves::leaves`]
    pub fn new(halves: &Halves, leaves: Vec<Mat<T>>, mut blocks: OffDiagonal<T>) -> Self {
        let (n, columns) = blocks.shape();
        let part = Part {
            splits: &halves.splits,
            terms: &blocks.terms,
            columns: &blocks.columns,
            leaves,
            left: MatMut::from_column_major_slice_mut(&mut blocks.left, n, columns),
            right: MatRef::from_column_major_slice(&blocks.right, n, columns),
            level: 0,
        };
        Self { root: part.factorise(), blocks }
    }

    /// Replaces the right-hand side by the solution.
    pub fn solve(&self, rhs: &mut [T]) {
        let (n, columns) = self.blocks.shape();
        let [left, right] = [&self.blocks.left, &self.blocks.right]
            .map(|values| MatRef::from_column_major_slice(values, n, columns));
        self.root.solve(left, right, MatMut::from_column_major_slice_mut(rhs, n, 1));
    }

    /// The memory of the blocks.
    pub fn into_blocks(self) -> OffDiagonal<T> {
        self.blocks
    }

    /// Bytes held, about.
    pub fn bytes(&self) -> usize {
        size_of::<T>() * (self.blocks.left.len() + self.blocks.right.len()) + self.root.bytes()
    }
}

impl<T> OffDiagonal<T> {
    fn shape(&self) -> (usize, usize) {
        (self.rows, self.columns[self.columns.len() - 1])
    }
}

/// What a part of the matrix is factorised from.
struct Part<'a, T> {
    /// The splits of this part, itself before those of its halves.
    splits: &'a [Split],
    terms: &'a [[usize; 2]],
    columns: &'a [usize],
    leaves: Vec<Mat<T>>,
    left: MatMut<'a, T>,
    right: MatRef<'a, T>,
    level: usize,
}

impl<T: RealField + Copy> Part<'_, T> {
    /// Factorises, and solves for the columns of the levels above.
    fn factorise(mut self) -> Node<T> {
        let first = self.columns[self.level];
        let Some((split, splits)) = self.splits.split_first() else {
            let factors = Factors::new(self.leaves.pop().expect("a block for each leaf"));
            factors.solve_columns(self.left.subcols_mut(0, first));
            return Node::Leaf(factors);
        };
        let middle = split.middle - split.start;
        let inner = splits.partition_point(|it| it.end <= split.middle);
        let second_leaves = self.leaves.split_off(inner + 1);
        let (mut top, mut bottom) = self.left.split_at_row_mut(middle);
        let (right_top, right_bottom) = self.right.split_at_row(middle);
        let (terms, below) = (self.terms[0], &self.terms[1..]);
        let (columns, level) = (self.columns, self.level + 1);
        let half = |of: Range<usize>, leaves, left, right| {
            let (splits, terms) = (&splits[of.clone()], &below[of]);
            Part { splits, terms, columns, leaves, left, right, level }
        };
        let halves = (
            half(0..inner, self.leaves, top.as_mut(), right_top),
            half(inner..splits.len(), second_leaves, bottom.as_mut(), right_bottom),
        );
        let halves = rayon::join(|| halves.0.factorise(), || halves.1.factorise());
        let [upper, lower] = terms;
        let right = [right_top.subcols(first, lower), right_bottom.subcols(first, upper)];
        // Of the levels above, and then of `Y` itself.
        let mut given =
            give(right, [top.as_ref().subcols(0, first + upper), bottom.as_ref().subcols(0, first + lower)]);
        let mut small = Mat::identity(upper + lower, upper + lower);
        for (row, column, rows, columns) in [(0, upper, upper, lower), (upper, 0, lower, upper)] {
            let own = given.as_ref().submatrix(row, first, rows, columns);
            small.as_mut().submatrix_mut(row, column, rows, columns).copy_from(own);
        }
        let coupling = Coupling { middle, first, terms, halves: halves.into(), small: Factors::new(small) };
        let ((above_top, own_top), (above_bottom, own_bottom)) =
            (top.split_at_col_mut(first), bottom.split_at_col_mut(first));
        let own = [own_top.as_ref().subcols(0, upper), own_bottom.as_ref().subcols(0, lower)];
        coupling.take(own, given.as_mut().subcols_mut(0, first), [above_top, above_bottom]);
        Node::Split(Box::new(coupling))
    }
}

/// `V₂ᵀ X₂` and then `V₁ᵀ X₁`, in as many columns as the wider of `X` has.
fn give<T: RealField + Copy>(right: [MatRef<'_, T>; 2], solutions: [MatRef<'_, T>; 2]) -> Mat<T> {
    let ([first, second], [top, bottom]) = (right, solutions);
    let (upper, lower) = (second.ncols(), first.ncols());
    let mut given = Mat::zeros(upper + lower, top.ncols().max(bottom.ncols()));
    for (row, right, solution) in [(0, second, bottom), (upper, first, top)] {
        let to = given.as_mut().submatrix_mut(row, 0, right.ncols(), solution.ncols());
        product(to, right.transpose(), solution, one());
    }
    given
}

impl<T: RealField + Copy> Coupling<T> {
    /// Takes from the solutions of each half for itself what the other gives to it.
    ///
    /// # Arguments
    /// * `left` -- `Y` of the halves
    /// * `given` -- of [`give`]
    fn take(&self, left: [MatRef<'_, T>; 2], mut given: MatMut<'_, T>, solutions: [MatMut<'_, T>; 2]) {
        self.small.solve_columns(given.as_mut());
        let (to_top, to_bottom) = given.as_ref().split_at_row(self.terms[0]);
        for ((solution, left), given) in solutions.into_iter().zip(left).zip([to_top, to_bottom]) {
            add_product(solution, left, given, -one::<T>());
        }
    }
}

impl<T: RealField + Copy> Node<T> {
    fn solve(&self, left: MatRef<'_, T>, right: MatRef<'_, T>, rhs: MatMut<'_, T>) {
        match self {
            Self::Leaf(factors) => factors.solve_columns(rhs),
            Self::Split(coupling) => {
                let Coupling { middle, first, terms: [upper, lower], .. } = **coupling;
                let (left_top, left_bottom) = left.split_at_row(middle);
                let (right_top, right_bottom) = right.split_at_row(middle);
                let (mut top, mut bottom) = rhs.split_at_row_mut(middle);
                let halves = &coupling.halves;
                rayon::join(
                    || halves[0].solve(left_top, right_top, top.as_mut()),
                    || halves[1].solve(left_bottom, right_bottom, bottom.as_mut()),
                );
                let right = [right_top.subcols(first, lower), right_bottom.subcols(first, upper)];
                let mut given = give(right, [top.as_ref(), bottom.as_ref()]);
                let left = [left_top.subcols(first, upper), left_bottom.subcols(first, lower)];
                coupling.take(left, given.as_mut(), [top, bottom]);
            }
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Self::Leaf(factors) => factors.bytes(),
            Self::Split(coupling) => {
                coupling.small.bytes() + coupling.halves.iter().map(Node::bytes).sum::<usize>()
            }
        }
    }
}
