//! Repeated blocks whose passes are short beside the evolution of wear: averaged over passes, against stepped from block to block.

mod support;

use fretwear::contact::InitialContact;
use fretwear::contact::half_space::HalfSpace;
use fretwear::contact::indenter::{Indenter, power_law_factor};
use fretwear::laws::conditions::Conditions;
use fretwear::laws::friction::Coulomb;
use fretwear::laws::history::History;
use fretwear::laws::loading::{Amplitude, Block, Duration, Load, Loading};
use fretwear::laws::wear::Archard;
use fretwear::numerics::grid::Clustering;
use fretwear::run::Results;
use fretwear::scene::Scene;
use fretwear::solver::model::{Model, OperatorStore, Resolution, Schedule};
use fretwear::solver::simulation::{End, Plan, Simulation};
use fretwear::solver::stepper;
use support::resume::whole_and_in_parts;
use support::{Case, Record, distance, laws};

/// Blocks of a pass: their parts of it, and factors of amplitude and indentation.
type Pass = &'static [[f64; 3]];

const TWO: Pass = &[[0.5, 0.7, 1.0], [0.5, 1.0, 1.0]];
const SMALLER: Pass = &[[0.5, 1.0, 1.0], [0.5, 0.7, 1.0]];
const THREE: Pass = &[[0.2, 1.0, 1.0], [0.3, 0.6, 1.0], [0.5, 0.8, 1.0]];
const PAUSE: Pass = &[[0.3, 1.0, 1.0], [0.7, 0.0, 1.0]];
const DEEPER: Pass = &[[0.5, 1.0, 1.0], [0.5, 1.0, 1.2]];

/// Dimensionless time of the runs compared, and the numbers of passes in it.
const TAU: f64 = 4.0;
const PASSES: [f64; 2] = [30.0, 100.0];

/// Tolerance of their steps.
const TOLERANCE: f64 = 1e-6;

/// What averaging leaves out over the swing of a pass, at most.
const OF_SWING: f64 = 1.5;

/// Conditions with passes of so many cycles.
fn in_passes(conditions: &Conditions, pass: Pass, cycles: f64) -> Conditions {
    let block = |[part, amplitude, indentation]: &[f64; 3]| -> Block {
        laws::block(part * cycles, *amplitude, *indentation)
    };
    Conditions { blocks: pass.iter().map(block).collect(), repeat: true, ..conditions.clone() }
}

/// Worn volumes and depths at the outputs.
fn worn(model: Model, outputs: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
    let plan = Plan { outputs: outputs.to_vec(), end: End::Cycles(outputs[outputs.len() - 1]) };
    let stepper = stepper::implicit(&model, TOLERANCE);
    let mut seen = Record::default();
    Simulation::new(model, stepper, TOLERANCE, plan).unwrap().run(&mut [&mut seen]).unwrap();
    seen.0.into_iter().map(|it| (it.wear_volume, it.wear_depth)).unzip()
}

/// The same, averaged from the first cycle on.
fn averaged(mut model: Model) -> Model {
    model.average_from(0.0);
    model
}

/// By how much averaged runs differ from stepped ones, over the swing of a pass: amid a pass and after whole ones, for each number of passes; the largest of
/// volume and depth, each over `scales`, m³ and m.
fn off(name: &str, model: impl Fn(f64) -> Model, scales: impl Fn(&Model) -> [f64; 2]) -> [[f64; 2]; 2] {
    PASSES.map(|passes| {
        let cycles = TAU / passes;
        let model = model(cycles);
        let scales = scales(&model);
        let swing = model.pass_swing(&model.initial_state().unwrap()).unwrap();
        let swing = (swing.volume / scales[0]).max(swing.depth / scales[1]);
        let wholes = [0.1, 0.4, 1.0].map(|part| (part * passes).floor());
        let outputs: Vec<f64> =
            wholes.iter().flat_map(|whole| [(whole - 0.6) * cycles, whole * cycles]).collect();
        let (stepped, averaged) = (worn(model.clone(), &outputs), worn(averaged(model), &outputs));
        let apart = |i: usize| {
            let volume = (stepped.0[i] - averaged.0[i]).abs() / scales[0];
            volume.max(distance(&stepped.1[i], &averaged.1[i]) / scales[1])
        };
        let most = |first: usize| (first..6).step_by(2).map(apart).fold(0.0, f64::max) / swing;
        let off = [most(0), most(1)];
        println!("{name}, {passes} passes: swing {swing:.1e}, off by {off:.2?} of it");
        off
    })
}

