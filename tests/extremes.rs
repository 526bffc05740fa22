//! The ends of every range, as whole runs: each comes to the closed form or is refused before any work (docs/extremes.md).

mod support;

use std::fs;
use std::path::Path;

use fretwear::Error;
use fretwear::data::{RunFile, Snapshot, StopReason};
use fretwear::report::CheckReport;
use fretwear::run::{Results, Run, Stop};
use fretwear::scene::Scene;
use support::command;

/// A power law on a graded half-space in partial slip, scaled in length and in stiffness.
#[derive(Clone)]
struct Extreme {
    grading: f64,
    exponent: f64,
    amplitude: String,
    end: String,
    numerics: String,
    /// `k_w`, 1/Pa, over the stiffness.
    wear: f64,
    length: f64,
    stiffness: f64,
}

impl Default for Extreme {
    fn default() -> Self {
        Self {
            grading: 0.0,
            exponent: 2.0,
            amplitude: "stick_ratio = 0.7".into(),
            end: "until_rate = 1e-11".into(),
            numerics: "accuracy = 1e-3".into(),
            wear: 1e-14,
            length: 1.0,
            stiffness: 1.0,
        }
    }
}

impl Extreme {
    fn text(&self) -> String {
        let (length, stiffness) = (self.length, self.stiffness);
        format!(
            "[indenter.power-law]\ncoefficient = {:e}\nexponent = {}\n[half_space]\ngrading = {}\nnormal_stiffness = {:e}\n\
             stiffness_ratio = 1.0\n[friction.coulomb]\ncoefficient = 0.5\n[wear.archard]\ncoefficient = {:e}\n[loading]\n\
             indentation = {:e}\n{}\n{}\n[numerics]\n{}\n[output]\nsnapshots = 3\n",
            1e-2 * length.powf(1.0 - self.exponent),
            self.exponent,
            self.grading,
            1e11 * stiffness * length.powf(-self.grading),
            self.wear / stiffness,
            1e-4 * length,
            self.amplitude,
            self.end,
            self.numerics,
        )
    }

    /// Runs to the end; what is refused before that must leave nothing behind.
    fn run_to(&self, output: &Path) -> fretwear::Result<Results> {
        let scene = Scene::from_toml(&self.text(), "extreme.toml")?;
        let run = Run::new(&scene, output, false, &Stop::default())
            .inspect_err(|_| assert!(!output.exists(), "refused and written"))?;
        run.execute(None)
    }

    fn run(&self) -> fretwear::Result<Results> {
        let folder = tempfile::tempdir().expect("a folder");
        self.run_to(&folder.path().join("run.h5"))
    }

    /// Why the scene is refused.
    fn refusal(&self) -> String {
        match self.run() {
            Err(error @ Error::NotConverged { .. }) => panic!("{error}"),
            Err(error) => error.to_string(),
            Ok(result) => panic!("ran to {:?}", result.stop_reason()),
        }
    }
}

/// How far a run ended from the closed form, each relative to the limit's own: largest depth, worn volume, contact radius.
#[derive(Debug, Clone, Copy)]
struct Off {
    depth: f64,
    volume: f64,
    radius: f64,
}

impl Off {
    fn of(result: &Results) -> Self {
        let limit = result.limit().expect("a closed form");
        let relative = |found: f64, known: f64| (found / known - 1.0).abs();
        Self {
            depth: result.distance().and_then(|it| it.distance_relative).expect("a limit"),
            volume: relative(result.last().wear_volume, limit.wear_volume()),
            radius: relative(result.last().contact_radius, limit.contact_radius_limit()),
        }
    }

    fn largest(self, other: Self) -> Self {
        // A comparison with what is not a number is false, so that it is kept.
        let worse = |a: f64, b: f64| if a <= b { b } else { a };
        Self {
            depth: worse(self.depth, other.depth),
            volume: worse(self.volume, other.volume),
            radius: worse(self.radius, other.radius),
        }
    }

