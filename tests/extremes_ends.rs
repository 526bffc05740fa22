//! How runs end that no springs and no steps lead on from, refused with the moment, and what of blocks leaves nothing to follow (docs/extremes.md).

use fretwear::{Error, Results, Scene, Simulation};

const GRADING: f64 = -0.8;

/// Debris spread over a twentieth of the contact radius, on a paraboloid at half of full sliding.
fn spread(grading: f64, tau: f64, numerics: &str) -> String {
    let coefficient = tau / 1e5 / (4.0 * 1e11 * 1e-3_f64.powf(grading - 1.0) * 1e-6 * 0.625);
    format!(
        "[indenter.power-law]\ncoefficient = 1.0\nexponent = 2\n[half_space]\ngrading = {grading}\nnormal_stiffness = 1e11\nstiffness_ratio = 0.8\n\
         [friction.coulomb]\ncoefficient = 0.5\n[wear.non-local]\ncoefficient = {coefficient:e}\nlength = 5e-5\n[loading]\nindentation = 1e-6\n\
         amplitude_ratio = 0.625\ncycles = 1e5\n[numerics]\n{numerics}\n[output]\nsnapshots = 2\n"
    )
}

fn read(text: &str) -> Scene {
    Scene::from_toml(text, "scene.toml").expect("a scene")
}

fn run(text: &str) -> Results {
    read(text).simulate().expect("it comes to its end")
}

/// Key and reason.
fn refusal(text: &str) -> (&'static str, String) {
    let error = Simulation::new(&read(text)).err().expect("refused");
    match error {
        Error::Inconsistent { what, why } => (what, why),
        other => panic!("{other}"),
    }
}

/// Dimensionless time that a refusal allows.
fn allowed(why: &str) -> f64 {
    let from = why.rfind("loading.tau = ").expect("a time to end at") + "loading.tau = ".len();
    let number: String = why[from..].chars().take_while(|it| !",)".contains(*it)).collect();
    number.parse().expect("a number")
}

#[test]
fn a_rim_that_debris_spares_is_refused_and_two_meshes_agree_up_to_the_time_allowed() {
    let (key, why) = refusal(&spread(GRADING, 30.0, "accuracy = 1e-2"));
    assert_eq!(key, "wear.non-local.length");
    let tau = allowed(&why);
    // Runs on 20 to 100 springs come to no end at τ = 1.42 to 1.23.
    assert!((0.1..1.2).contains(&tau), "{why}");
    let volume = |springs: usize| {
        let scene = spread(GRADING, 30.0, &format!("springs = {springs}\ntolerance = 1e-4"));
        run(&scene.replace("cycles = 1e5", &format!("tau = {tau:e}"))).last().wear_volume
    };
    let [coarse, fine] = [volume(36), volume(72)];
    assert!((coarse / fine - 1.0).abs() < 1e-2, "{coarse:e} and {fine:e} m³ up to τ = {tau}");
}

#[test]
fn the_time_allowed_shrinks_towards_the_softest_grading_and_there_is_no_end_of_it_above() {
    let moment = |grading: f64| allowed(&refusal(&spread(grading, 1e3, "accuracy = 1e-2")).1);
    let moments = [-0.6, -0.7, -0.8, -0.9, -0.99].map(moment);
    assert!(moments.is_sorted_by(|a, b| a > b), "{moments:?}");
    assert!(Simulation::new(&read(&spread(-0.49, 1e3, "accuracy = 1e-2"))).is_ok());
}

fn by_energy(density: f64) -> String {
    spread(0.0, 1e-12, "accuracy = 1e-2").replace("[friction.coulomb]\ncoefficient = 0.5", &format!(
        "[friction.wear-dependent]\nfirst_coefficient = 0.5\nlast_coefficient = 0.6\nenergy_density = {density:e}"
    ))
}

#[test]
fn friction_that_changes_within_a_tiny_part_of_the_first_cycle_is_refused() {
    let (key, why) = refusal(&by_energy(1e-11));
    assert_eq!(key, "friction.wear-dependent.energy_density");
    assert!(why.contains("of the first cycle"), "{why}");
    assert!(Simulation::new(&read(&by_energy(1e2))).is_ok());
}

