//! Samples of distributions: each is a function of the seed and its index alone, so that any shard can draw its own.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use sobol::Sobol;
use sobol::params::JoeKuoD6;
use spec_math::cephes64::{ndtr, ndtri};

/// How points are spread over the unit cube.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Independent and uniform.
    Random,
    /// Sobol's sequence (directions of Joe and Kuo) with a random digital shift.
    Sobol,
    /// One point in each of as many slices of every variable as there are samples.
    LatinHypercube,
}

impl Method {
    /// All methods, in the order of their names.
    pub const ALL: [Self; 3] = [Self::Random, Self::Sobol, Self::LatinHypercube];

    /// Their words in a study, in the same order.
    pub const WORDS: [&'static str; 3] = ["random", "sobol", "latin-hypercube"];
}

/// Points in the unit cube.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitCube {
    method: Method,
    count: u64,
    seed: u64,
    /// Direction numbers of Sobol's sequence, and its shift, for each variable.
    directions: Vec<Vec<u64>>,
    shifts: Vec<u64>,
    /// Slices of the samples, for each variable.
    slices: Vec<Vec<u32>>,
}

impl UnitCube {
    /// Most variables: Sobol's sequence has directions for so many.
    pub const MOST_VARIABLES: usize = 100;

    /// Points for a number of variables.
    ///
    /// # Panics
    /// For more variables than [`UnitCube::MOST_VARIABLES`], or more than `u32::MAX` samples.
    pub fn new(method: Method, count: u64, variables: usize, seed: u64) -> Self {
        assert!(variables <= Self::MOST_VARIABLES && count <= u64::from(u32::MAX));
        let mut cube = Self { method, count, seed, directions: vec![], shifts: vec![], slices: vec![] };
        // Streams from the far end belong to no sample.
        let mut generator = cube.generator(u64::MAX);
        match method {
            Method::Random => {}
            Method::Sobol => {
                cube.directions = Sobol::<f64>::init_direction_vals(variables, 64, &JoeKuoD6::minimal());
                cube.shifts = (0..variables).map(|_| generator.next_u64()).collect();
            }
            Method::LatinHypercube => {
                cube.slices = (0..variables).map(|_| permutation(count as u32, &mut generator)).collect();
            }
        }
        cube
    }

    /// Coordinate of a sample along a variable, strictly between 0 and 1.
    pub fn coordinate(&self, sample: u64, variable: usize) -> f64 {
        match self.method {
            Method::Random => self.uniform(sample, variable),
            Method::Sobol => {
                let gray = sample ^ (sample >> 1);
                let bits = self.directions[variable].iter().enumerate();
                let point =
                    bits.filter(|(bit, _)| gray >> bit & 1 == 1).fold(0, |sum, (_, value)| sum ^ value);
                inside(point ^ self.shifts[variable])
            }
            Method::LatinHypercube => {
                let slice = f64::from(self.slices[variable][sample as usize]);
                (slice + self.uniform(sample, variable)) / self.count as f64
            }
        }
    }

    fn generator(&self, stream: u64) -> ChaCha8Rng {
        let mut generator = ChaCha8Rng::seed_from_u64(self.seed);
        generator.set_stream(stream);
        generator
    }

    fn uniform(&self, sample: u64, variable: usize) -> f64 {
        let mut generator = self.generator(sample);
        // Two words of 32 bits each number.
        generator.set_word_pos(2 * variable as u128);
        inside(generator.next_u64())
    }
}

/// A number strictly between 0 and 1 of the 53 upper bits.
fn inside(bits: u64) -> f64 {
    ((bits >> 11) as f64 + 0.5) * 2f64.powi(-53)
}

/// A random permutation of `0 .. count`, by Fisher and Yates.
fn permutation(count: u32, generator: &mut ChaCha8Rng) -> Vec<u32> {
    let mut order: Vec<u32> = (0..count).collect();
    for last in (1..order.len()).rev() {
        // The product's upper half is uniform up to 2^-64 times the count.
        let chosen = (u128::from(generator.next_u64()) * (last as u128 + 1)) >> 64;
        order.swap(last, chosen as usize);
    }
    order
}

/// Distribution of one variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Distribution {
    /// Uniform between two values.
    Uniform {
        /// Lower end.
        from: f64,
        /// Upper end.
        to: f64,
    },
    /// Uniform in the logarithm between two positive values.
    LogUniform {
        /// Lower end.
        from: f64,
        /// Upper end.
        to: f64,
    },
    /// Normal, cut off where asked for.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation, positive.
        deviation: f64,
        /// Values are between these.
        bounds: [f64; 2],
    },
    /// Log-normal, cut off where asked for.
    LogNormal {
        /// Median, positive.
        median: f64,
        /// Two thirds of all values are within this factor of the median; above 1.
        factor: f64,
        /// Values are between these.
        bounds: [f64; 2],
    },
}

