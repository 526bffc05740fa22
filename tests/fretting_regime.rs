//! Energy ratio, sliding ratio and fretting regime: closed forms of power laws, a reference table, and the loops of runs.

mod support;

use fretwear::Scene;
use fretwear::contact::InitialContact;
use fretwear::contact::indenter::power_law_factor;
use fretwear::contact::stick_slip::{FrettingRegime, Regime};
use support::reference::{Table, relative};

const GRADINGS: [f64; 4] = [-0.3, 0.0, 0.5, 0.9];
const EXPONENTS: [f64; 3] = [1.0, 2.0, 4.0];

/// The indenter `r^n` in a contact of radius one, stiffnesses and friction one, under some lines of `[loading]`.
fn scene(exponent: f64, grading: f64, loading: &str) -> Scene {
    let text = format!(
        "[indenter.power-law]\ncoefficient = 1.0\nexponent = {exponent:e}\n[half_space]\ngrading = {grading:e}\n\
         normal_stiffness = 1.0\nstiffness_ratio = 1.0\n[friction.coulomb]\ncoefficient = 1.0\n[wear.archard]\ncoefficient = 1e-3\n\
         [loading]\nindentation = {:e}\n{loading}\n",
        power_law_factor(exponent, grading)
    );
    text.parse().unwrap()
}

fn contact(exponent: f64, grading: f64, amplitude: &str) -> InitialContact {
    scene(exponent, grading, &format!("{amplitude}\ntau = 1")).contact().unwrap()
}

/// `F ∝ 1 - (1 - u/U_t)^m` up to gross slip, `m = (n+1+k)/n`.
///
/// With `v = U/U_t` and `s = max(1 - v, 0)`, the area of Masing's loop and its place of no force,
///
/// ```text
/// A = 2 [v - (1 - s^(m+1))/(m+1)]/(v (1 - s^m)) - 1,   D = 1 - (2/v) [1 - ((1 + s^m)/2)^(1/m)]
/// ```
fn closed_form(exponent: f64, grading: f64, v: f64) -> [f64; 2] {
    let m = (exponent + 1.0 + grading) / exponent;
    let s = (1.0 - v).max(0.0);
    let energy = 2.0 * (v - (1.0 - s.powf(m + 1.0)) / (m + 1.0)) / (v * (1.0 - s.powf(m))) - 1.0;
    [energy, 1.0 - 2.0 / v * (1.0 - (0.5 * (1.0 + s.powf(m))).powf(m.recip()))]
}

#[test]
fn ratios_of_the_unworn_loop_are_those_of_the_closed_form_in_both_regimes() {
    for grading in GRADINGS {
        for exponent in EXPONENTS {
            let transition = (1.0 + grading) / (2.0 * exponent + 1.0 + grading);
            // Of gross slip A = 1 - (1 - A_t)/v.
            assert!(
                (closed_form(exponent, grading, 3.0)[0] - (1.0 - (1.0 - transition) / 3.0)).abs() < 1e-14
            );
            for v in [0.2, 0.9, 1.0, 1.5, 20.0] {
                let contact = contact(exponent, grading, &format!("amplitude_ratio = {v:e}"));
                let found = [contact.energy_ratio().unwrap(), contact.sliding_ratio().unwrap()];
                let expected = closed_form(exponent, grading, v);
                let place = format!("k = {grading}, n = {exponent}, U/U_t = {v}: {found:?}, {expected:?}");
                assert!(relative(contact.energy_ratio_transition().unwrap(), transition) < 1e-13, "{place}");
                assert!((0..2).all(|i| (found[i] - expected[i]).abs() < 1e-13), "{place}");
            }
        }
    }
    // The digits of small amplitudes: A = D = (m-1)/6 v and (m-1)/4 v to first order.
    let small = contact(2.0, 0.0, "amplitude_ratio = 1e-9");
    assert!(relative(small.energy_ratio().unwrap(), 1e-9 / 12.0) < 1e-8);
    assert_eq!(contact(2.0, 0.0, "amplitude_ratio = 0").energy_ratio().unwrap(), 0.0);
    // A sphere's transition by the sliding ratio is the 0.26 of Fouvry, Kapsa and Vincent.
    assert!(
        (contact(2.0, 0.0, "amplitude_ratio = 1").sliding_ratio().unwrap() - 0.259_921_049_894_873).abs()
            < 1e-13
    );
}

