//! Springs that are held harder while they stick than while they slip, under held forces and on a rig; edges of stick that come to rest.

use std::str::FromStr;

use fretwear::contact::closed_form::LimitingShape;
use fretwear::scene::Scene;
use fretwear::{Error, Results, Simulation};

const STATIC: &str = "[friction.static-kinetic]\nstatic_coefficient = 0.6\nkinetic_coefficient = 0.5";
const ARCHARD: &str = "[wear.archard]\ncoefficient = 1e-3";
const FORCE: &str = "tangential_control = \"force\"";
/// That of an indentation of 1 at k = 0.
const HELD: &str = "normal_force = 1.3333333333333333";

struct Case<'a> {
    grading: f64,
    friction: &'a str,
    wear: &'a str,
    loading: &'a str,
    springs: usize,
}

impl Case<'_> {
    fn scene(&self) -> Scene {
        let Self { grading, friction, wear, loading, springs } = self;
        Scene::from_str(&format!(
            "[indenter.paraboloid]\nradius = 1\n[half_space]\ngrading = {grading}\nnormal_stiffness = 1\nstiffness_ratio = 1\n{friction}\n{wear}\n\
             [loading]\n{loading}\n[numerics]\nsprings = {springs}\ntolerance = 1e-5\n[output]\nsnapshots = 4\n",
        ))
        .unwrap()
    }

    fn run(&self) -> Results {
        Simulation::new(&self.scene()).unwrap().run().unwrap_or_else(|error| panic!("{error}"))
    }

    fn error(&self) -> Error {
        let found = Simulation::new(&self.scene()).and_then(|simulation| simulation.run().map(drop));
        found.expect_err("a run that does not come to its end")
    }
}

fn at_rest<'a>(friction: &'a str, loading: &'a str, springs: usize) -> Case<'a> {
    Case { grading: 0.0, friction, wear: ARCHARD, loading, springs }
}

/// By how much the volume in the end of a run is off that of the limit under both forces, and the stick radius off that of the first cycle, relative.
fn beside_both_forces(scene: &Scene) -> [f64; 2] {
    let mut conditions = scene.conditions().clone();
    conditions.tangential_control = fretwear::laws::loading::TangentialControl::Force;
    let contact = scene.contact().unwrap();
    let limit = LimitingShape::under(&contact, &conditions).unwrap().unwrap();
    let results = scene.simulate().unwrap_or_else(|error| panic!("{error}"));
    let last = results.last();
    [last.wear_volume / limit.wear_volume(), last.stick_radius / contact.stick_radius().unwrap()]
        .map(|ratio| ratio - 1.0)
}

/// Under both forces, and on a rig beside a held normal force, springs that slip go on to, so that the edge stays where it is in the first cycle, and the
/// limit is that of Coulomb's friction with the same stick radius.
#[test]
fn beside_a_held_normal_force_the_edge_rests_and_the_limit_is_that_of_the_first_stick_radius() {
    let wear = [
        (ARCHARD, 1e3),
        ("[wear.power-law]\ncoefficient = 1e-3\npressure_exponent = 1\nslip_exponent = 0.5", 1e3),
    ];
    for (wear, tau) in wear {
        for control in [FORCE, "rig_stiffness = 2"] {
            let loading = format!("{HELD}\nstick_ratio = 0.7\n{control}\ntau = {tau:e}");
            let case = Case { wear, ..at_rest(STATIC, &loading, 60) };
            let [off, moved] = beside_both_forces(&case.scene());
            println!("{wear}, {control}: volume off by {off:.1e}, stick radius by {moved:.1e}");
            assert!(off.abs() < 2e-5, "{wear}, {control}: {off:e}");
            assert!(moved.abs() < 1e-12, "{wear}, {control}: {moved:e}");
        }
    }
}

