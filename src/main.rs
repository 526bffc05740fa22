//! The command line: parses, calls the library, prints and exits.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use clap::{Args, Parser, Subcommand};
use fretwear::data::{DatasetSummary, Mark, ResultPath, StopReason, check_distinct, check_own};
use fretwear::figures::FigureFile;
use fretwear::report::{self, CheckReport, InfoReport, LimitReport, RunReport, TableFile};
use fretwear::run::progress::{Progress, SceneProgress};
use fretwear::run::{Resumed, RunResult, most_threads};
use fretwear::scene::{MapScene, Scene, Study};
use fretwear::solver::simulation::Observer;
use fretwear::study::sweep::{MergeReport, SweepOptions, SweepReport};
use fretwear::study::wear_map::MapReport;
use fretwear::{Error, Result};
use signal_hook::consts::SIGXFSZ;

#[path = "main/completions.rs"]
mod completions;
#[path = "main/export.rs"]
mod export;
#[path = "main/report.rs"]
mod page_report;
#[path = "main/plot.rs"]
mod plot;
#[path = "main/schema.rs"]
mod schema;
#[path = "main/submit.rs"]
mod submit;
#[path = "main/tradeoff.rs"]
mod tradeoff;
#[path = "main/universality.rs"]
mod universality;

const EXIT_CODES: &str = "Exit codes: 0 done; 1 the run failed; 2 bad usage or bad input, nothing written; \
3 done, but the accuracy asked for was not reached; 75 stopped by a signal with a checkpoint written.\nResults go to stdout, everything else to stderr.";

/// Exit code of a run that came to its end less accurately than was asked for; its results are kept.
const INACCURATE: u8 = 3;

/// Exit code of a run that a signal stopped with a checkpoint written.
const INTERRUPTED: u8 = 75;

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
    Run(Run),
    /// Evaluate the limiting shape of a scene in closed form, without stepping in time
    Limit(Limit),
    /// Run the scenes of a study, or one shard of them, in parallel; only what is missing is run
    Sweep(Sweep),
    /// Merge the shards of a sweep into one table
    Merge(Merge),
    /// Compare gradings: wear maps, the optimal grading and worn profiles in closed form
    Map(Map),
    /// Run laws, modes and media against one limit, with cases that are not to reach it
    Universality(universality::Universality),
    /// Measure error against wall time of every stepper, tolerance and number of springs on one scene
    Tradeoff(tradeoff::Tradeoff),
    /// Validate a scene and show what follows from it, without running anything
    Check(Check),
    /// Prepare a study for a cluster: measure, propose shards, write job scripts and hand them to the engine
    Submit(submit::Submit),
    /// Draw a figure from a result file
    Plot(plot::Plot),
    /// Make a page of a result file: inputs, derived quantities, verdict, and all figures
    Report(page_report::Report),
    /// Show what is in a result file and whether it is complete
    Info(Info),
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

#[derive(Args)]
struct Run {
    /// The scene, a TOML file
    #[arg(value_name = "SCENE.toml", required_unless_present = "resume", conflicts_with = "resume")]
    scene: Option<PathBuf>,
    /// Go on from the last checkpoint in this result file, which holds everything needed
    #[arg(long, value_name = "FILE.h5", conflicts_with_all = ["output", "force", "settings"])]
    resume: Option<PathBuf>,
    /// The result file; by default the scene's name with .h5, in the current directory
    #[arg(short, long, value_name = "FILE.h5")]
    output: Option<PathBuf>,
    #[command(flatten)]
    set: Settings,
    /// Print the summary as one JSON object in SI units
    #[arg(long)]
    json: bool,
    /// Show no progress and no summary
    #[arg(long)]
    quiet: bool,
    /// Draw the worn profile when the run has ended, beside the result file as SVG unless another picture is named
    #[arg(long, value_name = "FIGURE.svg|.png", num_args = 0..=1, require_equals = true)]
    plot: Option<Option<PathBuf>>,
    /// Overwrite the result file, and the picture, if they exist
    #[arg(long)]
    force: bool,
    /// Go on even if the result file does not fit its checksum or has none; a damaged one may hang or end this program
    #[arg(long, conflicts_with = "scene")]
    unchecked: bool,
}

#[derive(Args)]
struct Limit {
    /// The scene, a TOML file
    #[arg(value_name = "SCENE.toml")]
    scene: PathBuf,
    #[command(flatten)]
    set: Settings,
    /// Print one JSON object in SI units
    #[arg(long)]
    json: bool,
    /// Write radius, initial and limiting profile and wear depth, all in m, to this file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Radii of the profile, separated by commas, in m or with a unit: 0,1e-5,"20 um"
    #[arg(long, value_name = "R1,R2,...", allow_hyphen_values = true)]
    at: Option<String>,
    /// Overwrite the CSV file if it exists
    #[arg(long, requires = "csv")]
    force: bool,
}

