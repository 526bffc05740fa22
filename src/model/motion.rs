//! How the springs slip in one period, in closed form or step by step.

use faer::Mat;

use super::schedule::{Demand, Drive};
use super::{Fields, Model};
use crate::linear::dot;
use crate::path::Path;
use crate::roots::bracketed;
use crate::spring::{Shakedown, SpringCycle, steady_cycle};
use crate::stick_slip::slip_amplitude_of_spring;
use crate::wear::WearLaw;

/// Change of a compression, relative to the one at the edge of stick, by which slopes are found.
const DIFFERENCE: f64 = 1e-7;

/// What the springs inside the contact edge do in one period.
pub(super) struct Motion {
    /// Tangential amplitude of the contact, m.
    pub amplitude: f64,
    /// Slip in each step, m, shape `(springs - 1, steps · components)`.
    pub slip: Mat<f64>,
    /// Slip of a spring without compression, m, shape `(steps · components,)`.
    pub free: Vec<f64>,
    /// One where all slip along a line, else two.
    pub components: usize,
    /// What presses in each step, m: the mean compression, or what resists slip where wear goes by energy; shape
    /// `(springs - 1, steps)`, or one column if it is the same in all.
    pub load: Mat<f64>,
    /// Energy dissipated per normal stiffness, m², shape `(springs - 1,)`.
    pub dissipation: Vec<f64>,
    /// Derivatives of `slip` and `load` by the compression of their spring.
    pub slip_slope: Mat<f64>,
    pub load_slope: Mat<f64>,
    /// Where the amplitude depends on the compressions.
    pub amplitude_slope: Option<AmplitudeSlope>,
}

/// How the amplitude follows the compressions.
pub(super) struct AmplitudeSlope {
    /// Derivatives of the amplitude by the compressions.
    pub by_compression: Vec<f64>,
    /// One for the springs that slip, zero for the others.
    pub slips: Vec<f64>,
}

impl Motion {
    /// Steps of the period.
    pub fn steps(&self) -> usize {
        self.free.len() / self.components
    }
}

impl Model {
    /// How the springs slip; slopes only if they are asked for.
    pub(super) fn motion(&self, drive: &Drive, compression: &[f64], fields: &Fields, slopes: bool) -> Motion {
        match &drive.path {
            Some(path) => self.resolved_motion(drive, path, compression, slopes),
            None => self.closed_form_motion(drive, compression, fields, slopes),
        }
    }

    /// Tangential oscillation at constant indentation: `4 σ(q)` in a single step.
    fn closed_form_motion(
        &self,
        drive: &Drive,
        compression: &[f64],
        fields: &Fields,
        slopes: bool,
    ) -> Motion {
        let ratio = self.contact.half_space().stiffness_ratio();
        let lifted: Vec<f64> = compression.iter().map(|q| q - drive.lift).collect();
        let amplitude = self.amplitude(drive, &lifted, fields);
        let slip: Vec<(f64, f64)> =
            lifted.iter().map(|q| slip_amplitude_of_spring(&drive.friction, ratio, amplitude, *q)).collect();
        let strength = |q: &f64| drive.friction.kinetic_strength(*q);
        let load: Vec<f64> = lifted.iter().map(|q| bearing(drive, *q)).collect();
        let inner = compression.len();
        let amplitude_slope = (slopes && drive.demand != Demand::Displacement)
            .then(|| self.amplitude_slope(drive, &lifted, &slip, fields));
        let rows = if slopes { inner } else { 0 };
        Motion {
            amplitude,
            slip: Mat::from_fn(inner, 1, |j, _| 4.0 * slip[j].0),
            free: vec![4.0 * amplitude],
            components: 1,
            load: Mat::from_fn(inner, 1, |j, _| load[j]),
            dissipation: lifted.iter().zip(&slip).map(|(q, s)| 4.0 * strength(q) * s.0).collect(),
            slip_slope: Mat::from_fn(rows, 1, |j, _| 4.0 * slip[j].1),
            load_slope: Mat::from_fn(rows, 1, |j, _| self.slope(|q| bearing(drive, q), lifted[j])),
            amplitude_slope,
        }
    }

    fn resolved_motion(&self, drive: &Drive, path: &Path, compression: &[f64], slopes: bool) -> Motion {
        let ratio = self.contact.half_space().stiffness_ratio();
        let steps = path.points.len();
        let components = if is_straight(path) { 1 } else { 2 };
        let (inner, columns) = (compression.len(), steps * components);
        let mut spring = SpringCycle::default();
        let shakedown = Shakedown::default();
        let mut passed = |q: f64| {
            steady_cycle(path, &drive.friction, ratio, q, &shakedown, &mut spring);
            let slip: Vec<f64> = spring.slip.iter().flat_map(|s| s[..components].iter().copied()).collect();
            (slip, spring.dissipation)
        };
        let free = passed(0.0).0;
        let mut slip = Mat::zeros(inner, columns);
        let mut slip_slope = Mat::zeros(if slopes { inner } else { 0 }, columns);
        let mut dissipation = vec![0.0; inner];
        let difference = DIFFERENCE * self.contact.slip_compression();
        for (j, q) in compression.iter().enumerate() {
            let (values, energy) = passed(q.max(0.0));
            dissipation[j] = energy;
            for (m, value) in values.iter().enumerate() {
                slip[(j, m)] = *value;
            }
            if slopes {
                let (nearby, _) = passed(q.max(0.0) + difference);
                for (m, value) in nearby.iter().enumerate() {
                    slip_slope[(j, m)] = (value - values[m]) / difference;
                }
            }
        }
        let lifts = |m: usize| [path.points[m].lift, path.points[(m + 1) % steps].lift];
        let constant = (0..steps).all(|m| lifts(m) == lifts(0) && lifts(m)[0] == lifts(m)[1]);
        let different = if constant { 1 } else { steps };
        let mean = |q: f64, m: usize| lifts(m).map(|lift| 0.5 * bearing(drive, q - lift)).iter().sum::<f64>();
        Motion {
            amplitude: drive.amplitude,
            slip,
            free,
            components,
            load: Mat::from_fn(inner, different, |j, m| mean(compression[j], m)),
            dissipation,
            slip_slope,
            load_slope: Mat::from_fn(if slopes { inner } else { 0 }, different, |j, m| {
                self.slope(|q| mean(q, m), compression[j])
            }),
            amplitude_slope: None,
        }
    }

