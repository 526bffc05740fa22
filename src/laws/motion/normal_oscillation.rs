//! The indentation oscillates too.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use serde_json::{Value, json};

use super::mode::Mode;
use crate::laws::entry::Entry;
use crate::laws::path::PathPoint;
use crate::numerics::roots::bracketed;
use crate::units::{Dimension, Key, Kind, Range, Rule, Scale, number};

/// `[loading.normal_oscillation]`.
pub static ENTRY: Entry<dyn Mode> =
    Entry::<dyn Mode>::new("normal_oscillation", "The indentation oscillates too.", &KEYS, |values| {
        let given = values.optional(AMPLITUDES[0]);
        let amplitude = given.unwrap_or_else(|| values.contact.indentation * values.number(AMPLITUDES[1]));
        let frequency_ratio = values.ratio("frequency_ratio");
        Ok(Arc::new(NormalOscillation { amplitude, frequency_ratio, phase: values.number("phase") }))
    })
    .rules(&[Rule::OneOf(&AMPLITUDES)])
    .departs("a normal oscillation")
    .refers(|_| true);

const AMPLITUDES: [&str; 2] = ["amplitude", "amplitude_ratio"];

const KEYS: [Key; 4] = [
    Key::quantity(AMPLITUDES[0], Dimension::LENGTH, "Amplitude d1, m, below the indentation.")
        .range(Range::POSITIVE)
        .example("0.1 um")
        .optional(),
    Key::number(AMPLITUDES[1], "d1 over the indentation.")
        .range(Range::above(0.0).below(1.0))
        .example("0.2")
        .optional(),
    Key::new(
        "frequency_ratio",
        Kind::Ratio,
        "Normal oscillations per tangential one, a ratio of whole numbers up to 64.",
    )
    .range(Range::POSITIVE)
    .example("3/2"),
    Key::quantity("phase", Dimension::ANGLE, "Phase against the tangential oscillation, rad.")
        .example("35 deg")
        .default("0 deg"),
];

/// Part of half a normal period near the largest indentation below which points lie evenly; beyond, half of them lie evenly in its
/// logarithm. A spring loaded within `1e-9 d_1` of the largest indentation is so for `1.4e-5` of the half period.
const EVEN_NEAR_PEAK: f64 = 1e-5;

/// Part of a tangential half period within which an extremum of the indentation counts as simultaneous with a reversal: beyond the
/// round-off of the phase, and far below what an experiment could tell.
const SIMULTANEOUS: f64 = 1e-9;

/// `d(t) = d + d_1 cos(m ωt/n + φ)`.
#[derive(Debug, Clone, Copy)]
pub struct NormalOscillation {
    /// `d_1`, m, positive, smaller than `d`.
    pub amplitude: f64,
    /// `m` and `n`, positive, without common divisor: `m` normal oscillations in `n` tangential ones.
    pub frequency_ratio: [u32; 2],
    /// `φ`, rad.
    pub phase: f64,
}

