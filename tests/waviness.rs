//! Paraboloids with waves: hundreds of them within the contact, judged by adaptive quadrature and by finer meshes.

mod support;

use std::f64::consts::PI;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use fretwear::contact::InitialContact;
use fretwear::contact::closed_form::LimitingShape;
use fretwear::contact::half_space::HalfSpace;
use fretwear::contact::indenter::{EquivalentProfile, Indenter, TabulatedProfile};
use fretwear::contact::slip_depth::UnwornSlip;
use fretwear::contact::transforms::Transforms;
use fretwear::data::RunFile;
use fretwear::laws::conditions::Conditions;
use fretwear::laws::friction::Coulomb;
use fretwear::laws::loading::{Amplitude, Duration, Load, Loading};
use fretwear::laws::wear::Archard;
use fretwear::numerics::grid::Clustering;
use fretwear::solver::model::Model;
use support::command::{object, run, text};

const GRADINGS: [f64; 4] = [-0.5, 0.0, 0.5, 0.9];

/// `f = r²/2 + A (1 - cos(2π N r))` with `N` waves within `r = 1` and `(2πN)² A = part`, rows up to `r = 1.5`.
fn wavy(rows: usize, waves: f64, part: f64) -> (Vec<f64>, Vec<f64>) {
    let number = 2.0 * PI * waves;
    let radius: Vec<f64> = (0..rows).map(|i| 1.5 * i as f64 / (rows - 1) as f64).collect();
    let wave = |r: f64| part / (number * number) * (1.0 - (number * r).cos());
    let height = radius.iter().map(|r| 0.5 * r * r + wave(*r)).collect();
    (radius, height)
}

fn table((radius, height): (Vec<f64>, Vec<f64>)) -> Indenter {
    Indenter::from(Arc::new(TabulatedProfile::new("rows", radius, height).unwrap()))
}

fn relative(found: f64, expected: f64) -> f64 {
    let error = (found / expected - 1.0).abs();
    if error.is_nan() { f64::INFINITY } else { error }
}

/// Adaptive quadrature for what begins at `c`. It takes the knots of `g`, rows and the places halfway, for breaks where they are few; where they
/// are many it gets no farther than 1e-10 across them.
fn outside(grading: f64, stick_radius: f64, rows: usize) -> Transforms {
    let knots = (1..2 * rows - 2).map(|i| 0.75 * i as f64 / (rows - 1) as f64);
    let few = rows < 1000;
    let breaks = knots.filter(|x| few && *x > stick_radius && *x < 1.3);
    let breaks: Vec<f64> = breaks.chain([stick_radius]).collect();
    let tolerance = if few { 1e-13 } else { 1e-10 };
    Transforms::new(grading, &breaks).unwrap().with_tolerance(tolerance).unwrap()
}

/// `F(h)` at `r` of what is zero within `c`.
fn carried(transforms: &Transforms, stick_radius: f64, r: f64, beyond: impl Fn(f64) -> f64) -> f64 {
    let density = |x: f64| if x > stick_radius { beyond(x) } else { 0.0 };
    transforms.profile(density, r).unwrap()
}

fn rise(g: &EquivalentProfile, from: f64, to: f64) -> f64 {
    g.rise(from, (to - from) * (to + from))
}

