//! What a run came to, in memory.

use std::f64::consts::PI;

use crate::contact::closed_form::LimitingShape;
use crate::contact::indenter::Indenter;
use crate::contact::stick_slip::{FrettingRegime, Regime};
use crate::data::{
    Checkpoint, LimitCurves, LimitDistance, RunHeader, Snapshot, StopReason, fretting_regimes,
};

/// Largest part of the normal force that tension within the contact may take without a word. Where wear is local it takes 2e-3 at most, next to one node.
const TENSION: f64 = 1e-2;

/// Part of the largest normal force of a run below which a contact is worn out, so that its pressure is round-off.
const LEAST_FORCE: f64 = 1e-3;

/// What a run came to: snapshots from its start to its end, the limiting shape, the estimated error. SI units throughout.
///
/// Series have one value for each snapshot, curves one row of them: their shapes are `(time,)` and `(time, node)`. The first snapshot is the
/// unworn contact, the last the end.
///
/// ```
/// # let scene: fretwear::Scene = include_str!("../../data/scenes/paraboloid.toml").parse()?;
/// let results = scene.simulate()?;
/// let (volume, depth) = (results.worn_volume(), results.wear_depth());
/// assert_eq!((volume.len(), depth[0].len()), (results.tau().len(), results.radius().len()));
/// assert!(volume.is_sorted() && results.accuracy_met() == Some(true));
/// # Ok::<(), fretwear::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Results {
    pub(super) header: RunHeader,
    pub(super) snapshots: Vec<Snapshot>,
    pub(super) checkpoint: Checkpoint,
    pub(super) stop_reason: StopReason,
    pub(super) last: Snapshot,
    pub(super) limit: Option<LimitingShape>,
    pub(super) distance: Option<LimitDistance>,
    pub(super) indenter: Indenter,
    /// Whether ground wears only where it is pressed.
    pub(super) wears_locally: bool,
}

/// Series: one number of each snapshot.
impl Results {
    fn series(&self, value: fn(&Snapshot) -> f64) -> Vec<f64> {
        self.snapshots.iter().map(value).collect()
    }

    /// Number of cycles, a real number, shape `(time,)`, increasing from 0.
    pub fn cycles(&self) -> Vec<f64> {
        self.series(|it| it.cycles)
    }

    /// Dimensionless time `τ`, shape `(time,)`, increasing from 0.
    pub fn tau(&self) -> Vec<f64> {
        self.series(|it| it.tau)
    }

    /// Worn volume, m³, shape `(time,)`.
    pub fn worn_volume(&self) -> Vec<f64> {
        self.series(|it| it.wear_volume)
    }

    /// Contact radius, m, shape `(time,)`.
    pub fn contact_radius(&self) -> Vec<f64> {
        self.series(|it| it.contact_radius)
    }

    /// Radius within which no spring slips in the cycle that is under way, m, shape `(time,)`; zero under gross slip.
    pub fn stick_radius(&self) -> Vec<f64> {
        self.series(|it| it.stick_radius)
    }

    /// Radius within which no spring has slipped so far, m, shape `(time,)`.
    pub fn permanent_stick_radius(&self) -> Vec<f64> {
        self.series(|it| it.permanent_stick_radius)
    }

    /// Largest indentation of the run, m, shape `(time,)`.
    pub fn indentation(&self) -> Vec<f64> {
        self.series(|it| it.indentation)
    }

    /// Normal force at that indentation, N, shape `(time,)`.
    pub fn normal_force(&self) -> Vec<f64> {
        self.series(|it| it.normal_force)
    }

    /// Largest tangential force along the fretting loop, N, shape `(time,)`.
    pub fn tangential_force(&self) -> Vec<f64> {
        self.series(|it| it.tangential_force)
    }

    /// Energy ratio `A = W/(4 Q* δ*)` of the fretting loop, shape `(time,)`.
    pub fn energy_ratio(&self) -> Vec<f64> {
        self.series(|it| it.energy_ratio)
    }

    /// Sliding ratio of the fretting loop, its width at no force over the stroke, shape `(time,)`.
    pub fn sliding_ratio(&self) -> Vec<f64> {
        self.series(|it| it.sliding_ratio)
    }

