//! What is not known is shown and stored as that, and curves lie where their numbers are.

mod support;

use std::fs;
use std::path::Path;

use fretwear::data::{Dataset, Format, RunFile};
use support::command::{done, run};

const SCENE: &str = r#"
[indenter.paraboloid]
radius = 1
[half_space]
grading = 0
normal_stiffness = 1
stiffness_ratio = 1
[friction.coulomb]
coefficient = 0.5
[wear.archard]
coefficient = 1e-3
[loading]
indentation = 1
amplitude_ratio = 0.5
tau = 0.1
[numerics]
springs = 60
tolerance = 1e-2
[output]
snapshots = 1
"#;

#[test]
fn scenes_without_a_result_are_hatched_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("scene.toml"), SCENE).unwrap();
    // Beyond 1 the whole contact slides, and there is no limit: two of eight amplitudes, eight gradings.
    let study = "scene = \"scene.toml\"\n[[axes]]\nkey = \"loading.amplitude_ratio\"\nvalues = [0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 1.1, 1.2]\n\
                 [[axes]]\nkey = \"friction.coulomb.coefficient\"\nvalues = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8]\n";
    fs::write(at.join("study.toml"), study).unwrap();
    let swept = run(at, &["sweep", "study.toml", "-o", "sweep", "--quiet"]);
    assert!(swept.status.code().is_some_and(|code| code < 2), "{}", support::command::text(&swept.stderr));
    done(at, &["merge", "sweep", "-o", "merged.h5"]);
    done(at, &["plot", "merged.h5", "-o", "map.svg", "--quantity", "wear_volume_limit"]);
    done(at, &["plot", "merged.h5", "-o", "map.png", "--quantity", "wear_volume_limit"]);
    let svg = fs::read_to_string(at.join("map.svg")).unwrap();
    let document = roxmltree::Document::parse(&svg).unwrap();
    let said = document.descendants().filter_map(|node| node.attribute("aria-label"));
    assert!(said.into_iter().any(|label| label.starts_with("no result in 16 of 64 scenes")), "no legend");
    let hatched =
        |node: &roxmltree::Node| node.attribute("fill").is_some_and(|fill| fill.starts_with("url(#"));
    let areas: Vec<&str> = document
        .descendants()
        .filter(|node| hatched(node) && node.attribute("data-series").is_some())
        .filter_map(|node| node.attribute("d"))
        .collect();
    // From the last amplitude with a result to the largest, as wide as the frame.
    let [area] = areas[..] else { panic!("{areas:?}") };
    let corners: Vec<[f64; 2]> = area
        .split(['M', 'L', 'Z'])
        .filter(|it| !it.is_empty())
        .map(|it| it.split_once(' ').map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()]).unwrap())
        .collect();
    let range = |axis: usize| {
        let all = corners.iter().map(|corner| corner[axis]);
        [all.clone().fold(f64::INFINITY, f64::min), all.fold(0.0, f64::max)]
    };
    let frame = document.descendants().find(|node| node.attribute("class") == Some("frame")).unwrap();
    let [left, top, width, height] =
        ["x", "y", "width", "height"].map(|name| frame.attribute(name).unwrap().parse::<f64>().unwrap());
    let [from, to] = range(1);
    assert!((from - top).abs() < 0.1 && (to - top - 0.5 * height).abs() < 0.1, "{from} to {to}");
    assert!((range(0)[0] - left).abs() < 0.1 && (range(0)[1] - left - width).abs() < 0.1, "{:?}", range(0));
    // No colour lies there: of the bands all are below.
    let colour = |node: &roxmltree::Node| {
        node.attribute("fill-rule").is_some() && node.attribute("data-series").is_some() && !hatched(node)
    };
    let bands = document.descendants().filter(colour).filter_map(|node| node.attribute("d"));
    let ends = bands.flat_map(|path| path.split(['M', 'L', 'Z'])).filter_map(|it| it.split_once(' '));
    let highest = ends.map(|(_, y)| y.parse::<f64>().unwrap()).fold(f64::INFINITY, f64::min);
    assert!((highest - to).abs() < 0.1, "bands to {highest}, hatched from {to}");
}

