//! The table `[loading]`: load, amplitude and end, control, mode and blocks, and which of them go together.

use std::sync::Arc;

use super::document::{Entry, Section};
use super::keys::MOST_TIMES;
use super::laws::{OneClock, clock_of};
use super::{Rows, path_file};
use crate::contact::InitialContact;
use crate::error::Result;
use crate::laws::friction::FrictionLaw;
use crate::laws::loading::{
    Amplitude, Block, Duration, Load, Loading, Mode, RecordedPath, TangentialControl,
};
use crate::units::Dimension;

const LOADS: [&str; 3] = ["indentation", "initial_force", "normal_force"];
const AMPLITUDES: [&str; 3] = ["amplitude", "amplitude_ratio", "stick_ratio"];
const DURATIONS: [&str; 3] = ["cycles", "tau", "until_rate"];
const MODES: [&str; 3] = ["normal_oscillation", "orbit", "path"];
const OTHERS: [&str; 5] = ["rig_stiffness", "tangential_control", "blocks", "repeat", "frequency"];

/// What the table says without a look at the contact.
pub(super) struct Motion {
    pub loading: Loading,
    pub control: TangentialControl,
    pub blocks: Vec<Block>,
    pub repeat: bool,
    /// Cycles per second, Hz.
    pub frequency: Option<f64>,
    path: Option<Arc<RecordedPath>>,
}

impl Motion {
    /// Whether the normal force is held.
    pub(super) fn holds_normal_force(&self) -> bool {
        matches!(self.loading.load, Load::NormalForce(_))
    }
}

/// Reads everything but what the mode takes from the contact.
pub(super) fn motion(section: &Section, rows: &Rows, clock: &mut OneClock) -> Result<Motion> {
    section.only(&[&LOADS[..], &AMPLITUDES, &DURATIONS, &MODES, &OTHERS].concat())?;
    section.at_most_one_of(&MODES)?;
    let load = match section.one_of(&LOADS)? {
        ("indentation", entry) => Load::Indentation(entry.positive(Dimension::LENGTH)?),
        ("initial_force", entry) => Load::InitialForce(entry.positive(Dimension::FORCE)?),
        (_, entry) => Load::NormalForce(entry.positive(Dimension::FORCE)?),
    };
    let path = section.optional("path").map(|entry| path(&entry.section()?, rows)).transpose()?;
    let amplitude = match &path {
        None => amplitude(section)?,
        Some(path) => {
            if let (Some((_, entry)), _) = section.at_most_one_of(&AMPLITUDES)? {
                return Err(entry.misplaced(
                    "has no meaning beside loading.path, which says how far the indenter goes; remove one of the two",
                ));
            }
            Amplitude::Displacement(path.amplitude())
        }
    };
    let duration = match section.one_of(&DURATIONS)? {
        ("cycles", entry) => Duration::Cycles(entry.positive(Dimension::NUMBER)?),
        ("tau", entry) => Duration::Tau(entry.positive(Dimension::NUMBER)?),
        (_, entry) => {
            const RANGE: &str = "[1e-14, 1); below, the rate of worn volume is the rounding of what is left of the pressure: give loading.tau instead";
            let within = |rate: f64| (Duration::SMALLEST_RATE..1.0).contains(&rate);
            Duration::UntilRate(entry.quantity_in(Dimension::NUMBER, RANGE, within)?)
        }
    };
    let control = control(section)?;
    let blocks = blocks(section, clock)?;
    let repeat = match section.optional("repeat") {
        Some(entry) if blocks.is_empty() => {
            return Err(entry.misplaced("repeats loading.blocks, of which there are none; remove it"));
        }
        Some(entry) => entry.boolean()?,
        None => false,
    };
    let frequency =
        section.optional("frequency").map(|entry| entry.positive(Dimension::FREQUENCY)).transpose()?;
    Ok(Motion { loading: Loading { load, amplitude, duration }, control, blocks, repeat, frequency, path })
}

fn amplitude(section: &Section) -> Result<Amplitude> {
    let not_negative = |value: f64| value >= 0.0;
    Ok(match section.one_of(&AMPLITUDES)? {
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
    })
}

/// A recorded path, from its file or as it was stored.
fn path(section: &Section, rows: &Rows) -> Result<Arc<RecordedPath>> {
    section.only(&["file", "displacement_unit"])?;
    let name = section.file_name("for example \"path.csv\", columns x and y")?;
    let unit = section.length_unit("displacement_unit")?;
    match rows {
        Rows::In(folder) => path_file::read(&section.file(folder, name)?, name, unit).map(Arc::new),
        Rows::Stored { path: Some(path), .. } => Ok(Arc::clone(path)),
        Rows::Stored { path: None, .. } => {
            Err(section.error("its rows are not stored in the result; run the scene again"))
        }
    }
}

