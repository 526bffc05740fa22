//! Gross slip in blocks at different indentations, each on the ground that those before have worn.

mod support;

use std::f64::consts::PI;
use std::fmt::Write as _;

use fretwear::Results;
use fretwear::scene::Scene;

/// Radius of the paraboloid, m, and worn volume per energy, m³/J.
const RADIUS: f64 = 10e-3;
const PER_ENERGY: f64 = 2e-13;
const TIGHT: &str = "accuracy = 1e-4\n";
const PARABOLOID: &str = "[indenter.paraboloid]\nradius = \"10 mm\"";

/// A contact that slides to and fro by more than 1.2 times what full sliding takes.
fn scene(indenter: &str, grading: f64, loading: &str, numerics: &str) -> Scene {
    let text = format!(
        "{indenter}\n[half_space]\ngrading = {grading}\nnormal_stiffness = 1e11\nstiffness_ratio = 0.8\n\
         [friction.coulomb]\ncoefficient = 0.5\n[wear.archard]\ncoefficient = 1e-13\n\
         [loading]\namplitude = \"800 nm\"\n{loading}\n[numerics]\n{numerics}\n"
    );
    text.parse().unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Blocks of these dimensionless times, amplitude factors and indentation factors, under a paraboloid at 1 µm.
fn blocks(blocks: &[[f64; 3]], more: &str) -> String {
    let mut text = format!("indentation = \"1 um\"\n{more}\n");
    for [tau, amplitude, depth] in blocks {
        let _ = write!(
            text,
            "[[loading.blocks]]\ntau = {tau}\namplitude_factor = {amplitude}\nindentation_factor = {depth}\n"
        );
    }
    text
}

fn run(scene: &Scene) -> Results {
    scene.simulate().unwrap_or_else(|error| panic!("{error}\n{}", scene.text()))
}

/// The last block wears flat whatever presses on it: at its indentation `d` within the radius `√(2Rd)`, if that is beyond all that was worn before.
#[test]
fn the_last_block_wears_flat() {
    for grading in [-0.6, -0.3, 0.0, 0.5] {
        for depth in [0.9, 0.95] {
            let loading = blocks(&[[1.0, 1.0, 1.0], [1.0, 1.0, depth]], "tau = 3000");
            let results = run(&scene(PARABOLOID, grading, &loading, "accuracy = 1e-3"));
            let indentation = depth * 1e-6;
            let radius = (2.0 * RADIUS * indentation).sqrt();
            let volume = PI * RADIUS * indentation * indentation;
            let last = results.last();
            let off = [last.wear_volume / volume, last.contact_radius / radius].map(|ratio| ratio - 1.0);
            println!("k = {grading}, d = {depth}: {off:?}");
            assert!(off.iter().all(|it| it.abs() < 1e-6), "k = {grading}, d = {depth}: {off:?}");
            assert!((last.indentation / indentation - 1.0).abs() < 1e-12);
        }
    }
}

/// A first block at a smaller indentation than a later one wears as if it were alone.
#[test]
fn a_first_block_that_is_shallower_wears_as_one_that_is_alone() {
    for grading in [-0.3, 0.0, 0.5] {
        let alone = run(&scene(PARABOLOID, grading, "indentation = \"0.7 um\"\ncycles = 300", TIGHT));
        let first = "cycles = 300\n[[loading.blocks]]\ncycles = 400\nindentation_factor = 0.7\n[[loading.blocks]]\ncycles = 1";
        let first = run(&scene(PARABOLOID, grading, &format!("indentation = \"1 um\"\n{first}"), TIGHT));
        let pairs = [
            [first.last().wear_volume, alone.last().wear_volume],
            [first.last().normal_force, alone.last().normal_force],
            [first.last().contact_radius, alone.last().contact_radius],
        ];
        let off = pairs.map(|[one, other]| one / other - 1.0);
        println!("k = {grading}: {off:?}");
        assert!(off.iter().all(|it| it.abs() < 2e-4), "k = {grading}: {off:?}");
    }
}

/// The second block wears as a contact of its own, with the worn profile as its indenter: a table, whose first contact is found in another way.
#[test]
fn a_block_wears_as_a_contact_whose_indenter_the_one_before_has_worn() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("worn.csv");
    for grading in [-0.3, 0.0, 0.5] {
        for depth in [0.6, 0.9] {
            let until = |tau: f64| {
                let loading = blocks(&[[1.0, 1.0, 1.0], [1.0, 1.0, depth]], &format!("tau = {tau}"));
                run(&scene(PARABOLOID, grading, &loading, &format!("{TIGHT}springs = 60")))
            };
            let [first, both] = [until(1.0), until(2.0)];
            let (radius, worn) = (first.radius(), &first.last().wear_depth);
            let heights: Vec<f64> =
                radius.iter().zip(worn).map(|(r, worn)| r * r / (2.0 * RADIUS) + worn).collect();
            let [near, next] = [0, 1].map(|i| radius[i] * radius[i]);
            let tip = heights[0] - (heights[1] - heights[0]) * near / (next - near);
            let mut rows = "0,0\n".to_owned();
            for (r, height) in radius.iter().zip(&heights) {
                let _ = writeln!(rows, "{r:e},{:e}", height - tip);
            }
            // The table goes on unworn to beyond where the block comes.
            for i in 1..60 {
                let r = radius[radius.len() - 1] * 1.02_f64.powi(i);
                let _ = writeln!(rows, "{r:e},{:e}", r * r / (2.0 * RADIUS) - tip);
            }
            std::fs::write(&file, rows).unwrap();
            let indenter = format!("[indenter.table]\nfile = {file:?}\nsmoothing = 0");
            let loading =
                format!("indentation = {:e}\ncycles = {:e}", depth * 1e-6 - tip, first.last().cycles);
            let alone = run(&scene(&indenter, grading, &loading, ""));
            let volume = both.last().wear_volume - first.last().wear_volume;
            let off = [
                volume / alone.last().wear_volume,
                both.last().contact_radius / alone.last().contact_radius,
                both.last().normal_force / alone.last().normal_force,
            ]
            .map(|ratio| ratio - 1.0);
            println!("k = {grading}, d = {depth}: {off:?}");
            assert!(off.iter().all(|it| it.abs() < 2e-4), "k = {grading}, d = {depth}: {off:?}");
        }
    }
}

