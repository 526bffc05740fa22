//! A progress bar on a terminal.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use crate::Result;
use crate::solver::simulation::{Flow, Observer, Simulation};
use crate::study::Progress;
use crate::study::calibration::Onlooker;
use indicatif::{ProgressBar, ProgressStyle};

/// Parts into which the bar is divided.
const PARTS: u64 = 1000;

/// Shows how many scenes are done, how fast and how long the rest will take; draws nothing unless stderr is a terminal.
#[derive(Debug)]
pub struct SceneProgress {
    bar: ProgressBar,
    failed: AtomicU64,
}

impl Default for SceneProgress {
    fn default() -> Self {
        let bar = ProgressBar::new(0);
        let template = "{bar:30} {pos}/{len} scenes  {per_sec}  {eta} left  {msg}";
        bar.set_style(ProgressStyle::with_template(template).expect("the template is well formed"));
        bar.enable_steady_tick(Duration::from_millis(200));
        Self { bar, failed: AtomicU64::new(0) }
    }
}

impl Progress for SceneProgress {
    fn begin(&self, scenes: u64) {
        self.bar.set_length(scenes);
        self.bar.reset_eta();
    }

    fn done(&self, failed: bool) {
        self.bar.inc(1);
        if failed {
            let count = self.failed.fetch_add(1, Ordering::Relaxed) + 1;
            self.bar.set_message(format!("{count} failed"));
        }
    }
}

impl Drop for SceneProgress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Shows how often the model was run and the misfit, then how many runs of a scene that is foretold are done; draws nothing unless stderr is a
/// terminal.
#[derive(Debug)]
pub struct CalibrationProgress {
    bar: ProgressBar,
}

impl Default for CalibrationProgress {
    fn default() -> Self {
        let bar = ProgressBar::new_spinner();
        let template = "{spinner} {elapsed}  {msg}";
        bar.set_style(ProgressStyle::with_template(template).expect("the template is well formed"));
        bar.enable_steady_tick(Duration::from_millis(200));
        Self { bar }
    }
}

impl Onlooker for CalibrationProgress {
    fn misfit(&self, runs: u64, reduced: f64) {
        if !self.bar.is_hidden() {
            self.bar.set_message(format!("{runs} runs of the model  misfit {reduced:.4e} for each value"));
        }
    }
}

impl Progress for CalibrationProgress {
    fn begin(&self, scenes: u64) {
        let template = "{bar:30} {pos}/{len} runs of the scene that is foretold  {eta} left";
        self.bar.set_style(ProgressStyle::with_template(template).expect("the template is well formed"));
        self.bar.set_length(scenes);
    }

    fn done(&self, _failed: bool) {
        self.bar.inc(1);
    }
}

impl Drop for CalibrationProgress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Shows cycles, τ, worn volume and the distance to the limit on stderr while a simulation runs; draws nothing unless that is a terminal.
pub struct RunProgress {
    bar: ProgressBar,
}

impl Default for RunProgress {
    fn default() -> Self {
        let bar = ProgressBar::new(PARTS);
        bar.set_style(
            ProgressStyle::with_template("{bar:30} {elapsed} {msg}").expect("the template is well formed"),
        );
        bar.enable_steady_tick(Duration::from_millis(200));
        Self { bar }
    }
}

impl Drop for RunProgress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

impl Observer for RunProgress {
    fn step(&mut self, simulation: &Simulation) -> Result<Flow> {
        if self.bar.is_hidden() {
            return Ok(Flow::Continue);
        }
        let (model, state) = (simulation.model(), simulation.state());
        let left = model
            .limit_depth()
            .iter()
            .zip(&simulation.wear_depth())
            .fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
        self.bar.set_position((simulation.done() * PARTS as f64) as u64);
        self.bar.set_message(format!(
            "cycle {:.4e}  τ {:.4}  worn {:.4e} m³  distance {:.1e}",
            state.cycles,
            state.cycles * model.contact().tau_per_cycle(),
            model.wear_volume(simulation.fields()),
            left / model.depth_scale()
        ));
        Ok(Flow::Continue)
    }
}