impl Mode for NormalOscillation {
    fn entry(&self) -> Option<&'static Entry<dyn Mode>> {
        Some(&ENTRY)
    }

    fn told(&self) -> Vec<(&'static str, Value)> {
        let Self { amplitude, frequency_ratio, phase } = self;
        vec![
            ("amplitude", json!(amplitude)),
            ("frequency_ratio", json!(frequency_ratio)),
            ("phase", json!(phase)),
        ]
    }

    fn words(&self) -> String {
        let [over, under] = self.frequency_ratio;
        let amplitude = Scale::LENGTH.show(self.amplitude);
        format!("normal oscillation too, {amplitude}, {over} in {under}, phase {} rad", number(self.phase))
    }

    /// `u = U cos ωt`, `d_max - d = 2 d_1 sin²((m ωt/n + φ)/2)`, from the reversal at `t = 0` on; time is counted in tangential periods.
    ///
    /// Reversals are hit exactly, and so are the extrema of the indentation, where the lift is exactly `0` and `2 d_1`. Points cluster
    /// towards every time of largest indentation, for near the limit of wear springs are loaded nowhere else: of `J` substeps in half a
    /// normal period half lie evenly, half evenly in the logarithm of the time from the peak, down to `1e-5` of the half period. Next to a
    /// reversal, where the indenter hardly moves, substeps are never shorter than half of their neighbours: `M |Δu| < μ_f |Δd|` in one of
    /// them is stick, which should come from the motion and not from the place of a sample. A peak within `1e-9` of a half period of a
    /// reversal is one with it.
    fn period(&self, amplitude: f64, substeps: usize) -> Vec<PathPoint> {
        self.timed_period(amplitude, substeps).into_iter().map(|(_, point)| point).collect()
    }

    /// With the places at which `U cos ωt ± s (d_max - d)` is largest or smallest, found as zeros of its rate.
    fn period_with_turns(&self, amplitude: f64, substeps: usize, slope: f64) -> Vec<PathPoint> {
        let mut nodes = self.timed_period(amplitude, substeps);
        let turns: Vec<f64> =
            [slope, -slope].into_iter().flat_map(|slope| self.turns(amplitude, &nodes, slope)).collect();
        for time in turns {
            let near = |(at, _): &(f64, PathPoint)| (at - time).abs() <= SIMULTANEOUS;
            if !nodes.iter().any(near) {
                nodes.push((time, self.place(amplitude, time)));
            }
        }
        nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
        nodes.into_iter().map(|(_, point)| point).collect()
    }

    fn oscillations(&self) -> u32 {
        self.frequency_ratio[1]
    }

    fn peaks(&self) -> u32 {
        self.frequency_ratio[0]
    }

    fn indentations(&self) -> [f64; 2] {
        [-self.amplitude, self.amplitude]
    }
}

impl NormalOscillation {
    /// Where the indenter is, time counted in tangential periods.
    fn place(&self, amplitude: f64, time: f64) -> PathPoint {
        let [m, n] = self.frequency_ratio.map(f64::from);
        let lift = 2.0 * self.amplitude * (0.5 * (TAU * m / n * time + self.phase)).sin().powi(2);
        PathPoint { tangential: [amplitude * (TAU * time).cos(), 0.0], lift }
    }

    /// Times, in tangential periods, at which `u + slope · lift` turns.
    fn turns(&self, amplitude: f64, nodes: &[(f64, PathPoint)], slope: f64) -> Vec<f64> {
        let [m, n] = self.frequency_ratio.map(f64::from);
        let ratio = m / n;
        let rate = |time: f64| {
            slope * self.amplitude * ratio * (TAU * ratio * time + self.phase).sin()
                - amplitude * (TAU * time).sin()
        };
        let ends = nodes.windows(2).map(|pair| [pair[0].0, pair[1].0]);
        let last = [nodes[nodes.len() - 1].0, n + nodes[0].0];
        let turns = ends.chain([last]).filter(|[from, to]| rate(*from) * rate(*to) < 0.0);
        turns
            .filter_map(|[from, to]| bracketed(rate, from, to, 0.0).ok())
            .map(|time| time.rem_euclid(n))
            .collect()
    }

    /// The points of a period with their times, in tangential periods.
    fn timed_period(&self, amplitude: f64, substeps: usize) -> Vec<(f64, PathPoint)> {
        let Self { amplitude: normal, frequency_ratio: [m, n], phase } = *self;
        let period = f64::from(n);
        let ratio = f64::from(m) / period;
        let half = 0.5 / ratio;
        let lift = |from_peak: f64| 2.0 * normal * (PI * ratio * from_peak).sin().powi(2);
        let place = |time: f64, lift: f64| {
            (time, PathPoint { tangential: [amplitude * (TAU * time).cos(), 0.0], lift })
        };

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
        nodes
    }
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
