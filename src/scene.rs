//! A scene: the TOML text that describes a run, read into data that cannot be invalid.
//!
//! ```
//! use fretwear::laws::loading::Duration;
//! use fretwear::scene::Scene;
//!
//! let text = r#"
//!     [indenter.paraboloid]
//!     radius = "10 mm"
//!     [half_space]
//!     grading = 0.0
//!     modulus = "210 GPa"
//!     poisson_ratio = 0.3
//!     [friction.coulomb]
//!     coefficient = 0.6
//!     [wear.archard]
//!     coefficient = "1e-14 1/Pa"
//!     [loading]
//!     initial_force = "50 N"
//!     stick_ratio = 0.7
//!     tau = 30
//! "#;
//! let scene = Scene::from_toml(text, "example.toml")?;
//! assert_eq!(scene.loading().duration, Duration::Tau(30.0));
//!
//! let error = Scene::from_toml(&text.replace("10 mm", "10 MPa"), "example.toml").unwrap_err();
//! assert!(error.to_string().starts_with("example.toml:3:14: indenter.paraboloid.radius: expected a length"));
//! # Ok::<(), fretwear::Error>(())
//! ```

use std::any::Any;
use std::path::Path;
use std::sync::Arc;

use crate::contact::InitialContact;
use crate::contact::half_space::HalfSpace;
use crate::contact::indenter::{Indenter, TabulatedProfile};
use crate::error::{Error, Result};
use crate::laws::conditions::Conditions;
use crate::laws::friction::Coulomb;
use crate::laws::loading::Loading;
use crate::laws::motion::RecordedPath;
use crate::laws::wear::Archard;

mod builder;
mod calibration;
mod columns;
mod document;
pub(crate) mod input;
mod keys;
mod laws;
mod map;
mod motion;
mod page;
mod patch;
mod reading;
pub mod sampling;
pub mod schema;
mod sections;
mod settings;
mod spacing;
mod study;
mod universality;

pub use builder::SceneBuilder;
pub use calibration::{Calibration, DataSet, Deviation, Measured, Unknown};
use input::{Pipes, Unread};
pub use keys::MOST_SCENES;
pub use map::MapScene;
pub use page::page_of_keys;
pub use study::{Input, KeptSnapshots, Study, Task};
pub use universality::{
    Case, FACTORS, MOST_COMBINATIONS, Prediction, Tolerances, UniversalityStudy, covering_design,
};

/// Most snapshots a scene may ask for.
pub const MOST_SNAPSHOTS: usize = 100_000;

/// Most substeps of one period that a scene may ask for.
pub const MOST_SUBSTEPS: usize = 100_000;

/// Size of the largest scene read, bytes; one with [`MOST_SNAPSHOTS`] times in it has 2 MB.
const LARGEST: u64 = 10_000_000;

/// How one cycle after the other is passed through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Stepper {
    /// Every cycle by itself.
    EveryCycle,
    /// Explicit steps over many cycles.
    CycleJump,
    /// Implicit steps over many cycles.
    #[default]
    Implicit,
}

impl Stepper {
    /// All methods, in the order of their cost.
    pub const ALL: [Self; 3] = [Self::EveryCycle, Self::CycleJump, Self::Implicit];

    /// Their words in a scene, in the same order.
    pub const WORDS: [&'static str; 3] = ["every-cycle", "cycle-jump", "implicit"];

    /// The word of the scene: `every-cycle`, `cycle-jump` or `implicit`.
    pub fn name(self) -> &'static str {
        Self::WORDS[self as usize]
    }
}

/// How the slip of one cycle is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cycle {
    /// By a formula, which is exact for tangential oscillation.
    ClosedForm,
    /// By following the springs through the period, in substeps.
    Resolved,
}

impl Cycle {
    /// Both ways.
    pub const ALL: [Self; 2] = [Self::ClosedForm, Self::Resolved];

    /// Their words in a scene, in the same order.
    pub const WORDS: [&'static str; 2] = ["closed-form", "resolved"];

    /// The word of the scene: `closed-form` or `resolved`.
    pub fn name(self) -> &'static str {
        Self::WORDS[self as usize]
    }
}

