//! The times before a state, which a multistep method needs.

use std::sync::Arc;

use super::State;

/// Times before a state, for a method that needs more of them than one.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Past {
    /// Order of the next step; zero at the start.
    pub order: usize,
    /// The state itself and those before it, the newest first.
    pub points: Vec<Arc<PastPoint>>,
    /// Where the factors were made with which the next step begins; none if it makes its own.
    pub linearised: Option<Arc<Linearised>>,
}

/// Where Newton's matrix was factorised.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Linearised {
    /// Cycles done.
    pub cycles: f64,
    /// `Z = a² - c²`, m².
    pub slip_area: f64,
    /// What the past made of it, m².
    pub gathered_slip_area: f64,
    /// Cycles by which the rates are multiplied.
    pub step: f64,
    /// Compression `q`, m, of the inner springs, shape `(springs - 1,)`.
    pub compression: Vec<f64>,
}

impl Past {
    /// Whether a method of orders up to `highest` can go on from a state with this past, in gross slip or not.
    pub fn fits(&self, state: &State, highest: usize, gross: bool) -> bool {
        let Some(newest) = self.points.first() else { return true };
        let springs = state.compression.len();
        let with_edge = if gross { 0 } else { springs + 1 };
        let finite = |point: &PastPoint| {
            let scalars = [point.cycles, point.slip_area, point.dissipated_energy, point.volume_by_rate];
            scalars.iter().chain(&point.compression).chain(&point.log_slip).all(|value| value.is_finite())
                && (point.compression.len(), point.log_slip.len()) == (springs, with_edge)
        };
        (1..=highest.min(self.points.len())).contains(&self.order)
            // A step that lands on an output ends there, its own time a rounding aside.
            && (newest.cycles - state.cycles).abs() <= 1e-12 * state.cycles
            && self.points.iter().all(|point| point.cycles >= 0.0 && finite(point))
            && self.points.windows(2).all(|pair| pair[0].cycles > pair[1].cycles)
            && self.linearised.as_ref().is_none_or(|it| {
                let scalars = [it.cycles, it.slip_area, it.gathered_slip_area, it.step];
                it.compression.len() == springs
                    && it.slip_area > 0.0
                    && scalars.iter().chain(&it.compression).all(|value| value.is_finite())
            })
    }
}

/// What is remembered of one time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PastPoint {
    /// Cycles done.
    pub cycles: f64,
    /// `Z = a² - c²`, m².
    pub slip_area: f64,
    /// Energy dissipated, J.
    pub dissipated_energy: f64,
    /// Worn volume by the rates of the cycles, m³.
    pub volume_by_rate: f64,
    /// Compression `q`, m, of the inner springs, shape `(springs - 1,)`.
    pub compression: Vec<f64>,
    /// `λ`, shape `(springs,)`; empty in gross slip, where the compressions are all that is stepped.
    pub log_slip: Vec<f64>,
}

impl PastPoint {
    /// What is remembered of a state.
    pub fn new(state: &State, log_slip: &[f64]) -> Arc<Self> {
        Arc::new(Self {
            cycles: state.cycles,
            slip_area: state.slip_area,
            dissipated_energy: state.dissipated_energy,
            volume_by_rate: state.volume_by_rate,
            compression: state.compression.clone(),
            log_slip: log_slip.to_vec(),
        })
    }

    /// A weighted sum of points; the time is not summed.
    pub fn sum(weights: &[f64], points: &[Arc<Self>]) -> Self {
        let [inner, all] = points.first().map_or([0; 2], |it| [it.compression.len(), it.log_slip.len()]);
        let mut sum = Self { compression: vec![0.0; inner], log_slip: vec![0.0; all], ..Self::default() };
        for (weight, point) in weights.iter().zip(points) {
            sum.slip_area += weight * point.slip_area;
            sum.dissipated_energy += weight * point.dissipated_energy;
            sum.volume_by_rate += weight * point.volume_by_rate;
            for (total, values) in
                [(&mut sum.compression, &point.compression), (&mut sum.log_slip, &point.log_slip)]
            {
                for (total, value) in total.iter_mut().zip(values) {
                    *total += weight * value;
                }
            }
        }
        sum
    }
}
