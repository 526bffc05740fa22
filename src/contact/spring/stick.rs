//! The compression from which on springs stick.

use super::enclosing::{Circle, smallest_enclosing};
use super::{Shakedown, SpringCycle, steady_cycle};
use crate::laws::friction::FrictionLaw;
use crate::laws::path::{Path, PathPoint};
use crate::numerics::roots::bracketed;

/// Parts of the range of compressions tried from the top down where a rule for the edge of stick is missing.
const LEVELS: usize = 128;

/// Relative distance below the largest lift at which a spring is tried that lifts off.
const JUST_LIFTED: f64 = 1e-6;

/// Compression at the largest indentation, m, from which on a spring sticks for ever after frictional shakedown: `q_c` of a path.
///
/// A spring that is always loaded comes to rest if there is a place `a` from which it can bear every point of the path, and then it does
/// so from any start [Melan's theorem]. With the strength `S` of the law
///
/// ```text
/// q* = min over a of max over t of { S⁻¹(M |u_t - a|) + d_max - d_t }
/// ```
///
/// which for Coulomb's law is the smallest circle around circles of radius `(μ_f/M) (d_max - d_t)` about the points of the path. It is `M U/μ_f`
/// for a plain oscillation, `M max(U_x, U_y)/μ_f` for an ellipse wherever its centre is. To round-off.
///
/// Springs below the largest lift slip in general, but not where the path returns through the same lifts the way it came (as when
/// both oscillations have one frequency and are in phase, with `M U < μ_f d_1`): then `q*` is lower, possibly zero, and is searched for among
/// 128 levels and bisected with [`steady_cycle`]. It stays what its name says, the compression from which on every spring sticks: springs
/// of still smaller compression may stick as well.
///
/// With static and kinetic friction the start matters: a spring that never slipped is held by `μ_s`, wherever the path goes; one that slipped
/// once is held by `μ_k` until it reverses. There `q*` is what [`steady_cycle`] shows, searched for as above.
///
/// # Arguments
/// * `path` -- one period
/// * `law` -- friction of the spring
/// * `stiffness_ratio` -- `M`
///
/// ```
/// use fretwear::laws::friction::Coulomb;
/// use fretwear::laws::motion::{SampledPath, Tangential};
/// use fretwear::contact::spring::stick_compression;
///
/// let law = Coulomb { coefficient: 0.5 };
/// let path = SampledPath::new(&Tangential, 3.0, 1.0, 2).path;
/// assert_eq!(stick_compression(&path, &law, 1.0), 6.0); // M U/μ_f
/// ```
pub fn stick_compression(path: &Path, law: &dyn FrictionLaw, stiffness_ratio: f64) -> f64 {
    searched_stick_compression(path, law, stiffness_ratio, 0.0).0
}

/// [`stick_compression`] where springs below some compression have slipped before, and the substeps passed in the search for it.
///
/// # Arguments
/// * `slipped` -- that compression, m
pub fn searched_stick_compression(
    path: &Path,
    law: &dyn FrictionLaw,
    stiffness_ratio: f64,
    slipped: f64,
) -> (f64, usize) {
    let lifted = path.largest_lift();
    let shakedown = Shakedown::default();
    let mut trial =
        Trial { path, law, stiffness_ratio, shakedown, cycle: SpringCycle::default(), substeps: 0 };
    if law.remembers_slip() {
        let fresh = trial.observed(never_slips(path, law, stiffness_ratio, 1.0));
        if slipped <= fresh {
            return (fresh, trial.substeps);
        }
        trial.shakedown.slipped = true;
        let kept = trial.observed(never_slips(path, law, stiffness_ratio, 2.0));
        return (fresh.max(kept.min(slipped)), trial.substeps);
    }
    let loaded_always = match law.coefficient() {
        Some(coefficient) => {
            let factor = coefficient / stiffness_ratio;
            smallest_circle(path, |lift| factor * lift).radius / factor
        }
        None => load_dependent(path, law, stiffness_ratio, lifted),
    };
    let returns_as_it_came =
        lifted > 0.0 && loaded_always <= lifted * (1.0 + 1e-12) && !trial.slips(lifted * (1.0 - JUST_LIFTED));
    let found = if returns_as_it_came { trial.observed(lifted) } else { loaded_always };
    (found, trial.substeps)
}

/// The smallest circle around circles about the points, their radii from the lifts.
fn smallest_circle(path: &Path, radius: impl Fn(f64) -> f64) -> Circle {
    let circle = |point: &PathPoint| Circle { centre: point.tangential, radius: radius(point.lift) };
    smallest_enclosing(&path.points.iter().map(circle).collect::<Vec<_>>())
}

/// The circles of radius `S(q - lift)/M` about the points have one point in common at `q*`: their excess falls as `q` grows.
fn load_dependent(path: &Path, law: &dyn FrictionLaw, stiffness_ratio: f64, lifted: f64) -> f64 {
    if lifted == 0.0 {
        return law.compression_at(stiffness_ratio * smallest_circle(path, |_| 0.0).radius);
    }
    let excess = |compression: f64| {
        smallest_circle(path, |lift| -law.static_strength(compression - lift) / stiffness_ratio).radius
    };
    if excess(lifted) <= 0.0 {
        return lifted;
    }
    let high = never_slips(path, law, stiffness_ratio, 1.0) * (1.0 + 1e-9);
    bracketed(excess, lifted, high, 0.0).expect("the circles have the place of pressing on in common")
}

/// A compression, m, that bears so many times the whole path from where the spring was pressed on: twice, wherever it comes from.
fn never_slips(path: &Path, law: &dyn FrictionLaw, stiffness_ratio: f64, times: f64) -> f64 {
    let least = |point: &PathPoint| {
        let [x, y] = point.tangential;
        law.compression_at(times * stiffness_ratio * x.hypot(y)) + point.lift
    };
    path.points.iter().map(least).fold(0.0, f64::max)
}

/// Springs that are tried one after the other.
struct Trial<'a> {
    path: &'a Path,
    law: &'a dyn FrictionLaw,
    stiffness_ratio: f64,
    shakedown: Shakedown,
    cycle: SpringCycle,
    /// Passed so far.
    substeps: usize,
}

impl Trial<'_> {
    /// Whether a spring of this compression, m, slips in the end.
    fn slips(&mut self, compression: f64) -> bool {
        let Self { path, law, stiffness_ratio, shakedown, cycle, substeps } = self;
        steady_cycle(path, *law, *stiffness_ratio, compression, shakedown, cycle);
        *substeps += cycle.substeps;
        cycle.slip_path > 0.0
    }

    /// Largest compression, m, of a spring that slips in the end, as far as levels tell; `high` sticks.
    fn observed(&mut self, mut high: f64) -> f64 {
        let top = high;
        // Springs that are not compressed slip freely, which says nothing of those that are.
        for level in (1..LEVELS).rev() {
            let mut low = top * level as f64 / LEVELS as f64;
            if !self.slips(low) {
                high = low;
                continue;
            }
            while high - low > 2.0 * f64::EPSILON * high {
                let middle = 0.5 * (low + high);
                if self.slips(middle) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            return high;
        }
        0.0
    }
}
