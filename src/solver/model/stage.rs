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
}

impl Unknowns {
    /// Those of a state.
    pub fn of(state: &State) -> Self {
        let [stick_area, stick_depth] = state.stick.as_ref().map_or([0.0; 2], |it| [it.area, it.depth]);
        Self { compression: state.compression.clone(), slip_area: state.slip_area, stick_area, stick_depth }
    }

    /// Some cycles after a state, at the rates of the last step.
    pub fn ahead(state: &State, cycles: f64) -> Self {
        let mut at = Self::of(state);
        at.slip_area += cycles * state.slip_area_rate;
        for (q, rate) in at.compression.iter_mut().zip(&state.compression_rate) {
            *q += cycles * rate;
        }
        let [area, depth] = state.stick.as_ref().map_or([0.0; 2], |stick| stick.rates);
        at.stick_area += cycles * area;
        at.stick_depth += cycles * depth;
        at
    }

    /// Takes a correction away: of the compressions, of `Z` and, where they are solved for, of `C` and `G`.
    pub fn correct(&mut self, correction: &[f64]) {
        let (of_springs, others) = correction.split_at(self.compression.len());
        for (q, change) in self.compression.iter_mut().zip(of_springs) {
            *q -= change;
        }
        self.slip_area -= others[0];
        if let [_, area, depth] = others {
            self.stick_area -= area;
            self.stick_depth -= depth;
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
    /// What acts.
    pub loading: CycleLoading,
}
