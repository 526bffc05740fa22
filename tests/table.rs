//! Measured profiles, judged by the closed forms of the shapes they were sampled from.

use std::f64::consts::PI;
use std::sync::Arc;

use fretwear::contact::InitialContact;
use fretwear::contact::closed_form::LimitingShape;
use fretwear::contact::half_space::HalfSpace;
use fretwear::contact::indenter::{Indenter, TabulatedProfile, power_law_factor};
use fretwear::laws::friction::Coulomb;
use fretwear::laws::loading::{Amplitude, Duration, Load, Loading};
use fretwear::laws::wear::Archard;

const GRADINGS: [f64; 8] = [-0.9999, -0.9, -0.5, 0.0, 0.3, 0.7, 0.9, 0.9999];

fn table(radius: Vec<f64>, height: Vec<f64>) -> Indenter {
    Indenter::from(Arc::new(TabulatedProfile::new("rows", radius, height).unwrap()))
}

/// `rows` radii from 0 to `last`, evenly spaced.
fn even(rows: usize, last: f64) -> Vec<f64> {
    (0..rows).map(|i| last * i as f64 / (rows - 1) as f64).collect()
}

/// Radii of very uneven spacing.
fn uneven(rows: usize, last: f64) -> Vec<f64> {
    let step = |i: usize| match i % 7 {
        0 => 0.05,
        3 => 2.0,
        _ => 0.6,
    };
    let mut radius = vec![0.0];
    (1..rows).for_each(|i| radius.push(radius[i - 1] + step(i)));
    let scale = last / radius[rows - 1];
    radius.iter().map(|r| r * scale).collect()
}

fn sampled(indenter: &Indenter, radius: Vec<f64>) -> Indenter {
    let height = radius.iter().map(|r| indenter.profile(*r)).collect();
    table(radius, height)
}

fn relative(found: f64, expected: f64) -> f64 {
    let error = (found / expected - 1.0).abs();
    if error.is_nan() { f64::INFINITY } else { error }
}

/// Relative errors of a0, F_N, a∞, ΔV, deepest wear and a depth at a fixed radius.
fn errors(tabulated: &Indenter, exact: &Indenter, grading: f64, depth: f64, ratio: f64) -> [f64; 6] {
    let shapes = [tabulated, exact]
        .map(|indenter| LimitingShape::from_stick_ratio(indenter, grading, depth, ratio).unwrap());
    let [found, expected] = &shapes;
    let load = |shape: &LimitingShape| {
        shape.initial_equivalent_profile().load_integral(shape.contact_radius_initial())
    };
    let offset =
        0.4 * expected.slip_width_limit() * (expected.contact_radius_limit() + expected.stick_radius());
    [
        relative(found.contact_radius_initial(), expected.contact_radius_initial()),
        relative(load(found), load(expected)),
        relative(found.contact_radius_limit(), expected.contact_radius_limit()),
        relative(found.wear_volume(), expected.wear_volume()),
        relative(found.wear_depth_max(), expected.wear_depth_max()),
        relative(found.wear_depth_at_offset(offset), expected.wear_depth_at_offset(offset)),
    ]
}

#[test]
fn a_table_of_a_paraboloid_or_a_cone_has_their_limit_to_round_off() {
    let mut worst = (0.0, String::new());
    for exact in [Indenter::paraboloid(1e-2).unwrap(), Indenter::cone(0.02).unwrap()] {
        for (name, radius) in
            [("even", even(201, 1e-3)), ("uneven", uneven(160, 1e-3)), ("few", even(4, 1e-3))]
        {
            let tabulated = sampled(&exact, radius);
            for grading in GRADINGS {
                for ratio in [0.05, 0.5, 0.7, 0.99, 1.0 - 1e-6] {
                    let depth = exact.equivalent_profile(grading).unwrap().value(1e-4);
                    let found = errors(&tabulated, &exact, grading, depth, ratio);
                    for error in found {
                        if error > worst.0 {
                            worst = (
                                error,
                                format!("{exact:?}, {name}, k = {grading}, c/a0 = {ratio}: {found:?}"),
                            );
                        }
                    }
                }
            }
        }
    }
    println!("{worst:?}");
    assert!(worst.0 < 2e-12, "{worst:?}");
}

