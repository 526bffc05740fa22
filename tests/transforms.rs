//! The transforms of any profile against tables of 17 digits (`data/reference/transforms.csv`), against themselves, and against the limit.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use fretwear::contact::closed_form::LimitingShape;
use fretwear::contact::indenter::Indenter;
use fretwear::contact::transforms::Transforms;

/// A profile with its first two derivatives, and the radii at which it has kinks.
struct Shape {
    profile: Box<dyn Fn(f64) -> f64>,
    slope: Box<dyn Fn(f64) -> f64>,
    curvature: Box<dyn Fn(f64) -> f64>,
    breaks: Vec<f64>,
    /// Those with closed forms.
    indenter: Option<Indenter>,
}

impl Shape {
    /// By the name in the table.
    fn named(name: &str) -> Self {
        let smooth = |profile: fn(f64) -> f64, slope: fn(f64) -> f64, curvature: fn(f64) -> f64| Self {
            profile: Box::new(profile),
            slope: Box::new(slope),
            curvature: Box::new(curvature),
            breaks: vec![],
            indenter: None,
        };
        match name {
            "1-exp(-r^2)" => smooth(
                |r| -(-r * r).exp_m1(),
                |r| 2.0 * r * (-r * r).exp(),
                |r| (2.0 - 4.0 * r * r) * (-r * r).exp(),
            ),
            "r^2+r^4" => smooth(|r| r * r + r.powi(4), |r| 2.0 * r + 4.0 * r.powi(3), |r| 2.0 + 12.0 * r * r),
            "trunc_cone_b=0.25" => Self {
                breaks: vec![0.25],
                ..smooth(|r| (r - 0.25).max(0.0), |r| f64::from(u8::from(r > 0.25)), |_| 0.0)
            },
            "sphere_R=1.5" => Self {
                indenter: Some(Indenter::sphere(1.5).unwrap()),
                ..smooth(
                    |r| r * r / (1.5 + (2.25 - r * r).sqrt()),
                    |r| r / (2.25 - r * r).sqrt(),
                    |r| 2.25 / (2.25 - r * r).powf(1.5),
                )
            },
            _ => {
                let n: f64 =
                    name.strip_prefix("power_n=").unwrap().split('_').next().unwrap().parse().unwrap();
                let coefficient = if name.ends_with("A=0.5") { 0.5 } else { 1.0 };
                Self {
                    profile: Box::new(move |r| coefficient * r.powf(n)),
                    slope: Box::new(move |r| coefficient * n * r.powf(n - 1.0)),
                    curvature: Box::new(move |r| coefficient * n * (n - 1.0) * r.powf(n - 2.0)),
                    breaks: vec![],
                    indenter: Some(Indenter::power_law(coefficient, n).unwrap()),
                }
            }
        }
    }

    fn transforms(&self, grading: f64) -> Transforms {
        Transforms::new(grading, &self.breaks).unwrap()
    }

    fn equivalent(&self, transforms: &Transforms, x: f64) -> f64 {
        transforms.equivalent_profile(&self.slope, x).unwrap_or(f64::NAN)
    }

    fn equivalent_slope(&self, transforms: &Transforms, x: f64) -> f64 {
        transforms.equivalent_slope(&self.slope, &self.curvature, x).unwrap_or(f64::NAN)
    }

    /// Slope of the equivalent profile up to `a`: the closed form, or an interpolant of its smooth factor for the sake of speed.
    fn fast_slope(&self, transforms: &Transforms, a: f64) -> Box<dyn Fn(f64) -> f64> {
        if let Some(indenter) = &self.indenter {
            let profile = indenter.equivalent_profile(transforms.grading()).unwrap();
            return Box::new(move |x| profile.derivative(x));
        }
        // Without kinks g'/x is even and analytic; above the kink of a truncated cone g' (x-b)^μ is.
        let start = self.breaks.first().copied().unwrap_or(0.0);
        let power = if start > 0.0 { 0.5 * (1.0 - transforms.grading()) } else { -1.0 };
        let nodes: Vec<(f64, f64)> = (0..INTERPOLATION)
            .map(|i| {
                let angle = PI * (i as f64 + 0.5) / INTERPOLATION as f64;
                let x = start + (a - start) * (0.5 * angle).sin().powi(2);
                (
                    x,
                    self.equivalent_slope(transforms, x)
                        * (x - start).powf(power)
                        * (-1f64).powi(i as i32)
                        * angle.sin(),
                )
            })
            .collect();
        Box::new(move |x| {
            if x <= start {
                return 0.0;
            }
            let (mut numerator, mut denominator) = (0.0, 0.0);
            for (i, &(node, value)) in nodes.iter().enumerate() {
                let angle = PI * (i as f64 + 0.5) / INTERPOLATION as f64;
                let difference = if x == node { f64::MIN_POSITIVE } else { x - node };
                numerator += value / difference;
                denominator += (-1f64).powi(i as i32) * angle.sin() / difference;
            }
            numerator / denominator * (x - start).powf(-power)
        })
    }
}

