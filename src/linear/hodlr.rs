//! Factors of a matrix whose blocks off the diagonal are of low rank.
//!
//! ```text
//! A = | A₁      U₁ V₂ᵀ |     = | A₁    | ( I + |  0     Y₁ V₂ᵀ | ),     Y_i = A_i⁻¹ U_i
//!     | U₂ V₁ᵀ  A₂     |       |    A₂ |       | Y₂ V₁ᵀ   0    |
//! ```
//!
//! In single precision: it is for matrices whose diagonal is one and that are known to some digits only, and takes half the time and memory.
//! The halves are of the same kind down to dense leaves, so that factors cost `O(n log² n)` and solutions `O(n log n)` operations (HODLR:
//! Ambikasaran & Darve, J. Sci. Comput. 57:477, 2013).

use std::ops::Range;

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};

use super::Factors;

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
    /// From the first row on.
    pub leaves: Vec<Range<usize>>,
}

impl Halves {
    /// Halves `n` rows at multiples of `leaf` until parts are no larger.
    pub fn new(n: usize, leaf: usize) -> Self {
        let mut halves = Self { splits: Vec::new(), leaves: Vec::new() };
        halves.divide(0, n, 0, leaf);
        halves
    }

    fn divide(&mut self, start: usize, end: usize, level: usize, leaf: usize) {
        let leaves = (end - start).div_ceil(leaf);
        if leaves <= 1 {
            self.leaves.push(start..end);
            return;
        }
        let middle = start + leaves / 2 * leaf;
        self.splits.push(Split { level, start, middle, end });
        self.divide(start, middle, level + 1, leaf);
        self.divide(middle, end, level + 1, leaf);
    }
}

/// The blocks off the diagonal of a [`Split`]: `upper = [U₁, V₂]`, `lower = [U₂, V₁]`, columns a term each.
#[derive(Debug, Clone)]
pub struct OffDiagonal {
    pub upper: [Mat<f32>; 2],
    pub lower: [Mat<f32>; 2],
}

/// Factors of such a matrix.
#[derive(Debug)]
pub struct HodlrFactors {
    root: Node,
    /// `Y` of all splits, a range of columns for each level.
    reduced: Mat<f32>,
}

#[derive(Debug)]
enum Node {
    Leaf(Factors<f32>),
    Split(Box<Joint>),
}

#[derive(Debug)]
struct Joint {
    middle: usize,
    columns: Range<usize>,
    halves: [Node; 2],
    /// `V₁` and `V₂`.
    right: [Mat<f32>; 2],
    /// Of `[I, V₂ᵀ Y₂; V₁ᵀ Y₁, I]`.
    small: Factors<f32>,
}

/// What factors are made of.
struct Parts {
    leaves: std::vec::IntoIter<Mat<f32>>,
    off_diagonal: std::vec::IntoIter<OffDiagonal>,
}

impl HodlrFactors {
    /// Factorises.
    ///
    /// # Arguments
    /// * `leaves` -- dense blocks on the diagonal, in the order of [`Halves::leaves`]
    /// * `off_diagonal` -- in the order of [`Halves::splits`]
    pub fn new(halves: &Halves, leaves: Vec<Mat<f32>>, off_diagonal: Vec<OffDiagonal>) -> Self {
        let n = halves.leaves.last().map_or(0, |leaf| leaf.end);
        let levels = halves.splits.iter().map(|split| split.level + 1).max().unwrap_or(0);
        let mut widths = vec![0; levels];
        for (split, blocks) in halves.splits.iter().zip(&off_diagonal) {
            let terms = blocks.upper[0].ncols().max(blocks.lower[0].ncols());
            widths[split.level] = terms.max(widths[split.level]);
        }
        let offsets: Vec<usize> = std::iter::once(0)
            .chain(widths.iter().scan(0, |sum, width| {
                *sum += width;
                Some(*sum)
            }))
            .collect();
        let mut reduced = Mat::zeros(n, offsets[levels]);
        for (split, blocks) in halves.splits.iter().zip(&off_diagonal) {
            let first = offsets[split.level];
            for (row, left) in [(split.start, &blocks.upper[0]), (split.middle, &blocks.lower[0])] {
                let mut to = reduced.as_mut().submatrix_mut(row, first, left.nrows(), left.ncols());
                to.copy_from(left);
            }
        }
        let mut parts = Parts { leaves: leaves.into_iter(), off_diagonal: off_diagonal.into_iter() };
        let tree = Plan::new(halves, &mut parts);
        let root = tree.factorise(&offsets, 0, reduced.as_mut());
        Self { root, reduced }
    }

    /// Replaces the right-hand side by the solution.
    pub fn solve(&self, rhs: &mut [f32]) {
        let n = rhs.len();
        self.root.solve(self.reduced.as_ref(), MatMut::from_column_major_slice_mut(rhs, n, 1));
    }

    /// Bytes held, about.
    pub fn bytes(&self) -> usize {
        4 * self.reduced.nrows() * self.reduced.ncols() + self.root.bytes()
    }
}

/// The tree before it is factorised.
enum Plan {
    Leaf(Mat<f32>),
    Split { middle: usize, blocks: Box<OffDiagonal>, halves: Box<[Plan; 2]> },
}

impl Plan {
    fn new(halves: &Halves, parts: &mut Parts) -> Self {
        Self::part(
            &mut halves.splits.iter().peekable(),
            parts,
            0..halves.leaves.last().map_or(0, |it| it.end),
        )
    }