#[test]
fn a_rig_that_moves_an_edge_by_less_than_it_is_rounded_is_refused_in_words_of_the_contact() {
    let scene = spread(0.0, 3.0, "accuracy = 1e-2")
        .replace("[wear.non-local]", "[wear.archard]")
        .replace("length = 5e-5\n", "")
        .replace("amplitude_ratio = 0.625", "amplitude_ratio = 1.25e-10\nrig_stiffness = 3.2e8");
    let (key, why) = refusal(&scene);
    assert_eq!(key, "loading.amplitude_ratio");
    assert!(why.contains("slip annulus") && !why.contains("root"), "{why}");
}

/// Deeper blocks, repeated, at a hundred times full sliding: once the deeper ones have worn all within `a∞` down to their indentation, nothing presses any more, and
/// in the others nothing did for long. `V∞ = π a∞² d n/(n+2)` with `a∞² = κ a0²`, `κ = 2`; the core of the mesh, 1e-3 of that, is left.
#[test]
fn blocks_in_which_nothing_is_left_to_wear_are_passed_over_to_the_closed_form_of_gross_slip() {
    let blocks = "repeat = true\n[[loading.blocks]]\ntau = 0.6\n[[loading.blocks]]\ntau = 0.6\nindentation_factor = 1.2\n";
    let scene = spread(0.0, 3.0, "accuracy = 1e-2")
        .replace("[wear.non-local]", "[wear.archard]")
        .replace("length = 5e-5\n", "")
        .replace("amplitude_ratio = 0.625", "amplitude_ratio = 125.0")
        .replace("cycles = 1e5\n", &format!("cycles = 1e5\n{blocks}"));
    let results = run(&scene);
    assert_eq!(results.accuracy_met(), Some(true), "{:?}", results.error_estimate());
    let last = results.last();
    let depth = 1.2e-6;
    let limit = std::f64::consts::PI * depth * depth * 0.5;
    let missed = last.wear_volume / limit - 1.0;
    assert!(missed.abs() < 3e-3, "{missed:e}");
    let coefficient = 3.0 / 1e5 / (4.0 * 1e11 * 1e-3_f64.powf(-1.0) * 1e-6 * 0.625);
    let balance = last.wear_volume * 0.5 / (coefficient * last.dissipated_energy);
    assert!((balance - 1.0).abs() < 1e-2, "{balance}");
}

/// Cycles without motion, at whatever the contact is then, leave it as it is.
#[test]
fn a_block_without_motion_leaves_the_contact_as_it_is() {
    let ended = |blocks: &str| {
        let scene = spread(-0.9, 3.0, "accuracy = 1e-3")
            .replace("[wear.non-local]", "[wear.archard]")
            .replace("length = 5e-5\n", "")
            .replace("cycles = 1e5\n", blocks);
        run(&scene)
    };
    let moved = "[[loading.blocks]]\ncycles = 5e3\n";
    let at_rest = "[[loading.blocks]]\ncycles = 3e5\namplitude_factor = 0.0\n";
    let shorter = ended(&format!("cycles = 1e4\n{moved}{moved}"));
    let longer = ended(&format!("cycles = 3.1e5\n{moved}{at_rest}{moved}"));
    let [shorter, longer] = [shorter, longer].map(|it| it.last().wear_volume);
    assert!((longer / shorter - 1.0).abs() < 8e-4, "{longer:e} and {shorter:e} m³");
}

/// Below its threshold a law lets nothing wear, but what slips dissipates: the energy of each cycle, cycle after cycle.
#[test]
fn where_nothing_wears_any_more_energy_is_dissipated_at_the_rate_of_the_cycles() {
    let scene = spread(0.0, 3.0, "accuracy = 1e-3")
        .replace("[wear.non-local]", "[wear.threshold]")
        .replace("length = 5e-5", "pressure = 2e7")
        .replace("cycles = 1e5", "cycles = 1e12")
        .replace("snapshots = 2", "at_cycles = [1e9, 1e11]");
    let results = run(&scene);
    let [.., before, last] = results.snapshots() else { panic!("two snapshots") };
    assert!(before.wear_volume > 0.0 && (last.wear_volume / before.wear_volume - 1.0).abs() < 1e-3);
    let passed = last.cycles - before.cycles;
    let found = (last.dissipated_energy - before.dissipated_energy) / (passed * last.cycle_energy);
    assert!(last.cycle_energy > 0.0 && (found - 1.0).abs() < 1e-3, "{found}");
}

