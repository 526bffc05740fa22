//! Dense linear algebra on one thread, so that results do not depend on the number of threads.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::linalg::matmul::matmul;
use faer::perm::PermRef;
use faer::{Accum, ColMut, ColRef, Mat, MatMut, MatRef, Par};

/// `y = A x` for the leading columns of `A`, as many as `x` is long.
pub fn multiply(matrix: MatRef<'_, f64>, x: &[f64], y: &mut [f64]) {
    let columns = matrix.subcols(0, x.len());
    matmul(
        ColMut::from_slice_mut(y).as_mat_mut(),
        Accum::Replace,
        columns,
        ColRef::from_slice(x).as_mat(),
        1.0,
        Par::Seq,
    );
}

/// Sum of products, in the order of the slices.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// LU factors with partial pivoting of a square matrix.
#[derive(Debug, Clone)]
pub struct Factors {
    lu: Mat<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
}

impl Factors {
    /// Factorises the matrix.
    pub fn new(mut matrix: Mat<f64>) -> Self {
        let n = matrix.nrows();
        let (mut forward, mut inverse) = (vec![0; n], vec![0; n]);
        let scratch = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Default::default());
        factor::lu_in_place(
            matrix.as_mut(),
            &mut forward,
            &mut inverse,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
            Default::default(),
        );
        Self { lu: matrix, forward, inverse }
    }

    /// Replaces the right-hand side by the solution.
    pub fn solve(&self, rhs: &mut [f64]) {
        let (lu, permutation, rhs) = self.parts(rhs);
        let scratch = solve::solve_in_place_scratch::<usize, f64>(lu.nrows(), 1, Par::Seq);
        solve::solve_in_place(
            lu,
            lu,
            permutation,
            rhs,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
    }

    /// Replaces the right-hand side by the solution with the transposed matrix.
    pub fn solve_transposed(&self, rhs: &mut [f64]) {
        let (lu, permutation, rhs) = self.parts(rhs);
        let scratch = solve::solve_transpose_in_place_scratch::<usize, f64>(lu.nrows(), 1, Par::Seq);
        let stack = &mut MemBuffer::new(scratch);
        solve::solve_transpose_in_place(lu, lu, permutation, rhs, Par::Seq, MemStack::new(stack));
    }

    fn parts<'a>(&'a self, rhs: &'a mut [f64]) -> (MatRef<'a, f64>, PermRef<'a, usize>, MatMut<'a, f64>) {
        let n = self.lu.nrows();
        let permutation = PermRef::new_checked(&self.forward, &self.inverse, n);
        (self.lu.as_ref(), permutation, MatMut::from_column_major_slice_mut(rhs, n, 1))
    }
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