    fn part<'a>(
        splits: &mut std::iter::Peekable<impl Iterator<Item = &'a Split>>,
        parts: &mut Parts,
        rows: Range<usize>,
    ) -> Self {
        let Some(split) = splits.next_if(|split| (split.start, split.end) == (rows.start, rows.end)) else {
            return Self::Leaf(parts.leaves.next().expect("a block for each leaf"));
        };
        let blocks = parts.off_diagonal.next().expect("blocks for each split");
        let first = Self::part(splits, parts, rows.start..split.middle);
        let second = Self::part(splits, parts, split.middle..rows.end);
        let middle = split.middle - rows.start;
        Self::Split { middle, blocks: Box::new(blocks), halves: Box::new([first, second]) }
    }

    /// Factorises, and solves for the columns of the levels above, which `reduced` has in the rows of this part.
    fn factorise(self, offsets: &[usize], level: usize, mut reduced: MatMut<'_, f32>) -> Node {
        match self {
            Self::Leaf(matrix) => {
                let factors = Factors::new(matrix);
                let above = reduced.subcols_mut(0, offsets[level]);
                factors.solve_columns(above);
                Node::Leaf(factors)
            }
            Self::Split { middle, blocks, halves } => {
                let columns = offsets[level]..offsets[level + 1];
                let (mut top, mut bottom) = reduced.as_mut().split_at_row_mut(middle);
                let [first, second] = *halves;
                let (first, second) = rayon::join(
                    || first.factorise(offsets, level + 1, top.as_mut()),
                    || second.factorise(offsets, level + 1, bottom.as_mut()),
                );
                let OffDiagonal { upper: [_, right_second], lower: [_, right_first] } = *blocks;
                let right = [right_first, right_second];
                let small = coupling(&right, [top.as_ref(), bottom.as_ref()], &columns);
                let joint = Joint { middle, columns, halves: [first, second], right, small };
                let (above_top, own_top) = top.split_at_col_mut(joint.columns.start);
                let (above_bottom, own_bottom) = bottom.split_at_col_mut(joint.columns.start);
                joint.correct([own_top.as_ref(), own_bottom.as_ref()], [above_top, above_bottom]);
                Node::Split(Box::new(joint))
            }
        }
    }
}

/// Factors of `[I, V₂ᵀ Y₂; V₁ᵀ Y₁, I]`, for what the halves give to each other: `V₂ᵀ x₂` and then `V₁ᵀ x₁`.
fn coupling(right: &[Mat<f32>; 2], reduced: [MatRef<'_, f32>; 2], columns: &Range<usize>) -> Factors<f32> {
    let [first, second] = right;
    let (upper, lower) = (second.ncols(), first.ncols());
    let mut small = Mat::identity(upper + lower, upper + lower);
    let own = |half: usize, count: usize| reduced[half].subcols(columns.start, count);
    let mut block = small.as_mut().submatrix_mut(0, upper, upper, lower);
    matmul(block.as_mut(), Accum::Replace, second.transpose(), own(1, lower), 1.0, Par::Seq);
    let mut block = small.as_mut().submatrix_mut(upper, 0, lower, upper);
    matmul(block.as_mut(), Accum::Replace, first.transpose(), own(0, upper), 1.0, Par::Seq);
    Factors::new(small)
}

impl Joint {
    /// Takes what the halves give to each other from the solutions of each for itself.
    ///
    /// # Arguments
    /// * `own` -- `Y` of the halves from the columns of this split on
    /// * `solutions` -- of the halves
    fn correct(&self, own: [MatRef<'_, f32>; 2], solutions: [MatMut<'_, f32>; 2]) {
        let [mut top, mut bottom] = solutions;
        let [first, second] = &self.right;
        let (upper, lower) = (second.ncols(), first.ncols());
        let mut given = Mat::zeros(upper + lower, top.ncols());
        let (mut to_top, mut to_bottom) = given.as_mut().split_at_row_mut(upper);
        matmul(to_top.as_mut(), Accum::Replace, second.transpose(), bottom.as_ref(), 1.0, Par::Seq);
        matmul(to_bottom.as_mut(), Accum::Replace, first.transpose(), top.as_ref(), 1.0, Par::Seq);
        self.small.solve_columns(given.as_mut());
        matmul(top.as_mut(), Accum::Add, own[0].subcols(0, upper), given.subrows(0, upper), -1.0, Par::Seq);
        matmul(
            bottom.as_mut(),
            Accum::Add,
            own[1].subcols(0, lower),
            given.subrows(upper, lower),
            -1.0,
            Par::Seq,
        );
    }
}

impl Node {
    fn solve(&self, reduced: MatRef<'_, f32>, rhs: MatMut<'_, f32>) {
        match self {
            Self::Leaf(factors) => factors.solve_columns(rhs),
            Self::Split(joint) => {
                let (own_top, own_bottom) = reduced.split_at_row(joint.middle);
                let (mut top, mut bottom) = rhs.split_at_row_mut(joint.middle);
                let [first, second] = &joint.halves;
                rayon::join(
                    || first.solve(own_top, top.as_mut()),
                    || second.solve(own_bottom, bottom.as_mut()),
                );
                let own = [own_top, own_bottom].map(|part| part.split_at_col(joint.columns.start).1);
                joint.correct(own, [top, bottom]);
            }
        }
    }

    fn bytes(&self) -> usize {
        match self {
            Self::Leaf(factors) => factors.bytes(),
            Self::Split(joint) => {
                let right: usize = joint.right.iter().map(|it| 4 * it.nrows() * it.ncols()).sum();
                right + joint.small.bytes() + joint.halves.iter().map(Node::bytes).sum::<usize>()
            }
        }
    }
}
