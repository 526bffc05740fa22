//! One scene from its first cycle to its end: springs by accuracy, error estimate, snapshots, and a file where one is wanted.

use crate::data::StopReason;
use crate::solver::simulation::Outcome;

mod accuracy;
mod anew;
mod attempt;
mod budget;
mod cost;
#[cfg(feature = "hdf5")]
mod file;
mod limit;
mod memory;
mod mesh;
mod method;
mod onlookers;
mod parts;
mod passes;
mod plan;
pub mod readings;
mod ready;
mod recorder;
mod results;
mod rim;
mod shared;
mod simulation;

pub use cost::Expected;
#[cfg(feature = "hdf5")]
pub use file::{Resumed, Run};
#[cfg(feature = "hdf5")]
pub(crate) use file::{hash_of, is_of};
#[cfg(feature = "hdf5")]
pub(crate) use memory::memory_figure;
#[cfg(feature = "hdf5")]
pub(crate) use mesh::operator_bytes;
pub use method::Method;
pub use results::Results;
pub use shared::{Shared, Stop};
pub use simulation::Simulation;

impl From<Outcome> for StopReason {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::End => Self::End,
            Outcome::Rate => Self::Rate,
            Outcome::WornOut => Self::WornOut,
            Outcome::Unending => Self::Unending,
            Outcome::Interrupted => Self::Interrupted,
        }
    }
}
