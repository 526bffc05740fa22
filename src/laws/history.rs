//! What changes along the cycles.

use serde::Serialize;

/// A factor that depends on the dimensionless time or on the number of cycles.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum History {
    /// Always 1.
    #[default]
    Constant,
    /// From 1 to `last`, `last + (1 - last) e^(-t/time)`.
    Exponential {
        /// The factor after a long time, at least 0.
        #[serde(rename = "final_factor")]
        last: f64,
        /// `t` at which the difference has fallen to `1/e`, positive.
        time: f64,
    },
    /// Linear between given times, constant before and after.
    Table {
        /// Times, increasing, at least one.
        times: Vec<f64>,
        /// Factors, positive.
        factors: Vec<f64>,
    },
}

impl History {
    /// Whether the factor is the same from one time to a later one with no kink in between.
    pub fn stays(&self, from: f64, to: f64) -> bool {
        match self {
            Self::Constant => true,
            Self::Exponential { last, .. } => *last == 1.0,
            Self::Table { .. } => self.at(from) == self.at(to),
        }
    }

    /// The factor at time `t >= 0`, in the unit of the times given.
    ///
    /// ```
    /// use fretwear::laws::history::History;
    ///
    /// let falling = History::Table { times: vec![1.0, 3.0], factors: vec![1.0, 0.5] };
    /// assert_eq!([0.0, 2.0, 9.0].map(|t| falling.at(t)), [1.0, 0.75, 0.5]);
    /// ```
    pub fn at(&self, t: f64) -> f64 {
        match self {
            Self::Constant => 1.0,
            Self::Exponential { last, time } => last + (1.0 - last) * (-t / time).exp(),
            Self::Table { times, factors } => {
                let after = times.partition_point(|time| *time <= t);
                match after {
                    0 => factors[0],
                    after if after == times.len() => factors[after - 1],
                    after => {
                        let part = (t - times[after - 1]) / (times[after] - times[after - 1]);
                        factors[after - 1] + part * (factors[after] - factors[after - 1])
                    }
                }
            }
        }
    }

    /// Times at which the factor has a kink.
    pub fn kinks(&self) -> &[f64] {
        match self {
            Self::Table { times, .. } => times,
            _ => &[],
        }
    }

    /// The factor after a long time.
    pub fn last(&self) -> f64 {
        match self {
            Self::Constant => 1.0,
            Self::Exponential { last, .. } => *last,
            Self::Table { factors, .. } => factors[factors.len() - 1],
        }
    }

    /// Whether it falls, and whether it rises, somewhere.
    pub fn directions(&self) -> [bool; 2] {
        match self {
            Self::Constant => [false, false],
            Self::Exponential { last, .. } => [*last < 1.0, *last > 1.0],
            Self::Table { factors, .. } => [
                factors.windows(2).any(|pair| pair[1] < pair[0]),
                factors.windows(2).any(|pair| pair[1] > pair[0]),
            ],
        }
    }

    /// Smallest factor from one time to another, or at the first where the other is before.
    pub fn least_between(&self, from: f64, to: f64) -> f64 {
        let within = self.kinks().iter().copied().filter(|t| (from..to).contains(t));
        within.chain([from, to.max(from)]).map(|t| self.at(t)).fold(f64::INFINITY, f64::min)
    }

    /// Smallest and largest factor over all times.
    pub fn range(&self) -> [f64; 2] {
        match self {
            Self::Constant => [1.0, 1.0],
            Self::Exponential { last, .. } => [last.min(1.0), last.max(1.0)],
            Self::Table { factors, .. } => {
                let smallest = factors.iter().fold(f64::INFINITY, |m: f64, f| m.min(*f));
                [smallest, factors.iter().fold(0.0, |m: f64, f| m.max(*f))]
            }
        }
    }
}
