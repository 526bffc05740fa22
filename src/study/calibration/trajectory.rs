//! What a run came to at times, as far as one kind of data needs it.

use crate::data::{Snapshot, StopReason};
use crate::numerics::linear::largest;
use crate::run::Results;
use crate::scene::Measured;

/// How much a time may miss the first snapshot.
const ROUNDING: f64 = 1e-9;

/// What a run came to at times, as far as one kind of data needs it.
#[derive(Debug, Clone)]
pub(super) struct Trajectory {
    /// `k_w N`, or `N` without a clock, increasing from 0, shape `(time,)`.
    times: Vec<f64>,
    /// Shape `(time, value)`.
    rows: Vec<Vec<f64>>,
    /// Radii of the depths of a scar, m.
    pub(super) radius: Vec<f64>,
    /// Whether nothing wears after the last time.
    is_over: bool,
}

impl Trajectory {
    /// What a kind of data needs of a run.
    ///
    /// # Arguments
    /// * `pace` -- time over the number of cycles
    pub(super) fn new(measured: Measured, results: &Results, pace: f64) -> Self {
        let snapshots = results.snapshots();
        let of = |it: &Snapshot| match measured {
            Measured::WearVolume | Measured::VolumeOverEnergy => vec![it.wear_volume],
            Measured::WearDepth => vec![largest(&it.wear_depth)],
            Measured::ContactRadius => vec![it.contact_radius],
            Measured::TangentialForce => vec![it.tangential_force],
            Measured::CycleEnergy => vec![it.cycle_energy],
            Measured::DissipatedEnergy => vec![it.dissipated_energy * pace],
            Measured::Scar => {
                let inner = if it.permanent_stick_radius > 0.0 { 0.0 } else { it.wear_depth[0] };
                [&[inner], &it.wear_depth[..], &[0.0]].concat()
            }
            Measured::Loop => [&it.loop_displacement[..], &it.loop_force[..]].concat(),
        };
        let rows: Vec<Vec<f64>> = snapshots.iter().map(of).collect();
        let nodes = results.radius();
        let (inner, outer) = (nodes.first().copied().unwrap_or(0.0), nodes.last().copied().unwrap_or(0.0));
        let radius = match measured {
            Measured::Scar => [&[inner * (1.0 - 1e-9)], nodes, &[outer * (1.0 + 1e-9)]].concat(),
            _ => vec![],
        };
        Self {
            times: snapshots.iter().map(|it| it.cycles * pace).collect(),
            rows,
            radius,
            is_over: results.stop_reason() != StopReason::End,
        }
    }

    /// Whether it holds all between two times.
    pub(super) fn serves(&self, [first, last]: [f64; 2]) -> bool {
        let begins = self.times.get(1).is_some_and(|it| *it <= first * (1.0 + ROUNDING));
        begins && (self.is_over || self.times.last().is_some_and(|it| *it >= last * (1.0 - ROUNDING)))
    }

    /// The only value at a time.
    pub(super) fn value(&self, time: f64) -> f64 {
        self.weights(time).iter().map(|(place, weight)| weight * self.rows[*place][0]).sum()
    }

    /// All values at a time, shape `(value,)`.
    pub(super) fn row(&self, time: f64) -> Vec<f64> {
        let mut row = vec![0.0; self.rows[0].len()];
        for (place, weight) in self.weights(time) {
            row.iter_mut().zip(&self.rows[place]).for_each(|(sum, it)| *sum += weight * it);
        }
        row
    }

    /// Snapshots and their weights at a time: a cubic in `ln t` through four of them, a straight line in `t` from the start to the first.
    fn weights(&self, time: f64) -> Vec<(usize, f64)> {
        let after = self.times.partition_point(|it| *it < time * (1.0 - ROUNDING));
        let last = self.times.len() - 1;
        if after > last {
            return vec![(last, 1.0)];
        }
        if (self.times[after] - time).abs() <= ROUNDING * time {
            return vec![(after, 1.0)];
        }
        if after <= 1 {
            let part = time / self.times[1];
            return vec![(0, 1.0 - part), (1, part)];
        }
        let begin = (after - 1).saturating_sub(1).max(1).min(last.saturating_sub(3).max(1));
        let places: Vec<usize> = (begin..=(begin + 3).min(last)).collect();
        let at = |place: usize| self.times[place].ln();
        let weight = |place: usize| {
            let others = places.iter().filter(|other| **other != place);
            others.map(|other| (time.ln() - at(*other)) / (at(place) - at(*other))).product()
        };
        places.iter().map(|place| (*place, weight(*place))).collect()
    }
}

/// Linear between nodes, constant beyond them.
pub(super) fn linear(x: &[f64], y: &[f64], at: f64) -> f64 {
    let after = x.partition_point(|it| *it < at);
    match after {
        0 => y[0],
        after if after == x.len() => y[after - 1],
        after => {
            let part = (at - x[after - 1]) / (x[after] - x[after - 1]);
            y[after - 1] + part * (y[after] - y[after - 1])
        }
    }
}

/// Force along a loop at measured displacements, on the branch on which the displacement moves the same way.
///
/// # Arguments
/// * `points` -- displacements and then forces along one period; the last point is the first
/// * `at` -- measured displacements in the order of time
pub(super) fn along_loop(points: &[f64], at: &[f64], centre: f64) -> Vec<f64> {
    let (displacement, force) = points.split_at(points.len() / 2);
    // Each branch with increasing displacement.
    let branch = |rises: bool| {
        let mut found: Vec<(f64, f64)> = vec![];
        for i in 1..displacement.len() {
            if (displacement[i] > displacement[i - 1]) == rises {
                found.extend([(displacement[i - 1], force[i - 1]), (displacement[i], force[i])]);
            }
        }
        found.sort_by(|one, other| one.0.total_cmp(&other.0));
        found.dedup_by(|one, other| one.0 == other.0);
        found.into_iter().unzip::<f64, f64, Vec<f64>, Vec<f64>>()
    };
    let branches = [branch(false), branch(true)];
    let count = at.len();
    let force_at = |i: usize| {
        let rises = at[(i + 1) % count] > at[(i + count - 1) % count];
        let (x, y) = &branches[usize::from(rises)];
        if x.is_empty() { 0.0 } else { linear(x, y, at[i] - centre) }
    };
    (0..count).map(force_at).collect()
}
