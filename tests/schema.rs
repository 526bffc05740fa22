//! JSON Schemas: never stricter than the program that reads the files, and with the same keys.

mod support;

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use fretwear::scene::schema::FileKind;
use fretwear::scene::{Calibration, MapScene, Scene, Study, UniversalityStudy};
use jsonschema::Validator;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use serde_json::Value;
use support::command::{done, names, run, text};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn validator(kind: FileKind) -> Validator {
    jsonschema::draft7::new(&kind.schema()).unwrap_or_else(|error| panic!("{}: {error}", kind.name()))
}

fn json(toml: &str) -> Value {
    let table: toml::Table = toml.parse().unwrap_or_else(|error| panic!("{error}\n{toml}"));
    serde_json::to_value(table).expect("TOML is JSON")
}

fn complaints(validator: &Validator, toml: &str) -> Vec<String> {
    validator.iter_errors(&json(toml)).map(|error| format!("{}: {error}", error.instance_path())).collect()
}

/// Reads a text as the program does; files that it names lie beside the scenes.
fn read(kind: FileKind, text: &str) -> Result<(), String> {
    let scenes = root().join("data/scenes");
    let read = match kind {
        FileKind::Scene => {
            let folder = scenes.display().to_string();
            let here = text.replace("file = \"measured", &format!("file = \"{folder}/measured"));
            let here = here.replace("file = \"../studies", &format!("file = \"{folder}/../studies"));
            Scene::from_toml(&here, "scene").map(drop)
        }
        FileKind::Study => {
            let base = scenes.join("paraboloid.toml");
            let scene = fs::read_to_string(&base).expect("the main scene");
            Study::from_texts(text, "study", &scene, &base).map(drop)
        }
        FileKind::Map => MapScene::from_toml(text, "map").map(drop),
        FileKind::Calibration => {
            Calibration::from_toml(text, "calibration", &root().join("data/calibration")).map(drop)
        }
        FileKind::Universality => {
            UniversalityStudy::from_toml(text, "study", &root().join("data/studies")).map(drop)
        }
    };
    read.map_err(|error| error.to_string())
}

fn shipped() -> Vec<(FileKind, PathBuf)> {
    let of = |kind, folder: &str, wanted: fn(&str) -> bool| {
        let entries = fs::read_dir(root().join("data").join(folder)).expect("the folder");
        let paths = entries.map(|entry| entry.expect("readable").path());
        let toml = move |path: &PathBuf| {
            let name = path.file_name().expect("a file").to_string_lossy().into_owned();
            name.ends_with(".toml") && wanted(&name)
        };
        paths.filter(toml).map(move |path| (kind, path)).collect::<Vec<_>>()
    };
    [
        of(FileKind::Scene, "scenes", |_| true),
        of(FileKind::Scene, "tradeoff", |_| true),
        of(FileKind::Scene, "template", |name| name == "scene.toml"),
        of(FileKind::Calibration, "template", |name| name == "calibration.toml"),
        of(FileKind::Study, "studies", |name| !name.starts_with("universality")),
        of(FileKind::Map, "maps", |_| true),
        of(FileKind::Universality, "studies", |name| name.starts_with("universality")),
        of(FileKind::Calibration, "calibration", |_| true),
    ]
    .concat()
}

#[test]
fn every_file_that_comes_along_satisfies_its_schema() {
    let files = shipped();
    assert!(files.len() >= 17, "{files:?}");
    for (kind, path) in files {
        let text = fs::read_to_string(&path).expect("readable");
        let found = complaints(&validator(kind), &text);
        assert!(found.is_empty(), "{}: {found:?}", path.display());
    }
}

const BASE: &str = r#"
[indenter.paraboloid]
radius = "10 mm"
[half_space]
grading = 0.2
modulus = "210 GPa"
reference_depth = "2 mm"
poisson_ratio = 0.3
[friction.coulomb]
coefficient = 0.6
[wear.archard]
coefficient = "1e-14 1/Pa"
[loading]
initial_force = "50 N"
amplitude = "1 um"
cycles = 1e6
"#;

