//! The result file of a run: snapshots, the limit, and what a restart needs, in HDF5 that is also valid netCDF-4.
//!
//! [`RunWriter`] collects snapshots and replaces the file as a whole at each save; [`RunFile`] reads it back.
//! Names, units and shapes of all datasets stand in one table ([`layout`]).
//!
//! A file is laid out in memory, written to a temporary beside it, synchronised and renamed, so a run killed at
//! any moment leaves either the previous save or the new one, never a torn file.

#[cfg(feature = "hdf5")]
mod atomic;
mod cells;
mod dataset;
mod fingerprint;
#[cfg(feature = "hdf5")]
mod folder;
mod format;
#[cfg(feature = "hdf5")]
mod labelled;
pub mod layout;
pub mod quantity;
#[cfg(feature = "hdf5")]
mod reader;
#[cfg(feature = "hdf5")]
mod run_file;
mod save;
#[cfg(feature = "hdf5")]
mod scratch;
#[cfg(feature = "hdf5")]
mod seal;
#[cfg(feature = "hdf5")]
mod shard;
#[cfg(feature = "hdf5")]
mod surface;
#[cfg(feature = "hdf5")]
mod tables;
#[cfg(feature = "hdf5")]
mod target;
mod writer;

#[cfg(feature = "hdf5")]
pub(crate) use atomic::{AtomicFile, failure, remove_abandoned};
#[cfg(feature = "hdf5")]
pub(crate) use cells::{cell, table};
pub use dataset::{Attribute, Dataset, Number, Values, Variable, Words};
#[cfg(feature = "hdf5")]
pub(crate) use fingerprint::Fingerprint;
pub(crate) use fingerprint::scene_hash;
#[cfg(feature = "hdf5")]
pub use folder::{Mark, check_distinct, check_own, make_folder};
#[cfg(feature = "hdf5")]
pub(crate) use folder::{check_can_be_made, check_folder};
pub use format::Format;
pub use quantity::{Quantity, Reading, Value};
#[cfg(feature = "hdf5")]
pub use reader::format_of;
#[cfg(feature = "hdf5")]
pub use run_file::RunFile;
#[cfg(feature = "hdf5")]
pub(crate) use scratch::Scratch;
#[cfg(feature = "hdf5")]
pub use seal::ResultPath;
#[cfg(feature = "hdf5")]
pub use shard::{SweepFile, SweepHeader, column};
#[cfg(feature = "hdf5")]
pub use surface::SurfaceSeries;
#[cfg(feature = "hdf5")]
pub use tables::{DatasetSummary, ResultTables, TableSummary, VariableSummary};
#[cfg(feature = "hdf5")]
pub use target::write_file;
pub use writer::RunWriter;

use std::sync::Arc;

use serde::Serialize;

use crate::contact::indenter::TabulatedProfile;
use crate::contact::stick_slip::{FrettingRegime, Regime};
use crate::laws::motion::RecordedPath;
use crate::numerics::linear::largest;
use crate::solver::model::State;
use crate::solver::simulation::Progress;

/// What does not change during a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RunHeader {
    /// Title of the scene.
    pub title: Option<String>,
    /// The scene as TOML text, complete: a restart needs nothing else but the rows of a measured profile and of a recorded path.
    pub scene: String,
    /// Radius of the nodes, m, shape `(node,)`, increasing.
    pub radius: Vec<f64>,
    /// The limiting shape, where it has a closed form.
    pub limit: Option<LimitCurves>,
    /// The rows of a measured profile, if the indenter is one.
    pub table: Option<Arc<TabulatedProfile>>,
    /// The rows of a recorded path, if the indenter follows one.
    pub path: Option<Arc<RecordedPath>>,
}

impl RunHeader {
    /// SHA-256 of all that the results depend on, in hexadecimal digits: version of the program and of the format, the scene with its
    /// numerics, the rows of a measured profile and of a recorded path.
    pub fn scene_hash(&self, program_version: &str) -> String {
        scene_hash(program_version, &self.scene, self.table.as_deref(), self.path.as_deref())
    }
}

/// The limiting shape on the nodes of a run [S, Eqs. (3) and (9)].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LimitCurves {
    /// Limiting profile, m, shape `(node,)`.
    pub profile: Vec<f64>,
    /// Depth worn away in the limit, m, shape `(node,)`.
    pub wear_depth: Vec<f64>,
}

/// How far a worn profile is from the limiting shape, over all nodes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LimitDistance {
    /// Largest wear depth of the limit, m.
    pub wear_depth_max: f64,
    /// `sup |f - f∞| / d`.
    pub distance: f64,
    /// `sup |f - f∞|` over the limit's own largest depth; none if that is zero.
    pub distance_relative: Option<f64>,
}

impl LimitDistance {
    /// Distance of a snapshot from the limit on the same nodes.
    pub fn new(limit: &LimitCurves, snapshot: &Snapshot) -> Self {
        let wear_depth_max = largest(&limit.wear_depth);
        // The depths, not the profiles: their difference is the same and keeps more digits.
        let gap = limit
            .wear_depth
            .iter()
            .zip(&snapshot.wear_depth)
            .fold(0.0, |largest: f64, (limit, depth)| largest.max((limit - depth).abs()));
        Self {
            wear_depth_max,
            distance: gap / snapshot.indentation,
            distance_relative: (wear_depth_max > 0.0).then(|| gap / wear_depth_max),
        }
    }
}

/// Cycles of two runs are the same up to this part of them.
pub(crate) const SAME_CYCLES: f64 = 1e-9;

/// Whether a number of cycles of one run is that of another.
pub(crate) fn same_cycles(one: f64, other: f64) -> bool {
    (one - other).abs() <= SAME_CYCLES * other
}

