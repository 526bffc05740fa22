//! What resolved periods take, counted as they are passed.

use std::sync::atomic::{AtomicU64, Ordering};

use super::motion::Motion;
use super::schedule::CycleLoading;
use super::{Model, State};
use crate::contact::spring::searched_stick_compression;
use crate::laws::friction::FrictionLaw;
use crate::laws::path::Path;
use crate::numerics::whole_contact::Touching;

/// Nanoseconds of one core, as fitted to 60 runs of all kinds: of a substep through which a spring is passed along a line, where it turns, and where slip begins
/// at a static limit; of a column of slip at a spring and of one of loads, each by what is done with it there, by the response of a table, by steps, and in gross slip; and of either by each other spring
/// that it is carried to.
const BY_SUBSTEP: [f64; 3] = [11.0, 17.0, 40.0];
const BY_COLUMN: [f64; 3] = [15.0, 10.0, 27.0];
const BY_LOAD: [f64; 3] = [6.0, 10.0, 11.0];
const BY_PAIR: f64 = 0.055;

/// The same of a column of loads at a point between nodes, in gross slip.
const BY_POINT: f64 = 30.0;

/// The same of a column of loads by each other spring to which debris spreads it.
const BY_SPREAD: f64 = 0.55;

/// Nanoseconds of one core that a jump of the edge of stick between two blocks takes, on a profile in closed form and on one that is a table: what the ground that
/// it passes has risen by is carried to wherever the contact edge can be.
const BY_JUMP: [f64; 2] = [2.3e6, 1e6];

/// Work counted so far, nanoseconds of one core, about. Whole numbers of what was done make it, so that it is the same on every machine.
#[derive(Debug, Default)]
pub(super) struct Meter(AtomicU64);

impl Clone for Meter {
    fn clone(&self) -> Self {
        Self(AtomicU64::new(self.read()))
    }
}

impl Meter {
    fn read(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    fn add(&self, work: f64) {
        self.0.fetch_add(work as u64, Ordering::Relaxed);
    }
}

impl Model {
    /// Work of the resolved periods so far, nanoseconds of one core, about: the same on every machine.
    pub fn work_counted(&self) -> u64 {
        self.meter.read()
    }

    /// Counts substeps of a path through which springs were passed.
    pub(super) fn count_substeps(&self, substeps: usize, path: &Path, law: &dyn FrictionLaw) {
        let [straight, turning, jumping] = BY_SUBSTEP;
        let each = match law.static_factor() == 1.0 {
            true if path.is_straight() => straight,
            true => turning,
            false => jumping,
        };
        self.meter.add(each * substeps as f64);
    }

    /// Compression at the edge of stick in a cycle, m, as [`CycleLoading::slip_compression`]; counts the periods of the search for it.
    pub(super) fn slip_compression_of(&self, loading: &CycleLoading) -> f64 {
        let ratio = self.contact.half_space().stiffness_ratio();
        let Some(path) = &loading.path else { return loading.slip_compression(ratio) };
        let (compression, substeps) =
            searched_stick_compression(path, &*loading.friction, ratio, loading.slipped);
        self.count_substeps(substeps, path, &*loading.friction);
        compression
    }

    /// Counts the jump of the edge of stick from a squared radius, m², to where a block begins, if it is one.
    pub fn count_jump(&self, from: Option<f64>, state: &State) {
        let table = self.contact.equivalent_profile().end_of_table().is_some();
        if state.stick.as_ref().map(|it| it.area) != from {
            self.meter.add(BY_JUMP[usize::from(table)]);
        }
    }

    /// Counts columns of slip and of loads that are carried to the surface, so many times.
    pub(super) fn count_columns(&self, loading: &CycleLoading, motion: &Motion, times: usize) {
        if loading.path.is_none() {
            return;
        }
        let [springs, slips, loads] =
            [self.springs(), motion.free.len(), motion.load.ncols()].map(|it| it as f64);
        let kind = match loading.steps {
            Some(_) => 1,
            None if self.gross().is_some() => 2,
            None => 0,
        };
        let [at_spring, of_load] = [BY_COLUMN[kind], BY_LOAD[kind]];
        let carried = BY_PAIR * springs;
        let spread = if loading.wear.spreading().is_some() { BY_SPREAD * springs } else { 0.0 };
        let by_slopes = self.gross().is_some_and(|it| it.asks_between_nodes())
            && self.bearing_in(loading).in_proportion().is_none();
        let pressed =
            if by_slopes { Touching::POINTS as f64 * (BY_POINT + carried) } else { of_load + carried };
        let by_spring = slips * (at_spring + carried) + loads * (pressed + spread);
        self.meter.add(times as f64 * springs * by_spring);
    }
}
