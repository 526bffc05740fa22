//! Equations of the paper that are used by nothing else: special cases, expansions, and limits, each against the general functions.

mod support;

use fretwear::contact::closed_form::{
    LimitingShape, paraboloid_contact_radius, paraboloid_normal_force, paraboloid_relative_slip_width,
    paraboloid_small_amplitude_wear_volume, paraboloid_stick_radius, power_law_contact_radius,
    power_law_indentation, power_law_profile, relative_limit_width, relative_slip_width,
    similar_stiffness_ratio,
};
use fretwear::contact::half_space::{HalfSpace, Poisson, modulus_at_depth};
use fretwear::contact::indenter::{Indenter, power_law_factor};
use std::f64::consts::PI;
use support::reference::{Table, Worst, relative};

const GRADINGS: [f64; 7] = [-0.9999, -0.9, -0.5, 0.0, 0.5, 0.9, 0.9999];

/// Power law with `g = x^n`, so that `a0 = d = 1`.
fn unit_power_law(exponent: f64, grading: f64) -> Indenter {
    Indenter::power_law(1.0 / power_law_factor(exponent, grading), exponent).unwrap()
}

#[test]
fn indentation_and_contact_radius_of_power_laws_are_inverse() {
    for k in GRADINGS {
        for n in [0.1, 1.0, 2.0, 20.0] {
            let depth = power_law_indentation(0.3, n, k, 0.7).unwrap();
            let profile = power_law_profile(0.3, n, 0.7).unwrap();
            assert!(relative(depth, power_law_factor(n, k) * profile) < 1e-14, "n = {n}, k = {k}: {depth}");
            let radius = power_law_contact_radius(0.3, n, k, depth).unwrap();
            assert!(relative(radius, 0.7) < 1e-14, "n = {n}, k = {k}: {radius}");
        }
    }
    assert!(power_law_indentation(1.0, 0.0, 0.0, 1.0).is_err());
    assert!(power_law_contact_radius(1.0, 2.0, 1.0, 1.0).is_err());
}

#[test]
fn the_stick_radius_keeps_its_digits_however_pointed_or_flat_the_profile() {
    let mut worst = Worst::default();
    for n in [0.1, 0.2, 0.5, 1.0, 2.0, 20.0] {
        for q in [1e-12, 1e-3, 0.1, 0.3, 0.49, 0.5, 0.51, 0.9, 1.0 - 1e-10] {
            let shape = LimitingShape::new(&unit_power_law(n, 0.3), 0.3, 1.0, q).unwrap();
            let logarithm = (-q).ln_1p() / n;
            let place = [format!("n = {n}"), format!("q = {q}")];
            worst.note("c", relative(shape.stick_radius(), logarithm.exp()), &place);
            worst.note("a0 - c", relative(shape.slip_width_initial(), -logarithm.exp_m1()), &place);
        }
    }
    worst.below("c", 1e-13);
    worst.below("a0 - c", 1e-13);
}

#[test]
fn the_paraboloid_is_the_power_law_of_exponent_two() {
    let (radius, d, compression) = (0.02, 3e-6, 4e-7);
    for k in GRADINGS {
        let paraboloid = Indenter::paraboloid(radius).unwrap();
        let shape = LimitingShape::new(&paraboloid, k, d, compression).unwrap();
        let (a, c) = (shape.contact_radius_initial(), shape.stick_radius());
        assert!(relative(paraboloid_contact_radius(k, radius, d), a) < 1e-14, "k = {k}");
        assert!(relative(paraboloid_stick_radius(k, radius, d, compression), c) < 1e-14, "k = {k}");
        let small = relative_slip_width(shape.slip_width_initial(), c);
        assert!(relative(paraboloid_relative_slip_width(d, compression), small) < 1e-14, "k = {k}");
        let volume = paraboloid_small_amplitude_wear_volume(k, radius, d, compression);
        assert!(relative(volume, shape.wear_volume_asymptotic()) < 3e-14, "k = {k}");
        let force = paraboloid_normal_force(k, radius, d, 5e11);
        let load = 5e11 * paraboloid.equivalent_profile(k).unwrap().load_integral(a);
        assert!(relative(force, load) < 1e-14, "k = {k}: {force} and {load}");
    }
}

