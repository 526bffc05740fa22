//! docs/extremes_matrix.md, made of what became of the scenes.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use super::cell::names;
use super::judge::Row;

const ENDS: [(&str, &str); 7] = [
    ("done", "done, within the accuracy by its own estimate"),
    ("told", "done, and told that the accuracy was not reached (exit code 3)"),
    ("refused", "refused before the work (exit code 2)"),
    (
        "named",
        "ended by the contact itself, at a moment that is named: no stick is left under the force that is held, or the profile of the indenter ends (exit code 1 or 2)",
    ),
    ("failed", "failed on the way (exit code 1)"),
    ("late", "out of time"),
    ("wrong", "wrong: a panic, a number that is none, another end when resumed"),
];

fn rows(folder: &Path, begin: &str) -> Vec<Row> {
    let entries = std::fs::read_dir(folder).expect("a folder").flatten();
    let mut files: Vec<_> = entries.map(|it| it.path()).collect();
    files.sort();
    let named = |path: &&std::path::PathBuf| {
        path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(begin))
    };
    let mut rows: BTreeMap<String, Row> = BTreeMap::new();
    for row in files.iter().filter(named).flat_map(|path| Row::read_all(path)) {
        rows.insert(row.name.clone(), row);
    }
    rows.into_values().collect()
}

/// Words with the numbers, names of keys that the scene chose and places left out, so that one reason is one.
fn kind_of(why: &str) -> String {
    let why = why.split(" (numerics.springs").next().unwrap_or(why);
    let is_line = |part: &str| part.split(':').all(|it| it.parse::<usize>().is_ok());
    let place =
        |part: &&str| !part.starts_with("scene.toml") && !part.contains("/scene.toml") && !is_line(part);
    let why = why.split(": ").filter(place).collect::<Vec<_>>().join(": ");
    let is_number = |word: &str| word.trim_matches(|it: char| ",;:()".contains(it)).parse::<f64>().is_ok();
    let words = why.split(' ').map(|word| if is_number(word) { "…" } else { word });
    words.collect::<Vec<_>>().join(" ")
}

fn counts(page: &mut String, rows: &[Row]) {
    page.push_str("| end | scenes | median, 99 %, longest, s |\n|---|---|---|\n");
    for (end, words) in ENDS {
        let mut seconds: Vec<f64> = rows.iter().filter(|it| it.end == end).map(|it| it.seconds).collect();
        seconds.sort_by(f64::total_cmp);
        let at = |part: f64| seconds.get((part * (seconds.len().max(1) - 1) as f64) as usize).copied();
        let times = match (at(0.5), at(0.99), at(1.0)) {
            (Some(median), Some(most), Some(last)) => format!("{median:.2}, {most:.1}, {last:.1}"),
            _ => String::new(),
        };
        let _ = writeln!(page, "| {words} | {} | {times} |", seconds.len());
    }
}

fn reasons(page: &mut String, rows: &[Row], end: &str) {
    let mut found: BTreeMap<String, (usize, &str, f64)> = BTreeMap::new();
    for row in rows.iter().filter(|it| it.end == end) {
        let entry = found.entry(kind_of(&row.why)).or_insert((0, &row.name, row.seconds));
        entry.0 += 1;
    }
    let mut found: Vec<_> = found.into_iter().collect();
    found.sort_by_key(|(_, (count, ..))| std::cmp::Reverse(*count));
    for (why, (count, name, _)) in found {
        let _ = writeln!(page, "* {count}: {why} (such as {name})");
    }
}

pub fn write(folder: &Path) {
    let mut page = String::from(
        "# The matrix of the extremes\n\nMade by `cargo bench --bench extremes`; [At the extremes](extremes.md) tells what decides. Seconds are of processor time, of which a scene has 20.\n",
    );
    let matrix = rows(folder, "matrix");
    let _ = writeln!(
        page,
        "\n## Every kind at every extreme\n\n`-- matrix`, an accuracy of 1e-2: the usual scene is a paraboloid at k = 0 with an amplitude of half of full sliding (amplitude 0.5) to τ = 3 in 1e5 \
         cycles; every cell is run once more in two parts, which come to the same to the last bit. **d**: done; **t**: told; **r**: refused; **n**: ended by the contact itself; **F**: failed; **L**: out of time; **W**: wrong.\n"
    );
    let [kinds, extremes] = names();
    let _ = writeln!(page, "| | {} |\n|---|{}", kinds.join(" | "), "---|".repeat(kinds.len()));
    for extreme in extremes {
        let marks = kinds.iter().map(|kind| {
            let name = format!("{kind} at {extreme}");
            match matrix.iter().find(|row| row.name == name).map(|row| row.end.as_str()) {
                Some("done") => "d",
                Some("told") => "t",
                Some("refused") => "r",
                Some("named") => "n",
                Some("failed") => "**F**",
                Some("late") => "**L**",
                Some(_) => "**W**",
                None => "",
            }
        });
        let _ = writeln!(page, "| {extreme} | {} |", marks.collect::<Vec<_>>().join(" | "));
    }
    page.push('\n');
    counts(&mut page, &matrix);
    let random = rows(folder, "random");
    let seeds = || random.iter().filter_map(|row| row.name.parse::<u64>().ok());
    let [first, last] = [seeds().min(), seeds().max()].map(Option::unwrap_or_default);
    for (title, rows) in [("the matrix", &matrix), ("the random scenes", &random)] {
        if title == "the random scenes" {
            let _ = writeln!(
                page,
                "\n## {} random scenes\n\n`-- random`, seeds {first} to {last}: every indenter, medium, law, history, control, mode and block, alone and together, with contact radii from nm to km, gradings to ±0.9999, \
                 exponents from 0.1 to 20, amplitudes from 1e-10 to 100 times full sliding, ends from τ = 1e-6 to 1e5 in up to 1e12 cycles, at 1e-2, 1e-3 and 1e-4.\n",
                rows.len()
            );
            counts(&mut page, rows);
        }
        for (end, words) in [
            ("refused", "refused"),
            ("named", "ended by the contact itself"),
            ("failed", "failed"),
            ("late", "out of time"),
            ("wrong", "wrong"),
        ] {
            if rows.iter().any(|row| row.end == end) {
                let _ = writeln!(page, "\n### Why of {title} are {words}\n");
                reasons(&mut page, rows, end);
            }
        }
    }
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/extremes_matrix.md");
    std::fs::write(path, &page).expect("writable");
    println!("{page}");
}