/// Worn volume, over its power of the amplitude, of a paraboloid whose friction rises to twice itself.
///
/// As the amplitude falls, `ε` of full sliding, the slip annulus becomes a strip of the width `~ ε`, its pressure falls as `ε^ν` and its depth as `ε^(1+μ)`: with times that grow
/// as `ε^(-ν)`, `V ~ ε^(2+μ)` up to a part of the order of `ε`.
fn of_strip(ratio: f64) -> f64 {
    let grading = -0.45;
    let (mu, nu) = (0.5 * (1.0 - grading), 0.5 * (1.0 + grading));
    let tau = 3.0 * ratio.powf(-nu);
    let scene = spread(grading, 1.0, "springs = 40\ntolerance = 1e-5")
        .replace("[wear.non-local]", "[wear.archard]")
        .replace("length = 5e-5\n", "")
        .replace("[wear", &format!("[friction.history]\nfinal_factor = 2.0\ntau = {tau:e}\n[wear"))
        .replace("amplitude_ratio = 0.625", &format!("amplitude_ratio = {ratio:e}"))
        .replace("cycles = 1e5", &format!("tau = {tau:e}"));
    run(&scene).last().wear_volume / ratio.powf(2.0 + mu)
}

/// Slopes by the place of an edge were taken over 1e-7 of its own, a third and more of such annuli.
#[test]
fn rising_friction_at_tiny_amplitudes_comes_to_the_strip_that_larger_ones_tend_to() {
    let strip = of_strip(1e-5);
    let missed = [1e-3, 3e-7, 1e-7, 1e-8].map(|ratio| of_strip(ratio) / strip - 1.0);
    let [of_first_order, tiny @ ..] = missed;
    assert!((1e-4..1e-2).contains(&of_first_order), "{missed:?}");
    assert!(tiny.iter().all(|it| it.abs() < 1e-4), "{missed:?}");
}

/// Load-dependent friction that falls in steps, a block of rest, and so long that all has worn long before the first block ends: what is left are springs that press by their
/// round-off. `V∞ = π R d²`, but for the core of the mesh, 1e-3 of the contact's area at most.
#[test]
fn what_is_worn_out_before_friction_has_changed_for_the_last_time_rests_until_the_next_block() {
    let results = run(
        "[indenter.sphere]\nradius = 442.8\n[half_space]\ngrading = 0.7\nnormal_stiffness = 781668477.0685041\nstiffness_ratio = 0.7354817022962032\n\
         [friction.load-dependent]\ncoefficient = 0.8431967922333216\nexponent = -0.21851743468629165\n[friction.history]\n\
         factors = [0.8533186022914033, 0.7093292466933184, 0.5436251980328993, 0.47695185244785493]\nat_tau = [0.0, 3.48, 70.0, 108.0]\n\
         [wear.power-law]\ncoefficient = 1.7656444878435815e-15\npressure_exponent = 1.350492899342961\nslip_exponent = 1.9227661474728528\n\
         [loading]\nindentation = 5.913630648708708e-3\namplitude_ratio = 15.202678730030458\nfrequency = 1.0\ntau = 612.0\nrepeat = true\n\
         [[loading.blocks]]\ntau = 306.0\namplitude_factor = 1.2074151066407954\n[[loading.blocks]]\ntau = 367.0\namplitude_factor = 0.0\n\
         [[loading.blocks]]\ntau = 49.0\namplitude_factor = 1.6175732334025716\n[numerics]\naccuracy = 0.0001\n[output]\nat_tau = [400.0, 600.0]\n",
    );
    let [.., at_rest, later, last] = results.snapshots() else { panic!("three snapshots") };
    let limit = std::f64::consts::PI * 442.8 * 5.913630648708708e-3_f64.powi(2);
    let missed = last.wear_volume / limit - 1.0;
    assert!(missed.abs() < 1e-3, "{missed:e}");
    assert_eq!([later, last].map(|it| it.dissipated_energy), [at_rest.dissipated_energy; 2]);
}

