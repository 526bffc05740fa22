//! The path of the indenter over one period.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::laws::loading::{Mode, RecordedPath};
use crate::numerics::roots::bracketed;

/// Part of half a normal period near the largest indentation below which points lie evenly; beyond, half of them lie evenly in its
/// logarithm. A spring loaded within `1e-9 d_1` of the largest indentation is so for `1.4e-5` of the half period.
const EVEN_NEAR_PEAK: f64 = 1e-5;

/// Part of a tangential half period within which an extremum of the indentation counts as simultaneous with a reversal: beyond the
/// round-off of the phase, and far below what an experiment could tell.
const SIMULTANEOUS: f64 = 1e-9;

/// A place of the indenter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PathPoint {
    /// Tangential displacements `u_x`, `u_y` from where it was pressed on, m.
    pub tangential: [f64; 2],
    /// How far it is lifted from the largest indentation of the path, `d_max - d >= 0`, m.
    pub lift: f64,
}

/// A closed path of straight lines; the last point leads back to the first.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// The corners, at least two; the smallest lift is zero.
    pub points: Vec<PathPoint>,
}

/// A mode of loading as a path.
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
    /// Reversals are hit exactly, and so are the extrema of the indentation, where the lift is exactly `0` and `2 d_1`.
    ///
    /// * Tangential oscillation: from `U` to `-U` and back in even steps. A path along a line is the same however it is cut, so two substeps
    ///   are as good as any number.
    /// * Normal oscillation: from the reversal at `t = 0` on. Points cluster towards every time of largest indentation, for near the limit
    ///   of wear springs are loaded nowhere else: of `J` substeps in half a normal period half lie evenly, half evenly in the logarithm of
    ///   the time from the peak, down to `1e-5` of the half period. Next to a reversal, where the indenter hardly moves, substeps are never
    ///   shorter than half of their neighbours: `M |Δu| < μ_f |Δd|` in one of them is stick, which should come from the motion and not from
    ///   the place of a sample. A peak within `1e-9` of a half period of a reversal is one with it.
    /// * Orbit: even steps of `ωt`, a multiple of four, shifted by less than an eighth of a turn such that the ends of both axes of the
    ///   ellipse are points.
    /// * Recorded: the rows, every straight line between them cut evenly into the same number of parts. `amplitude` plays no part.
    ///
    /// A curved path is second order in the substeps.
    ///
    /// # Arguments
    /// * `mode` -- what the indenter does
    /// * `amplitude` -- `U`, m
    /// * `indentation` -- `d`, m, the mean of a normal oscillation
    /// * `substeps` -- about how many per period; raised to what the reversals and extrema need
    ///
    /// # Panics
    /// If a recorded path has no rows.
    ///
    /// ```
    /// use fretwear::laws::loading::Mode;
    /// use fretwear::laws::path::SampledPath;
    ///
    /// let mode = Mode::NormalOscillation { amplitude: 0.1, frequency_ratio: [1, 2], phase: 0.3 };
    /// let sampled = SampledPath::new(&mode, 2.0, 1.0, 40);
    /// assert_eq!((sampled.largest_indentation, sampled.oscillations), (1.1, 2));
    /// let reversals = sampled.path.points.iter().filter(|point| point.tangential[0].abs() == 2.0);
    /// assert_eq!(reversals.count(), 4);
    /// ```
    pub fn new(mode: &Mode, amplitude: f64, indentation: f64, substeps: usize) -> Self {
        let (points, rise, oscillations) = match mode {
            Mode::Tangential => (line(amplitude, substeps), 0.0, 1),
            Mode::NormalOscillation { amplitude: normal, frequency_ratio, phase } => {
                let points = normal_oscillation(amplitude, *normal, *frequency_ratio, *phase, substeps);
                (points, *normal, frequency_ratio[1])
            }
            Mode::Orbit { transverse_amplitude, phase, centre } => {
                (orbit([amplitude, *transverse_amplitude], *phase, *centre, substeps), 0.0, 1)
            }
            Mode::Recorded(recorded) => {
                let rise = recorded.indentation.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                (rows(recorded, rise, substeps), rise, 1)
            }
        };
        Self { path: Path { points }, largest_indentation: indentation + rise, oscillations }
    }
}

