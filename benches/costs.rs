//! What the parts of a run cost as springs are added: `cargo bench`, and docs/numerics.md for figures.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use fretwear::abel::AbelOperators;
use fretwear::closed_form::LimitingShape;
use fretwear::contact::InitialContact;
use fretwear::grid::{Clustering, slip_annulus};
use fretwear::model::{Fields, Model};
use fretwear::run::Run;
use fretwear::scene::Scene;
use fretwear::simulation::{End, Plan, Simulation};
use fretwear::stepper::{Implicit, Stepper};

const SPRINGS: [usize; 5] = [50, 100, 200, 400, 800];
const SCENE: &str = include_str!("../data/scenes/paraboloid.toml");
const TOLERANCE: f64 = 3e-5;

/// Springs up to which the whole scene is measured repeatedly; beyond, once.
const MOST_REPEATED: usize = 200;

fn contact() -> InitialContact {
    Scene::from_toml(SCENE, "paraboloid.toml").expect("the scene is valid").contact().expect("in contact")
}

fn model(contact: &InitialContact, springs: usize) -> Model {
    Model::new(contact, springs, Clustering::Cubic).expect("in partial slip")
}

/// The main scene in the middle of its transient, at τ = 3; reached with a loose tolerance, for speed.
fn midway(contact: &InitialContact, springs: usize) -> Simulation {
    let cycles = 3.0 / contact.tau_per_cycle();
    let plan = Plan { outputs: vec![cycles], end: End::Cycles(cycles) };
    let loose = 1e-2;
    let stepper = Box::new(Implicit::new(loose));
    let mut simulation =
        Simulation::new(model(contact, springs), stepper, loose, plan).expect("an edge is found");
    simulation.run(&mut []).expect("steps are found");
    simulation
}

fn parts(criterion: &mut Criterion) {
    let contact = contact();
    for springs in SPRINGS {
        let nodes = slip_annulus(springs, 1.0, Clustering::Cubic);
        criterion.bench_function(&format!("operators/{springs}"), |bench| {
            bench.iter(|| AbelOperators::new(0.0, black_box(nodes.clone()), 3));
        });
        criterion.bench_function(&format!("model/{springs}"), |bench| {
            bench.iter(|| model(black_box(&contact), springs));
        });
        let simulation = midway(&contact, springs);
        let (model, state) = (simulation.model(), simulation.state());
        let mut fields = Fields::default();
        criterion.bench_function(&format!("evaluate/{springs}"), |bench| {
            bench.iter(|| model.evaluate(state.edge, black_box(&state.compression), &mut fields));
        });
        criterion.bench_function(&format!("explicit rates/{springs}"), |bench| {
            bench.iter(|| model.rates(black_box(&fields)));
        });
        let mut stepper = Implicit::new(TOLERANCE);
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
        Run::new(&scene, &output, true).expect("a run").execute(None).expect("reaches its end")
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

fn closed_form(criterion: &mut Criterion) {
    let contact = contact();
    criterion.bench_function("closed-form limit", |bench| {
        bench.iter(|| LimitingShape::from_contact(black_box(&contact)));
    });
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
    targets = closed_form, parts, whole_scene
}
criterion_main!(costs);