    /// Energy dissipated by friction since the start, J, shape `(time,)`.
    pub fn dissipated_energy(&self) -> Vec<f64> {
        self.series(|it| it.dissipated_energy)
    }

    /// Energy dissipated by friction in one cycle, J, shape `(time,)`.
    pub fn cycle_energy(&self) -> Vec<f64> {
        self.series(|it| it.cycle_energy)
    }

    /// What the oscillation does to the contact, shape `(time,)`.
    pub fn regime(&self) -> Vec<Regime> {
        self.snapshots.iter().map(|it| it.regime).collect()
    }

    /// Fretting regime of the run so far, shape `(time,)`.
    pub fn fretting_regime(&self) -> Vec<FrettingRegime> {
        fretting_regimes(&self.snapshots)
    }
}

/// Curves: one row of each snapshot.
impl Results {
    fn curves(&self, values: fn(&Snapshot) -> &[f64]) -> Vec<&[f64]> {
        self.snapshots.iter().map(values).collect()
    }

    /// Radius of the nodes, m, shape `(node,)`, increasing.
    pub fn radius(&self) -> &[f64] {
        &self.header.radius
    }

    /// Worn profile, m, shape `(time, node)`.
    pub fn profile(&self) -> Vec<&[f64]> {
        self.curves(|it| &it.profile)
    }

    /// Wear depth, m, shape `(time, node)`.
    pub fn wear_depth(&self) -> Vec<&[f64]> {
        self.curves(|it| &it.wear_depth)
    }

    /// Contact pressure, Pa, shape `(time, node)`; not a number where the ground has come to stick, which holds no pressure of its own.
    pub fn pressure(&self) -> Vec<&[f64]> {
        self.curves(|it| &it.pressure)
    }

    /// Slip amplitude, m, shape `(time, node)`.
    pub fn slip(&self) -> Vec<&[f64]> {
        self.curves(|it| &it.slip)
    }

    /// Tangential displacement along one period, m, shape `(time, point)`; the last point is the first.
    pub fn loop_displacement(&self) -> Vec<&[f64]> {
        self.curves(|it| &it.loop_displacement)
    }

    /// Tangential force along one period, N, shape `(time, point)`.
    pub fn loop_force(&self) -> Vec<&[f64]> {
        self.curves(|it| &it.loop_force)
    }

    /// Displacement across the main direction, m, shape `(time, point)`; rows are empty where the indenter stays on the x axis.
    pub fn loop_displacement_y(&self) -> Vec<&[f64]> {
        self.curves(|it| &it.loop_displacement_y)
    }

    /// Force across the main direction, N, shape `(time, point)`, as the displacement.
    pub fn loop_force_y(&self) -> Vec<&[f64]> {
        self.curves(|it| &it.loop_force_y)
    }
}

/// The run as a whole.
impl Results {
    /// The scene, as its TOML text.
    pub fn scene(&self) -> &str {
        &self.header.scene
    }

    /// All snapshots, in the order of time.
    pub fn snapshots(&self) -> &[Snapshot] {
        &self.snapshots
    }

    /// The contact where the run ended or was stopped, which need not be a snapshot.
    pub fn last(&self) -> &Snapshot {
        &self.last
    }

    /// Why the run stopped.
    pub fn stop_reason(&self) -> StopReason {
        self.stop_reason
    }

    /// Whether it reached its end, and was not stopped before.
    pub fn is_complete(&self) -> bool {
        self.stop_reason != StopReason::Interrupted
    }

    /// The limiting shape, where there is a closed form.
    pub fn limit(&self) -> Option<&LimitingShape> {
        self.limit.as_ref()
    }

    /// Limiting profile and wear depth on the nodes, m, shape `(node,)` each, where there is a closed form.
    pub fn limit_curves(&self) -> Option<&LimitCurves> {
        self.header.limit.as_ref()
    }

    /// Distance of the last profile from the limit.
    pub fn distance(&self) -> Option<LimitDistance> {
        self.distance
    }

