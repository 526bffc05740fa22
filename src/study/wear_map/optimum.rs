//! The grading that wears least, over the amplitude.

use rayon::prelude::*;
use serde::Serialize;

use super::medium::Column;
use super::{Form, Medium};
use crate::error::Result;
use crate::numerics::chebyshev::Chebyshev;
use crate::numerics::roots::bracketed;

/// What is the same for all gradings, besides indenter and amplitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// The indentation `d`.
    Indentation,
    /// The initial normal force, with the stiffness `c_N` of the graded medium of the same `E0`.
    Force {
        /// `z0/a_h`, the depth at which the moduli agree.
        reference_depth: f64,
    },
    /// The initial normal force, with the stiffness taken as `c_N(0)/z0^k`: only the depth of reference tells the media apart.
    ForceDepthOnly {
        /// `z0/a_h`.
        reference_depth: f64,
    },
}

/// Where the least wear is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// At a grading inside (-1, 1).
    Interior,
    /// In the limit `k → 1`.
    One,
    /// In the limit `k → -1`.
    MinusOne,
    /// At the border to full sliding, where the stick zone vanishes.
    FullSliding,
    /// Nowhere: every grading is in gross slip.
    Nowhere,
}

impl End {
    /// Name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Interior => "interior",
            Self::One => "k->1",
            Self::MinusOne => "k->-1",
            Self::FullSliding => "full-sliding",
            Self::Nowhere => "nowhere",
        }
    }
}

/// The grading that wears least at one amplitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Optimum {
    /// Amplitude `U/(μ_f d_h)`, `d_h` the indentation of the homogeneous contact.
    pub amplitude_ratio: f64,
    /// `k*`; 1 or -1 where the least is a limit, not a number where there is none.
    pub grading: f64,
    /// Least worn volume over that of the homogeneous contact; not a number as `k → -1`, and where that contact is in gross slip.
    pub volume_ratio: f64,
    /// Indentation over that of the homogeneous contact; not a number as `k → -1`, and where there is no optimum.
    pub indentation_ratio: f64,
    /// Where it is.
    pub end: End,
}

/// The optimal grading over the amplitude.
#[derive(Debug, Clone, PartialEq)]
pub struct OptimumCurve {
    /// What is held.
    pub control: Control,
    /// One optimum for each amplitude.
    pub points: Vec<Optimum>,
}

/// Amplitudes `U/(μ_f d)` at which, at the same indentation, the comparison of gradings turns; none where it does not.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Thresholds {
    /// Below it a slightly negative grading wears less than a homogeneous medium, above it a slightly positive one.
    pub optimum_crosses_zero: Option<f64>,
    /// Above it the limit `k → 1` wears less than the homogeneous medium.
    pub limit_beats_homogeneous: Option<f64>,
    /// Above it no grading wears less than the limit `k → 1`.
    pub limit_is_best: Option<f64>,
}

/// Gradings of the search are `tanh(x)`, `x` in steps over ±`FARTHEST`, so that `1 - k` and `1 + k` go down to 1e-7.
const FARTHEST: f64 = 8.4;
const STEPS: usize = 120;

impl OptimumCurve {
    /// Searches all gradings in partial slip for each amplitude, in parallel.
    ///
    /// The optimum is a zero of the derivative of a Chebyshev series of `ln ΔV`, good to about 1e-11, where a search for the minimum
    /// itself would give half the digits.
    ///
    /// # Errors
    /// Those of the closed form; [`Error::NotConverged`](crate::Error::NotConverged) if a minimum was seen and not found.
    ///
    /// # Examples
    /// ```
    /// use fretwear::contact::half_space::Poisson;
    /// use fretwear::study::wear_map::{Control, Medium, OptimumCurve};
    ///
    /// let medium = Medium::new(2.0, Poisson::Similar)?;
    /// let curve = OptimumCurve::new(&medium, Control::Indentation, &[0.5])?;
    /// assert!((curve.points[0].grading - 0.75897748761913086).abs() < 1e-10);
    /// # Ok::<(), fretwear::Error>(())
    /// ```
    pub fn new(medium: &Medium, control: Control, amplitude_ratios: &[f64]) -> Result<Self> {
        let search = Search::new(medium, control)?;
        let points =
            amplitude_ratios.par_iter().map(|&amplitude| search.optimum(amplitude)).collect::<Result<_>>()?;
        Ok(Self { control, points })
    }
}

