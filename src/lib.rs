//! Fretting wear of elastically graded media.
pub mod closed_form;
pub mod error;
pub mod half_space;
pub mod indenter;
pub mod quadrature;
pub mod roots;

pub use error::{Error, Result};