/// In gross slip at k = -0.925, `w ~ p^1.9`: pressure falls to half within `2^(-2/(1+k))/2` of the contact radius. There are no fewer springs than eight.
#[test]
fn a_thin_layer_at_the_contact_edge_is_told_with_the_grading_that_leaves_a_wider_one() {
    let error = read(
        "[indenter.paraboloid]\nradius = 0.31\n[half_space]\ngrading = -0.925\nmodulus = \"428 GPa\"\nreference_depth = \"14.5 mm\"\n\
         poisson_ratio = 0.343\n[friction.coulomb]\ncoefficient = 0.81\n[friction.history]\nfinal_factor = 0.78\ntau = 88000.0\n\
         [wear.power-law]\ncoefficient = 9.93e-21\npressure_exponent = 1.89\nslip_exponent = 1.75\n[wear.history]\nfinal_factor = 0.48\n\
         tau = 7925.0\n[loading]\nindentation = \"0.2087 mm\"\namplitude_ratio = 0.777\ntau = 19813.0\n[numerics]\nsprings = 8\ntolerance = 1e-3\n\
         [output]\nsnapshots = 2\n",
    )
    .simulate()
    .map(|it| it.last().tau);
    let error = error.expect_err("no step leads on").to_string();
    assert!(error.contains("half_space.grading = -0.925") && error.contains("-0.89 leaves"), "{error}");
    assert!(!error.contains("ask for"), "{error}");
}

/// A tip as sharp as `r^0.135`, worn to 1e-5 of the time of its limit, on cubics: few of them make less than nothing of so little wear. The program takes more, and by hand the estimate tells.
#[test]
fn wear_of_which_a_coarse_mesh_makes_less_than_nothing_is_found_on_a_finer_one() {
    let scene = |numerics: &str| {
        run(&format!(
            "[indenter.power-law]\ncoefficient = 5.5e-4\nexponent = 0.135\n[half_space]\ngrading = 0.0\nnormal_stiffness = 5.3e6\nstiffness_ratio = 0.98\n\
             [friction.load-dependent]\ncoefficient = 1.1\nexponent = 0.57\nreference_compression = 7.5e-4\n[friction.history]\nfinal_factor = 0.83\ncycles = 20\n\
             [wear.archard]\ncoefficient = 5.7e-13\n[loading]\nindentation = 3.3e-4\namplitude_ratio = 1.02\ntau = 1.5e-5\n[numerics]\n{numerics}\n[output]\nsnapshots = 4\n"
        ))
    };
    let [chosen, fine, coarse] = ["accuracy = 1e-3", "springs = 120", "springs = 8"].map(scene);
    let off = (chosen.last().wear_volume / fine.last().wear_volume - 1.0).abs();
    let told = chosen.error_estimate().unwrap();
    println!("off by {off:.1e}, estimated {told:.1e}");
    assert!(off <= told && told < 0.1, "{off:e}, {told:e}");
    let told = coarse.error_estimate().unwrap();
    assert!(coarse.last().wear_volume < 0.0 && told > 1.0, "{told:e}");
}

/// Springs that make less than nothing of the energy of the first cycle, at k = -0.9959 on a table, tell nothing of how fast friction changes with it.
#[test]
fn a_first_cycle_that_dissipates_less_than_nothing_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let step = 1.1163651863856186e-9;
    let rows = (0..33).map(f64::from).map(|i| format!("{:e}, {:e}\n", i * step, 2.63e-16 * i.powf(3.107)));
    std::fs::write(folder.path().join("profile.csv"), rows.collect::<String>()).expect("a table");
    let path = folder.path().join("scene.toml");
    let text = "[indenter.table]\nfile = \"profile.csv\"\n[half_space]\ngrading = -0.9958946931209366\nnormal_stiffness = 245754678922.0\n\
                stiffness_ratio = 0.6537\n[friction.wear-dependent]\nfirst_coefficient = 0.06384\nlast_coefficient = 0.05345\nenergy_density = 10879.0\n\
                [wear.threshold]\ncoefficient = \"5.51e-9 1/MPa\"\npressure = \"23683101162.9 kPa\"\n[loading]\nindentation = 1.4077337e-12\n\
                stick_ratio = 0.17925412\ntau = 5.4\nrig_stiffness = \"80373214.4 kN/m\"\n[[loading.blocks]]\ntau = 0.3675\namplitude_factor = 0.99\n\
                [numerics]\naccuracy = 1e-4\n";
    std::fs::write(&path, text).expect("a scene");
    let scene = Scene::from_path(&path).expect("a scene");
    let error = Simulation::new(&scene).map(|_| ()).expect_err("no first cycle").to_string();
    assert!(error.contains("less than nothing") && error.contains("numerics.springs"), "{error}");
}

