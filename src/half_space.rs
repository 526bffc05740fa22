//! The graded half-space `E(z) = E0 (z/z0)^k` as a row of springs: stiffnesses `c_N |x|^k dx` and `c_T |x|^k dx`.

use crate::error::{Error, Result};

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
        if !(grading > -1.0 && grading < 1.0) {
            return Err(Error::OutOfRange { name: "grading", value: grading, range: "(-1, 1)" });
        }
        for (name, value) in [("normal_stiffness", normal_stiffness), ("stiffness_ratio", stiffness_ratio)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::OutOfRange { name, value, range: "(0, inf)" });
            }
        }
        Ok(Self { grading, normal_stiffness, stiffness_ratio })
    }

    /// Grading `k` of `E(z) = E0 (z/z0)^k`.
    pub fn grading(&self) -> f64 {
        self.grading
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
