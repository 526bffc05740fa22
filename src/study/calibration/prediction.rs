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

use super::journal::Runs;
use super::trajectory::{Trajectory, along_loop, linear};
use crate::error::{Domain, Error, Result};
use crate::laws::history::History;
use crate::numerics::linear::largest;
use crate::scene::{Calibration, Measured, Scene, Stepper};

/// Snapshots in a factor of ten of time, between which cubics in `ln t` are right to 1e-5.
const PER_DECADE: f64 = 16.0;
/// How far before the first and beyond the last measurement a run with a clock is looked at: as long as starts are tried, and then.
const FAR: [f64; 2] = [0.01, 100.0];
const CLOSE: [f64; 2] = [0.3, 3.0];
/// Most numbers of cycles at which a run without a clock is looked at one by one.
const MOST_TIMES: usize = 200;
/// Most runs of data sets of one scene that are remembered.
const MOST_KEPT: usize = 500;

/// Runs of the model for all data sets.
pub(super) struct Predictor<'a> {
    calibration: &'a Calibration,
    runs_of: Runs<'a>,
    /// Accuracy of the runs of each data set.
    pub(super) accuracy: Vec<f64>,
    /// The unknown that stretches the clock of a data set.
    clocks: Vec<Option<usize>>,
    /// The data sets of the same scene, of which the first keeps the runs.
    companions: Vec<Vec<usize>>,
    kept: Vec<HashMap<Vec<u64>, Vec<Together>>>,
    /// What times of a clock a run serves, over those of the data.
    reach: [f64; 2],
    /// Number of runs so far.
    pub(super) runs: u64,
    /// The last reason why there was no prediction.
    pub(super) trouble: Option<Error>,
    /// A file that cannot be written, which ends all.
    pub(super) fatal: Option<Error>,
}

/// One run, as the data sets of its scene need it: their places, and what it came to for each.
type Together = Vec<(usize, Trajectory)>;

impl<'a> Predictor<'a> {
    /// # Errors
    /// [`Error::Scene`] if one of the scenes is not valid at these values.
    pub(super) fn new(
        calibration: &'a Calibration,
        values: &[f64],
        accuracy: f64,
        runs_of: Runs<'a>,
    ) -> Result<Self> {
        let count = calibration.data().len();
        let companions = (0..count).map(|data| calibration.companions(data)).collect();
        let mut this = Self {
            calibration,
            runs_of,
            companions,
            accuracy: vec![accuracy; count],
            clocks: vec![None; count],
            kept: vec![HashMap::new(); count],
            reach: FAR,
            runs: 0,
            trouble: None,
            fatal: None,
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
            runs_of: self.runs_of.clone(),
            companions: self.companions.clone(),
            accuracy: self.accuracy.iter().map(|it| it * factor).collect(),
            clocks: vec![None; count],
            kept: vec![HashMap::new(); count],
            reach: FAR,
            runs: 0,
            trouble: None,
            fatal: None,
        }
    }

    /// Asks for runs as accurate as these.
    pub(super) fn refine(&mut self, accuracy: &[f64]) {
        for (data, accuracy) in accuracy.iter().enumerate() {
            if *accuracy < self.accuracy[data] {
                self.accuracy[data] = *accuracy;
                self.kept[self.companions[data][0]].clear();
            }
        }
    }

    /// Looks no farther than near the place that was found.
    pub(super) fn stay_close(&mut self) {
        self.reach = CLOSE;
    }

    /// Whether all runs were asked to stop, or cannot go on.
    pub(super) fn is_stopped(&self) -> bool {
        self.runs_of.is_stopped() || self.fatal.is_some()
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
        if self.fatal.is_some() {
            return None;
        }
        let predicted = self.predicted(data, values, centre);
        let keep = |error: Error| match error.domain() {
            Domain::File => self.fatal = Some(error),
            _ => self.trouble = Some(error),
        };
        predicted.map_err(keep).ok()
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
        let (key, first) = (self.key(data, values), self.companions[data][0]);
        let own = |it: &'_ Together| it.iter().position(|(place, _)| *place == data);
        let serves = |it: &Together| own(it).is_some_and(|place| it[place].1.serves(times));
        if !self.kept[first].get(&key).is_some_and(|all| all.iter().any(serves)) {
            let found = self.run(data, values)?;
            if self.kept[first].len() >= MOST_KEPT {
                self.kept[first].clear();
            }
            self.kept[first].entry(key.clone()).or_default().push(found);
        }
        let all = &self.kept[first][&key];
        // The last is the one that was just made, if none did before.
        let together = all.iter().find(|it| serves(it)).unwrap_or(&all[all.len() - 1]);
        let run = &together[own(together).expect("a run has all data sets of its scene")].1;
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

    /// The run that serves a data set and all others of its scene.
    fn run(&mut self, data: usize, values: &[f64]) -> Result<Together> {
        let companions = self.companions[data].clone();
        let spans: Vec<[f64; 2]> = companions.iter().map(|it| self.span(*it)).collect();
        let first = spans.iter().map(|it| it[0]).fold(f64::INFINITY, f64::min);
        let last = spans.iter().map(|it| it[1]).fold(0.0, f64::max);
        let cycles = match self.clocks[data] {
            Some(place) => {
                let [least, most] = self.calibration.unknowns()[place].bounds.map(|it| it / values[place]);
                let [before, beyond] = self.reach;
                spread(first * before.max(least).min(1.0), last * beyond.min(most).max(1.0))
            }
            None => self.times(&companions),
        };
        let found = self.run_over(&companions, values, &cycles);
        match found {
            // What a long run cannot do a shorter one may.
            Err(_) if cycles.last() > Some(&last) && !self.is_stopped() => {
                self.run_over(&companions, values, &spread(first, last))
            }
            found => found,
        }
    }

    /// The numbers of cycles at which data sets were measured, increasing; of many, some in constant ratio.
    fn times(&self, companions: &[usize]) -> Vec<f64> {
        let of = |data: &usize| -> Vec<f64> {
            let [first, last] = self.span(*data);
            let set = &self.calibration.data()[*data];
            match set.measured.is_over_cycles() {
                false => vec![last],
                true if set.at.len() <= MOST_TIMES => set.at.iter().copied().filter(|it| *it > 0.0).collect(),
                true => spread(first, last),
            }
        };
        let mut all: Vec<f64> = companions.iter().flat_map(of).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    fn run_over(&mut self, companions: &[usize], values: &[f64], cycles: &[f64]) -> Result<Together> {
        let first = companions[0];
        let accuracy = companions.iter().map(|it| self.accuracy[*it]).fold(f64::INFINITY, f64::min);
        let scene: Scene = self.calibration.scene(first, values, cycles, accuracy)?;
        self.runs += 1;
        let results = self.runs_of.run(&scene)?;
        if !results.is_complete() {
            return Err(Error::NotConverged { what: "calibration", why: "it was stopped".into() });
        }
        let pace = self.clocks[first].map_or(1.0, |clock| values[clock]);
        let of =
            |data: &usize| (*data, Trajectory::new(self.calibration.data()[*data].measured, &results, pace));
        Ok(companions.iter().map(of).collect())
    }
}

/// Numbers of cycles in constant ratio.
fn spread(first: f64, last: f64) -> Vec<f64> {
    let count = ((last / first).log10() * PER_DECADE).ceil().max(4.0);
    (0..=count as usize).map(|i| last * (first / last).powf(1.0 - i as f64 / count)).collect()
}
