//! What a page says besides its figures, for each kind of result file.

use std::path::Path;

use super::{Part, Section, Verdict};
use crate::data::{Dataset, LimitDistance, SweepFile, Values, Variable};
use crate::error::Result;
use crate::figures::{Results, RunResults};
use crate::report::{CheckReport, InfoReport, number};
use crate::units::unit_in_words;

/// Rows of a sweep that a page shows.
const MOST_ROWS: usize = 500;
/// Words of the columns of a table.
const CASE_COLUMNS: [&str; 3] = ["name", "predicted", "verdict"];

pub(super) struct Content {
    pub title: String,
    pub program_version: String,
    pub verdict: Verdict,
    /// Before the figures, and after them.
    pub above: Vec<Section>,
    pub below: Vec<Section>,
}

pub(super) fn of(results: &Results, path: &Path) -> Result<Content> {
    match results {
        Results::Run(run) => of_run(run, path),
        Results::Sweep(file) => Ok(of_sweep(file)),
        Results::Map(file) => Ok(of_map(file)),
        Results::Universality(file) => of_universality(file),
        Results::Tradeoff(file) => Ok(of_tradeoff(file)),
        Results::Calibration(file) => of_calibration(file),
    }
}

fn titled(title: &str, otherwise: &str) -> String {
    if title.is_empty() { otherwise.into() } else { title.into() }
}

fn of_run(results: &RunResults, path: &Path) -> Result<Content> {
    let check = CheckReport::derived(&results.scene)?;
    let info = InfoReport::new(path, &results.run);
    let mut derived = vec![Part::Rows(check.table().lines)];
    derived.extend(check.warnings.iter().map(|warning| Part::Sentence(format!("Note: {warning}."))));
    Ok(Content {
        title: titled(results.run.header.title.as_deref().unwrap_or_default(), "A run"),
        program_version: results.run.program_version.clone(),
        verdict: verdict(results),
        above: vec![
            Section { heading: "Outcome", parts: vec![Part::Rows(info.table().lines)] },
            Section { heading: "What follows from the scene", parts: derived },
        ],
        below: vec![Section { heading: "Scene", parts: vec![Part::Text(results.run.header.scene.clone())] }],
    })
}

/// How far a run came.
fn verdict(results: &RunResults) -> Verdict {
    let run = &results.run;
    let Some(last) = run.snapshots.last() else {
        return Verdict { sentences: vec!["The file holds no snapshot.".into()], doubtful: true };
    };
    let numerics = results.scene.numerics();
    let estimate = run.checkpoint.as_ref().and_then(|checkpoint| checkpoint.error_estimate);
    let distance =
        run.header.limit.as_ref().and_then(|limit| LimitDistance::new(limit, last).distance_relative);
    let mut sentences = vec![];
    sentences.push(match (distance, run.complete) {
        (_, false) => format!("Not complete: stopped after {} cycles; fretwear run --resume goes on.", number(last.cycles)),
        (Some(distance), _) if distance <= estimate.unwrap_or(0.0).max(numerics.accuracy) => {
            "The worn profile has reached its limit, within the accuracy of the run.".into()
        }
        (Some(_), _) if results.scene.conditions().is_plain() => "The worn profile is on its way to the limit.".into(),
        (Some(_), _) => {
            "The worn profile is not at the limit of its stick radius and indentation, or not yet: under these conditions it need not go there."
                .into()
        }
        (None, _) => "This scene has no limit in closed form.".into(),
    });
    if let Some(distance) = distance {
        let cycles = number(last.cycles);
        sentences.push(format!(
            "After {cycles} cycles (τ = {}) the profile differs from the limit by {} of the limit's largest depth.",
            number(last.tau),
            number(distance)
        ));
    }
    if let Some(limit) = &results.limit {
        let part = last.wear_volume / limit.wear_volume();
        sentences.push(format!("The worn volume is {} of that of the limit.", number(part)));
    }
    let asked = numerics.accuracy_asked();
    let missed = estimate.zip(asked).is_some_and(|(estimate, asked)| estimate > asked);
    let wish = asked.map_or(String::new(), |asked| {
        format!("; {} was asked for{}", number(asked), if missed { ", which is missed" } else { "" })
    });
    sentences.push(match estimate {
        Some(estimate) => format!(
            "Estimated error of worn volume and profile: {} of those of the limit{wish}.",
            number(estimate)
        ),
        None => "There is no estimate of the error.".into(),
    });
    Verdict { sentences, doubtful: missed || !run.complete }
}

