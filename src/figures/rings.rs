//! Areas in which values on a grid are at least so large, as closed rings.

use std::collections::BTreeMap;

/// A point, by the bits of its coordinates.
type Key = [u64; 2];

/// Values on a grid.
pub(super) struct Grid<'a> {
    /// Coordinates, shapes `(n,)` and `(m,)`, increasing.
    pub first: &'a [f64],
    pub second: &'a [f64],
    /// Shape `(n, m)`; not a number where there is none.
    pub values: &'a [f64],
}

impl Grid<'_> {
    /// The rings around where the values, taken as linear along the edges of the grid, reach a level; after each a point that is not a number.
    ///
    /// Cells with a corner that has no value are left out; [`Grid::gaps`] are they.
    pub(super) fn rings(&self, level: f64) -> Vec<[f64; 2]> {
        let mut sides: BTreeMap<(Key, Key), usize> = BTreeMap::new();
        for i in 1..self.first.len() {
            for j in 1..self.second.len() {
                if self.lacks(i, j) {
                    continue;
                }
                let part = self.part_of_cell(i, j, level);
                for (place, from) in part.iter().enumerate() {
                    let to = part[(place + 1) % part.len()];
                    // What two cells share lies inside.
                    match sides.get_mut(&(key(to), key(*from))) {
                        Some(count) if *count > 0 => *count -= 1,
                        _ => *sides.entry((key(*from), key(to))).or_insert(0) += 1,
                    }
                }
            }
        }
        sides.retain(|(from, to), count| *count > 0 && from != to);
        joined(sides)
    }

    /// Whether a corner of a cell has no value.
    fn lacks(&self, i: usize, j: usize) -> bool {
        let value = |i: usize, j: usize| self.values[i * self.second.len() + j];
        [value(i - 1, j - 1), value(i, j - 1), value(i, j), value(i - 1, j)].iter().any(|it| it.is_nan())
    }

    /// The cells with a corner that has no value, as rectangles; after each a point that is not a number.
    pub(super) fn gaps(&self) -> Vec<[f64; 2]> {
        let mut rings = vec![];
        for i in 1..self.first.len() {
            let mut next = 1;
            while next < self.second.len() {
                let start = next;
                next += 1;
                if !self.lacks(i, start) {
                    continue;
                }
                // Those that follow each other are one.
                while next < self.second.len() && self.lacks(i, next) {
                    next += 1;
                }
                let ([left, right], [low, high]) =
                    ([self.first[i - 1], self.first[i]], [self.second[start - 1], self.second[next - 1]]);
                rings.extend([[left, low], [right, low], [right, high], [left, high], [f64::NAN; 2]]);
            }
        }
        rings
    }

    /// Corner of the part of a cell that reaches the level, counted round.
    fn part_of_cell(&self, i: usize, j: usize, level: f64) -> Vec<[f64; 2]> {
        let corners = [(i - 1, j - 1), (i, j - 1), (i, j), (i - 1, j)];
        let value = |(i, j): (usize, usize)| self.values[i * self.second.len() + j];
        let point = |(i, j): (usize, usize)| [self.first[i], self.second[j]];
        let mut part = vec![];
        for (place, &from) in corners.iter().enumerate() {
            let to = corners[(place + 1) % 4];
            if value(from) >= level {
                part.push(point(from));
            }
            if (value(from) >= level) != (value(to) >= level) {
                // In one order for both cells at the edge, so that they find the same point.
                let (low, high) = if from < to { (from, to) } else { (to, from) };
                let t = (level - value(low)) / (value(high) - value(low));
                let [start, end] = [point(low), point(high)];
                part.push([start[0] + t * (end[0] - start[0]), start[1] + t * (end[1] - start[1])]);
            }
        }
        part
    }
}

fn key(point: [f64; 2]) -> Key {
    // Zero has two signs.
    point.map(|value| (value + 0.0).to_bits())
}

/// Sides joined to rings, without the corners along straight stretches.
fn joined(mut sides: BTreeMap<(Key, Key), usize>) -> Vec<[f64; 2]> {
    let value = |key: Key| key.map(f64::from_bits);
    let mut rings = vec![];
    while let Some(((start, next), _)) = sides.pop_first() {
        let mut ring = vec![value(start)];
        let mut at = next;
        while at != start {
            ring.push(value(at));
            let onwards = sides.range((at, [0; 2])..=(at, [u64::MAX; 2])).next().map(|(side, _)| *side);
            let Some(side) = onwards else { break };
            sides.remove(&side);
            at = side.1;
        }
        rings.extend(without_straight(&ring));
        rings.push([f64::NAN; 2]);
    }
    rings
}

/// A ring without the corners between two sides along the same coordinate line.
fn without_straight(ring: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let count = ring.len();
    let is_straight = |place: usize| {
        let [before, at, after] = [ring[(place + count - 1) % count], ring[place], ring[(place + 1) % count]];
        (0..2).any(|axis| before[axis] == at[axis] && at[axis] == after[axis])
    };
    (0..count).filter(|place| !is_straight(*place)).map(|place| ring[place]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Area within rings, holes taken away (the shoelace formula).
    fn area(rings: &[[f64; 2]]) -> f64 {
        let of = |ring: &[[f64; 2]]| {
            let next = ring.iter().cycle().skip(1);
            ring.iter().zip(next).map(|(a, b)| 0.5 * (a[0] * b[1] - b[0] * a[1])).sum::<f64>()
        };
        rings.split(|point| point[0].is_nan()).map(of).sum()
    }

    #[test]
    fn rings_of_a_hill_have_the_area_of_their_discs() {
        let axis: Vec<f64> = (0..=80).map(|i| -1.0 + f64::from(i) / 40.0).collect();
        let values: Vec<f64> =
            axis.iter().flat_map(|x| axis.iter().map(move |y| 1.0 - x * x - y * y)).collect();
        let grid = Grid { first: &axis, second: &axis, values: &values };
        let found = area(&grid.rings(0.75));
        assert!((found - 0.25 * std::f64::consts::PI).abs() < 2e-3, "{found}");
        // All of the square, and none of it.
        assert!((area(&grid.rings(-2.0)) - 4.0).abs() < 1e-12 && grid.rings(2.0).is_empty());
        assert_eq!(grid.rings(-2.0).len(), 5, "four corners and an end");
        let bowl: Vec<f64> = values.iter().map(|value| -value).collect();
        let ring = Grid { values: &bowl, ..grid };
        let found = area(&ring.rings(-0.75));
        assert!((found - 4.0 + 0.25 * std::f64::consts::PI).abs() < 2e-3, "a hole: {found}");
    }

    #[test]
    fn cells_beside_a_gap_belong_to_no_ring_and_all_others_to_one() {
        let axis = [0.0, 1.0, 2.0, 3.0, 4.0];
        let mut values = vec![1.0; 25];
        // One in the middle, which four cells touch, and one in a corner.
        values[12] = f64::NAN;
        values[24] = f64::NAN;
        let grid = Grid { first: &axis, second: &axis, values: &values };
        let (gaps, rings) = (area(&grid.gaps()), area(&grid.rings(f64::NEG_INFINITY)));
        assert_eq!([gaps, rings], [5.0, 11.0]);
    }
}