impl Distribution {
    /// The value below which the part `probability` in (0, 1) of all values lies.
    pub fn quantile(&self, probability: f64) -> f64 {
        match *self {
            Self::Uniform { from, to } => from + (to - from) * probability,
            Self::LogUniform { from, to } => from * (probability * (to / from).ln()).exp(),
            Self::Normal { mean, deviation, bounds } => {
                let standard = bounds.map(|bound| (bound - mean) / deviation);
                (mean + deviation * truncated_normal(probability, standard)).clamp(bounds[0], bounds[1])
            }
            Self::LogNormal { median, factor, bounds } => {
                let standard = bounds.map(|bound| (bound / median).ln() / factor.ln());
                let value = median * (factor.ln() * truncated_normal(probability, standard)).exp();
                value.clamp(bounds[0], bounds[1])
            }
        }
    }
}

/// Quantile of the standard normal distribution between bounds.
fn truncated_normal(probability: f64, [low, high]: [f64; 2]) -> f64 {
    let [below, above] = [ndtr(low), ndtr(high)];
    ndtri(below + (above - below) * probability).clamp(low, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_fills_the_cube_evenly_and_reproducibly() {
        for method in Method::ALL {
            let cube = UnitCube::new(method, 1024, 3, 7);
            for variable in 0..3 {
                let mean: f64 = (0..1024).map(|i| cube.coordinate(i, variable)).sum::<f64>() / 1024.0;
                let square: f64 =
                    (0..1024).map(|i| cube.coordinate(i, variable).powi(2)).sum::<f64>() / 1024.0;
                let tolerance = if method == Method::Random { 0.03 } else { 1e-3 };
                assert!(
                    (mean - 0.5).abs() < tolerance && (square - 1.0 / 3.0).abs() < tolerance,
                    "{method:?}: {mean} {square}"
                );
            }
            let again = UnitCube::new(method, 1024, 3, 7);
            let other = UnitCube::new(method, 1024, 3, 8);
            assert_eq!(cube.coordinate(77, 2), again.coordinate(77, 2));
            assert_ne!(cube.coordinate(77, 2), other.coordinate(77, 2));
        }
    }

    #[test]
    fn one_sample_lies_in_each_slice_of_a_latin_hypercube_and_of_sobols_sequence() {
        for method in [Method::Sobol, Method::LatinHypercube] {
            let cube = UnitCube::new(method, 64, 5, 3);
            for variable in 0..5 {
                let mut slices: Vec<usize> =
                    (0..64).map(|i| (64.0 * cube.coordinate(i, variable)) as usize).collect();
                slices.sort_unstable();
                assert_eq!(slices, (0..64).collect::<Vec<_>>(), "{method:?}, variable {variable}");
            }
        }
    }

    #[test]
    fn variables_of_one_sample_are_independent() {
        for method in Method::ALL {
            let cube = UnitCube::new(method, 4096, 4, 11);
            for (a, b) in [(0, 1), (1, 2), (0, 3)] {
                let covariance: f64 = (0..4096)
                    .map(|i| (cube.coordinate(i, a) - 0.5) * (cube.coordinate(i, b) - 0.5))
                    .sum::<f64>()
                    / 4096.0;
                assert!(covariance.abs() < 4.0 / (12.0 * 64.0), "{method:?}, {a} and {b}: {covariance}");
            }
        }
    }

    #[test]
    fn quantiles_are_those_of_the_distributions() {
        let none = [f64::NEG_INFINITY, f64::INFINITY];
        let close =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        close(Distribution::Uniform { from: -1.0, to: 3.0 }.quantile(0.25), 0.0);
        close(Distribution::LogUniform { from: 1.0, to: 100.0 }.quantile(0.5), 10.0);
        let normal = Distribution::Normal { mean: 2.0, deviation: 0.5, bounds: none };
        close(normal.quantile(0.5), 2.0);
        // Φ(1) = 0.841344746068542948...
        close(normal.quantile(0.841_344_746_068_542_9), 2.5);
        let positive = Distribution::LogNormal { median: 3.0, factor: 2.0, bounds: [0.0, f64::INFINITY] };
        close(positive.quantile(0.841_344_746_068_542_9), 6.0);
        let half = Distribution::Normal { mean: 0.0, deviation: 1.0, bounds: [0.0, f64::INFINITY] };
        close(half.quantile(2.0 * 0.841_344_746_068_542_9 - 1.0), 1.0);
        let far = Distribution::Normal { mean: 0.0, deviation: 1.0, bounds: [1.0, 2.0] };
        assert!(
            (1.0..=2.0).contains(&far.quantile(1e-16)) && (1.0..=2.0).contains(&far.quantile(1.0 - 1e-16))
        );
    }
}
