//! The table `[loading]`: load, amplitude and end, control, mode and blocks, and which of them go together.

use std::sync::Arc;

use super::Rows;
use super::document::{Entry, Section};
use super::keys::{self, MOST_TIMES};
use super::laws::{Given, OneClock, clock_of, given};
use super::reading::Read;
use crate::contact::InitialContact;
use crate::error::Result;
use crate::laws::conditions::Extent;
use crate::laws::entry::Lengths;
use crate::laws::friction::FrictionLaw;
use crate::laws::loading::{Amplitude, Block, Duration, Load, Loading, TangentialControl};
use crate::laws::motion::{self, Mode, Tangential};
use crate::units::Key;

/// What the table says without a look at the contact.
pub(super) struct Motion<'a> {
    pub loading: Loading,
    pub control: TangentialControl,
    pub blocks: Vec<Block>,
    pub repeat: bool,
    /// Whether the first loading wears too.
    pub wears_from_rest: bool,
    /// Cycles per second, Hz.
    pub frequency: Option<f64>,
    mode: Option<Given<'a, dyn Mode>>,
}

impl Motion<'_> {
    /// Whether the normal force is held.
    pub(super) fn holds_normal_force(&self) -> bool {
        matches!(self.loading.load, Load::NormalForce(_))
    }
}

/// Reads everything but what the mode takes from the contact.
pub(super) fn motion<'a>(section: &Section<'a>, rows: &Rows, clock: &mut OneClock) -> Result<Motion<'a>> {
    section.check(&keys::LOADING)?;
    let loads: [(_, fn(_) -> _); 3] = [
        (&keys::INDENTATION, Load::Indentation),
        (&keys::INITIAL_FORCE, Load::InitialForce),
        (&keys::NORMAL_FORCE, Load::NormalForce),
    ];
    let amplitudes: [(_, fn(_) -> _); 5] = [
        (&keys::AMPLITUDE, Amplitude::Displacement),
        (&keys::STROKE, Amplitude::Stroke),
        (&keys::TANGENTIAL_FORCE, Amplitude::Force),
        (&keys::AMPLITUDE_RATIO, Amplitude::Ratio),
        (&keys::STICK_RATIO, Amplitude::StickRatio),
    ];
    let durations: [(_, fn(_) -> _); 3] = [
        (&keys::CYCLES, Duration::Cycles),
        (&keys::TAU, Duration::Tau),
        (&keys::UNTIL_RATE, Duration::UntilRate),
    ];
    let load = one(section, loads)?;
    let mode = given(section, motion::ENTRIES, rows)?;
    let amplitude = match mode.as_ref().filter(|mode| mode.entry.gives_amplitude) {
        Some(mode) => Amplitude::Displacement(mode.build()?.amplitude().expect("it decides the amplitude")),
        None => one(section, amplitudes)?,
    };
    let duration = one(section, durations)?;
    let word: usize = section.read(&keys::TANGENTIAL_CONTROL)?;
    let control = match (section.read_optional(&keys::RIG_STIFFNESS)?, word) {
        (Some(stiffness), _) => TangentialControl::Rig { stiffness },
        (None, 1) => TangentialControl::Force,
        _ => TangentialControl::Displacement,
    };
    let control = match (amplitude, control_given(section)) {
        (Amplitude::Force(_), Some(other)) if control != TangentialControl::Force => {
            return Err(other.misplaced(
                "does not go together with loading.tangential_force, which holds the force; remove one of the two",
            ));
        }
        (Amplitude::Force(_), _) => TangentialControl::Force,
        _ => control,
    };
    let blocks = blocks(section, clock)?;
    let repeat = section.read(&keys::REPEAT)?;
    let frequency = section.read_optional(&keys::FREQUENCY)?;
    let from: usize = section.read(&keys::WEAR_FROM)?;
    let loading = Loading { load, amplitude, duration };
    Ok(Motion { loading, control, blocks, repeat, wears_from_rest: from == 1, frequency, mode })
}

/// The key that says what is held tangentially, if one does.
fn control_given<'a>(section: &Section<'a>) -> Option<Entry<'a>> {
    let keys = [keys::RIG_STIFFNESS, keys::TANGENTIAL_CONTROL];
    keys.iter().find_map(|key| section.optional(key.name))
}

/// A key and what its number is.
type Alternative<'k, T> = (&'k Key, fn(f64) -> T);

/// What the one key says that a table has of some.
fn one<T, const N: usize>(section: &Section, alternatives: [Alternative<T>; N]) -> Result<T> {
    let given = alternatives.into_iter().find(|(key, _)| section.optional(key.name).is_some());
    let (key, of) = given.expect("the table has one of them");
    section.read(key).map(of)
}

fn blocks(section: &Section, clock: &mut OneClock) -> Result<Vec<Block>> {
    let Some(entry) = section.optional(keys::BLOCK.name) else { return Ok(Vec::new()) };
    let entries = entry.array(MOST_TIMES)?;
    if entries.is_empty() {
        return Err(entry.error("is empty; give at least one [[loading.blocks]], or leave it out"));
    }
    let blocks = entries.iter().map(|entry| block(&entry.section()?, clock)).collect::<Result<Vec<_>>>()?;
    if blocks.iter().all(|block| block.amplitude_factor == 0.0) {
        return Err(entry.misplaced("has only amplitude factors of 0: nothing would ever slip; ask for more"));
    }
    Ok(blocks)
}

