//! The closed form against tables of 17 digits (`data/reference`), against limits known by hand, and over random parameters.

mod support;

use fretwear::Error;
use fretwear::contact::closed_form::{
    LimitingShape, Regime, full_sliding_amplitude, paraboloid_contact_radius, paraboloid_stick_radius,
    relative_limit_width, relative_slip_width, similar_stiffness_ratio, slip_compression,
};
use fretwear::contact::indenter::{Indenter, power_law_factor};
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use std::f64::consts::PI;
use support::reference::{Table, Worst, relative};

/// Power law with `g = x^n`, so that `a0 = d = 1`.
fn unit_power_law(exponent: f64, grading: f64) -> Indenter {
    Indenter::power_law(1.0 / power_law_factor(exponent, grading), exponent).unwrap()
}

#[test]
fn limiting_shapes_agree_with_the_table() {
    let table = Table::read("limiting.csv");
    let mut worst = Worst::default();
    for row in &table.rows {
        let of = |name| table.number(row, name);
        let (n, k, ratio) = (of("n"), of("k"), of("c_over_a0"));
        let shape = LimitingShape::from_stick_ratio(&unit_power_law(n, k), k, 1.0, ratio).unwrap();
        worst.note("kappa", relative(power_law_factor(n, k), of("kappa")), row);
        worst.note("mindlin", relative(similar_stiffness_ratio(k), of("mindlin_m")), row);
        worst.note("slip compression", relative(shape.slip_compression(), of("u_over_umax")), row);
        worst.note("a∞", relative(shape.contact_radius_limit(), of("a_inf_over_a0")), row);
        worst.note("a∞ - c", relative(shape.slip_width_limit(), of("a_inf_minus_c_over_a0")), row);
        worst.note("a∞ - a0", relative(shape.contact_growth_limit(), of("a_inf_minus_a0_over_a0")), row);
        worst.note("ΔV", relative(shape.wear_volume() / PI, of("dv_over_pi_a0sq_d")), row);
        worst.note(
            "ΔV Eq 15",
            relative(shape.wear_volume_asymptotic() / PI, of("dv_eq15_over_pi_a0sq_d")),
            row,
        );
        let small = relative_slip_width(shape.slip_width_initial(), shape.stick_radius());
        worst.note("ε_a", relative(small, of("eps_a")), row);
        worst.note("ε", relative(shape.slip_width_limit() / shape.stick_radius(), of("eps_exact")), row);
        worst.note("ε Eq 14", relative(relative_limit_width(k, small), of("eps_eq14")), row);
        worst.note("max Δf", relative(shape.wear_depth_max(), of("max_df_over_d")), row);
        let place = shape.wear_depth_max_radius() - shape.stick_radius();
        worst.note("r max", (place - of("r_max_minus_c_over_a0")).abs(), row);
        worst.note("load fraction", relative(shape.load_fraction(), of("fn_worn_over_fn_initial")), row);
    }
    for (quantity, tolerance) in [
        ("kappa", 5e-15),
        ("mindlin", 1e-15),
        ("slip compression", 1e-15),
        ("a∞", 1e-14),
        ("a∞ - c", 1e-14),
        ("a∞ - a0", 3e-14),
        ("ΔV", 1e-13),
        ("ΔV Eq 15", 3e-14),
        ("ε_a", 3e-15),
        ("ε", 1e-14),
        ("ε Eq 14", 3e-15),
        ("max Δf", 1e-14),
        ("r max", 1e-14),
        ("load fraction", 5e-15),
    ] {
        worst.below(quantity, tolerance);
    }
}

