//! The claims of the paper, each with the number that decides it; docs/claims.md states the same numbers.

use std::f64::consts::PI;

use fretwear::contact::closed_form::{
    LimitingShape, Regime, full_sliding_amplitude, relative_limit_width, relative_slip_width,
    similar_stiffness_ratio, slip_compression,
};
use fretwear::contact::half_space::{HalfSpace, Poisson};
use fretwear::contact::indenter::Indenter;
use fretwear::numerics::quadrature::Rule;
use fretwear::study::wear_map::{Control, Medium, OptimumCurve, Thresholds, WearMap};

/// Asserts that the row of docs/claims.md that begins with the claim holds every number, as it is written there.
fn stated(claim: &str, numbers: &[String]) {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/claims.md");
    let text = std::fs::read_to_string(&path).unwrap();
    let row = text.lines().find(|line| line.starts_with(&format!("| {claim} |")));
    let row = row.unwrap_or_else(|| panic!("docs/claims.md has no row {claim:?}; numbers: {numbers:?}"));
    for number in numbers {
        assert!(row.contains(number.as_str()), "docs/claims.md, {claim:?}: {number} is not in {row:?}");
    }
}

fn digits(value: f64, decimals: usize) -> String {
    format!("{value:.decimals$}")
}

fn paraboloid() -> Medium {
    Medium::new(2.0, Poisson::Similar).unwrap()
}

fn cone() -> Medium {
    Medium::new(1.0, Poisson::Similar).unwrap()
}

fn ratio(medium: &Medium, grading: f64, amplitude_ratio: f64) -> f64 {
    WearMap::new(medium, &[grading], &[amplitude_ratio]).unwrap().ratio[0]
}

fn optimum(medium: &Medium, amplitude_ratio: f64) -> (f64, f64) {
    let curve = OptimumCurve::new(medium, Control::Indentation, &[amplitude_ratio]).unwrap();
    (curve.points[0].grading, curve.points[0].volume_ratio)
}

const POSITIVE: [f64; 5] = [0.1, 0.3, 0.5, 0.7, 0.95];
const NEGATIVE: [f64; 3] = [-0.1, -0.3, -0.5];

#[test]
fn positive_gradings_wear_less_at_intermediate_and_large_amplitudes() {
    for medium in [paraboloid(), cone()] {
        for amplitude in [0.3, 0.5, 1.0] {
            for grading in POSITIVE {
                let less = ratio(&medium, grading, amplitude);
                assert!(less < 1.0, "k = {grading}, {amplitude}: {less}");
            }
            let more = ratio(&medium, -0.1, amplitude);
            assert!(more > 1.0, "{amplitude}: {more}");
        }
    }
    let numbers = [0.3, 0.5, 1.0].map(|amplitude| digits(ratio(&paraboloid(), 0.5, amplitude), 3));
    stated("Positive k reduces wear at intermediate and large amplitudes", &numbers);
}

#[test]
fn negative_gradings_wear_less_at_small_amplitudes() {
    for medium in [paraboloid(), cone()] {
        for grading in NEGATIVE {
            let less = ratio(&medium, grading, 1e-3);
            assert!(less < 1.0, "k = {grading}: {less}");
        }
        for grading in POSITIVE {
            let more = ratio(&medium, grading, 1e-3);
            assert!(more > 1.0, "k = {grading}: {more}");
        }
    }
    let numbers = [1e-3, 1e-4].map(|amplitude| digits(ratio(&paraboloid(), -0.5, amplitude), 3));
    stated("Negative k pays at small amplitudes", &numbers);
}

#[test]
fn the_best_grading_of_small_amplitudes_is_negative_and_not_slightly() {
    let mut numbers = vec![];
    for amplitude in [1e-2, 1e-3, 1e-4] {
        let (grading, _) = optimum(&paraboloid(), amplitude);
        numbers.push(digits(grading, 2));
    }
    numbers.push(digits(optimum(&paraboloid(), 1e-4).1, 2));
    stated("A slightly positive exponent is best at very small amplitudes", &numbers);
    assert_eq!(numbers, ["-0.36", "-0.58", "-0.70", "0.22"]);
}

#[test]
fn the_best_grading_grows_with_the_amplitude_and_crosses_zero_once() {
    let amplitudes = [1e-6, 1e-4, 1e-2, 0.05, 0.1, 0.2, 0.3, 0.5];
    let best: Vec<f64> = amplitudes.map(|amplitude| optimum(&paraboloid(), amplitude).0).into();
    assert!(best.windows(2).all(|pair| pair[1] > pair[0]), "{best:?}");
    let numbers: Vec<String> = [0.1, 0.2, 0.3, 0.5]
        .iter()
        .map(|&amplitude| digits(optimum(&paraboloid(), amplitude).0, 2))
        .collect();
    assert_eq!(numbers, ["0.11", "0.35", "0.51", "0.76"]);
    stated("The optimum grading depends on the amplitude", &numbers);
}