    fn within(&self, depth: f64, volume: f64, radius: f64) -> bool {
        self.depth <= depth && self.volume <= volume && self.radius <= radius
    }
}

/// Runs all; the worst ends.
fn worst(cases: impl IntoIterator<Item = Extreme>) -> Off {
    let mut most = Off { depth: 0.0, volume: 0.0, radius: 0.0 };
    for case in cases {
        let result = case.run().unwrap_or_else(|error| panic!("{}: {error}", case.text()));
        let off = Off::of(&result);
        println!(
            "k {} n {} {}: {off:?} {:?} after {} steps",
            case.grading,
            case.exponent,
            case.amplitude,
            result.stop_reason(),
            result.checkpoint().progress.steps
        );
        most = most.largest(off);
    }
    println!("worst {most:?}");
    most
}

fn grading(grading: f64) -> Extreme {
    // As k → 1 the ground next to the edge of stick wears long after the rest: a time, not a rate, brings it to the limit.
    let end = if grading > 0.0 { "tau = 1e4" } else { "until_rate = 1e-11" };
    Extreme { grading, end: end.into(), ..Extreme::default() }
}

#[test]
fn gradings_towards_one_and_minus_one_end_at_the_limit() {
    let towards = [0.9, 0.99, 0.999, 0.9999];
    let off = worst(towards.into_iter().flat_map(|k| [grading(k), grading(-k)]));
    // Measured: 2.4e-12, 4.2e-5, 3.1e-13; the accuracy asked for is 1e-3.
    assert!(off.within(2e-11, 4e-4, 3e-12), "{off:?}");
}

const AMPLITUDES: [f64; 8] = [1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 1.0 - 1e-2, 1.0 - 1e-4, 1.0 - 1e-6];

fn ratio(amplitude: f64) -> String {
    format!("amplitude_ratio = {amplitude:?}")
}

#[test]
fn amplitudes_from_nearly_nothing_to_nearly_full_sliding_end_at_the_limit() {
    let off = worst(AMPLITUDES.map(|it| Extreme { amplitude: ratio(it), ..Extreme::default() }));
    assert!(off.within(2e-11, 1e-3, 3e-12), "{off:?}");
}

#[test]
fn a_rig_behind_a_contact_that_hardly_slips_leaves_its_wear_as_it_is() {
    // What slips bears next to nothing, so that the balance of forces with the rig holds the amplitude.
    let at = |amplitude: String| {
        let (end, numerics) = ("tau = 0.3".into(), "accuracy = 1e-2".into());
        Extreme { amplitude, end, numerics, ..Extreme::default() }.run().expect("a run")
    };
    let rig = at("amplitude_ratio = 1e-4\nrig_stiffness = 1e9".into());
    let first = &rig.snapshots()[0];
    let held = at(format!("stick_ratio = {:?}", first.stick_radius / first.contact_radius));
    let off = rig.last().wear_volume / held.last().wear_volume - 1.0;
    assert_eq!(rig.accuracy_met(), Some(true), "estimate {:?}", rig.error_estimate());
    assert!(off.abs() < 1e-2, "off by {off:e}");
}

#[test]
fn an_annulus_narrower_than_rounding_beside_an_edge_of_stick_that_moves_is_refused() {
    let numerics = "accuracy = 1e-2\n[friction.history]\nfinal_factor = 1.2\ntau = 0.1".into();
    let (amplitude, end) = ("amplitude_ratio = 1e-10".into(), "tau = 0.3".into());
    let error = Extreme { amplitude, end, numerics, ..Extreme::default() }.run().expect_err("refused");
    assert_eq!(error.exit_code(), 2, "{error}");
    assert!(error.to_string().contains("by less than its place is rounded to"), "{error}");
}