fn block(section: &Section, clock: &mut OneClock) -> Result<Block> {
    section.check(&keys::BLOCK)?;
    let (key, duration) = section.one_of(&["cycles", "tau"])?;
    clock.take(clock_of(key), &duration)?;
    Ok(Block {
        duration: f64::read(&duration, keys::BLOCK.key(key).expect("a key of a block"))?,
        amplitude_factor: section.read(&keys::AMPLITUDE_FACTOR)?,
        indentation_factor: section.read(&keys::INDENTATION_FACTOR)?,
    })
}

/// What the indenter does over one period; the contact gives the lengths that ratios refer to.
pub(super) fn mode<'c>(
    motion: &mut Motion,
    contact: impl Fn(&Loading) -> Result<&'c InitialContact>,
) -> Result<Arc<dyn Mode>> {
    let Motion { loading, blocks, mode: Some(given), .. } = motion else { return Ok(Arc::new(Tangential)) };
    given.refer(|| contact(loading).map(lengths))?;
    let mode = given.build()?;
    let lift = -mode.indentations()[0];
    if lift > 0.0 {
        // The indentation that the shallowest block has.
        let factor = |least: f64, block: &Block| least.min(block.indentation_factor);
        let depth = contact(loading)?.indentation() * blocks.iter().fold(1.0, factor);
        if lift >= depth {
            return Err(given.error(format_args!(
                "lifts the indenter by {lift:e} m from an indentation of {depth:e} m: the contact would open; lift it less"
            )));
        }
    }
    Ok(mode)
}

/// What others refer to.
pub(super) fn lengths(contact: &InitialContact) -> Lengths {
    Lengths { indentation: contact.indentation(), amplitude: contact.amplitude() }
}

pub(super) fn extent(contact: &InitialContact) -> Extent {
    let slip_width = contact.contact_radius() - contact.stick_radius().unwrap_or(0.0);
    Extent {
        indentation: contact.indentation(),
        amplitude: contact.amplitude(),
        mean_pressure: contact.mean_pressure(),
        slip_width,
        slip_share: slip_width / contact.contact_radius(),
        tangential_stiffness: contact.tangential_stiffness(),
    }
}

/// Refuses what does not go together.
pub(super) fn check(
    section: &Section,
    motion: &Motion,
    mode: &dyn Mode,
    friction: &dyn FrictionLaw,
) -> Result<()> {
    let of_mode = mode.entry().and_then(|mode| section.optional(mode.name));
    if let (true, Some(entry)) = (motion.wears_from_rest, &of_mode) {
        return Err(entry.misplaced(
            "settles in the course of many cycles, in each of which springs slip by other amounts (frictional shakedown): there is no one first cycle \
             for loading.wear_from = \"first-cycle\" to begin with; leave that out (tangential oscillation at constant indentation is settled from \
             its first reversal on)",
        ));
    }
    if motion.holds_normal_force() {
        let cure = "give loading.initial_force or loading.indentation instead";
        if let Some(entry) = of_mode.as_ref().filter(|_| mode.changes_indentation()) {
            return Err(entry.misplaced(format_args!(
                "changes the indentation, which loading.normal_force decides; {cure}"
            )));
        }
        let deeper = motion.blocks.iter().position(|block| block.indentation_factor != 1.0);
        if let (Some(place), Some(entry)) = (deeper, section.optional(keys::BLOCK.name)) {
            return Err(entry.misplaced(format_args!(
                "has an indentation_factor (in block {place}), but loading.normal_force decides the indentation; {cure}"
            )));
        }
    }
    let force = section.optional(keys::TANGENTIAL_FORCE.name);
    if let Some(entry) = force.as_ref().filter(|_| friction.coefficient().is_none()) {
        return Err(entry.misplaced(format_args!(
            "is turned into a stick radius by one coefficient of friction, and friction.{} has several; give the amplitude as a length, and \
             loading.tangential_control = \"force\"",
            friction.entry().name
        )));
    }
    let control = control_given(section).or(force);
    let held = control.filter(|_| motion.control != TangentialControl::Displacement);
    let (Some(control), Some(entry)) = (held, of_mode) else { return Ok(()) };
    // An amplitude of force stands for the displacement of a whole period only where that goes to and fro between two reversals.
    let (name, why) = match (motion.control, mode.changes_indentation()) {
        (TangentialControl::Force, true) => (
            "a held tangential force",
            "an amplitude tells the force at its two turning points alone, and while the indentation changes springs slip by how it goes between them",
        ),
        (TangentialControl::Force, false) => (
            "a held tangential force",
            "one amplitude says neither which component of the force that is nor how both go in between, by which springs slip",
        ),
        (_, true) => (
            "a rig",
            "what the contact bears changes with the indentation within a period, and so does how far the spring of the rig is stretched: the contact \
             would move on a path that is another in every cycle as it wears",
        ),
        (_, false) => (
            "a rig",
            "the spring of the rig is stretched along the force, which turns otherwise than the displacement: the contact would move on a path that is \
             another in every cycle as it wears",
        ),
    };
    Err(entry.misplaced(format_args!(
        "does not go together with {name}: {why}; remove {}, or oscillate tangentially at one indentation",
        control.path()
    )))
}