#[test]
fn tiny_amplitudes_keep_their_digits() {
    let table = Table::read("small_amplitude.csv");
    let mut worst = Worst::default();
    for row in &table.rows {
        let of = |name| table.number(row, name);
        let (n, k) = (of("n"), of("k"));
        let compression = slip_compression(similar_stiffness_ratio(k), of("ubar"), 1.0);
        let shape = LimitingShape::new(&unit_power_law(n, k), k, 1.0, compression).unwrap();
        worst.note("a0 - c", relative(shape.slip_width_initial(), of("one_minus_c_over_a0")), row);
        worst.note("ε", relative(shape.slip_width_limit() / shape.stick_radius(), of("eps_exact")), row);
        worst.note("a∞ - a0", relative(shape.contact_growth_limit(), of("a_inf_minus_a0_over_a0")), row);
        worst.note("ΔV", relative(shape.wear_volume() / PI, of("dv_over_pi_a0sq_d")), row);
        worst.note(
            "ΔV / Eq 15",
            relative(shape.wear_volume() / shape.wear_volume_asymptotic(), of("dv_over_eq15")),
            row,
        );
        worst.note("max Δf", relative(shape.wear_depth_max(), of("max_df_over_d")), row);
    }
    for (quantity, tolerance) in [
        ("a0 - c", 1e-13),
        // Of q next to full sliding, not of its evaluation: see tests/equations.rs.
        ("ε", 1e-12),
        ("a∞ - a0", 5e-13),
        ("ΔV", 1e-12),
        ("ΔV / Eq 15", 1e-12),
        ("max Δf", 5e-13),
    ] {
        worst.below(quantity, tolerance);
    }
}

#[test]
fn worn_profiles_agree_with_the_table() {
    let table = Table::read("profile.csv");
    let mut worst = Worst::default();
    for row in &table.rows {
        let of = |name| table.number(row, name);
        let (n, k, ratio) = (of("n"), of("k"), of("c_over_a0"));
        let shape = LimitingShape::from_stick_ratio(&unit_power_law(n, k), k, 1.0, ratio).unwrap();
        let beyond = of("r_minus_c_over_a0");
        let depth = shape.wear_depth_at_offset(beyond * (2.0 * ratio + beyond));
        worst.note("Δf", (depth - of("delta_f_over_d")).abs() / shape.wear_depth_max(), row);
        // Nearer to c the rounding of r itself is what would be seen.
        if beyond < 1e-3 * shape.slip_width_limit() || shape.slip_width_limit() < 1e-3 {
            continue;
        }
        worst.note(
            "Δf by r",
            (shape.wear_depth(of("r_over_a0")) - of("delta_f_over_d")).abs() / shape.wear_depth_max(),
            row,
        );
        worst.note("f∞", relative(shape.profile(of("r_over_a0")), of("f_inf_over_d")), row);
    }
    for (quantity, tolerance) in [("Δf", 3e-14), ("Δf by r", 3e-13), ("f∞", 3e-14)] {
        worst.below(quantity, tolerance);
    }
}

#[test]
fn figure_1_of_the_paper_agrees_with_the_table() {
    let table = Table::read("figure1.csv");
    let mut worst = Worst::default();
    let paraboloid = Indenter::paraboloid(1.0).unwrap();
    for row in &table.rows {
        let of = |name| table.number(row, name);
        let k = of("k");
        let compression = slip_compression(similar_stiffness_ratio(k), of("ubar"), 1.0);
        let shape = LimitingShape::new(&paraboloid, k, 1.0, compression).unwrap();
        worst.note("a0", relative(shape.contact_radius_initial(), of("a0_over_sqrt_rd")), row);
        worst.note("c", relative(shape.stick_radius(), of("c_over_sqrt_rd")), row);
        worst.note(
            "a0 Eq 16-18",
            relative(paraboloid_contact_radius(k, 1.0, 1.0), of("a0_over_sqrt_rd")),
            row,
        );
        worst.note(
            "c Eq 16-18",
            relative(paraboloid_stick_radius(k, 1.0, 1.0, compression), of("c_over_sqrt_rd")),
            row,
        );
        worst.note("a∞", relative(shape.contact_radius_limit(), of("a_inf_over_sqrt_rd")), row);
        let r = of("r_over_sqrt_rd");
        worst.note("Δf", (shape.wear_depth(r) - of("delta_f_over_d")).abs() / shape.wear_depth_max(), row);
        worst.note("f∞", (shape.profile(r) - of("f_inf_over_d")).abs(), row);
    }
    for (quantity, tolerance) in [
        ("a0", 1e-15),
        ("c", 1e-15),
        ("a0 Eq 16-18", 1e-15),
        ("c Eq 16-18", 1e-15),
        ("a∞", 1e-15),
        ("Δf", 3e-14),
        ("f∞", 3e-15),
    ] {
        worst.below(quantity, tolerance);
    }
}

