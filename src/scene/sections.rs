//! The tables of a scene, one function each: keys, units, ranges.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use super::document::{Entry, Section};
use super::quantity::{Dimension, parse};
use super::{MOST_SNAPSHOTS, Numerics, Output, Rows, Scene, Stepper, profile_file};
use crate::error::{Error, Result};
use crate::friction::Coulomb;
use crate::half_space::{HalfSpace, Poisson, similar_stiffness_ratio};
use crate::indenter::{Indenter, TabulatedProfile};
use crate::loading::{Amplitude, Duration, Load, Loading};
use crate::wear::Archard;

/// Reads the whole document; the text is kept as it is.
pub(super) fn scene(root: &Section, text: &str, rows: &Rows) -> Result<Scene> {
    const TABLES: [&str; 9] = [
        "title",
        "indenter",
        "half_space",
        "counter_body",
        "friction",
        "wear",
        "loading",
        "numerics",
        "output",
    ];
    root.only(&TABLES, &[])?;
    let mut warnings = Vec::new();
    let title = root.optional("title").map(|entry| title(&entry)).transpose()?;
    let shape = table(root, "indenter", "add for example [indenter.paraboloid] with radius")?;
    let indenter = indenter(&shape, rows, &mut warnings)?;
    let bodies = table(root, "half_space", "add [half_space] with grading, modulus and poisson_ratio")?;
    let half_space = contact(root, &bodies, &mut warnings)?;
    let friction = friction(&table(root, "friction", "add [friction.coulomb] with coefficient")?)?;
    let wear = wear(&table(root, "wear", "add [wear.archard] with coefficient")?, &friction)?;
    let loading = loading(&table(root, "loading", "add [loading] with load, amplitude and duration")?)?;
    let numerics = match root.optional("numerics") {
        Some(entry) => numerics(&entry.section()?, &mut warnings)?,
        None => Numerics::default(),
    };
    let output = match root.optional("output") {
        Some(entry) => output(&entry.section()?, loading.duration)?,
        None => Output::default(),
    };
    Ok(Scene {
        title,
        indenter,
        half_space,
        friction,
        wear,
        loading,
        numerics,
        output,
        text: text.into(),
        warnings,
    })
}

fn table<'a>(root: &Section<'a>, key: &str, cure: &str) -> Result<Section<'a>> {
    root.required(key, cure)?.section()
}

/// One line: a title goes into files and figures.
pub(super) fn title(entry: &Entry) -> Result<String> {
    const LONGEST: usize = 1000;
    let title = entry.string()?;
    if title.chars().any(char::is_control) {
        return Err(entry.error("holds a line break or another control character; a title is one line"));
    }
    if title.len() > LONGEST {
        return Err(entry.error(format_args!("is longer than {LONGEST} bytes")));
    }
    Ok(title.to_string())
}

fn indenter(section: &Section, rows: &Rows, warnings: &mut Vec<String>) -> Result<Indenter> {
    const SHAPES: [&str; 5] = ["paraboloid", "sphere", "cone", "power-law", "table"];
    section.only(&SHAPES, &[])?;
    let (shape, entry) = section.one_of(&SHAPES)?;
    let body = entry.section()?;
    match shape {
        "paraboloid" | "sphere" => {
            body.only(&["radius"], &[])?;
            let radius = body.required("radius", "for example \"10 mm\"")?.positive(Dimension::LENGTH)?;
            Ok(if shape == "sphere" { Indenter::Sphere { radius } } else { Indenter::Paraboloid { radius } })
        }
        "cone" => {
            body.only(&["slope", "half_angle"], &[])?;
            Ok(Indenter::Cone { slope: slope(body.one_of(&["slope", "half_angle"])?)? })
        }
        "table" => Ok(Indenter::Table(profile(&body, rows, warnings)?)),
        _ => {
            body.only(&["coefficient", "exponent"], &[])?;
            let exponent = body.required("exponent", "2 is a paraboloid")?.positive(Dimension::NUMBER)?;
            let unit = Dimension::profile_coefficient(exponent);
            let coefficient =
                body.required("coefficient", "in m^(1-n) for f = coefficient r^n")?.positive(unit)?;
            Ok(Indenter::PowerLaw { coefficient, exponent })
        }
    }
}

