//! Figures and pages of result files, judged by what they are made of: series, axes, labels, and where a drawing puts them.

mod support;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

use fretwear::data::{RunFile, SweepFile, Values, fretting_regimes};
use fretwear::figures::drawing::{Drawing, Figure, Panel, Series, Spacing, Style, ticks, without_markup};
use fretwear::figures::page;
use fretwear::figures::{Kind, Results, RunResults};
use roxmltree::Document;
use support::command::{done, names, run, text};

const MAP: &str = r#"
[map]
grading = { from = -0.8, to = 0.8, count = 33 }
amplitude_ratio = { from = 1e-3, to = 1, count = 31, spacing = "geometric" }
levels = [0.5, 1, 2]
[optimum]
amplitude_ratio = { from = 1e-3, to = 1, count = 7 }
[profiles]
grading = [-0.7, 0, 0.5]
amplitude_ratio = 0.5
points = 101
"#;

const UNIVERSALITY: &str = r#"
title = "Two that obey and one that does not"
cover = "full"
tolerances = { within = 1e-4, outside = 1e-2 }
[scene]
indenter = { paraboloid = { radius = 1 } }
half_space = { grading = 0, normal_stiffness = 1, stiffness_ratio = 1 }
friction = { coulomb = { coefficient = 1 } }
wear = { archard = { coefficient = 1e-3 } }
loading = { indentation = 1, stick_ratio = 0.7, tau = 60 }
numerics = { springs = 16, tolerance = 1e-3 }
[[wear]]
name = "p s"
[[wear]]
name = "dissipated energy"
patch = { wear = { dissipated-energy = { coefficient = 2e-3 } } }
[[cases]]
name = "stopped early"
predicted = "outside"
patch = { loading = { tau = 3 } }
"#;

const TRADEOFF: &str = r#"
title = "small"
indenter = { paraboloid = { radius = 1 } }
half_space = { grading = 0, normal_stiffness = 1, stiffness_ratio = 1 }
friction = { coulomb = { coefficient = 1 } }
wear = { archard = { coefficient = 1e-3 } }
loading = { indentation = 1, stick_ratio = 0.7, tau = 30 }
"#;

/// Nine amplitudes and eight radii, so that a sweep over both is a map.
fn study(axes: &str) -> String {
    format!("title = \"a <study> & its *title*\"\nscene = \"scene.toml\"\ntask = \"limit\"\n{axes}")
}
const AMPLITUDE: &str =
    "[[axes]]\nkey = \"loading.stick_ratio\"\nfrom = 0.5\nto = 0.9\ncount = 9\nspacing = \"linear\"\n";
const RADIUS: &str = "[[axes]]\nkey = \"indenter.paraboloid.radius\"\nfrom = \"1 mm\"\nto = \"8 mm\"\ncount = 8\nspacing = \"linear\"\n";
const FEW_RADII: &str = "[[axes]]\nkey = \"indenter.paraboloid.radius\"\nvalues = [\"1 mm\", \"5 mm\"]\n";
const SAMPLES: &str = "[sampling]\nmethod = \"random\"\ncount = 8\nseed = 1\n\
     [[sampling.variables]]\nkey = \"friction.coulomb.coefficient\"\ndistribution = \"uniform\"\nfrom = 0.5\nto = 0.7\n\
     [[sampling.variables]]\nkey = \"wear.archard.coefficient\"\ndistribution = \"uniform\"\nfrom = 1e-14\nto = 2e-14\n";

/// Result files of every kind, made once by the program.
static FILES: LazyLock<tempfile::TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    let put = |name: &str, text: &str| fs::write(place(name), text).unwrap();
    put("scene.toml", include_str!("support/base.toml"));
    put("map.toml", MAP);
    put("universality.toml", UNIVERSALITY);
    put("tradeoff.toml", TRADEOFF);
    let command = |line: &str| done(folder.path(), &line.split(' ').collect::<Vec<_>>());
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/scenes");
    command(&format!("run {} -o run.h5 --quiet", scenes.join("paraboloid.toml").display()));
    command(&format!("run {} -o orbit.h5 --quiet", scenes.join("orbit.toml").display()));
    command("map map.toml -o map --json");
    command("universality universality.toml -o universality --quiet");
    command(
        "tradeoff tradeoff.toml -o tradeoff --quiet --springs 12,24 --tolerances 1e-3 --accuracies 1e-2 --repeats 1",
    );
    for (name, axes) in [
        ("grid", format!("{AMPLITUDE}{RADIUS}")),
        ("curves", format!("{AMPLITUDE}{FEW_RADII}")),
        ("one", AMPLITUDE.into()),
        ("samples", format!("{AMPLITUDE}{SAMPLES}")),
    ] {
        put(&format!("{name}.toml"), &study(&axes));
        command(&format!("sweep {name}.toml -o {name} --quiet"));
        command(&format!("merge {name} -o {name}.h5"));
    }
    let dead_weight =
        include_str!("../data/studies/fretting_map.toml").replace("../scenes", &scenes.display().to_string());
    put("regimes.toml", &dead_weight.replace("count = 16", "count = 4"));
    command("sweep regimes.toml -o regimes --quiet");
    command("merge regimes -o regimes.h5");
    folder
});