#[test]
fn the_law_of_grading_makes_half_spaces_of_either_reference_the_same() {
    let of = |depth: f64| {
        let modulus = modulus_at_depth(-0.3, 1e11, 1e-3, depth);
        HalfSpace::from_modulus(-0.3, modulus, depth, Poisson::Ratio(0.3)).unwrap().normal_stiffness()
    };
    assert!(relative(of(5e-2), of(1e-3)) < 1e-14);
}

#[test]
fn equations_14_and_15_are_of_first_order_and_the_next_term_of_14_is_known() {
    for k in [-0.9, -0.5, 0.0, 0.5, 0.9] {
        for n in [1.0, 2.0, 4.0] {
            let (mu, nu) = (0.5 * (1.0 - k), 0.5 * (1.0 + k));
            let alpha = 1.0 + mu;
            // Relative errors of Eqs. (14) and (15), and of ln(a∞/c) with its next term.
            let errors = |eta: f64| {
                let shape =
                    LimitingShape::from_stick_ratio(&unit_power_law(n, k), k, 1.0, (-eta).exp()).unwrap();
                let (c, width) = (shape.stick_radius(), shape.slip_width_limit());
                let small = relative_slip_width(shape.slip_width_initial(), c);
                let eta = small.ln_1p();
                let next = alpha * eta * (1.0 - mu * (nu + 0.5 * n) / (2.0 + mu) * eta);
                [
                    relative(relative_limit_width(k, small), width / c),
                    relative(shape.wear_volume_asymptotic(), shape.wear_volume()),
                    relative(next, (width / c).ln_1p()),
                ]
            };
            let (coarse, fine) = (errors(2e-3), errors(2e-4));
            for (i, expected) in [1.0, 1.0, 2.0].into_iter().enumerate() {
                let order = (coarse[i] / fine[i]).log10();
                assert!(
                    (order - expected).abs() < 0.03,
                    "k = {k}, n = {n}, quantity {i}: order {order}, errors {:e} and {:e}",
                    coarse[i],
                    fine[i]
                );
            }
        }
    }
}

#[test]
fn the_gibson_medium_is_reached_as_the_table_says() {
    let table = Table::read("gibson.csv");
    let mut worst = Worst::default();
    for row in &table.rows {
        let of = |name| table.number(row, name);
        let (n, k, c) = (of("n"), of("k"), of("c_over_a0"));
        let mu = 0.5 * (1.0 - k);
        let shape = LimitingShape::from_stick_ratio(&unit_power_law(n, k), k, 1.0, c).unwrap();
        worst.note("a∞", relative(shape.contact_radius_limit(), of("a_inf_over_a0")), row);
        worst.note("a∞ - a0", relative(shape.contact_growth_limit(), of("a_inf_minus_a0_over_a0")), row);
        let volume = shape.wear_volume() / PI;
        worst.note("ΔV", relative(volume, of("dv_over_pi_a0sq_d")), row);
        worst.note("max Δf", relative(shape.wear_depth_max(), of("max_df_over_d")), row);
        worst.note("Δf midway", relative(shape.wear_depth(of("r_mid_over_a0")), of("df_mid")), row);

        // The limits: Δf → d - f0 on (c, a0], and ΔV accordingly.
        let limit = (1.0 - c * c) - 2.0 / (n + 2.0) * (1.0 - c.powf(n + 2.0));
        worst.note("limit of ΔV", relative(limit, of("dv_limit")) * of("dv_limit"), row);
        worst.note("limit of max Δf", relative(1.0 - c.powf(n), of("max_df_limit")), row);
        worst.note(
            "limit of Δf midway",
            relative(1.0 - of("r_mid_over_a0").powf(n), of("df_mid_limit")),
            row,
        );
        // The rates of approach; a∞ - a0 = (μ/n) ∫_{c²}^1 (1 - t^(n/2))/(1-t) dt + O(μ²).
        let rate = match n {
            1.0 => 2.0 * ((1.0 - c) - ((1.0 - c) / (1.0 + c)).ln_1p()),
            2.0 => 0.5 * (1.0 - c * c),
            _ => 0.25 * ((1.0 - c * c) + 0.5 * (1.0 - c.powi(4))),
        };
        worst.note("first order of a∞", relative(mu * rate, of("first_order_a")), row);
        let next = (shape.contact_growth_limit() / of("first_order_a") - 1.0) / mu;
        let volume_rate = (volume - of("dv_limit")) / mu;
        let difference = volume_rate - of("dv_minus_limit_over_mu");
        // All that the rounding of ΔV leaves of the difference.
        worst.note("rate of ΔV, in roundings", difference.abs() * mu / (f64::EPSILON * volume), row);
        let next_volume = (volume_rate - of("first_order_dv_coeff")) / mu;
        if k > 0.9 && mu > 1e-6 {
            worst.note("second order of a∞, over μ² a∞", next.abs(), row);
            worst.note("second order of ΔV, over μ²", next_volume.abs(), row);
        }
    }
    for (quantity, tolerance) in [
        ("a∞", 1e-15),
        ("a∞ - a0", 5e-15),
        ("ΔV", 5e-15),
        ("max Δf", 2e-15),
        ("Δf midway", 2e-14),
        ("limit of ΔV", 8e-16),
        ("limit of max Δf", 4e-15),
        ("limit of Δf midway", 5e-14),
        ("first order of a∞", 5e-15),
        ("rate of ΔV, in roundings", 30.0),
        ("second order of a∞, over μ² a∞", 5.0),
        ("second order of ΔV, over μ²", 0.5),
    ] {
        worst.below(quantity, tolerance);
    }
}

