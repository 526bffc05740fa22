//! The command line: parses, calls the library, prints and exits. One file a command.

use std::ffi::OsString;
use std::io::{ErrorKind, Write};
use std::path::Path;

use crate::data::ResultPath;
use crate::study::most_threads;
use crate::{Error, Result, Scene};
use clap::{Args, Parser, Subcommand};

mod calibrate;
mod check;
mod completions;
mod end;
mod export;
mod info;
mod limit;
mod map;
mod merge;
mod plot;
mod progress;
mod rehearsal;
mod report;
mod run;
mod schema;
mod signals;
mod submit;
mod sweep;
mod tradeoff;
mod universality;

use end::{EXIT_CODES, FAILURE, Failure, done};

/// Fretting wear of elastically graded media, from the first cycle to the limiting shape
#[derive(Parser)]
#[command(version, after_help = EXIT_CODES, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Simulate the wear of a scene cycle by cycle and write snapshots to an HDF5 file
    Run(run::Run),
    /// Evaluate the limiting shape of a scene in closed form, without stepping in time
    Limit(limit::Limit),
    /// Run the scenes of a study, or one shard of them, in parallel; only what is missing is run
    Sweep(sweep::Sweep),
    /// Merge the shards of a sweep into one table
    Merge(merge::Merge),
    /// Compare gradings: wear maps, the optimal grading and worn profiles in closed form
    Map(map::Map),
    /// Run laws, modes and media against one limit, with cases that are not to reach it
    Universality(universality::Universality),
    /// Measure error against wall time of every stepper, tolerance and number of springs on one scene
    Tradeoff(tradeoff::Tradeoff),
    /// Find keys of a scene from measurements, with how well they are known
    Calibrate(calibrate::Calibrate),
    /// Validate a scene and show what follows from it, without running anything
    Check(check::Check),
    /// Prepare a study for a cluster: measure, propose shards, write job scripts and hand them to the engine
    Submit(submit::Submit),
    /// Draw a figure from a result file
    Plot(plot::Plot),
    /// Make a page of a result file: inputs, derived quantities, verdict, and all figures
    Report(report::Report),
    /// Show what is in a result file and whether it is complete
    Info(info::Info),
    /// Write any table of a result file as CSV, or the worn surface of a run for ParaView
    Export(export::Export),
    /// Write a commented scene to begin with
    Init(schema::Init),
    /// Print the JSON Schema of a kind of file, for editors
    Schema(schema::Schema),
    /// Print a script with which a shell completes commands and options
    Completions(completions::Completions),
    /// Write manual pages, one for each subcommand
    Man(completions::Man),
}

#[derive(Args, Default)]
struct Settings {
    /// Give a key of the scene another value, with its unit: loading.amplitude="2 um"; what excludes the key is left out
    #[arg(long = "set", value_name = "KEY=VALUE")]
    settings: Vec<String>,
}

