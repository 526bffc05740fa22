//! The steps of a period at constant indentation in which the indenter turns, and what a spring slips in them.

use super::{difference, length};
use crate::laws::path::Path;

/// Most substeps in a step, and most that the motion turns within one, rad: more than that is a corner.
const MOST_SUBSTEPS: usize = 8;
const MOST_TURN: f64 = 0.3;

/// Substeps per step below which steps of two nodes would be no fewer than the substeps.
const FEWEST_SUBSTEPS: usize = 3;

/// The steps of a period at constant indentation, in which slip is taken by two nodes, or its substeps, where there would be hardly fewer steps.
///
/// Over a step `f` from 0 to 1 is the part of the way that is through. A vector of slip per `f` is taken by its first two moments, which a sum of springs
/// keeps, and written as those at the nodes of Gauss's rule:
///
/// ```text
/// s_0 = ∫ ds,  s_1 = ∫ (2f - 1) ds,      s_0/2 ± √3 s_1/2,      ∫ |ds| ≈ |s_0/2 - √3 s_1/2| + |s_0/2 + √3 s_1/2|
/// ```
///
/// which is of fourth order in the step where slip goes on all through it. Where the second half of the period is the opposite of the first, twice the first
/// stands for both.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Turns {
    /// The step of each substep that is kept, and the middle of the substep, `2f - 1`.
    substeps: Vec<(usize, f64)>,
    steps: usize,
    /// Whether there are two nodes in a step.
    paired: bool,
    /// Times that what is kept happens in the period.
    times: f64,
}

impl Turns {
    /// # Arguments
    /// * `path` -- one period
    /// * `mirrored` -- whether its second half is the opposite of the first
    pub(super) fn new(path: &Path, mirrored: bool) -> Self {
        let count = path.points.len();
        let (kept, times) = if mirrored { (count / 2, 2.0) } else { (count, 1.0) };
        let way = |m: usize| {
            let [from, to] = [m, m + 1].map(|m| path.points[m % count].tangential);
            difference(to, from)
        };
        let mut firsts = vec![0];
        let (mut turned, mut before) = (0.0, way(0));
        for m in 1..kept {
            let now = way(m);
            turned += angle(before, now);
            if turned > MOST_TURN || m - firsts[firsts.len() - 1] == MOST_SUBSTEPS {
                firsts.push(m);
                turned = 0.0;
            }
            before = now;
        }
        let steps = firsts.len();
        if FEWEST_SUBSTEPS * steps > kept {
            let substeps = (0..kept).map(|m| (m, 0.0)).collect();
            return Self { substeps, steps: kept, paired: false, times };
        }
        let ends = firsts[1..].iter().copied().chain([kept]);
        let substeps = firsts.iter().zip(ends).enumerate().flat_map(|(step, (first, end))| {
            let whole: f64 = (*first..end).map(|m| length(way(m))).sum();
            let mut through = 0.0;
            let middles = (*first..end).map(|m| {
                let part = length(way(m));
                through += part;
                let middle = if whole > 0.0 { (2.0 * through - part) / whole - 1.0 } else { 0.0 };
                (step, middle)
            });
            middles.collect::<Vec<_>>()
        });
        Self { substeps: substeps.collect(), steps, paired: true, times }
    }

    /// Substeps that are kept.
    pub(super) fn kept(&self) -> usize {
        self.substeps.len()
    }

    /// Whether columns come in pairs, the two nodes of a step.
    pub(super) fn is_paired(&self) -> bool {
        self.paired
    }

    /// Nodes, of which each has an `x` and a `y`.
    pub(super) fn nodes(&self) -> usize {
        if self.paired { 2 * self.steps } else { self.steps }
    }

    /// Slip at the nodes, m, x and y in turn, shape `(2 · nodes,)`, of the slip in each substep.
    pub(super) fn at_nodes(&self, slip: &[[f64; 2]], nodes: &mut [f64]) {
        nodes.fill(0.0);
        let half = 0.5 * 3.0_f64.sqrt();
        for ((step, middle), slip) in self.substeps.iter().zip(slip) {
            for (axis, moved) in slip.iter().enumerate() {
                let moved = self.times * moved;
                if self.paired {
                    let aside = half * moved * middle;
                    nodes[4 * step + axis] += 0.5 * moved - aside;
                    nodes[4 * step + 2 + axis] += 0.5 * moved + aside;
                } else {
                    nodes[2 * step + axis] += moved;
                }
            }
        }
    }
}

/// Angle between two motions, rad; zero if one is none.
fn angle(before: [f64; 2], now: [f64; 2]) -> f64 {
    let across = before[0] * now[1] - before[1] * now[0];
    across.atan2(super::dot(before, now)).abs()
}
