//! Modes of motion, a file each: keys, path and words of one mode. A new one is a file and its line in [`ENTRIES`].

mod mode;
pub mod normal_oscillation;
pub mod orbit;
pub mod recorded;
mod tangential;

pub use mode::{Mode, SampledPath, ToAndFro};
pub use normal_oscillation::NormalOscillation;
pub use orbit::Orbit;
pub use recorded::RecordedPath;
pub use tangential::Tangential;

use super::entry::Entry;

/// All modes that a scene can ask for; without one it is [`Tangential`].
pub static ENTRIES: &[&Entry<dyn Mode>] = &[&normal_oscillation::ENTRY, &orbit::ENTRY, &recorded::ENTRY];
