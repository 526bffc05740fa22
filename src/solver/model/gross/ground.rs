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
    /// Depth worn by the squared radius; none where nothing is.
    depth: Option<Cubic>,
}

impl WornGround {
    /// # Arguments
    /// * `lift` -- by how much the block lifts the indenter from its largest indentation of the run, m
    /// * `squared` -- squared radii, m², increasing from zero on the axis to where nothing is worn, shape `(place,)`; empty where nothing is at all
    /// * `worn` -- depth worn there, m, shape `(place,)`
    pub fn new(lift: f64, squared: Vec<f64>, worn: &[f64]) -> Self {
        let Some(last) = squared.len().checked_sub(1).filter(|last| *last > 0) else {
            return Self { lift, depth: None };
        };
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
        let slopes = (0..=last).map(slope).collect();
        Self { lift, depth: Some(Cubic::new(squared, worn, slopes)) }
    }

    /// Squared radii at which it is known, m², and the depth worn there, m.
    pub fn places(&self) -> impl Iterator<Item = (f64, f64)> {
        let curves = self.depth.iter();
        curves.flat_map(|it| it.knots().iter().enumerate().map(|(i, squared)| (*squared, it.at_knot(i))))
    }
}

/// What surrounds a contact in gross slip.
#[derive(Debug, Clone, Copy)]
pub struct Surroundings<'a> {
    indenter: &'a Indenter,
    worn: Option<&'a Cubic>,
    /// Indentation of the block under way where it is held, else that of the first contact, m.
    pub(super) indentation: f64,
}

impl Surroundings<'_> {
    /// Depth worn before the block under way at a squared radius, m.
    pub(super) fn worn(&self, squared: f64) -> f64 {
        self.worn.map_or(0.0, |worn| worn.value(squared))
    }

    /// `f(r)`, m.
    pub(super) fn profile(&self, radius: f64) -> f64 {
        self.indenter.profile(radius) + self.worn(radius * radius)
    }

    /// `f'(r)`.
    pub(super) fn slope(&self, radius: f64) -> f64 {
        let worn = self.worn.map_or(0.0, |worn| worn.derivative(radius * radius));
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
        match self.worn {
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
    pub fn surroundings<'a>(&'a self, ground: Option<&'a WornGround>) -> Surroundings<'a> {
        Surroundings {
            indenter: self.contact.indenter(),
            worn: ground.and_then(|it| it.depth.as_ref()),
            indentation: self.contact.indentation() - ground.map_or(0.0, |it| it.lift),
        }
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
