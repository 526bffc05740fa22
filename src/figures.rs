//! Figures of result files, one kind a file.
//!
//! A figure is made from a result file alone:
//!
//! ```
//! use std::path::Path;
//! use fretwear::figures::drawing::{Drawing, Spacing};
//! use fretwear::figures::{Kind, Results};
//! use fretwear::run::Run;
//! use fretwear::scene::Scene;
//!
//! let folder = tempfile::tempdir()?;
//! let file = folder.path().join("run.h5");
//! Run::new(&Scene::from_path(Path::new("data/scenes/paraboloid.toml"))?, &file, false, &Default::default())?.execute(None)?;
//! let results = Results::read(&file)?;
//! assert_eq!(results.kinds()[0], Kind::Profile);
//! let figure = results.figure(Kind::History, None)?;
//! let volume = figure.panels().next().expect("it has four");
//! assert_eq!((volume.x.spacing, volume.y.text().as_str()), (Spacing::Logarithmic, "worn volume Δ*V* (µm³)"));
//! assert!(Drawing::new(&figure, "history").svg.starts_with("<svg"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod approach;
mod calibration;
mod curve;
pub mod drawing;
mod history;
mod loops;
mod map;
mod measure;
mod optimum;
mod output;
pub mod page;
mod pressure;
mod profile;
mod regimes;
mod rings;
mod run;
mod sweep;
mod tradeoff;
mod universality;
mod worn_profiles;

pub use output::FigureFile;
pub use run::RunResults;

use std::path::Path;

use crate::data::{Dataset, Format, ResultPath, RunFile, SweepFile, format_of};
use crate::error::{Error, Result};
use crate::figures::drawing::Figure;

/// What a figure shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Profile of a run: unworn, at some snapshots, in the limit.
    Profile,
    /// Pressure and slip at some snapshots.
    Pressure,
    /// Worn volume, depth, radii and normal force over cycles.
    History,
    /// Distance from the limit.
    Approach,
    /// Fretting loops and energy.
    Loops,
    /// Worn volume over grading and amplitude [S, Fig. 2].
    Map,
    /// Worn profiles of several gradings [S, Fig. 1].
    WornProfiles,
    /// The grading that wears least.
    Optimum,
    /// Laws, modes and media against one limit, with the negative controls.
    Universality,
    /// Error against cost.
    Tradeoff,
    /// Data beside what is fitted to them, and how the misfit rises with each unknown.
    Calibration,
    /// A result of a sweep over what is varied.
    Sweep,
    /// Fretting regimes over cycles and what a sweep varies.
    Regimes,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 13] = [
        Self::Profile,
        Self::Pressure,
        Self::History,
        Self::Approach,
        Self::Loops,
        Self::Map,
        Self::WornProfiles,
        Self::Optimum,
        Self::Universality,
        Self::Tradeoff,
        Self::Calibration,
        Self::Sweep,
        Self::Regimes,
    ];

    /// Name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Profile => "profile",
            Self::Pressure => "pressure",
            Self::History => "history",
            Self::Approach => "approach",
            Self::Loops => "loops",
            Self::Map => "map",
            Self::WornProfiles => "worn-profiles",
            Self::Optimum => "optimum",
            Self::Universality => "universality",
            Self::Tradeoff => "tradeoff",
            Self::Calibration => "calibration",
            Self::Sweep => "sweep",
            Self::Regimes => "regimes",
        }
    }
}

/// A result file of any kind.
#[derive(Debug, Clone)]
pub enum Results {
    /// Of `fretwear run`.
    Run(Box<RunResults>),
    /// Of `fretwear sweep` or `merge`.
    Sweep(Box<SweepFile>),
    /// Of `fretwear map`.
    Map(Dataset),
    /// Of `fretwear universality`.
    Universality(Dataset),
    /// Of `fretwear tradeoff`.
    Tradeoff(Dataset),
    /// Of `fretwear calibrate`.
    Calibration(Dataset),
}

