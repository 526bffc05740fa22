//! Spring stiffnesses against printed values, exact limits and arithmetic of sixty digits.

use fretwear::Error;
use fretwear::contact::half_space::{HalfSpace, Poisson, similar_stiffness_ratio};

fn unit(grading: f64, ratio: f64) -> HalfSpace {
    HalfSpace::from_modulus(grading, 1.0, 1.0, Poisson::Ratio(ratio)).expect("a half-space")
}

fn relative(found: f64, expected: f64) -> f64 {
    (found / expected - 1.0).abs()
}

#[test]
fn stiffnesses_agree_with_an_independent_solution_to_all_its_printed_digits() {
    // (k, ν, c_N/E0, c_T/E0, M), half a unit of the last digit.
    let printed = [
        (-0.5, 0.3, "0.4017282127", "0.6984554893", "1.73862693"),
        (0.0, 0.3, "1.098901099", "0.9049773756", "0.8235294118"),
        (0.2, 0.3, "1.281130773", "0.8363349152", "0.6528099496"),
        (0.5, 0.45, "1.741415405", "0.5700750764", "0.3273630605"),
        (0.8, 0.45, "1.286354364", "0.2287566929", "0.17783334"),
    ];
    for (grading, ratio, normal, tangential, stiffness_ratio) in printed {
        let body = unit(grading, ratio);
        let found = [
            body.normal_stiffness(),
            body.stiffness_ratio() * body.normal_stiffness(),
            body.stiffness_ratio(),
        ];
        for (value, digits) in found.into_iter().zip([normal, tangential, stiffness_ratio]) {
            let places = digits.split('.').nth(1).map_or(0, str::len);
            let expected: f64 = digits.parse().expect("a number");
            let half_unit = 0.5 * 10f64.powi(-(places as i32));
            assert!(
                (value - expected).abs() <= half_unit * 1.0001,
                "k = {grading}, ν = {ratio}: {value} for {digits}"
            );
        }
    }
    assert!((unit(-0.5, 0.45).stiffness_ratio() - 1.700).abs() < 5e-4);
}

#[test]
fn stiffnesses_hold_to_fourteen_digits_up_to_the_corners_of_their_range() {
    // (k, ν, c_N, M) of these very doubles by the same formulas in mpmath with 60 digits; the largest error seen is 1.1e-15.
    let reference = [
        (-0.999, 0.3, 2.4139881448921424e-6, 741.2785128009724),
        (-0.9, -0.9, 0.25221412233356716, 5.9605656518840595),
        (-0.5, 0.5, 0.4028330021807206, 1.683684258486111),
        (0.5, 0.5, 2.10590920385239, 0.26783413653297306),
        (0.999, 0.5, 2.095202866233697, 0.0005000284790679129),
        (0.999999, 0.5, 2.0943959114449253, 5.000000284408402e-7),
        (1.0 - 2f64.powi(-40), 0.5 - 2f64.powi(-30), 0.0005112021253591335, 1.863099893110799e-9),
        (0.9, -0.99, 16.897462582892274, 0.8359268234881381),
        (-1.0 + 2f64.powi(-40), 0.25, 2.078931628468649e-24, 799644820201.2787),
        (0.75, 0.0, 0.641755331807034, 0.5836029460590836),
        (0.497, 0.22, 1.1400642790124806, 0.5407077141305573),
        (-0.2, 0.31, 0.8346802529881304, 1.06171534572505),
    ];
    for (grading, ratio, normal, stiffness_ratio) in reference {
        let body = unit(grading, ratio);
        let errors =
            [relative(body.normal_stiffness(), normal), relative(body.stiffness_ratio(), stiffness_ratio)];
        assert!(errors.iter().all(|&error| error < 1e-14), "k = {grading}, ν = {ratio}: {errors:?}");
    }
}

#[test]
fn a_homogeneous_half_space_has_the_classical_stiffnesses() {
    for ratio in [-0.9, 0.0, 0.3, 0.5] {
        let body = unit(0.0, ratio);
        assert!(relative(body.normal_stiffness(), 1.0 / (1.0 - ratio * ratio)) < 1e-14);
        assert!(relative(body.stiffness_ratio(), 2.0 * (1.0 - ratio) / (2.0 - ratio)) < 1e-14);
    }
}

#[test]
fn elastic_similarity_is_the_general_formula_at_its_own_poisson_ratio() {
    for step in 0..100 {
        let grading = f64::from(step) / 100.0;
        let similar = HalfSpace::from_modulus(grading, 3.0, 0.5, Poisson::Similar).expect("similar");
        let general = HalfSpace::from_modulus(grading, 3.0, 0.5, Poisson::Ratio(1.0 / (2.0 + grading)))
            .expect("general");
        let errors = [
            relative(similar.normal_stiffness(), general.normal_stiffness()),
            relative(similar.stiffness_ratio(), general.stiffness_ratio()),
        ];
        assert!(errors.iter().all(|&error| error < 2e-14), "k = {grading}: {errors:?}");
        assert_eq!(similar.stiffness_ratio(), similar_stiffness_ratio(grading));
    }
}