#[test]
fn more_grading_is_not_always_better() {
    let found = Thresholds::new(&paraboloid()).unwrap();
    let [beats, best] = [found.limit_beats_homogeneous, found.limit_is_best].map(Option::unwrap);
    // at 0.3 the limit k → 1 still wears more than k = 0.5
    assert!(ratio(&paraboloid(), 0.9999, 0.2) > 1.0 && ratio(&paraboloid(), 0.9999, 0.3) < 1.0);
    assert!(ratio(&paraboloid(), 0.9999, 0.3) > ratio(&paraboloid(), 0.5, 0.3));
    stated("The more positive k, the less wear", &[digits(beats, 4), digits(best, 3)]);
}

#[test]
fn cone_and_paraboloid_agree_in_kind() {
    let crossings =
        [paraboloid(), cone()].map(|medium| Thresholds::new(&medium).unwrap().optimum_crosses_zero.unwrap());
    for amplitude in [1e-3, 0.01, 0.05, 0.1, 0.3, 1.0] {
        let signs = [paraboloid(), cone()].map(|medium| optimum(&medium, amplitude).0.signum());
        assert_eq!(signs[0], signs[1], "U/(μ_f d) = {amplitude}");
    }
    stated("Cone and paraboloid agree in kind", &crossings.map(|it| digits(it, 4)));
}

#[test]
fn the_annulus_grows_by_the_same_factor_whatever_the_profile() {
    let mut largest = 0.0f64;
    for grading in [-0.9, -0.3, 0.0, 0.5, 0.9] {
        for indenter in [
            Indenter::cone(0.1).unwrap(),
            Indenter::paraboloid(1.0).unwrap(),
            Indenter::sphere(1.0).unwrap(),
            Indenter::power_law(0.3, 0.4).unwrap(),
            Indenter::power_law(2.0, 7.0).unwrap(),
        ] {
            let deviation = |ratio: f64| {
                let shape = LimitingShape::from_stick_ratio(&indenter, grading, 0.1, ratio).unwrap();
                let small = relative_slip_width(shape.slip_width_initial(), shape.stick_radius());
                (shape.slip_width_limit() / shape.stick_radius() / relative_limit_width(grading, small) - 1.0)
                    .abs()
            };
            let (coarse, fine) = (deviation(1.0 - 1e-5), deviation(1.0 - 1e-6));
            largest = largest.max(fine);
            let order = (coarse / fine).log10();
            assert!((order - 1.0).abs() < 0.01, "{indenter:?}, k = {grading}: order {order}");
        }
    }
    assert!(largest < 1e-5, "{largest:e}");
    stated("ε = (3-k)/2 ε_a for every profile", &[format!("{largest:.1e}")]);
}

#[test]
fn the_gibson_medium_does_not_wear() {
    // k = 1 - δ, ν = 1/2: M → δ/2
    for delta in [1e-2, 1e-4, 1e-6] {
        let ratio =
            HalfSpace::from_modulus(1.0 - delta, 1.0, 1.0, Poisson::Ratio(0.5)).unwrap().stiffness_ratio();
        assert!((ratio / delta - 0.5).abs() < delta, "δ = {delta}: M = {ratio}");
    }
    let gibson = Medium::new(2.0, Poisson::Ratio(0.5)).unwrap();
    let volume = |delta: f64| WearMap::new(&gibson, &[1.0 - delta], &[0.5]).unwrap().volume[0];
    let order = (volume(1e-3) / volume(1e-5)).log10() / 2.0;
    assert!((order - 2.0).abs() < 0.01, "ΔV falls with the power {order} of 1-k");
    assert_eq!(Poisson::Ratio(0.5).stiffness_ratio(1.0), 0.0);
    // elastic similarity instead: M → 1/4, and something wears
    let similar = ratio(&paraboloid(), 1.0 - 1e-9, 0.5);
    stated(
        "The Gibson medium with ν = 1/2 does not wear",
        &[digits(order, 2), digits(similar_stiffness_ratio(1.0), 2), digits(similar, 2)],
    );
}

#[test]
fn equation_4_needs_the_limiting_contact_radius() {
    let shape = LimitingShape::from_stick_ratio(&Indenter::paraboloid(1.0).unwrap(), 0.0, 1.0, 0.5).unwrap();
    let up_to = |outer: f64| {
        // with z = r² - c² as z = Z v^2, for the square root at c
        let (c, span) = (shape.stick_radius(), outer * outer - shape.stick_radius().powi(2));
        let rule = Rule::legendre(100).unwrap();
        assert!(c > 0.0);
        PI * span * rule.mean(|v| 2.0 * v * shape.wear_depth_at_offset(span * v * v))
    };
    let whole = up_to(shape.contact_radius_limit());
    assert!((whole / shape.wear_volume() - 1.0).abs() < 1e-6, "{whole} {}", shape.wear_volume());
    let printed = up_to(shape.contact_radius_initial()) / shape.wear_volume();
    stated("Eq. 4: the upper limit is a∞", &[digits(printed, 3)]);
}

