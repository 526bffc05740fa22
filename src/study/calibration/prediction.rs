//! What the model predicts for the data, with as few runs as serve.
//!
//! A coefficient of wear stretches the clock and does nothing else, where nothing but wear depends on the number of cycles: with
//! `t = k_w N`
//!
//! ```text
//! dw/dN = k_w F(w)     →     dw/dt = F(w)
//! ```
//!
//! so that one run, read off at `t`, serves all its values. Energies since the start are sums over cycles and go with `1/k_w`.

use std::collections::HashMap;

use crate::data::{Snapshot, StopReason, largest};
use crate::error::{Error, Result};
use crate::laws::history::History;
use crate::run::{Shared, Simulation, Stop};
use crate::scene::{Calibration, Measured, Scene, Stepper};

/// Snapshots in a factor of ten of time, between which cubics in `ln t` are right to 1e-5.
const PER_DECADE: f64 = 16.0;
/// How far before the first and beyond the last measurement a run with a clock is looked at: as long as starts are tried, and then.
const FAR: [f64; 2] = [0.01, 100.0];
const CLOSE: [f64; 2] = [0.3, 3.0];
/// How much a time may miss the first snapshot.
const ROUNDING: f64 = 1e-9;
/// Most numbers of cycles at which a run without a clock is looked at one by one.
const MOST_TIMES: usize = 200;
/// Most runs of a data set that are remembered.
const MOST_KEPT: usize = 500;

/// Runs of the model for all data sets.
pub(super) struct Predictor<'a> {
    calibration: &'a Calibration,
    shared: Shared,
    /// Accuracy of the runs of each data set.
    pub(super) accuracy: Vec<f64>,
    /// The unknown that stretches the clock of a data set.
    clocks: Vec<Option<usize>>,
    kept: Vec<HashMap<Vec<u64>, Vec<Trajectory>>>,
    /// What times of a clock a run serves, over those of the data.
    reach: [f64; 2],
    /// Number of runs so far.
    pub(super) runs: u64,
    /// The last reason why there was no prediction.
    pub(super) trouble: Option<Error>,
    /// Largest worn volume, depth or other value that errors of a data set are relative to.
    pub(super) scales: Vec<f64>,
}

/// What a run came to at times, as far as one kind of data needs it.
#[derive(Debug, Clone)]
struct Trajectory {
    /// `k_w N`, or `N` without a clock, increasing from 0, shape `(time,)`.
    times: Vec<f64>,
    /// Shape `(time, value)`.
    rows: Vec<Vec<f64>>,
    /// Radii of the depths of a scar, m.
    radius: Vec<f64>,
    /// Whether nothing wears after the last time.
    is_over: bool,
    /// Value that the accuracy of the run is relative to.
    scale: f64,
}

impl<'a> Predictor<'a> {
    /// # Errors
    /// [`Error::Scene`] if one of the scenes is not valid at these values.
    pub(super) fn new(
        calibration: &'a Calibration,
        values: &[f64],
        accuracy: f64,
        stop: &Stop,
    ) -> Result<Self> {
        let count = calibration.data().len();
        let mut this = Self {
            calibration,
            shared: Shared::without_checkpoints(stop),
            accuracy: vec![accuracy; count],
            clocks: vec![None; count],
            kept: vec![HashMap::new(); count],
            reach: FAR,
            runs: 0,
            trouble: None,
            scales: vec![0.0; count],
        };
        if calibration.has_scene() {
            for data in 0..count {
                this.clocks[data] = this.clock(data, values)?;
            }
        }
        Ok(this)
    }

    /// The same data from runs of another accuracy, each at its own numbers of cycles.
    pub(super) fn finer(&self, factor: f64) -> Self {
        let count = self.accuracy.len();
        Self {
            calibration: self.calibration,
            shared: self.shared.clone(),
            accuracy: self.accuracy.iter().map(|it| it * factor).collect(),
            clocks: vec![None; count],
            kept: vec![HashMap::new(); count],
            reach: FAR,
            runs: 0,
            trouble: None,
            scales: self.scales.clone(),
        }
    }

    /// Asks for runs as accurate as these.
    pub(super) fn refine(&mut self, accuracy: &[f64]) {
        for (data, accuracy) in accuracy.iter().enumerate() {
            if *accuracy < self.accuracy[data] {
                self.accuracy[data] = *accuracy;
                self.kept[data].clear();
            }
        }
    }

