//! Wear over grading and amplitude: the maps of [S, Fig. 2], the optimal grading, and the worn profiles of [S, Fig. 1].
//!
//! One power-law indenter `f = A r^n` is compared on half-spaces of different grading, all at the indentation `d`, the coefficient `A` and
//! the amplitude `U` of the homogeneous contact. Nothing is stepped in time: every number comes from the closed form.
//!
//! Lengths are in contact radii `a_h` of the homogeneous contact (radial) and in indentations `d` (depth), amplitudes are `U/(μ_f d)`.

mod files;
mod isolines;
mod medium;
mod optimum;
mod profiles;
mod report;

pub use files::{check_folder, write};
pub use isolines::{Isoline, isolines};
pub use medium::Medium;
pub use optimum::{Control, End, Optimum, OptimumCurve, Thresholds};
pub use profiles::WornProfiles;
pub use report::{MapReport, OptimumRow};

use rayon::prelude::*;

use crate::error::Result;
use crate::scene::MapScene;

/// How the worn volume of the map is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// By the closed form [S, Eq. (4)], exact.
    Exact,
    /// For small amplitudes [S, Eq. (15)], with the exact stick radius and `ε_a`.
    SmallAmplitude,
    /// The same to leading order throughout: `c → a0`, `ε_a → M U/(n μ_f d)`.
    LeadingOrder,
}

/// Limiting worn volume over grading and amplitude.
#[derive(Debug, Clone, PartialEq)]
pub struct WearMap {
    /// Gradings `k`, shape `(grading,)`.
    pub gradings: Vec<f64>,
    /// Amplitudes `U/(μ_f d)`, shape `(amplitude_ratio,)`.
    pub amplitude_ratios: Vec<f64>,
    /// Amplitude ratio `1/M` from which on everything slides, shape `(grading,)`.
    pub full_sliding: Vec<f64>,
    /// `ΔV/(π a_h² d)`, shape `(grading, amplitude_ratio)`; not a number under full sliding.
    pub volume: Vec<f64>,
    /// `ΔV(k)/ΔV(0)`, shape `(grading, amplitude_ratio)`; not a number where either is in gross slip.
    pub ratio: Vec<f64>,
    /// The same by [`Form::SmallAmplitude`].
    pub small_amplitude_ratio: Vec<f64>,
    /// The same by [`Form::LeadingOrder`].
    pub leading_order_ratio: Vec<f64>,
}

impl WearMap {
    /// Computes the map, columns of one grading in parallel; the number of threads does not change a digit.
    ///
    /// # Arguments
    /// * `medium` -- indenter exponent and Poisson's ratio
    /// * `gradings` -- `k`, each in (-1, 1)
    /// * `amplitude_ratios` -- `U/(μ_f d)`, each positive
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) names the argument; those of the closed form.
    ///
    /// # Examples
    /// ```
    /// use fretwear::contact::half_space::Poisson;
    /// use fretwear::study::wear_map::{Medium, WearMap};
    ///
    /// // Paraboloid, U/(μ_f d) = 0.5: a positive grading wears less, a negative one more.
    /// let map = WearMap::new(&Medium::new(2.0, Poisson::Similar)?, &[-0.3, 0.0, 0.3], &[0.5])?;
    /// assert!(map.ratio[0] > 1.0 && map.ratio[1] == 1.0 && map.ratio[2] < 1.0);
    /// # Ok::<(), fretwear::Error>(())
    /// ```
    pub fn new(medium: &Medium, gradings: &[f64], amplitude_ratios: &[f64]) -> Result<Self> {
        let forms = [Form::Exact, Form::SmallAmplitude, Form::LeadingOrder];
        let column = |grading: f64| -> Result<[Vec<f64>; 3]> {
            let column = medium.at(grading)?;
            let row = |form| -> Result<Vec<f64>> {
                amplitude_ratios.iter().map(|&amplitude| column.volume(form, amplitude)).collect()
            };
            let [exact, small, leading] = forms.map(row);
            Ok([exact?, small?, leading?])
        };
        let homogeneous = column(0.0)?;
        let columns = gradings.par_iter().map(|&grading| column(grading)).collect::<Result<Vec<_>>>()?;
        let joined = |form: usize| columns.iter().flat_map(move |column| column[form].iter().copied());
        let ratio = |form: usize| -> Vec<f64> {
            joined(form)
                .zip(homogeneous[form].iter().cycle())
                .map(|(volume, reference)| volume / reference)
                .collect()
        };
        Ok(Self {
            gradings: gradings.to_vec(),
            amplitude_ratios: amplitude_ratios.to_vec(),
            full_sliding: gradings.iter().map(|&grading| 1.0 / medium.stiffness_ratio(grading)).collect(),
            volume: joined(0).collect(),
            ratio: ratio(0),
            small_amplitude_ratio: ratio(1),
            leading_order_ratio: ratio(2),
        })
    }
}

/// Everything that `fretwear map` computes.
#[derive(Debug, Clone, PartialEq)]
pub struct MapStudy {
    /// The map.
    pub map: WearMap,
    /// Lines of equal `ΔV(k)/ΔV(0)`, exact.
    pub isolines: Vec<Isoline>,
    /// The same for small amplitudes [S, Fig. 2b].
    pub small_amplitude_isolines: Vec<Isoline>,
    /// The optimal grading over the amplitude, one curve for each control.
    pub optimum: Vec<OptimumCurve>,
    /// Amplitudes at which the comparison turns.
    pub thresholds: Thresholds,
    /// Worn profiles [S, Fig. 1].
    pub profiles: WornProfiles,
}

impl MapStudy {
    /// Computes what a map scene asks for.
    ///
    /// # Errors
    /// Those of the closed form.
    pub fn new(scene: &MapScene) -> Result<Self> {
        let medium = Medium::new(scene.exponent, scene.poisson)?;
        let map = WearMap::new(&medium, &scene.gradings, &scene.amplitude_ratios)?;
        let lines = |values: &[f64]| isolines(&map.gradings, &map.amplitude_ratios, values, &scene.levels);
        let controls = std::iter::once(Control::Indentation).chain(scene.reference_depths.iter().flat_map(
            |&reference_depth| {
                [Control::Force { reference_depth }, Control::ForceDepthOnly { reference_depth }]
            },
        ));
        let optimum = controls
            .map(|control| OptimumCurve::new(&medium, control, &scene.optimum_amplitude_ratios))
            .collect::<Result<_>>()?;
        Ok(Self {
            isolines: lines(&map.ratio),
            small_amplitude_isolines: lines(&map.small_amplitude_ratio),
            optimum,
            thresholds: Thresholds::new(&medium)?,
            profiles: WornProfiles::new(
                &medium,
                &scene.profile_gradings,
                scene.profile_amplitude_ratio,
                scene.profile_points,
            )?,
            map,
        })
    }
}
