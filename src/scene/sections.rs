//! The tables of a scene, one function each: keys, units, ranges.

use std::cell::OnceCell;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use super::document::{Entry, Section};
use super::laws::{self, OneClock};
use super::{
    Cycle, FINEST_ACCURACY, MOST_SNAPSHOTS, MOST_SUBSTEPS, Numerics, Output, Rows, Scene, Stepper, WearFrom,
};
use super::{motion, profile_file};
use crate::contact::InitialContact;
use crate::contact::half_space::{HalfSpace, Poisson, similar_stiffness_ratio};
use crate::contact::indenter::{Indenter, TabulatedProfile};
use crate::error::{Error, Result};
use crate::laws::conditions::Conditions;
use crate::laws::loading::{Duration, Loading, Mode};
use crate::laws::wear::{Archard, WearLaw};
use crate::solver::model::FEWEST_SPRINGS;
use crate::units::Dimension;

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
    let Physics { loading, wear, conditions } = physics(root, &indenter, &half_space, rows)?;
    let friction = conditions.friction.reference();
    let numerics = match root.optional("numerics") {
        Some(entry) => numerics(&entry.section()?, &conditions, &mut warnings)?,
        None => Numerics::default(),
    };
    warnings.extend(warning_of_another_limit(&conditions));
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
        conditions,
        numerics,
        output,
        text: text.into(),
        warnings,
    })
}

/// Laws, loading and conditions.
struct Physics {
    loading: Loading,
    wear: Archard,
    conditions: Conditions,
}

fn physics(root: &Section, indenter: &Indenter, half_space: &HalfSpace, rows: &Rows) -> Result<Physics> {
    let mut clock = OneClock::default();
    let friction_table = table(root, "friction", "add [friction.coulomb] with coefficient")?;
    let friction = laws::friction(&friction_table)?;
    let friction_history = laws::history(&friction_table, false, &mut clock)?;
    let wear_table = table(root, "wear", "add [wear.archard] with coefficient")?;
    let wear = laws::wear(&wear_table)?;
    let wear_history = laws::history(&wear_table, true, &mut clock)?;
    let section = table(root, "loading", "add [loading] with load, amplitude and duration")?;
    let motion = motion::motion(&section, rows, &mut clock)?;

    // Formed only where something refers to it. Whatever the wear coefficient, it is the same contact.
    let coulomb = friction.reference();
    let provisional = Archard { coefficient: half_space.normal_stiffness().recip() };
    let formed = OnceCell::new();
    let contact = || {
        if formed.get().is_none() {
            let contact = InitialContact::new(indenter, half_space, &coulomb, &provisional, &motion.loading);
            let _ = formed.set(contact.map_err(|error| section.error(error))?);
        }
        Ok(formed.get().expect("formed above"))
    };
    let mode = motion::mode(&section, &motion, contact)?;
    let friction = friction.finish(|| contact().map(InitialContact::indentation))?;
    motion::check(&section, &motion, &friction)?;
    let reference_wear = match wear {
        WearLaw::Archard(law) => law,
        WearLaw::DissipatedEnergy { coefficient } => Archard::from_dissipated_energy(coefficient, &coulomb),
        _ => contact()?.reference_wear(&wear),
    };
    if !reference_wear.coefficient.is_normal() {
        return Err(wear_table.error(format_args!(
            "the law comes to a wear coefficient of {:e} 1/Pa at the pressure and slip of this contact, which cannot be computed with; check \
             the units of its coefficient",
            reference_wear.coefficient
        )));
    }
    let conditions = Conditions {
        friction,
        friction_history,
        wear,
        wear_history,
        clock: clock.clock(),
        mode,
        holds_normal_force: motion.holds_normal_force(),
        blocks: motion.blocks,
        repeat: motion.repeat,
        tangential_control: motion.control,
    };
    Ok(Physics { loading: motion.loading, wear: reference_wear, conditions })
}