#[test]
fn the_unworn_slip_of_ten_to_a_thousand_waves_is_that_of_adaptive_quadrature() {
    let mut worst = [(0.0, String::new()), (0.0, String::new()), (0.0, String::new())];
    for (rows, waves, part) in [(801, 10.0, 0.4), (8001, 100.0, 0.4), (60_001, 1000.0, 0.4)] {
        let indenter = table(wavy(rows, waves, part));
        for grading in GRADINGS {
            let g = indenter.equivalent_profile(grading).unwrap();
            let c = 0.7;
            let few = usize::from(rows > 1000);
            let slip = UnwornSlip::new(&g, c, rise(&g, c, 1.0), 1.0 - c * c).unwrap();
            let transforms = outside(grading, c, rows);
            for part in [1e-9, 1e-5, 3e-3, 0.1, 0.37, 0.81, 1.0] {
                let z = part * slip.limit_slip_area();
                // From c = 0.7 on, no closer than its rounding allows.
                let exact = |z: f64| carried(&transforms, c, (c * c + z).sqrt(), |x| rise(&g, c, x));
                let found = slip.at(z);
                let place = || format!("{waves} waves, k = {grading}, {part} of the annulus");
                if part > 1e-4 {
                    let error = relative(found.slip, exact(z));
                    if error > worst[few].0 {
                        worst[few] = (error, place());
                    }
                }
                // The slope by differences of the slip itself, a hundredth of a wave apart.
                let step = 2e-3 * c / waves * part.min(1e-2);
                let values = [-2.0, -1.0, 1.0, 2.0].map(|i| slip.at(z + i * step).slip.ln());
                let slope = (values[0] - 8.0 * values[1] + 8.0 * values[2] - values[3]) / (12.0 * step);
                if part > 1e-2 {
                    let error = relative(slip.slopes(&found).log_slip, slope);
                    if error > worst[2].0 {
                        worst[2] = (error, place());
                    }
                }
            }
            // Next to the edge of stick slip is that of a straight g.
            let z = 1e-9 * slip.limit_slip_area();
            let mu = 0.5 * (1.0 - grading);
            let leading = slip.at(z).slip / (g.derivative(c) * 0.5 * c);
            let l = slip.at(z).logarithm;
            let constant = (PI * 0.5 * (1.0 + grading)).sin() / (PI * mu * (1.0 + mu));
            assert!(relative(leading, constant * l.powf(1.0 + mu)) < 1e-5, "{waves} waves, k = {grading}");
        }
    }
    println!("{worst:?}");
    assert!(worst[0].0 < 3e-10 && worst[1].0 < 3e-10 && worst[2].0 < 1e-7, "{worst:?}");
}

#[test]
fn the_limit_of_ten_to_a_thousand_waves_is_that_of_adaptive_quadrature() {
    let mut worst = [(0.0, String::new()), (0.0, String::new()), (0.0, String::new())];
    for (rows, waves, part) in [(801, 10.0, 0.4), (8001, 100.0, 0.4), (60_001, 1000.0, 0.4)] {
        let indenter = table(wavy(rows, waves, part));
        for grading in GRADINGS {
            let g = indenter.equivalent_profile(grading).unwrap();
            for ratio in [0.4, 0.9] {
                let shape = LimitingShape::from_stick_ratio(&indenter, grading, g.value(1.0), ratio).unwrap();
                let c = shape.stick_radius();
                let transforms = outside(grading, c, rows);
                let depth = |r: f64| {
                    let uniform = carried(&transforms, c, r, |_| 1.0);
                    shape.slip_compression() * uniform - carried(&transforms, c, r, |x| rise(&g, c, x))
                };
                let edge = shape.contact_radius_limit();
                let deepest = shape.wear_depth_max();
                let places = [0.02, 0.3, 0.6, 0.95].map(|part| c + part * (edge - c));
                let off = |r: f64| (shape.wear_depth(r) - depth(r)).abs() / deepest;
                let depths = places.map(off).into_iter().fold(0.0, f64::max);
                // No depth at a∞, and none above the largest.
                let at_edge = depth(edge).abs() / deepest;
                let found = relative(depth(shape.wear_depth_max_radius()), deepest);
                let above = (0..4000).map(|i| c + (edge - c) * f64::from(i) / 4000.0);
                let above = above.map(|r| shape.wear_depth(r) / deepest - 1.0).fold(0.0, f64::max);
                for (worst, error) in worst.iter_mut().zip([depths.max(at_edge), found, above]) {
                    if error > worst.0 {
                        *worst = (error, format!("{waves} waves, k = {grading}, c/a0 = {ratio}"));
                    }
                }
            }
        }
    }
    println!("{worst:?}");
    assert!(worst[0].0 < 4e-10 && worst[1].0 < 1e-10 && worst[2].0 < 1e-12, "{worst:?}");
}