fn file(name: &str) -> PathBuf {
    FILES.path().join(name)
}

fn results(name: &str) -> Results {
    Results::read(&file(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn figure(name: &str, kind: Kind) -> Figure {
    results(name).figure(kind, None).unwrap_or_else(|error| panic!("{name} {}: {error}", kind.name()))
}

fn run_file() -> RunFile {
    RunFile::open(&file("run.h5")).unwrap()
}

fn panel(figure: &Figure, number: usize) -> &Panel {
    figure.panels().nth(number).unwrap_or_else(|| panic!("no panel {number} in {:?}", figure.title))
}

fn series<'a>(panel: &'a Panel, name: &str) -> &'a Series {
    let found = panel.series.iter().find(|series| series.name == name);
    found.unwrap_or_else(|| {
        panic!("no {name} in {:?}", panel.series.iter().map(|it| &it.name).collect::<Vec<_>>())
    })
}

/// Files and all kinds that fit.
const ALL: [&str; 10] = [
    "run.h5",
    "orbit.h5",
    "map/map.h5",
    "universality/universality.h5",
    "tradeoff/tradeoff.h5",
    "grid.h5",
    "curves.h5",
    "one.h5",
    "samples.h5",
    "regimes.h5",
];

fn every_figure() -> Vec<(String, Figure)> {
    let of = |name: &&str| {
        let results = results(name);
        let figures = results
            .kinds()
            .into_iter()
            // Half a million cubic micrometres have no short ticks.
            .filter(|kind| *name != "regimes.h5" || *kind == Kind::Regimes)
            .map(|kind| (format!("{name} {}", kind.name()), results.figure(kind, None).unwrap()));
        figures.collect::<Vec<_>>()
    };
    ALL.iter().flat_map(of).collect()
}

#[test]
fn the_profile_is_that_of_the_file_between_the_unworn_one_and_the_limit() {
    let run = run_file();
    let figure = figure("run.h5", Kind::Profile);
    let [whole, ring, depth] = [0, 1, 2].map(|number| panel(&figure, number));
    assert_eq!(whole.x.text(), "radius *r* (µm)");
    assert_eq!(whole.y.text(), "profile *f* (nm)");
    assert_eq!(whole.x.range[0], 0.0);
    // Every node of the last snapshot lies on the last curve, in µm and nm.
    let last = run.snapshots.last().unwrap();
    let curve = series(depth, "*N* = 10^{6}");
    for (r, w) in run.header.radius.iter().zip(&last.wear_depth) {
        let [r, w] = [1e6 * r, 1e9 * w];
        let gap = curve
            .points
            .iter()
            .map(|point| (point[0] - r).abs().max((point[1] - w).abs()))
            .fold(f64::INFINITY, f64::min);
        assert!(gap < 1e-6 * r, "({r}, {w}) is off the curve by {gap}");
    }
    // Nothing between nodes is above the deepest node.
    let most = last.wear_depth.iter().copied().fold(0.0, f64::max);
    assert!(curve.points.iter().all(|point| point[1] <= 1e9 * most * (1.0 + 1e-12)));
    // The stuck centre is the unworn paraboloid, r²/(2R) with R = 10 mm.
    let stuck = series(whole, "limit").points.iter().filter(|point| point[0] < 60.0);
    let worst = stuck.map(|[r, f]| (f - 1e9 * (1e-6 * r).powi(2) / 0.02).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-6, "{worst} nm");
    let (limit, unworn) = (series(ring, "limit"), series(ring, "unworn"));
    assert!(limit.points[0][0] > 0.5 * 60.0 && limit.in_legend == unworn.in_legend && !limit.in_legend);
    // Later is darker.
    let curves = depth.series.iter().filter(|series| series.name.starts_with("*N*"));
    let luminances: Vec<f64> = curves.map(|series| series.colour.luminance()).collect();
    assert!(luminances.len() >= 4 && luminances.windows(2).all(|pair| pair[1] < pair[0]), "{luminances:?}");
}

#[test]
fn history_tends_to_the_limit_of_the_closed_form() {
    let run = run_file();
    let figure = figure("run.h5", Kind::History);
    let volume = panel(&figure, 0);
    assert_eq!(volume.x.spacing, Spacing::Logarithmic);
    let [first, last] = volume.x.range;
    assert!((first / 100.0 - 1.0).abs() < 1e-9 && (last / 1e6 - 1.0).abs() < 1e-9, "{first} {last}");
    assert_eq!(volume.y.text(), "worn volume Δ*V* (µm³)");
    let points = &series(volume, "worn volume").points;
    assert_eq!(points.len(), run.snapshots.len() - 1);
    let last = run.snapshots.last().unwrap();
    assert_eq!(points.last().unwrap(), &[last.cycles, last.wear_volume / 1e-18]);
    // The limits of the main scene, as `fretwear limit` has them.
    let limits = [(0, 1324.58, 1e-5), (1, 103.318, 1e-5), (2, 98.9913, 1e-6), (3, 8.78744, 1e-6)];
    for (number, expected, tolerance) in limits {
        let found = series(panel(&figure, number), "limit").points[0][1];
        assert!((found / expected - 1.0).abs() < tolerance, "panel {number}: {found}, {expected}");
    }
}

#[test]
fn the_approach_is_the_distance_of_the_report() {
    let run = run_file();
    let figure = figure("run.h5", Kind::Approach);
    let distance = &series(panel(&figure, 0), "profile, sup |*w* − *w*_{∞}| / max *w*_{∞}").points;
    let limit = run.header.limit.as_ref().unwrap();
    let most = limit.wear_depth.iter().copied().fold(0.0, f64::max);
    let last = run.snapshots.last().unwrap();
    let expected = limit
        .wear_depth
        .iter()
        .zip(&last.wear_depth)
        .map(|(one, other)| (one - other).abs())
        .fold(0.0, f64::max)
        / most;
    assert_eq!(distance.last().unwrap(), &[last.tau, expected]);
    assert_eq!(panel(&figure, 0).y.spacing, Spacing::Logarithmic);
}

#[test]
fn fretting_regimes_are_areas_around_the_snapshots() {
    let figure = figure("regimes.h5", Kind::Regimes);
    let panel = panel(&figure, 0);
    assert_eq!((panel.x.spacing, panel.y.text().as_str()), (Spacing::Logarithmic, "loading.amplitude (nm)"));
    let between =
        |low: f64, value: f64, high: f64| low <= value * (1.0 + 1e-12) && value * (1.0 - 1e-12) <= high;
    let inside = |ring: &[[f64; 2]], [x, y]: [f64; 2]| {
        between(ring[0][0], x, ring[1][0]) && between(ring[0][1], y, ring[2][1])
    };
    let SweepFile { runs, .. } = SweepFile::read(&file("regimes.h5")).unwrap();
    for (scene, run) in &runs {
        // 500, 600, 700 and 800 nm; gross slip begins at 638 nm.
        let y = 500.0 + 100.0 * *scene as f64;
        for (snapshot, regime) in run.snapshots.iter().zip(fretting_regimes(&run.snapshots)).skip(1) {
            let name = match (regime.name(), snapshot.regime.name()) {
                ("full-sliding", "full-sliding") => "gross slip",
                ("mixed", "partial-slip") => "mixed, now partial slip",
                ("partial-slip", "partial-slip") => "partial slip",
                other => panic!("{scene}: {other:?}"),
            };
            let areas = series(panel, name).points.split(|point| point[0].is_nan());
            let count = areas.filter(|ring| !ring.is_empty() && inside(ring, [snapshot.cycles, y])).count();
            assert_eq!(count, 1, "{name} at {y} nm after {} cycles", snapshot.cycles);
        }
    }
    let error = results("one.h5").figure(Kind::Regimes, None).unwrap_err().to_string();
    assert!(error.contains("keeps no snapshots") && error.contains("give sweep"), "{error}");
}

#[test]
fn pressure_ends_at_the_edge_of_contact_and_loops_close() {
    let run = run_file();
    let pressure = figure("run.h5", Kind::Pressure);
    let unworn = series(panel(&pressure, 0), "unworn").points.last().unwrap();
    assert_eq!(unworn[1], 0.0);
    assert!((unworn[0] - 1e6 * run.snapshots[0].contact_radius).abs() < 1e-9, "{unworn:?}");
    assert_eq!(panel(&pressure, 0).y.text(), "pressure *p* (MPa)");
    for (name, count) in [("run.h5", 2), ("orbit.h5", 2)] {
        let loops = figure(name, Kind::Loops);
        for number in 0..count {
            for series in &panel(&loops, number).series {
                let ends = [series.points.first().unwrap(), series.points.last().unwrap()];
                assert!(
                    ends[0].iter().zip(ends[1]).all(|(a, b)| (a - b).abs() < 1e-9),
                    "{name} {}: {ends:?}",
                    series.name
                );
            }
        }
    }
    // The area of the first loop is its energy (1 N nm = 1 nJ).
    let along = figure("run.h5", Kind::Loops);
    let area = |points: &[[f64; 2]]| {
        points.windows(2).map(|it| 0.5 * (it[1][0] - it[0][0]) * (it[0][1] + it[1][1])).sum::<f64>().abs()
    };
    let expected = 1e9 * run.snapshots[0].cycle_energy;
    let found = area(&series(panel(&along, 0), "unworn").points);
    assert!((found / expected - 1.0).abs() < 0.01, "{found} nJ, {expected} nJ");
}

#[test]
fn the_map_has_the_line_of_full_sliding_and_that_of_equal_wear() {
    let figure = figure("map/map.h5", Kind::Map);
    for panel in figure.panels() {
        assert_eq!(panel.x.range, [-0.8, 0.8]);
        assert_eq!((panel.y.spacing, panel.y.range[1]), (Spacing::Logarithmic, 1.0));
        // Under elastic similarity everything slides from U/(μ_f d) = (1+k)(3+k)/2 on.
        for [k, amplitude] in &series(panel, "full sliding").points {
            assert!((amplitude - 0.5 * (1.0 + k) * (3.0 + k)).abs() < 1e-12, "{k}: {amplitude}");
        }
        // The homogeneous medium wears as much as itself.
        let equal: Vec<[f64; 2]> = panel
            .series
            .iter()
            .filter(|series| series.name == "Δ*V*(*k*)/Δ*V*(0) = 1")
            .flat_map(|series| series.points.clone())
            .collect();
        assert!(equal.iter().filter(|point| point[0].abs() < 1e-9).count() > 10, "{equal:?}");
    }
    assert_eq!(figure.panels().last().unwrap().bar.as_ref().unwrap().axis.spacing, Spacing::Logarithmic);
}

#[test]
fn bands_of_the_map_lie_where_their_values_are() {
    let figure = figure("map/map.h5", Kind::Map);
    let panel = panel(&figure, 0);
    let bands: Vec<&Series> =
        panel.series.iter().filter(|series| matches!(series.style, Style::Region { opacity: 1.0 })).collect();
    // Much wear is dark; the last area is what slides, in grey.
    let colours: Vec<f64> = bands.iter().map(|band| band.colour.luminance()).collect();
    let (_, bands) = bands.split_last().unwrap();
    assert!(colours[..bands.len()].windows(2).all(|pair| pair[1] < pair[0]), "{colours:?}");
    // Along k = 0.5 the last band that begins at an amplitude, from below, grows lighter upwards: wear relative to k = 0 falls.
    let inside = |rings: &[[f64; 2]], x: f64, y: f64| {
        let crossings = rings.split(|point| point[0].is_nan()).flat_map(|ring| {
            let next = ring.iter().cycle().skip(1);
            ring.iter().zip(next).filter(move |(a, b)| {
                (a[0] > x) != (b[0] > x)
                    && y.ln() < a[1].ln() + (x - a[0]) / (b[0] - a[0]) * (b[1].ln() - a[1].ln())
            })
        });
        crossings.count() % 2 == 1
    };
    let topmost = |y: f64| bands.iter().rposition(|band| inside(&band.points, 0.51, y)).unwrap();
    let along: Vec<usize> = [2e-3, 1e-2, 5e-2, 0.2, 0.8].map(topmost).into();
    assert!(along.windows(2).all(|pair| pair[1] < pair[0]), "{along:?}");
}

#[test]
fn worn_profiles_leave_out_what_slides_and_say_so() {
    let figure = figure("map/map.h5", Kind::WornProfiles);
    let names: Vec<&str> = panel(&figure, 0).series.iter().map(|series| series.name.as_str()).collect();
    // Fig. 1 of the paper exists only for k > -0.5858.
    assert_eq!(names, ["unworn", "*k* = 0", "*k* = 0.5"]);
    assert!(
        figure.notes.iter().any(|note| note == "Full sliding, without a limit, for *k* = −0.7."),
        "{:?}",
        figure.notes
    );
    assert!(figure.notes[0].contains("= 0.5, *n* = 2"), "{:?}", figure.notes);
}

#[test]
fn the_optimum_changes_sign_where_it_is_known_to() {
    let figure = figure("map/map.h5", Kind::Optimum);
    let points = &series(panel(&figure, 0), "same indentation").points;
    // Negative below 0.067669, positive above.
    assert!(points.iter().all(|[amplitude, k]| (*amplitude > 0.0677) == (*k > 0.0)), "{points:?}");
    assert_eq!(panel(&figure, 0).x.spacing, Spacing::Logarithmic);
}

#[test]
fn controls_stand_apart_from_the_cases_that_obey() {
    let figure = figure("universality/universality.h5", Kind::Universality);
    let [obeying, controls, order] = [0, 1, 2].map(|number| panel(&figure, number));
    assert_eq!(obeying.title.as_deref(), Some("2 cases predicted to obey"));
    let off = |panel: &Panel| {
        let points = panel.series.iter().flat_map(|series| &series.points);
        points.map(|point| (point[0] - point[1]).abs()).fold(0.0, f64::max)
    };
    assert!(off(obeying) < 0.05 && off(controls) > 0.1, "{} {}", off(obeying), off(controls));
    assert!(order.labels.iter().any(|label| label.text == "stopped early  1"), "{:?}", order.labels);
}

#[test]
fn the_front_of_a_trade_off_falls_in_steps() {
    let figure = figure("tradeoff/tradeoff.h5", Kind::Tradeoff);
    for panel in figure.panels() {
        let front = &series(panel, "front").points;
        assert!(
            front.len() % 2 == 1 && front.windows(2).all(|it| it[1][0] >= it[0][0] && it[1][1] <= it[0][1]),
            "{front:?}"
        );
        assert_eq!(series(panel, "accuracy").points.len(), 1);
        assert_eq!((panel.x.spacing, panel.y.spacing), (Spacing::Logarithmic, Spacing::Logarithmic));
    }
    assert_eq!(panel(&figure, 0).x.text(), "wall time (s)");
    assert_eq!(panel(&figure, 0).y.range, panel(&figure, 1).y.range);
}

#[test]
fn a_sweep_is_drawn_by_the_axes_it_has() {
    let values = |name: &str, column: &str| {
        let file = SweepFile::read(&file(name)).unwrap();
        let column = file.columns.into_iter().find(|it| it.name == column).unwrap();
        let Values::Numbers(values) = column.values else { panic!("{} is words", column.name) };
        values
    };
    let one = figure("one.h5", Kind::Sweep);
    let curve = &series(panel(&one, 0), "loading.stick\\_ratio").points;
    let volumes = values("one.h5", "wear_volume_limit");
    assert_eq!(
        curve.iter().map(|point| point[0]).collect::<Vec<_>>(),
        values("one.h5", "input_loading_stick_ratio")
    );
    let worst = curve
        .iter()
        .zip(&volumes)
        .map(|(point, volume)| (point[1] / (volume / 1e-18) - 1.0).abs())
        .fold(0.0, f64::max);
    assert!(worst < 1e-12 && panel(&one, 0).y.unit == "µm³", "{worst} {}", panel(&one, 0).y.unit);
    let two = figure("curves.h5", Kind::Sweep);
    let legend: Vec<&str> =
        panel(&two, 0).series.iter().filter(|it| it.in_legend).map(|it| it.name.as_str()).collect();
    assert_eq!(legend, ["indenter.paraboloid.radius = 1 mm", "indenter.paraboloid.radius = 5 mm"]);
    let grid = figure("grid.h5", Kind::Sweep);
    let dots = panel(&grid, 0).series.iter().filter(|series| matches!(series.style, Style::Points { .. }));
    assert_eq!(dots.count(), 72);
    assert!(panel(&grid, 0).bar.as_ref().unwrap().axis.text().starts_with("worn volume in the limit"));
    let samples = figure("samples.h5", Kind::Sweep);
    let median = &series(panel(&samples, 0), "median").points;
    assert_eq!((median.len(), series(panel(&samples, 0), "samples").points.len()), (9, 72));
    let other = results("one.h5").figure(Kind::Sweep, Some("contact_radius_limit")).unwrap();
    assert!(panel(&other, 0).y.text().ends_with("(µm)"), "{}", panel(&other, 0).y.text());
}

#[test]
fn every_axis_has_a_readable_range_and_every_text_a_letter_for_each_of_its_own() {
    for (name, figure) in every_figure() {
        for panel in figure.panels() {
            for axis in [&panel.x, &panel.y] {
                let labels: Vec<String> = ticks(axis, 5).into_iter().filter_map(|tick| tick.label).collect();
                assert!(!axis.ticked || labels.len() >= 2, "{name}: {labels:?} on {}", axis.text());
                // 1e-6 m is 1 µm: no label needs more than six letters.
                let longest =
                    labels.iter().map(|label| without_markup(label).chars().count()).max().unwrap_or(0);
                assert!(longest <= 6, "{name}: {labels:?} on {}", axis.text());
            }
            let texts = [panel.x.text(), panel.y.text()]
                .into_iter()
                .chain(panel.series.iter().map(|it| it.name.clone()));
            for text in texts {
                assert!(!without_markup(&text).contains(['{', '}']), "{name}: {text}");
            }
        }
    }
}

/// Numbers of a path with absolute commands M and L only.
fn path_points(path: &str) -> Vec<[f64; 2]> {
    let pairs = path.split(['M', 'L', 'Z']).filter(|pair| !pair.is_empty());
    let number = |text: &str| text.parse::<f64>().unwrap_or_else(|_| panic!("{text:?} in {path}"));
    pairs.map(|pair| pair.split_once(' ').map(|(x, y)| [number(x), number(y)]).unwrap()).collect()
}

#[test]
fn drawings_parse_say_all_their_texts_and_put_points_where_the_axes_say() {
    for (name, figure) in every_figure() {
        let drawing = Drawing::new(&figure, "t");
        let document = Document::parse(&drawing.svg).unwrap_or_else(|error| panic!("{name}: {error}"));
        let texts: Vec<&str> =
            document.descendants().filter_map(|node| node.attribute("aria-label")).collect();
        let groups: Vec<_> =
            document.descendants().filter(|node| node.attribute("class") == Some("panel")).collect();
        assert_eq!(groups.len(), figure.panels().count(), "{name}");
        for ((panel, frame), group) in figure.panels().zip(&drawing.frames).zip(groups) {
            for expected in [panel.x.text(), panel.y.text()].iter().filter(|text| !text.is_empty()) {
                assert!(
                    texts.contains(&without_markup(expected).as_str()),
                    "{name}: {expected} is not in {texts:?}"
                );
            }
            for node in group.descendants() {
                let Some(number) = node.attribute("data-series") else { continue };
                let series = &panel.series[number.parse::<usize>().unwrap()];
                if !matches!(series.style, Style::Line { .. }) {
                    continue;
                }
                let drawn = path_points(node.attribute("d").unwrap());
                let places = series.points.iter().map(|point| frame.point(&panel.x, &panel.y, *point));
                let places: Vec<[f64; 2]> =
                    places.filter(|place| place.iter().all(|it| it.is_finite() && it.abs() < 1e6)).collect();
                assert_eq!(drawn.len(), places.len(), "{name} {}", series.name);
                for (one, other) in drawn.iter().zip(&places) {
                    assert!(
                        (one[0] - other[0]).abs() < 0.006 && (one[1] - other[1]).abs() < 0.006,
                        "{name}: {one:?} {other:?}"
                    );
                }
            }
            assert!(
                frame.left > 0.0
                    && frame.top > 0.0
                    && frame.left + frame.width < 720.0
                    && frame.width > 100.0,
                "{name}: {frame:?}"
            );
        }
        // Nothing is loaded, and no letter needs a font.
        assert!(!drawing.svg.contains("<text") && !drawing.svg.contains("url(http"), "{name}");
    }
}

#[test]
fn no_number_in_a_file_stops_the_drawing() {
    let values = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -1.0, 1e300, 5e-324];
    for (place, value) in values.into_iter().enumerate() {
        for which in 0..7 {
            let mut run = run_file();
            let (middle, last) = (run.snapshots.len() / 2, run.snapshots.len() - 1);
            let header = &mut run.header;
            match which {
                0 => run.snapshots[middle].wear_depth[3] = value,
                1 => run.snapshots[last].cycles = value,
                2 => run.snapshots[last].wear_volume = value,
                3 => run.snapshots[last].contact_radius = value,
                4 => *header.radius.last_mut().unwrap() = value,
                5 => run.snapshots[0].loop_force.fill(value),
                _ => run.snapshots.truncate(place),
            }
            let Ok(results) = RunResults::new(run, Path::new("edited.h5")) else { continue };
            let results = Results::Run(Box::new(results));
            if results.kinds().is_empty() {
                let error = results.figure(Kind::Profile, None).unwrap_err().to_string();
                assert!(error.ends_with("the file is of a run with too few snapshots"), "{error}");
            }
            for kind in results.kinds() {
                let drawing = Drawing::new(&results.figure(kind, None).unwrap(), "t");
                assert!(
                    Document::parse(&drawing.svg).is_ok() && !drawing.svg.contains("NaN"),
                    "{value} {which} {}",
                    kind.name()
                );
            }
        }
    }
}

