//! The file of a measured profile as a user meets it: what is read, how the rest is refused, and that a result needs it no more.

mod support;

use std::fs;
use std::process::{Command, Stdio};
use std::time::Duration;

use fretwear::contact::indenter::{Indenter, TabulatedProfile};
use fretwear::data::{RunFile, StopReason};
use fretwear::scene::Scene;
use support::command::{names, object, program, run, text};

/// f = r²/(2R), R = 10 mm: in mm and µm, f = 50 r².
const ROWS: [(f64, f64); 7] =
    [(0.0, 0.0), (0.05, 0.125), (0.1, 0.5), (0.15, 1.125), (0.2, 2.0), (0.25, 3.125), (0.3, 4.5)];

fn scene(indenter: &str, rest: &str) -> String {
    format!(
        "{indenter}\n[half_space]\ngrading = 0.2\nnormal_stiffness = 1e11\n[friction.coulomb]\ncoefficient = 0.6\n\
         [wear.archard]\ncoefficient = 1e-12\n[loading]\nindentation = \"1 um\"\nstick_ratio = 0.6\n{rest}\n"
    )
}

fn table(rest: &str) -> String {
    scene("[indenter.table]\nfile = \"rows.csv\"\nradius_unit = \"mm\"\nprofile_unit = \"um\"", rest)
}

/// The rows, each with the separator given.
fn csv(separator: &str) -> String {
    ROWS.iter().map(|(r, f)| format!("{r}{separator}{f}\n")).collect()
}

fn folder_with(scene: &str, rows: impl AsRef<[u8]>) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("scene.toml"), scene).expect("the scene");
    fs::write(folder.path().join("rows.csv"), rows).expect("the rows");
    folder
}

fn read(rows: impl AsRef<[u8]>) -> fretwear::Result<Scene> {
    Scene::from_path(folder_with(&table("tau = 1"), rows).path().join("scene.toml"))
}

#[test]
fn every_way_of_writing_the_same_rows_gives_the_same_profile() {
    let plain = read(csv(",")).unwrap();
    let table = plain.table().expect("a table");
    assert_eq!((table.source(), table.heights().len(), table.largest_radius()), ("rows.csv", 7, 0.3e-3));
    assert!((table.profile(0.12e-3) / 0.72e-6 - 1.0).abs() < 1e-13);
    assert!(plain.warnings().is_empty());
    let shuffled: String = [3, 6, 0, 2, 5, 1, 4].map(|i| format!("{},{}\n", ROWS[i].0, ROWS[i].1)).concat();
    for (name, rows) in [
        ("semicolons", csv(";")),
        ("tabs", csv("\t")),
        ("blanks", csv("   ")),
        ("comma and blank", csv(", ")),
        ("order", shuffled),
        ("Windows", csv(",").replace('\n', "\r\n")),
        ("byte order mark", format!("\u{feff}{}", csv(","))),
        ("header", format!("Profilometer X-1, scan 3\nradius (mm), f (µm)\n{}", csv(","))),
        ("comments", format!("# a\n% b\n// c\n; d\n\n{}\n# e\n", csv(",").replacen('\n', "  # tip\n\n", 1))),
        ("last comma", csv(",").replace('\n', ",\n")),
        ("quotes", ROWS.map(|(r, f)| format!("\"{r}\",\"{f}\"\n")).concat()),
        ("a row twice", csv(",") + "0.1,0.5\n"),
        ("no last line end", csv(",").trim_end().into()),
        ("exponents", csv(",").replace("0.05,", "+5.0E-2,")),
        ("minus zero", csv(",").replacen("0,0", "-0,0", 1)),
    ] {
        let found = read(&rows).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(found.indenter(), plain.indenter(), "{name}");
        assert!(found.warnings().is_empty(), "{name}");
    }
    // Exactly what a scene makes of the same numbers.
    assert_eq!(table.radii()[3], 1.5e-4);
    assert_eq!(table.heights()[3], 1.125e-6);
    // Units that are left out are metres.
    let folder = folder_with(
        &scene("[indenter.table]\nfile = \"rows.csv\"", "tau = 1"),
        ROWS.map(|(r, f)| format!("{:e} {:e}\n", r * 1e-3, f * 1e-6)).concat(),
    );
    let metres = Scene::from_path(folder.path().join("scene.toml")).unwrap();
    for (metres, table) in metres.table().unwrap().heights().iter().zip(table.heights()) {
        assert!((metres - table).abs() <= 1e-15 * table);
    }
}