#[test]
fn similarity_at_negative_grading_is_formal_and_does_not_fail() {
    let body = HalfSpace::from_modulus(-0.5, 1.0, 1.0, Poisson::Similar).expect("a formal limit");
    assert!(relative(body.stiffness_ratio(), 1.6) < 1e-15);
    assert!(
        Poisson::Similar.is_formal(-0.5)
            && !Poisson::Similar.is_formal(0.0)
            && !Poisson::Similar.is_formal(0.5)
    );
    assert!(!Poisson::Ratio(0.5).is_formal(-0.5));
}

#[test]
fn the_modulus_counts_at_the_reference_depth() {
    let here = HalfSpace::from_modulus(0.5, 4.0, 1.0, Poisson::Ratio(0.3)).expect("a half-space");
    let there = HalfSpace::from_modulus(0.5, 8.0, 4.0, Poisson::Ratio(0.3)).expect("a half-space");
    assert!(relative(here.normal_stiffness(), there.normal_stiffness()) < 1e-15);
}

#[test]
fn two_bodies_act_in_series_in_both_directions() {
    let (first, second) =
        (unit(0.2, 0.3), HalfSpace::from_modulus(0.2, 7.0, 1.0, Poisson::Ratio(0.0)).expect("second"));
    let pair = HalfSpace::in_series(&first, &second).expect("a pair");
    let normal = 1.0 / (1.0 / first.normal_stiffness() + 1.0 / second.normal_stiffness());
    let tangential = 1.0
        / (1.0 / (first.stiffness_ratio() * first.normal_stiffness())
            + 1.0 / (second.stiffness_ratio() * second.normal_stiffness()));
    assert!(relative(pair.normal_stiffness(), normal) < 1e-15);
    assert!(relative(pair.stiffness_ratio() * pair.normal_stiffness(), tangential) < 1e-15);
    assert_eq!(pair, HalfSpace::in_series(&second, &first).expect("the same pair"));
}

#[test]
fn a_body_far_stiffer_than_the_other_counts_as_rigid() {
    let soft = HalfSpace::from_stiffness(0.0, 1e-200, 0.8).expect("soft");
    let stiff = HalfSpace::from_stiffness(0.0, 1e200, 0.8).expect("stiff");
    assert_eq!(HalfSpace::in_series(&soft, &stiff).expect("a pair").normal_stiffness(), 1e-200);
}

#[test]
fn bodies_of_different_grading_have_no_common_springs() {
    let error = HalfSpace::in_series(&unit(0.2, 0.3), &unit(0.3, 0.3)).expect_err("different gradings");
    assert!(
        matches!(error, Error::Inconsistent { .. }) && error.to_string().contains("0.2 and 0.3"),
        "{error}"
    );
}

#[test]
fn an_argument_out_of_range_is_named_as_in_a_scene() {
    let ratio = Poisson::Ratio;
    let cases = [
        (HalfSpace::from_modulus(1.0, 1.0, 1.0, ratio(0.3)), "half_space.grading"),
        (HalfSpace::from_modulus(f64::NAN, 1.0, 1.0, ratio(0.3)), "half_space.grading"),
        (HalfSpace::from_modulus(0.1, 0.0, 1.0, ratio(0.3)), "half_space.modulus"),
        (HalfSpace::from_modulus(0.1, f64::INFINITY, 1.0, ratio(0.3)), "half_space.modulus"),
        (HalfSpace::from_modulus(0.1, 1.0, -1.0, ratio(0.3)), "half_space.reference_depth"),
        (HalfSpace::from_modulus(0.1, 1.0, 1.0, ratio(0.51)), "half_space.poisson_ratio"),
        (HalfSpace::from_modulus(0.1, 1.0, 1.0, ratio(-1.0)), "half_space.poisson_ratio"),
        (HalfSpace::from_modulus(0.1, 1.0, 1.0, ratio(f64::NAN)), "half_space.poisson_ratio"),
        (HalfSpace::from_modulus(0.9, 1e300, 1e-300, ratio(0.3)), "half_space.normal_stiffness"),
        (HalfSpace::from_stiffness(-1.0, 1.0, 1.0), "half_space.grading"),
        (HalfSpace::from_stiffness(0.0, 0.0, 1.0), "half_space.normal_stiffness"),
        (HalfSpace::from_stiffness(0.0, 1.0, f64::NAN), "half_space.stiffness_ratio"),
    ];
    for (result, key) in cases {
        let message = result.expect_err(key).to_string();
        assert!(message.starts_with(key), "{message} should begin with {key}");
    }
}