    /// Looks no farther than near the place that was found.
    pub(super) fn stay_close(&mut self) {
        self.reach = CLOSE;
    }

    /// Whether all runs were asked to stop.
    pub(super) fn is_stopped(&self) -> bool {
        self.shared.stop.is_stopped()
    }

    /// Whether an unknown costs no runs.
    pub(super) fn is_free(&self, unknown: usize) -> bool {
        !self.calibration.has_scene()
            || self
                .clocks
                .iter()
                .zip(self.calibration.data())
                .all(|(clock, data)| *clock == Some(unknown) || data.measured == Measured::VolumeOverEnergy)
    }

    /// The unknown that does nothing but stretch the clock of a data set.
    fn clock(&self, data: usize, values: &[f64]) -> Result<Option<usize>> {
        let unknowns = self.calibration.unknowns();
        let scene = |values: &[f64]| self.calibration.scene(data, values, &[1.0], self.accuracy[data]);
        let one = scene(values)?;
        let conditions = one.conditions();
        let steady = conditions.friction_history == History::Constant
            && conditions.friction.along_energy() == History::Constant
            && conditions.wear_history == History::Constant
            && conditions.blocks.is_empty()
            && !conditions.wears_from_rest
            && one.numerics().stepper != Stepper::EveryCycle;
        if self.calibration.data()[data].measured == Measured::VolumeOverEnergy || !steady {
            return Ok(None);
        }
        for (place, unknown) in unknowns.iter().enumerate() {
            let is_coefficient = unknown.key.starts_with("wear.") && unknown.key.ends_with(".coefficient");
            if !is_coefficient || !unknown.tied.is_empty() {
                continue;
            }
            let mut doubled = values.to_vec();
            doubled[place] *= 2.0;
            let is_scaled =
                scene(&doubled).is_ok_and(|two| *two.conditions().wear == *conditions.wear.scaled(2.0));
            if is_scaled {
                return Ok(Some(place));
            }
        }
        Ok(None)
    }

    /// What is predicted where a data set was measured, shape `(value,)`, in the unit of its values; none where there is no run, for a reason that
    /// is kept.
    ///
    /// # Arguments
    /// * `values` -- of the unknowns, in SI
    /// * `centre` -- of a scar or a loop, m
    pub(super) fn predict(&mut self, data: usize, values: &[f64], centre: f64) -> Option<Vec<f64>> {
        let predicted = self.predicted(data, values, centre);
        predicted.map_err(|error| self.trouble = Some(error)).ok()
    }

    fn predicted(&mut self, data: usize, values: &[f64], centre: f64) -> Result<Vec<f64>> {
        let calibration = self.calibration;
        let set = &calibration.data()[data];
        if set.measured == Measured::VolumeOverEnergy {
            let slope =
                if calibration.has_scene() { self.volume_per_energy(data, values)? } else { values[0] };
            return Ok(set.at.iter().map(|energy| slope * energy).collect());
        }
        let pace = self.clocks[data].map_or(1.0, |clock| values[clock]);
        let times = self.span(data).map(|cycles| pace * cycles);
        let key = self.key(data, values);
        if !self.kept[data].get(&key).is_some_and(|all| all.iter().any(|it| it.serves(times))) {
            let found = self.run(data, values)?;
            if self.kept[data].len() >= MOST_KEPT {
                self.kept[data].clear();
            }
            self.kept[data].entry(key.clone()).or_default().push(found);
        }
        let all = &self.kept[data][&key];
        // The last is the one that was just made, if none did before.
        let run = all.iter().find(|it| it.serves(times)).unwrap_or(&all[all.len() - 1]);
        self.scales[data] = run.scale;
        Ok(match set.measured {
            Measured::Scar => {
                let depth = run.row(pace * set.cycles);
                let at = |x: &f64| -set.share * linear(&run.radius, &depth, (x - centre).abs());
                set.at.iter().map(at).collect()
            }
            Measured::Loop => along_loop(&run.row(pace * set.cycles), &set.at, centre),
            Measured::DissipatedEnergy => set.at.iter().map(|n| run.value(pace * n) / pace).collect(),
            _ => set.at.iter().map(|n| run.value(pace * n)).collect(),
        })
    }

    /// First and last number of cycles, above zero, at which a data set was measured.
    fn span(&self, data: usize) -> [f64; 2] {
        let set = &self.calibration.data()[data];
        match set.measured.is_over_cycles() {
            true => {
                let worn = set.at.iter().copied().filter(|it| *it > 0.0);
                [worn.fold(f64::INFINITY, f64::min), largest(&set.at)]
            }
            false => [set.cycles; 2],
        }
    }

