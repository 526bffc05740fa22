//! Wear maps, the optimal grading and worn profiles against tables of 17 digits (`data/reference`) and figures known by hand.

mod support;

use std::f64::consts::PI;

use fretwear::contact::closed_form::{
    LimitingShape, PowerLawVolume, gibson_wear_volume, similar_stiffness_ratio,
};
use fretwear::contact::half_space::Poisson;
use fretwear::contact::indenter::{Indenter, power_law_factor};
use fretwear::scene::MapScene;
use fretwear::study::wear_map::{Control, End, Medium, OptimumCurve, Thresholds, WearMap, WornProfiles};
use support::reference::{Table, Worst, relative};

fn similar(exponent: f64) -> Medium {
    Medium::new(exponent, Poisson::Similar).unwrap()
}

#[test]
fn the_exact_map_agrees_with_the_table() {
    let table = Table::read("figure2a.csv");
    let mut worst = Worst::default();
    let mut sliding = 0;
    for row in &table.rows {
        let of = |name| table.number(row, name);
        let map = WearMap::new(&similar(2.0), &[of("k")], &[of("ubar")]).unwrap();
        if of("dv_ratio").is_nan() {
            sliding += 1;
            assert!(map.volume[0].is_nan() && of("ubar") >= map.full_sliding[0], "{row:?}");
            continue;
        }
        worst.note("ΔV", relative(PI * map.volume[0], of("dv_over_rdd")), row);
        worst.note("ratio", relative(map.ratio[0], of("dv_ratio")), row);
        worst.note("M ubar", relative(of("ubar") / map.full_sliding[0], of("u_over_umax")), row);
    }
    assert!(table.rows.len() - sliding > 300, "{sliding} rows of full sliding");
    for (quantity, tolerance) in [("ΔV", 1e-13), ("ratio", 1e-13), ("M ubar", 2e-15)] {
        worst.below(quantity, tolerance);
    }
}

#[test]
fn the_small_amplitude_maps_agree_with_the_table() {
    let table = Table::read("figure2b.csv");
    let mut worst = Worst::default();
    for row in &table.rows {
        let of = |name| table.number(row, name);
        if of("dv_eq15_ratio").is_nan() {
            continue;
        }
        let map = WearMap::new(&similar(2.0), &[of("k")], &[of("ubar")]).unwrap();
        worst.note("leading", relative(map.leading_order_ratio[0], of("dv_leading_ratio")), row);
        worst.note("Eq 15", relative(map.small_amplitude_ratio[0], of("dv_eq15_ratio")), row);
    }
    for (quantity, tolerance) in [("leading", 1e-14), ("Eq 15", 1e-13)] {
        worst.below(quantity, tolerance);
    }
}

#[test]
fn optimal_gradings_agree_with_the_table() {
    let table = Table::read("optimum.csv");
    let mut worst = Worst::default();
    for row in &table.rows {
        let of = |name| table.number(row, name);
        let control = match table.text(row, "control") {
            "d" => Control::Indentation,
            "FA" => Control::ForceDepthOnly { reference_depth: of("zeta_z0_over_ahom") },
            _ => Control::Force { reference_depth: of("zeta_z0_over_ahom") },
        };
        let curve = OptimumCurve::new(&similar(of("n")), control, &[of("ubar_hom")]).unwrap();
        let found = curve.points[0];
        let (end, kind) = match table.text(row, "minimum") {
            "interior" => (End::Interior, "interior"),
            "k->1" => (End::One, "limit"),
            _ => (End::MinusOne, "none"),
        };
        assert_eq!(found.end, end, "{row:?}: {found:?}");
        if end == End::MinusOne {
            assert!(found.volume_ratio.is_nan());
            continue;
        }
        worst.note(kind, (found.grading - of("k_opt")).abs(), row);
        worst.note("ratio", relative(found.volume_ratio, of("dv_ratio_opt")), row);
        worst.note("indentation", relative(found.indentation_ratio, of("d_ratio_at_opt")), row);
    }
    for (quantity, tolerance) in
        [("interior", 1e-10), ("limit", 0.0), ("ratio", 1e-13), ("indentation", 1e-10)]
    {
        worst.below(quantity, tolerance);
    }
}