#[derive(Args)]
struct Sweep {
    /// The study, a TOML file
    #[arg(value_name = "STUDY.toml")]
    study: PathBuf,
    /// Directory of the results, made if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Do shard I of N only, I from 0; all shards need the same N
    #[arg(long, value_name = "I/N", value_parser = shard)]
    shard: Option<(u64, u64)>,
    /// Threads, each of which runs one scene at a time; at most, and by default, one for each core
    #[arg(long, value_name = "T", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Failed scenes up to which the exit code is 0
    #[arg(long, value_name = "M", default_value_t = 0)]
    max_failed: u64,
    /// Seconds between checkpoints
    #[arg(long, value_name = "S", default_value_t = 30.0, value_parser = seconds)]
    checkpoint_interval: f64,
    /// Print the summary as one JSON object
    #[arg(long)]
    json: bool,
    /// Show no progress and no summary
    #[arg(long)]
    quiet: bool,
}

#[derive(Args)]
struct Merge {
    /// Directory of a sweep
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// The merged file
    #[arg(short, long, value_name = "FILE.h5")]
    output: PathBuf,
    /// Print the summary as one JSON object
    #[arg(long)]
    json: bool,
    /// Overwrite the merged file if it exists
    #[arg(long)]
    force: bool,
}

#[derive(Args)]
struct Map {
    /// What to compare, a TOML file; by default a paraboloid under elastic similarity
    #[arg(value_name = "MAP.toml")]
    map: Option<PathBuf>,
    /// Directory for map.h5 and its CSV tables, made if it is missing
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Overwrite files that exist
    #[arg(long)]
    force: bool,
}

#[derive(Args)]
struct Check {
    /// The scene, a TOML file
    #[arg(value_name = "SCENE.toml")]
    scene: PathBuf,
    #[command(flatten)]
    set: Settings,
    /// Print one JSON object in SI units
    #[arg(long)]
    json: bool,
}

#[derive(Args)]
struct Info {
    /// A result file that `fretwear run`, `sweep`, `merge`, `map`, `universality` or `tradeoff` wrote
    #[arg(value_name = "FILE.h5")]
    file: PathBuf,
    /// Print one JSON object in SI units
    #[arg(long)]
    json: bool,
    /// Read the file even if it does not fit its checksum or has none; a damaged one may hang or end this program
    #[arg(long, visible_alias = "force")]
    unchecked: bool,
}

fn main() -> ExitCode {
    // A file that grows beyond `ulimit -f` is then an error that names it, and not the end of the program.
    let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    let outcome = match Cli::parse().command {
        Command::Run(arguments) => run(&arguments),
        Command::Limit(arguments) => limit(&arguments).map(done),
        Command::Sweep(arguments) => sweep(&arguments),
        Command::Merge(arguments) => merge(&arguments),
        Command::Map(arguments) => map(&arguments).map(done),
        Command::Universality(arguments) => universality::universality(&arguments),
        Command::Tradeoff(arguments) => tradeoff::tradeoff(&arguments),
        Command::Check(arguments) => check(&arguments).map(done),
        Command::Submit(arguments) => submit::submit(&arguments),
        Command::Plot(arguments) => plot::plot(&arguments).map(done),
        Command::Report(arguments) => page_report::report(&arguments).map(done),
        Command::Info(arguments) => info(&arguments).map(done),
        Command::Export(arguments) => export::export(&arguments).map(done),
        Command::Init(arguments) => schema::init(&arguments).map(done),
        Command::Schema(arguments) => schema::schema(&arguments).map(done),
        Command::Completions(arguments) => Ok(done(completions::completions::<Cli>(&arguments))),
        Command::Man(arguments) => completions::man::<Cli>(&arguments).map(done),
    };
    match outcome {
        Ok((text, code)) => print(&text, code),
        Err(error) => {
            complain("error", &error.to_string());
            ExitCode::from(if matches!(error, Error::NotConverged { .. }) { 1 } else { 2 })
        }
    }
}

