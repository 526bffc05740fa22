//! Result files that are damaged, cut short, or changed by other programs: refused before anything in them is read.

mod support;

use std::collections::BTreeMap;
use std::fmt::Debug;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Command;

use fretwear::Result;
use fretwear::data::{
    Dataset, DatasetSummary, Format, ResultPath, ResultTables, RunFile, SweepFile, format_of,
};
use support::command::{done, ended, names, program, text};
use support::results::every_kind;

const SCENE: &str = r#"
[indenter.paraboloid]
radius = "10 mm"
[half_space]
grading = 0
modulus = "210 GPa"
poisson_ratio = 0.3
[friction.coulomb]
coefficient = 0.7
[wear.archard]
coefficient = "1e-8 1/MPa"
[loading]
initial_force = "10 N"
stick_ratio = 0.7
tau = 1
[numerics]
springs = 24
tolerance = 1e-2
[output]
snapshots = 6
"#;

/// SplitMix64.
struct Chance(u64);

impl Chance {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % end as u64) as usize
    }

    fn block(&mut self, length: usize) -> Range<usize> {
        let start = self.below(length);
        start..(start + 1 + self.below(2000)).min(length)
    }
}

/// The bytes of a file after one of several kinds of damage, and its name.
fn damaged(whole: &[u8], seed: u64) -> (Vec<u8>, String) {
    let mut chance = Chance(seed);
    loop {
        let mut bytes = whole.to_vec();
        let what = match seed % 8 {
            0 => {
                let flips = 1 + chance.below(4);
                (0..flips).for_each(|_| bytes[chance.below(whole.len())] ^= 1 << chance.below(8));
                "bits flipped"
            }
            1 => {
                bytes[chance.block(whole.len())].fill(0);
                "a block of zeros"
            }
            2 => {
                bytes.truncate(chance.below(whole.len()));
                "cut short"
            }
            3 => {
                let block = chance.block(whole.len());
                let from = chance.below(whole.len() - block.len());
                bytes[block.clone()].copy_from_slice(&whole[from..from + block.len()]);
                "a block of another place"
            }
            4 => {
                drop(bytes.drain(chance.block(whole.len())));
                "a block left out"
            }
            5 => {
                let (first, second) = (chance.block(whole.len()), chance.below(whole.len()));
                let length = first.len().min(whole.len() - second).min(first.start.abs_diff(second));
                (0..length).for_each(|at| bytes.swap(first.start + at, second + at));
                "blocks swapped"
            }
            6 => {
                let (place, length) = (chance.below(whole.len()), 1 + chance.below(2000));
                bytes.splice(place..place, (0..length).map(|_| chance.below(256) as u8));
                "bytes inserted"
            }
            _ => {
                // The first kilobytes hold most of what HDF5 follows.
                let place = chance.below(4000.min(whole.len()));
                bytes[place] = chance.below(256) as u8;
                "a byte near the beginning"
            }
        };
        if bytes != whole {
            return (bytes, format!("{what}, seed {seed}"));
        }
    }
}

fn folder_with_run() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.toml"), SCENE).unwrap();
    done(folder.path(), &["run", "scene.toml", "--quiet"]);
    let path = folder.path().join("scene.h5");
    (folder, path)
}

/// What a user is told; whether the words fit one of the reasons there are.
fn reasonable(message: &str, path: &Path) -> bool {
    let reasons = ["has no checksum at its end", "is damaged", "is not an HDF5 file", "is empty"];
    message.contains(&*path.file_name().unwrap().to_string_lossy())
        && reasons.iter().any(|reason| message.contains(reason))
}

#[test]
fn three_hundred_damages_are_all_told_by_the_checksum() {
    let (_folder, path) = folder_with_run();
    let whole = fs::read(&path).unwrap();
    RunFile::open(&path).expect("the whole file is read");
    for seed in 0..300 {
        let (bytes, what) = damaged(&whole, seed);
        fs::write(&path, bytes).unwrap();
        let message = ResultPath::checked(&path).map(drop).expect_err(&what).to_string();
        assert!(reasonable(&message, &path), "{what}: {message}");
    }
}

