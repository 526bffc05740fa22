//! Runs in parts, which must come to the same as whole ones.

use std::path::Path;

use fretwear::Stop;
use fretwear::data::{RunFile, StopReason};
use fretwear::run::{Results, Resumed, Run};
use fretwear::scene::Scene;
use fretwear::solver::simulation::{Flow, Observer, Simulation};

/// Stops after some steps.
struct StopAfter(u64);

impl Observer for StopAfter {
    fn step(&mut self, _: &Simulation) -> fretwear::Result<Flow> {
        self.0 -= 1;
        Ok(if self.0 == 0 { Flow::Stop } else { Flow::Continue })
    }
}

/// A run as its file has it, but for the wall time.
fn without_wall_time(path: &Path) -> RunFile {
    let mut file = RunFile::open(path).expect("a run");
    file.checkpoint.as_mut().expect("a checkpoint").wall_seconds = 0.0;
    // Pressure where the ground has come to stick and ratios of loops off the axis are not numbers, which equal nothing; none is negative.
    let unknown = file.snapshots.iter_mut().flat_map(|snapshot| {
        snapshot.pressure.iter_mut().chain([&mut snapshot.energy_ratio, &mut snapshot.sliding_ratio])
    });
    unknown.filter(|value| value.is_nan()).for_each(|value| *value = -1.0);
    file
}

/// Runs a scene whole, and once more stopped after every few steps; what the first came to, the files of both but for the wall time, and
/// the number of interruptions.
pub fn whole_and_in_parts(scene: &Scene, folder: &Path, steps: u64) -> (Results, [RunFile; 2], usize) {
    let [whole, parts] = ["whole.h5", "parts.h5"].map(|name| folder.join(name));
    let result =
        Run::new(scene, &whole, false, &Stop::default()).expect("a run").execute(None).expect("an end");
    let mut run = Run::new(scene, &parts, false, &Stop::default()).expect("a run");
    let mut interruptions = 0;
    while run.execute(Some(&mut StopAfter(steps))).expect("an end").stop_reason() == StopReason::Interrupted {
        interruptions += 1;
        run = match Run::resume(&parts, &Stop::default()).expect("a run that goes on") {
            Resumed::Run(run) => *run,
            Resumed::Complete(_) => panic!("interrupted and complete"),
        };
    }
    (result, [whole, parts].map(|path| without_wall_time(&path)), interruptions)
}
