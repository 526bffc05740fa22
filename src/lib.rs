//! Fretting wear of elastically graded media, from the first cycle to the limiting shape.
//!
//! A rigid axisymmetric indenter is pressed into a half-space with `E(z) = E0 (z/z0)^k` and oscillated tangentially. Its centre sticks, an
//! annulus around it slips and wears, and in the end the worn profile reaches a shape in which the annulus carries no pressure any more.
//! That shape has a closed form, given in \[S\] "Effect of elastic grading on fretting wear", Scientific Reports, 2019. This library steps
//! through the cycles on the way there, by the method of dimensionality reduction, and compares with the closed form.
//!
//! # A run in memory
//!
//! ```
//! # std::env::set_current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes"))?;
//! use fretwear::Scene;
//!
//! let results = Scene::from_path("paraboloid.toml")?.simulate()?;
//! let worn_volume = results.worn_volume(); // m³, one for each snapshot
//! assert!(results.distance().unwrap().distance_relative.unwrap() < 1e-3);
//! println!("{}", results.summary());
//! # assert!(worn_volume.is_sorted());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`Simulation`] does the same with callbacks and a token that stops it, [`Run`] with a result file and checkpoints, [`Sweep`] for the scenes of a
//! [`Study`].
//!
//! # Equations and functions
//!
//! | equation of \[S\] | content | function |
//! |---|---|---|
//! | (1) | grading E = E0 (z/z0)^k | [`modulus_at_depth`] |
//! | (2) | limiting equivalent profile | [`LimitingShape::equivalent_profile`] |
//! | (3) | limiting wear depth | [`LimitingShape::wear_depth`] |
//! | (4) | worn volume: limit, state | [`LimitingShape::wear_volume`], `solver::model::Model::wear_volume` |
//! | (5) | power law | [`power_law_profile`] |
//! | (6) | its factor κ | [`power_law_factor`] |
//! | (7) | indentation | [`power_law_indentation`] |
//! | (8) | contact radius | [`power_law_contact_radius`] |
//! | (9) | (3) for a power law, by series | [`HypergeometricLimit::wear_depth`] |
//! | (10) | Gauss's hypergeometric function | [`gauss_hypergeometric`] |
//! | (11) | edge of stick | [`slip_compression`], [`stick_radius`] |
//! | (12) | M under elastic similarity | [`similar_stiffness_ratio`] |
//! | (13) | small parameter ε_a | [`relative_slip_width`] |
//! | (14) | limiting annulus at small amplitudes | [`relative_limit_width`] |
//! | (15) | worn volume at small amplitudes | [`small_amplitude_wear_volume`] |
//! | (16), (17), (18) | paraboloid | [`paraboloid_contact_radius`], [`paraboloid_stick_radius`], [`paraboloid_relative_slip_width`], [`paraboloid_small_amplitude_wear_volume`] |
//! | (19) | equivalent profile g(x): power laws, spheres, tables; any profile | [`EquivalentProfile`], [`Transforms::equivalent_profile`] |
//! | (20) | springs to profile, slip to surface: on a mesh; any profile | `numerics::abel::AbelOperators::profile`, [`Transforms::profile`] |
//! | (21), corrected | springs to pressure: on a mesh; any profile | `numerics::abel::AbelOperators::pressure`, [`Transforms::pressure`] |
//! | (22) | normal force | `EquivalentProfile::load_integral`, [`Transforms::load`], `solver::model::Model::normal_force` |
//!
//! Equation (21) as printed has a factor `x^k` too many, with which forces do not balance; the library uses it without and takes pressure
//! as positive.
//!
//! # The layers
//!
//! Each folder uses itself and what stands below it here, and no two modules of a folder use each other; `tests/layers.rs` keeps it so.
//!
//! | folder | what it holds |
//! |---|---|
//! | `cli` | the command line, one file a command |
//! | `figures` | pictures and pages made from result files |
//! | `study` | many scenes: sweeps and their jobs, universality, trade-off, wear maps, calibration |
//! | `report` | what the commands say: text, JSON, CSV |
//! | `run` | one scene from its first cycle to its end: springs by accuracy, error estimate, checkpoints |
//! | `scene` | the text of a scene or study: keys, units, ranges, schema |
//! | `data` | result files: quantities, HDF5, seals, atomic writing |
//! | `solver` | the discretised contact, implicit steps, the loop over cycles |
//! | `contact` | indenters, the half-space, the stick zone, closed forms |
//! | `laws` | friction, wear, motion, histories |
//! | `units` | quantities with units; what a key of a scene is |
//! | `numerics` | quadrature, roots, linear algebra, Abel transforms on a mesh |
//!
//! SI units everywhere, nothing is scaled behind the scenes; the library neither prints nor exits.
//!
//! # Features
//!
//! | feature | what it adds |
//! |---|---|
//! | `hdf5` | result files, and the studies that write them; needs the HDF5 library |
//! | `static-hdf5` | HDF5 built from its source and linked in, so that no system has to have it; needs CMake 3.26 to build |
//! | `figures` | pictures and pages made from result files |
//! | `cli` | the program `fretwear` |
//!
//! All but `static-hdf5` are on by default. Without them the library simulates in memory, and needs neither a C library nor signals.