#[test]
fn a_tip_that_is_not_at_zero_is_subtracted_with_a_warning() {
    let raised = ROWS.map(|(r, f)| format!("{r},{}\n", f - 2.0)).concat();
    let scene = read(raised).unwrap();
    let [warning] = scene.warnings() else { panic!("{:?}", scene.warnings()) };
    assert!(warning.contains("rows.csv: f is -2 at r = 0; that height is subtracted"), "{warning}");
    assert!((scene.table().unwrap().profile(0.12e-3) / 0.72e-6 - 1.0).abs() < 1e-12);
}

#[test]
fn few_rows_within_the_contact_are_doubted() {
    let folder = folder_with(&table("tau = 1"), csv(","));
    let json = object(folder.path(), &["check", "scene.toml", "--json"]);
    assert_eq!(json["indenter"], "table rows.csv, 7 rows, radius 0 to 300 µm, f to 4.5 µm");
    let warnings = json["warnings"].as_array().unwrap();
    assert!(
        warnings.iter().any(|it| it.as_str().unwrap().contains("only 3 rows of the table lie within")),
        "{warnings:?}"
    );
    let many =
        (0..=60).map(|i| format!("{},{}\n", 0.005 * f64::from(i), 50.0 * (0.005 * f64::from(i)).powi(2)));
    let folder = folder_with(&table("tau = 1"), many.collect::<String>());
    let json = object(folder.path(), &["check", "scene.toml", "--json"]);
    assert_eq!(json["warnings"].as_array().unwrap().len(), 0, "{json}");
}

