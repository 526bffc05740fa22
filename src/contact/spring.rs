//! One tangential spring through the period of a path: where it slips, how hard it is held and what that costs.
//!
//! The spring carries the elastic deflection `e`, its force over its normal stiffness is `M e`, and it is held while `M |e|` stays below
//! its strength. Within a substep the indenter moves straight and at one speed, compression and limit of the deflection are linear. On such
//! a path the deflection is exact for any number of substeps, in one and in two directions:
//!
//! ```text
//! stick   e' = u'
//! slip    |e| = l,  s' = λ e/l,  e' = u' - s'    λ = u'·e/l - l' >= 0, and λ grows while the path is straight
//! ```
//!
//! Slip along a line is exact too. Where slip turns within a substep, what is recorded is its chord, and the energy is that of the mean force
//! along it: second order, and still in balance with the work to round-off.
//!
//! The exponent of a load-dependent law makes the limit curved in the compression; taken as linear between the corners it is second order.

mod enclosing;
mod neighbours;
mod response;
mod steps;
mod stick;
mod turns;

use std::ops::ControlFlow;

pub use neighbours::Neighbours;
pub use response::Response;
pub use steps::{PassedSteps, Steps};
pub use stick::{searched_stick_compression, stick_compression};

use crate::laws::friction::FrictionLaw;
use crate::laws::path::Path;

/// Onsets of slip within one substep: a spring with a static coefficient can slip, stick again and slip the other way, once.
const MAX_ONSETS: usize = 4;

/// Change of the deflection over a period, over the limit of the deflection, below which the spring has become periodic: what a period of
/// some hundred substeps loses to round-off.
const PERIODIC: f64 = 1e-13;

/// Round-off of one substep, over displacement and limit of deflection.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;

/// Periods passed before every other one is followed by a step of Newton's method.
const PLAIN_PERIODS: usize = 4;

/// Change of the deflection over a period, over a jump from the static to the kinetic limit, below which a spring that jumps nearly repeats itself.
const NEARLY: f64 = 0.01;

/// Most periods after which a spring that jumps is seen to repeat itself: what it does in one period may alternate with what it does in the next.
const MOST_ALTERNATING: usize = 32;

/// Change of the deflection, over its limit, by which the slopes of a period are found.
const DIFFERENCE: f64 = 1e-6;

/// Determinant of Newton's equations below which a period says too little.
const SINGULAR: f64 = 1e-10;

/// Deflection that Newton's method may find, over the limit onto which it is then put back.
const FARTHEST: f64 = 1.5;

/// When a spring counts as shaken down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shakedown {
    /// Periods after which it is taken as it is.
    pub max_periods: usize,
    /// Slip per period, over the length of the path while the spring is loaded, below which it sticks.
    pub threshold: f64,
    /// Whether it has slipped before, so that the kinetic limit holds it until it reverses; else it was pressed on at rest.
    pub slipped: bool,
    /// Whether it is known to slip for ever, as below the [`stick_compression`], so that Newton's method may find what it repeats. On its way to rest it must take all of that way.
    pub slips: bool,
}

impl Default for Shakedown {
    /// 1000 periods, `1e-9`, of a spring that is pressed on and may come to rest.
    fn default() -> Self {
        Self { max_periods: 1000, threshold: 1e-9, slipped: false, slips: false }
    }
}

/// One period of one spring, all per unit of its normal stiffness.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SpringCycle {
    /// Slip in each substep, m, shape `(substep,)`; zero while the spring is lifted.
    pub slip: Vec<[f64; 2]>,
    /// Elastic deflection at the end of each substep, m, shape `(substep,)`; times the tangential stiffness it is the force.
    pub deflection: Vec<[f64; 2]>,
    /// Length of the slip path, m.
    pub slip_path: f64,
    /// Work of the kinetic friction, m².
    pub dissipation: f64,
    /// What jumps from the static to the kinetic limit lose beyond it, `(μ_s - μ_k)² q²/(2 M)` each, m².
    pub jump_loss: f64,
    /// Work of the tangential displacement of the indenter, m²: dissipation and loss of jumps in a period that repeats itself.
    pub work: f64,
    /// Periods passed before the one that is recorded.
    pub periods: usize,
    /// Periods after which the spring repeats itself; slip, deflection and energies are the mean of so many.
    pub alternates: usize,
    /// Substeps passed until then, those of the one recorded and of the search for it included.
    pub substeps: usize,
    /// Limit of the deflection while slipping, at each corner, m.
    limit: Vec<f64>,
}

