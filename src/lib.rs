//! Fretting wear of elastically graded media.
pub mod error;
pub mod half_space;
pub mod indenter;
pub mod snapshot;

pub use error::{Error, Result};
