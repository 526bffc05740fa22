//! What one save of a run stores.

use super::{Checkpoint, RunHeader, Snapshot, StopReason};

/// Everything that one save stores.
pub(super) struct Save<'a> {
    pub header: &'a RunHeader,
    pub snapshots: &'a [Snapshot],
    pub checkpoint: &'a Checkpoint,
    pub stop_reason: StopReason,
    /// Whether it reached its end.
    pub complete: bool,
}
