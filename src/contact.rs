//! The contact of one indenter with one half-space: profiles, stiffness, the stick zone, one spring in a cycle, and closed forms.

pub mod closed_form;
pub mod half_space;
pub mod indenter;
mod initial;
mod loop_ratios;
pub mod slip_depth;
pub mod spring;
pub mod stick_slip;
pub mod transforms;
pub use initial::*;
