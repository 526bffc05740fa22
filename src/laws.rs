//! What a scene prescribes: laws of friction and wear, their change along the cycles, and the motion.

pub mod conditions;
pub mod entry;
pub mod friction;
pub mod history;
pub mod loading;
pub mod motion;
pub mod path;
pub mod wear;