fn run(arguments: &Run) -> Result<(String, ExitCode)> {
    let report = |result: &RunResult| {
        let report = RunReport::new(result);
        match (arguments.json, arguments.quiet) {
            (true, _) => report::json(&report),
            (false, true) => String::new(),
            (false, false) => report.text(),
        }
    };
    // Before anything runs: a picture that cannot be written is bad input.
    let picture =
        arguments.plot.as_ref().map(|named| run_picture(arguments, named.as_deref())).transpose()?;
    let run = match (&arguments.scene, &arguments.resume) {
        (_, Some(file)) => match fretwear::run::Run::resume(result_file(file, arguments.unchecked)?)? {
            Resumed::Run(run) => {
                if !arguments.quiet {
                    complain("note", &format!("goes on with the scene that is in {}", file.display()));
                }
                *run
            }
            Resumed::Complete(result) => {
                complain("note", &format!("{} is complete, nothing is left to do", file.display()));
                picture.map(|picture| plot::draw_run(file, picture)).transpose()?;
                result.warning().into_iter().for_each(|warning| complain("warning", &warning));
                return Ok((report(&result), ended(&result)));
            }
        },
        (Some(path), None) => {
            let scene = read(path, &arguments.set)?;
            let output = arguments.output.clone().unwrap_or_else(|| default_output(path));
            check_distinct(&output, path)?;
            if arguments.output.is_none() && arguments.force {
                check_own(&output, Mark::Results)?;
            }
            fretwear::run::Run::new(&scene, &output, arguments.force).map_err(at(
                &scene,
                path,
                &arguments.set,
            ))?
        }
        (None, None) => unreachable!("clap requires one of the two"),
    };
    run.warning().into_iter().for_each(|warning| complain("warning", warning));
    let mut progress = (!arguments.quiet && !arguments.json).then(Progress::default);
    let result = run.execute(progress.as_mut().map(|it| it as &mut dyn Observer));
    drop(progress);
    let result = match result {
        Ok(result) => result,
        // The input was in order: whatever stops a run that has begun is a failure of the run.
        Err(error) => {
            complain("error", &error.to_string());
            return Ok((String::new(), ExitCode::FAILURE));
        }
    };
    result.warning().into_iter().for_each(|warning| complain("warning", &warning));
    let interrupted = result.stop_reason == StopReason::Interrupted;
    // A run that is stopped goes on later, and is drawn then.
    if let Some(picture) = picture.filter(|_| !interrupted)
        && let Err(error) = plot::draw_run(&result.output, picture)
    {
        complain("error", &error.to_string());
        return Ok((report(&result), ExitCode::FAILURE));
    }
    Ok((report(&result), if interrupted { ExitCode::from(INTERRUPTED) } else { ended(&result) }))
}

/// The exit code of a run that came to its end.
fn ended(result: &RunResult) -> ExitCode {
    if result.accuracy_met() == Some(false) { ExitCode::from(INACCURATE) } else { ExitCode::SUCCESS }
}

/// The picture of a run: the one named, or that beside the result file.
fn run_picture(arguments: &Run, named: Option<&Path>) -> Result<FigureFile> {
    let result = arguments.resume.clone().or_else(|| arguments.output.clone());
    let result = result.or_else(|| arguments.scene.as_deref().map(default_output)).unwrap_or_default();
    let path = named.map_or_else(|| result.with_extension("svg"), Path::to_owned);
    check_distinct(&path, &result)?;
    arguments.scene.as_deref().map_or(Ok(()), |scene| check_distinct(&path, scene))?;
    if named.is_none() && arguments.force {
        check_own(&path, Mark::Words(fretwear::figures::drawing::BEGINNING))?;
    }
    FigureFile::new(&path, arguments.force)
}

/// The scene's name with `.h5`, in the current directory.
fn default_output(scene: &Path) -> PathBuf {
    // Not with_extension, which would cut the stem of `k0.9.toml` once more.
    let mut name = scene.file_stem().unwrap_or_default().to_owned();
    name.push(".h5");
    name.into()
}

fn limit(arguments: &Limit) -> Result<String> {
    let scene = read(&arguments.scene, &arguments.set)?;
    let radii = arguments.at.as_deref().map(report::parse_radii).transpose()?;
    arguments.csv.as_deref().map_or(Ok(()), |path| check_distinct(path, &arguments.scene))?;
    let table = arguments.csv.as_deref().map(|path| TableFile::new(path, arguments.force)).transpose()?;
    let report =
        LimitReport::new(&scene, radii.as_deref()).map_err(at(&scene, &arguments.scene, &arguments.set))?;
    if let Some(table) = table {
        table.write(&report.csv())?;
    }
    Ok(match (arguments.json, radii) {
        (true, _) => report::json(&report),
        (false, Some(_)) => report.text() + "\n" + &report.profile_text(),
        (false, None) => report.text(),
    })
}