/// Slip sets in with a jump at the edge of stick: the order is 1.5, with Coulomb's friction it is 2.9.
#[test]
fn under_a_balance_of_forces_volumes_converge() {
    for control in [FORCE, "rig_stiffness = 4"] {
        let loading = format!("indentation = 1\nstick_ratio = 0.7\n{control}\ntau = 6");
        let volumes =
            [60, 120, 240].map(|springs| at_rest(STATIC, &loading, springs).run().last().wear_volume);
        let [first, second] = [volumes[1] - volumes[0], volumes[2] - volumes[1]].map(f64::abs);
        let order = (first / second).log2();
        println!("{control}: {volumes:.7?}, order {order:.1}");
        assert!(order > 1.3 && second < 1e-4 * volumes[2], "{control}: {volumes:?}, order {order}");
    }
}

/// `μ_s c g_0'(c)/(1+k) = (μ_s - μ_k) (d - g_0(c))`; with g_0 = x² at k = 0 and d = 1 that is c² = 1/13.
#[test]
fn a_held_force_breaks_the_contact_away_where_springs_lose_more_than_those_that_stick_gain() {
    let breaks = 1.0 / 13.0_f64.sqrt();
    let loading =
        |ratio: f64, tau: f64| format!("indentation = 1\nstick_ratio = {ratio}\n{FORCE}\ntau = {tau}");
    let moment = |springs: usize| {
        let words = at_rest(STATIC, &loading(0.7, 30.0), springs).error().to_string();
        let number = |after: &str, until: &str| -> f64 {
            let rest = words.split_once(after).unwrap_or_else(|| panic!("{words}")).1;
            rest.split_once(until).unwrap().0.parse().unwrap()
        };
        [number("(τ = ", ")"), number("within the radius ", " m")]
    };
    let [coarse, fine] = [60, 120].map(moment);
    println!(
        "stick is lost at τ = {} and {}, from the radii {} and {}",
        coarse[0], fine[0], coarse[1], fine[1]
    );
    assert!((coarse[0] / fine[0] - 1.0).abs() < 1e-3, "{coarse:?}, {fine:?}");
    assert!((fine[1] / breaks - 1.0).abs() < 0.02, "{fine:?} against {breaks}");
    // It holds the force at first, or not at all.
    assert!(at_rest(STATIC, &loading(1.05 * breaks, 1e-4), 60).run().last().wear_volume > 0.0);
    let refused = at_rest(STATIC, &loading(0.97 * breaks, 1e-4), 60).error().to_string();
    assert!(refused.contains("breaks away") && refused.contains("loading.stick_ratio"), "{refused}");
}

/// At k = 0 and d = 1, `g_0 = x²`: the stick radius of springs of compression `q`.
fn radius_of(compression: f64) -> f64 {
    (1.0 - compression).sqrt()
}

/// Springs that have slipped go on to as the amplitude falls or friction rises, by up to `(μ_s + μ_k)/2 μ_s`; those that never did stay. So the edge rests, or moves to
/// where springs are pressed as hard as that, and the limit is that of Coulomb's friction with the same stick radius. What is worn before counts little.
#[test]
fn springs_that_have_slipped_go_on_to_down_to_the_mean_of_both_limits() {
    let edge = 1.0 - 0.7_f64 * 0.7;
    let limit = |compression: f64| {
        let loading =
            format!("indentation = 1\nstick_ratio = {}\ntau = 1000", radius_of(compression.min(edge)));
        at_rest("[friction.coulomb]\ncoefficient = 0.6", &loading, 60).run().last().wear_volume
    };
    let mean = 0.6 / 0.55;
    let with_blocks = |factor: f64, cycle: &str| {
        let blocks = format!(
            "[[loading.blocks]]\ntau = 1e-3\n[[loading.blocks]]\ntau = 1000\namplitude_factor = {factor}\n"
        );
        let loading = format!("indentation = 1\nstick_ratio = 0.7\ntau = 200\n{blocks}");
        let text =
            at_rest(STATIC, &loading, 240).scene().text().replace("[output]", &format!("{cycle}[output]"));
        text.parse::<Scene>().unwrap().simulate().unwrap().last().wear_volume
    };
    for factor in [0.95, 0.8] {
        let (found, exact) = (with_blocks(factor, ""), limit(edge * factor * mean));
        println!("blocks to {factor}: {:.1e}", found / exact - 1.0);
        assert!((found / exact - 1.0).abs() < 1e-3, "blocks to {factor}: {found}, {exact}");
        let resolved = with_blocks(factor, "cycle = \"resolved\"\n");
        assert!((resolved / found - 1.0).abs() < 1e-9, "blocks to {factor}: {resolved}, {found}");
    }
    // Friction that rises no farther than that leaves the edge where it is.
    let rising = format!("{STATIC}\n[friction.history]\nfinal_factor = 1.08\ntau = 0.1");
    let loading = "indentation = 1\nstick_ratio = 0.7\ntau = 200";
    let results = at_rest(&rising, loading, 240).run();
    let off = results.last().wear_volume / limit(edge) - 1.0;
    println!("friction to 1.08: {off:.1e}");
    assert!(off.abs() < 1e-4, "{off:e}");
    assert!((results.last().stick_radius / 0.7 - 1.0).abs() < 1e-12);
}

