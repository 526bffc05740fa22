//! What resists the slip of springs.
//!
//! Ground that a receding edge of stick passes wears within a layer that gets thinner as the edge comes to rest, in the end thinner than the first cell. In a medium whose modulus
//! falls with depth, `k < 0`, the compressions `q` of the springs next to the edge then swing about what they are. Under Coulomb's law slip follows from the slip depth, which does not
//! swing; a law that is not linear in `q` feeds the swings until no step leads on. Over the first springs it is replaced by the straight line through the edge of stick and the first
//! spring beyond, which has the compressions before and behind the layer right:
//!
//! ```text
//! R = μ_f(q_c) q_c + s (q - q_c),     s = (μ_f(q_c) q_c - μ_f(q_m) q_m)/(q_c - q_m)
//! ```
//!
//! and passes into the law itself smoothly. What the line is off by counts over the first cells alone, less with each spring more.

use super::schedule::CycleLoading;
use super::{Fields, Model};
use crate::laws::friction::FrictionLaw;

/// Springs from the edge of stick on over which the law is a straight line, and those at which it is the law itself. With 4 of 72 springs and without a smooth passage some scenes at
/// k = -0.5 found no step, with 24 the worn volume was off by 1e-3 on 100 springs.
const STRAIGHT: usize = 4;
const OWN: usize = 12;

/// Compression, over that at the edge of stick, below which what falls with a small power of it is in proportion to it: springs whose wear does so come to zero in a finite time, and
/// swing about it with no end. With 1e-4 and 1e-3 worn volumes are the same within 6e-5.
const LEAST: f64 = 3e-4;

/// Grading below which the law is left as it is: of scenes under friction by a power of 2.3 of the load one at -0.967 found no step on the line. It is measured down to -0.7.
const SOFTEST: f64 = -0.9;

/// Least fall of the compression, over that at the edge of stick, by which the line is drawn.
const LEAST_FALL: f64 = 1e-6;

/// Whether a law of friction is a straight line next to an edge of stick that recedes.
pub fn straightens(law: &dyn FrictionLaw, grading: f64) -> bool {
    (SOFTEST..0.0).contains(&grading) && law.coefficient().is_none() && !law.remembers_slip()
}

/// What resists slip in a cycle without lifts, over the normal stiffness of a spring, m.
pub(super) struct Resistance<'a> {
    law: &'a dyn FrictionLaw,
    /// Whether springs that pull resist by the odd function of their compression.
    odd: bool,
    /// See [`strength`].
    least: f64,
    line: Option<Line>,
}

/// `R = strength + slope (q - compression)`.
struct Line {
    compression: f64,
    strength: f64,
    slope: f64,
    /// The spring behind the layer.
    behind: usize,
}

impl Resistance<'_> {
    /// By the law itself.
    fn own(&self, compression: f64) -> f64 {
        let strength = |compression: f64| strength(self.law, self.least, compression);
        if self.odd { strength(compression.abs()).copysign(compression) } else { strength(compression) }
    }

    /// Of a spring of a compression after all lifts, m.
    pub fn of(&self, spring: usize, compression: f64) -> f64 {
        let own = self.own(compression);
        match &self.line {
            Some(line) if spring < line.behind => {
                let straight = line.strength + line.slope * (compression - line.compression);
                let part = spring.saturating_sub(STRAIGHT) as f64 / (line.behind - STRAIGHT) as f64;
                straight + part * part * (3.0 - 2.0 * part) * (own - straight)
            }
            _ => own,
        }
    }

    /// Whether it is more or less a straight line at a spring.
    pub fn is_straight(&self, spring: usize) -> bool {
        self.behind().is_some_and(|behind| spring < behind)
    }

    /// The spring by whose compression the line is drawn, if there is one.
    pub fn behind(&self) -> Option<usize> {
        self.line.as_ref().map(|line| line.behind)
    }
}

/// Strength of friction of a compression, m, in proportion to it from zero to the least, m; none where that is zero.
pub(super) fn strength(law: &dyn FrictionLaw, least: f64, compression: f64) -> f64 {
    if (0.0..least).contains(&compression) {
        law.kinetic_strength(least) * compression / least
    } else {
        law.kinetic_strength(compression)
    }
}

impl Model {
    /// Compression, m, below which strength is in proportion to it, see [`strength`]: none in gross slip, where all of them fall as the contact grows.
    pub(super) fn least_compression(&self, law: &dyn FrictionLaw) -> f64 {
        if law.coefficient().is_some() || self.gross().is_some() {
            return 0.0;
        }
        let least = LEAST * self.contact.slip_compression();
        let falls_slowly = law.kinetic_strength_slope(least) * least < law.kinetic_strength(least);
        if falls_slowly { least } else { 0.0 }
    }

    /// What resists the slip of springs.
    ///
    /// Next to an edge of stick in a medium whose modulus falls with depth compressions swing about zero as they do in the balance of normal forces: a spring that is never lifted resists
    /// by the odd function of its compression there, so that swings cancel and the balance of tangential forces has no kink. Elsewhere a spring that pulls resists nothing.
    ///
    /// # Arguments
    /// * `lifted` -- compressions after all lifts, m, shape `(springs - 1,)`
    pub(super) fn resistance<'a>(
        &self,
        loading: &'a CycleLoading,
        lifted: &[f64],
        fields: &Fields,
    ) -> Resistance<'a> {
        let (law, grading) = (&*loading.friction, self.contact.half_space().grading());
        let odd = loading.lift == 0.0 && grading < 0.0;
        let recedes = || self.moving().is_some_and(|moving| moving.recedes());
        if !straightens(law, grading) || !recedes() || !self.slips_from_edge(loading, fields) {
            return Resistance { law, odd, least: 0.0, line: None };
        }
        let edge = fields.stick_zone.slip_compression;
        let behind = OWN.min(lifted.len() - 1);
        let outer = lifted[behind].clamp(0.0, edge * (1.0 - LEAST_FALL));
        let strength = law.kinetic_strength(edge);
        let slope = (strength - law.kinetic_strength(outer)) / (edge - outer);
        let line = Line { compression: edge, strength, slope, behind };
        Resistance { law, odd, least: self.least_compression(law), line: Some(line) }
    }
}