    /// The values that a run depends on.
    fn key(&self, data: usize, values: &[f64]) -> Vec<u64> {
        let own = values.iter().enumerate().filter(|(place, _)| self.clocks[data] != Some(*place));
        own.map(|(_, value)| value.to_bits()).collect()
    }

    fn volume_per_energy(&self, data: usize, values: &[f64]) -> Result<f64> {
        let scene = self.calibration.scene(data, values, &[1.0], self.accuracy[data])?;
        let conditions = scene.conditions();
        let friction = conditions.friction.coefficient();
        conditions.wear.volume_per_energy(friction).ok_or_else(|| Error::Inconsistent {
            what: "wear",
            why: "worn volumes over measured energies need a law of wear in proportion to the energy; give wear.dissipated-energy, or wear.archard under Coulomb's friction".into(),
        })
    }

    fn run(&mut self, data: usize, values: &[f64]) -> Result<Trajectory> {
        let set = &self.calibration.data()[data];
        let [first, last] = self.span(data);
        let cycles = match self.clocks[data] {
            Some(place) => {
                let [least, most] = self.calibration.unknowns()[place].bounds.map(|it| it / values[place]);
                let [before, beyond] = self.reach;
                spread(first * before.max(least).min(1.0), last * beyond.min(most).max(1.0))
            }
            None => {
                let mut own: Vec<f64> = set.at.iter().copied().filter(|it| *it > 0.0).collect();
                own.sort_by(f64::total_cmp);
                own.dedup();
                match set.measured.is_over_cycles() {
                    false => vec![last],
                    true if own.len() <= MOST_TIMES => own,
                    true => spread(first, last),
                }
            }
        };
        let found = self.run_over(data, values, &cycles);
        match found {
            // What a long run cannot do a shorter one may.
            Err(_) if cycles.last() > Some(&last) => self.run_over(data, values, &spread(first, last)),
            found => found,
        }
    }

    fn run_over(&mut self, data: usize, values: &[f64], cycles: &[f64]) -> Result<Trajectory> {
        let measured = self.calibration.data()[data].measured;
        let scene: Scene = self.calibration.scene(data, values, cycles, self.accuracy[data])?;
        self.runs += 1;
        let results = Simulation::sharing(&scene, &self.shared)?.run()?;
        if !results.is_complete() {
            return Err(Error::NotConverged { what: "calibration", why: "it was stopped".into() });
        }
        let pace = self.clocks[data].map_or(1.0, |clock| values[clock]);
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
        let limit = results.limit();
        let scale = match measured {
            Measured::WearVolume => limit.map_or(0.0, |it| it.wear_volume()),
            Measured::WearDepth | Measured::Scar => limit.map_or(0.0, |it| it.wear_depth_max()),
            _ => 0.0,
        };
        let reached = rows.iter().flatten().fold(0.0, |largest: f64, it| largest.max(it.abs()));
        Ok(Trajectory {
            times: snapshots.iter().map(|it| it.cycles * pace).collect(),
            rows,
            radius,
            is_over: results.stop_reason() != StopReason::End,
            scale: if measured == Measured::DissipatedEnergy { reached / pace } else { scale.max(reached) },
        })
    }
}

/// Numbers of cycles in constant ratio.
fn spread(first: f64, last: f64) -> Vec<f64> {
    let count = ((last / first).log10() * PER_DECADE).ceil().max(4.0);
    (0..=count as usize).map(|i| last * (first / last).powf(1.0 - i as f64 / count)).collect()
}

impl Trajectory {
    /// Whether it holds all between two times.
    fn serves(&self, [first, last]: [f64; 2]) -> bool {
        let begins = self.times.get(1).is_some_and(|it| *it <= first * (1.0 + ROUNDING));
        begins && (self.is_over || self.times.last().is_some_and(|it| *it >= last * (1.0 - ROUNDING)))
    }

    fn value(&self, time: f64) -> f64 {
        self.weights(time).iter().map(|(place, weight)| weight * self.rows[*place][0]).sum()
    }

    fn row(&self, time: f64) -> Vec<f64> {
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
fn linear(x: &[f64], y: &[f64], at: f64) -> f64 {
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
fn along_loop(points: &[f64], at: &[f64], centre: f64) -> Vec<f64> {
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
