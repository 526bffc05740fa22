//! Fretting wear of elastically graded media.
pub mod closed_form;
pub mod contact;
pub mod error;
pub mod friction;
pub mod half_space;
pub mod indenter;
pub mod loading;
pub mod quadrature;
pub mod report;
pub mod roots;
pub mod scene;
pub mod snapshot;
pub mod stick_slip;
pub mod wear;

pub use error::{Error, Result};
