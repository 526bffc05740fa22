//! The tables of a scene, one function each: keys, units, ranges.

use std::cell::OnceCell;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use super::document::{Entry, Section, Source};
use super::laws::{self, OneClock};
use super::reading::Read;
use super::{Cycle, MOST_SNAPSHOTS, Numerics, Output, Rows, Scene, Stepper, keys, motion, profile_file};
use crate::contact::InitialContact;
use crate::contact::half_space::{HalfSpace, Poisson, similar_stiffness_ratio};
use crate::contact::indenter::{Indenter, TabulatedProfile};
use crate::error::{Error, Result};
use crate::laws::conditions::Conditions;
use crate::laws::friction::Coulomb;
use crate::laws::loading::{Duration, Loading, Mode};
use crate::laws::wear::Archard;
use crate::units::{Dimension, Table};

/// Reads the whole document; the text is kept as it is.
pub(super) fn scene(root: &Section, text: &str, rows: &Rows) -> Result<Scene> {
    root.check(&keys::SCENE)?;
    let mut warnings = Vec::new();
    let title = root.read_optional(&keys::TITLE)?;
    let shape = table(root, &keys::INDENTER)?;
    let indenter = indenter(&shape, rows, &mut warnings)?;
    let half_space = contact(root, &mut warnings)?;
    let Physics { loading, wear, conditions } = physics(root, &indenter, &half_space, rows)?;
    let friction = Coulomb { coefficient: conditions.friction.reference_coefficient() };
    let numerics = match root.optional("numerics") {
        Some(entry) => {
            let section = entry.section()?;
            let numerics = numerics(&section)?;
            check_numerics(&section, &numerics, &conditions, &mut warnings)?;
            numerics
        }
        None => Numerics::default(),
    };
    warnings.extend(warning_of_another_limit(&conditions));
    let output = match root.optional("output") {
        Some(entry) => output(&entry.section()?, Some(loading.duration))?,
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
    let friction_table = table(root, &keys::FRICTION)?;
    let friction = laws::friction(&friction_table)?;
    let friction_history = laws::history(&friction_table, false, &mut clock)?;
    let wear_table = table(root, &keys::WEAR)?;
    let wear = laws::wear(&wear_table)?;
    let wear_history = laws::history(&wear_table, true, &mut clock)?;
    let section = table(root, &keys::LOADING)?;
    let motion = motion::motion(&section, rows, &mut clock)?;
    let wear = wear.build(motion.frequency)?;

    // Formed only where something refers to it. Whatever the wear coefficient, it is the same contact.
    let coulomb = friction.reference()?;
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
    motion::check(&section, &motion, &*friction)?;
    let reference_wear = match wear.archard_coefficient(Some(coulomb.coefficient)) {
        Some(coefficient) => Archard { coefficient },
        None => contact()?.reference_wear(&*wear),
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
        frequency: motion.frequency,
        blocks: motion.blocks,
        repeat: motion.repeat,
        tangential_control: motion.control,
    };
    Ok(Physics { loading: motion.loading, wear: reference_wear, conditions })
}

/// The closed form knows nothing of what is not plain.
fn warning_of_another_limit(conditions: &Conditions) -> Option<String> {
    let mut departures = conditions.departures();
    if conditions.holds_both_forces() {
        // That has a closed form of its own.
        departures.retain(|it| !Conditions::HELD_FORCES.contains(it));
    }
    (!departures.is_empty()).then(|| {
        format!(
            "this scene has {}: limit takes its first cycle as plain tangential oscillation, run compares with the limit of the smallest \
             stick radius and the largest indentation of the run; docs/universality.md tells when the final shape is another",
            departures.join(", ")
        )
    })
}

fn table<'a>(root: &Section<'a>, table: &Table) -> Result<Section<'a>> {
    root.required_key(keys::SCENE.key(table.name).expect("a table of the scene"))?.section()
}