impl SpringCycle {
    fn clear(&mut self) {
        self.slip.clear();
        self.deflection.clear();
        (self.slip_path, self.dissipation, self.jump_loss, self.work) = (0.0, 0.0, 0.0, 0.0);
    }

    /// Adds a part of another cycle, of as many substeps.
    fn add(&mut self, part: f64, other: &Self) {
        for (own, others) in [(&mut self.slip, &other.slip), (&mut self.deflection, &other.deflection)] {
            own.resize(others.len(), [0.0; 2]);
            own.iter_mut().zip(others).for_each(|(own, value)| *own = sum(*own, scaled(part, *value)));
        }
        self.dissipation += part * other.dissipation;
        self.jump_loss += part * other.jump_loss;
        self.work += part * other.work;
    }

    /// Adds a substep; energies still over the tangential stiffness.
    fn push(&mut self, deflection: [f64; 2], passed: &Passed) {
        self.slip.push(passed.slip);
        self.deflection.push(deflection);
        self.dissipation += passed.dissipation;
        self.jump_loss += passed.jump_loss;
        self.work += passed.work;
    }

    /// A spring that slips by less than the threshold sticks.
    fn finish(&mut self, stiffness_ratio: f64, slip_path: f64, negligible: f64) {
        if slip_path <= negligible {
            self.slip.fill([0.0; 2]);
            (self.slip_path, self.dissipation, self.jump_loss, self.work) = (0.0, 0.0, 0.0, 0.0);
        } else {
            self.slip_path = slip_path;
            self.dissipation *= stiffness_ratio;
            self.jump_loss *= stiffness_ratio;
            self.work *= stiffness_ratio;
        }
    }
}