#[test]
fn equivalent_profiles_and_loads_agree_with_the_table() {
    let table = Table::read("transforms.csv");
    let mut worst = Worst::default();
    for row in &table.rows {
        let of = |name| table.number(row, name);
        let name = table.text(row, "shape");
        let (indenter, kind) = match name.split_once('=') {
            Some(("sphere_R", radius)) => (Indenter::sphere(radius.parse().unwrap()).unwrap(), "sphere"),
            Some(("power_n", "2_A")) | Some(("power_n", "2_A=0.5")) => {
                (Indenter::paraboloid(1.0).unwrap(), "power law")
            }
            Some(("power_n", n)) => (Indenter::power_law(1.0, n.parse().unwrap()).unwrap(), "power law"),
            _ => continue,
        };
        let profile = indenter.equivalent_profile(of("k")).unwrap();
        let (f, g, d, load) = match kind {
            "sphere" => ("sphere f", "sphere g", "sphere d", "sphere load"),
            _ => ("power law f", "power law g", "power law d", "power law load"),
        };
        worst.note(f, relative(indenter.profile(of("x")), of("f")), row);
        worst.note(g, relative(profile.value(of("x")), of("g")), row);
        worst.note(d, relative(profile.value(of("a")), of("d")), row);
        worst.note(load, relative(profile.load_integral(of("a")), of("fn_over_cn")), row);
        let inverse = if kind == "sphere" { "sphere inverses" } else { "power law inverses" };
        worst.note(inverse, relative(profile.radius_at(of("d")).unwrap(), of("a")), row);
        worst.note(inverse, relative(profile.depth_for_load(of("fn_over_cn")).unwrap(), of("d")), row);
    }
    for (quantity, tolerance) in [
        ("power law f", 1e-15),
        ("power law g", 5e-15),
        ("power law d", 5e-15),
        ("power law load", 5e-15),
        ("power law inverses", 1e-14),
        ("sphere f", 1e-15),
        ("sphere g", 2e-15),
        ("sphere d", 2e-15),
        ("sphere load", 4e-15),
        ("sphere inverses", 2e-15),
    ] {
        worst.below(quantity, tolerance);
    }
}

#[test]
fn worn_spheres_agree_with_thirty_digit_arithmetic() {
    let table = Table::read("sphere.csv");
    let mut worst = Worst::default();
    for row in &table.rows {
        let of = |name| table.number(row, name);
        let (k, d, ratio) = (of("k"), of("d"), of("c_over_a0"));
        let shape =
            LimitingShape::from_stick_ratio(&Indenter::sphere(of("radius")).unwrap(), k, d, ratio).unwrap();
        let again = LimitingShape::new(shape.indenter(), k, d, shape.slip_compression()).unwrap();
        worst.note("c", relative(again.stick_radius(), ratio * of("a0")), row);
        worst.note("a0", relative(shape.contact_radius_initial(), of("a0")), row);
        worst.note("a∞", relative(shape.contact_radius_limit(), of("a_inf")), row);
        worst.note("ΔV", relative(shape.wear_volume(), of("dv")), row);
        worst.note("Δf", relative(shape.wear_depth(of("r")), of("delta_f")), row);
        worst.note("load", relative(shape.load_fraction(), of("fn_worn_over_fn_initial")), row);
    }
    for (quantity, tolerance) in
        [("c", 1e-14), ("a0", 2e-15), ("a∞", 2e-15), ("ΔV", 1e-14), ("Δf", 2e-15), ("load", 2e-15)]
    {
        worst.below(quantity, tolerance);
    }
}

#[test]
fn a_shallow_sphere_wears_as_its_paraboloid_to_first_order_in_the_indentation() {
    for k in [-0.8, 0.0, 0.8] {
        let difference = |d: f64| {
            let of = |indenter: Indenter| LimitingShape::from_stick_ratio(&indenter, k, d, 0.9).unwrap();
            let (sphere, paraboloid) =
                (of(Indenter::sphere(1.0).unwrap()), of(Indenter::paraboloid(1.0).unwrap()));
            relative(sphere.wear_volume(), paraboloid.wear_volume())
        };
        let order = (difference(1e-3) / difference(1e-4)).log10();
        println!("k = {k}: difference {:e} at d = 1e-4 R, order {order}", difference(1e-4));
        assert!((order - 1.0).abs() < 0.01, "k = {k}: order {order}");
    }
}

