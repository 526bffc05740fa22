//! What benches share.

/// The power of the first with which the second of each pair grows: slope of the straight line through the logarithms.
pub fn exponent(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let points: Vec<(f64, f64)> = pairs.map(|(x, y)| (x.ln(), y.ln())).collect();
    let count = points.len() as f64;
    let (x, y) =
        points.iter().fold((0.0, 0.0), |sum, point| (sum.0 + point.0 / count, sum.1 + point.1 / count));
    let (above, below) = points.iter().fold((0.0, 0.0), |sum, point| {
        (sum.0 + (point.0 - x) * (point.1 - y), sum.1 + (point.0 - x).powi(2))
    });
    above / below
}
