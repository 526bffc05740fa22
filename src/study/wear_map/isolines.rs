//! Lines of equal value on a grid with holes.
//!
//! Marching squares of our own: of the two crates that offer them, one closes every line along the border and around holes and is
//! shifted by half a cell, the other's licence is the AGPL.

use std::collections::HashMap;

/// A line of equal value.
#[derive(Debug, Clone, PartialEq)]
pub struct Isoline {
    /// The value.
    pub level: f64,
    /// Points, coordinates along the first and the second axis.
    pub points: Vec<[f64; 2]>,
}

/// An edge of the grid: from a node along an axis to the next node.
type Edge = (usize, usize, usize);

/// Lines on which positive values on a grid equal the levels; cells with a corner that is not a number are left out.
///
/// On each edge of the grid a line is placed by cubic interpolation of the logarithm, so that the error of a point falls with the fourth
/// power of the spacing.
///
/// # Arguments
/// * `first`, `second` -- coordinates along the axes, shapes `(n,)` and `(m,)`, increasing
/// * `values` -- shape `(n, m)`
/// * `levels` -- positive
///
/// # Panics
/// If the shapes disagree.
pub fn isolines(first: &[f64], second: &[f64], values: &[f64], levels: &[f64]) -> Vec<Isoline> {
    assert_eq!(values.len(), first.len() * second.len(), "values of the grid");
    let logarithms: Vec<f64> = values.iter().map(|value| value.ln()).collect();
    let grid = Grid { first, second, values: &logarithms };
    levels.iter().flat_map(|&level| grid.lines(level)).collect()
}

struct Grid<'a> {
    first: &'a [f64],
    second: &'a [f64],
    /// Logarithms.
    values: &'a [f64],
}

impl Grid<'_> {
    fn value(&self, i: usize, j: usize) -> f64 {
        self.values[i * self.second.len() + j]
    }

    fn lines(&self, level: f64) -> Vec<Isoline> {
        let target = level.ln();
        let mut segments = vec![];
        for i in 0..self.first.len().saturating_sub(1) {
            for j in 0..self.second.len().saturating_sub(1) {
                self.add_cell(i, j, target, &mut segments);
            }
        }
        let place = |edge: &Edge| self.place(*edge, target);
        let chains = chains(&segments);
        chains.into_iter().map(|chain| Isoline { level, points: chain.iter().map(place).collect() }).collect()
    }

    /// The segments of one cell, as pairs of the edges they join.
    fn add_cell(&self, i: usize, j: usize, target: f64, segments: &mut Vec<[Edge; 2]>) {
        let corners =
            [self.value(i, j), self.value(i + 1, j), self.value(i + 1, j + 1), self.value(i, j + 1)];
        if corners.iter().any(|corner| !corner.is_finite()) {
            return;
        }
        let edges: [Edge; 4] = [(0, i, j), (1, i + 1, j), (0, i, j + 1), (1, i, j)];
        let above = corners.map(|corner| corner >= target);
        let crossed: Vec<Edge> =
            (0..4).filter(|&side| above[side] != above[(side + 1) % 4]).map(|side| edges[side]).collect();
        match crossed[..] {
            [one, other] => segments.push([one, other]),
            [first, second, third, fourth] => {
                // A saddle: the middle tells which corners belong together.
                let middle_above = 0.25 * corners.iter().sum::<f64>() >= target;
                if middle_above == above[0] {
                    segments.extend([[first, second], [third, fourth]]);
                } else {
                    segments.extend([[fourth, first], [second, third]]);
                }
            }
            _ => {}
        }
    }

    /// Where the line crosses an edge.
    fn place(&self, (axis, i, j): Edge, target: f64) -> [f64; 2] {
        let (coordinates, at, count) =
            if axis == 0 { (self.first, i, self.first.len()) } else { (self.second, j, self.second.len()) };
        let value = |at: usize| if axis == 0 { self.value(at, j) } else { self.value(i, at) };
        let crossing = crossing(coordinates, value, at, count, target);
        if axis == 0 { [crossing, self.second[j]] } else { [self.first[i], crossing] }
    }
}

