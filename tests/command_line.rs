//! What is made from the definition of the command line: completions and manual pages.

mod support;

use std::fs;
use std::io::Write;
use std::process::{Command, Stdio};

use support::command::{done, names, run, text};

/// The subcommands that the help lists.
fn subcommands() -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let help = done(folder.path(), &["--help"]);
    let list = help.split("Commands:\n").nth(1).expect("a list").split("\n\n").next().expect("its end");
    let names = list.lines().filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help");
    names.map(str::to_owned).collect()
}

/// Gives text to a program; whether it succeeds, and what it complains. None if it is not there.
fn judged(program: &str, arguments: &[&str], input: &str) -> Option<(bool, String)> {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().ok()?;
    child.stdin.take().expect("piped").write_all(input.as_bytes()).expect("written");
    let output = child.wait_with_output().expect("it ends");
    Some((output.status.success(), text(&output.stderr).to_owned()))
}

#[test]
fn every_shell_has_a_script_that_names_every_subcommand() {
    let folder = tempfile::tempdir().unwrap();
    let commands = subcommands();
    assert!(commands.len() >= 14, "{commands:?}");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = done(folder.path(), &["completions", shell]);
        for command in &commands {
            assert!(script.contains(command.as_str()), "{shell} does not complete {command}");
        }
        for option in ["resume", "max-failed", "table"] {
            assert!(script.contains(option), "{shell} does not complete --{option}");
        }
    }
    let script = done(folder.path(), &["completions", "bash"]);
    let (success, complaint) = judged("bash", &["-n"], &script).expect("bash is there");
    assert!(success && complaint.is_empty(), "{complaint}");
    assert_eq!(run(folder.path(), &["completions", "tcsh"]).status.code(), Some(2));
}

#[test]
fn every_subcommand_has_a_manual_page_that_groff_takes_without_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    done(folder, &["man", "-o", "man"]);
    let mut expected: Vec<String> = subcommands().iter().map(|name| format!("fretwear-{name}.1")).collect();
    expected.push("fretwear.1".into());
    expected.sort();
    assert_eq!(names(&folder.join("man")), expected);
    for name in &expected {
        let page = fs::read_to_string(folder.join("man").join(name)).unwrap();
        assert!(page.contains(".SH SYNOPSIS") && page.contains(".SH OPTIONS"), "{name}: {page}");
        // Where there is no groff nothing is left to judge.
        if let Some((success, complaint)) = judged("groff", &["-man", "-Tutf8", "-ww", "-z"], &page) {
            assert!(success && complaint.is_empty(), "{name}: {complaint}");
        }
    }
    let main = fs::read_to_string(folder.join("man/fretwear.1")).unwrap();
    assert_eq!(main, done(folder, &["man"]));
    assert!(main.contains("Exit codes"), "{main}");

    fs::write(folder.join("man/fretwear-run.1"), "mine").unwrap();
    let output = run(folder, &["man", "-o", "man"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("--force"));
    assert_eq!(fs::read_to_string(folder.join("man/fretwear-run.1")).unwrap(), "mine");
}
