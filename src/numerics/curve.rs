//! Distances of curves, where they are steep at places that are known to an error of their own.

/// Distance of a point from the curve through `(x_i, y_i)`, by the larger of both coordinates.
///
/// # Arguments
/// * `x` -- shape `(n,)`, increasing
/// * `y` -- shape `(n,)` or longer
/// * `point` -- both coordinates
/// * `near` -- index from which the nearest piece is sought, where `x` is that of the point
pub fn distance_from_curve(x: &[f64], y: &[f64], point: [f64; 2], near: usize) -> f64 {
    let to = |j: usize| [x[j] - point[0], y[j] - point[1]];
    let mut least = (y[near] - point[1]).abs();
    // Pieces farther away than what was found are not the nearest.
    let left = (0..near).rev().take_while(|j| point[0] - x[j + 1] < least);
    least = left.map(|j| nearest(to(j), to(j + 1))).fold(least, f64::min);
    let right = (near + 1..x.len().min(y.len())).take_while(|j| x[j - 1] - point[0] < least);
    right.map(|j| nearest(to(j - 1), to(j))).fold(least, f64::min)
}

/// Distance of the origin from a straight line between two points, by the larger of the coordinates.
fn nearest(from: [f64; 2], to: [f64; 2]) -> f64 {
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    let size = |part: f64| {
        let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 };
        (from[0] + part * dx).abs().max((from[1] + part * dy).abs())
    };
    // Where a coordinate is zero, or both are as large: there the larger one has its least.
    let places = [
        0.0,
        1.0,
        -from[0] / dx,
        -from[1] / dy,
        (from[1] - from[0]) / (dx - dy),
        -(from[0] + from[1]) / (dx + dy),
    ];
    places.into_iter().map(size).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_next_to_a_step_is_as_far_as_the_step() {
        let x = [0.0, 0.5, 0.51, 1.0];
        let y = [0.0, 0.0, 1.0, 1.0];
        // At the foot of the step it would be 1 below by depth alone.
        assert!((distance_from_curve(&x, &y, [0.51, 0.0], 2) - 0.01 / 1.01).abs() < 1e-12);
        assert_eq!(distance_from_curve(&x, &y, [1.0, 1.25], 3), 0.25);
    }
}