/// Averaged runs err by no more than is told, and by a third with three times the passes.
fn assert_first_order(name: &str, off: [[f64; 2]; 2]) {
    let [few, many] = off.map(|[amid, whole]| amid.max(whole));
    assert!(few < OF_SWING && many < OF_SWING, "{name}: {off:?}");
    assert!((0.7..1.4).contains(&(many / few)), "{name}: {off:?}");
}

fn of_limit(model: &Model) -> [f64; 2] {
    [model.limit_volume(), model.depth_scale()]
}

#[test]
fn averaged_blocks_wear_as_stepped_ones_to_first_order_in_the_length_of_a_pass() {
    for (exponent, grading) in [(2.0, 0.0), (1.0, -0.5), (2.0, 0.5)] {
        let case = Case::new(exponent, grading, 0.7, 24);
        let contact = case.contact();
        let plain = laws::plain(&contact);
        let wear_falls = History::Exponential { last: 0.5, time: 1.0 };
        let mut kinds = vec![
            ("two blocks", plain.clone(), TWO),
            ("three blocks", plain.clone(), THREE),
            ("a pause", plain.clone(), PAUSE),
            ("deeper", plain.clone(), DEEPER),
            ("wear that falls", Conditions { wear_history: wear_falls, ..plain.clone() }, TWO),
        ];
        let of_wear = laws::wear_laws(&contact).into_iter().skip(2).chain(laws::other_wear_laws(&contact));
        kinds.extend(of_wear.map(|(name, wear)| (name, Conditions { wear, ..plain.clone() }, TWO)));
        let of_friction = laws::friction_laws(&contact).into_iter().skip(1);
        kinds.extend(
            of_friction.map(|(name, friction)| (name, Conditions { friction, ..plain.clone() }, TWO)),
        );
        for (name, conditions, pass) in kinds {
            let model = |cycles: f64| laws::model(&case, &in_passes(&conditions, pass, cycles), None);
            let name = format!("n {exponent} k {grading}, {name}");
            assert_first_order(&name, off(&name, model, of_limit));
        }
    }
}

#[test]
fn so_do_orbits_and_normal_oscillations_in_blocks() {
    let case = Case::new(2.0, 0.0, 0.7, 16);
    let contact = case.contact();
    for (name, mode) in laws::modes(&contact).into_iter().skip(1).step_by(2) {
        let conditions = Conditions { mode, ..laws::plain(&contact) };
        let model = |cycles: f64| laws::model(&case, &in_passes(&conditions, TWO, cycles), Some(32));
        assert_first_order(name, off(name, model, of_limit));
    }
}

/// In the smaller block at 1.2 times what moves the whole contact springs stick.
#[test]
fn so_does_gross_slip() {
    for (grading, ratio) in [(0.0, 2.0), (0.5, 2.0), (0.0, 1.2)] {
        let contact = gross_contact(grading, ratio);
        for (name, pass) in [("a smaller block", SMALLER), ("a pause", PAUSE)] {
            let model = |cycles: f64| {
                let conditions = in_passes(&laws::plain(&contact), pass, cycles);
                let schedule = Schedule::new(&contact, &conditions, Resolution::default()).unwrap();
                let store = OperatorStore::default();
                let model = Model::under(&contact, schedule, 17, Clustering::Cubic, &store).unwrap();
                assert!(model.gross().is_some());
                model
            };
            let depth = contact.indentation();
            let scales = [depth * contact.contact_radius().powi(2), depth];
            let name = format!("k {grading}, U {ratio}, {name}");
            assert_first_order(&name, off(&name, model, |_| scales));
        }
    }
}

/// A paraboloid moved by a multiple of what moves all of the contact.
fn gross_contact(grading: f64, ratio: f64) -> InitialContact {
    let indentation = power_law_factor(2.0, grading);
    let loading = Loading {
        load: Load::Indentation(indentation),
        amplitude: Amplitude::Ratio(ratio),
        duration: Duration::Tau(1.0),
    };
    let indenter = Indenter::power_law(1.0, 2.0).unwrap();
    let half_space = HalfSpace::from_stiffness(grading, 1.0, 1.0).unwrap();
    let wear = Archard { coefficient: 0.25 / indentation };
    InitialContact::new(&indenter, &half_space, &Coulomb { coefficient: 1.0 }, &wear, &loading).unwrap()
}

