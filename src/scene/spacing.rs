//! Values along an axis.

/// How they are spread.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Spacing {
    /// In equal steps.
    Linear,
    /// In equal ratios; both ends above zero.
    Geometric,
}

impl Spacing {
    /// Both.
    pub(super) const ALL: [Self; 2] = [Self::Linear, Self::Geometric];

    /// Their words in a file, in the same order.
    pub(super) const WORDS: [&'static str; 2] = ["linear", "geometric"];

    /// Values from one end to the other, both met exactly.
    ///
    /// # Panics
    /// For fewer than two.
    pub(super) fn values(self, from: f64, to: f64, count: usize) -> Vec<f64> {
        assert!(count >= 2, "{count} values");
        let last = (count - 1) as f64;
        let between = |i: usize| match self {
            Self::Geometric => from * ((to / from).ln() * i as f64 / last).exp(),
            // Weighted so that a value meant to be zero is zero.
            Self::Linear => (from * (last - i as f64) + to * i as f64) / last,
        };
        (0..count)
            .map(|i| {
                if i == 0 {
                    from
                } else if i + 1 == count {
                    to
                } else {
                    between(i)
                }
            })
            .collect()
    }
}