#[test]
fn the_program_draws_svg_and_png_of_every_file() {
    let folder = tempfile::tempdir().unwrap();
    for name in ALL {
        let from = file(name);
        let from = from.to_str().unwrap();
        done(folder.path(), &["plot", from, "-o", "figure.png", "--force"]);
        let png = fs::read(folder.path().join("figure.png")).unwrap();
        assert_eq!(png[..8], *b"\x89PNG\r\n\x1a\n");
        let width = u32::from_be_bytes(png[16..20].try_into().unwrap());
        assert_eq!(width, 2160, "{name}");
        done(folder.path(), &["plot", from, "-o", "figure.svg", "--force"]);
        let svg = fs::read_to_string(folder.path().join("figure.svg")).unwrap();
        assert!(Document::parse(&svg).is_ok(), "{name}");
    }
    assert_eq!(names(folder.path()), ["figure.png", "figure.svg"]);
}

#[test]
fn bad_requests_are_refused_with_what_to_do_and_write_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("text.h5"), "not HDF5").unwrap();
    fs::write(here.join("there.svg"), "mine").unwrap();
    let whole = fs::read(file("run.h5")).unwrap();
    fs::write(here.join("cut.h5"), &whole[..whole.len() / 2]).unwrap();
    let [run_h5, map, sweep] =
        ["run.h5", "map/map.h5", "one.h5"].map(|name| file(name).to_str().unwrap().to_owned());
    let before = names(here);
    let cases: [(&[&str], &str); 13] = [
        (&["plot", "text.h5", "-o", "a.svg"], "text.h5: is not an HDF5 file"),
        (&["plot", "cut.h5", "-o", "a.svg"], "cut.h5: has no checksum at its end: it was cut short"),
        (&["plot", "missing.h5", "-o", "a.svg"], "missing.h5: No such file"),
        (
            &["plot", &run_h5, "-o", "a.pdf"],
            "a.pdf: ends neither in .svg nor in .png; give it the ending of one",
        ),
        (&["plot", &run_h5, "-o", "there.svg"], "there.svg: exists already; give --force"),
        (&["plot", &run_h5, "-o", "no/a.svg"], "create its directory first"),
        (
            &["plot", &run_h5, "-o", "a.svg", "--kind", "map"],
            "kind: map does not fit, the file is of a run; give profile, pressure, history, approach, loops",
        ),
        (&["plot", &map, "-o", "a.svg", "--kind", "profile"], "give map, worn-profiles, optimum"),
        (&["plot", &map, "-o", "a.svg", "--kind", "pie"], "give one of profile, pressure, history"),
        (
            &["plot", &sweep, "-o", "a.svg", "--quantity", "beauty"],
            "quantity: beauty is no number that the sweep found; give one of ",
        ),
        (
            &["plot", &run_h5, "-o", "a.svg", "--quantity", "wear_volume"],
            "is chosen for figures of a sweep only",
        ),
        (&["report", "text.h5", "-o", "a.html"], "text.h5: is not an HDF5 file"),
        (&["report", &run_h5, "-o", "there.svg"], "there.svg: exists already; give --force"),
    ];
    for (arguments, expected) in cases {
        let output = run(here, arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", text(&output.stderr));
        assert!(text(&output.stderr).contains(expected), "{arguments:?}: {}", text(&output.stderr));
        assert_eq!(names(here), before, "{arguments:?}");
    }
    assert_eq!(fs::read_to_string(here.join("there.svg")).unwrap(), "mine");
}