    /// Tangential amplitude of the contact, m: as prescribed, or by the balance of forces.
    fn amplitude(&self, drive: &Drive, lifted: &[f64], fields: &Fields) -> f64 {
        if drive.demand == Demand::Displacement {
            return drive.amplitude;
        }
        let strength = drive.friction.static_strength(self.contact.slip_compression() - drive.lift);
        let largest = strength / self.contact.half_space().stiffness_ratio();
        let excess = |amplitude: f64| drive.excess(self.force(drive, lifted, fields, amplitude), amplitude);
        // At the last stick radius the contact gives way.
        bracketed(excess, 0.0, largest, 0.0).unwrap_or(largest)
    }

    /// Derivatives of the amplitude in the balance of forces.
    fn amplitude_slope(
        &self,
        drive: &Drive,
        lifted: &[f64],
        slip: &[(f64, f64)],
        fields: &Fields,
    ) -> AmplitudeSlope {
        let half_space = self.contact.half_space();
        let slips: Vec<f64> = slip.iter().map(|(value, _)| f64::from(u8::from(*value > 0.0))).collect();
        let weights: Vec<f64> = self
            .operators
            .abel
            .spring_sum()
            .iter()
            .zip(&fields.density_factor)
            .map(|(weight, factor)| half_space.normal_stiffness() * fields.edge * weight * factor)
            .collect();
        let ratio = half_space.stiffness_ratio();
        let sticking: f64 =
            weights.iter().zip(&slips).map(|(weight, slips)| ratio * weight * (1.0 - slips)).sum();
        let by_amplitude = self.stuck_force(fields, 1.0) + sticking;
        let [by_force, direct] = drive.demand.factors();
        let by_compression = (0..lifted.len()).map(|j| {
            let strength = slips[j] * self.slope(|q| drive.friction.kinetic_strength(q), lifted[j]);
            -by_force * weights[j] * strength / (by_force * by_amplitude + direct)
        });
        AmplitudeSlope { by_compression: by_compression.collect(), slips: slips.clone() }
    }

    /// Amplitude of the tangential force, N, of springs lifted to `lifted`, m, moved by `amplitude`, m.
    pub(super) fn force(&self, drive: &Drive, lifted: &[f64], fields: &Fields, amplitude: f64) -> f64 {
        let half_space = self.contact.half_space();
        let ratio = half_space.stiffness_ratio();
        let borne: Vec<f64> = lifted
            .iter()
            .zip(&fields.density_factor)
            .map(|(q, factor)| factor * (ratio * amplitude).min(drive.friction.kinetic_strength(*q)))
            .collect();
        self.stuck_force(fields, amplitude)
            + half_space.normal_stiffness() * fields.edge * dot(self.operators.abel.spring_sum(), &borne)
    }

    /// Tangential force, N, of the springs within the last stick radius.
    fn stuck_force(&self, fields: &Fields, amplitude: f64) -> f64 {
        let half_space = self.contact.half_space();
        let q = 1.0 + half_space.grading();
        let tangential = half_space.stiffness_ratio() * half_space.normal_stiffness();
        2.0 * tangential * amplitude * fields.place.stick_area.powf(0.5 * q) / q
    }

    /// Slope of a function of the compression of one spring, by a difference to the side of more compression.
    fn slope(&self, function: impl Fn(f64) -> f64, compression: f64) -> f64 {
        let difference = DIFFERENCE * self.contact.slip_compression();
        (function(compression + difference) - function(compression)) / difference
    }
}

/// What the law of wear takes for the load of a spring: its compression, or what resists its slip where wear goes by energy.
fn bearing(drive: &Drive, compression: f64) -> f64 {
    match drive.wear {
        WearLaw::DissipatedEnergy { .. } => drive.friction.kinetic_strength(compression),
        // Springs may lose contact within the annulus.
        WearLaw::NonLocal { .. } => compression.max(0.0),
        _ if drive.path.is_some() || drive.lift > 0.0 => compression.max(0.0),
        // Round-off about zero in the limit is better left as it is.
        _ => compression,
    }
}

/// Whether the path has no component along y.
fn is_straight(path: &Path) -> bool {
    path.points.iter().all(|point| point.tangential[1] == 0.0)
}
