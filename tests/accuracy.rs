//! What `numerics.accuracy` promises: the error asked for, and an estimate of it that is near.

use fretwear::data::RunFile;
use fretwear::laws::conditions::Conditions;
use fretwear::numerics::grid::Clustering;
use fretwear::scene::Scene;
use fretwear::solver::model::{Model, State};
use fretwear::solver::simulation::{End, Observer, Plan, Simulation};
use fretwear::solver::stepper::Bdf;

/// Grading, exponent of the indenter, stick ratio, dimensionless time.
type Case = (f64, f64, f64, f64);

const CASES: [Case; 4] =
    [(-0.5, 2.0, 0.7, 30.0), (0.0, 2.0, 0.7, 30.0), (0.9, 2.0, 0.7, 30.0), (0.2, 1.0, 0.3, 3.0)];

fn scene((grading, exponent, stick_ratio, tau): Case, numerics: &str) -> Scene {
    let text = format!(
        "[indenter.power-law]\ncoefficient = 1.0\nexponent = {exponent}\n[half_space]\ngrading = {grading}\nnormal_stiffness = 1e9\n\
         stiffness_ratio = 1.0\n[friction.coulomb]\ncoefficient = 0.5\n[wear.archard]\ncoefficient = 1e-14\n[loading]\nindentation = 1e-6\n\
         stick_ratio = {stick_ratio}\ntau = {tau}\n[numerics]\n{numerics}\n"
    );
    Scene::from_toml(&text, "case.toml").expect("a scene")
}

#[derive(Default)]
struct Seen(Vec<State>);

impl Observer for Seen {
    fn output(&mut self, simulation: &Simulation) -> fretwear::Result<()> {
        self.0.push(simulation.state().clone());
        Ok(())
    }
}

/// Largest error of worn volume and of depth at the radii of a run, over its snapshots, against 140 springs and steps that are off by 1e-9.
fn error(case: Case, file: &RunFile) -> f64 {
    let contact = scene(case, "").contact().expect("a contact");
    let model = Model::new(
        &contact,
        &Conditions::plain(*contact.friction(), *contact.wear()),
        140,
        Clustering::Smooth,
    )
    .expect("a model");
    let outputs: Vec<f64> = file.snapshots[1..].iter().map(|it| it.cycles).collect();
    let plan = Plan { end: End::Cycles(outputs[outputs.len() - 1]), outputs };
    let mut seen = Seen::default();
    let mut simulation = Simulation::new(model, Box::new(Bdf::new(1e-9)), 1e-9, plan).expect("a start");
    simulation.run(&mut [&mut seen]).expect("a run");
    let model = simulation.into_model();
    let stick_area = contact.stick_radius().expect("partial slip").powi(2);
    let mut largest = 0.0_f64;
    for (state, shown) in seen.0.iter().zip(&file.snapshots).skip(1) {
        let fields = model.fields(state);
        largest = largest.max((model.wear_volume(&fields) - shown.wear_volume).abs() / model.limit_volume());
        for (r, depth) in file.header.radius.iter().zip(&shown.wear_depth) {
            let exact = model.wear_depth_at(state, &fields, r * r - stick_area);
            largest = largest.max((exact - depth).abs() / model.depth_scale());
        }
    }
    largest
}

fn run(case: Case, numerics: &str) -> (f64, usize, RunFile) {
    let results = scene(case, numerics).simulate().expect("an end");
    (results.error_estimate().expect("an estimate"), results.springs(), results.into_file())
}

#[test]
fn a_run_is_as_accurate_as_asked_and_its_estimate_is_near_its_error() {
    for case in CASES {
        for accuracy in [1e-2, 1e-3, 1e-4, 1e-5] {
            let (estimate, springs, file) = run(case, &format!("accuracy = {accuracy:e}"));
            let error = error(case, &file);
            assert!(
                error <= accuracy && estimate <= accuracy,
                "{case:?}: {accuracy:e} asked, {error:e} found, {estimate:e} estimated on {springs} springs"
            );
            assert!(
                (0.2..5.0).contains(&(error / estimate)),
                "{case:?}, {accuracy:e} asked: error {error:e}, estimate {estimate:e}"
            );
        }
    }
}

#[test]
fn a_tenth_of_the_error_takes_more_springs_and_more_steps() {
    for case in CASES {
        let found = [1e-3, 1e-4, 1e-5].map(|accuracy| {
            let (_, springs, file) = run(case, &format!("accuracy = {accuracy:e}"));
            (springs, file.checkpoint.expect("kept").progress.steps)
        });
        assert!(
            found.windows(2).all(|pair| pair[1].0 > pair[0].0 && pair[1].1 > pair[0].1),
            "{case:?}: {found:?}"
        );
    }
}

#[test]
fn springs_and_tolerance_by_hand_each_override_the_accuracy() {
    let case = CASES[1];
    let (_, chosen, _) = run(case, "accuracy = 1e-3");
    let (_, by_hand, _) = run(case, "accuracy = 1e-3\nsprings = 61");
    let (_, with_tolerance, file) = run(case, "accuracy = 1e-3\ntolerance = 1e-7");
    assert_eq!((by_hand, with_tolerance), (61, chosen));
    let steps = |file: RunFile| file.checkpoint.expect("kept").progress.steps;
    let (_, _, coarse) = run(case, "accuracy = 1e-3");
    assert!(steps(file) > 2 * steps(coarse));
}
