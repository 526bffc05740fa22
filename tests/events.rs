//! Events that differ by rounding are one; a run that fails says when and where; one that takes long says so before.

mod support;

use std::fmt::Write;
use std::fs;

use fretwear::{CheckReport, Error, Results, StopReason};

use fretwear::scene::Scene;
use fretwear::solver::model::{Model, State};
use fretwear::solver::simulation::{End, Flow, Observer, Outcome, Plan, Simulation};
use fretwear::solver::stepper::{Sdirk, Stepper, Trial};
use support::{Case, command};

/// The plain scene of a paraboloid, with an amplitude, an end, what more there is of loading and other tables.
fn scene(amplitude: &str, end: &str, more: &str) -> String {
    format!(
        "[indenter.paraboloid]\nradius = 1.0\n[half_space]\ngrading = 0.0\nnormal_stiffness = 2e11\nstiffness_ratio = 0.6666666666666666\n\
         [friction.coulomb]\ncoefficient = 0.5\n[wear.archard]\ncoefficient = 1.667e-13\n[numerics]\naccuracy = 1e-3\n[loading]\n\
         indentation = 1e-6\n{amplitude}\n{end}\n{more}"
    )
}

fn run(text: &str) -> fretwear::Result<Results> {
    Scene::from_toml(text, "events.toml")?.simulate()
}

/// Dimensionless times of the snapshots, and steps.
fn seen(text: &str) -> (Vec<f64>, u64, f64) {
    let result = run(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let times = result.tau();
    (times, result.checkpoint().progress.steps, result.last().wear_volume)
}

#[test]
fn a_snapshot_and_an_event_that_differ_by_rounding_are_one() {
    // Three tenths are 0.30000000000000004 as a sum.
    let blocks = "[[loading.blocks]]\ntau = 0.1\n[[loading.blocks]]\ntau = 0.2\namplitude_factor = 0.9\n[[loading.blocks]]\ntau = 1\n\
                  amplitude_factor = 0.8\n";
    let history =
        |time: &str| format!("[friction.history]\nfactors = [1.0, 0.9, 0.8]\nat_tau = [0.0, {time}, 0.6]\n");
    let wear = |time: &str| format!("[wear.history]\nfactors = [1.0, 0.5]\nat_tau = [0.0, {time}]\n");
    let others = [
        ("blocks", blocks.to_owned()),
        ("blocks, repeated", format!("repeat = true\n{}", blocks.replace("tau = 1\n", "tau = 0.2\n"))),
        ("friction after", history("0.30000000000000004")),
        ("friction before", history("0.29999999999999993")),
        ("wear after", wear("0.30000000000000004")),
        ("wear before", wear("0.29999999999999993")),
    ];
    for (name, more) in others {
        for (end, times) in
            [("tau = 0.5", "[0.1, 0.3]"), ("tau = 0.3", "[0.1]"), ("tau = 0.30000000000000004", "[0.1, 0.3]")]
        {
            let text = scene("stick_ratio = 0.7", end, &format!("{more}[output]\nat_tau = {times}\n"));
            let (times, steps, volume) = seen(&text);
            let apart = text.replace("at_tau = [0.1, 0.3]", "at_tau = [0.1]");
            let (_, steps_apart, volume_apart) = seen(&apart);
            println!("{name}, {end}: {times:?}, {steps} and {steps_apart} steps");
            let expected: &[f64] = if end == "tau = 0.5" { &[0.0, 0.1, 0.3, 0.5] } else { &[0.0, 0.1, 0.3] };
            let met = times.len() == expected.len()
                && times.iter().zip(expected).all(|(time, wanted)| (time - wanted).abs() <= 1e-15);
            assert!(met, "{name}, {end}: {times:?}");
            // The snapshot is where the run lands anyway, or is between two steps.
            assert!(steps <= steps_apart + 12, "{name}, {end}: {steps} steps instead of {steps_apart}");
            assert!(
                (volume / volume_apart - 1.0).abs() < 1e-3,
                "{name}, {end}: {volume:e} and {volume_apart:e}"
            );
        }
    }
}

#[test]
fn a_run_that_cannot_go_on_names_cycle_time_radius_and_what_to_do() {
    let case = Case::new(2.0, 0.0, 0.7, 20);
    // No step is as exact as that.
    let tolerance = 1e-40;
    let plan = Plan { outputs: vec![3.0], end: End::Cycles(3.0) };
    let error = case.simulation(Box::new(Sdirk::new(1e-3)), tolerance, plan).run(&mut []).unwrap_err();
    let words = error.to_string();
    assert!(matches!(error, Error::NotConverged { .. }), "{words}");
    let parts = [
        "at cycle 0 ",
        "τ = 0",
        "from the radius 7.0000e-1 m to the contact radius 1.0",
        "ask for 40 springs (numerics.springs; there were 20)",
        "loading.amplitude",
    ];
    for part in parts {
        assert!(words.contains(part), "{words:?} does not contain {part:?}");
    }
    assert!(!words.contains("too small"), "{words}");
}

/// Steps of one length without wear, of which some in a period are off by too much.
struct Rejected {
    length: f64,
    rejects: &'static [bool],
    tried: usize,
}

impl Stepper for Rejected {
    fn name(&self) -> &'static str {
        "rejected"
    }

    fn step(&mut self, _: &Model, state: &State, cycles: f64) -> fretwear::Result<Trial> {
        self.tried += 1;
        let rejected = self.rejects[self.tried % self.rejects.len()];
        Ok(Trial {
            state: Some(State { cycles: state.cycles + cycles, ..state.clone() }),
            fields: None,
            error: if rejected { 2.0 } else { 0.0 },
            rate_evaluations: 1,
            next_step: Some(self.length),
        })
    }

    fn estimate_order(&self) -> f64 {
        1.0
    }
}

