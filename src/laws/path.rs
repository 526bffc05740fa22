//! The path of the indenter over one period.

/// A place of the indenter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PathPoint {
    /// Tangential displacements `u_x`, `u_y` from where it was pressed on, m.
    pub tangential: [f64; 2],
    /// How far it is lifted from the largest indentation of the path, `d_max - d >= 0`, m.
    pub lift: f64,
}

/// A closed path of straight lines; the last point leads back to the first.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// The corners, at least two; the smallest lift is zero.
    pub points: Vec<PathPoint>,
}

impl Path {
    /// Length of the tangential path, m.
    pub fn length(&self) -> f64 {
        let next = self.points.iter().cycle().skip(1);
        let step = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]).hypot(b[1] - a[1]);
        self.points.iter().zip(next).map(|(a, b)| step(a.tangential, b.tangential)).sum()
    }

    /// Whether it has no component along y.
    pub fn is_straight(&self) -> bool {
        self.points.iter().all(|point| point.tangential[1] == 0.0)
    }

    /// Whether the indentation is the same at every point.
    pub fn is_level(&self) -> bool {
        self.points.iter().all(|point| point.lift == self.points[0].lift)
    }

    /// What of the period goes one way, by substep: springs slip one way only between reversals of a level path along a line, so those
    /// substeps are one; every other substep is by itself. Counted from 0 in the order in which they begin.
    ///
    /// ```
    /// use fretwear::laws::motion::{SampledPath, Tangential};
    ///
    /// let path = SampledPath::new(&Tangential, 3.0, 1.0, 5).path;
    /// assert_eq!(path.ways(), [0, 0, 0, 1, 1]);
    /// ```
    pub fn ways(&self) -> Vec<usize> {
        let count = self.points.len();
        if !(self.is_straight() && self.is_level()) {
            return (0..count).collect();
        }
        let moved = |m: usize| self.points[(m + 1) % count].tangential[0] - self.points[m].tangential[0];
        let mut ways = vec![0; count];
        let mut last = 0.0;
        for m in 0..count {
            let turned = last * moved(m) < 0.0;
            ways[m] = if m == 0 { 0 } else { ways[m - 1] + usize::from(turned) };
            if moved(m) != 0.0 {
                last = moved(m);
            }
        }
        // A path that begins between its reversals ends the way it began.
        let first = (0..count).map(moved).find(|moved| *moved != 0.0).unwrap_or_default();
        let whole = ways[count - 1];
        if whole > 1 && last * first > 0.0 {
            ways.iter_mut().filter(|way| **way == whole).for_each(|way| *way = 0);
        }
        ways
    }

    /// Numbers for the slip of a spring in one way: one along a line, else two.
    pub fn components(&self) -> usize {
        if self.is_straight() { 1 } else { 2 }
    }

    /// Numbers for the slip of a spring in a period.
    ///
    /// # Arguments
    /// * `ways` -- [`Path::ways`] of this path
    pub fn columns(&self, ways: &[usize]) -> usize {
        self.components() * ways.iter().max().map_or(0, |last| last + 1)
    }

    /// The path with all tangential displacements times `factor`.
    pub fn stretched(&self, factor: f64) -> Self {
        let stretched =
            |point: &PathPoint| PathPoint { tangential: point.tangential.map(|u| factor * u), ..*point };
        Self { points: self.points.iter().map(stretched).collect() }
    }

    /// Largest lift, m: springs of smaller compression at the largest indentation lift off in each period.
    pub fn largest_lift(&self) -> f64 {
        self.points.iter().fold(0.0, |largest, point| largest.max(point.lift))
    }
}
