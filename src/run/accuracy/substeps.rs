//! What the substeps of a period leave out.

use super::super::parts::schedule;
use crate::contact::InitialContact;
use crate::contact::closed_form::LimitingShape;
use crate::numerics::curve::distance_from_curve;
use crate::scene::{Numerics, Scene};
use crate::solver::model::{Model, Schedule};
use crate::solver::simulation::Simulation;

/// Substeps of a period with which those of a run are compared, over these. Halves would tell little: as more substeps come next to a reversal,
/// the error may stand still and then fall at once. At constant indentation the error is of second order, and a fifteenth of it is left out where they are four times as many, as beyond the last number.
const FINER: usize = 8;
const FINER_OF_MANY: usize = 4;
const MANY: usize = 384;

/// The same for a run with this schedule.
pub(super) fn finer_than(schedule: &Schedule) -> usize {
    let are_many = schedule.is_tabulated() || schedule.loop_steps(1) > MANY;
    if are_many { FINER_OF_MANY } else { FINER }
}

/// The larger of two numbers; infinite where one is not a number.
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::INFINITY } else { a.max(b) }
}

/// What the substeps of a period leave out: the integral over the cycles of what more of them would wear in the same states.
#[derive(Debug)]
pub(super) struct Unsampled {
    finer: Schedule,
    /// The limit's volume, m³, and its change, relative; none where the contact is in gross slip.
    limit: Option<[f64; 2]>,
    /// Largest part of the limit's volume that was worn.
    reached: f64,
    /// By how much the permanent edge of stick is off, over the contact radius.
    edge: f64,
    cycles: f64,
    /// Rates that are left out: of the volume, m³ per cycle, and of the depth at the springs, m per cycle.
    rates: Vec<f64>,
    /// What has been left out so far, as the rates, and the most of it at any time, m³ and m.
    sums: Vec<f64>,
    most: [f64; 2],
    /// Profiles with what they leave out, where they are compared as curves.
    profiles: Option<Vec<Profile>>,
}

/// Depth at the springs, and what it leaves out.
#[derive(Debug)]
struct Profile {
    /// Over the contact radius.
    radii: Vec<f64>,
    /// m.
    depth: Vec<f64>,
    left_out: Vec<f64>,
}

impl Profile {
    /// The largest distance from the curve without what is left out, of depth over `scale` or of radius.
    fn error(&self, scale: f64) -> f64 {
        let curve: Vec<f64> = self.depth.iter().map(|it| it / scale).collect();
        let with = |i: usize| [self.radii[i], curve[i] + self.left_out[i] / scale];
        let places = 0..curve.len();
        places.map(|i| distance_from_curve(&self.radii, &curve, with(i), i)).fold(0.0, larger)
    }
}

impl Unsampled {
    /// # Arguments
    /// * `as_curves` -- whether profiles are compared as curves
    pub(super) fn new(scene: &Scene, numerics: &Numerics, model: &Model, as_curves: bool) -> Option<Self> {
        let contact = scene.contact().ok()?;
        let points = model.schedule().loop_steps(1);
        let finer = Numerics { substeps: Some(finer_than(model.schedule()) * points), ..*numerics };
        let finer = schedule(scene, &contact, &finer).ok()?;
        let volume = |contact: &InitialContact| {
            let limit = LimitingShape::from_contact(contact).ok().flatten()?;
            Some(limit.wear_volume())
        };
        let (mut limit, mut edge) = (None, 0.0);
        if !model.slides() {
            let reach = finer.envelope(&contact).ok()?.contact;
            let volumes = volume(&reach).zip(volume(model.contact()));
            limit = volumes.map(|(fine, coarse)| [coarse, (fine / coarse - 1.0).abs()]);
            let edges = reach.stick_radius().zip(model.contact().stick_radius());
            edge = edges.map_or(0.0, |(fine, coarse)| (fine - coarse).abs() / contact.contact_radius());
        }
        let nothing = Self {
            finer,
            limit,
            reached: 0.0,
            edge,
            cycles: 0.0,
            rates: vec![],
            sums: vec![],
            most: [0.0; 2],
            profiles: (as_curves && model.gross().is_none()).then(Vec::new),
        };
        Some(nothing)
    }

    /// Takes the state of a simulation into account.
    pub(super) fn see(&mut self, simulation: &Simulation) {
        let (model, state, fields) = (simulation.model(), simulation.state(), simulation.fields());
        self.finer.average_from(model.schedule().averages_from());
        let loading = model.loading_in(state, self.finer.loading(state.cycles, state.cycles));
        let (fine, coarse) = (model.cycle(&loading, &state.compression, fields), simulation.cycle());
        // In gross slip growth is over the indentation.
        let scale = |i: usize| fields.slip_depth.get(i).copied().unwrap_or(model.contact().indentation());
        let depths = fine.growth.iter().zip(&coarse.growth).enumerate();
        let depths = depths.map(|(i, (fine, coarse))| (fine - coarse) * scale(i));
        let rates: Vec<f64> = std::iter::once(fine.volume - coarse.volume).chain(depths).collect();
        let elapsed = state.cycles - self.cycles;
        self.cycles = state.cycles;
        if self.rates.is_empty() {
            self.sums = vec![0.0; rates.len()];
        } else {
            for (sum, (now, before)) in self.sums.iter_mut().zip(rates.iter().zip(&self.rates)) {
                *sum += 0.5 * elapsed * (now + before);
            }
        }
        self.rates = rates;
        if let Some([volume, change]) = self.limit {
            // Nothing wears beyond the limit, whatever the rates next to it.
            let worn = model.wear_volume(fields);
            self.reached = self.reached.max(worn / volume);
            let left = |limit: f64, worn: f64, largest: f64| (limit - worn).max(0.0) + change * largest;
            let depths = fields.unworn.iter().zip(&fields.wear_depth);
            let depths = depths.map(|(unworn, worn)| left(unworn.limit_depth(), *worn, model.depth_scale()));
            let lefts = std::iter::once(left(volume, worn, volume)).chain(depths);
            self.sums.iter_mut().zip(lefts).for_each(|(sum, left)| *sum = sum.clamp(-left, left));
        }
        self.most[0] = larger(self.most[0], self.sums[0].abs());
        let left_out = &self.sums[1..];
        match &mut self.profiles {
            Some(profiles) => {
                let edge = model.contact_radius(state);
                let radii = model.spring_radii(fields).iter().map(|r| r / edge).collect();
                let (depth, left_out) = (fields.wear_depth.clone(), left_out.to_vec());
                profiles.push(Profile { radii, depth, left_out });
            }
            None => self.most[1] = left_out.iter().map(|it| it.abs()).fold(self.most[1], larger),
        }
    }

    pub(super) fn error(&self, [volume, depth]: [f64; 2]) -> f64 {
        let of_limit = self.limit.map_or(0.0, |[_, change]| change * self.reached.min(1.0));
        let of_profiles = self.profiles.iter().flatten().map(|it| it.error(depth)).fold(0.0, larger);
        larger(self.most[0] / volume, self.most[1] / depth).max(of_profiles).max(of_limit).max(self.edge)
    }
}
