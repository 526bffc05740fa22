//! Linear algebra whose results do not depend on the number of threads.

mod cross;
mod hodlr;
mod wide;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::linalg::matmul::matmul;
use faer::perm::PermRef;
use faer::traits::ComplexField;
use faer::{Accum, ColMut, ColRef, Mat, MatMut, MatRef, Par};
use rayon::prelude::*;

pub use cross::LowRank;
pub use hodlr::{Halves, HodlrFactors, LeafColumns, OffDiagonal, Split};

/// `y = A x` for the leading columns of `A`, as many as `x` is long.
pub fn multiply(matrix: MatRef<'_, f64>, x: &[f64], y: &mut [f64]) {
    let columns = matrix.subcols(0, x.len());
    product(ColMut::from_slice_mut(y).as_mat_mut(), columns, ColRef::from_slice(x).as_mat(), 1.0);
}

/// `to = scale · left · right`.
pub fn product<T: ComplexField>(to: MatMut<'_, T>, left: MatRef<'_, T>, right: MatRef<'_, T>, scale: T) {
    matmul(to, Accum::Replace, left, right, scale, Par::Seq);
    wide::leave_registers();
}

/// `to = to + scale · left · right`.
pub fn add_product<T: ComplexField>(to: MatMut<'_, T>, left: MatRef<'_, T>, right: MatRef<'_, T>, scale: T) {
    matmul(to, Accum::Add, left, right, scale, Par::Seq);
    wide::leave_registers();
}

/// Values of a vector that one task takes, in whole units, an even number of them.
const TASK: usize = 2048;

/// Fills a vector of units of `unit` values, many units at a time and always the same ones together, so that how many threads share the work
/// does not matter; `fill` is told the first unit.
pub fn in_parallel<T: Send>(values: &mut [T], unit: usize, fill: impl Fn(usize, &mut [T]) + Sync) {
    let units = (TASK / unit).next_multiple_of(2);
    values.par_chunks_mut(units * unit).enumerate().for_each(|(task, part)| fill(task * units, part));
}

/// Sum of products, in the order of the slices.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Largest of some values, at least zero.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(*value))
}

/// Largest magnitude, zero of none.
pub fn largest_magnitude(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// LU factors with partial pivoting of a square matrix.
#[derive(Debug, Clone)]
pub struct Factors<T = f64> {
    lu: Mat<T>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
}

impl<T: ComplexField> Factors<T> {
    /// Factorises the matrix.
    pub fn new(mut matrix: Mat<T>) -> Self {
        let n = matrix.nrows();
        let (mut forward, mut inverse) = (vec![0; n], vec![0; n]);
        let scratch = factor::lu_in_place_scratch::<usize, T>(n, n, Par::Seq, Default::default());
        factor::lu_in_place(
            matrix.as_mut(),
            &mut forward,
            &mut inverse,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
            Default::default(),
        );
        wide::leave_registers();
        Self { lu: matrix, forward, inverse }
    }

    /// Replaces the right-hand side by the solution.
    pub fn solve(&self, rhs: &mut [T]) {
        let n = rhs.len();
        self.solve_columns(MatMut::from_column_major_slice_mut(rhs, n, 1));
    }

    /// Replaces right-hand sides, a column each, by their solutions.
    pub fn solve_columns(&self, rhs: MatMut<'_, T>) {
        let (lu, permutation) = self.parts();
        let scratch = solve::solve_in_place_scratch::<usize, T>(lu.nrows(), rhs.ncols(), Par::Seq);
        let stack = &mut MemBuffer::new(scratch);
        solve::solve_in_place(lu, lu, permutation, rhs, Par::Seq, MemStack::new(stack));
        wide::leave_registers();
    }

    /// Replaces the right-hand side by the solution with the transposed matrix.
    pub fn solve_transposed(&self, rhs: &mut [T]) {
        let (lu, permutation) = self.parts();
        let rhs = MatMut::from_column_major_slice_mut(rhs, lu.nrows(), 1);
        let scratch = solve::solve_transpose_in_place_scratch::<usize, T>(lu.nrows(), 1, Par::Seq);
        let stack = &mut MemBuffer::new(scratch);
        solve::solve_transpose_in_place(lu, lu, permutation, rhs, Par::Seq, MemStack::new(stack));
        wide::leave_registers();
    }

    fn parts(&self) -> (MatRef<'_, T>, PermRef<'_, usize>) {
        let n = self.lu.nrows();
        (self.lu.as_ref(), PermRef::new_checked(&self.forward, &self.inverse, n))
    }

    /// The memory of the factors, for another matrix.
    pub fn into_matrix(self) -> Mat<T> {
        self.lu
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.lu.nrows() * (size_of::<T>() * self.lu.ncols() + 2 * size_of::<usize>())
    }
}

/// Sums along the rows, column by column as they lie in memory.
pub fn row_sums(matrix: &Mat<f64>) -> Vec<f64> {
    let mut sums = vec![0.0; matrix.nrows()];
    for m in 0..matrix.ncols() {
        sums.iter_mut().zip(matrix.col_as_slice(m)).for_each(|(sum, value)| *sum += value);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_solve_the_system_and_its_transpose() {
        let matrix = Mat::from_fn(3, 3, |i, j| [[0.0, 2.0, 1.0], [1.0, 1.0, 0.0], [3.0, 0.0, 5.0]][i][j]);
        let x = [1.0, -2.0, 0.5];
        let factors = Factors::new(matrix.clone());
        for (transposed, system) in [(false, matrix.clone()), (true, matrix.transpose().to_owned())] {
            let mut y = [0.0; 3];
            multiply(system.as_ref(), &x, &mut y);
            if transposed {
                factors.solve_transposed(&mut y)
            } else {
                factors.solve(&mut y)
            }
            assert!(y.iter().zip(x).all(|(a, b)| (a - b).abs() < 1e-14), "{transposed}: {y:?}");
        }
    }
}