#[test]
fn a_pressure_that_is_not_known_is_not_a_number_and_the_file_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes/normal_force.toml");
    let scene = fs::read_to_string(scene).unwrap().replace("tau = 30", "tau = 5");
    let scene = scene.replace("accuracy = 1e-3", "springs = 32\ntolerance = 1e-2");
    fs::write(at.join("scene.toml"), scene + "\n[output]\nsnapshots = 5\n").unwrap();
    let run = run(at, &["run", "scene.toml", "--quiet"]);
    assert!(run.status.success(), "{run:?}");
    let file = RunFile::open(&at.join("scene.h5")).unwrap();
    let mut missing = 0;
    for snapshot in &file.snapshots {
        for (r, pressure) in file.header.radius.iter().zip(&snapshot.pressure) {
            // Stick spreads over ground that is worn already; its innermost spring tells the edge to its own width.
            let sticks = *r < 0.999 * snapshot.stick_radius;
            let slips = *r > 1.001 * snapshot.stick_radius;
            assert!(!sticks || pressure.is_nan(), "τ = {}, r = {r}: {pressure}", snapshot.tau);
            assert!(!slips || pressure.is_finite(), "τ = {}, r = {r}: {pressure}", snapshot.tau);
            assert!(*r < snapshot.contact_radius || *pressure == 0.0, "τ = {}, r = {r}", snapshot.tau);
            missing += usize::from(pressure.is_nan());
        }
        assert!(
            snapshot
                .slip
                .iter()
                .chain(&snapshot.wear_depth)
                .chain(&snapshot.profile)
                .all(|it| it.is_finite())
        );
    }
    assert!(missing > 0, "the edge of stick did not move");
    let stored = hdf5::File::open(at.join("scene.h5")).unwrap();
    let dataset = stored.dataset("pressure").unwrap();
    assert!(dataset.attr("_FillValue").unwrap().read_scalar::<f64>().unwrap().is_nan());
    let why: hdf5::types::VarLenUnicode = dataset.attr("comment").unwrap().read_scalar().unwrap();
    assert!(why.contains("stick zone"), "{why}");
    stored.close().unwrap();
    // Figures, the page, CSV and VTK of it.
    done(at, &["plot", "scene.h5", "-o", "pressure.svg", "--kind", "pressure"]);
    done(at, &["report", "scene.h5", "-o", "page.html"]);
    done(at, &["export", "scene.h5", "-o", "curves.csv"]);
    for name in ["pressure.svg", "page.html", "curves.csv"] {
        let text = fs::read_to_string(at.join(name)).unwrap();
        assert!(!text.contains("NaN") || name == "page.html", "{name}");
    }
}

#[test]
fn curves_of_universality_lie_as_near_to_the_diagonal_as_their_cases_to_the_limit() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let study = format!(
        "[scene]\nindenter = {{ paraboloid = {{ radius = 1 }} }}\nhalf_space = {{ grading = 0, normal_stiffness = 1, stiffness_ratio = 1 }}\n\
         friction = {{ coulomb = {{ coefficient = 0.5 }} }}\nwear = {{ archard = {{ coefficient = 1e-3 }} }}\n\
         loading = {{ indentation = 1, amplitude_ratio = 0.5, tau = 100 }}\nnumerics = {{ springs = 30, tolerance = 1e-4 }}\n{}",
        "[[media]]\nname = \"homogeneous\"\n[[media]]\nname = \"graded\"\npatch = { half_space = { grading = 0.7 } }\n\
         [[wear]]\nname = \"Archard\"\n[[cases]]\nname = \"early\"\npredicted = \"outside\"\npatch = { loading = { tau = 1 } }\n"
    );
    fs::write(at.join("study.toml"), study).unwrap();
    let ended = run(at, &["universality", "study.toml", "-o", "out", "--quiet"]);
    assert!(ended.status.code().is_some_and(|code| code < 2), "{}", support::command::text(&ended.stderr));
    let file = Dataset::read(&at.join("out/universality.h5"), Format::Universality).unwrap();
    let cases = file.along("distance").unwrap();
    let points = file.along("position").unwrap().len();
    let [depth, limit] = ["profile_wear_depth", "profile_limit"]
        .map(|name| file.numbers(name, &[cases.len(), points]).unwrap());
    for (case, distance) in cases.iter().enumerate() {
        let part = case * points..(case + 1) * points;
        let gaps = depth[part.clone()].iter().zip(&limit[part]).map(|(one, other)| (one - other).abs());
        let worst = gaps.filter(|gap| gap.is_finite()).fold(0.0, f64::max);
        println!("case {case}: distance {distance:e}, the curve {worst:e}");
        assert!(
            worst <= distance * (1.0 + 1e-9) + 1e-12,
            "case {case}: distance {distance:e}, curve {worst:e}"
        );
        assert!(worst >= 0.3 * distance, "case {case}: distance {distance:e}, curve {worst:e}");
    }
}
