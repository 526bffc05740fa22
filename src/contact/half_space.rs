//! The graded half-space `E(z) = E0 (z/z0)^k` as a row of springs: stiffnesses `c_N |x|^k dx` and `c_T |x|^k dx`.
//!
//! ```
//! use fretwear::contact::half_space::{HalfSpace, Poisson};
//!
//! // Homogeneous steel: c_N = E/(1 - ν²), M = 2 (1 - ν)/(2 - ν).
//! let steel = HalfSpace::from_modulus(0.0, 210e9, 1.0, Poisson::Ratio(0.3))?;
//! assert!((steel.normal_stiffness() / (210e9 / 0.91) - 1.0).abs() < 1e-14);
//! assert!((steel.stiffness_ratio() - 1.4 / 1.7).abs() < 1e-14);
//! # Ok::<(), fretwear::Error>(())
//! ```

use std::f64::consts::{FRAC_PI_2, PI};

use libm::tgamma;

use crate::error::{Error, Result};

/// Poisson's ratio of a graded half-space, by value or by the wish for elastic similarity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Poisson {
    /// A value in (-1, 0.5]; 0.5, the incompressible solid, is an ordinary point for every `k` inside (-1, 1).
    Ratio(f64),
    /// `ν = 1/(2 + k)`: normal and tangential contact of a rigid body are elastically similar [S, Eq. (12)].
    Similar,
}

impl Poisson {
    /// Poisson's ratio at grading `k`.
    pub fn value(self, grading: f64) -> f64 {
        match self {
            Poisson::Ratio(ratio) => ratio,
            Poisson::Similar => 1.0 / (2.0 + grading),
        }
    }

    /// Stiffness ratio `M = c_T/c_N` at grading `k` in (-1, 1]; at the end, the limit along this ratio.
    ///
    /// ```
    /// use fretwear::contact::half_space::Poisson;
    /// assert_eq!(Poisson::Similar.stiffness_ratio(1.0), 0.25);
    /// assert_eq!(Poisson::Ratio(0.5).stiffness_ratio(1.0), 0.0); // the Gibson medium, in which nothing slips
    /// ```
    pub fn stiffness_ratio(self, grading: f64) -> f64 {
        match self {
            Poisson::Ratio(ratio) => stiffness_ratio(grading, ratio),
            Poisson::Similar => similar_stiffness_ratio(grading),
        }
    }

    /// Whether the ratio exceeds 0.5, which no stable isotropic solid has: similarity at `k < 0` is a formal limit.
    ///
    /// ```
    /// use fretwear::contact::half_space::Poisson;
    /// assert!(Poisson::Similar.is_formal(-0.2));
    /// assert!(!Poisson::Similar.is_formal(0.2));
    /// ```
    pub fn is_formal(self, grading: f64) -> bool {
        self.value(grading) > 0.5
    }
}

/// Spring stiffnesses of one contact, of a rigid body on a half-space or of two elastic bodies with the same grading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfSpace {
    grading: f64,
    normal_stiffness: f64,
    stiffness_ratio: f64,
}

impl HalfSpace {
    /// A half-space whose spring stiffnesses are known.
    ///
    /// # Arguments
    /// * `grading` -- exponent `k` of the modulus, in (-1, 1)
    /// * `normal_stiffness` -- `c_N`, N/m^(2+k), positive
    /// * `stiffness_ratio` -- `M = c_T/c_N`, positive
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the argument.
    pub fn from_stiffness(grading: f64, normal_stiffness: f64, stiffness_ratio: f64) -> Result<Self> {
        check_grading(grading)?;
        check_positive("half_space.normal_stiffness", normal_stiffness)?;
        check_positive("half_space.stiffness_ratio", stiffness_ratio)?;
        Ok(Self { grading, normal_stiffness, stiffness_ratio })
    }