#[test]
fn a_run_is_given_up_after_four_thousand_rejected_steps_only_if_they_are_more_than_half_of_the_accepted() {
    let case = Case::new(2.0, 0.0, 0.7, 10);
    let after = |steps: f64, rejects: &'static [bool]| {
        let probe =
            case.simulation(Box::new(Sdirk::new(1e-3)), 1.0, Plan { outputs: vec![], end: End::Cycles(1.0) });
        let length = probe.progress().next_step;
        let plan = Plan { outputs: vec![], end: End::Cycles(steps * length) };
        let mut simulation = case.simulation(Box::new(Rejected { length, rejects, tried: 0 }), 1.0, plan);
        let outcome = simulation.run(&mut []);
        (outcome, *simulation.progress())
    };
    // Half a step and a whole one in turn.
    let (outcome, progress) = after(1e6, &[false, true]);
    let error = outcome.expect_err("half of the steps are rejected");
    assert!(
        matches!(error, Error::NotConverged { .. }) && error.to_string().contains("most are rejected"),
        "{error}"
    );
    assert_eq!(progress.rejected_steps, 4001, "given up after {} accepted steps", progress.steps);

    let (outcome, progress) = after(12_000.0, &[false, true, false, false]);
    assert_eq!(outcome.expect("a quarter of the steps is rejected"), Outcome::End);
    assert!(progress.rejected_steps > 4001, "{} of {}", progress.rejected_steps, progress.steps);
}

#[test]
fn check_says_beforehand_that_a_run_takes_minutes_and_why() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut rows = String::from("x, y\n");
    for row in 0..4000 {
        let angle = std::f64::consts::TAU * f64::from(row) / 4000.0;
        writeln!(rows, "{:e}, {:e}", 3.8e-7 * angle.cos(), 3e-7 * (3.0 * angle).sin())
            .expect("a string takes all");
    }
    fs::write(folder.path().join("path.csv"), rows).expect("a file");
    let long = scene("", "tau = 3", "[loading.path]\nfile = \"path.csv\"\n")
        .replace("indentation = 1e-6", "normal_force = 266.7")
        .replace("accuracy = 1e-3", "accuracy = 1e-5");
    fs::write(folder.path().join("long.toml"), long).expect("a file");
    let output = command::run(folder.path(), &["check", "long.toml", "--json"]);
    let errors = command::text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{errors}");
    assert!(errors.contains("the run takes some") && errors.contains("numerics."), "{errors}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("one object");
    assert!(report["seconds_expected"].as_f64().is_some_and(|seconds| seconds > 60.0), "{report}");
    let said = |warning: &serde_json::Value| {
        warning.as_str().is_some_and(|words| words.contains("the run takes some"))
    };
    assert!(report["warnings"].as_array().is_some_and(|warnings| warnings.iter().any(said)), "{report}");
    fs::write(folder.path().join("short.toml"), scene("stick_ratio = 0.7", "tau = 3", "")).expect("a file");
    let report = command::object(folder.path(), &["check", "short.toml", "--json"]);
    assert!(report["seconds_expected"].is_null(), "{report}");
}