#[test]
fn the_comparison_turns_at_the_amplitudes_known() {
    // Paraboloid, cone and n = 4: from 40-digit arithmetic.
    for (exponent, crossing) in [(2.0, 0.067669488934835), (1.0, 0.074849), (4.0, 0.068404)] {
        let found = Thresholds::new(&similar(exponent)).unwrap();
        let crosses = found.optimum_crosses_zero.unwrap();
        let tolerance = if exponent == 2.0 { 1e-11 } else { 1e-5 };
        assert!(relative(crosses, crossing) < tolerance, "n = {exponent}: {crosses}");
        if exponent == 2.0 {
            let beats = found.limit_beats_homogeneous.unwrap();
            assert!((beats - 0.26290922).abs() < 5e-9, "{beats}");
            let best = found.limit_is_best.unwrap();
            assert!((best - 0.776).abs() < 5e-4, "{best}");
            // just below it the optimum is inside, just above it is not
            let ends =
                OptimumCurve::new(&similar(2.0), Control::Indentation, &[best * 0.9999, best * 1.0001])
                    .unwrap();
            assert_eq!([End::Interior, End::One], [0, 1].map(|i| ends.points[i].end), "{ends:?}");
        }
    }
}

#[test]
fn one_volume_is_that_of_the_limiting_shape_for_every_exponent() {
    let mut worst = (0.0, String::new());
    for exponent in [0.1, 0.5, 1.0, 2.0, 5.0, 20.0] {
        for grading in [-0.9999, -0.5, 0.0, 0.7, 0.9999] {
            let volume = PowerLawVolume::new(exponent, grading).unwrap();
            let indenter = Indenter::power_law(1.0 / power_law_factor(exponent, grading), exponent).unwrap();
            for compression in [1e-10, 1e-3, 0.3, 0.9, 1.0 - 1e-6, 1.0 - 1e-10] {
                let shape = LimitingShape::new(&indenter, grading, 1.0, compression).unwrap();
                let error = relative(volume.at(compression).unwrap() * PI, shape.wear_volume());
                if error > worst.0 {
                    worst = (error, format!("n = {exponent}, k = {grading}, q_c/d = {compression}"));
                }
            }
        }
    }
    println!("{worst:?}");
    assert!(worst.0 < 1e-13, "{worst:?}");
}

#[test]
fn the_limit_of_large_grading_is_approached_in_proportion_to_one_minus_k() {
    for exponent in [0.3, 1.0, 2.0, 7.0] {
        for compression in [1e-6, 0.2, 0.5, 0.8, 0.999] {
            let limit = gibson_wear_volume(exponent, compression);
            let gap = |grading: f64| {
                relative(PowerLawVolume::new(exponent, grading).unwrap().at(compression).unwrap(), limit)
            };
            let order = (gap(0.999) / gap(0.9999)).log10();
            assert!((order - 1.0).abs() < 0.02, "n = {exponent}, q_c/d = {compression}: order {order}");
        }
    }
}

#[test]
fn both_forms_of_the_limit_of_large_grading_join() {
    // The series below and the difference above |1 - 2/n| q = 1/2 differ by the rounding of the difference only.
    for exponent in [0.1, 0.5, 2.0, 20.0] {
        let join = 0.5 / f64::max(1.0, f64::abs(1.0 - 2.0 / exponent));
        let [below, above] = [-1e-9, 1e-9].map(|side| gibson_wear_volume(exponent, join * (1.0 + side)));
        let c = (1.0 - join).powf(1.0 / exponent);
        // dV/dq = 2 q c²/(n (1-q))
        let rise = 2e-9 * join * 2.0 * join * c * c / (exponent * (1.0 - join));
        assert!((above - below - rise).abs() < 1e-13 * below, "n = {exponent}: {below} {above} {rise:e}");
    }
}

