//! What becomes of every kind of scene at the ends of every range, one after the other and at random.
//!
//! `cargo bench --bench extremes -- matrix` goes through the kinds times the extremes, `-- random 0..3000` through random scenes, by seeds; `-- page` makes
//! docs/extremes_matrix.md of what both have written to `target/extremes`. A call goes on where the last one ended; `random 0..1500` and `random 1500..3000`
//! may run side by side. `-- show 17` prints a scene.
//!
//! A scene that has used [`PATIENCE`] of processor time is asked to stop, and counts as out of time.

#[path = "extremes/cell.rs"]
mod cell;
#[path = "extremes/judge.rs"]
mod judge;
#[path = "extremes/page.rs"]
mod page;
#[path = "../tests/support/scenes.rs"]
#[allow(dead_code, reason = "shared with the tests of generated scenes")]
mod scenes;

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

use cell::cells;
use judge::{Row, judge, judge_in_parts};
use scenes::{Length, RandomScene};

/// Processor time that a scene may take, s.
const PATIENCE: f64 = 20.0;

/// Where rows are written.
fn folder() -> PathBuf {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/target/extremes"));
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// Judges what has no row yet in a file, and writes one for each.
fn go_through(file: &Path, names: impl Iterator<Item = String>, judged: impl Fn(&str) -> Row) {
    let known = Row::read_all(file);
    for name in names {
        if known.iter().any(|row| row.name == name) {
            continue;
        }
        let lost = Row::lost(&name);
        let row = judge::watched(PATIENCE, || append(file, &lost), || judged(&name));
        println!("{}", row.written());
        append(file, &row);
    }
}

fn append(file: &Path, row: &Row) {
    let mut file = OpenOptions::new().create(true).append(true).open(file).expect("a file");
    writeln!(file, "{}", row.written()).expect("a line");
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|it| !it.starts_with('-')).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        ["random", range] => {
            let (first, last) = range.split_once("..").expect("a range of seeds");
            let [first, last]: [u64; 2] = [first, last].map(|it| it.parse().expect("a seed"));
            let file = folder().join(format!("random-{first}.csv"));
            go_through(&file, (first..last).map(|seed| seed.to_string()), |seed| {
                let random = RandomScene::new(seed.parse().expect("a seed"), Length::Extreme);
                let folder = tempfile::tempdir().expect("a folder");
                judge(seed, || random.read(folder.path()))
            });
        }
        ["matrix", ref part @ ..] => {
            let cells = cells();
            let wanted = |name: &String| part.iter().all(|it| name.contains(it));
            let file = folder().join(format!("matrix-{}.csv", part.join("-")));
            go_through(&file, cells.keys().filter(|name| wanted(name)).cloned(), |name| {
                judge_in_parts(name, &cells[name])
            });
        }
        ["page"] => page::write(&folder()),
        ["show", name] => match name.parse() {
            Ok(seed) => {
                let random = RandomScene::new(seed, Length::Extreme);
                println!("{}", random.text);
                random.files.iter().for_each(|(name, content)| println!("# {name}\n{content}"));
            }
            Err(_) => println!("{}", cells()[name]),
        },
        _ => println!("what? random FROM..TO, matrix [PART ...], page, or show NAME"),
    }
}