#[test]
fn the_energy_ratio_is_that_of_the_table() {
    let table = Table::read("energy_ratio.csv");
    for row in &table.rows {
        let [k, n, stick, expected] =
            ["k", "n", "stick_ratio", "energy_ratio"].map(|name| table.number(row, name));
        let amplitude =
            if stick == 0.0 { "amplitude_ratio = 1".into() } else { format!("stick_ratio = {stick:e}") };
        let found = contact(n, k, &amplitude).energy_ratio().unwrap();
        assert!(relative(found, expected) < 1e-12, "{row:?}: {found}");
    }
    assert_eq!(table.rows.len(), 5);
}

#[test]
fn a_run_begins_with_the_ratios_of_the_unworn_loop() {
    for grading in [-0.2, 0.0, 0.5] {
        for exponent in [1.0, 2.0] {
            for v in [0.3, 0.8, 2.0, 8.0] {
                let loading = format!("amplitude_ratio = {v:e}\ntau = 0.01");
                let results = scene(exponent, grading, &loading).simulate().unwrap();
                let found = [results.energy_ratio()[0], results.sliding_ratio()[0]];
                let expected = closed_form(exponent, grading, v);
                let [energy, sliding] = [0, 1].map(|i| relative(found[i], expected[i]));
                println!("k = {grading}, n = {exponent}, U/U_t = {v}: {energy:.1e}, {sliding:.1e}");
                // Between the springs the force has a kink where slip begins, at half of it within a cell.
                let met = energy < 1e-4 && sliding < 5e-3;
                assert!(met, "k = {grading}, n = {exponent}, U/U_t = {v}: {found:?}, {expected:?}");
            }
        }
    }
}

#[test]
fn a_run_is_mixed_once_some_cycles_slid_as_a_whole_and_some_did_not() {
    use FrettingRegime::{FullSliding as Gross, Mixed, PartialSlip as Partial, Stick};
    let after = FrettingRegime::after;
    assert_eq!(after(None, Regime::Stick, false), Stick);
    assert_eq!(after(Some(Stick), Regime::PartialSlip, false), Partial);
    assert_eq!(after(Some(Partial), Regime::Stick, false), Partial);
    assert_eq!(after(Some(Partial), Regime::FullSliding, true), Mixed);
    assert_eq!(after(Some(Gross), Regime::FullSliding, true), Gross);
    assert_eq!(after(Some(Mixed), Regime::FullSliding, true), Mixed);
    // A cycle between two snapshots slid.
    assert_eq!(after(Some(Partial), Regime::PartialSlip, true), Mixed);
    // A dead weight: just above the amplitude of full sliding the contact comes to stick again, just below it never slides.
    let text = include_str!("../data/scenes/normal_force.toml");
    let regimes = |amplitude: &str, weight: &str| {
        let text = text.replace("0.325 um", amplitude).replace("normal_force = \"10 N\"", weight);
        text.parse::<Scene>().unwrap().simulate().unwrap().fretting_regime()
    };
    let held = "normal_force = \"10 N\"";
    let above = regimes("0.66 um", held);
    assert_eq!((above[0], above[above.len() - 1]), (Gross, Mixed));
    assert!(above.is_sorted_by_key(|it| *it == Mixed));
    assert!(regimes("0.6 um", held).iter().all(|it| *it == Partial));
    assert!(regimes("0.9 um", held).iter().all(|it| *it == Gross));
    let blocks = "initial_force = \"10 N\"\nblocks = [{ tau = 1, amplitude_factor = 1 }, { tau = 1, amplitude_factor = 3 }]";
    let growing = regimes("0.3 um", blocks);
    assert_eq!((growing[0], growing[growing.len() - 1]), (Partial, Mixed));
}

#[test]
fn an_orbit_has_no_energy_ratio() {
    let text = include_str!("../data/scenes/orbit.toml");
    let results = text.parse::<Scene>().unwrap().simulate().unwrap();
    assert!(results.energy_ratio().iter().chain(&results.sliding_ratio()).all(|it| it.is_nan()));
}
