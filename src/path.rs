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
