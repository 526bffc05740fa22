//! The two ways to the limiting shape, the integral of Eq. (3) and the series of Eqs. (9), (10), each held to the error it claims: against
//! tables of 17 digits (`data/reference`) and against each other over the whole range of parameters.

mod support;

use fretwear::contact::closed_form::{Claimed, HypergeometricLimit, LimitingShape};
use fretwear::contact::indenter::{Indenter, power_law_factor};
use std::f64::consts::PI;
use support::reference::{Table, Worst, relative};

/// Power law with `g = x^n`, so that `a0 = d = 1`.
fn unit_power_law(exponent: f64, grading: f64) -> Indenter {
    Indenter::power_law(1.0 / power_law_factor(exponent, grading), exponent).unwrap()
}

/// How the errors of one quantity compare with those claimed.
#[derive(Default)]
struct Claims {
    rows: usize,
    /// Largest actual error over the claimed one: above one the claim is wrong.
    largest: f64,
    /// Sum of the logarithms of it, to see whether the claims are absurd; an actual error of zero counts as a last bit.
    logarithms: f64,
    /// Largest claim over the value.
    loosest: f64,
}

impl Claims {
    fn note(&mut self, found: Claimed, expected: f64, place: &[String]) {
        let error = (found.value - expected).abs();
        assert!(
            error <= found.error,
            "{:e} ± {:e} for {expected:e}: off by {error:e} at {:?}",
            found.value,
            found.error,
            &place[..4]
        );
        // Where nothing is worn and nothing is claimed there is nothing to compare.
        if found.error == 0.0 {
            return;
        }
        self.rows += 1;
        self.largest = self.largest.max(error / found.error);
        self.logarithms += (error.max(0.1 * f64::EPSILON * expected.abs()) / found.error).ln();
        if expected != 0.0 {
            self.loosest = self.loosest.max(found.error / expected.abs());
        }
    }

    fn report(&self, quantity: &str) {
        let typical = (self.logarithms / self.rows as f64).exp();
        println!(
            "{quantity}: {} rows, error over claim at most {:.2e}, typically {typical:.1e}; largest claim {:.1e} of the value",
            self.rows, self.largest, self.loosest
        );
        assert!(typical > 1e-3, "{quantity}: claims {:e} times too large", 1.0 / typical);
    }
}

/// Growth `a∞ - a0` and width `a∞ - c`, in `a0`, from `ln(a∞/a0)`.
fn widths(growth: Claimed, stick_logarithm: f64) -> [Claimed; 2] {
    let limit = growth.value.exp();
    let error = 1.1 * limit * growth.error;
    let widths =
        [growth.value.exp_m1(), (-stick_logarithm).exp() * (growth.value + stick_logarithm).exp_m1()];
    widths.map(|value| Claimed { value, error: error + 4.0 * f64::EPSILON * value })
}

#[test]
fn the_series_keep_their_claims_on_limiting_shapes() {
    let table = Table::read("limiting.csv");
    let mut claims: [Claims; 4] = Default::default();
    for row in &table.rows {
        let of = |name| table.number(row, name);
        let stick_logarithm = -of("c_over_a0").ln();
        let limit = HypergeometricLimit::new(of("n"), of("k"), stick_logarithm).unwrap();
        let growth = limit.growth().unwrap();
        let [increase, width] = widths(growth, stick_logarithm);
        let expected = [of("a_inf_minus_a0_over_a0"), of("a_inf_minus_c_over_a0"), of("dv_over_pi_a0sq_d")];
        claims[0].note(increase, expected[0], row);
        claims[1].note(width, expected[1], row);
        claims[2].note(limit.wear_volume(growth).unwrap(), expected[2], row);
        let deepest = (of("r_max_minus_c_over_a0") / of("c_over_a0")).ln_1p();
        let depth = limit.wear_depth(deepest, deepest - stick_logarithm).unwrap();
        claims[3].note(depth, of("max_df_over_d"), row);
    }
    for (claim, quantity) in claims.iter().zip(["a∞ - a0", "a∞ - c", "ΔV", "max Δf"]) {
        claim.report(quantity);
    }
}

