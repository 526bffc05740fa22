//! Coefficients of Runge-Kutta methods.

/// A singly diagonally implicit method of three stages, stiffly accurate: the last stage is the step.
#[derive(Debug)]
pub(super) struct Sdirk3 {
    /// Times of the stages, over the step.
    pub times: [f64; 3],
    /// Diagonal coefficient.
    pub diagonal: f64,
    pub matrix: [[f64; 3]; 3],
    /// Weights of a method of one order less.
    pub embedded: [f64; 3],
}

const GAMMA: f64 = 0.435_866_521_508_459;

/// L-stable, of order 3, with an embedded method of order 2 on its first two stages, `b̂_1 = γ/(1-γ)` and `b̂_2 = (1-2γ)/(1-γ)` (Alexander,
/// SIAM J. Numer. Anal. 14:1006, 1977).
pub(super) const ALEXANDER: Sdirk3 = Sdirk3 {
    times: [GAMMA, 0.5 * (1.0 + GAMMA), 1.0],
    diagonal: GAMMA,
    matrix: [
        [GAMMA, 0.0, 0.0],
        [0.5 * (1.0 - GAMMA), GAMMA, 0.0],
        [
            -0.25 * (6.0 * GAMMA * GAMMA - 16.0 * GAMMA + 1.0),
            0.25 * (6.0 * GAMMA * GAMMA - 20.0 * GAMMA + 5.0),
            GAMMA,
        ],
    ],
    embedded: [GAMMA / (1.0 - GAMMA), (1.0 - 2.0 * GAMMA) / (1.0 - GAMMA), 0.0],
};

/// An explicit method of which the last stage is the step.
#[derive(Debug)]
pub(super) struct Explicit {
    /// Weights of the stages before each stage.
    pub stages: [&'static [f64]; 4],
    /// Weights of the difference to a method of one order less.
    pub error: [f64; 4],
}

/// Of order 3, with an embedded method of order 2 (Bogacki and Shampine, Appl. Math. Lett. 2:321, 1989).
pub(super) const BOGACKI_SHAMPINE: Explicit = Explicit {
    stages: [&[], &[0.5], &[0.0, 0.75], &[2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0]],
    error: [-5.0 / 72.0, 1.0 / 12.0, 1.0 / 9.0, -1.0 / 8.0],
};