#[test]
fn an_edge_of_stick_next_to_which_no_mesh_knows_the_pressure_is_refused_where_wear_asks_for_it() {
    let nearly_slides = Extreme {
        grading: -0.3,
        exponent: 0.78,
        amplitude: "amplitude_ratio = 0.999999269".into(),
        end: "tau = 700".into(),
        ..Extreme::default()
    };
    assert_eq!(nearly_slides.run().expect("an end").stop_reason(), StopReason::End);
    let law = "[wear.power-law]\npressure_exponent = 1.39\nslip_exponent = 0.9\n";
    let text = nearly_slides.text().replace("[wear.archard]\n", law);
    let scene = Scene::from_toml(&text, "extreme.toml").expect("a scene");
    let error = CheckReport::new(&scene).expect_err("refused");
    assert_eq!(error.exit_code(), 2, "{error}");
    assert!(error.to_string().contains("the pressure next to the edge of stick by"), "{error}");
}

#[test]
fn the_scene_of_a_dead_weight_keeps_to_its_accuracy() {
    let scene: Scene = include_str!("../data/scenes/normal_force.toml").parse().expect("a scene");
    let results = scene.simulate().expect("a run");
    assert_eq!(results.accuracy_met(), Some(true), "estimate {:?}", results.error_estimate());
}

#[test]
fn exponents_from_a_tenth_to_twenty_end_at_the_limit() {
    let exponents = [0.1, 0.5, 1.0, 4.0, 10.0, 20.0];
    let off = worst(exponents.map(|exponent| Extreme { exponent, ..Extreme::default() }));
    assert!(off.within(1e-10, 4e-4, 3e-12), "{off:?}");
}

#[test]
fn a_pressure_that_blows_up_at_the_edge_of_stick_passes_where_stiffness_falls_with_depth() {
    let steep =
        |grading: f64, exponent: f64| Extreme { exponent, amplitude: ratio(0.99), ..self::grading(grading) };
    let off = worst([steep(-0.9, 4.0), steep(-0.9, 20.0), steep(-0.6, 20.0)]);
    assert!(off.within(1e-11, 5e-5, 1e-12), "{off:?}");
}

/// What became of a combination.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Tally {
    limit: usize,
    refused: usize,
    failed: usize,
}

/// Runs combinations: each ends at the limit, is refused before any work, or fails with a word; the worst of the first.
fn tally(gradings: &[f64], exponents: &[f64], amplitudes: &[f64]) -> (Tally, Off) {
    let mut tally = Tally::default();
    let mut most = Off { depth: 0.0, volume: 0.0, radius: 0.0 };
    for &k in gradings {
        for &exponent in exponents {
            for &amplitude in amplitudes {
                let case = Extreme {
                    exponent,
                    amplitude: ratio(amplitude),
                    end: "until_rate = 1e-14".into(),
                    ..grading(k)
                };
                let begun = std::time::Instant::now();
                let name = format!("| {k} | {exponent} | {amplitude:?} |");
                let seconds = || begun.elapsed().as_secs_f64();
                match case.run() {
                    Ok(result) => {
                        let off = Off::of(&result);
                        let steps = result.checkpoint().progress.steps;
                        println!(
                            "{name} {:.1e} | {:.1e} | {steps} | {:.2} |",
                            off.depth,
                            off.volume,
                            seconds()
                        );
                        most = most.largest(off);
                        tally.limit += 1;
                    }
                    Err(error @ Error::NotConverged { .. }) => {
                        println!("{name} fails: {error} | {:.2}", seconds());
                        // Close to full sliding alone.
                        assert!(
                            amplitude > 0.999 && error.to_string().contains("numerics.springs"),
                            "{name}: {error}"
                        );
                        tally.failed += 1;
                    }
                    Err(error) => {
                        println!("{name} refused: {error} | {:.2}", seconds());
                        assert!(error.to_string().contains("do not carry this contact"), "{name}: {error}");
                        tally.refused += 1;
                    }
                }
            }
        }
    }
    (tally, most)
}