/// Orders over all halvings of the spacing together: where the radii of contact and stick lie between the rows changes from one to the next.
fn assert_order(errors: &[[f64; 6]], quantity: usize, least: f64, place: &str) {
    let (first, last) = (errors[0][quantity], errors[errors.len() - 1][quantity]);
    let order = (first / last).log2() / (errors.len() - 1) as f64;
    // Rounding, and a cubic that meets the profile by chance.
    assert!(
        order >= least || last < 1e-11,
        "{place}: order {order:.2} of {:?}",
        errors.iter().map(|it| it[quantity]).collect::<Vec<_>>()
    );
}

#[test]
fn tables_of_spheres_and_power_laws_converge_with_the_spacing() {
    let shapes = [
        Indenter::sphere(1e-3).unwrap(),
        Indenter::power_law(0.3, 1.5).unwrap(),
        Indenter::power_law(30.0, 2.5).unwrap(),
        Indenter::power_law(1e3, 3.0).unwrap(),
    ];
    for exact in shapes {
        for grading in GRADINGS {
            let depth = exact.equivalent_profile(grading).unwrap().value(5e-4);
            let found: Vec<_> = [50, 100, 200, 400]
                .map(|cells| errors(&sampled(&exact, even(cells + 1, 9e-4)), &exact, grading, depth, 0.7))
                .into();
            let place = format!("{exact:?}, k = {grading}");
            // As k → -1 the transform becomes a derivative of the profile, of third order.
            let smooth = if grading < -0.2 { 2.4 } else { 3.2 };
            // A tip that is no smooth one costs the force h^(n+1+k): an error h^n of the profile on springs of x^k dx.
            let force = exact.as_power_law().map_or(3.4, |(_, n)| (n + 0.8 + grading).min(3.0));
            // Where the depth is taken between the rows changes most from one spacing to the next.
            let depth_order = f64::min(smooth, 2.4);
            for (quantity, least) in
                [smooth, force, smooth, smooth, depth_order, depth_order].into_iter().enumerate()
            {
                assert_order(&found, quantity, least, &format!("{place}, quantity {quantity}"));
            }
            let worst = found[3].iter().fold(0.0, |m: f64, e| m.max(*e));
            println!("{place}: {:?}", found.iter().map(|it| format!("{:.1e}", it[3])).collect::<Vec<_>>());
            // A cubic has nothing to converge to.
            let most = if exact.as_power_law().is_some_and(|(_, n)| n == 3.0) { 3e-13 } else { 1e-7 };
            assert!(worst < most, "{place}: {:?}", found[3]);
        }
    }
}

#[test]
fn the_transform_of_cubics_is_exact_for_every_grading_and_spacing() {
    let mut worst = (0.0, String::new());
    for (name, radius) in [
        ("even", even(301, 2.0)),
        ("uneven", uneven(250, 2.0)),
        ("geometric", std::iter::once(0.0).chain((0..60).map(|i| 2.0 * 0.7f64.powi(59 - i))).collect()),
    ] {
        let height = radius.iter().map(|r| r * (0.4 + r * (0.3 + r * 0.2))).collect();
        let tabulated = table(radius.clone(), height);
        for grading in GRADINGS {
            let g = tabulated.equivalent_profile(grading).unwrap();
            let factors = [1.0, 2.0, 3.0].map(|n| power_law_factor(n, grading));
            let exact = |x: f64| x * (0.4 * factors[0] + x * (0.3 * factors[1] + x * 0.2 * factors[2]));
            let slope = |x: f64| 0.4 * factors[0] + x * (0.6 * factors[1] + x * 0.6 * factors[2]);
            for x in (1..=400).map(|i| 2.0 * (i as f64 / 400.0).powi(3)) {
                for error in [relative(g.value(x), exact(x)), 0.01 * relative(g.derivative(x), slope(x))] {
                    if error > worst.0 {
                        worst = (error, format!("{name}, k = {grading}, x = {x}"));
                    }
                }
            }
        }
    }
    println!("{worst:?}");
    assert!(worst.0 < 2e-12, "{worst:?}");
}

/// A smooth profile that is no power law, with rows off by `rough` of their height.
fn crowned(rows: usize, rough: f64) -> Indenter {
    let noise = |i: usize| ((i * 7919) % 1000) as f64 / 1000.0 - 0.5;
    let radius = even(rows, 3e-3);
    let height = radius.iter().enumerate();
    let height = height.map(|(i, r)| 1e2 * r.powi(4) / (r * r + 2e-7) * (1.0 + rough * noise(i))).collect();
    table(radius, height)
}