#[test]
fn a_sphere_on_a_homogeneous_half_space_has_an_area_tangent_as_equivalent_profile() {
    let profile = Indenter::sphere(2.0).unwrap().equivalent_profile(0.0).unwrap();
    let mut worst = Worst::default();
    for x in [1e-8, 0.01, 0.5, 1.2, 1.7, 1.9, 1.95, 1.99, 1.997] {
        let place = [format!("x = {x}")];
        let (ratio, near) = (0.5 * x, 0.5 * x * (1.0 - 1e-9));
        worst.note("g", relative(profile.value(x), x * ratio.atanh()), &place);
        worst.note(
            "g'",
            relative(profile.derivative(x), ratio.atanh() + ratio / (1.0 - ratio * ratio)),
            &place,
        );
        worst.note("inverse", relative(profile.radius_at(profile.value(x)).unwrap(), x), &place);
        // over a small step the rise is the slope at the middle times the step
        let offset = 4.0 * (near - ratio) * (near + ratio);
        let middle = profile.derivative(near + ratio) / (2.0 * (near + ratio));
        worst.note("rise", relative(profile.rise(x, offset), middle * offset), &place);
        let drop = -profile.rise(x, offset);
        worst.note("drop", relative(profile.radius_squared_drop(x, drop), -offset), &place);
    }
    for (quantity, tolerance) in
        [("g", 1e-14), ("g'", 1e-14), ("inverse", 1e-15), ("rise", 1e-13), ("drop", 1e-15)]
    {
        worst.below(quantity, tolerance);
    }
    assert!(matches!(profile.radius_at(10.0), Err(Error::Inconsistent { .. })));
    assert!(matches!(profile.depth_for_load(1e3), Err(Error::Inconsistent { .. })));
}

#[test]
fn small_rises_of_power_laws_keep_their_digits() {
    for n in [0.5, 1.0, 2.0, 7.0] {
        let profile = unit_power_law(n, 0.3).equivalent_profile(0.3).unwrap();
        let offset = 1e-10;
        let series = 0.5 * n * offset * (1.0 + 0.5 * (0.5 * n - 1.0) * offset);
        assert!(relative(profile.rise(1.0, offset), series) < 1e-14, "n = {n}");
        assert!(
            relative(profile.radius_squared_drop(1.0, profile.rise(1.0, offset)), offset) < 1e-9,
            "n = {n}"
        );
        assert!(
            relative(profile.rise(1.0, -1.0), -1.0) < 1e-14
                && relative(profile.rise(0.0, 4.0), 2f64.powf(n)) < 1e-14,
            "n = {n}"
        );
    }
}

#[test]
fn the_factor_of_steep_power_laws_joins_its_expansion() {
    // κ(n+2)/κ(n) = (n+2)/(n+1+k), across the changes of method at n = 20 and 200
    for (n, k) in [
        (19.0, -0.7),
        (20.0, 0.0),
        (18.1, 0.9),
        (60.0, 0.2),
        (199.0, -0.7),
        (200.0, 0.9),
        (199.5, 0.4),
        (1e4, 0.1),
    ] {
        let ratio = power_law_factor(n + 2.0, k) / power_law_factor(n, k);
        assert!(relative(ratio, (n + 2.0) / (n + 1.0 + k)) < 1e-14, "n = {n}, k = {k}: {ratio}");
    }
    assert!(power_law_factor(1e300, -0.5).is_finite());
}

#[test]
fn stick_and_full_sliding_are_told_apart_from_partial_slip() {
    let paraboloid = Indenter::paraboloid(1.0).unwrap();
    let full = slip_compression(0.5, full_sliding_amplitude(0.5, 0.3, 2.0), 0.3);
    assert_eq!(Regime::new(2.0, full), Regime::FullSliding);
    let message = LimitingShape::new(&paraboloid, 0.0, 2.0, full).unwrap_err().to_string();
    assert!(message.contains("is in gross slip"), "{message}");
    let stick = LimitingShape::new(&paraboloid, 0.0, 2.0, 0.0).unwrap();
    assert_eq!(stick.regime(), Regime::Stick);
    assert_eq!(
        [stick.wear_volume(), stick.wear_depth_max(), stick.slip_width_limit(), stick.wear_depth(1.0)],
        [0.0; 4]
    );
    assert_eq!(stick.load_fraction(), 1.0);
    assert_eq!(LimitingShape::new(&paraboloid, 0.0, 2.0, 0.1).unwrap().regime(), Regime::PartialSlip);
}