#![warn(missing_docs)]
// Some helpers serve files and studies alone.
#![cfg_attr(not(feature = "figures"), allow(dead_code, unused_imports))]

// The inside: open to the tests and benches of the package, and no interface, so that it changes without notice.
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
#[doc(hidden)]
pub mod contact;
#[doc(hidden)]
pub mod data;
#[doc(hidden)]
pub mod error;
#[cfg(feature = "figures")]
#[doc(hidden)]
pub mod figures;
#[doc(hidden)]
pub mod laws;
#[doc(hidden)]
pub mod numerics;
#[doc(hidden)]
pub mod report;
#[doc(hidden)]
pub mod run;
#[doc(hidden)]
pub mod scene;
#[doc(hidden)]
pub mod solver;
#[cfg(feature = "hdf5")]
#[doc(hidden)]
pub mod study;
#[doc(hidden)]
pub mod units;

pub use contact::InitialContact;
pub use contact::closed_form::{
    Claimed, GibsonTransient, HypergeometricLimit, LimitingShape, PowerLawVolume, gauss_hypergeometric,
    gibson_wear_volume, paraboloid_contact_radius, paraboloid_normal_force, paraboloid_relative_slip_width,
    paraboloid_small_amplitude_wear_volume, paraboloid_stick_radius, power_law_contact_radius,
    power_law_indentation, power_law_profile, relative_limit_width, relative_slip_width,
    small_amplitude_wear_volume,
};
pub use contact::half_space::{HalfSpace, modulus_at_depth, similar_stiffness_ratio};
pub use contact::indenter::{EquivalentProfile, Indenter, TabulatedProfile, power_law_factor};
pub use contact::stick_slip::{
    FrettingRegime, Regime, full_sliding_amplitude, slip_amplitude, slip_compression, stick_radius,
};
pub use contact::transforms::Transforms;
pub use data::{LimitCurves, LimitDistance, Snapshot, StopReason};
#[cfg(feature = "hdf5")]
pub use data::{ResultPath, RunFile};
pub use error::{Domain, Error, Result};
#[cfg(feature = "figures")]
pub use figures::{FigureFile, Kind as FigureKind, Results as FigureSource};
pub use report::{CheckReport, LimitReport};
pub use run::{Expected, Results, Simulation, Stop};
#[cfg(feature = "hdf5")]
pub use run::{Resumed, Run};
pub use scene::{Calibration, MapScene, Scene, SceneBuilder, Study, UniversalityStudy};
#[cfg(feature = "hdf5")]
pub use study::calibration::{CalibrationReport, Outcome as CalibrationOutcome, calibrate};
#[cfg(feature = "hdf5")]
pub use study::sweep::{Sweep, SweepOptions, SweepOutcome, merge};
#[cfg(feature = "hdf5")]
pub use study::{Progress, Watch, run_many};