#[test]
fn a_run_draws_itself_where_it_is_asked_to() {
    let folder = tempfile::tempdir().unwrap();
    let scene = file("scene.toml");
    let scene = scene.to_str().unwrap();
    done(folder.path(), &["run", scene, "-o", "a.h5", "--quiet", "--plot"]);
    done(folder.path(), &["run", scene, "-o", "b.h5", "--quiet", "--plot=picture.png"]);
    assert_eq!(names(folder.path()), ["a.h5", "a.svg", "b.h5", "picture.png"]);
    // A picture in the way is found before anything runs.
    fs::remove_file(folder.path().join("a.h5")).unwrap();
    let output = run(folder.path(), &["run", scene, "-o", "a.h5", "--quiet", "--plot"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("a.svg: exists already"), "{}", text(&output.stderr));
    assert!(!folder.path().join("a.h5").exists());
}

#[test]
fn a_page_holds_inputs_verdict_and_figures_and_loads_nothing() {
    for name in ALL {
        let results = results(name);
        let page = page::report(&results, &file(name)).unwrap();
        for kind in results.kinds() {
            assert!(page.contains(&format!("<figure id=\"{}\">", kind.name())), "{name}");
        }
        for outside in ["src=", "href=\"http", "@import", "fetch(", "<link"] {
            assert!(!page.contains(outside), "{name} holds {outside}");
        }
        let from = format!("{} of fretwear {}</p>", results.what(), env!("CARGO_PKG_VERSION"));
        assert!(page.contains(&from), "{name} lacks {from}");
        let drawings = page.matches("<svg").count();
        assert_eq!(drawings, results.kinds().len(), "{name}");
        // No two things on a page have the same name.
        let mut ids: Vec<&str> =
            page.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        let all = ids.len();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), all, "{name}");
    }
    let run = page::report(&results("run.h5"), &file("run.h5")).unwrap();
    for expected in [
        "has reached its limit",
        "98.9913 µm",
        "Estimated error of worn volume",
        "[indenter.paraboloid]",
        "stiffness ratio M",
    ] {
        assert!(run.contains(expected), "{expected}");
    }
    let study = page::report(&results("universality/universality.h5"), &file("universality")).unwrap();
    assert!(study.contains("3 of 3 cases came out as predicted."));
    // What a file says is text, whatever it says.
    let sweep = page::report(&results("one.h5"), &file("one.h5")).unwrap();
    assert!(sweep.contains("<h1>a &lt;study&gt; &amp; its *title*</h1>") && !sweep.contains("<study>"));
}

