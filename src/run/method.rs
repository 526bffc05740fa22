//! How a scene is computed: what the program chose, or was told by hand.

use serde::Serialize;

use super::mesh::operator_bytes;
use crate::solver::model::Model;
use crate::solver::simulation::Simulation;

/// How a scene is computed; the fields are keys of the JSON of `fretwear check`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Method {
    /// How the slip of a cycle is found: `closed-form`, or `resolved` where a spring's state depends on its way through the cycle.
    pub cycle: &'static str,
    /// Where the springs are: over the `slip-annulus`, or over the `whole-contact` in gross slip.
    pub mesh: &'static str,
    /// How many there are to begin with; a run that turns out less accurate than was asked for is made anew on more.
    pub springs: usize,
    /// Method of time stepping.
    pub time_stepping: &'static str,
    /// How repeated blocks are passed through: `averaged` over passes, as in their mean cycle, `stepped`, one after the other, or `stepped-at-first`, until passes are
    /// short beside what is left of wear; none without.
    pub repeated_blocks: Option<&'static str>,
    /// The edge of stick: `fixed`; `moving`, with the springs; `on-mesh`, where it moves over springs that stay; or `none` in gross slip.
    pub stick_edge: &'static str,
    /// Memory of the transforms and of Newton's matrix, bytes, about; some 15 MB of the program itself come on top.
    pub memory_expected: f64,
}

impl Method {
    /// That of a run before its first step.
    pub(super) fn of(simulation: &Simulation) -> Self {
        let model = simulation.model();
        let (springs, in_gross_slip) = (model.springs(), model.gross().is_some());
        let backend = Model::backend(model.contact(), model.schedule(), springs);
        Self {
            cycle: if model.schedule().resolves() { "resolved" } else { "closed-form" },
            mesh: if in_gross_slip { "whole-contact" } else { "slip-annulus" },
            springs,
            time_stepping: simulation.stepper_name(),
            repeated_blocks: match model.schedule() {
                schedule if schedule.averages_from() == 0.0 => Some("averaged"),
                schedule if schedule.recurs() && simulation.may_come_to_average() => Some("stepped-at-first"),
                schedule if schedule.recurs() => Some("stepped"),
                _ => None,
            },
            stick_edge: match model.moving() {
                Some(_) => "moving",
                None if in_gross_slip => "none",
                None if model.follows_ground_at_rest() => "on-mesh",
                None => "fixed",
            },
            memory_expected: operator_bytes(backend, springs),
        }
    }
}