/// Scenes and studies in which every table occurs.
fn every_table() -> Vec<(FileKind, String)> {
    let scene = |table: &str, text: &str| {
        (
            FileKind::Scene,
            format!("{}\n{text}", {
                let mut scene: toml::Table = BASE.parse().expect("valid");
                scene.remove(table);
                scene
            }),
        )
    };
    let loading = "initial_force = 50\namplitude = 1e-6\ncycles = 1e6\n";
    let power = "[wear.friction-power]\nscope = \"global\"\ncoefficient = 1e-14\nexponent = 0";
    let timed =
        BASE.replace("[wear.archard]\ncoefficient = \"1e-14 1/Pa\"", power) + "frequency = \"1 Hz\"\n";
    let mut all = vec![
        (FileKind::Scene, timed),
        scene("indenter", "[indenter.sphere]\nradius = 0.01"),
        scene("indenter", "[indenter.cone]\nslope = 0.01"),
        scene("indenter", "[indenter.power-law]\ncoefficient = 50\nexponent = 2"),
        scene("indenter", "[indenter.table]\nfile = \"measured_profile.csv\"\nradius_unit = \"mm\"\nprofile_unit = \"um\""),
        scene("none", "[counter_body]\nmodulus = 1e9\nreference_depth = 1\npoisson_ratio = 0.3"),
        scene("none", "[numerics]\naccuracy = 1e-3"),
        scene("none", "[output]\nsnapshots = 3"),
        scene("friction", "[friction.static-kinetic]\nstatic_coefficient = 0.7\nkinetic_coefficient = 0.6"),
        scene("friction", "[friction.load-dependent]\ncoefficient = 0.6\nexponent = -0.1"),
        scene("friction", "[friction]\ncoulomb.coefficient = 0.6\nhistory = { final_factor = 0.5, tau = 3 }"),
        scene("wear", "[wear.dissipated-energy]\ncoefficient = 1e-14"),
        scene("wear", "[wear.power-law]\ncoefficient = 1e-14\npressure_exponent = 1\nslip_exponent = 1"),
        scene("wear", "[wear.threshold]\ncoefficient = 1e-14\npressure = 1e6"),
        scene("friction", "[friction.wear-dependent]\nfirst_coefficient = 0.3\nlast_coefficient = 0.6\nenergy_density = 1e6"),
        scene("wear", "[wear.non-local]\ncoefficient = 1e-14\nlength = 1e-6"),
        scene("wear", "[wear]\narchard.coefficient = 1e-14\nhistory = { factors = [1, 2], at_tau = [0, 3] }"),
        scene("loading", &format!("[loading]\n{loading}[[loading.blocks]]\ntau = 1")),
        scene("loading", &format!("[loading]\n{loading}[loading.orbit]\ntransverse_ratio = 0.5")),
        scene("loading", &format!("[loading]\n{loading}[loading.normal_oscillation]\namplitude_ratio = 0.1\nfrequency_ratio = 2")),
        scene("loading", "[loading]\ninitial_force = 50\ncycles = 10\n[loading.path]\nfile = \"../studies/period.csv\"\ndisplacement_unit = \"um\""),
        (
            FileKind::Study,
            "scene = \"x.toml\"\n[[axes]]\nkey = \"loading.cycles\"\nvalues = [1]\n[[axes]]\nkeys = [\"half_space.grading\"]\nrows = [[1]]\n[[axes]]\n\
             key = \"half_space.modulus\"\nfrom = 1\nto = 2\ncount = 2\n[sampling]\ncount = 2\n[[sampling.variables]]\n\
             key = \"numerics.accuracy\"\ndistribution = \"normal\"\nmean = 1\ndeviation = 1\n[[sampling.variables]]\n\
             key = \"numerics.springs\"\ndistribution = \"uniform\"\nfrom = 1\nto = 2\n[[sampling.variables]]\n\
             key = \"numerics.tolerance\"\ndistribution = \"log-uniform\"\nfrom = 1\nto = 2\n[[sampling.variables]]\n\
             key = \"numerics.substeps\"\ndistribution = \"log-normal\"\nmedian = 1\nfactor = 2\n[output]\n"
                .into(),
        ),
        (FileKind::Map, fs::read_to_string(root().join("data/maps/paper.toml")).expect("readable")),
        (
            FileKind::Calibration,
            fs::read_to_string(root().join("data/calibration/ball_laws.toml")).expect("readable"),
        ),
        (
            FileKind::Universality,
            format!(
                "[tolerances]\nwithin = 1e-6\n[[media]]\nname = \"a\"\n[[wear]]\nname = \"b\"\n[[friction]]\nname = \"c\"\n[[modes]]\nname = \"d\"\n\
                 [[without]]\nlevels = [\"a\", \"b\"]\n[[cases]]\nname = \"e\"\npredicted = \"within\"\n{}",
                BASE.replace("[", "[scene.")
            ),
        ),
    ];
    all.push((FileKind::Scene, BASE.into()));
    all
}

