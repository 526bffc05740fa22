//! The periodic motion of all springs on a path at constant indentation, once for a run.

use super::{Neighbours, SpringCycle};
use crate::laws::path::Path;

/// Cells between no limit and the one that sticks.
const CELLS: usize = 1024;

/// Fewest cells that are worth it, and most numbers kept.
const FEWEST_CELLS: usize = 128;
const MOST_NUMBERS: usize = 1 << 23;

/// What springs slip in each substep of a path at constant indentation, as a function of the limit `l` of their deflection alone.
///
/// Whatever the law of friction, how it changes with time and how far the spring is compressed, the limit is all that [`steady_cycle`](super::steady_cycle) knows
/// of it while static and kinetic strength are the same. With `l*` at which a spring sticks, the functions are tabulated over
///
/// ```text
/// l/l* = 1 - (1 - t²)⁴,    t even from 0 to 1
/// ```
///
/// and linear between: slip begins with a root on a circle, with a kink on an ellipse, and without a limit the spring turns fast. They are
/// second order in the cells but at kinks; on 1024 the path of slip is good to `3e-5` of that of a spring without limit.
#[derive(Debug, Clone, PartialEq)]
pub struct Response {
    /// `l*`, m.
    largest: f64,
    cells: usize,
    /// Numbers for the slip in each substep that is kept, x and y in turn.
    columns: usize,
    /// Whether the second half of the period is the opposite of the first, which alone is kept.
    mirrored: bool,
    /// By node: slip in each substep, m, then the energies.
    values: Vec<f64>,
}

/// Energies of one spring over its tangential stiffness.
const ENERGIES: usize = 2;

impl Response {
    /// Tabulates a path; `None` for one that presses and lifts, and for one of so many substeps that the table would be too large.
    ///
    /// # Arguments
    /// * `path` -- one period
    pub fn new(path: &Path) -> Option<Self> {
        let mut springs = Neighbours::new(path)?;
        let (mirrored, largest) = (springs.is_mirrored(), springs.sticking());
        let kept = if mirrored { path.points.len() / 2 } else { path.points.len() };
        let columns = 2 * kept;
        let width = columns + ENERGIES;
        let cells = CELLS.min(MOST_NUMBERS / width);
        if cells < FEWEST_CELLS {
            return None;
        }
        let mut cycle = SpringCycle::default();
        let mut values = Vec::with_capacity((cells + 1) * width);
        for node in 0..cells {
            springs.pass(largest * place(node as f64 / cells as f64), &mut cycle);
            values.extend(cycle.slip.iter().take(kept).flatten());
            values.extend([cycle.dissipation, cycle.work]);
        }
        values.extend(std::iter::repeat_n(0.0, width));
        Some(Self { largest, cells, columns, mirrored, values })
    }

    /// Slip in each substep, x and y in turn, m, shape `(2 · substeps,)`, with its derivative by the limit if that is asked for; returns
    /// dissipation and work over the tangential stiffness, m².
    ///
    /// # Arguments
    /// * `limit` -- of the deflection, m, at least 0
    pub fn at(&self, limit: f64, slip: &mut [f64], slope: Option<&mut [f64]>) -> [f64; 2] {
        let width = self.columns + ENERGIES;
        if limit >= self.largest {
            slip.fill(0.0);
            if let Some(slope) = slope {
                slope.fill(0.0);
            }
            return [0.0; 2];
        }
        let relative = limit / self.largest;
        let left = 1.0 - (1.0 - relative).sqrt().sqrt();
        let last = self.cells - 1;
        let mut cell = ((left.sqrt() * self.cells as f64) as usize).min(last);
        let node = |i: usize| place(i as f64 / self.cells as f64);
        while cell > 0 && node(cell) > relative {
            cell -= 1;
        }
        while cell < last && node(cell + 1) <= relative {
            cell += 1;
        }
        let distance = node(cell + 1) - node(cell);
        let part = (relative - node(cell)) / distance;
        let before = &self.values[cell * width..(cell + 1) * width];
        let after = &self.values[(cell + 1) * width..(cell + 2) * width];
        let between = |m: usize| before[m] + part * (after[m] - before[m]);
        self.fill(slip, between);
        if let Some(slope) = slope {
            let per_limit = (distance * self.largest).recip();
            self.fill(slope, |m| per_limit * (after[m] - before[m]));
        }
        [between(self.columns), between(self.columns + 1)]
    }

    /// Fills in a whole period from what is kept.
    fn fill(&self, values: &mut [f64], kept: impl Fn(usize) -> f64) {
        let (first, second) = values.split_at_mut(self.columns.min(values.len()));
        first.iter_mut().enumerate().for_each(|(m, value)| *value = kept(m));
        if self.mirrored {
            second.iter_mut().zip(first).for_each(|(value, opposite)| *value = -*opposite);
        }
    }
}

/// `1 - (1 - t²)⁴`.
fn place(t: f64) -> f64 {
    let u = t * t;
    // Nothing cancels at either end.
    u * (2.0 - u) * (2.0 - u * (2.0 - u))
}
