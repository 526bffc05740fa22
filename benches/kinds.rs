//! Whether every kind of scene is as accurate as was asked: the actual error beside the asked and the estimated one.
//!
//! `cargo bench --bench kinds [-- PART-OF-A-NAME ...]` prints the table of docs/accuracy.md and writes kinds.csv: every law, control and mode at 1e-2, 1e-3
//! and 1e-4, judged by a run with about four times the springs of the last by hand, a tenth of its tolerance and 768 substeps. References that take longer than
//! two minutes are replaced by ones on half of the springs; they are kept in `target/kinds` from one call to the next.
//!
//! `cargo bench --bench kinds -- cost [PART-OF-A-NAME ...]` prints what each takes over the plain scene instead, one beside the other, without references.
//!
//! Errors are the largest over all snapshots, of the worn volume relative to the limit's, or of the profile at any radius of the run relative to the limit's
//! largest depth; without a limit, relative to the largest of the reference. Where an edge of stick moves over the ground the profile's is
//! the distance of the curves, as in docs/accuracy.md.

#[path = "kinds/shown.rs"]
mod shown;

use std::collections::hash_map::DefaultHasher;
use std::fmt::Write as _;
use std::hash::{Hash, Hasher};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use fretwear::scene::Scene;
use fretwear::solver::simulation::Observer;
use fretwear::{Results, Simulation, Stop};

use shown::{Dense, Shown, errors};

const ACCURACIES: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// Springs of a reference over those of the run at the last accuracy, the most of them, where periods are resolved and in gross slip as well, and what it may take.
const FINER: usize = 4;
const MOST_SPRINGS: usize = 480;
const MOST_RESOLVED: usize = 240;
const MOST_IN_GROSS_SLIP: usize = 120;
const PATIENCE: Duration = Duration::from_secs(120);

/// Springs of a reference over those of the run at the last accuracy, even where that is more than the most.
const LEAST_FINER: usize = 2;

/// What is kept of a reference, and by which code; another number asks for all of them anew.
const FORMAT: u32 = 2;

/// Runs of which the fastest counts, where they are short.
const ROUNDS: usize = 3;
const SHORT: f64 = 0.3;

/// Pairs of runs, of a kind and of the plain scene, whose median ratio counts.
const PAIRS: usize = 7;

const FRICTION: &str = "[friction.coulomb]\ncoefficient = 0.5\n";
const WEAR: &str = "[wear.archard]\ncoefficient = 1.667e-13\n";
const PARABOLOID: &str = "[indenter.paraboloid]\nradius = 1.0\n";
const FORCE: &str = "normal_force = 266.6666666666667";
const OUT_OF_PHASE: &str =
    "[loading.normal_oscillation]\namplitude_ratio = 0.1\nfrequency_ratio = 1\nphase = 1.5707963\n";
const TWICE: &str = "[loading.normal_oscillation]\namplitude_ratio = 0.1\nfrequency_ratio = 2\nphase = 1.0\n";
const LOAD_DEPENDENT: &str = "[friction.load-dependent]\ncoefficient = 0.5\nexponent = 0.3\n";
const STATIC: &str = "[friction.static-kinetic]\nstatic_coefficient = 0.5\nkinetic_coefficient = 0.4\n";
const THRESHOLD: &str = "[wear.threshold]\ncoefficient = 1.667e-13\npressure = 1e7\n";
const SPREAD: &str = "[wear.non-local]\ncoefficient = 1.667e-13\nlength = 1e-4\n";

/// A kind of scene; what is not said is plain.
#[derive(Clone, Copy)]
struct Kind {
    name: &'static str,
    indenter: &'static str,
    grading: f64,
    friction: &'static str,
    wear: &'static str,
    load: &'static str,
    amplitude: &'static str,
    tau: f64,
    more: &'static str,
    numerics: &'static str,
    /// Whether an edge moves over the ground, or is where a sampled path says, so that a radius is known to the error as well.
    moves: bool,
}

const PLAIN: Kind = Kind {
    name: "plain",
    indenter: PARABOLOID,
    grading: 0.0,
    friction: FRICTION,
    wear: WEAR,
    load: "indentation = 1e-6",
    amplitude: "stick_ratio = 0.7",
    tau: 3.0,
    more: "",
    numerics: "",
    moves: false,
};