/// The tables in a document as paths of keys and of places in arrays; patches, settings of calibrations and base scenes of universality studies are
/// left out.
fn tables(value: &Value, path: &[String], found: &mut Vec<Vec<String>>) {
    let inner = |key: &str| [path, &[key.to_owned()]].concat();
    match value {
        Value::Object(object) => {
            found.push(path.to_vec());
            let keys = object.iter().filter(|(key, _)| {
                !(path.is_empty() && *key == "scene" || ["patch", "set"].contains(&key.as_str()))
            });
            keys.for_each(|(key, value)| tables(value, &inner(key), found));
        }
        Value::Array(array) => {
            array
                .iter()
                .enumerate()
                .for_each(|(place, value)| tables(value, &inner(&place.to_string()), found));
        }
        _ => {}
    }
}

/// The schema of a table in a document; of several forms the one that is a table.
fn schema_at<'a>(schema: &'a Value, path: &[String]) -> &'a Value {
    let mut here = schema;
    for key in path {
        here = if here["items"].is_object() { &here["items"] } else { &here["properties"][key] };
        if let Some(forms) = here["anyOf"].as_array() {
            here = forms.iter().find(|form| form["properties"].is_object()).unwrap_or(here);
        }
    }
    here
}

fn insert_stranger(value: &mut Value, path: &[String]) {
    match path {
        [] => {
            value.as_object_mut().expect("a table").insert(STRANGER.into(), 1.into());
        }
        [key, rest @ ..] => {
            let inner = match value {
                Value::Array(array) => &mut array[key.parse::<usize>().expect("a place")],
                object => &mut object[key],
            };
            insert_stranger(inner, rest);
        }
    }
}

const STRANGER: &str = "qqqqqqqqqqqq";

/// The keys that the program offers where it meets one that it does not know.
fn offered(complaint: &str) -> BTreeSet<String> {
    let list = complaint.split("this version offers ").nth(1).unwrap_or_else(|| panic!("{complaint}"));
    let list = list.lines().next().unwrap_or_default().trim_end_matches(" only");
    list.replace(" or ", ", ").split(", ").map(str::to_owned).collect()
}

fn keys_of(schema: &Value) -> BTreeSet<String> {
    schema["properties"].as_object().into_iter().flat_map(|it| it.keys().cloned()).collect()
}

/// Paths of all tables of a schema, but for patches.
fn tables_of(schema: &Value, path: &str, found: &mut BTreeSet<String>) {
    if let Some(properties) = schema["properties"].as_object() {
        found.insert(path.to_owned());
        properties.iter().for_each(|(key, inner)| tables_of(inner, &format!("{path}.{key}"), found));
    }
    tables_of_items(schema, path, found);
}

fn tables_of_items(schema: &Value, path: &str, found: &mut BTreeSet<String>) {
    if schema["items"].is_object() {
        tables_of(&schema["items"], path, found);
    }
    for form in schema["anyOf"].as_array().into_iter().flatten() {
        tables_of(form, path, found);
    }
}