/// Springs beyond the groove at the edge stick one by one as friction rises, which converges slowly, and the estimate of springs by hand says so; the balance of both volumes saw nothing of it.
#[test]
fn friction_that_rises_farther_is_told_by_the_estimate() {
    let rising = format!("{STATIC}\n[friction.history]\nfinal_factor = 1.2\ntau = 0.3");
    let loading = "indentation = 1\nstick_ratio = 0.7\ntau = 30";
    let [coarse, fine] = [80, 240].map(|springs| at_rest(&rising, loading, springs).run());
    let contact = at_rest(&rising, loading, 80).scene().contact().unwrap();
    let limit = LimitingShape::from_contact(&contact).unwrap().unwrap().wear_volume();
    let off = (coarse.last().wear_volume - fine.last().wear_volume).abs() / limit;
    let told = coarse.error_estimate().expect("an estimate");
    println!("off by {off:.1e}, told {told:.1e}");
    assert!(off > 1e-3 && told > 0.5 * off, "{off:e}, {told:e}");
}

/// Under a held normal force the edge rests, for ground next to it wears from the first cycle on; the limit is that of the first stick radius, as under both forces. Where the coefficients
/// differ by little, springs beyond the groove next to the edge are pressed so hard in time that they stick again, at the mean of both limits.
#[test]
fn under_a_held_normal_force_the_edge_rests_and_springs_stick_again_at_the_mean_of_both_limits() {
    let scene = |kinetic: f64, grading: f64, tau: f64| {
        let friction =
            format!("[friction.static-kinetic]\nstatic_coefficient = 0.6\nkinetic_coefficient = {kinetic}");
        let loading = format!("{HELD}\nstick_ratio = 0.7\ntau = {tau:e}");
        let text = Case { grading, friction: &friction, loading: &loading, ..at_rest("", "", 60) }.scene();
        text.text().replace("snapshots = 4", "snapshots = 40").parse::<Scene>().unwrap()
    };
    for kinetic in [0.3, 0.5, 0.55] {
        let [off, moved] = beside_both_forces(&scene(kinetic, 0.0, 1e3));
        println!("kinetic {kinetic}: volume off by {off:.1e}, stick radius by {moved:.1e}");
        assert!(off.abs() < 2e-5 && moved.abs() < 1e-9, "kinetic {kinetic}: {off:e}, {moved:e}");
    }
    let kinetic = 0.57;
    let scene = scene(kinetic, 0.5, 300.0);
    let contact = scene.contact().unwrap();
    let first = contact.stick_radius().unwrap();
    let height = contact.indentation() - contact.slip_compression();
    let mean = contact.slip_compression() * 2.0 / (1.0 + kinetic / 0.6);
    let results = scene.simulate().unwrap();
    let sticks_farther = |it: &&fretwear::Snapshot| it.stick_radius > first * (1.0 + 1e-9);
    let since = results.snapshots().iter().find(sticks_farther).expect("springs that stick again");
    let before = results.snapshots().iter().rev().find(|it| it.tau < since.tau).expect("a start");
    let pressed = [before, since].map(|it| it.indentation - height);
    println!("springs stick again between τ = {} and {}: {pressed:?} of {mean}", before.tau, since.tau);
    assert!(pressed[1] > mean && pressed[0] < 1.05 * mean, "{pressed:?} of {mean}");
}