#[test]
fn a_page_misses_no_accuracy_where_springs_are_given_by_hand() {
    let verdict = |numerics: &str| {
        let folder = tempfile::tempdir().unwrap();
        let scene = include_str!("support/base.toml").replace("springs = 16\ntolerance = 1e-2\n", numerics);
        fs::write(folder.path().join("scene.toml"), scene).unwrap();
        done(folder.path(), &["run", "scene.toml", "-o", "run.h5", "--quiet"]);
        let path = folder.path().join("run.h5");
        let estimate = RunFile::open(&path).unwrap().checkpoint.unwrap().error_estimate.unwrap();
        let page = page::report(&Results::read(&path).unwrap(), &path).unwrap();
        let verdict = page.split("<div class=\"verdict").nth(1).unwrap().split("</div>").next().unwrap();
        (verdict.to_owned(), estimate)
    };
    let (chosen, _) = verdict("accuracy = 1e-2\n");
    assert!(chosen.contains("; 0.01 was asked for."), "{chosen}");
    let (by_hand, estimate) = verdict("springs = 12\ntolerance = 1e-2\n");
    assert!(estimate > 1e-4, "an estimate of {estimate} meets the accuracy by default");
    assert!(by_hand.starts_with("\">") && by_hand.contains(" of those of the limit.</p>"), "{by_hand}");
}

