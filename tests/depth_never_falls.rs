//! What is worn stays worn: depth, volume and energy of runs of every kind, from snapshot to snapshot.

mod support;

use fretwear::contact::InitialContact;
use fretwear::laws::conditions::Conditions;
use fretwear::laws::history::History;
use fretwear::laws::loading::TangentialControl;
use fretwear::solver::model::Model;
use fretwear::solver::simulation::{End, Observer, Plan, Simulation};
use fretwear::solver::stepper::{Bdf, CycleJump, EveryCycle, Sdirk, Stepper};
use support::{Case, laws};

/// Depth, volume and energy at the outputs.
#[derive(Default)]
struct Seen(Vec<(f64, Vec<f64>, f64, f64)>);

impl Observer for Seen {
    fn output(&mut self, simulation: &Simulation) -> fretwear::Result<()> {
        let (model, state) = (simulation.model(), simulation.state());
        let depth = if state.cycles > 0.0 { simulation.wear_depth() } else { vec![0.0; model.radii().len()] };
        let volume = model.worn_volume(state, simulation.fields());
        self.0.push((state.cycles, depth, volume, state.dissipated_energy));
        Ok(())
    }
}

fn stepper(model: &Model) -> Box<dyn Stepper + Send> {
    match model.moving() {
        Some(_) => Box::new(Sdirk::new(1e-4)),
        None if model.wears_steadily() => Box::new(Bdf::new(1e-4)),
        None => Box::new(Sdirk::new(1e-4)),
    }
}

/// Falls of depth and volume from output to output, over their largest values, and the least depth.
fn falls(model: Model, stepper: Box<dyn Stepper + Send>, times: &[f64]) -> fretwear::Result<[f64; 3]> {
    let last = times[times.len() - 1];
    let radii = model.radii();
    let plan = Plan { outputs: times.to_vec(), end: End::Cycles(last) };
    let mut seen = Seen::default();
    Simulation::new(model, stepper, 1e-4, plan)?.run(&mut [&mut seen])?;
    let seen = seen.0;
    assert_eq!(seen.len(), times.len() + 1);
    let end = &seen[seen.len() - 1];
    let deepest = end.1.iter().fold(0.0, |m: f64, depth| m.max(*depth));
    let (mut depth, mut volume, mut least) = (0.0_f64, 0.0_f64, 0.0_f64);
    for pair in seen.windows(2) {
        for (i, (before, after)) in pair[0].1.iter().zip(&pair[1].1).enumerate() {
            if (before - after) / deepest > ALLOWED.max(depth) {
                println!(
                    "falls at {:.4} m from {:.5} to {:.5} before {:.3} cycles",
                    radii[i],
                    before / deepest,
                    after / deepest,
                    pair[1].0
                );
            }
            depth = depth.max((before - after) / deepest);
            least = least.min(*after / deepest);
        }
        volume = volume.max((pair[0].2 - pair[1].2) / end.2);
        assert!(pair[1].3 >= pair[0].3, "energy falls from {} to {}", pair[0].3, pair[1].3);
    }
    Ok([depth, volume, least])
}

fn table(factors: &[f64], times: &[f64]) -> History {
    History::Table { times: times.to_vec(), factors: factors.to_vec() }
}