fn of_calibration(file: &Dataset) -> Result<Content> {
    let count = file.along("parameter")?.len();
    let (keys, units) = (file.words("key", count)?, file.words("unit", count)?);
    let [estimate, lower, upper] = ["estimate", "lower", "upper"].map(|name| file.numbers(name, &[count]));
    let (estimate, lower, upper) = (estimate?, lower?, upper?);
    let end = |value: f64| if value.is_finite() { number(value) } else { "not told".into() };
    let told = (0..count).map(|i| {
        let unit = unit_in_words(units.get(i));
        let (low, high) = (end(lower[i]), end(upper[i]));
        (keys.get(i).to_owned(), format!("{} {unit} (95 %: {low} to {high})", number(estimate[i])))
    });
    let told: Vec<(String, String)> = told.collect();
    let warnings: Vec<&str> = file.text("warnings").unwrap_or_default().lines().collect();
    let open = (0..count).any(|i| !lower[i].is_finite() || !upper[i].is_finite());
    let sentence = if open { "The data do not tell all unknowns." } else { "The data tell all unknowns." };
    let text = file.text("calibration").unwrap_or_default();
    Ok(Content {
        title: titled(file.title(), "A calibration"),
        program_version: file.program_version().to_owned(),
        verdict: Verdict { sentences: vec![sentence.into()], doubtful: open },
        above: vec![Section {
            heading: "Outcome",
            parts: [Part::Rows(told)]
                .into_iter()
                .chain(foretold(file)?)
                .chain(warnings.iter().map(|it| Part::Sentence(format!("Note: {it}."))))
                .collect(),
        }],
        below: vec![Section { heading: "Calibration", parts: vec![Part::Text(text.into())] }],
    })
}

/// The results of a scene that is foretold.
fn foretold(file: &Dataset) -> Result<Option<Part>> {
    if !file.has("forecast_result") {
        return Ok(None);
    }
    let count = file.along("forecast_result")?.len();
    let (names, units) = (file.words("forecast_name", count)?, file.words("forecast_unit", count)?);
    let numbers = |name: &str| file.numbers(name, &[count]);
    let (estimate, lower, upper) =
        (numbers("forecast_estimate")?, numbers("forecast_lower")?, numbers("forecast_upper")?);
    let shown = |value: f64| if value.is_finite() { number(value) } else { String::new() };
    let row = |i: usize| {
        let numbers = [estimate[i], lower[i], upper[i]].map(shown);
        [vec![names.get(i).to_owned()], numbers.to_vec(), vec![unit_in_words(units.get(i))]].concat()
    };
    let head =
        ["foretold", "at the estimates", "lower end of 95 %", "upper end of 95 %", "unit"].map(str::to_owned);
    let told = (0..count).filter(|i| lower[*i].is_finite());
    Ok(Some(Part::Table(head.to_vec(), told.map(row).collect())))
}

fn of_map(file: &Dataset) -> Content {
    let text = file.text("map").unwrap_or_default();
    let exponent = file.text("indenter_exponent").unwrap_or("unknown");
    let text = if text.is_empty() { "(the built-in comparison)" } else { text };
    Content {
        title: titled(file.title(), "Worn volume of graded media"),
        program_version: file.program_version().to_owned(),
        verdict: Verdict {
            sentences: vec![format!(
                "Limits in closed form, for indenters f = A r^n with n = {exponent}; gradings are compared at the same indentation unless a \
                 figure says otherwise."
            )],
            doubtful: false,
        },
        above: vec![],
        below: vec![
            Section { heading: "What was compared", parts: vec![Part::Text(text.into())] },
            arrays(file),
        ],
    }
}

/// Everything in a file of arrays.
fn arrays(file: &Dataset) -> Section {
    let row = |it: &Variable| {
        let shape: Vec<String> = it.shape.iter().map(usize::to_string).collect();
        vec![it.name.clone(), shape.join(" × "), it.units.clone(), it.long_name.clone()]
    };
    let mut numbers: Vec<&Variable> = file.variables.iter().filter(|it| it.is_numeric()).collect();
    numbers.sort_by_key(|it| &it.name);
    let head = ["dataset", "shape", "unit", "meaning"].map(str::to_owned);
    let table = Part::Table(head.to_vec(), numbers.into_iter().map(row).collect());
    Section { heading: "Numbers in the file", parts: vec![table] }
}

