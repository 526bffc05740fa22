//! What the program asks of a mode of motion.

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use serde::{Serialize, Serializer};
use serde_json::Value;

use crate::laws::entry::Entry;
use crate::laws::path::{Path, PathPoint};

/// Points of a period by which a mode is told from oscillation to and fro.
const SAMPLES: usize = 64;

/// What the indenter does over one period, of which the tangential oscillation `u_x = U cos ωt` is a part.
///
/// Solvers ask for its properties, never for its name.
pub trait Mode: Any + Debug + Send + Sync {
    /// Its entry in the table of modes; none for plain tangential oscillation.
    fn entry(&self) -> Option<&'static Entry<dyn Mode>> {
        None
    }

    /// Its numbers, as JSON tells them.
    fn told(&self) -> Vec<(&'static str, Value)> {
        vec![]
    }

    /// The mode and its numbers, as reports say it.
    fn words(&self) -> String;

    /// The corners of one period; the smallest lift is zero. A curved path is second order in the substeps.
    ///
    /// # Arguments
    /// * `amplitude` -- `U`, m
    /// * `substeps` -- about how many; raised to what the reversals and extrema need
    fn period(&self, amplitude: f64, substeps: usize) -> Vec<PathPoint>;

    /// The corners of [`Mode::period`], with those at which `u_x + slope · lift` and `u_x - slope · lift` turn where a mode knows them: with the slope
    /// `μ_f/M` springs along a line begin to stick there, whatever their compression.
    ///
    /// # Arguments
    /// * `amplitude`, `substeps` -- as [`Mode::period`] takes them
    fn period_with_turns(&self, amplitude: f64, substeps: usize, _slope: f64) -> Vec<PathPoint> {
        self.period(amplitude, substeps)
    }

    /// Tangential oscillations in the period.
    fn oscillations(&self) -> u32 {
        1
    }

    /// Times in the period at which the indentation is largest.
    fn peaks(&self) -> u32 {
        1
    }

    /// Smallest and largest indentation over that of the scene, m.
    fn indentations(&self) -> [f64; 2] {
        [0.0; 2]
    }

    /// The mode with its own displacements along the surface times `factor`; none where it has none.
    fn scaled(&self, _factor: f64) -> Option<Arc<dyn Mode>> {
        None
    }

    /// Tangential amplitude, m, of a mode that decides it itself.
    fn amplitude(&self) -> Option<f64> {
        None
    }

    /// What it was recorded as, column by column.
    fn rows(&self) -> Vec<&[f64]> {
        vec![]
    }
}

impl dyn Mode {
    /// Whether it is plain tangential oscillation, of which a cycle has a closed form.
    pub fn is_tangential(&self) -> bool {
        self.entry().is_none()
    }

    /// Whether the indentation changes within the period.
    pub fn changes_indentation(&self) -> bool {
        self.indentations() != [0.0; 2]
    }

