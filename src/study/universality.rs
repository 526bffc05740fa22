//! Laws, modes and media against one limit, with negative controls.
//!
//! \[S\] claims that the worn shape tends to Eq. (9) whatever the local law of wear, the law of friction with stick and the mode of
//! oscillation. Each case of a study is run to near its end, and its last shape compared with Eq. (9) for what *its own run* shows: the
//! permanent stick radius, which is the smallest of all snapshots, and the largest indentation of all snapshots. Whether the distance is
//! within a tolerance is compared with what was predicted.
//!
//! Cases are run in parallel, each on one core. Until all are done, each finished run is kept in a hidden directory of the program's own inside
//! `DIR`; a study that was stopped or killed goes on from there with the same command, and its results are the same to the last bit, wall times
//! aside. After the end, or an error, that directory is gone.

mod files;
mod judge;
mod report;
mod runs;

pub use judge::{Judgement, Verdict};
pub use report::UniversalityReport;

use std::path::{Path, PathBuf};
use std::time::Instant;

use crate::error::Result;
use crate::run::{Shared, Stop};
use crate::scene::{Case, Prediction, Scene, UniversalityStudy};
use crate::study::batch::{Batch, Progress, check_valid};
use runs::{Job, Runs};

/// Points of the normalised profiles between stick radius and limiting contact radius, ends included.
pub const CURVE_POINTS: usize = 101;

/// How a study is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Options {
    /// Threads; all cores if none.
    pub threads: Option<usize>,
    /// Whether files that exist may be replaced.
    pub overwrite: bool,
}

/// A case and what came of it.
#[derive(Debug, Clone, PartialEq)]
pub struct CaseResult {
    /// The case.
    pub case: Case,
    /// Where its run ended, or why it has no end.
    pub end: std::result::Result<Judgement, String>,
    /// The same with more springs and smaller steps, where the study asks for it.
    pub finer: Option<std::result::Result<Judgement, String>>,
    /// What the distance says.
    pub verdict: Verdict,
}

impl CaseResult {
    /// Whether the verdict is the one that was predicted.
    pub fn agrees(&self) -> bool {
        self.verdict
            == match self.case.predicted {
                Prediction::Within => Verdict::Obeys,
                Prediction::Outside => Verdict::Violates,
            }
    }

    /// Why its run or the finer one failed.
    pub fn error(&self) -> Option<&str> {
        match (&self.end, &self.finer) {
            (Err(why), _) | (_, Some(Err(why))) => Some(why),
            _ => None,
        }
    }

    /// Distance and worn volume of the finer run against those of the run itself: `(D' - D, V'/V - 1)`.
    pub fn refinement(&self) -> Option<[f64; 2]> {
        let (Ok(end), Some(Ok(finer))) = (&self.end, &self.finer) else { return None };
        Some([finer.distance? - end.distance?, finer.wear_volume / end.wear_volume - 1.0])
    }
}

/// What a study came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// One row for each case, in the order of the study.
    pub rows: Vec<CaseResult>,
    /// The files written.
    pub files: Vec<PathBuf>,
    /// Wall time of this call, s.
    pub wall_seconds: f64,
}

/// A study that is ready to be run.
pub struct Universality<'a> {
    study: &'a UniversalityStudy,
    folder: PathBuf,
    overwrite: bool,
    jobs: Vec<Job>,
    batch: Batch,
    started: Instant,
}

impl<'a> Universality<'a> {
    /// Reads all scenes of a study and makes sure that its results can be written.
    ///
    /// # Errors
    /// [`Error::Scene`] shows the first scenes that are not valid, and counts them; [`Error::File`] if a file exists that may not be
    /// replaced, or the directory cannot be written.
    pub fn new(study: &'a UniversalityStudy, folder: &Path, options: &Options, stop: &Stop) -> Result<Self> {
        let started = Instant::now();
        let jobs = jobs(study)?;
        let batch = Batch::new(options.threads, Shared::without_checkpoints(stop))?;
        files::check_folder(folder, options.overwrite)?;
        let (folder, overwrite) = (folder.to_owned(), options.overwrite);
        Ok(Self { study, folder, overwrite, jobs, batch, started })
    }

    /// Number of runs, those with more springs included.
    pub fn runs(&self) -> usize {
        self.jobs.len()
    }

    /// Runs all cases and writes `universality.h5` and `universality.csv`; none if it was stopped first. A case that fails is a row, not an
    /// error.
    ///
    /// # Errors
    /// [`Error::File`] if files cannot be written.
    pub fn execute(self, progress: Option<&dyn Progress>) -> Result<Option<Outcome>> {
        let Self { study, folder, jobs, batch, .. } = &self;
        let runs = Runs::new(folder, &batch.shared)?;
        let Some(ends) = batch.each(jobs, progress, |job| runs.end(job), |_, end| Ok(end))? else {
            runs.keep();
            return Ok(None);
        };
        let rows = rows(study, jobs, ends);
        let files = files::write(study, &rows, folder, self.overwrite)?;
        let wall_seconds = self.started.elapsed().as_secs_f64();
        Ok(Some(Outcome { rows, files, wall_seconds }))
    }
}

/// The runs of all cases.
fn jobs(study: &UniversalityStudy) -> Result<Vec<Job>> {
    let texts = study.cases().iter().enumerate().flat_map(|(number, case)| {
        let texts = [Some(&case.scene), case.finer.as_ref()];
        let both = texts.into_iter().zip([false, true]);
        both.filter_map(move |(text, finer)| text.map(|text| (number, case.name.as_str(), finer, text)))
    });
    let read = |(case, name, finer, text): (usize, &str, bool, &String)| -> Result<Job> {
        let scene: Scene = study.scene(name, text)?;
        Ok(Job { case, finer, scene })
    };
    let (jobs, wrong): (Vec<_>, Vec<_>) = texts.map(read).partition(Result::is_ok);
    let wrong: Vec<String> = wrong.into_iter().filter_map(Result::err).map(|it| it.to_string()).collect();
    check_valid(&wrong, (jobs.len() + wrong.len()) as u64)?;
    Ok(jobs.into_iter().flatten().collect())
}

fn rows(
    study: &UniversalityStudy,
    jobs: &[Job],
    ends: Vec<std::result::Result<Judgement, String>>,
) -> Vec<CaseResult> {
    let mut rows: Vec<CaseResult> = vec![];
    // The finer run of a case follows it.
    for (job, end) in jobs.iter().zip(ends) {
        if job.finer {
            rows.last_mut().expect("the case itself comes first").finer = Some(end);
            continue;
        }
        let verdict = Verdict::new(&end, study.tolerances());
        rows.push(CaseResult { case: study.cases()[job.case].clone(), end, finer: None, verdict });
    }
    rows
}
