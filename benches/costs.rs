//! What the parts of a run cost as springs are added: `cargo bench`, and docs/numerics.md for figures.

use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use fretwear::contact::InitialContact;
use fretwear::contact::closed_form::{HypergeometricLimit, LimitingShape};
use fretwear::contact::half_space::Poisson;
use fretwear::contact::spring::{Shakedown, SpringCycle, steady_cycle, stick_compression};
use fretwear::contact::transforms::Transforms;
use fretwear::laws::conditions::Conditions;
use fretwear::laws::friction::{Coulomb, FrictionLaw, LoadDependent, StaticKinetic};
use fretwear::laws::motion::{Mode, NormalOscillation, Orbit, SampledPath, Tangential};
use fretwear::numerics::abel::AbelOperators;
use fretwear::numerics::grid::{Clustering, Mesh};
use fretwear::run::{Run, Stop};
use fretwear::scene::Scene;
use fretwear::solver::model::{Fields, Model, OperatorStore, Resolution, Schedule};
use fretwear::solver::simulation::{End, Plan, Simulation};
use fretwear::solver::stepper::{Sdirk, Stepper};
use fretwear::study::wear_map::{Control, Medium, OptimumCurve, WearMap};

const SPRINGS: [usize; 5] = [50, 100, 200, 400, 800];
const SCENE: &str = include_str!("../data/scenes/paraboloid.toml");
const TOLERANCE: f64 = 3e-5;

/// Springs up to which the whole scene is measured repeatedly; beyond, once.
const MOST_REPEATED: usize = 200;

fn contact() -> InitialContact {
    Scene::from_toml(SCENE, "paraboloid.toml").expect("the scene is valid").contact().expect("in contact")
}

fn model(contact: &InitialContact, springs: usize) -> Model {
    Model::new(contact, &Conditions::plain(*contact.friction(), *contact.wear()), springs, Clustering::Smooth)
        .expect("in partial slip")
}

/// The main scene in the middle of its transient, at τ = 3; reached with a loose tolerance, for speed.
fn midway(contact: &InitialContact, springs: usize) -> Simulation {
    let cycles = 3.0 / contact.tau_per_cycle();
    let plan = Plan { outputs: vec![cycles], end: End::Cycles(cycles) };
    let loose = 1e-2;
    let stepper = Box::new(Sdirk::new(loose));
    let mut simulation =
        Simulation::new(model(contact, springs), stepper, loose, plan).expect("an edge is found");
    simulation.run(&mut []).expect("steps are found");
    simulation
}

fn parts(criterion: &mut Criterion) {
    let contact = contact();
    for springs in SPRINGS {
        let mesh = Mesh::new(springs, 1.0, Clustering::Smooth);
        criterion.bench_function(&format!("operators/{springs}"), |bench| {
            bench.iter(|| AbelOperators::new(0.0, black_box(mesh.clone())));
        });
        criterion.bench_function(&format!("model/{springs}"), |bench| {
            bench.iter(|| model(black_box(&contact), springs));
        });
        let simulation = midway(&contact, springs);
        let (model, state) = (simulation.model(), simulation.state());
        let mut fields = Fields::default();
        criterion.bench_function(&format!("evaluate/{springs}"), |bench| {
            bench.iter(|| model.evaluate(state.slip_area, black_box(&state.compression), &mut fields));
        });
        criterion.bench_function(&format!("explicit rates/{springs}"), |bench| {
            bench.iter(|| model.rates(black_box(&fields), simulation.cycle()));
        });
        let mut stepper = Sdirk::new(TOLERANCE);
        let cycles = 0.1 / contact.tau_per_cycle();
        let trial = stepper.step(model, state, cycles).expect("a step");
        assert!(trial.state.is_some(), "the step at {springs} springs finds no state");
        criterion.bench_function(&format!("implicit step/{springs}"), |bench| {
            bench.iter(|| stepper.step(model, black_box(state), cycles));
        });
    }
}

fn whole_scene(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let output = folder.path().join("run.h5");
    let run = |springs: usize| {
        let text = format!("{SCENE}\n[numerics]\nsprings = {springs}\n");
        let scene = Scene::from_toml(&text, "paraboloid.toml").expect("the scene is valid");
        Run::new(&scene, &output, true, &Stop::default())
            .expect("a run")
            .execute(None)
            .expect("reaches its end")
    };
    for springs in SPRINGS {
        if springs <= MOST_REPEATED {
            criterion.bench_function(&format!("main scene with its file/{springs}"), |bench| {
                bench.iter(|| run(springs));
            });
        } else {
            let start = Instant::now();
            run(springs);
            println!("main scene with its file/{springs}  once: {:.2} s", start.elapsed().as_secs_f64());
        }
    }
}

/// The main scene in memory by the accuracy that is asked for: set-up, companion, run and snapshots, as many as there are by default or that of the end alone.
fn by_accuracy(criterion: &mut Criterion) {
    for accuracy in ["1e-2", "1e-3", "1e-4"] {
        for (output, name) in [("", ""), ("[output]\nsnapshots = 1\n", ", end alone")] {
            let text = format!("{SCENE}\n[numerics]\naccuracy = {accuracy}\n{output}");
            let scene = Scene::from_toml(&text, "paraboloid.toml").expect("the scene is valid");
            criterion.bench_function(&format!("main scene in memory{name}/{accuracy}"), |bench| {
                bench.iter(|| black_box(&scene).simulate().expect("reaches its end"));
            });
        }
    }
}