/// A scene with blocks of these dimensionless times, the first of 0.7 times the amplitude, and lines of `[loading]` and tables beside them.
fn scene(block: f64, loading: &str, tables: &str) -> Scene {
    let text = format!(
        "[indenter.paraboloid]\nradius = 1.0\n[half_space]\ngrading = 0\nnormal_stiffness = 2e11\nstiffness_ratio = 0.6666666666666667\n\
         [friction.coulomb]\ncoefficient = 0.5\n[wear.archard]\ncoefficient = 1.667e-13\n[loading]\nindentation = 1e-6\n{loading}\nrepeat = true\n\
         [[loading.blocks]]\ntau = {block:e}\namplitude_factor = 0.7\n[[loading.blocks]]\ntau = {block:e}\n{tables}\n[output]\nsnapshots = 4\n"
    );
    Scene::from_toml(&text, "passes.toml").unwrap()
}

fn averages(scene: &Scene) -> bool {
    fretwear::Simulation::new(scene).unwrap().stepping().model().schedule().averages_from() == 0.0
}

fn last_volume(results: &Results) -> f64 {
    results.last().wear_volume
}

#[test]
fn a_million_passes_and_a_thousand_million_take_a_few_steps_and_wear_the_same() {
    // Chosen springs may be 278 for one of them and 279 for the other.
    for (loading, numerics) in [
        ("stick_ratio = 0.7\ntau = 3", ""),
        ("amplitude_ratio = 3\ntau = 3", ""),
        ("stick_ratio = 0.7\nuntil_rate = 0.01", "[numerics]\nsprings = 280\n"),
    ] {
        let of = |block: f64| {
            let results = scene(block, loading, numerics).simulate().unwrap();
            let steps = results.checkpoint().progress.steps;
            let estimate = results.error_estimate().unwrap();
            println!(
                "{loading:?}, blocks of τ = {block:e}: {steps} steps, {:e} m³, estimate {estimate:e}",
                last_volume(&results)
            );
            assert!(steps < 1000 && estimate < 1e-3, "{loading:?}: {steps} steps, {estimate:e}");
            last_volume(&results)
        };
        let [short, shorter] = [of(1.5e-6), of(1.5e-9)];
        assert!((short / shorter - 1.0).abs() < 1e-6, "{loading:?}: {short:e} and {shorter:e}");
    }
}

/// Archard's law under Coulomb's friction: `V = (k_w/μ_f) ΣE`, of the surface and of the springs.
#[test]
fn the_volume_is_that_of_the_energy() {
    for loading in ["stick_ratio = 0.7\ntau = 3", "amplitude_ratio = 3\ntau = 3"] {
        let results = scene(1.5e-6, loading, "").simulate().unwrap();
        let by_energy = 1.667e-13 / 0.5 * results.last().dissipated_energy;
        let off = last_volume(&results) / by_energy - 1.0;
        println!("{loading:?}: {off:e}");
        assert!(off.abs() < 1e-3, "{loading:?}: {off:e}");
    }
}

#[test]
fn what_is_shown_is_of_the_block_under_way() {
    let results = scene(1.5e-6, "stick_ratio = 0.7\ntau = 3", "").simulate().unwrap();
    let first = &results.snapshots()[0];
    let other =
        results.snapshots().iter().find(|it| it.tau % 3e-6 > 1.5e-6 + 1e-9 && it.tau % 3e-6 < 3e-6 - 1e-9);
    // The edge of stick of the smaller amplitude lies farther out.
    let other = other.expect("a snapshot amid a second block");
    assert!(
        first.stick_radius > 1.1 * other.stick_radius,
        "{} and {}",
        first.stick_radius,
        other.stick_radius
    );
}

#[test]
fn passes_are_averaged_only_where_they_are_short_and_steps_are_free() {
    let tangential = "stick_ratio = 0.7\ntau = 3";
    assert!(averages(&scene(1.5e-6, tangential, "")));
    assert!(!averages(&scene(0.3, tangential, "")));
    // A pass is as long beside a run of a few.
    assert!(!averages(&scene(1.5e-6, "stick_ratio = 0.7\ntau = 3e-5", "")));
    let [coarse, fine] = ["1e-2", "1e-4"].map(|accuracy| format!("[numerics]\naccuracy = {accuracy}"));
    assert!(averages(&scene(1e-3, tangential, &coarse)) && !averages(&scene(1e-3, tangential, &fine)));
    assert!(!averages(&scene(1e-4, "stick_ratio = 0.7\ntau = 0.02", "[numerics]\nstepper = \"cycle-jump\"")));
    let by_force = scene(1e-4, "stick_ratio = 0.7\ntau = 0.1\ntangential_control = \"force\"", "");
    assert!(!averages(&by_force));
}