#[test]
fn every_command_refuses_a_damaged_run_with_exit_code_2_and_writes_nothing() {
    let (folder, path) = folder_with_run();
    let whole = fs::read(&path).unwrap();
    let commands: [&[&str]; 9] = [
        &["info", "scene.h5"],
        &["info", "scene.h5", "--json"],
        &["export", "scene.h5"],
        &["export", "scene.h5", "--list"],
        &["export", "scene.h5", "-o", "table.csv"],
        &["export", "scene.h5", "-o", "surface.vtkhdf"],
        &["plot", "scene.h5", "-o", "figure.svg"],
        &["report", "scene.h5", "-o", "report.html"],
        &["run", "--resume", "scene.h5"],
    ];
    for seed in 1000..1024 {
        let (bytes, what) = damaged(&whole, seed);
        fs::write(&path, &bytes).unwrap();
        for command in commands {
            let output = ended(program(folder.path(), command));
            let message = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{what}, {command:?}: {message}");
            assert!(reasonable(message, &path) && output.stdout.is_empty(), "{what}, {command:?}: {message}");
        }
        assert_eq!(names(folder.path()), ["scene.h5", "scene.toml"], "{what}");
        assert!(fs::read(&path).unwrap() == bytes, "{what}: the file is left as it is");
    }
}

#[test]
fn files_of_every_layout_are_refused_where_they_are_damaged() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("scene.toml"), SCENE).unwrap();
    let study = "scene = \"scene.toml\"\n[[axes]]\nkey = \"loading.stick_ratio\"\nvalues = [0.6, 0.7]\n";
    fs::write(at.join("study.toml"), study).unwrap();
    let map = "[map]\ngrading = [-0.5, 0, 0.5]\namplitude_ratio = { from = 0.01, to = 1, count = 5 }\n";
    fs::write(at.join("map.toml"), map).unwrap();
    done(at, &["sweep", "study.toml", "-o", "sweep", "--quiet"]);
    done(at, &["map", "map.toml", "-o", "map"]);
    let parts = names(&at.join("sweep"));
    let part = parts.iter().find(|name| name.ends_with(".h5")).expect("the shard");
    let part = at.join("sweep").join(part);
    let table = at.join("map/map.h5");
    type Reader = fn(&Path) -> Result<()>;
    let readers: [(&Path, Reader); 8] = [
        (&part, |path| SweepFile::read(path).map(drop)),
        (&part, |path| SweepFile::read_header(path).map(drop)),
        (&part, |path| ResultTables::open(path).map(drop)),
        (&part, |path| ResultTables::csv(path, None).map(drop)),
        (&table, |path| format_of(path).map(drop)),
        (&table, |path| Dataset::read(path, Format::Map).map(drop)),
        (&table, |path| DatasetSummary::read(path).map(drop)),
        (&table, |path| fretwear::figures::Results::read(path).map(drop)),
    ];
    let whole = [&part, &table].map(|path| fs::read(path).unwrap());
    for (path, read) in readers {
        read(path).expect("a whole file is read");
    }
    for seed in 0..12 {
        for (path, whole) in [&part, &table].into_iter().zip(&whole) {
            fs::write(path, damaged(whole, seed).0).unwrap();
        }
        for (place, (path, read)) in readers.into_iter().enumerate() {
            let message = read(path).expect_err("damaged").to_string();
            assert!(reasonable(&message, path), "reader {place}, seed {seed}: {message}");
        }
        let sweeps: [&[&str]; 2] =
            [&["sweep", "study.toml", "-o", "sweep", "--quiet"], &["merge", "sweep", "-o", "merged.h5"]];
        for command in sweeps {
            let output = ended(program(at, command));
            let message = text(&output.stderr);
            assert!(output.status.code() == Some(2) && reasonable(message, &part), "{command:?}: {message}");
        }
        assert!(!at.join("merged.h5").exists());
    }
}

/// What the program says with 1 GB and 5 s of computing: exit code and message, unless it ends by a signal, by a panic or without a word.
fn confined(folder: &Path, arguments: &[&str]) -> std::result::Result<(i32, String), String> {
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -v 1000000; ulimit -t 5; exec \"$0\" \"$@\""]);
    command.arg(assert_cmd::cargo::cargo_bin!("fretwear")).args(arguments).current_dir(folder);
    let output = ended(command);
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    match output.status.code() {
        Some(code @ (0 | 3)) => Ok((code, message)),
        Some(code @ (1 | 2)) if message.contains("error: ") => Ok((code, message)),
        _ => Err(format!("{}: {message}", output.status)),
    }
}

