//! Every command that writes, through what file systems do to it: nothing of the user's is lost, nothing half written stands under its final name,
//! and the message names the path. `.ci/faults` has the cells that need root or many seconds; docs/faults.md has all.

mod support;

use std::fs;
use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::Output;

use support::command::{names, program, run, text};

const SCENE: &str = include_str!("support/base.toml");
const STUDY: &str =
    "scene = \"scene.toml\"\n[[axes]]\nkey = \"friction.coulomb.coefficient\"\nvalues = [0.3, 0.5]\n";
const CASES: &str = "scene = \"scene.toml\"\n[[cases]]\nname = \"one\"\npredicted = \"outside\"\n";
const ALPHA: &str = "[[unknowns]]\nkey = \"wear.dissipated-energy.coefficient\"\nfrom = 1e-17\nto = 1e-11\n[[data]]\nfile = \"energies.csv\"\ndissipated_energy = \"E\"\nwear_volume = \"V\"\n";
const ENERGIES: &str = "E,V\n1,2e-14\n2,3.9e-14\n3,6.1e-14\n";
const USERS: &str = "the user's own, for years\n";

/// A command that writes one file; `@` stands for it.
const FILES: [(&str, &str); 10] = [
    ("run scene.toml --quiet -o @", "out.h5"),
    ("run scene.toml --quiet -o run2.h5 --plot=@", "out.svg"),
    ("limit scene.toml --csv @", "out.csv"),
    ("merge swept -o @", "out.h5"),
    ("plot run.h5 -o @", "out.svg"),
    ("report run.h5 -o @", "out.html"),
    ("export run.h5 -o @", "out.csv"),
    ("export run.h5 -o @", "out.vtkhdf"),
    ("init -o @", "out.toml"),
    ("schema -o @", "out.json"),
];

/// A command that writes several files into a directory, one of them, and its exit code.
const FOLDERS: [(&str, &str, i32); 6] = [
    ("map -o @", "profiles.csv", 0),
    ("universality cases.toml --quiet -o @", "universality.csv", 0),
    (
        "tradeoff scene.toml --springs 12,24 --tolerances 1e-2 --accuracies 1e-2 --steppers implicit --repeats 1 --quiet -o @",
        "tradeoff.json",
        0,
    ),
    ("submit study.toml --engine slurm --dry-run -o @", "sweep.sbatch", 0),
    ("man -o @", "fretwear-run.1", 0),
    ("calibrate alpha.toml --predict scene.toml --draws 20 --quiet -o @", "forecast.csv", 0),
];

/// A folder with everything that commands read.
struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        for (name, text) in [
            ("scene.toml", SCENE),
            ("study.toml", STUDY),
            ("cases.toml", CASES),
            ("alpha.toml", ALPHA),
            ("energies.csv", ENERGIES),
        ] {
            fs::write(place.at(name), text).unwrap();
        }
        for command in ["run scene.toml -o run.h5 --quiet", "sweep study.toml -o swept --quiet"] {
            place.call(command, "", 0);
        }
        place
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn words(command: &str, target: &str) -> Vec<String> {
        command.split(' ').map(|word| word.replace('@', target)).collect()
    }

    /// Runs a command that must end with this exit code; what it said.
    fn call(&self, command: &str, target: &str, code: i32) -> String {
        let words = Self::words(command, target);
        let output = run(self.0.path(), &words.iter().map(String::as_str).collect::<Vec<_>>());
        self.judged(command, &output, code)
    }

    fn judged(&self, command: &str, output: &Output, code: i32) -> String {
        let said = text(&output.stderr).to_owned();
        assert_eq!(output.status.code(), Some(code), "{command}: {said}");
        for folder in ["", "out", "swept"].map(|it| self.at(it)).into_iter().filter(|it| it.is_dir()) {
            let hidden = names(&folder).into_iter().find(|name| name.starts_with('.'));
            assert_eq!(hidden, None, "{command} left it in {}", folder.display());
        }
        said
    }

    /// As [`Place::call`] of a command that must be refused with the path.
    fn refused(&self, command: &str, target: &str) {
        let said = self.call(command, target, 2);
        assert!(said.contains(target), "{command} does not tell {target}: {said}");
    }

    fn forced(command: &str) -> String {
        format!("{command} --force")
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.at(name)).unwrap_or_default()
    }

    fn fifo(&self, name: &str) {
        let made = std::process::Command::new("mkfifo").arg(self.at(name)).status().unwrap();
        assert!(made.success());
    }
}

/// One place for all faults of a command, which leaves it as it was.
fn for_each_file(fault: impl Fn(&Place, &str, &str)) {
    let place = Place::new();
    for (command, target) in FILES {
        let _ = fs::remove_file(place.at("run2.h5"));
        fault(&place, command, target);
        let _ = fs::remove_file(place.at(target));
    }
}

