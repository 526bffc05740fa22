//! Laws, mode, blocks and control in words.

use super::text::{TextTable, number};
use crate::laws::conditions::Conditions;
use crate::laws::history::History;
use crate::laws::loading::{Block, Clock, TangentialControl};

/// Blocks and times of which all are listed.
const MOST_LISTED: usize = 6;

/// Adds what the conditions are to a table for people.
pub(super) fn put(rows: &mut TextTable, conditions: &Conditions) {
    let clock = match conditions.clock {
        Clock::Cycles => "cycles",
        Clock::Tau => "τ",
    };
    rows.row("friction law", conditions.friction.words());
    changing(rows, "its coefficients", &conditions.friction_history, clock);
    rows.row("wear law", conditions.wear.words());
    changing(rows, "its coefficient", &conditions.wear_history, clock);
    if let Some(frequency) = conditions.frequency {
        rows.row("frequency", format!("{} Hz", number(frequency)));
    }
    rows.row("mode", conditions.mode.words());
    let normal = if conditions.holds_normal_force { "normal force" } else { "indentation" };
    let tangential = match conditions.tangential_control {
        TangentialControl::Displacement => "amplitude held".to_owned(),
        TangentialControl::Force => "tangential force of the first cycle held".to_owned(),
        TangentialControl::Rig { stiffness } => {
            format!("amplitude held behind a spring of {} N/m", number(stiffness))
        }
    };
    rows.row("control", format!("{normal} held, {tangential}"));
    if !conditions.blocks.is_empty() {
        let blocks = conditions.blocks.iter().map(|it| block(it, clock));
        let after = if conditions.repeat { "repeated" } else { "once, the last goes on" };
        rows.row("blocks", format!("{}; {after}", listed(blocks)));
    }
}

/// The first few, and how many there are more.
fn listed(items: impl ExactSizeIterator<Item = String>) -> String {
    let more = items.len().saturating_sub(MOST_LISTED);
    let first: Vec<String> = items.take(MOST_LISTED).collect();
    match more {
        0 => first.join(", "),
        more => format!("{} and {more} more", first.join(", ")),
    }
}

fn block(block: &Block, clock: &str) -> String {
    let Block { duration, amplitude_factor, indentation_factor } = *block;
    let mut words = format!("{} {clock} at {} of the amplitude", number(duration), number(amplitude_factor));
    if indentation_factor != 1.0 {
        words += &format!(" and {} of the indentation", number(indentation_factor));
    }
    words
}

fn changing(rows: &mut TextTable, what: &str, history: &History, clock: &str) {
    match history {
        History::Constant => {}
        History::Exponential { last, time } => {
            rows.row(what, format!("to {} of the first, by 1/e in {} {clock}", number(*last), number(*time)))
        }
        History::Table { times, factors } => {
            let points = times.iter().zip(factors);
            let points = points.map(|(time, factor)| format!("{} at {}", number(*factor), number(*time)));
            rows.row(what, format!("of the first: {} {clock}", listed(points)));
        }
    }
}