#[test]
fn the_schemas_and_the_program_know_the_same_keys_in_every_table() {
    // Where the keys depend on a word, such as that of a distribution, those of all words together are the schema's.
    let mut known: BTreeMap<String, (BTreeSet<String>, BTreeSet<String>)> = BTreeMap::new();
    for (kind, text) in every_table() {
        let schema = kind.schema();
        let validator = validator(kind);
        let document = json(&text);
        assert_eq!(read(kind, &text), Ok(()), "{text}");
        let mut found = vec![];
        tables(&document, &[], &mut found);
        for path in found {
            let mut edited = document.clone();
            insert_stranger(&mut edited, &path);
            let toml = toml::to_string(&edited).expect("still TOML");
            let complaint = read(kind, &toml).expect_err("a key that nobody knows");
            assert!(complaint.contains(STRANGER), "{path:?}: {complaint}");
            assert!(!validator.is_valid(&edited), "{}: {path:?} takes any key", kind.name());
            let names: Vec<&str> =
                path.iter().map(String::as_str).filter(|key| key.parse::<usize>().is_err()).collect();
            let table = format!("{}.{}", kind.name(), names.join(".")).trim_end_matches('.').to_owned();
            let entry =
                known.entry(table).or_insert_with(|| (BTreeSet::new(), keys_of(schema_at(&schema, &path))));
            entry.0.extend(offered(&complaint));
        }
    }
    for (table, (offered, of_schema)) in &known {
        assert_eq!(offered, of_schema, "{table}");
    }
    let visited: BTreeSet<String> = known.into_keys().collect();
    let mut all = BTreeSet::new();
    FileKind::ALL.iter().for_each(|kind| tables_of(&kind.schema(), kind.name(), &mut all));
    // A counter-body has the keys of a half-space, and one axis of a map those of the others.
    let missed: Vec<&String> = all.difference(&visited).collect();
    let axes = ["map.map.levels", "map.optimum.reference_depth", "map.profiles.grading"];
    assert!(missed.iter().all(|table| axes.contains(&table.as_str())), "no example of {missed:?}");
}

#[test]
fn every_key_says_what_it_is() {
    fn check(schema: &Value, path: &str, without: &mut Vec<String>) {
        for (key, inner) in schema["properties"].as_object().into_iter().flatten() {
            let path = format!("{path}.{key}");
            if inner["description"].as_str().is_none_or(str::is_empty) && inner["$ref"].is_null() {
                without.push(path.clone());
            }
            check(inner, &path, without);
            check(&inner["items"], &path, without);
        }
    }
    let mut without = vec![];
    FileKind::ALL.iter().for_each(|kind| check(&kind.schema(), kind.name(), &mut without));
    assert!(without.is_empty(), "{without:?}");
}

#[test]
fn schemas_refuse_what_an_editor_should_mark() {
    let validator = validator(FileKind::Scene);
    assert!(validator.is_valid(&json(BASE)));
    for (old, new) in [
        ("radius = \"10 mm\"", "radius = true"),
        ("radius = \"10 mm\"", "radius = \"mm\""),
        ("radius = \"10 mm\"", "radius = \"10\""),
        ("radius = \"10 mm\"", "radius = 0"),
        ("radius = \"10 mm\"", "diameter = 1"),
        ("radius = \"10 mm\"", "radius = 1\n[indenter.sphere]\nradius = 1"),
        ("grading = 0.2", "grading = 1"),
        ("grading = 0.2", ""),
        ("poisson_ratio = 0.3", "poisson_ratio = \"alike\""),
        ("poisson_ratio = 0.3", "poisson_ratio = 0.3\nstiffness_ratio = 1"),
        ("[friction.coulomb]", "[friction.coulombs]"),
        ("cycles = 1e6", "cycles = 1e6\ntau = 3"),
        ("cycles = 1e6", ""),
        ("cycles = 1e6", "cycles = 1e6\nrepeat = true"),
        ("cycles = 1e6", "cycles = 1e6\ntangential_control = \"rig\""),
        ("amplitude = \"1 um\"", "amplitude = 1e-6\nstick_ratio = 0.7"),
        ("initial_force = \"50 N\"", ""),
        ("cycles = 1e6", "cycles = 1e6\n[numerics]\nsprings = 2"),
        ("cycles = 1e6", "cycles = 1e6\n[numerics]\nstepper = \"euler\""),
        ("cycles = 1e6", "cycles = 1e6\n[output]\nsnapshots = 1\nat_tau = [1]"),
        ("[indenter.paraboloid]", "[indenters.paraboloid]"),
    ] {
        assert_eq!(BASE.matches(old).count(), 1, "{old}");
        let edited = BASE.replace(old, new);
        assert!(!validator.is_valid(&json(&edited)), "{new} passes");
        assert!(read(FileKind::Scene, &edited).is_err(), "the program takes {new}");
    }
}