#[test]
fn combinations_end_at_the_limit_or_say_why_not() {
    let (tally, off) = tally(&[-0.9, 0.0, 0.9999], &[0.5, 2.0, 20.0], &[1e-10, 1.0 - 1e-2, 1.0 - 1e-6]);
    println!("{tally:?} {off:?}");
    // One of them, k = -0.9 and n = 0.5 at 1 - 1e-2 and closer, is refused. Measured: 3.2e-12 (k = 0.9999,
    // of which the ground next to the edge of stick wears last), 9.7e-5, 6.0e-14, the last of roundings.
    assert!(tally.limit >= 25 && tally.failed == 0, "{tally:?}");
    assert!(off.within(3e-11, 1e-3, 1e-12), "{off:?}");
}

#[test]
#[ignore = "the whole matrix, minutes"]
fn the_whole_matrix_ends_at_the_limit_or_says_why_not() {
    let gradings = [0.0, 0.9, -0.9, 0.99, -0.99, 0.999, -0.999, 0.9999, -0.9999];
    let (tally, off) = tally(&gradings, &[0.1, 0.5, 1.0, 2.0, 4.0, 10.0, 20.0], &AMPLITUDES);
    println!("{tally:?} {off:?}");
    // The one that fails: k = 0, n = 0.1 at 1 - 1e-6, a stick radius of 1e-60 of the contact radius.
    assert!(tally.limit >= 451 && tally.failed <= 1, "{tally:?}");
    // Measured: 1.7e-8 of the depth, 6.8e-8 of the radius, both n = 0.1 with c/a0 = 1e-60; seven of n = 0.1 are above 1e-11.
    assert!(off.within(1e-7, 1e-3, 5e-7), "{off:?}");
}

#[test]
fn a_rate_that_comes_to_nothing_by_its_quadrature_alone_ends_no_run() {
    let late = |grading: f64, rate: &str| {
        let case = Extreme { grading, end: format!("until_rate = {rate}"), ..Extreme::default() };
        let result = case.run().unwrap();
        (Off::of(&result), result.stop_reason())
    };
    for grading in [0.99, 0.0, -0.9] {
        let (off, stop) = late(grading, "1e-14");
        println!("k = {grading}: {off:?}, {stop:?}");
        let ended = matches!(stop, StopReason::Rate | StopReason::WornOut);
        assert!(off.depth < 1e-9 && ended, "k = {grading}: {off:?}, {stop:?}");
    }
}

/// Wear of the first cycle, over the limit's largest depth, for a wear coefficient of one.
fn wear_of_a_cycle() -> f64 {
    let case = Extreme { end: "cycles = 1".into(), wear: 1e-14, ..Extreme::default() };
    let result = case.run().unwrap();
    let deepest = result.last().wear_depth.iter().fold(0.0_f64, |m, w| m.max(*w));
    deepest / result.limit().unwrap().wear_depth_max() / 1e-14
}

#[test]
fn one_cycle_after_the_other_never_wears_beyond_the_limit() {
    let unit = wear_of_a_cycle();
    for share in [1e-15, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 1e6] {
        let case = Extreme {
            wear: share / unit,
            end: "cycles = 100".into(),
            numerics: "springs = 24\ntolerance = 1e-3\nstepper = \"every-cycle\"".into(),
            ..Extreme::default()
        };
        let steady = Extreme { numerics: "springs = 24\ntolerance = 1e-6".into(), ..case.clone() };
        let steady = steady.run().unwrap();
        match case.run() {
            Ok(result) => {
                let limit = result.limit().unwrap().wear_volume();
                let (worn, known) = (result.last().wear_volume / limit, steady.last().wear_volume / limit);
                let off = (worn - known).abs();
                println!("{share:e} of the limit a cycle: {worn:e} after 100, {off:.1e} from small steps");
                assert!(share <= 2e-2 && worn > 0.0 && worn < 1.0, "{share:e}: {worn:e}");
                // Round-off of a depth that is a difference of slips; 24 springs on two meshes; the first order in the wear of one cycle.
                assert!(off < 1e-14 + (2e-2 + share) * worn, "{share:e}: {worn:e} and {known:e}");
            }
            Err(error) => {
                println!("{share:e} of the limit a cycle: {error}");
                assert!(share >= 2e-2, "{share:e}: {error}");
                assert!(error.to_string().contains("one cycle is too coarse a step"), "{error}");
            }
        }
        if share >= 1.0 {
            let off = Off::of(&steady);
            assert!(off.depth < 1e-6, "{share:e}: {off:?}");
        }
    }
}

