//! Gross slip in blocks at different indentations: the mesh ends at the contact edge of the block that is under way, on the ground that blocks before have worn.
//!
//! What surrounds the contact is `f(r) = f_0(r) + w(r)`, with the depth `w` worn so far, instead of the unworn `f_0`. Where a block at another indentation `d` begins, its contact
//! is found on that ground as the first one is on the unworn profile:
//!
//! ```text
//! F q = d - f,     q(a) = 0
//! ```

use std::f64::consts::PI;
use std::sync::Arc;

use super::Gross;
use crate::error::{Error, Result};
use crate::numerics::roots::bracketed;
use crate::numerics::whole_contact::WholeContact;
use crate::solver::model::schedule::CycleLoading;
use crate::solver::model::worn_ground::{Surroundings, WornGround};
use crate::solver::model::{Fields, Model, Past, State};

/// Squared radii that differ by less than this part are the same.
const SAME_PLACE: f64 = 1e-9;

/// Factor from one radius to the next in the search for a contact edge, and how many are tried to each side.
const SEARCH: f64 = 1.01;
const TRIES: i32 = 150;

impl Model {
    /// Whether the mesh of gross slip ends at the contact edge of the block under way, where blocks press to different indentations.
    pub fn follows_blocks(&self) -> bool {
        let held = self.gross().is_some_and(|gross| !gross.holds_force());
        held && self.schedule.lifts_blocks() && self.schedule.averages_from() > 0.0
    }

    /// A state at the beginning of a block, with the mesh up to the contact edge at its indentation.
    ///
    /// # Errors
    /// [`Error::NotConverged`] where no contact edge is found.
    pub(in crate::solver) fn in_block_of(&self, state: State) -> Result<State> {
        let loading = self.schedule.loading(state.cycles, state.cycles);
        Ok(self.at_indentation_of(&loading, &state)?.unwrap_or(state))
    }

    /// A state at the indentation of a loading, where the mesh ends at the contact edge of each block; none where it serves as it is.
    ///
    /// # Errors
    /// [`Error::NotConverged`] where no contact edge is found.
    pub(in crate::solver) fn at_indentation_of(
        &self,
        loading: &CycleLoading,
        state: &State,
    ) -> Result<Option<State>> {
        if self.follows_blocks() { self.lifted_to(loading.least_lift(), state) } else { Ok(None) }
    }

    /// A contact in gross slip with the indenter lifted by so much, m, from its largest indentation of the run; none where it is so already or touches nothing then, and out of gross slip.
    ///
    /// # Errors
    /// [`Error::NotConverged`] where no contact edge is found.
    pub(in crate::solver) fn lifted_to(&self, lift: f64, state: &State) -> Result<Option<State>> {
        let before = state.ground.as_ref().map_or(0.0, |it| it.lift);
        let Some(gross) = self.gross().filter(|_| lift != before) else { return Ok(None) };
        let ground = Arc::new(self.ground_left(gross, state, lift));
        let around = self.surroundings(Some(&ground));
        let mesh = &gross.mesh;
        let place =
            |level| mesh.last_above(&state.compression, level).map(|at| mesh.fraction(at) * state.slip_area);
        let guess = match lift > before {
            // Where the block does not touch what was worn deeper, nothing bears.
            true => match place(lift - before) {
                Some(squared) => Some(squared.sqrt()),
                None => return Ok(None),
            },
            false => {
                let reached = ground.places().last().map_or(0.0, |(squared, _)| squared.sqrt());
                let unworn = self.contact.equivalent_profile().radius_at(around.indentation).ok();
                unworn.map(|radius| radius.max(reached))
            }
        };
        let (slip_area, compression) =
            guess.and_then(|guess| fitted(mesh, &around, guess)).ok_or_else(|| Error::NotConverged {
                what: "contact edge",
                why: "no contact is found at the indentation of the block that begins (loading.blocks, indentation_factor)".into(),
            })?;
        Ok(Some(State {
            slip_area,
            compression_rate: vec![0.0; compression.len()],
            compression,
            slip_area_rate: 0.0,
            ground: Some(ground),
            past: Past::default(),
            ..state.clone()
        }))
    }