#[test]
fn the_worn_volume_of_a_wavy_limit_is_the_sum_of_its_depths() {
    let mut worst = (0.0, String::new());
    for (rows, waves) in [(801, 10.0), (8001, 100.0)] {
        let indenter = table(wavy(rows, waves, 0.4));
        for grading in GRADINGS {
            let depth = indenter.equivalent_profile(grading).unwrap().value(1.0);
            let shape = LimitingShape::from_stick_ratio(&indenter, grading, depth, 0.6).unwrap();
            let (c, edge) = (shape.stick_radius(), shape.contact_radius_limit());
            // Simpson's rule in v with r² - c² = Z v^p, in which the depth, as ℓ^μ at c, is smooth enough.
            let (area, power) = ((edge - c) * (edge + c), 4.0 / (1.0 - grading));
            let cells = 20_000;
            let term = |i: usize| {
                let v = i as f64 / f64::from(cells as u32);
                let weight = if i == 0 || i == cells { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
                weight * power * v.powf(power - 1.0) * shape.wear_depth_at_offset(area * v.powf(power))
            };
            let sum = PI * area * (0..=cells).map(term).sum::<f64>() / (3.0 * cells as f64);
            let error = relative(shape.wear_volume(), sum);
            if error > worst.0 {
                worst = (error, format!("{waves} waves, k = {grading}"));
            }
        }
    }
    println!("{worst:?}");
    assert!(worst.0 < 4e-11, "{worst:?}");
}

#[test]
fn ever_more_rows_give_the_same_limit() {
    let waves = 50.0;
    let limit = |rows: usize, grading: f64| {
        let indenter = table(wavy(rows, waves, 0.4));
        let depth = 1.0 / (1.0 + grading);
        let shape = LimitingShape::from_stick_ratio(&indenter, grading, depth, 0.7).unwrap();
        [shape.contact_radius_limit(), shape.wear_volume(), shape.wear_depth_max()]
    };
    for grading in GRADINGS {
        let found = [1501, 3001, 6001, 24_001].map(|rows| limit(rows, grading));
        let error = |i: usize| (0..3).map(|j| relative(found[i][j], found[3][j])).fold(0.0, f64::max);
        let errors = [error(0), error(1), error(2)];
        println!("k = {grading}: {errors:?}");
        assert!(errors[2] < 1e-8 && errors[0] > 3.0 * errors[2], "k = {grading}: {errors:?}");
    }
}

/// Contact at an indentation at which `a0 = 1`, with a cycle of `τ = 1`.
fn contact(indenter: &Indenter, grading: f64, stick_ratio: f64) -> InitialContact {
    let depth = indenter.equivalent_profile(grading).unwrap().value(1.0);
    let half_space = HalfSpace::from_stiffness(grading, 1.0, 1.0).unwrap();
    let loading = Loading {
        load: Load::Indentation(depth),
        amplitude: Amplitude::StickRatio(stick_ratio),
        duration: Duration::Tau(1.0),
    };
    let wear = Archard { coefficient: 0.25 / depth };
    InitialContact::new(indenter, &half_space, &Coulomb { coefficient: 1.0 }, &wear, &loading).unwrap()
}

#[test]
fn springs_tell_how_much_of_the_waves_they_do_not_see() {
    let waves = 40.0;
    let indenter = table(wavy(4001, waves, 1.0));
    let contact = contact(&indenter, 0.0, 0.7);
    let limit = LimitingShape::from_contact(&contact).unwrap().unwrap();
    // A mesh of straight lines across every wave misses its height.
    let height = 2.0 / (2.0 * PI * waves).powi(2) / limit.wear_depth_max();
    let unseen = [24, 400, 800].map(|springs| {
        Model::new(
            &contact,
            &Conditions::plain(*contact.friction(), *contact.wear()),
            springs,
            Clustering::Smooth,
        )
        .unwrap()
        .unseen_depth()
        .unwrap()
    });
    println!("{height:e} {unseen:?}");
    assert!(unseen[0] > 0.5 * height && unseen[0] < 4.0 * height, "{unseen:?} of {height:e}");
    assert!(unseen[1] < 0.01 * height && unseen[2] < 0.05 * unseen[1], "{unseen:?} of {height:e}");
    let paraboloid = support::Case::new(2.0, 0.0, 0.7, 24).smooth().model();
    assert!(paraboloid.unseen_depth().is_none());
}

/// A scene of millimetres and micrometres: the unit of radii is 0.1 mm, `R = 10 mm`.
fn folder((radius, height): (Vec<f64>, Vec<f64>), loading: &str, rest: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let row = |(r, f): (&f64, &f64)| format!("{:.15e},{:.15e}\n", 0.1 * r, f);
    let rows: String = radius.iter().zip(&height).map(row).collect();
    let scene = format!(
        "[indenter.table]\nfile = \"rows.csv\"\nradius_unit = \"mm\"\nprofile_unit = \"um\"\n[half_space]\ngrading = 0.0\n\
         normal_stiffness = 1e11\n[friction.coulomb]\ncoefficient = 0.6\n[wear.archard]\ncoefficient = 1e-12\n[loading]\n{loading}\n{rest}\n"
    );
    fs::write(folder.path().join("rows.csv"), rows).expect("the rows");
    fs::write(folder.path().join("scene.toml"), scene).expect("the scene");
    folder
}

fn result(folder: &Path) -> (serde_json::Value, RunFile) {
    let json = object(folder, &["run", "scene.toml", "--json"]);
    (json, RunFile::open(&folder.join("scene.h5")).unwrap())
}

#[test]
fn a_run_of_thirty_waves_is_that_of_a_finer_mesh_and_ends_in_the_closed_form() {
    let rest = |numerics: &str| format!("[numerics]\n{numerics}\n[output]\nat_tau = [0.3, 3, 30, 200]");
    let loading = "indentation = \"1 um\"\nstick_ratio = 0.7\ntau = 200";
    let of = |numerics: &str| {
        let folder = folder(wavy(6001, 30.0, 0.8), loading, &rest(numerics));
        result(folder.path())
    };
    let [(fine_json, fine), (_, coarse), (chosen_json, chosen)] =
        [of("springs = 500\ntolerance = 1e-6"), of("springs = 250\ntolerance = 1e-6"), of("accuracy = 1e-4")];
    let limit = fine_json["wear_volume_limit"].as_f64().unwrap();
    let distance = |other: &RunFile| {
        let pairs = fine.snapshots.iter().zip(&other.snapshots).skip(1);
        pairs.map(|(a, b)| (a.wear_volume - b.wear_volume).abs() / limit).fold(0.0, f64::max)
    };
    let found = [distance(&coarse), distance(&chosen)];
    let end = fine_json["limit_distance_relative"].as_f64().unwrap();
    let volume = relative(fine_json["wear_volume"].as_f64().unwrap(), limit);
    println!("{found:?} {end:e} {volume:e}");
    assert_eq!(fine.snapshots.len(), 5);
    assert!(found[0] < 2e-7 && found[1] < 1e-4, "{found:?}");
    assert!(end < 8e-10 && volume < 1e-9, "{end:e} {volume:e}");
    let estimate = chosen_json["error_estimate"].as_f64().unwrap();
    assert!(estimate < 1e-4 && estimate > 0.3 * found[1], "{estimate:e} {found:?}");
}

#[test]
fn few_springs_on_many_waves_own_up_to_it() {
    let loading = "indentation = \"1 um\"\nstick_ratio = 0.7\ntau = 3";
    let of = |springs: usize| {
        let folder = folder(wavy(6001, 30.0, 1.0), loading, &format!("[numerics]\nsprings = {springs}"));
        object(folder.path(), &["run", "scene.toml", "--json"])["error_estimate"].as_f64().unwrap()
    };
    let estimates = [of(20), of(400)];
    println!("{estimates:?}");
    // The height of the waves is 4e-4 of the largest depth.
    assert!(estimates[0] > 2e-4 && estimates[1] < 1e-5, "{estimates:?}");
}

/// Waves that are too high between two radii only.
fn windowed(part: f64, from: f64, to: f64) -> (Vec<f64>, Vec<f64>) {
    let (radius, plain) = wavy(2001, 50.0, 0.0);
    let (_, waves) = wavy(2001, 50.0, part);
    let window =
        |r: f64| if r > from && r < to { (PI * (r - from) / (to - from)).sin().powi(2) } else { 0.0 };
    let height = (0..radius.len()).map(|i| plain[i] + window(radius[i]) * (waves[i] - plain[i])).collect();
    (radius, height)
}

#[test]
fn waves_that_are_too_high_are_refused_by_check_and_run_wherever_they_are() {
    let loading = "indentation = \"1 um\"\nstick_ratio = 0.7\ntau = 1";
    let springs = "[numerics]\nsprings = 60";
    // a0 = 1, a∞ = 1.143; waves far outside touch nothing.
    for (part, from, to, key) in [
        (60.0, 0.3, 0.6, Some("loading.indentation: ")),
        (60.0, 0.75, 0.95, Some("loading.indentation: ")),
        (60.0, 1.02, 1.12, Some("indenter.table: ")),
        (-10_000.0, 1.16, 1.3, Some("indenter.table: ")),
        (5.0, 0.3, 0.6, None),
        (5.0, 0.75, 0.95, None),
        (5.0, 1.02, 1.12, None),
        (60.0, 1.3, 1.45, None),
    ] {
        let folder = folder(windowed(part, from, to), loading, springs);
        for command in ["check", "run", "limit"] {
            let output = run(folder.path(), &[command, "scene.toml"]);
            let message = text(&output.stderr);
            let place = format!("{command}, part {part} from {from} to {to}: {message}");
            let Some(key) = key else {
                assert_eq!(output.status.code(), Some(0), "{place}");
                continue;
            };
            assert_eq!(output.status.code(), Some(2), "{place}");
            for words in [key, "would split into rings", "smooth it", "press less deep"] {
                assert!(message.contains(words), "{words:?} not in {place}");
            }
        }
    }
}

#[test]
fn a_contact_under_a_held_force_is_refused_too_where_it_would_touch_farther_out() {
    let loading = "normal_force = \"13.3 N\"\nstick_ratio = 0.7\ntau = 1";
    for (part, code) in [(-20_000.0, 2), (-20.0, 0)] {
        let folder = folder(windowed(part, 1.3, 1.45), loading, "[numerics]\nsprings = 40");
        for command in ["check", "run"] {
            let output = run(folder.path(), &[command, "scene.toml"]);
            let message = text(&output.stderr);
            assert_eq!(output.status.code(), Some(code), "{command}, part {part}: {message}");
            let refused = message.contains("indenter.table: ") && message.contains("touch");
            assert_eq!(refused, code == 2, "{command}, part {part}: {message}");
        }
    }
}

#[test]
fn a_wave_with_a_flat_spot_is_still_a_contact() {
    // The highest waves whose g does not fall, to the last digits: there g has a flat spot.
    let reaches =
        |part: f64| table(wavy(3001, 3.0, part)).equivalent_profile(0.0).unwrap().largest_radius() > 1.49;
    let (mut low, mut high) = (0.5, 4.0);
    assert!(reaches(low) && !reaches(high));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if reaches(middle) { low = middle } else { high = middle }
    }
    let limit = |part: f64, ratio: f64| {
        let indenter = table(wavy(3001, 3.0, part));
        let depth = indenter.equivalent_profile(0.0).unwrap().value(1.0);
        LimitingShape::from_stick_ratio(&indenter, 0.0, depth, ratio).unwrap()
    };
    let g = table(wavy(3001, 3.0, low)).equivalent_profile(0.0).unwrap();
    let places = (1..3000).map(|i| 0.0005 * f64::from(i));
    let flat = places.map(|x| (x, g.derivative(x) / x)).min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    println!("{low} {flat:?}");
    assert!(flat.1 < 2e-3, "{flat:?}");
    for ratio in [flat.0, 0.5 * flat.0, 0.9] {
        let (found, near) = (limit(low, ratio), limit(low * (1.0 - 1e-7), ratio));
        let errors = [
            relative(found.wear_volume(), near.wear_volume()),
            relative(found.contact_radius_limit(), near.contact_radius_limit()),
        ];
        assert!(errors.iter().all(|error| *error < 1e-6), "c/a0 = {ratio}: {errors:?}");
        let contact = contact(&table(wavy(3001, 3.0, low)), 0.0, ratio);
        let model = Model::new(
            &contact,
            &Conditions::plain(*contact.friction(), *contact.wear()),
            200,
            Clustering::Smooth,
        )
        .unwrap();
        let state = model.initial_state().unwrap();
        let edge = relative(state.slip_area, contact.slip_area_offset());
        assert!(edge < 1e-4, "c/a0 = {ratio}: {edge:e}");
        assert!(relative(model.limit_volume(), found.wear_volume()) < 1e-4, "c/a0 = {ratio}");
    }
}
