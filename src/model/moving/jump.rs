//! A jump of the edge of stick between two blocks.

use super::StickEdge;
use crate::error::Result;
use crate::model::{Fields, Model, Past, Place, State};
use crate::roots::bracketed;

/// Steps of the integrals over the ground that comes to rest in a jump of the edge of stick.
const JUMP_STEPS: usize = 1000;

impl Model {
    /// The state in which a new block begins: where the edge of stick jumps outwards, the mesh begins anew there.
    ///
    /// # Errors
    /// [`Error::NotConverged`](crate::Error::NotConverged) if no spring has the compression at which stick would end.
    pub fn begin_block(&self, state: State) -> Result<State> {
        let (Some(moving), Some(stick)) = (&self.moving, &state.stick) else { return Ok(state) };
        let drive = self.schedule.drive(state.cycles, state.cycles);
        let compression = drive.slip_compression(self.contact.half_space().stiffness_ratio());
        let before = self.contact.indentation() - stick.depth;
        if !moving.jumps || compression >= before {
            return Ok(state);
        }
        let profile = self.contact.equivalent_profile();
        let exponent = 1.0 + profile.grading();
        let mut on_springs = state.compression.clone();
        on_springs.push(0.0);
        // Next to the old edge, where springs may have lost their load within the first cell, the first spring's.
        let nodes = &self.operators.abel.nodes()[1..];
        let at = |x: f64| match x {
            x if x < nodes[0] => on_springs[0] + (before - on_springs[0]) * (1.0 - x / nodes[0]),
            x => self.between_springs(&on_springs, x),
        };
        let part = bracketed(|x| at(x) - compression, 0.0, 1.0, 0.0)?;
        let (mut left_behind, mut load) = (stick.left_behind.clone(), stick.load);
        let height = |x: f64| {
            let squared = stick.area + state.edge * x;
            self.contact.indentation() - at(x) - profile.value(squared.sqrt())
        };
        for step in 0..JUMP_STEPS {
            // Denser next to the old edge, as the springs are.
            let end = |i: usize| part * (i as f64 / JUMP_STEPS as f64).powi(4);
            let (low, high) = (end(step), end(step + 1));
            let middle = stick.area + 0.5 * state.edge * (low + high);
            let rise = height(high) - height(low);
            for (value, squared) in left_behind.iter_mut().zip(moving.stations()) {
                *value -= rise * self.unworn.at_stick(middle, 1.0, squared - middle).limit_slip;
            }
            load += 0.5
                * state.edge
                * (high - low)
                * at(0.5 * (low + high))
                * middle.powf(0.5 * (exponent - 2.0));
        }
        let next = Place {
            stick_area: stick.area + state.edge * part,
            slip_compression: compression,
            stick_load: load,
        };
        // Slip is what is carried over: small numbers next to the edge of stick, where compressions differ by little.
        let edge = state.edge * (1.0 - part);
        let mut fields = Fields::default();
        self.evaluate_at(&next, edge, &state.compression, &mut fields);
        let slipping = nodes.iter().map(|x| (compression - at(part + (1.0 - part) * x)).max(0.0));
        let slip = self.carried(&fields, slipping);
        // What is left behind is by another quadrature than the slip: the contact edge stays where it is.
        let behind = moving.left_behind(&left_behind, next.stick_area + edge);
        let off = self.mismatch_at(&next, edge, |i, _| slip[i]) - behind;
        left_behind.iter_mut().for_each(|value| *value += off);
        let moved = self.compression_at(&next, edge, |i, _| slip[i]);
        Ok(State {
            edge,
            compression_rate: vec![0.0; moved.len()],
            compression: moved,
            edge_rate: 0.0,
            past: Past::default(),
            stick: Some(StickEdge {
                area: next.stick_area,
                depth: self.contact.indentation() - compression,
                load,
                left_behind,
                wear_depth: stick.wear_depth.clone(),
                rates: [0.0; 2],
            }),
            ..state
        })
    }
}