#[test]
fn the_limiting_equivalent_profile_jumps_at_the_stick_radius() {
    let shape = LimitingShape::from_stick_ratio(&Indenter::paraboloid(1.0).unwrap(), 0.0, 1.0, 0.5).unwrap();
    assert!(relative(shape.equivalent_profile(0.5 * (1.0 - 1e-15)).unwrap(), 0.25) < 1e-14);
    assert_eq!(shape.equivalent_profile(0.51), Some(1.0));
    assert_eq!(shape.equivalent_profile(1.3), None);
}

#[test]
fn values_out_of_range_are_named_as_in_the_scene() {
    for (result, name) in [
        (Indenter::paraboloid(-1.0), "indenter.paraboloid.radius"),
        (Indenter::sphere(0.0), "indenter.sphere.radius"),
        (Indenter::cone(f64::NAN), "indenter.cone.slope"),
        (Indenter::power_law(0.0, 2.0), "indenter.power-law.coefficient"),
        (Indenter::power_law(1.0, f64::INFINITY), "indenter.power-law.exponent"),
    ] {
        assert!(result.unwrap_err().to_string().starts_with(name));
    }
    let paraboloid = Indenter::paraboloid(1.0).unwrap();
    for (result, name) in [
        (LimitingShape::new(&paraboloid, 1.0, 1.0, 0.1), "half_space.grading"),
        (LimitingShape::new(&paraboloid, 0.0, 0.0, 0.1), "loading.indentation"),
        (LimitingShape::new(&paraboloid, 0.0, 1.0, -0.1), "slip compression"),
        (LimitingShape::from_stick_ratio(&paraboloid, 0.0, 1.0, 1.1), "loading.stick_ratio"),
    ] {
        assert!(result.unwrap_err().to_string().starts_with(name));
    }
}

#[test]
fn random_shapes_have_positive_widths_and_bounded_depths() {
    let seed = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let mut runner = TestRunner::new_with_rng(
        ProptestConfig { cases: 2000, failure_persistence: None, ..Default::default() },
        seed,
    );
    // k towards both ends, n over two decades, amplitudes from 1e-14 of full sliding to nearly all of it
    let parameters = ((-4.0..4.0f64), (-0.7..1.3f64), (-14.0..-1e-3f64), (0.01..0.99f64));
    let outcome = runner.run(&parameters, |(side, exponent, amplitude, place)| {
        let (k, n) =
            (1.0f64.min(side.abs()) * side.signum() * (1.0 - 10f64.powf(-side.abs())), 10f64.powf(exponent));
        let shape = LimitingShape::new(&unit_power_law(n, k), k, 1.0, 10f64.powf(amplitude)).unwrap();
        for value in [
            shape.slip_width_initial(),
            shape.slip_width_limit(),
            shape.contact_growth_limit(),
            shape.wear_volume(),
        ] {
            prop_assert!(value > 0.0 && value.is_finite(), "k = {k}, n = {n}: {value}");
        }
        prop_assert!(shape.contact_growth_limit() < shape.slip_width_limit());
        let (c, r) = (shape.stick_radius(), place * shape.slip_width_limit());
        let depth = shape.wear_depth_at_offset(r * (2.0 * c + r));
        prop_assert!(
            depth > 0.0 && depth <= shape.wear_depth_max() * (1.0 + 1e-12),
            "k = {k}, n = {n}: {depth}"
        );
        prop_assert!(shape.wear_depth_max() < shape.slip_compression());
        prop_assert!(shape.load_fraction() > 0.0 && shape.load_fraction() <= 1.0 + 1e-14);
        Ok(())
    });
    outcome.unwrap();
}

#[test]
fn a_stick_radius_however_small_is_partial_slip() {
    // q_c = d (1 - 1e-18) rounds to d.
    let paraboloid = Indenter::paraboloid(1.0).unwrap();
    let shape = LimitingShape::from_stick_ratio(&paraboloid, 0.0, 1.0, 1e-9).unwrap();
    assert_eq!(shape.slip_compression(), shape.indentation());
    assert_eq!(shape.regime(), Regime::PartialSlip);
    let shape = LimitingShape::from_stick_ratio(&paraboloid, 0.0, 1.0, 1.0).unwrap();
    assert_eq!(shape.regime(), Regime::Stick);
}