const MOVING: Kind = Kind { moves: true, ..PLAIN };
const SLIDING: Kind = Kind { amplitude: "amplitude_ratio = 2.0", tau: 1.0, ..MOVING };

const KINDS: &[Kind] = &[
    PLAIN,
    Kind {
        name: "cone, k = 0.6",
        indenter: "[indenter.cone]\nslope = 1e-3\n",
        grading: 0.6,
        tau: 10.0,
        ..PLAIN
    },
    Kind {
        name: "n = 4, k = -0.4",
        indenter: "[indenter.power-law]\ncoefficient = 1e6\nexponent = 4\n",
        grading: -0.4,
        ..PLAIN
    },
    Kind {
        name: "measured profile",
        indenter: "[indenter.table]\nfile = \"data/scenes/measured_profile.csv\"\nradius_unit = \"mm\"\nprofile_unit = \"um\"\n",
        ..PLAIN
    },
    Kind { name: "cycle-jump", numerics: "stepper = \"cycle-jump\"\n", tau: 1.0, ..PLAIN },
    Kind { name: "first cycle counted", more: "wear_from = \"first-cycle\"\n", ..PLAIN },
    Kind { name: "normal force held", load: FORCE, ..MOVING },
    Kind { name: "normal force held, τ = 10", load: FORCE, tau: 10.0, ..MOVING },
    Kind { name: "tangential force held", more: "tangential_control = \"force\"\n", ..MOVING },
    Kind { name: "both forces held", load: FORCE, more: "tangential_control = \"force\"\n", ..PLAIN },
    Kind { name: "rig, half the contact's stiffness", more: "rig_stiffness = 1.3333333e8\n", ..MOVING },
    Kind { name: "rig, twice", more: "rig_stiffness = 5.3333333e8\n", ..MOVING },
    Kind {
        name: "rising friction",
        friction: "[friction.coulomb]\ncoefficient = 0.5\n[friction.history]\nfinal_factor = 2.0\ntau = 1.5\n",
        ..MOVING
    },
    Kind {
        name: "falling friction",
        friction: "[friction.coulomb]\ncoefficient = 0.5\n[friction.history]\nfinal_factor = 0.8\ntau = 1.5\n",
        ..MOVING
    },
    Kind {
        name: "rig and rising friction",
        friction: "[friction.coulomb]\ncoefficient = 0.5\n[friction.history]\nfinal_factor = 1.3\ntau = 1.5\n",
        more: "rig_stiffness = 5.3333333e8\n",
        ..MOVING
    },
    Kind {
        name: "friction that grows with wear",
        friction: "[friction.wear-dependent]\nfirst_coefficient = 0.5\nlast_coefficient = 0.6\nenergy_density = 1e3\n",
        ..MOVING
    },
    Kind {
        name: "blocks that shrink",
        more: "[[loading.blocks]]\ntau = 1\n[[loading.blocks]]\ntau = 1\namplitude_factor = 0.5\n",
        ..MOVING
    },
    Kind {
        name: "blocks that grow",
        more: "[[loading.blocks]]\ntau = 1\n[[loading.blocks]]\ntau = 1\namplitude_factor = 1.3\n",
        ..PLAIN
    },
    Kind {
        name: "blocks repeated",
        more: "repeat = true\n[[loading.blocks]]\ntau = 0.5\n[[loading.blocks]]\ntau = 0.5\namplitude_factor = 0.5\n",
        ..PLAIN
    },
    Kind {
        name: "deeper blocks, repeated",
        more: "repeat = true\n[[loading.blocks]]\ntau = 1\n[[loading.blocks]]\ntau = 1\nindentation_factor = 1.2\n",
        ..PLAIN
    },
    Kind { name: "normal oscillation, ratio 2", more: TWICE, ..PLAIN },
    Kind { name: "normal oscillation, out of phase", more: OUT_OF_PHASE, ..PLAIN },
    Kind { name: "normal oscillation, k = 0.5", more: TWICE, grading: 0.5, ..PLAIN },
    Kind { name: "normal oscillation, τ = 20", more: OUT_OF_PHASE, tau: 20.0, ..PLAIN },
    Kind {
        name: "out of phase, load-dependent friction",
        friction: LOAD_DEPENDENT,
        more: OUT_OF_PHASE,
        ..MOVING
    },
    Kind { name: "out of phase, threshold", wear: THRESHOLD, more: OUT_OF_PHASE, ..PLAIN },
    Kind { name: "orbit", more: "[loading.orbit]\ntransverse_ratio = 0.6\n", ..PLAIN },
    Kind {
        name: "circle, k = 0.3",
        more: "[loading.orbit]\ntransverse_ratio = 1.0\n",
        grading: 0.3,
        ..PLAIN
    },
    Kind {
        name: "orbit along a diagonal, k = 0.3",
        more: "[loading.orbit]\ntransverse_ratio = 1.0\nphase = 1.5707963\n",
        grading: 0.3,
        ..PLAIN
    },
    Kind {
        name: "orbit, static and kinetic friction",
        friction: STATIC,
        more: "[loading.orbit]\ntransverse_ratio = 0.6\n",
        ..PLAIN
    },
    Kind { name: "load-dependent friction", friction: LOAD_DEPENDENT, ..PLAIN },
    Kind { name: "static and kinetic friction", friction: STATIC, ..PLAIN },
    Kind { name: "threshold", wear: THRESHOLD, ..PLAIN },
    Kind {
        name: "threshold, three times as high, τ = 20",
        wear: "[wear.threshold]\ncoefficient = 1.667e-13\npressure = 3e7\n",
        tau: 20.0,
        ..PLAIN
    },
    Kind { name: "threshold, k = -0.4", wear: THRESHOLD, grading: -0.4, ..PLAIN },
    Kind { name: "threshold, normal force held", wear: THRESHOLD, load: FORCE, ..MOVING },
    Kind { name: "non-local", wear: SPREAD, ..PLAIN },
    Kind {
        name: "non-local, a tenth as wide, k = 0.3",
        wear: "[wear.non-local]\ncoefficient = 1.667e-13\nlength = 1e-5\n",
        grading: 0.3,
        ..PLAIN
    },
    Kind {
        name: "p^1.5 s^0.5",
        wear: "[wear.power-law]\ncoefficient = 1e-22\npressure_exponent = 1.5\nslip_exponent = 0.5\n",
        ..PLAIN
    },
    Kind {
        name: "p s^2",
        wear: "[wear.power-law]\ncoefficient = 3e-7\npressure_exponent = 1\nslip_exponent = 2\n",
        ..PLAIN
    },
    Kind {
        name: "p^0.7 s^0.8",
        wear: "[wear.power-law]\ncoefficient = 1e-12\npressure_exponent = 0.7\nslip_exponent = 0.8\n",
        tau: 1.0,
        ..PLAIN
    },
    Kind { name: "dissipated energy", wear: "[wear.dissipated-energy]\ncoefficient = 3.3e-13\n", ..PLAIN },
    Kind {
        name: "friction power",
        wear: "[wear.friction-power]\ncoefficient = 3.3e-13\nexponent = -0.25\nscope = \"local\"\n",
        more: "frequency = 10\n",
        ..PLAIN
    },
    Kind {
        name: "wear that falls",
        wear: "[wear.archard]\ncoefficient = 1.667e-13\n[wear.history]\nfinal_factor = 0.2\ntau = 1.5\n",
        ..PLAIN
    },
    SLIDING,
    Kind { name: "gross slip, normal force held", load: FORCE, ..SLIDING },
];