impl Results {
    /// Reads a result file.
    ///
    /// # Errors
    /// [`Error::File`] names the file, what in it cannot be used, and the cure; [`Error::Scene`] if the scene in it is not valid.
    pub fn read<'a>(file: impl Into<ResultPath<'a>>) -> Result<Self> {
        let file = file.into().ready()?;
        let format = format_of(file)?;
        let arrays = |kind: fn(Dataset) -> Self| Dataset::read(file, format).map(kind);
        match format {
            Format::Run => RunResults::new(RunFile::open(file)?, file.path()).map(Box::new).map(Self::Run),
            Format::Map => arrays(Self::Map),
            Format::Universality => arrays(Self::Universality),
            Format::Tradeoff => arrays(Self::Tradeoff),
            Format::Calibration => arrays(Self::Calibration),
            Format::Sweep => SweepFile::read(file).map(Box::new).map(Self::Sweep),
        }
    }

    /// A run that is in memory.
    ///
    /// # Errors
    /// Those of the closed form.
    pub fn of_run(run: crate::run::Results) -> Result<Self> {
        RunResults::new(run.into_file(), Path::new("run")).map(Box::new).map(Self::Run)
    }

    /// The kinds of figures that fit, the most telling one first.
    pub fn kinds(&self) -> Vec<Kind> {
        match self {
            Self::Run(run) => run.kinds(),
            Self::Sweep(file) if regimes::fits(file) => vec![Kind::Sweep, Kind::Regimes],
            Self::Sweep(_) => vec![Kind::Sweep],
            Self::Map(_) => vec![Kind::Map, Kind::WornProfiles, Kind::Optimum],
            Self::Universality(_) => vec![Kind::Universality],
            Self::Tradeoff(_) => vec![Kind::Tradeoff],
            Self::Calibration(_) => vec![Kind::Calibration],
        }
    }

    /// What the file is of, in words.
    pub fn what(&self) -> &'static str {
        match self {
            Self::Run(_) => "a run",
            Self::Sweep(_) => "a sweep",
            Self::Map(_) => "a comparison of gradings",
            Self::Universality(_) => "a study of universality",
            Self::Tradeoff(_) => "a trade-off",
            Self::Calibration(_) => "a calibration",
        }
    }

    /// A figure, its lines without the points that nobody sees.
    ///
    /// # Arguments
    /// * `kind` -- what it shows
    /// * `quantity` -- which result of a sweep, the name of a dataset; by default the worn volume
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if the kind does not fit, or there is too little to draw; [`Error::File`] if something is missing in the file.
    pub fn figure(&self, kind: Kind, quantity: Option<&str>) -> Result<Figure> {
        if !self.kinds().contains(&kind) {
            return Err(self.misfit(kind));
        }
        if quantity.is_some() && kind != Kind::Sweep {
            let why = format!("is chosen for figures of a sweep only, and the file is of {}", self.what());
            return Err(Error::Inconsistent { what: "quantity", why });
        }
        let mut figure = match self {
            Self::Run(run) => of_run(run, kind),
            Self::Sweep(file) if kind == Kind::Regimes => regimes::figure(file),
            Self::Sweep(file) => sweep::figure(file, quantity),
            Self::Map(file) if kind == Kind::WornProfiles => worn_profiles::figure(file),
            Self::Map(file) if kind == Kind::Optimum => optimum::figure(file),
            Self::Map(file) => map::figure(file),
            Self::Universality(file) => universality::figure(file),
            Self::Tradeoff(file) => tradeoff::figure(file),
            Self::Calibration(file) => calibration::figure(file),
        }?;
        figure.thin();
        Ok(figure)
    }

    fn misfit(&self, kind: Kind) -> Error {
        let fitting: Vec<&str> = self.kinds().into_iter().map(Kind::name).collect();
        let give = if fitting.is_empty() { String::new() } else { format!("; give {}", fitting.join(", ")) };
        let why = format!(
            "{} does not fit, the file is of {}{}{give}",
            kind.name(),
            self.what(),
            self.why_not(kind)
        );
        Error::Inconsistent { what: "kind", why }
    }

    /// Why a run lacks a kind that runs may have.
    fn why_not(&self, kind: Kind) -> &'static str {
        match (self, kind) {
            (Self::Run(_), Kind::Approach) => {
                " that has no limit in closed form or no snapshot after the start"
            }
            (Self::Run(_), Kind::Loops) => " that stores no fretting loops",
            (Self::Run(_), Kind::History | Kind::Pressure | Kind::Profile) => " with too few snapshots",
            (Self::Sweep(_), Kind::Regimes) => {
                " that varies not exactly one number, or keeps no snapshots (output.snapshots = \"all\")"
            }
            _ => "",
        }
    }
}

fn of_run(run: &RunResults, kind: Kind) -> Result<Figure> {
    let rows = match kind {
        Kind::Pressure => pressure::rows(run),
        Kind::History => history::rows(run),
        Kind::Approach => approach::rows(run),
        Kind::Loops => loops::rows(run),
        _ => profile::rows(run),
    };
    Ok(Figure { title: run.run.header.title.as_deref().map(drawing::plain), rows, notes: run.notes() })
}
