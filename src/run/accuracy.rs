//! How the error of a run is estimated whose springs the program chose: by coarser runs of the same scene.

pub(super) mod companion;
pub(super) mod estimate;
mod substeps;