impl Kind {
    fn scene(&self, numerics: &str) -> fretwear::Result<Scene> {
        let Self { indenter, grading, friction, wear, load, amplitude, tau, more, numerics: own, .. } = self;
        // Keys of [loading] go before its tables.
        let text = format!(
            "{indenter}[half_space]\ngrading = {grading}\nnormal_stiffness = 2e11\nstiffness_ratio = 0.6666666666666666\n{friction}{wear}[loading]\n{load}\n\
             {amplitude}\ntau = {tau}\n{more}\n[numerics]\n{own}{numerics}\n[output]\nsnapshots = 12\n"
        );
        Scene::from_toml(&text, "kind.toml")
    }
}

/// A run, stopped when it takes too long.
fn run(scene: &Scene, patience: Duration, observer: Option<&mut dyn Observer>) -> Result<Results, String> {
    let stop = Stop::default();
    std::thread::scope(|scope| {
        let (done, waits) = std::sync::mpsc::channel::<()>();
        let token = stop.clone();
        scope.spawn(move || {
            let _ = waits.recv_timeout(patience);
            token.stop();
        });
        let results = Simulation::new(scene).and_then(|it| it.stopped_by(&stop).run_with(observer));
        drop(done);
        match results {
            Ok(results) if results.is_complete() => Ok(results),
            Ok(_) => Err("none in time".into()),
            Err(error) => Err(error.to_string()),
        }
    })
}

