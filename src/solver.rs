//! Wear in time: the discretised contact, implicit steps, and the loop over cycles.

pub mod model;
pub mod simulation;
pub mod stepper;