impl Thresholds {
    /// Finds the amplitudes.
    ///
    /// # Errors
    /// Those of the closed form and of the root search.
    pub fn new(medium: &Medium) -> Result<Self> {
        const SMALLEST: f64 = 1e-6;
        let largest = 1.0 / medium.stiffness_ratio(0.0) * (1.0 - 1e-9);
        let (homogeneous, gibson) = (medium.at(0.0)?, medium.gibson());
        // In the logarithm of the amplitude, where the function changes sign.
        let threshold = |function: &dyn Fn(f64) -> f64, largest: f64| -> Result<Option<f64>> {
            let of_logarithm = |logarithm: f64| function(logarithm.exp());
            let (low, high) = (SMALLEST.ln(), largest.ln());
            let (first, last) = (of_logarithm(low), of_logarithm(high));
            match first.is_finite() && last.is_finite() && first.signum() != last.signum() {
                true => bracketed(of_logarithm, low, high, 1e-13).map(|root| Some(root.exp())),
                false => Ok(None),
            }
        };
        let ratio_of_limit = |amplitude: f64| {
            let volumes =
                [&gibson, &homogeneous].map(|it| it.volume(Form::Exact, amplitude).unwrap_or(f64::NAN));
            (volumes[0] / volumes[1]).ln()
        };
        // Derivatives by the grading: of a series about k = 0 in its middle, of one up to k = 1 at its end.
        let search = Search::new(medium, Control::Indentation)?;
        let slope_at_zero = |amplitude: f64| search.slope(amplitude, -0.1, 0.1, 0.0);
        let slope_at_one = |amplitude: f64| search.slope(amplitude, 0.9, 1.0, 1.0);
        let slidable = largest.min((1.0 - 1e-9) / medium.stiffness_ratio(-0.1));
        Ok(Self {
            optimum_crosses_zero: threshold(&slope_at_zero, slidable)?,
            limit_beats_homogeneous: threshold(&ratio_of_limit, largest)?,
            limit_is_best: best_above(&search, threshold(&slope_at_one, largest)?, largest)?,
        })
    }
}

/// The amplitude from which on the limit `k → 1` is the best of all gradings.
///
/// As a rule the optimum moves there continuously, at the amplitude `turning` where the slope at `k = 1` changes sign; otherwise it jumps
/// from another grading, and the amplitude is found by bisection.
fn best_above(search: &Search, turning: Option<f64>, largest: f64) -> Result<Option<f64>> {
    let is_best = |amplitude: f64| search.optimum(amplitude).map(|it| it.end == End::One);
    if let Some(turning) = turning
        && turning * 1.001 < largest
        && is_best(turning * 1.001)?
        && !is_best(turning * 0.999)?
    {
        return Ok(Some(turning));
    }
    let (mut low, mut high) = (1e-6, largest);
    if is_best(low)? || !is_best(high)? {
        return Ok(None);
    }
    while high / low > 1.0 + 1e-10 {
        let middle = (low * high).sqrt();
        *(if is_best(middle)? { &mut high } else { &mut low }) = middle;
    }
    Ok(Some(high))
}

/// A search over the gradings at any amplitude.
struct Search<'a> {
    medium: &'a Medium,
    control: Control,
    /// Gradings, increasing, with all that does not depend on the amplitude.
    scan: Vec<Loaded>,
    /// The homogeneous contact.
    reference: Loaded,
    /// The limit `k → 1`, where it has one.
    limit: Option<Loaded>,
}

/// One grading under the load that is held.
struct Loaded {
    grading: f64,
    column: Column,
    /// `(a0/a_h)²`.
    area: f64,
    /// `d/d_h`.
    depth: f64,
}

impl Loaded {
    fn new(medium: &Medium, control: Control, grading: f64) -> Result<Self> {
        Self::with_column(medium, control, grading, medium.at(grading)?)
    }

    /// The limit `k → 1`; none where the indentation grows without bounds, because `c_N` vanishes there.
    fn limit(medium: &Medium, control: Control) -> Result<Option<Self>> {
        match control {
            Control::Force { .. } => Ok(None),
            _ => Self::with_column(medium, control, 1.0, medium.gibson()).map(Some),
        }
    }

    fn with_column(medium: &Medium, control: Control, grading: f64, column: Column) -> Result<Self> {
        let n = medium.exponent();
        // d = κ a^n and F_N = 2 c_N κ a^(n+q) n/(q (n+q)), q = 1+k, each over its value at k = 0
        let (factor, q) = (medium.relative_factor(grading), 1.0 + grading);
        let radius = match control {
            Control::Indentation => factor.powf(-1.0 / n),
            Control::Force { reference_depth } | Control::ForceDepthOnly { reference_depth } => {
                let shape = match control {
                    Control::Force { .. } => medium.relative_stiffness(grading)?,
                    _ => 1.0,
                };
                let stiffness = shape * reference_depth.powf(-grading);
                (q * (n + q) / ((n + 1.0) * stiffness * factor)).powf(1.0 / (n + q))
            }
        };
        Ok(Self { grading, column, area: radius * radius, depth: factor * radius.powf(n) })
    }