/// Blocks that recur, of other amplitudes as well, and a pause: what the profile has lost is what energy wears, and four times the springs come to the same.
#[test]
fn blocks_that_recur_wear_what_their_energy_does() {
    for grading in [-0.3, 0.0, 0.5] {
        for (name, sequence) in [
            ("two depths", vec![[1.0, 1.0, 1.0], [1.0, 1.0, 0.6]]),
            ("deeper later", vec![[1.0, 1.0, 0.7], [1.0, 1.0, 1.0]]),
            ("amplitudes too", vec![[0.5, 1.0, 1.0], [0.5, 1.2, 0.6], [0.5, 1.0, 0.8]]),
            ("a pause", vec![[0.3, 1.0, 1.0], [0.3, 0.0, 0.6], [0.3, 1.0, 0.6]]),
        ] {
            let on = |springs: usize| {
                let loading = blocks(&sequence, "tau = 6\nrepeat = true");
                run(&scene(PARABOLOID, grading, &loading, &format!("{TIGHT}springs = {springs}")))
            };
            let [coarse, fine] = [on(24), on(96)];
            let springs = coarse.last().wear_volume / fine.last().wear_volume - 1.0;
            let energies = fine.snapshots().iter().map(|it| {
                (it.wear_volume - PER_ENERGY * it.dissipated_energy).abs() / fine.last().wear_volume
            });
            let energy = energies.fold(0.0, f64::max);
            println!("k = {grading}, {name}: by springs {springs:.1e}, by energy {energy:.1e}");
            assert!(springs.abs() < 4e-4 && energy < 5e-5, "k = {grading}, {name}: {springs:e}, {energy:e}");
        }
    }
}

/// An oscillation, normal or along an orbit, that is small changes little, though its periods are resolved: less than the oscillation itself.
#[test]
fn small_oscillations_beside_blocks_change_little() {
    let normal =
        "[loading.normal_oscillation]\namplitude_ratio = 0.01\nfrequency_ratio = 1\nphase = \"90 deg\"";
    let orbit = "[loading.orbit]\ntransverse_ratio = 0.15\nphase = \"90 deg\"";
    for grading in [-0.3, 0.0, 0.5] {
        let volume = |mode: &str| {
            let loading = blocks(&[[1.0, 1.0, 1.0], [1.0, 1.0, 0.7]], "tau = 3\nrepeat = true");
            run(&scene(PARABOLOID, grading, &format!("{loading}{mode}"), "")).last().wear_volume
        };
        let plain = volume("");
        for (mode, within) in [(normal, 5e-3), (orbit, 2e-2)] {
            let off = volume(mode) / plain - 1.0;
            println!("k = {grading}, {mode}: {off:.1e}");
            assert!(off.abs() < within, "k = {grading}, {mode}: {off:e}");
        }
    }
}