    /// The oscillation to and fro along a line, through where the indenter is pressed on, that comes nearest to it.
    ///
    /// # Arguments
    /// * `amplitude` -- `U`, m, along x
    /// * `indentation` -- `d`, m
    pub fn to_and_fro(&self, amplitude: f64, indentation: f64) -> ToAndFro {
        if self.is_tangential() {
            return ToAndFro { amplitude, angle: 0.0, departure: 0.0 };
        }
        let period = self.period(amplitude, SAMPLES);
        let reach = |point: &&PathPoint| point.tangential[0].hypot(point.tangential[1]);
        let [x, y] = period
            .iter()
            .max_by(|one, other| reach(one).total_cmp(&reach(other)))
            .map_or([amplitude, 0.0], |farthest| farthest.tangential);
        let amplitude = x.hypot(y);
        let line = [x, y].map(|it| it / amplitude * if x < 0.0 { -1.0 } else { 1.0 });
        let aside = |point: &PathPoint| {
            let [x, y] = point.tangential;
            ((line[0] * y - line[1] * x) / amplitude).abs().max(point.lift / indentation)
        };
        let deeper = self.indentations().map(|by| (by / indentation).abs());
        let aside = period.iter().map(aside).chain(deeper).fold(0.0, f64::max);
        let along = |point: &PathPoint| line[0] * point.tangential[0] + line[1] * point.tangential[1];
        let along: Vec<f64> = period.iter().map(along).collect();
        let moves = along.iter().zip(along.iter().cycle().skip(1)).map(|(from, to)| to - from);
        let moves: Vec<(f64, f64)> = along.iter().copied().zip(moves).filter(|(_, by)| *by != 0.0).collect();
        // Where the motion turns, it starts in the direction it did not come from.
        let before = moves.iter().cycle().skip(moves.len().saturating_sub(1));
        let turns = before.zip(&moves).filter(|((_, came), (_, goes))| came * goes < 0.0);
        let mut count = 0;
        let short = turns.map(|(_, (at, goes))| {
            count += 1;
            (at / amplitude + goes.signum()).abs()
        });
        let short = short.fold(0.0, f64::max);
        let departure = if count == 2 * self.oscillations() { aside.max(short) } else { f64::INFINITY };
        ToAndFro { amplitude, angle: line[1].atan2(line[0]), departure }
    }

    fn name(&self) -> String {
        self.entry().map_or("tangential".into(), |entry| entry.name.replace('_', "-"))
    }
}

/// An oscillation to and fro along a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToAndFro {
    /// Half of the stroke along the line, m.
    pub amplitude: f64,
    /// Angle from x to the line, rad.
    pub angle: f64,
    /// What the motion differs by from it, relative to amplitude and indentation.
    pub departure: f64,
}

impl PartialEq for dyn Mode {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name() && self.told() == other.told() && self.rows() == other.rows()
    }
}

impl Serialize for dyn Mode {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let told = self.told().into_iter();
        serializer.collect_map([("kind", self.name().into())].into_iter().chain(told))
    }
}

/// A mode as a path.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledPath {
    /// One period.
    pub path: Path,
    /// Largest indentation of the period, `d_max`, m, from which lift is measured.
    pub largest_indentation: f64,
    /// Tangential oscillations in the period: `n` of a ratio `m/n` of frequencies, else one.
    pub oscillations: u32,
}

impl SampledPath {
    /// The path of a mode over one period.
    ///
    /// # Arguments
    /// * `amplitude`, `substeps` -- as [`Mode::period`] takes them
    /// * `indentation` -- `d`, m, of the scene
    ///
    /// ```
    /// use fretwear::laws::motion::{NormalOscillation, SampledPath};
    ///
    /// let mode = NormalOscillation { amplitude: 0.1, frequency_ratio: [1, 2], phase: 0.3 };
    /// let sampled = SampledPath::new(&mode, 2.0, 1.0, 40);
    /// assert_eq!((sampled.largest_indentation, sampled.oscillations), (1.1, 2));
    /// let reversals = sampled.path.points.iter().filter(|point| point.tangential[0].abs() == 2.0);
    /// assert_eq!(reversals.count(), 4);
    /// ```
    pub fn new(mode: &dyn Mode, amplitude: f64, indentation: f64, substeps: usize) -> Self {
        Self {
            path: Path { points: mode.period(amplitude, substeps) },
            largest_indentation: indentation + mode.indentations()[1],
            oscillations: mode.oscillations(),
        }
    }

    /// The same with the corners at which springs begin to stick, see [`Mode::period_with_turns`].
    pub fn with_turns(
        mode: &dyn Mode,
        amplitude: f64,
        indentation: f64,
        substeps: usize,
        slope: f64,
    ) -> Self {
        Self {
            path: Path { points: mode.period_with_turns(amplitude, substeps, slope) },
            largest_indentation: indentation + mode.indentations()[1],
            oscillations: mode.oscillations(),
        }
    }
}