/// The reference, as kept or made.
fn reference(kind: &Kind, springs: usize) -> Option<Shown> {
    let sliding = kind.amplitude.starts_with("amplitude_ratio");
    let resolved = kind.more.contains("oscillation]") || kind.more.contains("orbit]");
    let most = match (sliding, resolved) {
        (true, _) => MOST_IN_GROSS_SLIP,
        (false, true) => MOST_RESOLVED,
        (false, false) => MOST_SPRINGS,
    };
    let stepper = if kind.numerics.is_empty() { "" } else { "by default" };
    // A reference of an explicit stepper is an implicit one.
    let kind = Kind { numerics: "", ..*kind };
    // One that the program raised further needs a finer judge yet.
    let finest = (FINER * springs).min(most.max(LEAST_FINER * springs));
    for springs in [finest, finest * 3 / 4, finest / 2] {
        let mut numerics = format!("springs = {springs}\ntolerance = 3e-6\n");
        if resolved {
            numerics += "substeps = 768\n";
        }
        let scene = kind.scene(&numerics).ok()?;
        let mut hasher = DefaultHasher::new();
        (scene.text(), stepper, FORMAT).hash(&mut hasher);
        let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/target/kinds"));
        let file = folder.join(format!("{:016x}.txt", hasher.finish()));
        if let Ok(text) = std::fs::read_to_string(&file) {
            match Shown::read(&text) {
                Some(shown) => return Some(shown),
                None => continue,
            }
        }
        std::fs::create_dir_all(&folder).ok()?;
        let mut dense = Dense::default();
        match run(&scene, PATIENCE, Some(&mut dense)) {
            Ok(results) => {
                let Dense { radius, seen, edges, .. } = dense;
                let shown = Shown { radius, seen, edges, ..Shown::of(&results) };
                std::fs::write(&file, shown.written()).ok()?;
                return Some(shown);
            }
            Err(why) => std::fs::write(&file, why).ok()?,
        }
    }
    None
}

/// Times of a kind over those of the plain scene, each beside one of it, and the median of the kind's, s.
fn cost(kind: &Kind, accuracy: f64) -> fretwear::Result<[f64; 2]> {
    let numerics = format!("accuracy = {accuracy}");
    let (scene, plain) = (kind.scene(&numerics)?, PLAIN.scene(&numerics)?);
    let mut pairs: Vec<[f64; 2]> = (0..PAIRS)
        .map(|_| {
            let seconds = timed(&scene).1;
            [seconds / timed(&plain).1, seconds]
        })
        .collect();
    let mut median = |of: usize| {
        pairs.sort_by(|a, b| a[of].total_cmp(&b[of]));
        pairs[PAIRS / 2][of]
    };
    Ok([median(0), median(1)])
}

/// The name of a kind that differs from the plain scene.
fn name_of(kind: &Kind) -> &'static str {
    let slides = kind.amplitude == SLIDING.amplitude && kind.name == "plain";
    if slides { "gross slip" } else { kind.name }
}