/// A block that does not touch what was worn deeper before wears nothing; and the next that does goes on.
#[test]
fn a_block_that_does_not_touch_wears_nothing() {
    let sequence = [[60.0, 1.0, 1.0], [1.0, 1.0, 0.4], [1.0, 1.0, 1.1]];
    let until = |tau: f64| {
        let loading = blocks(&sequence, &format!("tau = {tau}"));
        run(&scene(PARABOLOID, 0.0, &loading, "springs = 32")).last().wear_volume
    };
    let [before, after, on] = [60.0, 61.0, 62.0].map(until);
    println!("{before:e} {after:e} {on:e}");
    assert!((after / before - 1.0).abs() < 1e-6 && on > 1.02 * before, "{before:e} {after:e} {on:e}");
}

#[test]
fn blocks_in_gross_slip_that_are_interrupted_go_on_as_if_they_had_not_been() {
    let folder = tempfile::tempdir().unwrap();
    let loading = blocks(&[[0.5, 1.0, 0.8], [0.5, 1.0, 1.0], [0.5, 1.0, 0.6]], "tau = 5\nrepeat = true");
    let scene = scene(PARABOLOID, 0.0, &loading, "springs = 24");
    let (run, [whole, parts], interruptions) = support::resume::whole_and_in_parts(&scene, folder.path(), 5);
    println!("{interruptions} interruptions, {} steps", run.checkpoint().progress.steps);
    assert!(run.checkpoint().state.ground.is_some());
    assert!(interruptions >= 10 && whole == parts);
}

/// A paraboloid in blocks of these dimensionless times and amplitudes, over that of full sliding.
fn amplitudes(grading: f64, held: &str, blocks: &[[f64; 2]], tau: f64, numerics: &str) -> Scene {
    let [_, first] = blocks[0];
    let mut text = format!(
        "{PARABOLOID}\n[half_space]\ngrading = {grading}\nnormal_stiffness = 1e11\nstiffness_ratio = 0.8\n\
         [friction.coulomb]\ncoefficient = 0.5\n[wear.archard]\ncoefficient = 1e-13\n\
         [loading]\n{held}\namplitude_ratio = {first}\ntau = {tau}\n"
    );
    for [tau, amplitude] in blocks {
        let _ = write!(text, "[[loading.blocks]]\ntau = {tau}\namplitude_factor = {:?}\n", amplitude / first);
    }
    text += &format!("[numerics]\n{numerics}\n");
    text.parse().unwrap_or_else(|error| panic!("{error}\n{text}"))
}

const HELD: [&str; 2] = ["indentation = \"1 um\"", "normal_force = 10"];

/// A moment of gross slip changes nothing of what partial slip wears after it, once Coulomb's friction has shaken down.
#[test]
fn after_a_moment_of_gross_slip_partial_slip_wears_as_from_the_beginning() {
    for grading in [-0.3, 0.0, 0.5] {
        for held in HELD {
            let [after, alone] = [&[[1e-6, 1.2], [4.0, 0.8]][..], &[[4.0, 0.8]]]
                .map(|blocks| run(&amplitudes(grading, held, blocks, 4.0, "accuracy = 1e-4")));
            let off = after.last().wear_volume / alone.last().wear_volume - 1.0;
            let stick = after.last().stick_radius / alone.last().stick_radius - 1.0;
            let estimate = after.error_estimate().unwrap();
            println!(
                "k = {grading}, {held}: volume {off:.1e}, stick radius {stick:.1e}, {estimate:.1e} told"
            );
            // Measured: 1.5e-3 and 6.4e-4 told at k = -0.3 under a held force, 8.7e-5 at most elsewhere.
            let allowed = if grading < 0.0 && held == HELD[1] { 3.0 * estimate } else { 2e-4 };
            assert!(
                off.abs() < allowed && stick.abs() < allowed,
                "k = {grading}, {held}: {off:e}, {stick:e}"
            );
        }
    }
}