/// In gross slip under a held normal force springs next to the axis are pressed harder as those around them wear. At the axis the equivalent profile is the profile.
#[test]
fn what_slides_sticks_again_at_the_mean_of_both_limits() {
    let close = "[friction.static-kinetic]\nstatic_coefficient = 0.52\nkinetic_coefficient = 0.5";
    let amplitude = 0.53;
    let loading = format!("{HELD}\namplitude = {amplitude}\ntau = 4");
    let text = at_rest(close, &loading, 40).scene().text().replace("snapshots = 4", "snapshots = 40");
    let results = text.parse::<Scene>().unwrap().simulate().unwrap();
    let mean = 2.0 * amplitude / (0.52 + 0.5);
    let mut sticks = [0, 0];
    for it in results.snapshots() {
        let pressed = it.indentation - it.wear_depth[0];
        let stuck = it.stick_radius > 0.0;
        sticks[usize::from(stuck)] += 1;
        assert_eq!(stuck, pressed > mean, "at τ = {}: {pressed} of {mean}", it.tau);
    }
    assert!(sticks.iter().all(|count| *count > 2), "{sticks:?}");
}

/// A soft rig breaks the contact away at once, and goes on to move it: from the stick ratio that is asked for into gross slip.
#[test]
fn a_rig_goes_on_to_move_what_it_has_broken_away() {
    for (grading, tau) in [(-0.3, 6.0), (0.0, 4.0), (0.5, 4.0)] {
        let loading = format!("indentation = 1\nstick_ratio = 0.5\nrig_stiffness = 0.5\ntau = {tau}");
        let [coarse, fine] =
            [60, 240].map(|springs| Case { grading, ..at_rest(STATIC, &loading, springs) }.run());
        let (first, last) = (&fine.snapshots()[0], fine.last());
        let ratio = first.stick_radius / first.contact_radius;
        assert!((ratio - 0.5).abs() < 1e-6, "k = {grading}: {ratio}");
        assert!(last.stick_radius == 0.0 && last.contact_radius > first.contact_radius, "k = {grading}");
        let off = coarse.last().wear_volume / last.wear_volume - 1.0;
        let by_energy = 1e-3 / 0.5 * last.dissipated_energy / last.wear_volume - 1.0;
        println!("k = {grading}: 60 springs off by {off:.1e}, energy by {by_energy:.1e}");
        assert!(off.abs() < 1e-3 && by_energy.abs() < 1e-3, "k = {grading}: {off:e}, {by_energy:e}");
    }
}

/// What slides as a whole does not come to its static limit: it is Coulomb's friction with the kinetic coefficient.
#[test]
fn gross_slip_on_a_rig_is_that_of_the_kinetic_coefficient() {
    let coulomb = "[friction.coulomb]\ncoefficient = 0.5";
    for load in ["indentation = 1", HELD] {
        for rig in [0.1, 2.0] {
            // Beyond what both springs and rig bear under the static coefficient.
            let amplitude = 0.6 + 0.6 * 4.0 / 3.0 / rig;
            let loading = format!("{load}\namplitude = {amplitude}\nrig_stiffness = {rig}\ncycles = 1250");
            let [found, same] =
                [STATIC, coulomb].map(|friction| at_rest(friction, &loading, 24).run().last().wear_volume);
            println!("{load}, rig {rig}: {:.1e}", found / same - 1.0);
            assert!((found / same - 1.0).abs() < 2e-5, "{load}, rig {rig}: {found}, {same}");
        }
    }
}

/// Towards k = 1 a contact in gross slip comes to be pressed evenly. A soft rig that just broke a cone away then bears more than it can, for even springs break away
/// at once, at the mean of both limits.
#[test]
fn a_rig_that_no_longer_breaks_all_springs_away_is_told() {
    let run = |amplitude: f64| {
        let text = format!(
            "[indenter.cone]\nslope = 1e-3\n[half_space]\ngrading = 0.9\nnormal_stiffness = 2e11\nstiffness_ratio = 0.8\n[friction.static-kinetic]\n\
             static_coefficient = 0.36\nkinetic_coefficient = 0.3\n[wear.archard]\ncoefficient = 1e-14\n[loading]\nnormal_force = 188\n\
             amplitude = {amplitude}\nrig_stiffness = 1e5\nfrequency = 1\ntau = 20\n[output]\nsnapshots = 4\n"
        );
        let scene = Scene::from_str(&text).unwrap();
        Simulation::new(&scene).and_then(Simulation::run)
    };
    let words = run(580e-6).expect_err("a run that does not come to its end").to_string();
    assert!(words.contains("no longer breaks all springs away"), "{words}");
    assert_eq!(run(640e-6).unwrap().last().stick_radius, 0.0);
}