impl Path {
    /// Length of the tangential path, m.
    pub fn length(&self) -> f64 {
        let next = self.points.iter().cycle().skip(1);
        let step = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
        self.points.iter().zip(next).map(|(a, b)| step(a.tangential, b.tangential)).sum()
    }

    /// Whether it has no component along y.
    pub fn is_straight(&self) -> bool {
        self.points.iter().all(|point| point.tangential[1] == 0.0)
    }

    /// Whether the indentation is the same at every point.
    pub fn is_level(&self) -> bool {
        self.points.iter().all(|point| point.lift == self.points[0].lift)
    }

    /// What of the period goes one way, by substep: springs slip one way only between reversals of a level path along a line, so those
    /// substeps are one; every other substep is by itself. Counted from 0 in the order in which they begin.
    ///
    /// ```
    /// use fretwear::laws::loading::Mode;
    /// use fretwear::laws::path::SampledPath;
    ///
    /// let path = SampledPath::new(&Mode::Tangential, 3.0, 1.0, 5).path;
    /// assert_eq!(path.ways(), [0, 0, 0, 1, 1]);
    /// ```
    pub fn ways(&self) -> Vec<usize> {
        let count = self.points.len();
        if !(self.is_straight() && self.is_level()) {
            return (0..count).collect();
        }
        let moved = |m: usize| self.points[(m + 1) % count].tangential[0] - self.points[m].tangential[0];
        let mut ways = vec![0; count];
        let mut last = 0.0;
        for m in 0..count {
            let turned = last * moved(m) < 0.0;
            ways[m] = if m == 0 { 0 } else { ways[m - 1] + usize::from(turned) };
            if moved(m) != 0.0 {
                last = moved(m);
            }
        }
        // A path that begins between its reversals ends the way it began.
        let first = (0..count).map(moved).find(|moved| *moved != 0.0).unwrap_or_default();
        let whole = ways[count - 1];
        if whole > 1 && last * first > 0.0 {
            ways.iter_mut().filter(|way| **way == whole).for_each(|way| *way = 0);
        }
        ways
    }

    /// Largest lift, m: springs of smaller compression at the largest indentation lift off in each period.
    pub fn largest_lift(&self) -> f64 {
        self.points.iter().fold(0.0, |largest, point| largest.max(point.lift))
    }
}

/// From `U` to `-U` and back.
fn line(amplitude: f64, substeps: usize) -> Vec<PathPoint> {
    let there = substeps.max(2).div_ceil(2);
    let back = substeps.max(2) - there;
    let way = |from: f64, steps: usize| {
        (0..steps).map(move |i| PathPoint {
            tangential: [from * (1.0 - 2.0 * i as f64 / steps as f64), 0.0],
            lift: 0.0,
        })
    };
    way(amplitude, there).chain(way(-amplitude, back)).collect()
}

/// `u = U cos ωt`, `d_max - d = 2 d_1 sin²((m ωt/n + φ)/2)`; time is counted in tangential periods.
fn normal_oscillation(
    amplitude: f64,
    normal: f64,
    [m, n]: [u32; 2],
    phase: f64,
    substeps: usize,
) -> Vec<PathPoint> {
    let period = f64::from(n);
    let ratio = f64::from(m) / period;
    let half = 0.5 / ratio;
    let lift = |from_peak: f64| 2.0 * normal * (PI * ratio * from_peak).sin().powi(2);
    let place =
        |time: f64, lift: f64| (time, PathPoint { tangential: [amplitude * (TAU * time).cos(), 0.0], lift });

    let mut lift_at_reversal: Vec<f64> = (0..2 * n)
        .map(|i| {
            let turns = 0.5 * f64::from(i) * ratio + phase / TAU;
            lift((turns - turns.round()) / ratio)
        })
        .collect();
    let offsets = clustered_offsets(substeps.div_ceil(2 * m as usize));
    let mut nodes = vec![];
    for peak in 0..m {
        let time = ((f64::from(peak) - phase / TAU) / ratio).rem_euclid(period);
        for (time, lift) in [(time, 0.0), ((time + half).rem_euclid(period), 2.0 * normal)] {
            if (2.0 * time - (2.0 * time).round()).abs() < SIMULTANEOUS {
                lift_at_reversal[(2.0 * time).round() as usize % (2 * n as usize)] = lift;
            } else {
                nodes.push(place(time, lift));
            }
        }
        for part in offsets.windows(3) {
            let from_peak = half * part[1];
            let gap = half * (part[1] - part[0]).min(part[2] - part[1]);
            for time in [time + from_peak, time - from_peak] {
                let from_reversal = 0.5 * (2.0 * time - (2.0 * time).round()).abs();
                if from_reversal > 0.5 * gap {
                    nodes.push(place(time.rem_euclid(period), lift(from_peak)));
                }
            }
        }
    }
    nodes.extend(lift_at_reversal.iter().enumerate().map(|(i, &lift)| {
        let tangential = [if i % 2 == 0 { amplitude } else { -amplitude }, 0.0];
        (0.5 * i as f64, PathPoint { tangential, lift })
    }));
    nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
    nodes.into_iter().map(|(_, point)| point).collect()
}

