//! Whoever looks on at a run besides its recorder.

use super::recorder::snapshot;
use crate::data::Snapshot;
use crate::error::Result;
use crate::solver::simulation::{Flow, Observer, Simulation};

/// Called at each snapshot.
pub(super) type Watcher<'a> = Box<dyn FnMut(&Snapshot) + 'a>;

/// Whoever looks on besides the recorder.
pub(super) struct Onlookers<'a, 'b> {
    pub watchers: Vec<Watcher<'a>>,
    pub observer: Option<&'b mut dyn Observer>,
}

impl Onlookers<'_, '_> {
    /// Shows the snapshots of an attempt once more, which is the last one after all.
    pub(super) fn again(&mut self, snapshots: &[Snapshot]) {
        for watcher in &mut self.watchers {
            snapshots.iter().for_each(&mut *watcher);
        }
    }
}

impl Observer for Onlookers<'_, '_> {
    fn output(&mut self, simulation: &Simulation) -> Result<()> {
        if !self.watchers.is_empty() {
            let shown = snapshot(simulation);
            self.watchers.iter_mut().for_each(|watcher| watcher(&shown));
        }
        self.observer.as_mut().map_or(Ok(()), |observer| observer.output(simulation))
    }

    fn step(&mut self, simulation: &Simulation) -> Result<Flow> {
        self.observer.as_mut().map_or(Ok(Flow::Continue), |observer| observer.step(simulation))
    }
}