fn closed_form(criterion: &mut Criterion) {
    let contact = contact();
    criterion.bench_function("closed-form limit", |bench| {
        bench.iter(|| LimitingShape::from_contact(black_box(&contact)));
    });
    criterion.bench_function("closed-form limit by series", |bench| {
        bench.iter(|| {
            let limit = HypergeometricLimit::new(black_box(2.0), 0.0, 0.35)?;
            limit.wear_volume(limit.growth()?)
        });
    });
    let transforms = Transforms::new(0.3, &[0.25]).expect("in range");
    let truncated_cone = |r: f64| if r < 0.25 { 0.0 } else { 1.0 };
    criterion.bench_function("equivalent profile of a truncated cone at one radius", |bench| {
        bench.iter(|| transforms.equivalent_profile(truncated_cone, black_box(0.8)));
    });
}

/// One spring through one period; over the substeps it is the cost of a substep, with one period of shakedown or some.
fn springs(criterion: &mut Criterion) {
    let normal = NormalOscillation { amplitude: 0.2, frequency_ratio: [1, 1], phase: 0.9 };
    let orbit = Orbit { transverse_amplitude: 1.5, phase: 0.0, centre: [0.0; 2] };
    let coulomb = Coulomb { coefficient: 0.5 };
    let kinetic = StaticKinetic { static_coefficient: 0.6, kinetic_coefficient: 0.5 };
    let load = LoadDependent { coefficient: 0.5, exponent: -0.2, reference: 1.0 };
    let cases: [(&str, &dyn Mode, &dyn FrictionLaw); 5] = [
        ("tangential", &Tangential, &coulomb),
        ("normal oscillation", &normal, &coulomb),
        ("normal oscillation, load-dependent", &normal, &load),
        ("tangential, static and kinetic", &Tangential, &kinetic),
        ("orbit", &orbit, &coulomb),
    ];
    for (name, mode, law) in cases {
        for substeps in [2, 128] {
            let path = SampledPath::new(mode, 2.0, 2.0, substeps).path;
            let mut cycle = SpringCycle::default();
            let shakedown = Shakedown::default();
            let case = format!("{name}/{} substeps", path.points.len());
            criterion.bench_function(&format!("spring: {case}"), |bench| {
                bench.iter(|| steady_cycle(&path, law, 1.0, black_box(1.5), &shakedown, &mut cycle));
            });
            println!("    periods of shakedown: {}", cycle.periods);
            criterion.bench_function(&format!("stick compression: {case}"), |bench| {
                bench.iter(|| stick_compression(black_box(&path), law, 1.0));
            });
        }
    }
}

/// A cycle in closed form, by the table of what springs repeat along a line and on an ellipse, and passed step by step beside a normal oscillation, over springs and substeps.
fn resolved_cycles(criterion: &mut Criterion) {
    let contact = contact();
    let plain = Conditions::plain(*contact.friction(), *contact.wear());
    let transverse_amplitude = 0.6 * contact.amplitude();
    let orbit: Arc<dyn Mode> = Arc::new(Orbit { transverse_amplitude, phase: 0.0, centre: [0.0; 2] });
    let line: Arc<dyn Mode> = Arc::new(Tangential);
    let amplitude = 0.1 * contact.indentation();
    let pressing: Arc<dyn Mode> =
        Arc::new(NormalOscillation { amplitude, frequency_ratio: [1, 1], phase: 0.9 });
    for springs in [30, 60, 120] {
        let mut measure = |name: &str, mode: &Arc<dyn Mode>, substeps: Option<usize>| {
            let conditions = Conditions { mode: mode.clone(), ..plain.clone() };
            let resolution = Resolution { resolved: substeps.is_some(), substeps };
            let schedule = Schedule::new(&contact, &conditions, resolution).expect("a schedule");
            let store = OperatorStore::default();
            let model =
                Model::under(&contact, schedule, springs, Clustering::Cubic, &store).expect("it slips");
            let state = model.initial_state().expect("an edge is found");
            let (fields, loading) = (model.fields(&state), model.schedule().loading(0.0, 0.0));
            criterion.bench_function(&format!("cycle: {name}/{springs} springs"), |bench| {
                bench.iter(|| model.cycle(&loading, black_box(&state.compression), &fields));
            });
            let before = model.work_counted();
            model.cycle(&loading, &state.compression, &fields);
            println!("    counted as {} ns", model.work_counted() - before);
        };
        measure("closed form", &line, None);
        measure("line", &line, Some(96));
        measure("ellipse", &orbit, Some(96));
        for substeps in [16, 96] {
            measure(&format!("pressing, {substeps} substeps"), &pressing, Some(substeps));
        }
    }
}

/// Maps in closed form: one thread and all threads in the same run.
fn maps(criterion: &mut Criterion) {
    let medium = Medium::new(2.0, Poisson::Similar).expect("a paraboloid");
    let gradings: Vec<f64> = (0..400).map(|i| -0.9 + 1.89 * f64::from(i) / 399.0).collect();
    let amplitudes: Vec<f64> = (0..400).map(|i| 1e-4 * 1e4f64.powf(f64::from(i) / 399.0)).collect();
    let some: Vec<f64> = amplitudes.iter().step_by(4).copied().collect();
    for threads in [1, 0] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let name = format!("{} threads", pool.current_num_threads());
        criterion.bench_function(&format!("wear map 400 x 400/{name}"), |bench| {
            bench.iter(|| pool.install(|| WearMap::new(&medium, black_box(&gradings), &amplitudes)));
        });
        criterion.bench_function(&format!("optimal grading at 100 amplitudes/{name}"), |bench| {
            bench
                .iter(|| pool.install(|| OptimumCurve::new(&medium, Control::Indentation, black_box(&some))));
        });
    }
}

fn settings() -> Criterion {
    Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(100))
        .measurement_time(Duration::from_millis(500))
}

criterion_group! {
    name = costs;
    config = settings();
    targets = closed_form, springs, resolved_cycles, maps, parts, whole_scene, by_accuracy
}
criterion_main!(costs);