    /// A half-space of modulus `E(z) = E0 (z/z0)^k` under a rigid body.
    ///
    /// ```text
    /// c_N = h_N E0 / ((1-ν²) z0^k)
    /// ```
    ///
    /// Relative accuracy is that of the Γ function, some 1e-15, also as `k → ±1` and in the corner `k → 1`, `ν → 1/2`.
    ///
    /// # Arguments
    /// * `grading` -- exponent `k`, in (-1, 1)
    /// * `modulus` -- `E0`, Pa, the modulus at the depth `z0`
    /// * `reference_depth` -- `z0`, m; of no consequence for `k = 0`
    /// * `poisson` -- Poisson's ratio, in (-1, 0.5], or elastic similarity
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the argument, or the stiffness if it is too large or too small for a double.
    ///
    /// ```
    /// use fretwear::contact::half_space::{HalfSpace, Poisson};
    /// let graded = HalfSpace::from_modulus(0.5, 1.0, 1.0, Poisson::Ratio(0.45))?;
    /// assert!((graded.normal_stiffness() - 1.741415405).abs() < 1e-9);
    /// assert!((graded.stiffness_ratio() - 0.3273630605).abs() < 1e-10);
    /// # Ok::<(), fretwear::Error>(())
    /// ```
    pub fn from_modulus(grading: f64, modulus: f64, reference_depth: f64, poisson: Poisson) -> Result<Self> {
        check_grading(grading)?;
        check_positive("half_space.modulus", modulus)?;
        check_positive("half_space.reference_depth", reference_depth)?;
        let shape = match poisson {
            Poisson::Similar => similar_normal_stiffness(grading),
            Poisson::Ratio(ratio) => {
                if !(ratio > -1.0 && ratio <= 0.5) {
                    let range = "(-1, 0.5], the range of isotropic solids";
                    return Err(Error::OutOfRange { name: "half_space.poisson_ratio", value: ratio, range });
                }
                unit_normal_stiffness(grading, ratio)
            }
        };
        let normal_stiffness = shape * modulus / reference_depth.powf(grading);
        Self::from_stiffness(grading, normal_stiffness, poisson.stiffness_ratio(grading))
    }

    /// The contact of two elastic bodies with the same grading: their springs act in series.
    ///
    /// ```text
    /// 1/c_N = 1/c_N,1 + 1/c_N,2      1/c_T = 1/c_T,1 + 1/c_T,2      M = c_T/c_N
    /// ```
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if the gradings differ: then the two rows of springs have no common form.
    ///
    /// ```
    /// use fretwear::contact::half_space::{HalfSpace, Poisson};
    /// let steel = HalfSpace::from_modulus(0.0, 210e9, 1.0, Poisson::Ratio(0.3))?;
    /// let pair = HalfSpace::in_series(&steel, &steel)?;
    /// assert_eq!(pair.normal_stiffness(), steel.normal_stiffness() / 2.0);
    /// # Ok::<(), fretwear::Error>(())
    /// ```
    pub fn in_series(first: &Self, second: &Self) -> Result<Self> {
        if first.grading != second.grading {
            return Err(Error::Inconsistent {
                what: "two half-spaces in series",
                why: format!("their gradings differ, {} and {}", first.grading, second.grading),
            });
        }
        let normal = series(first.normal_stiffness, second.normal_stiffness);
        let tangential = series(
            first.stiffness_ratio * first.normal_stiffness,
            second.stiffness_ratio * second.normal_stiffness,
        );
        Self::from_stiffness(first.grading, normal, tangential / normal)
    }

    /// Grading `k` of `E(z) = E0 (z/z0)^k`.
    pub fn grading(&self) -> f64 {
        self.grading
    }

    /// Whether ground that wear spares at the contact edge comes to stand out as a rim that takes the load, so that the edge jumps. The deeper a half-space is soft, the
    /// less does pressure reach beyond the ground that is pressed on; from -0.5 down that was measured.
    pub fn loads_rims(&self) -> bool {
        self.grading <= -0.5
    }

    /// Normal spring stiffness `c_N`, N/m^(2+k).
    pub fn normal_stiffness(&self) -> f64 {
        self.normal_stiffness
    }

    /// Ratio of tangential to normal stiffness `M = c_T/c_N` [S, Eq. (12) under elastic similarity].
    pub fn stiffness_ratio(&self) -> f64 {
        self.stiffness_ratio
    }
}

/// Modulus at a depth, Pa: the law of grading [S, Eq. (1)].
///
/// ```text
/// E(z) = E0 (z/z0)^k
/// ```
///
/// # Arguments
/// * `grading` -- `k`, in (-1, 1)
/// * `modulus` -- `E0`, Pa
/// * `reference_depth` -- `z0`, m
/// * `depth` -- `z`, m
///
/// # Examples
/// ```
/// assert_eq!(fretwear::contact::half_space::modulus_at_depth(0.5, 100e9, 1e-3, 4e-3), 200e9);
/// ```
pub fn modulus_at_depth(grading: f64, modulus: f64, reference_depth: f64, depth: f64) -> f64 {
    modulus * (depth / reference_depth).powf(grading)
}