/// The periodic motion of a spring that was pressed on at `u = 0` with the indentation of the first point, and moved straight there.
///
/// The spring is loaded where its compression is not negative; one of compression zero at constant indentation slips all the way. On a path
/// along x it repeats itself after one period (with a static coefficient, nearly always); else periods pass until its deflection
/// repeats to `1e-13` of its limit, or until it sticks.
///
/// # Arguments
/// * `path` -- one period, `n` points and as many substeps
/// * `law` -- friction of the spring
/// * `stiffness_ratio` -- `M`
/// * `compression` -- at the largest indentation, m
/// * `shakedown` -- when to stop
/// * `out` -- overwritten; its memory is used again
///
/// ```
/// use fretwear::laws::friction::Coulomb;
/// use fretwear::laws::motion::{SampledPath, Tangential};
/// use fretwear::contact::spring::{Shakedown, SpringCycle, steady_cycle};
///
/// let path = SampledPath::new(&Tangential, 3.0, 1.0, 2).path;
/// let law = Coulomb { coefficient: 0.5 };
/// let mut cycle = SpringCycle::default();
/// steady_cycle(&path, &law, 1.0, 4.0, &Shakedown::default(), &mut cycle);
/// assert_eq!(cycle.slip_path, 4.0 * (3.0 - 0.5 * 4.0)); // 4 (U - μ_f q/M)
/// assert_eq!(cycle.dissipation, 0.5 * 4.0 * cycle.slip_path);
/// ```
pub fn steady_cycle(
    path: &Path,
    law: &dyn FrictionLaw,
    stiffness_ratio: f64,
    compression: f64,
    shakedown: &Shakedown,
    out: &mut SpringCycle,
) {
    let mut reach = 0.0_f64;
    let mut straight = true;
    let mut last_lift = f64::NAN;
    let mut limit = 0.0;
    out.limit.clear();
    for point in &path.points {
        let [x, y] = point.tangential;
        reach = reach.max(x.abs()).max(y.abs());
        straight &= y == 0.0;
        if point.lift != last_lift {
            last_lift = point.lift;
            limit = law.kinetic_strength(compression - last_lift) / stiffness_ratio;
        }
        out.limit.push(limit);
    }
    let largest_limit = law.kinetic_strength(compression) / stiffness_ratio;
    let round_off = ROUND_OFF * (reach + largest_limit) * path.points.len() as f64;
    let negligible = |loaded: f64| shakedown.threshold * loaded + round_off;

    let static_factor = law.static_factor();
    if straight && static_factor == 1.0 {
        let first = if compression >= path.points[0].lift {
            path.points[0].tangential[0].clamp(-out.limit[0], out.limit[0])
        } else {
            0.0
        };
        let count = path.points.len();
        out.slip.resize(count, [0.0; 2]);
        out.deflection.resize(count, [0.0; 2]);
        let (slip, deflections) = (&mut out.slip[..count], &mut out.deflection[..count]);
        let (start, _) = straight_period(path, &out.limit, compression, first, |_, _, _| {});
        let (mut slip_path, mut dissipation, mut work) = (0.0, 0.0, 0.0);
        let (_, loaded) =
            straight_period(path, &out.limit, compression, start, |substep, deflection, passed| {
                slip[substep] = passed.slip;
                deflections[substep] = [deflection, 0.0];
                slip_path += passed.slip[0].abs();
                dissipation += passed.dissipation;
                work += passed.work;
            });
        (out.dissipation, out.work, out.jump_loss) = (dissipation, work, 0.0);
        (out.periods, out.substeps, out.alternates) = (1, 2 * count, 1);
        out.finish(stiffness_ratio, slip_path, negligible(loaded));
        return;
    }

    let mut spring = Spring::default();
    if compression >= path.points[0].lift {
        let limits = [out.limit[0]; 2];
        spring.pass(path.points[0].tangential, limits, static_factor);
    }
    let limits = std::mem::take(&mut out.limit);
    let count = path.points.len();
    (out.periods, out.substeps, out.alternates) = (0, 0, 1);
    if shakedown.slipped {
        out.clear();
        general_period(path, &limits, count, compression, &mut spring, 1.0, out);
    }
    let mut last_change = f64::INFINITY;
    let (mut found_at, mut strays) = (None, false);
    let mut ends = Ends::default();
    loop {
        let before = spring;
        out.clear();
        let (slip_path, loaded) =
            general_period(path, &limits, count, compression, &mut spring, static_factor, out);
        let step = difference(spring.deflection, before.deflection);
        let change = length(step);
        let repeats =
            change <= PERIODIC * largest_limit && (static_factor == 1.0 || spring.sliding == before.sliding);
        let small = negligible(loaded);
        if repeats || slip_path <= small || out.periods >= shakedown.max_periods {
            out.finish(stiffness_ratio, slip_path, small);
            break;
        }
        out.periods += 1;
        if static_factor != 1.0 {
            if let Some(periods) = ends.since(&spring, PERIODIC * largest_limit) {
                let (slip_path, loaded) = mean_of(periods, out, |out| {
                    general_period(path, &limits, count, compression, &mut spring, static_factor, out)
                });
                out.finish(stiffness_ratio, slip_path, negligible(loaded));
                out.alternates = periods;
                break;
            }
            ends.push(spring);
        }
        // Where the path is a smooth map of the deflection onto the one a period later, Newton's method finds what repeats itself; from
        // any other deflection the spring comes to rest at the same.
        let waits = out.periods < PLAIN_PERIODS || !out.periods.is_multiple_of(2);
        if found_at.take().is_some_and(|before| change >= before) {
            // A jump that comes and goes from one deflection to the next: only periods tell.
            strays = static_factor != 1.0;
        }
        // A spring that lets go jumps, so that none is on its way to rest which jumps by far more than it is off.
        let nearly = NEARLY * (static_factor - 1.0) * largest_limit;
        let jumps = spring.sliding == before.sliding && change <= nearly && out.jump_loss > 0.0;
        let may_be_found = if static_factor == 1.0 { shakedown.slips } else { jumps && !strays };
        if waits || !may_be_found || change > 2.0 * last_change {
            last_change = change;
            continue;
        }
        last_change = change;
        let mut after = |deflection: [f64; 2]| {
            let mut moved = Spring { deflection, ..before };
            general_period(path, &limits, count, compression, &mut moved, static_factor, out);
            moved.deflection
        };
        if let Some(found) = newton(before.deflection, spring.deflection, limits[0], &mut after)
            && (!jumps || length(difference(found, spring.deflection)) <= nearly)
        {
            spring.deflection = found;
            found_at = Some(change);
            ends = Ends::default();
        }
    }
    out.limit = limits;
}

