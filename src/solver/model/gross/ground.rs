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
use crate::contact::indenter::{Cubic, Indenter};
use crate::error::{Error, Result};
use crate::numerics::roots::bracketed;
use crate::numerics::whole_contact::WholeContact;
use crate::solver::model::schedule::CycleLoading;
use crate::solver::model::{Fields, Model, Past, State};

/// Squared radii that differ by less than this part are the same.
const SAME_PLACE: f64 = 1e-9;

/// Least slope of the mismatch at a contact edge, over the rise of the ground. With 1e-4 and 1e-3 volumes are the same to 1e-6, with 5e-3 to 2e-4.
const LEAST_SLOPE: f64 = 1e-3;

/// Factor from one radius to the next in the search for a contact edge, and how many are tried to each side.
const SEARCH: f64 = 1.01;
const TRIES: i32 = 150;

/// Ground as worn as it was when the block under way began, and how deep that block presses.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WornGround {
    /// By how much the block lifts the indenter from its largest indentation of the run, m.
    pub lift: f64,
    /// Squared radii, m², increasing from zero on the axis to where nothing is worn, shape `(place,)`; empty where nothing is at all.
    pub squared: Vec<f64>,
    /// Depth worn there, m, shape `(place,)`.
    pub worn: Vec<f64>,
}

impl WornGround {
    /// Depth worn by the squared radius.
    fn depth(&self) -> Option<Cubic> {
        let (squared, worn) = (&self.squared, &self.worn);
        let last = squared.len().checked_sub(1).filter(|last| *last > 0)?;
        let rate = |i: usize| (worn[i + 1] - worn[i]) / (squared[i + 1] - squared[i]);
        // Of the parabola through each place and those next to it. Beyond the last nothing is worn.
        let slope = |i: usize| match i {
            0 => rate(0),
            i if i == last => 0.0,
            i => {
                let [before, after] = [squared[i] - squared[i - 1], squared[i + 1] - squared[i]];
                (after * rate(i - 1) + before * rate(i)) / (before + after)
            }
        };
        Some(Cubic::new(squared.clone(), worn, (0..=last).map(slope).collect()))
    }
}

/// What surrounds a contact in gross slip.
#[derive(Debug, Clone)]
pub struct Surroundings<'a> {
    indenter: &'a Indenter,
    worn: Option<Cubic>,
    /// Indentation of the block under way where it is held, else that of the first contact, m.
    pub(super) indentation: f64,
}

impl Surroundings<'_> {
    /// Depth worn before the block under way at a squared radius, m.
    pub(super) fn worn(&self, squared: f64) -> f64 {
        self.worn.as_ref().map_or(0.0, |worn| worn.value(squared))
    }

    /// `f(r)`, m.
    pub(super) fn profile(&self, radius: f64) -> f64 {
        self.indenter.profile(radius) + self.worn(radius * radius)
    }

    /// `f'(r)`.
    pub(super) fn slope(&self, radius: f64) -> f64 {
        let worn = self.worn.as_ref().map_or(0.0, |worn| worn.derivative(radius * radius));
        self.indenter.profile_derivative(radius) + 2.0 * radius * worn
    }

    /// Slope of the mismatch at a contact edge, by which the edge follows from what wears. Where a block begins it is next to nothing, and on ground that is worn the little that the
    /// mesh is off by would take it through zero: it is kept above a small part of the rise of `f`, smoothly.
    pub(super) fn kept_apart(&self, slope: f64, rise: f64) -> f64 {
        let least = LEAST_SLOPE * rise;
        match self.worn {
            None => slope,
            Some(_) if slope >= 2.0 * least => slope,
            Some(_) if slope <= 0.0 => least,
            Some(_) => least + 0.25 * slope * slope / least,
        }
    }

    /// Radius, m, at which `f` has risen to a height, m.
    pub(super) fn radius_at_height(&self, height: f64) -> f64 {
        // Worn ground is higher than unworn.
        let most = self.indenter.radius_at_height(height);
        match &self.worn {
            None => most,
            Some(_) if self.profile(most) <= height => most,
            Some(_) => bracketed(|r| self.profile(r) - height, 0.0, most, 0.0).unwrap_or(f64::NAN),
        }
    }
}

impl Model {
    /// Whether the mesh of gross slip ends at the contact edge of the block under way, where blocks press to different indentations.
    pub fn follows_blocks(&self) -> bool {
        let held = self.gross().is_some_and(|gross| !gross.holds_force());
        held && self.schedule.lifts_blocks() && self.schedule.averages_from() > 0.0
    }

