//! What runs of one process have in common: transforms, and whether they are to stop.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crate::solver::model::OperatorStore;

/// Stops runs from elsewhere: another thread, a callback, a signal handler. Clones are the same token.
///
/// ```
/// let stop = fretwear::Stop::default();
/// let other = stop.clone();
/// other.stop();
/// assert!(stop.is_stopped());
/// ```
#[derive(Debug, Clone, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Asks all runs that hold this token to stop at their next step.
    pub fn stop(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether they were asked to.
    pub fn is_stopped(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// The flag itself, for a signal handler: true stops.
    pub fn flag(&self) -> &Arc<AtomicBool> {
        &self.0
    }
}

/// What runs of many scenes in one process share.
#[derive(Debug, Clone, Default)]
pub struct Shared {
    /// The transforms.
    pub operators: OperatorStore,
    /// Stops all of them.
    pub stop: Stop,
    /// Wall time between checkpoints instead of the scene's.
    pub checkpoint_interval: Option<Duration>,
}

impl Shared {
    /// For runs that are kept where they are stopped and where they end, not in between.
    pub fn without_checkpoints(stop: &Stop) -> Self {
        Self { stop: stop.clone(), checkpoint_interval: Some(Duration::MAX), ..Self::default() }
    }
}