/// From gross slip to partial slip, and to less of it: on more springs as much wears, and what the profile has lost is what the cycles have worn.
#[test]
fn gross_slip_before_partial_slip_is_within_what_is_told() {
    for (name, blocks) in [
        ("one", &[[1.0, 1.2], [4.0, 0.7]][..]),
        ("two", &[[0.5, 1.2], [1.0, 0.8], [3.0, 0.6]]),
        ("a pause", &[[0.5, 1.2], [1.0, 0.0], [3.0, 0.6]]),
        ("more of it first", &[[0.2, 1.1], [0.3, 1.3], [3.0, 0.6]]),
    ] {
        for held in HELD {
            let [found, fine] = ["accuracy = 1e-3", "springs = 140\ntolerance = 1e-6"]
                .map(|numerics| run(&amplitudes(0.0, held, blocks, 3.0, numerics)));
            let (last, estimate) = (found.last(), found.error_estimate().unwrap());
            let off = (last.wear_volume / fine.last().wear_volume - 1.0).abs();
            let rings = found.radius().windows(2).zip(last.wear_depth.windows(2));
            let of_profile: f64 =
                rings.map(|(r, w)| PI * (r[1] - r[0]) * (r[0] * w[0] + r[1] * w[1])).sum::<f64>()
                    + PI * found.radius()[0].powi(2) * last.wear_depth[0];
            let lost = of_profile / last.wear_volume - 1.0;
            println!("{name}, {held}: off by {off:.1e}, {estimate:.1e} told, profile {lost:.1e}");
            assert!(
                off < 1e-3 && off < 4.0 * estimate && lost.abs() < 2e-3,
                "{name}, {held}: {off:e}, {estimate:e}, {lost:e}"
            );
            assert!(last.stick_radius > 0.3 * last.contact_radius, "{}", last.stick_radius);
        }
    }
}

#[test]
fn partial_slip_after_gross_slip_that_is_interrupted_goes_on_as_if_it_had_not_been() {
    for held in HELD {
        let scene = amplitudes(0.0, held, &[[0.5, 1.2], [1.0, 0.8], [3.0, 0.6]], 3.0, "accuracy = 1e-2");
        let folder = tempfile::tempdir().expect("a folder");
        let (_, [whole, parts], interruptions) =
            support::resume::whole_and_in_parts(&scene, folder.path(), 3);
        assert!(interruptions > 5 && whole == parts, "{held}: {interruptions} interruptions");
    }
}

/// Partial slip, gross slip and partial slip again: on other springs as much wears, in steps that the accuracy asks for, and interruptions change nothing.
#[test]
fn gross_slip_between_blocks_of_partial_slip_is_within_what_is_told() {
    let on = |numerics: &str| {
        amplitudes(0.0, HELD[1], &[[1.54, 0.634], [1.99, 1.484], [0.37, 0.415]], 3.9, numerics)
    };
    let asked = on("accuracy = 1e-3");
    let folder = tempfile::tempdir().expect("a folder");
    let (found, [whole, parts], interruptions) =
        support::resume::whole_and_in_parts(&asked, folder.path(), 40);
    let fine = run(&on("springs = 150\ntolerance = 1e-6"));
    let off = (found.last().wear_volume / fine.last().wear_volume - 1.0).abs();
    let (estimate, steps) = (found.error_estimate().unwrap(), found.checkpoint().progress.steps);
    println!("off by {off:.1e}, {estimate:.1e} told, {steps} steps, {interruptions} interruptions");
    // Measured: 1.6e-3 told, for the profile next to the edge of stick of the first block.
    assert!(estimate < 2e-3 && off < 1e-4, "{off:e}, {estimate:e}");
    // Measured: 175; to round-off they were 16,500.
    assert!(steps < 500, "{steps} steps");
    assert!(interruptions > 2 && whole == parts, "{interruptions} interruptions");
}