/// Values as a key may have them, well and badly written.
fn value() -> impl Strategy<Value = String> {
    let values = [
        "1",
        "0",
        "-1",
        "0.5",
        "1e-6",
        "\"1 mm\"",
        "\" 2.5um \"",
        "\"1e-14 1/Pa\"",
        "\"3 N\"",
        "\"0.3\"",
        "\".5 m\"",
        "\"5. m\"",
        "\"+1 mm\"",
        "\"10\"",
        "\"similar\"",
        "\"1e3 Pa\"",
        "\"80°\"",
        "\"3/2\"",
        "\"1\u{a0}mm\"",
        "\"2 mm/mm\"",
        "\"1e-5 mm^3/(N m)\"",
        "\"\"",
        "true",
        "[1, 2]",
        "[]",
        "{}",
        "\"implicit\"",
        "\"force\"",
        "\"resolved\"",
        "\"30 s\"",
        "\"1 min\"",
        "1_000",
        "0x10",
        "[0, 0.5]",
        "\"1e+3 N\"",
        "\"0 m\"",
        "\"-0 m\"",
    ];
    prop::sample::select(values.map(str::to_owned).to_vec())
}

/// Keys of the tables of a scene and values that are right.
fn scene() -> impl Strategy<Value = String> {
    let one =
        |texts: &[&str]| prop::sample::select(texts.iter().map(|it| (*it).to_owned()).collect::<Vec<_>>());
    let indenter = one(&[
        "[indenter.paraboloid]\nradius = \"10 mm\"",
        "[indenter.sphere]\nradius = 0.01",
        "[indenter.cone]\nhalf_angle = \"85°\"",
        "[indenter.cone]\nslope = \"0.1\"",
        "[indenter.power-law]\ncoefficient = \"50 1/m\"\nexponent = 2",
        "[indenter.table]\nfile = \"measured_profile.csv\"\nradius_unit = \"mm\"\nprofile_unit = \"um\"",
    ]);
    let body = one(&[
        "grading = 0\nmodulus = \"210 GPa\"\npoisson_ratio = 0.3",
        "grading = 0\nmodulus = 1e9\nreference_depth = \"1 m\"\npoisson_ratio = \"similar\"",
        "grading = 0\nnormal_stiffness = \"2e11 N/m^2\"",
        "grading = 0\nnormal_stiffness = 2e11\nstiffness_ratio = 0.8",
    ]);
    let friction = one(&[
        "coulomb = { coefficient = 0.6 }",
        "static-kinetic = { static_coefficient = 0.6, kinetic_coefficient = 0.5 }",
        "load-dependent = { coefficient = \"0.6\", exponent = -0.2 }",
        "coulomb = { coefficient = 0.6 }\nhistory = { final_factor = 0.5, tau = 2 }",
    ]);
    let wear = one(&[
        "archard = { coefficient = \"1e-8 1/MPa\" }",
        "dissipated-energy = { coefficient = \"2e-5 mm^3/J\" }",
        "threshold = { coefficient = 1e-14, pressure = \"50 MPa\" }",
        "archard = { coefficient = 1e-14 }\nhistory = { factors = [1, 0.5], at_tau = [0, 10] }",
    ]);
    let load = one(&["indentation = \"1 um\"", "initial_force = 10", "normal_force = \"10 N\""]);
    let amplitude = one(&["amplitude = \"0.2 um\"", "amplitude_ratio = 0.5", "stick_ratio = \"0.7\""]);
    let end = one(&["cycles = 1e6", "tau = 30", "until_rate = 1e-3"]);
    let more = one(&[
        "",
        "tangential_control = \"force\"",
        "rig_stiffness = \"5 MN/m\"",
        "blocks = [{ tau = 1, amplitude_factor = 0.5 }]\nrepeat = true",
        "normal_oscillation = { amplitude_ratio = 0.1, frequency_ratio = \"3/2\", phase = \"35 deg\" }",
        "orbit = { transverse_ratio = 0.5, centre_x = \"-0 m\" }",
    ]);
    let rest = one(&[
        "",
        "[numerics]\naccuracy = 1e-3\ncheckpoint_interval = \"1 min\"",
        "[numerics]\nsprings = 12\ntolerance = \"1e-3\"\nstepper = \"cycle-jump\"",
        "[output]\nat_tau = [1, 0.5, \"2\"]",
        "[output]\nsnapshots = 3\n[counter_body]\nmodulus = 1e9\npoisson_ratio = 0.3",
    ]);
    (indenter, body, friction, wear, (load, amplitude, end, more), rest).prop_map(
        |(indenter, body, friction, wear, (load, amplitude, end, more), rest)| {
            format!(
                "{indenter}\n[half_space]\n{body}\n[friction]\n{friction}\n[wear]\n{wear}\n[loading]\n{load}\n{amplitude}\n{end}\n{more}\n{rest}\n"
            )
        },
    )
}