    /// The ground that a state leaves to a block that lifts the indenter by so much, m.
    fn ground_left(&self, gross: &Gross, state: &State, lift: f64) -> WornGround {
        if state.cycles == 0.0 {
            return WornGround::new(lift, vec![], &[]);
        }
        let fields = self.gross_fields(gross, state);
        let axis = gross.mesh.value(&fields.wear_depth, gross.mesh.coordinate(0.0));
        let nodes = gross.mesh.fractions().iter().map(|fraction| fraction * state.slip_area);
        let within = std::iter::once((0.0, axis)).chain(nodes.zip(fields.wear_depth.iter().copied()));
        let before = state.ground.iter().flat_map(|it| it.places());
        let beyond = before.filter(|(squared, _)| *squared > state.slip_area * (1.0 + SAME_PLACE));
        let places = within.chain(beyond).map(|(squared, worn)| (squared, worn.max(0.0)));
        let (squared, worn): (Vec<f64>, Vec<f64>) = places.unzip();
        WornGround::new(lift, squared, &worn)
    }

    /// Volume worn outside the contact before the block under way, m³.
    pub(super) fn volume_around(&self, fields: &Fields) -> f64 {
        let Some(ground) = &fields.ground else { return 0.0 };
        let around = self.surroundings(Some(ground));
        let places = ground.places().map(|(squared, _)| squared).filter(|it| *it > fields.slip_area);
        let places: Vec<f64> = std::iter::once(fields.slip_area).chain(places).collect();
        // Simpson's rule has cubics exactly.
        let part = |ends: &[f64]| {
            let values = [ends[0], 0.5 * (ends[0] + ends[1]), ends[1]].map(|squared| around.worn(squared));
            (ends[1] - ends[0]) / 6.0 * (values[0] + 4.0 * values[1] + values[2])
        };
        PI * places.windows(2).map(part).sum::<f64>()
    }

    /// Radius up to which ground is worn, m.
    pub fn worn_radius(&self, state: &State) -> f64 {
        let before = state.ground.as_ref().and_then(|it| it.places().last());
        self.contact_radius(state).max(before.map_or(0.0, |(squared, _)| squared.sqrt()))
    }
}

/// Compressions, m, at the inner nodes with which the surface of a contact of a radius, m, has a height, m, by the radius; and what it is too high by at the edge, where they are zero.
pub(super) fn pressed_on(mesh: &WholeContact, radius: f64, height: impl Fn(f64) -> f64) -> (Vec<f64>, f64) {
    let at = |fraction: &f64| height(radius * fraction.sqrt());
    let mut compression: Vec<f64> = mesh.fractions()[..mesh.inner()].iter().map(at).collect();
    mesh.solve_profile(&mut compression);
    let mismatch = mesh.profile_at_edge(&compression) - at(&1.0);
    (compression, mismatch)
}

/// Squared contact radius, m², and compressions, m, on the ground around, with an edge near a guess, m; none where it has none.
fn fitted(mesh: &WholeContact, around: &Surroundings, guess: f64) -> Option<(f64, Vec<f64>)> {
    let height = |radius: f64| around.indentation - around.profile(radius);
    let mismatch = |radius: f64| pressed_on(mesh, radius, height).1;
    let sign = mismatch(guess).signum();
    // The nearest change of sign to either side.
    let change =
        (1..=TRIES).flat_map(|i| [i, -i]).find(|i| mismatch(guess * SEARCH.powi(*i)).signum() != sign)?;
    let ends = [change, change - change.signum()].map(|i| guess * SEARCH.powi(i));
    let radius = bracketed(mismatch, ends[0].min(ends[1]), ends[0].max(ends[1]), 0.0).ok()?;
    Some((radius * radius, pressed_on(mesh, radius, height).0))
}