#[test]
fn a_bad_file_is_refused_with_its_line_what_stands_there_and_the_cure() {
    let replaced = |old: &str, new: &str| csv(",").replacen(old, new, 1).into_bytes();
    let cases: Vec<(Vec<u8>, &str)> = vec![
        (replaced("0.1,0.5", "0.1"), "line 3: \"0.1\" has 1 column; a row is two numbers, r and f"),
        (replaced("0.1,0.5", "0.1,0.5,7"), "line 3: \"0.1,0.5,7\" has 3 columns"),
        (replaced("0.1,0.5", "0.1,abc"), "line 3: \"0.1,abc\" has f = \"abc\", which is no number"),
        (replaced("0.1,0.5", "abc,0.5"), "line 3: \"abc,0.5\" has r = \"abc\", which is no number"),
        (replaced("0,0\n", "0 mm, 0\n"), "line 1: \"0 mm, 0\" has r = \"0 mm\", which is no number"),
        (replaced("0.1,0.5", "0.1,nan"), "line 3: \"0.1,nan\" has f = nan, which is not finite"),
        (replaced("0.1,0.5", "inf,0.5"), "line 3: \"inf,0.5\" has r = inf, which is not finite"),
        (replaced("0.1,0.5", "0.1,1e999"), "has f = 1e999, which is not finite"),
        (replaced("0.1,0.5", "-0.1,0.5"), "line 3: \"-0.1,0.5\" has a negative radius; give one flank"),
        (
            replaced("0.1,0.5", "0.1,0.5\n0.1,0.6"),
            "lines 3 and 4 give the radius 0.1 twice, with f = 0.5 and f = 0.6",
        ),
        (replaced("0,0\n", ""), "begins at the radius 0.05 (line 1); add a row for the tip, r = 0"),
        (
            replaced("0.1,0.5", "0.1,-0.5"),
            "line 3: at r = 0.1 the profile has f = -0.5, below its tip at r = 0 with f = 0 (line 1)",
        ),
        (b"0,0\n0.1,1\n0.2,2\n".to_vec(), "it has 3 rows of different radius; give from 4 to 1000000"),
        (b"0 0\n1 0\n2 0\n3 0\n".to_vec(), "every f is zero"),
        (csv(";").replace('.', ",").into_bytes(), "line 2: \"0,05;0,125\" has a decimal comma; write points"),
        (csv("\t").replace('.', ",").into_bytes(), "has a decimal comma"),
        (csv(" ").replace('.', ",").into_bytes(), "line 2: \"0,05 0,125\" has a decimal comma"),
        (b"0,00;0,00\n".to_vec(), "line 1: \"0,00;0,00\" has a decimal comma"),
        (Vec::new(), "is empty; give rows of two numbers"),
        (b"# nothing\n\n".to_vec(), "is empty"),
        (b"one\ntwo\n".to_vec(), "holds no row of two numbers, r and f; line 1 is \"one\""),
        (b"0,0\n0.1,1\n\xff\xfe\n".to_vec(), "line 3 is not UTF-8 text; save the file in UTF-8"),
        (b"\x89PNG\r\n\x1a\n\0\0\0".to_vec(), "is not text; save the profile as plain text"),
        (
            (0..1_000_001).map(|i| format!("{i} {i}\n")).collect::<String>().into_bytes(),
            "line 1000001: there are more than 1000000 rows",
        ),
        (vec![b'#'; 100_000_001], "is larger than 100000000 bytes"),
        (vec![b'1'; 1_000_000], "has 1 column"),
    ];
    for (rows, words) in cases {
        let folder = folder_with(&table("tau = 1"), &rows);
        for command in ["run", "limit", "check"] {
            let output = run(folder.path(), &[command, "scene.toml"]);
            let message = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{words}: {message}");
            assert!(message.contains("rows.csv: ") && message.contains(words), "{words}: {message}");
            assert!(message.len() < 500 && output.stdout.is_empty(), "{words}: {message}");
        }
        assert_eq!(names(folder.path()), ["rows.csv", "scene.toml"], "{words}");
    }
}

#[test]
fn a_bad_table_of_the_scene_is_refused_at_its_line() {
    let file = "file = \"rows.csv\"";
    for (old, new, words) in [
        (file, "", "indenter.table.file is missing"),
        (file, "file = 3", "indenter.table.file: expected a string"),
        (file, "file = \"\"", "indenter.table.file = \"\" is no name of a file"),
        (
            file,
            "file = \"absent.csv\"",
            "indenter.table.file: absent.csv: there is no such file; it is taken relative to the folder of",
        ),
        (file, "file = \".\"", "is a directory; name a file"),
        (file, "file = \"/dev/zero\"", "is not a regular file"),
        (file, "file = \"rows.csv\"\ncolumns = 3", "indenter.table.columns is not a key"),
        ("\"mm\"", "\"MPa\"", "indenter.table.radius_unit: expected a length"),
        ("\"mm\"", "\"2 mm\"", "indenter.table.radius_unit: the unit \"2 mm\" cannot be read"),
        ("\"mm\"", "\"\"", "give a unit of length alone, such as \"um\""),
        ("\"mm\"", "\"e3 m\"", "indenter.table.radius_unit: the unit \"e3 m\" cannot be read"),
        ("\"mm\"", "1e-3", "indenter.table.radius_unit: expected a string"),
        ("\"um\"", "\"furlong\"", "indenter.table.profile_unit"),
    ] {
        let text = table("tau = 1");
        assert_eq!(text.matches(old).count(), 1, "{old}");
        let folder = folder_with(&text.replace(old, new), csv(","));
        let output = run(folder.path(), &["check", "scene.toml"]);
        let message = self::text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{new}: {message}");
        assert!(message.contains(words), "{new}: {message}");
    }
}