#[test]
fn the_schema_takes_every_scene_that_the_program_takes() {
    let validator = validator(FileKind::Scene);
    let mut runner =
        TestRunner::new(Config { cases: 3000, rng_seed: RngSeed::Fixed(7), ..Config::default() });
    let (taken, refused) = (Cell::new(0), Cell::new(0));
    // A scene, perhaps with the value of one of its lines replaced.
    let strategy = (scene(), prop::option::of((any::<prop::sample::Index>(), value())));
    let outcome = runner.run(&strategy, |(scene, edit)| {
        let mut lines: Vec<String> = scene.lines().map(str::to_owned).collect();
        if let Some((place, value)) = edit {
            let keys: Vec<usize> = (0..lines.len()).filter(|&it| lines[it].contains(" = ")).collect();
            let line = &mut lines[keys[place.index(keys.len())]];
            let key = line.split(" = ").next().unwrap_or_default().to_owned();
            *line = format!("{key} = {value}");
        }
        let text = lines.join("\n");
        match read(FileKind::Scene, &text) {
            Ok(()) => {
                taken.set(taken.get() + 1);
                let found = complaints(&validator, &text);
                prop_assert!(found.is_empty(), "{found:?}\n{text}");
            }
            Err(_) => refused.set(refused.get() + 1),
        }
        Ok(())
    });
    outcome.unwrap_or_else(|error| panic!("{error}"));
    let counts = [taken.get(), refused.get()];
    assert!(counts.iter().all(|count| *count > 500), "{counts:?} scenes taken and refused");
}

