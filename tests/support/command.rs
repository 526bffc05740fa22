//! The program as a user calls it.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use serde_json::Value;

/// The keys of the JSON of `run`.
pub const RUN_KEYS: [&str; 24] = [
    "output",
    "stop_reason",
    "regime",
    "fretting_regime",
    "error_estimate",
    "accuracy_met",
    "cycles",
    "tau",
    "steps",
    "rejected_steps",
    "rate_evaluations",
    "wall_seconds",
    "indentation",
    "normal_force",
    "contact_radius",
    "stick_radius",
    "wear_volume",
    "wear_depth_max",
    "wear_volume_limit",
    "limit_distance",
    "limit_distance_relative",
    "dissipated_energy",
    "energy_ratio",
    "sliding_ratio",
];

/// The program in a folder of its own, without a terminal.
pub fn program(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("fretwear"));
    command.current_dir(folder).args(arguments).stdin(Stdio::null());
    command
}

/// What it answers.
pub fn run(folder: &Path, arguments: &[&str]) -> Output {
    program(folder, arguments).output().expect("the program starts")
}

pub fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

/// Runs a command that must succeed; what it writes to stdout.
pub fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
    text(&output.stdout).to_owned()
}

/// Runs a command that must succeed; its one JSON object.
pub fn object(folder: &Path, arguments: &[&str]) -> Value {
    let found = done(folder, arguments);
    serde_json::from_str(&found).unwrap_or_else(|error| panic!("{arguments:?}: {error}\n{found}"))
}

/// The names in a folder, sorted.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder");
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Its answer, which must come: a program that does not end is killed, and fails the test.
pub fn ended(mut command: Command) -> Output {
    const PATIENCE: Duration = Duration::from_secs(60);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the program starts");
    let process = child.id().to_string();
    let (sender, receiver) = std::sync::mpsc::channel();
    std::thread::spawn(move || sender.send(child.wait_with_output()));
    match receiver.recv_timeout(PATIENCE) {
        Ok(output) => output.expect("an answer"),
        Err(_) => {
            let _ = Command::new("kill").args(["-9", &process]).status();
            panic!("{command:?} does not end");
        }
    }
}
