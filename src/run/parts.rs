//! Everything that a run needs and that follows from its scene alone: model, stepper, tolerance, plan and limit.

use std::cell::Cell;
use std::f64::consts::PI;
use std::slice;

use super::budget::{self, FEWEST_CUBICS, NEAR_GROSS_SLIP, OF_STEPS, springs_taken_up};
use super::cost::work_so_far;
use super::mesh::{self, SPRINGS_TO_SLIDE};
use super::passes::Averaging;
use super::rim;
use crate::contact::InitialContact;
use crate::contact::closed_form::LimitingShape;
use crate::contact::stick_slip::Regime;
use crate::data::Attempt;
use crate::error::{Error, Result};
use crate::laws::history::History;
use crate::scene::{Cycle, Numerics, Scene, Stepper as StepperChoice};
use crate::solver::model::{
    FEWEST_SPRINGS, Gross, Model, MovingStick, OperatorStore, Resolution, Schedule, State,
};
use crate::solver::simulation::{Flow, HandOver, Observer, Outcome, Plan, Progress, Simulation};
use crate::solver::stepper::{self, CycleJump, EveryCycle, GrossSdirk, Stepper};

/// Springs, and others where those come to no end, of polynomials and of cubics, and tolerance of the run that tells how far a contact in gross slip comes to reach,
/// most steps that it may try, most work of all that resolve periods, over which others may take so many times as much, and what is added to that radius.
const COARSE: ([usize; 2], [usize; 2], f64) = ([12, FEWEST_SPRINGS], [FEWEST_CUBICS, 60], 1e-3);
const MOST_TRIED: u64 = 8000;
const MOST_WORK: f64 = 5e8;
const OF_STEPS_ALONE: f64 = 6.0;
const MARGIN: f64 = 1.02;

/// Depth worn in a run, over the indentation, below which it is short.
const SHORT: f64 = 0.1;

/// Largest depth over the mean one: 1.5 in the first cycles at k = 0.
const DEEPEST: f64 = 2.0;

/// Least tolerance there: errors of the compressions that are round-off.
const ROUND_OFF: f64 = 1e-12;

const WITHIN_END: f64 = 1.0 - 1e-12;

/// Everything that follows from a scene alone.
pub(super) struct Parts {
    pub model: Model,
    pub stepper: Box<dyn Stepper + Send>,
    pub tolerance: f64,
    pub plan: Plan,
    pub limit: Option<LimitingShape>,
    /// Where the run leads to, where the contact is in gross slip, or may reach far beyond where it comes to.
    reach: Option<Reach>,
    /// The meshes that take the run up one after the other, where springs may stick again or a block of gross slip follows.
    pub hand_overs: Vec<HandOver>,
    /// As in [`Simulation::averaging_below`].
    pub most_swing: f64,
}

impl Parts {
    /// # Arguments
    /// * `numerics` -- those of the scene, or coarser ones
    /// * `wanted` -- springs where none are given by hand, instead of those for the accuracy
    /// * `known` -- what another attempt at the run with the same substeps has found
    pub(super) fn new(
        scene: &Scene,
        numerics: &Numerics,
        wanted: Option<usize>,
        known: Option<&Known>,
        store: &OperatorStore,
    ) -> Result<Self> {
        let schedule = known.map(|it| &it.schedule);
        let mut parts = Self::on_any(scene, numerics, wanted, schedule, None, store)?;
        check_sliding(&parts.model)?;
        parts.limit = limit(&parts.model)?;
        if parts.model.has_gross_slip() {
            rim::check_gross_slip(&parts.model, parts.plan.end)?;
            // Beyond its end nothing is known of a profile, to which a radius must not be rounded.
            let end = WITHIN_END * parts.model.contact().equivalent_profile().largest_radius();
            let reach = match known.and_then(|it| it.reach) {
                Some(reach) => reach,
                None => Reach::of(&parts)?,
            };
            let Reach { radius, sticks_again, worn } = reach;
            parts.reach = Some(reach);
            // Errors of the compressions are relative to all of them, those of a short run to what it wears.
            let is_short = parts.model.gross().is_some() && worn < SHORT;
            if numerics.tolerance.is_none() && numerics.stepper == StepperChoice::Implicit && is_short {
                parts.tolerance = (parts.tolerance * worn / SHORT).max(ROUND_OFF);
                parts.stepper = stepper::implicit(&parts.model, parts.tolerance);
            }
            parts.hand_overs.iter_mut().for_each(|it| it.expected = sticks_again);
            let offsets = parts.model.gross_offsets((MARGIN * radius).min(end));
            parts.model = parts.model.shown_at(offsets);
        } else if parts.limit.is_none() && parts.model.is_shown_far_out() {
            let reach = match known {
                Some(known) => known.reach,
                None => Reach::of_partial_slip(scene, numerics, &parts, store),
            };
            parts.reach = reach;
            parts.model = match reach {
                Some(reach) => parts.model.shown_up_to(MARGIN * reach.radius),
                None => parts.model,
            };
        }
        Ok(parts)
    }