/// At an indentation that is held the blocks before gross slip wear as they do alone, what they have worn stays as gross slip begins, and on other springs as much wears in the end.
#[test]
fn gross_slip_takes_up_what_partial_slip_has_worn() {
    for (grading, blocks) in [
        (-0.22, &[[2.23, 0.551], [0.31, 1.553]][..]),
        (0.0, &[[0.53, 0.517], [1.23, 0.35], [1.0, 1.4], [1.64, 0.6]]),
        (0.5, &[[1.45, 0.891], [1.98, 1.838]]),
    ] {
        let until = |tau: f64, numerics: &str| amplitudes(grading, HELD[0], blocks, tau, numerics);
        let gross = blocks.iter().position(|[_, amplitude]| *amplitude > 1.25).expect("gross slip");
        let before: f64 = blocks[..gross].iter().map(|[tau, _]| tau).sum();
        let alone = run(&until(before, "accuracy = 1e-6"));
        let taken_up = run(&until(before * (1.0 + 1e-5), TIGHT));
        let stays = taken_up.last().wear_volume / alone.last().wear_volume - 1.0;
        assert!(taken_up.last().stick_radius == 0.0, "k = {grading}: {}", taken_up.last().stick_radius);

        let all = blocks.iter().map(|[tau, _]| tau).sum();
        let [found, fine] =
            [TIGHT, "springs = 130\ntolerance = 1e-7"].map(|numerics| run(&until(all, numerics)));
        let (last, estimate) = (found.last(), found.error_estimate().unwrap());
        let off = last.wear_volume / fine.last().wear_volume - 1.0;
        let by_energy = last.wear_volume / (PER_ENERGY * last.dissipated_energy) - 1.0;
        println!(
            "k = {grading}: {stays:.1e} as it begins, {off:.1e} at the end, {estimate:.1e} told, {by_energy:.1e} by energy"
        );
        // What the mesh does not carry is worn off soon, as energy tells; until then it is told. Measured: 5.2e-4 where 4.2e-4 is told.
        let told = taken_up.error_estimate().unwrap();
        assert!(stays.abs() < (2.0 * told).min(1e-3), "k = {grading}: {stays:e}, {told:e} told");
        // Measured: 2.8e-4 told at k = 0.5, for the profile of the first snapshot in gross slip.
        assert!(
            estimate < 4e-4 && off.abs() < 1e-4 && by_energy.abs() < 3e-4,
            "k = {grading}: {off:e}, {estimate:e}, {by_energy:e}"
        );
    }
}

#[test]
fn gross_slip_between_blocks_that_is_interrupted_goes_on_as_if_it_had_not_been() {
    let blocks = [[0.5, 0.5], [0.5, 0.7], [0.5, 1.4], [0.5, 0.6]];
    let scene = amplitudes(0.0, HELD[0], &blocks, 2.0, "accuracy = 1e-3");
    let folder = tempfile::tempdir().expect("a folder");
    let (_, [whole, parts], interruptions) = support::resume::whole_and_in_parts(&scene, folder.path(), 10);
    assert!(interruptions > 5 && whole == parts, "{interruptions} interruptions");
}

/// A moment of gross slip changes nothing of what partial slip around it wears. What the mesh over the whole contact loses of the steep ground is worn anew, and told.
#[test]
fn a_moment_of_gross_slip_between_equal_blocks_is_told() {
    for grading in [-0.2, 0.0, 0.5] {
        let on = |blocks: &[[f64; 2]], tau: f64| {
            run(&amplitudes(grading, HELD[0], blocks, tau, "accuracy = 1e-3"))
        };
        let broken = on(&[[2.0, 0.8], [1e-3, 1.3], [5.0, 0.8]], 7.001);
        let alone = on(&[[7.0, 0.8]], 7.0);
        let off = (broken.last().wear_volume / alone.last().wear_volume - 1.0).abs();
        let estimate = broken.error_estimate().unwrap();
        println!("k = {grading}: off by {off:.1e}, {estimate:.1e} told");
        // Measured: 2.2e-2, 7.5e-3 and 1.3e-3; on one mesh they had been 3.0e-2, 9.8e-3 and 6.5e-4.
        assert!(off < 3e-2 && off < 1.5 * estimate, "k = {grading}: {off:e}, {estimate:e}");
    }
}

/// On few springs polynomials swing above what slips, where nothing sticks in any block that is left.
#[test]
fn gross_slip_after_long_partial_slip_comes_to_its_end() {
    let results = run(&amplitudes(-0.3, HELD[0], &[[20.0, 0.8], [5.0, 1.3]], 20.1, "accuracy = 1e-3"));
    let (last, estimate) = (results.last(), results.error_estimate().unwrap());
    let by_energy = last.wear_volume / (PER_ENERGY * last.dissipated_energy) - 1.0;
    println!("{estimate:.1e} told, {by_energy:.1e} by energy");
    assert!(by_energy.abs() < 1e-3 && last.stick_radius == 0.0, "{by_energy:e}");
}