    /// What surrounds the contact, on ground that blocks before have worn.
    pub fn surroundings(&self, ground: Option<&Arc<WornGround>>) -> Surroundings<'_> {
        Surroundings {
            indenter: self.contact.indenter(),
            worn: ground.and_then(|it| it.depth()),
            indentation: self.contact.indentation() - ground.map_or(0.0, |it| it.lift),
        }
    }

    /// What acts, seen from the indentation of the block under way.
    pub(in crate::solver) fn on_ground(
        &self,
        ground: Option<&WornGround>,
        loading: CycleLoading,
    ) -> CycleLoading {
        match ground {
            None => loading,
            Some(ground) => loading.each(|mut it| {
                it.lift_by(-ground.lift);
                it
            }),
        }
    }

    /// A state at the beginning of a block, with the mesh up to the contact edge at its indentation.
    ///
    /// # Errors
    /// [`Error::NotConverged`] where no contact edge is found.
    pub(in crate::solver) fn in_block_of(&self, gross: &Gross, state: State) -> Result<State> {
        if !self.follows_blocks() {
            return Ok(state);
        }
        let lift = self.schedule.loading(state.cycles, state.cycles).least_lift();
        self.lifted_to(gross, state, lift)
    }

    /// A state at the indentation of a loading, where the mesh ends at the contact edge of each block.
    ///
    /// # Errors
    /// [`Error::NotConverged`] where no contact edge is found.
    pub(in crate::solver) fn at_indentation_of(
        &self,
        loading: &CycleLoading,
        state: &State,
    ) -> Result<State> {
        match self.gross() {
            Some(gross) if self.follows_blocks() => {
                self.lifted_to(gross, state.clone(), loading.least_lift())
            }
            _ => Ok(state.clone()),
        }
    }

    /// The same contact with the indenter lifted by so much, m, from its largest indentation of the run.
    ///
    /// # Errors
    /// [`Error::NotConverged`] where no contact edge is found.
    pub(in crate::solver) fn lifted_to(&self, gross: &Gross, state: State, lift: f64) -> Result<State> {
        let before = state.ground.as_ref().map_or(0.0, |it| it.lift);
        if lift == before {
            return Ok(state);
        }
        let ground = Arc::new(WornGround { lift, ..self.ground_left(gross, &state) });
        let around = self.surroundings(Some(&ground));
        let mesh = &gross.mesh;
        let place =
            |level| mesh.last_above(&state.compression, level).map(|at| mesh.fraction(at) * state.slip_area);
        let guess = match lift > before {
            // Where the block does not touch what was worn deeper, nothing bears.
            true => match place(lift - before) {
                Some(squared) => Some(squared.sqrt()),
                None => return Ok(state),
            },
            false => {
                let reached = ground.squared.last().map_or(0.0, |squared| squared.sqrt());
                let unworn = self.contact.equivalent_profile().radius_at(around.indentation).ok();
                unworn.map(|radius| radius.max(reached))
            }
        };
        let (slip_area, compression) =
            guess.and_then(|guess| fitted(mesh, &around, guess)).ok_or_else(|| Error::NotConverged {
                what: "contact edge",
                why: "no contact is found at the indentation of the block that begins (loading.blocks, indentation_factor)".into(),
            })?;
        Ok(State {
            slip_area,
            compression_rate: vec![0.0; compression.len()],
            compression,
            slip_area_rate: 0.0,
            ground: Some(ground),
            past: Past::default(),
            ..state
        })
    }

    /// The ground that a state leaves.
    fn ground_left(&self, gross: &Gross, state: &State) -> WornGround {
        let fields = self.gross_fields(gross, state);
        let mut ground = WornGround::default();
        if state.cycles == 0.0 {
            return ground;
        }
        let axis = gross.mesh.value(&fields.wear_depth, gross.mesh.coordinate(0.0));
        let nodes = gross.mesh.fractions().iter().map(|fraction| fraction * state.slip_area);
        let within = std::iter::once((0.0, axis)).chain(nodes.zip(fields.wear_depth.iter().copied()));
        let before =
            state.ground.iter().flat_map(|it| it.squared.iter().copied().zip(it.worn.iter().copied()));
        let beyond = before.filter(|(squared, _)| *squared > state.slip_area * (1.0 + SAME_PLACE));
        (ground.squared, ground.worn) =
            within.chain(beyond).map(|(squared, worn)| (squared, worn.max(0.0))).unzip();
        ground
    }

    /// Volume worn outside the contact before the block under way, m³.
    pub(super) fn volume_around(&self, fields: &Fields) -> f64 {
        let Some(ground) = &fields.ground else { return 0.0 };
        let around = self.surroundings(Some(ground));
        let places = ground.squared.iter().copied().filter(|squared| *squared > fields.slip_area);
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
        let before = state.ground.as_ref().and_then(|it| it.squared.last().copied());
        self.contact_radius(state).max(before.unwrap_or_default().sqrt())
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