#[test]
fn a_million_million_cycles_are_run_or_refused_but_never_waited_for() {
    let with = |stepper: &str, wear: f64, end: &str| Extreme {
        wear,
        end: end.into(),
        numerics: format!("springs = 24\ntolerance = 1e-4\nstepper = \"{stepper}\""),
        ..Extreme::default()
    };
    // τ = 28 and 2.8e6.
    let implicit = with("implicit", 1e-19, "cycles = 1e12").run().unwrap();
    let explicit = with("cycle-jump", 1e-19, "cycles = 1e12").run().unwrap();
    let [a, b] = [&implicit, &explicit].map(|it| it.last().wear_volume / it.limit().unwrap().wear_volume());
    assert!(
        (a - b).abs() < 1e-4 && implicit.last().cycles == 1e12 && explicit.last().cycles == 1e12,
        "{a} and {b}"
    );
    let off = Off::of(&with("implicit", 1e-14, "cycles = 1e12").run().unwrap());
    assert!(off.within(1e-12, 3e-5, 1e-12), "{off:?}");

    for (case, words) in [
        (with("every-cycle", 1e-19, "cycles = 1e12"), "1.0e12 steps"),
        (with("every-cycle", 1e-300, "tau = 10"), "steps, of which 1e9 are allowed"),
        (with("every-cycle", 1e-29, "until_rate = 1e-3"), "steps, of which 1e9 are allowed"),
        (with("cycle-jump", 1e-10, "cycles = 1e12"), "limited by the stiffest springs"),
    ] {
        let message = case.refusal();
        assert!(message.starts_with("numerics.stepper") && message.contains(words), "{message}");
        assert!(message.contains("take the stepper \"implicit\""), "{message}");
    }
}

#[test]
fn springs_are_few_or_many_or_refused_with_the_figure() {
    let with = |springs: usize| Extreme { numerics: format!("springs = {springs}"), ..Extreme::default() };
    let off = worst([8, 12, 400].map(with));
    // Measured: 2.1e-11 (between 8 springs), 1.1e-3 (8 springs), 2.5e-13.
    assert!(off.within(1e-10, 5e-3, 1e-12), "{off:?}");
    let message = with(3).refusal();
    assert!(message.contains("numerics.springs = 3"), "{message}");
    for (springs, size) in [(1_000_000_000, "12000.0 GB"), (1_000_000_000_000, "12000000.0 GB")] {
        let message = with(springs).refusal();
        assert!(message.starts_with("numerics.springs") && message.contains(size), "{message}");
    }
    let message = Extreme { amplitude: ratio(1.0 - 1e-4), ..Extreme { exponent: 0.5, ..with(24) } }.refusal();
    assert!(
        message.contains("24 springs do not carry this contact") && message.contains("more springs"),
        "{message}"
    );
}

#[test]
fn what_a_run_refuses_for_its_mesh_the_check_refuses_with_the_same_words() {
    let with = |exponent: f64, amplitude: f64, springs: usize| Extreme {
        exponent,
        amplitude: ratio(amplitude),
        numerics: format!("springs = {springs}"),
        ..Extreme::default()
    };
    for case in [with(0.5, 1.0 - 1e-4, 24), with(2.0, 0.5, 1_000_000_000)] {
        let scene = Scene::from_toml(&case.text(), "extreme.toml").unwrap();
        let (checked, run) = (CheckReport::new(&scene).unwrap_err().to_string(), case.refusal());
        // The memory that is free may differ from one moment to the next.
        let said = |text: &str| text.split(" and ").next().unwrap_or_default().to_owned();
        assert_eq!(said(&checked), said(&run));
    }
    let scene = Scene::from_toml(&with(2.0, 0.5, 24).text(), "extreme.toml").unwrap();
    assert_eq!(CheckReport::new(&scene).unwrap().form.contact.regime().name(), "partial-slip");
}