#[test]
fn a_file_of_the_users_is_replaced_by_its_name_and_force_only() {
    for_each_file(|place, command, target| {
        fs::write(place.at(target), USERS).unwrap();
        fs::set_permissions(place.at(target), fs::Permissions::from_mode(0o600)).unwrap();
        place.refused(command, target);
        assert_eq!(place.read(target), USERS, "{command}");
        place.call(&Place::forced(command), target, 0);
        assert_ne!(fs::read(place.at(target)).unwrap(), USERS.as_bytes(), "{command}");
        let mode = fs::metadata(place.at(target)).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode, 0o600, "{command}: who may read it is the user's choice");
    });
}

#[test]
fn directories_fifos_and_devices_stay_what_they_are() {
    for_each_file(|place, command, target| {
        let forced = Place::forced(command);
        fs::create_dir_all(place.at(target).join("2023")).unwrap();
        place.refused(&forced, target);
        assert_eq!(names(&place.at(target)), ["2023"], "{command}");
        fs::remove_dir_all(place.at(target)).unwrap();
        place.fifo(target);
        place.refused(&forced, target);
        assert!(fs::symlink_metadata(place.at(target)).unwrap().file_type().is_fifo(), "{command}");
        fs::remove_file(place.at(target)).unwrap();
        // The name tells some commands what to write, so that the device is behind a link.
        symlink("/dev/null", place.at(target)).unwrap();
        place.refused(&forced, target);
        assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device(), "{command}");
    });
}

#[test]
fn links_are_followed_and_stay() {
    for_each_file(|place, command, target| {
        fs::write(place.at("users"), USERS).unwrap();
        symlink("users", place.at(target)).unwrap();
        place.refused(command, target);
        assert_eq!(place.read("users"), USERS, "{command}");
        fs::remove_file(place.at("users")).unwrap();
        // Now it leads to nothing: that is where the file is made.
        place.call(command, target, 0);
        assert!(fs::symlink_metadata(place.at(target)).unwrap().is_symlink(), "{command}");
        assert!(fs::metadata(place.at("users")).unwrap().len() > 200, "{command}");
        fs::remove_file(place.at("users")).unwrap();
        fs::remove_file(place.at(target)).unwrap();
        let nowhere = format!("none/{target}");
        place.refused(command, &nowhere);
    });
}

#[test]
fn a_file_that_grows_too_large_is_an_error_with_its_path() {
    /// More than a marker, less than any result.
    const LIMIT: libc::rlimit = libc::rlimit { rlim_cur: 512, rlim_max: 512 };
    for_each_file(|place, command, target| {
        let before = names(place.0.path());
        let words = Place::words(command, target);
        let mut child = program(place.0.path(), &words.iter().map(String::as_str).collect::<Vec<_>>());
        // SAFETY: one system call, between fork and exec.
        unsafe {
            child.pre_exec(|| {
                if libc::setrlimit(libc::RLIMIT_FSIZE, &LIMIT) == 0 {
                    Ok(())
                } else {
                    Err(std::io::Error::last_os_error())
                }
            })
        };
        let output = child.output().unwrap();
        let code = output.status.code().unwrap_or_else(|| panic!("{command}: {:?}", output.status));
        assert!([1, 2].contains(&code), "{command}: {code}");
        let said = place.judged(command, &output, code);
        let told = if command.contains("--plot") { "run2.h5" } else { target };
        assert!(said.contains(told), "{command}: {said}");
        assert_eq!(names(place.0.path()), before, "{command}");
    });
}

#[test]
fn what_lies_in_a_directory_of_results_stays() {
    let place = Place::new();
    let kept = [
        "runs/2023/thesis.h5",
        "parts/notes.txt",
        "parts/scene-0.h5",
        "parts/scene-1.0123456789ab.h5",
        "log/diary.txt",
        "thesis.h5",
        ".out.h5.1.tmp",
    ];
    for (command, _, code) in FOLDERS.into_iter().chain([("sweep study.toml --quiet -o @", "", 0)]) {
        for name in kept {
            fs::create_dir_all(place.at("out").join(name).parent().unwrap()).unwrap();
            fs::write(place.at("out").join(name), USERS).unwrap();
        }
        // A whole run of the user's, under the name of a checkpoint.
        fs::copy(place.at("run.h5"), place.at("out/parts/scene-0.aaaaaaaaaaaa.h5")).unwrap();
        let words = Place::words(command, "out");
        let output = run(place.0.path(), &words.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(code), "{command}: {}", text(&output.stderr));
        for name in kept {
            assert_eq!(place.read(&format!("out/{name}")), USERS, "{command}: {name}");
        }
        assert!(place.at("out/parts/scene-0.aaaaaaaaaaaa.h5").exists(), "{command}");
        let hidden: Vec<_> = names(&place.at("out")).into_iter().filter(|it| it.starts_with(".f")).collect();
        assert!(hidden.is_empty(), "{command}: {hidden:?}");
        fs::remove_dir_all(place.at("out")).unwrap();
    }
}