/// The closed form knows nothing of what is not plain.
fn warning_of_another_limit(conditions: &Conditions) -> Option<String> {
    let departures = conditions.departures();
    (!departures.is_empty()).then(|| {
        format!(
            "this scene has {}: limit takes its first cycle as plain tangential oscillation, run compares with the limit of the smallest \
             stick radius and the largest indentation of the run; docs/universality.md tells when the final shape is another",
            departures.join(", ")
        )
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
    section.only(&["file", UNITS[0], UNITS[1], "smoothing"], &[])?;
    let name = section.file_name("for example \"profile.csv\", two columns r and f")?;
    let units = [section.length_unit(UNITS[0])?, section.length_unit(UNITS[1])?];
    let smoothing = section.optional("smoothing");
    let deviation = match &smoothing {
        Some(entry) => entry.quantity_in(Dimension::LENGTH, "[0, inf)", |deviation| deviation >= 0.0)?,
        None => 0.0,
    };
    let profile = match rows {
        Rows::In(folder) => {
            let path = section.file(folder, name)?;
            profile_file::read(&path, name, units, deviation, warnings)
        }
        Rows::Stored { table: Some(table), .. } if table.deviation() == deviation => {
            return Ok(Arc::clone(table));
        }
        // The scene was patched.
        Rows::Stored { table: Some(table), .. } => TabulatedProfile::smoothed(
            table.source(),
            table.radii().to_vec(),
            table.heights().to_vec(),
            deviation,
        ),
        Rows::Stored { table: None, .. } => {
            Err(section.error("its rows are not stored in the result; run the scene again"))
        }
    };
    profile.map(Arc::new).map_err(|error| match (error, &smoothing) {
        (Error::Inconsistent { what, why }, Some(entry)) if what == TabulatedProfile::SMOOTHING => {
            entry.explained(why)
        }
        (other, _) => other,
    })
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
    section.refuse_beside(foreign, &entry)?;
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

fn numerics(section: &Section, conditions: &Conditions, warnings: &mut Vec<String>) -> Result<Numerics> {
    const SPACE: [&str; 2] = ["accuracy", "springs"];
    const TIME: [&str; 3] = ["stepper", "tolerance", "checkpoint_interval"];
    const CYCLE: [&str; 3] = ["cycle", "substeps", "wear_from"];
    section.only(&[&SPACE[..], &TIME, &CYCLE].concat(), &[])?;
    let mut numerics = Numerics::default();
    let fraction = |entry: &Entry, range: &str, least: f64| {
        entry.quantity_in(Dimension::NUMBER, range, |value| value > 0.0 && value >= least && value <= 0.1)
    };
    let accuracy = section.optional("accuracy");
    if let Some(entry) = &accuracy {
        numerics.accuracy = fraction(entry, "[1e-10, 0.1]", FINEST_ACCURACY)?;
    }
    if let Some(entry) = section.optional("springs") {
        numerics.springs = Some(entry.whole(FEWEST_SPRINGS..=usize::MAX)?);
    }
    if let Some(entry) = section.optional("stepper") {
        numerics.stepper = Stepper::ALL[entry.word(&Stepper::ALL.map(Stepper::name))?];
    }
    if let Some(entry) = section.optional("tolerance") {
        numerics.tolerance = Some(fraction(&entry, "(0, 0.1]", 0.0)?);
    }
    if let Some(entry) = section.optional("cycle") {
        let cycles = [Cycle::ClosedForm, Cycle::Resolved];
        let cycle = cycles[entry.word(&cycles.map(Cycle::name))?];
        if cycle == Cycle::ClosedForm && conditions.mode != Mode::Tangential {
            return Err(entry.error(
                "holds for tangential oscillation alone; leave it out or write \"resolved\" beside another mode",
            ));
        }
        numerics.cycle = Some(cycle);
    }
    if let Some(entry) = section.optional("substeps") {
        numerics.substeps = Some(entry.whole(2..=MOST_SUBSTEPS)?);
    }
    if let Some(entry) = section.optional("wear_from") {
        let starts = [WearFrom::Shakedown, WearFrom::FirstCycle];
        numerics.wear_from = starts[entry.word(&starts.map(WearFrom::name))?];
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