#[test]
fn the_series_keep_their_claims_at_tiny_amplitudes() {
    let table = Table::read("small_amplitude.csv");
    let mut claims: [Claims; 3] = Default::default();
    for row in &table.rows {
        let of = |name| table.number(row, name);
        let stick_logarithm = -(-of("one_minus_c_over_a0")).ln_1p();
        let limit = HypergeometricLimit::new(of("n"), of("k"), stick_logarithm).unwrap();
        // Where the claim exceeds the growth itself there is nothing left to be found.
        let growth = limit.growth().unwrap();
        claims[0].note(widths(growth, stick_logarithm)[0], of("a_inf_minus_a0_over_a0"), row);
        claims[1].note(limit.wear_volume(growth).unwrap(), of("dv_over_pi_a0sq_d"), row);
        let span = (of("r_max_minus_c_over_a0") / (1.0 - of("one_minus_c_over_a0"))).ln_1p();
        let depth = limit.wear_depth(span, span - stick_logarithm).unwrap();
        claims[2].note(depth, of("max_df_over_d"), row);
    }
    for (claim, quantity) in claims.iter().zip(["a∞ - a0", "ΔV", "max Δf"]) {
        claim.report(quantity);
    }
}

#[test]
fn the_series_keep_their_claims_on_worn_profiles() {
    let table = Table::read("profile.csv");
    let mut claims: [Claims; 2] = Default::default();
    for row in &table.rows {
        let of = |name| table.number(row, name);
        let (ratio, beyond) = (of("c_over_a0"), of("r_minus_c_over_a0"));
        let stick_logarithm = -ratio.ln();
        let limit = HypergeometricLimit::new(of("n"), of("k"), stick_logarithm).unwrap();
        let span = (beyond / ratio).ln_1p();
        let growth = span - stick_logarithm;
        claims[0].note(limit.wear_depth(span, growth).unwrap(), of("delta_f_over_d"), row);
        claims[1].note(limit.profile(span, growth).unwrap(), of("f_inf_over_d"), row);
    }
    claims[0].report("Δf");
    claims[1].report("f∞");
}

/// Random numbers in [0, 1) from a seed (SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((bits ^ (bits >> 31)) >> 11) as f64 * (-53f64).exp2()
    }

    /// From `low` to `high`, evenly in the logarithm.
    fn logarithmic(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.next())
    }

    fn side(&mut self) -> bool {
        self.next() < 0.5
    }
}

/// Exponent, grading, amplitude over that of full sliding, and a place between `c` and `a∞`.
fn parameters(random: &mut Random) -> (f64, f64, f64, f64) {
    let side = if random.side() { 1.0 } else { -1.0 };
    let grading = side * (1.0 - random.logarithmic(1e-4, 1.0));
    let exponent = random.logarithmic(0.1, 20.0);
    let small = random.logarithmic(1e-10, 0.5);
    let amplitude = if random.side() { small } else { 1.0 - small };
    (exponent, grading, amplitude, random.next())
}

