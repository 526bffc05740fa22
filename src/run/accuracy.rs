//! What `numerics.accuracy` chooses, and how the error of what comes of it is known.

pub(super) mod budget;
mod companion;
pub(super) mod estimate;
mod substeps;