#[test]
fn runs_in_parts_repeat_every_bit() {
    for loading in
        ["stick_ratio = 0.7\ntau = 3", "amplitude_ratio = 3\ntau = 3", "stick_ratio = 0.7\nuntil_rate = 0.05"]
    {
        for accuracy in ["1e-3", "1e-4"] {
            let folder = tempfile::tempdir().unwrap();
            let scene = scene(1.5e-7, loading, &format!("[numerics]\naccuracy = {accuracy}"));
            assert!(averages(&scene));
            let (_, [whole, parts], interruptions) = whole_and_in_parts(&scene, folder.path(), 7);
            assert!(interruptions > 1 && whole == parts, "{loading:?}, {accuracy}: {interruptions}");
        }
    }
}

/// The first cycle from rest is one of the first block, and wears a quarter more.
#[test]
fn a_first_cycle_from_rest_is_one_of_the_first_block() {
    let case = Case { tau_per_cycle: 1e-3, ..Case::new(2.0, 0.0, 0.7, 24) };
    let conditions = in_passes(&laws::plain(&case.contact()), TWO, 4.0);
    let volume = |conditions: &Conditions, averages: bool, cycles: f64| {
        let model = laws::model(&case, conditions, None);
        worn(if averages { averaged(model) } else { model }, &[cycles]).0[0]
    };
    let from_rest = Conditions { wears_from_rest: true, ..conditions.clone() };
    let [averaged, stepped] = [true, false].map(|averages| volume(&from_rest, averages, 1.0));
    assert!((averaged / stepped - 1.0).abs() < 1e-9, "{averaged} and {stepped}");
    let more = volume(&from_rest, true, 400.0) - volume(&conditions, true, 400.0);
    let settled = volume(&conditions, false, 1.0);
    println!("{more:e} of {settled:e}");
    assert!(more.abs() < 2.0 * settled, "{more:e} of {settled:e}");
}

/// A pass of τ = 0.02 wears too much at first, and next to nothing later.
#[test]
fn blocks_are_stepped_through_until_passes_are_short() {
    let fine = "[numerics]\naccuracy = 1e-3";
    for loading in ["stick_ratio = 0.7\ntau = 300", "stick_ratio = 0.7\nuntil_rate = 1e-6"] {
        let scene = scene(1e-2, loading, fine);
        assert!(!averages(&scene));
        let folder = tempfile::tempdir().unwrap();
        let (results, [whole, parts], interruptions) = whole_and_in_parts(&scene, folder.path(), 300);
        let progress = &results.checkpoint().progress;
        let from = progress.averages_from * results.last().tau / results.last().cycles;
        println!(
            "{loading:?}: averaged from τ = {from}, {} steps, {interruptions} interruptions",
            progress.steps
        );
        assert!(
            from > 1.0 && from < 30.0 && (progress.steps as f64) < 3.0 * 100.0 * from,
            "{loading:?}: {from}"
        );
        assert!(interruptions > 1 && whole == parts, "{loading:?}: {interruptions}");
        // Both amplitudes leave the limit of the larger.
        let limit = results.limit().unwrap().wear_volume();
        assert!(
            (last_volume(&results) / limit - 1.0).abs() < 1e-3,
            "{loading:?}: {:e}",
            last_volume(&results)
        );
        assert!(results.error_estimate().unwrap() < 1e-3);
    }
}

/// The same times on finer passes that are stepped through longer.
#[test]
fn a_run_that_comes_to_average_keeps_to_one_that_does_not() {
    let case = Case::new(2.0, 0.0, 0.7, 24);
    let conditions = in_passes(&laws::plain(&case.contact()), TWO, 0.1);
    let of = |most_swing: f64| {
        let model = laws::model(&case, &conditions, None);
        let outputs = [10.05, 20.0, 40.0];
        let plan = Plan { outputs: outputs.to_vec(), end: End::Cycles(outputs[2]) };
        let stepper = stepper::implicit(&model, TOLERANCE);
        let mut seen = Record::default();
        let simulation = Simulation::new(model, stepper, TOLERANCE, plan).unwrap();
        let mut simulation = simulation.averaging_below(most_swing);
        simulation.run(&mut [&mut seen]).unwrap();
        let volumes: Vec<f64> =
            seen.0.iter().map(|it| it.wear_volume / simulation.model().limit_volume()).collect();
        (volumes, simulation.progress().averages_from)
    };
    let (stepped, _) = of(0.0);
    for most_swing in [1e-3, 3e-4] {
        let (averaged, from) = of(most_swing);
        let off = distance(&stepped, &averaged);
        println!("from τ = {from}: off by {off:e}, {} of the swing", off / most_swing);
        assert!(from > 0.0 && off < OF_SWING * most_swing, "{most_swing}: {off:e}");
    }
}