    /// As [`Parts::new`], of an attempt at a run.
    ///
    /// # Arguments
    /// * `known` -- what another attempt of the same [kind](Attempt::kind) has found
    pub(super) fn of_attempt(
        scene: &Scene,
        attempt: &Attempt,
        springs: usize,
        known: Option<&Known>,
        store: &OperatorStore,
    ) -> Result<Self> {
        let before = if known.is_none() { Known::before(attempt, scene)? } else { None };
        Self::new(scene, &attempt.numerics(scene), Some(springs), known.or(before.as_ref()), store)
    }

    /// The same on as many springs as a run came to, however often it was made anew.
    ///
    /// # Arguments
    /// * `radii` -- of the output, m
    pub(super) fn of_state(
        scene: &Scene,
        attempt: &Attempt,
        (state, radii): (&State, &[f64]),
        store: &OperatorStore,
    ) -> Result<Self> {
        let springs = state.compression.len() + 1;
        let on = |springs| Self::of_attempt(scene, attempt, springs, None, store);
        let first = on(springs);
        if first.as_ref().is_ok_and(|parts| parts.fit(state)) {
            return first;
        }
        let only = budget::springs_before(springs);
        let mut before = match state.stick {
            Some(_) => only..=only,
            None => budget::springs_before_sliding(springs),
        };
        let fits = |parts: &Self| parts.is_taken_up(state) && parts.model.radii() == radii;
        before.find_map(|springs| on(springs).ok().filter(fits)).map_or(first, Ok)
    }

    /// Whether a state is one of the model that takes the run up.
    fn is_taken_up(&self, state: &State) -> bool {
        self.hand_overs_done(state).is_some_and(|done| done > 0)
    }

    /// After how many hand-overs a state comes that may be one of this run; none where it is none.
    fn hand_overs_done(&self, state: &State) -> Option<usize> {
        let springs = state.compression.len() + 1;
        let mut on_annulus = self.model.gross().is_none();
        if springs == self.model.springs()
            && state.stick.is_some() == self.model.moving().is_some()
            && !self.model.was_left_before(state.cycles)
        {
            return Some(0);
        }
        let is_on = |hand_over: &HandOver| {
            on_annulus = !on_annulus;
            hand_over.springs == springs && state.stick.is_some() == on_annulus
        };
        self.hand_overs.iter().position(is_on).map(|before| before + 1)
    }

    /// Whether a state has the mesh of gross slip.
    pub(super) fn is_on_whole_contact(&self, state: &State) -> bool {
        state.stick.is_none() && (self.model.gross().is_some() || self.is_taken_up(state))
    }

    /// Whether a state is one of this run.
    pub(super) fn fit(&self, state: &State) -> bool {
        self.hand_overs_done(state).is_some()
    }

    /// The run from a state on.
    ///
    /// # Errors
    /// As [`Simulation::resume_handed_over`].
    pub(super) fn resume(self, state: State, progress: Progress) -> Result<Simulation> {
        let done = self.hand_overs_done(&state).unwrap_or_default();
        let Self { model, stepper, tolerance, plan, hand_overs, most_swing, .. } = self;
        let (done, ahead) = hand_overs.split_at(done);
        let simulation = match done.is_empty() {
            true => Simulation::resume(model, stepper, tolerance, plan, state, progress)
                .averaging_below(most_swing),
            false => Simulation::resume_handed_over((model, tolerance), done, plan, state, progress)?,
        };
        Ok(simulation.handing_over(ahead))
    }

    /// The run from the unworn contact on.
    ///
    /// # Errors
    /// As [`Simulation::new`].
    pub(super) fn begin(self) -> Result<Simulation> {
        let simulation = Simulation::new(self.model, self.stepper, self.tolerance, self.plan)?;
        Ok(simulation.handing_over(&self.hand_overs).averaging_below(self.most_swing))
    }

