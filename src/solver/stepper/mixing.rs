//! Anderson mixing: corrections by a matrix that is near the right one, improved by what those before did.

use crate::numerics::linear::dot;

/// Corrections that the next is improved by; more gained nothing (measured).
const DEPTH: usize = 3;

/// Part of a difference below which nothing new is in it.
const NOTHING_NEW: f64 = 1e-6;

/// Mixing of the corrections of one Newton matrix (Anderson, J. ACM 12:547, 1965; Walker & Ni, SIAM J. Numer. Anal. 49:1715, 2011).
///
/// ```text
/// x ← x - c + Σ_j γ_j (u_j + c_(j+1) - c_j),     γ = argmin |c - Σ_j γ_j (c_(j+1) - c_j)|
/// ```
///
/// with the corrections `c` that the matrix gives and the `u` that were made of those before.
#[derive(Debug, Default)]
pub(super) struct Mixing {
    /// `c_(j+1) - c_j` and `u_j + c_(j+1) - c_j`, the oldest first.
    pairs: Vec<[Vec<f64>; 2]>,
    /// The last `c` and `u`.
    last: Option<[Vec<f64>; 2]>,
}

impl Mixing {
    /// What to take away, from what the matrix gives.
    pub fn improved(&mut self, correction: &[f64]) -> Vec<f64> {
        if let Some([before, taken]) = self.last.take() {
            let change: Vec<f64> = correction.iter().zip(&before).map(|(now, before)| now - before).collect();
            let both = taken.iter().zip(&change).map(|(taken, change)| taken + change).collect();
            self.pairs.push([change, both]);
            if self.pairs.len() > DEPTH {
                self.pairs.remove(0);
            }
        }
        // Gram and Schmidt's basis of the changes, the newest first, and the same sums of what goes with them.
        let mut basis: Vec<[Vec<f64>; 2]> = Vec::new();
        let mut improved = correction.to_vec();
        for [change, both] in self.pairs.iter().rev() {
            let (mut direction, mut step) = (change.clone(), both.clone());
            for [known, its_step] in &basis {
                let part = dot(known, &direction);
                subtract(&mut direction, part, known);
                subtract(&mut step, part, its_step);
            }
            let size = dot(&direction, &direction).sqrt();
            if size <= NOTHING_NEW * dot(change, change).sqrt() || !size.is_finite() {
                continue;
            }
            for value in direction.iter_mut().chain(&mut step) {
                *value /= size;
            }
            subtract(&mut improved, dot(&direction, correction), &step);
            basis.push([direction, step]);
        }
        self.last = Some([correction.to_vec(), improved.clone()]);
        improved
    }
}

fn subtract(from: &mut [f64], times: f64, values: &[f64]) {
    for (value, other) in from.iter_mut().zip(values) {
        *value -= times * other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_problem_of_three_kinds_is_solved_in_as_many_corrections_and_one() {
        // What a matrix leaves of the error of each kind; taken as they are, corrections would leave 0.5^4 of the worst.
        let left = [0.5, -0.4, 0.3];
        let solution = |i: usize| (i as f64).cos();
        let mut x = [0.0; 30];
        let mut mixing = Mixing::default();
        for _ in 0..4 {
            let correction: Vec<f64> = (0..30).map(|i| (1.0 - left[i % 3]) * (x[i] - solution(i))).collect();
            subtract(&mut x, 1.0, &mixing.improved(&correction));
        }
        let error = (0..30).fold(0.0, |most: f64, i| most.max((x[i] - solution(i)).abs()));
        assert!(error < 1e-13, "off by {error:e}");
    }
}
