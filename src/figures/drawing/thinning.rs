//! Lines without the points that nobody sees.

use super::{Axis, Figure, Style};

/// Points up to which a line is left as it is.
const FEW: usize = 2000;

/// Part of an axis by which a line may be off: a hundredth of a px, so that a page can be zoomed into.
const UNSEEN: f64 = 2e-5;

impl Figure {
    /// Leaves points of long lines out, so that what is left is off by less than a hundredth of a px.
    pub fn thin(&mut self) {
        for panel in self.rows.iter_mut().flat_map(|row| &mut row.panels) {
            let axes = [&panel.x, &panel.y];
            for series in &mut panel.series {
                if series.points.len() > FEW && matches!(series.style, Style::Line { .. }) {
                    series.points = thinned(&series.points, axes);
                }
            }
        }
    }
}

/// The points that are left, by halving at the point farthest from the line between two that stay (Douglas & Peucker, Cartographica 10:112,
/// 1973).
fn thinned(points: &[[f64; 2]], axes: [&Axis; 2]) -> Vec<[f64; 2]> {
    let places: Vec<[f64; 2]> = points.iter().map(|[x, y]| [axes[0].place(*x), axes[1].place(*y)]).collect();
    // Both ends of every run stay, and what breaks the line.
    let breaks = |at: usize| places[at].iter().any(|place| !place.is_finite());
    let last = points.len() - 1;
    let mut kept: Vec<bool> = (0..points.len())
        .map(|at| at == 0 || at == last || breaks(at) || breaks(at - 1) || breaks(at + 1))
        .collect();
    let fixed: Vec<usize> = (0..points.len()).filter(|at| kept[*at]).collect();
    let mut open: Vec<(usize, usize)> = fixed.windows(2).map(|pair| (pair[0], pair[1])).collect();
    while let Some((first, end)) = open.pop() {
        let distances = (first + 1..end).map(|at| (at, distance(places[at], places[first], places[end])));
        let farthest = distances.max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((at, _)) = farthest.filter(|(_, distance)| *distance > UNSEEN) {
            kept[at] = true;
            open.extend([(first, at), (at, end)]);
        }
    }
    points.iter().zip(kept).filter_map(|(point, kept)| kept.then_some(*point)).collect()
}

/// Distance of a place from the line between two others.
fn distance(from: [f64; 2], first: [f64; 2], end: [f64; 2]) -> f64 {
    let along = [end[0] - first[0], end[1] - first[1]];
    let length = along[0].powi(2) + along[1].powi(2);
    let offset = [from[0] - first[0], from[1] - first[1]];
    let part = (offset[0] * along[0] + offset[1] * along[1]) / length;
    // Where the two are one place there is no direction.
    let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 };
    (offset[0] - part * along[0]).hypot(offset[1] - part * along[1])
}

#[cfg(test)]
mod tests {
    use super::super::Spacing;
    use super::*;

    #[test]
    fn a_line_with_a_gap_keeps_its_shape_and_its_gap() {
        let axes = [
            Axis::new("x", "", Spacing::Linear, [0.0, 10.0]),
            Axis::new("y", "", Spacing::Linear, [-1.0, 1.0]),
        ];
        let mut points: Vec<[f64; 2]> =
            (0..=20_000).map(|i| f64::from(i) * 5e-4).map(|x| [x, x.sin()]).collect();
        points[12_345][1] = f64::NAN;
        let left = thinned(&points, [&axes[0], &axes[1]]);
        assert!(left.len() < 1500, "{} points are left", left.len());
        assert_eq!(left.iter().filter(|point| point[1].is_nan()).count(), 1);
        for [x, y] in points.iter().filter(|point| point[1].is_finite()) {
            let after = left.partition_point(|point| point[0] < *x).max(1);
            let (a, b) = (left[after - 1], left[after]);
            if a[1].is_finite() && b[1].is_finite() {
                let on_line = a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]);
                assert!((on_line - y).abs() < 2.0 * 10.0 * UNSEEN, "at {x}: {on_line} for {y}");
            }
        }
    }
}