#[test]
fn a_contact_that_the_table_does_not_reach_is_refused_with_the_key_and_the_radius() {
    for (old, new, words) in [
        (
            "\"1 um\"",
            "\"9 um\"",
            ["loading.indentation: ", "the table ends at 3e-4 m", "measure further out"],
        ),
        ("\"1 um\"", "\"6.5 um\"", ["indenter.table: ", "the table ends at 3e-4 m", "measure further out"]),
        (
            "indentation = \"1 um\"",
            "initial_force = \"10 kN\"",
            ["loading.initial_force: F_N/c_N = ", "the table ends at 3e-4 m", "measure further out"],
        ),
    ] {
        let folder = folder_with(&table("tau = 1").replace(old, new), csv(","));
        for command in ["run", "limit", "check"] {
            let output = run(folder.path(), &[command, "scene.toml"]);
            let message = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{new}: {message}");
            for word in words {
                assert!(message.contains(word), "{command}, {new}: {word:?} not in {message}");
            }
        }
        assert_eq!(names(folder.path()), ["rows.csv", "scene.toml"]);
    }
}

#[test]
fn the_run_of_a_tabulated_paraboloid_is_that_of_the_paraboloid() {
    let rest = "tau = 10\n[output]\nat_tau = [0.1, 1, 10]";
    let folder = folder_with(&table(rest), csv(","));
    let paraboloid = scene("[indenter.paraboloid]\nradius = \"10 mm\"", rest);
    fs::write(folder.path().join("paraboloid.toml"), paraboloid).unwrap();
    let files = ["scene", "paraboloid"].map(|name| {
        object(folder.path(), &["run", &format!("{name}.toml"), "--json"]);
        RunFile::open(&folder.path().join(format!("{name}.h5"))).unwrap()
    });
    let [table, paraboloid] = &files;
    assert_eq!(table.snapshots.len(), 4);
    assert!(paraboloid.header.table.is_none());
    let scale = LimitDepth(paraboloid).largest();
    let mut worst = 0.0f64;
    for (found, expected) in table.snapshots.iter().zip(&paraboloid.snapshots).skip(1) {
        for (found, expected) in [
            (found.wear_volume, expected.wear_volume),
            (found.contact_radius, expected.contact_radius),
            (found.normal_force, expected.normal_force),
            (found.dissipated_energy, expected.dissipated_energy),
        ] {
            worst = worst.max((found / expected - 1.0).abs());
        }
        for (found, expected) in found.wear_depth.iter().zip(&expected.wear_depth) {
            worst = worst.max((found - expected).abs() / scale);
        }
    }
    println!("{worst:e}");
    assert!(worst < 2e-10, "{worst:e}");
}

struct LimitDepth<'a>(&'a RunFile);

impl LimitDepth<'_> {
    fn largest(&self) -> f64 {
        self.0.header.limit.as_ref().unwrap().wear_depth.iter().copied().fold(0.0, f64::max)
    }
}

/// A run of about a second in very many steps.
fn long_scene() -> String {
    table(
        "cycles = 8000\n[numerics]\nstepper = \"every-cycle\"\nsprings = 48\ncheckpoint_interval = 0.01\n[output]\nsnapshots = 12",
    )
}