/// Between the nodes `at` and `at + 1`, by the cubic through these and their neighbours, or linear where a neighbour is missing.
fn crossing(coordinates: &[f64], value: impl Fn(usize) -> f64, at: usize, count: usize, target: f64) -> f64 {
    let (low, high) = (value(at) - target, value(at + 1) - target);
    let (left, right) = (coordinates[at], coordinates[at + 1]);
    let linear = left + (right - left) * low / (low - high);
    let whole = at >= 1 && at + 2 < count && value(at - 1).is_finite() && value(at + 2).is_finite();
    if !whole || low == 0.0 || high == 0.0 {
        return linear;
    }
    let cubic = |x: f64| {
        (at - 1..=at + 2).fold(0.0, |sum, node| {
            let others = (at - 1..=at + 2).filter(|&other| other != node);
            let weight: f64 = others
                .map(|other| (x - coordinates[other]) / (coordinates[node] - coordinates[other]))
                .product();
            sum + weight * (value(node) - target)
        })
    };
    crate::numerics::roots::bracketed(cubic, left, right, 1e-12 * (right - left)).unwrap_or(linear)
}

/// Joins segments that share an edge to lines, closed ones with the first edge repeated; the order does not depend on hashing.
fn chains(segments: &[[Edge; 2]]) -> Vec<Vec<Edge>> {
    let mut at_edge: HashMap<Edge, Vec<usize>> = HashMap::new();
    for (index, ends) in segments.iter().enumerate() {
        ends.iter().for_each(|edge| at_edge.entry(*edge).or_default().push(index));
    }
    let mut used = vec![false; segments.len()];
    // Goes on from an edge until no unused segment is left there.
    let mut follow = |start: Edge| {
        let mut line = vec![start];
        let mut end = start;
        while let Some(&next) = at_edge[&end].iter().find(|&&segment| !used[segment]) {
            used[next] = true;
            end = if segments[next][0] == end { segments[next][1] } else { segments[next][0] };
            line.push(end);
        }
        line
    };
    let mut lines = vec![];
    // Open lines from their ends first; what is left is closed.
    let is_end = |edge: &Edge| at_edge[edge].len() == 1;
    for &start in segments.iter().flatten().filter(|edge| is_end(edge)) {
        lines.push(follow(start));
    }
    for segment in segments {
        lines.push(follow(segment[0]));
    }
    lines.retain(|line| line.len() > 1);
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of `exp(f)` over [-1, 1]².
    fn grid(count: usize, f: impl Fn(f64, f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let axis: Vec<f64> = (0..count).map(|i| -1.0 + 2.0 * i as f64 / (count - 1) as f64).collect();
        let values = axis.iter().flat_map(|&x| axis.iter().map(move |&y| (x, y))).map(|(x, y)| f(x, y).exp());
        let values = values.collect();
        (axis, values)
    }

    #[test]
    fn circles_close_and_converge_with_the_fourth_power() {
        let error = |count: usize| {
            let (axis, values) = grid(count, |x, y| (x * x + y * y).sqrt() + 0.3 * x);
            let lines = isolines(&axis, &axis, &values, &[0.6f64.exp()]);
            assert_eq!(lines.len(), 1);
            let points = &lines[0].points;
            assert_eq!(points.first(), points.last());
            points
                .iter()
                .fold(0.0, |worst: f64, [x, y]| worst.max(((x * x + y * y).sqrt() + 0.3 * x - 0.6).abs()))
        };
        let (coarse, fine) = (error(21), error(81));
        let order = (coarse / fine).log2() / 2.0;
        assert!(fine < 1e-6 && order > 3.5, "errors {coarse:e} and {fine:e}, order {order}");
    }

    #[test]
    fn lines_end_at_holes_and_borders() {
        let hole = |x: f64, y: f64| if x > 0.3 && y > 0.3 { f64::NAN } else { y - x };
        let (axis, values) = grid(11, hole);
        let lines = isolines(&axis, &axis, &values, &[0.1f64.exp()]);
        assert_eq!(lines.len(), 1, "{lines:?}");
        assert!(lines[0].points.iter().all(|[x, y]| (y - x - 0.1).abs() < 1e-9 && *x < 0.4));
    }

    #[test]
    fn a_saddle_has_two_lines_that_do_not_cross() {
        let (axis, values) = grid(4, |x, y| x * y + 0.05);
        let lines = isolines(&axis, &axis, &values, &[1.0]);
        assert_eq!(lines.len(), 2, "{lines:?}");
    }
}