/// Chebyshev nodes of the interpolated slopes.
const INTERPOLATION: usize = 30;

/// Rows of the table: shape, then k, x, f, g, a, d, p/c_N, F_N/c_N and the load of Eq. (21) as printed.
fn rows() -> Vec<(String, [f64; 9])> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("data/reference/transforms.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let row = |line: &str| {
        let mut fields = line.split(',');
        let name = fields.next().unwrap().to_owned();
        let numbers: Vec<f64> = fields.map(|field| field.parse().unwrap()).collect();
        (name, numbers[..9].try_into().unwrap())
    };
    text.lines().skip(1).map(row).collect()
}

fn relative(found: f64, expected: f64) -> f64 {
    if found == expected { 0.0 } else { (found / expected - 1.0).abs() }
}

/// Largest error by shape and quantity; NaN counts as infinite.
#[derive(Default)]
struct Worst(BTreeMap<(String, &'static str), (f64, String)>);

impl Worst {
    fn note(&mut self, shape: &str, quantity: &'static str, error: f64, place: String) {
        let error = if error.is_nan() { f64::INFINITY } else { error };
        let entry = self.0.entry((shape.to_owned(), quantity)).or_insert((0.0, String::new()));
        if error >= entry.0 {
            *entry = (error, place);
        }
    }

    fn below(&self, tolerance: f64) {
        for ((shape, quantity), (error, place)) in &self.0 {
            println!("{shape:18} {quantity:30} {error:.1e} at {place}");
        }
        let wrong: Vec<_> = self.0.iter().filter(|(_, (error, _))| *error > tolerance).collect();
        assert!(wrong.is_empty(), "above {tolerance:e}: {wrong:?}");
    }
}

#[test]
fn equivalent_profiles_of_any_shape_agree_with_the_table() {
    let mut worst = Worst::default();
    for (name, [k, x, f, g, a, d, ..]) in rows() {
        let shape = Shape::named(&name);
        let transforms = shape.transforms(k);
        let place = format!("k = {k}, x = {x}");
        worst.note(&name, "f", relative((shape.profile)(x), f), place.clone());
        worst.note(&name, "g", relative(shape.equivalent(&transforms, x), g), place.clone());
        worst.note(&name, "d", relative(shape.equivalent(&transforms, a), d), place.clone());
        if let Some(indenter) = &shape.indenter {
            let exact = indenter.equivalent_profile(k).unwrap().derivative(x);
            worst.note(&name, "g'", relative(shape.equivalent_slope(&transforms, x), exact), place);
        }
    }
    worst.below(1e-12);
}

#[test]
fn profiles_from_equivalent_profiles_agree_with_the_table() {
    let mut worst = Worst::default();
    for (name, [k, x, f, ..]) in rows() {
        let shape = Shape::named(&name);
        let transforms = shape.transforms(k);
        let place = format!("k = {k}, x = {x}");
        // There and back again: the equivalent profile by the forward transform. At a tip that is dear, and the closed form does.
        let tip = name == "power_n=0.5";
        if !tip {
            let found = transforms.profile(|x| shape.equivalent(&transforms, x), x).unwrap_or(f64::NAN);
            worst.note(&name, "f from g by Eq. (19)", relative(found, f), place.clone());
        }
        if let Some(indenter) = &shape.indenter {
            let profile = indenter.equivalent_profile(k).unwrap();
            let found = transforms.profile(|x| profile.value(x), x).unwrap_or(f64::NAN);
            worst.note(&name, "f from the closed form of g", relative(found, f), place);
        }
    }
    worst.below(1e-12);
}

#[test]
fn pressures_agree_with_the_table() {
    let mut worst = Worst::default();
    for (name, [k, x, _, _, a, _, pressure, ..]) in rows() {
        let shape = Shape::named(&name);
        let transforms = shape.transforms(k);
        let place = format!("k = {k}, x = {x}");
        let slope = |x: f64| shape.equivalent_slope(&transforms, x);
        let found = match &shape.indenter {
            Some(_) => transforms.pressure(shape.fast_slope(&transforms, a), x, a),
            None => transforms.pressure(slope, x, a),
        };
        let found = found.unwrap_or(f64::NAN);
        worst.note(&name, "p/c_N", relative(found, pressure), place);
    }
    worst.below(1e-12);
}

#[test]
fn normal_forces_agree_with_the_table() {
    let mut worst = Worst::default();
    for (name, [k, _, _, _, a, d, _, load, _]) in rows() {
        let shape = Shape::named(&name);
        let transforms = shape.transforms(k);
        let found = match &shape.indenter {
            Some(indenter) => {
                let profile = indenter.equivalent_profile(k).unwrap();
                transforms.load(|x| profile.value(x), d, a)
            }
            None => transforms.load(|x| shape.equivalent(&transforms, x), d, a),
        };
        worst.note(&name, "F_N/c_N", relative(found.unwrap_or(f64::NAN), load), format!("k = {k}"));
    }
    worst.below(1e-12);
}

#[test]
fn pressures_add_up_to_the_normal_force_and_with_the_printed_factor_they_do_not() {
    let mut worst = Worst::default();
    let (mut seen, mut apart) = (vec![], 0);
    for (name, [k, _, _, _, a, _, _, load, printed]) in rows() {
        if seen.contains(&(name.clone(), k.to_bits())) {
            continue;
        }
        seen.push((name.clone(), k.to_bits()));
        let shape = Shape::named(&name);
        let transforms = shape.transforms(k);
        let slope = shape.fast_slope(&transforms, a);
        let misprinted = |x: f64| x.powf(k) * slope(x);
        // Without grading the factor is one.
        assert!(k == 0.0 || relative(printed, load) > 1e-3, "{name}, k = {k}: {printed} and {load}");
        apart += u32::from(k != 0.0);
        let place = format!("k = {k}");
        // Right above a kink the slope of g is steep, and the rounding of the radii is what would be seen.
        if shape.breaks.is_empty() {
            let sum = |slope: &dyn Fn(f64) -> f64| {
                let pressure = |r: f64| transforms.pressure(slope, r, a).unwrap_or(f64::NAN);
                transforms.pressure_sum(pressure, a).unwrap_or(f64::NAN)
            };
            worst.note(&name, "2π∫p r dr", relative(sum(&slope), load), place.clone());
            if k > -0.9 {
                worst.note(&name, "the same, as printed", relative(sum(&misprinted), printed), place);
                continue;
            }
        }
        // The same sum with the order of the integrals exchanged, ∫_0^x r (x²-r²)^(-μ) dr = x^(1+k)/(1+k): the pressure at r = 0 of another g'.
        let exchanged = |slope: &dyn Fn(f64) -> f64| {
            transforms.pressure(|x| slope(x) * x * x * 2.0 * PI / (1.0 + k), 0.0, a)
        };
        let sum = exchanged(&slope).unwrap_or(f64::NAN);
        worst.note(&name, "2π∫p r dr, exchanged", relative(sum, load), place.clone());
        match exchanged(&misprinted) {
            Ok(found) => worst.note(&name, "as printed, exchanged", relative(found, printed), place),
            Err(error) => assert!(printed.is_infinite(), "{name}, k = {k}: {error}"),
        }
    }
    println!("{} cases, {apart} of them with another load by the printed equation", seen.len());
    worst.below(1e-12);
}

#[test]
fn the_pressure_under_a_kink_adds_up_as_well_as_the_rounding_of_radii_allows() {
    let shape = Shape::named("trunc_cone_b=0.25");
    for k in [-0.2, 0.0, 0.5, 0.9] {
        let exact = shape.transforms(k);
        let slope = shape.fast_slope(&exact, 1.0);
        let [inner, outer] = [1e-8, 1e-7].map(|tolerance| exact.clone().with_tolerance(tolerance).unwrap());
        let pressure = |r: f64| inner.pressure(&slope, r, 1.0).unwrap_or(f64::NAN);
        let load = exact.load(|x| shape.equivalent(&exact, x), shape.equivalent(&exact, 1.0), 1.0).unwrap();
        let sum = outer.pressure_sum(pressure, 1.0).unwrap_or(f64::NAN);
        println!("k = {k}: {:e}", relative(sum, load));
        assert!(relative(sum, load) < 1e-7, "k = {k}: {sum} and {load}");
    }
    assert!(exact_is_refused(1.0) && exact_is_refused(f64::NAN));
}

fn exact_is_refused(tolerance: f64) -> bool {
    Transforms::new(0.0, &[]).unwrap().with_tolerance(tolerance).is_err()
}

#[test]
fn profiles_go_there_and_back_for_gradings_next_to_the_ends() {
    let mut worst = Worst::default();
    for k in [-0.9999, -0.99, 0.99, 0.999, 0.9999] {
        for name in ["power_n=1", "power_n=4", "1-exp(-r^2)", "trunc_cone_b=0.25", "sphere_R=1.5"] {
            let shape = Shape::named(name);
            let transforms = shape.transforms(k);
            for r in [1e-3, 0.26, 0.7, 1.3] {
                let found = transforms.profile(|x| shape.equivalent(&transforms, x), r).unwrap_or(f64::NAN);
                let error = relative(found, (shape.profile)(r));
                worst.note(name, "there and back", error, format!("k = {k}, r = {r}"));
            }
        }
    }
    worst.below(1e-12);
}

#[test]
fn power_laws_of_any_exponent_and_grading_agree_with_their_closed_forms() {
    let mut worst = Worst::default();
    let (mut refused, mut count) = (0, 0);
    for n in [0.1, 0.13, 0.3, 0.7, 1.0, 2.3, 5.0, 11.0, 20.0] {
        for k in [-0.9999, -0.997, -0.8, -0.3, 0.0, 0.3, 0.8, 0.997, 0.9999] {
            let transforms = Transforms::new(k, &[]).unwrap();
            let indenter = Indenter::power_law(1.0, n).unwrap();
            let profile = indenter.equivalent_profile(k).unwrap();
            // Micrometres to kilometres.
            for r in [1e-6, 0.3, 1e3] {
                let pairs = [
                    (
                        "g",
                        transforms.equivalent_profile(|r| indenter.profile_derivative(r), r),
                        profile.value(r),
                    ),
                    ("f", transforms.profile(|x| profile.value(x), r), indenter.profile(r)),
                    (
                        "F_N/c_N",
                        transforms.load(|x| profile.value(x), profile.value(r), r),
                        profile.load_integral(r),
                    ),
                ];
                for (quantity, found, expected) in pairs {
                    count += 1;
                    match found {
                        Ok(found) => worst.note(
                            "power laws",
                            quantity,
                            relative(found, expected),
                            format!("n = {n}, k = {k}, r = {r}"),
                        ),
                        Err(error) => {
                            println!("n = {n}, k = {k}, r = {r}, {quantity}: {error}");
                            refused += 1;
                        }
                    }
                }
            }
        }
    }
    println!("{refused} of {count} refused");
    worst.below(1e-12);
    assert_eq!(refused, 0);
}

#[test]
fn pressures_tend_to_local_ones_at_both_ends_of_the_gradings() {
    // k → 1: p → (c_N/π)(d - f).  k → -1: the kernel ν (x²-r²)^(ν-1) 2r becomes a delta function, p → (c_N/π) g'(r)/(2rν).
    let (paraboloid, a) = (Indenter::paraboloid(1.0).unwrap(), 1.2);
    for r in [0.1, 0.6, 1.1] {
        let error = |k: f64| {
            let transforms = Transforms::new(k, &[]).unwrap();
            let profile = paraboloid.equivalent_profile(k).unwrap();
            let found = transforms.pressure(|x| profile.derivative(x), r, a).unwrap();
            let local = match k > 0.0 {
                true => (profile.value(a) - paraboloid.profile(r)) / PI,
                false => profile.derivative(r) / (r * (1.0 + k)) / PI,
            };
            relative(found, local)
        };
        for (coarse, fine) in [(0.999, 0.9999), (-0.999, -0.9999)] {
            let order = (error(coarse) / error(fine)).log10();
            assert!((order - 1.0).abs() < 0.01, "k = {fine}, r = {r}: order {order}, {:e}", error(fine));
        }
    }
}

#[test]
fn the_worn_profile_is_the_transform_of_its_jumping_equivalent() {
    let mut worst = Worst::default();
    for (n, k, ratio) in
        [(2.0, 0.0, 0.7), (2.0, 0.5, 0.3), (1.0, -0.5, 0.5), (4.0, -0.9, 0.9), (2.0, 0.99, 0.5)]
    {
        let indenter = Indenter::power_law(1.0, n).unwrap();
        let shape = LimitingShape::from_stick_ratio(&indenter, k, 1.0, ratio).unwrap();
        let (c, limit) = (shape.stick_radius(), shape.contact_radius_limit());
        let transforms = Transforms::new(k, &[c]).unwrap();
        let equivalent = |x: f64| shape.equivalent_profile(x).unwrap_or(f64::NAN);
        let place = format!("n = {n}, k = {k}, c/a0 = {ratio}");
        for part in [0.1, 0.5, 0.9] {
            let r = c + part * (limit - c);
            let found = transforms.profile(equivalent, r).unwrap_or(f64::NAN);
            worst.note("worn", "f∞ by Eq. (20)", relative(found, shape.profile(r)), place.clone());
        }
        // The jump of g at c carries load: the worn annulus itself carries none.
        let unworn = indenter.equivalent_profile(k).unwrap();
        let inside = Transforms::new(k, &[]).unwrap();
        let jump = 2.0 * shape.slip_compression() * c.powf(1.0 + k) / (1.0 + k);
        let pressure = |r: f64| inside.pressure(|x| unworn.derivative(x), r, c).unwrap_or(f64::NAN);
        if k > -0.5 {
            let load = unworn.load_integral(shape.contact_radius_initial()) * shape.load_fraction();
            let by_springs = transforms.load(equivalent, 1.0, limit).unwrap_or(f64::NAN);
            worst.note("worn", "load by Eq. (22)", relative(by_springs, load), place.clone());
            let sum = jump + inside.pressure_sum(pressure, c).unwrap_or(f64::NAN);
            worst.note("worn", "2π∫p r dr", relative(sum, load), place);
        }
    }
    worst.below(1e-12);
}

#[test]
fn what_cannot_be_reached_is_refused_with_its_numbers() {
    let transforms = Transforms::new(-0.5, &[0.25]).unwrap();
    let shape = Shape::named("trunc_cone_b=0.25");
    // The pressure at a kink.
    let message =
        transforms.pressure(|x| shape.equivalent_slope(&transforms, x), 0.25, 1.0).unwrap_err().to_string();
    assert!(message.contains("did not converge") && message.contains("panels"), "{message}");
    assert!(transforms.equivalent_slope(&shape.slope, &shape.curvature, 0.25).is_err());
    assert!(transforms.equivalent_profile(|_| f64::NAN, 1.0).is_err());
    // A kink that was not named is found, at a price, or refused.
    let unaware = Transforms::new(-0.5, &[]).unwrap();
    for x in [0.26, 0.3, 0.9, 1.1] {
        if let Ok(found) = unaware.equivalent_profile(&shape.slope, x) {
            let expected = shape.equivalent(&transforms, x);
            assert!(relative(found, expected) < 1e-12, "x = {x}: {found} and {expected}");
        }
    }
    for (result, name) in [
        (Transforms::new(1.0, &[]), "half_space.grading"),
        (Transforms::new(0.0, &[-1.0]), "break of the profile"),
    ] {
        assert!(result.unwrap_err().to_string().starts_with(name));
    }
    assert!(transforms.load(|x| x, 1.0, f64::NAN).is_err());
    assert_eq!(transforms.pressure(|_| 1.0, 2.0, 1.0).unwrap(), 0.0);
    assert_eq!(transforms.profile(|x| x, 0.0).unwrap(), 0.0);
}