/// The contact after some number of cycles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Snapshot {
    /// Number of cycles since the start, a real number.
    pub cycles: f64,
    /// Dimensionless time `τ`.
    pub tau: f64,
    /// What the oscillation does to the contact.
    pub regime: Regime,
    /// Worn volume, m³.
    pub wear_volume: f64,
    /// Contact radius, m.
    pub contact_radius: f64,
    /// Radius within which no spring slips in the cycle that is under way, m; zero under full sliding.
    pub stick_radius: f64,
    /// Radius within which no spring has slipped so far, m.
    pub permanent_stick_radius: f64,
    /// Largest indentation of the run, m.
    pub indentation: f64,
    /// Normal force at that indentation, N.
    pub normal_force: f64,
    /// Energy dissipated by friction since the start, J.
    pub dissipated_energy: f64,
    /// Energy dissipated by friction in one cycle, J.
    pub cycle_energy: f64,
    /// Largest tangential force along the fretting loop, N.
    pub tangential_force: f64,
    /// Energy ratio `A = W/(4 Q* δ*)` of the fretting loop; not a number where the indenter leaves the x axis.
    pub energy_ratio: f64,
    /// Sliding ratio of the loop, its width at no force over the stroke; not a number where the indenter leaves the x axis.
    pub sliding_ratio: f64,
    /// Tangential displacement along one period, m, shape `(point,)`; the last point is the first.
    pub loop_displacement: Vec<f64>,
    /// Tangential force along one period, N, shape `(point,)`.
    pub loop_force: Vec<f64>,
    /// Displacement along y, as the other; empty where the indenter stays on the x axis.
    pub loop_displacement_y: Vec<f64>,
    /// Force along y, N, as the displacement.
    pub loop_force_y: Vec<f64>,
    /// Worn profile, m, shape `(node,)`.
    pub profile: Vec<f64>,
    /// Wear depth, m, shape `(node,)`.
    pub wear_depth: Vec<f64>,
    /// Contact pressure, Pa, shape `(node,)`.
    pub pressure: Vec<f64>,
    /// Slip amplitude, m, shape `(node,)`.
    pub slip: Vec<f64>,
}

/// Fretting regime of a run up to each of its snapshots, as these show it.
pub fn fretting_regimes(snapshots: &[Snapshot]) -> Vec<FrettingRegime> {
    let mut before = None;
    let after = snapshots.iter().map(|it| {
        let now = FrettingRegime::after(before, it.regime, it.permanent_stick_radius == 0.0);
        *before.insert(now)
    });
    after.collect()
}

/// What a restart needs besides the header and the snapshots; every value survives the file bit for bit.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Checkpoint {
    /// State of the contact.
    pub state: State,
    /// Step size and counts.
    pub progress: Progress,
    /// Wall time used, s.
    pub wall_seconds: f64,
    /// Estimated error of worn volume and profile, relative to those of the limit, or to the largest of the run where there is none.
    pub error_estimate: Option<f64>,
    /// The accuracy that was asked for, where the program chose the springs.
    pub accuracy: Option<f64>,
    /// How often the run had been made anew.
    pub attempt: Attempt,
}

/// What an attempt takes finer than the accuracy asks for, besides its springs.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Fineness {
    /// Tolerance of the time stepping where that is smaller, else zero.
    pub tolerance: f64,
    /// Substeps of a period where those are more, else zero.
    pub substeps: u64,
}

/// How a run came to be made anew, so that one that was interrupted takes the same way.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Attempt {
    /// How often it was made anew on more springs or more finely, or need not be any more.
    pub refinements: u64,
    /// What it takes finer.
    pub fineness: Fineness,
    /// Springs on which it came to an end, if less accurately than was asked for; zero where it did not.
    pub ended_on: u64,
    /// [`Attempt::fineness`] there.
    pub ended_with: Fineness,
    /// Its estimated error there, relative; 1 where nothing is known of it, and zero where it did not.
    pub ended_within: f64,
    /// Its worn volume there, m³; zero where it did not, and NaN in files that do not tell.
    pub ended_volume: f64,
    /// Work of the attempts before, nanoseconds of one core, about.
    pub work: u64,
}

impl Checkpoint {
    /// Whether the estimated error is as small as was asked for; none where springs were given by hand.
    pub fn accuracy_met(&self) -> Option<bool> {
        self.accuracy.map(|accuracy| self.error_estimate.is_some_and(|error| error <= accuracy))
    }
}

/// Why a run stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StopReason {
    /// The last cycle asked for was reached.
    End,
    /// The rate of worn volume fell to the fraction asked for.
    Rate,
    /// A signal came, or the file is a checkpoint of a run that goes on.
    Interrupted,
    /// No pressure is left anywhere.
    WornOut,
    /// The rate asked for is never reached: the contact goes on wearing.
    Unending,
}

impl StopReason {
    const ALL: [Self; 5] = [Self::End, Self::Rate, Self::Interrupted, Self::WornOut, Self::Unending];

    /// Name in files and JSON: `end`, `rate`, `interrupted`, `worn-out` or `unending`.
    ///
    /// ```
    /// use fretwear::data::StopReason;
    /// assert_eq!(StopReason::WornOut.name(), "worn-out");
    /// assert_eq!(StopReason::from_name("worn-out"), Some(StopReason::WornOut));
    /// ```
    pub fn name(self) -> &'static str {
        match self {
            Self::End => "end",
            Self::Rate => "rate",
            Self::Interrupted => "interrupted",
            Self::WornOut => "worn-out",
            Self::Unending => "unending",
        }
    }

    /// The reason of that name, if there is one.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|reason| reason.name() == name)
    }
}