#[test]
fn radius_depth_and_force_are_inverse_to_each_other_and_differences_keep_their_digits() {
    for rough in [0.0, 1e-4] {
        let indenter = crowned(101, rough);
        for grading in GRADINGS {
            let g = indenter.equivalent_profile(grading).unwrap();
            let place = |x: f64| format!("rough {rough}, k = {grading}, x = {x}");
            let mut before = 0.0;
            for x in (1..120).map(|i| 1e-3 * i as f64 / 60.0).filter(|x| *x < 0.8 * g.largest_radius()) {
                assert!(relative(g.radius_at(g.value(x)).unwrap(), x) < 1e-13, "{}", place(x));
                let load = g.load_integral(x);
                assert!(load > before, "{}", place(x));
                before = load;
                assert!(relative(g.depth_for_load(load).unwrap(), g.value(x)) < 1e-12, "{}", place(x));
                for share in [-0.9, -0.3, -1e-3, -1e-9, -1e-15, 1e-12, 1e-5, 0.4] {
                    let rise = g.rise(x, share * x * x);
                    let difference = g.value((x * x * (1.0 + share)).sqrt()) - g.value(x);
                    assert!(
                        (rise - difference).abs() < 4e-15 * g.value(x),
                        "{}: {rise} {difference}",
                        place(x)
                    );
                    if share.abs() < 1e-8 {
                        // To first order, with a generous second.
                        let linear = 0.5 * share * x * g.derivative(x);
                        assert!(
                            relative(rise, linear) < 1e-13 + 1e3 * share.abs(),
                            "{}: {rise} {linear}",
                            place(x)
                        );
                    }
                    if share < 0.0 && rise < 0.0 {
                        let back = relative(g.radius_squared_drop(x, -rise), -share * x * x);
                        let tolerance = 1e-12
                            + 1e-15 * g.value(x) / (x * g.derivative(x) * -share).min(1e-3 * g.value(x));
                        assert!(back < tolerance.min(1e-11), "{}, share {share}: {back}", place(x));
                    }
                }
            }
        }
    }
}