/// Wear under a held normal force that never comes to the rate asked for ends where it is shown to, on all meshes alike.
#[test]
fn wear_without_end_is_shown_to_the_same_time_on_every_mesh() {
    let results = run(
        "[indenter.paraboloid]\nradius = 1.0\n[half_space]\ngrading = 0.3\nnormal_stiffness = 2e11\nstiffness_ratio = 0.8\n[friction.coulomb]\ncoefficient = 0.5\n\
         [wear.archard]\ncoefficient = 1e-13\n[loading]\nnormal_force = 100\namplitude_ratio = 1.5\nuntil_rate = 1e-3\n[numerics]\naccuracy = 1e-3\n",
    );
    assert!((results.last().tau - 1.0).abs() < 1e-12, "{}", results.last().tau);
    assert_eq!(results.accuracy_met(), Some(true));
}

/// Stick that friction gives up as it falls is not stick that a mesh loses by error: a deep sphere on a rig under a held normal force.
#[test]
fn stick_that_falling_friction_gives_up_in_gross_slip_is_no_error() {
    let results = run(
        "[indenter.sphere]\nradius = 1.976e8\n[half_space]\ngrading = 0.9816\nnormal_stiffness = 1.95e9\nstiffness_ratio = 0.3498\n[friction.coulomb]\ncoefficient = 0.6858\n\
         [friction.history]\nfinal_factor = 0.5023\ntau = 0.03437\n[wear.archard]\ncoefficient = 1.457e-7\n[loading]\nnormal_force = 4.767e11\nstick_ratio = 0.0335\n\
         tau = 0.1068\ntangential_control = \"rig\"\nrig_stiffness = 2.098e15\n[numerics]\naccuracy = 1e-2\n[output]\nsnapshots = 5\n",
    );
    assert_eq!(results.accuracy_met(), Some(true), "{:?}", results.error_estimate());
}

/// The limit lies at 380 times the first radius of a tip of `r^0.23`. The contact hardly wears, and the radii shown end where it does.
#[test]
fn radii_shown_end_where_the_run_does() {
    let results = run(
        "[indenter.power-law]\ncoefficient = 1.983e-4\nexponent = 0.2311\n[half_space]\ngrading = 0.4221\nnormal_stiffness = 1.916e8\nstiffness_ratio = 0.5607\n\
         [counter_body]\nnormal_stiffness = 1.848e8\nstiffness_ratio = 0.8\n[friction.coulomb]\ncoefficient = 0.4126\n[friction.history]\nfactors = [0.9861]\nat_tau = [1.523e-5]\n\
         [wear.friction-power]\nscope = \"global\"\ncoefficient = 4.765e-13\nexponent = 0.9609\nreference_power = 2.65\n[loading]\nnormal_force = 3.687e7\n\
         amplitude_ratio = 0.5935\nfrequency = 1\ncycles = 8579\n[numerics]\naccuracy = 1e-3\n[output]\nsnapshots = 5\n",
    );
    let last = results.last();
    let farthest = results.radius().last().unwrap();
    println!("to {farthest:e} m of {:e} m", last.contact_radius);
    assert!(*farthest < 1.1 * last.contact_radius && last.wear_depth.iter().any(|depth| *depth > 0.0));
    assert_eq!(results.accuracy_met(), Some(true), "{:?}", results.error_estimate());
}