#[test]
fn an_amplitude_next_to_full_sliding_holds_as_many_digits_as_its_distance_from_it() {
    // q = M U/(μ_f d) enters through 1-q: an error δ of q is one of q/(1-q)/n δ in c/a0, 2e4/n in the rows of k = -0.9999 and U = 1e-4 μ_f d.
    let table = Table::read("small_amplitude.csv");
    let mut worst = Worst::default();
    let mut most = 0.0_f64;
    for row in &table.rows {
        let of = |name| table.number(row, name);
        let (n, k, amplitude) = (of("n"), of("k"), of("ubar"));
        let indenter = unit_power_law(n, k);
        let width = of("eps_exact");
        let of_shape =
            |shape: &LimitingShape| relative(shape.slip_width_limit() / shape.stick_radius(), width);
        let q = similar_stiffness_ratio(k) * amplitude;
        let condition = q / (1.0 - q) / n;
        most = most.max(condition);
        let by_amplitude = of_shape(&LimitingShape::new(&indenter, k, 1.0, q).unwrap());
        // Two roundings are in M, one in its product with the amplitude.
        worst.note("over condition", by_amplitude / (1.0 + condition) / f64::EPSILON, row);
        if condition < 1e3 {
            worst.note("well-conditioned", by_amplitude, row);
            continue;
        }
        // The same with 1-q = [(1+k)(3+k) - 2U]/((1+k)(3+k)), in which k and U are taken as they stand; c itself then has all its digits.
        let (first, second) = (1.0 + k, 3.0 + k);
        let second_rest = (3.0 - second) + k;
        let product = first * second;
        let product_rest = first.mul_add(second, -product) + first * second_rest;
        let ratio = (((product - 2.0 * amplitude) + product_rest) / product).powf(1.0 / n);
        let by_radius = of_shape(&LimitingShape::from_stick_ratio(&indenter, k, 1.0, ratio).unwrap());
        worst.note("ill-conditioned, by the stick radius", by_radius, row);
        worst.note("ill-conditioned, by the amplitude", by_amplitude, row);
    }
    println!("largest condition number {most:.1e}");
    for (quantity, tolerance) in [
        ("over condition", 10.0),
        ("well-conditioned", 2e-14),
        ("ill-conditioned, by the stick radius", 1e-14),
        ("ill-conditioned, by the amplitude", 1e-12),
    ] {
        worst.below(quantity, tolerance);
    }
}