/// Kinds of runs.
fn kinds(contact: &InitialContact) -> Vec<(String, Conditions)> {
    let plain = laws::plain(contact);
    let mut kinds = vec![("plain".to_owned(), plain.clone())];
    let mut add = |name: &str, conditions: Conditions| kinds.push((name.to_owned(), conditions));
    for (name, wear) in laws::wear_laws(contact).into_iter().chain(laws::other_wear_laws(contact)) {
        add(name, Conditions { wear, ..plain.clone() });
    }
    for (name, friction) in laws::friction_laws(contact) {
        add(name, Conditions { friction, ..plain.clone() });
    }
    for (name, mode) in laws::modes(contact) {
        add(name, Conditions { mode, ..plain.clone() });
    }
    for (name, factors, times) in [
        ("friction falls", vec![1.0, 0.8], vec![0.0, 2.0]),
        ("friction rises", vec![1.0, 1.4], vec![0.0, 2.0]),
        ("friction rises and falls", vec![1.0, 1.4, 1.0], vec![0.0, 1.0, 3.0]),
    ] {
        add(name, Conditions { friction_history: table(&factors, &times), ..plain.clone() });
    }
    add("held force", Conditions { holds_normal_force: true, ..plain.clone() });
    add(
        "held tangential force",
        Conditions { tangential_control: TangentialControl::Force, ..plain.clone() },
    );
    add("rig", Conditions { tangential_control: TangentialControl::Rig { stiffness: 2.0 }, ..plain.clone() });
    for (name, factors, repeat) in [
        ("blocks grow", [0.5, 0.8, 1.0], false),
        ("blocks shrink", [1.0, 0.6, 0.4], false),
        ("blocks shrink and grow", [1.0, 0.5, 0.75], false),
        ("blocks shrink and grow on", [0.9, 0.5, 1.0], false),
        ("blocks recur", [1.0, 0.4, 0.75], true),
    ] {
        let blocks = factors.map(|factor| laws::block(1.3, factor, 1.0)).to_vec();
        add(name, Conditions { blocks, repeat, ..plain.clone() });
    }
    let blocks = vec![laws::block(1.0, 1.0, 1.0), laws::block(1.0, 1.0, 0.9)];
    add("depths recur", Conditions { blocks, repeat: true, ..plain.clone() });
    kinds
}

/// Largest fall that is allowed, over the largest depth: of the order of what a run on so few springs is off by.
const ALLOWED: f64 = 2e-4;

/// The same under a law and along a path that are steep at the edge of stick: measured 2.3e-3 and 9e-4.
const ALLOWED_NEXT_TO_STICK: f64 = 5e-3;
const STEEP: [&str; 2] = ["p^0.7", "slanted ellipse"];

#[test]
fn depth_volume_and_energy_never_fall() {
    let times: Vec<f64> =
        [1e-4, 1e-3, 0.01].into_iter().chain((1..=40).map(|i| 0.2 * f64::from(i) + 0.0123)).collect();
    let mut faults = vec![];
    for (exponent, grading, stick_ratio) in [(2.0, 0.0, 0.7), (1.0, -0.3, 0.5), (4.0, 0.4, 0.7)] {
        let case = Case::new(exponent, grading, stick_ratio, 40);
        for (name, conditions) in kinds(&case.contact()) {
            let place = format!("n {exponent} k {grading} {name}");
            let held = ["held tangential force", "rig", "load-dependent 0.3", "depths recur"]
                .contains(&name.as_str());
            if (exponent, grading) != (2.0, 0.0) && (!conditions.mode.is_tangential() || held) {
                // Long, or the whole contact comes to slide, or more springs are needed.
                continue;
            }
            let model = laws::model(&case, &conditions, None);
            let stepper = stepper(&model);
            let found = match falls(model, stepper, &times) {
                Ok(found) => found,
                Err(error) => {
                    faults.push(format!("{place}: {error}"));
                    continue;
                }
            };
            println!(
                "{place}: depth falls by {:.1e}, volume by {:.1e}; least {:.1e}",
                found[0], found[1], found[2]
            );
            // Next to the edge of stick, within some 1e-6 of the annulus, the pressure is a property of the mesh.
            let allowed = if STEEP.contains(&name.as_str()) { ALLOWED_NEXT_TO_STICK } else { ALLOWED };
            if !(found[0] < allowed && found[1] <= 1e-12 && found[2] >= 0.0) {
                faults.push(format!("{place}: {found:?}"));
            }
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn under_explicit_steps_depth_never_falls() {
    let case =
        Case { clustering: fretwear::numerics::grid::Clustering::Quadratic, ..Case::new(2.0, 0.0, 0.7, 24) };
    let case = Case { tau_per_cycle: 1e-3, ..case };
    let times = [1.0, 10.0, 50.0, 100.0, 200.0];
    let steppers: [Box<dyn Stepper + Send>; 2] =
        [Box::new(EveryCycle::default()), Box::new(CycleJump::default())];
    for stepper in steppers {
        let found = falls(laws::model(&case, &laws::plain(&case.contact()), None), stepper, &times).unwrap();
        println!("{found:?}");
        assert!(found[0] < ALLOWED && found[1] <= 1e-12 && found[2] >= 0.0, "{found:?}");
    }
}