/// Damages files of every kind and has them read, with their checksum and without. Nothing is to end the program, to hold it up or to be told wrongly.
fn survey(seeds: Range<u64>) {
    // The name of a shard, so that `merge` reads it too.
    const NAME: &str = "shard-0-of-2.h5";
    const WAYS: [&[&str]; 7] = [
        &["info", NAME, "--json"],
        &["export", NAME],
        &["export", NAME, "--list"],
        &["plot", NAME, "-o", "figure.svg", "--force"],
        &["report", NAME, "-o", "report.html", "--force"],
        &["run", "--resume", NAME, "--quiet"],
        &["merge", ".", "-o", "merged.h5"],
    ];
    let folder = tempfile::tempdir().unwrap();
    let files: Vec<_> = every_kind(folder.path()).iter().map(|path| fs::read(path).unwrap()).collect();
    let judge = |seed: u64| {
        let mut chance = Chance(!seed);
        let place = chance.below(files.len());
        let (bytes, what) = damaged(&files[place], seed);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(NAME);
        fs::write(&path, bytes).unwrap();
        let fault = |way: &[&str], end: &dyn Debug| format!("FAULT {what}, file {place}, {way:?}: {end:?}");
        let way = WAYS[chance.below(7)];
        match confined(folder.path(), way) {
            Ok((2, message)) if reasonable(&message, &path) => {}
            end => return fault(way, &end),
        }
        let way = [WAYS[chance.below(6)], &["--unchecked"]].concat();
        match confined(folder.path(), &way) {
            Ok((2, message)) => {
                let ends = ["did not come to its end", "was ended by signal", "makes no sense"];
                let end = ends.into_iter().find(|end| message.contains(end));
                end.unwrap_or("refused").to_owned()
            }
            Ok((code, _)) => format!("exit code {code}"),
            end => fault(&way, &end),
        }
    };
    let mut tally = BTreeMap::<_, usize>::new();
    let halves = [0, 1].map(|half| seeds.clone().skip(half).step_by(2));
    std::thread::scope(|scope| {
        let halves = halves.map(|half| scope.spawn(|| half.map(judge).collect::<Vec<_>>()));
        let ends = halves.into_iter().flat_map(|half| half.join().expect("no panic"));
        ends.for_each(|end| *tally.entry(end).or_default() += 1);
    });
    println!("{} damages, read without the checksum: {tally:#?}", seeds.count());
    assert!(!tally.keys().any(|end| end.starts_with("FAULT")), "{tally:#?}");
}

#[test]
fn no_damage_to_any_kind_of_file_ends_the_program_or_holds_it_up() {
    survey(0..300);
}

#[test]
#[ignore = "takes minutes"]
fn ten_thousand_damages_end_no_command() {
    (0..4).for_each(|part| survey(1000 + 2500 * part..3500 + 2500 * part));
}

#[test]
fn a_file_that_another_program_has_changed_is_read_when_the_user_asks_for_it() {
    let (folder, path) = folder_with_run();
    let at = folder.path();
    let file = hdf5::File::append(&path).unwrap();
    file.new_attr::<f64>().create("roughness").unwrap().write_scalar(&1e-7).unwrap();
    file.close().unwrap();
    let info = ended(program(at, &["info", "scene.h5"]));
    let message = text(&info.stderr);
    assert_eq!(info.status.code(), Some(2), "{message}");
    assert!(message.contains("another program has opened it for writing") && message.contains("--unchecked"));
    for command in [
        &["info", "scene.h5", "--force"][..],
        &["info", "scene.h5", "--unchecked", "--json"],
        &["export", "scene.h5", "--unchecked"],
        &["export", "scene.h5", "--list", "--unchecked"],
        &["plot", "scene.h5", "-o", "figure.svg", "--unchecked"],
        &["report", "scene.h5", "-o", "report.html", "--unchecked"],
        &["run", "--resume", "scene.h5", "--unchecked"],
    ] {
        done(at, command);
    }
    let misused = ended(program(at, &["run", "scene.toml", "--unchecked", "--force"]));
    assert_eq!(misused.status.code(), Some(2), "it belongs to --resume");
}

/// What docs/files.md promises to those who check a file by other means.
#[test]
fn the_seal_is_as_documented() {
    use sha2::{Digest, Sha256};
    let (_folder, path) = folder_with_run();
    let bytes = fs::read(&path).unwrap();
    let (before, checksum) = bytes.split_at(bytes.len() - 32);
    assert_eq!(Sha256::digest(before).as_slice(), checksum);
    let head = &bytes[bytes.len() - 64..bytes.len() - 32];
    assert_eq!(&head[..16], b"fretwear-sha-256");
    assert_eq!(head[16..24], 1u64.to_le_bytes());
    assert_eq!(head[24..], (bytes.len() as u64 - 64).to_le_bytes());
}
