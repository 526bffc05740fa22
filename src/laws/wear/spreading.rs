//! How debris that stays in the contact spreads pressure.

/// Depth of the gap, over the compression at the edge of stick, that debris still fills. A choice: without an end, ground that has lost
/// contact would go on wearing for as long as anything nearby is pressed on, and the gap would deepen until no contact is left. With it the
/// run ends, with springs between no compression and that gap, by their history.
const DEBRIS_LAYER: f64 = 0.1;

/// Pressure, over the mean one of the unworn contact, from which on debris passes it on whole: without a kink at none.
const LEAST_DEBRIS: f64 = 1e-3;

/// Distance, in standard deviations, beyond which the weight is round-off.
const FARTHEST: f64 = 9.0;

/// A Gaussian average along the radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spreading {
    /// Standard deviation, m.
    pub length: f64,
}

impl Spreading {
    /// Pressure that debris passes on, Pa, and its slope: none of tension, and from a thousandth of the mean one on all but half of that.
    pub fn passed_on(self, pressure: f64, mean_pressure: f64) -> (f64, f64) {
        let least = LEAST_DEBRIS * mean_pressure;
        if pressure <= 0.0 {
            (0.0, 0.0)
        } else if pressure < least {
            (0.5 * pressure * pressure / least, pressure / least)
        } else {
            (pressure - 0.5 * least, 1.0)
        }
    }

    /// Weight of a place at some distance, m, next to that of the place itself; none where that is round-off.
    pub fn weight(self, distance: f64) -> f64 {
        let distance = distance / self.length;
        if distance.abs() < FARTHEST { (-0.5 * distance * distance).exp() } else { 0.0 }
    }

    /// Part of the debris that stays at some distance from the contact edge, m, where it leaves.
    ///
    /// ```text
    /// 1 - exp(-(a - r)/length)
    /// ```
    pub fn kept(self, distance: f64) -> f64 {
        -(-distance.max(0.0) / self.length).exp_m1()
    }

    /// How far debris fills the gap under a spring of some compression, m, and the derivative, where `q_c` is the compression at the edge of
    /// stick.
    ///
    /// ```text
    /// 1 in contact,    (1 - (q/h)²)² for -h < q < 0,    0 beyond;    h = q_c/10
    /// ```
    pub fn filled(self, compression: f64, slip_compression: f64) -> (f64, f64) {
        let layer = DEBRIS_LAYER * slip_compression;
        let part = (compression / layer).clamp(-1.0, 0.0);
        let left = 1.0 - part * part;
        (left * left, -4.0 * left * part / layer)
    }
}