/// A measured profile, from its file or as it was stored.
fn profile(section: &Section, rows: &Rows, warnings: &mut Vec<String>) -> Result<Arc<TabulatedProfile>> {
    const UNITS: [&str; 2] = ["radius_unit", "profile_unit"];
    section.only(&["file", UNITS[0], UNITS[1]], &[])?;
    let file = section.required("file", "for example \"profile.csv\", two columns r and f")?;
    let name = file.string()?;
    if name.is_empty() {
        return Err(file.error("is no name of a file"));
    }
    let unit = |key: &str| {
        let Some(entry) = section.optional(key) else { return Ok("m") };
        let unit = entry.string()?;
        parse(&format!("1 {unit}"), Dimension::LENGTH)
            .map_err(|why| entry.explained(why + "; give a unit of length alone, such as \"um\""))?;
        Ok(unit)
    };
    let units = [unit(UNITS[0])?, unit(UNITS[1])?];
    match rows {
        Rows::In(folder) => profile_file::read(&folder.join(name), name, units, warnings).map(Arc::new),
        Rows::Stored(Some(table)) => Ok(Arc::clone(table)),
        Rows::Stored(None) => {
            Err(section.error("its rows are not stored in the result; run the scene again"))
        }
    }
}

/// `tan θ` of a cone's flank, or `cot α` of half its apex angle `α`, which lies between axis and flank.
fn slope((key, entry): (&str, Entry)) -> Result<f64> {
    if key == "slope" {
        return entry.positive(Dimension::NUMBER);
    }
    let range = "(0, 90 deg); it lies between axis and flank, and a number without unit is in radian";
    let angle = entry.quantity_in(Dimension::ANGLE, range, |angle| angle > 0.0 && angle < FRAC_PI_2)?;
    let slope = angle.tan().recip();
    if slope.is_finite() { Ok(slope) } else { Err(entry.outside(range)) }
}

/// The half-space, in series with the counter-body if that is elastic too.
fn contact(root: &Section, first: &Section, warnings: &mut Vec<String>) -> Result<HalfSpace> {
    let half_space = body(first, None, warnings)?;
    let Some(entry) = root.optional("counter_body") else { return Ok(half_space) };
    let second = entry.section()?;
    let counter_body = body(&second, Some(half_space.grading()), warnings)?;
    HalfSpace::in_series(&half_space, &counter_body).map_err(|error| second.locate(error))
}

/// One elastic body; a counter-body may leave out the grading, which is that of the half-space.
fn body(section: &Section, grading: Option<f64>, warnings: &mut Vec<String>) -> Result<HalfSpace> {
    const MODULUS: [&str; 2] = ["reference_depth", "poisson_ratio"];
    let keys = ["grading", "modulus", MODULUS[0], MODULUS[1], "normal_stiffness", "stiffness_ratio"];
    section.only(&keys, &[])?;
    let grading = match (section.optional("grading"), grading) {
        (None, Some(same)) => same,
        (None, None) => {
            section.required("grading", "0 is a homogeneous body")?.quantity(Dimension::NUMBER)?
        }
        (Some(entry), same) => {
            let own = entry.quantity_in(Dimension::NUMBER, "(-1, 1)", |k| k > -1.0 && k < 1.0)?;
            match same {
                Some(same) if same != own => {
                    return Err(entry.error(format_args!(
                        "differs from half_space.grading = {same}; both must be equal"
                    )));
                }
                _ => own,
            }
        }
    };
    let (form, entry) = section.one_of(&["modulus", "normal_stiffness"])?;
    let foreign: &[&str] = if form == "modulus" { &["stiffness_ratio"] } else { &MODULUS };
    if let Some(stray) = foreign.iter().find_map(|key| section.optional(key)) {
        return Err(
            stray.misplaced(format_args!("has no meaning beside {}; remove one of the two", entry.path()))
        );
    }
    let body = match form {
        "modulus" => {
            let modulus = entry.positive(Dimension::PRESSURE)?;
            let depth =
                section.optional("reference_depth").map(|z| z.positive(Dimension::LENGTH)).transpose()?;
            let poisson = poisson(section)?;
            warn_if_formal(section, poisson, grading, warnings);
            HalfSpace::from_modulus(grading, modulus, depth.unwrap_or(1.0), poisson)
        }
        _ => {
            let normal = entry.positive(Dimension::spring_stiffness(grading))?;
            let ratio = match section.optional("stiffness_ratio") {
                Some(ratio) => ratio.positive(Dimension::NUMBER)?,
                None => {
                    warn_if_formal(section, Poisson::Similar, grading, warnings);
                    similar_stiffness_ratio(grading)
                }
            };
            HalfSpace::from_stiffness(grading, normal, ratio)
        }
    };
    body.map_err(|error| section.locate(error))
}