#[test]
fn profiles_of_figure_1_exist_where_something_sticks() {
    let gradings = [-0.5858, -0.5857, 0.0, 0.5];
    let profiles = WornProfiles::new(&similar(2.0), &gradings, 0.5, 101).unwrap();
    assert!(profiles.stick_radius[0].is_nan() && profiles.wear_depth[50].is_nan());
    assert!(profiles.stick_radius[1] > 0.0, "-2 + √2 = -0.58579 is where sliding begins");
    for (i, &grading) in gradings.iter().enumerate().skip(1) {
        let compression = similar_stiffness_ratio(grading) * 0.5;
        let paraboloid = Indenter::paraboloid(1.0).unwrap();
        let shape = LimitingShape::new(&paraboloid, grading, 1.0, compression).unwrap();
        assert!(relative(profiles.contact_radius_limit[i], shape.contact_radius_limit()) < 1e-14);
        for (j, &r) in profiles.radii.iter().enumerate() {
            let difference = profiles.wear_depth[i * profiles.radii.len() + j] - shape.wear_depth(r);
            assert!(difference.abs() < 1e-13 * shape.wear_depth_max(), "k = {grading}, r = {r}");
        }
    }
}

#[test]
fn another_poisson_ratio_changes_the_amplitude_of_sliding() {
    // k = 0: M = 2 (1-ν)/(2-ν)
    let map =
        WearMap::new(&Medium::new(2.0, Poisson::Ratio(0.3)).unwrap(), &[0.0, 0.5], &[0.1, 1.22]).unwrap();
    assert!(relative(map.full_sliding[0], 1.7 / 1.4) < 1e-14);
    assert!(map.volume[1].is_nan() && map.ratio[1].is_nan() && map.ratio[3].is_nan() && map.volume[3] > 0.0);
    assert!(Medium::new(2.0, Poisson::Ratio(0.6)).is_err());
    assert!(Medium::new(25.0, Poisson::Similar).unwrap_err().to_string().contains("indenter.exponent = 25"));
}

fn folder() -> std::path::PathBuf {
    env!("CARGO_MANIFEST_DIR").into()
}

fn fretwear() -> assert_cmd::Command {
    assert_cmd::Command::new(env!("CARGO_BIN_EXE_fretwear"))
}

#[test]
fn the_map_of_the_data_folder_is_what_is_done_without_a_file() {
    let mut written = MapScene::read(&folder().join("data/maps/paper.toml")).unwrap();
    let built_in = MapScene::default();
    for (a, b) in written.gradings.iter().zip(&built_in.gradings) {
        assert!((a - b).abs() < 1e-15, "{a} {b}");
    }
    written.gradings.clone_from(&built_in.gradings);
    (written.title, written.text) = (None, String::new());
    assert_eq!(written, built_in);
}

#[test]
fn the_command_writes_all_files_and_never_over_others() {
    let place = tempfile::tempdir().unwrap();
    let scene = place.path().join("small.toml");
    std::fs::write(
        &scene,
        "title = \"small\"\n[map]\ngrading = [-0.5, 0, 0.5]\namplitude_ratio = [0.01, 0.1, 0.9]\nlevels = [1.0]\n\
         [optimum]\namplitude_ratio = [0.5, 2]\n[profiles]\ngrading = [0]\npoints = 5\n",
    )
    .unwrap();
    let output = place.path().join("out");
    let map = || {
        let mut command = fretwear();
        command.arg("map").arg(&scene).arg("-o").arg(&output);
        command
    };
    let first = map().arg("--json").assert().success();
    let report: serde_json::Value = serde_json::from_slice(&first.get_output().stdout).unwrap();
    assert_eq!(report["files"].as_array().unwrap().len(), 6);
    assert!((report["optimum"][0]["grading"].as_f64().unwrap() - 0.758977487619131).abs() < 1e-10);
    assert_eq!(report["optimum"][1]["least_at"], "k->1");
    assert_eq!(report["optimum"][1]["wear_volume_ratio"], serde_json::Value::Null);

    let read = |name: &str| std::fs::read_to_string(output.join(name)).unwrap();
    let map_rows: Vec<String> = read("map.csv").lines().map(str::to_owned).collect();
    assert_eq!(map_rows.len(), 10);
    assert!(map_rows[3].starts_with("-5e-1,9e-1,,"), "full sliding leaves cells empty: {}", map_rows[3]);
    assert_eq!(read("profiles.csv").lines().count(), 6);
    assert_eq!(read("optimum.csv").lines().count(), 7);
    assert!(read("isolines.csv").lines().count() > 3);

    let before = read("map.csv");
    let refused = map().assert().code(2);
    let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(message.contains("exists already; give --force"), "{message}");
    assert_eq!(read("map.csv"), before);
    map().arg("--force").assert().success();

    let info = fretwear().arg("info").arg(output.join("map.h5")).assert().success();
    let text = String::from_utf8_lossy(&info.get_output().stdout).into_owned();
    assert!(text.contains("wear_volume_ratio                  3 x 3"), "{text}");
}