/// Finest accuracy that may be asked for: some units of round-off in the depths above what they are good to (docs/accuracy.md).
pub const FINEST_ACCURACY: f64 = 1e-10;

/// The table `[numerics]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Numerics {
    /// Accuracy asked for, in [1e-10, 0.1]; it decides what is not given by hand.
    pub accuracy: f64,
    /// Springs over the slip annulus, at least 8, if given by hand.
    pub springs: Option<usize>,
    /// Method of time stepping.
    pub stepper: Stepper,
    /// Tolerance of the time stepping relative to the limit's largest depth, in (0, 0.1], if given by hand.
    pub tolerance: Option<f64>,
    /// How the slip of one cycle is found; none is by formula where that is exact, else resolved.
    pub cycle: Option<Cycle>,
    /// Substeps of one period where it is resolved, from 2 to [`MOST_SUBSTEPS`], if given by hand.
    pub substeps: Option<usize>,
    /// Wall time between checkpoints, s, in [0, 1e9].
    pub checkpoint_interval: f64,
}

impl Numerics {
    /// The accuracy asked for, where the program chooses the springs.
    pub fn accuracy_asked(&self) -> Option<f64> {
        self.springs.is_none().then_some(self.accuracy)
    }
}

/// The table `[output]`: when snapshots are taken besides the start and the end.
#[derive(Debug, Clone, PartialEq)]
pub enum Output {
    /// This many after the start, from 1 to [`MOST_SNAPSHOTS`], spread geometrically in cycles; the last is the end.
    Snapshots(usize),
    /// At these numbers of cycles, increasing, at least 0.
    AtCycles(Vec<f64>),
    /// At these dimensionless times, increasing, at least 0.
    AtTau(Vec<f64>),
}

/// Where the rows of a measured profile and of a recorded path are.
enum Rows<'a> {
    /// In files, relative to this folder.
    In(&'a Path),
    /// In memory, if at all.
    Stored(Vec<Arc<dyn Any + Send + Sync>>),
}

/// A valid description of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    title: Option<String>,
    indenter: Indenter,
    half_space: HalfSpace,
    friction: Coulomb,
    wear: Archard,
    loading: Loading,
    conditions: Conditions,
    path: Option<Arc<RecordedPath>>,
    numerics: Numerics,
    output: Output,
    text: String,
    warnings: Vec<String>,
}

impl Scene {
    /// Reads a scene from its TOML text; the files that it names are taken relative to the current directory.
    ///
    /// # Arguments
    /// * `text` -- the TOML
    /// * `name` -- what messages call it, the path of the file as a rule
    ///
    /// # Errors
    /// [`Error::Scene`], whose message shows file, line and column, the line with the bad place marked, the key, and the cure;
    /// [`Error::File`] where the file of a measured profile or of a recorded path cannot be used.
    pub fn from_toml(text: &str, name: &str) -> Result<Self> {
        Self::with_rows(text, name, &Rows::In(Path::new("")))
    }

    /// Reads a scene as [`Scene::from_toml`] does, but takes the rows of a measured profile and of a recorded path as they were stored
    /// with it.
    ///
    /// # Errors
    /// As [`Scene::from_toml`]; also if the scene asks for rows and there are none.
    pub fn from_stored(
        text: &str,
        name: &str,
        table: Option<Arc<TabulatedProfile>>,
        path: Option<Arc<RecordedPath>>,
    ) -> Result<Self> {
        let stored = [table.map(|it| it as _), path.map(|it| it as _)];
        Self::with_rows(text, name, &Rows::Stored(stored.into_iter().flatten().collect()))
    }

    fn with_rows(text: &str, name: &str, rows: &Rows) -> Result<Self> {
        let source = document::Source { name, text, kind: "a scene" };
        if text.len() as u64 > LARGEST {
            return Err(source.unplaced(format_args!("is larger than {LARGEST} bytes, which no scene is")));
        }
        let document = source.parse()?;
        sections::scene(&document::Section::root(source, document.get_ref()), text, rows)
    }

    /// Reads a scene from a TOML file; the files that it names are taken relative to its folder.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be read as text, else as [`Scene::from_toml`].
    pub fn from_path(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::with_rows(&read_text(path)?, &path.display().to_string(), &Rows::In(folder))
    }

