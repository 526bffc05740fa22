//! The kernel of the transform of a rise, tabulated: powers take a third of the time of a value.

use crate::numerics::chebyshev::Chebyshev;

/// Octaves of the table, `2^FIRST` to `2^LAST`, and parts of each, eight.
const FIRST: i32 = -40;
const LAST: i32 = 4;
const PART_BITS: u32 = 3;
const PARTS: usize = 1 << PART_BITS;

/// Terms of the polynomial on a part: a power is then exact to round-off, and an exponential of the last octave.
const TERMS: usize = 13;

/// Bits of the mantissa of a number, and of what is left of it within a part.
const MANTISSA: u32 = f64::MANTISSA_DIGITS - 1;
const REST: u32 = MANTISSA - PART_BITS;
/// Exponent of a number one in its bits.
const BIAS: i32 = f64::MAX_EXP - 1;
/// Width of a part's own coordinate in units of the last of those bits.
const STEP: f64 = 1.0 / (1_u64 << (REST - 1)) as f64;

/// `(e^y - 1)^(-ν)` as polynomials on parts of octaves.
#[derive(Debug)]
pub(super) struct RiseKernel {
    nu: f64,
    /// Coefficients of the powers of a part's own coordinate, from -1 to 1.
    parts: Vec<[f64; TERMS]>,
}

impl RiseKernel {
    pub(super) fn new(nu: f64) -> Self {
        let part = |index: usize| {
            let octave = f64::from(FIRST + (index / PARTS) as i32).exp2();
            let (begin, width) =
                (octave * (1.0 + (index % PARTS) as f64 / PARTS as f64), octave / PARTS as f64);
            Chebyshev::powers(|x| exact(begin + width * x, nu))
        };
        Self { nu, parts: (0..(LAST - FIRST) as usize * PARTS).map(part).collect() }
    }

    /// Its value at `y > 0`, to some 1e-14 of it.
    pub(super) fn value(&self, y: f64) -> f64 {
        let bits = y.to_bits();
        let octave = (bits >> MANTISSA) as i32 - BIAS;
        let part = (bits >> REST) as usize % PARTS;
        if !(FIRST..LAST).contains(&octave) {
            return exact(y, self.nu);
        }
        let rest = bits & ((1 << REST) - 1);
        let x = rest as f64 * STEP - 1.0;
        let part = &self.parts[(octave - FIRST) as usize * PARTS + part];
        part.iter().rev().fold(0.0, |sum, c| sum * x + c)
    }
}

fn exact(y: f64, nu: f64) -> f64 {
    y.exp_m1().powf(-nu)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_the_kernel_over_all_octaves() {
        for nu in [0.005, 0.3, 0.5, 0.995] {
            let kernel = RiseKernel::new(nu);
            let mut y = 1e-14;
            while y < 40.0 {
                let (found, exact) = (kernel.value(y), exact(y, nu));
                assert!((found / exact - 1.0).abs() < 2e-13, "ν = {nu} at {y}: {found} {exact}");
                y *= 1.0173;
            }
        }
    }
}