/// The wear depth of the limit straight from its definition [S, Eq. (3)] in the variable that lifts the singularity, by Simpson's rule.
fn depth_by_definition(shape: &LimitingShape, offset: f64) -> f64 {
    const CELLS: usize = 40_000;
    let k = shape.grading();
    let mu = 0.5 * (1.0 - k);
    let outer = shape.stick_radius().powi(2) + offset;
    let integrand = |w: f64| {
        let s = outer - offset * w.powf(1.0 / mu);
        let compression = -shape
            .initial_equivalent_profile()
            .rise(shape.contact_radius_initial(), s - shape.contact_radius_initial().powi(2));
        s.powf(-mu) * compression
    };
    let weight = |i: usize| if i == 0 || i == CELLS { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
    let sum: f64 = (0..=CELLS).map(|i| weight(i) * integrand(i as f64 / CELLS as f64)).sum();
    (0.5 * PI * k).cos() / PI * offset.powf(mu) / mu * sum / (3.0 * CELLS as f64)
}

#[test]
fn the_limit_of_smooth_tables_and_rough_ones_is_that_of_its_definition() {
    // At k = -0.9 what is seen is Simpson's rule.
    for (rows, rough, tolerance) in
        [(101, 0.0, 8e-11), (401, 0.0, 8e-11), (101, 1e-4, 8e-11), (401, 1e-5, 8e-11)]
    {
        let indenter = crowned(rows, rough);
        let mut worst = (0.0, String::new());
        for grading in [-0.9, -0.5, 0.0, 0.3, 0.7, 0.9] {
            let depth = indenter.equivalent_profile(grading).unwrap().value(1e-3);
            for ratio in [0.3, 0.7, 0.98] {
                let shape = LimitingShape::from_stick_ratio(&indenter, grading, depth, ratio).unwrap();
                let edge = shape.slip_width_limit() * (shape.contact_radius_limit() + shape.stick_radius());
                for part in [0.1, 0.5, 0.9] {
                    let found = shape.wear_depth_at_offset(part * edge);
                    let error =
                        (found - depth_by_definition(&shape, part * edge)).abs() / shape.wear_depth_max();
                    if error > worst.0 {
                        worst = (error, format!("k = {grading}, c/a0 = {ratio}, {part} of the annulus"));
                    }
                }
            }
        }
        println!("{rows} rows, rough {rough}: {worst:?}");
        assert!(worst.0 < tolerance, "{rows} rows, rough {rough}: {worst:?}");
    }
}

#[test]
fn a_flat_centre_is_a_punch_with_a_rim() {
    // k = 0, f = s (r - b) outside b: g = s x arccos(b/x).
    let (flat, slope) = (1e-3, 0.01);
    let radius = even(2001, 4e-3);
    let height = radius.iter().map(|r| slope * (r - flat).max(0.0)).collect();
    let g = table(radius.clone(), height).equivalent_profile(0.0).unwrap();
    let mut worst = 0.0f64;
    for x in [1.2e-3, 2e-3, 3.5e-3f64] {
        worst = worst.max(relative(g.value(x), slope * x * (flat / x).acos()));
    }
    println!("{worst:e}");
    assert!(worst < 1e-5, "{worst:e}");
    assert_eq!(g.value(0.9e-3), 0.0);

    let indenter = table(radius.clone(), radius.iter().map(|r| slope * (r - flat).max(0.0)).collect());
    let depth = g.value(2e-3);
    let shape = LimitingShape::from_stick_ratio(&indenter, 0.0, depth, 0.7).unwrap();
    assert!(relative(shape.contact_radius_initial(), 2e-3) < 1e-12);
    let loading =
        |amplitude| Loading { load: Load::Indentation(depth), amplitude, duration: Duration::Tau(1.0) };
    let contact = |amplitude| {
        InitialContact::new(
            &indenter,
            &HalfSpace::from_stiffness(0.0, 1e11, 1.0).unwrap(),
            &Coulomb { coefficient: 0.5 },
            &Archard { coefficient: 1e-14 },
            &loading(amplitude),
        )
    };
    let message = contact(Amplitude::StickRatio(0.4)).unwrap_err().to_string();
    assert!(
        message.contains("loading.stick_ratio: 0.4 puts the edge of stick at")
            && message.contains("flat up to 0.001 m"),
        "{message}"
    );
    assert!(contact(Amplitude::StickRatio(0.6)).is_ok());
}

#[test]
fn rows_that_are_no_profile_are_refused_with_the_cure() {
    let good = || (vec![0.0, 1.0, 2.0, 3.0], vec![0.0, 1.0, 4.0, 9.0]);
    let refusal = |radius: Vec<f64>, height: Vec<f64>| {
        TabulatedProfile::new("rows", radius, height).unwrap_err().to_string()
    };
    let (radius, height) = good();
    assert!(TabulatedProfile::new("rows", radius.clone(), height.clone()).is_ok());
    let with = |at: usize, value: f64, of: &[f64]| {
        let mut values = of.to_vec();
        values[at] = value;
        values
    };
    for (radius, height, words) in [
        (
            radius[..3].to_vec(),
            height[..3].to_vec(),
            "it has 3 rows of different radius; give from 4 to 1000000",
        ),
        (even(1_000_001, 1.0), even(1_000_001, 1.0), "1000001 rows"),
        (radius[..3].to_vec(), height.clone(), "3 radii and 4 heights"),
        (with(2, f64::NAN, &radius), height.clone(), "row 3 is r = NaN, f = 4, not finite"),
        (radius.clone(), with(1, f64::INFINITY, &height), "row 2 is r = 1, f = inf"),
        (with(0, 0.5, &radius), height.clone(), "begins at r = 5e-1 m with f = 0e0 m"),
        (radius.clone(), with(0, 0.5, &height), "begins at r = 0e0 m with f = 5e-1 m"),
        (with(2, 1.0, &radius), height.clone(), "radius 1e0 m follows 1e0 m; they must increase"),
        (radius.clone(), with(1, -0.5, &height), "at r = 1e0 m it lies 5e-1 m below the tip"),
        (radius.clone(), vec![0.0; 4], "flat punch"),
        (radius.iter().map(|r| r * 1e120).collect(), height.clone(), "check the units"),
        (with(1, 1e-200, &radius), height.clone(), "check the units"),
    ] {
        let message = refusal(radius, height);
        assert!(message.starts_with("indenter.table: ") && message.contains(words), "{words}: {message}");
    }
}

#[test]
fn a_contact_that_would_split_into_rings_is_refused_with_the_radii() {
    // A groove at r = 0.8, as deep as the flank at 0.49: it rises, falls and rises again.
    let radius = even(201, 1.0);
    let groove = |r: f64| 0.5 * (-((r - 0.8) / 0.05f64).powi(2)).exp();
    let height = radius.iter().map(|r| r * (r - groove(*r))).collect();
    let indenter = table(radius, height);
    for grading in [-0.9, 0.0, 0.5] {
        let g = indenter.equivalent_profile(grading).unwrap();
        let top = g.largest_radius();
        assert!((0.6..0.8).contains(&top), "k = {grading}: {top}");
        let message = g.radius_at(1.001 * g.value(top)).unwrap_err().to_string();
        for words in [
            "split into rings",
            &format!("between its rows at r = {top:e} m and "),
            "as indenter.table.smoothing",
        ] {
            assert!(message.contains(words), "k = {grading}: {words:?} not in {message}");
        }
        let limit = |contact_radius: f64| {
            LimitingShape::from_stick_ratio(&indenter, grading, g.value(contact_radius), 0.7)
        };
        // Well inside the groove has no say, be `g` there what it may; nearer, the limit would touch its far side, or reach into it.
        assert!(limit(0.1).is_ok(), "k = {grading}: {}", limit(0.1).unwrap_err());
        for (contact_radius, words) in
            [(0.48, "would touch again at its row r = "), (0.999 * top, "would touch beyond")]
        {
            let message = limit(contact_radius).map(drop).unwrap_err().to_string();
            assert!(
                message.contains(words) && message.contains("rings"),
                "k = {grading}, {contact_radius}: {message}"
            );
        }
    }
}

#[test]
fn a_table_that_ends_too_early_is_refused_with_the_radius_it_has() {
    let paraboloid = Indenter::paraboloid(1e-2).unwrap();
    let indenter = sampled(&paraboloid, even(101, 1e-4));
    let g = indenter.equivalent_profile(0.0).unwrap();
    assert_eq!(g.largest_radius(), 1e-4);
    let message = g.radius_at(1.01e-6).unwrap_err().to_string();
    assert!(
        message.contains("an indentation of 1.01e-6 m is too much: the table ends at 1e-4 m"),
        "{message}"
    );
    assert!(message.contains("measure further out, or press less deep"), "{message}");
    assert!(relative(g.radius_at(1e-6 * (1.0 - 1e-12)).unwrap(), 1e-4) < 1e-12);
    let message = g.depth_for_load(1.01 * g.load_integral(1e-4)).unwrap_err().to_string();
    assert!(message.contains("F_N/c_N") && message.contains("the table ends at 1e-4 m"), "{message}");
    // a∞/a0 = 1.136 for c/a0 = 0.7.
    let limit =
        |contact_radius: f64| LimitingShape::from_stick_ratio(&indenter, 0.0, g.value(contact_radius), 0.7);
    assert!(limit(0.87e-4).is_ok());
    let message = limit(0.95e-4).map(drop).unwrap_err().to_string();
    assert!(message.contains("touch beyond 0.0001 m: the table ends at 1e-4 m"), "{message}");
}

#[test]
fn large_tables_carry_what_the_sphere_does_that_they_sample() {
    let sphere = Indenter::sphere(1e-3).unwrap();
    let exact = sphere.equivalent_profile(0.3).unwrap();
    for rows in [1_000, 10_000, 50_000] {
        let g = sampled(&sphere, even(rows, 9e-4)).equivalent_profile(0.3).unwrap();
        for radius in [1e-5, 1e-4, 5e-4, 8.9e-4] {
            let error = (g.value(radius) / exact.value(radius) - 1.0).abs();
            println!("{rows} rows, {radius}: {error:e}");
            assert!(error < 1e-9, "{rows} rows: off by {error:e} at {radius} m");
        }
    }
}

/// Rows a few roundings apart were once walked between for ever, or their rounding gave a slope and with it a wrong volume.
#[test]
fn rows_too_close_for_a_slope_are_refused() {
    for place in 0..8 {
        let close = 1e-4 * (1.0 + 0.137 * f64::from(place)) / 3.0;
        for apart in [f64::EPSILON, 5.0 * f64::EPSILON, 1e-13, 9e-11] {
            let mut radius = even(40, 1e-3);
            radius.extend((0..4).map(|row| close * (1.0 + f64::from(row) * apart)));
            radius.sort_by(f64::total_cmp);
            let height: Vec<f64> = radius.iter().map(|r| 50.0 * r * r).collect();
            let message = TabulatedProfile::new("rows", radius, height).expect_err("too close").to_string();
            assert!(message.starts_with("indenter.table: ") && message.contains("remove one"), "{message}");
        }
    }
}