#[test]
fn the_schema_is_printed_and_kept_as_a_file_for_editors() {
    let folder = tempfile::tempdir().unwrap();
    for kind in FileKind::ALL {
        let printed: Value = serde_json::from_str(&done(folder.path(), &["schema", kind.name()])).unwrap();
        assert_eq!(printed, kind.schema());
        let path = root().join("data/schema").join(format!("{}.json", kind.name()));
        let kept = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let cure = format!("make it anew: fretwear schema {} -o {} --force", kind.name(), path.display());
        assert_eq!(serde_json::from_str::<Value>(&kept).unwrap(), printed, "{cure}");
    }
    assert_eq!(done(folder.path(), &["schema"]), done(folder.path(), &["schema", "scene"]));
    let output = run(folder.path(), &["schema", "scenes"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        text(&output.stderr).contains("scene, study, map, universality, calibration"),
        "{}",
        text(&output.stderr)
    );
}

#[test]
fn a_scene_to_begin_with_checks_and_runs_and_overwrites_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    done(folder, &["init", "-o", "scene.toml"]);
    assert_eq!(fs::read_to_string(folder.join("scene.toml")).unwrap(), done(folder, &["init"]));
    done(folder, &["check", "scene.toml"]);
    let result = support::command::object(folder, &["run", "scene.toml", "--json"]);
    assert_eq!(result["stop_reason"], "end");
    assert!(result["limit_distance_relative"].as_f64().is_some_and(|it| it < 1e-3), "{result}");

    fs::write(folder.join("scene.toml"), "mine").unwrap();
    let before = names(folder);
    let output = run(folder, &["init", "-o", "scene.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("--force"), "{}", text(&output.stderr));
    assert_eq!(
        (fs::read_to_string(folder.join("scene.toml")).unwrap().as_str(), names(folder)),
        ("mine", before)
    );
    done(folder, &["init", "-o", "scene.toml", "--force"]);
    done(folder, &["check", "scene.toml"]);
}

/// Comments that begin with `or` are alternatives: each of them stands for keys that the program knows.
#[test]
fn the_alternatives_in_the_scene_to_begin_with_are_keys_of_the_schema() {
    let folder = tempfile::tempdir().unwrap();
    let template = done(folder.path(), &["init"]);
    let schema = FileKind::Scene.schema().to_string();
    let mut count = 0;
    for line in template.lines().filter(|line| line.starts_with("# or: ")) {
        let given = line.trim_start_matches("# or: ").trim_start_matches("or ");
        let words = given.split(|c: char| !(c.is_alphanumeric() || "_-.".contains(c)));
        for word in words.filter(|word| word.contains('_') || word.contains('-')) {
            let key = word.rsplit('.').next().unwrap_or_default();
            if key.chars().all(|c| c.is_lowercase() || c == '_' || c == '-') && key.len() > 2 {
                assert!(schema.contains(&format!("\"{key}\"")), "{key} in: {line}");
                count += 1;
            }
        }
    }
    assert!(count > 15, "{count} keys");
}

/// What is found only when a run is set up, by the mesh or the contact, is shown at its key too.
#[test]
fn what_is_refused_after_reading_is_shown_at_its_line_too() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (old, new, line, words) in [
        (
            "cycles = 1e6",
            "cycles = 1e6\n[numerics]\nsprings = 3",
            "springs = 3",
            "numerics.springs = 3 is outside [8, inf)",
        ),
        (
            "cycles = 1e6",
            "cycles = 1e6\n[numerics]\nsprings = 1000000000",
            "springs = 1000000000",
            "numerics.springs: 1000000000 springs need",
        ),
        (
            "cycles = 1e6",
            "cycles = 1e12\n[numerics]\nstepper = \"every-cycle\"",
            "stepper =",
            "numerics.stepper: \"every-cycle\"",
        ),
        ("amplitude = \"1 um\"", "amplitude = 0", "amplitude = 0", "loading.amplitude: 0e0 m leaves"),
        // Where several keys decide: the table of the first.
        (
            "coefficient = \"1e-14 1/Pa\"",
            "coefficient = 1e305",
            "[wear.archard]",
            "wear: the dimensionless time per cycle",
        ),
    ] {
        assert_eq!(BASE.matches(old).count(), 1, "{old}");
        fs::write(folder.join("scene.toml"), BASE.replace(old, new)).unwrap();
        let output = run(folder, &["run", "scene.toml", "-o", "never.h5"]);
        let complaint = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{new}: {complaint}");
        let place =
            complaint.lines().find(|line| line.starts_with("error: scene.toml:")).unwrap_or(complaint);
        assert!(place.contains(words), "{new}: {complaint}");
        assert!(
            complaint.lines().any(|shown| shown.contains(" | ") && shown.contains(line)),
            "{new}: {complaint}"
        );
        assert!(complaint.contains('^') && !folder.join("never.h5").exists(), "{complaint}");
    }
}