    /// As [`Parts::new`], for what a run is compared with: also on fewer springs than carry a contact that is in gross slip, and without its limit.
    ///
    /// # Arguments
    /// * `known` -- the schedule, where a run of the scene with the same substeps has made it
    /// * `averages` -- whether steps see the mean cycle of a pass, where that is decided
    pub(super) fn on_any(
        scene: &Scene,
        numerics: &Numerics,
        wanted: Option<usize>,
        known: Option<&Schedule>,
        averages: Option<bool>,
        store: &OperatorStore,
    ) -> Result<Self> {
        let contact = scene.contact()?;
        check_regime(scene, &contact)?;
        let schedule = match known {
            Some(schedule) => schedule.clone(),
            None => schedule(scene, &contact, numerics)?,
        };
        let model = mesh::model(&contact, &schedule, scene.loading().duration, numerics, wanted, store)?;
        check_stepper(numerics.stepper, &model)?;
        let whole = numerics.stepper == StepperChoice::EveryCycle;
        let plan =
            super::plan::plan(scene.loading().duration, scene.output(), contact.tau_per_cycle(), whole)?;
        let chosen = numerics.stepper == StepperChoice::Implicit;
        let averaging = match chosen {
            true => Averaging::of(&model, plan.end, numerics.accuracy),
            false => Averaging::default(),
        };
        let mut model = model;
        model.average_from(if averages.unwrap_or(averaging.at_once) { 0.0 } else { f64::INFINITY });
        let tolerance =
            numerics.tolerance.unwrap_or_else(|| budget::tolerance_for(numerics.accuracy, &model));
        let stepper: Box<dyn Stepper + Send> = match numerics.stepper {
            StepperChoice::Implicit => stepper::implicit(&model, tolerance),
            StepperChoice::EveryCycle => Box::<EveryCycle>::default(),
            StepperChoice::CycleJump => Box::<CycleJump>::default(),
        };
        // By hand it is one tolerance for both meshes, and no more springs than by choice; near gross slip springs are those over the slip annulus.
        let again = springs_taken_up(&model);
        let springs = match numerics.springs {
            Some(springs) if model.gross().is_some() && contact.regime() == Regime::PartialSlip => springs,
            Some(_) => again.min(budget::MOST_RAISED),
            None => again,
        };
        let given = scene.numerics().tolerance.is_some();
        let to = |springs: usize, part: f64| {
            let tolerance = if given { tolerance } else { part * tolerance };
            HandOver { springs, tolerance, expected: false }
        };
        let hand_overs = match model.gross() {
            _ if !model.is_taken_up() => vec![],
            None if model.comes_to_gross_slip() => {
                vec![to(springs, OF_STEPS), to(model.springs(), NEAR_GROSS_SLIP)]
            }
            Some(_) => vec![to(springs, NEAR_GROSS_SLIP / OF_STEPS)],
            None => vec![to(springs, budget::OF_SLIDING_ON)],
        };
        let most_swing = averaging.most_swing;
        Ok(Self { model, stepper, tolerance, plan, limit: None, reach: None, hand_overs, most_swing })
    }
}

/// What acts on a contact as far as it is asked for, for the steps of some numerics.
pub(super) fn schedule(scene: &Scene, contact: &InitialContact, numerics: &Numerics) -> Result<Schedule> {
    let span = scene.loading().duration.span(contact.tau_per_cycle())?;
    let asked = span.map_or(f64::INFINITY, |[cycles, _]| cycles);
    let all = scene.conditions();
    let conditions = all.until(asked * all.clock.per_cycle(contact.tau_per_cycle()));
    let schedule = Schedule::new(contact, &conditions, resolution(scene, numerics))?;
    if numerics.stepper != StepperChoice::Implicit {
        return Ok(schedule.for_explicit_steps());
    }
    Ok(schedule.asked_until(asked))
}

/// The limit in closed form, where there is one.
fn limit(model: &Model) -> Result<Option<LimitingShape>> {
    let conditions = model.schedule().conditions();
    let by_energy = *model.schedule().friction_along_energy() != History::Constant;
    let held = conditions.holds_normal_force && !conditions.holds_both_forces();
    let path_dependent = held || model.moving().is_some_and(MovingStick::passes_worn_ground);
    let slides = model.slides() || model.comes_to_gross_slip();
    let unlimited = slides || path_dependent || by_energy;
    if unlimited { Ok(None) } else { LimitingShape::under(model.contact(), conditions) }
}