pub(super) fn poisson(section: &Section) -> Result<Poisson> {
    let entry = section.required("poisson_ratio", "a number such as 0.3, or \"similar\"")?;
    match entry.string() {
        Ok("similar") => Ok(Poisson::Similar),
        Ok(_) => Err(entry.error("is neither a number nor \"similar\"")),
        Err(_) => Ok(Poisson::Ratio(entry.quantity(Dimension::NUMBER)?)),
    }
}

fn warn_if_formal(section: &Section, poisson: Poisson, grading: f64, warnings: &mut Vec<String>) {
    if poisson == Poisson::Similar && poisson.is_formal(grading) {
        warnings.push(format!(
            "{}: elastic similarity at grading {grading} needs Poisson's ratio {:.4}, above 0.5, which no isotropic solid has; \
             the result is a formal limit",
            section.name("grading"),
            poisson.value(grading),
        ));
    }
}

fn friction(section: &Section) -> Result<Coulomb> {
    section.only(&["coulomb"], &[])?;
    let law = section.one_of(&["coulomb"])?.1.section()?;
    Ok(Coulomb { coefficient: coefficient(&law, Dimension::NUMBER, "for example 0.6")? })
}

fn wear(section: &Section, friction: &Coulomb) -> Result<Archard> {
    const LAWS: [&str; 2] = ["archard", "dissipated-energy"];
    section.only(&LAWS, &[])?;
    let (law, entry) = section.one_of(&LAWS)?;
    // Volume per load and distance, and volume per energy, have the same dimension.
    let coefficient = |example: &str| coefficient(&entry.section()?, Dimension::INVERSE_PRESSURE, example);
    Ok(match law {
        "archard" => Archard { coefficient: coefficient("for example \"1e-14 1/Pa\"")? },
        _ => Archard::from_dissipated_energy(coefficient("for example \"2e-5 mm^3/J\"")?, friction),
    })
}

/// The positive coefficient of a law.
fn coefficient(law: &Section, dimension: Dimension, example: &str) -> Result<f64> {
    law.only(&["coefficient"], &[])?;
    law.required("coefficient", example)?.positive(dimension)
}

fn loading(section: &Section) -> Result<Loading> {
    const LOADS: [&str; 3] = ["indentation", "initial_force", "normal_force"];
    const AMPLITUDES: [&str; 3] = ["amplitude", "amplitude_ratio", "stick_ratio"];
    const DURATIONS: [&str; 3] = ["cycles", "tau", "until_rate"];
    const MODES: [&str; 3] = ["normal_oscillation", "orbit", "blocks"];
    section.only(&[LOADS, AMPLITUDES, DURATIONS].concat(), &MODES)?;
    if let (Some(("normal_force", entry)), _) = section.at_most_one_of(&LOADS)? {
        return Err(
            entry.not_offered("initial_force sets the indentation of the first cycle, which is then held")
        );
    }
    let load = match section.one_of(&LOADS[..2])? {
        ("indentation", entry) => Load::Indentation(entry.positive(Dimension::LENGTH)?),
        (_, entry) => Load::InitialForce(entry.positive(Dimension::FORCE)?),
    };
    let not_negative = |value: f64| value >= 0.0;
    let amplitude = match section.one_of(&AMPLITUDES)? {
        ("amplitude", entry) => {
            Amplitude::Displacement(entry.quantity_in(Dimension::LENGTH, "[0, inf)", not_negative)?)
        }
        ("amplitude_ratio", entry) => {
            Amplitude::Ratio(entry.quantity_in(Dimension::NUMBER, "[0, inf)", not_negative)?)
        }
        (_, entry) => {
            let within = |ratio: f64| ratio > 0.0 && ratio <= 1.0;
            Amplitude::StickRatio(entry.quantity_in(Dimension::NUMBER, "(0, 1]", within)?)
        }
    };
    let duration = match section.one_of(&DURATIONS)? {
        ("cycles", entry) => Duration::Cycles(entry.positive(Dimension::NUMBER)?),
        ("tau", entry) => Duration::Tau(entry.positive(Dimension::NUMBER)?),
        (_, entry) => {
            let within = |rate: f64| rate > 0.0 && rate < 1.0;
            Duration::UntilRate(entry.quantity_in(Dimension::NUMBER, "(0, 1)", within)?)
        }
    };
    Ok(Loading { load, amplitude, duration })
}

