//! Worn profiles at one amplitude for several gradings [S, Fig. 1].

use super::Medium;
use crate::contact::closed_form::LimitingShape;
use crate::contact::indenter::Indenter;
use crate::error::Result;

/// How far beyond the largest contact radius the profiles go.
const MARGIN: f64 = 1.15;

/// Profiles over the radius in units of `L`, `A L^n = d/n`, which is `√(R d)` for a paraboloid; depths in `d`.
#[derive(Debug, Clone, PartialEq)]
pub struct WornProfiles {
    /// `U/(μ_f d)`.
    pub amplitude_ratio: f64,
    /// Gradings `k`, shape `(profile_grading,)`.
    pub gradings: Vec<f64>,
    /// Radii `r/L`, shape `(profile_radius,)`, increasing from 0.
    pub radii: Vec<f64>,
    /// Unworn profile `f0/d`, the same for every grading, shape `(profile_radius,)`.
    pub initial: Vec<f64>,
    /// Limiting wear depth `Δf/d`, shape `(profile_grading, profile_radius)`; not a number under full sliding.
    pub wear_depth: Vec<f64>,
    /// First contact radius `a0/L`, shape `(profile_grading,)`.
    pub contact_radius_initial: Vec<f64>,
    /// Stick radius `c/L`, shape `(profile_grading,)`; not a number under full sliding.
    pub stick_radius: Vec<f64>,
    /// Limiting contact radius `a∞/L`, shape `(profile_grading,)`; not a number under full sliding.
    pub contact_radius_limit: Vec<f64>,
}

impl WornProfiles {
    /// Evaluates the profiles.
    ///
    /// # Errors
    /// Those of the closed form.
    pub fn new(medium: &Medium, gradings: &[f64], amplitude_ratio: f64, points: usize) -> Result<Self> {
        let n = medium.exponent();
        // d = L = 1
        let indenter = Indenter::power_law(1.0 / n, n)?;
        let mut shapes = vec![];
        let mut contact_radius_initial = vec![];
        for &grading in gradings {
            let compression = medium.stiffness_ratio(grading) * amplitude_ratio;
            contact_radius_initial.push(indenter.equivalent_profile(grading)?.radius_at(1.0)?);
            shapes.push(match compression < 1.0 {
                true => Some(LimitingShape::new(&indenter, grading, 1.0, compression)?),
                false => None,
            });
        }
        let limits = shapes.iter().flatten().map(LimitingShape::contact_radius_limit);
        let outermost = MARGIN
            * limits.chain(contact_radius_initial.iter().copied()).fold(0.0, |most: f64, it| most.max(it));
        let radii: Vec<f64> = (0..points).map(|i| outermost * i as f64 / (points - 1) as f64).collect();
        let of = |value: fn(&LimitingShape) -> f64| -> Vec<f64> {
            shapes.iter().map(|shape| shape.as_ref().map_or(f64::NAN, value)).collect()
        };
        let depth =
            |shape: &Option<LimitingShape>, r: f64| shape.as_ref().map_or(f64::NAN, |it| it.wear_depth(r));
        Ok(Self {
            amplitude_ratio,
            gradings: gradings.to_vec(),
            initial: radii.iter().map(|&r| indenter.profile(r)).collect(),
            wear_depth: shapes.iter().flat_map(|shape| radii.iter().map(move |&r| depth(shape, r))).collect(),
            contact_radius_initial,
            stick_radius: of(LimitingShape::stick_radius),
            contact_radius_limit: of(LimitingShape::contact_radius_limit),
            radii,
        })
    }
}
