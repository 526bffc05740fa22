//! Friction laws, a file each: keys, formulas and words of one law. A new one is a file and its line in [`ENTRIES`].

pub mod coulomb;
mod law;
pub mod load_dependent;
pub mod static_kinetic;
pub mod wear_dependent;

pub use coulomb::Coulomb;
pub use law::FrictionLaw;
pub use load_dependent::LoadDependent;
pub use static_kinetic::StaticKinetic;
pub use wear_dependent::WearDependent;

use super::entry::Entry;

/// All friction laws.
pub static ENTRIES: &[&Entry<dyn FrictionLaw>] =
    &[&coulomb::ENTRY, &static_kinetic::ENTRY, &load_dependent::ENTRY, &wear_dependent::ENTRY];