/// Stiffness ratio under elastic similarity, `M = 2/((1+k)(3+k))` [S, Eq. (12), where `ν = 1/(2+k)` is implied].
///
/// Outside (-1, 1) the number has no meaning.
///
/// # Examples
/// ```
/// assert!((fretwear::contact::half_space::similar_stiffness_ratio(0.0) - 2.0 / 3.0).abs() < 1e-15);
/// ```
pub fn similar_stiffness_ratio(grading: f64) -> f64 {
    2.0 / ((1.0 + grading) * (3.0 + grading))
}

/// `c_N z0^k/E0` under elastic similarity: `2 (1+k)(2+k) cos(kπ/2)/(3+k)`.
fn similar_normal_stiffness(k: f64) -> f64 {
    2.0 * (1.0 + k) * (2.0 + k) * cos_half_pi(k) / (3.0 + k)
}

/// `c_N z0^k/E0 = h_N/(1-ν²)`.
fn unit_normal_stiffness(k: f64, ratio: f64) -> f64 {
    cos_half_pi(k) * surface_factor(k, ratio) / ((1.0 - ratio) * (1.0 + ratio))
}

/// `M` from `1/M = ½ {(1+k)²/β² + h_N/[(1-ν) cos(kπ/2)]}`.
fn stiffness_ratio(k: f64, ratio: f64) -> f64 {
    let shear = (1.0 + k) * (1.0 - ratio) / compressibility(k, ratio);
    2.0 / (shear + surface_factor(k, ratio) / (1.0 - ratio))
}

/// `1 - ν(1+k)`, so that `β² = (1+k)(1 - kν/(1-ν))` is `(1+k)(1 - ν(1+k))/(1-ν)`; positive for `ν <= 1/2`.
///
/// It vanishes in the corner `k = 1`, `ν = 1/2`; there the two small terms are formed one by one.
fn compressibility(k: f64, ratio: f64) -> f64 {
    if ratio > 0.0 { (1.0 - 2.0 * ratio) + ratio * (1.0 - k) } else { 1.0 - ratio * (1.0 + k) }
}

/// `h_N/cos(kπ/2)`, the part of `h_N` that stays clear of 0 as `k → 1`.
///
/// ```text
/// h_N = 2(1+k) cos(kπ/2) Γ(1+k/2) / [√π C β sin(βπ/2) Γ((1+k)/2)]
/// ```
///
/// For every `k` in (-1, 1) and `ν` in (-1, 1/2], `β` lies in (0, √3), where neither the sine nor an argument of Γ vanishes;
/// `Γ((1+k)/2)` alone grows without bound as `k → -1` and is therefore taken as `Γ((3+k)/2)/((1+k)/2)`.
fn surface_factor(k: f64, ratio: f64) -> f64 {
    let beta = ((1.0 + k) * compressibility(k, ratio) / (1.0 - ratio)).sqrt();
    let numerator = (1.0 + k) * (1.0 + k) * tgamma(1.0 + 0.5 * k) / tgamma(1.5 + 0.5 * k);
    numerator / (PI.sqrt() * depth_constant(k, beta) * beta * (beta * FRAC_PI_2).sin())
}

/// `C = 2^(1+k) Γ((3+k+β)/2) Γ((3+k-β)/2) / (π Γ(2+k))`.
fn depth_constant(k: f64, beta: f64) -> f64 {
    (1.0 + k).exp2() * tgamma(0.5 * (3.0 + k + beta)) * tgamma(0.5 * (3.0 + k - beta))
        / (PI * tgamma(2.0 + k))
}

/// `cos(kπ/2)` with full relative accuracy as `k → ±1`.
fn cos_half_pi(k: f64) -> f64 {
    if k.abs() < 0.5 { (k * FRAC_PI_2).cos() } else { ((1.0 - k.abs()) * FRAC_PI_2).sin() }
}

/// `1/(1/a + 1/b)` of positive numbers, without overflow on the way.
fn series(a: f64, b: f64) -> f64 {
    let (soft, stiff) = (a.min(b), a.max(b));
    soft / (1.0 + soft / stiff)
}

fn check_grading(grading: f64) -> Result<()> {
    if grading > -1.0 && grading < 1.0 {
        return Ok(());
    }
    Err(Error::OutOfRange { name: "half_space.grading", value: grading, range: "(-1, 1)" })
}

fn check_positive(name: &'static str, value: f64) -> Result<()> {
    if value > 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(Error::OutOfRange { name, value, range: "(0, inf)" })
}