/// How a spring that jumps ended the last periods.
#[derive(Default)]
struct Ends {
    /// The last is at `count - 1`, modulo as many as there are.
    springs: [Spring; MOST_ALTERNATING],
    count: usize,
}

impl Ends {
    fn push(&mut self, spring: Spring) {
        self.springs[self.count % MOST_ALTERNATING] = spring;
        self.count += 1;
    }

    /// How many periods ago it ended one like this, to `within` in its deflection, m.
    fn since(&self, spring: &Spring, within: f64) -> Option<usize> {
        (2..=self.count.min(MOST_ALTERNATING)).find(|periods| {
            let before = &self.springs[(self.count - periods) % MOST_ALTERNATING];
            before.sliding == spring.sliding
                && length(difference(before.deflection, spring.deflection)) <= within
        })
    }
}

/// The mean of some periods that follow one another: lengths of the slip and of the path while loaded, m.
fn mean_of(
    periods: usize,
    out: &mut SpringCycle,
    mut pass: impl FnMut(&mut SpringCycle) -> (f64, f64),
) -> (f64, f64) {
    let part = (periods as f64).recip();
    let mut mean = SpringCycle::default();
    let (mut slip_path, mut loaded) = (0.0, 0.0);
    for _ in 0..periods {
        out.clear();
        let (slipped, moved) = pass(out);
        (slip_path, loaded) = (slip_path + part * slipped, loaded + part * moved);
        mean.add(part, out);
    }
    out.clear();
    out.add(1.0, &mean);
    (slip_path, loaded)
}

/// [`steady_cycle`] of a spring in a contact of which those below some compression have slipped before: where it sticks from rest, it may go on to slip.
///
/// # Arguments
/// * `slipped` -- compression, m, below which springs have slipped before
pub fn settled_cycle(
    path: &Path,
    law: &dyn FrictionLaw,
    stiffness_ratio: f64,
    [compression, slipped]: [f64; 2],
    shakedown: &Shakedown,
    out: &mut SpringCycle,
) {
    steady_cycle(path, law, stiffness_ratio, compression, shakedown, out);
    if law.remembers_slip() && out.slip_path == 0.0 && compression < slipped {
        let from_rest = out.substeps;
        let shakedown = Shakedown { slipped: true, ..*shakedown };
        steady_cycle(path, law, stiffness_ratio, compression, &shakedown, out);
        out.substeps += from_rest;
    }
}

/// The deflection that a period repeats, by one step of Newton's method; `None` where a period hardly changes it or it is none of the spring.
fn newton(
    start: [f64; 2],
    end: [f64; 2],
    limit: f64,
    after: &mut impl FnMut([f64; 2]) -> [f64; 2],
) -> Option<[f64; 2]> {
    let nearby = |axis: usize| {
        // Inwards, where the spring may be.
        let difference = -(DIFFERENCE * limit).copysign(start[axis]);
        let mut moved = start;
        moved[axis] += difference;
        (moved, difference)
    };
    let slopes = [0, 1].map(|axis| {
        let (moved, change) = nearby(axis);
        scaled(change.recip(), difference(after(moved), end))
    });
    // (1 - P') δ = P - e
    let [a, c] = [1.0 - slopes[0][0], -slopes[0][1]];
    let [b, d] = [-slopes[1][0], 1.0 - slopes[1][1]];
    let determinant = a * d - b * c;
    let step = difference(end, start);
    let change = [(d * step[0] - b * step[1]) / determinant, (a * step[1] - c * step[0]) / determinant];
    let found = sum(start, change);
    // A spring that slips when the period begins is on its limit.
    let size = length(found);
    let usable = determinant.abs() > SINGULAR && size <= FARTHEST * limit;
    usable.then(|| if size > limit { scaled(limit / size, found) } else { found })
}

