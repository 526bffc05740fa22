//! What the scenes of a study cost: a few of them, run here on one core.

use std::time::{Duration, Instant};

use serde::Serialize;

use crate::error::{Error, Result};
use crate::run::readings::ClosedForm;
use crate::run::{Shared, Simulation, memory_figure};
use crate::scene::{Study, Task};
use crate::study::batch::{Batch, alone};

/// Most scenes measured.
const MOST_SCENES: u64 = 5;

/// No further scene is begun after this time.
const ENOUGH: Duration = Duration::from_secs(30);

/// Part of the study between one measured scene and the next: with the golden ratio no axis of the study is kept in step with.
const STRIDE: f64 = 0.618_033_988_749_895;

/// What a few scenes took.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurement {
    /// The scenes measured; none where the cost was told.
    pub scenes: Vec<MeasuredScene>,
    /// Mean wall time of a scene on one core, s.
    pub mean_seconds: f64,
    /// Longest of them, s.
    pub longest_seconds: f64,
    /// Most memory this process has held, bytes, where the system tells.
    pub peak_memory: Option<f64>,
}

/// One of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasuredScene {
    /// Its number.
    pub scene: u64,
    /// Wall time on one core, s.
    pub seconds: f64,
    /// Why it failed, if it did; a sweep makes that a row and goes on.
    pub failure: Option<String>,
}

impl Measurement {
    /// Runs a few scenes spread over a study, one after the other on one core: five, or fewer once half a minute has passed.
    ///
    /// # Errors
    /// [`Error::Inconsistent`] with the failure of the first scene if all fail.
    pub fn new(study: &Study) -> Result<Self> {
        let batch = Batch::new(Some(1), Shared::default())?;
        let mut scenes = batch.install(|| measure_some(study, &batch.shared));
        if scenes.iter().all(|it| it.failure.is_some()) {
            let MeasuredScene { scene, failure, .. } = scenes.swap_remove(0);
            let why = format!("all scenes tried fail; scene {scene}: {}", failure.unwrap_or_default());
            return Err(Error::Inconsistent { what: "study", why });
        }
        let seconds = || scenes.iter().map(|it| it.seconds);
        Ok(Self {
            mean_seconds: seconds().sum::<f64>() / scenes.len() as f64,
            longest_seconds: seconds().fold(0.0, f64::max),
            peak_memory: memory_figure("/proc/self/status", "VmHWM:"),
            scenes,
        })
    }

    /// Takes the cost of a scene, s, as told.
    pub fn told(seconds: f64) -> Self {
        Self { scenes: vec![], mean_seconds: seconds, longest_seconds: seconds, peak_memory: None }
    }
}

/// Scenes until they are enough; transforms are shared among them, as in a sweep.
fn measure_some(study: &Study, shared: &Shared) -> Vec<MeasuredScene> {
    let begun = Instant::now();
    let mut scenes = vec![];
    for scene in spread(study.count(), MOST_SCENES) {
        scenes.push(measure(study, scene, shared));
        if begun.elapsed() >= ENOUGH {
            break;
        }
    }
    scenes
}

/// Numbers of at most `most` different scenes, spread over a study, increasing.
fn spread(count: u64, most: u64) -> Vec<u64> {
    if count <= most {
        return (0..count).collect();
    }
    let place = |i: u64| ((i as f64 * STRIDE + 0.5).fract() * count as f64) as u64;
    let mut scenes: Vec<u64> = (0..most).map(place).collect();
    scenes.sort_unstable();
    scenes.dedup();
    scenes
}

/// Runs one scene as a sweep does.
fn measure(study: &Study, scene: u64, shared: &Shared) -> MeasuredScene {
    let begun = Instant::now();
    let run = || {
        let described = study.scene(scene)?;
        match study.task() {
            Task::Limit => ClosedForm::new(&described).map(drop),
            Task::Run => Simulation::sharing(&described, shared)?.run().map(drop),
        }
    };
    let failure = match alone(&shared.stop, || run().map(Some)) {
        Ok(end) => end.and_then(std::result::Result::err),
        Err(error) => Some(error.to_string()),
    };
    MeasuredScene { scene, seconds: begun.elapsed().as_secs_f64(), failure }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_measured_are_spread_and_different() {
        assert_eq!(spread(1, 5), [0]);
        assert_eq!(spread(4, 5), [0, 1, 2, 3]);
        for count in [6, 12, 100, 10_000_000] {
            let scenes = spread(count, 5);
            assert_eq!(scenes.len(), 5, "of {count}: {scenes:?}");
            assert!(scenes.windows(2).all(|pair| pair[0] < pair[1]) && scenes[4] < count, "{scenes:?}");
            let widest = scenes.windows(2).map(|pair| pair[1] - pair[0]).max().expect("four gaps");
            assert!(widest <= count / 3 + 1, "of {count}: {scenes:?}");
        }
    }
}
