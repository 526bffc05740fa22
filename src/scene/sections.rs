//! The tables of a scene, one function each: keys, units, ranges.

use std::cell::OnceCell;

use super::document::{Entry, Section, Source};
use super::laws::{self, Given, OneClock};
use super::reading::Read;
use super::{Cycle, MOST_SNAPSHOTS, Numerics, Output, Rows, Scene, Stepper, keys, motion};
use crate::contact::InitialContact;
use crate::contact::half_space::{HalfSpace, Poisson, similar_stiffness_ratio};
use crate::contact::indenter::{self, Indenter};
use crate::contact::stick_slip::Regime;
use crate::error::Result;
use crate::laws::conditions::Conditions;
use crate::laws::entry as law;
use crate::laws::friction::{self, Coulomb};
use crate::laws::loading::{Amplitude, Duration, Loading};
use crate::laws::motion::RecordedPath;
use crate::laws::wear::{self, Archard};
use crate::units::{Dimension, Scale, Table, number};

/// Part of the accuracy that a condition changes at most where it is left out.
const IDLE: f64 = 1e-2;

/// Departure from a slanted line, relative, that is only rounding.
const ROUNDING: f64 = 1e-14;

/// Reads the whole document; the text is kept as it is.
pub(super) fn scene(root: &Section, text: &str, rows: &Rows) -> Result<Scene> {
    root.check(&keys::SCENE)?;
    let mut warnings = Vec::new();
    let title = root.read_optional(&keys::TITLE)?;
    let shape = one_of(&table(root, &keys::INDENTER)?, &keys::INDENTER, indenter::ENTRIES, rows)?;
    let indenter = Indenter::from(shape.build()?);
    warnings.append(&mut shape.values.warnings.borrow_mut());
    let half_space = contact(root, &mut warnings)?;
    let Physics { mut loading, wear, mut conditions } = physics(root, &indenter, &half_space, rows)?;
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
    let path = RecordedPath::of(&conditions.mode);
    let mut slides = false;
    if !conditions.is_plain() {
        let part = IDLE * numerics.accuracy;
        let formed = |loading: &Loading| {
            InitialContact::new(&indenter, &half_space, &friction, &wear, loading)
                .map_err(|error| table(root, &keys::LOADING).map_or_else(|it| it, |it| it.error(error)))
        };
        let mut first = formed(&loading)?;
        let mode = conditions.mode.entry();
        let mut left_out = vec![];
        if let Some(motion) = conditions.straighten(&motion::extent(&first), part) {
            if motion.angle.abs() > part {
                let name = mode.map_or("", |mode| mode.name);
                warnings.push(format!(
                    "loading.{name}: goes to and fro along a line at {}° to x; it is computed as an oscillation along that line, with an amplitude of {}",
                    number(motion.angle.to_degrees()),
                    Scale::LENGTH.show(motion.amplitude)
                ));
                loading.amplitude = Amplitude::Displacement(motion.amplitude);
                first = formed(&loading)?;
            }
            let told = motion.departure > ROUNDING;
            left_out.extend(mode.and_then(|mode| mode.departure).filter(|_| told));
        }
        left_out.extend(conditions.simplify(&motion::extent(&first), wear, part));
        warnings.extend(left_out.into_iter().map(|words| {
            format!("{words}: less than a hundredth of numerics.accuracy comes of it, so that it is left out")
        }));
        slides = first.regime() == Regime::FullSliding;
    }
    warnings.extend(warning_of_another_limit(&conditions, slides));
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
        path,
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
    let mut friction = one_of(&friction_table, &keys::FRICTION, friction::ENTRIES, rows)?;
    let friction_history = laws::history(&friction_table, &keys::FRICTION_HISTORY, &mut clock)?;
    let wear_table = table(root, &keys::WEAR)?;
    let mut wear = one_of(&wear_table, &keys::WEAR, wear::ENTRIES, rows)?;
    let wear_history = laws::history(&wear_table, &keys::WEAR_HISTORY, &mut clock)?;
    let section = table(root, &keys::LOADING)?;
    let mut motion = motion::motion(&section, rows, &mut clock)?;
    wear.values.frequency = motion.frequency;
    let wear = wear.build()?;

    // Formed only where something refers to it. Whatever the wear coefficient, it is the same contact, and Coulomb's law that stands for the
    // law of friction is the same whatever lengths that refers to.
    let coulomb = Coulomb { coefficient: friction.build()?.reference_coefficient() };
    let provisional = Archard { coefficient: half_space.normal_stiffness().recip() };
    let formed = OnceCell::new();
    let contact = |loading: &Loading| {
        if formed.get().is_none() {
            let contact = InitialContact::new(indenter, half_space, &coulomb, &provisional, loading);
            let _ = formed.set(contact.map_err(|error| section.error(error))?);
        }
        Ok(formed.get().expect("formed above"))
    };
    let mode = motion::mode(&mut motion, contact)?;
    friction.refer(|| contact(&motion.loading).map(motion::lengths))?;
    let friction = friction.build()?;
    motion::check(&section, &motion, &*mode, &*friction)?;
    // What a law by the contact as a whole makes of the energy is not in that.
    let in_proportion = wear.archard_coefficient(Some(coulomb.coefficient));
    let reference_wear = match in_proportion.filter(|_| wear.at_contact(0.0).is_none()) {
        Some(coefficient) => Archard { coefficient },
        None => contact(&motion.loading)?.reference_wear(&*wear),
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
        wears_from_rest: motion.wears_from_rest,
        frequency: motion.frequency,
        blocks: motion.blocks,
        repeat: motion.repeat,
        tangential_control: motion.control,
    };
    Ok(Physics { loading: motion.loading, wear: reference_wear, conditions })
}

/// What a table gives exactly one of.
fn one_of<'a, L: ?Sized>(
    section: &Section<'a>,
    table: &Table,
    entries: &'static [&'static law::Entry<L>],
    rows: &Rows,
) -> Result<Given<'a, L>> {
    section.check(table)?;
    Ok(laws::given(section, entries, rows)?.expect("the table has exactly one"))
}

/// The closed form knows nothing of what is not plain.
fn warning_of_another_limit(conditions: &Conditions, slides: bool) -> Option<String> {
    let mut departures = conditions.departures();
    if conditions.holds_both_forces() {
        // That has a closed form of its own.
        departures.retain(|it| !Conditions::HELD_FORCES.contains(it));
    }
    if departures.is_empty() {
        return None;
    }
    let says = if slides {
        "its first cycle is in gross slip, so that no stick zone is left from which a limit in closed form would follow"
    } else {
        "the limit in closed form is that of plain tangential oscillation. Before a run it is formed from the first cycle, after one from the smallest \
         stick radius and the largest indentation reached; docs/universality.md says when the final shape is another"
    };
    Some(format!("this scene has {}: {says}", departures.join(", ")))
}

fn table<'a>(root: &Section<'a>, table: &Table) -> Result<Section<'a>> {
    root.required_key(keys::SCENE.key(table.name).expect("a table of the scene"))?.section()
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
    match entry.text() {
        Some("similar") => Ok(Poisson::Similar),
        Some(_) => Err(entry.error("is neither a number nor \"similar\"")),
        None => Ok(Poisson::Ratio(entry.quantity(Dimension::NUMBER)?)),
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
    if numerics.cycle == Some(Cycle::ClosedForm) && !conditions.mode.is_tangential() {
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
