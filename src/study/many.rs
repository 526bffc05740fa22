//! Scenes simulated in memory, many at once.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};

use super::batch::Batch;
use crate::error::{Error, Result};
use crate::run::{Results, Shared, Simulation, Stop};
use crate::scene::Scene;
use crate::solver::simulation::{self as stepping, Flow, Observer};

/// Whoever looks on while scenes run.
pub trait Watch: Sync {
    /// The scene of this place is done up to a part, from 0 to 1; said at its beginning, after each step, and at its end.
    fn done(&self, scene: usize, part: f64);
}

/// Simulates scenes on threads of their own, in the order of their places.
///
/// Whoever stops them gets what there is: the runs that were begun, the last of them not complete.
///
/// ```
/// # std::env::set_current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes"))?;
/// use fretwear::{Scene, Stop, Watch, run_many};
///
/// struct Silent;
/// impl Watch for Silent {
///     fn done(&self, _scene: usize, _part: f64) {}
/// }
///
/// let scenes = [Scene::from_path("paraboloid.toml")?, Scene::from_path("graded_ceramic.toml")?];
/// let runs = run_many(&scenes, None, &Stop::default(), &Silent)?;
/// for (scene, run) in scenes.iter().zip(runs) {
///     println!("{:?}: {:e} m³", scene.title(), run?.worn_volume().last().unwrap());
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Arguments
/// * `threads` -- each of which runs one scene at a time; at most, and by default, one for each core
///
/// # Errors
/// [`Error::Option`] if the system gives no threads; those of each scene are in its place, as [`Simulation::run`].
pub fn run_many(
    scenes: &[Scene],
    threads: Option<usize>,
    stop: &Stop,
    watch: &dyn Watch,
) -> Result<Vec<Result<Results>>> {
    run_many_sharing(scenes, threads, &Shared { stop: stop.clone(), ..Shared::default() }, watch)
}

/// As [`run_many`], with what earlier runs of this process left behind for later ones.
///
/// # Errors
/// As [`run_many`].
pub fn run_many_sharing(
    scenes: &[Scene],
    threads: Option<usize>,
    shared: &Shared,
    watch: &dyn Watch,
) -> Result<Vec<Result<Results>>> {
    let (batch, stop) = (Batch::new(threads, shared.clone())?, &shared.stop);
    let next = AtomicUsize::new(0);
    let begin = || if stop.is_stopped() { None } else { Some(next.fetch_add(1, Ordering::Relaxed)) };
    let work = || {
        let mut ended = vec![];
        while let Some((place, scene)) = begin().and_then(|place| Some((place, scenes.get(place)?))) {
            watch.done(place, 0.0);
            let run =
                || Simulation::sharing(scene, &batch.shared)?.run_with(Some(&mut Onlooker(place, watch)));
            let panicked = |_| {
                Err(Error::Inconsistent {
                    what: "scene",
                    why: "the program panicked; please report this scene".into(),
                })
            };
            let end = catch_unwind(AssertUnwindSafe(run)).unwrap_or_else(panicked);
            watch.done(place, 1.0);
            ended.push((place, end));
        }
        ended
    };
    let mut ended: Vec<_> = batch.broadcast(work).into_iter().flatten().collect();
    ended.sort_by_key(|(place, _)| *place);
    Ok(ended.into_iter().map(|(_, end)| end).collect())
}

/// Does something on threads of its own, which a process that was forked off does not lack.
///
/// # Errors
/// [`Error::Option`] if the system gives no threads.
pub fn on_threads<T: Send>(work: impl FnOnce() -> T + Send) -> Result<T> {
    Ok(Batch::new(None, Shared::default())?.install(work))
}

struct Onlooker<'a>(usize, &'a dyn Watch);

impl Observer for Onlooker<'_> {
    fn step(&mut self, simulation: &stepping::Simulation) -> Result<Flow> {
        self.1.done(self.0, simulation.done());
        Ok(Flow::Continue)
    }
}
