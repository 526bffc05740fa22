//! Fretting wear of elastically graded media.
pub mod abel;
pub mod chebyshev;
pub mod closed_form;
pub mod contact;
pub mod error;
pub mod friction;
pub mod grid;
pub mod half_space;
pub mod indenter;
pub mod linear;
pub mod loading;
pub mod model;
pub mod progress;
pub mod quadrature;
pub mod report;
pub mod roots;
pub mod run;
pub mod scene;
pub mod simulation;
pub mod slip_depth;
pub mod snapshot;
pub mod stepper;
pub mod stick_slip;
pub mod wear;

pub use error::{Error, Result};
