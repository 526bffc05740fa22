//! The periodic motion of all springs on a path at constant indentation, once for a run.

use super::turns::Turns;
use super::{Neighbours, SpringCycle};
use crate::laws::path::Path;

/// Cells between no limit and the one that sticks.
const CELLS: usize = 1024;

/// Fewest cells that are worth it, and most numbers kept.
const FEWEST_CELLS: usize = 128;
const MOST_NUMBERS: usize = 1 << 23;

/// What springs slip in each step of a path at constant indentation, as a function of the limit `l` of their deflection alone.
///
/// Whatever the law of friction, how it changes with time and how far the spring is compressed, the limit is all that [`steady_cycle`](super::steady_cycle) knows
/// of it while static and kinetic strength are the same. With `l*` at which a spring sticks, the functions are tabulated over
///
/// ```text
/// l/l* = 1 - (1 - t²)⁴,    t even from 0 to 1
/// ```
///
/// and linear between: slip begins with a root on a circle, with a kink on an ellipse, and without a limit the spring turns fast. They are
/// second order in the cells but at kinks; on 1024 what a spring dissipates is good to `1e-4` of the amplitude times the path.
#[derive(Debug, Clone, PartialEq)]
pub struct Response {
    /// `l*`, m.
    largest: f64,
    cells: usize,
    turns: Turns,
    /// By node of the table: slip at the nodes of the steps, m, x and y in turn, then the energies.
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
        let (turns, largest) = (Turns::new(path, springs.is_mirrored()), springs.sticking());
        let width = 2 * turns.nodes() + ENERGIES;
        let cells = CELLS.min(MOST_NUMBERS / width);
        if cells < FEWEST_CELLS {
            return None;
        }
        let mut cycle = SpringCycle::default();
        let mut values = vec![0.0; (cells + 1) * width];
        for (node, values) in values.chunks_mut(width).take(cells).enumerate() {
            springs.pass(largest * place(node as f64 / cells as f64), &mut cycle);
            let (slip, energies) = values.split_at_mut(width - ENERGIES);
            turns.at_nodes(&cycle.slip[..turns.kept()], slip);
            energies.copy_from_slice(&[cycle.dissipation, cycle.work]);
        }
        Some(Self { largest, cells, turns, values })
    }

    /// Numbers for the slip of a period, x and y in turn.
    pub fn columns(&self) -> usize {
        2 * self.turns.nodes()
    }

    /// Whether the slip in a step is given at two nodes, of which one alone may be against the other.
    pub fn is_paired(&self) -> bool {
        self.turns.is_paired()
    }

    /// Slip in each step, or at its nodes, x and y in turn, m, shape `(columns,)`, with its derivative by the limit if that is asked for; returns
    /// dissipation and work over the tangential stiffness, m². Where the second half of a period is the opposite of the first, twice the first stands for both.
    ///
    /// # Arguments
    /// * `limit` -- of the deflection, m, at least 0
    pub fn at(&self, limit: f64, slip: &mut [f64], slope: Option<&mut [f64]>) -> [f64; 2] {
        let columns = self.columns();
        let width = columns + ENERGIES;
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
        let between = |(before, after): (&f64, &f64)| before + part * (after - before);
        let ends = || before.iter().zip(after);
        slip.iter_mut().zip(ends()).for_each(|(slip, ends)| *slip = between(ends));
        if let Some(slope) = slope {
            let per_limit = (distance * self.largest).recip();
            let slopes = ends().map(|(before, after)| per_limit * (after - before));
            slope.iter_mut().zip(slopes).for_each(|(to, slope)| *to = slope);
        }
        [0, 1].map(|m| between((&before[columns + m], &after[columns + m])))
    }
}

/// `1 - (1 - t²)⁴`.
fn place(t: f64) -> f64 {
    let u = t * t;
    // Nothing cancels at either end.
    u * (2.0 - u) * (2.0 - u * (2.0 - u))
}
