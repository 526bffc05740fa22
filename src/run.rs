//! The main job: a scene from the first cycle to its end, with snapshots, checkpoints and a summary.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM, SIGUSR1};

use crate::contact::InitialContact;
use crate::contact::closed_form::LimitingShape;
use crate::contact::indenter::Indenter;
use crate::contact::stick_slip::Regime;
use crate::data::{
    Checkpoint, LimitCurves, LimitDistance, ResultPath, RunFile, RunHeader, RunWriter, Snapshot, StopReason,
    scene_hash,
};
use crate::error::{Error, Result};
use crate::laws::history::History;
use crate::laws::loading::{self, Mode, cycles_at, has_come};
use crate::scene::{Cycle, Numerics, Output, Scene, Stepper as StepperChoice};
use crate::solver::model::{Model, OperatorStore, Resolution, Schedule};
use crate::solver::simulation::{End, Observer, Outcome, Plan, Simulation};
use crate::solver::stepper::{Bdf, CycleJump, EveryCycle, Sdirk, Stepper};

mod accuracy;
mod cost;
mod mesh;
pub mod progress;
pub mod readings;
mod ready;
mod recorder;
mod threads;

use accuracy::budget;
pub use cost::Expected;
pub(crate) use mesh::operator_bytes;
use ready::Ready;
use recorder::{Recorder, snapshot};
pub use threads::most_threads;
pub(crate) use threads::thread_pool;

/// Part of the run at which the first of geometrically spread snapshots is taken.
const FIRST_SNAPSHOT: f64 = 1e-4;

/// Dimensionless times between which snapshots are spread where the end is not known beforehand.
const UNKNOWN_END: [f64; 2] = [1e-2, 1e3];

/// Fewest springs that carry a contact which slides as a whole: their mesh begins at a thousandth of its radius.
const SPRINGS_TO_SLIDE: usize = 60;

/// What a finished or interrupted run comes to; SI.
#[derive(Debug, Clone)]
pub struct RunResult {
    /// The result file.
    pub output: PathBuf,
    /// Why the run stopped.
    pub stop_reason: StopReason,
    /// The last snapshot, or the state of the interruption.
    pub last: Snapshot,
    /// What a restart would need.
    pub checkpoint: Checkpoint,
    /// The limiting shape, where there is a closed form.
    pub limit: Option<LimitingShape>,
    /// Distance of the last profile from it.
    pub distance: Option<LimitDistance>,
    /// The unworn indenter.
    pub indenter: Indenter,
}

impl RunResult {
    /// Whether the error is as small as was asked for; none where springs were given by hand.
    pub fn accuracy_met(&self) -> Option<bool> {
        self.checkpoint.accuracy_met()
    }

