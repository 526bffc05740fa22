//! Wear laws, a file each: keys, formulas and words of one law. A new one is a file and its line in [`ENTRIES`].

pub mod archard;
pub mod dissipated_energy;
pub mod friction_power;
mod law;
pub mod non_local;
pub mod power_law;
mod spreading;
pub mod threshold;

pub use archard::Archard;
pub use dissipated_energy::DissipatedEnergy;
pub use law::{Rate, Rubbing, Scales, WearLaw};
pub use non_local::NonLocal;
pub use power_law::PowerLaw;
pub use spreading::Spreading;
pub use threshold::Threshold;

use super::entry::Entry;

/// All wear laws.
pub static ENTRIES: &[&Entry<dyn WearLaw>] = &[
    &archard::ENTRY,
    &dissipated_energy::ENTRY,
    &power_law::ENTRY,
    &threshold::ENTRY,
    &non_local::ENTRY,
    &friction_power::ENTRY,
];
