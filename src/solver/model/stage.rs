//! What a stage of an implicit step solves for, and what it starts from.

use super::State;
use super::schedule::CycleLoading;

/// Unknowns of a stage.
#[derive(Debug, Clone)]
pub struct Unknowns {
    /// Compression `q`, m, of the inner springs, shape `(springs - 1,)`.
    pub compression: Vec<f64>,
    /// `Z = a² - c²`, m².
    pub slip_area: f64,
    /// `C = c²`, m², and the height `G`, m, of the profile there; zero where the edge of stick rests, which leaves them out.
    pub stick_area: f64,
    /// See [`Unknowns::stick_area`].
    pub stick_depth: f64,
    /// `q_c`, m, where it is solved for beside the height: a normal force is held beside a balance of tangential forces.
    pub slip_compression: f64,
}

impl Unknowns {
    /// Those of a state.
    pub fn of(state: &State) -> Self {
        let stick = state.stick.as_ref();
        let [stick_area, stick_depth, slip_compression] =
            stick.map_or([0.0; 3], |it| [it.area, it.depth, it.slip_compression]);
        let (compression, slip_area) = (state.compression.clone(), state.slip_area);
        Self { compression, slip_area, stick_area, stick_depth, slip_compression }
    }

    /// Some cycles after a state, at the rates of the last step.
    pub fn ahead(state: &State, cycles: f64) -> Self {
        let mut at = Self::of(state);
        at.slip_area += cycles * state.slip_area_rate;
        for (q, rate) in at.compression.iter_mut().zip(&state.compression_rate) {
            *q += cycles * rate;
        }
        let [area, depth, slip_compression] = state.stick.as_ref().map_or([0.0; 3], |stick| stick.rates);
        at.stick_area += cycles * area;
        at.stick_depth += cycles * depth;
        at.slip_compression += cycles * slip_compression;
        at
    }

    /// Takes a correction away: of the compressions, of `Z` and, where they are solved for, of `C`, `G` and `q_c`.
    pub fn correct(&mut self, correction: &[f64]) {
        let (of_springs, others) = correction.split_at(self.compression.len());
        for (q, change) in self.compression.iter_mut().zip(of_springs) {
            *q -= change;
        }
        self.slip_area -= others[0];
        if let [_, area, depth, rest @ ..] = others {
            self.stick_area -= area;
            self.stick_depth -= depth;
            self.slip_compression -= rest.first().copied().unwrap_or_default();
        }
    }
}

/// What the stages or times before make of the present one, and what acts.
#[derive(Debug, Clone)]
pub struct Target {
    /// `λ̂`, shape `(springs,)`.
    pub log_slip: Vec<f64>,
    /// `Ẑ`, m².
    pub slip_area: f64,
    /// `h`, cycles: the step times the diagonal coefficient of the method.
    pub step: f64,
    /// Cycles done at the stage.
    pub cycles: f64,
    /// What acts.
    pub loading: CycleLoading,
}
