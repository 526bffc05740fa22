//! Fretting wear of elastically graded media, from the first cycle to the limiting shape.
//!
//! A rigid axisymmetric indenter is pressed into a half-space with `E(z) = E0 (z/z0)^k` and oscillated tangentially. Its centre sticks, an
//! annulus around it slips and wears, and in the end the worn profile reaches a shape in which the annulus carries no pressure any more.
//! That shape has a closed form, given in \[S\] "Effect of elastic grading on fretting wear", Scientific Reports, 2019. This library steps
//! through the cycles on the way there, by the method of dimensionality reduction, and has the closed form beside it as the judge.
//!
//! # A run in memory
//!
//! A scene flows one way: text → [`scene::Scene`] → [`contact::InitialContact`] → [`model::Model`] → [`simulation::Simulation`]. The worn
//! volume of a homogeneous half-space (`k = 0`) under a paraboloid with the stick ratio `c/a0 = 0.7` at the dimensionless time `τ = 1` is
//! known from three-dimensional solvers to be `0.026873 a0² d`:
//!
//! ```
//! use fretwear::grid::Clustering;
//! use fretwear::model::Model;
//! use fretwear::scene::Scene;
//! use fretwear::simulation::{End, Plan, Simulation};
//! use fretwear::stepper::Implicit;
//!
//! // Units in which a0 = 1 and d = 2.
//! let scene = Scene::from_toml(
//!     r#"
//!     [indenter.power-law]
//!     coefficient = 1
//!     exponent = 2
//!     [half_space]
//!     grading = 0
//!     normal_stiffness = 1
//!     stiffness_ratio = 1
//!     [friction.coulomb]
//!     coefficient = 1
//!     [wear.archard]
//!     coefficient = 1
//!     [loading]
//!     indentation = 2
//!     stick_ratio = 0.7
//!     tau = 1
//!     "#,
//!     "example.toml",
//! )?;
//! let contact = scene.contact()?;
//! let model = Model::new(&contact, scene.conditions(), 60, Clustering::Smooth)?;
//! let cycles = 1.0 / contact.tau_per_cycle();
//! let plan = Plan { outputs: vec![cycles], end: End::Cycles(cycles) };
//! let tolerance = 1e-5;
//! let mut simulation = Simulation::new(model, Box::new(Implicit::new(tolerance)), tolerance, plan)?;
//! simulation.run(&mut [])?;
//! let volume = simulation.model().wear_volume(simulation.fields());
//! assert!((volume / 2.0 / 0.026873 - 1.0).abs() < 3e-3);
//! # Ok::<(), fretwear::Error>(())
//! ```
//!
//! [`run::Run`] does the same with a result file, checkpoints and signals.
//!
//! # Equations and functions
//!
//! | equation of \[S\] | content | function |
//! |---|---|---|
//! | (1) | grading E = E0 (z/z0)^k | [`half_space::modulus_at_depth`] |
//! | (2) | limiting equivalent profile | [`closed_form::LimitingShape::equivalent_profile`] |
//! | (3) | limiting wear depth | [`closed_form::LimitingShape::wear_depth`] |
//! | (4) | worn volume: limit, state | [`closed_form::LimitingShape::wear_volume`], [`model::Model::wear_volume`] |
//! | (5) | power law | [`closed_form::power_law_profile`] |
//! | (6) | its factor κ | [`indenter::power_law_factor`] |
//! | (7) | indentation | [`closed_form::power_law_indentation`] |
//! | (8) | contact radius | [`closed_form::power_law_contact_radius`] |
//! | (9) | (3) for a power law, by series | [`closed_form::HypergeometricLimit::wear_depth`] |
//! | (10) | Gauss's hypergeometric function | [`closed_form::gauss_hypergeometric`] |
//! | (11) | edge of stick | [`stick_slip::slip_compression`], [`stick_slip::stick_radius`] |
//! | (12) | M under elastic similarity | [`half_space::similar_stiffness_ratio`] |
//! | (13) | small parameter ε_a | [`closed_form::relative_slip_width`] |
//! | (14) | limiting annulus at small amplitudes | [`closed_form::relative_limit_width`] |
//! | (15) | worn volume at small amplitudes | [`closed_form::small_amplitude_wear_volume`] |
//! | (16), (17), (18) | paraboloid | [`closed_form::paraboloid_contact_radius`], [`closed_form::paraboloid_stick_radius`], [`closed_form::paraboloid_relative_slip_width`], [`closed_form::paraboloid_small_amplitude_wear_volume`] |
//! | (19) | equivalent profile g(x): power laws, spheres, tables; any profile | [`indenter::EquivalentProfile`], [`transforms::Transforms::equivalent_profile`] |
//! | (20) | springs to profile, slip to surface: on a mesh; any profile | [`abel::AbelOperators::profile`], [`transforms::Transforms::profile`] |
//! | (21), corrected | springs to pressure: on a mesh; any profile | [`abel::AbelOperators::pressure`], [`transforms::Transforms::pressure`] |
//! | (22) | normal force | [`indenter::EquivalentProfile::load_integral`], [`transforms::Transforms::load`], [`model::Model::normal_force`] |
//!
//! Equation (21) as printed has a factor `x^k` too many, with which forces do not balance; the library uses it without and takes pressure
//! as positive.
//!
//! # The storeys of the house
//!
//! Each module uses only modules to its right in its own storey, and storeys below; `tests/house.rs` keeps it so.
//!
//! | storey | modules |
//! |---|---|
//! | entry | the binary; this page |
//! | jobs | [`submit`], [`sweep`], [`page`], [`figures`], [`report`], [`export`], [`universality`], [`tradeoff`], [`progress`], [`run`], [`wear_map`], [`drawing`] |
//! | files | [`scene`], [`snapshot`] |
//! | time | [`simulation`], [`stepper`], [`model`] |
//! | physics | [`closed_form`], [`contact`], [`slip_depth`], [`stick_slip`], [`conditions`], [`wear`], [`spring`], [`path`], [`friction`], [`loading`], [`history`], [`indenter`], [`half_space`] |
//! | numerics | [`transforms`], [`abel`], [`chebyshev`], [`linear`], [`quadrature`], [`roots`], [`grid`], [`error`] |
//!
//! SI units everywhere, nothing is scaled behind the scenes; the library neither prints nor exits.

pub mod abel;
pub mod chebyshev;
pub mod closed_form;
pub mod conditions;
pub mod contact;
pub mod drawing;
pub mod error;
pub mod export;
pub mod figures;
pub mod friction;
pub mod grid;
pub mod half_space;
pub mod history;
pub mod indenter;
pub mod linear;
pub mod loading;
pub mod model;
pub mod page;
pub mod path;
pub mod progress;
pub mod quadrature;
pub mod report;
pub mod roots;
pub mod run;
pub mod scene;
pub mod simulation;
pub mod slip_depth;
pub mod snapshot;
pub mod spring;
pub mod stepper;
pub mod stick_slip;
pub mod submit;
pub mod sweep;
pub mod tradeoff;
pub mod transforms;
pub mod universality;
pub mod wear;
pub mod wear_map;

pub use error::{Error, Result};