#[test]
fn what_would_need_a_step_for_each_of_too_many_blocks_is_refused() {
    let blocks = "repeat = true\n[[loading.blocks]]\ntau = 1e-12\n[[loading.blocks]]\ntau = 1e-12\namplitude_factor = 0.5\n";
    let held = "stick_ratio = 0.7\ntangential_control = \"force\"";
    let error = run(&scene(held, "tau = 3", blocks)).err().map(|error| error.to_string());
    let words = error.unwrap_or_default();
    assert!(words.starts_with("loading.blocks: ") && words.contains("make the blocks longer"), "{words}");
}

/// Stops what does not end.
struct Steps(u64);

impl Observer for Steps {
    fn step(&mut self, simulation: &Simulation) -> fretwear::Result<Flow> {
        Ok(if simulation.progress().steps < self.0 { Flow::Continue } else { Flow::Stop })
    }
}

#[test]
fn the_smallest_rate_that_may_be_asked_for_is_reached_under_every_law() {
    let laws = [
        ("plain", "", ""),
        (
            "power law, 0.6",
            "[wear.power-law]\ncoefficient = 1e-12\npressure_exponent = 0.6\nslip_exponent = 1.0\n",
            "",
        ),
        (
            "power law, 1.5",
            "[wear.power-law]\ncoefficient = 1e-16\npressure_exponent = 1.5\nslip_exponent = 1.0\n",
            "",
        ),
        ("threshold", "[wear.threshold]\ncoefficient = 1.667e-13\npressure = \"5 MPa\"\n", ""),
        ("non-local", "[wear.non-local]\ncoefficient = 1.667e-13\nlength = \"50 um\"\n", ""),
        ("wear that ceases", "", "[wear.history]\nfinal_factor = 0\ntau = 5\n"),
        ("friction that rises", "", "[friction.history]\nfactors = [1.0, 1.1]\nat_tau = [0.0, 1.0]\n"),
        ("friction that falls", "", "[friction.history]\nfactors = [1.0, 0.9]\nat_tau = [0.0, 1.0]\n"),
        (
            "blocks",
            "",
            "repeat = true\n[[loading.blocks]]\ntau = 1\n[[loading.blocks]]\ntau = 1\namplitude_factor = 0.9\n",
        ),
        (
            "a normal oscillation",
            "",
            "[loading.normal_oscillation]\namplitude_ratio = 0.2\nfrequency_ratio = 1\nphase = \"90 deg\"\n",
        ),
        ("gross slip", "amplitude", ""),
    ];
    for (name, law, more) in laws {
        let amplitude = if law == "amplitude" { "amplitude_ratio = 2" } else { "stick_ratio = 0.7" };
        let at = |rate: &str| {
            let text =
                scene(amplitude, &format!("until_rate = {rate}"), &format!("{more}[output]\nat_tau = []\n"));
            let text = if law.starts_with('[') {
                text.replace("[wear.archard]\ncoefficient = 1.667e-13\n", law)
            } else {
                text
            };
            let scene = Scene::from_toml(&text, "rate.toml").unwrap();
            let run = fretwear::Simulation::new(&scene).unwrap();
            let result =
                run.run_with(Some(&mut Steps(3000))).unwrap_or_else(|error| panic!("{name}: {error}"));
            println!(
                "{name}, {rate}: {:?} at τ = {:.3e}, {} steps, {:e} m³",
                result.stop_reason(),
                result.last().tau,
                result.checkpoint().progress.steps,
                result.last().wear_volume
            );
            assert_ne!(result.stop_reason(), StopReason::Interrupted, "{name}: no end after 3000 steps");
            result.last().wear_volume
        };
        let [late, last] = [at("1e-11"), at("1e-14")];
        assert!((late / last - 1.0).abs() < 1e-3, "{name}: {late:e} and {last:e} m³");
    }
}