/// What is the same in all attempts at a run with the same substeps.
pub(super) struct Known {
    schedule: Schedule,
    reach: Option<Reach>,
}

impl Known {
    pub(super) fn of(parts: &Parts) -> Self {
        Self { schedule: parts.model.under_all_blocks().1.clone(), reach: parts.reach }
    }

    /// Before an attempt, where its schedule is not that of the scene alone.
    ///
    /// # Errors
    /// Those of the schedule.
    fn before(attempt: &Attempt, scene: &Scene) -> Result<Option<Self>> {
        if !attempt.is_on_springs_that_stay() {
            return Ok(None);
        }
        let schedule = schedule(scene, &scene.contact()?, &attempt.numerics(scene))?;
        Ok(Some(Self { schedule: schedule.on_springs_that_stay(), reach: None }))
    }
}

/// Where a run leads to.
#[derive(Clone, Copy)]
struct Reach {
    /// Contact radius, m.
    radius: f64,
    /// Whether springs stick again on the way.
    sticks_again: bool,
    /// Depth worn, over the first indentation.
    worn: f64,
}

impl Reach {
    /// By a run in coarse steps, on the springs of the coarsest accuracy: whatever those of an attempt are, since one that is taken up again has to be shown at the same radii. None where
    /// that comes to no end, or takes long.
    fn of_partial_slip(
        scene: &Scene,
        numerics: &Numerics,
        parts: &Parts,
        store: &OperatorStore,
    ) -> Option<Self> {
        let (_, _, tolerance) = COARSE;
        let numerics = Numerics { accuracy: budget::CHEAPEST, tolerance: Some(tolerance), ..*numerics };
        let coarse = Parts::on_any(scene, &numerics, None, Some(parts.model.schedule()), None, store).ok()?;
        let plan = Plan { outputs: vec![], end: coarse.plan.end };
        let mut coarse = Parts { plan, ..coarse }.begin().ok()?;
        let outcome = coarse.run(&mut [&mut Bounded { most_work: MOST_WORK }]).ok()?;
        let ends = outcome != Outcome::Interrupted;
        let radius = coarse.model().contact_radius(coarse.state());
        ends.then_some(Self { radius, sticks_again: false, worn: 1.0 })
    }

    /// Of gross slip, whatever the springs of the run, by a coarse one. Where that comes to no end after springs stick again, one in which they do not reaches farther; where none comes to an end, the
    /// radius is that which bounds it at an indentation that is held, beyond which the unworn profile is as high.
    fn of(parts: &Parts) -> Result<Self> {
        let (polynomials, cubics, tolerance) = COARSE;
        let (contact, schedule) = parts.model.under_all_blocks();
        // At an indentation that is held another radius serves as well.
        let bounded = schedule.resolves() || !parts.model.wears_without_end();
        let most_work = if bounded { MOST_WORK } else { OF_STEPS_ALONE * MOST_WORK };
        let (sticks_again, most_work) = (Cell::new(false), Cell::new(most_work));
        let coarse = |springs: usize, follow: bool| -> Result<std::result::Result<Self, Error>> {
            let model = Model::in_gross_slip(contact, schedule.clone(), springs)?;
            let plan = Plan { outputs: vec![], end: parts.plan.end };
            let hand_over = HandOver { springs: springs_taken_up(&model), tolerance, expected: false };
            let coarse = Simulation::new(model, Box::new(GrossSdirk::new(tolerance)), tolerance, plan)?;
            let mut coarse = coarse.handing_over(if follow { slice::from_ref(&hand_over) } else { &[] });
            let outcome = coarse.run(&mut [&mut Bounded { most_work: most_work.get() }]);
            most_work.set(most_work.get() - work_so_far(&coarse));
            sticks_again.set(sticks_again.get() || coarse.sticks_after_gross_slip());
            if outcome? == Outcome::Interrupted {
                return Ok(Err(coarse.reaches_too_slowly()));
            }
            let before = coarse.state().ground.iter().flat_map(|it| it.places()).map(|(_, worn)| worn);
            // Next to an edge of stick that creeps those of the springs leave out the ground that it has passed.
            let depths = match coarse.model().gross() {
                Some(_) => coarse.fields().wear_depth.clone(),
                None => coarse.wear_depth(),
            };
            let deepest = depths.into_iter().chain(before).fold(0.0, f64::max);
            // Of a little wear depths are differences of compressions, as good as the tolerance; what is worn by the rates is not.
            let area = PI * coarse.model().contact_radius(coarse.state()).powi(2);
            let by_rates = DEEPEST * coarse.state().volume_by_rate / area;
            Ok(Ok(Self {
                radius: coarse.model().worn_radius(coarse.state()),
                sticks_again: sticks_again.get(),
                worn: deepest.min(by_rates) / contact.indentation(),
            }))
        };
        let [first, then] = if Gross::is_smooth(contact, schedule) { polynomials } else { cubics };
        let (mut why, mut too_slow) = (None, None);
        for (springs, follow) in [(first, true), (then, true), (first, false)] {
            if !follow && !sticks_again.get() {
                break;
            }
            match coarse(springs, follow) {
                Err(Error::NotConverged { why: here, .. }) => why = why.or(Some(here)),
                Ok(Err(error)) => too_slow = too_slow.or(Some(error)),
                Ok(Ok(found)) => return Ok(found),
                Err(error) => return Err(error),
            }
        }
        if parts.model.wears_without_end() {
            let no_end = || Error::Inconsistent { what: "loading", why: why.unwrap_or_default() };
            return Err(too_slow.unwrap_or_else(no_end));
        }
        let radius = contact.indenter().radius_at_height(contact.indentation());
        Ok(Self { radius, sticks_again: sticks_again.get(), worn: 1.0 })
    }
}

