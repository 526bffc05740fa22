//! Powers.

/// `x^y` of a positive number; by a root where the exponent is a half, as in the transforms of a homogeneous half-space, which takes a third of the time.
pub fn power(base: f64, exponent: f64) -> f64 {
    if exponent == 0.5 {
        base.sqrt()
    } else if exponent == -0.5 {
        base.sqrt().recip()
    } else {
        base.powf(exponent)
    }
}
