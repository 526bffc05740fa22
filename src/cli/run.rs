//! `fretwear run`.

use std::path::{Path, PathBuf};

use crate::data::{Mark, RunFile, check_distinct, check_own};
use crate::figures::FigureFile;
use crate::report::{self, RunReport};
use crate::run::{self, Results, Resumed};
use crate::solver::simulation::Observer;
use crate::{Result, Stop};
use clap::Args;

use super::end::{End, FAILURE, Failure, of_run};
use super::progress::RunProgress;
use super::{Settings, at, complain, error_line, plot, read, result_file, signals};

#[derive(Args)]
pub struct Run {
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
    /// Go on even if the result file does not fit its checksum or has none; what is damaged in it may go unnoticed
    #[arg(long, conflicts_with = "scene")]
    unchecked: bool,
}

/// What is to be run.
enum Ready {
    /// A run, and its result file.
    Run(Box<run::Run>, PathBuf),
    /// One that reached its end before.
    Complete(Box<Results>, PathBuf),
}

pub fn run(arguments: &Run) -> End {
    // Before anything runs: a picture that cannot be written is bad input.
    let picture =
        arguments.plot.as_ref().map(|named| run_picture(arguments, named.as_deref())).transpose()?;
    let (results, output) = match ready(arguments, &signals::stop()?)? {
        Ready::Run(run, named) => {
            let output = run.path().map_or(named, Path::to_owned);
            (execute(arguments, *run).map_err(Failure::Failed)?, output)
        }
        Ready::Complete(results, output) => {
            complain("note", &format!("{} is complete, nothing is left to do", output.display()));
            (*results, output)
        }
    };
    results.warnings().into_iter().for_each(|warning| complain("warning", &warning));
    let report = RunReport::new(&results, &output);
    let text = match (arguments.json, arguments.quiet) {
        (true, _) => report::json(&report),
        (false, true) => String::new(),
        (false, false) => report.text(),
    };
    // A run that is stopped goes on later, and is drawn then.
    if let Some(picture) = picture.filter(|_| results.is_complete())
        && let Err(error) = plot::draw_run(&output, picture)
    {
        error_line(&Failure::Failed(error));
        return Ok((text, FAILURE));
    }
    Ok((text, of_run(&results)))
}

/// Prepares a new run, or one that goes on.
fn ready(arguments: &Run, stop: &Stop) -> Result<Ready> {
    match (&arguments.scene, &arguments.resume) {
        (_, Some(file)) => {
            match run::Run::resume(result_file(file, arguments.unchecked, RunFile::open)?, stop)? {
                Resumed::Run(run) => {
                    if !arguments.quiet {
                        complain("note", &format!("goes on with the scene that is in {}", file.display()));
                    }
                    Ok(Ready::Run(run, file.clone()))
                }
                Resumed::Complete(results) => Ok(Ready::Complete(results, file.clone())),
            }
        }
        (Some(path), None) => {
            let scene = read(path, &arguments.set)?;
            let output = arguments.output.clone().unwrap_or_else(|| default_output(path));
            check_distinct(&output, path)?;
            if arguments.output.is_none() && arguments.force {
                check_own(&output, Mark::Results)?;
            }
            let run = run::Run::new(&scene, &output, arguments.force, stop).map_err(at(
                &scene,
                path,
                &arguments.set,
            ))?;
            Ok(Ready::Run(Box::new(run), output))
        }
        (None, None) => unreachable!("clap requires one of the two"),
    }
}

fn execute(arguments: &Run, run: run::Run) -> Result<Results> {
    run.warning().into_iter().for_each(|warning| complain("warning", warning));
    let mut progress = (!arguments.quiet && !arguments.json).then(RunProgress::default);
    run.execute(progress.as_mut().map(|it| it as &mut dyn Observer))
}

/// The picture of a run: the one named, or that beside the result file.
fn run_picture(arguments: &Run, named: Option<&Path>) -> Result<FigureFile> {
    let result = arguments.resume.clone().or_else(|| arguments.output.clone());
    let result = result.or_else(|| arguments.scene.as_deref().map(default_output)).unwrap_or_default();
    let path = named.map_or_else(|| result.with_extension("svg"), Path::to_owned);
    check_distinct(&path, &result)?;
    arguments.scene.as_deref().map_or(Ok(()), |scene| check_distinct(&path, scene))?;
    if named.is_none() && arguments.force {
        check_own(&path, Mark::Words(crate::figures::drawing::BEGINNING))?;
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