    /// Title, one line.
    pub fn title(&self) -> Option<&str> {
        self.title.as_deref()
    }

    /// Shape of the indenter.
    pub fn indenter(&self) -> &Indenter {
        &self.indenter
    }

    /// The rows of a measured profile, if the indenter is one.
    pub fn table(&self) -> Option<Arc<TabulatedProfile>> {
        self.indenter.table()
    }

    /// Spring stiffnesses; those of two elastic bodies are already in series.
    pub fn half_space(&self) -> &HalfSpace {
        &self.half_space
    }

    /// The recorded path, if the indenter follows one.
    pub fn path(&self) -> Option<Arc<RecordedPath>> {
        self.path.clone()
    }

    /// Laws, mode, blocks and control: plain tangential oscillation under Coulomb's and Archard's laws, or something else.
    pub fn conditions(&self) -> &Conditions {
        &self.conditions
    }

    /// Coulomb's law that stands for the law of friction in the unworn contact, the closed form and the dimensionless time
    /// ([`FrictionLaw::reference_coefficient`](crate::laws::friction::FrictionLaw::reference_coefficient)).
    pub fn friction(&self) -> &Coulomb {
        &self.friction
    }

    /// Archard's law that stands for the law of wear in the closed form and the dimensionless time ([`InitialContact::reference_wear`]).
    pub fn wear(&self) -> &Archard {
        &self.wear
    }

    /// Load, amplitude and duration; along a recorded path the amplitude is half of its width.
    pub fn loading(&self) -> &Loading {
        &self.loading
    }

    /// How the run is computed.
    pub fn numerics(&self) -> &Numerics {
        &self.numerics
    }

    /// When snapshots are taken.
    pub fn output(&self) -> &Output {
        &self.output
    }

    /// The unworn contact that the scene describes.
    ///
    /// # Errors
    /// As [`InitialContact::new`].
    pub fn contact(&self) -> Result<InitialContact> {
        InitialContact::new(&self.indenter, &self.half_space, &self.friction, &self.wear, &self.loading)
    }

    /// Shows an error that names a key of the scene, as it comes from what is computed with it, at that key.
    ///
    /// # Arguments
    /// * `error` -- any error; what is none of a value is given back
    /// * `name` -- what messages call the scene, the path of the file as a rule
    ///
    /// # Examples
    /// ```
    /// use fretwear::Error;
    /// use fretwear::scene::Scene;
    ///
    /// let scene = Scene::from_toml(include_str!("../data/scenes/paraboloid.toml"), "ball.toml")?;
    /// let error = Error::Inconsistent { what: "loading.amplitude", why: "is too large".into() };
    /// assert!(scene.locate(error, "ball.toml").to_string().starts_with("ball.toml:29:13: loading.amplitude: is too large"));
    /// # Ok::<(), Error>(())
    /// ```
    pub fn locate(&self, error: Error, name: &str) -> Error {
        let source = document::Source { name, text: &self.text, kind: "a scene" };
        let Ok(document) = source.parse() else { return error };
        let root = document::Section::root(source, document.get_ref());
        match error {
            Error::OutOfRange { name, value, range } => {
                root.at_key(name, format_args!(" = {value} is outside {range}"))
            }
            Error::Inconsistent { what, why } => root.at_key(what, format_args!(": {why}")),
            other => other,
        }
    }

    /// The TOML text as it was read.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// What is allowed but deserves a word, one sentence each.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }
}

/// Reads a TOML file, bounded in size.
pub(crate) fn read_text(path: &Path) -> Result<String> {
    let read = input::bytes(path, LARGEST, Pipes::Read).and_then(input::text);
    read.map_err(|unread| {
        let cure = match unread {
            Unread::Missing => "",
            Unread::TooLarge(_) => ", which no such file is",
            Unread::NotText(_) => "; it must be a TOML file in UTF-8",
            _ => "; name a TOML file",
        };
        Error::File { path: path.to_path_buf(), why: format!("{unread}{cure}") }
    })
}

/// The values of a base scene.
///
/// # Errors
/// [`Error::Scene`] shows the line that is not TOML.
fn base_table(text: &str, path: &Path) -> Result<toml::Table> {
    let name = path.display().to_string();
    document::Source { name: &name, text, kind: "a scene" }.values()
}