fn of_universality(file: &Dataset) -> Result<Content> {
    let count = file.along("case")?.len();
    let [names, predicted, verdicts] = CASE_COLUMNS.map(|name| file.words(name, count));
    let (names, predicted, verdicts) = (names?, predicted?, verdicts?);
    let [agrees, distance, volume, tau] = ["agrees", "distance", "wear_volume_ratio", "tau"]
        .map(|name| file.numbers(name, &[count]).map(|values| move |case: usize| values[case]));
    let (agrees, distance, volume, tau) = (agrees?, distance?, volume?, tau?);
    let row = |case: usize| {
        let words = [names, predicted, verdicts].map(|words| words.get(case).to_owned());
        let numbers = [distance(case), volume(case), tau(case)].map(number);
        words.into_iter().chain(numbers).collect()
    };
    let agreeing = (0..count).filter(|case| agrees(*case) == 1.0).count();
    let head =
        ["case", "predicted", "verdict", "distance", "volume over the limit's", "τ"].map(str::to_owned);
    let cases = Part::Table(head.to_vec(), (0..count).map(row).collect());
    let text = file.text("study").unwrap_or_default().to_owned();
    let obeying = verdicts.iter().filter(|verdict| *verdict == "obeys").count();
    Ok(Content {
        title: titled(file.title(), "One limit"),
        program_version: file.program_version().to_owned(),
        verdict: Verdict {
            sentences: vec![
                format!("{agreeing} of {count} cases came out as predicted."),
                format!("{obeying} obey the limit, {} do not.", count - obeying),
            ],
            doubtful: agreeing < count,
        },
        above: vec![],
        below: vec![
            Section { heading: "Cases", parts: vec![cases] },
            Section { heading: "Study", parts: vec![Part::Text(text)] },
        ],
    })
}

fn of_tradeoff(file: &Dataset) -> Content {
    let said = |name: &str| file.text(name).unwrap_or("unknown").to_owned();
    let scene = file.text("scene").unwrap_or_default().to_owned();
    let references = [
        ("springs of the references", "reference_springs"),
        ("their tolerances", "reference_tolerance"),
        ("uncertainty of volume, profile", "reference_uncertainty"),
    ];
    let references = references.map(|(meaning, name)| (meaning.to_owned(), said(name))).to_vec();
    Content {
        title: titled(file.title(), "A trade-off"),
        program_version: file.program_version().to_owned(),
        verdict: Verdict {
            sentences: vec![
                "Measured error against cost; wall times are those of the computer that ran it.".into(),
            ],
            doubtful: false,
        },
        above: vec![Section { heading: "References", parts: vec![Part::Rows(references)] }],
        below: vec![Section { heading: "Scene", parts: vec![Part::Text(scene)] }, arrays(file)],
    }
}

fn of_sweep(file: &SweepFile) -> Content {
    let header = &file.header;
    let count = file.scenes.len();
    let status = file.columns.iter().find(|column| column.name == "status");
    let failed = match status.map(|column| &column.values) {
        Some(Values::Texts(words)) => words.iter().filter(|word| *word == "failed").count(),
        _ => 0,
    };
    let head =
        std::iter::once("scene".to_owned()).chain(file.columns.iter().map(
            |column| match column.units.as_str() {
                "1" | "" => column.name.clone(),
                units => format!("{} ({units})", column.name),
            },
        ));
    let cell = |values: &Values, row: usize| match values {
        Values::Numbers(values) => number(values[row]),
        Values::Texts(words) => words.get(row).to_owned(),
        _ => String::new(),
    };
    let row = |row: usize| {
        let cells = file.columns.iter().map(|column| cell(&column.values, row));
        std::iter::once(file.scenes[row].to_string()).chain(cells).collect()
    };
    let table = Part::Table(head.collect(), (0..count.min(MOST_ROWS)).map(row).collect());
    let mut parts = vec![table];
    if count > MOST_ROWS {
        parts.push(Part::Sentence(format!(
            "The first {MOST_ROWS} of {count} scenes; all of them are in the file."
        )));
    }
    let sentence = format!("{count} of {} scenes, {failed} failed.", header.scenes);
    Content {
        title: titled(&header.title, "A sweep"),
        program_version: file.program_version.clone(),
        verdict: Verdict {
            sentences: vec![sentence],
            doubtful: failed > 0 || (count as u64) < header.scenes,
        },
        above: vec![],
        below: vec![
            Section { heading: "Scenes", parts },
            Section { heading: "Study", parts: vec![Part::Text(header.study.clone())] },
            Section { heading: "Base scene", parts: vec![Part::Text(header.base_scene.clone())] },
        ],
    }
}