fn numerics(section: &Section, warnings: &mut Vec<String>) -> Result<Numerics> {
    section.only(&["accuracy", "springs", "stepper", "tolerance", "cycle", "checkpoint_interval"], &[])?;
    let mut numerics = Numerics::default();
    let fraction = |entry: &Entry, range: &str, least: f64| {
        entry.quantity_in(Dimension::NUMBER, range, |value| value > 0.0 && value >= least && value <= 0.1)
    };
    let accuracy = section.optional("accuracy");
    if let Some(entry) = &accuracy {
        numerics.accuracy = fraction(entry, "[1e-10, 0.1]", 1e-10)?;
    }
    if let Some(entry) = section.optional("springs") {
        numerics.springs = Some(entry.whole(3..=usize::MAX)?);
    }
    if let Some(entry) = section.optional("stepper") {
        let steppers = [Stepper::EveryCycle, Stepper::CycleJump, Stepper::Implicit];
        numerics.stepper = steppers[entry.word(&steppers.map(Stepper::name))?];
    }
    if let Some(entry) = section.optional("tolerance") {
        numerics.tolerance = Some(fraction(&entry, "(0, 0.1]", 0.0)?);
    }
    if let Some(entry) = section.optional("cycle")
        && entry.word(&["closed-form", "resolved"])? == 1
    {
        return Err(entry.error("is not offered by this version; leave it out or write \"closed-form\""));
    }
    if let Some(entry) = section.optional("checkpoint_interval") {
        // The upper end, some thirty years, keeps it within what a clock can count.
        numerics.checkpoint_interval =
            entry.quantity_in(Dimension::TIME, "[0, 1e9] s", |time| (0.0..=1e9).contains(&time))?;
    }
    if accuracy.is_some() && numerics.springs.is_some() && numerics.tolerance.is_some() {
        warnings
            .push("numerics.accuracy decides nothing where springs and tolerance are given by hand".into());
    }
    Ok(numerics)
}

fn output(section: &Section, duration: Duration) -> Result<Output> {
    let keys = ["snapshots", "at_cycles", "at_tau"];
    section.only(&keys, &[])?;
    match section.at_most_one_of(&keys)?.0 {
        None => Ok(Output::default()),
        Some(("snapshots", entry)) => Ok(Output::Snapshots(entry.whole(1..=MOST_SNAPSHOTS)?)),
        Some(("at_cycles", entry)) => {
            let end = if let Duration::Cycles(end) = duration { Some(("loading.cycles", end)) } else { None };
            Ok(Output::AtCycles(times(&entry, end)?))
        }
        Some((_, entry)) => {
            let end = if let Duration::Tau(end) = duration { Some(("loading.tau", end)) } else { None };
            Ok(Output::AtTau(times(&entry, end)?))
        }
    }
}

/// Times in increasing order, none twice, none after the end of the run where that is known.
fn times(entry: &Entry, end: Option<(&str, f64)>) -> Result<Vec<f64>> {
    let read = |entry: &Entry| -> std::result::Result<f64, Error> {
        let time = entry.quantity_in(Dimension::NUMBER, "[0, inf)", |time| time >= 0.0)?;
        match end {
            Some((key, last)) if time > last => {
                Err(entry.error(format_args!("lies after the end of the run, {key} = {last}")))
            }
            _ => Ok(time),
        }
    };
    let mut times = entry.array(MOST_SNAPSHOTS)?.iter().map(read).collect::<Result<Vec<_>>>()?;
    times.sort_by(f64::total_cmp);
    times.dedup();
    Ok(times)
}