#[test]
fn the_data_of_a_page_are_those_of_its_figures() {
    let results = results("run.h5");
    let page = page::report(&results, &file("run.h5")).unwrap();
    let data = page
        .split("<script type=\"application/json\">")
        .skip(1)
        .map(|rest| rest.split("</script>").next().unwrap());
    for (kind, data) in results.kinds().into_iter().zip(data) {
        let figure = results.figure(kind, None).unwrap();
        let panels: serde_json::Value = serde_json::from_str(data).unwrap();
        for (number, panel) in figure.panels().enumerate() {
            let found = &panels[number];
            assert_eq!(found["x"]["unit"].as_str().unwrap(), panel.x.unit);
            for (place, series) in panel.series.iter().enumerate() {
                let points = found["series"][place]["points"].as_array().unwrap();
                assert_eq!(points.len(), series.points.len(), "{}", kind.name());
                for (one, other) in points.iter().zip(&series.points) {
                    let value = one[1].as_f64().unwrap();
                    assert!(
                        (value - other[1]).abs() <= 1e-6 * other[1].abs() + 1e-30,
                        "{value} {}",
                        other[1]
                    );
                }
            }
        }
    }
}

/// A browser, if there is one.
fn browser() -> Option<&'static str> {
    let starts = |name: &&str| {
        Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success())
    };
    ["chromium", "chromium-browser", "google-chrome"].into_iter().find(starts)
}

