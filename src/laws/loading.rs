//! What is done to the contact: how deep it is pressed, how far it is moved to and fro, and for how long.

use std::sync::Arc;

use serde::{Serialize, Serializer};

use crate::error::{Error, Result};

/// The normal load of the first cycle; its indentation `d` is then held, unless the force is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Load {
    /// Indentation `d`, m, positive.
    Indentation(f64),
    /// Normal force `F_N` before any wear, N, positive; it falls as the contact wears.
    InitialForce(f64),
    /// Normal force `F_N`, N, positive, held in every cycle; the indentation grows as the contact wears.
    NormalForce(f64),
}

impl Load {
    /// Key of the scene that gives it.
    pub fn key(self) -> &'static str {
        match self {
            Self::Indentation(_) => "loading.indentation",
            Self::InitialForce(_) => "loading.initial_force",
            Self::NormalForce(_) => "loading.normal_force",
        }
    }
}

/// The amplitude of the tangential oscillation `-U..U..-U`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Amplitude {
    /// `U`, m, at least 0.
    Displacement(f64),
    /// `U/(μ_f d)`, at least 0; full sliding begins at `1/M`.
    Ratio(f64),
    /// Stick radius over contact radius `c/a0` before any wear, in (0, 1]; 1 is no slip.
    StickRatio(f64),
}

impl Amplitude {
    /// Key of the scene that gives it.
    pub fn key(self) -> &'static str {
        match self {
            Self::Displacement(_) => "loading.amplitude",
            Self::Ratio(_) => "loading.amplitude_ratio",
            Self::StickRatio(_) => "loading.stick_ratio",
        }
    }
}

/// When a run ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Duration {
    /// After this number of cycles `N`, positive, not necessarily whole.
    Cycles(f64),
    /// At the dimensionless time `τ = 4 k_w c_N a0^(k-1) (μ_f d/M) N`, positive.
    Tau(f64),
    /// When the rate of worn volume has fallen to this fraction of its first value, in (0, 1).
    UntilRate(f64),
}

impl Duration {
    /// Smallest fraction of its first value to which the rate of worn volume can be seen to fall: below, it is the rounding of compressions that
    /// have come to nothing.
    pub const SMALLEST_RATE: f64 = 1e-14;

    /// Cycles and dimensionless time at the end; none if the rate of wear decides.
    ///
    /// # Arguments
    /// * `tau_per_cycle` -- dimensionless time of one cycle
    ///
    /// # Errors
    /// [`Error::Inconsistent`] names the key if one of the two overflows.
    pub fn span(self, tau_per_cycle: f64) -> Result<Option<[f64; 2]>> {
        let (key, value, span, name) = match self {
            Self::Cycles(cycles) => ("loading.cycles", cycles, [cycles, cycles * tau_per_cycle], "the time"),
            Self::Tau(tau) => {
                ("loading.tau", tau, [cycles_at(tau, tau_per_cycle), tau], "the number of cycles")
            }
            Self::UntilRate(_) => return Ok(None),
        };
        if span.iter().all(|it| it.is_finite()) {
            return Ok(Some(span));
        }
        let why = format!(
            "{value:e} is too large at a dimensionless time of {tau_per_cycle:e} per cycle: {name} overflows; ask for less"
        );
        Err(Error::Inconsistent { what: key, why })
    }
}

/// Cycles at a dimensionless time: of the doubles next to the quotient the one that gives this time back, if there is one.
pub fn cycles_at(tau: f64, tau_per_cycle: f64) -> f64 {
    let cycles = tau / tau_per_cycle;
    let candidates = [cycles, cycles.next_up(), cycles.next_down()];
    candidates.into_iter().find(|it| it * tau_per_cycle == tau).unwrap_or(cycles)
}

/// Times closer than this, relatively, are one: the sum of the durations of blocks and the same time written out differ by rounding.
const ONE_EVENT: f64 = 1e-12;

/// Whether an event at `time` is over at the time `now`, or one with it but for rounding.
pub fn has_come(time: f64, now: f64) -> bool {
    time <= now * (1.0 + ONE_EVENT)
}

/// Load, amplitude and end of plain tangential oscillation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loading {
    /// The normal load.
    pub load: Load,
    /// The tangential amplitude.
    pub amplitude: Amplitude,
    /// The end of the run.
    pub duration: Duration,
}

/// What the indenter does over one period, of which the tangential oscillation `u_x = U cos ωt` is a part.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Mode {
    /// Nothing else.
    #[default]
    Tangential,
    /// The indentation oscillates too, `d(t) = d + d_1 cos(m ωt/n + φ)`.
    NormalOscillation {
        /// `d_1`, m, positive, smaller than `d`.
        amplitude: f64,
        /// `m` and `n`, positive, without common divisor: `m` normal oscillations in `n` tangential ones.
        frequency_ratio: [u32; 2],
        /// `φ`, rad.
        phase: f64,
    },
    /// The indenter goes round, `u = (o_x + U cos ωt, o_y + U_y sin(ωt + φ))`.
    Orbit {
        /// `U_y`, m, positive.
        transverse_amplitude: f64,
        /// `φ`, rad; zero is an ellipse with its axes along x and y.
        phase: f64,
        /// `o_x`, `o_y`, m: the centre, seen from where the indenter is pressed on.
        centre: [f64; 2],
    },
    /// A recorded period.
    #[serde(rename = "path", serialize_with = "without_rows")]
    Recorded(Arc<RecordedPath>),
}