#[test]
fn an_interrupted_run_goes_on_without_the_file_of_the_profile_and_gives_the_same_bits() {
    let whole = folder_with(&long_scene(), csv(","));
    object(whole.path(), &["run", "scene.toml", "--json"]);
    let expected = RunFile::open(&whole.path().join("scene.h5")).unwrap();
    for pause in [100, 50, 200, 25, 400, 10, 800, 5] {
        let folder = folder_with(&long_scene(), csv(","));
        let output = folder.path().join("scene.h5");
        let mut child = program(folder.path(), &["run", "scene.toml", "--quiet"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program starts");
        std::thread::sleep(Duration::from_millis(pause));
        let _ = Command::new("kill").args(["-s", "TERM", &child.id().to_string()]).output();
        if child.wait().expect("an end").code() != Some(75) {
            // Too early or too late on this machine.
            continue;
        }
        assert_eq!(RunFile::open(&output).unwrap().stop_reason, StopReason::Interrupted);
        fs::remove_file(folder.path().join("rows.csv")).unwrap();
        fs::remove_file(folder.path().join("scene.toml")).unwrap();
        object(folder.path(), &["run", "--resume", "scene.h5", "--json"]);
        let found = RunFile::open(&output).unwrap();
        assert_eq!((found.complete, &found.header), (true, &expected.header));
        assert_eq!(found.snapshots, expected.snapshots);
        let info = run(folder.path(), &["info", "scene.h5"]);
        assert!(text(&info.stdout).contains("table rows.csv, 7 rows, radius 0 to 300 µm, f to 4.5 µm"));
        let table = found.header.table.expect("the rows");
        assert_eq!(
            Indenter::from(table),
            *Scene::from_path(whole.path().join("scene.toml")).unwrap().indenter()
        );
        return;
    }
    panic!("no interruption hit the run");
}

#[test]
fn rows_in_a_result_that_are_missing_or_damaged_are_refused() {
    let folder = folder_with(&table("tau = 1"), csv(","));
    let at = folder.path();
    object(at, &["run", "scene.toml", "--json"]);
    let edited = |name: &str, edit: &dyn Fn(&hdf5::File)| {
        fs::copy(at.join("scene.h5"), at.join(name)).unwrap();
        let file = hdf5::File::open_rw(at.join(name)).unwrap();
        edit(&file);
        file.close().unwrap();
    };
    let write = |file: &hdf5::File, name: &str, row: usize, value: f64| {
        let dataset = file.dataset(name).unwrap();
        let mut values: Vec<f64> = dataset.read_raw().unwrap();
        values[row] = value;
        dataset.write_raw(&values).unwrap();
    };
    edited("missing.h5", &|file| {
        file.unlink("table_profile").unwrap();
    });
    edited("half.h5", &|file| file.unlink("table_radius").unwrap());
    edited("nan.h5", &|file| write(file, "table_profile", 2, f64::NAN));
    edited("order.h5", &|file| write(file, "table_radius", 2, 1.0));
    edited("other.h5", &|file| write(file, "table_profile", 2, 1e-6));
    for (name, words) in [
        ("missing.h5", "is not the one that checkpoint and snapshots were computed from"),
        ("half.h5", "/table_radius is missing"),
        ("nan.h5", "/table_profile: indenter.table: row 3"),
        ("order.h5", "must increase"),
        ("other.h5", "is not the one that checkpoint and snapshots were computed from"),
    ] {
        let output = run(at, &["run", "--resume", name, "--unchecked"]);
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{name}: {message}");
        assert!(message.contains(words), "{name}: {message}");
    }
}

#[test]
fn no_bytes_make_the_reader_panic() {
    let mut seed = 7u64;
    let mut random = |below: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % below
    };
    const PARTS: [&str; 24] = [
        "0", "1", "2.5", "-1", "1e3", "nan", "inf", ",", ";", "\t", " ", "\n", "\n", "\n", "\r\n", "#", "%",
        "//", "\"", "r", "µ", "+", "1e308", "5e-324",
    ];
    for _ in 0..3000 {
        let mut rows = if random(2) == 0 { csv(",") } else { String::new() };
        for _ in 0..random(30) {
            rows.push_str(PARTS[random(PARTS.len())]);
        }
        if let Ok(scene) = read(&rows) {
            // Whatever passes for a profile gives numbers or an error.
            if let Ok(contact) = scene.contact() {
                assert!(contact.contact_radius() > 0.0 && contact.normal_force().is_finite(), "{rows}");
                let _ = fretwear::contact::closed_form::LimitingShape::from_contact(&contact);
            }
        }
    }
    assert!(TabulatedProfile::new("x", vec![0.0, 1.0, 2.0, 3.0], vec![0.0, 0.0, 0.0, 1e99]).is_ok());
}