/// `I/N` of `--shard`.
fn shard(text: &str) -> std::result::Result<(u64, u64), String> {
    let numbers = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
    match numbers {
        Some((shard, shards)) if shard < shards => Ok((shard, shards)),
        _ => Err("write I/N with 0 <= I < N, for example 0/4".into()),
    }
}

fn seconds(text: &str) -> std::result::Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.0..=1e9).contains(&seconds) => Ok(seconds),
        _ => Err("write seconds from 0 to 1e9".into()),
    }
}

fn sweep(arguments: &Sweep) -> Result<(String, ExitCode)> {
    let study = Study::read(&arguments.study)?;
    let (shard, shards) = arguments.shard.unwrap_or((0, 1));
    let options = SweepOptions {
        shard,
        shards,
        threads: threads(arguments.threads),
        checkpoint_interval: arguments.checkpoint_interval,
    };
    let shown = !arguments.quiet && !arguments.json;
    if shown {
        complain("note", &format!("{} scenes in {shards} shards", study.count()));
    }
    let progress = shown.then(SceneProgress::default);
    let outcome =
        fretwear::study::sweep::Sweep::new(&study, &arguments.output, &options)?.execute(progress.as_ref());
    drop(progress);
    let outcome = match outcome {
        Ok(outcome) => outcome,
        // The input was in order: what stops a sweep that has begun is a failure of the sweep.
        Err(error) => {
            complain("error", &error.to_string());
            return Ok((String::new(), ExitCode::FAILURE));
        }
    };
    let report = SweepReport::new(&options, &outcome);
    let code = match &outcome.file {
        None => ExitCode::from(INTERRUPTED),
        Some(_) if outcome.failed > arguments.max_failed => {
            complain("error", &format!("{} scenes failed; their rows say why", outcome.failed));
            ExitCode::FAILURE
        }
        Some(_) => ExitCode::SUCCESS,
    };
    let text = match (arguments.json, arguments.quiet) {
        (true, _) => report::json(&report),
        (false, true) => String::new(),
        (false, false) => report.text(),
    };
    Ok((text, code))
}

fn merge(arguments: &Merge) -> Result<(String, ExitCode)> {
    let merged = fretwear::study::sweep::merge(&arguments.folder, &arguments.output, arguments.force)?;
    let report = MergeReport::new(&merged, &arguments.output);
    let code = if merged.missing_shards.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    Ok((if arguments.json { report::json(&report) } else { report.text() }, code))
}

fn map(arguments: &Map) -> Result<String> {
    let scene = arguments.map.as_deref().map(MapScene::read).transpose()?.unwrap_or_default();
    let report = MapReport::write(&scene, &arguments.output, arguments.force)?;
    Ok(if arguments.json { report::json(&report) } else { report.text() })
}

fn check(arguments: &Check) -> Result<String> {
    let scene = Scene::read_with(&arguments.scene, &arguments.set.settings)?;
    let report = CheckReport::new(&scene).map_err(at(&scene, &arguments.scene, &arguments.set))?;
    report.warnings.iter().for_each(|warning| complain("warning", warning));
    Ok(if arguments.json { report::json(&report) } else { report.text() })
}

fn info(arguments: &Info) -> Result<String> {
    let file = result_file(&arguments.file, arguments.unchecked)?;
    if let Some(summary) = DatasetSummary::read(file)? {
        return Ok(if arguments.json { report::json(&summary) } else { report::arrays_text(&summary) });
    }
    let report = InfoReport::read(file)?;
    Ok(if arguments.json { report::json(&report) } else { report.text() })
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

/// A result file, checked once for all that is read from it unless the user wants it as it is.
fn result_file(path: &Path, unchecked: bool) -> Result<ResultPath<'_>> {
    if unchecked { Ok(ResultPath::unchecked(path)) } else { ResultPath::checked(path) }
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

fn complain(kind: &str, message: &str) {
    // Nowhere is left to say that stderr is closed.
    let _ = writeln!(std::io::stderr(), "{kind}: {message}");
}

/// Prints the result; a reader that has seen enough, such as `head`, is no failure.
fn print(text: &str, code: ExitCode) -> ExitCode {
    let mut output = std::io::stdout().lock();
    match output.write_all(text.as_bytes()).and_then(|()| output.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            complain("error", &format!("stdout: {error}"));
            ExitCode::FAILURE
        }
        _ => code,
    }
}

fn done(text: String) -> (String, ExitCode) {
    (text, ExitCode::SUCCESS)
}
