//! Plain tangential oscillation, of which every other mode is an extension.

use super::mode::Mode;
use crate::laws::path::PathPoint;

/// `u = U cos ωt`, nothing else; in a scene it is what is left where no mode is given.
#[derive(Debug, Clone, Copy)]
pub struct Tangential;

impl Mode for Tangential {
    fn words(&self) -> String {
        "tangential oscillation".into()
    }

    /// From `U` to `-U` and back in even steps. A path along a line is the same however it is cut, so two substeps are as good as any number.
    fn period(&self, amplitude: f64, substeps: usize) -> Vec<PathPoint> {
        let there = substeps.max(2).div_ceil(2);
        let back = substeps.max(2) - there;
        let way = |from: f64, steps: usize| {
            (0..steps).map(move |i| PathPoint {
                tangential: [from * (1.0 - 2.0 * i as f64 / steps as f64), 0.0],
                lift: 0.0,
            })
        };
        way(amplitude, there).chain(way(-amplitude, back)).collect()
    }
}