#[test]
fn in_a_directory_only_own_files_are_replaced() {
    let place = Place::new();
    for (command, name, code) in FOLDERS {
        let (path, forced) = (format!("out/{name}"), Place::forced(command));
        fs::create_dir(place.at("out")).unwrap();
        fs::write(place.at(&path), USERS).unwrap();
        for command in [command, &forced] {
            let said = place.call(command, "out", 2);
            assert!(said.contains(name), "{command}: {said}");
            assert_eq!(names(&place.at("out")), [name], "{command}");
            assert_eq!(place.read(&path), USERS, "{command}");
        }
        fs::remove_file(place.at(&path)).unwrap();
        place.call(command, "out", code);
        place.call(command, "out", 2);
        place.call(&forced, "out", code);
        assert_ne!(place.read(&path), USERS, "{command}");
        fs::remove_dir_all(place.at("out")).unwrap();
    }
}

#[test]
fn a_directory_of_results_must_be_one() {
    let place = Place::new();
    for (command, _, _) in FOLDERS.into_iter().chain([("sweep study.toml --quiet -o @", "", 0)]) {
        fs::write(place.at("out"), USERS).unwrap();
        place.refused(command, "out");
        assert_eq!(place.read("out"), USERS, "{command}");
        fs::remove_file(place.at("out")).unwrap();
        symlink("absent", place.at("out")).unwrap();
        place.refused(command, "out");
        fs::remove_file(place.at("out")).unwrap();
        place.fifo("out");
        place.refused(command, "out");
        fs::remove_file(place.at("out")).unwrap();
        place.refused(command, "/dev/null");
        let before = names(place.0.path());
        assert!(!before.contains(&"absent".to_owned()) && !before.contains(&"out".to_owned()), "{before:?}");
    }
}

#[test]
fn names_that_nobody_gave_are_replaced_only_where_they_are_own() {
    let place = Place::new();
    for (command, name) in [
        ("run scene.toml --quiet --force", "scene.h5"),
        ("run scene.toml --quiet -o new.h5 --plot --force", "new.svg"),
    ] {
        fs::write(place.at(name), USERS).unwrap();
        let said = place.call(command, "", 2);
        assert!(said.contains(name) && said.contains("not written by fretwear"), "{said}");
        assert_eq!(place.read(name), USERS);
        fs::remove_file(place.at(name)).unwrap();
        place.call(command, "", 0);
        place.call(command, "", 0);
    }
}

#[test]
fn no_output_is_the_file_that_is_read() {
    let place = Place::new();
    symlink("scene.toml", place.at("link.toml")).unwrap();
    fs::copy(place.at("run.h5"), place.at("run.svg")).unwrap();
    fs::copy(place.at("run.h5"), place.at("run.csv")).unwrap();
    for (command, target) in [
        ("run scene.toml -o @ --force", "scene.toml"),
        ("run scene.toml -o @ --force", "link.toml"),
        ("limit scene.toml --csv @ --force", "scene.toml"),
        ("report run.h5 -o @ --force", "run.h5"),
        ("plot run.svg -o @ --force", "run.svg"),
        ("export run.csv -o @ --force", "run.csv"),
        ("run scene.toml -o run.svg --plot --force", "run.svg"),
        ("merge swept -o @ --force", "swept/shard-0-of-1.h5"),
    ] {
        let before = fs::read(place.at(target)).unwrap();
        place.refused(command, target);
        assert!(fs::read(place.at(target)).unwrap() == before, "{command}");
    }
}

#[test]
fn kept_runs_are_outputs_like_others() {
    let place = Place::new();
    let command = FOLDERS[2].0.to_owned() + " --keep-runs";
    fs::create_dir_all(place.at("out/runs/2023")).unwrap();
    fs::write(place.at("out/runs/candidate1.h5"), USERS).unwrap();
    for command in [command.clone(), Place::forced(&command)] {
        let said = place.call(&command, "out", 2);
        assert!(said.contains("candidate1.h5"), "{said}");
        assert_eq!(place.read("out/runs/candidate1.h5"), USERS);
    }
    fs::rename(place.at("out/runs/candidate1.h5"), place.at("out/runs/2023/thesis.h5")).unwrap();
    place.call(&command, "out", 0);
    assert_eq!(place.read("out/runs/2023/thesis.h5"), USERS);
    let found = names(&place.at("out/runs"));
    assert_eq!(found.iter().filter(|name| name.starts_with("candidate")).count(), 5, "{found:?}");
}

#[test]
fn a_merge_or_a_submission_replaces_no_file_of_something_else() {
    let place = Place::new();
    fs::create_dir(place.at("out")).unwrap();
    fs::write(place.at("out/merged.h5"), USERS).unwrap();
    let submit = FOLDERS[3].0;
    assert!(place.call(submit, "out", 2).contains("merged.h5"));
    assert_eq!(names(&place.at("out")), ["merged.h5"]);
    // The merge of this very study may be made anew by its job.
    place.call("merge swept -o out/merged.h5 --force", "", 0);
    place.call(submit, "out", 0);
    assert!(Path::new(&place.at("out/submit.sh")).exists());
}
