//! Adaptive cross approximation (Bebendorf, Numer. Math. 86:565, 2000).

use std::ops::Range;

use faer::{Mat, MatRef};

/// Most pairs of vectors of a block.
const MOST_TERMS: usize = 60;

/// A block as a sum of products of a column and a row.
#[derive(Debug, Clone, Default)]
pub struct LowRank {
    /// Vectors over the rows.
    pub rows: Vec<Vec<f64>>,
    /// Vectors over the columns.
    pub columns: Vec<Vec<f64>>,
}

impl LowRank {
    /// Approximates a block from some of its rows and columns.
    ///
    /// # Arguments
    /// * `rows`, `columns` -- of the block
    /// * `first` -- the row to begin with, where the block is largest
    /// * `entry` -- the matrix, times what makes its diagonal one
    /// * `tolerance` -- size of the products that are left out
    pub fn new(
        rows: Range<usize>,
        columns: Range<usize>,
        first: usize,
        entry: impl Fn(usize, usize) -> f64,
        tolerance: f64,
    ) -> Self {
        let mut found = Self::default();
        let mut used = vec![false; rows.len()];
        let mut pivot_row = first - rows.start;
        let most = MOST_TERMS.min(rows.len()).min(columns.len());
        while found.rows.len() < most {
            used[pivot_row] = true;
            let mut row: Vec<f64> = columns.clone().map(|j| entry(rows.start + pivot_row, j)).collect();
            found.subtract(&mut row, &found.columns, |term| found.rows[term][pivot_row]);
            let pivot_column = largest(&row, |_| true);
            let pivot = row[pivot_column];
            if pivot == 0.0 {
                break;
            }
            let mut column: Vec<f64> = rows.clone().map(|i| entry(i, columns.start + pivot_column)).collect();
            found.subtract(&mut column, &found.rows, |term| found.columns[term][pivot_column]);
            row.iter_mut().for_each(|value| *value /= pivot);
            let size = norm(&row) * norm(&column);
            if size.is_nan() {
                break;
            }
            let next = largest(&column, |i| !used[i]);
            found.rows.push(column);
            found.columns.push(row);
            if size <= tolerance || used[next] {
                break;
            }
            pivot_row = next;
        }
        found
    }

    /// The same in the fewest products, but for those whose singular values are no larger than a tolerance: crosses are half as many again as
    /// it takes.
    #[must_use]
    pub fn truncated(&self, tolerance: f64) -> Self {
        let terms = self.terms();
        let matrix = |vectors: &[Vec<f64>]| {
            Mat::from_fn(vectors.first().map_or(0, Vec::len), terms, |i, term| vectors[term][i])
        };
        let [rows, columns] = [&self.rows, &self.columns].map(|vectors| matrix(vectors).qr());
        // Products that are no numbers have no singular values; they are left as they are, for whoever applies them to notice.
        let Ok(svd) = (rows.thin_R() * columns.thin_R().transpose()).thin_svd() else { return self.clone() };
        let sizes = svd.S().column_vector();
        let kept = sizes.iter().take_while(|size| **size > tolerance).count();
        let vectors = |basis: Mat<f64>, sides: MatRef<'_, f64>| -> Vec<Vec<f64>> {
            (basis * sides.subcols(0, kept))
                .col_iter()
                .map(|column| column.iter().copied().collect())
                .collect()
        };
        let mut rows = vectors(rows.compute_thin_Q(), svd.U());
        for (row, size) in rows.iter_mut().zip(sizes.iter()) {
            row.iter_mut().for_each(|value| *value *= size);
        }
        Self { rows, columns: vectors(columns.compute_thin_Q(), svd.V()) }
    }

    /// Number of products.
    pub fn terms(&self) -> usize {
        self.rows.len()
    }

    /// Takes the products so far from a row or a column.
    fn subtract(&self, from: &mut [f64], vectors: &[Vec<f64>], factor: impl Fn(usize) -> f64) {
        for (term, vector) in vectors.iter().enumerate() {
            let factor = factor(term);
            for (value, part) in from.iter_mut().zip(vector) {
                *value -= factor * part;
            }
        }
    }
}

/// Index of the largest magnitude among some; the first if there is none.
fn largest(values: &[f64], among: impl Fn(usize) -> bool) -> usize {
    let chosen = values.iter().enumerate().filter(|(index, _)| among(*index));
    chosen.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).map_or(0, |(index, _)| index)
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}
