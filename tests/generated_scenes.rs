//! Random scenes of every kind: `check` and `run` agree, every refusal names a key, no number is none, nothing panics.

mod support;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use fretwear::Error;
use fretwear::report::CheckReport;
use fretwear::run::{Run, Shared};
use fretwear::scene::schema::is_key;
use fretwear::simulation::{Flow, Observer, Simulation};
use fretwear::snapshot::Snapshot;
use support::scenes::{Length, RandomScene};

/// Wall time after which a run is stopped: its plan may be long, only its steps have to come to an end.
const LONG_ENOUGH: Duration = Duration::from_secs(2);

/// What became of a scene.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
enum End {
    /// Its text is refused.
    Unread,
    /// Refused before the first step.
    Refused,
    Ran,
    /// Stopped on the way.
    Stopped,
    Failed,
}

/// Stops a run that takes long.
struct Patience(Instant);

impl Observer for Patience {
    fn step(&mut self, _: &Simulation) -> fretwear::Result<Flow> {
        Ok(if self.0.elapsed() > LONG_ENOUGH { Flow::Stop } else { Flow::Continue })
    }
}

/// Whether a refusal names a key of scenes.
fn names_a_key(error: &Error) -> bool {
    let name = match error {
        Error::Inconsistent { what, .. } => what,
        Error::OutOfRange { name, .. } => name,
        _ => return false,
    };
    is_key(name)
}

fn numbers_are_numbers(snapshot: &Snapshot) -> bool {
    let Snapshot { wear_volume, contact_radius, stick_radius, indentation, normal_force, .. } = snapshot;
    let values =
        [wear_volume, contact_radius, stick_radius, indentation, normal_force, &snapshot.dissipated_energy];
    values.into_iter().chain(&snapshot.wear_depth).chain(&snapshot.profile).all(|value| value.is_finite())
}

/// Reads, checks and runs a scene; what became of it, or what is wrong.
fn judge(random: &RandomScene) -> Result<(End, String), String> {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = match random.read(folder.path()) {
        Ok(scene) => scene,
        Err(error @ (Error::Scene(_) | Error::File { .. })) => return Ok((End::Unread, error.to_string())),
        Err(error) => return Err(format!("read with an error that shows no place: {error}")),
    };
    let begun = Instant::now();
    let checked = CheckReport::new(&scene);
    let seconds = begun.elapsed().as_secs_f64();
    if seconds > 1.0 {
        println!("seed {}: check took {seconds:.1} s", random.seed);
    }
    let shared = Shared::default();
    let run = Run::one_of_many(&scene, &folder.path().join("run.h5"), &shared);
    let run = match (checked, run) {
        (Ok(_), Ok(run)) => run,
        (Err(check), Err(run)) => {
            let [check_words, words] = [&check, &run].map(|error| error.to_string());
            if check_words != words {
                return Err(format!("check says {check_words:?}, run says {words:?}"));
            }
            if !names_a_key(&run) {
                return Err(format!("refused without a key: {words}"));
            }
            return Ok((End::Refused, words));
        }
        (Ok(_), Err(error)) => return Err(format!("check says yes, run says {error}")),
        (Err(error), Ok(_)) => return Err(format!("run says yes, check says {error}")),
    };
    match run.execute_keeping(Some(&mut Patience(Instant::now()))) {
        Ok((result, file)) => {
            if let Some(off) = file.snapshots.iter().find(|snapshot| !numbers_are_numbers(snapshot)) {
                return Err(format!("not a number at τ = {}", off.tau));
            }
            let stopped = result.stop_reason == fretwear::snapshot::StopReason::Interrupted;
            Ok(if stopped {
                (
                    End::Stopped,
                    format!(
                        "τ = {:e}, {} steps, {} evaluations",
                        result.last.tau,
                        result.checkpoint.progress.steps,
                        result.checkpoint.progress.rate_evaluations
                    ),
                )
            } else {
                (End::Ran, String::new())
            })
        }
        Err(error) => {
            let words = error.to_string();
            let names_the_moment = ["τ = ", "cycle ", "radius"].iter().all(|part| words.contains(part));
            if !(names_the_moment && matches!(error, Error::NotConverged { .. })) {
                return Err(format!("fails without the moment: {words}"));
            }
            Ok((End::Failed, words))
        }
    }
}

/// Judges scenes; all that is wrong is shown at once.
fn judge_all(seeds: std::ops::Range<u64>, length: Length) {
    let count = seeds.end - seeds.start;
    let mut tally = std::collections::BTreeMap::<End, u64>::new();
    let mut wrong = vec![];
    for seed in seeds {
        let random = RandomScene::new(seed, length);
        let begun = Instant::now();
        let judged = catch_unwind(AssertUnwindSafe(|| judge(&random)));
        let seconds = begun.elapsed().as_secs_f64();
        match judged {
            Ok(Ok((end, words))) => {
                if std::env::var_os("FRETWEAR_SHOW").is_some() && (end != End::Ran || seconds > 1.0) {
                    println!("seed {seed}: {end:?} {seconds:.2} s {words}");
                }
                *tally.entry(end).or_default() += 1;
            }
            Ok(Err(why)) => wrong.push(format!("seed {seed}: {why}")),
            Err(_) => wrong.push(format!("seed {seed}: panics")),
        }
    }
    println!("{tally:?}, {} of {count} wrong", wrong.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let refused = tally.get(&End::Unread).unwrap_or(&0) + tally.get(&End::Refused).unwrap_or(&0);
    assert!(2 * refused < count, "most scenes are refused: {tally:?}");
}

#[test]
fn random_scenes_are_checked_as_they_are_run() {
    judge_all(0..200, Length::Short);
}

#[test]
#[ignore = "20,000 scenes, hours"]
fn twenty_thousand_random_scenes_are_checked_as_they_are_run() {
    judge_all(0..20_000, Length::Usual);
}