fn control(section: &Section) -> Result<TangentialControl> {
    const CONTROLS: [&str; 3] = ["displacement", "force", "rig"];
    let rig = section.optional("rig_stiffness");
    let stiffness = rig.as_ref().map(|entry| entry.positive(Dimension::STIFFNESS)).transpose()?;
    let word = section.optional("tangential_control");
    let control = word.as_ref().map(|entry| entry.word(&CONTROLS)).transpose()?;
    match (control.map(|place| CONTROLS[place]), stiffness, rig) {
        (None | Some("rig"), Some(stiffness), _) => Ok(TangentialControl::Rig { stiffness }),
        (Some(other), Some(_), Some(rig)) => Err(rig.misplaced(format_args!(
            "has no meaning beside loading.tangential_control = \"{other}\"; remove it, or write \"rig\""
        ))),
        (Some("force"), ..) => Ok(TangentialControl::Force),
        (Some("rig"), ..) => {
            section.required("rig_stiffness", "for example \"5 MN/m\"")?;
            Ok(TangentialControl::Displacement)
        }
        _ => Ok(TangentialControl::Displacement),
    }
}

fn blocks(section: &Section, clock: &mut OneClock) -> Result<Vec<Block>> {
    let Some(entry) = section.optional("blocks") else { return Ok(Vec::new()) };
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
    const TIMES: [&str; 2] = ["cycles", "tau"];
    const FACTORS: [&str; 2] = ["amplitude_factor", "indentation_factor"];
    section.only(&[TIMES, FACTORS].concat())?;
    let (key, duration) = section.one_of(&TIMES)?;
    clock.take(clock_of(key), &duration)?;
    let factor = |key: &str, range: &str, least: f64| match section.optional(key) {
        Some(entry) => entry.quantity_in(Dimension::NUMBER, range, |it| it > 0.0 || it == least),
        None => Ok(1.0),
    };
    Ok(Block {
        duration: duration.positive(Dimension::NUMBER)?,
        amplitude_factor: factor(FACTORS[0], "[0, inf)", 0.0)?,
        indentation_factor: factor(FACTORS[1], "(0, inf)", f64::NAN)?,
    })
}

/// What the indenter does over one period; the contact gives the lengths that ratios refer to.
pub(super) fn mode<'c>(
    section: &Section,
    motion: &Motion,
    contact: impl Fn() -> Result<&'c InitialContact>,
) -> Result<Mode> {
    // The indentation that the shallowest block has.
    let shallowest = |contact: &InitialContact| {
        let factor = |least: f64, block: &Block| least.min(block.indentation_factor);
        contact.indentation() * motion.blocks.iter().fold(1.0, factor)
    };
    match section.at_most_one_of(&MODES)?.0 {
        None => Ok(Mode::Tangential),
        Some(("normal_oscillation", entry)) => {
            let contact = contact()?;
            normal_oscillation(&entry.section()?, contact.indentation(), shallowest(contact))
        }
        Some(("orbit", entry)) => orbit(&entry.section()?, contact()?.amplitude()),
        Some((_, entry)) => {
            let path = motion.path.clone().expect("read with the rest of the table");
            if path.changes_indentation() {
                let depth = shallowest(contact()?);
                let lift = path.indentation.iter().fold(0.0, |most: f64, it| most.max(-it));
                if lift >= depth {
                    return Err(entry.misplaced(format_args!(
                        "lifts the indenter by {lift:e} m from an indentation of {depth:e} m: the contact would open; lift it less"
                    )));
                }
            }
            Ok(Mode::Recorded(path))
        }
    }
}

fn normal_oscillation(section: &Section, indentation: f64, shallowest: f64) -> Result<Mode> {
    const AMPLITUDES: [&str; 2] = ["amplitude", "amplitude_ratio"];
    section.only(&[&AMPLITUDES[..], &["frequency_ratio", "phase"]].concat())?;
    let (key, entry) = section.one_of(&AMPLITUDES)?;
    let amplitude = match key {
        "amplitude" => entry.positive(Dimension::LENGTH)?,
        _ => indentation * entry.quantity_in(Dimension::NUMBER, "(0, 1)", |it| it > 0.0 && it < 1.0)?,
    };
    if amplitude >= shallowest {
        return Err(entry.error(format_args!(
            "is an amplitude of {amplitude:e} m, not below the indentation of {shallowest:e} m: the contact would open; ask for less"
        )));
    }
    let ratio = section.required(
        "frequency_ratio",
        "normal oscillations per tangential one, for example 2 or \"3/2\"; 1 is the same frequency",
    )?;
    let frequency_ratio = frequency_ratio(&ratio)?;
    Ok(Mode::NormalOscillation { amplitude, frequency_ratio, phase: phase(section)? })
}

