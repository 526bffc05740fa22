//! Many scenes: sweeps and their jobs on clusters, the universality claim, the trade-off of time and error, wear maps.

mod batch;
pub mod calibration;
mod many;
pub mod submit;
pub mod sweep;
pub mod tradeoff;
pub mod universality;
pub mod wear_map;

pub use batch::{Progress, most_threads};
pub use many::{Watch, on_threads, run_many, run_many_sharing};