/// Stops the coarse run that takes too long.
struct Bounded {
    most_work: f64,
}

impl Observer for Bounded {
    fn step(&mut self, simulation: &Simulation) -> Result<Flow> {
        self.rejected(simulation)
    }

    fn rejected(&mut self, simulation: &Simulation) -> Result<Flow> {
        let progress = simulation.progress();
        let tried = progress.steps + progress.rejected_steps;
        let goes_on = tried < MOST_TRIED && work_so_far(simulation) <= self.most_work;
        Ok(if goes_on { Flow::Continue } else { Flow::Stop })
    }
}

/// Refuses contacts in which nothing slips and so nothing wears, where the first cycle tells.
fn check_regime(scene: &Scene, contact: &InitialContact) -> Result<()> {
    if contact.regime() != Regime::Stick || !scene.conditions().is_plain() {
        return Ok(());
    }
    let amplitude = contact.amplitude();
    let why = format!("{amplitude:e} m leaves the whole contact stuck, so that nothing wears; ask for more");
    Err(Error::Inconsistent { what: scene.loading().amplitude.key(), why })
}

/// Refuses too few springs for a mesh that reaches nearly to the axis.
fn check_sliding(model: &Model) -> Result<()> {
    let springs = model.springs();
    if !model.slides() || model.gross().is_some() || springs >= SPRINGS_TO_SLIDE {
        return Ok(());
    }
    let why = format!(
        "{springs} springs are too few where all stick is lost; ask for at least {SPRINGS_TO_SLIDE}, or for a smaller amplitude"
    );
    Err(Error::Inconsistent { what: "numerics.springs", why })
}

/// Refuses explicit steps where the edge of stick moves.
fn check_stepper(stepper: StepperChoice, model: &Model) -> Result<()> {
    if stepper == StepperChoice::Implicit {
        return Ok(());
    }
    if model.gross().is_some() {
        let why =
            format!("{:?} does not follow gross slip; leave it out or write \"implicit\"", stepper.name());
        return Err(Error::Inconsistent { what: "numerics.stepper", why });
    }
    if model.moving().is_none() {
        return Ok(());
    }
    Err(Error::Inconsistent {
        what: "numerics.stepper",
        why: format!(
            "{:?} does not follow an edge of stick that moves (a force that is held, a rig, friction that changes, blocks that shrink); \
             leave it out or write \"implicit\"",
            stepper.name()
        ),
    })
}

/// How periods are passed through.
pub(super) fn resolution(scene: &Scene, numerics: &Numerics) -> Resolution {
    let conditions = scene.conditions();
    let mode = &conditions.mode;
    let sampled = !mode.is_tangential() && numerics.springs.is_none();
    let steps = mode.changes_indentation() && conditions.constant_friction().is_some();
    let chosen = sampled.then(|| match steps {
        true => budget::substeps_of_steps(numerics.accuracy, mode.peaks().max(mode.oscillations())),
        false => budget::substeps_for(numerics.accuracy, mode.changes_indentation()),
    });
    let resolved = numerics.cycle == Some(Cycle::Resolved);
    Resolution { resolved, substeps: numerics.substeps.or(chosen) }
}
