//! The blocks of the transforms off the diagonal as matrices of low rank, for a solver that needs them to some digits only.

use std::ops::Range;

use faer::Mat;
use rayon::prelude::*;

use super::AbelOperators;
use super::hierarchical::LEAF;
use super::weights::Kernel;
use crate::numerics::linear::{Halves, LowRank, Split};

/// Singular values that are left out of a block where the diagonal is one. Newton's method with factors of such matrices contracts to 1e-4 to
/// 0.04 an iteration (measured); with 1e-2 it takes twice as many and finds no step at times.
const TOLERANCE: f64 = 1e-3;

/// What crosses leave of a block before.
const CROSSES: f64 = 0.1 * TOLERANCE;

/// Leaves of the hierarchical transforms to one of the halved matrix.
const LEAVES: usize = 2;

/// Columns at the far end of what is near to a leaf to which farther cells contribute as well.
const SHARED: usize = 4;

/// The columns, within a leaf of a row to either side, whose weights are those of the transform; for others the kernel does, at the spring itself.
fn near(row: usize) -> Range<usize> {
    let leaf = row / LEAF;
    let first = if leaf < 2 { 0 } else { (leaf - 1) * LEAF + SHARED };
    first..(leaf + 2) * LEAF - SHARED
}

/// Both transforms of a mesh, halved again and again.
#[derive(Debug)]
pub struct Compressed {
    halves: Halves,
    blocks: Vec<Block>,
}

/// The blocks off the diagonal of one [`Split`].
#[derive(Debug)]
pub struct Block {
    /// Eq. (20): from the springs of the first half to those of the second and [`Block::AHEAD`] more.
    pub profile: LowRank,
    /// Eq. (21): from the springs of the second half to those of the first.
    pub pressure: LowRank,
    /// Eq. (20): from the springs of the first half to its last ones, from the last one on.
    pub last_rows: [Vec<f64>; Self::BACK],
}

impl Block {
    /// Rows of the first half that the stencils of the second reach back to.
    pub const BACK: usize = 2;
    /// Rows beyond its end that the stencils of a half reach ahead to.
    pub const AHEAD: usize = 3;
}

impl Compressed {
    /// Approximates the blocks of hierarchical operators.
    pub fn new(operators: &AbelOperators) -> Self {
        let n = operators.len();
        let halves = Halves::new(n, LEAVES * LEAF);
        let scale = |weight: fn(&AbelOperators, usize, usize) -> f64| -> Vec<f64> {
            (0..n)
                .map(|i| weight(operators, i, i).abs().sqrt())
                .map(|root| if root > 0.0 { root } else { 1.0 })
                .collect()
        };
        let profile = scale(AbelOperators::profile_weight);
        let pressure = scale(AbelOperators::pressure_weight);
        let blocks = halves
            .splits
            .par_iter()
            .map(|split| Block::new(operators, split, [&profile, &pressure]))
            .collect();
        Self { halves, blocks }
    }

    /// Where the springs are halved.
    pub fn halves(&self) -> &Halves {
        &self.halves
    }

    /// The blocks of every split.
    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }
}

impl Block {
    fn new(operators: &AbelOperators, split: &Split, scales: [&[f64]; 2]) -> Self {
        let n = operators.len();
        let Split { start, middle, end, .. } = *split;
        let low_rank = |rows: Range<usize>,
                        columns: Range<usize>,
                        first,
                        scale: &[f64],
                        weight: fn(&AbelOperators, usize, usize) -> f64| {
            let entry = |i: usize, j: usize| weight(operators, i, j) / (scale[i] * scale[j]);
            let crosses = LowRank::new(rows.clone(), columns.clone(), first, entry, CROSSES);
            let mut found = crosses.truncated(TOLERANCE);
            for (vectors, range) in [(&mut found.rows, rows), (&mut found.columns, columns)] {
                for vector in vectors {
                    for (value, scale) in vector.iter_mut().zip(&scale[range.clone()]) {
                        *value *= scale;
                    }
                }
            }
            found
        };
        let ahead = (end + Self::AHEAD).min(n);
        Self {
            profile: low_rank(middle..ahead, start..middle, middle, scales[0], AbelOperators::profile_weight),
            pressure: low_rank(
                start..middle,
                middle..end,
                middle - 1,
                scales[1],
                AbelOperators::pressure_weight,
            ),
            last_rows: std::array::from_fn(|back| {
                (start..middle).map(|j| operators.profile_weight(middle - 1 - back, j)).collect()
            }),
        }
    }
}

impl AbelOperators {
    /// `F_ij` of Eq. (20), springs counted from zero: of hierarchical operators between springs far from each other to some digits only, and zero
    /// where it is a rounding.
    pub fn profile_weight(&self, i: usize, j: usize) -> f64 {
        let Some([profile, _]) = self.hierarchical() else { return self.profile()[(i, j)] };
        if i < j || near(i).contains(&j) {
            return profile.near_weight(i, j);
        }
        let Kernel { mu, nu, profile_factor, .. } = self.kernel;
        let distance = self.mesh.node(i + 1).minus(&self.mesh.node(j + 1));
        profile_factor * mu * distance.powf(-nu) * self.spring_sum[j]
    }

    /// `P_ij` of Eq. (21), as [`AbelOperators::profile_weight`].
    pub fn pressure_weight(&self, i: usize, j: usize) -> f64 {
        let Some([_, pressure]) = self.hierarchical() else { return self.pressure(i, j) };
        if j + 1 == self.len() {
            // At the contact edge there is no compression.
            return 0.0;
        }
        if j < i || near(i).contains(&j) {
            let before = if j > 0 { pressure.near_weight(i, j - 1) } else { 0.0 };
            return before - pressure.near_weight(i, j);
        }
        let mu = self.kernel.mu;
        let distance = self.mesh.node(j + 1).minus(&self.mesh.node(i + 1));
        // By parts: what the local polynomials have under the derivative of the kernel.
        -mu * distance.powf(-mu - 1.0) * self.spring_sum[j]
    }

    /// Weights of both transforms next to the diagonal, of hierarchical operators: of Eq. (20) for the springs `rows`, of Eq. (21) for the springs
    /// `columns`, both from the springs `columns`.
    ///
    /// # Panics
    /// If the operators are dense.
    pub fn diagonal_blocks(&self, rows: Range<usize>, columns: Range<usize>) -> [Mat<f64>; 2] {
        let [profile, pressure] = self.hierarchical().expect("asked of hierarchical operators");
        let (count, own) = (columns.len(), columns.clone());
        let mut carried = Mat::zeros(rows.len(), count);
        profile.add_near(rows.clone(), columns.clone(), 1.0, &mut carried);
        for i in rows.clone() {
            for j in columns.start..near(i).start.min(columns.end) {
                carried[(i - rows.start, j - columns.start)] = self.profile_weight(i, j);
            }
        }
        // A compression adds to the difference before it and takes from the one after.
        let mut pressed = Mat::zeros(count, count);
        pressure.add_near(own.clone(), own.clone(), -1.0, &mut pressed);
        let before = own.start.saturating_sub(1)..own.end.saturating_sub(1);
        let mut shifted = Mat::zeros(count, before.len());
        pressure.add_near(own.clone(), before.clone(), 1.0, &mut shifted);
        let skipped = count - before.len();
        for j in 0..before.len() {
            for i in 0..count {
                pressed[(i, j + skipped)] += shifted[(i, j)];
            }
        }
        for i in own.clone() {
            for j in near(i).end..own.end {
                pressed[(i - own.start, j - own.start)] = self.pressure_weight(i, j);
            }
        }
        [carried, pressed]
    }
}
