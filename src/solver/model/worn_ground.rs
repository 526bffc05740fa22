//! What surrounds a contact in gross slip: the indenter, and the ground that blocks before have worn.

use super::Model;
use crate::contact::indenter::{Cubic, Indenter};
use crate::numerics::roots::bracketed;

/// Least slope of the mismatch at a contact edge, over the rise of the ground. With 1e-4 and 1e-3 volumes are the same to 1e-6, with 5e-3 to 2e-4.
const LEAST_SLOPE: f64 = 1e-3;

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
    pub indentation: f64,
}

impl Surroundings<'_> {
    /// Depth worn before the block under way at a squared radius, m.
    pub fn worn(&self, squared: f64) -> f64 {
        self.worn.map_or(0.0, |worn| worn.value(squared))
    }

    /// `f(r)`, m.
    pub fn profile(&self, radius: f64) -> f64 {
        self.indenter.profile(radius) + self.worn(radius * radius)
    }

    /// `f'(r)`.
    pub fn slope(&self, radius: f64) -> f64 {
        let worn = self.worn.map_or(0.0, |worn| worn.derivative(radius * radius));
        self.indenter.profile_derivative(radius) + 2.0 * radius * worn
    }

    /// Slope of the mismatch at a contact edge, by which the edge follows from what wears. Where a block begins it is next to nothing, and on ground that is worn the little that the
    /// mesh is off by would take it through zero: it is kept above a small part of the rise of `f`, smoothly.
    pub fn kept_apart(&self, slope: f64, rise: f64) -> f64 {
        let least = LEAST_SLOPE * rise;
        match self.worn {
            None => slope,
            Some(_) if slope >= 2.0 * least => slope,
            Some(_) if slope <= 0.0 => least,
            Some(_) => least + 0.25 * slope * slope / least,
        }
    }

    /// Radius, m, at which `f` has risen to a height, m.
    pub fn radius_at_height(&self, height: f64) -> f64 {
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
    /// What surrounds the contact, on ground that blocks before have worn.
    pub fn surroundings<'a>(&'a self, ground: Option<&'a WornGround>) -> Surroundings<'a> {
        Surroundings {
            indenter: self.contact.indenter(),
            worn: ground.and_then(|it| it.depth.as_ref()),
            indentation: self.contact.indentation() - ground.map_or(0.0, |it| it.lift),
        }
    }
}