fn costs(wanted: &[String]) {
    println!("| kind | times plain at {ACCURACIES:?} | seconds |\n|---|---|---|");
    for kind in KINDS {
        let name = name_of(kind);
        if !wanted.is_empty() && !wanted.iter().any(|it| name.contains(it.as_str())) {
            continue;
        }
        let found = ACCURACIES.map(|accuracy| cost(kind, accuracy).unwrap_or([f64::NAN; 2]));
        let [times, seconds] = [0, 1].map(|of| found.map(|it| format!("{:.3}", it[of])).join(", "));
        println!("| {name} | {times} | {seconds} |");
    }
}

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|it| !it.starts_with('-')).collect();
    if let Some(("cost", wanted)) = wanted.split_first().map(|(first, rest)| (first.as_str(), rest)) {
        return costs(wanted);
    }
    let plain = |accuracy: f64| {
        let scene = PLAIN.scene(&format!("accuracy = {accuracy}")).expect("valid");
        (0..5).map(|_| timed(&scene).1).fold(f64::INFINITY, f64::min)
    };
    let plain = ACCURACIES.map(plain);
    let mut csv = String::from(
        "kind,asked,volume_error,profile_error,radius,tau,estimate,met,springs,reference_springs,steps,seconds,times_plain\n",
    );
    println!(
        "| kind | asked | volume | profile | at r/a0, τ | estimate | met | springs | finer | steps | seconds | times plain |\n|---|---|---|---|---|---|---|---|---|---|---|---|"
    );
    let mut counts = [0; 5];
    for kind in KINDS {
        let name = name_of(kind);
        if !wanted.is_empty() && !wanted.iter().any(|it| name.contains(it.as_str())) {
            continue;
        }
        let runs = ACCURACIES.map(|accuracy| {
            kind.scene(&format!("accuracy = {accuracy}")).map_err(|error| error.to_string()).and_then(
                |scene| {
                    let (results, mut seconds) = timed(&scene);
                    if seconds < SHORT {
                        seconds = (1..ROUNDS).map(|_| timed(&scene).1).fold(seconds, f64::min);
                    }
                    results.map(|it| (it, seconds))
                },
            )
        });
        let finest = runs.iter().flatten().map(|(it, _)| it.springs()).max().unwrap_or(120);
        let reference = reference(kind, finest);
        for ((accuracy, run), plain) in ACCURACIES.iter().zip(&runs).zip(plain) {
            let (results, seconds) = match run {
                Ok(found) => found,
                Err(why) => {
                    println!("| {name} | {accuracy:.0e} | {why} |");
                    continue;
                }
            };
            let Some(reference) = &reference else {
                println!("| {name} | {accuracy:.0e} | no reference |");
                continue;
            };
            let ([volume, profile], [radius, tau]) = errors(&Shown::of(results), reference, kind.moves);
            let (estimate, met) = (results.error_estimate(), results.accuracy_met());
            let actual = volume.max(profile);
            let within = actual <= *accuracy;
            let told = met != Some(true);
            let near = estimate.is_some_and(|it| it <= 5.0 * actual && it >= 0.2 * actual);
            let judged = [true, within, !within && told, within && told, near];
            counts.iter_mut().zip(judged).for_each(|(count, so)| *count += usize::from(so));
            let mark = match (within, told) {
                (false, false) => " BROKEN",
                (true, true) => " needless",
                _ => "",
            };
            let shown = estimate.map_or("none".into(), |it| format!("{it:.1e}"));
            let times = seconds / plain;
            let (springs, finer, steps) = (results.springs(), reference.springs, results.steps());
            println!(
                "| {name} | {accuracy:.0e} | {volume:.1e} | {profile:.1e}{mark} | {radius:.5}, {tau:.2} | {shown}{} | {} | {springs} | {finer} | {steps} | {seconds:.3} | {times:.1} |",
                if near { "" } else { " off" },
                if told { "no" } else { "yes" },
            );
            writeln!(
                csv,
                "\"{name}\",{accuracy:e},{volume:e},{profile:e},{radius},{tau},{},{},{springs},{finer},{steps},{seconds},{times}",
                estimate.map_or(String::new(), |it| format!("{it:e}")),
                !told
            )
            .expect("text");
        }
    }
    let [all, within, told, needless, near] = counts;
    println!(
        "\n{all} runs: {within} within, {told} others told, {needless} told without need, estimate within a factor of five in {near}"
    );
    if wanted.is_empty() {
        std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/benches/kinds.csv"), csv).expect("writable");
    }
}

/// A run and its time, s.
fn timed(scene: &Scene) -> (Result<Results, String>, f64) {
    let begun = Instant::now();
    let results = run(scene, PATIENCE, None);
    (results, begun.elapsed().as_secs_f64())
}