fn phase(section: &Section) -> Result<f64> {
    section.optional("phase").map_or(Ok(0.0), |entry| entry.quantity(Dimension::ANGLE))
}

/// `m` and `n` of a ratio `m/n` of whole numbers, without common divisor.
fn frequency_ratio(entry: &Entry) -> Result<[u32; 2]> {
    const LARGEST: u32 = 64;
    /// What the digits of a decimal fraction such as 1.3333333333333333 leave open.
    const ROUNDING: f64 = 1e-12;
    let ratio = match entry.string() {
        Ok(text) if text.contains('/') => {
            let whole = |part: &str| part.trim().parse::<u64>().ok().filter(|number| *number > 0);
            let parts = text.split_once('/').and_then(|(over, under)| whole(over).zip(whole(under)));
            parts.and_then(|(over, under)| {
                let divisor = common_divisor(over, under);
                let small = |number: u64| u32::try_from(number / divisor).ok().filter(|it| *it <= LARGEST);
                Some([small(over)?, small(under)?])
            })
        }
        _ => {
            let value = entry.positive(Dimension::NUMBER)?;
            (1..=LARGEST).find_map(|under| {
                let over = (value * f64::from(under)).round();
                let near = (value * f64::from(under) - over).abs() <= ROUNDING * over;
                (near && (1.0..=f64::from(LARGEST)).contains(&over)).then_some([over as u32, under])
            })
        }
    };
    ratio.ok_or_else(|| {
        entry.error(format_args!(
            "is no ratio of whole numbers up to {LARGEST}; write for example 2, 0.5 or \"4/3\""
        ))
    })
}

fn common_divisor(mut a: u64, mut b: u64) -> u64 {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

fn orbit(section: &Section, amplitude: f64) -> Result<Mode> {
    const AMPLITUDES: [&str; 2] = ["transverse_amplitude", "transverse_ratio"];
    section.only(&[&AMPLITUDES[..], &["phase", "centre_x", "centre_y"]].concat())?;
    let (key, entry) = section.one_of(&AMPLITUDES)?;
    let transverse_amplitude = match key {
        "transverse_amplitude" => entry.positive(Dimension::LENGTH)?,
        _ => amplitude * entry.positive(Dimension::NUMBER)?,
    };
    if !(transverse_amplitude > 0.0 && transverse_amplitude.is_finite()) {
        return Err(entry.error(format_args!(
            "gives an amplitude of {transverse_amplitude:e} m beside one of {amplitude:e} m along x; give {}",
            section.name(AMPLITUDES[0])
        )));
    }
    let place = |key: &str| section.optional(key).map_or(Ok(0.0), |entry| entry.quantity(Dimension::LENGTH));
    let centre = [place("centre_x")?, place("centre_y")?];
    Ok(Mode::Orbit { transverse_amplitude, phase: phase(section)?, centre })
}

/// Refuses what does not go together.
pub(super) fn check(section: &Section, motion: &Motion, friction: &dyn FrictionLaw) -> Result<()> {
    let mode = section.at_most_one_of(&MODES)?.0;
    if motion.holds_normal_force() {
        let cure = "give loading.initial_force or loading.indentation instead";
        let changes_indentation = match &mode {
            Some(("normal_oscillation", _)) => true,
            Some(("path", _)) => motion.path.as_ref().is_some_and(|path| path.changes_indentation()),
            _ => false,
        };
        if let Some((_, entry)) = mode.as_ref().filter(|_| changes_indentation) {
            return Err(entry.misplaced(format_args!(
                "changes the indentation, which loading.normal_force decides; {cure}"
            )));
        }
        let deeper = motion.blocks.iter().position(|block| block.indentation_factor != 1.0);
        if let (Some(place), Some(entry)) = (deeper, section.optional("blocks")) {
            return Err(entry.misplaced(format_args!(
                "has an indentation_factor (in block {place}), but loading.normal_force decides the indentation; {cure}"
            )));
        }
    }
    let control = ["rig_stiffness", "tangential_control"].iter().find_map(|key| section.optional(key));
    let Some(control) = control.filter(|_| motion.control != TangentialControl::Displacement) else {
        return Ok(());
    };
    let name = match motion.control {
        TangentialControl::Force => "a held tangential force",
        _ => "a rig",
    };
    if let Some((_, entry)) = mode {
        return Err(entry.misplaced(format_args!(
            "does not go together with {name}, which is for tangential oscillation alone; remove {}",
            control.path()
        )));
    }
    if friction.remembers_slip() {
        return Err(control.misplaced(format_args!(
            "asks for {name}, which does not go together with friction.{}; remove one of the two",
            friction.entry().name
        )));
    }
    Ok(())
}