    /// A word about an end that is less accurate than was asked for.
    pub fn warning(&self) -> Option<String> {
        let accuracy = self.checkpoint.accuracy?;
        let error = self.checkpoint.error_estimate.filter(|error| *error > accuracy)?;
        let springs = self.checkpoint.state.compression.len() + 1;
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

/// A run that is ready to go.
pub struct Run {
    simulation: Simulation,
    recorder: Recorder,
    limit: Option<LimitingShape>,
    warning: Option<String>,
    scene: Scene,
    store: OperatorStore,
}

/// What runs of many scenes in one process share.
#[derive(Debug, Default)]
pub struct Shared {
    /// The transforms.
    pub operators: OperatorStore,
    /// Set when all runs are to stop at their next step.
    pub stop: Arc<AtomicBool>,
    /// Wall time between checkpoints, s, instead of the scene's.
    pub checkpoint_interval: Option<f64>,
}

impl Shared {
    /// As the default, with `stop` set by SIGTERM, SIGINT and SIGUSR1.
    ///
    /// # Errors
    /// [`Error::Inconsistent`] if the system takes no handler.
    pub fn with_signals() -> Result<Self> {
        let shared = Self::default();
        for signal in [SIGTERM, SIGINT, SIGUSR1] {
            signal_hook::flag::register(signal, Arc::clone(&shared.stop)).map_err(|error| {
                Error::Inconsistent { what: "signal handler", why: format!("signal {signal}: {error}") }
            })?;
        }
        Ok(shared)
    }
}

/// What `--resume` finds.
pub enum Resumed {
    /// A run that goes on.
    Run(Box<Run>),
    /// The file of a run that reached its end.
    Complete(Box<RunResult>),
}

impl Run {
    /// Prepares the run of a scene; computes and writes nothing yet.
    ///
    /// # Errors
    /// [`Error::File`] if `output` exists and `overwrite` is not given, or cannot be written; those of the physics where in the
    /// scene nothing slips, or it needs more memory than there is.
    pub fn new(scene: &Scene, output: &Path, overwrite: bool) -> Result<Self> {
        let shared = Shared::with_signals()?;
        let mut run = Self::begin(scene, &shared, |header| RunWriter::create(output, header, overwrite))?;
        run.warning = cost::expected(scene.numerics().stepper, &mut run.simulation).warning;
        Ok(run)
    }

    /// Prepares the run of one scene of many, which writes a file only when it takes longer than its checkpoint interval or is stopped.
    ///
    /// # Errors
    /// As [`Run::new`].
    pub fn one_of_many(scene: &Scene, checkpoint: &Path, shared: &Shared) -> Result<Self> {
        let mut run = Self::begin(scene, shared, |header| Ok(RunWriter::deferred(checkpoint, header)))?;
        run.recorder.saves_result = false;
        Ok(run)
    }

    fn begin(
        scene: &Scene,
        shared: &Shared,
        writer: impl FnOnce(RunHeader) -> Result<RunWriter>,
    ) -> Result<Self> {
        let Ready { simulation, limit } = Ready::new(scene, &shared.operators)?;
        if scene.numerics().stepper == StepperChoice::Implicit {
            simulation.model().release_factors();
        }
        let header = header(scene, simulation.model(), limit.as_ref());
        let recorder = Recorder::new(scene, writer(header)?, 0.0, shared);
        let store = shared.operators.clone();
        Ok(Self { simulation, recorder, limit, warning: None, scene: scene.clone(), store })
    }

    /// Prepares a run that goes on from the last checkpoint in its file.
    ///
    /// # Errors
    /// [`Error::File`] if the file is none of a run, or holds no checkpoint that fits its scene.
    pub fn resume<'a>(file: impl Into<ResultPath<'a>>) -> Result<Resumed> {
        let file = file.into();
        let path = file.path();
        Self::go_on(RunFile::open(file)?, path, &Shared::with_signals()?, |run| run.into_writer(path))
    }

    /// Prepares a run as [`Run::one_of_many`] that goes on from the checkpoint in `from`, and writes its own to `checkpoint`.
    ///
    /// # Errors
    /// As [`Run::resume`]; [`Error::File`] if what is in `from` was computed from another scene.
    pub fn resume_one_of_many(
        scene: &Scene,
        from: &Path,
        checkpoint: &Path,
        shared: &Shared,
    ) -> Result<Resumed> {
        let file = RunFile::open(from)?;
        if !is_of(&file, scene) {
            let why = "was computed from another scene, or by another version of the program".into();
            return Err(Error::File { path: from.to_owned(), why });
        }
        let resumed = Self::go_on(file, from, shared, |file| Ok(file.into_deferred_writer(checkpoint)))?;
        Ok(match resumed {
            Resumed::Run(mut run) => {
                run.recorder.saves_result = false;
                Resumed::Run(run)
            }
            complete => complete,
        })
    }

    fn go_on(
        file: RunFile,
        path: &Path,
        shared: &Shared,
        writer: impl FnOnce(RunFile) -> Result<RunWriter>,
    ) -> Result<Resumed> {
        let unusable = |why: &str| Error::File { path: path.to_owned(), why: why.to_owned() };
        if !file.complete && file.program_version != env!("CARGO_PKG_VERSION") {
            return Err(unusable(&format!(
                "its checkpoint is of fretwear {}, and this is {}; go on with that one, or run its scene again",
                file.program_version,
                env!("CARGO_PKG_VERSION")
            )));
        }
        if !file.complete && file.scene_hash.is_none() {
            return Err(unusable(
                "does not tell what its checkpoint was computed from (no attribute scene_hash); run its scene again",
            ));
        }
        let mut checkpoint =
            file.checkpoint.clone().ok_or_else(|| unusable("holds no checkpoint; run its scene again"))?;
        let name = format!("{} (its scene)", path.display());
        let scene = Scene::from_stored(
            &file.header.scene,
            &name,
            file.header.table.clone(),
            file.header.path.clone(),
        )?;
        checkpoint.accuracy = scene.numerics().accuracy_asked();
        // As many springs as it came to, however often it was made anew.
        let springs = Some(checkpoint.state.compression.len() + 1);
        let parts = Parts::new(&scene, scene.numerics(), springs, &shared.operators)?;
        if file.header.radius != parts.model.radii()
            || checkpoint.state.compression.len() + 1 != parts.model.springs()
            || checkpoint.state.stick.is_some() != parts.model.moving().is_some()
            || !checkpoint.state.past.fits(&checkpoint.state, Bdf::HIGHEST_ORDER)
            || !checkpoint
                .state
                .compression
                .iter()
                .chain([&checkpoint.state.slip_area])
                .all(|value| value.is_finite())
        {
            return Err(unusable(
                "its checkpoint does not fit its scene; run the scene again with this version",
            ));
        }
        if file.complete {
            let last = file
                .snapshots
                .last()
                .cloned()
                .ok_or_else(|| unusable("holds no snapshot; run its scene again"))?;
            return Ok(Resumed::Complete(Box::new(RunResult {
                output: path.to_owned(),
                stop_reason: file.stop_reason,
                distance: distance(&parts.model, parts.limit.as_ref(), &last),
                indenter: parts.model.contact().indenter().clone(),
                last,
                checkpoint,
                limit: parts.limit,
            })));
        }
        let Checkpoint { state, progress, wall_seconds, .. } = checkpoint;
        let simulation =
            Simulation::resume(parts.model, parts.stepper, parts.tolerance, parts.plan, state, progress);
        let recorder = Recorder::new(&scene, writer(file)?, wall_seconds, shared);
        let store = shared.operators.clone();
        let limit = parts.limit;
        Ok(Resumed::Run(Box::new(Self { simulation, recorder, limit, warning: None, scene, store })))
    }

    /// Refuses what [`Run::new`] refuses, with the same words; else what the run will take.
    ///
    /// # Errors
    /// As [`Run::new`], those of files apart. Each names a key of the scene.
    pub fn check(scene: &Scene) -> Result<Expected> {
        let mut ready = Ready::new(scene, &OperatorStore::default())?;
        Ok(cost::expected(scene.numerics().stepper, &mut ready.simulation))
    }

    /// A word about a run that will take long, where that is known beforehand.
    pub fn warning(&self) -> Option<&str> {
        self.warning.as_deref()
    }

    /// The simulation, at its start or where it goes on.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// Runs to the end, or to a checkpoint when SIGTERM, SIGINT or SIGUSR1 arrives, and writes the result file.
    ///
    /// # Errors
    /// Those of the simulation, after what was reached is written; [`Error::File`] if it cannot be.
    pub fn execute(self, progress: Option<&mut dyn Observer>) -> Result<RunResult> {
        self.execute_keeping(progress).map(|(result, _)| result)
    }

    /// Runs as [`Run::execute`] does, and gives what is or would be in the result file as well.
    ///
    /// # Errors
    /// As [`Run::execute`].
    pub fn execute_keeping(self, mut progress: Option<&mut dyn Observer>) -> Result<(RunResult, RunFile)> {
        let Self { mut simulation, mut recorder, mut limit, scene, store, .. } = self;
        let mut refinements = 0;
        // Springs on which the run came to an end, if less accurately than was asked for.
        let mut ended = None;
        let (outcome, checkpoint) = loop {
            recorder.run_companions(&scene, &store, &simulation, limit.is_some());
            let outcome = match progress.as_mut() {
                Some(progress) => simulation.run(&mut [&mut recorder, &mut **progress]),
                None => simulation.run(&mut [&mut recorder]),
            };
            let checkpoint = recorder.checkpoint(&simulation);
            let springs = match (&outcome, ended) {
                // Finer ones do not.
                (Err(Error::NotConverged { .. }), Some(springs)) => {
                    refinements = budget::REFINEMENTS;
                    Some(springs)
                }
                _ if refinements < budget::REFINEMENTS => {
                    recorder.more_springs(&scene, &simulation, &outcome, &checkpoint)
                }
                _ => None,
            };
            if let Some(springs) = springs
                && let Ok(parts) = Parts::new(&scene, scene.numerics(), Some(springs), &store)
                && let Ok(finer) = Simulation::new(parts.model, parts.stepper, parts.tolerance, parts.plan)
            {
                ended = outcome.is_ok().then(|| simulation.model().springs());
                (simulation, limit) = (finer, parts.limit);
                recorder.writer.restart(header(&scene, simulation.model(), limit.as_ref()));
                refinements += 1;
                continue;
            }
            break (outcome, checkpoint);
        };
        let stop_reason = outcome.as_ref().map_or(StopReason::Interrupted, |outcome| (*outcome).into());
        let complete = stop_reason != StopReason::Interrupted;
        if recorder.saves(complete, outcome.is_err()) {
            recorder.writer.save(&checkpoint, stop_reason, complete)?;
        }
        outcome?;
        let last = snapshot(&simulation);
        let distance = distance(simulation.model(), limit.as_ref(), &last);
        let indenter = simulation.model().contact().indenter().clone();
        let output = recorder.writer.path().to_owned();
        let (header, snapshots) = recorder.writer.into_parts();
        let file = RunFile::finished(header, snapshots, checkpoint.clone(), stop_reason);
        Ok((RunResult { output, stop_reason, last, checkpoint, limit, distance, indenter }, file))
    }
}

/// Whether a file was computed from this scene, with its rows and numerics, by this version of the program.
pub(crate) fn is_of(file: &RunFile, scene: &Scene) -> bool {
    file.scene_hash == Some(hash_of(scene))
}

/// What a run of a scene is computed from, as one word.
pub(crate) fn hash_of(scene: &Scene) -> String {
    let (table, path) = (scene.table().map(Arc::as_ref), scene.path().map(Arc::as_ref));
    scene_hash(env!("CARGO_PKG_VERSION"), scene.text(), table, path)
}

/// What of a run does not change.
fn header(scene: &Scene, model: &Model, limit: Option<&LimitingShape>) -> RunHeader {
    RunHeader {
        title: scene.title().map(str::to_owned),
        scene: scene.text().to_owned(),
        radius: model.radii(),
        limit: limit.map(|limit| limit_curves(model, limit)),
        table: scene.table().cloned(),
        path: scene.path().cloned(),
    }
}

impl From<Outcome> for StopReason {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::End => Self::End,
            Outcome::Rate => Self::Rate,
            Outcome::WornOut => Self::WornOut,
            Outcome::Unending => Self::Unending,
            Outcome::Interrupted => Self::Interrupted,
        }
    }
}

