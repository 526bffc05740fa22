//! Fretting wear of elastically graded media.
pub mod error;
pub mod half_space;
pub mod indenter;
pub mod quadrature;

pub use error::{Error, Result};