    /// The unworn indenter.
    pub fn indenter(&self) -> &Indenter {
        &self.indenter
    }

    /// Estimated error of worn volume and profile, relative to those of the limit, or to the largest of the run where there is no limit.
    pub fn error_estimate(&self) -> Option<f64> {
        self.checkpoint.error_estimate
    }

    /// Whether the error is as small as was asked for; none where springs were given by hand.
    pub fn accuracy_met(&self) -> Option<bool> {
        self.checkpoint.accuracy_met()
    }

    /// Number of springs over the slip annulus.
    pub fn springs(&self) -> usize {
        self.checkpoint.state.compression.len() + 1
    }

    /// Steps accepted.
    pub fn steps(&self) -> u64 {
        self.checkpoint.progress.steps
    }

    /// Wall time used, s.
    pub fn wall_seconds(&self) -> f64 {
        self.checkpoint.wall_seconds
    }

    /// What a run that goes on from here needs.
    pub fn checkpoint(&self) -> &Checkpoint {
        &self.checkpoint
    }

    /// What deserves a word: an end that is less accurate than was asked for, and tension within the contact.
    pub fn warnings(&self) -> Vec<String> {
        [self.inaccuracy(), self.pulls()].into_iter().flatten().collect()
    }

    /// Part of the normal force, or of [`LEAST_FORCE`] of the largest of the run, N, that tension within the contact takes.
    ///
    /// ```text
    /// ∫ max(-p, 0) 2π r dr / F
    /// ```
    fn tension(&self, snapshot: &Snapshot, largest: f64) -> f64 {
        let radii = self.radius();
        let pulled = |i: usize| (-snapshot.pressure[i]).max(0.0) * radii[i];
        let rings = (1..radii.len()).map(|i| PI * (pulled(i - 1) + pulled(i)) * (radii[i] - radii[i - 1]));
        rings.sum::<f64>() / snapshot.normal_force.max(LEAST_FORCE * largest)
    }

    /// A word where springs pull: debris has worn the ground away from under the pressure, or they do not resolve it.
    fn pulls(&self) -> Option<String> {
        let seen = || self.snapshots.iter().chain([&self.last]);
        let largest = seen().map(|it| it.normal_force).fold(0.0, f64::max);
        let pulling: Vec<(f64, f64)> = seen()
            .map(|it| (it.tau, self.tension(it, largest)))
            .filter(|(_, part)| *part > TENSION)
            .collect();
        let (first, _) = *pulling.first()?;
        let (at, most) = *pulling.iter().max_by(|one, other| one.1.total_cmp(&other.1))?;
        let seen = format!(
            "from τ = {first:.3e} on springs within the contact pull, at τ = {at:.3e} with {:.0} % of the normal force",
            100.0 * most
        );
        let why = if self.wears_locally {
            "though no law that is local wears ground until it does: pressure is not resolved there, and swings about what it is. Worn volume and depth are as good as the estimated error; for the pressure \
             compare with more springs by hand (numerics.springs)"
                .to_owned()
        } else {
            format!(
                "for debris has worn the ground away from under the pressure. Such ground would lose touch, which is not modelled: it wears as if it adhered. End before \
                 (loading.tau = {first:.3e}), or take a law of wear that is local"
            )
        };
        Some(format!("{seen}, {why}"))
    }

    /// A word about an end that is less accurate than was asked for.
    fn inaccuracy(&self) -> Option<String> {
        let accuracy = self.checkpoint.accuracy?;
        let error = self.checkpoint.error_estimate.filter(|error| *error > accuracy)?;
        let springs = self.springs();
        Some(format!(
            "numerics.accuracy = {accuracy:e} was asked for, and the estimated error is {error:.1e} of the worn volume or of the largest depth; \
             rely on no more digits than that, ask for numerics.accuracy = {:.0e}, or compare with runs of more springs by hand \
             (numerics.springs; there were {springs})",
            rounded_up(error)
        ))
    }
}

/// To one digit, not below the number.
fn rounded_up(error: f64) -> f64 {
    let unit = 10f64.powf(error.log10().floor());
    (error / unit).ceil() * unit
}