/// Both ways for random parameters; returns how many gave an error.
fn both_ways_agree(count: usize, seed: u64) -> usize {
    let mut random = Random(seed);
    let mut refused = 0;
    let mut apart =
        [(0.0_f64, String::new()), (0.0, String::new()), (0.0, String::new()), (0.0, String::new())];
    for _ in 0..count {
        let (n, k, q, place) = parameters(&mut random);
        let text = format!("n = {n}, k = {k}, q = {q:e}");
        let shape = match LimitingShape::new(&unit_power_law(n, k), k, 1.0, q) {
            Ok(shape) => shape,
            Err(error) => {
                println!("{text}: {error}");
                refused += 1;
                continue;
            }
        };
        let (growth, width) = (shape.contact_growth_limit(), shape.slip_width_limit());
        for value in [growth, shape.slip_width_initial(), shape.wear_volume(), shape.wear_depth_max()] {
            assert!(value > 0.0 && value.is_finite(), "{text}: {value:e}");
        }
        // The two differ by a0 - c, which beside a∞ may be below the last bit.
        let held = shape.slip_width_initial() > LimitingShape::CLAIMED_ERROR * width;
        assert!(width > growth || !held, "{text}: {width:e} and {growth:e}");
        let c = shape.stick_radius();
        let beyond = place * width;
        let offset = beyond * (2.0 * c + beyond);
        let depth = shape.wear_depth_at_offset(offset);
        assert!(
            depth >= 0.0 && depth <= shape.wear_depth_max() * (1.0 + 1e-13),
            "{text}: {depth:e} at {place}"
        );

        let stick_logarithm = -(-q).ln_1p() / n;
        let series = HypergeometricLimit::new(n, k, stick_logarithm).unwrap();
        let root = series.growth().unwrap();
        let [increase, annulus] = widths(root, stick_logarithm);
        let volume = series.wear_volume(root).unwrap();
        let span = 0.5 * (offset / c / c).ln_1p();
        let other_depth = series.wear_depth(span, span - stick_logarithm).unwrap();
        let claim = LimitingShape::CLAIMED_ERROR;
        let pairs = [
            (growth, claim * growth, increase),
            (width, claim * width, annulus),
            (shape.wear_volume() / PI, claim * shape.wear_volume() / PI, volume),
            (depth, claim * shape.wear_depth_max(), other_depth),
        ];
        for ((value, error, other), worst) in pairs.into_iter().zip(&mut apart) {
            let ratio = (value - other.value).abs() / (error + other.error);
            if ratio.is_nan() || ratio > worst.0 {
                *worst = (ratio, format!("{text}: {value:e} and {:e} ± {:e}", other.value, other.error));
            }
        }
    }
    for (quantity, (ratio, text)) in ["a∞ - a0", "a∞ - c", "ΔV", "Δf"].iter().zip(&apart) {
        println!("{quantity}: difference over both claims at most {ratio:.2} ({text})");
    }
    assert!(apart.iter().all(|(ratio, _)| *ratio <= 1.0), "{apart:?}");
    refused
}

#[test]
fn both_ways_agree_within_their_claims_for_ten_thousand_random_parameters() {
    assert_eq!(both_ways_agree(10_000, 20_190_711), 0, "parameters refused");
}

#[test]
#[ignore = "a minute or two"]
fn both_ways_agree_within_their_claims_for_a_million_random_parameters() {
    assert_eq!(both_ways_agree(1_000_000, 1), 0, "parameters refused");
}

#[test]
fn the_corners_of_the_range_agree_with_the_table() {
    let table = Table::read("extremes.csv");
    let mut worst = Worst::default();
    let mut claims: [Claims; 4] = Default::default();
    for row in &table.rows {
        let of = |name| table.number(row, name);
        let (n, k, q) = (of("n"), of("k"), of("q"));
        let shape = LimitingShape::new(&unit_power_law(n, k), k, 1.0, q).unwrap();
        let c = shape.stick_radius();
        worst.note("c", relative(c, of("c_over_a0")), row);
        worst.note("a∞ - c", relative(shape.slip_width_limit(), of("a_inf_minus_c_over_a0")), row);
        worst.note("a∞ - a0", relative(shape.contact_growth_limit(), of("a_inf_minus_a0_over_a0")), row);
        worst.note("ΔV", relative(shape.wear_volume() / PI, of("dv_over_pi_a0sq_d")), row);
        worst.note("max Δf", relative(shape.wear_depth_max(), of("max_df_over_d")), row);
        let beyond = of("r_max_minus_c_over_a0");
        let depth = shape.wear_depth_at_offset(beyond * (2.0 * of("c_over_a0") + beyond));
        worst.note("Δf where deepest", relative(depth, of("max_df_over_d")), row);

        let stick_logarithm = -(-q).ln_1p() / n;
        let series = HypergeometricLimit::new(n, k, stick_logarithm).unwrap();
        let root = series.growth().unwrap();
        let [increase, width] = widths(root, stick_logarithm);
        claims[0].note(increase, of("a_inf_minus_a0_over_a0"), row);
        claims[1].note(width, of("a_inf_minus_c_over_a0"), row);
        claims[2].note(series.wear_volume(root).unwrap(), of("dv_over_pi_a0sq_d"), row);
        let span = (beyond / of("c_over_a0")).ln_1p();
        claims[3].note(series.wear_depth(span, span - stick_logarithm).unwrap(), of("max_df_over_d"), row);
    }
    for (claim, quantity) in claims.iter().zip(["a∞ - a0", "a∞ - c", "ΔV", "max Δf"]) {
        claim.report(quantity);
    }
    for quantity in ["c", "a∞ - c", "a∞ - a0", "ΔV", "max Δf", "Δf where deepest"] {
        worst.below(quantity, 1e-12);
    }
}