/// The part of a substep in which a spring is loaded.
struct Part {
    /// How much of the substep it is.
    fraction: f64,
    /// Limits of the deflection while slipping, m, at its ends; linear between.
    limits: [f64; 2],
}

/// A spring touches at the start of the part that is loaded, with limit zero, or lifts off at the end of it. Elastic deflection is zero there.
///
/// Continues with the loaded part, breaks if there is none.
#[inline]
fn loaded_part(compressions: [f64; 2], limits: [f64; 2]) -> ControlFlow<(), Part> {
    let [before, after] = compressions;
    ControlFlow::Continue(match (before >= 0.0, after >= 0.0) {
        (true, true) => Part { fraction: 1.0, limits },
        (false, true) => Part { fraction: after / (after - before), limits: [0.0, limits[1]] },
        (true, false) => Part { fraction: before / (before - after), limits: [limits[0], 0.0] },
        (false, false) => return ControlFlow::Break(()),
    })
}

/// What a substep did, energies over the tangential stiffness.
#[derive(Default)]
struct Passed {
    slip: [f64; 2],
    dissipation: f64,
    jump_loss: f64,
    work: f64,
}

/// One period along x with one coefficient: deflection at its end and length of the path while loaded, m.
///
/// The deflection after a substep is the one before, moved and clamped between its limits. The path is closed, so a period as a whole is
/// one clamp, and a second period repeats the first.
#[inline]
fn straight_period(
    path: &Path,
    limits: &[f64],
    compression: f64,
    mut deflection: f64,
    mut record: impl FnMut(usize, f64, &Passed),
) -> (f64, f64) {
    let mut loaded = 0.0;
    let count = path.points.len();
    let limits = &limits[..count];
    let place = |i: usize| {
        let point = &path.points[i];
        (point.tangential[0], compression - point.lift, limits[i])
    };
    let mut from = place(0);
    for substep in 0..count {
        let to = place(if substep + 1 < count { substep + 1 } else { 0 });
        match loaded_part([from.1, to.1], [from.2, to.2]) {
            ControlFlow::Continue(part) => {
                let moved = part.fraction * (to.0 - from.0);
                loaded += moved.abs();
                let passed;
                (deflection, passed) = straight_substep(deflection, moved, part.limits);
                record(substep, deflection, &passed);
            }
            ControlFlow::Break(()) => {
                deflection = 0.0;
                record(substep, 0.0, &Passed::default());
            }
        }
        from = to;
    }
    (deflection, loaded)
}

#[inline]
fn straight_substep(deflection: f64, moved: f64, limits: [f64; 2]) -> (f64, Passed) {
    let trial = deflection + moved;
    if trial.abs() <= limits[1] {
        let work = 0.5 * (deflection + trial) * moved;
        return (trial, Passed { work, ..Default::default() });
    }
    let side = 1.0_f64.copysign(trial);
    let end = side * limits[1];
    let growth = limits[1] - limits[0];
    // |e| - l is convex over the substep, so it is passed once, and then slip goes on to the end.
    let onset = if growth == 0.0 {
        end
    } else {
        let fraction = (limits[0] - side * deflection) / (side * moved - growth);
        deflection + fraction.clamp(0.0, 1.0) * moved
    };
    let sliding = moved - (onset - deflection);
    let slip = sliding - (end - onset);
    let mean = 0.5 * (onset + end);
    let work = 0.5 * (deflection + onset) * (onset - deflection) + mean * sliding;
    (end, Passed { slip: [slip, 0.0], dissipation: mean * slip, jump_loss: 0.0, work })
}