    fn slides(&self, amplitude_ratio: f64) -> bool {
        self.column.slides(amplitude_ratio / self.depth)
    }

    /// `ΔV/(π a_h² d_h)`; not a number under full sliding.
    fn volume(&self, amplitude_ratio: f64) -> Result<f64> {
        Ok(self.area * self.depth * self.column.own_volume(Form::Exact, amplitude_ratio / self.depth)?)
    }
}

impl<'a> Search<'a> {
    fn new(medium: &'a Medium, control: Control) -> Result<Self> {
        let grading = |step: usize| (FARTHEST * (2.0 * step as f64 / STEPS as f64 - 1.0)).tanh();
        let scan: Vec<usize> = (0..=STEPS).collect();
        let scan = scan
            .par_iter()
            .map(|&step| Loaded::new(medium, control, grading(step)))
            .collect::<Result<_>>()?;
        let reference = Loaded::new(medium, control, 0.0)?;
        Ok(Self { medium, control, scan, reference, limit: Loaded::limit(medium, control)? })
    }

    fn volume(&self, grading: f64, amplitude_ratio: f64) -> Result<f64> {
        Loaded::new(self.medium, self.control, grading)?.volume(amplitude_ratio)
    }

    /// `ln ΔV` over `high - k`.
    fn series(&self, amplitude_ratio: f64, low: f64, high: f64) -> Chebyshev {
        let logarithm = |below: f64| self.volume(high - below, amplitude_ratio).map_or(f64::NAN, f64::ln);
        Chebyshev::fit(logarithm, high - low)
    }

    /// `d ln ΔV/dk` at a grading, from a series over an interval; not a number where some of it is in gross slip.
    fn slope(&self, amplitude_ratio: f64, low: f64, high: f64, grading: f64) -> f64 {
        -self.series(amplitude_ratio, low, high).value_and_derivative(high - grading).1
    }

    fn optimum(&self, amplitude_ratio: f64) -> Result<Optimum> {
        let volumes = self.scan.iter().map(|it| it.volume(amplitude_ratio)).collect::<Result<Vec<f64>>>()?;
        let reference = self.reference.volume(amplitude_ratio)?;
        let nothing = |grading: f64, end: End| {
            let (volume_ratio, indentation_ratio) = (f64::NAN, f64::NAN);
            Ok(Optimum { amplitude_ratio, grading, volume_ratio, indentation_ratio, end })
        };
        let slipping = volumes.iter().enumerate().filter(|(_, volume)| volume.is_finite());
        let Some((least, _)) = slipping.min_by(|a, b| a.1.total_cmp(b.1)) else {
            return nothing(f64::NAN, End::Nowhere);
        };
        let at = |loaded: &Loaded, grading: f64, end: End| -> Result<Optimum> {
            let volume_ratio = loaded.volume(amplitude_ratio)? / reference;
            Ok(Optimum { amplitude_ratio, grading, volume_ratio, indentation_ratio: loaded.depth, end })
        };
        if least == 0 {
            return nothing(-1.0, End::MinusOne);
        }
        match &self.limit {
            Some(limit) if limit.volume(amplitude_ratio)? <= volumes[least] => {
                return at(limit, 1.0, End::One);
            }
            None if least == STEPS => return at(&self.scan[STEPS], 1.0, End::One),
            _ => {}
        }
        let own = self.scan[least].grading;
        let high = if least < STEPS { self.scan[least + 1].grading } else { 1.0 };
        // Next to full sliding there is no neighbour below.
        let sliding_below = !volumes[least - 1].is_finite();
        let low = if sliding_below { own } else { self.scan[least - 1].grading };
        let series = self.series(amplitude_ratio, low, high);
        let slope = |below: f64| series.value_and_derivative(below).1;
        if sliding_below && slope(high - low) < 0.0 {
            let border = self.border(amplitude_ratio, self.scan[least - 1].grading, own)?;
            return at(&Loaded::new(self.medium, self.control, border)?, border, End::FullSliding);
        }
        let below = bracketed(slope, 0.0, high - low, 0.0)?;
        let found = Loaded::new(self.medium, self.control, high - below)?;
        at(&found, high - below, End::Interior)
    }

    /// The smallest grading in partial slip, between one that slides and one that does not.
    fn border(&self, amplitude_ratio: f64, mut sliding: f64, mut slipping: f64) -> Result<f64> {
        while slipping - sliding > 4.0 * f64::EPSILON {
            let middle = 0.5 * (sliding + slipping);
            let slips = !Loaded::new(self.medium, self.control, middle)?.slides(amplitude_ratio);
            *(if slips { &mut slipping } else { &mut sliding }) = middle;
        }
        Ok(slipping)
    }
}