#[test]
fn what_the_past_of_single_springs_would_decide_is_refused() {
    let blocks = "[[loading.blocks]]\ntau = 0.3\n[[loading.blocks]]\ntau = 1\namplitude_factor = 0.7";
    let rising = format!("{STATIC}\n[friction.history]\nfinal_factor = 1.2\ntau = 1");
    let falling = format!("{STATIC}\n[friction.history]\nfinal_factor = 0.9\ntau = 1");
    let held = "indentation = 1\nstick_ratio = 0.7";
    for (friction, load, beside, key) in [
        (STATIC, held, blocks, "loading.blocks"),
        (&rising, held, "", "friction.history"),
        (&falling, "normal_force = 1.3333333333333333\nstick_ratio = 0.7", "", "friction.history"),
    ] {
        for control in [FORCE, "rig_stiffness = 4"] {
            let loading = format!("{load}\n{control}\ntau = 1\n{beside}");
            let words = at_rest(friction, &loading, 60).error().to_string();
            for part in [key, "past of each", "friction.coulomb"] {
                assert!(words.contains(part), "{control}: {words}");
            }
        }
    }
    // Also where a block moves all of the contact.
    let blocks = "[[loading.blocks]]\ntau = 0.2\n[[loading.blocks]]\ntau = 0.8\namplitude_factor = 20";
    let words =
        at_rest(STATIC, &format!("{held}\nrig_stiffness = 4\ntau = 1\n{blocks}"), 60).error().to_string();
    assert!(words.contains("loading.blocks") && words.contains("past of each"), "{words}");
    let loading = format!("{held}\n{FORCE}\ntau = 1");
    assert!(at_rest(&falling, &loading, 60).run().last().wear_volume > 0.0);
}

/// Behind the front compressions swing about zero next to the edge of stick; the balance of forces must not have a kink there.
#[test]
fn a_held_tangential_force_over_a_stiffening_surface_comes_to_its_end_on_many_springs() {
    let coulomb = "[friction.coulomb]\ncoefficient = 0.5";
    let loading = format!("indentation = 1\nstick_ratio = 0.7\n{FORCE}\ntau = 60");
    let volumes = [60, 120, 240].map(|springs| {
        Case { grading: -0.3, ..at_rest(coulomb, &loading, springs) }.run().last().wear_volume
    });
    println!("{volumes:.7?}");
    // What the steps are off by.
    assert!(volumes.iter().all(|volume| (volume / volumes[2] - 1.0).abs() < 5e-5), "{volumes:?}");
}

/// Ahead of a front of slip that cells do not resolve slip over the period must not be negative: steps became ever smaller.
#[test]
fn along_an_orbit_falling_friction_comes_to_the_limit_of_the_last_stick_radius() {
    let friction = "[friction.coulomb]\ncoefficient = 0.5\n[friction.history]\nfinal_factor = 0.8\ntau = 3";
    let loading = "indentation = 1\namplitude_ratio = 0.45\ntau = 300\norbit = { transverse_ratio = 0.6 }";
    let off = [24, 48].map(|springs| {
        let scene = Case { grading: -0.3, ..at_rest(friction, loading, springs) }.scene();
        let results = Simulation::new(&scene).unwrap().run().unwrap();
        let last = results.last();
        let contact = scene.contact().unwrap();
        let limit = LimitingShape::from_stick_ratio(
            scene.indenter(),
            -0.3,
            1.0,
            last.stick_radius / contact.contact_radius(),
        );
        last.wear_volume / limit.unwrap().wear_volume() - 1.0
    });
    println!("{off:?}");
    assert!(off.iter().all(|off| off.abs() < 1e-3), "{off:?}");
}