/// One period in two directions: lengths of the slip and of the path while loaded, m.
///
/// # Arguments
/// * `substeps` -- that are passed, from the first on
fn general_period(
    path: &Path,
    limits: &[f64],
    substeps: usize,
    compression: f64,
    spring: &mut Spring,
    static_factor: f64,
    out: &mut SpringCycle,
) -> (f64, f64) {
    out.substeps += substeps;
    let (mut slip_path, mut loaded) = (0.0, 0.0);
    let mut from = (path.points[0], limits[0]);
    let corners = path.points.iter().zip(limits);
    for (&point, &limit) in corners.clone().skip(1).chain(corners.take(1)).take(substeps) {
        let whole = difference(point.tangential, from.0.tangential);
        let compressions = [compression - from.0.lift, compression - point.lift];
        match loaded_part(compressions, [from.1, limit]) {
            ControlFlow::Continue(part) => {
                let moved = scaled(part.fraction, whole);
                loaded += length(moved);
                let passed = spring.pass(moved, part.limits, static_factor);
                if compressions[1] < 0.0 {
                    *spring = Spring::default();
                }
                slip_path += passed.slip_path;
                out.push(spring.deflection, &passed.passed);
            }
            ControlFlow::Break(()) => out.push([0.0; 2], &Passed::default()),
        }
        from = (point, limit);
    }
    (slip_path, loaded)
}

/// A spring under way in two directions.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Spring {
    deflection: [f64; 2],
    /// Whether the kinetic limit holds it: from an onset of slip until the slip reverses.
    sliding: bool,
}

/// A substep and the length of its slip, jumps to and fro counted each.
#[derive(Default)]
struct PassedPlane {
    passed: Passed,
    slip_path: f64,
}

impl PassedPlane {
    fn slips(&mut self, slip: [f64; 2]) {
        self.passed.slip = sum(self.passed.slip, slip);
        self.slip_path += length(slip);
    }
}

impl Spring {
    /// Moves the indenter straight by `rest`, m, while the kinetic limit goes linearly from `limits[0]` to `limits[1]`, m.
    #[inline]
    fn pass(&mut self, mut rest: [f64; 2], mut limits: [f64; 2], static_factor: f64) -> PassedPlane {
        let mut passed = PassedPlane::default();
        for _ in 0..MAX_ONSETS {
            if self.sliding && self.goes_on_sliding(rest, limits) {
                break;
            }
            self.sliding = false;
            let start = self.deflection;
            let bounds = limits.map(|limit| static_factor * limit);
            let trial = sum(start, rest);
            if square(trial) <= bounds[1] * bounds[1] {
                passed.passed.work += 0.5 * dot(sum(start, trial), rest);
                self.deflection = trial;
                return passed;
            }
            let fraction = onset(start, rest, bounds);
            let stuck = scaled(fraction, rest);
            let held = sum(start, stuck);
            passed.passed.work += 0.5 * dot(sum(start, held), stuck);
            rest = scaled(1.0 - fraction, rest);
            limits[0] += fraction * (limits[1] - limits[0]);
            self.deflection = held;
            self.sliding = true;
            if static_factor == 1.0 {
                break;
            }
            self.deflection = scaled(static_factor.recip(), held);
            let jump = difference(held, self.deflection);
            passed.passed.dissipation += dot(self.deflection, jump);
            passed.passed.jump_loss += 0.5 * square(jump);
            passed.slips(jump);
        }
        self.slide(rest, limits, &mut passed);
        passed
    }

    /// Whether the motion leads out of the kinetic limit, on which the spring is.
    fn goes_on_sliding(&self, moved: [f64; 2], limits: [f64; 2]) -> bool {
        let growth = limits[1] - limits[0];
        if limits[0] > 0.0 {
            dot(self.deflection, moved) >= limits[0] * growth
        } else {
            square(moved) >= growth * growth
        }
    }