/// Name and number of rows of a path, which are enough to tell it.
fn without_rows<S: Serializer>(path: &RecordedPath, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Summary<'a> {
        source: &'a str,
        rows: usize,
    }
    Summary { source: &path.source, rows: path.x.len() }.serialize(serializer)
}

/// A period as recorded: closed, straight between its rows, starting at the first one.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedPath {
    /// Where the rows came from.
    pub source: String,
    /// Tangential displacement along x, m, seen from where the indenter is pressed on.
    pub x: Vec<f64>,
    /// The same along y, m.
    pub y: Vec<f64>,
    /// Indentation over that of the scene, m; zero throughout if the indentation is constant.
    pub indentation: Vec<f64>,
}

impl RecordedPath {
    /// Fewest rows of a path.
    pub const FEWEST_ROWS: usize = 3;

    /// Most rows of a path.
    pub const MOST_ROWS: usize = 10_000;

    /// Path through rows.
    ///
    /// # Arguments
    /// * `source` -- where the rows come from, in words; the name of the file as a rule
    /// * `x`, `y`, `indentation` -- m, shape `(row,)` each, as the fields
    ///
    /// # Errors
    /// [`Error::Inconsistent`] names `loading.path` and what is wrong with the rows.
    ///
    /// # Examples
    /// ```
    /// use fretwear::laws::loading::RecordedPath;
    ///
    /// let path = RecordedPath::new("triangle", vec![0.0, 3e-6, 0.0], vec![0.0, 0.0, 4e-6], vec![0.0; 3])?;
    /// assert!((path.amplitude() / 2.5e-6 - 1.0).abs() < 1e-15);
    /// # Ok::<(), fretwear::Error>(())
    /// ```
    pub fn new(source: impl Into<String>, x: Vec<f64>, y: Vec<f64>, indentation: Vec<f64>) -> Result<Self> {
        let refused = |why: String| Err(Error::Inconsistent { what: "loading.path", why });
        let rows = x.len();
        if y.len() != rows || indentation.len() != rows {
            return refused(format!(
                "it has {rows} values of x, {} of y and {} of the indentation",
                y.len(),
                indentation.len()
            ));
        }
        if !(Self::FEWEST_ROWS..=Self::MOST_ROWS).contains(&rows) {
            let (fewest, most) = (Self::FEWEST_ROWS, Self::MOST_ROWS);
            return refused(format!("it has {rows} rows; give from {fewest} to {most}"));
        }
        // What is formed from them must not overflow.
        let sound = |value: f64| value.abs() < 1e100;
        if let Some(value) = [&x, &y, &indentation].into_iter().flatten().find(|it| !sound(**it)) {
            return refused(format!("it holds {value:e} m; check the units"));
        }
        if x.iter().all(|it| *it == x[0]) && y.iter().all(|it| *it == y[0]) {
            return refused(
                "all its rows are at the same x and y: the indenter does not move along the surface".into(),
            );
        }
        Ok(Self { source: source.into(), x, y, indentation })
    }

    /// Half of the largest distance between two rows along the surface, m: of a straight path to and fro its amplitude.
    pub fn amplitude(&self) -> f64 {
        let place = |row: usize| [self.x[row], self.y[row]];
        let mut largest = 0.0f64;
        for row in 0..self.x.len() {
            let [x, y] = place(row);
            largest =
                (0..row).map(place).fold(largest, |most, [u, v]| most.max((x - u).powi(2) + (y - v).powi(2)));
        }
        0.5 * largest.sqrt()
    }

    /// Whether the indentation changes along the path.
    pub fn changes_indentation(&self) -> bool {
        self.indentation.iter().any(|it| *it != 0.0)
    }
}

/// What decides the tangential amplitude in each cycle.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum TangentialControl {
    /// The amplitude of the displacement is as given.
    #[default]
    Displacement,
    /// The amplitude of the tangential force is held at its value in the first cycle.
    Force,
    /// The displacement given is that of the far end of a spring in series with the contact.
    Rig {
        /// Tangential stiffness, N/m, positive.
        #[serde(rename = "rig_stiffness")]
        stiffness: f64,
    },
}

/// Some cycles in which amplitude and indentation are multiplied by factors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Block {
    /// How long it lasts, in cycles or as dimensionless time by [`Clock`]; positive.
    pub duration: f64,
    /// On all tangential amplitudes, at least 0.
    pub amplitude_factor: f64,
    /// On the indentation, positive.
    pub indentation_factor: f64,
}

/// The unit of the times of blocks and histories.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Clock {
    /// Cycles.
    #[default]
    Cycles,
    /// The dimensionless time `τ`.
    Tau,
}