#[test]
fn nonsense_is_refused_and_nothing_written() {
    let place = tempfile::tempdir().unwrap();
    let output = place.path().join("out");
    for (text, expected) in [
        ("x = 1", "x is not a key of a map"),
        ("[map]\ngrading = []", "map.grading = [] is empty"),
        ("[map]\ngrading = [0, 1]", "map.grading[1] = 1 is outside (-1, 1)"),
        (
            "[map]\ngrading = { from = 1e-1, to = 0, count = 3 }",
            "map.grading.to = 0 is not above map.grading.from",
        ),
        ("[map]\namplitude_ratio = { from = 0.1, to = 1, count = 1 }", "count = 1 is outside 2 to 20000"),
        ("[map]\namplitude_ratio = 0.5", "expected an array"),
        (
            "[map]\ngrading = { from = -0.5, to = 0.5, count = 9, spacing = \"geometric\" }",
            "needs values above zero",
        ),
        (
            "[map]\ngrading = { from = -0.5, to = 0.5, count = 20000 }\namplitude_ratio = { from = 0.1, to = 1, count = 20000 }",
            "20000 x 20000 points are more than 10000000",
        ),
        ("[indenter]\nexponent = 30", "indenter.exponent = 30 is outside [0.1, 20]"),
        ("[half_space]\npoisson_ratio = 0.6", "half_space.poisson_ratio = 0.6 is outside (-1, 0.5]"),
        ("[optimum]\nreference_depth = [0]", "is outside [1e-6, 1e6]"),
    ] {
        let scene = place.path().join("bad.toml");
        std::fs::write(&scene, text).unwrap();
        let refused = fretwear().arg("map").arg(&scene).arg("-o").arg(&output).assert().code(2);
        let message = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        assert!(message.contains(expected), "{text}: {message}");
        assert!(!output.exists(), "{text}");
    }
}

#[test]
fn every_exponent_and_border_gives_finite_maps_or_full_sliding() {
    for exponent in [0.1, 0.7, 20.0] {
        for poisson in [Poisson::Similar, Poisson::Ratio(-0.99), Poisson::Ratio(0.5)] {
            let medium = Medium::new(exponent, poisson).unwrap();
            let gradings = [-0.9999, -0.5, 0.0, 0.5, 0.9999];
            let amplitudes = [1e-12, 1e-3, 0.3, 1e3];
            let map = WearMap::new(&medium, &gradings, &amplitudes).unwrap();
            for (i, volume) in map.volume.iter().enumerate() {
                let slides = amplitudes[i % 4] * (1.0 + 1e-9) > map.full_sliding[i / 4];
                assert!(
                    volume.is_nan() == slides && (slides || *volume >= 0.0),
                    "n = {exponent}, {poisson:?}, {i}"
                );
            }
            let controls = [Control::Indentation, Control::Force { reference_depth: 0.1 }];
            for control in controls {
                for point in OptimumCurve::new(&medium, control, &[1e-8, 0.01, 0.4, 30.0]).unwrap().points {
                    let found = matches!(point.end, End::Interior | End::One | End::FullSliding);
                    assert_eq!(found, point.indentation_ratio > 0.0, "{point:?}");
                }
            }
        }
    }
}