#[test]
fn check_tells_how_a_scene_is_computed() {
    let method = |name: &str| {
        let scene = Scene::from_path(format!("data/scenes/{name}")).unwrap();
        (scene.clone(), CheckReport::new(&scene).unwrap().method.unwrap())
    };
    let told = |name| {
        let (_, it) = method(name);
        (it.cycle, it.mesh, it.stick_edge, it.time_stepping)
    };
    let [bdf, sdirk] = ["BDF of order 1 to 5", "SDIRK of order 3"];
    assert_eq!(told("paraboloid.toml"), ("closed-form", "slip-annulus", "fixed", bdf));
    assert_eq!(told("orbit.toml"), ("resolved", "slip-annulus", "fixed", bdf));
    assert_eq!(told("normal_force.toml"), ("closed-form", "slip-annulus", "moving", sdirk));
    assert_eq!(told("blocks.toml"), ("closed-form", "slip-annulus", "on-mesh", sdirk));
    assert_eq!(told("fouvry2007.toml"), ("closed-form", "whole-contact", "none", bdf));
    // What it tells is what is run.
    let (scene, told) = method("paraboloid.toml");
    assert_eq!(scene.simulate().unwrap().springs(), told.springs);
}

/// The end by the rate is an event, located to the tolerance: it used to be the first step beyond, up to half the rate asked for, 1.5e-2 of the limit's volume away.
#[test]
fn a_run_ends_where_its_rate_is_what_was_asked_for() {
    let laws = [
        (
            "[friction.coulomb]\ncoefficient = 0.5",
            "[wear.archard]\ncoefficient = 1e-13",
            "amplitude_ratio = 0.3",
        ),
        (
            "[friction.static-kinetic]\nstatic_coefficient = 0.0700\nkinetic_coefficient = 0.0693",
            "[wear.power-law]\ncoefficient = 1e-18\npressure_exponent = 1.44\nslip_exponent = 0.76",
            "amplitude_ratio = 1e-5",
        ),
        // The edge of stick moves, and the whole contact slides.
        (
            "[friction.coulomb]\ncoefficient = 0.5",
            "[wear.archard]\ncoefficient = 1e-13",
            "amplitude_ratio = 0.5\ntangential_control = \"force\"",
        ),
        (
            "[friction.coulomb]\ncoefficient = 0.5",
            "[wear.archard]\ncoefficient = 1e-13",
            "amplitude_ratio = 2.0",
        ),
    ];
    for (friction, wear, loading) in laws {
        for rate in [0.9, 0.5, 0.1] {
            let run = |accuracy: f64| {
                let text = format!(
                    "[indenter.cone]\nslope = 0.01\n[half_space]\ngrading = 0.3\nnormal_stiffness = 6e8\nstiffness_ratio = 0.4\n{friction}\n{wear}\n\
                     [loading]\nindentation = 2.4e-8\n{loading}\nuntil_rate = {rate}\n[numerics]\naccuracy = {accuracy}\n"
                );
                let run = fretwear::Simulation::new(&text.parse().unwrap()).unwrap().run().unwrap();
                (run.last().wear_volume, run.error_estimate().unwrap(), run.accuracy_met())
            };
            let (exact, ..) = run(1e-5);
            for accuracy in [1e-2, 1e-3, 1e-4] {
                let (volume, told, met) = run(accuracy);
                let off = volume / exact - 1.0;
                println!("{loading}, {rate} at {accuracy:e}: {off:.1e} off, {told:.1e} told");
                assert!(
                    off.abs() < accuracy || met != Some(true),
                    "{loading}, {rate} at {accuracy:e}: {off:e} off, {told:e} told"
                );
            }
        }
    }
}
