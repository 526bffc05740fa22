//! The wear integrals of a measured profile, whose waves and kinks no single rule sees.

use std::sync::Arc;

use crate::contact::indenter::{EquivalentProfile, RiseTransform};
use crate::error::Result;
use crate::numerics::roots;

/// Places looked at in each piece of the slip's series for the deepest wear; a piece holds less than a wave.
const PLACES: usize = 4;

/// Wear integrals of a table from the transform of what it rises by outside the edge of stick, `h = g0 - g0(c)`:
///
/// ```text
/// Δf = F(q_c - h) = φ ℓ^μ (q_c G_1 - ℓ H),     G_1 = F 1/(φ ℓ^μ),  H = F h/(φ ℓ^(1+μ)),  φ = sin(πν)/(πμ),  ℓ = ln(r²/c²)
/// ```
#[derive(Debug, Clone)]
pub(super) struct TableWear {
    transform: Arc<RiseTransform>,
    /// `q_c`, m.
    compression: f64,
    mu: f64,
}

impl TableWear {
    /// Of the edge of stick at `ln(a0/c)`; none where the profile is no table.
    pub(super) fn new(
        profile: &EquivalentProfile,
        contact_radius: f64,
        stick_logarithm: f64,
    ) -> Result<Option<Self>> {
        let transform = profile.rise_transform(contact_radius * (-stick_logarithm).exp())?;
        let compression = -profile.at(contact_radius).rise(-stick_logarithm);
        let mu = 0.5 * (1.0 - profile.grading());
        Ok(transform.map(|transform| Self { transform, compression, mu }))
    }

    /// `Δf/(φ ℓ^μ)`, m, from `G_1`.
    pub(super) fn mean_compression(&self, logarithm: f64, uniform: f64) -> f64 {
        self.compression * uniform - logarithm * self.transform.mean(logarithm)
    }

    /// Mean compression, m, that counts for the volume.
    pub(super) fn volume_mean(&self, logarithm: f64) -> f64 {
        self.transform.volume_mean(self.compression, logarithm)
    }

    /// `ℓ` where wear is deepest: there may be as many hollows as waves.
    ///
    /// # Arguments
    /// * `end` -- `ℓ` at the limiting contact radius
    /// * `uniform` -- `G_1` as a function of `ℓ`
    pub(super) fn deepest(&self, end: f64, uniform: impl Fn(f64) -> f64) -> Result<f64> {
        let series = self.transform.series(end)?;
        let depth = |l: f64| l.powf(self.mu) * (self.compression * uniform(l) - l * series.value(l));
        let pieces = series.edges().windows(2).filter(|pair| pair[0] < end);
        let places = pieces.flat_map(|pair| {
            let width = pair[1].min(end) - pair[0];
            (1..=PLACES).map(move |i| pair[0] + width * i as f64 / PLACES as f64)
        });
        let places: Vec<f64> = std::iter::once(0.0).chain(places).collect();
        let inner = 1..places.len() - 1;
        let depths: Vec<f64> = inner.clone().map(|i| depth(places[i])).collect();
        let best = inner.zip(&depths).max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(i, _)| i);
        // dF1/dℓ = φ μ (e^ℓ - 1)^(-ν)
        let slope = |l: f64| {
            let (mean, mean_slope) = series.value_and_derivative(l);
            let power = l.powf(self.mu);
            self.compression * self.mu * l.exp_m1().powf(self.mu - 1.0)
                - power * ((1.0 + self.mu) * mean + l * mean_slope)
        };
        let (low, high) =
            (places[best.saturating_sub(1)].max(f64::MIN_POSITIVE), places[(best + 1).min(places.len() - 1)]);
        if slope(low) > 0.0 && slope(high) < 0.0 {
            return roots::bracketed(slope, low, high, 0.0);
        }
        Ok(places[best])
    }
}