#[test]
fn a_browser_shows_values_enlarges_and_goes_back() {
    let Some(browser) = browser() else {
        // Past the capture of the test harness, so that it is seen.
        let _ = std::io::stderr()
            .write_all(b"SKIPPED: no chromium, so the pages of reports were not opened in a browser\n");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    for (name, panel, expected) in [("run.h5", 2, "wear depth w: "), ("map/map.h5", 1, "amplitude U/(")] {
        let page = page::report(&results(name), &file(name)).unwrap();
        let pointer = include_str!("support/pointer.js").replace("PANEL", &panel.to_string());
        let path = folder.path().join("page.html");
        fs::write(&path, format!("{page}<script>{pointer}</script>")).unwrap();
        let profile = format!("--user-data-dir={}", folder.path().join("browser").display());
        let output = Command::new(browser)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--window-size=1000,1200",
                &profile,
                "--dump-dom",
            ])
            .arg(format!("file://{}", path.display()))
            .output()
            .unwrap();
        let page = text(&output.stdout);
        let found = page
            .split("<pre id=\"log\">")
            .nth(1)
            .unwrap_or_else(|| panic!("{name}: {}", text(&output.stderr)));
        let found = found.split("</pre>").next().unwrap();
        assert!(found.contains(expected) && !found.contains("failed"), "{name}: {found}");
        for step in ["shown: block", "enlarged: true", "wheel: true", "back: true"] {
            assert!(found.contains(step), "{name}, {step}: {found}");
        }
    }
}