#[test]
fn equation_11_has_no_stick_at_its_largest_amplitude() {
    let (stiffness_ratio, friction, indentation) = (similar_stiffness_ratio(0.3), 0.4, 1e-6);
    let largest = full_sliding_amplitude(stiffness_ratio, friction, indentation);
    let regime =
        |amplitude: f64| Regime::new(indentation, slip_compression(stiffness_ratio, amplitude, friction));
    assert_eq!(regime(largest), Regime::FullSliding);
    assert_eq!(regime(largest * (1.0 - 1e-12)), Regime::PartialSlip);
    stated("Eq. 11: U < u_max", &["c = 0".to_string()]);
}

#[test]
fn equation_12_holds_for_one_poisson_ratio_only() {
    for grading in [0.0, 0.3, 0.8] {
        let hidden = 1.0 / (2.0 + grading);
        let of = |ratio: f64| {
            HalfSpace::from_modulus(grading, 1.0, 1.0, Poisson::Ratio(ratio)).unwrap().stiffness_ratio()
        };
        let printed = similar_stiffness_ratio(grading);
        assert!((of(hidden) / printed - 1.0).abs() < 1e-14, "k = {grading}");
        assert!((of(0.3) / printed - 1.0).abs() > 0.02, "k = {grading}");
    }
    let ordinary = HalfSpace::from_modulus(-0.5, 1.0, 1.0, Poisson::Ratio(0.45)).unwrap().stiffness_ratio();
    assert!(
        Poisson::Similar.is_formal(-0.5)
            && HalfSpace::from_modulus(-0.5, 1.0, 1.0, Poisson::Ratio(2.0 / 3.0)).is_err()
    );
    stated("Eq. 12 implies ν = 1/(2+k)", &[digits(similar_stiffness_ratio(-0.5), 1), digits(ordinary, 3)]);
}

/// `F_N/c_N` of the pressure of Eq. (21) with a further factor `x^power`, integrated over the contact of a paraboloid `g = g1 x²`:
/// the order of integration exchanged, `2/(1+k) ∫ x^(power+1+k) g' dx`.
fn load_of_pressure(grading: f64, power: f64, factor: f64, radius: f64) -> f64 {
    let exponent = power + 3.0 + grading;
    2.0 / (1.0 + grading) * 2.0 * factor * radius.powf(exponent) / exponent
}

#[test]
fn equation_21_as_printed_does_not_balance_the_force() {
    // f = r²/2 (R = 1), k = 0.5, a = 1: g = x²/(1+k)
    let grading = 0.5;
    let profile = Indenter::paraboloid(1.0).unwrap().equivalent_profile(grading).unwrap();
    let force = profile.load_integral(1.0);
    let factor = profile.value(1.0);
    let (corrected, printed) =
        (load_of_pressure(grading, 0.0, factor, 1.0), load_of_pressure(grading, grading, factor, 1.0));
    assert!((corrected / force - 1.0).abs() < 1e-14, "{corrected} {force}");
    assert!((printed / force - 1.0).abs() > 0.1);
    stated("Eq. 21 has a factor x^k too many", &[digits(printed, 3), digits(force, 3)]);
}

#[test]
fn the_jump_of_the_limiting_profile_carries_load() {
    // Paraboloid R = 1, d = 1, c/a0 = 0.5. Pressure of g∞ within c: that of g0 up to c, and that of the jump d - g0(c),
    // (c_N/π) (d - g0(c)) (c² - r²)^(-μ), whose load is 2 c_N (d - g0(c)) c^(1+k)/(1+k).
    for grading in [-0.5, 0.0, 0.5] {
        let shape =
            LimitingShape::from_stick_ratio(&Indenter::paraboloid(1.0).unwrap(), grading, 1.0, 0.5).unwrap();
        let profile = shape.initial_equivalent_profile();
        let (c, a0) = (shape.stick_radius(), shape.contact_radius_initial());
        let smooth = profile.load_integral(c) / profile.load_integral(a0);
        let jump = 2.0 * shape.slip_compression() * c.powf(1.0 + grading)
            / (1.0 + grading)
            / profile.load_integral(a0);
        // F∞/F0 = [c^q/q - c^(n+q)/(n+q)] q (n+q)/n, c in a0, q = 1+k
        let (q, n, ratio) = (1.0 + grading, 2.0, 0.5f64);
        let known = (ratio.powf(q) / q - ratio.powf(n + q) / (n + q)) * q * (n + q) / n;
        assert!(
            (shape.load_fraction() / known - 1.0).abs() < 1e-13
                && ((smooth + jump) / known - 1.0).abs() < 1e-13
        );
        if grading == 0.0 {
            stated("g∞ jumps at c, and the jump carries load", &[digits(smooth, 4), digits(jump, 4)]);
        }
    }
}

#[test]
fn figure_1_begins_where_something_sticks() {
    // U/(μ_f d) = 0.5 = (1+k)(3+k)/2 at k = -2 + √2
    let border = -2.0 + 2f64.sqrt();
    assert!((similar_stiffness_ratio(border) * 0.5 - 1.0).abs() < 1e-14);
    let regime = |grading: f64| Regime::new(1.0, similar_stiffness_ratio(grading) * 0.5);
    assert_eq!([regime(border - 1e-9), regime(border + 1e-9)], [Regime::FullSliding, Regime::PartialSlip]);
    stated("Fig. 1 exists for every k", &[digits(border, 4)]);
}