/// The radii and depths of a run with some numerics.
fn depths(grading: f64, exponent: f64, stick_ratio: f64, numerics: &str) -> (Vec<f64>, Vec<Snapshot>, f64) {
    let case = Extreme {
        exponent,
        amplitude: format!("stick_ratio = {stick_ratio}"),
        end: "tau = 20".into(),
        numerics: numerics.into(),
        ..self::grading(grading)
    };
    let folder = tempfile::tempdir().expect("a folder");
    let output = folder.path().join("run.h5");
    let text = case.text().replace("snapshots = 3", "at_tau = [0.01, 0.3, 2.0, 6.0]");
    let scene = Scene::from_toml(&text, "depths.toml").unwrap();
    let result = Run::new(&scene, &output, false, &Stop::default()).unwrap().execute(None).unwrap();
    let file = RunFile::open(&output).unwrap();
    (file.header.radius, file.snapshots, result.limit().unwrap().wear_depth_max())
}

#[test]
fn few_springs_show_many_radii_and_between_the_springs_the_profile_is_as_right_as_at_them() {
    for (k, n, stick) in [(0.0, 2.0, 0.7), (0.9, 2.0, 0.7), (0.3, 4.0, 0.2), (-0.8, 2.0, 0.5)] {
        let (radii, snapshots, scale) = depths(k, n, stick, "accuracy = 1e-4");
        let (fine_radii, fine, _) = depths(k, n, stick, "springs = 115\ntolerance = 1e-7");
        assert!(radii.len() >= 120 && radii == fine_radii, "{} and {}", radii.len(), fine_radii.len());
        assert!(snapshots[0].wear_depth.iter().all(|depth| *depth == 0.0));
        for (snapshot, fine) in snapshots.iter().zip(&fine) {
            let pairs = snapshot.wear_depth.iter().zip(&fine.wear_depth);
            let off = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / scale;
            println!("k {k} n {n} c/a0 {stick} at τ = {}: {off:.1e}", snapshot.tau);
            // Measured: at most 5.5e-5, at the springs and between them.
            assert!(off < 1e-4, "k {k} n {n} c/a0 {stick} at τ = {}: {off:e}", snapshot.tau);
            let outside = radii.iter().zip(&snapshot.pressure).filter(|(r, _)| **r > snapshot.contact_radius);
            assert!(outside.into_iter().all(|(_, pressure)| *pressure == 0.0));
            assert!(snapshot.wear_depth.iter().chain(&snapshot.pressure).all(|value| *value >= 0.0));
        }
    }
}

#[test]
#[ignore = "a gigabyte and minutes"]
fn five_thousand_springs_make_a_step() {
    let numerics = "springs = 5000\ntolerance = 1e-2".to_owned();
    let result = Extreme { numerics, end: "cycles = 1".into(), ..Extreme::default() }.run().unwrap();
    let few = Extreme { end: "cycles = 1".into(), ..Extreme::default() }.run().unwrap();
    let off = (result.last().wear_volume / few.last().wear_volume - 1.0).abs();
    assert!(off < 1e-3, "{} and {}", result.last().wear_volume, few.last().wear_volume);
}

/// What a snapshot holds, in the powers of length and stiffness that it has.
fn measures(snapshot: &Snapshot) -> Vec<(&'static str, i32, i32, Vec<f64>)> {
    // Next to the edge of stick the pressure is a property of the mesh.
    let inner = snapshot.pressure.len() / 6;
    vec![
        ("profile", 1, 0, snapshot.profile.clone()),
        ("wear_depth", 1, 0, snapshot.wear_depth.clone()),
        ("slip", 1, 0, snapshot.slip.clone()),
        ("pressure", 0, 1, snapshot.pressure[inner..].to_vec()),
        ("wear_volume", 3, 0, vec![snapshot.wear_volume]),
        ("contact_radius", 1, 0, vec![snapshot.contact_radius]),
        ("stick_radius", 1, 0, vec![snapshot.stick_radius]),
        ("indentation", 1, 0, vec![snapshot.indentation]),
        ("normal_force", 2, 1, vec![snapshot.normal_force]),
        ("dissipated_energy", 3, 1, vec![snapshot.dissipated_energy]),
        ("loop_displacement", 1, 0, snapshot.loop_displacement.clone()),
        ("loop_force", 2, 1, snapshot.loop_force.clone()),
        ("tau", 0, 0, vec![snapshot.tau]),
    ]
}