/// Does what the arguments ask for, of which the first is the program's name, and prints what comes of it; the exit code.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    signals::outlive_full_files();
    keep_freed_memory();
    let command = match Cli::try_parse_from(arguments) {
        Ok(asked) => asked.command,
        Err(usage) => {
            // Nowhere is left to say that stdout or stderr is closed.
            let _ = usage.print();
            return usage.exit_code() as u8;
        }
    };
    let outcome = match command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Limit(arguments) => limit::limit(&arguments).map(done).map_err(Failure::from),
        Command::Sweep(arguments) => sweep::sweep(&arguments),
        Command::Merge(arguments) => merge::merge(&arguments),
        Command::Map(arguments) => map::map(&arguments).map(done).map_err(Failure::from),
        Command::Universality(arguments) => universality::universality(&arguments),
        Command::Tradeoff(arguments) => tradeoff::tradeoff(&arguments),
        Command::Calibrate(arguments) => calibrate::calibrate(&arguments),
        Command::Check(arguments) => check::check(&arguments).map(done).map_err(Failure::from),
        Command::Submit(arguments) => submit::submit(&arguments),
        Command::Plot(arguments) => plot::plot(&arguments).map(done).map_err(Failure::from),
        Command::Report(arguments) => report::report(&arguments).map(done).map_err(Failure::from),
        Command::Info(arguments) => info::info(&arguments).map(done).map_err(Failure::from),
        Command::Export(arguments) => export::export(&arguments).map(done).map_err(Failure::from),
        Command::Init(arguments) => schema::init(&arguments).map(done).map_err(Failure::from),
        Command::Schema(arguments) => schema::schema(&arguments).map(done).map_err(Failure::from),
        Command::Completions(arguments) => Ok(done(completions::completions::<Cli>(&arguments))),
        Command::Man(arguments) => completions::man::<Cli>(&arguments).map(done).map_err(Failure::from),
    };
    match outcome {
        Ok((text, code)) => print(&text, code),
        Err(failure) => {
            error_line(&failure);
            failure.code()
        }
    }
}

/// Has the allocator keep up to 32 MB of what is freed.
///
/// That of glibc gives what is free at the end of a heap back to the system beyond 128 kB, and takes it again, page by page, for the matrices of the next
/// evaluation, which cost a quarter of a normal oscillation. Its bound is twice the largest block that it has mapped and seen freed.
fn keep_freed_memory() {
    const BYTES: usize = 1 << 24;
    drop(std::hint::black_box(Vec::<u8>::with_capacity(BYTES)));
}

/// Seconds of an option.
fn seconds(text: &str) -> std::result::Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.0..=1e9).contains(&seconds) => Ok(seconds),
        _ => Err("write seconds from 0 to 1e9".into()),
    }
}

/// Threads asked for, as many of them as there are cores.
fn threads(asked: Option<u16>) -> Option<usize> {
    let most = most_threads();
    let asked = asked.map(usize::from);
    if let Some(asked) = asked.filter(|asked| *asked > most) {
        complain(
            "note",
            &format!("--threads {asked}: this process may use {most} cores, so {most} threads are started"),
        );
    }
    asked.map(|asked| asked.min(most))
}

/// A result file, checked once for all that is read from it; or as it is, where the user wants that and another process could read it.
fn result_file<'a, T>(
    path: &'a Path,
    unchecked: bool,
    read: impl FnOnce(ResultPath<'a>) -> Result<T>,
) -> Result<ResultPath<'a>> {
    if !unchecked {
        return ResultPath::checked(path);
    }
    let file = ResultPath::unchecked(path);
    rehearsal::survived(path, || drop(read(file)))?;
    Ok(file)
}

/// Reads a scene and passes its warnings on.
fn read(path: &Path, set: &Settings) -> Result<Scene> {
    let scene = Scene::read_with(path, &set.settings)?;
    scene.warnings().iter().for_each(|warning| complain("warning", warning));
    Ok(scene)
}

/// Shows an error at its line of the scene.
fn at<'a>(scene: &'a Scene, path: &Path, set: &Settings) -> impl Fn(Error) -> Error + 'a {
    let name = Scene::name_with(path, &set.settings);
    move |error| scene.locate(error, &name)
}

/// Says something on stderr.
fn complain(kind: &str, message: &str) {
    // Nowhere is left to say that stderr is closed.
    let _ = writeln!(std::io::stderr(), "{kind}: {message}");
}

/// Says why a command came to no end.
fn error_line(failure: &Failure) {
    complain("error", &failure.words());
}

/// Prints the result; a reader that has seen enough, such as `head`, is no failure.
fn print(text: &str, code: u8) -> u8 {
    let mut output = std::io::stdout().lock();
    match output.write_all(text.as_bytes()).and_then(|()| output.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            complain("error", &format!("stdout: {error}"));
            FAILURE
        }
        _ => code,
    }
}