/// Times from the peak in half periods, from 0 to 1: half of the substeps even, half even in the logarithm of the time.
fn clustered_offsets(substeps: usize) -> Vec<f64> {
    let decades = EVEN_NEAR_PEAK.recip().ln_1p();
    let cumulated = |time: f64| 0.5 * (time + (time / EVEN_NEAR_PEAK).ln_1p() / decades);
    let inner = (1..substeps).map(|i| {
        let part = i as f64 / substeps as f64;
        bracketed(|time| cumulated(time) - part, 0.0, 1.0, 0.0).expect("it grows from 0 to 1")
    });
    [0.0].into_iter().chain(inner).chain([1.0]).collect()
}

/// `u = (o_x + U cos ωt, o_y + U_y sin(ωt + φ))`.
fn orbit(amplitudes: [f64; 2], phase: f64, centre: [f64; 2], substeps: usize) -> Vec<PathPoint> {
    // |u - o|² varies as the real part of (U² - U_y² e^(2iφ)) e^(2iωt); a quarter of a turn leads from one axis to the other.
    let [x2, y2] = amplitudes.map(|amplitude| amplitude * amplitude);
    let axis = -0.5 * (-y2 * (2.0 * phase).sin()).atan2(x2 - y2 * (2.0 * phase).cos());
    let start = axis - FRAC_PI_2 * (axis / FRAC_PI_2).round();
    let cosine = [amplitudes[0] * start.cos(), amplitudes[1] * (start + phase).sin()];
    let sine = [-amplitudes[0] * start.sin(), amplitudes[1] * (start + phase).cos()];
    let quarter = substeps.div_ceil(4).max(1);
    let at = |i: usize| {
        let (s, c) = (FRAC_PI_2 * (i % quarter) as f64 / quarter as f64).sin_cos();
        // Whole quarters are turned exactly, so that opposite points are opposite to the last bit.
        let (s, c) = [(s, c), (c, -s), (-s, -c), (-c, s)][i / quarter];
        let tangential = [0, 1].map(|axis| centre[axis] + c * cosine[axis] + s * sine[axis]);
        PathPoint { tangential, lift: 0.0 }
    };
    (0..4 * quarter).map(at).collect()
}

/// The rows, each line cut into the same number of parts.
fn rows(recorded: &RecordedPath, highest: f64, substeps: usize) -> Vec<PathPoint> {
    let columns = recorded.x.iter().zip(&recorded.y).zip(&recorded.indentation);
    let mut corners: Vec<PathPoint> = columns
        .map(|((&x, &y), &indentation)| PathPoint { tangential: [x, y], lift: highest - indentation })
        .collect();
    assert!(!corners.is_empty(), "a recorded path has rows");
    if corners.len() > 2 && corners.first() == corners.last() {
        corners.pop();
    }
    if corners.len() == 1 {
        corners.push(corners[0]);
    }
    let parts = substeps.div_ceil(corners.len()).max(1);
    let next = corners.iter().cycle().skip(1);
    let cut = |(from, to): (&PathPoint, &PathPoint)| {
        let (from, to) = (*from, *to);
        (0..parts).map(move |i| {
            let part = i as f64 / parts as f64;
            let between = |a: f64, b: f64| a + part * (b - a);
            PathPoint {
                tangential: [0, 1].map(|axis| between(from.tangential[axis], to.tangential[axis])),
                lift: between(from.lift, to.lift),
            }
        })
    };
    corners.iter().zip(next).flat_map(cut).collect()
}