fn indenter(section: &Section, rows: &Rows, warnings: &mut Vec<String>) -> Result<Indenter> {
    const SHAPES: [&str; 5] = ["paraboloid", "sphere", "cone", "power-law", "table"];
    section.only(&SHAPES)?;
    let (shape, entry) = section.one_of(&SHAPES)?;
    let body = entry.section()?;
    match shape {
        "paraboloid" | "sphere" => {
            body.only(&["radius"])?;
            let radius = body.required("radius", "for example \"10 mm\"")?.positive(Dimension::LENGTH)?;
            Ok(if shape == "sphere" { Indenter::Sphere { radius } } else { Indenter::Paraboloid { radius } })
        }
        "cone" => {
            body.only(&["slope", "half_angle"])?;
            Ok(Indenter::Cone { slope: slope(body.one_of(&["slope", "half_angle"])?)? })
        }
        "table" => Ok(Indenter::Table(profile(&body, rows, warnings)?)),
        _ => {
            body.only(&["coefficient", "exponent"])?;
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
    section.only(&["file", UNITS[0], UNITS[1], "smoothing"])?;
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
fn contact(root: &Section, warnings: &mut Vec<String>) -> Result<HalfSpace> {
    let half_space = body(&table(root, &keys::HALF_SPACE)?, &keys::HALF_SPACE, None, warnings)?;
    let Some(entry) = root.optional(keys::COUNTER_BODY.name) else { return Ok(half_space) };
    let second = entry.section()?;
    let counter_body = body(&second, &keys::COUNTER_BODY, Some(half_space.grading()), warnings)?;
    HalfSpace::in_series(&half_space, &counter_body).map_err(|error| second.locate(error))
}

/// One elastic body; a counter-body may leave out the grading, which is that of the half-space.
fn body(
    section: &Section,
    table: &Table,
    half_space: Option<f64>,
    warnings: &mut Vec<String>,
) -> Result<HalfSpace> {
    section.check(table)?;
    let grading = match half_space {
        Some(same) => section.read_optional(&keys::GRADING)?.unwrap_or(same),
        None => section.read(&keys::GRADING)?,
    };
    if let Some(same) = half_space.filter(|same| *same != grading) {
        let entry = section.required_key(&keys::GRADING)?;
        let message = format!("differs from half_space.grading = {same}; both must be equal");
        return Err(entry.error(message));
    }
    let body = if let Some(modulus) = section.read_optional(&keys::MODULUS)? {
        let depth = reference_depth(section, grading)?;
        let poisson = poisson(section)?;
        warn_if_formal(section, poisson, grading, warnings);
        HalfSpace::from_modulus(grading, modulus, depth, poisson)
    } else {
        let normal = section.read(&keys::NORMAL_STIFFNESS.of(Dimension::spring_stiffness(grading)))?;
        let ratio = match section.read_optional(&keys::STIFFNESS_RATIO)? {
            Some(ratio) => ratio,
            None => {
                warn_if_formal(section, Poisson::Similar, grading, warnings);
                similar_stiffness_ratio(grading)
            }
        };
        HalfSpace::from_stiffness(grading, normal, ratio)
    };
    body.map_err(|error| section.locate(error))
}

/// The depth at which the modulus counts, m; any where it is the same at all depths.
fn reference_depth(section: &Section, grading: f64) -> Result<f64> {
    match section.read_optional(&keys::REFERENCE_DEPTH)? {
        Some(depth) => Ok(depth),
        None if grading == 0.0 => Ok(1.0),
        None => Err(section.error(format_args!(
            "{} is missing; where {} is not 0 the modulus counts at that depth: give it, for example {:?}",
            section.name(keys::REFERENCE_DEPTH.name),
            section.name(keys::GRADING.name),
            keys::REFERENCE_DEPTH.example
        ))),
    }
}

pub(super) fn poisson(section: &Section) -> Result<Poisson> {
    let entry = section.required_key(&keys::POISSON_RATIO)?;
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

pub(super) fn numerics(section: &Section) -> Result<Numerics> {
    section.check(&keys::NUMERICS)?;
    section.read::<usize>(&keys::WEAR_FROM)?;
    Ok(Numerics {
        accuracy: section.read(&keys::ACCURACY)?,
        springs: section.read_optional(&keys::SPRINGS)?,
        stepper: Stepper::ALL[section.read::<usize>(&keys::STEPPER)?],
        tolerance: section.read_optional(&keys::TOLERANCE)?,
        cycle: section.read_optional(&keys::CYCLE)?.map(|place: usize| Cycle::ALL[place]),
        substeps: section.read_optional(&keys::SUBSTEPS)?,
        checkpoint_interval: section.read(&keys::CHECKPOINT_INTERVAL)?,
    })
}

/// What of the numerics does not go together, or not with the conditions.
fn check_numerics(
    section: &Section,
    numerics: &Numerics,
    conditions: &Conditions,
    warnings: &mut Vec<String>,
) -> Result<()> {
    if numerics.cycle == Some(Cycle::ClosedForm) && conditions.mode != Mode::Tangential {
        return Err(section.required_key(&keys::CYCLE)?.error(
            "holds for tangential oscillation alone; leave it out or write \"resolved\" beside another mode",
        ));
    }
    let by_hand = numerics.springs.is_some() && numerics.tolerance.is_some();
    if by_hand && section.optional(keys::ACCURACY.name).is_some() {
        warnings
            .push("numerics.accuracy decides nothing where springs and tolerance are given by hand".into());
    }
    Ok(())
}

pub(super) fn output(section: &Section, duration: Option<Duration>) -> Result<Output> {
    section.check(&keys::OUTPUT)?;
    if let Some(entry) = section.optional(keys::AT_CYCLES.name) {
        let end = duration.and_then(|it| if let Duration::Cycles(end) = it { Some(end) } else { None });
        return Ok(Output::AtCycles(times(&entry, end.map(|end| ("loading.cycles", end)))?));
    }
    if let Some(entry) = section.optional(keys::AT_TAU.name) {
        let end = duration.and_then(|it| if let Duration::Tau(end) = it { Some(end) } else { None });
        return Ok(Output::AtTau(times(&entry, end.map(|end| ("loading.tau", end)))?));
    }
    Ok(Output::Snapshots(section.read(&keys::SNAPSHOTS)?))
}

/// Times in increasing order, none twice, none after the end of the run where that is known.
fn times(entry: &Entry, end: Option<(&str, f64)>) -> Result<Vec<f64>> {
    let read = |entry: &Entry| {
        let time = f64::read(entry, &keys::TIME)?;
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

/// The tables of a scene that says nothing of them.
impl Default for Numerics {
    fn default() -> Self {
        nothing(numerics)
    }
}

impl Default for Output {
    fn default() -> Self {
        nothing(|section| output(section, None))
    }
}

/// What is read from an empty table.
fn nothing<T>(read: impl Fn(&Section) -> Result<T>) -> T {
    let source = Source { name: "", text: "", kind: "a scene" };
    let document = source.parse().expect("no text is TOML");
    read(&Section::root(source, document.get_ref())).expect("every key has a default that serves")
}