/// Everything that follows from a scene alone.
struct Parts {
    model: Model,
    stepper: Box<dyn Stepper + Send>,
    tolerance: f64,
    plan: Plan,
    limit: Option<LimitingShape>,
}

impl Parts {
    /// # Arguments
    /// * `numerics` -- those of the scene, or coarser ones
    /// * `wanted` -- springs where none are given by hand, instead of those for the accuracy
    fn new(scene: &Scene, numerics: &Numerics, wanted: Option<usize>, store: &OperatorStore) -> Result<Self> {
        let parts = Self::on_any(scene, numerics, wanted, store)?;
        check_sliding(&parts.model)?;
        Ok(parts)
    }

    /// As [`Parts::new`], for what a run is compared with: also on fewer springs than carry a contact that slides as a whole.
    fn on_any(
        scene: &Scene,
        numerics: &Numerics,
        wanted: Option<usize>,
        store: &OperatorStore,
    ) -> Result<Self> {
        let contact = scene.contact()?;
        check_regime(scene, &contact)?;
        let schedule = Schedule::new(&contact, scene.conditions(), resolution(scene, numerics))?;
        let model = mesh::model(&contact, &schedule, numerics, wanted, store)?;
        let by_energy = *model.schedule().friction_along_energy() != History::Constant;
        let unlimited = model.slides() || scene.conditions().holds_normal_force || by_energy;
        let limit = if unlimited { None } else { LimitingShape::from_contact(model.contact())? };
        check_stepper(numerics.stepper, &model)?;
        let tolerance = numerics.tolerance.unwrap_or_else(|| budget::tolerance_for(numerics.accuracy));
        let stepper: Box<dyn Stepper + Send> = match numerics.stepper {
            StepperChoice::EveryCycle => Box::<EveryCycle>::default(),
            StepperChoice::CycleJump => Box::<CycleJump>::default(),
            StepperChoice::Implicit if model.wears_smoothly() => Box::new(Bdf::new(tolerance)),
            StepperChoice::Implicit => Box::new(Sdirk::new(tolerance)),
        };
        let whole = numerics.stepper == StepperChoice::EveryCycle;
        let plan = plan(scene.loading().duration, scene.output(), contact.tau_per_cycle(), whole)?;
        Ok(Self { model, stepper, tolerance, plan, limit })
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
    if !model.slides() || springs >= SPRINGS_TO_SLIDE {
        return Ok(());
    }
    let why = format!(
        "{springs} springs are too few where the whole contact slides; ask for at least {SPRINGS_TO_SLIDE}, or for a smaller amplitude"
    );
    Err(Error::Inconsistent { what: "numerics.springs", why })
}

/// Refuses explicit steps where the edge of stick moves.
fn check_stepper(stepper: StepperChoice, model: &Model) -> Result<()> {
    if model.moving().is_none() || stepper == StepperChoice::Implicit {
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
fn resolution(scene: &Scene, numerics: &Numerics) -> Resolution {
    let sampled = scene.conditions().mode != Mode::Tangential && numerics.springs.is_none();
    let chosen = sampled.then(|| budget::substeps_for(numerics.accuracy));
    let resolved = numerics.cycle == Some(Cycle::Resolved);
    Resolution { resolved, substeps: numerics.substeps.or(chosen) }
}

/// A figure of memory, bytes, from a table of the system in kilobytes.
pub(crate) fn memory_figure(table: &str, name: &str) -> Option<f64> {
    let text = std::fs::read_to_string(table).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok().map(|kilobytes| 1024.0 * kilobytes)
}

/// The plan of a scene; whole cycles where the stepper knows no others.
fn plan(duration: loading::Duration, output: &Output, tau_per_cycle: f64, whole: bool) -> Result<Plan> {
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

/// Distance of a snapshot from the limit.
fn distance(model: &Model, limit: Option<&LimitingShape>, last: &Snapshot) -> Option<LimitDistance> {
    limit.map(|limit| LimitDistance::new(&limit_curves(model, limit), last))
}

fn limit_curves(model: &Model, limit: &LimitingShape) -> LimitCurves {
    let wear_depth: Vec<f64> =
        model.offsets().into_iter().map(|offset| limit.wear_depth_at_offset(offset)).collect();
    LimitCurves { profile: worn_profile(model, &wear_depth), wear_depth }
}

/// Profile, m, with a depth worn away at the radii of the output.
fn worn_profile(model: &Model, wear_depth: &[f64]) -> Vec<f64> {
    let indenter = model.contact().indenter();
    model.radii().iter().zip(wear_depth).map(|(r, depth)| indenter.profile(*r) + depth).collect()
}