    /// Slides to the end of the substep, on the kinetic limit from here on.
    fn slide(&mut self, moved: [f64; 2], limits: [f64; 2], passed: &mut PassedPlane) {
        let onset = self.deflection;
        let end = turned(onset, moved, limits);
        let slip = difference(moved, difference(end, onset));
        let mean = scaled(0.5, sum(onset, end));
        passed.passed.dissipation += dot(mean, slip);
        passed.passed.work += dot(mean, moved);
        passed.slips(slip);
        self.deflection = end;
    }
}

/// Fraction of the motion at which `|e + θ Δu|` reaches the limit, linear between `limits`, which it exceeds in the end.
#[inline]
fn onset(deflection: [f64; 2], moved: [f64; 2], limits: [f64; 2]) -> f64 {
    let growth = limits[1] - limits[0];
    // a θ² + 2 b θ + c = 0, c <= 0 and the sum of all positive; the root where it changes sign upwards
    let a = square(moved) - growth * growth;
    let b = dot(deflection, moved) - limits[0] * growth;
    let size = length(deflection);
    let c = ((size - limits[0]) * (size + limits[0])).min(0.0);
    // b² - a c, in which nothing cancels where deflection and limit vanish together, as they do at lift-off of a path that returns.
    let turn = (deflection[0] * moved[1] - deflection[1] * moved[0]).abs();
    let reach = length(difference(scaled(limits[0], moved), scaled(growth, deflection)));
    let root = ((reach - turn).max(0.0) * (reach + turn)).sqrt();
    let fraction = if b > 0.0 { -c / (b + root) } else { (root - b) / a };
    if fraction.is_nan() { 0.0 } else { fraction.clamp(0.0, 1.0) }
}

/// Deflection at the end of sliding along a straight motion, while the limit goes linearly from `limits[0]` to `limits[1]`.
///
/// ```text
/// φ' = -(|u'|/l) sin φ   for the angle φ between deflection and motion,
/// tan(φ_1/2) = tan(φ_0/2) exp(-∫ |du|/l)
/// ```
#[inline]
fn turned(deflection: [f64; 2], moved: [f64; 2], limits: [f64; 2]) -> [f64; 2] {
    let (size, way) = (length(deflection), length(moved));
    if limits[1] == 0.0 {
        return [0.0; 2];
    }
    if way == 0.0 {
        return if size == 0.0 { [0.0; 2] } else { scaled(limits[1] / size, deflection) };
    }
    let along = scaled(way.recip(), moved);
    if size == 0.0 {
        return scaled(limits[1], along);
    }
    let growth = limits[1] - limits[0];
    let inverse_mean = if growth == 0.0 { limits[1].recip() } else { (growth / limits[0]).ln_1p() / growth };
    turned_by(deflection, size, along, (-way * inverse_mean).exp(), limits[1])
}

/// The same of a deflection of some size, by the direction of the motion, what is left of `tan(φ/2)`, and the limit at the end.
#[inline]
fn turned_by(deflection: [f64; 2], size: f64, along: [f64; 2], decay: f64, limit: f64) -> [f64; 2] {
    let across = [-along[1], along[0]];
    let (p, w) = (dot(deflection, along), dot(deflection, across));
    // tan(φ/2) = b/a, from whichever of its two forms does not cancel
    let (a, b) = if p >= 0.0 { (size + p, decay * w) } else { (w, decay * (size - p)) };
    let norm = a * a + b * b;
    if norm == 0.0 {
        return scaled(limit / size, deflection);
    }
    let (cosine, sine) = ((a * a - b * b) / norm, 2.0 * a * b / norm);
    sum(scaled(limit * cosine, along), scaled(limit * sine, across))
}

fn sum(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

fn difference(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn scaled(factor: f64, a: [f64; 2]) -> [f64; 2] {
    [factor * a[0], factor * a[1]]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn square(a: [f64; 2]) -> f64 {
    dot(a, a)
}

fn length(a: [f64; 2]) -> f64 {
    square(a).sqrt()
}