#[test]
fn nanometres_and_kilometres_soft_and_hard_are_the_same_numbers() {
    let stored = |case: &Extreme| {
        let folder = tempfile::tempdir().expect("a folder");
        let output = folder.path().join("run.h5");
        case.run_to(&output).unwrap_or_else(|error| panic!("{}: {error}", case.text()));
        RunFile::open(&output).unwrap().snapshots
    };
    let mut worst = (0.0, String::new());
    let mut worst_pressure = worst.clone();
    for grading in [-0.9, -0.5, 0.0, 0.5, 0.9] {
        let base = Extreme { grading, end: "tau = 10".into(), ..Extreme::default() };
        let reference = stored(&base);
        let scaled = [(1e-9, 1.0), (1e6, 1.0), (1.0, 1e-15), (1.0, 1e15), (1e-9, 1e15)];
        for (length, stiffness) in scaled {
            let snapshots = stored(&Extreme { length, stiffness, ..base.clone() });
            assert_eq!(snapshots.len(), reference.len());
            for (one, other) in reference.iter().zip(&snapshots) {
                for ((name, metres, moduli, a), (_, _, _, b)) in
                    measures(one).into_iter().zip(measures(other))
                {
                    assert_eq!(a.len(), b.len(), "{name}");
                    let scale = length.powi(metres) * stiffness.powi(moduli);
                    let size = a.iter().fold(f64::MIN_POSITIVE, |m, value| m.max(value.abs()));
                    for (a, b) in a.iter().zip(&b) {
                        let off = (a - b / scale).abs() / size;
                        let worst = if name == "pressure" { &mut worst_pressure } else { &mut worst };
                        if off.is_nan() || off > worst.0 {
                            *worst = (
                                off,
                                format!("{name}, k = {grading}, lengths {length:e}, stiffness {stiffness:e}"),
                            );
                        }
                    }
                }
            }
        }
    }
    println!("{worst:?}, {worst_pressure:?}");
    // Measured: 7.3e-8, at k = -0.9, and 5.2e-11.
    assert!(worst_pressure.0 < 5e-7, "{worst_pressure:?}");
    assert!(worst.0 < 5e-10, "{worst:?}");
}

#[test]
fn the_program_refuses_with_its_code_and_writes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = [
        (Extreme { numerics: "springs = 1000000000".into(), ..Extreme::default() }, "numerics.springs"),
        (
            Extreme {
                numerics: "stepper = \"every-cycle\"".into(),
                end: "cycles = 1e12".into(),
                ..Extreme::default()
            },
            "numerics.stepper",
        ),
        (
            Extreme {
                wear: 1e-3,
                numerics: "stepper = \"every-cycle\"".into(),
                end: "cycles = 100".into(),
                ..Extreme::default()
            },
            "one cycle is too coarse a step",
        ),
        (
            Extreme { grading: -0.9999, exponent: 0.1, amplitude: ratio(0.99), ..Extreme::default() },
            "numerics.accuracy",
        ),
        (Extreme { grading: 1.0, ..Extreme::default() }, "half_space.grading"),
    ];
    for (case, key) in cases {
        fs::write(folder.path().join("scene.toml"), case.text()).unwrap();
        let output = command::run(folder.path(), &["run", "scene.toml", "--json"]);
        let message = command::text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(key) && output.stdout.is_empty(), "{message}");
        assert_eq!(command::names(folder.path()), ["scene.toml"], "{message}");
    }
}
