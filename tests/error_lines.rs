//! Mistakes in every line of every file that comes along: what is refused is shown with file, line, column, the line itself and a caret.

use std::fs;
use std::path::{Path, PathBuf};

use fretwear::scene::{MapScene, Scene, Study, UniversalityStudy};

fn data(place: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(place)
}

/// Reads a text in the place of a file.
type Read = fn(&str) -> fretwear::Result<()>;

/// A file, how it is read, and the number of lines from one that is edited to the next.
type Sample = (PathBuf, Read, usize);

fn scene(text: &str) -> fretwear::Result<()> {
    Scene::from_toml(text, "file.toml").map(drop)
}

fn study(text: &str) -> fretwear::Result<()> {
    let base = data("scenes/paraboloid.toml");
    let base_text = fs::read_to_string(&base).expect("readable");
    Study::from_texts(text, "file.toml", &base_text, &base).map(drop)
}

fn map(text: &str) -> fretwear::Result<()> {
    MapScene::from_toml(text, "file.toml").map(drop)
}

fn universality(text: &str) -> fretwear::Result<()> {
    UniversalityStudy::from_toml(text, "file.toml", &data("studies")).map(drop)
}

fn files() -> Vec<Sample> {
    let scenes =
        fs::read_dir(data("scenes")).expect("the scenes").map(|entry| entry.expect("readable").path());
    let scenes = scenes.filter(|path| path.extension().is_some_and(|it| it == "toml"));
    let mut files: Vec<Sample> = scenes.map(|path| (path, scene as Read, 1)).collect();
    files.push((data("template/scene.toml"), scene, 1));
    files.push((data("studies/friction.toml"), study, 1));
    files.push((data("studies/scatter.toml"), study, 1));
    files.push((data("maps/paper.toml"), map, 1));
    // Its design of cases takes a while each time.
    files.push((data("studies/universality.toml"), universality, 53));
    files
}

/// The line with each of many mistakes.
fn mistakes(line: &str) -> Vec<String> {
    let code = line.split(" #").next().unwrap_or_default();
    if code.trim().is_empty() || line.starts_with('#') {
        return vec![];
    }
    let mut edits = vec![String::new(), format!("{code} ="), format!("q{code}")];
    if let Some((key, _)) = code.split_once(" = ") {
        let values = [
            "true",
            "-1",
            "0",
            "1e400",
            "nan",
            "\"\"",
            "\"x\"",
            "\"3 parsec\"",
            "\"1 kg\"",
            "[]",
            "[{}]",
            "{}",
            "2024-01-01",
            "0x1F",
            "\"\\u0000\"",
            "'''",
        ];
        edits.extend(values.map(|value| format!("{key} = {value}")));
        edits.push(format!("{code}\n{code}"));
        edits.push(format!("{key}s = 1"));
    } else if code.starts_with('[') {
        edits.push(code.replace('[', "[x."));
        edits.push(code.replace(']', ""));
        edits.push(format!("{code}\nqqq = 1"));
    }
    edits
}

/// `file.toml:LINE:COLUMN: ...`, then the line of that number as it stands in the text, then a caret at the column.
fn shows_its_place(message: &str, text: &str) -> bool {
    let mut parts = message.splitn(4, ':');
    let (name, line, column) = (parts.next(), parts.next(), parts.next());
    let numbers =
        line.and_then(|it| it.parse::<usize>().ok()).zip(column.and_then(|it| it.parse::<usize>().ok()));
    let (Some("file.toml"), Some((line, column))) = (name, numbers) else { return false };
    // A message may have several lines; those of the place come last.
    let lines: Vec<&str> = message.lines().collect();
    let [.., shown, caret] = &lines[..] else { return false };
    let Some((_, shown)) = shown.split_once(&format!("{line} | ")) else { return false };
    let written = text.lines().nth(line - 1).unwrap_or_default();
    let visible: String = written.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let fits = shown.contains("...") || visible.trim_end() == shown;
    fits && caret.contains('^') && column <= written.chars().count() + 1
}

/// What is TOML is refused for a key, which the message says in words as well.
fn names_its_key(error: &fretwear::Error) -> bool {
    let message = error.to_string();
    message.contains("not valid TOML")
        || error.key().is_some_and(|key| !key.is_empty() && message.contains(key))
}

#[test]
fn every_mistake_in_any_line_of_any_file_is_shown_at_its_place() {
    let (mut refused, mut taken) = (0, 0);
    for (path, read, stride) in files() {
        let text = fs::read_to_string(&path).expect("readable");
        // The files that scenes name are relative to the working directory of the test.
        let text = ["measured_profile.csv", "waviness.csv"].iter().fold(text, |text, name| {
            text.replace(&format!("\"{name}\""), &format!("\"data/scenes/{name}\""))
        });
        read(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let lines: Vec<&str> = text.lines().collect();
        for (number, line) in lines.iter().enumerate().step_by(stride) {
            for edit in mistakes(line) {
                let edited = [&lines[..number], &[edit.as_str()], &lines[number + 1..]].concat().join("\n");
                match read(&edited) {
                    Ok(()) => taken += 1,
                    Err(error) => {
                        let message = error.to_string();
                        let context =
                            format!("{}, line {} as {edit:?}\n{message}", path.display(), number + 1);
                        assert!(shows_its_place(&message, &edited), "{context}");
                        assert!(names_its_key(&error), "{:?}: {context}", error.key());
                        refused += 1;
                    }
                }
            }
        }
    }
    assert!(refused > 2000 && taken > 100, "{refused} mistakes refused, {taken} taken");
}
