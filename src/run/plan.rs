//! When snapshots are taken and when a run stops.

use crate::error::Result;
use crate::laws::loading::{self, cycles_at, has_come};
use crate::scene::Output;
use crate::solver::simulation::{End, Plan};

/// Part of the run at which the first of geometrically spread snapshots is taken.
const FIRST_SNAPSHOT: f64 = 1e-4;

/// Dimensionless times between which snapshots are spread where the end is not known beforehand.
const UNKNOWN_END: [f64; 2] = [1e-2, 1e3];

/// The plan of a scene; whole cycles where the stepper knows no others.
pub(super) fn plan(
    duration: loading::Duration,
    output: &Output,
    tau_per_cycle: f64,
    whole: bool,
) -> Result<Plan> {
    let round = |cycles: f64| if whole { cycles.round().max(1.0) } else { cycles };
    let end = match (duration.span(tau_per_cycle)?, duration) {
        (None, loading::Duration::UntilRate(fraction)) => End::Rate(fraction),
        (span, _) => End::Cycles(round(span.map_or(0.0, |[cycles, _]| cycles))),
    };
    let mut outputs: Vec<f64> = match (output, end) {
        (Output::Snapshots(count), End::Cycles(last)) => geometric(FIRST_SNAPSHOT * last, last, *count),
        (Output::Snapshots(count), End::Rate(_)) => {
            let [first, last] = UNKNOWN_END.map(|tau| tau / tau_per_cycle);
            geometric(first, last, *count)
        }
        (Output::AtCycles(cycles), _) => cycles.clone(),
        (Output::AtTau(taus), _) => taus.iter().map(|tau| cycles_at(*tau, tau_per_cycle)).collect(),
    };
    if let End::Cycles(last) = end {
        outputs.retain(|cycles| !has_come(last, *cycles));
        outputs.push(last);
    }
    let within = |cycles: &f64| *cycles > 0.0 && cycles.is_finite();
    let mut outputs: Vec<f64> = outputs.into_iter().filter(within).map(round).collect();
    outputs.dedup_by(|next, kept| has_come(*next, *kept));
    Ok(Plan { outputs, end })
}

/// `count` numbers of cycles in constant ratio, the last of them `last`.
fn geometric(first: f64, last: f64, count: usize) -> Vec<f64> {
    let ratio = (last / first).ln() / (count.max(2) - 1) as f64;
    (0..count).map(|i| last * (-ratio * (count - 1 - i) as f64).exp()).collect()
}
